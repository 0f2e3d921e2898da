//! The NC side of the file: it publishes steps and takes answers.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::{Ordering, fence};

use super::fields::{MAGIC, SLOTS, VERSION, answer, header, section, step};
use super::layout::{Layout, Section};
use super::words::{Torn, WORD, Words, field, next};
use crate::image::{Memory, Names, Parts};
use crate::source::{Place, Problem};
use crate::units::Time;

/// The rules under which the NC takes answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Whether each step waits for its answer.
    pub lock_step: bool,
    /// The maximum time without an answer of the PLC, for the information of the PLC.
    pub time_out: Time,
}

/// The state of the NC in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// The NC has ended.
    Ended,
    /// The NC runs, and the PLC is in RUN.
    Run,
    /// The NC runs, and the PLC is in STOP: answers are not taken.
    Stop,
}

/// One step for the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The cycle of the NC.
    pub cycle: u64,
    /// The time of this cycle.
    pub time: Time,
    /// The time since the last scan.
    pub since_last: Time,
}

/// The result of looking for an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// There is no new answer.
    Nothing,
    /// A new answer, to the step with this number; [`MappedImage::take`] takes it.
    Answer(u64),
    /// A new answer that violates the protocol.
    Refused(Refusal),
}

/// Why an answer is rejected.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The number of its slot is wrong.
    #[error("the number of its slot differs from the newest answer, or the slot is being written")]
    Number,
    /// The checksum is wrong.
    #[error("its checksum is neither 0 nor the CRC-32 of the bytes before it")]
    Checksum,
    /// The list of changes is too long.
    #[error("its list of changes is longer than its slot or names a byte beyond the image")]
    Changes,
    /// The PLC must not answer this step.
    #[error("it answers a step from before its start, or a step that does not exist yet")]
    Step,
}

/// The interface as a memory-mapped file, NC side.
#[derive(Debug)]
pub struct MappedImage {
    pub(super) words: Words,
    layout: Layout,
    pub(super) geometry: Geometry,
    /// Prevents another NC from serving the same file.
    _lock: File,
    step: Vec<u8>,
    pub(super) answer: Vec<u8>,
    newest: u64,
    pub(super) seen: u64,
    starts: u64,
    plc_starts_before: u64,
    answering: Answering,
}

/// The processes that answer. One that has been replaced by another one, and answers again, shows that both run.
#[derive(Debug, Default)]
struct Answering {
    newest: u64,
    replaced: Vec<u64>,
    replacement: Option<[u64; 2]>,
    both: Option<[u64; 2]>,
}

impl Answering {
    /// Replaced processes that are remembered.
    const MOST: usize = 16;

    fn note(&mut self, process: u64) {
        if process == 0 || process == self.newest {
            return;
        }
        if self.replaced.contains(&process) {
            self.both = Some([self.newest, process]);
        } else if self.newest != 0 {
            self.replacement = Some([process, self.newest]);
        }
        if self.newest != 0 && !self.replaced.contains(&self.newest) {
            self.replaced.push(self.newest);
            let more = self.replaced.len().saturating_sub(Self::MOST);
            self.replaced.drain(..more);
        }
        self.newest = process;
    }
}

/// The positions of the slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Geometry {
    pub(super) image_bytes: usize,
    pub(super) nc_slots: usize,
    pub(super) nc_slot_bytes: usize,
    pub(super) plc_slots: usize,
    pub(super) plc_slot_bytes: usize,
    pub(super) slots: usize,
    pub(super) file_bytes: usize,
}

impl Geometry {
    fn new(sections: usize, image_bytes: usize) -> Self {
        let nc_slots = (header::END + sections * section::BYTES).next_multiple_of(header::END);
        let nc_slot_bytes = (step::IMAGE + image_bytes + WORD).next_multiple_of(64);
        let plc_slots = nc_slots + SLOTS * nc_slot_bytes;
        let plc_slot_bytes = (answer::BEFORE + 2 * image_bytes + WORD).next_multiple_of(64);
        let file_bytes = (plc_slots + SLOTS * plc_slot_bytes).next_multiple_of(header::END);
        Self { image_bytes, nc_slots, nc_slot_bytes, plc_slots, plc_slot_bytes, slots: SLOTS, file_bytes }
    }

