//! The nomograph: every planet with its gears and its carrier as one straight lever.
//!
//! A gear `i` on planet `p` and carrier `c` stands at `N_i = (ω_i − ω_c)/(ω_p − ω_c)`, by tooth
//! numbers alone; the carrier at 0, the planet at 1. Speeds are displacements across the lever:
//! `ω_i = ω_c + N_i (ω_p − ω_c)` is a straight line. Torques are forces on the same lever:
//! `Σ T_i = 0`, and without friction `Σ N_i T_i = 0`. With friction the forces act at displaced
//! points, `Σ λ_i N_i T_i = 0`: `λ = η` at a gear that drives, which so moves towards the carrier,
//! `1/η` at one that is driven. Speeds are read at the true points.
//!
//! Source: H. L. Benford, M. B. Leising, The Lever Analogy: A New Tool in Transmission Analysis,
//! SAE 810102 (1981).

pub mod draw;
pub(crate) mod family;
mod layout;
pub mod panel;
mod role;

use serde::{Deserialize, Serialize};
use willis::analysis::{OperationReport, SolutionReport, operate};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::kinematics::Configuration;
use willis::train::{AS_DRAWN, Load, MemberId, Operation, ShiftElementId, Train};
use willis::units::{Dimension, Quantity};
use willis::unstable;

use crate::kind::{self, Ask, FigureRequest, Kind};
use crate::parts::point::ends;
use family::{Family, families};

pub use role::LeverRole;

pub(crate) const KIND: Kind<Lever> = Kind {
    title: "Levers",
    takes: &[Ask::State, Ask::Operation],
    effort: kind::of_operations,
    applies: None,
    make: |s, r| lever(s.train(), &LeverRequest::of(r)),
    steps: None,
    draw: draw::draw_on,
};

impl LeverRequest {
    /// What a request for a figure of any kind means here.
    fn of(r: &FigureRequest) -> Self {
        match (&r.operation, r.state.as_deref()) {
            (Some(operation), _) => Self::Operation(operation.clone()),
            (None, Some("all")) => Self::EveryState,
            (None, Some(state)) => Self::State(state.to_owned()),
            (None, None) => Self::First,
        }
    }
}

/// What a lever picture shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum LeverRequest {
    /// The first operation; of a train without operations the first state, or the train as drawn.
    #[default]
    First,
    /// Speeds and torques of this operation.
    Operation(String),
    /// This state with the input's speed and torque as units.
    State(String),
    /// The speeds of all states over each other, that of the input as unit.
    EveryState,
}

/// The nomograph of a train.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Lever {
    /// The train, and what is shown of it.
    pub title: String,
    /// The member whose speed and torque are the units, `ω/ω_in` and `T/T_in`; absent where speeds
    /// are in rad/s and torques in N m.
    pub unit: Option<String>,
    /// Whether torques are shown.
    pub torques: bool,
    /// The motions shown: one, or every state.
    pub cases: Vec<LeverCase>,
    /// The levers, from left to right.
    pub bars: Vec<LeverBar>,
    /// Members that stand on several levers.
    pub links: Vec<LeverLink>,
    /// Whether a member stands equally high on all of its levers.
    pub level: bool,
}

/// One motion.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverCase {
    /// What it is called in the picture: its own name where all names are short, else a small letter.
    pub letter: String,
    /// The operation, or the state.
    pub name: String,
    /// `ω_in/ω_out` of a state.
    pub ratio: Option<f64>,
    /// Closed shift elements.
    pub engaged: Vec<String>,
    /// Members at rest because something holds them, the frame among them.
    pub held: Vec<String>,
    /// Why speeds or torques are missing, or which of several equilibria this is.
    pub note: Option<String>,
}

/// A lever: one set, or several that share two members and so lie on one line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverBar {
    /// The sets on it.
    pub sets: Vec<LeverSet>,
    /// Its points, highest first.
    pub nodes: Vec<LeverNode>,
}

impl LeverBar {
    /// The names of its sets, with plus signs between them.
    pub fn name(&self) -> String {
        self.sets.iter().map(|s| s.name.as_str()).collect::<Vec<_>>().join(" + ")
    }
}

/// The forces of one set on its lever.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverSet {
    /// Name of the set, or of its meshes.
    pub name: String,
    /// What acts where; empty where torques are not shown.
    pub pulls: Vec<LeverPull>,
}

