//! A PLC program in another process, which the simulator starts and ends: `plc = { process = "python3 plc.py {image}" }` in a scenario.
//!
//! The process maps a file of its own (in memory where the system has `/dev/shm`), in lock-step. It starts before the first step, and the
//! first step waits until it has opened the file: a program that does not start, or never opens the file, is an error of the scenario. One
//! that ends or is silent during the run is a fault of the PLC, as in [`MappedPlc`]: alarm 2000, with the last lines that it printed. At the
//! end the process sees that the NC has ended, and has two seconds to end by itself; then it is killed. In each case it is waited for. This
//! concerns the process of the command itself: one that it starts in turn must end when it ends, or when the image shows the end of the NC.
//!
//! What the process prints goes into a file in the temporary directory, and the end of it into messages. On Unix both files have no name from
//! the time on at which the process has opened the image, so they go with the two processes, even if both are killed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use super::mapped_plc::{Exchange, MappedPlc};
use crate::image::{AsBytes, Memory, Names};
use crate::plc::{PlcFault, PlcIo, PlcProcess, PlcProgram, Programs};
use crate::source::{Problem, decode};
use crate::units::Time;

/// Tells a process that it was started for one NC: it ends with this NC, even if the NC ended before it opened the file.
const STARTED: &str = "OPENNCK_STARTED";

/// How long the process may take to end by itself.
const LAST: Duration = Duration::from_secs(2);
/// Polling interval while a process starts or ends.
const INTERVAL: Duration = Duration::from_millis(2);
/// The number of lines of its output in a message.
const LINES: usize = 8;
/// How much of the end of its output is read for them.
const OUTPUT_BYTES: u64 = 64 * 1024;
/// In the command, the mapped file.
const IMAGE: &str = "{image}";

/// Tells apart the files of this process.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Adds PLC programs in other processes to these programs.
#[must_use]
pub fn with_processes(programs: Programs) -> Programs {
    programs.with_processes(|process, memory, names, cycle| {
        Ok(Box::new(ProcessProgram::create(process, memory, names, cycle)?))
    })
}

/// A PLC program in a process of its own.
struct ProcessProgram {
    mapped: MappedPlc,
    process: PlcProcess,
    time_out: Duration,
    words: Vec<String>,
    files: Files,
    /// The process, once it runs.
    child: Option<Arc<Mutex<Child>>>,
    /// The counts of the file when the process had opened it.
    counts: [u64; 2],
}

/// The files of the exchange. Their names are removed at the end, or before.
struct Files {
    image: PathBuf,
    log: PathBuf,
    have_names: bool,
    /// What the process prints, open for reading; none if it prints to the output of this process.
    printed: Option<Arc<File>>,
}

impl Files {
    fn new(name: &str) -> Self {
        let (in_memory, temporary) = (Path::new("/dev/shm"), std::env::temp_dir());
        let folder = if in_memory.is_dir() { in_memory } else { &temporary };
        let (image, log) = (folder.join(format!("{name}.image")), temporary.join(format!("{name}.log")));
        let mut files = Self { image, log, have_names: true, printed: None };
        // Those of an earlier process with the same number.
        files.remove_names();
        files.have_names = true;
        files
    }

    /// Creates the file for what the process prints. It must be new: others can write to the temporary directory.
    fn create_log(&mut self) -> io::Result<File> {
        let log = OpenOptions::new().write(true).create_new(true).open(&self.log)?;
        self.printed = Some(Arc::new(File::open(&self.log)?));
        Ok(log)
    }

    /// The processes that have opened the files keep them.
    fn remove_names(&mut self) {
        if std::mem::take(&mut self.have_names) {
            let _ = fs::remove_file(&self.image);
            let _ = fs::remove_file(&self.log);
        }
    }
}

impl Drop for Files {
    fn drop(&mut self) {
        self.remove_names();
    }
}

impl ProcessProgram {
    fn create(process: &PlcProcess, memory: &Memory, names: &Names, cycle: Time) -> Result<Self, Problem> {
        let words = words(&process.command)?;
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let files = Files::new(&format!("opennck-{}-{number}", std::process::id()));
        let time_out = Duration::from_nanos(u64::try_from(process.time_out.nanos()).unwrap_or(0));
        let exchange = Exchange { lock_step: true, time_out };
        let mapped = MappedPlc::of(&files.image, memory, names, cycle, exchange)?;
        Ok(Self { mapped, process: process.clone(), time_out, words, files, child: None, counts: [0; 2] })
    }

