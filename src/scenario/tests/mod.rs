//! Scenarios: every kind of mistake, with its line and remedy, and the effect of each verb on time and memory.
//!
//! The tests of verbs use PLC flags, which only the scenario writes.

use std::path::Path;

use super::*;
use crate::image::Profile;
use crate::plc::Programs;
use crate::source::Problem;

mod causes;
mod language;

/// A head of two lines; the steps begin in line 3.
fn scenario(rest: &str) -> Result<Scenario, Problem> {
    let text = format!("title = \"t\"\nmachine = \"g1_example\"\n{rest}");
    Scenario::parse(&text, Path::new("s.toml"))
}

fn prepared(rest: &str) -> Result<Prepared, Problem> {
    scenario(rest)?.prepare(Profile::default(), &Programs::ready())
}

fn run(rest: &str) -> Finished {
    prepared(rest).unwrap_or_else(|problem| panic!("{problem}")).run()
}

/// The failure text of a run.
fn missed(rest: &str) -> String {
    run(rest).failure.expect("the run must fail").to_string()
}

fn held(rest: &str) -> Finished {
    let finished = run(rest);
    assert!(finished.failure.is_none(), "{}", finished.failure.unwrap());
    finished
}

/// 60 ms a cycle after power on: 167 cycles are the first ones that take 10 s.
#[test]
fn the_limit_and_a_wait_count_the_time_of_the_machine() {
    let slower = "[[step]]\nmachine_data = { \"10070\" = 30 }\n[[step]]\npower_on = true\n";
    let failure = missed(&format!("limit = \"10s\"\n{slower}[[step]]\nrun = \"20s\"\n"));
    assert!(failure.contains("reached the limit of 10.020 s: after 10.020 s of a run"), "{failure}");
    let failure = missed(&format!("{slower}[[step]]\nwait = \"M0.0\"\nwithin = \"1s\"\n"));
    assert!(failure.contains("waited 1.020 s for"), "{failure}");
}

const STEP: &str = "[[step]]\nrun = \"1s\"\n";

#[test]
fn every_mistake_in_the_head_names_its_line_and_a_cure() {
    for (head, line, cause, cure) in [
        ("titel = 1\n", 3, "unknown key `titel`", "did you mean `title`?"),
        ("[machine_data]\n37110[XF] = 1.5\n", 4, "key with no value", "in quotes: \"34090[XF]\" = 1.5"),
        ("profile = \"840d\"\n", 3, "a profile, found `840d`", "840d_sl"),
        ("profile = []\n", 3, "at least one profile", "840d_sl"),
        ("profile = [\"828d\", \"828d\"]\n", 3, "twice", "remove one"),
        ("plc = \"enable_al\"\n", 3, "enable_al", "did you mean `enable_all`?"),
        ("plc = 5\n", 3, "the name of a PLC program, found the integer 5", "quotes"),
        ("plc_image = \"no_such\"\n", 3, "plc_images/no_such.toml", ".toml"),
        ("limit = \"5\"\n", 3, "a duration, found `5`", "us, ms, s, min or h"),
        ("limit = 5\n", 3, "the limit of simulated time with its unit, found the integer 5", "\"5s\""),
        ("watch = [\"X.*\",\n \"X.positoin\"]\n", 4, "X.positoin", "did you mean"),
        ("causes = 1\n", 3, "found the integer 1", "true or false"),
        ("never = [\"1 <\"]\n", 3, "found the end", "operators are"),
        ("never = [\"a == 1\"]\n", 3, "a", ""),
        ("compare = \"exakt\"\n", 3, "a way to compare traces", "sequence"),
        ("compare = { tim = \"50ms\" }\n", 3, "unknown key `tim`", "did you mean `time`?"),
        ("compare = { time = \"5cycles\" }\n", 3, "a time with a unit", "50ms"),
        ("program = 5\n", 3, "the file of an NC program, found the integer 5", "quotes"),
        ("plant = 3\n", 3, "a table of plant data", "table"),
    ] {
        let problem = prepared(&format!("{head}{STEP}")).err().unwrap_or_else(|| panic!("{head} is accepted"));
        let place = problem.place.as_ref().map(ToString::to_string).unwrap_or_default();
        assert_eq!(place, format!("s.toml:{line}"), "{head}: {problem}");
        assert!(problem.what.contains(cause) && problem.cure.contains(cure), "{head}: {problem}");
    }
}

