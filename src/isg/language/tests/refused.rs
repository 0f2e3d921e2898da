//! What a control refuses although each word can be read: functions that exclude each other, two signs, labels and branches that stand twice,
//! split commands. Where a control goes on with a warning, `lenient` does, too.

use super::{Channel, blocks, fault, program};
use crate::isg::language::{End, check};

/// The faults of a run, strict and lenient: name, line and column.
fn both(text: &str) -> [Option<(String, u32, u32)>; 2] {
    [false, true].map(|lenient| {
        let fault = Channel::new(&[("part.nc", text)]).run(lenient).err();
        fault.map(|fault| (fault.code.to_string(), fault.line, fault.column))
    })
}

/// What the check finds, strict or lenient: line, column, name, and whether it is a warning.
fn found(text: &str, lenient: bool) -> Vec<(u32, u32, String, bool)> {
    check(&program("part.nc", text), &[], lenient)
        .into_iter()
        .map(|finding| (finding.fault.line, finding.fault.column, finding.fault.code.to_string(), finding.is_warning))
        .collect()
}

/// 20108, 20116, 20117, 20127; and the programming manual: functions of a group exclude each other, G90 and G91 also if one stands twice.
#[test]
fn a_block_has_one_g_function_of_a_group() {
    for (line, code, column) in [
        ("N10 G02 G03 X1", "20108", 9),
        ("N20 G01 X10 G00 Y20", "20108", 13),
        ("G53 X10 Y10 G54", "20116", 13),
        ("G360 X100 G60", "20117", 11),
        ("G02 G162 I10 X20 G162", "20127", 18),
        ("G90 G91 X1", "nc-syntax", 5),
        ("N100 G90 Z30 G90", "nc-syntax", 14),
        ("G17 G18", "nc-syntax", 5),
        ("G41 G40", "nc-syntax", 5),
    ] {
        let wanted = Some((code.to_owned(), 1, column));
        assert_eq!(both(line), [wanted.clone(), wanted], "{line}");
        assert_eq!(found(line, false), [(1, column, code.to_owned(), false)], "{line}");
    }
    assert_eq!(blocks("G01 G91 G17 G40 G162 G60 G53 X1").remove(0).g, [1, 91, 17, 40, 162, 60, 53]);
}

/// PROG, modulo axes: two signs are possible only there. Which axis is one, only the channel knows.
#[test]
fn two_signs_behind_an_axis_are_noted_with_their_place() {
    let block = blocks("N10 G0 X1 C--5").remove(0);
    let noted: Vec<_> = block.two_signs.iter().map(|(name, fault)| (name.as_str(), fault.line, fault.column)).collect();
    assert_eq!(noted, [("C", 1, 11)]);
    for line in ["X-5", "X=--5", "X-[-5]", "X[-5]"] {
        assert_eq!(blocks(line).remove(0).two_signs, [], "{line}");
    }
    assert_eq!(found("N10 G0 X+ -5", false), [(1, 8, "nc-syntax".to_owned(), true)]);
}

#[test]
fn g74_needs_axes() {
    let wanted = Some(("nc-syntax".to_owned(), 1, 5));
    assert_eq!(both("N10 G74"), [wanted, None]);
    let warnings = Channel::new(&[("part.nc", "N10 G74")]).run(true).unwrap().remove(0).warnings;
    assert_eq!(warnings.iter().map(|fault| fault.code.to_string()).collect::<Vec<_>>(), ["20003"]);
}

#[test]
fn m17_ends_no_main_program_except_leniently() {
    assert_eq!(both("G1 X1\nN20 X2 M17"), [Some(("nc-syntax".to_owned(), 2, 8)), None]);
    let ends = Channel::new(&[("part.nc", "M17\nG1 X2")]).run(true).unwrap();
    assert_eq!(ends.iter().map(|block| block.end).collect::<Vec<_>>(), [Some(End::Program)]);
    // A file of its own may be a subroutine.
    assert_eq!(found("N10 G1 X1\nM17", false), []);
    let mut channel = Channel::new(&[("part.nc", "N10 L SUB\nM30"), ("sub.nc", "N20 X1\nM17")]);
    assert_eq!(channel.run(false).unwrap().len(), 3);
}

