//! The alarms that block preparation raises, with their parameters. The caller adds the channel (%1).
//!
//! Inside the module an error is a [`Fault`]: a number, the columns that caused it, and a reason in words. The interpreter and the check
//! turn it into a [`ProgramAlarm`] with the block (%2) and the source text (%3).

use serde::{Deserialize, Serialize};

/// What an alarm does to the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Class {
    /// The program stops before the block, nothing of the block is executed, NC start reads it again.
    CorrectionBlock,
    /// The interpreter stops; only RESET clears the alarm.
    InterpreterStop,
}

/// What the third parameter of an alarm contains.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Third {
    /// Nothing.
    None,
    /// The source text that is wrong, or a name.
    Text,
}

/// An alarm of block preparation.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ProgramAlarm {
    /// The number of the control.
    pub number: u32,
    /// What the alarm does to the program.
    pub class: Class,
    /// %2: the block by its number (`N40`), else by its label, else by its line.
    pub block: String,
    /// %3: the source text that is wrong, or a name; empty if the alarm has no third parameter.
    pub text: String,
    /// Why the alarm was raised, in words.
    pub reason: String,
    /// The program.
    pub program: String,
    /// The line, counted from one.
    pub line: u32,
    /// The column, counted from one.
    pub column: u32,
    /// The control of the manual can do this, but OpenNCK cannot. The number is then 12553 (function not active).
    pub is_refused: bool,
}

impl ProgramAlarm {
    /// What the control calls the alarm.
    #[must_use]
    pub fn title(&self) -> &'static str {
        row(self.number).2
    }
}

impl std::fmt::Display for ProgramAlarm {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: block {}: {}", self.number, self.block, self.title())?;
        if !self.text.is_empty() {
            write!(f, " `{}`", self.text)?;
        }
        if self.reason.is_empty() { Ok(()) } else { write!(f, ": {}", self.reason) }
    }
}

/// Columns of a block: the first byte, and the byte behind the last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Span {
    pub(super) from: u32,
    pub(super) to: u32,
}

impl Span {
    /// From the start of this one to the end of another one.
    pub(super) fn until(self, end: Self) -> Self {
        Self { from: self.from, to: end.to.max(self.from) }
    }

    /// The text of these columns.
    pub(super) fn of(self, line: &str) -> &str {
        let end = (self.to as usize).min(line.len());
        line.get((self.from as usize).min(end)..end).unwrap_or_default().trim()
    }
}

/// An error in a block, before the block is known by its name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Fault {
    pub(super) number: u32,
    pub(super) at: Span,
    /// %3 instead of the source text.
    text: Option<String>,
    reason: String,
    is_refused: bool,
}

impl Fault {
    pub(super) fn new(number: u32, at: Span, reason: impl Into<String>) -> Self {
        Self { number, at, text: None, reason: reason.into(), is_refused: false }
    }

    /// A function of the control that OpenNCK does not have.
    pub(super) fn refused(at: Span, what: &str) -> Self {
        let mut fault = Self::new(12553, at, format!("{what}: OpenNCK does not model it"));
        fault.is_refused = true;
        fault
    }

    /// With this third parameter instead of the source text.
    pub(super) fn about(mut self, text: impl Into<String>) -> Self {
        self.text = Some(text.into());
        self
    }

    /// The alarm of a block.
    pub(super) fn alarm(self, program: &str, block: &str, line: u32, source: &str) -> ProgramAlarm {
        let (class, third, _) = row(self.number);
        let before = source.get(..(self.at.from as usize).min(source.len())).unwrap_or(source);
        let text = match (third, self.text) {
            (Third::None, _) => String::new(),
            (Third::Text, Some(text)) => text,
            (Third::Text, None) => self.at.of(source).to_owned(),
        };
        ProgramAlarm {
            number: self.number,
            class,
            block: block.to_owned(),
            text,
            reason: self.reason,
            program: program.to_owned(),
            line,
            column: u32::try_from(before.chars().count()).unwrap_or(u32::MAX - 1) + 1,
            is_refused: self.is_refused,
        }
    }
}

/// The numbers that the module raises.
pub fn numbers() -> impl Iterator<Item = u32> {
    ALARMS.iter().map(|row| row.0)
}

fn row(number: u32) -> (Class, Third, &'static str) {
    let found = ALARMS.binary_search_by_key(&number, |row| row.0);
    found.map_or((CB, NO, ""), |index| (ALARMS[index].1, ALARMS[index].2, ALARMS[index].3))
}

const CB: Class = Class::CorrectionBlock;
const IP: Class = Class::InterpreterStop;
const NO: Third = Third::None;
const TXT: Third = Third::Text;