#[test]
fn a_file_without_machine_or_steps_is_refused_and_without_a_title_it_has_the_name_of_its_file() {
    for (text, cause) in [
        ("title = \"t\"\n[[step]]\nrun = \"1s\"", "the key `machine`"),
        ("title = \"t\"\nmachine = \"g1_example\"", "at least one `[[step]]`"),
        ("title = \"t\"\nmachine = \"g1_example\"\n[step]\nrun = \"1s\"", "a list of steps"),
        ("title = ", "TOML"),
    ] {
        let problem = Scenario::parse(text, Path::new("s.toml")).unwrap_err();
        assert!(problem.to_string().starts_with("s.toml") && problem.what.contains(cause), "{problem}");
    }
    let untitled = "machine = \"g1_example\"\n[[step]]\nrun = \"1s\"";
    assert_eq!(Scenario::parse(untitled, Path::new("a/cold_start.toml")).unwrap().title, "cold_start");
    let nowhere =
        Scenario::parse("title = \"t\"\nmachine = \"no/such/machine\"\n[[step]]\nrun = \"1s\"", Path::new("s.toml"));
    let problem = nowhere.unwrap().prepare(Profile::default(), &Programs::ready()).err().unwrap();
    assert!(problem.place.is_some(), "{problem}");
}

