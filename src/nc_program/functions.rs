//! G functions: groups and indices as DB21.DBB207 + group shows them, and what holds after power on.

use serde::{Deserialize, Serialize};

/// A G function: its group and its index in the group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct GFunction {
    /// The G group.
    pub group: u8,
    /// The index in the group, from one.
    pub index: u8,
}

impl GFunction {
    const fn new(group: u8, index: u8) -> Self {
        Self { group, index }
    }

    /// Whether it acts until another function of its group.
    #[must_use]
    pub fn is_modal(self) -> bool {
        slot(self.group).is_some()
    }
}

/// G functions that the interpreter itself tests.
pub mod g {
    use super::GFunction;

    /// Rapid traverse.
    pub const G0: GFunction = GFunction::new(1, 1);
    /// Straight line.
    pub const G1: GFunction = GFunction::new(1, 2);
    /// Circle clockwise.
    pub const G2: GFunction = GFunction::new(1, 3);
    /// Circle counterclockwise.
    pub const G3: GFunction = GFunction::new(1, 4);
    /// Dwell.
    pub const G4: GFunction = GFunction::new(2, 1);
    /// Reference point approach.
    pub const G74: GFunction = GFunction::new(2, 3);
    /// Programmable offset, replaces.
    pub const TRANS: GFunction = GFunction::new(3, 1);
    /// Programmable offset, adds.
    pub const ATRANS: GFunction = GFunction::new(3, 5);
    /// Working area limit minus.
    pub const G25: GFunction = GFunction::new(3, 10);
    /// Working area limit plus.
    pub const G26: GFunction = GFunction::new(3, 11);
    /// Incremental dimensions.
    pub const G91: GFunction = GFunction::new(14, 2);
}

/// Names, with group and index.
pub(super) const FUNCTIONS: &[(&str, GFunction)] = &[
    ("G0", g::G0),
    ("G1", g::G1),
    ("G2", g::G2),
    ("G3", g::G3),
    ("G4", g::G4),
    ("G74", g::G74),
    ("TRANS", g::TRANS),
    ("ATRANS", g::ATRANS),
    ("G25", g::G25),
    ("G26", g::G26),
    ("STARTFIFO", GFunction::new(4, 1)),
    ("STOPFIFO", GFunction::new(4, 2)),
    ("FIFOCTRL", GFunction::new(4, 3)),
    ("G17", GFunction::new(6, 1)),
    ("G18", GFunction::new(6, 2)),
    ("G19", GFunction::new(6, 3)),
    ("G40", GFunction::new(7, 1)),
    ("G500", GFunction::new(8, 1)),
    ("G54", GFunction::new(8, 2)),
    ("G55", GFunction::new(8, 3)),
    ("G56", GFunction::new(8, 4)),
    ("G57", GFunction::new(8, 5)),
    ("G53", GFunction::new(9, 1)),
    ("SUPA", GFunction::new(9, 2)),
    ("G153", GFunction::new(9, 3)),
    ("G60", GFunction::new(10, 1)),
    ("G64", GFunction::new(10, 2)),
    ("G641", GFunction::new(10, 3)),
    ("G642", GFunction::new(10, 4)),
    ("G643", GFunction::new(10, 5)),
    ("G644", GFunction::new(10, 6)),
    ("G645", GFunction::new(10, 7)),
    ("G9", GFunction::new(11, 1)),
    ("G601", GFunction::new(12, 1)),
    ("G602", GFunction::new(12, 2)),
    ("G603", GFunction::new(12, 3)),
    ("G70", GFunction::new(13, 1)),
    ("G71", GFunction::new(13, 2)),
    ("G700", GFunction::new(13, 3)),
    ("G710", GFunction::new(13, 4)),
    ("G90", GFunction::new(14, 1)),
    ("G91", g::G91),
    ("G94", GFunction::new(15, 2)),
    ("G95", GFunction::new(15, 3)),
    ("BRISK", GFunction::new(21, 1)),
    ("SOFT", GFunction::new(21, 2)),
    ("FFWOF", GFunction::new(24, 1)),
    ("FFWON", GFunction::new(24, 2)),
    ("WALIMON", GFunction::new(28, 1)),
    ("WALIMOF", GFunction::new(28, 2)),
];

