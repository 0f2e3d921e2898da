//! G functions, auxiliary functions and commands.

use super::{Channel, alarm, interpreter, run, run_in};
use crate::nc_program::{
    Action, AuxiliaryKind, AxisIndex, AxisWord, Block, Centre, CouplingKind, Dimension, Frequency, MainRunAction,
    Modal, Prepared, Value, function_name, g,
};

const X: AxisIndex = AxisIndex(0);
const Y: AxisIndex = AxisIndex(1);

/// The first block of a program.
#[track_caller]
fn first(text: &str) -> Block {
    run(&format!("{text}\nM30")).swap_remove(0)
}

#[track_caller]
fn action(text: &str) -> Action {
    let mut block = first(text);
    assert_eq!(block.actions.len(), 1, "{text}: {block:?}");
    block.actions.remove(0)
}

#[test]
fn modal_g_functions_change_their_group() {
    for (name, group, index) in [
        ("G0", 1, 1),
        ("G1", 1, 2),
        ("G01", 1, 2),
        ("G2", 1, 3),
        ("G3", 1, 4),
        ("G17", 6, 1),
        ("G18", 6, 2),
        ("G19", 6, 3),
        ("G40", 7, 1),
        ("G500", 8, 1),
        ("G54", 8, 2),
        ("G57", 8, 5),
        ("G505", 8, 6),
        ("G599", 8, 100),
        ("G60", 10, 1),
        ("G64", 10, 2),
        ("G641", 10, 3),
        ("G645", 10, 7),
        ("G601", 12, 1),
        ("G602", 12, 2),
        ("G603", 12, 3),
        ("G70", 13, 1),
        ("G71", 13, 2),
        ("G700", 13, 3),
        ("G710", 13, 4),
        ("G90", 14, 1),
        ("G91", 14, 2),
        ("G94", 15, 2),
        ("G95", 15, 3),
        ("BRISK", 21, 1),
        ("SOFT", 21, 2),
        ("FFWOF", 24, 1),
        ("FFWON", 24, 2),
        ("WALIMON", 28, 1),
        ("WALIMOF", 28, 2),
        ("STARTFIFO", 4, 1),
        ("STOPFIFO", 4, 2),
        ("FIFOCTRL", 4, 3),
    ] {
        let blocks = run(&format!("{name}\nM30"));
        assert_eq!(blocks[0].modal.index(group), index, "{name}");
        assert_eq!(blocks[1].modal.index(group), index, "{name} is modal");
        assert!(!blocks[0].is_executable(), "{name}");
    }
}

#[test]
fn other_g_functions_hold_in_their_block() {
    for (name, group, index) in
        [("G9", 11, 1), ("G53", 9, 1), ("SUPA", 9, 2), ("G153", 9, 3), ("G4 F1", 2, 1), ("G74 X1=0", 2, 3)]
    {
        let blocks = run(&format!("{name}\nM30"));
        let found: Vec<_> = blocks[0].once.iter().map(|function| (function.group, function.index)).collect();
        assert_eq!((found, blocks[1].once.len()), (vec![(group, index)], 0), "{name}");
    }
    assert_eq!(function_name(g::G74).as_deref(), Some("G74"));
}

#[test]
fn reset_values_come_from_the_caller() {
    let mut modal = Modal::default();
    assert!(modal.set(crate::nc_program::GFunction { group: 8, index: 2 }));
    let mut channel = Channel::new().with("PART.MPF", "X5\nM30");
    let mut interpreter = crate::nc_program::Interpreter::new("PART.MPF", modal, Some(300.0), false);
    let Prepared::Block(block) = interpreter.next(&mut channel).unwrap() else { panic!("a block") };
    assert_eq!((block.modal.index(8), block.modal.index(1), block.feed), (2, 2, Some(300.0)));
}

#[test]
fn g_functions_are_programmed_indirectly() {
    let block = first("G[8]=2 G[14]=2 G=17");
    assert_eq!((block.modal.index(8), block.modal.index(14), block.modal.index(6)), (2, 2, 1));
}

