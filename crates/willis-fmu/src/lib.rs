//! Gear trains in other simulators: a train file becomes a Functional Mock-up Unit (FMU) by the Functional Mock-up Interface,
//! versions 2.0.4 and 3.0, for co-simulation and for model exchange.
//!
//! One crate, two faces. As a library of Rust it [packs](pack()): a description of the model, the train file and the runtime in
//! one archive. As a library of C it is that runtime: it reads the train from the folder `resources` of the unit, so that one
//! prebuilt library serves every train. Motion is that of [`willis::dynamics`]; nothing of it is done again here.
//!
//! | file | does |
//! |---|---|
//! | `layout` | the variables of a train in a scenario: inputs, parameters, outputs, states |
//! | `description` | the same as `modelDescription.xml` of either version |
//! | `archive` | files as one, the same bytes every time |
//! | `resources` | what lies in the unit, written and read back |
//! | `pack` | all of that together |
//! | `instance` | a run in the hands of a host: what may be called when, values, steps |
//! | `saved` | the state of such a run as bytes |
//! | `abi` | the functions of C |

mod abi;
mod archive;
mod description;
mod instance;
mod layout;
mod pack;
mod resources;
mod saved;

pub use description::Version;
pub use layout::Interface;
pub use pack::{Packed, Request, pack};

/// The name of the runtime in a unit, without what its file has before and behind.
pub const LIBRARY: &str = "willis_fmu";
