//! Any bytes, and valid programs with changes: no panic, every call ends, and the static check agrees with a run.

use proptest::prelude::*;

use super::{Channel, checked};
use crate::nc_program::{AxisNames, CheckFinding, Library, Modal, Prepared, Program, SINUMERIK, check};

/// Programs with almost every construct.
const VALID: &[&str] = &[
    "PROC PART(INT GIVEN=1, VAR REAL BACK, STRING[5] TEXT) SAVE SBLOF\nDEF INT AB[2,2]=SET(1,2), CD\nDEF STRING[9] EF=\"A;B\"\n\
     N10 G0 X10 Y=IC(-5.5) Z.5EX1 M3 S1=500 F100\n/1 N20 G2 X1 I5 J=AC(3) TURN=2\nIF (R1==2) AND NOT (CD>1)\nAB[1,0]=SIN(30)*2<<\"A\"\nELSE\n\
     GOTOF AB\nENDIF\nFOR CD=1 TO 3\nREPEATB AB P=2\nENDFOR\nAB: POS[X]=5 FA[X]=100\nID=1 WHENEVER $AA_IM[X]>R1 DO M20 $R[1]=5\n\
     CASE(R1) OF 1 GOTOF AB DEFAULT GOTOB N10\nWHILE $P_PROG==\"A\"\nSUB(1,,R2) P3\nENDWHILE\nG74 X1=0\nPRESETON(X,1)\nMSG(\"A\")\nM30",
    "%_N_PART_MPF\n;$PATH=/_N_MPF_DIR\nR1='H1F' R[R1]=-2\nREPEAT\nG[8]=2 G=17\nUNTIL R1 B_AND 'B11'\nLOOP\nCALL \"SUB\"\nENDLOOP\nM17",
];

