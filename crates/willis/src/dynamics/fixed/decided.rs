//! What decisions of steps keep from one to the next.

use crate::dynamics::bodies::Bodies;
use crate::dynamics::contacts::Contacts;

/// Decisions for one set of resisting shafts.
#[derive(Clone)]
pub(super) struct Decided {
    pub resists: Vec<f64>,
    pub bodies: Bodies,
    pub contacts: Contacts,
    /// What the contacts could hold in the round before.
    pub before: Vec<[[f64; 2]; 2]>,
}
