//! What stands above and below a symbol of a power flow, and the sizes that its picture keeps.

use willis::hypergraph::{Node, NodeKind};

use crate::parts::style::{fit, watts};

/// Radius of a symbol.
pub const R: f64 = 8.0;
/// Size of labels.
pub const SMALL: f64 = 11.0;
/// Longest name that is not cut.
const LONGEST: f64 = 170.0;
/// Height of a row of words.
pub const ROW: f64 = 14.0;
/// Room below the symbols of contacts that lean on the frame.
pub const GROUND: f64 = 13.0;

pub fn percent(x: f64) -> String {
    let p = 100.0 * x;
    if (99.995..100.0).contains(&p) || (0.0 < p && p < 0.1) { format!("{p:.4} %") } else { format!("{p:.2} %") }
}

/// What stands below a symbol, in rows.
pub fn values(n: &Node) -> Vec<String> {
    let row = match n.kind {
        NodeKind::Input => watts(n.power_out_w),
        NodeKind::Output => watts(n.power_in_w),
        NodeKind::Member => match n.speed_rad_s {
            Some(0.0) => "at rest".to_owned(),
            Some(w) => format!("{} rpm", rpm(w * 30.0 / std::f64::consts::PI)),
            None => "any speed".to_owned(),
        },
        _ if n.loss_w == 0.0 => return vec![],
        _ if n.power_out_w == 0.0 => format!("−{}", watts(n.loss_w)),
        _ => return vec![format!("−{}", watts(n.loss_w)), format!("η {}", percent(n.efficiency.unwrap_or(1.0)))],
    };
    vec![row]
}

fn rpm(x: f64) -> String {
    let decimals = if x.abs() >= 1000.0 { 0 } else { 1 };
    let t = format!("{x:.decimals$}");
    if t.contains('.') { t.trim_end_matches('0').trim_end_matches('.').to_owned() } else { t }.replace('-', "−")
}

/// What stands above a symbol.
pub fn name(n: &Node) -> String {
    let own = match n.kind {
        NodeKind::Input => "input".to_owned(),
        NodeKind::Output => "output".to_owned(),
        NodeKind::Gear => fit(&format!("{} in fluid", n.name), LONGEST, SMALL),
        _ => fit(&n.name, LONGEST, SMALL),
    };
    if n.count > 1 { format!("{own} ×{}", n.count) } else { own }
}
