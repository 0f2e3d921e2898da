//! Execution of control blocks (`$IF` to `$CONTINUE`).
//!
//! A condition counts as true from an absolute value of 0.5 on. `$CASE` compares with a tolerance of 0.001. A branch that is not taken is not
//! read, except for the control blocks in it.

use super::evaluate::{evaluate, is_true, resolved};
use super::expression::Expression;
use super::fault::{
    Error, FaultCode, SKIPPED_AT_GLOBAL_END, SKIPPED_AT_LOCAL_END, SKIPPED_AT_MAIN_END, UNEXPECTED_ELSE,
    UNEXPECTED_ELSEIF, UNEXPECTED_ENDIF,
};
use super::interpreter::Work;
use super::scope::Store;
use super::search::{DEEPEST, Part, Structure, Text, too_deep};
use super::state::{Interpreter, Open};
use super::syntax::Flow;
use super::variables::Environment;

/// `$CASE` takes values as equal whose difference is smaller.
const TOLERANCE: f64 = 0.001;

impl Interpreter {
    pub(super) fn flow(
        &mut self,
        flow: &Flow,
        at: usize,
        work: &Work<'_>,
        environment: &mut dyn Environment,
    ) -> Result<(), Error> {
        let next = work.line.next;
        match flow {
            Flow::If(condition, Some(target)) => {
                if is_true(self.value(condition, environment)?) {
                    return self.jump(target, at, work, environment);
                }
                self.go_to(next);
                Ok(())
            }
            Flow::If(condition, None) => {
                let is_searching = !is_true(self.value(condition, environment)?);
                let open = Open { is_searching, ..opened(Structure::If, work) };
                self.branch(open, at, work, environment)
            }
            Flow::ElseIf(condition) => {
                let open = self.innermost(Structure::If, "ELSEIF", at)?;
                if open.has_else {
                    return Err(unexpected("ELSEIF", at, "the $IF has had its $ELSE already"));
                }
                if !open.is_searching {
                    return self.end(at, work, environment);
                }
                let is_searching = !is_true(self.value(condition, environment)?);
                self.close();
                self.branch(Open { is_searching, ..open }, at, work, environment)
            }
            Flow::Else => {
                let open = self.innermost(Structure::If, "ELSE", at)?;
                if open.has_else {
                    return Err(unexpected("ELSE", at, "the $IF has had its $ELSE already"));
                }
                self.take(open.is_searching, at, work, environment)
            }
            Flow::EndIf => self.closed(Structure::If, at, next),
            Flow::Switch(place, value) => {
                let value = self.value(value, environment)?;
                if let Some(place) = place {
                    let name = resolved(place, &self.scope(environment, &Store::new()))?;
                    self.write(vec![(name, value, place.at)], environment)?;
                }
                self.branch(
                    Open { is_searching: true, value, ..opened(Structure::Switch, work) },
                    at,
                    work,
                    environment,
                )
            }
            Flow::Case(value) => {
                let open = self.innermost(Structure::Switch, "CASE", at)?;
                if !open.is_searching {
                    self.go_to(next);
                    return Ok(());
                }
                let is_searching = (self.value(value, environment)? - open.value).abs() >= TOLERANCE;
                self.close();
                self.branch(Open { is_searching, ..open }, at, work, environment)
            }
            Flow::Default => {
                let open = self.innermost(Structure::Switch, "DEFAULT", at)?;
                self.close();
                self.branch(Open { is_searching: false, ..open }, at, work, environment)
            }
            Flow::EndSwitch => self.closed(Structure::Switch, at, next),
            Flow::For { variable, from, to, step } => {
                let [from, to, step] = [from, to, step].map(|value| self.value(value, environment));
                let (from, to, step) = (from?, to?, step?);
                let name = resolved(variable, &self.scope(environment, &Store::new()))?;
                // The end is looked for before the variable is written.
                let end = part(Structure::For, next, &[], at, work, environment)?;
                self.write(vec![(name.clone(), from, variable.at)], environment)?;
                if is_passed(from, to, step) {
                    self.go_to(end.next);
                } else {
                    self.go_to(next);
                    self.open(Open { value: to, step, variable: name, ..opened(Structure::For, work) }, at)?;
                }
                Ok(())
            }
            Flow::EndFor => self.count(at, next, environment),
            Flow::While(condition) => {
                let end = part(Structure::While, next, &[], at, work, environment)?;
                if is_true(self.value(condition, environment)?) {
                    self.go_to(next);
                    self.open(opened(Structure::While, work), at)?;
                } else {
                    self.go_to(end.next);
                }
                Ok(())
            }
            Flow::EndWhile => {
                let line = self.innermost(Structure::While, "ENDWHILE", at)?.line;
                self.closed(Structure::While, at, line)
            }
            Flow::Do => self.begin(Structure::Do, at, work, environment),
            Flow::Repeat => self.begin(Structure::Repeat, at, work, environment),
            Flow::EndDo(condition) => {
                let condition = condition.as_ref().map(|condition| self.value(condition, environment)).transpose()?;
                self.again(Structure::Do, condition.is_none_or(is_true), at, next)
            }
            Flow::Until(condition) => {
                let is_done = is_true(self.value(condition, environment)?);
                self.again(Structure::Repeat, !is_done, at, next)
            }
            Flow::Break => {
                self.keep(|structure| structure.is_loop() || structure == Structure::Switch, "BREAK", at)?;
                self.end(at, work, environment)
            }
            Flow::Continue => {
                let open = self.keep(Structure::is_loop, "CONTINUE", at)?;
                let end = part(open.structure, open.next, &[], at, work, environment)?;
                self.go_to(end.line);
                Ok(())
            }
        }
    }

