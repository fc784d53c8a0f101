//! Hybrids: planetary sets between an engine, an output and two motors, with clutches that make modes.
//!
//! Terminals are E (engine, shaft 0), O (output, 1), the housing (2), A and B (motors, 3 and 4). A mode closes some of the
//! clutches and leaves one or two freedoms. With two freedoms the four terminals are vectors of a plane, and their
//! directions say what the mode is: input split if the output is parallel to a motor, output split if the engine is,
//! compound split if no two are. With one freedom it is a fixed gear, electric or charging by what turns. All of that is
//! decided by ranks, which are exact.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;
use std::sync::Mutex;

use serde::{Deserialize, Serialize};
use willis::contract::{Contract, Format};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::work::{Cancelled, Effort, Work};

use super::harvest;
use super::layout::{GROUND, Layout, Layouts, OUTPUT, Prefix, shaft_digit};
use super::motion::{self, MAX_MOBILITY, Motion};
use super::points::{Points, direction};
use super::report::SchemeCompleteness;
use super::table::binomial;
use super::wish::SetRatio;
use willis::exact::residue;

const MOTORS: [u8; 2] = [3, 4];
/// Engine, output, motors.
const TERMINALS: [u8; 4] = [0, OUTPUT, 3, 4];

/// What a mode of a hybrid is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
pub enum ModeKind {
    /// Two freedoms: the output turns with a motor, the engine with none.
    InputSplit,
    /// Two freedoms: the engine turns with a motor, the output with none.
    OutputSplit,
    /// Two freedoms: neither engine nor output turns with a motor.
    CompoundSplit,
    /// Two freedoms: engine and output each turn with a motor.
    InputAndOutputGeared,
    /// Two freedoms: the engine turns with the output.
    EngineGearedToOutput,
    /// Two freedoms: the motors turn with each other.
    MotorsGearedTogether,
    /// Two freedoms: a terminal is at rest.
    OneAtRest,
    /// One freedom: engine and output turn, no motor does.
    Fixed,
    /// One freedom: engine, output and a motor turn.
    FixedWithMotor,
    /// One freedom: the engine is at rest, output and a motor turn.
    Electric,
    /// One freedom: the output is at rest, engine and a motor turn.
    Charging,
    /// One freedom that is of no use.
    Nothing,
}

impl ModeKind {
    const ALL: [(Self, &'static str); 12] = [
        (Self::InputSplit, "input-split"),
        (Self::OutputSplit, "output-split"),
        (Self::CompoundSplit, "compound-split"),
        (Self::InputAndOutputGeared, "input-and-output-geared"),
        (Self::EngineGearedToOutput, "engine-geared-to-output"),
        (Self::MotorsGearedTogether, "motors-geared-together"),
        (Self::OneAtRest, "one-at-rest"),
        (Self::Fixed, "fixed"),
        (Self::FixedWithMotor, "fixed-with-motor"),
        (Self::Electric, "electric"),
        (Self::Charging, "charging"),
        (Self::Nothing, "nothing"),
    ];
}

impl fmt::Display for ModeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(Self::ALL.iter().find(|(kind, _)| kind == self).map_or("", |(_, name)| name))
    }
}

impl FromStr for ModeKind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let found = Self::ALL.iter().find(|(_, name)| *name == text).map(|(kind, _)| *kind);
        let names = Self::ALL.map(|(_, name)| name).join(", ");
        found.ok_or_else(|| format!("`{text}` is no kind of mode; there are {names}"))
    }
}

/// What a hybrid must do.
///
/// # Example
/// ```
/// use willis::work::Serial;
/// use willis_synthesis::schemes::{HybridWish, ModeKind, hybrids};
///
/// let wish = HybridWish::new(&["17/10", "23/10"], 3, &["input-split", "compound-split", "electric", "fixed"])?;
/// let answer = hybrids(&wish, &Serial)?;
/// assert_eq!((answer.layouts, answer.kinematic, answer.designs_found), (900, 2088, 3240));
/// assert_eq!(answer.modes[&ModeKind::CompoundSplit], 864);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct HybridWish {
    /// The tooth ratio of each set.
    pub sets: Vec<SetRatio>,
    /// Clutches and brakes.
    pub clutches: usize,
    /// Freedoms with no clutch closed.
    #[serde(default = "three")]
    pub mobility: usize,
    /// Modes that there must be. `fixed` is met by a fixed gear in which a motor turns, too.
    pub need: Vec<ModeKind>,
    /// How many designs are shown.
    #[serde(default = "ten")]
    pub top: usize,
}

