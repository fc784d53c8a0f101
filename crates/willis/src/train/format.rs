//! The text of a train file: what keys are made of, checked values in, values out.
//!
//! [`keys`] says what kind of value a key takes; the keys themselves are declared with the
//! [specification](super::specification). [`reader`] checks a whole document against them and collects every error with
//! its place; [`document`] writes one.

pub(crate) mod keys;
mod node;
mod reader;
mod synonyms;

pub(crate) use node::{Amount, Datum, Directed, Fields, Node, document};
pub(crate) use reader::{Spans, fields, read};
