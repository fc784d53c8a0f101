//! Temperatures over time: `C_i dT_i/dt = P_i − Σ flow out of i`.
//!
//! Dormand and Prince's pair of orders 5 and 4 with steps that keep the error of every temperature below a tolerance.
//! Heat made, carried away and the time integral of the oil temperature are integrated with the temperatures, so that the
//! audit `∫P − ∫Q = Σ C ΔT` holds up to round-off. Places without a heat capacity follow at once.
//!
//! Source of the pair: J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6 (1980) 19.

use nalgebra::{DMatrix, Schur};

use super::Source;
use super::balance::Failed;
use super::network::{Unsolved, imbalance, solve};
use crate::train::heat::{Heat, OIL};

/// Most steps of a run.
const MOST_STEPS: usize = 2_000_000;
/// Most passes until a duty cycle repeats itself.
const MOST_PASSES: usize = 60;

/// Temperatures at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Time, s.
    pub time: f64,
    /// Temperature of each place, K.
    pub temperatures: Vec<f64>,
    /// Heat made at all places with that beside the losses, W.
    pub made: f64,
}

/// A run over time.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// At the times asked for.
    pub rows: Vec<Row>,
    /// Temperature of each place at the end, K.
    pub end: Vec<f64>,
    /// Heat made, J.
    pub made: f64,
    /// Heat carried away, J.
    pub carried: f64,
    /// Heat stored, J.
    pub stored: f64,
    /// Mean oil temperature, K.
    pub mean_oil: f64,
    /// Highest and lowest oil temperature of all steps, K.
    pub oil_range: [f64; 2],
    /// Steps.
    pub steps: usize,
}

impl Run {
    /// `∫P − ∫Q − Σ C ΔT` over the heat made.
    pub fn audit(&self) -> f64 {
        let size = self.made.abs().max(self.carried.abs()).max(self.stored.abs());
        if size == 0.0 { 0.0 } else { (self.made - self.carried - self.stored).abs() / size }
    }
}

/// A part of a duty cycle: for how long, and what makes heat.
pub struct Segment<'a, S: ?Sized> {
    /// Duration, s.
    pub duration: f64,
    /// What makes heat.
    pub source: &'a S,
}

/// A duty cycle that repeats itself.
#[derive(Clone, Debug, PartialEq)]
pub struct PeriodicDuty {
    /// One period.
    pub runs: Vec<Run>,
    /// Highest, lowest and mean oil temperature, K.
    pub highest: f64,
    /// Lowest oil temperature, K.
    pub lowest: f64,
    /// Mean oil temperature, K.
    pub mean: f64,
    /// Passes until the start was the end.
    pub passes: usize,
    /// Difference of start and end that is left, K.
    pub left: f64,
}

/// Temperatures from a start on, for a duration, at evenly spaced times.
///
/// `tolerance` bounds the error of each step, over the temperature rise. `start` is the temperature of every place, K.
///
/// # Errors
/// The source or the network has no answer; the oil has no heat capacity.
pub fn warm_up<S: Source + ?Sized>(
    heat: &Heat,
    source: &S,
    start: &[f64],
    times: &[f64],
    tolerance: f64,
) -> Result<Run, Failed<S::Error>> {
    Integration { heat, source, tolerance }.run(start, times)
}

