//! A train compiled for many operating points: no allocation per point and, with constant
//! efficiencies, no elimination.
//!
//! For a fixed choice of what is prescribed (a [`CompileRequest`]) every torque is linear in the prescribed
//! torques, the prescribed speeds and the signs of the shaft speeds (Coulomb drag), once it is known
//! which end of each element drives. So the sign patterns are factorised once, at compile time,
//! and a point costs a small matrix-vector product and a check that the pattern fits. Batches are
//! structures of arrays, worked off in chunks that stay in the first-level cache, with the vector
//! width of the machine chosen at run time.
//!
//! The answers are those of [`crate::analysis`]: an element exactly at rest transmits without
//! loss, and where the train has no certificate of uniqueness every pattern is tried and the number
//! of solutions reported.
//!
//! # Losses that depend on load and speed
//!
//! [`CompileRequest::mesh_loss`] gives a mesh or a set a loss that is a power law of its own torque and speed.
//! Torques are then no longer linear, and each point is solved by Newton's method: torques balance to
//! round-off, and the losses in them agree with their laws to 1e-10 of all mesh losses.
//!
//! The certificate carries over. A law has a ceiling ([`PowerLoss::most`]), so the slope of an element's
//! output over its input lies between two numbers; if no system of equations with slopes between them is
//! singular, every load has exactly one equilibrium. Without that certificate every pattern of drivers
//! is solved at every point, which takes some hundred times as long.

mod duty;
mod parts;
#[macro_use]
mod passes;
mod batch;
mod grid;
mod iterated;
mod kernel;
mod pairs;
mod single;
mod tables;

use crate::arch::Arch;
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Element};
use crate::power_flow;
use crate::train::{FRAME, MemberId, MeshId, ShiftElementId, Train};

use kernel::General;
use parts::{Law, MOST_FEATURES, MOST_LINEAR, MOST_MOVING};
use single::Single;

pub use batch::Workspace;
pub use duty::{BatchInputs, CompileRequest, CompiledOutput, PointVerdict, PowerLoss, ShaftDrag};
pub use grid::{GridInputs, OutputSummary, PointValue};
pub use tables::{TableElement, TableMesh, TableOutput, Tables};

/// A train ready to be evaluated at many points.
#[derive(Clone, Debug)]
pub struct CompiledTrain {
    outputs: Vec<Column>,
    speeds: usize,
    torques: usize,
    /// The first output column that holds each linear output.
    column_of: Vec<Option<usize>>,
    general: General,
    single: Option<Single>,
    /// Whether a quotient of powers is asked for.
    divides: bool,
    arch: Arch,
}

/// Where an output comes from.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Column {
    /// A row over the prescribed speeds.
    Speed(usize),
    /// A prescribed torque, handed through.
    Input(usize),
    /// A linear output of the statics.
    Linear(usize),
    Loss,
    Efficiency,
}

impl Train {
    /// Compiles the train for what is prescribed and wanted. What one-way clutches allow is not looked at: those that are
    /// engaged are closed, the others open, as `state` says.
    ///
    /// # Errors
    /// Names that do not exist, speeds that do not determine the motion or contradict each other,
    /// loads missing or too many, a redundant train, or more than 12 elements whose direction of
    /// power matters.
    ///
    /// # Example
    /// ```
    /// use willis::compiled::{CompileRequest, CompiledOutput};
    /// use willis::train::{SetSpec, Train};
    ///
    /// let train = Train::builder("power split")
    ///     .members(["sun", "ring", "carrier"])
    ///     .terminals(["sun", "ring", "carrier"])
    ///     .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").mesh_efficiency(0.99))
    ///     .build()?;
    /// let request = CompileRequest::new(["sun", "carrier"], ["sun"])
    ///     .output(CompiledOutput::Torque("ring".into()))
    ///     .output(CompiledOutput::Efficiency);
    /// let compiled = train.compile(&request)?;
    /// let mut work = compiled.workspace();
    /// let mut out = [0.0; 2];
    /// compiled.evaluate(&[300.0, 100.0], &[10.0], &mut work, &mut out);
    /// // The sun drives (10 N m · 200 rad/s > 0): T_r = i0 η T_s, i0 = 7/3.
    /// assert!((out[0] - 7.0 / 3.0 * 0.9801 * 10.0).abs() < 1e-12);
    /// # Ok::<(), willis::diagnostic::Diagnostics>(())
    /// ```
    pub fn compile(&self, duty: &CompileRequest) -> Result<CompiledTrain, Diagnostics> {
        Compiler::new(self, duty)?.compile()
    }
}

