//! Bit logic, brackets, edges, MCR and jumps.

use proptest::prelude::{Just, Strategy, prop_oneof, proptest};

use super::{CpuOptions, Plc, registers, trial};
use crate::plc::step7::engine::Fault;

/// Runs bit statements with M 0.0 = 0 and M 0.1 = 1 from a status word; returns the status word.
fn status(statements: &str, before: u16) -> u16 {
    let (done, after, _) = trial(&format!("L 2; T MB 0; {statements}"), registers(0, 0, before));
    assert_eq!(done, Ok(()), "{statements}");
    after.status.word()
}

/// RLO 2, STA 4, OR 8, /FC 1.
#[test]
fn bit_operations_set_the_status_bits() {
    for (statements, before, wanted) in [
        // First check: the RLO is the bit.
        ("A M 0.1;", 0b0000, 0b0111),
        ("A M 0.0;", 0b0010, 0b0001),
        ("AN M 0.0;", 0b0000, 0b0011),
        ("AN M 0.1;", 0b0000, 0b0101),
        // In a string.
        ("A M 0.1;", 0b0001, 0b0101),
        ("A M 0.1;", 0b0011, 0b0111),
        // OR and a string: the term before stays.
        ("A M 0.0;", 0b1011, 0b1011),
        ("A M 0.0;", 0b1010, 0b0001),
        ("O M 0.1;", 0b0001, 0b0111),
        ("O M 0.0;", 0b0011, 0b0011),
        ("O M 0.0;", 0b0010, 0b0001),
        ("ON M 0.0;", 0b0001, 0b0011),
        ("X M 0.1;", 0b0011, 0b0101),
        ("X M 0.1;", 0b0010, 0b0111),
        ("XN M 0.1;", 0b0011, 0b0111),
        ("O;", 0b0011, 0b1111),
        ("O;", 0b0001, 0b0100),
        ("O;", 0b0010, 0b0110),
        ("NOT;", 0b0011, 0b0101),
        ("SET;", 0b1001, 0b0110),
        ("CLR;", 0b1111, 0b0000),
        ("= M 1.0;", 0b1011, 0b0110),
        ("S M 1.0;", 0b1001, 0b0000),
        ("S M 1.0;", 0b1011, 0b0110),
        ("R M 0.1;", 0b1011, 0b0010),
        ("A( ;", 0b1011, 0b0110),
        ("SAVE;", 0b0010, 0b1_0000_0010),
        ("FP M 0.0;", 0b1011, 0b0111),
        ("FP M 0.1;", 0b0010, 0b0001),
        ("FN M 0.1;", 0b0000, 0b0111),
        ("FN M 0.1;", 0b0010, 0b0001),
        ("A ==0;", 0b0000, 0b0111),
        ("A <>0;", 0b0_0100_0000, 0b0_0100_0111),
        ("A UO;", 0b0_1100_0000, 0b0_1100_0111),
        ("A >0;", 0b0_1000_0000, 0b0_1000_0111),
        ("A <=0;", 0b0_0100_0000, 0b0_0100_0111),
        ("A BR;", 0b1_0000_0000, 0b1_0000_0111),
        ("AN OV;", 0b0_0010_0000, 0b0_0010_0101),
        ("A OS;", 0b0_0001_0000, 0b0_0001_0111),
    ] {
        let found = status(statements, before);
        assert_eq!(found, wanted, "{statements} from {before:09b}: {found:09b}, not {wanted:09b}");
    }
}

#[test]
fn several_outputs_get_the_same_result_and_the_next_check_is_a_first_one() {
    let mut plc = Plc::of_statements("A M 0.0; A M 0.1; = M 1.0; = M 1.1; S M 1.2; A M 0.1; = M 1.3;");
    plc.set_bit(0, 0, true).set_bit(0, 1, true).scan();
    assert_eq!(plc.memory.flags[1], 0b1111);
    plc.set_bit(0, 0, false).scan();
    assert_eq!(plc.memory.flags[1], 0b1100);
}

