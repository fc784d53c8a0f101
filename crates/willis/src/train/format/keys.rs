//! Every key of the train file: its kind, whether it is required, and what it means.

use crate::units::Dimension;

/// What kind of value a key takes.
#[derive(Debug)]
pub(super) enum Kind {
    /// The format number.
    Format,
    Text,
    /// A member, shift element or state, by name.
    Name,
    Names,
    Integer,
    /// A number of rows.
    Samples,
    Flag,
    Choice(&'static [&'static str]),
    /// A number, or `{ forward, backward }`.
    Efficiency,
    /// A number, `{ forward, backward }`, or `{ external, internal }` with either of those.
    SetEfficiency,
    /// A plain number.
    Number,
    /// A number with a unit.
    Quantity(Dimension),
    /// Member name to quantity.
    Quantities(Dimension),
    /// A list of pairs.
    Points([Measure; 2]),
    /// A plain number, or points of it over a quantity.
    NumberOrPoints(Dimension),
    /// A list of times and names.
    Schedule,
    /// A value over time.
    Signal(&'static SignalKind),
    /// Two signals, the second of plain numbers.
    Product(&'static SignalKind),
    Table(&'static Table),
    /// `[[key]]`, or a list of inline tables; with the least number of entries.
    Tables(&'static Table, usize),
    /// Like `Tables`, the table depending on the entry's `type` (the first is the default).
    Variants(&'static [(&'static str, &'static Table)]),
}

/// The dimension of a quantity; `None` for a plain number.
pub(super) type Measure = Option<Dimension>;

/// What a value over time may be: a constant, or a table by its `type`.
#[derive(Debug)]
pub(super) struct SignalKind {
    /// What it is called in the schema.
    pub name: &'static str,
    pub of: Measure,
    pub types: &'static [(&'static str, &'static Table)],
}

#[derive(Debug)]
pub(super) struct Key {
    pub name: &'static str,
    pub kind: Kind,
    pub required: bool,
    pub doc: &'static str,
}

#[derive(Debug)]
pub(super) struct Table {
    pub doc: &'static str,
    pub keys: &'static [Key],
}

const fn must(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, required: true, doc }
}

const fn may(name: &'static str, kind: Kind, doc: &'static str) -> Key {
    Key { name, kind, required: false, doc }
}

pub(super) static FILE: Table = Table {
    doc: "A Willis gear train, format 1. Quantities are texts with a unit (\"4920 rpm\", \"350 N m\", \"75 kW\").",
    keys: &[
        must("format", Kind::Format, "Format of this file; 1."),
        must("name", Kind::Text, "What the train is called."),
        may("source", Kind::Text, "Where the data come from."),
        may("notes", Kind::Text, "Anything else worth keeping with the train."),
        must(
            "members",
            Kind::Names,
            "Every rotor. `frame` always exists and is at rest; planets of sets need no entry.",
        ),
        may(
            "terminals",
            Kind::Names,
            "Members on which an external torque may act. The first is the input and the last the output, unless `input` and `output` or a state say otherwise.",
        ),
        may("input", Kind::Name, "Where power enters when driving."),
        may("output", Kind::Name, "Where power leaves when driving."),
        may("mesh", Kind::Tables(&MESH, 0), "Gear pairs on a carrier."),
        may("set", Kind::Variants(SETS), "Planetary sets; each expands into its meshes."),
        may("shift_element", Kind::Tables(&SHIFT_ELEMENT, 0), "Clutches, brakes and one-way clutches."),
        may("state", Kind::Tables(&STATE, 0), "The shift table. Without it the train is as drawn."),
        may("operation", Kind::Tables(&OPERATION, 0), "Operating points to analyse."),
        may("oil", Kind::Table(&OIL), "The lubricant: from the catalogue, or by its data."),
        may("laws", Kind::Table(&LAWS), "Which law of each family is used; `willis laws` lists them."),
        may("housing", Kind::Table(&HOUSING), "What surrounds the gears."),
        may("bearing", Kind::Tables(&BEARING, 0), "Rolling bearings."),
        may("seal", Kind::Tables(&SEAL, 0), "Radial lip seals."),
        may("rotor", Kind::Tables(&ROTOR, 0), "Carriers and drums that drag the fluid around them."),
        may(
            "inertias",
            Kind::Quantities(Dimension::INERTIA),
            "Moments of inertia of members about their axes; of planets, all of them together. Planets of sets may have theirs in the set.",
        ),
        may("drag", Kind::Tables(&DRAG, 0), "Friction that does not depend on tooth loads, in motion."),
        may("shaft", Kind::Tables(&SHAFT, 0), "Elastic shafts."),
        may("scenario", Kind::Tables(&SCENARIO, 0), "Motions to simulate."),
        may("study", Kind::Tables(&STUDY, 0), "Sweeps over many operating points: `willis sweep FILE --study NAME`."),
    ],
};

/// The keys of one gear's teeth, after those given.
macro_rules! with_teeth {
    ($($key:expr),* $(,)?) => {
        &[
            $($key,)*
            may("shift", Kind::Number, "Profile shift coefficient x; positive moves the teeth outward, also on a ring (DIN gives the opposite sign for rings). Default: 0."),
            may("addendum", Kind::Number, "Addendum coefficient of the basic rack. Default: that of the geometry, 1."),
            may("dedendum", Kind::Number, "Dedendum coefficient of the basic rack. Default: that of the geometry, 1.25."),
            may("tip_alteration", Kind::Quantity(Dimension::LENGTH), "Tip alteration k m_n; negative shortens the teeth."),
            may("tip_diameter", Kind::Quantity(Dimension::LENGTH), "Tip diameter, instead of addendum and alteration."),
            may("roughness", Kind::Quantity(Dimension::LENGTH), "Arithmetic mean roughness Ra of the flanks. Default: that of the geometry."),
            may("immersion", Kind::Quantity(Dimension::LENGTH), "How deep the pitch circle dips into the oil at rest."),
        ]
    };
}

static GEOMETRY: Table = Table {
    doc: "Involute teeth of a cylindrical pair, or of all pairs of a set.",
    keys: &[
        must("module", Kind::Quantity(Dimension::LENGTH), "Normal module."),
        must("width", Kind::Quantity(Dimension::LENGTH), "Common face width; of one helix when double helical."),
        may("pressure_angle", Kind::Quantity(Dimension::ANGLE), "Normal pressure angle. Default: 20 deg."),
        may("helix", Kind::Quantity(Dimension::ANGLE), "Helix angle at the reference circle. Default: 0 deg."),
        may("double_helical", Kind::Flag, "true for herringbone gears: two helices whose axial forces cancel."),
        may(
            "centre_distance",
            Kind::Quantity(Dimension::LENGTH),
            "Operating centre distance. Default: the one that follows from the profile shifts.",
        ),
        may("addendum", Kind::Number, "Addendum coefficient of the basic rack. Default: 1."),
        may("dedendum", Kind::Number, "Dedendum coefficient of the basic rack. Default: 1.25."),
        may("roughness", Kind::Quantity(Dimension::LENGTH), "Arithmetic mean roughness Ra of the flanks."),
        may("youngs_modulus", Kind::Quantity(Dimension::PRESSURE), "Of the gear material. Default: steel, 206 GPa."),
        may("poisson_ratio", Kind::Number, "Of the gear material. Default: 0.3."),
    ],
};

const GEAR_GEOMETRY: Key =
    may("geometry", Kind::Table(&GEOMETRY), "The teeth: module, width, angles. With an oil, losses are computed.");

static OIL: Table = Table {
    doc: "The lubricant. Either a name of the catalogue (`willis laws --oils`), or its data.",
    keys: &[
        may("name", Kind::Text, "A designation of the catalogue, `ISO VG 220`; or any name beside own data."),
        may(
            "base",
            Kind::Choice(&["mineral", "pao", "ester", "pag", "phosphate-ester", "traction"]),
            "Base of the oil. Default: mineral.",
        ),
        may(
            "viscosity_40",
            Kind::Quantity(Dimension::KINEMATIC_VISCOSITY),
            "Kinematic viscosity at 40 degrees Celsius.",
        ),
        may(
            "viscosity_100",
            Kind::Quantity(Dimension::KINEMATIC_VISCOSITY),
            "Kinematic viscosity at 100 degrees Celsius.",
        ),
        may(
            "viscosity",
            Kind::Quantity(Dimension::DYNAMIC_VISCOSITY),
            "Dynamic viscosity at the operating temperature, instead of the two others.",
        ),
        may("density_15", Kind::Quantity(Dimension::DENSITY), "Density at 15 degrees Celsius. Default: by base."),
        may(
            "pressure_viscosity",
            Kind::Quantity(Dimension::PRESSURE_COEFFICIENT),
            "Pressure-viscosity coefficient. Default: by base and viscosity.",
        ),
        may(
            "lubricant_factor",
            Kind::Number,
            "Factor X_L of the oil in tooth friction, where measured. Default: by base.",
        ),
        may("temperature", Kind::Quantity(Dimension::TEMPERATURE), "Operating temperature. Default: 60 degC."),
        may(
            "supply",
            Kind::Choice(&["bath", "jet", "mist", "grease"]),
            "How the oil gets to gears and bearings: `bath` churns where gears are immersed, `jet` and `mist` turn the gears in air and oil mist.",
        ),
        may("volume", Kind::Quantity(Dimension::VOLUME), "Volume of oil in the sump; needed for churning."),
        may(
            "mist",
            Kind::Number,
            "Volumes of air to one volume of oil in the mist. Default: 34.25 for rotors and the windage law anderson-loewenthal; without it gears turn in air under the other laws.",
        ),
    ],
};

static LAWS: Table = Table {
    doc: "Which law of each family is used; `willis laws` lists them with range and source.",
    keys: &[
        may("mesh_friction", Kind::Text, "Friction of the teeth. Default: schlenk, or constant without an oil."),
        may("friction_coefficient", Kind::Number, "The coefficient of the law `constant`. Default: 0.05."),
        may("loss_factor", Kind::Text, "Loss factor of a mesh."),
        may("load_sharing", Kind::Text, "Sharing of the load between tooth pairs."),
        may("film", Kind::Text, "Thickness of the oil film."),
        may("film_reduction", Kind::Text, "Reduction of the film by heating at the inlet."),
        may("rolling", Kind::Text, "Rolling losses. Default: with friction laws that lack them."),
        may("bearing", Kind::Text, "Friction of rolling bearings."),
        may("windage", Kind::Text, "Gears in air."),
        may("churning", Kind::Text, "Gears in the sump."),
        may("seal", Kind::Text, "Lip seals."),
        may("rotor_drag", Kind::Text, "Carriers and drums."),
    ],
};

static HOUSING: Table = Table {
    doc: "What surrounds the gears.",
    keys: &[
        may(
            "enclosure",
            Kind::Number,
            "Factor on windage by `dawson-1984`: 1 free, 0.6 to 0.7 large case, 0.5 fitting case. Default: 1. `diab` takes the axial gap instead.",
        ),
        may(
            "axial_gap",
            Kind::Quantity(Dimension::LENGTH),
            "Axial distance from the gear faces to the wall. Default: free.",
        ),
    ],
};

static BEARING: Table = Table {
    doc: "Rolling bearings between two members: `count` of them; on planets, at every planet.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must("members", Kind::Names, "The two members it joins, or one that turns against the frame."),
        may("designation", Kind::Text, "`NU 1022`, `6205-2RS1`, `32216`: kind, size and constants from the catalogue."),
        may("kind", Kind::Choice(BEARING_KINDS), "Kind, where the catalogue does not have it."),
        may("series", Kind::Text, "Series of its constants, `10`, `62`, `322`."),
        may("bore", Kind::Quantity(Dimension::LENGTH), "Bore."),
        may("outside_diameter", Kind::Quantity(Dimension::LENGTH), "Outside diameter."),
        may("width", Kind::Quantity(Dimension::LENGTH), "Width."),
        may("static_rating", Kind::Quantity(Dimension::FORCE), "Static load rating C0."),
        may("axial_factor", Kind::Number, "Axial factor Y of a tapered bearing."),
        may("count", Kind::Integer, "How many sit side by side and share the load. Default: 1."),
        may("shaft_diameter", Kind::Quantity(Dimension::LENGTH), "Of the seat; checked against the bore."),
        may(
            "span",
            Kind::Quantity(Dimension::LENGTH),
            "Distance between the outermost of them; takes the tilting moment of helical planets. Default: the face width.",
        ),
        may(
            "radial_load",
            Kind::Quantity(Dimension::FORCE),
            "A constant radial load beside those of the gears, on all of them together. Default: none.",
        ),
        may(
            "axial_load",
            Kind::Quantity(Dimension::FORCE),
            "A constant axial load beside those of the gears. Default: none.",
        ),
        may("supply", Kind::Choice(&["bath", "jet", "mist", "grease"]), "How it gets its oil. Default: as the train."),
        may(
            "level",
            Kind::Quantity(Dimension::LENGTH),
            "Oil level above the lowest rolling element's contact, for a bath.",
        ),
    ],
};

static SEAL: Table = Table {
    doc: "A radial lip seal.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must(
            "members",
            Kind::Names,
            "The shaft, or the shaft and the member that holds the seal (default: the frame).",
        ),
        must("diameter", Kind::Quantity(Dimension::LENGTH), "Shaft diameter."),
        may("material", Kind::Choice(&["fkm", "nbr"]), "Of the lip. Default: fkm."),
        may("count", Kind::Integer, "How many lips. Default: 1."),
    ],
};