#[test]
fn positions_have_their_dimension() {
    let dimension = |text: &str| first(&format!("G0 {text}")).axes[0].dimension;
    for (text, expected) in [
        ("X5", Dimension::Absolute),
        ("G91 X5", Dimension::Incremental),
        ("X=IC(5)", Dimension::Incremental),
        ("G91 X=AC(5)", Dimension::Absolute),
        ("C=DC(90)", Dimension::Shortest),
        ("C=ACP(90)", Dimension::FromPlus),
        ("C=ACN(90)", Dimension::FromMinus),
        ("A=DC(400)", Dimension::Shortest),
    ] {
        assert_eq!(dimension(text), expected, "{text}");
    }
    assert_eq!(first("G0 C=ACP(359.999)").axes[0].value, 359.999);
}

#[test]
fn a_feedrate_is_modal_until_its_kind_changes() {
    let blocks = run("F100\nX1\nF200 X2\nG95 F0.5 X3\nX4\nM30");
    assert_eq!(
        blocks.iter().map(|block| block.feed).collect::<Vec<_>>(),
        [100.0, 100.0, 200.0, 0.5, 0.5, 0.5].map(Some)
    );
    assert_eq!(alarm("F100\nG95\nX1\nM30").number, 10860);
    assert_eq!(run("F100\nG94\nX1\nM30").len(), 4, "G94 was active already");
    assert_eq!(run("G0 X5\nM30").len(), 2, "rapid traverse needs none");
    assert_eq!(alarm("G4 F3\nG1 X5\nM30").number, 10860, "that F is no feedrate");
}

#[test]
fn circles_have_a_centre_a_radius_or_an_angle() {
    let block = first("G2 F1 X10 Y0 I5 J=AC(3) TURN=2");
    let circle = block.circle;
    assert_eq!(circle.centre[0], Some(Centre { value: 5.0, is_absolute: false }));
    assert_eq!(circle.centre[1], Some(Centre { value: 3.0, is_absolute: true }));
    assert_eq!((circle.centre[2], circle.turns), (None, Some(2)));
    assert_eq!(first("G3 F1 X10 CR=-5").circle.radius, Some(-5.0));
    assert_eq!(first("G3 F1 X10 AR=45").circle.opening_angle, Some(45.0));
    assert_eq!(alarm("G2 F1 X10 CR=5 I5\nM30").number, 12110);
    assert_eq!(alarm("G2 F1 X10 I5\nX5 CR=5 J5\nM30").number, 15460);
    assert_eq!(alarm("G2 F1 X10 I5 TURN=1.5\nM30").number, 14048);
}

#[test]
fn dwell_is_time_or_revolutions() {
    assert_eq!(action("G4 F2.5"), Action::DwellSeconds(2.5));
    assert_eq!(action("G4 S30"), Action::DwellRevolutions { spindle: None, revolutions: 30.0 });
    assert_eq!(action("G4 S2=30"), Action::DwellRevolutions { spindle: Some(2), revolutions: 30.0 });
    assert!(first("G4 F2").auxiliary.is_empty());
    assert_eq!(first("M3 G4 F2").auxiliary.len(), 1);
    assert_eq!(alarm("G4\nM30").number, 12110);
    assert_eq!(alarm("G4 F-1\nM30").number, 12560);
}

#[test]
fn limits_are_of_axes_or_spindles() {
    let expected = Action::Limit { is_upper: false, axes: vec![(X, -10.0), (Y, -20.0)], spindles: Vec::new() };
    assert_eq!(action("G25 X-10 Y-20"), expected);
    let expected = Action::Limit { is_upper: true, axes: Vec::new(), spindles: vec![(None, 3000.0)] };
    assert_eq!(action("G26 S3000"), expected);
}

#[test]
fn offsets_replace_or_add() {
    let text = "G0\nTRANS X10 Y5\nX1\nATRANS X2\nX1\nTRANS Y1\nX1\nTRANS\nX1\nM30";
    let offsets: Vec<_> =
        run(text).into_iter().filter(|block| !block.axes.is_empty()).map(|block| block.offset).collect();
    assert_eq!(offsets, [vec![(X, 10.0), (Y, 5.0)], vec![(X, 12.0), (Y, 5.0)], vec![(Y, 1.0)], vec![]]);
    assert_eq!(alarm("TRANS X5 F100\nM30").number, 12110);
    for rotation in ["ROT Z45", "AROT Z45", "SCALE X2", "MIRROR X0"] {
        assert!(alarm(&format!("{rotation}\nM30")).is_refused, "{rotation}");
    }
}

