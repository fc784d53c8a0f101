use num_dual::{DualNum, DualStruct};

use super::{BearingDuty, Law, Supply, pow};
use crate::catalogue::bearing::{BearingData, Kind, Seal, SealKind, SkfConstants};
use crate::catalogue::oil::Base;
use crate::losses::{LawInfo, Trust};
use crate::real::{self, Inner, Real};

/// Frictional torque of a rolling bearing after SKF (catalogues of 2013 and 2018).
///
/// # Formula
/// ```text
/// M = φ_ish φ_rs M_rr + M_sl + M_seal + M_drag
/// M_rr = G_rr (ν n)^0.6,  M_sl = G_sl μ_sl,  M_seal = K_S1 d_s^β + K_S2
/// φ_ish = 1/(1 + 1.84e-9 (n d_m)^1.28 ν^0.64)
/// φ_rs  = exp(−K_rs ν n (d + D) √(K_Z/(2 (D − d))))
/// μ_sl  = φ_bl μ_bl + (1 − φ_bl) μ_EHL,  φ_bl = exp(−2.6e-8 (n ν)^1.4 d_m)
/// M_drag = 0.4 V_M K_ball d_m⁵ n² + M_t           (balls)
/// M_drag = 4 V_M K_roll C_w B d_m⁴ n² + M_t       (rollers)
/// M_t    = 1.093e-7 n² d_m³ (n d_m² f_t/ν)^(−1.379) R_s
/// K_ball = i_rw K_Z (d + D)/(D − d) 1e-12,  K_roll = K_L K_Z (d + D)/(D − d) 1e-12
/// C_w = 2.789e-10 l_D³ − 2.786e-4 l_D² + 0.0195 l_D + 0.6439,  l_D = 5 K_L B/d_m
/// t   = 2 acos((0.6 d_m − H)/(0.6 d_m)), H ≤ 1.2 d_m
/// f_t = sin(t/2) for t ≤ π, else 1
/// R_s = 0.36 d_m² (t − sin t) f_A,  f_A = 0.05 K_Z (D + d)/(D − d)
/// ```
/// `G_rr` and `G_sl` by type, with α_F = 24.6 (F_a/C_0)^0.24 degrees:
/// ```text
/// deep groove   R1 d_m^1.96 (F_r + R2/sin α_F F_a)^0.54
///               F_a = 0: S1 d_m^−0.26 F_r^(5/3)
///               F_a > 0: S1 d_m^−0.145 (F_r⁵ + S2 d_m^1.5/sin α_F F_a⁴)^(1/3)
/// angular, 4-pt R1 d_m^1.97 (F_r + R3 d_m⁴ n² + R2 F_a)^0.54
///               S1 d_m^0.26 ((F_r + S3 d_m⁴ n²)^(4/3) + S2 F_a^(4/3))
/// self-aligning R1 d_m² (F_r + R3 d_m^3.5 n² + R2 F_a)^0.54
///               S1 d_m^−0.12 ((F_r + S3 d_m^3.5 n²)^(4/3) + S2 F_a^(4/3))
/// cylindrical   R1 d_m^2.41 F_r^0.31;  S1 d_m^0.9 F_a + S2 d_m F_r
/// tapered       R1 d_m^2.38 (F_r + R2 Y F_a)^0.31;  S1 d_m^0.82 (F_r + S2 Y F_a)
/// spherical     min(R1 d_m^1.85 (F_r + R2 F_a)^0.54, R3 d_m^2.3 (F_r + R4 F_a)^0.31)
///               min(S1 d_m^0.25 (F_r⁴ + S2 F_a⁴)^(1/3), S3 d_m^0.94 (F_r³ + S4 F_a³)^(1/3))
/// toroidal      min(R1 d_m^1.97 F_r^0.54, R2 d_m^2.37 F_r^0.31)
///               min(S1 d_m^−0.19 F_r^(5/3), S2 d_m^1.05 F_r)
/// axial ball    R1 d_m^1.83 F_a^0.54;  S1 d_m^0.05 F_a^(4/3)
/// axial roller  R1 d_m^2.38 F_a^0.31;  S1 d_m^0.62 F_a
/// ```
///
/// # Symbols
/// | there        | here                   | unit there | meaning                                          |
/// |--------------|------------------------|------------|--------------------------------------------------|
/// | M            | result                 | N mm       | frictional torque                                |
/// | n            | `speed`                | r/min      | speed of one ring relative to the other          |
/// | ν            | `kinematic_viscosity`  | mm²/s      | at the operating temperature                     |
/// | d, D, B, d_m | `bearing`              | mm         | bore, outside diameter, width, (d + D)/2         |
/// | F_r, F_a     | `radial_load`, `axial_load` | N     | loads                                            |
/// | C_0, Y       | `bearing`              | N, −       | static rating, axial factor                      |
/// | R, S, K_Z, K_L | `bearing.skf`        | −          | constants of type and series                     |
/// | V_M          | `bearing.skf`          | −          | drag loss factor over H/d_m, read from a diagram |
/// | H            | `supply`               | mm         | oil level over the lowest contact                |
/// | K_rs         | `supply`               | −          | 0 bath, 3e-8 low bath or jet, 6e-8 grease, mist  |
/// | μ_bl         | `sliding_friction`     | −          | 0.12; 0.15 at start                              |
/// | μ_EHL        | `sliding_friction`     | −          | 0.02 cylindrical, 0.002 tapered, else by the oil |
/// | d_s, K_S1, K_S2, β | `bearing.seal`   | mm         | rubbing seals                                    |
///
/// # Valid for
/// Bearings of normal clearance and alignment above their minimum load, up to their speed rating.
/// The source prints no other range. Against measurements on a tapered bearing it came out 1.3 to
/// 2.1 times too high; it errs on the safe side. `V_M` was digitised by a third party, ±10 %.
///
/// # Departs from the source
/// Speed 0 gives the starting torque, `M_sl` with μ_bl = 0.15 and the seals; just above it μ_bl is
/// 0.12, so the torque steps there (the power does not). A bath counts as low up to the middle of
/// the lowest rolling element. A jet has the drag of a bath of that level, times 2. Mist and grease
/// have no drag. μ_EHL by the base of the oil: mineral 0.05, traction fluids 0.1, all others 0.04.
/// Where `C_0` is not known α_F is 15°, where `Y` is not known it is 1.5. Where d_s is not known it is
/// d + (D − d) times 0.32 (RS1), 0.25 (RSH, RSL, CS), 0.8 (LS): estimates. Seals RSH and RSL beyond
/// their printed size take the row RS1. The formula for F_a > 0 of deep groove bearings does not
/// tend to the one for F_a = 0, in the source as here. The formula for F_a = 0 is also taken for a
/// vanishing load. A bearing without constants (needle rollers) gets [`Palmgren`](super::Palmgren)'s torque.
///
/// # Source
/// `[skf2018]`, frictional moment and power loss. In the note on the model K_rs stands on page 4, the
/// constants of G_rr and G_sl in table 2, those of the seals in table 3. In the catalogue of 2013 the
/// chapter begins on page 98, the sliding moment on page 103 and table 2a on page 104.
///
/// # Example
/// By hand, NU 308 (R1 1.09e-6; S1 0.16, S2 0.0015), 5 kN, 1500 r/min, 40 mm²/s, no oil level:
/// G_rr = 1.09e-6 · 65^2.41 · 5000^0.31 = 0.3575, (40 · 1500)^0.6 = 736.0, φ_ish = 0.9547, so
/// φ_ish M_rr = 251.2; G_sl = 0.0015 · 65 · 5000 = 487.5, μ_sl = 0.02003, M_sl = 9.76; sum 260.9 N mm.
/// ```
/// # use willis::losses::bearing::{BearingDuty, Law, Skf, Supply};
/// let duty = BearingDuty { supply: Supply::Bath { level: 0.0 }, ..BearingDuty::typical() };
/// let law = Skf { starvation: Some(0.0), ..Skf::DEFAULT };
/// assert_eq!(format!("{:.4}", law.eval(&duty)), "0.2609");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Skf {
    /// `K_rs`, where it is not to follow from the supply.
    pub starvation: Option<f64>,
    /// `V_M`, where it is not to follow from the oil level.
    pub drag_loss_factor: Option<f64>,
}