/// Prepares and checks a program. Ends for every text.
fn survive(bytes: &[u8]) {
    for program in Program::read("PART.MPF", "", bytes) {
        let path = program.path();
        let mut channel = Channel::new();
        channel.library.add(program.clone());
        let mut interpreter = crate::nc_program::Interpreter::new(&path, Modal::default(), None, false);
        for _ in 0..50 {
            match interpreter.next(&mut channel) {
                Ok(Prepared::Ended) | Err(_) => break,
                Ok(Prepared::Block(_) | Prepared::Calculated(_) | Prepared::Before(_) | Prepared::Waits(_)) => {}
            }
        }
        let findings = check(&program, &Library::default(), &AxisNames::usual(), &SINUMERIK);
        for finding in findings {
            let (line, column) = finding.place();
            assert!(line <= program.count().max(1) && column >= 1, "{finding:?}");
            if let CheckFinding::Alarm(alarm) = finding {
                assert!(!alarm.title().is_empty() && !alarm.to_string().is_empty(), "{alarm:?}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn any_bytes_are_survived(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        survive(&bytes);
    }

    #[test]
    fn any_printable_text_is_survived(text in "[ -~\n]{0,300}") {
        survive(text.as_bytes());
    }

    #[test]
    fn any_words_of_the_language_are_survived(words in proptest::collection::vec(word(), 0..60)) {
        survive(words.join(" ").as_bytes());
        survive(words.concat().as_bytes());
    }

    #[test]
    fn changed_programs_are_survived(
        which in 0..VALID.len(),
        changes in proptest::collection::vec((any::<prop::sample::Index>(), 0..4, any::<u8>()), 1..8),
    ) {
        let mut bytes = VALID[which].as_bytes().to_vec();
        for (place, kind, byte) in changes {
            let at = place.index(bytes.len());
            match kind {
                0 => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                2 => { bytes.remove(at); }
                _ => { let end = (at + usize::from(byte % 40)).min(bytes.len()); bytes.drain(at..end); }
            }
            if bytes.is_empty() {
                break;
            }
        }
        survive(&bytes);
        survive(&bytes[..bytes.len() / 2]);
    }

    /// What stops a run is found by the check, unless only a run knows it.
    #[test]
    fn the_check_finds_what_stops_a_run(words in proptest::collection::vec(word(), 1..12)) {
        let text = words.join(" ");
        let channel = Channel::new().with("PART.MPF", &text);
        let mut running = Channel::new().with("PART.MPF", &text);
        let mut interpreter = super::interpreter();
        let mut found = None;
        for _ in 0..20 {
            match interpreter.next(&mut running) {
                Ok(Prepared::Ended) => break,
                Err(alarm) => { found = Some(alarm.number); break; }
                Ok(Prepared::Block(_) | Prepared::Calculated(_) | Prepared::Before(_) | Prepared::Waits(_)) => {}
            }
        }
        let by_value = [12160, 12430, 12560, 12400, 14010, 14013, 14020, 14025, 14048, 14051, 14080, 14092, 12550, 12410,
            12475, 17020, 17070, 17080, 17090, 17095, 12553, 10860, 14082, 15700, 12150, 15460, 16930, 14800, 14810];
        if let Some(number) = found.filter(|number| !by_value.contains(number)) {
            let (alarms, _) = checked(&channel, "PART.MPF");
            prop_assert!(alarms.contains(&number), "{number} in {text:?}, found {alarms:?}");
        }
    }
}

fn word() -> impl Strategy<Value = String> {
    let fixed = [
        "G0",
        "G1",
        "G2",
        "G4",
        "G74",
        "G25",
        "TRANS",
        "G54",
        "G=",
        "G[8]=",
        "X10",
        "Y=",
        "Z-5",
        "X1=",
        "I5",
        "CR=5",
        "TURN=1",
        "F100",
        "F=",
        "S500",
        "M3",
        "M2=3",
        "M30",
        "M17",
        "T1",
        "D1",
        "H1",
        "POS[X]=",
        "FA[X]=",
        "SPOS=",
        "ACC[X]=",
        "AX[X]=",
        "R1=",
        "R[1]=",
        "R1",
        "R2",
        "5",
        "-",
        "+",
        "*",
        "/",
        "DIV",
        "MOD",
        "(",
        ")",
        "[",
        "]",
        ",",
        "=",
        "==",
        "<>",
        "<",
        ">",
        "<=",
        "<<",
        "AND",
        "OR",
        "NOT",
        "B_AND",
        "IF",
        "ELSE",
        "ENDIF",
        "WHILE",
        "ENDWHILE",
        "LOOP",
        "ENDLOOP",
        "FOR",
        "TO",
        "ENDFOR",
        "REPEAT",
        "UNTIL",
        "REPEATB",
        "CASE",
        "OF",
        "DEFAULT",
        "GOTOF",
        "GOTOB",
        "GOTO",
        "GOTOC",
        "GOTOS",
        "AB",
        "AB:",
        "N10",
        ":5",
        "/1",
        "P2",
        "P=",
        "DEF INT",
        "DEF STRING[5]",
        "DEF AXIS",
        "CD",
        "PROC",
        "VAR",
        "REAL",
        "SAVE",
        "CALL",
        "EXTCALL",
        "L1",
        "RET",
        "MSG(",
        "SETAL(",
        "STOPRE",
        "WAITP(X)",
        "GET(X)",
        "PRESETON(X,1)",
        "RELEASE(",
        "TRAILON(X,Y)",
        "ID=1",
        "WHEN",
        "DO",
        "RDISABLE",
        "$AA_IM[X]",
        "$R[1]",
        "$P_PROG",
        "SIN(",
        "SUBSTR(",
        "\"A\"",
        "'H1F'",
        "'B2'",
        "AC(",
        "IC(",
        "DC(",
        "QU(",
        "SUPA",
        "G41",
        "FOO",
        ";",
        "\n",
        "\n",
        "\n",
        "\"",
        "1.2EX-3",
        "\u{e4}",
    ];
    prop::sample::select(fixed.to_vec()).prop_map(str::to_owned)
}
