//! Every oil temperature at which the heat made and the heat carried away agree.
//!
//! With `Q` rising from 0 at the temperature `θ0` without losses, `P/Q = 1` at an equilibrium. Two arguments bound how
//! often that happens:
//!
//! - **Elasticity.** `P/Q` falls where `E = (P′/P)/(Q′/Q) < 1`. Where that holds on the whole range there is at most one
//!   equilibrium, for every conductance. A sum has the mean of the elasticities of its parts, weighted by their losses.
//! - **Branch and bound.** The residual rises with `θ` at given heats and falls with each heat. On `[a, b]` it lies between
//!   its value at `a` with the largest heats and that at `b` with the smallest. If 0 is not between them, there is no
//!   equilibrium; if its slope has one sign, there is one or none; else the interval is halved.
//!
//! Both need the heats between two temperatures. A source that knows bounds gives a proof ([`Certificate::proved`]). For
//! the others each heat is taken to be monotone, and its slope within twice those seen, between temperatures that were
//! computed; the certificate says how far apart these are.
//!
//! A law that jumps can leave no temperature at which the two agree: the balance then rests on the step.

use super::Source;
use super::network::Unsolved;
use crate::train::heat::Heat;

/// Parts of the range that are looked at first.
const PARTS: usize = 8;
/// Width below which an interval is not halved, K: with bounds, and from samples.
const NARROW: f64 = 1e-6;
const NARROW_SAMPLED: f64 = 1e-3;
/// How near an equilibrium a temperature must be to end the search, over the width that ends it otherwise.
const NEAR: f64 = 1e-3;
/// Most temperatures at which a source is asked.
const MOST_SAMPLES: usize = 100_000;
const MOST_SAMPLES_SAMPLED: usize = 400;

/// What a heat is within over an interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Smallest and largest heat, W.
    pub heat: [f64; 2],
    /// Smallest and largest slope, W/K.
    pub slope: [f64; 2],
}

/// Where equilibria are looked for, and how closely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Highest oil temperature that is looked at, K.
    pub highest: f64,
    /// Width to which an equilibrium is closed in, K; 0: neighbouring numbers.
    pub tolerance: f64,
}

/// What can be said of the oil temperature.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum HeatVerdict {
    /// One equilibrium.
    Unique,
    /// Several equilibria; which one is reached depends on the start.
    Several,
    /// No equilibrium up to the limit.
    NoneBelowLimit,
    /// Within some interval it is not decided.
    Undecided,
}

impl HeatVerdict {
    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::Unique => "one equilibrium",
            Self::Several => "several equilibria",
            Self::NoneBelowLimit => "no equilibrium below the limit",
            Self::Undecided => "not decided",
        }
    }
}

/// How it is known that there are no other equilibria.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// The elasticity of the losses is below one.
    Elasticity,
    /// Intervals were excluded, or have a slope of one sign.
    BranchAndBound,
}

/// Why there are no other equilibria.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Certificate {
    /// The argument.
    pub method: Method,
    /// Whether bounds prove it. Else the elasticity is taken to differ within an interval no more than it does from one
    /// interval to the next, or, where intervals were excluded, each heat to be monotone between the temperatures computed.
    pub proved: bool,
    /// Largest elasticity of the losses between two temperatures; one equilibrium where it is below 1.
    pub largest_elasticity: Option<f64>,
    /// Temperatures at which the losses were computed.
    pub temperatures: usize,
    /// Largest distance between two of them, K.
    pub widest_k: f64,
}

/// Heat made and carried away at one oil temperature.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Oil temperature, K.
    pub oil: f64,
    /// Heat made at each place, W.
    pub made: Vec<f64>,
    /// Temperature of each place, K.
    pub temperatures: Vec<f64>,
    /// Heat that leaves the oil if nothing is made, W.
    pub carried: f64,
    /// Heat that reaches the oil, with that beside the losses, W.
    pub reaching: f64,
}

impl Sample {
    /// Heat that leaves the oil less what reaches it, W.
    pub fn residual(&self) -> f64 {
        self.carried - self.reaching
    }
}

/// An oil temperature at which the two agree.
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium {
    /// Heat there.
    pub at: Sample,
    /// Slope of what is carried less what is made, W/K: above zero where it is stable.
    pub slope: f64,
    /// On the step of a law: the heat that reaches the oil just below and just above it, W.
    pub step: Option<[f64; 2]>,
}

