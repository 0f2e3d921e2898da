//! The values of the catalogue. A control without a program shows no program name and no block, and T0 before a program has written T; so
//! does this one. A geometry axis is the machine axis with the same number.

use std::borrow::Cow;

use super::{ControlValues, Datum, Kind, Refused, Shown, Variable, View};
use crate::image::{AxisFromNck, Block, ChannelAuxiliary, ChannelFromNck, ChannelToNck};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{AxisValues, Place, ShownProgram, nc_file};

pub(super) fn number(count: usize) -> Shown<'static> {
    Shown::Number(f64::from(u32::try_from(count).unwrap_or(u32::MAX)))
}

pub(super) fn flag(value: bool) -> Shown<'static> {
    Shown::Number(f64::from(u8::from(value)))
}

/// Whether a line is the first and only one.
pub(super) fn only(line: u16) -> Option<()> {
    (line == 1).then_some(())
}

pub(super) fn channel_exists(view: &View<'_>, unit: u8) -> Option<()> {
    channel_number(view, unit).map(|_| ())
}

/// A channel that has a name and a mode group (MD10010); the first channel always exists.
pub(super) fn channel_number(view: &View<'_>, unit: u8) -> Option<ChannelNumber> {
    let number = ChannelNumber::new(unit)?;
    let group = view.machine_data.and_then(|data| data.datum(Place::Nck, 10010, u16::from(unit) - 1));
    let has_none = matches!(group, Some(Datum::Whole(0) | Datum::Byte(0)));
    let exists = number == ChannelNumber::FIRST || view.names.channels[number].is_some() && !has_none;
    exists.then_some(number)
}

pub(super) fn axis_number(view: &View<'_>, line: u16) -> Option<AxisNumber> {
    let number = AxisNumber::new(u8::try_from(line).ok()?)?;
    view.names.axes[number].as_ref().map(|_| number)
}

pub(super) fn axis<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&AxisValues) -> f64) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(Shown::Number(get(&view.variables.axes[axis_number(view, line)?])))
}

/// There are at most three geometry axes.
pub(super) fn geometry_axis<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&AxisValues) -> f64,
) -> Option<Shown<'a>> {
    if line > 3 { None } else { axis(view, unit, line, get) }
}

pub(super) fn axis_name<'a>(view: &View<'a>, line: u16) -> Option<Shown<'a>> {
    // A table of names has a row for each possible axis; rows of axes that do not exist are empty.
    let number = AxisNumber::new(u8::try_from(line).ok()?)?;
    if number.number() > view.names.interface().count(Block::Axis) {
        return None;
    }
    Some(Shown::Text(view.names.axes[number].as_deref().unwrap_or("").into()))
}

pub(super) fn channel_name<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    let number = channel_number(view, unit)?;
    Some(Shown::Text(view.names.channels[number].as_deref().unwrap_or("").into()))
}

/// MD18040, four rows: this simulator and its version in the first row.
pub(super) fn version<'a>(line: u16) -> Option<Shown<'a>> {
    match line {
        1 => Some(Shown::Text(concat!("OpenNCK ", env!("CARGO_PKG_VERSION")).into())),
        2..=4 => Some(Shown::Text("".into())),
        _ => None,
    }
}

pub(super) fn count_axes<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(number(view.names.axes.iter().filter(|(_, name)| name.is_some()).count()))
}

pub(super) fn channel<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&ChannelFromNck) -> f64) -> Option<Shown<'a>> {
    only(line)?;
    Some(Shown::Number(get(&view.memory.from_nck().channels[channel_number(view, unit)?])))
}

/// An auxiliary function that the program has output.
pub(super) fn of_output<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&ChannelAuxiliary) -> f64,
) -> Option<Shown<'a>> {
    only(line)?;
    Some(Shown::Number(get(view.memory.from_nck().auxiliary(channel_number(view, unit)?))))
}

/// A function requested by the PLC.
pub(super) fn asked<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&ChannelToNck) -> bool) -> Option<Shown<'a>> {
    only(line)?;
    Some(flag(get(&view.memory.to_nck().channels[channel_number(view, unit)?])))
}

pub(super) fn zero<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    channel(view, unit, line, |_| 0.0)
}

pub(super) fn empty<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    zero(view, unit, line).map(|_| Shown::Text("".into()))
}

