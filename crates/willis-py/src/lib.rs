//! The inside of the Python package `willis`: trains, questions, compiled trains and tables, without manners. What a user
//! sees is written in Python, in `python/willis`.

mod answer;
mod arrow;
mod compiled;
mod interpreter;
mod refused;
mod table;
mod train;

#[pyo3::pymodule(gil_used = false)]
mod _willis {
    use std::ffi::OsString;

    use pyo3::prelude::{Python, pyfunction};

    #[pymodule_export]
    use crate::answer::{Answer, ask, gather, piece, questions};
    #[pymodule_export]
    use crate::compiled::Compiled;
    #[pymodule_export]
    use crate::table::Table;
    #[pymodule_export]
    use crate::train::Train;

    #[pymodule_export]
    #[allow(non_upper_case_globals)]
    const __version__: &str = env!("CARGO_PKG_VERSION");

    /// The command `willis` with these words; its exit status.
    #[pyfunction]
    fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
        py.detach(|| willis_cli::run_command(words))
    }

    /// The same for a program that shows the answer itself: what is wrong, if something is.
    #[pyfunction]
    fn command_told(py: Python<'_>, words: Vec<OsString>) -> Option<String> {
        py.detach(|| willis_cli::answer(words)).err()
    }
}
