//! The energies of steps that go on in one mode: what they leave on their trail, and what that is worth.

use crate::dynamics::mode::{Side, slope};
use crate::dynamics::system::Rubs;
use crate::train::SourceKind;

use super::FixedStep;
use super::groups::LEAST_UNBOUNDED;
use super::trail::{Book, Of, STEPS, Sums, Trail};

impl FixedStep {
    /// Leaves what the step that goes on from the present speeds is made of.
    #[inline(never)]
    pub(super) fn leave(&mut self) {
        let Trail { numbers, steps, .. } = &mut self.trail;
        let at = *steps % STEPS;
        let (speeds, inputs) = numbers.split_at_mut(self.v.len());
        speeds.iter_mut().zip(&self.v).for_each(|(row, v)| row[at] = *v);
        inputs.iter_mut().zip(&self.varying).for_each(|(row, k)| row[at] = self.inputs[*k]);
        *steps += 1;
        if *steps == STEPS {
            self.audit();
        }
    }

    /// Ends the trail: the mode or what is level is about to change.
    pub(super) fn end_trail(&mut self) {
        self.audit();
        self.trail.is_ready = false;
    }

    /// Books what the steps so far have left.
    #[cold]
    #[inline(never)]
    pub(super) fn audit(&mut self) {
        if self.trail.steps == 0 {
            return;
        }
        let mut trail = std::mem::take(&mut self.trail);
        if !trail.is_ready {
            self.open_accounts(&mut trail);
            trail.is_ready = true;
        }
        let s = &self.engine.system;
        let (all, width) = (s.all(), s.all() + self.varying.len() + 1);
        trail.numbers[width - 1].fill(1.0);
        trail.numbers[..width].iter_mut().for_each(|row| row[trail.steps..].fill(0.0));
        // Prescribed speeds by their accelerations.
        let (speeds, inputs) = trail.numbers.split_at_mut(all);
        for (row, k) in inputs.iter_mut().zip(&self.varying) {
            if let Some(i) = s.drivers.get(*k).and_then(|driver| driver.prescribed) {
                row.iter_mut().zip(&speeds[s.free + i]).for_each(|(end, start)| *end = (*end - start) / self.h);
            }
        }
        self.arch.dispatch(Book {
            trail: &trail,
            h: self.h,
            s,
            side: &self.side,
            energies: &mut self.energies,
            came_in: &mut self.came_in,
        });
        trail.steps = 0;
        self.trail = trail;
    }

