//! Channel-specific machine data, `$MC_`.

use super::table::machine_data;

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
    /// NC start without reference: 0 allowed, 1 axes with MD34110 above -1 must be referenced (10203), 2 a restored position is sufficient
    /// in MDI and overstore
    20700 REFP_NC_START_LOCK refp_nc_start_lock: u8 = 1; "", Range::between(0.0, 2.0), Reset;
}
scope Channel
}

/// X, Y, Z, A, B, C, U, V as on the control; the rest, X11 and so on, is our own.
fn default_names() -> [String; 20] {
    let letters = ["X", "Y", "Z", "A", "B", "C", "U", "V"];
    std::array::from_fn(|index| match index / letters.len() {
        0 => letters[index].to_owned(),
        row => format!("{}{row}{row}", letters[index % letters.len()]),
    })
}
