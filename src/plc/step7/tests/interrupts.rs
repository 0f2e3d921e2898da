//! Interrupts of time, masked faults, hours meters, data blocks that the program makes, and what does nothing.

use super::{Plc, SECOND, findings, ob1};
use crate::plc::step7::engine::{CpuOptions, Fault};
use crate::plc::step7::{Settings, Source, compile};

/// An organization block that counts its calls in a flag word and keeps local bytes in flags.
fn counting(number: u16, word: u16, local: &str) -> String {
    format!(
        "ORGANIZATION_BLOCK OB {number}\nVAR_TEMP\ninfo : ARRAY [0 .. 19] OF BYTE;\nEND_VAR\nBEGIN\nL MW {word}; + 1; T MW {word}; {local}\nEND_ORGANIZATION_BLOCK\n"
    )
}

#[test]
fn cyclic_interrupts_have_the_periods_of_an_s7_300() {
    // OB30 counts in MW 0, OB31 in MW 2 and so on.
    let text: String = (0..9).map(|index| counting(30 + index, index * 2, "")).collect();
    let mut plc = Plc::new(&format!("{text}{}", ob1("NOP 0;")));
    // 10 s in steps of 10 ms: 10 s / 5 s, 2 s, 1 s, 500, 200, 100, 50, 20 and 10 ms.
    for _ in 0..1000 {
        plc.after(SECOND / 100);
    }
    assert_eq!([0, 2, 4, 6, 8, 10, 12, 14, 16].map(|byte| plc.word(byte)), [2, 5, 10, 20, 50, 100, 200, 500, 1000]);
    let mut options = CpuOptions::default();
    options.cyclic_nanos[5] = SECOND / 20;
    let mut plc =
        Plc::with(&format!("{}{}", counting(35, 0, "L LW 10; T MW 2; L LD 0; T MD 4;"), ob1("NOP 0;")), options);
    plc.after(SECOND / 20);
    // EXEC_FREQ in ms; class 11h, event 36h, priority 12, OB35.
    assert_eq!((plc.word(0), plc.word(2), plc.double(4)), (1, 50, 0x1136_0C23));
}

const DELAY: &str = "A M 0.0; FP M 0.1; JCN a; CALL SFC 32 ( OB_NR := 20, DTIME := T#300MS, SIGN := W#16#ABCD, RET_VAL := MW 2 ); a: NOP 0; \
    CALL SFC 34 ( OB_NR := 20, RET_VAL := MW 4, STATUS := MW 6 ); \
    A M 0.2; JCN b; CALL SFC 33 ( OB_NR := 20, RET_VAL := MW 8 ); b: NOP 0;";

#[test]
fn a_time_delay_interrupt_comes_once_after_its_time() {
    let mut plc =
        Plc::new(&format!("{}{}", counting(20, 20, "L LW 6; T MW 22; L LD 8; T MD 24; L LD 0; T MD 28;"), ob1(DELAY)));
    plc.scan();
    // Bit 4: the block is loaded.
    assert_eq!((plc.word(4), plc.word(6)), (0, 0x10));
    plc.set_bit(0, 0, true).after(SECOND / 10);
    assert_eq!((plc.word(2), plc.word(6)), (0, 0x14));
    plc.after(SECOND / 5);
    assert_eq!(plc.word(20), 0);
    plc.after(SECOND / 10);
    assert_eq!((plc.word(20), plc.word(6)), (1, 0x10));
    // SIGN, DTIME, and 11h, 21h, priority 3, OB20.
    assert_eq!((plc.word(22), plc.double(24), plc.double(28)), (0xABCD, 300, 0x1121_0314));
    plc.after(SECOND);
    assert_eq!(plc.word(20), 1);
    // Cancelled: nothing comes; a second time there is none to cancel.
    plc.set_bit(0, 0, false).scan();
    plc.set_bit(0, 0, true).scan();
    plc.set_bit(0, 2, true).scan();
    assert_eq!(plc.word(8), 0);
    plc.scan();
    assert_eq!(plc.word(8), 0x80A0);
    plc.after(SECOND);
    assert_eq!(plc.word(20), 1);
}

