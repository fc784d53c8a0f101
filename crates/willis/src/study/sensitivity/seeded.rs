//! The numbers of a train with the derivative by some of them: what is given, and all that follows from it.

use crate::catalogue::oil::Viscosity;
use crate::geometry::{Pair, PairData, Tip};
use crate::operating_point::{
    DragNumbers, MountNumbers, Numbers, OilState, PumpNumbers, RotorNumbers, VariatorNumbers,
};
use crate::train::{
    BEVEL_WIDTH, BearingNumber, Jet, LossPart, PumpNumber, RotorNumber, Slot, Teeth, TipRelief, Train, steel_mass,
};

use super::lanes::{Asked, Moving, moving};

/// The numbers of a train in which the slots of each of up to [`LANES`] quantities move together, each at its rate; `None` where the
/// geometry stands on an edge of what is possible.
pub(super) fn numbers(train: &Train, temperature: Option<f64>, asked: &[Asked<'_>]) -> Option<Numbers<Moving>> {
    let plain = Numbers::of(train, temperature);
    let seeded = |slot: Slot, value: f64| {
        let rate = |own: &Asked<'_>| own.slots.iter().find(|(own, _)| *own == slot).map(|(_, rate)| *rate);
        moving(value, asked.iter().enumerate().filter_map(|(lane, own)| Some((lane, rate(own)?))))
    };

    let mut teeth: Vec<Option<Teeth<Moving>>> = Vec::with_capacity(train.meshes.len());
    for (j, mesh) in train.meshes.iter().enumerate() {
        let Some(t) = &mesh.teeth else {
            teeth.push(None);
            continue;
        };
        let mut data = pair_data(&t.pair.data, j, &seeded);
        if t.cones.is_some() {
            // Width and tips of the file are those of the real teeth.
            let width = BEVEL_WIDTH
                * t.hypoid
                    .as_ref()
                    .map_or(1.0, |h| h.width_factor(usize::from(mesh.gears[1].teeth >= mesh.gears[0].teeth)));
            data.width.eps *= width;
            for (k, wheel) in data.wheels.iter_mut().enumerate() {
                let Tip::Radius(radius) = &mut wheel.tip else { continue };
                let cone = t.hypoid.as_ref().map_or(t.cone(k), |h| h.cones[k].cos());
                radius.eps /= cone;
                if let Some(h) = &t.hypoid {
                    // The addendum is what the pitch circle leaves of it, and that grows with the module.
                    let pitch = wheel.teeth / (2.0 * data.helix.re.cos());
                    radius.eps += data.module.eps * pitch * (1.0 - h.radius_factor(k) / cone);
                }
            }
        }
        teeth.push(Some(Teeth {
            pair: Pair::new(&data).ok()?,
            cones: t.cones,
            hypoid: t.hypoid.clone(),
            roughness: [0, 1].map(|k| seeded(Slot::Roughness(j, k), t.roughness[k])),
            immersion: [0, 1].map(|k| t.immersion[k].map(|depth| seeded(Slot::Immersion(j, k), depth))),
            jet: t.jet.map(|jet| Jet {
                flow: seeded(Slot::Jet(j, true), jet.flow),
                speed: seeded(Slot::Jet(j, false), jet.speed),
                side: jet.side,
            }),
            hand: t.hand,
            position: t.position.map(|x| seeded(Slot::Position(j), x)),
            sharing: t.sharing,
            youngs_modulus: seeded(Slot::YoungsModulus(j), t.youngs_modulus),
            poisson_ratio: seeded(Slot::PoissonRatio(j), t.poisson_ratio),
            stiffness: t.stiffness,
            stiffness_by_standard: t.stiffness_by_standard,
            relief: t.relief.map(|relief| TipRelief {
                amount: [0, 1].map(|k| seeded(Slot::TipRelief(j, k, true), relief.amount[k])),
                length: [0, 1].map(|k| seeded(Slot::TipRelief(j, k, false), relief.length[k])),
                stiffness: relief.stiffness,
            }),
        }));
    }
    let bearings: Vec<MountNumbers<Moving>> = train
        .bearings
        .iter()
        .zip(&plain.bearings)
        .enumerate()
        .map(|(k, (mount, own))| {
            use BearingNumber as B;
            let of = |number: B, value: f64| seeded(Slot::Bearing(k, number), value);
            let mut data = own.data.lift::<Moving>();
            data.bore = of(B::Bore, own.data.bore);
            data.outside_diameter = of(B::OutsideDiameter, own.data.outside_diameter);
            data.width = of(B::Width, own.data.width);
            data.static_rating = own.data.static_rating.map(|x| of(B::StaticRating, x));
            data.axial_factor = own.data.axial_factor.map(|x| of(B::AxialFactor, x));
            if mount.bearing.element_diameter.is_none() {
                // Taken as a share of D − d.
                let share = own.data.element_diameter / (own.data.outside_diameter - own.data.bore);
                data.element_diameter.eps = (data.outside_diameter.eps - data.bore.eps) * share;
            }
            MountNumbers {
                data,
                span: own.span.map(|x| of(B::Span, x)),
                position: own.position.map(|x| of(B::Position, x)),
                clearance: of(B::Clearance, own.clearance),
                friction: of(B::Friction, own.friction),
                radial_load: of(B::RadialLoad, own.radial_load),
                axial_load: of(B::AxialLoad, own.axial_load),
                level: own.level.map(|x| of(B::Level, x)),
            }
        })
        .collect();
    let mut planets = Vec::with_capacity(train.planets.len());
    for (k, planet) in train.planets.iter().enumerate() {
        let orbit = teeth[planet.mesh.index()].as_ref()?.pair.centre_distance;
        let mass = if planet.estimated {
            let bearing = train.bearings.iter().position(|b| b.members.contains(&planet.member));
            let hole = bearing.map_or(Moving::from_re(0.0), |b| bearings[b].data.outside_diameter / 2.0);
            steel_mass(&train.meshes, planet.member, hole, &|j| teeth[j].clone())
        } else {
            seeded(Slot::Mass(k), planet.mass)
        };
        planets.push([orbit, mass]);
    }
    let oil = train.lubrication.as_ref().zip(plain.oil).map(|(l, state)| {
        let mut curves = l.oil.curves::<Moving>();
        let of = |wanted: Slot| train.inputs.iter().find(|i| i.slots.contains(&wanted)).map(|i| i.value);
        if let (Some(cold), Some(hot)) = (of(Slot::Viscosity40), of(Slot::Viscosity100)) {
            curves.viscosity = Viscosity::through(seeded(Slot::Viscosity40, cold), seeded(Slot::Viscosity100, hot));
        }
        if let Viscosity::Fixed { dynamic, .. } = &mut curves.viscosity {
            *dynamic = seeded(Slot::Viscosity, dynamic.re);
        }
        curves.density_15 = seeded(Slot::Density15, l.oil.density_15);
        curves.measured_pressure_viscosity =
            l.oil.measured_pressure_viscosity.map(|alpha| seeded(Slot::PressureViscosity, alpha));
        let given = [
            l.oil.lubricant_factor.map(|x| seeded(Slot::LubricantFactor, x)),
            l.volume.map(|x| seeded(Slot::Volume, x)),
            l.mist.map(|x| seeded(Slot::Mist, x)),
        ];
        OilState::at(l, &curves, seeded(Slot::Temperature, state.temperature), given)
    });
    Some(Numbers {
        efficiencies: (plain.efficiencies.iter().enumerate())
            .map(|(j, [forward, backward])| {
                [seeded(Slot::Efficiency(j, true), *forward), seeded(Slot::Efficiency(j, false), *backward)]
            })
            .collect(),
        teeth,
        oil,
        bearings,
        seals: plain.seals.iter().enumerate().map(|(k, d)| seeded(Slot::Seal(k), *d)).collect(),
        rotors: (plain.rotors.iter().enumerate())
            .map(|(k, r)| {
                let of = |number: RotorNumber, value: f64| seeded(Slot::Rotor(k, number), value);
                RotorNumbers {
                    radius: of(RotorNumber::Radius, r.radius),
                    length: of(RotorNumber::Length, r.length),
                    radial_gap: of(RotorNumber::RadialGap, r.radial_gap),
                    axial_gap: of(RotorNumber::AxialGap, r.axial_gap),
                }
            })
            .collect(),
        open: (plain.open.iter().enumerate())
            .map(|(k, open)| open.as_ref().map(|o| o.lift(&|number, value| seeded(Slot::Open(k, number), value))))
            .collect(),
        pumps: (plain.pumps.iter().enumerate())
            .map(|(k, p)| {
                let of = |number: PumpNumber, value: f64| seeded(Slot::Pump(k, number), value);
                PumpNumbers {
                    displacement: of(PumpNumber::Displacement, p.displacement),
                    pressure: of(PumpNumber::Pressure, p.pressure),
                    efficiency: p.efficiency.map(|x| of(PumpNumber::Efficiency, x)),
                }
            })
            .collect(),
        drags: (plain.drags.iter().zip(&train.drags).enumerate())
            .map(|(k, (own, mount))| {
                // The file has what one place exerts.
                let n = f64::from(mount.places);
                let of = |viscous: bool, value: f64| seeded(Slot::Drag(k, viscous), value / n) * n;
                DragNumbers { coulomb: own.coulomb.map(|c| of(false, c)), viscous: of(true, own.viscous) }
            })
            .collect(),
        planets,
        enclosure: plain.enclosure.map(|x| seeded(Slot::Enclosure, x)),
        axial_gap: plain.axial_gap.map(|x| seeded(Slot::AxialGap, x)),
        loss_factors: LossPart::ALL.map(|part| seeded(Slot::LossFactor(part), plain.loss_factors[part as usize])),
        friction_coefficient: seeded(Slot::FrictionCoefficient, plain.friction_coefficient),
        variators: (plain.variators.iter().enumerate())
            .map(|(k, v)| {
                let direct = !train.variators[k].has_bus();
                let slot = |j: usize, first: bool| match direct {
                    true => Slot::Variator(k, first),
                    false => Slot::Machine(k, j, first),
                };
                let both = |(j, [a, b]): (usize, &[f64; 2])| [seeded(slot(j, true), *a), seeded(slot(j, false), *b)];
                VariatorNumbers {
                    efficiencies: v.efficiencies.iter().enumerate().map(both).collect(),
                    standby: seeded(Slot::Standby(k), v.standby),
                    store: v.store.map(|p| seeded(Slot::Store(k), p)),
                }
            })
            .collect(),
    })
}

/// The data of a pair of teeth with the derivative by the slots.
fn pair_data(plain: &PairData, j: usize, seeded: &dyn Fn(Slot, f64) -> Moving) -> PairData<Moving> {
    let mut data = plain.lift::<Moving>();
    data.module = seeded(Slot::Module(j), plain.module);
    data.pressure_angle = seeded(Slot::PressureAngle(j), plain.pressure_angle);
    data.helix = seeded(Slot::Helix(j), plain.helix);
    data.width = seeded(Slot::Width(j), plain.width);
    data.centre_distance = plain.centre_distance.map(|a| seeded(Slot::CentreDistance(j), a));
    for (k, (wheel, own)) in data.wheels.iter_mut().zip(&plain.wheels).enumerate() {
        wheel.shift = seeded(Slot::Shift(j, k), own.shift);
        wheel.dedendum = seeded(Slot::Dedendum(j, k), own.dedendum);
        wheel.tip = match own.tip {
            Tip::Addendum { coefficient, alteration } => Tip::Addendum {
                coefficient: seeded(Slot::Addendum(j, k), coefficient),
                alteration: seeded(Slot::TipAlteration(j, k), alteration),
            },
            Tip::Radius(radius) => {
                let mut tip = seeded(Slot::TipDiameter(j, k), radius);
                tip.eps /= 2.0;
                Tip::Radius(tip)
            }
        };
    }
    data
}
