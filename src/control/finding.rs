//! Findings about the data of a machine: their classes, their text, and the summary of many of them.

use std::collections::BTreeSet;
use std::fmt;

use crate::source::{Place, Problem};

/// The classes of findings, the heaviest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Class {
    /// A text cannot be read. The machine is refused.
    Unreadable,
    /// The control raises an alarm at power on, here and on a machine.
    AlarmAtPowerOn,
    /// A text file that a person wrote names a datum that is not known. It has no effect.
    Mistyped,
    /// A control accepts the value (O-30), but a function cannot work with it, or two values contradict each other.
    Implausible,
    /// The datum acts on a control otherwise than here.
    ActsOtherwise,
    /// A later file replaced the value of an earlier file, or a later line that of an earlier line.
    Overlaid,
    /// The control knows the datum; here it is kept and has no effect.
    NotModelled,
}

impl Class {
    /// All classes, the heaviest first.
    pub const ALL: [Self; 7] = [
        Self::Unreadable,
        Self::AlarmAtPowerOn,
        Self::Mistyped,
        Self::Implausible,
        Self::ActsOtherwise,
        Self::Overlaid,
        Self::NotModelled,
    ];

    /// The word before each finding.
    #[must_use]
    pub const fn word(self) -> &'static str {
        match self {
            Self::Unreadable => "error",
            Self::AlarmAtPowerOn => "alarm at power on",
            Self::Mistyped => "unknown",
            Self::Implausible => "implausible",
            Self::ActsOtherwise => "acts otherwise",
            Self::Overlaid => "overlaid",
            Self::NotModelled => "not modelled",
        }
    }

    /// The title of the class in a report.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Unreadable => "errors",
            Self::AlarmAtPowerOn => "alarms at power on",
            Self::Mistyped => "unknown, perhaps mistyped",
            Self::Implausible => "implausible",
            Self::ActsOtherwise => "acts otherwise than on a control",
            Self::Overlaid => "values that a later file or line replaced",
            Self::NotModelled => "not modelled (known to the control, no effect here)",
        }
    }

    /// Whether findings of this class mean that the machine behaves otherwise than its data or its control suggest.
    #[must_use]
    pub const fn changes_behaviour(self) -> bool {
        match self {
            Self::Unreadable | Self::AlarmAtPowerOn | Self::Mistyped | Self::Implausible | Self::ActsOtherwise => true,
            Self::Overlaid | Self::NotModelled => false,
        }
    }
}

/// One finding: place, datum, owner, value, what was expected, and the remedy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Its class.
    pub class: Class,
    /// Its place, if it is in a file.
    pub place: Option<Place>,
    /// The number of the datum, if it is known.
    pub number: Option<u32>,
    /// The datum with its index, as the control writes it: `MD34020 $MA_REFP_VELO_SEARCH_CAM[AX7]`; may be empty.
    pub datum: String,
    /// The value as written; empty without a value.
    pub value: String,
    /// The axis or channel, by name: `axis X1`; empty for data of the whole control.
    pub owner: String,
    /// What was expected, or what happens.
    pub what: String,
    /// What to do about it; may be empty.
    pub cure: String,
    /// For data without effect: the function to which the datum belongs.
    pub group: &'static str,
    /// The number of values for which the finding stands.
    pub values: usize,
}

impl Finding {
    /// A finding about no datum.
    #[must_use]
    pub fn new(class: Class, what: impl Into<String>, cure: impl Into<String>) -> Self {
        Self {
            class,
            place: None,
            number: None,
            datum: String::new(),
            value: String::new(),
            owner: String::new(),
            what: what.into(),
            cure: cure.into(),
            group: "",
            values: 1,
        }
    }

    /// The datum, its value and its owner: `MD34020 $MA_REFP_VELO_SEARCH_CAM[AX7] = 0, axis WZM`; empty if there are none.
    #[must_use]
    pub fn subject(&self) -> String {
        let value = if self.value.is_empty() { String::new() } else { format!(" = {}", self.value) };
        let named = format!("{}{value}", self.datum);
        let parts = [named.as_str(), self.owner.as_str()];
        parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ")
    }
}

