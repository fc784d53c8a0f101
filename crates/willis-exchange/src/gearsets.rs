//! Automatic transmissions as `gearsets` JSON: a topology (sets with `Ns` and `Nr`, clutches, brakes, sprags, permanent ties)
//! and, in a file of its own, a shift schedule.
//!
//! Source of the format: public repository pablomarcel/gearsets, `transmissions/in/transmission_spec_*.json` and
//! `shift_schedule_*.json`, and what its `model.py` reads from them. A sprag holds its member against the housing;
//! `hold_direction` (`negative`, `ccw`, `counter_clockwise`, `reverse`, and the opposites) is the sense of rotation that it
//! prevents, and where a state lists it, it is locked. Efficiencies, planets and loads are not part of the format.

use std::collections::HashMap;

use serde_json::{Map, Value};
use willis::diagnostic::{Code, Diagnostic, Diagnostics, printable};
use willis::model::Model;

use crate::account::{AttributeReport, Fate, Guess, Problem};
use crate::rexs::{Counts, Imported, Missing, Report};
use crate::text::{Taken, comment, name, quoted};

/// No transmission is described by more.
const MOST_BYTES: usize = 1 << 20;
/// Sets, shift elements, states: each at most.
const MOST: usize = 200;

/// Whether a file is one of these: JSON with a list of gear sets.
pub fn is_gearsets(bytes: &[u8]) -> bool {
    bytes.len() <= MOST_BYTES && serde_json::from_slice::<Value>(bytes).is_ok_and(|v| v.get("gearsets").is_some())
}

/// Reads a topology, and a shift schedule if there is one.
///
/// # Errors
/// Why it is no such file, or holds no train.
///
/// # Example
/// ```
/// let spec = br#"{ "name": "one", "input_member": "in", "output_member": "out", "members": ["in", "out", "r"],
///     "gearsets": [{ "name": "P1", "Ns": 30, "Nr": 70, "sun": "in", "ring": "r", "carrier": "out" }],
///     "brakes": [{ "name": "B", "member": "r" }] }"#;
/// let schedule = br#"{ "states": { "1st": ["B"] } }"#;
/// let read = willis_exchange::gearsets::read("one.json", spec, Some(schedule))?;
/// assert_eq!(read.model.train().states().len(), 1);
/// assert!(read.toml.contains("teeth = 30"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn read(file: &str, spec: &[u8], schedule: Option<&[u8]>) -> Result<Imported, Diagnostics> {
    let refused = |what: &str, why: String| -> Diagnostics {
        let d = Diagnostic::new(Code::Unreadable, "", format!("this is no {what}: {why}"));
        d.hint("give a transmission spec with `gearsets`, and its shift schedule with `states`").into()
    };
    let parse = |what: &str, bytes: &[u8]| -> Result<Map<String, Value>, Diagnostics> {
        if bytes.len() > MOST_BYTES {
            return Err(refused(what, "it is larger than 1 MiB".into()));
        }
        match serde_json::from_slice(bytes) {
            Ok(Value::Object(all)) => Ok(all),
            Ok(_) => Err(refused(what, "it is no JSON object".into())),
            Err(e) => Err(refused(what, format!("it is no JSON: {e}"))),
        }
    };
    let spec = parse("transmission spec", spec)?;
    let schedule = schedule.map(|bytes| parse("shift schedule", bytes)).transpose()?;
    let mut reader = Reader::default();
    let body = reader.train(&spec, schedule.as_ref())?;
    reader.account(&spec, &USED_OF_SPEC);
    if let Some(schedule) = &schedule {
        reader.account(schedule, &USED_OF_SCHEDULE);
    }
    let title = file.rsplit(['/', '\\']).next().unwrap_or(file);
    let called = spec.get("name").and_then(Value::as_str).unwrap_or("transmission");
    let mut head = comment(&format!("read from {title} (gearsets JSON)"));
    for g in &reader.guessed {
        head += &comment(&format!("assumed: {}: {} ({})", g.of, g.taken, g.because));
    }
    for m in &reader.missing {
        head += &comment(&format!("not in the file: {}: {}", m.what, m.so));
    }
    for p in &reader.problems {
        head += &comment(&format!("{}: {}", p.place, p.message));
    }
    let toml = format!(
        "{head}\nformat = 1\nname = {}\nsource = {}\n{body}",
        quoted(&printable(called)),
        quoted(&format!("gearsets JSON file {}", printable(title)))
    );
    let model = Model::from_toml(&toml)?;
    let many = |fate: Fate| reader.attributes.iter().filter(|a| a.fate == fate).count();
    let counts = Counts {
        components: reader.components,
        attributes: reader.attributes.len(),
        used: many(Fate::Used),
        left_out: many(Fate::LeftOut),
        unusable: many(Fate::Unusable),
        ideal_supports: 0,
    };
    let report = Report {
        kind: "gearsets".into(),
        version: String::new(),
        application: String::new(),
        counts,
        guessed: reader.guessed,
        missing: reader.missing,
        problems: reader.problems,
        more_problems: 0,
        bearings: vec![],
        load_cases: vec![],
        attributes: reader.attributes,
    };
    Ok(Imported { toml, model, report })
}

