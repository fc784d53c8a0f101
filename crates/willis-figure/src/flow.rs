//! Powers through components and contacts. The data are [`willis::hypergraph::FlowReport`].

pub mod dot;
pub mod draw;
