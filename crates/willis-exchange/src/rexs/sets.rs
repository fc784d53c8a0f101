//! Planetary stages as sets, other stages as meshes, in the text of the train file.

use std::collections::{BTreeMap, HashMap};

use crate::account::{Account, At};
use crate::document::Relation;
use crate::text::{self, Taken, number, quantity, quoted};

use super::bodies::{Bodies, without_number};
use super::gears::{Gear, Gearing, Stage};

/// What sets and meshes became.
#[derive(Default)]
pub struct Written {
    pub toml: String,
    /// Names of planets and of members by their bodies.
    pub rotors: HashMap<usize, String>,
    /// Bodies of planets, with the body that stands for all that are alike.
    pub planets: HashMap<usize, usize>,
    /// Members, in the order in which they are met.
    pub members: Vec<String>,
    /// How many meshes there are, each with its parallel ones.
    pub meshes: usize,
    /// Bodies of members with the number of meshes at each.
    pub ends: BTreeMap<usize, usize>,
}

/// Planets of one kind.
struct Class {
    bodies: Vec<usize>,
}

struct Writer<'a, 'd> {
    account: &'a mut Account<'d>,
    bodies: &'a mut Bodies,
    gearing: &'a Gearing,
    out: Written,
    /// Names of sets.
    taken: Taken,
    mesh_names: Taken,
}

/// Writes all stages.
pub fn write(account: &mut Account<'_>, bodies: &mut Bodies, gearing: &Gearing) -> Written {
    let carriers = carriers(account, bodies);
    let (taken, mesh_names) = (Taken::default(), Taken::default());
    let mut writer = Writer { account, bodies, gearing, out: Written::default(), taken, mesh_names };
    let mut by_stage: BTreeMap<usize, Vec<&Stage>> = BTreeMap::new();
    let mut fixed: Vec<&Stage> = vec![];
    for stage in &gearing.stages {
        match stage.planetary {
            Some(set) => by_stage.entry(set).or_default().push(stage),
            None => fixed.push(stage),
        }
    }
    for (set, stages) in by_stage {
        match carriers.get(&set) {
            Some(carrier) => writer.planetary(set, *carrier, &stages),
            None => {
                let message = "no relation `planet_carrier_shaft` says what carries its planets; it is left out";
                let called = writer.account.called(At::model(set));
                writer.account.problem(called, message);
            }
        }
    }
    writer.fixed(&fixed);
    writer.out
}

/// Bodies of the carriers by planetary stage.
fn carriers(account: &mut Account<'_>, bodies: &mut Bodies) -> HashMap<usize, usize> {
    let components = &account.document.components;
    let mut all: HashMap<usize, usize> = HashMap::new();
    for relation in &account.document.relations {
        let (stage, part) = match relation.kind.as_str() {
            "planet_carrier_shaft" => (bodies.of(relation, "planetary_stage"), bodies.of(relation, "shaft")),
            "assembly" => {
                let part = bodies.of(relation, "part").filter(|p| components[*p].kind == "planet_carrier");
                (bodies.of(relation, "assembly").filter(|s| components[*s].kind == "planetary_stage"), part)
            }
            _ => continue,
        };
        let (Some(stage), Some(part)) = (stage, part) else { continue };
        let root = bodies.root(part);
        let before = all.get(&stage).map(|b| bodies.root(*b));
        if let Some(before) = before.filter(|b| *b != root) {
            let called = account.called(At::model(stage));
            account.guess(format!("carrier of {called}"), "one part", "its shafts are not joined in the file");
            bodies.join_also(before, root);
        }
        all.insert(stage, root);
    }
    all.into_iter().map(|(stage, body)| (stage, bodies.root(body))).collect()
}

impl Writer<'_, '_> {
    fn gear(&self, component: usize) -> &Gear {
        &self.gearing.gears[&component]
    }

