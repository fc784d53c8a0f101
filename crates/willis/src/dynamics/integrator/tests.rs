use allocation_counter::measure;

use super::{Dopri5, Implicit, Smooth, StepError, Stepper};

/// A system from a closure.
struct Closure<F> {
    states: usize,
    quadratures: usize,
    scale: f64,
    rate: F,
}

impl<F: FnMut(f64, &[f64], &mut [f64])> Smooth for Closure<F> {
    fn states(&self) -> usize {
        self.states
    }
    fn quadratures(&self) -> usize {
        self.quadratures
    }
    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]) {
        (self.rate)(t, x, rate);
    }
    fn scale(&self, _: usize) -> f64 {
        self.scale
    }
}

fn system<F: FnMut(f64, &[f64], &mut [f64])>(states: usize, quadratures: usize, rate: F) -> Closure<F> {
    Closure { states, quadratures, scale: 1.0, rate }
}

/// Runs to the end; the largest error of state and dense output against `exact`.
fn run<M: Stepper, S: Smooth>(
    sys: &mut S,
    x: &[f64],
    [start, end]: [f64; 2],
    tolerance: f64,
    exact: impl Fn(f64, usize) -> f64,
) -> (M, f64, f64) {
    let mut method = M::new(sys.states(), sys.quadratures());
    method.restart(sys, start, x, tolerance, end, None);
    let (mut at_steps, mut between) = (0.0_f64, 0.0_f64);
    let mut out = vec![0.0; x.len()];
    while method.t() < end {
        method.step(sys, end).unwrap();
        for k in 0..sys.states() {
            at_steps = at_steps.max((method.x()[k] - exact(method.t(), k)).abs());
        }
        for i in 0..=10 {
            let t = method.t_old() + (method.t() - method.t_old()) * f64::from(i) / 10.0;
            method.interpolate(t, &mut out);
            for k in 0..sys.states() {
                between = between.max((out[k] - exact(t, k)).abs());
            }
        }
    }
    assert_eq!(method.t(), end);
    (method, at_steps, between)
}

/// x'' = −x as a first-order system.
fn oscillator() -> Closure<impl FnMut(f64, &[f64], &mut [f64])> {
    system(2, 0, |_, x: &[f64], r: &mut [f64]| (r[0], r[1]) = (x[1], -x[0]))
}

fn circle(t: f64, k: usize) -> f64 {
    if k == 0 { t.cos() } else { -t.sin() }
}

#[test]
fn the_oscillator_keeps_the_tolerance() {
    for (tolerance, most) in [(1e-6, 90), (1e-9, 350), (1e-12, 1400)] {
        let (m, at_steps, between) = run::<Dopri5, _>(&mut oscillator(), &[1.0, 0.0], [0.0, 20.0], tolerance, circle);
        assert!(at_steps < 20.0 * tolerance && between < 10.0 * tolerance, "{tolerance}: {at_steps:e} {between:e}");
        assert!(m.counts().steps < most && m.counts().rejected < 10, "{:?}", m.counts());
        assert!(!m.is_stiff());
    }
    for (tolerance, most) in [(1e-4, 100), (1e-6, 300), (1e-9, 1500)] {
        let (m, at_steps, between) = run::<Implicit, _>(&mut oscillator(), &[1.0, 0.0], [0.0, 20.0], tolerance, circle);
        assert!(at_steps < 5.0 * tolerance && between < 20.0 * tolerance, "{tolerance}: {at_steps:e} {between:e}");
        assert!(m.counts().steps < most && m.counts().rejected < 10, "{:?}", m.counts());
    }
}

/// x' = −2t x², x(0) = 1: x = 1/(1 + t²).
#[test]
fn a_system_that_depends_on_time() {
    let bell = |t: f64, _| 1.0 / (1.0 + t * t);
    let mut sys = system(1, 0, |t: f64, x: &[f64], r: &mut [f64]| r[0] = -2.0 * t * x[0] * x[0]);
    let (_, at_steps, between) = run::<Dopri5, _>(&mut sys, &[1.0], [0.0, 5.0], 1e-10, bell);
    assert!(at_steps < 1e-9 && between < 1e-9, "{at_steps:e} {between:e}");
    let (_, at_steps, between) = run::<Implicit, _>(&mut sys, &[1.0], [0.0, 5.0], 1e-8, bell);
    assert!(at_steps < 1e-8 && between < 1e-7, "{at_steps:e} {between:e}");
}

