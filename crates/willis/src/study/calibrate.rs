//! Factors on the losses of the laws from tests: what was learnt, what is only prior, and which test would teach most.
//!
//! `P_i = Σ_k exp(z_k) L_k(x_i)`: a factor on each [kind of loss](LossPart), positive by construction. The prior of `z_k` is
//! how far the laws of that kind lie apart. Offsets of torque meters are parameters of their own for each group of tests:
//! `P_measured = P + Σ_j b_j ω_j`. Derivatives are those of the whole operating point, in which torques depend on losses.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::analysis::assumptions;
use crate::contract::{Contract, Format};
use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::model::{Model, ShaftRef, Target, shaft};
use crate::train::csv::{self, Row};
use crate::train::{LossPart, MemberId, Operation, Slot, Train};
use crate::units::{self, Dimension};
use crate::work::{self, Effort, Work};

use super::calibration::{Estimate, Evidence, FAR, deviation, estimate};
use super::profile::Profile;
use super::question::{Hold, PointSetup, TrainCache};
use super::sensitivity::loss_by;

/// Factors stay within this of 1, both ways.
const MOST_FACTOR: f64 = 5.0;
/// A reading below this weight is told as an outlier.
const OUTLIER: f64 = 0.2;
/// What the laws miss at least between groups of tests, over the loss.
const LEAST_MISFIT: f64 = 0.03;
/// The 95 % point of a normal number: half a band of 90 %.
const BAND: f64 = 1.644_853_626_951_472_7;
/// Most tests, and most quantities whose corners are candidates.
const MOST_TESTS: usize = 5000;
const MOST_CORNERS: usize = 4;
/// Most tests that are proposed.
const MOST_NEXT: usize = 5;

/// What a calibration is asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(default, deny_unknown_fields)]
pub struct CalibrateRequest {
    /// The tests, the text of a CSV table: a header, then one test a row. `loss [W]` is what was measured; `sigma [W]` its
    /// standard deviation; `group` tests that share a meter or a day; `note` anything; `time`, `duration`, `hours` and
    /// `share` are not read. The other columns say how it ran,
    /// as of [`CycleRequest`](super::CycleRequest): `input.speed [rpm]`, `input.torque [N m]`, `oil.temperature [degC]`,
    /// `state`.
    pub data: String,
    /// How the data are called, for the train file that results.
    pub name: String,
    /// Standard deviation of the measured loss where no column gives it, as a part of the loss. Default: 0.02.
    pub sigma: f64,
    /// Offsets of torque meters that are looked for in each group: the member, and the standard deviation of the offset
    /// before the tests, N m.
    pub offsets: Vec<(String, f64)>,
    /// Kinds of loss that may move, by their keys (`teeth`, `churning`). Default: all that the tests have.
    pub parts: Vec<String>,
    /// The operation of the train file that says what no column does.
    pub operation: Option<String>,
    /// Take every reading as normal: no outliers.
    pub trust_all: bool,
}

impl Default for CalibrateRequest {
    fn default() -> Self {
        Self {
            data: String::new(),
            name: "tests".into(),
            sigma: 0.02,
            offsets: vec![],
            parts: vec![],
            operation: None,
            trust_all: false,
        }
    }
}

/// What tests say of the laws: the results contract `willis-calibrate-1`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Calibration {
    /// `willis-calibrate-1`.
    pub format: Format<Self>,
    /// Name of the train.
    pub train: String,
    /// Tests.
    pub tests: u64,
    /// Groups of tests.
    pub groups: u64,
    /// The factors.
    pub parts: Vec<CalibratedPart>,
    /// Covariance of their logarithms, in the order of `parts`.
    pub covariance: Vec<Vec<f64>>,
    /// Offsets of torque meters.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub offsets: Vec<MeterOffset>,
    /// Combinations of parameters of which the tests tell more than the prior, of all.
    pub learnt: u64,
    /// How many combinations there are: as many as parameters.
    pub combinations: u64,
    /// Combinations that the tests do not tell from each other.
    pub blind: Vec<BlindDirection>,
    /// Kinds of loss that no test has; they keep their factor.
    pub without_effect: Vec<String>,
    /// Square of how much larger the residuals are than the stated noise, from the tests that parameters do not use up: 1
    /// where the laws fit. Outliers have little say.
    pub misfit: f64,
    /// Factor on the variance of the noise because the laws do not fit within what was stated; 1 where they do.
    pub inflation: f64,
    /// Root mean square of what the laws miss in a group that was left out, over the loss; at least 3 %.
    pub group_misfit: f64,
    /// Tests that are inside the 90 % band of the others, of all.
    pub inside_band: u64,
    /// Every test.
    pub residuals: Vec<TestResidual>,
    /// Loss of each operation of the file, before and after.
    pub predictions: Vec<PredictedLoss>,
    /// Tests that would teach most, the best first.
    pub next: Vec<NextTest>,
    /// Whether the estimate was found; without one there is no answer.
    pub converged: bool,
    /// The train file with the factors.
    pub train_file: String,
    /// What must be known to read the numbers.
    pub notes: Vec<String>,
    /// What the model leaves out, and what stands in for data that were not given.
    #[serde(default)]
    pub assumptions: Vec<String>,
}

