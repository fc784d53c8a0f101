//! Modes of motion, and the linear map that each of them is.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};
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

/// Mixes the words of a key: the few modes of a train need no defence against chosen keys.
#[derive(Clone, Copy, Default)]
pub(super) struct Mix(u64);

impl Hasher for Mix {
    fn finish(&self) -> u64 {
        self.0 ^ self.0 >> 32
    }
    fn write(&mut self, bytes: &[u8]) {
        for eight in bytes.chunks(8) {
            self.write_u64(eight.iter().fold(0, |word, b| word << 8 | u64::from(*b)));
        }
    }
    fn write_u64(&mut self, word: u64) {
        self.0 = (self.0.rotate_left(25) ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }
}

/// By key of a mode.
pub(super) type ByKey<K, V = u32> = HashMap<K, V, BuildHasherDefault<Mix>>;

/// What every group and every mesh does.
#[derive(Clone, PartialEq, Eq, Debug)]
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
        let response = system.response(slopes, resists)?;
        let p = system.ports;
        let mut slip = vec![0.0; system.groups.len() * p];
        let mut amounts = vec![0.0; p];
        for (row, group) in slip.chunks_exact_mut(p).zip(&system.groups) {
            amounts.fill(0.0);
            for (d, line) in group.row[..system.free].iter().zip(response.chunks_exact(p)).filter(|(d, _)| **d != 0.0) {
                for ((sum, amount), x) in row.iter_mut().zip(&mut amounts).zip(line) {
                    *sum += d * x;
                    *amount += (d * x).abs();
                }
            }
            row.iter_mut().zip(&amounts).for_each(|(sum, amounts)| *sum = unless_rounding(*sum, *amounts));
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
    patterns: ByKey<Vec<u8>, Option<Arc<Pattern>>>,
    maps: ByKey<Vec<u8>, Option<Arc<Map>>>,
    /// Room for a key.
    key: Vec<u8>,
}

impl Maps {
    /// What a pattern depends on: by element whether it loses, and which gear drives.
    fn pattern_key<'a>(system: &'a System, mode: &'a Mode) -> impl Iterator<Item = u8> + 'a {
        (0..system.elements.len()).map(|j| {
            let e = &system.elements[j];
            if e.group.is_none() || e.varies() || mode.element_slip(system, j) == 0 {
                0
            } else {
                1 + u8::from(mode.side[j] == Side::Coast)
            }
        })
    }

    pub fn pattern(&mut self, system: &System, mode: &Mode) -> Option<&Pattern> {
        self.pattern_with(system, mode, &[])
    }

    /// The same where each shaft resists its relative acceleration.
    pub fn pattern_with(&mut self, system: &System, mode: &Mode, resists: &[f64]) -> Option<&Pattern> {
        let mut key: Vec<u8> = Self::pattern_key(system, mode).collect();
        key.extend(resists.iter().flat_map(|d| d.to_bits().to_le_bytes()));
        self.patterns
            .entry(key)
            .or_insert_with(|| {
                let slopes: Vec<f64> = (0..system.elements.len()).map(|j| mode.slope(system, j)).collect();
                Pattern::new(system, &slopes, resists).map(Arc::new)
            })
            .as_deref()
    }

