//! Any text as a source, any program: no panic.

use proptest::prelude::{Just, Strategy, prop_oneof, proptest};

use super::ob1;
use crate::plc::step7::engine::{Cpu, CpuOptions, OwnMemory};
use crate::plc::step7::{Settings, Source, SourceKind, SymbolForm, compile};

fn compiles_or_not(text: &str) {
    let sources = [
        Source::statements("a.awl", text),
        Source { name: "a.asc".into(), text: text.into(), kind: SourceKind::Symbols(SymbolForm::Asc) },
        Source { name: "a.sdf".into(), text: text.into(), kind: SourceKind::Symbols(SymbolForm::Sdf) },
        Source { name: "a.seq".into(), text: text.into(), kind: SourceKind::Symbols(SymbolForm::Seq) },
    ];
    for finding in &compile(&sources, &Settings::default()).findings {
        assert!(!finding.to_string().is_empty());
    }
    runs(text);
}

/// Runs a source if it compiles.
fn runs(text: &str) {
    let settings = Settings { ignores_missing: true, ..Settings::default() };
    let Some(program) = compile(&[Source::statements("a.awl", text)], &settings).program else { return };
    let program = std::sync::Arc::new(program);
    let mut memory = OwnMemory::new(&program);
    let options = CpuOptions { instructions_per_scan: 2000, ..CpuOptions::default() };
    let mut cpu = Cpu::new(program, options);
    let _ = cpu.startup(&mut memory, 0);
    for scan in 0..3 {
        let _ = cpu.scan(&mut memory, scan * 150_000_000);
    }
}

/// Words of sources, in any order.
fn words() -> impl Strategy<Value = String> {
    const WORDS: &[&str] = &[
        "ORGANIZATION_BLOCK OB 1",
        "END_ORGANIZATION_BLOCK",
        "FUNCTION FC 1 : VOID",
        "END_FUNCTION",
        "FUNCTION_BLOCK FB 1",
        "END_FUNCTION_BLOCK",
        "DATA_BLOCK DB 1",
        "END_DATA_BLOCK",
        "TYPE UDT 1",
        "END_TYPE",
        "STRUCT",
        "END_STRUCT",
        "VAR_INPUT",
        "VAR_IN_OUT",
        "VAR",
        "VAR_TEMP",
        "END_VAR",
        "BEGIN",
        "NETWORK",
        "TITLE =",
        "ARRAY",
        "OF",
        "[",
        "]",
        "(",
        ")",
        ";",
        ":",
        ":=",
        ",",
        ".",
        "..",
        "{",
        "}",
        "\"",
        "'",
        "#",
        "#a",
        "a",
        "\"b\"",
        "1",
        "65535",
        "99999999999999999999",
        "1.5",
        "-",
        "+",
        "W#16#FF",
        "P#",
        "P##a",
        "P#M 0.0",
        "P#DB1.DBX 0.0 BYTE 4",
        "B#(",
        "S5T#1S",
        "DT#90-1-1-0:0:0.0",
        "INT",
        "BOOL",
        "STRING",
        "UDT 1",
        "FB 1",
        "CALL",
        "CALL FB 1, DB 1",
        "L",
        "T",
        "A",
        "U",
        "=",
        "==I",
        "JU",
        "JL",
        "a:",
        "M 0.0",
        "MD 4",
        "DBW",
        "DB1.DBW 0",
        "L 20.0",
        "[AR1,P#0.0]",
        "AR1",
        "T 5",
        "C 5",
        "STW",
        "\n",
        "//",
        "\u{e4}",
        "\u{0}",
        "1 .. 9",
        "32767 .. 32767",
    ];
    proptest::collection::vec(proptest::sample::select(WORDS), 0..60).prop_map(|words| words.join(" "))
}

