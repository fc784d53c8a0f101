//! What carries power in a state: unit torque at the input, no losses, driving.
//!
//! A mesh with force f takes z_1 f from its first gear, ± z_2 f from its second and the rest from its
//! carrier; a closed joint takes t from one member and gives it to the other. The torques on every
//! member add to zero. Power is torque times speed.

use willis::exact::Rational;
use willis::kinematics::Configuration;
use willis::train::{FRAME, MemberId, ShiftElementId, Train};
use willis::unstable;

/// Torque by where it acts; `None` where statics does not settle it.
type Torque = Option<Rational>;

pub(super) struct Load {
    /// Whether a state (or the train as drawn) with input and output is shown.
    pub shown: bool,
    /// Speed of each member over that of the input.
    pub speeds: Vec<Option<Rational>>,
    /// Power at first gear, second gear and carrier of each mesh: whether there is any.
    pub meshes: Vec<[Option<bool>; 3]>,
    /// Of each shift element, then each shaft.
    pub joints: Vec<[Option<bool>; 2]>,
    /// Of each member.
    pub members: Vec<Option<bool>>,
    /// Of each member: power from outside.
    pub outside: Vec<bool>,
    /// How much power, over that of the input, comes into first gear, second gear and carrier of each mesh from that mesh.
    pub from_meshes: Vec<[Option<f64>; 3]>,
    /// The same of each shift element, then each shaft.
    pub from_joints: Vec<[Option<f64>; 2]>,
    /// The same of each member, from outside.
    pub from_outside: Vec<Option<f64>>,
}

impl Load {
    pub fn new(train: &Train, state: Option<usize>) -> Self {
        let count = train.members().len();
        let joint_count = train.shift_elements().len() + train.shafts().len();
        let mut load = Self {
            shown: false,
            speeds: vec![None; count],
            meshes: vec![[None; 3]; train.meshes().len()],
            joints: vec![[None; 2]; joint_count],
            members: vec![None; count],
            outside: vec![false; count],
            from_meshes: vec![[None; 3]; train.meshes().len()],
            from_joints: vec![[None; 2]; joint_count],
            from_outside: vec![None; count],
        };
        if state.is_none() && !train.states().is_empty() {
            return load;
        }
        let own = state.map(|k| &train.states()[k]);
        let engaged: &[ShiftElementId] = own.map_or(&[], |s| &s.engaged);
        let [Some(input), Some(output)] = train.ends(state) else { return load };
        if input == output {
            return load;
        }
        let transfer = Configuration::new(train, engaged, &[], &[]).transfer(&[input]);
        if !transfer.conflicts.is_empty() {
            return load;
        }
        load.shown = true;
        load.speeds = transfer.speeds.into_iter().map(|s| s.map(|w| w[0].clone())).collect();
        load.torques(train, engaged, input, output);
        load
    }