static ROTOR: Table = Table {
    doc: "A smooth body of revolution, a carrier or a drum, that drags the fluid around it.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must("member", Kind::Name, "The member it belongs to."),
        must("radius", Kind::Quantity(Dimension::LENGTH), "Outer radius."),
        must("length", Kind::Quantity(Dimension::LENGTH), "Axial length of the rim."),
        must("radial_gap", Kind::Quantity(Dimension::LENGTH), "Gap between rim and wall."),
        may(
            "axial_gap",
            Kind::Quantity(Dimension::LENGTH),
            "Gap between each face and the wall. Default: the radial gap.",
        ),
        may("fluid", Kind::Choice(&["oil", "mist", "air"]), "What it turns in. Default: mist."),
    ],
};

const BEARING_KINDS: &[&str] = &[
    "deep-groove-ball",
    "angular-contact-ball",
    "double-row-angular-contact-ball",
    "four-point-contact-ball",
    "self-aligning-ball",
    "cylindrical-roller",
    "full-complement-cylindrical-roller",
    "needle-roller",
    "tapered-roller",
    "spherical-roller",
    "toroidal-roller",
    "axial-ball",
    "axial-cylindrical-roller",
];

static MESH: Table = Table {
    doc: "A gear pair on a carrier.",
    keys: &[
        may("name", Kind::Text, "Default: built from its gears."),
        must(
            "gears",
            Kind::Tables(&GEAR, 2),
            "The two gears. They turn in opposite senses relative to the carrier unless one is internal or `sense` says otherwise.",
        ),
        may("carrier", Kind::Name, "The member that carries the axes. Default: frame."),
        may(
            "efficiency",
            Kind::Efficiency,
            "In the carrier frame; or { forward, backward }: forward = the first gear drives. Default: lossless, listed as an assumption.",
        ),
        may("count", Kind::Integer, "Identical meshes in parallel. Default: 1."),
        GEAR_GEOMETRY,
        may(
            "loss_table",
            Kind::Tables(&LOSS_ROW, 0),
            "Efficiency and bearing torque over speed, instead of an efficiency; operating points use its first row.",
        ),
        may(
            "sense",
            Kind::Choice(&["opposite", "same"]),
            "Relative to the carrier. `same` for chains and for the second side gear of a bevel set.",
        ),
        may(
            "kind",
            Kind::Choice(&["cylindrical", "bevel"]),
            "On a bevel pair the planet's speed is that of the carrier plus its spin.",
        ),
    ],
};

