//! What a map needs to know of the answer at a place.

use willis::analysis::Role;
use willis::study::{PointAnswer, PointVerdict};
use willis::train::MemberId;

/// Which way power goes through a part.
#[derive(Clone, Copy, PartialEq)]
pub enum PowerRole {
    /// It neither gives nor takes power.
    Idle,
    /// A member at which power comes in.
    Input,
    /// A member at which power goes out.
    Output,
    /// A member that only passes power on, or is held.
    Passes,
    /// A mesh that this member drives.
    Driver(MemberId),
    /// A machine of a variator that gives power.
    Motors,
    /// A machine of a variator that takes power.
    Generates,
}

/// What a map needs to know of an operating point.
pub struct Told {
    pub verdict: PointVerdict,
    pub efficiency: Option<f64>,
    pub input_power_w: Option<f64>,
    pub loss_w: Option<f64>,
    /// Speed and torque of the input that was asked for, rad/s and N m.
    pub input: Option<[f64; 2]>,
    pub ways: Vec<PowerRole>,
}

impl Told {
    pub fn of(answer: &PointAnswer, input: Option<MemberId>) -> Self {
        let s = answer.numbers.as_ref();
        let unique = s.filter(|_| answer.is_unique());
        let input = input.zip(s).and_then(|(input, s)| {
            let m = s.member(input)?;
            Some([m.speed_rad_s?, m.torque_n_m?])
        });
        Self {
            verdict: answer.verdict,
            efficiency: unique.and_then(|s| s.efficiency),
            input_power_w: unique.map(|s| s.input_power_w),
            loss_w: unique.map(|s| s.loss_w),
            input,
            ways: ways(answer),
        }
    }
}

/// Which way power goes through every part that can change it.
pub fn ways(answer: &PointAnswer) -> Vec<PowerRole> {
    let Some(s) = &answer.numbers else { return vec![] };
    let members = s.members.iter().map(|m| match m.role {
        Role::Input => PowerRole::Input,
        Role::Output => PowerRole::Output,
        Role::Idle => PowerRole::Idle,
        _ => PowerRole::Passes,
    });
    let meshes = s.drivers.iter().map(|driver| driver.map_or(PowerRole::Idle, PowerRole::Driver));
    let variators = answer.solution.iter().flat_map(|s| s.variators.iter());
    let machines = variators.flat_map(|(_, v)| v.machines.iter()).map(|(_, m)| match m.power_w {
        w if w > 0.0 => PowerRole::Motors,
        w if w < 0.0 => PowerRole::Generates,
        _ => PowerRole::Idle,
    });
    members.chain(meshes).chain(machines).collect()
}
