//! Commands that begin with `#`.

use super::{Channel, blocks, code, commands, fault};
use crate::isg::language::{
    AxisReference, AxisRequest, Command, Conflicts, Form, GantryTargets, Link, LinkOff, Pair, PutTargets,
};

fn first(text: &str) -> Command {
    commands(text).remove(0)
}

fn form(pair: &str) -> Form {
    match first(&format!("#SET AX LINK[1, {pair}]")) {
        Command::Link(Link { pairs, .. }) => pairs[0].form,
        other => panic!("{other:?}"),
    }
}

/// SG-01, SG-19: both spellings, several pairs, any blanks.
#[test]
fn both_spellings_define_the_same_group() {
    let printed = first("#SET AX LINK[1, [Y2 = Y1,G,0.01,0.25], [Z2=Z1,G]]");
    for text in [
        "#AX LINK[1, [Y2 = Y1,G,0.01,0.25], [Z2=Z1,G]]",
        "N10   #SET  AX   LINK [1,[Y2=Y1 , G , 0.01 , 0.25],[ Z2 = Z1,G ]]   ",
        "#AX LINK [1, [Y2=Y1,G,0.01,0.25], [Z2=Z1,G]] (comment)",
    ] {
        assert_eq!(first(text), printed, "{text}");
    }
    let Command::Link(Link { group, pairs }) = printed else { panic!() };
    assert_eq!((group, pairs.len(), pairs[1].form), (1, 2, Form::Gantry { limits: None }));
}

/// SG-02, B15: logical numbers, also by expressions.
#[test]
fn nbr_takes_logical_numbers() {
    let pair =
        Pair { slave: AxisReference::Number(8), master: AxisReference::Number(2), form: Form::Gantry { limits: None } };
    let wanted = Command::Link(Link { group: 2, pairs: vec![pair] });
    assert_eq!(first("#AX LINK NBR[2,[8 = 2,G]]"), wanted);
    assert_eq!(first("P1=2 P8=8\n#AX LINK NBR [P1, [P8 = [P1], G]]"), wanted);
    assert_eq!(code("#AX LINK NBR[1, [0 = 2]]"), ("nc-value".to_owned(), 18));
    assert_eq!(code("#AX LINK[1, [8 = 2]]"), ("nc-syntax".to_owned(), 14));
    assert_eq!(code("#SET AX LINK NBR[1, [8 = 2]]").0, "nc-syntax");
}

/// SG-05, B01 to B12: whole numbers are compared; −1/2 is no mirror.
#[test]
fn only_factors_minus_one_and_one_are_effective() {
    for (factor, effective, is_scaled) in [
        ("1,-1", -1, false),
        ("-1,1", -1, false),
        ("-2,2", -1, false),
        ("1,1", 1, false),
        ("-3,-3", 1, false),
        ("1,2", 1, true),
        ("2,3", 1, true),
        ("3,2", 1, true),
        ("-1,2", 1, true),
        ("-3,2", 1, true),
    ] {
        let form = form(&format!("[Y2 = Y1,{factor}]"));
        assert_eq!((form.factor(), form.is_scaled(), form.is_monitored()), (effective, is_scaled, false), "{factor}");
    }
    for (factor, wanted, column) in [
        ("0,1", "21077", 25),
        ("0,0", "21077", 25),
        ("1,0", "link-denominator", 27),
        ("1", "21110", 25),
        ("1.5,1", "nc-value", 25),
        ("1,2,3", "nc-syntax", 28),
    ] {
        assert_eq!(code(&format!("#SET AX LINK[1,[Y2 = Y1,{factor}]]")), (wanted.to_owned(), column), "{factor}");
    }
}

/// SG-01, SG-06, B13, B16: both limits or none, greater than 0 and in their order; no G, no monitoring.
#[test]
fn limits_come_in_pairs_and_are_positive() {
    assert!(form("[Y2=Y1,G]").is_monitored());
    assert!(!form("[Y2=Y1]").is_monitored() && !form("Y2=Y1").is_monitored());
    for (line, wanted, column) in [
        ("#SET AX LINK[1,[Y2 = Y1,G,0.01]]", "nc-syntax", 31),
        ("#SET AX LINK[1,[Y2 = Y1,G,0,0.25]]", "nc-value", 27),
        ("#SET AX LINK[1,[Y2 = Y1,G,0.25,0.01]]", "nc-value", 32),
        ("#SET AX LINK[1]", "nc-syntax", 15),
        ("#SET AX LINK[1, Y2=Y1", "nc-syntax", 22),
        ("#SET AX LINK", "nc-syntax", 13),
        ("#SET AX LINK[1, Y2=]", "nc-syntax", 20),
    ] {
        assert_eq!(code(line), (wanted.to_owned(), column), "{line}");
    }
}

