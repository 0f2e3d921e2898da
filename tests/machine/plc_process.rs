//! A PLC program in another process that `run` and `test` start: in lock-step with the same trace as a closure, and with an end in each case.
//! If python3 is missing, the tests say so on standard error and check the rest.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::disallowed_methods, reason = "these tests wait for other processes")]
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::{Duration, Instant};

/// The same program as `enable_all`.
const ENABLES: &str = "
import sys, time
from opennck_image import Image
with Image(sys.argv[1]) as image:
    for step in image.steps():
        for db in (31, 32, 33):
            for bit in ('1.5', '2.1', '21.7'):
                step[f'DB{db}.DBX{bit}'] = 1
        MORE
        image.answer(step)
";

const SCENARIO: &str = "machine = \"g1_example\"\nPLC\nwatch = [\"X.*\", \"MW20\"]\nlimit = \"20s\"\n[[step]]\nrun = \"100ms\"\n\
    [[step]]\nset = { \"DB11.DBX1.2\" = 1 }\n[[step]]\npulse = [\"X.traversing_key_plus\"]\n[[step]]\nrun = \"1s\"\n";

fn directory(name: &str) -> PathBuf {
    let directory = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join("plc_process").join(name);
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).expect("the target directory is writable");
    directory
}

fn write(directory: &Path, name: &str, plc: &str, more: &str) {
    let scenario = SCENARIO.replace("PLC", plc);
    fs::write(directory.join(format!("{name}.toml")), scenario).unwrap();
    fs::write(directory.join(format!("{name}.py")), ENABLES.replace("MORE", more)).unwrap();
}

fn has_python() -> bool {
    let has = Command::new("python3").arg("--version").output().is_ok();
    if !has {
        eprintln!("NOT CHECKED: there is no python3 here, so no PLC in Python has run");
    }
    has
}

fn opennck(arguments: &[&str], directory: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    let module = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/python_plc");
    command.env("PYTHONPATH", module).env("PYTHONDONTWRITEBYTECODE", "1");
    command.args(arguments).current_dir(directory).output().expect("the program was built")
}

