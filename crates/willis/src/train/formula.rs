//! Formulas of the time and of speeds, as the train file writes them.

use std::cmp::Ordering;
use std::num::ParseFloatError;
use std::str::FromStr;

use exmex::{BinOp, Express, Operator};
use num_dual::{Dual64, DualNum};

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
    /// The same, that takes derivatives along.
    rising: Box<exmex::FlatEx<Rising, RisingOperators>>,
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
        let ordered = usual_order(text);
        let expression = exmex::parse::<f64>(&ordered).map_err(|e| e.to_string())?;
        let rising = exmex::FlatEx::parse(&ordered).map_err(|e| e.to_string())?;
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
        let (expression, rising) = (Box::new(expression), Box::new(rising));
        Ok((Self { text: text.to_owned(), expression, rising, variables }, speeds))
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
        self.evaluate(&self.expression, |v| v.map_or(time, |k| speeds[k])).unwrap_or(f64::NAN)
    }

    /// Derivative with respect to the time, 1/s, speeds held. NaN outside its domain. At a kink (`abs`, `min`, `max`)
    /// it is that of one side; where the formula [jumps](Self::jumps), it does not tell of the jump.
    pub fn rate(&self, time: f64, speeds: &[f64]) -> f64 {
        let rising = self.evaluate(&self.rising, |v| match v {
            None => Rising(Dual64::from(time).derivative()),
            Some(k) => Rising(Dual64::from(speeds[*k])),
        });
        rising.map_or(f64::NAN, |r| r.0.eps)
    }

    /// Whether it has a function whose value jumps: `signum`, `floor`, `ceil`, `round`, `trunc`, `fract`.
    pub fn jumps(&self) -> bool {
        tokens(&self.text).iter().any(|t| ["signum", "floor", "ceil", "round", "trunc", "fract"].contains(t))
    }

    fn evaluate<T: exmex::DataType + Copy, O: exmex::MakeOperators<T>>(
        &self,
        expression: &exmex::FlatEx<T, O>,
        value: impl Fn(&Option<usize>) -> T,
    ) -> Option<T>
    where
        T::Err: std::fmt::Debug,
    {
        const FEW: usize = 16;
        let n = self.variables.len();
        if n > FEW {
            let all: Vec<T> = self.variables.iter().map(value).collect();
            return expression.eval(&all).ok();
        }
        let mut few = [T::default(); FEW];
        few.iter_mut().zip(&self.variables).for_each(|(x, v)| *x = value(v));
        expression.eval(&few[..n]).ok()
    }
}

/// A value and its derivative, as the type of numbers of a formula.
#[derive(Clone, Copy, Debug)]
struct Rising(Dual64);

impl Default for Rising {
    fn default() -> Self {
        Self(Dual64::from(0.0))
    }
}

impl FromStr for Rising {
    type Err = ParseFloatError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        text.parse().map(|value: f64| Self(Dual64::from(value)))
    }
}

/// Of two, by the order of their values.
fn lesser(a: Rising, b: Rising, order: Ordering) -> Rising {
    let first = a.0.re.is_nan() || a.0.re.partial_cmp(&b.0.re) == Some(order) || a.0.re == b.0.re;
    if first { a } else { b }
}

/// `a^b`, also of negative numbers to whole powers.
fn raise(Rising(a): Rising, Rising(b): Rising) -> Rising {
    if b.eps == 0.0 { Rising(a.powf(b.re)) } else { Rising(a.powd(b)) }
}

/// The operators of the library for [`f64`], over derivatives.
#[derive(Clone, Debug)]
struct RisingOperators;

