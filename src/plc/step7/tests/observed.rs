//! What an observed CPU remembers: the operands that made a result, and what ran.

use std::sync::Arc;

use proptest::prelude::{Just, Strategy, prop_assert, prop_assert_eq, prop_oneof, proptest};

use super::{Plc, SECOND, ob1};
use crate::plc::step7::Coverage;
use crate::plc::step7::engine::{Area, Cpu, CpuOptions, Named, OwnMemory, text_of};

const fn i(bit: u32) -> Named {
    Named::Area(Area::Inputs, bit)
}

const fn m(byte: u32, bit: u32) -> Named {
    Named::Area(Area::Flags, byte * 8 + bit)
}

const fn q(bit: u32) -> Named {
    Named::Area(Area::Outputs, bit)
}

/// A CPU that is observed, with inputs.
fn plc(statements: &str, inputs: u8) -> Plc {
    let mut plc = Plc::of_statements(statements);
    plc.cpu.observe();
    plc.memory.inputs[0] = inputs;
    plc
}

/// The changes of the next scan: place, and the operands that made it.
fn seen(plc: &mut Plc) -> Vec<(Named, Vec<(Named, bool)>)> {
    plc.cpu.observed.as_mut().unwrap().begin_cycle();
    plc.after(SECOND);
    let seen = &plc.cpu.observed.as_ref().unwrap().seen;
    seen.iter()
        .map(|seen| (seen.place, seen.tested.iter().map(|read| (read.named, read.value != 0)).collect()))
        .collect()
}

/// A word, its new value, and the operands of which it was made, with their values.
type Word = (Named, u32, Vec<(Named, u32)>);

/// The words that the next scan changes, with their new values, and the operands of which they were made, with their values.
fn words(plc: &mut Plc) -> Vec<Word> {
    plc.cpu.observed.as_mut().unwrap().begin_cycle();
    plc.after(SECOND);
    let seen = plc.cpu.observed.as_ref().unwrap().seen.iter().filter(|seen| seen.bits > 1);
    seen.map(|seen| (seen.place, seen.value, seen.tested.iter().map(|read| (read.named, read.value)).collect()))
        .collect()
}

/// A network, the inputs I 0.0 to I 0.7, and the operands that decide with their values.
type Case<'a> = (&'a str, u8, &'a [(Named, bool)]);

#[test]
fn the_decisive_operands_are_named() {
    let cases: [Case<'_>; 18] = [
        ("A I 0.0; AN I 0.1; = Q 0.0;", 0b001, &[(i(0), true), (i(1), false)]),
        ("O I 0.0; O I 0.1; = Q 0.0;", 0b010, &[(i(1), true)]),
        ("A I 0.0; A I 0.1; O; A I 0.2; = Q 0.0;", 0b110, &[(i(2), true)]),
        ("A( ; O I 0.0; O I 0.1; ) ; A I 0.2; = Q 0.0;", 0b110, &[(i(1), true), (i(2), true)]),
        ("X I 0.0; X I 0.1; = Q 0.0;", 0b010, &[(i(0), false), (i(1), true)]),
        ("A I 0.0; NOT; = Q 0.0;", 0, &[(i(0), false)]),
        // An edge: what is before it.
        ("A I 0.0; FP M 20.0; = Q 0.0;", 1, &[(i(0), true)]),
        // A comparison names what it compared, and the contact beside it.
        ("L MW 30; L 5; <I; A I 0.0; = Q 0.0;", 1, &[(m(30, 0), false), (i(0), true)]),
        // A status bit names what its operation calculated with.
        ("L MW 30; L 5; -I; A <0; A I 0.0; = Q 0.0;", 1, &[(m(30, 0), false), (i(0), true)]),
        ("L MW 30; L 5; -I; T MW 32; AN OV; A I 0.0; = Q 0.0;", 1, &[(m(30, 0), false), (i(0), true)]),
        ("L MW 30; SLW 1; A ==0; = Q 0.0;", 0, &[(m(30, 0), false)]),
        // BR names what was saved.
        ("A I 0.1; SAVE; A BR; A I 0.0; = Q 0.0;", 0b11, &[(i(1), true), (i(0), true)]),
        // Operations on accumulators do not end a logic string.
        ("A I 0.0; L MW 30; T MW 32; A I 0.1; = Q 0.0;", 0b11, &[(i(0), true), (i(1), true)]),
        // Without an edge: the logic, or the marker where the logic is as it must be.
        ("SET; = M 20.0; A I 0.0; FP M 20.0; NOT; = Q 0.0;", 1, &[(m(20, 0), true), (i(0), true)]),
        ("A I 0.0; FP M 20.0; NOT; = Q 0.0;", 0, &[(i(0), false)]),
        // More contacts than operands of a value.
        (
            "A I 0.0; A I 0.1; A I 0.2; A I 0.3; A I 0.4; A I 0.5; A I 0.6; A I 0.7; AN M 1.0; AN M 1.1; = Q 0.0;",
            0xFF,
            &[
                (i(0), true),
                (i(1), true),
                (i(2), true),
                (i(3), true),
                (i(4), true),
                (i(5), true),
                (i(6), true),
                (i(7), true),
                (m(1, 0), false),
                (m(1, 1), false),
            ],
        ),
        // The value is that of the test, also where the bit was written since.
        ("O I 0.0; O M 1.0; = M 1.0; = Q 0.0;", 1, &[(i(0), true)]),
        // LAD branches through a local bit.
        (
            "A I 0.0; AN I 0.1; = L 40.0; A L 40.0; BLD 102; A I 0.2; = Q 0.0;",
            0b101,
            &[(i(0), true), (i(1), false), (i(2), true)],
        ),
    ];
    for (statements, inputs, wanted) in cases {
        let all = seen(&mut plc(statements, inputs));
        let (_, tested) = all.iter().find(|(place, _)| *place == q(0)).unwrap_or_else(|| panic!("{statements}"));
        assert_eq!(tested, wanted, "{statements}");
    }
}

