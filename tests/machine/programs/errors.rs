//! Blocks that cannot be executed, and starts that are refused.

use super::{automatic, position, start};
use opennck::plc::enable_all;
use opennck::scenario::Session;

/// Everything before the bad block is executed, nothing of the block, and NC start reads it again.
#[test]
fn a_bad_block_stops_the_program_before_it() {
    let mut session = automatic("N10 G1 X5 F6000\nN20 FOO=3\nM30");
    start(&mut session);
    session.wait("alarms() > 0", "5s").unwrap();
    session.expect_all(&["alarm(12550)", "CHAN1.program_state_stopped", "CHAN1.channel_state_interrupted"]).unwrap();
    assert_eq!(position(&session)[0], 5.0);
    let text = session.text();
    assert!(text.contains("N20") && text.contains("FOO"), "{text}");
    // NC start cancels the alarm, reads the block again, and finds the same.
    start(&mut session);
    session.run("10ms").unwrap();
    session.expect("alarm(12550) && CHAN1.program_state_stopped").unwrap();
    session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
    session.run("10ms").unwrap();
    session.expect("alarms() == 0 && CHAN1.program_state_aborted").unwrap();
}

/// The text of the alarm ends with the reason that `opennck nc check` prints (P-145), after power off and on, too.
#[test]
fn the_alarm_of_a_block_says_why() {
    let why = "syntax error I: I is an address: a name has two letters or `_` at its beginning";
    let mut session = automatic("N10 DEF INT I\nM30");
    start(&mut session);
    session.wait("alarm(12080)", "5s").unwrap();
    assert!(session.text().contains(&format!("block N10 {why}")), "{}", session.text());
    session.power_on().unwrap();
    assert!(session.text().contains(why), "{}", session.text());
    // An alarm that the channel finds has no more words than its text.
    let mut session = automatic("G1 X2=5 F100\nM30");
    start(&mut session);
    session.wait("alarm(14092)", "5s").unwrap();
    assert!(session.text().contains("wrong type of axis X2  ("), "{}", session.text());
}

#[test]
fn a_bad_block_that_is_jumped_over_is_never_noticed() {
    let session = super::run("GOTOF GOOD\nFOO=3\nGOOD: X1 F6000\nM30");
    assert_eq!(position(&session)[0], 1.0);
}

#[test]
fn each_error_has_its_alarm() {
    for (nc, alarm) in [
        ("G1 X1\nM30", 10860),
        ("X1 F0\nM30", 14800),
        ("G999\nM30", 12470),
        ("R1=1/0\nM30", 14051),
        ("L99\nM30", 14011),
        ("GOTOF NOWHERE\nM30", 14080),
        ("G2 X10 Y0 CR=2 F1000\nM30", 14095),
        ("G2 X10 Y0 I1 J0 F1000\nM30", 14040),
        // K is no centre in G17; beside I it stays without effect.
        ("G2 X10 Y0 K5 F1000\nM30", 14040),
        ("X2=5 F1000\nM30", 14092),
        ("POS[X2]=5\nM30", 14092),
        ("G74 X2=0\nM30", 16794),
        ("X1 F1000", 14000),
        ("POS[Z]=1 FA[Z]=0\nM30", 10861),
        ("R100=1\nM30", 17020),
        ("SPOS=90\nM30", 16100),
        // P-143: a function that names a spindle by its number needs it.
        ("M3=3\nM30", 16100),
        ("S2=500\nM30", 16100),
        ("G41 X1 F100\nM30", 12553),
        ("G0 A=DC(400)\nM30", 16830),
        ("G0 A400\nM30", 16830),
        ("POS[A]=AC(-1)\nM30", 16830),
        ("G0 X1EX30\nM30", 14088),
        ("POS[X]=-1EX30\nM30", 14088),
        ("G0 X1EX30=5\nM30", 12550),
    ] {
        let mut session = automatic(nc);
        start(&mut session);
        session.wait("alarms() > 0", "5s").unwrap();
        assert_eq!(session.value(&format!("alarm({alarm})")).unwrap(), 1.0, "{nc}: {}", session.text());
    }
}

