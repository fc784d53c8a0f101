//! What is uncertain when nobody says so, and the laws that are as likely as others.

use crate::catalogue::oil::Viscosity;
use crate::diagnostic::{Code, Diagnostic};
use crate::losses::{self, FAMILIES, Tag};
use crate::model::Target;
use crate::study::answer::PointAnswer;
use crate::study::distribution::{Distribution, Reader};
use crate::study::question::PointSetup;
use crate::train::{LossPart, Measure};

use super::{LawChoice, Uncertain, UncertainValue, listed, nominal};

/// Share of a given loss `1 − η` that is doubtful, each way.
const LOSS: f64 = 0.2;
/// Share of a roughness.
const ROUGHNESS: f64 = 0.2;
/// Kelvin of an oil temperature.
const TEMPERATURE: f64 = 5.0;
/// Standard deviation of the logarithm of what carries heat away.
const HEAT: f64 = 0.25;

/// The laws of a family that a train can use, in their order; only those inside their range at the operating point if so
/// asked and two are. And what is to be said of them.
pub(super) fn laws_of(family: &'static str, question: &PointSetup<'_>, inside: bool) -> (Vec<String>, String) {
    let train = question.model().train();
    let own = losses::entries().into_iter().filter(|e| e.family == family);
    let (wrong, good): (Vec<_>, Vec<_>) = own.partition(|e| e.tags.contains(&Tag::Compatibility));
    let (mut within, mut outside, mut unfit) = (vec![], vec![], vec![]);
    for e in good {
        let Ok(with) = train.clone().with_law(family, e.id) else {
            unfit.push(e.id.to_owned());
            continue;
        };
        let answer = PointAnswer::of(&with, question.base());
        let own = LawChoice { family: family.to_owned(), law: e.id.to_owned() };
        match answer.warnings.iter().any(|w| w.law.as_ref() == Some(&own)) {
            true => outside.push(e.id.to_owned()),
            false => within.push(e.id.to_owned()),
        }
    }
    let mut told = format!("law.{family}: each law is as likely as the others");
    let keep_inside = inside && within.len() > 1;
    let wrong: Vec<String> = wrong.iter().map(|e| e.id.to_owned()).collect();
    let beyond = if keep_inside { &outside[..] } else { &[] };
    let left_out: Vec<String> =
        [(&unfit[..], "data missing"), (&wrong[..], "a published error"), (beyond, "outside the range of the source")]
            .into_iter()
            .filter(|(laws, _)| !laws.is_empty())
            .map(|(laws, why)| format!("{} ({why})", listed(laws)))
            .collect();
    if !left_out.is_empty() {
        told += &format!("; left out: {}", left_out.join(", "));
    }
    if keep_inside {
        return (within, told);
    }
    let order = |id: &String| losses::entries().iter().position(|e| e.family == family && e.id == id);
    within.extend(outside);
    within.sort_by_key(order);
    (within, told)
}

/// `--laws`: a family, or all whose choice matters here.
pub(super) fn laws(family: &str, question: &PointSetup<'_>) -> Result<Vec<(Uncertain, String)>, Box<Diagnostic>> {
    let train = question.model().train();
    let one = |family: &'static str| {
        let (laws, told) = laws_of(family, question, true);
        let target = Target::Law(family);
        let loss = |law: &String| {
            let with = train.clone().with_law(family, law).ok()?;
            Some(PointAnswer::of(&with, question.base()).loss())
        };
        let all: Vec<f64> = laws.iter().filter_map(loss).filter(|l| !l.is_nan()).collect();
        let matters = all.iter().any(|l| *l != all[0]);
        let nominal = nominal(&target, question);
        let name = format!("law.{family}");
        let found = Uncertain { name, unit: String::new(), likely: UncertainValue::Each(laws), nominal, target };
        matters.then_some((found, told))
    };
    if family == "all" {
        let all: Vec<_> = FAMILIES.iter().filter_map(|f| one(f)).collect();
        if all.is_empty() {
            let d = Diagnostic::new(Code::Unfit, "", "no loss of this operating point depends on a law");
            return Err(Box::new(d.hint("laws compute losses from teeth, oil and bearings; give some of them")));
        }
        return Ok(all);
    }
    let Some(known) = FAMILIES.iter().find(|f| **f == family) else {
        let message = format!("there is no family of laws `{}`", family.chars().take(64).collect::<String>());
        let d = Diagnostic::new(Code::UnknownName, "", message).suggest(family, FAMILIES.iter().copied());
        return Err(Box::new(d.hint(format!("the families are: {}, or all", FAMILIES.join(", ")))));
    };
    match one(known) {
        Some(found) => Ok(vec![found]),
        None => {
            let d = Diagnostic::new(Code::Unfit, "", format!("no loss of this operating point depends on {family}"));
            Err(Box::new(d.hint("what the family is about is not given, or given as a number")))
        }
    }
}

