//! Oils: viscosity and density over temperature, pressure-viscosity coefficient.
//!
//! ```
//! use willis::catalogue::oil;
//!
//! let oil = oil::find("iso vg 220").unwrap();
//! let eta = oil.dynamic_viscosity(353.15);
//! assert!((0.02..0.04).contains(&eta));
//! ```

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::Trust;
use crate::real::Real;

/// Base of a lubricating oil.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Base {
    /// Mineral oil.
    Mineral,
    /// Poly-α-olefin.
    Pao,
    /// Ester.
    Ester,
    /// Polyglycol.
    Pag,
    /// Phosphate ester.
    PhosphateEster,
    /// Traction fluid.
    Traction,
}

impl Base {
    /// Factor `X_L` of the lubricant in the friction of ISO/TR 14179-2 at the sum of the surface
    /// speeds `v_ΣC` (m/s). Mineral oil 1; the others are to be confirmed in the standard.
    pub fn lubricant_factor<D: Real>(self, pitch_sum_speed: D) -> D {
        match self {
            Self::Mineral => D::from(1.0),
            Self::Pao | Self::Ester => D::from(0.8),
            Self::Pag => (pitch_sum_speed / 6.0).powf(-0.2) * 0.75,
            Self::PhosphateEster => D::from(1.3),
            Self::Traction => D::from(1.5),
        }
    }

    /// Change of density with temperature over the density at 15 °C, 1/K. Of phosphate esters and
    /// traction fluids a general value.
    pub fn expansion(self) -> f64 {
        match self {
            Self::Mineral => -5.8e-4,
            Self::Pao => -5.5e-4,
            Self::Ester => -8.1e-4,
            Self::Pag => -7.1e-4,
            Self::PhosphateEster | Self::Traction => -6.5e-4,
        }
    }

    /// Pressure-viscosity coefficient at the kinematic viscosity `ν` (m²/s) after Gold, 1/Pa:
    /// `α = s ν^t` with ν in mm²/s and α in 1/GPa. The constants are to be confirmed in the paper;
    /// phosphate esters are taken as esters, traction fluids as mineral oil.
    pub fn gold_pressure_viscosity<D: Real>(self, kinematic_viscosity: D) -> D {
        let (s, t) = match self {
            Self::Mineral | Self::Traction => (9.904, 0.1390),
            Self::Pao => (7.382, 0.1335),
            Self::Ester | Self::PhosphateEster => (6.605, 0.1360),
            Self::Pag => (5.489, 0.1485),
        };
        let nu_mm2_s = kinematic_viscosity * 1e6;
        nu_mm2_s.powf(t) * (s * 1e-9)
    }
}

/// How the viscosity of an oil depends on its temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Viscosity<R = f64> {
    /// ASTM D341: `log10 log10(ν + 0.7) = A − B log10 T`, ν in mm²/s, T in K. Meant for
    /// ν > 2 mm²/s; below, ASTM adds terms that are left out.
    Walther {
        /// `A`
        a: R,
        /// `B`
        b: R,
    },
    /// Vogel: `η = K exp(B/(t + C))`.
    Vogel {
        /// `K`, Pa s
        k: R,
        /// `B`, K
        b: R,
        /// `C` for t in °C, K
        c: R,
    },
    /// One dynamic viscosity, the one at the operating temperature.
    Fixed {
        /// Dynamic viscosity, Pa s
        dynamic: R,
        /// `−(1/η) dη/dT` there, 1/K, for laws that ask for it
        slope: f64,
    },
}

/// A lubricating oil.
#[derive(Clone, Debug, PartialEq)]
pub struct Oil {
    /// What it is called.
    pub name: String,
    /// Its base.
    pub base: Base,
    /// Viscosity over temperature.
    pub viscosity: Viscosity,
    /// Density at 15 °C, kg/m³; of an oil of fixed viscosity the density at its temperature.
    pub density_15: f64,
    /// Change of density with temperature over [`Self::density_15`], 1/K.
    pub expansion: f64,
    /// Pressure-viscosity coefficient where it was measured, 1/Pa; otherwise by the base, after Gold.
    pub measured_pressure_viscosity: Option<f64>,
    /// Thermal conductivity where it was measured, W/(m K); otherwise from the density.
    pub measured_conductivity: Option<f64>,
    /// Factor `X_L` of the mean coefficient of friction of teeth, where it was measured.
    pub lubricant_factor: Option<f64>,
    /// Boundary and full-film coefficient of sliding friction of roller bearings, where measured.
    pub sliding_roller: Option<[f64; 2]>,
    /// The same of ball bearings.
    pub sliding_ball: Option<[f64; 2]>,
    /// Lowest and highest temperature for which the data are meant, K.
    pub range: [f64; 2],
    /// Where the data come from.
    pub source: String,
    /// How far they were checked.
    pub trust: Trust,
}

