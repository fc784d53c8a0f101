//! Standard teeth for a set that gives only tooth numbers.

use willis::geometry::{Pair, PairData, Remark, Tip, Wheel as WheelData, involute};

use super::{Link, Wheel};

/// Module, m, and pressure angle, degrees.
const MODULE: f64 = 1e-3;
const ANGLE: f64 = 20.0;
/// Addendum and dedendum of full depth, then shorter ones: with a ring whose pinion is nearly as
/// large full teeth collide at their tips.
const DEPTHS: [(f64, f64); 4] = [(1.0, 1.25), (0.9, 1.15), (0.8, 1.05), (0.7, 0.95)];
/// Most difference of two standard centre distances that shifts close, in modules.
const SHIFTED: f64 = 1.0;

/// Planet teeth on one circle with the central gears that mesh with them.
struct Step {
    member: usize,
    teeth: u32,
    /// Standard centre distance of its first mesh, in its modules.
    first: f64,
    links: Vec<usize>,
    /// Module over that of the first step.
    scale: f64,
    distance: f64,
    shift: f64,
}

/// Fewest teeth that a ring has more than its pinion, so that tips of 20° teeth pass each other far
/// from the pitch point too: the usual rule of textbooks.
const FEWEST_MORE: u32 = 8;

/// The pairs of all links, and what was assumed; or why there are none.
pub fn pairs(links: &[Link]) -> Result<(Vec<Pair>, Vec<String>), String> {
    for link in links.iter().filter(|l| l.wheels.iter().any(|w| w.internal)) {
        let [a, b] = link.wheels.map(|w| w.teeth);
        if a.abs_diff(b) < FEWEST_MORE {
            return Err(format!(
                "{}: the ring has only {} teeth more than its pinion, and tips of standard teeth would collide",
                link.name,
                a.abs_diff(b)
            ));
        }
    }
    let mut why = String::new();
    for (addendum, dedendum) in DEPTHS {
        match with_depth(links, addendum, dedendum) {
            Ok(pairs) => {
                let mut notes = vec![format!(
                    "Teeth assumed: module 1 mm, pressure angle 20°, spur, addendum {addendum}, dedendum {dedendum}."
                )];
                let modules: Vec<f64> = pairs.iter().map(|p| p.data.module * 1e3).collect();
                if let Some(other) = modules.iter().find(|m| (*m - 1.0).abs() > 1e-9) {
                    notes.push(format!("On one circle with it the other step has module {other:.4} mm."));
                }
                if pairs.iter().any(|p| p.data.wheels.iter().any(|w| w.shift.abs() > 1e-9)) {
                    notes.push("Profile shifts bring the planets on one circle.".to_owned());
                }
                return Ok((pairs, notes));
            }
            Err(text) if why.is_empty() => why = text,
            Err(_) => {}
        }
    }
    Err(why)
}

fn with_depth(links: &[Link], addendum: f64, dedendum: f64) -> Result<Vec<Pair>, String> {
    let (steps, of_link) = steps(links)?;
    let mut all = Vec::with_capacity(links.len());
    for (link, step) in links.iter().zip(&of_link) {
        let step = step.map(|k| &steps[k]);
        // A planet has the shift and module of its step.
        let own = |w: &Wheel| steps.iter().find(|s| s.member == w.member && s.teeth == w.teeth);
        let shift = |w: &Wheel| match (w.planet, step) {
            (true, Some(step)) => step.shift,
            (true, None) => own(w).map_or(0.0, |s| s.shift),
            (false, Some(step)) => {
                let sum = sum_of_shifts(link, step);
                if w.internal { sum + step.shift } else { sum - step.shift }
            }
            (false, None) => 0.0,
        };
        let scale = step.or_else(|| link.wheels.iter().find_map(own)).map_or(1.0, |s| s.scale);
        let wheel = |w: &Wheel| WheelData {
            teeth: f64::from(w.teeth),
            internal: w.internal,
            shift: shift(w),
            tip: Tip::Addendum { coefficient: addendum, alteration: 0.0 },
            dedendum,
        };
        let data = PairData {
            module: MODULE * scale,
            pressure_angle: ANGLE.to_radians(),
            helix: 0.0,
            double_helical: false,
            width: 10.0 * MODULE,
            centre_distance: step.map(|s| s.distance * MODULE),
            wheels: [wheel(&link.wheels[0]), wheel(&link.wheels[1])],
        };
        let pair = Pair::new(&data).map_err(|faults| {
            let text = faults.first().map_or_else(String::new, ToString::to_string);
            format!("{}: {text}", link.name)
        })?;
        let collision = |r: &Remark| matches!(r, Remark::TipInterference { .. } | Remark::NoClearance { .. });
        if let Some(bad) = pair.remarks().iter().find(|r| collision(r)) {
            return Err(format!("{}: {bad}", link.name));
        }
        all.push(pair);
    }
    Ok(all)
}

