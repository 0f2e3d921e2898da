//! Override switches: the override factor for a byte of the PLC.

/// Whether a byte is the zero setting of the switch: position 1 in Gray code (code 0 or 1), 0 in binary. It acts also while the
/// override is not active (O-21).
#[must_use]
pub(in crate::sinumerik) const fn is_zero_setting(code: u8, is_gray: bool) -> bool {
    if is_gray { code & 0x1F <= 1 } else { code == 0 }
}

/// The factor of a byte that counts only while its override is active, except its zero setting.
#[must_use]
pub(in crate::sinumerik) fn effective(factor: f64, is_active: bool, is_zero_setting: bool) -> f64 {
    match (is_active, is_zero_setting) {
        (true, _) => factor,
        (false, true) => 0.0,
        (false, false) => 1.0,
    }
}

/// The factor of a byte; Gray code 0 counts as position 1 (O-21).
#[must_use]
pub(in crate::sinumerik) fn factor(code: u8, is_gray: bool, factors: &[f64; 31], limit: f64) -> f64 {
    if is_gray {
        let gray = code & 0x1F;
        // Each bit of the position is the parity of the Gray bits from it upwards.
        let position = gray ^ gray >> 1 ^ gray >> 2 ^ gray >> 3 ^ gray >> 4;
        factors[usize::from(position.max(1)) - 1]
    } else {
        (f64::from(code) / 100.0).min(limit)
    }
}
