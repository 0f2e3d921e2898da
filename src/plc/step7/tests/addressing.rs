//! Addresses in memory and in registers, data block registers.

use super::{Plc, registers, trial};
use crate::plc::step7::engine::Fault;

/// The result of the statements in MW 100, with M 20.0 to M 23.7 = 16#11223344.
#[track_caller]
fn result(statements: &str) -> u16 {
    let mut plc = Plc::of_statements(&format!("L DW#16#11223344; T MD 20; {statements} T MW 100;"));
    plc.scan().word(100)
}

#[test]
fn pointers_in_memory_and_in_registers_find_their_operands() {
    for (statements, wanted) in [
        ("L P#21.0; T MD 0; L MB [MD 0];", 0x22),
        ("L P#20.0; T LD 20; L MW [LD 20];", 0x1122),
        ("OPN DB 10; L P#20.0; T DBD 4; L MW [DBD 4];", 0x1122),
        ("OPN DI 10; L P#22.0; T DID 4; L MW [DID 4];", 0x3344),
        ("L P#20.0; LAR1; L MW [AR1,P#1.0];", 0x2233),
        ("LAR2 P#M 20.0; L W [AR2,P#2.0];", 0x3344),
        // The area byte of AR is ignored if the operation has the area.
        ("LAR1 P#I 20.0; L MB [AR1,P#0.0];", 0x11),
        ("L P#M 20.0; LAR1; L D [AR1,P#0.0];", 0x3344),
    ] {
        assert_eq!(result(statements), wanted, "{statements}");
    }
}

#[test]
fn bits_carry_into_bytes() {
    // 20.7 + 0.2 = 21.1; 16#22 has bits 1 and 5.
    let text = "L DW#16#11223344; T MD 20; LAR1 P#20.7; A M [AR1,P#0.2]; = M 1.0; LAR2 P#M 20.0; A [AR2,P#1.2]; = M 1.1; \
                SET; = [AR2,P#0.7]; L P#20.6; T MD 4; S M [MD 4];";
    let mut plc = Plc::of_statements(text);
    plc.scan();
    assert_eq!((plc.bit(1, 0), plc.bit(1, 1)), (true, false));
    assert_eq!(plc.memory.flags[20], 0x11 | 0xC0);
}

#[test]
fn a_pointer_with_bits_or_without_an_area_is_a_fault() {
    for (statements, wanted) in [
        ("L P#20.1; T MD 0; L MB [MD 0];", Fault::Alignment),
        ("LAR1 P#20.0; L B [AR1,P#0.0];", Fault::AreaCode(0)),
        ("L DW#16#88000000; LAR1; L W [AR1,P#0.0];", Fault::AreaCode(0x88)),
        ("L P#255.0; T MD 0; L MW [MD 0];", Fault::ReadLength(255)),
        ("L P#256.0; T MD 0; SET; S M [MD 0];", Fault::ReadLength(256)),
        ("L P#256.0; T MD 0; T MB [MD 0];", Fault::WriteLength(256)),
        ("L DBW 0;", Fault::NoDataBlock(0)),
        ("L DIW 0;", Fault::NoInstance(0)),
        ("OPN DB 11;", Fault::NoDataBlock(11)),
        ("OPN DI 11;", Fault::NoInstance(11)),
        ("L DB11.DBW 0;", Fault::NoDataBlock(11)),
        ("L DB10.DBW 31;", Fault::ReadLength(31)),
        ("T DB10.DBD 30;", Fault::WriteLength(30)),
        ("L LB 200;  L P#1000.0; T LD 20; L LB [LD 20];", Fault::ReadLength(1000)),
    ] {
        let (done, ..) = trial(statements, registers(0, 0, 0));
        assert_eq!(done, Err(wanted), "{statements}");
    }
}

#[test]
fn a_fully_qualified_access_leaves_its_data_block_open() {
    for statements in [
        "L DB10.DBW 2;",
        "T DB10.DBB 3;",
        "A DB10.DBX 2.0;",
        "= DB10.DBX 2.0;",
        "S DB10.DBX 2.0;",
        "R DB10.DBX 2.0;",
        "FP DB10.DBX 2.0;",
    ] {
        let mut plc = Plc::of_statements(&format!("L 7; T MW 4; {statements} L DBNO; T MW 100; L DBLG; T MW 102;"));
        plc.scan();
        assert_eq!((plc.word(100), plc.word(102)), (10, 32), "{statements}");
    }
    let mut plc = Plc::of_statements("L 7; T DB10.DBW 4; L DBW 4; T MW 100; CDB; L DINO; T MW 102; L DBNO; T MW 104;");
    plc.scan();
    assert_eq!((plc.word(100), plc.word(102), plc.word(104)), (7, 10, 0));
}

#[test]
fn data_blocks_by_number() {
    let mut plc = Plc::of_statements(
        "L 10; T MW 0; OPN DB [MW 0]; L DBNO; T MW 100; L 0; T MW 0; OPN DB [MW 0]; L DBNO; T MW 102;",
    );
    plc.scan();
    assert_eq!((plc.word(100), plc.word(102)), (10, 0));
}

#[test]
fn the_peripheral_area_reads_inputs_and_writes_outputs() {
    let mut plc = Plc::of_statements("L PIW 4; T PQW 6; L QW 6; T MW 100;");
    plc.memory.inputs[5] = 9;
    plc.scan();
    assert_eq!((plc.word(100), plc.memory.outputs[7]), (9, 9));
    let (done, ..) = trial("L P#1000.0; T MD 0; L PIB [MD 0];", registers(0, 0, 0));
    assert_eq!(done, Err(Fault::Peripheral(1000)));
}
