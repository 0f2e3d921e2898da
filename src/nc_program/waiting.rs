//! Blocks that must not be prepared ahead of the movement.

use super::expression::{Expression, is_main_run};
use super::functions::{GFunction, g};
use super::syntax::{Called, Direction, Initial, Jump, Statement, Word};
use super::vocabulary::Command;

/// What a block waits for before it is executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Wait {
    No,
    /// Everything before it has been executed. What POSA moves goes on.
    Executed,
    /// Nothing moves any more, either.
    AtRest,
}

/// What a block waits for: STOPRE, variables of the main run, and GOTOS (384.0 counts when the block is reached) for the execution of everything
/// before it; G74, PRESETON, GET, NEWCONF and DRFOF also for standstill.
pub(super) fn wait(statement: &Statement) -> Wait {
    let at_rest = |word: &Word| match word {
        Word::Function { function, .. } => stops(*function),
        Word::Command { command, .. } => command.is_stop() && *command != Command::StopPreparation,
        Word::Indirect { .. } | Word::Address(_) | Word::Synchronised(_) => false,
    };
    match statement {
        Statement::Words(words) if words.iter().any(at_rest) => Wait::AtRest,
        statement if waits(statement) => Wait::Executed,
        _ => Wait::No,
    }
}

fn waits(statement: &Statement) -> bool {
    let main_run = |one: &Expression| matches!(one, Expression::System { name, .. } if is_main_run(name));
    let reads = |expression: &Expression| expression.any(&main_run);
    let of_call = |called: &Called| match called {
        Called::Name(_) => false,
        Called::Text(text) | Called::External(text) => reads(text),
    };
    match statement {
        Statement::Define { variables, .. } => variables.iter().any(|variable| match &variable.initial {
            Initial::None => false,
            Initial::Values(values) => values.iter().flatten().any(reads),
            Initial::All(value, count) => reads(value) || count.as_ref().is_some_and(reads),
        }),
        Statement::If { condition, jump } => reads(condition) || jump.as_ref().is_some_and(restarts),
        Statement::While(condition) | Statement::Until(condition) => reads(condition),
        Statement::For { from, to, .. } => reads(from) || reads(to),
        Statement::Case { selector, cases, default, .. } => {
            reads(selector)
                || cases.iter().any(|(value, jump)| reads(value) || restarts(jump))
                || default.as_ref().is_some_and(restarts)
        }
        Statement::Jump(jump) => restarts(jump),
        Statement::Call(call) => {
            of_call(&call.program)
                || call.passes.as_ref().is_some_and(reads)
                || call.arguments.iter().flatten().flatten().any(reads)
        }
        Statement::Assign(assignments) => assignments.iter().any(|one| reads(&one.place) || reads(&one.value)),
        Statement::RepeatPart(part) => part.passes.as_ref().is_some_and(reads),
        Statement::Words(words) => words.iter().any(|word| match word {
            Word::Function { function, .. } => stops(*function),
            Word::Indirect { group, number, .. } => reads(number) || group.as_ref().is_some_and(reads),
            Word::Address(word) => reads(&word.value) || word.extension.as_ref().is_some_and(reads),
            Word::Command { command, arguments, .. } => command.is_stop() || arguments.iter().flatten().any(reads),
            Word::Synchronised(_) => false,
        }),
        Statement::Empty
        | Statement::External
        | Statement::Procedure(_)
        | Statement::Else
        | Statement::EndIf
        | Statement::EndWhile
        | Statement::RepeatLoop
        | Statement::Loop
        | Statement::EndLoop
        | Statement::EndFor
        | Statement::Return { .. } => false,
    }
}

fn restarts(jump: &Jump) -> bool {
    jump.direction == Direction::Start
}

fn stops(function: GFunction) -> bool {
    function == g::G74
}
