//! Files and blocks, numbers and addresses.

use super::{Channel, alarm, interpreter, path, r, run, run_in};
use crate::nc_program::{AuxiliaryKind, Prepared};

#[test]
fn numbers_have_their_forms() {
    for (text, value) in [
        ("5", 5.0),
        ("-.5", -0.5),
        ("3.", 3.0),
        ("1.2EX-3", 0.0012),
        ("1.2ex+2", 120.0),
        ("2EX3", 2000.0),
        ("'H1F'", 31.0),
        ("'hFFFFFFFF'", -1.0),
        ("'B101'", 5.0),
        ("+7", 7.0),
        ("- -7", 7.0),
        ("'A'", 65.0),
        ("4000000000", 4e9),
    ] {
        assert_eq!(r(&format!("R1={text}\nM30"), 1), [value], "{text}");
    }
    for wrong in ["'H1G'", "'B2'", "'HFFFFFFFFF'", "'H+1'", "1.2.3", "."] {
        assert_eq!(alarm(&format!("R1={wrong}\nM30")).number, 12080, "{wrong}");
    }
}

#[test]
fn words_need_no_blanks_and_may_have_them() {
    for text in ["G0X10Y-5Z.5", "G0 X10 Y-5 Z.5", "g00 x10 y-5 z.5", "G0 X 10 Y - 5 Z=.5", "Y-5 Z.5 G0 X10"] {
        let blocks = run(&format!("{text}\nM30"));
        let mut words: Vec<_> = path(&blocks).split(' ').map(str::to_owned).collect();
        words.sort();
        assert_eq!(words, ["X10", "Y-5", "Z0.5"], "{text}");
        assert_eq!(blocks[0].modal.index(1), 1, "{text}");
    }
    assert_eq!(path(&run("G0 X1.5EX1Y2\nM30")), "X15 Y2");
}

#[test]
fn names_of_several_letters_or_with_digits_need_an_equals_sign() {
    assert_eq!(path(&run("G0 X1=10 XF=5\nM30")), "X110 XF5", "the axis X1 gets 10");
    // Without `=` the digit is the value: X1 is the axis X at 1.
    assert_eq!(path(&run("G0 X1 Y2\nM30")), "X1 Y2");
    assert_eq!(alarm("G0 XF5\nM30").number, 12550);
    assert_eq!(alarm("G0 XF 5\nM30").number, 12080);
}

#[test]
fn extended_addresses_have_an_extension() {
    let blocks = run("M2=3 S1=500 H5=1.5 T=7\nM=5 M[2]=4\nM30");
    let found: Vec<_> =
        blocks.iter().flat_map(|block| &block.auxiliary).map(|one| (one.kind, one.extension, one.value)).collect();
    let (m, s) = (AuxiliaryKind::M, AuxiliaryKind::S);
    assert_eq!(
        found,
        [
            (m, Some(2), 3.0),
            (s, Some(1), 500.0),
            (AuxiliaryKind::H, Some(5), 1.5),
            (AuxiliaryKind::T, None, 7.0),
            (m, None, 5.0),
            (m, Some(2), 4.0),
            (m, None, 30.0),
        ]
    );
    // M2=30 is M30 with the extension 2: no end of program.
    assert_eq!(alarm("M2=30").number, 14000);
}

#[test]
fn comments_blank_lines_and_lone_numbers_have_no_effect() {
    let blocks = run("; a comment\n\nN10\nN20 ; X99\nAB:\nN30 G0 X5 ; Y5 (no comment)\nMSG(\"a;b\")\nM30");
    assert_eq!((blocks.len(), path(&blocks).as_str()), (3, "X5"));
    assert_eq!(blocks[0].origin.name, "N30");
    assert_eq!(blocks[0].origin.line, 6);
    // Parentheses are no comments.
    assert_eq!(alarm("X5 (no comment)\nM30").number, 12080);
}

#[test]
fn block_numbers_need_no_order() {
    let blocks = run("N20 G0 X1\nN10 X2\nN10 X3\n:5 X4\nAB: X5\nX6\nM30");
    let names: Vec<_> = blocks.iter().map(|block| block.origin.name.as_str()).collect();
    assert_eq!(names, ["N20", "N10", "N10", ":5", "AB", "6", "7"]);
}

#[test]
fn skip_levels_skip_their_blocks_only() {
    let text = "G0\n/ X0\n/0 X1\n/1 X2\n/9 N90 X9\nM30";
    let mut channel = Channel::new().with("PART.MPF", text);
    assert_eq!(path(&run_in(&mut channel).0), "X0 X1 X2 X9");
    channel.skipped = vec![0, 9];
    let (blocks, alarm) = run_in(&mut channel);
    assert_eq!((path(&blocks).as_str(), alarm), ("X2", None));
    assert_eq!(blocks[1].origin.skip, Some(1));
    // A skipped block is not read: its errors do not appear.
    let mut channel = Channel::new().with("PART.MPF", "/1 G999 X\nM30");
    channel.skipped = vec![1];
    assert_eq!(run_in(&mut channel).1, None);
}

#[test]
fn an_error_appears_when_its_block_is_reached() {
    let mut channel = Channel::new().with("PART.MPF", "G0 X1\nG999\nM30");
    let mut interpreter = interpreter();
    assert!(matches!(interpreter.next(&mut channel), Ok(Prepared::Block(_))));
    assert_eq!(interpreter.next(&mut channel).unwrap_err().number, 12470);
    // A wrong block that is jumped over is never noticed.
    run("GOTOF AB\nG999\n\"\nAB: M30");
    run("IF FALSE\nG999 ))\nENDIF\nM30");
}

#[test]
fn an_assignment_shares_its_block_only_with_assignments() {
    assert_eq!(r("R1=1 R2=R1+1 R3=R2+1\nM30", 3), [1.0, 2.0, 3.0]);
    for text in ["R1=1 X5", "R1=1 M5", "R1=10 M=R1", "X5 R1=1"] {
        assert_eq!(alarm(&format!("{text}\nM30")).number, 12080, "{text}");
    }
}

#[test]
fn the_end_of_the_program_is_its_last_block() {
    for end in ["M30", "M2", "M17", "X5 M30"] {
        let blocks = run(&format!("G0 X1\n{end}\nG999"));
        assert_eq!(blocks.len(), 2, "{end}");
    }
}

#[test]
fn blocks_of_mda_need_no_end() {
    let mut channel = Channel::new().with("PART.MPF", "G0 X1\nX2");
    let mut interpreter =
        crate::nc_program::Interpreter::new("PART.MPF", crate::nc_program::Modal::default(), None, true);
    let mut blocks = Vec::new();
    while let Prepared::Block(block) = interpreter.next(&mut channel).unwrap() {
        blocks.push(*block);
    }
    assert_eq!((path(&blocks).as_str(), interpreter.has_ended()), ("X1 X2", true));
}
