//! Gears and the stages in which they mesh.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, HashMap, HashSet};

use willis::geometry::involute;

use crate::account::{Account, At, Is, rounded};

use super::bodies::Bodies;

/// A gear, in the units of the train file; angles in degrees, lengths in mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Gear {
    pub component: usize,
    /// Root of its body.
    pub body: usize,
    pub teeth: i64,
    pub internal: bool,
    pub module: Option<f64>,
    pub width: Option<f64>,
    /// Helix angle, positive right-hand.
    pub helix: f64,
    pub pressure_angle: Option<f64>,
    /// As Willis has it: positive moves the teeth outward, also on a ring.
    pub shift: Option<f64>,
    pub tip_diameter: Option<f64>,
    pub roughness: Option<f64>,
    /// Modulus of elasticity, MPa, and Poisson's ratio.
    pub material: [Option<f64>; 2],
    /// Along the main axis.
    pub position: Option<f64>,
    /// Across it.
    pub axis: Option<[f64; 2]>,
    /// Two helices of opposite hand.
    pub double: bool,
}

/// Two gears in mesh.
#[derive(Clone, Debug)]
pub struct Stage {
    pub component: usize,
    /// Components of the gears.
    pub gears: [usize; 2],
    /// The planetary stage that it belongs to.
    pub planetary: Option<usize>,
    pub centre_distance: Option<f64>,
    pub width: Option<f64>,
}

/// All gears and stages of a file.
pub struct Gearing {
    pub gears: BTreeMap<usize, Gear>,
    pub stages: Vec<Stage>,
}

/// Directions of the file: the main axis and two across it.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    pub u: [f64; 3],
    v: [f64; 3],
    w: [f64; 3],
}

pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl Frame {
    /// By the first shaft that says where it points.
    pub fn new(account: &mut Account<'_>) -> Self {
        let components = &account.document.components;
        let mut frame = Self { u: [1.0, 0.0, 0.0], v: [0.0, 1.0, 0.0], w: [0.0, 0.0, 1.0] };
        for k in (0..components.len()).filter(|&k| components[k].kind == "shaft") {
            let at = At::model(k);
            if !account.has(at, "u_axis_vector") {
                continue;
            }
            let Some(u) = account.vector(at, "u_axis_vector", "direction of rotation") else { continue };
            let size = dot(u, u).sqrt();
            if size > 0.0 {
                frame.u = u.map(|x| x / size);
                break;
            }
            account.reject(at, "u_axis_vector", "is no direction");
        }
        // Across: the axis that is the least along u first.
        if frame.u != [1.0, 0.0, 0.0] {
            let least = (0..3).min_by(|&a, &b| frame.u[a].abs().total_cmp(&frame.u[b].abs())).unwrap_or(1);
            let mut v = [0.0; 3];
            v[least] = 1.0;
            let along = dot(v, frame.u);
            let v: [f64; 3] = std::array::from_fn(|k| v[k] - along * frame.u[k]);
            let size = dot(v, v).sqrt();
            frame.v = v.map(|x| x / size);
            let (u, v) = (frame.u, frame.v);
            frame.w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        }
        frame
    }

    /// Where a point is along the axis and across it.
    pub fn place(&self, p: [f64; 3]) -> (f64, [f64; 2]) {
        (rounded(dot(p, self.u)), [dot(p, self.v), dot(p, self.w)])
    }
}

/// Types of stages that are no pairs of cylindrical gears.
fn refused(kind: &str) -> Option<&'static str> {
    Some(match kind {
        "worm_stage" => "worm_stage: a worm and its wheel are no train of Willis",
        "bevel_stage" | "spiral_bevel_stage" => {
            "bevel_stage: bevel stages are not read yet; Willis has bevel sets, to be written by hand as a set of \
             `type = \"bevel\"`"
        }
        "hypoid_stage" => {
            "hypoid_stage: hypoid stages are not read yet; Willis has hypoid pairs, to be written by hand as a mesh of \
             `kind = \"bevel\"` with a `spiral_angle` for each gear"
        }
        "beveloid_stage" => "beveloid_stage: beveloid gears are no gears of Willis",
        _ => return None,
    })
}

