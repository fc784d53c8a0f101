//! What a kind of figure is: the questions it takes, how its data are made, how they are drawn.

use serde::{Deserialize, Serialize};
use willis::analysis::Selection;
use willis::diagnostic::Diagnostics;
use willis::model::Model;
use willis::train::Train;
use willis::work::{Effort, Work};

use crate::report::paper;

/// How much of a figure is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Detail {
    /// What can be seen within a moment: fewer points, fewer samples.
    Coarse,
    /// All.
    Fine,
}

impl Detail {
    /// How long points take: as estimated, or, for a coarse figure of a train whose points take long and where there is a clock,
    /// as measured with one point.
    pub fn pace(self, train: &Train, points: u64, work: &dyn Work, one: impl Fn()) -> Pace {
        /// Seconds of a point after which a second one would take too long to be tried.
        const LONG: f64 = 0.002;
        let each = Effort::of_points(train, points).seconds;
        let estimated = Pace { detail: self, each, moment: MOMENT, least: 6 };
        // What is compiled takes less and less from point to point.
        let is_long = train.is_physical() || !train.variators().is_empty();
        let measure = || {
            let began = work.clock()?;
            one();
            Some(work.clock()? - began)
        };
        if self == Self::Fine || !is_long {
            return estimated;
        }
        let Some(first) = measure() else { return estimated };
        // The first point prepares what the others find there.
        let again = if first < LONG { measure().unwrap_or(first) } else { first };
        Pace { each: points as f64 * again.min(first).max(1e-6), moment: MEASURED, least: 4, ..estimated }
    }

    /// Points along an axis, of so many in full.
    pub fn of(self, points: usize) -> usize {
        match self {
            Self::Coarse => points.div_ceil(2),
            Self::Fine => points,
        }
    }
}

/// Seconds of a coarse figure as its work is estimated. Estimates are right within a factor of three, and borders come to the
/// points: what is seen takes some 20 ms to 50 ms.
pub(crate) const MOMENT: f64 = 0.008;
/// The same where the work is measured: the picture is drawn in the rest of 50 ms.
pub(crate) const MEASURED: f64 = 0.016;

/// See [`Kind::steps`].
pub(crate) type InSteps<T> = fn(&Model, &FigureRequest, &dyn Work, Detail) -> Result<T, Diagnostics>;

/// How many points fit a moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace {
    detail: Detail,
    /// Seconds of a point.
    each: f64,
    /// Seconds for all of them.
    moment: f64,
    /// Points along an axis that show a shape.
    least: usize,
}

impl Pace {
    /// Whether everything is wanted, however long it takes.
    pub fn is_full(self) -> bool {
        self.detail == Detail::Fine
    }

    /// Points along two axes, of so many in full: a coarse figure has half as many along each axis, and fewer if they would take
    /// longer than a moment, but enough to show a shape.
    pub fn grid(self, full: [usize; 2]) -> [usize; 2] {
        if self.is_full() {
            return full;
        }
        let part = (self.moment / (self.each * (full[0] * full[1]) as f64)).sqrt().min(0.5);
        full.map(|n| ((n as f64 * part).ceil() as usize).max(self.least.min(n)))
    }

    /// Whether so many points fit a moment, or all are wanted.
    pub fn fits(self, points: usize) -> bool {
        self.is_full() || self.each * points as f64 <= self.moment
    }

    /// Points that fit a moment at each of so many places, but no more than these.
    pub fn at_each(self, places: usize, most: usize) -> usize {
        match self.is_full() {
            true => most,
            false => ((self.moment / (2.0 * self.each * places.max(1) as f64)) as usize).min(most),
        }
    }
}

/// What a kind of figure says of itself. Each folder has one, as `KIND`.
pub(crate) struct Kind<T> {
    /// The heading of its pictures.
    pub title: &'static str,
    /// The questions that make a difference to it.
    pub takes: &'static [Ask],
    /// How much work it is to make the data.
    pub effort: fn(&Model, &FigureRequest) -> Effort,
    /// Whether the data can be made, where that is known without making them.
    pub applies: Option<fn(&Model) -> bool>,
    /// Makes the data.
    pub make: fn(&Model, &FigureRequest) -> Result<T, Diagnostics>,
    /// Makes the data of a kind that takes long, coarsely or in full, within work that can be cancelled.
    pub steps: Option<InSteps<T>>,
    /// Draws them as SVG in its light form.
    pub draw: fn(&T, Drawing) -> String,
}