#[test]
fn functions_that_are_not_modelled_are_refused() {
    for text in [
        "G33 Z5 K2",
        "G41 X5",
        "G42",
        "G5",
        "G63",
        "G75 X1=0",
        "G96 S100",
        "FB=100",
        "G1 X5 FD=0",
        "MCALL L10",
        "TRAORI",
        "R1=CROT(Z,45)",
        "COUPDEF(X,Y)",
        "MEAS=1",
        "SETMS(2)",
        "T=\"DRILL\"",
        "RET(1)",
    ] {
        let found = alarm(&format!("{text}\nM30"));
        assert!(found.number == 12553 && found.is_refused, "{text}: {found}");
    }
}

#[test]
fn auxiliary_functions_keep_their_order() {
    let block = first("M7 S1=500 T12 D2 H3=1.5 M=QU(8) DL=1 F100");
    let found: Vec<_> = block.auxiliary.iter().map(|one| (one.kind, one.extension, one.value, one.is_quick)).collect();
    assert_eq!(
        found,
        [
            (AuxiliaryKind::M, None, 7.0, false),
            (AuxiliaryKind::S, Some(1), 500.0, false),
            (AuxiliaryKind::T, None, 12.0, false),
            (AuxiliaryKind::D, None, 2.0, false),
            (AuxiliaryKind::H, Some(3), 1.5, false),
            (AuxiliaryKind::M, None, 8.0, true),
            (AuxiliaryKind::SumOffset, None, 1.0, false),
            (AuxiliaryKind::F, None, 100.0, false),
        ]
    );
    // One group for each spindle.
    assert_eq!(first("M1=3 M2=4 M41 M1=5003").auxiliary.len(), 4);
    for (text, number) in
        [("M40 M41", 14760), ("M3 M19", 14760), ("M1=3 M1=5", 14760), ("M0 M2", 14760), ("M-1", 12560)]
    {
        assert_eq!(alarm(&format!("{text}\nM30")).number, number, "{text}");
    }
}

#[test]
fn positioning_axes_wait_or_not() {
    let target = AxisWord { axis: X, value: 5.0, dimension: Dimension::Absolute };
    assert_eq!(action("POS[X]=5"), Action::Position { target, waits: true });
    assert_eq!(action("POSA[X]=5"), Action::Position { target, waits: false });
    let target = AxisWord { axis: X, value: 5.0, dimension: Dimension::Incremental };
    assert_eq!(action("POS[X]=IC(5)"), Action::Position { target, waits: true });
    let block = first("G0 Y1 POS[X]=5 FA[X]=300 ACC[X]=50 OVR=80");
    let target = AxisWord { dimension: Dimension::Absolute, ..target };
    assert_eq!(
        block.actions,
        [
            Action::Position { target, waits: true },
            Action::AxisFeed(X, 300.0),
            Action::Acceleration(X, 50.0),
            Action::Override(80.0),
        ]
    );
    assert_eq!((block.auxiliary[0].kind, block.auxiliary[0].axis), (AuxiliaryKind::F, Some(X)));
    assert_eq!(action("WAITP(X,Y)"), Action::WaitForPosition(vec![X, Y]));
    let expected =
        Action::SpindlePosition { spindle: Some(2), value: 90.0, dimension: Dimension::FromPlus, waits: true };
    assert_eq!(action("SPOS[2]=ACP(90)"), expected);
    assert_eq!(action("WAITS(1,2)"), Action::WaitForSpindle(vec![1, 2]));
    assert_eq!(action("FGROUP(X,Y)"), Action::FeedGroup(vec![X, Y]));
    assert_eq!(action("FGROUP()"), Action::FeedGroup(vec![]));
}

#[test]
fn handwheel_overrides_are_actions_of_their_block() {
    let target = AxisWord { axis: X, value: 5.0, dimension: Dimension::Absolute };
    for (text, waits, feed) in [("POS[X]=5 FDA[X]=0", true, 0.0), ("POSA[X]=5 FDA[X]=300", false, 300.0)] {
        assert_eq!(first(text).actions, [Action::Position { target, waits }, Action::HandwheelFeed(X, feed)], "{text}");
    }
    let block = first("G1 X5 FD=300");
    assert_eq!((block.actions, block.feed), (vec![Action::PathHandwheelFeed(300.0)], None));
    assert_eq!(alarm("POS[X]=5 FDA[X]=-1\nM30").number, 14810);
    assert_eq!(alarm("G1 X5 FD=-1\nM30").number, 14800);
    // FD is no F for the block behind it.
    assert_eq!(alarm("G1 X5 FD=300\nX6\nM30").number, 10860);
}

