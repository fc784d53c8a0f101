//! Pours the checked values of the dynamic layer into its description.

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::train::describe::dynamic::{
    DragSpec, EngagementSpec, FrictionSpec, PlanetBodySpec, ScenarioSpec, ShaftSpec, SignalSpec, SourceKindSpec,
    SourceSpec,
};
use crate::train::dynamic::{Contact, LossRow, Signal, SourceKind};

use super::keys::SOURCE_KINDS;
use super::reader::Fields;

/// Density of air unless given, kg/m³.
const AIR: f64 = 1.2;

/// SI values by name, as of inertias.
pub(super) fn values(t: &Fields, key: &str) -> Vec<(String, f64)> {
    t.quantities(key).into_iter().map(|(name, q)| (name, q.si())).collect()
}

pub(super) fn planet_body(t: &Fields) -> PlanetBodySpec {
    PlanetBodySpec { mass: t.si("mass"), inertia: t.si("inertia"), orbit_radius: t.si("orbit_radius") }
}

pub(super) fn friction(t: &Fields) -> FrictionSpec {
    FrictionSpec {
        capacity: t.si("capacity"),
        coefficient: t.points("friction"),
        normal_force: t.si("normal_force"),
        effective_radius: t.si("effective_radius"),
        peak: t.real("peak"),
    }
}

/// The rows of a loss table, if there is one; what is missing or wrong in a row was reported.
pub(super) fn loss_table(t: &Fields) -> Option<Vec<LossRow>> {
    let row = |t: &Fields| LossRow {
        speed: t.si("speed").unwrap_or(0.0),
        forward: t.real("forward").unwrap_or(1.0),
        backward: t.real("backward").unwrap_or(1.0),
        forward_torque: t.si("forward_torque").unwrap_or(0.0),
        backward_torque: t.si("backward_torque").unwrap_or(0.0),
    };
    t.has("loss_table").then(|| t.tables("loss_table").iter().map(row).collect())
}

pub(super) fn drag(t: &Fields) -> DragSpec {
    DragSpec {
        name: t.text("name"),
        members: t.names("members"),
        coulomb: t.si("coulomb"),
        viscous: t.si("viscous"),
        table: t.points("table"),
        peak: t.real("peak"),
    }
}

pub(super) fn shaft(t: &Fields) -> ShaftSpec {
    ShaftSpec {
        name: t.text("name"),
        members: t.names("members"),
        stiffness: t.si("stiffness"),
        damping: t.si("damping"),
        backlash: t.si("backlash"),
        contact: match t.optional_text("contact").as_deref() {
            Some("hard") => Contact::Hard,
            _ => Contact::Soft,
        },
    }
}

pub(super) fn scenario(t: &Fields) -> ScenarioSpec {
    ScenarioSpec {
        start: t.si("start").unwrap_or(0.0),
        duration: t.si("duration"),
        end: t.si("end"),
        samples: t.integer("samples").unwrap_or(ScenarioSpec::SAMPLES),
        initial_speeds: values(t, "initial_speeds"),
        initial_twists: values(t, "initial_twists"),
        fixed: t.names("fixed"),
        state: t.optional_text("state"),
        gears: t.schedule("gears"),
        shift_time: t.si("shift_time"),
        sources: t.tables("source").iter().map(source).collect(),
        engagements: (t.tables("engagement").iter())
            .map(|e| EngagementSpec { element: e.text("element"), value: signal(e, "value").unwrap_or(0.0.into()) })
            .collect(),
        ..ScenarioSpec::empty(t.text("name"))
    }
}

fn source(t: &Fields) -> SourceSpec {
    SourceSpec { name: t.optional_text("name"), member: t.text("member"), kind: source_kind(t) }
}