    /// The map of a mode in which no element of varying slope moves; `None` if it has no unique solution. Which way
    /// things slide does not matter to it.
    pub fn find(&mut self, system: &System, mode: &Mode) -> Option<Arc<Map>> {
        self.key.clear();
        self.key.extend(Self::pattern_key(system, mode));
        self.key.extend(system.groups.iter().zip(&mode.slip).map(|(g, slip)| u8::from(*slip == 0 && !g.driven)));
        if let Some(map) = self.maps.get(&self.key) {
            return map.clone();
        }
        let key = self.key.clone();
        let map = self.pattern(system, mode).and_then(|pattern| compose(system, mode, pattern, &[])).map(Arc::new);
        self.maps.insert(key, map.clone());
        map
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
    // Conditions `row · τ = 0` over all ports, each solved for one port.
    let slopes = varying.iter().map(|&(j, _)| system.elements[j].port);
    let unknown: Vec<usize> = slopes.chain(held.iter().map(|&g| system.groups[g].lead.0)).collect();
    let count = unknown.len();
    let mut matrix = vec![0.0; count * count];
    // Right sides: over all ports, the unknown ones excluded, but for β.
    let mut rights = vec![0.0; count * p];
    for (i, right) in rights.chunks_exact_mut(p).enumerate() {
        match varying.get(i) {
            // L − α a f(τ) = β, the given torque of the port being β.
            Some(&(j, slope)) => {
                let (a, force) = (system.elements[j].factors[0], &pattern.response[(all + j) * p..(all + j + 1) * p]);
                right.iter_mut().zip(force).for_each(|(x, f)| *x = slope * a * f);
                right[system.elements[j].port] -= 1.0;
            }
            None => {
                let slip = &pattern.slip[held[i - varying.len()] * p..][..p];
                right.iter_mut().zip(slip).for_each(|(x, slip)| *x = -slip);
            }
        }
        for (k, &port) in unknown.iter().enumerate() {
            matrix[i * count + k] = -std::mem::take(&mut right[port]);
        }
        if i < varying.len() {
            right[unknown[i]] = 1.0;
        }
    }
    let original: Vec<f64> =
        (0..count).map(|i| if i < varying.len() { 1.0 } else { matrix[i * count + i].abs() }).collect();
    // What the conditions add up to in amounts, by which their solution may be wrong in its last places.
    let mut amounts: Vec<f64> = rights.iter().map(|x| x.abs()).collect();
    // Gauss–Jordan; a condition that others fulfil already has nothing left to be solved for.
    let mut carried = vec![false; system.groups.len()];
    let mut solved = vec![false; count];
    let (mut line, mut right, mut sizes) = (vec![0.0; count], vec![0.0; p], vec![0.0; p]);
    for i in 0..count {
        let pivot = matrix[i * count + i];
        if pivot.abs() <= 1e-9 * original[i] || pivot == 0.0 {
            if i < varying.len() {
                return None;
            }
            carried[held[i - varying.len()]] = true;
            continue;
        }
        solved[i] = true;
        line.copy_from_slice(&matrix[i * count..(i + 1) * count]);
        right.copy_from_slice(&rights[i * p..(i + 1) * p]);
        sizes.copy_from_slice(&amounts[i * p..(i + 1) * p]);
        for r in (0..count).filter(|&r| r != i) {
            let factor = matrix[r * count + i] / pivot;
            if factor != 0.0 {
                let of = |rows: usize| r * rows..(r + 1) * rows;
                matrix[of(count)].iter_mut().zip(&line).for_each(|(x, y)| *x -= factor * y);
                rights[of(p)].iter_mut().zip(&right).for_each(|(x, y)| *x -= factor * y);
                amounts[of(p)].iter_mut().zip(&sizes).for_each(|(x, y)| *x += (factor * y).abs());
            }
        }
    }
    // What a torque of a group that carries nothing would change.
    let mut open_groups = carried.clone();
    let mut open_unknowns = vec![false; n];
    for c in (0..count).filter(|&c| !solved[c]) {
        let taken: Vec<f64> =
            (0..count)
                .map(|i| {
                    if solved[i] { -matrix[i * count + c] / matrix[i * count + i] } else { f64::from(u8::from(i == c)) }
                })
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
    let mut weights = vec![0.0; count];
    // Columns of unknown ports act through their solution only.
    for row in 0..n {
        let line = &mut response[row * p..(row + 1) * p];
        weights.iter_mut().zip(&unknown).for_each(|(w, &port)| *w = std::mem::take(&mut line[port]));
        size.iter_mut().zip(&*line).for_each(|(size, x)| *size = x.abs());
        for i in (0..count).filter(|&i| solved[i] && weights[i] != 0.0) {
            let w = weights[i] / matrix[i * count + i];
            let of = i * p..(i + 1) * p;
            line.iter_mut().zip(&rights[of.clone()]).for_each(|(x, y)| *x += w * y);
            size.iter_mut().zip(&amounts[of]).for_each(|(x, y)| *x += w.abs() * y);
        }
        line.iter_mut().zip(&size).for_each(|(x, size)| *x = unless_rounding(*x, *size));
    }
    for (k, &g) in held.iter().enumerate() {
        let i = varying.len() + k;
        if solved[i] {
            for c in 0..p {
                let sum = unless_rounding(rights[i * p + c], amounts[i * p + c]);
                holding[g * p + c] = sum / matrix[i * count + i];
            }
        }
    }
    let map = Map { ports: p, response, holding, carried, open_groups, open_unknowns };
    map.response.iter().all(|x| x.is_finite()).then_some(map)
}