#[test]
fn axes_are_released_taken_and_set() {
    assert_eq!(action("RELEASE(X,Y)"), Action::Release(vec![X, Y]));
    assert_eq!(action("GET(X)"), Action::Get { axes: vec![X], is_direct: false });
    assert_eq!(action("GETD(X)"), Action::Get { axes: vec![X], is_direct: true });
    assert_eq!(action("PRESETON(X,100,Y,-5)"), Action::Preset(vec![(X, 100.0), (Y, -5.0)]));
    assert_eq!(action("G74 X1=0 Y0"), Action::Reference(vec![AxisIndex(5), Y]));
    assert_eq!(alarm("G74\nM30").number, 12080);
    assert_eq!(alarm("RELEASE()\nM30").number, 14020);
}

#[test]
fn couplings_are_handed_to_the_channel() {
    let expected =
        |kind, is_on, leading, parameters| Action::Coupling { kind, is_on, following: X, leading, parameters };
    assert_eq!(action("TRAILON(X,Y,2)"), expected(CouplingKind::Trail, true, Some(Y), vec![Some(Value::Int(2))]));
    assert_eq!(action("TRAILOF(X,Y)"), expected(CouplingKind::Trail, false, Some(Y), vec![]));
    assert_eq!(action("LEADON(X,Y,1)"), expected(CouplingKind::Lead, true, Some(Y), vec![Some(Value::Int(1))]));
    assert_eq!(action("COUPON(X,Y)"), expected(CouplingKind::Synchronous, true, Some(Y), vec![]));
    assert_eq!(action("COUPOF(X)"), expected(CouplingKind::Synchronous, false, None, vec![]));
    let mode = Some(Value::Text("NOC".to_owned()));
    assert_eq!(action("EGON(X,\"NOC\",Y)"), expected(CouplingKind::ElectronicGear, true, Some(Y), vec![mode]));
}

#[test]
fn messages_alarms_marks_and_channels() {
    assert_eq!(action("MSG(\"R=\"<<5)"), Action::Message(Some("R=5".to_owned())));
    assert_eq!(action("MSG()"), Action::Message(None));
    assert_eq!(action("MSG(1.5)"), Action::Message(Some("1.5".to_owned())));
    assert_eq!(action("SETAL(65000,\"TEXT\")"), Action::CycleAlarm { number: 65000, text: Some("TEXT".to_owned()) });
    assert_eq!(action("SETM(1,2)"), Action::SetMarks(vec![1, 2]));
    assert_eq!(action("CLEARM()"), Action::ClearMarks(vec![]));
    assert_eq!(action("WAITM(1,2,3)"), Action::WaitMark { mark: 1, channels: vec![2, 3], is_conditional: false });
    assert_eq!(action("WAITMC(1,2)"), Action::WaitMark { mark: 1, channels: vec![2], is_conditional: true });
    let expected = Action::Initialise { channel: 2, program: "PART".to_owned(), waits: false };
    assert_eq!(action("INIT(2,\"PART\",\"N\")"), expected);
    assert_eq!(action("START(2)"), Action::Start(vec![2]));
    assert_eq!(action("WAITE(2)"), Action::WaitEnd(vec![2]));
    assert_eq!(action("NEWCONF"), Action::NewConfiguration);
    assert_eq!(action("DRFOF"), Action::EndOverlays);
    assert_eq!(action("CANCEL(1,2)"), Action::Cancel(vec![1, 2]));
    run("MSG(\"A\")\nG4 F1\nMSG()\nM30");
    assert_eq!(alarm("SETM(1)\nR1=1\nCLEARM(1)\nM30").number, 16930);
    for wrong in ["WAITM(1,99)", "START()", "INIT(1)", "INIT(1,\"A\",\"Q\")", "MSG(\"A\",1,2)", "NEWCONF(1)"] {
        assert_eq!(alarm(&format!("{wrong}\nM30")).number, 14020, "{wrong}");
    }
}