/// SG-21, B17
#[test]
fn a_slave_has_one_master_and_is_none_itself() {
    for (pairs, wanted, column) in
        [("X=X", "20475", 17), ("C=X, C=Y", "20476", 22), ("B=X, C=B", "20477", 22), ("Y2=Y1, Y1=Z1", "20477", 24)]
    {
        assert_eq!(code(&format!("#SET AX LINK[1, {pairs}]")), (wanted.to_owned(), column), "{pairs}");
    }
    assert_eq!(blocks("#SET AX LINK[1, C=X, B=X]").len(), 1);
    assert_eq!(code("#AX LINK NBR[1, 8=2, 8=3]"), ("20476".to_owned(), 22));
}

/// SG-07, SG-10, SG-19, B26, B27, B28: what a group number and its absence mean, and numbers by expressions.
#[test]
fn groups_are_switched_on_and_off() {
    for (text, wanted) in [
        ("#ENABLE AX LINK[1]", Command::LinkOn(Some(1))),
        ("#ENABLE AX LINK [ 2 ]", Command::LinkOn(Some(2))),
        ("#AX LINK ON[1]", Command::LinkOn(Some(1))),
        (
            "#ENABLE AX LINK           (Coupling group 0, defined in the channel parameter list)  ",
            Command::LinkOn(None),
        ),
        ("#AX LINK ON", Command::LinkOn(None)),
        ("#DISABLE AX LINK[1]", Command::LinkOff(LinkOff::Group(1))),
        ("#AX LINK OFF [1]", Command::LinkOff(LinkOff::Group(1))),
        ("#DISABLE AX LINK", Command::LinkOff(LinkOff::Last)),
        ("#AX LINK OFF              (Deselect the last activated coupling group)  ", Command::LinkOff(LinkOff::Last)),
        ("#AX LINK OFF ALL", Command::LinkOff(LinkOff::All)),
        ("P1=1\n#ENABLE AX LINK[P1 + 1]", Command::LinkOn(Some(2))),
    ] {
        assert_eq!(first(text), wanted, "{text}");
    }
    for line in ["#DISABLE AX LINK ALL", "#AX LINK ON ALL", "#ENABLE AX LINK[]", "#AX LINK OFF[1", "#enable ax link[1]"]
    {
        assert_eq!(code(line).0, "nc-syntax", "{line}");
    }
    assert_eq!(code("#ENABLE AX LINK[1.5]"), ("nc-value".to_owned(), 17));
}

/// SG-10, B31: the command stands alone in its block.
#[test]
fn a_link_command_is_alone_in_its_block() {
    for is_lenient in [false, true] {
        for (line, column) in [
            ("N10 G01 X10 #ENABLE AX LINK[1]", 13),
            ("N10 #ENABLE AX LINK[1] G01 X10", 24),
            ("#SET AX LINK[1, Y2=Y1] #ENABLE AX LINK[1]", 24),
            ("#AX LINK OFF ALL M30", 18),
        ] {
            let fault = Channel::new(&[("part.nc", line)]).run(is_lenient).unwrap_err();
            assert_eq!((fault.code.to_string().as_str(), fault.column), ("link-not-alone", column), "{line}");
        }
    }
    assert_eq!(code("G01 X10 #PUT AX ALL"), ("nc-syntax".to_owned(), 9));
}

/// HG-14, HG-16, B65, B68, B74
#[test]
fn gantry_combinations_are_named_by_their_masters() {
    let masters = |masters: &[AxisReference]| GantryTargets::Masters(masters.to_vec());
    let name = |name: &str| AxisReference::Name(name.to_owned());
    for (text, is_on, targets) in [
        ("#GANTRY OFF [AX=X]", false, masters(&[name("X")])),
        ("#GANTRY OFF[AXNR=1]", false, masters(&[AxisReference::Number(1)])),
        ("#GANTRY ON [ AXNR = 2 AX=X ]", true, masters(&[AxisReference::Number(2), name("X")])),
        ("#GANTRY OFF ALL", false, GantryTargets::All),
        ("#GANTRY ON ALL", true, GantryTargets::All),
    ] {
        assert_eq!(first(text), Command::Gantry { is_on, targets }, "{text}");
    }
    for (line, column) in [
        ("#GANTRY OFF []", 14),
        ("#GANTRY ON[]", 12),
        ("#GANTRY OFF", 12),
        ("#GANTRY [AX=X]", 9),
        ("#GANTRY ON [X]", 13),
    ] {
        assert_eq!(code(line), ("nc-syntax".to_owned(), column), "{line}");
    }
}

