//! What an uncertain result comes to.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::analysis;
use crate::contract::{Contract, Format};
use crate::study::answer::PointVerdict;
use crate::study::column::{Column, ColumnTable, ColumnValues};
use crate::study::design::{REPLICATES, quantile};
use crate::study::summary::{WarningCount, WarningKind};

use super::{DIGITS, SampleResult, Statistics, UncertainValue, UncertaintyPlan, plain, rounded};

/// A quantity as the results show it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct UncertainQuantity {
    /// Its name.
    pub name: String,
    /// Its unit; empty for plain numbers and texts.
    pub unit: String,
    /// Its distribution as it can be written on the command line.
    pub distribution: String,
    /// What `distribution` says, as data.
    pub likely: UncertainValue,
    /// What the file has, as written.
    pub nominal: Option<String>,
}

/// The share of the variance of an output for which a quantity answers.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Influence {
    /// The quantity.
    pub quantity: String,
    /// Its Sobol indices.
    #[serde(flatten)]
    pub index: crate::study::SobolIndices,
}

/// One result and its distribution.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct UncertainResult {
    /// `efficiency`, `loss_w`, `mesh_loss_w`, …, `NAME.total_loss_w`.
    pub name: String,
    /// Its unit; empty for the efficiency.
    pub unit: String,
    /// With the file as written; absent where that has no unique answer.
    pub nominal: Option<f64>,
    /// The share of samples that lie below that.
    pub below_nominal: Option<f64>,
    /// Its distribution; absent where too few samples have an answer.
    pub statistics: Option<Statistics>,
    /// What dominates it, largest total index first; empty with a single quantity and where nothing varies.
    pub influences: Vec<Influence>,
}

/// The samples that share one choice: one law of a family, one number of planets.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ChoiceResult {
    /// The quantity.
    pub quantity: String,
    /// Its value.
    pub value: String,
    /// Whether the file has this one.
    pub is_nominal: bool,
    /// How many samples have it.
    pub samples: usize,
    /// How many of them have an answer.
    pub answered: usize,
    /// Median of their efficiencies.
    pub efficiency_median: Option<f64>,
    /// Median of their losses, W.
    pub loss_median_w: Option<f64>,
    /// 5 % of their losses are below, W.
    pub loss_p05_w: Option<f64>,
    /// 95 % of their losses are below, W.
    pub loss_p95_w: Option<f64>,
}

/// How sure a result is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Uncertainty {
    /// `willis-uncertainty-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// The operating point.
    pub operation: String,
    /// The state of the shift table.
    pub state: Option<String>,
    /// The seed of the points.
    pub seed: u64,
    /// Samples from which the distributions are told.
    pub samples: usize,
    /// Operating points that were computed; more than samples, for what dominates.
    pub evaluations: usize,
    /// Independent scramblings, from which sampling errors are told.
    pub replicates: usize,
    /// What is uncertain.
    pub quantities: Vec<UncertainQuantity>,
    /// What was assumed.
    pub assumptions: Vec<String>,
    /// What the model leaves out, and what stands in for data that were not given, in the file as written.
    #[serde(default)]
    pub model_assumptions: Vec<String>,
    /// What can be said of the file as written.
    pub nominal_verdict: PointVerdict,
    /// Samples by verdict.
    pub verdicts: BTreeMap<PointVerdict, usize>,
    /// The results, efficiency and loss first.
    pub outputs: Vec<UncertainResult>,
    /// Samples by choice, for every quantity that has choices.
    pub choices: Vec<ChoiceResult>,
    /// What is to be known of the distributions.
    pub warnings: Vec<String>,
    /// Warnings of samples by their code, and by `reason` why samples have no answer.
    pub seen: BTreeMap<WarningKind, WarningCount>,
}

impl Contract for Uncertainty {
    const FORMAT: &'static str = "willis-uncertainty-1";
}

impl Uncertainty {
    /// The result of that name.
    pub fn output(&self, name: &str) -> Option<&UncertainResult> {
        self.outputs.iter().find(|o| o.name == name)
    }
}

