//! What sticks and slips together, ready for the step.

/// Stands for a torque without bound: of a rigid lock, of a one-way clutch.
pub(in crate::dynamics) const UNBOUNDED: f64 = 1e30;

/// What counts as such when multiplied by a ratio of gears.
pub(super) const LEAST_UNBOUNDED: f64 = 1e24;

/// A friction element of a group, ready for the step.
#[derive(Clone)]
pub(in crate::dynamics) struct Rub {
    pub friction: usize,
    pub port: usize,
    pub factor: f64,
    /// Holds any torque, or none.
    pub is_rigid: bool,
    pub peak: f64,
    /// At this step: its viscous torque, and the torques with which it opposes slip of its group forward and
    /// backward.
    pub viscous: f64,
    pub opposes: [f64; 2],
}

impl Rub {
    /// Its torque at this step beside its viscous one, at least and at most, times a factor.
    pub fn range(&self, factor: f64) -> [f64; 2] {
        let [forward, backward] = self.opposes;
        let [low, high] = if self.factor > 0.0 { [-forward, backward] } else { [-backward, forward] };
        [low * factor, high * factor]
    }
}

/// What a group needs in a step.
#[derive(Clone)]
pub(in crate::dynamics) struct GroupStep {
    pub row: Vec<f64>,
    pub rubs: Vec<Rub>,
    pub elements: Vec<usize>,
    pub lead: (usize, f64),
    pub driven: bool,
    /// Whether several parts, teeth among them, share in holding it.
    pub shares: bool,
    /// Elements with losses that do not depend on load: port, torques when driving and coasting.
    pub constants: Vec<(usize, usize, [f64; 2])>,
}
