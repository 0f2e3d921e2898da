//! Measures the time of a step: a machine of 31 axes with one jogging gantry, compared with the same arithmetic written by hand, and the
//! worked example from opening to its last row. `benches/README.md` describes how to run it and its results.

use std::fs;
use std::path::{Path, PathBuf};

use divan::Bencher;
use divan::counter::ItemsCount;
use opennck::image::Profile;
use opennck::machine::Machine;
use opennck::plc::{ClosureProgram, Programs, program};
use opennck::scenario::{Prepared, Scenario};
use opennck::units::{AxisNumber, Time};

/// The number of steps of one sample: two seconds of the machine, one movement in each direction.
const STEPS: u64 = 1_000;
const CYCLE: f64 = 0.002;

fn main() {
    divan::main();
}

/// The machine with its PLC program and record; the record is drained.
#[divan::bench]
fn step(bencher: Bencher<'_, '_>) {
    let mut machine = jogging_machine();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut rows = 0;
        for _ in 0..STEPS {
            machine.step();
            rows += machine.recorder().rows().len();
            machine.drain();
        }
        rows
    });
}

/// The same, and every axis is moved, monitored and shown in every cycle, as `loop_by_hand` does: what a step costs where all
/// are awake.
#[divan::bench]
fn step_that_never_rests(bencher: Bencher<'_, '_>) {
    let mut machine = jogging_machine();
    machine.never_rest();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            machine.step();
            machine.drain();
        }
        machine.cycle()
    });
}

/// The same, and everything is decided for every axis in every cycle, too.
#[divan::bench]
fn step_that_always_decides(bencher: Bencher<'_, '_>) {
    let mut machine = jogging_machine();
    machine.decide_always();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            machine.step();
            machine.drain();
        }
        machine.cycle()
    });
}

/// 31 axes of which each jogs forth and back, eight of them as the four groupings that they form.
#[divan::bench]
fn all_axes_move(bencher: Bencher<'_, '_>) {
    let jogging = program("all", (), |(), io| {
        let seconds = io.time.nanos() / Time::from_millis(1_000).nanos();
        for axis in io.axes() {
            let signals = io.to_nck.axis(axis);
            signals.set_position_measuring_system_1(true);
            signals.set_controller_enable(true);
            signals.set_pulse_enable(true);
            signals.set_traversing_key_plus(seconds % 2 == 0);
            signals.set_traversing_key_minus(seconds % 2 == 1);
        }
    });
    let mut machine = Machine::open(directory_of_31_axes("four_groupings", 4)).expect("the archive is a good one");
    machine.load_program(jogging.boxed());
    for _ in 0..STEPS {
        machine.step();
        machine.drain();
    }
    let axes = &machine.memory().from_nck().axes;
    let moving = machine.names().axes.iter().filter(|(axis, name)| {
        let signals = &axes[*axis];
        name.is_some() && (signals.traverse_command_plus() || signals.traverse_command_minus())
    });
    assert_eq!(moving.count(), 31);
    assert_eq!(machine.variables().alarms.count(), 0, "{:?}", machine.variables().alarms);
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            machine.step();
            machine.drain();
        }
        machine.cycle()
    });
}

/// The same as `step`, and nobody drains the record: it is full from the start, and rows are only counted.
#[divan::bench]
fn step_with_a_full_record(bencher: Bencher<'_, '_>) {
    let mut machine = jogging_machine();
    while machine.recorder().lost() == 0 {
        machine.step();
    }
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        for _ in 0..STEPS {
            machine.step();
        }
        machine.cycle()
    });
}

