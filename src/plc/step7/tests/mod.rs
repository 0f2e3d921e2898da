//! Tests of the compiler and the engine. Expected values come from the rules of the operations and from arithmetic beside them.

mod addressing;
mod basic_blocks;
mod basic_program;
mod blocks;
mod calls;
mod control;
mod differences;
mod faults;
mod hostile;
mod instructions;
mod interface;
mod interrupts;
mod observed;
mod rare;
mod rules;
mod saved;
mod system;
mod timers;

use std::sync::Arc;

use super::engine::{Cpu, CpuOptions, Fault, OpenBlock, OwnMemory, Registers, Status};
use super::instruction::{BlockKind, Op};
use super::program::Program;
use super::{Settings, Source, compile};

pub(super) const SECOND: i64 = 1_000_000_000;

/// Compiles a source that has no findings.
#[track_caller]
pub(super) fn program(text: &str) -> Arc<Program> {
    let compiled = compile(&[Source::statements("a.awl", text)], &Settings::default());
    let findings: Vec<_> = compiled.findings.iter().map(ToString::to_string).collect();
    Arc::new(compiled.program.unwrap_or_else(|| panic!("{}", findings.join("\n"))))
}

/// The findings of a source, one line each.
pub(super) fn findings(text: &str) -> Vec<String> {
    let compiled = compile(&[Source::statements("a.awl", text)], &Settings::default());
    assert_eq!(compiled.program.is_some(), compiled.findings.is_empty());
    compiled.findings.iter().map(ToString::to_string).collect()
}

/// A CPU with its memory.
#[derive(Clone)]
pub(super) struct Plc {
    pub(super) cpu: Cpu,
    pub(super) memory: OwnMemory,
    pub(super) now: i64,
}

impl Plc {
    #[track_caller]
    pub(super) fn new(text: &str) -> Self {
        Self::with(text, CpuOptions::default())
    }

    #[track_caller]
    pub(super) fn with(text: &str, options: CpuOptions) -> Self {
        let program = program(text);
        let mut memory = OwnMemory::new(&program);
        let mut cpu = Cpu::new(program, options);
        cpu.startup(&mut memory, 0).unwrap();
        Self { cpu, memory, now: 0 }
    }

    /// An organization block with these statements, and room in all areas.
    #[track_caller]
    pub(super) fn of_statements(statements: &str) -> Self {
        Self::new(&ob1(statements))
    }

    #[track_caller]
    pub(super) fn scan(&mut self) -> &mut Self {
        if let Err(stop) = self.cpu.scan(&mut self.memory, self.now) {
            panic!("{stop}");
        }
        self
    }

    /// A scan some time later.
    #[track_caller]
    pub(super) fn after(&mut self, nanos: i64) -> &mut Self {
        self.now += nanos;
        self.scan()
    }

    /// The fault of the next scan.
    #[track_caller]
    pub(super) fn fault(&mut self) -> Fault {
        self.cpu.scan(&mut self.memory, self.now).expect_err("the scan should stop").fault
    }

    pub(super) fn bit(&self, byte: usize, bit: u8) -> bool {
        self.memory.flags[byte] >> bit & 1 == 1
    }

    pub(super) fn set_bit(&mut self, byte: usize, bit: u8, value: bool) -> &mut Self {
        let mask = 1 << bit;
        let byte = &mut self.memory.flags[byte];
        *byte = if value { *byte | mask } else { *byte & !mask };
        self
    }

    pub(super) fn word(&self, byte: usize) -> u16 {
        u16::from_be_bytes(*self.memory.flags[byte..].first_chunk().unwrap())
    }

    pub(super) fn double(&self, byte: usize) -> u32 {
        u32::from_be_bytes(*self.memory.flags[byte..].first_chunk().unwrap())
    }
}

/// OB1 with these statements; T 20, C 20 and M, I, Q up to byte 255 exist, and DB10 with 32 bytes.
pub(super) fn ob1(statements: &str) -> String {
    format!(
        "DATA_BLOCK DB 10\nSTRUCT\nw : ARRAY [0 .. 15] OF WORD;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
         ORGANIZATION_BLOCK OB 1\nVAR_TEMP\ninfo : ARRAY [0 .. 19] OF BYTE;\nEND_VAR\nBEGIN\nNETWORK\n{statements}\n\
         BEU;\nL MB 255; L IB 255; L QB 255; L T 20; L C 20;\nEND_ORGANIZATION_BLOCK\n"
    )
}

/// Registers for a trial: both accumulators, and the nine bits of the status word.
pub(super) fn registers(accu2: u32, accu1: u32, status: u16) -> Registers {
    Registers {
        accu: [accu1, accu2, 0x3333_3333, 0x4444_4444],
        status: Status::from_word(status),
        ..Registers::default()
    }
}

/// Runs statements in OB1 from given registers, up to its `BEU`; returns the registers and the memory.
#[track_caller]
pub(super) fn trial(statements: &str, before: Registers) -> (Result<(), Fault>, Registers, OwnMemory) {
    trial_with(statements, before, CpuOptions::default())
}

#[track_caller]
pub(super) fn trial_with(
    statements: &str,
    before: Registers,
    options: CpuOptions,
) -> (Result<(), Fault>, Registers, OwnMemory) {
    let program = program(&ob1(statements));
    let mut memory = OwnMemory::new(&program);
    let mut cpu = Cpu::new(Arc::clone(&program), options);
    let index = program.find(BlockKind::Ob, 1).unwrap();
    let block = &program.blocks[usize::from(index)];
    cpu.work.budget = 1000;
    cpu.push(block.local, (0, 0), 0, (OpenBlock::default(), OpenBlock::default(), None)).unwrap();
    cpu.state.registers = before;
    let mut pc = block.start;
    let mut done = Ok(());
    loop {
        let op = program.code[pc as usize];
        if matches!(op, Op::End(_)) && cpu.work.frames.len() == 1 || done.is_err() {
            return (done, cpu.state.registers, memory);
        }
        pc += 1;
        done = cpu.execute(&mut memory, op, &mut pc);
    }
}
