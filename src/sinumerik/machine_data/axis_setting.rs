//! Axis-specific setting data, `$SA_`: speed limits of spindles, M19, working area limits, temperature compensation.

use super::table::machine_data;

machine_data! {
/// The setting data of one axis.
AxisSetting {
    /// smallest speed of the spindle (G25 S)
    43210 SPIND_MIN_VELO_G25 spind_min_velo_g25: f64 = 0.0; "rev/min", Range::NOT_NEGATIVE, Immediate;
    /// largest speed of the spindle (G26 S)
    43220 SPIND_MAX_VELO_G26 spind_max_velo_g26: f64 = 1_000.0; "rev/min", Range::NOT_NEGATIVE, Immediate;
    /// position of M19
    43240 M19_SPOS m19_spos: f64 = 0.0; "deg", Range::POSITION, Immediate;
    /// direction of M19: 0 DC from standstill and unchanged in motion, 1 IC, 2 DC, 3 AC, 4 ACP, 5 ACN
    43250 M19_SPOSMODE m19_sposmode: u8 = 0; "", Range::between(0.0, 5.0), Immediate;
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
