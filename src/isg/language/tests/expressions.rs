//! Expressions.
#![expect(clippy::float_cmp, reason = "the values are exact")]

use super::{Channel, blocks, code};
use crate::isg::language::{Interpreter, LinkOff, Prepared};

fn value(expression: &str) -> f64 {
    blocks(&format!("X={expression}")).remove(0).axes[0].1
}

#[test]
fn operators_have_their_ranks() {
    for (expression, wanted) in [
        ("1 + 2 * 3", 7.0),
        ("[1 + 2] * 3", 9.0),
        ("10 - 4 - 3", 3.0),
        ("2 ** 3 * 2", 16.0),
        ("-2 ** 2", -4.0),
        ("2 ** -1", 0.5),
        ("4 ** 0.5 > 1.9", 1.0),
        ("45 MOD 20", 5.0),
        ("1 + 6 / 4", 2.5),
        ("6 & 3 | 8", 10.0),
        ("6 ^ 3", 5.0),
        ("1 + 1 == 2", 1.0),
        ("1 != 1", 0.0),
        ("1 <= 1 && 2 >= 3", 0.0),
        ("1 < 2 AND 2 < 3", 1.0),
        ("0 || 1", 1.0),
        ("1 XOR 1 OR 0", 0.0),
        ("0.4 OR 0", 0.0),
        ("-0.5 AND 1", 1.0),
        ("NOT[0.4]", 1.0),
        ("TRUE + FALSE", 1.0),
    ] {
        assert_eq!(value(expression), wanted, "{expression}");
    }
}

#[test]
fn functions_take_degrees_and_are_exact_where_they_can_be() {
    for (expression, wanted) in [
        ("SIN[30]", 0.5),
        ("[[sin[30.00] + 1] / 2]", 0.75),
        ("COS[60]", 0.5),
        ("TAN[45]", 1.0),
        ("COT[45]", 1.0),
        ("ASIN[1]", 90.0),
        ("ACOS[0.5]", 60.0),
        ("ATAN[1]", 45.0),
        ("ACOT[1]", 45.0),
        ("ATAN2[1, 0]", 90.0),
        ("SQRT[SQR[3] + 16]", 5.0),
        ("ABS[-2]", 2.0),
        ("INT[-2.7]", -2.0),
        ("FRACT[2.25]", 0.25),
        ("ROUND[2.5]", 3.0),
        ("LOG[1000]", 3.0),
        ("DEXP[3]", 1000.0),
        ("EXP[0] + LN[1]", 1.0),
        ("CEIL[1.2] + FLOOR[-1.2]", 0.0),
        ("INV[5]", -6.0),
        ("COS[180 * PI / PI]", -1.0),
        ("MIN[2, 3] * MAX[2, 3]", 6.0),
    ] {
        assert_eq!(value(expression), wanted, "{expression}");
    }
}

#[test]
fn what_has_no_value_is_refused() {
    for (line, wanted, column) in [
        ("X=1/0", "nc-value", 4),
        ("X=5 MOD 0", "nc-value", 5),
        ("X=SQRT[-1]", "nc-value", 3),
        ("X=TAN[90]", "nc-value", 3),
        ("X=0 ** -1", "nc-value", 5),
        ("X=DEXP[400]", "nc-value", 3),
        ("X=1.5 & 1", "nc-value", 7),
        ("X=P1[1.5]", "nc-value", 3),
        ("X=[1", "nc-syntax", 5),
        ("X=SIN 30", "nc-syntax", 7),
        ("X=SIN[1, 2]", "nc-syntax", 3),
        ("X=FOO[1]", "nc-syntax", 3),
    ] {
        assert_eq!(code(line), (wanted.to_owned(), column), "{line}");
    }
    assert_eq!(code(&format!("X={}1", "1+".repeat(10_000))).0, "nc-syntax");
    assert_eq!(code(&format!("X={}1", "[".repeat(100_000))).0, "nc-syntax");
    assert_eq!(code(&format!("X={}1", "-".repeat(100_000))).0, "nc-syntax");
}

/// SG-24, B24: the variables of axis coupling are read when everything before has been executed, and never written.
#[test]
fn variables_of_axis_coupling_are_read_and_never_written() {
    let mut channel = Channel::new(&[(
        "part.nc",
        "N10 G1 X1\nN20 $IF V.G.AX_LINK.ACTIVE\nN30 #AX LINK OFF[V.G.AX_LINK.NR]\nN40 $ENDIF\n",
    )]);
    let mut interpreter = Interpreter::new("PART.NC", false);
    channel.is_executed = false;
    assert!(matches!(interpreter.next(&mut channel), Ok(Prepared::Block(_))));
    let waiting = interpreter.clone();
    let Ok(Prepared::Waits(origin)) = interpreter.next(&mut channel) else { panic!() };
    assert_eq!((origin.number, &interpreter), (Some(20), &waiting));
    channel.is_executed = true;
    let rest = channel.go_on(&mut interpreter).unwrap();
    assert_eq!(rest[0].command, Some(crate::isg::language::Command::LinkOff(LinkOff::Group(3))));
    assert_eq!(code("V.G.AX_LINK.NR = 1"), ("nc-value".to_owned(), 1));
    assert_eq!(code("V.G.AX_LINK.ACTIVE = 0"), ("nc-value".to_owned(), 1));
}
