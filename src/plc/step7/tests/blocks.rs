//! Declarations, data blocks, initial and actual values.

use super::{Plc, findings, program};
use crate::plc::step7::{Settings, Source, SourceKind, SymbolForm, compile};

fn bytes(text: &str, number: u16) -> Vec<u8> {
    program(text).data_blocks().iter().find(|block| block.number == number).unwrap().bytes.clone()
}

#[test]
fn a_data_block_has_initial_values_and_over_them_actual_values() {
    let text = "DATA_BLOCK DB 1\nTITLE =a = b ; c\n//comment\n{ S7_language := '7(1) Deutsch' }\nAUTHOR : me\nVERSION : 1.2\nNON_RETAIN\n\
        STRUCT\n a : BOOL := TRUE; //x\n b { S7_dynamic := 'true' } : BYTE := B#16#12;\n c : INT := -2;\n d : ARRAY [1 .. 5] OF INT := 1, 3 (9), 4;\n\
        e : STRING [4] := 'AB';\n f : REAL := 1.5;\n g, h : WORD := W#16#ABCD;\n s : STRUCT x : BOOL; y : DINT := L#-1; END_STRUCT ;\n\
        END_STRUCT ;\nBEGIN\n c := 7; d[2] := 8;\n s.x := TRUE; e := 'XYZ';\nEND_DATA_BLOCK\n";
    let wanted = [
        0x01, 0x12, 0, 7, 0, 1, 0, 8, 0, 9, 0, 9, 0, 4, 4, 3, b'X', b'Y', b'Z', 0, 0x3F, 0xC0, 0, 0, 0xAB, 0xCD, 0xAB,
        0xCD, 1, 0, 0xFF, 0xFF, 0xFF, 0xFF,
    ];
    assert_eq!(bytes(text, 1), wanted);
}

#[test]
fn types_take_their_initial_values_along() {
    let text = "TYPE UDT 1\nSTRUCT\na : INT := 5;\nb : STRING [2];\nEND_STRUCT ;\nEND_TYPE\n\
        DATA_BLOCK DB 1\nUDT 1\nBEGIN\nEND_DATA_BLOCK\n\
        DATA_BLOCK DB 2\nSTRUCT\nx : ARRAY [1 .. 2] OF UDT 1;\nEND_STRUCT ;\nBEGIN\nx[2].a := 6;\nEND_DATA_BLOCK\n\
        DATA_BLOCK DB 3\nFB 1\nBEGIN\nn := 3;\nEND_DATA_BLOCK\n\
        FUNCTION_BLOCK FB 1\nVAR_INPUT\ni : BOOL := TRUE;\nEND_VAR\nVAR_OUTPUT\no : BOOL;\nEND_VAR\nVAR_IN_OUT\nio : UDT 1;\nEND_VAR\nVAR\n\
        n : INT := 2;\nu : UDT 1;\nm : FB 2;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK\n\
        FUNCTION_BLOCK FB 2\nVAR\nz : INT := 9;\nEND_VAR\nBEGIN\nEND_FUNCTION_BLOCK\n";
    assert_eq!(bytes(text, 1), [0, 5, 2, 0, 0, 0]);
    assert_eq!(bytes(text, 2), [0, 5, 2, 0, 0, 0, 0, 6, 2, 0, 0, 0]);
    // Inputs, outputs and in-outs each begin at an even byte; the in-out structure is a pointer of 6 bytes.
    assert_eq!(bytes(text, 3), [1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 5, 2, 0, 0, 0, 0, 9]);
}

