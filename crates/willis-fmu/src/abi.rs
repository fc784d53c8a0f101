//! The functions of C that a host calls. The only unsafe code of the project's runtime is here: reading and writing where the
//! host's pointers lead.
//!
//! A component that a host holds is a number dressed as a pointer, looked up in a list and never followed: one that was freed,
//! or never was, is an error and no crash. The same holds for states. Every call catches panics.

#![allow(unsafe_code)]
// Every function here has the contract of the standard of its name; what a pointer must be is said where it is followed.
#![allow(clippy::missing_safety_doc, clippy::too_many_arguments)]

mod handles;
mod raw;
mod three;
mod two;
