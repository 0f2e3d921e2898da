//! Drive values as bytes of S7. Values are big-endian in all forms of request.
//!
//! | request | value |
//! |---|---|
//! | area V, module `82`, column 21 | `r0021`, actual speed of a SINAMICS drive in rev/min |
//! | area V, module `1A`, column `06AB` | MD1707, actual speed of a powerline drive in rev/min |
//! | syntax `A2`, parameter 21 | `r0021` of a drive object |
//!
//! Choices: drive object 1 is the control unit and 2 is the infeed; the drives follow from 3 on in the
//! order of the axes.

use crate::s7::wire::data::Refusal;
use crate::s7::wire::items::DriveItem;
use crate::units::AxisNumber;
use crate::variables::nc::{Shown, View, motor_speed};

/// `r0021`.
pub(super) const ACTUAL_SPEED: u16 = 21;

/// The drive object of the first axis.
const FIRST_DRIVE: u16 = 3;
/// The code of REAL as the type of a drive item.
const REAL: u8 = 8;

/// Encodes a value in four bytes.
#[expect(clippy::cast_possible_truncation, reason = "a drive value has single precision")]
pub(super) fn real(value: f64) -> [u8; 4] {
    (value as f32).to_be_bytes()
}

/// Appends the value requested by an item of syntax `A2`.
///
/// # Errors
/// There is no such object or parameter, or it has another type.
pub(in crate::s7) fn read(view: &View<'_>, item: &DriveItem, into: &mut Vec<u8>) -> Result<(), Refusal> {
    let number = item.object.checked_sub(FIRST_DRIVE).and_then(|index| u8::try_from(index + 1).ok());
    let axis = number.and_then(AxisNumber::new).ok_or(Refusal::DoesNotExist)?;
    if item.parameter != ACTUAL_SPEED {
        return Err(Refusal::DoesNotExist);
    }
    let Some(Shown::Number(value)) = motor_speed(view, axis.number(), 1) else {
        return Err(Refusal::DoesNotExist);
    };
    match (item.kind, item.count, item.index) {
        (REAL, 1, 0) => into.extend_from_slice(&real(value)),
        (REAL, _, _) => return Err(Refusal::OutOfRange),
        _ => return Err(Refusal::TypeInconsistent),
    }
    Ok(())
}
