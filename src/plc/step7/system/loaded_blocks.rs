//! SFC 23 and 82 to 84: data blocks that the program makes, deletes, and copies from and to the load memory; SFC 79 and 80: bits of a range;
//! SFC 51: the system state list; SFB 8 to 15 and 52 to 54: partners and modules that do not exist (P-153).

use std::sync::LazyLock;

use crate::plc::step7::engine::{Areas, Cpu, Fault, Spot};
use crate::plc::step7::instruction::Width;
use crate::plc::step7::text::types::Layout;

use super::interface::{SYSTEM, SystemBlock};
use super::transfer::error;

/// The list that SFC 51 has: the operating state of the CPU.
const OPERATING_STATE: u32 = 0x0424;

/// An SZL_ID that the CPU does not have.
const NO_LIST: u32 = 0x8082;

/// The instances of all built-in blocks.
static LAYOUTS: LazyLock<Vec<Layout>> = LazyLock::new(|| SYSTEM.iter().map(SystemBlock::layout).collect());

impl Cpu {
    /// DEL_DB: only data blocks that the program made itself.
    pub(in crate::plc::step7) fn delete_block<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let number = u16::try_from(self.argument(areas, 0, Width::Word)?).unwrap_or(0);
        let result = match areas.block(number) {
            _ if number == 0 => 0x80A1,
            None => 0x80B1,
            Some(_) if areas.delete(number) => 0,
            // It is in the load memory.
            Some(_) => 0x80B3,
        };
        self.result(areas, 1, result)
    }

    /// SET, RSET: N bits from SA on; nothing in a zone of the MCR that is off.
    pub(in crate::plc::step7) fn set_bits<A: Areas>(&mut self, areas: &mut A, value: bool) -> Result<(), Fault> {
        let count = self.argument(areas, 0, Width::Word)?;
        let caller_is_off = self.work.frames.last().is_some_and(|frame| frame.mcr.is_off());
        if caller_is_off || count > 0x7FFF {
            return self.result(areas, 1, 0);
        }
        let first = match self.element(areas, 2) {
            Ok(first) => first,
            Err(fault) => return self.result(areas, 1, error(3, fault)),
        };
        for bit in 0..count {
            let spot = Spot { bit: first.bit + bit, ..first };
            if let Err(fault) = self.write_bit(areas, spot, value) {
                return self.result(areas, 1, error(3, fault));
            }
        }
        self.result(areas, 1, 0)
    }

    /// CREA_DBL: as CREAT_DB, with the bytes of SRCBLK.
    pub(in crate::plc::step7) fn create_loaded<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        self.set_argument(areas, 7, Width::Bit, 0)?;
        if self.argument(areas, 0, Width::Bit)? == 0 {
            return self.result(areas, 6, 0);
        }
        let (result, made) = self.make_block(areas, [1, 2, 3])?;
        self.set_argument(areas, 8, Width::Word, made.into())?;
        if let (0, Some(block)) = (result, areas.block(made)) {
            let from = match self.region(areas, 5) {
                Ok(from) => from,
                Err(fault) => return self.result(areas, 6, error(6, fault)),
            };
            for byte in 0..from.bytes.min(block.length) {
                let value: [u8; 1] = self.read_bytes(areas, from.spot.after(byte))?;
                areas.write(block, byte, value);
            }
        }
        self.result(areas, 6, result)
    }

    /// READ_DBL, WRIT_DBL: the load memory has the data blocks as they are; the copy is done at once.
    pub(in crate::plc::step7) fn move_loaded<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        self.set_argument(areas, 3, Width::Bit, 0)?;
        if self.argument(areas, 0, Width::Bit)? == 0 {
            return self.result(areas, 2, 0);
        }
        self.move_block(areas, [1, 2, 4])
    }

    /// RDSYSST: list 0424h, the operating state; all others do not exist.
    pub(in crate::plc::step7) fn state_list<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        self.set_argument(areas, 4, Width::Bit, 0)?;
        if self.argument(areas, 0, Width::Bit)? == 0 {
            return self.result(areas, 3, 0);
        }
        if self.argument(areas, 1, Width::Word)? != OPERATING_STATE {
            self.write_element(areas, 5, [0; 4])?;
            return self.result(areas, 3, NO_LIST);
        }
        // The event "change to RUN", the state RUN, and the time.
        let mut record = [0; 20];
        record[..4].copy_from_slice(&[0x43, 0x02, 0xFF, 0x08]);
        record[12..].copy_from_slice(&self.date_and_time());
        let to = match self.region(areas, 6) {
            Ok(to) => to,
            Err(fault) => return self.result(areas, 3, error(7, fault)),
        };
        for (byte, value) in (0..to.bytes).zip(record) {
            self.write_bytes(areas, to.spot.after(byte), [value])?;
        }
        // The length of a record, and their number.
        self.write_element(areas, 5, [0, 20, 0, 1])?;
        // 8081h: the record did not fit.
        self.result(areas, 3, if to.bytes < 20 { 0x8081 } else { 0 })
    }

    /// MP_ALM: in a rack with one CPU OB60 runs on it.
    pub(in crate::plc::step7) fn multicomputing<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let job = self.argument(areas, 0, Width::Byte)?;
        if !(1..=15).contains(&job) {
            return self.result(areas, 1, 0x8090);
        }
        self.multicomputing_interrupt(areas, u8::try_from(job).unwrap_or(0))?;
        self.result(areas, 1, 0)
    }

    /// A function block whose partner does not exist: with a job ERROR and STATUS, else 0.
    pub(in crate::plc::step7) fn refuse<A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        status: u32,
    ) -> Result<(), Fault> {
        let layout = &LAYOUTS[usize::from(index)];
        let first = self.own(areas, 0, 0)?;
        let asks = status != 0 && self.read_bit(areas, first)?;
        for (name, value) in
            [("ERROR", asks), ("DONE", false), ("NDR", false), ("VALID", false), ("BUSY", false), ("NEW", false)]
        {
            if let Some(field) = layout.field(name) {
                let spot = self.own(areas, field.bit / 8, field.bit % 8)?;
                self.write_bit(areas, spot, value)?;
            }
        }
        let Some(field) = layout.field("STATUS") else { return Ok(()) };
        let spot = self.own(areas, field.bit / 8, 0)?;
        let width = field.ty.width().unwrap_or(Width::Word);
        self.write(areas, spot, width, if asks { status } else { 0 })
    }
}
