//! Channel-specific machine data, `$MC_`.

use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::table::{Field, Scalar, machine_data};
use crate::control::{Kind, Value};

machine_data! {
/// The machine data of one channel.
Channel {
    /// name of the channel
    20000 CHAN_NAME chan_name: String = "CHAN1".to_owned(); "", Range::ANY, PowerOn;
    /// number of the channel axis that is geometry axis 1 to 3; 0 none
    20050 AXCONF_GEOAX_ASSIGN_TAB axconf_geoax_assign_tab: [u8; 3] = [1, 2, 3]; "", Range::between(0.0, 20.0), PowerOn;
    /// names of the geometry axes
    20060 AXCONF_GEOAX_NAME_TAB axconf_geoax_name_tab: [String; 3] = ["X", "Y", "Z"].map(str::to_owned); "", Range::ANY, PowerOn;
    /// number of the machine axis of each channel axis; 0 none
    20070 AXCONF_MACHAX_USED axconf_machax_used: [u8; 20] = [1, 2, 3, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0]; "", Range::between(0.0, 31.0), PowerOn;
    /// names of the channel axes
    20080 AXCONF_CHANAX_NAME_TAB axconf_chanax_name_tab: [String; 20] = default_names(); "", Range::ANY, PowerOn;
    /// spindle that S and M functions without an extension concern
    20090 SPIND_DEF_MASTER_SPIND spind_def_master_spind: u8 = 1; "", Range::between(0.0, 31.0), Reset;
    /// function of each G group after power on, RESET and the end of a program; 0 takes the first
    20150 GCODE_RESET_VALUES gcode_reset_values: PerGroup = PerGroup::default(); "", Range::ANY, Reset;
    /// jerk limit of the path with SOFT
    20600 MAX_PATH_JERK max_path_jerk: f64 = 10_000.0; "m/s3", Range::POSITIVE, NewConf;
    /// NC start without reference: 0 allowed, 1 axes with MD34110 above -1 must be referenced (10203), 2 a restored position is sufficient
    /// in MDI and overstore
    20700 REFP_NC_START_LOCK refp_nc_start_lock: u8 = 1; "", Range::between(0.0, 2.0), Reset;
    /// rapid traverse: 1 the axes of a block move on a straight line, 0 each axis alone
    20730 G0_LINEAR_MODE g0_linear_mode: bool = true; "", Range::ANY, PowerOn;
    /// output to the PLC; bit 0: M17 or M30 of a subprogram; bit 1: M1 only while DB21.DBX0.5 = 1
    20800 SPF_END_TO_VDI spf_end_to_vdi: u8 = 0; "", Range::ANY, PowerOn;
    /// bit 0: SPOS and SPOSA output M19
    20850 SPOS_TO_VDI spos_to_vdi: u8 = 0; "", Range::ANY, PowerOn;
    /// largest difference of the radii at the start and at the end of a circle (14040)
    21000 CIRCLE_ERROR_CONST circle_error_const: f64 = 0.01; "mm", Range::NOT_NEGATIVE, PowerOn;
    /// the same as a share of the radius; the greater of both acts
    21010 CIRCLE_ERROR_FACTOR circle_error_factor: f64 = 0.001; "factor", Range::NOT_NEGATIVE, PowerOn;
    /// group of an auxiliary function of the user; 1 is not collected by a block search
    22000 AUXFU_ASSIGN_GROUP auxfu_assign_group: [u8; 32] = [1; 32]; "", Range::between(1.0, 168.0), PowerOn;
    /// type of an auxiliary function of the user: M, S, T, D, DL, H or F; empty: no entry
    22010 AUXFU_ASSIGN_TYPE auxfu_assign_type: [String; 32] = std::array::from_fn(|_| String::new()); "", Range::ANY, PowerOn;
    /// extension of an auxiliary function of the user; below 0: any
    22020 AUXFU_ASSIGN_EXTENSION auxfu_assign_extension: [i32; 32] = [0; 32]; "", Range::ANY, PowerOn;
    /// value of an auxiliary function of the user; below 0: any
    22030 AUXFU_ASSIGN_VALUE auxfu_assign_value: [i32; 32] = [0; 32]; "", Range::ANY, PowerOn;
    /// quick auxiliary functions (QU): 0 the block change waits for their acknowledgement, 1 it does not
    22100 AUXFU_QUICK_BLOCKCHANGE auxfu_quick_blockchange: i32 = 0; "", Range::between(0.0, 1.0), PowerOn;
    /// H functions: 0 REAL, 1 DINT in DB21
    22110 AUXFU_H_TYPE_INT auxfu_h_type_int: i32 = 0; "", Range::ANY, PowerOn;
    /// output of M functions: 0 before the motion, 1 with it, 2 at the end of the block, 3 none, 4 as predefined
    22200 AUXFU_M_SYNC_TYPE auxfu_m_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// output of S functions, as MD22200
    22210 AUXFU_S_SYNC_TYPE auxfu_s_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// output of T functions, as MD22200
    22220 AUXFU_T_SYNC_TYPE auxfu_t_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// output of H functions, as MD22200
    22230 AUXFU_H_SYNC_TYPE auxfu_h_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// output of F functions, as MD22200
    22240 AUXFU_F_SYNC_TYPE auxfu_f_sync_type: u8 = 3; "", Range::ANY, PowerOn;
    /// output of D functions, as MD22200
    22250 AUXFU_D_SYNC_TYPE auxfu_d_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// output of DL functions, as MD22200
    22252 AUXFU_DL_SYNC_TYPE auxfu_dl_sync_type: u8 = 0; "", Range::ANY, PowerOn;
    /// M function that acts as M0; -1 none
    22254 AUXFU_ASSOC_M0_VALUE auxfu_assoc_m0_value: i32 = -1; "", Range::ANY, PowerOn;
    /// M function that acts as M1; -1 none
    22256 AUXFU_ASSOC_M1_VALUE auxfu_assoc_m1_value: i32 = -1; "", Range::ANY, PowerOn;
    /// the speed of the spindles stays over RESET and the end of a program
    22400 S_VALUES_ACTIVE_AFTER_RESET s_values_active_after_reset: bool = false; "", Range::ANY, PowerOn;
    /// the path feed stays over RESET and the end of a program
    22410 F_VALUES_ACTIVE_AFTER_RESET f_values_active_after_reset: bool = false; "", Range::ANY, PowerOn;
    /// G groups that DB21.DBB208 to 271 show
    22510 GCODE_GROUPS_TO_PLC gcode_groups_to_plc: [u8; 8] = [1, 0, 0, 0, 0, 0, 0, 0]; "", Range::between(0.0, 64.0), PowerOn;
    /// bit 0: DB21.DBB208 to 215 show the eight groups of MD22510 in their order
    22515 GCODE_GROUPS_TO_PLC_MODE gcode_groups_to_plc_mode: u32 = 0; "", Range::ANY, PowerOn;
    /// feed in a block search with program test: 0 SD42100 times MD22601, 1 the programmed feed times MD22601, 2 SD42100, 3 the programmed feed
    22600 SERUPRO_SPEED_MODE serupro_speed_mode: u8 = 1; "", Range::between(0.0, 3.0), Reset;
    /// factor of the feed in a block search with program test
    22601 SERUPRO_SPEED_FACTOR serupro_speed_factor: f64 = 10.0; "factor", Range::POSITIVE, Reset;
    /// number of R parameters
    28050 MM_NUM_R_PARAM mm_num_r_param: i32 = 100; "", Range::between(0.0, 32_535.0), PowerOn;
}
scope Channel
}