impl Contract for Calibration {
    const FORMAT: &'static str = "willis-calibrate-1";
}

/// The factor on a kind of loss.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct CalibratedPart {
    /// Its key in `[losses.factor]`.
    pub key: String,
    /// For people.
    pub name: String,
    /// The factor on the law.
    pub factor: f64,
    /// Standard deviation of its logarithm.
    pub spread: f64,
    /// Its 90 % band.
    pub band: [f64; 2],
    /// Standard deviation of the logarithm before the tests.
    pub prior: f64,
    /// Part of the variance of the prior that the tests took away.
    pub learnt: f64,
    /// Whether it is at the largest factor that is allowed.
    pub at_bound: bool,
}

/// The offset of a torque meter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MeterOffset {
    /// Where it measures.
    pub member: String,
    /// The group of tests.
    pub group: String,
    /// What it shows too much, N m, in the direction in which power goes in.
    pub offset_n_m: f64,
    /// Standard deviation, N m.
    pub spread_n_m: f64,
    /// Standard deviation before the tests, N m.
    pub prior_n_m: f64,
}

/// A combination of parameters that the tests do not see.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BlindDirection {
    /// What the tests tell of it over what the prior does: below 1.
    pub information: f64,
    /// Changes that leave every test as it is, the largest first.
    pub changes: Vec<BlindChange>,
}

/// The change of one parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct BlindChange {
    /// The kind of loss, or the meter.
    pub name: String,
    /// Of a kind of loss, as a part of it; of a meter its offset, N m.
    pub change: f64,
    /// Whether it is the offset of a meter.
    pub meter: bool,
}

/// A test beside its prediction.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct TestResidual {
    /// Its line in the data.
    pub line: u32,
    /// Its group.
    pub group: String,
    /// How it ran.
    pub condition: String,
    /// Measured loss, W.
    pub measured_w: f64,
    /// Its standard deviation, W.
    pub sigma_w: f64,
    /// Loss of the laws as they are, W.
    pub before_w: f64,
    /// Predicted loss with the factors and offsets, W.
    pub predicted_w: f64,
    /// Measured less predicted, over the standard deviation.
    pub residual: f64,
    /// The same from a fit without this test.
    pub left_out: f64,
    /// Its weight: 1 and more for a reading that fits, towards 0 for an outlier.
    pub weight: f64,
    /// Whether it is an outlier: a weight below 0.2.
    pub outlier: bool,
}

/// The loss of an operation of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PredictedLoss {
    /// The operation.
    pub operation: String,
    /// Loss of the laws as they are, W.
    pub before_w: f64,
    /// Loss with the factors, W.
    pub loss_w: f64,
    /// Standard deviation from what the tests leave open of the factors, W.
    pub spread_w: f64,
    /// 90 % band, with what the laws miss between groups, W.
    pub band_w: [f64; 2],
    /// Quantities that lie outside what was tested, each with its value and the tested range, SI.
    pub outside: Vec<(String, f64, [f64; 2])>,
}

/// A test that would teach something.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct NextTest {
    /// How it runs.
    pub condition: String,
    /// By how much it would lower the logarithm of what is possible for all parameters.
    pub gain: f64,
    /// By what part it would lower the variance of the losses of the file's operations.
    pub lowers_variance: f64,
}

/// A column of the data that is not a setting.
#[derive(Clone, Copy, PartialEq)]
enum Own {
    Loss,
    Sigma,
    Group,
    Note,
}

/// A test as it was read.
struct Test {
    line: u32,
    condition: u32,
    loss: f64,
    sigma: f64,
    group: String,
}

