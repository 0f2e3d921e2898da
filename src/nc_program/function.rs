//! Functions of expressions. Angles are in degrees.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::frames::ctrans;
use super::operator::real;
use super::trigonometry as angle;
use super::value::{Type, Value, integer, round};

/// A function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Function {
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Angle of a vector (y, x).
    Atan2,
    /// Square root.
    Sqrt,
    /// Absolute value.
    Abs,
    /// Square.
    Pot,
    /// Cuts to a whole number.
    Trunc,
    /// Rounds, one half upwards.
    Round,
    /// Rounds to the next higher whole number.
    RoundUp,
    /// Natural logarithm.
    Ln,
    /// Exponential function.
    Exp,
    /// The smaller one.
    MinVal,
    /// The larger one.
    MaxVal,
    /// A value limited to a range (minimum, maximum, value).
    Bound,
    /// The number in a text.
    Number,
    /// Whether a text is a number.
    IsNumber,
    /// The length of a text.
    StrLen,
    /// A text in capitals.
    ToUpper,
    /// A text in small letters.
    ToLower,
    /// The place of a character in a text, from zero; −1 without it.
    Index,
    /// The last place of a character.
    RIndex,
    /// The first place of one of several characters.
    MIndex,
    /// The place of a text in a text.
    Match,
    /// A part of a text (text, first character from zero, number of characters).
    SubStr,
    /// The frame with these offsets (axis, offset, …).
    Ctrans,
}

/// Names, with the least and the largest number of parameters.
pub(super) const FUNCTIONS: &[(&str, Function, usize, usize)] = &[
    ("SIN", Function::Sin, 1, 1),
    ("COS", Function::Cos, 1, 1),
    ("TAN", Function::Tan, 1, 1),
    ("ASIN", Function::Asin, 1, 1),
    ("ACOS", Function::Acos, 1, 1),
    ("ATAN2", Function::Atan2, 2, 2),
    ("SQRT", Function::Sqrt, 1, 1),
    ("ABS", Function::Abs, 1, 1),
    ("POT", Function::Pot, 1, 1),
    ("TRUNC", Function::Trunc, 1, 1),
    ("ROUND", Function::Round, 1, 1),
    ("ROUNDUP", Function::RoundUp, 1, 1),
    ("LN", Function::Ln, 1, 1),
    ("EXP", Function::Exp, 1, 1),
    ("MINVAL", Function::MinVal, 2, 2),
    ("MAXVAL", Function::MaxVal, 2, 2),
    ("BOUND", Function::Bound, 3, 3),
    ("NUMBER", Function::Number, 1, 1),
    ("ISNUMBER", Function::IsNumber, 1, 1),
    ("STRLEN", Function::StrLen, 1, 1),
    ("TOUPPER", Function::ToUpper, 1, 1),
    ("TOLOWER", Function::ToLower, 1, 1),
    ("INDEX", Function::Index, 2, 2),
    ("RINDEX", Function::RIndex, 2, 2),
    ("MINDEX", Function::MIndex, 2, 2),
    ("MATCH", Function::Match, 2, 2),
    ("SUBSTR", Function::SubStr, 2, 3),
    ("CTRANS", Function::Ctrans, 0, 62),
];

