//! Calls: parameters, registers of the data blocks, local data, and what comes back at the end of a block.

use crate::plc::step7::instruction::{
    BlockKind, BlockName, CopySource, Instance, Number, Operand, ParameterSource, Pointed, Target, Width,
};
use crate::plc::step7::system::{SYSTEM, by_number};

use super::access::{Spot, Where};
use super::cpu::{Cpu, Frame, McrState};
use super::fault::Fault;
use super::memory::{Areas, OpenBlock};
use super::timer::{Counter, Timer};

/// What AR2 is at the beginning of an instance: byte 0 of a data block.
const BEGIN: u32 = 0x8400_0000;

impl Cpu {
    pub(in crate::plc::step7) fn timer_at(&mut self, areas: &impl Areas, number: Number) -> Result<&mut Timer, Fault> {
        let number = self.number(areas, number)?;
        self.state.timers.get_mut(usize::from(number)).ok_or(Fault::TimerNumber(number))
    }

    pub(in crate::plc::step7) fn counter_at(
        &mut self,
        areas: &impl Areas,
        number: Number,
    ) -> Result<&mut Counter, Fault> {
        let number = self.number(areas, number)?;
        self.state.counters.get_mut(usize::from(number)).ok_or(Fault::CounterNumber(number))
    }

    /// A call with parameters; returns where to go on.
    pub(in crate::plc::step7) fn call<A: Areas>(&mut self, areas: &mut A, index: u32, pc: u32) -> Result<u32, Fault> {
        let site = self.program.calls[index as usize];
        let first = self.work.parameters.len();
        for number in site.first..site.first + u32::from(site.count) {
            let reference = match self.program.parameters[number as usize] {
                ParameterSource::Reference(operand) => self.spot(areas, operand).map(|spot| self.reference_to(spot)),
                ParameterSource::Number(number) => self.number(areas, number).map(u32::from),
            };
            match reference {
                Ok(reference) => self.work.parameters.push(reference),
                Err(fault) => {
                    self.work.parameters.truncate(first);
                    return Err(fault);
                }
            }
        }
        let status = &mut self.state.registers.status;
        (status.os, status.or, status.sta, status.fc) = (false, false, true, false);
        let from = u32::try_from(first).unwrap_or(u32::MAX);
        let entered = self.enter(areas, site.target, site.instance, (from, site.count), pc);
        if entered.is_err() {
            self.work.parameters.truncate(first);
        }
        entered
    }

    /// `UC` and `CC` of a block that is known.
    pub(in crate::plc::step7) fn call_plain<A: Areas>(
        &mut self,
        areas: &mut A,
        target: Target,
        pc: u32,
    ) -> Result<u32, Fault> {
        let first = u32::try_from(self.work.parameters.len()).unwrap_or(u32::MAX);
        self.enter(areas, target, Instance::None, (first, 0), pc)
    }

    /// `UC` and `CC` of a block by its number.
    pub(in crate::plc::step7) fn call_number<A: Areas>(
        &mut self,
        areas: &mut A,
        kind: BlockKind,
        number: u16,
        pc: u32,
    ) -> Result<u32, Fault> {
        let target = match self.program.find(kind, number) {
            Some(index) => Target::Block(index),
            None => match by_number(BlockName { kind, number }).filter(|&index| SYSTEM[index].parameters.is_empty()) {
                Some(index) => Target::System(u16::try_from(index).unwrap_or(u16::MAX)),
                None => {
                    return Err(match kind {
                        BlockKind::Fb | BlockKind::Sfb => Fault::NoFunctionBlock(number),
                        BlockKind::Sfc => Fault::NoSystemFunction(number),
                        _ => Fault::NoFunction(number),
                    });
                }
            },
        };
        self.call_plain(areas, target, pc)
    }

