//! A block as it was read, before its expressions have values.

use super::block::Sign;
use super::expression::{Expression, Place};
use super::head::Target;
use super::link::LinkOff;

/// What stands behind the beginning of a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Content {
    /// Nothing, or only comments.
    Empty,
    Words(Vec<Word>),
    Command(HashCommand),
    Flow(Flow),
}

/// A word of a block.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Word {
    pub(super) kind: WordKind,
    pub(super) at: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum WordKind {
    G(u32),
    M(u32),
    Value(Address, Expression),
    /// With the sign that stands directly behind the name, and whether another one follows it.
    Axis(String, Option<Sign>, bool, Expression),
    /// The time directly behind G04.
    Time(Expression),
    Assign(Place, Expression),
    Call {
        name: String,
        is_local: bool,
    },
    Goto(Target),
}

/// Addresses with a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Address {
    F,
    I,
    J,
    K,
    R,
    T,
    D,
    S,
    H,
}

/// A command that begins with `#`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum HashCommand {
    Link {
        group: Value,
        pairs: Vec<Pair>,
    },
    LinkOn(Option<Value>),
    LinkOff(Switch),
    Gantry {
        is_on: bool,
        targets: Option<Vec<GantryTarget>>,
    },
    Call {
        is_fast: bool,
        conflicts: [bool; 3],
        requests: Vec<Request>,
    },
    Put(Put),
    /// G201 (on), G202.
    Manual {
        is_on: bool,
        axes: Vec<String>,
    },
    /// `#TIME`
    Time(Value),
}

/// An expression and its place.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    pub(super) expression: Expression,
    pub(super) at: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Switch {
    /// The last one that was activated, or all.
    Known(LinkOff),
    Group(Value),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Pair {
    pub(super) slave: Axis,
    pub(super) master: Axis,
    pub(super) form: Form,
    pub(super) at: usize,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Axis {
    Name(String),
    Number(Value),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Form {
    Bare,
    Standard,
    Gantry(Option<[Value; 2]>),
    /// Numerator and denominator.
    Factor(Value, Option<Value>),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum GantryTarget {
    Name(String),
    Number(Value),
}

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Request {
    pub(super) name: String,
    pub(super) number: Value,
    pub(super) index: Value,
    pub(super) options: Vec<String>,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Put {
    All,
    Names(Vec<String>),
    Numbers(Vec<Value>),
}

/// A control block, which begins with `$`.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Flow {
    /// With a target, the jump is all that depends on the condition: there is no `$ENDIF`.
    If(Expression, Option<Target>),
    ElseIf(Expression),
    Else,
    EndIf,
    Switch(Option<Place>, Expression),
    Case(Expression),
    Default,
    EndSwitch,
    For {
        variable: Place,
        from: Expression,
        to: Expression,
        step: Expression,
    },
    EndFor,
    While(Expression),
    EndWhile,
    Do,
    EndDo(Option<Expression>),
    Repeat,
    Until(Expression),
    Break,
    Continue,
}

impl Content {
    /// Calls a function for each variable that the block reads or writes.
    pub(super) fn for_each_variable(&self, call: &mut dyn FnMut(&str)) {
        match self {
            Self::Empty => {}
            Self::Words(words) => words.iter().for_each(|word| word.kind.for_each_variable(call)),
            Self::Command(command) => command.for_each_value(&mut |value| value.expression.for_each_variable(call)),
            Self::Flow(flow) => flow.for_each_variable(call),
        }
    }
}

impl WordKind {
    fn for_each_variable(&self, call: &mut dyn FnMut(&str)) {
        match self {
            Self::G(_) | Self::M(_) | Self::Call { .. } | Self::Goto(_) => {}
            Self::Value(_, value) | Self::Axis(_, _, _, value) | Self::Time(value) => value.for_each_variable(call),
            Self::Assign(place, value) => {
                place.for_each_variable(call);
                value.for_each_variable(call);
            }
        }
    }
}

impl HashCommand {
    fn for_each_value(&self, call: &mut dyn FnMut(&Value)) {
        match self {
            Self::Link { group, pairs } => {
                call(group);
                for pair in pairs {
                    for axis in [&pair.slave, &pair.master] {
                        if let Axis::Number(value) = axis {
                            call(value);
                        }
                    }
                    match &pair.form {
                        Form::Bare | Form::Standard => {}
                        Form::Gantry(limits) => limits.iter().flatten().for_each(&mut *call),
                        Form::Factor(numerator, denominator) => {
                            call(numerator);
                            denominator.iter().for_each(&mut *call);
                        }
                    }
                }
            }
            Self::LinkOn(group) => group.iter().for_each(call),
            Self::LinkOff(Switch::Group(value)) | Self::Time(value) => call(value),
            Self::LinkOff(Switch::Known(_)) | Self::Manual { .. } | Self::Put(Put::All | Put::Names(_)) => {}
            Self::Gantry { targets, .. } => {
                for target in targets.iter().flatten() {
                    if let GantryTarget::Number(value) = target {
                        call(value);
                    }
                }
            }
            Self::Call { requests, .. } => {
                for request in requests {
                    call(&request.number);
                    call(&request.index);
                }
            }
            Self::Put(Put::Numbers(numbers)) => numbers.iter().for_each(call),
        }
    }
}

impl Flow {
    fn for_each_variable(&self, call: &mut dyn FnMut(&str)) {
        match self {
            Self::If(value, _)
            | Self::ElseIf(value)
            | Self::Case(value)
            | Self::While(value)
            | Self::Until(value)
            | Self::EndDo(Some(value)) => {
                value.for_each_variable(call);
            }
            Self::Switch(place, value) => {
                place.iter().for_each(|place| place.for_each_variable(call));
                value.for_each_variable(call);
            }
            Self::For { variable, from, to, step } => {
                variable.for_each_variable(call);
                [from, to, step].iter().for_each(|value| value.for_each_variable(call));
            }
            Self::Else
            | Self::EndIf
            | Self::Default
            | Self::EndSwitch
            | Self::EndFor
            | Self::EndWhile
            | Self::Do
            | Self::Repeat
            | Self::EndDo(None)
            | Self::Break
            | Self::Continue => {}
        }
    }
}