    /// The root of a gear's body: bodies may have been joined after it was read.
    fn body(&self, gear: usize) -> usize {
        self.bodies.root(gear)
    }

    /// The name of the member that a body is, which becomes one by this.
    fn member(&mut self, body: usize) -> String {
        let name = self.bodies.name(self.account, body);
        if name != "frame" {
            self.out.rotors.insert(body, name.clone());
            if !self.out.members.contains(&name) {
                self.out.members.push(name.clone());
            }
        }
        name
    }

    fn met(&mut self, body: usize) {
        *self.out.ends.entry(body).or_default() += 1;
    }

    fn problem(&mut self, component: usize, message: impl Into<String>) {
        let called = self.account.called(At::model(component));
        self.account.problem(called, message);
    }

    /// A planetary stage: one set if there is a type for it, else a mesh for each kind of pair.
    fn planetary(&mut self, set: usize, carrier: usize, stages: &[&Stage]) {
        let document = self.account.document;
        let of = |kind: &str| -> Vec<usize> {
            let is_own = |r: &&Relation| r.kind == kind && self.bodies.of(r, "planetary_stage") == Some(set);
            let own = document.relations.iter().filter(is_own);
            own.filter_map(|r| self.bodies.of(r, "shaft")).map(|k| self.bodies.root(k)).collect()
        };
        let (mut planets, central): (Vec<usize>, Vec<usize>) = (of("planet_shaft"), of("central_shaft"));
        planets.sort_unstable();
        planets.dedup();
        if planets.is_empty() {
            let all = stages.iter().flat_map(|s| s.gears).map(|g| self.body(g));
            planets = all.filter(|b| !central.contains(b) && *b != carrier && !self.bodies.is_frame(*b)).collect();
            planets.sort_unstable();
            planets.dedup();
            let called = self.account.called(At::model(set));
            if central.is_empty() {
                let message =
                    "no relation `planet_shaft` or `central_shaft` says which gears are planets; it is left out";
                return self.account.problem(called, message);
            }
            self.account.guess(
                format!("planets of {called}"),
                "all shafts that are not central",
                "no relation names them",
            );
        }
        let is_planet = |b: usize| planets.binary_search(&b).is_ok();
        // Gears and what they mesh with, which is the same for planets of one kind.
        let mut marks: BTreeMap<usize, Vec<String>> = BTreeMap::new();
        for stage in stages {
            for (own, other) in [(0, 1), (1, 0)] {
                let (own, other) = (stage.gears[own], stage.gears[other]);
                let body = self.body(own);
                if is_planet(body) {
                    let (g, o) = (self.gear(own), self.gear(other));
                    let of =
                        if is_planet(self.body(other)) { format!("planet {}", o.teeth) } else { other.to_string() };
                    marks.entry(body).or_default().push(format!("{} {:?} {of}", g.teeth, g.module));
                }
            }
        }
        marks.values_mut().for_each(|m| m.sort());
        let mut classes: Vec<(&Vec<String>, Class)> = vec![];
        for (body, mark) in &marks {
            match classes.iter_mut().find(|c| c.0 == mark) {
                Some((_, class)) => class.bodies.push(*body),
                None => classes.push((mark, Class { bodies: vec![*body] })),
            }
        }
        let classes: Vec<Class> = classes.into_iter().map(|c| c.1).collect();
        let count = classes.iter().map(|c| c.bodies.len()).min().unwrap_or(0);
        if count == 0 {
            return self.problem(set, "none of its planets meshes with anything; it is left out");
        }
        if classes.iter().any(|c| c.bodies.len() != count) {
            let many: Vec<String> = classes.iter().map(|c| c.bodies.len().to_string()).collect();
            let message =
                format!("its planets differ ({} of each kind): a relation or an attribute is missing", many.join(", "));
            self.problem(set, message);
        }
        // One pair of each kind.
        let class_of = |body: usize| classes.iter().position(|c| c.bodies.contains(&body));
        let mut pairs: Vec<([Option<usize>; 2], &Stage, usize)> = vec![];
        for stage in stages {
            let kinds = stage.gears.map(|g| class_of(self.body(g)));
            if kinds == [None, None] {
                self.problem(stage.component, "neither gear is a planet; it is left out");
                continue;
            }
            let sides = |s: &Stage| s.gears.map(|g| class_of(self.body(g)).ok_or(g));
            let alike = |p: &([Option<usize>; 2], &Stage, usize)| {
                let teeth = |s: &Stage| s.gears.map(|g| self.gear(g).teeth);
                sides(p.1) == sides(stage) && teeth(p.1) == teeth(stage)
            };
            match pairs.iter_mut().find(|p| alike(p)) {
                Some(pair) => pair.2 += 1,
                None => pairs.push((kinds, stage, 1)),
            }
        }
        let c = &self.account.document.components[set];
        let name = text::name(without_number(&c.name), &format!("P{}", self.taken.len() + 1), &mut self.taken);
        self.out.toml.push_str(&format!("\n{}", text::comment(&self.account.called(At::model(set)))));
        let stages: Vec<&Stage> = pairs.iter().map(|p| p.1).collect();
        let carrier_name = self.bodies.name(self.account, carrier);
        let written = match classes.len() {
            1 => self.one_kind(&name, &carrier_name, count, &pairs, &stages),
            2 => self.two_kinds(&name, &carrier_name, count, &pairs, &stages),
            _ => None,
        };
        let names: Vec<String> = match written {
            Some((body, names)) => {
                self.out.toml.push_str(&body);
                names.into_iter().map(|n| format!("{name}.{n}")).collect()
            }
            None => {
                let names: Vec<String> = (0..classes.len()).map(|k| format!("{name} planet {}", k + 1)).collect();
                self.out.members.extend(names.iter().cloned());
                for (kinds, stage, many) in &pairs {
                    let rotors = [0, 1].map(|k| kinds[k].map(|c| names[c].clone()));
                    self.mesh(stage, Some(&carrier_name), *many, rotors, None);
                }
                names
            }
        };
        self.member(carrier);
        self.out.meshes += pairs.len();
        for (class, name) in classes.iter().zip(names) {
            for body in &class.bodies {
                self.out.rotors.insert(*body, name.clone());
                self.out.planets.insert(*body, class.bodies[0]);
            }
        }
        self.met(carrier);
        for stage in stages {
            for body in stage.gears.map(|g| self.body(g)) {
                if !is_planet(body) {
                    self.met(body);
                }
            }
        }
    }

