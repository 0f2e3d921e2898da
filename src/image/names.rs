//! The names of one machine: its axes and channels, and the profile under which its interface blocks are known.

use serde::{Deserialize, Serialize};

use crate::source::{Problem, did_you_mean};
use crate::units::{AxisNumber, ChannelNumber, PerAxis, PerChannel};

use super::catalogue::{touching, usual_format};
use super::{
    Address, Area, Block, Location, Memory, Part, Profile, Signal, Width, Writer, profile_828d, signals, signals_at,
};

/// What a machine calls its axes (MD10000) and channels (MD20000).
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Names {
    /// Machine axis names; `None` for axes that do not exist.
    pub axes: PerAxis<Option<String>>,
    /// Channel names; `None` for channels that do not exist.
    pub channels: PerChannel<Option<String>>,
    /// Under which numbers the interface blocks are known.
    pub profile: Profile,
}

const NCK: &str = "nck";
const MODE_GROUPS: [&str; 2] = ["mode_group_1", "mode_group_2"];

impl Names {
    /// The number of an axis.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        self.axes.iter().find(|(_, other)| other.as_deref() == Some(name)).map(|(number, _)| number)
    }

    /// The number of a channel.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<ChannelNumber> {
        self.channels.iter().find(|(_, other)| other.as_deref() == Some(name)).map(|(number, _)| number)
    }

    /// Everything that can stand before the dot of a symbol.
    fn owners(&self) -> impl Iterator<Item = (&str, Block, u8)> {
        let axes = self.axes.iter().filter_map(|(n, name)| Some((name.as_deref()?, Block::Axis, n.number())));
        let channels =
            self.channels.iter().filter_map(|(n, name)| Some((name.as_deref()?, Block::Channel, n.number())));
        let groups =
            [(NCK, Block::Nck, 1), (MODE_GROUPS[0], Block::ModeGroup, 1), (MODE_GROUPS[1], Block::ModeGroup, 2)];
        groups.into_iter().chain(channels).chain(axes)
    }

    /// Whether every name says one thing.
    ///
    /// # Errors
    /// Two axes or channels have the same name, or a name is taken, or could not stand before a dot.
    pub fn check(&self) -> Result<(), Problem> {
        let mut seen: Vec<(&str, Block, u8)> = Vec::new();
        for (name, block, number) in self.owners() {
            let what = described(block, number);
            if let Some((_, other, other_number)) = seen.iter().find(|(other, ..)| *other == name) {
                return Err(Problem::new(
                    format!(
                        "expected different names, found `{name}` for {} and for {what}",
                        described(*other, *other_number)
                    ),
                    "rename one of them (MD10000, MD20000)",
                ));
            }
            let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let is_data_block = name.strip_prefix("DB").is_some_and(|rest| rest.parse::<u16>().is_ok());
            if name.is_empty() || !name.chars().all(letters) || is_data_block {
                return Err(Problem::new(
                    format!(
                        "expected a name of letters, digits and _ that is no data block, found `{name}` for {what}"
                    ),
                    "rename it (MD10000, MD20000)",
                ));
            }
            seen.push((name, block, number));
        }
        Ok(())
    }

    /// Where a symbol (`X.traversing_key_plus`) or an address (`DB31.DBX4.7`) lies.
    ///
    /// # Errors
    /// Nothing is called so, or the address does not exist; the cure names the nearest known name.
    pub fn resolve(&self, memory: &Memory, text: &str) -> Result<Location, Problem> {
        match text.split_once('.') {
            Some((owner, signal)) if signal.starts_with(|c: char| c.is_ascii_lowercase()) => self.lookup(owner, signal),
            _ => {
                let address: Address = text.parse().map_err(|problem: Problem| self.hint(text, problem))?;
                memory.locate(&address, self.profile)
            }
        }
    }

    fn lookup(&self, owner: &str, name: &str) -> Result<Location, Problem> {
        let Some((_, block, number)) = self.owners().find(|(other, ..)| *other == owner) else {
            let known: Vec<&str> = self.owners().map(|(name, ..)| name).collect();
            let cure = did_you_mean(owner, known.iter().copied(), "upper and lower case count");
            return Err(Problem::new(format!("expected one of `{}`, found `{owner}`", known.join("`, `")), cure));
        };
        let mut of_block = signals().filter(|signal| signal.block == block);
        let found = of_block.find(|signal| signal.name == name).and_then(|signal| signal.location(number));
        found.ok_or_else(|| {
            let known = signals().filter(|signal| signal.block == block).map(|signal| signal.name);
            let cure = did_you_mean(name, known, "`opennck signals` lists them all");
            Problem::new(
                format!("expected a signal of `{owner}` ({}), found `{owner}.{name}`", described(block, number)),
                cure,
            )
        })
    }

    /// Somebody who writes `X` or `x.CONTROLLER_ENABLE` meant a symbol.
    fn hint(&self, text: &str, problem: Problem) -> Problem {
        let (owner, signal) = text.split_once('.').unwrap_or((text, ""));
        if !self.owners().any(|(name, ..)| name == owner) {
            return problem;
        }
        let cure = did_you_mean(&signal.to_ascii_lowercase(), signals().map(|s| s.name), "write X.controller_enable");
        Problem::new(format!("expected a signal name in lower case behind `{owner}.`, found `{text}`"), cure)
    }

    /// The address of a place as this machine's profile writes it. What the 828D does not show has its 840D sl address.
    #[must_use]
    pub fn address(&self, location: Location) -> Address {
        let offset = u16::try_from(location.offset).unwrap_or(u16::MAX);
        let (area, byte) = match location.part {
            Part::Inputs => (Area::Inputs, offset),
            Part::Outputs => (Area::Outputs, offset),
            Part::Flags => (Area::Flags, offset),
            Part::Timers => (Area::Timers, offset / 2),
            Part::Counters => (Area::Counters, offset / 2),
            Part::Block(number) => (Area::DataBlock(number), offset),
            Part::ToNck | Part::FromNck | Part::Hmi => {
                let (db, byte) = self.data_block_byte(location);
                (Area::DataBlock(db), byte)
            }
        };
        let width = match location.width {
            _ if matches!(area, Area::Timers | Area::Counters) => Width::Word,
            1 => Width::Bit(location.bit),
            8 => Width::Byte,
            16 => Width::Word,
            32 => Width::Double,
            width => Width::Bits { first: location.bit, last: location.bit + width - 1 },
        };
        let is_usual = location.format == usual_format(location);
        let format = (!is_usual && location.width > 8).then_some(location.format);
        Address { area, byte, width, format }
    }

    fn data_block_byte(&self, location: Location) -> (u16, u16) {
        let Some(at) = signals_at(location.part, location.offset) else {
            return (0, 0);
        };
        let shown = match self.profile {
            Profile::Sinumerik840dSl => None,
            Profile::Sinumerik828d => profile_828d::shown(at.block, at.number, at.byte),
        };
        shown.unwrap_or((at.data_block, at.byte))
    }

    /// The symbol of a place, `X.controller_enable`, if exactly one signal lies there and its owner has a name.
    #[must_use]
    pub fn symbol(&self, location: Location) -> Option<String> {
        let (number, signal) = exactly(location)?;
        let (owner, ..) = self.owners().find(|(_, block, other)| (*block, *other) == (signal.block, number))?;
        Some(format!("{owner}.{}", signal.name))
    }

    /// Who writes the signals of the catalogue at a place; `None` for plain memory.
    #[must_use]
    pub fn writer(&self, location: Location) -> Option<Writer> {
        touching(location).next().map(|(_, signal)| signal.writer)
    }
}

/// What the signal means that fills a place, with its 1 and 0.
#[must_use]
pub fn meaning(location: Location) -> Option<&'static str> {
    exactly(location).map(|(_, signal)| signal.doc)
}

/// The signal that fills a place, with the number of its block.
fn exactly(location: Location) -> Option<(u8, &'static Signal)> {
    touching(location).find(|(number, signal)| {
        let place = |l: Location| (l.part, l.offset, l.bit, l.width);
        signal.location(*number).map(place) == Some(place(location))
    })
}

fn described(block: Block, number: u8) -> String {
    match block {
        Block::Nck => "the NCK".to_owned(),
        Block::ModeGroup => format!("mode group {number}"),
        Block::Channel => format!("channel {number}"),
        Block::Axis => format!("axis {number}"),
    }
}
