//! The page of a stick diagram: where it is drawn, and which members are listed in which colour.

use crate::parts::style::{BOLD, INK, colour, fit, wide};
use crate::{Columns, Drawing, GearRole, Place, Stick, StickGear};

/// Left and right of the grid on a screen.
const MARGIN: f64 = 168.0;
/// The least of it, beside the longest name: an arrow.
const ARROW_ROOM: f64 = 64.0;
const TOP: f64 = 124.0;
/// Half the length of a friction plate, of the line of the frame.
pub const PLATE: f64 = 9.0;
/// Width of one column of the list of members, and the least of it; height of its rows.
const LIST: [f64; 2] = [430.0, 340.0];
pub const ROW: f64 = 19.0;

/// The page of a stick diagram.
pub struct Sheet<'a> {
    pub data: &'a Stick,
    pub width: f64,
    pub height: f64,
    /// Left and right of the grid: names and arrows of the terminals.
    pub margin: f64,
    /// Width of a column of the list of members.
    pub list: f64,
    pub left: f64,
    /// Where the grid begins below the upper edge.
    top: f64,
    /// No label stands higher.
    pub ceiling: f64,
    /// Instead of one scale along the axis, where a panel has columns.
    columns: Option<&'a Columns>,
    pub unit: f64,
    pub rise: f64,
    /// Colour number of each member that has lines.
    pub category: Vec<Option<usize>>,
}

impl<'a> Sheet<'a> {
    pub fn new(data: &'a Stick, paper: Drawing) -> Self {
        let names = data.terminals.iter().map(|t| wide(&data.members[t.member].name, 12.0) * BOLD);
        let narrow = (names.fold(0.0, f64::max) + ARROW_ROOM).min(MARGIN);
        let on_screen = 1064.0 + 2.0 * MARGIN;
        let room = paper.page(on_screen, 560.0);
        let [margin, least] = if room < on_screen { [narrow, 32.0] } else { [MARGIN, 44.0] };
        let margins = 2.0 * margin;
        let unit = ((room - margins) / data.width.max(1.0)).clamp(least, 80.0).floor();
        let rise = (420.0 / data.height.max(1.0)).clamp(46.0, 66.0).floor();
        let drawn = unit * data.width;
        let width = (drawn + margins).clamp(640.0, 4000.0).max(0.0);
        let left = (width - drawn) / 2.0;
        let half = (width - 56.0) / 2.0;
        let list = if room < on_screen && half >= LIST[1] { half.min(LIST[0]) } else { LIST[0] };
        let category = categories(data);
        let (top, ceiling, columns) = (TOP, 82.0, None);
        let mut s = Self { data, width, height: 0.0, margin, list, left, top, ceiling, columns, unit, rise, category };
        s.height = s.list_top() + s.list_rows() as f64 * ROW + 52.0;
        s
    }

    /// Nothing but the schematic, in the columns of a panel that is so high.
    pub fn in_columns(data: &'a Stick, columns: &'a Columns, height: f64) -> Self {
        // Above: the frame of the highest brake. Below: the lowest axis.
        let (above, below) = (18.0, 18.0);
        let steps = data.height.max(1.0);
        let rise = ((height - above - below) / steps).clamp(22.0, 66.0);
        let drawn = rise * steps;
        let height = height.max(drawn + above + below);
        Self {
            data,
            width: columns.width,
            height,
            margin: columns.margin(),
            list: 0.0,
            left: columns.margin(),
            top: above + (height - above - below - drawn) / 2.0,
            ceiling: 4.0,
            columns: Some(columns),
            unit: (columns.width - 2.0 * columns.margin()) / data.width.max(1.0),
            rise,
            category: categories(data),
        }
    }

    pub fn at(&self, p: Place) -> (f64, f64) {
        // Whole pixels: lines of one width meet without a seam.
        let x = self.columns.map_or(self.left + p[0] * self.unit, |c| c.across(p[0]));
        let y = self.top + (self.data.height - p[1]) * self.rise;
        (x.round(), y.round())
    }

    pub fn bottom(&self) -> f64 {
        self.at([0.0, 0.0]).1
    }

    pub fn list_top(&self) -> f64 {
        self.bottom() + 86.0
    }

