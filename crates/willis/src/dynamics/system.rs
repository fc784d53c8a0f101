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

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Link};
use crate::train::{
    Curve, Engagement, LossRow, MemberId, MeshId, Scenario, ShiftElementKind, Signal, SourceKind, Train,
};

use super::laws::Laws;

/// Standard acceleration of free fall, m/s² (ISO 80000-3).
const GRAVITY: f64 = 9.80665;

/// Part of its power up to which the certificates of unique forces let a mesh under a law lose: several times what
/// good gears do.
pub(super) const MOST_LOST: f64 = 0.1;

/// Pulses of one signal in a scenario; each of them stops the integrator twice.
const MOST_PULSES: f64 = 1e6;

fn shortest_pulse(signal: &Signal) -> Option<f64> {
    match signal {
        Signal::Pulse { period, .. } => Some(*period),
        Signal::Product(of) => of.iter().filter_map(shortest_pulse).min_by(f64::total_cmp),
        _ => None,
    }
}

/// A mesh element: one gear pair, or a chain of them.
#[derive(Clone)]
pub(super) struct Element {
    pub links: Vec<Link>,
    /// `a` and `b` of its Willis equation.
    pub factors: [f64; 2],
    /// Rows of losses by amount of speed; one row where they are constant, and where they follow a law, as the
    /// most that it may lose.
    pub rows: Vec<LossRow>,
    /// Its mesh, if its loss follows a law.
    pub law: Option<MeshId>,
    /// Speed of the first gear relative to the carrier over the coordinates.
    pub row: Vec<f64>,
    /// Its group and its speed over that of the group; `None` if it loses nothing or never moves.
    pub group: Option<(usize, f64)>,
    pub port: usize,
    /// How its loss divides among its meshes when its first gear drives and when the second does: mesh and part.
    pub shares: [Vec<(usize, f64)>; 2],
    /// What its torque becomes from mesh to mesh.
    pub passes: Vec<Pass>,
}

/// A mesh of an element: what leaves it for what enters it.
#[derive(Clone, Copy)]
pub(super) struct Pass {
    pub mesh: usize,
    /// Whether it is passed from its first gear to its second.
    pub along: bool,
    /// Torque behind it over that before it, without loss.
    ratio: f64,
    /// Its efficiency when its first gear drives, and when its second does; 1 where it is an element alone.
    efficiency: [f64; 2],
}

impl Pass {
    fn of(train: &Train, links: &[Link]) -> Vec<Self> {
        let pass = |link: &Link| {
            let mesh = &train.meshes()[link.mesh.index()];
            let (from, to) = if link.along { (0, 1) } else { (1, 0) };
            let ratio = (&mesh.gears[to].teeth / &mesh.gears[from].teeth).to_f64();
            let own = &mesh.efficiency;
            Self {
                mesh: link.mesh.index(),
                along: link.along,
                ratio: if mesh.same_sense { -ratio } else { ratio },
                efficiency: if links.len() == 1 { [1.0; 2] } else { [own.forward.to_f64(), own.backward.to_f64()] },
            }
        };
        links.iter().map(pass).collect()
    }

    /// The torque behind it; `drive` if the first gear of the element drives.
    pub fn exit(&self, entry: f64, drive: bool, at_rest: bool) -> f64 {
        let efficiency = if at_rest { 1.0 } else { self.efficiency[usize::from(self.along != drive)] };
        self.ratio * entry * if drive { efficiency } else { 1.0 / efficiency }
    }
}

/// Part of each mesh of a chain in the loss of all: the power that reaches it, less what leaves it.
fn shares(train: &Train, links: &[Link]) -> [Vec<(usize, f64)>; 2] {
    [true, false].map(|drive| {
        let mut reaches = 1.0;
        let mut parts: Vec<(usize, f64)> = Vec::new();
        let order: Vec<&Link> = if drive { links.iter().collect() } else { links.iter().rev().collect() };
        for link in order {
            let own = &train.meshes()[link.mesh.index()].efficiency;
            let efficiency = if link.along == drive { own.forward.to_f64() } else { own.backward.to_f64() };
            parts.push((link.mesh.index(), reaches * (1.0 - efficiency)));
            reaches *= efficiency;
        }
        let whole: f64 = parts.iter().map(|p| p.1).sum();
        let alone = 1.0 / parts.len() as f64;
        parts.iter().map(|&(mesh, part)| (mesh, if whole > 0.0 { part / whole } else { alone })).collect()
    })
}

