//! Values of entries: a text of a list or a value of a scenario, typed as its parameter demands.

use crate::control::Value;
use crate::source::Problem;

use super::lines::{number, word};
use super::parameter::{Index, Parameter, Type};

/// A value that was read from a line, and a text behind it that has no meaning.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ReadValue<'a> {
    pub(super) value: Value,
    pub(super) ignored: &'a str,
}

/// The value of a parameter in what follows its name on a line.
///
/// # Errors
/// There is no value, it has the wrong type, or it is beyond its data type.
pub(super) fn read<'a>(parameter: &Parameter, index: Index, rest: &'a str) -> Result<ReadValue<'a>, Problem> {
    if parameter.kind == Type::String {
        let word = word(rest).map_err(|what| wrong(parameter, index, &what))?;
        if word.text.is_empty() && !rest.starts_with('"') {
            return Err(missing(parameter, index));
        }
        return Ok(ReadValue { value: Value::Text(word.text.to_owned()), ignored: word.ignored });
    }
    let text = number(rest);
    if text.is_empty() {
        return Err(missing(parameter, index));
    }
    Ok(ReadValue { value: typed(parameter, index, text)?, ignored: "" })
}

/// A value of a scenario as the value of a parameter, checked as in a list.
///
/// # Errors
/// It has the wrong type, or it is beyond its data type.
pub(super) fn convert(parameter: &Parameter, index: Index, value: &Value) -> Result<Value, Problem> {
    match (parameter.kind, value) {
        (Type::String, Value::Text(text)) => Ok(Value::Text(text.trim().to_owned())),
        (Type::String, Value::Integer(_) | Value::Real(_) | Value::Boolean(_)) => {
            Err(wrong(parameter, index, &format!("a word in quotes, found {value}")))
        }
        (Type::Boolean, Value::Boolean(value)) => Ok(Value::Integer(i64::from(*value))),
        (_, Value::Boolean(value)) => Err(wrong(parameter, index, &format!("a number, found {value}"))),
        (_, Value::Text(text)) => typed(parameter, index, text.trim()),
        (_, Value::Integer(number)) => typed(parameter, index, &number.to_string()),
        (Type::Real64, Value::Real(number)) if number.is_finite() => Ok(Value::Real(*number)),
        (_, Value::Real(number)) => typed(parameter, index, &format!("{number:?}")),
    }
}

/// The value of a text for a parameter that is no word.
fn typed(parameter: &Parameter, index: Index, text: &str) -> Result<Value, Problem> {
    let Some([least, most]) = parameter.kind.whole_numbers() else {
        return match real(text) {
            Some(number) => Ok(Value::Real(number)),
            None => Err(wrong(parameter, index, &format!("a number, found `{text}`"))),
        };
    };
    match whole(text) {
        Some(number) if (i128::from(least)..=i128::from(most)).contains(&number) => {
            // Within 64 bits, as every limit of a type is.
            Ok(Value::Integer(i64::try_from(number).unwrap_or_default()))
        }
        Some(_) => {
            Err(wrong(parameter, index, &format!("a number from {least} to {most} ({}), found {text}", parameter.kind)))
        }
        None => Err(wrong(parameter, index, &format!("a whole number ({}), found `{text}`", parameter.kind))),
    }
}

/// A whole number, decimal or as `0x…`, with or without a sign. A number of many digits is a number that is beyond every type.
fn whole(text: &str) -> Option<i128> {
    let (sign, digits) = match text.strip_prefix('-') {
        Some(digits) => (-1, digits),
        None => (1, text.strip_prefix('+').unwrap_or(text)),
    };
    let (radix, digits) = match digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        Some(digits) => (16, digits),
        None => (10, digits),
    };
    if digits.is_empty() || !digits.chars().all(|digit| digit.is_digit(radix)) {
        return None;
    }
    Some(sign * i128::from_str_radix(digits, radix).unwrap_or(i128::MAX))
}

/// A finite number.
fn real(text: &str) -> Option<f64> {
    let is_number = text.contains(|letter: char| letter.is_ascii_digit());
    match text.parse::<f64>() {
        Ok(number) => Some(number).filter(|number| is_number && number.is_finite()),
        #[expect(clippy::cast_precision_loss, reason = "a whole number where a fraction is allowed")]
        Err(_) => whole(text).map(|number| number as f64),
    }
}

fn wrong(parameter: &Parameter, index: Index, what: &str) -> Problem {
    let cure = match parameter.kind {
        Type::Boolean => "write 0 or 1".to_owned(),
        _ if parameter.range.is_empty() => "correct the value".to_owned(),
        _ => format!("allowed: {}", parameter.range),
    };
    Problem::new(format!("{}: expected {what}", parameter.title(index)), cure)
}