#[test]
fn every_mistake_in_a_step_names_its_line_and_a_cure() {
    for (step, line, cause, cure) in [
        ("note = \"n\"", 3, "one verb, found none", "verbs are"),
        ("sett = { \"M0.0\" = 1 }", 4, "unknown key `sett`", "did you mean `set`?"),
        ("run = \"1s\"\nwait = \"1\"", 0, "found `run` and `wait`", "one [[step]] for each"),
        ("within = \"1s\"", 4, "a verb together with `within`", "belongs to `wait`"),
        ("run = \"1s\"\nwithin = \"1s\"", 5, "`within` cannot be combined with `run`", "belongs to `wait`"),
        ("set = { \"M0.0\" = 1 }\nfor = \"1s\"", 5, "`for` cannot be combined with `set`", "belongs to `pulse`"),
        ("set = 5", 4, "signals with their values", "table"),
        ("set = { \"X.traversing_key_pls\" = 1 }", 4, "X.traversing_key_pls", "traversing_key_plus"),
        ("set = { \"Z.traversing_key_plus\" = 1 }", 4, "found `Z`", "did you mean"),
        ("set = { \"X.position\" = 1 }", 4, "found `X.position`, which is a value and not a signal", "in `watch`"),
        ("force = { \"X.velocity\" = 1 }", 4, "found `X.velocity`, which is a value and not a signal", "`expect`"),
        ("write = { \"XF.slide\" = 1 }", 4, "found `XF.slide`, which is a value and not a signal", "`capture`"),
        ("set = { \"Z.position\" = 1 }", 4, "found `Z`", "did you mean"),
        ("set = { \"AX3.controller_enable\" = 1 }", 4, "found `AX3`", "axis 3 is called `XF` on this machine (MD10000"),
        (
            "set = { \"X.feed_override\" = 100 }",
            4,
            "a Gray code from 0 to 31 for `X.feed_override`, found 100",
            "= \"100%\"",
        ),
        ("force = { \"CHAN1.feed_override\" = 32 }", 4, "for `CHAN1.feed_override`, found 32", "percentages are 0, 1"),
        ("set = { \"X.feed_override\" = -1 }", 4, "for `X.feed_override`, found -1", "any bits as \"16#FF\""),
        // g1_example has one mode group.
        (
            "set = { \"mode_group_2.mode_jog\" = 1 }",
            4,
            "signal of an existing mode group, found DB11.DBX20.2 of mode group 2",
            "the machine has mode_group_1",
        ),
        ("expect = \"mode_group_2.mode_jog\"", 4, "signal of an existing mode group", "the machine has mode_group_1"),
        ("expect = \"MD32000[X] > 1\"", 4, "found `[`", "machine data cannot be read in expressions"),
        ("expect = \"SD41110 > 1\"", 4, "found `SD41110`", "machine data cannot be read in expressions"),
        ("set = { \"DB31.DBX101.7\" = 1 }", 4, "found X.gantry_axis (DB31.DBX101.7), which the NCK writes", "expect"),
        ("set = { \"X.gantry_axis\" = 1 }", 4, "found X.gantry_axis (DB31.DBX101.7), which the NCK writes", "expect"),
        ("set = { \"DB31.DBB101\" = 1 }", 4, "which the NCK writes", "expect"),
        ("force = { \"X.gantry_synchronization_ready_to_start\" = 1 }", 4, "which the NCK writes", "expect"),
        ("pulse = [\"DB31.DBX101.4\"]", 4, "which the NCK writes", "expect"),
        ("pulse = [\"M0.0\",\n\"MB1\"]", 5, "a single bit to pulse, found `MB1`", "`set`"),
        ("set = { \"M0.0\" = 2 }", 4, "found 2", ""),
        ("set = { MB0 = 256 }", 4, "found 256", ""),
        ("set = { MB0 = -129 }", 4, "found -129", ""),
        ("set = { MB0 = 1.5 }", 4, "found the number 1.5", "REAL"),
        ("set = { MB0 = true }", 4, "found true", "single bits"),
        ("set = { MB0 = \"100%\" }", 4, "found the text \"100%\"", ""),
        ("set = { MB0 = [1] }", 4, "found an array", ""),
        ("set = { M300 = 1 }", 4, "M300", ""),
        ("release = [\"M400.0\"]", 4, "256 bytes", "255"),
        ("run = 5", 4, "the time to run with its unit, found the integer 5", "write \"5s\""),
        ("run = 0.5", 4, "the time to run with its unit, found the number 0.5", "write \"0.5s\""),
        ("run = 5s", 4, "invalid TOML", "in quotes"),
        ("wait = X.position > 5", 4, "invalid TOML", "in quotes"),
        (
            "set = { X.controller_enable = 1 }",
            4,
            "found X.controller_enable without quotes",
            "\"X.controller_enable\" = ",
        ),
        ("set = { DB31.DBX2.1 = 1 }", 4, "found DB31.DBX2.1 without quotes", "\"DB31.DBX2.1\" = "),
        ("machine_data = { 34090[XF] = 1 }", 4, "invalid TOML", "brackets in quotes"),
        ("set = { \"DB40.DBX2.1\" = 1 }", 4, "an existing axis, found DB40.DBX2.1 of axis 10", "X, Y, XF"),
        ("pulse = \"DB25.DBX7.1\"", 4, "an existing channel, found DB25.DBX7.1 of channel 5", "CHAN1"),
        ("force = { \"DB22.DBB4\" = 1 }", 4, "an existing channel, found DB22.DBB4 of channel 2", "CHAN1"),
        ("run = \"5 days\"", 4, "a duration, found `5 days`", "10cycles"),
        ("wait = \"X.ready\"", 4, "X.ready", ""),
        ("wait = \"1\"\nwithin = 5", 5, "the longest time to wait", "\"5s\""),
        ("hold = \"1\"", 4, "`during` together with `hold`", "during = "),
        ("expect = [\"1\",\n\"1 < 2 < 3\"]", 5, "one comparison", "do not chain"),
        ("expect = \"later > 1\"", 4, "later", ""),
        ("capture = { \"a.b\" = \"1\" }", 4, "a plain name", "letters, digits and underscores"),
        ("capture = { time = \"1\" }", 4, "a plain name", "`time` is reserved"),
        ("machine_data = { \"nonsense\" = 1 }", 4, "nonsense", ""),
        ("machine_data = { \"34090[XF]\" = [1] }", 4, "a value of a machine datum", "one value per index"),
        ("new_conf = false", 4, "expected true, found false", "new_conf = true"),
        ("r_parameters = { R99999 = 1 }", 4, "expected R0 to R99, found R99999", "MD28050"),
        ("r_parameters = { R100 = 1 }", 4, "R0 to R99", "MD28050"),
        ("set = { M0 = 1 }\nset = { M1 = 1 }", 5, "the key `set` a second time", "stands once"),
        ("power_on = 1", 4, "expected true, found the integer 1", "true or false"),
        ("plc = \"stopp\"", 4, "\"stop\", \"run\" or \"cold\"", "did you mean `stop`?"),
        ("handwheel = { number = 1 }", 4, "expected the key `pulses`", "number = 1, pulses = 50"),
        (
            "handwheel = { number = 4, pulses = 5, over = \"1s\" }",
            4,
            "the number of a handwheel, 1 to 3",
            "whole number",
        ),
        ("handwheel = { number = -1, pulses = 5, over = \"1s\" }", 4, "found the integer -1", "whole number"),
        ("handwheel = { number = 1, pulses = 1.5, over = \"1s\" }", 4, "expected a number of pulses", "whole number"),
        ("program = \"x.mpf\"\nchannel = 1", 4, "expected an NC program, found", "the path of an NC program"),
        ("fault = { kind = \"block\" }", 4, "the key `axis`", "axis = "),
        ("fault = { axis = \"XG\", kind = \"block\" }", 4, "a machine axis, found `XG`", "did you mean"),
        ("fault = { axis = \"XF\", kind = \"blok\" }", 4, "a kind of fault", "did you mean `block`?"),
        ("fault = { axis = \"XF\", kind = \"drift\" }", 4, "the key `by`", "by = "),
        ("fault = { axis = \"XF\", kind = \"drift\", by = 1e7 }", 4, "a velocity in mm", "1000000"),
        (
            "fault = { axis = \"XF\", kind = \"friction\", by = 1.5 }",
            4,
            "a share of the velocity",
            "1 loses everything",
        ),
        ("fault = { axis = \"XF\", kind = \"drive_fault\", by = 1 }", 4, "unknown key `by`", ""),
        ("fault = { axis = \"XF\", kind = \"encoder_fault\", encoder = 3 }", 4, "encoder 1 or 2", "active"),
        ("fault = { axis = \"XF\", kind = \"push\" }", 4, "the key `by`", "by = "),
        ("fault = { axis = \"XF\", kind = \"block\", by = 1 }", 4, "unknown key `by`", ""),
        (
            "fault = { axis = \"XF\", kind = \"switch_stuck\", which = \"camm\", at = 1 }",
            4,
            "a switch",
            "did you mean `cam`?",
        ),
        ("fault = { axis = \"XF\", kind = \"switch_stuck\", which = \"cam\", at = 2 }", 4, "0 or 1", "at = 1"),
        ("image = { \"DB31.DBB101\" = \"2#1_0000_0000\" }", 4, "found 256", ""),
        ("image = { \"DB31.DBB200\" = 0 }", 4, "148 bytes", "147"),
    ] {
        let problem = prepared(&format!("[[step]]\n{step}\n")).err().unwrap_or_else(|| panic!("{step} is accepted"));
        let place = problem.place.as_ref().map(ToString::to_string).unwrap_or_default();
        // Two verbs are reported at the verb that is second in the order of `VERBS`.
        let expected = if line == 0 { place.clone() } else { format!("s.toml:{line}") };
        assert_eq!(place, expected, "{step}: {problem}");
        assert!(problem.what.contains(cause) && problem.cure.contains(cure), "{step}: {problem}");
    }
}