/// `a.tea:7: implausible: MD34020 $MA_REFP_VELO_SEARCH_CAM[AX7] = 0, axis WZM: …`, and the remedy in a second line.
impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        write!(f, "{}: ", self.class.word())?;
        let subject = self.subject();
        if !subject.is_empty() {
            write!(f, "{subject}: ")?;
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
        Self { place, ..Self::new(Class::Unreadable, what, cure) }
    }
}

/// The findings in one line, by class: `1 alarm at power on, 2 act otherwise than on a control (MD32450, MD35000), 938 not modelled`; `None`
/// without findings.
#[must_use]
pub fn summary(findings: &[Finding]) -> Option<String> {
    let counts = Class::ALL.into_iter().filter_map(|class| {
        let count = findings.iter().filter(|finding| finding.class == class).count();
        let words = match (class, count) {
            (_, 0) => return None,
            (Class::Unreadable, 1) => "error",
            (Class::Unreadable, _) => "errors",
            (Class::AlarmAtPowerOn, 1) => "alarm at power on",
            (Class::AlarmAtPowerOn, _) => "alarms at power on",
            (Class::Mistyped, _) => "unknown, perhaps mistyped",
            (Class::Implausible, _) => "implausible",
            (Class::ActsOtherwise, 1) => "acts otherwise than on a control",
            (Class::ActsOtherwise, _) => "act otherwise than on a control",
            (Class::Overlaid, _) => "replaced by a later file or line",
            (Class::NotModelled, _) => "not modelled",
        };
        let named = if class == Class::ActsOtherwise { named(findings) } else { String::new() };
        Some(format!("{count} {words}{named}"))
    });
    let counts: Vec<_> = counts.collect();
    (!counts.is_empty()).then(|| counts.join(", "))
}

/// The data that act otherwise, each once: ` (MD32450, MD35000)`.
fn named(findings: &[Finding]) -> String {
    let data = findings.iter().filter(|finding| finding.class == Class::ActsOtherwise && !finding.datum.is_empty());
    let data: BTreeSet<&str> = data.filter_map(|finding| finding.datum.split_whitespace().next()).collect();
    if data.is_empty() {
        return String::new();
    }
    format!(" ({})", data.into_iter().collect::<Vec<_>>().join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finding_names_place_class_datum_value_and_owner() {
        let finding = Finding {
            place: Some(Place::file("a.tea").at_line(7)),
            datum: "MD34020 $MA_REFP_VELO_SEARCH_CAM[AX7]".to_owned(),
            value: "0".to_owned(),
            owner: "axis WZM".to_owned(),
            ..Finding::new(Class::Implausible, "expected more than 0", "correct the value")
        };
        let expected = "a.tea:7: implausible: MD34020 $MA_REFP_VELO_SEARCH_CAM[AX7] = 0, axis WZM: expected more than 0\n  \
            correct the value";
        assert_eq!(finding.to_string(), expected);
        assert_eq!(Finding::new(Class::ActsOtherwise, "a", "").to_string(), "acts otherwise: a");
    }

    #[test]
    fn many_findings_are_summarised_in_one_line() {
        let of = |class| Finding::new(class, "", "");
        assert_eq!(summary(&[]), None);
        let findings = [of(Class::NotModelled), of(Class::NotModelled), of(Class::AlarmAtPowerOn)];
        assert_eq!(summary(&findings).unwrap(), "1 alarm at power on, 2 not modelled");
        let about = |datum: &str| Finding { datum: datum.to_owned(), ..of(Class::ActsOtherwise) };
        let findings = [about("MD35000 $MA_A[AX2]"), about("MD32450 $MA_B[0,AX1]"), about("MD35000 $MA_A[AX3]")];
        assert_eq!(summary(&findings).unwrap(), "3 act otherwise than on a control (MD32450, MD35000)");
    }
}
