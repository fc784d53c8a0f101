//! Compiled trains over whole arrays.

use numpy::{Element, PyArray1, PyArrayMethods, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use willis::compiled::{self, BatchInputs, CompiledOutput, CompiledTrain, PowerLoss, ShaftDrag, Workspace};
use willis::train::Train;

use crate::refused::wrong;

/// What is prescribed at every point, and what is wanted, as the package says it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct CompileArguments {
    state: Option<String>,
    fixed: Vec<String>,
    speeds: Vec<String>,
    torques: Vec<String>,
    /// Member, part that does not depend on speed, part that grows with it.
    drag: Vec<(String, f64, f64)>,
    /// Mesh or set; coefficient, exponent, torque, speed, ceiling.
    losses: Vec<(String, f64, f64, f64, f64, f64)>,
    /// Kind and name: `torque`, `ring`.
    outputs: Vec<(String, String)>,
}

/// A train ready for many points.
#[pyclass(frozen, module = "willis._willis")]
pub struct Compiled {
    train: CompiledTrain,
    speeds: usize,
    torques: usize,
}

/// Points that one thread does at a time, where an input is the same at all of them.
const BLOCK: usize = 1 << 15;

impl Compiled {
    pub fn new(py: Python<'_>, train: &Train, duty: CompileArguments) -> PyResult<Self> {
        let mut own = compiled::CompileRequest::new(
            duty.speeds.iter().map(String::as_str),
            duty.torques.iter().map(String::as_str),
        );
        if let Some(state) = &duty.state {
            own = own.state(state);
        }
        for member in &duty.fixed {
            own = own.fixed(member);
        }
        for (member, coulomb, viscous) in &duty.drag {
            own = own.drag(member, ShaftDrag { coulomb: *coulomb, viscous: *viscous });
        }
        for (name, coefficient, exponent, torque, speed, most) in &duty.losses {
            let (coefficient, exponent, torque, speed, most) = (*coefficient, *exponent, *torque, *speed, *most);
            own = own.mesh_loss(name, PowerLoss { coefficient, exponent, torque, speed, most });
        }
        for (kind, name) in duty.outputs {
            own = own.output(match kind.as_str() {
                "speed" => CompiledOutput::Speed(name),
                // What is no mesh and no shift element is refused as a member.
                "torque" if train.member(&name).is_some() => CompiledOutput::Torque(name),
                "torque" if train.mesh(&name).is_some() => CompiledOutput::MeshTorque(name),
                "torque" if train.shift_elements().iter().any(|e| e.name == name) => {
                    CompiledOutput::ShiftElementTorque(name)
                }
                "torque" => CompiledOutput::Torque(name),
                "loss" => CompiledOutput::Loss,
                _ => CompiledOutput::Efficiency,
            });
        }
        let (speeds, torques) = (duty.speeds.len(), duty.torques.len());
        let train = py.detach(|| train.compile(&own)).map_err(|w| wrong(py, w))?;
        Ok(Self { train, speeds, torques })
    }
}

/// Points from `at` on, of inputs that are as long as all points or of length one.
fn block<'a>(inputs: &[&'a [f64]], constant: &'a [Vec<f64>], at: usize, len: usize) -> Vec<&'a [f64]> {
    let of = |(x, c): (&&'a [f64], &'a Vec<f64>)| if c.is_empty() { &x[at..at + len] } else { &c[..len] };
    inputs.iter().zip(constant).map(of).collect()
}

#[pymethods]
impl Compiled {
    #[getter]
    fn is_certified(&self) -> bool {
        self.train.is_certified()
    }

    /// Results at all points, an array each, and at how many points there is not one answer. An input of length one is the
    /// same at all points.
    fn evaluate<'py>(
        &self,
        py: Python<'py>,
        inputs: Vec<PyReadonlyArray1<'py, f64>>,
        points: usize,
        threads: usize,
    ) -> PyResult<(Vec<Bound<'py, PyArray1<f64>>>, usize)> {
        self.stored(py, &inputs, points, threads)
    }

    /// The same, rounded to single precision.
    fn evaluate_f32<'py>(
        &self,
        py: Python<'py>,
        inputs: Vec<PyReadonlyArray1<'py, f64>>,
        points: usize,
        threads: usize,
    ) -> PyResult<(Vec<Bound<'py, PyArray1<f32>>>, usize)> {
        self.stored(py, &inputs, points, threads)
    }

    /// The sum of each result over all points, nothing stored, and at how many points there is not one answer.
    fn sum(
        &self,
        py: Python<'_>,
        inputs: Vec<PyReadonlyArray1<'_, f64>>,
        points: usize,
    ) -> PyResult<(Vec<f64>, usize)> {
        let slices = self.slices(&inputs, points)?;
        Ok(py.detach(|| {
            let constant = constants(&slices, points);
            let mut room = self.train.workspace();
            let (mut sums, mut part, mut odd, mut at) = (vec![0.0; self.train.outputs()], vec![], 0, 0);
            while at < points {
                let len = BLOCK.min(points - at);
                let own = block(&slices, &constant, at, len);
                let (speeds, torques) = own.split_at(self.speeds);
                part.resize(sums.len(), 0.0);
                odd += self.train.sum_batch(&BatchInputs { speeds, torques }, &mut room, &mut part);
                sums.iter_mut().zip(&part).for_each(|(s, p)| *s += p);
                at += len;
            }
            (sums, odd)
        }))
    }
}

