//! `--record`: what is done to a live machine, written down as a scenario that does the same again.
//!
//! The stepping thread writes down what waits for the edge of its step (`scenario::Transcript`), whoever queued it. A thread of
//! its own brings that to the disk, once a second. The last step of the file lets time pass up to the end and is written anew each
//! time; so the file is a whole scenario at any moment, also after an end without warning (only who reads while it is written may
//! meet half a step). Whatever was written before stays. A
//! disk that takes nothing more ends the recording, not the machine: the file is what it was a second before.

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

/// How often the file is written.
const EVERY: Duration = Duration::from_secs(1);

/// A file that becomes the scenario of what is done to a machine.
#[derive(Debug)]
pub struct Recording {
    book: Arc<Mutex<Book>>,
    remarks: Vec<Remark>,
    /// Who has written, in order.
    clients: BTreeMap<SocketAddr, usize>,
    end: Option<mpsc::Sender<()>>,
    thread: Option<JoinHandle<()>>,
}

/// What waits for the disk.
#[derive(Debug)]
struct Book {
    transcript: Transcript,
    /// The last cycle.
    cycle: u64,
    /// The disk takes nothing more.
    is_over: bool,
}

impl Recording {
    /// Begins a file for a machine that has not run yet; the heading's paths are relative to the file.
    ///
    /// # Errors
    /// There is such a file already, or it cannot be written; or the machine has run.
    pub fn begin(path: &Path, heading: &Heading<'_>, machine: &Machine) -> Result<Self, Problem> {
        let place = Place::file(&path.display().to_string());
        if machine.cycle() > 0 {
            return Err(place.problem(
                format!("expected a machine that was just switched on, found one after {} s", machine.time()),
                "begin the recording before the machine runs",
            ));
        }
        let mut transcript = Transcript::begin(heading);
        let file = OpenOptions::new().write(true).create_new(true).open(path).map_err(|error| match error.kind() {
            io::ErrorKind::AlreadyExists => place.problem(
                "expected a new file, found one that exists",
                "name another one: a recording replaces nothing",
            ),
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

    /// Says that a client queues the commands that follow. Clients have numbers in the order in which they write: the port from
    /// which one comes is another one each time.
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

    /// Says whose the commands are behind the first ones.
    pub(super) fn remark(&mut self, before: usize, text: String) {
        self.remarks.push(Remark { before, text });
    }

    /// Notes a text, as the trace does at the end of the next step.
    pub(super) fn note(&mut self, text: &str) {
        let mut book = self.book.lock().unwrap_or_else(PoisonError::into_inner);
        if !book.is_over {
            book.transcript.note(text);
        }
    }

    /// Writes down what a machine does at the edge of its next step, which follows at once.
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

/// A file whose last step is written anew each time.
#[derive(Debug)]
struct Written {
    path: PathBuf,
    file: File,
    /// Where the last step begins.
    whole: u64,
    rest: String,
}

impl Written {
    /// Brings to the disk what there is, until the end or until the disk takes nothing more.
    fn follow(mut self, book: &Mutex<Book>, ended: &mpsc::Receiver<()>) {
        loop {
            let is_last = ended.recv_timeout(EVERY) != Err(RecvTimeoutError::Timeout);
            let (text, rest) = {
                let mut book = book.lock().unwrap_or_else(PoisonError::into_inner);
                (book.transcript.take_text(), book.transcript.rest(book.cycle))
            };
            if let Err(error) = self.write(&text, rest) {
                book.lock().unwrap_or_else(PoisonError::into_inner).is_over = true;
                tracing::error!("the recording ends, {} cannot be written: {error}", self.path.display());
                return;
            }
            if is_last {
                return;
            }
        }
    }

    /// Writes more in place of the last step, and a new last step; or leaves everything as it was.
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
