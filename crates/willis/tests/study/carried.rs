//! Exports: what of the train file they do not hold, as properties of every example, every format and every key.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::LazyLock;

use willis::model::Model;
use willis::study::export::{Export, ExportRequest, KINDS, export};

use crate::common::{example, examples};

fn made(model: &Model, kind: &str, request: &ExportRequest) -> Export {
    export(model, kind, request).unwrap_or_else(|e| panic!("{kind}: {e}"))
}

/// Every state, at the ends of ranges that do not depend on the file.
fn few(model: &Model, kind: &str) -> ExportRequest {
    ExportRequest {
        all_states: kind != "modelica" && !model.train().states().is_empty(),
        speeds: Some("1500 rpm".into()),
        torques: Some("-900 N m, 700 N m".into()),
        ..ExportRequest::default()
    }
}

/// Files that have every key a train file can have, between them.
fn generated() -> Vec<(&'static str, String)> {
    let head = |members: &str| {
        format!(
            "format = 1\nname = 'all keys'\nsource = 'a test'\nnotes = 'none'\nmembers = [{members}]\n\
             terminals = ['sun', 'carrier']\ninput = 'sun'\noutput = 'carrier'\n"
        )
    };
    // The teeth of a gear, whose tip is given one way or the other.
    let tooth = |tip: Option<f64>| {
        let tip =
            tip.map_or("addendum = 1.0, tip_alteration = '0 mm'".to_owned(), |d| format!("tip_diameter = '{d} mm'"));
        format!(
            "shift = 0.0, dedendum = 1.25, roughness = '0.5 um', immersion = '3 mm', tip_relief = '20 um', tip_relief_length = '4 mm', {tip}"
        )
    };
    let geometry = "{ module = '4 mm', width = '50 mm', pressure_angle = '20 deg', helix = '0 deg', double_helical = true, \
                    addendum = 1.0, dedendum = 1.25, roughness = '0.6 um', youngs_modulus = '206 GPa', poisson_ratio = 0.3, hand = 'right', position = '5 mm', jet_flow = '0.3 l/min', jet_speed = '5 m/s', jet_side = 'out-of-mesh', load_sharing_factor = 1.1, mesh_stiffness = 'iso-6336', external_mesh_stiffness = '18 N/(mm um)', internal_mesh_stiffness = '19 N/(mm um)' }";
    let apart = |distance: f64| geometry.replace(" }", &format!(", centre_distance = '{distance} mm' }}"));
    let body = |orbit: f64| format!("mass = '0.4 kg', inertia = '2e-4 kg m^2', orbit_radius = '{orbit} mm'");
    let oil = "[oil]\nname = 'own'\nbase = 'pao'\ndensity_15 = '880 kg/m^3'\npressure_viscosity = '18 1/GPa'\n\
               lubricant_factor = 0.9\ntemperature = '60 degC'\nsupply = 'bath'\nvolume = '4 l'\nmist = 30.0\n";
    let two = "viscosity_40 = '100 mm^2/s'\nviscosity_100 = '11 mm^2/s'\n";
    let physical = "[laws]\nmesh_friction = 'schlenk'\nfriction_coefficient = 0.06\nloss_factor = 'ohlendorf'\n\
        load_sharing = 'uniform'\nfilm = 'dowson-higginson'\nfilm_reduction = 'gupta-cheng'\nrolling = 'none'\n\
        bearing = 'palmgren'\nwindage = 'dawson-1984'\nchurning = 'changenet-2011'\nseal = 'iso-14179-2'\nrotor_drag = 'bilgen-boulos-daily-nece'\nclutch_drag = 'full-film'\npump = 'wilson'\ninjection = 'ariura'\nplain_bearing = 'petroff'\n\
        [housing]\nenclosure = 0.8\naxial_gap = '30 mm'\n\
        [[bearing]]\nname = 'planets'\nmembers = ['P.planet', 'carrier']\ndesignation = 'NU 206'\ncount = 2\nspan = '20 mm'\n\
        [[bearing]]\nname = 'sun'\nmembers = ['sun']\nkind = 'tapered-roller'\nseries = '302'\nbore = '50 mm'\n\
        outside_diameter = '90 mm'\nwidth = '21.75 mm'\nstatic_rating = '100 kN'\naxial_factor = 1.4\nshaft_diameter = '50 mm'\n\
        radial_load = '400 N'\naxial_load = '300 N'\nposition = '40 mm'\nlocates = true\nsupply = 'bath'\nlevel = '4 mm'\n\
        [[bearing]]\nname = 'bush'\nmembers = ['carrier']\nkind = 'plain'\nbore = '60 mm'\nwidth = '40 mm'\nclearance = '0.1 mm'\nfriction = 0.1\n\
        [[pump]]\nname = 'pump'\nmember = 'carrier'\ndisplacement = '10 cm^3'\npressure = '5 bar'\nefficiency = 0.8\n\
        [[seal]]\nname = 'in'\nmembers = ['sun']\ndiameter = '50 mm'\nmaterial = 'nbr'\ncount = 2\n\
        [[rotor]]\nname = 'drum'\nmember = 'carrier'\nradius = '130 mm'\nlength = '110 mm'\nradial_gap = '12 mm'\n\
        axial_gap = '15 mm'\nfluid = 'mist'\n";
    let simple = |tips: [Option<f64>; 3], geometry: &str| {
        format!(
            "[[set]]\nname = 'P'\ntype = 'simple'\nsun = {{ member = 'sun', teeth = 17, {} }}\n\
             planet = {{ teeth = 22, count = 3, {}, {} }}\nring = {{ member = 'frame', teeth = 61, {} }}\ncarrier = 'carrier'\n\
             geometry = {geometry}\n",
            tooth(tips[0]),
            body(78.0),
            tooth(tips[1]),
            tooth(tips[2])
        )
    };
    let dynamic = "[[shift_element]]\nname = 'B'\nkind = 'brake'\nmembers = ['ring']\ncapacity = '80 N m'\npeak = 1.2\n\
        open = { surfaces = 6, inner_radius = '60 mm', outer_radius = '75 mm', gap = '0.3 mm', flow = '0.2 l/min', groove_share = 0.2, groove_depth = '0.4 mm' }\n\
        [[shift_element]]\nname = 'D'\nkind = 'brake'\nmembers = ['ring']\nopen = { drum_radius = '80 mm', width = '40 mm', wrap = '300 deg', gap = '0.5 mm', wetted = 0.7 }\n\
        [[shift_element]]\nname = 'C'\nkind = 'clutch'\nmembers = ['sun', 'carrier']\nfriction = 0.12\nnormal_force = '5 kN'\n\
        effective_radius = '190 mm'\nopen = { curve = [['0 rpm', '0 N m'], ['300 rpm', '0.5 N m']], temperature = '70 degC' }\n\
        [[shift_element]]\nname = 'F'\nkind = 'one-way'\nmembers = ['ring']\nblocks = 'backward'\nopen = { torque = '0.2 N m' }\n\
        [[state]]\nname = '1'\nengaged = ['B']\ninput = 'sun'\noutput = 'carrier'\n\
        [[drag]]\nname = 'd'\nmembers = ['sun']\ncoulomb = '3 N m'\nviscous = '0.1 N m s/rad'\npeak = 1.1\n\
        [[drag]]\nname = 't'\nmembers = ['carrier']\ntable = [['0 rpm', '1 N m'], ['100 rpm', '2 N m']]\n\
        [[shaft]]\nname = 's'\nmembers = ['carrier', 'wheel']\nstiffness = '900 N m/rad'\ndamping = '2 N m s/rad'\n\
        backlash = '1 deg'\ncontact = 'hard'\n";
    let given = "mesh_efficiency = 0.99\n";
    let wheels = "inertias = { sun = '1e-3 kg m^2', wheel = '0.1 kg m^2' }\n";
    let set = |kind: &str, rest: &str| format!("[[set]]\nname = 'P'\ntype = '{kind}'\ncarrier = 'carrier'\n{rest}");
    let ends = "'sun', 'carrier'";
    let double = |tips: [Option<f64>; 2], end: &str| {
        set(
            "double-planet",
            &format!(
                "sun = {{ member = 'sun', teeth = 30, {0} }}\ninner_planet = {{ teeth = 16, count = 3, {2}, {1} }}\n\
                 outer_planet = {{ teeth = 16, count = 3, {3}, {1} }}\nring = {{ member = 'frame', teeth = 80, {end} }}\n\
                 geometry = {geometry}\n",
                tooth(tips[0]),
                tooth(tips[1]),
                body(92.0),
                body(128.0)
            ),
        )
    };
    let stepped = |tip: bool, geometry: &str| {
        let [sun, on_sun, ring, on_ring] = [88.0, 168.0, 312.0, 88.0].map(|d| tooth(Some(d).filter(|_| tip)));
        set(
            "stepped",
            &format!(
                "suns = [{{ member = 'sun', teeth = 20, planet_teeth = 40, planet = {{ {on_sun} }}, geometry = {geometry}, {sun} }}]\n\
                 rings = [{{ member = 'frame', teeth = 80, planet_teeth = 20, planet = {{ {on_ring} }}, geometry = {geometry}, \
                 {ring} }}]\nplanet = {{ count = 3, {} }}\n",
                body(120.0)
            ),
        )
    };
    let ravigneaux = |tip: bool| {
        let [small, large, ring, short, long] =
            [128.0, 160.0, 336.0, 96.0, 104.0].map(|d| tooth(Some(d).filter(|_| tip)));
        set(
            "ravigneaux",
            &format!(
                "small_sun = {{ member = 'sun', teeth = 30, {small} }}\nlarge_sun = {{ member = 'wheel', teeth = 38, {large} }}\n\
                 ring = {{ member = 'frame', teeth = 86, {ring} }}\nshort_planet = {{ teeth = 22, count = 3, {}, {short} }}\n\
                 long_planet = {{ teeth = 24, count = 3, {}, {long} }}\ngeometry = {geometry}\n",
                body(104.0),
                body(124.0)
            ),
        )
    };
    let bevel = |tip: Option<f64>| {
        set(
            "bevel",
            &format!(
                "sides = [{{ member = 'sun', teeth = 30, planet_teeth = 15, side = 'left' }}, {{ member = 'frame', teeth = 30, \
                 planet_teeth = 15, side = 'right' }}]\nplanet = {{ teeth = 15, count = 2, {}, {} }}\nbasic_efficiency = 0.98\n\
                 geometry = {{ module = '4 mm', width = '20 mm', shaft_angle = '85 deg' }}\n",
                body(60.0),
                tooth(tip)
            ),
        )
    };
    let mesh = |tip: bool| {
        let [a, b] = [88.0, 168.0].map(|d| tooth(Some(d).filter(|_| tip)));
        format!(
            "[[mesh]]\nname = 'G'\ngears = [{{ member = 'sun', teeth = 20, internal = false, {a} }}, {{ member = 'lay', teeth = 40, \
             {b} }}]\ncarrier = 'frame'\ncount = 2\nangle = '30 deg'\ngeometry = {}\n\
             [[mesh]]\nname = 'R'\ngears = [{{ member = 'lay', teeth = 20 }}, {{ member = 'mid', teeth = 60, internal = true }}]\n\
             efficiency = 0.98\n\
             [[mesh]]\nname = 'H'\ngears = [{{ member = 'mid', teeth = 20, spiral_angle = '45 deg' }}, {{ member = 'end', teeth = 40, spiral_angle = '30 deg' }}]\nkind = 'bevel'\n\
             geometry = {{ module = '3 mm', width = '20 mm', shaft_angle = '80 deg', offset = '18 mm' }}\n\
             efficiency = {{ forward = 0.97, backward = 0.96 }}\n\
             [[mesh]]\nname = 'K'\ngears = [{{ member = 'end', teeth = 20 }}, {{ member = 'carrier', teeth = 30 }}]\nsense = 'same'\n\
             loss_table = [{{ speed = '0 rpm', forward = 0.96, backward = 0.95, forward_torque = '1 N m', \
             backward_torque = '2 N m' }}, {{ speed = '100 rpm', forward = 0.97, backward = 0.96, forward_torque = '1 N m', \
             backward_torque = '2 N m' }}]\n",
            apart(120.0)
        )
    };
    let teeth = "sun = { member = 'sun', teeth = 17 }\nring = { member = 'frame', teeth = 61 }\n";
    let plain = set("simple", teeth);
    let by_kind = "mesh_efficiency = { external = { forward = 0.98, backward = 0.97 }, internal = { forward = 0.99, backward = \
                   0.985 } }\n";
    let variators = "[[set]]\nname = 'P'\nsun = { member = 'sun', teeth = 30 }\nring = { member = 'ring', teeth = 70 }\n\
        carrier = 'carrier'\nmesh_efficiency = 0.98\n[[shift_element]]\nname = 'B'\nkind = 'brake'\nmembers = ['ring']\n\
        [[state]]\nname = '1'\nengaged = ['B']\n\
        [[variator]]\nname = 'belt'\nkind = 'belt'\nmembers = ['sun', 'ring']\n\
        efficiency = { forward = 0.9, backward = 0.88 }\nratio = { min = 0.4, max = 2.5 }\n\
        [[variator]]\nname = 'path'\nkind = 'electric'\nstore = '0 W'\nstandby = '0 W'\n\
        machines = [{ name = 'a', member = 'sun', efficiency = { motoring = 0.9, generating = 0.88 }, torque = '100 N m', \
        power = '10 kW', speed = '6000 rpm' }, { name = 'b', member = 'ring', efficiency = 0.9 }]\n";
    let surface = "area = '0.6 m^2'\nheight = '0.3 m'\nemissivity = 0.9\nair_speed = '1.5 m/s'\nflow_length = '0.5 m'\n\
        air_share = 0.8\nfin_area = '0.2 m^2'\nfin_height = '20 mm'\nfin_thickness = '4 mm'\n";
    let sides = "length = '0.5 m'\nwidth = '0.4 m'\nheight = '0.3 m'\nsurroundings = 'hall'\n";
    let losses = "[losses]\ncalibrated = 'tests'\n[losses.factor]\nteeth = 1.1\nbearing_load = 0.9\nbearing_no_load = 1.2\n\
        seal = 0.8\nchurning = 0.7\nwindage = 1.3\nrotor = 1.4\n[losses.spread]\nteeth = 0.1\nbearing_load = 0.2\n\
        bearing_no_load = 0.3\nseal = 0.2\nchurning = 0.3\nwindage = 0.4\nrotor = 0.5\n";
    let heat = "[heat]\nambient = '20 degC'\nlimit = '90 degC'\nstart = '10 degC'\nextra_heat = '50 W'\nfactor = 1.1\n";
    let housing = format!(
        "{heat}oil_area = '0.4 m^2'\noil_coefficient = '150 W/(m^2 K)'\nfoundation = '5 W/K'\nheat_capacity = '18 kJ/K'\n\
         housing_heat_capacity = '42 kJ/K'\noil_specific_heat = '2000 J/(kg K)'\n{surface}\
         cooler = {{ inlet = '30 degC', flow = '6 l/min', effectiveness = 0.5, opens = '50 degC', open = '58 degC' }}\n"
    );
    let masses = format!(
        "{heat}oil_area = '0.4 m^2'\nmass = '20 kg'\nhousing_mass = '80 kg'\n{sides}\
         cooler = {{ inlet = '30 degC', conductance = '40 W/K' }}\n"
    );
    let coefficient = format!("{heat}area = '0.6 m^2'\ncoefficient = '15 W/(m^2 K)'\n");
    let network = format!(
        "{heat}[[heat.node]]\nname = 'gear'\nparts = ['sun']\nheat_capacity = '2 kJ/K'\n\
         [[heat.node]]\nname = 'case'\nmass = '50 kg'\n[[heat.node]]\nname = 'floor'\ntemperature = '15 degC'\n\
         [[heat.path]]\nbetween = ['oil', 'gear']\nconductance = '20 W/K'\n\
         [[heat.path]]\nbetween = ['oil', 'case']\narea = '0.4 m^2'\ncoefficient = '200 W/(m^2 K)'\n\
         [[heat.path]]\nbetween = ['case', 'ambient']\n{surface}[[heat.path]]\nbetween = ['case', 'floor']\n{sides}"
    );
    let tips = [Some(76.0), Some(96.0), Some(236.0)];
    let held = simple([None; 3], &apart(78.0)).replace("'frame'", "'ring'");
    vec![
        ("simple", head(ends) + oil + two + physical + &simple([None; 3], &apart(78.0))),
        ("simple, tips", head(ends) + oil + "viscosity = '20 mPa s'\n" + physical + &simple(tips, geometry)),
        ("dynamic", head("'sun', 'carrier', 'ring', 'wheel'") + wheels + oil + two + &held + given + dynamic),
        ("double", head(ends) + oil + two + &double([None; 2], &tooth(None))),
        ("double, tips", head(ends) + oil + two + &double([Some(128.0), Some(72.0)], &tooth(Some(312.0)))),
        ("stepped", head(ends) + oil + two + &stepped(false, &apart(120.0)) + "geometry = " + geometry),
        ("stepped, tips", head(ends) + oil + two + &stepped(true, geometry)),
        ("efficiencies", head(ends) + &plain + "basic_efficiency = { forward = 0.98, backward = 0.97 }\n"),
        ("efficiencies, by kind", head(ends) + &plain + by_kind),
        ("ravigneaux", head("'sun', 'carrier', 'wheel'") + oil + two + &ravigneaux(false)),
        (
            "ravigneaux, tips",
            head("'sun', 'carrier', 'wheel'") + "[oil]\nname = 'ISO VG 220'\nvolume = '4 l'\n" + &ravigneaux(true),
        ),
        ("bevel", head(ends) + &bevel(None)),
        ("bevel, tips", head(ends) + &bevel(Some(70.0))),
        ("mesh", head("'sun', 'lay', 'mid', 'end', 'carrier'") + oil + two + &mesh(false)),
        ("mesh, tips", head("'sun', 'lay', 'mid', 'end', 'carrier'") + oil + two + &mesh(true)),
        ("variators", head("'sun', 'carrier', 'ring'") + variators),
        ("heat, housing", head(ends) + losses + &housing + &plain + "basic_efficiency = 0.97\n"),
        ("heat, masses", head(ends) + &masses + &plain + "basic_efficiency = 0.97\n"),
        ("heat, coefficient", head(ends) + &coefficient + &plain + "basic_efficiency = 0.97\n"),
        ("heat, conductance", head(ends) + heat + "conductance = '45 W/K'\n" + &plain + "basic_efficiency = 0.97\n"),
        ("heat, network", head(ends) + &network + &plain + "basic_efficiency = 0.97\n"),
    ]
}