#[test]
fn an_edge_needs_a_marker_of_its_own() {
    let mut plc = Plc::of_statements("A M 0.0; FP M 0.1; = M 1.0; A M 0.0; FN M 0.2; = M 1.1;");
    let mut course = Vec::new();
    for input in [false, true, true, false, false, true] {
        plc.set_bit(0, 0, input).scan();
        course.push((plc.bit(1, 0), plc.bit(1, 1)));
    }
    assert_eq!(course, [(false, false), (true, false), (false, false), (false, true), (false, false), (true, false)]);
    // A marker that is used twice in a scan: the second edge never comes.
    let mut plc = Plc::of_statements("A M 0.0; FP M 0.1; = M 1.0; A M 0.0; FP M 0.1; = M 1.1;");
    plc.set_bit(0, 0, true).scan();
    assert_eq!((plc.bit(1, 0), plc.bit(1, 1)), (true, false));
    // A constant 1 fires in the first scan.
    let mut plc = Plc::of_statements("SET; FP M 0.1; = M 1.0;");
    assert!(plc.scan().bit(1, 0) && !plc.scan().bit(1, 0));
}

#[derive(Clone, Debug)]
enum Term {
    Bit(usize),
    Not(Box<Self>),
    And(Box<Self>, Box<Self>),
    Or(Box<Self>, Box<Self>),
    Xor(Box<Self>, Box<Self>),
}

impl Term {
    fn value(&self, bits: u8) -> bool {
        match self {
            Self::Bit(bit) => bits >> bit & 1 == 1,
            Self::Not(a) => !a.value(bits),
            Self::And(a, b) => a.value(bits) && b.value(bits),
            Self::Or(a, b) => a.value(bits) || b.value(bits),
            Self::Xor(a, b) => a.value(bits) != b.value(bits),
        }
    }

    fn depth(&self) -> usize {
        match self {
            Self::Bit(_) => 0,
            Self::Not(a) => a.depth() + 1,
            Self::And(a, b) | Self::Or(a, b) | Self::Xor(a, b) => a.depth().max(b.depth()) + 1,
        }
    }

    fn text(&self) -> String {
        match self {
            Self::Bit(bit) => format!("A M 0.{bit};"),
            Self::Not(a) => format!("AN( ; {} ) ;", a.text()),
            Self::And(a, b) => format!("A( ; {} ) ; A( ; {} ) ;", a.text(), b.text()),
            Self::Or(a, b) => format!("O( ; {} ) ; O( ; {} ) ;", a.text(), b.text()),
            Self::Xor(a, b) => format!("X( ; {} ) ; X( ; {} ) ;", a.text(), b.text()),
        }
    }
}

fn terms() -> impl Strategy<Value = Term> {
    let leaf = (0..8_usize).prop_map(Term::Bit);
    leaf.prop_recursive(5, 40, 2, |inner| {
        let pair = (inner.clone(), inner.clone());
        prop_oneof![
            inner.prop_map(|a| Term::Not(Box::new(a))),
            pair.clone().prop_map(|(a, b)| Term::And(Box::new(a), Box::new(b))),
            pair.clone().prop_map(|(a, b)| Term::Or(Box::new(a), Box::new(b))),
            pair.prop_map(|(a, b)| Term::Xor(Box::new(a), Box::new(b))),
        ]
    })
}

proptest! {
    /// Brackets and first checks are what the logic says.
    #[test]
    fn brackets_compute_the_term(term in terms(), bits in 0_u8..=255) {
        if term.depth() <= 7 {
            let mut plc = Plc::of_statements(&format!("{} = M 1.0;", term.text()));
            plc.memory.flags[0] = bits;
            assert_eq!(plc.scan().bit(1, 0), term.value(bits), "{}", term.text());
        }
    }

    /// AND before OR: terms of A and AN, with `O` between them.
    #[test]
    fn and_comes_before_or(
        terms in proptest::collection::vec(proptest::collection::vec((0..8_u8, prop_oneof![Just(true), Just(false)]), 1..4), 1..5),
        bits in 0_u8..=255,
    ) {
        let text: Vec<String> = terms
            .iter()
            .map(|term| term.iter().map(|(bit, positive)| format!("A{} M 0.{bit};", if *positive { "" } else { "N" })).collect())
            .collect();
        let wanted = terms.iter().any(|term| term.iter().all(|(bit, positive)| (bits >> bit & 1 == 1) == *positive));
        let mut plc = Plc::of_statements(&format!("{} = M 1.0;", text.join(" O; ")));
        plc.memory.flags[0] = bits;
        assert_eq!(plc.scan().bit(1, 0), wanted);
    }
}

