//! Recordings by `opennck serve` itself: a scenario in real time, crashes, and error messages.

use std::fs;
use std::io::{BufRead, BufReader, Lines};
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStderr, Command, Output, Stdio};
use std::time::{Duration, Instant};

use opennck::scenario::Scenario;

use super::panel::{Bare, DB, FLAGS, Item};
use crate::processes::{self, EndsWithTest};

/// `opennck serve` on any free port.
struct Program {
    child: Child,
    _ends: EndsWithTest,
    log: Lines<BufReader<ChildStderr>>,
    port: u16,
}

impl Program {
    /// Starts it in a new, empty folder.
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut program = processes::opennck();
        program.arg("serve").args(arguments).current_dir(folder);
        Self::started(program)
    }

    fn started(mut program: Command) -> Self {
        program.args(["--s7", "127.0.0.1:0"]).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = program.spawn().expect("the program was built");
        let ends = EndsWithTest::new(&child);
        let mut head = BufReader::new(child.stdout.take().expect("it is piped")).lines();
        let port = head.find_map(|line| line.ok()?.split_once("S7 on 127.0.0.1:")?.1.split(':').next()?.parse().ok());
        // Its output has no reader from here on.
        let log = BufReader::new(child.stderr.take().expect("it is piped")).lines();
        Self { child, _ends: ends, log, port: port.expect("the output has the port") }
    }

    fn address(&self) -> SocketAddr {
        SocketAddr::from(([127, 0, 0, 1], self.port))
    }

    /// Waits for a line of its log.
    #[track_caller]
    fn wait_for_log(&mut self, what: &str) -> String {
        let line = self.log.find(|line| line.as_ref().is_ok_and(|line| line.contains(what)));
        line.unwrap_or_else(|| panic!("it did not say: {what}")).expect("text")
    }

    fn end(&mut self, signal: &str) -> Option<i32> {
        processes::end(&mut self.child, signal).code()
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).expect("there is space");
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_opennck")).args(arguments).current_dir(folder).output().expect("it was built")
}

fn project(path: &str) -> String {
    format!("{}/{path}", env!("CARGO_MANIFEST_DIR"))
}

#[test]
#[cfg(unix)]
fn a_scenario_acts_in_real_time_as_it_runs_and_is_recorded() {
    let folder = folder("acts");
    let scenario = project("golden/worked_example/gantry_references_and_synchronises.toml");
    let arguments = ["--scenario", &scenario, "--speed", "50", "--record", "again.toml", "--trace", "live.jsonl"];
    let mut program = Program::start(&folder, &arguments);
    let mut client = Bare::connect(program.address());
    program.wait_for_log("the scenario passed");
    // The machine is still served, and later writes of clients are recorded as well.
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 77, &[7])]), [0xFF]);
    assert_eq!(program.end("-TERM"), Some(0));
    let live = fs::read_to_string(folder.join("live.jsonl")).unwrap();
    let recording = fs::read_to_string(folder.join("again.toml")).unwrap();
    for said in ["# 0.002 s: the scenario", "note = \"JOG with machine function REF\"", "MB77", "plc = \"enable_all\""]
    {
        assert!(recording.contains(said), "no {said} in\n{recording}");
    }
    for (scenario, trace) in [(scenario.as_str(), "run.jsonl"), ("again.toml", "again.jsonl")] {
        let output = run(&folder, &["run", scenario, "--trace", trace]);
        assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    }
    assert!(live == fs::read_to_string(folder.join("again.jsonl")).unwrap());
    // Running as fast as possible gives the same as real time, up to its end.
    let alone = fs::read_to_string(folder.join("run.jsonl")).unwrap();
    assert!(live.starts_with(&alone), "{} bytes, then {}", alone.len(), live.len());
}