#[test]
fn what_a_later_step_captures_is_unknown_before() {
    let steps = "[[step]]\nexpect = \"begun == 0\"\n[[step]]\ncapture = { begun = \"time\" }\n";
    let problem = prepared(steps).err().unwrap();
    assert_eq!(problem.place.unwrap().line, 4);
    let steps = "never = \"begun > 1\"\n[[step]]\ncapture = { begun = \"time\" }\n";
    assert!(prepared(steps).err().unwrap().cure.contains("only after its step"));
    held(
        "[[step]]\ncapture = { begun = \"time + 1\" }\n[[step]]\nrun = \"1s\"\n[[step]]\nexpect = \"time == begun\"\n",
    );
}

#[test]
fn time_stands_still_between_steps_and_expect_sees_what_was_written() {
    held(
        r#"
        [[step]]
        set = { "M0.0" = 1, MB1 = -2, "MD4:REAL" = 1.5 }
        [[step]]
        expect = ["time == 0", "M0.0", "MB1 == 254", "MD4:REAL == 1.5"]
        [[step]]
        image = { MB1 = "2#1111_1110" }
        [[step]]
        run = "1cycles"
        [[step]]
        expect = ["time == 0.002", "M0.0", "MB1 == 254"]
        [[step]]
        run = "3ms"
        [[step]]
        expect = "time == 0.006"
        "#,
    );
}