    /// Starts the process and waits until it has opened the file.
    fn start(&mut self) -> Result<(), Problem> {
        let program = &self.process.command;
        let unstarted = |error: io::Error| {
            Problem::new(
                format!("the PLC process `{program}` cannot be started: {error}"),
                format!("check the command; it runs in {}", shown(&self.process.directory)),
            )
        };
        let image = self.files.image.to_string_lossy();
        let mut words = self.words.iter().map(|word| word.replace(IMAGE, &image));
        let mut command = Command::new(words.next().unwrap_or_default());
        command.args(words).stdin(Stdio::null()).env(STARTED, "1");
        if !self.process.directory.as_os_str().is_empty() {
            command.current_dir(&self.process.directory);
        }
        if self.process.is_shown {
            command.stdout(io::stderr()).stderr(Stdio::inherit());
        } else {
            let log = self.files.create_log().map_err(unstarted)?;
            command.stdout(log.try_clone().map_err(unstarted)?).stderr(log);
        }
        let child = Arc::new(Mutex::new(command.spawn().map_err(unstarted)?));
        self.child = Some(Arc::clone(&child));
        let begin = Instant::now();
        while !self.mapped.is_opened() {
            if let Some(how) = ended(&child) {
                let what =
                    format!("the PLC process `{program}` ended before it opened the image ({how}){}", self.said());
                return Err(Problem::new(
                    what,
                    "start the program by hand to see why; it opens the file in place of {image}",
                ));
            }
            if begin.elapsed() > self.time_out {
                let limit = self.time_out;
                let what =
                    format!("the PLC process `{program}` did not open the image within {limit:?}{}", self.said());
                return Err(Problem::new(
                    what,
                    "open the file in place of {image} with `Image(path)`, or raise `timeout`",
                ));
            }
            std::thread::sleep(INTERVAL);
        }
        self.counts = self.mapped.counts();
        if cfg!(unix) {
            self.files.remove_names();
        }
        let (printed, command) = (self.files.printed.clone(), program.clone());
        self.mapped.notice_end(move || {
            let how = ended(&child)?;
            Some(format!(
                "the PLC process `{command}` ended while the NC runs ({how}){}",
                last_lines(printed.as_deref())
            ))
        });
        Ok(())
    }

    /// The last lines that the process printed.
    fn said(&self) -> String {
        last_lines(self.files.printed.as_deref())
    }

    /// The requests of the process that nobody grants here.
    fn refuse_requests(&self) -> Result<(), PlcFault> {
        let [starts, powers] = self.mapped.counts();
        let [starts_before, powers_before] = self.counts;
        if starts != starts_before {
            return Err(PlcFault::new(
                "the image was opened again: a PLC in a scenario is one process that opens it once".to_owned(),
            ));
        }
        if powers != powers_before {
            return Err(PlcFault::new(
                "the PLC process asks for power off and on; in a scenario a step does this: power_on = true".to_owned(),
            ));
        }
        Ok(())
    }
}

impl PlcProgram for ProcessProgram {
    fn name(&self) -> &str {
        &self.process.command
    }

    fn begin(&mut self) -> Result<(), Problem> {
        if self.child.is_some() { Ok(()) } else { self.start() }
    }

    fn startup(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        self.begin().map_err(|problem| PlcFault::new(problem.to_string()))?;
        self.mapped.startup(io)
    }

    fn scan(&mut self, io: &mut PlcIo<'_, AsBytes>) -> Result<(), PlcFault> {
        let scanned = self.mapped.scan(io).map_err(|fault| match self.said() {
            said if fault.reason.ends_with(&said) => fault,
            said => PlcFault::new(fault.reason + &said),
        });
        scanned.and_then(|()| self.refuse_requests())
    }

    fn save(&self) -> Vec<u8> {
        self.mapped.save()
    }

    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem> {
        self.mapped.restore(saved)
    }

    fn fork(&self) -> Option<Box<dyn PlcProgram>> {
        None
    }

    fn reset(&mut self) {
        self.mapped.reset();
    }
}

impl Drop for ProcessProgram {
    fn drop(&mut self) {
        let Some(child) = &self.child else { return };
        self.mapped.end();
        let begin = Instant::now();
        while ended(child).is_none() {
            if begin.elapsed() > LAST {
                let mut child = child.lock().unwrap_or_else(PoisonError::into_inner);
                let _ = child.kill();
                let _ = child.wait();
                return;
            }
            std::thread::sleep(INTERVAL);
        }
    }
}

