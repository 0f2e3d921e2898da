//! The PLC side of the file, for a soft PLC in Rust and for tests. A PLC in another language does the same according to the tables.

use std::fs::OpenOptions;
use std::path::Path;
use std::sync::atomic::{Ordering, fence};

use super::fields::{MAGIC, VERSION, answer, header, section, step};
use super::layout::{Section, parse};
use super::nc::{Geometry, State, Step};
use super::words::{WORD, Words, field, next};
use crate::image::Area;
use crate::source::{Place, Problem};
use crate::units::Time;

/// The maximum number of attempts to read the header while an NC restarts.
const TRIES: usize = 100;

/// The interface as a memory-mapped file, PLC side.
#[derive(Debug)]
pub struct PlcImage {
    words: Words,
    sections: Vec<Section>,
    geometry: Geometry,
    generation: u64,
    step: Vec<u8>,
    answer: Vec<u8>,
    newest: u64,
    /// The last answer. A step that does not include it is not used for the next scan.
    pub(super) answered: Option<u64>,
}

impl PlcImage {
    /// Maps the file that an NC serves, and counts a start of the PLC.
    ///
    /// # Errors
    /// The file does not exist, cannot be opened or is not an image, or no NC serves it.
    pub fn open(path: &Path) -> Result<Self, Problem> {
        let at = |what: String, cure: &str| Place::file(&path.display().to_string()).problem(what, cure);
        let unusable = |error: std::io::Error| at(format!("cannot be opened: {error}"), "start the NC first");
        let foreign = || {
            let what = format!("expected an image of version {VERSION}, found something else");
            at(what, "name the file that the NC serves")
        };
        for _ in 0..TRIES {
            let file = OpenOptions::new().read(true).write(true).open(path).map_err(unusable)?;
            let length = file.metadata().map_err(unusable)?.len();
            let length = usize::try_from(length).unwrap_or(0) / header::END * header::END;
            if length < header::END {
                return Err(foreign());
            }
            let words = Words::map(&file, length).map_err(unusable)?;
            // An NC that starts with this file changes these two fields before it writes anything else.
            let generation = words.load(header::GENERATION);
            let state = state(&words);
            let read = read(&words, length);
            fence(Ordering::Acquire);
            if words.load(header::GENERATION) != generation {
                continue;
            }
            let is_left = state == State::Ended || self::state(&words) == State::Ended;
            // An image that is being created has no tables yet.
            if is_left && is_image(&words) {
                let what = "no NC serves this image: the NC has ended or has not finished creating it";
                return Err(at(what.into(), "start the NC first"));
            }
            let (geometry, sections) = read.ok_or_else(foreign)?;
            words.store(header::PLC_STARTS, next(words.load(header::PLC_STARTS)));
            return Ok(Self {
                sections,
                generation,
                step: vec![0; geometry.nc_slot_bytes],
                answer: vec![0; geometry.plc_slot_bytes],
                newest: 0,
                answered: None,
                words,
                geometry,
            });
        }
        Err(foreign())
    }

    /// The state of the NC. After a restart of the NC it is `Ended`: open the file again.
    #[must_use]
    pub fn state(&self) -> State {
        if self.words.load(header::GENERATION) == self.generation { state(&self.words) } else { State::Ended }
    }

    /// The layout of the image.
    #[must_use]
    pub fn sections(&self) -> &[Section] {
        &self.sections
    }

    /// The position of a byte in the image.
    #[must_use]
    pub fn offset(&self, area: Area, byte: u32) -> Option<usize> {
        let has = |section: &&Section| {
            section.area == area && (section.first..section.first + section.length).contains(&byte)
        };
        let section = self.sections.iter().find(has)?;
        usize::try_from(section.offset + (byte - section.first)).ok()
    }

    /// Copies the newest step if it is newer than the last one and includes the last answer. Returns its number.
    pub fn next_step(&mut self) -> Option<u64> {
        let number = self.words.load(header::NEWEST_STEP);
        if number == self.newest || number == 0 {
            return None;
        }
        self.words.read_slot(self.geometry.nc_slot(number), number, &mut self.step).ok()?;
        if self.answered.is_some_and(|answered| answered != field(&self.step, step::TAKEN)) {
            return None;
        }
        self.newest = number;
        let images = &mut self.answer[answer::BEFORE..answer::BEFORE + 2 * self.geometry.image_bytes];
        let (before, after) = images.split_at_mut(self.geometry.image_bytes);
        let image = &self.step[step::IMAGE..step::IMAGE + self.geometry.image_bytes];
        before.copy_from_slice(image);
        after.copy_from_slice(image);
        Some(number)
    }

    /// The data at the head of the step.
    #[must_use]
    pub fn step(&self) -> Step {
        let time = |offset| Time::from_nanos(i64::try_from(field(&self.step, offset)).unwrap_or(i64::MAX));
        Step { cycle: field(&self.step, step::CYCLE), time: time(step::TIME), since_last: time(step::SINCE_LAST) }
    }

    /// The number of PLC starts by the NC; run OB100 if it differs from the last scan.
    #[must_use]
    pub fn starts(&self) -> u64 {
        field(&self.step, step::STARTS)
    }

    /// The image of the step, with the changes since it was copied.
    #[must_use]
    pub fn image(&self) -> &[u8] {
        let start = answer::BEFORE + self.geometry.image_bytes;
        &self.answer[start..start + self.geometry.image_bytes]
    }

