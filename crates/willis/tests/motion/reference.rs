//! Motion by another way, to compare with: implicit Euler in small steps, with friction of finite steepness and rigid
//! constraints that give a little, each step solved by Newton's method. It knows no modes, events or certificates.

use nalgebra::{DMatrix, DVector};

pub struct Mesh {
    /// Gear 1, gear 2, carrier; 0: the frame.
    pub bodies: [usize; 3],
    /// Teeth; internal below 0.
    pub teeth: [f64; 2],
    /// Gear 1 drives, gear 2 drives.
    pub efficiency: [f64; 2],
}

pub struct Element {
    pub bodies: [usize; 2],
    /// N m; none: rigid.
    pub capacity: Option<f64>,
    /// Of a one-way clutch the sign of the slip of its first body that it prevents, 0 otherwise.
    pub blocks: i8,
    /// N m s/rad, beside the capacity.
    pub viscous: f64,
}

/// A spring with a damper.
pub struct Shaft {
    pub bodies: [usize; 2],
    /// N m/rad.
    pub stiffness: f64,
    /// N m s/rad.
    pub damping: f64,
}

/// Torque, N m, by which the corner of a one-way clutch is rounded off, and speed over torque at which both count
/// alike.
const CORNER: [f64; 2] = [1e-4, 1e-3];

/// Force, N m per tooth, below which the amount of a force is rounded off.
const BLUNT: f64 = 1e-4;

/// Bodies with inertia, and what is between them.
pub struct Reference {
    /// kg m²; the frame first.
    pub inertias: Vec<f64>,
    pub meshes: Vec<Mesh>,
    pub elements: Vec<Element>,
    pub shafts: Vec<Shaft>,
    /// Speed, rad/s, at which friction has most of its torque.
    pub steep: f64,
    /// Speed over torque by which a rigid constraint gives, rad/(s N m): so redundant ones share.
    pub soft: f64,
}

fn saturated(x: f64) -> (f64, f64) {
    let root = (1.0 + x * x).sqrt();
    (x / root, 1.0 / (root * root * root))
}

impl Reference {
    /// Speeds at the end, and the largest on the way; none where Newton's method does not find its way. `torques`: on each body, at a time and with these speeds;
    /// `engaged`: how far each element is, at a time.
    pub fn run(
        &self,
        start: &[f64],
        duration: f64,
        steps: usize,
        torques: impl Fn(f64, &[f64]) -> Vec<f64>,
        engaged: impl Fn(f64) -> Vec<f64>,
    ) -> Option<(Vec<f64>, f64)> {
        let (n, m, k) = (self.inertias.len(), self.meshes.len(), self.elements.len());
        let mut y = DVector::zeros(n + 2 * m + k);
        y.rows_mut(0, n).copy_from_slice(start);
        let mut most = y.rows(0, n).amax();
        let mut twists = vec![0.0; self.shafts.len()];
        for step in 0..steps {
            let at = |step: usize| duration * step as f64 / steps as f64;
            self.step(&mut y, &mut twists, [at(step), at(step + 1)], &torques, &engaged, 0)?;
            most = most.max(y.rows(0, n).amax());
        }
        Some((y.rows(0, n).iter().copied().collect(), most))
    }

    /// One step, or two of half the length where Newton's method does not find its way.
    fn step(
        &self,
        y: &mut DVector<f64>,
        twists: &mut Vec<f64>,
        [from, to]: [f64; 2],
        torques: &impl Fn(f64, &[f64]) -> Vec<f64>,
        engaged: &impl Fn(f64) -> Vec<f64>,
        depth: usize,
    ) -> Option<()> {
        let middle = 0.5 * (from + to);
        let before: Vec<f64> = y.rows(0, self.inertias.len()).iter().copied().collect();
        let mut next = y.clone();
        if self.newton(&mut next, &before, twists, to - from, &torques(middle, &before), &engaged(middle)) {
            for (twist, shaft) in twists.iter_mut().zip(&self.shafts) {
                let [a, b] = shaft.bodies;
                *twist += 0.5 * (to - from) * (next[a] + before[a] - next[b] - before[b]);
            }
            *y = next;
            return Some(());
        }
        if depth == 14 {
            return None;
        }
        self.step(y, twists, [from, middle], torques, engaged, depth + 1)?;
        self.step(y, twists, [middle, to], torques, engaged, depth + 1)
    }

    fn newton(
        &self,
        y: &mut DVector<f64>,
        before: &[f64],
        twists: &[f64],
        h: f64,
        torques: &[f64],
        engaged: &[f64],
    ) -> bool {
        let n = self.inertias.len();
        let (mut r, mut j) = self.equations(y, before, twists, h, torques, engaged);
        for _ in 0..60 {
            let size = |x: &DVector<f64>| x.rows(0, n).amax();
            let forces = |x: &DVector<f64>| x.rows(n, x.len() - n).amax();
            let Some(change) = j.lu().solve(&r) else { return false };
            let whole = &*y - &change;
            let done = size(&change) <= 1e-10 * (1.0 + size(y)) && forces(&change) <= 1e-6 * (1.0 + forces(y));
            let mut next = (whole.clone(), self.equations(&whole, before, twists, h, torques, engaged));
            // Shorter steps where a whole one goes too far; the whole one if none is better.
            for k in 1..6 {
                if done || next.1.0.norm() < r.norm() {
                    break;
                }
                let part = &*y - &change * 0.5f64.powi(k);
                let at = self.equations(&part, before, twists, h, torques, engaged);
                if at.0.norm() < r.norm() {
                    next = (part, at);
                }
            }
            *y = next.0;
            (r, j) = next.1;
            if done {
                return true;
            }
        }
        false
    }

