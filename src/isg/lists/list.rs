//! The lists of a machine as they are kept: each entry with its place, as it stands in the list, and as the control adopted it.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::control::Value;
use crate::source::Place;

use super::parameter::{Key, Scope};

/// The number of the parameter that holds the logical number of an axis list.
pub(super) const AXIS_NUMBER: u32 = 16;

/// An entry of a list.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Entry {
    pub(super) value: Value,
    #[serde(with = "super::place")]
    pub(super) place: Place,
}

/// An entry that the table of parameters does not have. It is kept and has no effect.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Unknown {
    /// Its name as it stands in the list.
    pub name: String,
    /// What follows the name.
    pub value: String,
    /// The kind of list.
    pub scope: Scope,
    /// Its place.
    #[serde(with = "super::place")]
    pub place: Place,
}

/// The list of an axis or of a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct List {
    pub(super) scope: Scope,
    /// The logical number of the axis, 0 if the list gives 0; the number of the channel, from 1.
    pub(super) number: u16,
    /// The file.
    #[serde(with = "super::place")]
    pub(super) file: Place,
    /// The entries as they stand in the list.
    pub(super) stored: BTreeMap<Key, Entry>,
    /// The entries that the control adopted: those of its last start, and updates since that do not wait for a start.
    pub(super) active: BTreeMap<Key, Entry>,
    pub(super) unknown: Vec<Unknown>,
}

impl List {
    /// The owner in words: `axis 5`, `channel 1`.
    pub(super) fn owner(&self) -> String {
        match self.scope {
            Scope::Axis => format!("axis {}", self.number),
            Scope::Channel => format!("channel {}", self.number),
        }
    }
}

/// THE PARAMETER LISTS of a machine.
///
/// Each axis has a list with its logical number, each channel one with its axes. [`Lists::read`] reads them, [`Lists::set`] changes
/// entries, [`Lists::start`] is the start of the controller, and [`Lists::update`] gives what is in effect after changes at run time.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Lists {
    /// Ascending by logical number. More than one list may have the number 0; the control refuses those.
    pub(super) axes: Vec<List>,
    /// In the order of their file names; the first one is channel 1.
    pub(super) channels: Vec<List>,
    pub(super) others: Vec<String>,
}

impl Lists {
    /// The logical numbers of all axes, ascending.
    pub fn axis_numbers(&self) -> impl Iterator<Item = u16> {
        self.axes.iter().map(|list| list.number).filter(|number| *number != 0)
    }

    /// The number of channels.
    #[must_use]
    pub fn channels(&self) -> usize {
        self.channels.len()
    }

    /// The files that are neither axis lists nor channel lists, and are left alone.
    #[must_use]
    pub fn others(&self) -> &[String] {
        &self.others
    }

    /// The entries of unknown parameters.
    pub fn unknown(&self) -> impl Iterator<Item = &Unknown> {
        self.axes.iter().chain(&self.channels).flat_map(|list| &list.unknown)
    }

    /// Whether the axis lists have this logical number.
    pub(super) fn has_axis(&self, number: u16) -> bool {
        self.axis(number).is_some()
    }

    /// The list of an axis.
    pub(super) fn axis(&self, number: u16) -> Option<&List> {
        self.axes.iter().find(|list| list.number == number && number != 0)
    }
}
