//! The operands that an observed CPU reads, with their values.

use super::memory::Area;

/// The operands that are followed of one value.
pub(in crate::plc::step7) const OPERANDS: usize = 8;
/// The operands that are kept of one change.
pub(in crate::plc::step7) const TESTED: usize = 24;

/// A place that has a name outside of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Named {
    Area(Area, u32),
    /// A data block by its number.
    Block(u16, u32),
    Timer(u16),
    Counter(u16),
    /// The part that the PLC writes to the NCK.
    ToNck(u32),
    /// The part that the NCK writes.
    FromNck(u32),
    /// The bit operation at an instruction, whose operand has no name: a status bit, a comparison, a local bit.
    Operation(u32),
}

/// An operand that was read, with the value that it had.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) struct Read {
    pub(in crate::plc::step7) named: Named,
    /// 1, 8, 16 or 32. Of a timer or a counter 1 is its status, 16 its value as it was loaded.
    pub(in crate::plc::step7) bits: u8,
    pub(in crate::plc::step7) value: u32,
}

impl Read {
    pub(in crate::plc::step7) const fn bit(named: Named, value: bool) -> Self {
        Self { named, bits: 1, value: value as u32 }
    }
}
