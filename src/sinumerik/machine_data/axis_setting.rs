//! Axis-specific setting data, `$SA_`: working area limits, temperature compensation.

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
    /// temperature compensation that does not depend on the position (MD32750 bit 0)
    43900 TEMP_COMP_ABS_VALUE temp_comp_abs_value: f64 = 0.0; "mm, deg", Range::POSITION, Immediate;
    /// temperature compensation per distance from SD43920 (MD32750 bit 1)
    43910 TEMP_COMP_SLOPE temp_comp_slope: f64 = 0.0; "factor", Range::between(-1.0, 1.0), Immediate;
    /// position at which the temperature compensation of MD32750 bit 1 is 0
    43920 TEMP_COMP_REF_POSITION temp_comp_ref_position: f64 = 0.0; "mm, deg", Range::POSITION, Immediate;
}
scope AxisSetting
}
