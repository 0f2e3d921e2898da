//! Auxiliary functions in DB21.DBB58 to 206, and G functions in 208 to 271.

use super::{automatic, run, start};

/// Each decoded M function is 1 for exactly one PLC scan, in the order of the program.
#[test]
fn m_functions_are_decoded_for_one_scan_in_the_order_of_the_program() {
    let mut session = automatic("M7\nM8\nM7\nM30");
    session
        .watch(&["CHAN1.decoded_m_function_7", "CHAN1.decoded_m_function_8", "CHAN1.decoded_m_function_30"])
        .unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "1s").unwrap();
    session.run("10ms").unwrap();
    let rows: Vec<_> = session
        .sequence()
        .lines()
        .filter_map(|line| line.split_once("decoded_m_function_").map(|(_, rest)| rest.to_owned()))
        .map(|rest| {
            let number = rest.split_whitespace().next().unwrap().to_owned();
            (number, rest.contains("0 -> 1"))
        })
        .collect();
    let wanted =
        ["7", "8", "7", "30"].iter().flat_map(|number| [((*number).to_owned(), true), ((*number).to_owned(), false)]);
    assert_eq!(rows, wanted.collect::<Vec<_>>());
}

#[test]
fn values_and_extensions_stand_at_their_places() {
    let mut session = automatic("M12 M=13 S1500 T5 D1 H3=7.5\nM30");
    start(&mut session);
    session.wait("CHAN1.m_function_1_change && CHAN1.m_function_1 == 12", "1s").unwrap();
    for (address, value) in [
        ("DB21.DBW68", 0.0),
        ("DB21.DBD70", 12.0),
        ("DB21.DBD76", 13.0),
        ("DB21.DBW98", 0.0),
        ("DB21.DBW116", 0.0),
        ("DB21.DBW118", 5.0),
        ("DB21.DBB129", 1.0),
        ("DB21.DBW140", 3.0),
        ("DB21.DBB58", 3.0),
        ("DB21.DBB60", 1.0),
    ] {
        assert_eq!(session.value(address).unwrap(), value, "{address}");
    }
    assert_eq!(session.value("CHAN1.s_function_1").unwrap(), 1500.0);
    assert_eq!(session.value("CHAN1.h_function_1").unwrap(), 7.5);
}

/// The motion waits for what is output before it; M0 and M30 come at the end of the motion.
#[test]
fn an_m_function_before_the_motion_is_output_before_the_axis_moves() {
    let mut session = automatic("X10 F3000 M8\nY10 M0\nM30");
    start(&mut session);
    session.wait("CHAN1.decoded_m_function_8", "1s").unwrap();
    session.expect("!X.traverse_command_plus").unwrap();
    session.run("3cycles").unwrap();
    session.expect("X.traverse_command_plus").unwrap();
    session.wait("CHAN1.decoded_m_function_0", "5s").unwrap();
    session.expect("abs(Y.position - 10) < 0.02 && Y.setpoint == 10").unwrap();
}

#[test]
fn an_m_function_above_99_or_with_an_extension_is_not_decoded() {
    let mut session = automatic("M2=8\nM120\nM30");
    start(&mut session);
    session.wait("CHAN1.m_function_1_not_decoded", "1s").unwrap();
    session
        .expect("!CHAN1.decoded_m_function_8 && CHAN1.m_function_1_extension == 2 && CHAN1.m_function_1 == 8")
        .unwrap();
    session.wait("CHAN1.m_function_1 == 120", "1s").unwrap();
    session.expect("CHAN1.m_function_1_not_decoded").unwrap();
}

#[test]
fn the_groups_of_md22510_show_their_active_function() {
    let mut session = automatic("G0 G64 X1\nG1 X2 F6000 G91\nM0\nM30");
    // After power on: G1, G60, G90 (MD20150).
    session.image(&[("DB21.DBB208", "2"), ("DB21.DBB217", "1"), ("DB21.DBB221", "1"), ("DB21.DBB213", "0")]).unwrap();
    start(&mut session);
    session.wait("CHAN1.m0_m1_active", "5s").unwrap();
    session.image(&[("DB21.DBB208", "2"), ("DB21.DBB217", "2"), ("DB21.DBB221", "2")]).unwrap();
    session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
    session.image(&[("DB21.DBB217", "1"), ("DB21.DBB221", "1")]).unwrap();
}

#[test]
fn m17_of_a_subprogram_is_output_only_with_md20800() {
    let session = run("M30");
    assert_eq!(session.value("CHAN1.m_function_1").unwrap(), 30.0);
}
