//! The state at the start of a scenario.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic, Diagnostics, apart};
use crate::train::MemberId;

use super::engine::Engine;
use super::event::short;
use super::integrator::Smooth;

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

/// Sets the speeds of the start: those given, others at rest as far as the gears leave them free.
fn initial_speeds(engine: &mut Engine, x: &mut [f64]) -> Result<(), Diagnostics> {
    let start = engine.system.scenario.start;
    engine.look(start, x);
    let s = &engine.system;
    let free = s.free;
    // Rows of conditions over the free coordinates, in order of preference.
    let mut rows: Vec<(MemberId, Vec<f64>, f64, bool)> = Vec::new();
    let prescribed = |row: &[f64]| -> f64 { row[free..].iter().zip(&engine.speed[free..]).map(|(a, b)| a * b).sum() };
    for &(m, w) in &s.scenario.initial_speeds {
        let row = &s.speeds[m.index()];
        rows.push((m, row[..free].to_vec(), w - prescribed(row), true));
    }
    // What has no inertia turns as what acts on it will have it.
    for (k, row) in &s.followers {
        rows.push((s.coordinates[*k], row[..free].to_vec(), -prescribed(row), false));
    }
    for &m in &s.coordinates[..free] {
        rows.push((m, s.speeds[m.index()][..free].to_vec(), -prescribed(&s.speeds[m.index()]), false));
    }
    let mut taken: Vec<&(MemberId, Vec<f64>, f64, bool)> = Vec::new();
    for row in &rows {
        let mut matrix: Vec<&[f64]> = taken.iter().map(|r| r.1.as_slice()).collect();
        matrix.push(&row.1);
        let m = DMatrix::from_fn(matrix.len(), free, |i, k| matrix[i][k]);
        let norms: Vec<f64> = (0..m.nrows()).map(|i| m.row(i).norm()).collect();
        let independent = norms.iter().all(|n| *n > 0.0)
            && taken.len() < free
            && DMatrix::from_fn(m.nrows(), free, |i, k| m[(i, k)] / norms[i]).rank(1e-10) == m.nrows();
        if independent {
            taken.push(row);
        }
    }
    let a = DMatrix::from_fn(taken.len(), free, |i, k| taken[i].1[k]);
    let b = DVector::from_fn(taken.len(), |i, _| taken[i].2);
    if free > 0 {
        let v = a.lu().solve(&b).unwrap_or_else(|| DVector::zeros(free));
        x[..free].copy_from_slice(v.as_slice());
    }
    for (m, row, w, given) in &rows {
        let is: f64 = row.iter().zip(&x[..free]).map(|(a, b)| a * b).sum();
        let size: f64 = (s.speeds[m.index()].iter().zip(x[..free].iter().chain(&engine.speed[free..])))
            .map(|(a, b)| (a * b).abs())
            .sum();
        if *given && (is - w).abs() > s.train.speed_tolerance().max(AS_WRITTEN) * (size + w.abs()) {
            let row = &s.speeds[m.index()];
            let name = s.train.member_name(*m);
            let [given, follows] = apart(w + prescribed(row), is + prescribed(row), |x| short(x).to_string());
            let message = format!(
                "`{name}` cannot start at {} rad/s: the gears and the other speeds given make it {} rad/s",
                given, follows
            );
            let place = format!("{}.initial_speeds.{name}", s.scenario.place);
            let error = Diagnostic::new(Code::ContradictorySpeeds, place, message);
            return Err(error.hint("leave out one of the speeds").into());
        }
    }
    Ok(())
}