#[test]
fn seven_brackets_are_allowed_and_eight_stop_the_plc() {
    let brackets = |count: usize| format!("{} A M 0.0; {} = M 1.0;", "A( ;".repeat(count), ") ;".repeat(count));
    let mut plc = Plc::of_statements(&brackets(7));
    assert!(plc.set_bit(0, 0, true).scan().bit(1, 0));
    assert_eq!(Plc::of_statements(&brackets(8)).fault(), Fault::Nesting);
    assert_eq!(Plc::of_statements(") ;").fault(), Fault::Nesting);
}

#[test]
fn jumps_depend_on_the_status() {
    // The nine bits of the status word; whether each jump is taken, and the status after it.
    const ZERO: u16 = 0;
    const POSITIVE: u16 = 1 << 7;
    const NEGATIVE: u16 = 1 << 6;
    const UNORDERED: u16 = POSITIVE | NEGATIVE;
    for (jump, before, is_taken, after) in [
        ("JU", 0b1011, true, 0b1011),
        ("JC", 0b1011, true, 0b0110),
        ("JC", 0b1001, false, 0b0110),
        ("JCN", 0b1001, true, 0b0110),
        ("JCN", 0b0010, false, 0b0110),
        ("JCB", 0b0011, true, 0b1_0000_0110),
        ("JCB", 0b1_0000_0001, false, 0b0110),
        ("JNB", 0b1_0000_0001, true, 0b0110),
        ("JNB", 0b0011, false, 0b1_0000_0110),
        ("JBI", 0b1_0000_1001, true, 0b1_0000_0100),
        ("JBI", 0b0011, false, 0b0110),
        ("JNBI", 0b0011, true, 0b0110),
        ("JO", 1 << 5, true, 1 << 5),
        ("JO", 0, false, 0),
        ("JOS", 1 << 4, true, 0),
        ("JOS", 0, false, 0),
        ("JZ", ZERO, true, ZERO),
        ("JZ", NEGATIVE, false, NEGATIVE),
        ("JN", POSITIVE, true, POSITIVE),
        ("JN", NEGATIVE, true, NEGATIVE),
        ("JN", UNORDERED, false, UNORDERED),
        ("JP", POSITIVE, true, POSITIVE),
        ("JP", ZERO, false, ZERO),
        ("JM", NEGATIVE, true, NEGATIVE),
        ("JM", UNORDERED, false, UNORDERED),
        ("JPZ", ZERO, true, ZERO),
        ("JPZ", POSITIVE, true, POSITIVE),
        ("JPZ", NEGATIVE, false, NEGATIVE),
        ("JMZ", ZERO, true, ZERO),
        ("JMZ", NEGATIVE, true, NEGATIVE),
        ("JMZ", POSITIVE, false, POSITIVE),
        ("JUO", UNORDERED, true, UNORDERED),
        ("JUO", ZERO, false, ZERO),
    ] {
        let (_, found, _) = trial(&format!("{jump} M001; L 1; BEU; M001: L 2;"), registers(0, 0, before));
        assert_eq!(found.accu[0], if is_taken { 2 } else { 1 }, "{jump} from {before:09b}");
        assert_eq!(found.status.word(), after, "{jump} from {before:09b}: {:09b}", found.status.word());
    }
}

