//! Paths: targets, circles, dimensions, offsets, exact stops, positioning axes.

use opennck::plc::enable_all;
use opennck::scenario::Session;

use super::{automatic, duration, position, run, start};

#[test]
fn lines_end_where_they_are_programmed_and_the_synchronous_axis_goes_along() {
    let session = run("N10 G0 X10 Y20 Z-5\nN20 G1 X40 Y60 F3000\nN30 G91 X-5 Z=IC(2)\nN40 G90 Y=AC(1)\nM30");
    assert_eq!(position(&session), [35.0, 1.0, -3.0]);
    session.value("X2.position").map(|x2| assert!((x2 - 35.0).abs() < 0.01)).unwrap();
}

#[test]
fn circles_end_where_they_are_programmed_and_pass_their_far_side() {
    // A half circle clockwise from (0, 0) to (20, 0) about (10, 0): it passes (10, 10).
    let mut session = automatic("G2 X20 Y0 I10 J0 F2000\nM30");
    start(&mut session);
    session.wait("Y.setpoint > 9.99", "5s").unwrap();
    assert!((session.value("X.setpoint").unwrap() - 10.0).abs() < 0.5);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session), [20.0, 0.0, 0.0]);
}

#[test]
fn circles_have_a_centre_a_radius_or_an_angle() {
    // A quarter circle counterclockwise about (0, 10) from (0, 0) to (10, 10): three ways to write it.
    for nc in
        ["G3 X10 Y10 I0 J10", "G3 X10 Y10 CR=10", "G3 X10 Y10 AR=90", "G3 AR=90 I0 J10", "G3 X10 Y10 I=AC(0) J=AC(10)"]
    {
        let session = run(&format!("F2000\n{nc}\nM30"));
        assert_eq!(position(&session), [10.0, 10.0, 0.0], "{nc}");
    }
}

#[test]
fn a_full_circle_comes_back_and_takes_its_time() {
    // 2·π·10 mm at 2000 mm/min are 1.885 s.
    let seconds = duration("G2 X0 Y0 I10 J0 F2000\nM30");
    assert!((1.88..2.2).contains(&seconds), "{seconds}");
}

#[test]
fn a_circle_lies_in_the_plane_that_is_selected() {
    // G18: clockwise seen against Y, from Z to X. From (Z 0, X 0) about Z = 5 a half circle ends at Z = 10.
    let session = run("G18 G2 Z10 X0 K5 I0 F2000\nM30");
    assert_eq!(position(&session), [0.0, 0.0, 10.0]);
}

#[test]
fn a_helix_moves_the_third_axis_along() {
    let session = run("G17 G3 X0 Y0 I10 J0 Z-6 TURN=2 F3000\nM30");
    assert_eq!(position(&session), [0.0, 0.0, -6.0]);
}

#[test]
fn offsets_add_up_and_one_block_can_suppress_them() {
    let nc = "$P_UIFR[1,X,TR]=100\nG54 G0 X1 Y2\nTRANS Y10\nX2 Y3\nG53 Y0\nATRANS X5\nX0 Y0\nM30";
    // X: 100 + 5 + 0, Y: 10 + 0.
    assert_eq!(position(&run(nc)), [105.0, 10.0, 0.0]);
    assert_eq!(position(&run("$P_UIFR[2,X,TR]=7\nG55 G0 X1\nG500 X1\nM30")), [1.0, 0.0, 0.0]);
}

#[test]
fn inches_are_25_4_millimetres() {
    assert_eq!(position(&run("G70 G0 X1\nG71 Y1\nM30")), [25.4, 1.0, 0.0]);
}

/// G60: exact stop at each end. G64: the corner of 0° is passed without a stop.
#[test]
fn continuous_path_mode_passes_block_ends_and_exact_stop_does_not() {
    let blocks: String = (1..=20).map(|number| format!("X{}\n", number * 2)).collect();
    let continuous = duration(&format!("G64 G1 F6000\n{blocks}M30"));
    let exact = duration(&format!("G60 G1 F6000\n{blocks}M30"));
    // 40 mm at 100 mm/s are 0.4 s, 0.05 s for the ramps, and at most 0.15 s for the exact stop before M30.
    assert!((0.44..0.60).contains(&continuous), "{continuous}");
    assert!(exact > 20.0 * 0.1, "{exact}");
}

