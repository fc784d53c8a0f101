//! The instructions that the loops over many points run with.

/// Where a loop runs: with the widest vectors that this machine has.
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use pulp::Arch;

/// Where a loop runs: a browser has one width. What stands twice in a module, the reader of a page loads twice.
#[cfg(target_arch = "wasm32")]
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arch;

#[cfg(target_arch = "wasm32")]
impl Arch {
    pub(crate) fn new() -> Self {
        Self
    }

    pub(crate) fn dispatch<W: pulp::WithSimd>(self, work: W) -> W::Output {
        work.with_simd(pulp::Scalar)
    }
}
