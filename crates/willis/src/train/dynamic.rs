//! The dynamic layer of a train: inertias, drags, shafts, friction of shift elements, loss tables,
//! and the scenarios in which it moves.

use exmex::Express;

use super::{MemberId, MeshId, ShiftElementId};

/// A moment of inertia.
///
/// Its kinetic energy is `½ J (ω − ω_reference)²`: cylindrical planets and central rotors are
/// measured against the frame, the spin of bevel planets against their carrier.
#[derive(Clone, Debug, PartialEq)]
pub struct Inertia {
    /// The rotor; of planets, all of them together.
    pub member: MemberId,
    /// What its speed is measured against.
    pub reference: MemberId,
    /// J, kg m².
    pub value: f64,
}

/// A line through points; straight between them and level beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve(Vec<[f64; 2]>);

impl Curve {
    /// Through points of rising abscissa; `None` if there are none, if they do not rise, or if one
    /// is not finite.
    pub fn new(points: Vec<[f64; 2]>) -> Option<Self> {
        let rising = points.windows(2).all(|w| w[0][0] < w[1][0]);
        let finite = points.iter().flatten().all(|x| x.is_finite());
        (rising && finite && !points.is_empty()).then_some(Self(points))
    }

    /// The same value everywhere.
    pub fn constant(value: f64) -> Self {
        Self(vec![[0.0, value]])
    }

    /// The points.
    pub fn points(&self) -> &[[f64; 2]] {
        &self.0
    }

    /// Value at an abscissa.
    #[inline]
    pub fn at(&self, x: f64) -> f64 {
        if x.is_nan() {
            return x;
        }
        let p = &self.0;
        if p.len() == 1 || x <= p[0][0] {
            return p[0][1];
        }
        let last = p[p.len() - 1];
        if x >= last[0] {
            return last[1];
        }
        let k = p.partition_point(|q| q[0] <= x);
        let ([x0, y0], [x1, y1]) = (p[k - 1], p[k]);
        y0 + (y1 - y0) * (x - x0) / (x1 - x0)
    }

    /// Slope right of an abscissa.
    pub fn slope(&self, x: f64) -> f64 {
        let p = &self.0;
        let k = p.partition_point(|q| q[0] <= x);
        if k == 0 || k == p.len() { 0.0 } else { (p[k][1] - p[k - 1][1]) / (p[k][0] - p[k - 1][0]) }
    }
}

/// Friction between two members that does not depend on tooth loads: bearings, seals, dampers.
///
/// Against the relative speed `w` of the first member it exerts `c(|w|) + d |w|`; at rest it holds
/// up to `peak · c(0)`.
#[derive(Clone, Debug, PartialEq)]
pub struct DragMount {
    /// What it is called.
    pub name: String,
    /// The two members.
    pub members: [MemberId; 2],
    /// Torque c over the amount of relative speed, rad/s to N m, of all places together.
    pub torque: Curve,
    /// Viscous coefficient d, N m s/rad, of all places together.
    pub viscous: f64,
    /// Torque at which it breaks away, over that at which it slides; at least 1.
    pub peak: f64,
}

/// What a shaft does between its backlash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Contact {
    /// Damping never exceeds the spring and never pulls: the torque begins at zero.
    #[default]
    Soft,
    /// Spring and damper act from the first touch: the torque may jump.
    Hard,
}

/// An elastic shaft between two members: `k` times its twist and `d` times the rate of twist, which
/// is the first member's angle less the second's.
#[derive(Clone, Debug, PartialEq)]
pub struct Shaft {
    /// What it is called.
    pub name: String,
    /// The two members.
    pub members: [MemberId; 2],
    /// k, N m/rad.
    pub stiffness: f64,
    /// d, N m s/rad.
    pub damping: f64,
    /// Whole backlash, rad.
    pub backlash: f64,
    /// What happens at its ends.
    pub contact: Contact,
}

/// What a clutch, brake or one-way clutch can hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Friction {
    /// Torque over the amount of slip when fully engaged, rad/s to N m.
    pub torque: Curve,
    /// Torque at which it breaks away, over that at which it slides; at least 1.
    pub peak: f64,
}

/// A row of a loss table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LossRow {
    /// Amount of the speed of the first gear relative to the carrier, rad/s.
    pub speed: f64,
    /// Efficiency when the first gear drives.
    pub forward: f64,
    /// Efficiency when the second gear drives.
    pub backward: f64,
    /// Bearing torque at the first gear when it drives, N m.
    pub forward_torque: f64,
    /// Bearing torque at the first gear when the second drives, N m.
    pub backward_torque: f64,
}