/// A point of a lever.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverNode {
    /// The member.
    pub member: String,
    /// Number of its colour: its place among the members of the train; absent for the frame.
    #[serde(default)]
    pub colour: Option<usize>,
    /// What it is; several where sets share it.
    pub roles: Vec<LeverRole>,
    /// Height along the lever: 0 lowest, 1 highest of the picture (planets may stand beyond). Of
    /// three points of a set the ratio of distances is that of [`LeverNode::number`].
    pub position: f64,
    /// `N = (ω − ω_c)/(ω_p − ω_c)` in its (first) set: 0 the carrier, 1 the first planet.
    pub number: f64,
    /// Speed in each case, rad/s or in units of the input's; absent where not determined.
    pub speeds: Vec<Option<f64>>,
}

/// A torque on a lever.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverPull {
    /// Number of the node.
    pub node: usize,
    /// The mesh through which it acts; absent at carriers and planets.
    pub mesh: Option<String>,
    /// Torque that the member puts into the set, N m or in units of the input's.
    pub torque: f64,
    /// `λ`: by how much friction moves the force away from the carrier (`λ > 1`: it is driven) or
    /// towards it (`λ < 1`: it drives).
    pub displacement: f64,
    /// Height at which it acts.
    pub point: f64,
}

/// A member that stands on several levers: their points move alike.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LeverLink {
    /// The member.
    pub member: String,
    /// Numbers of the levers and of the nodes on them.
    pub points: Vec<[usize; 2]>,
}

/// The nomograph of a train.
///
/// # Errors
/// Unknown names, a train without gears, a motion that nothing settles.
///
/// # Example
/// ```
/// use willis_figure::{LeverRequest, lever};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.99))
///     .build()?;
/// let lever = lever(&train, &LeverRequest::First)?;
/// let bar = &lever.bars[0];
/// assert_eq!(bar.nodes.iter().filter(|n| n.member != "P1.planet").count(), 3);
/// let sum: f64 = bar.sets[0].pulls.iter().map(|p| p.torque).sum();
/// assert!(sum.abs() < 1e-12);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn lever(train: &Train, request: &LeverRequest) -> Result<Lever, Diagnostics> {
    LeverLayout::new(train)?.show(train, request)
}

/// Where the points of all levers of a train stand: by tooth numbers alone, so that speeds and torques change without moving
/// them.
pub struct LeverLayout {
    families: Vec<Family>,
    placed: layout::Placed,
}

impl LeverLayout {
    /// Lays out a train.
    ///
    /// # Errors
    /// A train without gears.
    pub fn new(train: &Train) -> Result<Self, Diagnostics> {
        let families = families(train);
        if families.is_empty() {
            return Err(unfit("it has no gears", "a lever is a set of gears on one carrier"));
        }
        let placed = layout::place(&families);
        Ok(Self { families, placed })
    }

    /// The levers with speeds and torques. The train must be the one that was laid out, perhaps with other operating points.
    ///
    /// # Errors
    /// No such operation or state; a state that has no motion to show.
    pub fn show(&self, train: &Train, request: &LeverRequest) -> Result<Lever, Diagnostics> {
        laid_out(train, &self.families, &self.placed, Shown::find(train, request)?)
    }

    /// The same of an operating point that is analyzed already, and one of its equilibria; where it has none, what moves only
    /// with every loaded member pushing.
    ///
    /// # Errors
    /// The train has no such operation; its speeds are not settled.
    pub fn show_report(
        &self,
        train: &Train,
        report: &OperationReport,
        equilibrium: usize,
    ) -> Result<Lever, Diagnostics> {
        let operation = train.find_operation(&report.name)?;
        let shown = Shown::report(train, operation, report.clone(), Some(equilibrium))?;
        laid_out(train, &self.families, &self.placed, shown)
    }
}

fn laid_out(train: &Train, families: &[Family], placed: &layout::Placed, shown: Shown) -> Result<Lever, Diagnostics> {
    let mut bars: Vec<LeverBar> = Vec::new();
    for parts in &placed.bars {
        bars.push(bar(train, families, placed, parts, &shown));
    }
    let far = |n: &LeverNode| !(n.position.is_finite() && n.number.is_finite());
    if bars.iter().flat_map(|b| &b.nodes).any(far) {
        return Err(unfit("its ratios are beyond floating point", "`willis analyze` tells them as fractions"));
    }
    let mut links: Vec<LeverLink> = Vec::new();
    for (b, one) in bars.iter().enumerate() {
        for (n, node) in one.nodes.iter().enumerate() {
            if node.roles == [LeverRole::Planet] {
                continue;
            }
            match links.iter_mut().find(|l| l.member == node.member) {
                Some(link) => link.points.push([b, n]),
                None => links.push(LeverLink { member: node.member.clone(), points: vec![[b, n]] }),
            }
        }
    }
    links.retain(|l| l.points.len() > 1);
    Ok(Lever {
        title: shown.title,
        unit: shown.unit,
        torques: shown.solution.is_some(),
        cases: shown.cases,
        bars,
        links,
        level: placed.level,
    })
}