    /// Finds what torques and mean speeds are in the present mode.
    fn open_accounts(&self, trail: &mut Trail) {
        trail.accounts.clear();
        trail.terms.clear();
        let Some((_, map)) = self.last else { return };
        let map = &self.maps[map as usize];
        let s = &self.engine.system;
        let (free, all, cols) = (s.free, s.all(), self.tau.len());
        let (drivers, frictions) = (s.drivers.len(), s.frictions.len());
        let one = all + self.varying.len();
        let width = one + 1;
        self.sum_torques(&mut trail.torques, width);
        trail.accelerations.clear(all, width);
        for (i, row) in map.rows[..free * cols].chunks_exact(cols).enumerate() {
            trail.torques.add_to(trail.accelerations.row_mut(i), row, 1.0);
        }
        for i in 0..s.prescribed {
            trail.accelerations.row_mut(free + i).copy_from_slice(trail.torques.row(s.port_of_prescribed + i));
        }
        // The speed half way through the step, of what is a sum over the coordinates.
        let mean = |trail: &mut Trail, row: &[f64]| {
            trail.speed.clear();
            trail.speed.extend_from_slice(row);
            trail.speed.resize(width, 0.0);
            trail.accelerations.add_to(&mut trail.speed, row, 0.5 * self.h);
        };
        let torque_of = |trail: &mut Trail, port: usize, factor: f64| {
            trail.torque.clear();
            trail.torque.extend(trail.torques.row(port).iter().map(|x| factor * x));
        };
        for (k, (driver, source)) in s.drivers.iter().zip(&s.scenario.sources).enumerate() {
            let row = &s.speeds[driver.member.index()];
            match driver.prescribed {
                Some(i) => {
                    trail.torque.clear();
                    trail.torque.resize(width, 0.0);
                    trail.torques.add_to(&mut trail.torque, &map.reactions[i * cols..(i + 1) * cols], 1.0);
                }
                None => torque_of(trail, driver.port.expect("a torque"), 1.0),
            }
            if let SourceKind::Controller { derivative, .. } = &source.kind {
                trail.accelerations.add_to(&mut trail.torque, row, -derivative);
            }
            if let Some(f) = driver.rolling {
                let rolling = trail.torques.row(s.frictions[f].port);
                trail.torque.iter_mut().zip(rolling).for_each(|(sum, x)| *sum += x);
            }
            mean(trail, row);
            trail.open(Of::Source(k));
        }
        for (k, f) in s.frictions.iter().enumerate() {
            let is_held = f.group.is_some_and(|(g, _)| self.sign[g] == 0 && !self.groups[g].driven);
            if !is_held && !matches!(f.what, Rubs::Rolling(_)) {
                torque_of(trail, f.port, -1.0);
                mean(trail, &f.row);
                trail.open(Of::Loss(drivers + k));
            }
        }
        for (k, e) in s.elastic.iter().enumerate() {
            let [twist, rate, constant] = self.shafts[k].damper();
            mean(trail, &e.row);
            // Its rate at the end of the step is as far beyond the mean as that is beyond the one before.
            trail.torque.clear();
            trail.torque.extend(trail.speed.iter().map(|x| 2.0 * rate * x));
            trail.torque.iter_mut().zip(&e.row).for_each(|(sum, x)| *sum -= rate * x);
            self.add_input(&mut trail.torque, drivers + frictions + k, twist);
            trail.torque[one] += constant;
            trail.open(Of::Loss(drivers + frictions + k));
        }
        let moving = map.rows[(free + map.held.len()) * cols..].chunks_exact(cols);
        for (&j, row) in map.moving.iter().zip(moving) {
            let j = usize::from(j);
            let (_, _, loss) = self.teeth[j];
            torque_of(trail, s.elements[j].port, 1.0);
            trail.torques.add_to(&mut trail.torque, row, slope(loss, self.side[j]));
            mean(trail, &s.elements[j].row);
            trail.open(Of::Element(j));
        }
    }

    /// Adds a multiple of an input to a sum.
    fn add_input(&self, sum: &mut [f64], k: usize, factor: f64) {
        let all = self.v.len();
        match self.varying.iter().position(|varies| *varies == k) {
            Some(at) => sum[all + at] += factor,
            None => sum[all + self.varying.len()] += factor * self.inputs[k],
        }
    }