/// Number, class, third parameter, text; in order of their numbers.
const ALARMS: &[(u32, Class, Third, &str)] = &[
    (10860, CB, NO, "no feedrate programmed"),
    (12000, CB, TXT, "address programmed more than once"),
    (12010, CB, TXT, "too many addresses of one type"),
    (12020, CB, NO, "modifier not allowed with this address"),
    (12040, CB, TXT, "expression is not of type AXIS"),
    (12060, CB, NO, "several functions of one G group"),
    (12070, CB, NO, "too many G functions that define the syntax"),
    (12080, CB, TXT, "syntax error"),
    (12090, CB, TXT, "parameter not expected"),
    (12110, CB, NO, "address does not fit the G function of the block"),
    (12120, CB, NO, "G function must be alone in its block"),
    (12150, CB, TXT, "operation and data type do not fit"),
    (12160, CB, TXT, "value outside the range of the type"),
    (12170, CB, TXT, "name defined more than once"),
    (12260, CB, TXT, "too many initial values"),
    (12300, CB, TXT, "reference parameter is missing"),
    (12320, CB, TXT, "reference parameter is not a variable"),
    (12330, CB, TXT, "parameter has the wrong type"),
    (12340, CB, TXT, "too many parameters"),
    (12400, CB, TXT, "array element does not exist"),
    (12410, CB, TXT, "index has the wrong type"),
    (12420, CB, NO, "name is too long"),
    (12430, CB, NO, "index is not valid"),
    (12470, CB, TXT, "unknown G function"),
    (12475, CB, TXT, "wrong number in indirect G programming"),
    (12500, CB, TXT, "keyword not allowed in this file"),
    (12550, CB, TXT, "name is not defined"),
    (12553, CB, TXT, "function is not active"),
    (12560, CB, TXT, "value outside the permitted range"),
    (12630, CB, NO, "skip or label not allowed in a block of a control structure"),
    (12640, IP, NO, "control structure not closed, or crossed"),
    (12641, IP, NO, "control structures nested too deep"),
    (14000, IP, NO, "end of file without end of program"),
    (14010, CB, NO, "omitted parameter has no default value"),
    (14011, CB, TXT, "program does not exist"),
    (14012, IP, NO, "too many program levels"),
    (14013, CB, NO, "number of passes is not positive"),
    (14016, CB, NO, "several M functions of a block are replaced by subprograms"),
    (14020, CB, NO, "wrong value or number of parameters"),
    (14025, IP, NO, "wrong ID of a synchronised action"),
    (14048, IP, NO, "wrong number of turns of a circle"),
    (14050, CB, NO, "expression nested too deep"),
    (14051, CB, NO, "arithmetic error"),
    (14060, CB, NO, "wrong skip level"),
    (14080, CB, TXT, "jump target does not exist"),
    (14082, CB, TXT, "label of a part of the program does not exist"),
    (14091, IP, TXT, "function not allowed here"),
    (14092, CB, TXT, "wrong type of axis"),
    (14300, CB, NO, "handwheel override not allowed here"),
    (14500, CB, NO, "DEF or PROC after the first block"),
    (14510, CB, NO, "call with parameters of a program without PROC"),
    (14520, CB, NO, "PROC is not the first block"),
    (14750, CB, NO, "too many auxiliary functions"),
    (14757, CB, NO, "action does not fit the type of the synchronised action"),
    (14760, CB, NO, "several auxiliary functions of one group"),
    (14800, CB, NO, "path feedrate is not positive"),
    (14810, CB, TXT, "feedrate of a positioning axis is negative"),
    (15460, CB, NO, "address does not fit the modal G function"),
    (15700, IP, TXT, "wrong number of a cycle alarm"),
    (16100, CB, TXT, "spindle does not exist in the channel"),
    (16420, CB, TXT, "axis programmed more than once"),
    (16785, CB, TXT, "the same axis is following and leading axis"),
    (16800, CB, TXT, "DC on an axis that is not rotary"),
    (16810, CB, TXT, "ACP on an axis that is not modulo"),
    (16820, IP, TXT, "ACN on an axis that is not modulo"),
    (16830, CB, TXT, "position outside the modulo range"),
    (16930, CB, NO, "an executable block must stand between"),
    (17020, CB, NO, "first index is not valid"),
    (17030, CB, NO, "second index is not valid"),
    (17040, CB, NO, "axis index is wrong"),
    (17070, CB, NO, "value is write-protected"),
    (17071, CB, NO, "value is read-protected"),
    (17080, CB, TXT, "value is below the lower limit"),
    (17090, CB, TXT, "value is above the upper limit"),
    (17095, CB, NO, "value is not valid"),
    (17180, CB, NO, "tool offset number is wrong"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_sorted_and_has_each_number_once() {
        assert!(ALARMS.windows(2).all(|pair| pair[0].0 < pair[1].0));
    }

    #[test]
    fn an_alarm_has_the_block_the_text_and_the_column() {
        let fault = Fault::new(12550, Span { from: 4, to: 7 }, "no such name");
        let alarm = fault.alarm("PART", "N40", 7, "N40 FOO");
        assert_eq!((alarm.block.as_str(), alarm.text.as_str(), alarm.column), ("N40", "FOO", 5));
        assert_eq!(alarm.to_string(), "12550: block N40: name is not defined `FOO`: no such name");
    }
}
