//! The static check of a program: every alarm that preparation could give, without running it. Values that only a run knows are replaced by
//! their types, so only errors of types are found in them.
//!
//! What depends on the way that the program takes (the modal G1 of a circle parameter, a missing F, MSG after MSG) is only judged up to the
//! first label, jump, call or control structure: behind it the way is not known.

use super::alarm::{Fault, ProgramAlarm, Span};
use super::assign::judge;
use super::block::parse;
use super::call::{is_same, judged};
use super::compose::compose;
use super::composer::Before;
use super::dialect::Dialect;
use super::evaluate::{Certainty, evaluate, evaluate_all};
use super::expression::Expression;
use super::functions::Modal;
use super::head::{Head, word};
use super::interpreter::{first_statement, taken};
use super::known::{Known, Last};
use super::macros::{Macro, define, expanded, is_definition};
use super::names::AxisNames;
use super::operator::{Operator, binary};
use super::prepared::End;
use super::search::{Bracket, StructureKind, Wanted, bracket, target};
use super::source::{Library, Program, ProgramKind, Request, requested};
use super::syntax::{
    Call, Called, Declaration, Direction, Initial, Jump, Procedure, RepeatPart, Statement, Target, Word,
};
use super::value::{Type, Value};
use super::variables::{Variable, index};
use super::vocabulary::is_keyword;

/// A finding of the check.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum CheckFinding {
    /// Preparation can raise this alarm.
    Alarm(ProgramAlarm),
    /// The block does something else than it seems.
    Warning {
        /// The line, counted from one.
        line: u32,
        /// The column, counted from one.
        column: u32,
        /// What is meant, and what to write.
        text: String,
    },
}

impl CheckFinding {
    /// The line and the column, counted from one.
    #[must_use]
    pub fn place(&self) -> (u32, u32) {
        match self {
            Self::Alarm(alarm) => (alarm.line, alarm.column),
            Self::Warning { line, column, .. } => (*line, *column),
        }
    }
}

/// Checks a program. Subprograms are searched in the library.
#[must_use]
pub fn check(program: &Program, library: &Library, axes: &AxisNames, dialect: &'static Dialect) -> Vec<CheckFinding> {
    let mut checker = Checker {
        program,
        library,
        dialect,
        known: Known { axes, variables: Vec::new(), is_incomplete: false },
        structures: Vec::new(),
        modal: Modal::default(),
        feed: None,
        is_unseparated: false,
        has_begun: false,
        is_at_start: true,
        is_straight: true,
        last: Last::Nothing,
        macros: Vec::new(),
        undefined: Vec::new(),
        findings: Vec::new(),
    };
    for line in 1..=program.count() {
        checker.line(line);
    }
    checker.end();
    checker.findings.sort_by_key(CheckFinding::place);
    checker.findings
}

struct Checker<'a> {
    program: &'a Program,
    library: &'a Library,
    dialect: &'static Dialect,
    known: Known<'a>,
    structures: Vec<(StructureKind, u32)>,
    modal: Modal,
    feed: Option<f64>,
    is_unseparated: bool,
    has_begun: bool,
    is_at_start: bool,
    /// No label, jump, call or control structure has come yet.
    is_straight: bool,
    last: Last,
    macros: Vec<Macro>,
    /// The words of DEF and PROC blocks with an alarm: alarms of blocks that use them would only follow from it.
    undefined: Vec<String>,
    findings: Vec<CheckFinding>,
}

/// The words of a block that can be names, in capital letters.
fn names(text: &str, comment: char) -> impl Iterator<Item = String> {
    let words = text.split(comment).next().unwrap_or_default().split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    words.filter(|word| word.starts_with(|c: char| !c.is_ascii_digit())).map(str::to_uppercase)
}