/// For comparison: setpoint, coupling, position control, drive and encoder of 31 axes without an interface.
#[divan::bench]
fn arithmetic_by_hand(bencher: Bencher<'_, '_>) {
    let mut axes = [ByHand::default(); 31];
    let mut cycle = 0_u64;
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut marks = 0;
        for _ in 0..STEPS {
            cycle += 1;
            let to = if (cycle / 500).is_multiple_of(2) { 2_000.0 } else { -2_000.0 };
            let wanted = divan::black_box(to * 1e6 / 60.0);
            let before = axes[0].setpoint;
            axes[0].lead(wanted);
            let (movement, velocity) = (axes[0].setpoint - before, axes[0].velocity);
            axes[1].setpoint += movement;
            axes[1].velocity = velocity;
            for axis in &mut axes[2..] {
                axis.lead(divan::black_box(0.0));
            }
            for axis in &mut axes {
                marks += axis.control();
            }
        }
        marks
    });
}

/// For comparison: the same arithmetic with an interface, written for this one machine only. In every cycle, a program writes bits, all 31
/// axes are moved and monitored, and their signals, values and changes of the interface are published.
#[divan::bench]
fn loop_by_hand(bencher: Bencher<'_, '_>) {
    let mut machine = MachineByHand::new();
    bencher.counter(ItemsCount::new(STEPS)).bench_local(|| {
        let mut rows = 0;
        for _ in 0..STEPS {
            machine.step();
            rows += machine.rows.len();
            machine.rows.clear();
        }
        rows
    });
}

/// A fork of the machine during a run.
#[divan::bench]
fn fork(bencher: Bencher<'_, '_>) {
    let machine = jogging_machine();
    bencher.bench_local(|| machine.fork());
}

/// The machine of `step`, from its archive.
#[divan::bench]
fn open_machine(bencher: Bencher<'_, '_>) {
    let directory = directory_of_31_axes("thirty_one_axes", 1);
    bencher.bench_local(|| Machine::open(&directory).expect("the archive is a good one"));
}

/// The part of the worked example that references and synchronises.
fn referencing_and_synchronising() -> Scenario {
    let text = include_str!("../golden/worked_example/gantry_references_and_synchronises.toml");
    let mut scenario = Scenario::parse(text, Path::new("example.toml")).expect("it is a good one");
    "g1_example".clone_into(&mut scenario.machine.text);
    scenario
}

/// The trace of the worked example as text.
#[divan::bench]
fn trace_to_text(bencher: Bencher<'_, '_>) {
    let scenario = referencing_and_synchronising();
    let profile = scenario.profiles.first().copied().unwrap_or_default();
    let finished = scenario.prepare(profile, &Programs::ready()).expect("the program holds a good one").run();
    bencher.bench_local(|| finished.text().len());
}

/// The worked example, from its text to the last row of its trace.
#[divan::bench]
fn worked_example(bencher: Bencher<'_, '_>) {
    let programs = Programs::ready();
    bencher.bench_local(|| {
        let scenario = referencing_and_synchronising();
        let profile = scenario.profiles.first().copied().unwrap_or_default();
        let prepared = scenario.prepare(profile, &programs).expect("the built-in scenario is valid");
        prepared.run().text().len()
    });
}

/// A scenario with one step that lets time pass on the machine of `step`, with ten conditions that must hold in every cycle.
#[divan::bench]
fn scenario_with_ten_conditions(bencher: Bencher<'_, '_>) {
    run_scenario(bencher, &format!("never = {TEN_CONDITIONS:?}"));
}

/// For comparison: the same scenario without conditions.
#[divan::bench]
fn scenario_without_conditions(bencher: Bencher<'_, '_>) {
    run_scenario(bencher, "");
}

/// The same scenario with ten rules: each of the conditions must be followed by something within a time.
#[divan::bench]
fn scenario_with_ten_rules(bencher: Bencher<'_, '_>) {
    let rule = |when: &&str| format!("[[rule]]\nwhen = {when:?}\nthen = \"time > 0\"\nwithin = \"100ms\"\n");
    run_scenario(bencher, &TEN_CONDITIONS.iter().map(rule).collect::<String>());
}

