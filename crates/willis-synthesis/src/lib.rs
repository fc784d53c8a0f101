//! Planetary gear trains by what they must do.
//!
//! Willis analyses a train that is given; here the question is turned round. The spaces of tooth numbers are small enough
//! to be finished, so an answer is *all* trains that satisfy a wish, with the statement that nothing else exists.

pub mod teeth;