static GEAR: Table = Table {
    doc: "A gear of a mesh.",
    keys: with_teeth![
        must("member", Kind::Name, "The rotor it sits on."),
        must("teeth", Kind::Integer, "Tooth count."),
        may("internal", Kind::Flag, "true for a ring gear."),
    ],
};

static CENTRAL: Table = Table {
    doc: "A sun or ring gear.",
    keys: with_teeth![
        must("member", Kind::Name, "The rotor it sits on; `frame` for a gear that is always held."),
        must("teeth", Kind::Integer, "Tooth count."),
    ],
};

static STEP: Table = Table {
    doc: "A sun or ring gear and the step of the planet it meshes with.",
    keys: with_teeth![
        must("member", Kind::Name, "The rotor it sits on; `frame` for a gear that is always held."),
        must("teeth", Kind::Integer, "Tooth count."),
        must("planet_teeth", Kind::Integer, "Teeth of the step of the planet that it meshes with."),
        may("planet", Kind::Table(&PLANET_STEP), "The teeth of that step."),
        GEAR_GEOMETRY,
    ],
};

static PLANET_STEP: Table = Table { doc: "The teeth of a step of the planet.", keys: with_teeth![] };

static SIDE: Table = Table {
    doc: "A side gear of a bevel set.",
    keys: &[
        must("member", Kind::Name, "The rotor it sits on; `frame` for a gear that is always held."),
        must("teeth", Kind::Integer, "Tooth count."),
        may("planet_teeth", Kind::Integer, "Teeth of the planet where this gear meshes, when the planet is stepped."),
        may(
            "side",
            Kind::Choice(&["left", "right"]),
            "Gears on different sides turn in opposite senses relative to the carrier. Default: the first left, the others right.",
        ),
    ],
};