impl Function {
    /// The function of this name.
    pub(super) fn find(name: &str) -> Option<Self> {
        FUNCTIONS.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// The least and the largest number of parameters.
    pub(super) fn parameters(self) -> (usize, usize) {
        FUNCTIONS.iter().find(|row| row.1 == self).map_or((0, 0), |row| (row.2, row.3))
    }
}

/// Applies a function. The number of parameters was tested when the block was read.
pub(super) fn apply(function: Function, values: &[Value], at: Span) -> Result<Value, Fault> {
    let unfit = |value: &Value| Fault::new(12150, at, format!("the function does not take {}", value.of_type().name()));
    let missing = || Fault::new(14020, at, "a parameter is missing");
    let number = |index: usize| {
        let value = values.get(index).ok_or_else(missing)?;
        value.number().ok_or_else(|| unfit(value))
    };
    let text = |index: usize| match values.get(index) {
        Some(Value::Text(text)) => Ok(text.as_str()),
        Some(other) => Err(unfit(other)),
        None => Err(missing()),
    };
    let domain = |what: &str| Fault::new(14020, at, what.to_owned());
    match function {
        Function::Sin => real(angle::sin(number(0)?), at),
        Function::Cos => real(angle::cos(number(0)?), at),
        Function::Tan => {
            let found = angle::tan(number(0)?);
            real(found.ok_or_else(|| Fault::new(14051, at, "the tangent is infinite"))?, at)
        }
        Function::Asin => real(angle::asin(number(0)?).ok_or_else(|| domain("a sine is in the range -1 to 1"))?, at),
        Function::Acos => real(angle::acos(number(0)?).ok_or_else(|| domain("a cosine is in the range -1 to 1"))?, at),
        Function::Atan2 => real(angle::atan2(number(0)?, number(1)?), at),
        Function::Sqrt => match number(0)? {
            negative if negative < 0.0 => Err(domain("the square root of a negative number")),
            other => real(other.sqrt(), at),
        },
        Function::Abs => match values.first() {
            Some(Value::Real(value)) => Ok(Value::Real(value.abs())),
            Some(Value::Int(value)) => {
                let positive = value.checked_abs().ok_or_else(|| Fault::new(14051, at, "outside the range of INT"))?;
                Ok(Value::Int(positive))
            }
            _ => real(number(0)?.abs(), at),
        },
        Function::Pot => real(number(0)? * number(0)?, at),
        Function::Trunc => whole(number(0)?.trunc(), at),
        Function::Round => whole(round(number(0)?), at),
        Function::RoundUp => whole(number(0)?.ceil(), at),
        Function::Ln => match number(0)? {
            positive if positive > 0.0 => real(angle::ln(positive), at),
            _ => Err(domain("the logarithm of a number that is not positive")),
        },
        Function::Exp => real(angle::exp(number(0)?), at),
        Function::MinVal => selected(values, number(0)? <= number(1)?, at),
        Function::MaxVal => selected(values, number(0)? >= number(1)?, at),
        Function::Bound => {
            let (least, most, value) = (number(0)?, number(1)?, number(2)?);
            if least > most {
                return Err(domain("the minimum is larger than the maximum"));
            }
            real(value.clamp(least, most), at)
        }
        Function::Number => real(parsed(text(0)?).ok_or_else(|| domain("the text is not a number"))?, at),
        Function::IsNumber => Ok(Value::Bool(parsed(text(0)?).is_some())),
        Function::StrLen => whole_of(text(0)?.chars().count(), at),
        Function::ToUpper => Ok(Value::Text(text(0)?.to_uppercase())),
        Function::ToLower => Ok(Value::Text(text(0)?.to_lowercase())),
        Function::Index | Function::RIndex | Function::MIndex | Function::Match => {
            let (within, wanted) =
                (text(0)?, part(values.get(1).ok_or_else(missing)?).ok_or_else(|| unfit(&values[1]))?);
            let is_one = wanted.chars().count() == 1;
            let has = |letter: &char| wanted.contains(*letter);
            let place = match function {
                Function::MIndex => within.chars().position(|letter| has(&letter)),
                Function::Match => within.find(&wanted).map(|byte| within[..byte].chars().count()),
                _ if !is_one => return Err(unfit(&values[1])),
                Function::RIndex => within
                    .chars()
                    .rev()
                    .position(|letter| has(&letter))
                    .map(|behind| within.chars().count() - 1 - behind),
                _ => within.chars().position(|letter| has(&letter)),
            };
            place.map_or(Ok(Value::Int(-1)), |place| whole_of(place, at))
        }
        Function::SubStr => {
            let place = |index: usize| -> Result<usize, Fault> {
                let found = integer(number(index)?, at)?;
                usize::try_from(found).map_err(|_| domain("a place in a text is not negative"))
            };
            let letters = text(0)?.chars().skip(place(1)?);
            let length = if values.len() > 2 { place(2)? } else { usize::MAX };
            Ok(Value::Text(letters.take(length).collect()))
        }
        Function::Ctrans => ctrans(values, at),
    }
}

/// A character or a text.
fn part(value: &Value) -> Option<String> {
    match value {
        Value::Char(code) => Some(char::from(*code).to_string()),
        Value::Text(text) => Some(text.clone()),
        _ => None,
    }
}

/// A number as text has the form of the language or the one with `E`.
fn parsed(text: &str) -> Option<f64> {
    let text = text.trim().to_ascii_uppercase().replace("EX", "E");
    let is_decimal = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.E".contains(&byte));
    text.parse().ok().filter(|_| is_decimal).filter(|number: &f64| number.is_finite())
}

fn selected(values: &[Value], is_first: bool, at: Span) -> Result<Value, Fault> {
    let is_whole = values.iter().all(|value| value.whole().is_some());
    let value = if is_first { &values[0] } else { &values[1] };
    value.clone().convert(if is_whole { Type::Int } else { Type::Real }, at)
}

/// A whole result is INT.
fn whole(number: f64, at: Span) -> Result<Value, Fault> {
    let out = |_| Fault::new(14051, at, "the result is outside the range of INT");
    integer(number, at).map(Value::Int).map_err(out)
}

fn whole_of(count: usize, at: Span) -> Result<Value, Fault> {
    i32::try_from(count).map(Value::Int).map_err(|_| Fault::new(14051, at, "the result is outside the range of INT"))
}
