//! The regimes of a train with two freedoms as a wheel of sectors, and its unrolled half.

pub mod draw;

use serde::{Deserialize, Serialize};
use willis::diagnostic::{Code, Diagnostic, Diagnostics};
use willis::regimes::{Atlas, RegimeReport, RegimeSelection, RegionReport};
use willis::train::Train;
use willis::unstable::{Speeds, arrow};

use crate::kind::{self, Ask, Kind};

pub(crate) const KIND: Kind<RegimeMap> = Kind {
    title: "Regimes",
    takes: &[Ask::State, Ask::Terminals, Ask::Balance],
    effort: kind::of_file,
    applies: None,
    make: |s, r| {
        let (state, terminals, balance) = (r.state.clone(), r.terminals.clone(), r.balance.clone());
        regime_map(s.train(), &RegimeSelection { state, terminals, balance })
    },
    steps: None,
    draw: |data, _| draw::draw(data),
};

/// The speed plane of a train with two freedoms.
///
/// Angles are in degrees, counterclockwise from the direction of the first base speed, *as drawn*:
/// a narrow sector is widened, so that it can be read, and the others shrink. Opposite directions
/// stay opposite.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct RegimeMap {
    /// The train, and its state.
    pub title: String,
    /// The two speeds that span the plane.
    pub base_speeds: [String; 2],
    /// The torque whose sign tells the rings apart: outer ring positive, inner ring negative.
    pub torque: String,
    /// Two terminals whose powers balance, where that was asked for.
    pub balance: Option<[String; 2]>,
    /// Every assignment of inputs and outputs that occurs.
    pub patterns: Vec<MapPattern>,
    /// The sectors, counterclockwise.
    pub sectors: Vec<MapSector>,
    /// The lines between them.
    pub boundaries: Vec<MapBoundary>,
    /// Efficiency over the half of the wheel on which the first base speed is positive.
    pub curves: Vec<Curve>,
    /// The angles between which the first base speed is positive.
    pub half: [f64; 2],
    /// Smallest efficiency of a regime with an output.
    pub least_efficiency: f64,
    /// Whether sectors were widened.
    pub widened: bool,
}

/// An assignment of inputs and outputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapPattern {
    /// A capital letter.
    pub letter: String,
    /// `engine, mg1 -> ring`.
    pub label: String,
    /// Smallest and largest efficiency in the map; absent where no regime of it is drawn.
    pub efficiency: Option<[f64; 2]>,
    /// No output: all power turns into heat.
    pub dissipated: bool,
}

/// A region of speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapSector {
    /// Number of the region.
    pub region: usize,
    /// The order of the speeds in it.
    pub order: Vec<String>,
    /// Angle of its first bound.
    pub from: f64,
    /// Angle of its second bound.
    pub to: f64,
    /// Its regimes, the outer ring's first.
    pub cells: Vec<MapCell>,
}

/// A regime.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapCell {
    /// Its name.
    pub regime: String,
    /// 0 outer ring (positive torque), 1 inner ring.
    pub ring: usize,
    /// Its place among several of one ring, and their number.
    pub slot: [usize; 2],
    /// Number of its pattern.
    pub pattern: usize,
    /// Efficiency at equal steps of angle, from one bound to the other.
    pub efficiency: Vec<f64>,
}

/// A line between sectors, on both sides of the centre.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MapBoundary {
    /// A small letter.
    pub letter: String,
    /// What is the case on it.
    pub label: String,
    /// Its two angles.
    pub angles: [f64; 2],
    /// Second over first base speed; absent when that is infinite.
    pub ratio: Option<f64>,
    /// A terminal stands still: its power passes zero. In a power split whose machines balance each
    /// other, a machine at rest is a mechanical point, and the label says so.
    pub at_rest: bool,
    /// A set turns as one: no loss there.
    pub locked_up: bool,
}

/// Efficiency of one ring over one sector.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Curve {
    /// The regime.
    pub regime: String,
    /// 0 positive torque, 1 negative.
    pub ring: usize,
    /// Its place among several of one ring, and their number.
    pub slot: [usize; 2],
    /// Number of its pattern.
    pub pattern: usize,
    /// Angle (within `half`) and efficiency.
    pub points: Vec<[f64; 2]>,
}

/// Steps of angle within a sector.
const STEPS: usize = 24;
/// Degrees that a sector has at least.
const NARROWEST: f64 = 14.0;

