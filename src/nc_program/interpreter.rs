//! Preparation, block by block. The channel calls [`Interpreter::next`] whenever its buffer has room; nothing is read ahead of that.
//!
//! An error leaves the interpreter before the block: it can be corrected and read again.

use std::sync::Arc;

use super::alarm::{Fault, ProgramAlarm, Span};
use super::block::parse;
use super::compose::compose;
use super::composer::Before;
use super::dialect::Dialect;
use super::environment::Environment;
use super::evaluate::evaluate;
use super::expression::Expression;
use super::function::Function;
use super::head::Head;
use super::macros::{define, expanded, is_definition};
use super::names::AxisNames;
use super::prepared::{Block, End, Origin, Prepared};
use super::scope::{Running, write};
use super::source::Program;
use super::state::{Interpreter, Level};
use super::syntax::{Declaration, Initial, SourceBlock, Statement, Word};
use super::value::{Type, Value};
use super::variables::{Content, Variable, index};
use super::vocabulary::Command;
use super::waiting::{Wait, wait};
use super::words::is_address;

/// Calculation blocks in one call, so that an endless loop does not hold the channel.
const CALCULATIONS: usize = 100; // as the documentation of `next` says

/// Lines without a statement in one call.
const LINES: usize = 10_000;

/// Why a block is not prepared.
#[derive(Debug)]
pub(super) enum Stopped {
    /// An error of the block.
    Fault(Fault),
    /// An error in the program that the block calls.
    Alarm(Box<ProgramAlarm>),
}

impl From<Fault> for Stopped {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// What the parts of the interpreter share while they work on a block.
pub(super) struct Work<'a> {
    pub(super) program: &'a Program,
    /// The line of the block.
    pub(super) line: u32,
    pub(super) dialect: &'static Dialect,
    pub(super) axes: &'a AxisNames,
}

impl Interpreter {
    /// The next block to be executed. After 100 blocks that only calculate, it returns the last one of them; call again.
    ///
    /// # Errors
    /// The alarm of a block. The interpreter stays before this block: the next call reads it again.
    pub fn next(&mut self, environment: &mut dyn Environment) -> Result<Prepared, ProgramAlarm> {
        for _ in 1..CALCULATIONS {
            match self.step(environment)? {
                Prepared::Calculated(_) => {}
                prepared @ (Prepared::Block(_) | Prepared::Before(_) | Prepared::Waits(_) | Prepared::Ended) => {
                    return Ok(prepared);
                }
            }
        }
        self.step(environment)
    }