/// Behind SET the jump that was not taken is the reason.
#[test]
fn the_jump_before_set_is_named() {
    let mut plc = plc("A I 0.0; AN I 0.1; FP M 20.0; JCN a; SET; S M 1.0; R M 1.1; a: NOP 0;", 1);
    plc.memory.flags[1] = 2;
    let reasons = vec![(i(0), true), (i(1), false)];
    assert_eq!(seen(&mut plc), [(m(20, 0), vec![]), (m(1, 0), reasons.clone()), (m(1, 1), reasons)][1..]);
}

/// A network, the word that it makes, and the operands.
type WordCase<'a> = (&'a str, u32, &'a [(Named, u32)]);

/// MW 30 is 3 and MW 32 is 4.
#[test]
fn a_word_names_the_operands_of_which_it_is_made() {
    let mw = |byte| m(byte, 0);
    let (a, b) = ((mw(30), 3), (mw(32), 4));
    let cases: [WordCase<'_>; 14] = [
        ("L MW 30; T MW 40;", 3, &[a]),
        ("L MW 30; L MW 32; +I; T MW 40;", 7, &[b, a]),
        ("L MW 30; L 5; *I; T MW 40;", 15, &[a]),
        ("L MW 30; L MW 32; TAK; -I; T MW 40;", 1, &[a, b]),
        ("L MW 30; SLW 4; T MW 40;", 0x30, &[a]),
        ("L MW 30; L MW 32; T MW 40;", 4, &[b]),
        ("L MW 30; L MW 32; OW; T MW 40;", 7, &[b, a]),
        // Through local data, and through a byte of it, of which the origin is not known.
        ("L MW 30; T LW 40; L 9; L LW 40; T MW 40;", 3, &[a]),
        ("L MW 30; T LW 40; L LB 41; T MW 40;", 3, &[]),
        ("L MW 30; T LW 40; SET; = L 40.0; L LW 40; T MW 40;", 0x103, &[]),
        ("LAR1 P#30.0; L MW [AR1,P#2.0]; T MW 40;", 4, &[b]),
        // What is made of the status word is not known.
        ("L MW 30; L STW; +I; T MW 40;", 3, &[]),
        ("A I 0.0; AN I 0.1; JCN a; L 5; T MW 40; a: NOP 0;", 5, &[(i(0), 1), (i(1), 0)]),
        ("L PIB 0; T MW 40;", 1, &[(i(0), 1)]),
    ];
    for (statements, value, wanted) in cases {
        let mut plc = plc(statements, 1);
        plc.memory.flags[31] = 3;
        plc.memory.flags[33] = 4;
        let all = words(&mut plc);
        let found = all.iter().find(|(place, ..)| *place == mw(40)).unwrap_or_else(|| panic!("{statements}"));
        assert_eq!((found.1, found.2.as_slice()), (value, wanted), "{statements}");
        // The same value is no change.
        assert_eq!(words(&mut plc), [], "{statements}");
    }
}

