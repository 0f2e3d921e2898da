//! Kinds of auxiliary functions, and the values that they can have.

use serde::{Deserialize, Serialize};

/// The kind of an auxiliary function.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AuxiliaryKind {
    /// M
    M,
    /// S
    S,
    /// T
    T,
    /// D
    D,
    /// DL
    SumOffset,
    /// H
    H,
    /// F: of the path, or of an axis (FA).
    F,
}

/// Whether an auxiliary function can have a value: the number of its alarm and the reason if not. M, T and D are whole numbers.
pub(super) fn judged_value(kind: AuxiliaryKind, value: f64) -> Result<(), (u32, String)> {
    let is_real = matches!(kind, AuxiliaryKind::S | AuxiliaryKind::H | AuxiliaryKind::SumOffset | AuxiliaryKind::F);
    if !is_real && value.fract() != 0.0 && !value.is_nan() {
        return Err((12560, format!("{value} is no whole number")));
    }
    let (least, most) = match kind {
        AuxiliaryKind::M => (0.0, f64::from(i32::MAX)),
        AuxiliaryKind::T => (0.0, 65_535.0),
        AuxiliaryKind::S | AuxiliaryKind::SumOffset => (0.0, f64::INFINITY),
        AuxiliaryKind::D => (0.0, 255.0),
        AuxiliaryKind::H | AuxiliaryKind::F => (f64::NEG_INFINITY, f64::INFINITY),
    };
    if value < least || value > most {
        let number = if kind == AuxiliaryKind::D { 17180 } else { 12560 };
        return Err((number, format!("{value} is outside {least} to {most}")));
    }
    Ok(())
}
