//! A planetary set or a pair of gears seen along its axis: true teeth, in mesh.

pub mod draw;
pub mod dxf;
mod layout;
mod nominal;
mod profile;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::geometry::Pair;
use willis::train::{Gear, MemberKind, Train};

use crate::kind::{self, Ask, Kind};
use profile::Profile;

pub(crate) const KIND: Kind<Front> = Kind {
    title: "Teeth in mesh",
    takes: &[Ask::Part, Ask::Nominal, Ask::Animated],
    effort: kind::of_file,
    applies: None,
    make: |s, r| front(s.train(), r.part.as_deref(), r.nominal),
    steps: None,
    draw: draw::draw_on,
};

/// The transverse section of a set, or of a pair of gears.
///
/// Lengths are in mm, angles in rad, counterclockwise. The axis of the carrier is the origin, the
/// axis of the first planet stands above it, on the positive y axis. The carrier is at rest: speeds
/// are relative to it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Front {
    /// The train.
    pub title: String,
    /// The set; of a single pair, the mesh.
    pub set: String,
    /// The type of the set, as in the file; `pair` for a single mesh.
    pub kind: String,
    /// The member that carries the axes.
    pub carrier: String,
    /// Whether the teeth are standard ones, because the train has none.
    pub assumed: bool,
    /// What has to be said beside the picture, in sentences.
    pub notes: Vec<String>,
    /// Every wheel.
    pub wheels: Vec<FrontWheel>,
    /// Every pair of wheels in mesh.
    pub meshes: Vec<FrontMesh>,
    /// The planes that lie one behind the other: in one plane no wheel covers another.
    pub planes: Vec<FrontPlane>,
    /// The planets around the axis.
    pub spacing: FrontSpacing,
}

/// A wheel: one central gear, or one planet of which there are several alike.
///
/// # Formula
/// ```text
/// half thickness at radius r, as an angle   ψ(r) = η − inv α(r),   cos α(r) = r_b/r
/// η = (π/2 + 2 x tan α_n)/z + inv α_t
/// ```
/// On a ring that is the half width of the space.
///
/// # Source
/// `[iso21771]`, tooth thickness half angle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontWheel {
    /// The member it sits on.
    pub name: String,
    /// Number of its colour: the place of that member in the train; absent for the frame.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub colour: Option<usize>,
    /// Tooth count `z`.
    pub teeth: u32,
    /// Whether it is a ring gear.
    pub internal: bool,
    /// Whether it is a planet.
    pub planet: bool,
    /// Normal module `m_n`, mm.
    pub module_mm: f64,
    /// Profile shift coefficient `x`, positive outward.
    pub shift: f64,
    /// Reference radius `r`, mm.
    pub reference_radius_mm: f64,
    /// Base radius `r_b`, mm.
    pub base_radius_mm: f64,
    /// Tip radius `r_a`, mm.
    pub tip_radius_mm: f64,
    /// Root radius `r_f`, mm.
    pub root_radius_mm: f64,
    /// Half angle `η` of the tooth (of the space, on a ring) at the base circle, rad.
    pub base_half_angle: f64,
    /// One tooth and half a space at each side, mm, around the wheel's axis, counterclockwise; the
    /// tooth's middle lies on the positive x axis.
    pub outline_mm: Vec<[f64; 2]>,
    /// Turns for one turn of the first central gear, relative to the carrier; zero where nothing can turn.
    pub turns: f64,
    /// The same exactly, `-17/22`.
    pub ratio: String,
    /// Where its copies stand, the one of the first planet first.
    pub bodies: Vec<FrontBody>,
}

/// A wheel in its place.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontBody {
    /// Its axis, mm.
    pub centre_mm: [f64; 2],
    /// Angle of the middle of a tooth, rad.
    pub phase: f64,
}

