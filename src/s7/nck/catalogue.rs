//! The catalogue: which variable lies at which area, module and column, how it is written down, and where its value comes from.
//!
//! It has what clients were seen to ask for and what this simulator knows. A control that runs no program shows no tool (T0),
//! no program name and no program state; so does this one. A geometry axis is the machine axis of the same number.

use super::{Kind, NckArea, Shown, Variable, View, module};
use crate::image::{ChannelFromNck, ChannelToNck};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{Alarms, AxisValues, RaisedAlarm};

use Kind::{Double, Length, Long, Text, Word};
use NckArea::{Channel, ModeGroup, Nck};

macro_rules! row {
    ($name:literal, $area:ident, $module:ident, $column:literal, $kind:expr, $get:expr) => {
        Variable { name: $name, area: $area, module: module::$module, column: $column, kind: $kind, get: $get }
    };
}

/// Every variable by name.
#[rustfmt::skip]
pub const CATALOGUE: &[Variable] = &[
    // Axes; the row is the number of the axis.
    row!("C/MachineAxis/cmdToolBasePos",        Channel,   SMA,    0x0001, Length,    |v, c, l| axis(v, c, l, |a| a.setpoint.user())),
    row!("C/MachineAxis/actToolBasePos",        Channel,   SMA,    0x0002, Length,    |v, c, l| axis(v, c, l, |a| a.position.user())),
    row!("C/MachineAxis/toolBaseDistToGo",      Channel,   SMA,    0x0003, Length,    |v, c, l| axis(v, c, l, |a| a.distance_to_go.user())),
    row!("C/GeometricAxis/actToolBasePos",      Channel,   SGA,    0x0002, Length,    |v, c, l| geometry_axis(v, c, l, |a| a.position.user())),
    row!("C/GeometricAxisExt/actFeedRate",      Channel,   SEGA,   0x0003, Length,    |v, c, l| geometry_axis(v, c, l, |a| a.velocity)),
    row!("C/GeometricAxisExt/position shown",   Channel,   SEGA,   0x0019, Length,    |v, c, l| geometry_axis(v, c, l, |a| a.position.user())),
    row!("C/MachineAxisExt/lag",                Channel,   SEMA,   0x000A, Length,    |v, c, l| axis(v, c, l, |a| a.following_error.user())),
    // Names.
    row!("C/$MC_AXCONF_CHANAX_NAME_TAB",        Channel,   M,      20080,  Text(32),  |v, c, l| channel_exists(v, c).and_then(|()| axis_name(v, l))),
    row!("C/$MC_CHAN_NAME",                     Channel,   M,      20000,  Text(32),  |v, c, l| only(l).and_then(|()| channel_name(v, c))),
    row!("N/$MN_AXCONF_MACHAX_NAME_TAB",        Nck,       M,      10000,  Text(32),  |v, _, l| axis_name(v, l)),
    // The configuration.
    row!("C/Y/numMachAxes",                     Channel,   Y,      0x0003, Word,      |v, c, l| only(l).and_then(|()| count_axes(v, c))),
    row!("C/Y/numSpindles",                     Channel,   Y,      0x0004, Word,      |v, c, l| zero(v, c, l)),
    row!("N/Y/basicLengthUnit",                 Nck,       Y,      0x0002, Word,      |v, _, l| only(l).map(|()| flag(v.memory.from_nck.nck.inch_measuring_system_active()))),
    row!("N/Y/maxnumAlarms",                    Nck,       Y,      0x0013, Word,      |_, _, l| only(l).map(|()| number(Alarms::CAPACITY))),
    // The mode group.
    row!("B/State/opMode",                      ModeGroup, S,      0x0003, Word,      |v, b, l| only(l).and_then(|()| mode(v, b))),
    // The channel.
    row!("C/State/actFeedRateIpo",              Channel,   S,      0x0001, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/cmdFeedRateIpo",              Channel,   S,      0x0002, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/chanStatus",                  Channel,   S,      0x000B, Word,      |v, c, l| channel(v, c, l, channel_status)),
    row!("C/State/machFunc",                    Channel,   S,      0x000C, Word,      |v, c, l| channel(v, c, l, |_| 0.0).and_then(|_| machine_function(v))),
    row!("C/State/progStatus",                  Channel,   S,      0x000D, Word,      |v, c, l| channel(v, c, l, program_status)),
    row!("C/State/actTNumber",                  Channel,   S,      0x0017, Word,      |v, c, l| zero(v, c, l)),
    row!("C/State/actDNumber",                  Channel,   S,      0x0018, Word,      |v, c, l| zero(v, c, l)),
    row!("C/State/actToolIdent",                Channel,   S,      0x0021, Text(32),  |v, c, l| empty(v, c, l)),
    row!("C/State/reqParts",                    Channel,   S,      0x0077, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/totalParts",                  Channel,   S,      0x0078, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/actParts",                    Channel,   S,      0x0079, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/specParts",                   Channel,   S,      0x007A, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/actProgNetTime",              Channel,   S,      0x0129, Double,    |v, c, l| zero(v, c, l)),
    row!("C/State/oldProgNetTime",              Channel,   S,      0x012A, Double,    |v, c, l| zero(v, c, l)),
    // The program.
    row!("C/ProgramInfo/msg",                   Channel,   SPARP,  0x0001, Text(128), |v, c, l| empty(v, c, l)),
    row!("C/ProgramInfo/progName",              Channel,   SPARP,  0x0003, Text(32),  |v, c, l| empty(v, c, l)),
    row!("C/ProgramInfo/block",                 Channel,   SPARP,  0x0004, Text(66),  |v, c, l| if l <= 3 { empty(v, c, 1) } else { None }),
    row!("C/ProgramInfo/actLineNumber",         Channel,   SPARP,  0x0009, Long,      |v, c, l| zero(v, c, l)),
    row!("C/ProgramInfo/workPNameLong",         Channel,   SPARP,  0x000C, Text(128), |v, c, l| empty(v, c, l)),
    row!("C/ProgramInfo/workPandProgName",      Channel,   SPARP,  0x0010, Text(160), |v, c, l| empty(v, c, l)),
    row!("C/ProgramInfo/selectedWorkPProg",     Channel,   SPARP,  0x0023, Text(160), |v, c, l| empty(v, c, l)),
    row!("C/ProgramPointer/progName",           Channel,   SPARPP, 0x0005, Text(32),  |v, c, l| empty(v, c, l)),
    row!("C/ProgramModification/trialRun",      Channel,   SINF,   0x0009, Word,      |v, c, l| asked(v, c, l, ChannelToNck::activate_dry_run_feedrate)),
    row!("C/ProgramModification/optStop",       Channel,   SINF,   0x000A, Word,      |v, c, l| asked(v, c, l, ChannelToNck::activate_m01)),
    row!("C/ProgramModification/singleBlock",   Channel,   SINF,   0x000C, Word,      |v, c, l| asked(v, c, l, ChannelToNck::activate_single_block)),
    row!("C/ProgramModification/progTest",      Channel,   SINF,   0x0010, Word,      |v, c, l| channel(v, c, l, |from| f64::from(u8::from(from.program_test_active())))),
    // Alarms; the row is the place in the list. textIndex is the number that is shown, alarmNo the place in the list, 0 for none.
    row!("N/State/numAlarms",                   Nck,       S,      0x0007, Word,      |v, _, l| only(l).map(|()| number(v.variables.alarms.count()))),
    row!("N/AlarmList/textIndex",               Nck,       SALA,   0x0001, Long,      |v, _, l| alarm(v, l).map(shown_number)),
    row!("N/AlarmList/alarmNo",                 Nck,       SALA,   0x0002, Long,      |v, _, l| alarm(v, l).map(|alarm| place(l, alarm))),
    row!("N/AlarmListTime/textIndex",           Nck,       SALAC,  0x0001, Long,      |v, _, l| alarm(v, l).map(shown_number)),
    row!("N/AlarmListTime/alarmNo",             Nck,       SALAC,  0x0002, Long,      |v, _, l| alarm(v, l).map(|alarm| place(l, alarm))),
    row!("N/LastAlarm/textIndex",               Nck,       SALAL,  0x0001, Long,      |v, _, l| only(l).map(|()| shown_number(last_alarm(v)))),
    row!("N/LastAlarm/alarmNo",                 Nck,       SALAL,  0x0002, Long,      |v, _, l| only(l).map(|()| number(v.variables.alarms.count()))),
    row!("N/TopPrioAlarm/textIndex",            Nck,       SALAP,  0x0001, Long,      |v, _, l| only(l).and_then(|()| alarm(v, 1)).map(shown_number)),
    row!("N/TopPrioAlarm/alarmNo",              Nck,       SALAP,  0x0002, Long,      |v, _, l| only(l).and_then(|()| alarm(v, 1)).map(|alarm| place(1, alarm))),
];

