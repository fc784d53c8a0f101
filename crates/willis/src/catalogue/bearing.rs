//! Rolling bearings: type, series, envelope and the constants of their friction laws.
//!
//! ```
//! use willis::catalogue::bearing;
//!
//! let bearing = bearing::find("NU 1022 ECP").unwrap();
//! assert_eq!((bearing.bore, bearing.outside_diameter, bearing.width), (0.110, 0.170, 0.028));
//! assert!(bearing.check().is_empty());
//! ```

use std::fmt;
use std::sync::OnceLock;

use serde::Deserialize;

use super::Trust;
use crate::real::Real;

/// Type of a rolling bearing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Kind {
    /// Deep groove ball bearing.
    DeepGrooveBall,
    /// Angular contact ball bearing, one row.
    AngularContactBall,
    /// Angular contact ball bearing, two rows.
    DoubleRowAngularContactBall,
    /// Four-point contact ball bearing.
    FourPointContactBall,
    /// Self-aligning ball bearing.
    SelfAligningBall,
    /// Cylindrical roller bearing with cage.
    CylindricalRoller,
    /// Cylindrical roller bearing, full complement.
    FullComplementCylindricalRoller,
    /// Needle roller bearing or cage.
    NeedleRoller,
    /// Tapered roller bearing.
    TaperedRoller,
    /// Spherical roller bearing.
    SphericalRoller,
    /// Toroidal roller bearing (CARB) with cage.
    ToroidalRoller,
    /// Axial (thrust) ball bearing.
    AxialBall,
    /// Axial (thrust) cylindrical roller bearing.
    AxialCylindricalRoller,
    /// Plain bearing: no rolling elements.
    Plain,
}

impl Kind {
    /// Whether its rolling elements are balls.
    pub fn is_ball(self) -> bool {
        matches!(
            self,
            Self::DeepGrooveBall
                | Self::AngularContactBall
                | Self::DoubleRowAngularContactBall
                | Self::FourPointContactBall
                | Self::SelfAligningBall
                | Self::AxialBall
        )
    }

    /// The kind of that name in a train file.
    pub fn named(name: &str) -> Option<Self> {
        Self::NAMES.iter().find(|n| n.0 == name).map(|n| n.1)
    }

    /// Names in a train file.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("deep-groove-ball", Self::DeepGrooveBall),
        ("angular-contact-ball", Self::AngularContactBall),
        ("double-row-angular-contact-ball", Self::DoubleRowAngularContactBall),
        ("four-point-contact-ball", Self::FourPointContactBall),
        ("self-aligning-ball", Self::SelfAligningBall),
        ("cylindrical-roller", Self::CylindricalRoller),
        ("full-complement-cylindrical-roller", Self::FullComplementCylindricalRoller),
        ("needle-roller", Self::NeedleRoller),
        ("tapered-roller", Self::TaperedRoller),
        ("spherical-roller", Self::SphericalRoller),
        ("toroidal-roller", Self::ToroidalRoller),
        ("axial-ball", Self::AxialBall),
        ("axial-cylindrical-roller", Self::AxialCylindricalRoller),
        ("plain", Self::Plain),
    ];

    /// Rows of rolling elements.
    pub fn rows(self) -> u8 {
        match self {
            Self::DoubleRowAngularContactBall | Self::SelfAligningBall | Self::SphericalRoller => 2,
            _ => 1,
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::DeepGrooveBall => "deep groove ball bearing",
            Self::AngularContactBall => "angular contact ball bearing",
            Self::DoubleRowAngularContactBall => "two-row angular contact ball bearing",
            Self::FourPointContactBall => "four-point contact ball bearing",
            Self::SelfAligningBall => "self-aligning ball bearing",
            Self::CylindricalRoller => "cylindrical roller bearing",
            Self::FullComplementCylindricalRoller => "full complement cylindrical roller bearing",
            Self::NeedleRoller => "needle roller bearing",
            Self::TaperedRoller => "tapered roller bearing",
            Self::SphericalRoller => "spherical roller bearing",
            Self::ToroidalRoller => "toroidal roller bearing",
            Self::AxialBall => "axial ball bearing",
            Self::AxialCylindricalRoller => "axial cylindrical roller bearing",
            Self::Plain => "plain bearing",
        })
    }
}

