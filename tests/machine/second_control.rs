//! Tests of the boundary of a control with a second control, implemented outside this crate: 32 drives with their own blocks, signals,
//! names, alarms, rules and chart, and nothing of the SINUMERIK. It uses signals, closures, scenario, golden, trace, save, fork, mapped
//! image and S7.
#![cfg(all(feature = "mapped", feature = "s7"))]
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod platform;

use std::fs;
use std::path::{Path, PathBuf};

use opennck::control::Configuration;
use opennck::golden::{Outcome, Update, cases};
use opennck::image::mapped::{Look, MappedImage, PlcImage, Rules, State as ImageState, Step};
use opennck::image::{Area, FromNck, View};
use opennck::live::{Live, Speed};
use opennck::machine::{Command, DatumValue, Machine, OpenOptions};
use opennck::plc::{Programs, enable_all, program_for};
use opennck::s7::client::{Client, Options};
use opennck::s7::live::LiveServer;
use opennck::s7::server::Limits;
use opennck::scenario::Session;
use opennck::sinumerik::Nck;
use opennck::source::{Place, Problem, Table};
use opennck::units::{AxisNumber, Position, Time};
use opennck::variables::Describe;

use platform::{Own, Platform, Platforms};

/// Reads a machine. It has no files; its plant is empty.
fn read(path: &Path) -> Result<(Box<dyn Configuration>, Table), Problem> {
    Ok((Box::<Platforms>::default(), Table::empty(Place::file(&path.display().to_string()))))
}

fn machine() -> Machine {
    let (configuration, plant) = read(Path::new("platform")).unwrap();
    Machine::of(&*configuration, plant, OpenOptions::default()).unwrap()
}

fn get(machine: &Machine, name: &str) -> u64 {
    machine.memory().read(machine.names().resolve(machine.memory(), name).unwrap())
}

fn set(machine: &mut Machine, name: &str, value: u64) {
    let location = machine.names().resolve(machine.memory(), name).unwrap();
    machine.queue(Command::Write { location, value }).unwrap();
}

fn steps(machine: &mut Machine, count: u32) {
    for _ in 0..count {
        machine.step();
    }
}

fn last() -> AxisNumber {
    AxisNumber::new(32).unwrap()
}

/// A program that gives every drive power while the platform is released.
fn power() -> Box<dyn opennck::plc::PlcProgram> {
    program_for::<_, Own>("power", (), |(), io| {
        for axis in io.axes() {
            io.to_nck.drives[axis.index()].set_power(io.to_nck.platform.release());
        }
        Ok(())
    })
    .boxed()
}

/// An empty directory for the files of a test.
fn directory(name: &str) -> PathBuf {
    let directory = Path::new(env!("CARGO_TARGET_TMPDIR")).join("second_control").join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    directory
}

const SCENARIO: &str = r#"
title = "the last drive moves while it has power"
machine = "platform"
plc = "power"
profile = "own"
causes = true
watch = ["A32.running", "A32.power", "platform.stopped"]
never = ["alarm(700)"]

[[step]]
set = { "platform.release" = 1 }
[[step]]
wait = "A32.running && A32.position > 1.0"
within = "10s"
[[step]]
expect = ["A1.running == 1", "A32.position == A1.position", "DB631.DBX5.0"]
[[step]]
set = { "platform.release" = 0 }
[[step]]
wait = "!A32.running"
within = "1s"
"#;

#[test]
fn signals_closures_and_mechanics_work_with_32_axes_of_another_control() {
    let mut machine = machine();
    machine.load_program(power());
    assert_eq!(machine.names().axes.iter().filter(|(_, name)| name.is_some()).count(), 32);
    steps(&mut machine, 10);
    assert_eq!((get(&machine, "A32.running"), get(&machine, "platform.cycles")), (0, 10));
    set(&mut machine, "platform.release", 1);
    // 20 ms until drives are ready, in cycles of 4 ms; then 1 mm takes a second at 60 mm/min.
    steps(&mut machine, 300);
    assert_eq!((get(&machine, "A1.running"), get(&machine, "A32.running")), (1, 1));
    let position = machine.variables().axes[last()].position;
    assert!(position.user() > 1.0 && position == machine.variables().axes[AxisNumber::FIRST].position, "{position:?}");
    assert!(machine.control().downcast::<Platform>().is_some() && machine.control().downcast::<Nck>().is_none());
    // A program for another control stops the PLC, and the platform raises its own alarm.
    machine.load_program(enable_all().boxed());
    steps(&mut machine, 2);
    assert!(machine.is_plc_stopped() && machine.plc_fault().unwrap().contains("another interface than own"));
    let alarm = machine.variables().alarms.iter().next().copied().unwrap();
    assert_eq!((alarm.number.0, machine.alarm_text(&alarm)), (700, "PLC of the platform missing".to_owned()));
}

