//! The names of axes, as the caller gives them. The module knows of an axis its name and what the form of a block depends on.

use serde::{Deserialize, Serialize};

/// An axis: its place in [`AxisNames`], from zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct AxisIndex(pub u16);

/// A name that a program can use for an axis.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisName {
    /// The name; case does not matter.
    pub name: String,
    /// What kind of axis it is.
    pub kind: AxisKind,
    /// Absolute positions outside 0 to 359.999 are allowed (MD30455 bit 0).
    pub is_beyond_modulo: bool,
    /// A modulo axis that takes the shortest way with G90, as with DC (MD30455 bit 2).
    pub is_shortest_by_default: bool,
}

impl AxisName {
    /// A name without the functions of MD30455.
    #[must_use]
    pub fn new(name: impl Into<String>, kind: AxisKind) -> Self {
        Self { name: name.into(), kind, is_beyond_modulo: false, is_shortest_by_default: false }
    }
}

/// What absolute positions, DC, ACP and ACN need to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum AxisKind {
    /// A linear axis.
    Linear,
    /// A rotary axis without modulo.
    Rotary,
    /// A rotary axis with modulo.
    Modulo,
    /// Not known: nothing about the kind of the axis is judged. For checks without a machine.
    Any,
}

/// All names of axes of a channel: geometry axes, other channel axes and machine axes. An index in it is an axis *name*; the caller knows
/// which axis it means.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisNames {
    rows: Vec<AxisName>,
    /// Indices of the rows, in the order of their names in capitals.
    sorted: Vec<u16>,
}

impl AxisNames {
    /// The table of these names. Of two equal names the first one counts.
    #[must_use]
    pub fn new(rows: impl IntoIterator<Item = AxisName>) -> Self {
        // The two largest indices are no axes.
        let rows: Vec<AxisName> = rows.into_iter().take(usize::from(u16::MAX) - 1).collect();
        let mut sorted: Vec<u16> = (0..u16::MAX).take(rows.len()).collect();
        sorted.sort_by(|one, other| {
            let (one, other) = (&rows[usize::from(*one)].name, &rows[usize::from(*other)].name);
            capitals(one).cmp(capitals(other))
        });
        Self { rows, sorted }
    }

    /// A table of names of one kind, for tests and checks.
    #[must_use]
    pub fn of(kind: AxisKind, names: &[&str]) -> Self {
        Self::new(names.iter().map(|name| AxisName::new(*name, kind)))
    }

    /// What programs use if no machine names its axes: the usual letters, alone and with a number.
    #[must_use]
    pub fn usual() -> Self {
        let mut names = Vec::new();
        for letter in "XYZABCUVWQE".chars() {
            names.push(letter.to_string());
            names.extend((1..=31).map(|number| format!("{letter}{number}")));
        }
        names.extend((1..=31).map(|number| format!("AX{number}")));
        Self::new(names.into_iter().map(|name| AxisName::new(name, AxisKind::Any)))
    }

    /// All names, in the order of their indices.
    pub fn iter(&self) -> impl Iterator<Item = &AxisName> {
        self.rows.iter()
    }

    /// The axis with this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<AxisIndex> {
        let before = |index: &u16| capitals(&self.rows[usize::from(*index)].name).lt(capitals(name));
        let found = *self.sorted.get(self.sorted.partition_point(before))?;
        self.rows[usize::from(found)].name.eq_ignore_ascii_case(name).then_some(AxisIndex(found))
    }

    /// The row of an axis.
    #[must_use]
    pub fn row(&self, axis: AxisIndex) -> Option<&AxisName> {
        self.rows.get(usize::from(axis.0))
    }

    /// The name of an axis; empty for an index of another table.
    #[must_use]
    pub fn name(&self, axis: AxisIndex) -> &str {
        self.row(axis).map_or("", |row| row.name.as_str())
    }
}

fn capitals(name: &str) -> impl Iterator<Item = u8> {
    name.bytes().map(|byte| byte.to_ascii_uppercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_without_regard_to_case_and_the_first_of_two_counts() {
        let names = AxisNames::of(AxisKind::Linear, &["Z", "X", "xf", "X", "A1"]);
        let find = |name| names.find(name).map(|axis| axis.0);
        assert_eq!(
            (find("x"), find("XF"), find("a1"), find("Z"), find("Y")),
            (Some(1), Some(2), Some(4), Some(0), None)
        );
        assert_eq!(AxisNames::default().find("X"), None);
    }
}
