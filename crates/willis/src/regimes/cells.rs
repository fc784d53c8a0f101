//! The cells of speed and torque in which a configuration can run, and its efficiency in them.

use std::collections::{BTreeMap, BTreeSet};

use crate::exact::Rational;

use super::arrangement::{self, Cell, dot};
use super::setup::{MOST_TRIED, Pattern, Setup, TorqueCell};

/// Most patterns of drivers times cones of torques, over all regions, that are tried.
const MOST_CELLS: u128 = 1 << 13;
/// Most regions of speed.
const MOST_REGIONS: u128 = 1 << 14;

/// Speed and torque cells of a setup, before they are told.
pub(crate) struct Cells {
    pub planes: Vec<Vec<Rational>>,
    pub regions: Vec<Cell>,
    /// By region.
    pub torques: Vec<Vec<TorqueCell>>,
    /// For some drivers the train lies exactly on a self-locking threshold.
    pub singular: bool,
    by_signs: BTreeMap<Vec<i8>, usize>,
}

impl Cells {
    /// The region on these sides of the planes, if there is one.
    pub fn region(&self, signs: &[i8]) -> Option<usize> {
        self.by_signs.get(signs).copied()
    }

    /// The region of all opposite speeds.
    pub fn opposite(&self, region: usize) -> usize {
        self.by_signs[&reversed(&self.regions[region].signs)]
    }

    /// The place in the opposite region of the cell with all speeds and torques reversed.
    pub fn mirror(&self, region: usize, cell: &TorqueCell) -> usize {
        let mirrored = |t: &TorqueCell| {
            t.pattern == cell.pattern
                && t.signs.iter().zip(&cell.signs).all(|(a, b)| *a == -b)
                && t.torques.iter().zip(&cell.torques).all(|(a, b)| *a == -b.clone())
        };
        self.torques[self.opposite(region)].iter().position(mirrored).expect("every regime has its mirror image")
    }
}

fn reversed(signs: &[i8]) -> Vec<i8> {
    signs.iter().map(|s| -s).collect()
}

/// All cells, or how many there would be.
pub(crate) fn enumerate(setup: &Setup<'_>) -> Result<Cells, String> {
    let planes = setup.planes();
    let d = setup.base.len();
    let bound = arrangement::most_cells(planes.len(), d);
    let too_large = |what: String| {
        format!("{what}. Use `willis locate` for the regime of an operating point, or name fewer terminals")
    };
    if bound > MOST_REGIONS {
        return Err(too_large(format!(
            "{} planes cut the {d}-dimensional speed space into up to {bound} regions, more than the {MOST_REGIONS} that \
             are listed",
            planes.len()
        )));
    }
    // With several independent torques nothing is certified, and each pattern has its cones; one of
    // them and its mirror image count as one.
    let lossy = (0..setup.active.len()).filter(|&j| setup.lossy(j)).count();
    let cones = arrangement::most_cells(lossy + setup.terminals.len(), setup.independent_torques()) / 2;
    let patterns = 1u128.checked_shl(lossy as u32).unwrap_or(u128::MAX);
    if setup.torques > 1 && bound.saturating_mul(patterns).saturating_mul(cones) / 2 > MOST_CELLS {
        return Err(too_large(format!(
            "up to {bound} regions of speed, each with 2^{lossy} patterns of drivers and up to {cones} signs of the \
             torques: more than are listed"
        )));
    }
    let regions = setup.speed_cells(&planes);
    let by_signs: BTreeMap<Vec<i8>, usize> = regions.iter().enumerate().map(|(k, c)| (c.signs.clone(), k)).collect();
    let mut torques: Vec<Option<Vec<TorqueCell>>> = vec![None; regions.len()];
    let mut singular = false;
    for k in 0..regions.len() {
        if torques[k].is_some() {
            continue;
        }
        let (mut cells, odd) = setup.torque_cells(&regions[k].point).map_err(|n| {
            too_large(format!(
                "up to {} regions of speed, and in some of them {n} elements without proof that their drivers are the only \
                 ones (at most {MOST_TRIED} that load each other are tried)",
                regions.len()
            ))
        })?;
        singular |= odd;
        cells.sort_by(|a, b| b.signs.cmp(&a.signs));
        // All speeds and torques reversed: the same drivers, the same powers.
        let opposite = by_signs[&reversed(&regions[k].signs)];
        if opposite != k {
            torques[opposite] = Some(
                cells
                    .iter()
                    .map(|t| TorqueCell {
                        pattern: t.pattern.clone(),
                        signs: reversed(&t.signs),
                        torques: t.torques.iter().map(|x| -x.clone()).collect(),
                    })
                    .collect(),
            );
        }
        torques[k] = Some(cells);
    }
    Ok(Cells { planes, regions, torques: torques.into_iter().flatten().collect(), singular, by_signs })
}