    /// The torques of the ports, and the slips that a step takes away, as they are in the present mode.
    fn sum_torques(&self, torques: &mut Sums, width: usize) {
        let s = &self.engine.system;
        let (drivers, frictions, one) = (s.drivers.len(), s.frictions.len(), width - 1);
        torques.clear(self.tau.len(), width);
        for (k, driver) in s.drivers.iter().enumerate() {
            match driver.prescribed {
                // What is level does not accelerate.
                Some(_) if !self.varying.contains(&k) => {}
                Some(i) => self.add_input(torques.row_mut(s.port_of_prescribed + i), k, 1.0),
                None => self.add_input(torques.row_mut(driver.port.expect("a torque")), k, 1.0),
            }
        }
        let add = |sum: &mut [f64], row: &[f64], factor: f64| {
            sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
        };
        for f in s.frictions.iter().filter(|f| f.viscous != 0.0) {
            add(torques.row_mut(f.port), &f.row, -f.viscous);
        }
        for (k, e) in s.elastic.iter().enumerate() {
            let [spring, damper, constant] = self.shafts[k].resists();
            let torque = torques.row_mut(e.port);
            self.add_input(torque, drivers + frictions + k, -spring);
            add(torque, &e.row, -damper);
            torque[one] -= constant;
        }
        for (g, group) in self.groups.iter().enumerate() {
            let sign = f64::from(self.sign[g]);
            if sign == 0.0 {
                // At rest before the step: it only follows what is prescribed.
                for (i, part) in group.row[s.free..].iter().enumerate() {
                    for k in 0..width {
                        let acceleration = torques.row(s.port_of_prescribed + i)[k];
                        torques.row_mut(s.ports + g)[k] += part * acceleration;
                    }
                }
                continue;
            }
            let is_open = |k: usize| self.inputs[drivers + k].abs() < LEAST_UNBOUNDED;
            for rub in group.rubs.iter().filter(|rub| !rub.is_rigid && is_open(rub.friction)) {
                let along = -sign * rub.factor.signum();
                self.add_input(torques.row_mut(rub.port), drivers + rub.friction, along);
            }
            for &(j, port, [drive, coast]) in &group.constants {
                let (_, factor, _) = self.teeth[j];
                torques.row_mut(port)[one] +=
                    sign * factor.signum() * if self.side[j] == Side::Drive { drive } else { coast };
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::train::Train;

    const SET: &str = r#"
        format = 1
        name = "a set"
        members = ["sun", "ring", "carrier"]
        terminals = ["sun", "carrier"]
        inertias = { sun = "0.05 kg m^2", ring = "0.2 kg m^2", carrier = "0.4 kg m^2" }
        [[set]]
        name = "P"
        sun = { member = "sun", teeth = 30 }
        planet = { teeth = 20, count = 4 }
        ring = { member = "ring", teeth = 70 }
        carrier = "carrier"
        mesh_efficiency = { external = 0.985, internal = 0.99 }
    "#;

    /// A brake that slips twice a period, and a bearing.
    const PULSES: &str = r#"
        [[shift_element]]
        name = "brake"
        kind = "brake"
        members = ["ring"]
        capacity = "400 N m"
        [[drag]]
        name = "bearing"
        members = ["carrier"]
        coulomb = "0.5 N m"
        viscous = "3 N m s/rad"
        [[scenario]]
        name = "run"
        duration = "2 s"
        initial_speeds = { sun = "100 rad/s", carrier = "0 rad/s" }
        engagement = [{ element = "brake", value = 1 }]
        [[scenario.source]]
        name = "engine"
        member = "sun"
        torque = { type = "sine", offset = "60 N m", amplitude = "200 N m", frequency = "2 Hz" }
    "#;

    /// A speed that swings drives a vehicle through an elastic shaft with backlash; the ring is braked with slip.
    const DRIVEN: &str = r#"
        [[shift_element]]
        name = "brake"
        kind = "brake"
        members = ["ring"]
        friction = [["0 rad/s", 0.3], ["20 rad/s", 0.4]]
        normal_force = "2 kN"
        effective_radius = "0.1 m"
        peak = 1.2
        [[drag]]
        name = "bearing"
        members = ["carrier", "ring"]
        coulomb = "2 N m"
        viscous = "0.3 N m s/rad"
        [[scenario]]
        name = "run"
        duration = "2 s"
        engagement = [{ element = "brake", value = { type = "sine", offset = 0.6, amplitude = 0.3, frequency = "3 Hz" } }]
        [[scenario.source]]
        name = "motor"
        member = "sun"
        speed = { type = "sine", offset = "60 rad/s", amplitude = "70 rad/s", frequency = "1 Hz" }
        [[scenario.source]]
        name = "car"
        member = "carrier"
        vehicle = { mass = "40 kg", wheel_radius = "0.3 m", rolling = 0.02, drag_area = "0.7 m^2", grade = { type = "sine", amplitude = 0.1, frequency = "0.5 Hz" } }
    "#;

    const SHAFT: &str = r#"
        format = 1
        name = "a load behind a shaft"
        members = ["motor", "middle", "load"]
        terminals = ["motor", "load"]
        inertias = { motor = "0.05 kg m^2", middle = "0.02 kg m^2", load = "0.4 kg m^2" }
        [[shaft]]
        name = "first"
        members = ["motor", "middle"]
        stiffness = "300 N m/rad"
        damping = "1 N m s/rad"
        backlash = "2 deg"
        [[shaft]]
        name = "second"
        members = ["middle", "load"]
        stiffness = "500 N m/rad"
        damping = "2 N m s/rad"
        backlash = "1 deg"
        contact = "soft"
        [[drag]]
        name = "bearing"
        members = ["load"]
        coulomb = "4 N m"
        viscous = "0.1 N m s/rad"
        [[scenario]]
        name = "run"
        duration = "4 s"
        [[scenario.source]]
        name = "motor"
        member = "motor"
        controller = { setpoint = { type = "sine", amplitude = "30 rad/s", frequency = "0.7 Hz" }, proportional = "2 N m s/rad", integral = "5 N m/rad", derivative = "0.01 N m s^2/rad" }
    "#;

    /// What the steps that go on in their mode book is what each of them books by itself, and it is all there is.
    #[test]
    fn a_trail_books_what_its_steps_do() {
        let set = |more: &str| format!("{SET}{more}");
        // Teeth that hold, and losses beside the load; efficiencies that do not follow the speed.
        let lossy_gear = include_str!("examples/lossy-gear.toml")
            .replace("forward = 0.95, backward = 0.94", "forward = 0.90, backward = 0.88")
            .replace("forward = 0.97, backward = 0.96", "forward = 0.90, backward = 0.88");
        let cases = [
            (set(PULSES), "run", 1e-3, true),
            (set(PULSES), "run", 1e-5, true),
            (set(DRIVEN), "run", 1e-3, true),
            (SHAFT.to_owned(), "run", 1e-3, false),
            (include_str!("examples/galvagno.toml").to_owned(), "two controllers and a load", 1e-4, true),
            (include_str!("examples/galvagno.toml").to_owned(), "load taken off", 1e-3, true),
            (include_str!("examples/shift-8hp70.toml").to_owned(), "", 1e-3, true),
            (include_str!("examples/launch.toml").to_owned(), "", 1e-3, false),
            (lossy_gear, "", 1e-3, true),
        ];
        for (text, scenario, h, closes) in cases {
            let train = Train::from_toml(&text).unwrap_or_else(|e| panic!("{e}"));
            let scenario = if scenario.is_empty() { &train.scenarios()[0].name } else { scenario };
            let place = format!("{}, {scenario}, steps of {h} s", train.name());
            let mut run = FixedStep::new(&train, scenario, h).unwrap_or_else(|e| panic!("{e}"));
            run.with_energies();
            let mut alone = run.clone();
            let mut x = vec![];
            run.copy_to_engine(&mut x);
            let before = run.engine.stored(&x);
            let steps = run.steps().min(50_000);
            for _ in 0..steps {
                // From the same state, settled anew.
                alone.v.clone_from(&run.v);
                alone.rest.clone_from(&run.rest);
                alone.sign.clone_from(&run.sign);
                alone.side.clone_from(&run.side);
                alone.shafts.clone_from(&run.shafts);
                alone.present = None;
                run.step();
                alone.step();
                assert_eq!(run.verdict, None, "{place}");
            }
            run.copy_to_engine(&mut x);
            alone.audit();
            let turned: f64 = run.came_in.iter().sum::<f64>() + before;
            assert!(turned > 1.0 && run.settled < steps / 2, "{place}: {turned} J, {} steps settle", run.settled);
            let books = [(&run.energies, &alone.energies), (&run.came_in, &alone.came_in)];
            for (k, (ours, theirs)) in books.iter().flat_map(|(a, b)| a.iter().zip(*b)).enumerate() {
                let off = (ours - theirs).abs() / turned;
                assert!(off < 1e-12, "{place}: energy {k} is {ours} J, not {theirs} J");
            }
            let sources = run.came_in.len();
            let net: f64 = run.energies[..sources].iter().sum();
            let lost: f64 = run.energies[sources..].iter().sum();
            let residual = (net - lost - (run.engine.stored(&x) - before)) / turned;
            assert!(!closes || residual.abs() < 1e-12, "{place}: residual {residual:.1e}");
        }
    }
}
