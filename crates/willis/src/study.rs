//! Many operating points: maps, trends, what matters most, how sure it is, and files for other programs.
//!
//! A [`Model`](crate::model::Model) is a train whose quantities can be set anew; a [`Question`] says what is prescribed and what is
//! held while quantities vary; an [`Axis`] is one quantity and its values. A [`Sweep`] puts them together: a grid of
//! points, each of which is one row, computed as [`analyze`](crate::analyze) computes it.

mod axis;
mod compare;
mod compiled;
mod cycle;
mod design;
mod distribution;
pub mod export;
mod profile;
mod question;
mod sensitivity;
mod sweep;
mod uncertainty;

pub use axis::{Axis, values};
pub use compare::{
    Band, CompareRequest, Compared, Comparison, Datum, Difference, MapComparison, MapDifference, MapPair, MapPlace,
    TextDifference, Variant, compare,
};
pub use compiled::{CompiledSweep, Room};
pub use cycle::{
    Cycle, CyclePart, CyclePoint, CycleReport, Energies, Said, SourceEnergy, TerminalEnergy, VerdictTime, Way, Worst,
    WorstRow, cycle,
};
pub(crate) use design::quantile;
pub use design::{Design, Index, REPLICATES, SamplingError, Statistics};
pub use distribution::{Distribution, standard_normal_quantile};
pub use profile::{Basis, Profile, ProfileRow};
pub use question::{Hold, Question, Trains};
pub use sensitivity::{
    Checks, OperationSensitivity, QuantitySensitivity, Sensitivity, SourceChange, StepKind, sensitivity,
};
pub use sweep::{Answer, Cells, Column, Extent, Rows, Seen, Summary, Sweep, VERDICTS};
pub use uncertainty::{
    Choice, Evaluated, Influence, Likely, Output, Reported, Uncertain, Uncertainty, UncertaintyPlan, UncertaintyRequest,
};
