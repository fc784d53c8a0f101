//! Which number of the file became which number of the train: for every continuous quantity its path, and every
//! place where it is read.

use crate::exact::Rational;
use crate::units;

use super::described::{GivenEfficiency, GivenGear, GivenMesh, GivenSet, Parts};
use super::heat::HeatNumber;
use super::specification::field::Tabular;
use super::specification::{
    EfficiencySpec, MachineEfficiencySpec, PlainGeometry, PlainSurface, PlainTooth, SetEfficiencySpec, Specification,
    ToothSpec,
};
use super::{BearingMount, LossPart, Lubrication, Measure, Mesh, OpenNumber, PlanetBody, Train};

/// A continuous number of the train file, or one that stands in for it.
#[derive(Clone, Debug)]
pub(crate) struct Input {
    /// As the file has it, with names for places in lists: `P1.geometry.module`, `bearing B1.radial_load`.
    pub path: String,
    /// SI.
    pub value: f64,
    /// SI.
    pub unit: &'static str,
    /// Whether it is taken, not given.
    pub assumed: bool,
    /// Every number of the train that it is.
    pub slots: Vec<Slot>,
}

/// A number of a train: meshes, bearings, seals, rotors and planets by their place in the train's lists, gears by
/// their place in the mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum Slot {
    /// First gear driving (`true`), or the second.
    Efficiency(usize, bool),
    /// Of a variator between two members: the first delivering (`true`), or the second.
    Variator(usize, bool),
    /// Of a machine of a variator: motoring (`true`), or generating.
    Machine(usize, usize, bool),
    /// Standby loss of a variator.
    Standby(usize),
    /// Power out of the store of a variator, as the train has it.
    Store(usize),
    Module(usize),
    Width(usize),
    PressureAngle(usize),
    Helix(usize),
    Position(usize),
    CentreDistance(usize),
    YoungsModulus(usize),
    PoissonRatio(usize),
    Shift(usize, usize),
    Addendum(usize, usize),
    TipAlteration(usize, usize),
    /// Half of it is the tip radius.
    TipDiameter(usize, usize),
    Dedendum(usize, usize),
    Roughness(usize, usize),
    Immersion(usize, usize),
    /// Amount of a tip relief (`true`), or its length.
    TipRelief(usize, usize, bool),
    Temperature,
    Viscosity40,
    Viscosity100,
    Viscosity,
    Density15,
    PressureViscosity,
    LubricantFactor,
    Volume,
    Mist,
    Enclosure,
    AxialGap,
    FrictionCoefficient,
    Bearing(usize, BearingNumber),
    /// Diameter of the shaft.
    Seal(usize),
    Rotor(usize, RotorNumber),
    /// Of a shift element that is open.
    Open(usize, OpenNumber),
    Pump(usize, PumpNumber),
    /// Flow of a jet at a mesh (`true`), or its speed.
    Jet(usize, bool),
    /// Of a given drag: its viscous part (`true`), or the torque at any speed.
    Drag(usize, bool),
    Mass(usize),
    /// A factor on a kind of loss.
    LossFactor(LossPart),
    /// A number of what carries heat away.
    Heat(HeatNumber),
}

/// A number of a train from which nothing else of it follows, no other number and no assumption (which a factor on a loss has),
/// so that it can be set alone.
enum Alone<'t> {
    /// An efficiency.
    Exact(&'t mut Rational),
    /// In SI units, above zero.
    Float(&'t mut f64),
}

impl Slot {
    /// Where it stands, if it stands alone.
    fn alone(self, train: &mut Train) -> Option<Alone<'_>> {
        use BearingNumber as B;
        Some(match self {
            Self::Efficiency(mesh, true) => Alone::Exact(&mut train.meshes[mesh].efficiency.forward),
            Self::Efficiency(mesh, false) => Alone::Exact(&mut train.meshes[mesh].efficiency.backward),
            Self::Roughness(mesh, k) => Alone::Float(&mut train.meshes[mesh].teeth.as_mut()?.roughness[k]),
            Self::Bearing(k, B::RadialLoad) => Alone::Float(&mut train.bearings[k].radial_load),
            Self::Bearing(k, B::AxialLoad) => Alone::Float(&mut train.bearings[k].axial_load),
            Self::Heat(HeatNumber::Factor) => Alone::Float(&mut train.heat.as_mut()?.factor),
            _ => return None,
        })
    }
}

