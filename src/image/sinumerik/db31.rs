//! DB31 to DB61: one machine axis or spindle each. The PLC writes bytes 0 to 43, the NCK bytes 60 to 107. Bytes 32 to 43 and 104 to 107 are those
//! of FC 18 (SpinCtrl): the list manual does not name them, and the 828D shows the same bits at DB380x.DBB3000 and DB390x.DBB3000.
//!
//! Where G1 contradicts the list manual, the list manual applies: 4.3 is feed stop and 4.4 is traversing key disable (E-02), the measuring
//! systems are 1.5 and 1.6 (E-03), 12.2 and 12.3 are the second *software* limit switches (E-04), minus precedes plus (E-05).

use crate::image::table::signals;

signals! {
    /// DB31 bytes 0 to 43: signals from the PLC to the axis.
    pub struct AxisToNck, axis_to_nck: Axis, Plc, 0 to 43;

    /// Feed override: position of the switch in Gray code (MD12000 = 1) or per cent in binary; position 1 = 0 %.
    u8, feed_override, set_feed_override: 0, 7 to 0;
    /// Drive test travel enable: the answer of the PLC to the drive test travel request.
    bool, drive_test_travel_enable, set_drive_test_travel_enable: 1, 0;
    /// Acknowledge fixed stop reached: 1 = acknowledged.
    bool, acknowledge_fixed_stop_reached, set_acknowledge_fixed_stop_reached: 1, 1;
    /// Sensor for fixed stop: 1 = the sensor has switched.
    bool, fixed_stop_sensor, set_fixed_stop_sensor: 1, 2;
    /// Axis/spindle disable: 1 = setpoints are not output; the loop stays closed.
    bool, axis_spindle_disable, set_axis_spindle_disable: 1, 3;
    /// Follow-up mode: while controller enable is off, 1 = the setpoint follows the actual value, 0 = the setpoint is held.
    bool, follow_up_mode, set_follow_up_mode: 1, 4;
    /// Position measuring system 1: 1 = selected; without 1 and 2 the axis is parked.
    bool, position_measuring_system_1, set_position_measuring_system_1: 1, 5;
    /// Position measuring system 2: 1 = selected; with both, only 1 is used.
    bool, position_measuring_system_2, set_position_measuring_system_2: 1, 6;
    /// Override active: 0 = the axial override is 100 %; its zero setting acts all the same.
    bool, override_active, set_override_active: 1, 7;
    /// Controller enable (servo enable): 0 = the axis brakes and the position control loop is opened.
    bool, controller_enable, set_controller_enable: 2, 1;
    /// Delete distance-to-go, spindle reset: effective at a rising edge.
    bool, delete_distance_to_go_spindle_reset, set_delete_distance_to_go_spindle_reset: 2, 2;
    /// Clamping in progress: 1 = clamping monitoring (MD36050) instead of zero-speed monitoring.
    bool, clamping_in_progress, set_clamping_in_progress: 2, 3;
    /// Reference point value 1: 1 selects MD34100 index 0; if none is set, value 1 applies.
    bool, reference_point_value_1, set_reference_point_value_1: 2, 4;
    /// Reference point value 2: 1 selects MD34100 index 1; if none is set, value 1 applies.
    bool, reference_point_value_2, set_reference_point_value_2: 2, 5;
    /// Reference point value 3: 1 selects MD34100 index 2; if none is set, value 1 applies.
    bool, reference_point_value_3, set_reference_point_value_3: 2, 6;
    /// Reference point value 4: 1 selects MD34100 index 3; if none is set, value 1 applies.
    bool, reference_point_value_4, set_reference_point_value_4: 2, 7;
    /// Accept external work offset: 1 = accept.
    bool, accept_external_work_offset, set_accept_external_work_offset: 3, 0;
    /// Enable travel to fixed stop: 1 = enabled.
    bool, enable_travel_to_fixed_stop, set_enable_travel_to_fixed_stop: 3, 1;
    /// Activate fixed feedrate 1: 1 = active.
    bool, activate_fixed_feedrate_1, set_activate_fixed_feedrate_1: 3, 2;
    /// Activate fixed feedrate 2: 1 = active.
    bool, activate_fixed_feedrate_2, set_activate_fixed_feedrate_2: 3, 3;
    /// Activate fixed feedrate 3: 1 = active.
    bool, activate_fixed_feedrate_3, set_activate_fixed_feedrate_3: 3, 4;
    /// Activate fixed feedrate 4: 1 = active.
    bool, activate_fixed_feedrate_4, set_activate_fixed_feedrate_4: 3, 5;
    /// Velocity/spindle speed limiting: 1 = limited.
    bool, velocity_spindle_speed_limiting, set_velocity_spindle_speed_limiting: 3, 6;
    /// Activate handwheel 1: 1 = the handwheel moves this axis.
    bool, activate_handwheel_1, set_activate_handwheel_1: 4, 0;
    /// Activate handwheel 2: 1 = the handwheel moves this axis.
    bool, activate_handwheel_2, set_activate_handwheel_2: 4, 1;
    /// Activate handwheel 3: 1 = the handwheel moves this axis.
    bool, activate_handwheel_3, set_activate_handwheel_3: 4, 2;
    /// Feed stop, spindle stop: 1 = stop.
    bool, feed_stop, set_feed_stop: 4, 3;
    /// Traversing key disable: 1 = the traversing keys are ignored.
    bool, traversing_key_disable, set_traversing_key_disable: 4, 4;
    /// Rapid traverse override: 1 = a traversing key moves the axis at MD32010 instead of MD32020.
    bool, rapid_traverse_override, set_rapid_traverse_override: 4, 5;
    /// Traversing key minus: 1 = pressed; both pressed: no motion.
    bool, traversing_key_minus, set_traversing_key_minus: 4, 6;
    /// Traversing key plus: 1 = pressed; both pressed: no motion.
    bool, traversing_key_plus, set_traversing_key_plus: 4, 7;
    /// Machine function INC1: 1 = requested.
    bool, machine_function_increment_1, set_machine_function_increment_1: 5, 0;
    /// Machine function INC10: 1 = requested.
    bool, machine_function_increment_10, set_machine_function_increment_10: 5, 1;
    /// Machine function INC100: 1 = requested.
    bool, machine_function_increment_100, set_machine_function_increment_100: 5, 2;
    /// Machine function INC1000: 1 = requested.
    bool, machine_function_increment_1000, set_machine_function_increment_1000: 5, 3;
    /// Machine function INC10000: 1 = requested.
    bool, machine_function_increment_10000, set_machine_function_increment_10000: 5, 4;
    /// Machine function INCvar: 1 = requested.
    bool, machine_function_increment_variable, set_machine_function_increment_variable: 5, 5;
    /// Machine function continuous traversing: 1 = requested.
    bool, machine_function_continuous, set_machine_function_continuous: 5, 6;
    /// Invert handwheel direction of rotation: 1 = inverted.
    bool, invert_handwheel_direction_of_rotation, set_invert_handwheel_direction_of_rotation: 7, 0;
    /// Axis/spindle replacement: number of the channel that receives the axis, binary.
    u8, replacement_channel_number, set_replacement_channel_number: 8, 3 to 0;
    /// Axis/spindle replacement: activation signal when the type changes; effective at a rising edge.
    bool, replacement_activation_signal, set_replacement_activation_signal: 8, 4;
    /// Axis/spindle replacement: 1 requests the axis for the PLC.
    bool, request_plc_axis, set_request_plc_axis: 8, 7;
    /// Controller parameter set, binary.
    u8, controller_parameter_set, set_controller_parameter_set: 9, 2 to 0;
    /// Parameter set specification by the NC disabled: 1 = only the PLC changes it.
    bool, parameter_set_change_by_nc_disabled, set_parameter_set_change_by_nc_disabled: 9, 3;
    /// Hardware limit switch minus: 1 = the axis is on it.
    bool, hardware_limit_switch_minus, set_hardware_limit_switch_minus: 12, 0;
    /// Hardware limit switch plus: 1 = the axis is on it.
    bool, hardware_limit_switch_plus, set_hardware_limit_switch_plus: 12, 1;
    /// Second software limit switch minus: 1 = MD36120 applies instead of MD36100.
    bool, second_software_limit_switch_minus, set_second_software_limit_switch_minus: 12, 2;
    /// Second software limit switch plus: 1 = MD36130 applies instead of MD36110.
    bool, second_software_limit_switch_plus, set_second_software_limit_switch_plus: 12, 3;
    /// Modulo rotary axis: 1 = its traversing range limits are effective.
    bool, modulo_limits_enable, set_modulo_limits_enable: 12, 4;
    /// Deceleration of reference point approach: 1 = the axis is on the reference cam.
    bool, deceleration_reference_point_approach, set_deceleration_reference_point_approach: 12, 7;
    /// JOG approach fixed point: its number, binary; 0 = none.
    u8, jog_approach_fixed_point, set_jog_approach_fixed_point: 13, 2 to 0;
    /// JOG approach position: 1 = approach.
    bool, jog_approach_position, set_jog_approach_position: 13, 3;
    /// Suppress program test: 1 = suppressed for this axis.
    bool, suppress_program_test, set_suppress_program_test: 14, 0;
    /// Activate program test: 1 = active for this axis.
    bool, activate_program_test, set_activate_program_test: 14, 1;
    /// Actual gear stage of the spindle, binary: 1 to 5.
    u8, actual_gear_stage, set_actual_gear_stage: 16, 2 to 0;
    /// Gear stage changed: 1 = the stage in the three bits before is engaged.
    bool, gear_stage_changed, set_gear_stage_changed: 16, 3;
    /// Resynchronise spindle 1: 1 = the zero mark is searched again with measuring system 1.
    bool, resynchronise_spindle_1, set_resynchronise_spindle_1: 16, 4;
    /// Resynchronise spindle 2: 1 = the zero mark is searched again with measuring system 2.
    bool, resynchronise_spindle_2, set_resynchronise_spindle_2: 16, 5;
    /// No speed monitoring during a gear change: 1 = none.
    bool, no_speed_monitoring_during_gear_change, set_no_speed_monitoring_during_gear_change: 16, 6;
    /// Delete S value: 1 = the programmed speed of the spindle is 0; effective at a rising edge.
    bool, delete_s_value, set_delete_s_value: 16, 7;
    /// Feed override for the spindle: 1 = the feed override acts instead of the spindle override.
    bool, feed_override_for_spindle, set_feed_override_for_spindle: 17, 0;
    /// Invert M3 and M4: 1 = M3 turns counterclockwise, M4 clockwise.
    bool, invert_m3_m4, set_invert_m3_m4: 17, 6;
    /// Oscillation by the PLC: 1 = the direction signals of oscillation are those of the PLC.
    bool, oscillation_by_plc, set_oscillation_by_plc: 18, 4;
    /// Oscillation enable: 1 = the spindle oscillates during a gear change.
    bool, oscillation_enable, set_oscillation_enable: 18, 5;
    /// Direction of oscillation clockwise: 1 = clockwise.
    bool, oscillation_clockwise, set_oscillation_clockwise: 18, 6;
    /// Direction of oscillation counterclockwise: 1 = counterclockwise.
    bool, oscillation_counterclockwise, set_oscillation_counterclockwise: 18, 7;
    /// Spindle override: position of the switch in Gray code (MD12060 = 1) or per cent in binary.
    u8, spindle_override, set_spindle_override: 19, 7 to 0;
    /// Ramp-function generator fast stop: 1 = speed setpoint 0 along the ramp of the drive.
    bool, ramp_function_generator_fast_stop, set_ramp_function_generator_fast_stop: 20, 1;
    /// Open holding brake: 1 = the brake of the motor opens, also without power; the axis may fall.
    bool, open_holding_brake, set_open_holding_brake: 20, 5;
    /// Motor and drive data set selection, binary.
    u8, drive_data_set_selection, set_drive_data_set_selection: 21, 4 to 0;
    /// Motor has been selected: 1 = yes.
    bool, motor_has_been_selected, set_motor_has_been_selected: 21, 5;
    /// Speed controller integrator disable: 1 = disabled.
    bool, speed_controller_integrator_disable, set_speed_controller_integrator_disable: 21, 6;
    /// Pulse enable: 0 = the drive has no torque.
    bool, pulse_enable, set_pulse_enable: 21, 7;
    /// Activate torque compensatory controller: 1 = on.
    bool, activate_torque_compensatory_controller, set_activate_torque_compensatory_controller: 24, 4;
    /// Request drive control: 1 = requested.
    bool, request_drive_control, set_request_drive_control: 24, 5;
    /// Activate master-slave coupling: 1 = on.
    bool, activate_master_slave, set_activate_master_slave: 24, 7;
    /// External oscillation reversal: 1 = reverse immediately.
    bool, external_oscillation_reversal, set_external_oscillation_reversal: 28, 0;
    /// PLC-controlled axis: reset, effective at a rising edge.
    bool, plc_controlled_axis_reset, set_plc_controlled_axis_reset: 28, 1;
    /// PLC-controlled axis: resume, effective at a rising edge.
    bool, plc_controlled_axis_resume, set_plc_controlled_axis_resume: 28, 2;
    /// Set reversal point: 1 = set.
    bool, set_oscillation_reversal_point, set_set_oscillation_reversal_point: 28, 3;
    /// Change reversal point: 0 = reversal point 1, 1 = reversal point 2.
    bool, change_oscillation_reversal_point, set_change_oscillation_reversal_point: 28, 4;
    /// Stop at the next reversal point: 1 = stop.
    bool, stop_at_next_oscillation_reversal_point, set_stop_at_next_oscillation_reversal_point: 28, 5;
    /// Stop along the braking ramp: 1 = stop; also the stop of a PLC-controlled axis.
    bool, stop_along_braking_ramp, set_stop_along_braking_ramp: 28, 6;
    /// PLC controls axis: 1 = requested.
    bool, plc_controls_axis, set_plc_controls_axis: 28, 7;
    /// Start gantry synchronization: 1 starts the synchronization run; effective on the leading axis.
    bool, start_gantry_synchronization, set_start_gantry_synchronization: 29, 4;
    /// No automatic synchronization of the gantry grouping: 1 = the synchronization run does not start automatically; effective on the
    /// leading axis.
    bool, no_automatic_synchronization, set_no_automatic_synchronization: 29, 5;
    /// FC 18: 1 = start spindle oscillation.
    bool, start_spindle_oscillation, set_start_spindle_oscillation: 32, 4;
    /// FC 18: 1 = start spindle rotation.
    bool, start_spindle_rotation, set_start_spindle_rotation: 32, 5;
    /// FC 18: 1 = start spindle positioning.
    bool, start_spindle_positioning, set_start_spindle_positioning: 32, 6;
    /// FC 18: a rising edge starts a positioning axis; 0 before its target is reached stops it.
    bool, start_positioning_axis, set_start_positioning_axis: 32, 7;
    /// FC 18: 1 = stop spindle oscillation.
    bool, stop_spindle_oscillation, set_stop_spindle_oscillation: 33, 4;
    /// FC 18: 1 = stop spindle rotation.
    bool, stop_spindle_rotation, set_stop_spindle_rotation: 33, 5;
    /// FC 18: 1 = the target is a distance (IC).
    bool, incremental_position, set_incremental_position: 34, 0;
    /// FC 18: 1 = shortest distance (DC).
    bool, shortest_distance, set_shortest_distance: 34, 1;
    /// FC 18: 1 = target and feedrate are in inches.
    bool, position_in_inches, set_position_in_inches: 34, 2;
    /// FC 18: 1 = with handwheel override.
    bool, positioning_with_handwheel_override, set_positioning_with_handwheel_override: 34, 3;
    /// FC 18: 1 = direction of rotation as for M4.
    bool, direction_of_rotation_as_m4, set_direction_of_rotation_as_m4: 34, 5;
    /// FC 18: 1 = constant cutting rate.
    bool, constant_cutting_rate, set_constant_cutting_rate: 34, 6;
    /// FC 18: 1 = automatic gear selection.
    bool, automatic_gear_selection, set_automatic_gear_selection: 34, 7;
    /// FC 18: 1 = absolute target, approached in minus direction (ACN).
    bool, approach_in_minus_direction, set_approach_in_minus_direction: 35, 0;
    /// FC 18: 1 = absolute target, approached in plus direction (ACP).
    bool, approach_in_plus_direction, set_approach_in_plus_direction: 35, 1;
    /// FC 18: 1 = the target is the number of an indexing position.
    bool, indexing_position, set_indexing_position: 35, 7;

    numbers {
        /// FC 18: target or distance in mm or degrees, or inches.
        f32, positioning_target, set_positioning_target: 36;
        /// FC 18: feedrate in mm/min or rev/min, or inches/min; 0 or less: MD32060.
        f32, positioning_feedrate, set_positioning_feedrate: 40;
    }
}

