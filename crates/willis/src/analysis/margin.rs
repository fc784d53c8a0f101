//! How far an equilibrium is from a change: of the loss formula, to locking, and within what friction leaves open.

use crate::exact::Rational;
use crate::power_flow::{Flow, Known};
use crate::statics::{Equilibrium, Solution, torque};
use crate::train::MemberId;

use super::rounds::Rounds;
use super::solution::Frame;
use super::stiction::stiction;
use super::words::name_of;
use super::{Boundary, LockMargin, Margin, StictionRange};

/// `a + b`, zero where they cancel up to round-off.
fn sum(a: f64, b: f64) -> f64 {
    if (a + b).abs() <= 1e-12 * a.abs() { 0.0 } else { a + b }
}

/// The boundary that the smallest change meets.
#[derive(Default)]
struct Nearest(Option<(f64, Boundary)>);

impl Nearest {
    fn offer(&mut self, change: f64, boundary: impl FnOnce() -> Boundary) {
        if self.0.as_ref().is_none_or(|b| change.abs() < b.0) {
            self.0 = Some((change.abs(), boundary()));
        }
    }
}

impl Frame<'_> {
    /// How far this equilibrium is from a change.
    pub fn margin(&self, s: &Solution, flow: &Flow) -> Margin {
        let (lock, lock_loss_factor) = self.locking(s, flow);
        Margin { torque: self.unloading(s), speed: self.standstill(s, flow), lock, lock_loss_factor }
    }

    /// The meshes of an element, or the variator that it is.
    fn meshes_of(&self, element: usize) -> Vec<String> {
        if let Some(k) = element.checked_sub(self.c.gears().len()) {
            return vec![self.c.train.variators[self.c.couplings[k].variator].name.clone()];
        }
        let links = self.c.elements[element].links.iter();
        links.map(|l| self.c.train.meshes[l.mesh.0].name.clone()).collect()
    }

    /// The smallest change of a prescribed torque that unloads a mesh. With one load all forces scale with it, so only
    /// two or more have a boundary.
    fn unloading(&self, s: &Solution) -> Option<Boundary> {
        let (c, scale) = (self.c, self.problem.scale());
        let members = c.train.members.len();
        let torques = self.problem.given.iter().filter(|(m, _)| m.0 < members);
        let given: Vec<(MemberId, usize, f64)> =
            torques.filter_map(|(m, t)| c.node(*m).map(|n| (*m, n, t.to_f64()))).collect();
        let largest = given.iter().fold(0.0f64, |a, g| a.max(g.2.abs()));
        if given.len() < 2 || largest == 0.0 {
            return None;
        }
        let nodes: Vec<usize> = given.iter().map(|g| g.1).collect();
        let mut nearest = Nearest::default();
        for (e, row) in self.equilibrium.sensitivity(s, &nodes).unwrap_or_default() {
            if s.driver[e].is_none() {
                continue;
            }
            for (k, &(member, _, value)) in given.iter().enumerate().filter(|(k, _)| row[*k] != 0.0) {
                let change = -s.forces[e] / row[k];
                nearest.offer(change, || Boundary {
                    member: name_of(c.train, member),
                    value: value * scale,
                    boundary: sum(value, change) * scale,
                    mesh: self.meshes_of(e).join(", "),
                });
            }
        }
        nearest.0.map(|b| b.1)
    }

    /// The smallest change of a prescribed speed that stops the relative motion in a mesh; likewise only with two
    /// freedoms or more.
    fn standstill(&self, s: &Solution, flow: &Flow) -> Option<Boundary> {
        let c = self.c;
        let prescribed: Vec<MemberId> = self.operation.speeds.iter().map(|(m, _)| *m).collect();
        if prescribed.len() < 2 {
            return None;
        }
        let transfer = c.transfer(&prescribed);
        let mut nearest = Nearest::default();
        for (j, e) in c.gears().iter().enumerate().filter(|(j, _)| s.driver[*j].is_some()) {
            let (Some(p), Some(q)) = (&transfer.speeds[e.p.0], &transfer.speeds[e.carrier.0]) else { continue };
            let relative = flow.speeds[e.p.0] - flow.speeds[e.carrier.0];
            for (k, &member) in prescribed.iter().enumerate() {
                let factor = (&p[k] - &q[k]).to_f64();
                if factor == 0.0 {
                    continue;
                }
                let (change, value) = (-relative / factor, flow.speeds[member.0]);
                nearest.offer(change, || Boundary {
                    member: c.train.member_name(member).to_owned(),
                    value,
                    boundary: sum(value, change),
                    mesh: self.meshes_of(j).join(", "),
                });
            }
        }
        nearest.0.map(|b| b.1)
    }

    /// The nearest efficiency, and the factor on all losses, at which the train locks: with the loads at the outputs
    /// given, the torque of the input grows there without bound.
    fn locking(&self, s: &Solution, flow: &Flow) -> (Option<LockMargin>, Option<f64>) {
        let c = self.c;
        if c.degrees_of_freedom() != 1 || flow.output_power <= 0.0 {
            return (None, None);
        }
        let nodes = |role: i8| -> Vec<usize> {
            let terminals = self.problem.terminals.iter().map(|(m, _)| *m);
            terminals.filter(|m| flow.roles[m.0] == role).filter_map(|m| c.node(m)).collect()
        };
        let (inputs, outputs) = (nodes(1), nodes(-1));
        let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, self.motion)).collect();
        let resisting = match inputs[..] {
            [input] if !outputs.contains(&input) => Equilibrium::new(c, &sigma, &[input], &outputs).ok(),
            _ => None,
        };
        let Some((resisting, s)) = resisting.and_then(|r| r.same_pattern(s).map(|s| (r, s))) else {
            return (None, None);
        };
        let lock = resisting.lock_thresholds(&s).into_iter().map(|(e, threshold)| LockMargin {
            meshes: self.meshes_of(e),
            efficiency: match s.driver[e] {
                Some(false) => c.elements[e].backward.to_f64(),
                _ => c.elements[e].forward.to_f64(),
            },
            threshold,
        });
        let nearest = lock.min_by(|a, b| (a.efficiency - a.threshold).total_cmp(&(b.efficiency - b.threshold)));
        (nearest, resisting.lock_factor(&s))
    }

    /// Ranges that friction in loaded meshes at rest leaves open.
    pub fn stiction(&self, s: &Solution, flow: &Flow) -> Vec<StictionRange> {
        if let Some(agreed) = self.agreed {
            let (rows, columns) = self.equilibrium.solved(s);
            let known = Known { c: self.c, rows: &rows, columns: &columns };
            let rounds = Rounds::new(known, self.motion, self.operation, self.sigma, self.undragged);
            if let Some(rounds) = rounds {
                return rounds.stiction(&agreed.step, flow);
            }
        }
        let c = self.c;
        let stuck: Vec<usize> = (0..c.gears().len())
            .filter(|&j| {
                let e = &c.elements[j];
                let lossy = e.forward != Rational::ONE || e.backward != Rational::ONE;
                lossy && s.forces[j] != 0.0 && self.sigma[j] == Some(0)
            })
            .collect();
        let rho = |j: usize, p: bool| {
            let e = &c.elements[j];
            if p { e.forward.to_f64() } else { 1.0 / e.backward.to_f64() }
        };
        stiction(c, flow, &stuck, rho, |choice| {
            let shifted = self.equilibrium.with_rho(s, choice, &self.problem.torques)?;
            Some(stuck_flow(self, &shifted))
        })
    }
}

/// External torques with other ρ in stuck elements. The mesh walk of [`Flow`] takes ρ from the
/// driver, so the torques are summed here from the elements.
fn stuck_flow(frame: &Frame<'_>, s: &Solution) -> Vec<Option<f64>> {
    let c = frame.c;
    let scale = frame.problem.scale();
    let mut demand: Vec<f64> = crate::power_flow::demand(c, &s.forces, &s.rho).iter().map(|x| x * scale).collect();
    let mut external = vec![0.0; demand.len()];
    for d in &frame.problem.driven {
        let machine = &c.train.variators[d.at[0]].machines()[d.at[1]];
        demand[machine.member.0] -= d.torque;
    }
    for (member, prescribed) in &frame.problem.terminals {
        external[member.0] = match (prescribed, c.node(*member)) {
            (Some(t), _) => t.to_f64() * scale,
            (None, Some(n)) => (torque(c, s, n) - frame.problem.torques[n].to_f64()) * scale,
            (None, None) => 0.0,
        };
    }
    let (_, reactions) = crate::power_flow::ties(c, &demand, &external);
    reactions.into_iter().zip(&external).map(|(r, x)| r.map(|r| r + x)).collect()
}
