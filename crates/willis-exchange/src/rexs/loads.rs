//! Terminals, the shift table and operating points.

use serde::{Deserialize, Serialize};
use willis::kinematics::Configuration;
use willis::train::{MemberId, ShiftElementId, Train};

use crate::account::{Account, At, Is};
use crate::document::{Component, Document};
use crate::text::{key, plain, quantity, quoted};

use super::bodies::{Bodies, Kind};
use super::gears::{Frame, dot};
use super::sets::Written;

/// A load case of the file and the operation that it became.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct LoadCaseReport {
    /// Its number in the file; none for a file without load cases.
    pub load_case: Option<i64>,
    /// The name of the operation; none if the case is left out, as the problems tell.
    pub operation: Option<String>,
    /// Its part of the operating time, where the file gives it.
    pub share: Option<f64>,
    /// Speed of the first driven shaft, rpm, and torque on it, N m, or power, kW: the row of a load spectrum.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub columns: Vec<Column>,
}

/// A column of a load spectrum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Column {
    /// What it is: `sun.speed [rpm]`.
    pub name: String,
    /// Its value.
    pub value: f64,
}

/// A shaft whose speed may be told, or a load.
#[derive(Clone, Debug)]
struct Source {
    component: usize,
    body: usize,
    /// The shaft that says where it points.
    shaft: usize,
    member: String,
}

/// What acts on a terminal: what is given first has the lowest rank; a power in kW (true) or a torque in N m, if known.
type OnTerminal = (u8, MemberId, String, Option<(bool, f64)>);

pub struct Loads {
    pub terminals: Vec<String>,
    speeds: Vec<Source>,
    torques: Vec<Source>,
}

fn components_of(account: &Account<'_>, kind: &str) -> Vec<usize> {
    let all = &account.document.components;
    (0..all.len()).filter(|&k| all[k].kind == kind).collect()
}

/// What every load case is looked at for: components that may tell a speed, a load or a temperature, with what they have.
pub fn weight(document: &Document) -> usize {
    let told = |c: &&Component| ["shaft", "external_load", "gear_unit", "gear_casing"].contains(&c.kind.as_str());
    document.components.iter().filter(told).map(|c| 1 + c.attributes.len()).sum()
}

impl Loads {
    /// Where torques act.
    pub fn new(account: &mut Account<'_>, bodies: &mut Bodies, written: &Written) -> Self {
        let cases = account.document.cases.len();
        let mut loads = Self { terminals: vec![], speeds: vec![], torques: vec![] };
        for component in components_of(account, "external_load") {
            let at = At::model(component);
            let body = bodies.root(component);
            let transmits = account.flag(at, "transmits_torque", "terminals");
            let gives = |id: &str| {
                (0..=cases).any(|case| account.in_case(case, component).is_some_and(|at| account.has(at, id)))
            };
            if !transmits.unwrap_or_else(|| gives("torque_around_u_axis") || gives("power")) {
                continue;
            }
            if bodies.is_frame(body) {
                continue;
            }
            let Some(member) = written.rotors.get(&body).filter(|m| written.members.contains(m)) else {
                account.problem(account.called(at), "it acts on a part that no gear turns and is left out");
                continue;
            };
            if loads.torques.iter().any(|l| l.body == body) {
                account
                    .problem(account.called(at), "a second load on the same shaft; its torque is added to the first");
            } else {
                loads.terminals.push(member.clone());
            }
            let shaft = bodies.first(account, body, Kind::Shaft).unwrap_or(component);
            loads.torques.push(Source { component, body, shaft, member: member.clone() });
        }
        for component in components_of(account, "shaft") {
            let body = bodies.root(component);
            let is_free = !bodies.is_frame(body) && !written.planets.contains_key(&body);
            if let Some(member) = written.rotors.get(&body).filter(|_| is_free) {
                loads.speeds.push(Source { component, body, shaft: component, member: member.clone() });
            }
        }
        // With less than two there is nothing to analyse.
        if loads.terminals.len() < 2 {
            let ends = written.ends.iter().filter(|(body, many)| **many == 1 && !bodies.is_frame(**body));
            let ends: Vec<usize> = ends.map(|(body, _)| *body).collect();
            for body in ends {
                let name = bodies.name(account, body);
                if !loads.terminals.contains(&name) && written.members.contains(&name) {
                    loads.terminals.push(name);
                }
            }
            let taken = loads.terminals.join(", ");
            account.guess(
                "terminals",
                taken,
                "the file has less than two loads that transmit torque: shafts with one gear",
            );
        }
        loads
    }

