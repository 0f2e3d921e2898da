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

/// The G groups: DB21.DBB207 + group shows the active function of each.
pub mod groups {
    /// How the path moves: G0, G1, G2, G3.
    pub const MOTION: u8 = 1;
    /// Dwell and reference point approach: G4, G74.
    pub const WAITS: u8 = 2;
    /// Programmable offsets and limits: TRANS, ATRANS, G25, G26.
    pub const OFFSETS: u8 = 3;
    /// The buffer of prepared blocks: STARTFIFO, STOPFIFO, FIFOCTRL.
    pub const BUFFER: u8 = 4;
    /// The plane: G17, G18, G19.
    pub const PLANE: u8 = 6;
    /// Tool radius compensation: G40.
    pub const TOOL_RADIUS: u8 = 7;
    /// Settable offsets: G500, G54 to G57, G505 to G599.
    pub const SETTABLE_OFFSET: u8 = 8;
    /// Blocks without offsets: G53, SUPA, G153.
    pub const SUPPRESSION: u8 = 9;
    /// Exact stop and continuous path: G60, G64 to G645.
    pub const EXACT_STOP: u8 = 10;
    /// Exact stop in one block: G9.
    pub const EXACT_STOP_ONCE: u8 = 11;
    /// When an exact stop is reached: G601, G602, G603.
    pub const CRITERION: u8 = 12;
    /// Inch and metric: G70, G71, G700, G710.
    pub const UNIT: u8 = 13;
    /// Absolute and incremental: G90, G91.
    pub const DIMENSION: u8 = 14;
    /// What a feed refers to: G94, G95.
    pub const FEED: u8 = 15;
    /// Acceleration: BRISK, SOFT.
    pub const ACCELERATION: u8 = 21;
    /// Feed-forward: FFWOF, FFWON.
    pub const FEED_FORWARD: u8 = 24;
    /// Working area limitation: WALIMON, WALIMOF.
    pub const WORKING_AREA: u8 = 28;
}

/// The G functions.
pub mod g {
    use super::{GFunction, groups};