/// Stages that no train can have, each told once.
pub fn refusals(account: &Account<'_>) -> Vec<(String, &'static str)> {
    let components = &account.document.components;
    let all = (0..components.len()).filter_map(|k| Some((account.called(At::model(k)), refused(&components[k].kind)?)));
    all.collect()
}

impl Gearing {
    pub fn new(account: &mut Account<'_>, bodies: &Bodies, frame: &Frame, outward: bool) -> Self {
        let components = &account.document.components;
        let relations = &account.document.relations;
        let mut planetary: HashMap<usize, usize> = HashMap::new();
        let mut flanks: HashMap<usize, Vec<usize>> = HashMap::new();
        let mut materials: HashMap<usize, usize> = HashMap::new();
        for relation in relations {
            match relation.kind.as_str() {
                "assembly" => {
                    if let (Some(whole), Some(part)) = (bodies.of(relation, "assembly"), bodies.of(relation, "part"))
                        && components[whole].kind == "planetary_stage"
                    {
                        planetary.insert(part, whole);
                    }
                }
                "flank" => {
                    if let Some(gear) = bodies.of(relation, "gear") {
                        let both = ["left", "right"].iter().filter_map(|role| bodies.of(relation, role));
                        flanks.insert(gear, both.collect());
                    }
                }
                "reference" => {
                    if let (Some(origin), Some(to)) = (bodies.of(relation, "origin"), bodies.of(relation, "referenced"))
                        && components[to].kind == "material"
                    {
                        materials.insert(origin, to);
                    }
                }
                _ => {}
            }
        }
        let mut stages = vec![];
        let mut told = vec![false; components.len()];
        for relation in relations.iter().filter(|r| r.kind == "stage") {
            let Some(stage) = bodies.of(relation, "stage") else { continue };
            told[stage] = true;
            if components[stage].kind != "cylindrical_stage" {
                continue;
            }
            let at = At::model(stage);
            let (Some(a), Some(b)) = (bodies.of(relation, "gear_1"), bodies.of(relation, "gear_2")) else {
                account.problem(account.called(at), "the stage has not two gears (gear_1, gear_2) and is left out");
                continue;
            };
            stages.push(Stage {
                component: stage,
                gears: [a, b],
                planetary: planetary.get(&stage).copied(),
                centre_distance: account.number(at, "center_distance", Is::Length, "geometry.centre_distance"),
                width: account.number(at, "common_face_width", Is::Length, "geometry.width"),
            });
        }
        for k in (0..components.len()).filter(|&k| components[k].kind == "cylindrical_stage" && !told[k]) {
            let message = "no relation `stage` says which gears mesh in it; it is left out";
            account.problem(account.called(At::model(k)), message);
        }
        let mut gears: BTreeMap<usize, Gear> = BTreeMap::new();
        let mut reader = Reader { bodies, frame, outward, flanks, materials };
        stages.retain(|stage| {
            let mut read = |k: usize| -> bool {
                if let Entry::Vacant(place) = gears.entry(k) {
                    let Some(gear) = reader.gear(account, k) else { return false };
                    place.insert(gear);
                }
                true
            };
            let both = [read(stage.gears[0]), read(stage.gears[1])];
            if both != [true; 2] {
                account.problem(account.called(At::model(stage.component)), "the stage is left out: a gear is missing");
            }
            both == [true; 2]
        });
        stages.retain(|stage| {
            let [a, b] = stage.gears.map(|g| &gears[&g]);
            let why = if a.internal && b.internal {
                "both gears are ring gears"
            } else if a.body == b.body {
                "both gears sit on one shaft"
            } else {
                return true;
            };
            account.problem(account.called(At::model(stage.component)), format!("the stage is left out: {why}"));
            false
        });
        let mut all = Self { gears, stages };
        all.join_helices();
        all.shifts(account);
        all.tips(account);
        all
    }

