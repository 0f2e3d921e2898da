//! The blocks of the basic program, called by AWL on the interface of a machine.

use crate::plc::bench::Bench;
use crate::plc::step7::{LoadedProgram, Settings, Source, compile};
use crate::plc::{NcVariable, PlcProgram};

/// A program on a bench with axes X and Y; OB100 has run.
pub(super) fn started(text: &str) -> (Bench, LoadedProgram) {
    let mut bench = Bench::with_axes(&["X", "Y"]);
    let program = start(&mut bench, text);
    (bench, program)
}

/// Loads a program and runs OB100.
#[track_caller]
pub(super) fn start(bench: &mut Bench, text: &str) -> LoadedProgram {
    let sources = [Source::statements("a.awl", text)];
    let loaded = LoadedProgram::compile(&sources, &Settings::default(), "step7/a");
    let mut program = loaded.unwrap_or_else(|findings| panic!("{findings:?}"));
    program.install(&mut bench.memory, &bench.names);
    program.startup(&mut bench.io()).unwrap();
    program
}

/// OB1 and OB100 with these statements.
pub(super) fn blocks(startup: &str, cyclic: &str) -> String {
    format!(
        "ORGANIZATION_BLOCK OB 100\nBEGIN\nNETWORK\n{startup}\nEND_ORGANIZATION_BLOCK\n\
         ORGANIZATION_BLOCK OB 1\nVAR_TEMP\ninfo : ARRAY [0 .. 19] OF BYTE;\nEND_VAR\nBEGIN\nNETWORK\n{cyclic}\nEND_ORGANIZATION_BLOCK\n"
    )
}

const MESSAGES: &str = "CALL FC 2; CALL FC 10 ( ToUserIF := M 0.0, Quit := M 0.1 );";

#[test]
fn fb1_sets_its_outputs_and_needs_no_source_of_its_instance() {
    let cyclic = "L DB7.DBW 0; T MW 10;";
    let (mut bench, mut program) = started(&blocks("CALL FB 1, DB 7 ( mcpnum := 2, NCKomm := TRUE );", cyclic));
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("MW10"), 2, "MCPNum is the first word");
    let named = "DATA_BLOCK DB 7\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
    let text = format!(
        "{named}{}",
        blocks(
            "CALL FB 1, DB 7 ();",
            "L DB7.MaxAxis; T MW 10; L DB7.MaxBAG; T MW 12; A DB7.ActivAxis[2]; = M 14.0; A DB7.ActivAxis[3]; = M 14.1;"
        )
    );
    let (mut bench, mut program) = started(&text);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("MW10"), bench.get("MW12")), (2, 1));
    assert_eq!(bench.get("MB14"), 1, "axis 2 exists, axis 3 does not");
}

/// P-155: MD10010 is 1 for the channels 1 and 3.
#[test]
fn fb1_counts_the_channels_that_exist() {
    let startup = "CALL FB 1, DB 7 (); L DB7.MaxChan; T MW 10; \
        A DB7.ActivChan[1]; = M 14.0; A DB7.ActivChan[2]; = M 14.1; A DB7.ActivChan[3]; = M 14.2;";
    let group = |line| (NcVariable { module: 0x1A, column: 10_010, line, ..NcVariable::default() }, 1.0);
    for (values, wanted) in [(vec![], (1, 0b001)), (vec![group(1), group(3)], (3, 0b101))] {
        let mut bench = Bench::with_axes(&["X"]);
        bench.nc.values = values;
        let text = format!("DATA_BLOCK DB 7\nFB 1\nBEGIN\nEND_DATA_BLOCK\n{}", blocks(startup, "NOP 0;"));
        start(&mut bench, &text);
        assert_eq!((bench.get("MW10"), bench.get("MB14")), wanted);
    }
}

/// P-151: DB38 is of axis 8, which does not exist: it has its values and its length. DB31 is of axis X.
#[test]
fn the_block_of_an_axis_that_is_not_there_is_one_of_the_program() {
    let block = |number: u16| {
        format!(
            "DATA_BLOCK DB {number}\nSTRUCT\na : ARRAY [0 .. 299] OF WORD := 300 (W#16#1234);\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n"
        )
    };
    let cyclic =
        "L DB38.DBW 598; T MW 10; L W#16#77; T DB38.DBW 60; L DB31.DBW 60; T MW 12; OPN DB 38; L DBLG; T MW 14;";
    let (mut bench, mut program) = started(&format!("{}{}{}", block(31), block(38), blocks("", cyclic)));
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("MW10"), bench.get("MW12"), bench.get("MW14")), (0x1234, 0, 600));
    assert_eq!((bench.get("DB38.DBW60"), bench.get("DB38.DBW0"), bench.get("DB31.DBB0")), (0x77, 0x1234, 0));
}

/// P-133: integers from byte 0, then bytes, then REALs, each part at an even byte.
#[test]
fn fb1_fills_db20_with_the_machine_data_for_the_plc() {
    let mut bench = Bench::with_axes(&["X"]);
    let datum = |column, line| NcVariable { module: 0x1A, column, line, ..NcVariable::default() };
    let values = [(14504, 1, 2.0), (14506, 1, 1.0), (14508, 1, 1.0)];
    let data = [(14510, 1, -5.0), (14510, 2, 300.0), (14512, 1, 254.0), (14514, 1, 1.5)];
    bench.nc.values =
        values.into_iter().chain(data).map(|(number, line, value)| (datum(number, line), value)).collect();
    let mut program = start(&mut bench, &blocks("CALL FB 1, DB 7 ();", "L DB7.DBW 0;"));
    bench.scan(&mut program).unwrap();
    // −5 is FFFBh, 300 is 012Ch, 1.5 is 3FC00000h.
    let found = ["DB20.DBW0", "DB20.DBW2", "DB20.DBB4", "DB20.DBD6"].map(|address| bench.get(address));
    assert_eq!(found, [0xFFFB, 300, 254, 0x3FC0_0000]);
}