impl Equilibrium {
    /// Whether the oil returns to it after a small disturbance.
    pub fn is_stable(&self) -> bool {
        self.slope > 0.0
    }
}

/// Every oil temperature that holds, up to a limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Balance {
    /// What can be said.
    pub verdict: HeatVerdict,
    /// Every equilibrium, the coldest first; stable and unstable alternate.
    pub equilibria: Vec<Equilibrium>,
    /// Why there are no others.
    pub certificate: Certificate,
    /// Intervals in which it is not decided, K.
    pub undecided: Vec<[f64; 2]>,
    /// Heat at every temperature that was computed, the coldest first.
    pub samples: Vec<Sample>,
}

impl Balance {
    /// The equilibrium that the oil tends to from a temperature, K: none where it runs beyond the limit.
    pub fn from(&self, start: f64) -> Option<&Equilibrium> {
        let below = self.equilibria.iter().rfind(|e| e.at.oil <= start);
        let above = self.equilibria.iter().find(|e| e.at.oil > start);
        match below {
            // Above an unstable one it warms, above a stable one it cools.
            Some(e) if e.is_stable() || e.at.oil == start => Some(e),
            _ => above,
        }
    }

    /// Heat at the highest temperature.
    pub fn at_limit(&self) -> &Sample {
        self.samples.last().expect("the ends of the range are samples")
    }
}

/// Why there is no balance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Failed<E> {
    /// The source has no answer.
    Source(E),
    /// The network has no temperatures.
    Network(Unsolved),
}

impl<E> From<Unsolved> for Failed<E> {
    fn from(u: Unsolved) -> Self {
        Self::Network(u)
    }
}

/// Every equilibrium of a network and a source from the temperature without losses up to a limit.
///
/// # Errors
/// The source has no answer at some temperature, or the network none.
///
/// # Example
/// A loss that does not depend on the temperature: `θ = θ_a + P/UA`.
/// ```
/// use willis::heat::{balance, HeatVerdict, Limits};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one place"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     mesh = [{ gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
///     heat = { ambient = "20 degC", conductance = "45 W/K" }
/// "#)?;
/// let loss = |_: f64| Ok::<_, ()>(vec![3600.0, 0.0]);
/// let all = balance(train.heat().unwrap(), &loss, Limits { highest: 420.0, tolerance: 0.0 }).unwrap();
/// assert_eq!(all.verdict, HeatVerdict::Unique);
/// assert!((all.equilibria[0].at.oil - 373.15).abs() < 1e-10);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn balance<S: Source>(heat: &Heat, source: &S, limits: Limits) -> Result<Balance, Failed<S::Error>> {
    let cold = heat.cold()?;
    let mut search = Search { heat, source, tolerance: limits.tolerance, sampled: false, asked: 0, last: [None, None] };
    if cold >= limits.highest {
        let samples = vec![search.sample(limits.highest)?];
        return Ok(search.finish(samples, Found::default(), Method::BranchAndBound, true, None));
    }
    let mut samples = vec![search.sample(cold)?];
    for k in 1..=PARTS {
        let t = cold + (limits.highest - cold) * k as f64 / PARTS as f64;
        samples.push(search.sample(if k == PARTS { limits.highest } else { t })?);
    }
    let elasticity = search.elasticity(&samples);
    let mut found = Found::default();
    let single = match elasticity {
        Elasticity::Proved(_) => true,
        Elasticity::Sampled { largest, change } => largest + change < 1.0,
        Elasticity::Unknown => false,
    };
    let largest = match elasticity {
        Elasticity::Proved(e) | Elasticity::Sampled { largest: e, .. } => Some(e),
        Elasticity::Unknown => None,
    };
    if single {
        let proved = matches!(elasticity, Elasticity::Proved(_));
        search.sampled |= !proved;
        if samples[PARTS].residual() >= 0.0 {
            let at = (1..=PARTS).find(|k| samples[*k].residual() >= 0.0).expect("the last one");
            let (a, b) = (samples[at - 1].clone(), samples[at].clone());
            let (e, more) = search.close_in(a, b)?;
            found.equilibria.push(e);
            samples.extend(more);
        }
        return Ok(search.finish(samples, found, Method::Elasticity, proved, largest));
    }
    if samples[0].residual() == 0.0 {
        // Nothing is lost at the temperature without losses.
        let slope = (samples[1].residual() - samples[0].residual()) / (samples[1].oil - samples[0].oil);
        found.equilibria.push(Equilibrium { at: samples[0].clone(), slope, step: None });
    }
    let pairs: Vec<(Sample, Sample)> = samples.windows(2).rev().map(|w| (w[0].clone(), w[1].clone())).collect();
    let mut stack = pairs;
    while let Some((a, b)) = stack.pop() {
        match search.judge(&a, &b, &mut samples)? {
            Judged::Nothing => {}
            Judged::One => {
                let (e, more) = search.close_in(a, b)?;
                found.equilibria.push(e);
                samples.extend(more);
            }
            Judged::Open(computed) => {
                let middle = 0.5 * (a.oil + b.oil);
                let narrow = if search.sampled { NARROW_SAMPLED } else { NARROW };
                let spent = search.asked > if search.sampled { MOST_SAMPLES_SAMPLED } else { MOST_SAMPLES };
                if b.oil - a.oil <= narrow || spent || middle <= a.oil || middle >= b.oil {
                    match crosses(&a, &b) && !spent {
                        // A step, or an equilibrium beside one: the sign changes here.
                        true => {
                            let (e, more) = search.close_in(a, b)?;
                            found.equilibria.push(e);
                            samples.extend(more);
                        }
                        false => found.undecided.push([a.oil, b.oil]),
                    }
                    continue;
                }
                let m = match computed {
                    Some(m) => m,
                    None => {
                        let m = search.sample(middle)?;
                        samples.push(m.clone());
                        m
                    }
                };
                stack.push((m.clone(), b));
                stack.push((a, m));
            }
        }
    }
    let proved = !search.sampled && found.undecided.is_empty();
    Ok(search.finish(samples, found, Method::BranchAndBound, proved, largest))
}

