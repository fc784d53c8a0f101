//! Trains that were found, as points over two objectives.

use willis::diagnostic::{Code, Diagnostic};
use willis_figure::{Pareto, ParetoAxis, ParetoPoint, draw_pareto};
use willis_synthesis::teeth::{DesignAnswer, DesignRow, Objective, RankedBy};

use crate::Refusal;

pub fn picture(a: &DesignAnswer) -> Result<String, Refusal> {
    let own = a.own.as_ref().map(|o| &o.row);
    let all: Vec<&DesignRow> = a.rows.iter().chain(own).collect();
    if all.is_empty() {
        let d = Diagnostic::new(Code::Unfit, "plot", "no train satisfies the wish: there is nothing to draw");
        return Err(d.hint("the answer says which wish must give").into());
    }
    // The eye reads size to the right and efficiency upwards.
    let right = [Objective::RingDiameter, Objective::Error, Objective::PlanetSpin];
    let up = [Objective::Forward, Objective::Backward, Objective::LockMargin];
    let asked = |o: &Objective| a.objectives.contains(o);
    let x = right.into_iter().find(asked).or(a.objectives.iter().copied().find(|o| !up.contains(o)));
    let y = up.into_iter().find(asked).or(a.objectives.iter().copied().find(|o| Some(*o) != x));
    let (x, y) = (x.unwrap_or(Objective::RingDiameter), y.unwrap_or(Objective::Forward));
    let third = a.objectives.iter().copied().find(|o| ![x, y].contains(o) && *o != Objective::Error);
    // Half a per cent of efficiency is what such a model can tell apart.
    let least = |o: Objective| if up[..2].contains(&o) { 0.5 } else { 0.0 };
    let axis = |o: Objective| ParetoAxis { title: title(o, a), better_high: o.is_better_high(), least: least(o) };
    let points = all
        .iter()
        .map(|r| ParetoPoint {
            label: if r.number == 0 { "yours".into() } else { r.number.to_string() },
            words: words(r),
            at: [value(a, x, r), value(a, y, r)],
            third: third.map(|o| value(a, o, r)),
            own: r.number == 0,
        })
        .collect();
    let left = a.waterfall.last().map_or(0, |s| s.trains);
    let kept = match a.of_all {
        true => format!("{} of {left} trains that satisfy the wish", a.rows.len()),
        false => format!(
            "{} of {} trains that no other one beats, among {left} that satisfy the wish",
            a.rows.len(),
            a.front
        ),
    };
    Ok(draw_pareto(&Pareto {
        title: a.name.clone(),
        subtitle: kept,
        axes: [axis(x), axis(y)],
        third: third.map(axis),
        points,
        note: format!("{}. Numbers are rows of the answer. {}", a.wish, a.completeness.statement),
    }))
}

fn title(o: Objective, a: &DesignAnswer) -> String {
    let metric = a.rows.iter().chain(a.own.as_ref().map(|o| &o.row)).any(|r| r.ring_diameter_m.is_some());
    let laws = |operations: &[String]| a.ranked_by.by == RankedBy::Laws && !operations.is_empty();
    match o {
        Objective::Error => "Ratio error, %",
        Objective::RingDiameter if metric => "Ring diameter, mm",
        Objective::RingDiameter => "Teeth of the largest ring",
        Objective::Forward if laws(&a.ranked_by.forward) => "Efficiency forward under the laws, %",
        Objective::Forward => "Efficiency forward, %",
        Objective::Backward if laws(&a.ranked_by.backward) => "Efficiency backward under the laws, %",
        Objective::Backward => "Efficiency backward, %",
        Objective::LockMargin => "Margin to self-locking",
        Objective::PlanetSpin => "Planet speed / input speed",
        Objective::MemberSpeed => "Member speed / input speed",
        _ => "Element torque / input torque",
    }
    .to_owned()
}

/// As a point is ranked: where the laws of friction do it, theirs.
fn value(a: &DesignAnswer, o: Objective, r: &DesignRow) -> f64 {
    let ranking = &a.ranked_by;
    if let (RankedBy::Laws, Some(laws)) = (ranking.by, &r.laws) {
        match o {
            Objective::Forward if !ranking.forward.is_empty() => return 100.0 * laws.forward.unwrap_or(0.0),
            Objective::Backward if !ranking.backward.is_empty() => return 100.0 * laws.backward.unwrap_or(0.0),
            _ => {}
        }
    }
    match o {
        Objective::Error => 100.0 * r.error,
        Objective::RingDiameter => r.ring_diameter_m.map_or(r.ring_teeth as f64, |d| 1e3 * d),
        Objective::Forward => 100.0 * r.forward.unwrap_or(0.0),
        Objective::Backward => 100.0 * r.backward.unwrap_or(0.0),
        Objective::LockMargin => r.lock_margin.unwrap_or(f64::NAN),
        Objective::PlanetSpin => r.planet_spin,
        Objective::MemberSpeed => r.member_speed,
        _ => r.element_torque.unwrap_or(0.0),
    }
}

fn words(r: &DesignRow) -> String {
    let teeth: Vec<String> =
        r.sets.iter().map(|(_, s)| s.teeth.iter().map(|(_, z)| z.to_string()).collect::<Vec<_>>().join("/")).collect();
    let name = if r.number == 0 { "yours".to_owned() } else { format!("row {}", r.number) };
    format!("{name}: teeth {}", teeth.join(", "))
}
