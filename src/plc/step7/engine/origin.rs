//! The operands of which the values of a running organization block were made, as plain data.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::Accumulators;

use super::read::{OPERANDS, Read};

/// Values in local data that are followed at a time.
const LOCALS: usize = 64;
/// Comparisons that are remembered.
pub(super) const COMPARISONS: usize = 16;

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
    /// The last comparisons: their instructions and what they compared.
    pub(super) compared: Vec<(u32, Origin, bool)>,
    /// The instruction to which the last jump, call or end of a block led. What follows it ran in order.
    pub(in crate::plc::step7) landed: u32,
}

impl Flow {
    /// An organization block begins at an instruction.
    pub(in crate::plc::step7) fn begin(start: u32) -> Self {
        Self { landed: start, ..Self::default() }
    }

    /// ACCU1 has a value from elsewhere.
    pub(in crate::plc::step7) fn forget_accu1(&mut self) {
        self.accu[0] = Origin::default();
    }

    /// The origin of ACCU1.
    pub(in crate::plc::step7) fn accu1(&self) -> &Origin {
        &self.accu[0]
    }

    /// What a comparison that ran since the last jump compared, and its result.
    pub(in crate::plc::step7) fn comparison(&self, at: u32) -> Option<(&Origin, bool)> {
        let (_, origin, result) = self.compared.iter().rev().find(|(pc, ..)| *pc == at && at >= self.landed)?;
        Some((origin, *result))
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
