//! Alarms: meaning, reactions, cancelling, and the list of pending alarms.
//!
//! Numbers, reactions and cancel classes follow the Diagnostics Manual. An alarm is raised in the stage "monitoring and alarms". Its bits
//! are published in the same cycle; its reactions act from the next cycle on. To add an alarm, add a row to [`alarms!`] and a call of
//! [`Pending::raise`](pending::Pending::raise).

pub(super) mod axis_exchange;
mod ended;
mod find;
pub(super) mod not_raised;
pub(super) mod pending;
pub(super) mod programs;
mod raised;

use std::fmt;

use crate::variables::AlarmNumber;

/// The reactions of an alarm, as flags, with the names of the Diagnostics Manual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reaction(u16);

impl Reaction {
    /// No reaction except the entry in the alarm list.
    pub const NONE: Self = Self(0);
    /// NC not ready: DB10.DBX108.7 = 0, all axes stop.
    pub const NC_NOT_READY: Self = Self(1);
    /// Mode group not ready: DB11.DBX6.3 = 0.
    pub const MODE_GROUP_NOT_READY: Self = Self(1 << 1);
    /// Channel not ready: DB21.DBX36.5 = 0.
    pub const CHANNEL_NOT_READY: Self = Self(1 << 2);
    /// NC start disabled in this channel.
    pub const START_DISABLED: Self = Self(1 << 3);
    /// The NC switches the axis to follow-up.
    pub const FOLLOW_UP: Self = Self(1 << 4);
    /// Alarm interface signals are set: DB10.DBX109.0, DB21.DBX36.6, DB31.DBX61.1.
    pub const INTERFACE_SIGNALS: Self = Self(1 << 5);
    /// The alarm is displayed.
    pub const DISPLAY: Self = Self(1 << 6);
    /// NC stop with the alarm: DB21.DBX36.7 = 1.
    pub const STOP: Self = Self(1 << 7);
    /// Only the affected axis stops.
    pub const LOCAL: Self = Self(1 << 8);

    /// Mode group not ready, also for single axes that the PLC or a command moves.
    pub const MODE_GROUP_AND_AXES_NOT_READY: Self = Self(1 << 1 | 1 << 9);
    /// Axes must be referenced again.
    pub const REFERENCE_AGAIN: Self = Self(1 << 10);
    /// NC stop at the end of the block.
    pub const STOP_AT_BLOCK_END: Self = Self(1 << 11);
    /// The block can be corrected.
    pub const CORRECTION_BLOCK: Self = Self(1 << 12);
    /// The interpreter stops.
    pub const INTERPRETER_STOP: Self = Self(1 << 13);
    /// Delayed reactions act at once.
    pub const NO_DELAY: Self = Self(1 << 14);

    /// Whether all of these reactions are set.
    #[must_use]
    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    pub(super) const fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

/// The action that clears an alarm. A stronger action also clears the alarms of the weaker ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cancel {
    /// The alarm clears when its cause is gone.
    ByItself,
    /// The alarm-cancel key, or NC start.
    CancelKey,
    /// NC start, or RESET.
    NcStart,
    /// RESET in the channel.
    Reset,
    /// RESET in all channels of the mode group.
    ModeGroupReset,
    /// Power off and on.
    PowerOn,
}

/// The operator's words: `RESET`, `alarm cancel`.
impl fmt::Display for Cancel {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::ByItself => "itself",
            Self::CancelKey => "alarm cancel",
            Self::NcStart => "NC start",
            Self::Reset => "RESET",
            Self::ModeGroupReset => "mode group RESET",
            Self::PowerOn => "POWER ON",
        })
    }
}