/// What is taken as uncertain when nothing is said, with the assumptions.
pub(super) fn quantities(question: &PointSetup<'_>) -> (Vec<Uncertain>, Vec<String>) {
    let model = question.model();
    let (train, document) = (model.train(), model.document());
    let (mut all, mut told) = (vec![], vec![]);
    let mut losses: Vec<String> = vec![];
    let mut roughness: Vec<String> = vec![];
    for (path, key) in document.quantities() {
        let Some(text) = document.value(&key) else { continue };
        let Some((value, unit)) = Reader::base_of(&text, key.measure) else { continue };
        let mut parts = path.rsplit('.');
        let is_efficiency = key.measure == Measure::Number
            && parts.clone().any(|p| matches!(p, "mesh_efficiency" | "efficiency" | "basic_efficiency"));
        let last = parts.next().unwrap_or_default();
        let distribution = if is_efficiency && value < 1.0 {
            losses.push(path.clone());
            let loss = LOSS * (1.0 - value);
            Distribution::Uniform { least: value - loss, most: value + loss }
        } else if last == "roughness" && value > 0.0 && train.is_physical() {
            roughness.push(path.clone());
            Distribution::Uniform { least: value * (1.0 - ROUGHNESS), most: value * (1.0 + ROUGHNESS) }
        } else {
            continue;
        };
        let target = Target::File(key);
        let likely = UncertainValue::Between(distribution);
        all.push(Uncertain { name: path, unit, likely, nominal: Some(text), target });
    }
    if !losses.is_empty() {
        told.push(format!("given efficiencies: the loss 1 − η is doubtful by ±20 % ({})", listed(&losses)));
    }
    if !roughness.is_empty() {
        told.push(format!("roughness is doubtful by ±20 % ({})", listed(&roughness)));
    }
    let varies = |l: &crate::train::Lubrication| !matches!(l.oil.viscosity, Viscosity::Fixed { .. });
    let follows = train.heat.is_some() && question.base().temperature.is_none();
    if follows {
        let key = document.find("heat.factor").expect("a key of [heat]");
        let text = document.value(&key).unwrap_or_else(|| "1".to_owned());
        let median = text.parse().unwrap_or(1.0);
        let likely = UncertainValue::Between(Distribution::Lognormal { median, factor: HEAT.exp() });
        let (name, unit, target) = ("heat.factor".into(), String::new(), Target::File(key));
        all.push(Uncertain { name, unit, likely, nominal: Some(text), target });
        told.push("what carries heat away is known within 25 % (one standard deviation)".into());
    }
    for (part, (factor, spread)) in
        LossPart::ALL.into_iter().zip(train.loss_factors.factors.into_iter().zip(train.loss_factors.spreads))
    {
        let Some(spread) = spread.filter(|s| *s > 0.0) else { continue };
        let name = format!("losses.factor.{}", part.key());
        let Ok(key) = document.find(&name) else { continue };
        let likely = UncertainValue::Between(Distribution::Lognormal { median: factor, factor: spread.exp() });
        told.push(format!("{name}: what tests leave open, {:.0} %", 100.0 * spread));
        let (unit, nominal, target) = (String::new(), Some(factor.to_string()), Target::File(key));
        all.push(Uncertain { name, unit, likely, nominal, target });
    }
    if !follows && train.is_physical() && train.lubrication.as_ref().is_some_and(varies) {
        let target = Target::Temperature;
        let text = nominal(&target, question).expect("there is an oil");
        let (value, unit) = Reader::base_of(&text, Measure::Number).expect("it was written as a number");
        let likely =
            UncertainValue::Between(Distribution::Uniform { least: value - TEMPERATURE, most: value + TEMPERATURE });
        all.push(Uncertain { name: "oil.temperature".into(), unit, likely, nominal: Some(text), target });
        told.push("the oil's temperature is doubtful by ±5 K".into());
    }
    // Tests say which friction there is, whatever the law.
    let tested = train.loss_factors.spreads[LossPart::Teeth as usize].is_some();
    if !tested
        && train.meshes.iter().any(|m| m.computed)
        && let Ok(found) = laws("mesh_friction", question)
    {
        let (laws, what): (Vec<_>, Vec<_>) = found.into_iter().unzip();
        all.extend(laws);
        told.extend(what);
    }
    (all, told)
}