/// Signs of the powers from outside, by terminal.
pub(crate) fn power_signs(setup: &Setup<'_>, base: &[Rational], torques: &[i8]) -> Vec<i8> {
    let power = |t: usize| dot(setup.terminal_speed(t), base).sign() * torques[t];
    (0..setup.terminals.len()).map(|t| if setup.is_end(t) { 0 } else { power(t) }).collect()
}

/// Output over input power; zero when all is dissipated, one when nothing flows.
pub(crate) fn efficiency_at(setup: &Setup<'_>, base: &[Rational], torques: &[Rational]) -> Rational {
    let (mut input, mut output) = (Rational::ZERO, Rational::ZERO);
    for t in (0..setup.terminals.len()).filter(|&t| !setup.is_end(t)) {
        let p = &dot(setup.terminal_speed(t), base) * &torques[t];
        match p.sign() {
            1 => input += p,
            _ => output -= p,
        }
    }
    if input.is_zero() { Rational::ONE } else { output / input }
}

/// Its limit on a direction that bounds a region, coming from a point inside.
pub(crate) fn efficiency_towards(
    setup: &Setup<'_>,
    ray: &[Rational],
    inside: &[Rational],
    pattern: &Pattern,
    torques: &[Rational],
) -> Rational {
    let there = setup.torques_at(pattern, inside, torques, ray);
    // With everything at rest that is loaded, all powers vanish alike.
    let outside = (0..there.len()).filter(|&t| !setup.is_end(t));
    let still = outside.into_iter().all(|t| there[t].is_zero() || dot(setup.terminal_speed(t), ray).is_zero());
    if still { efficiency_at(setup, inside, torques) } else { efficiency_at(setup, ray, &there) }
}

/// The least and the greatest efficiency between two directions that bound a region, where there is a link: torques that
/// are linear in the speeds make it a quotient with an extremum perhaps, which is looked for.
pub(crate) fn efficiency_between(setup: &Setup<'_>, pattern: &Pattern, rays: [&Vec<Rational>; 2]) -> [f64; 2] {
    const PARTS: usize = 128;
    // Torques and speeds at the two directions; between them both are linear.
    let ends = rays.map(|ray| {
        let size = ray.iter().map(Rational::abs).max().filter(|s| !s.is_zero()).unwrap_or(Rational::ONE);
        let unit: Vec<Rational> = ray.iter().map(|x| x / &size).collect();
        let torques = setup.torques_through(pattern, &unit);
        let speeds = (0..setup.terminals.len()).map(|t| dot(setup.terminal_speed(t), &unit));
        let both: Vec<[f64; 2]> = speeds.zip(torques).map(|(w, t)| [w.to_f64(), t.to_f64()]).collect();
        both
    });
    let at = |part: f64| {
        let (mut input, mut output) = (0.0, 0.0);
        for t in (0..setup.terminals.len()).filter(|&t| !setup.is_end(t)) {
            let [w, torque] = [0, 1].map(|k| (1.0 - part) * ends[0][t][k] + part * ends[1][t][k]);
            let p = w * torque;
            if p > 0.0 { input += p } else { output -= p }
        }
        // The torques may all have the other sign.
        if input > 0.0 && output > 0.0 { (output / input).min(input / output) } else { 0.0 }
    };
    let of = |k: usize| k as f64 / PARTS as f64;
    let extremum = |better: &dyn Fn(f64, f64) -> bool| {
        let inside = 1..PARTS;
        let best = inside.reduce(|a, b| if better(at(of(b)), at(of(a))) { b } else { a }).unwrap_or(1);
        let (mut low, mut high) = (of(best - 1), of(best + 1));
        for _ in 0..80 {
            let third = (high - low) / 3.0;
            if better(at(low + third), at(high - third)) { high -= third } else { low += third }
        }
        let found = at((low + high) / 2.0);
        if better(found, at(of(best))) { found } else { at(of(best)) }
    };
    [extremum(&|a, b| a < b), extremum(&|a, b| a > b)]
}

/// Region and torque signs of every regime of the same train without losses, in the regions of that with losses.
pub(crate) fn without_friction(setup: &Setup<'_>, cells: &Cells) -> BTreeSet<(usize, Vec<i8>)> {
    let mut ideal = setup.clone();
    for e in &mut ideal.c.elements {
        (e.forward, e.backward) = (Rational::ONE, Rational::ONE);
    }
    if let Some(link) = &mut ideal.link {
        link.efficiency = [Rational::ONE, Rational::ONE];
    }
    let all = cells.regions.iter().enumerate().flat_map(|(k, region)| {
        let cells = ideal.torque_cells(&region.point).map_or(vec![], |(cells, _)| cells);
        cells.into_iter().map(move |c| (k, c.signs))
    });
    all.collect()
}
