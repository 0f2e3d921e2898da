//! STEP 7 programs as the PLC of a machine. Sources are those of a user; expected values come from the rules of STEP 7 and of the control.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::fs;
use std::path::{Path, PathBuf};

use opennck::image::Profile;
use opennck::machine::{Command, Machine, OpenOptions};
use opennck::plc::Programs;
use opennck::scenario::{Finished, Scenario, Session};
use opennck::trace::Story;
use opennck::units::Time;

/// The enables of axis 2 (Y), a clock of 100 ms in T 5, a counter, a data block; OB35 counts, too.
const PORTAL: &str = "DATA_BLOCK DB 100\nSTRUCT\nscans : INT := 7;\nstarts : INT;\ninterrupts : INT;\nEND_STRUCT;\nBEGIN\n\
    starts := 3;\nEND_DATA_BLOCK\n\
    ORGANIZATION_BLOCK OB 100\nBEGIN\nL DB100.starts; + 1; T DB100.starts;\nEND_ORGANIZATION_BLOCK\n\
    ORGANIZATION_BLOCK OB 35\nBEGIN\nL DB100.interrupts; + 1; T DB100.interrupts;\nEND_ORGANIZATION_BLOCK\n\
    ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n\
    SET; = DB32.DBX 1.5; = DB32.DBX 2.1; = DB32.DBX 21.7;\nNETWORK\n\
    L DB100.scans; + 1; T DB100.scans;\n\
    A I 0.0; L S5T#100MS; SD T 5; A T 5; = Q 0.0;\n\
    A I 0.0; CU C 3; A DB32.DBX 61.5; = M 1.0;\nEND_ORGANIZATION_BLOCK\n";

/// A folder with a program, and room for scenarios beside it.
fn directory(name: &str, source: &str, toml: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("step7").join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(directory.join("step7/portal")).expect("the target directory is writable");
    fs::write(directory.join("step7/portal/main.awl"), source).unwrap();
    if !toml.is_empty() {
        fs::write(directory.join("step7/portal/plc.toml"), toml).unwrap();
    }
    directory
}

fn ob1(statements: &str) -> String {
    format!("ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\nNETWORK\n{statements}\nEND_ORGANIZATION_BLOCK\n")
}

#[track_caller]
fn run(directory: &Path, scenario: &str) -> Finished {
    let text = format!("machine = \"g1_example\"\nplc = \"step7/portal\"\n{scenario}");
    let scenario = Scenario::parse(&text, &directory.join("s.toml")).unwrap();
    scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run()
}

#[track_caller]
fn passes(directory: &Path, scenario: &str) -> Finished {
    let finished = run(directory, scenario);
    assert!(finished.failure.is_none(), "{}\n{}", finished.failure.as_ref().unwrap(), finished.text());
    finished
}

#[test]
fn a_folder_is_the_plc_program_of_a_scenario() {
    let directory = directory("scenario", PORTAL, "");
    let finished = passes(
        &directory,
        "watch = [\"Y.position_controller_active\", \"DB100.DBW2\", \"Q0.0\", \"M1.0\"]\n\
         [[step]]\nwait = \"Y.position_controller_active && M1.0\"\nwithin = \"1s\"\n\
         [[step]]\nexpect = [\"DB100.DBW2 == 4\", \"DB100.DBW0 > 7\", \"C3 == 0\"]\n\
         [[step]]\nset = { \"I0.0\" = 1 }\n\
         # The timer starts in the scan of the next cycle: 2 ms + 100 ms.\n\
         [[step]]\nhold = \"!Q0.0\"\nduring = \"50cycles\"\n\
         [[step]]\nexpect = [\"C3 == 1\", \"T5 == 1\"]\n\
         [[step]]\nrun = \"1cycles\"\n[[step]]\nexpect = [\"Q0.0\", \"T5 == 0\"]\n",
    );
    assert!(finished.text().contains("DB100.DBW2") || !finished.text().contains("stopped"), "{}", finished.text());
}