    /// The position of the slot of a step.
    pub(super) fn nc_slot(&self, number: u64) -> usize {
        self.nc_slots + self.index(number) * self.nc_slot_bytes + step::NUMBER
    }

    /// The position of the slot of an answer.
    pub(super) fn plc_slot(&self, number: u64) -> usize {
        self.plc_slots + self.index(number) * self.plc_slot_bytes + answer::NUMBER
    }

    fn index(&self, number: u64) -> usize {
        usize::try_from(number % self.slots as u64).unwrap_or(0)
    }
}

impl MappedImage {
    /// Creates the file, or reuses a file that an earlier NC has left. The memory is published, with the PLC in STOP until
    /// [`state`](Self::state) changes it.
    ///
    /// # Errors
    /// The file cannot be opened, is not an image, is in use by another NC, or does not fit on the disk.
    pub fn create(path: &Path, memory: &Memory, names: &Names, rules: Rules) -> Result<Self, Problem> {
        let layout = Layout::of(memory, names)?;
        let geometry = Geometry::new(layout.sections.len(), layout.length);
        let (file, is_new) = open(path, geometry.file_bytes)?;
        let unmade = |error| at(path, format!("cannot be extended to {} bytes: {error}", geometry.file_bytes), ROOM);
        prepare(&file, geometry.file_bytes, is_new).map_err(unmade)?;
        let words = Words::map(&file, geometry.file_bytes).map_err(unmade)?;
        // From here on, processes that have mapped the file find it invalid.
        words.store(header::STATE, 0);
        words.store(header::GENERATION, next(words.load(header::GENERATION)));
        // The stores below become visible only after the state above.
        fence(Ordering::Release);
        let table = layout.table();
        words.write(header::END, &table);
        for (offset, value) in [
            (header::FILE_BYTES, geometry.file_bytes as u64),
            (header::PROFILE, names.profile.number()),
            (header::SECTIONS, layout.sections.len() as u64),
            (header::SECTION_TABLE, header::END as u64),
            (header::SECTION_BYTES, section::BYTES as u64),
            (header::IMAGE_BYTES, layout.length as u64),
            (header::SLOTS, geometry.slots as u64),
            (header::NC_SLOTS, geometry.nc_slots as u64),
            (header::NC_SLOT_BYTES, geometry.nc_slot_bytes as u64),
            (header::PLC_SLOTS, geometry.plc_slots as u64),
            (header::PLC_SLOT_BYTES, geometry.plc_slot_bytes as u64),
            (header::LOCK_STEP, rules.lock_step.into()),
            (header::TIME_OUT, nanos(rules.time_out)),
            (header::PROCESS, std::process::id().into()),
            (header::REQUEST, 0),
        ] {
            words.store(offset, value);
        }
        let (newest, seen) = (words.load(header::NEWEST_STEP), words.load(header::NEWEST_ANSWER));
        // A PLC that opens the file from now on waits until the file is valid, and only then counts its start.
        let plc_starts_before = words.load(header::PLC_STARTS);
        // Numbers at their maximum cannot be reached by counting: another program wrote them.
        let newest = if newest > u64::MAX / 2 { 0 } else { newest };
        let mut image = Self {
            step: vec![0; geometry.nc_slot_bytes],
            answer: vec![0; geometry.plc_slot_bytes],
            words,
            layout,
            geometry,
            _lock: file,
            newest,
            seen,
            starts: 0,
            plc_starts_before,
            answering: Answering::default(),
        };
        let first = Step { cycle: 0, time: Time::ZERO, since_last: Time::ZERO };
        image.publish(memory, first, false);
        image.state(State::Stop);
        Ok(image)
    }

