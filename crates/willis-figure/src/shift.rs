//! The table of states as a picture: which shift elements are closed, the ratios and the steps
//! between them, efficiencies, and what changes from one gear to the next.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::analysis::{Direction, Selection, StateReport, Verdict, Why, analyze};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::exact::Rational;
use willis::train::{ShiftElementKind, Train};
use willis::unstable;

use crate::kind::{self, Kind};

pub(crate) const KIND: Kind<ShiftTable> = Kind {
    title: "Shift table",
    takes: &[],
    effort: kind::of_operations,
    applies: None,
    make: |s, _| shift(s.train()),
    steps: None,
    draw: draw::draw_on,
};

/// A shift table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftTable {
    /// The train.
    pub title: String,
    /// The columns.
    pub elements: Vec<ShiftColumn>,
    /// The states, in the order of the train.
    pub rows: Vec<ShiftRow>,
    /// What happens between each row and the next.
    pub changes: Vec<ShiftChange>,
    /// Over all ratios of the sign of the first one.
    pub spread: Option<ShiftSpread>,
    /// Whether all states have the same input and output.
    pub one_path: bool,
}

/// A shift element.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftColumn {
    /// Its name.
    pub name: String,
    /// What it is.
    pub kind: ShiftElementKind,
}

/// A state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftRow {
    /// Its name.
    pub state: String,
    /// Which elements are closed, by column.
    pub closed: Vec<bool>,
    /// Where power enters and leaves when driving.
    pub path: Option<[String; 2]>,
    /// `ω_input/ω_output`.
    pub ratio: Option<f64>,
    /// The same as a fraction.
    pub exact: Option<String>,
    /// Why there is no ratio.
    pub note: Option<String>,
    /// Input drives output.
    pub drive: ShiftEfficiency,
    /// Output drives input.
    pub coast: ShiftEfficiency,
}

/// Efficiency of a state in one direction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftEfficiency {
    /// Output over input power, where that is one number.
    pub value: Option<f64>,
    /// `locks`, `several`, or why there is none; empty where there is a number.
    pub words: String,
}

/// From one state to the next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftChange {
    /// Elements that open.
    pub opens: Vec<String>,
    /// Elements that close.
    pub closes: Vec<String>,
    /// Whether more than one element opens, or more than one closes: two shifts at once.
    pub several: bool,
    /// Ratio of the first over that of the second, where both have one sign, input and output.
    pub step: Option<f64>,
}

/// Largest over smallest ratio.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ShiftSpread {
    /// The quotient.
    pub value: f64,
    /// The state with the largest ratio.
    pub largest: String,
    /// The state with the smallest.
    pub smallest: String,
}

/// The shift table of a train.
///
/// # Errors
/// A train without states.
///
/// # Example
/// ```
/// use willis_figure::shift;
/// use willis::train::{SetSpec, ShiftElementSpec, StateSpec, Train};
///
/// let train = Train::builder("two speeds")
///     .members(["s", "r", "c"])
///     .terminals(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("r", 70), "c").planet(20, 4).mesh_efficiency(0.99))
///     .shift_element(ShiftElementSpec::brake("B", "r"))
///     .shift_element(ShiftElementSpec::clutch("C", "s", "c"))
///     .state(StateSpec::new("low", ["B"]))
///     .state(StateSpec::new("direct", ["C"]))
///     .build()?;
/// let table = shift(&train)?;
/// assert_eq!(table.rows[0].exact.as_deref(), Some("10/3"));
/// assert_eq!(table.changes[0].opens, ["B"]);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn shift(train: &Train) -> Result<ShiftTable, Diagnostics> {
    if train.states().is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "no shift table: the train has no states")
            .hint("list the closed shift elements of each gear as [[state]], or draw the levers of the train as drawn");
        return Err([d].into_iter().collect());
    }
    // Operations do not matter here, nor what is wrong with them.
    let analysis = analyze(&unstable::without_operations(train), &Selection::default())?;
    let elements: Vec<ShiftColumn> =
        train.shift_elements().iter().map(|e| ShiftColumn { name: e.name.clone(), kind: e.kind }).collect();
    let rows: Vec<ShiftRow> = train
        .states()
        .iter()
        .map(|state| {
            let mut closed = vec![false; elements.len()];
            state.engaged.iter().for_each(|e| closed[e.index()] = true);
            row(&state.name, closed, analysis.ratios.get(&state.name))
        })
        .collect();
    let step = |name: &str| analysis.ratios.get(name).and_then(|r| r.step);
    let changes = rows.windows(2).map(|w| change(&elements, &w[0], &w[1], step(&w[0].state))).collect();
    let mut paths = rows.iter().filter_map(|r| r.path.as_ref());
    let first = paths.next();
    let one_path = paths.all(|p| Some(p) == first);
    let spread = if one_path { spread(&rows) } else { None };
    Ok(ShiftTable { title: train.name().to_owned(), elements, rows, changes, spread, one_path })
}

