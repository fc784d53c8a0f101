//! What the points of a study say together.

use std::collections::BTreeMap;
use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use crate::diagnostic::Code;

use super::answer::{LawChoice, PointAnswer, PointVerdict};

/// A value and the number of the point that has it; in contracts `[value, point]`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(from = "(f64, u64)", into = "(f64, u64)")]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The number of the point.
    pub point: u64,
}

impl From<(f64, u64)> for Extreme {
    fn from((value, point): (f64, u64)) -> Self {
        Self { value, point }
    }
}

impl From<Extreme> for (f64, u64) {
    fn from(e: Extreme) -> Self {
        (e.value, e.point)
    }
}

/// Least, greatest and sum of a quantity over the points that have one, and where the extremes are.
///
/// Each piece of a study adds its own points in floating point; sums of pieces are added exactly. So the sum over many
/// pieces is the same in whatever order and through whatever shards they come together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct MinMaxSum {
    /// Points that have a value.
    pub count: u64,
    /// Their sum, rounded once.
    pub sum: f64,
    /// What `sum` lacks of the exact sum of all pieces, largest part first; nothing where it lacks nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub rest: Vec<f64>,
    /// The smallest, and the number of its point; absent where no point has a value.
    pub least: Option<Extreme>,
    /// The largest, and the number of its point.
    pub most: Option<Extreme>,
}

impl MinMaxSum {
    pub(super) fn add(&mut self, value: f64, point: u64) {
        if !value.is_nan() {
            self.add_run(1, value, [value; 2], |_| point);
        }
    }

    /// Adds values none of which is NaN: how many, their sum, the smallest and the largest; `point` finds a value.
    pub(super) fn add_run(&mut self, count: u64, sum: f64, [least, most]: [f64; 2], point: impl Fn(f64) -> u64) {
        self.count += count;
        self.sum += sum;
        // Where an extreme is, is looked up only when it is one.
        if self.least.is_none_or(|e| least < e.value) {
            self.least = Some(Extreme { value: least, point: point(least) });
        }
        if self.most.is_none_or(|e| most > e.value) {
            self.most = Some(Extreme { value: most, point: point(most) });
        }
    }

    pub(super) fn join(&mut self, other: &Self) {
        let (Some(least), Some(most)) = (other.least, other.most) else { return };
        self.count += other.count;
        let mut parts = exact_sum([self.sum, other.sum].iter().chain(&self.rest).chain(&other.rest)).into_iter();
        self.sum = parts.next().unwrap_or(0.0);
        self.rest = parts.collect();
        if self.least.is_none_or(|e| least.value < e.value) {
            self.least = Some(least);
        }
        if self.most.is_none_or(|e| most.value > e.value) {
            self.most = Some(most);
        }
    }

    /// Mean of the points that have a value.
    pub fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / self.count as f64)
    }
}

/// The exact sum of numbers as parts: the first is the sum rounded, the next what that lacks, rounded, and so on. Which
/// parts they are depends on the sum alone.
///
/// Numbers are added by Shewchuk, Adaptive precision floating-point arithmetic and fast robust geometric predicates,
/// Discrete & Computational Geometry 18 (1997), Theorem 10.
fn exact_sum<'a>(numbers: impl Iterator<Item = &'a f64> + Clone) -> Vec<f64> {
    let plain: f64 = numbers.clone().sum();
    if !plain.is_finite() {
        return vec![plain];
    }
    // Parts that do not overlap, smallest first.
    let mut parts: Vec<f64> = vec![];
    let grow = |parts: &mut Vec<f64>, x: f64| {
        let mut sum = x;
        let mut kept = 0;
        for k in 0..parts.len() {
            let [a, b] = if sum.abs() < parts[k].abs() { [parts[k], sum] } else { [sum, parts[k]] };
            sum = a + b;
            let lost = b - (sum - a);
            if lost != 0.0 {
                parts[kept] = lost;
                kept += 1;
            }
        }
        parts.truncate(kept);
        parts.push(sum);
    };
    numbers.for_each(|x| grow(&mut parts, *x));
    let mut out = vec![];
    loop {
        let rounded = rounded(&parts);
        if rounded == 0.0 {
            return out;
        }
        out.push(rounded);
        grow(&mut parts, -rounded);
    }
}

