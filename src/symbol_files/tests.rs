//! Each format with signals of all types. The expected lines follow from the documentation of the tools.

use super::*;
use crate::image::{Address, Area, Format as Number, Width, Writer};

fn symbol(name: &str, block: u16, byte: u16, width: Width, format: Option<Number>) -> Symbol {
    let (owner, signal) = name.split_once('.').unwrap();
    let address = Address { area: Area::DataBlock(block), byte, width, format };
    let meaning = "Positive key: 1 moves.".to_owned();
    Symbol { owner: owner.to_owned(), signal: signal.to_owned(), address, writer: Writer::Plc, meaning }
}

fn all_types() -> Vec<Symbol> {
    vec![
        symbol("X.traversing_key_plus", 31, 4, Width::Bit(7), None),
        symbol("X.parameter_set", 31, 9, Width::Bits { first: 0, last: 2 }, None),
        symbol("X.feed_override", 31, 0, Width::Byte, None),
        symbol("X.speed", 31, 10, Width::Word, None),
        symbol("X.torque", 31, 12, Width::Word, Some(Number::Signed)),
        symbol("X.number", 31, 16, Width::Double, Some(Number::Unsigned)),
        symbol("X.offset", 31, 20, Width::Double, Some(Number::Signed)),
        symbol("X.feed", 31, 24, Width::Double, Some(Number::Real)),
    ]
}

fn text(format: Format, symbols: &[Symbol]) -> String {
    String::from_utf8(symbol_file(format, symbols, &[(31, 30)]).bytes).unwrap()
}

#[test]
fn node_red_has_a_line_for_each_signal_and_for_each_bit_of_a_number_in_a_byte() {
    let expected = "DB31,X4.7;X.traversing_key_plus\nDB31,X9.0;X.parameter_set_0\nDB31,X9.1;X.parameter_set_1\n\
        DB31,X9.2;X.parameter_set_2\nDB31,B0;X.feed_override\nDB31,W10;X.speed\nDB31,I12;X.torque\nDB31,DW16;X.number\n\
        DB31,DI20;X.offset\nDB31,R24;X.feed\n";
    assert_eq!(text(Format::NodeRed, &all_types()), expected);
}

#[test]
fn python_snap7_has_the_columns_of_load_csv() {
    let text = text(Format::PythonSnap7, &all_types());
    let lines: Vec<_> = text.lines().collect();
    assert_eq!(
        lines[..3],
        ["tag,db,offset,type,bit", "X.traversing_key_plus,31,4,BOOL,7", "X.parameter_set_0,31,9,BOOL,0"]
    );
    assert_eq!(lines[9..], ["X.offset,31,20,DINT,0", "X.feed,31,24,REAL,0"]);
}

#[test]
fn the_source_of_step_7_has_each_signal_at_its_address_and_nothing_else() {
    let source = text(Format::Step7Awl, &all_types());
    let components: Vec<_> =
        source.lines().filter_map(|line| line.split_once(" ;")?.0.strip_prefix("   ")).map(str::to_owned).collect();
    let bits = |byte: u16, bits: std::ops::Range<u8>| bits.map(move |bit| format!("reserved_{byte}_{bit} : BOOL"));
    let mut expected = vec!["feed_override : BYTE".to_owned(), "reserved_1 : BYTE".to_owned()];
    expected.push("reserved_2 : ARRAY [2 .. 3] OF BYTE".to_owned());
    expected.extend(bits(4, 0..7));
    expected.push("traversing_key_plus : BOOL".to_owned());
    expected.push("reserved_5 : BYTE".to_owned());
    expected.push("reserved_6 : ARRAY [6 .. 7] OF BYTE".to_owned());
    expected.push("reserved_8 : BYTE".to_owned());
    expected.extend((0..3).map(|bit| format!("parameter_set_{bit} : BOOL")));
    expected.extend(bits(9, 3..8));
    expected.extend(["speed : WORD", "torque : INT", "reserved_14 : ARRAY [14 .. 15] OF BYTE"].map(str::to_owned));
    expected.extend(["number : DWORD", "offset : DINT", "feed : REAL"].map(str::to_owned));
    expected.push("reserved_28 : ARRAY [28 .. 29] OF BYTE".to_owned());
    assert_eq!(components, expected);
    assert!(source.ends_with("  END_STRUCT ;\r\nBEGIN\r\nEND_DATA_BLOCK\r\n\r\n"), "{source}");
}

#[test]
fn the_symbols_of_step_7_are_the_data_blocks() {
    let symbols = ["X.ready", "Y.ready"].into_iter().zip([31, 32]);
    let symbols: Vec<_> = symbols.map(|(name, block)| symbol(name, block, 61, Width::Bit(3), None)).collect();
    let table = |format| symbol_file(format, &symbols, &[(31, 62), (32, 62)]);
    let quoted = table(Format::Step7Sdf);
    let expected = "\"X\",\"DB 31\",\"DB 31\",\"interface of X\"\r\n\"Y\",\"DB 32\",\"DB 32\",\"interface of Y\"\r\n";
    assert_eq!(String::from_utf8(quoted.bytes).unwrap(), expected);
    assert_eq!(quoted.notes, [""; 0]);
    let columns = String::from_utf8(table(Format::Step7Asc).bytes).unwrap();
    let line = columns.lines().next().unwrap();
    // 126, and columns of 24, 12, 10 and 80 characters.
    assert_eq!(line.len(), 4 + 24 + 12 + 10 + 80);
    let fields =
        [&line[..4], line[4..28].trim_end(), line[28..40].trim_end(), line[40..50].trim_end(), line[50..].trim_end()];
    assert_eq!(fields, ["126,", "X", "DB 31", "DB 31", "interface of X"]);
}

#[test]
fn a_signal_that_shares_its_bytes_is_left_out_of_the_source_with_a_note() {
    let symbols = [symbol("X.all", 31, 4, Width::Byte, None), symbol("X.one", 31, 4, Width::Bit(1), None)];
    let source = symbol_file(Format::Step7Awl, &symbols, &[(31, 6)]);
    assert_eq!(source.notes, ["DB31: `all` at DB31.DBB4 shares its bytes with other signals and is no component"]);
    assert!(String::from_utf8(source.bytes).unwrap().contains("   one : BOOL ;  //PLC: Positive key: 1 moves.\r\n"));
}

#[test]
fn the_workbook_is_the_same_each_time() {
    let workbook = || symbol_file(Format::TiaXlsx, &all_types(), &[]).bytes;
    assert!(workbook().starts_with(b"PK"));
    assert_eq!(workbook(), workbook());
}
