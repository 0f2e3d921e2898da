//! Frames with offsets: CTRANS, `$P_PFRAME`, variables of type FRAME; words of the language in a wrong place; M functions that a subprogram
//! replaces.

use super::{Channel, alarm, path, r, run, run_in};
use crate::nc_program::AuxiliaryKind;

/// The offsets of the last block, by the names of their axes.
fn offsets(text: &str) -> Vec<(String, f64)> {
    let blocks = run(text);
    let axes = Channel::new().axes;
    let mut found: Vec<_> =
        blocks.last().unwrap().offset.iter().map(|(axis, value)| (axes.name(*axis).to_owned(), *value)).collect();
    found.sort_by(|one, other| one.0.cmp(&other.0));
    found
}

#[test]
fn ctrans_is_an_offset_and_a_chain_of_frames_is_their_sum() {
    let x_y = |x: f64, y: f64| vec![("X".to_owned(), x), ("Y".to_owned(), y)];
    assert_eq!(offsets("$P_PFRAME=CTRANS(X,10,Y,R1+20)\nM30"), x_y(10.0, 20.0));
    assert_eq!(offsets("DEF FRAME AB=CTRANS(X,1)\n$P_PFRAME=AB:CTRANS(X,2,Y,5):CTRANS(Y,-1)\nM30"), x_y(3.0, 4.0));
    // As TRANS it replaces what was there; CTRANS() has no offsets.
    assert_eq!(offsets("TRANS X5 Z5\n$P_PFRAME=CTRANS(X,1,Y,2)\nM30"), x_y(1.0, 2.0));
    assert_eq!(offsets("TRANS X5\n$P_PFRAME=CTRANS()\nM30"), vec![]);
    assert_eq!(offsets("TRANS X5 Y1\n$P_PFRAME[X,TR]=7\nM30"), x_y(7.0, 1.0));
    assert_eq!(offsets("$P_PFRAME=CTRANS(X,1)\nATRANS X2 Y3\nM30"), x_y(3.0, 3.0));
}

/// G70 and G71 act where TRANS is programmed: 2 inches are 50.8 mm, whatever holds later. A rotary axis has no inches.
#[test]
fn an_offset_is_the_length_that_it_was_when_it_was_programmed() {
    let x = |x: f64| vec![("X".to_owned(), x)];
    assert_eq!(offsets("G70 TRANS X2\nG71 G0 X1\nM30"), x(50.8));
    assert_eq!(offsets("TRANS X2\nG70 ATRANS X1\nG710 G0 X1\nM30"), x(27.4));
    assert_eq!(offsets("G700 TRANS C90\nG0 X1\nM30"), vec![("C".to_owned(), 90.0)]);
    // System variables have millimetres.
    assert_eq!(r("G70 TRANS X2\nR1=$P_PFRAME[X,TR]\n$P_PFRAME[X,TR]=7\nR2=$P_PFRAME[X,TR]\nM30", 2), [50.8, 7.0]);
}

#[test]
fn variables_of_type_frame_have_offsets_of_axes() {
    assert_eq!(
        r("DEF FRAME AB[2]\nAB[1]=CTRANS(X,3)\nAB[1,Y,TR]=4\nR1=AB[1,X,TR] R2=AB[1,Y,TR] R3=AB[0,X,TR]\nM30", 3),
        [3.0, 4.0, 0.0]
    );
    assert_eq!(r("TRANS X5\nR1=$P_PFRAME[X,TR] R2=$P_PFRAME[Y,TR]\nM30", 2), [5.0, 0.0]);
    // A variable of another type may have the name of a part.
    assert_eq!(r("DEF INT TR=1, AB[2]=SET(5,6)\nR1=AB[TR]\nM30", 1), [6.0]);
    let mut channel = Channel::new()
        .with("PART.MPF", "DEF FRAME AB\nSUB(AB)\nR1=AB[X,TR]\nM30")
        .with("SUB.SPF", "PROC SUB(VAR FRAME OF_CALLER)\nOF_CALLER=CTRANS(X,8)\nM17");
    assert_eq!(run_in(&mut channel).1, None);
    assert_eq!(channel.r[1], 8.0);
}