/// HG-15, SG-25, B71, B73: the arguments are name, logical number, index.
#[test]
fn axes_are_called_and_put_back() {
    let request = |name: &str, number, index| AxisRequest { name: name.to_owned(), number, index, options: Vec::new() };
    let call = |is_fast, conflicts, requests| Command::CallAxis { is_fast, conflicts, requests };
    let none = Conflicts::default();
    assert_eq!(first("#CALL AX[Axis_X1, 5, 4]"), call(false, none, vec![request("Axis_X1", 5, 4)]));
    let two = vec![request("A1", 5, 4), request("B", 6, 5)];
    assert_eq!(first("P1=4\n#CALL AX FAST [A1, 5, P1] [B,6,P1+1]"), call(true, none, two));
    let names = Conflicts { name: true, number: false, index: true };
    assert_eq!(first("#AX REQUEST [NAM, IDX] [A1, 5, 4]"), call(false, names, vec![request("A1", 5, 4)]));
    assert_eq!(first("#AX REQUEST [A1, 5, 4]"), call(false, none, vec![request("A1", 5, 4)]));
    for (text, targets) in [
        ("#PUT AX[Axis_X1]", PutTargets::Names(vec!["Axis_X1".to_owned()])),
        ("#PUT AX [ X, B]", PutTargets::Names(vec!["X".to_owned(), "B".to_owned()])),
        ("#PUT AX ALL", PutTargets::All),
        ("#AX RELEASE [X]", PutTargets::Names(vec!["X".to_owned()])),
        ("#AX RELEASE NBR [5, 6]", PutTargets::Numbers(vec![5, 6])),
    ] {
        assert_eq!(first(text), Command::PutAxis(targets), "{text}");
    }
    for line in ["#CALL AX", "#CALL AX [5, 4]", "#CALL AX [A1, 5]", "#PUT AX", "#PUT AX []", "#CALL [A1, 5, 4]"] {
        assert_eq!(code(line).0, "nc-syntax", "{line}");
    }
    assert_eq!(code("#CALL AX [A1, 5, -1]"), ("nc-value".to_owned(), 18));
}

/// SG-11: manual mode of an axis, with both words.
#[test]
fn g201_names_its_axes() {
    let manual = |is_on, axis: &str| Command::Manual { is_on, axes: vec![axis.to_owned()] };
    assert_eq!(first("N10 G201 #AXIS [Y2]"), manual(true, "Y2"));
    assert_eq!(first("G202 #ACHSE[Y2]"), manual(false, "Y2"));
    assert_eq!(code("G1 G201 #AXIS [X]").0, "nc-syntax");
}

#[test]
fn unknown_commands_are_refused_by_name() {
    for line in ["#SAVE CONFIG", "#LOAD CONFIG [AXLINK]", "#FOO", "#AX", "#AX LINKS ON"] {
        let (code, number, column, text) = fault(line);
        assert_eq!((code.as_str(), number, column), ("nc-syntax", 1, 1), "{line}");
        assert!(text.starts_with(&format!("`{}`", line.split(' ').next().unwrap())), "{text}");
    }
    // What is known, but not in this form or place, is no unknown command.
    for (line, column, wanted) in [
        ("#DISABLE AXLINK", 1, "AX LINK is written in two words"),
        ("X1 #COMMENT BEGIN", 4, "#COMMENT BEGIN and #COMMENT END stand alone"),
        ("#VAR X", 1, "#VAR and #ENDVAR stand alone"),
    ] {
        let (code, number, found, text) = fault(line);
        assert_eq!((code.as_str(), number, found), ("nc-syntax", 1, column), "{line}");
        assert!(text.starts_with(wanted), "{text}");
    }
    let (_, _, _, text) = fault("#VAR\nV.P.A : REAL64 = 2\n#ENDVAR");
    assert!(text.starts_with("the declaration of a type"), "{text}");
    let lenient = Channel::new(&[("part.nc", "#DISABLE AXLINK")]).run(true).unwrap();
    assert_eq!(lenient[0].command, Some(Command::LinkOff(LinkOff::Last)));
}
