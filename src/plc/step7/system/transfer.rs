//! SFC 20, 21, 81: blocks of memory; SFC 14, 15: the peripheral area.

use arrayvec::ArrayVec;

use crate::plc::step7::engine::{Area, Areas, Cpu, Fault, Spot, Where};
use crate::plc::step7::instruction::Width;

use super::dispatch::own_local_is_the_callers;

/// The pieces of a copy that are followed.
const MOST: usize = 512;

/// A piece of memory to which an ANY points.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Region {
    pub(in crate::plc::step7) spot: Spot,
    pub(in crate::plc::step7) bytes: u32,
    /// The code of its type.
    pub(in crate::plc::step7) code: u8,
}

/// `RET_VAL` for an error of a parameter, counted from one.
pub(super) fn error(parameter: u32, fault: Fault) -> u32 {
    0x8000 | parameter << 8 | u32::from(fault.code().unwrap_or(0x7F))
}

impl Cpu {
    /// The memory of a parameter of the type ANY.
    pub(in crate::plc::step7) fn region<A: Areas>(&mut self, areas: &A, index: u16) -> Result<Region, Fault> {
        let at = self.reference(index)?;
        self.region_at(areas, at)
    }

    /// The memory to which an ANY at a place points.
    pub(in crate::plc::step7) fn region_at<A: Areas>(&mut self, areas: &A, at: Spot) -> Result<Region, Fault> {
        let bytes: [u8; 10] = self.read_bytes(areas, at)?;
        let [syntax, code, count_high, count_low, block_high, block_low, pointer @ ..] = bytes;
        if syntax != 0x10 {
            return Err(Fault::AreaCode(syntax));
        }
        let count = u32::from(u16::from_be_bytes([count_high, count_low]));
        let pointer = u32::from_be_bytes(pointer);
        let number = u16::from_be_bytes([block_high, block_low]);
        let size = match code {
            // BOOL: whole bytes only.
            0x01 if count % 8 == 0 || count == 1 => return self.bits(areas, number, pointer, count),
            0x02 | 0x03 => 1,
            0x04 | 0x05 | 0x09 | 0x0C => 2,
            0x06..=0x08 | 0x0A | 0x0B => 4,
            0x0E => 8,
            0x13 => return self.text(areas, number, pointer),
            code => return Err(Fault::AreaCode(code)),
        };
        let spot = self.pointed(areas, number, pointer)?;
        if spot.bit % 8 != 0 {
            return Err(Fault::Alignment);
        }
        Ok(Region { spot, bytes: count * size, code })
    }

    fn bits<A: Areas>(&mut self, areas: &A, number: u16, pointer: u32, count: u32) -> Result<Region, Fault> {
        let spot = self.pointed(areas, number, pointer)?;
        if spot.bit % 8 != 0 {
            return Err(Fault::Alignment);
        }
        Ok(Region { spot, bytes: count.div_ceil(8), code: 0x01 })
    }

    /// A STRING: its maximum length says how long it is.
    fn text<A: Areas>(&mut self, areas: &A, number: u16, pointer: u32) -> Result<Region, Fault> {
        let spot = self.pointed(areas, number, pointer)?;
        let [maximum]: [u8; 1] = self.read_bytes(areas, spot)?;
        Ok(Region { spot, bytes: u32::from(maximum) + 2, code: 0x13 })
    }

    fn pointed<A: Areas>(&mut self, areas: &A, number: u16, pointer: u32) -> Result<Spot, Fault> {
        let db = self.state.registers.db;
        if number != 0 {
            self.state.registers.db = areas.block(number).ok_or(Fault::NoDataBlock(number))?;
        }
        let spot = self.crossing(own_local_is_the_callers(pointer));
        self.state.registers.db = db;
        spot
    }

    fn byte_of<A: Areas>(&self, areas: &A, region: &Region, byte: u32) -> Result<u8, Fault> {
        let [value] = self.read_bytes(areas, region.spot.after(byte))?;
        Ok(value)
    }

    /// BLKMOV: the smaller of both lengths, ascending; the parameters of the source, the result and the target.
    pub(in crate::plc::step7) fn move_block<A: Areas>(
        &mut self,
        areas: &mut A,
        [source, result, target]: [u16; 3],
    ) -> Result<(), Fault> {
        let number = |parameter: u16| u32::from(parameter) + 1;
        let (from, to) = match (self.region(areas, source), self.region(areas, target)) {
            (Ok(from), Ok(to)) => (from, to),
            (Err(fault), _) => return self.result(areas, result, error(number(source), fault)),
            (_, Err(fault)) => return self.result(areas, result, error(number(target), fault)),
        };
        let before = self.pieces(areas, &to, from.bytes.min(to.bytes));
        for byte in 0..from.bytes.min(to.bytes) {
            let value = match self.byte_of(areas, &from, byte) {
                Ok(value) => value,
                Err(fault) => return self.result(areas, result, error(number(source), fault)),
            };
            if let Err(fault) = self.write_bytes(areas, to.spot.after(byte), [value]) {
                return self.result(areas, result, error(number(target), fault));
            }
        }
        self.note_pieces(areas, (&from, &to), &before, |byte| byte);
        self.result(areas, result, 0)
    }

