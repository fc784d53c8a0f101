//! Torsional natural frequencies and shapes.
//!
//! The gears tie the speeds `ω` of all members to few coordinates `v`, exactly: `ω = N v`. With a
//! row `d` of ±1 for every inertia J (kg m²) and shaft of stiffness k (N m/rad) and damping c (N m
//! s/rad), the small vibration is
//! `M v'' + C v' + K v = 0`, `M = Nᵀ (Σ J d dᵀ) N`, `K = Nᵀ (Σ k d dᵀ) N`, `C = Nᵀ (Σ c d dᵀ) N`.
//! What has no inertia follows the rest without delay (static condensation). Source: Meirovitch,
//! Fundamentals of Vibrations, 2001, chapter 7; Guyan 1965 for the condensation.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector, SVD, Schur};
use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::{self, Matrix, Rational};
use crate::kinematics::Configuration;
use crate::train::{FRAME, MemberId, Train};

/// A number that belongs to a member or a shaft.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Part {
    /// The member or shaft.
    pub name: String,
    /// Its number.
    pub value: f64,
}

/// A motion without strain, at 0 Hz.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RigidMode {
    /// Angle of each member whose motion is settled; the largest is 1.
    pub shape: Vec<Part>,
    /// Share of the kinetic energy by member; 1 in all.
    pub kinetic_energy: Vec<Part>,
}

/// A vibration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Mode {
    /// Undamped natural frequency f, Hz.
    pub frequency_hz: f64,
    /// ω = 2π f, rad/s.
    pub angular_frequency_rad_s: f64,
    /// ζ = −Re λ/|λ| of its eigenvalue λ with damping; above 1 (then `c/(2ω)` of its shape) where it no
    /// longer vibrates; `None` where nothing damps it.
    pub damping_ratio: Option<f64>,
    /// Frequency with damping, Im λ/(2π), Hz; `None` where it no longer vibrates.
    pub damped_frequency_hz: Option<f64>,
    /// Angle amplitude of each member whose motion is settled, relative to the largest, which is 1.
    /// Opposite signs swing in opposite directions.
    pub shape: Vec<Part>,
    /// Share of the kinetic energy by member; 1 in all.
    pub kinetic_energy: Vec<Part>,
    /// Share of the strain energy by shaft; 1 in all.
    pub strain_energy: Vec<Part>,
}

/// Natural frequencies of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ModesReport {
    /// `willis-modes-1`
    pub format: Format<Self>,
    /// The train.
    pub train: String,
    /// The state of the shift table, or `as drawn`.
    pub state: String,
    /// Members held at rest beside it.
    pub fixed: Vec<String>,
    /// Members whose angles are the coordinates.
    pub coordinates: Vec<String>,
    /// Motions without strain; how many there are is certain, because they are found exactly.
    pub rigid_body_modes: Vec<RigidMode>,
    /// Vibrations, by rising frequency.
    pub modes: Vec<Mode>,
    /// What stands in for data that were not given.
    pub assumptions: Vec<String>,
    /// What the reader must know.
    pub notes: Vec<String>,
}

impl Contract for ModesReport {
    const FORMAT: &'static str = "willis-modes-1";
}

