//! The statics by itself: a train in a motion, its certificate, and its equilibria under torques.

use crate::diagnostic::{Code, Diagnostic, through_diagnostic};
use crate::exact::Rational;
use crate::kinematics::{Configuration, Motion, common};
use crate::train::{MemberId, MeshId};
use crate::units::{AngularSpeed, Torque};

use super::{Certificate, Equilibrium, Solution, Unsolvable};

/// A train that moves in a certain way, before its load is known: the question of the statics, without losses that
/// depend on load or speed, power flow or report. [`analyze`](crate::analyze) asks it for whole operating points.
///
/// Torques will act on some terminals; the other terminals balance them. Of the speeds only the directions of motion
/// matter here: they say which end of each mesh drives.
///
/// # Example
/// ```
/// use willis::kinematics::Configuration;
/// use willis::statics::Problem;
/// use willis::train::{SetSpec, Train};
/// use willis::units::{AngularSpeed, Torque};
///
/// // Ring held, sun and carrier turn; 49/50 of the power passes each mesh.
/// let train = Train::builder("reducer")
///     .members(["sun", "carrier"])
///     .terminals(["sun", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("frame", 70), "carrier").planet(20, 4).mesh_efficiency(0.98))
///     .build()?;
/// let (sun, carrier) = (train.member("sun").unwrap(), train.member("carrier").unwrap());
/// let as_drawn = Configuration::new(&train, &[], &[], train.terminals());
/// let problem = Problem::new(as_drawn, &[(sun, AngularSpeed::rpm(1000.0))], &[sun]).unwrap();
/// // Whatever the torque on the sun, there is exactly one equilibrium.
/// assert!(problem.certificate().unique_for_every_load());
///
/// let driving = problem.solve(&[(sun, Torque::n_m(10.0))]).unwrap();
/// let [only] = &driving.solutions[..] else { panic!("one equilibrium") };
/// // T_carrier = −(1 + 7/3 · 0.98²) T_sun
/// let expected = -10.0 * (1.0 + 7.0 / 3.0 * 0.98 * 0.98);
/// assert!((only.torque_n_m(carrier).unwrap() - expected).abs() < 1e-9);
/// assert!((only.efficiency.unwrap() - 0.97228).abs() < 1e-9);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
#[derive(Clone, Debug)]
pub struct Problem<'t> {
    configuration: Configuration<'t>,
    motion: Motion,
    equilibrium: Equilibrium,
    /// Terminals on which a torque may act, and those that balance it.
    loaded: Vec<MemberId>,
    open: Vec<MemberId>,
}

/// Why there is no such problem.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Unposed {
    /// The gears tie the speeds of the members of each list together, and not as they were given.
    Contradiction(Vec<Vec<MemberId>>),
    /// Motion and loads leave no problem with one equation for each force.
    Unsolvable(Unsolvable),
    /// A torque on a member that was not said to be loaded.
    NotLoaded(MemberId),
}

impl std::fmt::Display for Unposed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Contradiction(_) => f.write_str("the speeds contradict each other"),
            Self::Unsolvable(why) => why.fmt(f),
            Self::NotLoaded(_) => f.write_str("a torque acts on a member that was not said to be loaded"),
        }
    }
}

impl std::error::Error for Unposed {}

impl From<Unposed> for Diagnostic {
    fn from(why: Unposed) -> Self {
        let code = match &why {
            Unposed::Contradiction(_) => Code::ContradictorySpeeds,
            Unposed::Unsolvable(why) => return why.clone().into(),
            Unposed::NotLoaded(_) => Code::NotATerminal,
        };
        Self::new(code, "", why.to_string())
    }
}

through_diagnostic!(Unposed);

impl From<Unsolvable> for Unposed {
    fn from(why: Unsolvable) -> Self {
        Self::Unsolvable(why)
    }
}

/// Every equilibrium under a load.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Equilibria {
    /// What is known about their number.
    pub certificate: Certificate,
    /// The equilibria found. None: friction locks the train, unless the certificate is [`Certificate::Undecided`].
    pub solutions: Vec<Balanced>,
    /// Whether a whole range of torques balances the load beside them: it lies on a self-locking threshold.
    pub continuum: bool,
}

/// One equilibrium.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Balanced {
    /// External torque on each terminal that is loaded or balances, N m. Terminals that turn as one balance together,
    /// and the first of them has the torque.
    pub torques_n_m: Vec<(MemberId, f64)>,
    /// Power into the train at each of them, W, at the speeds given.
    pub powers_w: Vec<(MemberId, f64)>,
    /// The member that drives in each mesh, seen from its carrier; none in a mesh that is idle or at rest.
    pub drivers: Vec<(MeshId, Option<MemberId>)>,
    /// Power out over power in; 0 when every loaded terminal is driven, absent when no power enters.
    pub efficiency: Option<f64>,
}

impl Balanced {
    /// External torque on a terminal, N m.
    pub fn torque_n_m(&self, terminal: MemberId) -> Option<f64> {
        self.torques_n_m.iter().find(|(m, _)| *m == terminal).map(|(_, t)| *t)
    }
}