    /// FILL: the pattern is repeated, its last part is cut.
    pub(in crate::plc::step7) fn fill<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let (pattern, to) = match (self.region(areas, 0), self.region(areas, 2)) {
            (Ok(pattern), Ok(to)) => (pattern, to),
            (Err(fault), _) => return self.result(areas, 1, error(1, fault)),
            (_, Err(fault)) => return self.result(areas, 1, error(3, fault)),
        };
        if pattern.bytes == 0 {
            return self.result(areas, 1, 0);
        }
        let before = self.pieces(areas, &to, to.bytes);
        for byte in 0..to.bytes {
            let value = match self.byte_of(areas, &pattern, byte % pattern.bytes) {
                Ok(value) => value,
                Err(fault) => return self.result(areas, 1, error(1, fault)),
            };
            if let Err(fault) = self.write_bytes(areas, to.spot.after(byte), [value]) {
                return self.result(areas, 1, error(3, fault));
            }
        }
        self.note_pieces(areas, (&pattern, &to), &before, |byte| byte % pattern.bytes);
        self.result(areas, 1, 0)
    }

    /// The pieces of a region before a copy, for an observed CPU: words and what is left of them.
    fn pieces<A: Areas>(&self, areas: &A, region: &Region, bytes: u32) -> Vec<(u32, Width, u32)> {
        let mut pieces = Vec::new();
        let mut byte = 0;
        while self.observed.is_some() && byte < bytes && pieces.len() < MOST {
            let width = if bytes - byte >= 2 { Width::Word } else { Width::Byte };
            let Ok(value) = self.read(areas, region.spot.after(byte), width) else { break };
            pieces.push((byte, width, value));
            byte += width.bits() / 8;
        }
        pieces
    }

    /// After a copy: the pieces that changed, each with the piece of the source that it has now.
    fn note_pieces<A: Areas>(
        &mut self,
        areas: &A,
        (from, to): (&Region, &Region),
        before: &[(u32, Width, u32)],
        source: impl Fn(u32) -> u32,
    ) {
        let inputs = self.observed.as_mut().map(|observed| std::mem::take(&mut observed.inputs));
        for &(byte, width, old) in before {
            let spot = to.spot.after(byte);
            let Ok(now) = self.read(areas, spot, width) else { continue };
            let mut read = ArrayVec::new();
            let at = from.spot.after(source(byte));
            let is_whole = source(byte) + width.bits() / 8 <= from.bytes;
            if is_whole && let Ok(value) = self.read(areas, at, width) {
                self.note_read(at, width, value, &mut read);
            }
            if let Some(observed) = &mut self.observed {
                observed.inputs = read;
            }
            self.note_called(areas, spot, width.bits(), (old, now));
        }
        if let (Some(observed), Some(inputs)) = (&mut self.observed, inputs) {
            observed.inputs = inputs;
        }
    }

    /// DPRD_DAT: from the peripheral area at LADDR.
    pub(in crate::plc::step7) fn read_consistent<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let start = self.argument(areas, 0, Width::Word)?;
        let to = match self.region(areas, 2) {
            Ok(to) => to,
            Err(fault) => return self.result(areas, 1, error(3, fault)),
        };
        // 80A0h: an access error of the peripheral area.
        if (start + to.bytes) as usize > areas.bytes(Area::Inputs).len() {
            return self.result(areas, 1, 0x80A0);
        }
        for byte in 0..to.bytes {
            let from = Spot { at: Where::Peripheral, bit: (start + byte) * 8 };
            let [value]: [u8; 1] = self.read_bytes(areas, from)?;
            if let Err(fault) = self.write_bytes(areas, to.spot.after(byte), [value]) {
                return self.result(areas, 1, error(3, fault));
            }
        }
        self.result(areas, 1, 0)
    }

    /// DPWR_DAT: to the peripheral area at LADDR.
    pub(in crate::plc::step7) fn write_consistent<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        let start = self.argument(areas, 0, Width::Word)?;
        let from = match self.region(areas, 1) {
            Ok(from) => from,
            Err(fault) => return self.result(areas, 2, error(2, fault)),
        };
        // 80A1h: an access error when writing.
        if (start + from.bytes) as usize > areas.bytes(Area::Outputs).len() {
            return self.result(areas, 2, 0x80A1);
        }
        for byte in 0..from.bytes {
            let value = match self.byte_of(areas, &from, byte) {
                Ok(value) => value,
                Err(fault) => return self.result(areas, 2, error(2, fault)),
            };
            self.write_bytes(areas, Spot { at: Where::Peripheral, bit: (start + byte) * 8 }, [value])?;
        }
        self.result(areas, 2, 0)
    }
}