/// The modal groups, and what holds after power on.
const MODAL: [(u8, u8); 13] =
    [(1, 2), (4, 1), (6, 1), (7, 1), (8, 1), (10, 1), (12, 1), (13, 2), (14, 1), (15, 2), (21, 1), (24, 1), (28, 1)];

/// The settable offsets G505 to G599 follow G57 in group 8.
pub(super) fn settable_offset(number: u32) -> Option<GFunction> {
    let index = number.checked_sub(505)?.checked_add(6)?;
    (505..=599).contains(&number).then(|| u8::try_from(index).ok()).flatten().map(|index| GFunction::new(8, index))
}

/// The name of a G function, as programs write it.
#[must_use]
pub fn name(function: GFunction) -> Option<String> {
    let row = FUNCTIONS.iter().find(|(_, row)| *row == function);
    match row {
        Some((name, _)) => Some((*name).to_owned()),
        None if function.group == 8 && (6..=100).contains(&function.index) => {
            Some(format!("G{}", u32::from(function.index) + 499))
        }
        None => None,
    }
}

fn slot(group: u8) -> Option<usize> {
    MODAL.iter().position(|(row, _)| *row == group)
}

/// The active function of each modal G group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Modal {
    active: [u8; MODAL.len()],
}

impl Default for Modal {
    /// The reset values of the table; MD20150 of a machine may have others: [`Modal::set`].
    fn default() -> Self {
        Self { active: MODAL.map(|(_, index)| index) }
    }
}

impl Modal {
    /// The index of the active function of a group; 0 for a group that is not modal.
    #[must_use]
    pub fn index(&self, group: u8) -> u8 {
        slot(group).map_or(0, |slot| self.active[slot])
    }

    /// Whether a function is active.
    #[must_use]
    pub fn is(&self, function: GFunction) -> bool {
        function.index != 0 && self.index(function.group) == function.index
    }

    /// Activates a function. Returns whether its group is modal and has a function of this index.
    pub fn set(&mut self, function: GFunction) -> bool {
        match slot(function.group) {
            Some(slot) if name(function).is_some() => {
                self.active[slot] = function.index;
                true
            }
            Some(_) | None => false,
        }
    }

    /// The modal groups with the index of their active function.
    pub fn groups(&self) -> impl Iterator<Item = GFunction> {
        MODAL.into_iter().zip(self.active).map(|((group, _), index)| GFunction::new(group, index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_and_indices_are_those_of_the_table() {
        let found = |name: &str| FUNCTIONS.iter().find(|row| row.0 == name).map(|row| (row.1.group, row.1.index));
        for (name, group, index) in [
            ("G0", 1, 1),
            ("G3", 1, 4),
            ("G4", 2, 1),
            ("G74", 2, 3),
            ("G19", 6, 3),
            ("G57", 8, 5),
            ("G153", 9, 3),
            ("SUPA", 9, 2),
            ("G64", 10, 2),
            ("G603", 12, 3),
            ("G710", 13, 4),
            ("G94", 15, 2),
            ("G95", 15, 3),
            ("WALIMOF", 28, 2),
        ] {
            assert_eq!(found(name), Some((group, index)), "{name}");
        }
        assert_eq!(settable_offset(505), Some(GFunction::new(8, 6)));
        assert_eq!(settable_offset(504), None);
        assert_eq!(name(GFunction::new(8, 6)).as_deref(), Some("G505"));
    }

    #[test]
    fn reset_values_are_those_of_the_table() {
        let modal = Modal::default();
        for (group, index) in [(1, 2), (6, 1), (8, 1), (10, 1), (13, 2), (14, 1), (15, 2), (2, 0), (9, 0)] {
            assert_eq!(modal.index(group), index, "group {group}");
        }
        assert!(!Modal::default().set(g::G4));
        assert!(!Modal::default().set(GFunction::new(1, 99)));
    }
}
