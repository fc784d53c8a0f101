//! The oil temperature of an operating point: that at which its losses and what carries them away agree.

use std::cell::RefCell;

use serde::{Deserialize, Serialize};

use crate::heat::balance::Failed;
use crate::heat::{Balance, Certificate, HeatVerdict, Limits, Source, balance, time_constants};
use crate::named::NameMap;
use crate::operating_point::{LossKind, Physics, Step};
use crate::train::heat::{Heat, HeatPart, OIL};
use crate::train::{Operation, Train};

use super::operation::{Origin, Point, Settled, settle_at};
use super::rounds::Agreed;
use super::words::{Finding, Refusal};
use super::{MeshReport, SolutionReport, Verdict};

/// Width to which an oil temperature is closed in, K.
pub(super) const TOLERANCE: f64 = 1e-7;

/// Where an oil temperature comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum HeatBasis {
    /// Losses and heat flow agree there.
    Balance,
    /// The operation gives it.
    Given,
    /// There is no balance: the limit.
    Limit,
}

/// The temperatures of an operating point, and where its heat goes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatReport {
    /// Oil temperature in force, K.
    pub oil_k: f64,
    /// Where it comes from.
    pub basis: HeatBasis,
    /// What can be said of it; absent where it is given.
    pub verdict: Option<HeatVerdict>,
    /// Why there is no other.
    pub certificate: Option<Certificate>,
    /// Every oil temperature that holds, the coldest first.
    pub equilibria: Vec<HeatEquilibrium>,
    /// Intervals in which it could not be decided, K.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub undecided_k: Vec<[f64; 2]>,
    /// Temperature of the air, K.
    pub ambient_k: f64,
    /// Highest oil temperature allowed, K.
    pub limit_k: f64,
    /// Limit less oil temperature, K.
    pub margin_k: f64,
    /// Losses that become heat in the gearbox, W.
    pub heat_w: f64,
    /// Heat into the oil beside the losses, W.
    pub extra_heat_w: f64,
    /// Losses of variators, which have a cooling of their own, W.
    pub cooled_elsewhere_w: f64,
    /// Heat that reaches the oil less what leaves it, W: it warms where that is above zero.
    pub residual_w: f64,
    /// Every place.
    pub places: NameMap<PlaceReport>,
    /// Every way for heat.
    pub paths: Vec<HeatFlow>,
    /// Heat that the cooler takes, W; negative where it heats.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cooler_w: Option<f64>,
    /// Heat that reaches the oil and what it gives off, over its temperature. What reaches it is computed at the temperatures
    /// that the balance looked at; between those it is a straight line. Points of studies have none.
    pub curve: Vec<HeatPoint>,
    /// Change of what leaves the oil less what reaches it with its temperature, W/K; above zero where it is stable.
    pub slope_w_k: Option<f64>,
    /// Time constants around this temperature, s, the slowest first; none without heat capacities.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub time_constants_s: Vec<f64>,
    /// Whether other gears drive when the oil is cold than when it is as hot as it may be.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub drivers_change: bool,
}

/// An oil temperature at which losses and heat flow agree.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatEquilibrium {
    /// The temperature, K.
    pub oil_k: f64,
    /// Whether the oil returns to it after a small disturbance.
    pub stable: bool,
    /// Heat made there, W.
    pub heat_w: f64,
    /// On the step of a law: heat that reaches the oil just below and just above it, W.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_w: Option<[f64; 2]>,
}

/// A place of the network.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct PlaceReport {
    /// Its temperature, K.
    pub temperature_k: f64,
    /// Heat made there, W.
    pub heat_w: f64,
    /// Part of that heat that reaches the oil.
    pub share_to_oil: f64,
    /// Whether its temperature is given.
    pub given: bool,
}

/// Heat on its way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatFlow {
    /// From where to where.
    pub between: [String; 2],
    /// The heat, W; negative the other way round.
    pub heat_w: f64,
}

/// Heat at an oil temperature.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct HeatPoint {
    /// Oil temperature, K.
    pub oil_k: f64,
    /// Heat that reaches the oil, W: computed there, or on a straight line between two temperatures at which it was.
    pub reaching_w: f64,
    /// Heat that leaves it, W.
    pub carried_w: f64,
}

/// Why an operating point has no heat at some temperature.
#[derive(Clone, Debug)]
pub(crate) struct NoHeat(Why);

#[derive(Clone, Debug)]
enum Why {
    /// What it prescribes makes no question.
    Refused(Vec<Refusal>),
    /// It has no single answer.
    Verdict(Verdict),
}

