//! Tests of PLC programs in general and of the registry.

use crate::image::Names;
use crate::units::Time;

use super::bench::Bench;
use super::{OnDelay, PlcFault, PlcProgram, Programs, RisingEdge, program, program_with_fault};

fn counting() -> Box<dyn PlcProgram> {
    program("counting", (0_u16, RisingEdge::default()), |(count, edge), io| {
        *count += u16::from(edge.scan(io.inputs.bit(3, 4)));
        io.flags.set_word(10, *count);
    })
    .on_startup(|(count, _), io| {
        *count = 100;
        io.outputs.set_bit(4, 0, true);
    })
    .boxed()
}

fn count(bench: &mut Bench, program: &mut dyn PlcProgram) -> u16 {
    for on in [false, true] {
        bench.memory.inputs.set_bit(3, 4, on);
        bench.scan(program).unwrap();
    }
    bench.memory.flags.word(10)
}

#[test]
fn a_program_keeps_its_state_between_scans_and_clears_it_at_reset() {
    let (mut bench, mut program) = (Bench::with_axes(&["X"]), counting());
    assert_eq!(count(&mut bench, &mut *program), 1);
    assert_eq!(count(&mut bench, &mut *program), 2);
    program.reset();
    assert_eq!(count(&mut bench, &mut *program), 1);
}

#[test]
fn startup_runs_before_the_first_scan_and_only_when_called() {
    let (mut bench, mut program) = (Bench::with_axes(&["X"]), counting());
    program.startup(&mut bench.io()).unwrap();
    assert_eq!(bench.memory.outputs[4], 1);
    assert_eq!(count(&mut bench, &mut *program), 101);
}

#[test]
fn a_fork_continues_independently() {
    let (mut bench, mut program) = (Bench::with_axes(&["X"]), counting());
    count(&mut bench, &mut *program);
    let mut fork = program.fork().unwrap();
    assert_eq!(fork.name(), "counting");
    assert_eq!(count(&mut bench, &mut *fork), 2);
    assert_eq!(count(&mut bench, &mut *fork), 3);
    assert_eq!(count(&mut bench, &mut *program), 2);
}

#[test]
fn a_saved_program_continues_where_it_stopped() {
    let (mut bench, mut first) = (Bench::with_axes(&["X"]), counting());
    count(&mut bench, &mut *first);
    let saved = first.save();
    let mut second = counting();
    second.restore(&saved).unwrap();
    assert_eq!(count(&mut bench, &mut *second), 2);
    assert_eq!(second.save().len(), saved.len());
}

#[test]
fn the_state_of_another_program_is_refused() {
    let mut timer = program("timer", OnDelay::default(), |_, _| {});
    let problem = timer.restore(&[7, 7, 7]).unwrap_err().to_string();
    assert!(problem.contains("`timer`") && problem.contains("3 bytes"), "{problem}");
    assert!(timer.restore(&[0, 0]).is_err(), "bytes left over");
    assert!(timer.restore(&[0]).is_ok());
}

#[test]
fn a_program_can_stop_the_plc() {
    let mut bench = Bench::with_axes(&["X"]);
    let mut stops = program_with_fault("stops", (), |(), io| {
        if io.time > Time::from_millis(15) { Err(PlcFault::new("I0.0 failed")) } else { Ok(()) }
    });
    assert_eq!(bench.scan(&mut stops), Ok(()));
    let fault = bench.scan(&mut stops).unwrap_err();
    assert_eq!(fault.to_string(), "the PLC program stopped: I0.0 failed");
}

#[test]
fn a_program_finds_axes_by_name() {
    let mut bench = Bench::with_axes(&["X", "XF"]);
    let io = bench.io();
    assert_eq!(io.axis("XF").map(|axis| axis.number()), Some(2));
    assert_eq!(io.axis("xf"), None);
    assert_eq!(io.axes().count(), 2);
}

#[test]
fn programs_are_found_by_name_and_a_misspelt_name_gets_a_suggestion() {
    let programs = Programs::ready().with("mine", |_| Ok(counting()));
    let names = Names::default();
    assert!(programs.names().eq([
        "enable_all",
        "gantry_start",
        "gear_change",
        "limit_edge_marker",
        "machine_control_panel",
        "mine",
        "position_axis",
        "shared_reference_cam",
        "tool_change"
    ]));
    for name in ["enable_all", "gantry_start", "gear_change", "shared_reference_cam", "tool_change"] {
        assert_eq!(programs.program(name, &names).unwrap().name(), name);
    }
    assert_eq!(programs.program("mine", &names).unwrap().name(), "counting");
    let problem = programs.program("enable_al", &names).err().unwrap().to_string();
    assert!(problem.contains("did you mean `enable_all`?"), "{problem}");
}