    /// Operations of the load cases, or of the model itself, in the text of the train file.
    pub fn operations(&self, account: &mut Account<'_>, frame: &Frame, train: &Train) -> (String, Vec<LoadCaseReport>) {
        let mut out = String::new();
        let mut reports = vec![];
        let cases = account.document.cases.len();
        let base = temperature(account);
        for case in if cases == 0 { 0..=0 } else { 1..=cases } {
            let id = (case > 0).then(|| account.document.cases[case - 1].id);
            let unit = account.unit;
            let of_unit = |account: &Account<'_>, case| unit.and_then(|k| account.in_case(case, k));
            let share = of_unit(account, case)
                .and_then(|at| account.number(at, "operating_time_fraction", Is::Share, "share of the load spectrum"))
                .filter(|s| (0.0..=1.0).contains(s));
            let name = match (id, share) {
                (None, _) => "of the file".to_owned(),
                (Some(id), None) => format!("load case {id}"),
                (Some(id), Some(s)) => {
                    format!("load case {id} ({} % of the time)", plain(crate::account::rounded(s * 100.0)))
                        .replace('.', ",")
                }
            };
            let name = if reports.iter().any(|r: &LoadCaseReport| r.operation.as_ref() == Some(&name)) {
                format!("{name}, number {case}")
            } else {
                name
            };
            let place = id.map_or("the model".to_owned(), |id| format!("load case {id}"));
            let index = |account: &mut Account<'_>| {
                let own = [case, 0].into_iter().filter_map(|c| of_unit(account, c)).collect::<Vec<_>>();
                own.into_iter().find_map(|at| account.integer(at, "gear_shift_index", "operation.state"))
            };
            let state = match train.states() {
                [] => None,
                states => {
                    let k = index(account).unwrap_or(1);
                    let found = usize::try_from(k - 1).ok().filter(|k| *k < states.len());
                    if found.is_none() {
                        account.problem(&*place, format!("there is no gear {k}; gear 1 is taken"));
                    }
                    Some(found.unwrap_or(0))
                }
            };
            let mut report = LoadCaseReport { load_case: id, operation: None, share, columns: vec![] };
            match self.operation(account, frame, train, case, state) {
                Ok((lines, columns)) => {
                    out.push_str(&format!("\n[[operation]]\nname = {}\n", quoted(&name)));
                    if let Some(state) = state {
                        out.push_str(&format!("state = {}\n", quoted(&train.states()[state].name)));
                    }
                    out.push_str(&lines);
                    let own = temperature_in(account, case).or(base);
                    if let Some(t) = own {
                        if own != base {
                            out.push_str(&format!("temperature = {}\n", quantity(t, "degC")));
                        }
                        report.columns.push(Column { name: "oil.temperature [degC]".into(), value: t });
                    }
                    report.operation = Some(name);
                    report.columns.splice(0..0, columns);
                }
                Err(why) => {
                    let is_empty = case == 0 && why.is_empty();
                    if is_empty {
                        continue;
                    }
                    account.problem(&*place, format!("it is left out: {why}"));
                }
            }
            reports.push(report);
        }
        (out, reports)
    }

    /// One operation: as many speeds and torques as the train takes; those that the file calls given come first.
    fn operation(
        &self,
        account: &mut Account<'_>,
        frame: &Frame,
        train: &Train,
        case: usize,
        state: Option<usize>,
    ) -> Result<(String, Vec<Column>), String> {
        let scopes = if case == 0 { vec![0] } else { vec![case, 0] };
        let mut speeds: Vec<(bool, MemberId, String, f64)> = vec![];
        for source in &self.speeds {
            let found: Vec<At> = scopes.iter().filter_map(|c| account.in_case(*c, source.component)).collect();
            let speed =
                found.iter().find_map(|at| account.number(*at, "rotational_speed", Is::Speed, "operation.speeds"));
            let Some(speed) = speed else { continue };
            let defines = found.iter().find_map(|at| account.flag(*at, "defines_speed", "operation.speeds"));
            let Some(member) = train.member(&source.member) else { continue };
            let speed = self.sign(account, source.shaft, frame) * speed;
            match speeds.iter().find(|s| s.1 == member) {
                Some(other) if (other.3 - speed).abs() > 1e-6 * speed.abs() => {
                    let message =
                        format!("its speed {speed} rpm is not that of the part it is joined to, {} rpm", other.3);
                    account.problem(account.called(At::model(source.component)), message);
                }
                Some(_) => {}
                None => speeds.push((defines.unwrap_or(false), member, source.member.clone(), speed)),
            }
        }
        let mut loads: Vec<OnTerminal> = vec![];
        for name in &self.terminals {
            let Some(member) = train.member(name) else { continue };
            let mut sum: Option<(bool, f64)> = None;
            let mut rank = 2;
            for source in self.torques.iter().filter(|l| l.member == *name) {
                let found: Vec<At> = scopes.iter().filter_map(|c| account.in_case(*c, source.component)).collect();
                let defines = found.iter().find_map(|at| account.flag(*at, "defines_torque", "operation.torques"));
                let read = |account: &mut Account<'_>, id: &str, is: Is| {
                    found.iter().find_map(|at| account.number(*at, id, is, "operation.torques"))
                };
                let torque = read(account, "torque_around_u_axis", Is::Torque);
                let own = match torque {
                    Some(t) => Some((false, self.sign(account, source.shaft, frame) * t)),
                    None => read(account, "power", Is::Power).map(|p| (true, p)),
                };
                let Some((is_power, x)) = own else { continue };
                rank = rank.min(if defines == Some(true) { 0 } else { 1 });
                sum = match sum {
                    Some((before, y)) if before == is_power => Some((is_power, x + y)),
                    Some(_) => return Err("a torque and a power on one shaft".into()),
                    None => Some((is_power, x)),
                };
            }
            loads.push((rank, member, name.clone(), sum));
        }
        if speeds.is_empty() && loads.iter().all(|l| l.3.is_none()) {
            return Err(String::new());
        }
        speeds.sort_by_key(|s| !s.0);
        loads.sort_by_key(|l| l.0);
        let engaged: &[ShiftElementId] = state.map_or(&[], |k| &train.states()[k].engaged);
        let motion = Configuration::new(train, engaged, &[], train.terminals());
        let order: Vec<MemberId> = speeds.iter().map(|s| s.1).collect();
        let settling = motion.settling(&order);
        let freedoms = motion.degrees_of_freedom();
        if settling.len() < freedoms {
            return Err(format!("it gives {} of {freedoms} independent speeds", settling.len()));
        }
        let order: Vec<MemberId> = loads.iter().map(|l| l.1).collect();
        let needed = motion.loading(&order);
        let lacking: Vec<&str> =
            loads.iter().filter(|l| needed.contains(&l.1) && l.3.is_none()).map(|l| l.2.as_str()).collect();
        if !lacking.is_empty() {
            return Err(format!("it gives no torque on {}", lacking.join(" and ")));
        }
        let mut columns = vec![];
        let speeds: Vec<String> = speeds
            .iter()
            .filter(|s| settling.contains(&s.1))
            .map(|s| {
                columns.push(Column { name: format!("{}.speed [rpm]", s.2), value: s.3 });
                format!("{} = {}", key(&s.2), quantity(s.3, "rpm"))
            })
            .collect();
        let mut of = |wanted: bool, unit: &str, what: &str| -> Vec<String> {
            let all = loads.iter().filter(|l| needed.contains(&l.1));
            let own = all.filter_map(|l| Some((&l.2, l.3.filter(|(is_power, _)| *is_power == wanted)?.1)));
            own.map(|(name, x)| {
                columns.push(Column { name: format!("{name}.{what} [{unit}]"), value: x });
                format!("{} = {}", key(name), quantity(x, unit))
            })
            .collect()
        };
        let torques = of(false, "N m", "torque");
        let powers = of(true, "kW", "power");
        let mut lines = format!("speeds = {{ {} }}\n", speeds.join(", "));
        for (name, all) in [("torques", torques), ("powers", powers)] {
            if !all.is_empty() {
                lines.push_str(&format!("{name} = {{ {} }}\n", all.join(", ")));
            }
        }
        Ok((lines, columns))
    }

    /// 1 where a shaft points along the main axis, -1 where it points the other way.
    fn sign(&self, account: &mut Account<'_>, shaft: usize, frame: &Frame) -> f64 {
        let at = At::model(shaft);
        if !account.has(at, "u_axis_vector") {
            return 1.0;
        }
        match account.vector(at, "u_axis_vector", "direction of rotation") {
            Some(u) if dot(u, frame.u) < 0.0 => -1.0,
            _ => 1.0,
        }
    }
}

