//! Tests of the order in a step: in which cycle each part receives the data of the others, and what survives power off.

use crate::control::Owner;

use super::{Command, DatumValue, Fault, FaultKind, Machine, OpenOptions};
use crate::image::{Format, Location, Part, Preset, Profile};
use crate::plc::{PlcIo, enable_all, program};
use crate::source::Table;
use crate::trace::Change;
use crate::units::{AxisNumber, ChannelNumber, Position, Time};
use crate::variables::Describe;

/// The worked example without a PLC program, with tables merged over its plant.
fn example_with(plant: &str) -> Machine {
    let plant_over = Some(Table::parse(plant, "test").unwrap());
    Machine::open_with("g1_example", OpenOptions { plant_over, ..OpenOptions::default() }).unwrap()
}

fn example() -> Machine {
    Machine::open("g1_example").unwrap()
}

/// The worked example with every axis in position control, in JOG.
fn ready() -> Machine {
    let mut machine = example();
    machine.load_program(enable_all().boxed());
    set(&mut machine, "DB11.DBX0.2", 1);
    run(&mut machine, 30);
    assert_eq!(get(&machine, "DB31.DBX61.5"), 1);
    machine
}

fn at(machine: &Machine, name: &str) -> Location {
    machine.names().resolve(machine.memory(), name).unwrap()
}

fn get(machine: &Machine, name: &str) -> u64 {
    machine.memory().read(at(machine, name))
}

/// Queues a write, also of a bit of the NCK.
fn set(machine: &mut Machine, name: &str, value: u64) {
    let location = at(machine, name);
    machine.queue(Command::Write { location, value }).unwrap();
}

fn force(machine: &mut Machine, name: &str, value: u64) {
    let location = at(machine, name);
    machine.queue(Command::Force { location, value }).unwrap();
}

fn store(machine: &mut Machine, target: &str, value: DatumValue) {
    machine.queue(Command::MachineDatum { target: target.to_owned(), value }).unwrap();
}

fn run(machine: &mut Machine, cycles: u32) {
    for _ in 0..cycles {
        machine.step();
        machine.drain();
    }
}

fn setpoint(machine: &Machine, axis: &str) -> Position {
    machine.variables().axes[machine.axis(axis).unwrap()].setpoint
}

/// Counts its scans in MB0.
fn count_scans(_: &mut (), io: &mut PlcIo<'_>) {
    let count = io.flags.byte(0);
    io.flags.set_byte(0, count + 1);
}

#[test]
fn a_write_acts_in_the_next_step_and_the_control_answers_in_the_same_one() {
    let mut machine = ready();
    set(&mut machine, "DB11.DBX1.2", 1);
    assert_eq!(get(&machine, "DB11.DBX1.2"), 0);
    machine.step();
    assert_eq!((get(&machine, "DB11.DBX1.2"), get(&machine, "DB11.DBX7.2")), (1, 1));
}

#[test]
fn the_control_sees_the_plc_of_this_cycle_and_the_plc_sees_the_control_of_the_last_one() {
    let mut machine = ready();
    // In its third scan the program requests REF; M1.0 shows its view of 7.2.
    machine.load_program(
        program("ref", (), |(), io| {
            count_scans(&mut (), io);
            let third = io.flags.byte(0) >= 3;
            let active = io.from_nck.mode_groups[crate::units::ModeGroupNumber::FIRST].active_machine_function_ref();
            io.flags.set_bit(1, 0, active);
            io.to_nck.mode_groups[crate::units::ModeGroupNumber::FIRST].set_machine_function_ref(third);
        })
        .boxed(),
    );
    run(&mut machine, 2);
    assert_eq!((get(&machine, "DB11.DBX7.2"), get(&machine, "M1.0")), (0, 0));
    run(&mut machine, 1);
    assert_eq!((get(&machine, "DB11.DBX7.2"), get(&machine, "M1.0")), (1, 0));
    run(&mut machine, 1);
    assert_eq!((get(&machine, "DB11.DBX7.2"), get(&machine, "M1.0")), (1, 1));
}

#[test]
fn the_plc_program_sees_the_inputs_of_this_cycle() {
    // The cam of X is wired to I3.4, and the slide is on the cam. The cam of XF is not wired, and its slide is on the cam, too.
    let mut machine = example_with("[X]\nstart = 300.0\n[X.cam]\ninput = \"I3.4\"\n[XF]\nstart = 300.0\n");
    machine.load_program(
        program("cams", (), |(), io| {
            let xf_at_scan = io.to_nck.axes[AxisNumber::new(3).unwrap()].deceleration_reference_point_approach();
            io.flags.set_bit(1, 3, xf_at_scan);
            let cam = io.inputs.bit(3, 4);
            io.to_nck.axes[AxisNumber::FIRST].set_deceleration_reference_point_approach(cam);
        })
        .boxed(),
    );
    machine.step();
    assert_eq!((get(&machine, "I3.4"), get(&machine, "DB31.DBX12.7")), (1, 1));
    // A switch that is not wired is set after the scan: the program sees it one scan later.
    assert_eq!((get(&machine, "DB33.DBX12.7"), get(&machine, "M1.3")), (1, 0));
    machine.step();
    assert_eq!(get(&machine, "M1.3"), 1);
}

