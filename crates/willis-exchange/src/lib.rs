//! Gearboxes of other programs as train files of Willis, and back.
//!
//! REXS (Reusable Engineering EXchange Standard of the FVA) is read in its three forms, XML, JSON and zip, and written as
//! XML. What was read comes as the text of a train file with an account of every attribute: used, left out or unusable,
//! and what had to be assumed. Broken files are read as far as they go. Sizes are bounded: a file of a stranger costs a
//! known amount of time and memory.
//!
//! ```
//! use willis::model::Model;
//! use willis_exchange::rexs;
//!
//! let model = Model::from_toml(r#"
//!     format = 1
//!     name = "reducer"
//!     members = ["sun", "carrier"]
//!     terminals = ["sun", "carrier"]
//!     [[set]]
//!     name = "P1"
//!     sun = { member = "sun", teeth = 17 }
//!     planet = { teeth = 22, count = 3 }
//!     ring = { member = "frame", teeth = 61 }
//!     carrier = "carrier"
//!     geometry = { module = "4 mm", width = "50 mm" }
//! "#)?;
//! let file = rexs::write(model.train())?.text;
//! assert!(file.contains(r#"version="1.6""#));
//! let read = rexs::read("reducer.rexs", file.as_bytes())?;
//! assert_eq!(read.model.train().meshes().len(), 2);
//! assert!(read.toml.contains("teeth = 22"));
//! # Ok::<(), willis::Diagnostics>(())
//! ```

mod account;
pub mod c;
mod document;
pub mod gearsets;
mod json;
pub mod rexs;
mod text;
mod xml;
mod zip;