#[test]
fn the_jump_list_and_the_loop() {
    for (accu1, wanted) in [(0, 10), (1, 11), (2, 12), (3, 99), (0x1_0001, 11), (255, 99)] {
        let text = "JL else; JU a; JU b; JU c; else: L 99; BEU; a: L 10; BEU; b: L 11; BEU; c: L 12;";
        assert_eq!(trial(text, registers(0, accu1, 0)).1.accu[0], wanted, "{accu1}");
    }
    // 1 + 2 + 3 + 4 + 5 = 15.
    let mut plc = Plc::of_statements("L 0; T MW 2; L 5; next: T MW 4; L MW 2; +I; T MW 2; L MW 4; LOOP next;");
    assert_eq!(plc.scan().word(2), 15);
    assert_eq!(trial("LOOP a; a: NOP 0;", registers(0, 0xABCD_0000, 0)).1.accu[0], 0xABCD_FFFF);
}

#[test]
fn a_zone_that_is_off_writes_zeros() {
    let text = "MCRA; A M 0.0; MCR( ; A M 0.1; MCR( ; SET; = M 1.0; S M 1.1; R M 1.2; L 7; T MB 2; )MCR; SET; = M 1.3; )MCR; \
                SET; = M 1.4; MCRD; = M 1.5;";
    let mut plc = Plc::of_statements(text);
    for (outer, inner, wanted, byte) in [
        (true, true, 0b0011_1011, 7),
        (true, false, 0b0011_1110, 0),
        (false, true, 0b0011_0110, 0),
        (false, false, 0b0011_0110, 0),
    ] {
        plc.memory.flags[1] = 0b110;
        plc.memory.flags[2] = 0xFF;
        plc.set_bit(0, 0, outer).set_bit(0, 1, inner).scan();
        assert_eq!(plc.memory.flags[1], wanted, "{outer} {inner}: {:08b}", plc.memory.flags[1]);
        assert_eq!(plc.memory.flags[2], byte);
    }
    assert_eq!(Plc::of_statements(&"MCR( ;".repeat(9)).fault(), Fault::McrNesting);
    assert_eq!(Plc::of_statements(")MCR;").fault(), Fault::McrNesting);
}

#[test]
fn a_called_block_starts_without_the_zone_of_its_caller() {
    let text = "FUNCTION FC 1 : VOID\nBEGIN\nSET; = M 1.0;\nEND_FUNCTION\n\
                ORGANIZATION_BLOCK OB 1\nBEGIN\nMCRA; CLR; MCR( ; UC FC 1; SET; = M 1.1; )MCR; MCRD;\nEND_ORGANIZATION_BLOCK\n";
    let mut plc = Plc::new(text);
    plc.memory.flags[1] = 2;
    plc.scan();
    assert_eq!(plc.memory.flags[1], 1);
}

#[test]
fn an_endless_loop_hits_the_cycle_monitoring() {
    let mut plc = Plc::of_statements("a: JU a;");
    assert_eq!(plc.fault(), Fault::CycleTime);
    assert_eq!(plc.cpu.stopped().unwrap().line, 13);
}

/// OB80 in the first overrun of a scan, STOP in the second.
#[test]
fn ob80_runs_once_in_a_scan_that_does_not_end() {
    let text = |loops: &str| {
        format!(
            "ORGANIZATION_BLOCK OB 80\nVAR_TEMP\nclass : BYTE; fault : BYTE; i : ARRAY [0 .. 17] OF BYTE;\nEND_VAR\nBEGIN\n\
             L MW 10; + 1; T MW 10; L #class; T MB 12; L #fault; T MB 13; SET; S M 0.0;\nEND_ORGANIZATION_BLOCK\n\
             ORGANIZATION_BLOCK OB 1\nBEGIN\nL 7; a: {loops}; T MW 14;\nEND_ORGANIZATION_BLOCK\n"
        )
    };
    let options = CpuOptions { instructions_per_scan: 1000, ..CpuOptions::default() };
    // The block ends the loop: the statement that was interrupted goes on, with the registers as they were.
    let mut plc = Plc::with(&text("A M 0.0; JCN a"), options);
    plc.scan();
    assert_eq!((plc.word(10), plc.word(12), plc.word(14)), (1, 0x3501, 7));
    let mut plc = Plc::with(&text("JU a"), options);
    assert_eq!(plc.fault(), Fault::CycleTime);
    assert_eq!(plc.word(10), 1);
}
