//! Finding planetary gear trains: what a train must do is given, every train that does it is wanted.
//!
//! | I want to … | call |
//! |---|---|
//! | find who is joined to whom and which elements close in which gear | [`schemes`] |
//!
//! Every answer says what was searched, how much of it was examined or excluded by proof, and how many satisfy the wish.

pub mod schemes;
