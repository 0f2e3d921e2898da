//! Output of auxiliary functions to the PLC: values and change bits in DB21.DBB58 to 193, decoded M functions in
//! 194 to 206.
//!
//! A package is output in one cycle of the NCK and shown for one scan of the PLC. It is acknowledged when the answer of a scan that has seen it has
//! reached the NCK: in the cycle of the next scan, or later by `from_nck_delay` and `to_nck_delay` (O-28). Without a PLC program each cycle acknowledges.
//! The next package follows after a cycle with change bits of 0. Functions with QU are acknowledged in the next cycle, without a scan; with
//! MD22100 = 1 the program does not wait for them at all.
//!
//! Choices where the manuals leave one: an M function is decoded with extension 0; M3 to M5, M19, M70 and M40 to M45 also with the number of the
//! master spindle, or 1 without a spindle; values stay until the next output of their place. RESET does not withdraw what is output.

use std::collections::VecDeque;

use arrayvec::ArrayVec;
use serde::{Deserialize, Serialize};

use crate::image::{ChannelAuxiliary, Signal, channel_auxiliary as signal};
use crate::nc_program::AuxiliaryKind;
use crate::variables::EventId;

/// The most auxiliary functions of a block.
const MOST: usize = 10;

/// The bytes that this module writes: DB21.DBB58 to 206.
pub(in crate::sinumerik) const BYTES: usize = 149;

/// An auxiliary function at its place in the interface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Entry {
    pub kind: AuxiliaryKind,
    /// From 0: M 1 is place 0.
    pub place: u8,
    pub extension: u16,
    pub value: f64,
    pub is_quick: bool,
    /// An M function that has a decoded signal, if its number is below 100.
    pub is_decoded: bool,
    /// A function of a spindle of the channel.
    pub is_of_spindle: bool,
}

impl Entry {
    /// M1.
    pub(in crate::sinumerik) fn is_optional_stop(&self) -> bool {
        self.kind == AuxiliaryKind::M && self.extension == 0 && (self.value - 1.0).abs() < 0.5
    }
}

/// What is output in one PLC cycle.
pub(in crate::sinumerik) type Package = ArrayVec<Entry, MOST>;

/// A package that waits for its output.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Waiting {
    package: Package,
    cause: EventId,
    /// The program does not wait for it.
    is_free: bool,
}

/// A package whose acknowledgement is missing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Unacknowledged {
    /// The cycle of its output.
    cycle: u64,
    /// All its functions are quick: acknowledged in the next cycle.
    is_quick: bool,
    /// The program does not wait for it.
    is_free: bool,
}

/// The output of a channel.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Output {
    /// DB21.DBB58 to 206; empty before the first output.
    bytes: Vec<u8>,
    waiting: VecDeque<Waiting>,
    /// Change bits and decoded M functions are in the interface.
    is_shown: bool,
    unacknowledged: Option<Unacknowledged>,
    /// The package that the PLC has not acknowledged.
    package: Option<Package>,
    /// The event behind the last change.
    pub cause: EventId,
}

impl Output {
    /// Whether a program has to wait for something that is output or waits for it.
    pub(in crate::sinumerik) fn is_busy(&self) -> bool {
        self.unacknowledged.is_some_and(|one| !one.is_free) || self.waiting.iter().any(|one| !one.is_free)
    }

    /// Whether functions of spindles are output or wait for it.
    pub(in crate::sinumerik) fn concerns_spindles(&self) -> bool {
        let packages = self.package.iter().chain(self.waiting.iter().map(|one| &one.package));
        packages.flatten().any(|entry| entry.is_of_spindle)
    }

    /// The package that the PLC has not acknowledged.
    pub(in crate::sinumerik) fn pending(&self) -> Package {
        self.package.clone().unwrap_or_default()
    }

    /// Whether something waits behind the package that is output.
    pub(in crate::sinumerik) fn is_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Adds a package, after the event that leads to it. The program does not wait for quick functions if MD22100 = 1.
    pub(in crate::sinumerik) fn add(&mut self, package: &Package, cause: EventId, quick_is_free: bool) {
        if !package.is_empty() {
            let is_free = quick_is_free && is_quick(package);
            self.waiting.push_back(Waiting { package: package.clone(), cause, is_free });
        }
    }

    /// Takes note of an acknowledgement: the PLC had seen this cycle when it wrote what the control reads now. Quick functions are acknowledged
    /// in the cycle after their output. Returns the package that was acknowledged.
    pub(in crate::sinumerik) fn acknowledge(&mut self, cycle: u64, seen: Option<u64>) -> Option<Package> {
        let is_acknowledged =
            |one: &Unacknowledged| one.is_quick && one.cycle < cycle || seen.is_some_and(|seen| one.cycle <= seen);
        if self.unacknowledged.as_ref().is_some_and(is_acknowledged) {
            self.unacknowledged = None;
            return self.package.take();
        }
        None
    }

    /// Whether change bits and decoded M functions have been shown for one scan.
    pub(in crate::sinumerik) fn was_shown(&self, scanned: bool) -> bool {
        self.is_shown && scanned
    }

    /// Takes change bits and decoded M functions back.
    pub(in crate::sinumerik) fn take_back(&mut self, cause: EventId) {
        self.is_shown = false;
        self.cause = cause;
        let first = usize::from(signal::decoded_m_function_0.byte - ChannelAuxiliary::FIRST);
        // The change bits are bytes 58 to 67, the decoded M functions 194 to 206.
        self.bytes[..10].fill(0);
        self.bytes[first..].fill(0);
    }