/// The period of a duty cycle in its steady state: each pass starts where the last one ended. After two plain passes
/// Newton's method on the start, with differences of the run for its slope.
///
/// # Errors
/// As of [`warm_up`].
///
/// # Example
/// Loss 5 kW for 10 min, none for 15 min, 45 W/K, 60 kJ/K: `ΔT_max = P/UA (1 − e1)/(1 − e1 e2)`, `e = exp(−t UA/C)`.
/// ```
/// use willis::heat::{duty, Segment};
/// use willis::train::Train;
///
/// let train = Train::from_toml(r#"
///     format = 1
///     name = "one place"
///     members = ["a", "b"]
///     terminals = ["a", "b"]
///     mesh = [{ gears = [{ member = "a", teeth = 20 }, { member = "b", teeth = 30 }], efficiency = 0.99 }]
///     heat = { ambient = "20 degC", conductance = "45 W/K", heat_capacity = "60 kJ/K" }
/// "#)?;
/// let on: fn(f64) -> Result<Vec<f64>, ()> = |_| Ok(vec![5000.0, 0.0]);
/// let off: fn(f64) -> Result<Vec<f64>, ()> = |_| Ok(vec![0.0, 0.0]);
/// let cycle = [Segment { duration: 600.0, source: &on }, Segment { duration: 900.0, source: &off }];
/// let all = duty(train.heat().unwrap(), &cycle, 1e-10).unwrap();
/// assert!((all.highest - 293.15 - 59.618991).abs() < 1e-5);
/// # Ok::<(), willis::Diagnostics>(())
/// ```
pub fn duty<S: Source + ?Sized>(
    heat: &Heat,
    segments: &[Segment<'_, S>],
    tolerance: f64,
) -> Result<PeriodicDuty, Failed<S::Error>> {
    let cold = heat.cold()?;
    let mut start: Vec<f64> = heat.nodes.iter().map(|n| n.fixed.unwrap_or(cold)).collect();
    let pass = |start: &[f64]| -> Result<Vec<Run>, Failed<S::Error>> {
        let mut at = start.to_vec();
        let mut runs = Vec::with_capacity(segments.len());
        for s in segments {
            let run = warm_up(heat, s.source, &at, &[0.0, s.duration], tolerance)?;
            at.clone_from(&run.end);
            runs.push(run);
        }
        Ok(runs)
    };
    let end = |runs: &[Run], start: &[f64]| runs.last().map_or(start.to_vec(), |r| r.end.clone());
    let states: Vec<usize> = (0..heat.nodes.len()).filter(|k| heat.nodes[*k].capacity > 0.0).collect();
    let mut runs = pass(&start)?;
    let mut left = f64::INFINITY;
    let mut passes = 1;
    while passes < MOST_PASSES {
        let reached = end(&runs, &start);
        let gap: Vec<f64> = states.iter().map(|&k| reached[k] - start[k]).collect();
        left = gap.iter().fold(0.0f64, |a, d| a.max(d.abs()));
        let rise = runs.iter().map(|r| r.oil_range[1]).fold(0.0f64, f64::max) - cold;
        if left <= 1e-13 * rise.abs().max(1.0) * (1.0 + tolerance * 1e10).min(1e6) {
            break;
        }
        // Start + step = end(start + step): (1 − end′) step = gap.
        let mut matrix = vec![vec![0.0; states.len()]; states.len()];
        for (j, &k) in states.iter().enumerate() {
            let h = 0.1;
            let mut moved = start.clone();
            moved[k] += h;
            let there = end(&pass(&moved)?, &moved);
            for (i, &row) in states.iter().enumerate() {
                matrix[i][j] = f64::from(u8::from(i == j)) - (there[row] - reached[row]) / h;
            }
        }
        let step = solve(matrix, gap.clone()).unwrap_or_else(|| gap.clone());
        let bold = states.iter().zip(&step).all(|(&k, d)| (start[k] + d).is_finite() && start[k] + d > 150.0);
        states.iter().zip(if bold { &step } else { &gap }).for_each(|(&k, d)| start[k] += d);
        runs = pass(&start)?;
        passes += 1;
    }
    let period: f64 = segments.iter().map(|s| s.duration).sum();
    let mean = runs.iter().zip(segments).map(|(r, s)| r.mean_oil * s.duration).sum::<f64>() / period;
    Ok(PeriodicDuty {
        highest: runs.iter().map(|r| r.oil_range[1]).fold(f64::NEG_INFINITY, f64::max),
        lowest: runs.iter().map(|r| r.oil_range[0]).fold(f64::INFINITY, f64::min),
        mean,
        passes,
        left,
        runs,
    })
}

/// Time constants around temperatures at which heats are in balance, s, the slowest first: the inverse of the eigenvalues
/// of `C⁻¹ (slopes of the flows − slopes of the heats)`. One place: `τ = C/(UA − P′)`. A negative one runs away.
///
/// `slopes` are those of the heat made at each place by the oil temperature, W/K. Empty where nothing stores heat.
pub fn time_constants(heat: &Heat, temperatures: &[f64], slopes: &[f64]) -> Vec<f64> {
    let states: Vec<usize> = (0..heat.nodes.len()).filter(|k| heat.nodes[*k].capacity > 0.0).collect();
    let massless: Vec<usize> =
        (0..heat.nodes.len()).filter(|k| heat.nodes[*k].capacity == 0.0 && heat.nodes[*k].fixed.is_none()).collect();
    if !states.contains(&OIL) {
        return vec![];
    }
    let (mut matrix, _) = heat.slopes(temperatures, &vec![0.0; heat.nodes.len()]);
    for (k, slope) in slopes.iter().enumerate() {
        matrix[k][OIL] -= slope;
    }
    // What follows at once is eliminated.
    for &m in &massless {
        let pivot = matrix[m][m];
        for i in 0..heat.nodes.len() {
            let factor = matrix[i][m] / pivot;
            if i != m && factor != 0.0 {
                for j in 0..heat.nodes.len() {
                    let above = matrix[m][j];
                    matrix[i][j] -= factor * above;
                }
            }
        }
    }
    let n = states.len();
    let rates = DMatrix::from_fn(n, n, |i, j| matrix[states[i]][states[j]] / heat.nodes[states[i]].capacity);
    let Some(schur) = Schur::try_new(rates, f64::EPSILON, 10_000) else { return vec![] };
    let mut all: Vec<f64> = schur.complex_eigenvalues().iter().map(|l| 1.0 / l.re).collect();
    all.sort_by(|a, b| b.abs().total_cmp(&a.abs()));
    all
}

/// Nodes, coefficients and error weights of the pair.
const A: [&[f64]; 7] = [
    &[],
    &[1.0 / 5.0],
    &[3.0 / 40.0, 9.0 / 40.0],
    &[44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0],
    &[19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0],
    &[9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0],
    &[35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339200.0, 22.0 / 525.0, -1.0 / 40.0];

struct Integration<'a, S: ?Sized> {
    heat: &'a Heat,
    source: &'a S,
    tolerance: f64,
}

/// Rates of change: of each place that stores heat, K/s; of the heats made and carried, W; of the oil's integral, K.
struct Rates {
    temperatures: Vec<f64>,
    state: Vec<f64>,
    made: f64,
}

impl<S: Source + ?Sized> Integration<'_, S> {
    fn rates(&self, state: &[f64], states: &[usize]) -> Result<Rates, Failed<S::Error>> {
        let heat = self.heat;
        let mut known: Vec<Option<f64>> = heat.nodes.iter().map(|n| n.fixed).collect();
        states.iter().zip(state).for_each(|(&k, t)| known[k] = Some(*t));
        let made = self.source.heat(state[0]).map_err(Failed::Source)?;
        if !made.iter().chain(state).all(|x| x.is_finite()) {
            return Err(Unsolved.into());
        }
        let temperatures = heat.temperatures(&known, &made)?;
        let left = imbalance(heat, &temperatures, &made);
        let mut rates: Vec<f64> = states.iter().map(|&k| -left[k] / heat.nodes[k].capacity).collect();
        // What is left at places without capacity is round-off, and leaves with the rest.
        let made: f64 = made.iter().sum::<f64>() + heat.extra_heat;
        let stored: f64 = states.iter().map(|&k| -left[k]).sum();
        rates.extend([made, made - stored, temperatures[OIL]]);
        Ok(Rates { temperatures, state: rates, made })
    }

    fn run(&self, start: &[f64], times: &[f64]) -> Result<Run, Failed<S::Error>> {
        let heat = self.heat;
        let states: Vec<usize> = (0..heat.nodes.len()).filter(|k| heat.nodes[*k].capacity > 0.0).collect();
        if states.first() != Some(&OIL) {
            return Err(Unsolved.into());
        }
        let n = states.len();
        let mut y: Vec<f64> = states.iter().map(|&k| start[k]).chain([0.0; 3]).collect();
        let from: Vec<f64> = y.clone();
        let mut time = times.first().copied().unwrap_or(0.0);
        let begin = time;
        let mut first = self.rates(&y[..n], &states)?;
        let mut rows = vec![Row { time, temperatures: first.temperatures.clone(), made: first.made }];
        let mut range = [y[0], y[0]];
        let mut step = {
            let fastest = (0..n).map(|k| first.state[k].abs()).fold(0.0f64, f64::max);
            let span = times.last().map_or(0.0, |t| t - begin);
            (span * 1e-3).min(if fastest > 0.0 { 0.1 / fastest } else { f64::INFINITY }).max(span * 1e-12)
        };
        let mut steps = 0;
        // The first of them is the start, where it already stands.
        for &until in times.iter().skip(1) {
            while time < until {
                if steps == MOST_STEPS {
                    return Err(Unsolved.into());
                }
                steps += 1;
                let last = time + step >= until * (1.0 - 1e-15);
                let h = if last { until - time } else { step };
                let mut k: Vec<Vec<f64>> = vec![first.state.clone()];
                let mut end = None;
                for row in &A[1..] {
                    let at: Vec<f64> =
                        (0..n + 3).map(|j| y[j] + h * row.iter().zip(&k).map(|(a, k)| a * k[j]).sum::<f64>()).collect();
                    let rates = self.rates(&at[..n], &states)?;
                    k.push(rates.state.clone());
                    end = Some((at, rates));
                }
                let (next, rates) = end.expect("seven stages");
                let error = (0..n)
                    .map(|j| {
                        let e = h * ERROR.iter().zip(&k).map(|(e, k)| e * k[j]).sum::<f64>();
                        let scale = (next[j] - from[j]).abs().max((y[j] - from[j]).abs()).max(1.0);
                        (e / (self.tolerance * scale)).abs()
                    })
                    .fold(0.0f64, f64::max);
                // A step below what the time can tell is taken: the law jumps here.
                if error > 1.0 && h > 1e-12 * until.abs().max(1e-3) {
                    step = h * (0.9 * error.powf(-0.2)).max(0.1);
                    continue;
                }
                (time, y, first) = (if last { until } else { time + h }, next, rates);
                range = [range[0].min(y[0]), range[1].max(y[0])];
                let wanted = h * (0.9 * error.max(1e-10).powf(-0.2)).min(5.0);
                step = if last { step.max(wanted) } else { wanted };
            }
            rows.push(Row { time, temperatures: first.temperatures.clone(), made: first.made });
        }
        let stored = states.iter().enumerate().map(|(j, &k)| heat.nodes[k].capacity * (y[j] - from[j])).sum();
        let span = time - begin;
        Ok(Run {
            rows,
            end: first.temperatures,
            made: y[n],
            carried: y[n + 1],
            stored,
            mean_oil: if span > 0.0 { y[n + 2] / span } else { y[0] },
            oil_range: range,
            steps,
        })
    }
}