/// 10720: the end is behind a software limit switch; only a referenced axis has one.
#[test]
fn a_target_behind_a_software_limit_is_refused_when_the_axis_is_referenced() {
    let mut session = automatic("G0 Y50\nY150\nM30");
    session.machine_data("36110[Y]", 100.0).unwrap();
    session.new_conf().unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "10s").unwrap();
    assert_eq!(position(&session)[1], 150.0);
}

#[test]
fn nc_start_without_a_program_is_refused() {
    let mut session = automatic("M30");
    session.run("10ms").unwrap();
    let mut other = Session::open("machine_data/portal").unwrap();
    other.set("mode_group_1.mode_automatic", 1).unwrap();
    other.run("100ms").unwrap();
    start(&mut other);
    other.expect("alarm(14014)").unwrap();
}

#[test]
fn nc_start_of_a_program_that_runs_is_refused() {
    let mut session = automatic("X100 F1000\nM30");
    start(&mut session);
    session.run("50ms").unwrap();
    start(&mut session);
    session.expect("alarm(16920) && CHAN1.program_state_running").unwrap();
}

#[test]
fn nc_start_with_an_alarm_that_disables_it_is_refused() {
    // 14000 is cancelled by RESET only.
    let mut session = automatic("X1 F6000");
    start(&mut session);
    session.wait("alarm(14000)", "5s").unwrap();
    start(&mut session);
    session.expect("alarm(16919)").unwrap();
}

/// MIS-03, MIS-11: a synchronous axis cannot be programmed, and its coupling cannot be changed by a program.
#[test]
fn a_program_cannot_couple_or_move_a_synchronous_axis() {
    for (nc, alarm) in [
        ("TRAILON(X2,Y,1)\nM30", 16779),
        ("TRAILON(Y,X2,1)\nM30", 14092),
        ("TRAILON(X2,X2,1)\nM30", 16785),
        ("TRAILOF(X2,Y)\nM30", 16796),
        ("TRAILON(Y,Z,1)\nM30", 12553),
        ("PRESETON(X2,5)\nM30", 14092),
        ("POSA[X2]=5\nM30", 14092),
    ] {
        let mut session = automatic(nc);
        start(&mut session);
        session.wait("alarms() > 0", "5s").unwrap();
        assert_eq!(session.value(&format!("alarm({alarm})")).unwrap(), 1.0, "{nc}: {}", session.text());
    }
}

#[test]
fn cycle_alarms_stop_or_only_say_something() {
    let mut session = automatic(
        "SETAL(65000,\"A remark\")\nX1 F6000\nSETAL(62000,\"The tool is missing in place 7\")\nX2\nSETAL(61000)\nX3\nM30",
    );
    start(&mut session);
    session.wait("alarm(62000)", "5s").unwrap();
    session.expect("alarm(65000) && CHAN1.program_state_stopped").unwrap();
    assert_eq!(position(&session)[0], 1.0);
    assert!(session.text().contains("The tool is missing in place 7"), "{}", session.text());
    start(&mut session);
    session.wait("alarm(61000)", "5s").unwrap();
    session.expect("!alarm(62000)").unwrap();
    assert_eq!(position(&session)[0], 2.0);
    // Only RESET helps.
    start(&mut session);
    session.run("100ms").unwrap();
    assert_eq!(position(&session)[0], 2.0);
    session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
    session.run("10ms").unwrap();
    session.expect("!alarm(61000) && CHAN1.program_state_aborted").unwrap();
}

