//! What a control shows and does not need itself.
//!
//! **Overrides.** A byte is a position of the switch in Gray code, whose factors are machine data (MD12010, MD12030, MD12050), or per cent in
//! binary, limited by MD12100; rapid traverse is never faster than 100 %. An override that is not active counts as 100 %.
//! Only the axial one moves something here: feed and rapid traverse override of a channel act on programs, and are shown.
//!
//! **The speed of a motor** is the actual velocity behind pitch and gear of the active
//! parameter set.

use crate::image::{AxisToNck, ChannelToNck};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::parameters::overrides::factor;
use crate::units::AxisNumber;

impl Nck {
    /// The axial override that acts, in per cent.
    #[must_use]
    pub fn axis_override(&self, signals: &AxisToNck) -> f64 {
        let factor = self.parameters.axis_override(signals.feed_override());
        if signals.override_active() { percent(factor) } else { 100.0 }
    }

    /// Feed and rapid traverse override of a channel that act, in per cent.
    #[must_use]
    pub fn channel_overrides(&self, signals: &ChannelToNck) -> [f64; 2] {
        let data = &self.active().general;
        let limit = data.ovr_factor_limit_bin;
        let feed = factor(signals.feed_override(), data.ovr_feed_is_gray_code, &data.ovr_factor_feedrate, limit);
        let code = signals.rapid_traverse_override();
        let rapid = factor(code, data.ovr_rapid_is_gray_code, &data.ovr_factor_rapid_tra, limit.min(1.0));
        [
            if signals.feed_override_active() { percent(feed) } else { 100.0 },
            if signals.rapid_traverse_override_active() { percent(rapid) } else { 100.0 },
        ]
    }

    /// The speed of the motor of an axis in rev/min, from its velocity in mm/min or rev/min.
    #[must_use]
    pub fn motor_speed(&self, number: AxisNumber, velocity: f64) -> f64 {
        let data = &self.active().axes[number];
        let way = if data.is_rot_ax { velocity * 360.0 } else { velocity };
        way / Mechanics::new(data).motor_turn(self.state.axes[number].parameter_set.into())
    }
}

/// Without the last bits of a product: 0.07 is 7 %.
fn percent(factor: f64) -> f64 {
    (factor * 1e6).round() / 1e4
}