/// The regime map of a train with two freedoms and one independent torque.
///
/// # Errors
/// Unknown names, and a train (or state) of another kind.
///
/// # Example
/// ```
/// use willis_figure::regime_map;
/// use willis::regimes::RegimeSelection;
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("power split")
///     .members(["engine", "mg1", "ring"])
///     .terminals(["engine", "mg1", "ring"])
///     .set(SetSpec::simple("P1", ("mg1", 30), ("ring", 78), "engine").planet(24, 4).mesh_efficiency(0.99))
///     .build()?;
/// let map = regime_map(&train, &RegimeSelection::default())?;
/// assert_eq!((map.sectors.len(), map.boundaries.len(), map.patterns.len()), (8, 4, 6));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn regime_map(train: &Train, selection: &RegimeSelection) -> Result<RegimeMap, Diagnostics> {
    let plane = Speeds::new(train, selection).map_err(|why| match why {
        Ok(wrong) => wrong,
        Err(text) => {
            let mut all = Diagnostics::default();
            let d = Diagnostic::new(Code::Unfit, "", format!("no regime map: {text}"));
            all.push(d.hint(
                "it needs two degrees of freedom and one independent torque: name three `terminals`, or two \
                 that `balance` each other's power",
            ));
            all
        }
    })?;
    let atlas = plane.atlas();
    let n = atlas.regions.len();
    let rays: Vec<[[f64; 2]; 2]> =
        atlas.regions.iter().map(|r| plane.bounds(r).unwrap_or([[1.0, 0.0], [1.0, 0.0]])).collect();
    let angle = |v: [f64; 2]| v[1].atan2(v[0]).to_degrees().rem_euclid(360.0);
    let widths: Vec<f64> = rays.iter().map(|[a, b]| (angle(*b) - angle(*a)).rem_euclid(360.0)).collect();
    let (drawn, widened) = spread(&widths);
    // The direction of the first base speed is drawn at angle zero: it bounds a sector.
    let first = (0..n).find(|&k| rays[k][0][1] == 0.0 && rays[k][0][0] > 0.0).unwrap_or(0);
    let mut from = vec![0.0; n];
    let mut at = 0.0;
    for k in (0..n).map(|k| (k + first) % n) {
        from[k] = at;
        at += drawn[k];
    }

    // The half on which the first base speed is positive ends where it is zero.
    let upright = (0..n).find(|&k| rays[k][0][0] == 0.0 && rays[k][0][1] > 0.0).map_or(90.0, |k| from[k]);

    let lead = |r: &RegimeReport| r.torque_signs.iter().map(|(_, s)| *s).find(|s| *s != 0).unwrap_or(0);
    let torque = atlas
        .regimes
        .iter()
        .find_map(|r| r.torque_signs.iter().find(|(_, s)| *s != 0).map(|(name, _)| name.clone()))
        .unwrap_or_default();
    let mut patterns: Vec<(Vec<i8>, MapPattern)> = Vec::new();
    for a in &atlas.assignments {
        let Some(r) = atlas.regimes.iter().find(|r| a.regimes.contains(&r.id)) else { continue };
        let letter = char::from(b'A' + (patterns.len() % 26) as u8).to_string();
        patterns.push((
            plane.power_signs(r).to_vec(),
            MapPattern { letter, label: arrow(&a.inputs, &a.outputs), efficiency: None, dissipated: r.all_dissipated },
        ));
    }
    let mut sectors = Vec::new();
    let mut curves = Vec::new();
    for (k, region) in atlas.regions.iter().enumerate() {
        let own: Vec<&RegimeReport> = atlas.regimes.iter().filter(|r| r.region == region.number).collect();
        let mut cells = Vec::new();
        for ring in [0usize, 1] {
            let sign = if ring == 0 { 1 } else { -1 };
            let alike: Vec<&&RegimeReport> = own.iter().filter(|r| lead(r) == sign).collect();
            for (slot, r) in alike.iter().enumerate() {
                let pattern = patterns.iter().position(|(p, _)| p == plane.power_signs(r)).unwrap_or(0);
                let efficiency = along(&plane, region, r, rays[k]);
                let range = &mut patterns[pattern].1.efficiency;
                for e in &efficiency {
                    let [least, most] = range.unwrap_or([*e; 2]);
                    *range = Some([least.min(*e), most.max(*e)]);
                }
                let middle = from[k] + drawn[k] / 2.0;
                if !(upright..upright + 180.0).contains(&middle) {
                    let start = if middle >= upright { from[k] - 360.0 } else { from[k] };
                    let step = drawn[k] / STEPS as f64;
                    curves.push(Curve {
                        regime: r.id.clone(),
                        ring,
                        slot: [slot, alike.len()],
                        pattern,
                        points: efficiency.iter().enumerate().map(|(i, e)| [start + step * i as f64, *e]).collect(),
                    });
                }
                cells.push(MapCell { regime: r.id.clone(), ring, slot: [slot, alike.len()], pattern, efficiency });
            }
        }
        sectors.push(MapSector {
            region: region.number,
            order: region.order.clone(),
            from: from[k],
            to: from[k] + drawn[k],
            cells,
        });
    }
    let least = atlas
        .regimes
        .iter()
        .filter(|r| !r.all_dissipated)
        .filter_map(|r| r.efficiency_range.map(|e| e[0]))
        .fold(1.0, f64::min);
    let boundaries = boundaries(atlas, &rays, &from, atlas.link.as_ref().map(|link| &link.ends));
    Ok(RegimeMap {
        title: match atlas.state == willis::train::AS_DRAWN {
            true => train.name().to_owned(),
            false => format!("{}, state {}", train.name(), atlas.state),
        },
        base_speeds: [atlas.base_speeds[0].clone(), atlas.base_speeds[1].clone()],
        torque,
        balance: selection.balance.clone(),
        patterns: patterns.into_iter().map(|(_, p)| p).collect(),
        sectors,
        boundaries,
        curves,
        half: [upright - 180.0, upright],
        least_efficiency: least,
        widened,
    })
}

