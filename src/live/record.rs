//! `--record`: writes the changes to a live machine as a scenario that repeats them.
//!
//! The stepping thread collects the commands queued for the start of its step (`scenario::Transcript`), from all sources. A separate thread
//! writes them to the disk once per second. The last step of the file lets time pass up to the end and is rewritten each time. The file is
//! therefore a complete scenario at any time, also after a crash; only a reader during the write may see an incomplete step. Earlier
//! content never changes. If the disk accepts no more data, the recording ends and the machine keeps running: the file has the state of one
//! second before.

use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::{self, Seek, SeekFrom, Write};
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::Duration;

use crate::machine::Machine;
use crate::scenario::{Heading, Remark, Transcript};
use crate::source::{Place, Problem};

/// Interval between writes of the file.
const EVERY: Duration = Duration::from_secs(1);

/// A file that becomes the scenario of a live session.
#[derive(Debug)]
pub struct Recording {
    book: Arc<Mutex<Book>>,
    remarks: Vec<Remark>,
    /// The clients that have written, numbered in order.
    clients: BTreeMap<SocketAddr, usize>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// Text that waits for the disk.
#[derive(Debug)]
struct Book {
    transcript: Transcript,
    /// The last cycle.
    cycle: u64,
    /// The disk accepts no more data.
    is_over: bool,
}

impl Recording {
    /// Begins a file for a machine that has not run yet. The paths in the heading are relative to the file.
    ///
    /// # Errors
    /// The file exists already or cannot be written, or the machine has run.
    pub fn begin(path: &Path, heading: &Heading<'_>, machine: &Machine) -> Result<Self, Problem> {
        let place = Place::file(&path.display().to_string());
        if machine.cycle() > 0 {
            return Err(place.problem(
                format!("expected a machine that has not run yet, found one that has run for {} s", machine.time()),
                "begin the recording before the first step",
            ));
        }
        let mut transcript = Transcript::begin(heading);
        let file = OpenOptions::new().write(true).create_new(true).open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => {
                place.problem("the file exists already", "choose another name: a recording does not overwrite files")
            }
            _ => place.problem(format!("cannot be written: {error}"), "check the path and the permissions"),
        })?;
        let mut written = Written { path: path.to_owned(), file, whole: 0, rest: String::new() };
        let cannot = |error| place.problem(format!("cannot be written: {error}"), "check the disk");
        written.write(&transcript.take_text(), transcript.rest(0)).map_err(cannot)?;
        let book = Arc::new(Mutex::new(Book { transcript, cycle: 0, is_over: false }));
        let (end, ended) = mpsc::channel();
        let filled = Arc::clone(&book);
        let thread = std::thread::spawn(move || written.follow(&filled, &ended));
        Ok(Self { book, remarks: Vec::new(), clients: BTreeMap::new(), end: Some(end), thread: Some(thread) })
    }

    /// Marks the following commands as those of a client. Clients are numbered in the order in which they first write, because their ports
    /// differ from run to run.
    pub(super) fn client(&mut self, machine: &Machine, client: Option<SocketAddr>) {
        let text = client.map_or_else(
            || "a client".to_owned(),
            |client| {
                let next = self.clients.len() + 1;
                let number = self.clients.entry(client).or_insert(next);
                format!("client {number}, from {}", client.ip().to_canonical())
            },
        );
        self.remark(machine.queued().len(), text);
    }

    /// Adds a remark on the origin of all commands after the first `before` ones.
    pub(super) fn remark(&mut self, before: usize, text: String) {
        self.remarks.push(Remark { before, text });
    }

    /// Adds a note, which the trace shows at the end of the next step.
    pub(super) fn note(&mut self, text: &str) {
        let mut book = self.book.lock().unwrap_or_else(PoisonError::into_inner);
        if !book.is_over {
            book.transcript.note(text);
        }
    }

    /// Records the commands at the start of the next step, which must follow immediately.
    pub(super) fn edge(&mut self, machine: &Machine) {
        let mut book = self.book.lock().unwrap_or_else(PoisonError::into_inner);
        if !book.is_over {
            book.transcript.edge(machine, &self.remarks);
        }
        book.cycle = machine.cycle() + 1;
        self.remarks.clear();
    }
}

impl Drop for Recording {
    fn drop(&mut self) {
        drop(self.end.take());
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

/// A file whose last step is rewritten each time.
#[derive(Debug)]
struct Written {
    path: PathBuf,
    file: File,
    /// Offset at which the last step begins.
    whole: u64,
    rest: String,
}

impl Written {
    /// Writes new text to the disk until the recording ends or the disk accepts no more data.
    fn follow(mut self, book: &Mutex<Book>, ended: &mpsc::Receiver<()>) {
        loop {
            let is_last = ended.recv_timeout(EVERY) != Err(RecvTimeoutError::Timeout);
            let (text, rest) = {
                let mut book = book.lock().unwrap_or_else(PoisonError::into_inner);
                (book.transcript.take_text(), book.transcript.rest(book.cycle))
            };
            if let Err(error) = self.write(&text, rest) {
                book.lock().unwrap_or_else(PoisonError::into_inner).is_over = true;
                tracing::error!("the recording ends: {} cannot be written: {error}", self.path.display());
                return;
            }
            if is_last {
                return;
            }
        }
    }

    /// Replaces the last step by new text and a new last step. On an error the file stays as it was.
    fn write(&mut self, more: &str, rest: String) -> io::Result<()> {
        let written = self.put(&format!("{more}{rest}"));
        if written.is_ok() {
            self.whole += more.len() as u64;
            self.rest = rest;
        } else {
            let before = self.rest.clone();
            let _ = self.file.set_len(self.whole + before.len() as u64);
            let _ = self.put(&before);
        }
        written
    }

    fn put(&mut self, text: &str) -> io::Result<()> {
        self.file.seek(SeekFrom::Start(self.whole))?;
        self.file.write_all(text.as_bytes())
    }
}