fn missing(parameter: &Parameter, index: Index) -> Problem {
    let what = format!("{}: expected a value ({}), found none", parameter.title(index), parameter.kind);
    Problem::new(what, "write the value behind the name, or remove the line")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isg::lists::name::parameter;

    fn read_as(name: &str, rest: &str) -> Result<Value, Problem> {
        let (parameter, index) = parameter(name).unwrap();
        read(parameter, index, rest).map(|read| read.value)
    }

    /// HG-28: decimal, negative and hexadecimal numbers, and words.
    #[test]
    fn values_are_typed_by_their_parameter() {
        let whole = |number| Ok(Value::Integer(number));
        assert_eq!(read_as("kenngr.achs_mode", "0x00020001"), whole(0x0002_0001));
        assert_eq!(read_as("kenngr.achs_mode", "4294967295"), whole(4_294_967_295));
        assert_eq!(read_as("kenngr.gantry_offset", "-500 ; 50 µm"), whole(-500));
        assert_eq!(read_as("kenngr.gantry_ax_nr", "65535"), whole(65535));
        assert_eq!(read_as("P-AXIS-00261", "1"), whole(1));
        assert_eq!(read_as("prog_start.feedrate_factor", "0.1"), Ok(Value::Real(0.1)));
        assert_eq!(read_as("prog_start.feedrate_factor", "100"), Ok(Value::Real(100.0)));
        assert_eq!(read_as("kenngr.gantry_on_mode", "CONFIG"), Ok(Value::Text("CONFIG".to_owned())));
    }

    /// HG-28: a word or a fraction where a whole number belongs, and a number beyond its data type, cannot be read.
    #[test]
    fn what_does_not_fit_the_type_is_an_error() {
        for (name, rest) in [
            ("kenngr.gantry_ax_nr", "X"),
            ("kenngr.gantry_ax_nr", "1.0"),
            ("kenngr.gantry_ax_nr", "1e2"),
            ("kenngr.gantry_ax_nr", "65536"),
            ("kenngr.gantry_ax_nr", "-1"),
            ("kenngr.gantry_ax_nr", "0x"),
            ("kenngr.gantry_ax_nr", "0xG"),
            ("kenngr.gantry_ax_nr", "\"1\""),
            ("kenngr.gantry_ax_nr", ""),
            ("kenngr.gantry_ax_nr", "# 1"),
            ("kenngr.gantry_offset", "2147483648"),
            ("kenngr.gantry_offset", "-2147483649"),
            ("kenngr.gantry_max_diff_resetable", "4294967296"),
            ("kenngr.gantry_max_diff_resetable", "99999999999999999999999999999999999999999999"),
            ("kenngr.gantry_slave_no_homing", "2"),
            ("kenngr.gantry_slave_no_homing", "TRUE"),
            ("prog_start.feedrate", "NaN"),
            ("prog_start.feedrate", "inf"),
            ("prog_start.feedrate", "X"),
            ("prog_start.feedrate", "1e999"),
            ("kenngr.gantry_on_mode", ""),
            ("kenngr.gantry_on_mode", "( CONFIG"),
            ("kenngr.gantry_on_mode", "\"CONFIG"),
        ] {
            assert!(read_as(name, rest).is_err(), "{name} {rest}");
        }
        let problem = read_as("kenngr.gantry_ax_nr", "65536").unwrap_err();
        let expected = "P-AXIS-00070 kenngr.gantry_ax_nr: expected a number from 0 to 65535 (UNS16), found 65536\n  \
            allowed: 1 … 65535; 0 = none";
        assert_eq!(problem.to_string(), expected);
    }

    /// HG-28: a scenario gives numbers as TOML has them, or as a list has them.
    #[test]
    fn values_of_a_scenario_are_checked_as_in_a_list() {
        let convert = |name: &str, value: Value| {
            let (parameter, index) = parameter(name).unwrap();
            convert(parameter, index, &value)
        };
        let text = |text: &str| Value::Text(text.to_owned());
        assert_eq!(convert("kenngr.achs_mode", text("0x20001")), Ok(Value::Integer(0x20001)));
        assert_eq!(convert("kenngr.gantry_ax_nr", Value::Integer(5)), Ok(Value::Integer(5)));
        assert_eq!(convert("P-AXIS-00261", Value::Boolean(true)), Ok(Value::Integer(1)));
        assert_eq!(convert("prog_start.feedrate", Value::Integer(5)), Ok(Value::Real(5.0)));
        assert_eq!(convert("kenngr.gantry_on_mode", text("CONFIG")), Ok(text("CONFIG")));
        assert!(convert("kenngr.gantry_on_mode", Value::Integer(1)).is_err());
        assert!(convert("kenngr.gantry_ax_nr", Value::Real(1.0)).is_err());
        assert!(convert("kenngr.gantry_ax_nr", Value::Integer(-1)).is_err());
        assert!(convert("kenngr.gantry_ax_nr", Value::Boolean(true)).is_err());
        assert!(convert("P-AXIS-00261", Value::Integer(2)).is_err());
        assert!(convert("prog_start.feedrate", Value::Real(f64::NAN)).is_err());
    }
}
