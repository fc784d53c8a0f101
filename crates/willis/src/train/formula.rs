//! Formulas of the time and of speeds, as the train file writes them.

use std::cmp::Ordering;

use num_dual::{Dual64, DualNum};

mod expression;
mod jumps;

use expression::{Binary, Expression, Number, Unary};
use jumps::Span;

/// The functions whose value jumps.
const JUMPING: [&str; 6] = ["signum", "floor", "ceil", "round", "trunc", "fract"];

/// The functions that repeat themselves.
const WAVES: [&str; 3] = ["sin", "cos", "tan"];

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
    expression: Expression,
    jumps: bool,
    waves: bool,
    /// For each variable of the expression: the time, or the position of a speed.
    variables: Vec<Option<usize>>,
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
        let tokens = tokens(text);
        let (expression, names) = Expression::parse(&tokens)?;
        let mut speeds = Vec::new();
        let mut variables = Vec::new();
        for name in names {
            match (name.as_str(), name.strip_prefix("w_")) {
                ("t", _) => variables.push(None),
                (_, Some(member)) => {
                    variables.push(Some(speeds.len()));
                    speeds.push(member.to_owned());
                }
                _ => return Err(format!("`{name}` is neither the time t nor a speed such as w_sun")),
            }
        }
        let has = |functions: &[&str]| tokens.iter().any(|t| functions.contains(t));
        let (jumps, waves) = (has(&JUMPING), has(&WAVES));
        Ok((Self { text: text.to_owned(), expression, jumps, waves, variables }, speeds))
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
        self.expression.value(|k| self.variables[k].map_or(time, |k| speeds[k]))
    }

    /// Value at a time as if the formula went on as it is at the time `inside`: a function that jumps stays at the
    /// value that it has there.
    pub fn value_within(&self, time: f64, inside: f64, speeds: &[f64]) -> f64 {
        if self.jumps() { self.rising(time, inside, speeds).0.re } else { self.value(time, speeds) }
    }

    /// Derivative with respect to the time, 1/s, speeds held, as if the formula went on as it is at the time `inside`.
    /// NaN outside its domain. At a kink (`abs`, `min`, `max`) it is that of one side; where the formula
    /// [jumps](Self::jumps), it does not tell of the jump.
    pub fn rate(&self, time: f64, inside: f64, speeds: &[f64]) -> f64 {
        self.rising(time, inside, speeds).0.eps
    }

    /// Whether it has a function whose value jumps: `signum`, `floor`, `ceil`, `round`, `trunc`, `fract`.
    pub fn jumps(&self) -> bool {
        self.jumps
    }

    /// Whether it has a function of the time that repeats itself: `sin`, `cos`, `tan`.
    pub(crate) fn waves(&self) -> bool {
        self.waves && self.depends_on_time()
    }

    /// Through how many periods of a function that repeats itself it goes, at most, from a time to a later one while the
    /// speeds stay.
    pub(crate) fn turns(&self, from: f64, to: f64, speeds: &[f64]) -> f64 {
        if !self.waves() {
            return 0.0;
        }
        let values = |k: usize| self.variables[k].map_or(Span::new(from, to), |k| Span::new(speeds[k], speeds[k]));
        self.expression.value(values).turns
    }

    /// A time after `t`, s, before which it does not jump: that of its next jump, or an earlier one where the bounds
    /// of its values do not tell.
    pub fn next_jump(&self, t: f64) -> f64 {
        if !self.jumps || !self.depends_on_time() {
            return f64::INFINITY;
        }
        jumps::next(t, |from, to| {
            let values = |k: usize| self.variables[k].map_or(Span::new(from, to), |_| Span::ALL);
            self.expression.value(values).jumps
        })
    }

    /// A function that jumps and the speed in its argument, as it is written: when it jumps is not known beforehand.
    ///
    /// # Example
    /// ```
    /// use willis::train::Formula;
    ///
    /// let (formula, _) = Formula::parse("5*floor(t) + 2*signum(w_out - 3)")?;
    /// assert_eq!(formula.jumps_with_speed().as_deref(), Some("signum(w_out-3)"));
    /// # Ok::<(), String>(())
    /// ```
    pub fn jumps_with_speed(&self) -> Option<String> {
        let tokens = tokens(&self.text);
        let of_speed = |t: &&str| t.trim_start_matches('{').starts_with("w_");
        (0..tokens.len()).filter(|k| JUMPING.contains(&tokens[*k])).find_map(|k| {
            let mut depth = 0i32;
            let is_function = |n: usize| {
                tokens[n].starts_with(char::is_alphabetic)
                    && !of_speed(&tokens[n])
                    && tokens
                        .get(n + 1)
                        .is_some_and(|next| is_call_without_brackets(tokens[n], Some(next)) || *next == "(")
            };
            let last = (k + 1..tokens.len()).find(|&n| {
                depth += i32::from(tokens[n] == "(") - i32::from(tokens[n] == ")");
                depth <= 0 && !is_function(n)
            });
            let call = &tokens[k..=last.unwrap_or(tokens.len() - 1)];
            call.iter().any(of_speed).then(|| call.concat())
        })
    }

    fn rising(&self, time: f64, inside: f64, speeds: &[f64]) -> Rising {
        self.expression.value(|k| match self.variables[k] {
            None => Rising(Dual64::from(time).derivative(), inside),
            Some(k) => Rising::from(speeds[k]),
        })
    }
}

