//! The registers of the CPU as plain state.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::memory::OpenBlock;

/// The status word.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Status {
    /// /FC: a logic string has begun.
    pub fc: bool,
    /// The result of logic operation.
    pub rlo: bool,
    /// The last bit that was read or written.
    pub sta: bool,
    /// An AND term before OR is open.
    pub or: bool,
    /// Stored overflow.
    pub os: bool,
    /// Overflow.
    pub ov: bool,
    /// Condition code 0.
    pub cc0: bool,
    /// Condition code 1.
    pub cc1: bool,
    /// The binary result.
    pub br: bool,
}

impl Status {
    /// The nine bits of the status word.
    #[must_use]
    pub fn word(self) -> u16 {
        let bits = [self.fc, self.rlo, self.sta, self.or, self.os, self.ov, self.cc0, self.cc1, self.br];
        bits.iter().rev().fold(0, |word, &bit| word << 1 | u16::from(bit))
    }

    /// The status word from its nine bits.
    #[must_use]
    pub fn from_word(word: u16) -> Self {
        let bit = |number: u16| word >> number & 1 == 1;
        Self {
            fc: bit(0),
            rlo: bit(1),
            sta: bit(2),
            or: bit(3),
            os: bit(4),
            ov: bit(5),
            cc0: bit(6),
            cc1: bit(7),
            br: bit(8),
        }
    }
}

/// The registers: accumulators, address registers, data block registers, status.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Registers {
    /// ACCU1 to ACCU4; a CPU with two accumulators leaves the last two alone.
    pub accu: [u32; 4],
    /// AR1 and AR2.
    pub ar: [u32; 2],
    /// The open data block.
    pub db: OpenBlock,
    /// The open instance data block.
    pub di: OpenBlock,
    /// The status word.
    pub status: Status,
}

impl fmt::Display for Registers {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [accu1, accu2, accu3, accu4] = self.accu;
        let [ar1, ar2] = self.ar;
        write!(f, "ACCU1 {accu1:08X} ACCU2 {accu2:08X}")?;
        if accu3 | accu4 != 0 {
            write!(f, " ACCU3 {accu3:08X} ACCU4 {accu4:08X}")?;
        }
        write!(
            f,
            " AR1 {ar1:08X} AR2 {ar2:08X} DB {} DI {} STW {:09b}",
            self.db.number,
            self.di.number,
            self.status.word()
        )
    }
}
