//! Tests of reading, writing, cloning and storing the memory.

use crate::image::{Address, Area, Bytes, DataBlock, Memory, Part, SINUMERIK};
use crate::units::AxisNumber;

use super::{D828, SL, full_of, names};

fn value(memory: &Memory, text: &str) -> f64 {
    let address: Address = text.parse().unwrap();
    memory.value(memory.locate(&address, SL).unwrap())
}

/// The value at an address, to the last bit.
fn reads(memory: &Memory, text: &str, expected: f64) -> bool {
    value(memory, text).total_cmp(&expected).is_eq()
}

fn write(memory: &mut Memory, text: &str, raw: u64) {
    let address: Address = text.parse().unwrap();
    let location = memory.locate(&address, SL).unwrap();
    memory.write(location, raw);
}

#[test]
fn a_word_is_big_endian_and_its_suffix_selects_the_format() {
    let mut memory = Memory::new();
    write(&mut memory, "MW10", 0xFF9C);
    assert_eq!((memory.flags[10], memory.flags[11]), (0xFF, 0x9C));
    assert!(reads(&memory, "MW10", 65436.0) && reads(&memory, "MW10:INT", -100.0));
    write(&mut memory, "DB2.DBD4", 0xC000_0000);
    assert!(reads(&memory, "DB2.DBD4", 3_221_225_472.0));
    assert!(reads(&memory, "DB2.DBD4:DINT", -1_073_741_824.0));
    assert!(reads(&memory, "DB2.DBD4:REAL", -2.0));
}

#[test]
fn a_real_of_the_catalogue_is_a_real_without_a_suffix() {
    let mut memory = Memory::new();
    memory.from_nck_mut().axes[AxisNumber::FIRST].set_positioning_axis_f_function(1500.5);
    assert!(reads(&memory, "DB31.DBD78", 1500.5));
    assert!(reads(&memory, "DB31.DBD78:DINT", f64::from(1500.5_f32.to_bits())));
    let names = names();
    let real = names.resolve(&memory, "DB31.DBD78").unwrap();
    assert_eq!(names.address(real).to_string(), "DB31.DBD78");
    let integer = names.resolve(&memory, "DB31.DBD78:DINT").unwrap();
    assert_eq!(names.address(integer).to_string(), "DB31.DBD78:DINT");
}

#[test]
fn writing_a_group_leaves_the_rest_of_its_byte() {
    let mut memory = full_of(0xFF);
    let location = names().resolve(&memory, "nck.handwheel_1_axis_number").unwrap();
    memory.write(location, 3);
    assert!(reads(&memory, "DB10.DBB100", f64::from(0b1110_0011)));
    assert_eq!(names().address(location).to_string(), "DB10.DBX100.0..4");
    memory.write(location, 0xFF);
    assert_eq!(memory.read(location), 0x1F);
}

#[test]
fn plain_bytes_are_memory_like_any_other() {
    let (mut memory, names) = (Memory::new(), names());
    for text in ["DB10.DBB0", "DB10.DBB271", "DB11.DBX63.7", "DB21.DBW300", "DB22.DBB290", "DB31.DBB59", "DB61.DBD144"]
    {
        write(&mut memory, text, 1);
        assert!(reads(&memory, text, 1.0), "{text}");
        let location = names.resolve(&memory, text).unwrap();
        assert_eq!(names.writer(location), None, "{text}");
        assert_eq!(names.address(location).to_string(), text);
        write(&mut memory, text, 0);
    }
    assert_eq!(memory, Memory::new());
}

#[test]
fn timers_and_counters_are_words() {
    let mut memory = Memory::new();
    write(&mut memory, "T5", 0x2127);
    write(&mut memory, "C3", 0x0042);
    assert_eq!(memory.timers[10..12], [0x21, 0x27]);
    assert_eq!(memory.counters[6..8], [0x00, 0x42]);
}