fn source_kind(t: &Fields) -> SourceKindSpec {
    let zero = || SignalSpec::from(0.0);
    let si = |t: &Fields, key: &str| t.si(key).unwrap_or(0.0);
    if let Some(speed) = signal(t, "speed") {
        SourceKind::Speed(speed)
    } else if let Some(c) = t.table("controller") {
        SourceKind::Controller {
            setpoint: signal(c, "setpoint").unwrap_or_else(zero),
            feed_forward: signal(c, "feed_forward").unwrap_or_else(zero),
            proportional: si(c, "proportional"),
            integral: si(c, "integral"),
            derivative: si(c, "derivative"),
        }
    } else if let Some(l) = t.table("linear") {
        SourceKind::Linear { torque: si(l, "torque"), about: si(l, "about"), slope: si(l, "slope") }
    } else if let Some(q) = t.table("quadratic") {
        SourceKind::Quadratic {
            torque: si(q, "torque"),
            about: si(q, "about"),
            factor: si(q, "factor"),
            even: q.flag("even"),
        }
    } else if let Some(v) = t.table("vehicle") {
        SourceKind::Vehicle {
            mass: v.si("mass").unwrap_or(1.0),
            wheel_radius: v.si("wheel_radius").unwrap_or(1.0),
            final_drive: v.real("final_drive").unwrap_or(1.0),
            rolling: v.real("rolling").unwrap_or(0.0),
            drag_area: si(v, "drag_area"),
            air_density: v.si("air_density").unwrap_or(AIR),
            grade: signal(v, "grade").unwrap_or_else(zero),
        }
    } else if let Some(m) = t.table("motor") {
        let idle = || vec![[0.0, 0.0]];
        SourceKind::Motor {
            full_load: m.points("full_load").unwrap_or_else(idle),
            closed: m.points("closed").unwrap_or_else(idle),
            throttle: signal(m, "throttle").unwrap_or(1.0.into()),
        }
    } else {
        SourceKind::Torque(signal(t, "torque").unwrap_or_else(zero))
    }
}

fn signal(t: &Fields, key: &str) -> Option<SignalSpec> {
    if let Some(value) = t.scalar(key) {
        return Some(value.into());
    }
    let s = t.table(key)?;
    let value = |key: &str| s.scalar(key).unwrap_or(0.0);
    Some(SignalSpec::Given(match s.text("type").as_str() {
        "step" => Signal::Step { offset: value("offset"), height: value("height"), at: value("at") },
        "ramp" => Signal::Ramp {
            offset: value("offset"),
            height: value("height"),
            at: value("at"),
            duration: s.si("duration").unwrap_or(1.0),
        },
        "sine" => Signal::Sine {
            offset: value("offset"),
            amplitude: value("amplitude"),
            frequency: value("frequency"),
            phase: value("phase"),
            at: value("at"),
            decay: value("decay"),
        },
        "pulse" => Signal::Pulse {
            offset: value("offset"),
            amplitude: value("amplitude"),
            period: s.si("period").unwrap_or(1.0),
            width: s.real("width").unwrap_or(0.5),
            at: value("at"),
        },
        "expression" => return Some(SignalSpec::Formula(s.optional_text("formula")?)),
        "product" => {
            let of = s.table("of")?;
            return Some(SignalSpec::product(signal(of, "first")?, signal(of, "second")?));
        }
        // A table, or a file whose points were put beside its name.
        _ => Signal::Table { points: s.points("points")?, hold: s.flag("hold") },
    }))
}

/// Reports sources that say nothing, or more than one thing.
pub(super) fn check_sources(root: &Fields, diagnostics: &mut Diagnostics) {
    let scenarios = root.tables("scenario").iter().enumerate();
    let sources = scenarios.flat_map(|(k, s)| {
        s.tables("source").iter().enumerate().map(move |(j, t)| (format!("scenario[{k}].source[{j}]"), t))
    });
    for (place, t) in sources {
        let given: Vec<&str> = SOURCE_KINDS.iter().copied().filter(|k| t.has(k)).collect();
        // What is there and wrong was reported.
        let reported = || diagnostics.iter().any(|d| d.place.starts_with(&place));
        let hint = format!("keep one of {}", SOURCE_KINDS.join(", "));
        match given.as_slice() {
            [_] => {}
            [] if reported() => {}
            [] => {
                let d = Diagnostic::new(Code::MissingKey, place, "this source does not say what acts on its member");
                diagnostics.push(d.hint(hint.replace("keep", "give")));
            }
            [first, second, ..] => {
                let message = format!("`{first}` and `{second}` in one source: a source is one thing");
                let d = Diagnostic::new(Code::Conflict, format!("{place}.{second}"), message);
                diagnostics.push(d.hint("keep one; a second [[scenario.source]] may act on the same member"));
            }
        }
    }
}
