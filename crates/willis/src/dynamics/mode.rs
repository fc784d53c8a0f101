//! Modes of motion, and the linear map that each of them is.

use std::collections::HashMap;
use std::sync::Arc;

use super::element::Loss;
use super::rounding::unless_rounding;
use super::system::System;

/// Which side of its kink a mesh's loss is on: whose gear drives.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Hash)]
pub(super) enum Side {
    /// The first gear drives.
    Drive,
    /// The second gear drives.
    Coast,
}

impl Side {
    pub fn other(self) -> Self {
        match self {
            Self::Drive => Self::Coast,
            Self::Coast => Self::Drive,
        }
    }
}

/// What every group and every mesh does.
#[derive(Clone, PartialEq, Eq, Debug, Hash)]
pub(super) struct Mode {
    /// By group: the sign of its slip, 0 where it is held.
    pub slip: Vec<i8>,
    /// By element.
    pub side: Vec<Side>,
}

impl Mode {
    /// Sign of the speed of an element's first gear relative to its carrier.
    pub fn element_slip(&self, system: &System, element: usize) -> i8 {
        match system.elements[element].group {
            Some((g, factor)) => self.slip[g] * factor.signum() as i8,
            None => 0,
        }
    }

    /// The loss slope of an element whose efficiencies are constant; 0 where it is held.
    fn slope(&self, system: &System, element: usize) -> f64 {
        let e = &system.elements[element];
        if e.group.is_none() || e.varies() || self.element_slip(system, element) == 0 {
            return 0.0;
        }
        slope(e.loss(0.0), self.side[element])
    }
}

pub(super) fn slope(loss: Loss, side: Side) -> f64 {
    match side {
        Side::Drive => loss.drive,
        Side::Coast => loss.coast,
    }
}

/// Accelerations, forces and holding torques as a linear map of the torques of the ports.
#[derive(Clone, Debug)]
pub(super) struct Map {
    pub ports: usize,
    /// Unknowns × ports: accelerations of the free coordinates, torques behind prescribed speeds, forces of
    /// the elements.
    pub response: Vec<f64>,
    /// Groups × ports: torque at the lead port of each held group; zero rows elsewhere.
    pub holding: Vec<f64>,
    /// Groups held by others: their own share is not determined.
    pub carried: Vec<bool>,
    /// Groups whose share is open for that reason: those, and others that could take over from them.
    pub open_groups: Vec<bool>,
    /// Unknowns that depend on how such groups share.
    pub open_unknowns: Vec<bool>,
}

impl Map {
    /// Row of the response, times the port torques.
    #[inline]
    pub fn unknown(&self, row: usize, tau: &[f64]) -> f64 {
        dot(&self.response[row * self.ports..(row + 1) * self.ports], tau)
    }

    /// The same with its amounts added up: the size of its round-off.
    #[inline]
    pub fn size(&self, row: usize, tau: &[f64]) -> f64 {
        dot_size(&self.response[row * self.ports..(row + 1) * self.ports], tau)
    }

    #[inline]
    pub fn held(&self, group: usize, tau: &[f64]) -> f64 {
        dot(&self.holding[group * self.ports..(group + 1) * self.ports], tau)
    }

    #[inline]
    pub fn held_size(&self, group: usize, tau: &[f64]) -> f64 {
        dot_size(&self.holding[group * self.ports..(group + 1) * self.ports], tau)
    }

    pub fn is_redundant(&self) -> bool {
        self.carried.iter().any(|c| *c)
    }
}

/// Sum of products, in four partial sums: one alone waits for each addition.
#[inline(always)]
pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len().min(b.len());
    let (a, b) = (&a[..n], &b[..n]);
    let mut sums = [0.0; 4];
    let (fours_a, fours_b) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours_a.remainder().iter().zip(fours_b.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in fours_a.zip(fours_b) {
        for k in 0..4 {
            sums[k] += x[k] * y[k];
        }
    }
    (sums[0] + sums[2]) + (sums[1] + sums[3]) + rest
}

#[inline]
pub(super) fn dot_size(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x * y).abs()).sum()
}

/// What follows from the loss slopes alone: unknowns × ports, and slip accelerations of all groups × ports.
#[derive(Clone)]
pub(super) struct Pattern {
    pub ports: usize,
    pub response: Vec<f64>,
    pub slip: Vec<f64>,
}