    /// The image, mutable.
    pub fn image_mut(&mut self) -> &mut [u8] {
        let start = answer::BEFORE + self.geometry.image_bytes;
        &mut self.answer[start..start + self.geometry.image_bytes]
    }

    /// Answers the step: publishes the bits that were changed since it was copied. If the NC has ended, this writes nothing, because the
    /// slots may belong to another NC.
    pub fn answer(&mut self) {
        if self.state() == State::Ended {
            return;
        }
        let number = next(self.words.load(header::NEWEST_ANSWER));
        self.answer[answer::ANSWERS..answer::ANSWERS + WORD].copy_from_slice(&self.newest.to_le_bytes());
        let process = u64::from(std::process::id());
        self.answer[answer::PROCESS..answer::PROCESS + WORD].copy_from_slice(&process.to_le_bytes());
        let at = self.geometry.plc_slot(number);
        match self.changes() {
            Some(list) => self.words.write_part(at, number, &list, self.geometry.plc_slot_bytes),
            None => {
                self.answer[answer::CHANGES..answer::CHANGES + WORD].fill(0);
                self.words.write_slot(at, number, &mut self.answer);
            }
        }
        self.words.store(header::NEWEST_ANSWER, number);
        self.words.store(header::ACKNOWLEDGE, self.newest);
        self.answered = Some(number);
    }

    /// The answer as a list of changes, if it is shorter than the images.
    fn changes(&self) -> Option<Vec<u8>> {
        let bytes = self.geometry.image_bytes;
        let (before, after) = self.answer[answer::BEFORE..answer::BEFORE + 2 * bytes].split_at(bytes);
        let mut list = self.answer[..answer::BEFORE].to_vec();
        for (offset, (before, after)) in before.iter().zip(after).enumerate() {
            if before != after {
                list.extend_from_slice(&u32::try_from(offset).ok()?.to_le_bytes());
                list.extend_from_slice(&[*before, *after, 0, 0]);
            }
            if list.len() > bytes {
                return None;
            }
        }
        let count = (list.len() - answer::BEFORE) / answer::CHANGE_BYTES;
        list[answer::CHANGES..answer::CHANGES + WORD].copy_from_slice(&(count as u64 + 1).to_le_bytes());
        Some(list)
    }

    /// Requests power off and on of the control.
    pub fn power_off_and_on(&self) {
        self.words.store(header::POWER, next(self.words.load(header::POWER)));
    }
}

fn state(words: &Words) -> State {
    match words.load(header::STATE) {
        1 => State::Run,
        2 => State::Stop,
        _ => State::Ended,
    }
}

fn is_image(words: &Words) -> bool {
    let mut magic = [0; MAGIC.len()];
    words.read(header::MAGIC, &mut magic);
    magic == MAGIC && words.load(header::VERSION) == VERSION
}

/// The constant part of the header; `None` if the file is not an image of this version, or if the image exceeds the file.
fn read(words: &Words, length: usize) -> Option<(Geometry, Vec<Section>)> {
    let number = |offset| usize::try_from(words.load(offset)).unwrap_or(usize::MAX);
    let geometry = Geometry {
        image_bytes: number(header::IMAGE_BYTES),
        nc_slots: number(header::NC_SLOTS),
        nc_slot_bytes: number(header::NC_SLOT_BYTES),
        plc_slots: number(header::PLC_SLOTS),
        plc_slot_bytes: number(header::PLC_SLOT_BYTES),
        slots: number(header::SLOTS),
        file_bytes: number(header::FILE_BYTES),
    };
    let is_whole = is_image(words) && geometry.is_possible(length);
    if !is_whole || number(header::SECTION_BYTES) != section::BYTES || number(header::SECTION_TABLE) != header::END {
        return None;
    }
    let room = geometry.nc_slots - header::END;
    let bytes = number(header::SECTIONS).checked_mul(section::BYTES).filter(|bytes| *bytes <= room)?;
    let mut table = vec![0; bytes];
    words.read(header::END, &mut table);
    let sections: Option<Vec<_>> =
        table.chunks_exact(section::BYTES).map(|entry| parse(entry, geometry.image_bytes)).collect();
    Some((geometry, sections?))
}

impl Geometry {
    /// Whether all slots and tables are inside the file, at whole words.
    fn is_possible(&self, length: usize) -> bool {
        let end = |first: usize, bytes: usize| bytes.checked_mul(self.slots).and_then(|bytes| bytes.checked_add(first));
        let words = [self.image_bytes, self.nc_slots, self.nc_slot_bytes, self.plc_slots, self.plc_slot_bytes];
        (1..=1024).contains(&self.slots)
            && self.file_bytes <= length
            && words.iter().all(|number| *number <= length && number % WORD == 0)
            && self.nc_slots >= header::END
            && self.nc_slot_bytes >= step::IMAGE + self.image_bytes + WORD
            && self.plc_slot_bytes >= answer::BEFORE + 2 * self.image_bytes + WORD
            && end(self.nc_slots, self.nc_slot_bytes).is_some_and(|end| end <= self.plc_slots)
            && end(self.plc_slots, self.plc_slot_bytes).is_some_and(|end| end <= self.file_bytes)
    }
}
