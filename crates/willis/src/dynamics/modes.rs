//! Torsional natural frequencies and shapes.
//!
//! The gears tie the speeds `ω` of all members to few coordinates `v`, exactly: `ω = N v`. With a
//! row `d` of ±1 for every inertia J (kg m²) and shaft of stiffness k (N m/rad) and damping c (N m
//! s/rad), the small vibration is
//! `M v'' + C v' + K v = 0`, `M = Nᵀ (Σ J d dᵀ) N`, `K = Nᵀ (Σ k d dᵀ) N`, `C = Nᵀ (Σ c d dᵀ) N`.
//! A mesh with a stiffness c, N/m, is a spring too: over its line of action its flanks approach by `r_b1 (ω_1 − ω_c) ±
//! r_b2 (ω_2 − ω_c)`, and it no longer ties its gears.
//! What has no inertia follows the rest without delay (static condensation). Source: Meirovitch,
//! Fundamentals of Vibrations, 2001, chapter 7; Guyan 1965 for the condensation.

mod condensation;
mod coordinates;
mod damping;
mod normal;
mod oscillator;
mod report;
mod rows;
mod selection;
mod shape;

use nalgebra::DVector;

use crate::contract::Format;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::{Rational, null_space};
use crate::kinematics::Configuration;
use crate::train::{MemberId, MemberKind, ShiftElementId, Train};

use condensation::Condensed;
use coordinates::{Coordinates, Felt};
use damping::{Damped, Damping};
use normal::Normal;
use oscillator::{Oscillator, spring};
use selection::selection;
use shape::Shapes;

pub use report::{Mode, ModesReport, Part, PlanetMode, RigidMode};

/// Torsional natural frequencies and mode shapes in a state of the shift table (`None`: as drawn),
/// with the members `fixed` held.
///
/// A mesh is rigid, or a spring where its geometry says so ([`GeometrySpec::mesh_stiffness`](crate::train::GeometrySpec)); the
/// planets of a set with such meshes also swing against each other ([`PlanetMode`]). Only turning is described: axes of
/// gears and planets do not move.
///
/// Undamped frequencies solve `det(K − ω² M) = 0`; damping ratios come from the eigenvalues λ of
/// `λ² M + λ C + K` with the viscous damping of shafts and drags. For two inertias J₁, J₂ (kg m²)
/// on a shaft k (N m/rad), `ω = √(k (1/J₁ + 1/J₂))`. Source: Meirovitch, Fundamentals of
/// Vibrations, 2001, chapter 7; for elastic meshes Kahraman, Journal of Sound and Vibration 173 (1994), 125–130.
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
    let oscillator = Oscillator::of(train)?;
    let tied = tied(train);
    let Solution { coordinates, rigid, vibrations, mut notes } = solve(&oscillator, &tied, &engaged, &held)?;
    if oscillator.springs.is_empty() {
        notes.push("no shaft is elastic: there are only motions without strain".to_owned());
    }
    if coordinates.is_empty() {
        notes.push("nothing that has inertia can move".to_owned());
    }
    Ok(ModesReport {
        format: Format::new(),
        train: train.name.clone(),
        state: state.unwrap_or("as drawn").to_owned(),
        fixed: fixed.iter().map(|m| (*m).to_owned()).collect(),
        coordinates: coordinates.iter().map(|m| train.member_name(*m).to_owned()).collect(),
        rigid_body_modes: rigid,
        modes: vibrations,
        planet_modes: planet_modes(&oscillator, &tied, &held)?,
        assumptions: oscillator.assumptions(),
        notes,
    })
}

/// The train as its rigid meshes tie it.
fn tied(train: &Train) -> Train {
    let mut tied = train.clone();
    tied.meshes.retain(|mesh| spring(mesh).is_none());
    tied
}

