//! The conditions under which the gears of a set can be assembled: one axis, equal spacing, room between planets.

use crate::diagnostic::{Code, Diagnostic};
use crate::exact::Rational;
use crate::train::words::clip;

use super::expansion::Expansion;

impl Expansion<'_, '_> {
    /// The teeth of a planet between sun and ring: as given, if they lie on one axis with it, else nominal.
    pub fn planet_between(
        &mut self,
        sun: (i64, &str),
        ring: i64,
        given: Option<Rational>,
        planet_key: &str,
    ) -> Rational {
        match given {
            Some(given) => {
                self.coaxial(sun, ring, (&given, planet_key));
                given
            }
            None => self.nominal(sun.0, ring, planet_key),
        }
    }

    /// The planet that fits between unshifted sun and ring, `(z_r − z_s)/2`, where none is given.
    fn nominal(&mut self, sun: i64, ring: i64, key: &str) -> Rational {
        let z = Rational::new(ring.clamp(-100_000, 100_000) - sun.clamp(-100_000, 100_000), 2);
        let name = clip(&self.set.name);
        if z.sign() <= 0 {
            let message =
                format!("set `{name}`: a ring with {ring} teeth has no room for a planet around a sun with {sun}");
            self.a.report(
                Diagnostic::new(Code::NotCoaxial, format!("{}.ring.teeth", self.place), message)
                    .hint("the ring has more teeth than the sun; are the two swapped?"),
            );
            return Rational::ONE;
        }
        if z.is_integer() {
            self.a.assume(&format!("{}.{key} ({z})", self.set.name), "teeth not given, taken as (z_ring - z_sun)/2");
        } else {
            let message = format!(
                "set `{name}`: the {key}'s teeth are not given and (z_ring - z_sun)/2 = ({ring} - {sun})/2 = {} is no \
                 integer",
                z.to_f64()
            );
            let whole = z.to_f64().floor();
            self.a.report(Diagnostic::new(Code::NominalPlanet, self.place.as_str(), message).hint(format!(
                "profile shift closes it with {whole} or {} teeth; give the real number and planet speeds are exact \
                 (ratios and efficiencies do not depend on it)",
                whole + 1.0
            )));
        }
        z
    }

    /// `z_ring = z_sun + 2 z_planet` (unshifted gears of one module). Where the teeth are given their
    /// centre distances are compared instead.
    fn coaxial(&mut self, (sun, sun_key): (i64, &str), ring: i64, (planet, planet_key): (&Rational, &str)) {
        let needed = &Rational::from(sun) + &(planet * &Rational::from(2));
        let off = &Rational::from(ring) - &needed;
        if off.is_zero() || self.set.geometry.is_some() {
            return;
        }
        let message = format!(
            "set `{}`: ring {ring}, {sun_key} {sun} and {planet_key} {planet} do not lie on one axis: \
             {sun} + 2·{planet} = {needed}, off by {}",
            clip(&self.set.name),
            off.abs()
        );
        let place = format!("{}.ring.teeth", self.place);
        self.a.report(if off.abs() <= Rational::from(2) {
            Diagnostic::new(Code::NearlyCoaxial, place, message).hint("profile shift can close this")
        } else {
            Diagnostic::new(Code::NotCoaxial, place, message).hint(format!("use {needed} teeth, or another planet"))
        });
    }

    /// Planets at equal angles: `sum/n`, of what is called `what`, is an integer.
    pub fn equal_spacing(&mut self, sum: &Rational, n: u32, what: &str) {
        let each = sum / &Rational::from(n as i64);
        if !each.is_integer() {
            let message = format!(
                "set `{}`: {n} planets cannot be spaced equally: ({what})/{n} = {sum}/{n} = {:.4} is no integer",
                clip(&self.set.name),
                each.to_f64()
            );
            let fits: Vec<String> =
                (2..=8).filter(|k| (sum / &Rational::from(*k)).is_integer()).map(|k| k.to_string()).collect();
            let hint = match fits.is_empty() {
                true => "no number of planets from 2 to 8 does; change a tooth count, or space them unequally".into(),
                false => format!("{} planets would, or unequal angles", fits.join(" or ")),
            };
            self.a.report(Diagnostic::new(Code::UnequalSpacing, self.place.as_str(), message).hint(hint));
        }
    }

    /// Tip circles of neighbouring planets: `(z_s + z_p) sin(π/n) > z_p + 2` in modules, addendum one.
    pub fn clearance(&mut self, sun: &Rational, planet: &Rational, n: u32) {
        if n < 2 {
            return;
        }
        let (z_s, z_p) = (sun.to_f64(), planet.to_f64());
        let gap = (z_s + z_p) * (std::f64::consts::PI / n as f64).sin() - (z_p + 2.0);
        if gap <= 0.0 {
            let message = format!(
                "set `{}`: neighbouring planets overlap by {:.2} modules at the tip (sun {z_s}, planet {z_p}, {n} planets)",
                clip(&self.set.name),
                -gap
            );
            let fit = (std::f64::consts::PI / ((z_p + 2.0) / (z_s + z_p)).min(1.0).asin()).ceil() as u32 - 1;
            let d = Diagnostic::new(Code::PlanetsTouch, self.place.as_str(), message);
            self.a.report(d.hint(format!("at most {fit} planets fit")));
        }
    }

    /// Centre distances and spacing of a stepped set: teeth of each central gear, those of a ring negative, and of its
    /// step.
    pub fn stepped_conditions(&mut self, steps: &[(i64, Rational)], n: Option<u32>) {
        let Some((first, rest)) = steps.split_first() else { return };
        // Twice the centre distance in modules: |z + y| for sun (z > 0) and ring (z < 0).
        let twice = |(z, y): &(i64, Rational)| (&Rational::from(*z) + y).abs();
        // Where the teeth are given their centre distances are compared instead.
        for other in rest.iter().filter(|_| self.set.geometry.is_none()) {
            let off = (&twice(first) - &twice(other)).abs();
            if !off.is_zero() {
                let message = format!(
                    "set `{}`: with one module the centre distances differ: {}/2 and {}/2 modules",
                    clip(&self.set.name),
                    twice(first),
                    twice(other)
                );
                let hint = if off <= Rational::from(2) {
                    "profile shift can close this"
                } else {
                    "the steps have different modules or helix angles; the ratio does not depend on it"
                };
                self.a.report(Diagnostic::new(Code::NearlyCoaxial, self.place.as_str(), message).hint(hint));
            }
            if let Some(n) = n {
                // Identical planets at equal angles: (z1 y2 - z2 y1)/(n gcd(y1, y2)) is an integer.
                let (y1, y2) = (first.1.to_f64() as i64, other.1.to_f64() as i64);
                let gcd = Rational::from(gcd(y1, y2));
                let sum = (&Rational::from(first.0) * &other.1 - &Rational::from(other.0) * &first.1).abs() / gcd;
                self.equal_spacing(&sum, n, "(z_1 y_2 - z_2 y_1)/gcd(y_1, y_2)");
            }
        }
        if let Some(n) = n
            && let Some((z, y)) = steps.iter().filter(|s| s.0 > 0).max_by(|p, q| p.1.cmp(&q.1))
        {
            self.clearance(&Rational::from(*z), y, n);
        }
    }
}

fn gcd(a: i64, b: i64) -> i64 {
    if b == 0 { a } else { gcd(b, a % b) }
}
