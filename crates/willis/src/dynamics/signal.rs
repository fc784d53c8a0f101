//! Values over time, piece by piece.
//!
//! A signal is smooth between its breaks. Within a piece its formula is evaluated as if it went on, so that
//! an integrator that touches the end of the piece sees the value before a jump: `inside` is a time
//! inside the piece that says which one it is.

use crate::train::{MemberId, Signal};

impl Signal {
    /// A formula in it that has no finite value at `t` in the piece that holds `inside`, and what it has instead.
    pub(crate) fn not_finite(&self, t: f64, inside: f64, speed: &dyn Fn(MemberId) -> f64) -> Option<(&str, f64)> {
        match self {
            Self::Product(of) => of.iter().find_map(|s| s.not_finite(t, inside, speed)),
            Self::Expression { formula, .. } => {
                let value = self.value(t, inside, speed);
                (!value.is_finite()).then(|| (formula.text(), value))
            }
            _ => None,
        }
    }

    /// Value at `t` in the piece that holds `inside`; `speed` tells the speed of a member.
    pub(crate) fn value(&self, t: f64, inside: f64, speed: &dyn Fn(MemberId) -> f64) -> f64 {
        match self {
            Self::Constant(x) => *x,
            Self::Step { offset, height, at } => offset + if inside >= *at { *height } else { 0.0 },
            Self::Ramp { offset, height, at, duration } => {
                if inside < *at {
                    *offset
                } else if inside < at + duration {
                    offset + height * (t - at) / duration
                } else {
                    offset + height
                }
            }
            Self::Sine { offset, amplitude, frequency, phase, at, decay } => {
                if inside < *at {
                    *offset
                } else {
                    let since = t - at;
                    let swing = amplitude * (std::f64::consts::TAU * frequency * since + phase).sin();
                    offset + if *decay == 0.0 { swing } else { swing * (-decay * since).exp() }
                }
            }
            Self::Pulse { offset, amplitude, period, width, at } => {
                let phase = (inside - at) / period;
                offset + if phase >= 0.0 && phase - phase.floor() < *width { *amplitude } else { 0.0 }
            }
            Self::Table { points, hold } => match segment(points, inside) {
                Segment::Before => points[0][1],
                Segment::After => points[points.len() - 1][1],
                Segment::Between(k) if *hold => points[k][1],
                Segment::Between(k) => {
                    let ([t0, y0], [t1, y1]) = (points[k], points[k + 1]);
                    y0 + (y1 - y0) * (t - t0) / (t1 - t0)
                }
            },
            Self::Product(of) => of[0].value(t, inside, speed) * of[1].value(t, inside, speed),
            Self::Expression { formula, speeds } => {
                expression(speeds, speed, |speeds| formula.value_within(t, inside, speeds))
            }
        }
    }

    /// Whether its value changes within the piece that holds `inside`.
    pub(crate) fn moves(&self, inside: f64) -> bool {
        match self {
            Self::Constant(_) | Self::Step { .. } | Self::Pulse { .. } => false,
            Self::Ramp { at, duration, .. } => inside >= *at && inside < at + duration,
            Self::Sine { at, .. } => inside >= *at,
            Self::Table { points, hold } => match segment(points, inside) {
                Segment::Between(k) => !hold && points[k][1] != points[k + 1][1],
                Segment::Before | Segment::After => false,
            },
            Self::Product(of) => of.iter().any(|s| s.moves(inside)),
            Self::Expression { .. } => true,
        }
    }

    /// Whether its rate tells how it moves; that of a formula with jumps does not.
    pub(crate) fn has_rate(&self) -> bool {
        match self {
            Self::Expression { formula, .. } => !formula.jumps(),
            Self::Product(of) => of.iter().all(|s| s.has_rate()),
            _ => true,
        }
    }

    /// Whether speeds enter its value.
    pub(crate) fn depends_on_speed(&self) -> bool {
        match self {
            Self::Expression { speeds, .. } => !speeds.is_empty(),
            Self::Product(of) => of.iter().any(|s| s.depends_on_speed()),
            _ => false,
        }
    }

    /// Rate of change in time at `t`, speeds held, in the piece that holds `inside`.
    pub(crate) fn rate(&self, t: f64, inside: f64, speed: &dyn Fn(MemberId) -> f64) -> f64 {
        match self {
            Self::Constant(_) | Self::Step { .. } | Self::Pulse { .. } => 0.0,
            Self::Ramp { height, at, duration, .. } => {
                if inside >= *at && inside < at + duration {
                    height / duration
                } else {
                    0.0
                }
            }
            Self::Sine { amplitude, frequency, phase, at, decay, .. } => {
                if inside < *at {
                    return 0.0;
                }
                let (since, w) = (t - at, std::f64::consts::TAU * frequency);
                let (s, c) = (w * since + phase).sin_cos();
                amplitude * (-decay * since).exp() * (w * c - decay * s)
            }
            Self::Table { points, hold } => match segment(points, inside) {
                Segment::Between(k) if !hold => (points[k + 1][1] - points[k][1]) / (points[k + 1][0] - points[k][0]),
                _ => 0.0,
            },
            Self::Product(of) => {
                of[0].rate(t, inside, speed) * of[1].value(t, inside, speed)
                    + of[0].value(t, inside, speed) * of[1].rate(t, inside, speed)
            }
            Self::Expression { formula, speeds } => expression(speeds, speed, |speeds| formula.rate(t, inside, speeds)),
        }
    }

