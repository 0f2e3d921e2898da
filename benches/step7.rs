//! Measures the engine for STEP 7 programs: statements per second, beside the same logic as a closure written by hand.
//! `benches/README.md` describes how to run it and its results.

use std::fmt::Write;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use opennck::plc::step7::{Cpu, CpuOptions, OwnMemory, Program, Settings, Source, compile};

/// Copies of the mixture in a scan.
const COPIES: usize = 100;
/// Statements of the mixture: bit logic, edges, a comparison, arithmetic, a data block.
const MIXTURE: u64 = 20;

fn main() {
    divan::main();
}

fn program(text: &str) -> Arc<Program> {
    let compiled = compile(&[Source::statements("bench.awl", text)], &Settings::default());
    assert!(compiled.findings.is_empty(), "{}", compiled.findings[0]);
    Arc::new(compiled.program.expect("it has no findings"))
}

/// 2,000 statements as a machine's program mixes them.
fn mixture() -> Arc<Program> {
    let mut text = String::from(
        "DATA_BLOCK DB 10\nSTRUCT\nw : ARRAY [0 .. 1023] OF INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\nORGANIZATION_BLOCK OB 1\nBEGIN\n",
    );
    for copy in 0..COPIES {
        let (bit, word, data) = (copy + 10, 200 + copy * 2, copy * 2);
        let _ = writeln!(
            text,
            "A I {bit}.0; AN I {bit}.1; O; A M {bit}.2; A( ; O I {bit}.3; O M {bit}.3; ) ; = Q {bit}.0; = M {bit}.4; \
             A M {bit}.4; FP M {bit}.5; S M {bit}.6; L MW {word}; L 1; +I; T MW {word}; L DB10.DBW {data}; L MW {word}; <I; = M {bit}.7;"
        );
    }
    text += "END_ORGANIZATION_BLOCK\n";
    program(&text)
}

/// A scan of 2,000 statements.
#[divan::bench]
fn statements(bencher: Bencher<'_, '_>) {
    let program = mixture();
    let mut memory = OwnMemory::new(&program);
    let mut cpu = Cpu::new(program, CpuOptions::default());
    let mut now = 0;
    bencher.counter(ItemsCount::new(COPIES as u64 * MIXTURE)).bench_local(|| {
        now += 10_000_000;
        memory.inputs[10] ^= 1;
        cpu.scan(&mut memory, now)
    });
}

/// Bit logic alone.
#[divan::bench]
fn bit_statements(bencher: Bencher<'_, '_>) {
    let mut text = String::from("ORGANIZATION_BLOCK OB 1\nBEGIN\n");
    for copy in 0..500 {
        let byte = copy % 100;
        let _ = writeln!(text, "A I {byte}.0; AN M {byte}.1; O M {byte}.2; = Q {byte}.3;");
    }
    text += "END_ORGANIZATION_BLOCK\n";
    let program = program(&text);
    let mut memory = OwnMemory::new(&program);
    let mut cpu = Cpu::new(program, CpuOptions::default());
    bencher.counter(ItemsCount::new(2_000_u64)).bench_local(|| cpu.scan(&mut memory, 0));
}

/// The mixture as a programmer writes it in Rust.
#[divan::bench]
fn closure_by_hand(bencher: Bencher<'_, '_>) {
    let program = mixture();
    let mut memory = OwnMemory::new(&program);
    let bit = |bytes: &[u8], byte: usize, bit: u8| bytes[byte] >> bit & 1 == 1;
    let set = |bytes: &mut [u8], byte: usize, bit: u8, value: bool| {
        let mask = 1 << bit;
        bytes[byte] = if value { bytes[byte] | mask } else { bytes[byte] & !mask };
    };
    let word = |bytes: &[u8], byte: usize| i16::from_be_bytes([bytes[byte], bytes[byte + 1]]);
    bencher.counter(ItemsCount::new(COPIES as u64 * MIXTURE)).bench_local(|| {
        memory.inputs[10] ^= 1;
        for copy in 0..COPIES {
            let (byte, at) = (divan::black_box(copy + 10), 200 + copy * 2);
            let (inputs, flags) = (&memory.inputs, &memory.flags);
            let result = bit(inputs, byte, 0) && !bit(inputs, byte, 1)
                || bit(flags, byte, 2) && (bit(inputs, byte, 3) || bit(flags, byte, 3));
            let rises = result && !bit(flags, byte, 5);
            let sum = word(flags, at).wrapping_add(1);
            set(&mut memory.outputs, byte, 0, result);
            let flags = &mut memory.flags;
            set(flags, byte, 4, result);
            set(flags, byte, 5, result);
            if rises {
                set(flags, byte, 6, true);
            }
            flags[at..at + 2].copy_from_slice(&sum.to_be_bytes());
            let is_less = memory.data(10).is_some_and(|data| word(data, copy * 2) < sum);
            set(&mut memory.flags, byte, 7, is_less);
        }
    });
}

/// A function with three parameters, called a hundred times: an operand in M, a constant, a data block.
#[divan::bench]
fn calls(bencher: Bencher<'_, '_>) {
    let mut text = String::from(
        "DATA_BLOCK DB 10\nSTRUCT\nw : ARRAY [0 .. 1023] OF INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
         FUNCTION FC 1 : INT\nVAR_INPUT\na : INT;\nb : INT;\nEND_VAR\nBEGIN\nL #a; L #b; +I; T #RET_VAL;\nEND_FUNCTION\nORGANIZATION_BLOCK OB 1\nBEGIN\n",
    );
    for copy in 0..100 {
        let _ = writeln!(text, "CALL FC 1 ( a := MW {copy}, b := 5, RET_VAL := DB10.DBW {} );", copy * 2);
    }
    text += "END_ORGANIZATION_BLOCK\n";
    let program = program(&text);
    let mut memory = OwnMemory::new(&program);
    let mut cpu = Cpu::new(program, CpuOptions::default());
    bencher.counter(ItemsCount::new(100_u64)).bench_local(|| cpu.scan(&mut memory, 0));
}
