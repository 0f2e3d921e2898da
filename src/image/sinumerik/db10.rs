//! DB10: the NCK as a whole. The PLC writes bytes 56 and 57, the HMI 97 to 103, the NCK 68 to 96 and 104 to 109.

use crate::image::table::signals;

signals! {
    /// DB10 bytes 56 and 57: signals from the PLC to the NCK.
    pub struct NckToNck, nck_to_nck: Nck, Plc, 56 to 57;

    /// Emergency stop: 1 starts the emergency stop sequence of the NCK.
    bool, emergency_stop, set_emergency_stop: 56, 1;
    /// Acknowledge emergency stop: 1 together with mode group reset and emergency stop = 0 ends the emergency stop.
    bool, acknowledge_emergency_stop, set_acknowledge_emergency_stop: 56, 2;
    /// Key-operated switch position 0: 1 = the switch is in this position.
    bool, key_operated_switch_position_0, set_key_operated_switch_position_0: 56, 4;
    /// Key-operated switch position 1: 1 = the switch is in this position.
    bool, key_operated_switch_position_1, set_key_operated_switch_position_1: 56, 5;
    /// Key-operated switch position 2: 1 = the switch is in this position.
    bool, key_operated_switch_position_2, set_key_operated_switch_position_2: 56, 6;
    /// Key-operated switch position 3: 1 = the switch is in this position.
    bool, key_operated_switch_position_3, set_key_operated_switch_position_3: 56, 7;
    /// INC inputs active in mode group area: 1 = DB11 byte 2 sets the increment for all axes; 0 = only the bytes of the channels and axes
    /// are effective.
    bool, increment_inputs_active_in_mode_group_area, set_increment_inputs_active_in_mode_group_area: 57, 0;
}

signals! {
    /// DB10 bytes 68 to 109: signals from the NCK to the PLC. Bytes 97 to 103 in between belong to the HMI, see [`NckHmi`].
    pub struct NckFromNck, nck_from_nck: Nck, Nck, 68 to 109;

    /// Handwheel 1 moved: counter of its pulses, signed (two's complement), overflows at 127 and -128.
    u8, handwheel_1_moved, set_handwheel_1_moved: 68, 7 to 0;
    /// Handwheel 2 moved: counter of its pulses, like handwheel 1.
    u8, handwheel_2_moved, set_handwheel_2_moved: 69, 7 to 0;
    /// Handwheel 3 moved: counter of its pulses, like handwheel 1.
    u8, handwheel_3_moved, set_handwheel_3_moved: 70, 7 to 0;
    /// NC CPU ready: 1 = the NCK sends its sign of life to the PLC.
    bool, nc_cpu_ready, set_nc_cpu_ready: 104, 7;
    /// Emergency stop active: 1 from the cycle in which the NCK accepts the emergency stop until it is acknowledged.
    bool, emergency_stop_active, set_emergency_stop_active: 106, 1;
    /// Probe 1 actuated: 1 = deflected.
    bool, probe_1_actuated, set_probe_1_actuated: 107, 0;
    /// Probe 2 actuated: 1 = deflected.
    bool, probe_2_actuated, set_probe_2_actuated: 107, 1;
    /// NCU link active: 1 = the link between NCUs is active.
    bool, ncu_link_active, set_ncu_link_active: 107, 6;
    /// Inch measuring system active: 1 = inch, 0 = metric.
    bool, inch_measuring_system_active, set_inch_measuring_system_active: 107, 7;
    /// HMI ready at the operator panel interface: 1 = the HMI sends its sign of life.
    bool, operator_panel_ready, set_operator_panel_ready: 108, 3;
    /// Drives in cyclic operation: 1 = all drives exchange telegrams with the NCK.
    bool, drives_in_cyclic_operation, set_drives_in_cyclic_operation: 108, 5;
    /// Drives ready: 1 = all configured drives are ready.
    bool, drives_ready, set_drives_ready: 108, 6;
    /// NC ready: 0 during run-up and while an alarm with the reaction "NC not ready" is pending.
    bool, nc_ready, set_nc_ready: 108, 7;
    /// NCK alarm active: 1 = at least one alarm of the NCK is pending.
    bool, nc_alarm_active, set_nc_alarm_active: 109, 0;
    /// Heat sink temperature alarm: 1 = the NCU is too hot.
    bool, heat_sink_temperature_alarm, set_heat_sink_temperature_alarm: 109, 5;
    /// Air temperature alarm: 1 = the air in the cabinet is too hot, or the fan has failed.
    bool, air_temperature_alarm, set_air_temperature_alarm: 109, 6;
    /// NC battery alarm: 1 = the battery must be changed.
    bool, nc_battery_alarm, set_nc_battery_alarm: 109, 7;
}

