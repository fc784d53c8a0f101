//! Variants over the same axes, point by point.

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::Model;
use crate::study::axis::Axis;
use crate::study::question::{Hold, PointSetup, TrainCache};
use crate::study::sweep::Sweep;
use crate::train::Operation;
use crate::work::{self, Cancelled, Effort, Work};

use super::results::{point, prescribed, same};
use super::{CompareRequest, TextDifference};

/// Points of a map beyond which a comparison is a study of its own.
const MOST_POINTS: u64 = 1_000_000;
/// Bands into which a long axis is cut to tell where a variant is better.
const BANDS: usize = 5;

/// A place on a map.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapPlace {
    /// Value less that of the first variant.
    pub difference: f64,
    /// Value of the first variant.
    pub first: f64,
    /// Value of the other.
    pub other: f64,
    /// The point in words.
    pub place: String,
}

/// A difference over many points.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapDifference {
    /// Points at which the other variant is better.
    pub better: u64,
    /// Points at which it is worse.
    pub worse: u64,
    /// Points at which both are equal.
    pub equal: u64,
    /// Mean of its value less that of the first.
    pub mean: Option<f64>,
    /// Where it is better by most.
    pub most_better: Option<MapPlace>,
    /// Where it is worse by most.
    pub most_worse: Option<MapPlace>,
}

impl MapDifference {
    fn add(&mut self, first: f64, other: f64, more_is_better: bool, place: impl Fn() -> String) {
        let difference = other - first;
        let gain = if more_is_better { difference } else { -difference };
        let n = (self.better + self.worse + self.equal) as f64;
        self.mean = Some((self.mean.unwrap_or(0.0) * n + difference) / (n + 1.0));
        if same(first, other) {
            self.equal += 1;
            return;
        }
        let (count, most) = match gain > 0.0 {
            true => (&mut self.better, &mut self.most_better),
            false => (&mut self.worse, &mut self.most_worse),
        };
        *count += 1;
        if most.as_ref().is_none_or(|m| difference.abs() > m.difference.abs()) {
            *most = Some(MapPlace { difference, first, other, place: place() });
        }
    }
}

/// Efficiency along a part of an axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Band {
    /// The axis.
    pub axis: String,
    /// First value.
    pub from: String,
    /// Last value.
    pub to: String,
    /// Points at which the other variant is the more efficient.
    pub better: u64,
    /// Points at which it is the less efficient.
    pub worse: u64,
    /// Points at which both are equal.
    pub equal: u64,
    /// Mean of its efficiency less that of the first.
    pub mean: Option<f64>,
}

/// The first variant and another over the same axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapPair {
    /// Label of the first.
    pub first: String,
    /// Label of the other.
    pub other: String,
    /// Points at which both have one answer.
    pub compared: u64,
    /// Points at which only the first has one.
    pub only_first: u64,
    /// Points at which only the other has one.
    pub only_other: u64,
    /// Points at which neither has one.
    pub neither: u64,
    /// Of the efficiency.
    pub efficiency: MapDifference,
    /// Of the loss, W.
    pub loss_w: MapDifference,
    /// Efficiency along each axis.
    pub bands: Vec<Band>,
}

/// Efficiency and loss, W, of a variant at a point; none where it has not exactly one answer.
type Found = Option<(f64, f64)>;

impl MapPair {
    fn new(first: &str, other: &str, bands: Vec<Band>) -> Self {
        Self {
            first: first.to_owned(),
            other: other.to_owned(),
            compared: 0,
            only_first: 0,
            only_other: 0,
            neither: 0,
            efficiency: MapDifference::default(),
            loss_w: MapDifference::default(),
            bands,
        }
    }

    /// Adds a point of the sweep.
    fn add(&mut self, sweep: &Sweep<'_>, point: u64, first: Found, other: Found) {
        let ((a, lost_a), (b, lost_b)) = match (first, other) {
            (Some(a), Some(b)) => (a, b),
            (Some(_), None) => return self.only_first += 1,
            (None, Some(_)) => return self.only_other += 1,
            (None, None) => return self.neither += 1,
        };
        self.compared += 1;
        self.efficiency.add(a, b, true, || sweep.describe(point));
        self.loss_w.add(lost_a, lost_b, false, || sweep.describe(point));
        let mut at = 0;
        for (axis, k) in sweep.axes().iter().zip(sweep.place(point)) {
            let count = band_count(axis);
            let band = &mut self.bands[at + k * count / axis.len()];
            at += count;
            let n = (band.better + band.worse + band.equal) as f64;
            band.mean = Some((band.mean.unwrap_or(0.0) * n + (b - a)) / (n + 1.0));
            *match (same(a, b), b > a) {
                (true, _) => &mut band.equal,
                (false, true) => &mut band.better,
                (false, false) => &mut band.worse,
            } += 1;
        }
    }
}

/// How many parts an axis is cut into: every text is one.
fn band_count(axis: &Axis) -> usize {
    if axis.is_text() { axis.len() } else { axis.len().min(BANDS) }
}

/// Variants over the same axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapComparison {
    /// The axes as they were written.
    pub over: Vec<String>,
    /// How many points.
    pub points: u64,
    /// The operation from which each variant starts.
    pub operations: Vec<String>,
    /// What these prescribe differently, where no axis sets it.
    pub prescribed: Vec<TextDifference>,
    /// The first variant with each other.
    pub pairs: Vec<MapPair>,
}

