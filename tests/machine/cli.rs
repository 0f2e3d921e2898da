//! Tests of the program as users call it: commands, exit codes, and the use of standard output and standard error.
#![cfg(feature = "cli")]

use std::fs;
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};

/// A directory for one test.
pub(crate) fn directory(name: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).expect("the target directory is writable");
    directory
}

pub(crate) fn opennck(arguments: &[&str], directory: &PathBuf) -> Output {
    Command::new(env!("CARGO_BIN_EXE_opennck"))
        .args(arguments)
        .current_dir(directory)
        .output()
        .expect("the program was built")
}

pub(crate) fn out(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("text")
}

pub(crate) fn err(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("text")
}

const GOOD: &str = "title = \"A flag\"\nmachine = \"g1_example\"\nwatch = [\"M0.*\"]\n\
    [[step]]\nnote = \"now\"\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n";

#[test]
fn without_arguments_the_worked_example_runs_and_suggests_next_steps() {
    let output = opennck(&[], &directory("example"));
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).contains("X.start_gantry_synchronization"));
    assert!(out(&output).contains("passed, after") && out(&output).contains("What to try next"));
}

#[test]
fn run_prints_the_sequence_and_the_result_and_writes_the_trace() {
    let directory = directory("run");
    fs::write(directory.join("good.toml"), GOOD).unwrap();
    let output = opennck(&["run", "good.toml", "--trace", "t.jsonl"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).contains("0.002  # now") && out(&output).contains("passed, after 0.010 s"));
    let trace = fs::read_to_string(directory.join("t.jsonl")).unwrap();
    assert!(trace.starts_with("{\"t\":0.002,\"note\":\"now\"}\n"), "{trace}");
    assert!(trace.contains("{\"t\":0.002,\"signal\":\"M0.0\",\"value\":1,\"by\":\"outside\"}\n"), "{trace}");
    let output = opennck(&["run", "good.toml", "good.toml", "--trace", "t.jsonl"], &directory);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("expected one scenario"), "{}", err(&output));
}

#[test]
fn run_writes_the_trace_as_waveform_and_as_diagram() {
    let directory = directory("pictures");
    fs::write(directory.join("good.toml"), GOOD.replace("A flag", "A <flag> & more")).unwrap();
    let output = opennck(&["run", "good.toml", "--vcd", "f.vcd", "--svg", "f.svg"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let vcd = fs::read_to_string(directory.join("f.vcd")).unwrap();
    assert!(vcd.contains("$scope module memory $end") && vcd.contains(" M0_0 $end") && vcd.ends_with("#10\n"), "{vcd}");
    let svg = fs::read_to_string(directory.join("f.svg")).unwrap();
    assert!(svg.contains("A &lt;flag&gt; &amp; more") && svg.contains(">M0.0</text>"), "{svg}");
    for option in ["--vcd", "--svg"] {
        let output = opennck(&["run", "good.toml", "good.toml", option, "f"], &directory);
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains(&format!("expected one scenario under one profile with {option}")));
        let output = opennck(&["run", "good.toml", option, "nowhere/f"], &directory);
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""), "nothing runs");
        assert!(err(&output).contains("nowhere/f: cannot be written: "), "{}", err(&output));
    }
}

#[test]
fn run_draws_values_as_curves_with_one_scale() {
    let directory = directory("curves");
    fs::write(directory.join("good.toml"), GOOD).unwrap();
    let run = |options: &[&str]| opennck(&[&["run", "good.toml"], options].concat(), &directory);
    let output = run(&["--svg", "c.svg", "--curves", "*.following_error,X.velocity", "--from", "4ms"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let svg = fs::read_to_string(directory.join("c.svg")).unwrap();
    for name in ["X.following_error: ", "XF.following_error: ", "X.velocity: 0.000000 to 0.000000 mm/min"] {
        assert!(svg.contains(name), "{name}: {svg}");
    }
    assert!(!svg.contains("M0.0") && svg.ends_with("</svg>\n"), "{svg}");
    // The values are not watched: the printed trace does not have them.
    assert!(!out(&output).contains("following_error"), "{}", out(&output));
    for (curve, text) in [
        ("X.folowing_error", "--curves: "),
        ("M0.0", "--curves: expected the name of a value for a curve, found `M0.0`"),
        ("CHAN1.program", "--curves: expected the name of a value for a curve"),
    ] {
        let output = run(&["--svg", "d.svg", "--curves", curve]);
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""), "nothing runs");
        assert!(err(&output).contains(text) && !directory.join("d.svg").exists(), "{}", err(&output));
    }
    assert_eq!(run(&["--curves", "X.velocity"]).status.code(), Some(2), "there is no picture for them");
}

