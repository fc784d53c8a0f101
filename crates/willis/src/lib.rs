//! Planetary (epicyclic) gear trains: exact ratios, speeds, torques with mesh losses, power flow, efficiency, and a
//! certificate that the answer is the only one.
//!
//! A train is a [`Train`]: checked, and valid by construction. It comes from the text of a train file or from the builder,
//! and every question is a function of it. Everything that can be wrong with an input comes back at once, as
//! [`Diagnostics`].
//!
//! ```
//! use willis::prelude::*;
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
//! let row = analysis.ratios.get("as drawn").unwrap();
//! assert_eq!(row.exact, Some(Rational::new(10, 3)));
//! assert!(row.drive.certificate.unwrap().unique_for_every_load);
//! # Ok::<(), Diagnostics>(())
//! ```
//!
//! The same in code, with a load:
//!
//! ```
//! use willis::prelude::*;
//!
//! let train = Train::builder("sun drives, ring held")
//!     .members(["sun", "carrier"])
//!     .terminals(["sun", "carrier"])
//!     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
//!     .operation(OperationSpec::new("full").speed("sun", AngularSpeed::rpm(1000.0)).torque("sun", Torque::n_m(10.0)))
//!     .build()?;
//! let analysis = analyze(&train, &Selection::default())?;
//! let full = &analysis.operations[0];
//! assert_eq!(full.verdict, Verdict::Unique);
//! let carrier = full.solutions[0].members.get("carrier").unwrap();
//! assert!((carrier.torque_n_m.unwrap() + 32.869).abs() < 1e-3);        // the load resists
//! # Ok::<(), Diagnostics>(())
//! ```
//!
//! # I want to …
//!
//! | I want to … | call |
//! |---|---|
//! | read a train file | [`Train::from_toml`] |
//! | build a train in code | [`Train::builder`] |
//! | change a quantity of a train and keep its text | [`Model`] |
//! | know ratios, torques, losses, and whether they are the only ones | [`analyze`] |
//! | ask one operating point | [`analysis::operate`] |
//! | see losses over speed, load, temperature, and law beside law | [`analysis::losses`](fn@analysis::losses) |
//! | follow the power through the train | [`hypergraph::flows`] |
//! | know every way a train can run, with closed formulas | [`regimes::regimes`], [`regimes::formulas`] |
//! | know how far an operating point is from the next regime | [`regimes::locate`](fn@regimes::locate) |
//! | rank what matters most | [`study::sensitivity`](fn@study::sensitivity) |
//! | know how sure a number is | [`study::uncertainty`](fn@study::uncertainty) |
//! | vary quantities over a grid | [`study::sweep`](fn@study::sweep) |
//! | compute the energy of a duty cycle | [`study::cycle`](fn@study::cycle) |
//! | compare variants | [`study::compare`](fn@study::compare) |
//! | evaluate millions of points | [`Train::compile`] |
//! | simulate motion: clutches, sticking, shafts | [`dynamics::simulate`], in real time [`dynamics::FixedStep`] |
//! | find natural frequencies | [`dynamics::modes`](fn@dynamics::modes) |
//! | write a model or a map for another program | [`study::export`] |
//! | choose a law of losses, or read its page | [`losses`], [`losses::Laws`] |
//! | compute one pair of teeth | [`geometry::Pair`] |
//! | read `"1450 rpm"` | [`units::parse`] |
//! | give an answer to another program | serialise it; it reads back: [`contract`] |
//!
//! Charts, diagrams and reports are in the crate `willis-figure`.
//!
//! # What is exact
//!
//! Tooth counts, ratios, speeds and whether shafts turn alike are rational numbers ([`exact`]), with the power of π beside
//! them; so are the signs that decide which gear drives, and the conditions between regimes. Torques, powers and losses
//! are floating point, with their balance in the answer. A verdict says whether a torque is unique and how that is known;
//! what cannot be decided is said ([`analysis::Verdict`]).
//!
//! # Units
//!
//! Inside, and in every field, numbers are SI: the name of a field of an answer ends in its unit (`torque_n_m`,
//! `speed_rad_s`), the page of any other number says it. At the boundary [`units::AngularSpeed`], [`units::Torque`] and
//! their kin are made from numbers with a unit or from text.
//!
//! # Modules
//!
//! They are listed in the order of the pipeline, and a module uses only those above it:
//!
//! 1. [`exact`] and [`real`] numbers, [`symbolic`] functions, [`units`] and values by name ([`named`]);
//! 2. [`contract`]: answers that read back; [`work`]: progress, stopping and threads of long work;
//! 3. [`diagnostic`]: what is wrong, where, and what to do;
//! 4. [`catalogue`] of oils and bearings, [`geometry`] of involute teeth, [`losses`]: the laws;
//! 5. [`train`]: what a gear train is, and the train file; [`model`]: a train as data;
//! 6. [`kinematics`]: exact speeds, what is locked, free or redundant;
//! 7. [`statics`]: torques with losses, the certificate, the verdict;
//! 8. [`power_flow`]: torque and power everywhere, recirculation;
//! 9. [`compiled`]: a train made ready for many points;
//! 10. [`operating_point`]: losses and torques in agreement;
//! 11. [`heat`]: the oil temperature at which losses and heat flow agree, warm-up;
//! 12. [`dynamics`]: motion over time, natural frequencies;
//! 13. [`analysis`]: the whole answer, as every front end shows it;
//! 14. [`hypergraph`]: where the power runs, as a graph of components and contacts;
//! 15. [`regimes`]: every way a train can run, with closed formulas;
//! 16. [`study`]: many operating points, what matters most, how sure it is, files for other programs.
//!
//! The library touches no file, clock or environment and builds for `wasm32-unknown-unknown`.

pub mod exact;
pub mod symbolic;
pub mod real;
pub mod units;
pub mod named;
pub mod contract;
mod arch;
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
pub mod heat;
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

/// The names that most programs need: `use willis::prelude::*;`.
pub mod prelude {
    pub use crate::analysis::{Analysis, Selection, Verdict, analyze};
    pub use crate::diagnostic::Diagnostics;
    pub use crate::exact::Rational;
    pub use crate::model::Model;
    pub use crate::train::{MeshSpec, OperationSpec, SetSpec, ShiftElementSpec, StateSpec, Train};
    pub use crate::units::{AngularSpeed, Power, Torque};
}

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
    #[doc = include_str!("../../../book/src/heat.md")]
    struct HowWarmDoesItGet;
    #[doc = include_str!("../../../book/src/maps.md")]
    struct HowDoesItGo;
    #[doc = include_str!("../../../book/src/efficiency-map.md")]
    struct AnEfficiencyMap;
    #[doc = include_str!("../../../book/src/how-sure-am-i.md")]
    struct HowSureAmI;
    #[doc = include_str!("../../../book/src/duty-cycle.md")]
    struct WhatDoesItCost;
    #[doc = include_str!("../../../book/src/compare.md")]
    struct WhichVariantIsBetter;
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
