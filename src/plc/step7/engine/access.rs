//! How the engine reaches an operand: its place in the memory, and reads and writes there.

use crate::plc::step7::instruction::{Number, Operand, Register, Space, Width};

use super::cpu::{Cpu, Frame};
use super::fault::Fault;
use super::memory::{Area, Areas, OpenBlock};

/// Where an operand is.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) enum Where {
    Area(Area),
    /// The peripheral area: inputs are read, outputs are written.
    Peripheral,
    Block(OpenBlock),
    /// Local data from a byte to another one, both of the whole local data.
    Local(u32, u32),
}

/// The place of an operand, with its bit address there.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Spot {
    pub(in crate::plc::step7) at: Where,
    pub(in crate::plc::step7) bit: u32,
}

impl Spot {
    /// A place some bytes further.
    pub(in crate::plc::step7) fn after(self, bytes: u32) -> Self {
        Self { bit: self.bit + bytes * 8, ..self }
    }
}

/// A reference to the local data as parameters of functions have it: the bit address counts from the beginning of all local data.
const STACK: u32 = 0x88;

/// The bits of an address in a pointer: 16 for the byte, 3 for the bit.
const ADDRESS: u32 = 0x0007_FFFF;

impl Cpu {
    #[inline]
    pub(in crate::plc::step7) fn frame(&self) -> &Frame {
        self.work.frames.last().expect("statements run within a block")
    }

    fn in_space(&self, space: Space, bit: u32) -> Result<Spot, Fault> {
        let at = match space {
            Space::Peripheral => Where::Peripheral,
            Space::Inputs => Where::Area(Area::Inputs),
            Space::Outputs => Where::Area(Area::Outputs),
            Space::Flags => Where::Area(Area::Flags),
            Space::Data => Where::Block(self.data()?),
            Space::Instance => Where::Block(self.instance()?),
            Space::Local => {
                let (from, to) = self.frame().local;
                Where::Local(from, to)
            }
            Space::Caller => {
                let (from, to) = self.frame().caller;
                Where::Local(from, to)
            }
        };
        Ok(Spot { at, bit })
    }

    fn data(&self) -> Result<OpenBlock, Fault> {
        let db = self.state.registers.db;
        if db.number == 0 { Err(Fault::NoDataBlock(0)) } else { Ok(db) }
    }

    fn instance(&self) -> Result<OpenBlock, Fault> {
        let di = self.state.registers.di;
        if di.number == 0 { Err(Fault::NoInstance(0)) } else { Ok(di) }
    }

    pub(in crate::plc::step7) fn register(&self, register: Register) -> u32 {
        self.state.registers.ar[register as usize]
    }

    /// The place of an area-crossing pointer.
    pub(in crate::plc::step7) fn crossing(&self, pointer: u32) -> Result<Spot, Fault> {
        let space = match pointer >> 24 {
            0x80 => Space::Peripheral,
            0x81 => Space::Inputs,
            0x82 => Space::Outputs,
            0x83 => Space::Flags,
            0x84 => Space::Data,
            0x85 => Space::Instance,
            0x86 => Space::Local,
            0x87 => Space::Caller,
            code => return Err(Fault::AreaCode(u8::try_from(code).unwrap_or(0))),
        };
        self.in_space(space, pointer & ADDRESS)
    }

    /// The place to which a parameter of a function refers.
    pub(in crate::plc::step7) fn reference(&self, index: u16) -> Result<Spot, Fault> {
        let reference = self.parameter(index)?;
        if reference >> 24 == STACK {
            let end = u32::try_from(self.state.local.len()).unwrap_or(u32::MAX);
            return Ok(Spot { at: Where::Local(0, end), bit: reference & 0x00FF_FFFF });
        }
        self.crossing(reference)
    }

    /// A parameter of the function that runs.
    pub(in crate::plc::step7) fn parameter(&self, index: u16) -> Result<u32, Fault> {
        let (first, count) = self.frame().parameters;
        if index >= count {
            return Err(Fault::NoParameter(index));
        }
        Ok(self.work.parameters[first as usize + usize::from(index)])
    }

    /// The place of an operand. Operands in a data block that they name open it.
    #[inline]
    pub(in crate::plc::step7) fn spot<A: Areas>(&mut self, areas: &A, operand: Operand) -> Result<Spot, Fault> {
        match operand {
            Operand::Direct(space, bit) => self.in_space(space, bit),
            Operand::Block(number, bit) => {
                let block = areas.block(number).ok_or(Fault::NoDataBlock(number))?;
                self.state.registers.db = block;
                Ok(Spot { at: Where::Block(block), bit })
            }
            Operand::Own(bit) => {
                let from = self.state.registers.ar[1] & ADDRESS;
                Ok(Spot { at: Where::Block(self.instance()?), bit: from + bit })
            }
            operand => self.far_spot(areas, operand),
        }
    }