/// A pair of wheels, at the first planet. The first wheel drives.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontMesh {
    /// Its name.
    pub name: String,
    /// Driving and driven wheel.
    pub wheels: [usize; 2],
    /// Centre distance `a`, mm.
    pub centre_distance_mm: f64,
    /// Operating pressure angle in the transverse section `α_wt`, rad.
    pub pressure_angle: f64,
    /// Circumferential backlash `j_t` at the operating circles, mm.
    pub backlash_mm: f64,
    /// Transverse contact ratio `ε_α`.
    pub contact_ratio: f64,
    /// Operating pitch radii `r_w`, mm.
    pub pitch_radii_mm: [f64; 2],
    /// Pitch point C, mm.
    pub pitch_point_mm: [f64; 2],
    /// Unit vector along the line of action, in the sense in which contacts run.
    pub direction: [f64; 2],
    /// The points A, B, C, D, E of the path of contact: distances from C along the line of action,
    /// mm, contacts running from A to E.
    pub path_mm: [f64; 5],
    /// Where the line of action touches the base circles, driving wheel first: distances from C, mm.
    pub base_points_mm: [f64; 2],
    /// Transverse base pitch `p_bt`, mm: the distance of two contacts.
    pub base_pitch_mm: f64,
    /// The first contact after A as the wheels stand, mm from C.
    pub contact_mm: f64,
}

/// Wheels that lie in one plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontPlane {
    /// The wheels.
    pub wheels: Vec<usize>,
    /// Their meshes.
    pub meshes: Vec<usize>,
}

/// How the planets stand around the axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FrontSpacing {
    /// How many there are drawn.
    pub planets: u32,
    /// Whether the train says how many.
    pub given: bool,
    /// Angles from the first one, rad.
    pub angles: Vec<f64>,
    /// Whether all angles between neighbours are the same.
    pub equal: bool,
    /// Every angle at which a planet fits is a multiple of it, rad; absent when all do.
    pub least_angle: Option<f64>,
    /// Smallest distance of the tips of planets that do not mesh, mm; absent with one planet.
    pub clearance_mm: Option<f64>,
}

impl FrontMesh {
    /// The point at the distance s, mm, from C along the line of action.
    pub fn point(&self, s: f64) -> [f64; 2] {
        [self.pitch_point_mm[0] + s * self.direction[0], self.pitch_point_mm[1] + s * self.direction[1]]
    }
}

impl FrontWheel {
    /// Half angle of a tooth (of a space, on a ring) at a radius, mm, not below the base radius.
    ///
    /// # Example
    /// ```
    /// # use willis_figure::front;
    /// # use willis::train::{GeometrySpec, SetSpec, Train};
    /// # use willis::units::Length;
    /// let train = Train::builder("stage")
    ///     .members(["s", "c"])
    ///     .set(SetSpec::simple("P1", ("s", 17), ("frame", 61), "c").planet(22, 3).geometry(GeometrySpec::new(
    ///         Length::mm(4.0),
    ///         Length::mm(50.0),
    ///     )))
    ///     .build()?;
    /// let sun = &front(&train, None, false)?.wheels[0];
    /// // Unshifted: a quarter of the pitch, π m/4, over the reference radius.
    /// let quarter = std::f64::consts::PI * 4.0 / 4.0 / sun.reference_radius_mm;
    /// assert!((sun.half_angle(sun.reference_radius_mm) - quarter).abs() < 1e-12);
    /// # Ok::<(), willis::Diagnostics>(())
    /// ```
    pub fn half_angle(&self, radius_mm: f64) -> f64 {
        let cosine = (self.base_radius_mm / radius_mm).min(1.0);
        self.base_half_angle - willis::geometry::involute(cosine.acos())
    }

    /// Outer radius of what is drawn, mm: the tip, on a ring the rim outside its teeth.
    pub fn outer_radius_mm(&self) -> f64 {
        if self.internal { self.root_radius_mm + 2.5 * self.module_mm } else { self.tip_radius_mm }
    }
}

/// Teeth beyond which a picture shows none.
const MOST_TEETH: u32 = 2000;

/// A gear of a mesh that is to be drawn.
#[derive(Clone, Copy)]
struct Wheel {
    member: usize,
    teeth: u32,
    internal: bool,
    planet: bool,
}

/// A mesh that is to be drawn.
struct Link {
    name: String,
    wheels: [Wheel; 2],
}

