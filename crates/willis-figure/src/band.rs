//! How sure efficiency and loss are, over a quantity.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::model::{Model, Target};
use willis::study::{
    Axis, Hold, PointAnswer, PointAnswers, PointSetup, TrainCache, UncertaintyPlan, UncertaintyRequest,
};
use willis::work::{self, Effort, Serial, Work};

use crate::kind::{Ask, Detail, FigureRequest, Kind, MEASURED, MOMENT};
use crate::map::compiled::CompiledProbe;
use crate::parts::axes::{self, ChartAxis};

pub(crate) const KIND: Kind<Bands> = Kind {
    title: "How sure it is",
    takes: &[Ask::State, Ask::Operation, Ask::Over],
    effort,
    applies: Some(applies),
    make: |s, r| in_steps(s, r, &Serial, Detail::Fine),
    steps: Some(in_steps),
    draw: draw::draw_on,
};

fn in_steps(model: &Model, r: &FigureRequest, work: &dyn Work, detail: Detail) -> Result<Bands, Diagnostics> {
    let samples = match (detail, r.samples) {
        (Detail::Coarse, _) => DESIGN,
        (Detail::Fine, 0) => SAMPLES,
        (Detail::Fine, samples) => samples,
    };
    let (operation, state) = (r.operation.clone(), r.state.clone());
    bands_within(model, &UncertaintyRequest { operation, state, samples, ..Default::default() }, &r.over, work, detail)
}

/// The samples, each a train of its own, along the axis.
fn effort(model: &Model, request: &FigureRequest) -> Effort {
    let samples = if request.samples == 0 { SAMPLES } else { request.samples };
    let steps = if request.over.is_empty() { STEPS } else { axes::points(&request.over, model) };
    match PointSetup::new(model, None, None, Hold::AsGiven) {
        Ok(question) => question.effort(samples as u64, steps as u64),
        Err(_) => Effort::of_points(model.train(), 1),
    }
}

/// There are bands where something is uncertain and a speed can be varied.
fn applies(model: &Model) -> bool {
    let request = UncertaintyRequest { samples: SAMPLES, ..Default::default() };
    let Ok(plan) = UncertaintyPlan::new(model, &request) else { return false };
    axes::parse(&[axes::usual_speed(plan.question(), STEPS)], model).is_ok()
}

/// Samples where the caller does not say.
const SAMPLES: usize = 256;
/// Samples of a coarse figure: the first of a design with so many, the fewest that there can be.
const COARSE: usize = 32;
const DESIGN: usize = 128;
/// Samples of a coarse figure at least, however long each takes.
const FEWEST: usize = 4;
/// Samples that are computed as one part of the work.
const PART: usize = 8;

/// Points along the axis where the caller does not say.
const STEPS: usize = 9;
/// The same of a coarse figure of a train whose points take long.
const LEAST_STEPS: usize = 3;
/// Evaluations of one picture at most.
const MOST_POINTS: usize = 200_000;

/// The quantiles of [`BandPoint`]: the middle half, and nine tenths.
pub const QUANTILES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// Bands in which efficiency and loss lie.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Bands {
    /// The train.
    pub title: String,
    /// The operating point, and what was chosen for it.
    pub basis: String,
    /// The quantity that varies.
    pub x: ChartAxis,
    /// What is uncertain, each with its distribution.
    pub quantities: Vec<String>,
    /// Samples at each value.
    pub samples: usize,
    /// The bands, one for each value of the axis.
    pub points: Vec<BandPoint>,
}

/// The bands at one value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BandPoint {
    /// [`QUANTILES`] of the efficiency; absent where fewer than half of the samples have an answer.
    pub efficiency: Option<[f64; 5]>,
    /// [`QUANTILES`] of the loss, W.
    pub loss_w: Option<[f64; 5]>,
    /// The efficiency of the file as written.
    pub nominal_efficiency: Option<f64>,
    /// The loss of the file as written, W.
    pub nominal_loss_w: Option<f64>,
    /// Samples that have a single answer.
    pub answered: usize,
}

/// Computes bands of efficiency and loss over a quantity (the operation's first speed, where none is named), from the
/// same samples at every value: what is uncertain is the train, not the point.
///
/// # Errors
/// What [`UncertaintyPlan::new`] says; an axis that is none, or that is itself among the uncertain quantities.
pub fn bands(model: &Model, request: &UncertaintyRequest, over: &[String]) -> Result<Bands, Diagnostics> {
    bands_within(model, request, over, &Serial, Detail::Fine)
}

