//! Friction at rest balanced by sweeps: whether what is held several times over stays held, and how.

use super::engine::Engine;
use super::mode::{Mode, Side, dot, dot_size};

impl Engine {
    /// Whether groups that are held several times over stay held: some split of the torques among them fits.
    pub fn holds(&mut self, t: f64, x: &[f64]) -> bool {
        let mode = self.mode.clone();
        let held: Vec<bool> = mode.slip.iter().map(|s| *s == 0).collect();
        let balanced = self.balance_guess(t, x, &held, &mode);
        self.enter(&mode);
        self.solve(t, x);
        balanced.slip == mode.slip
    }

    /// Balances friction by projected sweeps (Gauss–Seidel): every element at rest takes the torque that
    /// stops its slip, within what it can hold. Where several share, any share that holds is found.
    pub fn balance_guess(&mut self, t: f64, x: &[f64], at_rest: &[bool], start: &Mode) -> Mode {
        let mut mode = start.clone();
        for g in 0..at_rest.len() {
            if at_rest[g] {
                mode.slip[g] = 0;
            }
        }
        let p = self.system.ports;
        let all = self.system.all();
        let groups: Vec<usize> = (0..at_rest.len()).filter(|&g| at_rest[g] && !self.system.groups[g].driven).collect();
        let mut rates = vec![0.0; at_rest.len()];
        let mut sizes = vec![0.0; at_rest.len()];
        for _round in 0..20 {
            self.mode = mode.clone();
            self.load(t, x);
            let mut tau = self.tau.clone();
            // Limits of the friction elements at rest.
            let mut limits: Vec<(usize, usize, f64, f64, f64)> = Vec::new();
            for &g in &groups {
                for &f in &self.system.groups[g].frictions {
                    let friction = &self.system.frictions[f];
                    let (_, factor) = friction.group.expect("of this group");
                    let c = |engine: &Self, sign: i8| engine.capacity_of(f, sign, t);
                    limits.push((g, friction.port, factor, -c(self, 1), c(self, -1)));
                }
            }
            let Some(pattern) = self.maps.pattern(&self.system, &mode) else { return mode };
            let response = pattern.response.clone();
            let slip = pattern.slip.clone();
            let torque_of = |j: usize, tau: &[f64], factors: [f64; 2]| {
                factors[0] * dot(&response[(all + j) * p..(all + j + 1) * p], tau)
            };
            for _sweep in 0..4000 {
                let mut change = 0.0f64;
                for &(g, port, factor, low, high) in &limits {
                    let d = factor * slip[g * p + port];
                    if d <= 0.0 {
                        continue;
                    }
                    let a = factor * dot(&slip[g * p..(g + 1) * p], &tau);
                    let next = (tau[port] - a / d).clamp(low, high);
                    change = change.max(
                        (next - tau[port]).abs()
                            / (next.abs() + 1e-300).max(dot_size(&slip[g * p..(g + 1) * p], &tau) / d.abs()),
                    );
                    tau[port] = next;
                }
                for &g in &groups {
                    for &j in &self.system.groups[g].elements {
                        let e = &self.system.elements[j];
                        let (_, factor) = e.group.expect("of this group");
                        let d = factor * slip[g * p + e.port];
                        if d >= 0.0 {
                            continue;
                        }
                        let a = factor * dot(&slip[g * p..(g + 1) * p], &tau);
                        let torque = torque_of(j, &tau, e.factors);
                        let loss = self.loss_at(j, 0.0);
                        let upper =
                            (loss.drive * torque + loss.drive_torque).max(loss.coast * torque + loss.coast_torque);
                        let lower =
                            (loss.drive * torque - loss.drive_torque).min(loss.coast * torque - loss.coast_torque);
                        let next = (tau[e.port] - a / d).clamp(lower.min(upper), upper.max(lower));
                        change = change.max(
                            (next - tau[e.port]).abs()
                                / (next.abs() + 1e-300).max(dot_size(&slip[g * p..(g + 1) * p], &tau) / d.abs()),
                        );
                        tau[e.port] = next;
                    }
                }
                for (j, e) in self.system.elements.iter().enumerate() {
                    if e.varies() && mode.element_slip(&self.system, j) != 0 {
                        let loss = self.loss(j);
                        let torque = torque_of(j, &tau, e.factors);
                        tau[e.port] = super::mode::slope(loss, mode.side[j]) * torque + self.tau[e.port];
                    }
                }
                if change < 1e-13 {
                    break;
                }
            }
            for &g in &groups {
                rates[g] = dot(&slip[g * p..(g + 1) * p], &tau);
                sizes[g] = dot_size(&slip[g * p..(g + 1) * p], &tau);
            }
            // Sides of what moves, at the torques found.
            let mut turned = false;
            for (j, e) in self.system.elements.iter().enumerate() {
                let sign = f64::from(mode.element_slip(&self.system, j));
                if e.group.is_none() {
                    continue;
                }
                let torque = torque_of(j, &tau, e.factors);
                let loss = self.loss(j);
                let sign = if sign == 0.0 {
                    let (g, factor) = e.group.expect("checked");
                    (rates[g] * factor).signum()
                } else {
                    sign
                };
                let value = sign * (loss.drive - loss.coast) * torque + loss.drive_torque - loss.coast_torque;
                let side = if value >= 0.0 { Side::Drive } else { Side::Coast };
                if side != mode.side[j] {
                    mode.side[j] = side;
                    turned |= mode.element_slip(&self.system, j) != 0;
                }
            }
            if !turned {
                break;
            }
        }
        for &g in &groups {
            if rates[g].abs() > 1e-8 * sizes[g] {
                mode.slip[g] = if rates[g] > 0.0 { 1 } else { -1 };
            }
        }
        mode
    }

    /// Amount of torque with which a friction element at rest opposes slip in a direction.
    fn capacity_of(&self, f: usize, sign: i8, t: f64) -> f64 {
        self.sliding(f, 0.0, sign, true, t).abs()
    }
}