/// Efficiency and bearing torque of an element at a speed.
#[derive(Clone, Copy)]
pub(super) struct Loss {
    /// Slope of the loss over the torque at the first gear when that gear drives, `1 − η`.
    pub drive: f64,
    /// The same when the second gear drives, `1 − 1/η`.
    pub coast: f64,
    pub drive_torque: f64,
    pub coast_torque: f64,
}

impl Element {
    pub fn is_lossless(&self) -> bool {
        self.rows
            .iter()
            .all(|r| r.forward == 1.0 && r.backward == 1.0 && r.forward_torque == 0.0 && r.backward_torque == 0.0)
    }

    /// Whether its slopes depend on its speed or load.
    pub fn varies(&self) -> bool {
        self.law.is_some()
            || self.rows.windows(2).any(|w| (w[0].forward, w[0].backward) != (w[1].forward, w[1].backward))
    }

    /// Losses at an amount of speed: straight between rows; those of the last row beyond it.
    pub fn loss(&self, speed: f64) -> Loss {
        let rows = &self.rows;
        let row = if rows.len() == 1 {
            rows[0]
        } else {
            let k = rows.partition_point(|r| r.speed <= speed).clamp(1, rows.len() - 1);
            let (a, b) = (rows[k - 1], rows[k]);
            let part = ((speed - a.speed) / (b.speed - a.speed)).clamp(0.0, 1.0);
            let mix = |x: f64, y: f64| x + part * (y - x);
            LossRow {
                speed,
                forward: mix(a.forward, b.forward),
                backward: mix(a.backward, b.backward),
                forward_torque: mix(a.forward_torque, b.forward_torque),
                backward_torque: mix(a.backward_torque, b.backward_torque),
            }
        };
        Loss {
            drive: 1.0 - row.forward,
            coast: 1.0 - 1.0 / row.backward,
            drive_torque: row.forward_torque,
            coast_torque: row.backward_torque,
        }
    }
}

/// What rubs without regard to tooth loads.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Rubs {
    /// A drag of the train.
    Drag(usize),
    /// A shift element.
    Shift(usize),
    /// Rolling resistance of the vehicle that a source describes.
    Rolling(usize),
    /// A place of the laws.
    Law(usize),
}

/// A friction element between two members.
#[derive(Clone)]
pub(super) struct Friction {
    pub what: Rubs,
    pub name: String,
    /// Torque over the amount of slip, at full engagement.
    pub torque: Curve,
    pub peak: f64,
    /// Torque per unit of speed beside it.
    pub viscous: f64,
    /// Holds any torque when engaged.
    pub rigid: bool,
    /// For a one-way clutch the direction it prevents.
    pub blocks: Option<i8>,
    /// Position in the scenario's engagements; `None`: always engaged.
    pub engagement: Option<usize>,
    /// Never engaged in this scenario.
    pub open: bool,
    /// The vehicle among the sources that presses on it by its weight.
    pub rolls: Option<usize>,
    /// Slip over the coordinates.
    pub row: Vec<f64>,
    pub group: Option<(usize, f64)>,
    pub port: usize,
}

/// Elements whose relative speeds are always proportional: they stick and slip together.
#[derive(Clone)]
pub(super) struct Group {
    /// Of its friction and mesh elements.
    pub names: Vec<String>,
    /// Its slip over the coordinates.
    pub row: Vec<f64>,
    pub frictions: Vec<usize>,
    pub elements: Vec<usize>,
    /// Only prescribed speeds move it: it cannot be held.
    pub driven: bool,
    /// Port of the element that carries the holding torque, and the slip of the group that a unit of it
    /// gives power to.
    pub lead: (usize, f64),
}

/// An elastic shaft.
#[derive(Clone)]
pub(super) struct Elastic {
    pub row: Vec<f64>,
    pub port: usize,
    /// Twist at the start.
    pub twist: f64,
}

