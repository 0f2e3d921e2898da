//! Values that clients write, as commands to the machine. Clients write the types that they have (UInt16, Int64, 1.0): a value is converted
//! if it fits; otherwise the answer is `BadTypeMismatch` for its type, and `BadOutOfRange` for its amount.
//!
//! A bit that the NCK writes accepts a write, as with S7 communication, and loses it at the next publication of the NCK (SIG-11).

use opcua::types::{StatusCode, Variant};

use super::node_id::{Datum, Id, Nc, Plc, Type};
use super::reading::{NOT_HERE, Reader, lengths, size, start, unit};
use crate::image::{Address, Area, Width};
use crate::machine::{Command, Panel};
use crate::variables::nc::{self, MachineData, Refused};

impl Reader<'_> {
    /// The commands that write a value to a node. Nothing is written if one of its elements does not fit.
    pub(super) fn write(&self, id: &Id, value: &Variant) -> Result<Vec<Command>, StatusCode> {
        // A node that does not exist is not just read-only.
        self.read(id)?;
        match id {
            Id::Plc(plc) => self.write_plc(plc, value),
            Id::Variable(nc) if nc.is_r => self.write_r(nc, value),
            Id::Datum(datum) => self.write_datum(datum, value),
            Id::Variable(_) | Id::Pattern(..) | Id::Absent | Id::Own(_) | Id::Cnc(_) => Err(StatusCode::BadNotWritable),
        }
    }

    fn write_plc(&self, plc: &Plc, value: &Variant) -> Result<Vec<Command>, StatusCode> {
        match plc.kind {
            // It is not 0 while it runs; only a program can start it.
            Type::Timer => return Err(StatusCode::BadNotWritable),
            Type::String => return self.write_text(plc, value),
            Type::Char => {
                let letters: Vec<_> =
                    elements(value, plc.count)?.into_iter().map(letter(plc.width)).collect::<Result<_, _>>()?;
                return self.write_bytes(plc.area, start(plc), &letters.concat());
            }
            Type::Bool
            | Type::Byte
            | Type::Word
            | Type::DoubleWord
            | Type::Int
            | Type::DoubleInt
            | Type::Real
            | Type::Counter => {}
        }
        let step = u16::try_from(if plc.area == Area::Counters { 1 } else { size(plc) }).unwrap_or(1);
        let mut commands = Vec::new();
        for (element, byte) in elements(value, plc.count)?.into_iter().zip((plc.byte..).step_by(step.into())) {
            let raw = raw(plc.kind, element)?;
            let address = Address { byte, area: plc.area, width: plc.width, format: None };
            match self.machine().memory().locate(&address, self.view().names.profile) {
                Ok(location) => commands.push(Command::Write { location, value: raw.into() }),
                Err(_) => {
                    let bytes = raw.to_be_bytes();
                    commands.extend(self.write_bytes(plc.area, byte.into(), &bytes[4 - size(plc)..])?);
                }
            }
        }
        Ok(commands)
    }

    fn write_bytes(&self, area: Area, first: u32, bytes: &[u8]) -> Result<Vec<Command>, StatusCode> {
        let of_byte = |(byte, value): (u32, &u8)| {
            let byte = u16::try_from(byte).map_err(|_| NOT_HERE)?;
            let address = Address { area, byte, width: Width::Byte, format: None };
            let location = self.machine().memory().locate(&address, self.view().names.profile).map_err(|_| NOT_HERE)?;
            Ok(Command::Write { location, value: (*value).into() })
        };
        (first..).zip(bytes).map(of_byte).collect()
    }

    /// The second length becomes that of the text; the first one, which limits it, stays.
    fn write_text(&self, plc: &Plc, value: &Variant) -> Result<Vec<Command>, StatusCode> {
        let Variant::String(text) = value else { return Err(StatusCode::BadTypeMismatch) };
        let (text, unit) = (text.as_ref(), unit(plc.width));
        let mut head = vec![0; 2 * unit];
        let profile = self.view().names.profile;
        self.machine().memory().read_bytes(plc.area, start(plc), &mut head, profile).map_err(|_| NOT_HERE)?;
        let [longest, _] = lengths(&head, plc.width);
        let letters: Vec<u8> =
            if unit == 2 { text.encode_utf16().flat_map(u16::to_be_bytes).collect() } else { text.bytes().collect() };
        let length = letters.len() / unit;
        if length > longest {
            return Err(StatusCode::BadOutOfRange);
        }
        let length = u16::try_from(length).map_err(|_| StatusCode::BadOutOfRange)?.to_be_bytes();
        let bytes = [&length[2 - unit..], &letters].concat();
        let after = start(plc) + u32::try_from(unit).unwrap_or(1);
        self.write_bytes(plc.area, after, &bytes)
    }

    fn write_r(&self, nc: &Nc, value: &Variant) -> Result<Vec<Command>, StatusCode> {
        let mut commands = Vec::new();
        for (element, number) in elements(value, nc.index.count)?.into_iter().zip(nc.index.first..) {
            let value = float(element)?;
            let line = number.checked_add(1).ok_or(NOT_HERE)?;
            let (channel, number, _) = nc::r_parameter(self.view(), nc.index.unit, line).map_err(|_| NOT_HERE)?;
            commands.push(Command::RParameter { channel, number, value });
        }
        Ok(commands)
    }

    fn write_datum(&self, datum: &Datum, value: &Variant) -> Result<Vec<Command>, StatusCode> {
        let (place, number) = self.datum_place(datum)?;
        let panel = Panel(self.machine());
        let mut commands = Vec::new();
        for (element, line) in elements(value, datum.index.count)?.into_iter().zip(datum.index.first..) {
            let value = match nc::datum(self.view(), place, number, line).map_err(|_| NOT_HERE)? {
                nc::Datum::Text(_) => return Err(StatusCode::BadNotWritable),
                nc::Datum::Boolean(_) => f64::from(u8::from(boolean(element)?)),
                nc::Datum::Number(_) => float(element)?,
                nc::Datum::Byte(_) => whole(element, 0, u8::MAX.into())?,
                nc::Datum::Whole(_) => whole(element, i32::MIN.into(), i32::MAX.into())?,
                nc::Datum::Unsigned(_) => whole(element, 0, u32::MAX.into())?,
            };
            panel.may_store(place, number, line - 1, value).map_err(|refused| match refused {
                Refused::NotAllowed => StatusCode::BadNotWritable,
                Refused::OutOfRange => StatusCode::BadOutOfRange,
                Refused::TypeInconsistent => StatusCode::BadTypeMismatch,
                Refused::DoesNotExist => NOT_HERE,
            })?;
            commands.push(panel.store(place, number, line - 1, value).map_err(|_| NOT_HERE)?);
        }
        Ok(commands)
    }
}

