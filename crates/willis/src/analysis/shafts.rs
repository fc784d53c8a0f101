//! What every shaft, planet and shift element does in every state, for one unit of speed and torque at the input.

use serde::{Deserialize, Serialize};

use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, Ratio};
use crate::named::NameMap;
use crate::power_flow::{External, Flow, ties};
use crate::train::{AS_DRAWN, Efficiency, FRAME, MemberId, MemberKind, ShiftElementId, ShiftElementKind, Train};

use super::assumptions;
use super::at_load::{AskedLoad, AtLoad, Loads};
use super::table::Drive;
use super::why::Why;

/// Speeds and torques of a whole shift table: the results contract `willis-table-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShaftTable {
    /// `willis-table-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Where its numbers come from.
    pub source: Option<String>,
    /// Whether torques are those without losses.
    pub lossless: bool,
    /// Every state; the train as drawn where it has none.
    pub states: NameMap<ShaftState>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
    /// What to know beside it.
    pub diagnostics: Vec<Diagnostic>,
}

impl ShaftTable {
    /// The same with what other laws of loss make of the efficiencies at a load: [`AtLoad::band`].
    ///
    /// # Example
    /// ```
    /// use willis::analysis::{AskedLoad, ShaftTableRequest, shaft_table};
    /// use willis::train::Train;
    ///
    /// let train = Train::from_toml(r#"
    ///     format = 1
    ///     name = "one set"
    ///     members = ["s", "c"]
    ///     terminals = ["s", "c"]
    ///     [oil]
    ///     name = "ISO VG 220"
    ///     temperature = "70 degC"
    ///     [[set]]
    ///     name = "P1"
    ///     sun = { member = "s", teeth = 30 }
    ///     planet = { teeth = 20, count = 4 }
    ///     ring = { member = "frame", teeth = 70 }
    ///     carrier = "c"
    ///     geometry = { module = "2 mm", width = "25 mm", roughness = "0.4 um" }
    ///     [[operation]]
    ///     name = "full load"
    ///     speeds = { s = "1000 rpm" }
    ///     torques = { s = "200 N m" }
    /// "#)?;
    /// let request = ShaftTableRequest { load: Some(AskedLoad::default()), ..ShaftTableRequest::default() };
    /// let table = shaft_table(&train, &request)?.with_bands(&train);
    /// let gear = table.states.0[0].1.at_load.as_ref().unwrap();
    /// let band = gear.band.as_ref().unwrap();
    /// assert!(band.low.efficiency < gear.efficiency.unwrap());
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn with_bands(mut self, train: &Train) -> Self {
        for (name, row) in &mut self.states.0 {
            if let Some(at) = &mut row.at_load {
                at.band = at.law_band(train, train.states.iter().position(|s| s.name == *name)).map(Box::new);
            }
        }
        self
    }
}

impl Contract for ShaftTable {
    const FORMAT: &'static str = "willis-table-1";
}

/// What a shift table is asked for.
#[derive(Clone, Debug, Default)]
pub struct ShaftTableRequest {
    /// Only this state.
    pub state: Option<String>,
    /// Torques without the losses of the teeth.
    pub lossless: bool,
    /// What of the load is asked for at which losses are computed; none leaves losses out.
    pub load: Option<AskedLoad>,
}

/// One state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShaftState {
    /// Where power enters.
    pub input: String,
    /// Where it leaves.
    pub output: String,
    /// Shift elements that are closed.
    pub engaged: Vec<String>,
    /// `ω_input/ω_output`, exactly.
    pub ratio: Option<Rational>,
    /// Output over input power, the input driving.
    pub efficiency: Option<f64>,
    /// The efficiency exactly, where the efficiencies of the meshes are given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub efficiency_exact: Option<Rational>,
    /// Why speeds or torques are missing.
    pub reason: Option<String>,
    /// What `reason` says, as data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<Why>,
    /// Every member, planets included.
    pub members: NameMap<ShaftMember>,
    /// Every shift element.
    pub shift_elements: NameMap<ShaftElement>,
    /// Torque that each member puts into each set, or mesh of no set, over the input torque.
    pub sets: NameMap<NameMap<f64>>,
    /// What it costs at a load and without one, where losses depend on that.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at_load: Option<Box<AtLoad>>,
}