    fn far_spot<A: Areas>(&mut self, areas: &A, operand: Operand) -> Result<Spot, Fault> {
        match operand {
            Operand::Direct(..) | Operand::Block(..) | Operand::Own(_) => self.spot(areas, operand),
            Operand::Fixed(number, bit) => {
                let block = areas.block(number).ok_or(Fault::NoInstance(number))?;
                Ok(Spot { at: Where::Block(block), bit })
            }
            Operand::Indirect(space, from, bit) => {
                let pointer = self.in_space(from, bit)?;
                let pointer = self.read(areas, pointer, Width::Double)?;
                self.in_space(space, pointer & ADDRESS)
            }
            Operand::Register(space, register, offset) => {
                let register = self.register(register);
                let bit = register.wrapping_add(offset) & ADDRESS;
                match space {
                    Some(space) => self.in_space(space, bit),
                    None => self.crossing(register & 0xFF00_0000 | bit),
                }
            }
            Operand::Parameter(index) => self.reference(index),
            Operand::Element(index, offset) => {
                let pointer = self.reference(index)?;
                self.through(areas, pointer, offset)
            }
            Operand::Through(bit, offset) => {
                let pointer = self.spot(areas, Operand::Own(bit))?;
                self.through(areas, pointer, offset)
            }
        }
    }

    /// The place to which a POINTER of 6 bytes points; it opens its data block.
    fn through<A: Areas>(&mut self, areas: &A, pointer: Spot, offset: u32) -> Result<Spot, Fault> {
        let (number, pointer) = self.read_pointer(areas, pointer)?;
        if number != 0 {
            self.state.registers.db = areas.block(number).ok_or(Fault::NoDataBlock(number))?;
        }
        let spot = self.crossing(pointer)?;
        Ok(Spot { bit: spot.bit + offset, ..spot })
    }

    /// A POINTER: the number of the data block and the area-crossing pointer.
    pub(in crate::plc::step7) fn read_pointer<A: Areas>(&self, areas: &A, at: Spot) -> Result<(u16, u32), Fault> {
        let bytes: [u8; 6] = self.read_bytes(areas, at)?;
        let [high, low, pointer @ ..] = bytes;
        Ok((u16::from_be_bytes([high, low]), u32::from_be_bytes(pointer)))
    }

    /// An area-crossing pointer to a place, and the number of its data block: what a called block can use.
    pub(in crate::plc::step7) fn pointer_to(&self, spot: Spot) -> (u16, u32) {
        match spot.at {
            Where::Area(Area::Inputs) => (0, 0x81 << 24 | spot.bit),
            Where::Area(Area::Outputs) => (0, 0x82 << 24 | spot.bit),
            Where::Area(Area::Flags) => (0, 0x83 << 24 | spot.bit),
            Where::Peripheral => (0, 0x80 << 24 | spot.bit),
            Where::Block(block) => (block.number, 0x84 << 24 | spot.bit),
            Where::Local(from, _) => {
                let base = self.frame().local.0;
                (0, 0x87 << 24 | (from * 8 + spot.bit).wrapping_sub(base * 8) & ADDRESS)
            }
        }
    }

    /// The reference to a place for the parameter of a function.
    pub(in crate::plc::step7) fn reference_to(&self, spot: Spot) -> u32 {
        match spot.at {
            Where::Local(from, _) => STACK << 24 | (from * 8 + spot.bit),
            _ => self.pointer_to(spot).1,
        }
    }

    /// What `P##parameter` is: in the local data of the caller, area V.
    pub(in crate::plc::step7) fn parameter_address(&self, index: u16) -> Result<u32, Fault> {
        let reference = self.parameter(index)?;
        if reference >> 24 == STACK {
            let base = self.frame().caller.0 * 8;
            return Ok(0x87 << 24 | (reference & 0x00FF_FFFF).wrapping_sub(base) & ADDRESS);
        }
        Ok(reference)
    }

    /// The bytes from a place on.
    #[inline]
    pub(in crate::plc::step7) fn read_bytes<const N: usize>(
        &self,
        areas: &impl Areas,
        spot: Spot,
    ) -> Result<[u8; N], Fault> {
        if !spot.bit.is_multiple_of(8) {
            return Err(Fault::Alignment);
        }
        self.chunk(areas, spot)
    }

