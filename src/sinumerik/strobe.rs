//! The writer of DB11.DBX5.2, and of DBX25.2 for the second mode group (E-01): the control mirrors REF there until the HMI uses the byte.

use std::mem::offset_of;

use crate::image::{Hmi, Location, ModeGroupHmi, Part};
use crate::units::ModeGroupNumber;

/// The writer of DB11.DBX5.2, and of DBX25.2 for the second mode group (E-01).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Strobe {
    /// The writer fixed by `plant.toml`: true for the HMI, false for the control.
    hmi_owns: Option<bool>,
}

impl Strobe {
    pub(super) const fn new(hmi_owns: Option<bool>) -> Self {
        Self { hmi_owns }
    }

    /// The mode groups whose byte belongs to the HMI after a write to this location.
    pub(super) fn touched_by(self, location: Location) -> impl Iterator<Item = ModeGroupNumber> {
        let of_the_hmi = location.part == Part::Hmi && self.hmi_owns.is_none();
        let touched = move |byte: usize| {
            let first = location.offset as usize;
            (first..first + location.bytes() as usize).contains(&byte)
        };
        ModeGroupNumber::all().filter(move |&group| of_the_hmi && touched(strobe_byte(group)))
    }

    /// The mode groups whose byte belongs to the HMI from the start.
    pub(super) fn fixed(self) -> impl Iterator<Item = ModeGroupNumber> {
        ModeGroupNumber::all().filter(move |_| self.hmi_owns == Some(true))
    }
}

/// The offset of DB11.DBB5 in the HMI's part, or of DBB25 for the second mode group.
fn strobe_byte(group: ModeGroupNumber) -> usize {
    let block = offset_of!(Hmi, mode_groups) + usize::from(group.number() - 1) * size_of::<ModeGroupHmi>();
    block + usize::from(5 - ModeGroupHmi::FIRST)
}
