//! `opennck signals`: the signal catalogue, of any machine or of one, and what of it is modelled.

mod aliases;
mod files;

use std::path::Path;

use super::list::{Format, List, near_words};
use super::output::Output;
use crate::control::Texts;
use crate::controls;
use crate::image::{Address, Block, Memory, Names, Profile, Signal, Writer};
use crate::machine::{Machine, OpenOptions};
use crate::scenario::profile_named;
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{AxisValue, NamedValue};
use aliases::means;
use files::SymbolRow;
pub(super) use files::{Listed, SignalFormat};

/// The columns for programs. New ones are added at the end.
const HEADS: &[&str] = &["address", "symbol", "writer", "name", "modelled"];

/// The columns for people: the longest one is the last.
const TABLE: &[&str] = &["address", "symbol", "writer", "modelled", "name"];

/// A signal or a value.
struct Row {
    /// Its name in the catalogue.
    name: &'static str,
    /// The cells in the order of [`HEADS`].
    cells: [String; 5],
    /// Where a signal is; a value has no address.
    place: Option<(Address, Writer)>,
}

impl Row {
    fn symbol(&self) -> &str {
        let [_, symbol, ..] = &self.cells;
        symbol
    }

    /// The signal for a symbol file.
    fn symbol_row(&self) -> Option<SymbolRow<'_>> {
        let [_, symbol, _, meaning, _] = &self.cells;
        let (address, writer) = self.place?;
        Some(SymbolRow { symbol, address, writer, meaning })
    }
}

fn list(rows: Vec<Row>, format: Format) -> List {
    let cells = |Row { cells: [address, symbol, writer, name, modelled], .. }| match format {
        Format::Table => vec![address, symbol, writer, modelled, name],
        Format::Json | Format::Csv => vec![address, symbol, writer, name, modelled],
    };
    let heads = if format == Format::Table { TABLE } else { HEADS };
    List { heads, rows: rows.into_iter().map(cells).collect() }
}

/// The names and the memory that give addresses and symbols, and what the control models.
struct Catalogue {
    names: Names,
    memory: Memory,
    texts: &'static dyn Texts,
    /// The machine that gave the names: all its axes, channels and mode groups are listed.
    machine: Option<Machine>,
}

