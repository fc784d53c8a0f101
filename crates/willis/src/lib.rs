//! Willis: planetary gear trains, exactly.
pub mod exact;
pub mod units;
pub mod diagnostic;
pub mod train;
pub mod kinematics;
pub mod statics;
pub mod power_flow;
pub mod compiled;
pub mod analysis;
