//! Axis-specific setting data, `$SA_`: working area limits.

use super::table::machine_data;

machine_data! {
/// The setting data of one axis.
AxisSetting {
    /// the working area is limited in plus direction
    43400 WORKAREA_PLUS_ENABLE workarea_plus_enable: bool = false; "", Range::ANY, Immediate;
    /// the working area is limited in minus direction
    43410 WORKAREA_MINUS_ENABLE workarea_minus_enable: bool = false; "", Range::ANY, Immediate;
    /// working area limit plus (G26)
    43420 WORKAREA_LIMIT_PLUS workarea_limit_plus: f64 = 1e8; "mm, deg", Range::POSITION, Immediate;
    /// working area limit minus (G25)
    43430 WORKAREA_LIMIT_MINUS workarea_limit_minus: f64 = -1e8; "mm, deg", Range::POSITION, Immediate;
}
scope AxisSetting
}
