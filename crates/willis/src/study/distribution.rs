//! How an uncertain number is distributed.

use serde::{Deserialize, Serialize};

use crate::diagnostic::{Code, Diagnostic};
use crate::train::Measure;
use crate::units::{self, Dimension};

/// A distribution of a number, in the unit in which it was written.
///
/// # Grammar
/// | text | values |
/// |---|---|
/// | `60..80 degC`, `uniform(60, 80 degC)` | everything between is equally likely |
/// | `normal(0.4 um, 0.05 um)` | normal with this mean and standard deviation, cut off at three of them |
/// | `triangular(0.2, 0.4, 0.8 um)` | least, most likely, greatest |
/// | `lognormal(0.4 um, 1.3)` | median and factor: the logarithm is normal, two thirds lie between median/1.3 and median·1.3; cut off at 1.3³ |
/// | `+-5%`, `±0.02 mm` | uniform about the value of the file |
/// | `normal(+-5%)`, `triangular(+-5%)` | about the value of the file; for `normal` the standard deviation |
///
/// A unit at one number holds for those without. A share is one of the value of the file, of a temperature there is
/// none.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "lowercase")]
#[non_exhaustive]
pub enum Distribution {
    /// All values between are equally likely.
    Uniform {
        /// Smallest value.
        least: f64,
        /// Largest value.
        most: f64,
    },
    /// Normal, cut off at three standard deviations.
    Normal {
        /// Mean.
        mean: f64,
        /// Standard deviation before it is cut off; after that it is 0.98658 of this.
        sigma: f64,
    },
    /// A straight rise and a straight fall.
    Triangular {
        /// Smallest value.
        least: f64,
        /// Most likely value.
        mode: f64,
        /// Largest value.
        most: f64,
    },
    /// The logarithm is normal, cut off at three standard deviations.
    Lognormal {
        /// Median.
        median: f64,
        /// The exponential of the standard deviation of the logarithm.
        factor: f64,
    },
}

/// Where normal distributions are cut off, in standard deviations.
pub const CUT: f64 = 3.0;
/// The normal distribution function at −[`CUT`].
const BELOW_CUT: f64 = 1.349_898_031_630_094_6e-3;

impl Distribution {
    /// The value below which a share `p` of the values lies.
    ///
    /// # Formula
    /// ```text
    /// uniform     a + p (b − a)
    /// triangular  a + √(p (b − a)(m − a)) up to the mode m, b − √((1 − p)(b − a)(b − m)) above
    /// normal      µ + σ Φ⁻¹(Φ(−3) + p (1 − 2 Φ(−3)))
    /// lognormal   median · factor^z with the same z
    /// ```
    pub fn quantile(&self, p: f64) -> f64 {
        let cut = || standard_normal_quantile(BELOW_CUT + p * (1.0 - 2.0 * BELOW_CUT));
        match *self {
            Self::Uniform { least, most } => least + p * (most - least),
            Self::Normal { mean, sigma } => mean + sigma * cut(),
            Self::Lognormal { median, factor } => median * (cut() * factor.ln()).exp(),
            Self::Triangular { least, mode, most } => {
                let width = most - least;
                if p * width < mode - least {
                    least + (p * width * (mode - least)).sqrt()
                } else {
                    most - ((1.0 - p) * width * (most - mode)).sqrt()
                }
            }
        }
    }

    /// The smallest and the largest value.
    pub fn ends(&self) -> [f64; 2] {
        match *self {
            Self::Uniform { least, most } | Self::Triangular { least, most, .. } => [least, most],
            Self::Normal { mean, sigma } => [mean - CUT * sigma, mean + CUT * sigma],
            Self::Lognormal { median, factor } => [median / factor.powi(3), median * factor.powi(3)],
        }
    }

    /// In words, with the unit.
    pub fn describe(&self, unit: &str) -> String {
        let n = |x: f64| plain(x, 6);
        let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
        match *self {
            Self::Uniform { least, most } => format!("{}..{}{unit}", n(least), n(most)),
            Self::Normal { mean, sigma } => format!("normal({}, {}{unit})", n(mean), n(sigma)),
            Self::Triangular { least, mode, most } => {
                format!("triangular({}, {}, {}{unit})", n(least), n(mode), n(most))
            }
            Self::Lognormal { median, factor } => format!("lognormal({}{unit}, {})", n(median), n(factor)),
        }
    }
}

/// A number rounded to so many digits.
pub(super) fn rounded(x: f64, digits: usize) -> f64 {
    let rounded: f64 = format!("{x:.*e}", digits - 1).parse().expect("a number was written");
    // Adding zero turns -0 into 0.
    rounded + 0.0
}

