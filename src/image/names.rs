//! The names of one machine: its axes and channels, and the profile that numbers its interface blocks.

use std::borrow::Cow;

use crate::source::{Problem, did_you_mean, nearest};
use crate::units::{AxisNumber, ChannelNumber, PerAxis, PerChannel};

use super::{Address, Area, Block, Interface, Location, Memory, Part, Profile, Signal, UnitElements, Width, Writer};

/// The names of the axes and channels of a machine, its interface, and the numbering of the interface blocks.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Names {
    /// Machine axis names; `None` for axes that do not exist.
    pub axes: PerAxis<Option<String>>,
    /// Channel names; `None` for channels that do not exist.
    pub channels: PerChannel<Option<String>>,
    /// Further names of axes.
    pub aliases: Vec<(String, AxisNumber)>,
    /// The interface with its numbering.
    pub profile: Profile,
}

impl Names {
    /// The interface of the machine.
    #[must_use]
    pub fn interface(&self) -> &'static Interface {
        self.profile.interface()
    }

    /// The number of the axis with this name.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        let named = self.axes.iter().find(|(_, other)| other.as_deref() == Some(name)).map(|(number, _)| number);
        named.or_else(|| self.aliases.iter().find(|(alias, _)| alias == name).map(|(_, number)| *number))
    }

    /// A text in which the name of an axis before the first dot is not an alias.
    #[must_use]
    pub fn without_alias<'a>(&self, text: &'a str) -> Cow<'a, str> {
        let found = text.split_once('.').and_then(|(owner, rest)| {
            let (_, axis) = self.aliases.iter().find(|(alias, _)| alias == owner)?;
            Some(format!("{}.{rest}", self.axes[*axis].as_deref()?))
        });
        found.map_or(Cow::Borrowed(text), Cow::Owned)
    }

    /// The number of the channel with this name.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<ChannelNumber> {
        self.channels.iter().find(|(_, other)| other.as_deref() == Some(name)).map(|(number, _)| number)
    }

    /// All names that can precede the dot of a symbol, with their blocks, in the order of the kinds of block.
    pub fn owners(&self) -> impl Iterator<Item = (&str, Block, u8)> {
        self.interface().tables().blocks.iter().flat_map(move |table| {
            let numbers = 1..=table.count;
            numbers.filter_map(move |number| Some((self.owner(table.block, number)?, table.block, number)))
        })
    }

    /// The name before the dot in the symbols of a block; `None` for a block without a name.
    #[must_use]
    pub fn owner(&self, block: Block, number: u8) -> Option<&str> {
        let by_the_machine = match block {
            Block::Nck | Block::ModeGroup => None,
            Block::Channel => ChannelNumber::new(number).and_then(|channel| self.channels[channel].as_deref()),
            Block::Axis => AxisNumber::new(number).and_then(|axis| self.axes[axis].as_deref()),
        };
        self.interface().fixed_name(block, number).or(by_the_machine)
    }

    /// Checks that every name is valid and unique.
    ///
    /// # Errors
    /// Two axes or channels have the same name, or a name is reserved or cannot precede a dot.
    pub fn check(&self) -> Result<(), Problem> {
        let named_in = self.interface().tables().named_in;
        let mut seen: Vec<(&str, Block, u8)> = Vec::new();
        for (name, block, number) in self.owners() {
            let what = self.interface().described(block, number);
            if let Some((_, other, other_number)) = seen.iter().find(|(other, ..)| *other == name) {
                return Err(Problem::new(
                    format!(
                        "expected different names, found `{name}` for {} and for {what}",
                        self.interface().described(*other, *other_number)
                    ),
                    format!("rename one of them ({named_in})"),
                ));
            }
            let letters = |c: char| c.is_ascii_alphanumeric() || c == '_';
            let is_data_block = name.strip_prefix("DB").is_some_and(|rest| rest.parse::<u16>().is_ok());
            if name.is_empty() || !name.chars().all(letters) || is_data_block {
                return Err(Problem::new(
                    format!(
                        "expected a name of letters, digits and _ that is not a data block, found `{name}` for {what}"
                    ),
                    format!("rename it ({named_in})"),
                ));
            }
            seen.push((name, block, number));
        }
        for (alias, axis) in &self.aliases {
            let others = self.aliases.iter().filter(|(other, _)| other == alias).count();
            if others > 1 || seen.iter().any(|(name, ..)| name == alias) {
                let what = self.interface().described(Block::Axis, axis.number());
                return Err(Problem::new(
                    format!("expected different names, found `{alias}` for {what} and for something else"),
                    format!("rename one of them ({named_in})"),
                ));
            }
        }
        Ok(())
    }

    /// The location of a symbol (`X.traversing_key_plus`) or an address (`DB31.DBX4.7`).
    ///
    /// # Errors
    /// No signal has this name, or the address does not exist; the problem names the nearest known name.
    pub fn resolve(&self, memory: &Memory, text: &str) -> Result<Location, Problem> {
        match text.split_once('.') {
            Some((owner, signal)) if signal.starts_with(|c: char| c.is_ascii_lowercase()) => self.lookup(owner, signal),
            _ => {
                let address: Address = text.parse().map_err(|problem: Problem| self.hint(text, problem))?;
                memory.locate(&address, self.profile)
            }
        }
    }

    /// The location that is written for a symbol or an address, and a bit that is set with it: a control unit takes a value only with its
    /// enable.
    ///
    /// # Errors
    /// As [`Names::resolve`].
    pub fn resolve_written(&self, memory: &Memory, text: &str) -> Result<(Location, Option<Location>), Problem> {
        let unit = text.split_once('.').and_then(|(owner, name)| {
            let (block, number) = self.block(owner)?;
            let [enable, command, _] = self.unit(block, name)?;
            let location = |signal| self.interface().location(signal, number);
            Some((location(command)?, Some(location(enable)?)))
        });
        unit.map_or_else(|| Ok((self.resolve(memory, text)?, None)), Ok)
    }

    /// The block of an owner, by a name or an alias.
    fn block(&self, owner: &str) -> Option<(Block, u8)> {
        let named = self.owners().find(|(other, ..)| *other == owner).map(|(_, block, number)| (block, number));
        let alias = || self.aliases.iter().find(|(alias, _)| alias == owner);
        named.or_else(|| alias().map(|(_, axis)| (Block::Axis, axis.number())))
    }

    /// The signals of a control unit: enable, command, state.
    fn unit(&self, block: Block, name: &str) -> Option<[&'static Signal; 3]> {
        let UnitElements { enable, command, state } = self.interface().tables().units?;
        let of_block = || self.interface().signals().filter(|signal| signal.block == block);
        let element = |end: &str| of_block().find(|signal| signal.name.strip_prefix(name) == Some(end));
        Some([element(enable)?, element(command)?, element(state)?])
    }

    fn lookup(&self, owner: &str, name: &str) -> Result<Location, Problem> {
        let Some((block, number)) = self.block(owner) else {
            let known: Vec<&str> = self.owners().map(|(name, ..)| name).collect();
            let cure = self
                .renamed(owner)
                .unwrap_or_else(|| did_you_mean(owner, known.iter().copied(), "names are case-sensitive"));
            return Err(Problem::new(format!("expected one of `{}`, found `{owner}`", known.join("`, `")), cure));
        };
        let of_block = || self.interface().signals().filter(|signal| signal.block == block);
        if let Some(location) = self.unit(block, name).and_then(|[.., state]| self.interface().location(state, number))
        {
            return Ok(location);
        }
        let of_name = of_block().filter(|signal| signal.name == name);
        let found: Vec<_> = of_name.filter_map(|signal| self.interface().location(signal, number)).collect();
        // A profile can show a signal with a width of its own: it then exists twice.
        let shown_by = |profile: Profile| found.iter().copied().find(|location| profile.shows(*location));
        let usual = || Profile::all(self.interface()).next().and_then(shown_by);
        if let Some(shown) = shown_by(self.profile).or_else(usual) {
            return Ok(shown);
        }
        let described = self.interface().described(block, number);
        if !found.is_empty() {
            let (title, profile) = (self.profile.numbering().title, self.profile.name());
            return Err(Problem::new(
                format!("expected a signal that {title} shows, found `{owner}.{name}` ({described})"),
                format!(
                    "`opennck signals --profile {profile}` lists the signals of this profile; another profile shows this one"
                ),
            ));
        }
        let cure = match nearest(name, of_block().map(|signal| signal.name)) {
            Some(near) => format!("did you mean `{owner}.{near}`?"),
            None => "`opennck signals` lists all signals".to_owned(),
        };
        Err(Problem::new(format!("expected a signal of `{owner}` ({described}), found `{owner}.{name}`"), cure))
    }

    /// The name of an axis or a channel that is named by its number, as `AX1` or `CHAN1`, while the machine has another name for it.
    fn renamed(&self, owner: &str) -> Option<String> {
        let numbered = [("CHAN", Block::Channel), ("AX", Block::Axis)];
        let (block, number) =
            numbered.into_iter().find_map(|(start, block)| Some((block, owner.strip_prefix(start)?.parse().ok()?)))?;
        let name = self.owner(block, number)?;
        let (what, named_in) = (self.interface().described(block, number), self.interface().tables().named_in);
        Some(format!("{what} is called `{name}` on this machine ({named_in})"))
    }

    /// Improves the message for a text such as `X` or `x.CONTROLLER_ENABLE`, which is meant as a symbol.
    fn hint(&self, text: &str, problem: Problem) -> Problem {
        let (owner, signal) = text.split_once('.').unwrap_or((text, ""));
        if !self.owners().any(|(name, ..)| name == owner) {
            return problem;
        }
        let example = format!("write {}", self.interface().tables().example);
        let known = self.interface().signals().map(|signal| signal.name);
        let cure = did_you_mean(&signal.to_ascii_lowercase(), known, &example);
        Problem::new(format!("expected a signal name in lower case after `{owner}.`, found `{text}`"), cure)
    }

    /// The address of a location in the numbering of this machine. A location that the profile does not show has its default address.
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
        let is_usual = location.format == self.interface().usual_format(location);
        let format = (!is_usual && location.width > 8).then_some(location.format);
        Address { area, byte, width, format }
    }

    fn data_block_byte(&self, location: Location) -> (u16, u16) {
        let Some(at) = self.interface().signals_at(location.part, location.offset) else {
            return (0, 0);
        };
        let usual = || Profile::all(self.interface()).find_map(|profile| profile.shown(at.block, at.number, at.byte));
        self.profile.shown(at.block, at.number, at.byte).or_else(usual).unwrap_or_default()
    }

    /// The symbol of a location, `X.controller_enable`, if exactly one signal has this location and its owner has a name.
    #[must_use]
    pub fn symbol(&self, location: Location) -> Option<String> {
        let (number, signal) = self.interface().exactly(location)?;
        let owner = self.owner(signal.block, number)?;
        Some(format!("{owner}.{}", signal.name))
    }

    /// Checks that a memory contains a location, and that it has a symbol or an address, with which a scenario can name it.
    ///
    /// # Errors
    /// It is not in the memory, or only a part of what has an address.
    pub fn check_location(&self, memory: &Memory, location: Location) -> Result<(), Problem> {
        let Location { part, offset, bit, width, .. } = location;
        if !memory.contains(location) {
            return Err(Problem::new(
                format!(
                    "expected a location in the {} bytes of {part:?}, found {width} bits from bit {bit} of byte {offset}",
                    memory.part(part).len()
                ),
                "a location is 1 to 8 bits of one byte, or 16 or 32 bits from bit 0",
            ));
        }
        let is_of_a_program = match part {
            Part::Inputs | Part::Outputs | Part::Flags | Part::Block(_) => u16::try_from(offset).is_ok(),
            Part::ToNck | Part::FromNck | Part::Hmi | Part::Timers | Part::Counters => false,
        };
        let is_found = || {
            let place = |l: Location| (l.part, l.offset, l.bit, l.width);
            let is_it = |found: Result<Location, Problem>| found.is_ok_and(|found| place(found) == place(location));
            let by_symbol = || self.symbol(location).is_some_and(|symbol| is_it(self.resolve(memory, &symbol)));
            is_it(memory.locate(&self.address(location), self.profile)) || by_symbol()
        };
        if is_of_a_program || is_found() {
            return Ok(());
        }
        Err(Problem::new(
            format!(
                "expected a location with an address, found {width} bits from bit {bit} of byte {offset} of {part:?}"
            ),
            "use the location of an address or symbol: `Names::resolve`",
        ))
    }

    /// Checks that the NCK does not write a location.
    ///
    /// # Errors
    /// The NCK writes it.
    pub fn check_writer(&self, location: Location) -> Result<(), Problem> {
        if self.writer(location) != Some(Writer::Nck) {
            return Ok(());
        }
        let address = self.address(location);
        let what = self.symbol(location).map_or_else(|| address.to_string(), |symbol| format!("{symbol} ({address})"));
        Err(Problem::new(
            format!("expected a signal that the PLC or the operator panel writes, found {what}, which the NCK writes"),
            "the NCK overwrites it in the same cycle: check it with `expect` or `wait`, or write it with `write`, \
             which does what a client could do",
        ))
    }

    /// The writer of the signals at a location; `None` for plain memory.
    #[must_use]
    pub fn writer(&self, location: Location) -> Option<Writer> {
        self.interface().touching(location).next().map(|(_, signal)| signal.writer)
    }
}
