//! Answers of a train that is compiled once, where its efficiencies are constants and speeds and torques vary.
//!
//! What a point costs is then a few multiplications instead of an elimination with fractions. The numbers are those of the
//! long way to a part in 10¹². Whatever is not plain is asked the long way: points that have not exactly one equilibrium, that
//! lie on a border, or that differ from the first answer in what stands still.

use willis::compiled::{CompileRequest, CompiledOutput, CompiledTrain, PointVerdict as Compiled, Workspace};
use willis::model::{ShaftRef, Target};
use willis::study::{PointAnswer, PointVerdict};
use willis::train::{FRAME, Load, MemberId, Operation, ShiftElementKind, Train};
use willis::unstable;

use super::told::{PowerRole, Told, ways};

/// Powers below this part of the largest may be round-off.
const ROUND_OFF: f64 = 1e-9;

/// What is prescribed at a place of the map.
struct Prescribed {
    /// The axis along which it varies.
    axis: Option<usize>,
    /// The value, or its multiple of the place on that axis.
    value: f64,
}

impl Prescribed {
    fn at(&self, place: &[f64]) -> f64 {
        self.axis.map_or(1.0, |a| place[a]) * self.value
    }
}

/// A member or mesh whose power may turn round.
struct Part {
    /// Columns whose product is its power: torque, speed, and the speed of its carrier.
    torque: usize,
    speed: usize,
    carrier: Option<usize>,
    /// What it is where its power is positive, and negative.
    ways: [PowerRole; 2],
    /// Its place among all ways.
    place: usize,
    /// It neither took nor gave power in the first answer.
    idle: bool,
}

/// A train in one state, for places in one quadrant of the map.
pub struct CompiledProbe {
    train: CompiledTrain,
    work: Workspace,
    speeds: Vec<Prescribed>,
    torques: Vec<Prescribed>,
    parts: Vec<Part>,
    /// How many of them are terminals.
    terminals: usize,
    /// The ways of the first answer.
    first: Vec<PowerRole>,
    /// The speed and the torque of the input, as columns.
    input: Option<[usize; 2]>,
    out: Vec<f64>,
}

impl CompiledProbe {
    /// Compiles what was asked at a place along these axes and has this answer; none where that cannot be, or does not agree.
    pub fn new(
        train: &Train,
        operation: &Operation,
        axes: &[&Target],
        place: &[f64],
        answer: &PointAnswer,
        input: Option<MemberId>,
    ) -> Option<Self> {
        let varies = |t: &Target| matches!(t, Target::Speed(_) | Target::Torque(_));
        let one_way = train.shift_elements().iter().any(|e| e.kind == ShiftElementKind::OneWay);
        if train.is_physical()
            || one_way
            || !train.variators().is_empty()
            || !answer.is_unique()
            || !axes.iter().all(|a| varies(a))
        {
            return None;
        }
        let moving = operation.speeds.iter().filter(|s| s.1.si() != 0.0).count();
        let [train_input, train_output] = train.ends(operation.state);
        let axis_of = |member: MemberId, speed: bool| -> Option<Option<usize>> {
            for (k, target) in axes.iter().enumerate() {
                let who = match *target {
                    Target::Speed(who) if speed => who,
                    Target::Torque(who) if !speed => who,
                    _ => continue,
                };
                let named = match who {
                    ShaftRef::Member(m) => Some(*m),
                    ShaftRef::Input => train_input,
                    ShaftRef::Output => train_output,
                };
                if named == Some(member) {
                    // A torque that drives turns with its member: within a quadrant it does not where one speed moves all.
                    let turns = !speed && !matches!(who, ShaftRef::Member(_)) && moving > 1;
                    return if turns { None } else { Some(Some(k)) };
                }
            }
            Some(None)
        };
        let prescribed = |member: MemberId, si: f64, speed: bool| {
            let axis = axis_of(member, speed)?;
            let value = axis.map_or(si, |a| si / place[a]);
            value.is_finite().then_some(Prescribed { axis, value })
        };
        let speeds = operation.speeds.iter().map(|(m, q)| prescribed(*m, q.si(), true)).collect::<Option<Vec<_>>>()?;
        let torque = |(m, load): &(MemberId, Load)| match load {
            Load::Torque(q) => prescribed(*m, q.si(), false),
            Load::Power(_) => None,
        };
        let torques = operation.loads.iter().map(torque).collect::<Option<Vec<_>>>()?;
        // All axes must be among them.
        let seen = |k: usize| speeds.iter().chain(&torques).any(|p| p.axis == Some(k));
        if !(0..axes.len()).all(seen) {
            return None;
        }

        let mut outputs = vec![CompiledOutput::Efficiency, CompiledOutput::Loss];
        let mut column = |o: CompiledOutput| {
            outputs.iter().position(|own| *own == o).unwrap_or_else(|| {
                outputs.push(o);
                outputs.len() - 1
            })
        };
        let name = |m: MemberId| train.member_name(m).to_owned();
        let solution = answer.solution.as_ref()?;
        let first = ways(answer);
        let mut parts = vec![];
        for &m in train.terminals() {
            let place = solution.members.iter().position(|(n, _)| *n == train.member_name(m))?;
            parts.push(Part {
                torque: column(CompiledOutput::Torque(name(m))),
                speed: column(CompiledOutput::Speed(name(m))),
                carrier: None,
                ways: [PowerRole::Input, PowerRole::Output],
                place,
                idle: !matches!(first[place], PowerRole::Input | PowerRole::Output),
            });
        }
        let terminals = parts.len();
        let members = solution.members.0.len();
        for chain in unstable::chains(train, operation) {
            let leading = train.meshes().get(chain[0].index())?;
            let torque = column(CompiledOutput::MeshTorque(leading.name.clone()));
            let speed = column(CompiledOutput::Speed(name(leading.gears[0].member)));
            let carrier = (leading.carrier != FRAME).then(|| column(CompiledOutput::Speed(name(leading.carrier))));
            // Power runs through all meshes of a chain the same way: as in the first answer, or against it.
            let mut turned = None;
            for mesh in chain.iter().map(|m| &train.meshes()[m.index()]) {
                let place = members + solution.meshes.iter().position(|(n, _)| *n == mesh.name)?;
                let [driving, driven] = mesh.gears.each_ref().map(|g| PowerRole::Driver(g.member));
                let idle = first[place] == PowerRole::Idle;
                let turned = *turned.get_or_insert(first[place] == driven);
                let ways = match (first[place] == driving, turned) {
                    _ if idle => [driving, driven],
                    (true, false) | (false, true) => [driving, driven],
                    _ => [driven, driving],
                };
                parts.push(Part { torque, speed, carrier, ways, place, idle });
            }
        }
        if parts.len() != terminals + train.meshes().len() {
            return None;
        }
        let input = input.map(|m| [column(CompiledOutput::Speed(name(m))), column(CompiledOutput::Torque(name(m)))]);
        let names = |all: Vec<MemberId>| all.into_iter().map(name).collect::<Vec<_>>();
        let given = [
            names(operation.speeds.iter().map(|s| s.0).collect()),
            names(operation.loads.iter().map(|l| l.0).collect()),
        ];
        let [given_speeds, given_torques] = given.each_ref().map(|g| g.iter().map(String::as_str));
        let mut duty = CompileRequest::new(given_speeds, given_torques);
        if let Some(k) = operation.state {
            duty = duty.state(&train.states()[k].name);
        }
        for m in &operation.fixed {
            duty = duty.fixed(train.member_name(*m));
        }
        let out = vec![0.0; outputs.len()];
        let compiled = outputs.into_iter().fold(duty, CompileRequest::output);
        let train = train.compile(&compiled).ok()?;
        let work = train.workspace();
        let mut own = Self { train, work, speeds, torques, parts, terminals, first, input, out };
        let told = own.at(place)?;
        let close = |a: Option<f64>, b: Option<f64>| match (a, b) {
            (Some(a), Some(b)) => (a - b).abs() <= ROUND_OFF * b.abs().max(1e-300),
            _ => a == b,
        };
        let same = told.ways == own.first
            && close(told.efficiency, solution.efficiency)
            && close(told.input_power_w, Some(solution.input_power_w));
        same.then_some(own)
    }

