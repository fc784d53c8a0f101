//! Losses by source, stacked over a quantity, and at the operating point.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::Model;
use willis::operating_point::LossKind;
use willis::study::{Axis, Hold, PointAnswer, PointSetup, PointVerdict, Sweep};
use willis::work::Effort;

use crate::kind::{Ask, FigureRequest, Kind};
use crate::parts::axes::{self, ChartAxis};

pub(crate) const KIND: Kind<LossChart> = Kind {
    title: "Losses by source",
    takes: &[Ask::State, Ask::Operation, Ask::Over],
    effort,
    applies: None,
    make: |s, r| loss_chart(s, r.state.as_deref(), r.operation.as_deref(), &r.over),
    steps: None,
    draw: draw::draw_on,
};

/// The points along the axis.
fn effort(model: &Model, request: &FigureRequest) -> Effort {
    let steps = if request.over.is_empty() { STEPS } else { axes::points(&request.over, model) };
    Effort::of_points(model.train(), steps as u64)
}

/// Points along the axis where the caller does not say.
const STEPS: usize = 49;
/// Sources that are shown by name.
const NAMED: usize = 8;

/// Where the power goes, over a quantity and at the operating point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LossChart {
    /// The train.
    pub title: String,
    /// The operating point, and what was chosen for it.
    pub basis: String,
    /// The quantity that varies.
    pub x: ChartAxis,
    /// The sources, the largest at the operating point first; the last may be all others together.
    pub series: Vec<LossSeries>,
    /// What can be said at each value: one of [`PointVerdict`](willis::study::PointVerdict).
    pub verdicts: Vec<PointVerdict>,
    /// Output over input power at each value.
    pub efficiency: Vec<Option<f64>>,
    /// The operating point itself, in the unit of the axis, where it prescribes the quantity that varies.
    pub at: Option<f64>,
    /// What can be said of the operating point: one of [`PointVerdict`](willis::study::PointVerdict).
    pub verdict: PointVerdict,
    /// Input power of the operating point, W; absent where it has no single answer.
    pub input_power_w: Option<f64>,
    /// All losses of the operating point, W.
    pub loss_w: Option<f64>,
}

/// The losses of a source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LossSeries {
    /// The source, as the losses name it; `others` for all that are too small to be told.
    pub name: String,
    /// What kind of loss it is; of the others, none.
    pub kind: Option<LossKind>,
    /// Its law; `given` for an efficiency that the file gives.
    pub law: Option<String>,
    /// How many sources it stands for.
    pub sources: usize,
    /// W at each value of the axis, absent where there is no single answer.
    pub loss_w: Vec<Option<f64>>,
    /// W at the operating point.
    pub at_operation_w: Option<f64>,
}

/// The losses of an answer: name, kind, law, W.
fn sources(answer: &PointAnswer) -> Option<Vec<(String, LossKind, String, f64)>> {
    let s = answer.solution.as_ref().filter(|_| answer.is_unique())?;
    Some(s.losses_by_source().into_iter().map(|x| (x.name, x.kind, x.law, x.loss_w)).collect())
}