/// Constants of the SKF model of friction for one kind and series, in the units of that model
/// (mm, N, r/min, mm²/s); unused places are 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkfConstants {
    /// `R1` to `R4` of the rolling torque.
    pub rolling: [f64; 4],
    /// `S1` to `S4` of the sliding torque.
    pub sliding: [f64; 4],
    /// `K_Z`
    pub k_z: f64,
    /// `K_L`; 0 for balls.
    pub k_l: f64,
    /// Drag loss factor: pairs of oil level over mean diameter and `V_M`, rising; ±10 %.
    pub drag: &'static [[f64; 2]],
    /// How far the constants of this kind were checked.
    pub trust: Trust,
}

/// Constants of Palmgren's torque.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmgrenConstants {
    /// `f0`, oil bath.
    pub f0: f64,
    /// `f1`
    pub f1: f64,
    /// Exponent `y` of `P0/C0`.
    pub exponent: f64,
}

/// Kind of a rubbing seal inside a bearing, as SKF designates it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SealKind {
    /// Low-friction contact seal of small deep groove ball bearings.
    Rsl,
    /// Contact seal of deep groove ball bearings to 52 mm.
    Rsh,
    /// Contact seal of ball bearings.
    Rs1,
    /// Contact seal of cylindrical roller bearings.
    Ls,
    /// Contact seal of spherical and toroidal roller bearings.
    Cs,
}

/// Rubbing seals inside a bearing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seal {
    /// Their kind.
    pub kind: SealKind,
    /// Lips that rub, 1 or 2.
    pub lips: u8,
    /// Diameter of the counterface `d_s`, m; estimated from the envelope when not known.
    pub diameter: Option<f64>,
}

/// A rolling bearing.
#[derive(Clone, Debug, PartialEq)]
pub struct Bearing {
    /// Designation, or what the user calls it.
    pub designation: String,
    /// Its type.
    pub kind: Kind,
    /// Dimension series and design letter, `10`, `3`, `322`, `222 E`, `72 B`; empty when not known.
    pub series: String,
    /// Bore, m.
    pub bore: f64,
    /// Outside diameter, m.
    pub outside_diameter: f64,
    /// Width, m; of a tapered bearing the overall width `T`, of an axial one its height.
    pub width: f64,
    /// Rows of rolling elements.
    pub rows: u8,
    /// Dynamic load rating `C`, N, where known.
    pub dynamic_rating: Option<f64>,
    /// Static load rating `C0`, N, where known.
    pub static_rating: Option<f64>,
    /// Limiting speed with oil, rad/s, where known: what cage and guidance stand.
    pub limiting_speed: Option<f64>,
    /// Axial factor `Y` of tapered and spherical rollers, where known.
    pub axial_factor: Option<f64>,
    /// Diameter of the rolling elements, m; estimated from the envelope when not known.
    pub element_diameter: Option<f64>,
    /// Rubbing seals.
    pub seal: Option<Seal>,
    /// Constants of the SKF model, where that kind and series has any.
    pub skf: Option<SkfConstants>,
    /// Constants of Palmgren's torque.
    pub palmgren: PalmgrenConstants,
    /// Where the dimensions come from.
    pub source: String,
    /// How far they were checked.
    pub trust: Trust,
}

impl Bearing {
    /// Whether it holds a shaft along its axis. A cylindrical roller bearing does by its flanges: its designation
    /// tells (NJ, NUP, NF, NCF and NJG do; NU, N and what is not known do not).
    pub fn takes_thrust(&self) -> bool {
        use Kind::{CylindricalRoller, FullComplementCylindricalRoller, NeedleRoller, ToroidalRoller};
        match self.kind {
            CylindricalRoller | FullComplementCylindricalRoller => {
                let name = self.designation.trim_start();
                ["NJ", "NUP", "NF", "NCF", "NNCF"].iter().any(|p| name.starts_with(p))
            }
            NeedleRoller | ToroidalRoller | Kind::Plain => false,
            _ => true,
        }
    }

    /// Whether it carries radial loads: all do but axial bearings.
    pub fn takes_radial_load(&self) -> bool {
        !matches!(self.kind, Kind::AxialBall | Kind::AxialCylindricalRoller)
    }
}