/// Efficiency and bearing torque of a mesh over its speed: straight between rows, and beyond the
/// last continued from the last two (Modelica's `lossTable`).
#[derive(Clone, Debug, PartialEq)]
pub struct LossTable {
    /// The mesh.
    pub mesh: MeshId,
    /// Rows of rising speed, at least one.
    pub rows: Vec<LossRow>,
}

/// A value over time, SI.
#[derive(Clone, Debug, PartialEq)]
pub enum Signal {
    /// Always the same.
    Constant(f64),
    /// `offset`, and `height` more from `at` on.
    Step {
        /// Before.
        offset: f64,
        /// The jump.
        height: f64,
        /// When, s.
        at: f64,
    },
    /// From `offset` at `at` in a straight line to `offset + height` after `duration`.
    Ramp {
        /// Before.
        offset: f64,
        /// The rise.
        height: f64,
        /// When it begins, s.
        at: f64,
        /// How long it takes, s.
        duration: f64,
    },
    /// `offset + amplitude e^{−decay (t − at)} sin(2π frequency (t − at) + phase)`; the offset alone before `at`.
    Sine {
        /// Mean.
        offset: f64,
        /// Amplitude.
        amplitude: f64,
        /// Hz.
        frequency: f64,
        /// rad
        phase: f64,
        /// When it begins, s.
        at: f64,
        /// 1/s
        decay: f64,
    },
    /// `offset`, and `amplitude` more during the first `width` of every period, from `at` on.
    Pulse {
        /// Between pulses.
        offset: f64,
        /// Height of a pulse.
        amplitude: f64,
        /// s
        period: f64,
        /// Part of the period, 0 to 1.
        width: f64,
        /// When the first one begins, s.
        at: f64,
    },
    /// Through points in time, s; level before the first and after the last. Two points of the same
    /// time are a jump. `hold`: level from each point to the next.
    Table {
        /// Time and value.
        points: Vec<[f64; 2]>,
        /// Steps instead of lines.
        hold: bool,
    },
    /// The product of two signals.
    Product(Box<[Signal; 2]>),
    /// A formula of the time `t` and of speeds `w_member`, rad/s.
    Expression {
        /// The formula.
        formula: Formula,
        /// The members whose speeds stand in it, in its order.
        speeds: Vec<MemberId>,
    },
}

/// A parsed formula of the time `t` and of speeds `w_member`.
///
/// # Example
/// ```
/// use willis::train::Formula;
///
/// let (formula, speeds) = Formula::parse("60 + 200*sin(2*t) - 3*w_out")?;
/// assert_eq!(speeds, ["out"]);
/// assert_eq!(formula.value(0.0, &[4.0]), 48.0);
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Debug)]
pub struct Formula {
    text: String,
    /// It takes 20 kB in place.
    expression: Box<exmex::FlatEx<f64>>,
    /// For each variable of the expression: the time, or the position of a speed.
    variables: Vec<Option<usize>>,
}

/// A formula with the brackets that the usual order of operations means: powers before signs and from the right,
/// `-t^2` is `-(t^2)` and `2^3^2` is `2^(3^2)`. The library takes signs first and powers from the left.
fn usual_order(text: &str) -> String {
    let tokens: Vec<&str> = tokens(text);
    let mut out = String::new();
    let mut at = 0;
    while at < tokens.len() {
        signed(&tokens, &mut at, &mut out);
    }
    out
}

/// Numbers, names (those of any characters in braces) and single characters.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let part = |more: &dyn Fn(char) -> bool| rest.find(|c| !more(c)).unwrap_or(rest.len());
        let length = if first == '{' {
            rest.find('}').map_or(rest.len(), |end| end + 1)
        } else if first.is_ascii_digit() || first == '.' {
            let mantissa = part(&|c| c.is_ascii_digit() || c == '.');
            // An exponent belongs to the number.
            let exponent = rest[mantissa..].strip_prefix(['e', 'E']).map(|e| e.strip_prefix(['+', '-']).unwrap_or(e));
            match exponent.filter(|e| e.starts_with(|c: char| c.is_ascii_digit())) {
                Some(e) => rest.len() - e.trim_start_matches(|c: char| c.is_ascii_digit()).len(),
                None => mantissa,
            }
        } else if first.is_alphanumeric() || first == '_' {
            part(&|c| c.is_alphanumeric() || c == '_')
        } else {
            first.len_utf8()
        };
        let (token, left) = rest.split_at(length);
        if !token.trim().is_empty() {
            tokens.push(token);
        }
        rest = left;
    }
    tokens
}