    fn enter<A: Areas>(
        &mut self,
        areas: &mut A,
        target: Target,
        instance: Instance,
        parameters: (u32, u16),
        pc: u32,
    ) -> Result<u32, Fault> {
        let registers = self.state.registers;
        let (db, di, ar2) = match instance {
            Instance::None => (registers.db, registers.di, None),
            Instance::Block(number) => {
                let block = areas.block(number).ok_or(Fault::NoInstance(number))?;
                self.state.registers.db = registers.di;
                self.state.registers.di = block;
                self.state.registers.ar[1] = BEGIN;
                (block, registers.di, Some(registers.ar[1]))
            }
            Instance::Within(bit) => {
                let ar2 = registers.ar[1];
                self.state.registers.db = registers.di;
                self.state.registers.ar[1] = ar2 & 0xFF00_0000 | ar2.wrapping_add(bit) & 0x00FF_FFFF;
                (registers.di, registers.di, Some(ar2))
            }
        };
        let local = match target {
            Target::Block(index) => self.program.blocks[usize::from(index)].local,
            Target::System(_) | Target::Nothing => 0,
        };
        let pushed = self.push(local, parameters, pc, (db, di, ar2));
        if let Err(fault) = pushed {
            self.state.registers = registers;
            return Err(fault);
        }
        match target {
            Target::Block(index) => Ok(self.program.blocks[usize::from(index)].start),
            Target::System(index) => {
                let done = self.built_in(areas, index);
                self.leave();
                done.map(|()| pc)
            }
            Target::Nothing => Ok(self.leave()),
        }
    }

    /// Calls a function of the user with one byte as its parameter, and comes back when it has ended.
    pub(in crate::plc::step7) fn call_user<A: Areas>(
        &mut self,
        areas: &mut A,
        index: u16,
        value: u8,
    ) -> Result<(), Fault> {
        // The last byte of the local data is nobody's.
        let Some(last) = self.state.local.len().checked_sub(1) else { return Ok(()) };
        self.state.local[last] = value;
        let last = u32::try_from(last).unwrap_or(u32::MAX);
        let first = u32::try_from(self.work.parameters.len()).unwrap_or(u32::MAX);
        let parameter = self.reference_to(Spot { at: Where::Local(last, last + 1), bit: 0 });
        self.work.parameters.push(parameter);
        let registers = self.state.registers;
        let start = self.enter(areas, Target::Block(index), Instance::None, (first, 1), u32::MAX)?;
        self.run(areas, start)?;
        self.state.registers = registers;
        Ok(())
    }

    /// Begins a block.
    pub(in crate::plc::step7) fn push(
        &mut self,
        local: u32,
        parameters: (u32, u16),
        back: u32,
        (db, di, ar2): (OpenBlock, OpenBlock, Option<u32>),
    ) -> Result<(), Fault> {
        let frames = self.work.frames.len();
        let depth = usize::from(self.options.call_depth) * (1 + usize::from(self.work.in_error));
        if frames > depth {
            return Err(Fault::CallDepth);
        }
        // OB121 and OB122 have the second half of the local data for themselves.
        let class = self.options.local_data * u32::from(self.work.in_error);
        let caller = self.work.frames.last().map_or((class, class), |frame| frame.local);
        let from = caller.1.max(class);
        let to = from + local;
        if to > class + self.options.local_data {
            return Err(Fault::LocalData);
        }
        let nests = u32::try_from(self.work.nests.len()).unwrap_or(u32::MAX);
        self.work.frames.push(Frame {
            back,
            local: (from, to),
            caller,
            parameters,
            nests,
            db,
            di,
            ar2,
            mcr: self.work.mcr,
        });
        self.work.mcr = McrState::default();
        Ok(())
    }

