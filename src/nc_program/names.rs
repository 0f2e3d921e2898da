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
    /// Positions outside 0 to 359.999 are allowed with DC, ACP and ACN (MD30455 bit 0).
    pub is_beyond_modulo: bool,
}

/// What DC, ACP and ACN need to know.
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

/// All names of axes of a channel: geometry axes, other channel axes and machine axes. An index in it is an axis *name*; the caller knows which
/// axis it means.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisNames {
    rows: Vec<AxisName>,
}

impl AxisNames {
    /// The table of these names. Of two equal names the first one counts.
    #[must_use]
    pub fn new(rows: impl IntoIterator<Item = AxisName>) -> Self {
        let limit = usize::from(u16::MAX);
        Self { rows: rows.into_iter().take(limit).collect() }
    }

    /// A table of names of one kind, for tests and checks.
    #[must_use]
    pub fn of(kind: AxisKind, names: &[&str]) -> Self {
        let row = |name: &&str| AxisName { name: (*name).to_owned(), kind, is_beyond_modulo: false };
        Self::new(names.iter().map(row))
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
        let row = |name| AxisName { name, kind: AxisKind::Any, is_beyond_modulo: false };
        Self::new(names.into_iter().map(row))
    }

    /// The axis with this name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<AxisIndex> {
        let index = self.rows.iter().position(|row| row.name.eq_ignore_ascii_case(name))?;
        u16::try_from(index).ok().map(AxisIndex)
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