// ---- Keys and values of a file ---------------------------------------------------------------

/// What tells nothing of the train.
const ABOUT: &[&str] = &["format", "name", "source", "notes", "operation", "scenario", "study"];

/// Keys of a file that have a value, without the positions of lists.
fn keys(value: &toml::Value, path: &str, all: &mut Vec<String>) {
    match value {
        toml::Value::Table(table) => {
            for (key, value) in table.iter().filter(|(key, _)| !path.is_empty() || !ABOUT.contains(&key.as_str())) {
                keys(value, &if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, all);
            }
        }
        toml::Value::Array(entries) if entries.iter().any(toml::Value::is_table) => {
            entries.iter().for_each(|value| keys(value, path, all));
        }
        _ if all.iter().any(|key| key == path) => {}
        _ => all.push(path.to_owned()),
    }
}

/// Changes a key wherever it is, in the entries of these names or in all; removes it where there is nothing to put there.
fn change(table: &mut toml::Table, steps: &[&str], of: &[String], to: &dyn Fn(&toml::Value) -> Option<toml::Value>) {
    let (first, rest) = steps.split_first().unwrap();
    if rest.is_empty() {
        if let Some(value) = table.get(*first) {
            match to(value) {
                Some(new) => drop(table.insert((*first).into(), new)),
                None => drop(table.remove(*first)),
            }
        }
        return;
    }
    match table.get_mut(*first) {
        Some(toml::Value::Table(inner)) => change(inner, rest, of, to),
        Some(toml::Value::Array(all)) => {
            for inner in all.iter_mut().filter_map(toml::Value::as_table_mut) {
                let is_of = inner
                    .get("name")
                    .and_then(toml::Value::as_str)
                    .is_none_or(|n| of.is_empty() || of.iter().any(|o| o == n));
                if is_of {
                    change(inner, rest, of, to);
                }
            }
        }
        _ => {}
    }
}

