//! Places in a program: where the main program and subroutines begin, labels, the parts of control blocks.
//!
//! They are searched in the text when they are needed, so a program of any size needs no more memory than its text.

use std::collections::BTreeSet;

use crate::nc_program::Program;

use super::fault::{CONTROL_DEPTH, Error, FaultCode};
use super::head::{Head, Header, Target, head, header, is_header};
use super::lines::{Line, Lines};

/// What a control block opens and closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) enum Structure {
    If,
    Switch,
    For,
    While,
    Do,
    Repeat,
}

impl Structure {
    /// The keyword that opens it, and the one that closes it.
    pub(super) fn words(self) -> [&'static str; 2] {
        match self {
            Self::If => ["IF", "ENDIF"],
            Self::Switch => ["SWITCH", "ENDSWITCH"],
            Self::For => ["FOR", "ENDFOR"],
            Self::While => ["WHILE", "ENDWHILE"],
            Self::Do => ["DO", "ENDDO"],
            Self::Repeat => ["REPEAT", "UNTIL"],
        }
    }

    pub(super) fn is_loop(self) -> bool {
        matches!(self, Self::For | Self::While | Self::Do | Self::Repeat)
    }

    const ALL: [Self; 6] = [Self::If, Self::Switch, Self::For, Self::While, Self::Do, Self::Repeat];
}

/// Control blocks inside each other; no source gives the number of a control.
pub(super) const DEEPEST: usize = 50;

/// The error of a control block too many.
pub(super) fn too_deep(at: usize) -> Error {
    let text = format!("control blocks are nested more than {DEEPEST} deep; write the inner ones as a subroutine");
    Error::new(FaultCode::Number(CONTROL_DEPTH), at, text)
}

/// What a line means for control blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark<'a> {
    Open(Structure),
    Close(Structure),
    /// `ELSE`, `ELSEIF`, `CASE`, `DEFAULT`, and others that open and close nothing.
    Other(&'a str),
}

/// The keyword of a control block; none for other lines.
pub(super) fn mark<'a>(text: &'a str, head: &Head) -> Option<Mark<'a>> {
    let rest = text.get(head.rest..)?.strip_prefix('$')?;
    let word = &rest[..rest.find(|letter: char| !letter.is_ascii_alphanumeric()).unwrap_or(rest.len())];
    if word == "IF" && rest.contains("$GOTO") {
        return Some(Mark::Other(word));
    }
    let found = Structure::ALL.iter().find_map(|structure| match structure.words() {
        [open, _] if open == word => Some(Mark::Open(*structure)),
        [_, close] if close == word => Some(Mark::Close(*structure)),
        _ => None,
    });
    Some(found.unwrap_or(Mark::Other(word)))
}

/// A program as it is searched.
#[derive(Clone, Copy)]
pub(super) struct Text<'a> {
    pub(super) program: &'a Program,
    pub(super) lenient: bool,
    /// Whether blocks with this skip level are skipped.
    pub(super) is_skipped: &'a dyn Fn(u8) -> bool,
}