/// A value and its derivative, and the value at the time inside a piece that says which one it is, as the type of
/// numbers of a formula.
#[derive(Clone, Copy, Debug)]
struct Rising(Dual64, f64);

impl Rising {
    fn map(self, rising: fn(Dual64) -> Dual64, inside: fn(f64) -> f64) -> Self {
        Self(rising(self.0), inside(self.1))
    }

    /// The same at every place of a piece.
    fn level(self, value: fn(f64) -> f64) -> Self {
        Self::from(value(self.1))
    }
}

impl From<f64> for Rising {
    fn from(value: f64) -> Self {
        Self(Dual64::from(value), value)
    }
}

/// Of two, by the order of their values.
fn lesser(a: Rising, b: Rising, order: Ordering) -> Rising {
    let first = a.0.re.is_nan() || a.0.re.partial_cmp(&b.0.re) == Some(order) || a.0.re == b.0.re;
    let inside = if order.is_lt() { a.1.min(b.1) } else { a.1.max(b.1) };
    Rising(if first { a.0 } else { b.0 }, inside)
}

/// `a^b`, also of negative numbers to whole powers.
fn raise(Rising(a, within): Rising, Rising(b, power): Rising) -> Rising {
    Rising(if b.eps == 0.0 { a.powf(b.re) } else { a.powd(b) }, within.powf(power))
}

impl Number for Rising {
    fn constant(value: f64) -> Self {
        Self::from(value)
    }

    fn binary(self, operation: Binary, other: Self) -> Self {
        let (a, b) = (self, other);
        match operation {
            Binary::Add => Self(a.0 + b.0, a.1 + b.1),
            Binary::Subtract => Self(a.0 - b.0, a.1 - b.1),
            Binary::Multiply => Self(a.0 * b.0, a.1 * b.1),
            Binary::Divide => Self(a.0 / b.0, a.1 / b.1),
            Binary::Power => raise(a, b),
            Binary::Atan2 => Self(a.0.atan2(b.0), a.1.atan2(b.1)),
            Binary::Min => lesser(a, b, Ordering::Less),
            Binary::Max => lesser(a, b, Ordering::Greater),
        }
    }