impl Skf {
    /// As published.
    pub const DEFAULT: Self = Self { starvation: None, drag_loss_factor: None };

    /// The parts of the torque; `None` for a bearing without constants.
    pub fn parts<D: Real>(&self, s: &BearingDuty<D>) -> Option<Parts<D>> {
        Some(self.turning(s)?.parts(s))
    }

    /// What of it no load changes; `None` for a bearing without constants.
    pub(super) fn turning<D: Real>(&self, s: &BearingDuty<D>) -> Option<Turning<D>> {
        let k = s.bearing.skf?;
        let drag = if s.speed.re() > 0.0 { self.drag(s, &k) } else { D::from(0.0) };
        Some(Turning::new(s, k, self.starvation, 0.12, drag))
    }

    /// N m
    fn drag<D: Real>(&self, s: &BearingDuty<D>, k: &SkfConstants) -> D {
        let (level, jets) = match s.supply {
            Supply::Bath { level } => (level, 1.0),
            Supply::Jet => (s.bearing.element_diameter * 0.5, 2.0),
            Supply::Mist | Supply::Grease => return D::from(0.0),
        };
        let Mm { d, big_d, b, dm } = Mm::of(&s.bearing);
        let fixed = D::constant;
        let h = real::min(level * 1e3, dm * 1.2);
        if h.re() <= 0.0 {
            return D::from(0.0);
        }
        let n = rpm(s);
        let nu_mm2_s = s.kinematic_viscosity * 1e6;
        let ratio = (big_d + d) / (big_d - d);
        let v_m = self.drag_loss_factor.map_or_else(|| interpolate(k.drag, h / dm), Inner::<D>::from);
        let first = if s.bearing.kind.is_ball() {
            v_m * 0.4 * (ratio * (f64::from(s.bearing.rows) * k.k_z) * 1e-12) * dm.powi(5)
        } else {
            let l_d = b * (5.0 * k.k_l) / dm;
            let c_w = l_d.powi(3) * 2.789e-10 - l_d.powi(2) * 2.786e-4 + l_d * 0.0195 + 0.6439;
            v_m * 4.0 * (ratio * (k.k_l * k.k_z) * 1e-12) * real::max(c_w, Inner::<D>::from(0.0)) * b * dm.powi(4)
        };
        let t = real::acos((dm * 0.6 - h) / (dm * 0.6)) * 2.0;
        let f_t = if t.re() <= std::f64::consts::PI { (t * 0.5).sin() } else { Inner::<D>::from(1.0) };
        let r_s = dm * 0.36 * dm * (t - t.sin()) * (ratio * (0.05 * k.k_z));
        let second = (n / nu_mm2_s * fixed(dm * dm * f_t)).powf(-1.379) * fixed(dm.powi(3) * 1.093e-7 * r_s);
        n * n * (second + fixed(first)) * (jets * 1e-3)
    }
}

