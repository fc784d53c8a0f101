//! A scheme as a design file: the same connections, elements and gears, with teeth that are still to be found.

use std::fmt::Write as _;

use willis::exact::Rational;

use super::scheme::{Scheme, SchemeGear};
use super::wish::{Bounds, SetRatio, Wish, decimal};
use crate::teeth::MOST_TEETH;

/// Relative tolerance of every ratio, in thousandths. With 1 % the four sets of an eight-speed transmission have 19 million
/// sets of tooth numbers, which takes half a minute; with half of that it is a sixteenth.
const TOLERANCE: i64 = 5;
/// The fewest teeth of a sun or planet, unless the teeth of the wish are fewer: those of the other design files.
const FEWEST: i64 = 12;
/// The most teeth of a ring, unless the basic ratio of the set needs more.
const USUAL_RING: i64 = 120;

/// The smallest whole number that is not below a positive number; none where it is no number of teeth.
fn ceiling(x: &Rational) -> Option<i64> {
    let nearest = x.to_f64();
    if nearest > MOST_TEETH as f64 {
        return None;
    }
    (0..=2).map(|up| nearest as i64 - 1 + up).find(|n| Rational::from(*n) >= *x)
}

/// Least teeth of sun and planet, most of the ring. A quarter more than the smallest ring that the basic ratio can have.
fn range(set: &SetRatio) -> [i64; 2] {
    let (k, fewest) = (set.ratio(), Rational::from(FEWEST));
    // The planet has half the teeth by which the ring exceeds the sun.
    let of_sun = &fewest * k;
    let of_planet = &(&(&fewest * &Rational::from(2)) * k) / &(k - &Rational::ONE);
    let roomy = &(if of_sun > of_planet { of_sun } else { of_planet }) * &Rational::new(5, 4);
    let needed = ceiling(&roomy).unwrap_or(MOST_TEETH);
    let own = set.teeth().map(|own| own.map(i64::from));
    let least = own.map_or(FEWEST, |[sun, ring]| FEWEST.min(sun).min((ring - sun) / 2).max(1));
    let most = own.map_or(0, |[_, ring]| ring).max(needed).clamp(USUAL_RING, MOST_TEETH);
    [least, most]
}

/// The ratio of a gear as a target: within the tolerance, and nowhere outside the range of the wish.
fn ratio(gear: &SchemeGear, wished: &Bounds) -> String {
    let aim = gear.ratio.abs();
    let off = &aim * &Rational::new(TOLERANCE, 1000);
    let [low, high] = [&aim - &off, &aim + &off];
    let cut_low = wished.min.as_ref().filter(|min| **min > low);
    let cut_high = wished.max.as_ref().filter(|max| **max < high);
    let is_reverse = gear.ratio.sign() < 0;
    if cut_low.is_none() && cut_high.is_none() {
        return format!("ratio = \"{}\"", gear.ratio.to_fraction());
    }
    let [low, high] = [cut_low.unwrap_or(&low).clone(), cut_high.unwrap_or(&high).clone()];
    let [low, high] = if is_reverse { [-high, -low] } else { [low, high] };
    format!("ratio = [\"{}\", \"{}\"]", low.to_fraction(), high.to_fraction())
}

/// The step from a gear to the next as a target: that of the wish. Ratios fall; an end that the wish leaves open is far from
/// the steps that the ratios allow.
fn step(gear: &SchemeGear, next: &SchemeGear, wished: &Bounds) -> String {
    let own = &gear.ratio / &next.ratio;
    let low = wished.min.clone().filter(|min| *min > Rational::ONE).unwrap_or(Rational::ONE);
    let high = wished.max.clone().unwrap_or_else(|| &own * &Rational::from(2));
    format!("step = [\"{}\", \"{}\"]", low.to_fraction(), high.to_fraction())
}