/// G25, G26 write the limits, SD43400 and 43410 enable them, WALIMOF switches them off; only referenced axes.
#[test]
fn the_working_area_limits_the_path_of_referenced_axes() {
    let nc = |walim: &str| format!("G74 Y=0\n$SA_WORKAREA_PLUS_ENABLE[Y]=1\nG26 Y50\n{walim}\nG0 Y40\nN60 Y60\nM30");
    let mut session = automatic(&nc("WALIMON"));
    start(&mut session);
    session.wait("alarms() > 0", "60s").unwrap();
    session.expect("alarm(10730)").unwrap();
    assert_eq!(position(&session)[1], 40.0);
    assert_eq!(position(&super::run(&nc("WALIMOF")))[1], 60.0);
}

/// nc_programs 1.6: an alarm of SETAL that stops lets nothing behind it calculate; one that is only shown does.
#[test]
fn nothing_is_calculated_behind_a_cycle_alarm_that_stops() {
    for (number, calculated) in [(61_000, 0.0), (62_000, 0.0), (65_000, 1.0)] {
        let mut session = automatic(&format!("R1=0\nN10 SETAL({number})\nR1=1\nM30"));
        start(&mut session);
        session.run("200ms").unwrap();
        session.expect(&format!("alarm({number}) && R1 == {calculated}")).unwrap();
    }
}

/// nc_programs 1.6: an axis that POSA still moves is not positioned again: 10610, which needs RESET.
#[test]
fn an_axis_that_posa_still_moves_is_not_positioned_again() {
    // 100 mm at 600 mm/min last 10 s.
    let mut session = automatic("POSA[Z]=100 FA[Z]=600\nN20 POSA[Z]=50\nM30");
    start(&mut session);
    session.run("1s").unwrap();
    session.expect("alarm(10610) && CHAN1.program_state_stopped && CHAN1.block == 20").unwrap();
    assert!(session.text().contains("axis Z block N20"), "{}", session.text());
    session.pulse("CHAN1.channel_reset").unwrap();
    session.run("1s").unwrap();
    session.expect("alarms() == 0 && CHAN1.program_state_aborted && Z.setpoint < 50").unwrap();
}

/// The program and the block of an alarm are shown: those of the subprogram, also for an error that preparation finds.
#[test]
fn the_program_in_which_an_alarm_is_is_shown() {
    for (bad, alarm) in [("FOO=3", 12550), ("G2 X10 Y0 I1 J0 F1000", 14040)] {
        let text = format!(
            "%_N_MAIN_MPF\nN10 G1 X5 F6000\nN20 CIRCLE\nN30 M30\n%_N_CIRCLE_SPF\nN100 R1=1\nN110 {bad}\nN120 M17\n"
        );
        let mut session = automatic(&text);
        session.watch(&["CHAN1.program"]).unwrap();
        start(&mut session);
        session.expect("CHAN1.block == 10").unwrap();
        session.wait(&format!("alarm({alarm})"), "5s").unwrap();
        session.run("1cycles").unwrap();
        session.expect("CHAN1.block == 110 && CHAN1.program_state_stopped").unwrap();
        let text = session.sequence();
        assert!(text.contains("MAIN.MPF -> CIRCLE.SPF"), "{text}");
    }
}

/// 16830 also for a spindle; an incremental angle has no range, and MD30455 bit 0 makes absolute ones count modulo 360.
#[test]
fn a_spindle_is_positioned_within_a_revolution() {
    let mill = |nc: &str, mask: i64| {
        let mut session = Session::open("machine_data/mill").unwrap().with_program(enable_all().boxed());
        session.machine_data("30455[SP1]", mask).unwrap();
        session.new_conf().unwrap();
        session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
        session.wait("SP1.speed_controller_active", "1s").unwrap();
        session.set("mode_group_1.mode_automatic", 1).unwrap();
        session.nc(nc, 1).unwrap();
        session.run("1cycles").unwrap();
        start(&mut session);
        session.wait("CHAN1.m2_m30_active || alarms() > 0", "60s").unwrap();
        session
    };
    for nc in ["SPOS=400\nM30", "SPOSA=DC(360)\nM30", "SPOS=-90\nM30"] {
        mill(nc, 0).expect("alarm(16830) && CHAN1.program_state_stopped").unwrap();
    }
    mill("SPOS=0\nSPOS=IC(400)\nM30", 0).expect("alarms() == 0").unwrap();
    // 400 degrees are 40: beside 39, one degree in plus direction.
    let mut session = mill("SPOS=39\nR1=$AA_IM[SP1]\nSPOS=400\nR2=$AA_IM[SP1]\nM30", 1);
    session.expect("alarms() == 0 && abs(R2 - R1 - 1) < 0.05").unwrap();
}