    fn unary(self, function: Unary) -> Self {
        let a = self;
        match function {
            Unary::Negative => Self(-a.0, -a.1),
            Unary::Abs => a.map(|x| if x.re < 0.0 { -x } else { x }, f64::abs),
            Unary::Signum => a.level(f64::signum),
            Unary::Floor => a.level(f64::floor),
            Unary::Round => a.level(f64::round),
            Unary::Ceil => a.level(f64::ceil),
            Unary::Trunc => a.level(f64::trunc),
            Unary::Fract => Self(a.0 - a.1.trunc(), a.1.fract()),
            Unary::Sin => a.map(|x| x.sin(), f64::sin),
            Unary::Cos => a.map(|x| x.cos(), f64::cos),
            Unary::Tan => a.map(|x| x.tan(), f64::tan),
            Unary::Asin => a.map(|x| x.asin(), f64::asin),
            Unary::Acos => a.map(|x| x.acos(), f64::acos),
            Unary::Atan => a.map(|x| x.atan(), f64::atan),
            Unary::Sinh => a.map(|x| x.sinh(), f64::sinh),
            Unary::Cosh => a.map(|x| x.cosh(), f64::cosh),
            Unary::Tanh => a.map(|x| x.tanh(), f64::tanh),
            Unary::Asinh => a.map(|x| x.asinh(), f64::asinh),
            Unary::Acosh => a.map(|x| x.acosh(), f64::acosh),
            Unary::Atanh => a.map(|x| x.atanh(), f64::atanh),
            Unary::Exp => a.map(|x| x.exp(), f64::exp),
            Unary::Sqrt => a.map(|x| x.sqrt(), f64::sqrt),
            Unary::Cbrt => a.map(|x| x.cbrt(), f64::cbrt),
            Unary::Ln => a.map(|x| x.ln(), f64::ln),
            Unary::Log2 => a.map(|x| x.log2(), f64::log2),
            Unary::Log10 => a.map(|x| x.log10(), f64::log10),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_are_read_in_the_usual_order() {
        let value = |text: &str| match Formula::parse(text) {
            Ok((formula, _)) => formula.value(3.0, &[2.0, 7.0]),
            Err(e) => panic!("{text}: {e}"),
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
            ("7 - 2 - 1 + 4", 8.0),
            ("12/2*3/9", 2.0),
            ("sin t^2", 3.0f64.sin().powi(2)),
            ("sin -t", -(3.0f64.sin())),
            ("min(t, max(w_a, 2.5)) + atan2(0, 1)", 2.5),
            ("(t - 0.5) max 0 min 1", 1.0),
            ("t max 1 + w_a", 5.0),
            ("t max 7 - w_a", 5.0),
            ("-((120*((t - 0.5) max 0 min 1)) min (45000/(abs(w_a) max 100)))", -120.0),
            ("w_b*0 + TAU - 2*π + e - E + w_a", 2.0),
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

    /// Every function, against central differences.
    #[test]
    fn rates_are_derivatives() {
        let functions =
            "sin cos tan asin acos atan sinh cosh tanh asinh atanh exp sqrt cbrt ln log log2 log10 abs fract";
        let mut texts: Vec<String> = functions.split(' ').map(|f| format!("w_a*{f}(t/4) - t^2")).collect();
        texts.extend(
            ["acosh(1 + t)", "t^1.5/2^t", "atan2(t, 2)", "min(t, 2*t) + max(t, 2*t)", "(-t)^3", "t^w_a"]
                .map(String::from),
        );
        texts.push("t*".repeat(900) + "t");
        texts.push("(t+".repeat(200) + "t" + &")".repeat(200));
        for text in &texts {
            let (formula, _) = Formula::parse(text).unwrap_or_else(|e| panic!("{text}: {e}"));
            let (t, h) = (1.01, 1e-6);
            let difference = (formula.value(t + h, &[3.0]) - formula.value(t - h, &[3.0])) / (2.0 * h);
            let rate = formula.rate(t, t, &[3.0]);
            assert!((rate - difference).abs() <= 1e-5 * (1.0 + difference.abs()), "{text}: {rate}, not {difference}");
        }
        for text in ["floor(t)", "2*signum(t - 1)", "round(t)"] {
            assert!(Formula::parse(text).unwrap().0.jumps(), "{text}");
        }
    }

    /// The jumps of formulas whose jumps are known.
    #[test]
    fn val_the_next_jump_is_where_the_argument_says() {
        let cases: [(&str, f64, f64); 16] = [
            ("floor(2*t)", 0.0, 0.5),
            ("floor(2*t)", 0.5, 1.0),
            ("20000*t - floor(20000*t)", 0.0, 5e-5),
            ("floor(2*fract(1e4*t))", 1e-4, 1.5e-4),
            ("floor(2*fract(1e4*t))", 1.5e-4, 2e-4),
            ("ceil(4*t)", 0.0, 0.25),
            ("round(t - 0.25)", 0.0, 0.75),
            ("trunc(t - 1)", 0.5, 2.0),
            ("signum(sin(2*PI*t))", 0.0, 0.5),
            ("signum(cos(2*PI*t))", 0.25, 0.75),
            ("floor(0.9*sin(t))", 0.0, std::f64::consts::PI),
            ("signum(t^2 - 2)", 0.0, std::f64::consts::SQRT_2),
            ("floor(exp(-t) + 0.5)", 0.0, std::f64::consts::LN_2),
            ("floor(sqrt(t - 1))", 0.0, 2.0),
            // What jumps at the time itself has jumped.
            ("floor(3/(t + 1))", 0.0, 0.5),
            ("floor(floor(3*t)/2)", 1.0 / 3.0, 2.0 / 3.0),
        ];
        for (text, t, expected) in cases {
            let formula = Formula::parse(text).unwrap().0;
            let next = formula.next_jump(t);
            assert!((next - expected).abs() <= 1e-13, "{text} after {t}: {next}, not {expected}");
        }
        for text in ["t^2 + sin(t)", "floor(0.5)*t", "signum(2 + sin(t))*w_a"] {
            let formula = Formula::parse(text).unwrap().0;
            let mut t = 0.0;
            for _ in 0..1000 {
                let next = formula.next_jump(t);
                if next.is_infinite() {
                    break;
                }
                assert!(next > t + 1e-3, "{text} at {t}: {next}");
                t = next;
            }
        }
    }

    /// No jump of any function lies between two breaks: the value goes on there as it is in their middle.
    #[test]
    fn no_jump_is_missed() {
        let arguments = [
            "3*t - 1",
            "2*sin(7*t)",
            "5*cos(t^2)",
            "tan(t)",
            "2*asin(sin(t))",
            "acos(cos(3*t))",
            "atan(9*t - 4)",
            "sinh(t - 1)",
            "3*cosh(t - 1)",
            "4*tanh(t - 1)",
            "asinh(5*t)",
            "acosh(1 + 3*t)",
            "atanh(t/2 - 0.5)",
            "exp(t)",
            "5*sqrt(t)",
            "3*cbrt(t - 1)",
            "ln(t)",
            "log2(t)",
            "log10(t)",
            "6*abs(t - 1)",
            "1/(t - 1.1)",
            "(t - 1)^3*4",
            "(t - 1)^-1",
            "3*2^t",
            "(t - 1)^2*5",
            "3*t^1.5",
            "atan2(t - 1, t - 1.5)",
            "min(3*t, 4 - t)",
            "max(3*t, 4 - t)",
            "floor(9*t)/2",
            "-5*t*sin(9*t)",
        ];
        for argument in arguments {
            for function in JUMPING {
                let text = format!("{function}({argument})");
                let formula = Formula::parse(&text).unwrap_or_else(|e| panic!("{text}: {e}")).0;
                let mut t = 0.0123;
                let mut breaks = 0;
                while t < 2.0 {
                    let next = formula.next_jump(t).min(2.0);
                    let middle = 0.5 * (t + next);
                    for k in 1..20 {
                        let at = t + (next - t) * f64::from(k) / 20.0;
                        let (is, goes_on) = (formula.value(at, &[]), formula.value_within(at, middle, &[]));
                        let same = is == goes_on || (is - goes_on).abs() < 1e-9 || is.is_nan() && goes_on.is_nan();
                        // At a pole the value is as large as it likes.
                        assert!(same || next - t < 1e-9, "{text} at {at} in [{t}, {next}]: {is}, {goes_on}");
                    }
                    t = next;
                    breaks += 1;
                    assert!(breaks < 5000, "{text} at {t}");
                    if breaks == 300 {
                        break;
                    }
                }
            }
        }
    }

    #[test]
    fn a_jump_at_a_speed_is_told() {
        let cases = [
            ("floor(t)*w_a", None),
            ("signum(w_a)", Some("signum(w_a)")),
            ("floor(t) + round(2*(t - {w_P1.planet}))", Some("round(2*(t-{w_P1.planet}))")),
            ("w_a*floor(t) + w_b", None),
            ("floor sin(w_a)", Some("floorsin(w_a)")),
            ("signum w_a + t", Some("signumw_a")),
        ];
        for (text, expected) in cases {
            assert_eq!(Formula::parse(text).unwrap().0.jumps_with_speed().as_deref(), expected, "{text}");
        }
    }

    /// What is wrong is said, and what lies too deep is not read.
    #[test]
    fn what_is_wrong_with_a_formula_is_said() {
        let deep = ["(", "-", "2^", "sin "].map(|part| part.repeat(100_000) + "t");
        let cases = [
            ("2*", "it ends where a value should be"),
            ("(t + 1", "a `)` is missing at the end"),
            ("t)", "there is a `)` without a `(`"),
            ("t t", "an operator is missing before `t`"),
            ("sin", "`sin` has no argument"),
            ("max(t)", "there is `)` where `,` should be"),
            ("2 + * t", "there is `*` where a value should be"),
            ("1.2.3*t", "`1.2.3` is no number"),
            ("{w_a", "the `}` of `{w_a` is missing"),
            ("x", "`x` is neither the time t nor a speed such as w_sun"),
        ];
        for (text, why) in cases {
            assert_eq!(Formula::parse(text).unwrap_err(), why, "{text}");
        }
        for text in deep {
            assert!(Formula::parse(&text).unwrap_err().contains("256 deep"), "{}", &text[..4]);
        }
    }
}
