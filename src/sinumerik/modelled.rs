//! Which signals of the catalogue have an effect in this model: the control writes or reads them.
//!
//! What it writes follows from the rows of publication. What it reads is the list here; a test compares it with the sources.

use crate::image::{Signal, Writer};
use crate::image::{axis_to_nck, channel_to_nck, mode_group_to_nck, nck_hmi, nck_to_nck};
use crate::sinumerik::publish::known::has_row;

/// The signals of the PLC and the HMI that a stage reads.
const READ: &[Signal] = &[
    nck_to_nck::emergency_stop,
    nck_to_nck::acknowledge_emergency_stop,
    nck_to_nck::increment_inputs_active_in_mode_group_area,
    nck_hmi::handwheel_1_axis_number,
    nck_hmi::handwheel_1_selected,
    nck_hmi::handwheel_1_machine_axis,
    nck_hmi::handwheel_2_axis_number,
    nck_hmi::handwheel_2_selected,
    nck_hmi::handwheel_2_machine_axis,
    nck_hmi::handwheel_3_axis_number,
    nck_hmi::handwheel_3_selected,
    nck_hmi::handwheel_3_machine_axis,
    mode_group_to_nck::mode_automatic,
    mode_group_to_nck::mode_mdi,
    mode_group_to_nck::mode_jog,
    mode_group_to_nck::mode_change_inhibit,
    mode_group_to_nck::mode_group_reset,
    mode_group_to_nck::machine_function_teach_in,
    mode_group_to_nck::machine_function_repos,
    mode_group_to_nck::machine_function_ref,
    mode_group_to_nck::machine_function_increment_1,
    mode_group_to_nck::machine_function_increment_10,
    mode_group_to_nck::machine_function_increment_100,
    mode_group_to_nck::machine_function_increment_1000,
    mode_group_to_nck::machine_function_increment_10000,
    mode_group_to_nck::machine_function_increment_variable,
    mode_group_to_nck::machine_function_continuous,
    channel_to_nck::activate_referencing,
    channel_to_nck::feed_override,
    channel_to_nck::rapid_traverse_override,
    channel_to_nck::feed_disable,
    channel_to_nck::rapid_traverse_override_active,
    channel_to_nck::feed_override_active,
    channel_to_nck::nc_start_disable,
    channel_to_nck::nc_start,
    channel_to_nck::channel_reset,
    axis_to_nck::feed_override,
    axis_to_nck::axis_spindle_disable,
    axis_to_nck::follow_up_mode,
    axis_to_nck::position_measuring_system_1,
    axis_to_nck::position_measuring_system_2,
    axis_to_nck::override_active,
    axis_to_nck::controller_enable,
    axis_to_nck::delete_distance_to_go_spindle_reset,
    axis_to_nck::clamping_in_progress,
    axis_to_nck::reference_point_value_1,
    axis_to_nck::reference_point_value_2,
    axis_to_nck::reference_point_value_3,
    axis_to_nck::reference_point_value_4,
    axis_to_nck::activate_handwheel_1,
    axis_to_nck::activate_handwheel_2,
    axis_to_nck::activate_handwheel_3,
    axis_to_nck::feed_stop,
    axis_to_nck::traversing_key_disable,
    axis_to_nck::rapid_traverse_override,
    axis_to_nck::traversing_key_minus,
    axis_to_nck::traversing_key_plus,
    axis_to_nck::machine_function_increment_1,
    axis_to_nck::machine_function_increment_10,
    axis_to_nck::machine_function_increment_100,
    axis_to_nck::machine_function_increment_1000,
    axis_to_nck::machine_function_increment_10000,
    axis_to_nck::machine_function_increment_variable,
    axis_to_nck::machine_function_continuous,
    axis_to_nck::invert_handwheel_direction_of_rotation,
    axis_to_nck::controller_parameter_set,
    axis_to_nck::hardware_limit_switch_minus,
    axis_to_nck::hardware_limit_switch_plus,
    axis_to_nck::second_software_limit_switch_minus,
    axis_to_nck::second_software_limit_switch_plus,
    axis_to_nck::deceleration_reference_point_approach,
    axis_to_nck::ramp_function_generator_fast_stop,
    axis_to_nck::drive_data_set_selection,
    axis_to_nck::pulse_enable,
    axis_to_nck::start_gantry_synchronization,
    axis_to_nck::no_automatic_synchronization,
];

/// Whether the control writes a signal of the NCK, or reads a signal of another writer. Another signal is named, and can be written and
/// read, without an effect.
pub(super) fn is_modelled(signal: &Signal) -> bool {
    let same = |other: &Signal| (other.block, other.byte, other.bit) == (signal.block, signal.byte, signal.bit);
    match signal.writer {
        Writer::Nck => has_row(signal),
        Writer::Plc | Writer::Hmi => READ.iter().any(same) || has_row(signal),
    }
}
