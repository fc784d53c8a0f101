//! Names and tooth counts beside the lines: each at the first place that is free.

use svg::node::element::Group;

use super::sheet::{PLATE, Sheet};
use crate::JointKind;
use crate::parts::style::{Anchor, BOLD, FAINT, INK, PAPER, fit, halo, text, wide};

/// A box: least and greatest x, least and greatest y.
type Bounds = [f64; 4];

/// What stands on the page already: texts, and marks that a text should leave alone.
#[derive(Default)]
pub(super) struct Labels {
    pub texts: Vec<Bounds>,
    marks: Vec<Bounds>,
}

impl Labels {
    pub fn mark(&mut self, a: (f64, f64), b: (f64, f64), half: f64) {
        self.marks.push([a.0.min(b.0) - half, a.0.max(b.0) + half, a.1.min(b.1) - half, a.1.max(b.1) + half]);
    }

    pub fn bounds(x: f64, y: f64, size: f64, anchor: Anchor, width: f64) -> Bounds {
        let left = match anchor {
            Anchor::Start => x,
            Anchor::Middle => x - width / 2.0,
            Anchor::End => x - width,
        };
        [left, left + width, y - 0.78 * size, y + 0.24 * size]
    }

    fn free(&self, b: &Bounds, marks: bool) -> bool {
        let apart =
            |o: &Bounds, gap: f64| b[0] > o[1] + gap || o[0] > b[1] + gap || b[2] > o[3] + gap || o[2] > b[3] + gap;
        self.texts.iter().all(|o| apart(o, 2.0)) && (!marks || self.marks.iter().all(|o| apart(o, 0.5)))
    }
}

/// Places for a label, the best first.
type Spots = Vec<(f64, f64, Anchor)>;