fn changed(text: &str, key: &str, of: &[String], to: &dyn Fn(&toml::Value) -> Option<toml::Value>) -> Option<Model> {
    let mut document: toml::Table = text.parse().unwrap();
    let steps: Vec<&str> = key.split('.').collect();
    change(&mut document, &steps, of, to);
    Model::from_toml(&toml::to_string(&document).unwrap()).ok()
}

/// A number of the file a little larger, or the numbers of a list; a count by so many.
fn larger(value: &toml::Value, factor: f64, more: i64) -> Option<toml::Value> {
    Some(match value {
        toml::Value::Integer(n) => toml::Value::Integer(n + more),
        toml::Value::Float(x) => toml::Value::Float(if *x == 0.0 { factor - 1.0 } else { x * factor }),
        toml::Value::String(text) => {
            let (number, unit) = text.split_once(' ')?;
            let x: f64 = number.parse().ok()?;
            toml::Value::String(format!("{:?} {unit}", if x == 0.0 { factor - 1.0 } else { x * factor }))
        }
        toml::Value::Array(all) => {
            toml::Value::Array(all.iter().map(|x| larger(x, factor, more)).collect::<Option<Vec<_>>>()?)
        }
        _ => return None,
    })
}

/// The text of all files, without what is told about what is not there.
fn numbers(out: &Export) -> Vec<String> {
    let told = |l: &&str| !["not carried over", "no inertias", "have a mass"].iter().any(|t| l.contains(t));
    out.files.iter().flat_map(|f| f.text.lines()).filter(told).map(str::to_owned).collect()
}

