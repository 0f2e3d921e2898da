//! Faults: OB121 and OB122, and the stop of the PLC with its place.

use super::{Plc, SECOND, ob1};
use crate::plc::step7::engine::{CpuOptions, Fault};

#[test]
fn a_fault_stops_the_plc_with_its_place_and_registers() {
    let text = "FUNCTION FC 7 : VOID\nBEGIN\nNETWORK\nTITLE =one\nNOP 0;\nNETWORK\nTITLE =two\nL 1;\nL 2;\nOPN DB 99;\nEND_FUNCTION\n";
    let mut plc = Plc::new(&format!("{text}{}", ob1("UC FC 7; L 1; T MW 0;")));
    assert_eq!(plc.fault(), Fault::NoDataBlock(99));
    let stop = plc.cpu.stopped().unwrap();
    assert_eq!((stop.block.as_str(), stop.network, stop.statement, stop.line), ("FC7", 2, 3, 10));
    assert_eq!(stop.registers.accu[..2], [2, 1]);
    assert_eq!(
        stop.to_string(),
        "FC7, network 2, statement 3 (a.awl:10): DB99 is not loaded\n  \
         ACCU1 00000002 ACCU2 00000001 AR1 00000000 AR2 00000000 DB 0 DI 0 STW 000000100"
    );
    // It stays stopped, and nothing runs.
    assert_eq!(plc.fault(), Fault::NoDataBlock(99));
    assert_eq!(plc.word(0), 0);
    // Power on begins again.
    plc.cpu.startup(&mut plc.memory, 0).unwrap();
    assert!(plc.cpu.stopped().is_none());
}

/// C-90: the fault, why the CPU is in STOP, and 35h or 25h or 29h as the class of the event.
#[test]
fn the_diagnostic_buffer_has_the_events_of_a_stop() {
    let short = CpuOptions { instructions_per_scan: 100, ..CpuOptions::default() };
    for (statements, events) in [
        ("a: JU a;", (Some(0x3501), 0x4568)),
        ("OPN DB 99;", (Some(0x253A), 0x4562)),
        ("L W#16#A; BTI;", (Some(0x2521), 0x4562)),
        ("L P#999.0; T MD 0; L PIB [MD 0];", (Some(0x2942), 0x4563)),
        ("CALL SFC 46;", (None, 0x4304)),
        // These have no OB121 and no event of their own here.
        (") ;", (None, 0x4562)),
    ] {
        let mut plc = Plc::with(&ob1(statements), short);
        plc.fault();
        let diagnosis = plc.cpu.stopped().unwrap().diagnosis();
        assert_eq!((diagnosis.cause, diagnosis.stop), events, "{statements}");
    }
}

const OB121: &str = "ORGANIZATION_BLOCK OB 121\nVAR_TEMP\nclass : BYTE;\ncode : BYTE;\ninfo : ARRAY [0 .. 17] OF BYTE;\nEND_VAR\nBEGIN\n\
    L #code; T MB 40; L LW 8; T MW 42; L MW 44; + 1; T MW 44; L 99; SET;\nEND_ORGANIZATION_BLOCK\n";

#[test]
fn ob121_runs_and_the_program_goes_on() {
    for (statements, code) in [
        ("OPN DB 99;", 0x3A),
        ("L DB10.DBW 100;", 0x22),
        ("T DB10.DBW 100;", 0x23),
        ("L W#16#A; BTI; L 5;", 0x21),
        ("L 99; T MW 0; UC FC [MW 0]; L 5;", 0x3C),
        ("L 99; T MW 0; A T [MW 0]; L 5;", 0x26),
        ("L 99; T MW 0; A C [MW 0]; L 5;", 0x27),
        ("L 5;", 0),
    ] {
        let mut plc = Plc::new(&format!("{OB121}{}", ob1(&format!("L 5; CLR; {statements} T MW 46; = M 1.0;"))));
        plc.scan();
        // A failed read leaves ACCU1, and the registers come back after OB121.
        assert_eq!((plc.memory.flags[40], plc.word(46), plc.bit(1, 0)), (code, 5, false), "{statements}");
        assert_eq!(plc.word(44), u16::from(code != 0));
        if code != 0 {
            assert_eq!(plc.word(42), 1, "the number of OB1");
        }
    }
}