    /// The bytes from the byte of a place on.
    #[inline]
    fn chunk<const N: usize>(&self, areas: &impl Areas, spot: Spot) -> Result<[u8; N], Fault> {
        let byte = spot.bit / 8;
        let bytes = match spot.at {
            Where::Area(area) => slice(areas.bytes(area), byte),
            Where::Peripheral => {
                return slice(areas.bytes(Area::Inputs), byte).ok_or(Fault::Peripheral(byte));
            }
            Where::Block(block) => areas.read(block, byte),
            Where::Local(from, to) => slice(&self.state.local[..to as usize], from + byte),
        };
        bytes.ok_or(Fault::ReadLength(byte))
    }

    /// Writes bytes from a place on.
    #[inline]
    pub(in crate::plc::step7) fn write_bytes<const N: usize>(
        &mut self,
        areas: &mut impl Areas,
        spot: Spot,
        value: [u8; N],
    ) -> Result<(), Fault> {
        if !spot.bit.is_multiple_of(8) {
            return Err(Fault::Alignment);
        }
        self.set_chunk(areas, spot, value)
    }

    #[inline]
    fn set_chunk<const N: usize>(&mut self, areas: &mut impl Areas, spot: Spot, value: [u8; N]) -> Result<(), Fault> {
        let byte = spot.bit / 8;
        let written = match spot.at {
            Where::Area(area) => put(areas.bytes_mut(area), byte, value),
            Where::Peripheral => {
                return put(areas.bytes_mut(Area::Outputs), byte, value).ok_or(Fault::Peripheral(byte));
            }
            Where::Block(block) => areas.write(block, byte, value),
            Where::Local(from, to) => put(&mut self.state.local[..to as usize], from + byte, value),
        };
        written.ok_or(Fault::WriteLength(byte))
    }

    #[inline]
    pub(in crate::plc::step7) fn read_bit(&self, areas: &impl Areas, spot: Spot) -> Result<bool, Fault> {
        if let Where::Peripheral = spot.at {
            return Err(Fault::AreaCode(0x80));
        }
        let [byte] = self.chunk(areas, spot)?;
        Ok(byte >> (spot.bit % 8) & 1 == 1)
    }

    #[inline]
    pub(in crate::plc::step7) fn write_bit(
        &mut self,
        areas: &mut impl Areas,
        spot: Spot,
        value: bool,
    ) -> Result<(), Fault> {
        if let Where::Peripheral = spot.at {
            return Err(Fault::AreaCode(0x80));
        }
        let read: Result<[u8; 1], Fault> = self.chunk(areas, spot);
        let [byte] = read.map_err(|_| Fault::WriteLength(spot.bit / 8))?;
        let mask = 1 << (spot.bit % 8);
        self.set_chunk(areas, spot, [if value { byte | mask } else { byte & !mask }])
    }

    #[inline]
    pub(in crate::plc::step7) fn read(&self, areas: &impl Areas, spot: Spot, width: Width) -> Result<u32, Fault> {
        Ok(match width {
            Width::Bit => u32::from(self.read_bit(areas, spot)?),
            Width::Byte => {
                let [byte] = self.read_bytes(areas, spot)?;
                u32::from(byte)
            }
            Width::Word => u32::from(u16::from_be_bytes(self.read_bytes(areas, spot)?)),
            Width::Double => u32::from_be_bytes(self.read_bytes(areas, spot)?),
        })
    }

    #[inline]
    pub(in crate::plc::step7) fn write(
        &mut self,
        areas: &mut impl Areas,
        spot: Spot,
        width: Width,
        value: u32,
    ) -> Result<(), Fault> {
        let [first, second, third, last] = value.to_be_bytes();
        match width {
            Width::Bit => self.write_bit(areas, spot, value & 1 == 1),
            Width::Byte => self.write_bytes(areas, spot, [last]),
            Width::Word => self.write_bytes(areas, spot, [third, last]),
            Width::Double => self.write_bytes(areas, spot, [first, second, third, last]),
        }
    }

    /// A bit of an operand. Areas in one piece are reached without a detour, because most statements are of this kind.
    #[inline]
    pub(in crate::plc::step7) fn bit_of<A: Areas>(&mut self, areas: &A, operand: Operand) -> Result<bool, Fault> {
        if let Some((area, bit)) = plain(operand) {
            let byte = areas.bytes(area).get((bit / 8) as usize).ok_or(Fault::ReadLength(bit / 8))?;
            return Ok(byte >> (bit % 8) & 1 == 1);
        }
        self.far_bit(areas, operand)
    }

    #[inline(never)]
    fn far_bit<A: Areas>(&mut self, areas: &A, operand: Operand) -> Result<bool, Fault> {
        let spot = self.spot(areas, operand)?;
        self.read_bit(areas, spot)
    }

