//! The NC's side of the file: it publishes steps and takes answers.

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

/// How the NC takes answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rules {
    /// Each step waits for its answer.
    pub lock_step: bool,
    /// How long the PLC may be silent, for its own information.
    pub time_out: Time,
}

/// What the NC does, as the file says it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It has ended.
    Ended,
    /// It runs, and the PLC is in RUN.
    Run,
    /// It runs, and the PLC is in STOP: answers are not taken.
    Stop,
}

/// One step for the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// The cycle of the NC.
    pub cycle: u64,
    /// Its time.
    pub time: Time,
    /// The time since the last scan.
    pub since_last: Time,
}

/// What came of a look for an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Nothing new.
    Nothing,
    /// A new answer, to this step; [`MappedImage::take`] takes it.
    Answer(u64),
    /// Something new that keeps not to the rules.
    Refused(Refusal),
}

/// Why an answer is not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Refusal {
    /// The number of its slot.
    #[error("its slot has another number than its newest answer, or is being written")]
    Number,
    /// Its checksum.
    #[error("its checksum is neither 0 nor the CRC-32 of what stands before it")]
    Checksum,
    /// A step that the PLC was not to answer.
    #[error("it answers a step from before its start, or one that there was not yet")]
    Step,
}

/// The interface as a file in memory, from the NC's side.
#[derive(Debug)]
pub struct MappedImage {
    pub(super) words: Words,
    layout: Layout,
    pub(super) geometry: Geometry,
    /// Keeps others from serving the same file.
    _lock: File,
    step: Vec<u8>,
    pub(super) answer: Vec<u8>,
    newest: u64,
    seen: u64,
    starts: u64,
    plc_starts_before: u64,
}

/// Where the slots are.
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

    /// Where the slot of a step is.
    pub(super) fn nc_slot(&self, number: u64) -> usize {
        self.nc_slots + self.index(number) * self.nc_slot_bytes + step::NUMBER
    }

    /// Where the slot of an answer is.
    pub(super) fn plc_slot(&self, number: u64) -> usize {
        self.plc_slots + self.index(number) * self.plc_slot_bytes + answer::NUMBER
    }

    fn index(&self, number: u64) -> usize {
        usize::try_from(number % self.slots as u64).unwrap_or(0)
    }
}

