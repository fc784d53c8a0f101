//! Why a load case has the verdict it has: data, with the sentence for people in one place.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Code;

use super::words::short;

/// What explains a verdict.
///
/// In answers for machines `kind` names it, and the rest is its numbers and names; shown, it is the sentence that
/// stands beside it as `reason`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Why {
    /// The ratio is a fraction that floating point cannot hold.
    RatioTooLarge,
    /// The output stands still while the input turns.
    OutputAtRest {
        /// The output.
        output: String,
        /// The input.
        input: String,
    },
    /// The closed shift elements leave no freedom.
    NothingTurns {
        /// The closed shift elements.
        engaged: Vec<String>,
    },
    /// The train turns, the input does not.
    InputLocked {
        /// The input.
        input: String,
        /// The closed shift elements.
        engaged: Vec<String>,
        /// All members that cannot turn.
        locked: Vec<String>,
    },
    /// The speed of the input does not settle that of the output.
    SpeedNotSettled {
        /// Degrees of freedom.
        freedoms: usize,
        /// The input.
        input: String,
        /// The output.
        output: String,
        /// Members whose speeds are open.
        open: Vec<String>,
    },
    /// A member cannot turn.
    CannotTurn {
        /// The member.
        member: String,
    },
    /// Speeds are not determined.
    SpeedsNotDetermined,
    /// The speed of one end does not move the other.
    CannotDrive {
        /// Where power would enter.
        from: String,
        /// Where it would leave.
        to: String,
    },
    /// A one-way clutch would have to hold against its free direction.
    Overruns {
        /// The one-way clutch.
        clutch: String,
    },
    /// A one-way clutch would have to hold this torque against its free direction.
    CannotHold {
        /// The one-way clutch.
        clutch: String,
        /// Its first member, on which the torque would act.
        member: String,
        /// Torque, N m.
        torque_n_m: f64,
    },
    /// A one-way clutch that is open would turn in the direction that it blocks.
    WouldLock {
        /// The one-way clutch.
        clutch: String,
        /// What it joins.
        members: [String; 2],
        /// Speed of the first relative to the second, rad/s.
        speed_rad_s: f64,
    },
    /// More terminals must carry a load.
    LoadMissing,
    /// A freedom is left over, so nothing carries the load.
    LoadNotCarried,
    /// Equilibrium does not determine all forces.
    Indeterminate,
    /// Equilibrium does not determine the tooth forces, although no mesh is redundant.
    ForcesNotFixed,
    /// Meshes constrain each other.
    RedundantMeshes {
        /// Groups of meshes that do.
        groups: Vec<Vec<String>>,
    },
    /// A loaded mesh has no determined relative speed.
    RelativeSpeedNotDetermined,
    /// Brakes, clutches and held members take every freedom.
    NoFreedom,
    /// The prescribed speeds leave others open.
    TooFewSpeeds {
        /// Degrees of freedom.
        freedoms: usize,
        /// How many of them the prescribed speeds settle.
        settled: usize,
        /// Members whose speeds are open.
        open: Vec<String>,
    },
    /// What is to balance the load stands still.
    BalancerAtRest {
        /// The terminals that were left open.
        members: Vec<String>,
    },
    /// No torque and no power acts.
    Unloaded,
    /// Losses and torques were not brought into agreement.
    NotConverged,
    /// Too many meshes act on each other to count the equilibria.
    TooManyMeshes,
    /// The same, and none was found.
    NoneFound,
    /// The same, and there may be others than those found.
    PerhapsMore,
    /// Friction lets one end drive no load at the other.
    FrictionLocks {
        /// Where power would enter.
        from: String,
        /// Where it would leave.
        to: String,
    },
    /// Friction leaves no equilibrium for this load.
    NoEquilibrium,
    /// The train moves only when every loaded member is driven.
    OnlyDissipates,
    /// The load lies on a self-locking threshold, where a whole range of torques balances it.
    Threshold {
        /// The range on each terminal that balances the load, as far as it is known.
        #[serde(default, skip_serializing_if = "Vec::is_empty")]
        ranges: Vec<TorqueRange>,
    },
    /// Several equilibria carry one load through a state.
    Several,
    /// Several equilibria carry the load of an operating point.
    Equilibria {
        /// Their efficiencies: 0 where everything is dissipated, absent where nothing is loaded.
        efficiencies: Vec<Option<f64>>,
    },
    /// The losses take all power that enters.
    LossesTakeAll,
    /// Every loaded member puts power in.
    AllPutIn {
        /// These members.
        inputs: Vec<String>,
    },
}