    /// Sun, planets and ring, or stepped planets with any suns and rings.
    fn one_kind(
        &mut self,
        name: &str,
        carrier: &str,
        count: usize,
        pairs: &[([Option<usize>; 2], &Stage, usize)],
        stages: &[&Stage],
    ) -> Option<(String, Vec<&'static str>)> {
        // Which gear of each pair is the planet's.
        let planet_at: Vec<usize> = pairs.iter().map(|p| usize::from(p.0[0].is_none())).collect();
        if pairs.iter().any(|p| p.0.iter().all(Option::is_some)) || pairs.iter().any(|p| p.2 > count) {
            return None;
        }
        let planets: Vec<usize> = stages.iter().zip(&planet_at).map(|(s, k)| s.gears[*k]).collect();
        let centrals: Vec<usize> = stages.iter().zip(&planet_at).map(|(s, k)| s.gears[1 - *k]).collect();
        if planets.iter().any(|g| self.gear(*g).internal) {
            return None;
        }
        let suns = centrals.iter().filter(|g| !self.gear(**g).internal).count();
        let head = format!("[[set]]\nname = {}\n", quoted(name));
        let tail = format!("carrier = {}\n", quoted(carrier));
        if stages.len() == 2 && suns == 1 && planets[0] == planets[1] {
            let (sun, ring) = if self.gear(centrals[0]).internal { (1, 0) } else { (0, 1) };
            let geometry = self.geometry(&[stages[sun], stages[ring]], centrals[sun])?;
            let common = self.roughness(&[centrals[sun], planets[0], centrals[ring]]);
            let (sun, ring) = (self.central(centrals[sun], common), self.central(centrals[ring], common));
            let (teeth, tooth) = (self.gear(planets[0]).teeth, self.tooth(planets[0], common));
            let geometry = with_roughness(geometry, common);
            let body = format!(
                "{head}sun = {sun}\nplanet = {{ teeth = {teeth}, count = {count}{tooth} }}\nring = {ring}\n{tail}{geometry}"
            );
            return Some((body, vec!["planet"]));
        }
        let mut lists = [vec![], vec![]];
        for ((stage, planet), central) in stages.iter().zip(&planets).zip(&centrals) {
            let geometry = self.geometry(&[*stage], *central)?;
            let common = self.roughness(&[*central, *planet]);
            let tooth = self.tooth(*planet, common).trim_start_matches(", ").to_owned();
            let tooth = if tooth.is_empty() { tooth } else { format!(", planet = {{ {tooth} }}") };
            let geometry = with_roughness(geometry, common);
            let geometry = geometry.trim_end();
            let geometry = if geometry.is_empty() { String::new() } else { format!(", {geometry}") };
            let central_text = self.central(*central, common);
            let inner = central_text.trim_start_matches("{ ").trim_end_matches(" }").to_owned();
            let step = format!("  {{ {inner}, planet_teeth = {}{tooth}{geometry} }},\n", self.gear(*planet).teeth);
            lists[usize::from(self.gear(*central).internal)].push(step);
        }
        let [suns, rings] = lists.map(|l| l.concat());
        let list = |key: &str, steps: String| if steps.is_empty() { steps } else { format!("{key} = [\n{steps}]\n") };
        let body = format!(
            "{head}type = \"stepped\"\n{}{}planet = {{ count = {count} }}\n{tail}",
            list("suns", suns),
            list("rings", rings)
        );
        Some((body, vec!["planet"]))
    }

