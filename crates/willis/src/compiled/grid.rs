//! Points that form a grid: their inputs are made where they are used, and never stored.

use std::ops::Range;

use super::parts::MOST_FEATURES;

/// Inputs of a batch whose points form a grid: every combination of the values of each input.
///
/// Points are numbered from 0 in row-major order: the last input runs fastest, where inputs are the speeds and then the
/// torques. [`GridInputs::nested`] chooses another order. The results are those of
/// [`evaluate_batch`](super::CompiledTrain::evaluate_batch) on the arrays that a grid stands for, to the last bit; a row
/// of a power split along which only the torque varies takes about a third of the time.
///
/// # Example
/// ```
/// use willis::compiled::{CompileRequest, CompiledOutput, GridInputs};
/// use willis::train::{SetSpec, Train};
///
/// let train = Train::builder("power split")
///     .members(["sun", "ring", "carrier"])
///     .terminals(["sun", "ring", "carrier"])
///     .set(SetSpec::simple("P1", ("sun", 30), ("ring", 70), "carrier").mesh_efficiency(0.99))
///     .build()?;
/// let request = CompileRequest::new(["sun", "carrier"], ["sun"]).output(CompiledOutput::Torque("ring".into()));
/// let compiled = train.compile(&request)?;
/// let mut work = compiled.workspace();
/// // Two speeds of the sun, one of the carrier, three torques: six points.
/// let grid = GridInputs::new(&[&[300.0, 400.0], &[100.0]], &[&[10.0, 20.0, 30.0]]);
/// let mut out = [0.0; 6];
/// compiled.evaluate_grid(&grid, 0..grid.len(), &mut work, &mut [&mut out]);
/// // The sun drives: T_r = i0 η T_s, i0 = 7/3.
/// assert!((out[4] - 7.0 / 3.0 * 0.9801 * 20.0).abs() < 1e-12);
///
/// // Nothing is stored.
/// let mut ring = [Default::default()];
/// compiled.summarize_grid(&grid, 0..grid.len(), &mut work, &mut ring);
/// assert_eq!(ring[0].max.map(|max| (max.value, max.point)), Some((out[2], 2)));
/// # Ok::<(), willis::diagnostic::Diagnostics>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct GridInputs<'a> {
    /// The values of each prescribed speed, rad/s; one value where it is the same at all points.
    pub speeds: &'a [&'a [f64]],
    /// The values of each prescribed torque, N m; one value where it is the same at all points.
    pub torques: &'a [&'a [f64]],
    /// The inputs (speeds, then torques) from the slowest to the fastest; empty for that order itself.
    order: &'a [usize],
}

impl<'a> GridInputs<'a> {
    /// A grid in row-major order: the last torque runs fastest.
    pub fn new(speeds: &'a [&'a [f64]], torques: &'a [&'a [f64]]) -> Self {
        Self { speeds, torques, order: &[] }
    }

    /// The same grid in another order: numbers of the inputs (speeds, then torques) from the slowest to the fastest.
    ///
    /// # Panics
    /// If `order` does not name every input once.
    #[must_use]
    pub fn nested(self, order: &'a [usize]) -> Self {
        let inputs = self.speeds.len() + self.torques.len();
        let named = |k: usize| order.contains(&k);
        assert!(order.len() == inputs && (0..inputs).all(named), "every input once");
        Self { order, ..self }
    }

    /// How many points: the product of the numbers of values.
    pub fn len(&self) -> usize {
        self.speeds.iter().chain(self.torques).fold(1, |n, values| n.saturating_mul(values.len()))
    }

    /// Whether an input has no value.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub(crate) fn layout(&self, speeds: usize, torques: usize) -> Layout<'a> {
        assert_eq!((self.speeds.len(), self.torques.len()), (speeds, torques), "inputs as the request names them");
        let inputs = speeds + torques;
        let (values, stride) = ([&[][..]; MOST_FEATURES], [1; MOST_FEATURES]);
        let mut layout = Layout { values, stride, inputs, torque_runs: false, is_tiny: false };
        layout.values.iter_mut().zip(self.speeds.iter().chain(self.torques)).for_each(|(to, values)| *to = values);
        let mut stride = 1;
        for at in (0..inputs).rev() {
            let input = if self.order.is_empty() { at } else { self.order[at] };
            layout.stride[input] = stride;
            stride = usize::saturating_mul(stride, layout.values[input].len());
        }
        layout.torque_runs = torques == 1 && layout.is_row(speeds);
        layout.is_tiny = layout.values.iter().any(|values| values.iter().any(|x| x.is_subnormal()));
        layout
    }
}

