//! Laws: formulas from the literature that give one number (a coefficient of friction, a film
//! thickness, a torque, a power) for one physical state.
//!
//! A *family* is a set of laws that answer the same question and can be exchanged: one state in,
//! one number out, one file a law, one line to register it. A law states its formula, symbols,
//! range, source and a number worked by hand inside that range; outside it a warning is attached, nothing is
//! clamped silently. Laws never know a train: [`crate::operating_point`] asks them.
//!
//! All quantities are SI; a law that is written in other units converts inside its own function.
//! Laws are generic over [`Real`](crate::Real), so that derivatives come with the value.

use crate::diagnostic::{Code, Diagnostic};

/// What every law says about itself. The list of laws, the documentation, the range warnings and
/// the choice by name read this and nothing else.
#[derive(Debug)]
pub struct LawInfo<S: 'static> {
    /// Name in files and on the command line, `schlenk`.
    pub id: &'static str,
    /// Whose it is, as readers say it: `Schlenk`, `Dowson–Higginson`; empty where it goes by what it does.
    pub by: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// Key in `data/references.bib`, and the place in that work.
    pub source: (&'static str, &'static str),
    /// How far the formula and its constants were checked.
    pub trust: Trust,
    /// What a caller must know to use it rightly.
    pub tags: &'static [Tag],
    /// Where the source claims validity.
    pub valid: &'static [ValidityRange<S>],
}

impl<S> LawInfo<S> {
    /// Quantities of a state that lie outside the range of the source.
    pub fn outside(&self, state: &S) -> Vec<OutsideValidity> {
        let of = |r: &ValidityRange<S>| OutsideValidity {
            symbol: r.symbol,
            unit: r.unit,
            value: (r.get)(state),
            range: (r.min, r.max),
        };
        self.valid.iter().map(of).filter(|o| !(o.range.0..=o.range.1).contains(&o.value)).collect()
    }
}

/// What a caller must know to use a law rightly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tag {
    /// A law of tooth friction for one point of the path of contact, to be averaged along it.
    Local,
    /// A law of tooth friction that contains sliding only: rolling losses are to be added.
    SlidingOnly,
    /// An estimate of an engineer's hand, good to about half its value.
    Estimate,
    /// Reproduces a published number that follows from an error; never the default.
    Compatibility,
    /// A law of tooth friction that belongs with the loss factor of its name and takes no other.
    OwnLossFactor,
    /// A law of tooth friction that reads neither the oil nor its film; every other has no value without an oil.
    WithoutOil,
    /// A law of tooth friction that reads the film or its ratio to the roughness; to all others they are zero.
    Film,
}

impl Tag {
    /// The same in a few words, for lists.
    pub fn words(self) -> &'static str {
        match self {
            Self::Local => "local, averaged along the path",
            Self::SlidingOnly => "sliding only, rolling is added",
            Self::Estimate => "estimate ±50 %",
            Self::Compatibility => "reproduces a published error",
            Self::OwnLossFactor => "with its own loss factor",
            Self::WithoutOil => "needs no oil",
            Self::Film => "reads the film",
        }
    }
}

/// How far a formula and its constants were checked against their source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trust {
    /// Formula and constants were seen in a publication, manual or program.
    Seen,
    /// Derived, and checked numerically.
    Derived,
    /// Named constants stand as recalled and are to be confirmed in the source; the text says which.
    Confirm(&'static str),
}

/// One bound quantity of a validity range, SI.
#[derive(Debug)]
pub struct ValidityRange<S: 'static> {
    /// Symbol, as in the law's table of symbols.
    pub symbol: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Lowest value.
    pub min: f64,
    /// Highest value.
    pub max: f64,
    /// Reads it from the state.
    pub get: fn(&S) -> f64,
}

/// A quantity that lies outside the range of a law.
#[derive(Clone, Debug, PartialEq)]
pub struct OutsideValidity {
    /// Its symbol.
    pub symbol: &'static str,
    /// Its SI unit.
    pub unit: &'static str,
    /// Its value, SI.
    pub value: f64,
    /// The range of the source.
    pub range: (f64, f64),
}

/// A law as lists show it.
#[derive(Clone, Debug)]
pub struct LawSummary {
    /// Name of the family, `mesh_friction`.
    pub family: &'static str,
    /// What the family gives: symbol and SI unit.
    pub gives: (&'static str, &'static str),
    /// Name of the law.
    pub id: &'static str,
    /// Whose it is, as readers say it: `Schlenk`, `Dowson–Higginson`; empty where it goes by what it does.
    pub by: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// Key in the list of references, and the place in that work.
    pub source: (&'static str, &'static str),
    /// How far it was checked.
    pub trust: Trust,
    /// What a user must know of it.
    pub tags: &'static [Tag],
    /// Range of validity: symbol, unit, lowest, highest value (SI).
    pub valid: Vec<(&'static str, &'static str, f64, f64)>,
    /// Whether it is the one used when nothing is chosen.
    pub default: bool,
}

