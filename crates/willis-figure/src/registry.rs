//! All kinds of figures. A kind is a file, a folder and a line here; everything else follows from the line.

use serde::{Deserialize, Serialize};

use willis::analysis::ShaftTable;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::hypergraph::FlowReport;
use willis::model::Model;
use willis::work::{Effort, TooLong, Work};

use crate::kind::Detail;
use crate::*;

macro_rules! kinds {
    ($(#[doc = $about:literal] $name:literal: $kind:ident($data:ty) = $entry:expr;)*) => {
        /// What can be drawn.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[non_exhaustive]
        pub enum FigureKind {
            $(#[doc = $about] #[serde(rename = $name)] $kind,)*
        }

        /// A figure of any kind, as data.
        #[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
        #[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
        #[serde(tag = "figure")]
        #[non_exhaustive]
        pub enum Figure {
            $(#[doc = $about] #[serde(rename = $name)] $kind($data),)*
        }

        impl FigureKind {
            /// All kinds.
            pub const ALL: &[Self] = &[$(Self::$kind),*];

            /// The word for it on the command line.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$kind => $name,)*
                }
            }

            /// What it shows, as a sentence of a few words.
            ///
            /// ```
            /// use willis_figure::FigureKind;
            ///
            /// assert_eq!(FigureKind::Shift.about(), "The table of states with its steps.");
            /// ```
            pub fn about(self) -> &'static str {
                match self {
                    $(Self::$kind => $about.trim_ascii(),)*
                }
            }

            /// The heading of its pictures.
            pub fn title(self) -> &'static str {
                match self {
                    $(Self::$kind => $entry.title,)*
                }
            }

            /// The questions that make a difference to it.
            pub fn takes(self) -> &'static [Ask] {
                match self {
                    $(Self::$kind => $entry.takes,)*
                }
            }

            /// How much work it is to make the figure of a train.
            pub fn effort(self, model: &Model, request: &FigureRequest) -> Effort {
                match self {
                    $(Self::$kind => ($entry.effort)(model, request),)*
                }
            }

            /// Whether the figure of a train can be made, in little time: what takes long is not made to find out.
            fn applies(self, model: &Model) -> bool {
                match self {
                    $(Self::$kind => match $entry.applies {
                        Some(quick) => quick(model),
                        None => ($entry.make)(model, &FigureRequest::default()).is_ok(),
                    },)*
                }
            }

            /// Makes the figure of a train, however long it takes; see [`FigureKind::effort`].
            ///
            /// # Errors
            /// Why the kind does not apply to this train, and what would; no such state, operation or part.
            ///
            /// # Example
            /// ```
            /// use willis::model::Model;
            /// use willis_figure::{Figure, FigureKind};
            ///
            /// let text = r#"
            ///     format = 1
            ///     name = "one set"
            ///     members = ["s", "c"]
            ///     terminals = ["s", "c"]
            ///     [[set]]
            ///     name = "P1"
            ///     sun = { member = "s", teeth = 30 }
            ///     ring = { member = "frame", teeth = 70 }
            ///     carrier = "c"
            /// "#;
            /// let model = Model::from_toml(text).unwrap();
            /// let figure = FigureKind::Stick.make(&model, &Default::default())?;
            /// assert!(matches!(figure, Figure::Stick(_)));
            /// // There are no gears to shift.
            /// assert!(FigureKind::Shift.make(&model, &Default::default()).is_err());
            /// # Ok::<(), willis::Diagnostics>(())
            /// ```
            pub fn make(self, model: &Model, request: &FigureRequest) -> Result<Figure, Diagnostics> {
                match self {
                    $(Self::$kind => ($entry.make)(model, request).map(Figure::$kind),)*
                }
            }
        }

        impl FigureKind {
            /// Makes the figure of a train as [`FigureKind::make`] does, within work: kinds that take long stop soon after they are
            /// cancelled.
            ///
            /// # Errors
            /// What [`FigureKind::make`] says; the work was cancelled.
            pub fn make_within(
                self,
                model: &Model,
                request: &FigureRequest,
                work: &dyn Work,
            ) -> Result<Figure, Diagnostics> {
                match self {
                    $(Self::$kind => match $entry.steps {
                        Some(make) => make(model, request, work, Detail::Fine),
                        None => ($entry.make)(model, request),
                    }
                    .map(Figure::$kind),)*
                }
            }

            /// A coarser figure to show until [`FigureKind::make_within`] is done: fewer points, fewer samples. None for a kind
            /// that is made at once.
            ///
            /// # Errors
            /// What [`FigureKind::make_within`] says.
            ///
            /// # Example
            /// ```
            /// use willis::model::Model;
            /// use willis::work::Serial;
            /// use willis_figure::{Figure, FigureKind};
            ///
            /// let text = r#"
            ///     format = 1
            ///     name = "one set"
            ///     members = ["s", "c"]
            ///     terminals = ["s", "c"]
            ///     [[set]]
            ///     name = "P1"
            ///     sun = { member = "s", teeth = 30 }
            ///     ring = { member = "frame", teeth = 70 }
            ///     carrier = "c"
            ///     mesh_efficiency = 0.99
            ///     [[operation]]
            ///     name = "full load"
            ///     speeds = { s = "1000 rpm" }
            ///     torques = { s = "10 N m" }
            /// "#;
            /// let model = Model::from_toml(text).unwrap();
            /// let request = Default::default();
            /// let points = |figure: Figure| match figure {
            ///     Figure::Map(map) => map.points.len(),
            ///     _ => 0,
            /// };
            /// let coarse = FigureKind::Map.make_coarse(&model, &request, &Serial).unwrap()?;
            /// let fine = FigureKind::Map.make_within(&model, &request, &Serial)?;
            /// assert!(points(coarse) * 3 < points(fine));
            /// assert!(FigureKind::Stick.make_coarse(&model, &request, &Serial).is_none());
            /// # Ok::<(), willis::Diagnostics>(())
            /// ```
            pub fn make_coarse(
                self,
                model: &Model,
                request: &FigureRequest,
                work: &dyn Work,
            ) -> Option<Result<Figure, Diagnostics>> {
                match self {
                    $(Self::$kind => {
                        let make = $entry.steps?;
                        Some(make(model, request, work, Detail::Coarse).map(Figure::$kind))
                    })*
                }
            }
        }

        impl Figure {
            /// What kind it is.
            pub fn kind(&self) -> FigureKind {
                match self {
                    $(Self::$kind(_) => FigureKind::$kind,)*
                }
            }
        }

        /// A figure as SVG in its light form, text as text.
        pub fn draw(figure: &Figure, how: Drawing) -> String {
            match figure {
                $(Figure::$kind(data) => ($entry.draw)(data, how),)*
            }
        }
    };
}

