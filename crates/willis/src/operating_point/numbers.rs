//! Every continuous number that the laws read of a train, in any kind of number.

use crate::catalogue::bearing::BearingData;
use crate::catalogue::oil::Curves;
use crate::losses::mesh_friction::{Constant, MeshFriction};
use crate::real::Real;
use crate::train::{
    BearingMount, DragMount, Efficiency, LossPart, Lubrication, OpenElement, Store, Teeth, Train, Variator,
    VariatorPath,
};

/// Viscosity of an oil at 40 °C where only the one at its temperature is known, m²/s.
pub(super) const VG_100: f64 = 100e-6;
/// Temperature at which oils are classed, K.
const COLD: f64 = 313.15;

/// Every continuous number that the laws read of a train.
#[derive(Clone, Debug)]
pub(crate) struct Numbers<R> {
    /// Given efficiency of each mesh, first gear driving and second gear driving; of a computed mesh the nominal one.
    pub efficiencies: Vec<[R; 2]>,
    pub teeth: Vec<Option<Teeth<R>>>,
    pub oil: Option<OilState<R>>,
    pub bearings: Vec<MountNumbers<R>>,
    /// Diameter under each seal, m.
    pub seals: Vec<R>,
    pub rotors: Vec<RotorNumbers<R>>,
    pub drags: Vec<DragNumbers<R>>,
    /// Of each shift element that drags while it is open.
    pub open: Vec<Option<OpenElement<R>>>,
    pub pumps: Vec<PumpNumbers<R>>,
    /// Radius of the orbit, m, and mass, kg.
    pub planets: Vec<[R; 2]>,
    pub enclosure: Option<R>,
    /// Axial gap to the housing, m.
    pub axial_gap: Option<R>,
    /// What the law `constant` gives.
    pub friction_coefficient: R,
    /// Factors on the losses, by [kind](LossPart).
    pub loss_factors: [R; LossPart::COUNT],
    pub variators: Vec<VariatorNumbers<R>>,
}

/// Numbers of a variator.
#[derive(Clone, Debug)]
pub(crate) struct VariatorNumbers<R> {
    /// Efficiencies: forward and backward of a variator between two members; else motoring and generating of each
    /// machine, those of a map at its best.
    pub efficiencies: Vec<[R; 2]>,
    /// Standby loss, W.
    pub standby: R,
    /// Power out of its store as the train has it, W; none: whatever balances the bus.
    pub store: Option<R>,
}

impl VariatorNumbers<f64> {
    fn of(v: &Variator) -> Self {
        let both = |e: &Efficiency| [e.forward.to_f64(), e.backward.to_f64()];
        match &v.path {
            VariatorPath::Direct { efficiency, .. } => {
                Self { efficiencies: vec![both(efficiency)], standby: 0.0, store: Some(0.0) }
            }
            VariatorPath::Bus { machines, store, standby } => Self {
                efficiencies: machines.iter().map(|m| both(&m.efficiency.nominal())).collect(),
                standby: *standby,
                store: match store {
                    Store::Power(q) => Some(q.si()),
                    Store::Free => None,
                },
            },
        }
    }
}

/// Numbers of the bearings at one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MountNumbers<R> {
    pub data: BearingData<R>,
    pub span: Option<R>,
    /// Where their middle stands along the axis, m.
    pub position: Option<R>,
    /// Of a plain bearing: difference of its two diameters, m.
    pub clearance: R,
    /// Of a plain bearing: coefficient of friction without a full film.
    pub friction: R,
    pub radial_load: R,
    pub axial_load: R,
    pub level: Option<R>,
}

impl MountNumbers<f64> {
    pub fn of(mount: &BearingMount) -> Self {
        Self {
            data: mount.bearing.data(),
            span: mount.span,
            position: mount.position,
            clearance: mount.clearance,
            friction: mount.friction,
            radial_load: mount.radial_load,
            axial_load: mount.axial_load,
            level: mount.level,
        }
    }
}

/// Numbers of an oil pump.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PumpNumbers<R> {
    /// m³ a turn.
    pub displacement: R,
    /// Pa.
    pub pressure: R,
    pub efficiency: Option<R>,
}

