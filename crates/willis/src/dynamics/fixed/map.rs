//! The map of a mode, flat, for a step.

use crate::dynamics::mode::{Mode, Pattern, Side, compose};
use crate::dynamics::system::System;

/// The map of a mode, flat: rows over ports and slips.
#[derive(Clone)]
pub(in crate::dynamics) struct StepMap {
    /// Accelerations of the free coordinates, then holding torques of `held`, then torques of `moving`.
    pub rows: Vec<f64>,
    pub held: Vec<u16>,
    pub moving: Vec<u16>,
    /// Torques at the first gears of the elements of held groups, in the order of `held`.
    pub still: Vec<(u16, Vec<f64>)>,
    /// Whether some of what is held is held several times over.
    pub is_redundant: bool,
    /// Torques behind prescribed speeds.
    pub reactions: Vec<f64>,
}

/// Key of a map: which groups are held, and the sides of what moves.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub(super) struct Key {
    pub held: u64,
    pub coast: u64,
    /// The contacts of the shafts.
    pub touch: u64,
}

impl Key {
    /// A mode of that key; which way things slide does not matter to its map.
    pub fn mode(self, s: &System) -> Mode {
        Mode {
            slip: (0..s.groups.len()).map(|g| i8::from(self.held >> g & 1 == 0)).collect(),
            side: (0..s.elements.len())
                .map(|j| if self.coast >> j & 1 == 1 { Side::Coast } else { Side::Drive })
                .collect(),
        }
    }
}

/// The flat map of a mode.
pub(super) fn step_map(s: &System, mode: &Mode, pattern: &Pattern) -> Option<StepMap> {
    let wide = pattern.with_slips(s.groups.len());
    let map = compose(s, mode, &wide, &[])?;
    let cols = wide.ports;
    let torque_row = |j: usize| -> Vec<f64> {
        let row = &map.response[(s.all() + j) * cols..(s.all() + j + 1) * cols];
        row.iter().map(|x| x * s.elements[j].factors[0]).collect()
    };
    let mut rows: Vec<f64> = map.response[..s.free * cols].to_vec();
    let held: Vec<u16> =
        (0..s.groups.len()).filter(|&g| mode.slip[g] == 0 && !s.groups[g].driven).map(|g| g as u16).collect();
    for &g in &held {
        rows.extend_from_slice(&map.holding[usize::from(g) * cols..(usize::from(g) + 1) * cols]);
    }
    let mut moving = Vec::new();
    for (j, e) in s.elements.iter().enumerate() {
        let Some((g, _)) = e.group else { continue };
        let torque = torque_row(j);
        if mode.slip[g] != 0 || s.groups[g].driven {
            moving.push(j as u16);
            rows.extend_from_slice(&torque);
        }
    }
    let still =
        (held.iter()).flat_map(|&g| &s.groups[usize::from(g)].elements).map(|&j| (j as u16, torque_row(j))).collect();
    let reactions = map.response[s.free * cols..s.all() * cols].to_vec();
    Some(StepMap { rows, held, moving, still, is_redundant: map.is_redundant(), reactions })
}
