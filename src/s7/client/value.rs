//! Values in program form, and their bytes on the wire.

use std::fmt::{self, Write};

use super::Error;
use super::nc::{NcKind, NcVariable};
use super::variable::{Memory, Variable};
use crate::image::{Area, Format, Width};
use crate::s7::wire::date_and_time::DateAndTime;

/// A value that was read or is to be written.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// One bit.
    Bit(bool),
    /// One byte, or adjacent bits of a byte.
    Byte(u8),
    /// Two bytes; also the raw value of a timer or counter.
    Word(u16),
    /// Four bytes.
    DoubleWord(u32),
    /// A signed two-byte integer.
    Int(i16),
    /// A signed four-byte integer.
    DoubleInt(i32),
    /// A four-byte floating-point number.
    Real(f32),
    /// An eight-byte floating-point number.
    Double(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
    /// Several elements.
    List(Vec<Self>),
}

impl Value {
    /// The value as a number, if it is one.
    #[must_use]
    pub fn number(&self) -> Option<f64> {
        Some(match self {
            Self::Bit(value) => f64::from(u8::from(*value)),
            Self::Byte(value) => f64::from(*value),
            Self::Word(value) => f64::from(*value),
            Self::DoubleWord(value) => f64::from(*value),
            Self::Int(value) => f64::from(*value),
            Self::DoubleInt(value) => f64::from(*value),
            Self::Real(value) => f64::from(*value),
            Self::Double(value) => *value,
            Self::Text(_) | Self::Bytes(_) | Self::List(_) => return None,
        })
    }

    /// Decodes bytes that were read.
    pub(super) fn decode(variable: &Variable, bytes: &[u8]) -> Option<Self> {
        match variable {
            Variable::Memory(memory) => {
                if bytes.len() != memory.length() {
                    return None;
                }
                match (memory.count, memory.width) {
                    (1, _) => element(memory, bytes),
                    (_, Width::Byte) => Some(Self::Bytes(bytes.to_vec())),
                    (_, Width::Bit(_) | Width::Bits { .. } | Width::Word | Width::Double) => {
                        let each = bytes.chunks(memory.element()).map(|bytes| element(memory, bytes));
                        each.collect::<Option<_>>().map(Self::List)
                    }
                }
            }
            Variable::Nc(variable) => {
                let Some(kind) = variable.kind else {
                    return Some(Self::Bytes(bytes.to_vec()));
                };
                if bytes.len() != kind.bytes() * usize::from(variable.item.count) {
                    return None;
                }
                let row = |bytes: &[u8]| row(kind, variable.is_big_endian(), bytes);
                match variable.item.count {
                    1 => row(bytes),
                    _ => bytes.chunks(kind.bytes().max(1)).map(row).collect::<Option<_>>().map(Self::List),
                }
            }
        }
    }

    /// The bytes that write the value. A group of bits gives one byte per bit, lowest bit first.
    ///
    /// # Errors
    /// The value does not fit the variable.
    pub fn encode(&self, variable: &Variable) -> Result<Vec<u8>, Error> {
        let mut bytes = Vec::new();
        let done = match (variable, self) {
            (Variable::Memory(memory), value) if memory.count == 1 => put_element(memory, value, &mut bytes),
            (Variable::Memory(memory), Self::Bytes(value)) if value.len() == memory.length() => {
                bytes.extend_from_slice(value);
                Some(())
            }
            (Variable::Memory(memory), Self::List(values)) if values.len() == memory.count as usize => {
                values.iter().try_for_each(|value| put_element(memory, value, &mut bytes))
            }
            (Variable::Memory(_), _) => None,
            (Variable::Nc(NcVariable { kind: None, .. }), Self::Bytes(value)) => {
                bytes.extend_from_slice(value);
                Some(())
            }
            (Variable::Nc(NcVariable { kind: Some(kind), item }), Self::List(values)) => (values.len()
                == usize::from(item.count))
            .then_some(values)
            .and_then(|values| values.iter().try_for_each(|value| put_row(*kind, variable, value, &mut bytes))),
            (Variable::Nc(NcVariable { kind: Some(kind), item }), value) if item.count == 1 => {
                put_row(*kind, variable, value, &mut bytes)
            }
            (Variable::Nc(_), _) => None,
        };
        match done {
            Some(()) => Ok(bytes),
            None => Err(Error::Input {
                what: format!("expected a value that fits {variable}, found {self}"),
                cure: "integers must be in range, only REAL accepts fractions, and each element needs one value"
                    .to_owned(),
            }),
        }
    }

