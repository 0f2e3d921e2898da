//! The catalogue: for each variable its area, module and column, its format, the sources of its address, and its value.
//!
//! It contains the variables that clients were seen to request and that this simulator has. No address is invented: a variable that is not
//! listed here does not exist. Sources of an address: W Wireshark's dissector, D DotNetSiemensPLCToolBoxLibrary, F the datafeed edge
//! connector's export of Siemens' NC-Var selector, T an NCK driver in TypeScript and C a collector in C, both of which read controls, L the
//! public lists of the columns of a module, which agree with the other sources wherever both name a column.
//!
//! Choices: texts of machine data and of alarm parameters have 32 bytes; MD18040 has 20, as on a real 828D. Programs have their names as files
//! of the NC (`_N_PART_MPF`). T and D are those that the program has output, the commanded speed of a spindle is its S function. `sysTimeUdword` counts seconds since 1970. MD18040 has this
//! simulator and its version in the first of its four rows. `N/Y` has no `nckType` and `nckVersion`: their addresses (columns 001F and
//! 0020) are known, but no source lists the values of the controls.

use super::alarms::{self, Order};
use super::drives::motor_speed;
use super::values::{
    asked, axis, axis_name, axis_number, axis_signal, block, channel, channel_exists, channel_name, channel_status,
    count_axes, count_spindles, d_number, empty, feedrate, file, flag, geometry_axis, machine_function,
    measuring_system, mode, number, of_axis, of_channel, of_output, of_program, of_spindle, only, program,
    program_status, r_parameter, seconds, turn_state, version, zero, zero_offset,
};
use super::variable::module;
use super::{Kind, NckArea, Shown, Variable};
use crate::image::ChannelToNck;
use crate::variables::Alarms;

use Kind::{Date, Double, DriveReal, Length, Long, Text, UnsignedLong, Word};
use NckArea::{Channel, FeedDrive, ModeGroup, Nck};

macro_rules! row {
    ($name:literal, $area:ident, $module:ident, $column:literal, $kind:expr, $source:literal, $get:expr) => {
        Variable {
            name: $name,
            area: $area,
            module: module::$module,
            column: $column,
            kind: $kind,
            source: $source,
            get: $get,
        }
    };
}

