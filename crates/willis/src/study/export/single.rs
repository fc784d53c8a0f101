//! One efficiency a direction, for formats that have room for no more.

use crate::analysis::Direction;
use crate::diagnostic::Diagnostics;

use super::map::Gear;
use super::names::{percent, short};

/// Efficiency driving and coasting where one number each has to do, and what must be told of it.
pub(super) struct Single {
    /// Power from input to output; `None` with its verdict in `why`.
    pub drive: Option<f64>,
    /// Power from output to input.
    pub coast: Option<f64>,
    /// Driving, coasting: why there is none.
    pub why: [String; 2],
    /// Where the numbers hold, and how far they change.
    pub notes: Vec<String>,
}

/// One efficiency a direction: of the shift table where it is constant, else at the largest speed and torque.
pub(super) fn single(gear: &Gear) -> Result<Single, Diagnostics> {
    let [temperature] = gear.temperatures[..] else {
        return Err(gear.refuse("one number has one oil temperature", "give one"));
    };
    let reason = |d: &Direction| d.reason.clone().unwrap_or_else(|| "there is no single answer".into());
    if !gear.is_physical() {
        let why = [reason(&gear.drive), reason(&gear.coast)];
        return Ok(Single { drive: gear.drive.efficiency, coast: gear.coast.efficiency, why, notes: vec![] });
    }
    let mut all = Single { drive: None, coast: None, why: Default::default(), notes: vec![] };
    let mut moving = gear.clone();
    moving.speeds.retain(|s| s.value.sign() > 0);
    let map = moving.map(temperature)?;
    for (k, coasting) in [(0, false), (1, true)] {
        let Some((speed, torque)) = gear.rated(coasting) else {
            all.why[k] = "no torque of the range goes this way".into();
            continue;
        };
        let point = gear.point(&speed, &torque, temperature)?;
        let efficiency = point.answer.and_then(|a| a.efficiency);
        *(if coasting { &mut all.coast } else { &mut all.drive }) = efficiency;
        let way = if coasting { "coasting" } else { "driving" };
        all.why[k] = point.reason.clone().unwrap_or_else(|| "the losses take all".into());
        let Some(efficiency) = efficiency else { continue };
        let range = map.rows.iter().flatten().filter(|p| (p.torque_n_m < 0.0) == coasting && p.torque_n_m != 0.0);
        let (mut low, mut none) = (efficiency, 0);
        for p in range {
            match p.answer.and_then(|a| a.efficiency) {
                Some(e) => low = low.min(e),
                None => none += 1,
            }
        }
        let mut note = format!(
            "{}, {way}: {} at {} rpm and {} N m; over the range of speeds and torques down to {}",
            gear.title(),
            percent(efficiency),
            short(point.speed_rpm),
            short(point.torque_n_m),
            percent(low)
        );
        if none > 0 {
            note += &format!(", and in {none} points nothing arrives");
        }
        all.notes.push(note + ": the efficiency depends on speed and load, and one number stands for all");
    }
    all.notes.push(format!("{}: a torque that is lost without load has no place in this format", gear.title()));
    Ok(all)
}