#[test]
fn bytes_are_read_and_written_across_the_writers() {
    let mut memory = Memory::new();
    let pattern: Vec<u8> = (0..148).collect();
    memory.write_bytes(Area::DataBlock(33), 0, &pattern, SL).unwrap();
    let mut read = vec![0; 100];
    memory.read_bytes(Area::DataBlock(33), 20, &mut read, SL).unwrap();
    assert_eq!(read, pattern[20..120]);
    let xf = AxisNumber::new(3).unwrap();
    assert_eq!(memory.to_nck().axes[xf].feed_override(), 0);
    assert!(memory.from_nck().axes[xf].gantry_trip_limit_exceeded(), "byte 101 is 101 = 0110_0101b");
    for (db, length) in [(10, 272), (11, 64), (30, 416), (61, 148)] {
        let pattern: Vec<u8> = (0..length).map(|index| u8::try_from(index % 251).unwrap()).collect();
        memory.write_bytes(Area::DataBlock(db), 0, &pattern, SL).unwrap();
        assert_eq!(super::data_block(&memory, db, pattern.len()), pattern, "DB{db}");
    }
}

#[test]
fn bytes_beyond_the_end_are_refused_and_nothing_is_written() {
    let mut memory = Memory::new();
    assert!(memory.write_bytes(Area::DataBlock(31), 140, &[1; 9], SL).is_err());
    assert!(memory.write_bytes(Area::DataBlock(3800), 10, &[1; 3], D828).is_err());
    assert!(memory.write_bytes(Area::Flags, 255, &[1; 2], SL).is_err());
    assert!(memory.write_bytes(Area::Flags, u32::MAX, &[1; 2], SL).is_err());
    assert!(memory.write_bytes(Area::DataBlock(99), 0, &[1], SL).is_err());
    assert!(memory.read_bytes(Area::DataBlock(31), 148, &mut [0], SL).is_err());
    assert_eq!(memory, Memory::new());
}

#[test]
fn a_stored_memory_is_restored_unchanged() {
    let mut memory = full_of(0x5A);
    memory.inputs[3] = 7;
    memory.blocks.put(DataBlock { number: 1000, name: Some("recipes".into()), bytes: Bytes::zeroed(9) });
    let stored = postcard::to_stdvec(&memory).unwrap();
    assert!(stored.len() < 16_000, "bytes are stored as bytes: {}", stored.len());
    assert_eq!(postcard::from_bytes::<Memory>(&stored).unwrap(), memory);
    let text = serde_json::to_string(&memory).unwrap();
    assert_eq!(serde_json::from_str::<Memory>(&text).unwrap(), memory);
    assert!(memory.fits(&SINUMERIK));
    let foreign = text.replacen("\"hmi\":[90,", "\"hmi\":[", 1);
    assert!(!serde_json::from_str::<Memory>(&foreign).unwrap().fits(&SINUMERIK));
}

#[test]
fn a_clone_is_independent() {
    let first = Memory::new();
    let mut second = first.clone();
    assert_eq!(first.flags.as_ptr(), second.flags.as_ptr(), "shared until the first write");
    second.flags.set_bit(10, 3, false);
    assert_eq!(first.flags.as_ptr(), second.flags.as_ptr(), "writing the same value changes nothing");
    second.flags.set_bit(10, 3, true);
    second.blocks.get_mut(4).unwrap().set_word(0, 0x1234);
    assert!(!first.flags.bit(10, 3) && second.flags.bit(10, 3));
    assert_eq!((first.blocks.get(4).unwrap().word(0), second.blocks.get(4).unwrap().word(0)), (0, 0x1234));
    assert_ne!(first, second);
}

#[test]
fn accesses_beyond_an_area_are_ignored_in_a_program() {
    let mut bytes = Bytes::zeroed(4);
    bytes.set_double(2, 0x0102_0304);
    bytes.set_bit(99, 1, true);
    assert_eq!(bytes[..], [0, 0, 1, 2]);
    assert!(!bytes.bit(99, 1));
    bytes.set_real(0, 1.5);
    assert_eq!(bytes.real(0).to_bits(), 1.5_f32.to_bits());
}

#[test]
fn own_blocks_stay_in_order_and_a_missing_one_reads_as_nothing() {
    let mut memory = Memory::new();
    memory.blocks.put(DataBlock { number: 3, name: None, bytes: Bytes::zeroed(1) });
    let numbers: Vec<u16> = memory.blocks.iter().map(|block| block.number).collect();
    assert_eq!(numbers, [2, 3, 4, 5, 7, 18, 19, 20, 71, 72, 73]);
    let location = names().resolve(&memory, "DB3.DBB0").unwrap();
    assert_eq!(location.part, Part::Block(3));
    assert_eq!(Memory::new().read(location), 0);
    let mut other = Memory::new();
    other.write(location, 5);
    assert_eq!(other, Memory::new());
}
