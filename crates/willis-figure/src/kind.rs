//! The kinds of figures, and making one of any kind.

use serde::Serialize;

use willis::analysis::Selection;
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::dynamics::{Options, simulate};
use willis::hypergraph::{FlowReport, flows};
use willis::model::Model;
use willis::regimes::RegimeSelection;
use willis::study::{UncertaintyRequest, sensitivity};

use crate::*;

/// What to draw of a train; what a kind has no use for is left alone.
#[derive(Clone, Debug, Default)]
pub struct FigureRequest {
    /// A state of the shift table.
    pub state: Option<String>,
    /// An operation; else the file's first, or all where a kind shows several.
    pub operation: Option<String>,
    /// A set, mesh or scenario, where a kind shows one of them.
    pub part: Option<String>,
    /// Quantities along the axes, as `sweep --over` takes them.
    pub over: Vec<String>,
    /// Members on which torque may act, for regimes; `None` for the train's terminals.
    pub terminals: Option<Vec<String>>,
    /// Two terminals whose powers add to zero, for regimes.
    pub balance: Option<[String; 2]>,
    /// Teeth without geometry are drawn as nominal ones of module 1.
    pub nominal: bool,
    /// Samples of bands at every value; 0 for as many as usual.
    pub samples: usize,
}

impl FigureRequest {
    fn selection(&self) -> Selection {
        Selection { state: self.state.clone(), operation: self.operation.clone() }
    }
}

/// Samples of bands where the caller does not say.
const SAMPLES: usize = 256;

