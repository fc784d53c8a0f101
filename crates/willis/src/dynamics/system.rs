//! The equations of motion of a train in a scenario, made ready for evaluation.
//!
//! Coordinates are independent speeds `v`, chosen among the members, and prescribed speeds `u`; every
//! speed is `ω = N (v, u)` by exact elimination. With the inertia matrix M over the nodes and for each
//! mesh element (a gear pair, or a chain through planets that carry nothing else) its force variable f,
//!
//! ```text
//! M N (v̇, u̇) + Σ f_j g_j + Σ L_j h_j = Q + Σ r_i e_i
//! g = a e_p + b e_q − (a+b) e_c,   h = −(b/a)(e_q − e_c),   power lost = L (ω_p − ω_c)
//! ```
//!
//! `g` is the Willis equation of the element, `a f` the torque that its first gear takes from the shaft,
//! `L` its loss as a torque at the first gear, and `r` the torques behind prescribed speeds. With `L = α a f + β`,
//! whose coefficients depend on direction of motion and of power only, all accelerations and forces are
//! linear in the torques `τ` of the *ports*. A port is a pattern of torque on the nodes: a source, a drag, a shaft, a
//! shift element, the loss of a mesh, the acceleration of a prescribed speed.
//! Source: Galvagno 2010, eqs. (8)–(15), with corrected signs; the loss law is that of Modelica's `LossyGear`.

mod checks;
mod coordinates;
mod drivers;
mod frictions;
mod groups;
mod inertia;
mod meshes;
mod paths;
mod ports;
mod reactions;
mod shafts;
mod traces;
mod uniqueness;

use std::sync::Arc;

use nalgebra::DMatrix;

use crate::diagnostic::Diagnostics;
use crate::exact::Rational;
use crate::kinematics::Configuration;
use crate::train::{MemberId, Scenario, Signal, SourceKind, Train, Variator};

use super::bodies::Bodies;
use super::decision::Body;
use super::dense;
use super::element::Element;
use super::laws::Laws;
use super::report::EnergyLossKind;
use super::rounding::unless_rounding;
use super::source::{signals_of, upright};

use coordinates::Coordinates;
use drivers::{Driver, Drivers};
use frictions::{Friction, drags, law_places, shift_elements};
use groups::{Group, slip_together};
use inertia::{Accelerations, NodeInertia, massless};
use meshes::Meshes;
use paths::Paths;
use ports::Ports;
use reactions::{Reaction, reactions};
use shafts::{Elastic, shafts};
use traces::Traces;

pub(super) use frictions::Rubs;
pub(super) use paths::{BusMachine, Geared, GivenStore, MachineDoes, Path, PathKind};

/// A train in a scenario.
#[derive(Clone)]
pub(crate) struct System {
    pub train: Train,
    pub scenario: Scenario,
    /// Free coordinates.
    pub free: usize,
    /// Prescribed coordinates, after them.
    pub prescribed: usize,
    pub coordinates: Vec<MemberId>,
    /// Those that have but a trace of inertia, and the row that is zero where they start as what leads them.
    pub followers: Vec<(usize, Vec<f64>)>,
    /// Bodies of the coordinates.
    pub coordinate_bodies: Vec<Body>,
    pub bodies: Bodies,
    pub nodes: usize,
    /// Every member's speed over the coordinates.
    pub speeds: Vec<Vec<f64>>,
    /// The same, exactly.
    pub exact_speeds: Arc<[Vec<Rational>]>,
    pub elements: Vec<Element>,
    pub frictions: Vec<Friction>,
    pub groups: Vec<Group>,
    pub elastic: Vec<Elastic>,
    /// What holds it from outside.
    pub reactions: Vec<Reaction>,
    pub drivers: Vec<Driver>,
    /// Variators.
    pub paths: Vec<Path>,
    /// Number of integrals of controllers and variators.
    pub integrals: usize,
    /// Laws that losses follow.
    pub laws: Option<Box<Laws>>,
    pub ports: usize,
    /// First port of the prescribed accelerations.
    pub port_of_prescribed: usize,
    /// Kinetic energy is `½ (v,u)ᵀ energy (v,u)`.
    pub energy: DMatrix<f64>,
    /// `Nᵀ M N` over the free coordinates, with what controllers add.
    pub mass: DMatrix<f64>,
    /// Left columns of the equations without losses: accelerations, reactions.
    left: DMatrix<f64>,
    /// Columns g and h of every element.
    gear: DMatrix<f64>,
    loss: DMatrix<f64>,
    /// Columns of the ports.
    port_columns: DMatrix<f64>,
    pub assumptions: Vec<String>,
}

