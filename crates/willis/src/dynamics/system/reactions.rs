//! What holds the train from outside: the torques that the frame takes, in all and by member that is held.

use crate::kinematics::Configuration;
use crate::train::{FRAME, MemberId, Scenario, SourceKind};

use super::coordinates::Coordinates;
use super::frictions::{Friction, Rubs};
use super::paths::Path;

/// A torque from outside that follows from a balance: what accelerates inertia, less all other torques.
#[derive(Clone)]
pub(in crate::dynamics) struct Reaction {
    /// The member that is held; the frame stands for all of them and for whatever is borne by it.
    pub member: MemberId,
    /// Rate of angular momentum over the accelerations of the coordinates, kg m².
    pub momentum: Vec<f64>,
    /// Elements that take torque from it: position, part of the torque at the first gear, part of the loss there.
    pub elements: Vec<(usize, f64, f64)>,
    /// Friction elements that act on it, and on which side.
    pub frictions: Vec<(usize, f64)>,
    /// Shafts that act on it, and on which side.
    pub shafts: Vec<(usize, f64)>,
    /// Sources that act on it; machines act between their member and the frame.
    pub sources: Vec<usize>,
    /// Ports of variators on it.
    pub variators: Vec<usize>,
}

/// The frame's, then that of each member that the scenario holds.
pub(super) fn reactions(
    c: &Configuration<'_>,
    scenario: &Scenario,
    coordinates: &Coordinates,
    frictions: &[Friction],
    paths: &[Path],
    traces: &[(MemberId, f64)],
) -> Vec<Reaction> {
    let held = |&member: &MemberId| of_member(c, scenario, coordinates, frictions, paths, member);
    std::iter::once(of_frame(c, scenario, coordinates, traces)).chain(scenario.fixed.iter().map(held)).collect()
}

/// Inner torques come in pairs, so what the frame gives is the rate of all angular momentum less what sources give.
fn of_frame(
    c: &Configuration<'_>,
    scenario: &Scenario,
    coordinates: &Coordinates,
    traces: &[(MemberId, f64)],
) -> Reaction {
    let mut momentum = vec![0.0; coordinates.all()];
    for i in c.train.inertias() {
        // Measured against another member, it passes on to that one what it takes.
        for (member, other) in [(i.member, i.reference), (i.reference, i.member)] {
            if other == FRAME {
                add(&mut momentum, i.value, &coordinates.speeds[member.index()]);
            }
        }
    }
    for (member, value) in traces {
        add(&mut momentum, *value, &coordinates.speeds[member.index()]);
    }
    for source in &scenario.sources {
        if let SourceKind::Vehicle { mass, wheel_radius, final_drive, .. } = &source.kind {
            let arm = wheel_radius / final_drive;
            add(&mut momentum, mass * arm * arm, &coordinates.speeds[source.member.index()]);
        }
    }
    Reaction {
        member: FRAME,
        momentum,
        elements: vec![],
        frictions: vec![],
        shafts: vec![],
        sources: (0..scenario.sources.len()).filter(|&k| scenario.sources[k].machine.is_none()).collect(),
        variators: vec![],
    }
}

fn of_member(
    c: &Configuration<'_>,
    scenario: &Scenario,
    coordinates: &Coordinates,
    frictions: &[Friction],
    paths: &[Path],
    member: MemberId,
) -> Reaction {
    let side = |members: [MemberId; 2]| -> f64 {
        f64::from(u8::from(members[0] == member)) - f64::from(u8::from(members[1] == member))
    };
    let is = |m: MemberId| f64::from(u8::from(m == member));
    let mut momentum = vec![0.0; coordinates.all()];
    for i in c.train.inertias() {
        let sign = side([i.member, i.reference]);
        if sign != 0.0 {
            add(&mut momentum, sign * i.value, &coordinates.slip([i.member, i.reference]));
        }
    }
    let elements = (c.elements.iter().enumerate())
        .map(|(j, e)| {
            let ratio = (&e.b / &e.a).to_f64();
            let (force, loss) =
                (is(e.p) + ratio * is(e.q) - (1.0 + ratio) * is(e.carrier), ratio * (is(e.carrier) - is(e.q)));
            (j, force, loss)
        })
        .filter(|(_, force, loss)| (*force, *loss) != (0.0, 0.0));
    let acting = (frictions.iter().enumerate())
        .filter(|(_, f)| !matches!(f.what, Rubs::Rolling(_)))
        .map(|(k, f)| (k, side(f.members)));
    let shafts = c.train.shafts().iter().enumerate().map(|(k, s)| (k, side(s.members)));
    Reaction {
        member,
        momentum,
        elements: elements.collect(),
        frictions: acting.filter(|(_, side)| *side != 0.0).collect(),
        shafts: shafts.filter(|(_, side)| *side != 0.0).collect(),
        sources: (0..scenario.sources.len()).filter(|&k| scenario.sources[k].member == member).collect(),
        variators: paths.iter().flat_map(Path::ports).filter(|(m, _)| *m == member).map(|(_, port)| port).collect(),
    }
}

fn add(sum: &mut [f64], factor: f64, row: &[f64]) {
    sum.iter_mut().zip(row).for_each(|(sum, x)| *sum += factor * x);
}
