//! The efficiency of a gear with given mesh efficiencies, for the search.
//!
//! Torques on sun, ring and carrier of a set are as `1 : k ρ : -(1 + k ρ)`: ρ is the efficiency η of its meshes in a row where
//! power flows from the sun to the ring relative to the carrier, and `1 / η` where it flows back, so that the set loses
//! power either way. A set that turns as one loses nothing, ρ is 1. Speeds do not depend on losses. Which way power flows in
//! each set is not assumed: every choice is solved, and those that contradict themselves are left out. If one is left,
//! the gear has that efficiency.
//!
//! Source of the torques: G. Müller, *Epicyclic Drive Trains* (1982), basic efficiency of a set.

use super::layout::{GROUND, INPUT, Layout, MAX_SETS, MAX_SHAFTS, OUTPUT};
use super::measure::solve;

/// The most unknowns: a torque for each set, for each closed element, and that of the output.
const MOST: usize = MAX_SHAFTS - 1;
/// Speeds and torques below this, per unit at the input, are zeros with rounding.
const ZERO: f64 = 1e-9;

/// Output over input power of a gear when the input drives; none where no state of its torques drives the output, or more
/// than one does. `k` are the tooth ratios, `eta` is the efficiency of the meshes of a set in a row, `speeds` are those of
/// all shafts for speed 1 of the input.
pub(crate) fn efficiency(
    layout: &Layout,
    k: &[f64],
    eta: f64,
    speeds: &[f64; MAX_SHAFTS],
    closed: &[[u8; 2]],
) -> Option<f64> {
    let blocks = layout.blocks();
    let sets = k.len().min(MAX_SETS);
    let rolling = |set: usize| speeds[usize::from(blocks[3 * set])] - speeds[usize::from(blocks[3 * set + 2])];
    let mut rolls = [0; MAX_SETS];
    let mut count = 0;
    for set in (0..sets).filter(|set| rolling(*set).abs() > ZERO) {
        rolls[count] = set;
        count += 1;
    }
    let mut found: Option<f64> = None;
    for choice in 0..1_u32 << count {
        let mut own = [0.0; MAX_SETS];
        own[..sets].copy_from_slice(&k[..sets]);
        for (n, set) in rolls[..count].iter().enumerate() {
            own[*set] *= if choice >> n & 1 == 1 { eta.recip() } else { eta };
        }
        let Some(torques) = torques(layout, &own[..sets], closed) else { continue };
        let agrees = rolls[..count].iter().enumerate().all(|(n, set)| {
            let power = torques[*set] * rolling(*set);
            power.abs() < ZERO || (power < 0.0) == (choice >> n & 1 == 1)
        });
        if !agrees {
            continue;
        }
        let value = -torques[sets] * speeds[usize::from(OUTPUT)];
        match found {
            Some(before) if (before - value).abs() > ZERO => return None,
            _ => found = Some(value),
        }
    }
    found.filter(|value| *value > 0.0)
}

/// The torques of a gear for torque 1 at the input: that on the sun of every set, then that of the output from outside, then
/// those of the closed elements; none where they are not determined. From the balance of every shaft but the housing.
fn torques(layout: &Layout, k: &[f64], closed: &[[u8; 2]]) -> Option<[f64; MOST]> {
    let sets = k.len();
    let size = sets + 1 + closed.len();
    if size + 1 != layout.shafts() || size > MOST {
        return None;
    }
    // The housing has no row: it carries what is left.
    let row = |shaft: u8| usize::from(shaft) - usize::from(shaft > GROUND);
    let mut a = [[0.0_f64; MOST]; MOST];
    let mut add = |shaft: u8, column: usize, value: f64| {
        if shaft != GROUND {
            a[row(shaft)][column] += value;
        }
    };
    for (set, (k, three)) in k.iter().zip(layout.blocks().chunks(3)).enumerate() {
        add(three[0], set, -1.0);
        add(three[1], set, -k);
        add(three[2], set, 1.0 + k);
    }
    add(OUTPUT, sets, 1.0);
    for (e, [x, y]) in closed.iter().enumerate() {
        add(*x, sets + 1 + e, 1.0);
        add(*y, sets + 1 + e, -1.0);
    }
    let mut b = [0.0; MOST];
    b[row(INPUT)] = -1.0;
    solve(size, a, b, 1e-12)
}