/// Legal statements with any addresses and values.
fn statements() -> impl Strategy<Value = String> {
    const PLAIN: &[&str] = &[
        "NOT",
        "SET",
        "CLR",
        "SAVE",
        "A(",
        "O(",
        "XN(",
        ")",
        "O",
        "==I",
        ">R",
        "<=D",
        "+I",
        "-D",
        "*R",
        "/I",
        "/D",
        "/R",
        "MOD",
        "*D",
        "NEGI",
        "NEGD",
        "SQRT",
        "LN",
        "EXP",
        "SIN",
        "TAN",
        "ACOS",
        "BTI",
        "BTD",
        "ITB",
        "DTB",
        "ITD",
        "DTR",
        "RND",
        "RND+",
        "TRUNC",
        "CAW",
        "CAD",
        "AW",
        "OD",
        "XOW",
        "SLW",
        "SRD",
        "SSI",
        "SSD",
        "RLD",
        "RRD",
        "RLDA",
        "TAK",
        "PUSH",
        "POP",
        "ENT",
        "LEAVE",
        "LAR1",
        "LAR2",
        "TAR1",
        "TAR2",
        "CAR",
        "+AR1",
        "+AR2",
        "CDB",
        "BEC",
        "MCRA",
        "MCRD",
        "MCR(",
        ")MCR",
        "L STW",
        "T STW",
        "L DBLG",
        "L DINO",
        "UC FC 1",
        "CC FC 2",
        "LOOP x",
        "JU x",
        "JC x",
        "JL x",
        "CALL FB 1, DB 11",
        "CALL FC 3 ( a := MW 0, b := P#M 0.0 BYTE 4, c := M 0.0 )",
        "CALL SFC 20 ( SRCBLK := P#M 0.0 BYTE 8, RET_VAL := MW 2, DSTBLK := P#DB10.DBX 0.0 BYTE 8 )",
        "OPN DB 10",
        "OPN DI 10",
        "OPN DB 77",
    ];
    let address = (proptest::sample::select(vec!["MB", "IW", "QD", "LB", "DBW", "DID", "DB10.DBD", "PIB"]), 0..40_u16)
        .prop_map(|(area, byte)| format!("{area} {byte}"));
    let bit = (proptest::sample::select(vec!["M", "I", "Q", "L", "DBX", "DIX", "DB10.DBX"]), 0..40_u16, 0..8_u8)
        .prop_map(|(area, byte, bit)| format!("{area} {byte}.{bit}"));
    let indirect = proptest::sample::select(vec![
        "L MW [MD 0]",
        "T DBB [MD 4]",
        "L W [AR1,P#1.0]",
        "T D [AR2,P#0.0]",
        "A [AR1,P#0.3]",
        "= M [AR2,P#3.7]",
        "S DIX [MD 8]",
        "OPN DB [MW 2]",
        "A T [MW 2]",
        "L C [MW 4]",
        "UC FC [MW 6]",
        "L LW [LD 20]",
        "SE T [MW 0]",
        "CU C [MW 0]",
    ]);
    prop_oneof![
        proptest::sample::select(PLAIN).prop_map(str::to_owned),
        (proptest::sample::select(vec!["A", "ON", "X", "=", "S", "R", "FP", "FN"]), bit)
            .prop_map(|(op, at)| format!("{op} {at}")),
        (proptest::sample::select(vec!["L", "T"]), address).prop_map(|(op, at)| format!("{op} {at}")),
        proptest::num::u32::ANY.prop_map(|value| format!("L DW#16#{value:X}")),
        indirect.prop_map(str::to_owned),
        Just("LC T 1".to_owned()),
        Just("SD T 1".to_owned()),
        Just("S C 1".to_owned()),
    ]
}

proptest! {
    #[test]
    fn any_text_is_read_without_a_panic(text in "\\PC*") {
        compiles_or_not(&text);
    }

    #[test]
    fn any_bytes_are_read_without_a_panic(bytes in proptest::collection::vec(proptest::num::u8::ANY, 0..200)) {
        compiles_or_not(&crate::source::decode(&bytes));
    }

    #[test]
    fn any_words_are_read_without_a_panic(text in words()) {
        compiles_or_not(&text);
    }

    #[test]
    fn any_words_within_a_block_are_read_without_a_panic(text in words()) {
        compiles_or_not(&ob1(&text));
    }

    #[test]
    fn any_statements_run_without_a_panic(statements in proptest::collection::vec(statements(), 0..40), has_ob121 in proptest::bool::ANY) {
        let error = if has_ob121 { "ORGANIZATION_BLOCK OB 121\nBEGIN\nL DB10.DBW 99;\nEND_ORGANIZATION_BLOCK\n" } else { "" };
        let blocks = "FUNCTION FC 1 : VOID\nBEGIN\nL 1; UC FC 2;\nEND_FUNCTION\nFUNCTION FC 2 : VOID\nBEGIN\nOPN DB 10; UC FC 1;\nEND_FUNCTION\n\
            FUNCTION FC 3 : VOID\nVAR_INPUT\na : INT;\nb : ANY;\nEND_VAR\nVAR_IN_OUT\nc : BOOL;\nEND_VAR\nBEGIN\nLAR1 P##b; L D [AR1,P#6.0]; L #a; S #c;\nEND_FUNCTION\n\
            FUNCTION_BLOCK FB 1\nVAR\na : INT;\nEND_VAR\nBEGIN\nL #a; + 1; T #a;\nEND_FUNCTION_BLOCK\nDATA_BLOCK DB 11\nFB 1\nBEGIN\nEND_DATA_BLOCK\n";
        runs(&format!("{error}{blocks}{}", ob1(&format!("x: NOP 0; {};", statements.join("; ")))));
    }
}

#[test]
fn deep_and_large_sources_are_refused() {
    let nested = format!("DATA_BLOCK DB 1\n{}", "STRUCT a : ".repeat(10_000));
    compiles_or_not(&nested);
    let arrays = format!(
        "DATA_BLOCK DB 1\nSTRUCT\na : {} INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n",
        "ARRAY [0 .. 1] OF ".repeat(10_000)
    );
    compiles_or_not(&arrays);
    let chain: String = (1..2000)
        .map(|number| format!("TYPE UDT {number}\nSTRUCT\na : UDT {};\nEND_STRUCT;\nEND_TYPE\n", number + 1))
        .collect();
    compiles_or_not(&chain);
    compiles_or_not(
        "DATA_BLOCK DB 1\nSTRUCT\na : ARRAY [1 .. 9] OF INT := 65536 (1), 65536 (1);\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK",
    );
}