    /// Two gears of opposite hand that mesh with two such gears are a double helical pair.
    fn join_helices(&mut self) {
        let alike = |a: &Gear, b: &Gear| {
            a.body == b.body
                && a.teeth == b.teeth
                && a.internal == b.internal
                && a.module == b.module
                && a.helix == -b.helix
                && a.helix != 0.0
        };
        let mut mate: HashMap<usize, usize> = HashMap::new();
        let mut by_body: BTreeMap<(usize, i64), Vec<usize>> = BTreeMap::new();
        for (k, gear) in &self.gears {
            by_body.entry((gear.body, gear.teeth)).or_default().push(*k);
        }
        for all in by_body.values() {
            for (n, a) in all.iter().enumerate() {
                let free = |b: &&usize| !mate.contains_key(*b) && alike(&self.gears[a], &self.gears[*b]);
                if !mate.contains_key(a)
                    && let Some(b) = all[n + 1..].iter().find(free).copied()
                {
                    mate.extend([(*a, b), (b, *a)]);
                }
            }
        }
        // Both halves of a gear mesh with the halves of the same gears, or they are no halves.
        loop {
            let mut partners: HashMap<usize, Vec<Option<usize>>> = HashMap::new();
            for stage in &self.stages {
                let [a, b] = stage.gears;
                partners.entry(a).or_default().push(mate.get(&b).map(|m| b.min(*m)));
                partners.entry(b).or_default().push(mate.get(&a).map(|m| a.min(*m)));
            }
            partners.values_mut().for_each(|all| all.sort());
            let is_half = |k: &usize, m: &usize| {
                partners.get(k) == partners.get(m) && partners.get(k).is_some_and(|all| all.iter().all(Option::is_some))
            };
            let wrong: Vec<usize> = mate.iter().filter(|(k, m)| !is_half(k, m)).map(|(k, _)| *k).collect();
            if wrong.is_empty() {
                break;
            }
            mate.retain(|k, _| !wrong.contains(k));
        }
        let joined: Vec<[usize; 2]> = mate.iter().filter(|(k, m)| k < m).map(|(k, m)| [*k, *m]).collect();
        for [first, second] in joined {
            let other = self.gears.remove(&second).expect("it is a gear");
            let gear = self.gears.get_mut(&first).expect("it is a gear");
            gear.double = true;
            gear.position = gear.position.zip(other.position).map(|(a, b)| rounded((a + b) / 2.0));
            for stage in &mut self.stages {
                stage.gears = stage.gears.map(|g| if g == second { first } else { g });
            }
        }
        let mut seen: HashSet<([usize; 2], Option<usize>)> = HashSet::new();
        let doubles: Vec<usize> = self.gears.iter().filter(|(_, g)| g.double).map(|(k, _)| *k).collect();
        self.stages.retain(|stage| {
            if !stage.gears.iter().all(|g| doubles.binary_search(g).is_ok()) {
                return true;
            }
            seen.insert((stage.gears, stage.planetary))
        });
    }

    /// Σx as a pair needs it for its centre distance: of the second gear by Willis' sign, `± x_1 + x_2`.
    fn sum_of_shifts(&self, stage: &Stage) -> Option<f64> {
        let [a, b] = stage.gears.map(|g| &self.gears[&g]);
        let (module, distance) = (a.module?, stage.centre_distance?);
        let angle = a.pressure_angle.or(b.pressure_angle).unwrap_or(20.0).to_radians();
        let helix = a.helix.to_radians();
        let transverse = (angle.tan() / helix.cos()).atan();
        let sum = match (a.internal, b.internal) {
            (false, false) => a.teeth + b.teeth,
            (true, _) => a.teeth - b.teeth,
            (_, true) => b.teeth - a.teeth,
        } as f64;
        let nominal = module * sum / 2.0 / helix.cos();
        let cosine = nominal / distance * transverse.cos();
        if !(0.0..=1.0).contains(&cosine) || distance <= 0.0 {
            return None;
        }
        Some(sum * (involute(cosine.acos()) - involute(transverse)) / (2.0 * angle.tan()))
    }