impl Law for Skf {
    const META: LawInfo<BearingDuty<f64>> = LawInfo {
        id: "skf",
        by: "SKF",
        title: "SKF model of 2013 and 2018",
        source: ("skf2018", "frictional moment; tables 2 and 3 of the note on the model"),
        trust: Trust::Seen,
        tags: &[],
        valid: &[],
    };

    fn eval<D: Real>(&self, s: &BearingDuty<D>) -> D {
        match self.parts(s) {
            Some(parts) => parts.total(),
            None => super::Palmgren::DEFAULT.eval(s),
        }
    }
}

/// The parts of the SKF torque, N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parts<D> {
    /// Rolling, `M_rr`, before the two factors below.
    pub rolling: D,
    /// Factor of inlet shear heating, `φ_ish`.
    pub inlet_heating: D,
    /// Factor of starvation, `φ_rs`.
    pub replenishment: D,
    /// Share of boundary friction in sliding, `φ_bl`.
    pub boundary_share: D,
    /// Sliding, `M_sl`.
    pub sliding: D,
    /// Rubbing seals, `M_seal`.
    pub seals: D,
    /// Drag of the oil, `M_drag`.
    pub drag: D,
}

impl<D: Real> Parts<D> {
    /// `φ_ish φ_rs M_rr + M_sl + M_seal + M_drag`
    pub fn total(&self) -> D {
        self.inlet_heating * self.replenishment * self.rolling + self.sliding + self.seals + self.drag
    }
}