/// The shortest text of a number, rounded to so many digits.
pub(super) fn plain(x: f64, digits: usize) -> String {
    rounded(x, digits).to_string()
}

/// The number below which a standard normal variable lies with probability `p`, for p from 1e-10 to 1 − 1e-10.
///
/// # Source
/// Wichura (1988), algorithm AS 241, PPND16: rational approximations with a relative error of 1e-16. That for
/// probabilities below exp(−25) is left out.
pub fn standard_normal_quantile(p: f64) -> f64 {
    const A: [f64; 8] = [
        3.387_132_872_796_366_5,
        1.331_416_678_917_843_8e2,
        1.971_590_950_306_551_3e3,
        1.373_169_376_550_946e4,
        4.592_195_393_154_987e4,
        6.726_577_092_700_87e4,
        3.343_057_558_358_813e4,
        2.509_080_928_730_122_7e3,
    ];
    const B: [f64; 8] = [
        1.0,
        4.231_333_070_160_091e1,
        6.871_870_074_920_579e2,
        5.394_196_021_424_751e3,
        2.121_379_430_158_66e4,
        3.930_789_580_009_271e4,
        2.872_908_573_572_194_3e4,
        5.226_495_278_852_854e3,
    ];
    const C: [f64; 8] = [
        1.423_437_110_749_683_5,
        4.630_337_846_156_546,
        5.769_497_221_460_691,
        3.647_848_324_763_204_5,
        1.270_458_252_452_368_4,
        2.417_807_251_774_506e-1,
        2.272_384_498_926_918_4e-2,
        7.745_450_142_783_414e-4,
    ];
    const D: [f64; 8] = [
        1.0,
        2.053_191_626_637_759,
        1.676_384_830_183_803_8,
        6.897_673_349_851e-1,
        1.481_039_764_274_800_8e-1,
        1.519_866_656_361_645_7e-2,
        5.475_938_084_995_345e-4,
        1.050_750_071_644_416_9e-9,
    ];
    let at = |c: &[f64; 8], r: f64| c.iter().rev().fold(0.0, |sum, c| sum * r + c);
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * at(&A, r) / at(&B, r);
    }
    let r = (-p.min(1.0 - p).ln()).sqrt() - 1.6;
    q.signum() * at(&C, r) / at(&D, r)
}

/// A distribution that was read, and its unit.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Read {
    pub distribution: Distribution,
    pub unit: String,
}

/// The names of distributions.
const NAMES: [&str; 4] = ["uniform", "normal", "triangular", "lognormal"];

const GRAMMAR: &str = "distributions are written `0.98..0.99` (equally likely), `+-5%`, `normal(0.4 um, 0.05 um)`, \
                       `triangular(0.2, 0.4, 0.8 um)`, `lognormal(0.4 um, 1.3)`; sets `3,4,5`";

pub(super) fn fault(text: &str, what: impl std::fmt::Display) -> Diagnostic {
    let message = format!("`{}`: {what}", text.chars().take(120).collect::<String>());
    Diagnostic::new(Code::BadAxis, "", message).hint(GRAMMAR)
}

/// Reads the part after the `=`.
pub(super) struct Reader<'a> {
    /// The whole, for messages.
    pub whole: &'a str,
    pub measure: Measure,
    /// The value of the file and its unit, where there is one.
    pub base: Option<(f64, String)>,
}

/// A number as written: its value, its unit, and whether it is a share of another.
#[derive(Clone, Debug)]
struct Part {
    value: f64,
    unit: String,
}

