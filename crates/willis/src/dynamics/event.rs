//! Changes of mode in words.

use crate::train::{ShiftElementKind, Train};

use super::engine::{Engine, Touch, Watch};
use super::report::{Event, ModeLabel};
use super::system::element_name;

/// Modes by element.
pub(super) type Labels = [(String, ModeLabel)];

/// Why the mode is chosen anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    Start,
    /// A break of what is prescribed.
    Input,
    Watch(Watch),
}

/// A verb for one and for several, and what stands before them.
type Verb = [&'static str; 3];

const RESTS: Verb = ["", " comes to rest", " come to rest"];
const BREAKS_AWAY: Verb = ["", " breaks away", " break away"];
const TURNS: Verb = ["", " turns round", " turn round"];
const ENGAGES: Verb = ["", " engages", " engage"];
const OPENS: Verb = ["", " opens", " open"];
const LOCKS: Verb = ["", " locks", " lock"];
const OVERRUNS: Verb = ["", " overruns", " overrun"];
const TOUCHES: Verb = ["contact in ", "", ""];
const PARTS: Verb = ["contact lost in ", "", ""];

/// The event that leads to modes; none where nothing happened but the choice itself: at a break of the inputs
/// everything may stay, and at its limit by round-off only, a held element stays held and breaks away next time.
pub(super) fn event(engine: &Engine, t: f64, why: Option<Why>, before: &Labels, now: &Labels) -> Option<Event> {
    let changed = || now.iter().enumerate().filter(|(k, l)| before.get(*k) != Some(l)).map(|(_, l)| l.clone());
    let happening = |cause| Some(Event { time_s: t, cause, modes: changed().collect() });
    if why == Some(Why::Start) {
        return happening("start".to_owned());
    }
    if changed().next().is_some() {
        return happening(changes(&engine.system.train, before, now));
    }
    let s = &engine.system;
    let Some(Why::Watch(watch)) = why else { return None };
    match watch {
        Watch::Slip(g) => happening(format!("{} at rest for an instant", list(s.groups[g].name.split(", ")))),
        Watch::Side(j) => happening(format!("drive reverses in {}", element_name(&s.train, &s.elements[j].links))),
        Watch::Touch(k) => happening(format!(
            "{} in {}",
            match engine.touch[k] {
                Touch::Gap => "no contact",
                Touch::On(_) => "full damping",
                Touch::Limited(_) => "damping limited to the spring's torque",
                Touch::Parting(_) => "contact without force",
            },
            s.train.shafts()[k].name
        )),
        Watch::Engage(k) => {
            let verb = if engine.engaged[k] { ENGAGES } else { OPENS };
            happening(format!("{}{}", s.frictions[k].name, verb[1]))
        }
        Watch::Hold(..) | Watch::HoldAll => None,
    }
}

/// What changed, those together that did the same.
fn changes(train: &Train, before: &Labels, now: &Labels) -> String {
    let mut clauses: Vec<(Verb, Vec<&str>)> = Vec::new();
    for ((name, a), (_, b)) in before.iter().zip(now).filter(|(a, b)| a.1 != b.1) {
        let verb = verb(train, name, *a, *b);
        match clauses.iter_mut().find(|c| c.0 == verb) {
            Some((_, names)) => names.push(name),
            None => clauses.push((verb, vec![name])),
        }
    }
    let told = clauses.iter().map(|([before, one, several], names)| {
        format!("{before}{}{}", list(names.iter().copied()), if names.len() == 1 { one } else { several })
    });
    told.collect::<Vec<_>>().join(", ")
}

fn verb(train: &Train, name: &str, before: ModeLabel, now: ModeLabel) -> Verb {
    let shaft = train.shafts().iter().any(|s| s.name == name);
    let one_way = || train.shift_elements().iter().any(|e| e.name == name && e.kind == ShiftElementKind::OneWay);
    match (before, now) {
        (_, ModeLabel::Free) if shaft => PARTS,
        _ if shaft => TOUCHES,
        (_, ModeLabel::Free) => {
            if one_way() {
                OVERRUNS
            } else {
                OPENS
            }
        }
        (ModeLabel::Free, _) => {
            if one_way() {
                LOCKS
            } else {
                ENGAGES
            }
        }
        (_, ModeLabel::Stuck) => RESTS,
        (ModeLabel::Stuck, _) => BREAKS_AWAY,
        _ => TURNS,
    }
}

/// A number for a sentence: six decimals at most.
pub(super) fn short(x: f64) -> f64 {
    (x * 1e6).round() / 1e6
}

/// Letters of names in a sentence.
const LONG: usize = 36;

/// Names in a sentence; the modes of an event have them all.
fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    match names[..] {
        [] => String::new(),
        [one] => one.to_owned(),
        [a, b] => format!("{a} and {b}"),
        [a, b, c] if a.len() + b.len() + c.len() <= LONG => format!("{a}, {b} and {c}"),
        // Long names would push the verb out of a table or figure.
        [a, b, ..] if a.len() + b.len() > LONG => format!("{a} and {} more", names.len() - 1),
        [a, b, ..] => format!("{a}, {b} and {} more", names.len() - 2),
    }
}
