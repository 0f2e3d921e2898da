//! Small programs against the rules of the operations: status word, accumulators, brackets, master control relay, addresses, jumps, calls. Expected
//! values are worked out by hand; the bits of the status word are BR 100h, CC1 80h, CC0 40h, OV 20h, OS 10h, RLO 2h.

use super::{Plc, ob1};

/// Statements, and the words that they leave in MW 100 and in MW 104. M 1.0 is 1, M 1.1 is 0.
type Case<'a> = (&'a str, u16, u16);

fn check(cases: &[Case<'_>]) {
    for (statements, word, status) in cases {
        let mut plc = Plc::of_statements(statements);
        plc.memory.flags[1] = 1;
        plc.scan();
        assert_eq!(
            (plc.word(100), plc.word(104)),
            (*word, *status),
            "{statements}: {:04X} {:04X}",
            plc.word(100),
            plc.word(104)
        );
    }
}

/// The result in MW 100 and the status word in MW 104.
#[test]
fn results_and_status_words() {
    let cases: Vec<(&str, u16, u16)> = vec![
        ("L 3; L 5; -I;", 0xFFFE, 0x40),
        // 60000 is −5536; −60000 is 5536.
        ("L 30000; L 30000; +I;", 0xEA60, 0x70),
        ("L -30000; L 30000; -I;", 0x15A0, 0xB0),
        // 90000 is 15F90h.
        ("L 300; L 300; *I;", 0x5F90, 0xB0),
        ("L -4; L 5; *I;", 0xFFEC, 0x40),
        ("L 7; L -2; /I;", 0xFFFD, 0x40),
        ("L -32768; L -1; /I;", 0x8000, 0xB0),
        ("L L#7; L L#-2; MOD;", 1, 0x80),
        ("L L#-7; L L#2; MOD;", 0xFFFF, 0x40),
        ("L L#2147483647; L L#1; +D;", 0, 0x70),
        ("L 5; + -7;", 0xFFFE, 0),
        ("L W#16#8000; NEGI;", 0x8000, 0x70),
        ("L W#16#FF; INVI;", 0xFF00, 0),
        ("L -2.5; ABS; RND;", 2, 0),
        ("L 3.5; RND;", 4, 0),
        ("L 2.1; RND+;", 3, 0),
        ("L -2.1; RND-;", 0xFFFD, 0),
        ("L -2.9; TRUNC;", 0xFFFE, 0),
        // Out of range: ACCU1 stays 3.0E10 = 50DF8476h; CC0 and CC1 stay.
        ("L 3.0e10; RND;", 0x8476, 0x30),
        // +infinity is 7F800000h.
        ("L 1.0; L 0.0; /R;", 0, 0xB0),
        ("L -1.0; SQRT; L 0;", 0, 0xF0),
        ("L 2.0; L 3.0; -R; L 0;", 0, 0x40),
        ("L -123; ITB;", 0xF123, 0),
        ("L 1000; ITB;", 1000, 0x30),
        ("L W#16#F123; BTI;", 0xFF85, 0),
        ("L W#16#F0F; L W#16#FF; AW;", 0x000F, 0x80),
        ("L W#16#F00; AW W#16#FF;", 0, 0),
        ("L W#16#F0F; XOW W#16#FF;", 0x0FF0, 0x80),
        ("L W#16#8001; SLW 1;", 2, 0x80),
        ("L W#16#8001; SRW 1;", 0x4000, 0x80),
        ("L 33; L DW#16#FFFFFFFF; SRD;", 0, 0),
        // A count of 0 does nothing at all: the codes of the comparison stay.
        ("L 3; L 5; -I; L 0; L W#16#8000; SLW;", 0x8000, 0x40),
        ("L W#16#8000; SSI 4;", 0xF800, 0),
        ("L DW#16#F0000001; RLD 4;", 0x001F, 0x80),
        // CC1 is 1 by AW; RRDA takes it in at the top, bit 0 goes out.
        ("L W#16#1; AW W#16#1; L DW#16#3; RRDA;", 1, 0x80),
        ("L W#16#12FF; INC 1;", 0x1200, 0),
        ("L W#16#1200; DEC 1;", 0x12FF, 0),
        ("L W#16#1234; CAW;", 0x3412, 0),
        ("L DW#16#12345678; CAD;", 0x3412, 0),
        ("L 1; L 2; TAK;", 1, 0),
        ("L 1; L 2; POP;", 1, 0),
        ("L 1; L 2; PUSH; L 3; TAK;", 2, 0),
        ("L -2; L 0; L 0; +D;", 0, 0),
        // L -2 has a high word of 0: 65534 and not −2.
        ("L -2; L L#1; >D; L 0;", 0, 0x82),
        ("L 5; L 5; ==I; L 0;", 0, 0x02),
        ("L 3; L 5; >I; L 0;", 0, 0x40),
        ("A M 1.0; SAVE; L 0;", 0, 0x102),
        ("L W#16#1FF; T STW; L 0;", 0, 0x1F2),
        ("L 30000; L 30000; +I; L 1; L 1; +I;", 2, 0x90),
    ];
    let texts: Vec<_> = cases.iter().map(|(text, ..)| format!("{text} T MW 100; L STW; T MW 104;")).collect();
    let cases: Vec<Case<'_>> =
        texts.iter().zip(&cases).map(|(text, (_, word, status))| (text.as_str(), *word, *status)).collect();
    check(&cases);
}

/// MB 100 has the results of bits; MW 104 further words.
#[test]
fn logic_brackets_edges_and_jumps() {
    let bit = |number: u16| 0x100 << number;
    check(&[
        ("A M 1.0; A( ; O M 1.1; O M 1.0; ) ; = M 100.0;", bit(0), 0),
        ("A M 1.1; O( ; A M 1.0; AN M 1.1; ) ; = M 100.0;", bit(0), 0),
        ("AN( ; A M 1.0; A M 1.1; ) ; = M 100.0;", bit(0), 0),
        ("A M 1.1; O; A M 1.0; AN M 1.1; = M 100.0;", bit(0), 0),
        ("A M 1.0; O; A M 1.1; = M 100.0;", bit(0), 0),
        ("X M 1.0; X M 1.0; X M 1.0; = M 100.0;", bit(0), 0),
        ("X( ; A M 1.0; ) ; XN( ; A M 1.1; ) ; = M 100.0;", 0, 0),
        ("A M 1.0; NOT; = M 100.0; NOT; = M 100.1;", bit(1), 0),
        // After an output the next bit operation is a first check.
        ("A M 1.1; = M 100.0; A M 1.0; = M 100.1;", bit(1), 0),
        // Seven brackets.
        ("A( ; A( ; A( ; A( ; A( ; A( ; A( ; A M 1.0; ) ; ) ; ) ; ) ; ) ; ) ; ) ; = M 100.0;", bit(0), 0),
        ("SET; FP M 2.0; = M 100.0; SET; FP M 2.0; = M 100.1; CLR; FN M 2.0; = M 100.2;", bit(0) | bit(2), 0),
        // A jump on the RLO that is not taken leaves RLO 1.
        ("A M 1.1; JC a; = M 100.0; a: NOP 0;", bit(0), 0),
        ("A M 1.1; JNB a; = M 100.0; a: A BR; = M 100.1;", 0, 0),
        ("A M 1.0; JCB a; = M 100.0; a: A BR; = M 100.1;", bit(1), 0),
        ("L 30000; L 30000; +I; JOS a; = M 100.0; a: JOS b; SET; = M 100.1; b: NOP 0;", bit(1), 0),
        ("L 2; L 2; -I; JN a; SET; = M 100.0; a: JPZ b; SET; = M 100.1; b: NOP 0;", bit(0), 0),
        ("L 1; JL d; JU a; JU b; d: JU c; a: L 10; JU e; b: L 11; JU e; c: L 12; e: T MW 104;", 0, 11),
        ("L 2; JL d; JU a; JU b; d: JU c; a: L 10; JU e; b: L 11; JU e; c: L 12; e: T MW 104;", 0, 12),
        ("L 3; n: T MW 102; L MW 104; + 1; T MW 104; L MW 102; LOOP n;", 0, 3),
        ("A C 1; = M 100.0; L C#125; A M 1.0; S C 1; A C 1; = M 100.1; CD C 1; LC C 1; T MW 104;", bit(1), 0x124),
        ("A M 1.0; L S5T#2S; SE T 1; A T 1; = M 100.0; LC T 1; T MW 104;", bit(0), 0x0200),
        ("A M 1.0; L S5T#2S; SD T 1; A T 1; = M 100.0; L T 1; T MW 104;", 0, 200),
    ]);
}

#[test]
fn the_master_control_relay() {
    let bit = |number: u16| 0x100 << number;
    check(&[
        ("SET; = M 100.0; S M 100.1; MCRA; CLR; MCR( ; SET; = M 100.0; R M 100.1; )MCR; MCRD;", bit(1), 0),
        // An inner zone that is on, within one that is off.
        ("MCRA; CLR; MCR( ; SET; MCR( ; SET; = M 100.0; )MCR; )MCR; SET; = M 100.1; MCRD;", bit(1), 0),
        ("L 7; T MW 104; MCRA; CLR; MCR( ; L 9; T MW 104; )MCR; MCRD;", 0, 0),
        // Without MCRA the brackets act on nothing.
        ("CLR; MCR( ; SET; = M 100.0; )MCR;", bit(0), 0),
    ]);
}

#[test]
fn indirect_addresses_and_registers() {
    check(&[
        ("L P#100.3; T MD 20; SET; = M [MD 20];", 0x0800, 0),
        ("LAR1 P#100.7; SET; = M [AR1,P#0.1];", 0x0001, 0),
        ("LAR1 P#M 102.0; L 7; T W [AR1,P#2.0]; L DW#16#0; LAR2 ; L 9; T MW [AR2,P#100.0];", 9, 7),
        ("L 10; T MW 20; OPN DB [MW 20]; L 9; T DBW 4; L DB10.DBW 4; T MW 104; L DBNO; T MW 100;", 10, 9),
        ("LAR1 P#0.0; L 16; +AR1 ; TAR1 ; T MW 104; L DBLG; T MW 100;", 0, 16),
        // 28h and 0Bh are 33h.
        ("LAR1 P#M 5.0; +AR1 P#1.3; TAR1 ; T MW 104; SRD 24; T MW 100;", 0x83, 0x33),
        ("LAR1 P#1.0; LAR2 P#2.0; CAR ; TAR1 ; T MW 100; TAR2 ; T MW 104;", 0x10, 0x08),
        // A qualified access opens its data block; DI stays.
        ("OPN DI 10; L DB10.DBW 0; L DBNO; T MW 100; L DINO; T MW 104;", 10, 10),
        ("OPN DB 10; CDB ; L DINO; T MW 100; L DBNO; T MW 104;", 10, 0),
        ("L P#104.0; T MD 20; L 5; T MW [MD 20]; L 3; T MW 22; L 4; T MW 100;", 4, 5),
    ]);
}

/// What blocks leave to their callers.
#[test]
fn calls_and_ends_of_blocks() {
    let fc =
        |number: u16, statements: &str| format!("FUNCTION FC {number} : VOID\nBEGIN\n{statements}\nEND_FUNCTION\n");
    let text = [
        // BEC that is not taken goes on with RLO 1; accumulators and RLO pass.
        fc(1, "A M 1.1; BEC; = M 100.0; L 77;"),
        // The zone of the caller does not act here.
        fc(2, "SET; = M 100.1;"),
        fc(3, "OPN DB 10; CLR; SAVE;"),
        ob1("UC FC 1; T MW 104; MCRA; CLR; MCR( ; UC FC 2; SET; = M 100.2; )MCR; MCRD; \
             SET; SAVE; CC FC 3; A BR; = M 100.3; L DBNO; T MW 106; CLR; CC FC 2; = M 100.4;"),
    ]
    .concat();
    let mut plc = Plc::new(&text);
    plc.memory.flags[1] = 1;
    plc.scan();
    // The conditional call that is not made leaves RLO 1.
    assert_eq!((plc.memory.flags[100], plc.word(104), plc.word(106)), (0b1_0011, 77, 0));
}