/// The numbers of a bearing that its friction laws read, copied out of a [`Bearing`] so that the
/// state of a law stays plain data. SI, as there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BearingData<R = f64> {
    /// Its type.
    pub kind: Kind,
    /// Bore, m.
    pub bore: R,
    /// Outside diameter, m.
    pub outside_diameter: R,
    /// Width, m.
    pub width: R,
    /// Rows of rolling elements.
    pub rows: u8,
    /// Static load rating `C0`, N.
    pub static_rating: Option<R>,
    /// Axial factor `Y`.
    pub axial_factor: Option<R>,
    /// Diameter of the rolling elements, m.
    pub element_diameter: R,
    /// Rubbing seals.
    pub seal: Option<Seal>,
    /// Constants of the SKF model.
    pub skf: Option<SkfConstants>,
    /// Constants of Palmgren's torque.
    pub palmgren: PalmgrenConstants,
}

impl<R: Real> BearingData<R> {
    /// Mean diameter `d_m = (d + D)/2`, m.
    pub fn mean_diameter(&self) -> R {
        (self.bore + self.outside_diameter) * 0.5
    }
}

impl BearingData {
    /// The same with another kind of numbers.
    pub fn lift<D: Real>(self) -> BearingData<D> {
        BearingData {
            kind: self.kind,
            bore: D::from(self.bore),
            outside_diameter: D::from(self.outside_diameter),
            width: D::from(self.width),
            rows: self.rows,
            static_rating: self.static_rating.map(D::from),
            axial_factor: self.axial_factor.map(D::from),
            element_diameter: D::from(self.element_diameter),
            seal: self.seal,
            skf: self.skf,
            palmgren: self.palmgren,
        }
    }
}

/// What does not fit in the data of a bearing. Lengths in m.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Mismatch {
    /// The outside diameter is not larger than the bore, or a length is not positive.
    NotABearing {
        /// Bore.
        bore: f64,
        /// Outside diameter.
        outside_diameter: f64,
        /// Width.
        width: f64,
    },
    /// The designation speaks of another bore.
    Bore {
        /// The one of the designation.
        designated: f64,
        /// The one given.
        given: f64,
    },
    /// The outside diameter is not that of the series at this bore.
    OutsideDiameter {
        /// Series, as given.
        series: String,
        /// The one of the series.
        expected: f64,
        /// The one given.
        given: f64,
    },
    /// The width is not that of the series at this bore.
    Width {
        /// Series, as given.
        series: String,
        /// The one of the series.
        expected: f64,
        /// The one given.
        given: f64,
    },
    /// Bore and outside diameter are those of another series of the same type.
    LooksLike {
        /// Designation of that bearing.
        designation: String,
        /// Its width.
        expected: f64,
        /// The width given.
        given: f64,
    },
    /// The whole envelope is that of a bearing of another type.
    LooksLikeOtherType {
        /// Designation of that bearing.
        designation: String,
        /// Its type.
        kind: Kind,
    },
    /// No constants of the SKF model are known for this type and series.
    NoConstants {
        /// Type.
        kind: Kind,
        /// Series, as given.
        series: String,
    },
}

impl Mismatch {
    /// Whether no such bearing can exist, so that nothing can be computed.
    pub fn is_impossible(&self) -> bool {
        matches!(self, Self::NotABearing { .. })
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mm = |x: &f64| (x * 1e6).round() / 1e3;
        match self {
            Self::NotABearing { bore, outside_diameter, width } => write!(
                f,
                "bore {} mm, outside diameter {} mm, width {} mm make no bearing",
                mm(bore),
                mm(outside_diameter),
                mm(width)
            ),
            Self::Bore { designated, given } => {
                write!(f, "the designation means a bore of {} mm, given are {} mm", mm(designated), mm(given))
            }
            Self::OutsideDiameter { series, expected, given } => write!(
                f,
                "series {series} has an outside diameter of {} mm at this bore, given are {} mm",
                mm(expected),
                mm(given)
            ),
            Self::Width { series, expected, given } => {
                write!(f, "series {series} is {} mm wide at this bore, given are {} mm", mm(expected), mm(given))
            }
            Self::LooksLike { designation, expected, given } => write!(
                f,
                "bore and outside diameter are those of {designation}, which is {} mm wide, given are {} mm",
                mm(expected),
                mm(given)
            ),
            Self::LooksLikeOtherType { designation, kind } => {
                write!(f, "the envelope is that of {designation}, a {kind}")
            }
            Self::NoConstants { kind, series } => {
                let series =
                    if series.is_empty() { "without a series".into() } else { format!("of series `{series}`") };
                write!(f, "no constants of the SKF model are known for a {kind} {series}: Palmgren's law stands in")
            }
        }
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-6
}

/// Series without its design letter.
fn plain(series: &str) -> &str {
    series.split(' ').next().unwrap_or_default()
}

impl Bearing {
    /// A bearing by type, series and envelope (m); constants of the friction laws are looked up.
    pub fn new(designation: &str, kind: Kind, series: &str, bore: f64, outside_diameter: f64, width: f64) -> Self {
        Self {
            designation: designation.to_owned(),
            kind,
            series: series.to_owned(),
            bore,
            outside_diameter,
            width,
            rows: kind.rows(),
            dynamic_rating: None,
            static_rating: None,
            limiting_speed: None,
            axial_factor: None,
            element_diameter: None,
            seal: None,
            skf: skf_constants(kind, series),
            palmgren: palmgren_constants(kind, series),
            source: "given".to_owned(),
            trust: Trust::Seen,
        }
    }