/// In BCD with the base of the last start: S5T#100MS is 10 of the base 10 ms.
#[test]
fn clients_see_timers_and_counters_as_words_in_bcd() {
    let directory = directory("words", PORTAL, "");
    passes(
        &directory,
        "[[step]]\nrun = \"1cycles\"\n[[step]]\nset = { \"I0.0\" = 1, \"C3\" = 0x99 }\n[[step]]\nrun = \"1cycles\"\n\
         # 99 is 16#99 in BCD, and one more is 16#100.\n\
         [[step]]\nexpect = [\"C3 == 256\", \"T5 == 16\"]\n[[step]]\nrun = \"11ms\"\n[[step]]\nexpect = \"T5 == 9\"\n",
    );
}

#[test]
fn ob1_and_ob35_have_their_own_periods() {
    let directory = directory("periods", PORTAL, "cycle = \"10ms\"\nob35 = \"4ms\"\n");
    // Cycles of 2 ms. Scans at cycles 1, 6, 11 … 46: ten in 100 ms. OB35 is due 4 ms after the start of the first scan, then every 4 ms: at
    // cycles 3, 5 … 49, that is 24 times.
    passes(
        &directory,
        "[[step]]\nrun = \"50cycles\"\n[[step]]\nexpect = [\"DB100.DBW0 == 17\", \"DB100.DBW4 == 24\"]\n",
    );
}