/// Whether numbers differ by more than rounding does.
fn moved(a: &Export, b: &Export) -> bool {
    let (a, b) = (numbers(a), numbers(b));
    let words = |l: &str| -> Vec<String> {
        l.split(|c: char| !(c.is_alphanumeric() || "+-.".contains(c))).map(str::to_owned).collect()
    };
    let line = |a: &str, b: &str| {
        let (a, b) = (words(a), words(b));
        let number = |w: &String| w.parse::<f64>().ok();
        let most = a.iter().filter_map(number).fold(0.0f64, |m, x| m.max(x.abs()));
        a.len() != b.len()
            || a.iter().zip(&b).any(|(a, b)| match (number(a), number(b)) {
                (Some(x), Some(y)) => (x - y).abs() > (1e-11 * x.abs()).max(1e-13 * most),
                _ => a != b,
            })
    };
    a.len() != b.len() || a.iter().zip(&b).any(|(a, b)| a != b && line(a, b))
}

/// Words that may stand at a key.
fn words(key: &str) -> Vec<String> {
    static SCHEMA: LazyLock<BTreeMap<String, Vec<String>>> = LazyLock::new(schema_keys);
    match key.split_once('.').unwrap_or_default() {
        ("laws", family) => {
            willis::losses::entries().iter().filter(|e| e.family == family).map(|e| e.id.to_owned()).collect()
        }
        ("bearing", "designation") => vec!["NU 205".into(), "6206".into()],
        ("bearing", "series") => vec!["302".into(), "322".into()],
        ("oil", "name") => vec!["ISO VG 100".into()],
        _ => SCHEMA.get(key).cloned().unwrap_or_default(),
    }
}

