//! `opennck signals`: the signal catalogue.

use super::list::{Format, List};
use super::output::Output;
use crate::image::{Memory, Names, Profile, Signal, Writer, signals as catalogue};
use crate::scenario::profile_named;
use crate::units::{AxisNumber, ChannelNumber};

pub(super) fn signals(filter: Option<&str>, profile: &str, format: Format, output: &mut Output) -> u8 {
    let profile = match profile_named(profile) {
        Ok(profile) => profile,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let mut list = List { heads: &["address", "symbol", "writer", "name"], rows: rows(profile) };
    let filter = filter.map(|filter| of_the_first(filter, profile));
    list.retain_with(filter.as_deref(), output);
    list.print(format, output)
}

/// The catalogue for the first axis, channel and mode group, which get names that stand for any.
fn rows(profile: Profile) -> Vec<Vec<String>> {
    let mut names = Names { profile, ..Names::default() };
    names.axes[AxisNumber::FIRST] = Some("AX1".to_owned());
    names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
    let memory = Memory::new();
    catalogue().filter_map(|signal| row(signal, &names, &memory)).collect()
}

/// The address in the block of the first axis or channel, which the list shows: DB35.DBX29.4 is looked up in DB31.
fn of_the_first(filter: &str, profile: Profile) -> String {
    let block =
        filter.get(..2).filter(|letters| profile == Profile::Sinumerik840dSl && letters.eq_ignore_ascii_case("DB"));
    let rest = block.map_or("", |_| &filter[2..]);
    let digits = rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len());
    match rest[..digits].parse() {
        Ok(32..=61) => format!("DB31{}", &rest[digits..]),
        Ok(22..=30) => format!("DB21{}", &rest[digits..]),
        _ => filter.to_owned(),
    }
}

/// Nothing for a signal that the profile does not show.
fn row(signal: &'static Signal, names: &Names, memory: &Memory) -> Option<Vec<String>> {
    let location = signal.location(1)?;
    let address = names.address(location);
    memory.locate(&address, names.profile).ok()?;
    let writer = match signal.writer {
        Writer::Plc => "plc",
        Writer::Nck => "nck",
        Writer::Hmi => "hmi",
    };
    Some(vec![address.to_string(), names.symbol(location)?, writer.to_owned(), signal.doc.to_owned()])
}