#[test]
fn a_dwell_takes_its_time() {
    let seconds = duration("G4 F1.5\nM30");
    assert!((1.5..1.52).contains(&seconds), "{seconds}");
}

#[test]
fn a_positioning_axis_goes_its_own_way() {
    let mut session = automatic("POS[A]=90 FA[A]=10\nPOSA[Z]=50 FA[Z]=1000 X10 F1000\nN30 Y1\nWAITP(Z)\nM30");
    start(&mut session);
    // 90° at 10 rev/min are 1.5 s.
    session.wait("A.position > 89.9", "2s").unwrap();
    // POSA does not hold the change of the block: Y moves while Z is still on its way.
    session.wait("Y.position > 0.9", "2s").unwrap();
    session.expect("Z.position < 25").unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session), [10.0, 1.0, 50.0]);
}

/// M30 waits for what POSA has started.
#[test]
fn a_program_ends_when_its_positioning_axes_have_arrived() {
    let mut session = automatic("POSA[A]=20\nM30");
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "20s").unwrap();
    session.expect("A.setpoint == 20 && !A.traverse_command_plus").unwrap();
}

#[test]
fn a_modulo_axis_takes_the_shortest_way() {
    // From 350° to 10° are 20° forward: no value between 20° and 340° is passed.
    let mut session = automatic("G0 A350\nN20 A=DC(10)\nM30");
    start(&mut session);
    session.wait("A.position > 349.9 && A.velocity == 0", "20s").unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert!((session.value("A.position").unwrap() - 370.0).abs() < 0.02, "{}", session.value("A.position").unwrap());
}

#[test]
fn the_path_keeps_its_feed_along_the_way() {
    // 3000 mm/min on a line of 3 : 4 are 1800 mm/min of X and 2400 mm/min of Y.
    let mut session = automatic("G1 X60 Y80 F3000\nM30");
    start(&mut session);
    session.run("1s").unwrap();
    session
        .expect_all(&["abs(X.velocity - 1800) < 5", "abs(X2.velocity - 1800) < 5", "abs(Y.velocity - 2400) < 5"])
        .unwrap();
}

/// O-08: the block of G74 ends when the grouping is synchronised.
#[test]
fn g74_references_axes_and_synchronises_the_grouping() {
    let mut session = automatic("G74 X=0 Y=0\nN20 R1=$AA_IM[X]\nG0 X5\nM30");
    start(&mut session);
    session.run("20ms").unwrap();
    session.expect("X.traverse_command_plus && Y.traverse_command_plus").unwrap();
    session.wait("CHAN1.m2_m30_active", "60s").unwrap();
    session
        .expect_all(&[
            "alarms() == 0",
            "X.referenced_synchronized_1 && X2.referenced_synchronized_1 && Y.referenced_synchronized_1",
            "X.gantry_grouping_is_synchronized",
            "!Z.referenced_synchronized_1",
        ])
        .unwrap();
    // MD34100 = 0: the reference point is 0.
    assert_eq!(position(&session)[0], 5.0);
}

#[test]
fn a_stop_aborts_g74_and_nc_start_begins_it_again() {
    let mut session = automatic("G74 Y=0\nM30");
    start(&mut session);
    session.run("500ms").unwrap();
    session.pulse_for("CHAN1.nc_stop", "200ms").unwrap();
    session.expect("CHAN1.program_state_stopped && Y.setpoint > 5 && alarms() == 0").unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "60s").unwrap();
    session.expect("Y.referenced_synchronized_1").unwrap();
}

/// SYN-10: all axes of the grouping lose reference and synchronism, and nothing moves.
#[test]
fn preseton_sets_the_value_and_takes_reference_and_synchronism_away() {
    let mut session = automatic("G74 X=0\nM0\nPRESETON(X,100)\nM0\nG0 X101\nM30");
    start(&mut session);
    session.wait("CHAN1.m0_m1_active", "60s").unwrap();
    session.expect("X.gantry_grouping_is_synchronized && X2.referenced_synchronized_1").unwrap();
    let slides = ["X.slide", "X2.slide"].map(|value| session.value(value).unwrap());
    start(&mut session);
    session.wait("CHAN1.m0_m1_active", "5s").unwrap();
    assert_eq!(position(&session)[0], 100.0);
    session
        .expect_all(&[
            "abs(X2.position - 100) < 0.02",
            "!X.referenced_synchronized_1 && !X2.referenced_synchronized_1",
            "!X.gantry_grouping_is_synchronized",
        ])
        .unwrap();
    for (value, before) in ["X.slide", "X2.slide"].into_iter().zip(slides) {
        // The axis was still settling by some micrometres.
        assert!((session.value(value).unwrap() - before).abs() < 0.01, "{value}");
    }
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session)[0], 101.0);
}

