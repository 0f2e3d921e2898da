//! Preparation, block by block. The channel calls [`Interpreter::next`] whenever its buffer has room; nothing is read ahead of that.

use std::sync::Arc;

use crate::nc_program::{Program, normalised};

use super::block::{End, Origin};
use super::compose::{Composed, compose, compose_command};
use super::fault::{
    Error, Fault, FaultCode, LABEL_TWICE, OPEN_AT_END, PERCENT_IN_GLOBAL_SUBROUTINE, PERCENT_IN_MAIN_PROGRAM,
};
use super::head::{Head, Target, head, header};
use super::lines::Line;
use super::parse::content;
use super::scope::{Owner, Scope, Store, is_read_only, owner};
use super::search::{Part, Structure, Text};
use super::state::{Interpreter, Level, Open, Prepared};
use super::syntax::{Content, HashCommand, Word};
use super::variables::{Environment, Refusal, Variables};

/// Lines in one call of `next`, so that an endless loop does not hold the channel.
const LINES: usize = 1000;

/// The number of nested calls; no source gives that of a control.
pub const DEEPEST_CALL: usize = 20;

/// A program with the line that is worked on.
pub(super) struct Work<'a> {
    pub(super) program: &'a Program,
    pub(super) line: &'a Line<'a>,
    pub(super) lenient: bool,
}

/// What happened to a line.
enum Step {
    Prepared(Prepared),
    /// There was nothing to execute.
    Next,
}

impl Interpreter {
    /// The next block to execute. Calculations, jumps, calls, comments and skipped blocks are dealt with inside; after 1000 lines of them
    /// the result is [`Prepared::Calculated`], and the channel calls again in its next cycle.
    ///
    /// # Errors
    /// A block cannot be read or has no possible value. Nothing of it has been executed, and the program has ended.
    pub fn next(&mut self, environment: &mut dyn Environment) -> Result<Prepared, Fault> {
        for _ in 0..LINES {
            match self.step(environment) {
                Ok(Step::Prepared(prepared)) => return Ok(prepared),
                Ok(Step::Next) => {}
                Err(fault) => {
                    self.levels.clear();
                    return Err(fault);
                }
            }
        }
        let Some(level) = self.levels.last() else { return Ok(Prepared::Ended) };
        let origin = Origin { program: level.program.clone(), line: level.line, ..Origin::default() };
        Ok(Prepared::Calculated(Box::new(origin)))
    }

    fn step(&mut self, environment: &mut dyn Environment) -> Result<Step, Fault> {
        let Some(level) = self.levels.last_mut() else { return Ok(Step::Prepared(Prepared::Ended)) };
        let Some(program) = environment.program(&level.program) else {
            let text = "the program does not exist any more".to_owned();
            let fault = Fault {
                code: FaultCode::Call,
                program: level.program.clone(),
                block: None,
                line: level.line.max(1),
                column: 1,
                text,
                pair: None,
            };
            return Err(fault);
        };
        if level.section == 0 {
            let is_skipped = |level| environment.is_skipped(level);
            let text = Text { program: &program, lenient: self.lenient, is_skipped: &is_skipped };
            level.section = text.main().map_err(|(line, error)| fault_in(&program, line, error))?;
            level.line = level.section;
        }
        let Some(line) = Line::read(&program, level.line, self.lenient) else {
            self.leave();
            return Ok(Step::Next);
        };
        let work = Work { program: &program, line: &line, lenient: self.lenient };
        let mut block = None;
        self.line(&work, environment, &mut block).map_err(|error| fault(&program, &line, block, error))
    }

    /// The end of a section: the caller goes on, or the program has ended.
    fn leave(&mut self) {
        self.levels.pop();
    }

    /// Goes on at a line of the innermost level.
    pub(super) fn go_to(&mut self, line: u32) {
        if let Some(level) = self.levels.last_mut() {
            level.line = line;
        }
    }

