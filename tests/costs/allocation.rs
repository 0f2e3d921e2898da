//! Tests that a step does not allocate, so that its time does not depend on the heap.
//!
//! Allocations are allowed in three cases: in a step in which RESET, "set machine data active" or power on activates changed machine data,
//! at the first write to memory that a clone shares, and when a command is queued.

use opennck::machine::{Command, DatumValue, Machine};
use opennck::plc::program;
use opennck::plc::step7::{Cpu, CpuOptions, LoadedProgram, OwnMemory, Settings, Source, compile};

fn write(machine: &mut Machine, signal: &str, value: u64) {
    let location = machine.names().resolve(machine.memory(), signal).expect("a signal");
    machine.queue(Command::Write { location, value }).expect("a write");
}

/// The worked example in REF with all enables, and with a PLC program that writes its memory.
fn ready() -> Machine {
    let mut machine = Machine::open("g1_example").expect("it is built in");
    let plc = program("enable_and_count", 0_u16, |scans, io| {
        *scans = scans.wrapping_add(1);
        io.flags.set_word(20, *scans);
        io.outputs.set_bit(4, 0, *scans & 1 == 1);
        for axis in io.axes() {
            let signals = io.to_nck.axis(axis);
            signals.set_position_measuring_system_1(true);
            signals.set_controller_enable(true);
            signals.set_pulse_enable(true);
        }
    });
    machine.load_program(plc.boxed());
    write(&mut machine, "DB11.DBX0.2", 1);
    write(&mut machine, "DB11.DBX1.2", 1);
    for _ in 0..50 {
        machine.step();
        machine.drain();
    }
    machine
}

/// Runs steps until a bit is 1, drains the record between them, and checks that no step allocates.
fn step_until(machine: &mut Machine, signal: &str) {
    let location = machine.names().resolve(machine.memory(), signal).expect("a signal");
    let mut rows = 0;
    while machine.memory().read(location) == 0 {
        assert!(machine.cycle() < 10_000, "{signal} did not become 1");
        let allocated = allocation_counter::measure(|| machine.step());
        assert_eq!(allocated.count_total, 0, "cycle {}", machine.cycle());
        rows += machine.recorder().rows().len();
        machine.drain();
    }
    assert!(rows > 0, "nothing was recorded");
}

#[test]
fn allocations_are_counted() {
    let machine = ready();
    assert!(allocation_counter::measure(|| drop(machine.save())).count_total > 0);
}

/// Calls, brackets, timers, a fault with OB121, a system function.
#[test]
fn no_scan_of_a_step_7_program_allocates() {
    let text = "DATA_BLOCK DB 10\nSTRUCT\nw : ARRAY [0 .. 9] OF INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
        FUNCTION FC 1 : INT\nVAR_INPUT\na : INT;\nb : ANY;\nEND_VAR\nBEGIN\nL #a; T #RET_VAL;\nEND_FUNCTION\n\
        ORGANIZATION_BLOCK OB 121\nBEGIN\nNOP 0;\nEND_ORGANIZATION_BLOCK\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nA( ; A( ; A M 0.0; ) ; ) ; L S5T#1S; SE T 1; OPN DB 99; \
        CALL FC 1 ( a := DB10.w[1], b := DB10.w, RET_VAL := DB10.w[2] ); \
        CALL SFC 20 ( SRCBLK := P#M 0.0 BYTE 4, RET_VAL := MW 10, DSTBLK := DB10.w );\nEND_ORGANIZATION_BLOCK\n";
    let program =
        compile(&[Source::statements("a.awl", text)], &Settings::default()).program.expect("it has no faults");
    let program = std::sync::Arc::new(program);
    let mut memory = OwnMemory::new(&program);
    let mut cpu = Cpu::new(program, CpuOptions::default());
    for scan in 0..3 {
        let allocated = allocation_counter::measure(|| cpu.scan(&mut memory, scan * 10_000_000).expect("it runs"));
        assert_eq!(allocated.count_total, 0, "scan {scan}");
    }
}

/// The program of a machine, with an interface data block, a data block of its own, timers and OB35.
#[test]
fn no_step_of_a_machine_with_a_step_7_program_allocates() {
    let text = "DATA_BLOCK DB 100\nSTRUCT\nscans : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
        ORGANIZATION_BLOCK OB 35\nBEGIN\nL MW 50; + 1; T MW 50;\nEND_ORGANIZATION_BLOCK\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nSET; = DB32.DBX 1.5; = DB32.DBX 2.1; = DB32.DBX 21.7; \
        L DB100.scans; + 1; T DB100.scans; AN T 1; L S5T#50MS; SE T 1; A DB32.DBX 61.5; CU C 1;\nEND_ORGANIZATION_BLOCK\n";
    let program = LoadedProgram::compile(&[Source::statements("a.awl", text)], &Settings::default(), "a");
    let mut machine = Machine::open("g1_example").expect("it is built in");
    machine.load_program(program.expect("it has no findings").boxed());
    for _ in 0..50 {
        machine.step();
        machine.drain();
    }
    for _ in 0..200 {
        let allocated = allocation_counter::measure(|| machine.step());
        assert_eq!(allocated.count_total, 0, "cycle {}", machine.cycle());
        machine.drain();
    }
    let counted = machine.names().resolve(machine.memory(), "C1").expect("a counter");
    assert_eq!(machine.memory().read(counted), 1, "position control became active once");
}

#[test]
fn no_step_of_referencing_and_synchronising_allocates() {
    reference_and_synchronise(&mut ready());
}

/// Jerk filters, feed-forward with dead time and matching, on axes that NEWCONF has activated them for.
#[test]
fn no_step_with_filters_and_delays_allocates() {
    let mut machine = ready();
    for axis in ["X", "XF"] {
        for (number, value) in [("32400", 1.0), ("32410", 0.05), ("32420", 1.0), ("32430", 10.0), ("32620", 3.0)] {
            let (target, value) = (format!("{number}[{axis}]"), DatumValue::Real(value));
            machine.queue(Command::MachineDatum { target, value }).expect("a machine datum");
        }
        let matching = [(format!("32900[{axis}]"), 1.0), (format!("32910[0,{axis}]"), 0.002)];
        for (target, value) in matching {
            machine.queue(Command::MachineDatum { target, value: DatumValue::Real(value) }).expect("a machine datum");
        }
    }
    write(&mut machine, "DB21.DBX7.7", 1);
    for _ in 0..50 {
        machine.step();
        machine.drain();
    }
    write(&mut machine, "DB21.DBX7.7", 0);
    machine.step();
    reference_and_synchronise(&mut machine);
}

fn reference_and_synchronise(machine: &mut Machine) {
    write(machine, "X.traversing_key_plus", 1);
    step_until(machine, "DB31.DBX60.4");
    step_until(machine, "DB33.DBX60.4");
    write(machine, "X.start_gantry_synchronization", 1);
    step_until(machine, "DB31.DBX101.5");
}

#[test]
fn no_step_of_a_fork_or_of_a_restored_machine_allocates() {
    let origin = ready();
    let mut fork = origin.fork().expect("a closure over its state");
    let mut restored = ready();
    restored.restore(&origin.save()).expect("it was saved on the same machine");
    drop(origin);
    for machine in [&mut fork, &mut restored] {
        write(machine, "X.traversing_key_plus", 1);
        machine.step();
        step_until(machine, "DB31.DBX101.4");
    }
}

#[test]
fn a_reset_without_changed_machine_data_does_not_allocate() {
    let mut machine = ready();
    write(&mut machine, "DB21.DBX7.7", 1);
    step_until(&mut machine, "DB21.DBX7.7");
}