/// Efficiency at equal steps of angle from one bounding direction to the other.
fn along(plane: &Speeds<'_>, region: &RegionReport, r: &RegimeReport, [from, to]: [[f64; 2]; 2]) -> Vec<f64> {
    let (a, b) = (from[1].atan2(from[0]), to[1].atan2(to[0]));
    let width = (b - a).rem_euclid(std::f64::consts::TAU);
    (0..=STEPS)
        .map(|i| {
            // Within the sector by a hair, also at its ends: the limit, not the value on the line.
            let t = (i as f64 / STEPS as f64).clamp(1e-6, 1.0 - 1e-6);
            let phi = a + width * t;
            plane.efficiency(region, r, [phi.cos(), phi.sin()])
        })
        .collect()
}

/// Widths in which none is too narrow to read, in sum the same.
fn spread(widths: &[f64]) -> (Vec<f64>, bool) {
    let least = NARROWEST.min(300.0 / widths.len() as f64);
    let mut narrow: Vec<bool> = widths.iter().map(|w| *w < least).collect();
    loop {
        let fixed = narrow.iter().filter(|n| **n).count() as f64 * least;
        let free: f64 = widths.iter().zip(&narrow).filter(|(_, n)| !**n).map(|(w, _)| w).sum();
        let scale = (360.0 - fixed) / free;
        let drawn: Vec<f64> = widths.iter().zip(&narrow).map(|(w, n)| if *n { least } else { w * scale }).collect();
        let more: Vec<bool> = drawn.iter().zip(&narrow).map(|(d, n)| *n || *d < least - 1e-9).collect();
        if more == narrow {
            return (drawn, narrow.contains(&true));
        }
        narrow = more;
    }
}

fn boundaries(atlas: &Atlas, rays: &[[[f64; 2]; 2]], from: &[f64], link: Option<&[String; 2]>) -> Vec<MapBoundary> {
    let n = from.len();
    let mut all: Vec<MapBoundary> = Vec::new();
    for k in 0..n {
        let before = &atlas.regions[(k + n - 1) % n];
        let after = &atlas.regions[k];
        let Some(p) = (0..before.signs.len()).find(|&p| before.signs[p] != after.signs[p]) else { continue };
        let plane = &atlas.planes[p];
        // Where one end of a variator, or of two balanced machines, stands still, no power passes beside the gears.
        let mechanical = link.is_some_and(|pair| pair.iter().any(|name| plane.at_rest.contains(name)));
        let label = if mechanical { format!("{}: mechanical point", plane.label) } else { plane.label.clone() };
        if let Some(b) = all.iter_mut().find(|b| b.label == label && (b.angles[0] + 180.0 - from[k]).abs() < 1e-6) {
            b.angles[1] = from[k];
            continue;
        }
        let direction = rays[k][0];
        all.push(MapBoundary {
            letter: String::new(),
            label,
            angles: [from[k], (from[k] + 180.0).rem_euclid(360.0)],
            ratio: (direction[0].abs() > 1e-12).then(|| direction[1] / direction[0]),
            at_rest: !plane.at_rest.is_empty(),
            locked_up: !plane.without_relative_motion.is_empty(),
        });
    }
    // Each line once; counterclockwise from the first axis.
    let mut kept: Vec<MapBoundary> = Vec::new();
    for b in all {
        let same = |o: &MapBoundary| {
            let gap = (o.angles[0] - b.angles[0]).rem_euclid(180.0);
            !(1e-6..=180.0 - 1e-6).contains(&gap)
        };
        if !kept.iter().any(same) {
            kept.push(b);
        }
    }
    for b in &mut kept {
        b.angles[0] = b.angles[0].rem_euclid(180.0);
        b.angles[1] = b.angles[0] + 180.0;
    }
    kept.sort_by(|a, b| a.angles[0].total_cmp(&b.angles[0]));
    for (k, b) in kept.iter_mut().enumerate() {
        b.letter = char::from(b'a' + (k % 26) as u8).to_string();
    }
    kept
}