/// A member in a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShaftMember {
    /// Speed over that of the input; absent where the input does not settle it.
    pub speed: Option<Rational>,
    /// The carrier on which it turns, for a planet.
    pub carrier: Option<String>,
    /// Speed relative to that carrier, over the speed of the input.
    pub relative_speed: Option<Rational>,
    /// External torque over that of the input, reactions of brakes included; absent where it is not determined.
    pub torque: Option<f64>,
}

/// A shift element in a state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShaftElement {
    /// What it is.
    pub kind: ShiftElementKind,
    /// The members it joins.
    pub members: [String; 2],
    /// Whether it is closed.
    pub engaged: bool,
    /// Speed of the first member less that of the second, over the speed of the input: 0 while it is closed.
    pub slip: Option<Rational>,
    /// Torque that it exerts on the first member, over the input torque; 0 while it is open, absent where it is not
    /// determined.
    pub torque: Option<f64>,
}

/// Speeds and torques of every shaft, planet and shift element in every state, per unit of speed and torque at the input,
/// which drives; and losses at a load.
///
/// # Errors
/// A state that the train does not have; a train without input and output.
///
/// # Example
/// ```
/// use willis::analysis::{ShaftTableRequest, shaft_table};
/// use willis::exact::Rational;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.98))
///     .build()?;
/// let table = shaft_table(&train, &ShaftTableRequest { lossless: true, ..ShaftTableRequest::default() })?;
/// let only = &table.states.0[0].1;
/// assert_eq!(only.members.get("carrier").unwrap().speed, Some(Rational::new(3, 10)));
/// // The planet turns backwards on its carrier, 30/20 times as fast as the sun does seen from there.
/// let planet = only.members.get("P1.planet").unwrap();
/// assert_eq!(planet.relative_speed, Some(Rational::new(-21, 20)));
/// assert!((only.members.get("carrier").unwrap().torque.unwrap() + 10.0 / 3.0).abs() < 1e-12);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn shaft_table(train: &Train, request: &ShaftTableRequest) -> Result<ShaftTable, Diagnostics> {
    let (state, lossless) = (request.state.as_deref(), request.lossless);
    let only = state.filter(|name| *name != AS_DRAWN).map(|name| train.find_state(name)).transpose();
    let only = only.map_err(|d| Diagnostics::from(*d))?;
    let mut states = Vec::new();
    let mut diagnostics = Diagnostics::default();
    for (k, s) in train.states.iter().enumerate() {
        if state.is_some() && only != Some(k) {
            continue;
        }
        match row(train, &s.engaged, train.ends(Some(k)), lossless) {
            Some(row) => states.push((s.name.clone(), row)),
            None => diagnostics.push(no_ends(&format!("state {}", s.name), &format!("state[{k}]"))),
        }
    }
    if train.states.is_empty() || state == Some(AS_DRAWN) {
        match row(train, &[], train.ends(None), lossless) {
            Some(row) => states.push((AS_DRAWN.to_owned(), row)),
            None => return Err(no_ends("the train", "").into()),
        }
    }
    if let Some(asked) = &request.load {
        let mut loads = Loads::new(train, asked)?;
        for (name, s) in &mut states {
            s.at_load = loads.at(train.states.iter().position(|own| own.name == *name));
        }
        // Where there is a ratio, and no other reason.
        let without = states.iter().filter(|(_, s)| s.ratio.is_some() && s.at_load.is_none());
        let without: Vec<&str> = without.map(|(name, _)| name.as_str()).collect();
        let is_asked = asked.torque.is_some() || asked.temperature.is_some();
        if !without.is_empty() && (is_asked || train.depends_on_load()) {
            diagnostics.push(no_load(train, &without));
        }
    }
    Ok(ShaftTable {
        format: Format::new(),
        train: train.name.clone(),
        source: train.source.clone(),
        lossless,
        states: NameMap(states),
        assumptions: assumptions(train),
        diagnostics: diagnostics.into_iter().collect(),
    })
}

