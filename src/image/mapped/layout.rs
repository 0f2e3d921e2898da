//! The order of bytes in the image: sections in the order of data block numbers, then I, Q, M, T and C.

use super::fields::section;
use super::words::field;
use crate::image::{Area, Memory, Names, Part, Parts, Profile};
use crate::source::Problem;

/// The writer of the bytes of a section.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The PLC; the NC takes its changes.
    Plc,
    /// The NCK.
    Nck,
    /// The HMI.
    Hmi,
    /// The machine (inputs).
    Machine,
}

/// The codes of the writers in the file.
const SOURCES: [(Source, u64); 4] = [(Source::Plc, 1), (Source::Nck, 2), (Source::Hmi, 3), (Source::Machine, 4)];

/// Adjacent bytes of one area or data block with one writer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Section {
    /// The area or data block.
    pub area: Area,
    /// Its first byte in this section.
    pub first: u32,
    /// The number of bytes.
    pub length: u32,
    /// The position of the first byte in the image.
    pub offset: u32,
    /// The writer of the bytes.
    pub writer: Source,
    /// The name of the axis, the channel or the data block of the program; empty if it has none.
    pub name: String,
}

/// Bytes that are adjacent in the memory by writer.
#[derive(Clone, Debug)]
struct Piece {
    part: Part,
    start: usize,
    offset: usize,
    length: usize,
}

/// The layout of an image.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) sections: Vec<Section>,
    pieces: Vec<Piece>,
    /// The number of bytes of the image.
    pub(super) length: usize,
}

impl Layout {
    /// The layout for the memory of a machine.
    pub(super) fn of(memory: &Memory, names: &Names) -> Result<Self, Problem> {
        let mut layout = Self { sections: Vec::new(), pieces: Vec::new(), length: 0 };
        let own = |db| memory.blocks.get(db).map_or(0, |bytes| bytes.len());
        for db in 1..=u16::MAX {
            let is_own = memory.blocks.get(db).is_some();
            let spans = if is_own { Vec::new() } else { names.profile.spans(db) };
            let spans = spans.into_iter().map(|(first, end)| (first.into(), end.into()));
            let own = is_own.then(|| (0, own(db)));
            let name = name(memory, names, db);
            for (first, end) in spans.chain(own) {
                layout.append(memory, names.profile, Area::DataBlock(db), first, end, &name)?;
            }
        }
        for area in [Area::Inputs, Area::Outputs, Area::Flags, Area::Timers, Area::Counters] {
            layout.append(memory, names.profile, area, 0, memory.part(area.plain_part()).len(), "")?;
        }
        layout.length = layout.length.next_multiple_of(64);
        Ok(layout)
    }

    /// Appends bytes `first` to before `end`. Bytes that follow the last section in its block also follow it in the image.
    fn append(
        &mut self,
        memory: &Memory,
        profile: Profile,
        area: Area,
        first: usize,
        end: usize,
        name: &str,
    ) -> Result<(), Problem> {
        let number = |number: usize| u32::try_from(number).expect("an area has at most 65535 bytes");
        let mut byte = first;
        while byte < end {
            let run = memory.run(area, number(byte), 1, profile)?;
            let length = (run.left as usize).min(end - byte);
            let writer = match run.part {
                Part::FromNck => Source::Nck,
                Part::Hmi => Source::Hmi,
                Part::Inputs => Source::Machine,
                Part::ToNck | Part::Outputs | Part::Flags | Part::Timers | Part::Counters | Part::Block(_) => {
                    Source::Plc
                }
            };
            let follows = |last: &&mut Section| last.area == area && last.first + last.length == number(byte);
            let last = self.sections.last_mut().filter(follows);
            if last.is_none() {
                self.length = self.length.next_multiple_of(8);
            }
            self.pieces.push(Piece { part: run.part, start: run.offset as usize, offset: self.length, length });
            match last.filter(|last| last.writer == writer) {
                Some(last) => last.length += number(length),
                None => self.sections.push(Section {
                    area,
                    first: number(byte),
                    length: number(length),
                    offset: number(self.length),
                    writer,
                    name: name.to_owned(),
                }),
            }
            self.length += length;
            byte += length;
        }
        Ok(())
    }

    /// Copies the memory into an image.
    pub(super) fn gather(&self, memory: &impl Parts, image: &mut [u8]) {
        for &Piece { part, start, offset, length } in &self.pieces {
            image[offset..offset + length].copy_from_slice(&memory.part(part)[start..start + length]);
        }
    }