    /// The layout of the image.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.layout.sections
    }

    /// The number of PLC starts in the file before it was created for this machine.
    #[must_use]
    pub fn plc_starts_before(&self) -> u64 {
        self.plc_starts_before
    }

    /// Publishes the state of the NC.
    pub fn state(&self, state: State) {
        let state = match state {
            State::Ended => 0,
            State::Run => 1,
            State::Stop => 2,
        };
        self.words.store(header::STATE, state);
    }

    /// Publishes the cycle time of the NC.
    pub fn cycle_time(&self, cycle: Time) {
        self.words.store(header::NC_CYCLE_TIME, nanos(cycle));
    }

    /// Starts the PLC with the next step, and returns the number of that step.
    pub fn start(&mut self) -> u64 {
        self.starts += 1;
        next(self.newest)
    }

    /// Whether the PLC has been started.
    #[must_use]
    pub fn has_started(&self) -> bool {
        self.starts > 0
    }

    /// Publishes a step, and whether the NC waits for its answer. Returns the number of the step.
    pub fn publish(&mut self, memory: &impl Parts, step: Step, waits: bool) -> u64 {
        let number = next(self.newest);
        for (offset, value) in [
            (step::CYCLE, step.cycle),
            (step::TIME, nanos(step.time)),
            (step::SINCE_LAST, nanos(step.since_last)),
            (step::STARTS, self.starts),
            (step::TAKEN, self.seen),
        ] {
            self.step[offset..offset + WORD].copy_from_slice(&value.to_le_bytes());
        }
        self.layout.gather(memory, &mut self.step[step::IMAGE..step::IMAGE + self.geometry.image_bytes]);
        self.words.write_slot(self.geometry.nc_slot(number), number, &mut self.step);
        self.words.store(header::REQUEST, if waits { number } else { 0 });
        self.words.store(header::NEWEST_STEP, number);
        self.newest = number;
        number
    }

    /// Ends the waiting for an answer.
    pub fn give_up(&self) {
        self.words.store(header::REQUEST, 0);
    }

    /// Whether the PLC has acknowledged this step; call [`look`](Self::look) for its answer.
    #[must_use]
    pub fn is_acknowledged(&self, number: u64) -> bool {
        self.words.load(header::ACKNOWLEDGE) == number
    }

    /// Looks for an answer to the step with this number or a later one.
    pub fn look(&mut self, least: u64) -> Look {
        let number = self.words.load(header::NEWEST_ANSWER);
        if number == self.seen || number == 0 {
            return Look::Nothing;
        }
        let at = self.geometry.plc_slot(number);
        let read = match self.changed(at) {
            None => self.words.read_slot(at, number, &mut self.answer),
            Some(bytes) if bytes <= self.answer.len() - WORD => {
                let slot_bytes = self.geometry.plc_slot_bytes;
                self.words.read_part(at, number, &mut self.answer[..bytes], slot_bytes)
            }
            Some(_) => return Look::Refused(Refusal::Changes),
        };
        match read {
            Err(Torn::Number) => return Look::Refused(Refusal::Number),
            Err(Torn::Checksum) => return Look::Refused(Refusal::Checksum),
            Ok(()) => self.seen = number,
        }
        self.answering.note(field(&self.answer, answer::PROCESS));
        match field(&self.answer, answer::ANSWERS) {
            answered if (least..=self.newest).contains(&answered) => Look::Answer(answered),
            _ => Look::Refused(Refusal::Step),
        }
    }

    /// The bytes of the answer in the slot at this position up to the end of its list of changes; `None` if it has images. The number of
    /// entries is stored plus one.
    fn changed(&self, at: usize) -> Option<usize> {
        let count = self.words.load(at + answer::CHANGES).checked_sub(1)?;
        let bytes = usize::try_from(count).ok().and_then(|count| count.checked_mul(answer::CHANGE_BYTES));
        Some(bytes.and_then(|bytes| bytes.checked_add(answer::BEFORE)).unwrap_or(usize::MAX))
    }

    /// Takes the answer that was found: the bits that the PLC has changed.
    pub fn take(&mut self, memory: &mut impl Parts) {
        if let Some(count) = field(&self.answer, answer::CHANGES).checked_sub(1) {
            let count = usize::try_from(count).unwrap_or(0);
            let entries = self.answer[answer::BEFORE..].as_chunks::<{ answer::CHANGE_BYTES }>().0;
            for &[a, b, c, d, before, after, ..] in entries.iter().take(count) {
                let offset = usize::try_from(u32::from_le_bytes([a, b, c, d])).unwrap_or(usize::MAX);
                self.layout.change(offset, before, after, memory);
            }
            return;
        }
        let images = &self.answer[answer::BEFORE..answer::BEFORE + 2 * self.geometry.image_bytes];
        let (before, after) = images.split_at(self.geometry.image_bytes);
        self.layout.scatter(before, after, memory);
    }

    /// The number of PLC starts with this file; the PLC counts them.
    #[must_use]
    pub fn plc_starts(&self) -> u64 {
        self.words.load(header::PLC_STARTS)
    }

    /// Two PLC processes that answer in turn, by their numbers, if there are any since the last call. Each takes steps of the other.
    pub fn take_both(&mut self) -> Option<[u64; 2]> {
        self.answering.both.take()
    }

    /// A PLC process that has begun to answer and the one that answered before, by their numbers, if there are any since the last call. The
    /// earlier one has ended, or it waits for ever because its steps go to the other.
    pub fn take_replacement(&mut self) -> Option<[u64; 2]> {
        self.answering.replacement.take()
    }

    /// The number of power off/on requests of the PLC.
    #[must_use]
    pub fn power_requests(&self) -> u64 {
        self.words.load(header::POWER)
    }
}