const ZERO_CELSIUS: f64 = 273.15;

/// `A` and `B` of ASTM D341 through two points: temperature in K, viscosity in m²/s.
fn walther<R: Real>((t1, nu1): (f64, R), (t2, nu2): (f64, R)) -> Viscosity<R> {
    let [z1, z2] = [nu1, nu2].map(|nu| (nu * 1e6 + 0.7).log10().log10());
    let b = (z1 - z2) / (t2.log10() - t1.log10());
    Viscosity::Walther { a: z1 + b * t1.log10(), b }
}

impl<R: Real> Viscosity<R> {
    /// ASTM D341 through the kinematic viscosities at 40 and 100 °C, m²/s.
    pub(crate) fn through(nu_40: R, nu_100: R) -> Self {
        walther((40.0 + ZERO_CELSIUS, nu_40), (100.0 + ZERO_CELSIUS, nu_100))
    }
}

impl Oil {
    fn new(name: &str, base: Base, viscosity: Viscosity, density: f64, expansion: f64, celsius: [f64; 2]) -> Self {
        Self {
            name: name.to_owned(),
            base,
            viscosity,
            density_15: density,
            expansion,
            measured_pressure_viscosity: None,
            measured_conductivity: None,
            lubricant_factor: None,
            sliding_roller: None,
            sliding_ball: None,
            range: celsius.map(|t| t + ZERO_CELSIUS),
            source: "given".to_owned(),
            trust: Trust::Seen,
        }
    }

    /// An oil known by its kinematic viscosity at 40 and at 100 °C (m²/s, the first the larger, both
    /// above 0.31 mm²/s) and its density at 15 °C (kg/m³). Good for 20 to 120 °C.
    ///
    /// ```
    /// use willis::catalogue::oil::{Base, Oil};
    ///
    /// let oil = Oil::from_two_points("VG 100", Base::Mineral, 100e-6, 11e-6, 880.0);
    /// assert_eq!(format!("{:.2}", oil.kinematic_viscosity(353.15) * 1e6), "19.32");
    /// ```
    pub fn from_two_points(name: &str, base: Base, nu_40: f64, nu_100: f64, density_15: f64) -> Self {
        let law = Viscosity::through(nu_40, nu_100);
        Self::new(name, base, law, density_15, base.expansion(), [20.0, 120.0])
    }

    /// An oil of one dynamic viscosity (Pa s) and one density (kg/m³), those at the operating
    /// temperature, whatever that is. Its slope `−(1/η) dη/dT` is taken as 0.04/K.
    pub fn fixed(name: &str, base: Base, dynamic_viscosity: f64, density: f64) -> Self {
        let law = Viscosity::Fixed { dynamic: dynamic_viscosity, slope: 0.04 };
        Self { range: [0.0, f64::INFINITY], ..Self::new(name, base, law, density, 0.0, [0.0, 0.0]) }
    }

    /// An oil by Vogel's equation, `η = K exp(B/(t + C))`, K in Pa s and t in °C. Good for 20 to 120 °C.
    pub fn vogel(name: &str, base: Base, k: f64, b: f64, c: f64, density_15: f64) -> Self {
        Self::new(name, base, Viscosity::Vogel { k, b, c }, density_15, base.expansion(), [20.0, 120.0])
    }

    /// Lowest and highest temperature for which the data are meant, K. Outside, the laws below go
    /// on with their formula; it is for the caller to warn.
    pub fn temperature_range(&self) -> [f64; 2] {
        self.range
    }

    /// Whether the data are meant for this temperature (K).
    pub fn covers(&self, temperature: f64) -> bool {
        (self.range[0]..=self.range[1]).contains(&temperature)
    }

    /// Density `ρ`, kg/m³, at the temperature `T` in K: `ρ15 (1 + a (T − 288.15))`.
    pub fn density<D: Real>(&self, temperature: D) -> D {
        self.curves().density(temperature)
    }

