//! Calls with every kind of parameter, instances and multi-instances, registers.

use super::{Plc, findings};
use crate::plc::step7::engine::Fault;

/// A program: OB1 with its statements, other blocks before it, and room in M.
fn plc(blocks: &str, statements: &str) -> Plc {
    Plc::new(&format!("{blocks}\n{}", super::ob1(statements)))
}

const ADD: &str =
    "FUNCTION FC 1 : INT\nVAR_INPUT\na : INT;\nb : INT;\nEND_VAR\nBEGIN\nL #a; L #b; +I; T #RET_VAL;\nEND_FUNCTION";

#[test]
fn a_function_reads_and_writes_its_operands() {
    let mut plc = plc(
        ADD,
        "L 3; T MW 0; CALL FC 1 ( a := MW 0, b := 4, RET_VAL := MW 2 ); L 10; T DB10.DBW 4; \
         CALL FC 1 ( b := DB10.DBW 4, a := MW 2, RET_VAL := DB10.w[3] ); L DB10.DBW 6; T MW 4;",
    );
    plc.scan();
    assert_eq!((plc.word(2), plc.word(4)), (7, 17));
}

#[test]
fn an_operand_in_m_is_written_at_once_and_one_in_a_data_block_after_the_call() {
    let block = "FUNCTION FC 1 : VOID\nVAR_IN_OUT\nx : INT;\nEND_VAR\nBEGIN\nL 5; T #x; L MW 0; T MW 2; L DB10.DBW 0; T MW 4;\nEND_FUNCTION";
    let mut plc =
        plc(block, "CALL FC 1 ( x := MW 0 ); L MW 2; T MW 6; CALL FC 1 ( x := DB10.DBW 0 ); L DB10.DBW 0; T MW 8;");
    plc.scan();
    assert_eq!((plc.word(6), plc.word(4), plc.word(8)), (5, 0, 5));
}

#[test]
fn an_output_that_is_never_written_keeps_flags() {
    let block = "FUNCTION FC 1 : VOID\nVAR_OUTPUT\nx : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION";
    let mut plc = plc(block, "L 9; T MW 0; CALL FC 1 ( x := MW 0 );");
    assert_eq!(plc.scan().word(0), 9);
}

#[test]
fn bits_timers_counters_and_blocks_are_parameters() {
    let block = "FUNCTION FC 1 : VOID\nVAR_INPUT\ni : BOOL;\nt : TIMER;\nz : COUNTER;\nd : BLOCK_DB;\nf : BLOCK_FC;\nv : S5TIME;\nEND_VAR\nVAR_OUTPUT\no : BOOL;\nEND_VAR\n\
        BEGIN\nA #i; L #v; SE #t; A #t; = #o; A #i; CU #z; OPN #d; L DBNO; T MW 4; UC #f;\nEND_FUNCTION\n\
        FUNCTION FC 2 : VOID\nBEGIN\nL 77; T MW 6;\nEND_FUNCTION";
    let mut plc =
        plc(block, "CALL FC 1 ( i := M 0.0, t := T 3, z := C 4, d := DB 10, f := FC 2, v := S5T#1S, o := M 0.1 );");
    plc.set_bit(0, 0, true).scan();
    assert_eq!((plc.bit(0, 1), plc.word(4), plc.word(6)), (true, 10, 77));
    assert_eq!((plc.cpu.timer(3, 0), plc.cpu.counter(4)), (Some((100, true)), Some(1)));
}

#[test]
fn parameters_are_handed_on_to_further_functions() {
    let blocks = format!(
        "{ADD}\nFUNCTION FC 2 : INT\nVAR_INPUT\nx : INT;\nt : TIMER;\nEND_VAR\nBEGIN\nCALL FC 1 ( a := #x, b := #x, RET_VAL := #RET_VAL ); \
         CALL FC 3 ( t := #t );\nEND_FUNCTION\nFUNCTION FC 3 : VOID\nVAR_INPUT\nt : TIMER;\nEND_VAR\nBEGIN\nSET; L S5T#1S; SE #t;\nEND_FUNCTION"
    );
    let mut plc = plc(&blocks, "CALL FC 2 ( x := 21, t := T 2, RET_VAL := MW 2 );");
    assert_eq!(plc.scan().word(2), 42);
    assert_eq!(plc.cpu.timer(2, 0), Some((100, true)));
}

