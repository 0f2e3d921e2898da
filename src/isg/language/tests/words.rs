//! Words and their values.
#![expect(clippy::float_cmp, reason = "the values are exact")]

use super::{Channel, blocks, code, fault};
use crate::isg::language::{Dwell, End, Prepared};

fn axes(text: &str) -> Vec<(String, f64)> {
    blocks(text).remove(0).axes
}

fn named(values: &[(&str, f64)]) -> Vec<(String, f64)> {
    values.iter().map(|(name, value)| ((*name).to_owned(), *value)).collect()
}

/// SG-13, B38: words as the tool-change program has them.
#[test]
fn words_have_letters_names_and_values() {
    let block = blocks("N300 G01 G91 X20 Y20 Z-40 C50 Y_S=20 Z_S = -40 C_S=50 F300").remove(0);
    assert_eq!((block.origin.number, block.origin.block(), block.g), (Some(300), 300, vec![1, 91]));
    let wanted = [("X", 20.0), ("Y", 20.0), ("Z", -40.0), ("C", 50.0), ("Y_S", 20.0), ("Z_S", -40.0), ("C_S", 50.0)];
    assert_eq!((block.axes, block.feed), (named(&wanted), Some(300.0)));
    let block = blocks("G02 X20 Y20 I10 J-10.5 K.5").remove(0);
    assert_eq!((block.centre, block.origin.block()), ([Some(10.0), Some(-10.5), Some(0.5)], 1));
    let block = blocks("T10 D10 S1000 H4 M3 M08").remove(0);
    assert_eq!(
        (block.tool, block.tool_data, block.spindle, block.h, block.m),
        (Some(10.0), Some(10.0), Some(1000.0), vec![4], vec![3, 8])
    );
}

#[test]
fn a_value_is_a_number_or_an_expression_with_or_without_an_equals_sign() {
    for (line, value) in [
        ("X20", 20.0),
        ("X=47", 47.0),
        ("X = -4.5", -4.5),
        ("X[2 + 3]", 5.0),
        ("X SIN [30]", 0.5),
        ("X--40", 40.0),
        ("P1=7 XP1", 7.0),
        ("P1=7 X=P1*2", 14.0),
        ("G1X20M8", 20.0),
        ("n10 g1 X20 f100 p1=2", 20.0),
        ("p1=3 X=p1", 3.0),
    ] {
        assert_eq!(axes(line), named(&[("X", value)]), "{line}");
    }
    assert_eq!(axes("Axis_X1=11 A12=3"), named(&[("Axis_X1", 11.0), ("A12", 3.0)]));
    // Only a name of one letter can do without `=`.
    assert_eq!(axes("A12"), named(&[("A", 12.0)]));
    assert_eq!(code("Y_S20"), ("nc-syntax".to_owned(), 1));
}

#[test]
fn what_is_no_word_is_refused_with_its_column() {
    for (line, wanted, column) in [
        ("G01 XX", "nc-syntax", 5),
        ("N10 master and slave", "nc-syntax", 5),
        ("Default", "nc-syntax", 1),
        ("x10", "nc-syntax", 1),
        ("G", "nc-syntax", 1),
        ("M70000", "nc-syntax", 1),
        ("X10 X20", "nc-syntax", 5),
        ("F100 F200", "nc-syntax", 6),
        ("X1.2.3", "nc-syntax", 2),
        ("E100", "nc-syntax", 1),
        ("L", "nc-syntax", 2),
        ("LINK 3", "nc-syntax", 1),
        ("P1 X2", "nc-syntax", 4),
        ("P0=1", "nc-syntax", 1),
        (":", "nc-syntax", 1),
        (") G1", "nc-syntax", 1),
        ("N99999999999 G1", "nc-syntax", 1),
        ("/11 G1", "nc-syntax", 2),
        ("X=1/0", "nc-value", 4),
        ("X=P9", "nc-value", 3),
        ("X=V.E.NOTHING", "nc-value", 3),
        ("H1.5", "nc-value", 1),
        ("G201", "nc-syntax", 1),
    ] {
        assert_eq!(code(line), (wanted.to_owned(), column), "{line}");
    }
}

#[test]
fn a_message_says_what_was_found_and_what_is_allowed() {
    let (_, _, _, text) = fault("Y_S 20");
    assert_eq!(
        text,
        "`Y_S` is not a word of an NC block: the name of an axis needs `=` and a value (`Y_S=20`), a name of one letter a value (`X20`)"
    );
    let fault = Channel::new(&[("part.nc", "G1\nN20 X=\n")]).run(false).unwrap_err();
    assert_eq!((fault.block, fault.number(), fault.line, fault.column), (Some(20), 20, 2, 7));
    assert_eq!(
        fault.to_string(),
        "nc-syntax: block N20: expected a number, `[`, a P parameter, a V. variable or a function; found the end of the line"
    );
}

