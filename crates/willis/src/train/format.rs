//! The train file, format 1: one description of its keys drives the reader, the suggestions for
//! misspelt keys and the JSON Schema.
//!
//! The text is read twice in spirit, once in fact: [`keys`] says which keys exist and what kind of
//! value each takes, [`read`] checks the whole document against it and collects every error with
//! its place, and the little that is left is to pour checked values into a [`TrainBuilder`].

mod csv;
mod dynamic;
mod edit;
mod keys;
mod physical;
mod reader;
mod schema;

use crate::diagnostic::{Code, Diagnostic, Diagnostics, Span};
use crate::train::{ShiftElementKind, Train};

use super::describe::{
    GearSpec, MeshSpec, OperationSpec, Parts, PlanetSpec, SetEfficiencySpec, SetSpec, ShiftElementSpec, StateSpec,
    StudySpec, TrainBuilder,
};
use super::{Load, assemble};
use reader::Fields;

pub use edit::{Document, Key, Measure};
pub use schema::schema;

/// What reading a train file gave.
#[derive(Clone, Debug)]
pub struct Reading {
    /// The train, unless there were errors.
    pub train: Option<Train>,
    /// Errors and warnings, with their places in the text.
    pub diagnostics: Diagnostics,
    spans: reader::Spans,
}

impl Reading {
    /// Gives later diagnostics (of an analysis) their places in `text`, the text that was read.
    pub fn locate(&self, text: &str, diagnostics: &mut Diagnostics) {
        locate(&self.spans, text, diagnostics);
    }
}

fn locate(spans: &reader::Spans, text: &str, diagnostics: &mut Diagnostics) {
    give_places(spans, text, diagnostics);
    diagnostics.stand_in(None, text);
    diagnostics.sort();
}

fn give_places(spans: &reader::Spans, text: &str, diagnostics: &mut Diagnostics) {
    for d in diagnostics.iter_mut().filter(|d| d.span.is_none()) {
        d.span = spans.nearest(&d.place).map(Span::from);
        // A suggestion replaces a name; inside quotes, if that is what stands there.
        if let (Some(span), Some(new)) = (&d.span, &mut d.replacement)
            && let Some(quote) = text[span.range()].chars().next().filter(|c| matches!(c, '"' | '\''))
        {
            *new = format!("{quote}{new}{quote}");
        }
    }
}

pub(super) fn read(text: &str, load: &mut reader::Load<'_>) -> Reading {
    let mut diagnostics = Diagnostics::default();
    if text.trim().is_empty() {
        diagnostics.push(
            Diagnostic::new(Code::MissingKey, "", "the file is empty")
                .hint("a train file begins with `format = 1` and names its `members`; see the examples for a start"),
        );
        return Reading { train: None, diagnostics, spans: reader::Spans::default() };
    }
    let (root, spans) = reader::read(text, &keys::FILE, load, &mut diagnostics);
    for (k, set) in root.tables("set").iter().enumerate() {
        if set.set_efficiency("mesh_efficiency").is_some() && set.efficiency("basic_efficiency").is_some() {
            let message = "`mesh_efficiency` and `basic_efficiency` both say what the set loses";
            let d = Diagnostic::new(Code::Conflict, format!("set[{k}].basic_efficiency"), message);
            diagnostics.push(d.hint("keep the one that is known"));
        }
    }
    dynamic::check_sources(&root, &mut diagnostics);
    let mut train = None;
    if !diagnostics.has_errors() {
        train = assemble::assemble(builder(&root), Some(&|place| spans.has(place)), &mut diagnostics);
    } else if diagnostics.len() < 100 && !diagnostics.iter().any(|d| d.code == Code::Syntax) {
        // Names can be checked too where the shape is sound; what is missing was already reported.
        let mut more = Diagnostics::default();
        assemble::assemble(builder(&root), None, &mut more);
        let reported: Vec<String> = diagnostics.iter().map(|d| d.place.clone()).collect();
        let doubtful = |d: &Diagnostic| {
            matches!(d.code, Code::MissingKey | Code::IncompleteSet | Code::Unconnected)
                || d.severity != crate::diagnostic::Severity::Error
                || reported.iter().any(|r| !r.is_empty() && (d.place.starts_with(r) || r.starts_with(&d.place)))
        };
        diagnostics.extend(more.into_iter().filter(|d| !doubtful(d)));
    }
    locate(&spans, text, &mut diagnostics);
    if let Some(train) = &mut train {
        train.warnings = diagnostics.iter().cloned().collect();
    }
    Reading { train, diagnostics, spans }
}

fn builder(root: &Fields) -> TrainBuilder {
    let mut b = TrainBuilder::new(root.text("name"));
    b.source = root.optional_text("source");
    b.members = root.names("members");
    b.terminals = root.names("terminals");
    b.input = root.optional_text("input");
    b.output = root.optional_text("output");
    b.meshes = root.tables("mesh").iter().map(mesh).collect();
    b.sets = root.tables("set").iter().map(set).collect();
    b.shift_elements = root.tables("shift_element").iter().map(shift_element).collect();
    b.states = root.tables("state").iter().map(state).collect();
    b.operations = root.tables("operation").iter().map(operation).collect();
    b.oil = root.table("oil").map(physical::oil);
    b.laws = root.table("laws").map(physical::laws).unwrap_or_default();
    b.friction_coefficient = root.table("laws").and_then(|t| t.real("friction_coefficient"));
    b.housing = root.table("housing").map(physical::housing).unwrap_or_default();
    b.bearings = root.tables("bearing").iter().map(physical::bearing).collect();
    b.seals = root.tables("seal").iter().map(physical::seal).collect();
    b.rotors = root.tables("rotor").iter().map(physical::rotor).collect();
    b.inertias = dynamic::values(root, "inertias");
    b.drags = root.tables("drag").iter().map(dynamic::drag).collect();
    b.shafts = root.tables("shaft").iter().map(dynamic::shaft).collect();
    b.scenarios = root.tables("scenario").iter().map(dynamic::scenario).collect();
    b.studies = root.tables("study").iter().map(study).collect();
    b
}

