//! The static check of a program: every error of every line, one for each line, without a machine and without running it.
//!
//! Values that only a run knows are no errors, nor are names of axes. Blocks that are skipped or jumped over are read, too.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::nc_program::{Program, normalised};

use super::block::{Block, is_modelled};
use super::compose::{Composed, compose, compose_command};
use super::control::unexpected;
use super::fault::{Error, Fault, FaultCode, OPEN_AT_END};
use super::head::{Header, Target, head, header};
use super::interpreter::{fault, fault_in, hidden, label_twice, percent, whole};
use super::lines::Line;
use super::parse::content;
use super::scope::{Owner, Scope, Store, is_read_only, owner};
use super::search::{DEEPEST, Mark, Opened, Part, Structure, Text, mark, too_deep};
use super::syntax::{Content, Flow};

/// A finding of the check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What and where it is.
    pub fault: Fault,
    /// The program goes on after it.
    pub is_warning: bool,
}

/// Checks a program. Global subroutines (`L NAME`) are searched in `others`.
#[must_use]
pub fn check(program: &Program, others: &[Arc<Program>], lenient: bool) -> Vec<Finding> {
    let text = Text { program, lenient, is_skipped: &|_| false };
    let main = text.main();
    let mut checker = Checker {
        text,
        others,
        main: main.as_ref().map_or(0, |line| *line),
        subroutines: text.subroutines(),
        labels: BTreeMap::new(),
        is_subroutine: false,
        has_ended: false,
        open: Vec::new(),
        has_else: Vec::new(),
        findings: Vec::new(),
    };
    if let Err((line, error)) = main {
        checker.findings.push(Finding { fault: fault_in(program, line, error), is_warning: false });
    }
    checker.enter(1, false);
    let mut number = 1;
    while let Some(line) = Line::read(program, number, lenient) {
        number = checker.line(&line);
    }
    checker.unclosed();
    let mut findings = checker.findings;
    // One for each line: the first error, else the first warning.
    findings.sort_by_key(|finding| (finding.fault.line, finding.is_warning, finding.fault.column));
    findings.dedup_by_key(|finding| finding.fault.line);
    findings
}

/// Whether `L NAME` means this program: with its ending, or without.
#[must_use]
pub fn is_called(name: &str, program: &Program) -> bool {
    let (name, known) = (normalised(name), program.name());
    name == known || known.strip_suffix(".NC").is_some_and(|known| name == known)
}

/// What the control refuses on any machine. Values that only a run knows are not numbers.
fn possible(block: &Block, at: usize) -> Result<(), Error> {
    if let Some(g) = block.g.iter().find(|g| !is_modelled(**g)) {
        return Err(Error::value(at, format!("G{g} is not modelled")));
    }
    if block.feed.is_some_and(|feed| feed < 0.0) {
        return Err(Error::value(at, "F is not negative"));
    }
    match block.axes.iter().find(|(_, word)| word.abs() > FARTHEST) {
        Some((name, _)) => Err(Error::value(at, format!("{name} is too far"))),
        None => Ok(()),
    }
}

/// Farther in mm no word reaches, neither as a position nor as a way from any position of the control.
const FARTHEST: f64 = 2e7;

struct Checker<'a> {
    text: Text<'a>,
    others: &'a [Arc<Program>],
    /// The first line of the main program; 0: there is none.
    main: u32,
    /// Local subroutines, in capitals.
    subroutines: BTreeSet<String>,
    /// Labels of the section (main program or subroutine), with the lines of the loops around them.
    labels: BTreeMap<Target, Vec<u32>>,
    is_subroutine: bool,
    /// The section has a block that ends the program or the subroutine.
    has_ended: bool,
    open: Vec<Opened>,
    /// Of each open control block: it is an `$IF` that has had its `$ELSE`.
    has_else: Vec<bool>,
    findings: Vec<Finding>,
}

impl<'a> Checker<'a> {
    /// Checks a line and returns the next one.
    fn line(&mut self, line: &Line<'a>) -> u32 {
        if line.line == self.main {
            // It may follow a subroutine without a header line.
            self.enter(self.main, false);
        }
        let mut block = None;
        let mut next = line.next;
        let mut warnings = Vec::new();
        let result = self.read(line, &mut block, &mut next, &mut warnings);
        let is_failed = result.is_err();
        let errors = result.err().into_iter().map(|error| (error, false));
        let warnings = warnings.into_iter().filter(|_| !is_failed).map(|warning| (warning, true));
        for (error, is_warning) in errors.chain(warnings) {
            self.findings.push(Finding { fault: fault(self.text.program, line, block, error), is_warning });
        }
        next
    }