fn three() -> usize {
    3
}

fn ten() -> usize {
    10
}

impl HybridWish {
    /// Hybrids of sets with these tooth ratios, so many clutches, and mobility 3.
    ///
    /// # Errors
    /// A tooth ratio that cannot be read or is not above 1, or an unknown kind of mode.
    pub fn new(sets: &[&str], clutches: usize, need: &[&str]) -> Result<Self, String> {
        Ok(Self {
            sets: sets.iter().map(|text| text.parse()).collect::<Result<_, String>>()?,
            clutches,
            mobility: 3,
            need: need.iter().map(|text| text.parse()).collect::<Result<_, String>>()?,
            top: 10,
        })
    }

    fn ratios(&self) -> Vec<Rational> {
        self.sets.iter().map(|s| s.ratio().clone()).collect()
    }

    /// Everything that is wrong with it.
    ///
    /// # Errors
    /// All of that.
    pub fn check(&self) -> Result<(), Diagnostics> {
        let mut wrong = Diagnostics::default();
        let mut say = |code: Code, place: &str, message: String, hint: &str| {
            wrong.push(Diagnostic::new(code, place, message).hint(hint));
        };
        let sets = self.sets.len();
        if !(1..=3).contains(&sets) {
            say(Code::OutOfRange, "sets", format!("there are {sets} sets"), "give the tooth ratios of 1 to 3 sets");
        } else if motion::teeth(&self.ratios()).is_none() {
            let hint = "give ratios of tooth numbers, or decimals with fewer digits";
            say(Code::OutOfRange, "sets", "the tooth ratios have too many digits to be computed exactly".into(), hint);
        }
        if !(2..=4).contains(&self.mobility) {
            let message = format!("a mobility of {}", self.mobility);
            say(Code::OutOfRange, "mobility", message, "there can be 2 to 4 freedoms with no clutch closed");
        } else if (1..=3).contains(&sets) && !(4..=3 * sets).contains(&(self.mobility + sets)) {
            let message = format!("{sets} sets do not carry four terminals with mobility {}", self.mobility);
            say(Code::Conflict, "mobility", message, "give more sets, or another mobility");
        }
        if !(1..=6).contains(&self.clutches) {
            say(Code::OutOfRange, "clutches", format!("there are {} clutches", self.clutches), "give 1 to 6");
        }
        if self.need.is_empty() {
            say(Code::MissingKey, "need", "no mode is wanted".into(), "name one at least, such as `input-split`");
        }
        if wrong.is_empty() { Ok(()) } else { Err(wrong) }
    }
}

/// A mode of a hybrid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HybridMode {
    /// What it is.
    pub kind: ModeKind,
    /// The clutches that are closed.
    pub closed: Vec<String>,
    /// Which of `engine`, `output`, `A` and `B` can turn.
    pub turning: Vec<String>,
    /// Two freedoms: ratios of engine to output speed at which a motor is at rest and all power passes through gears
    /// (mechanical points), motor A first.
    pub mechanical_points: Vec<Rational>,
    /// One freedom: the ratio of engine to output speed, if both turn.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Rational>,
}

/// A hybrid: a layout with clutches, and its modes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HybridDesign {
    /// Its name: layout, and the digits of the shafts that each clutch joins.
    pub id: String,
    /// The layout; 0 is the engine, 1 the output, 2 the housing, 3 and 4 are the motors.
    pub layout: String,
    /// The tooth ratio of every set.
    pub sets: Vec<SetRatio>,
    /// What the shafts are called, by digit: `engine`, `output`, `housing`, `A`, `B`, and what others carry.
    pub shafts: Vec<String>,
    /// The shafts that each clutch joins: `C1`, `C2`, …
    pub clutches: Vec<[String; 2]>,
    /// Other choices of clutches that have the same modes with the same speeds.
    pub same: usize,
    /// The modes that are of use.
    pub modes: Vec<HybridMode>,
}