fn row(name: &str, closed: Vec<bool>, report: Option<&StateReport>) -> ShiftRow {
    let Some(r) = report else {
        let none = || ShiftEfficiency { value: None, words: "no ratio".to_owned() };
        return ShiftRow {
            state: name.to_owned(),
            closed,
            path: None,
            ratio: None,
            exact: None,
            note: Some("no two members are its input and output".to_owned()),
            drive: none(),
            coast: none(),
        };
    };
    let beyond = r.exact.is_some() && r.value.is_none();
    ShiftRow {
        state: name.to_owned(),
        closed,
        path: Some([r.input.clone(), r.output.clone()]),
        ratio: r.value,
        exact: r.exact.as_ref().map(Rational::to_fraction),
        note: note(r).or_else(|| beyond.then(|| "the ratio is beyond floating point".to_owned())),
        drive: efficiency(&r.drive),
        coast: efficiency(&r.coast),
    }
}

/// Why there is no ratio; a picture says what is, not what to do about it.
fn note(r: &StateReport) -> Option<String> {
    let text = r.no_ratio.clone()?;
    match &r.drive.why {
        Some(Why::SpeedNotSettled { freedoms, input, output, .. }) => {
            Some(format!("{freedoms} degrees of freedom: {input} alone does not settle {output}"))
        }
        _ => Some(text),
    }
}

fn efficiency(d: &Direction) -> ShiftEfficiency {
    let words = match (d.verdict, d.efficiency) {
        (_, Some(_)) => String::new(),
        (Verdict::Locked, None) => "locks".to_owned(),
        (Verdict::Multiple, None) => "several".to_owned(),
        (_, None) if matches!(d.why, Some(Why::SpeedNotSettled { .. })) => "not settled".to_owned(),
        (_, None) => d.reason.clone().unwrap_or_else(|| "not determined".to_owned()),
    };
    ShiftEfficiency { value: d.efficiency, words }
}

fn change(elements: &[ShiftColumn], from: &ShiftRow, to: &ShiftRow, step: Option<f64>) -> ShiftChange {
    let names = |wanted: bool| -> Vec<String> {
        let changed = |k: usize| from.closed[k] != to.closed[k] && to.closed[k] == wanted;
        (0..elements.len()).filter(|k| changed(*k)).map(|k| elements[k].name.clone()).collect()
    };
    let (opens, closes) = (names(false), names(true));
    ShiftChange { several: opens.len() > 1 || closes.len() > 1, opens, closes, step }
}

fn spread(rows: &[ShiftRow]) -> Option<ShiftSpread> {
    let all: Vec<(&str, f64)> = rows.iter().filter_map(|r| Some((r.state.as_str(), r.ratio?))).collect();
    let sign = all.first()?.1.signum();
    let own = || all.iter().filter(|(_, i)| i.signum() == sign);
    let largest = own().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let smallest = own().min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    (own().count() > 1).then(|| ShiftSpread {
        value: largest.1 / smallest.1,
        largest: largest.0.to_owned(),
        smallest: smallest.0.to_owned(),
    })
}