    /// The numbers that the friction laws read. Where the diameter of the rolling elements is not
    /// known, 0.3 (balls) or 0.25 (rollers) of D − d is taken.
    pub fn data(&self) -> BearingData {
        let share = if self.kind.is_ball() { 0.3 } else { 0.25 };
        BearingData {
            kind: self.kind,
            bore: self.bore,
            outside_diameter: self.outside_diameter,
            width: self.width,
            rows: self.rows,
            static_rating: self.static_rating,
            axial_factor: self.axial_factor,
            element_diameter: self.element_diameter.unwrap_or(share * (self.outside_diameter - self.bore)),
            seal: self.seal,
            skf: self.skf,
            palmgren: self.palmgren,
        }
    }

    /// What does not fit: the envelope against the designation and the series, and whether the
    /// friction laws have constants.
    ///
    /// ```
    /// use willis::catalogue::bearing::{Bearing, Kind};
    ///
    /// let bearing = Bearing::new("planet", Kind::CylindricalRoller, "23", 0.110, 0.170, 0.038);
    /// let said: Vec<_> = bearing.check().iter().map(|m| m.to_string()).collect();
    /// assert_eq!(said[0], "series 23 has an outside diameter of 240 mm at this bore, given are 170 mm");
    /// ```
    pub fn check(&self) -> Vec<Mismatch> {
        let (d, big_d, b) = (self.bore, self.outside_diameter, self.width);
        if !(d > 0.0 && big_d > d && b > 0.0) {
            return vec![Mismatch::NotABearing { bore: d, outside_diameter: big_d, width: b }];
        }
        let mut found = Vec::new();
        if let Some(designated) = parse(&self.designation).and_then(|p| p.bore)
            && !same(designated, d)
        {
            found.push(Mismatch::Bore { designated, given: d });
        }
        let series = plain(&self.series);
        let mut off = false;
        if let Some(row) = row(self.kind, series, d) {
            if !same(row.outside_diameter, big_d) {
                let series = self.series.clone();
                found.push(Mismatch::OutsideDiameter { series, expected: row.outside_diameter, given: big_d });
                off = true;
            }
            if !same(row.width, b) {
                found.push(Mismatch::Width { series: self.series.clone(), expected: row.width, given: b });
                off = true;
            }
        }
        if off {
            let ring = |r: &&Bearing| same(r.bore, d) && same(r.outside_diameter, big_d);
            for row in all().iter().filter(ring).filter(|r| r.series != series) {
                if row.kind == self.kind {
                    let designation = row.designation.clone();
                    found.push(Mismatch::LooksLike { designation, expected: row.width, given: b });
                } else if same(row.width, b) {
                    found.push(Mismatch::LooksLikeOtherType { designation: row.designation.clone(), kind: row.kind });
                }
            }
        }
        if self.skf.is_none() {
            found.push(Mismatch::NoConstants { kind: self.kind, series: self.series.clone() });
        }
        found
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Group {
    kind: Kind,
    series: Vec<String>,
    source: String,
    trust: Trust,
    #[serde(rename = "note")]
    _note: Option<String>,
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

#[derive(Deserialize)]
struct SkfFile {
    kind: Vec<SkfKind>,
    drag: Drag,
}

#[derive(Deserialize)]
struct SkfKind {
    kind: Kind,
    k_z: f64,
    #[serde(default)]
    k_l: f64,
    trust: Trust,
    rows: Vec<SkfRow>,
}

#[derive(Deserialize)]
struct SkfRow {
    series: Vec<String>,
    r: Vec<f64>,
    s: Vec<f64>,
}

#[derive(Deserialize)]
struct Drag {
    ball: Vec<[f64; 2]>,
    roller: Vec<[f64; 2]>,
}

#[derive(Deserialize)]
struct PalmgrenFile {
    rows: Vec<PalmgrenRow>,
}

#[derive(Deserialize)]
struct PalmgrenRow {
    kind: Kind,
    series: Vec<String>,
    f0: f64,
    f1: f64,
    y: f64,
}

fn skf_file() -> &'static SkfFile {
    static FILE: OnceLock<SkfFile> = OnceLock::new();
    FILE.get_or_init(|| {
        toml::from_str(include_str!("../../data/skf-friction-constants.toml"))
            .expect("data/skf-friction-constants.toml is read")
    })
}

fn four(values: &[f64]) -> [f64; 4] {
    std::array::from_fn(|k| values.get(k).copied().unwrap_or(0.0))
}

/// Constants of the SKF model by type and series; a design letter that has no constants of its
/// own is left away.
pub fn skf_constants(kind: Kind, series: &str) -> Option<SkfConstants> {
    let file = skf_file();
    let group = file.kind.iter().find(|k| k.kind == kind)?;
    let row = [series, plain(series), "*", "other"]
        .iter()
        .find_map(|wanted| group.rows.iter().find(|r| r.series.iter().any(|s| s == wanted)))?;
    let drag: &'static [[f64; 2]] = if kind.is_ball() { &file.drag.ball } else { &file.drag.roller };
    Some(SkfConstants {
        rolling: four(&row.r),
        sliding: four(&row.s),
        k_z: group.k_z,
        k_l: group.k_l,
        drag,
        trust: group.trust,
    })
}

/// Constants of Palmgren's torque by type and series.
pub fn palmgren_constants(kind: Kind, series: &str) -> PalmgrenConstants {
    static FILE: OnceLock<PalmgrenFile> = OnceLock::new();
    let file = FILE.get_or_init(|| {
        toml::from_str(include_str!("../../data/palmgren-friction-constants.toml"))
            .expect("data/palmgren-friction-constants.toml is read")
    });
    let row = file
        .rows
        .iter()
        .find(|r| r.kind == kind && (r.series.is_empty() || r.series.iter().any(|s| s == plain(series))));
    row.map_or(PalmgrenConstants { f0: 4.0, f1: 0.0005, exponent: 0.0 }, |r| PalmgrenConstants {
        f0: r.f0,
        f1: r.f1,
        exponent: r.y,
    })
}

/// Letters and digits of a designation of the series at that bore, in mm.
fn designation(kind: Kind, series: &str, bore_mm: f64) -> String {
    let code = match bore_mm.round() as u32 {
        10 => "00".to_owned(),
        12 => "01".to_owned(),
        15 => "02".to_owned(),
        17 => "03".to_owned(),
        d => format!("{:02}", d / 5),
    };
    match kind {
        Kind::CylindricalRoller => format!("NU {series}{code}"),
        Kind::FullComplementCylindricalRoller => format!("NCF {series}{code}"),
        Kind::NeedleRoller => format!("NA {series}{code}"),
        Kind::ToroidalRoller => format!("C {series}{code}"),
        Kind::TaperedRoller if series == "320" => format!("{series}{code} X"),
        _ => format!("{series}{code}"),
    }
}

/// A group of the catalogue. It is read when a bearing of it is asked for: to read all of them takes longer than most
/// questions.
struct Section {
    text: &'static str,
    bearings: OnceLock<Vec<Bearing>>,
}

impl Section {
    /// Whether it has bearings of a kind and series, by its first lines.
    fn is_of(&self, kind: Kind, series: &str) -> bool {
        let value = |key: &str| self.text.lines().find_map(|line| line.strip_prefix(key)?.strip_prefix(" = "));
        let kind_is = |name: &str| Kind::named(name.trim_matches('"')) == Some(kind);
        value("kind").is_some_and(kind_is) && value("series").is_some_and(|all| all.contains(&format!("\"{series}\"")))
    }

    fn bearings(&self) -> &[Bearing] {
        self.bearings.get_or_init(|| {
            let group: Group = toml::from_str(self.text).expect("data/bearings.toml is read");
            let of = |series| group.rows.iter().map(move |row| (series, row));
            group.series.iter().flat_map(of).map(|(series, row)| group.bearing(series, row)).collect()
        })
    }
}

impl Group {
    fn bearing(&self, series: &str, row: &[f64]) -> Bearing {
        let get = |name: &str| {
            let place = self.columns.iter().position(|c| c == name)?;
            row.get(place).copied()
        };
        let mm = |name: &str| get(name).expect("data/bearings.toml gives d, D and B") / 1e3;
        let name = designation(self.kind, series, mm("d") * 1e3);
        Bearing {
            dynamic_rating: get("C").map(|kn| kn * 1e3),
            static_rating: get("C0").map(|kn| kn * 1e3),
            limiting_speed: get("n").map(|rpm| rpm * std::f64::consts::PI / 30.0),
            axial_factor: get("Y"),
            element_diameter: get("Dw").map(|mm| mm / 1e3),
            source: self.source.clone(),
            trust: self.trust,
            ..Bearing::new(&name, self.kind, series, mm("d"), mm("D"), mm("B"))
        }
    }
}

fn sections() -> &'static [Section] {
    static ALL: OnceLock<Vec<Section>> = OnceLock::new();
    ALL.get_or_init(|| {
        // What stands before the first group is about the file.
        let (_, groups) = include_str!("../../data/bearings.toml").split_once("[[group]]").expect("there are groups");
        groups.split("[[group]]").map(|text| Section { text, bearings: OnceLock::new() }).collect()
    })
}

/// The bearing of a kind, series and bore (m), open.
fn row(kind: Kind, series: &str, bore: f64) -> Option<&'static Bearing> {
    sections().iter().filter(|s| s.is_of(kind, series)).flat_map(Section::bearings).find(|b| {
        // A group may have several series.
        b.series == series && same(b.bore, bore)
    })
}

/// Every bearing of the catalogue, `data/bearings.toml`: one of each dimension series and bore, open.
pub fn all() -> &'static [Bearing] {
    static ALL: OnceLock<Vec<Bearing>> = OnceLock::new();
    ALL.get_or_init(|| sections().iter().flat_map(Section::bearings).cloned().collect())
}

