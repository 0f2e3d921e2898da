//! Drive values. A simulated drive has the actual speed of its motor. Torque, current and temperatures are not modelled, so these variables
//! do not exist.
//!
//! Choices: a drive has the number of its axis. There are no main drives, because there are no spindles.

use super::{Shown, View, values};

/// The motor speed of a drive; it has one line.
pub fn motor_speed<'a>(view: &View<'a>, drive: u8, line: u16) -> Option<Shown<'a>> {
    let axis = values::axis_number(view, drive.into())?;
    (line == 1).then_some(Shown::Number(view.control?.motor_speed(axis)))
}