#[test]
fn an_error_message_waits_for_its_acknowledgement_and_an_operating_message_does_not() {
    let (mut bench, mut program) = started(&blocks("", MESSAGES));
    // 510003: byte 0 bit 3, an error message. 510008: byte 1 bit 0, an operating message.
    bench.set("DB2.DBW0", 0x0801);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.nc.shown, [510_003, 510_008]);
    bench.set("DB2.DBW0", 0);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.nc.shown, [510_003]);
    bench.set("M0.1", 1);
    bench.scan(&mut program).unwrap();
    assert!(bench.nc.shown.is_empty());
    // An acknowledgement does not remove a message whose bit is 1.
    bench.set("DB2.DBX180.0", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.nc.shown, [700_000]);
}

/// P-134: the block sets group signals with OR, and takes back only what it has set.
#[test]
fn group_signals_are_ored_into_the_interface_and_taken_back() {
    let (mut bench, mut program) = started(&blocks("", MESSAGES));
    bench.set("DB2.DBX2.0", 1); // 510100: feed and read-in disable of channel 1
    bench.set("DB2.DBX144.0", 1); // 600100: feed stop of axis 1
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB21.DBB6"), bench.get("DB31.DBX4.3")), (0, 0), "ToUserIF is 0");
    bench.set("M0.0", 1);
    bench.set("DB32.DBX4.3", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB21.DBB6"), bench.get("DB31.DBX4.3")), (3, 1));
    bench.set("DB2.DBX0.0", 1); // 510000: feed disable
    bench.set("DB2.DBX2.0", 0);
    bench.set("DB2.DBX144.0", 0);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB21.DBB6"), bench.get("DB31.DBX4.3")), (1, 0), "510000 still disables the feed");
    assert_eq!(bench.get("DB32.DBX4.3"), 1, "the program has set it");
}

#[test]
fn fc2_passes_the_selections_of_the_hmi_unless_fb1_says_no() {
    let startup = "CALL FB 1, DB 7 ( MMCToIF := FALSE );";
    for (startup, wanted) in [("", 0x48), (startup, 0)] {
        let (mut bench, mut program) = started(&blocks(startup, "CALL FC 2;"));
        bench.set("DB21.DBX24.3", 1);
        bench.set("DB21.DBX24.6", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(bench.get("DB21.DBB0"), wanted, "DRF 0.3 and dry run 0.6");
        // A signal that the program sets itself stays while the selection does.
        bench.set("DB21.DBX6.6", 1);
        bench.scan(&mut program).unwrap();
        assert_eq!(bench.get("DB21.DBX6.6"), 1);
    }
}

#[test]
fn fc18_positions_an_axis_by_the_plc() {
    let call = "CALL FC 18 ( Start := M 0.0, Stop := M 0.1, Funct := B#16#5, Mode := B#16#0, AxisNo := 1, Pos := 120.5, FRate := 1000.0, \
                InPos := M 1.0, Error := M 1.1, State := MB 2 );";
    let (mut bench, mut program) = started(&blocks("", call));
    bench.set("M0.0", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!(bench.get("DB31.DBB8"), 0x90, "the axis is requested: 8.7 and 8.4");
    bench.set("DB31.DBX68.7", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("DB31.DBB32"), bench.get("DB31.DBD36")), (0x80, u64::from(120.5_f32.to_bits())));
    bench.set("DB31.DBB104", 0x40);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("M1.0"), bench.get("M1.1")), (1, 0));
    // An axis that does not exist.
    let (mut bench, mut program) = started(&blocks("", &call.replace("AxisNo := 1", "AxisNo := 9")));
    bench.set("M0.0", 1);
    bench.scan(&mut program).unwrap();
    assert_eq!((bench.get("M1.1"), bench.get("MB2")), (1, 100));
}

#[test]
fn a_number_is_the_basic_programs_or_the_iec_librarys_by_its_parameters() {
    let texts = "DATA_BLOCK DB 10\nSTRUCT\na : STRING [4] := 'ab';\nb : STRING [4] := 'ab';\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";
    let call = "CALL FC 10 ( S1 := DB10.a, S2 := DB10.b, RET_VAL := M 0.0 );";
    let compiled =
        compile(&[Source::statements("a.awl", format!("{texts}{}", blocks("", call)))], &Settings::default());
    assert!(compiled.program.unwrap().basic_program().next().is_none());
    let compiled = compile(&[Source::statements("a.awl", blocks("", MESSAGES))], &Settings::default());
    let used: Vec<_> =
        compiled.program.unwrap().basic_program().map(|(block, name)| format!("{block} {name}")).collect();
    assert_eq!(used, ["FC2 GP_HP", "FC10 AL_MSG"]);
}

#[test]
fn a_block_of_the_user_wins_unless_plc_toml_says_ours() {
    let own = "FUNCTION FC 2 : VOID\nBEGIN\nSET; = M 5.0;\nEND_FUNCTION\n";
    let sources = [Source::statements("a.awl", format!("{own}{}", blocks("", "CALL FC 2;")))];
    let name = crate::plc::step7::BlockName { kind: crate::plc::step7::BlockKind::Fc, number: 2 };
    for (ours, wanted) in [(vec![], 0), (vec![name], 1)] {
        let settings = Settings { ours, ..Settings::default() };
        let program = compile(&sources, &settings).program.unwrap();
        assert_eq!(program.basic_program().count(), wanted);
    }
}