    /// Rapid traverse.
    pub const G0: GFunction = GFunction::new(groups::MOTION, 1);
    /// Straight line.
    pub const G1: GFunction = GFunction::new(groups::MOTION, 2);
    /// Circle clockwise.
    pub const G2: GFunction = GFunction::new(groups::MOTION, 3);
    /// Circle counterclockwise.
    pub const G3: GFunction = GFunction::new(groups::MOTION, 4);
    /// Dwell.
    pub const G4: GFunction = GFunction::new(groups::WAITS, 1);
    /// Reference point approach.
    pub const G74: GFunction = GFunction::new(groups::WAITS, 3);
    /// Programmable offset, replaces.
    pub const TRANS: GFunction = GFunction::new(groups::OFFSETS, 1);
    /// Programmable offset, adds.
    pub const ATRANS: GFunction = GFunction::new(groups::OFFSETS, 5);
    /// Working area limit minus.
    pub const G25: GFunction = GFunction::new(groups::OFFSETS, 10);
    /// Working area limit plus.
    pub const G26: GFunction = GFunction::new(groups::OFFSETS, 11);
    /// Preparation goes on.
    pub const STARTFIFO: GFunction = GFunction::new(groups::BUFFER, 1);
    /// The buffer is filled before the path moves.
    pub const STOPFIFO: GFunction = GFunction::new(groups::BUFFER, 2);
    /// The control decides.
    pub const FIFOCTRL: GFunction = GFunction::new(groups::BUFFER, 3);
    /// Plane of the first and the second geometry axis.
    pub const G17: GFunction = GFunction::new(groups::PLANE, 1);
    /// Plane of the third and the first geometry axis.
    pub const G18: GFunction = GFunction::new(groups::PLANE, 2);
    /// Plane of the second and the third geometry axis.
    pub const G19: GFunction = GFunction::new(groups::PLANE, 3);
    /// No tool radius compensation.
    pub const G40: GFunction = GFunction::new(groups::TOOL_RADIUS, 1);
    /// No settable offset.
    pub const G500: GFunction = GFunction::new(groups::SETTABLE_OFFSET, 1);
    /// First settable offset.
    pub const G54: GFunction = GFunction::new(groups::SETTABLE_OFFSET, 2);
    /// Second settable offset.
    pub const G55: GFunction = GFunction::new(groups::SETTABLE_OFFSET, 3);
    /// Third settable offset.
    pub const G56: GFunction = GFunction::new(groups::SETTABLE_OFFSET, 4);
    /// Fourth settable offset.
    pub const G57: GFunction = GFunction::new(groups::SETTABLE_OFFSET, 5);
    /// No offsets in this block.
    pub const G53: GFunction = GFunction::new(groups::SUPPRESSION, 1);
    /// Neither offsets nor overlays in this block.
    pub const SUPA: GFunction = GFunction::new(groups::SUPPRESSION, 2);
    /// No offsets and no base frames in this block.
    pub const G153: GFunction = GFunction::new(groups::SUPPRESSION, 3);
    /// Exact stop.
    pub const G60: GFunction = GFunction::new(groups::EXACT_STOP, 1);
    /// Continuous path.
    pub const G64: GFunction = GFunction::new(groups::EXACT_STOP, 2);
    /// Continuous path with rounding.
    pub const G641: GFunction = GFunction::new(groups::EXACT_STOP, 3);
    /// Continuous path with rounding.
    pub const G642: GFunction = GFunction::new(groups::EXACT_STOP, 4);
    /// Continuous path with rounding.
    pub const G643: GFunction = GFunction::new(groups::EXACT_STOP, 5);
    /// Continuous path with rounding.
    pub const G644: GFunction = GFunction::new(groups::EXACT_STOP, 6);
    /// Continuous path with rounding.
    pub const G645: GFunction = GFunction::new(groups::EXACT_STOP, 7);
    /// Exact stop in this block.
    pub const G9: GFunction = GFunction::new(groups::EXACT_STOP_ONCE, 1);
    /// Exact stop fine.
    pub const G601: GFunction = GFunction::new(groups::CRITERION, 1);
    /// Exact stop coarse.
    pub const G602: GFunction = GFunction::new(groups::CRITERION, 2);
    /// End of interpolation.
    pub const G603: GFunction = GFunction::new(groups::CRITERION, 3);
    /// Lengths in inches.
    pub const G70: GFunction = GFunction::new(groups::UNIT, 1);
    /// Lengths in millimetres.
    pub const G71: GFunction = GFunction::new(groups::UNIT, 2);
    /// Lengths and feeds in inches.
    pub const G700: GFunction = GFunction::new(groups::UNIT, 3);
    /// Lengths and feeds in millimetres.
    pub const G710: GFunction = GFunction::new(groups::UNIT, 4);
    /// Absolute dimensions.
    pub const G90: GFunction = GFunction::new(groups::DIMENSION, 1);
    /// Incremental dimensions.
    pub const G91: GFunction = GFunction::new(groups::DIMENSION, 2);
    /// Feed for each minute.
    pub const G94: GFunction = GFunction::new(groups::FEED, 2);
    /// Feed for each revolution of the master spindle.
    pub const G95: GFunction = GFunction::new(groups::FEED, 3);
    /// Acceleration without limitation of the jerk.
    pub const BRISK: GFunction = GFunction::new(groups::ACCELERATION, 1);
    /// Acceleration with limited jerk.
    pub const SOFT: GFunction = GFunction::new(groups::ACCELERATION, 2);
    /// No feed-forward.
    pub const FFWOF: GFunction = GFunction::new(groups::FEED_FORWARD, 1);
    /// Feed-forward.
    pub const FFWON: GFunction = GFunction::new(groups::FEED_FORWARD, 2);
    /// Working area limitation on.
    pub const WALIMON: GFunction = GFunction::new(groups::WORKING_AREA, 1);
    /// Working area limitation off.
    pub const WALIMOF: GFunction = GFunction::new(groups::WORKING_AREA, 2);
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
    ("STARTFIFO", g::STARTFIFO),
    ("STOPFIFO", g::STOPFIFO),
    ("FIFOCTRL", g::FIFOCTRL),
    ("G17", g::G17),
    ("G18", g::G18),
    ("G19", g::G19),
    ("G40", g::G40),
    ("G500", g::G500),
    ("G54", g::G54),
    ("G55", g::G55),
    ("G56", g::G56),
    ("G57", g::G57),
    ("G53", g::G53),
    ("SUPA", g::SUPA),
    ("G153", g::G153),
    ("G60", g::G60),
    ("G64", g::G64),
    ("G641", g::G641),
    ("G642", g::G642),
    ("G643", g::G643),
    ("G644", g::G644),
    ("G645", g::G645),
    ("G9", g::G9),
    ("G601", g::G601),
    ("G602", g::G602),
    ("G603", g::G603),
    ("G70", g::G70),
    ("G71", g::G71),
    ("G700", g::G700),
    ("G710", g::G710),
    ("G90", g::G90),
    ("G91", g::G91),
    ("G94", g::G94),
    ("G95", g::G95),
    ("BRISK", g::BRISK),
    ("SOFT", g::SOFT),
    ("FFWOF", g::FFWOF),
    ("FFWON", g::FFWON),
    ("WALIMON", g::WALIMON),
    ("WALIMOF", g::WALIMOF),
];

