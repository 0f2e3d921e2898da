//! Tests of the following error of position control against formulas, for several servo gains, velocities and weights.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use opennck::machine::{Command, DatumValue, Machine};
use opennck::plc::enable_all;
use opennck::scenario::Session;

/// The following error of Y in mm at a steady velocity in mm/min, with the given machine data.
fn following_error(data: &[(&str, f64)], velocity: f64) -> f64 {
    let mut machine = Machine::open("g1_example").unwrap();
    for &(target, value) in data.iter().chain(&[("32020[Y]", velocity)]) {
        let (target, value) = (target.to_owned(), DatumValue::Real(value));
        machine.queue(Command::MachineDatum { target, value }).unwrap();
    }
    machine.queue(Command::PowerOn).unwrap();
    let mut session = Session::new(machine).with_program(Box::new(enable_all()));
    session.run("100ms").unwrap();
    session.set("DB11.DBX0.2", true).unwrap();
    session.set("Y.traversing_key_plus", true).unwrap();
    session.run("3s").unwrap();
    session.value("Y.following_error").unwrap()
}

/// The tolerance is one increment of the encoder, 0.0001 mm.
fn assert_close(found: f64, expected: f64, what: &str) {
    assert!((found - expected).abs() <= 0.000_15, "{what}: expected {expected}, found {found}");
}

/// DYN-05: v/Kv. At 1 (m/min)/mm, it is 1 mm at 1 m/min, for all cycle times.
#[test]
fn without_feed_forward_the_following_error_is_velocity_over_gain() {
    for gain in [0.5, 1.0, 2.5, 5.0] {
        for velocity in [300.0, 2_000.0, 7_500.0] {
            let expected = velocity / 1_000.0 / gain;
            // The weight and the balancing time have no effect while MD32620 = 0.
            let data = [("32200[0,Y]", gain), ("32610[0,Y]", 0.5), ("32810[0,Y]", 0.02)];
            for (system_cycle, ratio) in [(0.002, 1.0), (0.004, 3.0)] {
                let cycles = [("10050", system_cycle), ("10070", ratio)];
                let what = format!("Kv {gain}, v {velocity}, {ratio} cycles of {system_cycle} s");
                assert_close(following_error(&[&data[..], &cycles].concat(), velocity), expected, &what);
            }
        }
    }
}

/// DYN-05: v · MD32810 + (1 − MD32610) · v/Kv with PT1 (1) and dead time (3); MD32800 instead of MD32810 in modes 2 and 4.
#[test]
fn with_feed_forward_it_is_the_part_of_the_balancing_time_and_the_rest_of_the_weight() {
    for (mode, balancing) in [(1.0, 0.003), (2.0, 0.001), (3.0, 0.003), (4.0, 0.001)] {
        for (gain, velocity, weight) in [(1.0, 2_000.0, 1.0), (2.0, 2_000.0, 0.5), (1.0, 7_500.0, 0.0)] {
            let per_second = velocity / 60.0;
            let expected = per_second * balancing + (1.0 - weight) * velocity / 1_000.0 / gain;
            let data = [
                ("32620[Y]", mode),
                ("32610[0,Y]", weight),
                ("32200[0,Y]", gain),
                ("32810[0,Y]", 0.003),
                ("32800[0,Y]", 0.001),
            ];
            let what = format!("mode {mode}, Kv {gain}, v {velocity}, weight {weight}");
            assert_close(following_error(&data, velocity), expected, &what);
        }
    }
}

/// While MD32900 = 1, MD32910 delays the setpoint by v · MD32910, with and without feed-forward.
#[test]
fn matching_adds_its_time() {
    let with = |enable: f64, mode: f64| {
        let data = [("32900[Y]", enable), ("32910[0,Y]", 0.006), ("32620[Y]", mode), ("32810[0,Y]", 0.003)];
        following_error(&data, 2_000.0)
    };
    let way = |time: f64| 2_000.0 / 60.0 * time;
    assert_close(with(0.0, 0.0), 2.0, "neither");
    assert_close(with(1.0, 0.0), 2.0 + way(0.006), "matching");
    assert_close(with(0.0, 1.0), way(0.003), "feed-forward");
    assert_close(with(1.0, 1.0), way(0.003) + way(0.006), "both");
}

/// MD32430 = 0 limits no jerk: with MD32420 = 1 an axis sets off as without it.
#[test]
fn a_largest_jerk_of_0_limits_nothing() {
    let way = |limited: f64| {
        let mut session = Session::open("g1_example").unwrap().with_program(Box::new(enable_all()));
        session.machine_data("32420[Y]", limited).unwrap();
        session.machine_data("32430[Y]", 0.0).unwrap();
        session.pulse("CHAN1.channel_reset").unwrap();
        session.set("DB11.DBX0.2", true).unwrap();
        session.wait("Y.position_controller_active", "1s").unwrap();
        session.set("Y.traversing_key_plus", true).unwrap();
        session.run("100ms").unwrap();
        session.value("Y.setpoint").unwrap()
    };
    // 1 m/s2 up to 33.3 mm/s.
    assert!(way(0.0) > 2.0, "{}", way(0.0));
    assert_close(way(1.0), way(0.0), "with MD32420");
}
