//! `opennck signals`: the signal catalogue.

use super::Format;
use super::output::Output;
use crate::image::{Memory, Names, Profile, Signal, Writer, signals as catalogue};
use crate::scenario::profile_named;
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber};

/// One line of the list.
#[derive(Debug, serde::Serialize)]
struct Entry {
    address: String,
    symbol: String,
    writer: &'static str,
    name: &'static str,
}

pub(super) fn signals(filter: Option<&str>, profile: &str, format: Format, output: &mut Output) -> u8 {
    let profile = match profile_named(profile) {
        Ok(profile) => profile,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let wanted = filter.map(str::to_lowercase);
    let mut entries = entries(profile);
    entries.retain(|entry| wanted.as_ref().is_none_or(|wanted| entry.holds(wanted)));
    if let (true, Some(filter)) = (entries.is_empty(), filter) {
        output.warning(format!(
            "no signal has `{filter}` in its address, symbol or name; without a filter all are listed"
        ));
    }
    match printed(&entries, format) {
        Ok(text) => {
            output.print(&text);
            0
        }
        Err(problem) => {
            output.error(problem);
            2
        }
    }
}

impl Entry {
    fn holds(&self, wanted: &str) -> bool {
        [self.address.as_str(), self.symbol.as_str(), self.name].iter().any(|text| text.to_lowercase().contains(wanted))
    }
}

/// The catalogue for the first axis, channel and mode group, which get names that stand for any.
fn entries(profile: Profile) -> Vec<Entry> {
    let mut names = Names { profile, ..Names::default() };
    names.axes[AxisNumber::FIRST] = Some("AX1".to_owned());
    names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
    let memory = Memory::new();
    catalogue().filter_map(|signal| entry(signal, &names, &memory)).collect()
}

/// Nothing for a signal that the profile does not show.
fn entry(signal: &'static Signal, names: &Names, memory: &Memory) -> Option<Entry> {
    let location = signal.location(1)?;
    let address = names.address(location);
    memory.locate(&address, names.profile).ok()?;
    let writer = match signal.writer {
        Writer::Plc => "plc",
        Writer::Nck => "nck",
        Writer::Hmi => "hmi",
    };
    Some(Entry { address: address.to_string(), symbol: names.symbol(location)?, writer, name: signal.doc })
}

fn printed(entries: &[Entry], format: Format) -> Result<String, Problem> {
    let failed = |error: String| Problem::new(format!("the list cannot be written: {error}"), "choose another format");
    match format {
        Format::Table => Ok(table(entries)),
        Format::Json => {
            let text = serde_json::to_string_pretty(entries).map_err(|error| failed(error.to_string()))?;
            Ok(text + "\n")
        }
        Format::Csv => {
            let mut writer = csv::Writer::from_writer(Vec::new());
            if entries.is_empty() {
                writer
                    .write_record(["address", "symbol", "writer", "name"])
                    .map_err(|error| failed(error.to_string()))?;
            }
            for entry in entries {
                writer.serialize(entry).map_err(|error| failed(error.to_string()))?;
            }
            let bytes = writer.into_inner().map_err(|error| failed(error.to_string()))?;
            String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
        }
    }
}

fn table(entries: &[Entry]) -> String {
    let width = |column: fn(&Entry) -> &str, head: &str| {
        entries.iter().map(|entry| column(entry).chars().count()).max().unwrap_or(0).max(head.len())
    };
    let address = width(|entry| &entry.address, "address");
    let symbol = width(|entry| &entry.symbol, "symbol");
    let mut text = format!("{:<address$}  {:<symbol$}  writer  name\n", "address", "symbol");
    for entry in entries {
        let Entry { address: at, symbol: called, writer, name } = entry;
        text.push_str(&format!("{at:<address$}  {called:<symbol$}  {writer:<6}  {name}\n"));
    }
    text
}