/// The losses of an operating point as heat at the places of a network.
pub(crate) struct Losses<'t> {
    train: &'t Train,
    heat: &'t Heat,
    operation: Operation,
    /// From where other temperatures are looked for.
    near: RefCell<Option<Near<'t>>>,
    /// Which gear of each mesh drives, at every temperature that was asked.
    drivers: RefCell<Vec<(f64, Vec<Option<usize>>)>>,
}

/// An equilibrium at one temperature, and the laws at the next.
struct Near<'t> {
    point: Point<'t>,
    origin: Origin,
    physics: Physics<'t>,
    /// The losses at the last temperature: the next are looked for from there.
    last: Option<Step>,
}

impl<'t> Losses<'t> {
    pub fn new(train: &'t Train, heat: &'t Heat, operation: &Operation) -> Self {
        let (near, drivers) = (RefCell::default(), RefCell::default());
        Self { train, heat, operation: operation.clone(), near, drivers }
    }

    /// The heat at a temperature from the equilibrium at another one, where that needs no second look.
    fn near(&self, oil: f64) -> Option<Vec<f64>> {
        let mut near = self.near.borrow_mut();
        let Near { point, origin, physics, last } = near.as_mut()?;
        physics.warm_to(oil);
        let agreed = origin.follow(point, &self.operation, physics, last.as_ref())?;
        *last = Some(agreed.step.clone());
        self.drivers.borrow_mut().push((oil, agreed.flow.meshes.iter().map(|m| m.driver).collect()));
        Some(made_by(self.train, self.heat, physics, &agreed))
    }

    /// Whether other gears drive at one end of the temperatures than at the other.
    fn drivers_change(&self) -> bool {
        let all = self.drivers.borrow();
        let by = |a: &&(f64, Vec<Option<usize>>), b: &&(f64, Vec<Option<usize>>)| a.0.total_cmp(&b.0);
        let ends = all.iter().min_by(by).zip(all.iter().max_by(by));
        ends.is_some_and(|(cold, hot)| cold.1 != hot.1)
    }
}

impl Source for Losses<'_> {
    type Error = NoHeat;

    fn heat(&self, oil: f64) -> Result<Vec<f64>, NoHeat> {
        if let Some(made) = self.near(oil) {
            return Ok(made);
        }
        let operation = Operation { temperature: Some(oil), ..self.operation.clone() };
        let settled = settle_at(self.train, &operation, false).map_err(|wrong| NoHeat(Why::Refused(wrong)))?;
        let [solution] = &settled.report.solutions[..] else {
            return Err(NoHeat(Why::Verdict(settled.report.verdict)));
        };
        if !matches!(settled.report.verdict, Verdict::Unique | Verdict::Unloaded) {
            return Err(NoHeat(Why::Verdict(settled.report.verdict)));
        }
        let own = |(name, m): &(String, MeshReport)| {
            let mesh = self.train.meshes.iter().find(|mesh| mesh.name == *name)?;
            mesh.gears.iter().position(|g| Some(self.train.member_name(g.member)) == m.driver.as_deref())
        };
        self.drivers.borrow_mut().push((oil, solution.meshes.0.iter().map(own).collect()));
        let made = made(self.train, self.heat, solution).0;
        if let (Some(point), Some(origin)) = (settled.point, settled.origin) {
            let physics = Physics::new(self.train, &operation);
            *self.near.borrow_mut() = Some(Near { point, origin, physics, last: None });
            return Ok(self.near(oil).unwrap_or(made));
        }
        Ok(made)
    }
}

/// Heat made at each place, W, and the losses of variators that are cooled elsewhere.
pub(crate) fn made(train: &Train, heat: &Heat, solution: &SolutionReport) -> (Vec<f64>, f64) {
    let all = solution.losses_by_source();
    placed(train, heat, all.iter().map(|s| (s.name.as_str(), s.kind, s.loss_w)))
}

/// Heat made at each place, W, by losses that were found in floating point.
pub(super) fn made_by(train: &Train, heat: &Heat, physics: &Physics<'_>, agreed: &Agreed) -> Vec<f64> {
    let Agreed { step, flow, .. } = agreed;
    let parts = physics.parts(step, &flow.meshes, &flow.drag_losses);
    placed(train, heat, parts.iter().map(|s| (s.0, s.1, s.3))).0
}

