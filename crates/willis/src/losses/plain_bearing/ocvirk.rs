use super::{Journal, Law};
use crate::losses::{LawInfo, ValidityRange, Trust};
use crate::real::{self, Real};

/// Torque of a loaded plain bearing by the theory of short bearings.
///
/// # Formula
/// ```text
/// F = η U b³/(4 c²) · ε/(1 − ε²)² · √(16 ε² + π² (1 − ε²)),  U = ω d/2,  c = s/2
/// M = M_0/√(1 − ε²) + ½ c ε F sin φ,  M_0 = π η ω d³ b/(2 s),  tan φ = π √(1 − ε²)/(4 ε)
/// ```
///
/// # Symbols
/// | there | here        | unit there | meaning                          |
/// |-------|-------------|------------|----------------------------------|
/// | ω     | `speed`     | rad/s      | relative speed                   |
/// | d     | `diameter`  | m          | shaft diameter                   |
/// | b     | `width`     | m          | width                            |
/// | s     | `clearance` | m          | difference of the two diameters  |
/// | F     | `load`      | N          | load                             |
/// | η     | `viscosity` | Pa s       | dynamic viscosity                |
/// | ε     | −           | −          | eccentricity over c, 0 to 1      |
/// | −     | `friction`  | −          | beyond ε = 0.95 there is no full film, and the torque is at most µ F d/2 |
///
/// # Valid for
/// Width up to the diameter, and a full film: ε up to 0.95.
///
/// # Departs from the source
/// The film of the unloaded half shears as if it were full. Beyond the film the coefficient of friction holds.
///
/// # Source
/// `[duboisocvirk1953]`, short bearings; derived again here from Reynolds' equation without the circumferential pressure
/// flow, half-film condition. The numbers of the equations there are not known to us.
///
/// # Example
/// The bearing of [`Journal::typical`]: ε = 0.7144 by a change of sign, M = 0.0846 + 0.0098 = 0.0944 N m.
/// ```
/// # use willis::losses::plain_bearing::{Journal, Law, Ocvirk};
/// assert_eq!(format!("{:.4}", Ocvirk::DEFAULT.eval(&Journal::typical())), "0.0944");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ocvirk;

impl Ocvirk {
    /// As derived.
    pub const DEFAULT: Self = Self;
}

/// Eccentricity beyond which the film is too thin to keep the surfaces apart.
const THIN: f64 = 0.95;

/// Load over `η U b³/(4 c²)` at an eccentricity.
fn load<D: Real>(e: D) -> D {
    let square = e * e;
    let free = -square + 1.0;
    e / (free * free) * (square * 16.0 + free * std::f64::consts::PI.powi(2)).sqrt()
}

/// What the load is over `η U b³/(4 c²)`.
fn wanted<D: Real>(s: &Journal<D>) -> D {
    s.load * s.clearance.powi(2) / (s.viscosity * s.speed * s.diameter * s.width.powi(3)) * 2.0
}

/// Eccentricity over the radial clearance.
fn eccentricity(load_number: f64) -> f64 {
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if load(middle) < load_number { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn narrow(s: &Journal<f64>) -> f64 {
    s.width / s.diameter
}

fn eccentric(s: &Journal<f64>) -> f64 {
    eccentricity(wanted(s))
}

impl Law for Ocvirk {
    const META: LawInfo<Journal<f64>> = LawInfo {
        id: "ocvirk",
        by: "Ocvirk",
        title: "Ocvirk: short bearing",
        source: ("duboisocvirk1953", "short bearings"),
        trust: Trust::Derived,
        tags: &[],
        valid: &[
            ValidityRange { symbol: "b/d", unit: "-", min: 0.0, max: 1.0, get: narrow },
            ValidityRange { symbol: "ε", unit: "-", min: 0.0, max: 0.95, get: eccentric },
        ],
    };

    fn eval<D: Real>(&self, s: &Journal<D>) -> D {
        let most = s.friction * s.load * s.diameter * 0.5;
        if s.speed.re() <= 0.0 {
            return most;
        }
        let centred = super::petroff::centred(s);
        let number = wanted(s);
        if number.re() <= 0.0 {
            return centred;
        }
        // A root of the plain number, and one Newton step that carries the derivatives.
        let e = eccentricity(number.re());
        let slope = num_dual::first_derivative(load, e).1;
        if !(slope.is_finite() && e < 1.0 - 1e-9) {
            return most;
        }
        let e = (number - load(e)) / slope + e;
        let film = |e: &D| {
            let root = (-(*e * *e) + 1.0).sqrt();
            let tangent = root / *e * (std::f64::consts::PI / 4.0);
            let sine = tangent / (tangent * tangent + 1.0).sqrt();
            centred / root + s.clearance * *e * s.load * sine * 0.25
        };
        match e.re() > THIN {
            true => real::min(film(&e), real::max(most, film(&D::from(THIN)))),
            false => film(&e),
        }
    }
}
