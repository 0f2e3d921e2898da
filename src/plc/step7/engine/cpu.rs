//! The CPU: its complete state as plain data, and beside it what exists only while a block runs.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::plc::step7::basic_program::BasicState;
use crate::plc::step7::instruction::Logic;
use crate::plc::step7::program::Program;

use super::arithmetic::digits;
use super::fault::Stop;
use super::hours_meter::HoursMeter;
use super::interrupts::{Interrupts, present};
use super::memory::OpenBlock;
use super::observed::Observed;
use super::registers::Registers;
use super::timer::{Counter, Timer, bcd};

/// Properties of the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CpuOptions {
    /// Two accumulators as an S7-300 has them, or four as an S7-400.
    pub has_four_accumulators: bool,
    /// Bytes of local data of a priority class.
    pub local_data: u32,
    /// Calls within each other.
    pub call_depth: u16,
    /// The instructions of a scan after which its cycle monitoring time counts as exceeded.
    pub instructions_per_scan: u64,
    /// The periods of the cyclic interrupts OB30 to OB38, in ns.
    pub cyclic_nanos: [i64; 9],
    /// The date at time 0, in days since 1990-1-1.
    pub first_day: u32,
}

impl Default for CpuOptions {
    /// The CPU of a SINUMERIK 840D sl: two accumulators, 16 calls; 2024-1-1 as the date of power on.
    fn default() -> Self {
        Self {
            has_four_accumulators: false,
            local_data: 1024,
            call_depth: 16,
            instructions_per_scan: 10_000_000,
            // 5 s, 2 s, 1 s, 500 ms, 200 ms, 100 ms, 50 ms, 20 ms, 10 ms.
            cyclic_nanos: [5_000, 2_000, 1_000, 500, 200, 100, 50, 20, 10].map(|millis| millis * 1_000_000),
            first_day: 12_418,
        }
    }
}

/// The complete state of a CPU between two scans.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CpuState {
    /// The fingerprint of the program.
    pub(in crate::plc::step7) program: u64,
    pub(in crate::plc::step7) registers: Registers,
    /// The local data of all priority classes, not initialised between calls.
    pub(in crate::plc::step7) local: Vec<u8>,
    pub(in crate::plc::step7) timers: Vec<Timer>,
    pub(in crate::plc::step7) counters: Vec<Counter>,
    pub(in crate::plc::step7) stop: Option<Stop>,
    pub(in crate::plc::step7) scans: u64,
    /// The time of the start of the last scan, and the shortest and longest cycle, in ns.
    pub(in crate::plc::step7) last_scan: i64,
    pub(in crate::plc::step7) cycle: i64,
    pub(in crate::plc::step7) shortest: i64,
    pub(in crate::plc::step7) longest: i64,
    /// Time-of-day, time-delay and cyclic interrupts.
    pub(in crate::plc::step7) interrupts: Interrupts,
    pub(in crate::plc::step7) hours: [HoursMeter; 8],
    /// The next start is a cold restart.
    pub(in crate::plc::step7) is_cold: bool,
    /// SFC 41 calls that were not undone.
    pub(in crate::plc::step7) delayed: u16,
    /// Added to the virtual time for the clock, in ms, by SFC 0.
    pub(in crate::plc::step7) clock_shift: i64,
    /// The start information of the last start OB.
    pub(in crate::plc::step7) start_information: [u8; 20],
    /// The memory of the basic program.
    pub(in crate::plc::step7) basic: BasicState,
}

/// A bracket.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Nest {
    pub(in crate::plc::step7) rlo: bool,
    pub(in crate::plc::step7) or: bool,
    pub(in crate::plc::step7) fc: bool,
    pub(in crate::plc::step7) logic: Logic,
}

/// The master control relay of a block.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::plc::step7) struct McrState {
    pub(in crate::plc::step7) active: bool,
    pub(in crate::plc::step7) depth: u8,
    /// A bit for each open zone: on, and all outer ones too.
    pub(in crate::plc::step7) zones: u8,
}

impl McrState {
    /// Whether `=` and `T` write 0, and `S` and `R` nothing.
    pub(in crate::plc::step7) fn is_off(self) -> bool {
        self.active && self.depth > 0 && self.zones >> (self.depth - 1) & 1 == 0
    }
}

/// A block that runs.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Frame {
    /// Where the caller goes on.
    pub(in crate::plc::step7) back: u32,
    /// Its local data: from, to, in bytes.
    pub(in crate::plc::step7) local: (u32, u32),
    /// The local data of the caller.
    pub(in crate::plc::step7) caller: (u32, u32),
    /// Its parameters: the first, and the number.
    pub(in crate::plc::step7) parameters: (u32, u16),
    /// The brackets that were open before it.
    pub(in crate::plc::step7) nests: u32,
    /// DB, DI and AR2 after it.
    pub(in crate::plc::step7) db: OpenBlock,
    pub(in crate::plc::step7) di: OpenBlock,
    pub(in crate::plc::step7) ar2: Option<u32>,
    /// The MCR of the caller.
    pub(in crate::plc::step7) mcr: McrState,
}

/// A filter of faults: a bit for each event, counted from its first number.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::plc::step7) struct Mask {
    pub(in crate::plc::step7) masked: u32,
    /// Those that came while they were masked.
    pub(in crate::plc::step7) seen: u32,
}

