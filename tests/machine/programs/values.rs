//! R parameters, system variables, machine data in programs; what outlasts power off.

use super::{automatic, position, run, start};

#[test]
fn r_parameters_stay_and_system_variables_are_read_when_they_are_reached() {
    let session = run("R1=2*3+1\nG0 X=R1\nR2=$AA_IM[X]+1\nY=R2\nM30");
    assert_eq!(position(&session), [7.0, 8.0, 0.0]);
    assert_eq!(session.machine().r_parameter(opennck::units::ChannelNumber::FIRST, 2), Some(8.0));
}

#[test]
fn machine_data_are_read_and_written() {
    let session = run("R1=$MA_MAX_AX_VELO[X]\n$SC_DRY_RUN_FEED=123\nR2=$SC_DRY_RUN_FEED\nM30");
    let r = |number| session.machine().r_parameter(opennck::units::ChannelNumber::FIRST, number);
    assert_eq!((r(1), r(2)), (Some(20_000.0), Some(123.0)));
}

#[test]
fn a_program_and_r_parameters_outlast_power_off() {
    let mut session = run("R5=7\nM30");
    session.power_on().unwrap();
    session.run("10ms").unwrap();
    session
        .wait("X.position_controller_active && Y.position_controller_active && A.position_controller_active", "1s")
        .unwrap();
    assert_eq!(session.machine().r_parameter(opennck::units::ChannelNumber::FIRST, 5), Some(7.0));
    session.set("mode_group_1.mode_automatic", 1).unwrap();
    session.run("10ms").unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "1s").unwrap();
}

/// A copy in the middle of a block goes on exactly as the original.
#[test]
fn a_fork_and_a_saved_machine_go_on_with_the_program() {
    let mut session = automatic("G64 G1 X10 F3000\nY10\nG2 X20 Y0 CR=10 M8\nR1=5\nM30");
    start(&mut session);
    session.run("250ms").unwrap();
    let mut fork = session.fork().unwrap();
    let mut machine = session.machine().fork().unwrap();
    machine.restore(&session.machine().save()).unwrap();
    let mut restored = opennck::scenario::Session::new(machine);
    for one in [&mut session, &mut fork, &mut restored] {
        one.run("3s").unwrap();
    }
    assert_eq!(session.machine().save(), fork.machine().save());
    assert_eq!(session.machine().save(), restored.machine().save());
    assert_eq!(position(&session), [20.0, 0.0, 0.0]);
}

/// N10 to N30 are numbers, the block without one is line 3; the program has ended: 0.
#[test]
fn the_block_that_runs_is_its_number_or_its_line() {
    let mut session = automatic("N10 G90\nN20 G1 X5 F3000\nY5\nLABEL: Z5\n:50 X6\nM30");
    session.watch(&["CHAN1.block"]).unwrap();
    session.expect("CHAN1.block == 0").unwrap();
    start(&mut session);
    session.wait("CHAN1.block == 20", "1s").unwrap();
    session.wait("CHAN1.block == 3", "5s").unwrap();
    session.wait("CHAN1.block == 4", "5s").unwrap();
    session.wait("CHAN1.block == 50", "5s").unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    session.run("1cycles").unwrap();
    session.expect("CHAN1.block == 0").unwrap();
    let text = session.sequence();
    assert!(text.contains(" 20 -> 3"), "{text}");
}

/// The name of a program is a text: its rows show the subprogram while it runs.
#[test]
fn the_program_is_watched_as_a_text() {
    let mut session = automatic("N10 G0 X5\nM30");
    session.watch(&["CHAN1.program", "R5"]).unwrap();
    let text = "%_N_MAIN_MPF\nN10 G0 X1\nDEEPER\nN30 G0 X2\nM30\n%_N_DEEPER_SPF\nR5=2.5\nN10 G0 Y1\nM17\n";
    session.nc(text, 1).unwrap();
    session.run("2cycles").unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    session.expect("R5 == 2.5 && R5[CHAN1] == 2.5 && R6 == 0").unwrap();
    let text = session.sequence();
    for row in
        ["NC1.MPF -> MAIN.MPF", "MAIN.MPF -> DEEPER.SPF", "DEEPER.SPF -> MAIN.MPF", "0 -> 2.5", "program MAIN.MPF"]
    {
        assert!(text.contains(row), "{row}\n{text}");
    }
    let json = session.json_lines();
    assert!(json.contains(r#""symbol":"CHAN1.program","value":"DEEPER.SPF"}"#), "{json}");
    assert!(json.contains(r#""symbol":"R5","value":2.5}"#), "{json}");
    assert!(
        json.contains(r#""happened":"program_selected","program":"MAIN.MPF","where":"CHAN1","by":"outside""#),
        "{json}"
    );
    assert!(session.vcd().contains("CHAN1.program_=_DEEPER.SPF"), "{}", session.vcd());
}

#[test]
fn unknown_values_are_refused_with_what_exists() {
    let mut session = automatic("M30");
    let mut refused = |expression: &str, parts: &[&str]| {
        let text = session.expect(expression).unwrap_err().to_string();
        for part in parts {
            assert!(text.contains(part), "{expression}: {text}");
        }
    };
    refused("CHAN1.blok == 10", &["did you mean `CHAN1.block`?"]);
    refused("CHAN1.program == 1", &["which is a text", "watch = [\"CHAN1.program\"]"]);
    refused("R100 == 1", &["R0 to R99", "MD28050"]);
    refused("R5[CHAN7] == 1", &["CHAN7"]);
    refused("R5[CHAN1 == 1", &["`]`"]);
    let watched = session.watch(&["CHAN1.blok"]).unwrap_err().to_string();
    assert!(watched.contains("did you mean `CHAN1.block`?"), "{watched}");
    let watched = session.watch(&["R100"]).unwrap_err().to_string();
    assert!(watched.contains("R0 to R99"), "{watched}");
    for (name, cure) in [
        ("CHAN1.block", "can only be read"),
        ("R5", "r_parameters = { \"R5\""),
        ("X.position", "is a value and not a signal"),
    ] {
        let text = session.set(name, 1).unwrap_err().to_string();
        assert!(text.contains(cure), "{text}");
    }
    let text = session.capture("R5", "1").unwrap_err().to_string();
    assert!(text.contains("R parameter"), "{text}");
}

/// A fork copies the variables: the values of ten channels take a few hundred bytes of them, and R parameters are shared.
#[test]
fn the_values_of_channels_are_small() {
    use opennck::variables::{ChannelValues, RParameters, Variables};
    assert_eq!((size_of::<ChannelValues>(), size_of::<RParameters>()), (40, 80));
    let channels = 10 * size_of::<ChannelValues>() + size_of::<RParameters>();
    assert!(channels * 20 < size_of::<Variables>(), "{channels} of {}", size_of::<Variables>());
}
