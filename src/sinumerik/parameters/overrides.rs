//! Override switches: the override factor for a byte of the PLC.

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
