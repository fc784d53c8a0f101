//! Laws and statics in floating point, where it is known which ends drive.

use std::sync::{Arc, OnceLock};

use smallvec::SmallVec;

use crate::kinematics::{Configuration, Motion, Node};
use crate::operating_point::{Approach, Convergence, Idle, Physics, Step};
use crate::power_flow::{Drag, External, Flow, Known, demand, rho, ties};
use crate::statics::{Equilibrium, SolvedColumn};
use crate::train::{MemberId, Operation};

use super::StictionRange;
use super::loads::Loads;
use super::stiction::stiction;

/// What all rounds have in common.
pub(super) struct Rounds<'a> {
    known: Known<'a>,
    sigma: &'a [Option<i8>],
    problem: &'a Loads,
    /// SI, by member; zero where they are not determined.
    speeds: Vec<f64>,
    /// Torque on each node that has an equation, N m; drags are not in it.
    loads: Vec<(Node, f64)>,
    /// Given efficiency of each mesh, first gear driving and second gear driving.
    given: Vec<[f64; 2]>,
}

impl<'a> Rounds<'a> {
    /// `None` where more than gears is to be solved. `problem` are the loads without drags.
    pub fn new(
        known: Known<'a>,
        motion: &Motion,
        operation: &Operation,
        sigma: &'a [Option<i8>],
        problem: &'a Loads,
    ) -> Option<Self> {
        let c = known.c;
        if !c.train.variators.is_empty() || !operation.machines.is_empty() {
            return None;
        }
        let scale = problem.scale();
        let loads = known.rows.iter().map(|&n| (Some(n), problem.torques[n].to_f64() * scale)).collect();
        let speeds = (0..c.node_of.len()).map(|m| motion.si(MemberId(m)).unwrap_or(0.0)).collect();
        let given =
            c.train.meshes.iter().map(|m| [m.efficiency.forward.to_f64(), m.efficiency.backward.to_f64()]).collect();
        Some(Self { known, sigma, problem, speeds, loads, given })
    }