/// Lengths of a bearing in the unit of the source.
pub(super) struct Mm<D> {
    pub d: D,
    pub big_d: D,
    pub b: D,
    pub dm: D,
}

impl<D: Real> Mm<D> {
    pub fn of(bearing: &BearingData<D>) -> Self {
        let (d, big_d, b) = (bearing.bore * 1e3, bearing.outside_diameter * 1e3, bearing.width * 1e3);
        Self { d, big_d, b, dm: (d + big_d) * 0.5 }
    }
}

/// Speed in r/min.
pub(super) fn rpm<D: Real>(s: &BearingDuty<D>) -> D {
    s.speed * (30.0 / std::f64::consts::PI)
}

/// What of the torque no load changes, at one speed and viscosity: dear powers, worked out once where loads vary.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turning<D: Real> {
    constants: SkfConstants,
    /// Speed, r/min.
    n: D,
    /// `(ν n)^0.6`
    rolling: D,
    inlet_heating: D,
    replenishment: D,
    boundary_share: D,
    /// `μ_sl`
    friction: D,
    /// Constants of `G_rr` and `G_sl` with their powers of `d_m`.
    scales: [Inner<D>; 4],
    /// N m
    seals: D,
    /// N m
    drag: D,
}

impl<D: Real> Turning<D> {
    /// With this drag of the oil.
    pub(super) fn new(
        s: &BearingDuty<D>,
        k: SkfConstants,
        starvation: Option<f64>,
        boundary_friction: f64,
        drag: D,
    ) -> Self {
        let Mm { d, big_d, dm, .. } = Mm::of(&s.bearing);
        let kind = s.bearing.kind;
        let n = rpm(s);
        let nu_mm2_s = s.kinematic_viscosity * 1e6;
        let n_nu = n * nu_mm2_s;
        let turns = n.re() > 0.0;

        let full = match (kind, s.base) {
            (Kind::CylindricalRoller | Kind::FullComplementCylindricalRoller | Kind::AxialCylindricalRoller, _) => 0.02,
            (Kind::TaperedRoller, _) => 0.002,
            (_, Base::Mineral) => 0.05,
            (_, Base::Traction) => 0.1,
            _ => 0.04,
        };
        let [mu_bl, mu_ehl] = s.sliding_friction.unwrap_or([boundary_friction, full]);
        let low = s.bearing.element_diameter.re() * 0.5 * (1.0 + 1e-9);
        let k_rs = starvation.unwrap_or(match s.supply {
            Supply::Bath { level } if level.re() > low => 0.0,
            Supply::Bath { .. } | Supply::Jet => 3e-8,
            Supply::Mist | Supply::Grease => 6e-8,
        });
        let one = D::from(1.0);
        let fixed = D::constant;
        let (phi_ish, phi_rs, phi_bl, mu_sl) = if turns {
            let phi_bl = (-n_nu.powf(1.4) * fixed(dm * 2.6e-8)).exp();
            (
                ((n * fixed(dm)).powf(1.28) * nu_mm2_s.powf(0.64) * 1.84e-9 + 1.0).recip(),
                (-n_nu * fixed((d + big_d) * k_rs * (Inner::<D>::from(k.k_z) / ((big_d - d) * 2.0)).sqrt())).exp(),
                phi_bl,
                phi_bl * (mu_bl - mu_ehl) + mu_ehl,
            )
        } else {
            (one, one, one, D::from(mu_bl.max(0.15)))
        };
        let seals = s.bearing.seal.map_or(D::from(0.0), |seal| fixed(seal_torque(&seal, kind, d, big_d) * 1e-3));
        Self {
            constants: k,
            n,
            rolling: pow(n_nu, 0.6),
            inlet_heating: phi_ish,
            replenishment: phi_rs,
            boundary_share: phi_bl,
            friction: mu_sl,
            scales: scales(kind, &k, dm),
            seals,
            drag,
        }
    }