#[test]
fn diff_reports_the_first_difference_in_words() {
    let directory = directory("diff");
    let write = |name: &str, text: &str| fs::write(directory.join(name), text).unwrap();
    let key =
        "{\"t\":0.002,\"signal\":\"DB31.DBX4.7\",\"symbol\":\"X.traversing_key_plus\",\"value\":1,\"by\":\"plc\"}\n";
    write("a.jsonl", &format!("{key}{}", key.replace("2,", "8,").replace(":1", ":0")));
    write("b.jsonl", &format!("{key}{}", key.replace("0.002,", "0.012,").replace(":1", ":0")));
    write("c.jsonl", "{\"t\":0.002}\nno JSON\n");
    let output = opennck(&["diff", "a.jsonl", "a.jsonl"], &directory);
    assert_eq!((output.status.code(), out(&output).as_str()), (Some(0), "the traces are the same\n"));
    let output = opennck(&["diff", "a.jsonl", "b.jsonl"], &directory);
    assert_eq!(output.status.code(), Some(1));
    let words = "X.traversing_key_plus (DB31.DBX4.7) 1 -> 0 is 0.004 s later (0.012 s instead of 0.008 s)";
    assert!(out(&output).contains(words), "{}", out(&output));
    let output = opennck(&["diff", "a.jsonl", "c.jsonl"], &directory);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("c.jsonl:2: expected one line of a trace"), "{}", err(&output));
    write(
        "t.snap",
        "---\nsource: x\n---\nscenario  A\n\n    time  what  address  change  by\n   0.002  M0.0           0 -> 1  plc\n",
    );
    for (one, other) in [("a.jsonl", "t.snap"), ("a.jsonl", "missing")] {
        assert_eq!(opennck(&["diff", one, other], &directory).status.code(), Some(2), "{one} {other}");
    }
    write("u.snap", &fs::read_to_string(directory.join("t.snap")).unwrap().replace("plc", "outside"));
    let output = opennck(&["diff", "t.snap", "u.snap"], &directory);
    assert_eq!(output.status.code(), Some(1));
    let words = "first difference in line 7, at 0.002 s\n  M0.0 0 -> 1: expected writer plc, found outside\n";
    assert!(out(&output).starts_with(words), "{}", out(&output));
}

#[test]
fn a_case_of_a_matrix_and_a_part_of_a_picture_are_chosen() {
    let directory = directory("chosen");
    let matrix =
        "title = \"m\"\nmachine = \"g1_example\"\nwatch = [\"MB0\"]\n[matrix]\n\"plant.X.start\" = [120.0, 130.0]\n";
    let set = |value: u8| {
        let key = "\"X.traversing_key_plus\" = 1";
        format!("[[step]]\nset = {{ MB0 = {value}, {key} }}\n[[step]]\nrun = \"10ms\"\n")
    };
    fs::write(directory.join("m.toml"), format!("{matrix}{}{}", set(1), set(2))).unwrap();
    let why =
        |options: &[&str]| opennck(&[&["why", "m.toml", "X.traversing_key_plus@1"], options].concat(), &directory);
    let output = why(&["--case", "130.0"]);
    assert_eq!((output.status.code(), out(&output).contains("by outside")), (Some(0), true), "{}", err(&output));
    assert!(err(&why(&[])).contains("--case TEXT"), "{}", err(&why(&[])));
    assert!(err(&why(&["--case", "140"])).contains("cases are plant.X.start = 120.0; plant.X.start = 130.0"));
    fs::write(directory.join("plain.toml"), format!("title = \"p\"\nmachine = \"g1_example\"\n{}", set(1))).unwrap();
    let plain = opennck(&["run", "plain.toml", "--case", "130.0"], &directory);
    assert_eq!(plain.status.code(), Some(2));
    assert!(err(&plain).contains("the scenario has no `[matrix]`: omit --case"), "{}", err(&plain));
    let run = |options: &[&str]| opennck(&[&["run", "m.toml", "--case", "130.0"], options].concat(), &directory);
    let output = run(&["--vcd", "t.vcd", "--from", "12ms", "--to", "1"]);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let waveform = fs::read_to_string(directory.join("t.vcd")).unwrap();
    assert!(waveform.contains("#12\n$dumpvars\nb00000001 !\n$end\nb00000010 !\n"), "{waveform}");
    for (options, cause) in [
        (&["--from", "1s"][..], "expected --svg or --vcd together with --from and --to"),
        (&["--svg", "t.svg", "--from", "2s", "--to", "1s"], "expected a time --from before the time --to"),
        (&["--svg", "t.svg", "--from", "soon"], "expected a time such as 7.5"),
    ] {
        let output = run(options);
        assert!(output.status.code() == Some(2) && err(&output).contains(cause), "{}", err(&output));
    }
    let late = run(&["--svg", "t.svg", "--from", "9s"]);
    assert!(err(&late).contains("the trace ends at 0.020 s, before --from 9.000 s"), "{}", err(&late));
}

