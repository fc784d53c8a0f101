//! At which load and temperature the efficiencies of meshes are those of the laws.
//!
//! A regime is a cone of speeds and torques: it has no load. Efficiencies that laws compute have one, so regimes and
//! formulas take them at one operating point of the file and keep them constant, and every answer names that point.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::analysis::{DrivingLoad, OperationReport, in_force};
use crate::losses::mesh_friction::Constant;
use crate::named::NameMap;
use crate::train::{Efficiency, Load, Operation, Train};

/// Where the efficiencies of meshes come from whose losses laws compute.
///
/// # Example
/// ```
/// use willis::regimes::{RegimeSelection, regimes};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one set"
///     members = ["s", "c"]
///     terminals = ["s", "c"]
///     [oil]
///     name = "ISO VG 220"
///     temperature = "70 degC"
///     [[set]]
///     name = "P1"
///     sun = { member = "s", teeth = 30 }
///     planet = { teeth = 20, count = 4 }
///     ring = { member = "frame", teeth = 70 }
///     carrier = "c"
///     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "200 N m" }
/// "#)?;
/// let all = regimes(&train, &RegimeSelection::default())?;
/// let basis = all.states[0].efficiency_basis.as_ref().unwrap();
/// assert!(basis.is_at_load());
/// assert!(basis.efficiencies.iter().all(|(_, eta)| *eta < 1.0));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct EfficiencyBasis {
    /// The operation of the file whose load it is; absent where the request gives the point, and of nominal efficiencies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub operation: Option<String>,
    /// Speed of each member that is loaded from outside there, rad/s. Nothing of nominal efficiencies.
    #[serde(default)]
    pub speeds_rad_s: NameMap<f64>,
    /// Torque on each of them, N m.
    #[serde(default)]
    pub torques_n_m: NameMap<f64>,
    /// Oil temperature there, K: prescribed, of the heat balance, or of the oil.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub temperature_k: Option<f64>,
    /// Efficiency of each mesh whose losses are computed, with what bearings lose by its load; to six decimals, the same
    /// whichever gear drives.
    pub efficiencies: NameMap<f64>,
    /// Meshes that carry nothing or do not move there: theirs are nominal.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nominal: Vec<String>,
    /// Why all are nominal.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reason: Option<NoBasis>,
    /// The coefficient of friction that nominal efficiencies are made with.
    pub nominal_friction: f64,
}

/// Why there is no load at which the laws could be asked.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum NoBasis {
    /// The file has no operation in which a mesh of this state carries a load and moves.
    NoOperation,
    /// No operation that says so has exactly one equilibrium; these were tried.
    NotUnique(Vec<String>),
}

impl EfficiencyBasis {
    /// Whether the efficiencies are those of the laws at a load.
    pub fn is_at_load(&self) -> bool {
        self.reason.is_none()
    }
}

impl fmt::Display for EfficiencyBasis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let friction = self.nominal_friction;
        if let Some(reason) = &self.reason {
            write!(f, "mesh efficiencies are nominal, from a coefficient of friction of {friction}: ")?;
            return match reason {
                NoBasis::NoOperation => write!(f, "no operation of the file loads a mesh of this state that moves"),
                NoBasis::NotUnique(tried) => {
                    write!(f, "there is not exactly one equilibrium at the load of {}", tried.join(", "))
                }
            };
        }
        write!(f, "mesh efficiencies are those of the loss laws at ")?;
        match &self.operation {
            Some(name) => write!(f, "the load of operation `{name}`")?,
            None => write!(f, "this point")?,
        }
        for (k, ((name, speed), (_, torque))) in self.speeds_rad_s.iter().zip(self.torques_n_m.iter()).enumerate() {
            let rpm = speed * 30.0 / std::f64::consts::PI;
            write!(f, "{}{name} {rpm:.1} rpm and {torque:.1} N m", if k == 0 { " (" } else { ", " })?;
        }
        if !self.speeds_rad_s.0.is_empty() {
            write!(f, ")")?;
        }
        if let Some(kelvin) = self.temperature_k {
            write!(f, ", oil at {:.1} °C", kelvin - 273.15)?;
        }
        write!(
            f,
            "; with what bearings lose by the load; here they are constants, the same whichever gear drives, and what is lost without \
             load is left out"
        )?;
        if !self.nominal.is_empty() {
            let all = self.nominal.join(", ");
            write!(f, "; {all}: not loaded or not moving there, nominal from a coefficient of friction of {friction}")?;
        }
        Ok(())
    }
}

