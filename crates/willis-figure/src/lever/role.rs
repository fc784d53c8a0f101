//! What a point of a lever is: carrier, sun, ring, gear or planet.

use serde::{Deserialize, Serialize};

/// What a point of a lever is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum LeverRole {
    /// The carrier of the planets.
    Carrier,
    /// An external gear in mesh with a planet.
    Sun,
    /// An internal gear in mesh with a planet.
    Ring,
    /// A gear of a pair without planets.
    Gear,
    /// A planet.
    Planet,
}