#[test]
fn why_follows_an_edge_back_to_the_written_signal() {
    let directory = directory("why");
    let scenario = include_str!("../../golden/worked_example/gantry_references_and_synchronises.toml");
    fs::write(directory.join("s.toml"), scenario.replace("../../machine_data/", "")).unwrap();
    assert_eq!(opennck(&["run", "s.toml", "--trace", "t.jsonl"], &directory).status.code(), Some(0));
    for trace in ["s.toml", "t.jsonl"] {
        // Without a time, the last edge.
        let signal = "X.gantry_grouping_is_synchronized";
        for edge in [signal, &format!("{signal}@9"), "DB31.DBX101.5@8068ms"] {
            let output = opennck(&["why", trace, edge], &directory);
            assert_eq!(output.status.code(), Some(0), "{}", err(&output));
            for words in [
                "8.068  X.gantry_grouping_is_synchronized (DB31.DBX101.5)  0 -> 1  by nck\n",
                "8.068    because REF-10: ",
                "7.690    after REF-14: start, X.start_gantry_synchronization = 1  [X]\n",
                "7.690      X.start_gantry_synchronization (DB31.DBX29.4)  0 -> 1  by outside\n",
                "0.040      X.traversing_key_plus (DB31.DBX4.7)  0 -> 1  by outside\n",
            ] {
                assert!(out(&output).contains(words), "{words} in {}", out(&output));
            }
        }
    }
    let output = opennck(&["why", "t.jsonl", "alarm(10654)@7.6"], &directory);
    assert!(out(&output).contains("alarm(10654) (X)  raised  by nck\n    7.558    because REF-11"), "{}", out(&output));
    for (trace, edge, cause) in [
        ("t.jsonl", "MD37110[X]@9", "expected a signal or a happening of the trace, found `MD37110[X]`"),
        ("t.jsonl", "@5", "expected SIGNAL, SIGNAL@TIME or alarm(NUMBER)@TIME"),
        ("t.jsonl", "X.gantry_axis@soon", "expected SIGNAL, SIGNAL@TIME or alarm(NUMBER)@TIME"),
        ("t.jsonl", "X.gantri_axis@1", "did you mean `X.gantry_axis`?"),
        ("t.jsonl", "DB31.DBX101.5@1", "its first edge is at 8.068 s"),
        ("missing.jsonl", "X.gantry_axis@1", "cannot be read"),
        ("missing.toml", "X.gantry_axis@1", "missing.toml"),
    ] {
        let output = opennck(&["why", trace, edge], &directory);
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains(cause), "{cause} in {}", err(&output));
    }
}

#[test]
fn why_starts_at_power_on_machine_data_and_faults_too() {
    let directory = directory("why_happening");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n\
        [[step]]\nmachine_data = { \"37110[XF]\" = 0.3 }\n[[step]]\npulse = [\"DB21.DBX7.7\"]\n\
        [[step]]\nfault = { axis = \"XF\", kind = \"drive_fault\" }\n[[step]]\npower_on = true\n[[step]]\nrun = \"10ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    assert_eq!(opennck(&["run", "s.toml", "--trace", "t.jsonl"], &directory).status.code(), Some(0));
    for trace in ["s.toml", "t.jsonl"] {
        for (edge, words) in [
            ("MD37110@1", "MD37110 (XF)  active  by nck\n"),
            ("MD37110[XF]@1", "after RESET: RESET, CHAN1.channel_reset = 1  [CHAN1]\n"),
            ("machine_datum_active@1", "CHAN1.channel_reset (DB21.DBX7.7)  0 -> 1  by outside\n"),
            ("fault drive_fault[XF]@1", "fault drive_fault (XF)  set  by outside\n"),
            ("power@1", "power (nck)  on  by outside\n"),
            ("power_on@1", "because power on: power was switched on  [nck]\n"),
        ] {
            let output = opennck(&["why", trace, edge], &directory);
            assert!(out(&output).contains(words), "{edge}: {words} in {}{}", out(&output), err(&output));
        }
    }
}

#[test]
fn test_checks_the_causes_if_it_is_asked_to() {
    let directory = directory("check_causes");
    let scenario = "title = \"t\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\n[[step]]\nrun = \"50ms\"\n";
    fs::write(directory.join("s.toml"), scenario).unwrap();
    let output = opennck(&["test", "s.toml", "--accept", "--check-causes"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert!(out(&output).contains("1 case: 1 accepted"), "{}", out(&output));
}

#[test]
fn a_failed_expectation_ends_with_1_and_reports_the_value() {
    let directory = directory("failed");
    fs::write(directory.join("bad.toml"), format!("{GOOD}[[step]]\nexpect = \"M0.1\"\n")).unwrap();
    let output = opennck(&["run", "bad.toml"], &directory);
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("bad.toml:10: expected `M0.1`, but it is false"), "{}", err(&output));
    assert!(out(&output).contains("failed, after 0.010 s"));
}

/// `>>` of a shell: the file behind the stream keeps its content, and the report stands in it too.
#[cfg(unix)]
#[test]
fn a_trace_to_the_standard_output_keeps_the_file_behind_it() {
    let directory = directory("stream");
    fs::write(directory.join("good.toml"), GOOD).unwrap();
    let file = directory.join("all.txt");
    fs::write(&file, "before\n").unwrap();
    let opened = fs::OpenOptions::new().append(true).open(&file).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    command.args(["run", "good.toml", "--trace", "/dev/stdout"]).current_dir(&directory).stdout(opened);
    assert!(command.status().unwrap().success());
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.starts_with("before\n") && text.contains("\n{\"t\":") && text.contains("passed"), "{text}");
}

#[test]
fn a_text_in_utf_16_is_named_with_the_way_to_convert_it() {
    let directory = directory("utf_16");
    let bytes: Vec<u8> = GOOD.encode_utf16().flat_map(u16::to_le_bytes).collect();
    fs::write(directory.join("wide.toml"), [&[0xFF, 0xFE], &bytes[..]].concat()).unwrap();
    let output = opennck(&["run", "wide.toml"], &directory);
    assert_eq!(output.status.code(), Some(2));
    let found = "wide.toml: expected a text in UTF-8 or Latin-1, found a text in UTF-16 (little-endian)";
    assert!(err(&output).contains(found), "{}", err(&output));
    assert!(err(&output).contains("iconv -f UTF-16 -t UTF-8 'wide.toml' > NEW_FILE"), "{}", err(&output));
}

#[test]
fn with_one_invalid_file_nothing_runs() {
    let directory = directory("unusable");
    fs::write(directory.join("good.toml"), GOOD).unwrap();
    fs::write(directory.join("bad.toml"), GOOD.replace("M0.0", "X.nonsense")).unwrap();
    let output = opennck(&["run", "good.toml", "bad.toml", "missing.toml"], &directory);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(out(&output), "");
    assert!(err(&output).contains("bad.toml:6: ") && err(&output).contains("missing.toml"), "{}", err(&output));
}

#[test]
fn no_output_replaces_an_input_of_the_same_command() {
    let directory = directory("apart");
    fs::write(directory.join("good.toml"), GOOD).unwrap();
    for output in ["--trace", "--vcd", "--svg"] {
        let refused = opennck(&["run", "good.toml", output, "./good.toml"], &directory);
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            err(&refused).contains(&format!("expected a separate file for {output}, found a file that this command"))
        );
    }
    let serve = ["serve", "--scenario", "good.toml", "--s7", "127.0.0.1:0", "--trace", "good.toml"];
    let refused = opennck(&serve, &directory);
    assert_eq!(refused.status.code(), Some(2), "{}", err(&refused));
    assert_eq!(fs::read_to_string(directory.join("good.toml")).unwrap(), GOOD);
}

