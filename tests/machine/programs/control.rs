//! Start, stop, single block, RESET, interruption: the program states 35.0 to 35.4 and the channel states 35.5 to 35.7.

use super::{automatic, position, run, start};
use opennck::scenario::Session;

/// 35.0 running, 35.1 wait, 35.2 stopped, 35.3 interrupted, 35.4 aborted; 35.5 active, 35.6 interrupted, 35.7 reset: exactly one of each.
fn states(session: &Session) -> (&'static str, &'static str) {
    let shown = |names: &[&'static str], prefix: &str| {
        let set: Vec<_> =
            names.iter().filter(|name| session.value(&format!("CHAN1.{prefix}_{name}")).unwrap() == 1.0).collect();
        assert_eq!(set.len(), 1, "{set:?}");
        *set[0]
    };
    (
        shown(&["running", "wait", "stopped", "interrupted", "aborted"], "program_state"),
        shown(&["active", "interrupted", "reset"], "channel_state"),
    )
}

#[test]
fn a_program_runs_from_nc_start_to_m30() {
    let mut session = automatic("G1 X10 F6000\nM30");
    assert_eq!(states(&session), ("aborted", "reset"));
    start(&mut session);
    assert_eq!(states(&session), ("running", "active"));
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(states(&session), ("aborted", "reset"));
    // 33.5 goes with the next start.
    start(&mut session);
    session.expect("!CHAN1.m2_m30_active && CHAN1.program_state_running").unwrap();
}

#[test]
fn nc_stop_brakes_on_the_path_and_nc_start_goes_on() {
    let mut session = automatic("G1 X30 Y40 F3000\nM30");
    start(&mut session);
    session.run("300ms").unwrap();
    session.set("CHAN1.nc_stop", 1).unwrap();
    session.run("200ms").unwrap();
    assert_eq!(states(&session), ("stopped", "interrupted"));
    session.expect("abs(X.velocity) < 10 && abs(Y.velocity) < 10 && X.position > 5").unwrap();
    // On the line: 3 : 4.
    let [x, y, _] = position(&session);
    assert!((x / 3.0 - y / 4.0).abs() < 0.01, "{x} {y}");
    // While 7.3 is 1, NC start has no effect.
    start(&mut session);
    session.run("20ms").unwrap();
    assert_eq!(states(&session), ("stopped", "interrupted"));
    session.set("CHAN1.nc_stop", 0).unwrap();
    start(&mut session);
    assert_eq!(states(&session), ("running", "active"));
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session), [30.0, 40.0, 0.0]);
}

#[test]
fn nc_stop_at_the_block_limit_ends_the_block() {
    let mut session = automatic("G64 G1 X10 F3000\nX20\nX30\nM30");
    start(&mut session);
    session.run("100ms").unwrap();
    session.set("CHAN1.nc_stop_at_block_limit", 1).unwrap();
    session.wait("CHAN1.program_state_stopped", "5s").unwrap();
    assert_eq!(position(&session)[0], 10.0);
    session.set("CHAN1.nc_stop_at_block_limit", 0).unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
}

#[test]
fn reset_ends_the_program_when_the_axes_stand() {
    let mut session = automatic("G1 X100 F6000\nM30");
    start(&mut session);
    session.run("500ms").unwrap();
    session.set("CHAN1.channel_reset", 1).unwrap();
    session.run("1cycles").unwrap();
    // The axis brakes from 100 mm/s with 2 m/s²: 50 ms.
    assert_eq!(states(&session), ("running", "active"));
    session.run("100ms").unwrap();
    assert_eq!(states(&session), ("aborted", "reset"));
    session.expect("X.position < 60 && !CHAN1.m2_m30_active").unwrap();
    session.set("CHAN1.channel_reset", 0).unwrap();
    session.run("10ms").unwrap();
    // It begins again at its first block.
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "10s").unwrap();
    assert_eq!(position(&session)[0], 100.0);
}

#[test]
fn single_block_stops_after_each_block_that_moves() {
    let mut session = automatic("R1=5\nG1 X10 F6000\nR2=6\nX20\nM30");
    session.set("CHAN1.activate_single_block", 1).unwrap();
    start(&mut session);
    session.wait("CHAN1.program_state_stopped", "5s").unwrap();
    assert_eq!((position(&session)[0], states(&session)), (10.0, ("stopped", "interrupted")));
    start(&mut session);
    session.wait("CHAN1.program_state_stopped", "5s").unwrap();
    assert_eq!(position(&session)[0], 20.0);
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
}