/// One step of given length from the same start: the error of a method of order p goes with h^(p+1).
fn orders<M: Stepper>() -> [f64; 3] {
    let error = |h: f64| {
        let mut sys = system(2, 1, |t: f64, x: &[f64], r: &mut [f64]| {
            r[0] = x[0] * t.cos();
            r[1] = x[1] * x[0];
            r[2] = x[0] * t.cos() + 1.0;
        });
        let mut m = M::new(2, 1);
        m.restart(&mut sys, 0.3, &[0.3_f64.sin().exp(), 1.0, 0.0], 1e-2, 9.0, Some(h));
        m.step(&mut sys, 0.3 + h).unwrap();
        assert_eq!(m.counts().steps, 1);
        let exact = |t: f64| t.sin().exp();
        let mid = 0.3 + 0.7 * h;
        [
            (m.x()[0] - exact(0.3 + h)).abs(),
            (m.interpolate_component(mid, 0) - exact(mid)).abs(),
            (m.x()[2] - (exact(0.3 + h) - exact(0.3) + h)).abs(),
        ]
    };
    let (coarse, fine) = (error(0.1), error(0.05));
    std::array::from_fn(|k| (coarse[k] / fine[k]).log2())
}

#[test]
fn orders_of_step_dense_output_and_quadrature() {
    let [step, dense, quadrature] = orders::<Dopri5>();
    assert!((step - 6.0).abs() < 0.5 && dense > 4.6 && (quadrature - 6.0).abs() < 0.5, "{step} {dense} {quadrature}");
    let [step, dense, quadrature] = orders::<Implicit>();
    assert!(step > 5.0 && (dense - 4.0).abs() < 0.5 && quadrature > 5.0, "{step} {dense} {quadrature}");
}

/// The damped pendulum with a driving torque; quadratures: power of the drive, power lost.
fn pendulum() -> Closure<impl FnMut(f64, &[f64], &mut [f64])> {
    system(2, 2, |t: f64, x: &[f64], r: &mut [f64]| {
        let drive = 0.7 * (1.3 * t).sin();
        r[0] = x[1];
        r[1] = -x[0].sin() - 0.1 * x[1] + drive;
        r[2] = drive * x[1];
        r[3] = 0.1 * x[1] * x[1];
    })
}

fn energy_residual<M: Stepper>(tolerance: f64, every: usize) -> f64 {
    let mut sys = pendulum();
    let energy = |x: &[f64]| 0.5 * x[1] * x[1] - x[0].cos();
    let start = [1.0, 0.0, 0.0, 0.0];
    let mut m = M::new(2, 2);
    m.restart(&mut sys, 0.0, &start, tolerance, 10.0, None);
    let mut cut = 0;
    let mut x = [0.0; 4];
    while m.t() < 10.0 {
        m.step(&mut sys, 10.0).unwrap();
        // Now and then an event within the step.
        if m.counts().steps.is_multiple_of(every) {
            let t = m.t_old() + 0.37 * (m.t() - m.t_old());
            m.shorten(&mut sys, t);
            assert_eq!(m.t(), t);
            x.copy_from_slice(m.x());
            let mut rate = [0.0; 4];
            sys.rate(t, &x, &mut rate);
            for k in 0..4 {
                assert!((rate[k] - m.rate()[k]).abs() < 1e3 * tolerance, "{k}");
            }
            m.restart(&mut sys, t, &x, tolerance, 10.0, None);
            cut += 1;
        }
    }
    assert!(cut > 5 || every == usize::MAX);
    (energy(m.x()) - energy(&start) - (m.x()[2] - m.x()[3])).abs()
}

#[test]
fn energy_closes() {
    // Without events, and with an event in every tenth step.
    for every in [usize::MAX, 10] {
        let residual = energy_residual::<Dopri5>(1e-10, every);
        assert!(residual < 1e-9, "{residual:e}");
        let residual = energy_residual::<Implicit>(1e-10, every);
        assert!(residual < 1e-9, "{residual:e}");
    }
}

#[test]
fn the_last_step_ends_where_it_should_and_is_not_tiny() {
    fn check<M: Stepper>() {
        let mut sys = oscillator();
        let mut m = M::new(2, 0);
        m.restart(&mut sys, 0.0, &[1.0, 0.0], 1e-8, 3.0, None);
        let mut end = 0.0;
        let (mut shortest, mut longest) = (f64::MAX, 0.0_f64);
        for k in 1..40 {
            end += 0.1 * f64::from(k);
            while m.t() < end {
                m.step(&mut sys, end).unwrap();
                assert!(m.t() <= end && m.t_old() < m.t());
                if k > 5 {
                    shortest = shortest.min(m.t() - m.t_old());
                    longest = longest.max(m.t() - m.t_old());
                }
            }
            assert_eq!(m.t(), end);
        }
        assert!(shortest > 0.3 * longest, "{shortest} {longest}");
    }
    check::<Dopri5>();
    check::<Implicit>();
}

