//! A stretch as one affine map: accelerations and margins as sums over the speeds and over what sources give.
//!
//! In a mode everything is linear, and in a stretch most of what acts is constant or in proportion to a speed. Where all of it
//! is, the sums over the ports are made once: `a_i = c_i + Σ_k A_ik ω_k + Σ_s B_is T_s`, with the torque T_s of
//! each source that changes, and every margin likewise. A state then takes one small product.

use super::engine::Engine;
use super::margins::{Margin, NOISE};
use super::mode::{Map, Side};
use super::stretch::{Affine, Line, Steady, Watch};
use super::system::System;

/// A row that is being added up, with the amounts in its constant.
struct Row {
    of: Vec<f64>,
    amount: f64,
}

impl Row {
    fn plus(mut self, constant: f64) -> Self {
        self.of[0] += constant;
        self.amount += constant.abs();
        self
    }
}

impl Affine {
    /// The map of a mode in a stretch; none where something changes otherwise.
    pub fn new(engine: &Engine, steady: &Steady) -> Option<Self> {
        let s = &engine.system;
        let map = engine.map.as_deref()?;
        let other = !steady.sliding.is_empty()
            || !steady.elements.is_empty()
            || !s.elastic.is_empty()
            || s.prescribed > 0
            || engine.varying;
        if other {
            return None;
        }
        let rates =
            (map.response.chunks_exact(map.ports).take(s.free)).flat_map(|row| widen(s, steady, row, 1.0).of).collect();
        let each = steady.watches.iter().map(|watch| engine.affine_margins(steady, map, *watch));
        let margins = each.collect::<Option<Vec<_>>>().map(|all| {
            let (lines, rows): (Vec<Line>, Vec<Vec<f64>>) = all.into_iter().flatten().unzip();
            (lines, rows.concat())
        });
        let sources: Vec<usize> = steady.sources.iter().map(|(_, k)| *k).collect();
        let mut given = vec![0.0; 1 + s.all() + sources.len()];
        given[0] = 1.0;
        Some(Self { sources, given, rates, margins })
    }
}

/// A sum over the torques of the ports, as one over what is given.
fn widen(s: &System, steady: &Steady, row: &[f64], factor: f64) -> Row {
    let mut sum = Row { of: vec![0.0; 1 + s.all() + steady.sources.len()], amount: 0.0 };
    for (r, torque) in row.iter().zip(&steady.tau) {
        sum = sum.plus(factor * r * torque);
    }
    for &k in &steady.viscous {
        let f = &s.frictions[k];
        for (x, w) in sum.of[1..].iter_mut().zip(&f.row) {
            *x -= factor * row[f.port] * f.viscous * w;
        }
    }
    for (x, (port, _)) in sum.of[1 + s.all()..].iter_mut().zip(&steady.sources) {
        *x += factor * row[*port];
    }
    sum
}

impl Engine {
    /// The margins of what is watched, with their rows; none where one of them is not affine.
    fn affine_margins(&self, steady: &Steady, map: &Map, watch: Watch) -> Option<Vec<(Line, Vec<f64>)>> {
        let s = &self.system;
        let ports = |rows: &[f64], k: usize, factor| widen(s, steady, &rows[k * map.ports..][..map.ports], factor);
        match watch {
            Watch::Slip(g) => {
                let mut of = vec![0.0; 1 + s.all() + steady.sources.len()];
                let sign = f64::from(self.mode.slip[g]);
                of[1..].iter_mut().zip(&s.groups[g].row).for_each(|(x, r)| *x = sign * r);
                Some(vec![(Line { watch, noise: NOISE * 1e-3, constant: 0.0 }, of)])
            }
            Watch::Side(j) => {
                let loss = self.loss(j);
                let side = if self.mode.side[j] == Side::Drive { 1.0 } else { -1.0 };
                let sign = side * f64::from(self.mode.element_slip(s, j));
                let factor = sign * (loss.drive - loss.coast) * s.elements[j].factors[0];
                let row = ports(&map.response, s.all() + j, factor)
                    .plus(side * loss.drive_torque)
                    .plus(-side * loss.coast_torque);
                Some(vec![(Line { watch, noise: self.slack * NOISE, constant: row.amount }, row.of)])
            }
            Watch::Hold(g, _) => {
                let alike = |f: &usize| s.frictions[*f].torque.points().len() == 1 && steady.engaged[*f].is_some();
                if !s.groups[g].frictions.iter().all(alike) {
                    return None;
                }
                let capacity = self.capacity(g, true, steady.inside);
                let both =
                    [(1, capacity.forward), (-1, capacity.backward)].into_iter().filter(|(_, most)| most.is_finite());
                let margin = |(sign, most): (i8, f64)| {
                    let row = ports(&map.holding, g, f64::from(sign) * s.groups[g].lead.1).plus(most);
                    (Line { watch: Watch::Hold(g, sign), noise: self.slack * NOISE, constant: row.amount }, row.of)
                };
                Some(both.map(margin).collect())
            }
            Watch::Rest | Watch::Touch(_) | Watch::End(_) | Watch::Engage(_) => None,
        }
    }

    /// The map of the present stretch with what is given at a state, which is looked at; none where there is no such map.
    fn affine(&mut self, t: f64, x: &[f64]) -> Option<&Affine> {
        self.steady()?.affine.as_ref()?;
        self.look(t, x);
        let inside = self.inside;
        let all = self.system.all();
        // The sources ask the engine, in which the map stands.
        let mut affine = self.steady.as_mut().filter(|steady| steady.inside == inside)?.affine.take()?;
        affine.given[1..=all].copy_from_slice(&self.speed);
        for (given, k) in affine.given[1 + all..].iter_mut().zip(&affine.sources) {
            *given = self.source_torque(*k, t, x);
        }
        let slot = &mut self.steady.as_mut()?.affine;
        *slot = Some(affine);
        slot.as_ref()
    }

    /// Whether rates are found by the torques of the ports, from which energies follow, too.
    pub fn rates_by_ports(&self) -> bool {
        self.energies() > 0 || self.steady().is_none_or(|steady| steady.affine.is_none())
    }

    /// Accelerations at a state in the present stretch, where there is a map.
    pub fn solve_affinely(&mut self, t: f64, x: &[f64]) {
        let mut acceleration = std::mem::take(&mut self.acceleration);
        if let Some(affine) = self.affine(t, x) {
            for (a, row) in acceleration.iter_mut().zip(affine.rates.chunks_exact(affine.given.len())) {
                *a = row.iter().zip(&affine.given).map(|(r, x)| r * x).sum();
            }
        }
        self.acceleration = acceleration;
        if let Some(still) = &self.still {
            still.settle(&mut self.acceleration);
        }
    }

    /// Margins at a state in the present stretch; false where only its ports tell them.
    pub fn margins_affinely(&mut self, t: f64, x: &[f64], out: &mut Vec<Margin>) -> bool {
        let Some(affine) = self.affine(t, x) else { return false };
        let Some((lines, rows)) = &affine.margins else { return false };
        out.clear();
        for (line, row) in lines.iter().zip(rows.chunks_exact(affine.given.len())) {
            let (mut value, mut amounts) = (row[0], line.constant);
            for (r, x) in row[1..].iter().zip(&affine.given[1..]) {
                value += r * x;
                amounts += (r * x).abs();
            }
            out.push(Margin { watch: line.watch, value, noise: line.noise * amounts });
        }
        true
    }
}
