//! Every transcript runs again with the same trace.

use std::path::Path;

use super::*;
use crate::image::{Part, raw_value};
use crate::machine::{FaultKind, Switch};
use crate::plc::Programs;
use crate::scenario::Scenario;
use crate::scenario::program_rows::program_rows;
use crate::trace::{Trace, Watch};
use crate::units::{ChannelNumber, Position};

const HEADING: Heading<'_> = Heading {
    title: "All \"commands\"",
    machine: "g1_example",
    profile: Profile::SINUMERIK_840D_SL,
    plc: None,
    plc_image: None,
    watch: None,
    plant: None,
    machine_data: &[],
};

/// Sends all commands to a machine, records them, and runs the recorded scenario.
#[track_caller]
fn runs_again(heading: &Heading<'_>, edges: &[(u64, Vec<Command>)], end: u64) -> String {
    let options = crate::machine::OpenOptions { profile: heading.profile, ..Default::default() };
    let mut machine = Machine::open_with("g1_example", options).unwrap();
    let mut transcript = Transcript::begin(heading);
    let mut trace = Trace::begin(machine.memory(), machine.cycle_time(), 0, machine.time());
    while machine.cycle() < end {
        let cycle = machine.cycle();
        for (_, commands) in edges.iter().filter(|(at, _)| *at == cycle) {
            for command in commands {
                machine.queue(command.clone()).unwrap();
            }
        }
        transcript.edge(&machine, &[]);
        machine.step();
        trace.extend(machine.recorder());
        trace.extend_causes(machine.cycle(), program_rows(&machine));
        machine.drain();
        trace.end_cycle(machine.cycle(), machine.time(), machine.variables());
    }
    let text = transcript.take_text() + &transcript.rest(end);
    let scenario =
        Scenario::parse(&text, Path::new("again.toml")).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
    assert_eq!(scenario.title, heading.title);
    let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{:?}\n{text}", finished.failure);
    assert_eq!(finished.session().machine().cycle(), end);
    assert!(finished.json_lines() == trace.json_lines(&machine, &Watch::default()), "{text}");
    text
}

#[test]
fn every_command_is_repeated() {
    let machine = Machine::open("g1_example").unwrap();
    let place = |name: &str| machine.names().resolve(machine.memory(), name).unwrap();
    let write = |name: &str, value| Command::Write { location: place(name), value };
    let axis = machine.axis("XF").unwrap();
    let fault = |kind| Command::Fault(Fault { axis, kind });
    let by = Position::from_user(0.1234);
    let slip = FaultKind::EncoderSlip { by };
    let stuck = |which, at| fault(FaultKind::SwitchStuck { which, at });
    let datum = |target: &str, value| Command::MachineDatum { target: target.to_owned(), value };
    let r_parameter =
        |channel, number, value| Command::RParameter { channel: ChannelNumber::new(channel).unwrap(), number, value };
    let edges = [
        (0, vec![write("X.controller_enable", 1), write("DB31.DBX2.1", 0), write("MB7", 0xAB), write("DB31.DBB60", 3)]),
        (0, vec![Command::Force { location: place("X.pulse_enable"), value: 1 }]),
        (50, vec![Command::Release { location: place("X.pulse_enable") }, Command::PlcStop]),
        (
            60,
            vec![
                Command::PlcRun,
                datum("34090[XF]", DatumValue::Real(-1e-5)),
                datum("30300[Y]", DatumValue::Boolean(false)),
            ],
        ),
        (
            61,
            vec![
                Command::PlcColdRestart,
                Command::RParameter { channel: ChannelNumber::FIRST, number: 5, value: 0.5 },
                datum("10000[3]", DatumValue::Text("B2\\".to_owned())),
                datum("34080[AX1]", DatumValue::Integer(7)),
            ],
        ),
        (65, vec![r_parameter(1, 0, 0.1), r_parameter(1, 99, -1e300), Command::PlcColdRestart]),
        (70, vec![Command::NewConf, Command::Cancel, Command::Handwheel { number: 1, pulses: -20, cycles: 7 }]),
        (
            80,
            vec![
                fault(FaultKind::Block),
                fault(FaultKind::Push { by }),
                fault(slip),
                fault(FaultKind::ZeroMarkMissing),
            ],
        ),
        (90, vec![fault(FaultKind::DriveFault), fault(FaultKind::EncoderFault { encoder: None })]),
        (95, vec![fault(FaultKind::EncoderFault { encoder: Some(1) }), fault(FaultKind::Friction { by: 0.1 })]),
        (
            99,
            vec![fault(FaultKind::Drift { by: 0.1 + 0.2 }), stuck(Switch::Cam, true), stuck(Switch::LimitPlus, false)],
        ),
        (100, vec![Command::ClearFault(Fault { axis, kind: slip }), stuck(Switch::LimitMinus, true), Command::PowerOn]),
        (100, vec![write("M0.0", 1)]),
    ];
    let text = runs_again(&HEADING, &edges, 150);
    assert!(
        text.contains(
            "set = { \"X.controller_enable\" = 1 }\n\n[[step]]\nset = { \"X.controller_enable\" = 0, \"MB7\" = 171 }"
        ),
        "{text}"
    );
    assert!(text.contains("write = { \"DB31.DBB60\" = 3 }"), "{text}");
    assert!(text.contains("r_parameters = { \"R0\" = 0.1, \"R99\" = -1e300 }"), "{text}");
}