    fn line(
        &mut self,
        work: &Work<'_>,
        environment: &mut dyn Environment,
        block: &mut Option<u32>,
    ) -> Result<Step, Error> {
        let line = work.line;
        if line.text.trim().is_empty() {
            self.go_to(line.next);
            return Ok(Step::Next);
        }
        if header(&line.text)?.is_some() {
            return match self.levels.as_slice() {
                [.., level] if level.is_local => {
                    self.leave();
                    Ok(Step::Next)
                }
                levels => Err(percent(levels.len() > 1, line.indent())),
            };
        }
        let head = head(&line.text)?;
        *block = head.number;
        if head.skip.is_some_and(|level| environment.is_skipped(level)) {
            self.go_to(line.next);
            return Ok(Step::Next);
        }
        if let Some(next) = hidden(line)? {
            self.go_to(next);
            return Ok(Step::Next);
        }
        let content = content(&line.text, head.rest, work.lenient)?;
        whole(line, &content)?;
        let mut waits = false;
        content.for_each_variable(&mut |name| waits |= owner(name) == Owner::Channel && environment.waits(name));
        if waits && !environment.is_executed() {
            return Ok(Step::Prepared(Prepared::Waits(Box::new(origin(work, &head)))));
        }
        match content {
            Content::Empty => {
                self.go_to(line.next);
                Ok(Step::Next)
            }
            Content::Words(words) => self.words(&words, &head, work, environment),
            Content::Command(command) => self.command(&command, &head, work, environment),
            Content::Flow(flow) => {
                self.flow(&flow, head.rest, work, environment)?;
                Ok(Step::Next)
            }
        }
    }

