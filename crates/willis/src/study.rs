//! Many operating points: maps, trends, what matters most, how sure it is, and files for other programs.
//!
//! A [`Model`](crate::model::Model) is a train whose quantities can be set anew; a [`PointSetup`] says what is prescribed
//! and what is held while quantities vary; an [`Axis`] is one quantity and its values. A [`Sweep`] puts them together: a grid of
//! points, each of which is one row, computed as [`analyze`](crate::analyze) computes it.

mod answer;
mod axis;
mod calibrate;
pub mod calibration;
mod column;
mod compare;
mod compiled;
mod cycle;
mod design;
mod distribution;
pub mod export;
mod heat;
mod profile;
mod question;
mod sensitivity;
mod summary;
mod sweep;
mod uncertainty;

pub use answer::{LawChoice, PointAnswer, PointAnswers, PointVerdict, PointWarning};
pub use axis::{Axis, values};
pub use calibrate::{
    BlindChange, BlindDirection, CalibrateRequest, CalibratedPart, Calibration, MeterOffset, NextTest, PredictedLoss,
    TestResidual, calibrate,
};
pub use column::{Column, ColumnKind, ColumnTable, ColumnValues, Rows};
pub use compare::{
    Band, CompareRequest, Compared, ComparedUnit, ComparedValue, Comparison, Difference, MapComparison, MapDifference,
    MapPair, MapPlace, TextDifference, Variant, compare,
};
pub use compiled::{CompiledSweep, SweepWorkspace};
pub use cycle::{
    Cycle, CycleAnswer, CycleOil, CycleReport, CycleRequest, Energies, EnergyKind, LossBySource, PowerDirection,
    RepeatedMessage, TerminalEnergy, VerdictTime, Worst, WorstRow, cycle,
};
pub(crate) use design::quantile;
pub use design::{Design, REPLICATES, SamplingError, SobolIndices, Statistics};
pub use distribution::{Distribution, standard_normal_quantile};
pub use heat::{
    DutyHeat, HeatRequest, HeatRow, HeatStudy, NoWarmUp, OperationHeat, RatingStatus, ThermalRating, WarmUp, heat,
};
pub use profile::{Basis, Profile, ProfileColumns, ProfileRow};
pub use question::{Hold, PointSetup, TrainCache};
pub use sensitivity::{
    Checks, OperationSensitivity, QuantitySensitivity, Sensitivity, SourceChange, StepKind, sensitivity,
};
pub use summary::{AxisValue, Extreme, MinMaxSum, Summary, WarningCount, WarningKind};
pub use sweep::{
    Shard, Sweep, SweepAnswer, SweepAxis, SweepColumn, SweepMethod, SweepPlace, SweepPlan, SweepReport, SweepRequest,
    SweepStudy, sweep,
};
pub use uncertainty::{
    ChoiceResult, Influence, SampleResult, Uncertain, UncertainQuantity, UncertainResult, UncertainValue, Uncertainty,
    UncertaintyAnswer, UncertaintyPlan, UncertaintyRequest, uncertainty,
};
