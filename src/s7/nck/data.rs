//! Data for the catalogue besides memory and variables, as small traits: machine data, and values of the control.

use crate::s7::wire::data::Refusal;
use crate::units::{AxisNumber, ChannelNumber, Time};
use crate::variables::{AlarmNumber, Place};

/// The machine data of the control.
pub trait MachineData {
    /// A machine datum by number, and by index from 0 if it is an array.
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>>;

    /// Whether the control accepts a value for an existing datum.
    ///
    /// # Errors
    /// The datum is read-only, or the value is out of range.
    fn may_store(&self, _place: Place, _number: u16, _index: u16, _value: f64) -> Result<(), Refusal> {
        Ok(())
    }
}

/// Values of the control that are not signals, variables or machine data.
pub trait ControlValues {
    /// Simulated time; alarms have their times in it.
    fn time(&self) -> Time;

    /// The effective override of an axis, in per cent.
    fn axis_override(&self, axis: AxisNumber) -> f64;

    /// The effective feed and rapid traverse overrides of a channel, in per cent.
    fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2];

    /// The motor speed of an axis in rev/min.
    fn motor_speed(&self, axis: AxisNumber) -> f64;

    /// Whether positions of the axis are in degrees.
    fn is_rotary(&self, axis: AxisNumber) -> bool;

    /// An R parameter of a channel, by its number.
    fn r_parameter(&self, channel: ChannelNumber, number: u16) -> Option<f64>;

    /// How an alarm is cancelled: 1 POWER ON, 2 RESET, 3 the cancel key, 4 automatically by the NCK, 5 NC start, 6 RESET in all channels of
    /// the mode group.
    fn clear_info(&self, alarm: AlarmNumber) -> u8;

    /// A longer text of an alarm that the control keeps. The default is a control without them.
    fn message_text(&self, _index: u32) -> &str {
        ""
    }
}

/// The value of a machine datum; its kind determines the length on the wire.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Datum<'a> {
    /// BOOLEAN: one byte.
    Boolean(bool),
    /// BYTE: one byte.
    Byte(u8),
    /// DWORD: four bytes.
    Whole(i32),
    /// UDWORD: four bytes.
    Unsigned(u32),
    /// DOUBLE: eight bytes.
    Number(f64),
    /// STRING: 32 bytes.
    Text(&'a str),
}

/// Length of a text of the machine data.
const TEXT: usize = 32;

impl Datum<'_> {
    pub(super) fn put(self, into: &mut Vec<u8>) {
        match self {
            Self::Boolean(value) => into.push(value.into()),
            Self::Byte(value) => into.push(value),
            Self::Whole(value) => into.extend_from_slice(&value.to_le_bytes()),
            Self::Unsigned(value) => into.extend_from_slice(&value.to_le_bytes()),
            Self::Number(value) => into.extend_from_slice(&value.to_le_bytes()),
            Self::Text(text) => put_text(text, TEXT, into),
        }
    }

    /// The value of bytes of the same kind; texts cannot be written.
    pub(super) fn parse(self, bytes: &[u8]) -> Option<f64> {
        match (self, bytes) {
            (Self::Boolean(_), [value @ (0 | 1)]) | (Self::Byte(_), [value]) => Some((*value).into()),
            (Self::Whole(_), _) => Some(i32::from_le_bytes(bytes.try_into().ok()?).into()),
            (Self::Unsigned(_), _) => Some(u32::from_le_bytes(bytes.try_into().ok()?).into()),
            (Self::Number(_), _) => number(bytes),
            (Self::Boolean(_) | Self::Byte(_) | Self::Text(_), _) => None,
        }
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