#[test]
fn wrong_numbers_and_times_of_interrupts_are_refused() {
    let mut plc = Plc::of_statements(
        "CALL SFC 32 ( OB_NR := 24, DTIME := T#300MS, SIGN := W#16#0, RET_VAL := MW 0 ); \
         CALL SFC 32 ( OB_NR := 20, DTIME := T#61S, SIGN := W#16#0, RET_VAL := MW 2 ); \
         CALL SFC 30 ( OB_NR := 10, RET_VAL := MW 4 ); CALL SFC 29 ( OB_NR := 9, RET_VAL := MW 6 ); \
         CALL SFC 39 ( MODE := B#16#3, OB_NR := 35, RET_VAL := MW 8 ); CALL SFC 39 ( MODE := B#16#2, OB_NR := 1, RET_VAL := MW 10 );",
    );
    plc.scan();
    let found = [0, 2, 4, 6, 8, 10].map(|byte| plc.word(byte));
    assert_eq!(found, [0x8090, 0x8091, 0x80A0, 0x8090, 0x8091, 0x8090]);
}

/// Power on is 2024-1-1 00:00; from 00:01 on every minute, and once at 00:02.
#[test]
fn time_of_day_interrupts_follow_the_clock() {
    let block = "DATA_BLOCK DB 20\nSTRUCT\nminute : DATE_AND_TIME := DT#2024-1-1-0:1:30;\nonce : DATE_AND_TIME := DT#2024-1-1-0:2:0;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";
    let ob100 = "ORGANIZATION_BLOCK OB 100\nBEGIN\n\
        CALL SFC 28 ( OB_NR := 10, SDT := DB20.minute, PERIOD := W#16#201, RET_VAL := MW 0 ); CALL SFC 30 ( OB_NR := 10, RET_VAL := MW 2 );\n\
        CALL SFC 28 ( OB_NR := 11, SDT := DB20.once, PERIOD := W#16#0, RET_VAL := MW 4 ); CALL SFC 30 ( OB_NR := 11, RET_VAL := MW 6 );\n\
        CALL SFC 28 ( OB_NR := 12, SDT := DB20.once, PERIOD := W#16#1, RET_VAL := MW 8 );\nEND_ORGANIZATION_BLOCK\n";
    let text = format!(
        "{block}{ob100}{}{}{}",
        counting(10, 20, "L LW 6; T MW 22; L LD 0; T MD 24;"),
        counting(11, 30, ""),
        ob1("CALL SFC 31 ( OB_NR := 11, RET_VAL := MW 40, STATUS := MW 42 );")
    );
    let mut plc = Plc::new(&text);
    assert_eq!([0, 2, 4, 6, 8].map(|byte| plc.word(byte)), [0, 0, 0, 0, 0x8092]);
    plc.after(59 * SECOND);
    assert_eq!((plc.word(20), plc.word(42)), (0, 0x14));
    plc.after(SECOND);
    // The seconds of the start do not count: 00:01:00. PERIOD; 11h, 11h, priority 2, OB10.
    assert_eq!((plc.word(20), plc.word(22), plc.double(24)), (1, 0x201, 0x1111_020A));
    plc.after(60 * SECOND);
    assert_eq!((plc.word(20), plc.word(30), plc.word(42)), (2, 1, 0x10));
    plc.after(60 * SECOND);
    assert_eq!((plc.word(20), plc.word(30)), (3, 1));
}

