//! The operations on accumulators and registers, timers, counters and calls: what [`Cpu::execute`] does not do itself.

use crate::plc::step7::instruction::{
    Accumulators, Condition, DataRegister, Mcr, Op, Register, Shift, StatusBit, Width, WordLogic,
};

use super::arithmetic::{Sets, convert, low, shift, with_low};
use super::cpu::Cpu;
use super::fault::Fault;
use super::memory::{Areas, OpenBlock};
use super::registers::Status;
use super::timer::bcd;

/// The open MCR zones of a block.
const ZONES: u8 = 8;

impl Cpu {
    /// The operations that are less frequent.
    #[inline(never)]
    #[expect(clippy::too_many_lines, reason = "one arm for each instruction")]
    pub(in crate::plc::step7) fn operation<A: Areas>(
        &mut self,
        areas: &mut A,
        op: Op,
        pc: &mut u32,
    ) -> Result<(), Fault> {
        match op {
            Op::LogicTimer(logic, number) => {
                let now = self.work.now;
                let x = self.timer_at(areas, number)?.status(now);
                self.logic(logic, x);
            }
            Op::LogicCounter(logic, number) => {
                let x = self.counter_at(areas, number)?.value != 0;
                self.logic(logic, x);
            }
            Op::LogicStatus(logic, bit) => {
                let x = status_bit(self.state.registers.status, bit);
                self.logic(logic, x);
            }
            Op::Not => {
                let status = &mut self.state.registers.status;
                status.rlo = !status.rlo;
                status.sta = true;
            }
            Op::SetRlo(value) => {
                let status = &mut self.state.registers.status;
                (status.or, status.sta, status.rlo, status.fc) = (false, value, value, false);
            }
            Op::Save => self.state.registers.status.br = self.state.registers.status.rlo,
            Op::AddWord(value) => {
                let accu1 = self.state.registers.accu[0];
                self.state.registers.accu[0] = with_low(accu1, low(accu1).wrapping_add(value.cast_signed()));
            }
            Op::AddDouble(value) => {
                self.state.registers.accu[0] = self.state.registers.accu[0].wrapping_add(value);
            }
            Op::Convert(operation) => {
                let (value, sets) = convert(operation, self.state.registers.accu[0])?;
                self.state.registers.accu[0] = value;
                match sets {
                    Sets::Nothing => {}
                    Sets::Overflow(ov) => {
                        self.state.registers.status.ov = ov;
                        self.state.registers.status.os |= ov;
                    }
                    Sets::All(codes) => self.codes(codes),
                }
            }
            Op::WordLogic(logic, width) => self.word_logic(logic, width, self.state.registers.accu[1]),
            Op::WordLogicConstant(logic, width, value) => self.word_logic(logic, width, value),
            Op::Shift(operation) => {
                let count = self.state.registers.accu[1].to_be_bytes()[3];
                self.shift(operation, count);
            }
            Op::ShiftBy(operation, count) => self.shift(operation, count),
            // An S7-300 loads RLO, OS, OV, CC0, CC1 and BR.
            Op::LoadStatus => self.load(u32::from(self.state.registers.status.word() & 0b1_1111_0010)),
            Op::LoadData(register) => self.load_data(register),
            Op::LoadTimer(is_bcd, number) => {
                let now = self.work.now;
                let timer = self.timer_at(areas, number)?;
                let (value, base) = (timer.value(now), timer.base());
                let value = if is_bcd { u32::from(base) << 12 | u32::from(bcd(value)) } else { u32::from(value) };
                self.load(value);
            }
            Op::LoadCounter(is_bcd, number) => {
                let value = self.counter_at(areas, number)?.value;
                self.load(if is_bcd { u32::from(bcd(value)) } else { u32::from(value) });
            }
            Op::LoadParameterAddress(index) => {
                let address = self.parameter_address(index)?;
                self.load(address);
            }
            Op::TransferStatus => {
                let word = self.state.registers.accu[0] & 0x1FF;
                self.state.registers.status = Status::from_word(u16::try_from(word).unwrap_or(0));
            }
            Op::Accumulators(operation) => self.accumulators(operation),
            Op::Increment(count) => self.step_low_byte(|byte| byte.wrapping_add(count)),
            Op::Decrement(count) => self.step_low_byte(|byte| byte.wrapping_sub(count)),
            Op::RegisterFromAccu(register) => self.set_register(register, self.state.registers.accu[0]),
            Op::RegisterFromConstant(register, value) => self.set_register(register, value),
            Op::RegisterFromOperand(register, operand) => {
                let spot = self.spot(areas, operand)?;
                let value = self.read(areas, spot, Width::Double)?;
                self.set_register(register, value);
            }
            Op::RegisterFromParameterAddress(register, index) => {
                let address = self.parameter_address(index)?;
                self.set_register(register, address);
            }
            Op::RegisterFromOther => self.state.registers.ar[0] = self.state.registers.ar[1],
            Op::AccuFromRegister(register) => self.load(self.register(register)),
            Op::OperandFromRegister(register, operand) => {
                let value = self.register(register);
                let spot = self.spot(areas, operand)?;
                self.write(areas, spot, Width::Double, value)?;
            }
            Op::OtherFromRegister => self.state.registers.ar[1] = self.state.registers.ar[0],
            Op::SwapRegisters => self.state.registers.ar.swap(0, 1),
            Op::AddRegister(register) => {
                let value = i32::from(low(self.state.registers.accu[0])).cast_unsigned();
                self.add_register(register, value);
            }
            Op::AddRegisterConstant(register, value) => self.add_register(register, value),
            Op::OpenDb(number) => {
                let number = self.number(areas, number)?;
                self.state.registers.db = open(areas, number).ok_or(Fault::NoDataBlock(number))?;
            }
            Op::OpenDi(number) => {
                let number = self.number(areas, number)?;
                self.state.registers.di = open(areas, number).ok_or(Fault::NoInstance(number))?;
            }
            Op::SwapDb => {
                let registers = &mut self.state.registers;
                std::mem::swap(&mut registers.db, &mut registers.di);
            }
            Op::JumpList(count, target) => {
                let index = u32::from(self.state.registers.accu[0].to_be_bytes()[3]);
                *pc = if index < u32::from(count) { *pc + index } else { target };
            }
            Op::End(condition) => {
                let status = &mut self.state.registers.status;
                (status.or, status.sta, status.fc) = (false, true, false);
                if condition == Condition::Always || status.rlo {
                    status.os = false;
                    *pc = self.leave();
                } else {
                    status.rlo = true;
                }
            }
            Op::Mcr(mcr) => self.mcr(mcr)?,
            Op::StartTimer(kind, number) => {
                let now = self.work.now;
                let (rlo, accu1) = (self.state.registers.status.rlo, self.state.registers.accu[0]);
                self.timer_at(areas, number)?.start(kind, rlo, accu1, now)?;
                self.end_of_string();
            }
            Op::FreeTimer(number) => {
                let rlo = self.state.registers.status.rlo;
                self.timer_at(areas, number)?.free(rlo);
                self.end_of_string();
            }
            Op::ResetTimer(number) => {
                let rlo = self.state.registers.status.rlo;
                let timer = self.timer_at(areas, number)?;
                if rlo {
                    timer.reset();
                }
                self.end_of_string();
            }
            Op::CountUp(number) => {
                let rlo = self.state.registers.status.rlo;
                self.counter_at(areas, number)?.count_up(rlo);
                self.end_of_string();
            }
            Op::CountDown(number) => {
                let rlo = self.state.registers.status.rlo;
                self.counter_at(areas, number)?.count_down(rlo);
                self.end_of_string();
            }
            Op::SetCounter(number) => {
                let (rlo, accu1) = (self.state.registers.status.rlo, self.state.registers.accu[0]);
                self.counter_at(areas, number)?.set(rlo, accu1)?;
                self.end_of_string();
            }
            Op::ResetCounter(number) => {
                let rlo = self.state.registers.status.rlo;
                let counter = self.counter_at(areas, number)?;
                if rlo {
                    counter.value = 0;
                }
                self.end_of_string();
            }
            Op::FreeCounter(number) => {
                let rlo = self.state.registers.status.rlo;
                self.counter_at(areas, number)?.free(rlo);
                self.end_of_string();
            }
            Op::Copy(index) => self.copy(areas, index)?,
            Op::Pointer(index) => self.make_pointer(areas, index)?,
            Op::Call(index) => *pc = self.call(areas, index, *pc)?,
            Op::CallPlain(condition, target) => {
                if self.calls(condition) {
                    *pc = self.call_plain(areas, target, *pc)?;
                }
            }
            Op::CallNumber(condition, kind, number) => {
                if self.calls(condition) {
                    let number = self.number(areas, number)?;
                    *pc = self.call_number(areas, kind, number, *pc)?;
                }
            }
            // [`Cpu::execute`] keeps these.
            Op::Nothing
            | Op::Logic(..)
            | Op::OrBeforeAnd
            | Op::OpenNest(_)
            | Op::CloseNest
            | Op::Assign(_)
            | Op::Set(_)
            | Op::Reset(_)
            | Op::Edge(..)
            | Op::Compare(..)
            | Op::Arithmetic(..)
            | Op::Load(..)
            | Op::LoadConstant(_)
            | Op::Transfer(..)
            | Op::Jump(..) => {}
        }
        Ok(())
    }