static PLANET: Table = Table {
    doc: "The planets of a set.",
    keys: with_teeth![
        may(
            "teeth",
            Kind::Integer,
            "Tooth count. Without it planet speeds are those of the nominal planet (z_ring - z_sun)/2.",
        ),
        may("count", Kind::Integer, "Number of planets; enables the assembly checks."),
        PLANET_MASS,
        PLANET_INERTIA,
        ORBIT_RADIUS,
    ],
};

const PLANET_MASS: Key = may(
    "mass",
    Kind::Quantity(Dimension::MASS),
    "Mass of one planet; its centrifugal force loads the planet bearings, and it turns with the carrier.",
);
const PLANET_INERTIA: Key =
    may("inertia", Kind::Quantity(Dimension::INERTIA), "Moment of inertia of one planet about its own axis.");
const ORBIT_RADIUS: Key = may(
    "orbit_radius",
    Kind::Quantity(Dimension::LENGTH),
    "Distance of the planet's axis from the carrier's. Default: the centre distance of the geometry.",
);

static STEPPED_PLANET: Table = Table {
    doc: "The stepped planets of a set; their teeth stand with the gears they mesh with.",
    keys: &[
        may("count", Kind::Integer, "Number of planets; enables the assembly checks."),
        PLANET_MASS,
        PLANET_INERTIA,
        ORBIT_RADIUS,
    ],
};

const NAME: Key = must("name", Kind::Text, "Unique; its planets are called after it, `P1.planet`.");
const TYPE: Key = may("type", Kind::Choice(SET_TYPES), "Default: simple.");
const CARRIER: Key = must("carrier", Kind::Name, "The member that carries the planets.");
const MESH_EFFICIENCY: Key = may(
    "mesh_efficiency",
    Kind::SetEfficiency,
    "Of each mesh in the carrier frame: a number, { forward, backward }, or { external = …, internal = … }.",
);
const BASIC_EFFICIENCY: Key = may(
    "basic_efficiency",
    Kind::Efficiency,
    "From the first to the second central gear with the carrier held; instead of mesh_efficiency.",
);