    /// Inner and outer planets, or short and long ones.
    fn two_kinds(
        &mut self,
        name: &str,
        carrier: &str,
        count: usize,
        pairs: &[([Option<usize>; 2], &Stage, usize)],
        stages: &[&Stage],
    ) -> Option<(String, Vec<&'static str>)> {
        let both = pairs.iter().filter(|p| p.0.iter().all(Option::is_some)).count();
        if both != 1 || pairs.iter().any(|p| p.2 != count) {
            return None;
        }
        // Each kind of planet has one gear, and meshes with these suns and rings.
        let mut gears = [None, None];
        let mut centrals: [[Option<usize>; 2]; 2] = [[None; 2]; 2];
        for (kinds, stage, _) in pairs {
            for k in [0, 1] {
                let Some(class) = kinds[k] else { continue };
                let teeth = self.gear(stage.gears[k]).teeth;
                if self.gear(stage.gears[k]).internal || gears[class].is_some_and(|g| self.gear(g).teeth != teeth) {
                    return None;
                }
                gears[class].get_or_insert(stage.gears[k]);
                if kinds[1 - k].is_none() {
                    let central = stage.gears[1 - k];
                    let place = &mut centrals[class][usize::from(self.gear(central).internal)];
                    if place.replace(central).is_some() {
                        return None;
                    }
                }
            }
        }
        let gears = [gears[0]?, gears[1]?];
        let ring_at = centrals.iter().position(|c| c[1].is_some());
        let (short, long) = match ring_at {
            Some(long) => (1 - long, long),
            None => (0, 1),
        };
        if centrals[short][1].is_some() {
            return None;
        }
        let sun = centrals[short][0]?;
        let geometry = self.geometry(stages, sun)?;
        let all: Vec<usize> = centrals.iter().flatten().flatten().copied().chain(gears).collect();
        let common = self.roughness(&all);
        let planet = |w: &Self, k: usize| {
            format!("{{ teeth = {}, count = {count}{} }}", w.gear(gears[k]).teeth, w.tooth(gears[k], common))
        };
        let (short_planet, long_planet) = (planet(self, short), planet(self, long));
        let mut body = format!("[[set]]\nname = {}\n", quoted(name));
        let names = match (centrals[long][0], centrals[long][1]) {
            (None, Some(ring)) => {
                body.push_str(&format!(
                    "type = \"double-planet\"\nsun = {}\ninner_planet = {short_planet}\nouter_planet = {long_planet}\nring = {}\n",
                    self.central(sun, common),
                    self.central(ring, common)
                ));
                vec!["inner_planet", "outer_planet"]
            }
            (Some(large), ring) => {
                body.push_str(&format!(
                    "type = \"ravigneaux\"\nsmall_sun = {}\nlarge_sun = {}\n",
                    self.central(sun, common),
                    self.central(large, common)
                ));
                if let Some(ring) = ring {
                    body.push_str(&format!("ring = {}\n", self.central(ring, common)));
                }
                body.push_str(&format!("short_planet = {short_planet}\nlong_planet = {long_planet}\n"));
                vec!["short_planet", "long_planet"]
            }
            (None, None) => return None,
        };
        body.push_str(&format!("carrier = {}\n{}", quoted(carrier), with_roughness(geometry, common)));
        let mut names = names;
        if short == 1 {
            names.reverse();
        }
        Some((body, names))
    }

