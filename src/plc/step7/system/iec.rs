//! Functions of the IEC library on STRING and DATE_AND_TIME, and the selection SEL.
//!
//! A result that does not fit into its STRING is cut; a position or a length below 0 gives an empty text. Both show BR 0.

use std::cmp::Ordering;

use crate::plc::step7::engine::{Areas, Cpu, Fault};
use crate::plc::step7::instruction::Width;
use crate::plc::step7::text::constants::date_time_of;

use super::dispatch::{millis_of, parts_of};
use super::interface::System;

/// The most characters of a STRING.
const LONGEST: usize = 254;
const DAY_MILLIS: i64 = 86_400_000;
/// The last ms of 2089.
const LAST_MILLIS: i64 = 36_524 * DAY_MILLIS - 1;

/// The characters of a STRING.
#[derive(Clone, Copy)]
struct Letters {
    bytes: [u8; LONGEST],
    length: usize,
}

impl Letters {
    const EMPTY: Self = Self { bytes: [0; LONGEST], length: 0 };

    fn text(&self) -> &[u8] {
        &self.bytes[..self.length]
    }

    /// Appends letters as far as there is room; whether all had.
    fn append(&mut self, letters: &[u8]) -> bool {
        let fitting = letters.len().min(LONGEST - self.length);
        self.bytes[self.length..self.length + fitting].copy_from_slice(&letters[..fitting]);
        self.length += fitting;
        fitting == letters.len()
    }
}

/// The comparison of a function, by the order of its operands.
pub(in crate::plc::step7) fn holds(system: System, order: Ordering) -> bool {
    match system {
        System::TextEqual | System::DateEqual => order.is_eq(),
        System::TextNotEqual | System::DateNotEqual => order.is_ne(),
        System::TextGreater | System::DateGreater => order.is_gt(),
        System::TextGreaterEqual | System::DateGreaterEqual => order.is_ge(),
        System::TextLess | System::DateLess => order.is_lt(),
        _ => order.is_le(),
    }
}

impl Cpu {
    fn letters<A: Areas>(&mut self, areas: &A, index: u16) -> Result<Letters, Fault> {
        let at = self.element(areas, index)?;
        let [maximum, length]: [u8; 2] = self.read_bytes(areas, at)?;
        let mut letters = Letters { length: usize::from(length.min(maximum)).min(LONGEST), ..Letters::EMPTY };
        for (place, letter) in (2..).zip(&mut letters.bytes[..letters.length]) {
            [*letter] = self.read_bytes(areas, at.after(place))?;
        }
        Ok(letters)
    }

    /// Writes a text, cut to the maximum length of the result.
    fn set_letters<A: Areas>(&mut self, areas: &mut A, index: u16, text: &[u8], is_good: bool) -> Result<(), Fault> {
        let at = self.element(areas, index)?;
        let [maximum]: [u8; 1] = self.read_bytes(areas, at)?;
        let length = text.len().min(usize::from(maximum));
        self.state.registers.status.br = is_good && length == text.len();
        self.write_bytes(areas, at.after(1), [u8::try_from(length).unwrap_or(u8::MAX)])?;
        for (place, &letter) in (2..).zip(&text[..length]) {
            self.write_bytes(areas, at.after(place), [letter])?;
        }
        Ok(())
    }

    fn int<A: Areas>(&self, areas: &A, index: u16) -> Result<i32, Fault> {
        let word = self.argument(areas, index, Width::Word)?;
        Ok(i32::from(u16::try_from(word).unwrap_or(0).cast_signed()))
    }

    /// A comparison of two texts; a text that is the beginning of another one is less.
    pub(in crate::plc::step7) fn compare_texts<A: Areas>(
        &mut self,
        areas: &mut A,
        system: System,
    ) -> Result<(), Fault> {
        let (one, other) = (self.letters(areas, 0)?, self.letters(areas, 1)?);
        let result = holds(system, one.text().cmp(other.text()));
        self.set_argument(areas, 2, Width::Bit, result.into())
    }

    /// A comparison of two points of time.
    pub(in crate::plc::step7) fn compare_dates<A: Areas>(
        &mut self,
        areas: &mut A,
        system: System,
    ) -> Result<(), Fault> {
        let (one, other) = (self.point(areas, 0)?, self.point(areas, 1)?);
        let result = holds(system, one.cmp(&other));
        self.set_argument(areas, 2, Width::Bit, result.into())
    }

    /// The ms since 1990-1-1 of a DATE_AND_TIME; 0 and BR 0 if it is none.
    fn point<A: Areas>(&mut self, areas: &A, index: u16) -> Result<i64, Fault> {
        let spot = self.element(areas, index)?;
        let bytes: [u8; 8] = self.read_bytes(areas, spot)?;
        self.state.registers.status.br &= parts_of(bytes).is_some();
        Ok(millis_of(bytes).unwrap_or(0))
    }

    /// AD_DT_TM and SB_DT_TM; a result outside of 1990 to 2089 is limited, with BR 0.
    pub(in crate::plc::step7) fn shift_date<A: Areas>(&mut self, areas: &mut A, is_later: bool) -> Result<(), Fault> {
        let point = self.point(areas, 0)?;
        let duration = i64::from(self.argument(areas, 1, Width::Double)?.cast_signed());
        let exact = if is_later { point + duration } else { point - duration };
        let limited = exact.clamp(0, LAST_MILLIS);
        self.state.registers.status.br &= limited == exact;
        let days = u32::try_from(limited / DAY_MILLIS).unwrap_or(0);
        self.write_element(areas, 2, date_time_of(days, u32::try_from(limited % DAY_MILLIS).unwrap_or(0)))
    }