fn unfit(why: &str, hint: &str) -> Diagnostics {
    [Diagnostic::new(Code::Unfit, "", format!("no levers of this train: {why}")).hint(hint)].into_iter().collect()
}

/// Letters of a name that stands above a line.
const SHORT: usize = 3;

/// What is shown: motions, and torques where there is one.
struct Shown {
    title: String,
    unit: Option<String>,
    cases: Vec<LeverCase>,
    /// Speed of each member in each case.
    speeds: Vec<Vec<Option<f64>>>,
    solution: Option<SolutionReport>,
}

impl Shown {
    fn find(train: &Train, request: &LeverRequest) -> Result<Self, Diagnostics> {
        match request {
            LeverRequest::Operation(name) => Self::operation(train, train.find_operation(name)?),
            LeverRequest::State(name) if train.states().is_empty() && name == AS_DRAWN => Self::state(train, None),
            LeverRequest::State(name) => Self::state(train, Some(train.find_state(name)?)),
            LeverRequest::EveryState => Self::every_state(train),
            LeverRequest::First => match train.operations().first() {
                Some(operation) => Self::operation(train, operation),
                None => Self::state(train, (!train.states().is_empty()).then_some(0)),
            },
        }
    }

    fn operation(train: &Train, operation: &Operation) -> Result<Self, Diagnostics> {
        let (report, _) = operate(train, operation)?;
        Self::report(train, operation, report, None)
    }

    /// Of one of several equilibria, or of one that delivers power.
    fn report(
        train: &Train,
        operation: &Operation,
        report: OperationReport,
        equilibrium: Option<usize>,
    ) -> Result<Self, Diagnostics> {
        let engaged = operation.state.map_or(&[][..], |k| &train.states()[k].engaged);
        let mut case = case(train, 0, &operation.name, engaged, &operation.fixed);
        case.note = note(&report);
        let mut speeds = vec![Some(0.0)];
        speeds.extend(report.speeds_rad_s.iter().map(|(_, w)| *w));
        if speeds[1..].iter().all(Option::is_none) {
            return Err(unfit("its speeds are not settled", "prescribe as many speeds as it has degrees of freedom"));
        }
        let state = report.state.as_ref().map_or(String::new(), |s| format!(" (state {s})"));
        Ok(Self {
            title: format!("{}: {}{state}", train.name(), operation.name),
            unit: None,
            cases: vec![case],
            speeds: vec![speeds],
            solution: match equilibrium {
                Some(k) if k < report.solutions.len() => report.solutions.into_iter().nth(k),
                _ => chosen(report.solutions.into_iter().chain(report.dissipative_solutions).collect()),
            },
        })
    }

    fn state(train: &Train, state: Option<usize>) -> Result<Self, Diagnostics> {
        let (mut case, speeds) = motion(train, 0, state);
        let (Some((input, output)), Some(speeds)) = (ends(train, state), speeds) else {
            let why = format!("{}: {}", case.name, case.note.unwrap_or_default());
            return Err(unfit(
                &why,
                "add an [[operation]] with as many speeds as it has degrees of freedom, and its torques",
            ));
        };
        // Units have no temperature, and no film of oil.
        let plain = unstable::without_laws(train);
        let unit = |dimension| Quantity { value: Rational::ONE, pi_power: 0, dimension };
        let idle = train.terminals().iter().filter(|m| **m != input && **m != output);
        let none = Quantity { value: Rational::ZERO, ..unit(Dimension::TORQUE) };
        let mut loads = vec![(input, Load::Torque(unit(Dimension::TORQUE)))];
        loads.extend(idle.map(|m| (*m, Load::Torque(none.clone()))));
        let speeds_given = vec![(input, unit(Dimension::ANGULAR_SPEED))];
        let operation = unstable::operation(case.name.clone(), state, speeds_given, loads);
        let solution = match operate(&plain, &operation) {
            Ok((report, _)) => {
                case.note = note(&report);
                chosen(report.solutions)
            }
            Err(why) => {
                case.note = why.iter().next().map(|d| d.message.clone());
                None
            }
        };
        let title = match state {
            Some(_) => format!("{}, state {}", train.name(), case.name),
            None => train.name().to_owned(),
        };
        let unit = Some(train.member_name(input).to_owned());
        Ok(Self { title, unit, cases: vec![case], speeds: vec![speeds], solution })
    }