#[test]
fn test_compares_accepts_and_reports() {
    let directory = directory("test");
    fs::create_dir_all(directory.join("golden/area")).unwrap();
    fs::write(directory.join("golden/area/flag.toml"), GOOD).unwrap();
    let output = opennck(&["test"], &directory);
    assert_eq!(output.status.code(), Some(1), "a missing golden file is a failure");
    assert!(err(&output).contains("does not exist"), "{}", err(&output));
    let output = opennck(&["test", "--accept"], &directory);
    assert_eq!((output.status.code(), out(&output).lines().count()), (Some(0), 2), "{}", out(&output));
    let output = opennck(&["test", "golden/area/flag.toml", "--jobs", "2", "--junit", "r.xml"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    assert_eq!(out(&output), "1 case: 1 passed\n");
    assert!(fs::read_to_string(directory.join("r.xml")).unwrap().contains("tests=\"1\" failures=\"0\" errors=\"0\""));
    // Valid scenarios run in addition to an invalid one, and the exit code of the program is the highest code.
    fs::write(directory.join("golden/area/bad.toml"), "title = 1").unwrap();
    let output = opennck(&["test"], &directory);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(out(&output), "2 cases: 1 passed, 1 unusable\n");
}

#[test]
fn signals_are_listed_as_table_json_and_csv() {
    let directory = directory("signals");
    let output = opennck(&["signals", "start_gantry"], &directory);
    assert!(out(&output).contains("DB31.DBX29.4  AX1.start_gantry_synchronization  plc"), "{}", out(&output));
    let output = opennck(&["signals", "db35.dbx29.4"], &directory);
    assert!(out(&output).contains("AX1.start_gantry_synchronization"), "the signal of axis 5: {}", out(&output));
    let output = opennck(&["signals", "--format", "csv"], &directory);
    assert!(out(&output).starts_with("address,symbol,writer,name,modelled\n"));
    let csv = out(&output).lines().count();
    let output = opennck(&["signals", "--format", "json"], &directory);
    let json: serde_json::Value = serde_json::from_str(&out(&output)).unwrap();
    assert_eq!(json.as_array().unwrap().len() + 1, csv);
    let output = opennck(&["signals", "--profile", "isg"], &directory);
    let listed = out(&output);
    assert!(listed.contains("channel_1.start ") && listed.contains("ax1.gantry_on.enable_w "), "{listed}");
    assert!(!listed.contains("CHAN1.") && !listed.contains("AX1."), "{listed}");
    let output = opennck(&["signals", "start_gantry", "--profile", "828d"], &directory);
    assert!(out(&output).contains("DB3800.DBX5005.4"), "{}", out(&output));
    assert_eq!(opennck(&["signals", "--profile", "802d"], &directory).status.code(), Some(2));
    let output = opennck(&["signals", "no such signal", "--format", "csv"], &directory);
    assert_eq!(out(&output), "address,symbol,writer,name,modelled\n");
    // As `grep`: nothing was found.
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(opennck(&["alarms", "no such alarm"], &directory).status.code(), Some(1));
}

#[test]
fn why_not_names_that_a_spindle_starts_no_reference_point_approach() {
    let directory = directory("why_not_spindle");
    let machine = format!("{}/golden/archives/spindle", env!("CARGO_MANIFEST_DIR"));
    let scenario = format!(
        "title = \"A\"\nmachine = {machine:?}\nplc = \"enable_all\"\n\
        [[step]]\nset = {{ \"DB11.DBX0.2\" = 1, \"DB11.DBX1.2\" = 1 }}\n\
        [[step]]\nwait = \"SP1.position_controller_active\"\nwithin = \"1s\"\n\
        [[step]]\nset = {{ \"SP1.traversing_key_plus\" = 1 }}\n[[step]]\nrun = \"1s\"\n"
    );
    fs::write(directory.join("s.toml"), scenario).unwrap();
    for signal in ["SP1.traverse_command_plus", "SP1.referenced_synchronized_1"] {
        let output = opennck(&["why-not", "s.toml", signal], &directory);
        let text = out(&output);
        assert!(text.contains("reference point approach of SP1 (MD35000)") && text.contains("spindle"), "{text}");
        assert!(!text.contains("it follows"), "{text}");
    }
}

#[test]
fn why_not_names_what_holds_a_program() {
    let directory = directory("why_not_program");
    let write = |signals: &str| {
        let scenario = format!(
            "title = \"A\"\nmachine = \"portal\"\nplc = \"enable_all\"\nnc = \"N10 G1 X50 F1000\\nN20 M6\\nN30 M30\"\n\
            [[step]]\nwait = \"X.position_controller_active\"\nwithin = \"1s\"\n\
            [[step]]\nset = {{ \"DB11.DBX0.0\" = 1, {signals} }}\n[[step]]\nrun = \"20ms\"\n\
            [[step]]\npulse = \"CHAN1.nc_start\"\n[[step]]\nrun = \"500ms\"\n"
        );
        fs::write(directory.join("s.toml"), scenario).unwrap();
    };
    let asked = |signal: &str, wanted: &str| {
        let output = opennck(&["why-not", "s.toml", signal], &directory);
        let text = out(&output);
        assert!(text.contains(wanted) && !text.contains("it follows"), "{signal}: {text}");
    };
    write("\"CHAN1.feed_override\" = \"0%\", \"CHAN1.feed_override_active\" = 1");
    asked("X.axis_stationary", "effective override of the path of CHAN1 (feed_override): 0 %, wanted above 0 %");
    write("\"X2.feed_stop\" = 1");
    asked("X.axis_stationary", "X2.feed_stop (DB34.DBX4.3) = 1, wanted 0");
    write("\"CHAN1.read_in_disable\" = 1");
    for signal in ["X.traverse_command_plus", "X.axis_stationary", "CHAN1.decoded_m_function_6", "CHAN1.m2_m30_active"]
    {
        asked(signal, "CHAN1.read_in_disable (DB21.DBX6.1) = 1, wanted 0");
    }
}

#[test]
fn machine_data_are_checked_with_file_line_and_identifier() {
    let directory = directory("machine_data");
    fs::write(directory.join("m.tea"), "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=99\nM17\n").unwrap();
    let output = opennck(&["machine-data", "check", "m.tea"], &directory);
    assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
    let alarm = "  m.tea:1: alarm at power on: MD37100 $MA_GANTRY_AXIS_TYPE[AX1] = 99, axis X1: 10650: \
        channel CHAN1 axis X1 wrong gantry machine data, error code 1\n";
    assert!(out(&output).contains(alarm), "{}", out(&output));
    fs::write(directory.join("e.tea"), "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=x\nM17\n").unwrap();
    let output = opennck(&["machine-data", "check", "e.tea"], &directory);
    assert_eq!(output.status.code(), Some(2), "unusable: {}{}", out(&output), err(&output));
    assert!(out(&output).contains("e.tea:1: error: MD37100 "), "{}", out(&output));
    fs::write(directory.join("n.tea"), "N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"nck\"\n").unwrap();
    let output = opennck(&["machine-data", "check", "n.tea"], &directory);
    assert_eq!(output.status.code(), Some(2), "a run refuses it: {}{}", out(&output), err(&output));
    assert!(out(&output).contains("n.tea: error: expected different names, found `nck`"), "{}", out(&output));
    fs::write(directory.join("empty.arc"), "").unwrap();
    let output = opennck(&["machine-data", "check", "empty.arc"], &directory);
    assert_eq!(output.status.code(), Some(2), "{}{}", out(&output), err(&output));
    assert!(err(&output).contains("empty.arc: expected members, found an empty file\n"), "{}", err(&output));
    fs::write(directory.join("good.tea"), "N37100 $MA_GANTRY_AXIS_TYPE[AX2]=1\nN37100 $MA_GANTRY_AXIS_TYPE[AX5]=11\n")
        .unwrap();
    let output = opennck(&["machine-data", "check", "good.tea"], &directory);
    assert!(out(&output).starts_with("no findings\n2 machine data taken, 0 unknown kept\n"), "{}", out(&output));
    assert!(out(&output).contains("gantry grouping 1: Y1 leads B1\n"), "{}", out(&output));
    fs::create_dir(directory.join("empty")).unwrap();
    for nothing in ["empty", "nowhere"] {
        assert_eq!(opennck(&["machine-data", "check", nothing], &directory).status.code(), Some(2));
    }
    let output = opennck(&["machine-data", "check", "nowhere"], &directory);
    assert_eq!(output.status.code(), Some(2));
}

/// HG-28, 110076: the list and the table of `plant.toml` that misses its axis are in one error. Entries without an effect have a heading.
#[test]
fn a_list_with_the_number_0_is_named_with_the_axis_that_plant_toml_misses() {
    let directory = directory("logical_number_0");
    let machine = directory.join("m");
    fs::create_dir(&machine).unwrap();
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/machine_data/isg_hard_gantry")).unwrap() {
        let entry = entry.unwrap();
        fs::copy(entry.path(), machine.join(entry.file_name())).unwrap();
    }
    let slave = fs::read_to_string(machine.join("axis_5.lis")).unwrap();
    fs::write(machine.join("axis_5.lis"), slave.clone() + "\nkenngr.swe_pos 5\n").unwrap();
    let output = opennck(&["machine-data", "check", "m"], &directory);
    assert!(out(&output).contains("\n  entries that are not known here: 1 data, 1 values\n"), "{}", out(&output));
    let number = slave.lines().find(|line| line.starts_with("kopf.achs_nr")).unwrap().to_owned();
    fs::write(machine.join("axis_5.lis"), slave.replace(&number, "kopf.achs_nr 0")).unwrap();
    let output = opennck(&["machine-data", "check", "m"], &directory);
    assert_eq!(output.status.code(), Some(2));
    for part in ["m/plant.toml:8: ", "found `ax5`", "110076", "(axis_5.lis:2)", "kopf.achs_nr of this list"] {
        assert!(out(&output).contains(part), "{part}: {}", out(&output));
    }
}

/// The lines of a command's output that start with a text.
fn lines<'a>(output: &'a str, start: &str) -> Vec<&'a str> {
    output.lines().filter(|line| line.starts_with(start)).collect()
}