/// All hybrids that do what is wanted. Serialised it is the contract `willis-hybrids-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Hybrids {
    /// `willis-hybrids-1`.
    pub format: Format<Self>,
    /// What was wanted.
    pub wish: HybridWish,
    /// How much of the space the answer covers.
    pub completeness: SchemeCompleteness,
    /// What was taken where nothing was said.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub assumptions: Vec<String>,
    /// Layouts, with the motors exchanged counted once.
    pub layouts: u64,
    /// Modes of all layouts by their kind, with clutches that do the same counted once.
    pub modes: BTreeMap<ModeKind, u64>,
    /// Choices of clutches that differ in what they do.
    pub choices: u64,
    /// Of these, those that have the modes that are needed.
    pub kinematic: u64,
    /// The same with every place for the clutches.
    pub designs_found: u64,
    /// The first designs in the order of layouts, one for all places of its clutches that do the same.
    pub designs: Vec<HybridDesign>,
}

impl Contract for Hybrids {
    const FORMAT: &'static str = "willis-hybrids-1";
}

type Vector = [u64; MAX_MOBILITY];

/// How many of some vectors are independent: elimination modulo a prime.
fn rank(rows: impl IntoIterator<Item = Vector>) -> usize {
    let mut rows: Vec<Vector> = rows.into_iter().collect();
    let mut rank = 0;
    for column in 0..MAX_MOBILITY {
        let Some(found) = (rank..rows.len()).find(|r| rows[*r][column] != 0) else { continue };
        rows.swap(rank, found);
        let pivot = rows[rank];
        for row in &mut rows[rank + 1..] {
            let factor = row[column];
            for c in 0..MAX_MOBILITY {
                row[c] = residue::minus(residue::times(row[c], pivot[column]), residue::times(factor, pivot[c]));
            }
        }
        rank += 1;
    }
    rank
}

/// What a mode is, from the terminals' and the closed clutches' vectors; none if it leaves another number of freedoms.
fn kind(mobility: usize, terminals: &[Vector; 4], closed: &[Vector]) -> Option<ModeKind> {
    let own = rank(closed.iter().copied());
    if own != closed.len() {
        return None;
    }
    let [e, o, a, b] = *terminals;
    let with = |more: &[Vector]| rank(closed.iter().chain(more).copied()) - own;
    let [turns_e, turns_o, turns_a, turns_b] = turning(terminals, closed);
    let together = |x: Vector, y: Vector| with(&[x, y]) < 2;
    Some(match mobility - own {
        1 => match (turns_e, turns_o, turns_a || turns_b) {
            (true, false, true) => ModeKind::Charging,
            (false, true, true) => ModeKind::Electric,
            (true, true, true) => ModeKind::FixedWithMotor,
            (true, true, false) => ModeKind::Fixed,
            _ => ModeKind::Nothing,
        },
        2 => {
            let [output, input] = [o, e].map(|end| together(end, a) || together(end, b));
            match () {
                () if !(turns_e && turns_o && turns_a && turns_b) => ModeKind::OneAtRest,
                () if together(e, o) => ModeKind::EngineGearedToOutput,
                () if together(a, b) => ModeKind::MotorsGearedTogether,
                () if output && input => ModeKind::InputAndOutputGeared,
                () if output => ModeKind::InputSplit,
                () if input => ModeKind::OutputSplit,
                () => ModeKind::CompoundSplit,
            }
        }
        _ => return None,
    })
}

/// Which of the terminals can turn with these clutches closed.
fn turning(terminals: &[Vector; 4], closed: &[Vector]) -> [bool; 4] {
    let own = rank(closed.iter().copied());
    terminals.map(|t| rank(closed.iter().copied().chain([t])) > own)
}

/// The subsets of `0..n` of a size, in order.
fn subsets(n: usize, size: usize) -> Vec<Vec<usize>> {
    let all = (0..1_u64 << n).filter(|s| s.count_ones() as usize == size);
    all.map(|s| (0..n).filter(|k| s >> k & 1 == 1).collect()).collect()
}

