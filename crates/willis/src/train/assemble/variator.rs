//! Variators: two members and an efficiency, or machines on a bus with their maps and limits.

use std::collections::HashSet;

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::train::assembler::{Assembler, unique};
use crate::train::csv;
use crate::train::specification::{MachineEfficiencySpec, MachineSpec, StoreSpec, VariatorSpec};
use crate::train::variator::{EfficiencyMap, Machine, MachineEfficiency, Store, Variator, VariatorPath};
use crate::train::words::{clip, list};
use crate::train::{Efficiency, FRAME, MemberId};
use crate::units::{self, Dimension, Power};

/// Most machines on one bus.
const MOST_MACHINES: usize = 16;
/// Most points of a map.
const MOST_POINTS: usize = 1 << 18;

impl Assembler<'_> {
    pub fn variators(&mut self, all: &[VariatorSpec]) -> Vec<Variator> {
        unique(self, "variator", "variator", all.iter().map(|v| v.name.as_str()));
        let machines = all.iter().flat_map(|v| &v.machines);
        let mut seen = HashSet::new();
        for name in machines.map(|m| m.name.as_str()).filter(|n| !seen.insert(*n)).collect::<Vec<_>>() {
            let message = format!("a second machine is called `{}`", clip(name));
            self.report(Diagnostic::new(Code::DuplicateName, "variator", message).hint("give it another name"));
        }
        (all.iter().enumerate()).filter_map(|(k, spec)| self.variator(spec, format!("variator[{k}]"))).collect()
    }

    fn variator(&mut self, spec: &VariatorSpec, place: String) -> Option<Variator> {
        let key = |name: &str| format!("{place}.{name}");
        let bus = !spec.machines.is_empty();
        let wrong = |given: bool, name: &'static str| given.then_some(name);
        let misplaced: Vec<&str> = match bus {
            true => [
                wrong(!spec.members.is_empty(), "members"),
                wrong(spec.efficiency.is_some(), "efficiency"),
                wrong(spec.ratio.is_some(), "ratio"),
            ],
            false => [wrong(!spec.store.0.is_empty(), "store"), wrong(spec.standby.is_some(), "standby"), None],
        }
        .into_iter()
        .flatten()
        .collect();
        for name in &misplaced {
            let (message, hint) = match bus {
                true => (
                    format!("`{name}` describes a variator as a whole, and this one has `machines`"),
                    "give each machine its member and efficiency, or leave `machines` out",
                ),
                false => (
                    format!("`{name}` belongs to a bus, and this variator has none"),
                    "describe it by `machines` instead of `members`",
                ),
            };
            self.report(Diagnostic::new(Code::Variator, key(name), message).hint(hint));
        }
        let path = match bus {
            true => self.bus(spec, &place)?,
            false => self.direct(spec, &place)?,
        };
        let kind = spec.kind.unwrap_or_default();
        misplaced.is_empty().then(|| Variator { name: spec.name.clone(), kind, path, place: place.clone() })
    }

    /// A member that a variator acts on.
    fn acted_on(&mut self, name: &str, place: &str) -> Option<MemberId> {
        let id = self.resolve(name, &place)?;
        if id == FRAME {
            let d = Diagnostic::new(Code::Variator, place, "the frame is at rest: no power passes through it");
            self.report(d.hint("name a member that turns; what holds a member is a brake"));
            return None;
        }
        Some(id)
    }

    fn direct(&mut self, spec: &VariatorSpec, place: &str) -> Option<VariatorPath> {
        let at = format!("{place}.members");
        if spec.members.len() != 2 {
            let message = match spec.members.len() {
                0 => "a variator has `members` and an `efficiency`, or `machines` on a bus; here is neither".to_owned(),
                1 => "a variator joins two members, here is one".to_owned(),
                n => format!("a variator joins two members, here are {n}: more than two meet on a bus"),
            };
            let hint = match spec.members.len() {
                0 => "members = [\"a\", \"b\"], efficiency = 0.85",
                _ => "for a bus: machines = [{ name = \"mg1\", member = \"sun\", efficiency = 0.92 }, …]",
            };
            self.report(Diagnostic::new(Code::Variator, at, message).hint(hint));
            return None;
        }
        let ids: Vec<_> =
            spec.members.iter().enumerate().map(|(k, m)| self.acted_on(m, &format!("{at}[{k}]"))).collect();
        let [first, second] = [ids[0]?, ids[1]?];
        if first == second {
            let message = format!("a variator between `{}` and itself passes nothing on", clip(&spec.members[0]));
            self.report(Diagnostic::new(Code::Variator, at, message).hint("name two different members"));
            return None;
        }
        let efficiency = match &spec.efficiency {
            Some(e) => self.efficiency(e, &format_args!("{place}.efficiency")),
            None => {
                self.assume(&spec.name, "no efficiency given, taken as lossless");
                Efficiency::lossless()
            }
        };
        let [least, most] = spec.ratio.as_ref().map_or([None, None], |r| [r.min, r.max]);
        for (key, value) in [("min", least), ("max", most)] {
            if let Some(x) = value.filter(|x| !x.is_finite()) {
                let message = format!("a ratio of {x}: it is a finite number");
                self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.ratio.{key}"), message));
            }
        }
        if let (Some(low), Some(high)) = (least, most)
            && low > high
        {
            let message = format!("the least ratio is {low} and the greatest is {high}");
            self.report(Diagnostic::new(Code::Variator, format!("{place}.ratio"), message).hint("exchange the two"));
        }
        Some(VariatorPath::Direct { members: [first, second], efficiency, ratio: [least, most] })
    }

    fn bus(&mut self, spec: &VariatorSpec, place: &str) -> Option<VariatorPath> {
        let at = format!("{place}.machines");
        if spec.machines.len() > MOST_MACHINES {
            let message = format!("{} machines on one bus: at most {MOST_MACHINES}", spec.machines.len());
            self.report(Diagnostic::new(Code::TooLarge, at, message));
            return None;
        }
        let store = match &spec.store.0[..] {
            [] => Store::Power(Power::exact(Rational::ZERO).into()),
            [(name, power)] if name.is_empty() => match power {
                Some(power) => Store::Power(power.clone().into()),
                None => Store::Free,
            },
            _ => {
                let message = "a variator has one store, and here are names".to_owned();
                let d = Diagnostic::new(Code::Variator, format!("{place}.store"), message);
                self.report(d.hint("write its power, \"5 kW\", or \"free\""));
                return None;
            }
        };
        if let ([_], true) = (&spec.machines[..], matches!(&store, Store::Power(q) if q.value.is_zero())) {
            let message = "one machine on a bus without a store: nothing gives or takes its power";
            let hint = "add a second machine, or `store` with a power or \"free\"";
            self.report(Diagnostic::new(Code::Variator, at.clone(), message).hint(hint));
        }
        let standby = spec.standby.as_ref().map_or(0.0, Power::si);
        if !(0.0..1e12).contains(&standby) {
            let message = format!("a standby loss of {standby} W: it is from 0 to 1e12 W");
            self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.standby"), message));
        }
        let machines: Vec<_> =
            (spec.machines.iter().enumerate()).map(|(k, m)| self.machine(m, &format!("{at}[{k}]"))).collect();
        Some(VariatorPath::Bus { machines: machines.into_iter().collect::<Option<_>>()?, store, standby })
    }

    fn machine(&mut self, spec: &MachineSpec, place: &str) -> Option<Machine> {
        super::check_name(self, &spec.name, &format!("{place}.name"), false);
        let (name, key) = match &spec.member {
            Some(member) => (member, "member"),
            None => (&spec.name, "name"),
        };
        let member = self.acted_on(name, &format!("{place}.{key}"));
        let efficiency = match &spec.efficiency {
            Some(MachineEfficiencySpec::Constant(e)) => {
                Some(MachineEfficiency::Constant(self.efficiency(e, &format_args!("{place}.efficiency"))))
            }
            Some(MachineEfficiencySpec::Map(file)) => {
                self.map(file, &format!("{place}.efficiency.map")).map(MachineEfficiency::Map)
            }
            None => {
                self.assume(&spec.name, "no efficiency given, taken as lossless");
                Some(MachineEfficiency::Constant(Efficiency::lossless()))
            }
        };
        let limits = [
            ("torque", "N m", spec.torque.as_ref().map(|x| x.si())),
            ("power", "W", spec.power.as_ref().map(|x| x.si())),
            ("speed", "rad/s", spec.speed.as_ref().map(|x| x.si())),
        ];
        for (key, unit, limit) in limits {
            if let Some(limit) = limit.filter(|x| !(*x > 0.0 && x.is_finite())) {
                let message = format!("a limit of {limit} {unit}: it is above 0, for both directions");
                self.report(Diagnostic::new(Code::OutOfRange, format!("{place}.{key}"), message));
            }
        }
        let [torque, power, speed] = limits.map(|l| l.2);
        Some(Machine { name: spec.name.clone(), member: member?, efficiency: efficiency?, torque, power, speed })
    }

    /// The map of a machine from the table that the train names. Nothing of the table is shown: a train file from somebody
    /// else may name any file.
    fn map(&mut self, file: &str, place: &str) -> Option<EfficiencyMap> {
        if !self.files.contains_key(file) {
            let text = (self.load)(file);
            self.files.insert(file.to_owned(), text);
        }
        match &self.files[file] {
            Err(why) => {
                let why = why.clone();
                self.report(Diagnostic::new(Code::Unreadable, place, why));
                None
            }
            Ok(text) => match read_map(file, text) {
                Ok(map) => Some(map),
                Err(wrong) => {
                    for message in wrong {
                        let hint = "columns `speed [rpm]`, `torque [N m]` and `efficiency`, one row for each speed with \
                                    each torque";
                        let message = format!("{}: {message}", clip(file));
                        self.report(Diagnostic::new(Code::BadTable, place, message).hint(hint));
                    }
                    None
                }
            },
        }
    }

    /// What an operation says of the stores.
    pub fn stores(&mut self, spec: &StoreSpec, variators: &[Variator], place: &str) -> Vec<(usize, Store)> {
        let place = format!("{place}.store");
        let buses: Vec<usize> = (0..variators.len()).filter(|&k| variators[k].has_bus()).collect();
        let names = || buses.iter().map(|&k| variators[k].name.as_str()).collect::<Vec<_>>();
        let mut all: Vec<(usize, Store)> = Vec::new();
        for (name, power) in &spec.0 {
            let found = match (name.is_empty(), &buses[..]) {
                (true, [only]) => Some(*only),
                (true, _) => None,
                (false, _) => buses.iter().copied().find(|&k| variators[k].name == *name),
            };
            let Some(k) = found else {
                let message = match (name.is_empty(), buses.len()) {
                    (_, 0) => "the train has no variator with machines on a bus, so there is no store".to_owned(),
                    (true, n) => format!("the train has {n} buses, so a store has a name"),
                    (false, _) => format!("there is no variator with a bus that is called `{}`", clip(name)),
                };
                let hint = match buses.is_empty() {
                    true => "describe one as [[variator]] with `machines`".to_owned(),
                    false => format!("the variators with a bus are: {}", list(names())),
                };
                self.report(Diagnostic::new(Code::UnknownName, place.clone(), message).hint(hint));
                continue;
            };
            let store = power.as_ref().map_or(Store::Free, |p| Store::Power(p.clone().into()));
            all.push((k, store));
        }
        all
    }
}

