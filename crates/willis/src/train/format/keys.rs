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
    Flag,
    Choice(&'static [&'static str]),
    /// A number, or `{ forward, backward }`.
    Efficiency,
    /// A number, `{ forward, backward }`, or `{ external, internal }` with either of those.
    SetEfficiency,
    /// Member name to quantity.
    Quantities(Dimension),
    Table(&'static Table),
    /// `[[key]]`, or a list of inline tables; with the least number of entries.
    Tables(&'static Table, usize),
    /// Like `Tables`, the table depending on the entry's `type` (the first is the default).
    Variants(&'static [(&'static str, &'static Table)]),
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
    ],
};

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
    keys: &[
        must("member", Kind::Name, "The rotor it sits on."),
        must("teeth", Kind::Integer, "Tooth count."),
        may("internal", Kind::Flag, "true for a ring gear."),
    ],
};

static CENTRAL: Table = Table {
    doc: "A sun or ring gear.",
    keys: &[
        must("member", Kind::Name, "The rotor it sits on; `frame` for a gear that is always held."),
        must("teeth", Kind::Integer, "Tooth count."),
    ],
};

static STEP: Table = Table {
    doc: "A sun or ring gear and the step of the planet it meshes with.",
    keys: &[
        must("member", Kind::Name, "The rotor it sits on; `frame` for a gear that is always held."),
        must("teeth", Kind::Integer, "Tooth count."),
        must("planet_teeth", Kind::Integer, "Teeth of the step of the planet that it meshes with."),
    ],
};

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
    keys: &[
        may(
            "teeth",
            Kind::Integer,
            "Tooth count. Without it planet speeds are those of the nominal planet (z_ring - z_sun)/2.",
        ),
        may("count", Kind::Integer, "Number of planets; enables the assembly checks."),
    ],
};

static STEPPED_PLANET: Table = Table {
    doc: "The stepped planets of a set; their teeth stand with the gears they mesh with.",
    keys: &[may("count", Kind::Integer, "Number of planets; enables the assembly checks.")],
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
    ],
};