    fn end_of_string(&mut self) {
        let status = &mut self.state.registers.status;
        status.or = false;
        status.fc = false;
    }

    fn word_logic(&mut self, logic: WordLogic, width: Width, other: u32) {
        let accu1 = self.state.registers.accu[0];
        let result = match logic {
            WordLogic::And => accu1 & other,
            WordLogic::Or => accu1 | other,
            WordLogic::Xor => accu1 ^ other,
        };
        if width == Width::Double {
            self.state.registers.accu[0] = result;
            self.code_bit(result != 0);
        } else {
            self.state.registers.accu[0] = with_low(accu1, low(result));
            self.code_bit(low(result) != 0);
        }
    }

    fn shift(&mut self, operation: Shift, count: u8) {
        if let Some((value, cc1)) = shift(operation, self.state.registers.accu[0], count) {
            self.state.registers.accu[0] = value;
            self.code_bit(cc1);
        }
    }

    fn load_data(&mut self, register: DataRegister) {
        let registers = &self.state.registers;
        let value = match register {
            DataRegister::DbLength => registers.db.length,
            DataRegister::DbNumber => u32::from(registers.db.number),
            DataRegister::DiLength => registers.di.length,
            DataRegister::DiNumber => u32::from(registers.di.number),
        };
        self.load(value);
    }

