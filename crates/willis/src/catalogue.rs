//! Oils and bearings by designation, each datum with its source (`data/`).

use serde::{Deserialize, Serialize};

pub mod bearing;
pub mod oil;

/// How far a datum of the catalogue was checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Trust {
    /// Read in a publication, a data sheet or a catalogue, or in a transcription of one.
    Seen,
    /// Follows from data that were read.
    Derived,
    /// Recalled, to be confirmed in the source that is named.
    Confirm,
    /// A usual value of its class, not that of one product.
    Typical,
}