impl exmex::MakeOperators<Rising> for RisingOperators {
    fn make<'a>() -> Vec<Operator<'a, Rising>> {
        let binary = |apply, prio, is_commutative| BinOp { apply, prio, is_commutative };
        let unary = Operator::make_unary;
        let constant = |name, value: f64| Operator::make_constant(name, Rising(Dual64::from(value)));
        /// The same at every place between its jumps.
        fn level(r: Rising, value: fn(f64) -> f64) -> Rising {
            Rising(Dual64::from(value(r.0.re)))
        }
        vec![
            Operator::make_bin("^", binary(raise, 4, false)),
            Operator::make_bin("*", binary(|a, b| Rising(a.0 * b.0), 2, true)),
            Operator::make_bin("/", binary(|a, b| Rising(a.0 / b.0), 3, false)),
            Operator::make_bin_unary("+", binary(|a, b| Rising(a.0 + b.0), 0, true), |a| a),
            Operator::make_bin_unary("-", binary(|a, b| Rising(a.0 - b.0), 1, false), |a| Rising(-a.0)),
            Operator::make_bin("atan2", binary(|y, x| Rising(y.0.atan2(x.0)), 0, false)),
            Operator::make_bin("min", binary(|a, b| lesser(a, b, Ordering::Less), 0, true)),
            Operator::make_bin("max", binary(|a, b| lesser(a, b, Ordering::Greater), 0, true)),
            unary("abs", |a| if a.0.re < 0.0 { Rising(-a.0) } else { a }),
            unary("signum", |a| level(a, f64::signum)),
            unary("floor", |a| level(a, f64::floor)),
            unary("round", |a| level(a, f64::round)),
            unary("ceil", |a| level(a, f64::ceil)),
            unary("trunc", |a| level(a, f64::trunc)),
            unary("fract", |a| Rising(a.0 - a.0.re.trunc())),
            unary("sin", |a| Rising(a.0.sin())),
            unary("cos", |a| Rising(a.0.cos())),
            unary("tan", |a| Rising(a.0.tan())),
            unary("asin", |a| Rising(a.0.asin())),
            unary("acos", |a| Rising(a.0.acos())),
            unary("atan", |a| Rising(a.0.atan())),
            unary("sinh", |a| Rising(a.0.sinh())),
            unary("cosh", |a| Rising(a.0.cosh())),
            unary("tanh", |a| Rising(a.0.tanh())),
            unary("asinh", |a| Rising(a.0.asinh())),
            unary("acosh", |a| Rising(a.0.acosh())),
            unary("atanh", |a| Rising(a.0.atanh())),
            unary("exp", |a| Rising(a.0.exp())),
            unary("sqrt", |a| Rising(a.0.sqrt())),
            unary("cbrt", |a| Rising(a.0.cbrt())),
            unary("ln", |a| Rising(a.0.ln())),
            unary("log", |a| Rising(a.0.ln())),
            unary("log2", |a| Rising(a.0.log2())),
            unary("log10", |a| Rising(a.0.log10())),
            constant("PI", std::f64::consts::PI),
            constant("π", std::f64::consts::PI),
            constant("E", std::f64::consts::E),
            constant("e", std::f64::consts::E),
            constant("TAU", std::f64::consts::TAU),
            constant("τ", std::f64::consts::TAU),
        ]
    }
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
            let rate = formula.rate(t, &[3.0]);
            assert!((rate - difference).abs() <= 1e-5 * (1.0 + difference.abs()), "{text}: {rate}, not {difference}");
        }
        for text in ["floor(t)", "2*signum(t - 1)", "round(t)"] {
            assert!(Formula::parse(text).unwrap().0.jumps(), "{text}");
        }
    }

    /// The two readings of a text have the same operators.
    #[test]
    fn the_value_that_takes_its_rate_along_is_the_value() {
        let names = <exmex::FloatOpsFactory<f64> as exmex::MakeOperators<f64>>::make();
        let mine = <RisingOperators as exmex::MakeOperators<Rising>>::make();
        let all = |texts: Vec<&str>| {
            let mut t = texts;
            t.sort_unstable();
            t.join(" ")
        };
        assert_eq!(all(names.iter().map(|o| o.repr()).collect()), all(mine.iter().map(|o| o.repr()).collect()));
    }
}