/// The sum of parts that do not overlap, smallest first, rounded to the nearest number.
fn rounded(parts: &[f64]) -> f64 {
    let Some((last, rest)) = parts.split_last() else { return 0.0 };
    let (mut sum, mut lost) = (*last, 0.0);
    let mut below = rest.len();
    while below > 0 && lost == 0.0 {
        below -= 1;
        let before = sum;
        sum = before + rest[below];
        lost = rest[below] - (sum - before);
    }
    // Half of the last digit is lost: what is below it decides.
    if below > 0 && lost != 0.0 && (lost < 0.0) == (rest[below - 1] < 0.0) && rest[below - 1] != 0.0 {
        let (twice, next) = (2.0 * lost, sum + 2.0 * lost);
        if next - sum == twice {
            sum = next;
        }
    }
    sum
}

/// What points that say the same are counted by. In contracts it is a text: `W316`, `W316 mesh_friction = niemann`,
/// `reason: locked`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(into = "String", try_from = "String")]
#[non_exhaustive]
pub enum WarningKind {
    /// A warning of this code.
    Warning {
        /// The code of the warning.
        code: Code,
        /// The law that it is about, where laws are counted one by one.
        law: Option<LawChoice>,
    },
    /// Why there is no unique answer.
    Reason(PointVerdict),
}

impl From<Code> for WarningKind {
    fn from(code: Code) -> Self {
        Self::Warning { code, law: None }
    }
}

impl fmt::Display for WarningKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Warning { code, law: None } => write!(f, "{code}"),
            Self::Warning { code, law: Some(law) } => write!(f, "{code} {law}"),
            Self::Reason(verdict) => write!(f, "reason: {verdict}"),
        }
    }
}

impl FromStr for WarningKind {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("`{text}` is neither a code nor `reason: VERDICT`");
        if let Some(name) = text.strip_prefix("reason: ") {
            return PointVerdict::ALL.into_iter().find(|v| v.name() == name).map(Self::Reason).ok_or_else(wrong);
        }
        let (code, law) = text.split_once(' ').map_or((text, None), |(code, law)| (code, Some(law)));
        let code = Code::ALL.iter().copied().find(|c| c.as_str() == code).ok_or_else(wrong)?;
        let law = match law {
            None => None,
            Some(law) => {
                let (family, law) = law.split_once(" = ").ok_or_else(wrong)?;
                Some(LawChoice { family: family.to_owned(), law: law.to_owned() })
            }
        };
        Ok(Self::Warning { code, law })
    }
}

impl From<WarningKind> for String {
    fn from(kind: WarningKind) -> Self {
        kind.to_string()
    }
}

impl TryFrom<String> for WarningKind {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        text.parse()
    }
}

/// Points that say the same.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct WarningCount {
    /// At how many points.
    pub count: u64,
    /// What it says at the first of them that was looked at; where it has an extent, at the worst.
    pub message: String,
    /// The number of that point.
    pub point: u64,
    /// How far, where that can be told: the part by which prescribed speeds contradict the gears.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub extent: Option<f64>,
}

impl WarningCount {
    /// Counts later points.
    fn join(&mut self, later: &Self) {
        let count = self.count + later.count;
        if later.extent > self.extent {
            *self = later.clone();
        }
        self.count = count;
    }
}

/// Counts of what points say, by kind.
pub(super) type Seen = BTreeMap<WarningKind, WarningCount>;

/// Counts one more point, or the first.
pub(super) fn see(seen: &mut Seen, kind: WarningKind, message: &str, extent: Option<f64>, point: u64) {
    match seen.get_mut(&kind) {
        // Most points say what was said before.
        Some(own) if extent.is_none() || extent <= own.extent => own.count += 1,
        own => {
            let later = WarningCount { count: 1, message: message.into(), point, extent };
            match own {
                Some(own) => own.join(&later),
                None => drop(seen.insert(kind, later)),
            }
        }
    }
}

/// Adds what later points say.
pub(super) fn join(seen: &mut Seen, later: &Seen) {
    for (kind, count) in later {
        match seen.get_mut(kind) {
            Some(own) => own.join(count),
            None => drop(seen.insert(kind.clone(), count.clone())),
        }
    }
}

/// A value of an axis whose values are texts; in contracts `state = 3`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(into = "String", try_from = "String")]
pub struct AxisValue {
    /// The quantity of the axis.
    pub axis: String,
    /// The value.
    pub value: String,
}

impl fmt::Display for AxisValue {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} = {}", self.axis, self.value)
    }
}

impl From<AxisValue> for String {
    fn from(value: AxisValue) -> Self {
        value.to_string()
    }
}

impl TryFrom<String> for AxisValue {
    type Error = String;

