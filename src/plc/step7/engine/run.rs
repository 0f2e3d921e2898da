//! The interpreter: one instruction after the other until the block ends.

use std::sync::Arc;

use crate::plc::step7::instruction::{Jump, Logic, Op, Operand};

use super::arithmetic::{Codes, calculate, compare, low, with_low};
use super::cpu::{Cpu, Nest};
use super::fault::Fault;
use super::memory::Areas;
use super::registers::Status;

/// The open brackets of a block.
const BRACKETS: u32 = 7;

impl Cpu {
    /// Runs an organization block from an instruction to its end.
    pub(in crate::plc::step7) fn run<A: Areas>(&mut self, areas: &mut A, start: u32) -> Result<(), Fault> {
        if self.observed.is_some() {
            self.run_on::<A, true>(areas, start)
        } else {
            self.run_on::<A, false>(areas, start)
        }
    }

    fn run_on<A: Areas, const OBSERVED: bool>(&mut self, areas: &mut A, start: u32) -> Result<(), Fault> {
        let program = Arc::clone(&self.program);
        let code = program.code.as_slice();
        let mut pc = start;
        let mut budget = self.work.budget;
        // The frame of an organization block goes back to an instruction that does not exist.
        while let Some(&op) = code.get(pc as usize) {
            let here = pc;
            pc += 1;
            if budget == 0 {
                self.work.pc = here;
                self.late(areas)?;
                budget = self.work.budget;
            }
            budget -= 1;
            if OBSERVED {
                self.foresee(areas, op, here);
            }
            if let Err(fault) = self.execute(areas, op, &mut pc) {
                self.work.pc = here;
                self.work.budget = budget;
                self.report(areas, fault)?;
                budget = self.work.budget;
            } else if OBSERVED {
                self.mark(areas, op, here, pc);
            }
        }
        self.work.budget = budget;
        Ok(())
    }

    #[inline]
    pub(super) fn logic(&mut self, logic: Logic, x: bool) {
        self.state.registers.status.sta = x;
        self.combine(logic, x);
    }

    #[inline]
    fn combine(&mut self, logic: Logic, x: bool) {
        let status = &mut self.state.registers.status;
        let (fc, rlo) = (status.fc, status.rlo);
        match logic {
            Logic::And | Logic::AndNot => {
                let x = x == (logic == Logic::And);
                let term = status.or && fc;
                status.rlo = (if fc { rlo && x } else { x }) || term;
                status.or = term;
            }
            Logic::Or | Logic::OrNot => {
                status.rlo = fc && rlo || x == (logic == Logic::Or);
                status.or = false;
            }
            Logic::Xor | Logic::XorNot => {
                status.rlo = (fc && rlo) != (x == (logic == Logic::Xor));
                status.or = false;
            }
        }
        status.fc = true;
    }

    /// The end of a logic string: a bit was written.
    #[inline]
    fn written(&mut self, value: bool) {
        let status = &mut self.state.registers.status;
        status.or = false;
        status.sta = value;
        status.fc = false;
    }

    pub(super) fn codes(&mut self, codes: Codes) {
        let status = &mut self.state.registers.status;
        status.cc1 = codes.cc1;
        status.cc0 = codes.cc0;
        status.ov = codes.ov;
        status.os |= codes.ov;
    }

    /// CC1 by a bit, CC0 and OV 0: word logic and shifts.
    pub(super) fn code_bit(&mut self, cc1: bool) {
        let status = &mut self.state.registers.status;
        (status.cc1, status.cc0, status.ov) = (cc1, false, false);
    }

    #[inline]
    pub(super) fn load(&mut self, value: u32) {
        let accu = &mut self.state.registers.accu;
        accu[1] = accu[0];
        accu[0] = value;
    }

    /// With four accumulators, those above move down after arithmetic.
    fn drop_second(&mut self) {
        if self.options.has_four_accumulators {
            let accu = &mut self.state.registers.accu;
            accu[1] = accu[2];
            accu[2] = accu[3];
        }
    }