/// What a source needs beside its description.
#[derive(Clone)]
pub(super) struct Driver {
    pub member: MemberId,
    /// Port of its torque; `None` for a prescribed speed.
    pub port: Option<usize>,
    /// Position of its integral among those of the controllers.
    pub integral: Option<usize>,
    /// Position among the prescribed speeds.
    pub prescribed: Option<usize>,
    /// Its rolling resistance among the friction elements.
    pub rolling: Option<usize>,
}

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
    pub nodes: usize,
    /// Every member's speed over the coordinates.
    pub speeds: Vec<Vec<f64>>,
    pub elements: Vec<Element>,
    pub frictions: Vec<Friction>,
    pub groups: Vec<Group>,
    pub elastic: Vec<Elastic>,
    pub drivers: Vec<Driver>,
    /// Number of controller integrals.
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

/// The coordinates: exact speeds of every member over chosen ones.
struct Coordinates {
    chosen: Vec<MemberId>,
    speeds: Vec<Vec<f64>>,
    exact: Vec<Vec<Rational>>,
}

fn coordinates(
    c: &Configuration<'_>,
    prescribed: &[MemberId],
    wish: &[MemberId],
) -> Result<Coordinates, Vec<MemberId>> {
    let freedoms = c.degrees_of_freedom();
    let mut chosen: Vec<MemberId> = Vec::new();
    let independent = |set: &[MemberId]| c.transfer(set).conflicts.is_empty();
    for &m in prescribed {
        chosen.push(m);
        if !independent(&chosen) {
            return Err(chosen);
        }
    }
    let all = (1..c.train.members().len()).map(MemberId);
    for m in wish.iter().copied().chain(all) {
        if chosen.len() == freedoms {
            break;
        }
        if chosen.contains(&m) || c.inner[m.0] {
            continue;
        }
        chosen.push(m);
        if !independent(&chosen) {
            chosen.pop();
        }
    }
    // Prescribed speeds come last.
    chosen.rotate_left(prescribed.len());
    let exact: Vec<Vec<Rational>> = (c.transfer(&chosen).speeds.into_iter())
        .map(|s| s.unwrap_or_else(|| vec![Rational::ZERO; chosen.len()]))
        .collect();
    let speeds = exact.iter().map(|row| row.iter().map(Rational::to_f64).collect()).collect();
    Ok(Coordinates { chosen, speeds, exact })
}

/// The signal of how far a shift element is engaged.
pub(super) fn engagement(scenario: &Scenario, element: usize) -> Option<usize> {
    scenario.engagements.iter().position(|e: &Engagement| e.element.index() == element)
}