fn space(wish: &HybridWish) -> Layouts {
    Layouts::with_terminals(wish.sets.len(), wish.mobility + wish.sets.len(), 5)
}

/// A search for hybrids, checked and cut into parts that are independent of each other.
///
/// # Example
/// ```
/// use willis::work::Serial;
/// use willis_synthesis::schemes::{HybridHarvest, HybridSearch, HybridWish};
///
/// let search = HybridSearch::new(&HybridWish::new(&["17/10", "23/10"], 3, &["input-split", "fixed"])?)?;
/// let (mut whole, mut rest) = (HybridHarvest::default(), HybridHarvest::default());
/// search.harvest(&Serial, search.shard(0, 2), &mut whole);
/// search.harvest(&Serial, search.shard(1, 2), &mut rest);
/// whole.merge(&search, HybridHarvest::read(&rest.to_json(), &search)?)?;
/// assert!(search.answer(&whole).completeness.complete);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct HybridSearch {
    wish: HybridWish,
    parts: Vec<Prefix>,
}

/// What parts of a search for hybrids have found.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HybridHarvest {
    /// `willis-hybrids-progress-1`.
    format: Format<Self>,
    /// What it belongs to: the wish as JSON.
    wish: String,
    /// Parts that are done, growing.
    done: Vec<usize>,
    found: Part,
}

impl Contract for HybridHarvest {
    const FORMAT: &'static str = "willis-hybrids-progress-1";
}

impl HybridHarvest {
    /// The parts that are done, growing.
    pub fn parts(&self) -> &[usize] {
        &self.done
    }

    /// As JSON, for [`HybridHarvest::read`].
    pub fn to_json(&self) -> String {
        serde_json::to_string(self).expect("plain data") + "\n"
    }

    /// Reads what was kept of a search.
    ///
    /// # Errors
    /// It is none, it is spoilt, or it is that of another search.
    pub fn read(text: &str, search: &HybridSearch) -> Result<Self, Diagnostics> {
        let own: Self = harvest::parse(text)?;
        harvest::fits(&own.wish, &search.name(), &own.done, search.parts.len())?;
        let Part { choices, kinematic, hardware, designs, .. } = &own.found;
        let shown = (*kinematic).min(search.wish.top as u64);
        let is_done = |(part, design): &(usize, HybridDesign)| {
            own.done.binary_search(part).is_ok() && design.clutches.len() == search.wish.clutches
        };
        let sound = kinematic <= choices && kinematic <= hardware && designs.len() as u64 == shown;
        match sound && designs.iter().all(is_done) {
            true => Ok(own),
            false => Err(harvest::spoilt()),
        }
    }

    /// Adds what other parts of the same search have found.
    ///
    /// # Errors
    /// It belongs to another wish, or a part is in both.
    pub fn merge(&mut self, search: &HybridSearch, other: Self) -> Result<(), Diagnostics> {
        harvest::apart(&self.done, &other.done)?;
        for one in [&*self, &other] {
            harvest::fits(&one.wish, &search.name(), &one.done, search.parts.len())?;
        }
        self.wish = search.name();
        self.done.extend(other.done);
        self.done.sort_unstable();
        self.found.add(other.found, search.wish.top);
        Ok(())
    }
}

impl HybridSearch {
    /// Checks a wish and makes it ready.
    ///
    /// # Errors
    /// What [`HybridWish::check`] says.
    pub fn new(wish: &HybridWish) -> Result<Self, Diagnostics> {
        wish.check()?;
        Ok(Self { wish: wish.clone(), parts: space(wish).prefixes(3 * (wish.sets.len() - 1)) })
    }

    /// Into how many parts the work is cut.
    pub fn parts(&self) -> usize {
        self.parts.len()
    }

    /// The parts of share `k` of `n` shares of about the same work, counted from 0.
    pub fn shard(&self, k: usize, n: usize) -> impl Iterator<Item = usize> + use<> {
        (k..self.parts()).step_by(n.max(1))
    }