const SET_TYPES: &[&str] = &["simple", "double-planet", "stepped", "ravigneaux", "bevel"];

static SETS: &[(&str, &Table)] = &[
    ("simple", &SIMPLE),
    ("double-planet", &DOUBLE_PLANET),
    ("stepped", &STEPPED),
    ("ravigneaux", &RAVIGNEAUX),
    ("bevel", &BEVEL),
];

static SIMPLE: Table = Table {
    doc: "Sun, planets, ring.",
    keys: &[
        NAME,
        TYPE,
        must("sun", Kind::Table(&CENTRAL), "The sun gear."),
        may("planet", Kind::Table(&PLANET), "The planets."),
        must("ring", Kind::Table(&CENTRAL), "The ring gear."),
        CARRIER,
        GEAR_GEOMETRY,
        MESH_EFFICIENCY,
        BASIC_EFFICIENCY,
    ],
};

static DOUBLE_PLANET: Table = Table {
    doc: "Sun, inner planets, outer planets, ring.",
    keys: &[
        NAME,
        TYPE,
        must("sun", Kind::Table(&CENTRAL), "The sun gear; meshes with the inner planets."),
        may("inner_planet", Kind::Table(&PLANET), "The planets on the sun."),
        may("outer_planet", Kind::Table(&PLANET), "The planets on the ring, in mesh with the inner ones."),
        must("ring", Kind::Table(&CENTRAL), "The ring gear."),
        CARRIER,
        GEAR_GEOMETRY,
        MESH_EFFICIENCY,
        BASIC_EFFICIENCY,
    ],
};

static STEPPED: Table = Table {
    doc: "Planet shafts with several steps, each in mesh with a sun or a ring.",
    keys: &[
        NAME,
        TYPE,
        may("suns", Kind::Tables(&STEP, 0), "Sun gears."),
        may("rings", Kind::Tables(&STEP, 0), "Ring gears."),
        may("planet", Kind::Table(&STEPPED_PLANET), "The planets."),
        CARRIER,
        GEAR_GEOMETRY,
        MESH_EFFICIENCY,
        BASIC_EFFICIENCY,
    ],
};

static RAVIGNEAUX: Table = Table {
    doc: "Short planets on the small sun, long planets on the large sun and the ring, short and long in mesh. One of small_sun, large_sun and ring may be absent.",
    keys: &[
        NAME,
        TYPE,
        may("small_sun", Kind::Table(&CENTRAL), "Meshes with the short planets."),
        may("large_sun", Kind::Table(&CENTRAL), "Meshes with the long planets."),
        may("ring", Kind::Table(&CENTRAL), "Meshes with the long planets."),
        may("short_planet", Kind::Table(&PLANET), "Short planets."),
        may("long_planet", Kind::Table(&PLANET), "Long planets."),
        CARRIER,
        GEAR_GEOMETRY,
        MESH_EFFICIENCY,
        BASIC_EFFICIENCY,
    ],
};

static BEVEL: Table = Table {
    doc: "Bevel planets between side gears.",
    keys: &[
        NAME,
        TYPE,
        must("sides", Kind::Tables(&SIDE, 0), "Side gears."),
        may("planet", Kind::Table(&PLANET), "The planets."),
        CARRIER,
        MESH_EFFICIENCY,
        BASIC_EFFICIENCY,
    ],
};

static SHIFT_ELEMENT: Table = Table {
    doc: "A clutch, brake or one-way clutch.",
    keys: &[
        must("name", Kind::Text, "Its letter in the shift table."),
        must("kind", Kind::Choice(&["clutch", "brake", "one-way"]), "What it is."),
        must(
            "members",
            Kind::Names,
            "The two members a clutch joins; the one a brake holds; one (against the frame) or two for a one-way clutch.",
        ),
        may(
            "blocks",
            Kind::Choice(&["backward", "forward"]),
            "For a one-way clutch: the direction of the first member relative to the second that it prevents. Default: backward.",
        ),
        may(
            "capacity",
            Kind::Quantity(Dimension::TORQUE),
            "Torque that it transmits when fully engaged and sliding, in motion. Default: unlimited.",
        ),
        may(
            "friction",
            Kind::NumberOrPoints(Dimension::ANGULAR_SPEED),
            "Coefficient of friction, or points of it over slip, with `normal_force` and `effective_radius`. With `capacity`: a factor on it. Default: 1.",
        ),
        may("normal_force", Kind::Quantity(Dimension::FORCE), "Force on the friction surfaces when fully engaged."),
        may(
            "effective_radius",
            Kind::Quantity(Dimension::LENGTH),
            "Mean radius times the number of friction surfaces.",
        ),
        may(
            "peak",
            Kind::Number,
            "Torque at which it breaks away over that at which it slides; at least 1. Default: 1.",
        ),
    ],
};