struct Compiler<'t> {
    train: &'t Train,
    c: Configuration<'t>,
    speeds: Vec<MemberId>,
    torques: Vec<MemberId>,
    drag: Vec<(MemberId, ShaftDrag)>,
    /// Torques that act on the first member and against the second.
    between: Vec<[MemberId; 2]>,
    /// By element.
    laws: Vec<Option<Law>>,
    outputs: Vec<CompiledOutput>,
}

fn fail(code: Code, message: String, hint: &str) -> Diagnostics {
    let mut all = Diagnostics::default();
    all.push(Diagnostic::new(code, "duty", message).hint(hint));
    all
}

impl<'t> Compiler<'t> {
    fn new(train: &'t Train, duty: &CompileRequest) -> Result<Self, Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut find = |names: &[String]| -> Vec<MemberId> {
            let mut ids = Vec::new();
            for name in names {
                match train.member(name) {
                    Some(id) => ids.push(id),
                    None => {
                        let d = Diagnostic::new(Code::UnknownName, "duty", format!("there is no member `{name}`"));
                        wrong.push(d.suggest(name, train.members.iter().map(|m| m.name.as_str())));
                    }
                }
            }
            ids
        };
        let speeds = find(&duty.speeds);
        let torques = find(&duty.torques);
        let fixed = find(&duty.fixed);
        let dragged = find(&duty.drag.iter().map(|d| d.0.clone()).collect::<Vec<_>>());
        let engaged: &[ShiftElementId] = match duty.state.as_ref().map(|name| train.find_state(name)) {
            Some(Ok(k)) => &train.states[k].engaged,
            Some(Err(d)) => {
                wrong.push(*d);
                &[]
            }
            None => &[],
        };
        for t in torques.iter().filter(|t| !train.terminals.contains(t)) {
            let message = format!("`{}` is no terminal and takes no torque", train.member_name(*t));
            wrong.push(Diagnostic::new(Code::NotATerminal, "duty", message));
        }
        if !train.variators.is_empty() {
            let message = "the torques of a variator depend on the speeds, so a train that has one is not compiled";
            wrong.push(Diagnostic::new(Code::Unfit, "duty", message).hint("ask its operating points one by one"));
        }
        if wrong.has_errors() {
            return Err(wrong);
        }
        // A mesh with a law of its own is no part of a chain.
        let alone = duty.losses.iter().filter_map(|(name, _)| train.mesh(name));
        let alone = alone.flat_map(|m| train.meshes[m.0].gears.iter().map(|g| g.member));
        let between = duty.between.clone();
        let keep = speeds.iter().chain(&dragged).chain(between.iter().flatten()).copied().chain(alone);
        let keep: Vec<MemberId> = keep.collect();
        let c = Configuration::new(train, engaged, &fixed, &keep);
        let drag = dragged.into_iter().zip(duty.drag.iter().map(|d| d.1)).collect();
        let laws = vec![None; c.elements.len()];
        let mut compiler = Self { train, c, speeds, torques, drag, between, laws, outputs: duty.outputs.clone() };
        duty.losses.iter().try_for_each(|(name, law)| compiler.law(name, law))?;
        Ok(compiler)
    }

    /// Puts a law on the element that a name stands for.
    fn law(&mut self, name: &str, law: &PowerLoss) -> Result<(), Diagnostics> {
        let train = self.train;
        if !law.is_sound() {
            return Err(fail(
                Code::OutOfRange,
                format!("the loss of `{name}` is no law: {law:?}"),
                "exponents are from 0 to below 1, ceilings up to 0.5, nothing is negative",
            ));
        }
        let meshes: Vec<MeshId> = match (train.mesh(name), train.sets.iter().position(|s| s.name == name)) {
            (Some(mesh), _) => vec![mesh],
            (None, set) => {
                (0..train.meshes.len()).map(MeshId).filter(|m| set.is_some() && train.meshes[m.0].set == set).collect()
            }
        };
        let Some(first) = meshes.first() else {
            let d = Diagnostic::new(Code::UnknownName, "duty", format!("there is no mesh or set `{name}`"));
            let known = train.meshes.iter().map(|m| m.name.as_str()).chain(train.sets.iter().map(|s| s.name.as_str()));
            let mut all = Diagnostics::default();
            all.push(d.suggest(name, known));
            return Err(all);
        };
        let whole = |e: &Element| e.links.len() == meshes.len() && e.links.iter().all(|l| meshes.contains(&l.mesh));
        let Some(at) = self.c.elements.iter().position(whole) else {
            return Err(fail(
                Code::Unfit,
                format!("the meshes of `{name}` do not share one power"),
                "give each mesh its own loss",
            ));
        };
        if self.laws[at].is_some() {
            return Err(fail(Code::DuplicateName, format!("`{name}` has two losses"), "leave one of them out"));
        }
        let element = &mut self.c.elements[at];
        // End p is the first gear, whose torque and speed the law takes.
        if (element.links[0].mesh, element.links[0].along) != (*first, true) {
            *element = element.clone().reversed();
        }
        let PowerLoss { coefficient, exponent, torque, speed, most } = *law;
        let own = Law { c: [coefficient; 2], exponent, torque, speed, most };
        // The statics certifies slopes in place of efficiencies.
        let slopes = if coefficient > 0.0 { own.slopes() } else { [1.0; 2] };
        let exactly = |x: f64| Rational::from_f64(x).expect("bounded by the checks of the law");
        (element.forward, element.backward) = (exactly(slopes[0]), exactly(slopes[1]).recip());
        self.laws[at] = (coefficient > 0.0).then_some(own);
        Ok(())
    }

    fn compile(self) -> Result<CompiledTrain, Diagnostics> {
        let (train, c) = (self.train, &self.c);
        let transfer = c.transfer(&self.speeds);
        if !transfer.conflicts.is_empty() || self.speeds.len() > c.degrees_of_freedom() {
            return Err(fail(
                Code::ContradictorySpeeds,
                format!("{} speeds are prescribed and {} can be chosen", self.speeds.len(), c.degrees_of_freedom()),
                "prescribe as many independent speeds as there are degrees of freedom",
            ));
        }
        let d = self.speeds.len();
        let speed_row = |m: MemberId| -> Option<Vec<f64>> {
            transfer.speeds[m.0].as_ref().map(|r| r.iter().map(Rational::to_f64).collect())
        };

        // Terminals: loaded, or open. Their nodes give the rows.
        let mut open: Vec<(MemberId, usize)> = Vec::new();
        for &t in train.terminals.iter().filter(|t| !self.torques.contains(t)) {
            if let Some(n) = c.node(t) {
                if open.iter().any(|o| o.1 == n) {
                    return Err(fail(
                        Code::MissingTorque,
                        format!("`{}` turns with another terminal that has no torque either", train.member_name(t)),
                        "prescribe the torque of one of them",
                    ));
                }
                open.push((t, n));
            }
        }
        let mut loaded: Vec<usize> = self.torques.iter().filter_map(|t| c.node(*t)).collect();
        loaded.extend(self.drag.iter().filter_map(|(m, _)| c.node(*m)));
        loaded.extend(self.between.iter().flatten().filter_map(|m| c.node(*m)));
        let open_nodes: Vec<usize> = open.iter().map(|o| o.1).collect();
        // Generic directions of motion: an element at rest whatever the speeds stays at rest.
        let relative: Vec<Option<Vec<f64>>> = c
            .elements
            .iter()
            .map(|e| {
                let (p, q) = (transfer.speeds[e.p.0].as_ref()?, transfer.speeds[e.carrier.0].as_ref()?);
                let sign = Rational::from(i64::from(e.a.sign()));
                Some(p.iter().zip(q).map(|(p, q)| (&(p - q) * &sign).to_f64()).collect())
            })
            .collect();
        let sigma: Vec<Option<i8>> =
            relative.iter().map(|r| r.as_ref().map(|r| i8::from(r.iter().any(|x| *x != 0.0)))).collect();
        let equilibrium = crate::statics::Equilibrium::new(c, &sigma, &open_nodes, &loaded).map_err(|why| {
            use crate::statics::Unsolvable::*;
            match why {
                MissingLoads(n) => {
                    fail(Code::MissingTorque, format!("{n} more torques are needed"), "list them in the request")
                }
                TooManyLoads(n) => fail(
                    Code::TooManyTorques,
                    format!("{n} torques too many"),
                    "leave as many terminals open as there are degrees of freedom",
                ),
                UndeterminedSpeed => {
                    fail(Code::Undetermined, "a loaded part has no determined speed".into(), "prescribe another speed")
                }
                Indeterminate => fail(
                    Code::Indeterminate,
                    "the train is statically indeterminate".into(),
                    "remove the redundant mesh",
                ),
            }
        })?;
        let system = equilibrium.system();
        let k = system.columns.len();
        let moving: Vec<usize> = (0..k).filter(|&j| system.columns[j].rho[0] != system.columns[j].rho[1]).collect();
        if moving.len() > MOST_MOVING {
            let message = format!(
                "{} elements whose direction of power matters: at most {MOST_MOVING} are compiled",
                moving.len()
            );
            return Err(fail(Code::TooLarge, message, "split the train at a shaft"));
        }

        // Features: prescribed torques, prescribed speeds, signs of dragged shafts.
        let l = self.torques.len();
        let mut coulomb: Vec<(Vec<f64>, f64)> = Vec::new(); // speed row of a sign, and its reference for one freedom
        let mut drag_of: Vec<(MemberId, usize, f64, Vec<f64>, ShaftDrag)> = Vec::new();
        for (m, drag) in &self.drag {
            let Some(row) = speed_row(*m) else {
                return Err(fail(
                    Code::Undetermined,
                    format!("`{}` has drag and no determined speed", train.member_name(*m)),
                    "prescribe another speed",
                ));
            };
            if c.node(*m).is_none() || row.iter().all(|x| *x == 0.0) {
                continue;
            }
            // Shafts that turn in fixed proportion share one sign.
            let parallel = |other: &Vec<f64>| {
                let at = row.iter().position(|x| *x != 0.0)?;
                let factor = other[at] / row[at];
                (factor != 0.0 && row.iter().zip(other).all(|(a, b)| (b - a * factor).abs() <= 1e-15 * b.abs()))
                    .then_some(factor.signum())
            };
            let found = coulomb.iter().enumerate().find_map(|(i, (other, _))| parallel(other).map(|s| (i, s)));
            let (index, sign) = found.unwrap_or_else(|| {
                coulomb.push((row.clone(), 1.0));
                (coulomb.len() - 1, 1.0)
            });
            drag_of.push((*m, index, sign, row, *drag));
        }
        let features = l + d + coulomb.len() + self.between.len();
        if features > MOST_FEATURES {
            return Err(fail(Code::TooLarge, format!("{features} independent inputs"), "prescribe fewer"));
        }

        // External torque on each member from each feature (drag and prescribed torques).
        let mut external = vec![vec![0.0; train.members.len()]; features];
        for (i, t) in self.torques.iter().enumerate() {
            external[i][t.0] += 1.0;
        }
        for (m, index, sign, row, drag) in &drag_of {
            external[l + d + index][m.0] -= drag.coulomb * sign;
            for (i, w) in row.iter().enumerate() {
                external[l + i][m.0] -= drag.viscous * w;
            }
        }
        for (i, [a, b]) in self.between.iter().enumerate() {
            for (m, x) in [(a, 1.0), (b, -1.0)] {
                if *m != FRAME {
                    external[features - self.between.len() + i][m.0] += x;
                }
            }
        }
        let load = |feature: usize, node: usize| -> f64 {
            (1..train.members.len())
                .filter(|&m| !c.inner[m] && c.node_of[m] == Some(node))
                .map(|m| external[feature][m])
                .sum()
        };
        let right: Vec<Vec<f64>> = (0..features).map(|i| system.rows.iter().map(|&n| load(i, n)).collect()).collect();

        // Linear outputs: open terminals first, then what was asked for.
        let mut linear: Vec<Linear> = open.iter().map(|o| Linear::Torque(o.0)).collect();
        let mut columns = Vec::new();
        let mut speed_rows: Vec<Vec<f64>> = Vec::new();
        for output in &self.outputs {
            columns.push(self.column(output, &mut linear, &mut speed_rows, &speed_row)?);
        }
        let probe = |forces: &dyn Fn(usize) -> f64, rho: f64, features_on: Option<usize>| -> Vec<f64> {
            self.probe(&open, forces, rho, features_on.map(|i| &external[i][..]), &linear)
        };
        let zero = probe(&|_| 0.0, 1.0, None);
        debug_assert!(zero.iter().all(|x| *x == 0.0));
        let direct: Vec<Vec<f64>> = (0..features).map(|i| probe(&|_| 0.0, 1.0, Some(i))).collect();
        let per_force: Vec<[Vec<f64>; 2]> = system
            .columns
            .iter()
            .map(|col| {
                let unit = |e: usize| if e == col.element { 1.0 } else { 0.0 };
                let at_zero = probe(&unit, 0.0, None);
                let slope = probe(&unit, 1.0, None).iter().zip(&at_zero).map(|(a, b)| a - b).collect();
                [at_zero, slope]
            })
            .collect();

        let terminals: Vec<parts::Terminal> = self
            .torques
            .iter()
            .enumerate()
            .map(|(i, t)| (*t, parts::TorqueFrom::Input(i)))
            .chain(open.iter().enumerate().map(|(i, o)| (o.0, parts::TorqueFrom::Linear(i))))
            .filter(|(t, _)| c.node(*t).is_some())
            .map(|(t, torque)| {
                let row = speed_row(t).unwrap_or_else(|| vec![0.0; d]);
                parts::Terminal { torque, speed: row }
            })
            .collect();
        let parts = parts::Parts {
            speeds: d,
            torques: l,
            signs: coulomb.into_iter().map(|s| s.0).collect(),
            columns: system
                .columns
                .iter()
                .map(|col| parts::Element {
                    rho: col.rho,
                    relative: relative[col.element].clone().unwrap_or_else(|| vec![0.0; d]),
                    entries: col.entries.clone(),
                    arm: c.elements[col.element].a.to_f64().abs(),
                    law: self.laws[col.element],
                    meshes: self.shares(&c.elements[col.element]),
                })
                .collect(),
            right,
            direct,
            per_force,
            speed_rows,
            terminals,
            linear: linear.len(),
            certified: equilibrium.certificate().unique_for_every_load(),
        };
        let general = General::new(parts, &|bounds| equilibrium.regular_between(bounds));
        let single = self.single(&general, &open, &drag_of, &columns);
        let column_of = (0..general.linear()).map(|o| columns.iter().position(|c| *c == Column::Linear(o))).collect();
        Ok(CompiledTrain {
            divides: columns.contains(&Column::Efficiency),
            outputs: columns,
            speeds: d,
            torques: l,
            column_of,
            general,
            single,
            arch: Arch::new(),
        })
    }

    /// What each mesh of an element loses, over the power at its end p: where p drives, and where q does.
    fn shares(&self, e: &Element) -> Vec<(MeshId, [f64; 2])> {
        let eta = |l: &crate::kinematics::Link, forward: bool| {
            let own = &self.c.efficiencies[l.mesh.0];
            if l.along == forward { own.forward.to_f64() } else { own.backward.to_f64() }
        };
        let mut all: Vec<(MeshId, [f64; 2])> = e.links.iter().map(|l| (l.mesh, [0.0; 2])).collect();
        let mut left = 1.0;
        for (l, share) in e.links.iter().zip(&mut all) {
            share.1[0] = left * (1.0 - eta(l, true));
            left *= eta(l, true);
        }
        // What leaves at p is what entered at q times the efficiency.
        let mut left = -e.backward.recip().to_f64();
        for (l, share) in e.links.iter().zip(&mut all).rev() {
            share.1[1] = left * (1.0 - eta(l, false));
            left *= eta(l, false);
        }
        all
    }

    /// The fused kernel for one set with two freedoms, if this request is of that kind.
    fn single(
        &self,
        general: &General,
        open: &[(MemberId, usize)],
        drag: &[(MemberId, usize, f64, Vec<f64>, ShaftDrag)],
        columns: &[Column],
    ) -> Option<Single> {
        if self.laws.iter().any(Option::is_some) || !self.between.is_empty() {
            return None;
        }
        let [loaded] = self.torques[..] else { return None };
        let [first, second] = self.speeds[..] else { return None };
        let node = |m: MemberId| self.c.node(m);
        let terminals = [node(loaded)?, open.first()?.1, open.get(1)?.1];
        let third = *terminals.iter().find(|n| Some(**n) != node(first) && Some(**n) != node(second))?;
        let order = [node(first)?, node(second)?, third];
        let known = columns.iter().all(|c| match c {
            Column::Linear(i) => *i < 2,
            Column::Input(_) | Column::Loss | Column::Efficiency => true,
            Column::Speed(_) => false,
        });
        if !known || open.len() != 2 || order[0] == order[1] || !order.iter().all(|n| terminals.contains(n)) {
            return None;
        }
        let mut drags = [ShaftDrag::default(); 3];
        for (m, .., d) in drag {
            let at = order.iter().position(|n| node(*m) == Some(*n))?;
            drags[at].coulomb += d.coulomb;
            drags[at].viscous += d.viscous;
        }
        let place = |n: usize| order.iter().position(|o| *o == n).expect("checked above");
        let divides = columns.contains(&Column::Efficiency);
        Single::new(general, place(terminals[0]), [place(terminals[1]), place(terminals[2])], drags, divides)
    }

    fn column(
        &self,
        output: &CompiledOutput,
        linear: &mut Vec<Linear>,
        speed_rows: &mut Vec<Vec<f64>>,
        speed_row: &dyn Fn(MemberId) -> Option<Vec<f64>>,
    ) -> Result<Column, Diagnostics> {
        let train = self.train;
        let unknown = |what: &str, name: &str| {
            fail(Code::UnknownName, format!("there is no {what} `{name}` to give that result"), "check the name")
        };
        let mut add = |x: Linear| {
            let at = linear.iter().position(|y| *y == x).unwrap_or_else(|| {
                linear.push(x);
                linear.len() - 1
            });
            Column::Linear(at)
        };
        Ok(match output {
            CompiledOutput::Speed(name) => {
                let m = train.member(name).ok_or_else(|| unknown("member", name))?;
                let row = speed_row(m).ok_or_else(|| {
                    fail(
                        Code::Undetermined,
                        format!("the speed of `{name}` is not determined"),
                        "prescribe another speed",
                    )
                })?;
                speed_rows.push(row);
                Column::Speed(speed_rows.len() - 1)
            }
            CompiledOutput::Torque(name) => {
                let m = train.member(name).ok_or_else(|| unknown("terminal", name))?;
                match self.torques.iter().position(|t| *t == m) {
                    Some(i) => Column::Input(i),
                    None => add(Linear::Torque(m)),
                }
            }
            CompiledOutput::MeshTorque(name) => {
                let mesh = train.mesh(name).ok_or_else(|| unknown("mesh", name))?;
                let first = self.c.elements.iter().position(|e| e.links[0].mesh == mesh && e.links[0].along);
                match first {
                    Some(e) => add(Linear::ElementTorque(e)),
                    None => {
                        return Err(fail(
                            Code::UnknownName,
                            format!("the torque of mesh `{name}` follows from that of the mesh before it"),
                            "ask for the first mesh of the set",
                        ));
                    }
                }
            }
            CompiledOutput::ShiftElementTorque(name) => {
                let e = train.shift_elements.iter().position(|e| e.name == *name);
                let e = ShiftElementId(e.ok_or_else(|| unknown("shift element", name))?);
                if !self.c.engaged.contains(&e) {
                    return Err(fail(Code::UnknownName, format!("`{name}` is not engaged"), "name an engaged element"));
                }
                add(Linear::Tie(e))
            }
            CompiledOutput::Loss => Column::Loss,
            CompiledOutput::Efficiency => Column::Efficiency,
        })
    }

    /// The linear outputs for given forces of the elements, all with one ρ, and external torques.
    fn probe(
        &self,
        open: &[(MemberId, usize)],
        forces: &dyn Fn(usize) -> f64,
        rho: f64,
        external: Option<&[f64]>,
        linear: &[Linear],
    ) -> Vec<f64> {
        let c = &self.c;
        let mut demand = vec![0.0; self.train.members.len()];
        for (j, e) in c.elements.iter().enumerate() {
            let f = forces(j);
            let (a, b) = (e.a.to_f64(), e.b.to_f64() * rho);
            for (member, x) in [(e.p, a), (e.q, b), (e.carrier, -(a + b))] {
                demand[member.0] += f * x;
            }
        }
        let mut total = external.map_or_else(|| vec![0.0; demand.len()], <[f64]>::to_vec);
        let mut balance = vec![0.0; demand.len()];
        for (member, node) in open {
            balance[member.0] = (1..demand.len())
                .filter(|&m| !c.inner[m] && c.node_of[m] == Some(*node))
                .map(|m| demand[m] - total[m])
                .sum();
        }
        // The frame of a tie sees drag and terminal torque together; the terminal only its own.
        total.iter_mut().zip(&balance).for_each(|(t, b)| *t += b);
        let (ties, reactions) = power_flow::ties(c, &demand, &total);
        linear
            .iter()
            .map(|x| match x {
                Linear::Torque(m) => balance[m.0] + reactions[m.0].unwrap_or(f64::NAN),
                Linear::ElementTorque(e) => forces(*e) * c.elements[*e].a.to_f64(),
                Linear::Tie(id) => ties.iter().find(|t| t.element == *id).and_then(|t| t.torque).unwrap_or(f64::NAN),
            })
            .collect()
    }
}

