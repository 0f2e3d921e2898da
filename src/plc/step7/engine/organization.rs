//! Organization blocks: start-up, the cyclic program, the cyclic interrupt, and the blocks that faults call.

use crate::plc::step7::instruction::BlockKind;
use crate::plc::step7::text::constants::date_time_of;

use super::cpu::{Cpu, McrState};
use super::fault::{Fault, Stop};
use super::flow::Flow;
use super::memory::{Areas, OpenBlock};
use super::registers::Status;

const DAY_MILLIS: i64 = 86_400_000;
const MILLI_NANOS: i64 = 1_000_000;

/// The start information of an organization block: its first 20 bytes of local data.
type Information = [u8; 20];

impl Cpu {
    /// Power on: OB100. Timers, counters and registers begin from nothing; the memory is the caller's.
    ///
    /// # Errors
    /// The program stopped the PLC.
    pub fn startup<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        let fresh = Self::new(std::sync::Arc::clone(&self.program), self.options);
        self.state = fresh.state;
        self.state.next_ob35 = now.saturating_add(self.options.ob35_nanos);
        self.begin(now);
        let mut information = self.information(0x13, 0x82, 27, 100);
        information[12..].copy_from_slice(&self.date_and_time());
        self.state.start_information = information;
        let done = self.organization_block(areas, 100, &information);
        self.ended(done)
    }

    /// A scan at a time in ns: OB35 if it is due, then OB1.
    ///
    /// # Errors
    /// The program stopped the PLC, now or in an earlier scan.
    pub fn scan<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        if let Some(stop) = &self.state.stop {
            return Err(Box::new(stop.clone()));
        }
        self.begin(now);
        self.measure(now);
        self.cyclic_interrupt(areas, now)?;
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

    /// Between two scans, at a time in ns: OB35 if it is due.
    ///
    /// # Errors
    /// The program stopped the PLC, now or in an earlier scan.
    pub fn interrupt<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        if let Some(stop) = &self.state.stop {
            return Err(Box::new(stop.clone()));
        }
        self.begin(now);
        self.cyclic_interrupt(areas, now)
    }

    /// Whether the program has a block that runs between two scans.
    #[must_use]
    pub fn has_interrupts(&self) -> bool {
        self.program.find(BlockKind::Ob, 35).is_some()
    }

    /// Whether [`Cpu::interrupt`] would run a block at a time in ns.
    #[must_use]
    pub fn interrupt_is_due(&self, now: i64) -> bool {
        now >= self.state.next_ob35 && self.has_interrupts()
    }

    fn cyclic_interrupt<A: Areas>(&mut self, areas: &mut A, now: i64) -> Result<(), Box<Stop>> {
        if now >= self.state.next_ob35 {
            let period = self.options.ob35_nanos.max(1);
            let late = (now - self.state.next_ob35) / period;
            self.state.next_ob35 = self.state.next_ob35.saturating_add((late + 1).saturating_mul(period));
            if !self.state.is_disabled {
                let mut information = self.information(0x11, 0x36, 12, 35);
                let millis = i16::try_from(period / MILLI_NANOS).unwrap_or(i16::MAX);
                information[10..12].copy_from_slice(&millis.to_be_bytes());
                let done = self.organization_block(areas, 35, &information);
                self.ended(done)?;
            }
        }
        Ok(())
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

    fn information(&self, class: u8, event: u8, priority: u8, number: u8) -> Information {
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
        let first = i64::from(self.options.first_day) * DAY_MILLIS;
        (first + self.work.now / MILLI_NANOS).saturating_add(self.state.clock_shift).max(0)
    }

    /// Runs an organization block if the program has it.
    fn organization_block<A: Areas>(
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
        let number: u8 = if matches!(fault, Fault::Peripheral(_)) { 122 } else { 121 };
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
        self.state.delayed = delayed;
        (self.work.mcr, self.work.pc) = (mcr, pc);
        Ok(())
    }

    /// Keeps the place at which the PLC stopped.
    fn ended(&mut self, done: Result<(), Fault>) -> Result<(), Box<Stop>> {
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