#[test]
fn findings_are_grouped_and_only_those_that_change_the_behaviour_end_with_1() {
    let directory = directory("grouped_findings");
    let data = "N37100 $MA_GANTRY_AXIS_TYPE[AX1]=1\nN37100 $MA_GANTRY_AXIS_TYPE[AX2]=11\nN36902 $MA_SAFE_IS_ROT_AX[AX1]=1\n\
        N36902 $MA_SAFE_IS_ROT_AX[AX2]=1\nN36903 $MA_SAFE_CAM_ENABLE[AX1]=1\nN36901 $MA_SAFE_FUNCTION_ENABLE[AX1]=0\n$TC_DP1[1,1]=120\n";
    fs::create_dir(directory.join("m")).unwrap();
    fs::write(directory.join("m/a.arc"), data).unwrap();
    let check = |more: &[&str]| opennck(&[&["machine-data", "check", "m"], more].concat(), &directory);
    let output = check(&[]);
    assert_eq!(output.status.code(), Some(0), "{}{}", out(&output), err(&output));
    assert!(out(&output).contains("\n  Safety Integrated: 3 data, 4 values\n"), "{}", out(&output));
    assert!(
        out(&output).starts_with("findings: 4 not modelled\n") && !out(&output).contains("MD36902"),
        "{}",
        out(&output)
    );
    let listed = check(&["--all"]);
    assert_eq!(lines(&out(&listed), "    m/a.arc:").len(), 4, "{}", out(&listed));
    assert_eq!(check(&["--deny", "not-modelled"]).status.code(), Some(1));
    assert_eq!(check(&["--deny", "overlaid"]).status.code(), Some(0));
    fs::write(directory.join("m/b.tea"), "N37100 $MA_GANTRY_AXIS_TYPE[AX2]=12\nN36052 $MA_STOP_ON_CLAMPING[AX1]=1\n")
        .unwrap();
    let output = check(&[]);
    assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
    let expected = [
        "  m/a.arc:1: alarm at power on: MD37100 $MA_GANTRY_AXIS_TYPE[AX1] = 1, axis X1: 10651: channel CHAN1 illegal gantry \
         configuration, reason 2001",
        "  m/b.tea:1: alarm at power on: MD37100 $MA_GANTRY_AXIS_TYPE[AX2] = 12, axis Y1: 10651: channel CHAN1 illegal gantry \
         configuration, reason 1002",
        "  m/b.tea:2: acts otherwise: MD36052 $MA_STOP_ON_CLAMPING[AX1] = 1, axis X1: clamping has no special functions",
        "  m/b.tea:1: overlaid: MD37100 $MA_GANTRY_AXIS_TYPE[AX2] = 12, axis Y1: replaces 11 of m/a.arc:2",
    ];
    let text = out(&output);
    let found: Vec<_> = lines(&text, "  m/").into_iter().filter(|line| line.contains("MD3")).collect();
    assert_eq!(found, expected);
    fs::write(directory.join("s.toml"), "title = \"A\"\nmachine = \"m\"\n[[step]]\nrun = \"10ms\"\n").unwrap();
    let output = opennck(&["run", "s.toml"], &directory);
    let summary = "2 alarms at power on, 1 acts otherwise than on a control (MD36052), 1 replaced by a later file or line, 4 not modelled";
    assert_eq!(err(&output).lines().filter(|line| line.contains(summary)).count(), 1, "{}", err(&output));
    assert_eq!(err(&output).lines().count(), 1, "one line: {}", err(&output));
}

