//! Overrides: the factor behind a byte of the interface.
//!
//! A byte is a position of the switch in Gray code, whose factors are machine data (MD12010, MD12030, MD12050), or per cent in
//! binary, limited by MD12100; rapid traverse is never faster than 100 %. An override that is not active counts as 100 %.
//! Only the axial one moves something here: feed and rapid traverse override of a channel act on programs, and are shown.

use super::Control;
use crate::image::{AxisToNck, ChannelToNck};

/// The factor of a byte; Gray code 0 counts as position 1 (O-21).
#[must_use]
pub(super) fn factor(code: u8, is_gray: bool, factors: &[f64; 31], limit: f64) -> f64 {
    if is_gray {
        let gray = code & 0x1F;
        // Each bit of the position is the parity of the Gray bits from it upwards.
        let position = gray ^ gray >> 1 ^ gray >> 2 ^ gray >> 3 ^ gray >> 4;
        factors[usize::from(position.max(1)) - 1]
    } else {
        (f64::from(code) / 100.0).min(limit)
    }
}

impl Control {
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
}

/// Without the last bits of a product: 0.07 is 7 %.
fn percent(factor: f64) -> f64 {
    (factor * 1e6).round() / 1e4
}