impl MappedImage {
    /// Creates the file, or goes on with one that an NC left behind. The memory is shown, with the PLC in STOP until
    /// [`state`](Self::state) says otherwise.
    ///
    /// # Errors
    /// The file cannot be opened, is something else than such an image, is in use by another NC, or finds no room.
    pub fn create(path: &Path, memory: &Memory, names: &Names, rules: Rules) -> Result<Self, Problem> {
        let layout = Layout::of(memory, names)?;
        let geometry = Geometry::new(layout.sections.len(), layout.length);
        let (file, is_new) = open(path, geometry.file_bytes)?;
        let unmade = |error| at(path, format!("cannot be made {} bytes long: {error}", geometry.file_bytes), ROOM);
        prepare(&file, geometry.file_bytes, is_new).map_err(unmade)?;
        let words = Words::map(&file, geometry.file_bytes).map_err(unmade)?;
        // From here on, those who have it mapped know that it is not valid.
        words.store(header::STATE, 0);
        words.store(header::GENERATION, next(words.load(header::GENERATION)));
        // What is stored now is seen by nobody who has not seen that.
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
        // Whoever opens the file from now on waits until it is valid, and counts then.
        let plc_starts_before = words.load(header::PLC_STARTS);
        // Nobody has counted so far: it was written by a stranger, and numbers would come to their end.
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
        };
        let first = Step { cycle: 0, time: Time::ZERO, since_last: Time::ZERO };
        image.publish(memory, first, false);
        image.state(State::Stop);
        Ok(image)
    }

    /// Which bytes are where.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.layout.sections
    }

    /// How often a process had opened the file before it was created for this machine.
    #[must_use]
    pub fn plc_starts_before(&self) -> u64 {
        self.plc_starts_before
    }

    /// Says what the NC does.
    pub fn state(&self, state: State) {
        let state = match state {
            State::Ended => 0,
            State::Run => 1,
            State::Stop => 2,
        };
        self.words.store(header::STATE, state);
    }

    /// Says how long a cycle of the NC is.
    pub fn cycle_time(&self, cycle: Time) {
        self.words.store(header::NC_CYCLE_TIME, nanos(cycle));
    }

    /// The PLC starts with the next step, which has the number that this gives.
    pub fn start(&mut self) -> u64 {
        self.starts += 1;
        next(self.newest)
    }

    /// Whether the PLC has been started.
    #[must_use]
    pub fn has_started(&self) -> bool {
        self.starts > 0
    }

    /// Publishes a step, and says whether the NC waits for its answer; gives its number.
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

    /// The NC does not wait any more.
    pub fn give_up(&self) {
        self.words.store(header::REQUEST, 0);
    }

    /// Whether the PLC acknowledges this step; its answer can be looked for.
    #[must_use]
    pub fn is_acknowledged(&self, number: u64) -> bool {
        self.words.load(header::ACKNOWLEDGE) == number
    }

    /// Looks for an answer to a step from this number on.
    pub fn look(&mut self, least: u64) -> Look {
        let number = self.words.load(header::NEWEST_ANSWER);
        if number == self.seen || number == 0 {
            return Look::Nothing;
        }
        match self.words.read_slot(self.geometry.plc_slot(number), number, &mut self.answer) {
            Err(Torn::Number) => return Look::Refused(Refusal::Number),
            Err(Torn::Checksum) => return Look::Refused(Refusal::Checksum),
            Ok(()) => self.seen = number,
        }
        match field(&self.answer, answer::ANSWERS) {
            answered if (least..=self.newest).contains(&answered) => Look::Answer(answered),
            _ => Look::Refused(Refusal::Step),
        }
    }

    /// Takes the answer that was found: the bits that the PLC has changed.
    pub fn take(&mut self, memory: &mut impl Parts) {
        let images = &self.answer[answer::BEFORE..answer::BEFORE + 2 * self.geometry.image_bytes];
        let (before, after) = images.split_at(self.geometry.image_bytes);
        self.layout.scatter(before, after, memory);
    }

    /// How often a PLC has started with this file; it counts by itself.
    #[must_use]
    pub fn plc_starts(&self) -> u64 {
        self.words.load(header::PLC_STARTS)
    }

    /// How often the PLC has asked for power off and on.
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

const ROOM: &str = "make room, or choose another file: on Linux /dev/shm is memory";

fn at(path: &Path, what: impl Into<String>, cure: &str) -> Problem {
    Place::file(&path.display().to_string()).problem(what, cure)
}

/// Opens the file alone, and refuses what is not ours before anything is written. Says whether it is a new one: empty, or nothing but
/// zeros and no longer than it becomes, which is what an end in the middle of making it leaves.
fn open(path: &Path, length: usize) -> Result<(File, bool), Problem> {
    if let Ok(found) = std::fs::metadata(path)
        && !found.is_file()
    {
        return Err(at(path, "expected a file for the image, found something else", "choose another name"));
    }
    let unusable = |error: &std::io::Error| {
        at(path, format!("cannot be used for the image: {error}"), "check the path and the permissions")
    };
    let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(path);
    let mut file = options.map_err(|error| unusable(&error))?;
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => at(
            path,
            "expected an image that no other machine serves, found one in use",
            "end the other `opennck serve`, or choose another file",
        ),
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
        "expected a new file or an image of the interface, found something else in it".to_owned()
    };
    Err(at(path, what, "choose another file; this one was left as it is"))
}

/// Makes the file long enough, with room on the disk: a page that finds none would end the process later. It never becomes
/// shorter, for somebody may still have it mapped. A new one is an image from one moment to the next.
fn prepare(mut file: &File, length: usize, is_new: bool) -> std::io::Result<()> {
    let end = file.seek(SeekFrom::End(0))?;
    let missing = (length as u64).saturating_sub(end);
    let mut written = file.write_all(&vec![0; usize::try_from(missing).unwrap_or(0)]);
    if written.is_ok() && is_new {
        written = file.rewind().and_then(|()| file.write_all(&[MAGIC, VERSION.to_le_bytes()].concat()));
    }
    if written.is_err() {
        // Left as it was found: a new one empty.
        let _ = file.set_len(end);
    }
    written
}

/// Nanoseconds as the file has them; they are never negative.
fn nanos(time: Time) -> u64 {
    u64::try_from(time.nanos()).unwrap_or(0)
}