#[test]
fn a_plant_may_name_its_axes_and_no_others() {
    let open = |plant: &str| {
        let plant = Table::parse(plant, "plant.toml").unwrap();
        Machine::of(&Platforms::default(), plant, OpenOptions::default())
    };
    let machine = open("[A2]\nstart = 7.5\n").unwrap();
    assert_eq!(machine.variables().axes[AxisNumber::new(2).unwrap()].slide, Position::from_user(7.5));
    let refused = open("[A33]\nstart = 7.5\n").unwrap_err().to_string();
    assert!(
        refused.starts_with("plant.toml:1: ") && refused.contains("(the list of drives), found `A33`"),
        "{refused}"
    );
    let refused = open("[machine]\ndb11_5_2 = \"mirror\"\n").unwrap_err().to_string();
    assert!(refused.contains("found the unknown key `db11_5_2`"), "{refused}");
    let refused = open("[bridge.1]\nstiffness = 1\n").unwrap_err().to_string();
    assert!(refused.contains("this control has no gantry groupings"), "{refused}");
}

#[test]
fn a_datum_is_checked_at_the_boundary_and_kept_at_power_on() {
    let mut machine = machine();
    let speed = |value| Command::MachineDatum { target: "speed".to_owned(), value };
    let refused = machine.queue(speed(DatumValue::Real(-1.0))).unwrap_err().to_string();
    assert!(refused.contains("expected a speed of at least 0 mm/min"), "{refused}");
    assert!(machine.queue(Command::Cancel).is_ok());
    machine.queue(speed(DatumValue::Real(600.0))).unwrap();
    machine.queue(Command::PowerOn).unwrap();
    machine.step();
    let stored = machine.control().data().stored(1, opennck::control::Owner::Nck, 0).unwrap();
    assert_eq!((stored.value, stored.count), (DatumValue::Real(600.0), 1));
}

#[test]
fn a_scenario_has_a_golden_file_with_the_texts_of_its_control() {
    let directory = directory("golden");
    let file = directory.join("last_drive.toml");
    fs::write(&file, SCENARIO.replace("profile = \"own\"\n", "")).unwrap();
    let programs = Programs::ready().with("power", |_| Ok(power()));
    let run = |update| cases(&file).unwrap()[0].run_on(&programs, update, read);
    let (outcome, exercised) = run(Update::Accept);
    assert!(matches!(outcome, Outcome::Accepted), "{outcome}");
    let (outcome, _) = run(Update::No);
    assert!(matches!(outcome, Outcome::Held), "{outcome}");
    let golden = fs::read_to_string(directory.join("last_drive.snap")).unwrap();
    assert!(golden.contains("A32.running"), "{golden}");
    assert!(golden.contains("DB631.DBX5.0"), "{golden}");
    // A rule, a datum and a signal with the texts of this control.
    assert!(golden.contains("P-1: power and release, A32.power = 1, parameter 1 = 60"), "{golden}");
    let exercised = exercised.unwrap();
    assert_eq!(exercised.texts.name(), "own");
    let chart = &exercised.texts.charts()[0];
    let taken: Vec<_> = (0..chart.edges.len()).map(|row| exercised.taken.0[0].has(row)).collect();
    assert_eq!((chart.name, taken), ("drive", vec![true, true]));
    // Scenario files accept only profiles of the controls in `controls`.
    fs::write(&file, SCENARIO).unwrap();
    assert!(cases(&file).unwrap_err().to_string().contains("expected a profile, found `own`"));
}

