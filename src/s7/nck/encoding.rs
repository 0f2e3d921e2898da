//! The values of NC variables as bytes of S7: little-endian, except those of drives.

use crate::variables::nc::Datum;

/// Length of a text of the machine data.
const TEXT: usize = 32;

/// Appends a machine datum: BOOLEAN and BYTE one byte, DWORD and UDWORD four, DOUBLE eight, STRING 32.
pub(super) fn put_datum(datum: Datum<'_>, into: &mut Vec<u8>) {
    match datum {
        Datum::Boolean(value) => into.push(value.into()),
        Datum::Byte(value) => into.push(value),
        Datum::Whole(value) => into.extend_from_slice(&value.to_le_bytes()),
        Datum::Unsigned(value) => into.extend_from_slice(&value.to_le_bytes()),
        Datum::Number(value) => into.extend_from_slice(&value.to_le_bytes()),
        Datum::Text(text) => put_text(text, TEXT, into),
    }
}

/// The value of bytes of the same kind as a machine datum; texts cannot be written.
pub(super) fn parse_datum(datum: Datum<'_>, bytes: &[u8]) -> Option<f64> {
    match (datum, bytes) {
        (Datum::Boolean(_), [value @ (0 | 1)]) | (Datum::Byte(_), [value]) => Some((*value).into()),
        (Datum::Whole(_), _) => Some(i32::from_le_bytes(bytes.try_into().ok()?).into()),
        (Datum::Unsigned(_), _) => Some(u32::from_le_bytes(bytes.try_into().ok()?).into()),
        (Datum::Number(_), _) => number(bytes),
        (Datum::Boolean(_) | Datum::Byte(_) | Datum::Text(_), _) => None,
    }
}

/// A finite number of eight bytes.
pub(super) fn number(bytes: &[u8]) -> Option<f64> {
    let value = f64::from_le_bytes(bytes.try_into().ok()?);
    value.is_finite().then_some(value)
}

/// Appends a text, cut or padded to its length.
pub(super) fn put_text(text: &str, length: usize, into: &mut Vec<u8>) {
    let end = into.len() + length;
    // The last byte stays 0, so that the text is always terminated.
    into.extend(text.bytes().take(length.saturating_sub(1)));
    into.resize(end, 0);
}
