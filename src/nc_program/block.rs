//! The parser of a block: its statement. A block is read when preparation reaches it, never before.

use super::alarm::{Fault, Span};
use super::dialect::Dialect;
use super::expression::{Expression, Parser};
use super::head::{head, significant};
use super::names::AxisNames;
use super::syntax::{
    Address, Call, Called, Declaration, Direction, Initial, Jump, Parameter, Procedure, RepeatPart, SourceBlock,
    Statement, Target, Word,
};
use super::token::{Kind, Symbol, tokens};
use super::value::{Type, Value};
use super::vocabulary::is_keyword;
use super::words::Item;

/// Reads a block.
pub(super) fn parse(line: &str, dialect: &Dialect, axes: &AxisNames) -> Result<SourceBlock, Fault> {
    let head = head(line);
    let skip = head.skip_level(dialect.skip_level)?;
    if let Some(label) = head.label
        && label.len() > dialect.name_length
    {
        let reason = format!("{} characters, at most {} are allowed", label.len(), dialect.name_length);
        return Err(Fault::new(12420, head.label_at, reason));
    }
    let tokens = tokens(line, head.rest, dialect, axes)?;
    let end = u32::try_from(line.trim_end().len()).unwrap_or(u32::MAX);
    let mut parser = Parser::new(&tokens, end, dialect, axes);
    let statement = parser.statement()?;
    let is_structure = matches!(
        statement,
        Statement::If { jump: None, .. }
            | Statement::Else
            | Statement::EndIf
            | Statement::While(_)
            | Statement::EndWhile
            | Statement::RepeatLoop
            | Statement::Until(_)
            | Statement::Loop
            | Statement::EndLoop
            | Statement::For { .. }
            | Statement::EndFor
    );
    if is_structure && (skip.is_some() || head.label.is_some()) {
        let at = if skip.is_some() { head.skip_at } else { head.label_at };
        return Err(Fault::new(12630, at, "write it in the block before or behind"));
    }
    if !parser.is_at_end() {
        return Err(parser.syntax(match parser.is_symbol(0, Symbol::Assign) {
            true => "nothing more is expected here; a comparison is written with `==`",
            false => "nothing more is expected here",
        }));
    }
    Ok(SourceBlock { skip, statement, warnings: parser.warnings })
}