    /// Kinematic viscosity `ν`, m²/s, at the temperature `T` in K.
    pub fn kinematic_viscosity<D: Real>(&self, temperature: D) -> D {
        self.curves().kinematic_viscosity(temperature)
    }

    /// Dynamic viscosity `η = ν ρ`, Pa s, at the temperature `T` in K.
    pub fn dynamic_viscosity<D: Real>(&self, temperature: D) -> D {
        self.curves().dynamic_viscosity(temperature)
    }

    /// Pressure-viscosity coefficient `α`, 1/Pa, at the temperature `T` in K: measured, or after Gold.
    pub fn pressure_viscosity<D: Real>(&self, temperature: D) -> D {
        self.curves().pressure_viscosity(temperature)
    }

    /// Slope of the viscosity `β = −(1/η) dη/dT`, 1/K, at the temperature `T` in K. For ASTM D341
    /// it is `B (ν + 0.7) ln(ν + 0.7)/(ν T) − (1/ρ) dρ/dT`.
    pub fn viscosity_slope<D: Real>(&self, temperature: D) -> D {
        self.curves().viscosity_slope(temperature)
    }

    /// Thermal conductivity `k`, W/(m K), at the temperature `T` in K: measured, or
    /// `0.120 (1 − 0.0005 t/3)/ρ` with t in °C and ρ in g/cm³.
    pub fn conductivity<D: Real>(&self, temperature: D) -> D {
        self.curves().conductivity(temperature)
    }

    /// What its state follows from.
    pub(crate) fn curves<D: Real>(&self) -> Curves<D> {
        Curves {
            base: self.base,
            viscosity: match self.viscosity {
                Viscosity::Walther { a, b } => Viscosity::Walther { a: D::from(a), b: D::from(b) },
                Viscosity::Vogel { k, b, c } => Viscosity::Vogel { k: D::from(k), b: D::from(b), c: D::from(c) },
                Viscosity::Fixed { dynamic, slope } => Viscosity::Fixed { dynamic: D::from(dynamic), slope },
            },
            density_15: D::from(self.density_15),
            expansion: self.expansion,
            measured_pressure_viscosity: self.measured_pressure_viscosity.map(D::from),
            measured_conductivity: self.measured_conductivity,
        }
    }
}

/// The numbers of an oil from which its state at a temperature follows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Curves<D> {
    pub base: Base,
    pub viscosity: Viscosity<D>,
    pub density_15: D,
    pub expansion: f64,
    pub measured_pressure_viscosity: Option<D>,
    pub measured_conductivity: Option<f64>,
}

/// Each as the method of [`Oil`] of the same name says.
impl<D: Real> Curves<D> {
    pub fn density(&self, temperature: D) -> D {
        ((temperature - (15.0 + ZERO_CELSIUS)) * self.expansion + 1.0) * self.density_15
    }

    pub fn kinematic_viscosity(&self, temperature: D) -> D {
        match self.viscosity {
            Viscosity::Walther { a, b } => {
                let log = (-temperature.log10() * b + a) * std::f64::consts::LN_10;
                ((log.exp() * std::f64::consts::LN_10).exp() - 0.7) * 1e-6
            }
            _ => self.dynamic_viscosity(temperature) / self.density(temperature),
        }
    }

    pub fn dynamic_viscosity(&self, temperature: D) -> D {
        match self.viscosity {
            Viscosity::Walther { .. } => self.kinematic_viscosity(temperature) * self.density(temperature),
            Viscosity::Vogel { k, b, c } => ((temperature - (-c + ZERO_CELSIUS)).recip() * b).exp() * k,
            Viscosity::Fixed { dynamic, .. } => dynamic,
        }
    }

    pub fn pressure_viscosity(&self, temperature: D) -> D {
        match self.measured_pressure_viscosity {
            Some(alpha) => alpha,
            None => self.base.gold_pressure_viscosity(self.kinematic_viscosity(temperature)),
        }
    }

    pub fn viscosity_slope(&self, temperature: D) -> D {
        match self.viscosity {
            Viscosity::Walther { b, .. } => {
                let nu_mm2_s = self.kinematic_viscosity(temperature) * 1e6;
                let sum = nu_mm2_s + 0.7;
                let thermal = self.density(temperature).recip() * (self.density_15 * self.expansion);
                sum * sum.ln() * b / (nu_mm2_s * temperature) - thermal
            }
            Viscosity::Vogel { b, c, .. } => (temperature - (-c + ZERO_CELSIUS)).powi(-2) * b,
            Viscosity::Fixed { slope, .. } => D::from(slope),
        }
    }

