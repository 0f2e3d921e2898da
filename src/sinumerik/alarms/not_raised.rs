//! Alarms of the Diagnostics Manual that the model cannot raise yet. They are listed so that users can look up their numbers. A row moves
//! to `alarms/mod.rs` when the model raises it.
//!
//! | numbers | not modelled |
//! |---|---|
//! | 2001, 2900, 4002, 4004, 4005, 4011, 4040, 4060, 4075, 4111, 4112, 4113, 4200, 4210, 26014, 26015, 26017, 26024, 26025 | alarms of machine data: the model checks them before the control starts and reports them there |
//! | 10721, 10723, 16xxx, 17630 to 17900 | limits in motion, actions of the operator |
//! | 17050, 17181 | values beyond the range of a variable that no other alarm names, tool management |
//! | 20007, 20008, 22062, 22064 | MD34200 = 6 and 7 |
//! | 20052, 20060, 20062 | geometry axes |
//! | 20054, 20056, 20058 | indexing axes and revolutional feed |
//! | 20059 | AUTOMATIC with JOG at the same time (MD10735) |
//! | 21550 | couplings other than gantry groupings, which would retract an axis from its limit switch |
//! | 21620 | the emergency braking ramp of a drive that stops on its own |
//! | 22060 | a movement that a program, not a key, requests while the axis is not in position control |
//! | 25042 | limits of torque or force |
//! | 25070 | drift compensation |
//! | 26006, 26100, 26101, 26105, 26106 | drives and encoders on a bus: those of the plant are always found and always have the correct type |

use crate::sinumerik::alarms::{Cancel, Reaction, alarms};
use crate::variables::AlarmNumber;