impl System {
    /// # Errors
    /// Speeds that contradict each other, coordinates without inertia, meshes whose forces are not
    /// determined.
    pub fn new(train: &Train, name: &str) -> Result<Self, Diagnostics> {
        let fail = Diagnostics::from;
        let Some(scenario) = train.scenario(name) else {
            let known: Vec<&str> = train.scenarios().iter().map(|s| s.name.as_str()).collect();
            let mut d = Diagnostic::new(Code::UnknownSelection, "", format!("there is no scenario `{name}`"))
                .suggest(name, known.iter().copied());
            if d.hints.is_empty() {
                d = d.hint(match known.len() {
                    0 => "add it as a [[scenario]]".into(),
                    _ => format!("the scenarios are: {}", known.join(", ")),
                });
            }
            return Err(fail(d));
        };
        let place = scenario.place.clone();
        let held = &scenario.fixed;
        let prescribed: Vec<MemberId> =
            (scenario.sources.iter()).filter(|s| matches!(s.kind, SourceKind::Speed(_))).map(|s| s.member).collect();
        let laws = Laws::of(train);
        // Whatever has inertia, rubs or is driven stays visible; other planets vanish in chains.
        let keep: Vec<MemberId> = (train.inertias().iter().filter(|i| i.value > 0.0))
            .flat_map(|i| [i.member, i.reference])
            .chain(train.drags().iter().flat_map(|d| d.members))
            .chain(train.shafts().iter().flat_map(|s| s.members))
            .chain(scenario.sources.iter().map(|s| s.member))
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
            .collect();
        let c = Configuration::new(train, &[], held, &keep);
        if let Some(meshes) = c.redundant().first() {
            let names: Vec<&str> = meshes.iter().map(|m| train.meshes()[m.index()].name.as_str()).collect();
            let message = format!(
                "the forces in {} are not determined: these meshes constrain what others already constrain",
                names.join(", ")
            );
            return Err(fail(Diagnostic::new(Code::Unfit, place, message).hint("leave out one of them")));
        }
        if c.degrees_of_freedom() == 0 {
            let message = "nothing can move: what is held in `fixed` holds all members".to_owned();
            return Err(fail(Diagnostic::new(Code::Unfit, place, message).hint("leave one of them out of `fixed`")));
        }
        for signal in (scenario.sources.iter().flat_map(|s| signals_of(&s.kind)))
            .chain(scenario.engagements.iter().map(|e| &e.signal))
        {
            if let Some(period) = shortest_pulse(signal)
                && (scenario.end - scenario.start) / period > MOST_PULSES
            {
                let message = format!(
                    "a pulse of period {period} s comes {:.1e} times in this scenario, more than {MOST_PULSES:.0e}",
                    (scenario.end - scenario.start) / period
                );
                return Err(fail(
                    Diagnostic::new(Code::Unfit, place, message).hint("take its mean, or a shorter scenario"),
                ));
            }
        }
        for source in &scenario.sources {
            // What is derived by the time.
            let (what, signal) = match &source.kind {
                SourceKind::Speed(signal) => ("a prescribed speed", signal),
                SourceKind::Controller { setpoint, derivative, .. } if *derivative != 0.0 => {
                    ("the set point of a controller with a derivative part", setpoint)
                }
                _ => continue,
            };
            let (fault, hint) = if signal.depends_on_speed() {
                ("cannot follow the speeds of members", "let it follow the time, or use a torque")
            } else if !signal.has_rate() {
                ("cannot follow a formula with jumps, as `floor` and `signum` have", "use ramps or a table")
            } else {
                continue;
            };
            let message = format!("`{}`: {what} {fault}", source.name);
            return Err(fail(Diagnostic::new(Code::Unfit, place, message).hint(hint)));
        }
        let wish: Vec<MemberId> = (train.inertias().iter().map(|i| i.member))
            .filter(|m| train.terminals().contains(m))
            .chain(train.terminals().iter().copied())
            .chain(train.inertias().iter().map(|i| i.member))
            .collect();
        let coordinates = coordinates(&c, &prescribed, &wish).map_err(|members| {
            let names: Vec<&str> = members.iter().map(|m| train.member_name(*m)).collect();
            let message = format!("the gears tie the prescribed speeds of {} together", names.join(", "));
            fail(Diagnostic::new(Code::ContradictorySpeeds, place.clone(), message).hint("prescribe one of them"))
        })?;
        Self::assemble(train, scenario, &c, coordinates, prescribed.len(), laws)
    }