// Name on the command line: kind(its data) = what its folder says of it. The comment is also the help.
kinds! {
    /// Kinematic schematic, engaged elements and power path of a state.
    "stick": Stick(Stick) = stick::KIND;
    /// Nomograph: speeds and torques; the state `all` lays all states over each other.
    "lever": Lever(Lever) = lever::KIND;
    /// Wolf's symbols: sets as boxes, their sum shafts, and how they are coupled.
    "wolf": Wolf(Wolf) = wolf::KIND;
    /// Power from input to output, each loss branching off, to scale.
    "sankey": Sankey(Sankey) = sankey::KIND;
    /// Power through components and contacts.
    "flow": Flow(FlowReport) = flow::KIND;
    /// A set seen along its axis, true teeth in mesh.
    "front": Front(Front) = front::KIND;
    /// The regime map of a train with two degrees of freedom.
    "regimes": Regimes(RegimeMap) = regimes::KIND;
    /// Efficiency over two quantities; of an automatic the best gear.
    "map": Map(EfficiencyMap) = map::KIND;
    /// A power split over its ratio: efficiency, share of the variator, powers of its machines.
    "split": Split(Split) = split::KIND;
    /// Losses by source, stacked over a quantity and as bars.
    "losses": Losses(LossChart) = losses::KIND;
    /// Losses without load of every gear, stacked by source.
    "spin": Spin(SpinLosses) = spin::KIND;
    /// Temperatures and heat between the places of a gearbox, the balance as two curves, the warm-up.
    "heat": Heat(HeatPicture) = heat::KIND;
    /// Oil film over roughness along the path of contact of a mesh.
    "film": Film(ContactPath) = contact_path::film::KIND;
    /// Friction, sliding and load along the path of contact of a mesh.
    "path": Path(ContactPath) = contact_path::path::KIND;
    /// Natural modes of vibration on the stick diagram: amplitude and sign of each member.
    "modes": Modes(Vibration) = vibration::KIND;
    /// A scenario over time.
    "time": Time(TimePlot) = time::KIND;
    /// The table of states with its steps.
    "shift": Shift(ShiftTable) = shift::KIND;
    /// Speed of every shaft, slip of every open shift element and all torques, in every state.
    "table": Table(ShaftTable) = table::KIND;
    /// What a step of each quantity does to efficiency and losses.
    "tornado": Tornado(Tornado) = tornado::KIND;
    /// How sure efficiency and loss are, over a quantity.
    "band": Band(Bands) = band::KIND;
}