/// Losses of named sources at the places where they become heat; what no place names is made in the oil. Of tooth friction
/// each gear of the mesh gets half.
pub(crate) fn placed<'a, R: crate::real::Real>(
    train: &Train,
    heat: &Heat,
    losses: impl Iterator<Item = (&'a str, LossKind, R)>,
) -> (Vec<R>, R) {
    let mut all = vec![R::from(0.0); heat.nodes.len()];
    let mut elsewhere = R::from(0.0);
    for (name, kind, loss) in losses {
        match kind {
            LossKind::Sliding | LossKind::Rolling => {
                let mesh = train.meshes.iter().find(|m| m.name == name);
                for k in 0..2 {
                    let own = mesh.and_then(|m| heat.place(HeatPart::Member(m.gears[k].member)));
                    all[own.unwrap_or(OIL)] += loss * 0.5;
                }
            }
            LossKind::Variator => {
                let at = train.variators.iter().position(|v| v.name == name);
                match at.and_then(|k| heat.place(HeatPart::Variator(k))) {
                    Some(own) => all[own] += loss,
                    None => elsewhere += loss,
                }
            }
            _ => {
                let bearing = train.bearings.iter().position(|b| b.name == name).map(HeatPart::Bearing);
                let seal = train.seals.iter().position(|s| s.name == name).map(HeatPart::Seal);
                let rotor = train.rotors.iter().position(|r| r.name == name).map(HeatPart::Rotor);
                let part = match kind {
                    LossKind::Bearing => bearing,
                    LossKind::Seal => seal,
                    _ => rotor,
                };
                all[part.and_then(|p| heat.place(p)).unwrap_or(OIL)] += loss;
            }
        }
    }
    (all, elsewhere)
}

/// An operating point at the temperature that its losses and what carries them away give, or at the one that is
/// prescribed. `exactly` also works out fractions and the curve.
pub(super) fn settle<'t>(
    train: &'t Train,
    heat: &'t Heat,
    operation: &Operation,
    exactly: bool,
) -> Result<Settled<'t>, Vec<Refusal>> {
    if operation.temperature.is_some() {
        let mut settled = settle_at(train, operation, exactly)?;
        settled.report.heat = given(train, heat, operation, &settled).map(Box::new);
        return Ok(settled);
    }
    let losses = Losses::new(train, heat, operation);
    let found = match balance(heat, &losses, Limits { highest: heat.limit, tolerance: TOLERANCE }) {
        Ok(found) => found,
        Err(Failed::Source(NoHeat(Why::Refused(wrong)))) => return Err(wrong),
        Err(why) => {
            let mut settled = settle_at(train, operation, exactly)?;
            let verdict = match why {
                Failed::Source(NoHeat(Why::Verdict(verdict))) => Some(verdict),
                _ => None,
            };
            settled.findings.push(Finding::NoHeat(verdict));
            return Ok(settled);
        }
    };
    let reached = found.from(heat.start);
    let (oil, basis) = reached.map_or((heat.limit, HeatBasis::Limit), |e| (e.at.oil, HeatBasis::Balance));
    let mut settled = settle_at(train, &Operation { temperature: Some(oil), ..operation.clone() }, exactly)?;
    let [solution] = &settled.report.solutions[..] else { return Ok(settled) };
    let Some(mut report) = report(train, heat, oil, solution) else { return Ok(settled) };
    report.basis = basis;
    report.drivers_change = losses.drivers_change();
    describe(&mut report, heat, &found);
    if exactly {
        report.curve = curve(heat, &found);
    }
    settled.findings.extend(findings(&found, &report));
    settled.report.heat = Some(Box::new(report));
    Ok(settled)
}

/// The heat of an operating point whose temperature is prescribed.
fn given(train: &Train, heat: &Heat, operation: &Operation, settled: &Settled<'_>) -> Option<HeatReport> {
    match &settled.report.solutions[..] {
        [solution] => report(train, heat, operation.temperature?, solution),
        _ => None,
    }
}

/// Where the heat of an equilibrium goes at an oil temperature.
fn report(train: &Train, heat: &Heat, oil: f64, solution: &SolutionReport) -> Option<HeatReport> {
    let (made, elsewhere) = made(train, heat, solution);
    let at = heat.at(oil, &made).ok()?;
    let places = heat.nodes.iter().enumerate().map(|(k, n)| {
        let place = PlaceReport {
            temperature_k: at.temperatures[k],
            heat_w: made[k],
            share_to_oil: at.shares[k],
            given: n.fixed.is_some(),
        };
        (n.name.clone(), place)
    });
    let paths = heat.paths.iter().enumerate().map(|(k, p)| HeatFlow {
        between: p.between.map(|n| heat.nodes[n].name.clone()),
        heat_w: heat.flow(k, at.temperatures[p.between[0]], at.temperatures[p.between[1]]) + 0.0,
    });
    Some(HeatReport {
        oil_k: oil,
        basis: HeatBasis::Given,
        verdict: None,
        certificate: None,
        equilibria: vec![],
        undecided_k: vec![],
        ambient_k: heat.ambient(),
        limit_k: heat.limit,
        margin_k: heat.limit - oil,
        heat_w: made.iter().sum::<f64>() + 0.0,
        extra_heat_w: heat.extra_heat,
        cooled_elsewhere_w: elsewhere + 0.0,
        residual_w: -at.residual + 0.0,
        places: places.collect(),
        paths: paths.collect(),
        cooler_w: heat.cooler.map(|_| heat.cooled(oil) * heat.factor),
        curve: vec![],
        slope_w_k: None,
        time_constants_s: vec![],
        drivers_change: false,
    })
}

