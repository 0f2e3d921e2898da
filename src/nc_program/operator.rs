//! Operators of expressions.
//!
//! `+ - *` of two INT give INT, else REAL; `/` always gives REAL; DIV cuts to a whole number; MOD and the bit operators only take whole
//! types. REALs are equal if they differ by at most 1E-12 of the larger one.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::frames::chained;
use super::value::Value;

/// An operator between two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Operator {
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// DIV
    WholeDivide,
    /// MOD
    Modulo,
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// B_AND
    BitAnd,
    /// B_XOR
    BitXor,
    /// B_OR
    BitOr,
    /// AND
    And,
    /// XOR
    Xor,
    /// OR
    Or,
    /// `:` of frames
    Chain,
    /// `<<`
    Join,
    /// `==`
    Equal,
    /// `<>`
    Unequal,
    /// `>`
    Greater,
    /// `<`
    Less,
    /// `>=`
    GreaterOrEqual,
    /// `<=`
    LessOrEqual,
}

impl Operator {
    /// Whether it compares.
    #[must_use]
    pub fn is_comparison(self) -> bool {
        match self {
            Self::Equal | Self::Unequal | Self::Greater | Self::Less | Self::GreaterOrEqual | Self::LessOrEqual => true,
            Self::Multiply
            | Self::Divide
            | Self::WholeDivide
            | Self::Modulo
            | Self::Add
            | Self::Subtract
            | Self::BitAnd
            | Self::BitXor
            | Self::BitOr
            | Self::And
            | Self::Xor
            | Self::Or
            | Self::Chain
            | Self::Join => false,
        }
    }

    /// Whether it combines truth values.
    #[must_use]
    pub fn is_logical(self) -> bool {
        matches!(self, Self::And | Self::Xor | Self::Or)
    }
}

/// An operator before a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Prefix {
    /// `-`
    Minus,
    /// NOT
    Not,
    /// B_NOT
    BitNot,
}

/// Applies an operator to two values. `Join` needs texts: [`super::evaluate`] makes them first.
pub(super) fn binary(operator: Operator, left: &Value, right: &Value, at: Span) -> Result<Value, Fault> {
    let unfit = || {
        let (left, right) = (left.of_type().name(), right.of_type().name());
        Fault::new(12150, at, format!("the operator does not take {left} and {right}"))
    };
    let numbers = || Some((left.number()?, right.number()?));
    let whole = || Some((left.whole()?, right.whole()?));
    match operator {
        Operator::Add | Operator::Subtract | Operator::Multiply => {
            if let Some((left, right)) = whole() {
                let result = match operator {
                    Operator::Add => left + right,
                    Operator::Subtract => left - right,
                    _ => left * right, // of 32 bits each: no overflow in 64
                };
                return i32::try_from(result).map(Value::Int).map_err(|_| overflow(at, "INT"));
            }
            let (left, right) = numbers().ok_or_else(unfit)?;
            real(
                match operator {
                    Operator::Add => left + right,
                    Operator::Subtract => left - right,
                    _ => left * right,
                },
                at,
            )
        }
        Operator::Divide => {
            let (left, right) = numbers().ok_or_else(unfit)?;
            real(left / nonzero(right, at)?, at)
        }
        Operator::WholeDivide => {
            if let Some((left, right)) = whole() {
                let quotient = left.checked_div(right).ok_or_else(|| zero(at))?;
                return i32::try_from(quotient).map(Value::Int).map_err(|_| overflow(at, "INT"));
            }
            let (left, right) = numbers().ok_or_else(unfit)?;
            real((left / nonzero(right, at)?).trunc(), at)
        }
        Operator::Modulo => {
            let (left, right) = whole().ok_or_else(unfit)?;
            let rest = left.checked_rem(right).ok_or_else(|| zero(at))?;
            i32::try_from(rest).map(Value::Int).map_err(|_| overflow(at, "INT"))
        }
        Operator::BitAnd | Operator::BitXor | Operator::BitOr => {
            let (left, right) = whole().ok_or_else(unfit)?;
            let result = match operator {
                Operator::BitAnd => left & right,
                Operator::BitXor => left ^ right,
                _ => left | right,
            };
            i32::try_from(result).map(Value::Int).map_err(|_| overflow(at, "INT"))
        }
        Operator::And | Operator::Xor | Operator::Or => {
            let (left, right) = numbers().map(|(left, right)| (left != 0.0, right != 0.0)).ok_or_else(unfit)?;
            Ok(Value::Bool(match operator {
                Operator::And => left && right,
                Operator::Xor => left != right,
                _ => left || right,
            }))
        }
        Operator::Chain => match (left, right) {
            (Value::Frame(left), Value::Frame(right)) => Ok(Value::Frame(chained(left, right))),
            _ => Err(unfit()),
        },
        Operator::Join => match (left, right) {
            (Value::Text(left), Value::Text(right)) if left.len() + right.len() <= LONGEST_TEXT => {
                Ok(Value::Text(format!("{left}{right}")))
            }
            (Value::Text(_), Value::Text(_)) => Err(Fault::new(12160, at, "the text is too long")),
            _ => Err(unfit()),
        },
        Operator::Equal
        | Operator::Unequal
        | Operator::Greater
        | Operator::Less
        | Operator::GreaterOrEqual
        | Operator::LessOrEqual => {
            let order = order(left, right).ok_or_else(unfit)?;
            let is_equality = matches!(operator, Operator::Equal | Operator::Unequal);
            if matches!(left, Value::Axis(_)) && !is_equality {
                return Err(unfit()); // axes have no order
            }
            Ok(Value::Bool(match operator {
                Operator::Equal => order.is_eq(),
                Operator::Unequal => order.is_ne(),
                Operator::Greater => order.is_gt(),
                Operator::Less => order.is_lt(),
                Operator::GreaterOrEqual => order.is_ge(),
                _ => order.is_le(),
            }))
        }
    }
}