    /// The answer at a place, of which no quantity has another sign than at the first; none where only the long way has it.
    pub fn at(&mut self, place: &[f64]) -> Option<Told> {
        let mut given = [[0.0; 16]; 2];
        let [speeds, torques] = &mut given;
        let (speeds, torques) = (speeds.get_mut(..self.speeds.len())?, torques.get_mut(..self.torques.len())?);
        speeds.iter_mut().zip(&self.speeds).for_each(|(x, p)| *x = p.at(place));
        torques.iter_mut().zip(&self.torques).for_each(|(x, p)| *x = p.at(place));
        let out = &mut self.out;
        let verdict = self.train.evaluate(speeds, torques, &mut self.work, out);
        let speed = |p: &Part| out[p.speed] - p.carrier.map_or(0.0, |c| out[c]);
        let without = match verdict {
            Compiled::Unique => None,
            Compiled::Locked => Some(PointVerdict::Locked),
            Compiled::Multiple => Some(PointVerdict::Multiple),
            _ => return None,
        };
        if let Some(verdict) = without {
            // Away from where something stands still or is not loaded.
            let largest = self.parts.iter().map(|p| out[p.speed].abs()).fold(0.0, f64::max);
            let moves = self.parts.iter().all(|p| p.idle || speed(p).abs() > ROUND_OFF * largest);
            let loaded = torques.iter().any(|t| t.abs() > ROUND_OFF);
            let none = None;
            let (efficiency, input_power_w, loss_w, input) = (none, none, none, None);
            return (moves && loaded).then(|| Told { verdict, efficiency, input_power_w, loss_w, input, ways: vec![] });
        }
        let power = |p: &Part| out[p.torque] * speed(p);
        let (ends, meshes) = self.parts.split_at(self.terminals);
        let mut found = self.first.clone();
        let mut input_power = 0.0;
        for of in [ends, meshes] {
            let largest = of.iter().map(|p| power(p).abs()).fold(0.0, f64::max);
            for p in of {
                let w = power(p);
                // Round-off, or a border; written so that what is no number is asked the long way too.
                let plain = w.abs() > ROUND_OFF * largest;
                match (plain, p.idle) {
                    (true, false) => found[p.place] = p.ways[usize::from(w < 0.0)],
                    (false, true) => {}
                    _ => return None,
                }
            }
        }
        for p in ends {
            input_power += power(p).max(0.0);
        }
        let [efficiency, loss] = [out[0], out[1]];
        (efficiency > 0.0).then(|| Told {
            verdict: PointVerdict::Unique,
            efficiency: Some(efficiency),
            input_power_w: Some(input_power),
            loss_w: Some(loss),
            input: self.input.map(|[speed, torque]| [out[speed], out[torque]]),
            ways: found,
        })
    }
}
