//! Where the values in the accumulators come from: an observed CPU follows operands forward through loads, arithmetic and local data, so that
//! the cause of a word names the operands that it was made of, and a comparison those that it compared.
//!
//! What cannot be followed (status words, address registers, more than eight operands, local data that a system function wrote) is unknown,
//! and of a value with an unknown part no operand is named.

use crate::plc::step7::instruction::{Accumulators, CopySource, Jump, Op, Operand, Target, Width};

use super::access::Where;
use super::arithmetic::{Sets, convert};
use super::bit_operations::local;
use super::cpu::Cpu;
use super::memory::{Area, Areas};
use super::origin::{Flow, Origin};
use super::read::{Named, Read};

impl Cpu {
    /// Before an instruction: what it tests, and what it does with the origins of values.
    pub(super) fn follow<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let db = self.state.registers.db;
        match op {
            Op::Logic(..)
            | Op::LogicTimer(..)
            | Op::LogicCounter(..)
            | Op::LogicStatus(..)
            | Op::OpenNest(_)
            | Op::OrBeforeAnd
            | Op::Not => self.note_contact(areas, op, pc),
            Op::CloseNest | Op::Nothing => {}
            Op::Save | Op::Jump(Jump::IfRloWithBr | Jump::IfNotRloWithBr, _) => {
                let origin = self.origin_of_rlo(pc);
                if let Some(observed) = &mut self.observed {
                    observed.flow.binary_result = origin;
                }
            }
            Op::Compare(..) | Op::Edge(..) => {
                self.note_contact(areas, op, pc);
                self.state.registers.db = db;
                self.follow_values(areas, op, pc);
            }
            _ => self.follow_values(areas, op, pc),
        }
        self.state.registers.db = db;
    }

    fn follow_values<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let drops = self.options.has_four_accumulators;
        let now = self.work.now;
        let Some(mut observed) = self.observed.take() else { return };
        let flow = &mut observed.flow;
        match op {
            Op::Load(width, operand) => {
                if let Some(origin) = self.origin_of(areas, flow, operand, width) {
                    flow.load(origin);
                }
            }
            Op::LoadConstant(_) | Op::LoadParameterAddress(_) => flow.load(Origin::constant()),
            Op::LoadTimer(is_bcd, number) => {
                if let Ok(number) = self.number(areas, number)
                    && let (Some((value, _)), Some(word)) = (self.timer(number, now), self.timer_word(number, now))
                {
                    let value = if is_bcd { word } else { value };
                    flow.load(Origin::of(Read { named: Named::Timer(number), bits: 16, value: value.into() }));
                }
            }
            Op::LoadCounter(is_bcd, number) => {
                if let Ok(number) = self.number(areas, number)
                    && let (Some(value), Some(word)) = (self.counter(number), self.counter_word(number))
                {
                    let value = if is_bcd { word } else { value };
                    flow.load(Origin::of(Read { named: Named::Counter(number), bits: 16, value: value.into() }));
                }
            }
            Op::LoadStatus | Op::LoadData(_) | Op::AccuFromRegister(_) => flow.load(Origin::default()),
            Op::Arithmetic(..) => {
                flow.set_codes(flow.accu[0].and(&flow.accu[1]));
                flow.arithmetic(drops);
            }
            Op::Convert(operation) => {
                let (value, codes) = (flow.accu[0].clone(), self.state.registers.accu[0]);
                match convert(operation, codes) {
                    Ok((_, Sets::All(_))) => flow.set_codes(value),
                    Ok((_, Sets::Overflow(_))) => flow.overflow = value,
                    Ok((_, Sets::Nothing)) | Err(_) => {}
                }
            }
            Op::WordLogic(..) => {
                flow.accu[0] = flow.accu[0].and(&flow.accu[1]);
                flow.set_codes(flow.accu[0].clone());
            }
            Op::WordLogicConstant(..) => flow.set_codes(flow.accu[0].clone()),
            Op::Shift(_) => {
                flow.accu[0] = flow.accu[0].and(&flow.accu[1]);
                // With a count of 0 the codes stay, on account of this count.
                let counts = self.state.registers.accu[1].to_be_bytes()[3] != 0;
                let codes = if counts { flow.accu[0].clone() } else { flow.codes.and(&flow.accu[1]) };
                flow.set_codes(codes);
            }
            Op::ShiftBy(_, count) if count > 0 => flow.set_codes(flow.accu[0].clone()),
            Op::Accumulators(operation) => {
                if matches!(operation, Accumulators::RotateLeftThroughCc1 | Accumulators::RotateRightThroughCc1) {
                    flow.set_codes(flow.accu[0].clone());
                }
                flow.accumulators(operation, drops);
            }
            Op::TransferStatus => {
                flow.set_codes(flow.accu[0].clone());
                flow.binary_result = flow.accu[0].clone();
            }
            Op::Compare(..) => {
                let origin = flow.accu[0].and(&flow.accu[1]);
                flow.set_codes(origin.clone());
                flow.remember(pc, origin);
            }
            Op::Transfer(width, to) => {
                let origin = if self.work.mcr.is_off() { Origin::constant() } else { flow.accu[0].clone() };
                self.set_in_local(areas, flow, (to, width.bits()), origin);
            }
            Op::OperandFromRegister(_, to) => self.set_in_local(areas, flow, (to, 32), Origin::default()),
            Op::Assign(to) | Op::Set(to) | Op::Reset(to) | Op::Edge(_, to) => {
                self.set_in_local(areas, flow, (to, 1), Origin::default());
            }
            Op::Copy(index) => {
                let copy = self.program.copies[index as usize];
                let origin = self.copied(areas, flow, index);
                self.set_in_local(areas, flow, (copy.to, copy.bits), origin);
            }
            Op::Pointer(index) => {
                let made = self.program.pointers[index as usize];
                let bits = if made.any.is_some() { 80 } else { 48 };
                self.set_in_local(areas, flow, (made.to, bits), Origin::default());
            }
            Op::Call(index) if matches!(self.program.calls[index as usize].target, Target::System(_)) => {
                flow.forget_called();
            }
            Op::CallPlain(_, Target::System(_)) => flow.forget_called(),
            _ => {}
        }
        self.observed = Some(observed);
    }

    /// The origin of what a copy copies, if it is a bit, a byte, a word or a double word.
    fn copied<A: Areas>(&mut self, areas: &A, flow: &Flow, index: u32) -> Origin {
        let copy = self.program.copies[index as usize];
        let width = if copy.bits == 1 { Some(Width::Bit) } else { width_of(copy.bits) };
        match (copy.from, width) {
            (CopySource::Constant(_) | CopySource::Number(_), Some(_)) => Origin::constant(),
            (CopySource::Operand(from), Some(width)) => self.origin_of(areas, flow, from, width).unwrap_or_default(),
            (_, None) => Origin::default(),
        }
    }

    /// The origin of the value that a write of a byte, a word or a double word transfers.
    pub(super) fn transferred<A: Areas>(&mut self, areas: &A, op: Op) -> Origin {
        let Some(observed) = self.observed.take() else { return Origin::default() };
        let flow = &observed.flow;
        let origin = match op {
            // A zone of the MCR that is off made the value.
            Op::Transfer(..) if self.work.mcr.is_off() => Origin::default(),
            Op::Transfer(..) => flow.accu1().clone(),
            Op::Copy(index) => self.copied(areas, flow, index),
            _ => Origin::default(),
        };
        self.observed = Some(observed);
        origin
    }

    /// The origin of an operand that is read; `None` if the read fails.
    fn origin_of<A: Areas>(&mut self, areas: &A, flow: &Flow, operand: Operand, width: Width) -> Option<Origin> {
        let spot = self.spot(areas, operand).ok()?;
        let value = self.read(areas, spot, width).ok()?;
        if let Some(from) = local(spot) {
            return Some(flow.of_local(from, width.bits()));
        }
        let named = match spot.at {
            Where::Peripheral => Named::Area(Area::Inputs, spot.bit),
            _ => self.named(spot)?,
        };
        let bits = u8::try_from(width.bits()).unwrap_or(u8::MAX);
        Some(Origin::of(Read { named, bits, value }))
    }

    fn set_in_local<A: Areas>(&mut self, areas: &A, flow: &mut Flow, (to, bits): (Operand, u32), origin: Origin) {
        if let Some(from) = self.spot(areas, to).ok().and_then(local) {
            flow.set_local(from, bits, origin);
        }
    }
}

/// The width of a copy in one piece of more than a bit.
pub(super) fn width_of(bits: u32) -> Option<Width> {
    match bits {
        8 => Some(Width::Byte),
        16 => Some(Width::Word),
        32 => Some(Width::Double),
        _ => None,
    }
}