/// Declares a family of interchangeable laws: one state in, one number out, one file per law.
/// The first law is the default.
macro_rules! family {
    (
        $(#[$doc:meta])* $family:ident ($name:literal): $state:ident => $symbol:literal [$unit:literal];
        $($module:ident::$law:ident),+ $(,)?
    ) => {
        $(mod $module; pub use $module::$law;)+

        /// A law of this family.
        pub trait Law {
            /// Its description.
            const META: crate::losses::LawInfo<$state<f64>>;
            #[doc = concat!("`", $symbol, "`, ", $unit)]
            fn eval<D: crate::Real>(&self, state: &$state<D>) -> D;
            /// Quantities that lie outside the range of the source.
            fn outside(&self, state: &$state<f64>) -> Vec<crate::losses::OutsideValidity> {
                Self::META.outside(state)
            }
        }

        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(missing_docs)]
        #[non_exhaustive]
        pub enum $family { $($law($law)),+ }

        impl $family {
            /// Name of the family in files and on the command line.
            pub const FAMILY: &'static str = $name;
            /// Symbol and SI unit of what every law of the family returns.
            pub const GIVES: (&'static str, &'static str) = ($symbol, $unit);
            /// Every law with its default coefficients, in the order shown to people; the first
            /// is the default.
            pub const ALL: &'static [Self] = &[$(Self::$law($law::DEFAULT)),+];
            /// Source text of every law, for the test that reads their docs.
            #[doc(hidden)]
            pub const SOURCES: &'static [(&'static str, &'static str)] =
                &[$((stringify!($law), include_str!(concat!($name, "/", stringify!($module), ".rs")))),+];

            #[doc = concat!("`", $symbol, "`, ", $unit)]
            pub fn eval<D: crate::Real>(&self, state: &$state<D>) -> D {
                match self { $(Self::$law(law) => law.eval(state)),+ }
            }
            /// Its description.
            pub fn meta(&self) -> &'static crate::losses::LawInfo<$state<f64>> {
                match self { $(Self::$law(_) => const { &<$law as Law>::META }),+ }
            }
            /// The law of that name, with its default coefficients.
            pub fn named(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|l| l.meta().id == id)
            }
            /// Quantities that lie outside the range of the source.
            pub fn outside(&self, state: &$state<f64>) -> Vec<crate::losses::OutsideValidity> {
                self.meta().outside(state)
            }
            /// Every law as lists show it.
            pub fn entries() -> Vec<crate::losses::LawSummary> {
                Self::ALL.iter().enumerate().map(|(k, l)| {
                    let m = l.meta();
                    crate::losses::LawSummary {
                        family: Self::FAMILY, gives: Self::GIVES, id: m.id, by: m.by, title: m.title, source: m.source,
                        trust: m.trust, tags: m.tags, default: k == 0,
                        valid: m.valid.iter().map(|r| (r.symbol, r.unit, r.min, r.max)).collect(),
                    }
                }).collect()
            }
        }

        impl Default for $family {
            fn default() -> Self {
                Self::ALL[0]
            }
        }
    };
}

pub mod bearing;
pub mod churning;
pub mod clutch_drag;
pub mod film;
pub mod film_reduction;
pub mod injection;
mod list;
pub mod load_sharing;
pub mod loss_factor;
pub mod mesh_friction;
pub mod plain_bearing;
pub mod pump;
pub mod rolling;
pub mod rotor_drag;
pub mod seal;
pub mod windage;

pub use list::{Bounds, Checked, LawList, LawReport, Symbol, list};