/// 0 JOG, 1 MDA, 2 AUTOMATIC.
pub(super) fn mode<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    let group = &view.memory.from_nck().mode_groups[ModeGroupNumber::new(unit)?];
    let mode = match (group.active_mode_automatic(), group.active_mode_mdi()) {
        (true, _) => 2.0,
        (false, true) => 1.0,
        (false, false) => 0.0,
    };
    Some(Shown::Number(mode))
}

/// 0 none, 1 REPOS, 2 TEACH IN, 3 REF, of the first mode group.
pub(super) fn machine_function<'a>(view: &View<'a>) -> Option<Shown<'a>> {
    let group = &view.memory.from_nck().mode_groups[ModeGroupNumber::FIRST];
    let functions = [
        (group.active_machine_function_ref(), 3.0),
        (group.active_machine_function_teach_in(), 2.0),
        (group.active_machine_function_repos(), 1.0),
    ];
    let active = functions.into_iter().find(|(is_active, _)| *is_active);
    Some(Shown::Number(active.map_or(0.0, |(_, function)| function)))
}

/// 0 reset, 1 active, 2 interrupted.
pub(super) fn channel_status(from: &ChannelFromNck) -> f64 {
    match (from.channel_state_active(), from.channel_state_interrupted()) {
        (true, _) => 1.0,
        (false, true) => 2.0,
        (false, false) => 0.0,
    }
}

/// 1 interrupted, 2 stopped, 3 running, 4 waiting, 5 aborted.
pub(super) fn program_status(from: &ChannelFromNck) -> f64 {
    let states = [
        (from.program_state_running(), 3.0),
        (from.program_state_wait(), 4.0),
        (from.program_state_stopped(), 2.0),
        (from.program_state_interrupted(), 1.0),
    ];
    let state = states.into_iter().find(|(is_state, _)| *is_state);
    state.map_or(5.0, |(_, number)| number)
}

/// A signal of the axis, as a number.
pub(super) fn axis_signal<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&AxisFromNck) -> u8) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(Shown::Number(get(&view.memory.from_nck().axes[axis_number(view, line)?]).into()))
}

/// The active measuring system, 0 for none.
pub(super) fn measuring_system(from: &AxisFromNck) -> u8 {
    match (from.position_measuring_system_1_activated(), from.position_measuring_system_2_activated()) {
        (true, _) => 1,
        (false, true) => 2,
        (false, false) => 0,
    }
}

/// Velocity in mm/min or degrees per minute.
pub(super) fn feedrate<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    let velocity = view.variables.axes[axis_number(view, line)?].velocity;
    Some(Shown::Number(if is_rotary(view, line) { velocity * 360.0 } else { velocity }))
}

/// A value of the control for an axis.
pub(super) fn of_axis<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&dyn ControlValues, AxisNumber) -> f64,
) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(Shown::Number(get(view.control?, axis_number(view, line)?)))
}

/// Values of the control for a channel.
pub(super) fn of_channel<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&dyn ControlValues, ChannelNumber) -> f64,
) -> Option<Shown<'a>> {
    only(line)?;
    Some(Shown::Number(get(view.control?, channel_number(view, unit)?)))
}

/// A text of the program of a channel.
pub(super) fn program<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: impl FnOnce(ShownProgram<'a>) -> Cow<'a, str>,
) -> Option<Shown<'a>> {
    only(line)?;
    let channel = channel_number(view, unit)?;
    let shown = view.control.map(|control| control.shown_program(channel)).unwrap_or_default();
    Some(Shown::Text(get(shown)))
}

/// Three rows: the last block, the one that runs, and the next one. Only the one that runs is known.
pub(super) fn block<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    match line {
        2 => program(view, unit, 1, |program| program.block.into()),
        1 | 3 => empty(view, unit, 1),
        _ => None,
    }
}

/// The D number as a text.
pub(super) fn d_number<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    only(line)?;
    let number = view.memory.from_nck().auxiliary(channel_number(view, unit)?).d_function_1();
    Some(Shown::Text(number.to_string().into()))
}

/// A number of the program of a channel.
pub(super) fn of_program<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&ShownProgram<'_>) -> f64,
) -> Option<Shown<'a>> {
    only(line)?;
    let channel = channel_number(view, unit)?;
    let shown = view.control.map(|control| control.shown_program(channel)).unwrap_or_default();
    Some(Shown::Number(get(&shown)))
}