    fn try_from(text: String) -> Result<Self, String> {
        let (axis, value) = text.split_once(" = ").ok_or_else(|| format!("`{text}` is no value of an axis"))?;
        Ok(Self { axis: axis.to_owned(), value: value.to_owned() })
    }
}

/// What many rows say together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Summary {
    /// How many points.
    pub points: u64,
    /// How many points have each verdict.
    pub verdicts: BTreeMap<PointVerdict, u64>,
    /// Efficiency of all points with a unique answer.
    pub efficiency: MinMaxSum,
    /// Loss of all points with one answer, W.
    pub loss_w: MinMaxSum,
    /// Efficiency by each value of the axes whose values are texts (states, laws).
    pub by_text: BTreeMap<AxisValue, MinMaxSum>,
    /// By state: at how many points it is the most efficient.
    pub best: BTreeMap<String, u64>,
    /// Warnings by their code, and by `reason` why points have no answer.
    pub seen: BTreeMap<WarningKind, WarningCount>,
}

impl Summary {
    /// Adds what later rows say.
    pub fn join(&mut self, other: &Self) {
        self.points += other.points;
        for (verdict, count) in &other.verdicts {
            *self.verdicts.entry(*verdict).or_default() += count;
        }
        self.efficiency.join(&other.efficiency);
        self.loss_w.join(&other.loss_w);
        for (text, extent) in &other.by_text {
            self.by_text.entry(text.clone()).or_default().join(extent);
        }
        for (state, count) in &other.best {
            *self.best.entry(state.clone()).or_default() += count;
        }
        join(&mut self.seen, &other.seen);
    }

    /// What an answer says in words: why it is none, and its warnings, each kind once.
    pub(super) fn hear(&mut self, answer: &PointAnswer, point: u64) {
        // What is to be said of a unique answer is a warning.
        if !answer.reason.is_empty() && !answer.is_unique() {
            see(&mut self.seen, WarningKind::Reason(answer.verdict), &answer.reason, None, point);
        }
        let mut last = None;
        for warning in &answer.warnings {
            if last != Some(warning.code) {
                see(&mut self.seen, warning.code.into(), &warning.message, warning.deviation, point);
            }
            last = Some(warning.code);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sum_is_the_same_in_any_order_and_through_any_parts() {
        // Of very different sizes, cancelling in part, with ties of the last digit.
        let mut seed = 1u64;
        let mut next = || {
            seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            seed >> 11
        };
        let mut numbers: Vec<f64> =
            (0..400).map(|_| (next() as f64 / 2f64.powi(52) - 1.0) * 2f64.powi((next() % 140) as i32 - 90)).collect();
        numbers.extend([1.0, 2f64.powi(-53), 2f64.powi(-107), -2f64.powi(-53), 1e300, -1e300, 5e-324, 0.0, -0.0]);
        let one = |x: f64, k: usize| {
            let mut m = MinMaxSum::default();
            m.add(x, k as u64);
            m
        };
        let all = |order: &[usize], cut: usize| {
            let mut groups: Vec<MinMaxSum> = vec![];
            for group in order.chunks(cut) {
                let mut own = MinMaxSum::default();
                group.iter().for_each(|&k| own.join(&one(numbers[k], k)));
                groups.push(own);
            }
            let mut whole = MinMaxSum::default();
            groups.iter().for_each(|g| whole.join(g));
            (whole.sum, whole.rest)
        };
        let mut order: Vec<usize> = (0..numbers.len()).collect();
        let first = all(&order, 1);
        assert!(!first.1.is_empty());
        for cut in [1, 2, 7, 100, 1000] {
            for k in (1..order.len()).rev() {
                order.swap(k, next() as usize % (k + 1));
            }
            assert_eq!(all(&order, cut), first, "{cut}");
        }
        // By hand: rounded up because of the last part, then what that is too much.
        let [tie, last] = [2f64.powi(-53), 2f64.powi(-107)];
        assert_eq!(exact_sum([1.0, tie, last].iter()), [1.0 + 2.0 * tie, -tie, last]);
        assert_eq!(exact_sum([1.0, tie].iter()), [1.0, tie]);
        assert_eq!(exact_sum([1e16, 1.0, -1e16].iter()), [1.0]);
        assert_eq!(exact_sum([0.5, -0.5].iter()), [0.0; 0]);
        assert_eq!(exact_sum([f64::MAX, f64::MAX].iter()), [f64::INFINITY]);
    }
}