/// Reads a map; else what is wrong with it, bounded.
fn read_map(file: &str, text: &str) -> Result<EfficiencyMap, Vec<String>> {
    let mut rows = csv::rows(text);
    let Some(header) = rows.next() else { return Err(vec!["the file is empty".into()]) };
    if header.count > csv::MOST_COLUMNS {
        return Err(vec![csv::too_many(header.count)]);
    }
    let column = |name: &str, dimension: Option<Dimension>| -> Result<(usize, f64), String> {
        let titled = header.cells.iter().enumerate().filter_map(|(k, cell)| {
            let (title, unit) = match cell.text.split_once('[') {
                Some((title, unit)) => (title.trim(), unit.trim_end().strip_suffix(']').map(str::trim)),
                None => (cell.text.trim(), None),
            };
            (title == name).then_some((k, unit))
        });
        let found: Vec<_> = titled.collect();
        let [(k, unit)] = found[..] else {
            return Err(match found.len() {
                0 => format!("there is no column `{name}` in line {}", header.line),
                n => format!("there are {n} columns `{name}` in line {}", header.line),
            });
        };
        let factor = match (dimension, unit) {
            (None, None) => 1.0,
            (None, Some("%")) => 0.01,
            (None, Some(_)) => return Err(format!("the unit of `{name}` is none, or %")),
            (Some(dimension), None) => {
                let (_, example) = dimension.describe();
                let unit = example.split_once(' ').map_or("", |e| e.1);
                return Err(format!("the column `{name}` has no unit: write `{name} [{unit}]`"));
            }
            (Some(dimension), Some(unit)) => match units::parse(&format!("1 {unit}"), dimension) {
                Ok(one) => one.si(),
                Err(_) => return Err(format!("the unit of `{name}` is none of its kind")),
            },
        };
        Ok((k, factor))
    };
    let columns = [
        column("speed", Some(Dimension::ANGULAR_SPEED)),
        column("torque", Some(Dimension::TORQUE)),
        column("efficiency", None),
    ];
    let wrong: Vec<String> = columns.iter().filter_map(|c| c.as_ref().err().cloned()).collect();
    let [Ok(speed), Ok(torque), Ok(efficiency)] = columns else { return Err(wrong) };
    let (mut points, mut wrong): (Vec<[f64; 3]>, Vec<String>) = (vec![], vec![]);
    for row in rows {
        let line = row.line;
        if wrong.len() >= 5 || points.len() > MOST_POINTS {
            break;
        }
        if row.count != header.count {
            wrong.push(format!("line {line} has {} cells, the header has {}", row.count, header.count));
            continue;
        }
        let read = [speed, torque, efficiency].map(|(k, factor)| row.value(row.cells[k].text).map(|x| x * factor));
        match read {
            [Ok(w), Ok(_), Ok(_)] if w < 0.0 => {
                wrong.push(format!(
                    "line {line}: a speed is an amount, 0 or more; the sign of the torque tells motoring"
                ));
            }
            [Ok(_), Ok(_), Ok(e)] if !(e > 0.0 && e <= 1.0) => {
                wrong.push(format!("line {line}: an efficiency is above 0 and at most 1"));
            }
            [Ok(w), Ok(t), Ok(e)] => points.push([w, t, e]),
            _ => wrong.push(format!("line {line}: a cell is no finite number")),
        }
    }
    if points.len() > MOST_POINTS {
        wrong.push(format!("a map has at most {MOST_POINTS} points"));
    }
    if points.is_empty() && wrong.is_empty() {
        wrong.push("there is no row below the header".into());
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let axis = |k: usize| {
        let mut all: Vec<f64> = points.iter().map(|p| p[k]).collect();
        all.sort_by(f64::total_cmp);
        all.dedup();
        all
    };
    let (speeds, torques) = (axis(0), axis(1));
    if speeds.len() * torques.len() > MOST_POINTS {
        return Err(vec![holes(&speeds, &torques, points.len())]);
    }
    let mut values = vec![None; speeds.len() * torques.len()];
    for [w, t, e] in &points {
        let at = |axis: &[f64], x: f64| axis.partition_point(|a| *a < x);
        let value = &mut values[at(&speeds, *w) * torques.len() + at(&torques, *t)];
        if value.replace(*e).is_some() {
            return Err(vec!["two rows have the same speed and torque".into()]);
        }
    }
    match values.into_iter().collect::<Option<Vec<f64>>>() {
        Some(values) => Ok(EfficiencyMap { file: file.to_owned(), speeds, torques, values }),
        None => Err(vec![holes(&speeds, &torques, points.len())]),
    }
}

fn holes(speeds: &[f64], torques: &[f64], points: usize) -> String {
    format!(
        "{} speeds and {} torques make a grid of {} points, and {points} are there: the map has holes",
        speeds.len(),
        torques.len(),
        speeds.len() * torques.len(),
    )
}
