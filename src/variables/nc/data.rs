//! Data for the catalogue besides memory and variables, as small traits: machine data, and values of the control.

use crate::units::{AxisNumber, ChannelNumber, Time};
use crate::variables::{AlarmNumber, Place, ShownProgram};

/// Why a variable is not read or written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// It may not be written.
    NotAllowed,
    /// It has no such unit or row, or the value is out of its range.
    OutOfRange,
    /// The type of the value does not match.
    TypeInconsistent,
    /// There is no such variable.
    DoesNotExist,
}

/// The machine data of the control.
pub trait MachineData {
    /// A machine datum by number, and by index from 0 if it is an array.
    fn datum(&self, place: Place, number: u16, index: u16) -> Option<Datum<'_>>;

    /// The number of the machine datum with this identifier, with its prefix. The default is a control without identifiers.
    fn number(&self, _identifier: &str) -> Option<u16> {
        None
    }

    /// Whether the control accepts a value for an existing datum.
    ///
    /// # Errors
    /// The datum is read-only, or the value is out of range.
    fn may_store(&self, _place: Place, _number: u16, _index: u16, _value: f64) -> Result<(), Refused> {
        Ok(())
    }
}

/// Values of the control that are not signals, variables or machine data.
pub trait ControlValues {
    /// Simulated time; alarms have their times in it.
    fn time(&self) -> Time;

    /// The effective override of an axis, in per cent.
    fn axis_override(&self, axis: AxisNumber) -> f64;

    /// The effective override of a spindle, in per cent. The default is a control without spindles.
    fn spindle_override(&self, _axis: AxisNumber) -> f64 {
        100.0
    }

    /// The effective feed and rapid traverse overrides of a channel, in per cent.
    fn channel_overrides(&self, channel: ChannelNumber) -> [f64; 2];

    /// The motor speed of an axis in rev/min.
    fn motor_speed(&self, axis: AxisNumber) -> f64;

    /// Whether positions of the axis are in degrees.
    fn is_rotary(&self, axis: AxisNumber) -> bool;

    /// What is shown of the program of a channel. The default is a control without programs.
    fn shown_program(&self, _channel: ChannelNumber) -> ShownProgram<'_> {
        ShownProgram::default()
    }

    /// The settable zero offset of an axis, in mm or degrees: frame 1 is G54. The default is none.
    fn zero_offset(&self, _channel: ChannelNumber, _frame: u8, _axis: AxisNumber) -> f64 {
        0.0
    }

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

/// The value of a machine datum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Datum<'a> {
    /// BOOLEAN.
    Boolean(bool),
    /// BYTE.
    Byte(u8),
    /// DWORD.
    Whole(i32),
    /// UDWORD.
    Unsigned(u32),
    /// DOUBLE.
    Number(f64),
    /// STRING.
    Text(&'a str),
}
