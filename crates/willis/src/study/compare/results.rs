//! Results in which variants differ: states of the shift table, and operations.

use crate::analysis::{self, Direction, Losses, Selection, SolutionReport, StateReport};
use crate::study::answer::{PointAnswer, PointVerdict};
use crate::study::cycle::EnergyKind;
use crate::train::{Load, Operation, Train};

use super::{CompareRequest, Compared, ComparedUnit, ComparedValue, Difference, ROUND_OFF, TextDifference};

/// A result of one variant.
struct Fact {
    quantity: String,
    /// Whether it is what is asked first: it stands first, however small its difference.
    is_headline: bool,
    unit: ComparedUnit,
    value: ComparedValue,
}

fn fact(quantity: impl Into<String>, unit: ComparedUnit, value: Option<f64>) -> Fact {
    let value = value.filter(|x| x.is_finite()).map_or(ComparedValue::None, ComparedValue::Number);
    Fact { quantity: quantity.into(), is_headline: false, unit, value }
}

fn word(quantity: &str, value: impl Into<String>) -> Fact {
    let value = ComparedValue::Word(value.into());
    Fact { quantity: quantity.into(), is_headline: false, unit: ComparedUnit::None, value }
}

fn headline(fact: Fact) -> Fact {
    Fact { is_headline: true, ..fact }
}

pub(super) fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUND_OFF * a.abs().max(b.abs()) || (a - b).abs() < 1e-12
}

/// Facts that differ between those variants that have any, and how many do not.
fn differences(all: &[Option<Vec<Fact>>]) -> (Vec<Difference>, usize) {
    let mut names: Vec<&Fact> = vec![];
    for f in all.iter().flatten().flatten() {
        if !names.iter().any(|n| n.quantity == f.quantity) {
            names.push(f);
        }
    }
    let (mut out, mut equal) = (vec![], 0);
    if all.iter().flatten().count() < 2 {
        return (vec![], equal);
    }
    for Fact { quantity, is_headline, unit, .. } in names {
        let values: Vec<ComparedValue> = all
            .iter()
            .map(|facts| {
                let own = facts.as_ref().and_then(|f| f.iter().find(|f| f.quantity == *quantity));
                own.map_or(ComparedValue::None, |f| f.value.clone())
            })
            .collect();
        // A variant without the state or operation at all is told once, elsewhere.
        let present: Vec<&ComparedValue> =
            values.iter().zip(all).filter(|(_, f)| f.is_some()).map(|(v, _)| v).collect();
        let is_same = present.windows(2).all(|w| match (w[0], w[1]) {
            (ComparedValue::Number(a), ComparedValue::Number(b)) => same(*a, *b),
            (a, b) => a == b,
        });
        if is_same {
            equal += 1;
            continue;
        }
        // An efficiency is as large as what it lacks to 1.
        let weigh = |x: f64| if *unit == ComparedUnit::Efficiency { 1.0 - x } else { x };
        let first = values[0].number();
        let against = |v: &ComparedValue| Some((first?, v.number()?));
        let size = present
            .iter()
            .flat_map(|a| present.iter().map(move |b| (a, b)))
            .map(|(a, b)| match (a, b) {
                (ComparedValue::Number(a), ComparedValue::Number(b)) => {
                    let most = weigh(*a).abs().max(weigh(*b).abs());
                    if most > 0.0 { ((a - b).abs() / most).min(2.0) } else { 0.0 }
                }
                (a, b) if a == b => 0.0,
                _ => 2.0,
            })
            .fold(0.0, f64::max);
        let difference = Difference {
            quantity: quantity.to_owned(),
            unit: *unit,
            differences: values.iter().map(|v| against(v).map(|(a, b)| b - a)).collect(),
            relative: values
                .iter()
                .map(|v| against(v).map(|(a, b)| (b - a) / weigh(a).abs()).filter(|r| r.is_finite()))
                .collect(),
            values,
            size,
        };
        out.push((*is_headline, difference));
    }
    // Stable: of equal ones in the order in which they are usually read.
    out.sort_by(|a, b| b.0.cmp(&a.0).then(b.1.size.total_cmp(&a.1.size)));
    (out.into_iter().map(|d| d.1).collect(), equal)
}

/// Names in the order in which variants have them.
fn union<'a>(all: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    let mut names = vec![];
    for name in all {
        if !names.contains(&name) {
            names.push(name);
        }
    }
    names
}

fn missing(present: impl Iterator<Item = bool>, labels: &[String]) -> Vec<String> {
    present.zip(labels).filter(|(is, _)| !is).map(|(_, l)| l.clone()).collect()
}

