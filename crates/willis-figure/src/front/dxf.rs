//! A front view as DXF: outlines, circles and dimensions in millimetres, for programs that draw or cut parts.

use std::f64::consts::TAU;

use crate::{Front, FrontWheel};

/// The view as DXF (release 12, which every program reads): a layer for the outlines of each wheel, others for its circles, for
/// the operating pitch circles with the centre distances, and for numbers. The unit is the millimetre; teeth are as they are, in
/// the transverse section. What the picture puts side by side, because it would cover each other, lies in its true place.
///
/// # Example
/// ```
/// use willis_figure::{front, front_dxf};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("reducer")
///     .members(["s", "c"])
///     .set(SetSpec::simple("P1", ("s", 30), ("frame", 70), "c").planet(20, 4))
///     .build()?;
/// let dxf = front_dxf(&front(&train, None, true)?);
/// assert!(dxf.ends_with("EOF\n") && dxf.contains("z = 30"));
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn front_dxf(view: &Front) -> String {
    let mut file = Dxf::default();
    file.begin("HEADER");
    file.put(9, "$ACADVER").put(1, "AC1009");
    file.end();
    // Right of everything, from its top on.
    let radius = |w: &FrontWheel| w.tip_radius_mm.max(w.root_radius_mm);
    let reach = |axis: usize| {
        let of = |w: &FrontWheel| w.bodies.iter().map(|b| b.centre_mm[axis] + radius(w)).fold(f64::MIN, f64::max);
        view.wheels.iter().map(of).fold(0.0, f64::max)
    };
    let beside = [reach(0) + view.wheels.iter().map(|w| w.module_mm).fold(0.0, f64::max), reach(1)];
    file.begin("ENTITIES");
    for (k, w) in view.wheels.iter().enumerate() {
        let layer = format!("WHEEL_{}", k + 1);
        for body in 0..w.bodies.len() {
            file.polyline(&layer, &outline(w, body));
        }
        let circles = format!("WHEEL_{}_CIRCLES", k + 1);
        for b in &w.bodies {
            for r in [w.tip_radius_mm, w.reference_radius_mm, w.base_radius_mm, w.root_radius_mm] {
                file.circle(&circles, b.centre_mm, r);
            }
            // The axis.
            let arm = 0.1 * w.reference_radius_mm;
            for [dx, dy] in [[arm, 0.0], [0.0, arm]] {
                let [x, y] = b.centre_mm;
                file.line("AXES", [x - dx, y - dy], [x + dx, y + dy]);
            }
        }
        file.note(w, k, beside);
    }
    for m in &view.meshes {
        let [a, b] = m.wheels.map(|k| view.wheels[k].bodies[0].centre_mm);
        for (centre, r) in [a, b].into_iter().zip(m.pitch_radii_mm) {
            file.circle("PITCH_CIRCLES", centre, r);
        }
        if m.centre_distance_mm > 0.0 {
            let size = 0.5 * view.wheels[m.wheels[0]].module_mm;
            file.line("DIMENSIONS", a, b);
            let middle = [(a[0] + b[0]) / 2.0, (a[1] + b[1]) / 2.0 + 0.5 * size];
            file.text("DIMENSIONS", middle, size, &format!("{}: a = {:.4}", m.name, m.centre_distance_mm));
        }
        let [from, to] = [m.path_mm[0], m.path_mm[4]].map(|s| m.point(s));
        file.line("PATHS_OF_CONTACT", from, to);
    }
    file.end();
    file.put(0, "EOF");
    file.0
}

/// The whole wheel, tooth by tooth, mm.
fn outline(w: &FrontWheel, body: usize) -> Vec<[f64; 2]> {
    let b = w.bodies[body];
    let tooth = &w.outline_mm[..w.outline_mm.len().saturating_sub(1)];
    let turned = |k: u32| {
        let (sin, cos) = (b.phase + TAU * f64::from(k) / f64::from(w.teeth)).sin_cos();
        // The last point of a tooth is the first of the next.
        tooth.iter().map(move |p| [b.centre_mm[0] + p[0] * cos - p[1] * sin, b.centre_mm[1] + p[0] * sin + p[1] * cos])
    };
    (0..w.teeth).flat_map(turned).collect()
}

/// Text of pairs: the code of what follows, and the value.
#[derive(Default)]
struct Dxf(String);

impl Dxf {
    fn put(&mut self, code: u16, value: impl std::fmt::Display) -> &mut Self {
        self.0.push_str(&format!("{code}\n{value}\n"));
        self
    }

    fn begin(&mut self, section: &str) {
        self.put(0, "SECTION").put(2, section);
    }

    fn end(&mut self) {
        self.put(0, "ENDSEC");
    }

    /// A point, mm; to a nanometre.
    fn at(&mut self, first: u16, [x, y]: [f64; 2]) -> &mut Self {
        self.put(first, format!("{x:.6}")).put(first + 10, format!("{y:.6}"))
    }

    fn polyline(&mut self, layer: &str, points: &[[f64; 2]]) {
        // Closed.
        self.put(0, "POLYLINE").put(8, layer).put(66, 1).put(70, 1);
        for p in points {
            self.put(0, "VERTEX").put(8, layer).at(10, *p);
        }
        self.put(0, "SEQEND").put(8, layer);
    }

    fn circle(&mut self, layer: &str, centre: [f64; 2], radius: f64) {
        self.put(0, "CIRCLE").put(8, layer).at(10, centre).put(40, format!("{radius:.6}"));
    }

    fn line(&mut self, layer: &str, from: [f64; 2], to: [f64; 2]) {
        self.put(0, "LINE").put(8, layer).at(10, from).at(11, to);
    }

    fn text(&mut self, layer: &str, at: [f64; 2], size: f64, words: &str) {
        // What ASCII lacks is written by its number; a line end would end the value.
        let plain = |c: char| match c {
            ' '..='~' => c.to_string(),
            c if c.is_control() => " ".to_owned(),
            // Four digits are all that the form has.
            c => u16::try_from(u32::from(c)).map_or("?".to_owned(), |c| format!("\\U+{c:04X}")),
        };
        let words: String = words.chars().map(plain).collect();
        self.put(0, "TEXT").put(8, layer).at(10, at).put(40, format!("{size:.6}")).put(1, words);
    }

    /// The numbers of a wheel, mm, in its row from a place on downwards.
    fn note(&mut self, w: &FrontWheel, row: usize, [x, y]: [f64; 2]) {
        let size = 0.5 * w.module_mm;
        let words = format!(
            "{} {}: z = {}, mn = {}, x = {:.4}, d = {:.4}, da = {:.4}, df = {:.4}, db = {:.4}",
            row + 1,
            w.name,
            w.teeth,
            w.module_mm,
            w.shift,
            2.0 * w.reference_radius_mm,
            2.0 * w.tip_radius_mm,
            2.0 * w.root_radius_mm,
            2.0 * w.base_radius_mm
        );
        self.text("NUMBERS", [x, y - 2.0 * size * row as f64], size, &words);
    }
}