/// 253Ah is bit 3Ah - 20h = 26 of the programming errors; 2942h bit 2 of the access errors.
#[test]
fn masked_faults_do_not_stop_the_plc_and_are_read() {
    let statements = "CALL SFC 36 ( PRGFLT_SET_MASK := DW#16#4000000, ACCFLT_SET_MASK := DW#16#4, RET_VAL := MW 0, PRGFLT_MASKED := MD 4, ACCFLT_MASKED := MD 8 ); \
        OPN DB 99; L P#999.0; T MD 50; L PIB [MD 50]; \
        CALL SFC 38 ( PRGFLT_QUERY := DW#16#4000000, ACCFLT_QUERY := DW#16#C, RET_VAL := MW 12, PRGFLT_CLR := MD 16, ACCFLT_CLR := MD 20 ); \
        CALL SFC 38 ( PRGFLT_QUERY := DW#16#4000000, ACCFLT_QUERY := DW#16#4, RET_VAL := MW 14, PRGFLT_CLR := MD 24, ACCFLT_CLR := MD 28 ); \
        CALL SFC 37 ( PRGFLT_RESET_MASK := DW#16#4000000, ACCFLT_RESET_MASK := DW#16#0, RET_VAL := MW 32, PRGFLT_MASKED := MD 36, ACCFLT_MASKED := MD 40 ); \
        A M 60.0; JCN a; OPN DB 99; a: NOP 0;";
    let mut plc = Plc::of_statements(statements);
    plc.scan();
    assert_eq!((plc.word(0), plc.double(4), plc.double(8)), (0, 0x0400_0000, 4));
    // Bit 3 of the access errors is not masked, so RET_VAL is 1.
    assert_eq!((plc.word(12), plc.double(16), plc.double(20)), (1, 0x0400_0000, 4));
    assert_eq!((plc.word(14), plc.double(24), plc.double(28)), (0, 0, 0));
    assert_eq!((plc.word(32), plc.double(36), plc.double(40)), (0, 0, 4));
    // Unmasked again.
    plc.set_bit(60, 0, true);
    assert_eq!(plc.fault(), Fault::NoDataBlock(99));
}

#[test]
fn a_substitute_value_takes_the_place_of_a_failed_read() {
    let ob122 = "ORGANIZATION_BLOCK OB 122\nBEGIN\nCALL SFC 44 ( VAL := DW#16#12345678, RET_VAL := MW 2 );\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(&format!(
        "{ob122}{}",
        ob1("CALL SFC 44 ( VAL := DW#16#1, RET_VAL := MW 0 ); L P#999.0; T MD 50; L PID [MD 50]; T MD 4;")
    ));
    plc.scan();
    assert_eq!((plc.word(0), plc.word(2), plc.double(4)), (0x8080, 0, 0x1234_5678));
}

#[test]
fn hours_meters_count_whole_hours() {
    let mut plc = Plc::of_statements(
        "A M 0.0; JCN a; CALL SFC 2 ( NR := B#16#1, PV := 100, RET_VAL := MW 2 ); a: CALL SFC 3 ( NR := B#16#1, S := M 0.1, RET_VAL := MW 4 ); \
         CALL SFC 4 ( NR := B#16#1, RET_VAL := MW 6, CQ := M 8.0, CV := MW 10 ); CALL SFC 4 ( NR := B#16#8, RET_VAL := MW 12, CQ := M 8.1, CV := MW 14 );",
    );
    plc.set_bit(0, 0, true).scan();
    plc.set_bit(0, 0, false).set_bit(0, 1, true).scan();
    assert_eq!((plc.word(6), plc.bit(8, 0), plc.word(10), plc.word(12)), (0, true, 100, 0x8080));
    plc.after(2 * 3600 * SECOND - 1);
    assert_eq!(plc.word(10), 101);
    plc.after(1);
    assert_eq!(plc.word(10), 102);
    // It stands.
    plc.set_bit(0, 1, false).scan();
    plc.after(5 * 3600 * SECOND);
    assert_eq!((plc.bit(8, 0), plc.word(10)), (false, 102));
}