impl Reader<'_> {
    fn fault(&self, what: impl std::fmt::Display) -> Box<Diagnostic> {
        Box::new(fault(self.whole, what))
    }

    fn dimension(&self) -> Option<Dimension> {
        match self.measure {
            Measure::Quantity(d) => Some(d),
            _ => None,
        }
    }

    fn part(&self, text: &str) -> Result<Part, Box<Diagnostic>> {
        let text = text.trim();
        let plain = text.replace('\u{2212}', "-");
        let end = plain
            .char_indices()
            .find(|&(at, c)| {
                let exponent = matches!(c, 'e' | 'E')
                    && at > 0
                    && plain[at + 1..].trim_start_matches(['+', '-']).starts_with(|d: char| d.is_ascii_digit());
                !(c.is_ascii_digit() || matches!(c, '.' | '+' | '-') || exponent)
            })
            .map_or(plain.len(), |(at, _)| at);
        let value = plain[..end].parse::<f64>().ok().filter(|x| x.is_finite() && x.abs() < 1e100);
        let value = value.ok_or_else(|| self.fault(format!("`{}` is no number", clip(text))))?;
        Ok(Part { value, unit: plain[end..].trim().to_owned() })
    }

    /// SI value of 0 and of 1 in a unit.
    fn scale(&self, unit: &str) -> Result<(f64, f64), Box<Diagnostic>> {
        let Some(dimension) = self.dimension() else {
            let what = if unit == "%" { "a share stands after `+-`" } else { "this quantity is a plain number" };
            return Err(self.fault(format!("`{unit}` is out of place: {what}")));
        };
        let at = |n: &str| {
            units::parse(&format!("{n} {unit}"), dimension).map(|q| q.si()).map_err(|e| {
                let (kind, example) = dimension.describe();
                match e.instead.as_slice() {
                    [one] => self.fault(format!(
                        "`{unit}` is no unit of {kind}: {e}; did you mean `{}`?",
                        one.trim_start_matches("0 ")
                    )),
                    _ => self.fault(format!("`{unit}` is no unit of {kind}: {e}; an example is `{example}`")),
                }
            })
        };
        let zero = at("0")?;
        Ok((zero, at("1")? - zero))
    }

    /// Checks a unit, and gives the one in which the distribution is.
    fn unit(&self, parts: &[&Part]) -> Result<String, Box<Diagnostic>> {
        let written = parts.iter().map(|p| p.unit.as_str()).find(|u| !u.is_empty());
        match (written, self.dimension()) {
            (None, None) => Ok(String::new()),
            (None, Some(dimension)) => {
                let (kind, example) = dimension.describe();
                Err(self.fault(format!("the unit is missing: this is {kind}, as in `{example}`")))
            }
            (Some(unit), _) => self.scale(unit).map(|_| unit.to_owned()),
        }
    }

    /// A value in a unit.
    fn value(&self, part: &Part, unit: &str) -> Result<f64, Box<Diagnostic>> {
        if part.unit.is_empty() || part.unit == unit {
            return Ok(part.value);
        }
        let (theirs, ours) = (self.scale(&part.unit)?, self.scale(unit)?);
        Ok((theirs.0 + part.value * theirs.1 - ours.0) / ours.1)
    }

    /// A difference in a unit; a share is one of `of`.
    fn difference(&self, part: &Part, unit: &str, of: f64) -> Result<f64, Box<Diagnostic>> {
        if part.unit == "%" {
            if self.dimension() == Some(Dimension::TEMPERATURE) {
                return Err(self.fault("a share of a temperature has no meaning; write degrees, `+-5 K`"));
            }
            return Ok(part.value / 100.0 * of.abs());
        }
        if part.unit.is_empty() || part.unit == unit {
            return Ok(part.value);
        }
        Ok(part.value * self.scale(&part.unit)?.1 / self.scale(unit)?.1)
    }

    /// What stands after `+-`.
    fn about<'t>(&self, text: &'t str) -> Option<&'t str> {
        ["+-", "+/-", "±", "+\u{2212}"].iter().find_map(|sign| text.trim().strip_prefix(sign))
    }

    /// The value of the file and the half width about it.
    fn around(&self, text: &str) -> Result<(f64, f64, String), Box<Diagnostic>> {
        let part = self.part(text)?;
        let Some((base, unit)) = &self.base else {
            return Err(self.fault("the file gives no value about which it could vary; write both ends, `a..b`"));
        };
        if part.unit.is_empty() && self.dimension().is_some() {
            return Err(self.fault("the unit is missing: write `%` or a unit of this quantity"));
        }
        let half = self.difference(&part, unit, *base)?;
        if half < 0.0 {
            return Err(self.fault("the width after `+-` is above zero"));
        }
        if half == 0.0 {
            return Err(self.fault("nothing varies: the width is zero"));
        }
        Ok((*base, half, unit.clone()))
    }

    fn between(&self, from: &str, to: &str) -> Result<Read, Box<Diagnostic>> {
        let (from, to) = (self.part(from)?, self.part(to)?);
        let unit = self.unit(&[&from, &to])?;
        let (least, most) = (self.value(&from, &unit)?, self.value(&to, &unit)?);
        let [a, b] = [plain(least, 12), plain(most, 12)];
        if least == most {
            return Err(self.fault(format!("the interval is empty: both ends are {a}")));
        }
        if least > most {
            let message = format!("the interval runs backwards, from {a} down to {b}; write the smaller value first");
            return Err(self.fault(message));
        }
        Ok(Read { distribution: Distribution::Uniform { least, most }, unit })
    }

    /// Reads a distribution; `None` where it is a set of values.
    pub fn read(&self, text: &str) -> Result<Option<Read>, Box<Diagnostic>> {
        let text = text.trim();
        if let Some(width) = self.about(text) {
            let (base, half, unit) = self.around(width)?;
            let distribution = Distribution::Uniform { least: base - half, most: base + half };
            return Ok(Some(Read { distribution, unit }));
        }
        if let Some((name, rest)) = text.split_once('(') {
            let Some(inside) = rest.trim_end().strip_suffix(')') else {
                return Err(self.fault("the closing parenthesis is missing"));
            };
            return self.named(name.trim(), inside).map(Some);
        }
        match text.split_once("..") {
            Some((from, to)) => self.between(from, to).map(Some),
            None => Ok(None),
        }
    }

    fn named(&self, name: &str, inside: &str) -> Result<Read, Box<Diagnostic>> {
        if !NAMES.contains(&name) {
            let message = format!("there is no distribution `{}`", clip(name));
            let d = Diagnostic::new(Code::UnknownName, "", message).suggest(name, NAMES);
            return Err(Box::new(d.hint(GRAMMAR)));
        }
        if let Some(width) = self.about(inside) {
            let (base, half, unit) = self.around(width)?;
            let distribution = match name {
                "normal" => Distribution::Normal { mean: base, sigma: half },
                "triangular" => Distribution::Triangular { least: base - half, mode: base, most: base + half },
                "uniform" => Distribution::Uniform { least: base - half, most: base + half },
                _ => return Err(self.fault("a lognormal distribution has a factor: `lognormal(0.4 um, 1.3)`")),
            };
            return Ok(Read { distribution, unit });
        }
        let texts: Vec<&str> = inside.split(',').collect();
        let wants: &[&str] = match name {
            "normal" => &["mean", "standard deviation"],
            "triangular" => &["least", "most likely", "greatest value"],
            "lognormal" => &["median", "factor"],
            _ => &["least", "greatest value"],
        };
        if texts.len() != wants.len() {
            let message = format!("`{name}` has {} numbers, {}", wants.len(), wants.join(", "));
            return Err(self.fault(message));
        }
        if name == "uniform" {
            return self.between(texts[0], texts[1]);
        }
        let parts: Vec<Part> = texts.iter().map(|t| self.part(t)).collect::<Result<_, _>>()?;
        let of_unit: Vec<&Part> = match name {
            "lognormal" => vec![&parts[0]],
            // The unit of a spread may be another, 70 degC and 5 K.
            "normal" if parts[1].unit == "%" => vec![&parts[0]],
            _ => parts.iter().collect(),
        };
        let unit = self.unit(&of_unit)?;
        let first = self.value(&parts[0], &unit)?;
        let distribution = match name {
            "normal" => {
                let sigma = self.difference(&parts[1], &unit, first)?;
                if sigma <= 0.0 {
                    return Err(self.fault(format!("a standard deviation is above zero, and this is {sigma}")));
                }
                Distribution::Normal { mean: first, sigma }
            }
            "lognormal" => {
                if !parts[1].unit.is_empty() {
                    return Err(self.fault("the second number of `lognormal` is a factor, without a unit"));
                }
                let factor = parts[1].value;
                if factor <= 1.0 {
                    return Err(self.fault(format!("a factor is above 1, and this is {factor}")));
                }
                if first <= 0.0 {
                    return Err(self.fault("the median of a lognormal distribution is above zero"));
                }
                Distribution::Lognormal { median: first, factor }
            }
            _ => {
                let (mode, most) = (self.value(&parts[1], &unit)?, self.value(&parts[2], &unit)?);
                if !(first <= mode && mode <= most && first < most) {
                    return Err(self.fault("write least, most likely and greatest value in this order"));
                }
                Distribution::Triangular { least: first, mode, most }
            }
        };
        Ok(Read { distribution, unit })
    }

    /// The text of a value in its unit.
    pub fn base_of(text: &str, measure: Measure) -> Option<(f64, String)> {
        let own = Reader { whole: text, measure, base: None };
        match measure {
            Measure::Text | Measure::Flag => None,
            _ => own.part(text).ok().map(|p| (p.value, p.unit)),
        }
    }
}

fn clip(text: &str) -> String {
    text.chars().filter(|c| crate::diagnostic::is_printable(*c)).take(64).collect()
}
