//! What a run leaves behind for its readers: which instructions ran and with which results, and why the program changed bits.
//!
//! Only an observed CPU pays for it. Nothing here is a part of the state of the CPU.

use arrayvec::ArrayVec;

use crate::plc::step7::instruction::{Condition, CopySource, Instance, Jump, Op, Operand, Target, Width};

use crate::plc::step7::system::{SYSTEM, System};

use super::access::{Spot, Where};
use super::bit_operations::local;
use super::cpu::Cpu;
use super::flow::width_of;
use super::memory::{Area, Areas};
use super::observed::{CHANGES, Clock, NO, RAN, Seen, WORDS, YES};
use super::origin::Origin;
use super::read::{Named, Read, TESTED};

/// The bit address of Q in the instance of an IEC timer; IN is its first bit.
const Q: u32 = 6 * 8;

/// The bits that differ, with their new values.
fn changed_bits<'a>(before: &'a [u8], now: &'a [u8]) -> impl Iterator<Item = (u32, bool)> + 'a {
    (0_u32..).zip(before.iter().zip(now)).filter(|(_, (before, now))| before != now).flat_map(
        |(byte, (before, now))| {
            (0..8)
                .filter(move |bit| (before ^ now) >> bit & 1 == 1)
                .map(move |bit| (byte * 8 + bit, now >> bit & 1 == 1))
        },
    )
}

/// So many bytes of the interface are compared at once.
const PIECE: usize = 64;

/// What an instruction is about to write.
#[derive(Clone, Copy, Debug)]
enum Writes {
    Bit(Spot, bool),
    /// The width in bits, and the new value.
    Bytes(Spot, u32, u32),
    Timer(u16),
    Counter(u16),
}