/// Torques on a terminal that all balance one load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TorqueRange {
    /// The terminal.
    pub member: String,
    /// Least torque, N m; absent where there is none.
    pub low_n_m: Option<f64>,
    /// Greatest torque, N m; absent where there is none.
    pub high_n_m: Option<f64>,
}

impl fmt::Display for TorqueRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let n_m = |t: f64| if t == 0.0 { "0 N m".to_owned() } else { format!("{} N m", short(t)) };
        match (self.low_n_m, self.high_n_m) {
            (Some(low), Some(high)) => write!(f, "{} from {} to {}", self.member, n_m(low), n_m(high)),
            (Some(low), None) => write!(f, "{} from {} up without end", self.member, n_m(low)),
            (None, Some(high)) => write!(f, "{} from {} down without end", self.member, n_m(high)),
            (None, None) => write!(f, "{} any torque", self.member),
        }
    }
}

impl Why {
    /// The diagnostic that an operating point with this explanation carries, and what to do about it.
    pub(super) fn warning(&self) -> Option<(Code, Option<String>)> {
        let hint = |text: &str| Some(text.to_owned());
        Some(match self {
            Self::NoFreedom => (Code::KinematicallyLocked, hint("release one of them")),
            Self::TooFewSpeeds { freedoms, settled, .. } => {
                let text = match freedoms - settled {
                    1 => "give one more speed, or hold one member".to_owned(),
                    n => format!("give {n} more speeds, or hold {n} members"),
                };
                (Code::Undetermined, Some(text))
            }
            Self::BalancerAtRest { .. } => (Code::Undetermined, hint("leave open a terminal that turns")),
            Self::ForcesNotFixed | Self::RedundantMeshes { .. } => {
                (Code::Indeterminate, hint("remove a mesh, or release a held member"))
            }
            Self::LoadMissing
            | Self::LoadNotCarried
            | Self::Indeterminate
            | Self::SpeedsNotDetermined
            | Self::RelativeSpeedNotDetermined => (Code::Undetermined, None),
            Self::TooManyMeshes => (Code::NotEnumerated, None),
            Self::NotConverged => {
                (Code::NotConverged, hint("the train is close to locking, or a law is far outside its range"))
            }
            Self::NoEquilibrium | Self::OnlyDissipates => {
                (Code::SelfLocking, hint("higher mesh efficiency, or a basic ratio farther from 1, frees it"))
            }
            Self::Threshold { .. } | Self::Equilibria { .. } => (
                Code::SeveralSolutions,
                hint("a rigid quasi-static model cannot choose between them; better mesh efficiency makes it unique"),
            ),
            Self::LossesTakeAll | Self::AllPutIn { .. } => (Code::AllDissipated, None),
            Self::CannotHold { .. } => {
                (Code::OneWay, hint("analyse the state without it, or engage a brake beside it"))
            }
            Self::WouldLock { .. } => {
                (Code::OneWay, hint("engage it in this state, or check which direction it blocks"))
            }
            _ => return None,
        })
    }
}