#[test]
fn nothing_of_a_faulty_block_is_executed_and_the_program_ends() {
    let mut channel = Channel::new(&[("part.nc", "P1=1\nP1=2 V.E.OUT=5 X=1/0\nG1 X1\n")]);
    let mut interpreter = crate::isg::language::Interpreter::new("PART.NC", false);
    let fault = interpreter.next(&mut channel).unwrap_err();
    assert_eq!((fault.line, interpreter.variable("P1"), channel.variables["V.E.OUT"]), (2, Some(1.0), 0.0));
    assert!(interpreter.has_ended());
    assert_eq!(interpreter.next(&mut channel), Ok(Prepared::Ended));
    // The second variable cannot be written, so the first one is not written either.
    for line in ["V.E.OUT=5 V.E.NOTHING=1", "V.E.OUT=5 V.S.KEPT=101", "V.E.OUT=5 V.G.AX_LINK.NR=1"] {
        let mut channel = Channel::new(&[("part.nc", line)]);
        assert_eq!(channel.run(false).unwrap_err().code.to_string(), "nc-value", "{line}");
        assert_eq!(channel.variables["V.E.OUT"], 0.0, "{line}");
    }
}

#[test]
fn a_dwell_time_is_in_seconds_and_alone() {
    let dwell = |line: &str| blocks(line).remove(0).dwell.unwrap();
    for (line, seconds, axis) in [
        ("G04 X4.5", 4.5, Some("X")),
        ("G04 3.0", 3.0, None),
        ("G4 .5", 0.5, None),
        ("P1=2\nG04 P1", 2.0, None),
        ("V.L.TIME=3.5\nG04 V.L.TIME", 3.5, None),
        ("#TIME 2.5", 2.5, None),
        ("P1=2\n#TIME P1", 2.0, None),
    ] {
        assert_eq!(dwell(line), Dwell { seconds, axis: axis.map(str::to_owned) }, "{line}");
    }
    for (line, wanted, column) in [
        ("G04 10 X2", "20013", 5),
        ("G04", "nc-syntax", 1),
        ("G04 S10", "nc-syntax", 5),
        ("G04 2 F100", "nc-syntax", 7),
        ("G01 G04 2", "nc-syntax", 1),
        ("G04 -1", "nc-value", 5),
        ("#TIME -1", "nc-value", 7),
    ] {
        assert_eq!(code(line), (wanted.to_owned(), column), "{line}");
    }
    let block = blocks("G04 X2 Y3").remove(0);
    let warnings: Vec<_> = block.warnings.iter().map(|warning| (warning.code.to_string(), warning.column)).collect();
    assert_eq!(
        (block.dwell, warnings),
        (Some(Dwell { seconds: 2.0, axis: Some("X".to_owned()) }), vec![("20685".to_owned(), 8)])
    );
}

/// HG-30: the numbers are the order.
#[test]
fn g74_has_an_order_and_no_positions() {
    let block = blocks("G74 X2 Y3 Z1 Axis_X1=1").remove(0);
    let order: Vec<_> = block.homing.iter().map(|(name, order)| (name.as_str(), *order)).collect();
    assert_eq!((order, block.axes), (vec![("X", 2), ("Y", 3), ("Z", 1), ("Axis_X1", 1)], Vec::new()));
    assert_eq!((code("G74 X1.5").0, code("G74 X-1").0), ("nc-value".to_owned(), "nc-value".to_owned()));
}

#[test]
fn a_program_ends_with_m30_m02_or_its_text() {
    let ends = |text: &str| blocks(text).iter().map(|block| block.end).collect::<Vec<_>>();
    assert_eq!(ends("G1 X1\nM30\nG1 X2"), [None, Some(End::Program)]);
    assert_eq!(ends("G1 X1 M02\nG1 X2"), [Some(End::Program)]);
    assert_eq!(ends("G1 X1\n\n"), [None]);
    assert_eq!(ends(""), []);
}

#[test]
fn assignments_are_made_in_their_order() {
    let block =
        blocks("P10=20.5 P11=P10*2 X=P11\nV.L.A=1 V.P.B=2\nV.S.KEPT=V.L.A+V.P.B\nY=V.S.KEPT P5[1+1]=9\nZ=P5[2]");
    assert_eq!(block[0].axes, named(&[("X", 41.0)]));
    assert_eq!((&block[1].axes, &block[2].axes), (&named(&[("Y", 3.0)]), &named(&[("Z", 9.0)])));
}
