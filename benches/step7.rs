//! Measures the engine for STEP 7 programs: statements per second, and a machine with an AWL program, beside the same logic as a closure
//! written by hand.
//! `benches/README.md` describes how to run it and its results.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use divan::Bencher;
use divan::counter::ItemsCount;
use opennck::machine::{Command, Machine};
use opennck::plc::step7::{Cpu, CpuOptions, Folder, LoadedProgram, OwnMemory, Program, Settings, Source, compile};
use opennck::plc::{ClosureProgram, OnDelay, PlcProgram, RisingEdge, program as program_by_hand};
use opennck::units::{ModeGroupNumber, Time};
use serde::{Deserialize, Serialize};

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

/// Steps of a sample of the machine.
const STEPS: u64 = 1_000;

/// The machine of the portal example with its inputs set, after ten seconds.
fn portal(program: Box<dyn PlcProgram>) -> Machine {
    let mut machine = Machine::open("g1_example").expect("it is built in");
    machine.load_program(program);
    // Emergency stop released, door closed, pressure, clamp key, clamp closed.
    for input in ["I1.0", "I1.1", "I1.2", "I0.5", "I1.3"] {
        let location = machine.names().resolve(machine.memory(), input).expect("it exists");
        machine.queue(Command::Write { location, value: 1 }).expect("it is an input");
    }
    for _ in 0..5_000 {
        machine.step();
        machine.drain();
    }
    assert_eq!(machine.variables().alarms.count(), 0, "{:?}", machine.variables().alarms);
    let active = machine.names().resolve(machine.memory(), "X.position_controller_active").expect("it exists");
    assert_eq!(machine.memory().read(active), 1);
    machine
}

fn steps(bencher: Bencher<'_, '_>, mut machine: Machine) {
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            machine.step();
            machine.drain();
        }
        machine.cycle()
    });
}

/// A step of the machine with the AWL program of the portal example, which scans in each NC cycle here.
#[divan::bench]
fn portal_machine(bencher: Bencher<'_, '_>) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/step7_portal/plc");
    let Folder { sources, toml } = Folder::read(&folder).expect("it is a program");
    let program = LoadedProgram::compile(&sources, &toml.settings, "portal").expect("it has no findings");
    steps(bencher, portal(program.boxed()));
}

/// The peer: the same machine, and the same logic in Rust.
#[divan::bench]
fn portal_machine_by_hand(bencher: Bencher<'_, '_>) {
    steps(bencher, portal(by_hand().boxed()));
}

/// What the portal program remembers.
#[derive(Clone, Default, Serialize, Deserialize)]
struct ByHand {
    keys: [RisingEdge; 3],
    pressure: OnDelay,
    monitoring: OnDelay,
    controllers: [OnDelay; 3],
    fault: bool,
    counted: RisingEdge,
    faults: u16,
}

fn by_hand() -> ClosureProgram<ByHand> {
    program_by_hand("portal_by_hand", ByHand::default(), |state, io| {
        let key = |bit| io.inputs.bit(0, bit);
        let [jog, reference, automatic, plus, minus, clamp] = [0, 1, 2, 3, 4, 5].map(key);
        let [released, door, pressure, closed] = [0, 1, 2, 3].map(|bit| io.inputs.bit(1, bit));
        let now = io.time;
        let group = io.to_nck.mode_group(ModeGroupNumber::FIRST);
        let pressed = [jog, reference, automatic && !plus && !minus];
        for (number, (edge, pressed)) in state.keys.iter_mut().zip(pressed).enumerate() {
            if edge.scan(pressed) {
                group.set_mode_jog(number < 2);
                group.set_mode_automatic(number == 2);
                group.set_machine_function_ref(number == 1);
            }
        }
        let ready = state.pressure.scan(released && pressure, Time::from_millis(1_000), now);
        let valve = clamp && ready;
        if state.monitoring.scan(valve && !closed, Time::from_millis(2_000), now) {
            state.fault = true;
        }
        state.fault &= valve;
        state.faults += u16::from(state.counted.scan(state.fault));
        let nck = io.to_nck.nck();
        nck.set_acknowledge_emergency_stop(released);
        nck.set_emergency_stop(!released);
        let may_move = released && door && ready && !state.fault;
        for (name, delay) in ["X", "Y", "XF"].into_iter().zip(&mut state.controllers) {
            let Some(axis) = io.axis(name) else { continue };
            let signals = io.to_nck.axis(axis);
            signals.set_position_measuring_system_1(true);
            signals.set_pulse_enable(may_move);
            signals.set_controller_enable(delay.scan(may_move, Time::from_millis(100), now));
        }
        let Some(x) = io.axis("X") else { return };
        let (from, to) = (io.from_nck.axis(x), io.to_nck.axis(x));
        to.set_traversing_key_plus(plus && !minus && closed && may_move);
        to.set_traversing_key_minus(minus && !plus && closed && may_move);
        to.set_start_gantry_synchronization(from.gantry_synchronization_ready_to_start() && may_move);
        let lamps = [released, valve, state.fault, from.gantry_grouping_is_synchronized()];
        for (bit, lamp) in (0..).zip(lamps) {
            io.outputs.set_bit(0, bit, lamp);
        }
        io.flags.set_bit(10, 0, ready);
        io.flags.set_bit(10, 1, may_move);
        io.flags.set_bit(11, 0, state.fault);
    })
}