#[test]
fn symbols_name_blocks_data_and_addresses() {
    let table = "126,Start                   FC      1   FC      1 \r\n126,Daten                   DB      1   DB      1 \r\n126,Läuft                   \
                 M       1.0 BOOL      ja\r\n126,Typ                     UDT     1   UDT     1\r\n126,Hauptteil               OB      1   OB      1\r\n";
    let text = "TYPE \"Typ\"\nSTRUCT\nw : ARRAY [0 .. 3] OF INT;\nEND_STRUCT;\nEND_TYPE\nDATA_BLOCK \"Daten\"\n\"Typ\"\nBEGIN\nEND_DATA_BLOCK\n\
        FUNCTION \"Start\" : VOID\nBEGIN\nL 5; T \"Daten\".w[2]; L \"Daten\".DBW 4; T MW 2; SET; = \"läuft\";\nEND_FUNCTION\n\
        ORGANIZATION_BLOCK \"Hauptteil\"\nBEGIN\nCALL \"Start\";\nEND_ORGANIZATION_BLOCK\n";
    let sources = [
        Source::statements("a.awl", text),
        Source { name: "symbols.asc".into(), text: table.into(), kind: SourceKind::Symbols(SymbolForm::Asc) },
    ];
    let compiled = compile(&sources, &Settings::default());
    assert_eq!(compiled.findings, []);
    let program = std::sync::Arc::new(compiled.program.unwrap());
    let mut memory = super::OwnMemory::new(&program);
    let mut cpu = super::Cpu::new(program, super::CpuOptions::default());
    cpu.scan(&mut memory, 0).unwrap();
    assert_eq!(memory.data(1).unwrap(), [0, 0, 0, 0, 0, 5, 0, 0]);
    assert_eq!((memory.flags[3], memory.flags[1]), (5, 1));
}

#[test]
fn faults_of_declarations_have_their_places() {
    for (text, wanted) in [
        (
            "DATA_BLOCK DB 1\nSTRUCT\na : INTT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
            "a.awl:3:5: expected a type, found `INTT`",
        ),
        (
            "DATA_BLOCK DB 1\nSTRUCT\na : INT := 99999;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
            "a.awl:3:1: expected a value of the type INT",
        ),
        (
            "DATA_BLOCK DB 1\nSTRUCT\na : INT;\nA : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
            "a.awl:4:1: `A` is declared twice",
        ),
        (
            "DATA_BLOCK DB 1\nSTRUCT\na : INT;\nEND_STRUCT;\nBEGIN\nb := 1;\nEND_DATA_BLOCK\n",
            "a.awl:6:1: there is no `b`",
        ),
        ("DATA_BLOCK DB 1\nUDT 5\nBEGIN\nEND_DATA_BLOCK\n", "a.awl:2:1: UDT5 is not in the sources"),
        ("TYPE UDT 1\nSTRUCT\na : UDT 1;\nEND_STRUCT;\nEND_TYPE\n", "UDT1 contains itself"),
        (
            "DATA_BLOCK DB 1\nSTRUCT\na : ARRAY [1 .. 32000, 1 .. 32000] OF INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
            "at most 64 KiB",
        ),
        ("DATA_BLOCK DB 1\nSTRUCT\na : INT;\n", "expected `END_STRUCT`"),
        (
            "DATA_BLOCK DB 1\nSTRUCT\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\nDATA_BLOCK DB 1\nSTRUCT\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
            "DB1 is there twice",
        ),
        ("FUNCTION FB 1 : VOID\nBEGIN\nEND_FUNCTION\n", "expected a block of the kind Fc, found Fb"),
        ("x\n", "a.awl:1:1: expected a block, found `x`"),
    ] {
        let found = findings(text);
        assert!(found.iter().any(|finding| finding.contains(wanted)), "{text}: {found:#?}");
    }
}

#[test]
fn a_block_from_lad_compiles() {
    let text = "ORGANIZATION_BLOCK OB 1\nTITLE =\"Main\"\n{ S7_m_c := 'true' }\nVERSION : 0.1\n\nVAR_TEMP\n  i : ARRAY  [0 .. 19 ] OF BYTE ;\t//x\nEND_VAR\n\
        BEGIN\nNETWORK\nTITLE =Network ; 1\n//comment\n      A(    ; \n      A     M      0.0; \n      O     M      0.1; \n      )     ; \n      =     L     20.0; \n\
        A     L     20.0; \n      BLD   102; \n      =     M      1.0; \n      A     L     20.0; \n      JNB   _001; \n      L     5; \n      T     MW     2; \n\
        _001: NOP   0; \nNETWORK\nTITLE =\n\n      NOP   1; \nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.set_bit(0, 1, true).scan();
    assert_eq!((plc.bit(1, 0), plc.word(2)), (true, 5));
    plc.set_bit(0, 1, false).scan();
    assert!(!plc.bit(1, 0));
}