fn gear(t: &Fields) -> GearSpec {
    GearSpec {
        member: t.text("member"),
        teeth: t.integer("teeth").unwrap_or(1),
        internal: t.flag("internal"),
        planet_teeth: t.integer("planet_teeth"),
        right: t.optional_text("side").map(|s| s == "right"),
        tooth: physical::tooth(t),
        planet_tooth: t.table("planet").map(physical::tooth).unwrap_or_default(),
        geometry: physical::geometry(t),
    }
}

fn mesh(t: &Fields) -> MeshSpec {
    let blank = || GearSpec::external("", 1);
    let mut gears = t.tables("gears").iter().map(gear);
    let first = gears.next().unwrap_or_else(blank);
    let second = gears.next().unwrap_or_else(blank);
    MeshSpec {
        name: t.optional_text("name"),
        carrier: t.optional_text("carrier").unwrap_or_else(|| "frame".into()),
        efficiency: t.efficiency("efficiency"),
        same_sense: t.optional_text("sense").map(|s| s == "same"),
        bevel: t.optional_text("kind").is_some_and(|k| k == "bevel"),
        count: t.integer("count").unwrap_or(1),
        geometry: physical::geometry(t),
        loss_table: dynamic::loss_table(t),
        ..MeshSpec::new(first, second)
    }
}

fn planet(t: &Fields, key: &str) -> PlanetSpec {
    t.table(key).map_or(PlanetSpec::default(), |p| PlanetSpec {
        teeth: p.integer("teeth"),
        count: p.integer("count"),
        tooth: physical::tooth(p),
        body: dynamic::planet_body(p),
    })
}

fn set(t: &Fields) -> SetSpec {
    let sun_or_ring = |key: &str| t.table(key).map(gear).map(|g| GearSpec { internal: key == "ring", ..g });
    let required = |key: &str| sun_or_ring(key).unwrap_or_else(|| GearSpec::external("", 1));
    let parts = match t.optional_text("type").as_deref() {
        Some("double-planet") => Parts::DoublePlanet {
            sun: required("sun"),
            ring: GearSpec { internal: true, ..required("ring") },
            inner: planet(t, "inner_planet"),
            outer: planet(t, "outer_planet"),
        },
        Some("stepped") => {
            let rings = t.tables("rings").iter().map(|r| GearSpec { internal: true, ..gear(r) });
            let central = t.tables("suns").iter().map(gear).chain(rings).collect();
            Parts::Stepped { central, planet: planet(t, "planet") }
        }
        Some("ravigneaux") => Parts::Ravigneaux {
            small_sun: sun_or_ring("small_sun"),
            large_sun: sun_or_ring("large_sun"),
            ring: sun_or_ring("ring"),
            short: planet(t, "short_planet"),
            long: planet(t, "long_planet"),
        },
        Some("bevel") => {
            Parts::Bevel { sides: t.tables("sides").iter().map(gear).collect(), planet: planet(t, "planet") }
        }
        _ => Parts::Simple {
            sun: required("sun"),
            ring: GearSpec { internal: true, ..required("ring") },
            planet: planet(t, "planet"),
        },
    };
    let mut set = SetSpec::new(t.text("name"), t.text("carrier"), parts);
    set.efficiency = t
        .set_efficiency("mesh_efficiency")
        .map(|(external, internal)| SetEfficiencySpec::Meshes { external, internal })
        .or(t.efficiency("basic_efficiency").map(SetEfficiencySpec::Basic));
    set.geometry = physical::geometry(t);
    set
}

fn shift_element(t: &Fields) -> ShiftElementSpec {
    ShiftElementSpec {
        name: t.text("name"),
        kind: match t.text("kind").as_str() {
            "brake" => ShiftElementKind::Brake,
            "one-way" => ShiftElementKind::OneWay,
            _ => ShiftElementKind::Clutch,
        },
        members: t.names("members"),
        blocks: t.optional_text("blocks").map(|b| if b == "forward" { 1 } else { -1 }),
        friction: dynamic::friction(t),
    }
}

fn state(t: &Fields) -> StateSpec {
    StateSpec {
        name: t.text("name"),
        engaged: t.names("engaged"),
        input: t.optional_text("input"),
        output: t.optional_text("output"),
    }
}

fn study(t: &Fields) -> StudySpec {
    StudySpec {
        name: t.text("name"),
        over: t.names("over"),
        operation: t.optional_text("operation"),
        state: t.optional_text("state"),
        hold: t.optional_text("hold"),
        columns: t.names("columns"),
    }
}

fn operation(t: &Fields) -> OperationSpec {
    let loads = t.quantities("torques").into_iter().map(|(m, q)| (m, Load::Torque(q)));
    let powers = t.quantities("powers").into_iter().map(|(m, q)| (m, Load::Power(q)));
    OperationSpec {
        name: t.text("name"),
        state: t.optional_text("state"),
        speeds: t.quantities("speeds"),
        fixed: t.names("fixed"),
        loads: loads.chain(powers).collect(),
        temperature: t.si("temperature"),
    }
}