impl Scheme {
    /// The scheme as a design file, for the search for tooth numbers ([`Design`](crate::teeth::Design)): its
    /// connections, elements and gears, with ranges for the teeth of every set.
    ///
    /// * Each gear has its ratio as a target, within 0.5 % and within the range of the wish, and the steps of the wish to
    ///   the next gear; the limits of the wish on speeds, torques and efficiency stay. That no step is larger than the one before
    ///   it is not asked.
    /// * Teeth are 12 at least, and 120 at most on a ring, or more where the basic ratio of the set needs them. The teeth
    ///   of the wish are within these ranges. A set has 3 to 6 planets; rings may have a tooth more or less
    ///   than sun and planets without profile shift.
    ///
    /// # Example
    /// The teeth from which a scheme comes are among those that are found for it.
    /// ```
    /// use willis::work::Serial;
    /// use willis_synthesis::schemes::{Known, Search, Wish};
    /// use willis_synthesis::teeth::{Design, Request};
    ///
    /// let wish = Wish { step: "1.1..2.2".parse()?, ..Wish::new(&["62/26", "74/42"], 5, 2, 4)? };
    /// let scheme = Known::named("gm").unwrap().rediscover(&Search::new(&wish)?).scheme.unwrap();
    /// let design = Design::from_toml(&scheme.to_design(&wish))?;
    /// let own = Some(("gm".to_owned(), scheme.to_toml()));
    /// let answer = design.answer(&Request { own, ..Request::default() }, &Serial)?;
    /// assert!(answer.completeness.complete && !answer.rows.is_empty());
    /// assert!(answer.own.unwrap().fails.is_empty());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn to_design(&self, wish: &Wish) -> String {
        let mut text = self.head();
        text += "\n[design]\n";
        let _ = writeln!(text, "tolerance = {}", TOLERANCE as f64 / 1000.0);
        text += "planets = \"3..6\"\nmismatch = [-1, 0, 1]\nrules = [\"assembly\", \"clearance\"]\ngap = 0.5\n";
        let limits = [("member_speed", &wish.max_speed), ("element_torque", &wish.max_torque)];
        let limits: Vec<String> =
            limits.iter().filter_map(|(key, limit)| Some(format!("{key} = {}", limit.as_ref()?.to_f64()))).collect();
        if !limits.is_empty() {
            let _ = writeln!(text, "limits = {{ {} }}", limits.join(", "));
        }
        if let Some(least) = &wish.min_efficiency {
            let _ = writeln!(text, "require = {{ forward = {} }}", decimal(least));
        }
        text += "minimize = [\"error\", \"ring_diameter\"]\nmaximize = [\"forward\"]\n";
        for (n, gear) in self.gears.iter().enumerate() {
            let ratio = ratio(gear, &wish.forward_range);
            let _ = write!(text, "\n[[design.target]]\nstate = \"{}\"\n{ratio}\n", gear.name);
            if let Some(next) = self.gears.get(n + 1) {
                let _ = writeln!(text, "{}", step(gear, next, &wish.step));
            }
        }
        for gear in &self.reverse {
            let ratio = ratio(gear, &wish.reverse_range);
            let _ = write!(text, "\n[[design.target]]\nstate = \"{}\"\n{ratio}\n", gear.name);
        }
        for (n, set) in self.sets.iter().enumerate() {
            let [least, most] = range(set);
            let [sun, ring, carrier] = self.members(n);
            let _ = write!(
                text,
                "\n[[set]]\nname = \"P{}\"\nsun = {{ member = \"{sun}\", teeth = \"{least}..{most}\" }}\nplanet = {{ teeth = \
                 \"{least}..{most}\" }}\nring = {{ member = \"{ring}\", teeth = \"..{most}\" }}\ncarrier = \
                 \"{carrier}\"\nmesh_efficiency = {{ external = {}, internal = {} }}\n",
                n + 1,
                decimal(&self.mesh_efficiencies[0]),
                decimal(&self.mesh_efficiencies[1]),
            );
        }
        text + &self.elements_and_states()
    }
}
