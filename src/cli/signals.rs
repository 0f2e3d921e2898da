//! `opennck signals`: the signal catalogue.

use super::list::{Format, List};
use super::output::Output;
use crate::image::{Memory, Names, Profile, Signal, Writer};
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

/// The catalogue for the first axis, channel and mode group, under placeholder names.
fn rows(profile: Profile) -> Vec<Vec<String>> {
    let mut names = Names { profile, ..Names::default() };
    names.axes[AxisNumber::FIRST] = Some("AX1".to_owned());
    names.channels[ChannelNumber::FIRST] = Some("CHAN1".to_owned());
    let memory = Memory::of(profile.interface());
    profile.interface().signals().filter_map(|signal| row(signal, &names, &memory)).collect()
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

/// Returns nothing for a signal that the profile does not show.
fn row(signal: &'static Signal, names: &Names, memory: &Memory) -> Option<Vec<String>> {
    let location = names.interface().location(signal, 1)?;
    let address = names.address(location);
    memory.locate(&address, names.profile).ok()?;
    let writer = match signal.writer {
        Writer::Plc => "plc",
        Writer::Nck => "nck",
        Writer::Hmi => "hmi",
    };
    Some(vec![address.to_string(), names.symbol(location)?, writer.to_owned(), signal.doc.to_owned()])
}