/// All variables by name.
#[rustfmt::skip]
pub const CATALOGUE: &[Variable] = &[
    // Axes; the row is the axis number. The NCK has the modules SMA and SEMA as well, with the same columns.
    row!("C/MachineAxis/cmdToolBasePos",       Channel,   SMA,    0x0001, Length,    "L",       |v, c, l| axis(v, c, l, |a| a.setpoint.user())),
    row!("C/MachineAxis/actToolBasePos",       Channel,   SMA,    0x0002, Length,    "F C L",   |v, c, l| axis(v, c, l, |a| a.position.user())),
    row!("C/MachineAxis/toolBaseDistToGo",     Channel,   SMA,    0x0003, Length,    "C L",     |v, c, l| axis(v, c, l, |a| a.distance_to_go.user())),
    row!("C/MachineAxis/name",                 Channel,   SMA,    0x0009, Text(32),  "L",       |v, c, l| axis_number(v, l).and_then(|_| axis(v, c, l, |_| 0.0)).and_then(|_| axis_name(v, l))),
    row!("C/GeometricAxis/cmdToolBasePos",     Channel,   SGA,    0x0001, Length,    "L",       |v, c, l| geometry_axis(v, c, l, |a| a.setpoint.user())),
    row!("C/GeometricAxis/actToolBasePos",     Channel,   SGA,    0x0002, Length,    "F",       |v, c, l| geometry_axis(v, c, l, |a| a.position.user())),
    row!("C/GeometricAxis/toolBaseDistToGo",   Channel,   SGA,    0x0003, Length,    "L",       |v, c, l| geometry_axis(v, c, l, |a| a.distance_to_go.user())),
    row!("C/GeometricAxisExt/actFeedRate",     Channel,   SEGA,   0x0003, Length,    "F",       |v, c, l| if l > 3 { None } else { feedrate(v, c, l) }),
    row!("C/GeometricAxisExt/position shown",  Channel,   SEGA,   0x0019, Length,    "C",       |v, c, l| geometry_axis(v, c, l, |a| a.position.user())),
    row!("C/MachineAxisExt/feedRateOvr",       Channel,   SEMA,   0x0001, Double,    "T L",     |v, c, l| of_axis(v, c, l, |control, axis| control.axis_override(axis))),
    row!("C/MachineAxisExt/actFeedRate",       Channel,   SEMA,   0x0003, Length,    "L",       |v, c, l| feedrate(v, c, l)),
    row!("C/MachineAxisExt/measPos1",          Channel,   SEMA,   0x0005, Length,    "L",       |v, c, l| axis(v, c, l, |a| a.encoders[0].user())),
    row!("C/MachineAxisExt/measPos2",          Channel,   SEMA,   0x0006, Length,    "L",       |v, c, l| axis(v, c, l, |a| a.encoders[1].user())),
    row!("C/MachineAxisExt/cmdContrPos",       Channel,   SEMA,   0x0009, Length,    "L",       |v, c, l| axis(v, c, l, |a| a.setpoint.user())),
    row!("C/MachineAxisExt/lag",               Channel,   SEMA,   0x000A, Length,    "F L",     |v, c, l| axis(v, c, l, |a| a.following_error.user())),
    row!("C/MachineAxisExt/paramSetNo",        Channel,   SEMA,   0x0025, Word,      "L",       |v, c, l| axis_signal(v, c, l, |from| from.active_controller_parameter_set() + 1)),
    row!("C/MachineAxisExt/driveReady",        Channel,   SEMA,   0x0027, Word,      "L",       |v, c, l| axis_signal(v, c, l, |from| from.drive_ready().into())),
    row!("C/MachineAxisExt/encChoice",         Channel,   SEMA,   0x002A, Word,      "L",       |v, c, l| axis_signal(v, c, l, measuring_system)),
    row!("C/MachineAxisExt/driveActParamSet",  Channel,   SEMA,   0x002E, Word,      "L",       |v, c, l| axis_signal(v, c, l, |from| from.active_drive_data_set() + 1)),
    row!("C/MachineAxisExt/vaSyncDiff",        Channel,   SEMA,   0x00C1, Length,    "L",       |v, c, l| axis(v, c, l, |a| a.synchronism_difference.user())),
    // Spindles; the row is the number of the spindle (MD35000).
    row!("C/Spindle/actSpeed",                 Channel,   SSP,    0x0002, Double,    "F C T L", |v, c, l| of_spindle(v, c, l, |v, axis| v.variables.axes[axis].velocity.abs())),
    row!("C/Spindle/cmdSpeed",                 Channel,   SSP,    0x0003, Double,    "F C T L", |v, c, l| of_spindle(v, c, l, |v, axis| f64::from(v.memory.from_nck().axes[axis].spindle_s_function()))),
    row!("C/Spindle/speedOvr",                 Channel,   SSP,    0x0004, Double,    "F C T L", |v, c, l| of_spindle(v, c, l, |v, axis| v.control.map_or(100.0, |control| control.spindle_override(axis)))),
    row!("C/Spindle/turnState",                Channel,   SSP,    0x0009, Word,      "F C T L", |v, c, l| of_spindle(v, c, l, turn_state)),
    row!("C/Spindle/spindleType",              Channel,   SSP,    0x000D, Word,      "F C T L", |v, c, l| of_spindle(v, c, l, |_, _| 0.0)),
    // Drives; the unit is the drive number.
    row!("V/Drive/r0021 actual speed",         FeedDrive, DRIVE,  0x0015, DriveReal, "C",       |v, d, l| motor_speed(v, d, l)),
    row!("V/Drive/MD1707 actual speed",        FeedDrive, M,      0x06AB, DriveReal, "F",       |v, d, l| motor_speed(v, d, l)),
    // Names and numbers.
    row!("C/$MC_AXCONF_CHANAX_NAME_TAB",       Channel,   M,      0x4E70, Text(32),  "C",       |v, c, l| channel_exists(v, c).and_then(|()| axis_name(v, l))),
    row!("C/$MC_CHAN_NAME",                    Channel,   M,      0x4E20, Text(32),  "C D",     |v, c, l| only(l).and_then(|()| channel_name(v, c))),
    row!("N/$MN_AXCONF_MACHAX_NAME_TAB",       Nck,       M,      0x2710, Text(32),  "C D",     |v, _, l| axis_name(v, l)),
    row!("N/$MN_HW_SERIAL_NUMBER",             Nck,       M,      0x466E, Text(32),  "C",       |v, _, l| only(l).map(|()| Shown::Text(v.serial_number.into()))),
    row!("N/$MN_VERSION_INFO",                 Nck,       M,      0x4678, Text(20),  "C",       |_, _, l| version(l)),
    // The configuration.
    row!("C/Y/numMachAxes",                    Channel,   Y,      0x0003, Word,      "T",       |v, c, l| only(l).and_then(|()| count_axes(v, c))),
    row!("C/Y/numSpindles",                    Channel,   Y,      0x0004, Word,      "T",       |v, c, l| count_spindles(v, c, l)),
    row!("N/Y/basicLengthUnit",                Nck,       Y,      0x0002, Word,      "T",       |v, _, l| only(l).map(|()| flag(v.memory.from_nck().nck.inch_measuring_system_active()))),
    row!("N/Y/maxnumAlarms",                   Nck,       Y,      0x0013, Word,      "T",       |_, _, l| only(l).map(|()| number(Alarms::CAPACITY))),
    // The mode group.
    row!("B/State/opMode",                     ModeGroup, S,      0x0003, Word,      "F T C",   |v, b, l| only(l).and_then(|()| mode(v, b))),
    // The channel.
    row!("C/State/actFeedRateIpo",             Channel,   S,      0x0001, Double,    "C",       |v, c, l| of_program(v, c, l, |program| program.velocity)),
    row!("C/State/cmdFeedRateIpo",             Channel,   S,      0x0002, Double,    "C",       |v, c, l| zero(v, c, l)),
    row!("C/State/feedRateIpoOvr",             Channel,   S,      0x0003, Double,    "F T C",   |v, c, l| of_channel(v, c, l, |control, channel| control.channel_overrides(channel)[0])),
    row!("C/State/rapFeedRateOvr",             Channel,   S,      0x0004, Double,    "F T C",   |v, c, l| of_channel(v, c, l, |control, channel| control.channel_overrides(channel)[1])),
    row!("C/State/chanStatus",                 Channel,   S,      0x000B, Word,      "T C",     |v, c, l| channel(v, c, l, channel_status)),
    row!("C/State/machFunc",                   Channel,   S,      0x000C, Word,      "C",       |v, c, l| channel(v, c, l, |_| 0.0).and_then(|_| machine_function(v))),
    row!("C/State/progStatus",                 Channel,   S,      0x000D, Word,      "T C",     |v, c, l| channel(v, c, l, program_status)),
    row!("C/State/actTNumber",                 Channel,   S,      0x0017, Word,      "T C F",   |v, c, l| of_output(v, c, l, |from| from.t_function_1().into())),
    row!("C/State/actDNumber",                 Channel,   S,      0x0018, Word,      "T C F",   |v, c, l| of_output(v, c, l, |from| from.d_function_1().into())),
    row!("C/State/actToolIdent",               Channel,   S,      0x0021, Text(32),  "T C F",   |v, c, l| empty(v, c, l)),
    row!("C/State/D number shown",             Channel,   S,      0x0023, Text(32),  "C",       |v, c, l| d_number(v, c, l)),
    row!("C/State/reqParts",                   Channel,   S,      0x0077, Double,    "T C",     |v, c, l| zero(v, c, l)),
    row!("C/State/totalParts",                 Channel,   S,      0x0078, Double,    "T C",     |v, c, l| zero(v, c, l)),
    row!("C/State/actParts",                   Channel,   S,      0x0079, Double,    "T C",     |v, c, l| zero(v, c, l)),
    row!("C/State/specParts",                  Channel,   S,      0x007A, Double,    "T C",     |v, c, l| zero(v, c, l)),
    row!("C/State/actProgNetTime",             Channel,   S,      0x0129, Double,    "T D C",   |v, c, l| zero(v, c, l)),
    row!("C/State/oldProgNetTime",             Channel,   S,      0x012A, Double,    "T D C",   |v, c, l| zero(v, c, l)),
    row!("C/DIAGN/cycleTime",                  Channel,   DIAGN,  0x0009, Double,    "T D",     |v, c, l| zero(v, c, l)),
    row!("C/DIAGN/cuttingTime",                Channel,   DIAGN,  0x000A, Double,    "T D",     |v, c, l| zero(v, c, l)),
    // R parameters; R0 is row 1. Only these rows can be written.
    row!("C/Parameter/rpa",                    Channel,   RP,     0x0001, Double,    "D C",     |v, c, l| r_parameter(v, c, l).ok().map(|(_, _, value)| Shown::Number(value))),
    // The program.
    row!("C/ProgramInfo/msg",                  Channel,   SPARP,  0x0001, Text(128), "T F",     |v, c, l| program(v, c, l, |program| program.message.into())),
    row!("C/ProgramInfo/progName",             Channel,   SPARP,  0x0003, Text(32),  "T F",     |v, c, l| program(v, c, l, |program| file(program.active, false))),
    row!("C/ProgramInfo/block",                Channel,   SPARP,  0x0004, Text(66),  "T F",     |v, c, l| block(v, c, l)),
    row!("C/ProgramInfo/actLineNumber",        Channel,   SPARP,  0x0009, Long,      "T F",     |v, c, l| of_program(v, c, l, |program| program.line.into())),
    row!("C/ProgramInfo/workPNameLong",        Channel,   SPARP,  0x000C, Text(128), "T F",     |v, c, l| empty(v, c, l)),
    row!("C/ProgramInfo/workPandProgName",     Channel,   SPARP,  0x0010, Text(160), "T F",     |v, c, l| program(v, c, l, |program| file(program.active, true))),
    row!("C/ProgramInfo/selectedWorkPProg",    Channel,   SPARP,  0x0023, Text(160), "T F",     |v, c, l| program(v, c, l, |program| file(program.selected, true))),
    row!("C/ProgramPointer/progName",          Channel,   SPARPP, 0x0005, Text(32),  "T C",     |v, c, l| empty(v, c, l)),
    row!("C/ProgramPointer/selected program",  Channel,   SPARPP, 0x000C, Text(160), "C",       |v, c, l| program(v, c, l, |program| file(program.selected, true))),
    row!("C/UserFrame/linShift",               Channel,   FU,     0x0001, Double,    "C",       |v, c, l| zero_offset(v, c, l)),
    row!("C/ProgramModification/trialRun",     Channel,   SINF,   0x0009, Word,      "T",       |v, c, l| asked(v, c, l, ChannelToNck::activate_dry_run_feedrate)),
    row!("C/ProgramModification/optStop",      Channel,   SINF,   0x000A, Word,      "T",       |v, c, l| asked(v, c, l, ChannelToNck::activate_m01)),
    row!("C/ProgramModification/singleBlock",  Channel,   SINF,   0x000C, Word,      "T",       |v, c, l| asked(v, c, l, ChannelToNck::activate_single_block)),
    row!("C/ProgramModification/progTest",     Channel,   SINF,   0x0010, Word,      "T",       |v, c, l| channel(v, c, l, |from| f64::from(u8::from(from.program_test_active())))),
    // The time.
    row!("N/State/sysTimeBCD",                 Nck,       S,      0x0001, Date,      "L",       |v, _, l| only(l).map(|()| Shown::Date(Some(v.clock)))),
    row!("N/State/sysTimeUdword",              Nck,       S,      0x0121, UnsignedLong,"T C L",   |v, _, l| only(l).map(|()| seconds(v))),
    // Alarms; the row is the position in the list.
    row!("N/State/numAlarms",                  Nck,       S,      0x0007, Word,      "T C L",   |v, _, l| only(l).map(|()| number(v.variables.alarms.count()))),
    row!("N/AlarmList/textIndex",              Nck,       SALA,   0x0001, Long,      "C L",     |v, _, l| alarms::text_index(v, Order::Time, l)),
    row!("N/AlarmList/alarmNo",                Nck,       SALA,   0x0002, Long,      "T L",     |v, _, l| alarms::ordinal(v, Order::Time, l)),
    row!("N/AlarmList/clearInfo",              Nck,       SALA,   0x0003, Word,      "L",       |v, _, l| alarms::clear_info(v, Order::Time, l)),
    row!("N/AlarmList/timeBCD",                Nck,       SALA,   0x0004, Date,      "L",       |v, _, l| alarms::date(v, Order::Time, l)),
    row!("N/AlarmList/fillText1",              Nck,       SALA,   0x0005, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 0)),
    row!("N/AlarmList/fillText2",              Nck,       SALA,   0x0006, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 1)),
    row!("N/AlarmList/fillText3",              Nck,       SALA,   0x0007, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 2)),
    row!("N/AlarmList/fillText4",              Nck,       SALA,   0x0008, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 3)),
    row!("N/AlarmEvent/textIndex",             Nck,       SALAC,  0x0001, Long,      "L",       |v, _, l| alarms::text_index(v, Order::Time, l)),
    row!("N/AlarmEvent/alarmNo",               Nck,       SALAC,  0x0002, Long,      "T L",     |v, _, l| alarms::ordinal(v, Order::Time, l)),
    row!("N/AlarmEvent/clearInfo",             Nck,       SALAC,  0x0003, Word,      "L",       |v, _, l| alarms::clear_info(v, Order::Time, l)),
    row!("N/AlarmEvent/timeBCD",               Nck,       SALAC,  0x0004, Date,      "L",       |v, _, l| alarms::date(v, Order::Time, l)),
    row!("N/AlarmEvent/fillText1",             Nck,       SALAC,  0x0005, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 0)),
    row!("N/AlarmEvent/fillText2",             Nck,       SALAC,  0x0006, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 1)),
    row!("N/AlarmEvent/fillText3",             Nck,       SALAC,  0x0007, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 2)),
    row!("N/AlarmEvent/fillText4",             Nck,       SALAC,  0x0008, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Time, l, 3)),
    row!("N/LastAlarm/textIndex",              Nck,       SALAL,  0x0001, Long,      "L",       |v, _, l| alarms::text_index(v, Order::LastFirst, l)),
    row!("N/LastAlarm/alarmNo",                Nck,       SALAL,  0x0002, Long,      "T L",     |v, _, l| alarms::ordinal(v, Order::LastFirst, l)),
    row!("N/LastAlarm/clearInfo",              Nck,       SALAL,  0x0003, Word,      "L",       |v, _, l| alarms::clear_info(v, Order::LastFirst, l)),
    row!("N/LastAlarm/timeBCD",                Nck,       SALAL,  0x0004, Date,      "L",       |v, _, l| alarms::date(v, Order::LastFirst, l)),
    row!("N/LastAlarm/fillText1",              Nck,       SALAL,  0x0005, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::LastFirst, l, 0)),
    row!("N/LastAlarm/fillText2",              Nck,       SALAL,  0x0006, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::LastFirst, l, 1)),
    row!("N/LastAlarm/fillText3",              Nck,       SALAL,  0x0007, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::LastFirst, l, 2)),
    row!("N/LastAlarm/fillText4",              Nck,       SALAL,  0x0008, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::LastFirst, l, 3)),
    row!("N/TopPrioAlarm/textIndex",           Nck,       SALAP,  0x0001, Long,      "L",       |v, _, l| alarms::text_index(v, Order::Priority, l)),
    row!("N/TopPrioAlarm/alarmNo",             Nck,       SALAP,  0x0002, Long,      "T L",     |v, _, l| alarms::ordinal(v, Order::Priority, l)),
    row!("N/TopPrioAlarm/clearInfo",           Nck,       SALAP,  0x0003, Word,      "L",       |v, _, l| alarms::clear_info(v, Order::Priority, l)),
    row!("N/TopPrioAlarm/timeBCD",             Nck,       SALAP,  0x0004, Date,      "L",       |v, _, l| alarms::date(v, Order::Priority, l)),
    row!("N/TopPrioAlarm/fillText1",           Nck,       SALAP,  0x0005, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Priority, l, 0)),
    row!("N/TopPrioAlarm/fillText2",           Nck,       SALAP,  0x0006, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Priority, l, 1)),
    row!("N/TopPrioAlarm/fillText3",           Nck,       SALAP,  0x0007, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Priority, l, 2)),
    row!("N/TopPrioAlarm/fillText4",           Nck,       SALAP,  0x0008, Text(32),  "L",       |v, _, l| alarms::parameter(v, Order::Priority, l, 3)),
];