    /// Shifts that are not given follow from the centre distance and the shift of the other gear.
    fn shifts(&mut self, account: &mut Account<'_>) {
        loop {
            let mut found = None;
            for stage in &self.stages {
                let [a, b] = stage.gears.map(|g| &self.gears[&g]);
                let (known, open) = match (a.shift, b.shift) {
                    (Some(x), None) => (x, b),
                    (None, Some(x)) => (x, a),
                    _ => continue,
                };
                let Some(sum) = self.sum_of_shifts(stage) else { continue };
                // External: x_1 + x_2 = sum. With a ring: x_ring - x_other = sum.
                let x = match (open.internal, a.internal || b.internal) {
                    (true, _) => sum + known,
                    (false, true) => known - sum,
                    (false, false) => sum - known,
                };
                // Centre distances are written with a few digits.
                let x = (x * 1e6).round() / 1e6;
                found = Some((open.component, if x.abs() < 5e-5 { 0.0 } else { x }));
                break;
            }
            let Some((component, x)) = found else { break };
            self.gears.get_mut(&component).expect("it is a gear").shift = Some(x);
            let of = format!("profile shift of {}", account.called(At::model(component)));
            account.guess(of, x.to_string(), "it follows from the centre distance and the other gear");
        }
        for gear in self.gears.values_mut().filter(|g| g.shift.is_none() && g.module.is_some()) {
            gear.shift = Some(0.0);
            let of = format!("profile shift of {}", account.called(At::model(gear.component)));
            account.guess(of, "0", "the file does not give it");
        }
    }

    /// Tip circles that no tooth can have are not used.
    fn tips(&mut self, account: &mut Account<'_>) {
        for gear in self.gears.values_mut() {
            let (Some(tip), Some(module)) = (gear.tip_diameter, gear.module) else { continue };
            let helix = gear.helix.to_radians();
            let reference = module * gear.teeth as f64 / helix.cos();
            let angle = gear.pressure_angle.unwrap_or(20.0).to_radians();
            let base = reference * (angle.tan() / helix.cos()).atan().cos();
            let pitch = reference + 2.0 * module * gear.shift.unwrap_or(0.0);
            // A tooth ends between its base circle and twice the usual height above the shifted reference line.
            let range = match gear.internal {
                false => base.max(pitch - 2.0 * module)..=pitch + 4.0 * module,
                true => base.max(pitch - 4.0 * module)..=pitch + 2.0 * module,
            };
            if !range.contains(&tip) {
                let why = format!(
                    "{tip} mm is impossible for {} teeth of module {module} mm: a tip diameter from {:.2} mm to {:.2} mm \
                     could be; the usual one is taken",
                    gear.teeth,
                    range.start(),
                    range.end()
                );
                account.reject(At::model(gear.component), "tip_diameter", why);
                gear.tip_diameter = None;
            }
        }
    }
}

struct Reader<'a> {
    bodies: &'a Bodies,
    frame: &'a Frame,
    /// Whether the shift of a ring is positive outward.
    outward: bool,
    flanks: HashMap<usize, Vec<usize>>,
    materials: HashMap<usize, usize>,
}

