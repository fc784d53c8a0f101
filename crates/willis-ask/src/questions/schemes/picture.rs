//! The first rows as stick diagrams side by side.

use willis::Train;
use willis_figure::{SidePanel, draw_side_by_side};
use willis_synthesis::schemes::{HybridDesign, Scheme};

use super::SchemesAnswer;
use crate::Refusal;

/// Rows that are drawn.
const MOST: usize = 6;

/// The picture of an answer.
pub fn draw(answer: &SchemesAnswer) -> Result<String, Refusal> {
    let (title, subtitle, panels): (_, _, Result<Vec<SidePanel>, Refusal>) = match answer {
        SchemesAnswer::Schemes(found) => {
            let all = &found.all;
            let shown = all.schemes.len().min(MOST);
            (
                format!("{shown} of {} shift schemes", all.found.schemes),
                all.completeness.statement.clone(),
                all.schemes.iter().take(MOST).enumerate().map(scheme).collect(),
            )
        }
        SchemesAnswer::Hybrids(found) => {
            let all = &found.all;
            let shown = all.designs.len().min(MOST);
            (
                format!("{shown} of {} hybrids", all.kinematic),
                all.completeness.statement.clone(),
                all.designs.iter().take(MOST).enumerate().map(hybrid).collect(),
            )
        }
    };
    Ok(draw_side_by_side(&title, &subtitle, &panels?)?)
}

fn scheme((k, s): (usize, &Scheme)) -> Result<SidePanel, Refusal> {
    let known = s.known.as_ref().map_or(String::new(), |known| format!(" ({known})"));
    let rows = s.gears.iter().chain(&s.reverse).map(|g| {
        vec![
            g.name.clone(),
            format!("{:.3}", g.value),
            g.step.map_or(String::new(), |step| format!("{step:.3}")),
            g.closed.join(" "),
            g.efficiency.map_or("-".into(), |e| format!("{:.2} %", 100.0 * e)),
        ]
    });
    Ok(SidePanel {
        title: format!("Row {}: {}{known}", k + 1, s.id),
        subtitle: format!(
            "spread {:.3}, torque of an element up to {:.3}, speed of a shaft up to {:.3} of the input",
            s.spread, s.max_torque, s.max_speed
        ),
        train: Train::from_toml(&s.to_toml())?,
        head: ["gear", "ratio", "step", "closed", "η"].map(String::from).to_vec(),
        rows: rows.collect(),
    })
}

fn hybrid((k, d): (usize, &HybridDesign)) -> Result<SidePanel, Refusal> {
    let rows = d.modes.iter().map(|m| {
        let ratio = m.ratio.iter().chain(&m.mechanical_points).map(|r| format!("{:.3}", r.to_f64()));
        vec![m.kind.to_string(), m.closed.join(" "), ratio.collect::<Vec<_>>().join("  ")]
    });
    Ok(SidePanel {
        title: format!("Row {}: {}", k + 1, d.id),
        subtitle: "Ratios of fixed gears, of split modes the mechanical points.".into(),
        train: Train::from_toml(&d.to_toml())?,
        head: ["mode", "closed", "engine/output"].map(String::from).to_vec(),
        rows: rows.collect(),
    })
}