#[test]
fn a_machine_names_its_program() {
    let directory = directory("machine", PORTAL, "");
    let machine = directory.join("machine");
    fs::create_dir_all(machine.join("step7")).unwrap();
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("machine_data/g1_example");
    fs::copy(example.join("g1_example.tea"), machine.join("g1_example.tea")).unwrap();
    let plant = fs::read_to_string(example.join("plant.toml")).unwrap();
    fs::write(machine.join("plant.toml"), format!("[machine]\nplc = \"../step7/portal\"\n{plant}")).unwrap();
    let mut session = Session::open(&machine).unwrap();
    session.wait("Y.position_controller_active && DB100.DBW2 == 4", "1s").unwrap();

    let scenario = "machine = \"machine\"\n[[step]]\nwait = \"Y.position_controller_active && DB100.DBW0 > 20\"\n";
    let scenario = Scenario::parse(scenario, &directory.join("s.toml")).unwrap();
    let finished = scenario.prepare(Profile::default(), &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{}", finished.text());

    let mut other = Session::open("g1_example").unwrap().with_step7(directory.join("step7/portal")).unwrap();
    other.wait("Y.position_controller_active && DB100.DBW2 == 4", "1s").unwrap();
    other.expect("DB31.DBX61.5 == 0").unwrap();
}

#[test]
fn a_program_with_findings_is_not_loaded() {
    let directory = directory("findings", &ob1("A I 4.9;\nCALL FC 99;"), "");
    let text = "machine = \"g1_example\"\nplc = \"step7/portal\"\n[[step]]\nrun = \"1s\"\n";
    let scenario = Scenario::parse(text, &directory.join("s.toml")).unwrap();
    let problem = scenario.prepare(Profile::default(), &Programs::ready()).err().unwrap().to_string();
    let place = format!("{}:5: ", directory.join("step7/portal/main.awl").display());
    assert!(problem.starts_with(&place) && problem.contains("a bit from 0 to 7"), "{problem}");
    assert!(problem.contains("lists all 2 findings"), "{problem}");
    let nowhere = text.replace("step7/portal", "step7/nothing");
    let scenario = Scenario::parse(&nowhere, &directory.join("s.toml")).unwrap();
    let problem = scenario.prepare(Profile::default(), &Programs::ready()).err().unwrap().to_string();
    assert!(problem.contains("step7/nothing"), "{problem}");
}

#[test]
fn a_fault_stops_the_plc_with_its_place_and_the_registers() {
    let directory =
        directory("fault", &ob1("A I 0.0;\nJCN a;\nL 2;\nOPN DB 99;\na: SET;\n= Q 0.0;\n= DB32.DBX 2.1;"), "");
    let finished = passes(
        &directory,
        "[[step]]\nrun = \"10cycles\"\n[[step]]\nset = { \"I0.0\" = 1 }\n[[step]]\nwait = \"alarm(2000)\"\nwithin = \"1cycles\"\n",
    );
    let text = finished.text();
    let place = "# OB1, network 2, statement 4 (main.awl:8): DB99 is not loaded /   ACCU1 00000002 ACCU2 00000000";
    assert!(text.contains(place), "{text}");
    let machine = finished.session().machine();
    // P-150: the output that the same scan has set, and the enables of an earlier one.
    for address in ["Q0.0", "DB32.DBX2.1"] {
        let location = machine.names().resolve(machine.memory(), address).unwrap();
        assert_eq!(machine.memory().read(location), 0, "{address}");
    }
    assert!(finished.remarks().iter().any(|line| line.contains("statement 4 (main.awl:8): DB99 is not loaded")));
    let diagnosis = machine.plc_diagnosis().unwrap();
    assert_eq!((diagnosis.cause, diagnosis.stop), (Some(0x253A), 0x4562));
    assert!(machine.is_plc_stopped());
}

#[test]
fn with_ob121_the_plc_goes_on() {
    let source = "ORGANIZATION_BLOCK OB 121\nBEGIN\nL MW 2; + 1; T MW 2;\nEND_ORGANIZATION_BLOCK\n".to_owned()
        + &ob1("OPN DB 99;\nL MW 4;\n+ 1;\nT MW 4;");
    let directory = directory("ob121", &source, "");
    passes(
        &directory,
        "[[step]]\nrun = \"3cycles\"\n[[step]]\nexpect = [\"MW2 == 3\", \"MW4 == 3\", \"alarms() == 0\"]\n",
    );
}

/// Byte 61 belongs to the control: what the program writes there is lost. Byte 2 is the PLC's, and a byte of the operator panel is not.
#[test]
fn a_program_writes_its_own_bytes_of_the_interface() {
    let directory =
        directory("writers", &ob1("L W#16#FFFF;\nT DB31.DBW 60;\nT DB31.DBB 6;\nS I 5.0;\nA I 5.0;\n= M 0.0;"), "");
    passes(
        &directory,
        "[[step]]\nrun = \"3cycles\"\n[[step]]\nexpect = [\"DB31.DBB60 != 255\", \"DB31.DBB6 == 255\", \"!I5.0\"]\n",
    );
}

#[test]
fn the_828d_has_its_own_numbers() {
    let directory = directory(
        "numbers",
        &ob1("SET;\n= DB3801.DBX 1.5;\n= DB3801.DBX 2.1;\n= DB3801.DBX 4001.7;\nA DB3901.DBX 1.5;\n= M 0.0;"),
        "",
    );
    let finished = passes(
        &directory,
        "profile = \"828d\"\n[[step]]\nwait = \"Y.position_controller_active && M0.0\"\nwithin = \"1s\"\n",
    );
    assert!(finished.session().machine().plc_fault().is_none());
}

/// O-28: what the program writes reaches the control 10 ms later.
#[test]
fn delays_act_as_for_closures() {
    let source = ob1("SET;\n= DB32.DBX 1.5;\n= DB32.DBX 21.7;\nAN I 0.1;\n= DB32.DBX 2.1;");
    let directory = directory("delays", &source, "");
    let scenario = "[plant.machine]\nto_nck_delay = \"10ms\"\n[[step]]\nrun = \"1s\"\n[[step]]\nexpect = \"Y.position_controller_active\"\n\
        [[step]]\nset = { \"I0.1\" = 1 }\n[[step]]\nwait = \"!Y.position_controller_active\"\nwithin = \"1s\"\n";
    let late = passes(&directory, scenario).session().time();
    let at_once = passes(&directory, &scenario.replace("10ms", "0ms")).session().time();
    assert_eq!(late - at_once, Time::from_millis(10));
}

#[test]
fn a_plc_image_keeps_its_block_and_areas_grow() {
    let directory = directory(
        "image",
        &(PORTAL.to_owned() + "FUNCTION FC 1 : VOID\nBEGIN\nL MB 4095; L T 200;\nEND_FUNCTION\n"),
        "",
    );
    fs::write(directory.join("i.toml"), "[[db]]\nnumber = 100\nsize = 20\nvalues = { \"DBW0\" = 50 }\n").unwrap();
    passes(
        &directory,
        "plc_image = \"i.toml\"\n[[step]]\nrun = \"1cycles\"\n[[step]]\nexpect = [\"DB100.DBW0 == 51\", \"DB100.DBB19 == 0\", \"MB4095 == 0\", \"T200 == 0\"]\n",
    );
}

#[test]
fn power_on_runs_ob100_with_the_loaded_data() {
    let directory = directory("power", PORTAL, "");
    passes(
        &directory,
        "[[step]]\nset = { \"I0.0\" = 1 }\n[[step]]\nrun = \"50cycles\"\n[[step]]\nexpect = [\"C3 == 1\", \"DB100.DBW0 == 57\"]\n\
         [[step]]\npower_on = true\n[[step]]\nrun = \"1cycles\"\n[[step]]\nexpect = [\"C3 == 0\", \"DB100.DBW0 == 8\", \"DB100.DBW2 == 4\"]\n\
         # A restart keeps the data.\n\
         [[step]]\nplc = \"stop\"\n[[step]]\nplc = \"run\"\n[[step]]\nrun = \"1cycles\"\n[[step]]\nexpect = \"DB100.DBW2 == 5\"\n\
         [[step]]\nplc = \"cold\"\n[[step]]\nrun = \"1cycles\"\n[[step]]\nexpect = \"DB100.DBW2 == 4\"\n",
    );
}

/// In the middle of its timer, a saved and a forked machine go on byte for byte.
#[test]
fn a_saved_and_a_forked_machine_go_on_in_the_middle_of_a_timer() {
    let directory = directory("saved", PORTAL, "");
    let open = || {
        let mut machine = Machine::open_with("g1_example", OpenOptions::default()).unwrap();
        machine.load_named("step7/portal", &[&directory], &Programs::ready()).unwrap();
        machine
    };
    let mut machine = open();
    let input = machine.names().resolve(machine.memory(), "I0.0").unwrap();
    machine.queue(Command::Write { location: input, value: 1 }).unwrap();
    for _ in 0..30 {
        machine.step();
    }
    let saved = machine.save();
    let mut fork = machine.fork().unwrap();
    let mut restored = open();
    restored.restore(&saved).unwrap();
    let output = machine.names().resolve(machine.memory(), "Q0.0").unwrap();
    assert_eq!(machine.memory().read(output), 0, "the timer runs");
    for _ in 0..40 {
        for other in [&mut machine, &mut fork, &mut restored] {
            other.step();
        }
        assert_eq!(machine.save(), fork.save());
        assert_eq!(machine.save(), restored.save());
    }
    assert_eq!(machine.memory().read(output), 1);
    fs::write(directory.join("step7/portal/main.awl"), ob1("NOP 0;")).unwrap();
    assert!(open().restore(&saved).is_err(), "another program");
}

/// From the position control of X back through four blocks, a multi-instance and a timer to the key and the pressure switch.
#[test]
fn why_goes_through_the_program_to_the_key() {
    let finished = example("clamp_fault");
    let session = finished.session();
    let story = session.trace().story(session.machine());
    let text = story.why("X.position_controller_active", Time::from_seconds(3.2)).unwrap();
    let rows = [
        "because SIG-01: controller enable missing in the unit, X.controller_enable = 0  [X]",
        "X.controller_enable (DB31.DBX2.1)  1 -> 0  by plc",
        "because FB11, network 2, statement 1 (blocks.awl:146): DB110.DBX4.1 = 0  [PLC]",
        "because OB1, network 3, statement 5 (main.awl:37): \"Clamp fault\" (M11.0) = 1  [PLC]",
        "because FC30, network 2, statement 6 (blocks.awl:70): \"Clamp monitoring\" (T2) = 1  [PLC]",
        "because FC30, network 2, statement 4 (blocks.awl:68): \"Clamp valve\" (Q0.1) = 1, \"Clamp closed\" (I1.3) = 0  [PLC]",
        "because FC30, network 1, statement 3 (blocks.awl:62): \"Key clamp\" (I0.5) = 1, \"Hydraulics ready\" (M10.0) = 1  [PLC]",
        "I0.5  0 -> 1  by outside",
    ];
    let mut rest = text.as_str();
    for row in rows {
        rest = &rest[rest.find(row).unwrap_or_else(|| panic!("{row}\n{text}"))..];
    }
    // The same from JSON lines.
    let read = Story::read(&session.json_lines()).unwrap();
    let again = read.why("X.controller_enable", Time::from_seconds(3.2)).unwrap();
    assert!(
        again.contains("because FB11, network 2, statement 1 (blocks.awl:146): DB110.DBX4.1 = 0  [PLC]"),
        "{again}"
    );
}

#[test]
fn why_not_names_the_open_contact() {
    let scenario = Scenario::read(&portal().join("reference_and_synchronise.toml")).unwrap();
    let prepared = scenario.prepare(Profile::default(), &Programs::ready()).unwrap();
    // Pressure is there, the time is not over.
    let finished = prepared.run_until(Some(Time::from_seconds(0.5)));
    let text = finished.session().why_not("X.traversing_key_plus", false).unwrap();
    let head = "X.traversing_key_plus (DB31.DBX4.7) is 0: the control does not write it; never changed";
    assert!(text.contains(head), "{text}");
    for row in [
        "FC40, network 1, statement 5 (blocks.awl:87)",
        "\"Key X plus\" (I0.3) = 0, wanted 1: never changed",
        "\"Clamp closed\" (I1.3) = 0, wanted 1: never changed",
        "\"Axes released\" (M10.1) = 0, wanted 1: never changed",
        "OB1, network 3, statement 5 (main.awl:37)",
        "\"Pressure delay\" (T1) = 0, wanted 1",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    assert!(!text.contains("Key X minus"), "its contact is closed:\n{text}");
}

/// An override and a counter: a word names its statement and the words of which it is made, back to the input.
#[test]
fn words_name_the_words_of_which_they_are_made() {
    let directory = directory(
        "made",
        "FUNCTION FC 1 : VOID\nBEGIN\nNETWORK\nL IW 2;\nL 2;\n*I;\nT MW 20;\nNETWORK\nL MB 21;\nT DB32.DBB 0;\n\
         L DB100.limit;\nL MW 20;\n<=I;\n= Q 0.0;\nEND_FUNCTION\n\
         DATA_BLOCK DB 100\nSTRUCT\nlimit : INT := 50;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
         ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FC 1;\nEND_ORGANIZATION_BLOCK\n",
        "",
    );
    let finished = passes(
        &directory,
        "watch = [\"MW20\", \"DB32.DBB0\", \"Q0.0\", \"IW2\"]\n[[step]]\nrun = \"10cycles\"\n[[step]]\nset = { \"IB3\" = 30 }\n[[step]]\nrun = \"2cycles\"\n",
    );
    let text = finished.text();
    for row in [
        "FC1, network 1, statement 4 (main.awl:7): IW2 = 30",
        "FC1, network 2, statement 2 (main.awl:10): MB21 = 60",
        "FC1, network 2, statement 6 (main.awl:14): MW20 = 60, DB100.DBW0 = 50",
    ] {
        assert!(text.contains(row), "{row}\n{text}");
    }
    let session = finished.session();
    let why = session.trace().story(session.machine()).why("DB32.DBB0", session.time()).unwrap();
    let rows = [
        "because FC1, network 2, statement 2 (main.awl:10): MB21 = 60",
        "MB21  0 -> 60",
        "IW2 = 30",
        "IW2  0 -> 30  by outside",
    ];
    let mut rest = why.as_str();
    for row in rows {
        rest = &rest[rest.find(row).unwrap_or_else(|| panic!("{row}\n{why}"))..];
    }
    // A word that does not change: the statement that writes it, and what it reads.
    let why_not = session.why_not("MW20", false).unwrap();
    assert!(why_not.contains("MW20 is 60: changed last at"), "{why_not}");
    assert!(why_not.contains("FC1, network 1, statement 4 (main.awl:7)\n"), "{why_not}");
    assert!(why_not.contains("IW2 = 30: changed last at"), "{why_not}");
    // A bit that a comparison makes, and a bit within a byte that is transferred: 60 is 0011_1100.
    let why_not = session.why_not("Q0.0", false).unwrap();
    assert!(why_not.contains("MW20 = 60") && why_not.contains("DB100.DBW0 = 50: never changed"), "{why_not}");
    let why_not = session.why_not("DB32.DBX0.0", false).unwrap();
    assert!(why_not.contains("statement 2 (main.awl:10)") && why_not.contains("MB21 = 60"), "{why_not}");
}

fn portal() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/step7_portal")
}

#[track_caller]
fn example(name: &str) -> Finished {
    let scenario = Scenario::read(&portal().join(format!("{name}.toml"))).unwrap();
    let finished = scenario.prepare(Profile::default(), &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{}", finished.text());
    finished
}

#[test]
fn the_example_passes_and_has_its_golden_traces() {
    opennck::golden::check(portal(), &Programs::ready());
}

/// A scenario observes the program; its trace and state are those of a machine that does not.
#[test]
fn an_observed_machine_has_the_same_bytes() {
    let directory = directory("observed", PORTAL, "");
    let open = || {
        let mut machine = Machine::open("g1_example").unwrap();
        machine.load_named("step7/portal", &[&directory], &Programs::ready()).unwrap();
        machine
    };
    let (mut plain, mut observed) = (open(), open());
    observed.observe_program();
    for _ in 0..100 {
        plain.step();
        observed.step();
        assert_eq!(plain.save(), observed.save());
    }
    assert!(plain.program_coverage().is_none() && observed.program_coverage().is_some());
}

#[test]
#[cfg(feature = "cli")]
fn coverage_is_written_in_three_forms() {
    let directory = directory("coverage", &ob1("A I 0.0;\n= M 0.0;\nJC a;\nA I 0.1;\n= M 0.1;\na: NOP 0;"), "");
    let text = "machine = \"g1_example\"\nplc = \"./step7/portal\"\nwatch = [\"M0.0\"]\n[[step]]\nrun = \"10ms\"\n";
    fs::write(directory.join("s.toml"), text).unwrap();
    let opennck = |arguments: &[&str]| {
        let mut command = std::process::Command::new(env!("CARGO_BIN_EXE_opennck"));
        let output = command.args(arguments).current_dir(&directory).output().unwrap();
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stdout).into_owned(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    // Without I 0.0: both contacts are false, the jump is not taken.
    let line = "PLC ./step7/portal: 6 of 6 statements (100 %), 1 of 1 networks (100 %), 1 of 2 branches (50 %), 0 of 2 contacts true and false (0 %)\n";
    for file in ["c.html", "c.json", "c.lcov"] {
        let (code, out, err) = opennck(&["run", "s.toml", "--plc-coverage", file]);
        assert!(code == Some(0) && out.ends_with(line), "{out}{err}");
    }
    let read = |file: &str| fs::read_to_string(directory.join(file)).unwrap();
    let lcov = read("c.lcov");
    let path = "SF:step7/portal/main.awl\n";
    assert!(
        lcov.contains(path) && lcov.contains("BRDA:5,0,0,1\nBRDA:5,0,1,0\n") && lcov.contains("DA:6,1\n"),
        "{lcov}"
    );
    assert!(lcov.contains("BRF:6\nBRH:3\n") && lcov.ends_with("LF:6\nLH:6\nend_of_record\n"), "{lcov}");
    let json: serde_json::Value = serde_json::from_str(&read("c.json")).unwrap();
    assert_eq!(json["counts"]["branches"], serde_json::json!({ "covered": 1, "all": 2 }));
    assert_eq!(json["unchanged"][0]["text"], "A I 0.0;");
    let html = read("c.html");
    let (first, source) =
        (html.find("Contacts that never changed: 2").unwrap(), html.find("<h2>step7/portal/main.awl</h2>").unwrap());
    assert!(first < source, "the list of contacts is before the sources");
    let (code, _, _) = opennck(&["test", "s.toml", "--accept"]);
    assert_eq!(code, Some(0));
    let (code, out, err) = opennck(&["test", "s.toml", "--plc-coverage", "all.lcov"]);
    assert!(code == Some(0) && out.contains(line), "{out}{err}");
    assert_eq!(read("all.lcov"), lcov);
    let (code, _, err) = opennck(&["run", "s.toml", "--plc-coverage", "c.txt"]);
    assert!(code == Some(2) && err.contains(".html, .json or .lcov"), "{err}");
}