/// A result that is linear in the features for a given sign pattern.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Linear {
    Torque(MemberId),
    /// Torque of end p into an element.
    ElementTorque(usize),
    Tie(ShiftElementId),
}

impl CompiledTrain {
    /// Number of results per point.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Whether every load has exactly one solution.
    pub fn is_certified(&self) -> bool {
        self.general.certified()
    }

    /// Evaluates one point. Nothing is allocated.
    ///
    /// # Panics
    /// If the slices are not as long as the request has speeds, torques and outputs.
    pub fn evaluate(&self, speeds: &[f64], torques: &[f64], work: &mut Workspace, out: &mut [f64]) -> PointVerdict {
        assert_eq!((speeds.len(), torques.len(), out.len()), (self.speeds, self.torques, self.outputs.len()));
        let mut own = [[0.0; MOST_FEATURES]; 2];
        let [speeds, torques] = match self.divides && speeds.iter().chain(torques).any(|x| x.is_subnormal()) {
            false => [speeds, torques],
            true => {
                let [w, t] = &mut own;
                w[..speeds.len()].copy_from_slice(speeds);
                t[..torques.len()].copy_from_slice(torques);
                [batch::without_tiny(&mut w[..speeds.len()]), batch::without_tiny(&mut t[..torques.len()])]
            }
        };
        let mut linear = [0.0; MOST_LINEAR];
        let linear = &mut linear[..self.general.linear()];
        let verdict = self.general.point(speeds, torques, &mut work.hint, linear);
        let (power_in, power) = self.general.powers(speeds, torques, linear);
        for (o, c) in out.iter_mut().zip(&self.outputs) {
            *o = match *c {
                Column::Speed(i) => self.general.speed(i, speeds),
                Column::Input(i) => torques[i],
                Column::Linear(i) => linear[i],
                Column::Loss => power,
                // Nothing times infinity is no number: powers beyond floating point have no efficiency.
                Column::Efficiency if power_in >= kernel::LEAST_POWER => (power_in - power) / power_in + power * 0.0,
                Column::Efficiency => power * 0.0,
            };
        }
        verdict
    }
}
