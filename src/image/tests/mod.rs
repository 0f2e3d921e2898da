//! Tests of the interface. They use the bytes and bits of the manual, not the constants of the tables.

mod addresses;
mod memories;
mod naming;
mod presets;
mod profile_828d;
mod signals;

use crate::units::{AxisNumber, ChannelNumber};

use super::{Area, Location, Memory, Names, Part, Profile, SINUMERIK, Signal};

const SL: Profile = Profile::SINUMERIK_840D_SL;
const D828: Profile = Profile::SINUMERIK_828D;
const PARTS: [Part; 3] = [Part::ToNck, Part::FromNck, Part::Hmi];

/// All signals.
fn signals() -> impl Iterator<Item = &'static Signal> {
    SINUMERIK.signals()
}

/// The location of a signal in a block that exists.
fn location(signal: &Signal, number: u8) -> Location {
    SINUMERIK.location(signal, number).unwrap()
}

/// Axes X, Y, XF and channels CHAN1, CHAN2.
fn names() -> Names {
    let mut names = Names::default();
    for (number, name) in AxisNumber::all().zip(["X", "Y", "XF"]) {
        names.axes[number] = Some(name.to_owned());
    }
    for (number, name) in ChannelNumber::all().zip(["CHAN1", "CHAN2"]) {
        names.channels[number] = Some(name.to_owned());
    }
    names
}

fn names_828d() -> Names {
    Names { profile: D828, ..names() }
}

/// Names for all axes and channels: A1 to A31 and K1 to K10.
fn all_names() -> Names {
    let mut names = Names::default();
    for (number, name) in names.axes.iter_mut().take(31) {
        *name = Some(format!("A{number}"));
    }
    for (number, name) in names.channels.iter_mut() {
        *name = Some(format!("K{number}"));
    }
    names
}

/// A memory whose interface bytes all have this value.
fn full_of(byte: u8) -> Memory {
    let mut memory = Memory::new();
    for part in PARTS {
        memory.part_mut(part).fill(byte);
    }
    memory
}

/// All bytes of a data block of the 840D sl.
fn data_block(memory: &Memory, number: u16, length: usize) -> Vec<u8> {
    let mut bytes = vec![0; length];
    memory.read_bytes(Area::DataBlock(number), 0, &mut bytes, SL).unwrap();
    bytes
}
