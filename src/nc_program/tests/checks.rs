//! The static check of a program.

use super::{Channel, checked};
use crate::nc_program::{AxisNames, CheckFinding, Library, Program, ProgramKind, SINUMERIK, check};

/// Line, column and number of each alarm; number 0 is a warning.
fn findings(text: &str) -> Vec<(u32, u32, u32)> {
    let program = Program::new("PART.MPF", ProgramKind::Main, "", text.as_bytes());
    let found = check(&program, &Library::default(), &AxisNames::usual(), &SINUMERIK);
    let row = |finding: &CheckFinding| {
        let (line, column) = finding.place();
        let number = if let CheckFinding::Alarm(alarm) = finding { alarm.number } else { 0 };
        (line, column, number)
    };
    found.iter().map(row).collect()
}

#[test]
fn all_errors_are_found_with_line_and_column() {
    let text = "N10 G0 X5 G999\nN20 R1=FOO+1\nGOTOF NOWHERE\nR2=1/0\nG0 X1 X2\nENDIF\nM30";
    assert_eq!(
        findings(text),
        [(1, 11, 12470), (2, 8, 12550), (3, 1, 14080), (4, 5, 14051), (5, 7, 16420), (6, 1, 12640)]
    );
}

#[test]
fn comparisons_beside_logical_operators_are_warned_of() {
    for (text, column) in [
        ("IF R1==2 AND R2==3 GOTOF AB", Some(6)),
        ("IF R1==2 OR TRUE GOTOF AB", Some(6)),
        ("IF NOT R1==2 GOTOF AB", Some(10)),
        ("IF (R1==2) AND (R2==3) GOTOF AB", None),
        ("IF NOT (R1==2) GOTOF AB", None),
        ("IF (R1 AND R2)==3 GOTOF AB", None),
        ("IF R1+1==2 GOTOF AB", None),
    ] {
        let found = findings(&format!("{text}\nAB: M30"));
        let first = found.first().map(|(line, column, number)| (*line, *column, *number));
        assert_eq!(first, column.map(|column| (1, column, 0)), "{text}: {found:?}");
    }
}

#[test]
fn values_that_only_a_run_knows_are_no_errors() {
    for text in [
        "DEF INT AB[3]\nAB[R1]=R2/R3",
        "G0 X=R1\nF=R2 G1 X5",
        "M=R1 T=R2 D=R3 G=R4",
        "R1=SQRT(R2)+LN(R3)",
        "DEF AXIS SLIDE, OTHER\nFA[SLIDE]=R1 POS[SLIDE]=R2 POS[OTHER]=5",
        "L1=5",
        "GOTOF \"N\"<<R1",
        "DEF STRING[9] GOAL\nGOTOF GOAL",
        "IF $P_PROG==\"A\"\nENDIF\nR1=$AA_IM[X]+1",
        "IF R1 GOTOF AB\nX5\nAB:",
        "FOR R1=R2 TO R3\nENDFOR",
        "CALL \"S\"<<R1",
        "SETAL(60000+R1)",
        "G2 F1 X5 I5 TURN=R1",
        "ID=1 EVERY $AC_MARKER[1]==R2 DO $AC_MARKER[2]=5",
    ] {
        let found = findings(&format!("{text}\nM30"));
        let expected = if text == "L1=5" { vec![12550] } else { Vec::new() };
        assert_eq!(found.iter().map(|row| row.2).collect::<Vec<_>>(), expected, "{text}");
    }
}

#[test]
fn what_depends_on_the_way_is_not_judged_behind_a_label() {
    assert_eq!(findings("G1 X5\nM30"), [(1, 1, 10860)]);
    assert_eq!(findings("START: G1 X5\nM30"), []);
    assert_eq!(findings("F5 G1 X5\nX1 I5\nM30"), [(2, 4, 15460)]);
    assert_eq!(findings("GOTOF AB\nAB: X1 I5\nM30"), []);
}

#[test]
fn a_wrong_definition_causes_no_other_errors() {
    assert_eq!(findings("DEF INT AB CD\nAB=CD\nM30").len(), 1);
    assert_eq!(findings("DEF INT A B\nN10 A=1\nM30").len(), 1);
    assert_eq!(findings("DEF REAL 1A\nR1=5 X\nM30").len(), 2, "another block");
}

#[test]
fn an_end_is_needed_where_the_program_arrives() {
    for (text, expected) in [
        ("R1=1", vec![14000]),
        ("", vec![14000]),
        ("AB: R1=1\nGOTOB AB", vec![]),
        ("LOOP\nR1=1\nENDLOOP", vec![]),
        ("M30\n; the end", vec![]),
        ("R1=1 X5", vec![12080]),
    ] {
        assert_eq!(findings(text).iter().map(|row| row.2).collect::<Vec<_>>(), expected, "{text}");
    }
}

#[test]
fn subprograms_are_checked_as_such() {
    let channel = Channel::new()
        .with("SUB.SPF", "PROC SUB(INT GIVEN, VAR REAL BACK, REAL LIST[])\nBACK=GIVEN+LIST[7] X=LIST[1]\nRET")
        .with("PART.MPF", "DEF REAL LIST[2]\nSUB(1,R1,LIST)\nG1 X5\nM30");
    assert_eq!(checked(&channel, "SUB.SPF").0, [12080], "an assignment beside a word");
    assert_eq!(checked(&channel, "PART.MPF").0, Vec::<u32>::new(), "the subprogram may have programmed F");
    let channel = Channel::new().with("SUB.SPF", "G1 X5\nM17");
    assert_eq!(checked(&channel, "SUB.SPF").0, Vec::<u32>::new(), "the caller may have programmed F");
}
