//! The words at the nodes and links of a Sankey diagram, and how wide they may be.

use willis::hypergraph::NodeKind;

use crate::parts::style::{BOLD, digits, fit, lines, watts, wide};
use crate::{SankeyFlow, SankeyLink, SankeyLoss, SankeyNode};

/// Size of words.
pub const SMALL: f64 = 11.0;

pub fn percent(part: f64, whole: f64) -> String {
    match 100.0 * part / whole {
        _ if whole <= 0.0 => String::new(),
        p if p < 1e-3 => "< 0.001 %".to_owned(),
        p => format!("{} %", digits(p)),
    }
}

/// The plural of what loses power.
pub fn losers(kind: NodeKind) -> &'static str {
    match kind {
        NodeKind::Teeth => "teeth",
        NodeKind::Bearing => "bearings",
        NodeKind::Seal => "seals",
        NodeKind::Gear => "gears in fluid",
        NodeKind::Rotor => "rotors in fluid",
        NodeKind::Drag => "given drags",
        NodeKind::OpenElement => "open clutches and brakes",
        NodeKind::Pump => "oil pumps",
        NodeKind::ShiftElement => "clutches and brakes",
        NodeKind::Variator => "variators",
        _ => "others",
    }
}

/// The name that a set gives to its own parts, as words: `outer_planet` is an outer planet. Other names are those of the user.
fn spoken(name: &str) -> String {
    match name.split_once('.') {
        Some((set, part)) => format!("{set}.{}", part.replace('_', " ")),
        None => name.to_owned(),
    }
}

/// A row without the blanks at which it was broken.
fn close_up(row: String) -> String {
    row.replace("- ", "-")
}

/// The words of a picture, and how wide they may be.
#[derive(Clone, Copy)]
pub struct Words {
    /// The input power, W.
    input: f64,
    /// Narrow columns, for a picture of many layers.
    narrow: bool,
    /// Names, losses and what goes round only, for a panel of a screen.
    brief: bool,
}

impl Words {
    pub fn of(f: &SankeyFlow, brief: bool) -> Self {
        Self { input: f.input_w, narrow: f.layers >= 8 || brief, brief }
    }

    fn most(self) -> f64 {
        if self.brief {
            return 66.0;
        }
        if self.narrow { 96.0 } else { 128.0 }
    }

    /// A power and its share, in one row or two.
    fn amount(self, power: String, share: String) -> Vec<String> {
        match (share.is_empty(), self.narrow) {
            (true, _) => vec![power],
            (_, true) => vec![power, share],
            (_, false) => vec![format!("{power} · {share}")],
        }
    }

    /// Above a node, the first in bold.
    pub fn head(self, n: &SankeyNode) -> Vec<String> {
        let times = if n.count > 1 { format!(" ×{}", n.count) } else { String::new() };
        let bold = |text: &str| fit(text, self.most(), SMALL * BOLD);
        let whole = n.name.clone() + &times;
        let mut all = match (n.kind, whole.split_once('.')) {
            (NodeKind::Input | NodeKind::Output, _) if n.name.starts_with(willis::hypergraph::STORE) => {
                vec![bold(&n.name)]
            }
            (NodeKind::Input, _) => vec![bold(&format!("into {}", n.name))],
            (NodeKind::Output, _) => vec![bold(&format!("out of {}", n.name))],
            // The set, and below it which of its contacts.
            (NodeKind::Teeth, Some((set, contact))) if self.narrow || bold(&whole) != whole => {
                let mut rows = vec![bold(set)];
                rows.extend(
                    lines(&contact.replace('_', " ").replace('-', "- "), self.most(), SMALL).into_iter().map(close_up),
                );
                rows
            }
            _ => vec![fit(&spoken(&n.name), self.most() - wide(&times, SMALL * BOLD), SMALL * BOLD) + &times],
        };
        if self.brief {
            return all;
        }
        if let (NodeKind::Member, Some(w)) = (n.kind, n.speed_rad_s) {
            all.push(format!("{} rpm", digits(w * 30.0 / std::f64::consts::PI)));
        }
        if n.input_w > 0.0 {
            let whole = n.input_w >= self.input * (1.0 - 1e-9);
            let share = if whole { String::new() } else { percent(n.input_w, self.input) };
            all.extend(self.amount(format!("in {}", watts(n.input_w)), share));
        }
        if n.output_w > 0.0 {
            all.extend(self.amount(format!("out {}", watts(n.output_w)), percent(n.output_w, self.input)));
        }
        all
    }

    /// Below a node: its losses.
    pub fn foot(self, n: &SankeyNode) -> Vec<String> {
        if self.brief {
            let lost: f64 = n.losses.iter().map(|l| l.power_w).sum();
            return if n.losses.is_empty() { vec![] } else { vec![watts(lost)] };
        }
        let one = |l: &SankeyLoss| {
            let amount = self.amount(format!("lost {}", watts(l.power_w)), percent(l.power_w, self.input));
            let what = match l.names.as_slice() {
                [own] if *own == n.name && l.kind == n.kind => None,
                [other] if matches!(l.kind, NodeKind::Gear | NodeKind::Rotor) => Some(format!("{other} in fluid")),
                [other] => Some(other.clone()),
                all => Some(format!("{} {}", all.len(), losers(l.kind))),
            };
            what.map(|w| fit(&w, self.most(), SMALL)).into_iter().chain(amount).collect::<Vec<_>>()
        };
        n.losses.iter().flat_map(one).collect()
    }

    /// At a link.
    pub fn link(self, l: &SankeyLink) -> Vec<String> {
        let mut all = vec![watts(l.power_w), percent(l.power_w, self.input)];
        all.retain(|t| !t.is_empty());
        if self.brief {
            return vec![all.join(" · ")];
        }
        if !l.via.is_empty() {
            let via = format!("via {}", l.via.iter().map(|n| spoken(n)).collect::<Vec<_>>().join(", "));
            // What a long way passes is told by its tooltip.
            all.extend(lines(&via, if self.narrow { 76.0 } else { 120.0 }, SMALL).into_iter().take(3));
        }
        all
    }
}
