//! Subroutines and the beginning of programs.

use super::{Channel, blocks, code, fault};
use crate::isg::language::{DEEPEST_CALL, End};

fn order(files: &[(&str, &str)]) -> Vec<u32> {
    Channel::new(files).run(false).unwrap().iter().map(|block| block.origin.block()).collect()
}

#[test]
fn local_subroutines_stand_before_or_behind_the_main_program() {
    let before =
        "%L UP1\nN10 X1\nN20 M17\n%L UP2\nN30 X1\n%MAIN\nN40 G1 LL UP1\nN50 LL UP2\nN60 LL up1\nN70 M30\nN80 X1";
    // UP2 ends with the next header; N50 and N60 only call.
    assert_eq!(order(&[("part.nc", before)]), [40, 10, 20, 30, 10, 20, 70]);
    assert_eq!(order(&[("part.nc", "#COMMENT BEGIN\nX1\n#COMMENT END\n%L UP\nX1\n%MAIN\nN10 X1")]), [10]);
    let behind = "N40 LL UP1\nN50 X5\nN60 M30\n%L UP1\nN10 X1\nN20 M29\nN25 X2";
    assert_eq!(order(&[("part.nc", behind)]), [10, 20, 50, 60]);
}

/// Diagnosis 20193 and 21313: `%` marks names of programs, and a main program that is being executed has none in it.
#[test]
fn a_main_program_that_reaches_a_percent_sign_is_aborted() {
    for (text, line) in [
        ("%MAIN\nN10 G0 X0\nN20 X1\n%L SUB1\nN30 X2", 4),
        ("%A\nN10 X1\n%B\nN20 X2", 3),
        ("N10 X1\n  %L UP\nM17\n%MAIN\nM30", 2),
        // A block number before the first % begins a main program.
        ("N10 (comment)\n%L UP1\nM17\n%MAIN\nN20 X1", 2),
    ] {
        let (code, number, column, _) = fault(text);
        assert_eq!((code.as_str(), number), ("20193", line), "{text}");
        assert_eq!(column, if line == 2 && text.contains("  %") { 3 } else { 1 });
    }
    let files = [("part.nc", "N10 L SUB\nN20 M30"), ("sub.nc", "N30 X1\n%L UP\nM17")];
    assert_eq!(Channel::new(&files).run(false).unwrap_err().code.to_string(), "21313");
    // What is never reached is no error.
    assert_eq!(order(&[("part.nc", "(text)\n\n%A\nN10 X1\nN20 M30\n%B\nN30 X2")]), [10, 20]);
}

#[test]
fn global_subroutines_are_files_with_subroutines_of_their_own() {
    let files = [
        ("part.nc", "N10 L SUB.NC\nN20 L \"other\"\nN30 L4712\nN40 M30"),
        ("sub.nc", "%L IN\nN110 X1\nM17\n%SUB\nN100 LL IN\nN120 M17\nN130 X1"),
        ("other.nc", "N200 X1"),
        ("4712", "N300 X1\nN310 M29"),
    ];
    // The M17 of IN has no number: its line is 3.
    assert_eq!(order(&files), [110, 3, 120, 200, 300, 310, 40]);
}

/// A block with words and a call: the words are executed first; nothing may stand behind the call.
#[test]
fn a_call_is_the_last_word_of_its_block() {
    assert_eq!(order(&[("part.nc", "N10 X1 LL UP\nN20 M30\n%L UP\nN30 X2")]), [10, 30, 20]);
    assert_eq!(code("N10 LL UP X1"), ("21542".to_owned(), 11));
    for call in ["L CYCLE", "L CYCLE [1]", "LL CYCLE [NAME=UP @P1=2]"] {
        let (code, _, column, text) = fault(&format!("N10 {call}"));
        assert_eq!((code.as_str(), column), ("nc-syntax", 5));
        assert!(text.starts_with("calls of cycles"), "{text}");
    }
}

#[test]
fn a_missing_subroutine_and_endless_calls_are_refused() {
    assert_eq!(code("N10 X1 LL NOWHERE"), ("nc-call".to_owned(), 8));
    assert_eq!(code("N10 L NOWHERE"), ("nc-call".to_owned(), 5));
    // The fault is that of the innermost block.
    let (code, line, _, text) = fault("N10 LL UP\nM30\n%L UP\nLL UP\nM17");
    assert_eq!((code.as_str(), line), ("nc-call", 4));
    assert_eq!(text, format!("subroutines are nested more than {DEEPEST_CALL} deep; does one call itself?"));
    // Just as deep as is allowed: UP calls itself while P1 counts.
    let text = format!("P1=1\nLL UP\nM30\n%L UP\nX=P1 P1=P1+1\n$IF P1 <= {DEEPEST_CALL}\nLL UP\n$ENDIF\nM17");
    assert_eq!(blocks(&text).len(), 2 * DEEPEST_CALL + 1);
}

#[test]
fn m30_in_a_subroutine_aborts_the_program() {
    let blocks = blocks("LL UP\nX3\n%L UP\nX1 M30\nX2");
    assert_eq!((blocks.len(), blocks[0].end), (1, Some(End::Aborted)));
}

#[test]
fn v_l_variables_belong_to_a_level_and_p_parameters_to_the_program() {
    let (code, line, ..) = fault("P1=1 V.L.A=1\nLL UP\n%L UP\nX=P1\nX=V.L.A");
    assert_eq!((code.as_str(), line), ("nc-value", 5));
}

#[test]
fn a_file_of_subroutines_has_no_main_program() {
    let (code, line, column, text) = fault("%L A\nM17\n%L B\nM17\n(end)");
    assert_eq!((code.as_str(), line, column), ("nc-syntax", 3, 1));
    assert!(text.starts_with("the file has subroutines and no main program"), "{text}");
    assert_eq!(order(&[("part.nc", "%L A\nM17\n%\nN10 X1")]), [10]);
    assert_eq!(fault("%L\nX1").1, 1);
    assert_eq!(fault("%A B\nX1").1, 1);
}