/// 2 ms before power on and 60 ms after it: the times of the recording are those of the machine.
#[test]
fn a_change_of_the_cycle_is_repeated_with_its_times() {
    let cycles = Command::MachineDatum { target: "10070".to_owned(), value: DatumValue::Integer(30) };
    let machine = Machine::open("g1_example").unwrap();
    let location = machine.names().resolve(machine.memory(), "MB7").unwrap();
    let write = |value| Command::Write { location, value };
    let edges = [(10, vec![write(1)]), (20, vec![cycles, Command::PowerOn]), (40, vec![write(2)])];
    runs_again(&HEADING, &edges, 60);
}

/// Every byte of every part, with all widths, under both profiles. What the machine accepts can be read again.
#[test]
fn every_location_is_repeated() {
    for profile in [Profile::SINUMERIK_840D_SL, Profile::SINUMERIK_828D] {
        let heading = Heading { profile, ..HEADING };
        let options = crate::machine::OpenOptions { profile, ..Default::default() };
        let machine = Machine::open_with("g1_example", options).unwrap();
        let memory = machine.memory();
        let parts = [
            Part::ToNck,
            Part::FromNck,
            Part::Hmi,
            Part::Inputs,
            Part::Outputs,
            Part::Flags,
            Part::Timers,
            Part::Counters,
            Part::Block(19),
        ];
        let mut commands = Vec::new();
        for part in parts {
            for offset in 0..u32::try_from(memory.part(part).len()).unwrap() {
                let bit = u8::try_from(offset % 8).unwrap();
                for (bit, width) in [(bit, 1), (bit, 3), (0, 7), (0, 8), (0, 16), (0, 32), (1, 8), (0, 64)] {
                    let location = Location { part, offset, bit, width, format: Format::Unsigned };
                    // A client cannot write a location that the profile does not show or that spans two parts.
                    // As a REAL it is a finite number: another one has no text for a signal that the profile shows at no address.
                    let value = u64::from(offset).wrapping_mul(0x9E37_79B9) & 0xFFFF_FFFF_BFFF_FFFF;
                    let command = Command::Write { location, value };
                    if machine.check(&command).is_ok() {
                        commands.push(Command::Write { location, value: value & location.mask() });
                    }
                }
            }
        }
        assert!(commands.len() > 4000, "{}", commands.len());
        runs_again(&heading, &[(0, commands)], 20);
    }
}