#[test]
#[cfg(unix)]
fn a_scenario_brings_its_plant_profile_and_image_into_the_recording() {
    let folder = folder("brings");
    let scenario = "machine = \"g1_example\"\nplc_image = \"image.toml\"\nprofile = \"828d\"\nwatch = [\"Y.slide\", \"Y.*\"]\n\
        [plant.Y]\nstart = 12.5\n[[step]]\nset = { MW90 = 5 }\n[[step]]\nrun = \"1s\"\n\
        [[step]]\nexpect = \"Y.position > 1000\"\n[[step]]\nset = { \"M0.0\" = 1 }\n";
    fs::write(folder.join("mine.toml"), scenario).unwrap();
    fs::copy(project("plc_images/recipes.toml"), folder.join("image.toml")).unwrap();
    let arguments = ["--scenario", "mine.toml", "--speed", "20", "--record", "again.toml", "--trace", "live.jsonl"];
    let mut program = Program::start(&folder, &arguments);
    // The step that fails ends the scenario and is logged; the server keeps running.
    let line = program.wait_for_log("the scenario failed");
    assert!(line.contains("mine.toml:12") && line.contains("Y.position > 1000"), "{line}");
    drop(Bare::connect(program.address()));
    assert_eq!(program.end("-INT"), Some(0));
    let output = run(&folder, &["run", "again.toml", "--trace", "again.jsonl"]);
    let recording = fs::read_to_string(folder.join("again.toml")).unwrap();
    assert_eq!(output.status.code(), Some(0), "{}{recording}", String::from_utf8_lossy(&output.stderr));
    let live = fs::read_to_string(folder.join("live.jsonl")).unwrap();
    assert!(live.contains("\"symbol\":\"Y.slide\",\"value\":12.5"), "{live}");
    assert!(live == fs::read_to_string(folder.join("again.jsonl")).unwrap(), "{recording}");
    for said in ["profile = \"828d\"", "plc_image = \"image.toml\"", "plant = { \"Y\" = { \"start\" = 12.5 } }"] {
        assert!(recording.contains(said), "no {said} in\n{recording}");
    }
    assert!(!recording.contains("M0.0"), "steps after a failed step must not be executed:\n{recording}");
}

#[test]
#[cfg(unix)]
fn with_exit_the_server_ends_with_its_scenario() {
    let folder = folder("exits");
    let scenario = "machine = \"g1_example\"\n[[step]]\nrun = \"100ms\"\n[[step]]\nexpect = \"M0.0 == 0\"\n";
    fs::write(folder.join("good.toml"), scenario).unwrap();
    fs::write(folder.join("bad.toml"), scenario.replace("== 0", "== 1")).unwrap();
    for (name, code) in [("good.toml", 0), ("bad.toml", 1)] {
        let trace = format!("{name}.jsonl");
        let arguments = ["serve", "--scenario", name, "--exit", "--s7", "127.0.0.1:0", "--trace", &trace];
        let output = run(&folder, &arguments);
        assert_eq!(output.status.code(), Some(code), "{}", String::from_utf8_lossy(&output.stderr));
        assert!(folder.join(&trace).is_file());
    }
}

#[test]
#[cfg(unix)]
fn a_closed_terminal_ends_the_server_with_its_trace_and_a_long_trace_has_an_end() {
    let folder = folder("hangup");
    let scenario =
        "machine = \"g1_example\"\nwatch = [\"M0.*\"]\n[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"100ms\"\n";
    fs::write(folder.join("s.toml"), scenario).unwrap();
    let mut program = Program::start(&folder, &["--scenario", "s.toml", "--trace", "t.jsonl"]);
    program.wait_for_log("the scenario passed");
    assert_eq!(program.end("-HUP"), Some(0));
    assert!(fs::read_to_string(folder.join("t.jsonl")).unwrap().contains("\"signal\":\"M0.0\""));
    let counts = "machine = \"g1_example\"\nlimit = \"1h\"\nwatch = [\"X.position\", \"M0.2\"]\n[[step]]\nset = { \"M0.0\" = 1 }\n\
        [[step]]\npulse = [\"M0.1\"]\nfor = \"1cycles\"\n[[step]]\ninclude = \"more.toml\"\ntimes = 80000\n";
    fs::write(
        folder.join("more.toml"),
        "[[step]]\npulse = [\"M0.2\"]\nfor = \"1cycles\"\n[[step]]\nrun = \"1cycles\"\n",
    )
    .unwrap();
    fs::write(folder.join("long.toml"), counts).unwrap();
    let arguments = ["--scenario", "long.toml", "--speed", "1000", "--trace", "t.jsonl", "--trace-limit", "1"];
    let mut program = Program::start(&folder, &arguments);
    program.wait_for_log("the trace has reached its limit of 1 MiB and ends; the machine keeps running");
    assert_eq!(program.end("-TERM"), Some(0));
    let trace = fs::read_to_string(folder.join("t.jsonl")).unwrap();
    let last = trace.lines().last().unwrap();
    assert!(last.contains("the trace ends here: it has reached its limit of 1 MiB"), "{last}");
}

#[test]
#[cfg(unix)]
fn a_crash_loses_at_most_one_second() {
    let folder = folder("killed");
    let mut program = Program::start(&folder, &["g1_example", "--record", "killed.toml"]);
    let mut client = Bare::connect(program.address());
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[11])]), [0xFF]);
    let text = || fs::read_to_string(folder.join("killed.toml")).unwrap();
    let cycles = |text: &str| -> u64 {
        let run = |line: &str| line.strip_prefix("run = \"")?.strip_suffix("cycles\"")?.parse::<u64>().ok();
        text.lines().filter_map(run).sum()
    };
    // The file is written to the disk repeatedly, not only at the end.
    let begin = Instant::now();
    while cycles(&text()) < 700 {
        assert!(begin.elapsed() < Duration::from_secs(30), "{}", text());
        std::thread::sleep(Duration::from_millis(50));
    }
    program.end("-KILL");
    let text = text();
    assert!(text.contains("\"MB1\" = 11"), "{text}");
    assert_eq!(run(&folder, &["run", "killed.toml"]).status.code(), Some(0));
}