/// Why a load that is asked for says nothing.
fn no_load(train: &Train, states: &[&str]) -> Diagnostic {
    let new = |text: &str| Diagnostic::new(Code::NothingAsked, "", text);
    match train.depends_on_load() {
        false => new("the losses of this train are given efficiencies: neither load nor oil changes them")
            .hint("give `geometry`, bearings, seals or drags to have losses that do"),
        true => new(&format!(
            "{}: no losses at a load, because neither the file nor what is asked for has both speed and torque of an input \
             that drives",
            states.join(", ")
        ))
        .hint("ask for speed and torque of the input, or add an [[operation]] in which it drives"),
    }
}

fn no_ends(what: &str, place: &str) -> Diagnostic {
    let text =
        format!("{what} has no two different members as input and output, so nothing can be told per unit of them");
    Diagnostic::new(Code::NothingAsked, place, text).hint("name two `terminals`, or `input` and `output`")
}

/// Torques over that of the input.
struct Torques {
    members: Vec<Option<f64>>,
    elements: Vec<(ShiftElementId, Option<f64>)>,
    sets: Vec<(String, Vec<(MemberId, f64)>)>,
    efficiency: f64,
    exact: Option<Rational>,
}

fn row(train: &Train, engaged: &[ShiftElementId], ends: [Option<MemberId>; 2], lossless: bool) -> Option<ShaftState> {
    let [Some(input), Some(output)] = ends else { return None };
    if input == output {
        return None;
    }
    let mut c = Configuration::new(train, engaged, &[], &[]);
    if lossless {
        c = c.with_efficiencies(vec![Efficiency::lossless(); train.meshes.len()]);
    }
    let name = |m: MemberId| train.member_name(m).to_owned();
    let transfer = c.transfer(&[input]);
    // Per unit of the input's speed; nothing where the input cannot turn.
    let turns = c.node(input).is_some() && transfer.conflicts.is_empty();
    let speed = |m: MemberId| transfer.speeds[m.0].as_ref().filter(|_| turns).map(|w| w[0].clone());
    let (torques, why) = match drive(&c, input, output) {
        Ok(torques) => (Some(torques), None),
        Err(why) => (None, Some(why)),
    };
    let of_member = |m: MemberId| {
        let carrier = (train.members[m.0].kind == MemberKind::Planet)
            .then(|| train.meshes.iter().find(|x| x.gears.iter().any(|g| g.member == m)).map(|x| x.carrier))
            .flatten()
            .filter(|carrier| *carrier != FRAME);
        ShaftMember {
            speed: speed(m),
            relative_speed: carrier.and_then(|carrier| Some(speed(m)? - speed(carrier)?)),
            carrier: carrier.map(name),
            torque: torques.as_ref().and_then(|t| t.members[m.0]),
        }
    };
    let of_element = |k: usize| {
        let e = &train.shift_elements[k];
        let is_closed = engaged.contains(&ShiftElementId(k));
        let [a, b] = e.members.map(speed);
        ShaftElement {
            kind: e.kind,
            members: e.members.map(name),
            engaged: is_closed,
            slip: if is_closed { Some(Rational::ZERO) } else { a.zip(b).map(|(a, b)| a - b) },
            torque: match &torques {
                _ if !is_closed => Some(0.0),
                Some(t) => t.elements.iter().find(|(id, _)| id.0 == k).and_then(|(_, torque)| *torque),
                None => None,
            },
        }
    };
    let sets = torques
        .iter()
        .flat_map(|t| &t.sets)
        .map(|(set, members)| (set.clone(), NameMap(members.iter().map(|(m, torque)| (name(*m), *torque)).collect())));
    Some(ShaftState {
        input: name(input),
        output: name(output),
        engaged: engaged.iter().map(|e| train.shift_elements[e.0].name.clone()).collect(),
        ratio: match c.ratio(input, output) {
            Ratio::Exact(r) => Some(r),
            _ => None,
        },
        efficiency: torques.as_ref().map(|t| t.efficiency),
        efficiency_exact: torques.as_ref().and_then(|t| t.exact.clone()).filter(|_| lossless || c.is_exact()),
        reason: why.as_ref().map(ToString::to_string),
        why,
        members: (1..train.members.len()).map(MemberId).map(|m| (name(m), of_member(m))).collect(),
        shift_elements: (0..train.shift_elements.len())
            .map(|k| (train.shift_elements[k].name.clone(), of_element(k)))
            .collect(),
        sets: NameMap(sets.collect()),
        at_load: None,
    })
}

