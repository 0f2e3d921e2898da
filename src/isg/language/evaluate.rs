//! The values of expressions: `+ − × ÷ sqrt` and the functions of `nc_program`, so the same bits on every computer.
//!
//! Inside the check a value that only a run knows is not a number (NaN). It makes every result unknown, and is never an error.

use crate::nc_program::{acos, asin, atan2, cos, exp, ln, sin, tan};

use super::expression::{Expression, Function, Operator, Place};
use super::fault::Error;

/// Values of variables.
pub(super) trait Values {
    /// The value of a variable; none if it does not exist.
    fn value(&self, name: &str) -> Option<f64>;
}

/// The value of an expression.
pub(super) fn evaluate(expression: &Expression, values: &dyn Values) -> Result<f64, Error> {
    match expression {
        Expression::Number(number) => Ok(*number),
        Expression::Variable(place) => {
            let name = resolved(place, values)?;
            values.value(&name).ok_or_else(|| {
                let cure = if name.starts_with('P') || name.starts_with("V.L.") || name.starts_with("V.P.") {
                    "it has no value yet; assign one before"
                } else {
                    "the channel has no such variable"
                };
                Error::value(place.at, format!("{name} cannot be read: {cure}"))
            })
        }
        Expression::Minus(inner) => Ok(-evaluate(inner, values)?),
        Expression::Binary { operator, left, right, at } => {
            let (left, right) = (evaluate(left, values)?, evaluate(right, values)?);
            if left.is_nan() || right.is_nan() {
                return Ok(f64::NAN);
            }
            finite(binary(*operator, left, right, *at)?, *at)
        }
        Expression::Function { function, arguments, at } => {
            let mut of = [0.0; 2];
            for (value, argument) in of.iter_mut().zip(arguments) {
                *value = evaluate(argument, values)?;
            }
            if of.iter().any(|value| value.is_nan()) {
                return Ok(f64::NAN);
            }
            let result = apply(*function, of[0], of[1]);
            let result =
                result.ok_or_else(|| Error::value(*at, format!("the function is not defined for {}", of[0])))?;
            finite(result, *at)
        }
    }
}

/// The name of a variable with the values of its indices.
pub(super) fn resolved(place: &Place, values: &dyn Values) -> Result<String, Error> {
    let mut name = String::with_capacity(place.name.len());
    let mut parts = place.name.split("[]");
    name.push_str(parts.next().unwrap_or_default());
    for (index, part) in place.indices.iter().zip(parts) {
        match whole(evaluate(index, values)?, "an index", place.at)? {
            Some(index) => name.push_str(&format!("[{index}]")),
            None => name.push_str("[]"),
        }
        name.push_str(part);
    }
    Ok(name)
}

/// A whole number; none for a value that is not known.
pub(super) fn whole(value: f64, what: &str, at: usize) -> Result<Option<i64>, Error> {
    if value.is_nan() {
        return Ok(None);
    }
    let number = integer(value).ok_or_else(|| Error::value(at, format!("{what} is a whole number, found {value}")))?;
    Ok(Some(number))
}

/// Whether a value counts as true: 0.5 or more, without its sign.
pub(super) fn is_true(value: f64) -> bool {
    value.abs() >= 0.5
}

/// The largest number whose neighbours are whole numbers, too: 2 to the 53.
const LARGEST: f64 = 9_007_199_254_740_992.0;

#[expect(clippy::cast_possible_truncation, clippy::float_cmp, reason = "a whole number in the range")]
fn integer(value: f64) -> Option<i64> {
    (value.abs() <= LARGEST && value == value.trunc()).then_some(value as i64)
}

#[expect(clippy::cast_precision_loss, reason = "results of bit operators on 53 bits have at most 54")]
fn bits(left: f64, right: f64, at: usize, operator: impl Fn(i64, i64) -> i64) -> Result<f64, Error> {
    match (integer(left), integer(right)) {
        (Some(left), Some(right)) => Ok(operator(left, right) as f64),
        _ => Err(Error::value(at, format!("bit operators need whole numbers, found {left} and {right}"))),
    }
}

