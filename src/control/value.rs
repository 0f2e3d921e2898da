//! A value of a machine datum, as given in an archive or a scenario, and as the control writes it.

use std::fmt;

use crate::source::{self, Node, Problem};

/// A value before conversion to the type of a datum, and when it is read back.
#[derive(serde::Serialize, serde::Deserialize, Clone, Debug, PartialEq)]
pub enum Value {
    /// `TRUE`, `true`.
    Boolean(bool),
    /// `12`, `'H1c'`, `'B1000'`.
    Integer(i64),
    /// `1.5`, `1EX-05`.
    Real(f64),
    /// `"X1"`.
    Text(String),
}

impl Value {
    /// Reads a value in the syntax of an ASCII archive; `None` if the text is not a value. `inf` and `NaN` are not
    /// values.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        if let Some(inner) = text.strip_prefix('"') {
            return inner
                .strip_suffix('"')
                .filter(|inner| !inner.contains('"'))
                .map(|inner| Self::Text(inner.to_owned()));
        }
        if let Some(inner) = text.strip_prefix('\'') {
            let inner = inner.strip_suffix('\'')?;
            let radix = match inner.as_bytes().first()? {
                b'H' | b'h' => 16,
                b'B' | b'b' => 2,
                _ => return None,
            };
            let digits = &inner[1..];
            return digits
                .bytes()
                .all(|digit| digit.is_ascii_alphanumeric())
                .then(|| i64::from_str_radix(digits, radix).ok().map(Self::Integer))?;
        }
        if text.eq_ignore_ascii_case("TRUE") {
            return Some(Self::Boolean(true));
        }
        if text.eq_ignore_ascii_case("FALSE") {
            return Some(Self::Boolean(false));
        }
        let starts_as_number = |text: &str| {
            text.trim_start_matches(['+', '-']).starts_with(|first: char| first.is_ascii_digit() || first == '.')
        };
        if !starts_as_number(text) {
            return None;
        }
        if let Ok(integer) = text.parse() {
            return Some(Self::Integer(integer));
        }
        // The control writes the exponent of ten as EX, because E1 could be the name of an axis.
        let text = text.replace("EX", "e").replace("ex", "e");
        text.parse().ok().filter(|number: &f64| number.is_finite()).map(Self::Real)
    }

    /// The value in a scenario. A mask may be written as in an archive, `"'H1c'"`.
    ///
    /// # Errors
    /// The node is an array or a table.
    pub fn from_node(node: &Node) -> Result<Self, Problem> {
        match &node.value {
            source::Value::Boolean(value) => Ok(Self::Boolean(*value)),
            source::Value::Integer(integer) => Ok(Self::Integer(*integer)),
            source::Value::Float(real) => Ok(Self::Real(*real)),
            source::Value::Text(text) if text.starts_with('\'') => {
                Ok(Self::parse(text).unwrap_or_else(|| Self::Text(text.clone())))
            }
            source::Value::Text(text) => Ok(Self::Text(text.clone())),
            source::Value::Array(_) | source::Value::Table(_) => {
                Err(node.expected("a value of a machine datum", "write one value per index: \"34100[2,XF]\" = 5.0"))
            }
        }
    }

    /// The value as a whole number, if it is one.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "only a whole number within 2^53 is converted")]
    pub fn whole(&self) -> Option<i64> {
        match self {
            Self::Integer(integer) => Some(*integer),
            Self::Real(real) if real.fract().abs() < f64::MIN_POSITIVE && real.abs() < 9e15 => Some(*real as i64),
            Self::Real(_) | Self::Boolean(_) | Self::Text(_) => None,
        }
    }

    /// The value as a number, if it is one; a BOOLEAN as 0 or 1.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Integer(integer) => Some(*integer as f64),
            Self::Real(real) => Some(*real),
            Self::Boolean(value) => Some(f64::from(u8::from(*value))),
            Self::Text(_) => None,
        }
    }

    /// The value in the export syntax: masks as `'H1c'`, exponents as `EX`, BOOLEAN as 0 or 1.
    #[must_use]
    pub fn export(&self, kind: Kind) -> String {
        match self {
            Self::Boolean(value) => u8::from(*value).to_string(),
            Self::Integer(integer) if kind == Kind::Udword => format!("'H{integer:x}'"),
            Self::Integer(integer) => integer.to_string(),
            Self::Real(real) => export_real(*real),
            Self::Text(text) => format!("\"{text}\""),
        }
    }
}

