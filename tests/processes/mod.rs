//! Processes that tests start: none outlives its test, and signals have their default action.
#![allow(dead_code, reason = "each test binary uses its part")]
#![expect(clippy::disallowed_methods, reason = "processes end in real time")]

use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

/// Ends a process when the test was killed, or fails, and cannot do it: a shell reads from a pipe, which the system closes with the test.
#[derive(Debug)]
pub(crate) struct EndsWithTest(Option<Child>);

impl EndsWithTest {
    pub(crate) fn new(child: &Child) -> Self {
        if cfg!(not(unix)) {
            return Self(None);
        }
        let mut shell = Command::new("sh");
        shell.args(["-c", "read line; kill -KILL \"$0\"", &child.id().to_string()]);
        let shell = shell.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        Self(Some(shell.expect("there is a shell")))
    }
}

impl Drop for EndsWithTest {
    fn drop(&mut self) {
        if let Some(shell) = &mut self.0 {
            // A test that passes has ended the process, and another one may have its number: the shell ends before its pipe closes.
            if !std::thread::panicking() {
                let _ = shell.kill();
            }
            let _ = shell.wait();
        }
    }
}

/// `opennck`, which a signal ends as usual: `nohup` and a shell that runs a job in the background let their programs ignore SIGHUP or SIGINT,
/// and each program passes that on to those it starts.
pub(crate) fn opennck() -> Command {
    let program = env!("CARGO_BIN_EXE_opennck");
    // Signals 1 (SIGHUP), 2 (SIGINT) and 15 (SIGTERM) are the bits 0, 1 and 14.
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| u64::from_str_radix(line.strip_prefix("SigIgn:")?.trim(), 16).ok());
    if ignored.unwrap_or(0) & 0x4003 == 0 {
        return Command::new(program);
    }
    let mut command = Command::new("env");
    command.args(["--default-signal=HUP,INT,TERM", program]);
    command
}

/// Sends a signal (`-INT`) and waits for the end. The time-out is only for a process that does not end.
#[track_caller]
pub(crate) fn end(child: &mut Child, signal: &str) -> ExitStatus {
    let id = child.id().to_string();
    assert!(Command::new("kill").args([signal, &id]).status().expect("there is a kill").success());
    let begin = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("it is a child") {
            return status;
        }
        if begin.elapsed() > Duration::from_secs(120) {
            let _ = child.kill();
            let _ = child.wait();
            panic!("it does not end after kill {signal}");
        }
        std::thread::sleep(Duration::from_millis(10));
    }
}