alarms! {
    /// The alarms that the model cannot raise yet, ascending by number.
    NOT_RAISED;
    2001 [NC_NOT_READY LOCAL CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "PLC has not started up";
    2900 [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY STOP NO_DELAY] PowerOn "reboot is delayed";
    4002 [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 axis %2 not defined in the channel";
    4004 [MODE_GROUP_NOT_READY CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 geometry axis %2 defined more than once";
    4005 [NC_NOT_READY CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 more axes than allowed";
    4011 [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 machine datum invalid";
    4040 [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 axis identifier %2 not consistent with machine datum";
    4060 [DISPLAY] Reset "default machine data loaded";
    4075 [DISPLAY] CancelKey "machine datum %1 not changed, access level %2 missing";
    4111 [DISPLAY] Reset "PLC cycle changed to %1 ms";
    4112 [DISPLAY] Reset "position control cycle changed to %1 ms";
    4113 [DISPLAY] Reset "system clock cycle changed to %1 ms";
    4200 [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 geometry axis %2 must not be a rotary axis";
    4210 [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "channel %1 spindle %2: declaration as rotary axis is missing";
    10721 [LOCAL INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %3 axis %2 programmed end point is behind software limit switch %4";
    10723 [LOCAL INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %5 axis %2 software limit switch violated, residual distance %3 %4";
    16755 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 stop not necessary";
    16772 [DISPLAY] ByItself "channel %1 block %2 axis %3 is a following axis, the coupling is opened";
    16903 [DISPLAY] CancelKey "channel %1 action %2 not allowed in the present state of the channel";
    16904 [DISPLAY] CancelKey "channel %1 action %2 not allowed in the present state";
    16905 [DISPLAY] CancelKey "channel %1 action %2 not allowed";
    16906 [DISPLAY] CancelKey "channel %1 action %2 aborted by an alarm";
    16907 [DISPLAY] CancelKey "channel %1 action %2 only possible in stop";
    16908 [DISPLAY] CancelKey "channel %1 action %2 only possible in reset or at the block end";
    16927 [DISPLAY] CancelKey "channel %1 action %2 not allowed while an interrupt is handled";
    16928 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 interrupt handling: action %2 not possible";
    16933 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 interrupt handling: action %2 not allowed in the present state";
    17050 [INTERPRETER_STOP START_DISABLED INTERFACE_SIGNALS DISPLAY] Reset "channel %1 block %2 value too large for the variable";
    17181 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 T number %3, D number %4 does not exist";
    17630 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 axis %3 reference point approach not possible";
    17650 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart "channel %1 block %2 machine axis %3 not programmable";
    17810 [INTERFACE_SIGNALS DISPLAY] CancelKey "channel %1 axis %2 not referenced";
    17900 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 block %2 axis %4 is not a machine axis";
    20007 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 axis %2 reference point approach needs two measuring systems";
    20008 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 axis %2 reference point approach needs a second, referenced measuring system";
    20052 [DISPLAY] CancelKey "channel %1 axis %2 already active";
    20054 [DISPLAY] CancelKey "channel %1 axis %2 indexing index not allowed";
    20056 [DISPLAY] ByItself "channel %1 axis %2 no revolutional feedrate possible";
    20058 [DISPLAY] ByItself "channel %1 axis %2 revolutional feedrate: illegal source";
    20059 [DISPLAY] CancelKey "channel %1 axis %2 already active, cause %3";
    20060 [DISPLAY] CancelKey "channel %1 axis %2 cannot be moved as a geometry axis";
    20062 [DISPLAY] CancelKey "channel %1 axis %2 already active as geometry axis";
    21550 [START_DISABLED DISPLAY] Reset "channel %1 axis %2 motion off the hardware limit switch not possible, cause %3";
    21620 [START_DISABLED LOCAL FOLLOW_UP INTERFACE_SIGNALS DISPLAY] Reset "channel %1 axis %2 emergency braking ramp active";
    22060 [DISPLAY] ByItself "channel %1 axis %2 position control expected";
    22062 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 axis %2 zero mark search velocity not reached";
    22064 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset "channel %1 axis %2 zero mark search velocity too high";
    25042 [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset "axis %1 standstill monitoring with torque or force limiting";
    25070 [DISPLAY] CancelKey "axis %1 drift value too large";
    26006 [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "axis %1 encoder %2 encoder or output type %3 not possible";
    26014 [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "axis %1 machine datum %2 value not allowed";
    26015 [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "axis %1 machine datum %2[%3] value not allowed";
    26017 [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset "axis %1 machine datum %2[%3] value not allowed";
    26024 [DISPLAY] Reset "axis %1 machine datum %2 value was changed";
    26025 [DISPLAY] Reset "axis %1 machine datum %2[%3] value was changed";
    26100 [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "axis %1 drive %2 sign of life missing";
    26101 [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED REFERENCE_AGAIN INTERFACE_SIGNALS DISPLAY STOP] Reset "axis %1 drive %2 communication failure";
    26105 [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "drive of axis %1 not found";
    26106 [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn "encoder %2 of axis %1 not found";
}

#[cfg(test)]
mod tests {
    use super::NOT_RAISED;

    /// `4xxx but 4300`, `26014`, `2001`.
    fn covers(numbers: &str, number: &str) -> bool {
        let (numbers, but) = numbers.split_once(" but ").unwrap_or((numbers, ""));
        let (first, last) = numbers.split_once(" to ").unwrap_or((numbers, numbers));
        let within = |end: &str, bound: char| end.replace('x', &bound.to_string()).parse::<u32>().unwrap();
        number != but && (within(first, '0')..=within(last, '9')).contains(&number.parse().unwrap())
    }

    #[test]
    fn the_table_gives_a_reason_for_every_alarm_and_for_no_other() {
        let rows = include_str!("not_raised.rs").lines().filter_map(|line| line.strip_prefix("//! | "));
        let listed: Vec<_> = rows.skip(1).flat_map(|row| row.split(" | ").next().unwrap().split(", ")).collect();
        for alarm in NOT_RAISED {
            let number = alarm.number.0.to_string();
            let rows = listed.iter().filter(|numbers| covers(numbers, &number)).count();
            assert_eq!(rows, 1, "alarm {number}");
        }
        for numbers in listed {
            assert!(NOT_RAISED.iter().any(|alarm| covers(numbers, &alarm.number.0.to_string())), "{numbers}");
        }
    }
}