fn number(count: usize) -> Shown<'static> {
    Shown::Number(f64::from(u32::try_from(count).unwrap_or(u32::MAX)))
}

fn flag(value: bool) -> Shown<'static> {
    Shown::Number(f64::from(u8::from(value)))
}

/// Whether a line is the only one.
fn only(line: u16) -> Option<()> {
    (line == 1).then_some(())
}

fn channel_exists(view: &View<'_>, unit: u8) -> Option<()> {
    channel_number(view, unit).map(|_| ())
}

/// A channel that has a name; the first one exists always.
fn channel_number(view: &View<'_>, unit: u8) -> Option<ChannelNumber> {
    let number = ChannelNumber::new(unit)?;
    (number == ChannelNumber::FIRST || view.names.channels[number].is_some()).then_some(number)
}

fn axis_number(view: &View<'_>, line: u16) -> Option<AxisNumber> {
    let number = AxisNumber::new(u8::try_from(line).ok()?)?;
    view.names.axes[number].as_ref().map(|_| number)
}

fn axis<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&AxisValues) -> f64) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(Shown::Number(get(&view.variables.axes[axis_number(view, line)?])))
}

/// There are at most three of them.
fn geometry_axis<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&AxisValues) -> f64) -> Option<Shown<'a>> {
    if line > 3 { None } else { axis(view, unit, line, get) }
}