/// SYN-10: PRESET of the operator; not while the axis moves (22321), and not on a synchronous axis.
#[test]
fn preset_of_the_operator_acts_on_the_leading_axis_at_standstill() {
    let mut session = automatic("X50 F3000\nM30");
    assert!(session.preset("X2", 1.0).unwrap_err().to_string().contains("found X2"));
    start(&mut session);
    session.run("100ms").unwrap();
    session.preset("X", 7.0).unwrap();
    session.run("1cycles").unwrap();
    session.expect("alarm(22321) && X.setpoint < 6").unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    session.set("DB11.DBX0.0", 0).unwrap();
    session.set("DB11.DBX0.2", 1).unwrap();
    session.run("100ms").unwrap();
    session.preset("X", 7.0).unwrap();
    session.run("10ms").unwrap();
    session.expect("X.setpoint == 7 && abs(X2.position - 7) < 0.02").unwrap();
}

/// FGROUP: F counts for its axes only. 100 mm of X at 6000 mm/min are 1 s; X and Y together go 141.4 mm, 1.414 s.
#[test]
fn the_path_feed_refers_to_the_axes_of_fgroup() {
    let line = "G1 X100 Y100 F6000\nM30";
    let (both, only_x) = (duration(line), duration(&format!("FGROUP(X)\n{line}")));
    assert!((both - only_x - 0.414).abs() < 0.03, "{both} {only_x}");
    let back = duration(&format!("FGROUP(X)\nFGROUP()\n{line}"));
    assert!((both - back).abs() < 0.01, "{both} {back}");
    assert_eq!(position(&run("FGROUP(Y)\nG1 X10 F6000\nM30"))[0], 10.0);
}

/// SOFT: the path acceleration of X, Y and Z is √(2² + 2² + 2²) = 3.464 m/s²; at MD20600 = 10 m/s³ it rises within 0.3464 s, 174 cycles of
/// 2 ms. With A, whose 5 rev/s² count as 1.8 m/s², the path has 3.904 m/s² and needs 196 cycles: 44 ms longer.
#[test]
fn soft_limits_the_jerk_of_the_axes_of_fgroup() {
    let time = |nc: &str| {
        let mut session = automatic(nc);
        session.machine_data("20600[CHAN1]", 10.0).unwrap();
        session.new_conf().unwrap();
        session.run("1cycles").unwrap();
        start(&mut session);
        session.wait("X.setpoint > 0", "5s").unwrap();
        let before = session.time().seconds();
        session.wait("X.setpoint == 50", "5s").unwrap();
        session.time().seconds() - before
    };
    let line = "SOFT G1 X50 F6000\nM30";
    let (geometry, all) = (time(line), time(&format!("FGROUP(X,Y,Z,A)\n{line}")));
    assert!((all - geometry - 0.044).abs() < 0.0021, "{geometry} {all}");
    // BRISK: 50 mm at 100 mm/s and 2 m/s² take 0.5 s + 0.05 s. SOFT: 173 cycles more.
    assert!((geometry - 0.55 - 0.346).abs() < 0.01, "{geometry}");
}

/// P-142: limits of the working area are programmed in the unit of the block, and SD43420 and SD43430 have that of the basic system.
#[test]
fn the_working_area_has_the_unit_of_its_block() {
    for (unit, end) in [("G71", 10.0), ("G710", 10.0), ("G70", 254.0), ("G700", 254.0)] {
        let read = "R1=$SA_WORKAREA_LIMIT_PLUS[X]\nR2=$SA_WORKAREA_LIMIT_MINUS[X]\nM30";
        let mut session = run(&format!("{unit}\nG26 X10\nG25 X-10\n{read}"));
        session.expect(&format!("abs(R1 - {end}) < 0.00001 && abs(R2 + {end}) < 0.00001")).unwrap();
    }
    // Speeds have no unit of length.
    let mut session = Session::open("machine_data/mill").unwrap().with_program(enable_all().boxed());
    session.wait("SP1.speed_controller_active", "1s").unwrap();
    session.set("mode_group_1.mode_automatic", 1).unwrap();
    let read = "R1=$SA_SPIND_MAX_VELO_G26[SP1]\nR2=$SA_SPIND_MIN_VELO_G25[SP1]\nM30";
    session.nc(&format!("G700\nG26 S400\nG25 S10\n{read}"), 1).unwrap();
    session.run("1cycles").unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active || alarms() > 0", "5s").unwrap();
    session.expect("alarms() == 0 && R1 == 400 && R2 == 10").unwrap();
}

