//! Tests of the file from both sides.

use std::fs;
use std::path::{Path, PathBuf};

use super::{
    Look, MAGIC, MappedImage, PlcImage, Refusal, Rules, Section, Source, State, Step, answer, header, section, step,
};
use crate::image::{Area, Memory, Names, Profile, SINUMERIK};
use crate::units::{AxisNumber, Time};

const RULES: Rules = Rules { lock_step: false, time_out: Time::from_millis(100) };

/// A file for one test.
struct File(PathBuf);

impl File {
    fn new(name: &str) -> Self {
        let file = Self(std::env::temp_dir().join(format!("opennck-{}-{name}.image", std::process::id())));
        let _ = fs::remove_file(&file.0);
        file
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn names() -> Names {
    let mut names = Names::default();
    names.axes[AxisNumber::FIRST] = Some("X".to_owned());
    names
}

fn step(cycle: u64) -> Step {
    Step { cycle, time: Time::from_millis(2 * cycle.cast_signed()), since_last: Time::from_millis(2) }
}

fn create(file: &File, memory: &Memory) -> MappedImage {
    MappedImage::create(&file.0, memory, &names(), RULES).unwrap()
}

/// Both sides, and an answer to the published step.
fn both(file: &File, memory: &Memory) -> (MappedImage, PlcImage) {
    let nc = create(file, memory);
    let plc = PlcImage::open(&file.0).unwrap();
    (nc, plc)
}

fn at(plc: &PlcImage, db: u16, byte: u32) -> usize {
    plc.offset(Area::DataBlock(db), byte).unwrap()
}

#[test]
fn every_field_is_documented_at_its_position() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for document in ["src/image/mapped/mod.rs", "docs/plc_in_another_process.md"] {
        let text = fs::read_to_string(root.join(document)).unwrap();
        let mut rows = text.lines().map(|line| line.trim_start_matches("//! "));
        for table in [header::FIELDS, section::FIELDS, step::FIELDS, answer::FIELDS] {
            assert!(rows.any(|row| row.starts_with("| byte | bytes |")), "{document} must have one table for each");
            for (offset, bytes, field) in table {
                let bytes = if *bytes == 0 { "`IMAGE_BYTES`".to_owned() } else { bytes.to_string() };
                let wanted = format!("| {offset} | {bytes} | `{field}` | ");
                assert!(rows.any(|row| row.starts_with(&wanted)), "{document} has no row `{wanted}` at its position");
            }
        }
    }
}

#[test]
fn sections_have_one_writer_and_step_7_addresses() {
    let file = File::new("sections");
    let (_nc, plc) = both(&file, &Memory::new());
    let of = |db| plc.sections().iter().filter(move |s| s.area == Area::DataBlock(db)).collect::<Vec<&Section>>();
    let spans: Vec<_> = of(31).iter().map(|s| (s.first, s.length, s.writer, s.name.as_str())).collect();
    // In DB31, bytes 0 to 59 belong to the PLC, 60 to 107 to the NCK; the rest is plain memory.
    assert_eq!(spans, [(0, 60, Source::Plc, "X"), (60, 48, Source::Nck, "X"), (108, 40, Source::Plc, "X")]);
    let hmi: Vec<_> = of(10).iter().filter(|s| s.writer == Source::Hmi).map(|s| (s.first, s.length)).collect();
    assert_eq!(hmi, [(97, 7)]);
    for db in (10..=11).chain(21..=61).chain(SINUMERIK.tables().standard_blocks.iter().copied()) {
        let first = of(db)[0];
        assert_eq!((first.first, first.offset % 8), (0, 0), "DB{db}");
        assert!(of(db).iter().all(|s| s.offset == first.offset + s.first), "DB{db} is contiguous");
    }
    assert_eq!(plc.offset(Area::DataBlock(31), 148), None);
    assert_eq!(plc.offset(Area::DataBlock(30), 415).map(|end| end + 1), plc.offset(Area::DataBlock(31), 0));
}

#[test]
fn the_828d_has_its_own_blocks_with_their_gaps() {
    let file = File::new("828d");
    let names = Names { profile: Profile::SINUMERIK_828D, ..names() };
    let nc = MappedImage::create(&file.0, &Memory::new(), &names, RULES).unwrap();
    let spans = |db| {
        let of = nc.sections().iter().filter(move |s| s.area == Area::DataBlock(db));
        of.map(|s| (s.first, s.length, s.writer)).collect::<Vec<_>>()
    };
    let axis = [(0, 12), (1000, 4), (2000, 4), (3000, 12), (4000, 4), (5000, 8)];
    assert_eq!(spans(3800), axis.map(|(first, length)| (first, length, Source::Plc)));
    // FC 18 answers in 3000 to 3003.
    let mut nck = axis.map(|(first, length)| (first, length, Source::Nck));
    nck[3].1 = 4;
    assert_eq!(spans(3900), nck);
    assert_eq!(spans(31), []);
}

#[test]
fn a_step_arrives_complete_and_only_bits_that_the_plc_changed_are_taken() {
    let file = File::new("both");
    let mut memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    let x = AxisNumber::FIRST;
    memory.from_nck_mut().axes[x].set_gantry_synchronization_ready_to_start(true); // DB31.DBX101.4
    memory.flags.set_byte(10, 0b0001);
    let number = nc.publish(&memory, step(7), false);
    assert_eq!(plc.next_step(), Some(number));
    assert_eq!((plc.step(), plc.next_step()), (step(7), None));
    let (ready, start, flag) = (at(&plc, 31, 101), at(&plc, 31, 29), plc.offset(Area::Flags, 10).unwrap());
    assert_eq!((plc.image()[ready], plc.image()[start], plc.image()[flag]), (0b1_0000, 0, 0b0001));
    plc.image_mut()[start] |= 0b1_0000; // DB31.DBX29.4
    plc.image_mut()[ready] = 0; // a bit that the PLC does not own
    plc.image_mut()[flag] |= 0b0010;
    plc.answer();
    memory.flags.set_byte(10, 0b0100); // in the meantime an HMI has set M10.0 = 0 and M10.2 = 1
    assert_eq!(nc.look(number), Look::Answer(number));
    nc.take(&mut memory);
    assert!(memory.to_nck().axes[x].start_gantry_synchronization());
    assert!(memory.from_nck().axes[x].gantry_synchronization_ready_to_start());
    assert_eq!(memory.flags.byte(10), 0b0110);
    assert_eq!(nc.look(number), Look::Nothing);
}

#[test]
fn a_list_of_changes_and_two_images_say_the_same() {
    let file = File::new("list");
    let mut memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    let flags = plc.offset(Area::Flags, 0).unwrap();
    let bytes = plc.offset(Area::Flags, 200).unwrap() - flags;
    for changed in [0, 3, bytes] {
        let number = nc.publish(&memory, step(1), false);
        plc.next_step().unwrap();
        plc.image_mut()[flags..flags + changed].iter_mut().for_each(|byte| *byte ^= 0b101);
        plc.answer();
        let answered = nc.words.load(header::NEWEST_ANSWER);
        let entries = nc.words.load(nc.geometry.plc_slot(answered) + answer::CHANGES);
        assert_eq!(entries, changed as u64 + 1);
        let mut expected = memory.clone();
        for byte in 0..changed {
            expected.flags.set_byte(byte, expected.flags.byte(byte) ^ 0b101);
        }
        assert_eq!(nc.look(number), Look::Answer(number));
        nc.take(&mut memory);
        assert_eq!(memory, expected);
    }
    // A list may name what the PLC does not own, and what does not exist.
    let number = nc.publish(&memory, step(2), false);
    plc.next_step().unwrap();
    plc.image_mut()[flags] ^= 1;
    plc.answer();
    let slot = nc.geometry.plc_slot(nc.words.load(header::NEWEST_ANSWER));
    for offset in [at(&plc, 31, 101), nc.geometry.image_bytes, usize::try_from(u32::MAX).unwrap()] {
        nc.words.store(slot + answer::BEFORE, offset as u64 | 0xFF << 40);
        nc.seen = 0;
        assert_eq!(nc.look(0), Look::Answer(number));
        let before = memory.clone();
        nc.take(&mut memory);
        assert_eq!(memory, before);
    }
}

#[test]
fn two_processes_that_answer_in_turn_are_told_from_one_after_the_other() {
    let file = File::new("two");
    let memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    let mut answer_as = |process: u64| {
        let number = nc.publish(&memory, step(1), false);
        plc.next_step().unwrap();
        plc.answer();
        let slot = nc.geometry.plc_slot(nc.words.load(header::NEWEST_ANSWER));
        nc.words.store(slot + answer::PROCESS, process);
        assert_eq!(nc.look(number), Look::Answer(number));
        (nc.take_replacement(), nc.take_both())
    };
    let (replacements, both): (Vec<_>, Vec<_>) = [7, 7, 8, 8, 9, 0, 8, 8, 9].into_iter().map(&mut answer_as).unzip();
    assert_eq!(replacements, [None, None, Some([8, 7]), None, Some([9, 8]), None, None, None, None]);
    assert_eq!(both, [None, None, None, None, None, None, Some([9, 8]), None, Some([8, 9])]);
}

#[test]
fn a_plc_that_counts_in_its_flags_counts_every_answer_once() {
    let file = File::new("counts");
    let mut memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    let flag = plc.offset(Area::Flags, 0).unwrap();
    for count in 1..=20 {
        nc.publish(&memory, step(2 * u64::from(count)), false);
        plc.next_step().unwrap();
        plc.image_mut()[flag] += 1;
        plc.answer();
        // The next step is published before the answer is taken: it still has the old count and is not used for the next scan.
        nc.publish(&memory, step(2 * u64::from(count) + 1), false);
        assert_eq!(plc.next_step(), None);
        assert!(matches!(nc.look(0), Look::Answer(_)));
        nc.take(&mut memory);
        assert_eq!(memory.flags.byte(0), count);
    }
}

#[test]
fn an_answer_from_before_the_start_is_not_taken() {
    let file = File::new("start");
    let memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    plc.next_step().unwrap();
    plc.answer();
    let least = nc.start();
    assert_eq!(nc.look(least), Look::Refused(Refusal::Step));
    assert_eq!(nc.publish(&memory, step(1), true), least);
    assert!(!nc.is_acknowledged(least));
    // The rejected answer was seen, so the PLC continues.
    assert_eq!((plc.next_step(), plc.starts()), (Some(least), 1));
    plc.answer();
    assert!(nc.is_acknowledged(least));
    assert_eq!(nc.look(least), Look::Answer(least));
}

fn length_of_an_image() -> u64 {
    let file = File::new("length");
    let _nc = create(&file, &Memory::new());
    fs::metadata(&file.0).unwrap().len()
}

#[test]
fn zeros_of_an_interrupted_creation_are_a_new_file() {
    let file = File::new("zeros");
    let length = length_of_an_image();
    for left in [0, 1, 8, 16, 64, 4096, length - 1, length] {
        let _ = fs::remove_file(&file.0);
        fs::write(&file.0, vec![0; usize::try_from(left).unwrap()]).unwrap();
        assert!(PlcImage::open(&file.0).is_err(), "{left}");
        let (mut nc, mut plc) = both(&file, &Memory::new());
        assert_eq!(plc.next_step(), Some(1), "{left}");
        plc.answer();
        assert_eq!((nc.look(1), fs::metadata(&file.0).unwrap().len()), (Look::Answer(1), length), "{left}");
    }
    // Creation interrupted when the file is already an image, but without tables: invalid for the PLC, reusable for the next NC.
    fs::write(&file.0, [&MAGIC[..], &1_u64.to_le_bytes(), &[0; 8000]].concat()).unwrap();
    let problem = PlcImage::open(&file.0).unwrap_err();
    assert!(problem.what.contains("has not finished creating it"), "{problem}");
    assert_eq!(both(&file, &Memory::new()).1.next_step(), Some(1));
}

#[test]
fn a_file_that_is_not_an_image_stays_unchanged() {
    let file = File::new("foreign");
    let other = [&MAGIC[..], &2_u64.to_le_bytes()].concat();
    let length = usize::try_from(length_of_an_image()).unwrap();
    let (zeros, end) = (vec![0; length + 1], [vec![0; length - 1], vec![1]].concat());
    let contents = [(&b"a letter"[..], "other contents"), (&zeros, "other contents"), (&end, "other contents")];
    for (content, said) in contents.into_iter().chain([(&other[..], "version 2")]) {
        fs::write(&file.0, content).unwrap();
        let problem = MappedImage::create(&file.0, &Memory::new(), &names(), RULES).unwrap_err();
        assert!(problem.what.contains(said) && problem.place.is_some(), "{problem}");
        assert!(PlcImage::open(&file.0).is_err());
        assert!(fs::read(&file.0).unwrap() == content, "{said}");
    }
    let folder = MappedImage::create(&std::env::temp_dir(), &Memory::new(), &names(), RULES).unwrap_err();
    assert!(folder.what.contains("expected a regular file"), "{folder}");
    let nowhere = std::env::temp_dir().join("no/such/folder/nck.image");
    let nowhere = MappedImage::create(&nowhere, &Memory::new(), &names(), RULES).unwrap_err();
    assert!(nowhere.what.contains("cannot be used"), "{nowhere}");
}

#[test]
fn one_nc_at_a_time_serves_a_file_and_numbers_continue() {
    let file = File::new("again");
    let memory = Memory::new();
    let mut first = create(&file, &memory);
    let problem = MappedImage::create(&file.0, &memory, &names(), RULES).unwrap_err();
    assert!(problem.what.contains("in use by another machine"), "{problem}");
    let number = first.publish(&memory, step(1), false);
    let mut plc = PlcImage::open(&file.0).unwrap();
    plc.next_step().unwrap();
    plc.answer();
    assert_eq!((plc.state(), first.has_started()), (State::Stop, false));
    first.state(State::Run);
    assert_eq!(plc.state(), State::Run);
    drop(first);
    assert_eq!(plc.state(), State::Ended);
    // Longer than needed, as if it had more data blocks. The length is kept, because another process may have all of it mapped.
    let length = fs::metadata(&file.0).unwrap().len() + 4096;
    fs::File::options().write(true).open(&file.0).unwrap().set_len(length).unwrap();
    let mut second = create(&file, &memory);
    assert_eq!(fs::metadata(&file.0).unwrap().len(), length);
    assert_eq!(plc.state(), State::Ended, "the PLC must read the header again");
    assert_eq!(second.look(0), Look::Nothing, "an answer to the first NC is not an answer to the second");
    assert!(second.publish(&memory, step(1), false) > number);
    assert_eq!(PlcImage::open(&file.0).unwrap().state(), State::Stop);
}

#[test]
fn an_invalid_header_or_slot_is_rejected_without_reading_beyond_the_file() {
    let file = File::new("broken");
    let memory = Memory::new();
    let (mut nc, mut plc) = both(&file, &memory);
    let number = nc.publish(&memory, step(1), false);
    plc.next_step().unwrap();
    plc.answer();
    let slot = nc.geometry.plc_slot(1);
    for too_long in [nc.geometry.image_bytes as u64, u64::MAX] {
        nc.words.store(slot + answer::CHANGES, too_long);
        assert_eq!(nc.look(number), Look::Refused(Refusal::Changes));
    }
    for changes in [0, 1] {
        nc.words.store(slot + answer::CHANGES, changes); // images, or a list
        nc.words.store(slot + nc.geometry.plc_slot_bytes - 8, 7);
        assert_eq!(nc.look(number), Look::Refused(Refusal::Checksum));
    }
    nc.words.store(slot + nc.geometry.plc_slot_bytes - 8, 0); // none: a PLC with barriers
    assert_eq!(nc.look(number), Look::Answer(number));
    nc.words.store(header::NEWEST_ANSWER, u64::MAX);
    assert_eq!(nc.look(number), Look::Refused(Refusal::Number));
    for (offset, _, field) in header::FIELDS.iter().take_while(|(offset, ..)| *offset <= header::PLC_SLOT_BYTES) {
        let right = nc.words.load(*offset);
        for wrong in [1_u64 << 20, 1 << 40, u64::MAX] {
            nc.words.store(*offset, wrong);
            let opened = PlcImage::open(&file.0);
            let may = [header::GENERATION, header::PROFILE].contains(offset);
            assert_eq!(opened.is_ok(), may, "{field} {wrong}");
        }
        nc.words.store(*offset, right);
    }
}

#[test]
fn a_section_beyond_the_image_is_refused() {
    let file = File::new("sections-wrong");
    let nc = create(&file, &Memory::new());
    let image_bytes = nc.geometry.image_bytes as u64;
    let last = header::END + (nc.sections().len() - 1) * section::BYTES;
    let length = nc.words.load(last + section::LENGTH);
    let u32_max = u64::from(u32::MAX);
    for (field, wrong) in [
        (section::OFFSET, [image_bytes - length + 1, u32_max, u64::MAX]),
        (section::LENGTH, [image_bytes + 1, u32_max, u64::MAX]),
        (section::FIRST, [u32_max, u32_max - length + 1, u64::MAX]),
    ] {
        let right = nc.words.load(last + field);
        for wrong in wrong {
            nc.words.store(last + field, wrong);
            assert!(PlcImage::open(&file.0).is_err(), "{field} {wrong}");
        }
        nc.words.store(last + field, right);
    }
    assert!(PlcImage::open(&file.0).is_ok());
}

#[test]
fn a_stale_plc_writes_nothing_and_an_image_without_an_nc_is_not_opened() {
    let file = File::new("stale");
    let memory = Memory::new();
    let (first, mut plc) = both(&file, &memory);
    plc.next_step().unwrap();
    drop(first);
    let problem = PlcImage::open(&file.0).unwrap_err();
    assert!(problem.what.contains("no NC serves this image"), "{problem}");
    let second = create(&file, &memory);
    let before = fs::read(&file.0).unwrap();
    plc.answer();
    assert!(before == fs::read(&file.0).unwrap());
    drop(second);
}

#[test]
fn numbers_of_a_file_may_be_at_their_maximum() {
    let file = File::new("end");
    let memory = Memory::new();
    let nc = create(&file, &memory);
    for word in [header::GENERATION, header::NEWEST_STEP, header::PLC_STARTS, header::NEWEST_ANSWER, header::POWER] {
        nc.words.store(word, u64::MAX);
    }
    drop(nc);
    let (mut nc, mut plc) = both(&file, &memory);
    plc.power_off_and_on();
    assert_eq!((nc.plc_starts(), nc.power_requests(), nc.words.load(header::GENERATION)), (1, 1, 1));
    assert_eq!((nc.start(), plc.next_step()), (2, Some(1)));
    plc.answer();
    assert_eq!(nc.look(1), Look::Answer(1));
    assert_eq!(nc.words.load(header::NEWEST_ANSWER), 1);
}

#[test]
fn the_nc_survives_random_contents_of_the_file() {
    let file = File::new("scribbled");
    let mut memory = Memory::new();
    let mut nc = create(&file, &memory);
    let mut state = 0x9E37_79B9_7F4A_7C15_u64;
    let mut random = || {
        // xorshift: the same in every run
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        state
    };
    let bytes = nc.geometry.file_bytes;
    let (mut taken, mut least) = (0, 0);
    for cycle in 0..2000 {
        for _ in 0..20 {
            let place = usize::try_from(random()).unwrap_or(0) % (bytes / 8) * 8;
            nc.words.store(place, random());
        }
        // Writes random values to the words that the NC reads, and sometimes an answer with valid numbers and random contents.
        for word in [header::PLC_STARTS, header::NEWEST_ANSWER, header::ACKNOWLEDGE, header::POWER, header::STATE] {
            nc.words.store(word, [0, 1, u64::MAX, random()][usize::try_from(cycle % 4).unwrap()]);
        }
        let answer = nc.words.load(header::NEWEST_ANSWER);
        if cycle % 3 == 0 {
            let slot = nc.geometry.plc_slot(answer);
            nc.words.store(slot, answer);
            nc.words.store(slot + answer::ANSWERS, nc.words.load(header::NEWEST_STEP));
            nc.words.store(slot + nc.geometry.plc_slot_bytes - 8, 0);
        }
        if cycle % 100 == 0 {
            least = nc.start();
        }
        let from_nck = memory.from_nck.clone();
        if let Look::Answer(_) = nc.look(least) {
            nc.take(&mut memory);
            taken += 1;
        }
        assert!(memory.from_nck == from_nck, "the PLC must not write signals of the NCK");
        let _ = (nc.plc_starts(), nc.power_requests(), nc.is_acknowledged(answer));
        nc.publish(&memory, step(cycle), false);
        let _ = PlcImage::open(&file.0);
    }
    assert!(taken > 10, "some random answers must be valid: {taken}");
    drop(nc);
    // An NC starts with any contents, or reports that the file is not an image.
    let _ = MappedImage::create(&file.0, &memory, &names(), RULES);
}