    fn c(&self) -> &Configuration<'a> {
        self.known.c
    }

    /// The flow with the losses of a step: speeds, meshes and drags. `None` where other ends drive than was taken, or a part
    /// that carried nothing does now.
    pub fn flow(&self, step: &Step) -> Option<Flow> {
        let (c, known) = (self.c(), self.known);
        if step.is_locked() {
            return None;
        }
        let efficiencies = step.efficiencies(c.train, &self.given);
        let is_open = |node: Node| node.is_none_or(|n| self.problem.open.contains(&n));
        if !self.dragged(step).all(|(node, _)| is_open(node) || known.row(node).is_some()) {
            return None;
        }
        let of = |column: &SolvedColumn| rho(&c.elements[column.element], column.p_drives, &efficiencies);
        let forces = self.forces(step, of)?;
        let drives = |element: usize| match forces[element] * f64::from(self.sigma[element].unwrap_or(0)) {
            0.0 => None,
            power => Some(power > 0.0),
        };
        let turned = |column: &SolvedColumn| {
            let [p, q] = self.rho_between(column, &efficiencies);
            column.p_drives.is_some() && drives(column.element) != column.p_drives && p != q
        };
        if !forces.iter().all(|f| f.is_finite()) || known.columns.iter().any(turned) {
            return None;
        }
        let meshes = known.meshes(&forces, &self.speeds, &efficiencies, drives);
        let relative = |d: &Drag| self.speeds[d.members[1].0] - self.speeds[d.members[0].0];
        let drag_losses = step.drags.iter().map(|d| d.torque * relative(d)).collect();
        Some(Flow { speeds: self.speeds.clone(), meshes, drag_losses, ..Flow::default() })
    }

    /// What the drags of a step exert on nodes, N m.
    fn dragged<'s>(&'s self, step: &'s Step) -> impl Iterator<Item = (Node, f64)> + 's {
        let both = step.drags.iter().flat_map(|d| [(d.members[0], d.torque), (d.members[1], -d.torque)]);
        both.map(|(member, torque)| (self.c().node(member), torque))
    }

    /// The force in each element with the drags of a step and these ρ.
    fn forces(&self, step: &Step, rho: impl Fn(&SolvedColumn) -> f64) -> Option<SmallVec<[f64; 8]>> {
        let entries = |column: &SolvedColumn, add: &mut dyn FnMut(usize, f64)| {
            let rho = rho(column);
            column.entries.iter().for_each(|&(row, constant, slope)| add(row, rho * slope + constant));
        };
        self.known.forces(entries, self.loads.iter().copied().chain(self.dragged(step)))
    }

    /// Ranges that friction in loaded meshes at rest leaves open; `whole` is the whole flow of the step.
    pub fn stiction(&self, step: &Step, whole: &Flow) -> Vec<StictionRange> {
        if self.known.columns.iter().all(|column| column.p_drives.is_some()) {
            return vec![];
        }
        let c = self.c();
        let efficiencies = step.efficiencies(c.train, &self.given);
        let end = |j: usize, p: bool| rho(&c.elements[j], Some(p), &efficiencies);
        let taken = |column: &SolvedColumn| rho(&c.elements[column.element], column.p_drives, &efficiencies);
        let Some(forces) = self.forces(step, taken) else { return vec![] };
        let is_stuck = |j: &usize| {
            forces[*j] != 0.0 && self.sigma[*j] == Some(0) && (end(*j, true) != 1.0 || end(*j, false) != 1.0)
        };
        let stuck: Vec<usize> = (0..c.gears().len()).filter(is_stuck).collect();
        let scale = self.problem.scale();
        stiction(c, whole, &stuck, end, |choice| {
            let mut rho = vec![1.0; c.elements.len()];
            self.known.columns.iter().for_each(|column| rho[column.element] = taken(column));
            choice.iter().for_each(|(j, own)| rho[*j] = *own);
            let forces = self.forces(step, |column| rho[column.element])?;
            let demand = demand(c, &forces, &rho);
            // What elements and drags ask of each node.
            let mut asked = vec![0.0; c.nodes];
            for (m, torque) in demand.iter().enumerate().filter(|(m, _)| !c.inner[*m]) {
                c.node(MemberId(m)).into_iter().for_each(|n| asked[n] += torque);
            }
            for (node, torque) in self.dragged(step) {
                node.into_iter().for_each(|n| asked[n] -= torque);
            }
            let mut external = vec![0.0; demand.len()];
            for (member, prescribed) in &self.problem.terminals {
                external[member.0] = match (prescribed, c.node(*member)) {
                    (Some(torque), _) => torque.to_f64() * scale,
                    (None, Some(n)) => asked[n] - self.problem.torques[n].to_f64() * scale,
                    (None, None) => 0.0,
                };
            }
            let (_, reactions) = ties(c, &demand, &external);
            Some(reactions.into_iter().zip(&external).map(|(r, x)| r.map(|r| r + x)).collect())
        })
    }

    /// Losses in agreement with the torques, from a train without any; `None` where other ends drive on the way.
    pub fn agree(&self, physics: &Physics<'_>, motion: &Motion) -> Option<Agreed> {
        let (start, idle) = self.start(physics, motion, None)?;
        self.agree_from(physics, motion, Approach::new(start).with(idle))
    }

    /// The same, with what no load changes where `known` has it of these speeds at this temperature of the oil; else it is put
    /// there.
    pub fn agree_again(&self, physics: &Physics<'_>, motion: &Motion, known: &mut Option<KnownIdle>) -> Option<Agreed> {
        let oil = physics.temperature();
        let same = known.as_ref().filter(|k| k.speeds == self.speeds && k.oil == oil).map(|k| k.idle.clone());
        let is_new = same.is_none();
        let (start, idle) = self.start(physics, motion, same)?;
        if is_new {
            *known = Some(KnownIdle { speeds: self.speeds.clone(), oil, idle: idle.clone() });
        }
        self.agree_from(physics, motion, Approach::new(start).with(idle))
    }

    /// The same for losses that are compared with others closely, which may begin near those of a neighbour.
    pub fn agree_closely(&self, physics: &Physics<'_>, motion: &Motion, near: Option<&Step>) -> Option<Agreed> {
        let from = match near {
            Some(near) => Approach::closely(near.clone()),
            None => {
                let (start, idle) = self.start(physics, motion, None)?;
                Approach::closely(start).with(idle)
            }
        };
        self.agree_from(physics, motion, from)
    }

    /// The losses for the torques that there are without losses, and those of them that do not depend on the load.
    fn start(&self, physics: &Physics<'_>, motion: &Motion, idle: Option<Arc<Idle>>) -> Option<(Step, Arc<Idle>)> {
        let flow = self.flow(&Step::lossless(self.c().train))?;
        let idle = idle.unwrap_or_else(|| Arc::new(physics.idle(&flow, motion)));
        Some((physics.step(&flow, motion, &idle), idle))
    }

    fn agree_from(&self, physics: &Physics<'_>, motion: &Motion, from: Approach) -> Option<Agreed> {
        let (step, (), flow, convergence) =
            physics.agree(motion, from, |step| self.flow(step).map(|flow| ((), flow)))?;
        let acting = self.acting(&step, &flow);
        convergence.converged.then_some(Agreed { step, flow, convergence, acting })
    }

    /// What acts on each terminal in the flow of a step.
    fn acting(&self, step: &Step, flow: &Flow) -> Vec<Acting> {
        let c = self.c();
        // What elements and drags ask of each node, and the sizes of its terms.
        let mut asked = vec![[0.0; 2]; c.nodes];
        let mut ask = |member: MemberId, torque: f64| {
            if let Some(n) = c.node(member).filter(|_| !c.inner[member.0]) {
                asked[n][0] += torque;
                asked[n][1] += torque.abs();
            }
        };
        for m in &flow.meshes {
            let mesh = &c.train.meshes[m.mesh.index()];
            let members = [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier];
            members.into_iter().zip(m.torques).for_each(|(member, torque)| ask(member, torque));
        }
        for d in &step.drags {
            ask(d.members[0], -d.torque);
            ask(d.members[1], d.torque);
        }
        let scale = self.problem.scale();
        let terminals = self.problem.terminals.iter().map(|(member, prescribed)| {
            let [torque, size] = match (prescribed, c.node(*member)) {
                (Some(torque), _) => [torque.to_f64() * scale; 2],
                (None, Some(n)) => {
                    let given = self.problem.torques[n].to_f64() * scale;
                    [asked[n][0] - given, asked[n][1] + given.abs()]
                }
                (None, None) => [0.0; 2],
            };
            Acting { member: *member, torque, size: size.abs() }
        });
        terminals.collect()
    }

    /// Of a column's element: ρ when its first end drives, and when its second does.
    fn rho_between(&self, column: &SolvedColumn, efficiencies: &[[f64; 2]]) -> [f64; 2] {
        match column.p_drives {
            None => [1.0; 2],
            Some(_) => [true, false].map(|p| rho(&self.c().elements[column.element], Some(p), efficiencies)),
        }
    }

    /// Whether this agreement is the only one, beyond the doubts of rounding, and drives its load in spite of the drags.
    /// `equilibrium` is the problem of `known`, with whatever losses; `regular` keeps what was proved at other points.
    pub fn is_only(&self, equilibrium: &Equilibrium, agreed: &Agreed, regular: &OnceLock<Vec<[f64; 2]>>) -> bool {
        let c = self.c();
        let Agreed { step, acting, .. } = agreed;
        let efficiencies = step.efficiencies(c.train, &self.given);
        let rho: Vec<[f64; 2]> = self.known.columns.iter().map(|k| self.rho_between(k, &efficiencies)).collect();
        let mut torques: Vec<f64> = self.loads.iter().map(|(_, torque)| *torque).collect();
        for d in &step.drags {
            for (member, torque) in [(d.members[0], d.torque), (d.members[1], -d.torque)] {
                if let Some(row) = self.known.row(c.node(member)) {
                    torques[row] += torque;
                }
            }
        }
        let gives = acting.iter().any(|x| x.torque * self.speeds[x.member.0] < 0.0 && x.is_certain());
        let drives = gives
            || c.degrees_of_freedom() != 1
            || self.problem.are_none()
            // Drag may eat a small load up; only tooth friction locks.
            || self.drives_without_drags(step);
        drives && equilibrium.is_only(self.known.columns, &rho, &torques, regular)
    }

    /// Whether a load is driven, beyond doubt, if nothing but the losses of the meshes resists.
    fn drives_without_drags(&self, step: &Step) -> bool {
        let step = step.without_drags();
        let gives = |x: &Acting| x.torque * self.speeds[x.member.0] < 0.0 && x.is_certain();
        self.flow(&step).is_some_and(|flow| self.acting(&step, &flow).iter().any(gives))
    }
}

