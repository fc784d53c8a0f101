//! Planetary gear trains by what they must do.
//!
//! Willis analyses a train that is given; here the question is turned round. These spaces are small enough to be finished, so
//! an answer is *all* trains that satisfy a wish, with the statement of what was searched, how much of it was examined or
//! excluded by proof, and that nothing else exists in it.
//!
//! | I want to … | call |
//! |---|---|
//! | find tooth numbers for ratios | [`teeth`] |
//! | find who is joined to whom and which elements close in which gear | [`schemes`] |

pub mod schemes;
pub mod teeth;