impl Drop for MappedImage {
    fn drop(&mut self) {
        self.give_up();
        self.state(State::Ended);
    }
}

const ROOM: &str = "free disk space, or choose another file; on Linux /dev/shm is in memory";

fn at(path: &Path, what: impl Into<String>, cure: &str) -> Problem {
    Place::file(&path.display().to_string()).problem(what, cure)
}

/// Opens the file exclusively, and rejects a file of another kind before anything is written. The flag is `true` for a new file: an empty
/// one, or one of zeros that is not longer than needed, which an interrupted creation leaves behind.
fn open(path: &Path, length: usize) -> Result<(File, bool), Problem> {
    if let Ok(found) = std::fs::metadata(path)
        && !found.is_file()
    {
        return Err(at(path, "expected a regular file for the image, found something else", "choose another name"));
    }
    let unusable = |error: &std::io::Error| {
        at(path, format!("cannot be used for the image: {error}"), "check the path and the permissions")
    };
    let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
    let mut file = options.map_err(|error| unusable(&error))?;
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => {
            at(path, "the image is in use by another machine", "stop the other `opennck serve`, or choose another file")
        }
        TryLockError::Error(error) => unusable(&error),
    })?;
    let mut found = Vec::new();
    let head = header::VERSION + WORD;
    Read::by_ref(&mut file).take(head as u64).read_to_end(&mut found).map_err(|error| unusable(&error))?;
    let version = field(&found, header::VERSION);
    if found.starts_with(&MAGIC) && version == VERSION {
        return Ok((file, false));
    }
    if found.iter().all(|byte| *byte == 0) {
        Read::by_ref(&mut file).take(length as u64).read_to_end(&mut found).map_err(|error| unusable(&error))?;
        if found.len() <= length && found.iter().all(|byte| *byte == 0) {
            return Ok((file, true));
        }
    }
    let what = if found.starts_with(&MAGIC) {
        format!("expected an image of version {VERSION}, found version {version}")
    } else {
        "expected a new file or an image of the interface, found other contents".to_owned()
    };
    Err(at(path, what, "choose another file; this one is unchanged"))
}

/// Extends the file and allocates its disk space; a page without disk space would end the process later. The file never becomes shorter,
/// because another process may have it mapped. A new file becomes a valid image in one write.
fn prepare(mut file: &File, length: usize, is_new: bool) -> std::io::Result<()> {
    let end = file.seek(SeekFrom::End(0))?;
    let missing = (length as u64).saturating_sub(end);
    let mut written = file.write_all(&vec![0; usize::try_from(missing).unwrap_or(0)]);
    if written.is_ok() && is_new {
        written = file.rewind().and_then(|()| file.write_all(&[MAGIC, VERSION.to_le_bytes()].concat()));
    }
    if written.is_err() {
        // Restore the old length; a new file is empty again.
        let _ = file.set_len(end);
    }
    written
}

/// Nanoseconds in the format of the file; they are never negative.
fn nanos(time: Time) -> u64 {
    u64::try_from(time.nanos()).unwrap_or(0)
}
