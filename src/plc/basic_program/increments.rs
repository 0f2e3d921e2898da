//! The increments of a machine control panel (DB11.DBB2), for each panel.

use crate::image::ModeGroupToNck;

/// Requests an increment: 0 to 4 for 1 to 10000, 5 the variable one; without one, continuous travel.
pub(in crate::plc) fn select_increment(group: &mut ModeGroupToNck, increment: Option<u8>) {
    group.set_machine_function_increment_1(increment == Some(0));
    group.set_machine_function_increment_10(increment == Some(1));
    group.set_machine_function_increment_100(increment == Some(2));
    group.set_machine_function_increment_1000(increment == Some(3));
    group.set_machine_function_increment_10000(increment == Some(4));
    group.set_machine_function_increment_variable(increment == Some(5));
    group.set_machine_function_continuous(increment.is_none());
}