/// A grid ready to be filled in: for each input its values and from how many points to the next of them.
pub(crate) struct Layout<'a> {
    values: [&'a [f64]; MOST_FEATURES],
    stride: [usize; MOST_FEATURES],
    inputs: usize,
    /// Whether the only torque runs up or down along rows at whose points the speeds stay.
    pub torque_runs: bool,
    /// Whether a value is too small for all digits of floating point.
    pub is_tiny: bool,
}

impl<'a> Layout<'a> {
    fn position(&self, input: usize, point: usize) -> usize {
        point / self.stride[input] % self.values[input].len()
    }

    /// The values of an input at some points.
    pub fn fill(&self, input: usize, points: Range<usize>, out: &mut [f64]) {
        let (values, stride) = (self.values[input], self.stride[input]);
        if let [value] = values {
            return out[..points.len()].fill(*value);
        }
        let mut point = points.start;
        let mut out = &mut out[..points.len()];
        while !out.is_empty() {
            let k = self.position(input, point);
            let run = if stride == 1 { values.len() - k } else { stride - point % stride };
            let (now, later) = std::mem::take(&mut out).split_at_mut(run.min(points.end - point));
            match stride {
                1 => now.copy_from_slice(&values[k..k + now.len()]),
                _ => now.fill(values[k]),
            }
            point += now.len();
            out = later;
        }
    }

    /// Whether this input is the fastest, and its values run up or down.
    fn is_row(&self, input: usize) -> bool {
        let values = self.values[input];
        let fastest = (0..self.inputs).all(|k| k == input || self.values[k].len() == 1 || self.stride[k] > 1);
        let sorted = values.is_sorted_by(|a, b| a <= b) || values.is_sorted_by(|a, b| a >= b);
        values.len() > 1 && fastest && sorted
    }

    /// All values of an input.
    pub fn row(&self, input: usize) -> &'a [f64] {
        self.values[input]
    }

    /// The values of the fastest input from a point on.
    pub fn rest_of_row(&self, input: usize, point: usize) -> &'a [f64] {
        &self.values[input][self.position(input, point)..]
    }

    /// An input at a point, to go on from.
    pub fn counter(&self, input: usize, point: usize) -> Counter<'a> {
        let stride = self.stride[input];
        let at = self.position(input, point);
        Counter { values: self.values[input], at, stride, left: stride - point % stride }
    }
}

/// An input along the points of a grid: counted, because divisions would take as long as the points of a short row.
pub(crate) struct Counter<'a> {
    values: &'a [f64],
    at: usize,
    stride: usize,
    /// Points to the next value.
    left: usize,
}

impl Counter<'_> {
    /// The value where it stands.
    pub fn value(&self) -> f64 {
        self.values[self.at]
    }

    /// Goes on by points that all have this value.
    pub fn advance(&mut self, points: usize) {
        self.left -= points;
        if self.left == 0 {
            self.at = if self.at + 1 == self.values.len() { 0 } else { self.at + 1 };
            self.left = self.stride;
        }
    }
}

/// What an output is over many points, with none of them stored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct OutputSummary {
    /// The sum over all points; not a number where a point has no result. 2048 points at a time are added in 32 partial
    /// sums, point k to that of k modulo 32.
    pub sum: f64,
    /// The smallest result, and the first point that has it; nothing where no point has a result.
    pub min: Option<PointValue>,
    /// The largest result, and the first point that has it.
    pub max: Option<PointValue>,
}

/// A result and its point.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct PointValue {
    /// The result.
    pub value: f64,
    /// The number of the point: in the arrays, or in the grid.
    pub point: usize,
}