impl System {
    /// # Errors
    /// Speeds that contradict each other, coordinates without inertia, meshes whose forces are not
    /// determined.
    ///
    /// `step`: the length of the steps, s, it is made for; 0 where that is adapted. `warms`: whether the temperature of the oil
    /// follows what is lost, where the train says what carries its heat away.
    pub fn new(train: &Train, name: &str, step: f64, warms: bool) -> Result<Self, Diagnostics> {
        let scenario = train.find_scenario(name)?;
        let laws = Laws::of(train);
        let c = Configuration::new(train, &[], &scenario.fixed, &visible(train, scenario, laws.as_ref()));
        checks::forces_and_freedom(&c, scenario)?;
        checks::pulses(scenario)?;
        checks::rates(scenario)?;
        let coordinates = Coordinates::of(&c, scenario)?;
        let warms = warms && train.heat().is_some_and(|h| h.is_stored());
        Self::assemble(scenario, step, warms, &c, coordinates, laws)
    }

    /// The equations of motion, part by part. The order of the parts is that of their ports.
    fn assemble(
        scenario: &Scenario,
        step: f64,
        warms: bool,
        c: &Configuration<'_>,
        coordinates: Coordinates,
        mut laws: Option<Laws>,
    ) -> Result<Self, Diagnostics> {
        let train = c.train;
        let mut assumptions: Vec<String> = train.assumptions().to_vec();
        let mut inertia = NodeInertia::of(c);
        let mut ports = Ports::new(c, &coordinates);

        // What acts between members.
        let Drivers { drivers, rolling, integrals } = Drivers::of(scenario, &mut inertia, &mut ports);
        // Rolling resistances come first: their drivers know them by position.
        let mut frictions = rolling;
        frictions.extend(drags(train, &mut ports));
        frictions.extend(shift_elements(train, scenario, &mut ports));
        if let Some(laws) = &mut laws {
            laws.first = frictions.len();
            frictions.extend(law_places(laws, &mut ports));
            assumptions.extend(laws.assumptions(train, warms));
        }
        assumptions.extend(not_followed(train));
        let mut paths = Paths::of(train, scenario, integrals, frictions.len(), &mut ports)?;
        frictions.append(&mut paths.rubbing);
        let elastic = shafts(c, scenario, &mut ports);
        let traces = Traces::of(scenario, step, &coordinates, train, &frictions, &elastic, &inertia);
        assumptions.extend(traces.assumption(train));
        traces.given.iter().for_each(|&(member, value)| inertia.add(member, value));
        // Steps of fixed length damp by themselves what they do not resolve.
        if step == 0.0 {
            frictions.extend(traces.dampers(train, &coordinates, &elastic, &mut ports));
        }
        let Meshes { mut elements, gear, loss } = Meshes::of(c, &coordinates, laws.is_some(), &mut ports);
        let groups = slip_together(c, &coordinates, &mut frictions, &mut elements);
        let reactions = reactions(c, scenario, &coordinates, &frictions, &paths.all, &traces.given);

        let node = |m: &MemberId| c.node(*m);
        let coordinate_bodies: Vec<Body> = coordinates.chosen.iter().map(node).collect();
        let bodies = Bodies {
            count: c.nodes,
            inertias: inertia.parts.clone(),
            meshes: meshes::contacts(c, &elements),
            frictions: frictions.iter().map(|f| f.members.map(|m| c.node(m))).collect(),
            prescribed: coordinate_bodies[coordinates.free..].to_vec(),
        };

        // What resists acceleration.
        let Accelerations { left, prescribed, mass, energy } = inertia.accelerations(&coordinates);
        let port_of_prescribed = ports.count();
        for column in prescribed {
            ports.add(column);
        }
        ports.at_least_one();
        let (ports, port_columns) = (ports.count(), ports.matrix());
        massless(&mass, &coordinates.speeds, train, scenario)?;
        paths.stiffen(train, scenario, &coordinates, &mass)?;
        assumptions.extend(paths.assumptions(train, scenario));

        for source in scenario.sources.iter().filter(|s| matches!(s.kind, SourceKind::Vehicle { .. })) {
            assumptions.push(format!(
                "{}: its rolling resistance and air drag are part of what it takes, not losses of the train",
                source.name
            ));
        }
        Ok(Self {
            train: train.clone(),
            scenario: scenario.clone(),
            free: coordinates.free,
            prescribed: coordinates.prescribed().len(),
            followers: (traces.given.iter().zip(traces.leads))
                .map(|((member, _), lead)| {
                    (coordinates.chosen.iter().position(|m| m == member).expect("a coordinate"), lead)
                })
                .collect(),
            coordinates: coordinates.chosen,
            coordinate_bodies,
            bodies,
            nodes: c.nodes,
            speeds: coordinates.speeds,
            exact_speeds: coordinates.exact.into(),
            elements,
            frictions,
            groups,
            elastic,
            reactions,
            drivers,
            integrals: paths.integrals,
            paths: paths.all,
            laws: laws.map(Box::new),
            ports,
            port_of_prescribed,
            energy,
            mass,
            left,
            gear,
            loss,
            port_columns,
            assumptions,
        })
    }

