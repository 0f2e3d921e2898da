//! What a block says, before any value is known: statements and words.

use serde::{Deserialize, Serialize};

use super::alarm::Span;
use super::expression::Expression;
use super::functions::GFunction;
use super::names::AxisIndex;
use super::value::Type;
use super::vocabulary::Command;

/// A block of a program.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SourceBlock {
    /// The skip level, 0 to 9.
    pub(super) skip: Option<u8>,
    pub(super) statement: Statement,
    /// Comparisons beside logical operators without parentheses.
    pub(super) warnings: Vec<Span>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Statement {
    /// Only a number, a label or a comment.
    Empty,
    Define {
        kind: Type,
        variables: Vec<Declaration>,
        at: Span,
    },
    /// EXTERN: a declaration without effect, because calls look at PROC.
    External,
    Procedure(Procedure),
    If {
        condition: Expression,
        jump: Option<Jump>,
    },
    Else,
    EndIf,
    While(Expression),
    EndWhile,
    RepeatLoop,
    Until(Expression),
    Loop,
    EndLoop,
    For {
        variable: Expression,
        from: Expression,
        to: Expression,
        at: Span,
    },
    EndFor,
    Case {
        selector: Expression,
        cases: Vec<(Expression, Jump)>,
        default: Option<Jump>,
        at: Span,
    },
    Jump(Jump),
    RepeatPart(RepeatPart),
    Call(Call),
    /// RET
    Return {
        at: Span,
    },
    Assign(Vec<Assignment>),
    Words(Vec<Word>),
}

/// A variable of DEF.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Declaration {
    pub(super) name: String,
    pub(super) dimensions: Vec<Expression>,
    pub(super) initial: Initial,
    pub(super) at: Span,
}

/// Initial values.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Initial {
    /// 0, FALSE, or an empty text.
    None,
    /// A value, or several of an array; the others keep their initial value.
    Values(Vec<Option<Expression>>),
    /// REP: all elements, or the first ones.
    All(Expression, Option<Expression>),
}

/// `PROC name(…) SAVE DISPLOF SBLOF`.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Procedure {
    pub(super) parameters: Vec<Parameter>,
    pub(super) saves: bool,
    pub(super) is_single_block_off: bool,
    pub(super) is_display_off: bool,
    pub(super) at: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) kind: Type,
    /// VAR: the variable of the caller.
    pub(super) is_reference: bool,
    /// The number of dimensions of an array.
    pub(super) dimensions: usize,
    pub(super) default: Option<Expression>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// GOTOF
    Forward,
    /// GOTOB
    Backward,
    /// GOTO: forward, then from the start.
    Both,
    /// GOTOC: as GOTO; a missing target is no error.
    BothSilent,
    /// GOTOS: the start of the program, if the PLC wants it.
    Start,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Jump {
    pub(super) direction: Direction,
    pub(super) target: Target,
    pub(super) at: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Target {
    /// None, of GOTOS.
    Start,
    /// A label, or a variable of type STRING.
    Name(String),
    /// `N10`, `:10`.
    Number { is_main: bool, digits: String },
    /// A text with a label or a number.
    Text(Expression),
}

/// `REPEAT first [last] P=n`, `REPEATB first P=n`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct RepeatPart {
    pub(super) first: Target,
    pub(super) last: Option<Target>,
    pub(super) is_block: bool,
    pub(super) passes: Option<Expression>,
    pub(super) at: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Call {
    pub(super) program: Called,
    /// None without parentheses. An omitted parameter is None.
    pub(super) arguments: Option<Vec<Option<Expression>>>,
    pub(super) passes: Option<Expression>,
    pub(super) at: Span,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Called {
    /// `L10`, `NAME`.
    Name(String),
    /// `CALL "NAME"`.
    Text(Expression),
    /// `EXTCALL("path")`.
    External(Expression),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Assignment {
    /// An R parameter, a variable or a system variable.
    pub(super) place: Expression,
    pub(super) value: Expression,
    pub(super) at: Span,
}

/// A word of a block that moves, outputs or switches.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Word {
    Function {
        function: GFunction,
        at: Span,
    },
    /// `G=number`, `G[group]=index`.
    Indirect {
        group: Option<Expression>,
        number: Expression,
        at: Span,
    },
    Address(AddressWord),
    Command {
        command: Command,
        arguments: Vec<Option<Expression>>,
        at: Span,
    },
    Synchronised(Box<Synchronised>),
}

impl Word {
    pub(super) fn at(&self) -> Span {
        match self {
            Self::Function { at, .. } | Self::Indirect { at, .. } | Self::Command { at, .. } => *at,
            Self::Address(word) => word.at,
            Self::Synchronised(action) => action.at,
        }
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct AddressWord {
    pub(super) address: Address,
    /// `M2=3`, `FA[X]=…`: the number or the axis.
    pub(super) extension: Option<Expression>,
    pub(super) modifier: Option<Modifier>,
    pub(super) value: Expression,
    pub(super) at: Span,
}

/// Addresses. The letters of axes are in the table of the caller.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Address {
    Axis(AxisIndex),
    /// `AX[variable]=`
    AxisOf,
    /// I, J, K: 0, 1, 2.
    Centre(u8),
    /// CR
    Radius,
    /// AR
    OpeningAngle,
    /// TURN
    Turns,
    F,
    /// `FA[X]=`
    AxisFeed,
    /// `FDA[X]=`
    HandwheelFeed,
    /// `FD=`
    PathHandwheelFeed,
    S,
    T,
    D,
    /// DL
    SumOffset,
    H,
    M,
    /// `POS[X]=`
    Position,
    /// `POSA[X]=`
    PositionAcross,
    /// `SPOS=`
    SpindlePosition,
    /// `SPOSA=`
    SpindlePositionAcross,
    /// `OVR=`
    Override,
    /// `ACC[X]=`
    Acceleration,
    /// `P=`, without a call.
    Passes,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Modifier {
    Absolute,
    Incremental,
    Shortest,
    FromPlus,
    FromMinus,
    /// QU: quick output of an auxiliary function.
    Quick,
}

impl Modifier {
    pub(super) fn find(name: &str) -> Option<Self> {
        Some(match name {
            "AC" => Self::Absolute,
            "IC" => Self::Incremental,
            "DC" => Self::Shortest,
            "ACP" => Self::FromPlus,
            "ACN" => Self::FromMinus,
            "QU" => Self::Quick,
            _ => return None,
        })
    }
}

/// A synchronised action.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Synchronised {
    /// The ID, and whether it outlives the program (IDS).
    pub(super) id: Option<(Expression, bool)>,
    pub(super) frequency: Frequency,
    pub(super) condition: Option<Expression>,
    pub(super) actions: Vec<SynchronisedWord>,
    pub(super) at: Span,
}

/// When the actions of a synchronised action are executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Frequency {
    /// No condition: in every cycle.
    Always,
    /// WHEN: once, as soon as the condition holds.
    Once,
    /// WHENEVER: in every cycle in which the condition holds.
    Whenever,
    /// EVERY: each time that the condition begins to hold.
    Every,
    /// FROM: in every cycle from the first one in which the condition holds.
    From,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum SynchronisedWord {
    Address(AddressWord),
    Assign(Assignment),
    Command { command: Command, arguments: Vec<Option<Expression>>, at: Span },
}
