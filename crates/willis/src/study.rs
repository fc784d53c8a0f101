//! Many operating points: maps, trends, what matters most, how sure it is, and files for other programs.

mod sensitivity;

pub use sensitivity::{
    Checks, OperationSensitivity, QuantitySensitivity, Sensitivity, SourceChange, StepKind, sensitivity,
};