    /// Accounts of what comes in from outside: one for each source, then one for each variator, of its store.
    pub fn accounts(&self) -> usize {
        self.drivers.len() + self.paths.len()
    }

    /// Coordinates of both kinds.
    pub fn all(&self) -> usize {
        self.free + self.prescribed
    }

    /// Rows of a solution: accelerations, torques behind prescribed speeds, mesh forces.
    pub fn unknowns(&self) -> usize {
        self.nodes
    }

    /// The equations with loss slopes `slopes`, one for each element, and with a torque against the relative
    /// acceleration of each shaft; by rows.
    fn matrix(&self, slopes: &[f64], resists: &[f64]) -> Vec<f64> {
        let (n, all) = (self.nodes, self.all());
        let mut k = vec![0.0; n * n];
        for (i, row) in k.chunks_exact_mut(n).enumerate() {
            let (accelerations, forces) = row.split_at_mut(all);
            accelerations.iter_mut().enumerate().for_each(|(c, x)| *x = self.left[(i, c)]);
            for (j, (x, e)) in forces.iter_mut().zip(&self.elements).enumerate() {
                *x = self.gear[(i, j)] + self.loss[(i, j)] * (slopes[j] * e.factors[0]);
            }
            for (e, d) in self.elastic.iter().zip(resists) {
                let port = self.port_columns[(i, e.port)];
                accelerations[..self.free].iter_mut().zip(&e.row).for_each(|(x, row)| *x += d * row * port);
            }
        }
        k
    }

