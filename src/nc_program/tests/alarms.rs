//! Each number with a smallest program that raises it, in a run and in the static check.

use std::collections::BTreeSet;

use super::{Channel, alarm, checked, run_in};
use crate::nc_program::{Class, alarm_numbers};

/// Number, %2, %3, program, and whether the static check finds it, too.
const ALARMS: &[(u32, &str, &str, &str, bool)] = &[
    (10860, "N10", "", "N10 G1 X10\nM30", true),
    (10860, "3", "", "F100\nX1\nG95 X2\nM30", true),
    (12000, "N10", "F200", "N10 G1 F100 F200\nM30", true),
    (12000, "1", "S2=200", "S2=100 S2=200\nM30", true),
    (12000, "1", "T2", "T1 T2\nM30", true),
    (12000, "1", "I2", "G2 F1 X1 I1 I2\nM30", true),
    (12010, "1", "M15", "M10 M11 M12 M13 M14 M15\nM30", true),
    (12010, "1", "H4", "H1 H2 H3 H4\nM30", true),
    (12020, "1", "", "F=AC(5)\nM30", true),
    (12020, "1", "", "G2 F1 X1 I=DC(5)\nM30", true),
    (12020, "1", "", "X=QU(5)\nM30", true),
    (12020, "1", "", "M=AC(5)\nM30", true),
    (12020, "1", "", "TRANS X=IC(5)\nM30", true),
    (12020, "1", "", "R1=IC(5)\nM30", true),
    (12040, "1", "FA[1]=5", "FA[1]=5\nM30", true),
    (12060, "1", "", "G0 G1 X5\nM30", true),
    (12070, "1", "", "G4 G25 F5\nM30", true),
    (12080, "1", "IF", "R1=5 G0\nM30", true),
    (12080, "N5", "", "N5 IF GOTOF AB\nAB: M30", true),
    (12080, "1", "X5", "R1 X5\nM30", true),
    (12080, "1", "\"A", "MSG(\"A\nM30", true),
    (12080, "1", "", "X5 STOPRE\nM30", true),
    (12090, "1", "P5", "G0 X5 P5\nM30", true),
    (12110, "1", "", "G1 F5 I10 X20\nM30", true),
    (12110, "1", "", "G4 F5 X5\nM30", true),
    (12110, "1", "", "G4 F5 S5\nM30", true),
    (12110, "1", "", "G74 X1=0 M5\nM30", true),
    (12120, "1", "", "G25 X-5 M5\nM30", true),
    (12120, "1", "", "STARTFIFO X5\nM30", true),
    (12150, "1", "+", "R1=1+\"A\"\nM30", true),
    (12150, "1", "R1=\"A\"", "R1=\"A\"\nM30", true),
    (12160, "2", "WHOLE=1EX20", "DEF INT WHOLE\nWHOLE=1EX20\nM30", true),
    (12160, "1", "1EX999", "R1=1EX999\nM30", true),
    (12170, "2", "AB", "DEF INT AB\nDEF REAL AB\nM30", true),
    (12170, "1", "STOPRE", "DEF INT STOPRE\nM30", true),
    (12170, "1", "CR", "DEF REAL CR\nM30", true),
    (12170, "1", "SIN", "DEF REAL SIN\nM30", true),
    (12260, "1", "AB", "DEF INT AB[2]=SET(1,2,3)\nM30", true),
    (12400, "2", "AB", "DEF INT AB[2]\nR1=AB\nM30", true),
    (12400, "1", "R", "R1=R\nM30", true),
    (12410, "2", "AB", "DEF INT AB[2]\nR1=AB[\"A\"]\nM30", true),
    (12420, "1", "", "ABCDEFGHIJKLMNOPQRSTUVWXYZ1234567=1\nM30", true),
    (12420, "ABCDEFGHIJKLMNOPQRSTUVWXYZ1234567", "", "ABCDEFGHIJKLMNOPQRSTUVWXYZ1234567: X1\nM30", true),
    (12430, "2", "", "DEF INT AB[2]\nR1=AB[2]\nM30", true),
    (12430, "1", "", "DEF INT AB[1,1,1,1]\nM30", true),
    (12470, "N1", "G999", "N1 G999\nM30", true),
    (12475, "1", "999", "G=999\nM30", true),
    (12475, "1", "77", "G[8]=2 G[1]=77\nM30", true),
    (12500, "1", "CHAN", "DEF CHAN INT AB\nM30", true),
    (12550, "1", "FOO", "R1=FOO\nM30", true),
    (12550, "1", "FOO", "G0 X1 FOO\nM30", true),
    (12550, "1", "Q5", "G0 Q5\nM30", true),
    (12550, "1", "$AA_NOTHING", "R1=$AA_NOTHING\nM30", false),
    (12553, "1", "G41", "G41 X5\nM30", true),
    (12553, "1", "$AC_PATHN", "R1=$AC_PATHN\nM30", false),
    (12560, "1", "T70000", "T70000\nM30", true),
    (12560, "1", "T1.5", "T1.5\nM30", true),
    (12560, "1", "M1.5", "M1.5\nM30", true),
    (12560, "1", "M=R1+0.5", "M=R1+0.5\nM30", false),
    (12560, "1", "M=2.5", "DO M=2.5\nM30", true),
    (12560, "1", "M=-1", "ID=1 DO M=-1\nM30", true),
    (12560, "1", "M=R1+0.5", "WHEN $AA_IM[X]>5 DO M=R1+0.5\nM30", false),
    (12550, "1", "X1EX30", "X1EX30=5\nM30", true),
    (12550, "1", "M1EX2", "M1EX2=5\nM30", true),
    (12560, "1", "M=-1", "M=-1\nM30", true),
    (12560, "1", "D0.5", "D0.5\nM30", true),
    (12560, "1", "ACC[X]=0", "ACC[X]=0\nM30", true),
    (12630, "1", "", "/ WHILE TRUE\nENDWHILE\nM30", true),
    (12630, "AB", "", "AB: LOOP\nENDLOOP\nM30", true),
    (12640, "2", "", "R1=1\nENDIF\nM30", true),
    (12640, "1", "", "WHILE FALSE\nENDLOOP\nM30", true),
    (12640, "1", "", "IF TRUE\nR1=1", true),
    (14000, "2", "", "R1=1\nR2=1", true),
    (14013, "1", "", "L1 P0\nM30", true),
    (14011, "1", "NOWHERE", "NOWHERE\nM30", true),
    (14011, "1", "L0123", "L0123\nM30", true),
    (14011, "1", "NOWHERE", "CALL \"NOWHERE\"\nM30", true),
    (14016, "N5", "", "N5 M60 M61\nM30", false),
    (14020, "1", "", "R1=SQRT(-1)\nM30", true),
    (14020, "1", "", "R1=SIN(1,2)\nM30", true),
    (14020, "1", "", "PRESETON(X)\nM30", true),
    (14025, "1", "", "ID=0 DO M20\nM30", true),
    (14048, "1", "", "G2 F1 X5 I5 TURN=-1\nM30", true),
    (14050, "1", "", "R1=((((((((((((((((((((((1))))))))))))))))))))))\nM30", true),
    (14051, "1", "", "R1=1/0\nM30", true),
    (14051, "1", "", "R1=TAN(90)\nM30", true),
    (14060, "1", "", "/10 X5\nM30", true),
    (14080, "1", "AB", "GOTOF AB\nM30", true),
    (14080, "AB", "AB", "AB: GOTOF AB\nM30", true),
    (14080, "2", "N7", "N10 R1=1\nGOTO N7\nM30", true),
    (14082, "1", "AB", "REPEAT AB P=2\nM30", true),
    (14091, "1", "1", "RET\nM30", true),
    (14092, "2", "FA[AB]=5", "DEF AXIS AB\nFA[AB]=5\nM30", false),
    (14300, "1", "", "FDA[X]=5 X5\nM30", true),
    (14300, "1", "", "POS[Y]=5 FDA[X]=5\nM30", true),
    (14300, "1", "", "POS[X]=5 FDA[X]=5 FA[X]=5\nM30", true),
    (14300, "1", "", "G1 FD=5\nM30", true),
    (14300, "1", "", "G95 G1 X5 FD=5\nM30", true),
    (14300, "1", "", "G0 X5 FD=5\nM30", true),
    (14300, "1", "", "G1 X5 F5 FD=5\nM30", true),
    (14500, "2", "", "R1=1\nDEF INT AB\nM30", true),
    (14500, "2", "", "R1=1\nPROC AB\nM30", true),
    (14520, "2", "", "DEF INT AB\nPROC PART\nM30", true),
    (14750, "1", "", "M10 M11 M12 M13 M14 S1=1 S2=2 S3=3 H1 H2 H3\nM30", true),
    (14757, "1", "", "ID=1 DO X5\nM30", true),
    (14757, "1", "", "ID=1 DO R1=5\nM30", true),
    (14760, "1", "", "M3 M4\nM30", true),
    (14760, "1", "", "M0 M30\nM30", true),
    (14800, "1", "", "G1 X5 F0\nM30", true),
    (14810, "1", "X", "FA[X]=-1\nM30", true),
    (15460, "2", "", "G1 F5\nX5 I5\nM30", true),
    (15700, "1", "59999", "SETAL(59999)\nM30", true),
    (16100, "1", "SPOS[40]=5", "SPOS[40]=5\nM30", true),
    (16420, "1", "X", "G0 X1 X2\nM30", true),
    (16420, "1", "X", "G0 X1 POS[X]=2\nM30", true),
    (16785, "1", "X", "TRAILON(X,X,1)\nM30", true),
    (16800, "1", "X", "G0 X=DC(5)\nM30", true),
    (16810, "1", "A", "G0 A=ACP(5)\nM30", true),
    (16820, "1", "X", "G0 X=ACN(5)\nM30", true),
    (16830, "1", "C", "G0 C=DC(360)\nM30", true),
    (16830, "1", "C", "G0 C400\nM30", true),
    (16830, "1", "C", "G0 C-0.001\nM30", true),
    (16830, "2", "C", "G91 G0 C400\nG0 C=AC(360)\nM30", true),
    (16830, "4", "C", "TRANS C400\nG74 C=400\nG91\nPOS[C]=AC(400)\nM30", true),
    (16930, "2", "", "MSG(\"A\")\nMSG()\nM30", true),
    (17020, "1", "", "R1=R100\nM30", false),
    (17020, "1", "", "R[-1]=5\nM30", true),
    (17020, "1", "", "R1=$MC_LIMIT[99]\nM30", false),
    (17030, "1", "", "R1=$MC_LIMIT[0,99]\nM30", false),
    (17040, "1", "", "R1=$AA_IM[XF]\nM30", false),
    (17070, "1", "", "$MN_FIXED=1\nM30", false),
    (17071, "1", "", "R1=$MN_SECRET\nM30", false),
    (17080, "1", "$MC_LIMIT", "$MC_LIMIT=-1\nM30", false),
    (17090, "1", "$MC_LIMIT", "$MC_LIMIT=11\nM30", false),
    (17095, "1", "", "$MC_LIMIT=1.5\nM30", false),
    (17180, "1", "", "D256\nM30", true),
];

