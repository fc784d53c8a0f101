//! Profile shifts that bring the gears of a set onto one axis.
//!
//! A set has more freedom than it needs: one centre distance, and how each sum of shifts is divided. With the distance
//! given, `inv α_w` gives the sum of the shifts of the sun and the planet, and the difference of those of the ring and the
//! planet. The first choice is taken, beginning with gears without shift, in which no tooth is undercut, every tip is at
//! least 0.2 modules wide, and no tips touch: [`Pair::new`] judges.

use willis::geometry::{Pair, PairData, Remark, Tip, Wheel, conjugate_shifts};

use super::layout::SetKind;

/// The basic rack: addendum 1, dedendum 1.25.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rack {
    /// Pressure angle, rad.
    angle: f64,
    /// Whether tips may reach beyond the mating involute.
    long_tips: bool,
    /// How far from gears without shift to look: steps of 0.05.
    steps: u32,
}

impl Default for Rack {
    fn default() -> Self {
        Self { angle: 20f64.to_radians(), long_tips: false, steps: 12 }
    }
}

impl Rack {
    /// The rack with a pressure angle, rad; 20 degrees where none is given.
    pub fn with_angle(angle: Option<f64>) -> Self {
        angle.filter(|a| (0.1..0.7).contains(a)).map_or(Self::default(), |angle| Self {
            angle,
            long_tips: false,
            steps: 12,
        })
    }

    /// The least shift without undercut: `x = 1 − z sin² α/2`.
    fn least(self, teeth: i64) -> f64 {
        1.0 - teeth as f64 * self.angle.sin().powi(2) / 2.0
    }
}

/// One metre is the unit of these computations times a thousand: modules are millimetres.
const MODULE: f64 = 1e-3;
/// Shifts beyond this are not tried.
const MOST: f64 = 1.0;

fn wheel(teeth: i64, internal: bool, shift: f64) -> Wheel {
    let tip = Tip::Addendum { coefficient: 1.0, alteration: 0.0 };
    Wheel { teeth: teeth as f64, internal, shift, tip, dedendum: 1.25 }
}

fn data(rack: Rack, wheels: [Wheel; 2], twice_distance: Option<f64>) -> PairData {
    PairData {
        module: MODULE,
        pressure_angle: rack.angle,
        helix: 0.0,
        double_helical: false,
        width: 10.0 * MODULE,
        centre_distance: twice_distance.map(|a| a / 2.0 * MODULE),
        wheels,
    }
}

/// Whether a pair with these shifts runs well. Where that is not to be had, tips may be too long for the mating flank:
/// they are then shortened when the gears are drawn in detail.
fn sound(rack: Rack, wheels: [Wheel; 2], twice_distance: Option<f64>) -> bool {
    let bad = |r: &Remark| match r {
        Remark::LowContactRatio { .. } => false,
        Remark::PathShortened { .. } | Remark::BelowForm { .. } => !rack.long_tips,
        _ => true,
    };
    Pair::new(&data(rack, wheels, twice_distance)).is_ok_and(|p| !p.remarks().iter().any(bad))
}

/// The shift of the other wheel at a distance, when `first` keeps its own.
fn other(rack: Rack, first: Wheel, second: Wheel, twice_distance: f64) -> Option<f64> {
    conjugate_shifts(&data(rack, [first, second], Some(twice_distance))).map(|x| x[1])
}

/// Distances to try, in modules and doubled, nearest to the larger of those without shift first.
fn distances(rack: Rack, low: f64, high: f64) -> impl Iterator<Item = f64> {
    let start = low.max(high);
    (0..2 * rack.steps - 1).flat_map(move |k| {
        let step = 0.05 * f64::from(k);
        [start + step, start - step]
    })
}

/// Shifts to try for a planet, those near zero first.
fn trials(rack: Rack, least: f64) -> impl Iterator<Item = f64> {
    let start = least.max(0.0);
    (0..rack.steps)
        .flat_map(move |k| {
            let step = 0.05 * f64::from(k);
            [start + step, start - step]
        })
        .filter(move |x| *x >= least && x.abs() <= MOST)
}

/// Shifts of a sun, a planet and a ring on a common distance, with that distance doubled.
fn chain(rack: Rack, [s, p, r]: [i64; 3]) -> Option<([f64; 3], f64)> {
    for a in distances(rack, (s + p) as f64, (r - p) as f64) {
        for x_p in trials(rack, rack.least(p)) {
            let planet = || wheel(p, false, x_p);
            let Some(x_s) = other(rack, planet(), wheel(s, false, 0.0), a) else { break };
            let Some(x_r) = other(rack, planet(), wheel(r, true, 0.0), a) else { break };
            if x_s < rack.least(s) || x_s.abs() > MOST || x_r.abs() > 2.0 * MOST {
                continue;
            }
            if sound(rack, [wheel(s, false, x_s), planet()], Some(a))
                && sound(rack, [planet(), wheel(r, true, x_r)], Some(a))
            {
                return Some(([x_s, x_p, x_r], a));
            }
        }
    }
    None
}