/// Whether another value of a key makes another file, in all entries or in the first alone; none where there can be no
/// other.
fn moves(text: &str, key: &str, kind: &str, request: &ExportRequest, whole: &Export) -> Option<bool> {
    // What is no number is left out, or another word.
    let numbers = [(1.1, 1), (0.9, -1), (1.0001, 2), (0.99, 12)];
    let numbers = numbers.map(|(factor, more)| -> Other { Box::new(move |value| larger(value, factor, more)) });
    let words = words(key).into_iter().map(|word| -> Other { Box::new(move |_| Some(word.clone().into())) });
    let mut any = None;
    for other in numbers.into_iter().chain(words) {
        for only_first in [false, true] {
            let first = Cell::new(true);
            let to = |value: &toml::Value| if only_first && !first.take() { Some(value.clone()) } else { other(value) };
            let Some(model) = changed(text, key, &[], &to) else { continue };
            // What can no longer be exported is another file.
            if export(&model, kind, request).map_or(true, |other| moved(whole, &other)) {
                return Some(true);
            }
            any = Some(false);
        }
    }
    any
}

/// What stands at a key instead; nothing, and it is left out.
type Other = Box<dyn Fn(&toml::Value) -> Option<toml::Value>>;

/// Keys of the schema that have a value, without the positions of lists, and the words that they take.
fn schema_keys() -> BTreeMap<String, Vec<String>> {
    fn walk(schema: &serde_json::Value, path: &str, all: &mut BTreeMap<String, Vec<String>>) {
        let mut inside = false;
        if let Some(properties) = schema["properties"].as_object().filter(|_| schema["then"].is_null()) {
            inside = true;
            for (key, value) in properties.iter().filter(|(key, _)| !path.is_empty() || !ABOUT.contains(&key.as_str()))
            {
                walk(value, &if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, all);
            }
        }
        for part in ["then", "else"].iter().filter_map(|part| schema.get(part)) {
            inside = true;
            walk(part, path, all);
        }
        let branches = ["allOf", "oneOf", "anyOf"].iter().filter_map(|b| schema[b].as_array()).flatten();
        // What is one value or a table of several has all of them.
        let tables = branches
            .filter(|b| b["properties"].is_object() || b["then"].is_object() || b["items"]["properties"].is_object());
        for branch in tables {
            inside = true;
            walk(branch, path, all);
        }
        if schema["items"].get("properties").or(schema["items"].get("allOf")).is_some() {
            inside = true;
            walk(&schema["items"], path, all);
        }
        if !inside {
            let words = schema["enum"].as_array().into_iter().flatten().filter_map(|w| w.as_str().map(str::to_owned));
            all.entry(path.to_owned()).or_default().extend(words);
        }
    }
    let mut all = BTreeMap::new();
    walk(&willis::train::schema(), "", &mut all);
    all
}

