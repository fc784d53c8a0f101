//! Changes of mode: what happened to which elements, and in words.

use crate::named::NameMap;
use crate::train::{ShiftElementKind, Train};

use super::element::element_name;
use super::engine::{Engine, Touch};
use super::report::{Event, Happening, HappeningKind, ModeLabel};
use super::stretch::Watch;

/// Why the mode is chosen anew.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Why {
    Start,
    /// A break of what is prescribed.
    Input,
    Watch(Watch),
}

/// The event that leads to modes; none where nothing happened but the choice itself: at a break of the inputs
/// everything may stay, and at its limit by round-off only, a held element stays held and breaks away next time.
pub(super) fn event(
    engine: &Engine,
    t: f64,
    why: Option<Why>,
    before: &[ModeLabel],
    now: &[ModeLabel],
) -> Option<Event> {
    let changed = |(k, l): &(usize, &ModeLabel)| before.get(*k) != Some(l);
    let named = |(k, l): (usize, &ModeLabel)| (engine.names[k].clone(), *l);
    let modes: NameMap<ModeLabel> = now.iter().enumerate().filter(changed).map(named).collect();
    let happenings = if why == Some(Why::Start) {
        vec![Happening { kind: HappeningKind::Start, of: vec![] }]
    } else if !modes.is_empty() {
        changes(engine, before, now)
    } else {
        vec![unseen(engine, why)?]
    };
    Some(Event { time_s: t, cause: words(&happenings), happenings, modes })
}

/// What happened where no mode changed.
fn unseen(engine: &Engine, why: Option<Why>) -> Option<Happening> {
    let s = &engine.system;
    let Some(Why::Watch(watch)) = why else { return None };
    let (kind, of) = match watch {
        Watch::Slip(g) => (HappeningKind::RestsForAnInstant, s.groups[g].names.clone()),
        Watch::Side(j) => (HappeningKind::DriveReverses, vec![element_name(&s.train, &s.elements[j].links)]),
        Watch::Touch(k) => {
            let kind = match engine.touch[k] {
                Touch::Gap => HappeningKind::NoContact,
                Touch::On(_) => HappeningKind::FullDamping,
                Touch::Limited(_) => HappeningKind::DampingLimited,
                Touch::Parting(_) => HappeningKind::ContactWithoutForce,
            };
            (kind, vec![s.train.shafts()[k].name.clone()])
        }
        Watch::End(k) => {
            let kind = match engine.path_ends[k] {
                0 => HappeningKind::LeavesLimit,
                _ => HappeningKind::ReachesLimit,
            };
            (kind, vec![s.train.variators[s.paths[k].variator].name.clone()])
        }
        Watch::Engage(k) => {
            let kind = if engine.engaged[k] { HappeningKind::Engages } else { HappeningKind::Opens };
            (kind, vec![s.frictions[k].name.clone()])
        }
        Watch::Hold(..) | Watch::Rest => return None,
    };
    Some(Happening { kind, of })
}

/// What changed, those together that did the same.
fn changes(engine: &Engine, before: &[ModeLabel], now: &[ModeLabel]) -> Vec<Happening> {
    let mut all: Vec<Happening> = Vec::new();
    for (name, (a, b)) in engine.names.iter().zip(before.iter().zip(now)).filter(|(_, (a, b))| a != b) {
        let kind = kind(&engine.system.train, name, *a, *b);
        match all.iter_mut().find(|h| h.kind == kind) {
            Some(known) => known.of.push(name.clone()),
            None => all.push(Happening { kind, of: vec![name.clone()] }),
        }
    }
    all
}

fn kind(train: &Train, name: &str, before: ModeLabel, now: ModeLabel) -> HappeningKind {
    use HappeningKind::*;
    let shaft = train.shafts().iter().any(|s| s.name == name);
    let one_way = || train.shift_elements().iter().any(|e| e.name == name && e.kind == ShiftElementKind::OneWay);
    match (before, now) {
        (_, ModeLabel::Free) if shaft => ContactLost,
        _ if shaft => Touches,
        (_, ModeLabel::Free) if one_way() => Overruns,
        (_, ModeLabel::Free) => Opens,
        (ModeLabel::Free, _) if one_way() => Locks,
        (ModeLabel::Free, _) => Engages,
        (_, ModeLabel::Stuck) => ComesToRest,
        (ModeLabel::Stuck, _) => BreaksAway,
        _ => TurnsRound,
    }
}

/// Happenings in a sentence.
fn words(happenings: &[Happening]) -> String {
    let clause = |h: &Happening| {
        // What stands before the names, and behind one of them or several.
        let [before, one, several] = match h.kind {
            HappeningKind::Start => return "start".to_owned(),
            HappeningKind::ComesToRest => ["", " comes to rest", " come to rest"],
            HappeningKind::BreaksAway => ["", " breaks away", " break away"],
            HappeningKind::TurnsRound => ["", " reverses", " reverse"],
            HappeningKind::RestsForAnInstant => ["", " at rest for an instant", " at rest for an instant"],
            HappeningKind::Engages => ["", " engages", " engage"],
            HappeningKind::Opens => ["", " opens", " open"],
            HappeningKind::Locks => ["", " locks", " lock"],
            HappeningKind::Overruns => ["", " overruns", " overrun"],
            HappeningKind::DriveReverses => ["drive reverses in ", "", ""],
            HappeningKind::Touches => ["contact in ", "", ""],
            HappeningKind::ContactLost => ["contact lost in ", "", ""],
            HappeningKind::NoContact => ["no contact in ", "", ""],
            HappeningKind::FullDamping => ["full damping in ", "", ""],
            HappeningKind::DampingLimited => ["damping limited to the spring's torque in ", "", ""],
            HappeningKind::ContactWithoutForce => ["contact without force in ", "", ""],
            HappeningKind::ReachesLimit => ["", " reaches a limit of its ratio", " reach limits of their ratios"],
            HappeningKind::LeavesLimit => ["", " leaves a limit of its ratio", " leave limits of their ratios"],
        };
        format!("{before}{}{}", list(h.of.iter().map(String::as_str)), if h.of.len() == 1 { one } else { several })
    };
    happenings.iter().map(clause).collect::<Vec<_>>().join(", ")
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