/// The elements of a value: as many as the node has.
fn elements(value: &Variant, count: Option<u16>) -> Result<Vec<&Variant>, StatusCode> {
    match (value, count) {
        (Variant::Array(array), Some(count)) if array.values.len() == usize::from(count) => {
            Ok(array.values.iter().collect())
        }
        (Variant::Array(_), Some(_)) => Err(StatusCode::BadOutOfRange),
        (Variant::Array(_), None) | (_, Some(_)) => Err(StatusCode::BadTypeMismatch),
        (value, None) => Ok(vec![value]),
    }
}

/// A number as a whole one, whatever its type.
fn integer(value: &Variant) -> Result<i128, StatusCode> {
    Ok(match *value {
        Variant::SByte(value) => value.into(),
        Variant::Byte(value) => value.into(),
        Variant::Int16(value) => value.into(),
        Variant::UInt16(value) => value.into(),
        Variant::Int32(value) => value.into(),
        Variant::UInt32(value) => value.into(),
        Variant::Int64(value) => value.into(),
        Variant::UInt64(value) => value.into(),
        Variant::Float(value) => of_float(value.into())?,
        Variant::Double(value) => of_float(value)?,
        _ => return Err(StatusCode::BadTypeMismatch),
    })
}

#[expect(clippy::cast_possible_truncation, reason = "the value is small and has no fraction")]
fn of_float(value: f64) -> Result<i128, StatusCode> {
    if !value.is_finite() || value.abs() > 1e18 {
        Err(StatusCode::BadOutOfRange)
    } else if value.fract() == 0.0 {
        Ok(value as i128)
    } else {
        Err(StatusCode::BadTypeMismatch)
    }
}

