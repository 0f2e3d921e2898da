//! The Python module `opennck._opennck`: sessions, scenarios and their traces. The package `opennck` beside it wraps it; users do not call
//! it. It has no behaviour of its own: verbs, errors and traces are those of the library.

mod error;
mod plc;
mod scenarios;
mod session;

/// The module.
#[pyo3::pymodule]
mod _opennck {
    #[pymodule_export]
    use crate::error::{Error, Missed};
    #[pymodule_export]
    use crate::plc::PlcIo;
    #[pymodule_export]
    use crate::scenarios::{Case, Outcome, cases, scenario_files};
    #[pymodule_export]
    use crate::session::Session;
}
