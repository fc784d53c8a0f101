//! Inertia: over the nodes, over the coordinates, and where there is none.

use nalgebra::{DMatrix, DVector};

use crate::diagnostic::{Code, Diagnostic, Diagnostics};
use crate::dynamics::decision::Inertia;
use crate::kinematics::Configuration;
use crate::train::{FRAME, MemberId, Scenario, Train};

use super::coordinates::Coordinates;
use super::ports::on_nodes;

/// Inertia matrices over the nodes.
pub(super) struct NodeInertia<'c> {
    configuration: &'c Configuration<'c>,
    /// What stores kinetic energy.
    pub real: DMatrix<f64>,
    /// What accelerations feel: the same, with what controllers add.
    pub felt: DMatrix<f64>,
    /// That one by one.
    pub parts: Vec<Inertia>,
    /// Members whose relative speeds it acts on.
    pub pairs: Vec<[MemberId; 2]>,
}

impl<'c> NodeInertia<'c> {
    /// That of the members.
    pub fn of(configuration: &'c Configuration<'c>) -> Self {
        let nodes = configuration.nodes;
        let mut all = Self {
            configuration,
            real: DMatrix::zeros(nodes, nodes),
            felt: DMatrix::zeros(nodes, nodes),
            parts: Vec::new(),
            pairs: Vec::new(),
        };
        for i in configuration.train.inertias() {
            let added = all.feel([i.member, i.reference], i.value);
            all.real += added;
        }
        all
    }

    /// Adds to what accelerations feel; what that is.
    fn feel(&mut self, [member, reference]: [MemberId; 2], value: f64) -> DMatrix<f64> {
        let added = turning(self.configuration, [member, reference], value);
        self.felt += &added;
        if value != 0.0 {
            self.pairs.push([member, reference]);
        }
        match [member, reference].map(|m| self.configuration.node(m)) {
            [Some(member), reference] | [reference, Some(member)] => {
                self.parts.push(Inertia { member, reference, value });
            }
            [None, None] => {}
        }
        added
    }

    /// Adds what turns with a member and stores energy.
    pub fn add(&mut self, member: MemberId, value: f64) {
        let added = self.feel([member, FRAME], value);
        self.real += added;
    }

    /// Adds what resists acceleration of a member without storing energy.
    pub fn add_felt(&mut self, member: MemberId, value: f64) {
        self.feel([member, FRAME], value);
    }

    /// What it makes of the accelerations of coordinates.
    pub fn accelerations(&self, coordinates: &Coordinates) -> Accelerations {
        let (free, all) = (coordinates.free, coordinates.all());
        let n = coordinates.of_nodes(self.configuration);
        let n_free = n.columns(0, free).into_owned();
        let mut left = DMatrix::zeros(self.configuration.nodes, all);
        left.columns_mut(0, free).copy_from(&(&self.felt * &n_free));
        for (i, &member) in coordinates.prescribed().iter().enumerate() {
            left.set_column(free + i, &on_nodes(self.configuration, [(member, -1.0)]));
        }
        Accelerations {
            prescribed: (free..all).map(|i| -(&self.felt * n.column(i))).collect(),
            mass: n_free.transpose() * &self.felt * &n_free,
            energy: n.transpose() * &self.real * &n,
            left,
        }
    }
}

/// Inertia over the coordinates, and its part in the equations of motion.
pub(super) struct Accelerations {
    /// Torques on the nodes that a unit of each free acceleration takes; after them, as a prescribed acceleration is
    /// known, those of a unit of the unknown torque behind it.
    pub left: DMatrix<f64>,
    /// Torques on the nodes of a unit of each prescribed acceleration.
    pub prescribed: Vec<DVector<f64>>,
    /// `Nᵀ M N` over the free coordinates, with what controllers add.
    pub mass: DMatrix<f64>,
    /// The same over all coordinates, of what stores kinetic energy.
    pub energy: DMatrix<f64>,
}

/// The matrix of an inertia that turns with one member and is measured against another.
fn turning(c: &Configuration<'_>, [member, reference]: [MemberId; 2], value: f64) -> DMatrix<f64> {
    let d = on_nodes(c, [(member, 1.0), (reference, -1.0)]);
    &d * d.transpose() * value
}

/// An error if some combination of the coordinates has no inertia.
pub(super) fn massless(
    reduced: &DMatrix<f64>,
    speeds: &[Vec<f64>],
    train: &Train,
    scenario: &Scenario,
) -> Result<(), Diagnostics> {
    let free = reduced.nrows();
    if free == 0 {
        return Ok(());
    }
    // Each coordinate measured by its own inertia, so that units and sizes do not matter.
    let scale: Vec<f64> = (0..free).map(|k| reduced[(k, k)].sqrt()).collect();
    let weakest: Option<Vec<f64>> = match scale.iter().position(|s| *s == 0.0) {
        Some(k) => Some((0..free).map(|i| f64::from(u8::from(i == k))).collect()),
        None => {
            let scaled = DMatrix::from_fn(free, free, |i, j| reduced[(i, j)] / (scale[i] * scale[j]));
            let eigen = scaled.symmetric_eigen();
            let k = eigen.eigenvalues.imin();
            (eigen.eigenvalues[k] < 1e-13).then(|| (0..free).map(|i| eigen.eigenvectors[(i, k)] / scale[i]).collect())
        }
    };
    let Some(direction) = weakest else { return Ok(()) };
    let speed = |m: usize| -> f64 { speeds[m].iter().zip(&direction).map(|(n, d)| n * d).sum() };
    let fastest = (0..speeds.len()).map(|m| speed(m).abs()).fold(0.0, f64::max);
    let moving: Vec<&str> = (1..speeds.len())
        .filter(|&m| speed(m).abs() > 1e-6 * fastest)
        .map(|m| train.members()[m].name.as_str())
        .take(8)
        .collect();
    let message = match moving[..] {
        [one] => {
            format!("`{one}` has no inertia and its speed is not prescribed, so its acceleration is not determined")
        }
        _ => format!(
            "{} can move together without any inertia and without a prescribed speed, so their acceleration is not determined",
            moving.join(", ")
        ),
    };
    let hint = format!(
        "give one of them a moment of inertia, [inertias] {} = \"0.01 kg m^2\"; or prescribe its speed, or hold it in `fixed`",
        moving.first().copied().unwrap_or("member"),
    );
    Err(Diagnostic::new(Code::NoInertia, scenario.place.clone(), message).hint(hint).into())
}
