//! The writer of DB11.DBX5.2, and of DBX25.2 for the second mode group (E-01): the control mirrors REF there until the HMI uses the byte.

use std::mem::offset_of;

use crate::control::Settings;
use crate::image::{Hmi, Location, ModeGroupHmi, Part};
use crate::source::{Node, Problem};
use crate::units::ModeGroupNumber;

/// The writer of DB11.DBX5.2, and of DBX25.2 for the second mode group (E-01).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Strobe {
    /// The writer fixed by `plant.toml`: true for the HMI, false for the control.
    hmi_owns: Option<bool>,
}

impl Strobe {
    /// Takes `db11_5_2` of `[machine]` or of `[compatibility]` in `plant.toml`: `mirror` or `hmi_strobe`. Without it, the control mirrors
    /// until the HMI writes.
    ///
    /// # Errors
    /// Another value, or different values in the two tables.
    pub(super) fn read(settings: &mut Settings) -> Result<Self, Problem> {
        let read = |node: &Node| node.one_of(&[("mirror", false), ("hmi_strobe", true)]);
        let machine = settings.machine.take("db11_5_2").map(|node| read(&node)).transpose()?;
        let Some(node) = settings.compatibility.take("db11_5_2") else {
            return Ok(Self::new(machine));
        };
        let here = read(&node)?;
        if machine.is_some_and(|other| other != here) {
            return Err(node.expected("the same db11_5_2 as in [machine]", "remove one of the two"));
        }
        Ok(Self::new(Some(here)))
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::Table;

    fn read(machine: &str, compatibility: &str) -> Result<Strobe, Problem> {
        let table = |text: &str| Table::parse(text, "plant.toml").unwrap();
        Strobe::read(&mut Settings { machine: table(machine), compatibility: table(compatibility), control: table("") })
    }

    #[test]
    fn db11_5_2_may_stand_in_compatibility_but_not_contradict() {
        assert_eq!(read("", ""), Ok(Strobe::new(None)));
        assert_eq!(read("db11_5_2 = \"mirror\"\n", ""), Ok(Strobe::new(Some(false))));
        assert_eq!(read("", "db11_5_2 = \"hmi_strobe\"\n"), Ok(Strobe::new(Some(true))));
        let both = read("db11_5_2 = \"mirror\"\n", "\ndb11_5_2 = \"hmi_strobe\"\n").unwrap_err().to_string();
        assert!(both.starts_with("plant.toml:2: expected the same db11_5_2 as in [machine]"), "{both}");
        assert!(read("db11_5_2 = \"miror\"\n", "").unwrap_err().to_string().contains("did you mean `mirror`?"));
    }
}