    /// Accelerations and forces for a unit torque in each port: unknowns × ports, by rows. `None` if the equations
    /// have no unique solution with these slopes. `resists`: the torque of each shaft against its relative
    /// acceleration, which steps of fixed length add; empty where there is none.
    pub fn response(&self, slopes: &[f64], resists: &[f64]) -> Option<Vec<f64>> {
        let (n, p) = (self.nodes, self.ports);
        if n == 0 {
            return Some(vec![]);
        }
        let matrix = self.matrix(slopes, resists);
        let mut right: Vec<f64> = (0..n * p).map(|k| self.port_columns[(k / p, k % p)]).collect();
        for (e, d) in self.elastic.iter().zip(resists) {
            for (i, row) in right.chunks_exact_mut(p).enumerate() {
                let port = self.port_columns[(i, e.port)];
                let behind = &mut row[self.port_of_prescribed..][..self.prescribed];
                behind.iter_mut().zip(&e.row[self.free..]).for_each(|(x, row)| *x -= d * row * port);
            }
        }
        let inverse = dense::inverse(&matrix, n)?;
        let mut x = vec![0.0; n * p];
        dense::add_product(&mut x, &inverse, &right, [n, p]);
        let minus: Vec<f64> = matrix.iter().map(|k| -k).collect();
        let mut left_over = right.clone();
        dense::add_product(&mut left_over, &minus, &x, [n, p]);
        dense::add_product(&mut x, &inverse, &left_over, [n, p]);
        // Bound of the error that rounding of the equations makes (Skeel 1979): what is within it is zero, as the force
        // in an idle mesh.
        let amounts = |of: &[f64]| -> Vec<f64> { of.iter().map(|x| x.abs()).collect() };
        let mut sums = amounts(&right);
        dense::add_product(&mut sums, &amounts(&matrix), &amounts(&x), [n, p]);
        let mut bound = vec![0.0; n * p];
        dense::add_product(&mut bound, &amounts(&inverse), &sums, [n, p]);
        x.iter_mut().zip(&bound).for_each(|(x, bound)| *x = unless_rounding(*x, *bound));
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    /// Adds the torques of the first ports to those on the nodes.
    pub fn add_torques(&self, tau: &[f64], torques: &mut [[f64; 2]]) {
        for (column, tau) in self.port_columns.column_iter().zip(tau).filter(|(_, tau)| **tau != 0.0) {
            column.iter().zip(&mut *torques).for_each(|(x, sum)| sum[0] += x * tau);
        }
    }

    /// Adds what a force in a mesh element puts on the nodes, without loss.
    pub fn add_force(&self, element: usize, force: f64, torques: &mut [[f64; 2]]) {
        self.gear.column(element).iter().zip(torques).for_each(|(x, sum)| sum[0] += x * force);
    }

    /// What governs how far a friction element is engaged, if anything does: the position among the signals, and
    /// the signal.
    pub fn governor(&self, f: &Friction) -> Option<(usize, &Signal)> {
        let first =
            |k: usize| -> usize { self.scenario.sources[..k].iter().map(|s| signals_of(&s.kind).count()).sum() };
        if let Some(k) = f.rolls {
            let grade = signals_of(&self.scenario.sources[k].kind).next().expect("a vehicle has a grade");
            return Some((first(k), grade));
        }
        let k = f.engagement?;
        Some((first(self.scenario.sources.len()) + k, &self.scenario.engagements[k].signal))
    }

    /// How far a friction element is engaged, 0 to 1; `value` tells what its governor is worth.
    #[inline]
    pub fn engaged(&self, f: &Friction, value: impl Fn(&Signal) -> f64) -> f64 {
        match (f.rolls, f.engagement) {
            _ if f.open => 0.0,
            (Some(k), _) => match &self.scenario.sources[k].kind {
                SourceKind::Vehicle { grade, .. } => upright(value(grade)),
                _ => unreachable!("only a vehicle rolls"),
            },
            (None, None) => 1.0,
            (None, Some(k)) => value(&self.scenario.engagements[k].signal),
        }
    }

    /// What a friction element is among the energies; nothing of its own where it belongs to a source.
    pub fn loss_kind(&self, f: usize) -> Option<EnergyLossKind> {
        match self.frictions[f].what {
            Rubs::Drag(_) => Some(EnergyLossKind::Drag),
            Rubs::Shift(_) => Some(EnergyLossKind::ShiftElement),
            // Counted with the source, and with the variator.
            Rubs::Rolling(_) | Rubs::Variator(_) => None,
            Rubs::Trace => Some(EnergyLossKind::Shaft),
            Rubs::Law(place) => self.laws.as_ref().map(|laws| laws.places[place].loss_kind()),
        }
    }

    /// The signals of the scenario.
    pub fn signals(&self) -> impl Iterator<Item = &Signal> {
        let sources = self.scenario.sources.iter().flat_map(|s| signals_of(&s.kind));
        let engagements = self.scenario.engagements.iter().map(|e| &e.signal);
        sources.chain(engagements).chain(self.scenario.controls.iter().map(|c| c.kind.signal()))
    }
}

/// What costs power at an operating point and is not there in motion.
fn not_followed(train: &Train) -> Option<String> {
    let open = train.shift_elements().iter().any(|e| e.open.is_some());
    let jets = train.meshes().iter().any(|m| m.teeth.as_ref().is_some_and(|t| t.jet.is_some()));
    let all = [(open, "drag of open shift elements"), (!train.pumps().is_empty(), "oil pumps"), (jets, "jets of oil")];
    let named: Vec<&str> = all.iter().filter(|x| x.0).map(|x| x.1).collect();
    (!named.is_empty()).then(|| format!("not followed in motion: {}", named.join(", ")))
}

/// Whatever has inertia, rubs or is driven stays visible; other planets vanish in chains.
fn visible(train: &Train, scenario: &Scenario, laws: Option<&Laws>) -> Vec<MemberId> {
    (train.inertias().iter().filter(|i| i.value > 0.0))
        .flat_map(|i| [i.member, i.reference])
        .chain(train.drags().iter().flat_map(|d| d.members))
        .chain(train.shafts().iter().flat_map(|s| s.members))
        .chain(scenario.sources.iter().map(|s| s.member))
        .chain(train.variators.iter().flat_map(Variator::members))
        .chain(train.loss_tables().iter().flat_map(|t| {
            let mesh = &train.meshes()[t.mesh.index()];
            [mesh.gears[0].member, mesh.gears[1].member]
        }))
        // The laws load each mesh with teeth by itself.
        .chain(laws.iter().flat_map(|laws| laws.places.iter().flat_map(|p| p.members)))
        .chain(
            train
                .meshes()
                .iter()
                .filter(|m| laws.is_some() && m.teeth.is_some())
                .flat_map(|m| [m.gears[0].member, m.gears[1].member]),
        )
        .filter(|m| m.index() != 0)
        .collect()
}