    fn every_state(train: &Train) -> Result<Self, Diagnostics> {
        if train.states().is_empty() {
            return Err(unfit("it has no states to lay over each other", "draw the levers of one operation"));
        }
        let all: Vec<_> = (0..train.states().len()).map(|k| motion(train, k, Some(k))).collect();
        if all.iter().all(|(_, speeds)| speeds.is_none()) {
            return Err(unfit(
                "no state settles all speeds by that of the input",
                "draw the levers of an [[operation]] with as many speeds as it has degrees of freedom",
            ));
        }
        let mut inputs: Vec<MemberId> =
            (0..all.len()).filter(|k| all[*k].1.is_some()).filter_map(|k| ends(train, Some(k))).map(|e| e.0).collect();
        inputs.dedup();
        let unit = match inputs[..] {
            [input] => train.member_name(input).to_owned(),
            _ => "the input".to_owned(),
        };
        let (mut cases, speeds): (Vec<LeverCase>, Vec<_>) = all.into_iter().unzip();
        // Names of gears are what everybody knows them by.
        if cases.iter().all(|c| c.name.chars().count() <= SHORT) {
            cases.iter_mut().for_each(|c| c.letter.clone_from(&c.name));
        }
        let none = vec![None; train.members().len()];
        Ok(Self {
            title: format!("{}, every state", train.name()),
            unit: Some(unit),
            cases,
            speeds: speeds.into_iter().map(|s| s.unwrap_or_else(|| none.clone())).collect(),
            solution: None,
        })
    }
}

fn case(train: &Train, k: usize, name: &str, engaged: &[ShiftElementId], fixed: &[MemberId]) -> LeverCase {
    let held = unstable::held(&Configuration::new(train, engaged, fixed, &[]));
    LeverCase {
        letter: letter(k),
        name: name.to_owned(),
        ratio: None,
        engaged: engaged.iter().map(|e| train.shift_elements()[e.index()].name.clone()).collect(),
        held: held.into_iter().map(|m| train.member_name(m).to_owned()).collect(),
        note: None,
    }
}

fn letter(k: usize) -> String {
    let one = char::from(b'a' + (k % 26) as u8);
    if k < 26 { one.to_string() } else { format!("{one}{}", k / 26) }
}

/// Why there are no torques, or which they are.
fn note(report: &OperationReport) -> Option<String> {
    match (&report.reason, report.solutions.len()) {
        (reason, 2..) => {
            Some(format!("shown is one of {}; {}", report.solutions.len(), reason.clone().unwrap_or_default()))
        }
        (reason, _) => reason.clone(),
    }
}

/// An equilibrium that delivers power, if there is one.
fn chosen(mut all: Vec<SolutionReport>) -> Option<SolutionReport> {
    let at = all.iter().position(|s| !s.all_dissipated).unwrap_or(0);
    (at < all.len()).then(|| all.swap_remove(at))
}

/// A state as a case, and its speeds where the input's settles them.
fn motion(train: &Train, k: usize, state: Option<usize>) -> (LeverCase, Option<Vec<Option<f64>>>) {
    let (name, engaged) =
        state.map_or((AS_DRAWN, &[][..]), |s| (train.states()[s].name.as_str(), &train.states()[s].engaged[..]));
    let mut case = case(train, k, name, engaged, &[]);
    let Some((input, output)) = ends(train, state) else {
        case.note = Some("no input and output are named".to_owned());
        return (case, None);
    };
    let c = Configuration::new(train, engaged, &[], &[]);
    let transfer = c.transfer(&[input]);
    if !transfer.conflicts.is_empty() {
        case.note = Some(format!("{} cannot turn", train.member_name(input)));
        return (case, None);
    }
    let speeds: Vec<Option<f64>> =
        transfer.speeds.iter().map(|w| w.as_ref().map(|w| w[0].to_f64()).filter(|w| w.is_finite())).collect();
    if speeds[output.index()].is_none() {
        let text = format!(
            "{} degrees of freedom: the speed of {} does not settle that of {}",
            c.degrees_of_freedom(),
            train.member_name(input),
            train.member_name(output)
        );
        case.note = Some(text);
        return (case, None);
    }
    case.ratio = speeds[output.index()].filter(|w| *w != 0.0).map(f64::recip);
    (case, Some(speeds))
}