/// Numbers that need more than one program, or more nesting than a line of the table shows.
const ELSEWHERE: &[u32] = &[12300, 12320, 12330, 12340, 12641, 14010, 14012, 14510];

#[test]
fn each_number_is_raised_by_a_smallest_program() {
    let mut wrong = Vec::new();
    for (number, block, text, program, _) in ALARMS {
        let found = alarm(program);
        // The table has no text where the whole word is meant.
        let is_text = text.is_empty() || *number == 12080 || found.text == *text;
        let is_explained = !found.reason.is_empty() || matches!(number, 16420 | 16785);
        if found.number != *number || found.block != *block || !is_text || !is_explained {
            wrong.push(format!("{number}: {program:?}: {found}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A name that cannot be one is explained: it is an axis, an address, a word of the language.
#[test]
fn a_wrong_name_of_a_variable_is_explained() {
    for (text, words) in [
        ("DEF INT I", "I is an address"),
        ("DEF REAL X", "X is an axis"),
        ("DEF INT IF", "IF is a word of the language"),
        ("DEF INT A1", "its first two characters are letters"),
        ("PROC SUB(INT N)", "N is an address"),
    ] {
        let found = alarm(&format!("{text}\nM30"));
        assert!(found.number == 12080 && found.reason.contains(words), "{text}: {found}");
    }
}

#[test]
fn the_static_check_finds_the_same_numbers() {
    let mut wrong = Vec::new();
    for (number, _, _, program, is_static) in ALARMS {
        let (alarms, _) = checked(&Channel::new().with("PART.MPF", program), "PART.MPF");
        if alarms.contains(number) != *is_static {
            wrong.push(format!("{number}: {program:?}: {alarms:?}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_number_of_the_module_is_tested() {
    let tested: BTreeSet<u32> = ALARMS.iter().map(|row| row.0).chain(ELSEWHERE.iter().copied()).collect();
    let missing: Vec<_> = alarm_numbers().filter(|number| !tested.contains(number)).collect();
    assert!(missing.is_empty(), "{missing:?}");
}

#[test]
fn calls_have_their_alarms() {
    let sub = "PROC SUB(INT VALUE, VAR REAL BACK, AXIS SLIDE)\nBACK=VALUE\nM17";
    for (number, text, call) in [
        (12300, "BACK", "SUB(1,,X)"),
        (12320, "BACK", "SUB(1,2,X)"),
        (12330, "VALUE", "SUB(\"A\",R1,X)"),
        (12330, "BACK", "SUB(1,WHOLE,X)"),
        (12340, "SUB(1,R1,X,3)", "SUB(1,R1,X,3)"),
        (14010, "", "SUB(,R1)"),
        (14510, "", "PLAIN(1)"),
        (14013, "", "SUB(1,R1,X) P=-1"),
        (12080, "", "SUB(1,R1,X) X5"),
    ] {
        let main = format!("DEF INT WHOLE\nN20 {call}\nM30");
        let mut channel = Channel::new().with("PART.MPF", &main).with("SUB.SPF", sub).with("PLAIN.SPF", "M17");
        let (_, found) = run_in(&mut channel);
        let found = found.unwrap_or_else(|| panic!("{call}"));
        assert_eq!((found.number, found.block.as_str()), (number, "N20"), "{call}: {found}");
        assert!(text.is_empty() || found.text == text, "{call}: {found:?}");
        let (alarms, _) = checked(&channel, "PART.MPF");
        assert_eq!(alarms, [number], "{call}");
    }
}

#[test]
fn an_error_in_proc_is_an_alarm_of_the_called_program() {
    let mut channel = Channel::new().with("PART.MPF", "SUB(1)\nM30").with("SUB.SPF", "\nN5 PROC SUB(FOO A1)\nM17");
    let (_, found) = run_in(&mut channel);
    let found = found.unwrap();
    assert_eq!((found.number, found.program.as_str(), found.block.as_str(), found.line), (12080, "SUB.SPF", "N5", 2));
}

#[test]
fn structures_and_levels_are_limited() {
    let nested = |count: usize| format!("{}{}M30", "IF TRUE\n".repeat(count), "ENDIF\n".repeat(count));
    assert_eq!(run_in(&mut Channel::new().with("PART.MPF", &nested(8))).1, None);
    let found = alarm(&nested(9));
    assert_eq!((found.number, found.block.as_str(), found.class), (12641, "9", Class::InterpreterStop));
    assert_eq!(checked(&Channel::new().with("PART.MPF", &nested(9)), "PART.MPF").0, [12641]);

    let mut channel = Channel::new().with("PART.MPF", "L1\nM30");
    for level in 1..=8 {
        channel = channel.with(&format!("L{level}.SPF"), &format!("L{}\nM17", level + 1));
    }
    let (_, found) = run_in(&mut channel);
    let found = found.unwrap();
    // The main program and seven subprograms are eight levels.
    assert_eq!((found.number, found.program.as_str()), (14012, "L7.SPF"));
}

#[test]
fn an_alarm_of_a_correction_block_leaves_nothing_executed() {
    let mut channel = Channel::new().with("PART.MPF", "R1=5 R2=7 R3=1/R4\nG0 X=R1\nM30");
    let mut interpreter = super::interpreter();
    let before = interpreter.clone();
    for _ in 0..2 {
        let found = interpreter.next(&mut channel).unwrap_err();
        assert_eq!((found.number, found.class), (14051, Class::CorrectionBlock));
        assert_eq!((&interpreter, channel.r[1], channel.r[2]), (&before, 0.0, 0.0));
    }
    // The operator corrects R4; the next NC start reads the block again.
    channel.r[4] = 1.0;
    assert!(interpreter.next(&mut channel).is_ok());
    assert_eq!(channel.r[1..4], [5.0, 7.0, 1.0]);
}

#[test]
fn columns_and_refused_functions_are_reported() {
    let found = alarm("N10 G0 X1 G41\nM30");
    assert_eq!((found.line, found.column, found.is_refused), (1, 11, true));
    assert!(found.reason.contains("tool radius compensation"), "{found}");
    let found = alarm("MSG(\"\u{e4}\u{f6}\") X1\nM30");
    assert_eq!(found.column, 1);
    let found = alarm("R1=\"\u{e4}\u{f6}\" + FOO\nM30");
    assert_eq!((found.number, found.column), (12550, 11));
}
