//! Where the mean tooth force meets the line of centres.
//!
//! A loss in the mesh moves the force off the pitch point, by an offset δ along the line of centres (Galvagno
//! 2010, section 2). The equations of motion here hold tooth *torques* and efficiencies instead, which is the same
//! motion without the limit of [`internal`]; the offset is a derived quantity.
//!
//! Arms of the force: of an external pair `R_1 + d` and `R_2 − d`, of an internal pair `R_1 + d` and `R_2 + d`, where
//! `d = δ` if the first gear drives and `d = −δ` if the second does.

/// Which gear of a pair drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The first gear.
    First,
    /// The second gear.
    Second,
}

/// Offset of the force of two external gears, in the unit of their pitch radii.
///
/// `(1 − η)/(η/R_1 + 1/R_2)` if the first drives, `(1 − η)/(η/R_2 + 1/R_1)` if the second does. Source: Galvagno 2010,
/// eqs. (1), (2), re-derived from the arms. `None` unless `0 < η ≤ 1` and the radii are positive.
///
/// # Example
/// ```
/// use willis::dynamics::offset::{Driver, external};
///
/// let (sun, planet) = (30.0, 21.0);
/// let d = external(Driver::First, 0.97, [sun, planet]).unwrap();
/// let efficiency = (planet - d) * sun / ((sun + d) * planet);
/// assert!((efficiency - 0.97).abs() < 1e-15);
/// ```
pub fn external(driver: Driver, efficiency: f64, [first, second]: [f64; 2]) -> Option<f64> {
    let good = first > 0.0 && second > 0.0;
    if good { offset(driver, efficiency, [first, second]) } else { None }
}

/// Offset of the force of an external gear, the first, in an internal one, in the unit of their pitch radii.
///
/// `(1 − η)/(η/R_1 − 1/R_2)` if the external gear drives, `(1 − η)/(1/R_1 − η/R_2)` if the internal one does. Source:
/// Galvagno 2010, eqs. (1), (2), re-derived from the arms; the paper does not name the limit.
///
/// `None` unless `0 < η ≤ 1` and `0 < R_1 < R_2`; and, if the external gear drives, unless `η > R_1/R_2`: no force
/// on the line of centres loses more.
///
/// # Example
/// ```
/// use willis::dynamics::offset::{Driver, internal};
///
/// let (planet, ring) = (21.0, 72.0);
/// let d = internal(Driver::First, 0.88, [planet, ring]).unwrap();
/// let efficiency = (ring + d) * planet / ((planet + d) * ring);
/// assert!((efficiency - 0.88).abs() < 1e-15);
/// assert_eq!(internal(Driver::First, 21.0 / 72.0, [planet, ring]), None);
/// assert!(internal(Driver::Second, 21.0 / 72.0, [planet, ring]).is_some());
/// ```
pub fn internal(driver: Driver, efficiency: f64, [first, second]: [f64; 2]) -> Option<f64> {
    let good = first > 0.0 && second > first && (driver == Driver::Second || efficiency * second > first);
    if good { offset(driver, efficiency, [first, -second]) } else { None }
}

/// A negative radius is that of an internal gear.
fn offset(driver: Driver, efficiency: f64, [first, second]: [f64; 2]) -> Option<f64> {
    if !(efficiency > 0.0 && efficiency <= 1.0) {
        return None;
    }
    let curvature = match driver {
        Driver::First => efficiency / first + 1.0 / second,
        Driver::Second => efficiency / second + 1.0 / first,
    };
    let offset = (1.0 - efficiency) / curvature;
    offset.is_finite().then_some(offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn theory_the_arms_give_the_efficiency_back() {
        let [sun, planet, ring] = [0.05, 0.012, 0.074];
        for percent in 17..=100 {
            let eta = f64::from(percent) / 100.0;
            let close = |x: f64| assert!((x - eta).abs() < 1e-12, "{x} {eta}");
            let d = external(Driver::First, eta, [sun, planet]).unwrap();
            close((planet - d) * sun / ((sun + d) * planet));
            let d = -external(Driver::Second, eta, [sun, planet]).unwrap();
            close((sun + d) * planet / ((planet - d) * sun));
            let d = internal(Driver::First, eta, [planet, ring]).unwrap();
            close((ring + d) * planet / ((planet + d) * ring));
            let d = -internal(Driver::Second, eta, [planet, ring]).unwrap();
            close((planet + d) * ring / ((ring + d) * planet));
        }
        assert_eq!(external(Driver::First, 1.0, [sun, planet]), Some(0.0));
    }

    #[test]
    fn regress_beyond_the_limit_there_is_none() {
        let [planet, ring] = [0.012, 0.074];
        assert_eq!(internal(Driver::First, 0.16, [planet, ring]), None);
        assert!(internal(Driver::Second, 0.16, [planet, ring]).unwrap() < planet);
        for eta in [0.0, -0.5, 1.01, f64::NAN] {
            assert_eq!(external(Driver::First, eta, [0.03, 0.02]), None);
            assert_eq!(internal(Driver::Second, eta, [planet, ring]), None);
        }
        assert_eq!(external(Driver::Second, 0.9, [0.03, 0.0]), None);
        assert_eq!(internal(Driver::Second, 0.9, [ring, planet]), None);
    }
}