/// The value of a timer and of a counter as they were loaded: 2 s of the base 10 ms are 200.
#[test]
fn values_of_timers_and_counters_are_named() {
    let mut plc = plc("A I 0.0; L S5T#2S; SE T 5; CU C 3; L T 5; T MW 40; L C 3; T MW 42;", 1);
    let found = words(&mut plc);
    let timer = (m(40, 0), 200, vec![(Named::Timer(5), 200)]);
    assert!(found.contains(&timer), "{found:?}");
    assert!(found.contains(&(m(42, 0), 1, vec![(Named::Counter(3), 1)])), "{found:?}");
}

/// Through an FC with an operand in a data block, and through an instance.
#[test]
fn words_are_followed_through_parameters() {
    let text = "DATA_BLOCK DB 10\nSTRUCT\na : INT := 7;\nb : INT;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
        FUNCTION FC 1 : VOID\nVAR_INPUT\nx : INT;\nEND_VAR\nVAR_OUTPUT\ny : INT;\nEND_VAR\nBEGIN\nL #x; L 2; *I; T #y;\nEND_FUNCTION\n\
        FUNCTION_BLOCK FB 1\nVAR_INPUT\nx : INT;\nEND_VAR\nVAR_OUTPUT\ny : INT;\nEND_VAR\nBEGIN\nL #x; T #y;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FC 1 ( x := DB10.a, y := DB10.b ); CALL FB 1 , DB 20 ( x := DB10.b, y := MW 40 );\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.cpu.observe();
    let db = |number, byte: u32| Named::Block(number, byte * 8);
    assert_eq!(
        words(&mut plc),
        [
            (db(10, 2), 14, vec![(db(10, 0), 7)]),
            (db(20, 0), 14, vec![(db(10, 2), 14)]),
            (db(20, 2), 14, vec![(db(20, 0), 14)]),
            (m(40, 0), 14, vec![(db(20, 2), 14)]),
        ]
    );
}

/// A jump into the middle: the contact before the label was not tested. What the RLO was before the jump counts, unless the string begins there.
#[test]
fn a_string_that_was_entered_in_its_middle_names_what_ran() {
    let mut first = plc("SET; JU a; A I 0.0; a: A I 0.1; = Q 0.0;", 0b10);
    assert_eq!(seen(&mut first), [(q(0), vec![(i(1), true)])]);
    let mut second = plc("A I 0.2; JU a; A I 0.0; a: A I 0.1; = Q 0.0;", 0b110);
    assert_eq!(seen(&mut second), [(q(0), vec![])]);
    let jump = "A I 0.1; JC b; A I 0.0; JCN a; b: L 5; T MW 40; a: NOP 0;";
    let mut third = plc(jump, 0b10);
    assert_eq!(words(&mut third), [(m(40, 0), 5, vec![])]);
}

/// OB121 has its own accumulators; after it those of OB1 are what they were.
#[test]
fn an_error_block_leaves_the_origins() {
    let ob121 = "ORGANIZATION_BLOCK OB 121\nBEGIN\nL MW 50; T MW 52;\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(&format!("{ob121}{}", ob1("L MW 30; OPN DB 99; T MW 40;")));
    plc.cpu.observe();
    plc.memory.flags[31] = 3;
    plc.memory.flags[51] = 8;
    assert_eq!(words(&mut plc), [(m(52, 0), 8, vec![(m(50, 0), 8)]), (m(40, 0), 3, vec![(m(30, 0), 3)])]);
}

#[test]
fn the_contact_that_opened_is_named() {
    let mut plc = plc("A I 0.0; A I 0.1; A I 0.2; = Q 0.0;", 0b111);
    plc.scan();
    plc.memory.inputs[0] = 0b101;
    assert_eq!(seen(&mut plc), [(q(0), vec![(i(1), false)])]);
    plc.memory.inputs[0] = 0b001;
    assert_eq!(seen(&mut plc), [], "nothing changed");
}

