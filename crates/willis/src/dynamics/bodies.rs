//! The bodies of a train, as the decision of what its contacts do knows them.

use super::decision::{Body, Inertia, Mesh};

/// The bodies of a train in a scenario, and what is between them: what does not change with the contacts.
#[derive(Clone)]
pub(super) struct Bodies {
    pub count: usize,
    pub inertias: Vec<Inertia>,
    /// One for each mesh element, with its constant efficiencies.
    pub meshes: Vec<Mesh>,
    /// One for each friction element.
    pub frictions: Vec<[Body; 2]>,
    /// Those of prescribed speeds.
    pub prescribed: Vec<Body>,
}