/// How a process has ended, if it has. It is then no longer known to the system.
fn ended(child: &Mutex<Child>) -> Option<String> {
    match child.lock().unwrap_or_else(PoisonError::into_inner).try_wait() {
        Ok(None) => None,
        Ok(Some(status)) => Some(status.to_string()),
        Err(error) => Some(error.to_string()),
    }
}

/// The end of what a process printed, as further lines of a message.
fn last_lines(printed: Option<&File>) -> String {
    let end = printed.and_then(|file| end_of(file).ok()).unwrap_or_default();
    let text = decode(&end);
    let lines: Vec<&str> = text.lines().map(str::trim_end).filter(|line| !line.is_empty()).collect();
    let last = &lines[lines.len().saturating_sub(LINES)..];
    let hint = last.iter().any(|line| line.contains("ModuleNotFoundError"));
    let printed = last.iter().map(|line| format!("\n  it printed: {}", line.replace(char::is_control, " ")));
    printed.chain(hint.then(|| MODULE_NOT_FOUND.to_owned())).collect()
}

/// What to do when Python does not find a module.
const MODULE_NOT_FOUND: &str = "\n  Python looks for modules beside the program and in PYTHONPATH: set it to absolute paths, for example \
    PYTHONPATH=$PWD/examples/python_plc (a process of a scenario runs in the folder of the scenario)";

fn end_of(mut file: &File) -> io::Result<Vec<u8>> {
    let length = file.seek(SeekFrom::End(0))?;
    file.seek(SeekFrom::Start(length.saturating_sub(OUTPUT_BYTES)))?;
    let mut end = Vec::new();
    file.take(OUTPUT_BYTES).read_to_end(&mut end)?;
    Ok(end)
}

fn shown(directory: &Path) -> String {
    if directory.as_os_str().is_empty() { "this folder".to_owned() } else { directory.display().to_string() }
}

/// The words of a command. It is not run by a shell, so that it means the same on each system.
fn words(command: &str) -> Result<Vec<String>, Problem> {
    let wrong = |what: &str| {
        Problem::new(
            format!("expected a command such as `python3 plc.py {IMAGE}`, found `{command}`"),
            format!("{what}; {IMAGE} stands for the mapped file"),
        )
    };
    let (mut words, mut word, mut quote) = (Vec::new(), None::<String>, None);
    for character in command.chars() {
        match (quote, character) {
            (Some(open), _) if open == character => quote = None,
            (None, '"' | '\'') => {
                quote = Some(character);
                word.get_or_insert_default();
            }
            (None, _) if character.is_whitespace() => words.extend(word.take()),
            _ => word.get_or_insert_default().push(character),
        }
    }
    words.extend(word);
    if quote.is_some() {
        return Err(wrong("close the quotes"));
    }
    if !words.iter().skip(1).any(|word| word.contains(IMAGE)) {
        return Err(wrong(&format!("add {IMAGE} to the arguments")));
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use super::*;

    #[test]
    fn the_output_of_a_process_is_new_and_only_its_end_is_read() {
        let name = format!("opennck-test-{}", std::process::id());
        let mut files = Files::new(&name);
        let mut log = files.create_log().unwrap();
        assert!(files.create_log().is_err(), "it exists");
        let path = files.log.clone();
        if cfg!(unix) {
            files.remove_names();
            assert!(!path.exists());
        }
        log.write_all(&b"line\n".repeat(100_000)).unwrap();
        log.write_all(b"last\n").unwrap();
        let printed = files.printed.clone().unwrap();
        assert_eq!(end_of(&printed).unwrap().len() as u64, OUTPUT_BYTES);
        let lines = last_lines(Some(&printed));
        assert_eq!(lines.lines().filter(|line| line.starts_with("  it printed: ")).count(), LINES);
        assert!(lines.ends_with("  it printed: last"), "{lines}");
        log.write_all(b"ModuleNotFoundError: No module named 'opennck_image'\n").unwrap();
        assert!(last_lines(Some(&printed)).contains("PYTHONPATH=$PWD/"));
        drop((files, log, printed));
        assert!(!path.exists());
    }

    #[test]
    fn quotes_keep_a_word_together_and_the_image_is_required() {
        let command = "python3 'my plc.py' \"\" --image={image}";
        assert_eq!(words(command).unwrap(), ["python3", "my plc.py", "", "--image={image}"]);
        for command in ["", "{image}", "python3 plc.py", "python3 'plc.py {image}"] {
            assert!(words(command).is_err(), "{command}");
        }
    }
}