#[test]
fn m0_stops_always_and_m1_if_it_is_selected() {
    let mut session = automatic("X1 F6000\nM0\nX2\nM1\nX3\nM1\nX4\nM30");
    start(&mut session);
    session.wait("CHAN1.m0_m1_active", "5s").unwrap();
    assert_eq!((position(&session)[0], states(&session)), (1.0, ("stopped", "interrupted")));
    session.set("CHAN1.activate_m01", 1).unwrap();
    start(&mut session);
    session.expect("!CHAN1.m0_m1_active").unwrap();
    session.wait("CHAN1.m0_m1_active", "5s").unwrap();
    assert_eq!(position(&session)[0], 2.0);
    session.set("CHAN1.activate_m01", 0).unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session)[0], 4.0);
}

#[test]
fn read_in_disable_holds_the_block_change_and_the_states_stay() {
    let mut session = automatic("G64 G1 X10 F3000\nX20\nM30");
    start(&mut session);
    session.run("50ms").unwrap();
    session.set("CHAN1.read_in_disable", 1).unwrap();
    session.run("2s").unwrap();
    assert_eq!((position(&session)[0], states(&session)), (10.0, ("running", "active")));
    session.set("CHAN1.read_in_disable", 0).unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
}

#[test]
fn feed_disable_feed_stop_and_an_override_of_zero_hold_the_path_and_keep_the_traverse_command() {
    for signal in ["CHAN1.feed_disable", "X.feed_stop"] {
        let mut session = automatic("G1 X20 Y20 F3000\nM30");
        start(&mut session);
        session.run("100ms").unwrap();
        session.set(signal, 1).unwrap();
        session.run("200ms").unwrap();
        session
            .expect(
                "abs(X.velocity) < 10 && abs(Y.velocity) < 10 && X.traverse_command_plus && X2.traverse_command_plus",
            )
            .unwrap();
        assert_eq!(states(&session), ("running", "active"), "{signal}");
        session.set(signal, 0).unwrap();
        session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    }
    let mut session = automatic("G1 X20 F3000\nM30");
    session.set("CHAN1.feed_override_active", 1).unwrap();
    session.set("CHAN1.feed_override", "50%").unwrap();
    start(&mut session);
    session.run("200ms").unwrap();
    session.expect("abs(X.velocity - 1500) < 5").unwrap();
    session.set("CHAN1.feed_override", "0%").unwrap();
    session.run("200ms").unwrap();
    session.expect("abs(X.velocity) < 10 && CHAN1.program_state_running").unwrap();
}

#[test]
fn delete_distance_to_go_drops_the_rest_of_the_block() {
    let mut session = automatic("G1 X100 F3000\nY5\nM30");
    start(&mut session);
    session.run("500ms").unwrap();
    session.pulse_for("CHAN1.delete_distance_to_go", "5cycles").unwrap();
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    let [x, y, _] = position(&session);
    assert!((20.0..30.0).contains(&x) && y == 5.0, "{x} {y}");
}

#[test]
fn skip_levels_leave_blocks_out() {
    let mut session = automatic("X1 F6000\n/X2\n/1 X3\nM30");
    session.set("CHAN1.skip_block_level_1", 1).unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session)[0], 2.0);
}

#[test]
fn the_dry_run_moves_with_its_own_feed() {
    // SD42100 = 5000 is the greater one (SD42101 = 0).
    let mut session = automatic("X50 F1000\nM30");
    session.set("CHAN1.activate_dry_run_feedrate", 1).unwrap();
    start(&mut session);
    session.run("200ms").unwrap();
    session.expect("abs(X.velocity - 5000) < 20").unwrap();
}

