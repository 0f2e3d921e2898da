//! The results of reading an archive line by line.

use super::scaling::System;
use crate::control::{Class, Finding};
use crate::source::{Place, Problem};
use crate::units::ChannelNumber;

/// A single problem with the first error of a rejected archive, and the number of further findings.
#[must_use]
pub fn refusal(findings: &[Finding]) -> Problem {
    let errors: Vec<_> = findings.iter().filter(|finding| finding.class == Class::Unreadable).collect();
    let Some(first) = errors.first() else {
        return Problem::new("the machine data were rejected", "");
    };
    let subject = first.subject();
    let name = if subject.is_empty() { subject } else { format!("{subject}: ") };
    let more = match errors.len() - 1 {
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

/// The author of a text of machine data.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Author {
    /// A text file that a person wrote. Mistakes are errors, and what the catalogue does not know is perhaps mistyped.
    Person,
    /// A text file that a control exported. Mistakes are errors, because a person may have edited it; what the catalogue does not know is
    /// known to the control.
    Export,
    /// A binary archive: a control wrote it. Nothing in it is a mistake (O-30); what the simulator does not know is kept.
    Control,
}

/// An assignment as read.
#[derive(Clone)]
pub(super) struct Line {
    pub(super) place: Place,
    pub(super) number: Option<u32>,
    pub(super) name: String,
    pub(super) channel: ChannelNumber,
    pub(super) value: String,
    pub(super) author: Author,
    /// The file, counted from zero in the order of reading.
    pub(super) file: usize,
    /// The system of units that the file declares.
    pub(super) system: Option<System>,
    /// Whether a checksum follows the value, which only a control writes.
    pub(super) has_checksum: bool,
}

/// The data collected while reading files.
#[derive(Default)]
pub(super) struct Reading {
    pub(super) lines: Vec<Line>,
    pub(super) findings: Vec<Finding>,
    pub(super) members: Vec<Member>,
    /// The number of the file that is being read.
    pub(super) file: usize,
}

impl From<Line> for Assignment {
    fn from(line: Line) -> Self {
        let Line { place, number, name, channel, value, author: _, file: _, system: _, has_checksum: _ } = line;
        Self { place, number, name, channel, value }
    }
}
