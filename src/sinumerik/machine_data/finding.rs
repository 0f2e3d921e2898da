//! What reading an archive finds: assignments line by line, and what is to be said about them.

use std::fmt;

use crate::source::{Place, Problem};
use crate::units::ChannelNumber;

use super::table::numbered;

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// The archive is used.
    Warning,
    /// The archive is refused.
    Error,
}

/// Something to say about an archive: where, which datum, what was expected and what came.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// How bad it is.
    pub severity: Severity,
    /// Where, if it stands in a file.
    pub place: Option<Place>,
    /// The number of the datum, if it is known.
    pub number: Option<u32>,
    /// The identifier with its prefix; may be empty.
    pub identifier: String,
    /// What was expected and what came.
    pub what: String,
    /// What to do about it; may be empty.
    pub cure: String,
}

/// `a.tea:7: error: MD37100 GANTRY_AXIS_TYPE: expected …, found …`, and the cure in a second line.
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

/// One problem for the first of the findings that refused an archive, saying how many more there are.
#[must_use]
pub fn refusal(findings: &[Finding]) -> Problem {
    let Some(first) = findings.first() else {
        return Problem::new("the machine data were refused", "");
    };
    let name = first.number.map(|number| format!("{} {}: ", numbered(number), first.identifier)).unwrap_or_default();
    let more = match findings.len() - 1 {
        0 => String::new(),
        more => format!("; `machine-data check` shows {more} more"),
    };
    Problem { place: first.place.clone(), what: format!("{name}{}{more}", first.what), cure: first.cure.clone() }
}

/// An assignment that means no datum of the catalogue: kept as it stands, to be written back.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Where it stands.
    pub place: Place,
    /// The number in front of it, if there is one.
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
    /// How many assignments were read in it; `None` where it holds no machine data and was left alone.
    pub assignments: Option<usize>,
}

/// An assignment as a reader found it.
pub(super) struct Line {
    pub(super) place: Place,
    pub(super) number: Option<u32>,
    pub(super) name: String,
    pub(super) channel: ChannelNumber,
    pub(super) value: String,
}

/// What the readers of files collect.
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
