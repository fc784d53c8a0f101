//! Smooth motion between changes of mode.

/// A smooth system of ordinary differential equations with quadratures beside it.
///
/// The state is `x[..states()]`; after it stand `quadratures()` integrals whose rates depend on the
/// state but on which nothing depends (energies). Their error does not control the step.
pub(crate) trait Smooth {
    /// Number of states, whose error is controlled.
    fn states(&self) -> usize;
    /// Number of quadratures after them.
    fn quadratures(&self) -> usize;
    /// `rate = dx/dt`, of both.
    fn rate(&mut self, t: f64, x: &[f64], rate: &mut [f64]);
    /// Size of each state with which its error is compared: `tolerance (|x| + scale)`.
    fn scale(&self, state: usize) -> f64;
}