impl fmt::Display for Why {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let with = |engaged: &[String]| match engaged {
            [] => String::new(),
            some => format!(" with {} engaged", some.join(", ")),
        };
        match self {
            Self::RatioTooLarge => f.write_str("the ratio is beyond floating point"),
            Self::OutputAtRest { output, input } => write!(f, "{output} stands still while {input} turns"),
            Self::NothingTurns { engaged } => f.write_str(&match engaged[..] {
                [] => "nothing can turn: the gears hold each other".to_owned(),
                _ => format!("nothing can turn{}; release a shift element", with(engaged)),
            }),
            Self::InputLocked { input, engaged, locked } => {
                write!(f, "{input} cannot turn{}; locked: {}", with(engaged), locked.join(", "))
            }
            Self::SpeedNotSettled { freedoms, input, output, open } => write!(
                f,
                "{freedoms} degrees of freedom: the speed of {input} does not settle that of {output} (open: {}); hold \
                 one member, or prescribe {freedoms} speeds in an [[operation]]",
                open.join(", ")
            ),
            Self::CannotTurn { member } => write!(f, "{member} cannot turn"),
            Self::SpeedsNotDetermined => f.write_str("the speeds are not determined"),
            Self::CannotDrive { from, to } => write!(f, "{from} cannot drive {to}"),
            Self::Overruns { clutch } => {
                write!(f, "the one-way clutch {clutch} overruns: no load is carried this way")
            }
            Self::CannotHold { clutch, member, torque_n_m } => write!(
                f,
                "the one-way clutch {clutch} would have to hold {member} against its free direction ({} N m); it \
                 overruns instead and the torques shown do not arise",
                short(*torque_n_m)
            ),
            Self::WouldLock { clutch, members: [first, second], speed_rad_s } => write!(
                f,
                "{first} would turn at {} rpm relative to {second}, the direction that the one-way clutch {clutch} blocks; \
                 it locks instead and this motion does not arise",
                short(speed_rad_s * 30.0 / std::f64::consts::PI)
            ),
            Self::LoadMissing => f.write_str("a load is missing"),
            Self::LoadNotCarried => f.write_str("a freedom is left over: the load is not carried"),
            Self::Indeterminate => f.write_str("statically indeterminate"),
            Self::ForcesNotFixed => f.write_str("statically indeterminate: equilibrium does not fix the tooth forces"),
            Self::RedundantMeshes { groups } => {
                let groups: Vec<String> = groups.iter().map(|g| g.join(", ")).collect();
                write!(f, "statically indeterminate: the meshes {} constrain each other", groups.join("; "))
            }
            Self::RelativeSpeedNotDetermined => f.write_str("a loaded mesh has no determined relative speed"),
            Self::NoFreedom => {
                f.write_str("nothing can turn: every freedom is taken by brakes, clutches and held members")
            }
            Self::TooFewSpeeds { freedoms, settled, open } => write!(
                f,
                "{}, {settled} settled by the prescribed speeds: no determined speed for {}",
                super::words::freedoms(*freedoms),
                open.join(", ")
            ),
            Self::BalancerAtRest { members } => write!(
                f,
                "{} stands still in this motion and can take no power, so nothing balances the load",
                members.join(", ")
            ),
            Self::Unloaded => f.write_str("no torque or power reaches a gear that can turn"),
            Self::NotConverged => {
                f.write_str("losses and torques were not brought into agreement: what is shown is the last step")
            }
            Self::TooManyMeshes => f.write_str("too many interacting meshes to decide how many equilibria there are"),
            Self::NoneFound => {
                f.write_str("too many interacting meshes: no equilibrium was found, and none is excluded")
            }
            Self::PerhapsMore => {
                f.write_str("too many interacting meshes: the equilibrium shown may not be the only one")
            }
            Self::FrictionLocks { from, to } => write!(f, "friction lets {from} drive no load at {to}"),
            Self::NoEquilibrium => {
                f.write_str("friction locks the train: no equilibrium exists for this load in this motion")
            }
            Self::OnlyDissipates => f.write_str(
                "friction locks the train: it moves this way only when every loaded member is driven, and all of that \
                 power is dissipated",
            ),
            Self::Threshold { ranges } => {
                f.write_str("the load lies on a self-locking threshold: a whole range of torques balances it")?;
                let each: Vec<String> = ranges.iter().map(ToString::to_string).collect();
                if each.is_empty() { Ok(()) } else { write!(f, ", {}", each.join("; ")) }
            }
            Self::Several => f.write_str("several equilibria carry the same load"),
            Self::Equilibria { efficiencies } => {
                let each = efficiencies.iter().map(|e| match e {
                    Some(e) if *e > 0.0 => format!("{e:.4}"),
                    Some(_) => "all dissipated".to_owned(),
                    None => "unloaded".to_owned(),
                });
                write!(
                    f,
                    "{} equilibria carry the same load, with efficiencies {}",
                    efficiencies.len(),
                    each.collect::<Vec<_>>().join(" and ")
                )
            }
            Self::LossesTakeAll => f.write_str("no power leaves: the losses take all that enters"),
            Self::AllPutIn { inputs } => {
                write!(f, "{} all put power in and none takes power out: everything is dissipated", inputs.join(", "))
            }
        }
    }
}
