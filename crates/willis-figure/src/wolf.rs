//! Wolf's symbols: every set a box with its shafts, whatever is inside, and how shafts of several sets are coupled.
//!
//! Of the three torques of a set one is the sum of the other two, with the other sign: that of the *sum shaft*, whose line is
//! double. Which shaft it is follows from the basic ratio alone, and with it what a coupling of sets can do.
//!
//! Source: A. Wolf, Die Grundgesetze der Umlaufgetriebe, Braunschweig 1958; VDI 2157.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::train::{FRAME, MemberId, ShiftElementKind, Train};

use crate::kind::{self, Ask, Kind};
use crate::lever::LeverRole;
use crate::lever::family::{Family, families};

pub(crate) const KIND: Kind<Wolf> = Kind {
    title: "Wolf diagram",
    takes: &[Ask::State],
    effort: kind::of_file,
    applies: None,
    make: |s, r| wolf(s.train(), r.state.as_deref()),
    steps: None,
    draw: |data, _| draw::draw(data),
};

/// A train as Wolf's symbols.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Wolf {
    /// The train.
    pub title: String,
    /// The state whose shift elements are closed.
    pub state: Option<String>,
    /// Members with a shaft in a set, a shift element or a variator, in the order of the train; without the frame.
    pub members: Vec<WolfMember>,
    /// The boxes.
    pub sets: Vec<WolfSet>,
    /// Shift elements.
    pub ties: Vec<WolfTie>,
    /// Variators: the second paths of a power split.
    #[serde(default)]
    pub variators: Vec<WolfVariator>,
}

/// A member.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WolfMember {
    /// Its name.
    pub name: String,
    /// Number of its colour: its place in the train.
    pub colour: usize,
    /// Power from outside may enter or leave here.
    pub terminal: bool,
}

/// Planets on one carrier with their central gears, or a pair of gears.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WolfSet {
    /// Its name.
    pub name: String,
    /// Its shafts, the carrier last.
    pub shafts: Vec<WolfShaft>,
    /// Speed of the first over that of the second shaft, relative to the carrier, as a fraction; of sets with three shafts.
    pub basic_ratio: Option<String>,
}

/// A shaft of a set.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WolfShaft {
    /// Position in [`Wolf::members`]; absent for the frame.
    pub member: Option<usize>,
    /// What it is in the set.
    pub role: LeverRole,
    /// Its torque is the sum of the other two, with the other sign, when losses are left out.
    pub sum: bool,
}

/// A shift element between two members, or a member and the frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WolfTie {
    /// Its name.
    pub name: String,
    /// Positions in [`Wolf::members`]; absent for the frame.
    pub members: [Option<usize>; 2],
    /// It locks in one direction only.
    pub one_way: bool,
    /// It is closed in the state.
    pub engaged: bool,
}

/// A variator between members, directly or by machines on a bus.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WolfVariator {
    /// Its name.
    pub name: String,
    /// Positions in [`Wolf::members`].
    pub members: Vec<usize>,
}

/// The boxes of a train and how their shafts are coupled; with a state also what is closed in it.
///
/// # Errors
/// An unknown state; a train without gears.
///
/// # Example
/// ```
/// use willis_figure::wolf;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let set = &wolf(&train, None)?.sets[0];
/// assert_eq!(set.basic_ratio.as_deref(), Some("-7/3"));
/// // The carrier holds both gears.
/// assert!(set.shafts[2].sum);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn wolf(train: &Train, state: Option<&str>) -> Result<Wolf, Diagnostics> {
    let state = state.map(|name| train.find_state(name)).transpose()?;
    let families = families(train);
    if families.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "no boxes of this train: it has no gears");
        return Err(d.hint("a box is a set of gears on one carrier").into());
    }
    let mut used: Vec<MemberId> = families.iter().flat_map(|f| central(f).map(|p| p.0)).collect();
    used.extend(train.shift_elements().iter().flat_map(|e| e.members));
    used.extend(train.variators().iter().flat_map(|v| v.members()));
    used.retain(|m| *m != FRAME);
    used.sort_unstable();
    used.dedup();
    let place = |m: MemberId| used.iter().position(|u| *u == m);
    let members = used.iter().map(|m| WolfMember {
        name: train.member_name(*m).to_owned(),
        colour: m.index() - 1,
        terminal: train.terminals().contains(m),
    });
    let engaged = state.map_or(&[][..], |k| &train.states()[k].engaged);
    let ties = train.shift_elements().iter().enumerate().map(|(k, e)| WolfTie {
        name: e.name.clone(),
        members: e.members.map(place),
        one_way: e.kind == ShiftElementKind::OneWay,
        engaged: engaged.iter().any(|id| id.index() == k),
    });
    let variators = train
        .variators()
        .iter()
        .map(|v| WolfVariator { name: v.name.clone(), members: v.members().into_iter().filter_map(place).collect() });
    Ok(Wolf {
        title: train.name().to_owned(),
        state: state.map(|k| train.states()[k].name.clone()),
        members: members.collect(),
        sets: families.iter().map(|f| set(f, &place)).collect(),
        ties: ties.collect(),
        variators: variators.collect(),
    })
}

/// Shafts that leave a set: its central gears with their numbers, and the carrier at zero.
fn central(f: &Family) -> impl Iterator<Item = (MemberId, Rational, LeverRole)> {
    let gears = f.points.iter().filter(|p| p.role != LeverRole::Planet).map(|p| (p.member, p.number.clone(), p.role));
    gears.chain([(f.carrier, Rational::ZERO, LeverRole::Carrier)])
}

fn set(f: &Family, place: &dyn Fn(MemberId) -> Option<usize>) -> WolfSet {
    let all: Vec<_> = central(f).collect();
    // Forces on a lever: T₁ : T₂ : T_c = N₂ : −N₁ : N₁ − N₂.
    let (basic_ratio, sum) = match &all[..] {
        [a, b, _] if !b.1.is_zero() => {
            let torques = [b.1.clone(), a.1.clone(), &a.1 - &b.1].map(|t| t.abs());
            let largest = (0..3).find(|&k| torques[k] == &torques[(k + 1) % 3] + &torques[(k + 2) % 3]);
            (Some((&a.1 / &b.1).to_fraction().trim_end_matches("/1").to_owned()), largest)
        }
        _ => (None, None),
    };
    let shaft = |(k, (member, _, role)): (usize, &(MemberId, Rational, LeverRole))| WolfShaft {
        member: place(*member),
        role: *role,
        sum: sum == Some(k),
    };
    WolfSet { name: f.name.clone(), shafts: all.iter().enumerate().map(shaft).collect(), basic_ratio }
}
