//! The printable items of a byte: its signals in the catalogue, its bits, the byte itself.

use std::collections::BTreeMap;

use super::Watch;
use super::printable::{Printable, mask_in_byte, printable};
use crate::image::{Format, Location, Names, Part, Signal};

/// The printable items of each byte, searched once for each byte that changes.
pub(super) struct Places<'a> {
    names: &'a Names,
    watch: &'a Watch,
    known: BTreeMap<(Part, u32), Vec<Printable>>,
}

impl<'a> Places<'a> {
    pub(super) fn new(names: &'a Names, watch: &'a Watch) -> Self {
        Self { names, watch, known: BTreeMap::new() }
    }

    /// The items of this byte that have their own rows.
    pub(super) fn at(&mut self, part: Part, offset: u32) -> &[Printable] {
        let (names, watch) = (self.names, self.watch);
        self.known.entry((part, offset)).or_insert_with(|| found(names, watch, part, offset))
    }

    /// The name of these bits of a byte in a message.
    pub(super) fn call(&self, part: Part, offset: u32, bits: u8) -> String {
        let mut called = Vec::new();
        let everything = Watch::default();
        let catalogue = found(self.names, &everything, part, offset);
        let mut left = bits;
        for printable in &catalogue {
            let mask = mask_in_byte(printable.location, offset);
            if left & mask != 0 {
                left &= !mask;
                called.push(printable.called());
            }
        }
        for bit in (0..8).filter(|bit| left & (1 << bit) != 0) {
            let location = Location { part, offset, bit, width: 1, format: Format::Unsigned };
            called.push(self.names.address(location).to_string());
        }
        called.join(", ")
    }
}

fn found(names: &Names, watch: &Watch, part: Part, offset: u32) -> Vec<Printable> {
    let mut printables = Vec::new();
    if matches!(part, Part::Timers | Part::Counters) {
        // Timers and counters are words.
        let location = Location { part, offset: offset & !1, bit: 0, width: 16, format: Format::Unsigned };
        let printable = printable(names, location);
        if watch.shows_unnamed_bit(&printable) || watch.locations().contains(&location) {
            printables.push(printable);
        }
        return printables;
    }
    let mut named_bits = 0;
    let interface = names.interface();
    let byte = interface.signals_at(part, offset);
    let location = |signal: &&Signal, number| interface.location(signal, number);
    let signals = byte.iter().flat_map(|byte| byte.signals.iter().map(|signal| location(signal, byte.number)));
    for location in signals.flatten() {
        named_bits |= mask_in_byte(location, offset);
        // A pattern means the signals of the profile.
        if !names.profile.shows(location) {
            continue;
        }
        let printable = printable(names, location);
        if watch.shows_signal(&printable) {
            printables.push(printable);
        }
    }
    for bit in (0..8).filter(|bit| named_bits & (1 << bit) == 0) {
        let location = Location { part, offset, bit, width: 1, format: Format::Unsigned };
        let printable = printable(names, location);
        if watch.shows_unnamed_bit(&printable) {
            printables.push(printable);
        }
    }
    if named_bits == 0 {
        let location = Location { part, offset, bit: 0, width: 8, format: Format::Unsigned };
        let printable = printable(names, location);
        if watch.shows_unnamed_byte(&printable) {
            printables.push(printable);
        }
    }
    for &location in watch.locations() {
        let listed = printables.iter().any(|printable| printable.location == location);
        if !listed && location.part == part && mask_in_byte(location, offset) != 0 {
            printables.push(printable(names, location));
        }
    }
    printables
}