impl Parser<'_> {
    fn statement(&mut self) -> Result<Statement, Fault> {
        let at = self.here();
        let (name, is_assigned) = match self.kind(0) {
            None => return Ok(Statement::Empty),
            Some(Kind::Numbered(numbered)) if numbered.letter == 'L' && !self.is_symbol(1, Symbol::Assign) => {
                let name = numbered.name();
                self.at += 1;
                return self.call(Called::Name(name), at);
            }
            Some(Kind::Name(name)) => (name.as_str(), self.is_symbol(1, Symbol::Assign)),
            Some(_) => return self.items(),
        };
        if is_assigned {
            return self.items();
        }
        self.at += 1;
        Ok(match name {
            "DEF" => self.define(at)?,
            "EXTERN" => {
                self.at = self.tokens.len();
                Statement::External
            }
            "PROC" => Statement::Procedure(self.procedure(at)?),
            "IF" => {
                let condition = self.condition()?;
                Statement::If { condition, jump: self.jump()? }
            }
            "ELSE" => Statement::Else,
            "ENDIF" => Statement::EndIf,
            "WHILE" => Statement::While(self.condition()?),
            "ENDWHILE" => Statement::EndWhile,
            "REPEAT" if self.is_at_end() => Statement::RepeatLoop,
            "REPEAT" | "REPEATB" => Statement::RepeatPart(self.repeat_part(name == "REPEATB", at)?),
            "UNTIL" => Statement::Until(self.condition()?),
            "LOOP" => Statement::Loop,
            "ENDLOOP" => Statement::EndLoop,
            "FOR" => {
                let variable = self.place()?;
                self.need(Symbol::Assign, "`=`")?;
                let from = self.expression()?;
                if !self.take_name("TO") {
                    return Err(self.syntax("TO is missing"));
                }
                let to = self.expression()?;
                Statement::For { variable, from, to, at: at.until(self.before()) }
            }
            "ENDFOR" => Statement::EndFor,
            "CASE" => self.case(at)?,
            "RET" => {
                if self.is_symbol(0, Symbol::Open) {
                    return Err(Fault::refused(at, "RET with parameters"));
                }
                Statement::Return { at }
            }
            "CALL" => {
                let program = self.expression()?;
                self.call(Called::Text(program), at)?
            }
            "EXTCALL" => {
                let program = self.expression()?;
                self.call(Called::External(program), at)?
            }
            _ => {
                self.at -= 1;
                if let Some(jump) = self.jump()? {
                    return Ok(Statement::Jump(jump));
                }
                if self.is_program(name) {
                    self.at += 1;
                    return self.call(Called::Name(name.to_owned()), at);
                }
                return self.items();
            }
        })
    }

    /// Whether a name at the beginning of a block can only be a program.
    fn is_program(&self, name: &str) -> bool {
        let is_call = !self.is_symbol(1, Symbol::Assign) && !self.is_symbol(1, Symbol::OpenIndex);
        let is_alone = self.tokens.len() <= self.at + 1
            || self.is_symbol(1, Symbol::Open)
            || matches!(self.kind(1), Some(Kind::Numbered(numbered)) if numbered.letter == 'P')
            || matches!(self.kind(1), Some(Kind::Name(name)) if name == "P");
        let is_reserved = matches!(name, "ID" | "IDS") || is_keyword(name);
        is_call
            && is_alone
            && !is_reserved
            && name.len() > 1
            && self.dialect.function(name).is_none()
            && self.dialect.refused(name).is_none()
            && super::vocabulary::Command::find(name).is_none()
            && self.axes.find(name).is_none()
    }

    fn condition(&mut self) -> Result<Expression, Fault> {
        if self.is_at_end() || self.name().is_some_and(|name| name.starts_with("GOTO")) {
            return Err(self.syntax("the condition is missing"));
        }
        self.expression()
    }

    /// Words, or assignments. Both in one block is an error.
    fn items(&mut self) -> Result<Statement, Fault> {
        let (mut words, mut assignments) = (Vec::new(), Vec::new());
        while !self.is_at_end() {
            match self.item()? {
                Item::Word(word) => words.push(word),
                Item::Assignment(assignment) => assignments.push(assignment),
            }
        }
        if let (Some(assignment), false) = (assignments.first(), words.is_empty()) {
            return Err(Fault::new(12080, assignment.at, "an assignment shares its block only with assignments"));
        }
        for word in &words {
            let is_alone = match word {
                Word::Command { command, .. } => command.is_alone(),
                Word::Synchronised(_) => true,
                Word::Function { .. } | Word::Indirect { .. } | Word::Address(_) => false,
            };
            if is_alone && words.len() > 1 {
                return Err(Fault::new(12080, word.at(), "it must be alone in its block"));
            }
        }
        Ok(if assignments.is_empty() { Statement::Words(words) } else { Statement::Assign(assignments) })
    }

    /// GOTOF, GOTOB, GOTO, GOTOC, GOTOS with its target.
    fn jump(&mut self) -> Result<Option<Jump>, Fault> {
        let at = self.here();
        let direction = match self.name() {
            Some("GOTOF") => Direction::Forward,
            Some("GOTOB") => Direction::Backward,
            Some("GOTO") => Direction::Both,
            Some("GOTOC") => Direction::BothSilent,
            Some("GOTOS") => Direction::Start,
            _ => return Ok(None),
        };
        self.at += 1;
        let target = if direction == Direction::Start { Target::Start } else { self.target()? };
        Ok(Some(Jump { direction, target, at: at.until(self.before()) }))
    }

    fn target(&mut self) -> Result<Target, Fault> {
        let is_text = self.is_symbol(1, Symbol::Join) || self.is_symbol(1, Symbol::OpenIndex);
        let target = match self.kind(0) {
            None => return Err(self.syntax("the jump target is missing")),
            Some(Kind::Numbered(numbered)) if numbered.letter == 'N' && numbered.whole().is_some() => {
                Target::Number { is_main: false, digits: significant(&numbered.digits).to_owned() }
            }
            Some(Kind::Symbol(Symbol::Colon)) => match self.kind(1) {
                Some(Kind::Int(number)) => {
                    self.at += 1;
                    Target::Number { is_main: true, digits: number.to_string() }
                }
                _ => return Err(self.syntax("a number must follow `:`")),
            },
            Some(Kind::Name(name)) if !is_text => Target::Name(name.clone()),
            Some(_) => return self.expression().map(Target::Text),
        };
        self.at += 1;
        Ok(target)
    }

    /// `CASE(e) OF c GOTOF l … DEFAULT GOTOF l`.
    fn case(&mut self, at: Span) -> Result<Statement, Fault> {
        let selector = self.condition()?;
        if !self.take_name("OF") {
            return Err(self.syntax("OF is missing"));
        }
        let (mut cases, mut default) = (Vec::new(), None);
        while !self.is_at_end() {
            let is_default = self.take_name("DEFAULT");
            let value = if is_default { None } else { Some(self.condition()?) };
            let jump = self.jump()?.ok_or_else(|| self.syntax("GOTOF or GOTOB is missing"))?;
            match value {
                Some(value) => cases.push((value, jump)),
                None => {
                    default = Some(jump);
                    break;
                }
            }
        }
        if cases.is_empty() {
            return Err(self.syntax("a value with its jump is missing"));
        }
        Ok(Statement::Case { selector, cases, default, at: at.until(self.before()) })
    }

    fn repeat_part(&mut self, is_block: bool, at: Span) -> Result<RepeatPart, Fault> {
        if self.is_at_end() {
            return Err(self.syntax("the label is missing"));
        }
        let first = self.target()?;
        let is_label = matches!(self.kind(0), Some(Kind::Name(name)) if name != "P");
        let last = if is_label && !is_block { Some(self.target()?) } else { None };
        let passes = self.passes()?;
        Ok(RepeatPart { first, last, is_block, passes, at: at.until(self.before()) })
    }

    /// `P3`, `P=3`.
    fn passes(&mut self) -> Result<Option<Expression>, Fault> {
        let is_passes = match self.kind(0) {
            Some(Kind::Numbered(numbered)) => numbered.letter == 'P',
            Some(Kind::Name(name)) => name == "P",
            _ => false,
        };
        if !is_passes {
            return Ok(None);
        }
        match self.item()? {
            Item::Word(Word::Address(word)) if word.address == Address::Passes => Ok(Some(word.value)),
            Item::Word(_) | Item::Assignment(_) => Err(self.syntax("the number of passes is missing")),
        }
    }

    /// The rest of a call: parameters and passes.
    fn call(&mut self, program: Called, at: Span) -> Result<Statement, Fault> {
        let arguments = match program {
            Called::Name(_) => self.arguments()?,
            Called::Text(_) | Called::External(_) => None,
        };
        let passes = self.passes()?;
        Ok(Statement::Call(Call { program, arguments, passes, at: at.until(self.before()) }))
    }

    fn kind_of_variable(&mut self) -> Result<Option<Type>, Fault> {
        let at = self.here();
        let kind = match self.name() {
            Some("INT") => Type::Int,
            Some("REAL") => Type::Real,
            Some("BOOL") => Type::Bool,
            Some("CHAR") => Type::Char,
            Some("AXIS") => Type::Axis,
            Some("FRAME") => Type::Frame,
            Some("STRING") => {
                self.at += 1;
                let length = match self.indices()?.as_slice() {
                    [] => LONGEST_STRING,
                    [Expression::Constant(Value::Int(length))] => u16::try_from(*length)
                        .ok()
                        .filter(|length| (1..=LONGEST_STRING).contains(length))
                        .ok_or_else(|| Fault::new(12430, at, format!("the length is 1 to {LONGEST_STRING}")))?,
                    _ => return Err(Fault::new(12410, at, "the length is a number")),
                };
                return Ok(Some(Type::Text(length)));
            }
            _ => return Ok(None),
        };
        self.at += 1;
        Ok(Some(kind))
    }

    fn define(&mut self, at: Span) -> Result<Statement, Fault> {
        if let Some("CHAN" | "NCK" | "SYNR" | "SYNW" | "SYNRW" | "APR" | "APW" | "PHU" | "LLI" | "ULI") = self.name() {
            return Err(Fault::new(12500, self.here(), "it belongs to files of global variables"));
        }
        let kind = self.kind_of_variable()?.ok_or_else(|| self.syntax("a type is missing: INT, REAL, BOOL, …"))?;
        let mut variables = Vec::new();
        loop {
            variables.push(self.declaration()?);
            if !self.take_symbol(Symbol::Comma) {
                break;
            }
        }
        Ok(Statement::Define { kind, variables, at: at.until(self.before()) })
    }

    /// The name of a variable: at least two letters or `_` at the beginning.
    fn new_name(&mut self) -> Result<(String, Span), Fault> {
        let at = self.here();
        let Some(name) = self.name() else {
            return Err(self.syntax("no name: its first two characters are letters or `_`"));
        };
        if is_keyword(name) {
            return Err(self.syntax(format!("{name} is a word of the language, and no name of a variable")));
        }
        if name.len() == 1 {
            let what = if self.axes.find(name).is_some() { "an axis" } else { "an address" };
            return Err(self.syntax(format!("{name} is {what}: a name has two letters or `_` at its beginning")));
        }
        if name.bytes().take(2).any(|byte| byte.is_ascii_digit()) {
            return Err(self.syntax("the first two characters of a name are letters or `_`"));
        }
        self.at += 1;
        Ok((name.to_owned(), at))
    }

    fn declaration(&mut self) -> Result<Declaration, Fault> {
        let (name, at) = self.new_name()?;
        let dimensions = self.indices()?;
        let mut initial = Initial::None;
        if self.take_symbol(Symbol::Assign) {
            let is_list = self.name() == Some("SET") || !dimensions.is_empty() && self.is_symbol(0, Symbol::Open);
            if self.name() == Some("REP") && self.is_symbol(1, Symbol::Open) {
                self.at += 2;
                let value = self.expression()?;
                let count = if self.take_symbol(Symbol::Comma) { Some(self.expression()?) } else { None };
                initial = Initial::All(value, count);
                self.need(Symbol::Close, "`)`")?;
            } else if is_list {
                self.take_name("SET");
                let list = self.arguments()?.ok_or_else(|| self.syntax("`(` is missing"))?;
                initial = Initial::Values(list);
            } else {
                initial = Initial::Values(vec![Some(self.expression()?)]);
            }
        }
        Ok(Declaration { name, dimensions, initial, at })
    }

    fn procedure(&mut self, at: Span) -> Result<Procedure, Fault> {
        let mut found = Procedure { at, ..Procedure::default() };
        match self.kind(0) {
            Some(Kind::Name(_) | Kind::Numbered(_)) => self.at += 1,
            _ => return Err(self.syntax("the name of the program is missing")),
        }
        if self.take_symbol(Symbol::Open) && !self.take_symbol(Symbol::Close) {
            loop {
                let is_reference = self.take_name("VAR");
                let kind = self.kind_of_variable()?.ok_or_else(|| self.syntax("a type is missing: INT, REAL, …"))?;
                let (name, _) = self.new_name()?;
                let dimensions = self.dimensions()?;
                let default = if self.take_symbol(Symbol::Assign) { Some(self.expression()?) } else { None };
                found.parameters.push(Parameter { name, kind, is_reference, dimensions, default });
                if !self.take_symbol(Symbol::Comma) {
                    break;
                }
            }
            self.need(Symbol::Close, "`)`")?;
        }
        while let Some(name) = self.name() {
            match name {
                "SAVE" => found.saves = true,
                "DISPLOF" => found.is_display_off = true,
                "SBLOF" => found.is_single_block_off = true,
                "DISPLON" | "SBLON" | "ACTBLOCNO" => {}
                _ => return Err(self.syntax("SAVE, DISPLOF, SBLOF or ACTBLOCNO may follow")),
            }
            self.at += 1;
        }
        Ok(found)
    }

    /// The number of dimensions of an array parameter: `A[]`, `A[,]`, `A[3,4]`.
    fn dimensions(&mut self) -> Result<usize, Fault> {
        if !self.take_symbol(Symbol::OpenIndex) {
            return Ok(0);
        }
        let mut count = 1;
        while !self.take_symbol(Symbol::CloseIndex) {
            match self.kind(0) {
                Some(Kind::Symbol(Symbol::Comma)) => count += 1,
                Some(Kind::Int(_)) => {}
                _ => return Err(self.syntax("`]` is missing")),
            }
            self.at += 1;
        }
        Ok(count)
    }
}

/// The longest STRING.
const LONGEST_STRING: u16 = 200;