#[test]
fn structures_and_arrays_are_reached_through_a_pointer() {
    let blocks = "TYPE UDT 1\nSTRUCT\na : INT;\nb : ARRAY [1 .. 3] OF INT;\nEND_STRUCT;\nEND_TYPE\n\
        DATA_BLOCK DB 20\nSTRUCT\nfirst : INT;\nu : UDT 1;\nEND_STRUCT;\nBEGIN\nu.b[2] := 5;\nEND_DATA_BLOCK\n\
        FUNCTION FC 1 : VOID\nVAR_IN_OUT\nu : UDT 1;\nEND_VAR\nBEGIN\nL #u.b[2]; + 1; T #u.a; L DBNO; T MW 2;\nEND_FUNCTION\n\
        FUNCTION FC 2 : VOID\nVAR_IN_OUT\nu : UDT 1;\nEND_VAR\nBEGIN\nCALL FC 1 ( u := #u );\nEND_FUNCTION\n\
        FUNCTION FC 3 : INT\nVAR_TEMP\nu : UDT 1;\nEND_VAR\nBEGIN\nL 8; T #u.b[2]; CALL FC 1 ( u := #u ); L #u.a; T #RET_VAL;\nEND_FUNCTION";
    let mut plc = plc(blocks, "CALL FC 2 ( u := DB20.u ); L DB20.u.a; T MW 4; CALL FC 3 ( RET_VAL := MW 6 );");
    plc.scan();
    assert_eq!((plc.word(4), plc.word(6)), (6, 9));
    // Access through the pointer opened DB20 in the function.
    assert_eq!(plc.memory.data(20).unwrap()[3], 6);
}

const MULTIPLY: &str = "FUNCTION_BLOCK FB 1\nVAR_INPUT\na : INT := 2;\nb : INT := 3;\nEND_VAR\nVAR_OUTPUT\nq : INT;\nEND_VAR\nVAR_IN_OUT\nsum : INT;\nEND_VAR\nVAR\ncalls : INT;\nEND_VAR\n\
    BEGIN\nL #a; L #b; *I; T #q; L #sum; +I; T #sum; L #calls; + 1; T #calls;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 20\nFB 1\nBEGIN\nb := 5;\nEND_DATA_BLOCK";

#[test]
fn a_function_block_keeps_its_parameters_in_the_instance() {
    let mut plc = plc(MULTIPLY, "CALL FB 1, DB 20 ( a := MW 0, q := MW 2, sum := MW 4 ); CALL FB 1, DB 20;");
    plc.memory.flags[1] = 4;
    plc.scan();
    // a = 4, b = 5: q = 20; the second call adds to the sum in the instance only.
    assert_eq!((plc.word(2), plc.word(4)), (20, 20));
    assert_eq!(plc.memory.data(20).unwrap(), [0, 4, 0, 5, 0, 20, 0, 40, 0, 2]);
}

#[test]
fn a_call_of_a_function_block_leaves_its_registers() {
    let block = "FUNCTION_BLOCK FB 1\nVAR\nx : INT;\nEND_VAR\nBEGIN\nTAR2 MD 40; L DBNO; T MW 44; L DINO; T MW 46;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 21\nSTRUCT\nx : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(
        block,
        "OPN DB 10; OPN DI 21; LAR2 P#M 5.0; CALL FB 1, DB 20; TAR2 MD 50; L DBNO; T MW 54; L DINO; T MW 56;",
    );
    plc.scan();
    // In the block: AR2 at its beginning, DB = the caller's DI, DI = the instance.
    assert_eq!((plc.double(40), plc.word(44), plc.word(46)), (0x8400_0000, 21, 20));
    // After it: AR2 and DI as before, DB = the instance.
    assert_eq!((plc.double(50), plc.word(54), plc.word(56)), (0x8300_0028, 20, 21));
}

#[test]
fn multi_instances_lie_within_the_instance_of_their_caller() {
    let blocks = "FUNCTION_BLOCK FB 2\nVAR_INPUT\ni : INT;\nEND_VAR\nVAR_OUTPUT\no : INT;\nEND_VAR\nVAR\nn : INT;\nEND_VAR\nBEGIN\nL #n; L #i; +I; T #n; T #o; TAR2 MD 40;\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK FB 1\nVAR_INPUT\nv : INT;\nEND_VAR\nVAR\nk : INT;\na : FB 2;\nb : FB 2;\nEND_VAR\n\
        BEGIN\nCALL #a ( i := #v, o := #k ); CALL #b ( i := #k, o := MW 4 ); L #b.n; T MW 6; TAR2 MD 44;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(blocks, "CALL FB 1, DB 20 ( v := 3 ); CALL FB 1, DB 20 ( v := 4 );");
    plc.scan();
    // a: 3, then 7; b: 3, then 10.
    assert_eq!((plc.word(4), plc.word(6)), (10, 10));
    assert_eq!(plc.memory.data(20).unwrap(), [0, 4, 0, 7, 0, 4, 0, 7, 0, 7, 0, 7, 0, 10, 0, 10]);
    assert_eq!((plc.double(40), plc.double(44)), (0x8400_0050, 0x8400_0000));
}