impl FigureKind {
    /// The kind of that name.
    ///
    /// # Errors
    /// There is none, with the nearest.
    pub fn named(name: &str) -> Result<Self, Diagnostics> {
        Self::ALL.iter().copied().find(|k| k.name() == name).ok_or_else(|| {
            let known = Self::ALL.iter().map(|k| k.name());
            let d = Diagnostic::new(Code::UnknownSelection, "", format!("there is no figure `{name}`"));
            let list = known.clone().collect::<Vec<_>>().join(", ");
            d.suggest(name, known).hint(format!("the figures are: {list}")).into()
        })
    }

    /// The kinds that can be made of a train as it is, of those that do not take long to make.
    pub fn applicable(model: &Model) -> Vec<Self> {
        /// What a list may cost, s.
        const LONGEST: f64 = 2.0;
        let request = FigureRequest { samples: 128, ..Default::default() };
        let fits = |k: &Self| k.effort(model, &request).seconds < LONGEST && k.applies(model);
        Self::ALL.iter().copied().filter(fits).collect()
    }

    /// Makes one of many figures: it may take its share of the [patience](Work::patience).
    ///
    /// # Errors
    /// What [`FigureKind::make`] says; it would take longer.
    pub fn make_among_many(
        self,
        model: &Model,
        request: &FigureRequest,
        work: &dyn Work,
    ) -> Result<Figure, Diagnostics> {
        const SHARE: f64 = 1.0 / 6.0;
        match self.effort(model, request) {
            long if long.seconds > SHARE * work.patience() => Err(TooLong(long).into()),
            _ => self.make_within(model, request, work),
        }
    }

    /// The first question that is answered in vain: it makes no difference to this kind.
    ///
    /// ```
    /// use willis_figure::{Ask, Drawing, FigureKind, FigureRequest};
    ///
    /// let request = FigureRequest { state: Some("3".into()), ..Default::default() };
    /// assert_eq!(FigureKind::Stick.deaf_to(&request, Drawing::default()), None);
    /// assert_eq!(FigureKind::Shift.deaf_to(&request, Drawing::default()), Some(Ask::State));
    /// ```
    pub fn deaf_to(self, request: &FigureRequest, how: Drawing) -> Option<Ask> {
        let asked = request.asks().into_iter().chain(how.animated.then_some(Ask::Animated));
        asked.into_iter().find(|ask| !self.takes().contains(ask))
    }
}

impl Figure {
    /// The heading of its picture.
    pub fn title(&self) -> &'static str {
        self.kind().title()
    }
}