#[test]
fn a_real_is_written_as_a_number_or_else_as_its_bits() {
    let machine = Machine::open("g1_example").unwrap();
    let location = machine.names().resolve(machine.memory(), "DB19.DBD0:REAL").unwrap();
    for (bits, text) in [
        (0x3F80_0000, "1.0"),
        (0xC144_0000, "-12.25"),
        (0x8000_0000, "-0.0"),
        (0x0000_0001, "1e-45"),
        (0x7F7F_FFFF, "3.4028235e38"),
    ] {
        assert_eq!(number(bits, location).as_deref(), Some(text));
        let node = Table::parse(&format!("a = {text}"), "t").unwrap().take("a").unwrap();
        assert_eq!(raw_value(&node, location, machine.override_coding()).unwrap(), bits);
    }
    for no_number in [0x7FC0_0000, 0x7F80_0000, 0xFFFF_FFFF] {
        assert_eq!(number(no_number, location), None);
    }
}

#[test]
fn notes_are_at_their_cycle_with_or_without_commands() {
    let mut machine = Machine::open("g1_example").unwrap();
    let mut transcript = Transcript::begin(&HEADING);
    for _ in 0..3 {
        machine.step();
    }
    transcript.note("one");
    transcript.note("two");
    transcript.edge(&machine, &[]);
    let steps =
        "\n[[step]]\nrun = \"3cycles\"\n\n[[step]]\nnote = \"one\"\nset = {}\n\n[[step]]\nnote = \"two\"\nset = {}\n";
    assert!(transcript.take_text().ends_with(steps));
}

/// A selected program with its subprogram, once more, another one, and blocks of MDA: the recording has their texts.
#[test]
fn programs_are_repeated_with_their_texts() {
    let main = "N10 G90 ; it's\nN20 SUB\nN30 M30";
    let program = |name: &str, text: &str| crate::nc_program::Program::read(name, "parts", text.as_bytes()).remove(0);
    let mut machine = Machine::open("machine_data/portal").unwrap();
    machine.load_programs(
        vec![program("part.mpf", main), program("other.mpf", "M30\r\n"), program("sub.spf", "M17\n")],
        Vec::new(),
    );
    let channel = ChannelNumber::FIRST;
    let select = |path: &str| Command::SelectProgram { channel, path: path.to_owned() };
    let heading = Heading { machine: "machine_data/portal", ..HEADING };
    let mut transcript = Transcript::begin(&heading);
    let mut trace = Trace::begin(machine.memory(), machine.cycle_time(), 0, machine.time());
    let mdi = Command::EnterBlocks { channel, text: "G0 X1\nM30".to_owned() };
    let search = Command::Search { channel, block: "N20".to_owned(), kind: crate::machine::SearchKind::EndPoint };
    for command in [select("parts/PART.MPF"), mdi, search, select("parts/OTHER.MPF"), select("parts/PART.MPF")] {
        machine.queue(command).unwrap();
        transcript.edge(&machine, &[]);
        machine.step();
        trace.extend(machine.recorder());
        machine.drain();
        trace.end_cycle(machine.cycle(), machine.time(), machine.variables());
    }
    let text = transcript.take_text() + &transcript.rest(5);
    let scenario =
        Scenario::parse(&text, Path::new("again.toml")).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
    let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{:?}\n{text}", finished.failure);
    assert!(
        finished.json_lines() == trace.json_lines(&machine, &Watch::default()),
        "{text}\n{}",
        finished.json_lines()
    );
    let expected = "nc = '''\n%_N_PART_MPF\n;$PATH=parts\nN10 G90 ; it's\nN20 SUB\nN30 M30\n";
    assert!(text.contains(expected), "{text}");
    assert!(text.contains("\n%_N_SUB_SPF\n;$PATH=parts\nM17\n"), "{text}");
    assert!(text.contains("mdi = '''\nG0 X1\nM30'''\n"), "{text}");
    assert!(text.contains("search = { block = \"N20\", kind = \"end_point\" }\n"), "{text}");
    let again = finished.session().machine();
    for path in ["parts/PART.MPF", "parts/OTHER.MPF", "parts/SUB.SPF"] {
        assert!(again.program_text(path, false).is_some(), "{path}");
    }
}