#[test]
fn complex_parameters_of_a_function_block_are_copied_or_pointed_to() {
    let blocks = "TYPE UDT 1\nSTRUCT\na : INT;\nb : INT;\nEND_STRUCT;\nEND_TYPE\n\
        FUNCTION_BLOCK FB 1\nVAR_INPUT\nu : UDT 1;\ns : STRING [6];\nEND_VAR\nVAR_IN_OUT\nx : UDT 1;\nEND_VAR\nBEGIN\nL #u.b; + 1; T #x.a; L #s[2]; T MB 5;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 21\nSTRUCT\nu : UDT 1;\ny : UDT 1;\nt : STRING [6] := 'AZ';\nEND_STRUCT;\nBEGIN\nu.b := 6;\nEND_DATA_BLOCK";
    let mut plc = plc(blocks, "CALL FB 1, DB 20 ( u := DB21.u, s := DB21.t, x := DB21.y ); L DB21.y.a; T MW 2;");
    plc.scan();
    assert_eq!((plc.word(2), plc.memory.flags[5]), (7, b'Z'));
    assert_eq!(&plc.memory.data(20).unwrap()[12..], [0, 21, 0x84, 0, 0, 0x20]);
}

#[test]
fn any_and_pointer_have_their_bytes() {
    let blocks = "FUNCTION FC 1 : VOID\nVAR_INPUT\np : ANY;\nq : POINTER;\nEND_VAR\nBEGIN\n\
        L P##p; LAR1; L D [AR1,P#0.0]; T MD 40; L D [AR1,P#4.0]; T MD 44; L W [AR1,P#8.0]; T MW 48; \
        LAR1 P##q; L W [AR1,P#0.0]; T MW 50; L D [AR1,P#2.0]; T MD 52;\nEND_FUNCTION\n\
        DATA_BLOCK DB 20\nSTRUCT\nx : INT;\nr : ARRAY [1 .. 6] OF BYTE;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    for (any, pointer, wanted) in [
        ("MW 60", "MW 60", [0x1004_0001, 0x0000_8300, 0x01E0_0000, 0x8300_01E0]),
        ("P#DB20.DBX 2.0 BYTE 6", "P#DB20.DBX 2.0", [0x1002_0006, 0x0014_8400, 0x0010_0014, 0x8400_0010]),
        ("DB20.r", "DB20.x", [0x1002_0006, 0x0014_8400, 0x0010_0014, 0x8400_0000]),
        ("P#M 10.0 WORD 4", "P#M 10.0", [0x1004_0004, 0x0000_8300, 0x0050_0000, 0x8300_0050]),
    ] {
        let mut plc = plc(blocks, &format!("CALL FC 1 ( p := {any}, q := {pointer} );"));
        plc.scan();
        assert_eq!([40, 44, 48, 52].map(|byte| plc.double(byte)), wanted, "{any}");
    }
}

#[test]
fn a_temporary_any_is_handed_on_as_it_is() {
    let blocks = "FUNCTION FC 1 : VOID\nVAR_TEMP\np : ANY;\nresult : INT;\nEND_VAR\nBEGIN\n\
        LAR1 P##p; L W#16#1002; T W [AR1,P#0.0]; L 4; T W [AR1,P#2.0]; L 0; T W [AR1,P#4.0]; L P#M 60.0; T D [AR1,P#6.0]; \
        CALL SFC 20 ( SRCBLK := #p, RET_VAL := #result, DSTBLK := P#M 70.0 BYTE 4 ); L #result; T MW 2;\nEND_FUNCTION";
    let mut plc = plc(blocks, "L DW#16#01020304; T MD 60; CALL FC 1;");
    plc.scan();
    assert_eq!((plc.double(70), plc.word(2)), (0x0102_0304, 0));
}