    /// Writes the bits that differ between two images into the memory, but only bits that the PLC owns.
    pub(super) fn scatter(&self, before: &[u8], after: &[u8], memory: &mut impl Parts) {
        if before == after {
            return;
        }
        for &Piece { part, start, offset, length } in &self.pieces {
            let (before, after) = (&before[offset..offset + length], &after[offset..offset + length]);
            if before == after || matches!(part, Part::FromNck | Part::Hmi | Part::Inputs) {
                continue;
            }
            for ((byte, before), after) in memory.part_mut(part)[start..].iter_mut().zip(before).zip(after) {
                let changed = before ^ after;
                *byte = *byte & !changed | after & changed;
            }
        }
    }

    /// Writes the bits that differ between two values of one byte of the image, if the PLC owns it. A byte beyond the image is ignored.
    pub(super) fn change(&self, offset: usize, before: u8, after: u8, memory: &mut impl Parts) {
        let at = self.pieces.partition_point(|piece| piece.offset <= offset);
        let Some(piece) = at.checked_sub(1).map(|at| &self.pieces[at]) else { return };
        let place = offset - piece.offset;
        let is_foreign = matches!(piece.part, Part::FromNck | Part::Hmi | Part::Inputs);
        if place >= piece.length || is_foreign {
            return;
        }
        let byte = &mut memory.part_mut(piece.part)[piece.start + place];
        let changed = before ^ after;
        *byte = *byte & !changed | after & changed;
    }

    /// The table of sections in the format of the file.
    pub(super) fn table(&self) -> Vec<u8> {
        self.sections.iter().flat_map(entry).collect()
    }
}

/// The name of the axis, the channel or the data block of the program with this data block number.
fn name(memory: &Memory, names: &Names, db: u16) -> String {
    let Some((block, number)) = names.profile.block_of(db) else {
        let own = memory.blocks.iter().find(|block| block.number == db);
        return own.and_then(|block| block.name.as_deref()).unwrap_or_default().to_owned();
    };
    // A fixed name adds nothing to the number of the data block.
    match names.interface().fixed_name(block, number) {
        Some(_) => String::new(),
        None => names.owner(block, number).unwrap_or_default().to_owned(),
    }
}

fn kind(area: Area) -> (&'static str, u16) {
    match area {
        Area::DataBlock(number) => ("DB", number),
        Area::Inputs => ("I", 0),
        Area::Outputs => ("Q", 0),
        Area::Flags => ("M", 0),
        Area::Timers => ("T", 0),
        Area::Counters => ("C", 0),
    }
}

fn entry(entry: &Section) -> [u8; section::BYTES] {
    let (kind, number) = kind(entry.area);
    let writer = SOURCES.iter().find(|(source, _)| *source == entry.writer).map_or(0, |(_, code)| *code);
    let mut bytes = [0; section::BYTES];
    bytes[section::KIND..section::KIND + kind.len()].copy_from_slice(kind.as_bytes());
    for (offset, value) in [
        (section::NUMBER, number.into()),
        (section::FIRST, entry.first.into()),
        (section::LENGTH, entry.length.into()),
        (section::OFFSET, entry.offset.into()),
        (section::WRITER, writer),
    ] {
        bytes[offset..offset + 8].copy_from_slice(&u64::to_le_bytes(value));
    }
    // The last byte stays 0; a long name is cut between characters.
    let name = &entry.name[..entry.name.floor_char_boundary(section::BYTES - section::NAME - 1)];
    bytes[section::NAME..section::NAME + name.len()].copy_from_slice(name.as_bytes());
    bytes
}

/// Reads a section from the file; `None` if it is not an entry of this version or exceeds the image.
pub(super) fn parse(bytes: &[u8], image_bytes: usize) -> Option<Section> {
    let number = |offset| field(bytes, offset);
    let text = |range: std::ops::Range<usize>| {
        let text = bytes.get(range)?.split(|byte| *byte == 0).next()?;
        std::str::from_utf8(text).ok()
    };
    let area = match text(section::KIND..section::KIND + 8)? {
        "DB" => Area::DataBlock(u16::try_from(number(section::NUMBER)).ok()?),
        letter => Area::of_letter(letter)?,
    };
    let (writer, _) = *SOURCES.iter().find(|(_, code)| *code == number(section::WRITER))?;
    let small = |offset| u32::try_from(number(offset)).ok();
    let (first, length, offset) = (small(section::FIRST)?, small(section::LENGTH)?, small(section::OFFSET)?);
    first.checked_add(length)?;
    let end = usize::try_from(offset.checked_add(length)?).ok()?;
    if end > image_bytes {
        return None;
    }
    Some(Section { area, first, length, offset, writer, name: text(section::NAME..section::BYTES)?.to_owned() })
}