#[test]
fn frames_have_only_offsets_and_only_fit_frames() {
    for (text, number) in [
        ("$P_PFRAME=CROT(Z,45)", 12553),
        ("$P_PFRAME=CTRANS(X,1):CMIRROR(X)", 12553),
        ("R1=$P_PFRAME[X,RT]", 12553),
        ("R1=CTRANS(X,1)", 12150),
        ("$P_PFRAME=5", 12150),
        ("$P_PFRAME=CTRANS(X)", 14020),
        ("$P_PFRAME=CTRANS(X,1,X,2)", 14020),
        ("$P_PFRAME=CTRANS(1,2)", 12040),
        ("R1=$P_PFRAME[X]", 12400),
        ("R1=1:2", 12150),
        ("MSG(<<CTRANS(X,1))", 12150),
    ] {
        assert_eq!(alarm(&format!("{text}\nM30")).number, number, "{text}");
    }
}

#[test]
fn set_and_rep_assign_values_from_an_element_on() {
    assert_eq!(
        r("DEF REAL AB[5]\nAB[1]=SET(10,,30)\nAB[4]=7\nR1=AB[1] R2=AB[2] R3=AB[3] R4=AB[4]\nM30", 4),
        [10.0, 0.0, 30.0, 7.0]
    );
    assert_eq!(r("R[2]=SET(5,6)\nR[4]=REP(9,2)\nM30", 5), [0.0, 5.0, 6.0, 9.0, 9.0]);
    assert_eq!(
        r(
            "DEF INT AB[2,2]=REP(3,2), CD[3]=SET(1,,2)\nR1=AB[0,1] R2=AB[1,0] R3=CD[2]\nAB[0,1]=REP(8)\nR4=AB[1,1]\nM30",
            4
        ),
        [3.0, 0.0, 2.0, 8.0]
    );
    for (text, number) in [
        ("DEF INT AB[2]\nAB[1]=SET(1,2)", 12260),
        ("DEF INT AB[2]\nAB[0]=REP(1,3)", 12260),
        ("DEF INT AB[2]=REP(1,3)", 12260),
        ("R1=5+SET(1)", 12550),
        ("DEF INT AB[2]\nAB[0]=SET(\"A\")", 12150),
    ] {
        assert_eq!(alarm(&format!("{text}\nM30")).number, number, "{text}");
    }
    // Nothing is written when one value does not fit.
    let mut channel = Channel::new().with("PART.MPF", "R[1]=SET(1,2,\"A\")\nM30");
    assert_eq!(run_in(&mut channel).1.unwrap().number, 12150);
    assert_eq!(channel.r[1..3], [0.0, 0.0]);
}

#[test]
fn a_word_of_the_language_in_a_wrong_place_is_a_syntax_error() {
    for text in [
        "G0 X1 ENDIF",
        "R1=IF",
        "X1 GOTOF AB",
        "R1=STOPRE",
        "R1=5+DIV",
        "X=TO",
        "IF ELSE",
        "G0 SAVE",
        "SAVE",
        "R1=G0",
        "X1 POS",
        "X1 SIN",
        "DEF REAL IF",
        "WHILE=5",
        "UNTIL",
        "FOR R1=1 5",
        "R1=BRISK",
        "TO X5",
        "X1 AND Y1",
    ] {
        let found = alarm(&format!("{text}\nM30"));
        assert_eq!(found.number, 12080, "{text}: {found}");
    }
    assert_eq!(alarm("X1 NOWORD\nM30").number, 12550);
}

#[test]
fn a_subprogram_replaces_an_m_function_behind_its_block() {
    // The test channel replaces M60 by SUB. In SUB M60 is a function.
    let mut channel = Channel::new().with("PART.MPF", "G0 X1 M60 M7\nX3\nM30").with("SUB.SPF", "X2 M60\nM17");
    let (blocks, alarm) = run_in(&mut channel);
    assert_eq!(alarm, None);
    assert_eq!(path(&blocks), "X1 X2 X3");
    let m = |block: usize| -> Vec<f64> {
        blocks[block].auxiliary.iter().filter(|one| one.kind == AuxiliaryKind::M).map(|one| one.value).collect()
    };
    assert_eq!((m(0), m(1)), (vec![7.0], vec![60.0]));
}
