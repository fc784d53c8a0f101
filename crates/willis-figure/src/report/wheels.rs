//! The data sheet of every wheel whose teeth are given, and of the pairs in which they run.

use willis::train::{Mesh, Teeth, Train};

use super::results::significant;
use crate::report::document::{Block, Column};

/// Wheels beside each other.
const BESIDE: usize = 7;

/// A wheel with what is known of it. A planet that meets several others is one wheel.
struct Sheet<'t> {
    name: &'t str,
    teeth: String,
    internal: bool,
    /// By row of the sheet.
    values: Vec<String>,
}

/// A row of the sheet: its name, its value for wheel `k` of a pair in the unit of the name, and how many digits it has.
type Row = (&'static str, fn(&Teeth, usize) -> f64, i32);

const ROWS: [Row; 12] = [
    ("Normal module mₙ, mm", |t, _| t.pair.data.module * 1e3, 4),
    ("Normal pressure angle αₙ, °", |t, _| t.pair.data.pressure_angle.to_degrees(), 5),
    ("Helix angle β, °", |t, _| t.pair.data.helix.to_degrees(), 5),
    ("Profile shift x", |t, k| t.pair.data.wheels[k].shift, 4),
    ("Face width b, mm", |t, _| t.pair.data.width * 1e3, 5),
    ("Reference diameter d, mm", |t, k| 2e3 * t.pair.gears[k].reference_radius, 6),
    ("Base diameter, mm", |t, k| 2e3 * t.pair.gears[k].base_radius, 6),
    ("Tip diameter, mm", |t, k| 2e3 * t.pair.gears[k].tip_radius, 6),
    ("Root diameter, mm", |t, k| 2e3 * t.pair.gears[k].root_radius, 6),
    ("Tooth thickness at the tip, mm", |t, k| 1e3 * t.pair.gears[k].tip_thickness, 4),
    ("Roughness Ra, µm", |t, k| t.roughness[k] * 1e6, 3),
    ("Modulus of elasticity, GPa", |t, _| t.youngs_modulus / 1e9, 3),
];

/// Data sheets: wheels set by set, then the pairs.
pub fn sheets(train: &Train) -> Vec<Block> {
    let mut sets: Vec<Option<usize>> = train.meshes().iter().map(|m| m.set).collect();
    sets.dedup();
    let mut all = vec![];
    for set in sets {
        let meshes: Vec<&Mesh> = train
            .meshes()
            .iter()
            .filter(|m| m.set == set && m.teeth.as_ref().is_some_and(|t| t.cones.is_none()))
            .collect();
        let wheels = wheels(train, &meshes);
        let name = set.and_then(|k| train.sets().get(k)).map_or("pairs of gears".to_owned(), |s| s.name.clone());
        let parts = wheels.len().div_ceil(BESIDE).max(1);
        for some in wheels.chunks(wheels.len().div_ceil(parts).max(1)) {
            all.push(table(&name, some));
        }
    }
    all.extend(pairs(train));
    all
}

fn wheels<'t>(train: &'t Train, meshes: &[&'t Mesh]) -> Vec<Sheet<'t>> {
    let mut all: Vec<Sheet<'t>> = vec![];
    for m in meshes {
        let Some(t) = &m.teeth else { continue };
        for k in [0, 1] {
            let g = &m.gears[k];
            let (name, teeth) = (train.member_name(g.member), significant(g.teeth.to_f64(), 6));
            let values = ROWS.iter().map(|(_, of, digits)| significant(rounded(of(t, k)), *digits)).collect();
            let own = Sheet { name, teeth, internal: g.internal, values };
            // The tip of a planet may be another against each partner: then both are shown.
            if !all.iter().any(|w| w.name == own.name && w.teeth == own.teeth && w.values == own.values) {
                all.push(own);
            }
        }
    }
    all
}

/// Round-off of angles and shifts is none.
fn rounded(x: f64) -> f64 {
    if x.abs() < 1e-9 { 0.0 } else { x }
}

fn table(set: &str, wheels: &[Sheet<'_>]) -> Block {
    let kind = |w: &Sheet<'_>| if w.internal { "internal" } else { "external" };
    let mut rows: Vec<Vec<String>> = vec![];
    let mut row = |name: &str, cell: &dyn Fn(&Sheet<'_>) -> String| {
        rows.push([name.to_owned()].into_iter().chain(wheels.iter().map(cell)).collect());
    };
    row("Number of teeth z", &|w| w.teeth.clone());
    row("Teeth", &|w| kind(w).to_owned());
    for (k, (name, ..)) in ROWS.iter().enumerate() {
        row(name, &|w| w.values[k].clone());
    }
    let columns = [Column::words("Wheel")].into_iter();
    let columns = columns.chain(wheels.iter().map(|w| Column::numbers(w.name))).collect();
    Block::Table { caption: format!("Data of the wheels of {set}"), columns, rows }
}

/// What belongs to a pair and not to a wheel.
fn pairs(train: &Train) -> Option<Block> {
    let heads = ["Pairs", "a, mm", "αₜ, °", "α′ₜ, °", "εα", "εβ", "Backlash, mm"];
    let columns = [Column::words("Mesh")].into_iter().chain(heads.map(Column::numbers)).collect();
    let rows: Vec<Vec<String>> = (train.meshes().iter())
        .filter_map(|m| {
            let p = &m.teeth.as_ref()?.pair;
            let n = |x: f64| significant(rounded(x), 4);
            Some(vec![
                m.name.clone(),
                m.count.to_string(),
                significant(p.centre_distance * 1e3, 6),
                n(p.transverse_pressure_angle.to_degrees()),
                n(p.operating_pressure_angle.to_degrees()),
                n(p.contact_ratio),
                n(p.overlap_ratio),
                significant(rounded(p.backlash * 1e3), 3),
            ])
        })
        .collect();
    let double = train.meshes().iter().any(|m| m.teeth.as_ref().is_some_and(|t| t.pair.data.double_helical));
    let halves = if double { ". Double helical wheels: the face width is that of each half" } else { "" };
    let caption = format!(
        "Pairs: centre distance a, transverse pressure angle αₜ and operating pressure angle α′ₜ, transverse contact ratio εα, \
         overlap ratio εβ, backlash{halves}"
    );
    (!rows.is_empty()).then_some(Block::Table { caption, columns, rows })
}
