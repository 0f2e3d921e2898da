//! Where the values in the accumulators come from: an observed CPU follows operands forward through loads, arithmetic and local data, so that
//! the cause of a word names the operands that it was made of, and a comparison those that it compared.
//!
//! What cannot be followed (status words, address registers, more than eight operands, local data that a system function wrote) is unknown,
//! and of a value with an unknown part no operand is named.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::{Accumulators, CopySource, Op, Operand, Target, Width};

use super::access::{Spot, Where};
use super::cpu::Cpu;
use super::memory::{Area, Areas};
use super::observed::{Named, OPERANDS, Read};

/// Values in local data that are followed at a time.
const LOCALS: usize = 64;
/// Comparisons that are remembered.
const COMPARISONS: usize = 16;

/// The operands of which a value was made.
#[derive(Clone, Debug, Default)]
pub(in crate::plc::step7) struct Origin {
    /// `None` if a part of the value is unknown.
    reads: Option<ArrayVec<Read, OPERANDS>>,
}

impl Origin {
    /// The value of a constant.
    fn constant() -> Self {
        Self { reads: Some(ArrayVec::new()) }
    }

    fn of(read: Read) -> Self {
        let mut origin = Self::constant();
        origin.reads.iter_mut().for_each(|reads| reads.push(read));
        origin
    }

    /// The origin of a value that is made of two.
    fn and(&self, other: &Self) -> Self {
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
    accu: [Origin; 4],
    /// Values in the local data, by the bits from which and to which they reach, in the order in which they were written.
    local: Vec<(u32, u32, Origin)>,
    /// The last comparisons: their instructions and what they compared.
    compared: Vec<(u32, Origin, bool)>,
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

    fn load(&mut self, origin: Origin) {
        self.accu[1] = std::mem::replace(&mut self.accu[0], origin);
    }

    fn of_local(&self, from: u32, bits: u32) -> Origin {
        let found = self.local.iter().rev().find(|(begin, end, _)| *begin < from + bits && from < *end);
        match found {
            Some((begin, end, origin)) if (*begin, *end) == (from, from + bits) => origin.clone(),
            _ => Origin::default(),
        }
    }

    /// Local data were written.
    fn set_local(&mut self, from: u32, bits: u32, origin: Origin) {
        self.local.retain(|(begin, end, _)| *end <= from || from + bits <= *begin);
        if origin.reads.is_some() {
            if self.local.len() == LOCALS {
                self.local.remove(0);
            }
            self.local.push((from, from + bits, origin));
        }
    }

    fn arithmetic(&mut self, drops: bool) {
        self.accu[0] = self.accu[0].and(&self.accu[1]);
        if drops {
            self.accu[1] = self.accu[2].clone();
            self.accu[2] = self.accu[3].clone();
        }
    }

    fn accumulators(&mut self, operation: Accumulators, has_four: bool) {
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

/// The bit address of a place in all local data.
fn local(spot: Spot) -> Option<u32> {
    match spot.at {
        Where::Local(from, _) => Some(from * 8 + spot.bit),
        Where::Area(_) | Where::Peripheral | Where::Block(_) => None,
    }
}

impl Cpu {
    /// Before an instruction: what it does with the origins of values.
    pub(super) fn follow<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let db = self.state.registers.db;
        self.follow_values(areas, op, pc);
        self.state.registers.db = db;
    }

    fn follow_values<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let drops = self.options.has_four_accumulators;
        let now = self.work.now;
        let Some(mut flow) = self.observed.as_mut().map(|observed| std::mem::take(&mut observed.flow)) else { return };
        match op {
            Op::Load(width, operand) => {
                if let Some(origin) = self.origin_of(areas, &flow, operand, width) {
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
            Op::Arithmetic(..) => flow.arithmetic(drops),
            Op::WordLogic(..) | Op::Shift(_) => flow.accu[0] = flow.accu[0].and(&flow.accu[1]),
            Op::Accumulators(operation) => flow.accumulators(operation, drops),
            Op::Compare(relation, numeric) => {
                let [accu1, accu2, ..] = self.state.registers.accu;
                let (result, _) = super::arithmetic::compare(relation, numeric, accu2, accu1);
                if flow.compared.len() == COMPARISONS {
                    flow.compared.remove(0);
                }
                let origin = flow.accu[0].and(&flow.accu[1]);
                flow.compared.push((pc, origin, result));
            }
            Op::Transfer(width, to) => {
                let origin = if self.work.mcr.is_off() { Origin::constant() } else { flow.accu[0].clone() };
                self.set_in_local(areas, &mut flow, (to, width.bits()), origin);
            }
            Op::OperandFromRegister(_, to) => self.set_in_local(areas, &mut flow, (to, 32), Origin::default()),
            Op::Assign(to) | Op::Set(to) | Op::Reset(to) | Op::Edge(_, to) => {
                self.set_in_local(areas, &mut flow, (to, 1), Origin::default());
            }
            Op::Copy(index) => {
                let copy = self.program.copies[index as usize];
                let origin = self.copied(areas, &flow, index);
                self.set_in_local(areas, &mut flow, (copy.to, copy.bits), origin);
            }
            Op::Pointer(index) => {
                let made = self.program.pointers[index as usize];
                let bits = if made.any.is_some() { 80 } else { 48 };
                self.set_in_local(areas, &mut flow, (made.to, bits), Origin::default());
            }
            Op::Call(index) if matches!(self.program.calls[index as usize].target, Target::System(_)) => {
                flow.local.clear();
            }
            Op::CallPlain(_, Target::System(_)) => flow.local.clear(),
            _ => {}
        }
        if let Some(observed) = &mut self.observed {
            observed.flow = flow;
        }
    }

    /// The origin of what a copy copies, if it is a byte, a word or a double word.
    fn copied<A: Areas>(&mut self, areas: &A, flow: &Flow, index: u32) -> Origin {
        let copy = self.program.copies[index as usize];
        match (copy.from, width_of(copy.bits)) {
            (CopySource::Constant(_) | CopySource::Number(_), Some(_)) => Origin::constant(),
            (CopySource::Operand(from), Some(width)) => self.origin_of(areas, flow, from, width).unwrap_or_default(),
            (_, None) => Origin::default(),
        }
    }

    /// The origin of the value that a write of a byte, a word or a double word transfers.
    pub(super) fn transferred<A: Areas>(&mut self, areas: &A, op: Op) -> Origin {
        let Some(flow) = self.observed.as_mut().map(|observed| std::mem::take(&mut observed.flow)) else {
            return Origin::default();
        };
        let origin = match op {
            // A zone of the MCR that is off made the value.
            Op::Transfer(..) if self.work.mcr.is_off() => Origin::default(),
            Op::Transfer(..) => flow.accu1().clone(),
            Op::Copy(index) => self.copied(areas, &flow, index),
            _ => Origin::default(),
        };
        if let Some(observed) = &mut self.observed {
            observed.flow = flow;
        }
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