#[test]
fn a_plc_cycle_of_10_ms_scans_in_every_fifth_cycle_of_2_ms() {
    let mut machine = example_with("[machine]\nplc_cycle = \"10ms\"\n");
    machine.load_program(program("count", (), count_scans).boxed());
    let mut counts = Vec::new();
    for _ in 0..12 {
        machine.step();
        counts.push(get(&machine, "MB0"));
    }
    assert_eq!(counts, [1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3]);
}

#[test]
fn a_force_wins_over_the_plc_program_until_it_is_released() {
    let mut machine = ready();
    force(&mut machine, "XF.controller_enable", 0);
    run(&mut machine, 1);
    assert_eq!(get(&machine, "XF.controller_enable"), 0);
    run(&mut machine, 5);
    assert_eq!((get(&machine, "XF.controller_enable"), get(&machine, "XF.position_controller_active")), (0, 0));
    let location = at(&machine, "XF.controller_enable");
    machine.queue(Command::Release { location }).unwrap();
    run(&mut machine, 1);
    assert_eq!(get(&machine, "XF.controller_enable"), 1);
}

#[test]
fn a_write_that_the_plc_program_overwrites_is_noticed_in_the_same_cycle() {
    let mut machine = ready();
    let location = at(&machine, "X.controller_enable");
    set(&mut machine, "X.controller_enable", 0);
    machine.step();
    assert_eq!(get(&machine, "X.controller_enable"), 1);
    let noticed = |row: &crate::trace::Row| {
        row.cycle == machine.cycle()
            && row.change == Change::Overwritten { part: location.part, offset: location.offset, bits: 1 << 1 }
    };
    assert!(machine.recorder().rows().iter().any(noticed), "{:?}", machine.recorder().rows());
    assert_eq!(get(&machine, "X.position_controller_active"), 1);
}

/// SIG-11
#[test]
fn a_foreign_write_to_a_bit_of_the_nck_lasts_until_its_next_publication() {
    let mut machine = ready();
    machine.load_program(
        program("look", (), |(), io| {
            enable(io);
            let synchronised = io.from_nck.axes[AxisNumber::FIRST].gantry_grouping_is_synchronized();
            io.flags.set_bit(1, 0, synchronised);
        })
        .boxed(),
    );
    // 101.5 = 1, 101.7 = 0, and a bit of an axis that does not exist; MB200 is plain memory.
    set(&mut machine, "DB31.DBX101.5", 1);
    set(&mut machine, "DB31.DBX101.7", 0);
    set(&mut machine, "DB40.DBX60.4", 1);
    set(&mut machine, "MB200", 0x5A);
    machine.step();
    // The scan comes before the publication and sees the written values.
    assert_eq!(get(&machine, "M1.0"), 1);
    assert_eq!((get(&machine, "DB31.DBB101"), get(&machine, "DB40.DBX60.4")), (0b1100_0000, 0));
    run(&mut machine, 5);
    assert_eq!((get(&machine, "M1.0"), get(&machine, "MB200")), (0, 0x5A));
}

fn enable(io: &mut PlcIo<'_>) {
    for axis in io.axes() {
        let signals = io.to_nck.axis(axis);
        signals.set_position_measuring_system_1(true);
        signals.set_controller_enable(true);
        signals.set_pulse_enable(true);
    }
}

#[test]
fn power_on_restarts_interface_and_plc_memory_and_keeps_slides_faults_and_machine_data() {
    let mut machine = ready();
    let x = machine.axis("X").unwrap();
    let xf = machine.axis("XF").unwrap();
    machine.queue(Command::Fault(Fault { axis: xf, kind: FaultKind::Block })).unwrap();
    machine.queue(Command::Fault(Fault { axis: xf, kind: FaultKind::Push { by: Position::from_user(0.25) } })).unwrap();
    store(&mut machine, "37130[XF]", DatumValue::Real(50.0));
    set(&mut machine, "MB10", 7);
    force(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 20);
    let (slide, other) = (machine.variables().axes[x].slide, machine.variables().axes[xf].slide);
    assert!(slide > Position::from_user(120.0));
    assert_eq!(other, Position::from_user(120.25));
    machine.queue(Command::PowerOn).unwrap();
    machine.step();
    // Memory, forces and the start-up sequence start again; the drives coast at most one cycle.
    assert_eq!((get(&machine, "MB10"), get(&machine, "X.traversing_key_plus")), (0, 0));
    assert_eq!(
        (get(&machine, "DB10.DBX108.7"), get(&machine, "DB31.DBX61.5"), get(&machine, "DB11.DBX0.2")),
        (0, 0, 0)
    );
    // The PLC program starts with OB100 and its first scan in the same step.
    assert_eq!(get(&machine, "X.controller_enable"), 1);
    // The slides stay, the fault stays, the stored datum is active.
    assert_eq!(machine.variables().axes[x].slide, slide);
    assert_eq!(machine.variables().axes[xf].slide, other);
    assert_eq!(machine.variables().axes[x].position, Position::ZERO, "an incremental encoder counts from here");
    let stored = machine.control().data().stored(37130, Owner::Axis(xf), 0).unwrap();
    assert_eq!(stored.value, DatumValue::Real(50.0));
    set(&mut machine, "DB11.DBX0.2", 1);
    set(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 60);
    assert!(machine.variables().axes[x].slide > slide);
    assert_eq!(machine.variables().axes[xf].slide, other, "still blocked");
}