    /// The value as an integer, if it is one.
    fn whole(&self) -> Option<i64> {
        Some(match self {
            Self::Bit(value) => i64::from(*value),
            Self::Byte(value) => i64::from(*value),
            Self::Word(value) => i64::from(*value),
            Self::DoubleWord(value) => i64::from(*value),
            Self::Int(value) => i64::from(*value),
            Self::DoubleInt(value) => i64::from(*value),
            Self::Real(_) | Self::Double(_) | Self::Text(_) | Self::Bytes(_) | Self::List(_) => return None,
        })
    }
}

fn element(memory: &Memory, bytes: &[u8]) -> Option<Value> {
    Some(match (memory.width, memory.format, bytes) {
        (Width::Bit(_), _, [byte]) => Value::Bit(byte & 1 == 1),
        (Width::Bits { first, last }, _, [byte]) => {
            Value::Byte(byte >> first & u8::MAX >> 7_u8.saturating_sub(last.saturating_sub(first)))
        }
        (Width::Byte, _, [byte]) => Value::Byte(*byte),
        (Width::Word, Format::Signed, _) => Value::Int(i16::from_be_bytes(bytes.try_into().ok()?)),
        (Width::Word, _, _) => Value::Word(u16::from_be_bytes(bytes.try_into().ok()?)),
        (Width::Double, Format::Unsigned, _) => Value::DoubleWord(u32::from_be_bytes(bytes.try_into().ok()?)),
        (Width::Double, Format::Signed, _) => Value::DoubleInt(i32::from_be_bytes(bytes.try_into().ok()?)),
        (Width::Double, Format::Real, _) => Value::Real(f32::from_be_bytes(bytes.try_into().ok()?)),
        (Width::Bit(_) | Width::Bits { .. } | Width::Byte, _, _) => return None,
    })
}

fn row(kind: NcKind, is_big_endian: bool, bytes: &[u8]) -> Option<Value> {
    if let NcKind::Text(_) = kind {
        let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
        // Controls send Latin-1 or UTF-8, depending on their language.
        let text = bytes.get(..end)?;
        let text = std::str::from_utf8(text)
            .map_or_else(|_| text.iter().map(|byte| char::from(*byte)).collect(), ToOwned::to_owned);
        return Some(Value::Text(text));
    }
    if kind == NcKind::Date {
        let time = DateAndTime::parse(bytes);
        return match time {
            Some(time) => Some(Value::Text(date(&time))),
            None => bytes.iter().all(|byte| *byte == 0).then(|| Value::Text(String::new())),
        };
    }
    let mut bytes = bytes.to_vec();
    if is_big_endian {
        bytes.reverse();
    }
    let bytes = bytes.as_slice();
    Some(match kind {
        NcKind::Byte => Value::Byte(*bytes.first()?),
        NcKind::Word => Value::Word(u16::from_le_bytes(bytes.try_into().ok()?)),
        NcKind::Long => Value::DoubleInt(i32::from_le_bytes(bytes.try_into().ok()?)),
        NcKind::Real => Value::Real(f32::from_le_bytes(bytes.try_into().ok()?)),
        NcKind::Double => Value::Double(f64::from_le_bytes(bytes.try_into().ok()?)),
        NcKind::UnsignedLong => Value::DoubleWord(u32::from_le_bytes(bytes.try_into().ok()?)),
        NcKind::Date | NcKind::Text(_) => return None,
    })
}

/// Formats `2026-11-22 05:06:07.089`.
fn date(time: &DateAndTime) -> String {
    let DateAndTime { year, month, day, hour, minute, second, millisecond } = time;
    format!("{year:04}-{month:02}-{day:02} {hour:02}:{minute:02}:{second:02}.{millisecond:03}")
}