/// Tooth numbers of a link added, on a ring subtracted.
fn sum_of_teeth(link: &Link) -> f64 {
    let [a, b] = link.wheels.map(|w| f64::from(w.teeth));
    if link.wheels.iter().any(|w| w.internal) { (a - b).abs() } else { a + b }
}

/// Shifts added (on a ring its own less the planet's) that leave no backlash on the step's circle.
fn sum_of_shifts(link: &Link, step: &Step) -> f64 {
    let angle = ANGLE.to_radians();
    let teeth = sum_of_teeth(link);
    let working = (teeth / 2.0 * step.scale * angle.cos() / step.distance).min(1.0).acos();
    teeth * (involute(working) - involute(angle)) / (2.0 * angle.tan())
}

fn steps(links: &[Link]) -> Result<(Vec<Step>, Vec<Option<usize>>), String> {
    let mut steps: Vec<Step> = Vec::new();
    let mut of_link = vec![None; links.len()];
    for (k, link) in links.iter().enumerate() {
        let planet = match link.wheels.map(|w| w.planet) {
            [true, false] => link.wheels[0],
            [false, true] => link.wheels[1],
            _ => continue,
        };
        let distance = sum_of_teeth(link) / 2.0;
        if distance <= 0.0 {
            return Err(format!("{}: no room for the planet in the ring", link.name));
        }
        let same = |s: &Step| {
            s.member == planet.member && s.teeth == planet.teeth && (s.first - distance).abs() <= SHIFTED + 1e-9
        };
        let at = steps.iter().position(same).unwrap_or_else(|| {
            let (member, teeth) = (planet.member, planet.teeth);
            steps.push(Step { member, teeth, first: distance, links: vec![], scale: 1.0, distance: 0.0, shift: 0.0 });
            steps.len() - 1
        });
        steps[at].links.push(k);
        of_link[k] = Some(at);
    }
    for k in 0..steps.len() {
        // Halfway between the standard distances, so that shifts are small.
        let all: Vec<f64> = steps[k].links.iter().map(|&l| sum_of_teeth(&links[l]) / 2.0).collect();
        let mean = all.iter().sum::<f64>() / all.len() as f64;
        let first = steps[..k].iter().find(|s| s.member == steps[k].member).map(|s| s.distance);
        let step = &mut steps[k];
        step.distance = first.unwrap_or(mean);
        step.scale = step.distance / mean;
        let external = step.links.iter().find(|&&l| links[l].wheels.iter().all(|w| !w.internal));
        step.shift = external.map_or(0.0, |&l| sum_of_shifts(&links[l], step) / 2.0);
    }
    for (link, step) in links.iter().zip(&of_link) {
        let Some(step) = step.map(|k| &steps[k]) else { continue };
        let cosine = sum_of_teeth(link) / 2.0 * step.scale * ANGLE.to_radians().cos() / step.distance;
        if cosine > 1.0 {
            return Err(format!("{}: no shift brings its planet on the circle of the others", link.name));
        }
    }
    Ok((steps, of_link))
}