#[test]
fn every_command_has_help_and_a_mistyped_one_ends_with_2() {
    let directory = directory("help");
    for arguments in [
        &["--help"][..],
        &["run", "--help"],
        &["test", "--help"],
        &["diff", "--help"],
        &["why", "--help"],
        &["signals", "--help"],
        &["machine-data", "check", "--help"],
        &["plc", "check", "--help"],
        &["machine-data", "list", "--help"],
        &["tune-limits", "--help"],
    ] {
        let output = opennck(arguments, &directory);
        assert!(output.status.code() == Some(0) && out(&output).contains("Usage:"), "{arguments:?}");
    }
    assert_eq!(opennck(&["rum"], &directory).status.code(), Some(2));
    assert_eq!(opennck(&["run"], &directory).status.code(), Some(2));
}

#[test]
fn a_step_7_program_is_checked_with_file_line_and_network() {
    let directory = directory("step7");
    let folder = directory.join("portal");
    fs::create_dir_all(&folder).unwrap();
    let check = |source: &str| {
        fs::write(
            folder.join("main.awl"),
            format!("ORGANIZATION_BLOCK OB 1\nBEGIN\nNETWORK\n{source}\nEND_ORGANIZATION_BLOCK\n"),
        )
        .unwrap();
        let output = opennck(&["plc", "check", "portal"], &directory);
        (output.status.code(), out(&output))
    };
    let (code, text) = check("A M 0.0; = DB31.DBX 2.1;");
    assert_eq!(code, Some(0), "{text}");
    assert!(
        text.contains("data blocks that the machine must have: DB31\n") && text.contains("no findings\n"),
        "{text}"
    );
    let (code, text) = check("CALL FC 77;\nCALL SFC 90;");
    assert_eq!(code, Some(1), "{text}");
    assert!(text.contains("main.awl:4:1: OB1, network 1: FC77 is called and is nowhere\n"), "{text}");
    assert!(
        text.contains("not supported: 1\n") && text.contains("main.awl:5:1: OB1, network 1: SFC90 is not built in"),
        "{text}"
    );
    let (code, text) = check("A M 0.9;");
    assert_eq!(code, Some(2), "{text}");
    assert!(text.contains("errors: 1\n") && text.contains("main.awl:4:5: expected a bit from 0 to 7"), "{text}");
    fs::write(folder.join("plc.toml"), "missing = \"ignore\"\n").unwrap();
    assert_eq!(check("CALL FC 77;").0, Some(0));
    fs::remove_file(folder.join("main.awl")).unwrap();
    let output = opennck(&["plc", "check", "portal"], &directory);
    assert!(
        output.status.code() == Some(2) && err(&output).contains("expected at least one source"),
        "{}",
        err(&output)
    );
}

