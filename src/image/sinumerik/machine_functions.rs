//! The seven machine functions of JOG and the three handwheels as one group of bits: INC1 is bit 0, INCvar bit 5, continuous bit 6;
//! handwheel 1 is bit 0.
//!
//! The tables name each bit. The control reads the group once per axis and cycle, because seven single reads would cost too much time.

use bitfield::{BitRange, BitRangeMut};

use super::{AxisFromNck, AxisToNck, ModeGroupFromNck, ModeGroupToNck};

/// Bit `bit` of byte `byte` in a run that begins with byte `first`.
const fn at(first: u16, byte: u16, bit: usize) -> usize {
    (byte - first) as usize * 8 + bit
}

impl AxisToNck {
    /// Requested machine functions, DBX5.0 to 5.6.
    #[must_use]
    #[inline]
    pub fn requested_machine_functions(&self) -> u8 {
        self.bit_range(at(Self::FIRST, 5, 6), at(Self::FIRST, 5, 0))
    }

    /// Handwheels to activate, DBX4.0 to 4.2.
    #[must_use]
    #[inline]
    pub fn activated_handwheels(&self) -> u8 {
        self.bit_range(at(Self::FIRST, 4, 2), at(Self::FIRST, 4, 0))
    }
}

impl ModeGroupToNck {
    /// Requested machine functions, DBX2.0 to 2.6.
    #[must_use]
    pub fn requested_machine_functions(&self) -> u8 {
        self.bit_range(at(Self::FIRST, 2, 6), at(Self::FIRST, 2, 0))
    }
}

impl AxisFromNck {
    /// Active machine function, DBX65.0 to 65.6.
    #[inline]
    pub fn set_active_machine_functions(&mut self, functions: u8) {
        self.set_bit_range(at(Self::FIRST, 65, 6), at(Self::FIRST, 65, 0), functions);
    }

    /// Active handwheels, DBX64.0 to 64.2.
    #[inline]
    pub fn set_active_handwheels(&mut self, handwheels: u8) {
        self.set_bit_range(at(Self::FIRST, 64, 2), at(Self::FIRST, 64, 0), handwheels);
    }
}

impl ModeGroupFromNck {
    /// Active machine function, DBX8.0 to 8.6.
    pub fn set_active_machine_functions(&mut self, functions: u8) {
        self.set_bit_range(at(Self::FIRST, 8, 6), at(Self::FIRST, 8, 0), functions);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that a group and the single bits of the tables are the same bits.
    #[test]
    fn a_group_reads_and_writes_the_bits_of_its_table() {
        let mut axis = AxisToNck::default();
        axis.set_machine_function_increment_1(true);
        axis.set_machine_function_continuous(true);
        axis.set_activate_handwheel_3(true);
        assert_eq!((axis.requested_machine_functions(), axis.activated_handwheels()), (0b100_0001, 0b100));
        let mut group = ModeGroupToNck::default();
        group.set_machine_function_increment_variable(true);
        assert_eq!(group.requested_machine_functions(), 0b10_0000);
        let mut shown = AxisFromNck::default();
        shown.set_active_machine_functions(0b10);
        shown.set_active_handwheels(0b10);
        assert!(shown.active_machine_function_increment_10() && shown.handwheel_2_active());
        assert!(!shown.active_machine_function_increment_1() && !shown.handwheel_1_active());
        let mut group = ModeGroupFromNck::default();
        group.set_active_machine_functions(0b100_0000);
        assert!(group.active_machine_function_continuous());
    }
}