impl<'t> Problem<'t> {
    /// Sets up the problem and certifies it. `speeds` settle the motion; a torque may act on the terminals in `loaded`,
    /// and the other terminals of the train balance it: as many as there are degrees of freedom.
    ///
    /// A planet that is a terminal, or whose speed is given, must be in the `keep` of the configuration.
    ///
    /// # Errors
    /// Speeds that contradict each other or leave a loaded mesh without one, loads too many or too few, and trains
    /// whose forces equilibrium does not determine.
    pub fn new(
        configuration: Configuration<'t>,
        speeds: &[(MemberId, AngularSpeed)],
        loaded: &[MemberId],
    ) -> Result<Self, Unposed> {
        let c = &configuration;
        let speeds: Vec<_> = speeds.iter().map(|(m, w)| (*m, w.0.clone())).collect();
        let motion = c
            .motion(&speeds)
            .map_err(|broken| Unposed::Contradiction(broken.into_iter().map(|d| d.members).collect()))?;
        let sigma: Vec<_> = c.elements.iter().map(|e| c.sigma(e, &motion)).collect();
        let mut open: Vec<MemberId> = Vec::new();
        for m in c.train.terminals.iter().filter(|m| c.node(**m).is_some() && !loaded.contains(m)) {
            if open.iter().all(|o| c.node(*o) != c.node(*m)) {
                open.push(*m);
            }
        }
        let nodes = |members: &[MemberId]| members.iter().filter_map(|m| c.node(*m)).collect::<Vec<_>>();
        let equilibrium = Equilibrium::new(c, &sigma, &nodes(&open), &nodes(loaded))?;
        Ok(Self { motion, equilibrium, loaded: loaded.to_vec(), open, configuration })
    }

    /// What is known about the number of equilibria, whatever the torques are.
    pub fn certificate(&self) -> Certificate {
        self.equilibrium.certificate()
    }

    /// Every equilibrium under these torques; on a loaded terminal that is not among them none acts.
    ///
    /// # Errors
    /// A torque on a member that was not said to be loaded.
    pub fn solve(&self, torques: &[(MemberId, Torque)]) -> Result<Equilibria, Unposed> {
        let c = &self.configuration;
        if let Some((m, _)) = torques.iter().find(|(m, _)| !self.loaded.contains(m)) {
            return Err(Unposed::NotLoaded(*m));
        }
        let (values, pi_power) = common(torques.iter().map(|(_, t)| &t.0));
        let scale = std::f64::consts::PI.powi(pi_power.into());
        let mut loads = vec![Rational::ZERO; c.nodes];
        let mut given: Vec<(MemberId, f64)> = self.loaded.iter().map(|m| (*m, 0.0)).collect();
        for ((m, _), value) in torques.iter().zip(values) {
            if let Some(own) = given.iter_mut().find(|(g, _)| g == m) {
                own.1 += value.to_f64() * scale;
            }
            if let Some(n) = c.node(*m) {
                loads[n] += value;
            }
        }
        let answer = self.equilibrium.solve(&loads);
        let given: Vec<_> =
            given.into_iter().map(|(m, t)| (m, t, if t == 0.0 { 0 } else { t.signum() as i8 })).collect();
        let balanced = |s: &Solution| {
            let open = self.open.iter().filter_map(|m| {
                let (torque, sign) = self.equilibrium.balancing_torque(c, s, &loads, c.node(*m)?);
                Some((*m, torque * scale + 0.0, sign))
            });
            self.balanced(s, given.iter().copied().chain(open).collect())
        };
        Ok(Equilibria {
            certificate: answer.certificate,
            solutions: answer.solutions.iter().map(balanced).collect(),
            continuum: !answer.stretches.is_empty(),
        })
    }

    /// From the torques of the terminals with their signs.
    fn balanced(&self, s: &Solution, acting: Vec<(MemberId, f64, i8)>) -> Balanced {
        let c = &self.configuration;
        let way = |m: MemberId| self.motion.speeds[m.0].as_ref().map_or(0, Rational::sign);
        let torques_n_m: Vec<_> = acting.iter().map(|&(m, t, _)| (m, t)).collect();
        let powers_w: Vec<_> = acting.iter().map(|&(m, t, _)| (m, t * self.motion.si(m).unwrap_or(0.0))).collect();
        let sum = |role: i8| -> f64 {
            let of = acting.iter().zip(&powers_w).filter(|((m, _, sign), _)| sign * way(*m) == role);
            of.map(|(_, (_, p))| p.abs()).sum()
        };
        let (input, output) = (sum(1), sum(-1));
        let mut drivers: Vec<(MeshId, Option<MemberId>)> = Vec::with_capacity(c.train.meshes.len());
        for (e, p_drives) in c.elements.iter().zip(&s.driver) {
            for link in &e.links {
                let gears = &c.train.meshes[link.mesh.0].gears;
                drivers.push((link.mesh, p_drives.map(|p| gears[usize::from(p != link.along)].member)));
            }
        }
        drivers.sort_by_key(|d| d.0);
        // Without a driver nothing is lost, whatever the round-off says.
        let lossless = s.driver.iter().all(Option::is_none);
        let efficiency = (input > 0.0).then(|| if lossless { 1.0 } else { (output / input).clamp(0.0, 1.0) });
        Balanced { torques_n_m, powers_w, drivers, efficiency }
    }
}