impl Checker<'_> {
    fn line(&mut self, line: u32) {
        let Some((head, text)) = self.program.head(line) else { return };
        let rest = text[head.rest..].trim();
        if rest.is_empty() || rest.starts_with(self.dialect.comment) {
            self.is_straight &= head.label.is_none();
            return;
        }
        self.is_straight &= head.label.is_none();
        if is_definition(text, head.rest) {
            self.last = Last::GoesOn;
            if let Err(fault) = define(&mut self.macros, text, head.rest, self.has_begun, self.dialect) {
                self.raise(fault, &head, line, text);
            }
            self.is_at_start = false;
            return;
        }
        let replaced = expanded(text, head.rest, &self.macros, self.dialect);
        let text = replaced.as_deref().unwrap_or(text);
        let result = parse(text, self.dialect, self.known.axes);
        let structure = bracket(text, head.rest, self.dialect);
        if let Some(bracket) = structure {
            self.is_straight = false;
            if let Err(fault) = self.structure(bracket, line) {
                self.raise(fault, &head, line, text);
            }
        }
        let block = match result {
            Ok(block) => block,
            Err(fault) => {
                let defines = ["DEF", "PROC"].contains(&word(text, head.rest).to_uppercase().as_str());
                self.known.is_incomplete |= defines;
                self.last = Last::Unknown;
                self.raise(fault, &head, line, text);
                if defines {
                    self.undefined
                        .extend(names(&text[head.rest..], self.dialect.comment).filter(|name| !is_keyword(name)));
                }
                return;
            }
        };
        for span in &block.warnings {
            let column = text.get(..span.from as usize).map_or(1, |before| before.chars().count() + 1);
            let text = "the comparison binds weaker than AND, OR, XOR and NOT beside it: write parentheses, as in \
                        (R1==2) AND (R2==3)";
            let (column, text) = (u32::try_from(column).unwrap_or(u32::MAX), text.to_owned());
            self.findings.push(CheckFinding::Warning { line, column, text });
        }
        self.last = Last::GoesOn;
        if let Err(fault) = self.statement(&block.statement, line) {
            self.last = Last::Unknown;
            self.raise(fault, &head, line, text);
        }
        self.is_at_start = false;
    }

    fn raise(&mut self, fault: Fault, head: &Head<'_>, line: u32, text: &str) {
        if names(&text[head.rest..], self.dialect.comment).any(|name| self.undefined.contains(&name)) {
            return;
        }
        let alarm = fault.alarm(&self.program.path(), &head.name(line), line, text);
        self.findings.push(CheckFinding::Alarm(alarm));
    }

    /// What is missing at the end of the text.
    fn end(&mut self) {
        for (_, line) in std::mem::take(&mut self.structures) {
            if let Some((head, text)) = self.program.head(line) {
                let fault = Fault::new(12640, Span::default(), "the control structure that begins here has no end");
                self.raise(fault, &head, line, text);
            }
        }
        if matches!(self.last, Last::Nothing | Last::GoesOn) {
            let line = self.program.count().max(1);
            let (head, text) = self.program.head(line).unwrap_or_default();
            let fault = Fault::new(14000, Span::default(), "M30, M2 or M17 is missing behind the last block");
            self.raise(fault, &head, line, text);
        }
    }

    fn structure(&mut self, bracket: Bracket, line: u32) -> Result<(), Fault> {
        let wrong = || Fault::new(12640, Span::default(), "this word has no beginning before it, or is crossed");
        match bracket {
            Bracket::Opens(kind) => {
                self.structures.push((kind, line));
                if self.structures.len() > self.dialect.structures {
                    let reason = format!("a program level has at most {}", self.dialect.structures);
                    return Err(Fault::new(12641, Span::default(), reason));
                }
            }
            Bracket::Else if self.structures.last().is_some_and(|(kind, _)| *kind == StructureKind::If) => {}
            Bracket::Closes(kind) if self.structures.last().is_some_and(|(open, _)| *open == kind) => {
                self.structures.pop();
            }
            Bracket::Else | Bracket::Closes(_) => return Err(wrong()),
        }
        Ok(())
    }

    fn statement(&mut self, statement: &Statement, line: u32) -> Result<(), Fault> {
        let (has_begun, is_at_start) = (self.has_begun, self.is_at_start);
        match statement {
            Statement::Define { kind, variables, at } => {
                if has_begun {
                    return Err(Fault::new(14500, *at, "DEF comes before the first executable block"));
                }
                return variables.iter().try_for_each(|one| self.define(*kind, one));
            }
            Statement::Empty | Statement::External => return Ok(()),
            Statement::Procedure(procedure) => {
                if !is_at_start {
                    let number = if has_begun { 14500 } else { 14520 };
                    return Err(Fault::new(number, procedure.at, "PROC is the first block of a program"));
                }
                return self.procedure(procedure);
            }
            _ => self.has_begun = true,
        }
        match statement {
            Statement::If { condition, jump } => {
                self.term_as(condition, Type::Bool, Span::default())?;
                jump.as_ref().map_or(Ok(()), |jump| self.jump(jump, line))
            }
            Statement::While(condition) | Statement::Until(condition) => {
                self.term_as(condition, Type::Bool, Span::default())
            }
            Statement::For { variable, from, to, at } => {
                self.term_as(from, Type::Real, *at)?;
                self.term_as(to, Type::Real, *at)?;
                self.term_as(variable, Type::Real, *at)
            }
            Statement::EndLoop => {
                self.last = Last::Ends;
                Ok(())
            }
            Statement::Case { selector, cases, default, at } => {
                let selected = evaluate(selector, &mut self.known)?;
                for (value, jump) in cases {
                    let value = evaluate(value, &mut self.known)?;
                    let is_known = selected.certainty.min(value.certainty) > Certainty::Nothing;
                    if is_known {
                        binary(Operator::Equal, &selected.value, &value.value, *at)?;
                    }
                    self.jump(jump, line)?;
                }
                default.as_ref().map_or(Ok(()), |jump| self.jump(jump, line))
            }
            Statement::Jump(jump) => {
                if !matches!(jump.direction, Direction::Start | Direction::BothSilent) {
                    self.last = Last::Ends;
                }
                self.jump(jump, line)
            }
            Statement::RepeatPart(part) => self.repeat_part(part, line),
            Statement::Call(call) => self.call(call),
            Statement::Return { at } => {
                self.last = Last::Ends;
                if self.program.kind() == ProgramKind::Main {
                    return Err(Fault::new(14091, *at, "RET in the main program").about("1"));
                }
                Ok(())
            }
            Statement::Assign(assignments) => assignments.iter().try_for_each(|one| judge(&mut self.known, one)),
            Statement::Words(words) => self.words(words),
            Statement::Empty
            | Statement::Define { .. }
            | Statement::External
            | Statement::Procedure(_)
            | Statement::Else
            | Statement::EndIf
            | Statement::EndWhile
            | Statement::RepeatLoop
            | Statement::Loop
            | Statement::EndFor => Ok(()),
        }
    }

    /// Whether an expression can be of a type.
    fn term_as(&mut self, expression: &Expression, kind: Type, at: Span) -> Result<(), Fault> {
        evaluate(expression, &mut self.known)?.convert(kind, at).map(|_| ())
    }

    fn words(&mut self, words: &[Word]) -> Result<(), Fault> {
        let is_main = self.program.kind() == ProgramKind::Main;
        let before = Before {
            dialect: self.dialect,
            modal: self.modal,
            feed: self.feed,
            offset: &[],
            is_unseparated: self.is_unseparated && self.is_straight,
            is_main,
            needs_feed: is_main && self.is_straight,
        };
        let done = match compose(words, before, &mut self.known) {
            // The modal function may be another one, on another way.
            Err(fault) if fault.number == 15460 && !self.is_straight => return Ok(()),
            other => other?,
        };
        (self.modal, self.feed) = (done.modal, done.feed);
        let is_executable =
            !done.axes.is_empty() || !done.auxiliary.is_empty() || !done.actions.is_empty() || done.end.is_some();
        self.is_unseparated = done.needs_separation || self.is_unseparated && !is_executable;
        if matches!(done.end, Some(End::Program | End::Subprogram)) {
            self.last = Last::Ends;
        }
        Ok(())
    }

    fn define(&mut self, kind: Type, declaration: &Declaration) -> Result<(), Fault> {
        let at = declaration.at;
        let is_known = self.known.variables.iter().any(|variable| variable.name == declaration.name);
        if let Some(reason) = taken(&declaration.name, is_known, self.known.axes, self.dialect) {
            return Err(Fault::new(12170, at, reason));
        }
        let mut dimensions = Vec::new();
        for term in evaluate_all(&declaration.dimensions, &mut self.known)? {
            let size = if term.is_known() { index(&term.value, at)? } else { 1 };
            dimensions.push(u32::try_from(size).map_err(|_| Fault::new(12430, at, "a dimension is positive"))?);
        }
        let count: u32 = dimensions.iter().fold(1, |count, size| count.saturating_mul(*size));
        let variable = Variable::new(&declaration.name, kind, dimensions, at)?;
        self.known.variables.push(variable);
        let values = match &declaration.initial {
            Initial::None => return Ok(()),
            Initial::All(value, _) => return self.term_as(value, kind, at),
            Initial::Values(values) => values,
        };
        if values.len() > count as usize {
            return Err(Fault::new(12260, at, format!("{} values, the variable has {count}", values.len())));
        }
        values.iter().flatten().try_for_each(|value| self.term_as(value, kind, at))
    }

    fn procedure(&mut self, procedure: &Procedure) -> Result<(), Fault> {
        for parameter in &procedure.parameters {
            if self.known.variables.iter().any(|variable| variable.name == parameter.name) {
                return Err(Fault::new(12170, procedure.at, "two parameters of PROC").about(parameter.name.clone()));
            }
            if let Some(default) = &parameter.default {
                self.term_as(default, parameter.kind, procedure.at)?;
            }
            // The caller decides the sizes of an array: no index of it is outside.
            let mut variable = Variable::new(&parameter.name, parameter.kind, Vec::new(), procedure.at)?;
            variable.dimensions = vec![u32::MAX; parameter.dimensions];
            self.known.variables.push(variable);
        }
        Ok(())
    }

    fn jump(&mut self, jump: &Jump, line: u32) -> Result<(), Fault> {
        self.is_straight = false;
        if matches!(jump.direction, Direction::Start | Direction::BothSilent) {
            return Ok(());
        }
        let Some(wanted) = self.wanted(&jump.target, jump.at)? else { return Ok(()) };
        if target(self.program, &wanted, line, jump.direction).is_some() {
            return Ok(());
        }
        let reason = "no block in the direction of the jump has this label or number";
        Err(Fault::new(14080, jump.at, reason).about(wanted.text()))
    }

    /// The target, if it is known without running the program.
    fn wanted(&mut self, target: &Target, at: Span) -> Result<Option<Wanted>, Fault> {
        match target {
            Target::Start => Ok(None),
            Target::Number { is_main, digits } => {
                Ok(Some(Wanted::Number { is_main: *is_main, digits: digits.clone() }))
            }
            Target::Name(name) => {
                let text = |variable: &Variable| variable.name == *name && matches!(variable.kind, Type::Text(_));
                let is_variable = self.known.variables.iter().any(text);
                Ok((!is_variable).then(|| Wanted::Label(name.clone())))
            }
            Target::Text(text) => {
                let term = evaluate(text, &mut self.known)?.convert(Type::Text(u16::MAX), at)?;
                match term.value {
                    Value::Text(ref text) if term.is_known() => Ok(Some(Wanted::new(text))),
                    _ => Ok(None),
                }
            }
        }
    }

    fn repeat_part(&mut self, part: &RepeatPart, line: u32) -> Result<(), Fault> {
        self.is_straight = false;
        self.passes(part.passes.as_ref(), part.at)?;
        let missing = |wanted: &Wanted| Err(Fault::new(14082, part.at, "no block has this label").about(wanted.text()));
        let Some(wanted) = self.wanted(&part.first, part.at)? else { return Ok(()) };
        let before = target(self.program, &wanted, line.saturating_sub(1), Direction::Backward);
        let Some(first) = before.or_else(|| target(self.program, &wanted, line, Direction::Forward)) else {
            return missing(&wanted);
        };
        if let Some(last) = &part.last {
            let Some(wanted) = self.wanted(last, part.at)? else { return Ok(()) };
            if target(self.program, &wanted, first, Direction::Forward).is_none() {
                return missing(&wanted);
            }
        }
        Ok(())
    }

    fn passes(&mut self, passes: Option<&Expression>, at: Span) -> Result<(), Fault> {
        let Some(passes) = passes else { return Ok(()) };
        let term = evaluate(passes, &mut self.known)?.convert(Type::Int, at)?;
        match term.value {
            Value::Int(number) if term.is_known() && number <= 0 => Err(Fault::new(14013, at, "at least one pass")),
            _ => Ok(()),
        }
    }

    fn call(&mut self, call: &Call) -> Result<(), Fault> {
        self.is_straight = false;
        self.passes(call.passes.as_ref(), call.at)?;
        let text = match &call.program {
            Called::Name(name) => name.clone(),
            Called::Text(text) | Called::External(text) => {
                let term = evaluate(text, &mut self.known)?.convert(Type::Text(u16::MAX), call.at)?;
                match term.value {
                    Value::Text(ref text) if term.is_known() => text.clone(),
                    _ => return Ok(()),
                }
            }
        };
        let (name, folder) = requested(&text);
        let found = self.library.find(&Request { name: &name, folder, caller: self.program.folder() });
        let program =
            found.ok_or_else(|| Fault::new(14011, call.at, "no such program in the search path").about(name))?;
        let procedure = first_statement(&program, self.dialect).and_then(|line| {
            let block = parse(program.line(line)?, self.dialect, self.known.axes).ok()?;
            if let Statement::Procedure(procedure) = block.statement { Some(procedure) } else { None }
        });
        let arguments = call.arguments.as_deref().unwrap_or_default();
        let Some(procedure) = procedure else {
            if arguments.is_empty() {
                return Ok(());
            }
            return Err(Fault::new(14510, call.at, format!("{} has no PROC", program.name())));
        };
        self.arguments(&procedure, arguments, call.at)
    }

    fn arguments(&mut self, procedure: &Procedure, arguments: &[Option<Expression>], at: Span) -> Result<(), Fault> {
        if arguments.len() > procedure.parameters.len() {
            let reason = format!("{} parameters, PROC has {}", arguments.len(), procedure.parameters.len());
            return Err(Fault::new(12340, at, reason));
        }
        for (index, parameter) in procedure.parameters.iter().enumerate() {
            let name = parameter.name.as_str();
            match arguments.get(index).and_then(Option::as_ref) {
                None if parameter.is_reference => {
                    return Err(Fault::new(12300, at, "a VAR parameter is missing").about(name));
                }
                None if parameter.default.is_none() && parameter.kind == Type::Axis => {
                    return Err(Fault::new(14010, at, format!("{name} was omitted")));
                }
                None => {}
                Some(given) if parameter.is_reference => {
                    let kind = match given {
                        Expression::RParameter { .. } => Type::Real,
                        Expression::Variable { name: given, .. } => {
                            let found = self.known.variables.iter().find(|variable| variable.name == *given);
                            match found {
                                Some(variable) => variable.kind,
                                None if self.known.is_incomplete => continue,
                                None => return Err(Fault::new(12550, at, "the variable is not defined").about(given)),
                            }
                        }
                        _ => return Err(Fault::new(12320, at, "a VAR parameter needs a variable").about(name)),
                    };
                    if !is_same(kind, parameter.kind) {
                        let reason = format!("a variable of type {} is needed", parameter.kind.name());
                        return Err(Fault::new(12330, at, reason).about(name));
                    }
                }
                Some(_) if parameter.dimensions > 0 => {}
                Some(given) => {
                    judged(given, parameter.kind, at, &mut self.known).map_err(|fault| match fault.number {
                        12330 => fault.about(name),
                        _ => fault,
                    })?;
                }
            }
        }
        Ok(())
    }
}