/// Factors on the losses of the laws of a train, from tests.
///
/// # Errors
/// What is wrong with the data, each with its line; too few tests; a train without computed losses; and
/// [`Code::Cancelled`].
pub fn calibrate(model: &Model, request: &CalibrateRequest, work: &dyn Work) -> Result<Calibration, Diagnostics> {
    let train = model.train();
    if !train.is_physical() {
        let d = Diagnostic::new(
            Code::Unfit,
            "",
            "no loss of this train is computed by a law, so there is nothing to scale",
        );
        return Err(d.hint("give teeth, oil, bearings or seals; given efficiencies are changed in the file").into());
    }
    let (profile, tests) = read(model, request)?;
    let question = PointSetup::new(model, request.operation.as_deref(), None, Hold::AsGiven)?;
    let conditions = profile.conditions();
    work.afford(&Effort::of_points(train, (20 * conditions) as u64))?;
    let points = points(&question, &profile, &tests)?;
    let groups: Vec<String> = {
        let mut all: Vec<String> = tests.iter().map(|t| t.group.clone()).collect();
        all.sort();
        all.dedup();
        all
    };
    let offsets = offsets(train, &request.offsets)?;
    let chosen = parts(request)?;

    // What the tests have: kinds of loss with a slope anywhere.
    work.begin("conditions", conditions as u64);
    let first = losses(&points, &chosen, &[0.0; LossPart::COUNT], work)?;
    let has = |k: usize| first.iter().any(|(loss, slopes)| slopes[k].abs() > 1e-9 * loss.abs());
    let (used, unused): (Vec<usize>, Vec<usize>) = (0..chosen.len()).partition(|k| has(*k));
    if used.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "", "no test has a loss of a kind that may move");
        return Err(d.hint("leave out `parts`, or test where something is lost").into());
    }
    let free: Vec<LossPart> = used.iter().map(|k| chosen[*k]).collect();
    let m = free.len();
    let nuisance: Vec<(MemberId, f64, usize)> =
        (0..groups.len()).flat_map(|g| offsets.iter().map(move |(member, sd)| (*member, *sd, g))).collect();
    let group_of: Vec<usize> =
        tests.iter().map(|t| groups.iter().position(|g| *g == t.group).expect("it is one of them")).collect();
    let power_speed = |condition: u32, member: MemberId| speed_of(train, &points[condition as usize].1, member);
    let predict = |z: &[f64]| -> Result<Vec<(f64, Vec<f64>)>, Diagnostics> {
        let all = losses(&points, &free, &z[..m], work)?;
        Ok(tests
            .iter()
            .zip(&group_of)
            .map(|(t, group)| {
                let (loss, slopes) = &all[t.condition as usize];
                let mut jacobian: Vec<f64> = slopes.clone();
                let mut value = *loss;
                for (j, (member, _, of)) in nuisance.iter().enumerate() {
                    let own = if of == group { power_speed(t.condition, *member) } else { 0.0 };
                    value += own * z[m + j];
                    jacobian.push(own);
                }
                (value, jacobian)
            })
            .collect())
    };
    let measured: Vec<f64> = tests.iter().map(|t| t.loss).collect();
    let sigma: Vec<f64> = tests.iter().map(|t| t.sigma).collect();
    let prior: Vec<f64> = free.iter().map(|p| p.prior()).chain(nuisance.iter().map(|n| n.1)).collect();
    let evidence = Evidence {
        measured: &measured,
        sigma: &sigma,
        mean: &vec![0.0; prior.len()],
        prior: &prior,
        robust: !request.trust_all,
        bound: MOST_FACTOR.ln(),
    };
    let before = predict(&vec![0.0; prior.len()])?;
    let found = estimate(&predict, &evidence)?;
    if !found.converged {
        let d = Diagnostic::new(Code::Unfit, "", "no factors: the estimate does not come to rest on these tests");
        return Err(d
            .hint(
                "look for tests that contradict each other, and for a `sigma` that is far below what the meters can do",
            )
            .into());
    }

    let names: Vec<String> = free
        .iter()
        .map(|p| p.words().to_owned())
        .chain(nuisance.iter().map(|(member, _, g)| offset_name(train, *member, &groups, *g)))
        .collect();
    let blind = found.directions.iter().filter(|d| d.information < 1.0).map(|d| blind(d, &prior, &names, m)).collect();
    let left_out = found.left_out();
    let inside_band = left_out.iter().filter(|(r, sd)| r.abs() <= BAND * sd).count() as u64;
    let group_misfit = group_misfit(&found, &tests, &groups, &group_of, &sigma);
    let residuals = tests.iter().enumerate().map(|(i, t)| TestResidual {
        line: t.line,
        group: t.group.clone(),
        condition: profile.describe(t.condition as usize),
        measured_w: t.loss,
        sigma_w: t.sigma,
        before_w: before[i].0,
        predicted_w: found.predicted[i].0,
        residual: found.residuals[i],
        left_out: left_out[i].0,
        weight: found.weights[i],
        outlier: found.weights[i] < OUTLIER,
    });
    let parts: Vec<CalibratedPart> = (free.iter().enumerate())
        .map(|(k, part)| {
            let spread = found.covariance[k][k].sqrt();
            CalibratedPart {
                key: part.key().to_owned(),
                name: part.words().to_owned(),
                factor: found.z[k].exp() * train.loss_factors.factors[*part as usize],
                spread,
                band: [-BAND, BAND]
                    .map(|x| (found.z[k] + x * spread).exp() * train.loss_factors.factors[*part as usize]),
                prior: part.prior(),
                learnt: (1.0 - found.covariance[k][k] / (part.prior() * part.prior())).max(0.0),
                at_bound: found.at_bound.contains(&k),
            }
        })
        .collect();
    let range = ranges(&profile, &tests);
    let predictions = predictions(&question, train, &free, &found, group_misfit, &range);
    let next = next(&question, &profile, &tests, &found, &free, &predictions);
    let file = with_factors(model, request, &parts, &tests, &range)?;
    Ok(Calibration {
        assumptions: assumptions(train),
        format: Format::new(),
        train: train.name().to_owned(),
        tests: tests.len() as u64,
        groups: groups.len() as u64,
        covariance: (0..m).map(|a| found.covariance[a][..m].to_vec()).collect(),
        offsets: (nuisance.iter().enumerate())
            .map(|(j, (member, sd, g))| MeterOffset {
                member: train.member_name(*member).to_owned(),
                group: groups[*g].clone(),
                offset_n_m: found.z[m + j],
                spread_n_m: found.covariance[m + j][m + j].sqrt(),
                prior_n_m: *sd,
            })
            .collect(),
        learnt: found.learnt() as u64,
        combinations: found.directions.len() as u64,
        blind,
        without_effect: unused.iter().map(|k| chosen[*k].words().to_owned()).collect(),
        misfit: found.misfit,
        inflation: found.inflation,
        group_misfit,
        inside_band,
        residuals: residuals.collect(),
        predictions: predictions.into_iter().map(|p| p.0).collect(),
        next,
        converged: found.converged,
        train_file: file,
        notes: notes(train, request, &profile, &found, &strangers(&found, &groups, &group_of), groups.len(), &parts),
        parts,
    })
}

