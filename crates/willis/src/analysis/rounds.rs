//! Laws and statics in floating point, where it is known which ends drive.

use crate::kinematics::{Configuration, Motion, Node};
use crate::operating_point::Step;
use crate::power_flow::{Drag, Flow, Known, rho};
use crate::statics::{Equilibrium, SolvedColumn};
use crate::train::{MemberId, Operation};

use super::loads::Loads;

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
        if !c.couplings.is_empty() || !operation.machines.is_empty() {
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
        let efficiencies = step.efficiencies(c.train, &self.given);
        let dragged = step.drags.iter().flat_map(|d| [(d.members[0], d.torque), (d.members[1], -d.torque)]);
        let dragged: Vec<(Node, f64)> = dragged.map(|(member, torque)| (c.node(member), torque)).collect();
        let is_open = |node: Node| node.is_none_or(|n| self.problem.open.contains(&n));
        if !dragged.iter().all(|(node, _)| is_open(*node) || known.row(*node).is_some()) {
            return None;
        }
        let entries = |column: &SolvedColumn, add: &mut dyn FnMut(usize, f64)| {
            let rho = rho(&c.elements[column.element], column.p_drives, &efficiencies);
            column.entries.iter().for_each(|&(row, constant, slope)| add(row, rho * slope + constant));
        };
        let forces = known.forces(entries, self.loads.iter().copied().chain(dragged))?;
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

    /// Of a column's element: ρ when its first end drives, and when its second does.
    fn rho_between(&self, column: &SolvedColumn, efficiencies: &[[f64; 2]]) -> [f64; 2] {
        match column.p_drives {
            None => [1.0; 2],
            Some(_) => [true, false].map(|p| rho(&self.c().elements[column.element], Some(p), efficiencies)),
        }
    }

    /// Whether the flow of a step is the only one, beyond the doubts of rounding, and drives its load in spite of the drags.
    /// `equilibrium` is the problem of `known`, with whatever losses.
    pub fn is_only(&self, equilibrium: &Equilibrium, step: &Step, flow: &Flow) -> bool {
        let c = self.c();
        let efficiencies = step.efficiencies(c.train, &self.given);
        let rho: Vec<[f64; 2]> = self.known.columns.iter().map(|k| self.rho_between(k, &efficiencies)).collect();
        let mut torques: Vec<f64> = self.loads.iter().map(|(_, torque)| *torque).collect();
        // What elements and drags ask of each node.
        let mut asked = vec![0.0; c.nodes];
        let mut ask = |member: MemberId, torque: f64| {
            if let Some(n) = c.node(member).filter(|_| !c.inner[member.0]) {
                asked[n] += torque;
            }
        };
        for m in &flow.meshes {
            let mesh = &c.train.meshes[m.mesh.index()];
            let members = [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier];
            members.into_iter().zip(m.torques).for_each(|(member, torque)| ask(member, torque));
        }
        for d in &step.drags {
            for (member, torque) in [(d.members[0], d.torque), (d.members[1], -d.torque)] {
                ask(member, -torque);
                if let Some(row) = self.known.row(c.node(member)) {
                    torques[row] += torque;
                }
            }
        }
        let scale = self.problem.scale();
        let gives = self.problem.terminals.iter().any(|(member, prescribed)| {
            let torque = match (prescribed, c.node(*member)) {
                (Some(torque), _) => torque.to_f64() * scale,
                (None, Some(n)) => asked[n] - self.problem.torques[n].to_f64() * scale,
                (None, None) => 0.0,
            };
            torque * self.speeds[member.0] < 0.0
        });
        let drives = gives || c.degrees_of_freedom() != 1 || self.problem.are_none();
        drives && equilibrium.is_only(self.known.columns, &rho, &torques)
    }
}