impl Train {
    /// Which inputs can be [set](Self::set_input) by their numbers alone.
    pub(crate) fn inputs_alone(&mut self) -> Vec<usize> {
        let slots: Vec<Vec<Slot>> = self.inputs.iter().map(|i| i.slots.clone()).collect();
        let alone = |k: &usize| slots[*k].iter().all(|s| s.alone(self).is_some());
        (0..slots.len()).filter(alone).collect()
    }

    /// Gives one input the value that a train file writes so; `None` where only a reading of the whole file tells what the
    /// train is with it, and the train is spoiled then.
    pub(crate) fn set_input(&mut self, k: usize, measure: Measure, text: &str) -> Option<()> {
        let (exact, value) = match measure {
            Measure::Number => {
                let exact: Rational = text.parse().ok()?;
                let value = exact.to_f64();
                // More digits than a number of the file keeps.
                (Rational::from_f64(value)? == exact).then_some((exact, value))?
            }
            Measure::Quantity(dimension) => (Rational::ZERO, units::parse(text, dimension).ok()?.si()),
            _ => return None,
        };
        self.inputs[k].value = value;
        for slot in self.inputs[k].slots.clone() {
            match slot.alone(self)? {
                Alone::Exact(own) if exact.sign() > 0 && exact <= Rational::ONE => *own = exact.clone(),
                Alone::Float(own) if value.is_finite() && value > 0.0 => *own = value,
                // A value that the file may not have, or one that means something else there.
                _ => return None,
            }
        }
        Some(())
    }
}

/// A number of a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum BearingNumber {
    Bore,
    OutsideDiameter,
    Width,
    StaticRating,
    AxialFactor,
    Span,
    Position,
    Clearance,
    Friction,
    RadialLoad,
    AxialLoad,
    Level,
}

/// A number of an oil pump.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum PumpNumber {
    Displacement,
    Pressure,
    Efficiency,
}

/// A number of a rotor.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(missing_docs)]
pub(crate) enum RotorNumber {
    Radius,
    Length,
    RadialGap,
    AxialGap,
}

/// What was assembled, as far as inputs went into it.
pub(super) struct Assembled<'a> {
    pub meshes: &'a [Mesh],
    pub lubrication: Option<&'a Lubrication>,
    pub bearings: &'a [BearingMount],
    pub planets: &'a [PlanetBody],
    /// The first planet of each set, as a member.
    pub set_planets: &'a [Vec<super::MemberId>],
}

/// Every continuous number of a description and where it went.
pub(super) fn inputs(
    spec: &Specification,
    meshes: &[GivenMesh],
    sets: &[GivenSet],
    train: &Assembled<'_>,
) -> Vec<Input> {
    let mut list = List { all: vec![], train };
    // Meshes stand in the order of the description, those of the sets behind.
    for (j, mesh) in meshes.iter().enumerate() {
        if train.meshes.get(j).is_none_or(|m| m.set.is_some()) {
            return vec![];
        }
        // A path leads through names that the file has; a mesh without one has its number.
        let name = mesh.name.clone().unwrap_or_else(|| format!("mesh.{j}"));
        if let (Some(given), None) = (&mesh.efficiency, &mesh.loss_table) {
            list.efficiency(&format!("{name}.efficiency"), given, &[(j, false)]);
        }
        if let Some(g) = &mesh.geometry {
            let gears = [0, 1].map(|k| (format!("{name}.gears.{k}"), &mesh.gears[k].tooth));
            list.teeth(j, &gears, g, &format!("{name}.geometry"));
        }
    }
    for (index, set) in sets.iter().enumerate() {
        list.set(index, set);
    }
    list.oil(spec);
    list.machinery(spec);
    list.heat(spec);
    list.variators(spec);
    list.all
}