macro_rules! kinds {
    ($($(#[$doc:meta])* $kind:ident($data:ty) $name:literal: |$subject:ident, $request:ident| $make:expr;)*) => {
        /// What can be drawn.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
        #[serde(rename_all = "kebab-case")]
        pub enum FigureKind {
            $($(#[$doc])* $kind,)*
        }

        /// A figure of any kind, as data.
        #[derive(Clone, Debug, PartialEq, Serialize)]
        #[serde(rename_all = "kebab-case", tag = "figure")]
        pub enum Figure {
            $($(#[$doc])* $kind($data),)*
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

            /// Makes the figure of a train.
            ///
            /// # Errors
            /// Why the kind does not apply to this train, and what would; no such state, operation or part.
            ///
            /// # Example
            /// ```
            /// use willis_figure::{Figure, FigureKind};
            /// use willis::model::Model;
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
            /// let subject = Model::from_toml(text).unwrap();
            /// let figure = FigureKind::Stick.make(&subject, &Default::default())?;
            /// assert!(matches!(figure, Figure::Stick(_)));
            /// // There are no gears to shift.
            /// assert!(FigureKind::Shift.make(&subject, &Default::default()).is_err());
            /// # Ok::<(), willis::Diagnostics>(())
            /// ```
            pub fn make(self, subject: &Model, request: &FigureRequest) -> Result<Figure, Diagnostics> {
                match self {
                    $(Self::$kind => {
                        let ($subject, $request) = (subject, request);
                        Ok(Figure::$kind($make))
                    })*
                }
            }
        }
    };
}

kinds! {
    /// The kinematic schematic.
    Stick(Stick) "stick": |s, r| stick(s.train(), r.state.as_deref())?;
    /// Speeds and torques on levers.
    Lever(Lever) "lever": |s, r| lever(s.train(), &lever_request(r))?;
    /// Powers as bands, each loss branching off.
    Sankey(Sankey) "sankey": |s, r| sankey(&powers(s, r)?);
    /// Powers through components and contacts.
    Flow(FlowReport) "flow": |s, r| powers(s, r)?;
    /// A set seen along its axis.
    Front(Front) "front": |s, r| front(s.train(), r.part.as_deref(), r.nominal)?;
    /// The wheel of regimes of two freedoms.
    Regimes(RegimeMap) "regimes": |s, r| {
        let (state, terminals, balance) = (r.state.clone(), r.terminals.clone(), r.balance.clone());
        regime_map(s.train(), &RegimeSelection { state, terminals, balance })?
    };
    /// Efficiency over two quantities, and the best state.
    Map(EfficiencyMap) "map": |s, r| efficiency_map(s, r.state.as_deref(), r.operation.as_deref(), &r.over)?;
    /// Losses by source, over a quantity and at the operating point.
    Losses(LossChart) "losses": |s, r| loss_chart(s, r.state.as_deref(), r.operation.as_deref(), &r.over)?;
    /// Film over roughness along the path of contact.
    Film(ContactPath) "film": |s, r| contact_path(s.train(), r.operation.as_deref(), r.part.as_deref())?;
    /// Friction, sliding and load along the path of contact.
    Path(ContactPath) "path": |s, r| contact_path(s.train(), r.operation.as_deref(), r.part.as_deref())?;
    /// A scenario over time.
    Time(TimePlot) "time": |s, r| time(s, r)?;
    /// The table of states with its steps.
    Shift(ShiftTable) "shift": |s, _r| shift(s.train())?;
    /// What moves efficiency and losses most.
    Tornado(Tornado) "tornado": |s, r| ranking(s, r)?;
    /// How sure efficiency and loss are.
    Band(Bands) "band": |s, r| {
        let samples = if r.samples == 0 { SAMPLES } else { r.samples };
        let (operation, state) = (r.operation.clone(), r.state.clone());
        bands(s, &UncertaintyRequest { operation, state, samples, ..Default::default() }, &r.over)?
    };
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

    /// The kinds that can be made of a train as it is.
    pub fn applicable(subject: &Model) -> Vec<Self> {
        let request = FigureRequest { samples: 128, ..Default::default() };
        Self::ALL.iter().copied().filter(|k| k.make(subject, &request).is_ok()).collect()
    }
}

impl FigureKind {
    /// Which of the questions of a [`FigureRequest`] make a difference to it: `state`, `operation`, `part`, `over`,
    /// `terminals`, `balance`, `nominal`.
    pub fn takes(self) -> &'static [&'static str] {
        match self {
            Self::Stick => &["state"],
            Self::Lever | Self::Sankey | Self::Flow | Self::Tornado => &["state", "operation"],
            Self::Front => &["part", "nominal"],
            Self::Regimes => &["state", "terminals", "balance"],
            Self::Map | Self::Losses | Self::Band => &["state", "operation", "over"],
            Self::Film | Self::Path => &["operation", "part"],
            Self::Time => &["part"],
            Self::Shift => &[],
        }
    }
}

impl Figure {
    /// What kind it is.
    pub fn title(&self) -> &'static str {
        match self {
            Self::Stick(_) => "Kinematic schematic",
            Self::Lever(_) => "Levers",
            Self::Sankey(_) => "Power flow to scale",
            Self::Flow(_) => "Power flow",
            Self::Front(_) => "Teeth in mesh",
            Self::Regimes(_) => "Regimes",
            Self::Map(_) => "Efficiency map",
            Self::Losses(_) => "Losses by source",
            Self::Film(_) => "Oil film along the path of contact",
            Self::Path(_) => "Contact along its path",
            Self::Time(_) => "Motion over time",
            Self::Shift(_) => "Shift table",
            Self::Tornado(_) => "What matters most",
            Self::Band(_) => "How sure it is",
        }
    }
}

fn lever_request(r: &FigureRequest) -> LeverRequest {
    match (&r.operation, r.state.as_deref()) {
        (Some(operation), _) => LeverRequest::Operation(operation.clone()),
        (None, Some("all")) => LeverRequest::EveryState,
        (None, Some(state)) => LeverRequest::State(state.to_owned()),
        (None, None) => LeverRequest::First,
    }
}

fn powers(subject: &Model, r: &FigureRequest) -> Result<FlowReport, Diagnostics> {
    let report = flows(subject.train(), &r.selection())?;
    if report.operations.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "power flows in operations, and there is none");
        return Err(d
            .hint("add an [[operation]] with speeds and torques or powers; `stick` and `lever` need none")
            .into());
    }
    Ok(report)
}

/// Bars of a ranking.
const BARS: usize = 14;

/// The ranking of the operation that is named, or of the first that has derivatives.
fn ranking(subject: &Model, r: &FigureRequest) -> Result<Tornado, Diagnostics> {
    let all = sensitivity(subject.train(), &r.selection())?;
    let first = all.operations.iter().find(|o| !o.quantities.is_empty()).map(|o| o.name.clone());
    tornado(&all, r.operation.clone().or(first).as_deref(), BARS)
}

/// Simulates the scenario of that name, or the first.
fn time(subject: &Model, r: &FigureRequest) -> Result<TimePlot, Diagnostics> {
    let train = subject.train();
    let all = train.scenarios();
    let scenario = match &r.part {
        None => all.first(),
        Some(name) => all.iter().find(|s| s.name == *name),
    };
    let Some(scenario) = scenario else {
        let d = match &r.part {
            Some(name) => {
                let known = all.iter().map(|s| s.name.as_str());
                let list = known.clone().collect::<Vec<_>>().join(", ");
                Diagnostic::new(Code::UnknownSelection, "", format!("the train has no scenario `{name}`"))
                    .suggest(name, known)
                    .hint(format!("its scenarios are: {}", if list.is_empty() { "none" } else { &list }))
            }
            None => Diagnostic::new(Code::Unfit, "", "the train has no scenario that could run over time"),
        };
        return Err(d.hint("a [[scenario]] says what drives and what happens when").into());
    };
    let mut plot = TimePlotBuilder::new(train, [scenario.start, scenario.end]);
    let report = simulate(train, &scenario.name, &Options::default(), &mut plot)?;
    Ok(plot.finish(&report))
}