/// A sign with the power that follows it, a power, or a single operator.
fn signed(tokens: &[&str], at: &mut usize, out: &mut String) {
    let after_value = |out: &str| out.ends_with(|c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | ')' | '}'));
    match tokens[*at] {
        "-" | "+" if !after_value(out) && *at + 1 < tokens.len() => {
            let minus = tokens[*at] == "-";
            *at += 1;
            out.push_str(if minus { "(0-" } else { "(" });
            let mut operand = String::new();
            signed(tokens, at, &mut operand);
            out.push_str(&operand);
            out.push(')');
        }
        _ => power(tokens, at, out),
    }
}

fn power(tokens: &[&str], at: &mut usize, out: &mut String) {
    let mut base = String::new();
    primary(tokens, at, &mut base);
    if tokens.get(*at) == Some(&"^") && *at + 1 < tokens.len() {
        *at += 1;
        let mut exponent = String::new();
        signed(tokens, at, &mut exponent);
        out.push_str(&format!("(({base})^({exponent}))"));
    } else {
        out.push_str(&base);
    }
}

/// A number, a name with its arguments, something in brackets; or whatever else stands there.
fn primary(tokens: &[&str], at: &mut usize, out: &mut String) {
    let name = tokens[*at];
    // The library knows no exponents of ten.
    match name.parse::<f64>() {
        Ok(number) if name.contains(['e', 'E']) && number.is_finite() => out.push_str(&number.to_string()),
        _ => out.push_str(name),
    }
    *at += 1;
    let is_call = name.starts_with(|c: char| c.is_alphabetic()) && tokens.get(*at) == Some(&"(");
    if is_call {
        out.push('(');
        *at += 1;
    }
    if is_call || name == "(" {
        while *at < tokens.len() && tokens[*at] != ")" {
            signed(tokens, at, out);
        }
        if *at < tokens.len() {
            out.push(')');
            *at += 1;
        }
    } else if is_call_without_brackets(name, tokens.get(*at)) {
        out.push(' ');
        primary(tokens, at, out);
    }
}

/// `sin t`: a name before a name or a number.
fn is_call_without_brackets(name: &str, next: Option<&&str>) -> bool {
    let word = |s: &str| s.starts_with(|c: char| c.is_alphanumeric() || c == '_' || c == '.');
    word(name) && next.is_some_and(|n| word(n) || n.starts_with('{'))
}

impl PartialEq for Formula {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Formula {
    /// Parses a formula; returns it and the names of the members whose speeds it uses.
    ///
    /// # Errors
    /// What is wrong with the text, in words.
    pub fn parse(text: &str) -> Result<(Self, Vec<String>), String> {
        let expression = exmex::parse::<f64>(&usual_order(text)).map_err(|e| e.to_string())?;
        let mut speeds = Vec::new();
        let mut variables = Vec::new();
        for name in expression.var_names() {
            match (name.as_str(), name.strip_prefix("w_")) {
                ("t", _) => variables.push(None),
                (_, Some(member)) => {
                    variables.push(Some(speeds.len()));
                    speeds.push(member.to_owned());
                }
                _ => return Err(format!("`{name}` is neither the time t nor a speed such as w_sun")),
            }
        }
        Ok((Self { text: text.to_owned(), expression: Box::new(expression), variables }, speeds))
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the time stands in it.
    pub fn depends_on_time(&self) -> bool {
        self.variables.contains(&None)
    }

    /// Value at a time, s, and speeds, rad/s. NaN outside its domain.
    pub fn value(&self, time: f64, speeds: &[f64]) -> f64 {
        const FEW: usize = 16;
        let value = |v: &Option<usize>| v.map_or(time, |k| speeds[k]);
        let mut few = [0.0; FEW];
        let n = self.variables.len();
        if n > FEW {
            let all: Vec<f64> = self.variables.iter().map(value).collect();
            return self.expression.eval(&all).unwrap_or(f64::NAN);
        }
        few.iter_mut().zip(&self.variables).for_each(|(x, v)| *x = value(v));
        self.expression.eval(&few[..n]).unwrap_or(f64::NAN)
    }
}

/// What acts on members from outside in a scenario; `S` is what a value over time is told by, `C` a
/// curve.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceKind<S = Signal, C = Curve> {
    /// An external torque, N m, over time.
    Torque(S),
    /// A prescribed speed, rad/s, over time; its torque is a result.
    Speed(S),
    /// A speed controller, `T = T_ff + k_p e + k_i ∫e dt + k_d de/dt` with `e = w_set − w` (Galvagno 2010,
    /// section 6.2).
    Controller {
        /// The speed wanted, rad/s.
        setpoint: S,
        /// T_ff, N m.
        feed_forward: S,
        /// k_p, N m s/rad.
        proportional: f64,
        /// k_i, N m/rad.
        integral: f64,
        /// k_d, N m s²/rad; acts as an added inertia.
        derivative: f64,
    },
    /// `T = T_0 − d (w − w_0)`.
    Linear {
        /// T_0, N m.
        torque: f64,
        /// w_0, rad/s.
        about: f64,
        /// d, N m s/rad.
        slope: f64,
    },
    /// `T = T_0 − k (w − w_0)² sgn(w − w_0)`; or without the sign if `even`.
    Quadratic {
        /// T_0, N m.
        torque: f64,
        /// w_0, rad/s.
        about: f64,
        /// k, N m s²/rad².
        factor: f64,
        /// Leave the sign out: the torque does not follow the direction of rotation.
        even: bool,
    },
    /// A vehicle on its wheels: `v = r w/i`; mass, rolling resistance, air and slope.
    Vehicle {
        /// kg
        mass: f64,
        /// Wheel radius, m.
        wheel_radius: f64,
        /// Turns of the member to one turn of the wheel.
        final_drive: f64,
        /// Rolling resistance coefficient; holds the vehicle at rest.
        rolling: f64,
        /// Drag coefficient times frontal area, m².
        drag_area: f64,
        /// kg/m³
        air_density: f64,
        /// Rise over run.
        grade: S,
    },
    /// A motor: between the torque it drags with and its full-load torque, by a throttle from 0 to 1.
    Motor {
        /// Full-load torque over speed, rad/s to N m.
        full_load: C,
        /// Torque at closed throttle over speed (negative for drag), rad/s to N m.
        closed: C,
        /// 0 to 1.
        throttle: S,
    },
}

/// Something that acts on a member from outside; its torque is counted as power into the train.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// What it is called.
    pub name: String,
    /// The member.
    pub member: MemberId,
    /// What acts.
    pub kind: SourceKind,
    pub(crate) place: String,
}

