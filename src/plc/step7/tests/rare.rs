//! System functions that few programs call, and calls that the compiler refuses.

use super::{Plc, SECOND, findings, ob1};
use crate::plc::step7::text::mnemonics::Language;
use crate::plc::step7::{Settings, Source, compile};

fn plc(blocks: &str, statements: &str) -> Plc {
    Plc::new(&format!("{blocks}\n{}", ob1(statements)))
}

/// 10 bits from M 20.3 on: M 20.3 to M 20.7 and M 21.0 to M 21.4.
#[test]
fn set_and_rset_write_bits_of_a_range() {
    let mut plc = plc(
        "",
        "CALL SFC 79 ( N := 10, RET_VAL := MW 0, SA := P#M 20.3 ); CALL SFC 80 ( N := 2, RET_VAL := MW 2, SA := P#M 20.4 );\
         MCRA; CLR; MCR( ; CALL SFC 79 ( N := 8, RET_VAL := MW 4, SA := P#M 30.0 ); )MCR; MCRD;\
         CALL SFC 79 ( N := 8, RET_VAL := MW 6, SA := P#DB10.DBX 31.1 );",
    );
    plc.scan();
    // 1111_1000 without the bits 4 and 5; 0001_1111; nothing in a zone that is off; a bit beyond DB10 is an error of parameter 3.
    assert_eq!(&plc.memory.flags[20..23], [0b1100_1000, 0b0001_1111, 0]);
    assert_eq!((plc.memory.flags[30], plc.word(0), plc.word(2), plc.word(6)), (0, 0, 0, 0x8323));
}

#[test]
fn a_program_deletes_only_what_it_has_made() {
    let mut plc = plc(
        "",
        "CALL SFC 22 ( LOW_LIMIT := W#16#C8, UP_LIMIT := W#16#D2, COUNT := W#16#4, RET_VAL := MW 0, DB_NUMBER := MW 2 );\
         CALL SFC 23 ( DB_NUMBER := MW 2, RET_VAL := MW 4 ); CALL SFC 23 ( DB_NUMBER := MW 2, RET_VAL := MW 6 );\
         CALL SFC 23 ( DB_NUMBER := W#16#A, RET_VAL := MW 8 ); CALL SFC 23 ( DB_NUMBER := W#16#0, RET_VAL := MW 10 );",
    );
    for _ in 0..2 {
        plc.scan();
        assert_eq!((plc.word(0), plc.word(2), plc.word(4)), (0, 200, 0));
        assert_eq!((plc.word(6), plc.word(8), plc.word(10)), (0x80B1, 0x80B3, 0x80A1));
    }
}

#[test]
fn data_blocks_of_the_load_memory_are_copied_at_once() {
    let mut plc = plc(
        "",
        "L W#16#1234; T MW 20; SET; = M 30.0;\
         CALL SFC 82 ( REQ := M 30.0, LOW_LIMIT := W#16#C8, UP_LIMIT := W#16#D2, COUNT := W#16#4, ATTRIB := B#16#0,\
           SRCBLK := P#M 20.0 BYTE 2, RET_VAL := MW 0, BUSY := M 31.0, DB_NUM := MW 2 );\
         OPN DB [MW 2]; L DBW 0; T MW 4; L DBLG; T MW 6;\
         CALL SFC 84 ( REQ := M 30.0, SRCBLK := MW 20, RET_VAL := MW 8, BUSY := M 31.0, DSTBLK := P#DB10.DBX 0.0 BYTE 2 );\
         CALL SFC 83 ( REQ := M 30.1, SRCBLK := P#DB10.DBX 0.0 BYTE 2, RET_VAL := MW 10, BUSY := M 31.0, DSTBLK := MW 22 );",
    );
    plc.scan();
    assert_eq!((plc.word(0), plc.word(2), plc.word(4), plc.word(6)), (0, 200, 0x1234, 4));
    assert_eq!(plc.memory.data(10).unwrap()[..2], [0x12, 0x34]);
    // Without REQ nothing is read.
    assert_eq!((plc.word(8), plc.word(10), plc.word(22), plc.bit(31, 0)), (0, 0, 0, false));
}