    /// Stages whose axes are fixed in the housing.
    fn fixed(&mut self, stages: &[&Stage]) {
        let mut pairs: Vec<(&Stage, usize)> = vec![];
        for stage in stages {
            let alike = |p: &(&Stage, usize)| {
                [0, 1].iter().all(|&k| {
                    let (a, b) = (self.gear(p.0.gears[k]), self.gear(stage.gears[k]));
                    self.body(a.component) == self.body(b.component)
                        && (a.teeth, a.internal, a.module, a.helix) == (b.teeth, b.internal, b.module, b.helix)
                })
            };
            match pairs.iter_mut().find(|p| alike(p)) {
                Some(pair) => pair.1 += 1,
                None => pairs.push((*stage, 1)),
            }
        }
        self.out.meshes += pairs.len();
        for (stage, count) in pairs {
            self.out.toml.push_str(&format!("\n{}", text::comment(&self.account.called(At::model(stage.component)))));
            let [a, b] = stage.gears.map(|g| self.gear(g));
            let angle = match (a.axis, b.axis) {
                (Some(p), Some(q)) if (p[0] - q[0]).hypot(p[1] - q[1]) > 1e-6 => {
                    Some((q[1] - p[1]).atan2(q[0] - p[0]).to_degrees())
                }
                _ => None,
            };
            // A mesh whose first gear is a ring has its axis inside: the direction is the same line.
            self.mesh(stage, None, count, [None, None], angle);
            for gear in stage.gears {
                self.met(self.body(gear));
            }
        }
    }