    /// Ends a block: what the caller had comes back. Returns where it goes on.
    pub(in crate::plc::step7) fn leave(&mut self) -> u32 {
        let Some(frame) = self.work.frames.pop() else { return 0 };
        self.work.parameters.truncate(frame.parameters.0 as usize);
        self.work.nests.truncate(frame.nests as usize);
        self.work.mcr = frame.mcr;
        self.state.registers.db = frame.db;
        self.state.registers.di = frame.di;
        if let Some(ar2) = frame.ar2 {
            self.state.registers.ar[1] = ar2;
        }
        frame.back
    }

    /// Copies a parameter, before or after a call.
    pub(in crate::plc::step7) fn copy<A: Areas>(&mut self, areas: &mut A, index: u32) -> Result<(), Fault> {
        let copy = self.program.copies[index as usize];
        let width = match copy.bits {
            1 => Some(Width::Bit),
            8 => Some(Width::Byte),
            16 => Some(Width::Word),
            32 => Some(Width::Double),
            _ => None,
        };
        let from = match copy.from {
            CopySource::Constant(value) => return self.put(areas, copy.to, width, value),
            CopySource::Number(number) => {
                let value = u32::from(self.number(areas, number)?);
                return self.put(areas, copy.to, width, value);
            }
            CopySource::Operand(operand) => self.spot(areas, operand)?,
        };
        if let Some(width) = width {
            let value = self.read(areas, from, width)?;
            return self.put(areas, copy.to, Some(width), value);
        }
        let to = self.spot(areas, copy.to)?;
        for byte in 0..copy.bits / 8 {
            let [value]: [u8; 1] = self.read_bytes(areas, from.after(byte))?;
            self.write_bytes(areas, to.after(byte), [value])?;
        }
        Ok(())
    }

    fn put<A: Areas>(&mut self, areas: &mut A, to: Operand, width: Option<Width>, value: u32) -> Result<(), Fault> {
        let to = self.spot(areas, to)?;
        self.write(areas, to, width.unwrap_or(Width::Double), value)
    }

    /// Writes a POINTER or an ANY for a call.
    pub(in crate::plc::step7) fn make_pointer<A: Areas>(&mut self, areas: &mut A, index: u32) -> Result<(), Fault> {
        let made = self.program.pointers[index as usize];
        let registers = self.state.registers;
        let (block, pointer) = match made.pointed {
            // A partly qualified operand: the called block has other data blocks open.
            Pointed::Constant(0, pointer) if pointer >> 24 == 0x84 => (registers.db.number, pointer),
            Pointed::Constant(0, pointer) if pointer >> 24 == 0x85 => {
                (registers.di.number, 0x84 << 24 | pointer & 0x00FF_FFFF)
            }
            Pointed::Constant(block, pointer) => (block, pointer),
            Pointed::Local(bit) => (0, 0x87 << 24 | bit),
            Pointed::Own(bit) => (registers.di.number, BEGIN | (registers.ar[1].wrapping_add(bit) & 0x00FF_FFFF)),
            Pointed::Parameter(index) => {
                let spot = self.reference(index)?;
                self.pointer_to(spot)
            }
            Pointed::Element(index, offset) => self.pointer_through(areas, Operand::Element(index, offset))?,
            Pointed::Through(bit, offset) => self.pointer_through(areas, Operand::Through(bit, offset))?,
        };
        let to = self.spot(areas, made.to)?;
        let mut at = to;
        if let Some((code, count)) = made.any {
            let [high, low] = count.to_be_bytes();
            self.write_bytes(areas, to, [0x10, code, high, low])?;
            at = to.after(4);
        }
        self.write_bytes(areas, at, block.to_be_bytes())?;
        self.write_bytes(areas, at.after(2), pointer.to_be_bytes())
    }

    /// The pointer to a part of a parameter, without opening its data block.
    fn pointer_through<A: Areas>(&mut self, areas: &A, operand: Operand) -> Result<(u16, u32), Fault> {
        let db = self.state.registers.db;
        let spot = self.spot(areas, operand);
        self.state.registers.db = db;
        spot.map(|spot| self.pointer_to(spot))
    }
}