pub(super) fn states(trains: &[&Train], labels: &[String], request: &CompareRequest) -> Vec<Compared> {
    // Of operations that make no question the table knows nothing.
    let tables: Vec<_> = (trains.iter())
        .map(|t| {
            let mut bare = (*t).clone();
            bare.operations.clear();
            analysis::analyze(&bare, &Selection::default()).map(|a| a.ratios).unwrap_or_default()
        })
        .collect();
    let names = union(tables.iter().flat_map(|t| t.iter()).map(|(name, _)| name.as_str()));
    let mut all: Vec<Compared> = names
        .into_iter()
        .filter(|n| request.state.as_ref().is_none_or(|s| s == n))
        .map(|name| {
            let own: Vec<Option<&StateReport>> = tables.iter().map(|t| t.get(name)).collect();
            let facts: Vec<_> = own.iter().map(|s| s.map(state_facts)).collect();
            let (differences, equal) = differences(&facts);
            let reason = |s: &StateReport| -> Option<String> {
                s.no_ratio.clone().or(s.drive.reason.clone()).or(s.coast.reason.clone())
            };
            let reasons = own.iter().zip(labels).filter_map(|(s, l)| Some((l.clone(), reason((*s)?)?))).collect();
            let missing_in = missing(own.iter().map(Option::is_some), labels);
            let reasons = if differences.is_empty() { vec![] } else { reasons };
            Compared { name: name.to_owned(), missing_in, prescribed: vec![], differences, equal, reasons }
        })
        .collect();
    all.sort_by(|a, b| b.size().total_cmp(&a.size()));
    all
}

fn state_facts(s: &StateReport) -> Vec<Fact> {
    let verdict = |d: &Direction| PointVerdict::from(d.verdict).name();
    vec![
        fact("ratio", ComparedUnit::None, s.value),
        fact("step", ComparedUnit::None, s.step),
        fact("efficiency driving", ComparedUnit::Efficiency, s.drive.efficiency),
        fact("efficiency coasting", ComparedUnit::Efficiency, s.coast.efficiency),
        word("verdict driving", verdict(&s.drive)),
        word("verdict coasting", verdict(&s.coast)),
    ]
}

pub(super) fn operations(trains: &[&Train], labels: &[String], request: &CompareRequest) -> Vec<Compared> {
    let state = |t: &Train, o: &Operation| o.state.map(|k| t.states()[k].name.clone());
    let names = union(trains.iter().flat_map(|t| t.operations()).map(|o| o.name.as_str()));
    let mut all: Vec<Compared> = names
        .into_iter()
        .filter(|n| request.operation.as_ref().is_none_or(|o| o == n))
        .filter_map(|name| {
            let own: Vec<Option<&Operation>> =
                trains.iter().map(|t| t.operations().iter().find(|o| o.name == name)).collect();
            let in_state = |(t, o): (&&Train, &Option<&Operation>)| o.is_some_and(|o| state(t, o) == request.state);
            if request.state.is_some() && !trains.iter().zip(&own).any(in_state) {
                return None;
            }
            let answers: Vec<Option<PointAnswer>> =
                trains.iter().zip(&own).map(|(t, o)| o.map(|o| PointAnswer::of(t, o))).collect();
            let facts: Vec<_> = answers.iter().map(|a| a.as_ref().map(operation_facts)).collect();
            let (differences, equal) = differences(&facts);
            let reasons: Vec<(String, String)> = (answers.iter().zip(labels))
                .filter_map(|(a, l)| Some((l.clone(), a.as_ref()?.reason.clone())))
                .filter(|r| !r.1.is_empty())
                .collect();
            let points: Vec<_> = trains.iter().zip(&own).map(|(t, o)| o.map(|o| point(t, o))).collect();
            Some(Compared {
                name: name.to_owned(),
                missing_in: missing(own.iter().map(Option::is_some), labels),
                prescribed: prescribed(&points),
                differences,
                equal,
                reasons,
            })
        })
        .collect();
    all.sort_by(|a, b| b.size().total_cmp(&a.size()));
    all
}

/// What an operation prescribes, in words.
pub(super) fn point(train: &Train, o: &Operation) -> Vec<(String, String)> {
    let mut all = vec![];
    if let Some(k) = o.state {
        all.push(("state".to_owned(), train.states()[k].name.clone()));
    }
    let name = |m| train.member_name(m);
    let short = |x: f64| format!("{:.6e}", x).parse::<f64>().unwrap_or(x).to_string();
    for (m, w) in &o.speeds {
        all.push((format!("speed of {}", name(*m)), format!("{} rpm", short(w.si() * 30.0 / std::f64::consts::PI))));
    }
    for (m, load) in &o.loads {
        let text = match load {
            Load::Torque(q) => format!("torque {} N m", short(q.si())),
            Load::Power(q) => format!("power {} W", short(q.si())),
        };
        all.push((format!("load at {}", name(*m)), text));
    }
    if !o.fixed.is_empty() {
        all.push(("held".into(), o.fixed.iter().map(|m| name(*m)).collect::<Vec<_>>().join(", ")));
    }
    if let Some(t) = o.temperature.or(train.lubrication.as_ref().map(|l| l.temperature)) {
        all.push(("oil".into(), format!("{} degC", short(t - 273.15))));
    }
    all
}

