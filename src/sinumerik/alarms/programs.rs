//! Alarms of programs: those of preparation (their numbers and texts are those of [`nc_program`](crate::nc_program)), and those of the channel
//! that runs a program.

use crate::sinumerik::alarms::{Alarm, Cancel, Reaction, alarms};
use crate::variables::AlarmNumber;

alarms! {
    /// The alarms of programs, ascending by number.
    PROGRAMS;
    10208 [INTERPRETER_STOP DISPLAY STOP] NcStart "channel %1 continue the program with NC start after the block search";
    10610 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 axis %2 block %3 positioning axis still moves";
    10720 [CORRECTION_BLOCK LOCAL INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %3 axis %2 programmed end point is behind software limit switch %4";
    10722 [CORRECTION_BLOCK LOCAL INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %3 axis %2 path violates software limit switch %4";
    10730 [CORRECTION_BLOCK LOCAL INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %3 axis %2 path leaves the working area %4";
    10860 [CORRECTION_BLOCK LOCAL INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 no feedrate programmed";
    10861 [CORRECTION_BLOCK LOCAL INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %3 axis %2 positioning velocity is 0";
    12000 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 address programmed more than once %3";
    12010 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 too many addresses of one type %3";
    12020 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 modifier not allowed with this address";
    12040 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 expression is not of type AXIS %3";
    12060 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 several functions of one G group";
    12070 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 too many G functions that define the syntax";
    12080 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 syntax error %3";
    12090 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 parameter not expected %3";
    12110 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 address does not fit the G function of the block";
    12120 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 G function must be alone in its block";
    12150 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 operation and data type do not fit %3";
    12160 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value outside the range of the type %3";
    12170 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 name defined more than once %3";
    12260 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 too many initial values %3";
    12300 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 reference parameter is missing %3";
    12320 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 reference parameter is not a variable %3";
    12330 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 parameter has the wrong type %3";
    12340 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 too many parameters %3";
    12400 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 array element does not exist %3";
    12410 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 index has the wrong type %3";
    12420 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 name is too long";
    12430 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 index is not valid";
    12470 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 unknown G function %3";
    12475 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 wrong number in indirect G programming %3";
    12500 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 keyword not allowed in this file %3";
    12550 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 name is not defined %3";
    12553 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 function is not active %3";
    12560 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value outside the permitted range %3";
    12630 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 skip or label not allowed in a block of a control structure";
    12640 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 control structure not closed, or crossed";
    12641 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 control structures nested too deep";
    14000 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 end of file without end of program";
    14010 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 omitted parameter has no default value";
    14011 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 program does not exist %3";
    14012 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 too many program levels";
    14013 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 number of passes is not positive";
    14014 [DISPLAY] CancelKey "channel %1 selected program does not exist: %3";
    14016 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 several M functions are replaced by subprograms";
    14020 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 wrong value or number of parameters";
    14025 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 wrong ID of a synchronised action";
    14040 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 end point of the circle is wrong";
    14048 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 wrong number of turns of a circle";
    14050 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 expression nested too deep";
    14051 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 arithmetic error";
    14060 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 wrong skip level";
    14080 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 jump target does not exist %3";
    14082 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 label of a part of the program does not exist %3";
    14088 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 axis %3 position too large";
    14091 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 function not allowed here %3";
    14092 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 wrong type of axis %3";
    14095 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 radius of the circle is too small";
    14300 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 handwheel override not allowed here";
    14500 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 DEF or PROC after the first block";
    14510 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 call with parameters of a program without PROC";
    14520 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 PROC is not the first block";
    14750 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 too many auxiliary functions";
    14757 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 action does not fit the type of the synchronised action";
    14760 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 several auxiliary functions of one group";
    14769 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 spindle %3: M%4 is one M function too many";
    14800 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 path feedrate is not positive";
    14810 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 feedrate of a positioning axis is negative %3";
    15310 [DISPLAY] CancelKey "channel %1 block search: selected program does not exist: %2";
    15330 [DISPLAY] CancelKey "channel %1 block search: %2 is not a block number";
    15340 [DISPLAY] CancelKey "channel %1 block search: %2 is not a label";
    15350 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block search: block %2 not found up to the end of the program";
    15370 [DISPLAY] CancelKey "channel %1 block search: the program has no block %2";
    15460 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 address does not fit the modal G function";
    15700 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 wrong number of a cycle alarm %3";
    16100 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 spindle does not exist in the channel %3";
    16420 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 axis programmed more than once %3";
    16779 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 block %2 too many leading axes for axis %3: %4 leads it already";
    16782 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 following axis %3 not available";
    16785 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 the same axis is following and leading axis %3";
    16794 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 axis %3 coupling does not permit referencing";
    16796 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 coupling is not defined";
    16800 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 DC on an axis that is not rotary %3";
    16810 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 ACP on an axis that is not modulo %3";
    16820 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 ACN on an axis that is not modulo %3";
    16830 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 position outside the modulo range %3";
    16912 [DISPLAY] CancelKey "channel %1 action %2 only in the state reset";
    16913 [DISPLAY] CancelKey "channel %2 action %3 only in the state reset";
    16914 [DISPLAY] CancelKey "mode group %1 channel %2 mode change not allowed, action %3";
    16919 [DISPLAY] CancelKey "channel %1 action %2 not allowed while an alarm is pending";
    16920 [DISPLAY] CancelKey "channel %1 action %2 already active";
    16924 [DISPLAY] CancelKey "channel %1 program test: caution, it changes tool data";
    16925 [DISPLAY] CancelKey "channel %1 action %2 not allowed in this mode";
    16930 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 an executable block must stand between";
    16935 [DISPLAY] CancelKey "channel %1 action %2 not possible during a block search with program test";
    16936 [DISPLAY] CancelKey "channel %1 action %2 not possible while the dry run is active";
    16937 [DISPLAY] CancelKey "channel %1 action %2 not possible while a program test is active";
    16938 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 action aborted because a gear change lasts too long";
    16942 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 START in a block search with program test";
    16952 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 START not possible while MDA is active";
    17020 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 first index is not valid";
    17030 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 second index is not valid";
    17040 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 axis index is wrong";
    17070 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value is write-protected";
    17071 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value is read-protected";
    17080 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value is below the lower limit %3";
    17090 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value is above the upper limit %3";
    17095 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 value is not valid";
    17180 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 tool offset number is wrong";
    20080 [DISPLAY] ByItself "channel %1 axis %2 no handwheel for the override";
    20140 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 synchronised action: the command axis %2 cannot move, alarm %3";
    20141 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 synchronised action %3: axis %4 is moved otherwise";
    20143 [DISPLAY] CancelKey "channel %1 synchronised action %3: command axis %4 is under control of the PLC";
    22321 [INTERFACE_SIGNALS DISPLAY] CancelKey "channel %1 axis %2 PRESET not allowed during motion";
}

/// What 14014 and 15310 show instead of a name while no program is selected.
pub(in crate::sinumerik) const NONE_SELECTED: &str = "none selected";

/// PRESET while the axis moves.
pub(in crate::sinumerik) const PRESET_IN_MOTION: AlarmNumber = AlarmNumber(22321);
/// A coupling of an axis that is a synchronous axis of a gantry grouping already.
pub(in crate::sinumerik) const FOLLOWS_ALREADY: AlarmNumber = AlarmNumber(16779);
/// The following axis of a coupling is not in the channel.
pub(in crate::sinumerik) const FOLLOWING_AXIS_MISSING: AlarmNumber = AlarmNumber(16782);
/// The end of a coupling that is not defined.
pub(in crate::sinumerik) const NO_COUPLING: AlarmNumber = AlarmNumber(16796);

/// A block positions an axis that a POSA still moves.
pub(in crate::sinumerik) const STILL_POSITIONED: AlarmNumber = AlarmNumber(10610);
/// The end point of a block is behind a software limit switch.
pub(in crate::sinumerik) const BEHIND_SOFTWARE_LIMIT: AlarmNumber = AlarmNumber(10720);
/// The path of a block leads behind a software limit switch.
pub(in crate::sinumerik) const PATH_BEHIND_LIMIT: AlarmNumber = AlarmNumber(10722);
/// The path of a block leaves the working area.
pub(in crate::sinumerik) const OUTSIDE_WORKING_AREA: AlarmNumber = AlarmNumber(10730);
/// A positioning axis without a velocity.
pub(in crate::sinumerik) const NO_POSITIONING_VELOCITY: AlarmNumber = AlarmNumber(10861);
/// RESET has waited for a gear change as long as MD10192 permits.
pub(in crate::sinumerik) const GEAR_CHANGE_TOO_LONG: AlarmNumber = AlarmNumber(16938);
/// The selected program does not exist.
pub(in crate::sinumerik) const NO_PROGRAM: AlarmNumber = AlarmNumber(14014);
/// The radii at the start and at the end of a circle differ.
pub(in crate::sinumerik) const CIRCLE_END: AlarmNumber = AlarmNumber(14040);
/// The wrong type of axis for what is programmed.
pub(in crate::sinumerik) const WRONG_AXIS_TYPE: AlarmNumber = AlarmNumber(14092);
/// The radius of a circle is too small.
pub(in crate::sinumerik) const CIRCLE_RADIUS: AlarmNumber = AlarmNumber(14095);
/// G74 of a synchronous axis; in REF, a key of one in an open grouping, then without a block.
pub(in crate::sinumerik) const REFERENCING_COUPLED: AlarmNumber = AlarmNumber(16794);
/// More than five M functions in a block, with those that it does not name.
pub(in crate::sinumerik) const TOO_MANY_M_FUNCTIONS: AlarmNumber = AlarmNumber(14769);
/// An action while an alarm is pending.
pub(in crate::sinumerik) const ALARM_PENDING: AlarmNumber = AlarmNumber(16919);
/// An action that is already active.
pub(in crate::sinumerik) const ALREADY_ACTIVE: AlarmNumber = AlarmNumber(16920);

/// A block search is over, and NC start goes on.
pub(in crate::sinumerik) const CONTINUE_AFTER_SEARCH: AlarmNumber = AlarmNumber(10208);
/// Block search, and no program is selected.
pub(in crate::sinumerik) const SEARCH_WITHOUT_PROGRAM: AlarmNumber = AlarmNumber(15310);
/// Block search for a wrong block number.
pub(in crate::sinumerik) const SEARCH_BLOCK_NUMBER: AlarmNumber = AlarmNumber(15330);
/// Block search for a wrong label.
pub(in crate::sinumerik) const SEARCH_LABEL: AlarmNumber = AlarmNumber(15340);
/// The program has ended before the block that a search looks for.
pub(in crate::sinumerik) const SEARCH_NOT_FOUND: AlarmNumber = AlarmNumber(15350);
/// The block that a search without calculation looks for is not in the program.
pub(in crate::sinumerik) const SEARCH_TARGET_MISSING: AlarmNumber = AlarmNumber(15370);
/// An action that is possible only while no program runs or is stopped.
pub(in crate::sinumerik) const ONLY_IN_RESET: AlarmNumber = AlarmNumber(16912);
/// An action in the wrong mode.
pub(in crate::sinumerik) const MODE_NOT_SUITABLE: AlarmNumber = AlarmNumber(16925);
/// An action during a block search with program test.
pub(in crate::sinumerik) const DURING_SERUPRO: AlarmNumber = AlarmNumber(16935);
/// A block search with program test while the dry run is active.
pub(in crate::sinumerik) const NOT_IN_DRY_RUN: AlarmNumber = AlarmNumber(16936);
/// A block search with program test while a program test is active.
pub(in crate::sinumerik) const NOT_IN_PROGRAM_TEST: AlarmNumber = AlarmNumber(16937);
/// The program of INIT does not exist.
pub(in crate::sinumerik) const PROGRAM_MISSING: AlarmNumber = AlarmNumber(14011);
/// A wrong parameter, for example a channel that does not exist.
pub(in crate::sinumerik) const WRONG_PARAMETER: AlarmNumber = AlarmNumber(14020);
/// START in a block search with program test.
pub(in crate::sinumerik) const START_IN_SERUPRO: AlarmNumber = AlarmNumber(16942);
/// START of a channel whose mode group is in MDA.
pub(in crate::sinumerik) const START_IN_MDA: AlarmNumber = AlarmNumber(16952);
/// FD or FDA, and no handwheel is assigned to the axis.
pub(in crate::sinumerik) const NO_HANDWHEEL: AlarmNumber = AlarmNumber(20080);
/// A position beyond all that an axis can have.
pub(in crate::sinumerik) const POSITION_TOO_LARGE: AlarmNumber = AlarmNumber(14088);
/// A position of a modulo axis or of a spindle that is not within 0 to 359.999.
pub(in crate::sinumerik) const OUTSIDE_MODULO_RANGE: AlarmNumber = AlarmNumber(16830);
/// A command axis of a synchronised action that cannot move.
pub(in crate::sinumerik) const COMMAND_AXIS: AlarmNumber = AlarmNumber(20140);
/// A command axis that a PLC program has.
pub(in crate::sinumerik) const COMMAND_AXIS_OF_PLC: AlarmNumber = AlarmNumber(20143);
/// A command axis that the program moves, or that another channel has.
pub(in crate::sinumerik) const COMMAND_AXIS_IN_MOTION: AlarmNumber = AlarmNumber(20141);
/// A change between AUTOMATIC and MDA while a program runs or is stopped.
pub(in crate::sinumerik) const MODE_ONLY_IN_RESET: AlarmNumber = AlarmNumber(16913);
/// REF while a program is interrupted.
pub(in crate::sinumerik) const MODE_NOT_ALLOWED: AlarmNumber = AlarmNumber(16914);
/// A program test begins.
pub(in crate::sinumerik) const PROGRAM_TEST: AlarmNumber = AlarmNumber(16924);

/// A cycle alarm (SETAL) of this number: `%3` and `%4` are its text. Numbers below 62000 and from 63000 to 64999 need RESET, those from 62000 NC
/// start; from 65000 on the program goes on.
pub(in crate::sinumerik) fn of_a_cycle(number: AlarmNumber) -> Option<&'static Alarm> {
    match number.0 {
        60_000..62_000 | 63_000..65_000 => Some(&BY_RESET),
        62_000..63_000 => Some(&BY_NC_START),
        65_000..70_000 => Some(&DISPLAYED),
        _ => None,
    }
}

const TEXT: &str = "channel %1 block %2 %3%4";

static BY_RESET: Alarm = Alarm {
    number: AlarmNumber(61_000),
    text: TEXT,
    reaction: Reaction::INTERPRETER_STOP
        .and(Reaction::START_DISABLED)
        .and(Reaction::INTERFACE_SIGNALS)
        .and(Reaction::DISPLAY),
    cancel: Cancel::Reset,
};

static BY_NC_START: Alarm = Alarm {
    number: AlarmNumber(62_000),
    text: TEXT,
    reaction: Reaction::CORRECTION_BLOCK.and(Reaction::INTERFACE_SIGNALS).and(Reaction::DISPLAY),
    cancel: Cancel::NcStart,
};

static DISPLAYED: Alarm =
    Alarm { number: AlarmNumber(65_000), text: TEXT, reaction: Reaction::DISPLAY, cancel: Cancel::CancelKey };

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nc_program::alarm_numbers;

    #[test]
    fn every_alarm_of_preparation_has_a_row() {
        let missing = alarm_numbers().find(|number| !PROGRAMS.iter().any(|alarm| alarm.number.0 == *number));
        assert_eq!(missing, None);
    }
}