impl Pattern {
    pub fn new(system: &System, slopes: &[f64], resists: &[f64]) -> Option<Self> {
        let x = system.response(slopes, resists)?;
        let (n, p) = (system.unknowns(), system.ports);
        let mut response = vec![0.0; n * p];
        for i in 0..n {
            for k in 0..p {
                response[i * p + k] = x[(i, k)];
            }
        }
        let mut slip = vec![0.0; system.groups.len() * p];
        for (g, group) in system.groups.iter().enumerate() {
            let row = &mut slip[g * p..(g + 1) * p];
            for (k, entry) in row.iter_mut().enumerate() {
                let parts = group.row[..system.free].iter().enumerate().map(|(i, d)| d * response[i * p + k]);
                let (sum, amounts) = parts.fold((0.0, 0.0), |(sum, amounts), x: f64| (sum + x, amounts + x.abs()));
                *entry = unless_rounding(sum, amounts);
            }
            for i in 0..system.prescribed {
                row[system.port_of_prescribed + i] += group.row[system.free + i];
            }
        }
        Some(Self { ports: p, response, slip })
    }

    /// With one more port for each group, which adds to its slip acceleration and to nothing else: what a step
    /// of fixed length has to take away to end at rest.
    pub fn with_slips(&self, groups: usize) -> Self {
        let widen = |rows: &[f64]| -> Vec<f64> {
            let zeros = std::iter::repeat_n(0.0, groups);
            rows.chunks_exact(self.ports).flat_map(|row| row.iter().copied().chain(zeros.clone())).collect()
        };
        let ports = self.ports + groups;
        let mut slip = widen(&self.slip);
        for g in 0..groups {
            slip[g * ports + self.ports + g] = 1.0;
        }
        Self { ports, response: widen(&self.response), slip }
    }
}

/// The maps met so far.
#[derive(Clone, Default)]
pub(super) struct Maps {
    patterns: HashMap<Vec<u8>, Option<Arc<Pattern>>>,
    by_mode: HashMap<Mode, usize>,
    maps: Vec<Option<Arc<Map>>>,
}

impl Maps {
    fn pattern_key(system: &System, mode: &Mode) -> Vec<u8> {
        (0..system.elements.len())
            .map(|j| {
                let e = &system.elements[j];
                if e.group.is_none() || e.varies() || mode.element_slip(system, j) == 0 {
                    0
                } else {
                    1 + u8::from(mode.side[j] == Side::Coast)
                }
            })
            .collect()
    }

    pub fn pattern(&mut self, system: &System, mode: &Mode) -> Option<&Pattern> {
        self.pattern_with(system, mode, &[])
    }

    /// The same where each shaft resists its relative acceleration.
    pub fn pattern_with(&mut self, system: &System, mode: &Mode, resists: &[f64]) -> Option<&Pattern> {
        let mut key = Self::pattern_key(system, mode);
        key.extend(resists.iter().flat_map(|d| d.to_bits().to_le_bytes()));
        self.patterns
            .entry(key)
            .or_insert_with(|| {
                let slopes: Vec<f64> = (0..system.elements.len()).map(|j| mode.slope(system, j)).collect();
                Pattern::new(system, &slopes, resists).map(Arc::new)
            })
            .as_deref()
    }

    /// The map of a mode in which no element of varying slope moves; `None` if it has no unique solution.
    pub fn find(&mut self, system: &System, mode: &Mode) -> Option<Arc<Map>> {
        if let Some(&k) = self.by_mode.get(mode) {
            return self.maps[k].clone();
        }
        let map = self.pattern(system, mode).and_then(|pattern| compose(system, mode, pattern, &[]));
        self.maps.push(map.map(Arc::new));
        self.by_mode.insert(mode.clone(), self.maps.len() - 1);
        self.maps[self.maps.len() - 1].clone()
    }
}

