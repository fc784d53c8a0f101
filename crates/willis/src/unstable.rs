//! What the figures need of the inside of the library, and nobody else should use.
//!
//! No promise is made about anything here: it changes with the code behind it, without a new version.

use crate::analysis::MeshReport;
use crate::diagnostic::Diagnostics;
use crate::exact::{self, Rational};
use crate::kinematics::{Configuration, Element};
use crate::operating_point::Physics;
use crate::power_flow::MeshFlow;
use crate::regimes::setup::Setup;
use crate::regimes::{self, Atlas, RegimeReport, RegimeSelection, RegionReport, choice_of_two, efficiency_at};
use crate::study;
use crate::train::{Load, MemberId, MeshId, Operation, Train};
use crate::units::Quantity;

pub use crate::operating_point::contact::Station;

/// Reduced row echelon form in place, pivoting only in the first `columns` columns; returns the pivot column of each of
/// the leading rows. The rows after them are zero in those columns.
pub fn reduce(matrix: &mut Vec<Vec<Rational>>, columns: usize) -> Vec<usize> {
    exact::reduce(matrix, columns)
}

/// The quantile `p` of sorted values.
pub fn quantile(sorted: &[f64], p: f64) -> f64 {
    study::quantile(sorted, p)
}

/// Inputs and outputs as people write them: `engine, mg1 -> ring`.
pub fn arrow(inputs: &[String], outputs: &[String]) -> String {
    regimes::arrow(inputs, outputs)
}

/// Members at rest because something holds them, the frame among them.
pub fn held(c: &Configuration<'_>) -> Vec<MemberId> {
    (0..c.inner.len()).filter(|&m| !c.inner[m] && c.node_of[m].is_none()).map(MemberId).collect()
}

/// The train with its nominal efficiencies only.
pub fn without_laws(train: &Train) -> Train {
    train.without_laws()
}

/// The train alone.
pub fn without_operations(train: &Train) -> Train {
    let mut alone = train.clone();
    alone.operations.clear();
    alone
}

/// Meshes in a row, in which power runs one way: those of an operation, each row from the mesh that the first gear of it enters.
pub fn chains(train: &Train, operation: &Operation) -> Vec<Vec<MeshId>> {
    let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
    let prescribed: Vec<MemberId> = operation.speeds.iter().map(|s| s.0).collect();
    let c = Configuration::new(train, engaged, &operation.fixed, &prescribed);
    let meshes = |e: &Element| e.links.iter().map(|l| l.mesh).collect();
    c.elements.iter().filter(|e| e.links.first().is_some_and(|l| l.along)).map(meshes).collect()
}

/// An operation that stands in no file.
pub fn operation(
    name: String,
    state: Option<usize>,
    speeds: Vec<(MemberId, Quantity)>,
    loads: Vec<(MemberId, Load)>,
) -> Operation {
    Operation { state, speeds, loads, ..Operation::new(name) }
}

/// The train with one operation more.
pub fn with_operation(train: &Train, operation: Operation) -> Train {
    let mut more = train.clone();
    more.operations.push(operation);
    more
}

/// The path of contact of a mesh.
#[derive(Clone, Debug)]
pub struct Along {
    /// From A to E, on both sides of every jump of the load.
    pub stations: Vec<Station>,
    /// Sliding loss of all pairs in parallel, W: the local loss integrated by the rule that averages friction.
    pub loss: Option<f64>,
    /// Whether the law of friction gives a value for each place.
    pub local: bool,
    /// Which of the two gears drives, seen from the carrier.
    pub driver: usize,
}

/// The path of contact of a mesh of an operation, of which `own` was found; `steps` places in each part of it. None when
/// it has no teeth or is idle.
pub fn along(train: &Train, operation: &Operation, mesh: usize, own: &MeshReport, steps: usize) -> Option<Along> {
    let id = MeshId(mesh);
    let mesh = &train.meshes[mesh];
    let teeth = mesh.teeth.as_ref()?;
    let driver =
        own.driver.as_ref().and_then(|name| mesh.gears.iter().position(|g| train.member_name(g.member) == name));
    let known = driver.unwrap_or(0);
    let counts = [0, 1].map(|g| mesh.gears[g].teeth.to_f64());
    let other = own.relative_speed_rad_s * counts[known] / counts[1 - known] * if mesh.same_sense { 1.0 } else { -1.0 };
    let mut relative_speeds = [own.relative_speed_rad_s; 2];
    relative_speeds[1 - known] = other;
    let flow = MeshFlow {
        mesh: id,
        torques: [own.first_torque_n_m, own.second_torque_n_m, own.carrier_torque_n_m],
        relative_speeds,
        driver,
        potential_power: own.potential_power_w,
        efficiency: own.efficiency,
        loss: own.loss_w,
    };
    let found = Physics::new(train, operation).along(mesh, teeth, &flow, steps)?;
    Some(Along { stations: found.stations, loss: found.loss, local: found.local, driver: known })
}

/// The speed plane of a state with two freedoms and one independent torque.
pub struct Speeds<'t> {
    atlas: Atlas,
    setup: Setup<'t>,
}

impl<'t> Speeds<'t> {
    /// That of the first state of the selection which has one.
    ///
    /// # Errors
    /// Diagnostics for unknown names; why, in words, when no state has one.
    pub fn new(train: &'t Train, selection: &RegimeSelection) -> Result<Self, Result<Diagnostics, String>> {
        choice_of_two(train, selection).map(|(atlas, setup)| Self { atlas, setup })
    }

    /// Its regimes.
    pub fn atlas(&self) -> &Atlas {
        &self.atlas
    }

    /// The two directions, in base speeds, between which a region lies.
    pub fn bounds(&self, region: &RegionReport) -> Option<[[f64; 2]; 2]> {
        region.rays.as_ref().map(|rays| rays.each_ref().map(|v| [v[0].to_f64(), v[1].to_f64()]))
    }

    /// Sign of the power of each terminal in a regime.
    pub fn power_signs<'r>(&self, regime: &'r RegimeReport) -> &'r [i8] {
        &regime.power_signs
    }

    /// Efficiency of a regime at base speeds of its region; not a number where these are none.
    pub fn efficiency(&self, region: &RegionReport, regime: &RegimeReport, base: [f64; 2]) -> f64 {
        let base: Option<Vec<Rational>> = base.into_iter().map(Rational::from_f64).collect();
        let Some(base) = base else { return f64::NAN };
        let torques = self.setup.torques_at(&regime.pattern, &region.point, &regime.torques, &base);
        efficiency_at(&self.setup, &base, &torques).to_f64()
    }
}
