//! Values that a control displays and does not need itself.
//!
//! **Overrides.** A byte is either a switch position in Gray code, with factors from machine data (MD12010, MD12030, MD12050), or per cent
//! in binary, limited by MD12100. Rapid traverse is never faster than 100 %. An inactive override counts as 100 %, except at
//! its zero setting (O-21). Only the axial override
//! affects motion here: the feed and rapid traverse overrides of a channel act on programs and are only displayed.
//!
//! **Motor speed** is the actual velocity converted with pitch and gear of the active parameter set.

use crate::image::{AxisToNck, ChannelToNck};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::parameters::overrides::{effective, factor, is_zero_setting};
use crate::units::AxisNumber;

impl Nck {
    /// The effective axial override, in per cent.
    #[must_use]
    pub fn axis_override(&self, signals: &AxisToNck) -> f64 {
        percent(self.parameters.axis_override(signals.feed_override(), signals.override_active()))
    }

    /// The effective override of a spindle, in per cent; 100 % of an axis that is none.
    #[must_use]
    pub fn spindle_override(&self, axis: AxisNumber, signals: &AxisToNck) -> f64 {
        let own = self.parameters.axes[axis].spindle.as_deref();
        own.map_or(100.0, |own| percent(self.state.spindle_factor(axis, own, signals)))
    }

    /// The effective feed and rapid traverse overrides of a channel, in per cent.
    #[must_use]
    pub fn channel_overrides(&self, signals: &ChannelToNck) -> [f64; 2] {
        let data = &self.active().general;
        let limit = data.ovr_factor_limit_bin;
        let (code, gray) = (signals.feed_override(), data.ovr_feed_is_gray_code);
        let feed = factor(code, gray, &data.ovr_factor_feedrate, limit);
        let feed = effective(feed, signals.feed_override_active(), is_zero_setting(code, gray));
        let (code, gray) = (signals.rapid_traverse_override(), data.ovr_rapid_is_gray_code);
        let rapid = factor(code, gray, &data.ovr_factor_rapid_tra, limit.min(1.0));
        let rapid = effective(rapid, signals.rapid_traverse_override_active(), is_zero_setting(code, gray));
        [percent(feed), percent(rapid)]
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