/// Negative numbers may be written to unsigned locations as two's complement, as everywhere in this project.
fn fits(number: i64, bits: u32, format: Format) -> bool {
    let half = 1_i64 << (bits - 1);
    match format {
        _ if bits == 1 => (0..=1).contains(&number),
        Format::Signed => (-half..half).contains(&number),
        Format::Unsigned | Format::Real => (-half..2 * half).contains(&number),
    }
}

fn put_element(memory: &Memory, value: &Value, into: &mut Vec<u8>) -> Option<()> {
    let bits = match memory.width {
        Width::Bit(_) => 1,
        Width::Bits { first, last } => u32::from(last.saturating_sub(first)) + 1,
        Width::Byte => 8,
        Width::Word => 16,
        Width::Double => 32,
    };
    if memory.format == Format::Real && bits == 32 {
        into.extend_from_slice(&real(value)?.to_be_bytes());
        return Some(());
    }
    let number = value.whole().filter(|number| fits(*number, bits, memory.format))?;
    if let Width::Bits { .. } = memory.width {
        into.extend((0..bits).map(|bit| u8::from(number >> bit & 1 == 1)));
        return Some(());
    }
    let bytes = number.to_be_bytes();
    into.extend_from_slice(&bytes[8 - memory.element()..]);
    Some(())
}

/// The value as a REAL; `None` if it does not fit.
#[expect(clippy::cast_possible_truncation, reason = "a value that does not fit becomes infinite and is refused")]
fn real(value: &Value) -> Option<f32> {
    if let Value::Real(value) = value {
        return Some(*value); // including infinity and NaN
    }
    let value = value.number()? as f32;
    value.is_finite().then_some(value)
}

fn put_row(kind: NcKind, variable: &Variable, value: &Value, into: &mut Vec<u8>) -> Option<()> {
    let start = into.len();
    match kind {
        NcKind::Text(length) => {
            let Value::Text(text) = value else { return None };
            // The last byte stays 0.
            if text.len() >= length {
                return None;
            }
            into.extend_from_slice(text.as_bytes());
            into.resize(start + length, 0);
            return Some(());
        }
        NcKind::Date => return None, // times of events are set by the control only
        NcKind::Byte | NcKind::Word | NcKind::Long | NcKind::UnsignedLong => {
            let bits = 8 * u32::try_from(kind.bytes()).ok()?;
            let number = value.whole().filter(|number| fits(*number, bits, Format::Unsigned))?;
            into.extend_from_slice(&number.to_le_bytes()[..kind.bytes()]);
        }
        NcKind::Real => into.extend_from_slice(&real(value)?.to_le_bytes()),
        NcKind::Double => into.extend_from_slice(&value.number()?.to_le_bytes()),
    }
    if matches!(variable, Variable::Nc(variable) if variable.is_big_endian()) {
        into[start..].reverse();
    }
    Some(())
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bit(value) => write!(f, "{}", u8::from(*value)),
            Self::Byte(value) => value.fmt(f),
            Self::Word(value) => value.fmt(f),
            Self::DoubleWord(value) => value.fmt(f),
            Self::Int(value) => value.fmt(f),
            Self::DoubleInt(value) => value.fmt(f),
            Self::Real(value) => value.fmt(f),
            Self::Double(value) => value.fmt(f),
            // The text comes from the server: control characters are replaced, so that they cannot control the
            // terminal.
            Self::Text(text) => text.chars().try_for_each(|c| f.write_char(if c.is_control() { '.' } else { c })),
            Self::Bytes(bytes) => {
                let each: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
                f.write_str(&each.join(" "))
            }
            Self::List(values) => {
                let each: Vec<String> = values.iter().map(ToString::to_string).collect();
                f.write_str(&each.join(" "))
            }
        }
    }
}