/// An operand without a name that decides is named by its operation: OS, a status word that was loaded, a local bit behind S.
#[test]
fn an_operation_whose_operand_is_unknown_is_named() {
    for (statements, text, value) in [
        ("AN OS; A I 0.0; = Q 0.0;", "AN OS", false),
        ("L STW; L 5; <I; A I 0.0; = Q 0.0;", "<I", true),
        ("A I 0.0; S L 40.0; A L 40.0; A I 0.0; = Q 0.0;", "A L 40.0", true),
    ] {
        let mut plc = plc(statements, 1);
        let all = seen(&mut plc);
        let (_, tested) = all.iter().find(|(place, _)| *place == q(0)).unwrap();
        let [(Named::Operation(pc), found), (input, true)] = tested[..] else { panic!("{statements}: {tested:?}") };
        let op = plc.cpu.program.code[pc as usize];
        assert_eq!((text_of(op).as_deref(), found, input), (Some(text), value, i(0)), "{statements}");
    }
}

/// A bit of a data block is copied for an FC, and tested there.
#[test]
fn bits_are_followed_through_parameters_of_functions() {
    let text = "DATA_BLOCK DB 10\nSTRUCT\na : BOOL := TRUE;\nb : BOOL;\nEND_STRUCT;\nBEGIN\nEND_DATA_BLOCK\n\
        FUNCTION FC 1 : VOID\nVAR_INPUT\nx : BOOL;\nEND_VAR\nVAR_OUTPUT\ny : BOOL;\nEND_VAR\nBEGIN\nA #x; A I 0.0; = #y;\nEND_FUNCTION\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FC 1 ( x := DB10.a, y := Q 0.0 );\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.cpu.observe();
    plc.memory.inputs[0] = 1;
    assert_eq!(seen(&mut plc), [(q(0), vec![(Named::Block(10, 0), true), (i(0), true)])]);
}

/// The same comparison runs twice in a scan: what it compared the first time is no reason the second time.
#[test]
fn a_statement_that_runs_again_forgets_what_it_compared() {
    let text = "FUNCTION FC 1 : VOID\nBEGIN\nL 5; >I; = Q 0.0;\nEND_FUNCTION\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nL MW 30; UC FC 1; L STW; UC FC 1;\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.cpu.observe();
    // 3 is not above 5; the status word is CC0 then, 64.
    plc.memory.flags[31] = 3;
    let all = seen(&mut plc);
    let [(place, tested)] = &all[..] else { panic!("{all:?}") };
    assert_eq!(*place, q(0));
    assert!(matches!(tested[..], [(Named::Operation(_), true)]), "{tested:?}");
}

/// In a zone of the MCR that is off, 0 is written whatever the logic says.
#[test]
fn the_logic_is_no_reason_in_a_zone_of_the_mcr_that_is_off() {
    let mut plc = plc("MCRA; CLR; MCR( ; A I 0.0; = Q 0.0; )MCR; MCRD;", 1);
    plc.memory.outputs[0] = 1;
    assert_eq!(seen(&mut plc), [(q(0), vec![])]);
}

/// BLKMOV, FILL, and a function of a library: what they read.
#[test]
fn built_in_blocks_name_what_they_read() {
    let mut plc = plc(
        "CALL SFC 20 ( SRCBLK := P#M 30.0 BYTE 4, RET_VAL := MW 0, DSTBLK := P#DB10.DBX 0.0 BYTE 4 );\
         CALL SFC 21 ( BVAL := MB 31, RET_VAL := MW 0, BLK := P#M 40.0 BYTE 2 );\
         CALL SFC 24 ( DB_NUMBER := MW 30, RET_VAL := MW 0, DB_LENGTH := MW 50, WRITE_PROT := M 2.0 );",
        0,
    );
    plc.memory.flags[31] = 10;
    let mw = |byte| m(byte, 0);
    let db = |byte: u32| Named::Block(10, byte * 8);
    // FILL repeats a byte, so a word of its target has no word of its source.
    assert_eq!(
        words(&mut plc),
        [(db(0), 10, vec![(mw(30), 10)]), (mw(40), 0x0A0A, vec![]), (mw(50), 32, vec![(mw(30), 10)]),]
    );
}

