//! Control structures, jumps and repetitions: where the program goes on.

use super::alarm::{Fault, Span};
use super::environment::Environment;
use super::expression::Expression;
use super::interpreter::Work;
use super::operator::{Operator, binary};
use super::search::{Bracket, StructureKind, Wanted, closing, left_by_jump, target};
use super::state::{Interpreter, Level, Repetition, Structure};
use super::syntax::{Direction, Jump, RepeatPart, Statement, Target};
use super::value::{Type, Value, integer};

impl Interpreter {
    /// Executes a statement that decides where the program goes on. Returns the line.
    pub(super) fn flow(
        &mut self,
        statement: &Statement,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<u32, Fault> {
        let next = work.line.saturating_add(1);
        match statement {
            Statement::If { condition, jump: Some(jump) } => {
                if self.holds(condition, work, environment)? {
                    self.jump(jump, work, environment)
                } else {
                    Ok(next)
                }
            }
            Statement::If { condition, jump: None } => {
                self.begin(StructureKind::If, work)?;
                if self.holds(condition, work, environment)? {
                    self.open(StructureKind::If, 0.0, work);
                    return Ok(next);
                }
                let (line, bracket) = end_of(StructureKind::If, true, work.line, work)?;
                if bracket == Bracket::Else {
                    self.open(StructureKind::If, 0.0, work);
                }
                Ok(line.saturating_add(1))
            }
            Statement::Else => {
                self.close(StructureKind::If, work)?;
                let (line, _) = end_of(StructureKind::If, false, work.line, work)?;
                Ok(line.saturating_add(1))
            }
            Statement::EndIf => self.close(StructureKind::If, work).map(|_| next),
            Statement::While(condition) => {
                self.begin(StructureKind::While, work)?;
                if self.holds(condition, work, environment)? {
                    self.open(StructureKind::While, 0.0, work);
                    return Ok(next);
                }
                let (line, _) = end_of(StructureKind::While, false, work.line, work)?;
                Ok(line.saturating_add(1))
            }
            // The condition is tested again in the block of WHILE.
            Statement::EndWhile => self.close(StructureKind::While, work).map(|structure| structure.line),
            Statement::RepeatLoop => {
                self.begin(StructureKind::Repeat, work)?;
                self.open(StructureKind::Repeat, 0.0, work);
                Ok(next)
            }
            Statement::Until(condition) => {
                let structure = self.innermost(StructureKind::Repeat)?;
                if self.holds(condition, work, environment)? {
                    self.close(StructureKind::Repeat, work)?;
                    return Ok(next);
                }
                Ok(structure.line.saturating_add(1))
            }
            Statement::Loop => {
                self.begin(StructureKind::Loop, work)?;
                self.open(StructureKind::Loop, 0.0, work);
                Ok(next)
            }
            Statement::EndLoop => self.innermost(StructureKind::Loop).map(|structure| structure.line.saturating_add(1)),
            Statement::For { variable, from, to, at } => self.begin_for(variable, (from, to), *at, work, environment),
            Statement::EndFor => self.end_for(work, environment),
            Statement::Case { selector, cases, default, at } => {
                let selected = self.value(selector, work, environment)?;
                for (value, jump) in cases {
                    let value = self.value(value, work, environment)?;
                    if binary(Operator::Equal, &selected, &value, *at)? == Value::Bool(true) {
                        return self.jump(jump, work, environment);
                    }
                }
                default.as_ref().map_or(Ok(next), |jump| self.jump(jump, work, environment))
            }
            Statement::Jump(jump) => self.jump(jump, work, environment),
            Statement::RepeatPart(part) => self.repeat_part(part, work, environment),
            Statement::Empty
            | Statement::Define { .. }
            | Statement::External
            | Statement::Procedure(_)
            | Statement::Call(_)
            | Statement::Return { .. }
            | Statement::Assign(_)
            | Statement::Words(_) => Ok(next),
        }
    }

    /// FOR: the first pass begins, or the program goes on behind ENDFOR.
    fn begin_for(
        &mut self,
        variable: &Expression,
        (from, to): (&Expression, &Expression),
        at: Span,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<u32, Fault> {
        self.begin(StructureKind::For, work)?;
        let first = self.number(from, at, work, environment)?;
        let last = self.number(to, at, work, environment)?;
        let end = if first > last { Some(end_of(StructureKind::For, false, work.line, work)?) } else { None };
        self.write(variable, Value::Real(first), at, work, environment)?;
        if let Some((line, _)) = end {
            return Ok(line.saturating_add(1));
        }
        self.open(StructureKind::For, last, work);
        Ok(work.line.saturating_add(1))
    }

    fn holds(&self, condition: &Expression, work: &Work<'_>, environment: &dyn Environment) -> Result<bool, Fault> {
        Ok(self.value_as(condition, Type::Bool, Span::default(), work, environment)? == Value::Bool(true))
    }

    fn number(
        &self,
        expression: &Expression,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<f64, Fault> {
        let value = self.value_as(expression, Type::Real, at, work, environment)?;
        Ok(value.number().unwrap_or_default())
    }

    /// A structure begins: it fits into the level, and it has an end.
    fn begin(&self, kind: StructureKind, work: &Work<'_>) -> Result<(), Fault> {
        let most = work.dialect.structures;
        if self.levels.last().is_some_and(|level| level.structures.len() >= most) {
            return Err(Fault::new(12641, Span::default(), format!("a program level has at most {most}")));
        }
        end_of(kind, false, work.line, work).map(drop)
    }

    fn open(&mut self, kind: StructureKind, last: f64, work: &Work<'_>) {
        if let Some(level) = self.levels.last_mut() {
            level.structures.push(Structure { kind, line: work.line, last });
        }
    }

    /// The innermost structure, if it has this kind.
    fn innermost(&self, kind: StructureKind) -> Result<Structure, Fault> {
        let found = self.levels.last().and_then(|level| level.structures.last());
        let found = found.filter(|structure| structure.kind == kind).copied();
        found.ok_or_else(|| Fault::new(12640, Span::default(), "this word has no beginning before it"))
    }

    fn close(&mut self, kind: StructureKind, _: &Work<'_>) -> Result<Structure, Fault> {
        let structure = self.innermost(kind)?;
        if let Some(level) = self.levels.last_mut() {
            level.structures.pop();
        }
        Ok(structure)
    }

    /// ENDFOR: one more, and again as long as the end value is not passed.
    fn end_for(&mut self, work: &Work<'_>, environment: &mut dyn Environment) -> Result<u32, Fault> {
        let structure = self.innermost(StructureKind::For)?;
        let (head, text) = work.program.head(structure.line).unwrap_or_default();
        let block = super::block::parse(text, work.dialect, work.axes)?;
        debug_assert!(head.label.is_none(), "a control structure has no label");
        let Statement::For { variable, at, .. } = block.statement else {
            return Err(Fault::new(12640, Span::default(), "FOR no longer exists"));
        };
        let value = self.number(&variable, at, work, environment)? + 1.0;
        self.write(&variable, Value::Real(value), at, work, environment)?;
        if value <= structure.last {
            return Ok(structure.line.saturating_add(1));
        }
        self.close(StructureKind::For, work)?;
        Ok(work.line.saturating_add(1))
    }

    fn jump(&mut self, jump: &Jump, work: &Work<'_>, environment: &dyn Environment) -> Result<u32, Fault> {
        let next = work.line.saturating_add(1);
        if jump.direction == Direction::Start {
            if !environment.is_restarting() {
                return Ok(next);
            }
            if let Some(level) = self.levels.last_mut() {
                level.restart();
            }
            return Ok(1);
        }
        let wanted = self.wanted(&jump.target, jump.at, work, environment)?;
        match target(work.program, &wanted, work.line, jump.direction) {
            Some(line) => {
                self.arrive(line, work);
                Ok(line)
            }
            None if jump.direction == Direction::BothSilent => Ok(next),
            None => {
                let side = match jump.direction {
                    Direction::Forward => "behind this block",
                    Direction::Backward => "before this block",
                    Direction::Both | Direction::BothSilent | Direction::Start => "in the program",
                };
                let reason = format!("no block {side} has this label or number");
                Err(Fault::new(14080, jump.at, reason).about(wanted.text()))
            }
        }
    }

    /// What a jump looks for. A name is a label, unless a STRING variable has it.
    fn wanted(
        &self,
        target: &Target,
        at: Span,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<Wanted, Fault> {
        let text = match target {
            Target::Start => return Ok(Wanted::Label(String::new())),
            Target::Number { is_main, digits } => {
                return Ok(Wanted::Number { is_main: *is_main, digits: digits.clone() });
            }
            Target::Name(name) => {
                let level = self.levels.last();
                let variable = level.and_then(|level| level.variables.get(level.variable(name)?));
                if !variable.is_some_and(|variable| matches!(variable.kind, Type::Text(_))) {
                    return Ok(Wanted::Label(name.clone()));
                }
                let variable = Expression::Variable { name: name.clone(), indices: Vec::new(), at };
                self.value_as(&variable, Type::Text(u16::MAX), at, work, environment)?
            }
            Target::Text(text) => self.value_as(text, Type::Text(u16::MAX), at, work, environment)?,
        };
        match text {
            Value::Text(text) => Ok(Wanted::new(&text)),
            _ => Err(Fault::new(12150, at, "a jump target is a text")),
        }
    }

    /// Leaves the structures and repetitions that do not contain the target.
    fn arrive(&mut self, line: u32, work: &Work<'_>) {
        let left = if line > work.line { left_by_jump(work.program, work.line, line, work.dialect) } else { 0 };
        let Some(level) = self.levels.last_mut() else { return };
        if line > work.line {
            let stay = level.structures.len().saturating_sub(left);
            level.structures.truncate(stay);
        } else {
            level.structures.retain(|structure| structure.line < line);
        }
        level.repetitions.retain(|repetition| (repetition.first..=repetition.last).contains(&line));
    }

    fn repeat_part(&mut self, part: &RepeatPart, work: &Work<'_>, environment: &dyn Environment) -> Result<u32, Fault> {
        let next = work.line.saturating_add(1);
        let passes = match &part.passes {
            Some(passes) => integer(self.number(passes, part.at, work, environment)?, part.at)?,
            None => 1,
        };
        let passes = u32::try_from(passes).ok().filter(|passes| *passes > 0);
        let passes = passes.ok_or_else(|| Fault::new(14013, part.at, "at least one pass"))?;
        let missing = |wanted: &Wanted| Fault::new(14082, part.at, "no block has this label").about(wanted.text());
        let wanted = self.wanted(&part.first, part.at, work, environment)?;
        // The part begins before the block, or else behind it.
        let before = target(work.program, &wanted, work.line.saturating_sub(1), Direction::Backward);
        let first = before.or_else(|| target(work.program, &wanted, work.line, Direction::Forward));
        let first = first.ok_or_else(|| missing(&wanted))?;
        let last = match (&part.last, part.is_block) {
            (_, true) => first,
            (Some(last), false) => {
                let wanted = self.wanted(last, part.at, work, environment)?;
                target(work.program, &wanted, first, Direction::Forward).ok_or_else(|| missing(&wanted))?
            }
            (None, false) => {
                let wanted = Wanted::Label("ENDLABEL".to_owned());
                let end = target(work.program, &wanted, first.saturating_sub(1), Direction::Forward);
                match end.filter(|end| first > work.line || *end < work.line) {
                    Some(end) => end,
                    None if first < work.line => work.line - 1,
                    None => return Err(missing(&wanted)),
                }
            }
        };
        if let Some(level) = self.levels.last_mut() {
            if level.repetitions.len() >= MOST_REPETITIONS {
                let reason = format!("at most {MOST_REPETITIONS} repetitions inside each other");
                return Err(Fault::new(12641, part.at, reason));
            }
            level.repetitions.push(Repetition { first, last, left: passes - 1, back: next });
        }
        Ok(first)
    }

    /// At the end of a repeated part: again, or back behind REPEAT.
    pub(super) fn repeat(&mut self) {
        let Some(level) = self.levels.last_mut() else { return };
        while let Some(repetition) = level.repetitions.last_mut()
            && level.line == repetition.last.saturating_add(1)
        {
            if repetition.left > 0 {
                repetition.left -= 1;
                level.line = repetition.first;
                return;
            }
            // An outer repetition can end at the same place.
            level.line = repetition.back;
            level.repetitions.pop();
        }
    }

    /// The end of a subprogram: the next pass, or back to the caller.
    pub(super) fn return_to_caller(&mut self) {
        match self.levels.last_mut() {
            Some(Level { passes, .. }) if *passes < 2 => self.leave(),
            Some(level) => {
                level.passes -= 1;
                level.restart();
            }
            None => {}
        }
    }
}

/// Running repetitions of a level, at most.
const MOST_REPETITIONS: usize = 8;

fn end_of(kind: StructureKind, stops_at_else: bool, line: u32, work: &Work<'_>) -> Result<(u32, Bracket), Fault> {
    let found = closing(work.program, line, kind, stops_at_else, work.dialect);
    found.ok_or_else(|| Fault::new(12640, Span::default(), "the control structure has no end"))
}