#[test]
fn a_program_interrupted_in_jog_returns_to_its_path() {
    let mut session = automatic("G1 X30 Y40 F3000\nM30");
    start(&mut session);
    session.run("300ms").unwrap();
    session.pulse_for("CHAN1.nc_stop", "200ms").unwrap();
    session.set("mode_group_1.mode_automatic", 0).unwrap();
    session.set("mode_group_1.mode_jog", 1).unwrap();
    session.run("10ms").unwrap();
    assert_eq!(states(&session), ("interrupted", "interrupted"));
    session.set("Y.traversing_key_minus", 1).unwrap();
    session.run("100ms").unwrap();
    // 35.5 while an axis is jogged.
    assert_eq!(states(&session), ("interrupted", "active"));
    session.set("Y.traversing_key_minus", 0).unwrap();
    session.run("500ms").unwrap();
    assert_eq!(states(&session), ("interrupted", "interrupted"));
    let [x, y, _] = position(&session);
    assert!(x / 3.0 - y / 4.0 > 0.3, "{x} {y}");
    session.set("mode_group_1.mode_jog", 0).unwrap();
    session.set("mode_group_1.mode_automatic", 1).unwrap();
    session.run("10ms").unwrap();
    start(&mut session);
    session.wait("CHAN1.m2_m30_active", "5s").unwrap();
    assert_eq!(position(&session), [30.0, 40.0, 0.0]);
}

#[test]
fn a_change_to_jog_stops_a_program_that_runs() {
    let mut session = automatic("G1 X100 F3000\nM30");
    start(&mut session);
    session.run("300ms").unwrap();
    session.set("mode_group_1.mode_automatic", 0).unwrap();
    session.set("mode_group_1.mode_jog", 1).unwrap();
    session.run("200ms").unwrap();
    assert_eq!(states(&session), ("interrupted", "interrupted"));
    session.expect("abs(X.velocity) < 10").unwrap();
}

#[test]
fn an_emergency_stop_stops_the_program_and_its_reset_ends_it() {
    let mut session = automatic("G1 X100 Y50 F6000\nM30");
    start(&mut session);
    session.run("300ms").unwrap();
    session.set("nck.emergency_stop", 1).unwrap();
    session.run("1s").unwrap();
    assert_eq!(states(&session), ("stopped", "interrupted"));
    session.set("nck.emergency_stop", 0).unwrap();
    session.set("nck.acknowledge_emergency_stop", 1).unwrap();
    session.set("mode_group_1.mode_group_reset", 1).unwrap();
    session.run("1s").unwrap();
    assert_eq!(states(&session), ("aborted", "reset"));
}

#[test]
fn blocks_of_mda_run_without_m30_and_run_again() {
    let mut session = automatic("M30");
    session.set("mode_group_1.mode_automatic", 0).unwrap();
    session.set("mode_group_1.mode_mdi", 1).unwrap();
    session.mdi("G91 G0 X5", 1).unwrap();
    session.run("10ms").unwrap();
    for wanted in [5.0, 10.0] {
        start(&mut session);
        session.wait("CHAN1.program_state_aborted", "5s").unwrap();
        assert_eq!((position(&session)[0], states(&session)), (wanted, ("aborted", "reset")));
    }
}

#[test]
fn a_subprogram_repeats_and_a_jump_goes_back() {
    let session = run("R1=0\nAGAIN:\nG91 G0 X1\nR1=R1+1\nIF R1<3 GOTOB AGAIN\nFOR R2=1 TO 4\nY2\nENDFOR\nM30");
    assert_eq!(position(&session), [3.0, 8.0, 0.0]);
}

/// P-63: with MD10704 = 1 and MD10706 = 1 a change acts at once, with a short stop of the path; with 2 it acts at STOPRE.
#[test]
fn dry_run_and_skip_levels_change_at_once_or_at_stopre() {
    let session = |mask: f64, nc: &str| {
        let mut session = automatic(nc);
        session.machine_data("10704", mask).unwrap();
        session.machine_data("10706", mask).unwrap();
        session.power_on().unwrap();
        session.run("200ms").unwrap();
        super::prepare(&mut session, nc);
        start(&mut session);
        session.run("300ms").unwrap();
        session.set("CHAN1.activate_dry_run_feedrate", 1).unwrap();
        session.set("CHAN1.skip_block_level_9", 1).unwrap();
        session.run("200ms").unwrap();
        session
    };
    // 40 mm at 1000 mm/min; SD42100 = 5000 mm/min. The path has stopped, and goes on at once.
    let mut at_once = session(1.0, "G64 G1 X40 F1000\n/9 Y5\nY7\nM30");
    at_once.expect("abs(X.velocity - 5000) < 20 && CHAN1.program_state_running").unwrap();
    at_once.wait("Y.setpoint == 7", "10s").unwrap();
    assert_eq!(at_once.value("count(Y.setpoint == 5)").unwrap_or(0.0), 0.0);
    let mut at_stop = session(2.0, "G1 X10 F1000\n/9 Y5\nSTOPRE\n/9 Y10\nZ20\nM30");
    at_stop.expect("abs(X.velocity - 1000) < 20").unwrap();
    at_stop.wait("Z.setpoint > 12", "10s").unwrap();
    // The first skip block was read before STOPRE, the second one behind it.
    assert_eq!(position(&at_stop)[1], 5.0);
    at_stop.expect("abs(Z.velocity - 5000) < 150").unwrap();
    let mut at_the_end = session(0.0, "G64 G1 X10 F1000\n/9 X12\nZ20\nM30");
    at_the_end.expect("abs(X.velocity - 1000) < 20").unwrap();
    at_the_end.wait("Z.setpoint > 12", "10s").unwrap();
    // The skip level would need a stop, the dry run only the end of a block.
    assert_eq!(position(&at_the_end)[0], 12.0);
    at_the_end.expect("abs(Z.velocity - 5000) < 150").unwrap();
}