/// Blocks of the inputs that are the same at all points; empty for the others.
fn constants(slices: &[&[f64]], points: usize) -> Vec<Vec<f64>> {
    let of = |s: &&[f64]| if s.len() == points { vec![] } else { vec![s[0]; BLOCK.min(points)] };
    slices.iter().map(of).collect()
}

/// A number of the results.
trait Stored: Element + Send {
    fn fill(train: &CompiledTrain, points: &BatchInputs<'_>, room: &mut Workspace, out: &mut [&mut [Self]]) -> usize
    where
        Self: Sized;
}

impl Stored for f64 {
    fn fill(train: &CompiledTrain, points: &BatchInputs<'_>, room: &mut Workspace, out: &mut [&mut [f64]]) -> usize {
        train.evaluate_batch(points, room, out)
    }
}

impl Stored for f32 {
    fn fill(train: &CompiledTrain, points: &BatchInputs<'_>, room: &mut Workspace, out: &mut [&mut [f32]]) -> usize {
        train.evaluate_batch_f32(points, room, out)
    }
}

impl Compiled {
    /// Results at all points, the points shared out among threads.
    fn stored<'py, T: Stored>(
        &self,
        py: Python<'py>,
        inputs: &[PyReadonlyArray1<'py, f64>],
        points: usize,
        threads: usize,
    ) -> PyResult<(Vec<Bound<'py, PyArray1<T>>>, usize)> {
        let slices = self.slices(inputs, points)?;
        let arrays: Vec<_> = (0..self.train.outputs()).map(|_| PyArray1::<T>::zeros(py, points, false)).collect();
        let mut writable: Vec<_> = arrays.iter().map(|a| a.readwrite()).collect();
        let mut out: Vec<&mut [T]> =
            writable.iter_mut().map(|w| w.as_slice_mut().map_err(PyErr::from)).collect::<PyResult<_>>()?;
        let odd = py.detach(|| {
            let constant = constants(&slices, points);
            let each = points.div_ceil(threads.max(1)).max(1);
            let whole = constant.iter().all(Vec::is_empty);
            std::thread::scope(|scope| {
                let mut at = 0;
                let mut parts = vec![];
                while at < points {
                    let len = each.min(points - at);
                    let mut own = Vec::with_capacity(out.len());
                    for o in &mut out {
                        let (head, tail) = std::mem::take(o).split_at_mut(len);
                        own.push(head);
                        *o = tail;
                    }
                    let (slices, constant) = (&slices, &constant);
                    let job = move || self.part(slices, constant, at, if whole { len.max(1) } else { BLOCK }, own);
                    if at + len >= points {
                        return job()
                            + parts
                                .into_iter()
                                .map(|p: std::thread::ScopedJoinHandle<'_, usize>| p.join().unwrap_or(0))
                                .sum::<usize>();
                    }
                    parts.push(scope.spawn(job));
                    at += len;
                }
                0
            })
        });
        drop(out);
        drop(writable);
        Ok((arrays, odd))
    }

    fn slices<'a>(&self, inputs: &'a [PyReadonlyArray1<'_, f64>], points: usize) -> PyResult<Vec<&'a [f64]>> {
        if inputs.len() != self.speeds + self.torques {
            return Err(PyValueError::new_err("as many inputs as there are speeds and torques"));
        }
        let slices: Vec<&[f64]> = inputs.iter().map(|a| a.as_slice().map_err(PyErr::from)).collect::<PyResult<_>>()?;
        match slices.iter().all(|s| s.len() == points || s.len() == 1) {
            true => Ok(slices),
            false => Err(PyValueError::new_err("inputs as long as there are points, or of length one")),
        }
    }

    /// One thread's part.
    fn part<T: Stored>(
        &self,
        slices: &[&[f64]],
        constant: &[Vec<f64>],
        from: usize,
        size: usize,
        mut out: Vec<&mut [T]>,
    ) -> usize {
        let mut room = self.train.workspace();
        let (mut odd, mut at) = (0, from);
        loop {
            let left = out.first().map_or(0, |o| o.len());
            if left == 0 {
                return odd;
            }
            let len = size.min(left);
            let mut own = Vec::with_capacity(out.len());
            for o in &mut out {
                let (head, tail) = std::mem::take(o).split_at_mut(len);
                own.push(head);
                *o = tail;
            }
            let inputs = block(slices, constant, at, len);
            let (speeds, torques) = inputs.split_at(self.speeds);
            odd += T::fill(&self.train, &BatchInputs { speeds, torques }, &mut room, &mut own);
            at += len;
        }
    }
}