/// The speed of a member, rad/s; 0 where it is not determined.
fn speed_of(train: &Train, operation: &Operation, member: MemberId) -> f64 {
    let engaged = operation.state.map_or(&[][..], |k| &train.states[k].engaged);
    let c = crate::kinematics::Configuration::new(train, engaged, &operation.fixed, &[member]);
    c.motion(&operation.speeds).ok().and_then(|motion| motion.si(member)).unwrap_or(0.0)
}

fn offset_name(train: &Train, member: MemberId, groups: &[String], group: usize) -> String {
    let meter = format!("meter at {}", train.member_name(member));
    if groups.len() > 1 { format!("{meter}, group {}", groups[group]) } else { meter }
}

/// Which kinds of loss may move.
fn parts(request: &CalibrateRequest) -> Result<Vec<LossPart>, Diagnostics> {
    let keys = || LossPart::ALL.iter().map(|p| p.key());
    let mut wrong = Diagnostics::default();
    for name in request.parts.iter().filter(|name| keys().all(|k| k != name.as_str())) {
        let d = Diagnostic::new(Code::UnknownName, "", format!("there is no kind of loss `{name}`"));
        let list: Vec<&str> = keys().collect();
        wrong.push(d.suggest(name, keys()).hint(format!("they are: {}", list.join(", "))));
    }
    if wrong.has_errors() {
        return Err(wrong);
    }
    let wanted = |p: &LossPart| request.parts.is_empty() || request.parts.iter().any(|n| n == p.key());
    Ok(LossPart::ALL.into_iter().filter(wanted).collect())
}

/// The meters whose offsets are looked for.
fn offsets(train: &Train, given: &[(String, f64)]) -> Result<Vec<(MemberId, f64)>, Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut all = vec![];
    for (name, sd) in given {
        let member = match shaft(train, name, name) {
            Ok(Some(ShaftRef::Input)) => train.input(),
            Ok(Some(ShaftRef::Output)) => train.output(),
            Ok(Some(ShaftRef::Member(m))) => Some(m),
            Ok(None) => None,
            Err(d) => {
                wrong.push(*d);
                continue;
            }
        };
        match member {
            None => {
                let d = Diagnostic::new(Code::UnknownName, "", format!("a meter at `{name}`: there is no such member"));
                let known = train.members().iter().map(|m| m.name.as_str()).chain(["input", "output"]);
                wrong.push(d.suggest(name, known));
            }
            Some(_) if !(sd.is_finite() && *sd > 0.0) => {
                let message = format!("an offset of {sd} N m at `{name}`: its standard deviation is above zero");
                wrong.push(Diagnostic::new(Code::OutOfRange, "", message));
            }
            Some(member) => all.push((member, *sd)),
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok(all) }
}