#[test]
fn a_timer_is_named_and_its_start_too() {
    let mut plc = plc("A I 0.0; L S5T#2S; SD T 5; A T 5; = Q 0.0;", 1);
    assert_eq!(seen(&mut plc), [(Named::Timer(5), vec![(i(0), true)])]);
    assert_eq!(seen(&mut plc), []);
    assert_eq!(seen(&mut plc), [(q(0), vec![(Named::Timer(5), true)])]);
    plc.memory.inputs[0] = 0;
    assert_eq!(seen(&mut plc), [(Named::Timer(5), vec![(i(0), false)]), (q(0), vec![(Named::Timer(5), false)])]);
}

#[test]
fn a_counter_is_named_and_what_counted() {
    let mut plc = plc("A I 0.0; CU C 3; A C 3; = Q 0.0;", 1);
    assert_eq!(seen(&mut plc), [(Named::Counter(3), vec![(i(0), true)]), (q(0), vec![(Named::Counter(3), true)])]);
}

/// Through an instance: the parameter is copied, tested there, and its result copied out.
#[test]
fn parameters_lead_to_their_operands() {
    let text = "FUNCTION_BLOCK FB 1\nVAR_INPUT\ngo : BOOL;\nEND_VAR\nVAR_OUTPUT\non : BOOL;\nEND_VAR\nBEGIN\nA #go; = #on;\nEND_FUNCTION_BLOCK\n\
        DATA_BLOCK DB 20\nFB 1\nBEGIN\nEND_DATA_BLOCK\n\
        FUNCTION FC 1 : VOID\nVAR_INPUT\ngo : BOOL;\nEND_VAR\nVAR_OUTPUT\non : BOOL;\nEND_VAR\nBEGIN\nA #go; = #on;\nEND_FUNCTION\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nCALL FB 1 , DB 20 ( go := I 0.0, on := Q 0.0 ); CALL FC 1 ( go := I 0.1, on := Q 0.1 );\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.cpu.observe();
    plc.memory.inputs[0] = 3;
    let (go, on) = (Named::Block(20, 0), Named::Block(20, 16));
    assert_eq!(
        seen(&mut plc),
        [(go, vec![(i(0), true)]), (on, vec![(go, true)]), (q(0), vec![(on, true)]), (q(1), vec![(i(1), true)]),]
    );
}

/// The DB register is another one when the output is written.
#[test]
fn operands_in_data_blocks_keep_their_block() {
    let text = "DATA_BLOCK DB 10\nSTRUCT\na : BOOL;\nEND_STRUCT;\nBEGIN\na := TRUE;\nEND_DATA_BLOCK\n\
        DATA_BLOCK DB 11\nSTRUCT\na : BOOL;\nEND_STRUCT;\nBEGIN\na := TRUE;\nEND_DATA_BLOCK\n\
        ORGANIZATION_BLOCK OB 1\nBEGIN\nA DB10.DBX 0.0; A DBX 0.0; A DB11.DBX 0.0; = Q 0.0;\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.cpu.observe();
    let block = |number| (Named::Block(number, 0), true);
    assert_eq!(seen(&mut plc), [(q(0), vec![block(10), block(11)])]);
}

#[test]
fn observing_changes_no_result() {
    let statements = "A I 0.0; FP M 1.0; = M 1.1; A M 1.1; JCN a; L MW 4; + 1; T MW 4; a: A I 0.1; L S5T#1S; SE T 1; A T 1; = Q 0.0;";
    let (mut one, mut other) = (Plc::of_statements(statements), plc(statements, 0));
    for inputs in [0, 1, 3, 2, 1, 0, 3] {
        for plc in [&mut one, &mut other] {
            plc.memory.inputs[0] = inputs;
            plc.after(SECOND / 3);
        }
        assert_eq!((&one.memory, one.cpu.state()), (&other.memory, other.cpu.state()));
    }
}