pub(super) fn compare(
    variants: &[(&str, &Model)],
    labels: &[String],
    request: &CompareRequest,
    work: &dyn Work,
) -> Result<MapComparison, Diagnostics> {
    let mut sweeps = vec![];
    for (file, model) in variants {
        let called = |wrong: Diagnostics| -> Diagnostics {
            let own = wrong.into_iter().map(|mut d| {
                d.message = format!("{file}: {}", d.message);
                d.span = None;
                d
            });
            own.collect()
        };
        let axes: Result<Vec<Axis>, _> = request.over.iter().map(|text| Axis::parse(text, model)).collect();
        let axes = axes.map_err(|d| called((*d).into()))?;
        let question = PointSetup::new(model, request.operation.as_deref(), request.state.as_deref(), Hold::AsGiven);
        sweeps.push(question.and_then(|q| Sweep::new(q, axes, &[])).map_err(called)?);
    }
    let first = &sweeps[0];
    // Each against the first.
    for (k, other) in sweeps.iter().enumerate().skip(1) {
        for (a, b) in first.axes().iter().zip(other.axes()) {
            let is_same = a.len() == b.len() && (0..a.len().min(1000)).all(|k| a.setting(k) == b.setting(k));
            if !is_same {
                let message = format!("`{}` takes other values in {} than in {}", a.name, labels[k], labels[0]);
                let d = Diagnostic::new(Code::BadAxis, "", message);
                return Err(d.hint("list those that all variants have").into());
            }
        }
    }
    let points = first.len();
    if points > MOST_POINTS {
        let message = format!("{points} points are too many to compare; at most {MOST_POINTS} are");
        return Err(Diagnostic::new(Code::BadAxis, "", message)
            .hint("fewer values tell where a variant is better")
            .into());
    }
    let of = |s: &Sweep<'_>| Effort::of_points(s.question().model().train(), s.len());
    let all: Vec<Effort> = sweeps.iter().map(of).collect();
    work.afford(&Effort {
        what: all[0].what,
        count: all.iter().map(|e| e.count).sum(),
        seconds: all.iter().map(|e| e.seconds).sum(),
    })?;
    let mut pairs: Vec<MapPair> =
        (1..sweeps.len()).map(|k| MapPair::new(&labels[0], &labels[k], bands(first))).collect();
    for (point, answers) in (0..points).zip(answers(&sweeps, points, work)?) {
        for (pair, other) in pairs.iter_mut().zip(&answers[1..]) {
            pair.add(first, point, answers[0], *other);
        }
    }
    let base: Vec<&Operation> = sweeps.iter().map(|s| s.question().base()).collect();
    // At the first point, so that what an axis sets is the same.
    let begun = sweeps.iter().zip(variants).map(|(s, v)| match s.ask(0, &mut TrainCache::default()) {
        Ok((train, operation)) => Some(point(&train, &operation)),
        Err(_) => Some(point(v.1.train(), s.question().base())),
    });
    let bases: Vec<_> = begun.collect();
    Ok(MapComparison {
        over: request.over.clone(),
        points,
        operations: base.iter().map(|o| o.name.clone()).collect(),
        prescribed: prescribed(&bases),
        pairs,
    })
}

/// Efficiency and loss of every variant at every point, where it has one answer.
fn answers(sweeps: &[Sweep<'_>], points: u64, work: &dyn Work) -> Result<Vec<Vec<Found>>, Cancelled> {
    /// Points of a piece.
    const PIECE: u64 = 256;
    work.begin("points", points);
    let parts = work::map(work, points.div_ceil(PIECE) as usize, |k| {
        let mut trains: Vec<TrainCache> = sweeps.iter().map(|_| TrainCache::default()).collect();
        let (from, to) = (k as u64 * PIECE, ((k as u64 + 1) * PIECE).min(points));
        let mut one = |point: u64| -> Vec<Found> {
            let all = sweeps.iter().zip(&mut trains).map(|(s, t)| {
                let answer = s.answer(point, t);
                let one = answer.is_unique() && !answer.efficiency().is_nan();
                one.then(|| (answer.efficiency(), answer.loss()))
            });
            all.collect()
        };
        let part: Vec<_> = (from..to).map(&mut one).collect();
        work.advance(to - from);
        part
    })?;
    Ok(parts.into_iter().flatten().collect())
}

/// Parts of every axis, still empty.
fn bands(sweep: &Sweep<'_>) -> Vec<Band> {
    let of_axis = |axis: &Axis| -> Vec<Band> {
        let n = axis.len();
        let count = band_count(axis);
        let band = |b: usize| {
            let inside: Vec<usize> = (0..n).filter(|k| k * count / n == b).collect();
            let (from, to) = (inside.first().copied().unwrap_or(0), inside.last().copied().unwrap_or(0));
            let (from, to) = (axis.setting(from), axis.setting(to));
            Band { axis: axis.name.clone(), from, to, better: 0, worse: 0, equal: 0, mean: None }
        };
        (0..count).map(band).collect()
    };
    sweep.axes().iter().flat_map(of_axis).collect()
}