    /// Whether so many parts of it may take as long as they do.
    ///
    /// # Errors
    /// They may not.
    pub fn afford_parts(&self, work: &dyn Work, parts: usize) -> Result<(), Diagnostics> {
        let shafts = self.wish.mobility + self.wish.sets.len();
        let places = shafts * (shafts + 1) / 2 - 1;
        let choices = binomial(places, self.wish.clutches);
        let counts = super::layout::count_layouts(self.wish.sets.len());
        let layouts = counts.get(&shafts).map_or(0, |n| u64::try_from(*n).unwrap_or(u64::MAX));
        let share = parts as f64 / self.parts.len().max(1) as f64;
        let effort = Effort::new("layouts", (layouts as f64 * share) as u64, 1e-6 * (100 + choices) as f64);
        let Err(too_long) = work.afford(&effort) else { return Ok(()) };
        let message = format!("{too_long}; up to {choices} choices of {} clutches in each", self.wish.clutches);
        let hint = "give fewer sets or clutches, search a `shard` (1/100), or say `yes` to let it go on";
        Err(Diagnostic::new(Code::TooLong, "", message).hint(hint).into())
    }

    fn name(&self) -> String {
        serde_json::to_string(&self.wish).unwrap_or_default()
    }

    /// Searches some of the parts and adds what they find to a harvest; parts that it has already are left out.
    ///
    /// If the work is cancelled, the parts that were not finished are missing; the rest of the harvest holds.
    pub fn harvest(&self, work: &dyn Work, parts: impl IntoIterator<Item = usize>, into: &mut HybridHarvest) {
        let parts = harvest::missing(parts, self.parts(), &into.done);
        work.begin("parts", parts.len() as u64);
        let whole = Mutex::new(std::mem::take(into));
        work.run(parts.len(), &|k| {
            let Some(own) = self.part(parts[k], work) else { return };
            let mut whole = whole.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            whole.done.push(parts[k]);
            whole.found.add(own, self.wish.top);
            drop(whole);
            work.advance(1);
        });
        *into = whole.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
        into.done.sort_unstable();
        into.wish = self.name();
    }

    /// One part; none where the work was cancelled within it.
    fn part(&self, part: usize, work: &dyn Work) -> Option<Part> {
        let mut own = Part::default();
        let ratios = self.wish.ratios();
        let teeth = motion::teeth(&ratios)?;
        let mut points = Points::default();
        let whole = space(&self.wish).walk(&self.parts[part], &mut |layout| {
            layout_of(&self.wish, part, layout, &ratios, &teeth, &mut points, &mut own);
            !work.cancelled()
        });
        whole.then_some(own)
    }

    /// The answer that parts give.
    pub fn answer(&self, harvest: &HybridHarvest) -> Hybrids {
        let (wish, found) = (&self.wish, &harvest.found);
        let (parts, done) = (self.parts(), harvest.done.len());
        let share = if parts == 0 { 1.0 } else { done as f64 / parts as f64 };
        let ratios: Vec<String> = wish.sets.iter().map(ToString::to_string).collect();
        let mut statement = format!(
            "All connections of {} simple sets, tooth ratios {}, with engine, output and two motors, mobility {}, {} \
             clutches: {} layouts with the motors exchangeable, {} choices of clutches that differ in what they do, ",
            wish.sets.len(),
            ratios.join(", "),
            wish.mobility,
            wish.clutches,
            found.layouts,
            found.choices,
        );
        statement += &match done == parts {
            true => format!(
                "all examined; {} have the modes, in {} places; nothing else exists in this space.",
                found.kinematic, found.hardware
            ),
            false => format!(
                "{:.1} % of the parts of the space are finished; {} have the modes there, in {} places; the rest was not \
                 examined.",
                100.0 * share,
                found.kinematic,
                found.hardware
            ),
        };
        Hybrids {
            format: Format::new(),
            wish: wish.clone(),
            completeness: SchemeCompleteness {
                complete: done == parts,
                parts,
                asked: parts,
                done,
                share,
                sample: 1,
                statement,
            },
            assumptions: vec![],
            layouts: found.layouts,
            modes: found.modes.clone(),
            choices: found.choices,
            kinematic: found.kinematic,
            designs_found: found.hardware,
            designs: found.designs.iter().map(|(_, design)| design.clone()).collect(),
        }
    }
}

