//! Mesh elements: what a gear pair, or a chain of them, loses, and how that divides among its meshes.

use crate::kinematics::Link;
use crate::train::{LossRow, MeshId, Train};

/// Part of its power up to which the certificates of unique forces let a mesh under a law lose: several times what
/// good gears do.
pub(super) const MOST_LOST: f64 = 0.1;

/// A mesh element: one gear pair, or a chain of them.
#[derive(Clone)]
pub(super) struct Element {
    pub links: Vec<Link>,
    /// `a` and `b` of its Willis equation.
    pub factors: [f64; 2],
    /// Rows of losses by amount of speed; one row where they are constant, and where they follow a law, as the
    /// most that it may lose.
    pub rows: Vec<LossRow>,
    /// Its mesh, if its loss follows a law.
    pub law: Option<MeshId>,
    /// Speed of the first gear relative to the carrier over the coordinates.
    pub row: Vec<f64>,
    /// Its group and its speed over that of the group; `None` if it loses nothing or never moves.
    pub group: Option<(usize, f64)>,
    pub port: usize,
    /// How its loss divides among its meshes when its first gear drives and when the second does: mesh and part.
    pub shares: [Vec<(usize, f64)>; 2],
    /// What its torque becomes from mesh to mesh.
    pub passes: Vec<Pass>,
}

/// A mesh of an element: what leaves it for what enters it.
#[derive(Clone, Copy)]
pub(super) struct Pass {
    pub mesh: usize,
    /// Whether it is passed from its first gear to its second.
    pub along: bool,
    /// Torque behind it over that before it, without loss.
    ratio: f64,
    /// Its efficiency when its first gear drives, and when its second does; 1 where it is an element alone.
    efficiency: [f64; 2],
}

impl Pass {
    pub fn of(train: &Train, links: &[Link]) -> Vec<Self> {
        let pass = |link: &Link| {
            let mesh = &train.meshes()[link.mesh.index()];
            let (from, to) = if link.along { (0, 1) } else { (1, 0) };
            let ratio = (&mesh.gears[to].teeth / &mesh.gears[from].teeth).to_f64();
            let own = &mesh.efficiency;
            Self {
                mesh: link.mesh.index(),
                along: link.along,
                ratio: if mesh.same_sense { -ratio } else { ratio },
                efficiency: if links.len() == 1 { [1.0; 2] } else { [own.forward.to_f64(), own.backward.to_f64()] },
            }
        };
        links.iter().map(pass).collect()
    }

    /// The torque behind it; `drive` if the first gear of the element drives.
    pub fn exit(&self, entry: f64, drive: bool, at_rest: bool) -> f64 {
        let efficiency = if at_rest { 1.0 } else { self.efficiency[usize::from(self.along != drive)] };
        self.ratio * entry * if drive { efficiency } else { 1.0 / efficiency }
    }
}

/// Part of each mesh of a chain in the loss of all: the power that reaches it, less what leaves it.
pub(super) fn shares(train: &Train, links: &[Link]) -> [Vec<(usize, f64)>; 2] {
    [true, false].map(|drive| {
        let mut reaches = 1.0;
        let mut parts: Vec<(usize, f64)> = Vec::new();
        let order: Vec<&Link> = if drive { links.iter().collect() } else { links.iter().rev().collect() };
        for link in order {
            let own = &train.meshes()[link.mesh.index()].efficiency;
            let efficiency = if link.along == drive { own.forward.to_f64() } else { own.backward.to_f64() };
            parts.push((link.mesh.index(), reaches * (1.0 - efficiency)));
            reaches *= efficiency;
        }
        let whole: f64 = parts.iter().map(|p| p.1).sum();
        let alone = 1.0 / parts.len() as f64;
        parts.iter().map(|&(mesh, part)| (mesh, if whole > 0.0 { part / whole } else { alone })).collect()
    })
}

/// Efficiency and bearing torque of an element at a speed.
#[derive(Clone, Copy)]
pub(super) struct Loss {
    /// Slope of the loss over the torque at the first gear when that gear drives, `1 − η`.
    pub drive: f64,
    /// The same when the second gear drives, `1 − 1/η`.
    pub coast: f64,
    pub drive_torque: f64,
    pub coast_torque: f64,
}

impl Element {
    pub fn is_lossless(&self) -> bool {
        self.rows
            .iter()
            .all(|r| r.forward == 1.0 && r.backward == 1.0 && r.forward_torque == 0.0 && r.backward_torque == 0.0)
    }

    /// Whether its slopes depend on its speed or load.
    pub fn varies(&self) -> bool {
        self.law.is_some()
            || self.rows.windows(2).any(|w| (w[0].forward, w[0].backward) != (w[1].forward, w[1].backward))
    }

    /// Losses at an amount of speed: straight between rows; those of the last row beyond it.
    pub fn loss(&self, speed: f64) -> Loss {
        let rows = &self.rows;
        let row = if rows.len() == 1 {
            rows[0]
        } else {
            let k = rows.partition_point(|r| r.speed <= speed).clamp(1, rows.len() - 1);
            let (a, b) = (rows[k - 1], rows[k]);
            let part = ((speed - a.speed) / (b.speed - a.speed)).clamp(0.0, 1.0);
            let mix = |x: f64, y: f64| x + part * (y - x);
            LossRow {
                speed,
                forward: mix(a.forward, b.forward),
                backward: mix(a.backward, b.backward),
                forward_torque: mix(a.forward_torque, b.forward_torque),
                backward_torque: mix(a.backward_torque, b.backward_torque),
            }
        };
        Loss {
            drive: 1.0 - row.forward,
            coast: 1.0 - 1.0 / row.backward,
            drive_torque: row.forward_torque,
            coast_torque: row.backward_torque,
        }
    }
}

/// The name of a mesh, or of the set of a chain.
pub(super) fn element_name(train: &Train, links: &[Link]) -> String {
    let first = &train.meshes()[links[0].mesh.index()];
    match (links, first.set) {
        ([_], _) => first.name.clone(),
        (_, Some(set)) => format!("{} ({} meshes)", train.sets()[set].name, links.len()),
        _ => links.iter().map(|l| train.meshes()[l.mesh.index()].name.as_str()).collect::<Vec<_>>().join("+"),
    }
}
