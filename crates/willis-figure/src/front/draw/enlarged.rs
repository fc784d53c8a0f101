//! One mesh, large.

use std::f64::consts::TAU;

use svg::node::element::{Group, Path};

use super::clip::Frame;
use super::view::{DASH_DOT, View, circle, own};
use crate::parts::style::{Anchor, BOLD, FAINT, INK, LINE, PAPER, colour, fit, halo, line, number, rectangle, text};
use crate::{Front, FrontMesh, FrontWheel};

/// Edge of the enlarged mesh.
pub const ENLARGED: f64 = 330.0;

/// Half of the enlarged window, mm.
pub fn window(view: &Front, mesh: &FrontMesh) -> f64 {
    let module = view.wheels[mesh.wheels[0]].module_mm;
    let [a, .., e] = mesh.path_mm;
    a.abs().max(e.abs()) + 1.2 * module
}

/// The first mesh, large: flanks in contact, the path with its points.
pub fn enlarged(view: &Front, mesh: &FrontMesh, x: f64, y: f64) -> Group {
    let head = format!("Mesh {}, enlarged", own(view, &mesh.name));
    let mut g = Group::new()
        .add(text(x, y + 14.0, 13.0, Anchor::Start, &fit(&head, ENLARGED / BOLD, 13.0)).set("font-weight", "bold"));
    let y = y + 26.0;
    let half = window(view, mesh);
    let scale = ENLARGED / (2.0 * half);
    let middle = (x + ENLARGED / 2.0, y + ENLARGED / 2.0);
    let c = mesh.pitch_point_mm;
    let at = View { centre: (middle.0 - c[0] * scale, middle.1 + c[1] * scale), scale };
    let frame = Frame { left: x, top: y, right: x + ENLARGED, bottom: y + ENLARGED };
    let words = |points: &[(f64, f64)]| {
        points.iter().map(|p| format!("{} {}", number(p.0), number(p.1))).collect::<Vec<_>>().join(" ")
    };
    for &k in &mesh.wheels {
        let w = &view.wheels[k];
        let edge: Vec<(f64, f64)> = whole(w).into_iter().map(|p| at.at(p)).collect();
        let fill = colour(w.colour, 0.24);
        // What lies beyond the frame is cut off, the material and its edge each for itself. Of a ring
        // the frame is its material, less the space within its teeth.
        let inside = frame.area(&edge);
        let mut d = if inside.len() > 2 { format!("M{}Z", words(&inside)) } else { String::new() };
        if w.internal {
            d.push_str(&format!("M{}Z", words(&frame.corners())));
        }
        if !d.is_empty() {
            g = g.add(Path::new().set("d", d).set("fill", fill).set("fill-rule", "evenodd"));
        }
        for piece in frame.line(&edge) {
            let d = format!("M{}", words(&piece));
            g = g.add(Path::new().set("d", d).set("fill", "none").set("stroke", INK).set("stroke-width", 1.1));
        }
    }
    for (side, &k) in mesh.wheels.iter().enumerate() {
        let w = &view.wheels[k];
        for (r, dash) in [(mesh.pitch_radii_mm[side], DASH_DOT), (w.base_radius_mm, "2 3")] {
            let b = w.bodies[0].centre_mm;
            let round: Vec<(f64, f64)> = (0..=720)
                .map(|k| f64::from(k) * TAU / 720.0)
                .map(|a| at.at([b[0] + r * a.cos(), b[1] + r * a.sin()]))
                .collect();
            for piece in frame.line(&round) {
                g = g.add(
                    Path::new()
                        .set("d", format!("M{}", words(&piece)))
                        .set("fill", "none")
                        .set("stroke", FAINT)
                        .set("stroke-width", 0.9)
                        .set("stroke-dasharray", dash),
                );
            }
        }
    }
    let far = 4.0 * half;
    for piece in frame.line(&[at.at(mesh.point(-far)), at.at(mesh.point(far))]) {
        g = g.add(line(piece[0], piece[piece.len() - 1], INK, 0.8));
    }
    let [a, .., e] = mesh.path_mm;
    g = g.add(line(at.at(mesh.point(a)), at.at(mesh.point(e)), INK, 2.4));
    let mut s = mesh.contact_mm;
    while s <= e + 1e-9 {
        let p = at.at(mesh.point(s));
        g = g.add(circle(p, 6.0, &colour(Some(1), 1.0), 2.0));
        s += mesh.base_pitch_mm;
    }
    g = g.add(points(mesh, &at, &frame));
    let note = "Bold: path of contact A to E. Rings: contacts.";
    g.add(rectangle(x, y, ENLARGED, ENLARGED, "none").set("stroke", LINE).set("stroke-width", 1))
        .add(text(x, y + ENLARGED + 15.0, 11.0, Anchor::Start, note).set("fill", FAINT))
}

/// The letters of the path, beside their points where there is room.
fn points(mesh: &FrontMesh, at: &View, frame: &Frame) -> Group {
    let mut g = Group::new();
    let mut taken: Vec<(f64, f64)> = Vec::new();
    let (along, across) = (mesh.direction, [-mesh.direction[1], mesh.direction[0]]);
    // C first: it must be there; B and D only where there is single contact.
    let single = (1.0..=2.0).contains(&mesh.contact_ratio);
    for k in [2, 0, 4, 1, 3] {
        if !single && (k == 1 || k == 3) {
            continue;
        }
        let p = at.at(mesh.point(mesh.path_mm[k]));
        g = g.add(circle(p, 2.6, INK, 1.2).set("fill", PAPER));
        let places = [(15.0, 0.0), (-15.0, 0.0), (14.0, 10.0), (-14.0, -10.0), (14.0, -10.0), (-14.0, 10.0)];
        let free = places.into_iter().find_map(|(side, on)| {
            let q = (p.0 + side * across[0] + on * along[0], p.1 - side * across[1] - on * along[1]);
            let inside =
                q.0 > frame.left + 8.0 && q.0 < frame.right - 8.0 && q.1 > frame.top + 9.0 && q.1 < frame.bottom - 9.0;
            let clear = taken.iter().all(|t| (t.0 - q.0).abs() > 12.0 || (t.1 - q.1).abs() > 16.0);
            (inside && clear).then_some(q)
        });
        if let Some(q) = free {
            taken.push(q);
            let letter = ["A", "B", "C", "D", "E"][k];
            let t = text(q.0, q.1 + 4.5, 13.0, Anchor::Middle, letter).set("font-weight", "bold");
            g = g.add(halo(t, PAPER, 3.0));
        }
    }
    g
}

/// Outline of the wheel of the first planet, mm.
fn whole(w: &FrontWheel) -> Vec<[f64; 2]> {
    let b = w.bodies[0];
    let mut all = Vec::with_capacity(w.outline_mm.len() * w.teeth as usize + 1);
    for k in 0..w.teeth {
        let (sin, cos) = (b.phase + TAU * f64::from(k) / f64::from(w.teeth)).sin_cos();
        for p in &w.outline_mm[..w.outline_mm.len() - 1] {
            all.push([b.centre_mm[0] + p[0] * cos - p[1] * sin, b.centre_mm[1] + p[0] * sin + p[1] * cos]);
        }
    }
    all.push(all[0]);
    all
}