/// Signals, values, alarms and time, and edges of them. AX1, AX2 and AX3 have the names X1, Y1 and Z1.
const TEN_CONDITIONS: [&str; 10] = [
    "alarms() > 0",
    "alarm(10653, Y1) || alarm(10652)",
    "Y1.gantry_warning_limit_exceeded",
    "X1.traverse_command_plus && X1.traverse_command_minus",
    "abs(Y1.synchronism_difference) > 0.5",
    "X1.velocity > 2010",
    "time > 1.5 && !X1.position_controller_active",
    "rose(Z1.traverse_command_plus)",
    "fell(X1.position_controller_active && !alarm(10653))",
    "rose(Z1.position > 1)",
];

fn run_scenario(bencher: Bencher<'_, '_>, rules: &str) {
    let machine = directory_of_31_axes("thirty_one_axes", 1);
    let text = format!("machine = {machine:?}\nplc = \"jogging\"\n{rules}\n[[step]]\nrun = \"{STEPS}cycles\"\n");
    let scenario = Scenario::parse(&text, Path::new("bench.toml")).expect("the scenario is valid");
    let programs = Programs::ready().with("jogging", |_| Ok(jogging_program().boxed()));
    let prepare = || scenario.prepare(Profile::default(), &programs).expect("the scenario is valid");
    if let Some(failure) = prepare().run().failure {
        panic!("{failure}");
    }
    bencher.counter(ItemsCount::new(STEPS)).with_inputs(prepare).bench_local_values(Prepared::run);
}

/// 31 axes; AX1 leads AX2. A program enables all axes and jogs the gantry forth and back every second.
fn jogging_machine() -> Machine {
    let mut machine = Machine::open(directory_of_31_axes("thirty_one_axes", 1)).expect("the archive is a good one");
    machine.load_program(jogging_program().boxed());
    for _ in 0..STEPS {
        machine.step();
        machine.drain();
    }
    let moving = &machine.memory().from_nck().axes[AxisNumber::FIRST];
    assert!(moving.traverse_command_plus() || moving.traverse_command_minus(), "AX1 does not move");
    assert_eq!(machine.names().axes.iter().filter(|(_, name)| name.is_some()).count(), 31);
    assert_eq!(machine.variables().alarms.count(), 0, "{:?}", machine.variables().alarms);
    machine
}

fn directory_of_31_axes(name: &str, groupings: u8) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::create_dir_all(&directory).expect("the target directory is ours");
    let mut archive = String::from("CHANDATA(1)\nN10050 $MN_SYSCLOCK_CYCLE_TIME=0.002\n");
    for axis in 1..=31 {
        archive += &format!("N30130 $MA_CTRLOUT_TYPE[AX{axis}]=1\nN30200 $MA_NUM_ENCS[AX{axis}]=1\n");
        archive += &format!("N30240 $MA_ENC_TYPE[0,AX{axis}]=1\nN32020 $MA_JOG_VELO[AX{axis}]=2000\n");
    }
    for grouping in 1..=groupings {
        let (leader, follower) = (2 * grouping - 1, 2 * grouping);
        archive += &format!("N37100 $MA_GANTRY_AXIS_TYPE[AX{leader}]={grouping}\n");
        archive += &format!("N37100 $MA_GANTRY_AXIS_TYPE[AX{follower}]={}\n", 10 + grouping);
        archive += &format!("N37120 $MA_GANTRY_POS_TOL_ERROR[AX{follower}]=1\n");
        archive += &format!("N37130 $MA_GANTRY_POS_TOL_REF[AX{follower}]=1\n");
    }
    archive += "M17\n";
    fs::write(directory.join("machine_data.tea"), archive).expect("the target directory is ours");
    directory
}