    fn value(&self, expression: &Expression, environment: &dyn Environment) -> Result<f64, Error> {
        evaluate(expression, &self.scope(environment, &Store::new()))
    }

    fn open(&mut self, open: Open, at: usize) -> Result<(), Error> {
        let Some(level) = self.levels.last_mut() else { return Ok(()) };
        if level.open.len() >= DEEPEST {
            return Err(too_deep(at));
        }
        level.open.push(open);
        Ok(())
    }

    fn close(&mut self) {
        if let Some(level) = self.levels.last_mut() {
            level.open.pop();
        }
    }

    /// The innermost control block, which must be of this kind.
    fn innermost(&self, structure: Structure, word: &str, at: usize) -> Result<Open, Error> {
        let open = self.levels.last().and_then(|level| level.open.last());
        open.filter(|open| open.structure == structure).cloned().ok_or_else(|| {
            let [opens, _] = structure.words();
            unexpected(word, at, &format!("${word} without ${opens} before it"))
        })
    }

    /// Closes the innermost control block.
    fn closed(&mut self, structure: Structure, at: usize, next: u32) -> Result<(), Error> {
        self.innermost(structure, structure.words()[1], at)?;
        self.close();
        self.go_to(next);
        Ok(())
    }

    /// Enters a branch, or goes on to the next one.
    fn branch(
        &mut self,
        mut open: Open,
        at: usize,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<(), Error> {
        let words: &[&str] = if open.structure == Structure::If { &["ELSEIF", "ELSE"] } else { &["CASE", "DEFAULT"] };
        let next = match part(open.structure, work.line.next, words, at, work, environment) {
            // A control tells it at the end of the program: of a branch that runs as a warning.
            Err(_) if work.lenient && open.structure == Structure::If => {
                if open.is_searching {
                    return Err(self.skipped_to_the_end(open.line, at));
                }
                open.is_unclosed = true;
                self.go_to(work.line.next);
                return self.open(open, at);
            }
            next => next?,
        };
        self.go_to(if open.is_searching { next.line } else { work.line.next });
        self.open(open, at)
    }

    /// `$ELSE`: enters the branch, or leaves the control block because another branch was taken.
    fn take(&mut self, is_taken: bool, at: usize, work: &Work<'_>, environment: &dyn Environment) -> Result<(), Error> {
        if !is_taken {
            return self.end(at, work, environment);
        }
        if let Some(open) = self.levels.last_mut().and_then(|level| level.open.last_mut()) {
            open.is_searching = false;
            open.has_else = true;
        }
        self.go_to(work.line.next);
        Ok(())
    }

    /// Everything behind a condition that is false belongs to its branch, up to the end of the program.
    fn skipped_to_the_end(&self, line: u32, at: usize) -> Error {
        let number = match self.levels.as_slice() {
            [.., level] if level.is_local => SKIPPED_AT_LOCAL_END,
            [_, .., _] => SKIPPED_AT_GLOBAL_END,
            _ => SKIPPED_AT_MAIN_END,
        };
        Error::new(FaultCode::Number(number), at, format!("the $IF in line {line} has no $ENDIF"))
    }

    /// Leaves the innermost control block.
    fn end(&mut self, at: usize, work: &Work<'_>, environment: &dyn Environment) -> Result<(), Error> {
        let Some(open) = self.levels.last_mut().and_then(|level| level.open.last_mut()) else { return Ok(()) };
        if open.structure == Structure::If
            && let Some(line) = text(work, &|level| environment.is_skipped(level)).misplaced(open.next)
        {
            // The second $ELSE is refused in its own line.
            open.has_else = true;
            self.go_to(line);
            return Ok(());
        }
        let end = part(open.structure, open.next, &[], at, work, environment)?;
        self.close();
        self.go_to(end.next);
        Ok(())
    }

    /// Leaves control blocks up to the innermost one of a kind.
    fn keep(&mut self, is_kind: impl Fn(Structure) -> bool, word: &str, at: usize) -> Result<Open, Error> {
        let error = || Error::syntax(at, format!("${word} outside a loop"));
        let level = self.levels.last_mut().ok_or_else(error)?;
        let index = level.open.iter().rposition(|open| is_kind(open.structure)).ok_or_else(error)?;
        level.open.truncate(index + 1);
        level.open.last().cloned().ok_or_else(error)
    }

    /// A loop that tests its condition at the end.
    fn begin(
        &mut self,
        structure: Structure,
        at: usize,
        work: &Work<'_>,
        environment: &dyn Environment,
    ) -> Result<(), Error> {
        part(structure, work.line.next, &[], at, work, environment)?;
        self.go_to(work.line.next);
        self.open(opened(structure, work), at)
    }

    /// The end of such a loop.
    fn again(&mut self, structure: Structure, goes_on: bool, at: usize, next: u32) -> Result<(), Error> {
        if goes_on {
            let first = self.innermost(structure, structure.words()[1], at)?.next;
            self.go_to(first);
            return Ok(());
        }
        self.closed(structure, at, next)
    }

    /// `$ENDFOR`
    fn count(&mut self, at: usize, next: u32, environment: &mut dyn Environment) -> Result<(), Error> {
        let open = self.innermost(Structure::For, "ENDFOR", at)?;
        let value = {
            let none = Store::new();
            let scope = self.scope(environment, &none);
            super::evaluate::Values::value(&scope, &open.variable)
        };
        let value =
            value.ok_or_else(|| Error::value(at, format!("{} has no value any more", open.variable)))? + open.step;
        if !value.is_finite() {
            return Err(Error::value(at, "the counting variable is too large"));
        }
        self.write(vec![(open.variable.clone(), value, at)], environment)?;
        if is_passed(value, open.value, open.step) {
            return self.closed(Structure::For, at, next);
        }
        self.go_to(open.next);
        Ok(())
    }
}

/// Whether a counting loop has passed its end. Step 0 never does.
fn is_passed(value: f64, end: f64, step: f64) -> bool {
    step > 0.0 && value > end || step < 0.0 && value < end
}

fn opened(structure: Structure, work: &Work<'_>) -> Open {
    Open::new(structure, work.line.line, work.line.next)
}

/// A part of a control block that does not match the innermost one.
pub(super) fn unexpected(word: &str, at: usize, text: &str) -> Error {
    let code = match word {
        "ELSE" => FaultCode::Number(UNEXPECTED_ELSE),
        "ELSEIF" => FaultCode::Number(UNEXPECTED_ELSEIF),
        "ENDIF" => FaultCode::Number(UNEXPECTED_ENDIF),
        _ => FaultCode::Syntax,
    };
    Error::new(code, at, text)
}

fn text<'a>(work: &Work<'a>, is_skipped: &'a dyn Fn(u8) -> bool) -> Text<'a> {
    Text { program: work.program, lenient: work.lenient, is_skipped }
}

/// The line that a control block goes on with.
fn part(
    structure: Structure,
    from: u32,
    words: &[&str],
    at: usize,
    work: &Work<'_>,
    environment: &dyn Environment,
) -> Result<Part, Error> {
    text(work, &|level| environment.is_skipped(level)).part(structure, from, words).ok_or_else(|| {
        let [word, end] = structure.words();
        Error::syntax(at, format!("${word} has no ${end}, or control blocks cross each other"))
    })
}