/// Torsional natural frequencies and mode shapes in a state of the shift table (`None`: as drawn),
/// with the members `fixed` held.
///
/// Undamped frequencies solve `det(K − ω² M) = 0`; damping ratios come from the eigenvalues λ of
/// `λ² M + λ C + K` with the viscous damping of shafts and drags. For two inertias J₁, J₂ (kg m²)
/// on a shaft k (N m/rad), `ω = √(k (1/J₁ + 1/J₂))`. Source: Meirovitch, Fundamentals of
/// Vibrations, 2001, chapter 7.
///
/// # Errors
/// An unknown state or member; no inertia at all; a motion that has neither inertia nor stiffness.
///
/// # Example
/// ```
/// use willis::dynamics::modes;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("set")
///     .members(["s", "r", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c"))
///     .build()?;
/// let wrong = modes(&train, None, &[]).unwrap_err();
/// assert!(wrong.to_string().contains("no member has a moment of inertia"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn modes(train: &Train, state: Option<&str>, fixed: &[&str]) -> Result<ModesReport, Diagnostics> {
    let (engaged, held) = selection(train, state, fixed)?;
    let springs: Vec<_> = train.shafts.iter().filter(|s| s.stiffness > 0.0).collect();
    let rotors: Vec<_> = train.inertias.iter().filter(|j| j.value > 0.0).collect();
    if rotors.is_empty() {
        let d = Diagnostic::new(Code::MissingKey, "", "no member has a moment of inertia, so nothing can vibrate");
        return Err(one(d.hint("give the moments of inertia of the members in `inertias`")));
    }
    let touched = rotors.iter().map(|j| [j.member, j.reference]);
    let mut involved: Vec<MemberId> = touched.chain(springs.iter().map(|s| s.members)).flatten().collect();
    let damping = train.shafts.iter().filter(|s| s.damping > 0.0).map(|s| (s.members, s.damping, s.name.as_str()));
    let drags = train.drags.iter().filter(|d| d.viscous > 0.0).map(|d| (d.members, d.viscous, d.name.as_str()));
    let dampers: Vec<_> = damping.chain(drags).collect();
    let keep: Vec<MemberId> = involved.iter().copied().chain(dampers.iter().flat_map(|d| d.0)).collect();
    let configuration = Configuration::new(train, &engaged, &held, &keep);

    // Independent speeds that settle those of all inertias and shafts.
    let mut chosen: Vec<MemberId> = Vec::new();
    let mut speeds = configuration.transfer(&chosen).speeds;
    involved.retain(|m| *m != FRAME);
    for m in involved {
        if speeds[m.0].is_none() {
            chosen.push(m);
            speeds = configuration.transfer(&chosen).speeds;
        }
    }
    let n = chosen.len();
    let row = |[a, b]: [MemberId; 2]| -> Option<Vec<Rational>> {
        let (a, b) = (speeds[a.0].as_ref()?, speeds[b.0].as_ref()?);
        Some(a.iter().zip(b).map(|(a, b)| a - b).collect())
    };
    let known = "the coordinates settle it";
    let inertia_rows: Matrix = rotors.iter().map(|j| row([j.member, j.reference]).expect(known)).collect();
    let spring_rows: Matrix = springs.iter().map(|s| row(s.members).expect(known)).collect();

    let mut notes = Vec::new();
    let mut assumptions = vec!["meshes are rigid; friction other than viscous is left out".to_owned()];
    if springs.iter().any(|s| s.backlash > 0.0) {
        assumptions.push("shafts with backlash are taken as in contact".to_owned());
    }
    if train.shift_elements.iter().any(|e| e.blocks != 0) {
        assumptions.push("one-way clutches are open unless the state engages them".to_owned());
    }

    // A motion that neither an inertia nor a shaft feels.
    let both: Matrix = inertia_rows.iter().chain(&spring_rows).cloned().collect();
    if let Some(free) = null_space(both, n).first() {
        let names: Vec<_> = (0..n).filter(|&k| !free[k].is_zero()).map(|k| train.member_name(chosen[k])).collect();
        let text = format!("a motion of `{}` has neither inertia nor stiffness", names.join("`, `"));
        return Err(one(Diagnostic::new(Code::MissingKey, "", text).hint(format!(
            "give `{}` a moment of inertia, or hold a member that leaves this motion no freedom",
            names[0]
        ))));
    }

    // x = N coordinates = T a, with a as many coordinates as feel inertia.
    let mut reduced = inertia_rows.clone();
    let pivots = exact::reduce(&mut reduced, n);
    reduced.truncate(pivots.len());
    let massless = null_space(inertia_rows.clone(), n);
    let r = pivots.len();
    let (j_rows, k_rows) = (floats(&inertia_rows, n), floats(&spring_rows, n));
    let stiffness = DVector::from_iterator(springs.len(), springs.iter().map(|s| s.stiffness));
    let mut to_all = DMatrix::zeros(n, r);
    pivots.iter().enumerate().for_each(|(k, &p)| to_all[(p, k)] = 1.0);
    if !massless.is_empty() {
        let names: Vec<_> = (0..n).filter(|k| !pivots.contains(k)).map(|k| train.member_name(chosen[k])).collect();
        notes.push(format!(
            "`{}` without inertia of its own follows its shafts without delay (static condensation)",
            names.join("`, `")
        ));
        let u = DMatrix::from_fn(n, massless.len(), |i, k| massless[k][i].to_f64());
        let own = &k_rows * &u;
        let weighted = DMatrix::from_diagonal(&stiffness) * &own;
        let Some(factor) = (own.transpose() * &weighted).cholesky() else { return Err(singular()) };
        let follow = factor.solve(&(weighted.transpose() * (&k_rows * &to_all)));
        to_all -= u * follow;
    }

    // Coordinates in which the inertia is the unit matrix: a = L⁻ᵀ u.
    let mut weighted = &j_rows * &to_all;
    weighted.row_iter_mut().zip(&rotors).for_each(|(mut row, j)| row *= j.value.sqrt());
    let Some(factor) = (weighted.transpose() * weighted).cholesky() else { return Err(singular()) };
    let lower = factor.l();
    let Some(to_u) = lower.transpose().solve_upper_triangular(&DMatrix::identity(r, r)) else { return Err(singular()) };
    let mut strain = &k_rows * &to_all * &to_u;
    strain.row_iter_mut().zip(&springs).for_each(|(mut row, s)| row *= s.stiffness.sqrt());

    // Motions without strain, exactly, and their orthonormal basis over u.
    let rigid = null_space(spring_rows, n);
    let elastic = r - rigid.len();
    let inertial = floats(&reduced, n);
    let mut basis: Vec<DVector<f64>> = Vec::new();
    for motion in &rigid {
        let x = DVector::from_iterator(n, motion.iter().map(Rational::to_f64));
        let mut u = lower.transpose() * (&inertial * x);
        u.normalize_mut();
        for _ in 0..2 {
            basis.iter().for_each(|b| u -= b * b.dot(&u));
            u.normalize_mut();
        }
        basis.push(u);
    }
    // Singular values keep low frequencies beside high ones more exactly than eigenvalues of K do.
    let mut vibrations: Vec<(f64, DVector<f64>)> = Vec::new();
    if elastic > 0 {
        let svd = SVD::new(strain.clone(), false, true);
        let rows = svd.v_t.as_ref().expect("asked for");
        vibrations = svd.singular_values.iter().zip(rows.row_iter()).map(|(w, v)| (*w, v.transpose())).collect();
        vibrations.sort_by(|a, b| b.0.total_cmp(&a.0));
        vibrations.truncate(elastic);
        vibrations.reverse();
    }

    let all: DMatrix<f64> = {
        let settled = |m: usize| speeds[m].clone().unwrap_or_else(|| vec![Rational::ZERO; n]);
        floats(&(0..train.members.len()).map(settled).collect(), n)
    };
    let show = |x: &DVector<f64>| -> (Vec<Part>, Vec<Part>) {
        let angles = &all * x;
        let largest = angles.amax();
        let sign = angles.iter().find(|a| a.abs() >= largest * (1.0 - 1e-9)).map_or(1.0, |a| a.signum());
        let shape = (1..train.members.len())
            .filter(|&m| speeds[m].is_some())
            .map(|m| Part { name: train.members[m].name.clone(), value: sign * angles[m] / largest })
            .collect();
        let energies: Vec<f64> = (&j_rows * x).iter().zip(&rotors).map(|(w, j)| j.value * w * w).collect();
        let total: f64 = energies.iter().sum();
        let mut kinetic: Vec<Part> = Vec::new();
        for (j, e) in rotors.iter().zip(energies) {
            let name = train.member_name(j.member);
            match kinetic.iter_mut().find(|p| p.name == name) {
                Some(part) => part.value += e / total,
                None => kinetic.push(Part { name: name.to_owned(), value: e / total }),
            }
        }
        (shape, kinetic)
    };

    let rigid_body_modes: Vec<_> = rigid
        .iter()
        .map(|motion| {
            let x = DVector::from_iterator(n, motion.iter().map(Rational::to_f64));
            let (shape, kinetic_energy) = show(&x);
            RigidMode { shape, kinetic_energy }
        })
        .collect();

    let mut damping_rows: Vec<(Vec<Rational>, f64)> = Vec::new();
    for (members, coefficient, name) in &dampers {
        match row(*members) {
            Some(row) => damping_rows.push((row, *coefficient)),
            None => notes.push(format!("`{name}` acts on a motion without inertia and stiffness and is left out")),
        }
    }
    let damped = if elastic == 0 || damping_rows.is_empty() {
        vec![Damped::None; elastic]
    } else {
        let rows = floats(&damping_rows.iter().map(|d| d.0.clone()).collect(), n);
        let mut shapes = DMatrix::zeros(r, r);
        let columns = vibrations.iter().map(|v| &v.1).chain(&basis);
        columns.enumerate().for_each(|(k, u)| shapes.set_column(k, u));
        let mut rates = rows * &to_all * &to_u * shapes;
        rates.row_iter_mut().zip(&damping_rows).for_each(|(mut row, d)| row *= d.1.sqrt());
        if !massless.is_empty() {
            notes.push("damping at members without inertia holds for slow motion of them only".to_owned());
        }
        let frequencies: Vec<f64> = vibrations.iter().map(|v| v.0).collect();
        let Some(damped) = damp(&frequencies, &(rates.transpose() * &rates)) else { return Err(singular()) };
        if damped.iter().any(|d| matches!(d, Damped::Over(_))) {
            notes.push(
                "modes with a damping ratio of 1 or more do not vibrate; theirs is that of the undamped shape"
                    .to_owned(),
            );
        }
        damped
    };

    let modes: Vec<_> = vibrations
        .iter()
        .zip(damped)
        .map(|((w, u), damped)| {
            let (shape, kinetic_energy) = show(&(&to_all * (&to_u * u)));
            let twists = &strain * u;
            let total = twists.norm_squared();
            let share = |(s, t): (&&crate::train::Shaft, &f64)| Part { name: s.name.clone(), value: t * t / total };
            let (damping_ratio, damped_frequency_hz) = match damped {
                Damped::None => (None, Some(w / TAU)),
                Damped::Vibrates { ratio, frequency } => (Some(ratio), Some(frequency / TAU)),
                Damped::Over(ratio) => (Some(ratio), None),
            };
            Mode {
                frequency_hz: w / TAU,
                angular_frequency_rad_s: *w,
                damping_ratio,
                damped_frequency_hz,
                shape,
                kinetic_energy,
                strain_energy: springs.iter().zip(twists.iter()).map(share).collect(),
            }
        })
        .collect();
    if springs.is_empty() {
        notes.push("no shaft is elastic: there are only motions without strain".to_owned());
    }
    if n == 0 {
        notes.push("nothing that has inertia can move".to_owned());
    }
    Ok(ModesReport {
        format: Format::new(),
        train: train.name.clone(),
        state: state.unwrap_or("as drawn").to_owned(),
        fixed: fixed.iter().map(|m| (*m).to_owned()).collect(),
        coordinates: chosen.iter().map(|m| train.member_name(*m).to_owned()).collect(),
        rigid_body_modes,
        modes,
        assumptions,
        notes,
    })
}