#[test]
fn data_blocks_are_made_in_spare_numbers() {
    let mut plc = Plc::of_statements(
        "A M 0.0; JCN a; CALL SFC 22 ( LOW_LIMIT := W#16#A, UP_LIMIT := W#16#C, COUNT := W#16#8, RET_VAL := MW 2, DB_NUMBER := MW 4 ); a: NOP 0; \
         A M 0.1; JCN b; OPN DB [MW 4]; L DBLG; T MW 6; L 77; T DBW 6; L DBW 6; T MW 8; b: NOP 0; \
         CALL SFC 22 ( LOW_LIMIT := W#16#14, UP_LIMIT := W#16#14, COUNT := W#16#7, RET_VAL := MW 10, DB_NUMBER := MW 12 );",
    );
    // DB10 exists, so 11 and 12 are spare.
    plc.set_bit(0, 0, true).set_bit(0, 1, true).scan();
    assert_eq!([2, 4, 6, 8, 10, 12].map(|byte| plc.word(byte)), [0, 11, 8, 77, 0x80A2, 0]);
    plc.scan();
    assert_eq!((plc.word(2), plc.word(4)), (0, 12));
    plc.set_bit(0, 1, false).scan();
    assert_eq!((plc.word(2), plc.word(4)), (0x80B1, 0));
    assert_eq!(plc.memory.data(11).unwrap(), [0, 0, 0, 0, 0, 0, 0, 77]);
}

#[test]
fn ob102_runs_after_a_cold_restart_only() {
    let text = format!("{}{}{}", counting(100, 0, ""), counting(102, 2, "L LD 0; T MD 4;"), ob1("NOP 0;"));
    let mut plc = Plc::new(&text);
    assert_eq!((plc.word(0), plc.word(2)), (1, 0));
    plc.cpu.prepare_cold_restart();
    plc.cpu.startup(&mut plc.memory, 0).unwrap();
    assert_eq!((plc.word(0), plc.word(2), plc.double(4)), (1, 1, 0x1385_1B66));
    plc.cpu.startup(&mut plc.memory, 0).unwrap();
    assert_eq!((plc.word(0), plc.word(2)), (2, 1));
}

/// What does nothing is listed once, with its first place.
#[test]
fn what_is_left_out_is_listed_once() {
    let answer = "CALL SFC 52 ( SEND := TRUE, EVENTN := W#16#A001, INFO1 := MW 0, INFO2 := MW 2, RET_VAL := MW 4 );";
    let text = format!("{}{}{}", counting(81, 0, ""), counting(82, 0, ""), ob1(&format!("{answer}\n{answer}")));
    let compiled = compile(&[Source::statements("a.awl", &*text)], &Settings::default());
    let remarks: Vec<_> =
        compiled.remarks.iter().map(|remark| remark.to_string().lines().next().unwrap().to_owned()).collect();
    assert_eq!(
        remarks,
        [
            "a.awl:1:1: OB81 is compiled and never called",
            "a.awl:8:1: OB82 is compiled and never called",
            "a.awl:27:1: OB1, network 1: SFC52 WR_USMSG does nothing: its RET_VAL is 0",
        ]
    );
    assert!(compiled.program.is_some());
    assert!(findings(&ob1("CALL SFC 53;"))[0].contains("a.awl:13:1: OB1, network 1: SFC53 is not built in"));
    let ignored = Settings { ignores_missing: true, ..Settings::default() };
    let compiled = compile(&[Source::statements("a.awl", ob1("CALL FC 99;\nCALL FC 99;\nCALL SFC 53;"))], &ignored);
    let remarks: Vec<_> = compiled.remarks.iter().map(ToString::to_string).collect();
    assert_eq!(
        remarks,
        [
            "a.awl:13:1: OB1, network 1: FC99 is nowhere: its calls are left out",
            "a.awl:15:1: OB1, network 1: SFC53 is not built in: its calls are left out",
        ]
    );
}