/// MD30455 bit 2: with G90 a modulo axis takes the shortest way. From 350 degrees to 10: 20 degrees forward, else 340 back.
#[test]
fn g90_of_a_modulo_axis_can_take_the_shortest_way() {
    for (mask, end) in [(0, 10.0), (4, 370.0)] {
        for (word, end) in [("G0 A10", end), ("POS[A]=10", end), ("G0 A=AC(10)", 10.0), ("TRANS A10\nG0 A0", end)] {
            let mut session = automatic(&format!("G0 A=AC(350)\nM0\n{word}\nM30"));
            session.machine_data("30455[A]", mask).unwrap();
            session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
            start(&mut session);
            session.wait("CHAN1.m0_m1_active", "10s").unwrap();
            start(&mut session);
            session.wait("CHAN1.m2_m30_active || alarms() > 0", "60s").unwrap();
            session.expect(&format!("alarms() == 0 && abs(A.setpoint - {end}) < 0.001")).unwrap();
        }
    }
}

/// Axis disable (1.3): the setpoint goes to 20 and the axis stays at 0. $VA_IM is the setpoint; with MD30455 bit 3 the actual value.
#[test]
fn the_actual_value_of_a_disabled_axis() {
    for (mask, value) in [(0, 20.0), (8, 0.0)] {
        let mut session = automatic("G0 X20\nR1=$VA_IM[X] R2=$AA_IM[X]\nM30");
        session.machine_data("30455[X]", mask).unwrap();
        session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
        session.set("X.axis_spindle_disable", 1).unwrap();
        start(&mut session);
        session.wait("CHAN1.m2_m30_active || alarms() > 0", "20s").unwrap();
        session.expect(&format!("alarms() == 0 && abs(R1 - {value}) < 0.02 && R2 == 20")).unwrap();
    }
}

/// G70 and G71 act where an offset is programmed: one inch stays 25.4 mm.
#[test]
fn an_offset_in_inches_stays_where_it_is() {
    assert_eq!(position(&run("G70 TRANS X1\nG71 G0 X10\nM30"))[0], 35.4);
}

/// $AA_TYP: 1 an axis of the program, 7 a synchronous axis of a closed grouping, 2 a neutral axis.
#[test]
fn the_type_of_a_synchronous_axis_is_coupled() {
    let mut session = run("R1=$AA_TYP[X] R2=$AA_TYP[X2]\nRELEASE(Z)\nR3=$AA_TYP[Z]\nM30");
    session.expect("R1 == 1 && R2 == 7 && R3 == 2").unwrap();
}

/// MD36600. The cycle of 2 ms in which the switch is read is still a movement of 0.2 mm at 100 mm/s. On the ramp of 2 m/s², 4 mm/s in each cycle,
/// (96 + 92 + … + 4) mm/s in 24 cycles are 2.4 mm more.
#[test]
fn a_positioning_axis_stops_at_its_hardware_limit_switch() {
    for (mode, least, most) in [(0, 2.59, 2.61), (1, -0.001, 0.201)] {
        let mut session = automatic("POS[Z]=100 FA[Z]=6000\nM30");
        session.machine_data("36600[Z]", mode).unwrap();
        session.new_conf().unwrap();
        start(&mut session);
        session.wait("Z.setpoint > 50", "5s").unwrap();
        let before = session.value("Z.setpoint").unwrap();
        session.force("Z.hardware_limit_switch_plus", 1).unwrap();
        session.run("200ms").unwrap();
        let way = session.value("Z.setpoint").unwrap() - before;
        assert!(way > least && way < most, "{mode}: {way}");
        session.release("Z.hardware_limit_switch_plus").unwrap();
        session.run("200ms").unwrap();
        session.expect("alarm(21614, Z) && CHAN1.program_state_running && Z.velocity == 0").unwrap();
        assert!((session.value("Z.setpoint").unwrap() - before - way).abs() < 1e-9);
    }
}
