//! The state at the start of a scenario.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic, Diagnostics, apart};
use crate::train::MemberId;

use super::engine::Engine;
use super::integrator::Smooth;
use super::rounding::short;

/// Difference between speeds, relative to them, up to which they are the same number written down: what the program
/// prints it takes back.
pub(super) const AS_WRITTEN: f64 = 1e-9;

/// The state at the start, without energies; the engine looks at it.
pub(super) fn initial_state(engine: &mut Engine) -> Result<Vec<f64>, Diagnostics> {
    let start = engine.system.scenario.start;
    engine.inside = start;
    let mut x = vec![0.0; engine.states() + engine.quadratures()];
    initial_speeds(engine, &mut x)?;
    engine.look(start, &x);
    engine.rescale(&x);
    Ok(x)
}

/// A condition on the speeds at the start: a sum of speeds of members.
struct Condition {
    what: What,
    /// Over all coordinates.
    row: Vec<f64>,
    /// What its entries are made of, in amounts.
    size: Vec<f64>,
    /// What it is worth.
    value: f64,
}

impl Condition {
    fn new(what: What, row: &[f64], value: f64) -> Self {
        Self { what, row: row.to_vec(), size: row.iter().map(|x| x.abs()).collect(), value }
    }
}

/// Whose condition it is.
#[derive(Clone, Copy)]
enum What {
    /// The speed of a member, as it is given.
    Given(MemberId),
    /// The ratio of a variator: its position among the paths, and the ratio.
    Ratio(usize, f64),
    /// What is left is at rest.
    Rest,
}

/// Sets the speeds of the start: those given, those that variators settle, others at rest as far as the gears leave them
/// free.
fn initial_speeds(engine: &mut Engine, x: &mut [f64]) -> Result<(), Diagnostics> {
    let start = engine.system.scenario.start;
    engine.first_ratios(x);
    engine.look(start, x);
    let s = &engine.system;
    let free = s.free;
    // In order of preference.
    let mut conditions: Vec<Condition> = Vec::new();
    for &(m, value) in &s.scenario.initial_speeds {
        conditions.push(Condition::new(What::Given(m), &s.speeds[m.index()], value));
    }
    for (k, members, ratio) in engine.known_ratios(start, x) {
        let [p, q] = members.map(|m| &s.speeds[m.index()]);
        let size: Vec<f64> = p.iter().zip(q).map(|(p, q)| p.abs() + (ratio * q).abs()).collect();
        // Where gears make the same ratio, what is left of a coordinate is round-off.
        let left =
            |((p, q), size): ((&f64, &f64), &f64)| Some(p - ratio * q).filter(|x| x.abs() > 4.0 * f64::EPSILON * size);
        let row = p.iter().zip(q).zip(&size).map(|parts| left(parts).unwrap_or(0.0)).collect();
        conditions.push(Condition { what: What::Ratio(k, ratio), row, size, value: 0.0 });
    }
    // What has no inertia turns as what acts on it will have it.
    for (_, row) in &s.followers {
        conditions.push(Condition::new(What::Rest, row, 0.0));
    }
    for &m in &s.coordinates[..free] {
        conditions.push(Condition::new(What::Rest, &s.speeds[m.index()], 0.0));
    }
    let prescribed = |row: &[f64]| -> f64 { row[free..].iter().zip(&engine.speed[free..]).map(|(a, b)| a * b).sum() };
    let mut taken: Vec<&Condition> = Vec::new();
    for condition in &conditions {
        let mut matrix: Vec<&[f64]> = taken.iter().map(|c| &c.row[..free]).collect();
        matrix.push(&condition.row[..free]);
        let m = DMatrix::from_fn(matrix.len(), free, |i, k| matrix[i][k]);
        let norms: Vec<f64> = (0..m.nrows()).map(|i| m.row(i).norm()).collect();
        let independent = norms.iter().all(|n| *n > 0.0)
            && taken.len() < free
            && DMatrix::from_fn(m.nrows(), free, |i, k| m[(i, k)] / norms[i]).rank(1e-10) == m.nrows();
        if independent {
            taken.push(condition);
        }
    }
    let a = DMatrix::from_fn(taken.len(), free, |i, k| taken[i].row[k]);
    let b = DVector::from_fn(taken.len(), |i, _| taken[i].value - prescribed(&taken[i].row));
    if free > 0 {
        let v = a.lu().solve(&b).unwrap_or_else(|| DVector::zeros(free));
        x[..free].copy_from_slice(v.as_slice());
    }
    for Condition { what, row, size, value } in &conditions {
        let sum = |row: &[f64], of: fn(f64) -> f64| -> f64 {
            row.iter().zip(x[..free].iter().chain(&engine.speed[free..])).map(|(a, b)| a * of(*b)).sum()
        };
        let (is, size) = (sum(row, |x| x), sum(size, f64::abs));
        if (is - value).abs() <= s.train.speed_tolerance().max(AS_WRITTEN) * (size + value.abs()) {
            continue;
        }
        let (place, message) = match what {
            What::Rest => continue,
            What::Given(m) => {
                let name = s.train.member_name(*m);
                let [given, follows] = apart(*value, is, |x| short(x).to_string());
                let message = format!(
                    "`{name}` cannot start at {given} rad/s: the gears and the other speeds given make it {follows} rad/s"
                );
                (format!("{}.initial_speeds.{name}", s.scenario.place), message)
            }
            What::Ratio(k, ratio) => {
                let path = &s.paths[*k];
                let control = &s.scenario.controls[path.control.expect("its ratio is given")];
                let message = format!(
                    "`{}` cannot start with its ratio of {}: the speeds given make another one",
                    s.train.variators()[path.variator].name,
                    short(*ratio)
                );
                (control.place.clone(), message)
            }
        };
        let error = Diagnostic::new(Code::ContradictorySpeeds, place, message);
        return Err(error.hint("leave out one of the speeds").into());
    }
    Ok(())
}