    fn assemble(
        train: &Train,
        scenario: &Scenario,
        c: &Configuration<'_>,
        coordinates: Coordinates,
        prescribed: usize,
        mut laws: Option<Laws>,
    ) -> Result<Self, Diagnostics> {
        let Coordinates { chosen, speeds, exact } = coordinates;
        let free = chosen.len() - prescribed;
        let all = chosen.len();
        let nodes = c.nodes;
        let mut assumptions: Vec<String> = train.assumptions().to_vec();
        let difference = |a: MemberId, b: MemberId| -> Vec<f64> {
            speeds[a.0].iter().zip(&speeds[b.0]).map(|(x, y)| x - y).collect()
        };
        let exact_difference = |a: MemberId, b: MemberId| -> Vec<Rational> {
            exact[a.0].iter().zip(&exact[b.0]).map(|(x, y)| x - y).collect()
        };
        let add = |column: &mut DVector<f64>, m: MemberId, x: f64| {
            if let Some(n) = c.node(m) {
                column[n] += x;
            }
        };

        // Speeds of the nodes.
        let mut n = DMatrix::zeros(nodes, all);
        for m in 0..train.members().len() {
            if let (false, Some(node)) = (c.inner[m], c.node_of[m]) {
                for k in 0..all {
                    n[(node, k)] = speeds[m][k];
                }
            }
        }
        let mut real_mass = DMatrix::zeros(nodes, nodes);
        let add_inertia = |mass: &mut DMatrix<f64>, member: MemberId, reference: MemberId, value: f64| {
            let mut d = DVector::zeros(nodes);
            add(&mut d, member, 1.0);
            add(&mut d, reference, -1.0);
            *mass += &d * d.transpose() * value;
        };
        for i in train.inertias() {
            add_inertia(&mut real_mass, i.member, i.reference, i.value);
        }
        let mut mass = real_mass.clone();

        // Ports.
        let mut columns: Vec<DVector<f64>> = Vec::new();
        let mut port = |a: MemberId, b: MemberId| -> usize {
            let mut column = DVector::zeros(nodes);
            add(&mut column, a, 1.0);
            add(&mut column, b, -1.0);
            columns.push(column);
            columns.len() - 1
        };
        let frame = MemberId(0);
        let mut frictions: Vec<Friction> = Vec::new();
        let mut drivers = Vec::new();
        let (mut integrals, mut prescribed_seen) = (0, 0);
        for (k, s) in scenario.sources.iter().enumerate() {
            let mut driver = Driver { member: s.member, port: None, integral: None, prescribed: None, rolling: None };
            match &s.kind {
                SourceKind::Speed(_) => {
                    driver.prescribed = Some(prescribed_seen);
                    prescribed_seen += 1;
                }
                kind => {
                    driver.port = Some(port(s.member, frame));
                    match kind {
                        SourceKind::Controller { derivative, .. } => {
                            driver.integral = Some(integrals);
                            integrals += 1;
                            // The derivative of the speed is the acceleration: an added inertia.
                            add_inertia(&mut mass, s.member, frame, *derivative);
                        }
                        SourceKind::Vehicle { mass: m, wheel_radius, final_drive, rolling, .. } => {
                            let arm = wheel_radius / final_drive;
                            for matrix in [&mut mass, &mut real_mass] {
                                add_inertia(matrix, s.member, frame, m * arm * arm);
                            }
                            if *rolling > 0.0 {
                                driver.rolling = Some(frictions.len());
                                frictions.push(Friction {
                                    what: Rubs::Rolling(k),
                                    name: s.name.clone(),
                                    torque: Curve::constant(rolling * m * GRAVITY * arm.abs()),
                                    peak: 1.0,
                                    viscous: 0.0,
                                    rigid: false,
                                    blocks: None,
                                    engagement: None,
                                    open: false,
                                    rolls: Some(k),
                                    row: speeds[s.member.0].clone(),
                                    group: None,
                                    port: port(s.member, frame),
                                });
                            }
                        }
                        _ => {}
                    }
                }
            }
            drivers.push(driver);
        }
        for (k, d) in train.drags().iter().enumerate() {
            let [a, b] = d.members;
            frictions.push(Friction {
                what: Rubs::Drag(k),
                name: d.name.clone(),
                torque: d.torque.clone(),
                peak: d.peak,
                viscous: d.viscous,
                rigid: false,
                blocks: None,
                engagement: None,
                open: false,
                rolls: None,
                row: difference(a, b),
                group: None,
                port: port(a, b),
            });
        }
        for (k, e) in train.shift_elements().iter().enumerate() {
            let [a, b] = e.members;
            let one_way = e.kind == ShiftElementKind::OneWay;
            let engagement = if one_way { None } else { engagement(scenario, k) };
            let (torque, peak) = match &e.friction {
                Some(f) => (f.torque.clone(), f.peak),
                None => (Curve::constant(0.0), 1.0),
            };
            frictions.push(Friction {
                what: Rubs::Shift(k),
                name: e.name.clone(),
                torque,
                peak,
                viscous: 0.0,
                rigid: e.friction.is_none() || one_way,
                blocks: one_way.then_some(e.blocks),
                engagement,
                open: !one_way && engagement.is_none(),
                rolls: None,
                row: difference(a, b),
                group: None,
                port: port(a, b),
            });
        }
        if let Some(laws) = &mut laws {
            laws.first = frictions.len();
            frictions.extend(laws.places.iter().enumerate().map(|(k, place)| {
                let [a, b] = place.members;
                Friction {
                    what: Rubs::Law(k),
                    name: place.name.clone(),
                    torque: Curve::constant(0.0),
                    peak: 1.0,
                    viscous: 0.0,
                    rigid: false,
                    blocks: None,
                    engagement: None,
                    open: false,
                    rolls: None,
                    row: difference(a, b),
                    group: None,
                    port: port(a, b),
                }
            }));
            assumptions.extend(laws.assumptions(train));
        }
        let elastic: Vec<Elastic> = (train.shafts().iter().enumerate())
            .map(|(k, s)| Elastic {
                row: difference(s.members[0], s.members[1]),
                port: port(s.members[0], s.members[1]),
                twist: scenario.initial_twists.iter().find(|t| t.0 == k).map_or(0.0, |t| t.1),
            })
            .collect();

        // Meshes.
        let m = c.elements.len();
        let mut gear = DMatrix::zeros(nodes, m);
        let mut loss = DMatrix::zeros(nodes, m);
        let mut elements: Vec<Element> = Vec::with_capacity(m);
        for (j, e) in c.elements.iter().enumerate() {
            let (a, b) = (e.a.to_f64(), e.b.to_f64());
            let mut g = DVector::zeros(nodes);
            let mut h = DVector::zeros(nodes);
            for (member, x) in [(e.p, a), (e.q, b), (e.carrier, -(a + b))] {
                add(&mut g, member, x);
            }
            for (member, x) in [(e.q, -b / a), (e.carrier, b / a)] {
                add(&mut h, member, x);
            }
            gear.set_column(j, &g);
            loss.set_column(j, &h);
            columns.push(-h);
            let table = match e.links[..] {
                [Link { mesh, .. }] => train.loss_tables().iter().find(|t| t.mesh == mesh),
                _ => None,
            };
            let law = match e.links[..] {
                [Link { mesh, .. }] => Some(mesh).filter(|m| laws.is_some() && train.meshes()[m.index()].computed),
                _ => None,
            };
            let nominal = |efficiency: &Rational| if law.is_some() { 1.0 - MOST_LOST } else { efficiency.to_f64() };
            let constant = LossRow {
                speed: 0.0,
                forward: nominal(&e.forward),
                backward: nominal(&e.backward),
                forward_torque: 0.0,
                backward_torque: 0.0,
            };
            elements.push(Element {
                links: e.links.clone(),
                factors: [a, b],
                rows: table.map_or_else(|| vec![constant], |t| t.rows.clone()),
                law,
                row: difference(e.p, e.carrier),
                group: None,
                port: columns.len() - 1,
                shares: shares(train, &e.links),
                passes: Pass::of(train, &e.links),
            });
        }
        let port_of_prescribed = columns.len();
        for i in 0..prescribed {
            columns.push(-(&mass * n.column(free + i)));
        }
        let port_columns = DMatrix::from_columns(&columns);

        // What always slips together, decided exactly.
        let mut groups: Vec<Group> = Vec::new();
        let mut rows: Vec<Vec<Rational>> = Vec::new();
        let mut join = |row: Vec<Rational>, name: &str, lead: usize, sign: f64| -> Option<(usize, f64)> {
            let first = row.iter().position(|x| !x.is_zero())?;
            for (g, other) in rows.iter().enumerate() {
                if other[first].is_zero() {
                    continue;
                }
                let factor = &row[first] / &other[first];
                if row.iter().zip(other).all(|(x, y)| *x == &factor * y) {
                    let factor = factor.to_f64();
                    groups[g].names.push(name.to_owned());
                    return Some((g, factor));
                }
            }
            groups.push(Group {
                names: vec![name.to_owned()],
                row: row.iter().map(Rational::to_f64).collect(),
                frictions: vec![],
                elements: vec![],
                driven: row[..free].iter().all(Rational::is_zero),
                lead: (lead, sign),
            });
            rows.push(row);
            Some((groups.len() - 1, 1.0))
        };
        for f in &mut frictions {
            let [a, b] = match f.what {
                Rubs::Drag(k) => train.drags()[k].members,
                Rubs::Shift(k) => train.shift_elements()[k].members,
                Rubs::Rolling(k) => [scenario.sources[k].member, frame],
                Rubs::Law(k) => laws.as_ref().expect("of these laws").places[k].members,
            };
            let rubs = f.rigid || matches!(f.what, Rubs::Law(_)) || f.torque.points().iter().any(|p| p[1] > 0.0);
            if rubs && !f.open {
                f.group = join(exact_difference(a, b), &f.name, f.port, 1.0);
            }
        }
        for (j, e) in c.elements.iter().enumerate() {
            if !elements[j].is_lossless() {
                let name = element_name(train, &e.links);
                elements[j].group = join(exact_difference(e.p, e.carrier), &name, elements[j].port, -1.0);
            }
        }
        for (k, f) in frictions.iter().enumerate() {
            if let Some((g, _)) = f.group {
                groups[g].frictions.push(k);
            }
        }
        for (j, e) in elements.iter().enumerate() {
            if let Some((g, factor)) = e.group {
                groups[g].elements.push(j);
                // The loss of a mesh acts against its speed.
                if groups[g].lead.0 == e.port {
                    groups[g].lead.1 = -factor;
                }
            }
        }

        let n_free = n.columns(0, free).into_owned();
        let reduced = n_free.transpose() * &mass * &n_free;
        let energy = n.transpose() * &real_mass * &n;
        massless(&reduced, &speeds, train, scenario)?;
        let mut left = DMatrix::zeros(nodes, all);
        left.columns_mut(0, free).copy_from(&(&mass * &n_free));
        for i in 0..prescribed {
            let mut column = DVector::zeros(nodes);
            add(&mut column, chosen[free + i], -1.0);
            left.set_column(free + i, &column);
        }
        for source in scenario.sources.iter().filter(|s| matches!(s.kind, SourceKind::Vehicle { .. })) {
            assumptions.push(format!(
                "{}: its rolling resistance and air drag are part of what it takes, not losses of the train",
                source.name
            ));
        }
        Ok(Self {
            train: train.clone(),
            scenario: scenario.clone(),
            free,
            prescribed,
            coordinates: chosen,
            nodes,
            speeds,
            elements,
            frictions,
            groups,
            elastic,
            drivers,
            integrals,
            laws: laws.map(Box::new),
            ports: columns.len(),
            port_of_prescribed,
            energy,
            mass: reduced,
            left,
            gear,
            loss,
            port_columns,
            assumptions,
        })
    }

