//! One tooth in the transverse section.

use std::f64::consts::{FRAC_PI_2, PI};

use willis::geometry::{Pair, involute};

/// Tip radius of the cutting rack over the module, profile A of ISO 53.
const RACK_TIP: f64 = 0.38;
/// Rounding at the root of a ring over the module; below the usual tip clearance of 0.25.
const RING_FILLET: f64 = 0.2;
/// Points along a flank, and along its fillet.
const FLANK: usize = 14;
const FILLET: usize = 14;
/// How far a chord may leave its arc, in modules.
const CHORD: f64 = 2e-3;

/// The teeth of a wheel, mm.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pub teeth: u32,
    pub internal: bool,
    /// Normal module.
    pub module: f64,
    pub shift: f64,
    pub reference: f64,
    pub base: f64,
    pub tip: f64,
    pub root: f64,
    /// Transverse pressure angle.
    pub angle: f64,
    /// Half angle of the tooth (on a ring, of the space) at the base circle.
    pub half_angle: f64,
}

impl Profile {
    /// One wheel of a pair.
    pub fn of(pair: &Pair, k: usize) -> Self {
        let (wheel, gear) = (&pair.data.wheels[k], &pair.gears[k]);
        let angle = pair.transverse_pressure_angle;
        let half = (2.0 * wheel.shift * pair.data.pressure_angle.tan() + FRAC_PI_2) / wheel.teeth;
        Self {
            teeth: wheel.teeth as u32,
            internal: wheel.internal,
            module: pair.data.module * 1e3,
            shift: wheel.shift,
            reference: gear.reference_radius * 1e3,
            base: gear.base_radius * 1e3,
            tip: gear.tip_radius * 1e3,
            root: gear.root_radius * 1e3,
            angle,
            half_angle: half + involute(angle),
        }
    }

    /// Whether both are the same teeth, to a nanometre.
    pub fn same(&self, other: &Self) -> bool {
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6;
        self.teeth == other.teeth
            && self.internal == other.internal
            && close(self.reference, other.reference)
            && close(self.base, other.base)
            && close(self.tip, other.tip)
            && close(self.root, other.root)
            && close(self.half_angle * self.base, other.half_angle * other.base)
    }

    pub fn pitch(&self) -> f64 {
        2.0 * PI / f64::from(self.teeth)
    }

    /// Half angle of the tooth (of the space, on a ring) at a radius outside the base circle.
    pub fn half(&self, radius: f64) -> f64 {
        self.half_angle - involute((self.base / radius).min(1.0).acos())
    }

    /// Half angle of the tooth, also on a ring.
    pub fn tooth(&self, radius: f64) -> f64 {
        let half = self.half(radius);
        if self.internal { self.pitch() / 2.0 - half } else { half }
    }

    /// One tooth from the middle of a space to the next.
    pub fn outline(&self) -> Vec<[f64; 2]> {
        // One side, from the middle of the tip: radius and angle.
        let mut side: Vec<[f64; 2]> = vec![[self.tip, 0.0]];
        let quarter = self.pitch() / 2.0;
        let (from, to) = if self.internal { self.ring_flank() } else { (self.tip, 0.0) };
        let fillet = if self.internal { Vec::new() } else { self.fillet() };
        let foot = fillet.last().map_or(self.root.max(self.base), |p| p[0]);
        let (from, to) = if self.internal { (from, to) } else { (from, foot.min(from)) };
        let at_tip = self.tooth(from).clamp(0.0, quarter);
        self.arc(&mut side, self.tip, at_tip);
        // Equal steps of the roll angle, in which the involute bends evenly.
        let roll = |r: f64| ((r / self.base).powi(2) - 1.0).max(0.0).sqrt();
        let (a, b) = (roll(from), roll(to));
        for k in 0..=FLANK {
            let t = a + (b - a) * k as f64 / FLANK as f64;
            let r = self.base * (1.0 + t * t).sqrt();
            side.push([r, self.tooth(r).clamp(0.0, quarter)]);
        }
        if self.internal {
            // A rounding that runs into the flank and the root circle.
            let last = side[side.len() - 1];
            let corner = [self.root, self.tooth(self.root).clamp(0.0, quarter)];
            let end = [self.root, (corner[1] + RING_FILLET * self.module / self.root).min(quarter)];
            for k in 1..=4 {
                let t = f64::from(k) / 4.0;
                let bend =
                    |i: usize| (1.0 - t) * (1.0 - t) * last[i] + 2.0 * t * (1.0 - t) * corner[i] + t * t * end[i];
                side.push([bend(0), bend(1)]);
            }
        } else {
            // Its last point is where the involute begins, which is there already.
            for p in fillet.iter().rev().skip(1) {
                side.push([p[0], (quarter - p[1]).clamp(0.0, quarter)]);
            }
            if fillet.is_empty() {
                let foot = side[side.len() - 1][1];
                side.push([self.root, foot]);
            }
        }
        self.arc(&mut side, self.root, quarter);
        side.dedup_by(|b, a| (a[0] - b[0]).abs() < 1e-9 && ((a[1] - b[1]) * a[0]).abs() < 1e-9);
        let point = |r: f64, angle: f64| [r * angle.cos(), r * angle.sin()];
        let right = side.iter().rev().map(|&[r, angle]| point(r, -angle));
        // The first point stands on the middle line of the tooth: it is its own mirror image.
        right.chain(side.iter().skip(1).map(|&[r, angle]| point(r, angle))).collect()
    }