    /// The variables as a block sees them.
    pub(super) fn scope<'a>(&'a self, environment: &'a dyn Variables, none: &'a Store) -> Scope<'a> {
        let level = self.levels.last().map_or(none, |level| &level.variables);
        Scope { program: &self.variables, level, channel: Some(environment), written: Vec::new() }
    }

    /// Writes what a block assigned: all of it, or nothing.
    pub(super) fn write(
        &mut self,
        written: Vec<(String, f64, usize)>,
        environment: &mut dyn Environment,
    ) -> Result<(), Error> {
        for (name, value, at) in &written {
            if owner(name) != Owner::Channel {
                continue;
            }
            let allowed = if is_read_only(name) { Err(Refusal::ReadOnly) } else { environment.may_write(name, *value) };
            if let Err(refusal) = allowed {
                let text = match refusal {
                    Refusal::Unknown => format!("{name} cannot be written: the channel has no such variable"),
                    Refusal::ReadOnly => format!("{name} cannot be written, only read"),
                    Refusal::Value => format!("{name} cannot have the value {value}"),
                };
                return Err(Error::value(*at, text));
            }
        }
        for (name, value, _) in written {
            match owner(&name) {
                Owner::Channel => environment.write(&name, value),
                Owner::Program => drop(self.variables.insert(name, value)),
                Owner::Level => {
                    if let Some(level) = self.levels.last_mut() {
                        level.variables.insert(name, value);
                    }
                }
            }
        }
        Ok(())
    }

    fn words(
        &mut self,
        words: &[Word],
        head: &Head,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<Step, Error> {
        let none = Store::new();
        let mut scope = self.scope(environment, &none);
        let composed = compose(words, &mut scope, work.lenient)?;
        let written = scope.written;
        if !work.lenient
            && self.levels.len() == 1
            && let Some(at) = composed.subroutine_end
        {
            return Err(Error::syntax(at, "M17 and M29 end a subroutine, and this is the main program; write M30"));
        }
        // What the block does later is looked for first: nothing of a faulty block is executed.
        let called =
            composed.call.as_ref().map(|(name, is_local, at)| self.called(name, *is_local, *at, work, environment));
        let called = called.transpose()?;
        let jump = composed.jump.as_ref().map(|(target, at)| self.label(target, *at, work, environment)).transpose()?;
        self.write(written, environment)?;
        self.go_to(work.line.next);
        if let Some((line, open)) = jump
            && let Some(level) = self.levels.last_mut()
        {
            (level.line, level.open) = (line, open);
        }
        let prepared = self.prepared(composed, head, work);
        if let Some(level) = called
            && !self.levels.is_empty()
        {
            self.levels.push(level);
        }
        Ok(prepared)
    }

    fn command(
        &mut self,
        command: &HashCommand,
        head: &Head,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Step, Error> {
        let none = Store::new();
        let composed = compose_command(command, &self.scope(environment, &none))?;
        self.go_to(work.line.next);
        Ok(self.prepared(composed, head, work))
    }

    /// The block, and the end of the level or the program.
    fn prepared(&mut self, mut composed: Composed, head: &Head, work: &Work<'_>) -> Step {
        let is_executable = composed.is_executable();
        let unclosed = self.levels.last().and_then(|level| level.open.iter().find(|open| open.is_unclosed));
        let block = &mut composed.block;
        if let (Some(_), Some(open)) = (block.end, unclosed) {
            let text = format!("the $IF in line {} has no $ENDIF", open.line);
            composed.warnings.push(Error::new(FaultCode::Number(OPEN_AT_END), 0, text));
        }
        block.end = block.end.map(|end| match (end, self.levels.len() > 1) {
            (End::Program, true) => End::Aborted,
            (End::Subroutine, false) => End::Program,
            (end, _) => end,
        });
        match block.end {
            Some(End::Subroutine) => self.leave(),
            Some(End::Program | End::Aborted) => self.levels.clear(),
            None => {}
        }
        if !is_executable {
            return Step::Next;
        }
        block.origin = origin(work, head);
        let warning = |error| fault(work.program, work.line, head.number, error);
        block.warnings = composed.warnings.into_iter().map(warning).collect();
        let two_signs = composed.two_signs.into_iter();
        block.two_signs =
            two_signs.map(|(name, error)| (name, fault(work.program, work.line, head.number, error))).collect();
        Step::Prepared(Prepared::Block(Box::new(composed.block)))
    }

    /// The level of a subroutine.
    fn called(
        &self,
        name: &str,
        is_local: bool,
        at: usize,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Level, Error> {
        let error = |text: String| Error::new(FaultCode::Call, at, text);
        if self.levels.len() > DEEPEST_CALL {
            return Err(error(format!("subroutines are nested more than {DEEPEST_CALL} deep; does one call itself?")));
        }
        let is_skipped = |level| environment.is_skipped(level);
        if is_local {
            let text = Text { program: work.program, lenient: work.lenient, is_skipped: &is_skipped };
            let section = text.subroutine(name).ok_or_else(|| {
                error(format!("the file has no local subroutine `%L {name}`; a subroutine in a file of its own is called with `L {name}`"))
            })?;
            return Ok(Level::local(work.program.path(), section));
        }
        let program: Arc<Program> = environment.find_program(&normalised(name)).ok_or_else(|| {
            error(format!("there is no program {name}; a local subroutine of this file is called with `LL {name}`"))
        })?;
        Ok(Level::main(program.path()))
    }

    /// The line of a label, and the control blocks that are open there.
    fn label(
        &self,
        target: &Target,
        at: usize,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<(u32, Vec<Open>), Error> {
        let is_skipped = |level| environment.is_skipped(level);
        let text = Text { program: work.program, lenient: work.lenient, is_skipped: &is_skipped };
        let (section, now) = self.levels.last().map_or((1, &[][..]), |level| (level.section, &level.open));
        let (found, second) = text.label(section, target);
        let (line, open) =
            found.ok_or_else(|| Error::syntax(at, format!("this program level has no label {target}")))?;
        if let Some(second) = second {
            return Err(label_twice(target, at, line, second));
        }
        let mut opened = Vec::with_capacity(open.len());
        for (structure, Part { line, next }) in open {
            if let Some(known) = now.iter().find(|known| known.line == line) {
                opened.push(Open { is_searching: false, ..known.clone() });
            } else if structure.is_loop() {
                let text = format!(
                    "the label {target} lies inside a loop that begins in line {line}; a jump cannot begin a loop"
                );
                return Err(Error::syntax(at, text));
            } else {
                opened.push(Open::new(structure, line, next));
            }
        }
        Ok((line, opened))
    }

    /// `$IF … $GOTO` jumps.
    pub(super) fn jump(
        &mut self,
        target: &Target,
        at: usize,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<(), Error> {
        let found = self.label(target, at, work, environment)?;
        if let Some(level) = self.levels.last_mut() {
            (level.line, level.open) = found;
        }
        Ok(())
    }
}

impl Open {
    /// A control block without values, whose branch is being executed.
    pub(super) fn new(structure: Structure, line: u32, next: u32) -> Self {
        Self {
            structure,
            line,
            next,
            is_searching: false,
            has_else: false,
            is_unclosed: false,
            value: 0.0,
            step: 0.0,
            variable: String::new(),
        }
    }
}

/// A label that stands twice in a program level.
pub(super) fn label_twice(target: &Target, at: usize, first: u32, second: u32) -> Error {
    let text =
        format!("the label {target} stands in line {first} and in line {second}; labels of a program level differ");
    Error::new(FaultCode::Number(LABEL_TWICE), at, text)
}

/// A `#` command stands in one line.
pub(super) fn whole(line: &Line<'_>, content: &Content) -> Result<(), Error> {
    match (line.broken, content) {
        (Some(at), Content::Command(_)) => {
            Err(Error::syntax(at, "a `#` command cannot be continued with `\\`; write it in one line"))
        }
        _ => Ok(()),
    }
}

/// A `%` in a main program that is being executed.
pub(super) fn percent(is_called: bool, at: usize) -> Error {
    let number = if is_called { PERCENT_IN_GLOBAL_SUBROUTINE } else { PERCENT_IN_MAIN_PROGRAM };
    let text = "`%` in a main program; it begins with the first line that is neither empty nor a comment, subroutines (`%L NAME`) stand before it, \
                and M30 ends it";
    Error::new(FaultCode::Number(number), at, text)
}

/// `#COMMENT BEGIN`: the line behind the `#COMMENT END`.
pub(super) fn hidden(line: &Line<'_>) -> Result<Option<u32>, Error> {
    if let Some(cursor) = line.ends_comment() {
        let text = "#COMMENT END without #COMMENT BEGIN before it";
        return Err(Error::syntax(cursor.at(), text));
    }
    let Some(mut cursor) = line.begins_comment() else { return Ok(None) };
    cursor.expect_end("#COMMENT BEGIN")?;
    let (end, has_text) =
        line.comment_end().ok_or_else(|| Error::syntax(0, "#COMMENT BEGIN without #COMMENT END behind it"))?;
    if has_text {
        return Err(Error::syntax(
            0,
            format!("something stands behind the #COMMENT END in line {end}; it stands alone"),
        ));
    }
    Ok(Some(end.saturating_add(1)))
}

fn origin(work: &Work<'_>, head: &Head) -> Origin {
    Origin {
        program: work.program.path(),
        line: work.line.line,
        number: head.number,
        label: head.label.as_ref().map(Target::to_string),
        skip: head.skip,
        text: work.line.source().to_owned(),
    }
}

/// The message of an error in a block.
pub(super) fn fault(program: &Program, line: &Line<'_>, block: Option<u32>, error: Error) -> Fault {
    let at = if error.at == 0 { line.indent() } else { error.at };
    let (number, column) = line.place(at);
    Fault { code: error.code, program: program.path(), block, line: number, column, text: error.text, pair: error.pair }
}

/// The message of an error in a line.
pub(super) fn fault_in(program: &Program, number: u32, error: Error) -> Fault {
    match Line::read(program, number, false) {
        Some(line) => fault(program, &line, head(&line.text).ok().and_then(|head| head.number), error),
        None => {
            let (code, text, pair) = (error.code, error.text, error.pair);
            Fault { code, program: program.path(), block: None, line: number, column: 1, text, pair }
        }
    }
}