/// The effort of a kind that shows operating points of the file.
pub(crate) fn of_operations(model: &Model, request: &FigureRequest) -> Effort {
    Effort::of_analysis(model.train(), &request.selection())
}

/// The effort of a kind that shows what is in the file.
pub(crate) fn of_file(model: &Model, _: &FigureRequest) -> Effort {
    Effort::of_points(model.train(), 1)
}

/// A question of a [`FigureRequest`] or [`Drawing`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Ask {
    /// [`FigureRequest::state`].
    State,
    /// [`FigureRequest::operation`].
    Operation,
    /// [`FigureRequest::part`].
    Part,
    /// [`FigureRequest::over`].
    Over,
    /// [`FigureRequest::terminals`].
    Terminals,
    /// [`FigureRequest::balance`].
    Balance,
    /// [`FigureRequest::seen_from`].
    SeenFrom,
    /// [`FigureRequest::nominal`].
    Nominal,
    /// [`FigureRequest::window`].
    Window,
    /// [`Drawing::animated`].
    Animated,
}

impl Ask {
    /// The word for it: `state`, `operation`, …
    pub fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Operation => "operation",
            Self::Part => "part",
            Self::Over => "over",
            Self::Terminals => "terminals",
            Self::Balance => "balance",
            Self::SeenFrom => "seen-from",
            Self::Nominal => "nominal",
            Self::Window => "from",
            Self::Animated => "animated",
        }
    }
}

/// What to draw of a train. A kind makes no difference between answers to questions that it does not take.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct FigureRequest {
    /// A state of the shift table.
    pub state: Option<String>,
    /// An operation; else the file's first, or all where a kind shows several.
    pub operation: Option<String>,
    /// A set, mesh or scenario, where a kind shows one of them.
    pub part: Option<String>,
    /// Quantities along the axes, as `sweep --over` takes them.
    pub over: Vec<String>,
    /// Members on which torque may act, for regimes; absent for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero, for regimes.
    pub balance: Option<[String; 2]>,
    /// The member from which speeds and powers are seen, such as a carrier, for flows of power; absent for the housing.
    pub seen_from: Option<String>,
    /// Teeth without geometry are drawn as nominal ones of module 1.
    pub nominal: bool,
    /// From when to when a scenario is shown, s; infinite where it is shown from its start or to its end.
    pub window: Option<[f64; 2]>,
    /// Samples of bands at every value; 0 for as many as usual.
    pub samples: usize,
}

impl FigureRequest {
    /// State and operation as the analysis takes them.
    pub(crate) fn selection(&self) -> Selection {
        Selection { state: self.state.clone(), operation: self.operation.clone() }
    }

    /// The questions that it answers.
    pub fn asks(&self) -> Vec<Ask> {
        let given = [
            (Ask::State, self.state.is_some()),
            (Ask::Operation, self.operation.is_some()),
            (Ask::Part, self.part.is_some()),
            (Ask::Over, !self.over.is_empty()),
            (Ask::Terminals, self.terminals.is_some()),
            (Ask::Balance, self.balance.is_some()),
            (Ask::SeenFrom, self.seen_from.is_some()),
            (Ask::Nominal, self.nominal),
            (Ask::Window, self.window.is_some()),
        ];
        given.into_iter().filter(|g| g.1).map(|g| g.0).collect()
    }
}

/// How a figure is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Drawing {
    /// Wheels turn, where the kind has wheels.
    pub animated: bool,
    /// How wide the paper is, in units of the figure, of which its smallest text has 11. A kind lays itself out in that width
    /// as far as it can; absent for as wide as suits a screen.
    pub width: Option<u32>,
}

impl Drawing {
    /// The size of the smallest text of every figure, in units of the figure.
    pub const SMALLEST_TEXT: f64 = 11.0;

    /// The width of paper of so many mm in units of the figure, so that its smallest text has 7 pt.
    ///
    /// ```
    /// use willis_figure::Drawing;
    ///
    /// // The text of an A4 page.
    /// assert_eq!(Drawing::units(174.0), 775);
    /// ```
    pub fn units(mm: f64) -> u32 {
        (mm * paper::MM / paper::SMALLEST * Self::SMALLEST_TEXT) as u32
    }

    /// The width of a page that is so wide on a screen; on narrow paper as wide as that is, but not below what it needs.
    pub(crate) fn page(self, usual: f64, needs: f64) -> f64 {
        self.width.map_or(usual, |width| f64::from(width).clamp(needs.min(usual), usual))
    }
}
