//! The results of reading an archive: assignments line by line, and findings.

use std::fmt;

use crate::source::{Place, Problem};
use crate::units::ChannelNumber;

use super::table::numbered;

/// The severity of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The archive is used.
    Warning,
    /// The archive is rejected.
    Error,
}

/// A finding about an archive: place, datum, what was expected and what was found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Severity.
    pub severity: Severity,
    /// Place, if it is in a file.
    pub place: Option<Place>,
    /// The number of the datum, if it is known.
    pub number: Option<u32>,
    /// The identifier with its prefix; may be empty.
    pub identifier: String,
    /// What was expected and what was found.
    pub what: String,
    /// What to do about it; may be empty.
    pub cure: String,
}

/// `a.tea:7: error: MD37100 GANTRY_AXIS_TYPE: expected …, found …`, and the remedy in a second line.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(match self.severity {
            Severity::Warning => "warning: ",
            Severity::Error => "error: ",
        })?;
        let number = self.number.map(numbered).unwrap_or_default();
        let name = [number.as_str(), self.identifier.as_str()].join(" ");
        if !name.trim().is_empty() {
            write!(f, "{}: ", name.trim())?;
        }
        f.write_str(&self.what)?;
        if !self.cure.is_empty() {
            write!(f, "\n  {}", self.cure)?;
        }
        Ok(())
    }
}

impl From<Problem> for Finding {
    fn from(problem: Problem) -> Self {
        let Problem { place, what, cure } = problem;
        Self { severity: Severity::Error, place, number: None, identifier: String::new(), what, cure }
    }
}

/// A single problem with the first error of a rejected archive, and the number of further findings.
#[must_use]
pub fn refusal(findings: &[Finding]) -> Problem {
    let Some(first) = findings.first() else {
        return Problem::new("the machine data were rejected", "");
    };
    let name = first.number.map(|number| format!("{} {}: ", numbered(number), first.identifier)).unwrap_or_default();
    let more = match findings.len() - 1 {
        0 => String::new(),
        more => format!("; `machine-data check` shows {more} more"),
    };
    Problem { place: first.place.clone(), what: format!("{name}{}{more}", first.what), cure: first.cure.clone() }
}

/// An assignment to a datum that is not in the catalogue. It is kept unchanged, to be written back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Its place.
    pub place: Place,
    /// The number in front of it, if any.
    pub number: Option<u32>,
    /// The name with its prefix and index: `$MA_SPIND_VELO_LIMIT[0,AX4]`.
    pub name: String,
    /// The channel of its section.
    pub channel: ChannelNumber,
    /// The value as it was written.
    pub value: String,
}

/// A part of an archive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name: a file, or a member of a binary archive with its folder.
    pub name: String,
    /// Number of assignments read; `None` if it contains no machine data and was ignored.
    pub assignments: Option<usize>,
}

/// An assignment as read.
pub(super) struct Line {
    pub(super) place: Place,
    pub(super) number: Option<u32>,
    pub(super) name: String,
    pub(super) channel: ChannelNumber,
    pub(super) value: String,
}

/// The data collected while reading files.
#[derive(Default)]
pub(super) struct Reading {
    pub(super) lines: Vec<Line>,
    pub(super) findings: Vec<Finding>,
    pub(super) members: Vec<Member>,
}

impl From<Line> for Assignment {
    fn from(line: Line) -> Self {
        let Line { place, number, name, channel, value } = line;
        Self { place, number, name, channel, value }
    }
}