    /// The next block of any kind, also one that only calculates, jumps or calls.
    ///
    /// # Errors
    /// The alarm of a block, as for [`next`](Self::next).
    pub fn step(&mut self, environment: &mut dyn Environment) -> Result<Prepared, ProgramAlarm> {
        let (dialect, axes) = (environment.dialect(), environment.axes());
        let Some(level) = self.levels.last() else { return Ok(Prepared::Ended) };
        let Some(program) = environment.program(&level.program) else {
            let name = level.program.clone();
            let fault = Fault::new(14011, Span::default(), "the program no longer exists").about(&name);
            return Err(fault.alarm(&name, &level.line.to_string(), level.line, ""));
        };
        for _ in 0..LINES {
            self.repeat();
            let Some(level) = self.levels.last() else { return Ok(Prepared::Ended) };
            let line = level.line;
            let Some((head, text)) = program.head(line) else { return self.end_of_text(&program) };
            if text[head.rest..].starts_with(dialect.comment) || text[head.rest..].trim().is_empty() {
                if self.stops_before(&head) {
                    return Ok(Prepared::Before(self.origin(&program, &head, line, text)));
                }
                self.go_to_next(line);
                continue;
            }
            let origin = self.origin(&program, &head, line, text);
            let alarm = |fault: Fault| fault.alarm(&origin.program, &origin.name, line, text);
            if let Some(skip) = head.skip_level(dialect.skip_level).map_err(alarm)?
                && environment.is_skipped(skip)
            {
                self.go_to_next(line);
                continue;
            }
            if self.is_stopped && !environment.is_executed() {
                return Ok(Prepared::Waits(origin));
            }
            self.is_stopped = false;
            if is_definition(text, head.rest) {
                if self.stops_before(&head) {
                    return Ok(Prepared::Before(origin));
                }
                if let Some(level) = self.levels.last_mut() {
                    define(&mut level.macros, text, head.rest, level.has_begun, dialect).map_err(alarm)?;
                    (level.line, level.is_at_start) = (line.saturating_add(1), false);
                }
                return Ok(Prepared::Calculated(origin));
            }
            let macros = self.levels.last().map_or(&[][..], |level| &level.macros);
            let replaced = expanded(text, head.rest, macros, dialect);
            let text = replaced.as_deref().unwrap_or(text);
            let alarm = |fault: Fault| fault.alarm(&origin.program, &origin.name, line, text);
            let block = parse(text, dialect, &axes).map_err(alarm)?;
            if is_calculation(&block.statement) && self.stops_before(&head) {
                return Ok(Prepared::Before(origin));
            }
            let may_run = match wait(&block.statement) {
                Wait::No => true,
                Wait::Executed => environment.is_executed(),
                Wait::AtRest => environment.is_executed() && environment.is_at_rest(),
            };
            if !may_run {
                return Ok(Prepared::Waits(origin));
            }
            let work = Work { program: &program, line, dialect, axes: &axes };
            return match self.execute(block, origin.clone(), &work, environment) {
                Ok(prepared) => Ok(prepared),
                Err(Stopped::Fault(fault)) => Err(alarm(fault)),
                Err(Stopped::Alarm(alarm)) => Err(*alarm),
            };
        }
        let Some(level) = self.levels.last() else { return Ok(Prepared::Ended) };
        Ok(Prepared::Calculated(self.origin(&program, &Head::default(), level.line, "")))
    }

    /// Whether preparation stops before this line; it does so once.
    fn stops_before(&mut self, head: &Head<'_>) -> bool {
        let is_target = self.levels.len() == 1 && self.target.as_ref().is_some_and(|target| target.is_head(head));
        if is_target {
            self.target = None;
        }
        is_target
    }

    fn go_to_next(&mut self, line: u32) {
        if let Some(level) = self.levels.last_mut() {
            level.line = line.saturating_add(1);
        }
    }

    fn origin(&self, program: &Program, head: &Head<'_>, line: u32, text: &str) -> Origin {
        let level = self.levels.last();
        Origin {
            program: program.path(),
            line,
            level: u8::try_from(self.levels.len().saturating_sub(1)).unwrap_or(u8::MAX),
            name: head.name(line),
            text: text.to_owned(),
            skip: head.skip.and_then(|digits| digits.parse().ok()),
            is_single_block_off: level.is_some_and(|level| level.is_single_block_off),
            is_display_off: level.is_some_and(|level| level.is_display_off),
        }
    }

    /// Behind the last line: an end of program is missing.
    fn end_of_text(&mut self, program: &Program) -> Result<Prepared, ProgramAlarm> {
        let open = self.levels.last().and_then(|level| level.structures.last().copied());
        let last = program.count().max(1);
        let (line, fault) = match open {
            Some(structure) => (
                structure.line,
                Fault::new(12640, Span::default(), "the control structure that begins here has no end"),
            ),
            None if self.ends_with_text && self.levels.len() == 1 => {
                self.levels.clear();
                return Ok(Prepared::Ended);
            }
            None => (last, Fault::new(14000, Span::default(), "M30, M2 or M17 is missing")),
        };
        let (head, text) = program.head(line).unwrap_or_default();
        Err(fault.alarm(&program.path(), &head.name(line), line, text))
    }