    /// Goes on along a circle.
    fn arc(&self, side: &mut Vec<[f64; 2]>, radius: f64, to: f64) {
        let from = side[side.len() - 1][1];
        let step = (8.0 * CHORD * self.module / radius).sqrt();
        let n = ((to - from).abs() / step).ceil().clamp(1.0, 24.0) as usize;
        side.extend((1..=n).map(|k| [radius, from + (to - from) * k as f64 / n as f64]));
    }

    /// Radii between which a ring's flank is drawn as an involute.
    fn ring_flank(&self) -> (f64, f64) {
        let from = self.tip.max(self.base);
        (from, (self.root - RING_FILLET * self.module).max(from))
    }

    /// The fillet that a rack leaves whose tip is rounded, from the root to where the involute begins:
    /// radius, and half angle of the space. The rounding of the transverse section is taken as a circle.
    ///
    /// The rack rolls on the reference circle. When the wheel has turned by φ, the centre of the
    /// rounding is `(−d, r φ + c)` from the pitch point, and the point of contact lies beyond it by
    /// the radius of the rounding.
    fn fillet(&self) -> Vec<[f64; 2]> {
        let (r, tan) = (self.reference, self.angle.tan());
        let depth = r - self.root;
        // Half the rack's tooth where it rolls: half the space at the reference circle.
        let half = r * (self.pitch() / 2.0 - self.half(r));
        let full = (half - depth * tan) / (1.0 / self.angle.cos() - tan);
        let rounding = (RACK_TIP * self.module).min(full).min(0.9 * depth);
        if rounding <= 0.0 || r <= self.base {
            return Vec::new();
        }
        let d = depth - rounding;
        let c = half - d * tan - rounding / self.angle.cos();
        let (first, last) = (-c / r, (d / tan - c) / r);
        let point = |t: f64| {
            let turned = first + (last - first) * t;
            let along = r * turned + c;
            let length = d.hypot(along);
            let (x, y) = (r - d - rounding * d / length, along + rounding * along / length);
            [x.hypot(y), y.atan2(x) - turned]
        };
        // Where the rack's tip cuts into the flank, the involute begins where both curves cross.
        let undercut = d / self.angle.sin() + rounding > r * self.angle.sin();
        let beyond = |[radius, angle]: [f64; 2]| {
            undercut && radius > self.base && angle <= self.pitch() / 2.0 - self.half(radius)
        };
        let mut end = 1.0;
        let steps = 100;
        if let Some(k) = (1..=steps).find(|k| beyond(point(f64::from(*k) / f64::from(steps)))) {
            let (mut low, mut high) = (f64::from(k - 1) / f64::from(steps), f64::from(k) / f64::from(steps));
            for _ in 0..50 {
                let middle = (low + high) / 2.0;
                if beyond(point(middle)) { high = middle } else { low = middle }
            }
            end = high;
        }
        let mut all: Vec<[f64; 2]> = Vec::new();
        for k in 0..=FILLET {
            // Denser at the root, where it bends.
            let p = point(end * (k as f64 / FILLET as f64).powf(1.5));
            if p[0] >= self.tip {
                break;
            }
            if all.last().is_none_or(|q| p[0] > q[0]) {
                all.push(p);
            }
        }
        if let Some(&[radius, angle]) = all.last()
            && radius < self.base
        {
            all.push([self.base.min(self.tip), angle]);
        }
        all
    }
}