    /// A new section begins.
    fn enter(&mut self, section: u32, is_subroutine: bool) {
        self.unclosed();
        self.is_subroutine = is_subroutine;
        self.has_ended = false;
        self.labels.clear();
        let (labels, mut lines) = (&mut self.labels, BTreeMap::new());
        let mut twice = Vec::new();
        self.text.each_label(section, &mut |label, line, open| {
            let loops = open.iter().filter(|(structure, _)| structure.is_loop()).take(DEEPEST);
            if let Some(first) = lines.get(label) {
                twice.push((line, label_twice(label, 0, *first, line)));
            } else {
                lines.insert(label.clone(), line);
                labels.insert(label.clone(), loops.map(|(_, part)| part.line).collect());
            }
            true
        });
        let found = |(line, error)| Finding { fault: fault_in(self.text.program, line, error), is_warning: false };
        self.findings.extend(twice.into_iter().map(found));
    }

    fn read(
        &mut self,
        line: &Line<'a>,
        block: &mut Option<u32>,
        next: &mut u32,
        warnings: &mut Vec<Error>,
    ) -> Result<(), Error> {
        if line.text.trim().is_empty() {
            return Ok(());
        }
        if let Some(header) = header(&line.text)? {
            let is_main_running = self.main != 0 && line.line >= self.main && !self.is_subroutine && !self.has_ended;
            self.enter(line.next, matches!(header, Header::Subroutine(_)));
            // A main program that has not ended reaches this line.
            return if is_main_running { Err(percent(false, line.indent())) } else { Ok(()) };
        }
        let head = head(&line.text)?;
        *block = head.number;
        if line.begins_comment().is_some() && line.comment_end().is_none() {
            // All lines behind it are hidden.
            *next = self.text.program.count().saturating_add(1);
        }
        if let Some(behind) = hidden(line)? {
            *next = behind;
            return Ok(());
        }
        self.structure(mark(&line.text, &head), line, head.rest)?;
        let (none, at) = (Store::new(), head.rest);
        let mut scope = Scope { program: &none, level: &none, channel: None, written: Vec::new() };
        let content = content(&line.text, head.rest, self.text.lenient)?;
        whole(line, &content)?;
        let composed = match content {
            Content::Empty => return Ok(()),
            Content::Words(words) => compose(&words, &mut scope, self.text.lenient)?,
            Content::Command(command) => compose_command(&command, &scope)?,
            Content::Flow(flow) => {
                if let Flow::If(_, Some(target)) = flow {
                    return self.jump(&target, at);
                }
                return self.inside(&flow, at);
            }
        };
        if let Some((name, _, at)) = scope.written.iter().find(|(name, ..)| owner(name) == Owner::Channel) {
            let why = if is_read_only(name) { ", only read" } else { ": the channel has no such variable" };
            return Err(Error::value(*at, format!("{name} cannot be written{why}")));
        }
        self.composed(composed, at, warnings)
    }

    fn composed(&mut self, composed: Composed, at: usize, warnings: &mut Vec<Error>) -> Result<(), Error> {
        warnings.extend(composed.warnings);
        // Only a machine knows its modulo axes.
        warnings.extend(composed.two_signs.into_iter().map(|(_, error)| error));
        self.has_ended |= composed.block.end.is_some();
        possible(&composed.block, at)?;
        if self.is_subroutine
            && let Some(function) = composed.block.m.iter().find(|function| matches!(function, 2 | 30))
        {
            let text =
                format!("M{function:02} in a subroutine aborts the program; write M17, or M30 in the main program");
            warnings.push(Error::new(FaultCode::Call, at, text));
        }
        if let Some((target, at)) = composed.jump {
            self.jump(&target, at)?;
        }
        let Some((name, is_local, at)) = composed.call else { return Ok(()) };
        let is_known = match is_local {
            true => self.subroutines.contains(&name.to_ascii_uppercase()),
            false => is_called(&name, self.text.program) || self.others.iter().any(|other| is_called(&name, other)),
        };
        let text = match is_local {
            true => format!("the file has no local subroutine `%L {name}`"),
            false => format!("there is no program {name} among the files that are checked or beside them"),
        };
        if is_known { Ok(()) } else { Err(Error::new(FaultCode::Call, at, text)) }
    }