fn jogging_program() -> ClosureProgram<()> {
    program("jogging", (), |(), io| {
        for axis in io.axes() {
            let signals = io.to_nck.axis(axis);
            signals.set_position_measuring_system_1(true);
            signals.set_controller_enable(true);
            signals.set_pulse_enable(true);
        }
        let seconds = io.time.nanos() / Time::from_millis(1_000).nanos();
        let leader = io.to_nck.axis(AxisNumber::FIRST);
        leader.set_traversing_key_plus(seconds % 2 == 0);
        leader.set_traversing_key_minus(seconds % 2 == 1);
    })
}

/// One axis, written by hand for the movement only; nanometres and seconds.
#[derive(Clone, Copy, Default)]
struct ByHand {
    setpoint: i64,
    setpoint_carry: f64,
    velocity: f64,
    motor: f64,
    slide: i64,
    slide_carry: f64,
}

impl ByHand {
    fn lead(&mut self, wanted: f64) {
        let step = 1e9 * CYCLE;
        self.velocity += (wanted - self.velocity).clamp(-step, step);
        advance(&mut self.setpoint, &mut self.setpoint_carry, self.velocity * CYCLE);
    }

    /// Position control, drive, slide and encoder. Returns the number of zero marks that were passed.
    fn control(&mut self) -> u32 {
        let (count, spacing) = (divan::black_box(1_000_i64), divan::black_box(10_000_000_i64));
        let actual = (self.slide + count / 2).div_euclid(count) * count;
        let deviation = self.setpoint - actual;
        let command = if deviation.abs() <= count / 2 { 0.0 } else { deviation as f64 * 1_000.0 / 60.0 };
        self.motor += CYCLE / (0.003 + CYCLE) * (command - self.motor);
        if self.motor.abs() < 1e-4 {
            self.motor = 0.0;
        }
        let before = self.slide;
        advance(&mut self.slide, &mut self.slide_carry, self.motor * CYCLE);
        u32::from(before != self.slide && before.div_euclid(spacing) != self.slide.div_euclid(spacing))
    }
}

/// A byte of the interface, before and after.
struct RowByHand {
    cycle: u64,
    offset: usize,
    old: u8,
    new: u8,
}

/// Bytes of the data block of an axis, and of all interface blocks: DB31 to DB61, DB21 to DB30, DB10 and DB11.
const BLOCK: usize = 148;
const BLOCKS: usize = 31 * BLOCK + 10 * 416 + 272 + 64;

/// The values of an axis in the service display.
#[derive(Clone, Copy, Default)]
#[expect(dead_code, reason = "the values are published but not read")]
struct ValuesByHand {
    position: i64,
    setpoint: i64,
    velocity: f64,
    following_error: i64,
}

struct MachineByHand {
    cycle: u64,
    axes: [ByHand; 31],
    models: [(i64, f64); 31],
    rest: [u32; 31],
    values: [ValuesByHand; 31],
    interface: Box<[u8; BLOCKS]>,
    before: Box<[u8; BLOCKS]>,
    rows: Vec<RowByHand>,
}

impl MachineByHand {
    fn new() -> Self {
        Self {
            cycle: 0,
            axes: [ByHand::default(); 31],
            models: [(0, 0.0); 31],
            rest: [0; 31],
            values: [ValuesByHand::default(); 31],
            interface: Box::new([0; BLOCKS]),
            before: Box::new([0; BLOCKS]),
            rows: Vec::with_capacity(2_048),
        }
    }

    fn step(&mut self) {
        self.cycle += 1;
        self.plc();
        self.decide();
        for number in 0..31 {
            self.axes[number].control();
            let alarm = self.monitor(number);
            self.publish(number, alarm);
        }
        self.record();
    }

    /// Enables all axes and jogs the first axis forth and back.
    fn plc(&mut self) {
        for axis in self.interface[..31 * BLOCK].chunks_exact_mut(BLOCK) {
            axis[1] |= 1 << 5;
            axis[2] |= 1 << 1;
            axis[21] |= 1 << 7;
        }
        let plus = (self.cycle / 500).is_multiple_of(2);
        self.interface[4] = if plus { 1 << 7 } else { 1 << 6 };
    }

