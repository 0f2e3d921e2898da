//! The file in memory: words of 64 bits that this process and other processes load and store. This is the only place of this crate with
//! `unsafe`; both sides of the image call it.
//!
//! Every access is an atomic load or store of one aligned word, so no byte is borrowed while another process writes it. The callers define
//! the meaning of larger pieces and decide when they are complete.

use std::fs::File;
use std::io;
use std::sync::atomic::{AtomicU64, Ordering, fence};

use memmap2::{MmapOptions, MmapRaw};

/// Bytes of a word.
pub(super) const WORD: usize = size_of::<u64>();

/// A file in memory.
#[derive(Debug)]
pub(super) struct Words {
    map: MmapRaw,
}

impl Words {
    /// Maps the first `length` bytes of a file, which must be at least that long.
    pub(super) fn map(file: &File, length: usize) -> io::Result<Self> {
        assert_eq!(length % WORD, 0, "whole words are mapped");
        let map = MmapOptions::new().len(length).map_raw(file)?;
        Ok(Self { map })
    }

    #[expect(unsafe_code, reason = "memory that is shared with other processes is accessed through a pointer")]
    fn words(&self) -> &[AtomicU64] {
        // SAFETY: the mapping begins at a page boundary, so words are aligned. It has `len` bytes and lives as long as `self.map`, from
        // which the slice borrows. Any 64 bits are a valid word. All references to these bytes are atomics, because this is the only place
        // that reads the pointer. Other processes may write at any time, which atomics allow. The pages exist as long as no process
        // truncates the file. Neither side truncates it; if another process does, this process ends by a signal and not by undefined
        // behaviour.
        unsafe { std::slice::from_raw_parts(self.map.as_mut_ptr().cast::<AtomicU64>(), self.map.len() / WORD) }
    }

    /// Loads the number at a position, and makes visible everything that its writer wrote before.
    pub(super) fn load(&self, offset: usize) -> u64 {
        u64::from_le(self.words()[offset / WORD].load(Ordering::Acquire))
    }

    /// Stores a number after everything that this process wrote before.
    pub(super) fn store(&self, offset: usize, value: u64) {
        self.words()[offset / WORD].store(value.to_le(), Ordering::Release);
    }

    /// Copies whole words out of the file.
    pub(super) fn read(&self, offset: usize, into: &mut [u8]) {
        for (word, bytes) in self.words()[offset / WORD..].iter().zip(into.chunks_exact_mut(WORD)) {
            bytes.copy_from_slice(&word.load(Ordering::Relaxed).to_ne_bytes());
        }
    }

    /// Copies whole words into the file. Words that are right already are not stored: most of an image stays as it was, and what no
    /// process stores stays in the caches of the others.
    pub(super) fn write(&self, offset: usize, bytes: &[u8]) {
        for (word, bytes) in self.words()[offset / WORD..].iter().zip(bytes.as_chunks::<WORD>().0) {
            let value = u64::from_ne_bytes(*bytes);
            if word.load(Ordering::Relaxed) != value {
                word.store(value, Ordering::Relaxed);
            }
        }
    }

    /// Writes a slot that begins with its number and ends with its checksum, so that a reader that follows the protocol never takes a part.
    pub(super) fn write_slot(&self, offset: usize, number: u64, slot: &mut [u8]) {
        slot[..WORD].copy_from_slice(&number.to_le_bytes());
        let end = slot.len() - WORD;
        let checksum = u64::from(crc32fast::hash(&slot[..end]));
        slot[end..].copy_from_slice(&checksum.to_le_bytes());
        self.store(offset, 0);
        fence(Ordering::Release);
        self.write(offset + WORD, &slot[WORD..]);
        self.store(offset, number);
    }

    /// Writes the beginning of a slot, without a checksum: for a list of changes. Barriers give its order.
    pub(super) fn write_part(&self, offset: usize, number: u64, part: &[u8], slot_bytes: usize) {
        self.store(offset, 0);
        fence(Ordering::Release);
        self.write(offset + WORD, &part[WORD..]);
        self.store(offset + slot_bytes - WORD, 0);
        self.store(offset, number);
    }

    /// Copies the beginning of a slot that has no checksum, if it is complete and has this number.
    pub(super) fn read_part(&self, offset: usize, number: u64, part: &mut [u8], slot_bytes: usize) -> Result<(), Torn> {
        self.read(offset, part);
        let checksum = self.load(offset + slot_bytes - WORD);
        fence(Ordering::Acquire);
        if self.load(offset) != number || field(part, 0) != number {
            return Err(Torn::Number);
        }
        if checksum == 0 { Ok(()) } else { Err(Torn::Checksum) }
    }

    /// Copies a slot if it is complete and has this number.
    pub(super) fn read_slot(&self, offset: usize, number: u64, slot: &mut [u8]) -> Result<(), Torn> {
        if self.load(offset) != number {
            return Err(Torn::Number);
        }
        self.read(offset, slot);
        fence(Ordering::Acquire);
        if self.load(offset) != number || field(slot, 0) != number {
            return Err(Torn::Number);
        }
        let end = slot.len() - WORD;
        let checksum = field(slot, end);
        if checksum == 0 || checksum == u64::from(crc32fast::hash(&slot[..end])) { Ok(()) } else { Err(Torn::Checksum) }
    }
}

/// Why a slot is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Torn {
    /// The slot has another number, or is being written.
    Number,
    /// The checksum is wrong.
    Checksum,
}

/// The next number, for any value in the file; it is never 0, which means "none".
pub(super) fn next(number: u64) -> u64 {
    number.wrapping_add(1).max(1)
}

/// The number at a position of a copy; 0 beyond its end.
pub(super) fn field(bytes: &[u8], offset: usize) -> u64 {
    bytes.get(offset..).and_then(|rest| rest.first_chunk()).map_or(0, |bytes| u64::from_le_bytes(*bytes))
}