/// The values that the PLC wrote are reset, even if a client also wrote to its memory. The axes keep their reference, and NC and
/// panel keep their halves.
#[test]
fn a_cold_restart_resets_plc_memory_and_program_and_a_warm_one_does_not() {
    let mut machine = example();
    let count = |count: &mut u8, io: &mut PlcIo<'_>| {
        *count += 1;
        io.flags.set_byte(0, *count);
    };
    machine.load_program(program("counts", 0_u8, count).boxed());
    run(&mut machine, 5);
    for (name, value) in [("MB1", 7), ("QB3", 9), ("DB31.DBX1.5", 1), ("DB11.DBX0.2", 1)] {
        set(&mut machine, name, value);
    }
    machine.queue(Command::PlcStop).unwrap();
    run(&mut machine, 1);
    let all = |machine: &Machine| ["MB0", "MB1", "QB3", "DB31.DBX1.5", "DB11.DBX0.2"].map(|name| get(machine, name));
    // P-150: STOP resets the outputs and the signals to the NCK, and keeps flags and the selection of a measuring system.
    assert_eq!(all(&machine), [5, 7, 0, 1, 0]);
    machine.queue(Command::PlcRun).unwrap();
    run(&mut machine, 1);
    assert_eq!(all(&machine), [6, 7, 0, 1, 0]);
    machine.queue(Command::PlcColdRestart).unwrap();
    run(&mut machine, 1);
    assert_eq!(all(&machine), [1, 0, 0, 0, 0]);
    assert!(!machine.is_plc_stopped());
    // The NCK's own bits do not belong to the PLC: JOG is still active.
    assert_eq!(get(&machine, "DB11.DBX6.2"), 1);
}

#[test]
fn r_parameters_are_written_at_the_edge_of_a_step_saved_and_kept_without_power() {
    let mut machine = example();
    let first = ChannelNumber::FIRST;
    let write = |number, value| Command::RParameter { channel: first, number, value };
    assert_eq!(machine.r_parameter(first, 99), Some(0.0));
    assert!(machine.queue(write(100, 1.0)).is_err() && machine.queue(write(1, f64::NAN)).is_err());
    machine.queue(write(99, -2.5)).unwrap();
    assert_eq!(machine.r_parameter(first, 99), Some(0.0));
    run(&mut machine, 1);
    machine.queue(Command::PowerOn).unwrap();
    run(&mut machine, 1);
    let mut other = example();
    other.restore(&machine.save()).unwrap();
    for machine in [&machine, &other, &machine.fork().unwrap()] {
        assert_eq!(machine.r_parameter(first, 99), Some(-2.5));
        assert_eq!(machine.r_parameter(first, 100), None);
    }
}

/// Positions of MD12010 in Gray code: 8 is 20 % (8 ^ 4 = 12); rapid traverse is never faster than 100 %: 23 is 120 % (23 ^ 11 = 28).
#[test]
fn an_override_counts_as_100_per_cent_unless_it_is_active() {
    let mut machine = example();
    let (x, first) = (machine.axis("X").unwrap(), ChannelNumber::FIRST);
    for (name, value) in [("DB31.DBB0", 12), ("DB21.DBB4", 28), ("DB21.DBB5", 28)] {
        set(&mut machine, name, value);
    }
    run(&mut machine, 1);
    assert_eq!((machine.axis_override(x), machine.channel_overrides(first)), (100.0, [100.0, 100.0]));
    for name in ["DB31.DBX1.7", "DB21.DBX6.7", "DB21.DBX6.6"] {
        set(&mut machine, name, 1);
    }
    run(&mut machine, 1);
    assert_eq!((machine.axis_override(x), machine.channel_overrides(first)), (20.0, [120.0, 100.0]));
    set(&mut machine, "DB21.DBB5", 12);
    run(&mut machine, 1);
    assert_eq!((machine.axis_override(x), machine.channel_overrides(first)), (20.0, [120.0, 20.0]));
}

/// O-21: at power on every override byte holds 100 %, in the coding that is active then. The zero setting acts while the override is
/// not active, too.
#[test]
fn overrides_hold_100_per_cent_at_power_on_and_their_zero_setting_always_acts() {
    let mut machine = example();
    let (x, first) = (machine.axis("X").unwrap(), ChannelNumber::FIRST);
    let bytes = |machine: &Machine| ["DB31.DBB0", "DB33.DBB0", "DB21.DBB4", "DB21.DBB5"].map(|byte| get(machine, byte));
    assert_eq!(bytes(&machine), [26; 4], "position 19, Gray code 19 ^ 9");
    for byte in ["DB31.DBB0", "DB21.DBB4", "DB21.DBB5"] {
        set(&mut machine, byte, 0);
    }
    run(&mut machine, 1);
    assert_eq!((machine.axis_override(x), machine.channel_overrides(first)), (0.0, [0.0, 0.0]));
    store(&mut machine, "12020", DatumValue::Boolean(false));
    machine.queue(Command::PowerOn).unwrap();
    run(&mut machine, 1);
    assert_eq!(bytes(&machine), [26, 26, 100, 26], "MD12020 = 0: the feed override of the channel is binary now");
}

