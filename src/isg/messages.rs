//! The messages of the control: numbers of published diagnoses, and names of this project where no source gives a number (O-18).

use crate::variables::AlarmNumber;

use super::lists;

/// A message.
#[derive(Debug)]
pub(super) struct Row {
    pub number: AlarmNumber,
    /// The name without a published number.
    pub name: &'static str,
    /// Reaction class: 1 is a warning.
    pub class: u8,
    pub text: &'static str,
}

/// The first number that stands for a parameter: P-AXIS-00072 is this + 72, P-CHAN-00104 this + 100,000 + 104.
const PARAMETERS: u32 = AlarmNumber::OWN + 1_000_000;

/// The message about a parameter.
pub(super) const fn of_parameter(number: u32) -> AlarmNumber {
    AlarmNumber(PARAMETERS + number)
}

/// Generates constants and the table.
macro_rules! messages {
    ($($constant:ident = $number:expr, $name:literal, $class:literal, $text:literal;)*) => {
        $(#[doc = $text] pub(super) const $constant: AlarmNumber = AlarmNumber($number);)*

        /// All messages but those about parameters, ascending by number.
        pub(super) static ROWS: &[Row] =
            &[$(Row { number: $constant, name: $name, class: $class, text: $text },)*];
    };
}

messages! {
    AXIS_MISSING = 20003, "", 1, "Channel %1 block %2: the G function needs axes: %3";
    DWELL_TWICE = 20013, "", 2, "Channel %1 block %2: dwell time both directly and with an axis";
    MOTION_TWICE = 20108, "", 2, "Channel %1 block %2: more than one G function for the kind of movement: %3";
    ZERO_OFFSET_TWICE = 20116, "", 2, "Channel %1 block %2: more than one G function for zero offsets: %3";
    TRANSITION_TWICE = 20117, "", 2, "Channel %1 block %2: more than one G function for the block transition: %3";
    CENTRE_TWICE = 20127, "", 2, "Channel %1 block %2: more than one G function for the centre of circles: %3";
    HOMING_WITH_GROUP = 20137, "", 2, "Channel %1 block %2: homing is not possible while coupling group %3 is active";
    PERCENT_IN_MAIN_PROGRAM = 20193, "", 2, "Channel %1 block %2: percent sign in the main program";
    CONTROL_DEPTH = 20211, "", 2, "Channel %1 block %2: control blocks are nested too deeply";
    UNEXPECTED_ELSE = 20214, "", 2, "Channel %1 block %2: $ELSE does not match the control block: %3";
    UNEXPECTED_ELSEIF = 20216, "", 2, "Channel %1 block %2: $ELSEIF does not match the control block: %3";
    UNEXPECTED_ENDIF = 20218, "", 2, "Channel %1 block %2: $ENDIF does not match the control block: %3";
    OPEN_AT_END = 20375, "", 1, "Channel %1 block %2: control blocks are open at the end of the program: %3";
    GROUP_0_NUMBER = 20438, "", 1, "Channel %1: the number 0 is no axis; the pair of coupling group 0 is skipped: %4";
    GROUP_0_SELF = 20440, "", 1, "Channel %1: axis %3 is its own master; the pair of coupling group 0 is skipped: %4";
    GROUP_0_TWICE = 20441, "", 1, "Channel %1: axis %3 is a slave twice; the pair of coupling group 0 is skipped: %4";
    GROUP_0_BOTH = 20442, "", 1, "Channel %1: axis %3 is both master and slave; the pair of coupling group 0 is skipped: %4";
    LINK_WITH_COMPENSATION = 20457, "", 2, "Channel %1 block %2: a coupling cannot be switched while tool radius compensation is active";
    GROUP_OUT_OF_RANGE = 20461, "", 2, "Channel %1 block %2: coupling group %3 is out of range";
    SLAVE_IS_MAIN_AXIS = 20467, "", 2, "Channel %1 block %2: slave %3 is a main axis (channel index 0 to 2)";
    TYPES_DIFFER = 20468, "", 2, "Channel %1 block %2: master %4 and slave %3 have different axis types";
    MODES_DIFFER = 20469, "", 2, "Channel %1 block %2: master %4 and slave %3 have different axis modes";
    SLAVE_IN_MANUAL = 20470, "", 2, "Channel %1 block %2: slave %3 is in manual mode G201";
    GROUP_ACTIVE = 20472, "", 2, "Channel %1 block %2: coupling group %3 is active and cannot be defined anew";
    OWN_MASTER = 20475, "", 2, "Channel %1 block %2: axis %3 is its own master, group %4";
    SLAVE_TWICE = 20476, "", 2, "Channel %1 block %2: axis %3 is a slave twice, group %4";
    MASTER_AND_SLAVE = 20477, "", 2, "Channel %1 block %2: axis %3 is both master and slave, group %4";
    DWELL_AXES = 20685, "", 1, "Channel %1 block %2: dwell time with additional axes";
    LABEL_TWICE = 20836, "", 2, "Channel %1 block %2: a label is defined more than once: %3";
    JUMP_TARGET = 20839, "", 2, "Channel %1 block %2: character behind $GOTO not permitted";
    NUMBER_TWICE = 20841, "", 2, "Channel %1 block %2: the block number stands twice: %3";
    SLAVE_IN_CHANNEL = 21020, "", 3, "Channel %1 block %2: %3 is a gantry slave and cannot be an axis of a channel: %4";
    NUMERATOR_0 = 21077, "", 2, "Channel %1 block %2: the numerator of the coupling factor is 0";
    DENOMINATOR_MISSING = 21110, "", 2, "Channel %1 block %2: the denominator of the coupling factor is missing";
    FACTOR_NOT_ONE = 21111, "", 1, "Channel %1 block %2: the coupling factor of axis %3 is neither 1 nor -1; it is set to 1";
    INDEX_TWICE = 21257, "", 2, "Channel %1 block %2: channel index %3 is given twice";
    INDEX_OCCUPIED = 21260, "", 2, "Channel %1 block %2: channel index %3 is occupied";
    ALREADY_SLAVE = 21283, "", 2, "Channel %1 block %2: slave %3 is a slave in the active group %4 already";
    SLAVE_IS_MASTER = 21284, "", 2, "Channel %1 block %2: slave %3 is a master in the active group %4";
    MASTER_IS_SLAVE = 21285, "", 2, "Channel %1 block %2: master %3 is a slave in the active group %4";
    PERCENT_IN_SUBROUTINE = 21313, "", 2, "Channel %1 block %2: percent sign in a global subroutine";
    SLAVE_IS_MAIN_SPINDLE = 21347, "", 2, "Channel %1: the slave of a spindle pair is the main spindle";
    COMPENSATED_WHILE_COUPLED = 21403, "", 2, "Channel %1: the compensation of axis %2 was changed while it is coupled";
    MASTER_INDEPENDENT = 21481, "", 2, "Channel %1: axis %2, the master of an active coupling group, was programmed as independent axis";
    SKIPPED_AT_LOCAL_END = 21500, "", 2, "Channel %1 block %2: skipped control blocks are open at the end of a local subroutine: %3";
    SKIPPED_AT_MAIN_END = 21501, "", 2, "Channel %1 block %2: skipped control blocks are open at the end of the main program: %3";
    SKIPPED_AT_GLOBAL_END = 21502, "", 2, "Channel %1 block %2: skipped control blocks are open at the end of a global subroutine: %3";
    BEHIND_CALL = 21542, "", 2, "Channel %1 block %2: NC commands behind a subroutine call";
    NO_MASTER_BIT = 70124, "", 1, "Slave %1 names axis %2 as its master, which is not configured as one: %3";
    MODULO_DIFFERS = 70202, "", 1, "Modulo settings of slave %1 and master %2 differ: %3";
    HOMING_TRAVEL = 70229, "", 2, "Slave %1 exceeded its homing travel (P-AXIS-00284)";
    LINK_OF_MASTER_CONFLICTS = 70454, "", 7, "An HLI coupling was commanded on slave %1, which takes that of its master";
    NOT_AT_STANDSTILL = 70569, "", 7, "Channel %1 block %2: a gantry combination can be opened and closed only at standstill, axis %3";
    RETRACT_DISTANCE = 70651, "", 1, "Axis %1: the retract distance of homing to a fixed stop is not above P-AXIS-00072";
    MODULO_RANGE = 110_052, "", 1, "Axis %1: modulo range invalid: %3";
    AXIS_MODE = 110_053, "", 1, "Axis %1: axis mode invalid, corrected: %3";
    NUMBER_0 = 110_076, "", 3, "The logical number of an axis list is 0: %3";
    MODULO_TOO_LARGE = 110_308, "", 1, "Axis %1: modulo range too large: %3";
    MASTER_WITH_MASTER = 110_342, "", 3, "Gantry master %1 has an entry for its own master; it is set to 0: %3";
    AXIS_MODE_CORRECTED = 110_353, "", 1, "Axis %1: axis mode invalid, corrected: %3";
    GANTRY_ON_MODE = 110_606, "", 1, "Axis %1: P-AXIS-00704 contradicts P-AXIS-00261: %3";
    STAGE_1 = AlarmNumber::OWN + 1, "gantry-stage-1", 4, "Axis %1: gantry difference above the resettable limit";
    STAGE_2 = AlarmNumber::OWN + 2, "gantry-stage-2", 4, "Axis %1: gantry difference above the limit that no reset clears";
    NOT_CONFIG = AlarmNumber::OWN + 3, "gantry-not-config", 2, "Channel %1 block %2: #GANTRY needs CONFIG (P-AXIS-00704) on every slave of axis %3";
    GANTRY_UNKNOWN = AlarmNumber::OWN + 4, "gantry-unknown", 2, "Channel %1 block %2: axis %3 is no gantry master that this command reaches";
    LINK_UNASSIGNED = AlarmNumber::OWN + 5, "link-unassigned", 2, "Channel %1 block %2: coupling group %3 is not assigned";
    LINK_AXIS_MISSING = AlarmNumber::OWN + 6, "link-axis-missing", 2, "Channel %1 block %2: axis %3 of coupling group %4 is not in the channel";
    LINK_SLAVE_PROGRAMMED = AlarmNumber::OWN + 7, "link-slave-programmed", 2, "Channel %1 block %2: axis %3 is the slave of an active coupling group and cannot be programmed";
    LINK_NOT_ALONE = AlarmNumber::OWN + 8, "link-not-alone", 2, "Channel %1 block %2: this command stands alone in its block";
    LINK_DENOMINATOR = AlarmNumber::OWN + 9, "link-denominator", 2, "Channel %1 block %2: the denominator of the coupling factor is 0";
    AXIS_UNKNOWN = AlarmNumber::OWN + 10, "axis-unknown", 2, "Channel %1 block %2: axis unknown: %3";
    NC_SYNTAX = AlarmNumber::OWN + 11, "nc-syntax", 2, "Channel %1 block %2: syntax error, %3";
    NC_CALL = AlarmNumber::OWN + 12, "nc-call", 2, "Channel %1 block %2: subroutine call: %3";
    NC_VALUE = AlarmNumber::OWN + 13, "nc-value", 2, "Channel %1 block %2: a value is not possible: %3";
    DRIVE_FAULT = AlarmNumber::OWN + 14, "drive-fault", 4, "Axis %1: the drive reports a fault";
    DRIVE_NOT_READY = AlarmNumber::OWN + 15, "drive-not-ready", 4, "Axis %1 is to move without its releases";
    LINK_NOT_RESTORED = AlarmNumber::OWN + 16, "P-CHAN-00104", 2, "Channel %1 block %2: coupling group %3 has axes outside the configuration of the channel and is not restored";
    LINK_NOT_KEPT = AlarmNumber::OWN + 17, "P-CHAN-00105", 2, "Channel %1 block %2: coupling group %3 has axes outside the configuration of the channel and is not switched on again";
}

/// The row of a message.
pub(super) fn row(number: AlarmNumber) -> Option<&'static Row> {
    ROWS.binary_search_by_key(&number, |row| row.number).ok().map(|index| &ROWS[index])
}

/// Whether a message is only a warning: it stops nothing.
pub(super) fn is_warning(number: AlarmNumber) -> bool {
    row(number).is_some_and(|row| row.class == 1)
}

/// The name of a message: its number, or its own name.
pub(super) fn name(number: AlarmNumber) -> String {
    match row(number) {
        Some(row) if row.name.is_empty() => row.number.0.to_string(),
        Some(row) => row.name.to_owned(),
        None => {
            let parameter = number.0.checked_sub(PARAMETERS).and_then(lists::by_number);
            parameter.map_or_else(|| number.0.to_string(), lists::Parameter::id)
        }
    }
}

/// The number of a message with only a name.
pub(super) fn named(name: &str) -> Option<AlarmNumber> {
    let own = ROWS.iter().find(|row| row.name == name && !row.name.is_empty()).map(|row| row.number);
    own.or_else(|| lists::parameter(name).map(|(parameter, _)| of_parameter(parameter.number())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_of_the_language_has_a_row() {
        for (number, meaning) in crate::isg::language::NUMBERS {
            assert!(row(AlarmNumber(number)).is_some(), "{number}: {meaning}");
        }
    }
}