impl UncertaintyPlan<'_> {
    /// The values of a sample: `efficiency`, `loss_w`, …
    pub fn outputs(&self) -> &[Column] {
        &self.outputs
    }

    /// Every sample: its point, verdict and values, in the order of [`outputs`](Self::outputs).
    pub fn samples<'a>(
        &'a self,
        evaluated: &'a SampleResult,
    ) -> impl Iterator<Item = (usize, PointVerdict, &'a [f64])> + 'a {
        let width = self.outputs.len();
        let points = (0..evaluated.verdicts.len()).filter(|k| self.design.is_sample(*k));
        points.map(move |k| (k, evaluated.verdicts[k], &evaluated.values[k * width..][..width]))
    }

    /// Every sample as a row: its number, its replicate, the uncertain quantities, the verdict and the results.
    pub fn table(&self, evaluated: &SampleResult) -> ColumnTable {
        let points: Vec<(usize, PointVerdict, &[f64])> = self.samples(evaluated).collect();
        let mut table = ColumnTable::default();
        table.add(Column::integer("sample"), ColumnValues::Integers((0..points.len() as i64).collect()));
        let replicate = |p: &(usize, PointVerdict, &[f64])| self.design.replicate(p.0) as i64;
        table.add(Column::integer("replicate"), ColumnValues::Integers(points.iter().map(replicate).collect()));
        let places: Vec<Vec<f64>> = points.iter().map(|p| self.design.at(p.0)).collect();
        for (k, q) in self.quantities.iter().enumerate() {
            let at = places.iter().map(|place| place[k]);
            let values = match &q.likely {
                UncertainValue::Between(d) => {
                    ColumnValues::Numbers(at.map(|p| rounded(d.quantile(p), DIGITS)).collect())
                }
                UncertainValue::Each(_) => ColumnValues::Texts(at.map(|p| q.setting(p).into()).collect()),
            };
            table.add(q.column(), values);
        }
        let verdicts = points.iter().map(|p| p.1.name().into()).collect();
        table.add(Column::text("verdict"), ColumnValues::Texts(verdicts));
        for (k, column) in self.outputs.iter().enumerate() {
            table.add(column.clone(), ColumnValues::Numbers(points.iter().map(|p| p.2[k]).collect()));
        }
        table
    }

    /// The distributions of the results, once all points are evaluated.
    ///
    /// # Panics
    /// If points are missing.
    pub fn finish(&self, evaluated: &SampleResult) -> Uncertainty {
        assert_eq!(evaluated.verdicts.len(), self.len(), "every point is evaluated once");
        let width = self.outputs.len();
        let mut verdicts: BTreeMap<PointVerdict, usize> = BTreeMap::new();
        for (_, verdict, _) in self.samples(evaluated) {
            *verdicts.entry(verdict).or_default() += 1;
        }
        let mut outputs = vec![];
        for (c, Column { name, unit, .. }) in self.outputs.iter().enumerate() {
            // Rows of `width` values lie one after the other.
            let column: Vec<f64> = evaluated.values.iter().skip(c).step_by(width).copied().collect();
            // What this train does not have is not worth a line.
            if c > 1 && column.iter().all(|v| v.is_nan() || *v == 0.0) {
                continue;
            }
            let nominal = Some(self.nominal[c]).filter(|v| !v.is_nan());
            let statistics = self.design.statistics(&column);
            let below_nominal = nominal.zip(statistics).map(|(nominal, s)| {
                let samples = column.iter().enumerate().filter(|(k, _)| self.design.is_sample(*k));
                let (mut below, mut same) = (0, 0);
                for (_, v) in samples {
                    let is_same = (v - nominal).abs() <= Statistics::SAME * nominal.abs();
                    same += usize::from(is_same);
                    below += usize::from(*v < nominal && !is_same);
                }
                (below as f64 + 0.5 * same as f64) / s.answered as f64
            });
            let indices = self.design.indices(&column).unwrap_or_default();
            let mut influences: Vec<Influence> = (self.quantities.iter().zip(indices))
                .map(|(q, index)| Influence { quantity: q.name.clone(), index })
                .collect();
            influences.sort_by(|a, b| b.index.total.total_cmp(&a.index.total));
            outputs.push(UncertainResult {
                name: name.clone(),
                unit: unit.clone(),
                nominal,
                below_nominal,
                statistics,
                influences,
            });
        }
        let base = self.question.base();
        let train = self.question.model().train();
        Uncertainty {
            format: Format::new(),
            train: train.name().to_owned(),
            operation: base.name.clone(),
            state: base.state.map(|k| train.states()[k].name.clone()),
            seed: self.design.seed(),
            samples: self.design.samples(),
            evaluations: self.design.len(),
            replicates: REPLICATES,
            quantities: self.reported(),
            assumptions: self.assumptions.clone(),
            model_assumptions: analysis::assumptions(train),
            nominal_verdict: self.nominal_verdict,
            verdicts,
            outputs,
            choices: self.choices(evaluated),
            warnings: self.warnings.clone(),
            seen: evaluated.seen.clone(),
        }
    }

    fn reported(&self) -> Vec<UncertainQuantity> {
        let all = self.quantities.iter().map(|q| UncertainQuantity {
            name: q.name.clone(),
            unit: q.unit.clone(),
            distribution: q.describe(),
            likely: q.likely.clone(),
            nominal: q.nominal.clone(),
        });
        all.collect()
    }

    fn choices(&self, evaluated: &SampleResult) -> Vec<ChoiceResult> {
        let mut all = vec![];
        for (i, q) in self.quantities.iter().enumerate() {
            let UncertainValue::Each(values) = &q.likely else { continue };
            let mut of: Vec<(usize, Vec<f64>, Vec<f64>)> = vec![Default::default(); values.len()];
            for (point, _, row) in self.samples(evaluated) {
                let own = &mut of[q.choice(self.design.at(point)[i])];
                own.0 += 1;
                if !row[1].is_nan() {
                    own.1.push(row[0]);
                    own.2.push(row[1]);
                }
            }
            for (value, (samples, mut efficiency, mut loss)) in values.iter().zip(of) {
                efficiency.retain(|e| !e.is_nan());
                efficiency.sort_by(f64::total_cmp);
                loss.sort_by(f64::total_cmp);
                let at = |of: &[f64], p: f64| (!of.is_empty()).then(|| quantile(of, p));
                let same = |nominal: &String| {
                    let number = |t: &str| t.parse::<f64>().ok().map(|x| plain(x, DIGITS));
                    nominal == value || number(nominal).is_some_and(|n| Some(n) == number(value))
                };
                all.push(ChoiceResult {
                    quantity: q.name.clone(),
                    value: value.clone(),
                    is_nominal: q.nominal.as_ref().is_some_and(same),
                    samples,
                    answered: loss.len(),
                    efficiency_median: at(&efficiency, 0.5),
                    loss_median_w: at(&loss, 0.5),
                    loss_p05_w: at(&loss, 0.05),
                    loss_p95_w: at(&loss, 0.95),
                });
            }
        }
        all
    }
}
