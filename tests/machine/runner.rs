//! Tests of `opennck test` as CI calls it: which cases run, in which order, and its reports. Also of outputs: complete, or not changed.
#![cfg(feature = "cli")]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use std::process::{Command, Output, Stdio};
use std::time::Duration;

use crate::processes::{self, EndsWithTest};

/// A scenario of four cases, of which one fails.
const FLAGS: &str = "title = \"Flags & <more>\"\nmachine = \"g1_example\"\ncovers = [\"REF-04\", \"REF-11\"]\nwatch = [\"M0.*\"]\n\
    [matrix]\nplc = [\"enable_all\", \"gantry_start\"]\n\"plant.X.start\" = [120.0, 121.0]\n\
    [[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n";

fn directory(name: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("runner").join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(directory.join("golden/area")).expect("the target directory is writable");
    fs::write(directory.join("golden/area/flags.toml"), FLAGS).expect("the target directory is writable");
    let failing = "machine = \"g1_example\"\n[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nexpect = \"M0.1\"\n";
    fs::write(directory.join("golden/failing.toml"), failing).expect("the target directory is writable");
    assert_eq!(opennck(&["test", "golden/area", "--accept"], &directory).status.code(), Some(0));
    directory
}

fn opennck(arguments: &[&str], directory: &Path) -> Output {
    let program = env!("CARGO_BIN_EXE_opennck");
    Command::new(program).args(arguments).current_dir(directory).output().expect("the program was built")
}

fn out(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

fn listed(arguments: &[&str], directory: &Path) -> Vec<String> {
    let output = opennck(&[&["test", "--list"], arguments].concat(), directory);
    assert_eq!(output.status.code(), Some(0), "{}", err(&output));
    out(&output).lines().map(str::to_owned).collect()
}

#[test]
fn a_case_of_a_matrix_is_the_unit_of_list_filter_and_shard() {
    let directory = directory("select");
    let all = listed(&[], &directory);
    assert_eq!(all.len(), 5);
    assert_eq!(all[0], "golden/area/flags.toml [plc = enable_all, plant.X.start = 120.0]");
    assert_eq!(listed(&["--filter", "gantry_start"], &directory), all[2..4]);
    assert_eq!(listed(&["--filter", "ref-04"], &directory), all[..4], "a cited rule");
    assert_eq!(
        listed(&["--filter", "120.0", "--filter", "failing"], &directory),
        [all[0].clone(), all[2].clone(), all[4].clone()]
    );
    let mut parts = [listed(&["--shard", "1/2"], &directory), listed(&["--shard", "2/2"], &directory)].concat();
    assert_eq!(parts.len(), 5);
    parts.sort();
    let mut sorted = all.clone();
    sorted.sort();
    assert_eq!(parts, sorted, "the parts together are all cases");
    let shuffled = |seed: &str| listed(&["--shuffle", seed], &directory);
    assert_eq!(shuffled("7"), shuffled("7"));
    assert!((0..8).any(|seed| shuffled(&seed.to_string()) != all));
    let none = opennck(&["test", "--filter", "nowhere"], &directory);
    assert_eq!((none.status.code(), err(&none).contains("found none of 5")), (Some(2), true), "{}", err(&none));
    let empty = opennck(&["test", "--shard", "9/9"], &directory);
    assert_eq!((empty.status.code(), out(&empty).as_str()), (Some(0), "0 cases: none in this shard\n"));
}

/// A program with its lines of output as they come, which ends with the test.
struct Watching {
    child: std::process::Child,
    _ends: EndsWithTest,
    lines: std::sync::mpsc::Receiver<String>,
}

impl Watching {
    fn start(arguments: &[&str], directory: &Path) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        command.args(arguments).current_dir(directory).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().expect("the program was built");
        let ends = EndsWithTest::new(&child);
        let output = BufReader::new(child.stdout.take().expect("it is piped"));
        let (sender, lines) = std::sync::mpsc::channel();
        std::thread::spawn(move || {
            output.lines().map_while(Result::ok).take_while(|line| sender.send(line.clone()).is_ok()).for_each(drop);
        });
        Self { child, _ends: ends, lines }
    }

    /// Waits for a line with this text. The time-out is only for a program that hangs.
    fn wait_for(&self, text: &str) -> String {
        let mut seen = Vec::new();
        loop {
            match self.lines.recv_timeout(Duration::from_secs(300)) {
                Ok(line) if line.contains(text) => return line,
                Ok(line) => seen.push(line),
                Err(error) => panic!("{error}: expected `{text}` after {seen:#?}"),
            }
        }
    }
}