impl Sheet<'_> {
    pub fn joint_names(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for j in &self.data.joints {
            let [a, b] = j.ends.map(|p| self.at(p));
            let (x, y) = ((a.0 + b.0) / 2.0, (a.1 + b.1) / 2.0);
            let r = PLATE + 8.0;
            let level = a.1 == b.1;
            let side: Spots = vec![(x + r, y + 4.0, Anchor::Start), (x - r, y + 4.0, Anchor::End)];
            let over: Spots = vec![(x, y - r, Anchor::Middle), (x, y + r + 8.0, Anchor::Middle)];
            let mut spots = if level { over } else { side };
            spots.extend([
                (x + r, y - 8.0, Anchor::Start),
                (x - r, y - 8.0, Anchor::End),
                (x + r, y + 14.0, Anchor::Start),
                (x - r, y + 14.0, Anchor::End),
                (x + r - 4.0, y - r, Anchor::Start),
                (x - r + 4.0, y - r, Anchor::End),
                (x + r - 4.0, y + r + 8.0, Anchor::Start),
                (x - r + 4.0, y + r + 8.0, Anchor::End),
            ]);
            let weight = if j.engaged && j.kind != JointKind::Shaft { "bold" } else { "normal" };
            g = g.add(self.label(&j.name, None, 12.0, INK, weight, &spots, labels));
        }
        g
    }

    pub fn teeth(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for gear in &self.data.gears {
            let Some([hub, tip]) = gear.stems.first().filter(|_| !gear.teeth.is_empty()) else { continue };
            let (h, t) = (self.at(*hub), self.at(*tip));
            let mut spots = Spots::new();
            if hub[1] == tip[1] {
                for s in [-10.0, 18.0, -22.0, 30.0] {
                    spots.push(((h.0 + t.0) / 2.0, h.1 + s, Anchor::Middle));
                }
            }
            let (x, y) = (h.0, (h.1 + t.1) / 2.0 + 3.5);
            for dy in [0.0, -5.0, 5.0, -10.0, 10.0] {
                spots.push((x + 6.0, y + dy, Anchor::Start));
                spots.push((x - 6.0, y + dy, Anchor::End));
            }
            // Beyond the hub, and beside the teeth.
            let away = (h.1 - t.1).signum();
            for dy in [10.0, 18.0] {
                let y = h.1 + away * dy + 3.5;
                spots.extend([(x + 6.0, y, Anchor::Start), (x - 6.0, y, Anchor::End)]);
            }
            let beside = 0.42 * self.unit;
            spots.extend([(x + beside, t.1 + 3.5, Anchor::Start), (x - beside, t.1 + 3.5, Anchor::End)]);
            let shown = fit(&gear.teeth, 60.0, 11.0);
            g = g.add(self.label(&shown, None, 11.0, FAINT, "normal", &spots, labels));
        }
        g
    }

    pub fn member_names(&self, labels: &mut Labels) -> Group {
        let mut g = Group::new();
        for k in self.listed() {
            let m = &self.data.members[k];
            if self.data.terminals.iter().any(|t| t.member == k) {
                continue;
            }
            // Long level lines first, then upright ones.
            let mut spans: Vec<((f64, f64), (f64, f64))> =
                m.pieces.iter().flat_map(|p| p.points.windows(2).map(|w| (self.at(w[0]), self.at(w[1])))).collect();
            let length = |s: &((f64, f64), (f64, f64))| (s.1.0 - s.0.0).hypot(s.1.1 - s.0.1);
            spans.sort_by(|a, b| length(b).total_cmp(&length(a)));
            let mut spots = Spots::new();
            for (a, b) in spans.iter().filter(|s| s.0.1 == s.1.1) {
                let (from, to) = (a.0.min(b.0), a.0.max(b.0));
                for y in [a.1 - 6.0, a.1 + 14.0] {
                    spots.push(((from + to) / 2.0, y, Anchor::Middle));
                    spots.push((from + 6.0, y, Anchor::Start));
                    spots.push((to - 6.0, y, Anchor::End));
                }
            }
            for (a, b) in spans.iter().filter(|s| s.0.0 == s.1.0) {
                let (low, high) = (a.1.min(b.1), a.1.max(b.1));
                for y in [(low + high) / 2.0, low + 8.0, high - 8.0] {
                    spots.push((a.0 + 7.0, y + 4.0, Anchor::Start));
                    spots.push((a.0 - 7.0, y + 4.0, Anchor::End));
                }
            }
            for gear in self.data.gears.iter().filter(|g| g.member == Some(k)) {
                for [hub, _] in &gear.stems {
                    let (x, y) = self.at(*hub);
                    spots.extend([(x + 7.0, y + 14.0, Anchor::Start), (x - 7.0, y + 14.0, Anchor::End)]);
                    spots.extend([(x + 7.0, y - 7.0, Anchor::Start), (x - 7.0, y - 7.0, Anchor::End)]);
                    spots.extend([(x, y + 18.0, Anchor::Middle), (x, y - 10.0, Anchor::Middle)]);
                }
            }
            let number = self.category[k].map(|c| (c + 1).to_string());
            g = g.add(self.label(&m.name, number.as_deref(), 11.0, INK, "italic", &spots, labels));
        }
        g
    }

    /// A label at the first place that is free, shorter if need be, else over lines with a halo, else its
    /// stand-in.
    #[allow(clippy::too_many_arguments)]
    fn label(
        &self,
        content: &str,
        stand_in: Option<&str>,
        size: f64,
        ink: &str,
        face: &str,
        spots: &Spots,
        labels: &mut Labels,
    ) -> Group {
        let factor = if face == "bold" { BOLD } else { 1.0 };
        let most = wide(content, size).min(150.0);
        let least = wide("00", size).max(most * 0.45).min(most);
        let mut tries: Vec<(String, bool)> = Vec::new();
        for part in [1.0, 0.8, 0.6] {
            let width = most * part;
            if width >= least {
                tries.push((fit(content, width + 0.01, size), true));
            }
        }
        tries.extend(stand_in.map(|s| (s.to_owned(), true)));
        tries.push((fit(content, most + 0.01, size), false));
        tries.push((fit(content, least + 0.01, size), false));
        tries.extend(stand_in.map(|s| (s.to_owned(), false)));
        for (shown, marks) in tries {
            let width = wide(&shown, size) * factor;
            for (x, y, anchor) in spots {
                let b = Labels::bounds(*x, *y, size, *anchor, width);
                let inside =
                    b[0] >= 4.0 && b[1] <= self.width - 4.0 && b[2] >= self.ceiling && b[3] <= self.bottom() + 20.0;
                if !inside || !labels.free(&b, marks) {
                    continue;
                }
                labels.texts.push(b);
                let mut t = text(*x, *y, size, *anchor, &shown).set("fill", ink);
                match face {
                    "bold" => t = t.set("font-weight", "bold"),
                    "italic" => t = t.set("font-style", "italic"),
                    _ => {}
                }
                return if marks { Group::new().add(t) } else { halo(t, PAPER, 3.0) };
            }
        }
        Group::new()
    }
}