fn between(value: &Variant, least: i64, most: i64) -> Result<i64, StatusCode> {
    let value = integer(value)?;
    let value = i64::try_from(value).map_err(|_| StatusCode::BadOutOfRange)?;
    if (least..=most).contains(&value) { Ok(value) } else { Err(StatusCode::BadOutOfRange) }
}

#[expect(clippy::cast_precision_loss, reason = "the limits are at most 32 bits")]
fn whole(value: &Variant, least: i64, most: i64) -> Result<f64, StatusCode> {
    // Some clients write 0 and 1 of a byte as a Boolean.
    if let Variant::Boolean(value) = value {
        return Ok(u8::from(*value).into());
    }
    between(value, least, most).map(|value| value as f64)
}

fn boolean(value: &Variant) -> Result<bool, StatusCode> {
    match value {
        Variant::Boolean(value) => Ok(*value),
        value => between(value, 0, 1).map(|value| value == 1),
    }
}

fn float(value: &Variant) -> Result<f64, StatusCode> {
    let value = match *value {
        Variant::Float(value) => value.into(),
        Variant::Double(value) => value,
        #[expect(clippy::cast_precision_loss, reason = "a client that writes an integer of 64 bits to a REAL")]
        ref value => integer(value)? as f64,
    };
    if value.is_finite() { Ok(value) } else { Err(StatusCode::BadOutOfRange) }
}

/// The bits of a number.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the ranges are checked")]
fn raw(kind: Type, value: &Variant) -> Result<u32, StatusCode> {
    Ok(match kind {
        Type::Bool => boolean(value)?.into(),
        Type::Byte | Type::Counter => between(value, 0, u8::MAX.into())? as u32,
        Type::Word => between(value, 0, u16::MAX.into())? as u32,
        Type::DoubleWord => between(value, 0, u32::MAX.into())? as u32,
        Type::Int => u32::from(between(value, i16::MIN.into(), i16::MAX.into())? as u16),
        Type::DoubleInt => between(value, i32::MIN.into(), i32::MAX.into())? as u32,
        Type::Real => {
            let value = float(value)? as f32;
            if value.is_finite() { value.to_bits() } else { return Err(StatusCode::BadOutOfRange) }
        }
        Type::Char | Type::String | Type::Timer => return Err(StatusCode::BadNotWritable),
    })
}

/// The bytes of a text of one character.
fn letter(width: Width) -> impl Fn(&Variant) -> Result<Vec<u8>, StatusCode> {
    move |value| {
        let Variant::String(text) = value else { return Err(StatusCode::BadTypeMismatch) };
        let text = text.as_ref();
        let bytes: Vec<u8> = if unit(width) == 2 {
            text.encode_utf16().flat_map(u16::to_be_bytes).collect()
        } else {
            text.bytes().collect()
        };
        if bytes.len() == unit(width) { Ok(bytes) } else { Err(StatusCode::BadOutOfRange) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_converted_if_it_fits() {
        let mismatch = Err(StatusCode::BadTypeMismatch);
        let range = Err(StatusCode::BadOutOfRange);
        for (kind, value, result) in [
            (Type::Bool, Variant::from(true), Ok(1)),
            (Type::Bool, Variant::from(1_u16), Ok(1)),
            (Type::Bool, Variant::from(2_u16), range),
            (Type::Byte, Variant::from(255_i64), Ok(255)),
            (Type::Byte, Variant::from(256_i64), range),
            (Type::Byte, Variant::from(-1_i32), range),
            (Type::Word, Variant::from(1.0), Ok(1)),
            (Type::Word, Variant::from(1.5), mismatch),
            (Type::Word, Variant::from(f64::NAN), range),
            (Type::Word, Variant::from(true), mismatch),
            (Type::Word, Variant::from("1"), mismatch),
            (Type::Int, Variant::from(-1_i16), Ok(0xFFFF)),
            (Type::Int, Variant::from(40_000), range),
            (Type::DoubleInt, Variant::from(-1_i64), Ok(0xFFFF_FFFF)),
            (Type::DoubleWord, Variant::from(u64::MAX), range),
            (Type::Real, Variant::from(1_u32), Ok(0x3F80_0000)),
            (Type::Real, Variant::from(-2.0_f32), Ok(0xC000_0000)),
            (Type::Real, Variant::from(1e300), range),
        ] {
            assert_eq!(raw(kind, &value), result, "{kind:?} {value:?}");
        }
    }
}
