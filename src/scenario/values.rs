//! Values that a scenario or a test writes: `1`, `true`, `1.5`, `"100%"`, `"2#1101_0000"`.

use crate::image::{Location, OverrideCoding, signal_value};
use crate::source::{Node, Place, Problem, Value};

/// A value to write.
#[derive(Clone, Debug, PartialEq)]
pub enum Setting {
    /// A whole number; a negative one is written as two's complement.
    Integer(i64),
    /// A number, for a REAL.
    Float(f64),
    /// A value for one bit.
    Boolean(bool),
    /// A percentage for an override, or a number with its base.
    Text(String),
}

impl From<i64> for Setting {
    fn from(number: i64) -> Self {
        Self::Integer(number)
    }
}

impl From<i32> for Setting {
    fn from(number: i32) -> Self {
        Self::Integer(number.into())
    }
}

impl From<f64> for Setting {
    fn from(number: f64) -> Self {
        Self::Float(number)
    }
}

impl From<bool> for Setting {
    fn from(value: bool) -> Self {
        Self::Boolean(value)
    }
}

impl From<&str> for Setting {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl Setting {
    /// The bits of this value at a location with the given name.
    pub(super) fn bits(self, name: &str, location: Location, coding: OverrideCoding) -> Result<u64, Problem> {
        let value = match self {
            Self::Integer(number) => Value::Integer(number),
            Self::Float(number) => Value::Float(number),
            Self::Boolean(value) => Value::Boolean(value),
            Self::Text(text) => Value::Text(text),
        };
        let node = Node { place: Place::file(name), value };
        signal_value(name, &node, location, coding)
    }
}