/// The form used in messages.
impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.export(Kind::Double))
    }
}

fn export_real(real: f64) -> String {
    let size = real.abs();
    if size > 0.0 && !(1e-4..1e15).contains(&size) {
        let text = format!("{real:e}");
        if let Some((mantissa, exponent)) = text.split_once('e')
            && let Ok(exponent) = exponent.parse::<i32>()
        {
            let sign = if exponent < 0 { '-' } else { '+' };
            return format!("{mantissa}EX{sign}{:02}", exponent.abs());
        }
    }
    real.to_string()
}

/// The type of a datum as the list manual names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// BOOLEAN: 0 or 1.
    Boolean,
    /// BYTE: 0 to 255.
    Byte,
    /// DWORD: a whole number of 32 bits with sign.
    Dword,
    /// UDWORD: 32 bits, written as `'H0F'`.
    Udword,
    /// DOUBLE: a finite number.
    Double,
    /// STRING: a text in quotes.
    String,
}

impl fmt::Display for Kind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Boolean => "BOOLEAN",
            Self::Byte => "BYTE",
            Self::Dword => "DWORD",
            Self::Udword => "UDWORD",
            Self::Double => "DOUBLE",
            Self::String => "STRING",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn masks_exponents_and_truth_are_read_as_the_control_writes_them() {
        assert_eq!(Value::parse("'H1c'"), Some(Value::Integer(28)));
        assert_eq!(Value::parse("'HFF'"), Some(Value::Integer(255)));
        assert_eq!(Value::parse("'B10000'"), Some(Value::Integer(16)));
        assert_eq!(Value::parse("7.8EX-05"), Some(Value::Real(7.8e-5)));
        assert_eq!(Value::parse("1EX-05"), Some(Value::Real(1e-5)));
        assert_eq!(Value::parse("TRUE"), Some(Value::Boolean(true)));
        assert_eq!(Value::parse("\"\""), Some(Value::Text(String::new())));
    }

    #[test]
    fn what_is_no_finite_number_is_no_value() {
        for text in ["", "inf", "-inf", "NaN", "1EX400", "X", "'H'", "'Hxyz'", "'7'", "\"a", "1 2", "--1", "'", "\""] {
            assert_eq!(Value::parse(text), None, "{text}");
        }
    }

    #[test]
    fn small_numbers_are_written_with_ex() {
        assert_eq!(Value::Real(7.8e-5).export(Kind::Double), "7.8EX-05");
        assert_eq!(Value::Real(0.0005).export(Kind::Double), "0.0005");
        assert_eq!(Value::Real(-1e8).export(Kind::Double), "-100000000");
        assert_eq!(Value::Integer(28).export(Kind::Udword), "'H1c'");
    }

    #[test]
    fn a_scenario_may_write_a_mask_as_an_archive_does() {
        let mut table = source::Table::parse("a = \"'H0F'\"\nb = true\nc = [1]\n", "s.toml").unwrap();
        let mut value = |key| Value::from_node(&table.take(key).unwrap());
        assert_eq!((value("a"), value("b")), (Ok(Value::Integer(15)), Ok(Value::Boolean(true))));
        assert_eq!(value("c").unwrap_err().place.unwrap().line, 3);
    }

    proptest! {
        #[test]
        fn any_finite_number_survives_writing_and_reading(bits: u64) {
            let number = f64::from_bits(bits);
            prop_assume!(number.is_finite());
            let read = Value::parse(&export_real(number)).and_then(|value| value.number());
            prop_assert_eq!(read, Some(number));
        }

        #[test]
        fn any_text_is_read_or_refused(text: String) {
            let _ = Value::parse(&text);
        }
    }
}