fn one(diagnostic: Diagnostic) -> Diagnostics {
    [diagnostic].into_iter().collect()
}

fn singular() -> Diagnostics {
    one(Diagnostic::new(
        Code::Unfit,
        "",
        "the inertias or stiffnesses differ so much that no frequency can be computed",
    ))
}

/// The shift elements engaged in a state and the members held.
fn selection(
    train: &Train,
    state: Option<&str>,
    fixed: &[&str],
) -> Result<(Vec<crate::train::ShiftElementId>, Vec<MemberId>), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut engaged = Vec::new();
    match state {
        None | Some("as drawn") => {}
        Some(name) => match train.state(name) {
            Some(state) => engaged.clone_from(&state.engaged),
            None => {
                let known: Vec<_> = train.states.iter().map(|s| s.name.as_str()).chain(["as drawn"]).collect();
                let d = Diagnostic::new(Code::UnknownSelection, "", format!("the train has no state `{name}`"));
                wrong
                    .push(d.suggest(name, known.iter().copied()).hint(format!("its states are: {}", known.join(", "))));
            }
        },
    }
    let mut held = Vec::new();
    for name in fixed {
        match train.member(name) {
            Some(member) => held.push(member),
            None => {
                let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no member `{name}`"));
                wrong.push(d.suggest(name, train.members.iter().map(|m| m.name.as_str())));
            }
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok((engaged, held)) }
}