fn axis_name<'a>(view: &View<'a>, line: u16) -> Option<Shown<'a>> {
    // A table of names has a row for each axis that there could be; rows of others are empty.
    let number = AxisNumber::new(u8::try_from(line).ok()?)?;
    Some(Shown::Text(view.names.axes[number].as_deref().unwrap_or("")))
}

fn channel_name<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    let number = channel_number(view, unit)?;
    Some(Shown::Text(view.names.channels[number].as_deref().unwrap_or("")))
}

fn count_axes<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    channel_exists(view, unit)?;
    Some(number(view.names.axes.iter().filter(|(_, name)| name.is_some()).count()))
}

fn channel<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&ChannelFromNck) -> f64) -> Option<Shown<'a>> {
    only(line)?;
    Some(Shown::Number(get(&view.memory.from_nck.channels[channel_number(view, unit)?])))
}

/// A function that the PLC asks for.
fn asked<'a>(view: &View<'a>, unit: u8, line: u16, get: fn(&ChannelToNck) -> bool) -> Option<Shown<'a>> {
    only(line)?;
    Some(flag(get(&view.memory.to_nck.channels[channel_number(view, unit)?])))
}

fn zero<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    channel(view, unit, line, |_| 0.0)
}

fn empty<'a>(view: &View<'a>, unit: u8, line: u16) -> Option<Shown<'a>> {
    zero(view, unit, line).map(|_| Shown::Text(""))
}

/// 0 JOG, 1 MDA, 2 AUTOMATIC.
fn mode<'a>(view: &View<'a>, unit: u8) -> Option<Shown<'a>> {
    let group = &view.memory.from_nck.mode_groups[ModeGroupNumber::new(unit)?];
    let mode = match (group.active_mode_automatic(), group.active_mode_mdi()) {
        (true, _) => 2.0,
        (false, true) => 1.0,
        (false, false) => 0.0,
    };
    Some(Shown::Number(mode))
}

/// 0 none, 1 REPOS, 2 TEACH IN, 3 REF, of the first mode group.
fn machine_function<'a>(view: &View<'a>) -> Option<Shown<'a>> {
    let group = &view.memory.from_nck.mode_groups[ModeGroupNumber::FIRST];
    let functions = [
        (group.active_machine_function_ref(), 3.0),
        (group.active_machine_function_teach_in(), 2.0),
        (group.active_machine_function_repos(), 1.0),
    ];
    let active = functions.into_iter().find(|(is_active, _)| *is_active);
    Some(Shown::Number(active.map_or(0.0, |(_, function)| function)))
}

/// 0 reset, 1 active, 2 interrupted.
fn channel_status(from: &ChannelFromNck) -> f64 {
    match (from.channel_state_active(), from.channel_state_interrupted()) {
        (true, _) => 1.0,
        (false, true) => 2.0,
        (false, false) => 0.0,
    }
}

/// 1 interrupted, 2 stopped, 3 running, 4 waiting, 5 aborted.
fn program_status(from: &ChannelFromNck) -> f64 {
    let states = [
        (from.program_state_running(), 3.0),
        (from.program_state_wait(), 4.0),
        (from.program_state_stopped(), 2.0),
        (from.program_state_interrupted(), 1.0),
    ];
    let state = states.into_iter().find(|(is_state, _)| *is_state);
    state.map_or(5.0, |(_, number)| number)
}

/// The alarm at a place of the list, if there is one; the list has so many places that a client may look further than alarms are
/// pending.
fn alarm<'a>(view: &View<'a>, line: u16) -> Option<Option<&'a RaisedAlarm>> {
    let at = usize::from(line.checked_sub(1)?);
    (at < Alarms::CAPACITY).then(|| view.variables.alarms.iter().nth(at))
}

/// Alarms are kept in order of number, not of time; the last is the one with the highest number.
fn last_alarm<'a>(view: &View<'a>) -> Option<&'a RaisedAlarm> {
    view.variables.alarms.iter().last()
}

fn shown_number<'a>(alarm: Option<&RaisedAlarm>) -> Shown<'a> {
    Shown::Number(alarm.map_or(0.0, |alarm| alarm.number.0.into()))
}

fn place<'a>(line: u16, alarm: Option<&RaisedAlarm>) -> Shown<'a> {
    Shown::Number(if alarm.is_some() { line.into() } else { 0.0 })
}