/// Finds all hybrids that do what is wanted.
///
/// # Errors
/// What [`HybridWish::check`] says; the search takes too long for its surroundings, or was cancelled.
pub fn hybrids(wish: &HybridWish, work: &dyn Work) -> Result<Hybrids, Diagnostics> {
    let search = HybridSearch::new(wish)?;
    search.afford_parts(work, search.parts())?;
    let mut harvest = HybridHarvest::default();
    search.harvest(work, 0..search.parts(), &mut harvest);
    match harvest.done.len() == search.parts() {
        true => Ok(search.answer(&harvest)),
        false => Err(Cancelled.into()),
    }
}

/// What was found: counts, and the first designs with the parts that they are in.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Part {
    layouts: u64,
    choices: u64,
    kinematic: u64,
    hardware: u64,
    modes: BTreeMap<ModeKind, u64>,
    designs: Vec<(usize, HybridDesign)>,
}

impl Part {
    /// Designs are kept in the order of their parts, so that it does not matter in which order these are added.
    fn add(&mut self, other: Self, top: usize) {
        let sum = |own: &mut u64, more: u64| *own = own.saturating_add(more);
        sum(&mut self.layouts, other.layouts);
        sum(&mut self.choices, other.choices);
        sum(&mut self.kinematic, other.kinematic);
        sum(&mut self.hardware, other.hardware);
        for (kind, count) in other.modes {
            sum(self.modes.entry(kind).or_default(), count);
        }
        self.designs.extend(other.designs);
        self.designs.sort_by_key(|(part, _)| *part);
        self.designs.truncate(top);
    }
}

fn layout_of(
    wish: &HybridWish,
    part: usize,
    layout: &Layout,
    ratios: &[Rational],
    teeth: &motion::Teeth,
    points: &mut Points,
    own: &mut Part,
) {
    let blocks = layout.blocks();
    let first = |terminal: u8| blocks.iter().position(|b| *b == terminal);
    if TERMINALS.iter().any(|t| first(*t).is_none()) || first(MOTORS[0]) > first(MOTORS[1]) {
        return;
    }
    let Some(motion) = Motion::of(layout, teeth) else { return };
    own.layouts += 1;
    // Ends are looked at here, so it does not matter whether they turn.
    points.fill_from(&motion, |x, y| [x, y] != [OUTPUT, GROUND]);
    let terminals = TERMINALS.map(|t| direction(motion.shaft(t)));
    let mobility = motion.mobility;
    let kinds: Vec<BTreeMap<Vec<usize>, ModeKind>> = [mobility - 2, mobility - 1]
        .map(|closed| {
            let mut all = BTreeMap::new();
            for set in subsets(points.len(), closed) {
                let vectors: Vec<Vector> = set.iter().map(|p| points.class[*p]).collect();
                if let Some(kind) = kind(mobility, &terminals, &vectors) {
                    *own.modes.entry(kind).or_default() += 1;
                    all.insert(set, kind);
                }
            }
            all
        })
        .into();
    if points.len() < wish.clutches {
        return;
    }
    let shafts = layout.shafts();
    let mut members = vec![0; shafts];
    blocks.iter().for_each(|b| members[usize::from(*b)] += 1);
    let positions: Vec<Vec<usize>> =
        [mobility - 2, mobility - 1].iter().flat_map(|closed| subsets(wish.clutches, *closed)).collect();
    let mut chosen: Vec<usize> = (0..wish.clutches).collect();
    loop {
        own.choices += 1;
        let modes: Vec<(usize, ModeKind)> = positions
            .iter()
            .enumerate()
            .filter_map(|(p, set)| {
                let set: Vec<usize> = set.iter().map(|k| chosen[*k]).collect();
                let kind = kinds.iter().find_map(|k| k.get(&set))?;
                Some((p, *kind))
            })
            .collect();
        let has = |need: &ModeKind| {
            modes.iter().any(|(_, k)| k == need || *need == ModeKind::Fixed && *k == ModeKind::FixedWithMotor)
        };
        if wish.need.iter().all(has) {
            let hardware = places(&chosen, points, &members);
            if let Some(clutches) = hardware.first() {
                own.kinematic += 1;
                own.hardware += hardware.len() as u64;
                if own.designs.len() < wish.top {
                    let modes: Vec<(&[usize], ModeKind, Vec<bool>)> = modes
                        .iter()
                        .map(|(p, kind)| {
                            let closed: Vec<Vector> = positions[*p].iter().map(|k| points.class[chosen[*k]]).collect();
                            (positions[*p].as_slice(), *kind, turning(&terminals, &closed).to_vec())
                        })
                        .collect();
                    let found = (wish, layout, ratios, clutches.as_slice());
                    own.designs.push((part, design(found, hardware.len() - 1, &modes)));
                }
            }
        }
        // The next choice of points.
        let Some(at) = (0..wish.clutches).rev().find(|k| chosen[*k] + wish.clutches - k < points.len()) else { return };
        chosen[at] += 1;
        for k in at + 1..wish.clutches {
            chosen[k] = chosen[k - 1] + 1;
        }
    }
}