static STATE: Table = Table {
    doc: "A row of the shift table.",
    keys: &[
        must("name", Kind::Text, "The gear: 1, 2, R, …"),
        must("engaged", Kind::Names, "The shift elements that are closed."),
        may("input", Kind::Name, "Where power enters in this state."),
        may("output", Kind::Name, "Where power leaves in this state."),
    ],
};

static OPERATION: Table = Table {
    doc: "An operating point. As many speeds as the train has degrees of freedom; a torque or power on every terminal but as many as that.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        may("state", Kind::Name, "The state of the shift table it runs in. Default: as drawn."),
        may(
            "speeds",
            Kind::Quantities(Dimension::ANGULAR_SPEED),
            "Prescribed speeds, positive in one axis direction for the whole train.",
        ),
        may("fixed", Kind::Names, "Members held at rest from outside."),
        may("torques", Kind::Quantities(Dimension::TORQUE), "External torques ON terminals."),
        may("powers", Kind::Quantities(Dimension::POWER), "External powers INTO the train at terminals."),
        may(
            "temperature",
            Kind::Quantity(Dimension::TEMPERATURE),
            "Oil temperature in this operating point. Default: that of the oil.",
        ),
    ],
};

static STUDY: Table = Table {
    doc: "A sweep over many operating points.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must(
            "over",
            Kind::Names,
            "Axes, QUANTITY=VALUES: \"input.speed=500 rpm..12000 rpm:100\", \"state=all\", \"P1.planet.count=3,4,6\".",
        ),
        may("operation", Kind::Name, "The operation from which it starts. Default: the first."),
        may("state", Kind::Name, "The state of the shift table. Default: that of the operation."),
        may(
            "hold",
            Kind::Choice(&["as-given", "torque", "power", "output"]),
            "What stays the same: the loads as given (the default), their torques, their powers, or the torque at the output.",
        ),
        may("columns", Kind::Names, "More columns: members, meshes, elements, sources, all, or single ones."),
    ],
};

static LOSS_ROW: Table = Table {
    doc: "Losses of a mesh at one speed.",
    keys: &[
        must("speed", Kind::Quantity(Dimension::ANGULAR_SPEED), "Amount of the first gear's speed on the carrier."),
        must("forward", Kind::Number, "Efficiency when the first gear drives."),
        must("backward", Kind::Number, "Efficiency when the second gear drives."),
        may(
            "forward_torque",
            Kind::Quantity(Dimension::TORQUE),
            "Bearing torque at the first gear when it drives. Default: 0 N m.",
        ),
        may(
            "backward_torque",
            Kind::Quantity(Dimension::TORQUE),
            "Bearing torque at the first gear when the second drives. Default: 0 N m.",
        ),
    ],
};

const SPEED: Measure = Some(Dimension::ANGULAR_SPEED);
const TORQUE: Measure = Some(Dimension::TORQUE);

static DRAG: Table = Table {
    doc: "Friction between two members that does not depend on tooth loads; at a planet of a set, at every planet. It needs `coulomb`, `viscous` or `table`.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must("members", Kind::Names, "The two members, or one that turns against the frame."),
        may("coulomb", Kind::Quantity(Dimension::TORQUE), "Torque at any speed; holds at rest."),
        may("viscous", Kind::Quantity(Dimension::VISCOUS), "Torque over relative speed."),
        may("table", Kind::Points([SPEED, TORQUE]), "Torque over the amount of relative speed, instead of `coulomb`."),
        may(
            "peak",
            Kind::Number,
            "Torque at which it breaks away over that at which it slides; at least 1. Default: 1.",
        ),
    ],
};

static SHAFT: Table = Table {
    doc: "An elastic shaft. It needs a stiffness or a damping.",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        must("members", Kind::Names, "The two members it joins, or one that it ties to the frame."),
        may("stiffness", Kind::Quantity(Dimension::STIFFNESS), "Torque over twist."),
        may("damping", Kind::Quantity(Dimension::VISCOUS), "Torque over the rate of twist."),
        may("backlash", Kind::Quantity(Dimension::ANGLE), "Whole backlash. Default: none."),
        may(
            "contact",
            Kind::Choice(&["soft", "hard"]),
            "At the ends of the backlash: `soft` damping never exceeds the spring and never pulls; with `hard` the torque may jump. Default: soft.",
        ),
    ],
};