    fn mesh(
        &mut self,
        stage: &Stage,
        carrier: Option<&str>,
        count: usize,
        rotors: [Option<String>; 2],
        angle: Option<f64>,
    ) {
        let [first, second] = rotors;
        let names = [(first, stage.gears[0]), (second, stage.gears[1])].map(|(rotor, gear)| match rotor {
            Some(name) => name,
            None => {
                let body = self.body(gear);
                self.member(body)
            }
        });
        let c = &self.account.document.components[stage.component];
        let name = text::name(without_number(&c.name), &format!("stage {}", c.id), &mut self.mesh_names);
        let common = self.roughness(&stage.gears);
        let geometry = self.geometry(&[stage], stage.gears[0]).unwrap_or_default();
        let gear = |w: &Self, k: usize| {
            let g = w.gear(stage.gears[k]);
            let internal = if g.internal { ", internal = true" } else { "" };
            let tooth = w.tooth(stage.gears[k], common);
            format!("  {{ member = {}, teeth = {}{internal}{tooth} }},\n", quoted(&names[k]), g.teeth)
        };
        let mut body = format!("[[mesh]]\nname = {}\ngears = [\n{}{}]\n", quoted(&name), gear(self, 0), gear(self, 1));
        if let Some(carrier) = carrier {
            body.push_str(&format!("carrier = {}\n", quoted(carrier)));
        }
        if count > 1 {
            body.push_str(&format!("count = {count}\n"));
        }
        body.push_str(&with_roughness(geometry, common));
        if let Some(angle) = angle {
            body.push_str(&format!("angle = {}\n", quantity((angle * 1e9).round() / 1e9 + 0.0, "deg")));
        }
        self.out.toml.push_str(&body);
    }

    /// A sun or ring gear.
    fn central(&mut self, gear: usize, common: Option<f64>) -> String {
        let body = self.body(gear);
        let member = self.member(body);
        format!("{{ member = {}, teeth = {}{} }}", quoted(&member), self.gear(gear).teeth, self.tooth(gear, common))
    }

    /// Keys of the teeth of one gear, each after a comma.
    fn tooth(&self, gear: usize, common: Option<f64>) -> String {
        let g = self.gear(gear);
        let mut out = String::new();
        if g.module.is_none() {
            return out;
        }
        if let Some(x) = g.shift.filter(|x| *x != 0.0) {
            out.push_str(&format!(", shift = {}", number(x)));
        }
        if let Some(d) = g.tip_diameter {
            out.push_str(&format!(", tip_diameter = {}", quantity(d, "mm")));
        }
        if let Some(ra) = g.roughness.filter(|_| common.is_none()) {
            out.push_str(&format!(", roughness = {}", quantity(ra, "um")));
        }
        out
    }

    /// The roughness that all of these gears have.
    fn roughness(&self, gears: &[usize]) -> Option<f64> {
        let first = self.gear(*gears.first()?).roughness?;
        gears.iter().all(|g| self.gear(*g).roughness == Some(first)).then_some(first)
    }