/// The efficiencies of all meshes in a state, and where they come from; none where no law computes any. A point `here`
/// comes first, nameless where it is none of the file's; then the load at which the table of ratios compares gears; then
/// operations of this state.
pub(super) fn basis(
    train: &Train,
    state: Option<usize>,
    here: Option<&Operation>,
) -> Option<(Vec<Efficiency>, EfficiencyBasis)> {
    if !train.meshes.iter().any(|m| m.computed) {
        return None;
    }
    let named = |point: &Operation| Some(point.name.clone()).filter(|name| !name.is_empty());
    let mut tried: Vec<String> = Vec::new();
    // A point in which every mesh is idle says nothing of losses; one without its only equilibrium is told.
    let mut at = |operation: Option<String>, point: &Operation| match in_force(train, point) {
        Some((all, report)) => Some(found(train, operation, all, &report, point))
            .filter(|(_, own)| own.nominal.len() < own.efficiencies.0.len()),
        None => {
            tried.extend(operation);
            None
        }
    };
    let loaded = |point: &&Operation| {
        let acts = |load: &Load| match load {
            Load::Torque(q) | Load::Power(q) => !q.value.is_zero(),
        };
        point.loads.iter().any(|(_, load)| acts(load)) || !(point.stores.is_empty() && point.machines.is_empty())
    };
    if let Some(found) = here.filter(loaded).and_then(|point| at(named(point), point)) {
        return Some(found);
    }
    let load = train.ends(state)[0].and_then(|input| DrivingLoad::of_file(train, input));
    if let Some(point) = load.as_ref().and_then(|load| load.point(train, state, "")) {
        let operation = load.and_then(|load| load.operation);
        if let Some(found) = at(operation, &point) {
            return Some(found);
        }
    }
    for point in train.operations.iter().filter(|o| o.state == state).filter(loaded) {
        if let Some(found) = at(Some(point.name.clone()), point) {
            return Some(found);
        }
    }
    tried.dedup();
    let efficiencies: Vec<Efficiency> = train.meshes.iter().map(|m| m.efficiency.clone()).collect();
    let reason = if tried.is_empty() { NoBasis::NoOperation } else { NoBasis::NotUnique(tried) };
    let basis = EfficiencyBasis {
        operation: None,
        speeds_rad_s: NameMap::default(),
        torques_n_m: NameMap::default(),
        temperature_k: None,
        efficiencies: computed(train, &efficiencies),
        nominal: vec![],
        reason: Some(reason),
        nominal_friction: nominal_friction(train),
    };
    Some((efficiencies, basis))
}

fn found(
    train: &Train,
    operation: Option<String>,
    efficiencies: Vec<Efficiency>,
    report: &OperationReport,
    point: &Operation,
) -> (Vec<Efficiency>, EfficiencyBasis) {
    let mut basis = EfficiencyBasis {
        operation,
        speeds_rad_s: NameMap::default(),
        torques_n_m: NameMap::default(),
        temperature_k: report.oil_k(train, point),
        efficiencies: computed(train, &efficiencies),
        nominal: vec![],
        reason: None,
        nominal_friction: nominal_friction(train),
    };
    if let [only] = &report.solutions[..] {
        for (m, _) in &point.loads {
            let name = train.member_name(*m);
            let member = only.members.get(name);
            if let Some((speed, torque)) = member.and_then(|m| m.speed_rad_s.zip(m.torque_n_m))
                && torque != 0.0
                && basis.speeds_rad_s.get(name).is_none()
            {
                basis.speeds_rad_s.0.push((name.to_owned(), speed));
                basis.torques_n_m.0.push((name.to_owned(), torque));
            }
        }
        let idle = |name: &str| only.meshes.get(name).is_none_or(|m| m.driver.is_none());
        let own = train.meshes.iter().filter(|m| m.computed && idle(&m.name));
        basis.nominal = own.map(|m| m.name.clone()).collect();
    }
    (efficiencies, basis)
}

fn computed(train: &Train, efficiencies: &[Efficiency]) -> NameMap<f64> {
    let own = train.meshes.iter().zip(efficiencies).filter(|(mesh, _)| mesh.computed);
    own.map(|(mesh, own)| (mesh.name.clone(), own.forward.to_f64())).collect()
}

fn nominal_friction(train: &Train) -> f64 {
    train.laws.friction_coefficient.unwrap_or(Constant::DEFAULT.mu)
}