#[test]
fn a_closed_output_pipe_causes_no_panic() {
    let mut child = Command::new(env!("CARGO_BIN_EXE_opennck"))
        .args(["signals", "--format", "json"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let mut errors = String::new();
    child.stderr.take().unwrap().read_to_string(&mut errors).unwrap();
    assert!(child.wait().unwrap().code().is_some() && errors.is_empty(), "{errors}");
}

#[test]
fn test_marks_the_transitions_that_scenarios_take_and_lists_the_others() {
    let directory = directory("flowchart");
    let referencing = "title = \"X and XF\"\nmachine = \"g1_example\"\nplc = \"enable_all\"\nwatch = [\"DB31.DBX101.4\"]\n\
        [[step]]\nset = { \"DB11.DBX1.2\" = 1 }\n[[step]]\npulse = \"X.traversing_key_plus\"\n\
        [[step]]\nwait = \"X.gantry_synchronization_ready_to_start\"\nwithin = \"60s\"\n";
    fs::write(directory.join("referencing.toml"), referencing).unwrap();
    fs::write(directory.join("nothing.toml"), GOOD).unwrap();
    let output = opennck(&["test", ".", "--accept", "--jobs", "2", "--flowchart", "chart.mmd"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let chart = fs::read_to_string(directory.join("chart.mmd")).unwrap();
    assert!(chart.starts_with("flowchart TD\n"), "{chart}");
    // Eight rows of the approach (the path with MD34050 = 0 and a cam), and three rows of the grouping.
    for text in [out(&output), chart.clone()] {
        assert!(text.contains("11 of 71 transitions taken\n"), "{text}");
        assert!(text.contains("never taken: WaitingForStart -> Synchronising (REF-14: start)\n"), "{text}");
        assert!(
            !text.contains("never taken: ReferencingSynchronousAxis -> WaitingForStart (REF-11: MD37110 = 0)"),
            "{text}"
        );
    }
    opennck(&["test", ".", "--flowchart", "again.mmd"], &directory);
    assert_eq!(fs::read_to_string(directory.join("again.mmd")).unwrap(), chart);
    let output = opennck(&["test", ".", "--flowchart", "missing/chart.mmd"], &directory);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("missing/chart.mmd"), "{}", err(&output));
}

#[test]
fn each_shell_has_completions() {
    let directory = directory("completions");
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let output = opennck(&["completions", shell], &directory);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        assert!(
            ["flowchart", "machine-data", "tune-limits"].iter().all(|command| out(&output).contains(command)),
            "{shell}: {}",
            out(&output)
        );
    }
    assert_eq!(opennck(&["completions", "cmd"], &directory).status.code(), Some(2));
}

#[test]
fn every_command_has_a_manual_page() {
    let directory = directory("man");
    let output = opennck(&["man", "."], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let help = out(&opennck(&["--help"], &directory));
    let (_, commands) = help.split_once("Commands:\n").unwrap();
    let (commands, _) = commands.split_once("\n\n").unwrap();
    let is_name = |line: &&str| line.starts_with("  ") && !line.starts_with("   ");
    let names = commands.lines().filter(is_name).filter_map(|line| line.split_whitespace().next());
    let mut count = 0;
    for name in names.filter(|name| *name != "help") {
        let page = fs::read_to_string(directory.join(format!("opennck-{name}.1"))).unwrap();
        assert!(page.contains(".SH SYNOPSIS"), "{name}: {page}");
        count += 1;
    }
    assert!(count > 10, "{help}");
    assert!(fs::read_to_string(directory.join("opennck.1")).unwrap().contains("opennck\\-run(1)"));
    assert_eq!(opennck(&["man", "missing"], &directory).status.code(), Some(2));
}

/// Skipped on a system without bash.
#[test]
fn bash_sources_its_completions_and_completes_a_command() {
    let directory = directory("bash");
    fs::write(directory.join("opennck.bash"), out(&opennck(&["completions", "bash"], &directory))).unwrap();
    let script = "set -eu; source ./opennck.bash; complete -p opennck; COMP_WORDS=(opennck flow); COMP_CWORD=1; \
        _opennck opennck flow opennck; printf '%s\\n' \"${COMPREPLY[@]}\"";
    let Ok(output) = Command::new("bash").args(["--norc", "-c", script]).current_dir(&directory).output() else {
        return;
    };
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(out(&output).lines().last(), Some("flowchart"), "{}", out(&output));
}

#[test]
fn rule_explains_rules_decisions_and_alarms() {
    let directory = directory("rule");
    let ask = |id: &str| out(&opennck(&["rule", id], &directory));
    let rule = ask("REF-02");
    assert!(rule.starts_with("REF-02  Section 1: ") && rule.contains("source: G1 2.3.1"), "{rule}");
    assert!(rule.contains("\nscenarios:\n") && rule.contains("golden/referencing/minus_direction.toml"), "{rule}");
    let touched = ask("mon-08");
    assert!(touched.contains("\n  E-14  ") && touched.contains("module: sinumerik/gantry/"), "{touched}");
    for (id, words) in [
        ("E-14", "It touches MON-08."),
        ("C-03", "fast stop 20.1"),
        ("O-14", "gantry-not-config"),
        ("25040", "Alarm: axis %1 standstill monitoring"),
        ("power on", "Power was switched on"),
    ] {
        assert!(ask(id).contains(words), "{id}: {}", ask(id));
    }
    let list = out(&opennck(&["rule", "parking", "--format", "csv"], &directory));
    assert!(list.starts_with("id,scenarios,source,rule\n") && list.contains("SIG-08,"), "{list}");
    let json: serde_json::Value =
        serde_json::from_str(&out(&opennck(&["rule", "REF-02", "--format", "json"], &directory))).unwrap();
    assert_eq!(json["id"], "REF-02");
    let unknown = opennck(&["rule", "REF-99"], &directory);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(err(&unknown).contains("did you mean `REF-"), "{}", err(&unknown));
}

#[test]
fn signals_say_what_is_modelled_and_know_everyday_words_and_machines() {
    let directory = directory("signals_modelled");
    let ask = |arguments: &[&str]| out(&opennck(&[&["signals"], arguments].concat(), &directory));
    let csv = ask(&["--format", "csv"]);
    assert!(csv.starts_with("address,symbol,writer,name,modelled\n"), "{csv}");
    let count = |word: &str| csv.lines().filter(|line| line.ends_with(&format!(",{word}"))).count();
    assert_eq!(count("yes") + count("written never") + count("memory only") + 1, csv.lines().count());
    for (signal, modelled) in [
        ("DB31.DBX101.5,", "yes"),
        ("DB31.DBX62.3,", "written never"),
        ("DB31.DBX2.1,", "yes"),
        ("DB11.DBX0.5,", "yes"),
        ("DB11.DBX5.2,", "yes"),
    ] {
        let row = csv.lines().find(|line| line.starts_with(signal)).unwrap();
        assert!(row.ends_with(modelled), "{row}");
    }
    for (words, symbol) in [
        ("reference cam", "AX1.deceleration_reference_point_approach"),
        ("Reglerfreigabe", "AX1.controller_enable"),
        ("Schleppabstand", "AX1.following_error"),
        ("gantry start", "AX1.start_gantry_synchronization"),
        ("position", "AX1.position "),
    ] {
        assert!(ask(&[words]).contains(symbol), "{words}: {}", ask(&[words]));
    }
    let of_machine = ask(&["--machine", "g1_example", "start_gantry"]);
    assert!(of_machine.contains("DB33.DBX29.4  XF.start_gantry") && !of_machine.contains("AX1."), "{of_machine}");
}

/// One screen: at most 45 rows.
#[test]
fn the_example_fits_on_a_screen_and_offers_the_rest() {
    let directory = directory("example_screen");
    let output = opennck(&["--svg", "f.svg"], &directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    let text = out(&output);
    assert!(text.lines().count() <= 45, "{} rows\n{text}", text.lines().count());
    assert!(text.lines().all(|line| line.chars().count() <= 140), "{text}");
    assert!(fs::read_to_string(directory.join("f.svg")).unwrap().contains("deceleration_reference_point_approach"));
}