/// MODE 6 sets 5 hours, 1 starts: after 2 hours it has 7.
#[test]
fn an_hours_meter_of_32_bits() {
    let mut plc = plc(
        "",
        "L MB 20; CALL SFC 101 ( NR := B#16#1, MODE := MB 20, PV := L#5, RET_VAL := MW 0, CQ := M 2.0, CV := MD 4 );",
    );
    for (mode, hours, wanted) in
        [(6, 0, (0, false, 5)), (1, 0, (0, true, 5)), (0, 2, (0, true, 7)), (9, 0, (0x8082, true, 7))]
    {
        plc.memory.flags[20] = mode;
        plc.after(hours * 3600 * SECOND);
        assert_eq!((plc.word(0), plc.bit(2, 0), plc.double(4)), wanted, "{mode}");
    }
}

#[test]
fn ob60_runs_where_sfc_35_is_called() {
    let ob60 = "ORGANIZATION_BLOCK OB 60\nVAR_TEMP\ninfo : ARRAY [0 .. 19] OF BYTE;\nEND_VAR\nBEGIN\nL LW 6; T MW 10;\nEND_ORGANIZATION_BLOCK";
    let mut plc = plc(
        ob60,
        "CALL SFC 35 ( JOB := B#16#7, RET_VAL := MW 0 ); L MW 10; T MW 12; CALL SFC 35 ( JOB := B#16#0, RET_VAL := MW 2 );",
    );
    plc.scan();
    assert_eq!((plc.word(0), plc.word(12), plc.word(2)), (0, 7, 0x8090));
}

/// List 0424h has one record of 20 bytes; 08h is RUN.
#[test]
fn the_system_state_list_has_the_operating_state() {
    let mut plc = plc(
        "DATA_BLOCK DB 20\nSTRUCT\nh : STRUCT\nlength : WORD;\ncount : WORD;\nEND_STRUCT;\nr : ARRAY [0 .. 19] OF BYTE;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK",
        "SET; = M 30.0;\
         CALL SFC 51 ( REQ := M 30.0, SZL_ID := W#16#424, INDEX := W#16#0, RET_VAL := MW 0, BUSY := M 30.1, SZL_HEADER := DB20.h, DR := DB20.r );\
         L DB20.h.length; T MW 4; CALL SFC 51 ( REQ := M 30.0, SZL_ID := W#16#111, INDEX := W#16#1, RET_VAL := MW 2, BUSY := M 30.1, SZL_HEADER := DB20.h, DR := DB20.r );",
    );
    plc.scan();
    assert_eq!((plc.word(0), plc.word(4), plc.word(2)), (0, 20, 0x8082));
    assert_eq!(plc.memory.data(20).unwrap()[4..8], [0x43, 0x02, 0xFF, 0x08]);
}

#[test]
fn function_blocks_without_a_partner_report_an_error() {
    let mut plc = plc(
        "DATA_BLOCK DB 20\nSFB 52\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 21\nSFB 14\nBEGIN\nEND_DATA_BLOCK",
        "CALL SFB 52 , DB 20 ( REQ := M 30.0, ERROR := M 0.0, STATUS := MD 4, BUSY := M 0.1 ); CALL SFB 14 , DB 21 ( REQ := M 30.0, ERROR := M 0.2, STATUS := MW 8 );",
    );
    plc.scan();
    assert_eq!((plc.memory.flags[0], plc.double(4), plc.word(8)), (0, 0, 0));
    plc.set_bit(30, 0, true).scan();
    assert_eq!((plc.memory.flags[0], plc.double(4), plc.word(8)), (0b101, 0xC080_9100, 1));
}

const FB: &str = "FUNCTION_BLOCK FB 1\nVAR_INPUT\na : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK\n\
    FUNCTION_BLOCK FB 2\nVAR_INPUT\na : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK\n\
    DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";

#[test]
fn an_instance_of_another_block_is_refused() {
    let all = findings(&format!("{FB}{}", ob1("CALL FB 1 , DB 20;\nCALL FB 2 , DB 20 ( a := 1 );")));
    let [one] = &all[..] else { panic!("{all:?}") };
    assert!(
        one.contains("OB1, network 1: expected an instance of FB2, found DB20, which is an instance of FB1"),
        "{one}"
    );
    assert!(one.contains("DATA_BLOCK DB 20 FB2"), "{one}");
}