/// MD20700 = 1 and 2: NC start needs the reference points of the channel; 0: it does not.
#[test]
fn nc_start_without_reference_points_is_refused_with_md20700_of_1_and_2() {
    for (lock, refused) in [(0.0, 0.0), (1.0, 1.0), (2.0, 1.0)] {
        let mut session = automatic("R1=1\nM30");
        session.machine_data("20700[CHAN1]", lock).unwrap();
        session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
        start(&mut session);
        session.run("20ms").unwrap();
        assert_eq!(session.value("alarm(10203)").unwrap(), refused, "{lock}");
        assert_eq!(session.value("R1").unwrap(), 1.0 - refused, "{lock}");
    }
}

/// 16913: between AUTOMATIC and MDA only while no program runs or is stopped; once for each request.
#[test]
fn automatic_and_mda_exclude_each_other_while_a_program_is_stopped() {
    let mut session = automatic("X10 F3000\nM0\nM30");
    start(&mut session);
    session.wait("CHAN1.m0_m1_active", "5s").unwrap();
    session.set("mode_group_1.mode_automatic", 0).unwrap();
    session.set("mode_group_1.mode_mdi", 1).unwrap();
    session.run("10ms").unwrap();
    session.expect("alarm(16913) && mode_group_1.active_mode_automatic && CHAN1.program_state_stopped").unwrap();
    session.cancel().unwrap();
    session.run("10ms").unwrap();
    session.expect("!alarm(16913) && mode_group_1.active_mode_automatic").unwrap();
    session.pulse_for("CHAN1.channel_reset", "5cycles").unwrap();
    session.run("10ms").unwrap();
    session.expect("mode_group_1.active_mode_mdi").unwrap();
}

/// MD22410: the path feed stays over the end of a program; without it, 10860.
#[test]
fn the_path_feed_stays_over_the_end_of_a_program_with_md22410() {
    for (stays, alarm) in [(0.0, 1.0), (1.0, 0.0)] {
        let mut session = automatic("X1 F3000\nM30");
        session.machine_data("22410[CHAN1]", stays).unwrap();
        session.power_on().unwrap();
        session.run("200ms").unwrap();
        super::prepare(&mut session, "X1 F3000\nM30");
        start(&mut session);
        session.wait("CHAN1.m2_m30_active", "5s").unwrap();
        session.nc("X2\nM30", 1).unwrap();
        session.run("10ms").unwrap();
        start(&mut session);
        session.wait("CHAN1.m2_m30_active || alarm(10860)", "5s").unwrap();
        assert_eq!(session.value("alarm(10860)").unwrap(), alarm);
    }
}

/// nc_programs.md 3.4: SBL2 stops behind every block, and R parameters are those of the blocks that were executed. Each NC start is seen as a
/// cycle with 35.0 in which `block` is the one that runs.
#[test]
fn single_block_of_type_b_stops_after_calculations_and_executes_none_ahead() {
    let mut session = automatic("N10 G0 X10\nN20 R1=5\nN30 R1=R1*2\nN40 G90\nN50 STOPRE\nN60 G1 X20 F5000\nM30");
    session.set("CHAN1.activate_single_block", 1).unwrap();
    session.set("mode_group_1.single_block_type_b", 1).unwrap();
    start(&mut session);
    session.expect("CHAN1.block == 10 && R1 == 0").unwrap();
    session.wait("CHAN1.program_state_stopped", "5s").unwrap();
    session.expect("R1 == 0").unwrap();
    for (block, r) in [(20, 5), (30, 10), (40, 10), (50, 10)] {
        start(&mut session);
        session.expect(&format!("CHAN1.program_state_running && CHAN1.block == {block}")).unwrap();
        session.run("1cycles").unwrap();
        session.expect(&format!("CHAN1.program_state_stopped && CHAN1.block == {block} && R1 == {r}")).unwrap();
    }
    start(&mut session);
    session.wait("CHAN1.program_state_stopped", "5s").unwrap();
    assert_eq!(position(&session)[0], 20.0);
}