/// Whether the residual changes sign between two temperatures, or is zero at the upper one.
fn crosses(a: &Sample, b: &Sample) -> bool {
    a.residual() < 0.0 && b.residual() >= 0.0 || a.residual() > 0.0 && b.residual() <= 0.0
}

/// Where between `a` and `b` the residual is zero, as a part of the way from `a`; `c` is a third point beside them.
fn between(a: &Sample, b: &Sample, c: Option<&Sample>) -> f64 {
    let [fa, fb] = [a, b].map(Sample::residual);
    let Some(c) = c else { return fa / (fa - fb) };
    let fc = c.residual();
    let (xi, phi) = ((a.oil - b.oil) / (c.oil - b.oil), (fa - fb) / (fc - fb));
    if phi * phi >= xi || (1.0 - phi) * (1.0 - phi) >= 1.0 - xi {
        return 0.5;
    }
    let reach = (c.oil - a.oil) / (b.oil - a.oil);
    fa / (fb - fa) * fc / (fb - fc) + reach * fa / (fc - fa) * fb / (fc - fb)
}

#[derive(Default)]
struct Found {
    equilibria: Vec<Equilibrium>,
    undecided: Vec<[f64; 2]>,
}

enum Judged {
    Nothing,
    One,
    /// With the middle, where it was computed.
    Open(Option<Sample>),
}

/// Largest elasticity over the range.
#[derive(Clone, Copy)]
enum Elasticity {
    /// Bounded by bounds of the source.
    Proved(f64),
    /// Between samples, and by how much it changes from one interval to the next.
    Sampled {
        largest: f64,
        change: f64,
    },
    Unknown,
}

struct Search<'a, S> {
    heat: &'a Heat,
    source: &'a S,
    tolerance: f64,
    /// Whether something rests on samples.
    sampled: bool,
    asked: usize,
    /// Temperatures of the last sample, with its heats and without any.
    last: [Option<Vec<f64>>; 2],
}