/// The reactions in words, in the order of the Diagnostics Manual.
impl fmt::Display for Reaction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words = [
            (Self::NC_NOT_READY, "NC not ready"),
            (Self::MODE_GROUP_NOT_READY, "mode group not ready"),
            (Self::CHANNEL_NOT_READY, "channel not ready"),
            (Self::START_DISABLED, "NC start disabled"),
            (Self::FOLLOW_UP, "follow-up"),
            (Self::REFERENCE_AGAIN, "reference again"),
            (Self::CORRECTION_BLOCK, "correction block"),
            (Self::INTERPRETER_STOP, "interpreter stop"),
            (Self::INTERFACE_SIGNALS, "interface signals"),
            (Self::DISPLAY, "shown"),
            (Self::STOP, "NC stop"),
            (Self::STOP_AT_BLOCK_END, "NC stop at block end"),
            (Self::LOCAL, "local"),
            (Self::NO_DELAY, "without delay"),
        ];
        let words: Vec<_> = words.iter().filter(|(flag, _)| self.has(*flag)).map(|(_, word)| *word).collect();
        f.pad(&words.join(", "))
    }
}

/// A row of the alarm list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Alarm {
    /// Its number, or our own number above [`AlarmNumber::OWN`].
    pub number: AlarmNumber,
    /// Its text with `%1` to `%4`.
    pub text: &'static str,
    /// Its reactions.
    pub reaction: Reaction,
    /// The action that clears it.
    pub cancel: Cancel,
}