/// The modal groups, and what holds after power on.
const MODAL: [GFunction; 13] = [
    g::G1,
    g::STARTFIFO,
    g::G17,
    g::G40,
    g::G500,
    g::G60,
    g::G601,
    g::G71,
    g::G90,
    g::G94,
    g::BRISK,
    g::FFWOF,
    g::WALIMON,
];

/// The settable offsets G505 to G599 follow G57 in group 8.
pub(super) fn settable_offset(number: u32) -> Option<GFunction> {
    let index = number.checked_sub(505)?.checked_add(6)?;
    (505..=599)
        .contains(&number)
        .then(|| u8::try_from(index).ok())
        .flatten()
        .map(|index| GFunction::new(groups::SETTABLE_OFFSET, index))
}

/// The name of a G function, as programs write it.
#[must_use]
pub fn name(function: GFunction) -> Option<String> {
    let row = FUNCTIONS.iter().find(|(_, row)| *row == function);
    match row {
        Some((name, _)) => Some((*name).to_owned()),
        None if function.group == groups::SETTABLE_OFFSET && (6..=100).contains(&function.index) => {
            Some(format!("G{}", u32::from(function.index) + 499))
        }
        None => None,
    }
}

fn slot(group: u8) -> Option<usize> {
    MODAL.iter().position(|row| row.group == group)
}

/// Millimetres in an inch.
pub const INCH: f64 = 25.4;

/// The active function of each modal G group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Modal {
    active: [u8; MODAL.len()],
}

impl Default for Modal {
    /// The reset values of the table; MD20150 of a machine may have others: [`Modal::set`].
    fn default() -> Self {
        Self { active: MODAL.map(|function| function.index) }
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

    /// Whether lengths are in inches: G70 and G700.
    #[must_use]
    pub fn is_inch(&self) -> bool {
        self.is(g::G70) || self.is(g::G700)
    }

    /// Whether a group has the same function in both.
    #[must_use]
    pub fn agrees(&self, other: &Self, group: u8) -> bool {
        self.index(group) == other.index(group)
    }

    /// The active settable offset: its index in its group, from 2; `None` with G500.
    #[must_use]
    pub fn settable_offset(&self) -> Option<u8> {
        Some(self.index(groups::SETTABLE_OFFSET)).filter(|index| *index > g::G500.index)
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
        MODAL.into_iter().zip(self.active).map(|(function, index)| GFunction::new(function.group, index))
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