/// The gears of one mesh of a set, each with its path and teeth, and the central one of them.
struct Pair<'a> {
    gears: [(&'static str, usize, PlainTooth); 2],
    central: Option<(usize, &'a GivenGear)>,
}

/// The meshes of a set, in the order in which they are assembled. Paths may hold the number of a list's entry.
fn pairs(set: &GivenSet) -> Vec<Pair<'_>> {
    let plain = |key: &'static str, tooth: &PlainTooth| (key, 0, tooth.clone());
    let with = |gears, central: Option<(usize, _)>| Pair { gears, central };
    match &set.parts {
        Parts::Simple { sun, ring, planet } => vec![
            with([plain("sun", &sun.tooth), plain("planet", &planet.tooth)], Some((0, sun))),
            with([plain("planet", &planet.tooth), plain("ring", &ring.tooth)], Some((1, ring))),
        ],
        Parts::DoublePlanet { sun, ring, inner, outer } => vec![
            with([plain("sun", &sun.tooth), plain("inner_planet", &inner.tooth)], Some((0, sun))),
            with([plain("inner_planet", &inner.tooth), plain("outer_planet", &outer.tooth)], None),
            with([plain("outer_planet", &outer.tooth), plain("ring", &ring.tooth)], Some((1, ring))),
        ],
        Parts::Stepped { central, .. } => {
            let (mut suns, mut rings) = (0, 0);
            let mut all = Vec::new();
            for g in central {
                if g.internal {
                    all.push(with(
                        [("rings[#].planet", rings, g.planet_tooth.clone()), ("rings[#]", rings, g.tooth.clone())],
                        Some((1, g)),
                    ));
                    rings += 1;
                } else {
                    all.push(with(
                        [("suns[#]", suns, g.tooth.clone()), ("suns[#].planet", suns, g.planet_tooth.clone())],
                        Some((0, g)),
                    ));
                    suns += 1;
                }
            }
            all
        }
        Parts::Ravigneaux { small_sun, large_sun, ring, short, long } => {
            let (short, long) = (plain("short_planet", &short.tooth), plain("long_planet", &long.tooth));
            let mut all = Vec::new();
            if let Some(g) = small_sun {
                all.push(with([plain("small_sun", &g.tooth), short.clone()], Some((0, g))));
            }
            all.push(with([short.clone(), long.clone()], None));
            if let Some(g) = large_sun {
                all.push(with([plain("large_sun", &g.tooth), long.clone()], Some((0, g))));
            }
            if let Some(g) = ring {
                all.push(with([long, plain("ring", &g.tooth)], Some((1, g))));
            }
            all
        }
        Parts::Bevel { sides, .. } => {
            let blank = ToothSpec::default().twin();
            sides.iter().map(|g| with([plain("side", &blank), plain("planet", &blank)], Some((0, g)))).collect()
        }
    }
}

struct List<'a> {
    all: Vec<Input>,
    train: &'a Assembled<'a>,
}