/// The planets of each set against each other. The sum over them is zero in what they exert on sun, ring and carrier,
/// which are at rest; all have one frequency, which is that of all together against members at rest.
fn planet_modes(oscillator: &Oscillator<'_>, tied: &Train, held: &[MemberId]) -> Result<Vec<PlanetMode>, Diagnostics> {
    let train = oscillator.train;
    let mut all = Vec::new();
    for (k, set) in train.sets.iter().enumerate() {
        let own = || train.meshes.iter().filter(|mesh| mesh.set == Some(k));
        let planets: Vec<MemberId> = (own().flat_map(|mesh| mesh.gears.iter().map(|g| g.member)))
            .filter(|m| train.members[m.0].kind == MemberKind::Planet)
            .collect();
        let number = own().map(|mesh| mesh.count).max().unwrap_or(1);
        let swings = |m: &MemberId| oscillator.rotors.iter().any(|j| j.member == *m || j.reference == *m);
        let is_elastic = own().any(|mesh| spring(mesh).is_some());
        if number < 2 || !is_elastic || !planets.iter().any(swings) || held.iter().any(|m| planets.contains(m)) {
            continue;
        }
        let others: Vec<MemberId> = (1..train.members.len()).map(MemberId).filter(|m| !planets.contains(m)).collect();
        for mode in solve(oscillator, tied, &[], &others)?.vibrations {
            all.push(PlanetMode { set: set.name.clone(), multiplicity: number - 1, mode });
        }
    }
    Ok(all)
}

/// Motions of an oscillator.
struct Solution {
    coordinates: Vec<MemberId>,
    rigid: Vec<RigidMode>,
    vibrations: Vec<Mode>,
    notes: Vec<String>,
}

fn solve(
    oscillator: &Oscillator<'_>,
    tied: &Train,
    engaged: &[ShiftElementId],
    held: &[MemberId],
) -> Result<Solution, Diagnostics> {
    let train = oscillator.train;
    let configuration = Configuration::new(tied, engaged, held, &oscillator.members());
    let coordinates = Coordinates::of(&configuration, oscillator);
    let n = coordinates.count();
    let felt = Felt::of(oscillator, &coordinates);
    felt.check(train, &coordinates)?;
    let mut notes = Vec::new();

    let condensed = Condensed::of(&felt, oscillator).ok_or_else(singular)?;
    if !condensed.followers.is_empty() {
        let names: Vec<_> = condensed.followers.iter().map(|&k| train.member_name(coordinates.chosen[k])).collect();
        notes.push(format!(
            "`{}` without inertia of its own follows its shafts without delay (static condensation)",
            names.join("`, `")
        ));
    }
    let normal = Normal::of(&condensed, &felt, oscillator).ok_or_else(singular)?;

    // Motions without strain are found exactly; the others are vibrations.
    let rigid: Vec<DVector<f64>> = null_space(felt.twists.exact.clone(), n)
        .iter()
        .map(|motion| DVector::from_iterator(n, motion.iter().map(Rational::to_f64)))
        .collect();
    let vibrations = normal.vibrations(rigid.len());

    let damping = Damping::of(oscillator, &coordinates);
    for name in &damping.left_out {
        notes.push(format!("`{name}` acts on a motion without inertia and stiffness and is left out"));
    }
    let mut damped = vec![Damped::None; vibrations.len()];
    if !damping.is_empty() && !vibrations.is_empty() {
        if !condensed.followers.is_empty() {
            notes.push("damping at members without inertia holds for slow motion of them only".to_owned());
        }
        let basis = normal.rigid_basis(&rigid);
        damped = damping.of_vibrations(&normal, &vibrations, &basis).ok_or_else(singular)?;
    }
    if damped.iter().any(|d| matches!(d, Damped::Over(_))) {
        notes.push(
            "modes with a damping ratio of 1 or more do not vibrate; theirs is that of the undamped shape".to_owned(),
        );
    }
    let shapes = Shapes::new(oscillator, &coordinates, &felt);
    Ok(Solution {
        rigid: rigid.iter().map(|x| shapes.rigid(x)).collect(),
        vibrations: vibrations.iter().zip(damped).map(|(v, damped)| shapes.vibration(v, damped, &normal)).collect(),
        coordinates: coordinates.chosen,
        notes,
    })
}