impl<S: Source> Search<'_, S> {
    fn sample(&mut self, oil: f64) -> Result<Sample, Failed<S::Error>> {
        self.asked += 1;
        let made = self.source.heat(oil).map_err(Failed::Source)?;
        // Newton's method needs the fewest steps from the temperatures of the last sample.
        let [warm, idle] = &mut self.last;
        let at = self.heat.at_near(oil, &made, warm.as_deref())?;
        let without = self.heat.at_near(oil, &vec![0.0; made.len()], idle.as_deref())?;
        let carried = without.residual + self.heat.extra_heat;
        (*warm, *idle) = (Some(at.temperatures.clone()), Some(without.temperatures));
        Ok(Sample { oil, made, temperatures: at.temperatures, carried, reaching: carried - at.residual })
    }

    /// Elasticities between neighbouring samples.
    fn elasticity(&self, samples: &[Sample]) -> Elasticity {
        if samples.iter().any(|s| s.reaching.is_nan() || s.reaching <= 0.0) {
            return Elasticity::Unknown;
        }
        if let Some(proved) = self.proved_elasticity(samples) {
            return Elasticity::Proved(proved);
        }
        let of = |w: &[Sample]| {
            let [a, b] = w else { return 0.0 };
            let losses = (b.reaching / a.reaching).ln();
            // From the temperature without losses on, of which the ratio is none.
            let heats = if a.carried > 0.0 { (b.carried / a.carried).ln() } else { 1.0 };
            losses / heats
        };
        let all: Vec<f64> = samples.windows(2).map(of).collect();
        let largest = all.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let change = all.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
        Elasticity::Sampled { largest, change }
    }

    /// A bound of the elasticity that holds everywhere, if the source gives bounds and the network is linear.
    fn proved_elasticity(&self, samples: &[Sample]) -> Option<f64> {
        if !self.is_linear() {
            return None;
        }
        let mut largest = f64::NEG_INFINITY;
        for w in samples.windows(2) {
            let bounds = self.source.bounds(w[0].oil, w[1].oil)?;
            let at = self.heat.at(w[1].oil, &w[1].made).ok()?;
            let sum = |of: &dyn Fn(&Bounds) -> f64| bounds.iter().zip(&at.shares).map(|(b, s)| of(b) * s).sum::<f64>();
            let slope = sum(&|b| b.slope[1]);
            let reaching = sum(&|b| b.heat[0]) + self.heat.extra_heat;
            if reaching.is_nan() || reaching <= 0.0 {
                return None;
            }
            // Q/Q′ is the distance from the temperature without losses.
            let distance = if slope > 0.0 { w[1].oil } else { w[0].oil } - samples[0].oil;
            largest = largest.max(slope * distance / reaching);
        }
        (largest < 1.0).then_some(largest)
    }

    /// Whether heat flows in proportion to differences of temperature.
    fn is_linear(&self) -> bool {
        use crate::train::heat::{Exchange, PathLaw};
        let paths = self.heat.paths.iter().all(|p| !matches!(p.law, PathLaw::Surface(_)));
        let cooler = self.heat.cooler.is_none_or(|c| {
            c.thermostat.is_none() && (matches!(c.exchange, Exchange::Conductance(_)) || self.heat.oil.expansion == 0.0)
        });
        paths && cooler
    }

    /// Whether an interval has no equilibrium, one, or must be halved.
    fn judge(&mut self, a: &Sample, b: &Sample, samples: &mut Vec<Sample>) -> Result<Judged, Failed<S::Error>> {
        let known = self.source.bounds(a.oil, b.oil);
        let rigorous = known.is_some();
        let ends: Vec<[f64; 2]> = match &known {
            Some(bounds) => bounds.iter().map(|b| b.heat).collect(),
            None => a.made.iter().zip(&b.made).map(|(x, y)| [x.min(*y), x.max(*y)]).collect(),
        };
        let pick = |k: usize| ends.iter().map(|e| e[k]).collect::<Vec<_>>();
        let least = self.heat.at(a.oil, &pick(1))?.residual;
        let most = self.heat.at(b.oil, &pick(0))?.residual;
        if least > 0.0 || most < 0.0 {
            self.sampled |= !rigorous;
            return Ok(Judged::Nothing);
        }
        let verdict = || if crosses(a, b) { Judged::One } else { Judged::Nothing };
        if let (Some(bounds), true) = (&known, self.is_linear()) {
            let at = self.heat.at(a.oil, &a.made)?;
            let slope = |k: usize| bounds.iter().zip(&at.shares).map(|(b, s)| b.slope[k] * s).sum::<f64>();
            let [low, high] = [at.slope - slope(1), at.slope - slope(0)];
            return Ok(if low > 0.0 || high < 0.0 { verdict() } else { Judged::Open(None) });
        }
        // Slopes of both halves, which differ little: the slope between them has their sign.
        self.sampled = true;
        if b.oil - a.oil <= NARROW_SAMPLED {
            return Ok(Judged::Open(None));
        }
        let m = self.sample(0.5 * (a.oil + b.oil))?;
        let slopes = [(a, &m), (&m, b)].map(|(x, y)| (y.residual() - x.residual()) / (y.oil - x.oil));
        samples.push(m.clone());
        let alike = slopes[0] * slopes[1] > 0.0 && (0.5..=2.0).contains(&(slopes[0] / slopes[1]));
        Ok(if alike { verdict() } else { Judged::Open(Some(m)) })
    }

    /// The equilibrium between two temperatures with residuals of different signs, and what was computed on the way.
    fn close_in(&mut self, a: Sample, b: Sample) -> Result<(Equilibrium, Vec<Sample>), Failed<S::Error>> {
        let slope = (b.residual() - a.residual()) / (b.oil - a.oil);
        let mut more = vec![];
        // The method of Chandrupatla (Adv. Eng. Softw. 28 (1997) 145): a parabola through the last three points where it is
        // sure to lie between, else the middle; the straight line to begin with. `a` is the latest point, `c` the one before.
        let (mut a, mut b, mut c) = (b, a, None::<Sample>);
        loop {
            let width = (b.oil - a.oil).abs();
            let middle = 0.5 * (a.oil + b.oil);
            if a.residual() == 0.0 || width <= self.tolerance || middle == a.oil || middle == b.oil {
                break;
            }
            let part = between(&a, &b, c.as_ref());
            let least = (0.5 * NEAR * self.tolerance / width).clamp(f64::EPSILON, 0.5);
            let m = self.sample(a.oil + part.clamp(least, 1.0 - least) * (b.oil - a.oil))?;
            more.push(m.clone());
            // A residual so small is a temperature so near.
            let chord = (b.residual() - a.residual()) / width;
            let found = m.residual().abs() <= NEAR * self.tolerance * chord.abs();
            let before = std::mem::replace(&mut a, m);
            c = Some(match (a.residual() < 0.0) == (before.residual() < 0.0) {
                true => before,
                false => std::mem::replace(&mut b, before),
            });
            if found {
                break;
            }
        }
        let (a, b) = if a.oil < b.oil { (a, b) } else { (b, a) };
        let width = (b.oil - a.oil).max(f64::MIN_POSITIVE);
        // What a steady law changes over so small a width.
        let expected = 4.0 * slope.abs() * width + 1e-8 * a.reaching.abs().max(b.reaching.abs());
        let jumps = (b.residual() - a.residual()).abs() > 1e2 * expected && b.residual() != 0.0;
        let step = jumps.then_some([a.reaching, b.reaching]);
        let rising = b.residual() >= a.residual();
        let at = if b.residual().abs() <= a.residual().abs() { b } else { a };
        let slope = self.slope(&at, rising)?;
        Ok((Equilibrium { at, slope, step }, more))
    }

    /// Slope of carried less made near an equilibrium, with the sign that is known.
    fn slope(&mut self, at: &Sample, rising: bool) -> Result<f64, Failed<S::Error>> {
        let h = 0.01;
        let beside = [at.oil - h, at.oil + h].map(|t| {
            let made = self.source.heat(t).map_err(Failed::Source)?;
            Ok::<f64, Failed<S::Error>>(self.heat.at(t, &made)?.residual)
        });
        let [low, high] = beside;
        let slope = (high? - low?) / (2.0 * h);
        Ok(if (slope > 0.0) == rising {
            slope
        } else if rising {
            f64::MIN_POSITIVE
        } else {
            -f64::MIN_POSITIVE
        })
    }

    fn finish(
        &self,
        mut samples: Vec<Sample>,
        mut found: Found,
        method: Method,
        proved: bool,
        largest_elasticity: Option<f64>,
    ) -> Balance {
        samples.sort_by(|a, b| a.oil.total_cmp(&b.oil));
        samples.dedup_by(|a, b| a.oil == b.oil);
        found.equilibria.sort_by(|a, b| a.at.oil.total_cmp(&b.at.oil));
        let verdict = match (found.undecided.is_empty(), found.equilibria.len()) {
            (false, _) => HeatVerdict::Undecided,
            (true, 0) => HeatVerdict::NoneBelowLimit,
            (true, 1) => HeatVerdict::Unique,
            (true, _) => HeatVerdict::Several,
        };
        let widest = samples.windows(2).map(|w| w[1].oil - w[0].oil).fold(0.0, f64::max);
        Balance {
            verdict,
            equilibria: found.equilibria,
            certificate: Certificate {
                method,
                proved,
                largest_elasticity,
                temperatures: samples.len(),
                widest_k: widest,
            },
            undecided: found.undecided,
            samples,
        }
    }
}
