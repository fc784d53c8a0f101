//! What friction in meshes at rest leaves open: every torque between the corners of their ρ-box balances the train.

use crate::kinematics::Configuration;
use crate::power_flow::Flow;

use super::{StictionQuantity, StictionRange};

/// Most elements at rest whose friction is varied, two values each.
const MOST_STUCK: usize = 8;

/// Ranges that friction in `stuck` elements leaves open, which carry a force and do not move: every vertex of their ρ-box.
/// `rho` tells ρ of an element when its end p drives and when q does, `torques` the external torques by member with these ρ in
/// place of 1.
pub(super) fn stiction(
    c: &Configuration<'_>,
    flow: &Flow,
    stuck: &[usize],
    rho: impl Fn(usize, bool) -> f64,
    torques: impl Fn(&[(usize, f64)]) -> Option<Vec<Option<f64>>>,
) -> Vec<StictionRange> {
    if stuck.is_empty() {
        return vec![];
    }
    if stuck.len() > MOST_STUCK {
        return vec![StictionRange::new(StictionQuantity::Unbounded { meshes: stuck.len() }, None)];
    }
    let mut low: Vec<Option<f64>> = flow.torques.clone();
    let mut high = low.clone();
    let efficiency = |f: &Flow| if f.input_power > 0.0 { f.output_power / f.input_power } else { 0.0 };
    let mut eta = (efficiency(flow), efficiency(flow));
    let ends: Vec<[f64; 2]> = stuck.iter().map(|&j| [rho(j, true), rho(j, false)]).collect();
    let mut choice: Vec<(usize, f64)> = stuck.iter().map(|&j| (j, 1.0)).collect();
    for mask in 0..1usize << stuck.len() {
        for (bit, (own, ends)) in choice.iter_mut().zip(&ends).enumerate() {
            own.1 = ends[mask >> bit & 1];
        }
        let Some(f) = torques(&choice) else { continue };
        for m in 0..low.len() {
            if let (Some(l), Some(h), Some(t)) = (low[m], high[m], f[m]) {
                (low[m], high[m]) = (Some(l.min(t)), Some(h.max(t)));
            }
        }
        // Efficiency from the torques of the terminals.
        let (mut power_in, mut power_out) = (0.0, 0.0);
        for (m, t) in f.iter().enumerate() {
            let p = t.unwrap_or(0.0) * flow.speeds[m];
            if p > 0.0 { power_in += p } else { power_out -= p }
        }
        if power_in > 0.0 {
            eta = (eta.0.min(power_out / power_in), eta.1.max(power_out / power_in));
        }
    }
    let size = flow.torques.iter().flatten().fold(0.0f64, |a, t| a.max(t.abs()));
    let mut all = Vec::new();
    if eta.1 - eta.0 > 1e-9 {
        all.push(StictionRange::new(StictionQuantity::Efficiency, Some(eta)));
    }
    for m in 1..low.len() {
        if let (Some(l), Some(h)) = (low[m], high[m])
            && h - l > 1e-9 * size
        {
            let quantity = StictionQuantity::Torque { member: c.train.members[m].name.clone() };
            all.push(StictionRange::new(quantity, Some((l, h))));
        }
    }
    all
}