/// Keys that say what the train consists of, who is joined to whom, and what type it is.
fn is_train(key: &str, text: &str) -> bool {
    let last = key.rsplit('.').next().unwrap();
    let joins = ["name", "member", "members", "carrier", "engaged", "terminals", "input", "output", "side", "sense"];
    let kinds = ["set.type", "mesh.kind", "shift_element.kind", "shift_element.blocks", "mesh.gears.internal"];
    // A name of the catalogue stands for data.
    let is_data = key == "oil.name" && !text.contains("viscosity");
    joins.contains(&last) && !is_data || kinds.contains(&key)
}

/// Examples and generated files; each with its number.
fn texts() -> impl Iterator<Item = (usize, (String, String))> {
    let own = generated().into_iter().map(|(name, text)| (name.to_owned(), text));
    own.chain(examples()).filter(|(_, text)| Model::from_toml(text).is_ok()).enumerate()
}

/// Which keys of a text meet a format: each key one; where losses are computed, which takes time, one in 24 meets two.
fn meet(model: &Model, text: usize, kind: usize, keys: usize) -> Vec<usize> {
    let meets = |key: &usize| match model.train().is_physical() {
        true => (text + kind).is_multiple_of(4) && (text + key).is_multiple_of(24),
        false => (text + key + kind).is_multiple_of(KINDS.len()),
    };
    (0..keys).filter(meets).collect()
}

// ---- Properties ------------------------------------------------------------------------------

/// The generated files have every key of the schema, so what holds for their keys holds for all.
#[test]
fn no_key_of_the_schema_is_missing_from_the_generated_files() {
    let mut all = vec![];
    for (name, text) in generated() {
        Model::from_toml(&text).unwrap_or_else(|e| panic!("{name}: {e}"));
        keys(&text.parse::<toml::Table>().unwrap().into(), "", &mut all);
    }
    let missing: Vec<String> = schema_keys()
        .into_keys()
        .filter(|key| {
            let within = |other: &String| {
                other.strip_prefix(key.as_str()).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
            };
            !all.iter().any(within)
        })
        // A table is another file.
        .filter(|key| key != "variator.machines.efficiency.map")
        // Gears of their own geometry are those of stepped sets, which are cylindrical.
        .filter(|key| !["set.suns.geometry.shaft_angle", "set.rings.geometry.shaft_angle"].contains(&key.as_str()))
        // Hypoid gears are pairs: sets refuse both.
        .filter(|key| !(key.starts_with("set.") && (key.ends_with(".offset") || key.ends_with(".spiral_angle"))))
        .collect();
    assert!(missing.is_empty(), "add them to a file: {missing:?}");
    assert!(schema_keys().len() > 150, "{}", schema_keys().len());
}

/// What every format has and moves no number there: text, key, why.
const STILL: &[(&str, &str, &str)] =
    &[("locked-both-ways", "set.basic_efficiency", "it locks as well with a little more or less friction")];

