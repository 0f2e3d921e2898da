//! Values in files: the values that a location accepts, and their bits.

use crate::source::{Node, Problem, Value};

use super::{Format, Location, OverrideCoding};

/// The raw bits of a value from a file. A whole number must fit (a negative number as two's complement). A number with a fraction requires
/// a REAL, `true` and `false` require a bit, `"100%"` requires an override. A text such as `"2#1101_0000"` or `"16#D0"` is a whole number.
///
/// # Errors
/// The value does not fit; the problem names its place in the file.
pub fn raw_value(node: &Node, location: Location, coding: OverrideCoding) -> Result<u64, Problem> {
    match &node.value {
        Value::Boolean(value) if location.width == 1 => Ok(u64::from(*value)),
        Value::Boolean(_) => Err(node.expected("a number", "use true and false for single bits only")),
        Value::Integer(number) => integer(*number, node, location),
        Value::Float(number) if location.format == Format::Real => real(*number, node),
        Value::Float(_) => {
            Err(node.expected("a whole number", "add :REAL to the address; only a REAL accepts fractions"))
        }
        Value::Text(text) => match (text.strip_suffix('%'), based(text)) {
            (Some(percent), _) => per_cent(percent, node, location, coding),
            (None, Some(number)) => integer(number, node, location),
            (None, None) => Err(node.expected("a number, true, false or \"100%\"", "write numbers without quotes")),
        },
        Value::Array(_) | Value::Table(_) => Err(node.expected("one value", "write one entry for each address")),
    }
}

/// The number of a text with a base: `2#1101_0000`, `8#17`, `16#D0`.
fn based(text: &str) -> Option<i64> {
    let (base, digits) = text.split_once('#')?;
    let base = match base {
        "2" => 2,
        "8" => 8,
        "16" => 16,
        _ => return None,
    };
    i64::from_str_radix(&digits.replace('_', ""), base).ok()
}

fn integer(number: i64, node: &Node, location: Location) -> Result<u64, Problem> {
    if location.format == Format::Real {
        return real(number as f64, node);
    }
    let half = 1_i64 << (location.width - 1);
    let (least, most) = match (location.format, location.width) {
        (_, 1) => (0, 1),
        (Format::Signed, _) => (-half, half - 1),
        (Format::Unsigned | Format::Real, _) => (-half, 2 * half - 1),
    };
    if (least..=most).contains(&number) {
        Ok(number.cast_unsigned() & location.mask())
    } else {
        Err(node.place.problem(
            format!("expected a number from {least} to {most}, found {number}"),
            if location.width == 1 {
                "the address is one bit".to_owned()
            } else {
                format!("the address has {} bits", location.width)
            },
        ))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a REAL has 32 bits; a value that does not fit is rejected below")]
fn real(number: f64, node: &Node) -> Result<u64, Problem> {
    let value = number as f32;
    if value.is_finite() {
        Ok(u64::from(value.to_bits()))
    } else {
        Err(node.expected("a number that fits a REAL", "the largest REAL is 3.4e38"))
    }
}

/// The bits of a value for the signal with this name, as a person writes it: a number that no switch with a Gray code has is refused at the
/// symbol of an override, because a percentage without quotes and sign is meant. At its address, and with a base, every number is possible.
///
/// # Errors
/// The value does not fit the location.
pub fn signal_value(name: &str, node: &Node, location: Location, coding: OverrideCoding) -> Result<u64, Problem> {
    if let Value::Integer(number) = node.value
        && is_no_code(name, number, location, coding)
        && let Some((_, known)) = coding.code(location, None)
    {
        let bits = number.cast_unsigned() & location.mask();
        return Err(node.place.problem(
            format!("expected a percentage or a Gray code from 0 to {LARGEST_GRAY_CODE} for `{name}`, found {number}"),
            format!("write \"{name}\" = \"100%\", or any bits as \"16#{bits:X}\"; its percentages are {known}"),
        ));
    }
    raw_value(node, location, coding)
}

/// Whether a name is the symbol of an override with Gray code, and a number is no code of its switch.
#[must_use]
pub fn is_no_code(name: &str, number: i64, location: Location, coding: OverrideCoding) -> bool {
    let is_symbol =
        name.split_once('.').is_some_and(|(_, signal)| signal.starts_with(|c: char| c.is_ascii_lowercase()));
    is_symbol
        && !(0..=i64::from(LARGEST_GRAY_CODE)).contains(&number)
        && coding.at(location).is_some_and(|(_, gray)| gray)
}

/// The largest code of an override switch with Gray code, which has five bits.
const LARGEST_GRAY_CODE: u8 = 31;

fn per_cent(text: &str, node: &Node, location: Location, coding: OverrideCoding) -> Result<u64, Problem> {
    let Some((code, known)) = coding.code(location, text.trim().parse().ok()) else {
        let mut takers: Vec<_> = coding.interface.tables().overrides.iter().map(|(signal, _)| signal.name).collect();
        takers.dedup();
        let cure = match &takers[..] {
            [] => "no signal of this control accepts a percentage".to_owned(),
            takers => format!("only {} accept a percentage", takers.join(" and ")),
        };
        return Err(node.expected("a plain number", &cure));
    };
    code.map(u64::from)
        .ok_or_else(|| node.expected("a percentage of the override switch", &format!("its percentages are {known}")))
}