    fn torques(&mut self, train: &Train, engaged: &[ShiftElementId], input: MemberId, output: MemberId) {
        let count = train.members().len();
        let meshes = train.meshes();
        // Columns: force of each mesh, torque of each closed joint, torque on the output.
        let joints: Vec<(usize, [MemberId; 2])> = (train.shift_elements().iter().enumerate())
            .filter(|(k, _)| engaged.iter().any(|e| e.index() == *k))
            .map(|(k, e)| (k, e.members))
            .chain(train.shafts().iter().enumerate().map(|(k, s)| (train.shift_elements().len() + k, s.members)))
            .collect();
        let columns = meshes.len() + joints.len() + 1;
        let mut rows = vec![vec![Rational::ZERO; columns + 1]; count];
        let parts: Vec<[(MemberId, Rational); 3]> = meshes
            .iter()
            .map(|m| {
                let first = m.gears[0].teeth.clone();
                let second = if m.same_sense { -m.gears[1].teeth.clone() } else { m.gears[1].teeth.clone() };
                let carrier = -(&first + &second);
                [(m.gears[0].member, first), (m.gears[1].member, second), (m.carrier, carrier)]
            })
            .collect();
        for (k, part) in parts.iter().enumerate() {
            part.iter().for_each(|(m, x)| rows[m.index()][k] += x.clone());
        }
        for (k, (_, [a, b])) in joints.iter().enumerate() {
            rows[a.index()][meshes.len() + k] += Rational::ONE;
            rows[b.index()][meshes.len() + k] += -Rational::ONE;
        }
        rows[output.index()][columns - 1] += -Rational::ONE;
        rows[input.index()][columns] = Rational::ONE;
        rows.remove(FRAME.index());
        let pivots = unstable::reduce(&mut rows, columns);
        if rows[pivots.len()..].iter().any(|r| !r[columns].is_zero()) {
            // No equilibrium: the output cannot take the load.
            return;
        }
        let mut found: Vec<Torque> = vec![None; columns];
        for (row, &column) in rows.iter().zip(&pivots) {
            if (0..columns).all(|c| c == column || row[c].is_zero()) {
                found[column] = Some(row[columns].clone());
            }
        }
        let power = |member: MemberId, torque: Option<&Rational>, factor: &Rational| -> Option<bool> {
            if member == FRAME || torque.is_some_and(Rational::is_zero) || factor.is_zero() {
                return Some(false);
            }
            let speed = self.speeds[member.index()].as_ref()?;
            if speed.is_zero() { Some(false) } else { torque.map(|_| true) }
        };
        for (k, part) in parts.iter().enumerate() {
            for (end, (m, factor)) in part.iter().enumerate() {
                self.meshes[k][end] = power(*m, found[k].as_ref(), factor);
            }
        }
        for (k, (joint, members)) in joints.iter().enumerate() {
            self.joints[*joint] = members.map(|m| power(m, found[meshes.len() + k].as_ref(), &Rational::ONE));
        }
        // What a mesh takes from a member does not come into it.
        let amount = |member: MemberId, torque: Option<&Rational>, factor: &Rational| -> Option<f64> {
            if member == FRAME || factor.is_zero() {
                return Some(0.0);
            }
            Some((torque?.clone() * factor.clone() * self.speeds[member.index()].clone()?).to_f64())
        };
        let meshes_found: Vec<[Option<f64>; 3]> = (parts.iter().enumerate())
            .map(|(k, part)| part.each_ref().map(|(m, z)| amount(*m, found[k].as_ref(), &-z.clone())))
            .collect();
        let joints_found: Vec<[Option<f64>; 2]> = (joints.iter().enumerate())
            .map(|(k, (_, [a, b]))| {
                let torque = found[meshes.len() + k].as_ref();
                [amount(*a, torque, &-Rational::ONE), amount(*b, torque, &Rational::ONE)]
            })
            .collect();
        let leaving = amount(output, found[columns - 1].as_ref(), &Rational::ONE);
        let entering = amount(input, Some(&Rational::ONE), &Rational::ONE);
        self.outside[input.index()] = power(input, Some(&Rational::ONE), &Rational::ONE) == Some(true);
        self.outside[output.index()] = power(output, found[columns - 1].as_ref(), &Rational::ONE) == Some(true);
        self.from_meshes = meshes_found;
        joints.iter().zip(joints_found).for_each(|((joint, _), found)| self.from_joints[*joint] = found);
        self.from_outside = vec![Some(0.0); count];
        (self.from_outside[input.index()], self.from_outside[output.index()]) = (entering, leaving);
        for m in 1..count {
            let mut all = vec![Some(self.outside[m])];
            for (k, part) in parts.iter().enumerate() {
                all.extend((0..3).filter(|&e| part[e].0.index() == m).map(|e| self.meshes[k][e]));
            }
            for (joint, members) in &joints {
                all.extend((0..2).filter(|&e| members[e].index() == m).map(|e| self.joints[*joint][e]));
            }
            self.members[m] = match all.contains(&Some(true)) {
                true => Some(true),
                false => all.iter().all(|p| *p == Some(false)).then_some(false),
            };
        }
    }
}