#[test]
fn synchronised_actions_are_conditions_and_actions() {
    let text = "R1=50\nID=1 WHENEVER $AA_IM[X]>R1 DO POS[Y]=10 FA[Y]=500 M20 $R[5]=$AA_IM[X]*2 RDISABLE SETM(1)\nM30";
    let mut channel = Channel::new().with("PART.MPF", text);
    let (blocks, found) = run_in(&mut channel);
    assert_eq!(found, None);
    let Action::Synchronised(action) = &blocks[0].actions[0] else { panic!("{blocks:?}") };
    assert_eq!(
        (action.id, action.is_static, action.frequency, action.actions.len()),
        (Some(1), false, Frequency::Whenever, 6)
    );
    let condition = action.condition.as_ref().unwrap();
    channel.r[1] = 0.0; // R1 was read by preparation
    assert_eq!(condition.holds(&channel), Ok(false));
    channel.system.insert("$AA_IM".to_owned(), Value::Real(50.5));
    assert_eq!(condition.holds(&channel), Ok(true));
    let MainRunAction::Assign { name, indices, value } = &action.actions[3] else { panic!("{action:?}") };
    assert_eq!((name.as_str(), indices.as_slice(), value.number(&channel)), ("$R", &[Value::Int(5)][..], Ok(101.0)));
    let frequency = |text: &str| match super::words::action(text) {
        Action::Synchronised(action) => (action.id, action.is_static, action.frequency),
        other => panic!("{other:?}"),
    };
    assert_eq!(frequency("IDS=7 WHEN $AA_IM[X]>1 DO M20"), (Some(7), true, Frequency::Once));
    assert_eq!(frequency("EVERY $AA_IM[X]>1 DO M20"), (None, false, Frequency::Every));
    assert_eq!(frequency("FROM $AA_IM[X]>1 DO M20"), (None, false, Frequency::From));
    assert_eq!(frequency("DO M20"), (None, false, Frequency::Always));
    for wrong in ["ID=1 WHEN DO M20", "ID=1 WHEN $AA_IM[X]>1", "ID=1 DO", "ID=1 M20"] {
        assert!(matches!(alarm(&format!("{wrong}\nM30")).number, 12080 | 14757), "{wrong}");
    }
    assert_eq!(alarm("ID=256 DO M20\nM30").number, 14025);
}

#[test]
fn blocks_that_must_not_run_ahead_wait() {
    for (text, waits_before, waits_after) in [
        ("STOPRE", true, false),
        ("R1=$AA_IM[X]", true, false),
        ("IF $AA_IM[X]>5 GOTOF AB", true, false),
        ("G0 X=$AA_IM[X]", true, false),
        ("G74 X1=0", true, true),
        ("PRESETON(X,0)", true, true),
        ("GET(X)", true, true),
        ("NEWCONF", true, true),
        ("R1=$MC_LIMIT", false, false),
        ("ID=1 WHEN $AA_IM[X]>5 DO M20", false, false),
        ("M20", false, false),
    ] {
        let mut channel = Channel::new().with("PART.MPF", &format!("{text}\nAB: M30"));
        let mut interpreter = interpreter();
        channel.is_executed = false;
        let before = interpreter.clone();
        let waits = matches!(interpreter.step(&mut channel), Ok(Prepared::Waits(_)));
        assert_eq!(waits, waits_before, "{text}");
        if waits {
            assert_eq!(interpreter, before, "{text}: nothing has changed");
            channel.is_executed = true;
            assert!(!matches!(interpreter.step(&mut channel), Ok(Prepared::Waits(_))), "{text}");
            channel.is_executed = false;
        }
        assert_eq!(matches!(interpreter.step(&mut channel), Ok(Prepared::Waits(_))), waits_after, "{text}");
    }
}

#[test]
fn the_page_names_every_word() {
    use crate::nc_program::{function, functions, vocabulary, words};
    let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/nc_programs.md")).unwrap();
    let named: Vec<&str> = page.split(|c: char| !c.is_ascii_alphanumeric() && c != '_').collect();
    let commands = vocabulary::COMMANDS.iter().map(|row| row.0);
    let addresses = words::ADDRESSES.iter().map(|row| row.0);
    let others = function::FUNCTIONS.iter().map(|row| row.0);
    // Ranges of numbers, as G54 to G57, name their ends.
    let ranges = ["G55", "G56", "G642", "G643", "G644"];
    let g_functions = functions::FUNCTIONS.iter().map(|row| row.0).filter(|name| !ranges.contains(name));
    let missing: Vec<_> =
        commands.chain(addresses).chain(others).chain(g_functions).filter(|name| !named.contains(name)).collect();
    assert!(missing.is_empty(), "docs/nc_programs.md: {missing:?}");
}