impl Variable {
    /// The name of the type: `BOOL`, `WORD`, `REAL`, `F64`.
    #[must_use]
    pub fn type_name(&self) -> String {
        let (name, count) = match self {
            Self::Memory(memory) => {
                let name = match (memory.area, memory.width, memory.format) {
                    (Area::Timers, _, _) => "TIMER",
                    (Area::Counters, _, _) => "COUNTER",
                    (_, Width::Bit(_), _) => "BOOL",
                    (_, Width::Bits { .. }, _) => "BITS",
                    (_, Width::Byte, _) => "BYTE",
                    (_, Width::Word, Format::Signed) => "INT",
                    (_, Width::Word, _) => "WORD",
                    (_, Width::Double, Format::Signed) => "DINT",
                    (_, Width::Double, Format::Real) => "REAL",
                    (_, Width::Double, Format::Unsigned) => "DWORD",
                };
                (name.to_owned(), memory.count)
            }
            Self::Nc(variable) => {
                let name = match variable.kind {
                    None => "BYTES".to_owned(),
                    Some(NcKind::Byte) => "BYTE".to_owned(),
                    Some(NcKind::Word) => "WORD".to_owned(),
                    Some(NcKind::Long) => "LONG".to_owned(),
                    Some(NcKind::UnsignedLong) => "ULONG".to_owned(),
                    Some(NcKind::Date) => "DATE".to_owned(),
                    Some(NcKind::Real) => "REAL".to_owned(),
                    Some(NcKind::Double) => "DOUBLE".to_owned(),
                    Some(NcKind::Text(length)) => format!("TEXT{length}"),
                };
                (name, variable.item.count.into())
            }
        };
        if count == 1 { name } else { format!("{name}[{count}]") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(text: &str, value: &Value) -> Option<Vec<u8>> {
        value.encode(&text.parse().unwrap()).ok()
    }

    #[test]
    fn numbers_of_the_plc_are_big_endian_and_must_fit() {
        assert_eq!(encoded("MW0", &Value::Word(0x1234)), Some(vec![0x12, 0x34]));
        assert_eq!(encoded("MW0", &Value::Int(-2)), Some(vec![0xFF, 0xFE]));
        assert_eq!(encoded("MW0:INT", &Value::Word(0x8000)), None);
        assert_eq!(encoded("MB0", &Value::Word(256)), None);
        assert_eq!(encoded("MD0:REAL", &Value::Double(1.5)), Some(vec![0x3F, 0xC0, 0, 0]));
        assert_eq!(encoded("MD0:REAL", &Value::Double(1e300)), None);
        assert_eq!(encoded("MD0", &Value::Real(1.0)), None);
        assert_eq!(encoded("M0.1", &Value::Byte(2)), None);
        assert_eq!(encoded("DB10.DBX1.2..4", &Value::Byte(0b110)), Some(vec![0, 1, 1]));
        assert_eq!(encoded("DB10.DBX1.2..4", &Value::Byte(8)), None);
    }

    #[test]
    fn numbers_of_the_nck_are_little_endian_and_those_of_drives_are_not() {
        assert_eq!(encoded("C/State/chanStatus", &Value::Word(1)), Some(vec![1, 0]));
        assert_eq!(encoded("A/M/32000:DOUBLE", &Value::Double(1.0)), Some(vec![0, 0, 0, 0, 0, 0, 0xF0, 0x3F]));
        assert_eq!(encoded("V/M/1717:REAL", &Value::Double(1.0)), Some(vec![0x3F, 0x80, 0, 0]));
        let text = Value::Text("AB".to_owned());
        assert_eq!(encoded("N/M/1:TEXT4", &text), Some(vec![b'A', b'B', 0, 0]));
        assert_eq!(encoded("N/M/1:TEXT2", &text), None, "the last byte stays 0");
    }

    #[test]
    fn control_characters_in_a_printed_text_are_replaced() {
        let text = Value::Text("X\u{1b}[2J\u{9b}1m\nY".to_owned());
        assert_eq!(text.to_string(), "X.[2J.1m.Y");
        assert_eq!(Value::List(vec![text]).to_string(), "X.[2J.1m.Y");
    }

    #[test]
    fn bits_of_a_group_are_taken_out_of_their_byte() {
        let variable = "DB10.DBX1.2..4".parse().unwrap();
        assert_eq!(Value::decode(&variable, &[0b0101_1011]), Some(Value::Byte(0b110)));
    }
}
