//! The errors of the library as exceptions, with its texts.

use opennck::scenario::Failure;
use opennck::source::{Place, Problem};
use pyo3::PyErr;
use pyo3::exceptions::PyException;

pyo3::create_exception!(
    opennck,
    Error,
    PyException,
    "Unusable input, or a machine that did not do what was expected. The text says what was expected, what was found, and what to do."
);
pyo3::create_exception!(
    opennck,
    Missed,
    Error,
    "The machine did not do what was expected. The text has the value of every signal in the expression and the pending alarms."
);

/// The place of a step that a program gives; its texts do not show it.
pub(crate) const STEP: &str = "the step";

fn is_step(place: &Place) -> bool {
    &*place.file == STEP
}

/// Unusable input.
pub(crate) fn unusable(mut problem: Problem) -> PyErr {
    problem.place = problem.place.filter(|place| !is_step(place));
    Error::new_err(problem.to_string())
}

/// A step that did not succeed.
pub(crate) fn failed(failure: Failure) -> PyErr {
    match failure {
        Failure::Unusable(problem) => unusable(problem),
        Failure::Missed(mut missed) => {
            missed.place = missed.place.filter(|place| !is_step(place));
            Missed::new_err(missed.to_string())
        }
    }
}
