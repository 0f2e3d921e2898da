//! NC programs as a language: text, words, expressions, blocks. The module knows the names of axes, and no axis: it does
//! not know where an axis is, what it may do, or what moves it.
//!
//! # The boundary
//!
//! A channel owns an [`Interpreter`], which is plain data, and implements [`Environment`]: R parameters, system variables, axis names,
//! programs, skip levels. It calls [`Interpreter::next`] whenever its buffer of prepared blocks has room:
//!
//! | result | what the channel does |
//! |---|---|
//! | [`Prepared::Block`] | executes it: [`Block`] has modal G functions, feedrate, offset, axis words, circle, auxiliary functions and [`Action`]s with their values |
//! | [`Prepared::Calculated`] | nothing; single block type 2 stops after it ([`Interpreter::step`] returns every such block, `next` only some) |
//! | [`Prepared::Before`] | stands before this block, as a search wants |
//! | [`Prepared::Waits`] | calls again when everything before has been executed ([`Environment::is_executed`]) |
//! | [`Prepared::Ended`] | there are no more blocks: M30, M2 or M17 of the main program was in the last one |
//! | a [`ProgramAlarm`] | raises it with its channel as %1. With [`Class::CorrectionBlock`] the next call reads the block again; with [`Class::InterpreterStop`] only RESET helps: a new interpreter |
//!
//! The channel decides all that needs a machine: limits, frames and units, circle geometry (14040, 14095), owners of axes (14092, 16794, …),
//! whether a system variable exists, the output of auxiliary functions, couplings, what a synchronised action does in each cycle
//! ([`Condition::holds`], [`MainRunValue::number`]).
//!
//! # How a program is read
//!
//! A [`Program`] is its text and the beginnings of its lines. Nothing is parsed before it is reached, and nothing is kept afterwards: a
//! program of a million blocks needs its text and four bytes for each line. Jumps and the ends of control structures are searches in the
//! text at the moment of execution, so an error in a block that is jumped over is never noticed. [`check`] reads a whole program statically
//! instead.
//!
//! # The same result everywhere
//!
//! Numbers are `f64` with `+ − × ÷ sqrt`. Sine, logarithm and the like are those of the crate `libm`, which is software in Rust, behind an
//! exact reduction of angles in degrees.
//!
//! # What differs between controls
//!
//! [`Dialect`] has it: ranks of operators, G functions, refused words, limits. [`SINUMERIK`] is the only one.

mod addresses;
mod alarm;
mod assign;
mod auxiliary;
mod block;
mod call;
mod check;
mod commands;
mod compose;
mod composer;
mod condition;
mod dialect;
mod environment;
mod evaluate;
mod expression;
mod flow;
mod frames;
mod function;
mod functions;
mod head;
mod interpreter;
mod known;
mod macros;
mod names;
mod operator;
mod prepared;
mod scope;
mod search;
mod source;
mod state;
mod syntax;
mod token;
mod trigonometry;
mod value;
mod variables;
mod vocabulary;
mod waiting;
mod words;

#[cfg(test)]
mod tests;

pub use alarm::{Class, ProgramAlarm, numbers as alarm_numbers};
pub use auxiliary::AuxiliaryKind;
pub use check::{CheckFinding, check};
pub use condition::{Condition, MainRunValue};
pub use dialect::{Dialect, SINUMERIK};
pub use environment::{Environment, SystemVariable, VariableRefusal};
pub use functions::{GFunction, INCH, Modal, g, groups, name as function_name};
pub use names::{AxisIndex, AxisKind, AxisName, AxisNames};
pub use operator::Operator;
pub use prepared::{
    Action, AuxiliaryFunction, AxisWord, Block, Centre, Circle, CouplingKind, Dimension, End, MainRunAction, Origin,
    Prepared, SynchronisedAction, is_of_spindle, predefined_group,
};
pub use search::BlockTarget;
pub use source::{Library, Program, ProgramKind, Request, normalised};
pub use state::Interpreter;
pub use syntax::Frequency;
pub use trigonometry::{acos, asin, atan2, cos, exp, ln, sin, tan};
pub use value::{Type, Value};