/// How far a shift element is engaged over time, 0 to 1 (negative counts as 0).
#[derive(Clone, Debug, PartialEq)]
pub struct Engagement {
    /// The element.
    pub element: ShiftElementId,
    /// 0 to 1.
    pub signal: Signal,
    pub(crate) place: String,
}

/// A motion to simulate.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Its name.
    pub name: String,
    /// When it begins, s.
    pub start: f64,
    /// When it ends, s.
    pub end: f64,
    /// Speeds at the start, rad/s; those that the gears settle follow, what is left is at rest.
    pub initial_speeds: Vec<(MemberId, f64)>,
    /// Twist of shafts at the start, by position in [`Train::shafts`](super::Train::shafts), rad;
    /// zero unless given.
    pub initial_twists: Vec<(usize, f64)>,
    /// Members held at rest from outside.
    pub fixed: Vec<MemberId>,
    /// What acts from outside.
    pub sources: Vec<Source>,
    /// When shift elements are engaged; those that are not named here are open, one-way clutches
    /// are always in action.
    pub engagements: Vec<Engagement>,
    /// How many rows of output, evenly spaced in time.
    pub samples: usize,
    pub(crate) place: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_read_in_the_usual_order() {
        let value = |text: &str| match Formula::parse(text) {
            Ok((formula, _)) => formula.value(3.0, &[2.0]),
            Err(e) => panic!("{text}: {}: {e}", usual_order(text)),
        };
        let cases = [
            ("-t^2", -9.0),
            ("2^3^2", 512.0),
            ("2^-1", 0.5),
            ("1/-t^2", -1.0 / 9.0),
            ("4 - -t^2*2", 22.0),
            ("-(t+1)^2 + +2", -14.0),
            ("exp(-((t-1)/2)^2)", (-1.0f64).exp()),
            ("1e-3*t - 2.5E+1", 0.003 - 25.0),
            ("-w_a^2*t", -12.0),
            ("-sin(t)^2", -(3.0f64.sin().powi(2))),
            ("60 + 200*sin(2*t) - 3*w_a", 60.0 + 200.0 * 6.0f64.sin() - 6.0),
            ("-2^2", -4.0),
            ("-{w_a}^2", -4.0),
            ("-sin t", -(3.0f64.sin())),
            ("2*-3", -6.0),
        ];
        for (text, expected) in cases {
            let is = value(text);
            assert!((is - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{text}: {is}, not {expected}");
        }
    }

    #[test]
    fn damaged_formulas_are_refused() {
        for text in ["", "-", "2^", "(t", "t)", "sin(", "^2", "1 +", "* 3", "t t", "é", "w_"] {
            assert!(
                Formula::parse(text).is_err() || Formula::parse(text).unwrap().0.value(1.0, &[1.0; 8]).is_finite(),
                "{text}"
            );
        }
    }
}