static SCENARIO: Table = Table {
    doc: "A motion to simulate, from `start` for a `duration` (or to `end`).",
    keys: &[
        must("name", Kind::Text, "What it is called."),
        may("start", Kind::Quantity(Dimension::TIME), "When it begins. Default: 0 s."),
        may("duration", Kind::Quantity(Dimension::TIME), "How long it takes."),
        may("end", Kind::Quantity(Dimension::TIME), "When it ends, instead of `duration`."),
        may("samples", Kind::Samples, "Rows of output, evenly spaced in time. Default: 500."),
        may(
            "initial_speeds",
            Kind::Quantities(Dimension::ANGULAR_SPEED),
            "Speeds at the start; those that the gears settle follow, what is left is at rest.",
        ),
        may("initial_twists", Kind::Quantities(Dimension::ANGLE), "Twist of shafts at the start. Default: none."),
        may("fixed", Kind::Names, "Members held at rest from outside."),
        may("state", Kind::Name, "State of the shift table whose elements are engaged. Default: none are."),
        may("gears", Kind::Schedule, "Times and states, instead of `state`: [ [\"0 s\", \"1\"], [\"2 s\", \"2\"] ]."),
        may(
            "shift_time",
            Kind::Quantity(Dimension::TIME),
            "How long elements take to engage and to open when the gear changes. Default: 0 s.",
        ),
        may("source", Kind::Tables(&SOURCE, 0), "What acts on members from outside."),
        may("engagement", Kind::Tables(&ENGAGEMENT, 0), "Engagement of single shift elements over time."),
    ],
};

static ENGAGEMENT: Table = Table {
    doc: "How far a shift element is engaged over time; instead of what `state` or `gears` say of it.",
    keys: &[
        must("element", Kind::Name, "The shift element."),
        must("value", Kind::Signal(&NUMBER_SIGNAL), "From 0, open, to 1, fully engaged."),
    ],
};

/// The keys of a source of which it has exactly one.
pub(super) const SOURCE_KINDS: &[&str] = &["torque", "speed", "controller", "linear", "quadratic", "vehicle", "motor"];

static SOURCE: Table = Table {
    doc: "What acts on a member from outside: exactly one of torque, speed, controller, linear, quadratic, vehicle, motor.",
    keys: &[
        may("name", Kind::Text, "What it is called. Default: after what it is, `torque on sun`."),
        must("member", Kind::Name, "The member it acts on."),
        may("torque", Kind::Signal(&TORQUE_SIGNAL), "An external torque on the member."),
        may("speed", Kind::Signal(&SPEED_SIGNAL), "A prescribed speed; its torque is a result."),
        may("controller", Kind::Table(&CONTROLLER), "A torque that seeks a speed."),
        may("linear", Kind::Table(&LINEAR), "torque - slope (w - about)."),
        may("quadratic", Kind::Table(&QUADRATIC), "torque - factor (w - about)^2, against the direction of w - about."),
        may("vehicle", Kind::Table(&VEHICLE), "A vehicle on its wheels."),
        may("motor", Kind::Table(&MOTOR), "A motor with its full-load curve and a throttle."),
    ],
};

static CONTROLLER: Table = Table {
    doc: "A speed controller: feed_forward + proportional e + integral of e + derivative of e, where e = setpoint - w.",
    keys: &[
        must("setpoint", Kind::Signal(&SPEED_SIGNAL), "The speed wanted."),
        may("feed_forward", Kind::Signal(&TORQUE_SIGNAL), "Torque without any error. Default: 0 N m."),
        may("proportional", Kind::Quantity(Dimension::VISCOUS), "Torque over error. Default: none."),
        may("integral", Kind::Quantity(Dimension::STIFFNESS), "Torque over the integral of the error. Default: none."),
        may(
            "derivative",
            Kind::Quantity(Dimension::TORQUE_PER_ACCELERATION),
            "Torque over the rate of the error; acts as an added inertia. Default: none.",
        ),
    ],
};

static LINEAR: Table = Table {
    doc: "A torque that falls in a straight line with speed.",
    keys: &[
        may("torque", Kind::Quantity(Dimension::TORQUE), "Torque at the speed `about`. Default: 0 N m."),
        may("about", Kind::Quantity(Dimension::ANGULAR_SPEED), "Default: 0 rad/s."),
        may("slope", Kind::Quantity(Dimension::VISCOUS), "Fall of the torque over speed. Default: none."),
    ],
};

static QUADRATIC: Table = Table {
    doc: "A torque that falls with the square of speed: fans, air.",
    keys: &[
        may("torque", Kind::Quantity(Dimension::TORQUE), "Torque at the speed `about`. Default: 0 N m."),
        may("about", Kind::Quantity(Dimension::ANGULAR_SPEED), "Default: 0 rad/s."),
        may(
            "factor",
            Kind::Quantity(Dimension::TORQUE_PER_SPEED_SQUARED),
            "Fall of the torque over the square of speed. Default: none.",
        ),
        may("even", Kind::Flag, "true: the torque does not follow the direction of rotation."),
    ],
};

static VEHICLE: Table = Table {
    doc: "A vehicle on its wheels: mass, rolling resistance, air and slope.",
    keys: &[
        must("mass", Kind::Quantity(Dimension::MASS), "Mass of the vehicle."),
        must("wheel_radius", Kind::Quantity(Dimension::LENGTH), "Rolling radius of the wheels."),
        may("final_drive", Kind::Number, "Turns of the member to one turn of the wheels. Default: 1."),
        may("rolling", Kind::Number, "Rolling resistance coefficient; holds the vehicle at rest. Default: 0."),
        may("drag_area", Kind::Quantity(Dimension::AREA), "Drag coefficient times frontal area. Default: 0 m^2."),
        may("air_density", Kind::Quantity(Dimension::DENSITY), "Default: 1.2 kg/m^3."),
        may("grade", Kind::Signal(&NUMBER_SIGNAL), "Slope of the road, rise over run. Default: 0."),
    ],
};