/// Every key is told, or another value of it makes another file, or with the rest as it is it can have no other.
#[test]
fn every_key_is_told_or_moves_a_number() {
    let (mut tried, mut wrong) = (0, vec![]);
    for (i, (name, text)) in texts() {
        let model = Model::from_toml(&text).unwrap();
        let mut all = vec![];
        keys(&text.parse::<toml::Table>().unwrap().into(), "", &mut all);
        all.retain(|key| !is_train(key, &text));
        for (k, kind) in KINDS.iter().map(|k| k.id).enumerate() {
            let request = few(&model, kind);
            let met = meet(&model, i, k, all.len());
            let Some(whole) = (!met.is_empty()).then(|| export(&model, kind, &request).ok()).flatten() else {
                continue;
            };
            for key in met.into_iter().map(|j| &all[j]) {
                if whole.not_carried.iter().any(|n| n.key == *key && !n.in_part) {
                    continue;
                }
                let is_known = STILL.iter().any(|(text, of, _)| (*text, *of) == (name.as_str(), key.as_str()));
                if !is_known && moves(&text, key, kind, &request, &whole) == Some(false) {
                    wrong.push(format!("{name}, {kind}: {key}"));
                }
                tried += 1;
            }
        }
    }
    assert!(wrong.is_empty() && tried > 100, "{tried} {wrong:?}");
}

/// What is said to be left out makes no difference to the numbers.
#[test]
fn what_is_not_carried_changes_nothing() {
    let (mut tried, mut wrong) = (0, vec![]);
    for (i, (name, text)) in texts() {
        let model = Model::from_toml(&text).unwrap();
        let mut all = vec![];
        keys(&text.parse::<toml::Table>().unwrap().into(), "", &mut all);
        // Where losses are computed, which takes time, two formats.
        let kinds = KINDS.iter().map(|k| k.id).enumerate();
        for (_, kind) in kinds.filter(|(k, _)| !model.train().is_physical() || (i + k).is_multiple_of(8)) {
            let request = few(&model, kind);
            let Ok(whole) = export(&model, kind, &request) else { continue };
            // What weighs is there as a whole or not at all: without the part that is unknown the rest is there.
            let is_inertia =
                |key: &str| ["mujoco", "drake"].contains(&kind) && (key.ends_with(".mass") || key.contains("inertia"));
            let left = whole.not_carried.iter().filter(|n| !is_inertia(&n.key) && !n.in_part);
            for left in left.skip(i % 3).step_by(3) {
                // An entry of which nothing is carried goes as a whole.
                let table = left.key.split('.').next().unwrap();
                let is_left = |key: &String| is_train(key, &text) || whole.not_carried.iter().any(|n| n.key == *key);
                let goes = || all.iter().filter(|key| key.split('.').next() == Some(table)).all(is_left);
                let key = if ["drag", "shaft"].contains(&table) && goes() { table } else { &left.key };
                let Some(other) = changed(&text, key, &left.of, &|_| None) else { continue };
                if moved(&whole, &made(&other, kind, &request)) {
                    wrong.push(format!("{name}, {kind}: {}", left.key));
                }
                tried += 1;
            }
        }
    }
    assert!(wrong.is_empty() && tried > 50, "{tried} {wrong:?}");
}

// ---- Worked numbers --------------------------------------------------------------------------

fn told<'e>(out: &'e Export, key: &str) -> Option<(&'e [String], &'e [String])> {
    out.not_carried.iter().find(|n| n.key == key).map(|n| (&*n.of, &*n.values))
}

/// `../shared/cases/mass.toml` in short: four planets of 2 kg, a sun of 1e-5 kg m².
fn weighing(planet: &str) -> Model {
    let text = format!(
        r#"
        format = 1
        name = "mass"
        members = ["sun", "carrier"]
        terminals = ["sun", "carrier"]
        inertias = {{ sun = "1e-5 kg m^2" }}
        [[set]]
        name = "P1"
        sun = {{ member = "sun", teeth = 30 }}
        planet = {{ teeth = 20, count = 4, {planet} }}
        ring = {{ member = "frame", teeth = 70 }}
        carrier = "carrier"
        mesh_efficiency = 0.99
        "#
    );
    Model::from_toml(&text).unwrap()
}