fn floats(rows: &Matrix, columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns, |i, k| rows[i][k].to_f64())
}

/// Basis of the vectors that the rows take to zero.
fn null_space(mut rows: Matrix, columns: usize) -> Matrix {
    let pivots = exact::reduce(&mut rows, columns);
    (0..columns)
        .filter(|k| !pivots.contains(k))
        .map(|free| {
            let mut vector = vec![Rational::ZERO; columns];
            vector[free] = Rational::ONE;
            for (row, &pivot) in rows.iter().zip(&pivots) {
                vector[pivot] = -row[free].clone();
            }
            vector
        })
        .collect()
}

/// What damping makes of a mode.
#[derive(Clone, Copy, Debug)]
enum Damped {
    None,
    Vibrates { ratio: f64, frequency: f64 },
    Over(f64),
}

/// The vibrations with damping, for undamped frequencies and a damping matrix over the undamped
/// shapes (those at 0 Hz last). `None` if no eigenvalues are found.
fn damp(frequencies: &[f64], damping: &DMatrix<f64>) -> Option<Vec<Damped>> {
    let (elastic, all) = (frequencies.len(), damping.nrows());
    // Over (ω q, q'), which are of one size.
    let mut matrix = DMatrix::zeros(elastic + all, elastic + all);
    for (k, w) in frequencies.iter().enumerate() {
        matrix[(k, elastic + k)] = *w;
        matrix[(elastic + k, k)] = -w;
    }
    matrix.view_mut((elastic, elastic), (all, all)).copy_from(&-damping);
    let eigenvalues = Schur::try_new(matrix, f64::EPSILON, 10_000)?.complex_eigenvalues();
    let mut left: Vec<Complex<f64>> = eigenvalues.iter().copied().filter(|l| l.im > 1e-9 * l.norm()).collect();
    let ratio = |k: usize| damping[(k, k)] / (2.0 * frequencies[k]);
    // Each mode takes the eigenvalue nearest to its own without coupling, the nearest pair first.
    let mut damped: Vec<_> = (0..elastic).map(|k| Damped::Over(ratio(k).max(1.0))).collect();
    let mut open: Vec<usize> = (0..elastic).collect();
    while !left.is_empty() && !open.is_empty() {
        let distance = |k: usize, l: Complex<f64>| {
            let zeta = ratio(k);
            let own = Complex::new(-zeta, (1.0 - zeta * zeta).max(0.0).sqrt()) * frequencies[k];
            (l - own).norm() / frequencies[k]
        };
        let pairs = (0..open.len()).flat_map(|a| (0..left.len()).map(move |b| (a, b)));
        let near = |&(a, b): &(usize, usize)| distance(open[a], left[b]);
        let (a, b) = pairs.min_by(|p, q| near(p).total_cmp(&near(q)))?;
        let (k, l) = (open.remove(a), left.remove(b));
        // Without any damping of its own a mode keeps its eigenvalue but for round-off.
        damped[k] = if -l.re > 1e-13 * l.norm() {
            Damped::Vibrates { ratio: -l.re / l.norm(), frequency: l.im }
        } else {
            Damped::None
        };
    }
    Some(damped)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::{
        Contact, Curve, DragMount, GearSpec, Inertia, MeshSpec, SetSpec, Shaft, ShiftElementSpec, StateSpec,
    };

    fn inertia(train: &mut Train, member: &str, value: f64) {
        let member = train.member(member).unwrap();
        train.inertias.push(Inertia { member, reference: FRAME, value });
    }

    fn shaft(train: &mut Train, name: &str, [a, b]: [&str; 2], stiffness: f64, damping: f64) {
        let members = [a, b].map(|m| train.member(m).unwrap());
        let (name, contact) = (name.to_owned(), Contact::Soft);
        train.shafts.push(Shaft { name, members, stiffness, damping, backlash: 0.0, contact });
    }

    fn train(members: &[&str]) -> Train {
        Train::builder("chain").members(members.iter().copied()).build().unwrap()
    }

    fn frequencies(report: &ModesReport) -> Vec<f64> {
        report.modes.iter().map(|m| m.angular_frequency_rad_s).collect()
    }

    fn close(found: f64, expected: f64) {
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} {expected}");
    }

    fn value(parts: &[Part], name: &str) -> f64 {
        parts.iter().find(|p| p.name == name).unwrap().value
    }

    #[test]
    fn two_inertias_on_a_shaft() {
        let mut t = train(&["a", "b"]);
        inertia(&mut t, "a", 2.0);
        inertia(&mut t, "b", 0.5);
        shaft(&mut t, "S", ["a", "b"], 1000.0, 0.3);
        let report = modes(&t, None, &[]).unwrap();
        let reduced: f64 = 1.0 / (1.0 / 2.0 + 1.0 / 0.5);
        let w = (1000.0 / reduced).sqrt();
        close(report.modes[0].angular_frequency_rad_s, w);
        close(report.modes[0].frequency_hz, w / TAU);
        let zeta = 0.3 / (2.0 * reduced * w);
        let mode = &report.modes[0];
        assert!((mode.damping_ratio.unwrap() / zeta - 1.0).abs() < 1e-9);
        assert!((mode.damped_frequency_hz.unwrap() / (w / TAU * (1.0 - zeta * zeta).sqrt()) - 1.0).abs() < 1e-9);
        assert!((value(&mode.shape, "a") + 0.25).abs() < 1e-12);
        assert!((value(&mode.shape, "b") - 1.0).abs() < 1e-12);
        close(value(&mode.kinetic_energy, "b"), 0.8);
        close(value(&mode.strain_energy, "S"), 1.0);
        assert_eq!(report.rigid_body_modes.len(), 1);
        assert_eq!(value(&report.rigid_body_modes[0].shape, "a"), 1.0);
        assert_eq!(value(&report.rigid_body_modes[0].shape, "b"), 1.0);
        close(value(&report.rigid_body_modes[0].kinetic_energy, "a"), 0.8);
        // One end held: ω² = k/J.
        let report = modes(&t, None, &["a"]).unwrap();
        assert!(report.rigid_body_modes.is_empty());
        close(report.modes[0].angular_frequency_rad_s, (1000.0_f64 / 0.5).sqrt());
        assert_eq!(serde_json::to_value(&report).unwrap()["format"], "willis-modes-1");
    }

    /// Three discs: ω⁴ − ω² (k₁/J₁ + (k₁ + k₂)/J₂ + k₂/J₃) + k₁ k₂ (J₁ + J₂ + J₃)/(J₁ J₂ J₃) = 0, with
    /// stiffnesses far apart.
    #[test]
    fn three_discs() {
        for [k1, k2] in [[1e3, 2e3], [1e3, 1e11]] {
            let [j1, j2, j3] = [1.0, 2.0, 3.0];
            let mut t = train(&["a", "b", "c"]);
            [("a", j1), ("b", j2), ("c", j3)].iter().for_each(|(m, j)| inertia(&mut t, m, *j));
            shaft(&mut t, "1", ["a", "b"], k1, 0.0);
            shaft(&mut t, "2", ["b", "c"], k2, 0.0);
            let report = modes(&t, None, &[]).unwrap();
            let sum: f64 = k1 / j1 + (k1 + k2) / j2 + k2 / j3;
            let product = k1 * k2 * (j1 + j2 + j3) / (j1 * j2 * j3);
            let high = 0.5 * (sum + (sum * sum - 4.0 * product).sqrt());
            let found = frequencies(&report);
            assert!((found[0] / (product / high).sqrt() - 1.0).abs() < 1e-10, "{found:?}");
            close(found[1], high.sqrt());
            assert!(report.modes.iter().all(|m| m.damping_ratio.is_none()));
            assert!((report.modes[1].kinetic_energy.iter().map(|p| p.value).sum::<f64>() - 1.0).abs() < 1e-12);
        }
    }

    /// A gear pair between two shafts: seen from the first shaft, everything behind the gears counts
    /// with the square of the ratio. The gears have no inertia: both shafts act in series.
    #[test]
    fn gears_reflect_inertia_and_stiffness() {
        let mesh = MeshSpec::new(GearSpec::external("p", 20), GearSpec::external("q", 60));
        let build = || Train::builder("pair").members(["a", "p", "q", "b"]).mesh(mesh.clone()).build().unwrap();
        let mut t = build();
        inertia(&mut t, "a", 0.1);
        inertia(&mut t, "b", 5.0);
        shaft(&mut t, "in", ["a", "p"], 400.0, 0.0);
        shaft(&mut t, "out", ["q", "b"], 9000.0, 0.0);
        let report = modes(&t, None, &[]).unwrap();
        let (j, k) = (5.0 / 9.0, 1.0 / (1.0 / 400.0 + 9.0 / 9000.0));
        close(report.modes[0].angular_frequency_rad_s, f64::sqrt(k * (1.0 / 0.1 + 1.0 / j)));
        assert_eq!((report.modes.len(), report.rigid_body_modes.len()), (1, 1));
        let shape = &report.rigid_body_modes[0].shape;
        assert!((value(shape, "a") / value(shape, "b") + 3.0).abs() < 1e-12);
        assert!(report.notes[0].contains("static condensation"), "{:?}", report.notes);
        // A rigid shaft and gears with inertia.
        let mut t = build();
        inertia(&mut t, "p", 0.02);
        inertia(&mut t, "q", 0.7);
        inertia(&mut t, "b", 5.0);
        shaft(&mut t, "out", ["q", "b"], 9000.0, 0.0);
        let report = modes(&t, None, &[]).unwrap();
        close(report.modes[0].angular_frequency_rad_s, f64::sqrt(9000.0 * (1.0 / (0.7 + 0.02 * 9.0) + 1.0 / 5.0)));
    }

    /// A set whose ring hangs on a torsion spring. With the carrier held, ω² = k/(J_r + J_s (z_r/z_s)² +
    /// J_p (z_r/z_p)²). With the sun held, the carrier turns at w = z_r/(z_r + z_s) of the ring and the
    /// planets at w + (1 − w) z_r/z_p.
    #[test]
    fn a_ring_on_a_spring() {
        let (zs, zp, zr) = (30.0, 20.0, 70.0);
        let mut t = Train::builder("set")
            .members(["s", "r", "c"])
            .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4))
            .shift_element(ShiftElementSpec::brake("B", "c"))
            .state(StateSpec::new("1", ["B"]))
            .build()
            .unwrap();
        let [js, jr, jc, jp] = [0.01, 0.3, 0.2, 0.004];
        [("s", js), ("r", jr), ("c", jc), ("P1.planet", jp)].iter().for_each(|(m, j)| inertia(&mut t, m, *j));
        shaft(&mut t, "ring", ["r", "frame"], 5e4, 0.0);
        let report = modes(&t, Some("1"), &[]).unwrap();
        let whole: f64 = jr + js * (zr / zs) * (zr / zs) + jp * (zr / zp) * (zr / zp);
        close(report.modes[0].angular_frequency_rad_s, (5e4 / whole).sqrt());
        let report = modes(&t, None, &["s"]).unwrap();
        let wc = zr / (zr + zs);
        let wp = wc + (1.0 - wc) * zr / zp;
        let whole = jr + jc * wc * wc + jp * wp * wp;
        close(report.modes[0].angular_frequency_rad_s, (5e4 / whole).sqrt());
        close(value(&report.modes[0].shape, "P1.planet") / value(&report.modes[0].shape, "r"), wp);
        // Free: sun and carrier may turn with the ring at rest.
        let report = modes(&t, None, &[]).unwrap();
        assert_eq!((report.modes.len(), report.rigid_body_modes.len()), (1, 1));
        assert_eq!(value(&report.rigid_body_modes[0].shape, "r"), 0.0);
    }

    /// Masses along a chain with branches, in two orders of members and of entries.
    #[test]
    fn the_order_of_members_does_not_matter() {
        let build = |members: [&str; 6], backwards: bool| {
            let mut t = Train::builder("set")
                .members(members)
                .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4))
                .build()
                .unwrap();
            let mut j = [("s", 0.01), ("r", 0.3), ("c", 0.2), ("m", 0.05), ("l", 2.0), ("P1.planet", 0.004)];
            let mut k =
                [("1", ["m", "s"], 300.0), ("2", ["c", "x"], 4e4), ("3", ["x", "l"], 3e4), ("4", ["r", "frame"], 1e6)];
            if backwards {
                j.reverse();
                k.reverse();
            }
            j.iter().for_each(|(m, j)| inertia(&mut t, m, *j));
            k.iter().for_each(|(n, m, k)| shaft(&mut t, n, *m, *k, 1e-4 * k));
            modes(&t, None, &[]).unwrap()
        };
        let first = build(["s", "r", "c", "m", "x", "l"], false);
        let second = build(["l", "x", "c", "m", "r", "s"], true);
        assert_eq!((first.modes.len(), first.rigid_body_modes.len()), (3, 1));
        for (a, b) in first.modes.iter().zip(&second.modes) {
            close(a.frequency_hz, b.frequency_hz);
            assert!((a.damping_ratio.unwrap() / b.damping_ratio.unwrap() - 1.0).abs() < 1e-9);
            // Damping in proportion to stiffness: ζ = β ω/2.
            assert!((a.damping_ratio.unwrap() / (0.5e-4 * a.angular_frequency_rad_s) - 1.0).abs() < 1e-9);
            for p in &a.strain_energy {
                assert!((p.value - value(&b.strain_energy, &p.name)).abs() < 1e-9);
            }
            for p in &a.shape {
                assert!((p.value.abs() - value(&b.shape, &p.name).abs()).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn drags_damp_and_too_much_stops_the_vibration() {
        let build = |viscous: f64| {
            let mut t = train(&["a", "b"]);
            inertia(&mut t, "a", 0.5);
            inertia(&mut t, "b", 0.5);
            shaft(&mut t, "S", ["a", "frame"], 800.0, 0.0);
            shaft(&mut t, "T", ["b", "frame"], 200.0, 0.0);
            let members = [t.member("a").unwrap(), FRAME];
            let (name, torque) = ("oil".to_owned(), Curve::constant(1.0));
            t.drags.push(DragMount { name, members, torque, viscous, peak: 1.0 });
            modes(&t, None, &[]).unwrap()
        };
        let report = build(4.0);
        assert_eq!(report.modes[0].damping_ratio, None);
        let zeta = report.modes[1].damping_ratio.unwrap();
        assert!((zeta - 4.0 / (2.0 * 0.5 * 40.0)).abs() < 1e-12, "{zeta}");
        let report = build(100.0);
        assert_eq!(report.modes[0].damping_ratio, None);
        assert!((report.modes[1].damping_ratio.unwrap() - 2.5).abs() < 1e-12);
        assert_eq!(report.modes[1].damped_frequency_hz, None);
        assert!(!report.notes.is_empty());
    }

    #[test]
    fn what_cannot_be_asked() {
        let mut t = train(&["a", "b", "c"]);
        let message = |t: &Train, state: Option<&str>, fixed: &[&str]| modes(t, state, fixed).unwrap_err().to_string();
        assert!(message(&t, None, &[]).starts_with("error[E005]"));
        assert!(message(&t, Some("2"), &["x"]).contains("no state `2`"));
        assert!(message(&t, Some("2"), &["x"]).contains("no member `x`"));
        inertia(&mut t, "a", 1.0);
        // Without shafts: rigid motion.
        let report = modes(&t, None, &[]).unwrap();
        assert_eq!((report.modes.len(), report.rigid_body_modes.len()), (0, 1));
        assert!(report.notes[0].contains("no shaft is elastic"));
        // All held.
        let report = modes(&t, None, &["a"]).unwrap();
        assert!(report.modes.is_empty() && report.rigid_body_modes.is_empty() && report.notes.len() == 2);
        // A shaft between members that nothing else holds.
        shaft(&mut t, "S", ["b", "c"], 10.0, 0.0);
        let text = message(&t, None, &[]);
        assert!(text.contains("`b`, `c`") && text.contains("neither inertia nor stiffness"), "{text}");
    }
}
