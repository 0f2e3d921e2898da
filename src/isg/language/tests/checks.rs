//! The static check.

use std::sync::Arc;

use super::program;
use crate::isg::language::check;

fn found(text: &str) -> Vec<(u32, u32, String, bool)> {
    let others = [Arc::new(program("sub.nc", "M17"))];
    let row = |finding: &crate::isg::language::Finding| {
        (finding.fault.line, finding.fault.column, finding.fault.code.to_string(), finding.is_warning)
    };
    check(&program("part.nc", text), &others, false).iter().map(row).collect()
}

#[test]
fn every_line_has_its_first_error() {
    let text = "%L UP\nN10 XX YY\nM30\n%MAIN\nX=P1/0\nLL UP\nLL DOWN\nL SUB\nL OTHER\n$GOTO [A]\n#FOO\nV.G.AX_LINK.NR=1\n$IF P1\n$ENDFOR\n";
    let error = |line, column, code: &str| (line, column, code.to_owned(), false);
    let wanted = [
        error(2, 5, "nc-syntax"),
        (3, 1, "nc-call".to_owned(), true),
        // P1/0: P1 is not known, and the division is not made.
        error(7, 1, "nc-call"),
        error(9, 1, "nc-call"),
        error(10, 1, "nc-syntax"),
        error(11, 1, "nc-syntax"),
        error(12, 1, "nc-value"),
        error(13, 1, "nc-syntax"),
        error(14, 1, "nc-syntax"),
    ];
    assert_eq!(found(text), wanted);
}

#[test]
fn what_only_a_run_knows_is_no_error() {
    let text = "N10 #AX LINK NBR[P1, [P2 = P3, P4, P5], P6=P7]\n#SET AX LINK[P1, [Y2=Y1,G,P1,P2]]\nX=SQRT[P1] G74 Y=P2\nG04 P1\n#CALL AX [A1, P1, P2]\n$FOR P1=P2,P3,P4\nX=P1[P2]\n$ENDFOR\n/ $GOTO N10\nN10:";
    assert_eq!(found(text), []);
}

/// Diagnosis 20193: the main program has begun, and `%` stands in it.
#[test]
fn a_percent_sign_in_the_main_program_is_found_in_its_line() {
    let error = |line, column| (line, column, "20193".to_owned(), false);
    assert_eq!(found("N10 X1\n  %MAIN\nN20 X2\nM30"), [error(2, 3)]);
    assert_eq!(found("%MAIN\nN10 X1\n%L UP\nM17"), [error(3, 1)]);
    // Behind its end a subroutine may stand.
    assert_eq!(found("%MAIN\nN10 X1\nM30\n%L UP\nM17"), []);
}

/// What the control refuses on any machine is an error here, too, each in its line.
#[test]
fn values_that_no_machine_takes_are_errors() {
    let text = "G33 X1\nG500\nF-100\nV.G.FOO=1\nX=V.G.AX_LINK.FOO\nG0 X=99999999999999999999\nN10 G01 X1 F100\nM30\n";
    let errors: Vec<_> = found(text).into_iter().map(|(line, _, code, _)| (line, code)).collect();
    let wanted: Vec<_> = (1..=6).map(|line| (line, "nc-value".to_owned())).collect();
    assert_eq!(errors, wanted);
}