fn err(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Whether a process runs whose command has this text.
fn is_left(text: &str) -> bool {
    let processes = fs::read_dir("/proc").into_iter().flatten().flatten();
    processes.into_iter().any(|process| {
        let command = fs::read(process.path().join("cmdline")).unwrap_or_default();
        String::from_utf8_lossy(&command).contains(text)
    })
}

/// The names of the files that this NC has made for its PLC processes.
#[cfg(target_os = "linux")]
fn left_files(nc: u32) -> Vec<PathBuf> {
    let folders = [PathBuf::from("/dev/shm"), std::env::temp_dir()];
    let files = folders.iter().filter_map(|folder| fs::read_dir(folder).ok()).flatten().flatten();
    let own = format!("opennck-{nc}-");
    files.map(|file| file.path()).filter(|path| path.to_string_lossy().contains(&own)).collect()
}

#[test]
fn a_program_in_python_has_the_golden_file_of_a_closure() {
    if !has_python() {
        return;
    }
    let directory = directory("same");
    write(&directory, "closure", "plc = \"enable_all\"", "pass");
    write(&directory, "python", "plc = { process = \"python3 python.py {image}\" }", "pass");
    let accepted = opennck(&["test", ".", "--accept"], &directory);
    assert_eq!(accepted.status.code(), Some(0), "{}", err(&accepted));
    let body = |name: &str| {
        let text = fs::read_to_string(directory.join(name)).unwrap();
        text.split_once("\n---\n").unwrap().1.replace("closure", "python")
    };
    assert!(body("closure.snap").contains("X.traverse_command_plus"), "{}", body("closure.snap"));
    assert_eq!(body("closure.snap"), body("python.snap"));
    let again = opennck(&["test", ".", "--jobs", "2"], &directory);
    assert_eq!(again.status.code(), Some(0), "{}", err(&again));
    // `run` starts the same process for a scenario that names none.
    let traced = |scenario: &str, process: &[&str], trace: &str| {
        let output = opennck(&[&["run", scenario, "--trace", trace], process].concat(), &directory);
        assert_eq!(output.status.code(), Some(0), "{}", err(&output));
        fs::read_to_string(directory.join(trace)).unwrap()
    };
    let process = ["--plc-process", "python3 'python.py' {image}"];
    assert_eq!(traced("closure.toml", &process, "a.jsonl"), traced("python.toml", &[], "b.jsonl"));
    assert!(!is_left("python.py"));
}

#[test]
fn a_process_that_does_not_start_or_attach_is_unusable_and_one_that_ends_or_hangs_fails() {
    if !has_python() {
        return;
    }
    let directory = directory("ends");
    let process = |name: &str| format!("plc = {{ process = \"python3 {name}.py {{image}}\", timeout = \"2s\" }}");
    write(&directory, "dies", &process("dies"), "if step.cycle == 20: print('nothing to do'); sys.exit(3)");
    write(&directory, "hangs", &process("hangs"), "if step.cycle == 20: time.sleep(1000)");
    write(&directory, "wrong", &process("wrong"), "step['DB99.DBX0.0'] = 1");
    for (name, statement) in
        [("nck", "step['DB31.DBX101.4'] = 1"), ("text", "step['DB31.DBX4.7'] = '0'"), ("large", "step['MB0'] = 300")]
    {
        write(&directory, name, &process(name), statement);
    }
    write(&directory, "unstarted", "plc = { process = \"no_such_program {image}\" }", "");
    write(&directory, "unattached", "plc = { process = \"sleep {image} 1000\", timeout = \"2s\" }", "");
    write(&directory, "imageless", "plc = { process = \"python3 dies.py\" }", "");
    write(&directory, "power", &process("power"), "image.power_off_and_on()");
    for (name, code, words) in [
        ("dies", 1, "dies.toml:2: the PLC process `python3 dies.py {image}` ended while the NC runs (exit status: 3)"),
        ("dies", 1, "it printed: nothing to do"),
        ("hangs", 1, "hangs.toml:2: no answer from the PLC process for 2s"),
        ("wrong", 1, "it printed: LookupError: DB99.DBX0.0: the image does not have this byte"),
        ("nck", 1, "it printed: ValueError: DB31.DBX101.4: the NCK writes this byte"),
        ("text", 1, "it printed: TypeError: DB31.DBX4.7: expected a number or a truth value, found '0'"),
        ("large", 1, "it printed: ValueError: MB0: expected a number from -128 to 255, found 300"),
        ("unstarted", 2, "unstarted.toml:2: the PLC process `no_such_program {image}` cannot be started"),
        ("unattached", 2, "unattached.toml:2: the PLC process `sleep {image} 1000` ended before it opened the image"),
        (
            "imageless",
            2,
            "imageless.toml:2: expected a command such as `python3 plc.py {image}`, found `python3 dies.py`",
        ),
        ("power", 1, "in a scenario a step does this: power_on = true"),
    ] {
        let begin = Instant::now();
        let output = opennck(&["test", &format!("{name}.toml")], &directory);
        assert_eq!(output.status.code(), Some(code), "{name}: {}", err(&output));
        assert!(err(&output).contains(words), "{name}: {words} in {}", err(&output));
        assert!(begin.elapsed() < Duration::from_secs(30), "{name}");
        assert!(!is_left(&format!("{name}.py")), "{name}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_process_whose_nc_was_killed_ends_by_itself() {
    if !has_python() {
        return;
    }
    let directory = directory("killed");
    write(
        &directory,
        "orphan",
        "plc = { process = \"python3 orphan.py {image}\" }",
        "open('opened', 'w').close(); time.sleep(0.01)",
    );
    let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
    let module = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/python_plc");
    command.env("PYTHONPATH", module).env("PYTHONDONTWRITEBYTECODE", "1").args(["test", "orphan.toml"]);
    let mut child = command.current_dir(&directory).spawn().unwrap();
    let _ends = crate::processes::EndsWithTest::new(&child);
    let wait = |is_over: &dyn Fn() -> bool, what: &str| {
        let begin = Instant::now();
        while !is_over() {
            assert!(begin.elapsed() < Duration::from_secs(30), "{what}");
            std::thread::sleep(Duration::from_millis(20));
        }
    };
    wait(&|| is_left("orphan.py"), "it starts");
    let id = child.id();
    // It has written the mark when it had opened the image.
    wait(&|| directory.join("opened").exists(), "it opens the image");
    wait(&|| left_files(id).is_empty(), "its files have no names any more");
    child.kill().unwrap();
    child.wait().unwrap();
    wait(&|| !is_left("orphan.py"), "it ends");
}