/// The number of G groups.
const GROUPS: usize = 70;

/// One value for each G group; group 1 has index 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PerGroup([u8; GROUPS]);

impl PerGroup {
    /// The value of a group, counted from 1; 0 for a group that does not exist.
    #[must_use]
    pub fn of(&self, group: u8) -> u8 {
        let index = usize::from(group).checked_sub(1);
        index.and_then(|index| self.0.get(index)).copied().unwrap_or(0)
    }
}

/// G1, G17, G40, G500, G60, G601, G71, G90, G94, BRISK, FFWOF; every other modal group has its first function.
impl Default for PerGroup {
    fn default() -> Self {
        let mut values = [1; GROUPS];
        (values[0], values[12], values[14]) = (2, 2, 2);
        // Groups of functions that hold for one block.
        for group in [2, 3, 5, 9, 11] {
            values[group - 1] = 0;
        }
        Self(values)
    }
}

impl Field for PerGroup {
    const KIND: Kind = <u8 as Scalar>::KIND;
    const COUNT: u16 = 70;

    fn value(&self, index: usize) -> Option<Value> {
        self.0.get(index).map(Scalar::value)
    }

    fn store(&mut self, index: usize, value: &Value) -> Result<(), String> {
        let place = self.0.get_mut(index).ok_or_else(|| "an index of a G group".to_owned())?;
        *place = u8::from_value(value)?;
        Ok(())
    }
}

impl Serialize for PerGroup {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.as_slice().serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for PerGroup {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let values = Vec::<u8>::deserialize(deserializer)?;
        values.try_into().map(Self).map_err(|_| D::Error::custom("one value for each G group"))
    }
}

/// X, Y, Z, A, B, C, U, V as on the control; the rest, X11 and so on, is our own.
fn default_names() -> [String; 20] {
    let letters = ["X", "Y", "Z", "A", "B", "C", "U", "V"];
    std::array::from_fn(|index| match index / letters.len() {
        0 => letters[index].to_owned(),
        row => format!("{}{row}{row}", letters[index % letters.len()]),
    })
}