    /// Enables, keys and setpoints; the second axis follows the first one.
    fn decide(&mut self) {
        let before = self.axes[0].setpoint;
        for (axis, bits) in self.axes.iter_mut().zip(self.interface.chunks_exact(BLOCK)) {
            let enabled = bits[1] & 1 << 5 != 0 && bits[2] & 1 << 1 != 0 && bits[21] & 1 << 7 != 0;
            let key = match bits[4] & 0xC0 {
                0x80 if enabled => 1.0,
                0x40 if enabled => -1.0,
                _ => 0.0,
            };
            axis.lead(key * 2_000.0 * 1e6 / 60.0);
        }
        let (movement, velocity) = (self.axes[0].setpoint - before, self.axes[0].velocity);
        self.axes[1].setpoint += movement;
        self.axes[1].velocity = velocity;
    }

    /// Standstill, contour, velocity and speed setpoint.
    fn monitor(&mut self, number: usize) -> bool {
        let (axis, (model, carry)) = (&self.axes[number], &mut self.models[number]);
        let wanted = (axis.setpoint - *model) as f64 * 1_000.0 / 60.0;
        advance(model, carry, wanted * CYCLE);
        let resting = axis.velocity.abs() < 1e-9;
        self.rest[number] = if resting { (self.rest[number] + 1).min(200) } else { 0 };
        let deviation = (axis.setpoint - axis.slide).abs();
        self.rest[number] == 200 && deviation > 200_000
            || (*model - axis.slide).abs() > 1_000_000
            || axis.motor.abs() > 11_500.0 * 1e6 / 60.0
            || wanted.abs() > 33_000.0 * 1e6 / 60.0
    }

    fn publish(&mut self, number: usize, alarm: bool) {
        let axis = &self.axes[number];
        let deviation = axis.setpoint - axis.slide;
        let resting = axis.velocity.abs() < 1e-9;
        let bits = &mut self.interface[number * BLOCK + 60..][..BLOCK - 60];
        let on = |bit: u8, value: bool| u8::from(value) << bit;
        bits[0] = on(6, resting && deviation.abs() <= 40_000) | on(7, resting && deviation.abs() <= 10_000);
        bits[1] = on(1, alarm) | on(2, !alarm) | on(4, axis.motor.abs() < 83_333.0) | 0xE0;
        bits[4] = on(6, axis.velocity < 0.0) | on(7, axis.velocity > 0.0);
        bits[33] = on(5, true) | on(7, true);
        bits[41] = on(6, number == 0) | on(7, number < 2) | on(2, number == 1 && deviation.abs() > 1_000_000);
        self.values[number] = divan::black_box(ValuesByHand {
            position: axis.slide,
            setpoint: axis.setpoint,
            velocity: axis.motor * 60.0 / 1e6,
            following_error: deviation,
        });
    }

    /// Records the changes.
    fn record(&mut self) {
        if self.interface == self.before {
            return;
        }
        let (now, before) = (self.interface.chunks(64), self.before.chunks_mut(64));
        for (piece, (now, before)) in now.zip(before).enumerate() {
            if now == before {
                continue;
            }
            for (place, (new, old)) in now.iter().zip(before).enumerate() {
                if new != old {
                    let offset = piece * 64 + place;
                    self.rows.push(RowByHand { cycle: self.cycle, offset, old: *old, new: *new });
                    *old = *new;
                }
            }
        }
        divan::black_box(self.rows.last().map(|row| row.cycle + row.offset as u64 + u64::from(row.old ^ row.new)));
    }
}

fn advance(position: &mut i64, carry: &mut f64, movement: f64) {
    let exact = movement + *carry;
    let whole = exact.round();
    *carry = exact - whole;
    #[expect(clippy::cast_possible_truncation, reason = "the movement in one cycle is small")]
    let whole = whole as i64;
    *position += whole;
}