/// Splits the data into settings, which a profile reads, and what was measured.
fn read(model: &Model, request: &CalibrateRequest) -> Result<(Profile, Vec<Test>), Diagnostics> {
    let mut wrong = Diagnostics::default();
    let bad = |message: String| Diagnostic::new(Code::BadTable, "", message);
    if !(request.sigma.is_finite() && request.sigma > 0.0) {
        let message = format!("a standard deviation of {} of the loss: it is above zero", request.sigma);
        return Err(Diagnostic::new(Code::OutOfRange, "", message).into());
    }
    let mut rows = csv::rows(&request.data);
    let Some(header) = rows.next() else {
        let d = bad("the data are empty".into());
        return Err(d
            .hint("a header row comes first: `input.speed [rpm],input.torque [N m],loss [W],sigma [W]`")
            .into());
    };
    if header.count > csv::MOST_COLUMNS {
        return Err(bad(csv::too_many(header.count)).into());
    }
    // Name and unit of each column that is not a setting.
    let mut own: Vec<Option<(Own, String)>> = vec![];
    for cell in &header.cells {
        let (name, unit) = match cell.text.split_once('[') {
            Some((name, unit)) => (name.trim(), unit.trim_end_matches(']').trim()),
            None => (cell.text, ""),
        };
        let kind = match name {
            "loss" => Some(Own::Loss),
            "sigma" => Some(Own::Sigma),
            "group" => Some(Own::Group),
            // A test is a condition: when it ran and for how long does not matter.
            "note" | "time" | "duration" | "hours" | "share" => Some(Own::Note),
            _ => None,
        };
        if let Some(kind @ (Own::Loss | Own::Sigma)) = kind
            && units::parse(&format!("1 {unit}"), Dimension::POWER).is_err()
        {
            let message = match unit {
                "" => format!("column `{name}` has no unit"),
                unit => format!("column `{name}`: `{unit}` is no unit of power"),
            };
            wrong.push(bad(message).hint(format!("write `{name} [W]`")));
            own.push(Some((kind, "W".into())));
            continue;
        }
        own.push(kind.map(|k| (k, unit.to_owned())));
    }
    let count = |kind: Own| own.iter().flatten().filter(|o| o.0 == kind).count();
    if count(Own::Loss) == 0 {
        wrong.push(bad("no column has the measured loss".into()).hint("name it `loss [W]`"));
    }
    for (kind, name) in [(Own::Loss, "loss"), (Own::Sigma, "sigma"), (Own::Group, "group")] {
        if count(kind) > 1 {
            wrong.push(bad(format!("two columns are called `{name}`")).hint("keep one of them"));
        }
    }
    // The rest of the data is a profile in which every row weighs the same; its lines stay where they are.
    let separator = header.separator();
    let settings = |row: &Row<'_>, last: &str| -> String {
        let kept = row.cells.iter().zip(&own).filter(|(_, o)| o.is_none());
        let mut cells: Vec<String> = kept.map(|(c, _)| quoted(c.text, separator)).collect();
        cells.push(last.to_owned());
        cells.join(&separator.to_string())
    };
    let mut text: Vec<String> = vec![String::new(); header.line];
    text[header.line - 1] = settings(&header, "hours");
    let mut tests: Vec<Test> = vec![];
    for row in rows {
        text.resize(row.line, String::new());
        text[row.line - 1] = settings(&row, "1");
        if row.count != header.count {
            let message = format!("line {}: {} cells, and the header has {}", row.line, row.count, header.count);
            wrong.push(bad(message));
            continue;
        }
        let mut test = Test { line: row.line as u32, condition: 0, loss: f64::NAN, sigma: f64::NAN, group: "1".into() };
        for (cell, own) in row.cells.iter().zip(&own) {
            let Some((kind, unit)) = own else { continue };
            match kind {
                Own::Note => {}
                Own::Group => cell.text.clone_into(&mut test.group),
                Own::Loss | Own::Sigma => match row.number(cell.text) {
                    Err(why) => wrong.push(bad(format!("line {}: {}", row.line, why.of(cell.text)))),
                    Ok(number) => {
                        let value =
                            units::parse(&format!("{number} {unit}"), Dimension::POWER).map_or(f64::NAN, |q| q.si());
                        *(if *kind == Own::Loss { &mut test.loss } else { &mut test.sigma }) = value;
                    }
                },
            }
        }
        if test.loss <= 0.0 {
            let message = format!("line {}: a measured loss of {} W: it is above zero", row.line, test.loss);
            wrong.push(bad(message).hint("is it a power out, or an offset of the meter larger than the loss?"));
        }
        if count(Own::Sigma) == 0 {
            test.sigma = request.sigma * test.loss;
        } else if test.sigma <= 0.0 {
            let message = format!("line {}: a standard deviation of {} W: it is above zero", row.line, test.sigma);
            wrong.push(bad(message));
        }
        tests.push(test);
    }
    if wrong.has_errors() {
        return Err(wrong);
    }
    if tests.len() < 2 {
        let message = match tests.len() {
            0 => "the data have no test".to_owned(),
            _ => "one test cannot tell a law from noise".to_owned(),
        };
        return Err(bad(message).hint("give two tests or more, at different speeds or loads").into());
    }
    if tests.len() > MOST_TESTS {
        return Err(bad(format!("{} tests: at most {MOST_TESTS} are taken", tests.len())).into());
    }
    // Places in a text that nobody wrote are not told; messages have the line.
    let strip = |all: Diagnostics| all.into_iter().map(|d| Diagnostic { span: None, ..d }).collect::<Diagnostics>();
    let profile = Profile::parse(&(text.join("\n") + "\n"), model).map_err(strip)?;
    for (test, row) in tests.iter_mut().zip(profile.rows()) {
        test.condition = row.condition;
    }
    Ok((profile, tests))
}