    pub fn conductivity(&self, temperature: D) -> D {
        match self.measured_conductivity {
            Some(k) => D::from(k),
            None => {
                let celsius = temperature - ZERO_CELSIUS;
                let rho_g_cm3 = self.density(temperature) * 1e-3;
                (-celsius * (0.0005 / 3.0) + 1.0) * 0.120 / rho_g_cm3
            }
        }
    }
}

/// Viscosity under pressure after Barus, `η = η0 exp(α p)`; Pa s, 1/Pa, Pa.
pub fn barus<D: Real>(dynamic_viscosity: D, pressure_viscosity: D, pressure: D) -> D {
    dynamic_viscosity * (pressure_viscosity * pressure).exp()
}

/// Viscosity under pressure after Roelands,
/// `η = η0 exp((ln η0 + 9.67)(−1 + (1 + 5.1e−9 p)^Z))` with `Z = α/(5.1e−9 (ln η0 + 9.67))`, so that
/// its slope at p = 0 is α; Pa s, 1/Pa, Pa. The constants are to be confirmed.
pub fn roelands<D: Real>(dynamic_viscosity: D, pressure_viscosity: D, pressure: D) -> D {
    let level = dynamic_viscosity.ln() + 9.67;
    let z = pressure_viscosity / (level * 5.1e-9);
    dynamic_viscosity * (level * (((pressure * 5.1e-9 + 1.0).ln() * z).exp() - 1.0)).exp()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Row {
    name: String,
    base: Base,
    nu40: Option<f64>,
    nu100: Option<f64>,
    walther: Option<[f64; 2]>,
    vogel: Option<[f64; 3]>,
    eta: Option<f64>,
    rho: Option<f64>,
    rho15: Option<f64>,
    alpha: Option<f64>,
    conductivity: Option<f64>,
    x_l: Option<f64>,
    sliding_roller: Option<[f64; 2]>,
    sliding_ball: Option<[f64; 2]>,
    t: Option<[f64; 2]>,
    source: String,
    trust: Trust,
}

#[derive(Deserialize)]
struct File {
    oil: Vec<Row>,
}

fn oil(row: Row) -> Oil {
    let density = row.rho15.or(row.rho).expect("data/oils.toml gives a density");
    let mut oil = match (row.nu40.zip(row.nu100), row.walther, row.vogel, row.eta) {
        (Some((nu_40, nu_100)), ..) => Oil::from_two_points(&row.name, row.base, nu_40 * 1e-6, nu_100 * 1e-6, density),
        (_, Some([a, b]), ..) => {
            let law = Viscosity::Walther { a, b };
            Oil::new(&row.name, row.base, law, density, row.base.expansion(), [20.0, 120.0])
        }
        (_, _, Some([k, b, c]), _) => Oil::vogel(&row.name, row.base, k * 1e-3, b, c, density),
        (_, _, _, eta) => {
            Oil::fixed(&row.name, row.base, eta.expect("data/oils.toml gives a viscosity") * 1e-3, density)
        }
    };
    if let Some(celsius) = row.t {
        oil.range = celsius.map(|t| t + ZERO_CELSIUS);
    }
    Oil {
        measured_pressure_viscosity: row.alpha.map(|a| a * 1e-9),
        measured_conductivity: row.conductivity,
        lubricant_factor: row.x_l,
        sliding_roller: row.sliding_roller,
        sliding_ball: row.sliding_ball,
        source: row.source,
        trust: row.trust,
        ..oil
    }
}

/// Every oil of the catalogue, `data/oils.toml`.
pub fn all() -> &'static [Oil] {
    static ALL: OnceLock<Vec<Oil>> = OnceLock::new();
    ALL.get_or_init(|| {
        let file: File = toml::from_str(include_str!("../../data/oils.toml")).expect("data/oils.toml is read");
        file.oil.into_iter().map(oil).collect()
    })
}

/// The oil of that name; capitals and blanks do not matter.
pub fn find(name: &str) -> Option<&'static Oil> {
    let plain =
        |text: &str| text.chars().filter(|c| !c.is_whitespace()).flat_map(char::to_lowercase).collect::<String>();
    let wanted = plain(name);
    all().iter().find(|o| plain(&o.name) == wanted)
}