fn temperature_in(account: &mut Account<'_>, case: usize) -> Option<f64> {
    let housing = components_of(account, "gear_casing");
    let found: Vec<At> = housing.into_iter().filter_map(|k| account.in_case(case, k)).collect();
    found.into_iter().find_map(|at| account.number(at, "temperature_lubricant", Is::Temperature, "oil.temperature"))
}

/// Temperature of the oil: of the model itself, or of its first load case.
pub fn temperature(account: &mut Account<'_>) -> Option<f64> {
    let first = usize::from(!account.document.cases.is_empty());
    temperature_in(account, 0).or_else(|| temperature_in(account, first))
}

/// Shift elements and the shift table.
pub fn shifting(account: &mut Account<'_>, bodies: &mut Bodies, written: &mut Written) -> String {
    let mut out = String::new();
    let mut elements = vec![];
    let couplings = std::mem::take(&mut bodies.couplings);
    for coupling in &couplings {
        let roots = coupling.bodies.map(|b| bodies.root(b));
        let known = |b: usize| bodies.is_frame(b) || written.rotors.contains_key(&b);
        if !roots.iter().all(|b| known(*b)) || roots[0] == roots[1] {
            account
                .problem(format!("coupling `{}`", coupling.name), "it joins nothing that gears turn; it is left out");
            continue;
        }
        let members = roots.map(|b| bodies.name(account, b));
        let held: Vec<String> = members.iter().filter(|m| *m != "frame").map(|m| quoted(m)).collect();
        let kind = if held.len() == 1 { "brake" } else { "clutch" };
        out.push_str(&format!(
            "\n[[shift_element]]\nname = {}\nkind = \"{kind}\"\nmembers = [{}]\n",
            quoted(&coupling.name),
            held.join(", ")
        ));
        elements.push(coupling);
    }
    if !elements.is_empty() {
        for gear in 0..bodies.gears {
            let closed: Vec<String> = elements.iter().filter(|c| c.engaged[gear]).map(|c| quoted(&c.name)).collect();
            out.push_str(&format!("\n[[state]]\nname = \"{}\"\nengaged = [{}]\n", gear + 1, closed.join(", ")));
        }
    }
    out
}
