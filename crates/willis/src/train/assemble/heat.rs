//! Checks what carries heat away: every place leads to one of given temperature, and the air is cooler than the limit.

use crate::diagnostic::{Code, Diagnostic};
use crate::train::assembler::Assembler;
use crate::train::heat::{
    AMBIENT, Cooler, Exchange, Heat, HeatNode, HeatPart, HeatPath, OIL, OilHeat, PathLaw, Surface,
};
use crate::train::physical::Lubrication;
use crate::train::specification::{HeatSpec, PlainCooler, PlainHeat, PlainSurface, field::Tabular};
use crate::train::words::clip;

/// Highest temperature of mineral oil by ISO/TR 14179-1, K.
const LIMIT: f64 = 368.15;
/// Specific heats of steel, iron and oil, J/(kg K).
const STEEL: f64 = 470.0;
const IRON: f64 = 500.0;
const OIL_HEAT: f64 = 1950.0;
/// Heat transfer from splashing oil to a wall, W/(m² K).
const SPLASH: f64 = 200.0;
/// Range of the thermostat where its end is not given, K.
const RAMP: f64 = 10.0;
/// Most places and ways of a network.
const MOST_PLACES: usize = 100;

/// What can make heat at a place, by name.
pub(super) struct Makers<'a> {
    pub bearings: Vec<&'a str>,
    pub seals: Vec<&'a str>,
    pub rotors: Vec<&'a str>,
    pub variators: Vec<&'a str>,
}

