//! Why a scenario failed: what it expected, the value of every signal in the expression, and the pending alarms.

use std::fmt;

use super::fields::in_the_case;
use crate::source::{Place, Problem};
use crate::units::Time;

/// A step that did not succeed.
#[derive(Clone, PartialEq)]
pub enum Failure {
    /// The input is invalid; nothing was run for it.
    Unusable(Problem),
    /// The machine did not behave as expected.
    Missed(Box<Missed>),
}

/// An expectation that was not met.
#[derive(Clone, Debug, PartialEq)]
pub struct Missed {
    /// The step, if it is in a file.
    pub place: Option<Place>,
    /// Time since the start of the scenario.
    pub time: Time,
    /// The values of the case, if the scenario has a matrix.
    pub case: Option<String>,
    /// What was expected, and for how long.
    pub what: String,
    /// Each signal and value in the expression, with its value at that time.
    pub operands: Vec<String>,
    /// Each pending alarm with its text.
    pub alarms: Vec<String>,
}

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Progress {
    /// The PLC program has not begun.
    New,
    /// Its steps are executed.
    Running,
    /// The steps are done, or one has failed.
    Over(Option<Failure>),
}

impl Failure {
    /// The same failure with this place, unless it already has one.
    #[must_use]
    pub(super) fn at(self, place: &Place) -> Self {
        match self {
            Self::Unusable(problem) => Self::Unusable(problem.at(place)),
            Self::Missed(mut missed) => {
                missed.place.get_or_insert_with(|| place.clone());
                Self::Missed(missed)
            }
        }
    }
}

impl Failure {
    /// The same failure in this case of a matrix.
    #[must_use]
    pub(super) fn of_case(self, case: Option<&str>) -> Self {
        match self {
            Self::Unusable(problem) => Self::Unusable(in_the_case(problem, case)),
            Self::Missed(mut missed) => {
                missed.case = case.map(str::to_owned);
                Self::Missed(missed)
            }
        }
    }
}

impl From<Problem> for Failure {
    fn from(problem: Problem) -> Self {
        Self::Unusable(problem)
    }
}

impl From<Missed> for Failure {
    fn from(missed: Missed) -> Self {
        Self::Missed(Box::new(missed))
    }
}

impl fmt::Display for Missed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        write!(f, "{} (at {} s)", self.what, self.time)?;
        if let Some(case) = &self.case {
            write!(f, "\n  in the case {case}")?;
        }
        for operand in &self.operands {
            write!(f, "\n  {operand}")?;
        }
        if self.alarms.is_empty() {
            write!(f, "\n  no alarm is pending")?;
        }
        for alarm in &self.alarms {
            write!(f, "\n  pending: {alarm}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unusable(problem) => problem.fmt(f),
            Self::Missed(missed) => missed.fmt(f),
        }
    }
}

/// Prints the same text as `Display`, so that a test that unwraps a failure shows it readably.
impl fmt::Debug for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl std::error::Error for Failure {}