    fn execute(
        &mut self,
        block: SourceBlock,
        origin: Origin,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<Prepared, Stopped> {
        let (has_begun, is_at_start) =
            self.levels.last().map_or((true, false), |level| (level.has_begun, level.is_at_start));
        let is_declaration =
            matches!(block.statement, Statement::Define { .. } | Statement::External | Statement::Procedure(_));
        let next = work.line.saturating_add(1);
        let goes_to = match block.statement {
            Statement::Words(words) => return self.words(&words, origin, work, environment),
            Statement::Empty | Statement::External => next,
            Statement::Define { kind, variables, at } => {
                if has_begun {
                    return Err(Fault::new(14500, at, "DEF comes before the first executable block").into());
                }
                self.define(kind, &variables, work, environment)?;
                next
            }
            Statement::Procedure(procedure) => {
                if !is_at_start {
                    let number = if has_begun { 14500 } else { 14520 };
                    return Err(Fault::new(number, procedure.at, "PROC is the first block of a program").into());
                }
                self.enter(&procedure)?;
                next
            }
            Statement::Assign(assignments) => {
                self.assign(&assignments, work, environment)?;
                next
            }
            Statement::Call(call) => {
                let caller = self.levels.len();
                self.call(&call, work, environment)?;
                if let Some(level) = self.levels.get_mut(caller - 1) {
                    (level.line, level.has_begun, level.is_at_start) = (next, true, false);
                }
                return Ok(Prepared::Calculated(origin));
            }
            Statement::Return { at } => {
                if self.levels.len() < 2 {
                    return Err(Fault::new(14091, at, "RET in the main program").about("1").into());
                }
                self.return_to_caller();
                return Ok(Prepared::Calculated(origin));
            }
            flow => self.flow(&flow, work, environment)?,
        };
        if let Some(level) = self.levels.last_mut() {
            level.line = goes_to;
            // GOTOS begins the level again, with its definitions.
            if goes_to != 1 || !level.is_at_start {
                level.is_at_start = false;
                level.has_begun |= !is_declaration;
            }
        }
        Ok(Prepared::Calculated(origin))
    }

    /// The value of an expression in the innermost level.
    pub(super) fn value(
        &self,
        expression: &Expression,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Value, Fault> {
        let mut scope = Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
        evaluate(expression, &mut scope).map(|term| term.value)
    }

    /// The value of an expression as a type.
    pub(super) fn value_as(
        &self,
        expression: &Expression,
        kind: Type,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Value, Fault> {
        self.value(expression, work, environment)?.convert(kind, at)
    }

    fn words(
        &mut self,
        words: &[Word],
        origin: Origin,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<Prepared, Stopped> {
        let before = Before {
            dialect: work.dialect,
            modal: self.modal,
            feed: self.feed,
            offset: &self.offset,
            is_unseparated: self.is_unseparated,
            is_main: self.levels.len() < 2,
            needs_feed: true,
        };
        let mut scope = Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset };
        let mut done = compose(words, before, &mut scope)?;
        let at = words.first().map_or_else(Span::default, Word::at);
        let replacement = self.replacement(&mut done.auxiliary, at, work, environment)?;
        (self.modal, self.feed) = (done.modal, done.feed);
        self.offset.clone_from(&done.offset);
        self.is_stopped = done.stops_preparation;
        if let Some(level) = self.levels.last_mut() {
            level.line = work.line.saturating_add(1);
            (level.has_begun, level.is_at_start) = (true, false);
            level.is_single_block_off = done.single_block_off.unwrap_or(level.is_single_block_off);
        }
        match done.end {
            Some(End::Program) => self.levels.clear(),
            Some(End::Subprogram) => self.return_to_caller(),
            None => self.levels.extend(replacement),
        }
        if only_controls(words) {
            return Ok(Prepared::Calculated(origin));
        }
        let block = Block {
            origin,
            modal: done.modal,
            once: done.once,
            feed: done.feed,
            offset: done.offset,
            axes: done.axes,
            circle: done.circle,
            auxiliary: done.auxiliary,
            actions: done.actions,
            end: done.end,
            stops_preparation: done.stops_preparation,
        };
        self.is_unseparated = done.needs_separation || self.is_unseparated && !block.is_executable();
        Ok(Prepared::Block(Box::new(block)))
    }

    /// Writes a place of the innermost level.
    pub(super) fn write(
        &mut self,
        place: &Expression,
        value: Value,
        at: Span,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<(), Fault> {
        let place =
            Running { levels: &self.levels, environment, axes: work.axes, offset: &self.offset }.place(place)?;
        write(&place, value, (&mut self.levels, &mut self.offset), environment, at)
    }

    /// DEF: all variables of the block, or none.
    fn define(
        &mut self,
        kind: Type,
        declarations: &[Declaration],
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<(), Fault> {
        let count = self.levels.last().map_or(0, |level| level.variables.len());
        for declaration in declarations {
            let variable = match self.declared(kind, declaration, work, environment) {
                Ok(variable) => variable,
                Err(fault) => {
                    if let Some(level) = self.levels.last_mut() {
                        level.variables.truncate(count);
                    }
                    return Err(fault);
                }
            };
            if let Some(level) = self.levels.last_mut() {
                level.variables.push(variable);
            }
        }
        Ok(())
    }

    fn declared(
        &self,
        kind: Type,
        declaration: &Declaration,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Variable, Fault> {
        let at = declaration.at;
        let is_known = self.levels.last().is_some_and(|level| level.variable(&declaration.name).is_some());
        if let Some(reason) = taken(&declaration.name, is_known, work.axes, work.dialect) {
            return Err(Fault::new(12170, at, reason));
        }
        let mut dimensions = Vec::new();
        for size in &declaration.dimensions {
            let size = index(&self.value(size, work, environment)?, at)?;
            dimensions.push(u32::try_from(size).map_err(|_| Fault::new(12430, at, "a dimension is positive"))?);
        }
        let mut variable = Variable::new(&declaration.name, kind, dimensions, at)?;
        let Content::Values(values) = &mut variable.content else { return Ok(variable) };
        match &declaration.initial {
            Initial::None => {}
            Initial::All(value, count) => {
                let value = self.value_as(value, kind, at, work, environment)?;
                let room = values.len();
                let count = match count {
                    Some(count) => usize::try_from(index(&self.value(count, work, environment)?, at)?).unwrap_or(0),
                    None => room,
                };
                if count > room {
                    return Err(Fault::new(12260, at, format!("{count} values, the variable has {room}")));
                }
                values[..count].fill(value);
            }
            Initial::Values(list) => {
                if list.len() > values.len() {
                    let reason = format!("{} values, the variable has {}", list.len(), values.len());
                    return Err(Fault::new(12260, at, reason));
                }
                for (place, value) in
                    values.iter_mut().zip(list).filter_map(|(place, value)| Some((place, value.as_ref()?)))
                {
                    *place = self.value_as(value, kind, at, work, environment)?;
                }
            }
        }
        Ok(variable)
    }
}

/// Whether the words of a block only control preparation and single block.
fn only_controls(words: &[Word]) -> bool {
    let controls =
        |command| matches!(command, Command::StopPreparation | Command::SingleBlockOff | Command::SingleBlockOn);
    matches!(words, [Word::Command { command, .. }] if controls(*command))
}

/// Whether a block is never executed by the channel.
fn is_calculation(statement: &Statement) -> bool {
    !matches!(statement, Statement::Words(words) if !only_controls(words))
}

/// Why a name cannot be a new variable.
pub(super) fn taken(name: &str, is_known: bool, axes: &AxisNames, dialect: &Dialect) -> Option<&'static str> {
    if is_known {
        Some("the program has a variable of this name")
    } else if axes.find(name).is_some() {
        Some("an axis has this name")
    } else if dialect.function(name).is_some() || Command::find(name).is_some() || dialect.refused(name).is_some() {
        Some("the language has a word of this name")
    } else if is_address(name) || Function::find(name).is_some() {
        Some("the language has an address or a function of this name")
    } else {
        None
    }
}

/// The first line of a program with a statement.
pub(super) fn first_statement(program: &Arc<Program>, dialect: &Dialect) -> Option<u32> {
    (1..=program.count()).find(|line| {
        program.head(*line).is_some_and(|(head, text)| {
            let rest = text[head.rest..].trim_start();
            !rest.is_empty() && !rest.starts_with(dialect.comment)
        })
    })
}

impl Level {
    /// The level begins its program again.
    pub(super) fn restart(&mut self) {
        self.line = 1;
        (self.is_at_start, self.has_begun) = (true, false);
        self.variables.truncate(self.parameters);
        self.structures.clear();
        self.macros.clear();
        self.repetitions.clear();
    }
}
