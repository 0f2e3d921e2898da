//! DB21 to DB30: one channel each. The PLC writes bytes 0 to 21, the HMI bytes 24 and 25, the NCK bytes 32 to 53.

use crate::image::table::signals;

signals! {
    /// DB21 bytes 0 to 21: signals from the PLC to the channel.
    pub struct ChannelToNck, channel_to_nck: Channel, Plc, 0 to 21;

    /// Activate DRF: 1 = handwheel offsets in AUTOMATIC.
    bool, activate_drf, set_activate_drf: 0, 3;
    /// Activate single block: 1 = stop after each block.
    bool, activate_single_block, set_activate_single_block: 0, 4;
    /// Activate M01: 1 = the programmed optional stop is effective.
    bool, activate_m01, set_activate_m01: 0, 5;
    /// Activate dry run feedrate: 1 = the dry run feedrate replaces the programmed one.
    bool, activate_dry_run_feedrate, set_activate_dry_run_feedrate: 0, 6;
    /// Activate referencing: a rising edge starts the channel-specific reference point approach.
    bool, activate_referencing, set_activate_referencing: 1, 0;
    /// PLC action completed: 1 = the program may continue.
    bool, plc_action_completed, set_plc_action_completed: 1, 6;
    /// Activate program test: 1 = setpoints are not output.
    bool, activate_program_test, set_activate_program_test: 1, 7;
    /// Skip block level 0: 1 = blocks with / are skipped.
    bool, skip_block_level_0, set_skip_block_level_0: 2, 0;
    /// Skip block level 1: 1 = blocks with /1 are skipped.
    bool, skip_block_level_1, set_skip_block_level_1: 2, 1;
    /// Skip block level 2: 1 = blocks with /2 are skipped.
    bool, skip_block_level_2, set_skip_block_level_2: 2, 2;
    /// Skip block level 3: 1 = blocks with /3 are skipped.
    bool, skip_block_level_3, set_skip_block_level_3: 2, 3;
    /// Skip block level 4: 1 = blocks with /4 are skipped.
    bool, skip_block_level_4, set_skip_block_level_4: 2, 4;
    /// Skip block level 5: 1 = blocks with /5 are skipped.
    bool, skip_block_level_5, set_skip_block_level_5: 2, 5;
    /// Skip block level 6: 1 = blocks with /6 are skipped.
    bool, skip_block_level_6, set_skip_block_level_6: 2, 6;
    /// Skip block level 7: 1 = blocks with /7 are skipped.
    bool, skip_block_level_7, set_skip_block_level_7: 2, 7;
    /// Feed override: position of the switch in Gray code (MD12020 = 1) or per cent in binary.
    u8, feed_override, set_feed_override: 4, 7 to 0;
    /// Rapid traverse override: position of the switch in Gray code (MD12040 = 1) or per cent in binary.
    u8, rapid_traverse_override, set_rapid_traverse_override: 5, 7 to 0;
    /// Feed disable: 1 stops all axes of the channel, also in JOG.
    bool, feed_disable, set_feed_disable: 6, 0;
    /// Read-in disable: 1 = the next block is not read in.
    bool, read_in_disable, set_read_in_disable: 6, 1;
    /// Delete distance-to-go: 1 = delete it for the path axes.
    bool, delete_distance_to_go, set_delete_distance_to_go: 6, 2;
    /// Delete number of passes: 1 = the running subprogram is not repeated again.
    bool, delete_number_of_passes, set_delete_number_of_passes: 6, 3;
    /// Program level abort: 1 = the running subprogram is aborted.
    bool, program_level_abort, set_program_level_abort: 6, 4;
    /// Rapid traverse override active: 0 = the override is 100 %.
    bool, rapid_traverse_override_active, set_rapid_traverse_override_active: 6, 6;
    /// Feed override active: 0 = the override is 100 %.
    bool, feed_override_active, set_feed_override_active: 6, 7;
    /// NC start disable: 1 = no program can be started.
    bool, nc_start_disable, set_nc_start_disable: 7, 0;
    /// NC start: a rising edge starts the program.
    bool, nc_start, set_nc_start: 7, 1;
    /// NC stop at block limit: 1 = stop at the end of the block.
    bool, nc_stop_at_block_limit, set_nc_stop_at_block_limit: 7, 2;
    /// NC stop: 1 = stop immediately.
    bool, nc_stop, set_nc_stop: 7, 3;
    /// NC stop axes plus spindles: 1 = also stop the spindles.
    bool, nc_stop_axes_plus_spindles, set_nc_stop_axes_plus_spindles: 7, 4;
    /// Reset: 1 resets the channel and cancels alarms that RESET clears.
    bool, channel_reset, set_channel_reset: 7, 7;
    /// Geometry axis 1: activate handwheel 1: 1 = yes.
    bool, geometry_axis_1_activate_handwheel_1, set_geometry_axis_1_activate_handwheel_1: 12, 0;
    /// Geometry axis 1: activate handwheel 2: 1 = yes.
    bool, geometry_axis_1_activate_handwheel_2, set_geometry_axis_1_activate_handwheel_2: 12, 1;
    /// Geometry axis 1: activate handwheel 3: 1 = yes.
    bool, geometry_axis_1_activate_handwheel_3, set_geometry_axis_1_activate_handwheel_3: 12, 2;
    /// Geometry axis 1: feed stop: 1 = stop.
    bool, geometry_axis_1_feed_stop, set_geometry_axis_1_feed_stop: 12, 3;
    /// Geometry axis 1: traversing key lock: 1 = its traversing keys are ignored.
    bool, geometry_axis_1_traversing_key_lock, set_geometry_axis_1_traversing_key_lock: 12, 4;
    /// Geometry axis 1: rapid traverse override: 1 = a traversing key moves the axis at rapid traverse.
    bool, geometry_axis_1_rapid_traverse_override, set_geometry_axis_1_rapid_traverse_override: 12, 5;
    /// Geometry axis 1: traversing key minus: 1 = pressed.
    bool, geometry_axis_1_traversing_key_minus, set_geometry_axis_1_traversing_key_minus: 12, 6;
    /// Geometry axis 1: traversing key plus: 1 = pressed.
    bool, geometry_axis_1_traversing_key_plus, set_geometry_axis_1_traversing_key_plus: 12, 7;
    /// Geometry axis 1: machine function INC1: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_1, set_geometry_axis_1_machine_function_increment_1: 13, 0;
    /// Geometry axis 1: machine function INC10: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_10, set_geometry_axis_1_machine_function_increment_10: 13, 1;
    /// Geometry axis 1: machine function INC100: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_100, set_geometry_axis_1_machine_function_increment_100: 13, 2;
    /// Geometry axis 1: machine function INC1000: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_1000, set_geometry_axis_1_machine_function_increment_1000: 13, 3;
    /// Geometry axis 1: machine function INC10000: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_10000, set_geometry_axis_1_machine_function_increment_10000: 13, 4;
    /// Geometry axis 1: machine function INCvar: 1 = requested.
    bool, geometry_axis_1_machine_function_increment_variable, set_geometry_axis_1_machine_function_increment_variable: 13, 5;
    /// Geometry axis 1: machine function continuous traversing: 1 = requested.
    bool, geometry_axis_1_machine_function_continuous, set_geometry_axis_1_machine_function_continuous: 13, 6;
    /// Geometry axis 2: activate handwheel 1: 1 = yes.
    bool, geometry_axis_2_activate_handwheel_1, set_geometry_axis_2_activate_handwheel_1: 16, 0;
    /// Geometry axis 2: activate handwheel 2: 1 = yes.
    bool, geometry_axis_2_activate_handwheel_2, set_geometry_axis_2_activate_handwheel_2: 16, 1;
    /// Geometry axis 2: activate handwheel 3: 1 = yes.
    bool, geometry_axis_2_activate_handwheel_3, set_geometry_axis_2_activate_handwheel_3: 16, 2;
    /// Geometry axis 2: feed stop: 1 = stop.
    bool, geometry_axis_2_feed_stop, set_geometry_axis_2_feed_stop: 16, 3;
    /// Geometry axis 2: traversing key lock: 1 = its traversing keys are ignored.
    bool, geometry_axis_2_traversing_key_lock, set_geometry_axis_2_traversing_key_lock: 16, 4;
    /// Geometry axis 2: rapid traverse override: 1 = a traversing key moves the axis at rapid traverse.
    bool, geometry_axis_2_rapid_traverse_override, set_geometry_axis_2_rapid_traverse_override: 16, 5;
    /// Geometry axis 2: traversing key minus: 1 = pressed.
    bool, geometry_axis_2_traversing_key_minus, set_geometry_axis_2_traversing_key_minus: 16, 6;
    /// Geometry axis 2: traversing key plus: 1 = pressed.
    bool, geometry_axis_2_traversing_key_plus, set_geometry_axis_2_traversing_key_plus: 16, 7;
    /// Geometry axis 2: machine function INC1: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_1, set_geometry_axis_2_machine_function_increment_1: 17, 0;
    /// Geometry axis 2: machine function INC10: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_10, set_geometry_axis_2_machine_function_increment_10: 17, 1;
    /// Geometry axis 2: machine function INC100: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_100, set_geometry_axis_2_machine_function_increment_100: 17, 2;
    /// Geometry axis 2: machine function INC1000: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_1000, set_geometry_axis_2_machine_function_increment_1000: 17, 3;
    /// Geometry axis 2: machine function INC10000: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_10000, set_geometry_axis_2_machine_function_increment_10000: 17, 4;
    /// Geometry axis 2: machine function INCvar: 1 = requested.
    bool, geometry_axis_2_machine_function_increment_variable, set_geometry_axis_2_machine_function_increment_variable: 17, 5;
    /// Geometry axis 2: machine function continuous traversing: 1 = requested.
    bool, geometry_axis_2_machine_function_continuous, set_geometry_axis_2_machine_function_continuous: 17, 6;
    /// Geometry axis 3: activate handwheel 1: 1 = yes.
    bool, geometry_axis_3_activate_handwheel_1, set_geometry_axis_3_activate_handwheel_1: 20, 0;
    /// Geometry axis 3: activate handwheel 2: 1 = yes.
    bool, geometry_axis_3_activate_handwheel_2, set_geometry_axis_3_activate_handwheel_2: 20, 1;
    /// Geometry axis 3: activate handwheel 3: 1 = yes.
    bool, geometry_axis_3_activate_handwheel_3, set_geometry_axis_3_activate_handwheel_3: 20, 2;
    /// Geometry axis 3: feed stop: 1 = stop.
    bool, geometry_axis_3_feed_stop, set_geometry_axis_3_feed_stop: 20, 3;
    /// Geometry axis 3: traversing key lock: 1 = its traversing keys are ignored.
    bool, geometry_axis_3_traversing_key_lock, set_geometry_axis_3_traversing_key_lock: 20, 4;
    /// Geometry axis 3: rapid traverse override: 1 = a traversing key moves the axis at rapid traverse.
    bool, geometry_axis_3_rapid_traverse_override, set_geometry_axis_3_rapid_traverse_override: 20, 5;
    /// Geometry axis 3: traversing key minus: 1 = pressed.
    bool, geometry_axis_3_traversing_key_minus, set_geometry_axis_3_traversing_key_minus: 20, 6;
    /// Geometry axis 3: traversing key plus: 1 = pressed.
    bool, geometry_axis_3_traversing_key_plus, set_geometry_axis_3_traversing_key_plus: 20, 7;
    /// Geometry axis 3: machine function INC1: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_1, set_geometry_axis_3_machine_function_increment_1: 21, 0;
    /// Geometry axis 3: machine function INC10: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_10, set_geometry_axis_3_machine_function_increment_10: 21, 1;
    /// Geometry axis 3: machine function INC100: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_100, set_geometry_axis_3_machine_function_increment_100: 21, 2;
    /// Geometry axis 3: machine function INC1000: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_1000, set_geometry_axis_3_machine_function_increment_1000: 21, 3;
    /// Geometry axis 3: machine function INC10000: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_10000, set_geometry_axis_3_machine_function_increment_10000: 21, 4;
    /// Geometry axis 3: machine function INCvar: 1 = requested.
    bool, geometry_axis_3_machine_function_increment_variable, set_geometry_axis_3_machine_function_increment_variable: 21, 5;
    /// Geometry axis 3: machine function continuous traversing: 1 = requested.
    bool, geometry_axis_3_machine_function_continuous, set_geometry_axis_3_machine_function_continuous: 21, 6;
}

