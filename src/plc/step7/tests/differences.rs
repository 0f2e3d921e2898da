//! Rules in which engines differ: qualified accesses, the order of effects of a call, variables of function blocks, declarations.

use super::Plc;

/// Data blocks 10 and 20 with three words each: 1, 2, 3 and 11, 12, 13.
const DATA: &str = "DATA_BLOCK DB 10\nSTRUCT\na : INT := 1; b : INT := 2; c : INT := 3;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
    DATA_BLOCK DB 20\nSTRUCT\na : INT := 11; b : INT := 12; c : INT := 13;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n";

/// OB1 with these statements behind blocks; M up to byte 99.
#[track_caller]
fn run(blocks: &str, statements: &str) -> Plc {
    let text =
        format!("{DATA}{blocks}ORGANIZATION_BLOCK OB 1\nBEGIN\n{statements}\nBEU;\nL MB 99;\nEND_ORGANIZATION_BLOCK\n");
    let mut plc = Plc::new(&text);
    plc.scan();
    plc
}

/// `DB20.DBW 0` is `OPN DB 20` and `DBW 0`, for every operation, and so for the partly qualified access behind it.
#[test]
fn every_qualified_access_opens_its_data_block() {
    for access in [
        "L DB20.DBW 0;",
        "T DB20.DBW 4;",
        "SET; A DB20.DBX 0.0;",
        "SET; = DB20.DBX 4.0;",
        "SET; S DB20.DBX 4.0;",
        "SET; R DB20.DBX 4.0;",
        "CLR; S DB20.DBX 4.0;",
        "SET; FP DB20.DBX 4.0;",
        "L DB20.DBX4.0;",
    ] {
        // An operand without blanks, as people write it.
        let access = if access == "L DB20.DBX4.0;" { "A DB20.DBX4.0;" } else { access };
        let plc = run("", &format!("OPN DB 10; {access} L DBW 2; T MW 0; L DBNO; T MW 2;"));
        assert_eq!((plc.word(0), plc.word(2)), (12, 20), "{access}");
    }
}

/// What a block opens is its own.
#[test]
fn uc_and_cc_give_both_data_blocks_back() {
    let open = "FUNCTION FC 1 : VOID\nBEGIN\nOPN DB 20; OPN DI 20;\nEND_FUNCTION\n";
    let plc = run(
        open,
        "OPN DB 10; OPN DI 10; UC FC 1; L DBNO; T MW 0; L DINO; T MW 2; SET; CC FC 1; L DBNO; T MW 4; L DIW 2; T MW 6;",
    );
    assert_eq!([0, 2, 4, 6].map(|byte| plc.word(byte)), [10, 10, 10, 2]);
}

/// The operand in a data block is copied before the call, which opens the block in the caller; its result comes back after the call.
#[test]
fn the_copy_of_an_operand_opens_its_data_block_in_the_caller() {
    let add = "FUNCTION FC 1 : VOID\nVAR_INPUT\nx : INT;\nEND_VAR\nVAR_OUTPUT\ny : INT;\nEND_VAR\nBEGIN\n\
        L #x; + 100; T #y; L DB20.DBW 4; T MW 10;\nEND_FUNCTION\n";
    let plc = run(add, "OPN DB 10; CALL FC 1 ( x := DB20.DBW 0, y := DB20.DBW 4 ); L DBNO; T MW 0; L DBW 4; T MW 2;");
    // Within the block DB20.DBW 4 still has its old value.
    assert_eq!((plc.word(0), plc.word(2), plc.word(10)), (20, 111, 13));
}

/// A parameter in M is the operand itself, so a call that writes its output sees it at its input.
#[test]
fn two_parameters_can_be_one_operand() {
    let swap = "FUNCTION FC 1 : VOID\nVAR_INPUT\nx : INT;\nEND_VAR\nVAR_OUTPUT\ny : INT;\nEND_VAR\nBEGIN\n\
        L 7; T #y; L #x; + 1; T #y;\nEND_FUNCTION\n";
    assert_eq!(run(swap, "L 1; T MW 0; CALL FC 1 ( x := MW 0, y := MW 0 );").word(0), 8);
    // In an instance the input is a copy.
    let block = "FUNCTION_BLOCK FB 1\nVAR_INPUT\nx : INT;\nEND_VAR\nVAR_OUTPUT\ny : INT;\nEND_VAR\nBEGIN\n\
        L 7; T #y; L #x; + 1; T #y;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 30\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
    assert_eq!(run(block, "L 1; T MW 0; CALL FB 1 , DB 30 ( x := MW 0, y := MW 0 );").word(0), 2);
}