/// Shifts of a central gear, which may be a ring, and of the step of a planet with which it meshes at a distance.
fn step(rack: Rack, (teeth, is_ring): (i64, bool), planet: i64, twice_distance: f64) -> Option<[f64; 2]> {
    trials(rack, rack.least(planet)).find_map(|x| {
        let own = || wheel(planet, false, x);
        let shift = other(rack, own(), wheel(teeth, is_ring, 0.0), twice_distance)?;
        let most = if is_ring { 2.0 * MOST } else { MOST };
        if shift.abs() > most || !is_ring && shift < rack.least(teeth) {
            return None;
        }
        let central = wheel(teeth, is_ring, shift);
        let wheels = if is_ring { [own(), central] } else { [central, own()] };
        sound(rack, wheels, Some(twice_distance)).then_some([shift, x])
    })
}

/// Shifts for every gear of a set, in the order of [`SetKind::gears`], with the short planet of a Ravigneaux set after
/// them; positive moves teeth outward, also on a ring. None where no choice is sound.
///
/// Numbers are rounded to 10⁻⁶; the ring takes up what is left.
pub(crate) fn shifts(kind: SetKind, z: &[i64], rack: Rack) -> Option<Vec<f64>> {
    // Gears without shift, if nothing forbids them; then sound ones; then those with tips to be shortened.
    let passes = [(1, true), (12, false), (20, true)];
    passes.into_iter().find_map(|(steps, long_tips)| choose(kind, z, Rack { steps, long_tips, ..rack }))
}

fn choose(kind: SetKind, z: &[i64], rack: Rack) -> Option<Vec<f64>> {
    let found = match kind {
        SetKind::Simple => chain(rack, [z[0], z[1], z[2]])?.0.to_vec(),
        SetKind::Wolfrom => {
            // The second step turns on the same distance, whose first choice may not suit it.
            let (first, a) = chain(rack, [z[0], z[1], z[2]])?;
            let second = trials(rack, rack.least(z[3])).find_map(|x| {
                let planet = || wheel(z[3], false, x);
                let ring = other(rack, planet(), wheel(z[4], true, 0.0), a)?;
                sound(rack, [planet(), wheel(z[4], true, ring)], Some(a)).then_some([x, ring])
            })?;
            [&first[..], &second].concat()
        }
        SetKind::Stepped | SetKind::Rings => {
            let first_is_ring = kind == SetKind::Rings;
            let first = if first_is_ring { z[0] - z[1] } else { z[0] + z[1] };
            distances(rack, first as f64, (z[3] - z[2]) as f64).find_map(|a| {
                let [one, planet_1] = step(rack, (z[0], first_is_ring), z[1], a)?;
                let [two, planet_2] = step(rack, (z[3], true), z[2], a)?;
                Some(vec![one, planet_1, planet_2, two])
            })?
        }
        SetKind::Ravigneaux => {
            let ([large, long, ring], _) = chain(rack, [z[1], z[2], z[3]])?;
            let mut all = vec![0.0, large, long, ring];
            // The distances of the short planets follow from their shifts.
            match z.get(4) {
                Some(short) => {
                    let (x_short, x_small) = trials(rack, rack.least(*short)).find_map(|x| {
                        let planet = || wheel(*short, false, x);
                        let suits = sound(rack, [planet(), wheel(z[2], false, long)], None);
                        let small = trials(rack, rack.least(z[0]))
                            .find(|y| suits && sound(rack, [wheel(z[0], false, *y), planet()], None))?;
                        Some((x, small))
                    })?;
                    all[0] = x_small;
                    all.push(x_short);
                }
                None => all[0] = trials(rack, rack.least(z[0])).next()?,
            }
            all
        }
    };
    Some(found.into_iter().map(|x| (x * 1e6).round() / 1e6 + 0.0).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gears_that_need_no_shift_get_none() {
        assert_eq!(shifts(SetKind::Simple, &[30, 20, 70], Rack::default()), Some(vec![0.0; 3]));
    }

    #[test]
    fn a_mismatch_is_closed() {
        // ZF 6HP26, rear: large sun 38, ring 85: planets of 23 or 24 teeth.
        for (z, off) in
            [([38, 23, 85], 1), ([38, 24, 85], -1), ([33, 19, 72], 1), ([30, 20, 72], 2), ([30, 20, 68], -2)]
        {
            assert_eq!(z[2] - z[0] - 2 * z[1], off);
            let x = shifts(SetKind::Simple, &z, Rack::default()).unwrap_or_else(|| panic!("{z:?}"));
            let chain = willis::geometry::SimpleSetGeometry {
                module: 1e-3,
                pressure_angle: 20f64.to_radians(),
                helix: 0.0,
                teeth: z.map(|z| z as f64),
                shifts: [x[0], x[1], x[2]],
            };
            let [outer, inner] = chain.centre_distances().unwrap();
            assert!((outer - inner).abs() < 1e-8, "{z:?} {x:?}");
        }
    }

    #[test]
    fn few_teeth_are_shifted_out_of_undercut() {
        let x = shifts(SetKind::Simple, &[12, 30, 72], Rack::default()).unwrap();
        assert!(x[0] >= Rack::default().least(12) && x[1] >= Rack::default().least(30));
    }
}
