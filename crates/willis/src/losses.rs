//! Laws: formulas from the literature that give one number (a coefficient of friction, a film
//! thickness, a torque, a power) for one physical state.
//!
//! A *family* is a set of laws that answer the same question and can be exchanged: one state in,
//! one number out, one file a law, one line to register it. A law states its formula, symbols,
//! range, source and a number worked by hand; outside its range a warning is attached, nothing is
//! clamped silently. Laws never know a train: [`crate::operating_point`] asks them.
//!
//! All quantities are SI; a law that is written in other units converts inside its own function.
//! Laws are generic over [`Real`](crate::Real), so that derivatives come with the value.

/// What every law says about itself. The list of laws, the documentation, the range warnings and
/// the choice by name read this and nothing else.
#[derive(Debug)]
pub struct Meta<S: 'static> {
    /// Name in files and on the command line, `schlenk`.
    pub id: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// Key in `data/references.bib`, and the place in that work.
    pub source: (&'static str, &'static str),
    /// How far the formula and its constants were checked.
    pub trust: Trust,
    /// What a caller must know to use it rightly.
    pub tags: &'static [Tag],
    /// Where the source claims validity.
    pub valid: &'static [Range<S>],
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
pub struct Range<S: 'static> {
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
pub struct Outside {
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
pub struct Entry {
    /// Name of the family, `mesh_friction`.
    pub family: &'static str,
    /// What the family gives: symbol and SI unit.
    pub gives: (&'static str, &'static str),
    /// Name of the law.
    pub id: &'static str,
    /// Title for people.
    pub title: &'static str,
    /// Key in the list of references, and the place in that work.
    pub source: (&'static str, &'static str),
    /// How far it was checked.
    pub trust: Trust,
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
            const META: crate::losses::Meta<$state<f64>>;
            #[doc = concat!("`", $symbol, "`, ", $unit)]
            fn eval<D: crate::Real>(&self, state: &$state<D>) -> D;
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
            pub fn meta(&self) -> &'static crate::losses::Meta<$state<f64>> {
                match self { $(Self::$law(_) => const { &<$law as Law>::META }),+ }
            }
            /// The law of that name, with its default coefficients.
            pub fn named(id: &str) -> Option<Self> {
                Self::ALL.iter().copied().find(|l| l.meta().id == id)
            }
            /// Quantities that lie outside the range of the source.
            pub fn outside(&self, state: &$state<f64>) -> Vec<crate::losses::Outside> {
                self.meta().valid.iter()
                    .map(|r| crate::losses::Outside {
                        symbol: r.symbol, unit: r.unit, value: (r.get)(state), range: (r.min, r.max),
                    })
                    .filter(|o| !(o.range.0..=o.range.1).contains(&o.value))
                    .collect()
            }
            /// Every law as lists show it.
            pub fn entries() -> Vec<crate::losses::Entry> {
                Self::ALL.iter().enumerate().map(|(k, l)| {
                    let m = l.meta();
                    crate::losses::Entry {
                        family: Self::FAMILY, gives: Self::GIVES, id: m.id, title: m.title, source: m.source,
                        trust: m.trust, default: k == 0,
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
pub mod film;
pub mod film_reduction;
pub mod load_sharing;
pub mod loss_factor;
pub mod mesh_friction;
pub mod rolling;
pub mod rotor_drag;
pub mod seal;
pub mod windage;

/// All laws of all families, families in the order of the pipeline.
pub fn entries() -> Vec<Entry> {
    let mut all = Vec::new();
    all.extend(film::Film::entries());
    all.extend(film_reduction::FilmReduction::entries());
    all.extend(mesh_friction::MeshFriction::entries());
    all.extend(rolling::Rolling::entries());
    all
}