    /// Outputs the next package in this cycle, if none is shown or unacknowledged. Returns the event behind it.
    pub(in crate::sinumerik) fn next(&mut self, cycle: u64, whole_h_functions: bool) -> Option<EventId> {
        if self.is_shown || self.unacknowledged.is_some() {
            return None;
        }
        let Waiting { package, cause, is_free } = self.waiting.pop_front()?;
        if self.bytes.is_empty() {
            self.bytes = vec![0; BYTES];
        }
        for entry in &package {
            self.show(entry, whole_h_functions);
        }
        self.is_shown = true;
        self.unacknowledged = Some(Unacknowledged { cycle, is_quick: is_quick(&package), is_free });
        self.package = Some(package);
        Some(cause)
    }

    /// DB21.DBB58 to 206; `None` before the first output.
    pub(in crate::sinumerik) fn bytes(&self) -> Option<&[u8]> {
        Some(self.bytes.as_slice()).filter(|bytes| !bytes.is_empty())
    }

    /// RESET: packages that have not been output are dropped.
    pub(in crate::sinumerik) fn drop_waiting(&mut self) {
        self.waiting.clear();
    }

    fn show(&mut self, entry: &Entry, whole_h_functions: bool) {
        let place = u16::from(entry.place);
        let (change, quick) = change_bits(entry.kind);
        self.set_bit(change.byte, change.bit + entry.place);
        if entry.is_quick {
            self.set_bit(quick.byte, quick.bit + entry.place);
        }
        match entry.kind {
            AuxiliaryKind::M => {
                let at = signal::m_function_1_extension.byte + 6 * place;
                self.put(at, &entry.extension.to_be_bytes());
                let value = unsigned(entry.value);
                self.put(at + 2, &value.to_be_bytes());
                match u8::try_from(value).ok().filter(|number| entry.is_decoded && *number < 100) {
                    Some(number) => {
                        self.set_bit(signal::decoded_m_function_0.byte + u16::from(number) / 8, number % 8);
                    }
                    None => {
                        let of_first = signal::m_function_1_not_decoded;
                        self.set_bit(of_first.byte, of_first.bit + entry.place);
                    }
                }
            }
            AuxiliaryKind::S => self.put_real(signal::s_function_1_extension, 6 * place, entry),
            AuxiliaryKind::F => self.put_real(signal::f_function_1_extension, 6 * place, entry),
            AuxiliaryKind::SumOffset => self.put_real(signal::dl_function_extension, 0, entry),
            AuxiliaryKind::H if whole_h_functions => {
                let at = signal::h_function_1_extension.byte + 6 * place;
                self.put(at, &entry.extension.to_be_bytes());
                self.put(at + 2, &signed(entry.value).to_be_bytes());
            }
            AuxiliaryKind::H => self.put_real(signal::h_function_1_extension, 6 * place, entry),
            AuxiliaryKind::T => {
                let at = signal::t_function_1_extension.byte + 4 * place;
                self.put(at, &entry.extension.to_be_bytes());
                let number = u16::try_from(unsigned(entry.value)).unwrap_or(u16::MAX);
                self.put(at + 2, &number.to_be_bytes());
            }
            AuxiliaryKind::D => {
                let at = signal::d_function_1_extension.byte + 2 * place;
                let byte = |number: u32| u8::try_from(number).unwrap_or(u8::MAX);
                self.put(at, &[byte(entry.extension.into()), byte(unsigned(entry.value))]);
            }
        }
    }

    /// An extension and a REAL.
    fn put_real(&mut self, extension: Signal, offset: u16, entry: &Entry) {
        let at = extension.byte + offset;
        self.put(at, &entry.extension.to_be_bytes());
        #[expect(clippy::cast_possible_truncation, reason = "the interface has REALs of four bytes")]
        let value = entry.value as f32;
        self.put(at + 2, &value.to_be_bytes());
    }

    fn put(&mut self, byte: u16, value: &[u8]) {
        let at = usize::from(byte - ChannelAuxiliary::FIRST);
        self.bytes[at..at + value.len()].copy_from_slice(value);
    }

    fn set_bit(&mut self, byte: u16, bit: u8) {
        self.bytes[usize::from(byte - ChannelAuxiliary::FIRST)] |= 1 << bit;
    }
}

/// Whether all functions of a package are output with quick acknowledgement (QU).
fn is_quick(package: &Package) -> bool {
    package.iter().all(|entry| entry.is_quick)
}

/// The change bit and the quick bit of the first place of a kind.
const fn change_bits(kind: AuxiliaryKind) -> (Signal, Signal) {
    match kind {
        AuxiliaryKind::M => (signal::m_function_1_change, signal::m_function_1_quick),
        AuxiliaryKind::S => (signal::s_function_1_change, signal::s_function_1_quick),
        AuxiliaryKind::T => (signal::t_function_1_change, signal::t_function_1_quick),
        AuxiliaryKind::D => (signal::d_function_1_change, signal::d_function_1_quick),
        AuxiliaryKind::SumOffset => (signal::dl_function_change, signal::dl_function_quick),
        AuxiliaryKind::H => (signal::h_function_1_change, signal::h_function_1_quick),
        AuxiliaryKind::F => (signal::f_function_1_change, signal::f_function_1_quick),
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates")]
fn unsigned(value: f64) -> u32 {
    value.round() as u32
}

#[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
fn signed(value: f64) -> i32 {
    value.round() as i32
}
