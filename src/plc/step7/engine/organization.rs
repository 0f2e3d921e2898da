//! Organization blocks: start-up, the cyclic program, and the blocks that faults call.

use crate::plc::step7::instruction::BlockKind;
use crate::plc::step7::text::constants::date_time_of;

use super::cpu::{Cpu, Mask, McrState};
use super::fault::{Fault, Stop};
use super::interrupts::{DAY_MILLIS, Interrupts};
use super::memory::{Areas, OpenBlock};
use super::origin::Flow;
use super::registers::Status;

const MILLI_NANOS: i64 = 1_000_000;

/// The start information of an organization block: its first 20 bytes of local data.
type Information = [u8; 20];

impl Cpu {
    /// Power on: OB100, or after [`Cpu::prepare_cold_restart`] OB102 if the program has it. Timers, counters and registers begin from nothing;
    /// hours meters keep their values; the memory is the caller's.
    ///
    /// # Errors
    /// The program stopped the PLC.
    pub fn startup<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        let fresh = Self::new(std::sync::Arc::clone(&self.program), self.options);
        let before = std::mem::replace(&mut self.state, fresh.state);
        self.state.hours = before.hours.map(|meter| meter.stopped(before.last_scan));
        self.state.interrupts = Interrupts::begin(now, &self.options.cyclic_nanos);
        self.begin(now);
        // The events: warm restart 82h, cold restart 85h.
        let is_cold = before.is_cold && self.program.find(BlockKind::Ob, 102).is_some();
        let (event, number) = if is_cold { (0x85, 102) } else { (0x82, 100) };
        let mut information = self.information(0x13, event, 27, number);
        information[12..].copy_from_slice(&self.date_and_time());
        self.state.start_information = information;
        let done = self.organization_block(areas, number.into(), &information);
        self.ended(done)
    }

    /// The next start is a cold restart.
    pub fn prepare_cold_restart(&mut self) {
        self.state.is_cold = true;
    }

    /// A scan at a time in ns: the interrupts that are due, then OB1.
    ///
    /// # Errors
    /// The program stopped the PLC, now or in an earlier scan.
    pub fn scan<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        if let Some(stop) = &self.state.stop {
            return Err(Box::new(stop.clone()));
        }
        self.begin(now);
        self.measure(now);
        self.interrupts(areas, now)?;
        let mut information = self.information(0x11, if self.state.scans == 0 { 1 } else { 3 }, 1, 1);
        let times = [self.state.cycle, self.state.shortest, self.state.longest];
        for (place, time) in [6, 8, 10].into_iter().zip(times) {
            let millis = i16::try_from(time / MILLI_NANOS).unwrap_or(i16::MAX);
            information[place..place + 2].copy_from_slice(&millis.to_be_bytes());
        }
        let done = self.organization_block(areas, 1, &information);
        self.state.scans += 1;
        self.ended(done)
    }

    /// Between two scans, at a time in ns: the interrupts that are due.
    ///
    /// # Errors
    /// The program stopped the PLC, now or in an earlier scan.
    pub fn interrupt<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        if let Some(stop) = &self.state.stop {
            return Err(Box::new(stop.clone()));
        }
        self.begin(now);
        self.interrupts(areas, now)
    }

    fn begin(&mut self, now: i64) {
        self.work.now = now;
        self.work.budget = self.options.instructions_per_scan;
        self.clear();
    }

    /// Nothing runs.
    fn clear(&mut self) {
        self.work.frames.clear();
        self.work.parameters.clear();
        self.work.nests.clear();
        self.work.mcr = McrState::default();
        self.work.in_error = false;
        self.work.is_late = false;
    }

    fn measure(&mut self, now: i64) {
        if self.state.scans > 0 {
            let cycle = now - self.state.last_scan;
            self.state.cycle = cycle;
            self.state.shortest = if self.state.scans == 1 { cycle } else { self.state.shortest.min(cycle) };
            self.state.longest = self.state.longest.max(cycle);
        }
        self.state.last_scan = now;
    }

    pub(super) fn information(&self, class: u8, event: u8, priority: u8, number: u8) -> Information {
        let mut information = [0; 20];
        information[..4].copy_from_slice(&[class, event, priority, number]);
        information[12..].copy_from_slice(&self.date_and_time());
        information
    }

    /// The date and the time of day, from virtual time.
    pub(in crate::plc::step7) fn date_and_time(&self) -> [u8; 8] {
        let millis = self.clock_millis();
        let days = u32::try_from(millis / DAY_MILLIS).unwrap_or(0).min(36_523);
        date_time_of(days, u32::try_from(millis % DAY_MILLIS).unwrap_or(0))
    }

    /// The ms since 1990-1-1 of the clock.
    pub(in crate::plc::step7) fn clock_millis(&self) -> i64 {
        self.clock_at(self.work.now)
    }

    /// The same at a time in ns.
    pub(super) fn clock_at(&self, now: i64) -> i64 {
        let first = i64::from(self.options.first_day) * DAY_MILLIS;
        (first + now / MILLI_NANOS).saturating_add(self.state.clock_shift).max(0)
    }

    /// Runs an organization block if the program has it.
    pub(super) fn organization_block<A: Areas>(
        &mut self,
        areas: &mut A,
        number: u16,
        information: &Information,
    ) -> Result<(), Fault> {
        let Some(index) = self.program.find(BlockKind::Ob, number) else { return Ok(()) };
        let (start, local) = {
            let block = &self.program.blocks[usize::from(index)];
            (block.start, block.local)
        };
        self.work.pc = start;
        self.state.registers.db = OpenBlock::default();
        self.state.registers.di = OpenBlock::default();
        self.state.registers.status = Status::default();
        if let Some(observed) = &mut self.observed {
            observed.flow = Flow::begin(start);
        }
        if self.work.frames.is_empty() {
            self.work.masks = [Mask::default(); 2];
        }
        let first = u32::try_from(self.work.parameters.len()).unwrap_or(u32::MAX);
        let nothing = (OpenBlock::default(), OpenBlock::default(), None);
        self.push(local, (first, 0), u32::MAX, nothing)?;
        let from = self.frame().local.0 as usize;
        let length = information.len().min(local as usize);
        self.state.local[from..from + length].copy_from_slice(&information[..length]);
        self.run(areas, start)?;
        // SFC 41 acts until the end of the organization block.
        self.state.delayed = 0;
        Ok(())
    }

    /// A fault: OB121 or OB122 runs if the program has it; else the PLC stops.
    pub(in crate::plc::step7) fn report<A: Areas>(&mut self, areas: &mut A, fault: Fault) -> Result<(), Fault> {
        let Some(code) = fault.code() else { return Err(fault) };
        let is_access = matches!(fault, Fault::Peripheral(_));
        let mask = &mut self.work.masks[usize::from(is_access)];
        let bit = 1_u32 << (code - if is_access { 0x40 } else { 0x20 });
        if mask.masked & bit != 0 {
            mask.seen |= bit;
            return Ok(());
        }
        let number: u8 = if is_access { 122 } else { 121 };
        if self.work.in_error || self.program.find(BlockKind::Ob, u16::from(number)).is_none() {
            return Err(fault);
        }
        let mut information = self.information(if number == 121 { 0x25 } else { 0x29 }, code, 1, number);
        if let Some(block) = self.program.block_at(self.work.pc) {
            information[4] = match block.name.kind {
                BlockKind::Ob => 0x88,
                BlockKind::Fb => 0x8E,
                _ => 0x8C,
            };
            information[8..10].copy_from_slice(&block.name.number.to_be_bytes());
        }
        let register = u16::try_from(place_of(fault)).unwrap_or(u16::MAX);
        information[6..8].copy_from_slice(&register.to_be_bytes());
        self.error_block(areas, &information)
    }

    /// The cycle monitoring time is exceeded: OB80 runs if the program has it, and the monitoring time begins again, once in a scan; else
    /// the PLC stops.
    pub(in crate::plc::step7) fn late<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        if self.work.in_error || self.work.is_late || self.program.find(BlockKind::Ob, 80).is_none() {
            return Err(Fault::CycleTime);
        }
        self.work.is_late = true;
        self.work.budget = self.options.instructions_per_scan;
        let information = self.information(0x35, 0x01, 26, 80);
        self.error_block(areas, &information)?;
        self.work.budget = self.options.instructions_per_scan;
        Ok(())
    }

    /// The process interrupt of the basic program: OB40 runs within OB1, which then goes on as it was.
    pub(in crate::plc::step7) fn process_interrupt<A: Areas>(&mut self, areas: &mut A) -> Result<(), Fault> {
        if self.work.in_error || self.program.find(BlockKind::Ob, 40).is_none() {
            return Ok(());
        }
        let information = self.information(0x11, 0x41, 16, 40);
        self.error_block(areas, &information)
    }

    /// The multicomputing interrupt (SFC 35): OB60 runs within the block that asks for it, which then goes on as it was.
    pub(in crate::plc::step7) fn multicomputing_interrupt<A: Areas>(
        &mut self,
        areas: &mut A,
        job: u8,
    ) -> Result<(), Fault> {
        if self.work.in_error || self.program.find(BlockKind::Ob, 60).is_none() {
            return Ok(());
        }
        let mut information = self.information(0x11, 0x61, 25, 60);
        information[6..8].copy_from_slice(&[0, job]);
        self.error_block(areas, &information)
    }

    /// Runs OB80, OB121 or OB122 within another block, which then goes on as it was.
    fn error_block<A: Areas>(&mut self, areas: &mut A, information: &Information) -> Result<(), Fault> {
        let (registers, mcr, pc, delayed) = (self.state.registers, self.work.mcr, self.work.pc, self.state.delayed);
        let flow = self.observed.as_ref().map(|observed| observed.flow.clone());
        self.work.in_error = true;
        self.organization_block(areas, u16::from(information[3]), information)?;
        self.work.in_error = false;
        if let (Some(observed), Some(flow)) = (&mut self.observed, flow) {
            observed.flow = flow;
        }
        self.state.registers = registers;
        if let Some(value) = self.work.replacement.take() {
            self.state.registers.accu[0] = value;
            if let Some(observed) = &mut self.observed {
                observed.flow.forget_accu1();
            }
        }
        self.state.delayed = delayed;
        (self.work.mcr, self.work.pc) = (mcr, pc);
        Ok(())
    }

    /// Keeps the place at which the PLC stopped.
    pub(super) fn ended(&mut self, done: Result<(), Fault>) -> Result<(), Box<Stop>> {
        let Err(fault) = done else { return Ok(()) };
        let line = self.program.lines.get(self.work.pc as usize).copied().unwrap_or_default();
        let stop = Stop {
            fault,
            block: self.program.block_at(self.work.pc).map_or_else(String::new, |block| block.name.to_string()),
            network: line.network,
            statement: line.statement,
            file: self.program.files.get(usize::from(line.file)).cloned().unwrap_or_default(),
            line: line.line,
            registers: self.state.registers,
        };
        self.clear();
        self.state.stop = Some(stop.clone());
        Err(Box::new(stop))
    }
}

/// The address or the number of a fault, as OB121 sees it.
fn place_of(fault: Fault) -> u32 {
    match fault {
        Fault::ReadLength(byte) | Fault::WriteLength(byte) | Fault::Peripheral(byte) => byte,
        Fault::TimerNumber(number)
        | Fault::CounterNumber(number)
        | Fault::NoDataBlock(number)
        | Fault::NoInstance(number)
        | Fault::NoFunction(number)
        | Fault::NoFunctionBlock(number)
        | Fault::NoSystemFunction(number)
        | Fault::NoParameter(number) => u32::from(number),
        Fault::AreaCode(code) => u32::from(code),
        Fault::BcdDigit
        | Fault::Alignment
        | Fault::CallDepth
        | Fault::LocalData
        | Fault::Nesting
        | Fault::McrNesting
        | Fault::CycleTime
        | Fault::StopCalled => 0,
    }
}