#[test]
fn db11_dbx5_2_mirrors_ref_until_another_writer_writes_the_byte() {
    let mut machine = ready();
    set(&mut machine, "DB11.DBX1.2", 1);
    run(&mut machine, 1);
    assert_eq!((get(&machine, "DB11.DBX7.2"), get(&machine, "DB11.DBX5.2")), (1, 1));
    // An HMI strobes DBX5.0: from now on the byte belongs to the HMI. This is logged once.
    let mut logged = 0;
    for (signal, value, byte) in
        [("DB11.DBB5", 1, 1), ("DB11.DBX1.2", 0, 1), ("DB11.DBB5", 2, 2), ("DB11.DBX1.2", 1, 2)]
    {
        set(&mut machine, signal, value);
        machine.step();
        logged += machine.recorder().new_events().iter().filter(|event| machine.rule(event.rule).id == "E-01").count();
        machine.drain();
        assert_eq!(get(&machine, "DB11.DBB5"), byte, "{signal} = {value}");
    }
    assert_eq!((get(&machine, "DB11.DBX7.2"), logged), (1, 1));
}

#[test]
fn plant_toml_fixes_db11_dbx5_2_either_way() {
    for (fixed, mirrors) in [("mirror", true), ("hmi_strobe", false)] {
        let mut machine = example_with(&format!("[compatibility]\ndb11_5_2 = \"{fixed}\"\n"));
        for round in ["opened", "powered on"] {
            set(&mut machine, "DB11.DBX0.2", 1);
            set(&mut machine, "DB11.DBX1.2", 1);
            run(&mut machine, 2);
            assert_eq!(get(&machine, "DB11.DBX5.2"), u64::from(mirrors), "{fixed}, {round}");
            // Writing the byte again does not change its owner.
            set(&mut machine, "DB11.DBB5", 1);
            run(&mut machine, 2);
            assert_eq!(get(&machine, "DB11.DBX5.2"), u64::from(mirrors), "{fixed}, {round}, written");
            machine.queue(Command::PowerOn).unwrap();
            run(&mut machine, 1);
        }
    }
}

