//! Motion by another way, to compare with: implicit Euler in small steps, with friction of finite steepness and rigid
//! constraints that give a little, each step solved by Newton's method. It knows no modes, events or certificates.

use nalgebra::{DMatrix, DVector};

/// Speed, rad/s, at which friction has its full torque.
const STEEP: f64 = 1e-3;

/// Speed over torque by which a rigid constraint gives, rad/(s N m): so redundant ones share.
const SOFT: f64 = 1e-7;

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
}

/// Force, N m per tooth, below which the amount of a force is rounded off.
const BLUNT: f64 = 1e-4;

/// Bodies with inertia, and what is between them.
pub struct Reference {
    /// kg m²; the frame first.
    pub inertias: Vec<f64>,
    pub meshes: Vec<Mesh>,
    pub elements: Vec<Element>,
}

fn saturated(x: f64) -> (f64, f64) {
    let root = (1.0 + x * x).sqrt();
    (x / root, 1.0 / (root * root * root))
}

impl Reference {
    /// Speeds at the end. `torques`: on each body at a time; `engaged`: how far each element is, at a time.
    pub fn run(
        &self,
        start: &[f64],
        duration: f64,
        steps: usize,
        torques: impl Fn(f64) -> Vec<f64>,
        engaged: impl Fn(f64) -> Vec<f64>,
    ) -> Vec<f64> {
        let (n, m, k) = (self.inertias.len(), self.meshes.len(), self.elements.len());
        let mut y = DVector::zeros(n + 2 * m + k);
        y.rows_mut(0, n).copy_from_slice(start);
        for step in 0..steps {
            let at = |step: usize| duration * step as f64 / steps as f64;
            self.step(&mut y, at(step), at(step + 1), &torques, &engaged, 0);
        }
        y.rows(0, n).iter().copied().collect()
    }

    /// One step, or two of half the length where Newton's method does not find its way.
    fn step(
        &self,
        y: &mut DVector<f64>,
        from: f64,
        to: f64,
        torques: &impl Fn(f64) -> Vec<f64>,
        engaged: &impl Fn(f64) -> Vec<f64>,
        depth: usize,
    ) {
        let middle = 0.5 * (from + to);
        let before: Vec<f64> = y.rows(0, self.inertias.len()).iter().copied().collect();
        let mut next = y.clone();
        if self.newton(&mut next, &before, to - from, &torques(middle), &engaged(middle), STEEP) {
            *y = next;
            return;
        }
        assert!(depth < 20, "the reference does not converge at t = {from}");
        self.step(y, from, middle, torques, engaged, depth + 1);
        self.step(y, middle, to, torques, engaged, depth + 1);
    }

    fn newton(
        &self,
        y: &mut DVector<f64>,
        before: &[f64],
        h: f64,
        torques: &[f64],
        engaged: &[f64],
        steep: f64,
    ) -> bool {
        let n = self.inertias.len();
        let (mut r, mut j) = self.equations(y, before, h, torques, engaged, steep);
        for _ in 0..60 {
            let size = |x: &DVector<f64>| x.rows(0, n).amax();
            let forces = |x: &DVector<f64>| x.rows(n, x.len() - n).amax();
            let Some(change) = j.lu().solve(&r) else { return false };
            let whole = &*y - &change;
            let done = size(&change) <= 1e-10 * (1.0 + size(y)) && forces(&change) <= 1e-6 * (1.0 + forces(y));
            let mut next = (whole.clone(), self.equations(&whole, before, h, torques, engaged, steep));
            // Shorter steps where a whole one goes too far; the whole one if none is better.
            for k in 1..6 {
                if done || next.1.0.norm() < r.norm() {
                    break;
                }
                let part = &*y - &change * 0.5f64.powi(k);
                let at = self.equations(&part, before, h, torques, engaged, steep);
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
        h: f64,
        torques: &[f64],
        engaged: &[f64],
        steep: f64,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let (n, m) = (self.inertias.len(), self.meshes.len());
        {
            let mut r = DVector::zeros(y.len());
            let mut j = DMatrix::zeros(y.len(), y.len());
            r[0] = y[0];
            j[(0, 0)] = 1.0;
            for i in 1..n {
                r[i] = self.inertias[i] * (y[i] - before[i]) / h - torques[i];
                j[(i, i)] = self.inertias[i] / h;
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
                r[row] = z1 * (y[a] - y[c]) + z2 * (y[b] - y[c]) + SOFT * y[f];
                for (body, z) in [(a, z1), (b, z2), (c, -z1 - z2), (f, SOFT)] {
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
                match element.capacity.map(|c| c * engaged[q]) {
                    Some(capacity) => {
                        let (slip, slope) = saturated((y[a] - y[b]) / steep);
                        r[row] = (y[row] + capacity * slip) * steep;
                        j[(row, row)] = steep;
                        j[(row, a)] += capacity * slope;
                        j[(row, b)] -= capacity * slope;
                    }
                    None if engaged[q] > 0.0 => {
                        r[row] = y[a] - y[b] + SOFT * y[row];
                        j[(row, row)] = SOFT;
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
