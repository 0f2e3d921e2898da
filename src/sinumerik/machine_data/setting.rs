//! General setting data, `$SN_`: the operator's settings for JOG, and the tables of sag compensation.

use super::table::{PerTable, machine_data};

machine_data! {
/// The general setting data.
Setting {
    /// size of the variable increment, in units of MD31090
    41010 JOG_VAR_INCR_SIZE jog_var_incr_size: f64 = 0.0; "", Range::NOT_NEGATIVE, Immediate;
    /// keys in continuous JOG: 1 travel while held, 0 from one press to the next
    41050 JOG_CONT_MODE_LEVELTRIGGRD jog_cont_mode_leveltriggrd: bool = true; "", Range::ANY, Immediate;
    /// axes that travel with a revolutional feedrate in JOG
    41100 JOG_REV_IS_ACTIVE jog_rev_is_active: u8 = 0x0E; "", Range::ANY, Immediate;
    /// velocity of keys of linear axes; 0 takes MD32020
    41110 JOG_SET_VELO jog_set_velo: f64 = 0.0; "mm/min", Range::NOT_NEGATIVE, Immediate;
    /// velocity of keys of rotary axes; 0 takes MD32020
    41130 JOG_ROT_AX_SET_VELO jog_rot_ax_set_velo: f64 = 0.0; "rev/min", Range::NOT_NEGATIVE, Immediate;
    /// speed of keys of spindles; 0 takes MD32020
    41200 JOG_SPIND_SET_VELO jog_spind_set_velo: f64 = 0.0; "rev/min", Range::NOT_NEGATIVE, Immediate;
    /// the table $AN_CEC with this number is evaluated
    41300 CEC_TABLE_ENABLE cec_table_enable: PerTable<bool> = PerTable::filled(false); "", Range::ANY, Immediate;
    /// factor of the values of the table $AN_CEC with this number
    41310 CEC_TABLE_WEIGHT cec_table_weight: PerTable<f64> = PerTable::filled(1.0); "factor", Range::POSITION, Immediate;
}
scope Setting
}