fn singular() -> Diagnostics {
    let message = "the inertias or stiffnesses differ so much that no frequency can be computed";
    Diagnostic::new(Code::Unfit, "", message).into()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;
    use crate::train::{
        Contact, Curve, DragMount, FRAME, GearSpec, GeometrySpec, Inertia, MeshSpec, MeshStiffness, SetSpec, Shaft,
        ShiftElementSpec, StateSpec,
    };
    use crate::units::{Length, Pressure};

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

    /// The fixed-ring set of Kahraman (1994): three planets, base radii 0.5, 0.5 and 1.5 m, 7 and 11 N/m in each mesh,
    /// inertias of sun 0.5, each planet 0.75, carrier 4 kg m². Frequencies of Drivetrain-python, tests/test_kahraman_1994.
    #[test]
    fn val_elastic_meshes_of_a_set_have_published_frequencies() {
        let angle = 20f64.to_radians();
        let mut geometry = GeometrySpec::new(Length::m(1.0 / (40.0 * angle.cos())), Length::m(0.1));
        geometry.external_mesh_stiffness = Some(Pressure::pa(70.0));
        geometry.internal_mesh_stiffness = Some(Pressure::pa(110.0));
        let set = SetSpec::simple("P1", ("s", 40), ("r", 120), "c").planet(40, 3).geometry(geometry);
        let mut t = Train::builder("Kahraman 1994").members(["s", "r", "c"]).set(set).build().unwrap();
        [("s", 0.5), ("c", 4.0), ("P1.planet", 3.0 * 0.75)].iter().for_each(|(m, j)| inertia(&mut t, m, *j));
        let report = modes(&t, None, &["r"]).unwrap();
        let found: Vec<f64> = report.modes.iter().map(|m| m.frequency_hz).collect();
        assert_eq!((found.len(), report.rigid_body_modes.len(), report.planet_modes.len()), (2, 1, 1));
        close(found[0], 0.508728970094716);
        close(found[1], 0.707886793423852);
        let planets = &report.planet_modes[0];
        assert_eq!((planets.set.as_str(), planets.multiplicity), ("P1", 2));
        close(planets.mode.frequency_hz, 0.389848400616838);
        assert!((planets.mode.strain_energy.iter().map(|p| p.value).sum::<f64>() - 1.0).abs() < 1e-12);
        // The more stiff the teeth are, the nearer to gears that tie.
        let of = |stiffness: Option<f64>| {
            let mut t = t.clone();
            for mesh in &mut t.meshes {
                mesh.teeth.as_mut().unwrap().stiffness = stiffness;
            }
            shaft(&mut t, "out", ["c", "frame"], 50.0, 0.0);
            modes(&t, None, &["r"]).unwrap().modes[0].frequency_hz
        };
        assert!((of(Some(1e9)) / of(None) - 1.0).abs() < 1e-6);
        assert!(of(Some(10.0)) < 0.99 * of(None));
    }

    /// Two gears on the spring of their teeth: ω² = c (r_b1²/J_1 + r_b2²/J_2).
    #[test]
    fn val_two_gears_on_their_teeth() {
        let mut geometry = GeometrySpec::new(Length::mm(2.0), Length::mm(20.0));
        geometry.external_mesh_stiffness = Some(Pressure::gpa(18.0));
        let mesh = MeshSpec::new(GearSpec::external("p", 25), GearSpec::external("q", 50)).geometry(geometry.clone());
        let mut t = Train::builder("pair").members(["p", "q"]).mesh(mesh).build().unwrap();
        [("p", 2e-4), ("q", 3e-3)].iter().for_each(|(m, j)| inertia(&mut t, m, *j));
        let report = modes(&t, None, &[]).unwrap();
        let [r1, r2] = [25.0, 50.0].map(|z| z * 1e-3 * 20f64.to_radians().cos());
        let c = 18e9 * 20e-3;
        close(report.modes[0].angular_frequency_rad_s, f64::sqrt(c * (r1 * r1 / 2e-4 + r2 * r2 / 3e-3)));
        assert!(
            (value(&report.rigid_body_modes[0].shape, "p") + 2.0 * value(&report.rigid_body_modes[0].shape, "q")).abs()
                < 1e-12
        );
        // By the standard: of the size that textbooks give, 20 N/(mm µm).
        geometry.external_mesh_stiffness = None;
        geometry.mesh_stiffness = Some(MeshStiffness::Iso6336);
        let mesh = MeshSpec::new(GearSpec::external("p", 25), GearSpec::external("q", 50)).geometry(geometry);
        let t = Train::builder("pair").members(["p", "q"]).mesh(mesh).build().unwrap();
        let c = t.meshes[0].teeth.as_ref().unwrap().stiffness.unwrap() / 20e-3;
        assert!((15e9..22e9).contains(&c), "{c}");
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
            t.drags.push(DragMount { name, members, torque, viscous, places: 1, peak: 1.0 });
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