#[test]
fn both_ends_of_a_step() {
    fn check<M: Stepper>() {
        let mut sys = oscillator();
        let mut m = M::new(2, 0);
        m.restart(&mut sys, 0.0, &[1.0, 0.0], 1e-8, 3.0, Some(0.01));
        assert_eq!((m.t_old(), m.t(), m.rate()), (0.0, 0.0, &[0.0, -1.0][..]));
        m.step(&mut sys, 3.0).unwrap();
        assert_eq!((m.t_old(), m.t()), (0.0, 0.01));
        assert_eq!((m.x_old(), m.rate_old()), (&[1.0, 0.0][..], &[0.0, -1.0][..]));
        let x = [m.x()[0], m.x()[1]];
        assert_eq!(m.rate(), [x[1], -x[0]]);
        let mut out = [0.0; 2];
        m.interpolate(0.0, &mut out);
        assert_eq!(out, [1.0, 0.0]);
        m.interpolate(0.01, &mut out);
        assert_eq!(out, x);
        // From both sides the interpolation joins the ends.
        m.interpolate(0.01 - 1e-13, &mut out);
        assert!((out[0] - x[0]).abs() < 1e-12 && (out[1] - x[1]).abs() < 1e-12);
    }
    check::<Dopri5>();
    check::<Implicit>();
}

/// Eigenvalues −1 and −10⁶, coupled: (x₀ + x₁)' = −(x₀ + x₁), (x₀ − x₁)' = −10⁶ (x₀ − x₁).
fn stiff() -> Closure<impl FnMut(f64, &[f64], &mut [f64])> {
    system(2, 0, |_, x: &[f64], r: &mut [f64]| {
        let (slow, fast) = (0.5 * (x[0] + x[1]), 0.5e6 * (x[0] - x[1]));
        (r[0], r[1]) = (-slow - fast, -slow + fast);
    })
}

#[test]
fn a_stiff_linear_system_takes_few_steps() {
    let exact = |t: f64, k: usize| (-t).exp() + if k == 0 { 1.0 } else { -1.0 } * (-1e6 * t).exp();
    let (m, at_steps, _) = run::<Implicit, _>(&mut stiff(), &[2.0, 0.0], [0.0, 10.0], 1e-6, exact);
    assert!(at_steps < 1e-5, "{at_steps:e}");
    assert!(m.counts().steps < 150, "{:?}", m.counts());
}

#[test]
fn the_explicit_method_notices_that_it_should_not() {
    let mut sys = stiff();
    let mut m = Dopri5::new(2, 0);
    m.restart(&mut sys, 0.0, &[2.0, 0.0], 1e-6, 10.0, None);
    while !m.is_stiff() && m.counts().steps < 300 {
        m.step(&mut sys, 10.0).unwrap();
    }
    assert!(m.is_stiff() && m.t() < 1e-2, "{} {:?}", m.t(), m.counts());
}

/// x'' = μ(1 − x²)x' − x with μ = 1000; reference: Mazzia, Magherini, Test Set for IVP Solvers 2008.
#[test]
fn van_der_pol() {
    let mut sys = system(2, 0, |_, x: &[f64], r: &mut [f64]| {
        (r[0], r[1]) = (x[1], 1e3 * (1.0 - x[0] * x[0]) * x[1] - x[0]);
    });
    sys.scale = 1e-3;
    let mut m = Implicit::new(2, 0);
    m.restart(&mut sys, 0.0, &[2.0, 0.0], 1e-7, 2000.0, None);
    while m.t() < 2000.0 {
        m.step(&mut sys, 2000.0).unwrap();
    }
    assert!((m.x()[0] - 1.706167732170469).abs() < 1e-6, "{:?}", m.x());
    assert!((m.x()[1] + 8.928097010248125e-4).abs() < 1e-9, "{:?}", m.x());
    assert!(m.counts().steps < 1700, "{:?}", m.counts());
}