#[test]
fn the_address_of_a_static_variable_is_without_ar2() {
    let blocks = "FUNCTION_BLOCK FB 2\nVAR\nx : INT;\ny : INT;\nEND_VAR\nBEGIN\nL P##y; T MD 40; LAR1 P##y; TAR2; +AR1; L 9; T DIW [AR1,P#0.0];\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK FB 1\nVAR\nk : INT;\na : FB 2;\nEND_VAR\nBEGIN\nCALL #a;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(blocks, "CALL FB 1, DB 20;");
    plc.scan();
    assert_eq!(plc.double(40), 0x8500_0010);
    assert_eq!(plc.memory.data(20).unwrap(), [0, 0, 0, 0, 0, 9]);
}

#[test]
fn registers_pass_in_both_directions() {
    let block = "FUNCTION FC 1 : VOID\nBEGIN\nOPN DB 20; OPN DI 20; T MW 40; + 1; SET; SAVE;\nEND_FUNCTION\n\
        DATA_BLOCK DB 20\nSTRUCT\nx : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK";
    let mut plc =
        plc(block, "OPN DB 10; CLR; L 5; UC FC 1; T MW 42; = M 0.0; A BR; = M 0.1; L DBNO; T MW 44; L DINO; T MW 46;");
    plc.scan();
    assert_eq!((plc.word(40), plc.word(42), plc.memory.flags[0]), (5, 6, 3));
    // DB and DI of the caller come back.
    assert_eq!((plc.word(44), plc.word(46)), (10, 0));
}

#[test]
fn a_conditional_call_depends_on_the_rlo() {
    let block = "FUNCTION FC 1 : VOID\nBEGIN\nL MW 2; + 1; T MW 2;\nEND_FUNCTION";
    let mut plc = plc(block, "A M 0.0; CC FC 1; = M 0.1; L 1; T MW 4; A M 0.0; CC FC [MW 4];");
    plc.scan();
    assert_eq!((plc.word(2), plc.bit(0, 1)), (0, true));
    plc.set_bit(0, 0, true).scan();
    assert_eq!(plc.word(2), 2);
}

#[test]
fn a_block_ends_early_if_the_rlo_is_1() {
    let block = "FUNCTION FC 1 : VOID\nBEGIN\nA M 0.0; BEC; = M 0.1; L 1; T MW 2;\nEND_FUNCTION";
    let mut plc = plc(block, "L 0; T MW 2; CALL FC 1;");
    plc.scan();
    // BEC sets the RLO.
    assert_eq!((plc.bit(0, 1), plc.word(2)), (true, 1));
    plc.set_bit(0, 0, true).scan();
    assert_eq!(plc.word(2), 0);
}

#[test]
fn recursion_is_limited_by_the_call_depth() {
    let block = "FUNCTION FC 1 : VOID\nBEGIN\nL MW 2; + -1; T MW 2; L 0; <=I; BEC; CALL FC 1;\nEND_FUNCTION";
    let mut deep = plc(block, "L 17; T MW 2; CALL FC 1;");
    // 17 calls within OB1, one more than 16.
    assert_eq!(deep.fault(), Fault::CallDepth);
    let mut shallow = plc(block, "L 16; T MW 2; CALL FC 1;");
    shallow.scan();
}

#[test]
fn local_data_of_callers_are_in_area_v() {
    let block = "FUNCTION FC 1 : VOID\nVAR_INPUT\na : INT;\nEND_VAR\nBEGIN\nL P##a; T MD 40; LAR1; L W [AR1,P#0.0]; T MW 44;\nEND_FUNCTION";
    // The constant is put into the local data of OB1, behind its 20 bytes.
    let mut plc = plc(block, "CALL FC 1 ( a := 7 );");
    plc.scan();
    assert_eq!((plc.double(40), plc.word(44)), (0x8700_00A0, 7));
}

#[test]
fn code_version_1_has_no_ar2() {
    let blocks = "FUNCTION_BLOCK FB 1\nCODE_VERSION1\nVAR_INPUT\na : INT;\nEND_VAR\nVAR\nb : INT;\nEND_VAR\nBEGIN\nLAR2 P#M 50.0; L #a; T #b;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(blocks, "CALL FB 1, DB 20 ( a := 6 );");
    plc.scan();
    assert_eq!(plc.memory.data(20).unwrap(), [0, 6, 0, 6]);
}