/// What a designation says.
struct Parsed {
    kind: Kind,
    /// Series with its design letter.
    series: String,
    /// Bore, m; none for bore codes that are not understood.
    bore: Option<f64>,
    /// Outside diameter and width, m, of needle cages, which carry them in their name.
    cage: Option<[f64; 2]>,
    seal: Option<Seal>,
}

/// Bore (m) of a bore code of two digits.
fn bore_of(code: &str) -> Option<f64> {
    let mm = match code {
        "00" => 10,
        "01" => 12,
        "02" => 15,
        "03" => 17,
        _ => 5 * code.parse::<u32>().ok()?,
    };
    Some(f64::from(mm) / 1e3)
}

/// Reads prefix letters, digits and suffix of a designation.
fn parse(designation: &str) -> Option<Parsed> {
    let text = designation.trim().to_uppercase();
    let digits_at = text.find(|c: char| c.is_ascii_digit())?;
    let (prefix, rest) = text.split_at(digits_at);
    let prefix = prefix.trim_end();
    if prefix == "K" {
        let mm: Vec<f64> = rest.split('X').map(|p| p.trim().parse().ok()).collect::<Option<_>>()?;
        let [d, big_d, b] = mm[..] else { return None };
        let cage = Some([big_d / 1e3, b / 1e3]);
        return Some(Parsed {
            kind: Kind::NeedleRoller,
            series: "K".to_owned(),
            bore: Some(d / 1e3),
            cage,
            seal: None,
        });
    }
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (digits, suffix) = rest.split_at(end);
    let suffix = suffix.trim_start();
    let series_end = digits.len().checked_sub(2).filter(|n| *n > 0)?;
    let (series, code) = digits.split_at(series_end);
    let kind = match (prefix, series) {
        ("N" | "NU" | "NJ" | "NUP" | "NUB" | "RN" | "RNU", _) => Kind::CylindricalRoller,
        ("NCF" | "NJG" | "NNC" | "NNCF" | "NNCL" | "SL", _) => Kind::FullComplementCylindricalRoller,
        ("NA" | "NKI" | "RNA", _) => Kind::NeedleRoller,
        ("C", _) => Kind::ToroidalRoller,
        ("QJ", _) => Kind::FourPointContactBall,
        ("", s) if s.len() == 3 && s.starts_with('3') => Kind::TaperedRoller,
        ("", s) if s.len() == 3 && s.starts_with('2') => Kind::SphericalRoller,
        ("", "511" | "512" | "513" | "514") => Kind::AxialBall,
        ("", "811" | "812") => Kind::AxialCylindricalRoller,
        ("", s) if s.starts_with('6') || s == "160" || s == "161" || s == "42" || s == "43" => Kind::DeepGrooveBall,
        ("", "70" | "72" | "73") => Kind::AngularContactBall,
        ("", "32" | "33") => Kind::DoubleRowAngularContactBall,
        ("", "12" | "13" | "22" | "23") => Kind::SelfAligningBall,
        _ => return None,
    };
    let letter = match kind {
        Kind::AngularContactBall if suffix.starts_with("AC") => " AC",
        Kind::AngularContactBall | Kind::TaperedRoller if suffix.starts_with('B') => " B",
        Kind::DoubleRowAngularContactBall if suffix.starts_with('A') => " A",
        Kind::SphericalRoller if suffix.starts_with('E') => " E",
        _ => "",
    };
    let lips = |two: &str| if suffix.contains(two) { 2 } else { 1 };
    let seal = match kind {
        _ if suffix.contains("RSL") => Some((SealKind::Rsl, lips("2RSL"))),
        _ if suffix.contains("RSH") => Some((SealKind::Rsh, lips("2RSH"))),
        _ if suffix.contains("RS") && kind.is_ball() => Some((SealKind::Rs1, lips("2RS"))),
        Kind::CylindricalRoller | Kind::FullComplementCylindricalRoller if suffix.contains("2LS") => {
            Some((SealKind::Ls, 2))
        }
        Kind::SphericalRoller | Kind::ToroidalRoller if suffix.contains("CS") => Some((SealKind::Cs, lips("2CS"))),
        _ => None,
    };
    Some(Parsed {
        kind,
        series: format!("{series}{letter}"),
        bore: bore_of(code),
        cage: None,
        seal: seal.map(|(kind, lips)| Seal { kind, lips, diameter: None }),
    })
}