/// Robertson's reactions to 10¹¹ s; reference: Mazzia, Magherini, Test Set for IVP Solvers 2008.
#[test]
fn robertson() {
    let mut sys = system(3, 0, |_, x: &[f64], r: &mut [f64]| {
        let (slow, mixed, fast) = (0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]);
        (r[0], r[1], r[2]) = (mixed - slow, slow - mixed - fast, fast);
    });
    sys.scale = 1e-8;
    let mut m = Implicit::new(3, 0);
    m.restart(&mut sys, 0.0, &[1.0, 0.0, 0.0], 1e-6, 1e11, None);
    while m.t() < 1e11 {
        m.step(&mut sys, 1e11).unwrap();
    }
    let reference = [0.2083340149701255e-7, 0.8333360770334713e-13, 0.999999979166505];
    for k in 0..3 {
        assert!((m.x()[k] / reference[k] - 1.0).abs() < 1e-3, "{:?}", m.x());
    }
    assert!(m.counts().steps < 500, "{:?}", m.counts());
}

#[test]
fn a_rate_that_is_no_number() {
    fn check<M: Stepper>() {
        // Finite until x = 1, which is reached at t = 1.
        let mut sys = system(1, 1, |_, x: &[f64], r: &mut [f64]| {
            r[0] = if x[0] > 1.0 { f64::NAN } else { 1.0 };
            r[1] = 0.0;
        });
        let mut m = M::new(1, 1);
        m.restart(&mut sys, 0.0, &[0.0, 0.0], 1e-8, 3.0, None);
        let error = loop {
            if let Err(e) = m.step(&mut sys, 3.0) {
                break e;
            }
        };
        assert_eq!(error, StepError::NotFinite);
        assert!((m.t() - 1.0).abs() < 1e-3 && m.x()[0].is_finite(), "{}", m.t());
        // In a quadrature, and from the start.
        let mut sys = system(1, 1, |t: f64, _: &[f64], r: &mut [f64]| (r[0], r[1]) = (1.0, (0.5 - t).sqrt()));
        m.restart(&mut sys, 0.0, &[0.0, 0.0], 1e-8, 3.0, None);
        while m.step(&mut sys, 3.0).is_ok() {}
        assert!(m.t() <= 0.5 && m.t() > 0.499, "{}", m.t());
        m.restart(&mut sys, 1.0, &[0.0, 0.0], 1e-8, 3.0, None);
        assert_eq!(m.step(&mut sys, 3.0), Err(StepError::NotFinite));
    }
    check::<Dopri5>();
    check::<Implicit>();
}

#[test]
fn a_pole_ends_the_steps() {
    fn check<M: Stepper>() {
        // x' = x², pole at t = 1.
        let mut sys = system(1, 0, |_, x: &[f64], r: &mut [f64]| r[0] = x[0] * x[0]);
        let mut m = M::new(1, 0);
        m.restart(&mut sys, 0.0, &[1.0], 1e-8, 3.0, None);
        while m.step(&mut sys, 3.0).is_ok() {
            assert!(m.counts().steps < 5000);
        }
        assert!((m.t() - 1.0).abs() < 1e-6, "{}", m.t());
    }
    check::<Dopri5>();
    check::<Implicit>();
}

#[test]
fn quadratures_alone() {
    fn check<M: Stepper>() {
        let mut sys = system(0, 1, |_, _: &[f64], r: &mut [f64]| r[0] = 2.0);
        let mut m = M::new(0, 1);
        m.restart(&mut sys, 0.0, &[0.0], 1e-8, 3.0, None);
        while m.t() < 3.0 {
            m.step(&mut sys, 3.0).unwrap();
        }
        assert!((m.x()[0] - 6.0).abs() < 1e-12);
    }
    check::<Dopri5>();
    check::<Implicit>();
}

#[test]
fn steps_and_restarts_do_not_allocate() {
    fn check<M: Stepper>() {
        let mut sys = pendulum();
        let mut m = M::new(2, 2);
        let mut x = [1.0, 0.0, 0.0, 0.0];
        m.restart(&mut sys, 0.0, &x, 1e-8, 1e9, None);
        let count = measure(|| {
            for _ in 0..2000 {
                m.step(&mut sys, 1e9).unwrap();
                m.shorten(&mut sys, 0.5 * (m.t_old() + m.t()));
                x.copy_from_slice(m.x());
                m.restart(&mut sys, m.t(), &x, 1e-8, 1e9, None);
                m.step(&mut sys, 1e9).unwrap();
            }
        });
        assert_eq!(count.count_total, 0);
    }
    check::<Dopri5>();
    check::<Implicit>();
}