impl List<'_> {
    fn add(&mut self, path: String, value: f64, unit: &'static str, assumed: bool, slot: Slot) {
        match self.all.iter_mut().find(|i| i.path == path) {
            Some(input) if input.slots.contains(&slot) => {}
            Some(input) => input.slots.push(slot),
            None => self.all.push(Input { path, value, unit, assumed, slots: vec![slot] }),
        }
    }

    /// An efficiency of meshes; `swapped` where forward is the second gear driving.
    fn efficiency(&mut self, path: &str, given: &EfficiencySpec, meshes: &[(usize, bool)]) {
        let split = given.is_directed();
        let mut add = |path: String, value: Option<&Rational>, forward: bool| {
            for &(mesh, swapped) in meshes {
                let value = value.map_or(1.0, Rational::to_f64);
                self.add(path.clone(), value, "-", false, Slot::Efficiency(mesh, forward != swapped));
            }
        };
        let name = |direction: &str| if split { format!("{path}.{direction}") } else { path.to_owned() };
        add(name("forward"), given.forward(), true);
        add(name("backward"), given.backward(), false);
    }

    fn variators(&mut self, spec: &Specification) {
        for (k, v) in spec.variator.iter().enumerate() {
            let name = &v.name;
            let mut both = |path: String, given: &EfficiencySpec, keys: [&str; 2], slot: &dyn Fn(bool) -> Slot| {
                for (key, value, first) in [(keys[0], given.forward(), true), (keys[1], given.backward(), false)] {
                    let path = if given.is_directed() { format!("{path}.{key}") } else { path.clone() };
                    self.add(path, value.map_or(1.0, Rational::to_f64), "-", false, slot(first));
                }
            };
            if let Some(e) = &v.efficiency {
                both(format!("{name}.efficiency"), e, ["forward", "backward"], &|first| Slot::Variator(k, first));
            }
            for (j, machine) in v.machines.iter().enumerate() {
                if let Some(MachineEfficiencySpec::Constant(e)) = &machine.efficiency {
                    let path = format!("{name}.machines.{}.efficiency", machine.name);
                    both(path, e, ["motoring", "generating"], &|first| Slot::Machine(k, j, first));
                }
            }
            if let Some(standby) = &v.standby {
                self.add(format!("{name}.standby"), standby.si(), "W", false, Slot::Standby(k));
            }
            if let [(_, Some(power))] = &v.store.0[..] {
                self.add(format!("{name}.store"), power.si(), "W", false, Slot::Store(k));
            }
        }
    }

    fn set(&mut self, index: usize, set: &GivenSet) {
        let meshes: Vec<usize> =
            (0..self.train.meshes.len()).filter(|&j| self.train.meshes[j].set == Some(index)).collect();
        let pairs = pairs(set);
        if meshes.len() != pairs.len() {
            return;
        }
        let name = &set.name;
        match &set.efficiency {
            None => {}
            Some(GivenEfficiency::Meshes(given)) => {
                let path = format!("{name}.mesh_efficiency");
                let ring = |j: &usize| self.train.meshes[*j].gears.iter().any(|g| g.internal);
                let all = |wanted: &dyn Fn(&usize) -> bool| -> Vec<(usize, bool)> {
                    meshes.iter().filter(|j| wanted(j)).map(|j| (*j, false)).collect()
                };
                match given {
                    SetEfficiencySpec::All(e) => self.efficiency(&path, e, &all(&|_| true)),
                    SetEfficiencySpec::ByKind { external, internal } => {
                        let (with_ring, without) = (all(&ring), all(&|j| !ring(j)));
                        self.efficiency(&format!("{path}.external"), external, &without);
                        self.efficiency(&format!("{path}.internal"), internal, &with_ring);
                    }
                }
            }
            Some(GivenEfficiency::Basic(given)) => {
                let booked: Vec<(usize, bool)> = match &set.parts {
                    Parts::Ravigneaux { ring, .. } => {
                        let suns = if ring.is_some() { 2 } else { 1 };
                        let sun = |p: &Pair<'_>| p.central.is_some_and(|(_, g)| !g.internal);
                        let of = meshes.iter().zip(&pairs).filter(|(_, p)| sun(p)).map(|(j, _)| (*j, false));
                        of.take(suns).collect()
                    }
                    _ => {
                        let Some(&first_mesh) = meshes.first() else { return };
                        let first = &self.train.meshes[first_mesh];
                        let swapped = pairs[0].central.is_some_and(|(_, g)| g.internal) || first.same_sense;
                        vec![(first_mesh, swapped)]
                    }
                };
                self.efficiency(&format!("{name}.basic_efficiency"), given, &booked);
            }
        }
        for (j, pair) in meshes.into_iter().zip(&pairs) {
            let own = pair.central.and_then(|(k, g)| Some((k, g.geometry.as_ref()?)));
            let Some(g) = own.map(|(_, g)| g).or(set.geometry.as_ref()) else { continue };
            let path = |k: usize| {
                let (key, number, _) = pair.gears[k];
                format!("{name}.{}", key.replace('#', &number.to_string()))
            };
            let gears = [0, 1].map(|k| (path(k), &pair.gears[k].2));
            let at = own.map_or_else(|| name.clone(), |(k, _)| path(k));
            self.teeth(j, &gears, g, &format!("{at}.geometry"));
        }
        let members = self.train.set_planets.get(index).cloned().unwrap_or_default();
        for (member, (key, planet)) in members.into_iter().zip(set.planets()) {
            let at = self.train.planets.iter().position(|p| p.member == member);
            if let (Some(k), Some(mass)) = (at, planet.body.mass) {
                self.add(format!("{name}.{key}.mass"), mass, "kg", false, Slot::Mass(k));
            }
        }
    }

    fn teeth(&mut self, j: usize, gears: &[(String, &PlainTooth); 2], g: &PlainGeometry, path: &str) {
        let Some(teeth) = &self.train.meshes[j].teeth else { return };
        for (key, value, unit, slot, given) in [
            ("module", Some(g.module), "m", Slot::Module(j), true),
            ("width", Some(g.width), "m", Slot::Width(j), true),
            ("pressure_angle", Some(g.pressure_angle()), "rad", Slot::PressureAngle(j), g.pressure_angle.is_some()),
            // Spur gears become helical in one direction only.
            ("helix", Some(g.helix()).filter(|b| *b != 0.0), "rad", Slot::Helix(j), true),
            ("centre_distance", g.centre_distance, "m", Slot::CentreDistance(j), true),
            ("position", g.position, "m", Slot::Position(j), true),
            ("jet_flow", g.jet_flow, "m^3/s", Slot::Jet(j, true), true),
            ("jet_speed", g.jet_speed, "m/s", Slot::Jet(j, false), true),
            ("youngs_modulus", Some(g.youngs_modulus()), "Pa", Slot::YoungsModulus(j), g.youngs_modulus.is_some()),
            ("poisson_ratio", Some(g.poisson_ratio()), "-", Slot::PoissonRatio(j), g.poisson_ratio.is_some()),
        ] {
            if let Some(value) = value {
                self.add(format!("{path}.{key}"), value, unit, !given, slot);
            }
        }
        for (k, (gear, t)) in gears.iter().enumerate() {
            self.add(format!("{gear}.shift"), t.shift.unwrap_or(0.0), "-", t.shift.is_none(), Slot::Shift(j, k));
            if let Some(d) = t.tip_diameter {
                self.add(format!("{gear}.tip_diameter"), d, "m", false, Slot::TipDiameter(j, k));
            } else {
                match t.addendum {
                    Some(h) => self.add(format!("{gear}.addendum"), h, "-", false, Slot::Addendum(j, k)),
                    None => {
                        let slot = Slot::Addendum(j, k);
                        self.add(format!("{path}.addendum"), g.addendum(), "-", g.addendum.is_none(), slot);
                    }
                }
                if let Some(alteration) = t.tip_alteration {
                    self.add(format!("{gear}.tip_alteration"), alteration, "m", false, Slot::TipAlteration(j, k));
                }
            }
            match t.dedendum {
                Some(h) => self.add(format!("{gear}.dedendum"), h, "-", false, Slot::Dedendum(j, k)),
                None => {
                    let slot = Slot::Dedendum(j, k);
                    self.add(format!("{path}.dedendum"), g.dedendum(), "-", g.dedendum.is_none(), slot);
                }
            }
            let (rough, slot) = (teeth.roughness[k], Slot::Roughness(j, k));
            match t.roughness {
                Some(_) => self.add(format!("{gear}.roughness"), rough, "m", false, slot),
                None => self.add(format!("{path}.roughness"), rough, "m", g.roughness.is_none(), slot),
            }
            if let Some(depth) = t.immersion {
                self.add(format!("{gear}.immersion"), depth, "m", false, Slot::Immersion(j, k));
            }
            for (key, value, amount) in
                [("tip_relief", t.tip_relief, true), ("tip_relief_length", t.tip_relief_length, false)]
            {
                if let Some(value) = value {
                    self.add(format!("{gear}.{key}"), value, "m", false, Slot::TipRelief(j, k, amount));
                }
            }
        }
    }

    fn oil(&mut self, spec: &Specification) {
        if let (Some(oil), Some(l)) = (spec.oil.as_ref().map(Tabular::twin), self.train.lubrication) {
            // A catalogue's oil keeps its own density.
            let own = oil.viscosity.is_some() || oil.viscosity_40.is_some();
            let density = own.then_some(l.oil.density_15);
            for (key, value, unit, assumed, slot) in [
                ("temperature", Some(l.temperature), "K", oil.temperature.is_none(), Slot::Temperature),
                ("viscosity_40", oil.viscosity_40, "m^2/s", false, Slot::Viscosity40),
                ("viscosity_100", oil.viscosity_100, "m^2/s", false, Slot::Viscosity100),
                ("viscosity", oil.viscosity, "Pa s", false, Slot::Viscosity),
                ("density_15", density, "kg/m^3", oil.density_15.is_none(), Slot::Density15),
                ("pressure_viscosity", oil.pressure_viscosity, "1/Pa", false, Slot::PressureViscosity),
                ("lubricant_factor", oil.lubricant_factor, "-", false, Slot::LubricantFactor),
                ("volume", oil.volume, "m^3", false, Slot::Volume),
                ("mist", oil.mist, "-", false, Slot::Mist),
            ] {
                if let Some(value) = value {
                    self.add(format!("oil.{key}"), value, unit, assumed, slot);
                }
            }
        }
        if self.train.meshes.iter().any(|m| m.computed) {
            let given = spec.laws.as_ref().and_then(|l| l.friction_coefficient);
            let mu = given.unwrap_or(crate::losses::mesh_friction::Constant::DEFAULT.mu);
            let path = "laws.friction_coefficient".to_owned();
            self.add(path, mu, "-", given.is_none(), Slot::FrictionCoefficient);
        }
        let housing = spec.housing.clone().unwrap_or_default().twin();
        if let Some(x) = housing.enclosure {
            self.add("housing.enclosure".into(), x, "-", false, Slot::Enclosure);
        }
        if let Some(x) = housing.axial_gap {
            self.add("housing.axial_gap".into(), x, "m", false, Slot::AxialGap);
        }
    }

    fn machinery(&mut self, spec: &Specification) {
        use BearingNumber as B;
        use RotorNumber as R;
        if self.train.bearings.len() == spec.bearing.len() {
            for (k, b) in spec.bearing.iter().map(Tabular::twin).enumerate() {
                for (key, value, unit, number) in [
                    ("bore", b.bore, "m", B::Bore),
                    ("outside_diameter", b.outside_diameter, "m", B::OutsideDiameter),
                    ("width", b.width, "m", B::Width),
                    ("static_rating", b.static_rating, "N", B::StaticRating),
                    ("axial_factor", b.axial_factor, "-", B::AxialFactor),
                    ("span", b.span, "m", B::Span),
                    ("position", b.position, "m", B::Position),
                    ("clearance", b.clearance, "m", B::Clearance),
                    ("friction", b.friction, "-", B::Friction),
                    ("radial_load", b.radial_load, "N", B::RadialLoad),
                    ("axial_load", b.axial_load, "N", B::AxialLoad),
                    ("level", b.level, "m", B::Level),
                ] {
                    if let Some(value) = value {
                        let path = format!("{}.{key}", b.name);
                        self.add(path, value, unit, false, Slot::Bearing(k, number));
                    }
                }
            }
        }
        for (k, p) in spec.pump.iter().map(Tabular::twin).enumerate() {
            use PumpNumber as P;
            for (key, value, unit, number) in [
                ("displacement", Some(p.displacement), "m^3", P::Displacement),
                ("pressure", Some(p.pressure), "Pa", P::Pressure),
                ("efficiency", p.efficiency, "-", P::Efficiency),
            ] {
                if let Some(value) = value {
                    self.add(format!("{}.{key}", p.name), value, unit, false, Slot::Pump(k, number));
                }
            }
        }
        for (k, e) in spec.shift_element.iter().enumerate() {
            use super::OpenNumber as N;
            let Some(o) = e.open.as_ref().map(|o| o.twin()) else { continue };
            for (key, value, unit, number) in [
                ("inner_radius", o.inner_radius, "m", N::InnerRadius),
                ("outer_radius", o.outer_radius, "m", N::OuterRadius),
                ("gap", o.gap, "m", N::Gap),
                ("flow", o.flow, "m^3/s", N::Flow),
                ("groove_share", o.groove_share, "-", N::GrooveShare),
                ("groove_depth", o.groove_depth, "m", N::GrooveDepth),
                ("drum_radius", o.drum_radius, "m", N::DrumRadius),
                ("width", o.width, "m", N::Width),
                ("wrap", o.wrap, "rad", N::Wrap),
                ("wetted", o.wetted, "-", N::Wetted),
                ("torque", o.torque, "N m", N::Torque),
            ] {
                if let Some(value) = value {
                    self.add(format!("{}.open.{key}", e.name), value, unit, false, Slot::Open(k, number));
                }
            }
        }
        for (k, d) in spec.drag.iter().map(Tabular::twin).enumerate() {
            let parts = [("coulomb", d.coulomb, "N m", false), ("viscous", d.viscous, "N m s/rad", true)];
            for (key, value, unit, viscous) in parts {
                if let Some(value) = value {
                    self.add(format!("{}.{key}", d.name), value, unit, false, Slot::Drag(k, viscous));
                }
            }
        }
        for (k, s) in spec.seal.iter().map(Tabular::twin).enumerate() {
            self.add(format!("{}.diameter", s.name), s.diameter, "m", false, Slot::Seal(k));
        }
        for (k, r) in spec.rotor.iter().map(Tabular::twin).enumerate() {
            // Without a gap of its own a face has that of the rim.
            let face = if r.axial_gap.is_some() { "axial_gap" } else { "radial_gap" };
            for (key, value, number) in [
                ("radius", r.radius, R::Radius),
                ("length", r.length, R::Length),
                ("radial_gap", r.radial_gap, R::RadialGap),
                (face, r.axial_gap.unwrap_or(r.radial_gap), R::AxialGap),
            ] {
                self.add(format!("{}.{key}", r.name), value, "m", false, Slot::Rotor(k, number));
            }
        }
    }

    fn heat(&mut self, spec: &Specification) {
        if let Some(factors) = spec.losses.as_ref().and_then(|l| l.factor.as_ref()).map(Tabular::twin) {
            for (part, value) in LossPart::ALL.into_iter().zip(factors.values()) {
                if let Some(value) = value {
                    self.add(format!("losses.factor.{}", part.key()), value, "-", false, Slot::LossFactor(part));
                }
            }
        }
        use HeatNumber as H;
        let Some(h) = spec.heat.as_ref().map(Tabular::twin) else { return };
        let mut add = |path: String, value: Option<f64>, unit: &'static str, number: H| {
            if let Some(value) = value {
                self.add(path, value, unit, false, Slot::Heat(number));
            }
        };
        add("heat.ambient".into(), Some(h.ambient), "K", H::Fixed(super::heat::AMBIENT));
        add("heat.extra_heat".into(), h.extra_heat, "W", H::ExtraHeat);
        add("heat.factor".into(), h.factor, "-", H::Factor);
        add("heat.oil_specific_heat".into(), h.oil_specific_heat, "J/(kg K)", H::SpecificHeat);
        if let Some(c) = &h.cooler {
            add("heat.cooler.inlet".into(), Some(c.inlet), "K", H::Inlet);
            add("heat.cooler.flow".into(), c.flow, "m^3/s", H::Flow);
            add("heat.cooler.effectiveness".into(), c.effectiveness, "-", H::Effectiveness);
            add("heat.cooler.conductance".into(), c.conductance, "W/K", H::CoolerConductance);
        }
        let mut surface = |place: &str, s: &PlainSurface, k: usize| {
            for (key, value, unit, number) in [
                ("conductance", s.conductance, "W/K", H::Conductance(k)),
                ("coefficient", s.coefficient, "W/(m^2 K)", H::Coefficient(k)),
                ("area", s.area, "m^2", H::Area(k)),
                // The sides of a box are an area too.
                ("height", s.height.filter(|_| s.area.is_some()), "m", H::Height(k)),
                ("emissivity", s.emissivity, "-", H::Emissivity(k)),
                ("air_speed", s.air_speed, "m/s", H::AirSpeed(k)),
                ("flow_length", s.flow_length, "m", H::FlowLength(k)),
                ("air_share", s.air_share, "-", H::AirShare(k)),
                ("fin_area", s.fin_area, "m^2", H::FinArea(k)),
                ("fin_height", s.fin_height, "m", H::FinHeight(k)),
                ("fin_thickness", s.fin_thickness, "m", H::FinThickness(k)),
            ] {
                add(format!("{place}.{key}"), value, unit, number);
            }
        };
        if h.node.is_empty() && h.path.is_empty() {
            let outer = usize::from(h.oil_area.is_some());
            surface("heat", &h.surface, outer);
            add("heat.oil_area".into(), h.oil_area, "m^2", H::Area(0));
            add("heat.oil_coefficient".into(), h.oil_coefficient, "W/(m^2 K)", H::Coefficient(0));
            add("heat.foundation".into(), h.foundation, "W/K", H::Conductance(outer + 1));
            return;
        }
        for (k, p) in h.path.iter().enumerate() {
            surface(&format!("heat.path.{k}"), &p.surface, k);
        }
        for (k, n) in h.node.iter().enumerate() {
            add(format!("heat.node.{}.temperature", n.name), n.temperature, "K", H::Fixed(k + 2));
        }
    }
}