pub(super) fn signals(machine: Option<&Path>, profile: &str, listed: &Listed<'_>, output: &mut Output) -> u8 {
    match catalogue(machine, profile) {
        Ok(catalogue) => catalogue.print(listed, output),
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

/// The catalogue of a machine, or that of the first axis, channel and mode group under placeholder names.
fn catalogue(machine: Option<&Path>, profile: &str) -> Result<Catalogue, Problem> {
    let profile = profile_named(profile)?;
    if let Some(path) = machine {
        let machine = Machine::open_with(path, OpenOptions { profile, ..OpenOptions::default() })?;
        let (names, memory) = (machine.names().clone(), machine.memory().clone());
        return Ok(Catalogue { names, memory, texts: machine.control().texts(), machine: Some(machine) });
    }
    let memory = Memory::of(profile.interface());
    let is_of_profile = |texts: &&'static dyn Texts| std::ptr::eq(texts.interface(), profile.interface());
    let texts = controls::texts().find(is_of_profile).expect("a profile belongs to a control");
    let mut names = Names { profile, ..Names::default() };
    let (axis, channel) = texts.first_names();
    names.axes[AxisNumber::FIRST] = Some(axis.to_owned());
    names.channels[ChannelNumber::FIRST] = Some(channel.to_owned());
    Ok(Catalogue { names, memory, texts, machine: None })
}

impl Catalogue {
    fn print(&self, listed: &Listed<'_>, output: &mut Output) -> u8 {
        let mut rows = self.signals();
        let list_format = listed.format.list();
        if list_format == Some(Format::Table) {
            rows.extend(self.values());
        }
        let mut found = 0;
        if let Some(filter) = listed.filter {
            let fallback = format!("omit the filter to list all signals{}", self.hint());
            let texts = || rows.iter().flat_map(|row| &row.cells).map(String::as_str);
            let cure = near_words(&filter.to_lowercase(), texts(), &fallback);
            rows = self.filtered(rows, filter);
            if rows.is_empty() {
                found = 1;
                output.warning(format!("no signal contains `{filter}`; {cure}"));
            }
        }
        let written = match list_format {
            Some(format) => list(rows, format).text(format).map(String::into_bytes),
            None => {
                let rows: Vec<_> = rows.iter().filter_map(Row::symbol_row).collect();
                let made = files::symbol_file(listed.format, &rows, self.names.profile);
                for note in &made.notes {
                    output.remark(note);
                }
                Ok(made.bytes)
            }
        };
        match written.and_then(|bytes| files::write(&bytes, listed, output)) {
            Ok(()) => found,
            Err(problem) => {
                output.error(problem);
                2
            }
        }
    }

    /// The rows that contain a text or are meant by an everyday word; without such a row, those with all words of the text.
    fn filtered(&self, rows: Vec<Row>, filter: &str) -> Vec<Row> {
        let filter = match self.machine {
            Some(_) => filter.to_owned(),
            None => of_the_first(filter, self.names.profile),
        };
        let wanted = filter.to_lowercase();
        let contains = |row: &Row, text: &str| row.cells.iter().any(|cell| cell.to_lowercase().contains(text));
        let is_meant = |row: &Row| contains(row, &wanted) || means(&wanted, row.name);
        if rows.iter().any(is_meant) {
            return rows.into_iter().filter(is_meant).collect();
        }
        // `X.feed_stop`: without a machine, the list has no axis of this name.
        let signal = wanted.split_once('.').map(|(_, signal)| format!(".{signal}"));
        if let Some(signal) = signal.filter(|_| self.machine.is_none())
            && rows.iter().any(|row| row.symbol().contains(&signal))
        {
            return rows.into_iter().filter(|row| row.symbol().contains(&signal)).collect();
        }
        rows.into_iter().filter(|row| wanted.split_whitespace().all(|word| contains(row, word))).collect()
    }

    /// What else to do about a name that is not found.
    fn hint(&self) -> &'static str {
        if self.machine.is_some() {
            ""
        } else {
            ", or add --machine for the names of a machine, or --profile isg for another control"
        }
    }

    fn signals(&self) -> Vec<Row> {
        let Some(machine) = &self.machine else {
            return self.names.interface().signals().filter_map(|signal| self.row(signal, 1)).collect();
        };
        let exists = |(_, block, number): &(&str, Block, u8)| match block {
            Block::Channel => ChannelNumber::new(*number).is_some_and(|channel| machine.has_channel(channel)),
            Block::ModeGroup => ModeGroupNumber::new(*number).is_some_and(|group| machine.has_mode_group(group)),
            Block::Nck | Block::Axis => true,
        };
        let of_owner = |(_, block, number)| {
            let of_block = self.names.interface().signals().filter(move |signal| signal.block == block);
            of_block.filter_map(move |signal| self.row(signal, number))
        };
        self.names.owners().filter(exists).flat_map(of_owner).collect()
    }

    /// Returns nothing for a signal that the profile does not show.
    fn row(&self, signal: &'static Signal, number: u8) -> Option<Row> {
        let location = self.names.interface().location(signal, number)?;
        let address = self.names.address(location);
        self.memory.locate(&address, self.names.profile).ok()?;
        let writer = match signal.writer {
            Writer::Plc => "plc",
            Writer::Nck => "nck",
            Writer::Hmi => "hmi",
        };
        let modelled = match signal.writer {
            _ if self.texts.is_modelled(signal) => "yes",
            Writer::Nck => "written never",
            Writer::Plc | Writer::Hmi => "memory only",
        };
        let symbol = self.names.symbol(location)?;
        let cells = [address.to_string(), symbol, writer.to_owned(), signal.doc.to_owned(), modelled.to_owned()];
        Some(Row { name: signal.name, cells, place: Some((address, signal.writer)) })
    }

    /// The values of each axis and channel, which have names and no addresses.
    fn values(&self) -> Vec<Row> {
        let axes = self.names.axes.iter().filter_map(|(_, name)| name.as_deref());
        let of_axis = |axis: &str| {
            let interface = self.names.interface();
            AxisValue::ALL.map(|value| Row {
                name: value.name(interface),
                cells: [
                    "value".to_owned(),
                    format!("{axis}.{}", value.name(interface)),
                    "nck".to_owned(),
                    value.meaning(interface).to_owned(),
                    "yes".to_owned(),
                ],
                place: None,
            })
        };
        let exists = |channel| self.machine.as_ref().is_none_or(|machine| machine.has_channel(channel));
        let channels =
            self.names.channels.iter().filter(|(channel, _)| exists(*channel)).filter_map(|(_, name)| name.as_deref());
        let of_channel = |channel: &str| {
            NamedValue::OF_CHANNEL.map(|(name, meaning)| Row {
                name,
                cells: [
                    "value".to_owned(),
                    format!("{channel}.{name}"),
                    "nck".to_owned(),
                    meaning.to_owned(),
                    "yes".to_owned(),
                ],
                place: None,
            })
        };
        axes.flat_map(of_axis).chain(channels.flat_map(of_channel)).collect()
    }
}

/// Converts an address to the block of the first axis or channel, which the list shows: DB35.DBX29.4 is found as
/// DB31.DBX29.4.
fn of_the_first(filter: &str, profile: Profile) -> String {
    let Some(rest) = filter.get(..2).filter(|letters| letters.eq_ignore_ascii_case("DB")).map(|_| &filter[2..]) else {
        return filter.to_owned();
    };
    let digits = rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len());
    let number: Option<u16> = rest[..digits].parse().ok();
    let behind_the_first = number.and_then(|db| Some(db - (u16::from(profile.block_of(db)?.1) - 1)));
    behind_the_first.map_or_else(|| filter.to_owned(), |first| format!("DB{first}{}", &rest[digits..]))
}