    /// The first time after `t` at which it is not smooth.
    pub(crate) fn next_break(&self, t: f64) -> f64 {
        let first = |times: &[f64]| times.iter().copied().filter(|&b| b > t).fold(f64::INFINITY, f64::min);
        match self {
            Self::Constant(_) => f64::INFINITY,
            Self::Expression { formula, .. } => formula.next_jump(t),
            Self::Step { at, .. } | Self::Sine { at, .. } => first(&[*at]),
            Self::Ramp { at, duration, .. } => first(&[*at, at + duration]),
            Self::Pulse { period, width, at, .. } => {
                let k = ((t - at) / period).floor().max(0.0);
                let edge = |n: f64| [at + n * period, at + (n + width) * period];
                first([edge(k), edge(k + 1.0)].as_flattened())
            }
            Self::Table { points, .. } => {
                let k = points.partition_point(|p| p[0] <= t);
                points.get(k).map_or(f64::INFINITY, |p| p[0])
            }
            Self::Product(of) => of[0].next_break(t).min(of[1].next_break(t)),
        }
    }

    /// The longest step from `t` that sees what it does within the piece that holds `inside`, s: a sixth of the period of
    /// a sine, over which the integrator makes an error of about 1e-6, and an eighth of what a formula waves, which may be
    /// more than one sine. A formula tells of itself how quickly its waves turn; beside that it is looked at as often as
    /// `most`, s, asks.
    pub(crate) fn longest_step(&self, t: f64, inside: f64, most: f64, speed: &dyn Fn(MemberId) -> f64) -> f64 {
        const SIXTH: f64 = 1.0 / 6.0;
        const PART: f64 = 0.125;
        match self {
            Self::Sine { frequency, at, .. } if inside >= *at => SIXTH / frequency.abs(),
            // The product of two sines turns as quickly as both together.
            Self::Product(of) => {
                let each = of.each_ref().map(|signal| signal.longest_step(t, inside, most, speed));
                1.0 / (1.0 / each[0] + 1.0 / each[1])
            }
            Self::Expression { formula, speeds } => expression(speeds, speed, |speeds| {
                let mut step = most;
                while formula.turns(t, t + step, speeds) > PART && t + step > t {
                    step *= 0.5;
                }
                step
            }),
            _ => f64::INFINITY,
        }
    }

    /// Whether that step is another one at every time.
    pub(crate) fn waves(&self) -> bool {
        match self {
            Self::Expression { formula, .. } => formula.waves(),
            Self::Product(of) => of.iter().any(Self::waves),
            _ => false,
        }
    }

    /// Whether it may become zero at a time that is not known beforehand.
    pub(crate) fn crosses_unannounced(&self) -> bool {
        match self {
            Self::Constant(_) | Self::Step { .. } | Self::Pulse { .. } => false,
            Self::Table { hold, .. } => !hold,
            Self::Product(of) => of.iter().any(Self::crosses_unannounced),
            Self::Ramp { .. } | Self::Sine { .. } | Self::Expression { .. } => true,
        }
    }
}

/// What a formula says at the speeds of its members.
fn expression(speeds: &[MemberId], speed: &dyn Fn(MemberId) -> f64, say: impl Fn(&[f64]) -> f64) -> f64 {
    const FEW: usize = 8;
    if speeds.len() <= FEW {
        let mut few = [0.0; FEW];
        few.iter_mut().zip(speeds).for_each(|(x, m)| *x = speed(*m));
        return say(&few[..speeds.len()]);
    }
    let all: Vec<f64> = speeds.iter().map(|m| speed(*m)).collect();
    say(&all)
}

enum Segment {
    Before,
    Between(usize),
    After,
}

/// Where a time lies among points; of several points of one time the last counts.
fn segment(points: &[[f64; 2]], t: f64) -> Segment {
    match points.partition_point(|p| p[0] <= t) {
        0 => Segment::Before,
        k if k == points.len() => Segment::After,
        k => Segment::Between(k - 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(s: &Signal, t: f64, inside: f64) -> f64 {
        s.value(t, inside, &|_| 0.0)
    }

    #[test]
    fn regress_a_piece_goes_on_to_its_end() {
        let step = Signal::Step { offset: 1.0, height: 2.0, at: 0.5 };
        assert_eq!((at(&step, 0.5, 0.2), at(&step, 0.5, 0.7)), (1.0, 3.0));
        let ramp = Signal::Ramp { offset: 0.0, height: 5.0, at: 1.0, duration: 2.0 };
        assert_eq!((at(&ramp, 3.0, 2.0), at(&ramp, 3.0, 4.0), ramp.rate(2.0, 2.0, &|_| 0.0)), (5.0, 5.0, 2.5));
        let pulse = Signal::Pulse { offset: 0.0, amplitude: 1.0, period: 2.0, width: 0.25, at: 1.0 };
        assert_eq!([0.5, 1.1, 1.6, 3.2].map(|t| at(&pulse, t, t)), [0.0, 1.0, 0.0, 1.0]);
        assert_eq!([0.0, 1.0, 1.5, 3.0].map(|t| pulse.next_break(t)), [1.0, 1.5, 3.0, 3.5]);
        let jump = Signal::Table { points: vec![[0.0, 0.0], [1.0, 1.0], [1.0, 3.0], [2.0, 3.0]], hold: false };
        assert_eq!((at(&jump, 1.0, 0.5), at(&jump, 1.0, 1.5), jump.next_break(0.5)), (1.0, 3.0, 1.0));
    }
}