/// A program as a file of the NC, or its name alone.
pub(super) fn file(path: Option<&str>, is_whole: bool) -> Cow<'static, str> {
    let file = path.map(nc_file).unwrap_or_default();
    let name = if is_whole { file.as_str() } else { file.rsplit('/').next().unwrap_or_default() };
    name.to_owned().into()
}

/// The axis of a spindle, by its number (MD35000).
fn spindle(view: &View<'_>, number: u16) -> Option<AxisNumber> {
    let data = view.machine_data?;
    let mut axes = view.names.axes.iter().filter(|(_, name)| name.is_some()).map(|(axis, _)| axis);
    axes.find(|axis| match data.datum(Place::Axis(*axis), 35000, 0) {
        Some(Datum::Byte(found)) => number > 0 && u16::from(found) == number,
        Some(Datum::Whole(found)) => number > 0 && found == i32::from(number),
        _ => false,
    })
}

/// The number of spindles.
pub(super) fn count_spindles<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    only(line)?;
    channel_exists(view, unit)?;
    Some(number((1..=31).filter(|number| spindle(view, *number).is_some()).count()))
}

/// A value of a spindle; the row is its number.
pub(super) fn of_spindle<'a>(
    view: &View<'a>,
    unit: u8,
    line: u16,
    get: fn(&View<'_>, AxisNumber) -> f64,
) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(Shown::Number(get(view, spindle(view, line)?)))
}

/// 0 clockwise, 1 counter-clockwise, 2 at rest.
pub(super) fn turn_state(view: &View<'_>, axis: AxisNumber) -> f64 {
    let from = &view.memory.from_nck().axes[axis];
    match (from.axis_stationary(), from.actual_direction_of_rotation_clockwise()) {
        (true, _) => 2.0,
        (false, true) => 0.0,
        (false, false) => 1.0,
    }
}

/// A settable zero offset: the rows of the axes of G500, then those of G54, and so on. In G500 all are 0.
pub(super) fn zero_offset<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    let channel = channel_number(view, unit)?;
    let axes: Vec<_> = view.names.axes.iter().filter(|(_, name)| name.is_some()).map(|(axis, _)| axis).collect();
    let row = usize::from(line.checked_sub(1)?);
    let frame = u8::try_from(row / axes.len().max(1)).ok().filter(|frame| *frame <= 4)?;
    let offset = |control: &dyn ControlValues| control.zero_offset(channel, frame, axes[row % axes.len()]);
    Some(Shown::Number(if frame == 0 { 0.0 } else { view.control.map_or(0.0, offset) }))
}

/// The clock of the CPU in seconds since 1970.
pub(super) fn seconds(view: &View<'_>) -> Shown<'static> {
    Shown::Number(view.clock.seconds())
}

/// Whether the axis of a row is a rotary axis: degrees are not converted to inches.
pub(super) fn is_rotary(view: &View<'_>, line: u16) -> bool {
    let axis = u8::try_from(line).ok().and_then(AxisNumber::new);
    axis.zip(view.control).is_some_and(|(axis, control)| control.is_rotary(axis))
}

/// The R parameter of a row: its channel, its number and its value.
///
/// # Errors
/// The channel or the parameter does not exist.
pub fn r_parameter(view: &View<'_>, unit: u8, line: u16) -> Result<(ChannelNumber, u16, f64), Refused> {
    let control = view.control.ok_or(Refused::DoesNotExist)?;
    let channel = channel_number(view, unit).ok_or(Refused::OutOfRange)?;
    let number = line.checked_sub(1).ok_or(Refused::OutOfRange)?;
    let value = control.r_parameter(channel, number).ok_or(Refused::OutOfRange)?;
    Ok((channel, number, value))
}

impl Variable {
    /// Its value for a unit and a line, both from one; lengths in mm, or in inches. `None` if there is no such row.
    #[must_use]
    pub fn value<'a>(&self, view: &View<'a>, unit: u8, line: u16, is_inch: bool) -> Option<Shown<'a>> {
        match ((self.get)(view, unit, line)?, self.kind) {
            (Shown::Number(length), Kind::Length) if is_inch && !is_rotary(view, line) => {
                Some(Shown::Number(length / 25.4))
            }
            (shown, _) => Some(shown),
        }
    }
}