impl<'a> Text<'a> {
    fn lines(self, from: u32) -> Lines<'a> {
        Lines::new(self.program, from, self.lenient)
    }

    /// The lines up to the next header line that are not skipped, with their beginnings.
    fn section(self, from: u32) -> impl Iterator<Item = (Line<'a>, Head)> {
        let is_inside = |line: &Line<'_>| !is_header(&line.text);
        let readable = move |line: Line<'a>| {
            let head = head(&line.text).ok()?;
            (!head.skip.is_some_and(|level| (self.is_skipped)(level))).then_some((line, head))
        };
        self.lines(from).take_while(is_inside).filter_map(readable)
    }

    /// The first line of the main program.
    ///
    /// Text before the first `%` is the main program, a block number alone included, else `%NAME` begins it. With `lenient` it may follow the `M17` of the last subroutine;
    /// without, those lines belong to the subroutine.
    ///
    /// # Errors
    /// The line that has the problem, and the problem.
    pub(super) fn main(self) -> Result<u32, (u32, Error)> {
        let mut last_subroutine = None;
        for line in self.lines(1) {
            match header(&line.text) {
                Err(error) => return Err((line.line, error)),
                Ok(Some(Header::Main)) => return Ok(line.next),
                Ok(Some(Header::Subroutine(_))) => last_subroutine = Some((line.line, line.next)),
                Ok(None) if last_subroutine.is_none() && self.begins_main(&line) => return Ok(1),
                Ok(None) => {}
            }
        }
        let Some((header_line, first)) = last_subroutine else { return Ok(1) };
        let mut is_ended = false;
        for line in self.lines(first) {
            if is_ended && !self.is_empty(&line) {
                if self.lenient {
                    return Ok(line.line);
                }
                let text = "the file has no main program: the lines behind the last M17 belong to its subroutine; write a header line `%NAME` before this line";
                return Err((line.line, Error::syntax(0, text)));
            }
            is_ended |= ["M17", "M29"].iter().any(|end| has_function(&line.text, end));
        }
        let text =
            "the file has subroutines and no main program; write a header line `%NAME` and its blocks behind them";
        Err((header_line, Error::syntax(0, text)))
    }

    /// Whether a line before the first `%` begins a main program without a header (diagnosis 20193); with `lenient` a block must be in it.
    fn begins_main(self, line: &Line<'_>) -> bool {
        !self.is_empty(line) || !self.lenient && !line.is_comment() && !line.text.trim().is_empty()
    }

    fn is_empty(self, line: &Line<'_>) -> bool {
        if line.is_comment() {
            return true;
        }
        let rest = head(&line.text).map_or(&*line.text, |head| &line.text[head.rest..]).trim();
        rest.is_empty() || self.lenient && rest == ":"
    }

    /// The first line of a local subroutine.
    pub(super) fn subroutine(self, name: &str) -> Option<u32> {
        let is_it = |line: &Line<'_>| match header(&line.text) {
            Ok(Some(Header::Subroutine(found))) => found.eq_ignore_ascii_case(name),
            Ok(Some(Header::Main) | None) | Err(_) => false,
        };
        self.lines(1).find(is_it).map(|line| line.next)
    }

    /// The line of a label in the section that begins at a line, and the control blocks that are open there, with their lines; and the line
    /// of a second label of this name.
    pub(super) fn label(self, section: u32, target: &Target) -> (Option<(u32, Vec<Opened>)>, Option<u32>) {
        let (mut found, mut second) = (None, None);
        self.each_label(section, &mut |label, line, open| {
            match (label == target, &found) {
                (true, None) => found = Some((line, open.to_vec())),
                (true, Some(_)) => second = Some(line),
                (false, _) => {}
            }
            second.is_none()
        });
        (found, second)
    }

    /// The line of a second `$ELSE` or of an `$ELSEIF` behind `$ELSE`. The given line is the one in which the blocks of the `$IF` begin.
    pub(super) fn misplaced(self, from: u32) -> Option<u32> {
        let (mut depth, mut has_else) = (0_usize, false);
        for (line, head) in self.section(from) {
            match mark(&line.text, &head) {
                Some(Mark::Open(_)) => depth += 1,
                Some(Mark::Close(_)) => depth = depth.checked_sub(1)?,
                Some(Mark::Other("ELSE" | "ELSEIF")) if depth == 0 && has_else => return Some(line.line),
                Some(Mark::Other("ELSE")) if depth == 0 => has_else = true,
                Some(Mark::Other(_)) | None => {}
            }
        }
        None
    }

    /// Calls a function for each label of a section, with its line and the control blocks that are open there, as long as it returns true.
    pub(super) fn each_label(self, section: u32, call: &mut dyn FnMut(&Target, u32, &[Opened]) -> bool) {
        let mut open = Vec::new();
        for (line, head) in self.section(section) {
            if head.label.as_ref().is_some_and(|label| !call(label, line.line, &open)) {
                return;
            }
            match mark(&line.text, &head) {
                Some(Mark::Open(structure)) => open.push((structure, Part { line: line.line, next: line.next })),
                Some(Mark::Close(_)) => {
                    open.pop();
                }
                Some(Mark::Other(_)) | None => {}
            }
        }
    }

    /// The names of all local subroutines, in capitals.
    pub(super) fn subroutines(self) -> BTreeSet<String> {
        let name = |line: Line<'_>| match header(&line.text) {
            Ok(Some(Header::Subroutine(name))) => Some(name.to_ascii_uppercase()),
            Ok(Some(Header::Main) | None) | Err(_) => None,
        };
        self.lines(1).filter_map(name).collect()
    }

    /// The first line from here on, outside further control blocks, that has one of these words or closes the control block.
    pub(super) fn part(self, structure: Structure, from: u32, words: &[&str]) -> Option<Part> {
        let mut open = Vec::new();
        for (line, head) in self.section(from) {
            match mark(&line.text, &head) {
                Some(Mark::Open(inner)) => open.push(inner),
                Some(Mark::Close(closed)) => match open.pop() {
                    Some(inner) if inner == closed => {}
                    None if closed == structure => return Some(Part { line: line.line, next: line.next }),
                    Some(_) | None => return None,
                },
                Some(Mark::Other(word)) if open.is_empty() && words.contains(&word) => {
                    return Some(Part { line: line.line, next: line.next });
                }
                Some(Mark::Other(_)) | None => {}
            }
        }
        None
    }
}

/// A control block and the line that opens it.
pub(super) type Opened = (Structure, Part);

/// A line of a control block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    pub(super) line: u32,
    /// The line behind it.
    pub(super) next: u32,
}

/// Whether a line has this M function.
pub(super) fn has_function(text: &str, function: &str) -> bool {
    text.match_indices(function).any(|(at, _)| {
        let before = text[..at].chars().next_back();
        let after = text[at + function.len()..].chars().next();
        !before.is_some_and(|letter| letter.is_ascii_alphabetic() || letter == '_')
            && !after.is_some_and(|letter| letter.is_ascii_alphanumeric())
    })
}