/// What of the losses no load changes, and at which speeds and temperature of the oil.
pub(super) struct KnownIdle {
    speeds: Vec<f64>,
    oil: Option<f64>,
    idle: Arc<Idle>,
}

/// Losses and torques in agreement, in floating point.
pub(super) struct Agreed {
    pub step: Step,
    /// Speeds, meshes and drags.
    pub flow: Flow,
    pub convergence: Convergence,
    /// In the order of the terminals.
    pub acting: Vec<Acting>,
}

/// The torque on a terminal.
pub(super) struct Acting {
    pub member: MemberId,
    /// N m.
    pub torque: f64,
    /// The sum of the sizes of the terms that it is a sum of.
    pub size: f64,
}

/// A torque that is a sum of terms is certain in sign where it is larger than this part of their sizes: far above what
/// rounding makes of them.
const CERTAIN: f64 = 1e-9;

impl Acting {
    /// Whether its sign is beyond the doubts of rounding.
    pub fn is_certain(&self) -> bool {
        self.torque.abs() > CERTAIN * self.size
    }
}

impl Agreed {
    /// The whole flow; `externals` tell the signs of powers, and powers that are prescribed.
    pub fn whole(&self, c: &Configuration<'_>, externals: &[External]) -> Flow {
        let own = |(x, told): (&External, &Acting)| External { torque: told.torque, ..*x };
        let externals: Vec<External> = externals.iter().zip(&self.acting).map(own).collect();
        let Flow { speeds, meshes, .. } = self.flow.clone();
        Flow::assemble(c, speeds, meshes, vec![], &externals, &self.step.drags)
    }
}