/// The laws in force, one of each family.
macro_rules! laws {
    ($($(#[$doc:meta])* $name:ident: $family:ty;)+) => {
        /// The laws in force, one of each family.
        #[derive(Clone, Copy, Debug, Default, PartialEq)]
        pub struct Laws {
            /// Tooth friction; `None`: the default with an oil, `constant` without.
            pub mesh_friction: Option<mesh_friction::MeshFriction>,
            /// The coefficient of the law `constant`, where given.
            pub friction_coefficient: Option<f64>,
            /// Rolling losses; `None`: the default with friction laws that lack them.
            pub rolling: Option<rolling::Rolling>,
            $($(#[$doc])* pub $name: $family,)+
        }

        /// Every family, in the order of the pipeline.
        pub const FAMILIES: &[&str] = &["mesh_friction", "rolling", $(stringify!($name)),+];

        /// All laws of all families, in that order.
        pub fn entries() -> Vec<LawSummary> {
            let mut all = mesh_friction::MeshFriction::entries();
            all.extend(rolling::Rolling::entries());
            $(all.extend(<$family>::entries());)+
            all
        }

        impl Laws {
            /// Puts a law into force by name.
            ///
            /// # Errors
            /// If there is no such family or law; with what there is.
            ///
            /// # Example
            /// ```
            /// let mut laws = willis::losses::Laws::default();
            /// assert!(laws.choose("bearing", "palmgren").is_ok());
            /// let wrong = laws.choose("bearing", "plamgren").unwrap_err();
            /// assert!(wrong.hints[0].contains("palmgren"));
            /// ```
            pub fn choose(&mut self, family: &str, law: &str) -> Result<(), Box<Diagnostic>> {
                let unknown = |known: Vec<&str>, what: String, name: &str, list: &str| {
                    let mut d = Diagnostic::new(Code::UnknownName, "laws", what).suggest(name, known.iter().copied());
                    d = d.hint(format!("{list}: {}", known.join(", ")));
                    Box::new(d)
                };
                let no_law = |family: &str, entries: Vec<LawSummary>| {
                    let known = entries.iter().map(|e| e.id).collect();
                    let what = format!("the family `{family}` has no law `{}`", short(law));
                    unknown(known, what, law, "its laws are")
                };
                match family {
                    "mesh_friction" => {
                        let found = mesh_friction::MeshFriction::named(law);
                        let none = || no_law(family, mesh_friction::MeshFriction::entries());
                        self.mesh_friction = Some(found.ok_or_else(none)?);
                    }
                    "rolling" => {
                        let found = rolling::Rolling::named(law);
                        self.rolling = Some(found.ok_or_else(|| no_law(family, rolling::Rolling::entries()))?);
                    }
                    $(stringify!($name) => {
                        self.$name = <$family>::named(law).ok_or_else(|| no_law(family, <$family>::entries()))?;
                    })+
                    _ => {
                        let what = format!("there is no family of laws `{}`", short(family));
                        return Err(unknown(FAMILIES.to_vec(), what, family, "the families are"));
                    }
                }
                // The sharing that is chosen is the one that is integrated.
                if let loss_factor::LossFactor::Integrated(integrated) = &mut self.loss_factor {
                    integrated.sharing = self.load_sharing;
                }
                Ok(())
            }
        }
    };
}

/// A name for a message.
fn short(name: &str) -> String {
    name.chars().filter(|c| crate::diagnostic::is_printable(*c)).take(64).collect()
}

laws! {
    /// Loss factor of a mesh.
    loss_factor: loss_factor::LossFactor;
    /// Sharing of the load between tooth pairs.
    load_sharing: load_sharing::LoadSharing;
    /// Thickness of the oil film.
    film: film::Film;
    /// Thermal reduction of the film.
    film_reduction: film_reduction::FilmReduction;
    /// Friction of rolling bearings.
    bearing: bearing::BearingTorque;
    /// Gears in air.
    windage: windage::Windage;
    /// Gears in the sump.
    churning: churning::Churning;
    /// Lip seals.
    seal: seal::SealLoss;
    /// Carriers and drums.
    rotor_drag: rotor_drag::RotorDrag;
    /// Open multi-plate clutches and brakes.
    clutch_drag: clutch_drag::ClutchDrag;
    /// Oil pumps.
    pump: pump::PumpTorque;
    /// Oil that is sprayed at meshes.
    injection: injection::InjectionLoss;
    /// Plain bearings.
    plain_bearing: plain_bearing::PlainBearing;
}

impl Laws {
    /// The friction law in force, with an oil or without.
    pub fn mesh_friction(&self, oil: bool) -> mesh_friction::MeshFriction {
        use mesh_friction::{Constant, MeshFriction};
        let constant = || Constant { mu: self.friction_coefficient.unwrap_or(Constant::DEFAULT.mu) };
        match self.mesh_friction {
            Some(MeshFriction::Constant(_)) => MeshFriction::Constant(constant()),
            Some(law) => law,
            None if oil => MeshFriction::default(),
            None => MeshFriction::Constant(constant()),
        }
    }

    /// The loss factor in force beside a friction law: its own where it has one, else the one that is chosen.
    pub fn loss_factor(&self, friction: &mesh_friction::MeshFriction) -> loss_factor::LossFactor {
        let own = || loss_factor::LossFactor::named(friction.meta().id);
        let has_own = friction.meta().tags.contains(&Tag::OwnLossFactor);
        has_own.then(own).flatten().unwrap_or(self.loss_factor)
    }

    /// A chosen law that needs an oil, for a train that has none.
    pub(crate) fn without_oil(&self) -> Option<Diagnostic> {
        let friction = self.mesh_friction.filter(|l| l.needs_oil()).map(|l| ("mesh_friction", l.meta().id));
        let rolling = self.rolling.map(|l| ("rolling", l.meta().id)).filter(|l| l.1 != "none");
        let (family, law) = friction.or(rolling)?;
        let message = format!("{family} = {law} depends on an oil, and none is given");
        let d = Diagnostic::new(Code::MissingKey, format!("laws.{family}"), message);
        Some(d.hint("add [oil] with a name of the catalogue or its viscosities, or choose `constant` friction"))
    }

    /// The rolling law in force beside a friction law; `None` where that contains the rolling loss.
    pub fn rolling(&self, friction: &mesh_friction::MeshFriction) -> Option<rolling::Rolling> {
        let lacks_it = friction.meta().tags.contains(&Tag::SlidingOnly);
        self.rolling.or(lacks_it.then(rolling::Rolling::default))
    }
}