    pub fn listed(&self) -> Vec<usize> {
        let mut all: Vec<usize> = (0..self.data.members.len()).filter(|&k| self.category[k].is_some()).collect();
        all.sort_by_key(|&k| self.category[k]);
        all
    }

    pub fn list_columns(&self) -> usize {
        (((self.width - 56.0) / self.list + 1e-9) as usize).max(1)
    }

    /// The members that are listed, in the columns of the list, each with its parts in as many lines as they need.
    pub fn list_of_members(&self) -> Vec<Vec<(usize, Vec<String>)>> {
        let all: Vec<(usize, Vec<String>)> = self.listed().into_iter().map(|k| (k, self.parts(k))).collect();
        let needed: usize = all.iter().map(|m| m.1.len()).sum();
        let filled = |rows: usize| {
            let mut columns: Vec<Vec<(usize, Vec<String>)>> = vec![];
            let mut left = 0;
            for member in &all {
                if left < member.1.len() {
                    columns.push(vec![]);
                    left = rows;
                }
                left = left.saturating_sub(member.1.len());
                columns.last_mut().expect("the first has no room left").push(member.clone());
            }
            columns
        };
        let most = self.list_columns();
        let least = needed.div_ceil(most).max(1);
        (least..=needed.max(1)).map(filled).find(|c| c.len() <= most).unwrap_or_default()
    }

    /// Rows of the list, its head included.
    pub fn list_rows(&self) -> usize {
        let rows = |column: &Vec<(usize, Vec<String>)>| column.iter().map(|m| m.1.len()).sum::<usize>();
        self.list_of_members().iter().map(rows).max().unwrap_or(0) + 1
    }

    /// Where the parts of a member stand in its column, right of its name.
    pub fn parts_at(&self) -> f64 {
        // Names, parts and speeds share a narrow column.
        182.0 - 0.45 * (LIST[0] - self.list)
    }

    /// Whether there are speeds to be listed.
    pub fn speeds(&self) -> bool {
        self.listed().into_iter().filter(|&k| self.data.members[k].speed_ratio.is_some()).count() > 1
    }

    /// What a member is made of, in lines: its gears, and the blocks whose planets it carries.
    fn parts(&self, k: usize) -> Vec<String> {
        let block = |b: usize| self.data.blocks[b].name.as_str();
        let gears = self.data.gears.iter().filter(|g| g.member == Some(k));
        let mut all: Vec<String> = gears.map(|g| format!("{} {}", role(g), block(g.block))).collect();
        all.extend(self.data.members[k].carries.iter().map(|&b| format!("carrier {}", block(b))));
        all.dedup();
        let room = self.list - self.parts_at() - if self.speeds() { 98.0 } else { 24.0 };
        let mut lines = vec![String::new()];
        for (nth, part) in all.iter().enumerate() {
            let part = if nth + 1 < all.len() { format!("{part},") } else { part.clone() };
            let last = lines.last_mut().expect("never empty");
            if last.is_empty() {
                *last = part;
            } else if wide(last, 11.0) + wide(" ", 11.0) + wide(&part, 11.0) <= room {
                *last += " ";
                *last += &part;
            } else {
                lines.push(part);
            }
        }
        lines.into_iter().map(|l| fit(&l, room, 11.0)).collect()
    }

    pub fn ink(&self, member: Option<usize>) -> String {
        match member.map(|m| self.category[m]) {
            Some(Some(c)) => colour(Some(c), 1.0),
            _ => INK.to_owned(),
        }
    }
}

/// The colour number of each member that has lines: planets have none, unless something joins them from outside.
fn categories(data: &Stick) -> Vec<Option<usize>> {
    let led_out = |k: usize| {
        let joined = data.joints.iter().any(|j| j.members.contains(&Some(k)));
        joined || data.terminals.iter().any(|t| t.member == k) || !data.members[k].carries.is_empty()
    };
    data.members.iter().enumerate().map(|(k, m)| (!m.planet || led_out(k)).then_some(m.colour)).collect()
}

/// What a gear is called in lists.
pub fn role(g: &StickGear) -> &'static str {
    match g.role {
        GearRole::Sun => "sun",
        GearRole::Planet => "planet",
        GearRole::Ring => "ring",
        GearRole::Side => "side gear",
        _ => "gear",
    }
}