/// What a designation says of the kind and the series of a bearing, whether the catalogue has it or not.
///
/// ```
/// use willis::catalogue::bearing::{Kind, kind_of};
///
/// assert_eq!(kind_of("6299"), Some((Kind::DeepGrooveBall, "62".into())));
/// assert_eq!(kind_of("hub of the left wheel"), None);
/// ```
pub fn kind_of(designation: &str) -> Option<(Kind, String)> {
    parse(designation).map(|parsed| (parsed.kind, parsed.series))
}

/// The bearing of that designation; capitals, blanks between its parts and suffixes that say nothing
/// about friction do not matter. Of the suffixes, rubbing seals (RS1, RSH, RSL, LS, CS) and the design letters
/// that have their own friction constants (`E`, `B`, `AC`, `A`) are read; shields (Z) and seals that
/// do not rub (RZ) cost nothing. Needle cages carry their size in the name: `K 20x24x10`.
///
/// ```
/// use willis::catalogue::bearing::{self, SealKind};
///
/// let bearing = bearing::find("6205-2RS1").unwrap();
/// assert_eq!((bearing.outside_diameter, bearing.width), (0.052, 0.015));
/// assert_eq!(bearing.seal.unwrap().kind, SealKind::Rs1);
/// assert!(bearing::find("6205 2Z").unwrap().seal.is_none());
/// ```
pub fn find(designation: &str) -> Option<Bearing> {
    let parsed = parse(designation)?;
    let bore = parsed.bore?;
    let name = designation.trim();
    if let Some([outside_diameter, width]) = parsed.cage {
        return Some(Bearing {
            source: "the designation of the cage".to_owned(),
            ..Bearing::new(name, parsed.kind, &parsed.series, bore, outside_diameter, width)
        });
    }
    let row = row(parsed.kind, plain(&parsed.series), bore)?;
    Some(Bearing {
        designation: name.to_owned(),
        seal: parsed.seal,
        skf: skf_constants(parsed.kind, &parsed.series),
        series: parsed.series,
        ..row.clone()
    })
}