impl Reader<'_> {
    fn gear(&mut self, account: &mut Account<'_>, component: usize) -> Option<Gear> {
        let at = At::model(component);
        let kind = account.document.components[component].kind.as_str();
        if !["cylindrical_gear", "ring_gear"].contains(&kind) {
            account.problem(account.called(at), "it is no cylindrical gear");
            return None;
        }
        let teeth = account.integer(at, "number_of_teeth", "teeth")?;
        if teeth == 0 || teeth.abs() > 100_000 {
            account.reject(at, "number_of_teeth", format!("there is no gear of {teeth} teeth"));
            return None;
        }
        if teeth < 0 && kind != "ring_gear" {
            account.guess(account.called(at), "a ring gear", "its tooth count is negative");
        }
        let internal = kind == "ring_gear" || teeth < 0;
        let positive = |account: &mut Account<'_>, id: &str, is: Is, what: &str| -> Option<f64> {
            let x = account.number(at, id, is, what)?;
            if x > 0.0 {
                return Some(x);
            }
            account.reject(at, id, format!("{x} is not positive"));
            None
        };
        let module = positive(account, "normal_module", Is::Length, "geometry.module");
        let width = positive(account, "face_width", Is::Length, "geometry.width");
        // A ring of negative tooth count has a negative tip diameter too.
        let tip_diameter = account.number(at, "tip_diameter", Is::Length, "tip_diameter");
        let tip_diameter = tip_diameter.map(|d| if teeth < 0 { d.abs() } else { d });
        let helix = account.number(at, "helix_angle_reference_diameter", Is::Angle, "geometry.helix").unwrap_or(0.0);
        let helix = if helix.abs() < 90.0 {
            helix + 0.0
        } else {
            account.reject(at, "helix_angle_reference_diameter", format!("{helix} deg is no helix angle"));
            0.0
        };
        let roughness = positive(account, "arithmetic_average_roughness_flank", Is::Roughness, "roughness");
        let roughness = roughness.or_else(|| {
            let what = "roughness, as Rz = 6 Ra";
            let rz = positive(account, "averaged_peak_to_valley_height_flank", Is::Roughness, what)?;
            let ra = rounded(rz / 6.0);
            account.guess(format!("roughness Ra of {}", account.called(at)), format!("{ra} um"), "Rz over 6");
            Some(ra)
        });
        let places: Vec<At> =
            self.flanks.get(&component).into_iter().flatten().map(|k| At::model(*k)).chain([at]).collect();
        let mut of_flanks = |id: &str, is: Is, what: &str| -> Option<f64> {
            let all: Vec<f64> = places.iter().filter_map(|at| account.number(*at, id, is, what)).collect();
            let first = *all.first()?;
            if all.iter().any(|x| (x - first).abs() > 1e-9) {
                let message = format!("{id} differs between the flanks; {first} is taken for both");
                account.problem(account.called(at), message);
            }
            Some(first)
        };
        let pressure_angle = of_flanks("normal_pressure_angle", Is::Angle, "geometry.pressure_angle");
        let sign = "shift, with the sign of a ring reversed";
        let what = if internal { sign } else { "shift" };
        let shift = of_flanks("addendum_modification_coefficient", Is::Number, what);
        // DIN 3960: positive moves the reference line towards the tip, inward on a ring.
        let shift = shift.map(|x| if internal && !self.outward { 0.0 - x } else { x });
        let pressure_angle = pressure_angle.filter(|a| (5.0..45.0).contains(a));
        let material = match self.materials.get(&component).map(|k| At::model(*k)) {
            Some(at) => [
                account.number(at, "elastic_modulus", Is::Pressure, "geometry.youngs_modulus"),
                account.number(at, "poisson_ratio", Is::Number, "geometry.poisson_ratio"),
            ],
            None => [None, None],
        };
        let place = place(account, component, self.frame);
        Some(Gear {
            component,
            body: self.bodies.root(component),
            teeth: teeth.abs(),
            internal,
            module,
            width,
            helix,
            pressure_angle,
            shift,
            tip_diameter,
            roughness,
            material,
            position: place.map(|p| p.0),
            axis: place.map(|p| p.1),
            double: false,
        })
    }
}

/// Where a component is, if it is told from the origin of the gearbox.
pub fn place(account: &mut Account<'_>, component: usize, frame: &Frame) -> Option<(f64, [f64; 2])> {
    let at = At::model(component);
    if !account.has(at, "support_vector") {
        return None;
    }
    let p = account.vector(at, "support_vector", "geometry.position")?;
    let unit = account.unit.map(|k| account.document.components[k].id);
    let reference = account.integer(at, "reference_component_for_position", "geometry.position");
    if reference.is_some() && reference != unit {
        account.forget(at, "support_vector");
        return None;
    }
    Some(frame.place(p))
}