#[test]
fn a_session_traces_edges_and_why_prints_the_rule() {
    let mut session = Session::new(machine()).with_program(power());
    session.watch(&["A32.*"]).unwrap();
    session.set("platform.release", 1).unwrap();
    session.wait("A32.running", "1s").unwrap();
    let text = session.text();
    assert!(text.contains("DB631.DBX5.0") && text.contains("A32.running"), "{text}");
    let machine = session.machine();
    let running = machine.names().resolve(machine.memory(), "A32.running").unwrap();
    let story = session.trace().why(running, machine.time(), machine).unwrap();
    assert!(story.contains("P-1: power and release"), "{story}");
}

#[test]
fn a_restored_machine_and_a_fork_continue_byte_for_byte() {
    let mut machine = machine();
    machine.load_program(power());
    set(&mut machine, "platform.release", 1);
    steps(&mut machine, 50);
    let saved = machine.save();
    let (mut fork, mut restored) = (machine.fork().unwrap(), self::machine());
    restored.load_program(power());
    restored.restore(&saved).unwrap();
    for step in 0..200 {
        for other in [&mut fork, &mut restored] {
            other.step();
        }
        machine.step();
        assert!(machine.save() == fork.save() && machine.save() == restored.save(), "step {step}");
    }
    let mut sinumerik = Machine::open("g1_example").unwrap();
    assert!(sinumerik.restore(&saved).unwrap_err().to_string().contains("interface `sinumerik`"));
    let of_the_sinumerik = sinumerik.save();
    assert!(machine.restore(&of_the_sinumerik).is_err());
    assert!(FromNck::of_bytes(&machine.memory().from_nck).is_none());
}

#[test]
fn a_plc_process_writes_its_half_of_the_mapped_memory() {
    let mut machine = machine();
    steps(&mut machine, 3);
    let file = directory("mapped").join("image");
    let rules = Rules { lock_step: false, time_out: Time::ZERO };
    let mut memory = machine.memory().clone();
    let mut nc = MappedImage::create(&file, &memory, machine.names(), rules).unwrap();
    nc.state(ImageState::Run);
    let mut plc = PlcImage::open(&file).unwrap();
    nc.start();
    nc.publish(&memory, Step { cycle: 3, time: machine.time(), since_last: Time::ZERO }, false);
    plc.next_step().unwrap();
    let power = plc.offset(Area::DataBlock(631), 4).unwrap();
    plc.image_mut()[power] = 0x80;
    plc.answer();
    assert!(matches!(nc.look(0), Look::Answer(_)));
    nc.take(&mut memory);
    assert_eq!(memory.read(machine.names().resolve(&memory, "A32.power").unwrap()), 1);
}

#[test]
fn s7_clients_read_and_write_its_blocks_and_foreign_nc_variables_are_rejected() {
    let live = Live::start(machine(), Speed::default());
    let server = LiveServer::open(&live, &["127.0.0.1:0"], false, Limits::default()).unwrap();
    let mut client = rust7::S7Client::new();
    let address = server.addresses()[0];
    client.set_connection_port(address.port()).unwrap();
    client.connect_rack_slot(&address.ip().to_string(), 0, 2).unwrap();
    client.write_bit(rust7::S7_AREA_DB, 500, 0, 0, true).unwrap();
    client.write_bit(rust7::S7_AREA_DB, 631, 4, 7, true).unwrap();
    let is_running = |client: &mut rust7::S7Client| client.read_bit(rust7::S7_AREA_DB, 631, 5, 0).unwrap();
    let is_moving = (0..2_000).any(|_| is_running(&mut client));
    assert!(is_moving, "A32 has power but does not move");
    assert!(client.read_bit(rust7::S7_AREA_DB, 31, 61, 3).is_err(), "DB31 is a block of the SINUMERIK");
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let identification = runtime.block_on(async {
        let plc = Client::connect(&address.to_string(), Options::default()).await.unwrap();
        plc.identification().await.unwrap()
    });
    assert_eq!(identification.order_number.trim(), "OPENNCK SIMULATOR", "it is not an 840D sl");
    let refused = runtime.block_on(async {
        let nck = Client::connect(&address.to_string(), Options::nck()).await.unwrap();
        nck.read(&"nck:C/MachineAxis/name[1]".parse().unwrap()).await.unwrap_err()
    });
    assert!(refused.to_string().contains("does not exist"), "{refused}");
}