impl Assembler<'_> {
    /// The thermal network of a train; `None` where it is wrong or there is none.
    pub(super) fn heat(
        &mut self,
        spec: Option<&HeatSpec>,
        lubrication: Option<&Lubrication>,
        makers: &Makers<'_>,
    ) -> Option<Heat> {
        let before = self.diagnostics.len();
        let spec = spec?.twin();
        self.heat_numbers(&spec);
        if spec.node.len() > MOST_PLACES || spec.path.len() > MOST_PLACES {
            let message = format!("{} places and {} paths: at most {MOST_PLACES}", spec.node.len(), spec.path.len());
            self.report(Diagnostic::new(Code::TooLarge, "heat", message).hint("join places of one temperature"));
            return None;
        }
        let limit = spec.limit.unwrap_or_else(|| {
            self.assume("heat", "limit not given, taken as 95 °C for mineral oil");
            LIMIT
        });
        self.heat_temperatures(&spec, limit);
        let oil = OilHeat {
            density_15: lubrication.map_or(880.0, |l| l.oil.density_15),
            expansion: lubrication.map_or(0.0, |l| l.oil.base.expansion()),
            specific_heat: spec.oil_specific_heat.unwrap_or(OIL_HEAT),
        };
        let own = lubrication.and_then(|l| l.volume).map_or(0.0, |v| v * oil.density_15 * oil.specific_heat);
        let capacity = self.capacity(spec.heat_capacity, spec.mass.map(|m| m * STEEL + own), "heat", "mass");
        let place = |name: &str, fixed, capacity| HeatNode { name: name.to_owned(), fixed, capacity, parts: vec![] };
        let mut nodes = vec![place("oil", None, capacity), place("ambient", Some(spec.ambient), 0.0)];
        let mut paths = Vec::new();
        match spec.node.is_empty() && spec.path.is_empty() {
            true => self.simple(&spec, &mut nodes, &mut paths),
            false => self.network(&spec, &mut nodes, &mut paths, makers),
        }
        let cooler = spec.cooler.as_ref().and_then(|c| self.cooler(c, limit, lubrication.is_some()));
        if self.diagnostics.has_errors_since(before) {
            return None;
        }
        let reached = reached(&nodes, &paths, cooler.is_some());
        for (node, _) in nodes.iter().zip(&reached).filter(|(_, there)| !**there) {
            let message = format!("nothing carries the heat of `{}` away", clip(&node.name));
            let d = Diagnostic::new(Code::MissingKey, "heat", message);
            self.report(d.hint(match spec.node.is_empty() {
                true => "give `conductance`, `area` with `coefficient` or `surroundings`, or `area` with `height`",
                false => "add a [[heat.path]] from it to a place that leads to `ambient`",
            }));
        }
        if reached.contains(&false) {
            return None;
        }
        Some(Heat {
            nodes,
            paths,
            cooler,
            oil,
            extra_heat: spec.extra_heat.unwrap_or(0.0),
            factor: spec.factor.unwrap_or(1.0),
            limit,
            start: spec.start.unwrap_or(spec.ambient),
        })
    }

    /// Numbers that must be above or at zero.
    fn heat_numbers(&mut self, spec: &PlainHeat) {
        for (value, zero, what, unit, key) in [
            (spec.factor, false, "a factor", "", "factor"),
            (spec.oil_area, false, "an area", "m²", "oil_area"),
            (spec.oil_coefficient, false, "a heat transfer coefficient", "W/(m² K)", "oil_coefficient"),
            (spec.foundation, false, "a conductance", "W/K", "foundation"),
            (spec.heat_capacity, false, "a heat capacity", "J/K", "heat_capacity"),
            (spec.mass, false, "a mass", "kg", "mass"),
            (spec.housing_heat_capacity, false, "a heat capacity", "J/K", "housing_heat_capacity"),
            (spec.housing_mass, false, "a mass", "kg", "housing_mass"),
            (spec.oil_specific_heat, false, "a specific heat", "J/(kg K)", "oil_specific_heat"),
            (spec.extra_heat, true, "a heat", "W", "extra_heat"),
        ] {
            if let Some(value) = value {
                self.positive(value, zero, what, unit, &format!("heat.{key}"));
            }
        }
    }

    /// Says where a temperature is none of a gearbox.
    fn heat_temperature(&mut self, value: Option<f64>, place: &str) {
        if let Some(t) = value.filter(|t| !(200.0..=600.0).contains(t)) {
            let message = format!("a temperature of {:.1} °C is none of a gearbox", t - 273.15);
            self.report(Diagnostic::new(Code::OutOfRange, place, message).hint("from -73 to 327 °C is computed"));
        }
    }

    /// Air, start and limit.
    fn heat_temperatures(&mut self, spec: &PlainHeat, limit: f64) {
        for (value, key) in [(Some(spec.ambient), "ambient"), (spec.start, "start"), (spec.limit, "limit")] {
            self.heat_temperature(value, &format!("heat.{key}"));
        }
        for (value, what, key) in
            [(Some(spec.ambient), "the air around has", "ambient"), (spec.start, "the oil starts at", "start")]
        {
            if let Some(t) = value.filter(|t| *t >= limit) {
                let c = |t: f64| t - 273.15;
                let message = format!("{what} {:.1} °C, and the oil may have {:.1} °C at most", c(t), c(limit));
                let d = Diagnostic::new(Code::OutOfRange, format!("heat.{key}"), message);
                self.report(d.hint("the limit is above both; are the two swapped?"));
            }
        }
    }

    /// A heat capacity that is given, or follows from a mass; not both.
    fn capacity(&mut self, given: Option<f64>, of_mass: Option<f64>, place: &str, key: &str) -> f64 {
        if given.is_some() && of_mass.is_some() {
            let message = "a heat capacity and a mass say the same twice";
            let d = Diagnostic::new(Code::Conflict, format!("{place}.{key}"), message);
            self.report(d.hint("keep one of the two"));
        }
        given.or(of_mass).unwrap_or(0.0)
    }

    /// Oil, perhaps a housing of its own, and air.
    fn simple(&mut self, spec: &PlainHeat, nodes: &mut Vec<HeatNode>, paths: &mut Vec<HeatPath>) {
        let law = self.path_law(&spec.surface, "heat");
        let housing =
            self.capacity(spec.housing_heat_capacity, spec.housing_mass.map(|m| m * IRON), "heat", "housing_mass");
        let mut outside = OIL;
        if let Some(area) = spec.oil_area {
            outside = nodes.len();
            nodes.push(HeatNode { name: "housing".into(), fixed: None, capacity: housing, parts: vec![] });
            let coefficient = spec.oil_coefficient.unwrap_or_else(|| {
                self.assume("heat", "heat transfer from oil to housing not given, taken as 200 W/(m² K)");
                SPLASH
            });
            paths.push(HeatPath { between: [OIL, outside], law: PathLaw::Coefficient(coefficient, area) });
        } else {
            for (given, key) in
                [(spec.oil_coefficient.is_some(), "oil_coefficient"), (housing > 0.0, "housing_heat_capacity")]
            {
                if given {
                    let message = "the housing has the temperature of the oil";
                    let d = Diagnostic::new(Code::MissingKey, format!("heat.{key}"), message);
                    self.report(d.hint("give `oil_area`, and the housing is a place of its own"));
                }
            }
        }
        paths.extend(law.map(|law| HeatPath { between: [outside, AMBIENT], law }));
        let foundation = spec.foundation.map(PathLaw::Conductance);
        paths.extend(foundation.map(|law| HeatPath { between: [outside, AMBIENT], law }));
    }

    /// Places and ways that the file lists.
    fn network(&mut self, spec: &PlainHeat, nodes: &mut Vec<HeatNode>, paths: &mut Vec<HeatPath>, makers: &Makers<'_>) {
        let s = &spec.surface;
        for (given, key) in [
            (s.conductance.is_some(), "conductance"),
            (s.area.is_some(), "area"),
            (spec.oil_area.is_some(), "oil_area"),
            (spec.foundation.is_some(), "foundation"),
            (spec.housing_heat_capacity.is_some(), "housing_heat_capacity"),
            (spec.housing_mass.is_some(), "housing_mass"),
        ] {
            if given {
                let message = format!("`{key}` says how the heat of one place leaves, and there is a network");
                let d = Diagnostic::new(Code::Conflict, format!("heat.{key}"), message);
                self.report(d.hint("say it of a [[heat.path]] or a [[heat.node]]"));
            }
        }
        let mut placed: Vec<HeatPart> = Vec::new();
        for (k, n) in spec.node.iter().enumerate() {
            let at = format!("heat.node[{k}]");
            super::check_name(self, &n.name, &format!("{at}.name"), false);
            if nodes.iter().any(|other| other.name == n.name) {
                let message = format!("a second place is called `{}`", clip(&n.name));
                let d = Diagnostic::new(Code::DuplicateName, format!("{at}.name"), message);
                self.report(d.hint("`oil` and `ambient` are always there; their data are keys of [heat]"));
                continue;
            }
            for (value, what, unit, key) in [
                (n.heat_capacity, "a heat capacity", "J/K", "heat_capacity"),
                (n.mass, "a mass", "kg", "mass"),
                (n.temperature, "an absolute temperature", "K", "temperature"),
            ] {
                if let Some(value) = value {
                    self.positive(value, false, what, unit, &format!("{at}.{key}"));
                }
            }
            self.heat_temperature(n.temperature, &format!("{at}.temperature"));
            let capacity = self.capacity(n.heat_capacity, n.mass.map(|m| m * STEEL), &at, "mass");
            if n.temperature.is_some() && (capacity > 0.0 || !n.parts.is_empty()) {
                let message = format!("`{}` has a given temperature: it stores and makes no heat", clip(&n.name));
                let d = Diagnostic::new(Code::Conflict, format!("{at}.temperature"), message);
                self.report(d.hint("leave out the temperature, or `parts` and heat capacity"));
            }
            let mut parts = Vec::new();
            for (j, name) in n.parts.iter().enumerate() {
                let place = format!("{at}.parts[{j}]");
                let Some(part) = self.maker(name, makers, &place) else { continue };
                if placed.contains(&part) {
                    let message = format!("the heat of `{}` is made at another place already", clip(name));
                    self.report(Diagnostic::new(Code::Conflict, place, message).hint("name it once"));
                } else {
                    placed.push(part);
                    parts.push(part);
                }
            }
            nodes.push(HeatNode { name: n.name.clone(), fixed: n.temperature, capacity, parts });
        }
        let known: Vec<String> = nodes.iter().map(|n| n.name.clone()).collect();
        let known: Vec<&str> = known.iter().map(String::as_str).collect();
        for (k, p) in spec.path.iter().enumerate() {
            let at = format!("heat.path[{k}]");
            let place = |j: usize| format!("{at}.between[{j}]");
            let ends: Vec<Option<usize>> = (p.between.iter().enumerate())
                .map(|(j, name)| self.position("place", "heat.node", name, place(j), &known))
                .collect();
            let law = self.path_law(&p.surface, &at);
            let [Some(a), Some(b)] = ends[..] else {
                if ends.len() != 2 {
                    let message = format!("a path leads between two places, here are {}", ends.len());
                    let d = Diagnostic::new(Code::Conflict, format!("{at}.between"), message);
                    self.report(d.hint("between = [\"oil\", \"housing\"]"));
                }
                continue;
            };
            if a == b {
                let message = format!("this path leads from `{}` to itself", clip(known[a]));
                self.report(Diagnostic::new(Code::Conflict, format!("{at}.between"), message));
                continue;
            }
            let fixed = |k: usize| nodes[k].fixed.is_some();
            let Some(law) = law else {
                let message = "nothing says how heat passes here";
                let d = Diagnostic::new(Code::MissingKey, at, message);
                self.report(d.hint("give `conductance`, or `area` with `coefficient` or `height`"));
                continue;
            };
            if matches!(law, PathLaw::Surface(_)) && !fixed(a) && !fixed(b) {
                let message = "convection and radiation lead to air of given temperature";
                let d = Diagnostic::new(Code::Conflict, format!("{at}.between"), message);
                self.report(d.hint("lead it to `ambient`, or give a conductance"));
                continue;
            }
            let between = if fixed(a) { [b, a] } else { [a, b] };
            paths.push(HeatPath { between, law });
        }
    }

    /// What makes heat, by its name.
    fn maker(&mut self, name: &str, makers: &Makers<'_>, place: &str) -> Option<HeatPart> {
        let of = |all: &[&str]| all.iter().position(|n| *n == name);
        let found = (self.by_name.get(name).copied().map(HeatPart::Member))
            .or_else(|| of(&makers.bearings).map(HeatPart::Bearing))
            .or_else(|| of(&makers.seals).map(HeatPart::Seal))
            .or_else(|| of(&makers.rotors).map(HeatPart::Rotor))
            .or_else(|| of(&makers.variators).map(HeatPart::Variator));
        if found.is_none() {
            let members: Vec<String> = self.members.iter().map(|m| m.name.clone()).collect();
            let others = [&makers.bearings, &makers.seals, &makers.rotors, &makers.variators];
            let known = members.iter().map(String::as_str).chain(others.into_iter().flatten().copied());
            let message = format!("no member, bearing, seal, rotor or variator is called `{}`", clip(name));
            self.report(Diagnostic::new(Code::UnknownName, place, message).suggest(name, known));
        }
        found
    }

    /// The law that the keys of a surface mean; `None` where they say nothing, or something wrong.
    fn path_law(&mut self, s: &PlainSurface, at: &str) -> Option<PathLaw> {
        let mut good = true;
        for (value, zero, what, unit, key) in [
            (s.conductance, false, "a conductance", "W/K", "conductance"),
            (s.area, false, "an area", "m²", "area"),
            (s.coefficient, false, "a heat transfer coefficient", "W/(m² K)", "coefficient"),
            (s.height, false, "a height", "m", "height"),
            (s.length, false, "a length", "m", "length"),
            (s.width, false, "a width", "m", "width"),
            (s.emissivity, true, "an emissivity", "", "emissivity"),
            (s.air_speed, true, "a speed", "m/s", "air_speed"),
            (s.flow_length, false, "a length", "m", "flow_length"),
            (s.air_share, true, "a share", "", "air_share"),
            (s.fin_area, false, "an area", "m²", "fin_area"),
            (s.fin_height, false, "a height", "m", "fin_height"),
            (s.fin_thickness, false, "a thickness", "m", "fin_thickness"),
        ] {
            if let Some(value) = value {
                good &= self.positive(value, zero, what, unit, &format!("{at}.{key}"));
            }
        }
        for (value, what, key) in [(s.emissivity, "an emissivity", "emissivity"), (s.air_share, "a share", "air_share")]
        {
            if let Some(x) = value.filter(|x| *x > 1.0) {
                let message = format!("{what} of {x}: it is at most 1");
                self.report(Diagnostic::new(Code::OutOfRange, format!("{at}.{key}"), message));
                good = false;
            }
        }
        let size = match (s.area, s.length, s.width, s.height) {
            (Some(area), ..) => Some(area),
            // A box on its base.
            (None, Some(l), Some(b), Some(h)) => Some(l * b + 2.0 * h * (l + b)),
            _ => None,
        };
        let air = s.height.is_some() && (s.area.is_some() || s.length.is_some());
        let ways: Vec<&str> = [
            (s.conductance.is_some(), "conductance"),
            (s.coefficient.is_some(), "coefficient"),
            (s.surroundings.is_some(), "surroundings"),
        ]
        .into_iter()
        .filter_map(|(given, key)| given.then_some(key))
        .collect();
        if ways.len() > 1 || s.conductance.is_some() && s.area.is_some() {
            let message = format!(
                "how heat leaves is said twice: {}",
                match ways.len() {
                    1 => "conductance and area".to_owned(),
                    _ => ways.join(", "),
                }
            );
            self.report(Diagnostic::new(Code::Conflict, at, message).hint("keep one of them"));
            return None;
        }
        let fins = [s.fin_area, s.fin_height, s.fin_thickness];
        if fins.iter().any(Option::is_some) && (fins.contains(&None) || !ways.is_empty() || !air) {
            let message = "fins need `fin_area`, `fin_height` and `fin_thickness` beside `area` and `height`";
            self.report(Diagnostic::new(Code::MissingKey, format!("{at}.fin_area"), message));
            return None;
        }
        if !good {
            return None;
        }
        let coefficient = s.coefficient.or_else(|| {
            let k = s.surroundings?;
            let k = k.coefficient();
            let text = format!("{k} W/(m² K) to the air, the middle of the range of ISO/TR 14179-1 (confirm)");
            self.assume("heat", text);
            Some(k)
        });
        match (s.conductance, coefficient, size, s.height) {
            (Some(g), ..) => Some(PathLaw::Conductance(g)),
            (None, Some(k), Some(area), _) => Some(PathLaw::Coefficient(k, area)),
            (None, None, Some(area), Some(height)) => {
                let emissivity = s.emissivity.unwrap_or_else(|| {
                    self.assume("heat", "emissivity not given, taken as 0.9 (painted, or cast iron)");
                    0.9
                });
                Some(PathLaw::Surface(Surface {
                    area,
                    height,
                    emissivity,
                    air_speed: s.air_speed.unwrap_or(0.0),
                    flow_length: s.flow_length.unwrap_or(height),
                    air_share: s.air_share.unwrap_or(1.0),
                    fins: match fins {
                        [Some(a), Some(h), Some(d)] => Some([a, h, d]),
                        _ => None,
                    },
                }))
            }
            (None, Some(_), None, _) => {
                let message = "a coefficient without an area";
                let d = Diagnostic::new(Code::MissingKey, format!("{at}.area"), message);
                self.report(d.hint("give `area`, or `length`, `width` and `height`"));
                None
            }
            (None, None, Some(_), None) => {
                let message = "an area alone does not say how it gives off heat";
                let d = Diagnostic::new(Code::MissingKey, format!("{at}.area"), message);
                self.report(d.hint("add `height`, `coefficient` or `surroundings`"));
                None
            }
            (None, None, None, _) => None,
        }
    }

    fn cooler(&mut self, c: &PlainCooler, limit: f64, has_oil: bool) -> Option<Cooler> {
        let celsius = |t: f64| t - 273.15;
        let mut good = true;
        for (value, what, unit, key) in [
            (c.flow, "a flow", "m³/s", "flow"),
            (c.effectiveness, "an effectiveness", "", "effectiveness"),
            (c.conductance, "a conductance", "W/K", "conductance"),
            (Some(c.inlet), "an absolute temperature", "K", "inlet"),
        ] {
            if let Some(value) = value {
                good &= self.positive(value, false, what, unit, &format!("heat.cooler.{key}"));
            }
        }
        if let Some(e) = c.effectiveness.filter(|e| *e > 1.0) {
            let message = format!("an effectiveness of {e}: it is at most 1");
            self.report(Diagnostic::new(Code::OutOfRange, "heat.cooler.effectiveness", message));
            good = false;
        }
        if c.inlet >= limit {
            let (inlet, limit) = (celsius(c.inlet), celsius(limit));
            let message = format!("what cools enters at {inlet:.1} °C, and the oil may have {limit:.1} °C at most");
            let d = Diagnostic::new(Code::OutOfRange, "heat.cooler.inlet", message);
            self.report(d.hint("a cooler is cooler than the oil"));
            good = false;
        }
        let thermostat = match (c.opens, c.open) {
            (None, None) => None,
            (Some(from), to) => {
                let to = to.unwrap_or(from + RAMP);
                if from >= to || from < c.inlet {
                    let message = format!(
                        "a thermostat that opens from {:.1} to {:.1} °C, with {:.1} °C at the inlet",
                        celsius(from),
                        celsius(to),
                        celsius(c.inlet)
                    );
                    let d = Diagnostic::new(Code::OutOfRange, "heat.cooler.opens", message);
                    self.report(d.hint("it opens above the inlet temperature, and is open at a higher one"));
                    good = false;
                }
                Some([from, to])
            }
            (None, Some(_)) => {
                let message = "a thermostat that is open and never opens";
                let d = Diagnostic::new(Code::MissingKey, "heat.cooler.opens", message);
                self.report(d.hint("give `opens`, the temperature at which it begins"));
                return None;
            }
        };
        let exchange = match (c.flow, c.effectiveness, c.conductance) {
            (Some(v), Some(e), None) => {
                if !has_oil {
                    self.assume("heat", "no oil given: the density of the oil in the cooler is taken as 880 kg/m³");
                }
                Exchange::Flow(v, e)
            }
            (None, None, Some(g)) => Exchange::Conductance(g),
            _ => {
                let message = "what the cooler takes is given half, or twice";
                let d = Diagnostic::new(Code::Conflict, "heat.cooler", message);
                self.report(d.hint("give `flow` and `effectiveness`, or `conductance`"));
                return None;
            }
        };
        good.then_some(Cooler { inlet: c.inlet, exchange, thermostat })
    }
}

/// From which places heat gets out.
fn reached(nodes: &[HeatNode], paths: &[HeatPath], cooled: bool) -> Vec<bool> {
    let mut reached: Vec<bool> =
        nodes.iter().enumerate().map(|(k, n)| n.fixed.is_some() || k == OIL && cooled).collect();
    for _ in 0..nodes.len() {
        for HeatPath { between: [a, b], .. } in paths {
            let either = reached[*a] || reached[*b];
            (reached[*a], reached[*b]) = (either, either);
        }
    }
    reached
}