    /// SB_DT_DT; a result outside of TIME is limited, with BR 0.
    pub(in crate::plc::step7) fn difference_of_dates<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let exact = self.point(areas, 0)? - self.point(areas, 1)?;
        let limited = i32::try_from(exact.clamp(i32::MIN.into(), i32::MAX.into())).unwrap_or(0);
        self.state.registers.status.br &= i64::from(limited) == exact;
        self.set_argument(areas, 2, Width::Double, limited.cast_unsigned())
    }

    /// LEN and FIND.
    pub(in crate::plc::step7) fn text_number<A: Areas>(&mut self, areas: &mut A, system: System) -> Result<(), Fault> {
        let text = self.letters(areas, 0)?;
        if system == System::Length {
            return self.set_argument(areas, 1, Width::Word, u32::try_from(text.length).unwrap_or(0));
        }
        let sought = self.letters(areas, 1)?;
        let found = match sought.length {
            0 => None,
            length => text.text().windows(length).position(|part| part == sought.text()),
        };
        let place = found.map_or(0, |index| u32::try_from(index + 1).unwrap_or(0));
        self.set_argument(areas, 2, Width::Word, place)
    }

    /// LEFT and RIGHT: at most the whole text.
    pub(in crate::plc::step7) fn text_end<A: Areas>(&mut self, areas: &mut A, is_left: bool) -> Result<(), Fault> {
        let (text, count) = (self.letters(areas, 0)?, self.int(areas, 1)?);
        let Ok(count) = usize::try_from(count) else { return self.set_letters(areas, 2, &[], false) };
        let count = count.min(text.length);
        let part = if is_left { &text.text()[..count] } else { &text.text()[text.length - count..] };
        self.set_letters(areas, 2, part, true)
    }

    /// MID: up to L letters from letter P on; an empty text and BR 0 if P or L is 0 or less, or P beyond the text.
    pub(in crate::plc::step7) fn text_middle<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let text = self.letters(areas, 0)?;
        let (count, place) = (self.int(areas, 1)?, self.int(areas, 2)?);
        let (Ok(count @ 1..), Ok(place @ 1..)) = (usize::try_from(count), usize::try_from(place)) else {
            return self.set_letters(areas, 3, &[], false);
        };
        match text.text().get(place - 1..).filter(|rest| !rest.is_empty()) {
            Some(rest) => self.set_letters(areas, 3, &rest[..count.min(rest.len())], true),
            None => self.set_letters(areas, 3, &[], false),
        }
    }

    /// CONCAT: the second text behind the first.
    pub(in crate::plc::step7) fn text_join<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (mut text, other) = (self.letters(areas, 0)?, self.letters(areas, 1)?);
        let fits = text.append(other.text());
        self.set_letters(areas, 2, text.text(), fits)
    }

    /// INSERT: the second text behind letter P of the first, 0 for before it, at its end if P is beyond.
    pub(in crate::plc::step7) fn text_insert<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (text, other, place) = (self.letters(areas, 0)?, self.letters(areas, 1)?, self.int(areas, 2)?);
        let Ok(place) = usize::try_from(place) else { return self.set_letters(areas, 3, &[], false) };
        let (before, after) = text.text().split_at(place.min(text.length));
        self.joined(areas, 3, [before, other.text(), after])
    }

    /// DELETE: without L letters from letter P on; the text itself if there is nothing to delete.
    pub(in crate::plc::step7) fn text_delete<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let text = self.letters(areas, 0)?;
        let (count, place) = (self.int(areas, 1)?, self.int(areas, 2)?);
        let (Ok(count), Ok(place)) = (usize::try_from(count), usize::try_from(place)) else {
            return self.set_letters(areas, 3, &[], false);
        };
        if count == 0 || place == 0 || place > text.length {
            return self.set_letters(areas, 3, text.text(), true);
        }
        let (before, rest) = text.text().split_at(place - 1);
        self.joined(areas, 3, [before, &[], &rest[count.min(rest.len())..]])
    }

    /// REPLACE: L letters from letter P on are replaced by the second text; at the end if P is beyond.
    pub(in crate::plc::step7) fn text_replace<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (text, other) = (self.letters(areas, 0)?, self.letters(areas, 1)?);
        let (count, place) = (self.int(areas, 2)?, self.int(areas, 3)?);
        let (Ok(count), Ok(place)) = (usize::try_from(count), usize::try_from(place)) else {
            return self.set_letters(areas, 4, &[], false);
        };
        if count == 0 {
            return self.set_letters(areas, 4, text.text(), true);
        }
        let (before, rest) = text.text().split_at(place.saturating_sub(1).min(text.length));
        self.joined(areas, 4, [before, other.text(), &rest[count.min(rest.len())..]])
    }

    fn joined<A: Areas>(&mut self, areas: &mut A, index: u16, parts: [&[u8]; 3]) -> Result<(), Fault> {
        let mut text = Letters::EMPTY;
        let mut fits = true;
        for part in parts {
            fits &= text.append(part);
        }
        self.set_letters(areas, index, text.text(), fits)
    }

    /// SEL: the second input if G is set, else the first; BR 0 if the types differ.
    pub(in crate::plc::step7) fn select<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let chosen = if self.argument(areas, 0, Width::Bit)? == 1 { 2 } else { 1 };
        let (from, to) = (self.region(areas, chosen)?, self.region(areas, 3)?);
        if (from.code, from.bytes) != (to.code, to.bytes) {
            self.state.registers.status.br = false;
            return Ok(());
        }
        self.copy_region(areas, from, to)
    }
}
