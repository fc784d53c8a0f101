//! What the second path of a power split does in an equilibrium, and which of its limits it exceeds.

use serde::{Deserialize, Serialize};

use crate::named::NameMap;
use crate::power_flow::{BeyondLimit, Flow, SideFlow, VariatorFlow, machine_beyond, ratio_beyond};
use crate::train::{Train, Variator, VariatorKind, VariatorPath};

use super::SolutionReport;

/// A variator in an operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VariatorReport {
    /// What it is made of.
    pub kind: VariatorKind,
    /// Power that reaches the receiving side, W; with more than two machines, all that motor together.
    pub power_w: f64,
    /// That power over the input power: positive from the first side to the second, negative the other way. With more
    /// than two machines the first that generates or motors counts as the first side.
    pub share: f64,
    /// Power lost on the way, W; standby losses included.
    pub loss_w: f64,
    /// Power out of the store into the bus, W; absent where there is no bus.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub store_w: Option<f64>,
    /// Speed of the first side over that of the second; absent with more than two, and where the second stands still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<f64>,
    /// Its sides by their members, or its machines.
    pub machines: NameMap<MachineReport>,
}

/// A side of a variator, or a machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MachineReport {
    /// The member that it turns with.
    pub member: String,
    /// Torque that it exerts on the member, N m.
    pub torque_n_m: f64,
    /// Speed of the member, rad/s.
    pub speed_rad_s: f64,
    /// Power that it delivers to the member, W: positive where it motors.
    pub power_w: f64,
    /// Efficiency in force, where it passes power.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency: Option<f64>,
}

/// What the variators do in a flow.
pub(super) fn reports(train: &Train, flow: &Flow) -> NameMap<VariatorReport> {
    let named = |f: &VariatorFlow| {
        let v = &train.variators[f.variator];
        (v.name.clone(), report(train, v, f, flow.input_power))
    };
    NameMap(flow.variators.iter().map(named).collect())
}

fn report(train: &Train, v: &Variator, f: &VariatorFlow, input: f64) -> VariatorReport {
    let motoring: f64 = f.sides.iter().map(|s| s.power.max(0.0)).sum();
    // From the first side to the second: the first takes power from its member, or the second gives it.
    let largest =
        |sides: &[SideFlow]| sides.iter().map(|s| s.power).fold(0.0, |a: f64, p| if p.abs() > a.abs() { p } else { a });
    let forward = match &f.sides[..] {
        [first, second] if second.power == 0.0 => first.power <= 0.0,
        [_, second] => second.power > 0.0,
        sides => largest(sides) <= 0.0,
    };
    let (standby, has_bus) = match &v.path {
        VariatorPath::Bus { standby, .. } => (*standby, true),
        VariatorPath::Direct { .. } => (0.0, false),
    };
    let ratio = match &f.sides[..] {
        [a, b] if b.speed != 0.0 => Some(a.speed / b.speed),
        _ => None,
    };
    let names: Vec<String> = match v.machines() {
        [] => v.members().into_iter().map(|m| train.member_name(m).to_owned()).collect(),
        machines => machines.iter().map(|m| m.name.clone()).collect(),
    };
    let side = |(k, s): (usize, &SideFlow)| MachineReport {
        member: train.member_name(s.member).to_owned(),
        torque_n_m: s.torque + 0.0,
        speed_rad_s: s.speed + 0.0,
        power_w: s.power + 0.0,
        efficiency: v.machines().get(k).filter(|_| s.power != 0.0).map(|m| m.efficiency.at(s.torque, s.speed).0),
    };
    VariatorReport {
        kind: v.kind,
        power_w: motoring + 0.0,
        share: if input > 0.0 { motoring / input * if forward { 1.0 } else { -1.0 } + 0.0 } else { 0.0 },
        loss_w: f.loss + standby + 0.0,
        store_w: has_bus.then_some(f.store + 0.0),
        ratio,
        machines: NameMap(names.into_iter().zip(f.sides.iter().enumerate().map(side)).collect()),
    }
}

/// Limits that a flow exceeds.
pub(super) fn beyond(train: &Train, flow: &Flow) -> Vec<BeyondLimit> {
    let of = |f: &VariatorFlow| {
        let v = &train.variators[f.variator];
        let ratio = match &f.sides[..] {
            [a, b] => ratio_beyond(v, a.speed / b.speed),
            _ => None,
        };
        let machines = v.machines().iter().zip(&f.sides);
        let machines = machines.flat_map(|(m, side)| machine_beyond(v, m, side.torque, side.speed));
        ratio.into_iter().chain(machines).map(|(limit, _)| limit).collect::<Vec<_>>()
    };
    flow.variators.iter().flat_map(of).collect()
}

/// Machines of an equilibrium that run outside their maps.
pub(super) fn outside_maps(train: &Train, s: &SolutionReport) -> Vec<String> {
    let outside = |name: &str, m: &MachineReport| {
        let mut machines = train.variators.iter().flat_map(Variator::machines);
        let machine = machines.find(|own| own.name == name);
        machine.is_some_and(|own| own.efficiency.at(m.torque_n_m, m.speed_rad_s).1)
    };
    let all = s.variators.iter().flat_map(|(_, v)| v.machines.iter());
    all.filter(|(name, m)| outside(name, m)).map(|(name, _)| name.clone()).collect()
}