static MOTOR: Table = Table {
    doc: "A motor: between the torque it drags with and its full-load torque.",
    keys: &[
        must("full_load", Kind::Points([SPEED, TORQUE]), "Torque over speed at full throttle."),
        may(
            "closed",
            Kind::Points([SPEED, TORQUE]),
            "Torque over speed at closed throttle, negative for drag. Default: 0 N m.",
        ),
        may("throttle", Kind::Signal(&NUMBER_SIGNAL), "From 0, closed, to 1, full load. Default: 1."),
    ],
};

const SIGNAL_TYPE: Key = must("type", Kind::Text, "How the value changes over time.");
const HOLD: Key = may("hold", Kind::Flag, "true: level from each point to the next, instead of straight lines.");
const AT: Key = may("at", Kind::Quantity(Dimension::TIME), "When. Default: 0 s.");

/// A kind of signal: its name, its measure and the kind of key that takes a value of it.
macro_rules! signal {
    ($signal:ident, $name:literal, $of:expr, $value:expr) => {
        pub(super) static $signal: SignalKind = SignalKind {
            name: $name,
            of: $of,
            types: &[
                (
                    "step",
                    &Table {
                        doc: "A jump.",
                        keys: &[
                            SIGNAL_TYPE,
                            may("offset", $value, "Value before. Default: 0."),
                            must("height", $value, "The jump."),
                            AT,
                        ],
                    },
                ),
                (
                    "ramp",
                    &Table {
                        doc: "A straight rise.",
                        keys: &[
                            SIGNAL_TYPE,
                            may("offset", $value, "Value before. Default: 0."),
                            must("height", $value, "The rise."),
                            AT,
                            must("duration", Kind::Quantity(Dimension::TIME), "How long it takes."),
                        ],
                    },
                ),
                (
                    "sine",
                    &Table {
                        doc: "offset + amplitude exp(-decay (t - at)) sin(2 pi frequency (t - at) + phase); before `at` the offset.",
                        keys: &[
                            SIGNAL_TYPE,
                            may("offset", $value, "Mean. Default: 0."),
                            must("amplitude", $value, "Amplitude."),
                            must("frequency", Kind::Quantity(Dimension::FREQUENCY), "Frequency, \"2 Hz\"."),
                            may("phase", Kind::Quantity(Dimension::ANGLE), "Default: 0 deg."),
                            AT,
                            may("decay", Kind::Quantity(Dimension::FREQUENCY), "How fast it fades, \"0.5 1/s\". Default: not."),
                        ],
                    },
                ),
                (
                    "pulse",
                    &Table {
                        doc: "A value that comes and goes.",
                        keys: &[
                            SIGNAL_TYPE,
                            may("offset", $value, "Value between pulses. Default: 0."),
                            must("amplitude", $value, "Height of a pulse."),
                            must("period", Kind::Quantity(Dimension::TIME), "From one pulse to the next."),
                            may("width", Kind::Number, "Part of the period that a pulse takes, 0 to 1. Default: 0.5."),
                            AT,
                        ],
                    },
                ),
                (
                    "table",
                    &Table {
                        doc: "Through points in time; level before the first and after the last. Two points of one time are a jump.",
                        keys: &[
                            SIGNAL_TYPE,
                            must("points", Kind::Points([Some(Dimension::TIME), $of]), "Times and values."),
                            HOLD,
                        ],
                    },
                ),
                (
                    "csv",
                    &Table {
                        doc: "Through the points of a CSV file: a header row, commas, values in SI units.",
                        keys: &[
                            SIGNAL_TYPE,
                            must("file", Kind::Text, "The file, seen from the train file."),
                            must("time", Kind::Text, "Name of the column with the times, s."),
                            must("value", Kind::Text, "Name of the column with the values, SI."),
                            HOLD,
                        ],
                    },
                ),
                (
                    "expression",
                    &Table {
                        doc: "A formula of the time t and of speeds w_member in rad/s; its value is in SI units.",
                        keys: &[SIGNAL_TYPE, must("formula", Kind::Text, "Such as \"60 + 200*sin(4*PI*t) - 3*w_sun\".")],
                    },
                ),
                (
                    "product",
                    &Table {
                        doc: "The product of two signals.",
                        keys: &[
                            SIGNAL_TYPE,
                            must("of", Kind::Product(&$signal), "A signal of this kind, and one of plain numbers."),
                        ],
                    },
                ),
            ],
        };
    };
}

signal!(TORQUE_SIGNAL, "torque_signal", TORQUE, Kind::Quantity(Dimension::TORQUE));
signal!(SPEED_SIGNAL, "speed_signal", SPEED, Kind::Quantity(Dimension::ANGULAR_SPEED));
signal!(NUMBER_SIGNAL, "number_signal", None, Kind::Number);