/// What exists while a block runs; empty between two scans.
#[derive(Debug, Default)]
pub(in crate::plc::step7) struct Work {
    pub(in crate::plc::step7) frames: Vec<Frame>,
    pub(in crate::plc::step7) parameters: Vec<u32>,
    pub(in crate::plc::step7) nests: Vec<Nest>,
    pub(in crate::plc::step7) mcr: McrState,
    pub(in crate::plc::step7) budget: u64,
    pub(in crate::plc::step7) now: i64,
    /// Whether OB80, OB121 or OB122 runs.
    pub(in crate::plc::step7) in_error: bool,
    /// Whether OB80 has run in this scan.
    pub(in crate::plc::step7) is_late: bool,
    /// The instruction that runs, or ran last.
    pub(in crate::plc::step7) pc: u32,
    /// Programming errors and access errors that do not call OB121 and OB122.
    pub(in crate::plc::step7) masks: [Mask; 2],
    /// What ACCU1 has after OB121 or OB122 (SFC 44).
    pub(in crate::plc::step7) replacement: Option<u32>,
}

/// A CPU with its program. The memory is not a part of it.
#[derive(Debug)]
pub struct Cpu {
    pub(in crate::plc::step7) program: Arc<Program>,
    pub(in crate::plc::step7) options: CpuOptions,
    pub(in crate::plc::step7) state: CpuState,
    pub(in crate::plc::step7) work: Work,
    /// A bit for each block of the program that time can start.
    pub(in crate::plc::step7) interrupts: u64,
    /// What is observed, if it is; no part of the state.
    pub(in crate::plc::step7) observed: Option<Box<Observed>>,
}

impl Clone for Cpu {
    /// A second CPU with the same program and state, between two scans.
    fn clone(&self) -> Self {
        let mut copy = Self::new(Arc::clone(&self.program), self.options);
        copy.state = self.state.clone();
        copy.observed = self.observed.as_ref().map(|_| Box::new(Observed::new(self.program.code.len())));
        copy
    }
}

impl Cpu {
    /// A CPU after loading a program.
    #[must_use]
    pub fn new(program: Arc<Program>, options: CpuOptions) -> Self {
        let sizes = program.sizes();
        let depth = usize::from(options.call_depth) * 2 + 4;
        let state = CpuState {
            program: program.fingerprint,
            registers: Registers::default(),
            local: vec![0; options.local_data as usize * 2],
            timers: vec![Timer::default(); sizes.timers as usize],
            counters: vec![Counter::default(); sizes.counters as usize],
            stop: None,
            scans: 0,
            last_scan: 0,
            cycle: 0,
            shortest: 0,
            longest: 0,
            interrupts: Interrupts::default(),
            hours: [HoursMeter::default(); 8],
            is_cold: false,
            delayed: 0,
            clock_shift: 0,
            start_information: [0; 20],
            basic: BasicState::default(),
        };
        let work = Work {
            frames: Vec::with_capacity(depth),
            parameters: Vec::with_capacity(depth * 64),
            nests: Vec::with_capacity(depth * 8),
            ..Work::default()
        };
        let interrupts = present(&program);
        Self { program, options, state, work, interrupts, observed: None }
    }

    /// The state, to save it.
    #[must_use]
    pub fn state(&self) -> &CpuState {
        &self.state
    }

    /// Goes on from a saved state; `false` if it is of another program.
    pub fn restore(&mut self, state: CpuState) -> bool {
        let fits = state.program == self.state.program
            && state.timers.len() == self.state.timers.len()
            && state.counters.len() == self.state.counters.len()
            && state.local.len() == self.state.local.len();
        if fits {
            self.state = state;
        }
        fits
    }

    /// Observes the program from now on, for coverage and causes: slower, with the same results.
    pub fn observe(&mut self) {
        self.observed.get_or_insert_with(|| Box::new(Observed::new(self.program.code.len())));
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The program, to share it with another CPU.
    #[must_use]
    pub fn shared_program(&self) -> Arc<Program> {
        Arc::clone(&self.program)
    }

    /// Why the PLC stopped, if it did.
    #[must_use]
    pub fn stopped(&self) -> Option<&Stop> {
        self.state.stop.as_ref()
    }

    /// The registers after the last scan.
    #[must_use]
    pub fn registers(&self) -> Registers {
        self.state.registers
    }

    /// The registers, to be set before a scan.
    pub fn registers_mut(&mut self) -> &mut Registers {
        &mut self.state.registers
    }

    /// The options with which it runs.
    #[must_use]
    pub fn options(&self) -> CpuOptions {
        self.options
    }

    /// The word of a timer as clients read it: the value in BCD with its base in the bits 12 and 13, at a time in ns.
    #[must_use]
    pub fn timer_word(&self, number: u16, now: i64) -> Option<u16> {
        let timer = self.state.timers.get(usize::from(number))?;
        Some(u16::from(timer.base()) << 12 | bcd(timer.value(now)))
    }

    /// The word of a counter as clients read it: the value in BCD.
    #[must_use]
    pub fn counter_word(&self, number: u16) -> Option<u16> {
        self.counter(number).map(bcd)
    }

    /// Sets a counter from a word in BCD; a digit above 9 changes nothing.
    pub fn set_counter_word(&mut self, number: u16, word: u16) {
        if let (Some(counter), Ok(value)) =
            (self.state.counters.get_mut(usize::from(number)), digits(u32::from(word & 0xFFF)))
        {
            counter.value = u16::try_from(value).unwrap_or(999);
        }
    }

    /// The value of a timer as `L T` loads it, and its status bit, at a time in ns.
    #[must_use]
    pub fn timer(&self, number: u16, now: i64) -> Option<(u16, bool)> {
        self.state.timers.get(usize::from(number)).map(|timer| (timer.value(now), timer.status(now)))
    }

    /// The value of a counter.
    #[must_use]
    pub fn counter(&self, number: u16) -> Option<u16> {
        self.state.counters.get(usize::from(number)).map(|counter| counter.value)
    }
}