/// Keys that are used, by the list that they stand in; an empty name stands for the file itself.
type Used = [(&'static str, &'static [&'static str])];

const USED_OF_SPEC: [(&str, &[&str]); 6] = [
    ("", &["name", "input_member", "output_member", "members"]),
    ("gearsets", &["name", "Ns", "Nr", "sun", "ring", "carrier"]),
    ("clutches", &["name", "a", "b"]),
    ("brakes", &["name", "member"]),
    ("sprags", &["name", "member", "hold_direction"]),
    ("permanent_ties", &[]),
];
const USED_OF_SCHEDULE: [(&str, &[&str]); 2] =
    [("", &["display_order"]), ("states", &["active_constraints", "engaged", "manual_neutral"])];

/// A train while it is read.
#[derive(Default)]
struct Reader {
    guessed: Vec<Guess>,
    missing: Vec<Missing>,
    problems: Vec<Problem>,
    attributes: Vec<AttributeReport>,
    components: usize,
    /// What became of each name, and what holds one body together.
    members: Vec<String>,
    names: HashMap<String, String>,
    taken: Taken,
}

fn text<'v>(entry: &'v Value, key: &str) -> Option<&'v str> {
    entry.get(key).and_then(Value::as_str).map(str::trim).filter(|t| !t.is_empty())
}

impl Reader {
    fn problem(&mut self, place: impl Into<String>, message: impl Into<String>) {
        self.problems.push(Problem { place: place.into(), message: message.into() });
    }

    /// The entries of a list.
    fn list<'v>(&mut self, of: &'v Map<String, Value>, key: &str) -> Vec<&'v Value> {
        match of.get(key) {
            None | Some(Value::Null) => vec![],
            Some(Value::Array(all)) => {
                if all.len() > MOST {
                    self.problem(key, format!("{} entries; the first {MOST} are read", all.len()));
                }
                all.iter().take(MOST).collect()
            }
            Some(_) => {
                self.problem(key, "it is no list and is left out");
                vec![]
            }
        }
    }

    /// The member of a name in the file; new where it was not met.
    fn member(&mut self, wanted: &str) -> String {
        if let Some(known) = self.names.get(wanted) {
            return known.clone();
        }
        let instead = format!("member {}", self.members.len() + 1);
        let own = name(wanted, &instead, &mut self.taken);
        self.names.insert(wanted.to_owned(), own.clone());
        self.members.push(own.clone());
        own
    }

    fn train(
        &mut self,
        spec: &Map<String, Value>,
        schedule: Option<&Map<String, Value>>,
    ) -> Result<String, Diagnostics> {
        // Ties first: what is tied is one member.
        let mut tied: Vec<Vec<String>> = vec![];
        for (k, tie) in self.list(spec, "permanent_ties").into_iter().enumerate() {
            let pair: Vec<String> =
                tie.as_array().into_iter().flatten().filter_map(Value::as_str).map(str::to_owned).collect();
            if pair.len() != 2 {
                self.problem(format!("permanent_ties {}", k + 1), "it is no pair of members and is left out");
                continue;
            }
            let (with, apart): (Vec<_>, Vec<_>) = tied.into_iter().partition(|g| pair.iter().any(|p| g.contains(p)));
            let mut one: Vec<String> = with.into_iter().flatten().collect();
            one.extend(pair);
            tied = apart;
            tied.push(one);
        }
        let ends = ["input_member", "output_member"].map(|key| spec.get(key).and_then(Value::as_str).map(str::trim));
        // The name of an end goes first: it stands for all that is tied to it.
        for group in &mut tied {
            group.sort_by_key(|m| !ends.contains(&Some(m.as_str())));
            group.dedup();
            let own = self.member(&group[0]);
            group[1..].iter().for_each(|m| drop(self.names.insert(m.clone(), own.clone())));
        }
        let [Some(input), Some(output)] = ends else {
            let d = Diagnostic::new(Code::MissingKey, "", "the file has no `input_member` or no `output_member`");
            return Err(d.hint("name the members where power enters and leaves").into());
        };
        let ends = [input, output].map(|m| self.member(m));
        let mut sets = String::new();
        let mut set_names = Taken::default();
        let gearsets = self.list(spec, "gearsets");
        for (k, set) in gearsets.iter().enumerate() {
            let called = name(text(set, "name").unwrap_or(""), &format!("P{}", k + 1), &mut set_names);
            let teeth =
                ["Ns", "Nr"].map(|key| set.get(key).and_then(Value::as_u64).filter(|n| (1..100_000).contains(n)));
            let parts = ["sun", "ring", "carrier"].map(|key| text(set, key).map(str::to_owned));
            let ([Some(ns), Some(nr)], [Some(sun), Some(ring), Some(carrier)]) = (teeth, parts) else {
                self.problem(format!("gear set {called}"), "it lacks Ns, Nr, sun, ring or carrier and is left out");
                continue;
            };
            let [sun, ring, carrier] = [sun, ring, carrier].map(|m| self.member(&m));
            if ns >= nr {
                self.problem(
                    format!("gear set {called}"),
                    format!("a ring of {nr} teeth has no room for a sun of {ns}; it is left out"),
                );
                continue;
            }
            if (nr - ns) % 2 == 1 {
                let told = format!(
                    "Ns = {ns} and Nr = {nr} leave {} teeth for a planet: a nominal one",
                    (nr - ns) as f64 / 2.0
                );
                self.problem(format!("gear set {called}"), told);
            }
            self.components += 1;
            sets += &format!(
                "\n[[set]]\nname = {}\nsun = {{ member = {}, teeth = {ns} }}\nring = {{ member = {}, teeth = {nr} }}\ncarrier = {}\n",
                quoted(&called),
                quoted(&sun),
                quoted(&ring),
                quoted(&carrier)
            );
        }
        if sets.is_empty() {
            let d = Diagnostic::new(Code::Unfit, "", "the file holds no gear set that can be read");
            return Err(d.hint("a gear set needs Ns, Nr, sun, ring and carrier").into());
        }
        let (elements, known) = self.elements(spec);
        let states = self.states(spec, schedule, &known);
        // Members that nothing else names.
        for m in self.list(spec, "members") {
            match m.as_str().map(str::trim).filter(|m| !m.is_empty()) {
                Some(m) if !self.names.contains_key(m) => {
                    self.problem(format!("member {m}"), "no gear set and no shift element has it; it is left out");
                }
                _ => {}
            }
        }
        self.missing.push(Missing {
            what: "efficiencies of the gear sets".into(),
            so: "the train loses nothing until `mesh_efficiency` or the teeth's data are added".into(),
        });
        let names = |all: &[String]| all.iter().map(|n| quoted(n)).collect::<Vec<_>>().join(", ");
        let both = names(&ends);
        Ok(format!(
            "\nmembers = [{}]\nterminals = [{both}]\ninput = {}\noutput = {}\n{sets}{elements}{states}",
            names(&self.members),
            quoted(&ends[0]),
            quoted(&ends[1])
        ))
    }

    /// Clutches, brakes and sprags, and what they are called here.
    fn elements(&mut self, spec: &Map<String, Value>) -> (String, HashMap<String, String>) {
        let mut out = String::new();
        let mut known = HashMap::new();
        let mut taken = Taken::default();
        for (list, keys) in [("clutches", &["a", "b"][..]), ("brakes", &["member"]), ("sprags", &["member"])] {
            for (k, e) in self.list(spec, list).into_iter().enumerate() {
                let wanted = text(e, "name").unwrap_or("").to_owned();
                let place = format!("{list} {}", if wanted.is_empty() { (k + 1).to_string() } else { wanted.clone() });
                let parts: Vec<&str> = keys.iter().filter_map(|key| text(e, key)).collect();
                if parts.len() != keys.len() || known.contains_key(&wanted) {
                    self.problem(place, "it has no members, or the name of another one, and is left out");
                    continue;
                }
                let members: Vec<String> = parts.into_iter().map(|m| self.member(m)).collect();
                if members.len() == 2 && members[0] == members[1] {
                    self.problem(place, "its two sides are tied together; it is left out");
                    continue;
                }
                let own = name(&wanted, &format!("{list} {}", k + 1), &mut taken);
                let (kind, blocks) = match list {
                    "clutches" => ("clutch", None),
                    "brakes" => ("brake", None),
                    _ => self.sprag(&place, text(e, "hold_direction").unwrap_or("counter_clockwise")),
                };
                let all: Vec<String> = members.iter().map(|m| quoted(m)).collect();
                out += &format!(
                    "\n[[shift_element]]\nname = {}\nkind = \"{kind}\"\nmembers = [{}]\n",
                    quoted(&own),
                    all.join(", ")
                );
                if let Some(blocks) = blocks {
                    out += &format!("blocks = \"{blocks}\"\n");
                }
                self.components += 1;
                known.insert(wanted, own);
            }
        }
        (out, known)
    }

    /// What a sprag is here: a one-way clutch, or a brake where it holds both ways.
    fn sprag(&mut self, place: &str, direction: &str) -> (&'static str, Option<&'static str>) {
        match direction.to_ascii_lowercase().as_str() {
            "negative" | "ccw" | "counter_clockwise" | "reverse" => ("one-way", Some("backward")),
            "positive" | "cw" | "clockwise" | "forward" => ("one-way", Some("forward")),
            other => {
                self.guessed.push(Guess {
                    of: place.to_owned(),
                    taken: "a brake".into(),
                    because: format!("`hold_direction` is `{}`, which names no sense of rotation", printable(other)),
                });
                ("brake", None)
            }
        }
    }

    /// The states of the schedule, in the order in which it shows them.
    fn states(
        &mut self,
        spec: &Map<String, Value>,
        schedule: Option<&Map<String, Value>>,
        known: &HashMap<String, String>,
    ) -> String {
        let Some(schedule) = schedule else {
            self.missing.push(Missing {
                what: "the shift schedule".into(),
                so: "it stands in a file of its own; without it the train has shift elements and no states".into(),
            });
            return String::new();
        };
        let Some(Value::Object(all)) = schedule.get("states") else {
            self.problem("states", "the schedule has no object `states`");
            return String::new();
        };
        let mut order: Vec<&str> = [schedule, spec]
            .iter()
            .find_map(|of| of.get("display_order").and_then(Value::as_array))
            .into_iter()
            .flatten()
            .filter_map(Value::as_str)
            .filter(|name| all.contains_key(*name))
            .collect();
        let rest: Vec<&str> = all.keys().map(String::as_str).filter(|name| !order.contains(name)).collect();
        order.extend(rest);
        let mut out = String::new();
        let mut taken = Taken::default();
        for (k, wanted) in order.into_iter().take(MOST).enumerate() {
            let state = &all[wanted];
            let list = state.as_array().or_else(|| {
                ["active_constraints", "engaged"].iter().find_map(|key| state.get(*key).and_then(Value::as_array))
            });
            let engaged: Vec<&str> = list.into_iter().flatten().filter_map(Value::as_str).map(str::trim).collect();
            if let Some(unknown) = engaged.iter().find(|e| !known.contains_key(**e)) {
                let told = format!("there is no shift element `{}`; it is left out", printable(unknown));
                self.problem(format!("state {}", printable(wanted)), told);
                continue;
            }
            let own = name(wanted, &format!("state {}", k + 1), &mut taken);
            let all: Vec<String> = engaged.iter().map(|e| quoted(&known[*e])).collect();
            out += &format!("\n[[state]]\nname = {}\nengaged = [{}]\n", quoted(&own), all.join(", "));
            self.components += 1;
        }
        out
    }

    /// Every value of the file, used or left out.
    fn account(&mut self, of: &Map<String, Value>, used: &Used) {
        let is_used =
            |kind: &str, key: &str| used.iter().any(|u| u.0 == kind && (u.1.is_empty() || u.1.contains(&key)));
        for (key, value) in of {
            let listed = used.iter().any(|u| u.0 == key && !key.is_empty());
            match value {
                Value::Array(all) if listed => {
                    for (k, entry) in all.iter().enumerate() {
                        self.entry(key, k, entry, &is_used);
                    }
                }
                Value::Object(all) if listed => {
                    for (k, (called, entry)) in all.iter().enumerate() {
                        match entry {
                            Value::Object(_) => self.entry(key, k, entry, &is_used),
                            _ => self.one(key, k, called, entry, true),
                        }
                    }
                }
                _ => self.one("transmission", 0, key, value, is_used("", key)),
            }
        }
    }

    fn entry(&mut self, kind: &str, k: usize, entry: &Value, is_used: &dyn Fn(&str, &str) -> bool) {
        match entry {
            Value::Object(all) => {
                for (key, value) in all {
                    self.one(kind, k, key, value, is_used(kind, key));
                }
            }
            other => self.one(kind, k, kind, other, true),
        }
    }

    fn one(&mut self, kind: &str, k: usize, key: &str, value: &Value, used: bool) {
        /// Attributes that are listed; a file of a stranger may have any number.
        const MOST_LISTED: usize = 5000;
        if self.attributes.len() < MOST_LISTED {
            let shown: String = value.to_string().chars().take(60).collect();
            self.attributes.push(AttributeReport {
                load_case: None,
                component: k as i64 + 1,
                kind: printable(kind).into_owned(),
                attribute: printable(key).into_owned(),
                value: printable(&shown).into_owned(),
                unit: String::new(),
                fate: if used { Fate::Used } else { Fate::LeftOut },
                why: String::new(),
            });
        }
    }
}