    /// What the equations leave over, and its derivatives.
    fn equations(
        &self,
        y: &DVector<f64>,
        before: &[f64],
        twists: &[f64],
        h: f64,
        torques: &[f64],
        engaged: &[f64],
    ) -> (DVector<f64>, DMatrix<f64>) {
        let (n, m, steep) = (self.inertias.len(), self.meshes.len(), self.steep);
        {
            let mut r = DVector::zeros(y.len());
            let mut j = DMatrix::zeros(y.len(), y.len());
            r[0] = y[0];
            j[(0, 0)] = 1.0;
            for i in 1..n {
                r[i] = self.inertias[i] * (y[i] - before[i]) / h - torques[i];
                j[(i, i)] = self.inertias[i] / h;
            }
            for (shaft, twist) in self.shafts.iter().zip(twists) {
                let [a, b] = shaft.bodies;
                let twisted = twist + 0.5 * h * (y[a] + before[a] - y[b] - before[b]);
                let torque = shaft.stiffness * twisted + shaft.damping * (y[a] - y[b]);
                let slope = 0.5 * h * shaft.stiffness + shaft.damping;
                for (body, sign) in [(a, 1.0), (b, -1.0)] {
                    if body != 0 {
                        r[body] += sign * torque;
                        j[(body, a)] += sign * slope;
                        j[(body, b)] -= sign * slope;
                    }
                }
            }
            for (q, mesh) in self.meshes.iter().enumerate() {
                let ([a, b, c], [z1, z2]) = (mesh.bodies, mesh.teeth);
                let (f, e, row) = (n + 2 * q, n + 2 * q + 1, n + 2 * q);
                for (body, from_f, from_e) in [(a, z1, 0.0), (b, 0.0, z2), (c, -z1, -z2)] {
                    if body != 0 {
                        r[body] += from_f * y[f] + from_e * y[e];
                        j[(body, f)] += from_f;
                        j[(body, e)] += from_e;
                    }
                }
                r[row] = z1 * (y[a] - y[c]) + z2 * (y[b] - y[c]) + self.soft * y[f];
                for (body, z) in [(a, z1), (b, z2), (c, -z1 - z2), (f, self.soft)] {
                    j[(row, body)] += z;
                }
                let [eta12, eta21] = mesh.efficiency;
                let (middle, half) = ((eta12 + 1.0 / eta21) / 2.0, (1.0 / eta21 - eta12) / 2.0);
                let (slip, slope) = saturated((y[a] - y[c]) * z1.signum() / steep);
                let amount = y[f].hypot(BLUNT);
                let sign = y[f] / amount;
                r[row + 1] = y[e] - middle * y[f] + half * amount * slip;
                j[(row + 1, e)] += 1.0;
                j[(row + 1, f)] += -middle + half * sign * slip;
                let by_slip = half * amount * slope * z1.signum() / steep;
                j[(row + 1, a)] += by_slip;
                j[(row + 1, c)] -= by_slip;
            }
            for (q, element) in self.elements.iter().enumerate() {
                let ([a, b], row) = (element.bodies, n + 2 * m + q);
                for (body, sign) in [(a, 1.0), (b, -1.0)] {
                    if body != 0 {
                        r[body] -= sign * y[row];
                        j[(body, row)] -= sign;
                    }
                }
                if element.blocks != 0 {
                    // Torque and slip both against what is prevented, one of them zero.
                    let [round, softness] = CORNER;
                    let sign = -f64::from(element.blocks);
                    let (p, s) = (sign * y[row], sign * (y[a] - y[b]) / softness);
                    let root = (p * p + s * s + round * round).sqrt();
                    r[row] = p + s - root;
                    j[(row, row)] = sign * (1.0 - p / root);
                    let by_slip = sign * (1.0 - s / root) / softness;
                    j[(row, a)] += by_slip;
                    j[(row, b)] -= by_slip;
                    continue;
                }
                match element.capacity.map(|c| c * engaged[q]) {
                    Some(capacity) => {
                        let (slip, slope) = saturated((y[a] - y[b]) / steep);
                        let slope = capacity * slope + element.viscous * steep;
                        r[row] = (y[row] + capacity * slip + element.viscous * (y[a] - y[b])) * steep;
                        j[(row, row)] = steep;
                        j[(row, a)] += slope;
                        j[(row, b)] -= slope;
                    }
                    None if engaged[q] > 0.0 => {
                        r[row] = y[a] - y[b] + self.soft * y[row];
                        j[(row, row)] = self.soft;
                        j[(row, a)] += 1.0;
                        j[(row, b)] -= 1.0;
                    }
                    None => {
                        r[row] = y[row];
                        j[(row, row)] = 1.0;
                    }
                }
            }
            (r, j)
        }
    }
}
