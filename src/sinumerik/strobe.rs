//! Who writes DB11.DBX5.2, and DBX25.2 of the second mode group (E-01): the control mirrors REF there until the HMI uses the byte.

use std::mem::offset_of;

use crate::image::{Hmi, Location, ModeGroupHmi, Part};
use crate::units::ModeGroupNumber;

/// Whose DB11.DBX5.2 is, and DBX25.2 of the second mode group (E-01).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Strobe {
    /// What `plant.toml` fixes: the HMI's, or the control's.
    is_the_hmi_s: Option<bool>,
}

impl Strobe {
    pub(super) const fn new(is_the_hmi_s: Option<bool>) -> Self {
        Self { is_the_hmi_s }
    }

    /// The mode groups whose byte a write there makes the HMI's.
    pub(super) fn touched_by(self, location: Location) -> impl Iterator<Item = ModeGroupNumber> {
        let of_the_hmi = location.part == Part::Hmi && self.is_the_hmi_s.is_none();
        let touched = move |byte: usize| {
            let first = location.offset as usize;
            (first..first + location.bytes() as usize).contains(&byte)
        };
        ModeGroupNumber::all().filter(move |&group| of_the_hmi && touched(strobe_byte(group)))
    }

    /// The mode groups whose byte is the HMI's from the start.
    pub(super) fn fixed(self) -> impl Iterator<Item = ModeGroupNumber> {
        ModeGroupNumber::all().filter(move |_| self.is_the_hmi_s == Some(true))
    }
}

/// Where DB11.DBB5 lies in the HMI's part, or DBB25 of the second mode group.
fn strobe_byte(group: ModeGroupNumber) -> usize {
    let block = offset_of!(Hmi, mode_groups) + usize::from(group.number() - 1) * size_of::<ModeGroupHmi>();
    block + usize::from(5 - ModeGroupHmi::FIRST)
}