/// What a given drag exerts, of all places together.
#[derive(Clone, Copy, Debug)]
pub(crate) struct DragNumbers<R> {
    /// Torque at any speed, N m; none where it is a curve over speed.
    pub coulomb: Option<R>,
    /// Torque over relative speed, N m s/rad.
    pub viscous: R,
}

impl DragNumbers<f64> {
    pub fn of(drag: &DragMount) -> Self {
        let coulomb = match drag.torque.points() {
            [[_, torque]] => Some(*torque),
            _ => None,
        };
        Self { coulomb, viscous: drag.viscous }
    }
}

/// Lengths of a rotor, m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RotorNumbers<R> {
    pub radius: R,
    pub length: R,
    pub radial_gap: R,
    pub axial_gap: R,
}

/// State of the oil at the operating temperature.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OilState<R> {
    pub temperature: R,
    pub dynamic_viscosity: R,
    pub kinematic_viscosity: R,
    pub density: R,
    pub pressure_viscosity: R,
    pub viscosity_slope: R,
    pub conductivity: R,
    /// Kinematic viscosity at 40 °C, m²/s, or one that stands for it.
    pub viscosity_40: R,
    pub lubricant_factor: Option<R>,
    /// Volume in the sump, m³.
    pub volume: Option<R>,
    /// Volumes of air to one of oil in the mist.
    pub mist: Option<R>,
}

impl<R: Real> OilState<R> {
    pub fn at(
        lubrication: &Lubrication,
        curves: &Curves<R>,
        temperature: R,
        [lubricant_factor, volume, mist]: [Option<R>; 3],
    ) -> Self {
        Self {
            temperature,
            dynamic_viscosity: curves.dynamic_viscosity(temperature),
            kinematic_viscosity: curves.kinematic_viscosity(temperature),
            density: curves.density(temperature),
            pressure_viscosity: curves.pressure_viscosity(temperature),
            viscosity_slope: curves.viscosity_slope(temperature),
            conductivity: curves.conductivity(temperature),
            viscosity_40: match lubrication.oil.covers(COLD) {
                true => curves.kinematic_viscosity(R::from(COLD)),
                false => R::from(VG_100),
            },
            lubricant_factor,
            volume,
            mist,
        }
    }
}

impl OilState<f64> {
    /// As the train has it, at a temperature, K.
    pub fn of(lubrication: &Lubrication, temperature: f64) -> Self {
        let given = [lubrication.oil.lubricant_factor, lubrication.volume, lubrication.mist];
        Self::at(lubrication, &lubrication.oil.curves(), temperature, given)
    }
}

impl Numbers<f64> {
    /// As the train has them, at the temperature of its oil unless another is given.
    pub fn of(train: &Train, temperature: Option<f64>) -> Self {
        Self {
            efficiencies: (train.meshes.iter())
                .map(|m| [m.efficiency.forward.to_f64(), m.efficiency.backward.to_f64()])
                .collect(),
            teeth: train.meshes.iter().map(|m| m.teeth.as_deref().cloned()).collect(),
            oil: train.lubrication.as_ref().map(|l| OilState::of(l, temperature.unwrap_or(l.temperature))),
            bearings: train.bearings.iter().map(MountNumbers::of).collect(),
            seals: train.seals.iter().map(|s| s.diameter).collect(),
            rotors: (train.rotors.iter())
                .map(|r| RotorNumbers {
                    radius: r.radius,
                    length: r.length,
                    radial_gap: r.radial_gap,
                    axial_gap: r.axial_gap,
                })
                .collect(),
            drags: train.drags.iter().map(DragNumbers::of).collect(),
            open: train.shift_elements.iter().map(|e| e.open.clone()).collect(),
            pumps: (train.pumps.iter())
                .map(|p| PumpNumbers { displacement: p.displacement, pressure: p.pressure, efficiency: p.efficiency })
                .collect(),
            planets: train.planets.iter().map(|p| [p.orbit_radius, p.mass]).collect(),
            enclosure: train.housing.enclosure,
            axial_gap: train.housing.axial_gap,
            friction_coefficient: match train.laws.mesh_friction(train.lubrication.is_some()) {
                MeshFriction::Constant(constant) => constant.mu,
                _ => train.laws.friction_coefficient.unwrap_or(Constant::DEFAULT.mu),
            },
            loss_factors: train.loss_factors.factors,
            variators: train.variators.iter().map(VariatorNumbers::of).collect(),
        }
    }
}