    /// Coordinates of both kinds.
    pub fn all(&self) -> usize {
        self.free + self.prescribed
    }

    /// Rows of a solution: accelerations, torques behind prescribed speeds, mesh forces.
    pub fn unknowns(&self) -> usize {
        self.nodes
    }

    /// The equations with loss slopes `slopes`, one for each element.
    fn matrix(&self, slopes: &[f64]) -> DMatrix<f64> {
        let mut k = DMatrix::zeros(self.nodes, self.nodes);
        k.columns_mut(0, self.all()).copy_from(&self.left);
        for (j, e) in self.elements.iter().enumerate() {
            let column = self.gear.column(j) + self.loss.column(j) * (slopes[j] * e.factors[0]);
            k.set_column(self.all() + j, &column);
        }
        k
    }

    /// Accelerations and forces for a unit torque in each port: unknowns × ports. `None` if the equations
    /// have no unique solution with these slopes.
    pub fn response(&self, slopes: &[f64]) -> Option<DMatrix<f64>> {
        let matrix = self.matrix(slopes);
        let lu = matrix.lu();
        let x = lu.solve(&self.port_columns)?;
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    /// Determinant of the equations over that without losses.
    pub fn determinant(&self, slopes: &[f64]) -> f64 {
        let lossless = vec![0.0; slopes.len()];
        self.matrix(slopes).lu().determinant() / self.matrix(&lossless).lu().determinant()
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

    /// The signals of the scenario.
    pub fn signals(&self) -> impl Iterator<Item = &Signal> {
        let sources = self.scenario.sources.iter().flat_map(|s| signals_of(&s.kind));
        sources.chain(self.scenario.engagements.iter().map(|e| &e.signal))
    }
}

pub(super) fn signals_of(kind: &SourceKind) -> impl Iterator<Item = &Signal> {
    let [first, second] = match kind {
        SourceKind::Torque(s) | SourceKind::Speed(s) => [Some(s), None],
        SourceKind::Controller { setpoint, feed_forward, .. } => [Some(setpoint), Some(feed_forward)],
        SourceKind::Vehicle { grade, .. } => [Some(grade), None],
        SourceKind::Motor { throttle, .. } => [Some(throttle), None],
        SourceKind::Linear { .. } | SourceKind::Quadratic { .. } => [None, None],
    };
    first.into_iter().chain(second)
}

/// Torque of a source whose member turns at `w` and whose error has the integral `sum`. `value` tells what its first or
/// second signal is worth, `rate` how fast one changes. A prescribed speed has no torque of its own: 0. The derivative of
/// a controller's speed is not in it: it acts through the acceleration.
#[inline]
pub(super) fn source_torque(
    kind: &SourceKind,
    w: f64,
    sum: f64,
    value: impl Fn(usize, &Signal) -> f64,
    rate: impl Fn(&Signal) -> f64,
) -> f64 {
    match kind {
        SourceKind::Torque(signal) => value(0, signal),
        SourceKind::Speed(_) => 0.0,
        SourceKind::Controller { setpoint, feed_forward, proportional, integral, derivative } => {
            let rate = if *derivative == 0.0 { 0.0 } else { rate(setpoint) };
            value(1, feed_forward) + proportional * (value(0, setpoint) - w) + integral * sum + derivative * rate
        }
        SourceKind::Linear { torque, about, slope } => torque - slope * (w - about),
        SourceKind::Quadratic { torque, about, factor, even } => {
            let d = w - about;
            torque - factor * if *even { d * d } else { d * d.abs() }
        }
        SourceKind::Vehicle { mass, wheel_radius, final_drive, drag_area, air_density, grade, .. } => {
            let arm = wheel_radius / final_drive;
            let v = w * arm;
            let grade = value(0, grade);
            let weight = mass * GRAVITY * grade * upright(grade);
            -(0.5 * air_density * drag_area * v * v.abs() + weight) * arm
        }
        SourceKind::Motor { full_load, closed, throttle } => {
            let (low, high) = (closed.at(w), full_load.at(w));
            low + value(0, throttle).clamp(0.0, 1.0) * (high - low)
        }
    }
}

/// Cosine of a slope whose tangent is `grade`: the part of a weight that presses on it.
pub(super) fn upright(grade: f64) -> f64 {
    1.0 / grade.hypot(1.0)
}

/// The name of a mesh, or of the set of a chain.
pub(super) fn element_name(train: &Train, links: &[Link]) -> String {
    let first = &train.meshes()[links[0].mesh.index()];
    match (links, first.set) {
        ([_], _) => first.name.clone(),
        (_, Some(set)) => format!("{} ({} meshes)", train.sets()[set].name, links.len()),
        _ => links.iter().map(|l| train.meshes()[l.mesh.index()].name.as_str()).collect::<Vec<_>>().join("+"),
    }
}

/// An error if some combination of the coordinates has no inertia.
fn massless(
    reduced: &DMatrix<f64>,
    speeds: &[Vec<f64>],
    train: &Train,
    scenario: &Scenario,
) -> Result<(), Diagnostics> {
    let free = reduced.nrows();
    if free == 0 {
        return Ok(());
    }
    // Each coordinate measured by its own inertia, so that units and sizes do not matter.
    let scale: Vec<f64> = (0..free).map(|k| reduced[(k, k)].sqrt()).collect();
    let weakest: Option<Vec<f64>> = match scale.iter().position(|s| *s == 0.0) {
        Some(k) => Some((0..free).map(|i| f64::from(u8::from(i == k))).collect()),
        None => {
            let scaled = DMatrix::from_fn(free, free, |i, j| reduced[(i, j)] / (scale[i] * scale[j]));
            let eigen = scaled.symmetric_eigen();
            let k = eigen.eigenvalues.imin();
            (eigen.eigenvalues[k] < 1e-13).then(|| (0..free).map(|i| eigen.eigenvectors[(i, k)] / scale[i]).collect())
        }
    };
    let Some(direction) = weakest else { return Ok(()) };
    let speed = |m: usize| -> f64 { speeds[m].iter().zip(&direction).map(|(n, d)| n * d).sum() };
    let fastest = (0..speeds.len()).map(|m| speed(m).abs()).fold(0.0, f64::max);
    let moving: Vec<&str> = (1..speeds.len())
        .filter(|&m| speed(m).abs() > 1e-6 * fastest)
        .map(|m| train.members()[m].name.as_str())
        .take(8)
        .collect();
    let message = match moving[..] {
        [one] => {
            format!("`{one}` has no inertia and its speed is not prescribed, so its acceleration is not determined")
        }
        _ => format!(
            "{} can move together without any inertia and without a prescribed speed, so their acceleration is not determined",
            moving.join(", ")
        ),
    };
    let hint = format!(
        "give one of them a moment of inertia, [inertias] {} = \"0.01 kg m^2\"; or prescribe its speed, or hold it in `fixed`",
        moving.first().copied().unwrap_or("member"),
    );
    Err(Diagnostic::new(Code::NoInertia, scenario.place.clone(), message).hint(hint).into())
}
