//! Values of the NC language: their types and conversions.
//!
//! REAL to INT rounds, one half upwards. A number is TRUE as BOOL if it is not 0; BOOL is 0 or 1 as a number. STRING, AXIS and FRAME convert only to
//! themselves, except a string of one character to CHAR.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::names::AxisIndex;

/// A value.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Value {
    /// INT, 32 bits.
    Int(i32),
    /// REAL.
    Real(f64),
    /// BOOL.
    Bool(bool),
    /// CHAR: the code of a character.
    Char(u8),
    /// STRING.
    Text(String),
    /// AXIS.
    Axis(AxisIndex),
    /// FRAME: the offset of each axis that has one. Rotation, scale and mirror image do not exist here.
    Frame(Vec<(AxisIndex, f64)>),
}

/// A type of variables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Type {
    /// INT.
    Int,
    /// REAL.
    Real,
    /// BOOL.
    Bool,
    /// CHAR.
    Char,
    /// STRING with at most this number of characters.
    Text(u16),
    /// AXIS.
    Axis,
    /// FRAME.
    Frame,
}

impl Type {
    /// The keyword.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Int => "INT",
            Self::Real => "REAL",
            Self::Bool => "BOOL",
            Self::Char => "CHAR",
            Self::Text(_) => "STRING",
            Self::Axis => "AXIS",
            Self::Frame => "FRAME",
        }
    }

    /// The value of a variable without an initial value. An AXIS then has no axis.
    pub(super) fn initial(self) -> Value {
        match self {
            Self::Int => Value::Int(0),
            Self::Real => Value::Real(0.0),
            Self::Bool => Value::Bool(false),
            Self::Char => Value::Char(0),
            Self::Text(_) => Value::Text(String::new()),
            Self::Axis => Value::Axis(AxisIndex(u16::MAX)),
            Self::Frame => Value::Frame(Vec::new()),
        }
    }
}

impl Value {
    /// The type; a string has the largest length.
    #[must_use]
    pub fn of_type(&self) -> Type {
        match self {
            Self::Int(_) => Type::Int,
            Self::Real(_) => Type::Real,
            Self::Bool(_) => Type::Bool,
            Self::Char(_) => Type::Char,
            Self::Text(_) => Type::Text(u16::MAX),
            Self::Axis(_) => Type::Axis,
            Self::Frame(_) => Type::Frame,
        }
    }

    /// The number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Int(value) => Some(f64::from(*value)),
            Self::Real(value) => Some(*value),
            Self::Bool(value) => Some(f64::from(u8::from(*value))),
            Self::Char(value) => Some(f64::from(*value)),
            Self::Text(_) | Self::Axis(_) | Self::Frame(_) => None,
        }
    }

    /// The whole number, if it is a number without REAL.
    pub(super) fn whole(&self) -> Option<i64> {
        match self {
            Self::Int(value) => Some(i64::from(*value)),
            Self::Bool(value) => Some(i64::from(*value)),
            Self::Char(value) => Some(i64::from(*value)),
            Self::Real(_) | Self::Text(_) | Self::Axis(_) | Self::Frame(_) => None,
        }
    }

    /// The value as another type.
    pub(super) fn convert(self, to: Type, at: Span) -> Result<Self, Fault> {
        let unfit = |found: &Self| {
            let reason = format!("{} does not convert to {}", found.of_type().name(), to.name());
            Fault::new(12150, at, reason)
        };
        match (to, self) {
            (Type::Int, found) => integer(found.number().ok_or_else(|| unfit(&found))?, at).map(Self::Int),
            (Type::Real, found) => found.number().map(Self::Real).ok_or_else(|| unfit(&found)),
            (Type::Bool, found) => found.number().map(|number| Self::Bool(number != 0.0)).ok_or_else(|| unfit(&found)),
            (Type::Char, Self::Text(text)) => match text.as_bytes() {
                [] => Ok(Self::Char(0)),
                [one] => Ok(Self::Char(*one)),
                _ => Err(unfit(&Self::Text(text))),
            },
            (Type::Char, found) => {
                let whole = integer(found.number().ok_or_else(|| unfit(&found))?, at)?;
                let out = || Fault::new(12160, at, format!("{whole} is not in the range 0 to 255 of CHAR"));
                u8::try_from(whole).map(Self::Char).map_err(|_| out())
            }
            (Type::Text(length), Self::Text(text)) => {
                let found = text.chars().count();
                if found > usize::from(length) {
                    let reason = format!("{found} characters, the variable has {length}");
                    return Err(Fault::new(12160, at, reason));
                }
                Ok(Self::Text(text))
            }
            (Type::Axis, found @ Self::Axis(_)) | (Type::Frame, found @ Self::Frame(_)) => Ok(found),
            (Type::Text(_) | Type::Axis | Type::Frame, found) => Err(unfit(&found)),
        }
    }
}

/// A number as INT: rounded, one half upwards.
pub(super) fn integer(number: f64, at: Span) -> Result<i32, Fault> {
    let rounded = round(number);
    if rounded >= f64::from(i32::MIN) && rounded <= f64::from(i32::MAX) {
        #[expect(clippy::cast_possible_truncation, reason = "the range is tested")]
        return Ok(rounded as i32);
    }
    Err(Fault::new(12160, at, format!("{number} is outside the range of INT")))
}

/// Rounds, one half upwards.
pub(super) fn round(number: f64) -> f64 {
    let below = number.floor();
    if number - below >= 0.5 { below + 1.0 } else { below }
}

/// A number as a program shows it in a text: without superfluous zeros.
pub(super) fn shown(number: f64) -> String {
    if number != 0.0 && !(1e-6..1e15).contains(&number.abs()) {
        return format!("{number:e}").replace('e', "EX");
    }
    let text = format!("{number:.10}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reals_round_to_integers_one_half_upwards() {
        for (real, whole) in [(0.5, 1), (-0.5, 0), (1.4999, 1), (-1.5, -1), (-1.6, -2), (0.499_999_999_999_999_94, 0)] {
            assert_eq!(Value::Real(real).convert(Type::Int, Span::default()), Ok(Value::Int(whole)), "{real}");
        }
        assert_eq!(Value::Real(3e9).convert(Type::Int, Span::default()).unwrap_err().number, 12160);
    }

    #[test]
    fn values_convert_as_the_table_says() {
        let convert = |value: Value, to| value.convert(to, Span::default()).map_err(|fault| fault.number);
        assert_eq!(convert(Value::Real(0.1), Type::Bool), Ok(Value::Bool(true)));
        assert_eq!(convert(Value::Bool(true), Type::Real), Ok(Value::Real(1.0)));
        assert_eq!(convert(Value::Text("A".to_owned()), Type::Char), Ok(Value::Char(65)));
        assert_eq!(convert(Value::Text("A".to_owned()), Type::Int), Err(12150));
        assert_eq!(convert(Value::Axis(AxisIndex(0)), Type::Real), Err(12150));
        assert_eq!(convert(Value::Int(1), Type::Axis), Err(12150));
        assert_eq!(convert(Value::Int(300), Type::Char), Err(12160));
        assert_eq!(convert(Value::Text("ABC".to_owned()), Type::Text(2)), Err(12160));
    }

    #[test]
    fn numbers_are_shown_without_superfluous_zeros() {
        for (number, text) in [(1.5, "1.5"), (-2.0, "-2"), (0.1 + 0.2, "0.3"), (1e20, "1EX20"), (0.0, "0")] {
            assert_eq!(shown(number), text);
        }
    }
}
