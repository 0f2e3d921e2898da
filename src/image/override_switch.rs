//! The override switches: the code of a percentage on the interface.

use super::{Block, Interface, Location, Memory, Names, Override};

/// The percentages of the switch positions, from position 1: the defaults of MD12010. Positions after the last one also mean 120 %.
const POSITIONS: [u8; 23] = [0, 1, 2, 4, 6, 8, 10, 20, 30, 40, 50, 60, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120];

/// The code of a percentage: the position of the switch in Gray code, or the percentage itself in binary up to 200.
/// `None` if the switch has no such position.
#[must_use]
pub fn override_code(percent: u16, gray: bool) -> Option<u8> {
    let percent = u8::try_from(percent).ok()?;
    if !gray {
        return (percent <= 200).then_some(percent);
    }
    let index = POSITIONS.iter().position(|other| *other == percent)?;
    let position = u8::try_from(index + 1).ok()?;
    Some(position ^ position >> 1)
}

/// The coding of each override: position in Gray code or binary percentage.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OverrideCoding {
    /// The interface, which defines the bytes of the overrides.
    pub interface: &'static Interface,
    /// Axial feed override; on a SINUMERIK, MD12000.
    pub axis_is_gray: bool,
    /// Feed override of the channel, MD12020.
    pub feed_is_gray: bool,
    /// Rapid traverse override of the channel, MD12040.
    pub rapid_traverse_is_gray: bool,
}

impl OverrideCoding {
    /// Gray code for all overrides of an interface. The data of a control may change it.
    #[must_use]
    pub const fn of(interface: &'static Interface) -> Self {
        Self { interface, axis_is_gray: true, feed_is_gray: true, rapid_traverse_is_gray: true }
    }

    /// Whether the override at a location is in Gray code; `None` if the location is not an override.
    pub(super) fn at(self, location: Location) -> Option<bool> {
        let (_, signal) = self.interface.exactly(location)?;
        let (_, which) = self.interface.tables().overrides.iter().find(|(other, _)| other == signal)?;
        Some(self.is_gray(*which))
    }

    const fn is_gray(self, which: Override) -> bool {
        match which {
            Override::Axis => self.axis_is_gray,
            Override::Feed => self.feed_is_gray,
            Override::RapidTraverse => self.rapid_traverse_is_gray,
        }
    }

    /// The code of 100 %.
    fn full(self, which: Override) -> u8 {
        override_code(100, self.is_gray(which)).unwrap_or(0)
    }

    /// The percentage of a code at a location; `None` if the location is not an override, or if no position has the code.
    #[must_use]
    pub fn percent(self, location: Location, code: u8) -> Option<u16> {
        let gray = self.at(location)?;
        (0..=200).find(|percent| override_code(*percent, gray) == Some(code))
    }

    /// The percentages that have a code.
    pub(super) fn known(gray: bool) -> String {
        if gray { POSITIONS.map(|percent| percent.to_string()).join(", ") } else { "0 to 200".to_owned() }
    }
}

/// The overrides of the axes and channels of a machine.
fn overrides(names: &Names) -> impl Iterator<Item = (Override, Location)> {
    let interface = names.interface();
    interface.tables().overrides.iter().flat_map(move |(signal, which)| {
        let numbers: Vec<u8> = match signal.block {
            Block::Axis => {
                names.axes.iter().filter(|(_, name)| name.is_some()).map(|(axis, _)| axis.number()).collect()
            }
            Block::Channel => {
                names.channels.iter().filter(|(_, name)| name.is_some()).map(|(channel, _)| channel.number()).collect()
            }
            Block::Nck | Block::ModeGroup => vec![1],
        };
        numbers.into_iter().filter_map(move |number| Some((*which, interface.location(signal, number)?)))
    })
}

impl Memory {
    /// The memory after power on: zero, and the code of 100 % in each override of the axes and channels (O-21).
    #[must_use]
    pub fn after_power_on(names: &Names, coding: OverrideCoding) -> Self {
        let mut memory = Self::of(names.interface());
        for (which, location) in overrides(names) {
            memory.put_override(location, coding.full(which));
        }
        memory
    }

    /// Changes each override of 100 % from one coding to another.
    pub fn recode_overrides(&mut self, names: &Names, before: OverrideCoding, now: OverrideCoding) {
        for (which, location) in overrides(names) {
            if self.part(location.part).get(location.offset as usize) == Some(&before.full(which)) {
                self.put_override(location, now.full(which));
            }
        }
    }

    fn put_override(&mut self, location: Location, code: u8) {
        if let Some(byte) = self.part_mut(location.part).get_mut(location.offset as usize) {
            *byte = code;
        }
    }
}