/// In what operations of one name differ.
pub(super) fn prescribed(points: &[Option<Vec<(String, String)>>]) -> Vec<TextDifference> {
    let names = union(points.iter().flatten().flatten().map(|p| p.0.as_str()));
    let value = |p: &Option<Vec<(String, String)>>, name: &str| {
        p.as_ref().and_then(|p| p.iter().find(|x| x.0 == name)).map(|x| x.1.clone())
    };
    let all = names
        .into_iter()
        .map(|name| TextDifference { path: name.to_owned(), values: points.iter().map(|p| value(p, name)).collect() });
    all.filter(|d| {
        let mut present = d.values.iter().zip(points).filter(|(_, p)| p.is_some()).map(|(v, _)| v);
        let first = present.next();
        present.any(|v| Some(v) != first)
    })
    .collect()
}

fn operation_facts(answer: &PointAnswer) -> Vec<Fact> {
    let mut all = vec![word("verdict", answer.verdict.name())];
    if let Some(s) = &answer.solution {
        solution_facts(s, &mut all);
    }
    all
}

fn solution_facts(s: &SolutionReport, all: &mut Vec<Fact>) {
    all.push(headline(fact("efficiency", ComparedUnit::Efficiency, s.efficiency)));
    all.push(fact("input power", ComparedUnit::Watt, Some(s.input_power_w)));
    all.push(fact("output power", ComparedUnit::Watt, Some(s.output_power_w)));
    all.push(headline(fact("loss", ComparedUnit::Watt, Some(s.loss_w))));
    if s.sources.is_empty() {
        all.extend(
            s.meshes.iter().map(|(name, m)| fact(format!("loss in {name}"), ComparedUnit::Watt, Some(m.loss_w))),
        );
    } else {
        for (k, (name, loss)) in Losses::NAMES.iter().zip(s.losses_w.all()).enumerate() {
            // The first five stand in every answer, the others where there are any.
            if k < 5 || loss != 0.0 || (*name == "variator" && !s.variators.is_empty()) {
                let all_of = match *name {
                    "mesh" => "meshes",
                    "windage" | "churning" | "injection" => name,
                    "shift-element" => "open shift elements",
                    other => &format!("{other}s"),
                };
                all.push(fact(format!("loss in all {all_of}"), ComparedUnit::Watt, Some(loss)));
            }
        }
        for x in &s.sources {
            let kind = EnergyKind::from(x.kind).name();
            all.push(fact(format!("loss in {} ({kind})", x.name), ComparedUnit::Watt, Some(x.loss_w)));
        }
    }
    for (name, v) in s.variators.iter() {
        all.push(fact(format!("power through {name}"), ComparedUnit::Watt, Some(v.power_w)));
        if s.sources.is_empty() {
            all.push(fact(format!("loss in {name}"), ComparedUnit::Watt, Some(v.loss_w)));
        }
        for (side, m) in v.machines.iter() {
            let torque = Some(m.torque_n_m);
            all.push(fact(format!("torque of {name} at {side}"), ComparedUnit::NewtonMetre, torque));
        }
    }
    for (name, m) in s.members.iter() {
        all.push(fact(format!("torque on {name}"), ComparedUnit::NewtonMetre, m.torque_n_m));
    }
    for (name, m) in s.members.iter() {
        all.push(fact(format!("speed of {name}"), ComparedUnit::RadianPerSecond, m.speed_rad_s));
    }
    for (name, e) in s.shift_elements.iter() {
        all.push(fact(format!("torque of {} {name}", e.kind), ComparedUnit::NewtonMetre, e.torque_n_m));
    }
    for (name, c) in s.contacts.iter() {
        all.push(fact(format!("contact pressure in {name}"), ComparedUnit::Pascal, Some(c.pressure_pa)));
        all.push(fact(format!("film ratio in {name}"), ComparedUnit::None, c.film_ratio));
    }
    all.push(fact(
        "circulating power",
        ComparedUnit::Watt,
        Some(s.recirculation.iter().map(|r| r.power_w).fold(0.0, f64::max)),
    ));
    all.push(fact("factor on all losses that locks", ComparedUnit::None, s.margin.lock_loss_factor));
    if let Some(b) = &s.margin.torque {
        all.push(fact(
            format!("torque on {} that unloads {}", b.member, b.mesh),
            ComparedUnit::NewtonMetre,
            Some(b.boundary),
        ));
    }
}