/// Type A runs through calculations, and stops behind M17 and MSG, which take no time.
#[test]
fn each_start_in_single_block_is_seen_as_running() {
    let text = "%_N_MAIN_MPF\nN10 R1=1\nN20 L7\nN30 MSG(\"A\")\nN40 G4 F0.1\nN50 M30\n%_N_L7_SPF\nN100 G1 Y5 F1000\nN110 M17\n";
    let mut session = automatic(text);
    session.set("CHAN1.activate_single_block", 1).unwrap();
    start(&mut session);
    for block in [100, 110, 30, 40] {
        session.expect(&format!("CHAN1.program_state_running && CHAN1.block == {block}")).unwrap();
        session.wait("CHAN1.program_state_stopped", "5s").unwrap();
        session.run("100ms").unwrap();
        session.expect(&format!("CHAN1.program_state_stopped && CHAN1.block == {block}")).unwrap();
        start(&mut session);
    }
    session.wait("CHAN1.m2_m30_active", "1s").unwrap();
}

/// nc_programs.md 3.5: blocks that calculate, jump or call are found like others. Three passes, each to X = 10·R1 and Y = 5·R1.
#[test]
fn a_search_finds_blocks_that_calculate_jump_or_call() {
    let text = "%_N_MAIN_MPF\nN10 R1=0\nN20 WHILE R1<3\nN30 R1=R1+1\nN40 G1 X=R1*10 F5000\nN50 L7\nN60 ENDWHILE\nN70 M30\n\
                %_N_L7_SPF\nN100 G1 Y=R1*5\nN110 M17\n";
    // Where the approach leads to, and R1 there: in the first pass.
    for (block, r, x, y) in
        [("N20", 0, 0.0, 0.0), ("N30", 0, 0.0, 0.0), ("N40", 1, 0.0, 0.0), ("N50", 1, 10.0, 0.0), ("N60", 1, 10.0, 5.0)]
    {
        for kind in ["contour", "end_point", "serupro"] {
            let mut session = automatic(text);
            session.search(block, kind, 1).unwrap();
            session.run("10ms").unwrap();
            session.wait("CHAN1.program_state_stopped", "10s").unwrap();
            if kind != "serupro" {
                start(&mut session);
            }
            session.wait("alarm(10208)", "1s").unwrap();
            session.expect(&format!("R1 == {r} && abs(X.position) < 0.01")).unwrap();
            start(&mut session);
            session.expect("!alarm(10208) && CHAN1.program_state_running").unwrap();
            session.wait("!CHAN1.approach_block_active", "5s").unwrap();
            let end = if block == "N40" && kind == "end_point" { 10.0 } else { x };
            assert_eq!(position(&session)[..2], [end, y], "{block} {kind}");
            session.wait("CHAN1.m2_m30_active || alarms() > 0", "10s").unwrap();
            session.expect("alarms() == 0 && R1 == 3").unwrap();
            assert_eq!(position(&session)[..2], [30.0, 15.0], "{block} {kind}");
        }
    }
    // A block of the subprogram is not found: 15350.
    let mut session = automatic(text);
    session.search("N100", "contour", 1).unwrap();
    session.wait("alarm(15350)", "1s").unwrap();
}

/// The approach to the end of a block with G60 ends with its exact stop: M30 comes when 60.7 = 1.
#[test]
fn the_approach_to_the_end_point_ends_with_the_exact_stop_of_the_block() {
    let mut session = automatic("N10 G60 G0 X10\nN50 G1 X100 F2000\nN60 M30");
    session.search("N50", "end_point", 1).unwrap();
    session.run("50ms").unwrap();
    start(&mut session);
    session.wait("alarm(10208)", "1s").unwrap();
    start(&mut session);
    session.wait("X.setpoint == 100", "5s").unwrap();
    session.expect("!X.position_reached_exact_stop_fine").unwrap();
    session.wait("CHAN1.decoded_m_function_30", "1s").unwrap();
    session.expect("X.position_reached_exact_stop_fine").unwrap();
}
