//! Languages, labels, findings.

use super::{Plc, findings, ob1};
use crate::plc::step7::{BlockKind, BlockName, FindingKind, Language, Settings, Source, compile};

#[test]
fn both_languages_give_the_same_program() {
    let german = "FUNCTION FC 1 : VOID\nBEGIN\nU E 0.0; UN A 0.1; SPB M001; L EW 2; L 5; UW ; T AW 4; SPA ende; M001: L S5T#1S; SE T 1; ZV Z 1; AUF DB 10; TAR; BEA; ende: BE;\nEND_FUNCTION\n";
    let international = "FUNCTION FC 1 : VOID\nBEGIN\nA I 0.0; AN Q 0.1; JC M001; L IW 2; L 5; AW ; T QW 4; JU ende; M001: L S5T#1S; SD T 1; CU C 1; OPN DB 10; CAR; BEU; ende: BE;\nEND_FUNCTION\n";
    let compile = |text: &str| compile(&[Source::statements("a.awl", text)], &Settings::default());
    let (german, international) = (compile(german), compile(international));
    assert_eq!((german.findings.len(), international.findings.len()), (0, 0), "{:#?}", german.findings);
    assert_eq!(german.languages[0].1, Language::German);
    assert_eq!(international.languages[0].1, Language::International);
    assert_eq!(german.program.unwrap().code, international.program.unwrap().code);
}

#[test]
fn capitals_count_in_labels_only() {
    let mut plc = Plc::of_statements("l 1; t mw 2; ju X1; x1: l 2; t MW 2; X1: NOP 0;");
    assert_eq!(plc.scan().word(2), 1);
}

#[test]
fn findings_name_file_line_column_block_and_network() {
    for (statements, wanted) in [
        ("A M 0.8;", "a.awl:13:5: expected a bit from 0 to 7"),
        ("A M 0.0", "a.awl:14:1: expected `;`, found `BEU`"),
        ("AX M 0.0;", "a.awl:13:1: OB1, network 1: there is no operation `AX`"),
        (
            "SPA M001; A M 0.0; AN M 0.0; JU a; a: NOP 0;",
            "OB1, network 1: there is no operation `SPA`\n  the other statements of this file are international",
        ),
        ("JU M001;", "a.awl:13:1: OB1: there is no label `M001`"),
        ("a: NOP 0; a: NOP 0;", "a.awl:13:14: OB1, network 1: the label `a` is there twice"),
        ("abcde: NOP 0;", "expected a label of one to four characters, found `abcde`"),
        ("L #x;", "`x` is not declared in OB1"),
        ("L \"x\";", "the symbol \"x\" is not in the symbol table"),
        ("L M 0.0;", "expected an operand of the width byte or word or double"),
        ("A MW 0;", "expected an operand of the width bit"),
        ("L W#16#12345;", "a.awl:13:3: expected hexadecimal digits of this width"),
        ("L 70000;", "expected a constant of at most 32 bits"),
        ("L DB11.x;", "the variables of DB11 are not known"),
        ("L DB10.w[16];", "is outside of the array"),
        ("SLW 33;", "expected a number from 0 to 32"),
        ("TAK 5;", "expected `;`, found 5"),
        ("OPN MW 0;", "expected a data block, found MW 0"),
        ("L MB [MW 0];", "expected a pointer in m, l, db or di with the width double"),
        ("SP C 1;", "expected a timer or a counter"),
    ] {
        let found = findings(&ob1(statements));
        assert!(found.iter().any(|finding| finding.contains(wanted)), "{statements}: {found:#?}");
    }
}

#[test]
fn nothing_is_half_loaded_and_all_faults_are_listed() {
    let text = format!("{}FUNCTION FC 1 : VOID\nBEGIN\nL 99999;\nEND_FUNCTION\n", ob1("A M 0.9; L 5; AX; L 6; T MW 2"));
    let compiled = compile(&[Source::statements("a.awl", &*text)], &Settings::default());
    assert!(compiled.program.is_none());
    assert_eq!(compiled.findings.len(), 4, "{:#?}", compiled.findings);
}

#[test]
fn missing_blocks_are_listed_once_or_left_out() {
    let text = ob1("CALL FC 110; CALL FC 110; CALL FC 111 ( a := 1 ); L 1; T MW 0;");
    let sources = [Source::statements("a.awl", &*text)];
    let compiled = compile(&sources, &Settings::default());
    let missing: Vec<_> = compiled.findings.iter().map(|finding| (finding.kind, finding.what.as_str())).collect();
    assert_eq!(
        missing,
        [
            (FindingKind::Missing, "FC110 is called and is nowhere"),
            (FindingKind::Missing, "FC111 is called and is nowhere")
        ]
    );
    let settings = Settings { ignores_missing: true, ..Settings::default() };
    let program = compile(&sources, &settings).program.unwrap();
    let name = |number| BlockName { kind: BlockKind::Fc, number };
    assert_eq!(program.left_out(), [name(110), name(111)]);
}

#[test]
fn a_protected_block_without_statements_is_missing() {
    let block = "FUNCTION FC 10 : VOID\nKNOW_HOW_PROTECT\nVAR_INPUT\na : INT;\nEND_VAR\nBEGIN\nEND_FUNCTION\n";
    let text = format!("{block}{}", ob1("CALL FC 10 ( a := 5 ); L 1; T MW 0;"));
    assert!(findings(&text)[0].contains("FC10 is called, is protected, and its source has no statements"));
    let settings = Settings { ignores_missing: true, ..Settings::default() };
    let program = compile(&[Source::statements("a.awl", text)], &settings).program.unwrap();
    let program = std::sync::Arc::new(program);
    let mut memory = super::OwnMemory::new(&program);
    let mut cpu = super::Cpu::new(program, super::CpuOptions::default());
    cpu.scan(&mut memory, 0).unwrap();
    assert_eq!(memory.flags[1], 1);
}

#[test]
fn areas_are_as_large_as_the_program_uses_them() {
    let text = "ORGANIZATION_BLOCK OB 1\nBEGIN\nL ID 10; T QW 20; A M 30.0; A T 4; A C 5; L DB31.DBW 0;\nEND_ORGANIZATION_BLOCK\n";
    let settings = Settings { least: [0, 0, 100, 0, 0], ..Settings::default() };
    let program = compile(&[Source::statements("a.awl", text)], &settings).program.unwrap();
    let sizes = program.sizes();
    assert_eq!((sizes.inputs, sizes.outputs, sizes.flags, sizes.timers, sizes.counters), (14, 22, 100, 5, 6));
    assert_eq!(program.foreign_data_blocks(), [31]);
    assert_eq!(program.statements(), 6);
}

#[test]
fn bytes_of_another_code_page_are_read() {
    let bytes = b"ORGANIZATION_BLOCK OB 1\r\nTITLE =St\xF6rung \xFF\r\nBEGIN\r\nNETWORK\r\n// l\xE4uft\r\n      L     1; // \x80\r\n      T     MW     0;\r\nEND_ORGANIZATION_BLOCK\r\n";
    let mut plc = Plc::new(&crate::source::decode(bytes));
    assert_eq!(plc.scan().word(0), 1);
}