/// DA828 14769: with MD20850 SPOS is also M19, so five M functions beside it are one too many.
#[test]
fn an_implicit_m19_counts_among_the_m_functions_of_its_block() {
    for (m, fits) in [("M10 M11 M12 M13", true), ("M10 M11 M12 M13 M14", false)] {
        let mut session = Session::open("machine_data/mill").unwrap().with_program(enable_all().boxed());
        session.machine_data("20850[CHAN1]", 1).unwrap();
        session.power_on().unwrap();
        session.wait("SP1.speed_controller_active", "1s").unwrap();
        session.set("mode_group_1.mode_automatic", 1).unwrap();
        session.nc(&format!("N10 {m} SPOS=90\nM30"), 1).unwrap();
        session.run("1cycles").unwrap();
        start(&mut session);
        session.wait("CHAN1.m2_m30_active || alarms() > 0", "20s").unwrap();
        session.expect(if fits { "alarms() == 0" } else { "alarm(14769) && CHAN1.block == 10" }).unwrap();
    }
}

/// DA828 20141: the path moves the axis, so a synchronised action cannot. 12560: a value that is known in the main run only, and that M cannot have.
#[test]
fn actions_that_are_not_possible_raise_their_alarms_in_the_main_run() {
    for (action, alarm) in [("POS[X]=3", 20141), ("POS[A]=400", 20140), ("M=$AA_IM[X]/7", 12560)] {
        let mut session = automatic(&format!("WHEN $AA_IM[X]>5 DO {action}\nN20 G1 X20 F1000\nM30"));
        start(&mut session);
        session.wait("alarms() > 0 || CHAN1.m2_m30_active", "5s").unwrap();
        session.expect(&format!("alarm({alarm}) && X.setpoint > 4.9 && X.setpoint < 6")).unwrap();
    }
}

/// O-37: NC start reads the block of a correctable alarm again, whoever found the error, with the R parameters that it finds then. What was
/// calculated before it is not calculated again, and what was read behind it counts once.
#[test]
fn a_block_is_read_again_with_the_r_parameters_of_then() {
    // 14088 is found by the channel, 14051 by the interpreter.
    for (bad, wrong, right) in [("X=R1", 1e12, 5.0), ("X=10/R1", 0.0, 2.0)] {
        let nc = format!("R2=R2+1\nN10 G0 X1\nR2=R2+10\nN20 {bad}\nR2=R2+100\nN30 M30");
        let mut session = automatic(&nc);
        session.r_parameter("R1", wrong).unwrap();
        start(&mut session);
        session.wait("alarms() > 0", "5s").unwrap();
        session.expect("CHAN1.program_state_stopped && CHAN1.block == 20 && X.setpoint == 1 && R2 == 11").unwrap();
        // Not corrected: the alarm comes again.
        start(&mut session);
        session.run("50ms").unwrap();
        session.expect("alarms() == 1 && CHAN1.program_state_stopped").unwrap();
        session.r_parameter("R1", right).unwrap();
        start(&mut session);
        session.wait("CHAN1.m2_m30_active", "5s").unwrap();
        session.expect("X.setpoint == 5 && R2 == 111 && alarms() == 0").unwrap();
    }
}