    /// What all teeth of these stages have in common; empty if there is no module, none if they have no one geometry.
    /// The first of them is the gear whose hand counts.
    fn geometry(&mut self, stages: &[&Stage], first: usize) -> Option<String> {
        let gears: Vec<usize> = stages.iter().flat_map(|s| s.gears).collect();
        let all: Vec<Gear> = gears.iter().map(|g| self.gear(*g).clone()).collect();
        let place = stages[0].component;
        if all.iter().any(|g| g.module.is_none()) {
            self.problem(
                place,
                "a gear has no module (`normal_module`): teeth without geometry, and no losses of them",
            );
            return Some(String::new());
        }
        let differs = |a: f64, b: f64| (a - b).abs() > 1e-9 * a.abs().max(b.abs());
        let module = all[0].module?;
        if all.iter().any(|g| differs(g.module.unwrap_or(module), module)) {
            let told: Vec<String> = all.iter().filter_map(|g| g.module).map(|m| m.to_string()).collect();
            if stages.len() == 1 {
                let message = format!("its gears have modules {} mm: they cannot mesh", told.join(" and "));
                self.problem(place, message);
                return Some(String::new());
            }
            return None;
        }
        let helix = all[0].helix.abs();
        if all.iter().any(|g| differs(g.helix.abs(), helix)) {
            self.problem(place, "its gears have different helix angles; that of the first is taken");
        }
        for stage in stages {
            let [a, b] = stage.gears.map(|g| self.gear(g).clone());
            let same = a.helix * b.helix > 0.0;
            if a.helix != 0.0 && b.helix != 0.0 && same != (a.internal || b.internal) {
                let which = if same { "the same" } else { "opposite" };
                self.problem(
                    stage.component,
                    format!("its gears have {which} hands, which cannot mesh; that of the first counts"),
                );
            }
        }
        let mut fields = vec![format!("module = {}", quantity(module, "mm"))];
        let width = |s: &&Stage| {
            let [a, b] = s.gears.map(|g| self.gear(g).width);
            s.width.or_else(|| Some(a?.min(b?))).or(a).or(b)
        };
        let widths: Vec<f64> = stages.iter().filter_map(width).collect();
        let Some(least) = widths.iter().copied().reduce(f64::min) else {
            self.problem(place, "no gear has a width (`face_width`): teeth without geometry, and no losses of them");
            return Some(String::new());
        };
        if widths.iter().any(|w| differs(*w, least)) {
            self.problem(place, format!("its pairs differ in width; {least} mm is taken for all"));
        }
        fields.push(format!("width = {}", quantity(least, "mm")));
        let angles: Vec<f64> = all.iter().filter_map(|g| g.pressure_angle).collect();
        match angles.first() {
            Some(a) if angles.iter().any(|b| differs(*a, *b)) => {
                self.problem(place, format!("its gears have different pressure angles; {a} deg is taken"));
                fields.push(format!("pressure_angle = {}", quantity(*a, "deg")));
            }
            Some(a) => fields.push(format!("pressure_angle = {}", quantity(*a, "deg"))),
            None => self.account.guess(
                format!("pressure angle of {}", self.account.called(At::model(place))),
                "20 deg",
                "the file does not give it",
            ),
        }
        let hand = self.gear(first).helix;
        if helix != 0.0 {
            fields.push(format!("helix = {}", quantity(helix, "deg")));
            if all.iter().all(|g| g.double) {
                fields.push("double_helical = true".into());
            } else if hand != 0.0 {
                let word = if hand > 0.0 { "right" } else { "left" };
                fields.push(format!("hand = \"{word}\""));
                let because = "a positive helix angle is taken as right-hand, as in DIN 3960";
                self.account.guess(format!("hand of {}", self.account.called(At::model(first))), word, because);
            }
        }
        let positions: Vec<f64> = all.iter().filter_map(|g| g.position).collect();
        if let Some(p) = positions.first().filter(|_| positions.len() == all.len()) {
            let mean = positions.iter().sum::<f64>() / positions.len() as f64;
            let far = positions.iter().any(|q| (q - mean).abs() > 1e-3);
            let mean = if far { mean } else { *p };
            fields.push(format!("position = {}", quantity(mean, "mm")));
        }
        let distances: Vec<f64> = stages.iter().filter_map(|s| s.centre_distance).filter(|a| *a > 0.0).collect();
        if let Some(a) = distances.first() {
            if distances.iter().any(|b| differs(*a, *b)) {
                self.problem(place, format!("its pairs have different centre distances; {a} mm is taken"));
            }
            fields.push(format!("centre_distance = {}", quantity(*a, "mm")));
        }
        let material = all[0].material;
        if all.iter().all(|g| g.material == material) {
            if let Some(e) = material[0].filter(|e| *e > 0.0) {
                fields.push(format!("youngs_modulus = {}", quantity(e / 1000.0, "GPa")));
            }
            if let Some(nu) = material[1].filter(|nu| (0.0..0.5).contains(nu)) {
                fields.push(format!("poisson_ratio = {}", number(nu)));
            }
        } else {
            self.problem(
                place,
                "its gears are of different materials, which the train file cannot say: steel is taken",
            );
        }
        Some(fields.join(", "))
    }
}

/// The line of a geometry.
fn with_roughness(geometry: String, common: Option<f64>) -> String {
    if geometry.is_empty() {
        return geometry;
    }
    let rough = common.map_or(String::new(), |ra| format!(", roughness = {}", quantity(ra, "um")));
    format!("geometry = {{ {geometry}{rough} }}\n")
}
