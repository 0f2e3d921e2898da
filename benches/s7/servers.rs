//! The measured servers, each a separate process.

use std::io::{self, BufRead, BufReader, Read};
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::load::{BLOCK, BYTES};

/// The version of python-snap7 with the native library; later versions are written in Python.
const SNAP7: &str = "python-snap7==2.1.0";
/// The variable that names a Python with this package.
const SNAP7_PYTHON: &str = "OPENNCK_SNAP7_PYTHON";

/// A server in a separate process.
pub(crate) struct Server {
    pub(crate) name: &'static str,
    pub(crate) address: SocketAddr,
    pub(crate) knows_s7: bool,
    child: Child,
    _input: Option<ChildStdin>,
    said: Option<JoinHandle<String>>,
}

impl Server {
    /// This simulator as users start it: a machine in real time, a PLC program, user data blocks.
    pub(crate) fn opennck() -> io::Result<Self> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_opennck"));
        command.args(["serve", "g1_example", "--plc", "enable_all", "--plc-image", "recipes", "--s7", "127.0.0.1:0"]);
        let (child, input, port) = start(command.current_dir(env!("CARGO_MANIFEST_DIR")), |line| {
            line.split_once("S7 on 127.0.0.1:")?.1.split(':').next()?.parse().ok()
        })?;
        Ok(Self::new("opennck", port, true, child, input))
    }

    /// This program again, as the echo.
    pub(crate) fn echo() -> io::Result<Self> {
        let (child, input, port) = start(Command::new(std::env::current_exe()?).arg("--echo"), |line| {
            line.strip_prefix("ready ")?.parse().ok()
        })?;
        Ok(Self::new("echo", port, false, child, input))
    }

    /// snap7's own server.
    pub(crate) fn snap7() -> io::Result<Self> {
        let python = python()?;
        let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/s7/snap7_server.py");
        let arguments = [port.to_string(), BLOCK.to_string(), BYTES.to_string()];
        let (child, input, port) =
            start(Command::new(python).arg(script).args(arguments), |line| (line == "ready").then_some(port))?;
        Ok(Self::new("snap7", port, true, child, input))
    }

    fn new(name: &'static str, port: u16, knows_s7: bool, mut child: Child, input: Option<ChildStdin>) -> Self {
        let said = child.stderr.take().map(|mut stream| {
            std::thread::spawn(move || {
                let mut said = Vec::new();
                let _ = stream.read_to_end(&mut said);
                String::from_utf8_lossy(&said).into_owned()
            })
        });
        Self { name, address: ([127, 0, 0, 1], port).into(), knows_s7, child, _input: input, said }
    }

    fn file(&self, name: &str) -> String {
        std::fs::read_to_string(format!("/proc/{}/{name}", self.child.id())).unwrap_or_default()
    }

    /// The processor time so far: all threads, user mode and kernel mode.
    pub(crate) fn processor(&self) -> Duration {
        let stat = self.file("stat");
        let fields: Vec<_> = stat.rsplit(')').next().unwrap_or_default().split_whitespace().collect();
        // Fields 14 and 15, counted from 1 with two before the bracket, in ticks of 1/100 s on Linux.
        let ticks = |at: usize| fields.get(at).and_then(|field| field.parse().ok()).unwrap_or(0_u64);
        Duration::from_millis(10 * (ticks(11) + ticks(12)))
    }

    /// Its resident memory in bytes.
    pub(crate) fn memory(&self) -> u64 {
        let status = self.file("status");
        let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
        1024 * line.split_whitespace().next().and_then(|number| number.parse::<u64>().ok()).unwrap_or(0)
    }

    /// Its number of open files and sockets.
    pub(crate) fn handles(&self) -> usize {
        std::fs::read_dir(format!("/proc/{}/fd", self.child.id())).map_or(0, Iterator::count)
    }

    /// Ends it; returns its output.
    pub(crate) fn end(mut self) -> String {
        let id = self.child.id().to_string();
        let asked = Command::new("kill").args(["-INT", &id]).status();
        if self.name != "opennck" || !asked.is_ok_and(|status| status.success()) {
            let _ = self.child.kill();
        }
        let _ = self.child.wait();
        self.said.take().and_then(|said| said.join().ok()).unwrap_or_default()
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// Starts a process, and waits for the line of output with its port.
fn start(command: &mut Command, port: impl Fn(&str) -> Option<u16>) -> io::Result<(Child, Option<ChildStdin>, u16)> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()?;
    let output = child.stdout.take().map(BufReader::new);
    for line in output.into_iter().flat_map(BufRead::lines) {
        if let Some(port) = port(&line?) {
            let input = child.stdin.take();
            return Ok((child, input, port));
        }
    }
    let said = child.wait_with_output()?;
    Err(io::Error::other(format!("it ended: {}", String::from_utf8_lossy(&said.stderr).trim())))
}

/// A Python with snap7's library: the one named by the variable, else one installed below the target folder.
fn python() -> io::Result<PathBuf> {
    if let Some(python) = std::env::var_os(SNAP7_PYTHON) {
        return Ok(python.into());
    }
    let own = Path::new(env!("CARGO_TARGET_TMPDIR")).join("snap7");
    let python = own.join("bin/python");
    let is_there = |python: &Path| {
        let check = Command::new(python).args(["-c", "import snap7"]).stderr(Stdio::null()).status();
        check.is_ok_and(|status| status.success())
    };
    if !is_there(&python) {
        eprintln!("installing {SNAP7} below the target folder; set {SNAP7_PYTHON} to use a Python that has it already");
        run(Command::new("python3").args(["-m", "venv"]).arg(&own))?;
        run(Command::new(&python).args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", SNAP7]))?;
    }
    Ok(python)
}

fn run(command: &mut Command) -> io::Result<()> {
    let said = command.output()?;
    let error = || String::from_utf8_lossy(&said.stderr).trim().to_owned();
    if said.status.success() { Ok(()) } else { Err(io::Error::other(error())) }
}
