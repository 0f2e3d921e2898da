//! The operands of which the values of a running organization block were made, as plain data.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::{Accumulators, StatusBit};

use super::read::{OPERANDS, Read};

/// Values in local data that are followed at a time.
const LOCALS: usize = 64;
/// Bit operations without an operand of their own that are remembered.
const REMEMBERED: usize = 32;

/// The operands of which a value was made.
#[derive(Clone, Debug, Default)]
pub(in crate::plc::step7) struct Origin {
    /// `None` if a part of the value is unknown.
    pub(super) reads: Option<ArrayVec<Read, OPERANDS>>,
}

impl Origin {
    /// The value of a constant.
    pub(super) fn constant() -> Self {
        Self { reads: Some(ArrayVec::new()) }
    }

    pub(super) fn of(read: Read) -> Self {
        let mut origin = Self::constant();
        origin.reads.iter_mut().for_each(|reads| reads.push(read));
        origin
    }

    /// The origin of a value that is made of these; unknown if they are too many.
    pub(super) fn made_of(reads: &[Read]) -> Self {
        let mut made = ArrayVec::new();
        Self { reads: made.try_extend_from_slice(reads).is_ok().then_some(made) }
    }

    /// The origin of a value that is made of two.
    pub(super) fn and(&self, other: &Self) -> Self {
        let (Some(reads), Some(others)) = (&self.reads, &other.reads) else { return Self::default() };
        let mut reads = reads.clone();
        for read in others {
            if !reads.contains(read) && reads.try_push(*read).is_err() {
                return Self::default();
            }
        }
        Self { reads: Some(reads) }
    }

    /// The operands, if all of them are known.
    pub(in crate::plc::step7) fn reads(&self) -> Option<&[Read]> {
        self.reads.as_deref()
    }
}

/// What is known of the values of a running organization block.
#[derive(Clone, Debug, Default)]
pub(in crate::plc::step7) struct Flow {
    pub(super) accu: [Origin; 4],
    /// Values in the local data, by the bits from which and to which they reach, in the order in which they were written.
    pub(super) local: Vec<(u32, u32, Origin)>,
    /// The condition codes, OV, and BR.
    pub(super) codes: Origin,
    pub(super) overflow: Origin,
    pub(super) binary_result: Origin,
    /// The last comparisons, tests of status bits and of local bits: their instructions and of what they were made.
    remembered: Vec<(u32, Origin)>,
    /// The instruction to which the last jump, call or end of a block led. What follows it ran in order.
    pub(in crate::plc::step7) landed: u32,
}

impl Flow {
    /// An organization block begins at an instruction.
    pub(in crate::plc::step7) fn begin(start: u32) -> Self {
        // Its status word begins with 0.
        let [codes, overflow, binary_result] = std::array::from_fn(|_| Origin::constant());
        Self { landed: start, codes, overflow, binary_result, ..Self::default() }
    }

    /// The origin of a status bit; OS has a history of its own.
    pub(super) fn of_status(&self, bit: StatusBit) -> Origin {
        match bit {
            StatusBit::Overflow => self.overflow.clone(),
            StatusBit::StoredOverflow => Origin::default(),
            StatusBit::BinaryResult => self.binary_result.clone(),
            StatusBit::Zero
            | StatusBit::NotZero
            | StatusBit::Positive
            | StatusBit::Negative
            | StatusBit::NotNegative
            | StatusBit::NotPositive
            | StatusBit::Unordered => self.codes.clone(),
        }
    }

    /// An operation sets the condition codes and OV.
    pub(super) fn set_codes(&mut self, origin: Origin) {
        self.overflow = origin.clone();
        self.codes = origin;
    }

    /// ACCU1 has a value from elsewhere.
    pub(in crate::plc::step7) fn forget_accu1(&mut self) {
        self.accu[0] = Origin::default();
    }

    /// A built-in block may have written to local data, and sets BR.
    pub(super) fn forget_called(&mut self) {
        self.local.clear();
        self.binary_result = Origin::default();
    }

    /// The origin of ACCU1.
    pub(in crate::plc::step7) fn accu1(&self) -> &Origin {
        &self.accu[0]
    }

    /// Remembers of what the bit was made that an instruction tested.
    pub(super) fn remember(&mut self, at: u32, origin: Origin) {
        if self.remembered.len() == REMEMBERED {
            self.remembered.remove(0);
        }
        self.remembered.push((at, origin));
    }

    /// Of what the bit was made that an instruction tested when it ran last.
    pub(in crate::plc::step7) fn remembered(&self, at: u32) -> Option<&Origin> {
        self.remembered.iter().rev().find(|(pc, _)| *pc == at).map(|(_, origin)| origin)
    }

    pub(super) fn load(&mut self, origin: Origin) {
        self.accu[1] = std::mem::replace(&mut self.accu[0], origin);
    }

    pub(super) fn of_local(&self, from: u32, bits: u32) -> Origin {
        let found = self.local.iter().rev().find(|(begin, end, _)| *begin < from + bits && from < *end);
        match found {
            Some((begin, end, origin)) if (*begin, *end) == (from, from + bits) => origin.clone(),
            _ => Origin::default(),
        }
    }

    /// Local data were written.
    pub(super) fn set_local(&mut self, from: u32, bits: u32, origin: Origin) {
        self.local.retain(|(begin, end, _)| *end <= from || from + bits <= *begin);
        if origin.reads.is_some() {
            if self.local.len() == LOCALS {
                self.local.remove(0);
            }
            self.local.push((from, from + bits, origin));
        }
    }

    pub(super) fn arithmetic(&mut self, drops: bool) {
        self.accu[0] = self.accu[0].and(&self.accu[1]);
        if drops {
            self.accu[1] = self.accu[2].clone();
            self.accu[2] = self.accu[3].clone();
        }
    }

    pub(super) fn accumulators(&mut self, operation: Accumulators, has_four: bool) {
        let [first, second, third, fourth] = self.accu.clone();
        match operation {
            Accumulators::Swap => self.accu.swap(0, 1),
            Accumulators::Push if has_four => self.accu = [first.clone(), first, second, third],
            Accumulators::Push => self.accu[1] = first,
            Accumulators::Pop if has_four => self.accu = [second, third, fourth.clone(), fourth],
            Accumulators::Pop => self.accu[0] = second,
            Accumulators::Enter => self.accu = [first, second.clone(), second, third],
            Accumulators::Leave => self.accu = [first, third, fourth.clone(), fourth],
            Accumulators::RotateLeftThroughCc1 | Accumulators::RotateRightThroughCc1 => {
                self.accu[0] = Origin::default();
            }
        }
    }
}
