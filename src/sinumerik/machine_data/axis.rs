//! Axis-specific machine data, `$MA_`: gantry, reference point, encoders, dynamics, monitoring.

use super::table::machine_data;

machine_data! {
/// The machine data of one axis.
Axis {
    /// output of setpoints: 0 simulation, 1 real; the plant defines whether the axis is simulated (E-26)
    30130 CTRLOUT_TYPE ctrlout_type: u8 = 0; "", Range::ANY, PowerOn;
    /// number of encoders; must be above 0 to reference an axis, also a simulated one
    30200 NUM_ENCS num_encs: u8 = 1; "", Range::between(0.0, 2.0), PowerOn;
    /// encoder type: 0 simulation, 1 raw signal, 2 square wave, 4 absolute
    30240 ENC_TYPE enc_type: [u8; 2] = [0; 2]; "", Range::ANY, PowerOn;
    /// corrections of the active encoder do not affect this one; 2 aligned, but not referenced
    30242 ENC_IS_INDEPENDENT enc_is_independent: [u8; 2] = [0; 2]; "", Range::ANY, NewConf;
    /// rotary axis; must be equal for all axes of a gantry grouping
    30300 IS_ROT_AX is_rot_ax: bool = false; "", Range::ANY, PowerOn;
    /// modulo rotary axis, whose software limits are inactive
    30310 ROT_IS_MODULO rot_is_modulo: bool = false; "", Range::ANY, PowerOn;
    /// position shown modulo 360 degrees
    30320 DISPLAY_IS_MODULO display_is_modulo: bool = false; "", Range::ANY, PowerOn;
    /// size of the modulo range
    30330 MODULO_RANGE modulo_range: f64 = 360.0; "deg", Range::INCREMENT, Reset;
    /// start of the modulo range
    30340 MODULO_RANGE_START modulo_range_start: f64 = 0.0; "deg", Range::POSITION, Reset;
    /// a simulated axis outputs its interface signals (E-26)
    30350 SIMU_AX_VDI_OUTPUT simu_ax_vdi_output: bool = false; "", Range::ANY, PowerOn;
    /// concurrent positioning axis; ignored with alarm 4300 on a synchronous axis
    30450 IS_CONCURRENT_POS_AX is_concurrent_pos_ax: bool = false; "", Range::ANY, Reset;
    /// bit 0: absolute positions of a modulo axis outside of 0 to 359.999 count modulo 360 degrees, without alarm 16830; bit 1: the reference of
    /// a rotary axis with distance-coded marks is within the modulo range; bit 2: G90 of a modulo axis takes the shortest way; bit 3: $VA_IM is
    /// the actual value, also with axis disable
    30455 MISC_FUNCTION_MASK misc_function_mask: u32 = 0; "", Range::ANY, Reset;
    /// bit 4: only the PLC moves the axis; bit 5: permanent PLC axis; bit 6: feed disable (6.0) does not act on a PLC axis; bit 7: 36.3
    /// "all axes stationary" leaves a PLC axis out
    30460 BASE_FUNCTION_MASK base_function_mask: u32 = 0; "", Range::ANY, PowerOn;
    /// indexing axis with a Hirth gear; not in a gantry grouping (10651, 14000), otherwise not modelled
    30505 HIRTH_IS_ACTIVE hirth_is_active: bool = false; "", Range::ANY, PowerOn;
    /// channel that owns the axis initially; must match within a grouping (10651, 30XX)
    30550 AXCONF_ASSIGN_MASTER_CHAN axconf_assign_master_chan: u8 = 0; "", Range::between(0.0, 10.0), PowerOn;
    /// a program names a neutral axis: 0 alarm, 1 it takes the axis like GET, 2 like GETD
    30552 AUTO_GET_TYPE auto_get_type: u8 = 1; "", Range::between(0.0, 2.0), PowerOn;
    /// the encoder is a linear scale
    31000 ENC_IS_LINEAR enc_is_linear: [bool; 2] = [false; 2]; "", Range::ANY, PowerOn;
    /// grating period of a linear scale
    31010 ENC_GRID_POINT_DIST enc_grid_point_dist: [f64; 2] = [0.01; 2]; "mm", Range::INCREMENT, PowerOn;
    /// lines per revolution
    31020 ENC_RESOL enc_resol: [i32; 2] = [2048; 2]; "1/rev", Range::ANY, PowerOn;
    /// pitch of the leadscrew
    31030 LEADSCREW_PITCH leadscrew_pitch: f64 = 10.0; "mm/rev", Range::INCREMENT, PowerOn;
    /// the encoder is mounted on the machine, not on the motor
    31040 ENC_IS_DIRECT enc_is_direct: [bool; 2] = [false; 2]; "", Range::ANY, PowerOn;
    /// denominator of the load gear
    31050 DRIVE_AX_RATIO_DENOM drive_ax_ratio_denom: [i32; 6] = [1; 6]; "", Range::ANY, PowerOn;
    /// numerator of the load gear
    31060 DRIVE_AX_RATIO_NUMERA drive_ax_ratio_numera: [i32; 6] = [1; 6]; "", Range::ANY, PowerOn;
    /// denominator of the measuring gear
    31070 DRIVE_ENC_RATIO_DENOM drive_enc_ratio_denom: [i32; 2] = [1; 2]; "", Range::ANY, PowerOn;
    /// numerator of the measuring gear
    31080 DRIVE_ENC_RATIO_NUMERA drive_enc_ratio_numera: [i32; 2] = [1; 2]; "", Range::ANY, PowerOn;
    /// one increment in the metric and in the inch system
    31090 JOG_INCR_WEIGHT jog_incr_weight: [f64; 2] = [0.001, 0.00254]; "mm, deg", Range::POSITION, Reset;
    /// largest velocity of the axis
    32000 MAX_AX_VELO max_ax_velo: f64 = 10_000.0, rotary 27.77; "mm/min", Range::POSITIVE, NewConf;
    /// velocity of keys with rapid traverse override
    32010 JOG_VELO_RAPID jog_velo_rapid: f64 = 10_000.0, rotary 27.77; "mm/min", Range::NOT_NEGATIVE, Reset;
    /// velocity of keys, where SD41110 (linear) or SD41130 (rotary) is 0
    32020 JOG_VELO jog_velo: f64 = 2_000.0, rotary 5.55; "mm/min", Range::NOT_NEGATIVE, Reset;
    /// velocity of a positioning axis without a programmed one
    32060 POS_AX_VELO pos_ax_velo: f64 = 10_000.0, rotary 27.77; "mm/min", Range::NOT_NEGATIVE, Reset;
    /// velocity of overlaid motion, as a share of JOG_VELO
    32070 CORR_VELO corr_velo: f64 = 50.0; "%", Range::NOT_NEGATIVE, Reset;
    /// largest increment of the handwheel; 0 unlimited
    32080 HANDWH_MAX_INCR_SIZE handwh_max_incr_size: f64 = 0.0; "mm, deg", Range::NOT_NEGATIVE, Reset;
    /// largest velocity that a handwheel adds to a path or a positioning (FD, FDA); 0 unlimited
    32082 HANDWH_MAX_INCR_VELO_SIZE handwh_max_incr_velo_size: f64 = 500.0; "mm/min", Range::NOT_NEGATIVE, Reset;
    /// conditions that abort (1) or interrupt (0) handwheel travel: bit 0 feed override, 1 spindle override, 2 feed stop, 3 clamping, 4
    /// controller enable, 5 pulse enable
    32084 HANDWH_STOP_COND handwh_stop_cond: u32 = 0xFF; "", Range::ANY, Reset;
    /// share of the JOG velocity for the overlay of a handwheel
    32090 HANDWH_VELO_OVERLAY_FACTOR handwh_velo_overlay_factor: f64 = 0.5; "factor", Range::NOT_NEGATIVE, Reset;
    /// -1 reverses the direction of travel relative to the mechanics at opening of the machine; position control stays stable
    32100 AX_MOTION_DIR ax_motion_dir: i32 = 1; "", Range::ANY, PowerOn;
    /// -1 reverses the direction of the encoder; if it differs from the mechanics at opening of the machine, the axis runs away
    32110 ENC_FEEDBACK_POL enc_feedback_pol: [i32; 2] = [1; 2]; "", Range::ANY, PowerOn;
    /// servo gain: 1 gives 1 mm following error at 1 m/min; multiplied by 16.6667 it is in 1/s; 0 opens the loop
    32200 POSCTRL_GAIN posctrl_gain: [f64; 6] = [1.0; 6]; "(m/min)/mm", Range::NOT_NEGATIVE, NewConf;
    /// rated output
    32250 RATED_OUTVAL rated_outval: f64 = 0.0; "%", Range::NOT_NEGATIVE, NewConf;
    /// rated motor speed
    32260 RATED_VELO rated_velo: f64 = 3_000.0; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// largest acceleration by dynamic mode; index 0 for JOG
    32300 MAX_AX_ACCEL max_ax_accel: [f64; 5] = [1.0; 5], rotary [2.77; 5]; "m/s2", Range::POSITIVE, NewConf;
    /// acceleration in JOG; 0 takes MD32300
    32301 JOG_MAX_ACCEL jog_max_accel: f64 = 0.0; "m/s2", Range::NOT_NEGATIVE, NewConf;
    /// factor of the acceleration by which an axis may change its velocity in one cycle at a corner of the path
    32310 MAX_ACCEL_OVL_FACTOR max_accel_ovl_factor: [f64; 5] = [1.2; 5]; "factor", Range::NOT_NEGATIVE, NewConf;
    /// axial jerk filter on, for every movement; a fast stop (enable lost, emergency stop, MD36600 = 1) bypasses it
    32400 AX_JERK_ENABLE ax_jerk_enable: bool = false; "", Range::ANY, NewConf;
    /// type of jerk filter; 2 is recommended; every type acts as 2, the moving average
    32402 AX_JERK_MODE ax_jerk_mode: u8 = 1; "", Range::ANY, NewConf;
    /// time constant of the jerk filter: the window of the average, at most 1000 cycles
    32410 AX_JERK_TIME ax_jerk_time: f64 = 0.001; "s", Range::NOT_NEGATIVE, NewConf;
    /// jerk limitation in JOG, referencing and of positioning axes; a fast stop bypasses it
    32420 JOG_AND_POS_JERK_ENABLE jog_and_pos_jerk_enable: bool = false; "", Range::ANY, Reset;
    /// largest jerk in JOG, referencing and of positioning axes; acceleration divided by it is the jerk time; 0 means no limit
    32430 JOG_AND_POS_MAX_JERK jog_and_pos_max_jerk: f64 = 100.0; "m/s3", Range::NOT_NEGATIVE, Reset;
    /// jerk limit of the axis on a path with SOFT
    32431 MAX_AX_JERK max_ax_jerk: f64 = 1_000.0; "m/s3", Range::POSITIVE, NewConf;
    /// backlash, active once the encoder is referenced; positive: the encoder leads the slide, as an encoder on the motor does
    32450 BACKLASH backlash: [f64; 2] = [0.0; 2]; "mm, deg", Range::POSITION, NewConf;
    /// factor of the backlash for each parameter set
    32452 BACKLASH_FACTOR backlash_factor: [f64; 6] = [1.0; 6]; "factor", Range::between(0.01, 100.0), NewConf;
    /// backlash: bit 0 the side of the play is kept over power off; bit 1 motion of sag and temperature compensation does not change it
    32454 BACKLASH_MODE backlash_mode: [u8; 2] = [0; 2]; "", Range::between(0.0, 3.0), NewConf;
    /// share of the speed feedforward; 1: at steady speed the following error is that of the balancing time alone
    32610 VELO_FFW_WEIGHT velo_ffw_weight: [f64; 6] = [1.0; 6]; "factor", Range::NOT_NEGATIVE, NewConf;
    /// feedforward: 0 off, 1 speed PT1, 2 torque PT1, 3 speed Tt, 4 torque Tt (2 and 4: only their speed part acts, balanced by MD32800);
    /// the default 0 is ours, so that a machine without archive shows v/Kv (real controls: 1 with MD32630 = 1)
    32620 FFW_MODE ffw_mode: u8 = 0; "", Range::between(0.0, 4.0), Reset;
    /// activation of the feedforward: 0 MD32620 alone; 1 and 2 FFWON of a part program, so that nothing switches it on in JOG and REF; the
    /// default 0 is ours
    32630 FFW_ACTIVATION_MODE ffw_activation_mode: u8 = 0; "", Range::between(0.0, 2.0), Reset;
    /// inertia for torque feedforward
    32650 AX_INERTIA ax_inertia: f64 = 0.0; "kgm2", Range::NOT_NEGATIVE, NewConf;
    /// leadscrew error compensation with the table $AA_ENC_COMP, active once the encoder is referenced
    32700 ENC_COMP_ENABLE enc_comp_enable: [bool; 2] = [false; 2]; "", Range::ANY, NewConf;
    /// sag compensation with the tables $AN_CEC of which this is the output axis
    32710 CEC_ENABLE cec_enable: bool = false; "", Range::ANY, NewConf;
    /// unit of the tables $AN_CEC: 1 metric; 0 is not modelled, lengths of tables are in mm
    32711 CEC_SCALING_SYSTEM_METRIC cec_scaling_system_metric: bool = true; "", Range::ANY, NewConf;
    /// largest sag compensation value, else alarm 20124
    32720 CEC_MAX_SUM cec_max_sum: f64 = 1.0; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// largest velocity by which sag compensation moves the axis, as a share of MD32000, else alarm 20125
    32730 CEC_MAX_VELO cec_max_velo: f64 = 10.0; "%", Range::between(0.0, 100.0), NewConf;
    /// temperature compensation: bit 0 independent of the position (SD43900), bit 1 dependent on it (SD43910, SD43920)
    32750 TEMP_COMP_TYPE temp_comp_type: u8 = 0; "", Range::ANY, NewConf;
    /// largest velocity by which temperature compensation moves the axis, as a share of MD32000
    32760 COMP_ADD_VELO_FACTOR comp_add_velo_factor: f64 = 0.01; "factor", Range::between(0.0, 0.1), NewConf;
    /// time constant of the closed current loop: balancing time of the feedforward modes 2 and 4
    32800 EQUIV_CURRCTRL_TIME equiv_currctrl_time: [f64; 6] = [0.0005; 6]; "s", Range::NOT_NEGATIVE, NewConf;
    /// time constant of the closed speed loop as set in the control: balancing time of the feedforward modes 1 and 3
    32810 EQUIV_SPEEDCTRL_TIME equiv_speedctrl_time: [f64; 6] = [0.008; 6]; "s", Range::NOT_NEGATIVE, NewConf;
    /// dynamic response adaptation: the setpoint is delayed by MD32910, also without feedforward
    32900 DYN_MATCH_ENABLE dyn_match_enable: bool = false; "", Range::ANY, NewConf;
    /// time constant of the adaptation: that of the slowest axis of the grouping minus that of this axis
    32910 DYN_MATCH_TIME dyn_match_time: [f64; 6] = [0.0; 6]; "s", Range::NOT_NEGATIVE, NewConf;
    /// fine interpolator, 2 cubic; equal in a grouping
    33000 FIPO_TYPE fipo_type: u8 = 2; "", Range::ANY, PowerOn;
    /// the axis has a reference cam; 0: the approach begins with the zero mark search in the direction of the key
    34000 REFP_CAM_IS_ACTIVE refp_cam_is_active: bool = true; "", Range::ANY, Reset;
    /// direction of the approach: 0 plus, 1 minus; the other key does not start
    34010 REFP_CAM_DIR_IS_MINUS refp_cam_dir_is_minus: bool = false; "", Range::ANY, Reset;
    /// velocity of the cam search
    34020 REFP_VELO_SEARCH_CAM refp_velo_search_cam: f64 = 5_000.0, rotary 13.88; "mm/min", Range::POSITIVE, Reset;
    /// largest distance to the cam, else alarm 20000
    34030 REFP_MAX_CAM_DIST refp_max_cam_dist: f64 = 10_000.0; "mm, deg", Range::NOT_NEGATIVE, Reset;
    /// creep velocity of the zero mark search, and of the synchronising motion (E-12)
    34040 REFP_VELO_SEARCH_MARKER refp_velo_search_marker: [f64; 2] = [300.0; 2], rotary [0.833; 2]; "mm/min", Range::POSITIVE, Reset;
    /// edge of the cam at which the zero mark search begins: 0 falling, 1 rising (E-19)
    34050 REFP_SEARCH_MARKER_REVERSE refp_search_marker_reverse: [bool; 2] = [false; 2]; "", Range::ANY, Reset;
    /// largest distance to the zero mark, else alarm 20002 (distance-coded: 20004)
    34060 REFP_MAX_MARKER_DIST refp_max_marker_dist: [f64; 2] = [20.0; 2]; "mm, deg", Range::NOT_NEGATIVE, Reset;
    /// velocity from the zero mark to the reference point
    34070 REFP_VELO_POS refp_velo_pos: f64 = 10_000.0, rotary 27.77; "mm/min", Range::POSITIVE, Reset;
    /// distance from the zero mark to the reference point
    34080 REFP_MOVE_DIST refp_move_dist: [f64; 2] = [-2.0; 2]; "mm, deg", Range::POSITION, Reset;
    /// added to MD34080; offset of absolute and distance-coded encoders, written by the control on calibration
    34090 REFP_MOVE_DIST_CORR refp_move_dist_corr: [f64; 2] = [0.0; 2]; "mm, deg", Range::POSITION, PowerOn;
    /// distance by which the zero mark search is delayed after the edge of the cam
    34092 REFP_CAM_SHIFT refp_cam_shift: [f64; 2] = [0.0; 2]; "mm, deg", Range::NOT_NEGATIVE, Reset;
    /// distance from the edge of the cam to the zero mark, displayed by the control
    34093 REFP_CAM_MARKER_DIST refp_cam_marker_dist: [f64; 2] = [0.0; 2]; "mm, deg", Range::POSITION, Immediate, read_only true;
    /// reference point value 1 to 4, selected by DBX2.4 to 2.7
    34100 REFP_SET_POS refp_set_pos: [f64; 4] = [0.0; 4]; "mm, deg", Range::POSITION, Reset;
    /// 1: all encoders are aligned to the one that was referenced
    34102 REFP_SYNC_ENCS refp_sync_encs: u8 = 0; "", Range::between(0.0, 1.0), Reset;
    /// referencing by external motion in follow-up
    34104 REFP_PERMITTED_IN_FOLLOWUP refp_permitted_in_followup: bool = false; "", Range::ANY, PowerOn;
    /// order of channel-specific referencing: -1 not required for NC start, 0 required but not started, n after all axes with n-1
    34110 REFP_CYCLE_NR refp_cycle_nr: i32 = 1; "", Range::between(-1.0, 31.0), Reset;
    /// 0 absolute encoder, or no approach; 1 zero mark; 2 BERO; 3 distance-coded; 5 BERO as the cam; 6 second encoder; 7 spindle; 8
    /// distance-coded over four marks
    34200 ENC_REFP_MODE enc_refp_mode: [u8; 2] = [1; 2]; "", Range::between(0.0, 8.0), PowerOn;
    /// absolute: 0 not calibrated, 1 enabled, 2 calibrated; incremental: 1 restoring enabled, 2 referenced and at standstill, 3 position
    /// restored
    34210 ENC_REFP_STATE enc_refp_state: [u8; 2] = [0; 2]; "", Range::between(0.0, 3.0), Immediate;
    /// number of turns that a rotary absolute encoder distinguishes
    34220 ENC_ABS_TURNS_MODULO enc_abs_turns_modulo: [i32; 2] = [4096; 2]; "rev", Range::between(1.0, 100000.0), PowerOn;
    /// serial number of the encoder; a change invalidates the calibration
    34230 ENC_SERIAL_NUMBER enc_serial_number: [i32; 2] = [0; 2]; "", Range::ANY, PowerOn;
    /// 0 ignores the serial number 0
    34232 EVERY_ENC_SERIAL_NUMBER every_enc_serial_number: [bool; 2] = [true; 2]; "", Range::ANY, PowerOn;
    /// basic distance of the fixed marks
    34300 ENC_REFP_MARKER_DIST enc_refp_marker_dist: [f64; 2] = [10.0; 2]; "mm, deg", Range::INCREMENT, PowerOn;
    /// difference of two mark distances
    34310 ENC_MARKER_INC enc_marker_inc: [f64; 2] = [0.02; 2]; "mm, deg", Range::INCREMENT, PowerOn;
    /// the scale counts in the opposite direction of the machine axis
    34320 ENC_INVERS enc_invers: [bool; 2] = [false; 2]; "", Range::ANY, PowerOn;
    /// absolute and distance-coded: 0 travels to MD34100, 1 stops where the position is known
    34330 REFP_STOP_AT_ABS_MARKER refp_stop_at_abs_marker: [bool; 2] = [false; 2]; "", Range::ANY, PowerOn;
    /// WAITENC takes the axis into account
    34800 WAIT_ENC_VALID wait_enc_valid: i32 = 0; "", Range::between(0.0, 1.0), Reset;
    /// spindle that is assigned to the machine axis; 0 for an axis
    35000 SPIND_ASSIGN_TO_MACHAX spind_assign_to_machax: u8 = 0; "", Range::between(0.0, 31.0), PowerOn;
    /// gear stages: bit 0 changed anywhere, bit 1 changed at the position of MD35012, bit 3 the dialogue with the PLC is simulated; 0 none
    35010 GEAR_STEP_CHANGE_ENABLE gear_step_change_enable: u32 = 0; "", Range::ANY, Reset;
    /// position for a gear change, by gear stage
    35012 GEAR_STEP_CHANGE_POSITION gear_step_change_position: [f64; 6] = [0.0; 6]; "deg", Range::POSITION, NewConf;
    /// mode after power on, start and RESET: 0 speed control, 1 position control, 2 positioning, 3 axis
    35020 SPIND_DEFAULT_MODE spind_default_mode: u8 = 0; "", Range::between(0.0, 3.0), Reset;
    /// bit 19: SPOS and SPOSA output M19
    35035 SPIND_FUNCTION_MASK spind_function_mask: u32 = 0x110; "", Range::ANY, Reset;
    /// 1: RESET and program end do not stop the spindle
    35040 SPIND_ACTIVE_AFTER_RESET spind_active_after_reset: u8 = 0; "", Range::between(0.0, 2.0), PowerOn;
    /// number of gear stages
    35090 NUM_GEAR_STEPS num_gear_steps: i32 = 5; "", Range::between(0.0, 5.0), Reset;
    /// largest speed of the spindle, alarm 22100
    35100 SPIND_VELO_LIMIT spind_velo_limit: f64 = 10_000.0; "rev/min", Range::NOT_NEGATIVE, PowerOn;
    /// largest speed at which M40 takes a gear stage
    35110 GEAR_STEP_MAX_VELO gear_step_max_velo: [f64; 6] = [500.0, 500.0, 1_000.0, 2_000.0, 4_000.0, 8_000.0]; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// smallest speed at which M40 takes a gear stage
    35120 GEAR_STEP_MIN_VELO gear_step_min_velo: [f64; 6] = [50.0, 50.0, 400.0, 800.0, 1_500.0, 3_000.0]; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// largest speed of a gear stage, DBX83.1
    35130 GEAR_STEP_MAX_VELO_LIMIT gear_step_max_velo_limit: [f64; 6] = [500.0, 500.0, 1_000.0, 2_000.0, 4_000.0, 8_000.0]; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// smallest speed of a gear stage, DBX83.2
    35140 GEAR_STEP_MIN_VELO_LIMIT gear_step_min_velo_limit: [f64; 6] = [5.0, 5.0, 10.0, 20.0, 40.0, 80.0]; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// tolerance of the spindle speed, DBX83.5 and 83.0; of the creep velocity in the zero mark search
    35150 SPIND_DES_VELO_TOL spind_des_velo_tol: f64 = 0.1; "factor", Range::NOT_NEGATIVE, Reset;
    /// speed limit while the PLC sets DBX3.6
    35160 SPIND_EXTERN_VELO_LIMIT spind_extern_velo_limit: f64 = 1_000.0; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// acceleration in speed control, by gear stage
    35200 GEAR_STEP_SPEEDCTRL_ACCEL gear_step_speedctrl_accel: [f64; 6] = [30.0, 30.0, 25.0, 20.0, 15.0, 10.0]; "rev/s2", Range::POSITIVE, NewConf;
    /// acceleration in position control, by gear stage
    35210 GEAR_STEP_POSCTRL_ACCEL gear_step_posctrl_accel: [f64; 6] = [30.0, 30.0, 25.0, 20.0, 15.0, 10.0]; "rev/s2", Range::POSITIVE, NewConf;
    /// speed of positioning, by gear stage
    35300 SPIND_POSCTRL_VELO spind_posctrl_velo: [f64; 6] = [500.0; 6]; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// direction of positioning from standstill without a reference: 3 plus, 4 minus
    35350 SPIND_POSITIONING_DIR spind_positioning_dir: u8 = 3; "", Range::between(3.0, 4.0), Reset;
    /// speed of oscillation
    35400 SPIND_OSCILL_DES_VELO spind_oscill_des_velo: f64 = 500.0; "rev/min", Range::NOT_NEGATIVE, NewConf;
    /// acceleration of oscillation
    35410 SPIND_OSCILL_ACCEL spind_oscill_accel: f64 = 16.0; "rev/s2", Range::POSITIVE, NewConf;
    /// first direction of oscillation: 0 as before, 3 clockwise, 4 counterclockwise
    35430 SPIND_OSCILL_START_DIR spind_oscill_start_dir: u8 = 0; "", Range::between(0.0, 4.0), Reset;
    /// time of oscillation clockwise
    35440 SPIND_OSCILL_TIME_CW spind_oscill_time_cw: f64 = 1.0; "s", Range::NOT_NEGATIVE, NewConf;
    /// time of oscillation counterclockwise
    35450 SPIND_OSCILL_TIME_CCW spind_oscill_time_ccw: f64 = 0.5; "s", Range::NOT_NEGATIVE, NewConf;
    /// the path of a block with a feed waits for DBX83.5: 1 at the beginning of the block
    35500 SPIND_ON_SPEED_AT_IPO_START spind_on_speed_at_ipo_start: u8 = 1; "", Range::between(0.0, 3.0), Reset;
    /// window of exact stop coarse, DBX60.6
    36000 STOP_LIMIT_COARSE stop_limit_coarse: f64 = 0.04; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// window of exact stop fine, DBX60.7
    36010 STOP_LIMIT_FINE stop_limit_fine: f64 = 0.01; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// multiplies MD36000, MD36010 and MD36030
    36012 STOP_LIMIT_FACTOR stop_limit_factor: [f64; 6] = [1.0; 6]; "factor", Range::NOT_NEGATIVE, NewConf;
    /// time to exact stop fine, else alarm 25080
    36020 POSITIONING_TIME positioning_time: f64 = 1.0; "s", Range::NOT_NEGATIVE, NewConf;
    /// standstill tolerance (25040), also the window of the automatic gantry synchronisation outside REF
    36030 STANDSTILL_POS_TOL standstill_pos_tol: f64 = 0.2; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// delay of the standstill monitoring
    36040 STANDSTILL_DELAY_TIME standstill_delay_time: f64 = 0.4; "s", Range::NOT_NEGATIVE, NewConf;
    /// delay of the standstill monitoring with force control
    36042 FOC_STANDSTILL_DELAY_TIME foc_standstill_delay_time: f64 = 0.4; "s", Range::NOT_NEGATIVE, NewConf;
    /// clamping tolerance, alarm 26000
    36050 CLAMP_POS_TOL clamp_pos_tol: f64 = 0.5; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// special functions of a clamped axis
    36052 STOP_ON_CLAMPING stop_on_clamping: u8 = 0; "", Range::ANY, NewConf;
    /// velocity below which the axis counts as stationary, DBX61.4
    36060 STANDSTILL_VELO_TOL standstill_velo_tol: f64 = 5.0, rotary 0.0138; "mm/min", Range::NOT_NEGATIVE, NewConf;
    /// first software limit switch minus
    36100 POS_LIMIT_MINUS pos_limit_minus: f64 = -1e8; "mm, deg", Range::POSITION, NewConf;
    /// first software limit switch plus
    36110 POS_LIMIT_PLUS pos_limit_plus: f64 = 1e8; "mm, deg", Range::POSITION, NewConf;
    /// second software limit switch minus, selected by DBX12.2
    36120 POS_LIMIT_MINUS2 pos_limit_minus2: f64 = -1e8; "mm, deg", Range::POSITION, NewConf;
    /// second software limit switch plus, selected by DBX12.3
    36130 POS_LIMIT_PLUS2 pos_limit_plus2: f64 = 1e8; "mm, deg", Range::POSITION, NewConf;
    /// velocity monitoring, alarm 25030; 10 to 15 % above MD32000
    36200 AX_VELO_LIMIT ax_velo_limit: [f64; 6] = [11_500.0; 6], rotary [31.94; 6]; "mm/min", Range::NOT_NEGATIVE, NewConf;
    /// largest speed setpoint
    36210 CTRLOUT_LIMIT ctrlout_limit: f64 = 110.0; "%", Range::NOT_NEGATIVE, NewConf;
    /// delay of the speed setpoint monitoring, alarm 25060
    36220 CTRLOUT_LIMIT_TIME ctrlout_limit_time: f64 = 0.0; "s", Range::NOT_NEGATIVE, NewConf;
    /// frequency limit of the encoder, DBX60.2 and 60.3, alarm 21610
    36300 ENC_FREQ_LIMIT enc_freq_limit: [f64; 2] = [300_000.0; 2]; "Hz", Range::NOT_NEGATIVE, PowerOn;
    /// share of MD36300 below which the encoder operates again
    36302 ENC_FREQ_LIMIT_LOW enc_freq_limit_low: [f64; 2] = [99.9; 2]; "%", Range::NOT_NEGATIVE, NewConf;
    /// zero mark monitoring: 0 off, below 100 alarms 25000 and 25001, 100 all encoder monitoring off, above 25010 and 25011
    36310 ENC_ZERO_MONITORING enc_zero_monitoring: [i32; 2] = [0; 2]; "", Range::ANY, NewConf;
    /// contour monitoring, alarm 25050
    36400 CONTOUR_TOL contour_tol: f64 = 1.0; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// largest jump at an encoder switch-over, alarm 25100; below MD37110 (REF-28)
    36500 ENC_CHANGE_TOL enc_change_tol: f64 = 0.1; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// largest difference of two encoders, alarm 25105; 0 off
    36510 ENC_DIFF_TOL enc_diff_tol: f64 = 0.0; "mm, deg", Range::NOT_NEGATIVE, NewConf;
    /// limit of the setpoint velocity
    36520 DES_VELO_LIMIT des_velo_limit: f64 = 125.0; "%", Range::NOT_NEGATIVE, NewConf;
    /// at a hardware limit switch: 0 brakes along MD32300, 1 setpoint 0
    36600 BRAKE_MODE_CHOICE brake_mode_choice: u8 = 1; "", Range::between(0.0, 1.0), NewConf;
    /// time of the fast braking ramp from the largest velocity
    36610 AX_EMERGENCY_STOP_TIME ax_emergency_stop_time: f64 = 0.05; "s", Range::NOT_NEGATIVE, NewConf;
    /// delay of the controller switch-off; not below MD36610
    36620 SERVO_DISABLE_DELAY_TIME servo_disable_delay_time: f64 = 0.1; "s", Range::NOT_NEGATIVE, NewConf;
    /// signals of the drive that are passed on
    36730 DRIVE_SIGNAL_TRACKING drive_signal_tracking: u8 = 0; "", Range::ANY, PowerOn;
    /// units digit: grouping 1 to 8, 0 none; tens digit: 0 leading, 1 synchronous axis; checked at power on (10650, 10651)
    37100 GANTRY_AXIS_TYPE gantry_axis_type: u8 = 0; "", Range::ANY, PowerOn;
    /// warning limit, alarm 10652 and DBX101.3; 0: no warning and no automatic start
    37110 GANTRY_POS_TOL_WARNING gantry_pos_tol_warning: f64 = 0.0; "mm, deg", Range::NOT_NEGATIVE, Reset;
    /// trip limit while synchronised, alarm 10653 and DBX101.2
    37120 GANTRY_POS_TOL_ERROR gantry_pos_tol_error: f64 = 0.0; "mm, deg", Range::NOT_NEGATIVE, PowerOn;
    /// trip limit while not synchronised
    37130 GANTRY_POS_TOL_REF gantry_pos_tol_ref: f64 = 0.0; "mm, deg", Range::NOT_NEGATIVE, PowerOn;
    /// difference at alarm 10653 with extended monitoring; not 0 after power on: alarm 10657; cleared by writing 0
    37135 GANTRY_ACT_POS_TOL_ERROR gantry_act_pos_tol_error: f64 = 0.0; "mm, deg", Range::POSITION, Reset;
    /// 1 opens the coupling (E-07)
    37140 GANTRY_BREAK_UP gantry_break_up: bool = false; "", Range::ANY, NewConf;
    /// bit 0 extended monitoring, bit 1 zero mark search of the synchronous axis in the direction of the leading one, bit 2 no alarm 10655
    37150 GANTRY_FUNCTION_MASK gantry_function_mask: u32 = 0; "", Range::ANY, Reset;
    /// points of the table $AA_ENC_COMP of each encoder: at least (_MAX - _MIN) / _STEP + 1
    38000 MM_ENC_COMP_MAX_POINTS mm_enc_comp_max_points: [i32; 2] = [0; 2]; "", Range::between(0.0, 5000.0), PowerOn;
}
scope Axis
}