/// All faults of a call at once, each with what was found.
#[test]
fn a_call_reports_all_of_its_faults() {
    let fc = "FUNCTION FC 1 : VOID\nVAR_INPUT\na : INT;\nb : BOOL;\nc : TIMER;\nd : WORD;\ne : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION\n";
    let all = findings(&format!("{fc}{}", ob1("CALL FC 1 (\na := M 1.0,\nb := 5,\nc := MW 4,\nx := 1);")));
    for text in [
        "expected an operand of the width word, found M 1.0",
        "expected a BOOL for `b`, found 5",
        "expected an operand of the type TIMER, found MW 4",
        "FC1 has no parameter `x`",
        "the parameters `d`, `e` of FC1 are missing",
    ] {
        assert!(all.iter().any(|line| line.contains(text)), "{text}: {all:#?}");
    }
    assert_eq!(all.len(), 5, "{all:#?}");
}

fn languages(sources: &[(&str, &str)], settings: &Settings) -> Result<Vec<Language>, String> {
    let sources: Vec<_> = sources.iter().map(|(name, statements)| Source::statements(*name, *statements)).collect();
    let compiled = compile(&sources, settings);
    match compiled.findings.first() {
        Some(finding) => Err(finding.to_string()),
        None => Ok(compiled.languages.into_iter().map(|(_, language)| language).collect()),
    }
}

/// `SE` is in both languages. The folder decides, `plc.toml` where it does not, and for a single file always.
#[test]
fn the_folder_decides_on_operations_that_mean_two_things() {
    let timer = "FUNCTION FC 1 : VOID\nBEGIN\nL S5T#1S; SE T 5;\nEND_FUNCTION\n";
    let german = "FUNCTION FC 2 : VOID\nBEGIN\nU M 0.0; = M 0.1;\nEND_FUNCTION\n";
    let mut settings = Settings::default();
    let both = [("p/a.awl", timer), ("p/b.awl", german)];
    assert_eq!(languages(&both, &settings), Ok(vec![Language::German; 2]));
    let alone = languages(&both[..1], &settings).unwrap_err();
    assert!(alone.starts_with("p/a.awl:3:") && alone.contains("`SE`") && alone.contains("plc.toml"), "{alone}");
    settings.language = Some(Language::German);
    assert_eq!(languages(&both[..1], &settings), Ok(vec![Language::German]));
    settings.languages.insert("a.awl".to_owned(), Language::International);
    assert_eq!(languages(&both, &settings), Ok(vec![Language::International, Language::German]));
}

/// Blocks of the basic program that are not built in, and one whose parameters are those of neither it nor a library.
#[test]
fn a_call_of_a_block_of_the_basic_program_that_is_not_there_says_so() {
    let fb =
        [5, 7, 9, 10, 11, 29].map(|number| (format!("FB{number}"), format!("CALL FB {number} , DB 130 ( x := 1 );")));
    let fc = [13, 17, 21, 26].map(|number| (format!("FC{number}"), format!("CALL FC {number} ( x := 1 );")));
    for (name, call) in fb.into_iter().chain(fc) {
        let all = findings(&ob1(&call));
        let text = format!("{name} is called and is nowhere; the basic program has one, which is not built in");
        assert!(all.len() == 1 && all[0].contains(&text), "{all:#?}");
        assert!(all[0].contains(&format!("add the source of your own {name}")), "{all:#?}");
    }
    let all = findings(&ob1("CALL FC 19 ( Panel := 1 );"));
    assert!(all[0].contains("FC19 is the built-in MCP_IFM only if a call has its parameters"), "{all:#?}");
    assert!(all[0].contains("BAGNo, ChanNo, SpindleIFNo, FeedHold, SpindleHold"), "{all:#?}");
    // SFB 32 is a block of the CPU that is not built in.
    let all = findings(&ob1("CALL SFB 32 , DB 130 ( RESET := TRUE );"));
    assert!(all[0].contains("SFB32 is not built in"), "{all:#?}");
}
