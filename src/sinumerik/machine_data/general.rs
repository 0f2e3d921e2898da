//! General machine data, `$MN_`: names, cycles, keys, handwheels, override switches.

use super::table::{Many, PerTable, machine_data};

machine_data! {
/// The machine data of the whole NC.
General {
    /// names of the machine axes; `AXn` stays valid beside them
    10000 AXCONF_MACHAX_NAME_TAB axconf_machax_name_tab: [String; 31] = default_axis_names(); "", Range::ANY, PowerOn;
    /// logical machine axes
    10002 AXCONF_LOGIC_MACHAX_TAB axconf_logic_machax_tab: [String; 31] = std::array::from_fn(|index| format!("AX{}", index + 1)); "", Range::ANY, PowerOn;
    /// mode group of each channel; 0 the channel does not exist
    10010 ASSIGN_CHAN_TO_MODE_GROUP assign_chan_to_mode_group: [i32; 10] = [1, 0, 0, 0, 0, 0, 0, 0, 0, 0]; "", Range::between(0.0, 10.0), PowerOn;
    /// basic system cycle
    10050 SYSCLOCK_CYCLE_TIME sysclock_cycle_time: f64 = 0.004; "s", Range::between(0.000_01, 1.0), PowerOn;
    /// position control cycle in basic system cycles
    10060 POSCTRL_SYSCLOCK_TIME_RATIO posctrl_sysclock_time_ratio: i32 = 1; "", Range::between(1.0, 31.0), PowerOn, read_only true;
    /// interpolation cycle in basic system cycles; one step of the simulator (O-22)
    10070 IPO_SYSCLOCK_TIME_RATIO ipo_sysclock_time_ratio: i32 = 3; "", Range::between(1.0, 100.0), PowerOn;
    /// longest wait for a gear change before a RESET or another event, alarm 16938
    10192 GEAR_CHANGE_WAIT_TIME gear_change_wait_time: f64 = 10.0; "s", Range::NOT_NEGATIVE, PowerOn;
    /// computational resolution of linear axes
    10200 INT_INCR_PER_MM int_incr_per_mm: f64 = 1_000.0; "1/mm", Range::POSITIVE, PowerOn;
    /// computational resolution of rotary axes
    10210 INT_INCR_PER_DEG int_incr_per_deg: f64 = 1_000.0; "1/deg", Range::POSITIVE, PowerOn;
    /// basic system of units: 1 metric, 0 inch: lengths of linear axes in inch, inch/min, inch/s2, inch/s3
    10240 SCALING_SYSTEM_IS_METRIC scaling_system_is_metric: bool = true; "", Range::ANY, PowerOn;
    /// millimetres in one inch
    10250 SCALING_VALUE_INCH scaling_value_inch: f64 = 25.4; "mm/inch", Range::POSITIVE, PowerOn;
    /// change of the dry run (DB21.DBX0.6) while a program runs: 0 at the end of a block, 1 at once with a short stop, 2 at the next STOPRE
    10704 DRYRUN_MASK dryrun_mask: u8 = 0; "", Range::between(0.0, 2.0), PowerOn;
    /// change of the skip levels (DB21.DBB2, 31.6, 31.7) while a program runs: 0 stopped at the end of a block, 1 at once with a short stop, 2 at the next STOPRE
    10706 SLASH_MASK slash_mask: u8 = 0; "", Range::between(0.0, 2.0), PowerOn;
    /// block search with program test; bit 0: no stop at M0; bit 1: START of another channel starts nothing, without 16942; bit 4: overrides are ignored
    10708 SERUPRO_MASK serupro_mask: u32 = 0; "", Range::ANY, PowerOn;
    /// M functions behind which preparation waits until everything has been executed; -1: none
    10713 M_NO_FCT_STOPRE m_no_fct_stopre: [i32; 15] = [-1; 15]; "", Range::ANY, PowerOn;
    /// M functions that a subprogram replaces; -1: none
    10715 M_NO_FCT_CYCLE m_no_fct_cycle: [i32; 30] = [-1; 30]; "", Range::ANY, PowerOn;
    /// names of the subprograms that replace the M functions of MD10715
    10716 M_NO_FCT_CYCLE_NAME m_no_fct_cycle_name: [String; 30] = std::array::from_fn(|_| String::new()); "", Range::ANY, PowerOn;
    /// mode of each mode group after power on: 0, 1 AUTOMATIC; 2 to 5 MDI; 6, 7 JOG; machine functions are selected by their signals (O-19)
    10720 OPERATING_MODE_DEFAULT operating_mode_default: [i32; 10] = [6; 10]; "", Range::between(0.0, 7.0), PowerOn;
    /// axis exchange; bit 0: another channel takes an axis automatically also after WAITP; bit 3: the PLC requests only exclusive or permanent
    /// PLC axes
    10722 AXCHANGE_MASK axchange_mask: u32 = 0; "", Range::ANY, PowerOn;
    /// settings of JOG
    10735 JOG_MODE_MASK jog_mode_mask: u32 = 0; "", Range::ANY, Reset;
    /// incremental JOG and reference point approach: 1 while the key is held, 0 from a press of the key on
    11300 JOG_INC_MODE_LEVELTRIGGRD jog_inc_mode_leveltriggrd: bool = true; "", Range::ANY, PowerOn;
    /// pulses of a handwheel per detent
    11320 HANDWH_IMP_PER_LATCH handwh_imp_per_latch: [f64; 6] = [1.0; 6]; "", Range::POSITION, PowerOn;
    /// sizes of the fixed increments
    11330 JOG_INCR_SIZE_TAB jog_incr_size_tab: [f64; 5] = [1.0, 10.0, 100.0, 1_000.0, 10_000.0]; "", Range::NOT_NEGATIVE, Reset;
    /// a handwheel gives 1 the distance, 0 the velocity
    11346 HANDWH_TRUE_DISTANCE handwh_true_distance: u8 = 1; "", Range::ANY, PowerOn;
    /// alarms that are suppressed; bit 29: 16772
    11410 SUPPRESS_ALARM_MASK suppress_alarm_mask: u32 = 0; "", Range::ANY, Reset;
    /// alarms that are enabled
    11411 ENABLE_ALARM_MASK enable_alarm_mask: u32 = 0; "", Range::ANY, Reset;
    /// an alarm resets ready of 1 its channel, 0 the mode group
    11412 ALARM_REACTION_CHAN_NOREADY alarm_reaction_chan_noready: bool = false; "", Range::ANY, PowerOn;
    /// block search; bit 0: after the last action block, 10208 waits for DB21.DBX1.6
    11450 SEARCH_RUN_MODE search_run_mode: u32 = 0; "", Range::ANY, PowerOn;
    /// bit 0: gaps in the channel axes (MD20070) are allowed; without it, power on raises 4000
    11640 ENABLE_CHAN_AX_GAP enable_chan_ax_gap: u32 = 0; "", Range::ANY, PowerOn;
    /// coding of the axial feed override: 1 Gray, 0 binary
    12000 OVR_AX_IS_GRAY_CODE ovr_ax_is_gray_code: bool = true; "", Range::ANY, PowerOn;
    /// axial feed override of each switch position
    12010 OVR_FACTOR_AX_SPEED ovr_factor_ax_speed: [f64; 31] = FEED_OVERRIDE; "factor", Range::NOT_NEGATIVE, PowerOn;
    /// coding of the path feed override: 1 Gray, 0 binary
    12020 OVR_FEED_IS_GRAY_CODE ovr_feed_is_gray_code: bool = true; "", Range::ANY, PowerOn;
    /// path feed override of each switch position
    12030 OVR_FACTOR_FEEDRATE ovr_factor_feedrate: [f64; 31] = FEED_OVERRIDE; "factor", Range::NOT_NEGATIVE, PowerOn;
    /// coding of the rapid traverse override: 1 Gray, 0 binary
    12040 OVR_RAPID_IS_GRAY_CODE ovr_rapid_is_gray_code: bool = true; "", Range::ANY, PowerOn;
    /// rapid traverse override of each switch position
    12050 OVR_FACTOR_RAPID_TRA ovr_factor_rapid_tra: [f64; 31] = FEED_OVERRIDE.map(|factor| factor.min(1.0)); "factor", Range::NOT_NEGATIVE, PowerOn;
    /// spindle override in Gray code; otherwise in binary
    12060 OVR_SPIND_IS_GRAY_CODE ovr_spind_is_gray_code: bool = true; "", Range::ANY, PowerOn;
    /// spindle override for each position of the switch
    12070 OVR_FACTOR_SPIND_SPEED ovr_factor_spind_speed: [f64; 31] = SPINDLE_OVERRIDE; "factor", Range::NOT_NEGATIVE, PowerOn;
    /// limit of a binary coded override
    12100 OVR_FACTOR_LIMIT_BIN ovr_factor_limit_bin: f64 = 1.2; "factor", Range::NOT_NEGATIVE, PowerOn;
    /// how many of MD14510 are in DB20
    14504 MAXNUM_USER_DATA_INT maxnum_user_data_int: i32 = 0; "", Range::between(0.0, 256.0), PowerOn;
    /// how many of MD14512 are in DB20
    14506 MAXNUM_USER_DATA_HEX maxnum_user_data_hex: i32 = 0; "", Range::between(0.0, 256.0), PowerOn;
    /// how many of MD14514 are in DB20
    14508 MAXNUM_USER_DATA_FLOAT maxnum_user_data_float: i32 = 0; "", Range::between(0.0, 32.0), PowerOn;
    /// integers for the PLC program; the first 32 are in DB4500 of an 828D
    14510 USER_DATA_INT user_data_int: Many<i32, 256> = Many::default(); "", Range::between(-32_768.0, 32_767.0), PowerOn;
    /// bytes for the PLC program; the first 32 are in DB4500 of an 828D
    14512 USER_DATA_HEX user_data_hex: Many<u8, 256> = Many::default(); "", Range::ANY, PowerOn;
    /// REALs for the PLC program; the first 8 are in DB4500 of an 828D
    14514 USER_DATA_FLOAT user_data_float: Many<f64, 32> = Many::default(); "", Range::between(-3.4e38, 3.4e38), PowerOn;
    /// user alarms 700000 to 700247 of an 828D; bit 0: NC start disable; 1: read-in disable; 2: feed disable; 3: emergency stop; 4: PLC stop;
    /// 6: cleared by DB1600.DBX3000.0; 7: by power off
    14516 USER_DATA_PLC_ALARM user_data_plc_alarm: Many<u8, 248> = Many::default(); "", Range::ANY, PowerOn;
    /// interface signals; bit 0: the traverse commands 64.6 and 64.7 are output 0 with the request, 1 only while the axis may move
    17900 VDI_FUNCTION_MASK vdi_function_mask: u32 = 0; "", Range::ANY, PowerOn;
    /// points of each table $AN_CEC: at least (_MAX - _MIN) / _STEP + 1; 0 the table does not exist
    18342 MM_CEC_MAX_POINTS mm_cec_max_points: PerTable<i32> = PerTable::filled(0); "", Range::between(0.0, 2000.0), PowerOn;
}
scope General
}

/// The override switch with 23 positions; the remaining positions have the last value.
const FEED_OVERRIDE: [f64; 31] = [
    0.0, 0.01, 0.02, 0.04, 0.06, 0.08, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1,
    1.15, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2,
];

/// The spindle override switch has 15 positions from 50 %; the remaining positions have the last value.
const SPINDLE_OVERRIDE: [f64; 31] = [
    0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.15, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2,
    1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2, 1.2,
];

/// X1, Y1, Z1, A1, B1, C1, U1, V1, W1 and, as our own continuation, X2 and so on.
fn default_axis_names() -> [String; 31] {
    let letters = ["X", "Y", "Z", "A", "B", "C", "U", "V", "W"];
    std::array::from_fn(|index| format!("{}{}", letters[index % letters.len()], index / letters.len() + 1))
}