#[test]
fn a_wait_goes_on_in_the_cycle_in_which_it_became_true() {
    held(
        r#"
        [[step]]
        wait = "1"
        [[step]]
        expect = "time == 0"
        [[step]]
        wait = "time >= 0.1"
        [[step]]
        expect = "time == 0.1"
        [[step]]
        set = { "M0.0" = 1 }
        [[step]]
        wait = "rose(M0.0)"
        within = "1s"
        [[step]]
        expect = ["time == 0.102", "rose(M0.0)", "!fell(M0.0)"]
        [[step]]
        run = "1cycles"
        [[step]]
        expect = "!rose(M0.0)"
        "#,
    );
}

#[test]
fn a_failed_wait_reports_its_expression_its_time_and_every_signal() {
    let text = missed("[[step]]\nwait = \"M0.0 && X.traversing_key_plus\"\nwithin = \"10ms\"\n");
    let first = text.lines().next().unwrap();
    assert_eq!(
        first,
        "s.toml:3: waited 0.010 s for `M0.0 && X.traversing_key_plus`; it did not become true (at 0.010 s)"
    );
    assert!(text.contains("\n  M0.0 = 0") && text.contains("\n  X.traversing_key_plus (DB31.DBX4.7) = 0"), "{text}");
}

#[test]
fn the_limit_ends_every_step_that_lets_time_pass() {
    for (step, doing) in [
        ("wait = \"M0.0\"", "waited 0.100 s for `M0.0`"),
        ("run = \"1s\"", "after 0.100 s of a run"),
        ("hold = \"1\"\nduring = \"1s\"", "while `1` held"),
        ("pulse = \"M0.0\"\nfor = \"1s\"", "after 0.100 s of a run"),
    ] {
        let text = missed(&format!("limit = \"100ms\"\n[[step]]\n{step}\n"));
        assert!(text.contains("reached the limit of 0.100 s") && text.contains(doing), "{text}");
    }
    held("limit = \"100ms\"\n[[step]]\nrun = \"100ms\"\n");
}

#[test]
fn a_hold_must_be_true_now_and_in_every_cycle() {
    held("[[step]]\nhold = \"time <= 0.1\"\nduring = \"100ms\"\n[[step]]\nexpect = \"time == 0.1\"\n");
    let text = missed("[[step]]\nhold = \"time < 0.05\"\nduring = \"100ms\"\n");
    assert!(text.contains("it was false after 0.050 s"), "{text}");
    assert!(missed("[[step]]\nhold = \"M0.0\"\nduring = \"1s\"\n").contains("after 0.000 s"));
}

#[test]
fn a_pulse_takes_its_time_and_one_cycle_more() {
    held(
        r#"
        always = ["M0.0 == (time <= 0.1)", "M0.1 == M0.0"]
        [[step]]
        pulse = ["M0.0", "M0.1"]
        [[step]]
        expect = ["time == 0.102", "!M0.0", "fell(M0.0)"]
        "#,
    );
    held("[[step]]\npulse = \"M0.0\"\nfor = \"5cycles\"\n[[step]]\nexpect = \"time == 0.012\"\n");
}

#[test]
fn never_and_always_are_checked_in_every_cycle_and_named_with_their_line() {
    let text = missed(&format!("never = [\"M0.1\",\n\"time > 0.01\"]\n{STEP}"));
    assert!(text.starts_with("s.toml:4: `never` is violated: `time > 0.01` is true (at 0.012 s)"), "{text}");
    let text = missed(&format!("always = \"time < 0.01\"\n{STEP}"));
    assert!(text.starts_with("s.toml:3: `always` is violated: `time < 0.01` is false (at 0.010 s)"), "{text}");
}

#[test]
fn an_expected_byte_is_shown_in_bits() {
    let text = missed("[[step]]\nset = { MB1 = 5 }\n[[step]]\nimage = { MB1 = \"2#1101_0000\" }\n");
    assert!(text.starts_with("s.toml:6: expected MB1 = 2#11010000, found 2#00000101"), "{text}");
}