impl Cpu {
    /// Before an instruction: if it will change memory, remembers why; then follows the values.
    pub(super) fn foresee<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        self.remember(areas, op, pc);
        self.follow(areas, op, pc);
    }

    fn remember<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let db = self.state.registers.db;
        if let Some(observed) = &mut self.observed {
            observed.pc = pc;
        }
        if let Op::Call(index) = op {
            let clock = self.clock(areas, index);
            if let Some(observed) = &mut self.observed {
                observed.clock = clock;
            }
            return;
        }
        let has_all = self.observed.as_ref().is_some_and(|observed| observed.has_all_writes);
        let writes = match op {
            Op::Set(operand) | Op::Reset(operand) if has_all => self.latched(areas, operand, matches!(op, Op::Set(_))),
            op => self.writes(areas, op),
        };
        self.state.registers.db = db;
        let Some(writes) = writes else { return };
        let mut is_word = false;
        let (place, bits, value) = match writes {
            Writes::Bit(spot, value) => {
                if self.read_bit(areas, spot).ok() == Some(value) && !has_all {
                    return;
                }
                (self.named(spot), 1, value.into())
            }
            Writes::Bytes(spot, bits, value) => {
                let width = width_of(bits).unwrap_or(Width::Double);
                if self.read(areas, spot, width).ok() == Some(value) && !has_all {
                    return;
                }
                is_word = !matches!(spot.at, Where::Block(block) if areas.is_interface(block));
                (self.named(spot), bits, value)
            }
            // For a reader of every write: whether the timer is started.
            Writes::Timer(number) => (Some(Named::Timer(number)), 16, self.state.registers.status.rlo.into()),
            Writes::Counter(number) => (Some(Named::Counter(number)), 16, 0),
        };
        let Some(place) = place else { return };
        let Some(observed) = &mut self.observed else { return };
        let has_room = observed.seen.len() < CHANGES && (!is_word || observed.words < WORDS);
        if !has_room && !has_all {
            return;
        }
        observed.words += usize::from(is_word);
        let mut tested = ArrayVec::new();
        self.reasons(areas, op, pc, &mut tested);
        self.state.registers.db = db;
        if let Some(observed) = &mut self.observed {
            observed.seen.push(Seen { pc, place, bits, value, tested });
        }
    }

    /// The IEC timer that a call is of.
    fn clock<A: Areas>(&self, areas: &A, index: u32) -> Option<Clock> {
        let site = self.program.calls[index as usize];
        let Target::System(system) = site.target else { return None };
        let system = SYSTEM.get(usize::from(system))?.system;
        if !matches!(system, System::Pulse | System::OnDelay | System::OffDelay) {
            return None;
        }
        let registers = self.state.registers;
        let (block, begin) = match site.instance {
            Instance::None => return None,
            Instance::Block(number) => (areas.block(number)?, 0),
            Instance::Within(bit) => (registers.di, registers.ar[1].wrapping_add(bit) & 0x0007_FFFF),
        };
        let before = self.read_bit(areas, Spot { at: Where::Block(block), bit: begin + Q }).ok()?;
        Some(Clock { block, begin, is_pulse: system == System::Pulse, before })
    }

    /// After the call of an IEC timer: Q follows from IN, or from the time alone.
    fn clock_called<A: Areas>(&mut self, areas: &A, pc: u32) {
        let Some(observed) = &mut self.observed else { return };
        let Some(Clock { block, begin, is_pulse, before }) = observed.clock.take() else { return };
        let (all, is_full) = (observed.has_all_writes, observed.seen.len() >= CHANGES);
        let bit = |bit| self.read_bit(areas, Spot { at: Where::Block(block), bit: begin + bit });
        let (Ok(input), Ok(value)) = (bit(0), bit(Q)) else { return };
        if !all && (value == before || is_full) {
            return;
        }
        let mut tested = ArrayVec::new();
        if input == value && (value || !is_pulse) {
            tested.push(Read::bit(Named::Block(block.number, begin), input));
        }
        let place = Named::Block(block.number, begin + Q);
        if let Some(observed) = &mut self.observed {
            observed.seen.push(Seen { pc, place, bits: 1, value: value.into(), tested });
        }
    }

    /// After a block of the basic program: what it wrote to the NCK, on account of what it read.
    pub(in crate::plc::step7) fn note_interface(&mut self, before: &[u8], now: &[u8]) {
        let Some(observed) = &mut self.observed else { return };
        // Most calls change nothing: whole pieces are compared first.
        if before == now {
            return;
        }
        let pc = observed.pc;
        let tested = if observed.has_all_writes { ArrayVec::new() } else { observed.inputs.clone() };
        let pieces = before.chunks(PIECE).zip(now.chunks(PIECE));
        for (first, (before, now)) in (0_u32..).step_by(PIECE).zip(pieces).filter(|(_, (before, now))| before != now) {
            for (bit, value) in changed_bits(before, now) {
                if observed.seen.len() < CHANGES || observed.has_all_writes {
                    let place = Named::ToNck(first * 8 + bit);
                    observed.seen.push(Seen { pc, place, bits: 1, value: value.into(), tested: tested.clone() });
                }
            }
        }
    }

    /// After a built-in block: one of its outputs, with its value before and now.
    pub(in crate::plc::step7) fn note_called<A: Areas>(
        &mut self,
        areas: &A,
        spot: Spot,
        bits: u32,
        (before, now): (u32, u32),
    ) {
        let place = self.named(spot);
        let is_word = bits > 1 && !matches!(spot.at, Where::Block(block) if areas.is_interface(block));
        let Some(observed) = &mut self.observed else { return };
        let mut tested = observed.inputs.clone();
        if let Some(from) = local(spot) {
            observed.flow.set_local(from, bits, Origin::made_of(&tested));
        }
        if observed.has_all_writes && bits == 1 {
            // Whoever asks why a bit is not another one must not read that each input should be.
            tested.clear();
        }
        let Some(place) = place else { return };
        let has_room = observed.seen.len() < CHANGES && (!is_word || observed.words < WORDS);
        if observed.has_all_writes || has_room && before != now {
            observed.words += usize::from(is_word);
            let pc = observed.pc;
            observed.seen.push(Seen { pc, place, bits, value: now, tested });
        }
    }

    /// Adds something that a built-in block has read: by its name, or for local data by what it was made of.
    pub(in crate::plc::step7) fn note_read(
        &self,
        spot: Spot,
        width: Width,
        value: u32,
        inputs: &mut ArrayVec<Read, TESTED>,
    ) {
        let mut add = |read: Read| {
            if !inputs.contains(&read) {
                let _ = inputs.try_push(read);
            }
        };
        if let Some(from) = local(spot) {
            let origin = self.observed.as_ref().map(|observed| observed.flow.of_local(from, width.bits()));
            origin.unwrap_or_default().reads().unwrap_or_default().iter().for_each(|read| add(*read));
        } else if let Some(named) = self.named(spot) {
            add(Read { named, bits: u8::try_from(width.bits()).unwrap_or(u8::MAX), value });
        }
    }

    /// Adds the bits that have changed to what the block that runs has read.
    pub(in crate::plc::step7) fn note_changed(
        &mut self,
        before: &[u8],
        now: &[u8],
        named: impl Fn(u32) -> Option<Named>,
    ) {
        let Some(observed) = &mut self.observed else { return };
        for (bit, value) in changed_bits(before, now) {
            if let Some(named) = named(bit) {
                let _ = observed.inputs.try_push(Read::bit(named, value));
            }
        }
    }

    /// S or R, if it is a reason for the value that its bit has behind it.
    fn latched<A: Areas>(&mut self, areas: &A, operand: Operand, sets: bool) -> Option<Writes> {
        let rlo = self.state.registers.status.rlo && !self.work.mcr.is_off();
        let spot = self.spot(areas, operand).ok()?;
        let value = if rlo { sets } else { self.read_bit(areas, spot).ok()? };
        ((sets == rlo) == value).then_some(Writes::Bit(spot, value))
    }

    /// What an instruction writes, as far as its readers can see it.
    fn writes<A: Areas>(&mut self, areas: &A, op: Op) -> Option<Writes> {
        let status = self.state.registers.status;
        let is_off = self.work.mcr.is_off();
        let is_on = status.rlo && !is_off;
        match op {
            Op::Assign(operand) => Some(Writes::Bit(self.spot(areas, operand).ok()?, is_on)),
            Op::Set(operand) | Op::Reset(operand) if is_on => {
                Some(Writes::Bit(self.spot(areas, operand).ok()?, matches!(op, Op::Set(_))))
            }
            Op::Transfer(width, operand) => {
                let accu1 = if is_off { 0 } else { self.state.registers.accu[0] };
                let value = accu1 & u32::MAX >> (32 - width.bits());
                Some(Writes::Bytes(self.spot(areas, operand).ok()?, width.bits(), value))
            }
            Op::Copy(index) => {
                let copy = self.program.copies[index as usize];
                let width = if copy.bits == 1 { Width::Bit } else { width_of(copy.bits)? };
                let value = match copy.from {
                    CopySource::Operand(operand) => {
                        let from = self.spot(areas, operand).ok()?;
                        self.read(areas, from, width).ok()?
                    }
                    CopySource::Constant(value) => value & u32::MAX >> (32 - copy.bits),
                    CopySource::Number(_) => return None,
                };
                let to = self.spot(areas, copy.to).ok()?;
                Some(if copy.bits == 1 { Writes::Bit(to, value != 0) } else { Writes::Bytes(to, copy.bits, value) })
            }
            Op::StartTimer(kind, number) => {
                let (number, now) = (self.number(areas, number).ok()?, self.work.now);
                let mut after = self.state.timers.get(usize::from(number))?.clone();
                after.start(kind, status.rlo, self.state.registers.accu[0], now).ok()?;
                let has_all = self.observed.as_ref().is_some_and(|observed| observed.has_all_writes);
                let differs = self.state.timers[usize::from(number)].differs_from(&after, now);
                (differs || has_all).then_some(Writes::Timer(number))
            }
            Op::ResetTimer(number) if status.rlo => {
                let (number, now) = (self.number(areas, number).ok()?, self.work.now);
                let mut after = self.state.timers.get(usize::from(number))?.clone();
                after.reset();
                self.state.timers[usize::from(number)].differs_from(&after, now).then_some(Writes::Timer(number))
            }
            Op::CountUp(number) | Op::CountDown(number) | Op::SetCounter(number) | Op::ResetCounter(number)
                if status.rlo =>
            {
                let number = self.number(areas, number).ok()?;
                let before = self.state.counters.get(usize::from(number))?;
                let mut after = before.clone();
                match op {
                    Op::CountUp(_) => after.count_up(true),
                    Op::CountDown(_) => after.count_down(true),
                    Op::SetCounter(_) => after.set(true, self.state.registers.accu[0]).ok()?,
                    _ => after.value = 0,
                }
                (after.value != before.value).then_some(Writes::Counter(number))
            }
            _ => None,
        }
    }

    /// The name of a place for readers; local data have none.
    pub(super) fn named(&self, spot: Spot) -> Option<Named> {
        match spot.at {
            Where::Area(area) => Some(Named::Area(area, spot.bit)),
            Where::Block(block) => Some(Named::Block(block.number, spot.bit)),
            Where::Peripheral => Some(Named::Area(Area::Outputs, spot.bit)),
            Where::Local(..) => None,
        }
    }

    /// After an instruction: marks what it was.
    #[inline]
    pub(super) fn mark<A: Areas>(&mut self, areas: &A, op: Op, pc: u32, next: u32) {
        if matches!(op, Op::Call(_)) {
            self.clock_called(areas, pc);
        }
        let sta = self.state.registers.status.sta;
        let Some(observed) = &mut self.observed else { return };
        if next != pc + 1 {
            observed.flow.landed = next;
        }
        let Some(mark) = observed.marks.get_mut(pc as usize) else { return };
        *mark |= RAN
            | match kind(op) {
                Kind::Plain => 0,
                Kind::Contact => {
                    if sta {
                        YES
                    } else {
                        NO
                    }
                }
                Kind::Branch => {
                    if next == pc + 1 {
                        NO
                    } else {
                        YES
                    }
                }
            };
    }
}

/// What coverage asks of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Kind {
    /// That it runs.
    Plain,
    /// That it is true once and false once.
    Contact,
    /// That it is taken once and not taken once.
    Branch,
}

/// The kind of an instruction.
pub(in crate::plc::step7) fn kind(op: Op) -> Kind {
    match op {
        Op::Logic(..) | Op::LogicTimer(..) | Op::LogicCounter(..) | Op::LogicStatus(..) | Op::Compare(..) => {
            Kind::Contact
        }
        Op::Edge(..) => Kind::Contact,
        Op::Jump(jump, _) if jump != Jump::Always => Kind::Branch,
        Op::End(Condition::IfRlo) | Op::CallPlain(Condition::IfRlo, _) | Op::CallNumber(Condition::IfRlo, ..) => {
            Kind::Branch
        }
        _ => Kind::Plain,
    }
}
