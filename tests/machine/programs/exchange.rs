//! Axis exchange by programs: the values of MD30552, WAITP with MD10722, and the largest number of PLC axes.

use opennck::plc::enable_all;
use opennck::scenario::Session;

use super::{prepare, start};

/// The portal with two channels, with these machine data; CHAN1 runs its program, and CHAN2 has the other one selected.
fn two_channels(data: &[(&str, f64)], first: &str, second: &str) -> Session {
    let mut session = Session::open("portal_two_channels").unwrap().with_program(enable_all().boxed());
    for (datum, value) in data {
        session.machine_data(datum, *value).unwrap();
    }
    session.power_on().unwrap();
    session.run("100ms").unwrap();
    prepare(&mut session, first);
    session.nc(&format!("%_N_SECOND_MPF\n{second}"), 2).unwrap();
    session.run("1cycles").unwrap();
    start(&mut session);
    session
}

fn start_second(session: &mut Session) {
    session.set("CHAN2.nc_start", 1).unwrap();
    session.run("1cycles").unwrap();
    session.set("CHAN2.nc_start", 0).unwrap();
}

const MOVES_Y: &str = "N10 G1 Y5 F1200\nN20 M30";

/// MD30552 of 0 refuses, 1 waits until Y is free, 2 takes it when no block uses it.
#[test]
fn a_block_takes_a_foreign_axis_as_md30552_says() {
    for (kind, alarm, wait, channel) in [(0.0, true, false, 1.0), (1.0, false, true, 1.0), (2.0, false, false, 2.0)] {
        let mut session = two_channels(&[("30552[Y]", kind)], "N10 G4 F5\nN20 M30", MOVES_Y);
        start_second(&mut session);
        session.run("1s").unwrap();
        let found = [
            session
                .value("alarm('axis-not-a-channel-axis', CHAN2)")
                .unwrap_or_else(|_| session.value("alarms()").unwrap()),
            session.value("CHAN2.program_state_wait").unwrap(),
            session.value("Y.axis_replacement_channel").unwrap(),
        ];
        assert_eq!(found, [f64::from(alarm), f64::from(wait), channel], "MD30552 = {kind}");
        let target = if kind == 2.0 { 5.0 } else { 0.0 };
        assert_eq!(session.value("Y.setpoint").unwrap(), target, "MD30552 = {kind}");
    }
}

/// RELEASE gives Y to any channel, WAITP only with MD10722 bit 0; GET takes it in either case.
#[test]
fn after_waitp_another_channel_takes_the_axis_automatically_only_with_md10722() {
    let waitp = "N10 POSA[Y]=5 FA[Y]=1200\nN20 WAITP(Y)\nN30 G4 F5\nN40 M30";
    let release = "N10 G1 Y5 F1200\nN20 RELEASE(Y)\nN30 G4 F5\nN40 M30";
    let get = "N5 GET(Y)\nN10 G1 Y5 F1200\nN20 M30";
    for (mask, first, second, channel) in
        [(0.0, waitp, MOVES_Y, 1.0), (1.0, waitp, MOVES_Y, 2.0), (0.0, release, MOVES_Y, 2.0), (0.0, waitp, get, 2.0)]
    {
        let mut session = two_channels(&[("10722", mask)], first, second);
        session.wait("Y.neutral_axis", "2s").unwrap();
        start_second(&mut session);
        session.run("500ms").unwrap();
        let found = session.value("Y.axis_replacement_channel").unwrap();
        assert_eq!(found, channel, "MD10722 = {mask}, {first}, {second}");
        assert_eq!(session.value("CHAN2.program_state_wait").unwrap(), f64::from(channel == 1.0));
        session.expect("alarms() == 0").unwrap();
    }
}

/// what leads beyond twelve axes is refused.
#[test]
fn the_plc_has_twelve_axes_at_most() {
    let mut session = Session::open("machine_data/eight_groupings").unwrap();
    // Axes 5 and 6 lead groupings of three axes, the last eight are single axes: 3 + 3 + 6 = 12, and two are too many.
    for number in [5, 6, 24, 25, 26, 27, 28, 29, 30, 31] {
        session.set(&format!("DB{}.DBX8.7", 30 + number), 1).unwrap();
        session.set(&format!("DB{}.DBX8.4", 30 + number), 1).unwrap();
        session.run("4cycles").unwrap();
    }
    let mut plc_axes = Vec::new();
    for number in 1..=31 {
        if session.value(&format!("DB{}.DBX68.7", 30 + number)).unwrap() == 1.0 {
            plc_axes.push(number);
        }
    }
    assert_eq!(plc_axes, [5, 6, 13, 14, 21, 22, 24, 25, 26, 27, 28, 29]);
    session.expect("alarm(26070, P7) && alarm(26070, P8)").unwrap();
}