/// What a balance adds to the report of its temperature.
fn describe(report: &mut HeatReport, heat: &Heat, found: &Balance) {
    report.verdict = Some(found.verdict);
    report.certificate = Some(found.certificate);
    report.undecided_k.clone_from(&found.undecided);
    let total = |made: &[f64]| made.iter().sum::<f64>();
    report.equilibria = (found.equilibria.iter())
        .map(|e| HeatEquilibrium { oil_k: e.at.oil, stable: e.is_stable(), heat_w: total(&e.at.made), step_w: e.step })
        .collect();
    if let Some(e) = found.equilibria.iter().find(|e| e.at.oil == report.oil_k) {
        report.slope_w_k = Some(e.slope);
        // Slopes of the heats between the samples around it.
        let at = found.samples.partition_point(|s| s.oil < e.at.oil - 0.5);
        let beside = [at.saturating_sub(1), found.samples.partition_point(|s| s.oil <= e.at.oil + 0.5)];
        let [low, high] = beside.map(|k| &found.samples[k.min(found.samples.len() - 1)]);
        if high.oil > low.oil {
            let slopes: Vec<f64> =
                low.made.iter().zip(&high.made).map(|(a, b)| (b - a) / (high.oil - low.oil)).collect();
            report.time_constants_s = time_constants(heat, &e.at.temperatures, &slopes);
        }
    }
}

/// Heat over temperature for a picture. What is carried away costs nothing to compute, and bends where a thermostat opens;
/// what reaches the oil is known at the samples, with straight lines between them.
fn curve(heat: &Heat, found: &Balance) -> Vec<HeatPoint> {
    const PARTS: usize = 60;
    let (first, last) = (&found.samples[0], found.at_limit());
    let mut at: Vec<f64> = (0..=PARTS).map(|k| first.oil + (last.oil - first.oil) * k as f64 / PARTS as f64).collect();
    let bends = heat.cooler.and_then(|c| c.thermostat).into_iter().flatten();
    at.extend(bends.chain(found.equilibria.iter().map(|e| e.at.oil)).filter(|t| (first.oil..=last.oil).contains(t)));
    at.sort_by(f64::total_cmp);
    at.dedup_by(|a, b| (*a - *b).abs() < 1e-6);
    let reaching = |oil: f64| {
        let k = found.samples.partition_point(|s| s.oil < oil).clamp(1, found.samples.len().max(2) - 1);
        let [a, b] = [k - 1, k].map(|k| &found.samples[k.min(found.samples.len() - 1)]);
        let part = if b.oil > a.oil { (oil - a.oil) / (b.oil - a.oil) } else { 0.0 };
        a.reaching + part * (b.reaching - a.reaching)
    };
    let point =
        |oil: f64| Some(HeatPoint { oil_k: oil, reaching_w: reaching(oil), carried_w: heat.carried(oil).ok()? });
    at.into_iter().filter_map(point).collect()
}

/// What a reader must know of a balance.
fn findings(found: &Balance, report: &HeatReport) -> Vec<Finding> {
    let mut all = vec![];
    match found.verdict {
        HeatVerdict::Unique => {}
        HeatVerdict::NoneBelowLimit => {
            let at = found.at_limit();
            all.push(Finding::TooHot { limit: report.limit_k, reaching: at.reaching, carried: at.carried });
        }
        HeatVerdict::Several | HeatVerdict::Undecided => {
            all.push(Finding::SeveralTemperatures {
                others: found.equilibria.iter().map(|e| (e.at.oil, e.is_stable())).collect(),
                undecided: found.undecided.clone(),
                taken: report.oil_k,
            });
        }
    }
    let on_step = found.equilibria.iter().filter(|e| e.at.oil == report.oil_k).find_map(|e| e.step);
    all.extend(on_step.map(|step| Finding::HeatStep { oil: report.oil_k, step }));
    if let Some(heating) = report.cooler_w.filter(|q| *q < 0.0) {
        all.push(Finding::CoolerHeats(-heating));
    }
    all
}