#[test]
fn ob122_runs_for_the_peripheral_area_only() {
    let ob122 = OB121.replace("OB 121", "OB 122");
    let mut plc = Plc::new(&format!("{ob122}{}", ob1("L P#999.0; T MD 0; L PIB [MD 0]; L 1; T MW 46;")));
    plc.scan();
    assert_eq!((plc.memory.flags[40], plc.word(46)), (0x42, 1));
    let mut plc = Plc::new(&format!("{ob122}{}", ob1("OPN DB 99;")));
    assert_eq!(plc.fault(), Fault::NoDataBlock(99));
}

#[test]
fn a_fault_within_ob121_and_fatal_faults_stop_the_plc() {
    let faulty = OB121.replace("L #code;", "OPN DB 98; L #code;");
    let mut plc = Plc::new(&format!("{faulty}{}", ob1("OPN DB 99;")));
    assert_eq!(plc.fault(), Fault::NoDataBlock(98));
    assert_eq!(plc.cpu.stopped().unwrap().block, "OB121");
    let mut plc = Plc::new(&format!("{OB121}{}", ob1(") ;")));
    assert_eq!(plc.fault(), Fault::Nesting);
    let mut plc = Plc::new(&format!("{OB121}{}", ob1("CALL SFC 46;")));
    assert_eq!(plc.fault(), Fault::StopCalled);
}

#[test]
fn local_data_of_a_priority_class_are_limited() {
    let options = CpuOptions { local_data: 64, ..CpuOptions::default() };
    let text = format!(
        "FUNCTION FC 1 : VOID\nVAR_TEMP\nx : ARRAY [1 .. 50] OF BYTE;\nEND_VAR\nBEGIN\nEND_FUNCTION\n{}",
        ob1("UC FC 1;")
    );
    let mut plc = Plc::with(&text, options);
    assert_eq!(plc.fault(), Fault::LocalData);
}

#[test]
fn organization_blocks_run_when_they_are_due() {
    let text = "ORGANIZATION_BLOCK OB 100\nBEGIN\nL MW 0; + 1; T MW 0;\nEND_ORGANIZATION_BLOCK\n\
        ORGANIZATION_BLOCK OB 35\nBEGIN\nL MW 2; + 1; T MW 2;\nEND_ORGANIZATION_BLOCK\n\
        ORGANIZATION_BLOCK OB 1\nVAR_TEMP\nclass : BYTE;\nscan : BYTE;\np : ARRAY [0 .. 3] OF BYTE;\nprevious : INT;\nleast : INT;\nmost : INT;\ndt : DATE_AND_TIME;\nEND_VAR\n\
        BEGIN\nL #scan; T MB 10; L #previous; T MW 12; L #least; T MW 14; L #most; T MW 16; L MW 2; T MW 4; L LD 12; T MD 20;\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    assert_eq!(plc.word(0), 1);
    plc.scan();
    // The first scan at 2024-1-1 00:00.
    assert_eq!((plc.memory.flags[10], plc.double(20)), (1, 0x2401_0100));
    plc.after(SECOND / 20);
    assert_eq!((plc.memory.flags[10], plc.word(12), plc.word(2)), (3, 50, 0));
    // OB35 runs before the OB1 of the step in which it is due.
    plc.after(SECOND / 20);
    assert_eq!((plc.word(2), plc.word(4)), (1, 1));
    plc.after(SECOND / 100);
    assert_eq!((plc.word(2), plc.word(12), plc.word(14), plc.word(16)), (1, 10, 10, 50));
    // Three periods late: once, and the next one at its time.
    plc.after(SECOND * 3 / 10);
    assert_eq!(plc.word(2), 2);
    plc.after(SECOND * 9 / 100);
    assert_eq!(plc.word(2), 3);
}