    fn accumulators(&mut self, operation: Accumulators) {
        let has_four = self.options.has_four_accumulators;
        let accu = &mut self.state.registers.accu;
        let [first, second, third, fourth] = *accu;
        match operation {
            Accumulators::Swap => accu.swap(0, 1),
            Accumulators::Push if has_four => *accu = [first, first, second, third],
            Accumulators::Push => accu[1] = first,
            Accumulators::Pop if has_four => *accu = [second, third, fourth, fourth],
            Accumulators::Pop => accu[0] = second,
            Accumulators::Enter => *accu = [first, second, second, third],
            Accumulators::Leave => *accu = [first, third, fourth, fourth],
            Accumulators::RotateLeftThroughCc1 => {
                accu[0] = first << 1 | u32::from(self.state.registers.status.cc1);
                self.code_bit(first >> 31 == 1);
            }
            Accumulators::RotateRightThroughCc1 => {
                accu[0] = first >> 1 | u32::from(self.state.registers.status.cc1) << 31;
                self.code_bit(first & 1 == 1);
            }
        }
    }

    fn step_low_byte(&mut self, change: impl FnOnce(u8) -> u8) {
        let [first, second, third, last] = self.state.registers.accu[0].to_be_bytes();
        self.state.registers.accu[0] = u32::from_be_bytes([first, second, third, change(last)]);
    }

    fn set_register(&mut self, register: Register, value: u32) {
        self.state.registers.ar[register as usize] = value;
    }

    /// Adds to the 24 bits of the address; the area stays.
    fn add_register(&mut self, register: Register, value: u32) {
        let old = self.register(register);
        self.set_register(register, old & 0xFF00_0000 | old.wrapping_add(value) & 0x00FF_FFFF);
    }

    fn mcr(&mut self, mcr: Mcr) -> Result<(), Fault> {
        let state = &mut self.work.mcr;
        let status = &mut self.state.registers.status;
        match mcr {
            Mcr::Activate => state.active = true,
            Mcr::Deactivate => state.active = false,
            Mcr::Open => {
                if state.depth >= ZONES {
                    return Err(Fault::McrNesting);
                }
                let outer = state.depth == 0 || state.zones >> (state.depth - 1) & 1 == 1;
                let bit = 1 << state.depth;
                state.zones = if outer && status.rlo { state.zones | bit } else { state.zones & !bit };
                state.depth += 1;
                (status.or, status.sta, status.fc) = (false, true, false);
            }
            Mcr::Close => {
                state.depth = state.depth.checked_sub(1).ok_or(Fault::McrNesting)?;
                (status.or, status.sta, status.fc) = (false, true, false);
            }
        }
        Ok(())
    }

    /// Whether `UC` or `CC` calls; the status as the call leaves it.
    fn calls(&mut self, condition: Condition) -> bool {
        let status = &mut self.state.registers.status;
        (status.os, status.or, status.sta, status.fc) = (false, false, true, false);
        if condition == Condition::Always {
            return true;
        }
        std::mem::replace(&mut status.rlo, true)
    }
}

fn open(areas: &impl Areas, number: u16) -> Option<OpenBlock> {
    // DB0 does not exist: nothing is open after it.
    if number == 0 { Some(OpenBlock::default()) } else { areas.block(number) }
}

pub(super) fn status_bit(status: Status, bit: StatusBit) -> bool {
    let (cc1, cc0) = (status.cc1, status.cc0);
    match bit {
        StatusBit::Zero => !cc1 && !cc0,
        StatusBit::NotZero => cc1 != cc0,
        StatusBit::Positive => cc1 && !cc0,
        StatusBit::Negative => !cc1 && cc0,
        StatusBit::NotNegative => !cc0,
        StatusBit::NotPositive => !cc1,
        StatusBit::Unordered => cc1 && cc0,
        StatusBit::Overflow => status.ov,
        StatusBit::StoredOverflow => status.os,
        StatusBit::BinaryResult => status.br,
    }
}
