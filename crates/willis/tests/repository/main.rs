//! What the repository says of itself: the order of modules, the prose.

mod architecture;
mod contracts;
mod docs;