#[test]
#[cfg(unix)]
fn a_full_disk_ends_the_recording_and_not_the_machine() {
    let folder = folder("full");
    let mut shell = Command::new("sh");
    // The maximum file size is 4096 bytes, and a longer write returns an error.
    let line = "trap '' XFSZ; ulimit -f 8; exec \"$0\" serve g1_example --record full.toml \"$@\"";
    shell.args(["-c", line, env!("CARGO_BIN_EXE_opennck")]).current_dir(&folder);
    let mut program = Program::started(shell);
    let mut client = Bare::connect(program.address());
    for round in 0..200 {
        assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[round, 2, 3, 4, 5, 6, 7, 8])]), [0xFF]);
    }
    let line = program.wait_for_log("the recording ends");
    assert!(line.contains("full.toml cannot be written"), "{line}");
    assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[9])]), [0xFF]);
    assert_eq!(program.end("-TERM"), Some(0));
    let text = fs::read_to_string(folder.join("full.toml")).unwrap();
    assert!(text.len() <= 4096 && Scenario::parse(&text, Path::new("full.toml")).is_ok(), "{text}");
}

#[test]
fn errors_of_a_recording_name_the_cause() {
    let folder = folder("errors");
    fs::write(folder.join("old.toml"), "mine").unwrap();
    fs::write(folder.join("wrong.toml"), "machine = \"g1_example\"\n[[step]]\nsett = { \"M0.0\" = 1 }\n").unwrap();
    let taken = TcpListener::bind("127.0.0.1:0").unwrap();
    let taken = taken.local_addr().unwrap().to_string();
    for (arguments, said) in [
        (vec!["g1_example", "--record", "old.toml"], ["old.toml: the file exists already", "does not overwrite"]),
        (vec!["g1_example", "--record", "none/new.toml"], ["none/new.toml", "check the path"]),
        (vec!["g1_example", "--record", "new.toml", "--s7", &taken], ["the port is in use", "--s7"]),
        (vec!["--scenario", "wrong.toml"], ["wrong.toml:3", "`sett`"]),
        (vec!["--scenario", "none.toml"], ["none.toml", "cannot be read"]),
        (vec![], ["<MACHINE>", "required"]),
        (vec!["g1_example", "--record", "new.toml", "--image", "new.image"], ["--record", "--image"]),
    ] {
        let output = run(&folder, &[&["serve"], arguments.as_slice()].concat());
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
        assert!(said.iter().all(|said| error.contains(said)), "{arguments:?}: {error}");
    }
    assert_eq!(fs::read(folder.join("old.toml")).unwrap(), b"mine");
    assert!(!folder.join("new.toml").exists(), "it would block the next attempt");
}

/// The commands of `docs/serving.md`, unchanged.
#[test]
#[cfg(unix)]
fn the_session_of_the_pages_is_recorded_and_runs_again() {
    let folder = folder("serving");
    let page = fs::read_to_string(project("docs/serving.md")).unwrap();
    let mut blocks = page.split("```sh\n").skip(1).filter_map(|block| block.split("```").next());
    let block = blocks.find(|block| block.contains("--record")).unwrap();
    let mut lines = block.lines().map(|line| line.split_whitespace().skip(1).collect::<Vec<_>>());
    let (serve, again) = (lines.next().unwrap(), lines.next().unwrap());
    let mut program = Program::start(&folder, &serve[1..]);
    let mut client = Bare::connect(program.address());
    assert_eq!(client.write(&[Item::bit((DB, 32), 4, 7, true)]), [0xFF]);
    assert_eq!(program.end("-INT"), Some(0));
    let output = run(&folder, &again);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("Y.traversing_key_plus"));
}

/// At these speeds a step takes two seconds, or a thousandth of that: requests are answered, and the program ends at
/// once.
#[test]
#[cfg(unix)]
fn the_slowest_and_the_fastest_machine_answer_and_end() {
    for speed in ["0.001", "1000"] {
        let folder = folder("speeds");
        let mut program = Program::start(&folder, &["g1_example", "--speed", speed, "--record", "speed.toml"]);
        let mut client = Bare::connect(program.address());
        assert_eq!(client.write(&[Item::bytes((FLAGS, 0), 1, &[1])]), [0xFF]);
        let begin = Instant::now();
        assert_eq!(program.end("-TERM"), Some(0));
        assert!(begin.elapsed() < Duration::from_secs(10));
        assert_eq!(run(&folder, &["run", "speed.toml"]).status.code(), Some(0));
    }
}