/// A set, or one pair of gears, seen along its axis. Without a name: the first that can be drawn.
///
/// The teeth are those of the train. A set that gives none is drawn with standard teeth where
/// `nominal` allows it: module 1 mm, 20°, shifts that bring the planets on one circle.
///
/// # Errors
/// An unknown set, one without teeth, a bevel set, and teeth that cannot be put together.
///
/// # Example
/// ```
/// use willis_figure::front;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// assert!(front(&train, None, false).is_err());
/// let view = front(&train, None, true)?;
/// assert!(view.assumed && view.spacing.equal);
/// assert_eq!(view.wheels.iter().map(|w| w.bodies.len()).collect::<Vec<_>>(), [1, 4, 1]);
/// assert_eq!(view.wheels[1].ratio, "-3/2");
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn front(train: &Train, set: Option<&str>, nominal: bool) -> Result<Front, Diagnostics> {
    let subjects = subjects(train);
    let chosen = match set {
        Some(name) => match subjects.iter().find(|s| s.name == name) {
            Some(found) => found,
            None => {
                let known = subjects.iter().map(|s| s.name.as_str());
                let d = Diagnostic::new(Code::UnknownName, "", format!("the train has no set or pair `{name}`"));
                let list = known.clone().collect::<Vec<_>>().join(", ");
                return Err([d.suggest(name, known).hint(format!("it has: {list}"))].into_iter().collect());
            }
        },
        None => {
            let with_teeth = |s: &&Subject| s.meshes.iter().all(|&m| train.meshes()[m].teeth.is_some());
            let flat = |s: &&Subject| s.meshes.iter().all(|&m| !train.meshes()[m].bevel);
            let first = subjects.iter().find(with_teeth).or_else(|| subjects.iter().find(flat));
            match first.or(subjects.first()) {
                Some(first) => first,
                None => return Err(unfit("no front view: the train has no gears", "add a set, or a mesh")),
            }
        }
    };
    let name = &chosen.name;
    if chosen.meshes.iter().any(|&m| train.meshes()[m].bevel) {
        let text = format!("no front view of `{name}`: it is a bevel set, whose axes intersect");
        return Err(unfit(text, "sets and pairs of cylindrical gears have a front view"));
    }
    let bare: Vec<&str> = chosen
        .meshes
        .iter()
        .filter(|&&m| train.meshes()[m].teeth.is_none())
        .map(|&m| train.meshes()[m].name.as_str())
        .collect();
    let assumed = !bare.is_empty();
    if assumed && (bare.len() < chosen.meshes.len() || !nominal) {
        let (what, place) = match chosen.set {
            true => ("the set", "its `geometry = { module = \"2 mm\", width = \"20 mm\" }`"),
            false => ("the mesh", "its `geometry = { module = \"2 mm\", width = \"20 mm\" }`"),
        };
        let text = format!("no front view of `{name}`: the teeth of {} are not given", bare.join(", "));
        let hint = match bare.len() < chosen.meshes.len() {
            true => format!("give {what} {place} for every mesh"),
            false => format!("give {what} {place}, or draw standard teeth of module 1 mm (`nominal`)"),
        };
        return Err(unfit(text, hint));
    }
    let mut notes = Vec::new();
    let mut links = Vec::new();
    for &m in &chosen.meshes {
        let mesh = &train.meshes()[m];
        let wheel = |g: &Gear, central: bool| {
            let teeth = g.teeth.to_f64();
            let whole = if g.teeth.is_integer() { teeth } else { teeth.ceil() };
            Wheel {
                member: g.member.index(),
                teeth: whole as u32,
                internal: g.internal,
                planet: !central && (!chosen.set || train.members()[g.member.index()].kind == MemberKind::Planet),
            }
        };
        for g in &mesh.gears {
            if !g.teeth.is_integer() {
                let member = train.member_name(g.member);
                if !assumed {
                    let text = format!("no front view of `{name}`: {member} has {} teeth", g.teeth.to_fraction());
                    return Err(unfit(text, "give the tooth number of the planet"));
                }
                let note = format!("Tooth number of {member} not known, {} drawn.", g.teeth.to_f64().ceil());
                if !notes.contains(&note) {
                    notes.push(note);
                }
            } else if g.teeth.to_f64() > f64::from(MOST_TEETH) {
                let member = train.member_name(g.member);
                let text = format!("no front view of `{name}`: {member} has more than {MOST_TEETH} teeth");
                return Err(unfit(text, "so many cannot be seen"));
            }
        }
        // Of a single pair the ring stands in the middle, else the first gear.
        let ring = mesh.gears.iter().position(|g| g.internal).unwrap_or(0);
        let wheels = [0, 1].map(|k| wheel(&mesh.gears[k], !chosen.set && k == ring));
        links.push(Link { name: mesh.name.clone(), wheels });
    }
    let pairs: Vec<Pair> = if assumed {
        match nominal::pairs(&links) {
            Ok((pairs, more)) => {
                notes.extend(more);
                pairs
            }
            Err(why) => {
                let text = format!("no front view of `{name}` with standard teeth: {why}");
                return Err(unfit(text, "give its teeth: `geometry = { module = … }` and profile shifts"));
            }
        }
    } else {
        chosen.meshes.iter().filter_map(|&m| Some(train.meshes()[m].teeth.as_ref()?.pair.clone())).collect()
    };
    let mesh = &train.meshes()[chosen.meshes[0]];
    let count = match (chosen.set, chosen.planets) {
        (true, planets) => planets,
        (false, _) => Some(1),
    };
    if !chosen.set && mesh.count > 1 {
        notes.push(format!("One of {} pairs in parallel.", mesh.count));
    }
    let built = layout::build(&links, pairs, count).map_err(|why| {
        unfit(format!("no front view of `{name}`: {why}"), "check tooth numbers, shifts and centre distances")
    })?;
    notes.extend(built.notes);
    let wheels = built.wheels.into_iter().map(|w| {
        let p: &Profile = &w.profile;
        FrontWheel {
            name: train.members()[w.member].name.clone(),
            colour: w.member.checked_sub(1),
            teeth: p.teeth,
            internal: p.internal,
            planet: w.planet,
            module_mm: p.module,
            shift: p.shift,
            reference_radius_mm: p.reference,
            base_radius_mm: p.base,
            tip_radius_mm: p.tip,
            root_radius_mm: p.root,
            base_half_angle: p.half_angle,
            outline_mm: p.outline(),
            turns: w.turns.0 as f64 / w.turns.1 as f64,
            ratio: if w.turns.1 == 1 { w.turns.0.to_string() } else { format!("{}/{}", w.turns.0, w.turns.1) },
            bodies: w.bodies,
        }
    });
    Ok(Front {
        title: train.name().to_owned(),
        set: name.clone(),
        kind: chosen.kind.to_owned(),
        carrier: train.member_name(mesh.carrier).to_owned(),
        assumed,
        notes,
        wheels: wheels.collect(),
        meshes: built.meshes,
        planes: built.planes,
        spacing: built.spacing,
    })
}

/// What can be drawn: a set with its meshes, or one mesh of no set.
struct Subject {
    name: String,
    kind: &'static str,
    set: bool,
    planets: Option<u32>,
    meshes: Vec<usize>,
}

fn subjects(train: &Train) -> Vec<Subject> {
    let mut all: Vec<Subject> = Vec::new();
    for (k, s) in train.sets().iter().enumerate() {
        let meshes = (0..train.meshes().len()).filter(|&m| train.meshes()[m].set == Some(k)).collect();
        all.push(Subject { name: s.name.clone(), kind: s.kind, set: true, planets: s.planets, meshes });
    }
    for (m, mesh) in train.meshes().iter().enumerate().filter(|(_, m)| m.set.is_none()) {
        all.push(Subject { name: mesh.name.clone(), kind: "pair", set: false, planets: None, meshes: vec![m] });
    }
    all.retain(|s| !s.meshes.is_empty());
    all
}

fn unfit(text: impl Into<String>, hint: impl Into<String>) -> Diagnostics {
    [Diagnostic::new(Code::Unfit, "", text).hint(hint)].into_iter().collect()
}