/// Variables of a function block are DI from AR2 on: a program that moves AR2 reaches others, and its own again when it restores AR2.
#[test]
fn variables_of_a_function_block_follow_ar2_and_di() {
    let block = "FUNCTION_BLOCK FB 1\nVAR\na : INT := 5; b : INT := 6;\nEND_VAR\nBEGIN\n\
        TAR2 MD 20; +AR2 P#2.0; L #a; T MW 0; LAR2 MD 20; L #a; T MW 2; OPN DI 20; L #b; T MW 4;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 30\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
    let plc = run(block, "CALL FB 1 , DB 30;");
    assert_eq!([0, 2, 4].map(|byte| plc.word(byte)), [6, 5, 12]);
}

/// In a multi-instance at byte 4: `P##b` counts from the beginning of its own data, a register-indirect access takes the address as it stands.
#[test]
fn register_indirect_accesses_to_di_add_no_ar2() {
    let blocks = "FUNCTION_BLOCK FB 1\nVAR\na : INT := 5; b : INT := 6;\nEND_VAR\nBEGIN\n\
        LAR1 P##b; L DIW [AR1,P#0.0]; T MW 0; LAR1 P##b; L W [AR1,P#0.0]; T MW 2; TAR2; LAR1 P##b; +AR1; L DIW [AR1,P#0.0]; T MW 4;\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK FB 2\nVAR\nx : INT := 1; y : INT := 2; one : FB 1;\nEND_VAR\nBEGIN\nCALL #one; L #one.b; T MW 6;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 30\nFB 2\nBEGIN\nEND_DATA_BLOCK\n";
    let plc = run(blocks, "CALL FB 2 , DB 30;");
    // Byte 2 of the instance is y; with AR2 it is b, as by its name.
    assert_eq!([0, 2, 4, 6].map(|byte| plc.word(byte)), [2, 2, 6, 6]);
}

/// A data block of a UDT, an output of an instance by its name, elements of a temporary array, initial values with repetitions.
#[test]
fn declarations_and_names_that_others_refuse() {
    let blocks = "TYPE UDT 1\nSTRUCT\nv : ARRAY [0 .. 3] OF INT := 4, 2 (9), 1;\nEND_STRUCT\nEND_TYPE\n\
        DATA_BLOCK DB 30\nUDT 1\nBEGIN\nv[3] := 8;\nEND_DATA_BLOCK\n\
        FUNCTION_BLOCK FB 1\nVAR_OUTPUT\nq { S7_m_c := 'true' } : INT := 3;\nEND_VAR\nBEGIN\nL #q; + 1; T #q;\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK FB 2\nVAR\none : FB 1;\nEND_VAR\nVAR_TEMP\nt : ARRAY [1 .. 3] OF INT;\nEND_VAR\nBEGIN\n\
        CALL #one; L #one.q; T #t[2]; L #t[2]; T MW 0;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 31\nFB 2\nBEGIN\nEND_DATA_BLOCK\n";
    let plc = run(
        blocks,
        "CALL FB 2 , DB 31; L DB30.v[0]; T MW 2; L DB30.v[2]; T MW 4; L DB30.v[3]; T MW 6; L DB31.one.q; T MW 8;",
    );
    assert_eq!([0, 2, 4, 6, 8].map(|byte| plc.word(byte)), [4, 4, 9, 8, 4]);
}

/// An in-out parameter that is a structure: by pointer, so that the called block writes the operand itself, at once.
#[test]
fn a_structure_as_in_out_parameter_is_not_copied() {
    let blocks = "TYPE UDT 1\nSTRUCT\na : INT; b : INT;\nEND_STRUCT\nEND_TYPE\nDATA_BLOCK DB 30\nSTRUCT\ns : UDT 1;\nEND_STRUCT;\nBEGIN\ns.a := 4;\nEND_DATA_BLOCK\n\
        FUNCTION_BLOCK FB 1\nVAR_IN_OUT\np : UDT 1;\nEND_VAR\nBEGIN\nL #p.a; + 1; T #p.b; L DB30.s.b; T MW 0;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 31\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
    let plc = run(blocks, "CALL FB 1 , DB 31 ( p := DB30.s ); L DB30.s.b; T MW 2;");
    assert_eq!((plc.word(0), plc.word(2)), (5, 5));
}
