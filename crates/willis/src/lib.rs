//! Planetary (epicyclic) gear trains: exact ratios, speeds, torques with mesh losses, power flow,
//! efficiency, and a certificate that the answer is the only one.
//!
//! The modules are listed in the order of the pipeline, and a module uses only those above it:
//!
//! 1. [`exact`] and [`real`] numbers, [`symbolic`] functions, [`units`] and values by name ([`named`]);
//! 2. [`diagnostic`]: what is wrong, where, and what to do;
//! 3. [`catalogue`] of oils and bearings, [`geometry`] of involute teeth, [`losses`]: the laws;
//! 4. [`train`]: what a gear train is, and the train file; [`model`]: a train as data;
//! 5. [`kinematics`]: exact speeds, what is locked, free or redundant;
//! 6. [`statics`]: torques with losses, the certificate, the verdict;
//! 7. [`power_flow`]: torque and power everywhere, recirculation;
//! 8. [`compiled`]: a train made ready for many points;
//! 9. [`operating_point`]: losses and torques in agreement;
//! 10. [`analysis`]: the whole answer, as every front end shows it;
//! 11. [`hypergraph`]: where the power runs, as a graph of components and contacts;
//! 12. [`regimes`]: every way a train can run, with closed formulas;
//! 13. [`study`]: what matters most at an operating point.
//!
//! Charts, diagrams and reports are in the crate `willis-figure`.
//!
//! The library touches no file, clock or environment and builds for `wasm32-unknown-unknown`.
//!
//! ```
//! use willis::exact::Rational;
//! use willis::{Selection, Train, analyze};
//!
//! let train = Train::from_toml(r#"
//!     format = 1
//!     name = "sun drives, ring held"
//!     members = ["sun", "carrier"]
//!     terminals = ["sun", "carrier"]
//!
//!     [[set]]
//!     name = "P1"
//!     sun = { member = "sun", teeth = 30 }
//!     planet = { teeth = 20, count = 4 }
//!     ring = { member = "frame", teeth = 70 }
//!     carrier = "carrier"
//!     mesh_efficiency = 0.99
//! "#)?;
//! let analysis = analyze(&train, &Selection::default())?;
//! let (_, row) = &analysis.ratios.0[0];
//! assert_eq!(row.exact, Some(Rational::new(10, 3)));
//! assert!(row.drive.certificate.unwrap().unique_for_every_load);
//! # Ok::<(), willis::Diagnostics>(())
//! ```

pub mod exact;
pub mod symbolic;
pub mod real;
pub mod units;
pub mod named;
pub mod contract;
pub mod work;
pub mod diagnostic;
pub mod catalogue;
pub mod geometry;
pub mod losses;
pub mod train;
pub mod model;
pub mod kinematics;
pub mod statics;
pub mod power_flow;
pub mod compiled;
pub mod operating_point;
pub mod dynamics;
pub mod analysis;
pub mod hypergraph;
pub mod regimes;
pub mod study;
#[doc(hidden)]
pub mod unstable;

pub use analysis::{Analysis, Selection, analyze};
pub use diagnostic::Diagnostics;
pub use model::Model;
pub use real::Real;
pub use train::Train;

/// The Rust code of the README and of the book runs as doctests.
#[cfg(doctest)]
mod prose {
    #[doc = include_str!("../../../README.md")]
    struct Readme;
    #[doc = include_str!("../../../book/src/first-train.md")]
    struct FirstTrain;
    #[doc = include_str!("../../../book/src/verdict.md")]
    struct WhatTheVerdictMeans;
    #[doc = include_str!("../../../book/src/train-file.md")]
    struct TheTrainFile;
    #[doc = include_str!("../../../book/src/shift-tables.md")]
    struct ShiftTables;
    #[doc = include_str!("../../../book/src/automatic-transmission.md")]
    struct AnAutomaticTransmission;
    #[doc = include_str!("../../../book/src/wind-turbine.md")]
    struct AWindTurbinesGearbox;
    #[doc = include_str!("../../../book/src/losses.md")]
    struct WhereDoesEveryWattGo;
    #[doc = include_str!("../../../book/src/which-loss-first.md")]
    struct WhichLossFirst;
    #[doc = include_str!("../../../book/src/maps.md")]
    struct HowDoesItGo;
    #[doc = include_str!("../../../book/src/efficiency-map.md")]
    struct AnEfficiencyMap;
    #[doc = include_str!("../../../book/src/how-sure-am-i.md")]
    struct HowSureAmI;
    #[doc = include_str!("../../../book/src/duty-cycle.md")]
    struct WhatDoesItCost;
    #[doc = include_str!("../../../book/src/regimes.md")]
    struct EveryWayATrainCanRun;
    #[doc = include_str!("../../../book/src/power-split.md")]
    struct APowerSplit;
    #[doc = include_str!("../../../book/src/power-flow.md")]
    struct WhereThePowerRuns;
    #[doc = include_str!("../../../book/src/planets-and-losses.md")]
    struct PlanetsAndLosses;
    #[doc = include_str!("../../../book/src/shift-a-gear.md")]
    struct WhatHappensWhileIShift;
    #[doc = include_str!("../../../book/src/why-does-it-not-move.md")]
    struct WhyDoesItNotMove;
    #[doc = include_str!("../../../book/src/galvagno.md")]
    struct GalvagnosExperiment;
    #[doc = include_str!("../../../book/src/library.md")]
    struct UsingTheLibrary;
}