    /// Writes a bit of an operand.
    #[inline]
    pub(in crate::plc::step7) fn set_bit_of<A: Areas>(
        &mut self,
        areas: &mut A,
        operand: Operand,
        value: bool,
    ) -> Result<(), Fault> {
        if let Some((area, bit)) = plain(operand) {
            let byte = areas.bytes_mut(area).get_mut((bit / 8) as usize).ok_or(Fault::WriteLength(bit / 8))?;
            *byte = *byte & !(1 << (bit % 8)) | u8::from(value) << (bit % 8);
            return Ok(());
        }
        self.set_far_bit(areas, operand, value)
    }

    #[inline(never)]
    fn set_far_bit<A: Areas>(&mut self, areas: &mut A, operand: Operand, value: bool) -> Result<(), Fault> {
        let spot = self.spot(areas, operand)?;
        self.write_bit(areas, spot, value)
    }

    /// The value of an operand of bytes.
    #[inline]
    pub(in crate::plc::step7) fn value_of<A: Areas>(
        &mut self,
        areas: &A,
        operand: Operand,
        width: Width,
    ) -> Result<u32, Fault> {
        if let Some((area, bit)) = plain(operand) {
            let (bytes, byte) = (areas.bytes(area), bit / 8);
            let value = match width {
                Width::Bit | Width::Byte => slice::<1>(bytes, byte).map(|[value]| u32::from(value)),
                Width::Word => slice(bytes, byte).map(|value| u32::from(u16::from_be_bytes(value))),
                Width::Double => slice(bytes, byte).map(u32::from_be_bytes),
            };
            return value.ok_or(Fault::ReadLength(byte));
        }
        self.far_value(areas, operand, width)
    }

    #[inline(never)]
    fn far_value<A: Areas>(&mut self, areas: &A, operand: Operand, width: Width) -> Result<u32, Fault> {
        let spot = self.spot(areas, operand)?;
        self.read(areas, spot, width)
    }

    /// Writes an operand of bytes.
    #[inline]
    pub(in crate::plc::step7) fn set_value_of<A: Areas>(
        &mut self,
        areas: &mut A,
        operand: Operand,
        width: Width,
        value: u32,
    ) -> Result<(), Fault> {
        if let Some((area, bit)) = plain(operand) {
            let (bytes, byte) = (areas.bytes_mut(area), bit / 8);
            let [first, second, third, last] = value.to_be_bytes();
            let written = match width {
                Width::Bit | Width::Byte => put(bytes, byte, [last]),
                Width::Word => put(bytes, byte, [third, last]),
                Width::Double => put(bytes, byte, [first, second, third, last]),
            };
            return written.ok_or(Fault::WriteLength(byte));
        }
        self.set_far_value(areas, operand, width, value)
    }

    #[inline(never)]
    fn set_far_value<A: Areas>(
        &mut self,
        areas: &mut A,
        operand: Operand,
        width: Width,
        value: u32,
    ) -> Result<(), Fault> {
        let spot = self.spot(areas, operand)?;
        self.write(areas, spot, width, value)
    }

    /// The number of a timer, a counter or a block.
    pub(in crate::plc::step7) fn number(&mut self, areas: &impl Areas, number: Number) -> Result<u16, Fault> {
        let word = match number {
            Number::Direct(number) => return Ok(number),
            Number::At(space, bit) => {
                let spot = self.in_space(space, bit)?;
                self.read(areas, spot, Width::Word)?
            }
            Number::Parameter(index) => self.parameter(index)? & 0xFFFF,
            Number::Own(bit) => {
                let spot = self.spot(areas, Operand::Own(bit))?;
                self.read(areas, spot, Width::Word)?
            }
        };
        Ok(u16::try_from(word).unwrap_or(u16::MAX))
    }
}

/// An area in one piece, and the bit address in it.
#[inline]
fn plain(operand: Operand) -> Option<(Area, u32)> {
    match operand {
        Operand::Direct(Space::Inputs, bit) => Some((Area::Inputs, bit)),
        Operand::Direct(Space::Outputs, bit) => Some((Area::Outputs, bit)),
        Operand::Direct(Space::Flags, bit) => Some((Area::Flags, bit)),
        _ => None,
    }
}

#[inline]
fn slice<const N: usize>(bytes: &[u8], byte: u32) -> Option<[u8; N]> {
    bytes.get(byte as usize..)?.first_chunk().copied()
}

#[inline]
fn put<const N: usize>(bytes: &mut [u8], byte: u32, value: [u8; N]) -> Option<()> {
    *bytes.get_mut(byte as usize..)?.first_chunk_mut()? = value;
    Some(())
}