/// The lever of one family, or of several on one line.
fn bar(train: &Train, families: &[Family], placed: &layout::Placed, parts: &[usize], shown: &Shown) -> LeverBar {
    let mut nodes: Vec<(MemberId, LeverNode)> = Vec::new();
    let mut of_point: Vec<Vec<usize>> = Vec::new();
    for &f in parts {
        let family = &families[f];
        let points = family.points.iter().map(|p| (p.member, p.number.to_f64(), p.role));
        let mut own = Vec::new();
        for (member, number, role) in points.chain([(family.carrier, 0.0, LeverRole::Carrier)]) {
            let position = placed.height(f, number);
            let found = nodes.iter().position(|(m, n)| *m == member && (n.position - position).abs() < 1e-9);
            let at = found.unwrap_or_else(|| {
                let speeds = shown.speeds.iter().map(|s| s[member.index()]).collect();
                let name = train.member_name(member).to_owned();
                let colour = member.index().checked_sub(1);
                nodes.push((member, LeverNode { member: name, colour, roles: vec![], position, number, speeds }));
                nodes.len() - 1
            });
            let roles = &mut nodes[at].1.roles;
            if !roles.contains(&role) {
                roles.push(role);
                roles.sort();
            }
            own.push(at);
        }
        of_point.push(own);
    }
    let mut order: Vec<usize> = (0..nodes.len()).collect();
    order.sort_by(|a, b| nodes[*b].1.position.total_cmp(&nodes[*a].1.position));
    let mut rank = vec![0; nodes.len()];
    order.iter().enumerate().for_each(|(r, k)| rank[*k] = r);
    let sets = parts
        .iter()
        .zip(&of_point)
        .map(|(&f, own)| {
            let mut pulls = shown.solution.as_ref().map_or(vec![], |s| pulls(train, &families[f], s));
            for p in &mut pulls {
                let number = families[f].points.get(p.node).map_or(0.0, |x| x.number.to_f64());
                p.point = placed.height(f, p.displacement * number);
                p.node = rank[own[p.node]];
            }
            LeverSet { name: families[f].name.clone(), pulls }
        })
        .collect();
    let mut sorted: Vec<(usize, LeverNode)> = nodes.into_iter().enumerate().map(|(k, (_, n))| (rank[k], n)).collect();
    sorted.sort_by_key(|(r, _)| *r);
    LeverBar { sets, nodes: sorted.into_iter().map(|(_, n)| n).collect() }
}

/// The forces on a family, by point (the carrier's number is that of the points). Heights are left
/// open.
fn pulls(train: &Train, family: &Family, solution: &SolutionReport) -> Vec<LeverPull> {
    // What the outer and the inner gear put into each mesh, and the displacement that this means.
    let mut carrier = 0.0;
    let mut largest = 0.0f64;
    let forces: Vec<[f64; 3]> = family
        .meshes
        .iter()
        .map(|contact| {
            let Some(m) = solution.meshes.get(&train.meshes()[contact.mesh].name) else { return [0.0, 0.0, 1.0] };
            let (outer, inner) = match contact.first {
                true => (m.first_torque_n_m, m.second_torque_n_m),
                false => (m.second_torque_n_m, m.first_torque_n_m),
            };
            carrier += m.carrier_torque_n_m;
            largest = largest.max(outer.abs()).max(inner.abs());
            let ratio = (&family.points[contact.outer].number / &family.points[contact.inner].number).to_f64();
            let displacement = Some(-inner / (ratio * outer)).filter(|d| d.is_finite()).unwrap_or(1.0);
            [outer, inner, displacement]
        })
        .collect();
    let mut displacement = vec![1.0; family.points.len()];
    for k in 1..family.points.len() {
        // The way leads to points found before.
        if let Some(way) = family.points[k].way {
            displacement[k] = displacement[family.meshes[way].inner] * forces[way][2];
        }
    }
    let mut all = Vec::new();
    // A rotor between gears takes what no gear balances: drags, or nothing.
    let between = |k: usize| k == 0 || family.points[k].role == LeverRole::Planet;
    for k in (0..family.points.len()).filter(|k| between(*k)) {
        let own = family.meshes.iter().zip(&forces);
        let torque: f64 =
            own.map(|(c, f)| if c.outer == k { f[0] } else { 0.0 } + if c.inner == k { f[1] } else { 0.0 }).sum();
        if torque.abs() > 1e-12 * largest {
            all.push(LeverPull { node: k, mesh: None, torque, displacement: displacement[k], point: 0.0 });
        }
    }
    for (contact, [torque, _, lambda]) in family.meshes.iter().zip(&forces) {
        if !between(contact.outer) {
            let mesh = Some(train.meshes()[contact.mesh].name.clone());
            let displacement = displacement[contact.inner] * lambda;
            all.push(LeverPull { node: contact.outer, mesh, torque: *torque, displacement, point: 0.0 });
        }
    }
    all.push(LeverPull { node: family.points.len(), mesh: None, torque: carrier, displacement: 1.0, point: 0.0 });
    all
}