#[test]
fn wrong_calls_are_refused_with_their_names() {
    for (statement, wanted) in [
        ("CALL FC 1 ( a := 1, RET_VAL := MW 2 );", "the parameter `b` of FC1 is missing"),
        ("CALL FC 1 ( a := 1, b := 2, c := 3, RET_VAL := MW 2 );", "FC1 has no parameter `c`"),
        ("CALL FC 1 ( a := M 0.0, b := 2, RET_VAL := MW 2 );", "expected an operand of the width word, found M 0.0"),
        ("CALL FC 1 ( a := 1.5, b := 2, RET_VAL := MW 2 );", "expected a INT for `a`, found 1.5e0"),
        (
            "CALL FC 1 ( a := 1, b := 2, RET_VAL := 3 );",
            "expected an operand that can be written for `RET_VAL`, found 3",
        ),
        ("CALL FC 202;", "FC202 is called and is nowhere"),
        ("CALL SFC 99;", "SFC99 is not built in"),
        ("CALL FB 1;", "expected an instance data block behind FB1, found no operand"),
        ("CALL DB 10;", "expected an FC, FB, SFC or SFB, found DB10"),
        ("UC SFC 20;", "expected a block without parameters, found SFC20"),
    ] {
        let found = findings(&format!("{ADD}\n{}", super::ob1(statement)));
        assert_eq!(found.len(), 1, "{statement}: {found:#?}");
        assert!(found[0].contains(wanted) && found[0].contains("OB1, network 1"), "{statement}: {found:#?}");
    }
}

#[test]
fn area_l_of_an_any_is_that_of_the_caller_of_a_system_function() {
    let blocks = "FUNCTION FC 1 : VOID\nVAR_TEMP\np : ANY;\nbuffer : ARRAY [1 .. 4] OF BYTE;\nresult : INT;\nEND_VAR\nBEGIN\n\
        LAR1 P##p; L W#16#1002; T W [AR1,P#0.0]; L 4; T W [AR1,P#2.0]; L 0; T W [AR1,P#4.0]; L P##buffer; T D [AR1,P#6.0]; \
        CALL SFC 20 ( SRCBLK := MD 60, RET_VAL := #result, DSTBLK := #p ); L #buffer[4]; T MB 2; L #buffer[1]; T MB 3; \
        CALL SFC 20 ( SRCBLK := #buffer, RET_VAL := #result, DSTBLK := MD 64 );\nEND_FUNCTION";
    let mut plc = plc(blocks, "L DW#16#01020304; T MD 60; CALL FC 1;");
    plc.scan();
    assert_eq!((plc.word(2), plc.double(64)), (0x0401, 0x0102_0304));
}

#[test]
fn built_in_blocks_can_be_multi_instances() {
    let blocks = "FUNCTION_BLOCK FB 1\nVAR_INPUT\ngo : BOOL;\nEND_VAR\nVAR\na : SFB 4;\nb : SFB 0;\nEND_VAR\nBEGIN\n\
        CALL #a ( IN := #go, PT := T#1S ); CALL #b ( CU := #a.Q, PV := 1, CV := MW 2 ); A #a.Q; = M 1.0;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc = plc(blocks, "CALL FB 1, DB 20 ( go := M 0.0 );");
    plc.set_bit(0, 0, true).scan();
    assert!(!plc.after(super::SECOND - 1_000_000).bit(1, 0));
    assert!(plc.after(1_000_000).bit(1, 0));
    assert_eq!(plc.word(2), 1);
}

#[test]
fn function_blocks_get_numbers_and_pointers() {
    let blocks = "FUNCTION_BLOCK FB 1\nVAR_INPUT\nt : TIMER;\nz : COUNTER;\nd : BLOCK_DB;\np : ANY;\nq : POINTER;\nEND_VAR\nBEGIN\n\
        SET; L S5T#1S; SE #t; A #t; = M 1.0; SET; CU #z; OPN #d; L DBNO; T MW 2; \
        CALL SFC 20 ( SRCBLK := #p, RET_VAL := MW 4, DSTBLK := MD 64 );\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK";
    let mut plc =
        plc(blocks, "L 7; T MW 62; CALL FB 1, DB 20 ( t := T 3, z := C 4, d := DB 10, p := MD 60, q := DB10.w[1] );");
    plc.scan();
    assert_eq!((plc.bit(1, 0), plc.word(2), plc.word(4), plc.double(64)), (true, 10, 0, 7));
    assert_eq!((plc.cpu.timer(3, 0), plc.cpu.counter(4)), (Some((100, true)), Some(1)));
    assert_eq!(&plc.memory.data(20).unwrap()[16..], [0, 10, 0x84, 0, 0, 0x10]);
}