/// Computes losses over a quantity (the operation's first speed, where none is named), source by source.
///
/// # Errors
/// No such state or operation, no operation at all; an axis that is none.
///
/// # Example
/// ```
/// use willis_figure::loss_chart;
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
///     mesh_efficiency = 0.99
///     [[operation]]
///     name = "full load"
///     speeds = { s = "1000 rpm" }
///     torques = { s = "10 N m" }
/// "#;
/// let model = Model::from_toml(text).unwrap();
/// let chart = loss_chart(&model, None, None, &["s.torque=1..20 N m:5".into()])?;
/// let total: f64 = chart.series.iter().map(|s| s.at_operation_w.unwrap()).sum();
/// assert!((total - chart.loss_w.unwrap()).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn loss_chart(
    model: &Model,
    state: Option<&str>,
    operation: Option<&str>,
    over: &[String],
) -> Result<LossChart, Diagnostics> {
    let train = model.train();
    let question = PointSetup::new(model, operation, state, Hold::AsGiven)?;
    if question.base().loads.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "losses belong to a loaded operating point, and there is none");
        return Err(d.hint("add an [[operation]] with speeds and torques or powers").into());
    }
    let over = match over {
        [] => vec![axes::usual_speed(&question, STEPS)],
        [_] => over.to_vec(),
        _ => {
            let message = format!("losses are drawn over one quantity, not {}", over.len());
            return Err(Diagnostic::new(Code::BadAxis, "", message).into());
        }
    };
    let [x] = <[Axis; 1]>::try_from(axes::parse(&over, model)?).expect("one is parsed");
    let basis = axes::basis(&question, &[&x]);
    let own = PointAnswer::of(train, question.base());
    let here = sources(&own);
    let at = here.is_some().then(|| prescribed(&question, &x)).flatten();
    let axis = ChartAxis::of(&x);
    let sweep = Sweep::new(question, vec![x], &[])?;
    let mut trains = Default::default();
    let answers: Vec<PointAnswer> = (0..sweep.len()).map(|k| sweep.answer(k, &mut trains)).collect();
    let found: Vec<_> = answers.iter().map(sources).collect();

    // By name and kind: a mesh slides and rolls.
    let mut all: Vec<LossSeries> = vec![];
    let everywhere = found.iter().map(Some).chain([None]).enumerate();
    for (k, list) in everywhere {
        for (name, kind, law, watts) in list.unwrap_or(&here).iter().flatten() {
            let at = all.iter().position(|s| s.name == *name && s.kind == Some(*kind)).unwrap_or_else(|| {
                let loss_w = found.iter().map(|f| f.as_ref().map(|_| 0.0)).collect();
                let (name, kind, law) = (name.clone(), Some(*kind), Some(law.clone()));
                all.push(LossSeries {
                    name,
                    kind,
                    law,
                    sources: 1,
                    loss_w,
                    at_operation_w: here.as_ref().map(|_| 0.0),
                });
                all.len() - 1
            });
            match all[at].loss_w.get_mut(k) {
                Some(here) => *here = Some(here.unwrap_or(0.0) + watts),
                None => all[at].at_operation_w = Some(all[at].at_operation_w.unwrap_or(0.0) + watts),
            }
        }
    }
    let most = |s: &LossSeries| s.loss_w.iter().chain([&s.at_operation_w]).flatten().fold(0.0f64, |a, w| a.max(*w));
    all.retain(|s| most(s) > 0.0);
    // As the bars of the operating point stand below each other; without one, by the greatest loss anywhere.
    let rank = |s: &LossSeries| s.at_operation_w.unwrap_or_else(|| most(s));
    all.sort_by(|a, b| rank(b).total_cmp(&rank(a)).then(most(b).total_cmp(&most(a))));
    if all.len() > NAMED {
        let rest = all.split_off(NAMED - 1);
        let sum = |own: &dyn Fn(&LossSeries) -> Option<f64>| rest.iter().map(own).sum::<Option<f64>>();
        let others = LossSeries {
            name: "others".to_owned(),
            kind: None,
            law: None,
            sources: rest.len(),
            loss_w: (0..axis.values.len()).map(|k| sum(&|s| s.loss_w[k])).collect(),
            at_operation_w: sum(&|s| s.at_operation_w),
        };
        all.push(others);
    }
    Ok(LossChart {
        title: train.name().to_owned(),
        basis,
        x: axis,
        series: all,
        verdicts: answers.iter().map(|a| a.verdict).collect(),
        efficiency: answers.iter().map(|a| Some(a.efficiency()).filter(|e| e.is_finite())).collect(),
        at,
        verdict: own.verdict,
        input_power_w: own.solution.as_ref().filter(|_| here.is_some()).map(|s| s.input_power_w),
        loss_w: own.solution.as_ref().filter(|_| here.is_some()).map(|s| s.loss_w),
    })
}

/// The value of the axis at the operating point itself, where that prescribes it.
fn prescribed(question: &PointSetup<'_>, x: &Axis) -> Option<f64> {
    let (who, what) = x.name.rsplit_once('.')?;
    let member = question.model().train().member(who)?;
    let speed = question.base().speeds.iter().find(|s| s.0 == member).filter(|_| what == "speed" && x.unit == "rpm")?;
    let value = speed.1.si() * 30.0 / std::f64::consts::PI;
    (value >= x.number(0) && value <= x.number(x.len() - 1)).then_some(value)
}