/// The longest text of an expression.
const LONGEST_TEXT: usize = 1024;

/// Applies an operator to one value.
pub(super) fn prefix(operator: Prefix, value: &Value, at: Span) -> Result<Value, Fault> {
    let unfit = || Fault::new(12150, at, format!("the operator does not take {}", value.of_type().name()));
    match (operator, value) {
        (Prefix::Minus, Value::Real(number)) => Ok(Value::Real(-number)),
        (Prefix::Minus, _) => {
            let negative = -value.whole().ok_or_else(unfit)?;
            i32::try_from(negative).map(Value::Int).map_err(|_| overflow(at, "INT"))
        }
        (Prefix::Not, _) => Ok(Value::Bool(value.number().ok_or_else(unfit)? == 0.0)),
        (Prefix::BitNot, _) => {
            let inverse = !value.whole().ok_or_else(unfit)?;
            i32::try_from(inverse).map(Value::Int).map_err(|_| overflow(at, "INT"))
        }
    }
}

/// How two values of one kind follow each other.
fn order(left: &Value, right: &Value) -> Option<std::cmp::Ordering> {
    match (left, right) {
        (Value::Text(left), Value::Text(right)) => Some(left.cmp(right)),
        (Value::Axis(left), Value::Axis(right)) => Some(left.cmp(right)),
        (Value::Char(left), Value::Text(right)) => Some(char::from(*left).to_string().as_str().cmp(right)),
        (Value::Text(left), Value::Char(right)) => Some(left.as_str().cmp(char::from(*right).to_string().as_str())),
        _ => {
            let (left, right) = (left.number()?, right.number()?);
            let is_equal = (left - right).abs() <= TOLERANCE * left.abs().max(right.abs());
            if is_equal { Some(std::cmp::Ordering::Equal) } else { left.partial_cmp(&right) }
        }
    }
}

/// The part by which equal REALs may differ.
const TOLERANCE: f64 = 1e-12;

/// A REAL result, unless it overflows.
pub(super) fn real(number: f64, at: Span) -> Result<Value, Fault> {
    if number.is_finite() { Ok(Value::Real(number)) } else { Err(overflow(at, "REAL")) }
}

fn nonzero(number: f64, at: Span) -> Result<f64, Fault> {
    if number == 0.0 { Err(zero(at)) } else { Ok(number) }
}

fn zero(at: Span) -> Fault {
    Fault::new(14051, at, "division by zero")
}

fn overflow(at: Span, kind: &str) -> Fault {
    Fault::new(14051, at, format!("the result is outside the range of {kind}"))
}