#[test]
fn notes_and_watched_memory_are_in_the_golden_text() {
    let finished = held(
        r#"watch = ["M0.*"]
        [[step]]
        run = "10ms"
        [[step]]
        note = "now"
        set = { "M0.0" = 1 }
        [[step]]
        run = "10ms"
        "#,
    );
    let golden = finished.golden();
    assert!(golden.starts_with("scenario  t\nmachine   g1_example\ncycle     2 ms\n\n"), "{golden}");
    let rows: Vec<_> = golden.lines().skip(5).map(str::trim).filter(|row| row.starts_with("0.012")).collect();
    assert_eq!(rows.len(), 2, "{golden}");
    assert_eq!(rows[0], "0.012  # now");
    assert_eq!(rows[1].split_whitespace().collect::<Vec<_>>(), ["0.012", "M0.0", "0", "->", "1", "outside"]);
}

#[test]
fn the_same_scenario_gives_the_same_bytes() {
    let text = "watch = [\"*\", \"X.position\"]\n[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"100ms\"\n";
    assert_eq!(held(text).golden(), held(text).golden());
    assert_eq!(held(text).json_lines(), held(text).json_lines());
}

#[test]
fn a_session_does_in_rust_what_a_scenario_does_in_a_file() -> Result<(), Failure> {
    let mut session = Session::open("g1_example")?;
    session.set("M0.0", true)?;
    session.set("MW2", -1)?;
    session.expect("M0.0 && MW2 == 65535")?;
    session.run("10ms")?;
    session.pulse("M0.1")?;
    session.wait("fell(M0.1) || time > 0.05", "1s")?;
    assert!((session.capture("begun", "time")? - 0.112).abs() < 1e-9);
    session.hold("time >= begun", "10ms")?;
    let mut fork = session.fork()?;
    fork.run("10ms")?;
    assert!(fork.value("time")? > session.value("time")?);
    assert_eq!(session.machine().cycle() + 5, fork.machine().cycle());
    let failure = session.expect("MW2 == 1").unwrap_err();
    assert!(failure.to_string().contains("MW2 = 65535"), "{failure}");
    assert!(matches!(session.set("X.nonsense", 1), Err(Failure::Unusable(_))));
    Ok(())
}

#[test]
fn a_force_wins_until_it_is_released() {
    held(
        r#"
        [[step]]
        force = { "X.controller_enable" = 1 }
        [[step]]
        run = "1cycles"
        [[step]]
        set = { "X.controller_enable" = 0 }
        [[step]]
        run = "1cycles"
        [[step]]
        expect = "X.controller_enable"
        [[step]]
        release = "X.controller_enable"
        [[step]]
        set = { "X.controller_enable" = 0 }
        [[step]]
        run = "1cycles"
        [[step]]
        expect = "!X.controller_enable"
        "#,
    );
}

#[test]
fn an_overwrite_by_the_plc_program_is_reported() {
    let finished = held(
        r#"plc = "enable_all"
        [[step]]
        run = "100ms"
        [[step]]
        set = { "X.controller_enable" = 0 }
        [[step]]
        run = "10ms"
        [[step]]
        expect = "X.controller_enable"
        "#,
    );
    let notice = "# the PLC program overwrote what was set: X.controller_enable (DB31.DBX2.1)";
    assert!(finished.golden().contains(notice), "{}", finished.golden());
}

/// The code of a switch, its address and a code with a base are what a test of a PLC program needs; `write` does what a client could.
#[test]
fn any_bits_can_be_written_to_an_override_by_its_address() {
    held(
        r#"[[step]]
        set = { "X.feed_override" = 31, "DB32.DBB0" = 100, "XF.feed_override" = "2#1110_0001" }
        [[step]]
        write = { "CHAN1.feed_override" = 100 }
        [[step]]
        run = "10ms"
        [[step]]
        expect = ["X.feed_override == 31", "Y.feed_override == 100", "XF.feed_override == 225", "CHAN1.feed_override == 100"]
        "#,
    );
}