/// Torques while the input drives the output; why there are none, or several.
fn drive(c: &Configuration<'_>, input: MemberId, output: MemberId) -> Result<Torques, Why> {
    let train = c.train;
    let redundant = c.redundant();
    if !redundant.is_empty() {
        let group = |g: &Vec<crate::train::MeshId>| g.iter().map(|m| train.meshes[m.0].name.clone()).collect();
        return Err(Why::RedundantMeshes { groups: redundant.iter().map(group).collect() });
    }
    let drive = Drive::new(c, input, output).map_err(|(_, why)| why)?;
    let [w_in, w_out] = drive.speeds.each_ref().map(Rational::to_f64);
    let Some(balance) = drive.balance else {
        let mut external = vec![0.0; train.members.len()];
        (external[input.0], external[output.0]) = (1.0, -1.0);
        let (elements, reactions) = ties(c, &vec![0.0; external.len()], &external);
        let members = reactions.iter().zip(&external).map(|(r, x)| r.map(|r| r + x)).collect();
        let elements = elements.iter().map(|t| (t.element, t.torque)).collect();
        return Ok(Torques { members, elements, sets: vec![], efficiency: 1.0, exact: Some(Rational::ONE) });
    };
    let s = match (&balance.answer.solutions[..], balance.answer.stretches.is_empty()) {
        ([], true) => {
            return Err(Why::FrictionLocks {
                from: train.member_name(input).into(),
                to: train.member_name(output).into(),
            });
        }
        ([only], true) if balance.answer.certificate != crate::statics::Certificate::Undecided => only,
        (_, false) => return Err(Why::Threshold { ranges: vec![] }),
        (_, true) if balance.answer.certificate == crate::statics::Certificate::Undecided => {
            return Err(Why::TooManyMeshes);
        }
        _ => return Err(Why::Several),
    };
    let (torque, sign) = balance.equilibrium.balancing_torque(c, s, &balance.loads, balance.node);
    if sign == 0 || f64::from(sign) * w_in <= 0.0 {
        return Err(Why::FrictionLocks { from: train.member_name(input).into(), to: train.member_name(output).into() });
    }
    let load = -w_out.signum();
    let motion: &Motion = &drive.motion;
    let acting = [
        External { member: input, torque: 1.0, prescribed_power: None, power: 1 },
        External { member: output, torque: load / torque, prescribed_power: None, power: -1 },
    ];
    let flow = Flow::new(c, motion, s, 1.0 / torque, &acting, &[], &[]);
    let mut sets: Vec<(String, Vec<(MemberId, f64)>)> = Vec::new();
    for m in &flow.meshes {
        let mesh = &train.meshes[m.mesh.0];
        let name = mesh.set.map_or(&mesh.name, |k| &train.sets[k].name);
        let at = sets.iter().position(|(own, _)| own == name).unwrap_or_else(|| {
            sets.push((name.clone(), vec![]));
            sets.len() - 1
        });
        for (member, torque) in [mesh.gears[0].member, mesh.gears[1].member, mesh.carrier].into_iter().zip(m.torques) {
            if train.members[member.0].kind == MemberKind::Planet {
                continue;
            }
            match sets[at].1.iter_mut().find(|(own, _)| *own == member) {
                Some((_, sum)) => *sum += torque,
                None => sets[at].1.push((member, torque)),
            }
        }
    }
    let exact_in = balance.equilibrium.exact_torque(c, s, &balance.loads, balance.node);
    let exact = exact_in.map(|t| drive.speeds[1].abs() / (t * drive.speeds[0].clone()).abs());
    Ok(Torques {
        efficiency: w_out.abs() / (torque * w_in).abs(),
        exact,
        members: flow.torques,
        elements: flow.ties.iter().map(|t| (t.element, t.torque)).collect(),
        sets,
    })
}