    fn jump(&self, target: &Target, at: usize) -> Result<(), Error> {
        let Some(loops) = self.labels.get(target) else {
            return Err(Error::syntax(at, format!("this program level has no label {target}")));
        };
        let is_entered = |line: u32| self.open.iter().any(|(_, part)| part.line == line);
        match loops.iter().find(|line| !is_entered(**line)) {
            Some(line) => {
                let text = format!(
                    "the label {target} lies inside a loop that begins in line {line}; a jump cannot begin a loop"
                );
                Err(Error::syntax(at, text))
            }
            None => Ok(()),
        }
    }

    /// Opens and closes control blocks.
    fn structure(&mut self, mark: Option<Mark<'_>>, line: &Line<'_>, at: usize) -> Result<(), Error> {
        match mark {
            Some(Mark::Open(structure)) => {
                self.open.push((structure, Part { line: line.line, next: line.next }));
                self.has_else.push(false);
                if self.open.len() > DEEPEST { Err(too_deep(at)) } else { Ok(()) }
            }
            Some(Mark::Close(structure)) => match self.open.last() {
                Some((open, _)) if *open == structure => {
                    self.open.pop();
                    self.has_else.pop();
                    Ok(())
                }
                Some(_) | None => {
                    let [word, end] = structure.words();
                    Err(unexpected(end, at, &format!("${end} without ${word} before it")))
                }
            },
            Some(Mark::Other(_)) | None => Ok(()),
        }
    }

    /// Parts of a control block stand inside it.
    fn inside(&mut self, flow: &Flow, at: usize) -> Result<(), Error> {
        let innermost = self.open.last().map(|(structure, _)| *structure);
        let has_else = self.has_else.last().copied().unwrap_or(false) && innermost == Some(Structure::If);
        if matches!(flow, Flow::Else)
            && innermost == Some(Structure::If)
            && let Some(has_else) = self.has_else.last_mut()
        {
            *has_else = true;
        }
        let (word, is_inside) = match flow {
            Flow::ElseIf(_) => ("ELSEIF", innermost == Some(Structure::If)),
            Flow::Else => ("ELSE", innermost == Some(Structure::If)),
            Flow::Case(_) => ("CASE", innermost == Some(Structure::Switch)),
            Flow::Default => ("DEFAULT", innermost == Some(Structure::Switch)),
            Flow::Break => {
                let is_left = |(structure, _): &Opened| structure.is_loop() || *structure == Structure::Switch;
                ("BREAK", self.open.iter().any(is_left))
            }
            Flow::Continue => ("CONTINUE", self.open.iter().any(|(structure, _)| structure.is_loop())),
            Flow::If(..)
            | Flow::EndIf
            | Flow::Switch(..)
            | Flow::EndSwitch
            | Flow::For { .. }
            | Flow::EndFor
            | Flow::While(_)
            | Flow::EndWhile
            | Flow::Do
            | Flow::Repeat
            | Flow::Until(_)
            | Flow::EndDo(_) => return Ok(()),
        };
        if has_else && matches!(flow, Flow::Else | Flow::ElseIf(_)) {
            return Err(unexpected(word, at, "the $IF has had its $ELSE already"));
        }
        if is_inside {
            Ok(())
        } else {
            Err(unexpected(word, at, &format!("${word} stands outside the control block that it belongs to")))
        }
    }

    /// The end of a section: what is open has no end.
    fn unclosed(&mut self) {
        self.has_else.clear();
        for (structure, part) in std::mem::take(&mut self.open) {
            let [word, end] = structure.words();
            // A program runs over an $IF without its end if the condition is true.
            let is_warning = self.text.lenient && structure == Structure::If;
            let code = if is_warning { FaultCode::Number(OPEN_AT_END) } else { FaultCode::Syntax };
            let error = Error::new(code, 0, format!("${word} has no ${end}"));
            self.findings.push(Finding { fault: fault_in(self.text.program, part.line, error), is_warning });
        }
    }
}