/// The places of clutches at points by which no shaft besides the terminals dangles.
fn places(chosen: &[usize], points: &Points, members: &[usize]) -> Vec<Vec<[u8; 2]>> {
    let mut all: Vec<Vec<[u8; 2]>> = vec![vec![]];
    for point in chosen {
        let here = points.at(*point);
        all = all.iter().flat_map(|set| here.iter().map(|e| set.iter().copied().chain([*e]).collect())).collect();
    }
    all.retain(|set| {
        (5..members.len()).all(|s| members[s] + set.iter().flatten().filter(|e| usize::from(**e) == s).count() >= 2)
    });
    all
}

type Found<'a> = (&'a HybridWish, &'a Layout, &'a [Rational], &'a [[u8; 2]]);

fn design(
    (wish, layout, ratios, clutches): Found<'_>,
    same: usize,
    modes: &[(&[usize], ModeKind, Vec<bool>)],
) -> HybridDesign {
    const ENDS: [&str; 5] = ["engine", "output", "housing", "A", "B"];
    let mut names = super::scheme::shaft_names(layout);
    for (name, own) in names.iter_mut().zip(ENDS) {
        *name = own.to_owned();
    }
    let modes = modes.iter().filter(|(_, kind, _)| *kind != ModeKind::Nothing).map(|(set, kind, turning)| {
        let closed: Vec<[u8; 2]> = set.iter().map(|k| clutches[*k]).collect();
        let ratio = |more: &[[u8; 2]]| {
            let closed: Vec<[u8; 2]> = closed.iter().chain(more).copied().collect();
            Some(motion::speeds(layout, ratios, &closed)?[1].recip())
        };
        let splits = [ModeKind::InputSplit, ModeKind::OutputSplit, ModeKind::CompoundSplit];
        let rest = MOTORS.iter().filter(|_| splits.contains(kind)).filter_map(|m| ratio(&[[GROUND, *m]]));
        let is_fixed = matches!(kind, ModeKind::Fixed | ModeKind::FixedWithMotor);
        let turning = TERMINALS.iter().zip(turning).filter(|(_, turns)| **turns);
        HybridMode {
            kind: *kind,
            closed: set.iter().map(|k| format!("C{}", k + 1)).collect(),
            turning: turning.map(|(t, _)| ENDS[usize::from(*t)].to_owned()).collect(),
            mechanical_points: rest.collect(),
            ratio: is_fixed.then(|| ratio(&[])).flatten(),
        }
    });
    let modes = modes.collect();
    let digits = clutches.iter().map(|e| e.map(shaft_digit).into_iter().collect::<String>());
    HybridDesign {
        id: std::iter::once(layout.to_string()).chain(digits).collect::<Vec<_>>().join(" "),
        layout: layout.to_string(),
        sets: wish.sets.clone(),
        clutches: clutches.iter().map(|e| e.map(|s| names[usize::from(s)].clone())).collect(),
        shafts: names,
        same,
        modes,
    }
}