signals! {
    /// DB21 bytes 24 and 25: selections of the operator on the HMI; PLC programs copy them to bytes 0 and 6.
    pub struct ChannelHmi, channel_hmi: Channel, Hmi, 24 to 25;

    /// DRF selected on the HMI: 1 = yes.
    bool, drf_selected, set_drf_selected: 24, 3;
    /// Associated M0/M1 selected on the HMI: 1 = yes.
    bool, associated_m0_m1_selected, set_associated_m0_m1_selected: 24, 4;
    /// M01 selected on the HMI: 1 = yes.
    bool, m01_selected, set_m01_selected: 24, 5;
    /// Dry run feedrate selected on the HMI: 1 = yes.
    bool, dry_run_feedrate_selected, set_dry_run_feedrate_selected: 24, 6;
    /// Feed override selected for rapid traverse on the HMI: 1 = yes.
    bool, feed_override_for_rapid_traverse_selected, set_feed_override_for_rapid_traverse_selected: 25, 3;
}

signals! {
    /// DB21 bytes 32 to 53: signals from the channel to the PLC.
    pub struct ChannelFromNck, channel_from_nck: Channel, Nck, 32 to 53;

    /// Action block active: 1 = yes.
    bool, action_block_active, set_action_block_active: 32, 3;
    /// Approach block active: 1 = yes.
    bool, approach_block_active, set_approach_block_active: 32, 4;
    /// M0/M1 active: 1 = the program waits at a programmed stop.
    bool, m0_m1_active, set_m0_m1_active: 32, 5;
    /// Last action block active: 1 = yes.
    bool, last_action_block_active, set_last_action_block_active: 32, 6;
    /// Referencing active: 1 during channel-specific referencing.
    bool, referencing_active, set_referencing_active: 33, 0;
    /// Revolutional feedrate active: 1 = yes.
    bool, revolutional_feedrate_active, set_revolutional_feedrate_active: 33, 2;
    /// Handwheel override active: 1 = yes.
    bool, handwheel_override_active, set_handwheel_override_active: 33, 3;
    /// Block search active: 1 = yes.
    bool, block_search_active, set_block_search_active: 33, 4;
    /// M2/M30 active: 1 = the program has ended.
    bool, m2_m30_active, set_m2_m30_active: 33, 5;
    /// Transformation active: 1 = yes.
    bool, transformation_active, set_transformation_active: 33, 6;
    /// Program test active: 1 = yes.
    bool, program_test_active, set_program_test_active: 33, 7;
    /// Program state running: 1 = in this state; exactly one of the five is 1.
    bool, program_state_running, set_program_state_running: 35, 0;
    /// Program state wait: 1 = in this state; exactly one of the five is 1.
    bool, program_state_wait, set_program_state_wait: 35, 1;
    /// Program state stopped: 1 = in this state; exactly one of the five is 1.
    bool, program_state_stopped, set_program_state_stopped: 35, 2;
    /// Program state interrupted: 1 = in this state; exactly one of the five is 1.
    bool, program_state_interrupted, set_program_state_interrupted: 35, 3;
    /// Program state aborted: 1 = in this state; exactly one of the five is 1.
    bool, program_state_aborted, set_program_state_aborted: 35, 4;
    /// Channel state active: 1 = in this state; exactly one of the three is 1.
    bool, channel_state_active, set_channel_state_active: 35, 5;
    /// Channel state interrupted: 1 = in this state; exactly one of the three is 1.
    bool, channel_state_interrupted, set_channel_state_interrupted: 35, 6;
    /// Channel state reset: 1 = in this state; exactly one of the three is 1.
    bool, channel_state_reset, set_channel_state_reset: 35, 7;
    /// All axes that require a reference point are referenced: 1 = yes (MD34110, MD20700).
    bool, all_axes_requiring_reference_point_are_referenced, set_all_axes_requiring_reference_point_are_referenced: 36, 2;
    /// All axes stationary: 1 = yes.
    bool, all_axes_stationary, set_all_axes_stationary: 36, 3;
    /// Interrupt handling active: 1 = yes.
    bool, interrupt_handling_active, set_interrupt_handling_active: 36, 4;
    /// Channel ready: 0 with the alarm reaction "channel not ready".
    bool, channel_ready, set_channel_ready: 36, 5;
    /// Channel-specific NCK alarm active: 1 = at least one.
    bool, channel_specific_nck_alarm_active, set_channel_specific_nck_alarm_active: 36, 6;
    /// NCK alarm with machining stop active: 1 = at least one.
    bool, nck_alarm_with_machining_stop_active, set_nck_alarm_with_machining_stop_active: 36, 7;
    /// Geometry axis 1: handwheel 1 active: 1 = yes.
    bool, geometry_axis_1_handwheel_1_active, set_geometry_axis_1_handwheel_1_active: 40, 0;
    /// Geometry axis 1: handwheel 2 active: 1 = yes.
    bool, geometry_axis_1_handwheel_2_active, set_geometry_axis_1_handwheel_2_active: 40, 1;
    /// Geometry axis 1: handwheel 3 active: 1 = yes.
    bool, geometry_axis_1_handwheel_3_active, set_geometry_axis_1_handwheel_3_active: 40, 2;
    /// Geometry axis 1: traverse request minus: 1 = motion is requested.
    bool, geometry_axis_1_traverse_request_minus, set_geometry_axis_1_traverse_request_minus: 40, 4;
    /// Geometry axis 1: traverse request plus: 1 = motion is requested.
    bool, geometry_axis_1_traverse_request_plus, set_geometry_axis_1_traverse_request_plus: 40, 5;
    /// Geometry axis 1: traverse command minus: 1 = the axis must move.
    bool, geometry_axis_1_traverse_command_minus, set_geometry_axis_1_traverse_command_minus: 40, 6;
    /// Geometry axis 1: traverse command plus: 1 = the axis must move.
    bool, geometry_axis_1_traverse_command_plus, set_geometry_axis_1_traverse_command_plus: 40, 7;
    /// Geometry axis 1: active machine function INC1: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_1, set_geometry_axis_1_active_machine_function_increment_1: 41, 0;
    /// Geometry axis 1: active machine function INC10: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_10, set_geometry_axis_1_active_machine_function_increment_10: 41, 1;
    /// Geometry axis 1: active machine function INC100: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_100, set_geometry_axis_1_active_machine_function_increment_100: 41, 2;
    /// Geometry axis 1: active machine function INC1000: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_1000, set_geometry_axis_1_active_machine_function_increment_1000: 41, 3;
    /// Geometry axis 1: active machine function INC10000: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_10000, set_geometry_axis_1_active_machine_function_increment_10000: 41, 4;
    /// Geometry axis 1: active machine function INCvar: 1 = active.
    bool, geometry_axis_1_active_machine_function_increment_variable, set_geometry_axis_1_active_machine_function_increment_variable: 41, 5;
    /// Geometry axis 1: active machine function continuous traversing: 1 = active.
    bool, geometry_axis_1_active_machine_function_continuous, set_geometry_axis_1_active_machine_function_continuous: 41, 6;
    /// Geometry axis 2: handwheel 1 active: 1 = yes.
    bool, geometry_axis_2_handwheel_1_active, set_geometry_axis_2_handwheel_1_active: 46, 0;
    /// Geometry axis 2: handwheel 2 active: 1 = yes.
    bool, geometry_axis_2_handwheel_2_active, set_geometry_axis_2_handwheel_2_active: 46, 1;
    /// Geometry axis 2: handwheel 3 active: 1 = yes.
    bool, geometry_axis_2_handwheel_3_active, set_geometry_axis_2_handwheel_3_active: 46, 2;
    /// Geometry axis 2: traverse request minus: 1 = motion is requested.
    bool, geometry_axis_2_traverse_request_minus, set_geometry_axis_2_traverse_request_minus: 46, 4;
    /// Geometry axis 2: traverse request plus: 1 = motion is requested.
    bool, geometry_axis_2_traverse_request_plus, set_geometry_axis_2_traverse_request_plus: 46, 5;
    /// Geometry axis 2: traverse command minus: 1 = the axis must move.
    bool, geometry_axis_2_traverse_command_minus, set_geometry_axis_2_traverse_command_minus: 46, 6;
    /// Geometry axis 2: traverse command plus: 1 = the axis must move.
    bool, geometry_axis_2_traverse_command_plus, set_geometry_axis_2_traverse_command_plus: 46, 7;
    /// Geometry axis 2: active machine function INC1: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_1, set_geometry_axis_2_active_machine_function_increment_1: 47, 0;
    /// Geometry axis 2: active machine function INC10: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_10, set_geometry_axis_2_active_machine_function_increment_10: 47, 1;
    /// Geometry axis 2: active machine function INC100: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_100, set_geometry_axis_2_active_machine_function_increment_100: 47, 2;
    /// Geometry axis 2: active machine function INC1000: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_1000, set_geometry_axis_2_active_machine_function_increment_1000: 47, 3;
    /// Geometry axis 2: active machine function INC10000: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_10000, set_geometry_axis_2_active_machine_function_increment_10000: 47, 4;
    /// Geometry axis 2: active machine function INCvar: 1 = active.
    bool, geometry_axis_2_active_machine_function_increment_variable, set_geometry_axis_2_active_machine_function_increment_variable: 47, 5;
    /// Geometry axis 2: active machine function continuous traversing: 1 = active.
    bool, geometry_axis_2_active_machine_function_continuous, set_geometry_axis_2_active_machine_function_continuous: 47, 6;
    /// Geometry axis 3: handwheel 1 active: 1 = yes.
    bool, geometry_axis_3_handwheel_1_active, set_geometry_axis_3_handwheel_1_active: 52, 0;
    /// Geometry axis 3: handwheel 2 active: 1 = yes.
    bool, geometry_axis_3_handwheel_2_active, set_geometry_axis_3_handwheel_2_active: 52, 1;
    /// Geometry axis 3: handwheel 3 active: 1 = yes.
    bool, geometry_axis_3_handwheel_3_active, set_geometry_axis_3_handwheel_3_active: 52, 2;
    /// Geometry axis 3: traverse request minus: 1 = motion is requested.
    bool, geometry_axis_3_traverse_request_minus, set_geometry_axis_3_traverse_request_minus: 52, 4;
    /// Geometry axis 3: traverse request plus: 1 = motion is requested.
    bool, geometry_axis_3_traverse_request_plus, set_geometry_axis_3_traverse_request_plus: 52, 5;
    /// Geometry axis 3: traverse command minus: 1 = the axis must move.
    bool, geometry_axis_3_traverse_command_minus, set_geometry_axis_3_traverse_command_minus: 52, 6;
    /// Geometry axis 3: traverse command plus: 1 = the axis must move.
    bool, geometry_axis_3_traverse_command_plus, set_geometry_axis_3_traverse_command_plus: 52, 7;
    /// Geometry axis 3: active machine function INC1: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_1, set_geometry_axis_3_active_machine_function_increment_1: 53, 0;
    /// Geometry axis 3: active machine function INC10: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_10, set_geometry_axis_3_active_machine_function_increment_10: 53, 1;
    /// Geometry axis 3: active machine function INC100: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_100, set_geometry_axis_3_active_machine_function_increment_100: 53, 2;
    /// Geometry axis 3: active machine function INC1000: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_1000, set_geometry_axis_3_active_machine_function_increment_1000: 53, 3;
    /// Geometry axis 3: active machine function INC10000: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_10000, set_geometry_axis_3_active_machine_function_increment_10000: 53, 4;
    /// Geometry axis 3: active machine function INCvar: 1 = active.
    bool, geometry_axis_3_active_machine_function_increment_variable, set_geometry_axis_3_active_machine_function_increment_variable: 53, 5;
    /// Geometry axis 3: active machine function continuous traversing: 1 = active.
    bool, geometry_axis_3_active_machine_function_continuous, set_geometry_axis_3_active_machine_function_continuous: 53, 6;
}