/// Eliminates the torques that hold groups, and the losses of elements whose slopes `varying` (element, slope)
/// depend on speed, from a pattern.
///
/// Groups that are held already by others get no torque of their own.
pub(super) fn compose(system: &System, mode: &Mode, pattern: &Pattern, varying: &[(usize, f64)]) -> Option<Map> {
    let (n, p, all) = (system.unknowns(), pattern.ports, system.all());
    let held: Vec<usize> =
        (0..system.groups.len()).filter(|&g| mode.slip[g] == 0 && !system.groups[g].driven).collect();
    // Rows of conditions `row · τ = 0` over all ports, each solved for one port.
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let mut unknown: Vec<usize> = Vec::new();
    let mut scales: Vec<f64> = Vec::new();
    for &(j, slope) in varying {
        // L − α a f(τ) = β, the given torque of the port being β.
        let a = system.elements[j].factors[0];
        let mut row: Vec<f64> =
            pattern.response[(all + j) * p..(all + j + 1) * p].iter().map(|x| -slope * a * x).collect();
        let port = system.elements[j].port;
        row[port] += 1.0;
        rows.push(row);
        unknown.push(port);
        scales.push(1.0);
    }
    for &g in &held {
        rows.push(pattern.slip[g * p..(g + 1) * p].to_vec());
        unknown.push(system.groups[g].lead.0);
        scales.push(pattern.slip[g * p + system.groups[g].lead.0].abs());
    }
    let count = unknown.len();
    // Right sides: over all ports, the unknown ones excluded, but for β.
    let mut rights: Vec<Vec<f64>> = (rows.iter().enumerate())
        .map(|(i, row)| {
            let mut right: Vec<f64> = row.iter().map(|x| -x).collect();
            for (k, &port) in unknown.iter().enumerate() {
                right[port] = if k == i && i < varying.len() { 1.0 } else { 0.0 };
            }
            right
        })
        .collect();
    let mut matrix: Vec<Vec<f64>> = rows.iter().map(|row| unknown.iter().map(|&port| row[port]).collect()).collect();
    // What the conditions add up to in amounts, by which their solution may be wrong in its last places.
    let mut amounts: Vec<Vec<f64>> = rights.iter().map(|right| right.iter().map(|x| x.abs()).collect()).collect();
    // Gauss–Jordan; a condition that others fulfil already has nothing left to be solved for.
    let mut carried = vec![false; system.groups.len()];
    let mut solved = vec![false; count];
    for i in 0..count {
        let pivot = matrix[i][i];
        let original = if i < varying.len() { 1.0 } else { scales[i] };
        if pivot.abs() <= 1e-9 * original || pivot == 0.0 {
            if i < varying.len() {
                return None;
            }
            carried[held[i - varying.len()]] = true;
            continue;
        }
        solved[i] = true;
        for r in 0..count {
            if r == i {
                continue;
            }
            let factor = matrix[r][i] / pivot;
            if factor != 0.0 {
                for c in 0..count {
                    let x = matrix[i][c];
                    matrix[r][c] -= factor * x;
                }
                for c in 0..p {
                    let (x, size) = (rights[i][c], amounts[i][c]);
                    rights[r][c] -= factor * x;
                    amounts[r][c] += (factor * size).abs();
                }
            }
        }
    }
    // What a torque of a group that carries nothing would change.
    let mut open_groups = carried.clone();
    let mut open_unknowns = vec![false; n];
    for c in (0..count).filter(|&c| !solved[c]) {
        let taken: Vec<f64> = (0..count)
            .map(|i| if solved[i] { -matrix[i][c] / matrix[i][i] } else { f64::from(u8::from(i == c)) })
            .collect();
        let most = taken.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        for (i, share) in taken.iter().enumerate().skip(varying.len()) {
            open_groups[held[i - varying.len()]] |= share.abs() > 1e-9 * most;
        }
        for (row, open) in open_unknowns.iter_mut().enumerate() {
            let parts = unknown.iter().zip(&taken).map(|(&port, share)| pattern.response[row * p + port] * share);
            let (sum, size) = parts.fold((0.0, 0.0f64), |(sum, size), x| (sum + x, size + x.abs()));
            *open |= sum.abs() > 1e-9 * size;
        }
    }
    let mut holding = vec![0.0; system.groups.len() * p];
    let mut response = pattern.response.clone();
    let mut size = vec![0.0; p];
    // Columns of unknown ports act through their solution only.
    for row in 0..n {
        let line = &mut response[row * p..(row + 1) * p];
        let weights: Vec<f64> = unknown.iter().map(|&port| std::mem::take(&mut line[port])).collect();
        size.iter_mut().zip(&*line).for_each(|(size, x)| *size = x.abs());
        for i in (0..count).filter(|&i| solved[i] && weights[i] != 0.0) {
            let w = weights[i] / matrix[i][i];
            for c in 0..p {
                line[c] += w * rights[i][c];
                size[c] += w.abs() * amounts[i][c];
            }
        }
        line.iter_mut().zip(&size).for_each(|(x, size)| *x = unless_rounding(*x, *size));
    }
    for (k, &g) in held.iter().enumerate() {
        let i = varying.len() + k;
        if solved[i] {
            for c in 0..p {
                holding[g * p + c] = unless_rounding(rights[i][c], amounts[i][c]) / matrix[i][i];
            }
        }
    }
    let map = Map { ports: p, response, holding, carried, open_groups, open_unknowns };
    map.response.iter().all(|x| x.is_finite()).then_some(map)
}