signals! {
    /// DB10 bytes 97 to 103: signals from the HMI to the PLC.
    pub struct NckHmi, nck_hmi: Nck, Hmi, 97 to 103;

    /// Channel number of the geometry axis for handwheel 1, binary.
    u8, handwheel_1_channel_number, set_handwheel_1_channel_number: 97, 3 to 0;
    /// Channel number of the geometry axis for handwheel 2, binary.
    u8, handwheel_2_channel_number, set_handwheel_2_channel_number: 98, 3 to 0;
    /// Channel number of the geometry axis for handwheel 3, binary.
    u8, handwheel_3_channel_number, set_handwheel_3_channel_number: 99, 3 to 0;
    /// Axis number for handwheel 1, binary.
    u8, handwheel_1_axis_number, set_handwheel_1_axis_number: 100, 4 to 0;
    /// Handwheel 1 defined as contour handwheel: 1 = yes.
    bool, handwheel_1_contour_handwheel, set_handwheel_1_contour_handwheel: 100, 5;
    /// Handwheel 1 selected: 1 = yes.
    bool, handwheel_1_selected, set_handwheel_1_selected: 100, 6;
    /// Handwheel 1 for a machine axis: 1 = machine axis, 0 = geometry axis.
    bool, handwheel_1_machine_axis, set_handwheel_1_machine_axis: 100, 7;
    /// Axis number for handwheel 2, binary.
    u8, handwheel_2_axis_number, set_handwheel_2_axis_number: 101, 4 to 0;
    /// Handwheel 2 defined as contour handwheel: 1 = yes.
    bool, handwheel_2_contour_handwheel, set_handwheel_2_contour_handwheel: 101, 5;
    /// Handwheel 2 selected: 1 = yes.
    bool, handwheel_2_selected, set_handwheel_2_selected: 101, 6;
    /// Handwheel 2 for a machine axis: 1 = machine axis, 0 = geometry axis.
    bool, handwheel_2_machine_axis, set_handwheel_2_machine_axis: 101, 7;
    /// Axis number for handwheel 3, binary.
    u8, handwheel_3_axis_number, set_handwheel_3_axis_number: 102, 4 to 0;
    /// Handwheel 3 defined as contour handwheel: 1 = yes.
    bool, handwheel_3_contour_handwheel, set_handwheel_3_contour_handwheel: 102, 5;
    /// Handwheel 3 selected: 1 = yes.
    bool, handwheel_3_selected, set_handwheel_3_selected: 102, 6;
    /// Handwheel 3 for a machine axis: 1 = machine axis, 0 = geometry axis.
    bool, handwheel_3_machine_axis, set_handwheel_3_machine_axis: 102, 7;
    /// Remote diagnosis active: 1 = a remote station operates the control.
    bool, remote_diagnosis_active, set_remote_diagnosis_active: 103, 0;
    /// AT box ready: 1 = the expansion box of the operator panel is ready.
    bool, at_box_ready, set_at_box_ready: 103, 5;
    /// HMI temperature limit: 1 = the operator panel is too hot.
    bool, hmi_temperature_limit, set_hmi_temperature_limit: 103, 6;
    /// HMI battery alarm: 1 = the battery of the operator panel must be changed.
    bool, hmi_battery_alarm, set_hmi_battery_alarm: 103, 7;
}