    /// The parts under the load of a duty of this speed and viscosity.
    pub(super) fn parts(&self, s: &BearingDuty<D>) -> Parts<D> {
        let (g_rr, g_sl) = self.geometry(s);
        Parts {
            rolling: g_rr * self.rolling * 1e-3,
            inlet_heating: self.inlet_heating,
            replenishment: self.replenishment,
            boundary_share: self.boundary_share,
            sliding: g_sl * self.friction * 1e-3,
            seals: self.seals,
            drag: self.drag,
        }
    }

    /// `G_rr` and `G_sl`, in the units of the source.
    fn geometry(&self, s: &BearingDuty<D>) -> (D, D) {
        let [_, r2, r3, r4] = self.constants.rolling;
        let [_, s2, s3, s4] = self.constants.sliding;
        let [first, second, third, fourth] = self.scales.map(D::constant);
        let (fr, fa) = (real::abs(s.radial_load), real::abs(s.axial_load));
        let fixed = D::constant;
        let y = s.bearing.axial_factor.unwrap_or(Inner::<D>::from(1.5));
        let cube = 1.0 / 3.0;
        match s.bearing.kind {
            Kind::DeepGrooveBall if fa.re() > 0.0 => {
                let sine = match s.bearing.static_rating {
                    Some(c0) => (fa.over(c0).powf(0.24) * 24.6f64.to_radians()).sin(),
                    None => D::from(15f64.to_radians().sin()),
                };
                // beyond 90° the formula means nothing: the contact cannot be steeper
                let sine = if sine.re() > 0.0 { sine } else { D::from(1.0) };
                (pow(fr + fa / sine * r2, 0.54) * first, pow(fr.powi(5) + fa.powi(4) / sine * fourth, cube) * third)
            }
            Kind::DeepGrooveBall => (pow(fr, 0.54) * first, pow(fr, 5.0 * cube) * second),
            Kind::AngularContactBall
            | Kind::DoubleRowAngularContactBall
            | Kind::FourPointContactBall
            | Kind::SelfAligningBall => {
                let whirl = self.n * self.n * third;
                (
                    pow(fr + whirl * r3 + fa * r2, 0.54) * first,
                    (pow(fr + whirl * s3, 4.0 * cube) + pow(fa, 4.0 * cube) * s2) * second,
                )
            }
            Kind::TaperedRoller => {
                (pow(fr + fa * fixed(y * r2), 0.31) * first, (fr + fa * fixed(y * s2)) * second)
            }
            Kind::SphericalRoller => (
                real::min(pow(fr + fa * r2, 0.54) * first, pow(fr + fa * r4, 0.31) * third),
                real::min(
                    pow(fr.powi(4) + fa.powi(4) * s2, cube) * second,
                    pow(fr.powi(3) + fa.powi(3) * s4, cube) * fourth,
                ),
            ),
            Kind::ToroidalRoller => (
                real::min(pow(fr, 0.54) * first, pow(fr, 0.31) * third),
                real::min(pow(fr, 5.0 * cube) * second, fr * fourth),
            ),
            // It has no constants of this model, and never comes here.
            Kind::Plain => (D::from(0.0), D::from(0.0)),
            Kind::AxialBall => (pow(fa, 0.54) * first, pow(fa, 4.0 * cube) * second),
            Kind::AxialCylindricalRoller => (pow(fa, 0.31) * first, fa * second),
            Kind::CylindricalRoller | Kind::FullComplementCylindricalRoller | Kind::NeedleRoller => {
                (pow(fr, 0.31) * first, fa * second + fr * fourth)
            }
        }
    }
}

