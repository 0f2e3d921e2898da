//! Control blocks.

use super::{Channel, blocks, fault};
use crate::isg::language::{Interpreter, Prepared};

/// The values of X in the order of their blocks.
fn trace(text: &str) -> String {
    let values: Vec<String> =
        blocks(text).iter().flat_map(|block| &block.axes).map(|(_, value)| value.to_string()).collect();
    values.join(" ")
}

#[test]
fn if_takes_the_first_branch_whose_condition_is_at_least_a_half() {
    for (value, wanted) in [("1", "1"), ("-0.5", "1"), ("0.4", "4"), ("0", "4")] {
        assert_eq!(trace(&format!("P1={value}\n$IF P1\nX1\n$ELSE\nX4\n$ENDIF")), wanted, "{value}");
    }
    let text =
        |value| format!("P1={value}\n$IF P1 == 0\nX1\n$ELSEIF P1 >= 5\nX2\n$ELSEIF P1 > 2\nX3\n$ELSE\nX4\n$ENDIF\nX9");
    assert_eq!([0, 5, 3, 1].map(|value| trace(&text(value))), ["1 9", "2 9", "3 9", "4 9"]);
    assert_eq!(trace("$IF 0\nX1\n$ENDIF\nX2"), "2");
}

/// A branch that is not taken is read only for control blocks.
#[test]
fn a_branch_that_is_not_taken_is_not_read() {
    assert_eq!(trace("$IF 0\nXY\n$IF 1\nfoo\n$ELSE\nbar\n$ENDIF\n#FOO\n$ELSE\nX2\n$ENDIF"), "2");
}

#[test]
fn switch_compares_with_a_tolerance_and_runs_on_without_break() {
    let text = |value| {
        format!(
            "$SWITCH P1=INT[{value}]\n$CASE 1\nX1\n$BREAK\n$CASE 1+1\nX2\n$CASE 3\nX3\n$BREAK\n$DEFAULT\nX4\n$ENDSWITCH\nX=P1"
        )
    };
    assert_eq!([1, 2, 3, -7].map(|value| trace(&text(value))), ["1 1", "2 3 2", "3 3", "4 -7"]);
    assert_eq!(trace("$SWITCH 1.0005\n$CASE 1\nX1\n$ENDSWITCH\n$SWITCH 1.002\n$CASE 1\nX2\n$ENDSWITCH"), "1");
}

#[test]
fn loops_count_and_test() {
    assert_eq!(trace("$FOR P1= 1, 7, 3\nX=P1\n$ENDFOR\nX=P1"), "1 4 7 10");
    assert_eq!(trace("$FOR P1= 3, 1, -1\nX=P1\n$ENDFOR"), "3 2 1");
    assert_eq!(trace("$FOR P1= 3, 1, 1\nX=P1\n$ENDFOR\nX9"), "9");
    assert_eq!(trace("$FOR V.L.I[2] = 1, 2, 1\n$FOR P2=1,2,1\nX=V.L.I[2]*10+P2\n$ENDFOR\n$ENDFOR"), "11 12 21 22");
    assert_eq!(trace("P1=0\n$WHILE P1 < 3\nX=P1 P1=P1+1\n$ENDWHILE\nX9"), "0 1 2 9");
    assert_eq!(trace("P2=10 P1=8\n$REPEAT\nP1=P1+1\nXP1\n$UNTIL P1 > P2\nX0"), "9 10 11 0");
    assert_eq!(trace("P1=9\n$DO\nX=P1 P1=P1+1\n$ENDDO P1 < 3\nX0"), "9 0");
    assert_eq!(
        trace("P1=0\n$DO\nP1=P1+1\n$IF P1 == 2\n$CONTINUE\n$ENDIF\nX=P1\n$IF P1 > 3\n$BREAK\n$ENDIF\n$ENDDO\nX0"),
        "1 3 4 0"
    );
    assert_eq!(trace("$FOR P1=1,4,1\n$IF P1 == 2\n$CONTINUE\n$ENDIF\nX=P1\n$ENDFOR"), "1 3 4");
}

#[test]
fn jumps_find_labels_of_their_level_in_both_directions() {
    assert_eq!(trace("P1=0\nN20: X=P1 P1=P1+1\n$IF P1 < 3 $GOTO N20\nX9"), "0 1 2 9");
    assert_eq!(trace("X1 $GOTO [End]\nX2\n[END] X3"), "1 3");
    assert_eq!(trace("$GOTO [IN]\nX1\n$IF 0\nX2\n[IN] X3\n$ELSE\nX4\n$ENDIF\nX5"), "3 5");
    assert_eq!(trace("$FOR P1=1,3,1\n$IF P1 == 2\n$GOTO [OUT]\n$ENDIF\nX=P1\n$ENDFOR\n[OUT]\nX9"), "1 9");
    // N20 without a colon is no label.
    for (text, code, line) in [
        ("$GOTO N20\nN20 X1", "nc-syntax", 1),
        ("$GOTO [A]\nX1\n%L UP\n[A] X1", "nc-syntax", 1),
        ("$GOTO [A]\n$DO\n[A] X1\n$ENDDO", "nc-syntax", 1),
        ("$GOTO A", "20839", 1),
    ] {
        let (found, number, ..) = fault(text);
        assert_eq!((found.as_str(), number), (code, line), "{text}");
    }
}

#[test]
fn control_blocks_that_do_not_fit_are_refused() {
    for (text, line) in [
        ("X1\n$IF 1\nX1", 2),
        ("$WHILE 0\n$IF 1\n$ENDWHILE\n$ENDIF", 1),
        ("$BREAK", 1),
        ("$IF 1\n$CONTINUE\n$ENDIF", 2),
        ("$FOR P1=1,2\n$ENDFOR", 1),
        ("$FOR X=1,2,1\n$ENDFOR", 1),
        ("$FOO", 1),
        ("$IF", 1),
        ("$IF 1 X1\n$ENDIF", 1),
        ("X1 $IF 1\n$ENDIF", 1),
        ("$CASE 1", 1),
        ("$UNTIL 1", 1),
    ] {
        let (code, number, ..) = fault(text);
        assert_eq!((code.as_str(), number), ("nc-syntax", line), "{text}");
    }
}

#[test]
fn control_blocks_are_nested_fifty_deep_at_most() {
    let nested = |depth: usize| format!("{}X1\n{}", "$IF 1\n".repeat(depth), "$ENDIF\n".repeat(depth));
    assert_eq!(trace(&nested(50)), "1");
    let (code, line, ..) = fault(&nested(51));
    assert_eq!((code.as_str(), line), ("20211", 51));
}

#[test]
fn an_endless_loop_does_not_hold_the_channel() {
    let mut channel = Channel::new(&[("part.nc", "$WHILE 1\nP1=1\n$ENDWHILE")]);
    let mut interpreter = Interpreter::new("PART.NC", false);
    for _ in 0..3 {
        assert!(matches!(interpreter.next(&mut channel), Ok(Prepared::Calculated(_))));
    }
}