/// A cell as it must be written between separators.
fn quoted(text: &str, separator: char) -> String {
    if text.contains(separator) || text.contains('"') {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// The operating point of each condition.
fn points(
    question: &PointSetup<'_>,
    profile: &Profile,
    tests: &[Test],
) -> Result<Vec<(std::sync::Arc<Train>, Operation)>, Diagnostics> {
    let mut wrong = Diagnostics::default();
    let mut all = vec![];
    for condition in 0..profile.conditions() {
        match question.at(&profile.settings(condition), &mut TrainCache::default()) {
            Ok((train, operation)) => all.push((train, operation)),
            Err(more) => {
                let line = tests.iter().find(|t| t.condition as usize == condition).map_or(0, |t| t.line);
                wrong.extend(
                    more.into_iter().map(|d| Diagnostic { message: format!("line {line}: {}", d.message), ..d }),
                );
            }
        }
    }
    if wrong.has_errors() { Err(wrong) } else { Ok(all) }
}

/// Loss of an operation with factors `exp(z)` on some kinds, W, and its derivatives by `z`; none where it has no one
/// answer. Parameters behind those of the kinds have no effect.
fn loss_at(
    train: &Train,
    operation: &Operation,
    free: &[LossPart],
    z: &[f64],
) -> Result<Option<(f64, Vec<f64>)>, Diagnostics> {
    let slots: Vec<Slot> = free.iter().map(|p| Slot::LossFactor(*p)).collect();
    let mut train = train.clone();
    for (part, z) in free.iter().zip(z) {
        train.loss_factors.factors[*part as usize] *= z.exp();
    }
    let Some((loss, slopes)) = loss_by(&train, operation, &slots)? else { return Ok(None) };
    let of = |(p, s): (&LossPart, f64)| s * train.loss_factors.factors[*p as usize];
    let mut by_z: Vec<f64> = free.iter().zip(slopes).map(of).collect();
    by_z.resize(z.len(), 0.0);
    Ok(Some((loss, by_z)))
}

/// The same of each condition.
fn losses(
    points: &[(std::sync::Arc<Train>, Operation)],
    free: &[LossPart],
    z: &[f64],
    work: &dyn Work,
) -> Result<Vec<(f64, Vec<f64>)>, Diagnostics> {
    let all = work::map(work, points.len(), |k| {
        let (train, operation) = &points[k];
        loss_at(train, operation, free, &z[..free.len()])?.ok_or_else(|| {
            let message = format!("a test has no one answer: {}", operation.name);
            Diagnostics::from(Diagnostic::new(Code::Unfit, "", message))
        })
    })?;
    all.into_iter().collect()
}

/// A combination that the tests do not see, in units that people know.
fn blind(d: &super::calibration::Direction, prior: &[f64], names: &[String], m: usize) -> BlindDirection {
    let real: Vec<f64> = d.whitened.iter().zip(prior).map(|(v, s)| v * s).collect();
    // One standard deviation of the prior along the direction; upward in its largest member.
    let largest = (0..real.len()).max_by(|&a, &b| d.whitened[a].abs().total_cmp(&d.whitened[b].abs())).unwrap_or(0);
    let sign = d.whitened[largest].signum();
    let mut changes: Vec<BlindChange> = (0..real.len())
        .filter(|&k| d.whitened[k].abs() > 0.05)
        .map(|k| BlindChange { name: names[k].clone(), change: sign * real[k], meter: k >= m })
        .collect();
    changes.sort_by(|a, b| b.change.abs().total_cmp(&a.change.abs()));
    BlindDirection { information: d.information, changes }
}

/// Groups of which more than half are outliers among the others.
fn strangers(found: &Estimate, groups: &[String], group_of: &[usize]) -> Vec<String> {
    let of = |g: usize| {
        let own: Vec<bool> =
            (0..group_of.len()).filter(|i| group_of[*i] == g).map(|i| found.weights[i] < OUTLIER).collect();
        2 * own.iter().filter(|o| **o).count() > own.len()
    };
    (0..groups.len()).filter(|g| of(*g)).map(|g| groups[g].clone()).collect()
}

/// What the laws miss in a group that is left out, over the loss. A reading is passed over only where it is strange in its
/// own group: a group that misses as a whole is what this tells.
fn group_misfit(found: &Estimate, tests: &[Test], groups: &[String], group_of: &[usize], sigma: &[f64]) -> f64 {
    if groups.len() < 2 {
        return LEAST_MISFIT;
    }
    let (mut sum, mut count) = (0.0, 0usize);
    for g in 0..groups.len() {
        let own: Vec<usize> = (0..tests.len()).filter(|i| group_of[*i] == g).collect();
        let missed = found.left_out_together(&own, sigma);
        let middle = median(missed.clone());
        let apart: Vec<f64> = missed.iter().map(|r| r - middle).collect();
        let far = FAR * deviation(&apart).max(1.0);
        for ((i, r), _) in own.iter().zip(missed).zip(apart).filter(|(_, apart)| apart.abs() <= far) {
            sum += ((r * r - 1.0).max(0.0) * sigma[*i] * sigma[*i]) / (tests[*i].loss * tests[*i].loss);
            count += 1;
        }
    }
    (sum / count.max(1) as f64).sqrt().max(LEAST_MISFIT)
}

/// The middle one of several numbers.
fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    all.get(all.len() / 2).copied().unwrap_or(0.0)
}

/// Smallest and largest value of each numeric setting in the tests, SI.
fn ranges(profile: &Profile, tests: &[Test]) -> Vec<(Target, String, [f64; 2])> {
    let mut all: Vec<(Target, String, [f64; 2])> = vec![];
    for test in tests {
        for (target, text) in profile.settings(test.condition as usize) {
            let dimension = match target {
                Target::Speed(_) => Dimension::ANGULAR_SPEED,
                Target::Torque(_) => Dimension::TORQUE,
                Target::Power(_) => Dimension::POWER,
                Target::Temperature => Dimension::TEMPERATURE,
                _ => continue,
            };
            let Ok(value) = units::parse(&text, dimension).map(|q| q.si()) else { continue };
            match all.iter_mut().find(|(t, ..)| t == target) {
                Some((.., range)) => *range = [range[0].min(value), range[1].max(value)],
                None => all.push((target.clone(), name_of(profile, test, target), [value; 2])),
            }
        }
    }
    all
}

/// The name of a setting as the data have it.
fn name_of(profile: &Profile, test: &Test, target: &Target) -> String {
    let settings = profile.settings(test.condition as usize);
    let at = settings.iter().position(|(t, _)| *t == target).unwrap_or(0);
    let column = profile.columns().nth(at).unwrap_or("");
    column.split('[').next().unwrap_or(column).trim().to_owned()
}

/// The losses of the file's operations with their derivatives.
fn predictions(
    question: &PointSetup<'_>,
    train: &Train,
    free: &[LossPart],
    found: &Estimate,
    misfit: f64,
    ranges: &[(Target, String, [f64; 2])],
) -> Vec<(PredictedLoss, Vec<f64>)> {
    let mut all = vec![];
    for operation in train.operations() {
        let Ok(Some((loss, by))) = loss_at(train, operation, free, &found.z) else { continue };
        let Ok(Some((before, _))) = loss_at(train, operation, &[], &[]) else { continue };
        let spread = found.variance(&by).sqrt();
        let wide = BAND * (spread * spread + (misfit * loss).powi(2)).sqrt();
        let value = |target: &Target| match target {
            Target::Speed(who) => {
                let member = question.role(train, operation, *who).ok()?;
                Some(speed_of(train, operation, member))
            }
            Target::Torque(who) => {
                let member = question.role(train, operation, *who).ok()?;
                let load = operation.loads.iter().find(|l| l.0 == member)?;
                match &load.1 {
                    crate::train::Load::Torque(q) if matches!(who, ShaftRef::Output) => Some(-q.si()),
                    crate::train::Load::Torque(q) => Some(q.si()),
                    crate::train::Load::Power(_) => None,
                }
            }
            Target::Temperature => operation.temperature.or(train.lubrication().map(|l| l.temperature)),
            _ => None,
        };
        let outside = ranges.iter().filter_map(|(target, name, range)| {
            let x = value(target)?;
            let slack = 1e-6 * (range[1].abs().max(range[0].abs()));
            (x < range[0] - slack || x > range[1] + slack).then(|| (name.clone(), x, *range))
        });
        let predicted = PredictedLoss {
            operation: operation.name.clone(),
            before_w: before,
            loss_w: loss,
            spread_w: spread,
            band_w: [(loss - wide).max(0.0), loss + wide],
            outside: outside.collect(),
        };
        all.push((predicted, by));
    }
    all
}

/// The corners of what was tested, and no load, ranked by what they would teach.
fn next(
    question: &PointSetup<'_>,
    profile: &Profile,
    tests: &[Test],
    found: &Estimate,
    free: &[LossPart],
    wanted: &[(PredictedLoss, Vec<f64>)],
) -> Vec<NextTest> {
    let mut ranges = ranges(profile, tests);
    ranges.truncate(MOST_CORNERS);
    let fixed = profile.settings(tests[0].condition as usize);
    let fixed: Vec<(&Target, String)> = fixed.into_iter().filter(|(t, _)| ranges.iter().all(|r| r.0 != **t)).collect();
    let mut all = vec![];
    let levels: Vec<Vec<f64>> = ranges
        .iter()
        .map(|(target, _, [low, high])| {
            let mut all = vec![*low, *high];
            if matches!(target, Target::Torque(_) | Target::Power(_)) && *low > 0.0 {
                all.insert(0, 0.0);
            }
            all.dedup();
            all
        })
        .collect();
    let count: usize = levels.iter().map(Vec::len).product();
    let variance: f64 = wanted.iter().map(|w| found.variance(&w.1)).sum();
    let aims: Vec<Vec<f64>> = wanted.iter().map(|w| w.1.clone()).collect();
    for k in 0..count {
        let mut rest = k;
        let mut settings: Vec<(&Target, String)> = fixed.clone();
        let mut said = vec![];
        for ((target, name, _), levels) in ranges.iter().zip(&levels) {
            let value = levels[rest % levels.len()];
            rest /= levels.len();
            let (unit, shown) = match target {
                Target::Speed(_) => ("rad/s", format!("{:.0} rpm", value * 30.0 / std::f64::consts::PI)),
                Target::Power(_) => ("W", format!("{value:.0} W")),
                Target::Temperature => ("K", format!("{:.0} °C", value - 273.15)),
                _ => ("N m", format!("{value:.1} N m")),
            };
            settings.push((target, format!("{value} {unit}")));
            said.push(format!("{name} = {shown}"));
        }
        let Ok((train, operation)) = question.at(&settings, &mut TrainCache::default()) else { continue };
        let Ok(Some((loss, by))) = loss_at(&train, &operation, free, &found.z) else { continue };
        // It would be measured as well as the test that lost about as much.
        let apart = |t: &Test| (t.loss - loss).abs();
        let noise = tests.iter().min_by(|a, b| apart(a).total_cmp(&apart(b))).map_or(f64::INFINITY, |t| t.sigma);
        all.push(NextTest {
            condition: said.join(", "),
            gain: found.gain(&by, noise),
            lowers_variance: if variance > 0.0 { found.gain_for(&by, noise, &aims) / variance } else { 0.0 },
        });
    }
    all.sort_by(|a, b| b.lowers_variance.total_cmp(&a.lowers_variance).then(b.gain.total_cmp(&a.gain)));
    all.truncate(MOST_NEXT);
    all
}

/// The train file with the factors, what is left open of them, and what they rest on.
fn with_factors(
    model: &Model,
    request: &CalibrateRequest,
    parts: &[CalibratedPart],
    tests: &[Test],
    ranges: &[(Target, String, [f64; 2])],
) -> Result<String, Diagnostics> {
    let mut settings: Vec<(String, String)> = vec![];
    let of: Vec<String> = ranges
        .iter()
        .map(|(target, name, [low, high])| match target {
            Target::Speed(_) => {
                let rpm = |w: f64| w * 30.0 / std::f64::consts::PI;
                format!("{name} {:.0} to {:.0} rpm", rpm(*low), rpm(*high))
            }
            Target::Temperature => format!("{name} {:.0} to {:.0} degC", low - 273.15, high - 273.15),
            Target::Power(_) => format!("{name} {low:.0} to {high:.0} W"),
            _ => format!("{name} {low:.1} to {high:.1} N m"),
        })
        .collect();
    let said = format!("{} tests of {}: {}", tests.len(), request.name, of.join(", "));
    settings.push(("losses.calibrated".into(), said.chars().filter(|c| !c.is_control() && *c != '"').collect()));
    for p in parts {
        settings.push((format!("losses.factor.{}", p.key), format!("{:.6}", p.factor)));
        settings.push((format!("losses.spread.{}", p.key), format!("{:.6}", p.spread)));
    }
    Ok(model.with(settings)?.to_toml().to_owned())
}

/// What must be known to read the numbers.
fn notes(
    train: &Train,
    request: &CalibrateRequest,
    profile: &Profile,
    found: &Estimate,
    strangers: &[String],
    groups: usize,
    parts: &[CalibratedPart],
) -> Vec<String> {
    let mut all: Vec<String> = profile.notes().to_vec();
    if found.inflation > 1.0 {
        all.push(format!(
            "the laws do not fit within the stated noise: it is taken {:.1} times as large",
            found.inflation.sqrt()
        ));
    }
    for group in strangers {
        all.push(format!(
            "group {group}: most of its tests are outliers among the others; look at its meters before you trust the factors"
        ));
    }
    for p in parts.iter().filter(|p| p.at_bound) {
        all.push(format!(
            "{} is at the largest factor allowed, {MOST_FACTOR} or its inverse: look for another cause",
            p.name
        ));
    }
    if groups < 2 {
        all.push("one group of tests: what the laws miss between groups is taken as 3 % of the loss".into());
    }
    let columns: Vec<&str> = profile.columns().collect();
    let mut constant: BTreeMap<usize, Option<String>> = (0..columns.len()).map(|k| (k, None)).collect();
    for condition in 0..profile.conditions() {
        for (k, cell) in profile.cells(condition).enumerate() {
            match constant.get(&k) {
                Some(None) => drop(constant.insert(k, Some(cell.to_owned()))),
                Some(Some(first)) if first != cell => drop(constant.remove(&k)),
                _ => {}
            }
        }
    }
    for k in constant.keys() {
        all.push(format!("column `{}` is the same in every test: the tests say nothing of what it does", columns[*k]));
    }
    if request.offsets.is_empty() {
        all.push("torque meters are taken without offset; give `offsets` to look for one in each group".into());
    }
    if train.loss_factors.calibrated.is_some() {
        all.push("the file is calibrated already: its factors are where this calibration starts".into());
    }
    all
}