#[test]
fn formula_an_inertia_is_whole_or_not_there() {
    let after = |out: &Export, before: &str| -> Option<f64> {
        let value = out.files[0].text.split(before).nth(1)?.split(['"', ')']).next()?;
        value.parse().ok()
    };
    // The sun turns 10/3 times as fast as the carrier; planets 50 mm from the axis weigh 2 kg each.
    let planets = 4.0 * 2.0 * 0.05f64.powi(2);
    let whole = 1e-5 * (10.0f64 / 3.0).powi(2) + planets;
    let placed = weighing("mass = \"2 kg\", orbit_radius = \"50 mm\"");
    let out = made(&placed, "mujoco", &ExportRequest::default());
    let found = after(&out, "armature=\"").unwrap();
    assert!((found - whole).abs() < 1e-12 && (found - 0.0201).abs() < 1e-4, "{found}");
    // Between sun and ring the planets' teeth settle no ratio.
    assert_eq!(out.not_carried.iter().map(|n| &*n.key).collect::<Vec<_>>(), ["set.planet.teeth"]);
    let out = made(&placed, "drake", &ExportRequest::default());
    let found = after(&out, "rotor_inertia value=\"").unwrap();
    assert!((found - whole * 0.09).abs() < 1e-12, "{found}");
    let out = made(&placed, "modelica", &ExportRequest::default());
    let found = after(&out, "inertia_carrier(J=").unwrap();
    assert!((found - planets).abs() < 1e-12, "{found}");
    let out = made(&placed, "csv", &ExportRequest::default());
    assert_eq!(told(&out, "set.planet.orbit_radius"), Some((&["P1".to_owned()][..], &["50 mm".to_owned()][..])));
    let unplaced = weighing("mass = \"2 kg\"");
    for kind in ["mujoco", "drake"] {
        let out = made(&unplaced, kind, &ExportRequest::default());
        let text = &out.files[0].text;
        assert_eq!((after(&out, "armature=\""), after(&out, "rotor_inertia value=\"")), (None, None), "{text}");
        let keys: Vec<&str> = out.not_carried.iter().map(|n| n.key.as_str()).collect();
        assert_eq!(keys, ["set.planet.teeth", "set.planet.count", "set.planet.mass", "inertias.sun"], "{text}");
        assert!(text.contains("set.planet.mass (P1: 2 kg), inertias.sun (100 g cm^2)"), "{text}");
        assert!(out.notes.iter().any(|n| n.contains("the planets P1.planet have a mass")), "{:?}", out.notes);
    }
    let out = made(&unplaced, "modelica", &ExportRequest::default());
    assert_eq!(after(&out, "inertia_sun(J="), Some(1e-5));
    assert_eq!(after(&out, "inertia_carrier(J="), None);
    assert!(told(&out, "set.planet.mass").is_some() && told(&out, "inertias.sun").is_none(), "{:?}", out.not_carried);
}

/// Wheels behind an elastic shaft do not follow the engine: what they weigh is at no one joint.
#[test]
fn an_inertia_behind_an_elastic_shaft_is_told() {
    let model = Model::from_toml(&example("launch")).unwrap();
    for kind in ["mujoco", "drake"] {
        let request = ExportRequest { state: Some(model.train().states()[0].name.clone()), ..ExportRequest::default() };
        let out = made(&model, kind, &request);
        assert!(out.not_carried.iter().any(|n| n.key.starts_with("inertias.")), "{:?}", out.not_carried);
        assert!(!out.notes.iter().any(|n| n.contains("no inertias are given")), "{:?}", out.notes);
    }
}

/// An open clutch that drags with 3 N m: either it is in the numbers, or the amount is told and they are those without it.
#[test]
fn the_drag_of_an_open_clutch_is_told_with_its_amount() {
    let plain = example("zf-8hp70");
    let text = CLUTCH.replace("TRAIN", &plain);
    let [model, without] = [&text, &plain].map(|text| Model::from_toml(text).unwrap());
    for kind in KINDS.iter().map(|k| k.id) {
        let request = ExportRequest { state: (kind != "modelica").then(|| "1".into()), ..few(&model, "modelica") };
        let out = made(&model, kind, &request);
        let text = &out.files[0].text;
        if kind == "modelica" {
            assert_eq!(told(&out, "drag.coulomb"), None);
            assert!(text.contains("BearingFriction friction_open_E(useSupport=true, tau_pos=[0, 3; 1, 3])"), "{text}");
            continue;
        }
        if moved(&out, &made(&without, kind, &request)) {
            assert_eq!(told(&out, "drag.coulomb"), None, "{kind}");
            continue;
        }
        assert_eq!(told(&out, "drag.coulomb"), Some((&["open E".to_owned()][..], &["3 N m".to_owned()][..])), "{kind}");
        // Whose it is goes with it.
        assert_eq!(told(&out, "drag.members"), None);
        assert!(out.notes.iter().any(|n| n.contains("drag.coulomb (open E: 3 N m)")), "{kind}: {:?}", out.notes);
        assert!(kind == "csv" || text.contains("drag.coulomb (open E: 3 N m)"), "{kind}: {text}");
    }
}

const CLUTCH: &str = "TRAIN\n[[drag]]\nname = \"open E\"\nmembers = [\"r2s3\", \"r3s4\"]\ncoulomb = \"3 N m\"\n";

/// Of a table whose first row alone is used the others are told.
#[test]
fn a_table_is_carried_in_part() {
    let model = Model::from_toml(&example("lossy-gear")).unwrap();
    let out = made(&model, "csv", &ExportRequest::default());
    let rows = out.not_carried.iter().find(|n| n.key == "mesh.loss_table.forward").unwrap();
    assert_eq!((rows.in_part, &rows.values[..]), (true, &["0.95, 0.97".to_owned()][..]));
    assert!(
        out.notes.iter().any(|n| n.contains("mesh.loss_table.forward in part (pair: 0.95, 0.97)")),
        "{:?}",
        out.notes
    );
    assert!(made(&model, "modelica", &ExportRequest::default()).not_carried.is_empty());
}
