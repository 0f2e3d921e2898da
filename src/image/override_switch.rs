//! The override switches: the code of a percentage on the interface.

use super::{Block, Interface, Location, Memory, Names, Override};

/// The percentages of the switch positions, from position 1: the defaults of MD12010. Positions after the last one also mean 120 %.
const POSITIONS: [u8; 23] = [0, 1, 2, 4, 6, 8, 10, 20, 30, 40, 50, 60, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120];

/// The same of a spindle override, MD12070.
const SPINDLE_POSITIONS: [u8; 15] = [50, 55, 60, 65, 70, 75, 80, 85, 90, 95, 100, 105, 110, 115, 120];

/// The code of a percentage of a feed override: the position of the switch in Gray code, or the percentage itself in binary up to 200.
/// `None` if the switch has no such position.
#[must_use]
pub fn override_code(percent: u16, gray: bool) -> Option<u8> {
    code_of(percent, gray, &POSITIONS)
}

fn code_of(percent: u16, gray: bool, positions: &[u8]) -> Option<u8> {
    let percent = u8::try_from(percent).ok()?;
    if !gray {
        return (percent <= 200).then_some(percent);
    }
    let index = positions.iter().position(|other| *other == percent)?;
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
    /// Spindle override of an axis, MD12060.
    pub spindle_is_gray: bool,
}

impl OverrideCoding {
    /// Gray code for all overrides of an interface. The data of a control may change it.
    #[must_use]
    pub const fn of(interface: &'static Interface) -> Self {
        Self { interface, axis_is_gray: true, feed_is_gray: true, rapid_traverse_is_gray: true, spindle_is_gray: true }
    }

    /// The override at a location, and whether it is in Gray code; `None` if the location is not an override.
    pub(super) fn at(self, location: Location) -> Option<(Override, bool)> {
        let (_, signal) = self.interface.exactly(location)?;
        let (_, which) = self.interface.tables().overrides.iter().find(|(other, _)| other == signal)?;
        Some((*which, self.is_gray(*which)))
    }

    const fn is_gray(self, which: Override) -> bool {
        match which {
            Override::Axis => self.axis_is_gray,
            Override::Feed => self.feed_is_gray,
            Override::RapidTraverse => self.rapid_traverse_is_gray,
            Override::Spindle => self.spindle_is_gray,
        }
    }

    /// The code of 100 %.
    fn full(self, which: Override) -> u8 {
        override_code(100, self.is_gray(which)).unwrap_or(0)
    }

    /// The percentage of a code at a location; `None` if the location is not an override, or if no position has the code.
    #[must_use]
    pub fn percent(self, location: Location, code: u8) -> Option<u16> {
        let (which, gray) = self.at(location)?;
        (0..=200).find(|percent| code_of(*percent, gray, positions(which)) == Some(code))
    }

    /// The code of a percentage at a location, and the percentages that have one. `None` if the location is not an override.
    pub(super) fn code(self, location: Location, percent: Option<u16>) -> Option<(Option<u8>, String)> {
        let (which, gray) = self.at(location)?;
        let code = percent.and_then(|percent| code_of(percent, gray, positions(which)));
        Some((code, Self::known(which, gray)))
    }

    /// The percentages that have a code.
    pub(super) fn known(which: Override, gray: bool) -> String {
        if !gray {
            return "0 to 200".to_owned();
        }
        positions(which).iter().map(u8::to_string).collect::<Vec<_>>().join(", ")
    }
}

const fn positions(which: Override) -> &'static [u8] {
    match which {
        Override::Axis | Override::Feed | Override::RapidTraverse => &POSITIONS,
        Override::Spindle => &SPINDLE_POSITIONS,
    }
}

/// The overrides of the axes and channels of a machine that hold 100 % at power on: not those of spindles, whose code 0 is 100 % (S-04).
fn overrides(names: &Names) -> impl Iterator<Item = (Override, Location)> {
    let interface = names.interface();
    let preset = interface.tables().overrides.iter().filter(|(_, which)| *which != Override::Spindle);
    preset.flat_map(move |(signal, which)| {
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
