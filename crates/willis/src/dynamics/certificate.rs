//! Whether tooth forces and friction have exactly one solution, whatever the loads.

use super::mode::{Mode, Pattern, Side};
use super::system::System;

/// Sign patterns that are looked at, at most.
const MOST_PATTERNS: usize = 1 << 14;

/// Whether the force problem has exactly one solution in every rolling state: the determinants of the
/// equations have one sign for all directions of power. They are affine in each loss slope, so the
/// corners decide for everything between (theory of the W-property; Galvagno's paper does not ask).
/// `None`: too many meshes to look at all corners.
pub(super) fn rolling_is_unique(s: &System) -> Option<bool> {
    let lossy: Vec<usize> = (0..s.elements.len()).filter(|&j| !s.elements[j].is_lossless()).collect();
    if lossy.len() > 14 || 1usize << lossy.len() > MOST_PATTERNS {
        return None;
    }
    let range = |j: usize| {
        let rows = &s.elements[j].rows;
        let drive = rows.iter().map(|r| 1.0 - r.forward).fold(0.0, f64::max);
        let coast = rows.iter().map(|r| 1.0 - 1.0 / r.backward).fold(0.0, f64::min);
        (drive, coast)
    };
    let mut slopes = vec![0.0; s.elements.len()];
    for corner in 0..1usize << lossy.len() {
        for (k, &j) in lossy.iter().enumerate() {
            let (drive, coast) = range(j);
            slopes[j] = if corner >> k & 1 == 0 { drive } else { coast };
        }
        if s.determinant(&slopes) <= 1e-12 {
            return Some(false);
        }
    }
    Some(true)
}

/// Whether sticking and sliding off are decided in one way in every state: all principal minors of the matrix
/// that turns friction torques into slip accelerations are positive (or zero, where one holds what
/// others hold already), in every rolling pattern. `None`: too many to look at.
pub(super) fn sticking_is_unique(s: &System) -> Option<bool> {
    let lossy: Vec<usize> = (0..s.elements.len()).filter(|&j| !s.elements[j].is_lossless()).collect();
    let groups: Vec<usize> = (0..s.groups.len()).filter(|&g| !s.groups[g].driven).collect();
    if lossy.len() + groups.len() > 14 {
        return None;
    }
    for corner in 0..1usize << lossy.len() {
        let mut mode = Mode { slip: vec![1; s.groups.len()], side: vec![Side::Drive; s.elements.len()] };
        for (k, &j) in lossy.iter().enumerate() {
            mode.side[j] = if corner >> k & 1 == 0 { Side::Drive } else { Side::Coast };
        }
        let slopes: Vec<f64> = (0..s.elements.len())
            .map(|j| {
                let loss = s.elements[j].loss(0.0);
                if s.elements[j].is_lossless() { 0.0 } else { super::mode::slope(loss, mode.side[j]) }
            })
            .collect();
        let Some(pattern) = Pattern::new(s, &slopes) else { return Some(false) };
        let w = |g: usize, h: usize| {
            let (port, lead) = s.groups[h].lead;
            lead * pattern.slip[g * s.ports + port]
        };
        for subset in 1..1usize << groups.len() {
            let of: Vec<usize> =
                groups.iter().enumerate().filter(|(k, _)| subset >> k & 1 == 1).map(|(_, g)| *g).collect();
            let scale: f64 = of.iter().map(|&g| w(g, g).abs()).product();
            let minor = nalgebra::DMatrix::from_fn(of.len(), of.len(), |i, k| w(of[i], of[k])).determinant();
            if minor < -1e-9 * scale {
                return Some(false);
            }
        }
    }
    Some(true)
}
