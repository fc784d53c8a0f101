//! What the repository says of itself: the order of modules, the prose, what an addition takes.

mod architecture;
mod contracts;
mod docs;
mod how_to_add;
mod profiles;
mod prose;
