//! Tests of the STEP 7 notation.

use proptest::prelude::*;

use crate::image::{Address, Area, Format, Memory, Width};

use super::{D828, SL};

fn any_address() -> impl Strategy<Value = Address> {
    let area = prop_oneof![
        (0_u16..).prop_map(Area::DataBlock),
        prop::sample::select(vec![Area::Inputs, Area::Outputs, Area::Flags, Area::Timers, Area::Counters]),
    ];
    let width = prop_oneof![
        (0_u8..8).prop_map(Width::Bit),
        (0_u8..7, 1_u8..7)
            .prop_filter("inside a byte", |(first, more)| first + more < 8)
            .prop_map(|(first, more)| { Width::Bits { first, last: first + more } }),
        prop::sample::select(vec![Width::Byte, Width::Word, Width::Double]),
    ];
    let format = prop::sample::select(vec![None, Some(Format::Signed), Some(Format::Real)]);
    (area, any::<u16>(), width, format).prop_map(|(area, byte, width, format)| {
        let width = if matches!(area, Area::Timers | Area::Counters) { Width::Word } else { width };
        let is_number = !matches!(area, Area::Timers | Area::Counters)
            && (width == Width::Double || (width == Width::Word && format == Some(Format::Signed)));
        Address { area, byte, width, format: format.filter(|_| is_number) }
    })
}

proptest! {
    #[test]
    fn an_address_reads_back_as_it_was_printed(address in any_address()) {
        prop_assert_eq!(address.to_string().parse::<Address>().unwrap(), address);
    }

    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,20}|(DB|M|I|Q|T|C)[0-9DBXWT.:é]{0,12}") {
        if let Ok(address) = text.parse::<Address>() {
            let _ = Memory::new().locate(&address, SL);
            let _ = Memory::new().locate(&address, D828);
        }
    }
}

#[test]
fn the_notation_of_step_7_is_read() {
    let address = |area, byte, width, format| Address { area, byte, width, format };
    let axis = Area::DataBlock(31);
    for (text, expected) in [
        ("DB31.DBX101.5", address(axis, 101, Width::Bit(5), None)),
        ("DB31.DBB101", address(axis, 101, Width::Byte, None)),
        ("DB21.DBW4", address(Area::DataBlock(21), 4, Width::Word, None)),
        ("DB31.DBD78:REAL", address(axis, 78, Width::Double, Some(Format::Real))),
        ("DB31.DBD78:DINT", address(axis, 78, Width::Double, Some(Format::Signed))),
        ("MW4:INT", address(Area::Flags, 4, Width::Word, Some(Format::Signed))),
        ("M10.3", address(Area::Flags, 10, Width::Bit(3), None)),
        ("IB0", address(Area::Inputs, 0, Width::Byte, None)),
        ("I3.4", address(Area::Inputs, 3, Width::Bit(4), None)),
        ("QW4", address(Area::Outputs, 4, Width::Word, None)),
        ("MD8", address(Area::Flags, 8, Width::Double, None)),
        ("T5", address(Area::Timers, 5, Width::Word, None)),
        ("C3", address(Area::Counters, 3, Width::Word, None)),
        ("DB10.DBX100.0..4", address(Area::DataBlock(10), 100, Width::Bits { first: 0, last: 4 }, None)),
        ("DB3900.DBX0001.2", address(Area::DataBlock(3900), 1, Width::Bit(2), None)),
    ] {
        assert_eq!(text.parse::<Address>().unwrap(), expected, "{text}");
    }
    assert_eq!("DB3900.DBX0001.2".parse::<Address>().unwrap().to_string(), "DB3900.DBX1.2");
}

#[test]
fn an_invalid_address_is_rejected_with_an_example() {
    for text in [
        "",
        "DB",
        "DB31",
        "DB31.",
        "DB31.DB",
        "DB31.DBX",
        "DB31.DBX1",
        "DB31.DBX1.",
        "DB31.DBX.1",
        "DB31.DBB1.0",
        "DB31.DBQ1",
        "db31.dbx1.0",
        "DB31.DBX1.3 ",
        "DB31.DBX1.0..0",
        "DB31.DBX1.0..7",
        "DB31.DBX1.5..3",
        "DB70000.DBB0",
        "DB31.DBB70000",
        "DB31.DBB+1",
        "M",
        "M10",
        "MX1.0",
        "M1.0:INT",
        "MB1:INT",
        "MW1:REAL",
        "MD1:INT",
        "MD1:real",
        "T",
        "T1.0",
        "TB1",
        "C-1",
        "A1.0",
        "E1.0",
        "X",
        "DB31.DBD78:",
    ] {
        let problem = text.parse::<Address>().unwrap_err();
        assert!(!problem.what.is_empty() && !problem.cure.is_empty(), "{text}");
    }
}

#[test]
fn a_bit_beyond_seven_is_named() {
    for text in ["DB31.DBX1.8", "M10.9", "I0.10"] {
        let problem = text.parse::<Address>().unwrap_err().to_string();
        assert!(problem.contains("a bit from 0 to 7") && problem.contains(text), "{problem}");
    }
}

fn refused(text: &str) -> String {
    let address: Address = text.parse().unwrap();
    Memory::new().locate(&address, SL).unwrap_err().to_string()
}

#[test]
fn an_address_beyond_its_block_is_refused_with_the_length() {
    for (text, length) in [
        ("DB10.DBB272", "272 bytes of DB10"),
        ("DB11.DBX64.0", "64 bytes of DB11"),
        ("DB21.DBB416", "416 bytes of DB21"),
        ("DB30.DBW415", "416 bytes of DB30"),
        ("DB31.DBX148.0", "148 bytes of DB31"),
        ("DB61.DBD145", "148 bytes of DB61"),
        ("DB2.DBB256", "256 bytes of DB2"),
        ("M256.0", "256 bytes of M"),
        ("IB128", "128 bytes of I"),
        ("QD125", "128 bytes of Q"),
        ("T32", "64 bytes of T"),
        ("C32", "64 bytes of C"),
    ] {
        let problem = refused(text);
        assert!(problem.contains(length) && problem.starts_with(text), "{problem}");
    }
    for text in ["DB10.DBB271", "DB11.DBB63", "DB30.DBB415", "DB61.DBD144", "DB73.DBB255", "M255.7", "T31", "C31"] {
        assert!(Memory::new().locate(&text.parse().unwrap(), SL).is_ok(), "{text}");
    }
}

#[test]
fn an_unknown_data_block_is_refused_with_the_known_ones() {
    for text in ["DB1.DBB0", "DB12.DBB0", "DB62.DBB0", "DB1000.DBB0"] {
        let problem = refused(text);
        assert!(problem.contains("DB31 to DB61") && problem.contains("71, 72, 73"), "{problem}");
    }
    assert!(refused("DB3900.DBX0.4").contains("828D"));
}

#[test]
fn a_number_over_bytes_of_two_writers_is_refused() {
    assert!(refused("DB31.DBD58").contains("two writers"));
    assert!(refused("DB21.DBW31").contains("two writers"));
}