    /// One instruction; the frequent ones are here, the others in [`Cpu::operation`].
    #[inline]
    pub(in crate::plc::step7) fn execute<A: Areas>(
        &mut self,
        areas: &mut A,
        op: Op,
        pc: &mut u32,
    ) -> Result<(), Fault> {
        match op {
            Op::Nothing => {}
            Op::Logic(logic, operand) => {
                let x = self.bit_of(areas, operand)?;
                self.logic(logic, x);
            }
            Op::OrBeforeAnd => {
                let status = &mut self.state.registers.status;
                status.or = (status.rlo || status.or) && status.fc;
                status.fc = status.fc && status.rlo;
                status.sta = true;
            }
            Op::OpenNest(logic) => self.open_nest(logic)?,
            Op::CloseNest => self.close_nest()?,
            Op::Assign(operand) => {
                let value = self.state.registers.status.rlo && !self.work.mcr.is_off();
                self.set_bit_of(areas, operand, value)?;
                self.written(value);
            }
            Op::Set(operand) => self.set(areas, operand, true)?,
            Op::Reset(operand) => self.set(areas, operand, false)?,
            Op::Edge(positive, operand) => {
                let before = self.bit_of(areas, operand)?;
                let rlo = self.state.registers.status.rlo;
                self.set_bit_of(areas, operand, rlo)?;
                let edge = if positive { rlo && !before } else { !rlo && before };
                let status = &mut self.state.registers.status;
                (status.or, status.sta, status.rlo, status.fc) = (false, edge, edge, true);
            }
            Op::Compare(relation, numeric) => {
                let [accu1, accu2, ..] = self.state.registers.accu;
                let (result, codes) = compare(relation, numeric, accu2, accu1);
                self.codes(codes);
                let status = &mut self.state.registers.status;
                (status.or, status.sta, status.rlo, status.fc) = (false, result, result, true);
            }
            Op::Arithmetic(operation, numeric) => {
                let [accu1, accu2, ..] = self.state.registers.accu;
                let (result, codes) = calculate(operation, numeric, accu2, accu1);
                self.state.registers.accu[0] = result;
                self.codes(codes);
                self.drop_second();
            }
            Op::Load(width, operand) => {
                let value = self.value_of(areas, operand, width)?;
                self.load(value);
            }
            Op::LoadConstant(value) => self.load(value),
            Op::Transfer(width, operand) => {
                let value = if self.work.mcr.is_off() { 0 } else { self.state.registers.accu[0] };
                self.set_value_of(areas, operand, width, value)?;
            }
            Op::Jump(jump, target) => {
                if self.jumps(jump) {
                    *pc = target;
                }
            }
            other => self.operation(areas, other, pc)?,
        }
        Ok(())
    }

    fn open_nest(&mut self, logic: Logic) -> Result<(), Fault> {
        let open = self.work.nests.len() - self.frame().nests as usize;
        if open >= BRACKETS as usize {
            return Err(Fault::Nesting);
        }
        let status = &mut self.state.registers.status;
        self.work.nests.push(Nest { rlo: status.rlo, or: status.or, fc: status.fc, logic });
        (status.or, status.sta, status.fc) = (false, true, false);
        Ok(())
    }

    fn close_nest(&mut self) -> Result<(), Fault> {
        if self.work.nests.len() <= self.frame().nests as usize {
            return Err(Fault::Nesting);
        }
        let Some(nest) = self.work.nests.pop() else { return Err(Fault::Nesting) };
        let status = &mut self.state.registers.status;
        let x = status.rlo;
        (status.rlo, status.or, status.fc) = (nest.rlo, nest.or, nest.fc);
        self.combine(nest.logic, x);
        self.state.registers.status.sta = true;
        Ok(())
    }

    fn set<A: Areas>(&mut self, areas: &mut A, operand: Operand, value: bool) -> Result<(), Fault> {
        let mut sta = self.bit_of(areas, operand)?;
        if self.state.registers.status.rlo && !self.work.mcr.is_off() {
            self.set_bit_of(areas, operand, value)?;
            sta = value;
        }
        self.written(sta);
        Ok(())
    }

    /// Whether a jump is taken; sets the status as the jump does.
    fn jumps(&mut self, jump: Jump) -> bool {
        let status = &mut self.state.registers.status;
        let (cc1, cc0, rlo) = (status.cc1, status.cc0, status.rlo);
        let by_rlo = |status: &mut Status| {
            (status.or, status.sta, status.rlo, status.fc) = (false, true, true, false);
        };
        match jump {
            Jump::Always => true,
            Jump::IfRlo | Jump::IfNotRlo => {
                by_rlo(status);
                rlo == (jump == Jump::IfRlo)
            }
            Jump::IfRloWithBr | Jump::IfNotRloWithBr => {
                status.br = rlo;
                by_rlo(status);
                rlo == (jump == Jump::IfRloWithBr)
            }
            Jump::IfBr | Jump::IfNotBr => {
                (status.or, status.sta, status.fc) = (false, true, false);
                status.br == (jump == Jump::IfBr)
            }
            Jump::IfOverflow => status.ov,
            Jump::IfStoredOverflow => std::mem::take(&mut status.os),
            Jump::IfZero => !cc1 && !cc0,
            Jump::IfNotZero => cc1 != cc0,
            Jump::IfPositive => cc1 && !cc0,
            Jump::IfNegative => !cc1 && cc0,
            Jump::IfNotNegative => !cc0,
            Jump::IfNotPositive => !cc1,
            Jump::IfUnordered => cc1 && cc0,
            Jump::Loop => {
                let accu1 = self.state.registers.accu[0];
                let left = low(accu1).wrapping_sub(1);
                self.state.registers.accu[0] = with_low(accu1, left);
                left != 0
            }
        }
    }
}
