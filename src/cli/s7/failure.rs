//! Why a command failed, and its exit code.

use crate::s7::client::Error;
use crate::source::Problem;

/// A problem and the exit code.
#[derive(Debug)]
pub(super) struct Failure {
    pub(super) problem: Problem,
    pub(super) code: u8,
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self { problem, code: 2 }
    }
}

impl From<&Error> for Failure {
    /// A refusal by the module gives exit code 1.
    fn from(error: &Error) -> Self {
        let code = match error {
            Error::Refused { .. } | Error::Rejected { .. } => 1,
            Error::Input { .. }
            | Error::Unreachable { .. }
            | Error::NotAccepted { .. }
            | Error::TimedOut { .. }
            | Error::Lost { .. }
            | Error::Unexpected { .. } => 2,
        };
        Self { problem: problem(error), code }
    }
}

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        Self::from(&error)
    }
}

/// An error of the client in the form that the program prints.
pub(super) fn problem(error: &Error) -> Problem {
    Problem::new(error.to_string(), error.cure())
}
