//! Values that a control displays and does not need itself.
//!
//! **Overrides.** A byte is either a switch position in Gray code, with factors from machine data (MD12010, MD12030, MD12050), or per cent
//! in binary, limited by MD12100. Rapid traverse is never faster than 100 %. An inactive override counts as 100 %. Only the axial override
//! affects motion here: the feed and rapid traverse overrides of a channel act on programs and are only displayed.
//!
//! **Motor speed** is the actual velocity converted with pitch and gear of the active parameter set.

use crate::image::{AxisToNck, ChannelToNck};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::parameters::overrides::factor;
use crate::units::AxisNumber;

impl Nck {
    /// The effective axial override, in per cent.
    #[must_use]
    pub fn axis_override(&self, signals: &AxisToNck) -> f64 {
        let factor = self.parameters.axis_override(signals.feed_override());
        if signals.override_active() { percent(factor) } else { 100.0 }
    }

    /// The effective feed and rapid traverse overrides of a channel, in per cent.
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

/// Rounds off the last bits of a product: 0.07 is 7 %.
fn percent(factor: f64) -> f64 {
    (factor * 1e6).round() / 1e4
}