/// 20214, 20216: whichever branch runs, the line of the second `$ELSE` is refused when it is passed.
#[test]
fn a_second_else_is_refused_in_its_line() {
    for condition in [0, 1] {
        let text = |word: &str| format!("$IF {condition}\nX1\n$ELSE\nX2\n{word}\nX3\n$ENDIF");
        for (word, code) in [("  $ELSE", "20214"), ("  $ELSEIF 1", "20216")] {
            let wanted = Some((code.to_owned(), 5, 3));
            assert_eq!(both(&text(word)), [wanted.clone(), wanted]);
            assert_eq!(found(&text(word), true), [(5, 3, code.to_owned(), false)]);
        }
    }
    // That of a control block inside is another one.
    assert_eq!(found("$IF 1\n$ELSE\n$IF 1\n$ELSE\n$ENDIF\n$ENDIF", false), []);
    assert_eq!(blocks("$IF 0\n$ELSE\n$IF 0\n$ELSE\nX1\n$ENDIF\n$ENDIF").len(), 1);
    for (line, code) in [("$ELSE", "20214"), ("$ELSEIF 1", "20216"), ("$ENDIF", "20218")] {
        assert_eq!(fault(line).0, code);
        assert_eq!(found(line, false), [(1, 1, code.to_owned(), false)]);
    }
}

/// 20836: labels of a program level differ; a jump to one that stands twice ends the program. 20841: a block has one number.
#[test]
fn labels_and_block_numbers_stand_once() {
    let text = "N10: X1\n$GOTO N20\nX9\nN20: X2\nN20: X3";
    let wanted = Some(("20836".to_owned(), 2, 1));
    assert_eq!(both(text), [wanted.clone(), wanted]);
    assert_eq!(found(text, false), [(5, 1, "20836".to_owned(), false)]);
    assert_eq!(found("[A] X1\n [a] X2", false), [(2, 2, "20836".to_owned(), false)]);
    // N20 without a colon is no label, and subroutines have labels of their own.
    assert_eq!(found("%L UP\nN20: X1\nM17\n%MAIN\nN20: X1\nN20 X2\n$GOTO N20", false), []);
    let wanted = Some(("20841".to_owned(), 1, 6));
    assert_eq!(both("N100 N100: X1"), [wanted.clone(), wanted]);
    assert_eq!(found("N100 N100: X1", false), [(1, 6, "20841".to_owned(), false)]);
}

/// 20375: a branch that runs over the end of its program is a warning of a control; 21501: a skipped one ends it.
#[test]
fn an_if_without_its_end_runs_only_leniently() {
    let text = |condition| format!("N10 X1\n$IF {condition}\nN30 X3\nM30");
    let refused = |code: &str| Some((code.to_owned(), 2, 1));
    assert_eq!(both(&text(1)), [refused("nc-syntax"), None]);
    assert_eq!(both(&text(0)), [refused("nc-syntax"), refused("21501")]);
    let blocks = Channel::new(&[("part.nc", &text(1))]).run(true).unwrap();
    let warnings: Vec<_> = blocks.iter().map(|block| block.warnings.len()).collect();
    assert_eq!((warnings, blocks[2].warnings[0].code.to_string()), (vec![0, 0, 1], "20375".to_owned()));
    assert_eq!(found(&text(1), false), [(2, 1, "nc-syntax".to_owned(), false)]);
    assert_eq!(found(&text(1), true), [(2, 1, "20375".to_owned(), true)]);
    let local = "%L UP\n$IF 0\nX1\nM17\n%MAIN\nLL UP\nM30";
    assert_eq!(both(local)[1], refused("21500"));
    let mut global = Channel::new(&[("part.nc", "L SUB\nM30"), ("sub.nc", "N20 X1\n$IF 0\nM17")]);
    assert_eq!(global.run(true).unwrap_err().code.to_string(), "21502");
}

/// PROG, line break: commands of the additional functions are not split.
#[test]
fn a_hash_command_stands_in_one_line() {
    let text = "N10 X1\nN20 #SET AX LINK[1, \\\nY2=Y1]";
    let wanted = Some(("nc-syntax".to_owned(), 2, 21));
    assert_eq!(both(text), [wanted.clone(), wanted]);
    assert_eq!(found(text, false), [(2, 21, "nc-syntax".to_owned(), false)]);
    assert_eq!(found("N10 #TIME 1 (\\ in a comment)", false), []);
}