signals! {
    /// DB31 bytes 60 to 107: signals from the axis to the PLC.
    pub struct AxisFromNck, axis_from_nck: Axis, Nck, 60 to 107;

    /// Spindle, no axis: 1 = spindle, 0 = axis.
    bool, spindle_no_axis, set_spindle_no_axis: 60, 0;
    /// NCU link axis active: 1 = yes.
    bool, ncu_link_axis_active, set_ncu_link_axis_active: 60, 1;
    /// Encoder limit frequency exceeded 1: 1 = above MD36300; the reference is lost.
    bool, encoder_limit_frequency_exceeded_1, set_encoder_limit_frequency_exceeded_1: 60, 2;
    /// Encoder limit frequency exceeded 2: 1 = above MD36300; the reference is lost.
    bool, encoder_limit_frequency_exceeded_2, set_encoder_limit_frequency_exceeded_2: 60, 3;
    /// Referenced/synchronized 1: 1 = the axis is referenced with measuring system 1.
    bool, referenced_synchronized_1, set_referenced_synchronized_1: 60, 4;
    /// Referenced/synchronized 2: 1 = the axis is referenced with measuring system 2.
    bool, referenced_synchronized_2, set_referenced_synchronized_2: 60, 5;
    /// Position reached with exact stop coarse: 1 = inside MD36000.
    bool, position_reached_exact_stop_coarse, set_position_reached_exact_stop_coarse: 60, 6;
    /// Position reached with exact stop fine: 1 = inside MD36010.
    bool, position_reached_exact_stop_fine, set_position_reached_exact_stop_fine: 60, 7;
    /// Drive test travel request: 1 = the drive requests autonomous motion.
    bool, drive_test_travel_request, set_drive_test_travel_request: 61, 0;
    /// Axis-specific alarm: 1 = at least one alarm of this axis is pending.
    bool, axis_specific_alarm, set_axis_specific_alarm: 61, 1;
    /// Axis ready: 1 = ready to move.
    bool, axis_ready, set_axis_ready: 61, 2;
    /// Follow-up active: 1 = the setpoint follows the actual value.
    bool, follow_up_active, set_follow_up_active: 61, 3;
    /// Axis/spindle stationary (n < nmin): 1 = no new setpoints are output and slower than MD36060.
    bool, axis_stationary, set_axis_stationary: 61, 4;
    /// Position controller active: 1 = the position control loop is closed.
    bool, position_controller_active, set_position_controller_active: 61, 5;
    /// Speed controller active: 1 = the speed control loop is closed.
    bool, speed_controller_active, set_speed_controller_active: 61, 6;
    /// Current controller active: 1 = the current control loop is closed.
    bool, current_controller_active, set_current_controller_active: 61, 7;
    /// Software cams active: 1 = yes.
    bool, software_cams_active, set_software_cams_active: 62, 0;
    /// Handwheel override active: 1 = yes.
    bool, handwheel_override_active, set_handwheel_override_active: 62, 1;
    /// Revolutional feedrate active: 1 = yes.
    bool, revolutional_feedrate_active, set_revolutional_feedrate_active: 62, 2;
    /// Measurement active: 1 = yes.
    bool, measurement_active, set_measurement_active: 62, 3;
    /// Travel to fixed stop activated: 1 = yes.
    bool, travel_to_fixed_stop_activated, set_travel_to_fixed_stop_activated: 62, 4;
    /// Fixed stop reached: 1 = yes.
    bool, fixed_stop_reached, set_fixed_stop_reached: 62, 5;
    /// Axis container rotation active: 1 = yes.
    bool, axis_container_rotation_active, set_axis_container_rotation_active: 62, 7;
    /// Reset executed: 1 = the reset of the PLC-controlled axis is complete.
    bool, reset_executed, set_reset_executed: 63, 0;
    /// PLC-controlled axis: 1 = the PLC controls the axis.
    bool, plc_controlled_axis, set_plc_controlled_axis: 63, 1;
    /// Axis stop active: 1 = yes.
    bool, axis_stop_active, set_axis_stop_active: 63, 2;
    /// Handwheel 1 active: 1 = the handwheel moves this axis.
    bool, handwheel_1_active, set_handwheel_1_active: 64, 0;
    /// Handwheel 2 active: 1 = the handwheel moves this axis.
    bool, handwheel_2_active, set_handwheel_2_active: 64, 1;
    /// Handwheel 3 active: 1 = the handwheel moves this axis.
    bool, handwheel_3_active, set_handwheel_3_active: 64, 2;
    /// Traverse request minus: 1 = motion is requested, even if it is blocked.
    bool, traverse_request_minus, set_traverse_request_minus: 64, 4;
    /// Traverse request plus: 1 = motion is requested, even if it is blocked.
    bool, traverse_request_plus, set_traverse_request_plus: 64, 5;
    /// Traverse command minus: 1 = the axis must move.
    bool, traverse_command_minus, set_traverse_command_minus: 64, 6;
    /// Traverse command plus: 1 = the axis must move.
    bool, traverse_command_plus, set_traverse_command_plus: 64, 7;
    /// Active machine function INC1: 1 = active.
    bool, active_machine_function_increment_1, set_active_machine_function_increment_1: 65, 0;
    /// Active machine function INC10: 1 = active.
    bool, active_machine_function_increment_10, set_active_machine_function_increment_10: 65, 1;
    /// Active machine function INC100: 1 = active.
    bool, active_machine_function_increment_100, set_active_machine_function_increment_100: 65, 2;
    /// Active machine function INC1000: 1 = active.
    bool, active_machine_function_increment_1000, set_active_machine_function_increment_1000: 65, 3;
    /// Active machine function INC10000: 1 = active.
    bool, active_machine_function_increment_10000, set_active_machine_function_increment_10000: 65, 4;
    /// Active machine function INCvar: 1 = active.
    bool, active_machine_function_increment_variable, set_active_machine_function_increment_variable: 65, 5;
    /// Active machine function continuous traversing: 1 = active.
    bool, active_machine_function_continuous, set_active_machine_function_continuous: 65, 6;
    /// Collision protection of the coupling in the machine frame active: 1 = yes.
    bool, machine_frame_coupling_collision_protection_active, set_machine_frame_coupling_collision_protection_active: 66, 0;
    /// Invert handwheel direction of rotation active: 1 = yes.
    bool, invert_handwheel_direction_of_rotation_active, set_invert_handwheel_direction_of_rotation_active: 67, 0;
    /// Axis/spindle replacement: number of the channel that has the axis, binary.
    u8, axis_replacement_channel, set_axis_replacement_channel: 68, 3 to 0;
    /// Axis/spindle replacement: 1 = the PLC has asked for an exchange that is not carried out yet.
    bool, axis_replacement_requested, set_axis_replacement_requested: 68, 4;
    /// Axis/spindle replacement: 1 = the axis can be exchanged now.
    bool, axis_replacement_possible, set_axis_replacement_possible: 68, 5;
    /// Axis/spindle replacement: 1 = neutral axis.
    bool, neutral_axis, set_neutral_axis: 68, 6;
    /// Axis/spindle replacement: 1 = PLC axis.
    bool, plc_axis, set_plc_axis: 68, 7;
    /// Active controller parameter set, binary.
    u8, active_controller_parameter_set, set_active_controller_parameter_set: 69, 2 to 0;
    /// REPOS offset: 1 = an offset exists.
    bool, repos_offset, set_repos_offset: 70, 0;
    /// REPOS offset valid: 1 = yes.
    bool, repos_offset_valid, set_repos_offset_valid: 70, 1;
    /// REPOS delay acknowledgement: 1 = acknowledged.
    bool, repos_delay_acknowledgement, set_repos_delay_acknowledgement: 70, 2;
    /// Position restored, encoder 1: 1 = restored after power on (MD34210 = 3).
    bool, position_restored_1, set_position_restored_1: 71, 4;
    /// Position restored, encoder 2: 1 = restored after power on (MD34210 = 3).
    bool, position_restored_2, set_position_restored_2: 71, 5;
    /// REPOS delay: 1 = active.
    bool, repos_delay, set_repos_delay: 72, 0;
    /// Modulo rotary axis: 1 = its traversing range limits are active.
    bool, modulo_limits_active, set_modulo_limits_active: 74, 4;
    /// JOG approach fixed point active: its number, binary.
    u8, jog_approach_fixed_point_active, set_jog_approach_fixed_point_active: 75, 2 to 0;
    /// JOG fixed point reached: its number, binary.
    u8, jog_approach_fixed_point_reached, set_jog_approach_fixed_point_reached: 75, 5 to 3;
    /// JOG approach position active: 1 = yes.
    bool, jog_approach_position_active, set_jog_approach_position_active: 75, 6;
    /// JOG position reached: 1 = yes.
    bool, jog_position_reached, set_jog_position_reached: 75, 7;
    /// Lubrication pulse: changes its value after each lubrication distance.
    bool, lubrication_pulse, set_lubrication_pulse: 76, 0;
    /// Path axis: 1 = yes.
    bool, path_axis, set_path_axis: 76, 4;
    /// Positioning axis: 1 = yes.
    bool, positioning_axis, set_positioning_axis: 76, 5;
    /// Indexing axis in position: 1 = yes.
    bool, indexing_axis_in_position, set_indexing_axis_in_position: 76, 6;
    /// Rotary axis in position: 1 = yes.
    bool, rotary_axis_in_position, set_rotary_axis_in_position: 76, 7;
    /// Setpoint gear stage, binary.
    u8, setpoint_gear_stage, set_setpoint_gear_stage: 82, 2 to 0;
    /// Change gear stage: 1 = a new gear stage is requested.
    bool, change_gear_stage, set_change_gear_stage: 82, 3;
    /// Speed limit exceeded: 1 = yes.
    bool, speed_limit_exceeded, set_speed_limit_exceeded: 83, 0;
    /// Setpoint speed limited: 1 = yes.
    bool, setpoint_speed_limited, set_setpoint_speed_limited: 83, 1;
    /// Setpoint speed increased: 1 = yes.
    bool, setpoint_speed_increased, set_setpoint_speed_increased: 83, 2;
    /// Spindle in setpoint range: 1 = yes.
    bool, spindle_in_setpoint_range, set_spindle_in_setpoint_range: 83, 5;
    /// Actual direction of rotation clockwise: 1 = yes.
    bool, actual_direction_of_rotation_clockwise, set_actual_direction_of_rotation_clockwise: 83, 7;
    /// Tapping without compensating chuck: 1 = active.
    bool, tapping_without_compensating_chuck, set_tapping_without_compensating_chuck: 84, 3;
    /// Synchronous mode: 1 = active.
    bool, synchronous_mode, set_synchronous_mode: 84, 4;
    /// Positioning mode: 1 = active.
    bool, positioning_mode, set_positioning_mode: 84, 5;
    /// Oscillation mode: 1 = active.
    bool, oscillation_mode, set_oscillation_mode: 84, 6;
    /// Control mode: 1 = active.
    bool, control_mode, set_control_mode: 84, 7;
    /// Spindle in position: 1 = yes.
    bool, spindle_in_position, set_spindle_in_position: 85, 5;
    /// Ramp-function generator disable active: 1 = yes.
    bool, ramp_function_generator_disable_active, set_ramp_function_generator_disable_active: 92, 1;
    /// Drive-autonomous motion active: 1 = yes.
    bool, drive_autonomous_motion_active, set_drive_autonomous_motion_active: 92, 4;
    /// Holding brake open: 1 = the brake of the motor is open; 0 = it holds, or the motor has none.
    bool, holding_brake_open, set_holding_brake_open: 92, 5;
    /// Active motor and drive data set, binary.
    u8, active_drive_data_set, set_active_drive_data_set: 93, 4 to 0;
    /// Drive ready: 1 = the drive can be enabled.
    bool, drive_ready, set_drive_ready: 93, 5;
    /// Speed controller integrator disabled: 1 = yes.
    bool, speed_controller_integrator_disabled, set_speed_controller_integrator_disabled: 93, 6;
    /// Pulses enabled: 1 = the drive has torque.
    bool, pulses_enabled, set_pulses_enabled: 93, 7;
    /// Motor temperature prewarning: 1 = too hot.
    bool, motor_temperature_prewarning, set_motor_temperature_prewarning: 94, 0;
    /// Heat sink temperature prewarning: 1 = too hot.
    bool, heat_sink_temperature_prewarning, set_heat_sink_temperature_prewarning: 94, 1;
    /// Run-up completed: 1 = yes.
    bool, run_up_completed, set_run_up_completed: 94, 2;
    /// Torque below its threshold, |Md| < Mdx: 1 = yes.
    bool, torque_below_threshold, set_torque_below_threshold: 94, 3;
    /// Speed below its minimum, |n| < nmin: 1 = yes.
    bool, speed_below_minimum, set_speed_below_minimum: 94, 4;
    /// Speed below its threshold, |n| < nx: 1 = yes.
    bool, speed_below_threshold, set_speed_below_threshold: 94, 5;
    /// Actual speed equals setpoint speed: 1 = yes.
    bool, actual_speed_equals_setpoint_speed, set_actual_speed_equals_setpoint_speed: 94, 6;
    /// Variable signal function: 1 = its threshold is exceeded.
    bool, variable_signal_function, set_variable_signal_function: 94, 7;
    /// Extended stop and retract: 1 = undervoltage of the DC link.
    bool, dc_link_undervoltage, set_dc_link_undervoltage: 95, 1;
    /// Extended stop and retract: 1 = triggered, or generator mode active.
    bool, extended_stop_and_retract_response, set_extended_stop_and_retract_response: 95, 2;
    /// Extended stop and retract: 1 = the speed of the generator is too low.
    bool, generator_minimum_speed_fallen_below, set_generator_minimum_speed_fallen_below: 95, 3;
    /// Warning of alarm class C pending in the drive: 1 = yes.
    bool, alarm_class_c_pending, set_alarm_class_c_pending: 95, 7;
    /// Fine synchronous operation: 1 = yes; for couplings other than gantry.
    bool, fine_synchronous_operation, set_fine_synchronous_operation: 98, 0;
    /// Coarse synchronous operation: 1 = yes; for couplings other than gantry.
    bool, coarse_synchronous_operation, set_coarse_synchronous_operation: 98, 1;
    /// Actual value coupling: 1 = yes.
    bool, actual_value_coupling, set_actual_value_coupling: 98, 2;
    /// Overlaid motion: 1 = yes.
    bool, overlaid_motion, set_overlaid_motion: 98, 4;
    /// Velocity alarm threshold reached: 1 = yes.
    bool, velocity_alarm_threshold_reached, set_velocity_alarm_threshold_reached: 98, 5;
    /// Acceleration alarm threshold reached: 1 = yes.
    bool, acceleration_alarm_threshold_reached, set_acceleration_alarm_threshold_reached: 98, 6;
    /// Leading spindle active: 1 = yes.
    bool, leading_spindle_active, set_leading_spindle_active: 99, 0;
    /// Following spindle active: 1 = yes.
    bool, following_spindle_active, set_following_spindle_active: 99, 1;
    /// Axis accelerates: 1 = yes.
    bool, axis_accelerates, set_axis_accelerates: 99, 3;
    /// Oscillation reversal active: 1 = yes.
    bool, oscillation_reversal_active, set_oscillation_reversal_active: 100, 2;
    /// Oscillation cannot start: 1 = yes.
    bool, oscillation_cannot_start, set_oscillation_cannot_start: 100, 3;
    /// Error during oscillation: 1 = yes.
    bool, oscillation_error, set_oscillation_error: 100, 4;
    /// Sparking-out active: 1 = yes.
    bool, sparking_out_active, set_sparking_out_active: 100, 5;
    /// Oscillation motion active: 1 = yes.
    bool, oscillation_motion_active, set_oscillation_motion_active: 100, 6;
    /// Oscillation active: 1 = yes.
    bool, oscillation_active, set_oscillation_active: 100, 7;
    /// Gantry trip limit exceeded: 1 = yes; reported on the synchronized axis.
    bool, gantry_trip_limit_exceeded, set_gantry_trip_limit_exceeded: 101, 2;
    /// Gantry warning limit exceeded: 1 = yes; reported on the synchronized axis.
    bool, gantry_warning_limit_exceeded, set_gantry_warning_limit_exceeded: 101, 3;
    /// Gantry synchronization ready to start: 1 = the synchronization run can be started; reported on the leading axis.
    bool, gantry_synchronization_ready_to_start, set_gantry_synchronization_ready_to_start: 101, 4;
    /// Gantry grouping is synchronized: 1 = yes; reported on the leading axis.
    bool, gantry_grouping_is_synchronized, set_gantry_grouping_is_synchronized: 101, 5;
    /// Gantry leading axis: 1 on the leading axis, 0 on a synchronized axis.
    bool, gantry_leading_axis, set_gantry_leading_axis: 101, 6;
    /// Gantry axis: 1 on all axes of a grouping.
    bool, gantry_axis, set_gantry_axis: 101, 7;
    /// Position measuring system 1 activated: 1 = yes.
    bool, position_measuring_system_1_activated, set_position_measuring_system_1_activated: 102, 5;
    /// Position measuring system 2 activated: 1 = yes.
    bool, position_measuring_system_2_activated, set_position_measuring_system_2_activated: 102, 6;
    /// FC 18: 1 = the axis cannot be started; its error number says why.
    bool, positioning_not_started, set_positioning_not_started: 104, 0;
    /// FC 18: 1 = an error while traversing; its error number says which.
    bool, positioning_error, set_positioning_error: 104, 1;
    /// FC 18: 1 = position reached, with exact stop fine.
    bool, position_reached, set_position_reached: 104, 6;
    /// FC 18: 1 = the PLC positions the axis.
    bool, positioning_active, set_positioning_active: 104, 7;
    /// FC 18: error number; 0 without an error.
    u8, positioning_error_number, set_positioning_error_number: 107, 7 to 0;

    numbers {
        /// F function of the positioning axis: its feedrate; kept until overwritten.
        f32, positioning_axis_f_function, set_positioning_axis_f_function: 78;
        /// M function of the spindle, binary.
        u16, spindle_m_function, set_spindle_m_function: 86;
        /// S function of the spindle: its speed.
        f32, spindle_s_function, set_spindle_s_function: 88;
    }
}