#[test]
fn coverage_counts_statements_networks_branches_and_contacts() {
    let text = ob1(
        "A I 0.0;\n= M 1.0;\nAN I 0.0;\nJC a;\nA I 0.1; // never\n= M 1.1;\na: NOP 0;\nNETWORK\nA M 1.0;\n= M 1.2;\nBEU;\nNETWORK\nA I 0.2;\n= M 1.3;",
    );
    let program = super::program(&text);
    let mut observed = Cpu::new(Arc::clone(&program), CpuOptions::default());
    let mut memory = OwnMemory::new(&program);
    observed.observe();
    let mut coverage = |inputs: u8| {
        memory.inputs[0] = inputs;
        observed.scan(&mut memory, 0).unwrap();
        let files = vec![("a.awl".to_owned(), String::new())];
        Coverage::of("p/a", &program, observed.observed.as_ref().unwrap(), files)
    };
    // Without I 0.0 the jump is taken: statements 5 and 6 do not run, nor the network after BEU, nor what `ob1` adds.
    let first = coverage(0);
    let counts = first.counts();
    assert_eq!((counts.statements, counts.networks), ([8, 18], [2, 3]));
    assert_eq!((counts.branches, counts.contacts), ([1, 2], [0, 5]));
    assert_eq!(
        first.unchanged().map(|one| (one.line, one.contact.unwrap()[1])).collect::<Vec<_>>(),
        [(13, false), (15, false), (21, false)]
    );
    // With I 0.0: contacts 1, 3 and the one of network 2 have changed.
    let counts = coverage(1).counts();
    assert_eq!((counts.statements, counts.branches, counts.contacts), ([10, 18], [2, 2], [3, 5]));
    assert!(coverage(1).summary().starts_with(
        "p/a: 10 of 18 statements (55 %), 2 of 3 networks (66 %), 2 of 2 branches (100 %), 3 of 5 contacts"
    ));
}

/// `O` keeps AN M 0.3 = 0, `NOT` inverts the RLO, and the bracket is 0: Q 0.0 would be 1 with M 0.3 = 0, so M 0.0 did not decide alone.
#[test]
fn behind_or_and_not_nothing_is_named_alone() {
    let mut plc = Plc::of_statements("AN M 0.3; O; NOT; A( ; A M 0.0; ) ; = Q 0.0;");
    plc.cpu.observe();
    plc.memory.flags[0] = 0b1000;
    plc.memory.outputs[0] = 1;
    assert_eq!(seen(&mut plc), [(q(0), vec![])]);
    plc.memory.flags[0] = 0;
    plc.scan();
    assert_eq!(plc.memory.outputs[0] & 1, 1);
}

/// Bit statements on M 0.0 to M 0.5.
fn chain() -> impl Strategy<Value = String> {
    let operand = (prop_oneof![Just("A"), Just("AN"), Just("O"), Just("ON"), Just("X"), Just("XN")], 0..6_u8)
        .prop_map(|(operation, bit)| format!("{operation} M 0.{bit};"));
    let part = prop_oneof![
        6 => operand.clone(),
        1 => Just("O;".to_owned()),
        1 => Just("NOT;".to_owned()),
        2 => (prop_oneof![Just("A("), Just("AN("), Just("O("), Just("X("), Just("XN(")], proptest::collection::vec(operand.clone(), 1..4))
            .prop_map(|(open, inner)| format!("{open} ; {} ) ;", inner.join(" "))),
    ];
    (operand, proptest::collection::vec(part, 0..8)).prop_map(|(first, rest)| format!("{first} {}", rest.join(" ")))
}

proptest! {
    /// With the named operands as they were, the result is the same whatever the others are.
    #[test]
    fn the_named_operands_decide_alone(chain in chain(), flags in 0..64_u8, others in 0..64_u8) {
        let mut plc = Plc::of_statements(&format!("{chain} = Q 0.0;"));
        plc.cpu.observe();
        plc.memory.flags[0] = flags;
        plc.scan();
        let result = plc.memory.outputs[0] & 1;
        // The other way round, so that the next scan changes the output.
        plc.memory.outputs[0] = 1 - result;
        let all = seen(&mut plc);
        prop_assert_eq!(all.len(), 1, "{}", chain);
        let tested = &all[0].1;
        let mut kept = 0;
        for (named, value) in tested {
            let Named::Area(Area::Flags, bit) = named else { panic!("{named:?}") };
            prop_assert_eq!(*value, flags >> bit & 1 == 1, "{}", &chain);
            kept |= 1 << bit;
        }
        plc.memory.flags[0] = flags & kept | others & !kept;
        plc.scan();
        prop_assert!(tested.is_empty() || plc.memory.outputs[0] & 1 == result, "{}", chain);
    }
}