#[test]
fn a_simulated_axis_is_silent_only_where_the_archive_says_so() {
    let directory = std::env::temp_dir().join(format!("opennck-silent-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    for (line, shown) in
        [("", 1), ("N30350 $MA_SIMU_AX_VDI_OUTPUT[AX1]=0\n", 0), ("N30350 $MA_SIMU_AX_VDI_OUTPUT[AX1]=1\n", 1)]
    {
        let text = format!("CHANDATA(1)\nN30130 $MA_CTRLOUT_TYPE[AX1]=0\nN32020 $MA_JOG_VELO[AX1]=2000\n{line}M17\n");
        let file = directory.join("simulated.tea");
        std::fs::write(&file, text).unwrap();
        let mut machine = Machine::open(&file).unwrap();
        machine.load_program(enable_all().boxed());
        set(&mut machine, "DB11.DBX0.2", 1);
        set(&mut machine, "DB31.DBX4.7", 1);
        run(&mut machine, 100);
        let (active, moves) = (get(&machine, "DB31.DBX61.5"), get(&machine, "DB31.DBX64.7"));
        assert_eq!((active, moves), (shown, shown), "{line}");
        // The axis moves nevertheless.
        assert!(machine.variables().axes[AxisNumber::FIRST].position > Position::from_user(1.0), "{line}");
    }
    std::fs::remove_dir_all(&directory).unwrap();
}

#[test]
fn the_start_up_chain_comes_in_its_order() {
    let mut machine = example();
    machine.load_program(enable_all().boxed());
    // The control, then each axis (O-20); the last one waits for the drives, which need 20 ms = 10 cycles.
    let control = ["DB10.DBX104.7", "DB10.DBX108.5", "DB10.DBX108.6", "DB10.DBX108.7"];
    let axis = ["DB31.DBX93.5", "DB31.DBX93.7", "DB31.DBX61.7", "DB31.DBX61.6", "DB31.DBX61.5"];
    let mut first = [0_u64; 9];
    while machine.cycle() < 100 {
        machine.step();
        for (cycle, bit) in first.iter_mut().zip(control.into_iter().chain(axis)) {
            if *cycle == 0 && get(&machine, bit) == 1 {
                *cycle = machine.cycle();
            }
        }
    }
    assert!(first.iter().all(|&cycle| cycle > 0), "{first:?}");
    assert!(first[..4].is_sorted_by(|before, after| before < after), "{first:?}");
    assert!(first[4..].is_sorted_by(|before, after| before < after), "{first:?}");
    assert!(first[4] >= 10 && first[2] >= first[4] && first[5] >= first[3], "{first:?}");
}

/// DYN-01
#[test]
fn leading_and_synchronous_axis_move_by_the_same_increments_in_every_cycle() {
    let mut machine = ready();
    // Starting, cruising at an odd velocity, turning round in full motion, rapid traverse, braking.
    let keys = [(0, "X.traversing_key_plus", 1), (90, "X.override_active", 1), (170, "X.traversing_key_plus", 0)];
    let more =
        [(170, "X.traversing_key_minus", 1), (200, "X.rapid_traverse_override", 1), (500, "X.traversing_key_minus", 0)];
    set(&mut machine, "X.feed_override", 9);
    let (mut moved, mut before) = (0, (setpoint(&machine, "X"), setpoint(&machine, "XF")));
    for cycle in 0..800 {
        for &(_, key, value) in keys.iter().chain(&more).filter(|(when, _, _)| *when == cycle) {
            set(&mut machine, key, value);
        }
        run(&mut machine, 1);
        let after = (setpoint(&machine, "X"), setpoint(&machine, "XF"));
        assert_eq!(after.0 - before.0, after.1 - before.1, "cycle {cycle}");
        moved += u32::from(after.0 != before.0);
        before = after;
    }
    assert!(moved > 400, "{moved}");
    assert_eq!(setpoint(&machine, "X"), before.0);
}

/// DYN-01, in sections 1 and 2: the following axis moves by the same increments in the same cycle, whichever axis leads.
#[test]
fn while_referencing_both_axes_move_by_the_same_increments_whichever_leads() {
    let mut machine = ready();
    set(&mut machine, "DB11.DBX1.2", 1);
    set(&mut machine, "X.traversing_key_plus", 1);
    let difference = |machine: &Machine| setpoint(machine, "XF") - setpoint(machine, "X");
    let (mut before, mut jumps) = (difference(&machine), Vec::new());
    while get(&machine, "DB31.DBX101.4") == 0 {
        assert!(machine.cycle() < 10_000);
        run(&mut machine, 1);
        let after = difference(&machine);
        if after != before {
            jumps.push((get(&machine, "DB31.DBX60.4"), get(&machine, "DB33.DBX60.4")));
        }
        before = after;
    }
    // Only the two reference points change the actual values at the present positions.
    assert_eq!(jumps, [(1, 0), (1, 1)]);
}

/// SIG-01
#[test]
fn a_lost_enable_stops_all_axes_in_the_same_manner_whichever_axis_loses_it() {
    let mut machine = ready();
    // Other servo disable delays and emergency ramps: the unit still stops in one way.
    store(&mut machine, "36620[XF]", DatumValue::Real(0.02));
    store(&mut machine, "36610[XF]", DatumValue::Real(0.2));
    machine.queue(Command::PowerOn).unwrap();
    set(&mut machine, "DB11.DBX0.2", 1);
    set(&mut machine, "X.rapid_traverse_override", 1);
    set(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 250);
    let mut other = machine.fork().unwrap();
    force(&mut machine, "X.controller_enable", 0);
    force(&mut other, "XF.controller_enable", 0);
    let start = (setpoint(&machine, "X"), setpoint(&machine, "XF"));
    for cycle in 0..300 {
        for machine in [&mut machine, &mut other] {
            run(machine, 1);
            let states =
                |axis: &str| ["61.3", "61.5", "61.6", "61.7"].map(|bit| get(machine, &format!("DB{axis}.DBX{bit}")));
            assert_eq!(states("31"), states("33"), "cycle {cycle}");
            assert!(machine.variables().alarms.find(crate::variables::AlarmNumber(21612), None).is_some());
        }
        assert_eq!(setpoint(&machine, "X"), setpoint(&other, "X"), "cycle {cycle}");
        assert_eq!(setpoint(&machine, "XF"), setpoint(&other, "XF"), "cycle {cycle}");
        if get(&machine, "DB31.DBX61.5") == 1 {
            assert_eq!(setpoint(&machine, "X") - start.0, setpoint(&machine, "XF") - start.1, "cycle {cycle}");
        }
    }
    assert_eq!(get(&machine, "DB31.DBX61.5"), 0);
    assert_eq!(machine.variables().axes[AxisNumber::FIRST].velocity.abs().to_bits(), 0.0_f64.to_bits());
}

/// Permitted but unsuitable machine data: the loop is unstable, and the axis runs away.
#[test]
fn an_axis_that_runs_away_stays_within_numbers_that_can_be_reckoned_with() {
    let mut machine = example();
    for (target, value) in [("32200[0,X]", 1e9), ("32000[X]", 1e9), ("32300[0,X]", 1e9), ("32020[X]", 1e9)] {
        store(&mut machine, target, DatumValue::Real(value));
    }
    machine.queue(Command::PowerOn).unwrap();
    machine.load_program(enable_all().boxed());
    set(&mut machine, "DB11.DBX0.2", 1);
    run(&mut machine, 50);
    set(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 500);
    // Without position control in follow-up, the setpoint equals the actual value.
    force(&mut machine, "X.follow_up_mode", 1);
    force(&mut machine, "X.controller_enable", 0);
    run(&mut machine, 500);
    let farthest = Position::from_user(5e9);
    let values = machine.variables().axes[AxisNumber::FIRST];
    assert!(values.slide.abs() < farthest && values.position.abs() < farthest, "{values:?}");
}

/// MD36060 = 0 is permitted: an axis without any motion is stationary.
#[test]
fn without_a_standstill_tolerance_an_axis_at_rest_is_stationary_and_is_referenced() {
    let mut machine = example();
    for axis in ["X", "XF"] {
        store(&mut machine, &format!("36060[{axis}]"), DatumValue::Real(0.0));
    }
    machine.queue(Command::PowerOn).unwrap();
    machine.load_program(enable_all().boxed());
    set(&mut machine, "DB11.DBX0.2", 1);
    set(&mut machine, "DB11.DBX1.2", 1);
    run(&mut machine, 50);
    assert_eq!((get(&machine, "DB31.DBX61.4"), get(&machine, "DB21.DBX36.3")), (1, 1));
    set(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 6_000);
    assert_eq!((get(&machine, "DB31.DBX60.4"), get(&machine, "DB33.DBX60.4")), (1, 1));
}

/// O-12: a measuring system that is not referenced gives no information about a difference that did not exist before.
#[test]
fn a_switch_to_an_unreferenced_measuring_system_makes_no_synchronism_difference() {
    let mut machine = example();
    for (target, value) in [("30200[XF]", 2), ("34200[1,XF]", 1)] {
        store(&mut machine, target, DatumValue::Integer(value));
    }
    machine.queue(Command::PowerOn).unwrap();
    machine.load_program(enable_all().boxed());
    set(&mut machine, "DB11.DBX0.2", 1);
    set(&mut machine, "DB11.DBX1.2", 1);
    run(&mut machine, 50);
    set(&mut machine, "X.traversing_key_plus", 1);
    run(&mut machine, 6_000);
    assert_eq!(get(&machine, "DB31.DBX101.4"), 1);
    let difference = |machine: &Machine| machine.variables().axes[machine.axis("XF").unwrap()].synchronism_difference;
    let before = difference(&machine);
    force(&mut machine, "XF.position_measuring_system_1", 0);
    force(&mut machine, "XF.position_measuring_system_2", 1);
    run(&mut machine, 2);
    assert_eq!(get(&machine, "DB33.DBX102.6"), 1);
    assert!((difference(&machine) - before).abs() < Position::from_user(0.001), "{before}, {}", difference(&machine));
    assert!(machine.variables().alarms.find(crate::variables::AlarmNumber(10653), None).is_none());
    // The first system is still referenced: with it the difference is absolute again.
    force(&mut machine, "XF.position_measuring_system_1", 1);
    force(&mut machine, "XF.position_measuring_system_2", 0);
    run(&mut machine, 2);
    assert!((difference(&machine) - before).abs() < Position::from_user(0.001), "{before}, {}", difference(&machine));
}

#[test]
fn what_the_files_ask_for_and_nobody_does_is_said() {
    let machine = example_with("[XF.encoder1]\nkind = \"absolute\"\n");
    let [finding] = machine.findings() else { panic!("{:?}", machine.findings()) };
    let expected = "g1_example.tea:82: implausible: MD30240 $MA_ENC_TYPE[0,AX3] = 1, axis XF: the encoder of `plant.toml` is absolute, and \
        the control uses it as an incremental one\n  set MD30240 = 4 and MD34200 = 0";
    assert_eq!(finding.to_string(), expected);
    assert!(machine.warnings()[0].contains("1 implausible"), "{:?}", machine.warnings());
    assert!(example().warnings().is_empty(), "{:?}", example().warnings());
}

#[test]
fn there_are_three_handwheels() {
    let mut machine = example();
    for (number, there) in [(0, false), (1, true), (3, true), (4, false)] {
        let turned = machine.queue(Command::Handwheel { number, pulses: 1, cycles: 1 });
        assert_eq!(turned.is_ok(), there, "{number}");
    }
}

#[cfg(feature = "live")]
#[test]
fn a_snapshot_stays_while_the_machine_goes_on() {
    let mut machine = Machine::open("g1_example").expect("it is built in");
    let flag = at(&machine, "MB100");
    machine.step();
    let snapshot = machine.snapshot();
    machine.queue(Command::Write { location: flag, value: 7 }).expect("it is a place");
    machine.step();
    assert_eq!((machine.cycle(), machine.memory().read(flag)), (2, 7));
    assert_eq!((snapshot.cycle(), snapshot.memory().read(flag)), (1, 0));
    assert_eq!(snapshot.names(), machine.names());
}

#[test]
fn a_state_is_refused_on_a_machine_of_other_files_and_the_problem_names_what_differs() {
    let preset = |text: &str| Some(Preset::parse(text, "image.toml").unwrap());
    let with = |options| Machine::open_with("g1_example", options).unwrap();
    let of_828d = OpenOptions { profile: Profile::SINUMERIK_828D, ..OpenOptions::default() };
    let flags = OpenOptions { preset: preset("[areas]\nM = 512\n"), ..OpenOptions::default() };
    let value = OpenOptions { preset: preset("[interface]\n\"X.feed_override\" = 1\n"), ..OpenOptions::default() };
    let machines = [
        ("profile `828d`", with(of_828d)),
        ("512 bytes of Flags", with(flags)),
        ("the same PLC image", with(value)),
        ("the same plant", example_with("[X]\nstart = 300.0\n")),
        ("the same plant", example_with("[machine]\nplc_cycle = \"10ms\"\n")),
        ("the same machine data and settings", example_with("[compatibility]\ndb11_5_2 = \"mirror\"\n")),
    ];
    let mut origin = ready();
    origin.program = None;
    let saved = origin.save();
    for (what, mut other) in machines {
        run(&mut other, 3);
        let before = other.save();
        let problem = other.restore(&saved).unwrap_err().to_string();
        assert!(problem.contains(&format!("with {what}")), "{what}: {problem}");
        assert!(other.save() == before, "{what}: a rejected state must not change the machine");
        other.queue(Command::PlcColdRestart).unwrap();
        run(&mut other, 1);
        assert!(example().restore(&before).is_err(), "{what}");
    }
}

#[test]
fn a_state_is_refused_on_a_machine_of_another_archive_but_not_after_a_change_at_run_time() {
    let directory = std::env::temp_dir().join(format!("opennck-archive-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let file = directory.join("axis.tea");
    let open = |velocity| {
        std::fs::write(&file, format!("CHANDATA(1)\nN32020 $MA_JOG_VELO[AX1]={velocity}\nM17\n")).unwrap();
        Machine::open(&file).unwrap()
    };
    let (mut origin, mut other) = (open(2000), open(1000));
    store(&mut origin, "32020[AX1]", DatumValue::Real(3000.0));
    run(&mut origin, 3);
    let saved = origin.save();
    let problem = other.restore(&saved).unwrap_err().to_string();
    assert!(problem.contains("the same machine data and settings"), "{problem}");
    let mut same = open(2000);
    same.restore(&saved).unwrap();
    assert!(same.save() == saved);
    std::fs::remove_dir_all(&directory).unwrap();
}

/// 0.0 and -0.0 are equal numbers with different bytes.
#[test]
fn a_machine_datum_of_minus_zero_is_saved_alike_after_it_was_restored() {
    let mut machine = example();
    store(&mut machine, "34090[X]", DatumValue::Real(-0.0));
    run(&mut machine, 2);
    let saved = machine.save();
    let mut other = example();
    other.restore(&saved).unwrap();
    assert!(other.save() == saved);
}

#[test]
fn a_saved_control_with_more_bytes_after_it_is_refused() {
    let machine = example();
    let mut control = machine.control().clone_box();
    let mut saved = control.save();
    assert!(control.restore(&saved).is_ok());
    saved.push(0);
    let problem = control.restore(&saved).unwrap_err();
    assert!(problem.to_string().contains("1 more than expected"), "{problem}");
}

#[test]
fn a_location_that_no_memory_contains_is_refused() {
    let mut machine = example();
    for (part, offset, bit, width) in [
        (Part::ToNck, u32::MAX, 0, 8),
        (Part::ToNck, u32::MAX - 1, 0, 32),
        (Part::Flags, 0, 0, 0),
        (Part::Flags, 0, 0, 64),
        (Part::Flags, 0, 0, 255),
        (Part::Flags, 0, 63, 1),
        (Part::Flags, 255, 7, 5),
        (Part::Flags, 0, 7, 33),
        (Part::Flags, 255, 0, 16),
        (Part::Flags, 256, 0, 8),
        (Part::Timers, 1, 0, 16),
        (Part::Block(0), 0, 0, 8),
    ] {
        let location = Location { part, offset, bit, width, format: Format::Unsigned };
        for command in [
            Command::Write { location, value: u64::MAX },
            Command::Force { location, value: u64::MAX },
            Command::Release { location },
        ] {
            let problem = machine.queue(command).unwrap_err();
            assert!(problem.what.starts_with("expected a location"), "{problem}");
        }
    }
    assert!(machine.queued().is_empty());
}

/// A scenario cannot say it either, so a recording of it could not run.
#[test]
fn a_location_that_the_nck_writes_can_be_written_and_not_forced() {
    let mut machine = example();
    let location = at(&machine, "DB31.DBB60");
    machine.queue(Command::Write { location, value: 1 }).unwrap();
    for command in [Command::Force { location, value: 1 }, Command::Release { location }] {
        let problem = machine.queue(command).unwrap_err().to_string();
        assert!(problem.contains("found DB31.DBB60, which the NCK writes"), "{problem}");
    }
}

#[test]
fn a_fault_that_the_plant_cannot_have_is_refused() {
    let mut machine = example();
    let (x, none) = (machine.axis("X").unwrap(), AxisNumber::new(31).unwrap());
    let far = Position::new(i64::MAX);
    for (kind, what) in [
        (FaultKind::EncoderFault { encoder: Some(2) }, "encoder 1 or 2, found 3"),
        (FaultKind::EncoderFault { encoder: Some(255) }, "encoder 1 or 2, found 256"),
        (FaultKind::Friction { by: f64::NAN }, "a share of the velocity, 0 to 1, found NaN"),
        (FaultKind::Friction { by: -0.5 }, "0 to 1, found -0.5"),
        (FaultKind::Friction { by: 1e300 }, "0 to 1"),
        (FaultKind::Drift { by: f64::INFINITY }, "a velocity in mm or degrees per second"),
        (FaultKind::Drift { by: f64::NAN }, "a velocity in mm or degrees per second"),
        (FaultKind::Drift { by: 1.001e12 }, "found 1001000"),
        (FaultKind::Push { by: far }, "a distance in mm or degrees"),
        (FaultKind::EncoderSlip { by: far }, "a distance in mm or degrees"),
    ] {
        for command in [Command::Fault(Fault { axis: x, kind }), Command::ClearFault(Fault { axis: x, kind })] {
            let problem = machine.queue(command).unwrap_err().to_string();
            assert!(problem.contains(what), "{what}: {problem}");
        }
    }
    let problem = machine.queue(Command::Fault(Fault { axis: none, kind: FaultKind::Block })).unwrap_err();
    assert!(problem.what.contains("axis 31, which does not exist") && problem.cure.contains("XF"), "{problem}");
    for kind in [
        FaultKind::EncoderFault { encoder: Some(1) },
        FaultKind::Friction { by: 1.0 },
        FaultKind::Drift { by: -1e12 },
        FaultKind::Push { by: Position::from_user(-1e6) },
    ] {
        machine.queue(Command::Fault(Fault { axis: x, kind })).unwrap();
    }
}

/// One mm/s without power: the slide and the time agree in each cycle, also in that of power on.
#[test]
fn a_cycle_takes_as_long_as_the_mechanics_move_in_it_also_at_power_on() {
    let mut machine = example();
    let x = machine.axis("X").unwrap();
    let drift = FaultKind::Drift { by: Position::PER_USER_UNIT };
    machine.queue(Command::Fault(Fault { axis: x, kind: drift })).unwrap();
    run(&mut machine, 50);
    let (time, slide) = (machine.time(), machine.variables().axes[x].slide);
    store(&mut machine, "10070", DatumValue::Integer(30));
    machine.queue(Command::PowerOn).unwrap();
    for cycle in 1..=3 {
        run(&mut machine, 1);
        let passed = machine.time() - time;
        assert_eq!(passed, Time::from_millis(60 * cycle));
        assert_eq!(machine.variables().axes[x].slide - slide, Position::from_user(passed.seconds()));
    }
}

/// O-28: with 6 and 4 ms, a bit of the PLC reaches the control three cycles later. Bytes on their way are part of the state.
#[test]
fn what_is_on_its_way_between_plc_and_nck_is_saved_restored_and_forked() {
    let delayed = || {
        let mut machine = example_with("[machine]\nto_nck_delay = \"6ms\"\nfrom_nck_delay = \"4ms\"\n");
        machine.load_program(enable_all().boxed());
        machine
    };
    let mut machine = delayed();
    run(&mut machine, 60);
    set(&mut machine, "DB11.DBX0.1", 1);
    run(&mut machine, 2);
    let (saved, mut fork, mut restored) = (machine.save(), machine.fork().unwrap(), delayed());
    restored.restore(&saved).unwrap();
    for machine in [&mut machine, &mut fork, &mut restored] {
        run(machine, 1);
        assert_eq!(get(machine, "DB11.DBX6.1"), 0);
        run(machine, 1);
        assert_eq!(get(machine, "DB11.DBX6.1"), 1);
        run(machine, 20);
    }
    assert!(machine.save() == fork.save() && machine.save() == restored.save());
    let refused = example().restore(&saved);
    assert!(refused.is_err(), "a machine without delays, and without a program");
    let mut other = example();
    other.load_program(enable_all().boxed());
    assert!(other.restore(&saved).unwrap_err().to_string().contains("the same plant"));
}

/// O-28: no cycle is skipped for an axis at rest when a byte arrives late.
#[test]
fn axes_at_rest_wake_up_when_a_late_byte_arrives() {
    let machines = [0, 1, 2].map(|kind| {
        let mut machine = example_with("[machine]\nto_nck_delay = \"10ms\"\n");
        machine.load_program(enable_all().boxed());
        match kind {
            0 => {}
            1 => machine.never_rest(),
            _ => machine.decide_always(),
        }
        run(&mut machine, 200);
        set(&mut machine, "DB32.DBX4.7", 1);
        run(&mut machine, 100);
        set(&mut machine, "DB32.DBX4.7", 0);
        run(&mut machine, 200);
        machine.save()
    });
    assert!(machines[0] == machines[1] && machines[0] == machines[2]);
}

#[test]
fn a_delay_is_whole_cycles() {
    for delay in ["3ms", "1h"] {
        let plant_over = Some(Table::parse(&format!("[machine]\nfrom_nck_delay = \"{delay}\"\n"), "test").unwrap());
        let options = OpenOptions { plant_over, ..OpenOptions::default() };
        let error = Machine::open_with("g1_example", options).unwrap_err().to_string();
        assert!(error.contains("expected from_nck_delay to be whole NC cycles of 0.002 s"), "{error}");
    }
}