#[test]
fn verbs_without_effect_are_reported() {
    let finished = held(
        r#"[[step]]
        set = { "X.traversing_key_plus" = 1 }
        [[step]]
        force = { "X.controller_enable" = 1 }
        [[step]]
        fault = { axis = "XF", kind = "block" }
        [[step]]
        run = "10ms"
        [[step]]
        release = ["X.traversing_key_plus", "X.controller_enable"]
        [[step]]
        clear_fault = { axis = "XF", kind = "block" }
        [[step]]
        clear_fault = { axis = "XF", kind = "drive_fault" }
        [[step]]
        clear_fault = { axis = "Y", kind = "push" }
        [[step]]
        run = "10ms"
        "#,
    );
    let text = finished.golden();
    let notes: Vec<&str> = text.lines().filter_map(|line| line.split_once("  # ").map(|(_, note)| note)).collect();
    assert_eq!(
        notes,
        [
            "`release` without effect: X.traversing_key_plus (DB31.DBX4.7) was not forced; a value that was set stays until it is \
             set again",
            "`clear_fault` without effect: XF had no fault drive_fault",
            "`clear_fault` without effect: a push displaces Y once, and the displacement stays",
        ],
        "{text}"
    );
    assert!(text.contains("fault block") && text.contains("cleared") && !text.contains("drive_fault  "), "{text}");
}

#[test]
fn the_plant_of_a_scenario_is_merged_over_that_of_the_machine() {
    held("[plant.XF]\nstart = 119.5\n[[step]]\nexpect = \"XF.slide == 119.5\"\n");
    let problem = prepared(&format!("[plant.XF]\nstrat = 119.5\n{STEP}")).err().unwrap();
    assert_eq!(problem.place.unwrap().to_string(), "s.toml:4");
    assert!(problem.cure.contains("did you mean `start`?"), "{}", problem.cure);
}

#[test]
fn power_on_clears_the_memory_and_keeps_stored_machine_data_and_a_rejected_value_never_runs() {
    held(
        r#"
        [[step]]
        set = { "M0.0" = 1 }
        [[step]]
        machine_data = { "37110[XF]" = 0.05 }
        [[step]]
        run = "10ms"
        [[step]]
        expect = "M0.0"
        [[step]]
        power_on = true
        [[step]]
        run = "1cycles"
        [[step]]
        expect = "!M0.0"
        "#,
    );
    let step = "[[step]]\nmachine_data = { \"37100[XF]\" = \"no number\" }\n";
    assert_eq!(prepared(step).err().unwrap().place.unwrap().line, 4);
}

/// What judges the state behind a power on does not see the state before it.
#[test]
fn a_condition_behind_a_power_on_is_judged_after_it() {
    let before = "[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n[[step]]\npower_on = true\n[[step]]\n";
    for judged in [
        "expect = \"!M0.0\"",
        "wait = \"!M0.0\"\nwithin = \"1cycles\"",
        "hold = \"!M0.0\"\nduring = \"10ms\"",
        "image = { \"MB0\" = 0 }",
        "capture = { later = \"M0.0\" }\n[[step]]\nexpect = \"later == 0\"",
    ] {
        held(&format!("{before}{judged}\n"));
    }
}

#[test]
fn bits_of_a_machine_datum_are_written_as_in_an_archive() {
    held("[[step]]\nmachine_data = { \"37150[XF]\" = \"'H5'\", \"37150[X]\" = \"'B101'\", \"37150[Y]\" = 5 }\n");
    let step = "[[step]]\nmachine_data = { \"37150[XF]\" = \"H5\" }\n";
    let problem = prepared(step).err().unwrap();
    assert_eq!(problem.place.as_ref().unwrap().line, 4);
    assert!(problem.to_string().contains("'H0F'"), "{problem}");
}

#[test]
fn a_plc_image_is_found_by_its_name_above_the_scenario_or_by_its_file() {
    let directory = std::env::temp_dir().join(format!("opennck-image-{}", std::process::id()));
    std::fs::create_dir_all(directory.join("plc_images")).unwrap();
    std::fs::create_dir_all(directory.join("golden/area")).unwrap();
    let image = "[[db]]\nnumber = 1000\nsize = 8\nvalues = { \"DBW2\" = 250 }\n";
    std::fs::write(directory.join("plc_images/recipes.toml"), image).unwrap();
    for name in ["recipes", "../../plc_images/recipes.toml"] {
        let text = format!(
            "title = \"t\"\nmachine = \"g1_example\"\nplc_image = \"{name}\"\n\
             [[step]]\nexpect = \"DB1000.DBW2 == 250\"\n"
        );
        let scenario = Scenario::parse(&text, &directory.join("golden/area/s.toml")).unwrap();
        let finished = scenario.prepare(Profile::default(), &Programs::ready()).unwrap().run();
        assert!(finished.failure.is_none(), "{:?}", finished.failure);
    }
}