impl Drop for Watching {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// `--watch`: cases run again when a file of theirs has changed, others rest, and a closed output ends the program. A changed file is
/// renamed to its name, so that it is never seen half written.
#[test]
fn a_changed_file_runs_its_cases_again_until_the_output_is_closed() {
    let directory = directory("watch");
    let replace = |text: &str| {
        fs::write(directory.join("new"), text).unwrap();
        fs::rename(directory.join("new"), directory.join("golden/failing.toml")).unwrap();
    };
    let mut watching = Watching::start(&["test", "--watch"], &directory);
    watching.wait_for("5 cases: 4 passed, 1 failed");
    watching.wait_for("; press Ctrl-C to stop");
    // A file of another length counts as changed whatever the clock of the file system does.
    let passes = "machine = \"g1_example\"\n[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nexpect = \"M0.0\"\n# passes\n";
    replace(passes);
    watching.wait_for("changed: golden/failing.toml");
    // Its golden file is missing; the four other cases do not run.
    watching.wait_for("1 case: ");
    replace(&passes.replace("expect = \"M0.0\"", "expect = \"M0.1 && M0.2\""));
    watching.wait_for("changed: golden/failing.toml");
    watching.wait_for("1 case: 1 failed");
    // Nobody reads any more. The thread that reads ends with the first line that it cannot pass on; an output after that finds it closed.
    watching.lines = std::sync::mpsc::channel().1;
    let ended = (0..600).find_map(|round| {
        replace(&format!("{passes}# {round}\n"));
        std::thread::sleep(Duration::from_millis(500));
        watching.child.try_wait().unwrap()
    });
    assert_eq!(ended.and_then(|status| status.code()), Some(0));
}

#[test]
fn fail_fast_begins_no_case_after_the_first_failure() {
    let directory = directory("fail_fast");
    fs::rename(directory.join("golden/failing.toml"), directory.join("golden/a.toml")).unwrap();
    let output = opennck(&["test", "--fail-fast", "--jobs", "1"], &directory);
    assert_eq!(output.status.code(), Some(1));
    assert!(out(&output).ends_with("5 cases: 1 failed, 4 not run\n"), "{}", out(&output));
}

#[test]
fn reports_name_rules_files_and_times_and_show_the_signals_of_failures() {
    let directory = directory("reports");
    let output = opennck(&["test", "--format", "github", "--junit", "r.xml", "--html", "r.html"], &directory);
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    let annotation =
        "::error file=golden/failing.toml,line=5,title=golden/failing.toml::golden/failing.toml:5: expected `M0.1`";
    assert!(out(&output).contains(annotation), "{}", out(&output));
    let junit = fs::read_to_string(directory.join("r.xml")).unwrap();
    for words in [
        "name=\"golden/area/flags.toml [plc = enable_all, plant.X.start = 120.0]\" classname=\"golden.area\" time=\"",
        "file=\"golden/area/flags.toml\"",
        "<property name=\"rule\" value=\"REF-04\"/>",
        "<property name=\"rule\" value=\"REF-11\"/>",
        "name=\"golden/failing.toml\" classname=\"golden\"",
    ] {
        assert!(junit.contains(words), "{words} in {junit}");
    }
    let html = fs::read_to_string(directory.join("r.html")).unwrap();
    assert_eq!((html.matches("<svg").count(), html.matches("<h2").count()), (1, 1), "one failure");
    for words in ["<h1>5 cases: 4 passed, 1 failed</h1>", "M0.1 = 0", "REF-04 REF-11", "</html>"] {
        assert!(html.contains(words), "{words} in {html}");
    }
}

#[cfg(unix)]
#[test]
fn a_link_to_a_folder_above_shows_no_scenario_twice() {
    let directory = directory("cycle");
    std::os::unix::fs::symlink("../..", directory.join("golden/area/loop")).unwrap();
    assert_eq!(listed(&[], &directory).len(), 5);
}

#[cfg(unix)]
#[test]
fn a_link_that_cannot_be_followed_is_unusable_and_all_others_run() {
    let directory = directory("loops");
    std::os::unix::fs::symlink("loop.toml", directory.join("golden/loop.toml")).unwrap();
    std::os::unix::fs::symlink("loop", directory.join("golden/loop")).unwrap();
    std::os::unix::fs::symlink("nowhere.toml", directory.join("golden/area/gone.toml")).unwrap();
    let output = opennck(&["test", "golden"], &directory);
    assert_eq!(output.status.code(), Some(2), "{}", err(&output));
    assert!(out(&output).ends_with("7 cases: 4 passed, 1 failed, 2 unusable\n"), "{}", out(&output));
    assert!(err(&output).contains("golden/loop.toml: cannot be read: "), "{}", err(&output));
    assert!(err(&output).contains("golden/area/gone.toml: cannot be read: "), "{}", err(&output));
}

#[test]
fn characters_that_control_a_terminal_are_shown_by_their_codes_in_a_page_too() {
    let directory = directory("codes");
    let failing = "title = \"red \\u001b[31m\"\nmachine = \"g1_example\"\nwatch = [\"M0.*\"]\n[[step]]\nnote = \"back \\u0008 \\u202e\"\n\
        set = { \"M0.0\" = 1 }\n[[step]]\nexpect = \"M0.1\"\n";
    fs::write(directory.join("golden/failing.toml"), failing).unwrap();
    opennck(&["test", "golden/failing.toml", "--html", "r.html"], &directory);
    let html = fs::read_to_string(directory.join("r.html")).unwrap();
    assert!(html.contains("<p>red \\u{1b}[31m</p>"), "{html}");
    let controls = |c: char| c.is_control() && c != '\n' || c == '\u{202e}';
    assert!(!html.contains(controls), "{html:?}");
}

/// A scenario of 900 hours, which does not end by itself. The warning about its machine is printed when the outputs are open and the run begins.
#[cfg(unix)]
#[test]
fn a_signal_during_the_run_leaves_no_file_beside_the_outputs() {
    let directory = directory("interrupted");
    let machine = directory.join("machine");
    fs::create_dir_all(&machine).unwrap();
    fs::write(machine.join("plant.toml"), "[machine]\n").unwrap();
    let data = "N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X\"\nN32000 $MA_MAX_AX_VELO[AX1]=-5\n";
    fs::write(machine.join("data.tea"), data).unwrap();
    let long = "machine = \"machine\"\nlimit = \"1000h\"\n[[step]]\nrun = \"900h\"\n";
    fs::write(directory.join("long.toml"), long).unwrap();
    fs::write(directory.join("t.jsonl"), "old").unwrap();
    for signal in ["-INT", "-TERM"] {
        let mut command = processes::opennck();
        command.args(["run", "long.toml", "--trace", "t.jsonl", "--svg", "t.svg"]).current_dir(&directory);
        let mut child = command.stderr(Stdio::piped()).spawn().unwrap();
        let _ends = EndsWithTest::new(&child);
        let errors = BufReader::new(child.stderr.take().unwrap()).lines();
        assert!(errors.map_while(Result::ok).any(|line| line.contains("1 implausible")), "the run does not begin");
        assert_eq!(processes::end(&mut child, signal).code(), None, "the signal ends it");
    }
    let mut names: Vec<_> = fs::read_dir(&directory).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    assert_eq!(names, ["golden", "long.toml", "machine", "t.jsonl"]);
    assert_eq!(fs::read_to_string(directory.join("t.jsonl")).unwrap(), "old");
}

#[test]
fn no_output_is_an_input_or_another_output() {
    let directory = directory("apart");
    let machine = directory.join("machine");
    fs::create_dir_all(&machine).unwrap();
    fs::write(machine.join("plant.toml"), "[machine]\n").unwrap();
    fs::write(machine.join("data.tea"), "N10000 $MN_AXCONF_MACHAX_NAME_TAB[0]=\"X\"\n").unwrap();
    fs::write(directory.join("own.toml"), "machine = \"machine\"\n[[step]]\nrun = \"10ms\"\n").unwrap();
    let before = fs::read_to_string(directory.join("golden/area/flags.toml")).unwrap();
    for (arguments, words) in [
        (&["run", "own.toml", "--trace", "machine/plant.toml"][..], "this command also reads or writes, in "),
        (&["run", "own.toml", "--svg", "new.snap"], "found the name of an input: .snap"),
        (
            &["run", "own.toml", "--trace", "own.toml/x.jsonl"],
            "cannot be written: own.toml is a file, not a folder, for --trace",
        ),
        (&["run", "own.toml", "--trace", "f", "--vcd", "./f"], "found the file of --trace"),
        (&["test", "--junit", "golden/area/flags.toml"], "this command also reads or writes"),
        (&["test", "--flowchart", "golden/area/x.snap"], "found the name of an input: .snap"),
        (&["test", "--junit", "f", "--html", "f"], "found the file of --junit"),
    ] {
        let output = opennck(arguments, &directory);
        assert_eq!((output.status.code(), out(&output).as_str()), (Some(2), ""), "{arguments:?}: nothing runs");
        assert!(err(&output).contains(words), "{words} in {}", err(&output));
    }
    assert_eq!(fs::read_to_string(machine.join("plant.toml")).unwrap(), "[machine]\n");
    assert_eq!(fs::read_to_string(directory.join("golden/area/flags.toml")).unwrap(), before);
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_on_a_full_disk_ends_with_2_and_a_closed_one_does_not() {
    let directory = directory("full");
    let full = || fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    for arguments in [
        &["run", "golden/area/flags.toml"][..],
        &["test", "golden/area"],
        &["signals"],
        &["machine-data", "check", "g1_example"],
        &["--help"],
    ] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        let output = command.args(arguments).current_dir(&directory).stdout(full()).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert_eq!(err(&output).matches("standard output cannot be written").count(), 1, "{}", err(&output));
    }
    let shell = format!("{} signals | head -1 >/dev/null; exit ${{PIPESTATUS[0]}}", env!("CARGO_BIN_EXE_opennck"));
    let closed = Command::new("bash").args(["-c", &shell]).output().unwrap();
    assert_eq!((closed.status.code(), err(&closed).as_str()), (Some(0), ""));
    let trace = opennck(
        &["run", "golden/area/flags.toml", "--case", "gantry_start, plant.X.start = 120", "--trace", "/dev/full"],
        &directory,
    );
    assert!(err(&trace).contains("/dev/full: cannot be written: "), "{}", err(&trace));
    assert_eq!(trace.status.code(), Some(2));
}