/// Makes a constant and a catalogue entry of each row, `NAME number [REACTIONS] Cancel "text";`. Rows without names give a list without
/// constants.
macro_rules! alarms {
    ($(#[$about:meta])* $catalogue:ident: $($(#[$doc:meta])* $constant:ident $number:literal
        [$($reaction:ident)*] $cancel:ident $text:literal;)*) => {
        $($(#[$doc])* pub(in crate::sinumerik) const $constant: AlarmNumber = AlarmNumber($number);)*

        alarms! { $(#[$about])* $catalogue; $($number [$($reaction)*] $cancel $text;)* }
    };
    ($(#[$about:meta])* $catalogue:ident; $($number:literal [$($reaction:ident)*] $cancel:ident $text:literal;)*) => {
        $(#[$about])*
        pub const $catalogue: &[$crate::sinumerik::Alarm] = &[$($crate::sinumerik::Alarm {
            number: AlarmNumber($number),
            text: $text,
            reaction: Reaction::NONE$(.and(Reaction::$reaction))*,
            cancel: Cancel::$cancel,
        }),*];

        const _: () = assert!(
            $crate::sinumerik::alarms::ascends($catalogue),
            "alarms must ascend by number: put the row at its place, each number once"
        );
    };
}
pub(super) use alarms;

/// Whether the numbers ascend, so that [`Alarm::find`] finds each of them.
const fn ascends(alarms: &[Alarm]) -> bool {
    let mut index = 1;
    while index < alarms.len() {
        if alarms[index - 1].number.0 >= alarms[index].number.0 {
            return false;
        }
        index += 1;
    }
    true
}

alarms! {
    /// All alarms that the model can raise, ascending by number.
    CATALOGUE:
    /// The PLC program was stopped or failed.
    PLC_SIGN_OF_LIFE 2000
        [NC_NOT_READY LOCAL CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "sign-of-life monitoring: the PLC program does not run";
    /// Emergency stop. It clears with its acknowledgement together with mode group RESET.
    EMERGENCY_STOP 3000
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP NO_DELAY] ModeGroupReset
        "emergency stop";
    /// MD20070 of a channel has a gap, and MD11640 does not allow it. %2: the machine datum; %3: the index of the first gap.
    CHANNEL_AXIS_GAP 4000
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 machine datum %2[%3] has a gap in the axis assignment";
    /// MD20070 of several channels names an axis, and MD30550 names none of them as its master.
    AXIS_IN_SEVERAL_CHANNELS 4001
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 axis %2 defined for more than one channel";
    /// MD10240, MD10250 or MD30300 was changed and became active by power on.
    SCALING_CHANGED 4070 [DISPLAY] CancelKey
        "scaling machine datum changed";
    /// MD10070 is not a multiple of MD10060: the next multiple acts. %1: the cycle in milliseconds.
    CYCLE_CHANGED 4110 [DISPLAY] Reset
        "interpolation cycle changed to %1 ms";
    /// MD30450 on a synchronous axis of a closed grouping: the value is ignored, and the value of the leading axis applies. %1: the machine
    /// datum.
    DECLARATION_NOT_ALLOWED 4300 [DISPLAY] Reset
        "axis %2 machine datum %1: declaration not allowed";
    /// NC start in AUTOMATIC or MDI while an axis that needs its reference point is not referenced (MD20700).
    START_WITHOUT_REFERENCE 10203 [INTERFACE_SIGNALS DISPLAY] NcStart
        "channel %1 NC start without reference point";
    /// A movement has to stop before a software limit switch: by 12.2, 12.3, an offset of a handwheel or a machine datum that came after the
    /// preparation of its block, or as a movement to a target. %3: the block, %4: + or −.
    REACHES_SOFTWARE_LIMIT 10620 [LOCAL START_DISABLED INTERFACE_SIGNALS DISPLAY STOP_AT_BLOCK_END] Reset
        "channel %1 block %3 axis %2 reaches software limit switch %4";
    /// JOG: the axis rests on a software limit switch. %3: + or −.
    ON_SOFTWARE_LIMIT 10621 [DISPLAY] ByItself
        "channel %1 axis %2 rests on software limit switch %3";
    /// A movement has to stop before the limit of the working area. %2: the block, %4: + or −.
    REACHES_WORKING_AREA 10630 [LOCAL START_DISABLED INTERFACE_SIGNALS DISPLAY STOP_AT_BLOCK_END] Reset
        "channel %1 block %2 axis %3 reaches working area limit %4";
    /// JOG: the axis rests on the limit of its working area. %3: + or −.
    ON_WORKING_AREA 10631 [DISPLAY] ByItself
        "channel %1 axis %2 rests on working area limit %3";
    /// Wrong gantry machine data. Code 1: wrong grouping number or designation; 2: leading axis declared more than once.
    GANTRY_MACHINE_DATA 10650
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 axis %2 wrong gantry machine data, error code %3";
    /// Illegal gantry configuration, reason and grouping in one number.
    GANTRY_CONFIGURATION 10651
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 illegal gantry configuration, reason %2";
    /// Warning limit exceeded.
    GANTRY_WARNING_LIMIT 10652 [DISPLAY] ByItself
        "channel %1 axis %2 gantry warning limit exceeded";
    /// Trip limit exceeded. The axes brake in position control and stay in position control.
    GANTRY_TRIP_LIMIT 10653 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 gantry error limit exceeded";
    /// Waiting for synchronisation start.
    GANTRY_WAITING 10654 [DISPLAY] ByItself
        "channel %1 waiting for synchronization start of gantry grouping %2";
    /// Synchronisation running.
    GANTRY_SYNCHRONISING 10655 [DISPLAY] ByItself
        "channel %1 synchronization of gantry grouping %2 running";
    /// The leading axis demands more than MD32000 or MD32300 of the synchronous axis.
    GANTRY_OVERLOADED 10656
        [MODE_GROUP_NOT_READY LOCAL CHANNEL_NOT_READY INTERFACE_SIGNALS DISPLAY] ModeGroupReset
        "channel %1 axis %2 gantry synchronized axis dynamically overloaded";
    /// Power was switched off after a trip in extended monitoring (MD37150 bit 0), and MD37135 still shows the difference.
    GANTRY_SWITCHED_OFF 10657 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 switched off while the gantry error limit was exceeded";
    /// The grouping cannot be closed. %3: the thousands digit gives the reason (7: motion pending), the last two digits the grouping.
    IMPERMISSIBLE_AXIS_STATE 10658 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP LOCAL] Reset
        "channel %1 axis %2 impermissible axis state %3";
    /// Reference cam not reached within MD34030.
    CAM_NOT_REACHED 20000 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference cam not reached";
    /// At standstill after phase 1 and not on the cam.
    CAM_SIGNAL_MISSING 20001 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 cam signal missing";
    /// No zero mark within MD34060.
    REFERENCE_MARK_NOT_FOUND 20002 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 zero reference mark not found";
    /// Distance-coded: the distance of two marks is above 2 × MD34300, also on a second attempt in the other direction.
    MEASURING_SYSTEM_ERROR 20003 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 measuring system error";
    /// Distance-coded: no two marks within MD34060.
    REFERENCE_MARK_MISSING 20004 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference mark missing";
    /// Approach aborted.
    APPROACH_ABORTED 20005 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference point approach aborted";
    /// Creep velocity not reached at the cam edge, twice.
    CREEP_VELOCITY_NOT_REACHED 20006 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 reference point creep velocity not reached";
    /// A traversing key is pressed while handwheels move the axis.
    HANDWHEEL_ACTIVE 20050 [DISPLAY] ByItself
        "channel %1 axis %2 handwheel active";
    /// Handwheels are turned while the axis is moved by another function.
    HANDWHEEL_NOT_POSSIBLE 20051 [DISPLAY] ByItself
        "channel %1 axis %2 handwheel not possible";
    /// A handwheel is turned for a DRF offset while its axis is referenced: the pulses are lost.
    DRF_NOT_POSSIBLE 20053 [DISPLAY] CancelKey
        "channel %1 axis %2 DRF, FTOCON, external work offset not possible";
    /// More than 5 tables of sag compensation have the same output axis; none of them is evaluated. %1: the axis.
    SAG_TOO_MANY_TABLES 20120 [INTERFACE_SIGNALS DISPLAY] Reset
        "axis %1 too many compensation relations";
    /// A table of sag compensation with MAX below MIN or STEP of 0; it is not evaluated. %2: the table.
    SAG_TABLE_WRONG 20121 [INTERFACE_SIGNALS DISPLAY] Reset
        "axis %1 configuration error in compensation table %2";
    /// A table of sag compensation without input or output axis; it is not evaluated. %1: the table.
    SAG_AXES_MISSING 20122 [INTERFACE_SIGNALS DISPLAY] Reset
        "compensation table %1 axis assignment not valid";
    /// The tables of a product have different output axes; the product is not evaluated. %2: the table.
    SAG_PRODUCT 20123 [INTERFACE_SIGNALS DISPLAY] Reset
        "axis %1 different output axes of the multiplied compensation table %2";
    /// The sag compensation value is limited to MD32720.
    SAG_LIMITED 20124 [INTERFACE_SIGNALS DISPLAY] Reset
        "axis %1 sum of compensation values too high: limited";
    /// The change of the sag compensation value is limited to MD32730 and made up later.
    SAG_TOO_FAST 20125 [INTERFACE_SIGNALS DISPLAY] ByItself
        "axis %1 compensation value changes too fast: limited";
    /// MD36300 exceeded on the active encoder. %3: encoder.
    ENCODER_FREQUENCY 21610
        [MODE_GROUP_NOT_READY CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "channel %1 axis %2 encoder %3 frequency exceeded";
    /// Enable reset during motion. Cause 1: servo enable; 2: pulse enable; 3: pulses enabled; 4: drive ready.
    ENABLE_RESET 21612 [FOLLOW_UP START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] CancelKey
        "channel %1 axis %2 enable reset during motion, cause %3";
    /// The measuring system was switched over.
    SWITCH_OVER 21613 [DISPLAY] ByItself
        "axis %1 encoder switchover";
    /// Hardware limit switch. %3: + or −.
    HARDWARE_LIMIT_SWITCH 21614 [START_DISABLED DISPLAY] Reset
        "channel %1 axis %2 hardware limit switch %3";
    /// The drive lost its power during motion.
    FOLLOW_UP_IN_MOTION 21615 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 axis %2 taken from motion into follow-up";
    /// The PLC reports another gear stage than the wanted one.
    GEAR_STAGE_DIFFERS 22010 [DISPLAY] CancelKey
        "channel %1 spindle %2 actual gear stage is not the wanted one";
    /// SPOS of a spindle without an active encoder.
    SPINDLE_WITHOUT_POSITION_CONTROL 22050 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 spindle %2 no change from speed control to position control";
    /// No zero mark in the search of a spindle.
    SPINDLE_MARK_MISSING 22051 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "channel %1 spindle %2 reference mark not found";
    /// The chuck speed (MD35100 and 10 %) is exceeded.
    CHUCK_SPEED 22100
        [MODE_GROUP_NOT_READY CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "channel %1 spindle %2 chuck speed exceeded";
    /// No signal from the active encoder, or its cable is disconnected.
    ACTIVE_ENCODER_FAULT 25000
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP REFERENCE_AGAIN] PowerOn
        "axis %1 hardware fault of the active encoder";
    /// No signal from the passive encoder.
    PASSIVE_ENCODER_FAULT 25001 [DISPLAY] Reset
        "axis %1 hardware fault of the passive encoder";
    /// As 25000, with MD36310 above 100.
    ACTIVE_ENCODER_POLLUTION 25010
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP REFERENCE_AGAIN] ModeGroupReset
        "axis %1 pollution of the active measuring system";
    /// As 25001, with MD36310 above 100.
    PASSIVE_ENCODER_POLLUTION 25011 [DISPLAY] CancelKey
        "axis %1 pollution of the passive measuring system";
    /// A zero mark of the active encoder is not at the expected count (MD36310).
    ACTIVE_ZERO_MARK 25020
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP REFERENCE_AGAIN] ModeGroupReset
        "axis %1 zero mark monitoring of the active encoder";
    /// As 25020, for the passive encoder.
    PASSIVE_ZERO_MARK 25021 [DISPLAY] CancelKey
        "axis %1 zero mark monitoring of the passive encoder";
    /// %3 = 0: the absolute encoder is not adjusted.
    ENCODER_WARNING 25022 [DISPLAY] CancelKey
        "axis %1 encoder %2 warning %3";
    /// MD36200 exceeded.
    ACTUAL_VELOCITY 25030
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 actual velocity alarm limit";
    /// MD36030 exceeded at rest.
    STANDSTILL 25040
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 standstill monitoring";
    /// MD36400 exceeded.
    CONTOUR 25050
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 contour monitoring";
    /// MD36210 exceeded for longer than MD36220.
    SPEED_SETPOINT 25060
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 speed setpoint limitation";
    /// Exact stop fine not reached within MD36020.
    POSITIONING 25080
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 positioning monitoring";
    /// The encoders differ by more than MD36500, or the other encoder has no signal.
    SWITCH_OVER_IMPOSSIBLE 25100 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "axis %1 encoder switchover not possible";
    /// MD36510 exceeded.
    ENCODERS_DIFFER 25105
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 measuring systems differ";
    /// 1.6 selects an encoder that the axis does not have.
    ENCODER_NOT_AVAILABLE 25110 [DISPLAY] CancelKey
        "axis %1 selected encoder not available";
    /// The interface requests a parameter set that does not exist.
    PARAMETER_SET_INVALID 25200 [START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "axis %1 requested parameter set invalid";
    /// The drive reports a fault.
    DRIVE_FAULT 25201
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 drive fault";
    /// The drive does not start up.
    WAITING_FOR_DRIVE 25202 [INTERFACE_SIGNALS DISPLAY] ByItself
        "axis %1 waiting for drive";
    /// MD36050 exceeded while 2.3 = 1.
    CLAMPING 26000
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 clamping monitoring";
    /// A movement is to start, and the machine datum of 0 that a control accepted makes it impossible (O-30).
    DATUM_NOT_ALLOWED 26016
        [NC_NOT_READY FOLLOW_UP MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] ModeGroupReset
        "axis %1 machine datum %2 value not allowed";
    /// MD30240 = 4, and the encoder has no absolute position. %2: encoder; %3: bits as of 25022.
    ENCODER_INITIALISATION 26020
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP REFERENCE_AGAIN] PowerOn
        "axis %1 encoder %2 hardware fault %3 at encoder initialisation";
    /// Data of gear or encoder, or the serial number, of an adjusted absolute encoder were changed.
    ABSOLUTE_POSITION_LOST 26030
        [MODE_GROUP_NOT_READY FOLLOW_UP CHANNEL_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP REFERENCE_AGAIN] ModeGroupReset
        "axis %1 encoder %2 absolute position lost";
    /// The parameter set has another load gear, and the axis is in position control with an encoder behind that gear. %2, %3: 1 to 6.
    PARAMETER_SET_NOT_POSSIBLE 26050 [FOLLOW_UP LOCAL START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] Reset
        "axis %1 parameter set change from %2 to %3 not possible";
    /// Linear and rotary axes in one grouping. The manuals give no number (O-18).
    GANTRY_MIXED_AXIS_TYPES 1_000_000
        [NC_NOT_READY MODE_GROUP_AND_AXES_NOT_READY START_DISABLED INTERFACE_SIGNALS DISPLAY STOP] PowerOn
        "channel %1 axis %2 gantry grouping %3 mixes linear and rotary axes";
    /// Data that must be equal within a grouping differ at power on (DYN-03). The manuals give no number (O-18).
    GANTRY_UNEQUAL_DATA 1_000_001 [DISPLAY] Reset
        "channel %1 axis %2 machine datum %3 differs from that of the leading axis of gantry grouping %4";
    /// More alarms are pending than the list takes; the further ones are not shown and have no effect (C-28). %1: the first of them.
    ALARM_LIST_FULL 1_000_002 [DISPLAY] CancelKey
        "the alarm list is full: alarm %1 and further ones are not shown";
    /// A block moves an axis that its channel does not have, and MD30552 = 0 forbids the automatic GET. The manuals give no number (O-18).
    AXIS_NOT_IN_CHANNEL 1_000_003 [CORRECTION_BLOCK INTERFACE_SIGNALS DISPLAY] NcStart
        "channel %1 block %2 axis %3 is not a channel axis, and MD30552 = 0 forbids the automatic GET";
    /// NC start in JOG, and the function generator has a signal for a synchronous axis (MIS-09). The manuals give no number (O-18).
    GENERATOR_SYNCHRONOUS_AXIS 1_000_004 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 function generator: not possible for a synchronous axis, name its leading axis";
    /// NC start in JOG, and the axis of the function generator moves or is not in position control. The manuals give no number (O-18).
    GENERATOR_NOT_POSSIBLE 1_000_005 [INTERFACE_SIGNALS DISPLAY] CancelKey
        "channel %1 axis %2 function generator: the axis moves, or cannot move";
}

/// The names of the alarms for which no source gives a number (O-18), in the order of our own numbers.
const OWN_NAMES: &[&str] = &[
    "gantry-mixed-axis-types",
    "gantry-unequal-data",
    "alarm-list-full",
    "axis-not-a-channel-axis",
    "function-generator-synchronous-axis",
    "function-generator-not-possible",
];

impl Alarm {
    /// The name of an alarm: its number, or our own name if no source gives a number.
    #[must_use]
    pub fn name(number: AlarmNumber) -> String {
        let own = number.0.checked_sub(AlarmNumber::OWN).and_then(|index| OWN_NAMES.get(index as usize));
        own.map_or_else(|| number.0.to_string(), |name| (*name).to_owned())
    }

    /// The number of an alarm with our own name.
    #[must_use]
    pub fn named(name: &str) -> Option<AlarmNumber> {
        let index = OWN_NAMES.iter().position(|known| *known == name)?;
        u32::try_from(index).ok().map(|index| AlarmNumber(AlarmNumber::OWN + index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_catalogue_ascends_so_that_a_number_is_found() {
        let [first, second] = [CATALOGUE[0], CATALOGUE[1]];
        assert!(ascends(&[first, second]) && !ascends(&[second, first]) && !ascends(&[first, first]));
        assert!(Alarm::raised().all(|alarm| Alarm::find(alarm.number) == Some(alarm)));
        assert_eq!(Alarm::find(GANTRY_WAITING).map(|alarm| alarm.cancel), Some(Cancel::ByItself));
        assert_eq!(Alarm::find(AlarmNumber(1)), None);
    }

    #[test]
    fn an_alarm_is_raised_or_not_yet_and_never_both() {
        assert!(not_raised::NOT_RAISED.iter().all(|alarm| Alarm::find(alarm.number).is_none()));
        assert_eq!(Alarm::named("gantry-mixed-axis-types"), Some(GANTRY_MIXED_AXIS_TYPES));
        assert_eq!(Alarm::name(GANTRY_MIXED_AXIS_TYPES), "gantry-mixed-axis-types");
    }
}