/// What stands before the loads in `G_rr` and `G_sl`: two of the first and two of the second kind of each, by type.
fn scales<C: Real>(kind: Kind, k: &SkfConstants, dm: C) -> [C; 4] {
    let [r1, r2, r3, _] = k.rolling;
    let [s1, s2, s3, _] = k.sliding;
    let none = C::from(0.0);
    match kind {
        Kind::DeepGrooveBall => {
            [dm.powf(1.96) * r1, dm.powf(-0.26) * s1, dm.powf(-0.145) * s1, dm.powf(1.5) * s2]
        }
        Kind::AngularContactBall | Kind::DoubleRowAngularContactBall | Kind::FourPointContactBall => {
            [dm.powf(1.97) * r1, dm.powf(0.26) * s1, dm.powi(4), none]
        }
        Kind::SelfAligningBall => [dm.powi(2) * r1, dm.powf(-0.12) * s1, dm.powf(3.5), none],
        Kind::TaperedRoller => [dm.powf(2.38) * r1, dm.powf(0.82) * s1, none, none],
        Kind::SphericalRoller => [dm.powf(1.85) * r1, dm.powf(0.25) * s1, dm.powf(2.3) * r3, dm.powf(0.94) * s3],
        Kind::ToroidalRoller => [dm.powf(1.97) * r1, dm.powf(-0.19) * s1, dm.powf(2.37) * r2, dm.powf(1.05) * s2],
        Kind::Plain => [none; 4],
        Kind::AxialBall => [dm.powf(1.83) * r1, dm.powf(0.05) * s1, none, none],
        Kind::AxialCylindricalRoller => [dm.powf(2.38) * r1, dm.powf(0.62) * s1, none, none],
        Kind::CylindricalRoller | Kind::FullComplementCylindricalRoller | Kind::NeedleRoller => {
            [dm.powf(2.41) * r1, dm.powf(0.9) * s1, none, dm * s2]
        }
    }
}

/// Torque of rubbing seals, N mm.
fn seal_torque<D: Real>(seal: &Seal, kind: Kind, d: D, big_d: D) -> D {
    let share = match seal.kind {
        SealKind::Rs1 => 0.32,
        SealKind::Rsl | SealKind::Rsh | SealKind::Cs => 0.25,
        SealKind::Ls => 0.8,
    };
    let d_s = seal.diameter.map_or(d + (big_d - d) * share, |x| D::from(x * 1e3));
    let deep_groove = kind == Kind::DeepGrooveBall;
    let size = big_d.re();
    let (k_s1, k_s2, beta) = match seal.kind {
        // Angular contact and self-aligning ball bearings have a row of their own.
        SealKind::Rs1 if kind.is_ball() && !deep_groove => (0.014, 10.0, 2.0),
        SealKind::Rsl if size <= 25.0 => (0.0, 0.0, 0.0),
        SealKind::Rsl if size <= 52.0 => (0.0018, 0.0, 2.25),
        SealKind::Rsh if size <= 52.0 => (0.028, 2.0, 2.25),
        SealKind::Ls => (0.032, 50.0, 2.0),
        SealKind::Cs => (0.057, 50.0, 2.0),
        _ if size <= 62.0 => (0.023, 2.0, 2.25),
        _ if size <= 80.0 => (0.018, 20.0, 2.25),
        _ if size <= 100.0 => (0.018, 15.0, 2.25),
        _ => (0.018, 0.0, 2.25),
    };
    (d_s.powf(beta) * k_s1 + k_s2) * 0.5 * f64::from(seal.lips)
}

/// Linear between the points of a table that rises in its first column; its ends hold beyond.
pub(super) fn interpolate<D: Real>(table: &[[f64; 2]], x: D) -> D {
    let above = table.partition_point(|p| p[0] < x.re());
    match (above.checked_sub(1).and_then(|k| table.get(k)), table.get(above)) {
        (Some([x0, y0]), Some([x1, y1])) => (x - *x0) * (y1 - y0) / (x1 - x0) + *y0,
        (Some([_, y]), None) | (None, Some([_, y])) => D::from(*y),
        (None, None) => D::from(0.0),
    }
}