/// Efficiency and loss of a sample at every value of the axis; NaN where there is no single answer.
fn along(plan: &UncertaintyPlan<'_>, sample: usize, x: &Axis, trains: &mut TrainCache) -> Vec<[f64; 2]> {
    /// Values at which it is tried to compile: the first may lie on a border.
    const TRIES: usize = 3;
    if plan.question().model().train().is_physical() {
        let mut values = vec![];
        let points = (0..x.len()).map(|k| plan.asked_along(Some(sample), x, k, trains));
        PointAnswers::each(points, false, |answer, _| {
            values.push(if answer.is_unique() { [answer.efficiency(), answer.loss()] } else { [f64::NAN; 2] });
        });
        return values;
    }
    let target = Target::parse(&x.name, plan.question().model()).ok();
    // By the sign of the value: beyond zero power goes other ways.
    let mut compiled: [Result<CompiledProbe, usize>; 2] = [Err(0), Err(0)];
    let mut one = |k: usize| {
        let place = if x.is_text() { f64::NAN } else { x.number(k) };
        let known = &mut compiled[usize::from(place > 0.0)];
        let plain = place.is_finite() && place != 0.0;
        if let (true, Ok(known)) = (plain, &mut *known)
            && let Some(told) = known.at(&[place])
        {
            return [told.efficiency, told.loss_w].map(|v| v.unwrap_or(f64::NAN));
        }
        let Ok((train, operation)) = plan.asked_along(Some(sample), x, k, trains) else { return [f64::NAN; 2] };
        let answer = PointAnswer::of(&train, &operation);
        if !answer.is_unique() {
            return [f64::NAN; 2];
        }
        if let (true, Err(tries @ 0..TRIES), Some(target)) = (plain, &*known, &target) {
            let tries = tries + 1;
            *known = CompiledProbe::new(&train, &operation, &[target], &[place], &answer, None).ok_or(tries);
        }
        [answer.efficiency(), answer.loss()]
    };
    (0..x.len()).map(&mut one).collect()
}

fn bands_within(
    model: &Model,
    request: &UncertaintyRequest,
    over: &[String],
    work: &dyn Work,
    detail: Detail,
) -> Result<Bands, Diagnostics> {
    let began = work.clock();
    let plan = UncertaintyPlan::new(model, request)?;
    let question = plan.question();
    let train = question.model().train();
    let pace = detail.pace(train, 1, work, || {
        let _ = PointAnswer::of(train, question.base());
    });
    // Each value is asked of every sample.
    let is_slow = !pace.fits(FEWEST * detail.of(STEPS));
    let over = match over {
        [] => vec![axes::usual_speed(question, if is_slow { LEAST_STEPS } else { detail.of(STEPS) })],
        [_] => over.to_vec(),
        _ => {
            let message = format!("bands are drawn over one quantity, not {}", over.len());
            return Err(Diagnostic::new(Code::BadAxis, "", message).into());
        }
    };
    let [x] = <[Axis; 1]>::try_from(axes::parse(&over, model)?).expect("one is parsed");
    let design = plan.design();
    let most = match detail {
        Detail::Coarse if question.effort(COARSE as u64, x.len() as u64).seconds > MOMENT => COARSE / 2,
        Detail::Coarse => COARSE,
        Detail::Fine => usize::MAX,
    };
    let samples: Vec<usize> = (0..plan.len()).filter(|k| design.is_sample(*k)).take(most).collect();
    if samples.len() * x.len() > MOST_POINTS {
        let message = format!("{} values with {} samples each are too many for a picture", x.len(), samples.len());
        return Err(Diagnostic::new(Code::BadAxis, "", message).hint("take fewer of either").into());
    }
    work.begin("samples", samples.len() as u64);
    let mut trains = Default::default();
    let nominal: Vec<_> = (0..x.len()).map(|j| plan.answer_along(None, &x, j, &mut trains)).collect();
    // What is coarse ends with its moment, where there is a clock, but has some samples.
    let ends = began.filter(|_| detail == Detail::Coarse).map(|began| began + MEASURED);
    let is_over = || ends.is_some_and(|ends| work.clock().is_some_and(|now| now > ends));
    let parts: Vec<&[usize]> = samples.chunks(if ends.is_some() { 1 } else { PART }).collect();
    // One train after the other, so that each is built once.
    let part = |k: usize| -> Vec<Vec<[f64; 2]>> {
        if k >= FEWEST && is_over() {
            return vec![];
        }
        let mut trains = Default::default();
        let values = parts[k].iter().map(|sample| along(&plan, *sample, &x, &mut trains)).collect();
        work.advance(parts[k].len() as u64);
        values
    };
    let values: Vec<Vec<[f64; 2]>> = work::map(work, parts.len(), part)?.into_iter().flatten().collect();
    let samples = values.len();
    let points = nominal
        .into_iter()
        .enumerate()
        .map(|(j, nominal)| {
            let sorted = |which: usize| {
                let mut own: Vec<f64> = values.iter().map(|v| v[j][which]).filter(|v| v.is_finite()).collect();
                own.sort_by(f64::total_cmp);
                own
            };
            let (efficiency, loss) = (sorted(0), sorted(1));
            let told = |own: &[f64]| {
                (2 * own.len() >= samples && !own.is_empty())
                    .then(|| QUANTILES.map(|p| willis::unstable::quantile(own, p)))
            };
            let nominal = (nominal.is_unique()).then(|| [nominal.efficiency(), nominal.loss()]);
            BandPoint {
                efficiency: told(&efficiency),
                loss_w: told(&loss),
                nominal_efficiency: nominal.map(|n| n[0]).filter(|e| e.is_finite()),
                nominal_loss_w: nominal.map(|n| n[1]).filter(|e| e.is_finite()),
                answered: loss.len(),
            }
        })
        .collect();
    Ok(Bands {
        title: model.train().name().to_owned(),
        basis: axes::basis(question, &[&x]),
        x: ChartAxis::of(&x),
        quantities: plan.quantities().iter().map(|q| format!("{} {}", q.name, q.describe())).collect(),
        samples,
        points,
    })
}
