//! Areas of plain bytes (inputs, outputs, flags, data blocks of the program), and their serialization.

use std::fmt;
use std::ops::{Deref, DerefMut};
use std::sync::Arc;

use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// An area of bytes. A clone is cheap: it shares the bytes until one of the copies is written.
#[derive(Clone, Debug, Default)]
pub struct Bytes {
    bytes: Arc<Vec<u8>>,
    /// They may have been written to since [`Bytes::take_written`] was last asked.
    written: bool,
}

/// What matters is the bytes, not whether they have been looked at.
impl PartialEq for Bytes {
    fn eq(&self, other: &Self) -> bool {
        self.bytes == other.bytes
    }
}

impl Eq for Bytes {}

impl Bytes {
    /// An area of this length, all bytes 0.
    #[must_use]
    pub fn zeroed(length: usize) -> Self {
        Self::from(vec![0; length])
    }

    /// Whether they may have been written to since this was last asked.
    pub(crate) fn take_written(&mut self) -> bool {
        std::mem::take(&mut self.written)
    }

    /// One bit: `bit(3, 4)` is bit 4 of byte 3, as in `I3.4`; `false` beyond the end.
    #[must_use]
    pub fn bit(&self, byte: usize, bit: u8) -> bool {
        self.byte(byte) >> (bit % 8) & 1 == 1
    }

    /// Sets one bit; has no effect beyond the end.
    pub fn set_bit(&mut self, byte: usize, bit: u8, value: bool) {
        let mask = 1 << (bit % 8);
        let old = self.byte(byte);
        self.set_byte(byte, if value { old | mask } else { old & !mask });
    }

    /// One byte; 0 beyond the end.
    #[must_use]
    pub fn byte(&self, byte: usize) -> u8 {
        self.bytes.get(byte).copied().unwrap_or(0)
    }

    /// Sets one byte; has no effect beyond the end.
    pub fn set_byte(&mut self, byte: usize, value: u8) {
        if self.bytes.get(byte).is_some_and(|old| *old != value) {
            self[byte] = value;
        }
    }

    /// Two bytes, most significant first.
    #[must_use]
    pub fn word(&self, byte: usize) -> u16 {
        u16::from_be_bytes([self.byte(byte), self.byte(byte + 1)])
    }

    /// Sets two bytes, most significant first.
    pub fn set_word(&mut self, byte: usize, value: u16) {
        for (index, part) in value.to_be_bytes().into_iter().enumerate() {
            self.set_byte(byte + index, part);
        }
    }

    /// Four bytes, most significant first.
    #[must_use]
    pub fn double(&self, byte: usize) -> u32 {
        u32::from(self.word(byte)) << 16 | u32::from(self.word(byte + 2))
    }

    /// Sets four bytes, most significant first.
    pub fn set_double(&mut self, byte: usize, value: u32) {
        for (index, part) in value.to_be_bytes().into_iter().enumerate() {
            self.set_byte(byte + index, part);
        }
    }

    /// A REAL (floating point number of 32 bits).
    #[must_use]
    pub fn real(&self, byte: usize) -> f32 {
        f32::from_bits(self.double(byte))
    }

    /// Sets a REAL.
    pub fn set_real(&mut self, byte: usize, value: f32) {
        self.set_double(byte, value.to_bits());
    }
}

impl From<Vec<u8>> for Bytes {
    fn from(bytes: Vec<u8>) -> Self {
        Self { bytes: Arc::new(bytes), written: true }
    }
}

impl Deref for Bytes {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        &self.bytes
    }
}

impl DerefMut for Bytes {
    fn deref_mut(&mut self) -> &mut [u8] {
        self.written = true;
        Arc::make_mut(&mut self.bytes).as_mut_slice()
    }
}

impl Serialize for Bytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self)
    }
}

impl<'de> Deserialize<'de> for Bytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer).map(Self::from)
    }
}

/// The bytes of a part of the interface. Their number is fixed by the interface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PartBytes(Box<[u8]>);

impl PartBytes {
    pub(super) fn zeroed(length: usize) -> Self {
        Self(vec![0; length].into())
    }
}

impl Deref for PartBytes {
    type Target = [u8];
    #[inline]
    fn deref(&self) -> &[u8] {
        &self.0
    }
}

impl DerefMut for PartBytes {
    #[inline]
    fn deref_mut(&mut self) -> &mut [u8] {
        &mut self.0
    }
}

impl Serialize for PartBytes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_bytes(self)
    }
}

impl<'de> Deserialize<'de> for PartBytes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        read(deserializer).map(|bytes| Self(bytes.into()))
    }
}

/// Reads bytes, stored either as bytes or as a sequence.
fn read<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<u8>, D::Error> {
    struct AnyBytes;

    impl<'de> Visitor<'de> for AnyBytes {
        type Value = Vec<u8>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("bytes")
        }

        fn visit_bytes<E: Error>(self, bytes: &[u8]) -> Result<Vec<u8>, E> {
            Ok(bytes.to_vec())
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Vec<u8>, A::Error> {
            let mut bytes = Vec::new();
            while let Some(byte) = sequence.next_element()? {
                bytes.push(byte);
            }
            Ok(bytes)
        }
    }

    deserializer.deserialize_bytes(AnyBytes)
}