#[expect(clippy::float_cmp, reason = "comparisons of the language are exact")]
fn binary(operator: Operator, left: f64, right: f64, at: usize) -> Result<f64, Error> {
    let truth = |is_it: bool| Ok(if is_it { 1.0 } else { 0.0 });
    match operator {
        Operator::Power => {
            power(left, right).ok_or_else(|| Error::value(at, format!("{left} ** {right} has no value")))
        }
        Operator::Multiply => Ok(left * right),
        Operator::Divide | Operator::Modulo if right == 0.0 => Err(Error::value(at, "division by zero")),
        Operator::Divide => Ok(left / right),
        Operator::Modulo => Ok(left % right),
        Operator::Add => Ok(left + right),
        Operator::Subtract => Ok(left - right),
        Operator::BitAnd => bits(left, right, at, |left, right| left & right),
        Operator::BitXor => bits(left, right, at, |left, right| left ^ right),
        Operator::BitOr => bits(left, right, at, |left, right| left | right),
        Operator::Equal => truth(left == right),
        Operator::Unequal => truth(left != right),
        Operator::LessOrEqual => truth(left <= right),
        Operator::GreaterOrEqual => truth(left >= right),
        Operator::Less => truth(left < right),
        Operator::Greater => truth(left > right),
        Operator::And => truth(is_true(left) && is_true(right)),
        Operator::Xor => truth(is_true(left) != is_true(right)),
        Operator::Or => truth(is_true(left) || is_true(right)),
    }
}

fn apply(function: Function, x: f64, second: f64) -> Option<f64> {
    match function {
        Function::Abs => Some(x.abs()),
        Function::Square => Some(x * x),
        Function::Root => (x >= 0.0).then(|| x.sqrt()),
        Function::Exponential => Some(exp(x)),
        Function::Logarithm => (x > 0.0).then(|| ln(x)),
        Function::PowerOfTen => power(10.0, x),
        Function::LogarithmOfTen => (x > 0.0).then(|| logarithm_of_ten(x)),
        Function::Sine => Some(sin(x)),
        Function::Cosine => Some(cos(x)),
        Function::Tangent => tan(x),
        Function::Cotangent => (sin(x) != 0.0).then(|| cos(x) / sin(x)),
        Function::ArcSine => asin(x),
        Function::ArcCosine => acos(x),
        Function::ArcTangent => Some(atan2(x, 1.0)),
        Function::ArcCotangent => Some(90.0 - atan2(x, 1.0)),
        Function::ArcTangentOfTwo => Some(atan2(x, second)),
        Function::Integer => Some(x.trunc()),
        Function::Fraction => Some(x - x.trunc()),
        Function::Round => Some(x.round()),
        Function::Not => Some(if is_true(x) { 0.0 } else { 1.0 }),
        Function::Invert => bits(x, -1.0, 0, |x, ones| x ^ ones).ok(),
        Function::Ceiling => Some(x.ceil()),
        Function::Floor => Some(x.floor()),
        Function::Minimum => Some(x.min(second)),
        Function::Maximum => Some(x.max(second)),
    }
}

/// Whole exponents by multiplication, so that they are exact where they can be.
const WHOLE_EXPONENTS: i64 = 1024;

fn power(base: f64, exponent: f64) -> Option<f64> {
    if let Some(whole) = integer(exponent).filter(|whole| whole.abs() <= WHOLE_EXPONENTS) {
        let (mut result, mut square, mut left) = (1.0, base, whole.unsigned_abs());
        while left > 0 {
            if left % 2 == 1 {
                result *= square;
            }
            square *= square;
            left /= 2;
        }
        return match whole < 0 {
            true if base == 0.0 => None,
            true => Some(1.0 / result),
            false => Some(result),
        };
    }
    match base {
        0.0 => (exponent > 0.0).then_some(0.0),
        base if base > 0.0 => Some(exp(exponent * ln(base))),
        _ => None,
    }
}

/// Exact for powers of ten.
fn logarithm_of_ten(x: f64) -> f64 {
    let logarithm = ln(x) / ln(10.0);
    let nearest = logarithm.round();
    if power(10.0, nearest) == Some(x) { nearest } else { logarithm }
}

fn finite(value: f64, at: usize) -> Result<f64, Error> {
    if value.is_finite() { Ok(value) } else { Err(Error::value(at, "the result is too large")) }
}
