//! What a failure says, and the parts of the language that go beyond one verb at one time.

use std::path::{Path, PathBuf};

use super::{Finished, Programs, STEP, Scenario, Session, held, missed, prepared, run};
use crate::source::Problem;

#[test]
fn a_failed_expect_names_every_false_item_and_only_those() {
    let text = missed("[[step]]\nset = { MB0 = 5 }\n[[step]]\nexpect = [\n\"MB0 == 5\",\n\"MB0 > 5\",\n\"MB1 == 1\"]");
    for line in [
        "s.toml:8: 2 of 3 expectations are false (at 0.000 s)",
        "  line 8: `MB0 > 5` is false\n    MB0 = 5\n",
        "  line 9: `MB1 == 1` is false\n    MB1 = 0\n",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(!text.contains("MB0 == 5"), "{text}");
    let one = missed("[[step]]\nexpect = [\"1\", \"MB1 == 1\"]");
    assert!(one.starts_with("s.toml:4: expected `MB1 == 1`, but it is false (at 0.000 s)\n  MB1 = 0"), "{one}");
}

#[test]
fn a_failed_image_names_every_other_byte() {
    let text = missed("[[step]]\nimage = { MB0 = 0, MB1 = 1, MB2 = \"2#10\" }");
    assert!(text.starts_with("s.toml:4: expected MB1 = 2#00000001, found 2#00000000 (at 0.000 s)\n"), "{text}");
    assert!(text.contains("line 4: expected MB2 = 2#00000010, found 2#00000000"), "{text}");
}

#[test]
fn a_channel_that_stored_data_create_can_be_written_after_power_on() {
    let step = "[[step]]\nmachine_data = { \"10010[1]\" = 1 }\n[[step]]\npower_on = true\n[[step]]\nset = { \"DB22.DBX7.1\" = 1 }";
    held(step);
}

/// Machine data are stored before the first power on: the control starts with them.
#[test]
fn machine_data_of_the_head_hold_from_the_first_cycle() {
    let head = "[machine_data]\n\"34090[Q]\" = 2\n\"37110[XF]\" = 1.5\n\"10000[4]\" = \"Q\"\n\"11300\" = true\n";
    let finished = held(&format!("{head}[[step]]\nexpect = \"X.position == 0\""));
    let data = finished.session().machine().control().data();
    let axis = |number| crate::control::Owner::Axis(crate::units::AxisNumber::new(number).unwrap());
    let stored = |number, owner| data.stored(number, owner, 0).unwrap().value;
    assert_eq!(stored(37110, axis(3)), crate::control::Value::Real(1.5));
    assert_eq!(stored(34090, axis(5)), crate::control::Value::Real(2.0));
}

#[test]
fn a_mistake_in_machine_data_of_the_head_names_its_line() {
    for (data, cause) in [
        ("\"34090[Q]\" = 1", "found `Q`"),
        ("\"34090[XF]\" = \"text\"", "found"),
        ("\"37110[XF]\" = -1.0", "found -1"),
        ("34090.XF = 1", "found 34090.XF without quotes"),
        ("\"34090[XF]\" = [1]", "a value of a machine datum"),
    ] {
        let problem = prepared(&format!("[machine_data]\n{data}\n{STEP}")).err().expect(data);
        assert_eq!(problem.place.as_ref().map(|place| place.line), Some(4), "{problem}");
        assert!(problem.what.contains(cause), "{problem}");
    }
}

fn cases(rest: &str) -> Result<Vec<Finished>, Problem> {
    let text = format!("title = \"t\"\nmachine = \"g1_example\"\n{rest}");
    let cases = Scenario::parse_cases(&text, Path::new("s.toml"))?;
    cases.into_iter().map(|case| Ok(case.prepare(case.profiles[0], &Programs::ready())?.run())).collect()
}

#[test]
fn every_case_of_a_matrix_runs_and_its_failure_and_its_head_name_the_values() {
    let matrix = "[matrix]\n\"plant.X.start\" = [120.0, 130.0]\nplc = [\"enable_all\", \"gantry_start\"]\n";
    let finished = cases(&format!("{matrix}[[step]]\nexpect = \"X.slide < 125\"")).unwrap();
    assert_eq!(finished.iter().map(|case| case.failure.is_some()).collect::<Vec<_>>(), [false, false, true, true]);
    assert!(finished[1].golden().contains("case      plant.X.start = 120.0, plc = gantry_start\n"));
    let failure = finished[2].failure.as_ref().unwrap().to_string();
    assert!(failure.contains("\n  in the case plant.X.start = 130.0, plc = enable_all\n"), "{failure}");
}

#[test]
fn a_case_that_cannot_be_used_names_the_values() {
    let problem = cases(&format!("[matrix]\nplc = [\"enable_all\", \"nothing\"]\n{STEP}")).err().unwrap();
    assert!(problem.what.ends_with("(in the case plc = nothing)"), "{problem}");
    let one = Scenario::parse(
        &format!("title = \"t\"\nmachine = \"g1_example\"\n[matrix]\nplc = [\"a\", \"b\"]\n{STEP}"),
        Path::new("s.toml"),
    );
    assert!(one.unwrap_err().what.contains("found a matrix of 2"));
}

#[test]
fn a_broken_rule_names_where_it_began_and_failed_and_the_values() {
    let rule = "[[rule]]\nname = \"answer\"\nwhen = \"M0.0\"\nthen = \"M0.1\"\nwithin = \"20ms\"\n";
    let text =
        missed(&format!("{rule}[[step]]\nrun = \"10ms\"\n[[step]]\nset = {{ \"M0.0\" = 1 }}\n[[step]]\nrun = \"1s\""));
    for line in [
        "s.toml:3: rule `answer` is broken: `M0.1` did not become true within 0.020 s after `M0.0` (at 0.032 s)",
        "  began in cycle 6, at 0.012 s\n  failed in cycle 16, at 0.032 s\n  M0.0 = 1\n  M0.1 = 0\n",
    ] {
        assert!(text.contains(line), "{text}");
    }
}

#[test]
fn a_rule_that_goes_on_is_noted_in_its_cycle_and_fails_at_the_end() {
    let rule = "[[rule]]\nname = \"quiet\"\nnever = \"M0.0\"\ngo_on = true\n";
    let set = |value: u8| format!("[[step]]\nset = {{ \"M0.0\" = {value} }}\n[[step]]\nrun = \"10ms\"\n");
    let finished = run(&format!("{rule}{}{}{}", set(1), set(0), set(1)));
    let golden = finished.golden();
    assert!(golden.contains("0.002  # rule `quiet` is broken: `M0.0` is true\n"), "{golden}");
    let failure = finished.failure.unwrap().to_string();
    assert!(failure.starts_with("s.toml:3: rule `quiet` is broken: `M0.0` is true (at 0.002 s)"), "{failure}");
    assert!(failure.contains("also: rule `quiet` is broken: `M0.0` is true (at 0.022 s)"), "{failure}");
}

#[test]
fn a_failure_of_a_step_names_the_rules_that_were_broken_before() {
    let rule = "[[rule]]\nname = \"quiet\"\nnever = \"M0.0\"\ngo_on = true\n";
    let steps = "[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n[[step]]\nexpect = \"M1.0\"";
    let text = missed(&format!("{rule}{steps}"));
    assert!(text.contains("expected `M1.0`") && text.contains("before: rule `quiet` is broken"), "{text}");
}

#[test]
fn rules_that_never_began_or_are_open_are_remarked_and_not_failed() {
    let rules = "[[rule]]\nname = \"a\"\nwhen = \"M2.0\"\nthen = \"M0.1\"\n[[rule]]\nname = \"b\"\nwhen = \"M0.0\"\nthen = \"M0.1\"\nwithin = \"1h\"\n";
    let finished = held(&format!("{rules}[[step]]\nset = {{ \"M0.0\" = 1 }}\n[[step]]\nrun = \"10ms\""));
    assert_eq!(
        finished.remarks(),
        [
            "rule `a` never began: `M2.0` did not become true",
            "rule `b`: 1 watch was open at the end; it began at 0.002 s"
        ]
    );
    let must = rules.replacen("then", "must_begin = true\nthen", 1);
    let text = missed(&format!("{must}{STEP}"));
    assert!(text.contains("rule `a` is broken: it never began: `M2.0` did not become true (at 1.000 s)"), "{text}");
}

#[test]
fn power_on_closes_open_watches() {
    let rule = "[[rule]]\nname = \"a\"\nwhen = \"M0.0\"\nthen = \"M0.1\"\nwithin = \"20ms\"\n";
    let steps =
        "[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n[[step]]\npower_on = true\n[[step]]\nrun = \"1s\"";
    assert_eq!(held(&format!("{rule}{steps}")).remarks(), ["rule `a`: power on ended 1 watch without a result"]);
}

#[test]
fn every_mistake_in_a_rule_names_its_line_and_a_cure() {
    for (rule, line, cause, cure) in [
        ("name = \"a\"", 3, "with `when`, `always` or `never`, found none", "then ="),
        ("when = \"1\"", 3, "`then` together with `when`", "what must follow"),
        ("when = \"1\"\nnever = \"1\"", 3, "found several", "one [[rule]] for each"),
        ("never = \"1\"\nwithin = \"1s\"", 5, "`within` in a rule with `when`", "remove it"),
        (
            "when = \"1\"\nthen = \"1\"\nnot_before = \"1s\"",
            3,
            "`within` together with `not_before`",
            "without `within`",
        ),
        (
            "when = \"1\"\nthen = \"1\"\nnot_before = \"2s\"\nwithin = \"1s\"",
            3,
            "at most as long as `within`",
            "exchange",
        ),
        ("when = \"1\"\nthen = \"1\"\nwithin = 5", 6, "with its unit, found the integer 5", "\"5s\""),
        ("wen = \"1\"", 4, "unknown key `wen`", "did you mean `when`?"),
        ("when = \"M0.0\"\nthen = \"M0.x\"", 5, "M0.x", ""),
        ("never = \"a == 1\"", 4, "`a`", "apply from the start"),
    ] {
        let problem = prepared(&format!("[[rule]]\n{rule}\n[[step]]\ncapture = {{ a = \"1\" }}\n")).err().expect(rule);
        let place = problem.place.as_ref().map(ToString::to_string).unwrap_or_default();
        assert_eq!(place, format!("s.toml:{line}"), "{rule}: {problem}");
        assert!(problem.what.contains(cause) && problem.cure.contains(cure), "{rule}: {problem}");
    }
    let one = prepared(&format!("[rule]\nnever = \"1\"\n{STEP}")).err().unwrap();
    assert!(one.cure.contains("two brackets"), "{one}");
}

#[test]
fn since_and_count_begin_with_the_scenario_wherever_they_are_used() {
    let toggle = "[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n[[step]]\nset = { \"M0.0\" = 0 }\n[[step]]\nrun = \"10ms\"\n";
    held(&format!(
        "{toggle}{toggle}[[step]]\nexpect = [\"count(M0.0) == 2\", \"abs(since(M0.0) - 0.018) < 0.0001\", \"since(M7.7) > 1000000\"]"
    ));
}

/// A directory of this test with these files.
fn directory(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("opennck-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    for (file, text) in files {
        std::fs::write(directory.join(file), text).unwrap();
    }
    directory
}

const PART: &str = "[[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"2cycles\"\n[[step]]\nset = { \"M0.0\" = 0 }\n[[step]]\nrun = \"2cycles\"\n[[step]]\ncapture = { n = \"count(M0.0)\" }\n";

fn read(file: &Path) -> Result<Finished, Problem> {
    let scenario = Scenario::read(file)?;
    Ok(scenario.prepare(scenario.profiles[0], &Programs::ready())?.run())
}

#[test]
fn included_steps_run_several_times_and_share_captured_names() {
    let twice = "machine = \"g1_example\"\n[[step]]\nnote = \"twice\"\ninclude = \"part.toml\"\ntimes = 2\n[[step]]\nexpect = [\"n == 2\", \"abs(time - 0.016) < 0.0001\"]\n";
    let nested = "machine = \"g1_example\"\n[[step]]\ninclude = \"twice.toml\"\n[[step]]\ninclude = \"inner.toml\"\ntimes = 3\n[[step]]\nexpect = \"n == 2 + 3 * 4\"\n";
    let inner = "[[step]]\ninclude = \"part.toml\"\ntimes = 4\n";
    let files = [("part.toml", PART), ("twice.toml", twice), ("nested.toml", nested), ("inner.toml", inner)];
    let directory = directory("included", &files);
    for file in ["twice.toml", "nested.toml"] {
        let finished = read(&directory.join(file)).unwrap();
        assert!(finished.failure.is_none(), "{file}: {}", finished.failure.unwrap());
        assert_eq!(finished.golden().matches("# twice").count(), 1);
    }
    let mut session = Session::open("g1_example").unwrap();
    session.follow("M0.0").unwrap();
    session.include(directory.join("part.toml")).unwrap();
    session.expect("n == 1").unwrap();
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn a_failure_in_included_steps_names_both_places_and_the_repetition() {
    let part = format!("{PART}[[step]]\nexpect = \"n < 3\"\n");
    let scenario = "machine = \"g1_example\"\n[[step]]\nrun = \"1s\"\n[[step]]\ninclude = \"part.toml\"\ntimes = 9\n";
    let directory = directory("failing", &[("part.toml", &part), ("s.toml", scenario)]);
    let failure = read(&directory.join("s.toml")).unwrap().failure.unwrap().to_string();
    assert!(failure.contains("part.toml:12: expected `n < 3`"), "{failure}");
    assert!(failure.contains("included at ") && failure.contains("s.toml:4, time 3 of 9"), "{failure}");
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn files_that_include_each_other_and_other_mistakes_are_refused() {
    let head = "machine = \"g1_example\"\n";
    let files = [
        ("a.toml", format!("{head}[[step]]\ninclude = \"b.toml\"\n")),
        ("b.toml", "[[step]]\ninclude = \"a.toml\"\n".to_owned()),
        ("nothing.toml", format!("{head}[[step]]\ninclude = \"no_such.toml\"\n")),
        ("none.toml", format!("{head}[[step]]\ninclude = \"b.toml\"\ntimes = 0\n")),
        ("both.toml", format!("{head}[[step]]\ninclude = \"b.toml\"\nrun = \"1s\"\n")),
        ("times.toml", format!("{head}[[step]]\nrun = \"1s\"\ntimes = 2\n")),
        ("typo.toml", format!("{head}[[step]]\ninclude = \"wrong.toml\"\n")),
        ("wrong.toml", "titel = \"t\"\n[[step]]\nrun = \"1s\"\n".to_owned()),
    ];
    let files: Vec<_> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    let directory = directory("refused", &files);
    for (file, line, cause) in [
        ("a.toml", "b.toml:2", "include each other in a circle"),
        ("nothing.toml", "nothing.toml:3", "no_such.toml cannot be read"),
        ("none.toml", "none.toml:4", "a number of times from 1 to 1000000"),
        ("both.toml", "both.toml:2", "the only verb of a step, found `run`"),
        ("times.toml", "times.toml:4", "`times` cannot be combined with `run`"),
        ("typo.toml", "wrong.toml:1", "unknown key `titel`"),
    ] {
        let problem = read(&directory.join(file)).err().expect(file);
        let place = problem.place.as_ref().map(ToString::to_string).unwrap_or_default();
        assert!(place.ends_with(line) && problem.what.contains(cause), "{file}: {problem}");
    }
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn a_watched_value_has_a_row_where_it_has_moved_by_its_step() {
    let drift = "[[step]]\nfault = { axis = \"Y\", kind = \"drift\", by = 1.0 }\n[[step]]\nrun = \"1s\"\n";
    let rows = |watch: &str| held(&format!("watch = [{watch}]\n{drift}")).golden().matches("Y.slide ").count();
    // One second at 1 mm/s: the start, and one row for each 0.25 mm.
    assert_eq!(rows("{ value = \"Y.slide\", step = 0.25 }"), 5);
    assert_eq!(rows("{ value = \"Y.slide\", step = 0.25 }, { value = \"*.slide\", step = 0.25 }"), 5);
    assert!(rows("\"Y.slide\"") > 400);
    for (entry, cause) in [
        ("{ value = \"Y.slide\" }", "the keys `value` and `step`"),
        ("{ value = \"Y.slide\", step = 0 }", "a step above 0"),
        ("{ value = \"M0.0\", step = 1 }", "the value of a machine axis for a step"),
    ] {
        let problem = prepared(&format!("watch = [{entry}]\n{STEP}")).err().expect(entry);
        assert!(problem.what.contains(cause), "{problem}");
    }
}

/// Every verb of a scenario is a call of a session.
#[test]
fn a_session_has_every_verb() {
    let mut session = Session::open("g1_example").unwrap();
    session.write("DB31.DBB101", 3).unwrap();
    session.pulse_all(&["M0.0", "M0.1"], "10ms").unwrap();
    session.set("MB5", 7).unwrap();
    session.image(&[("MB5", "2#111"), ("MB0", "0")]).unwrap();
    let text = session.image(&[("MB5", "2#110"), ("MB0", "1")]).unwrap_err().to_string();
    assert!(text.contains("expected MB5") && text.contains("expected MB0"), "{text}");
    let text = session.expect_all(&["MB5 == 7", "MB5 == 8", "MB0 == 1"]).unwrap_err().to_string();
    assert!(text.contains("2 of 3 expectations are false"), "{text}");
    session.r_parameter("R5", 1.5).unwrap();
    session.handwheel(1, 10, "100ms").unwrap();
    session.plc_cold().unwrap();
    session.always("MB5 < 200").unwrap();
    session.never("M0.7").unwrap();
    session.follows("answer", "M1.0", "M1.1", "20ms").unwrap();
    session.run("10ms").unwrap();
    session.set("M1.0", 1).unwrap();
    let text = session.run("1s").unwrap_err().to_string();
    assert!(text.contains("rule `answer` is broken"), "{text}");
}

#[test]
fn times_of_a_rule_are_those_of_the_machine_after_power_on_changed_its_cycles() {
    let rule = "[[rule]]\nname = \"a\"\nwhen = \"M0.0\"\nthen = \"M0.1\"\nwithin = \"150ms\"\n";
    let begin = "[[step]]\nmachine_data = { \"10070\" = 30 }\n[[step]]\npower_on = true\n[[step]]\nrun = \"1cycle\"\n[[step]]\nset = { \"M0.0\" = 1 }\n";
    // Cycles of 60 ms: 150 ms are over after three of them, not after 75.
    let text = missed(&format!("{rule}{begin}[[step]]\nrun = \"1s\""));
    assert!(text.contains("within 0.150 s after `M0.0` (at 0.300 s)"), "{text}");
    assert!(text.contains("began in cycle 2, at 0.120 s\n  failed in cycle 5, at 0.300 s\n"), "{text}");
    let answer = "[[step]]\nrun = \"1cycle\"\n[[step]]\nset = { \"M0.1\" = 1 }\n[[step]]\nrun = \"1cycle\"";
    assert_eq!(
        held(&format!("{rule}{begin}{answer}")).margins(),
        ["margin of `a`: 2 cycles (0.120 s), began at 0.120 s; 1 of 1 in time"]
    );
}

#[test]
fn a_limit_in_cycles_is_named_in_cycles() {
    let rule =
        "[[rule]]\nname = \"a\"\nwhen = \"M0.0\"\nthen = \"M0.1\"\nwithin = \"3cycles\"\nnot_before = \"1cycle\"\n";
    let set = "[[step]]\nset = { \"M0.0\" = 1 }\n";
    let text = missed(&format!("{rule}{set}[[step]]\nrun = \"1s\""));
    assert!(text.contains("within 3 cycles after `M0.0` (at 0.008 s)"), "{text}");
    let text = missed(&format!("{rule}[[step]]\nset = {{ \"M0.0\" = 1, \"M0.1\" = 1 }}\n[[step]]\nrun = \"1s\""));
    assert!(text.contains("`M0.1` is true earlier than 1 cycle after `M0.0` (at 0.002 s)"), "{text}");
}

#[test]
fn a_rule_that_is_broken_before_the_first_cycle_fails_also_a_run_without_a_cycle() {
    let rule = "[[rule]]\nname = \"a\"\nwhen = \"M0.0 == 0\"\nthen = \"M0.1\"\nfrom_start = true\n";
    let text = missed(&format!("{rule}[[step]]\nexpect = \"1\""));
    assert!(
        text.contains("rule `a` is broken: `M0.1` is not true in the cycle in which `M0.0 == 0` became true"),
        "{text}"
    );
}

#[test]
fn rules_that_break_in_the_same_cycle_are_all_named() {
    let rules = "never = [\"M0.0\", \"M0.1\"]\n[[rule]]\nname = \"c\"\nalways = \"MB0 < 3\"\ngo_on = true\n";
    let text = missed(&format!("{rules}[[step]]\nset = {{ \"MB0\" = 3 }}\n[[step]]\nrun = \"1s\""));
    for line in [
        "`never` is violated: `M0.0` is true (at 0.002 s)",
        "\n  also: `never` is violated: `M0.1` is true\n",
        "\n  before: rule `c` is broken: `MB0 < 3` is false (at 0.002 s)\n",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

#[test]
fn a_file_that_only_includes_another_one_does_not_count_its_repetitions() {
    let scenario = "machine = \"g1_example\"\n[[step]]\ninclude = \"outer.toml\"\n";
    let outer = "[[step]]\ninclude = \"inner.toml\"\ntimes = 5\n";
    let inner = "[[step]]\nrun = \"1cycle\"\n[[step]]\nexpect = \"time < 0.005\"\n";
    let directory = directory("nested", &[("s.toml", scenario), ("outer.toml", outer), ("inner.toml", inner)]);
    let failure = read(&directory.join("s.toml")).unwrap().failure.unwrap().to_string();
    let places: Vec<_> = failure.lines().filter(|line| line.contains("included at")).collect();
    assert!(places[0].ends_with("outer.toml:1, time 3 of 5") && places[1].ends_with("s.toml:2"), "{failure}");
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn repetitions_of_nested_files_multiply_and_have_a_limit() {
    let scenario = "machine = \"g1_example\"\n[[step]]\ninclude = \"outer.toml\"\ntimes = 1000000\n";
    let outer = "[[step]]\ninclude = \"inner.toml\"\ntimes = 2\n";
    let inner = "[[step]]\nexpect = \"1\"\n";
    let directory = directory("multiplied", &[("s.toml", scenario), ("outer.toml", outer), ("inner.toml", inner)]);
    let problem = read(&directory.join("s.toml")).err().unwrap();
    assert!(problem.what.contains("at most 1000000 times, found 2000000"), "{problem}");
    assert!(problem.to_string().contains("outer.toml:1: "), "{problem}");
    std::fs::remove_dir_all(directory).unwrap();
}

#[test]
fn a_case_is_chosen_by_its_values() {
    let text = format!("machine = \"g1_example\"\n[matrix]\nplc = [\"a\", \"ab\"]\n{STEP}");
    let directory =
        directory("cases", &[("s.toml", &text), ("one.toml", &format!("machine = \"g1_example\"\n{STEP}"))]);
    let plc = |wanted| Scenario::read_case(&directory.join("s.toml"), wanted).map(|case| case.plc.unwrap().text);
    assert_eq!([plc(Some("plc = a")), plc(Some("ab"))], [Ok("a".to_owned()), Ok("ab".to_owned())]);
    let problem = plc(Some("plc")).unwrap_err();
    assert!(problem.what.contains("selects 2") && problem.cure.contains("plc = a"), "{problem}");
    let problem = plc(Some("x")).unwrap_err();
    assert!(
        problem.what.contains("with `x`, found none") && problem.cure == "cases are plc = a; plc = ab",
        "{problem}"
    );
    assert!(plc(None).unwrap_err().cure.contains("--case"));
    assert!(Scenario::read_case(&directory.join("one.toml"), None).is_ok());
    let problem = Scenario::read_case(&directory.join("one.toml"), Some("x")).unwrap_err();
    assert_eq!(problem.cure, "the scenario has no matrix");
    std::fs::remove_dir_all(directory).unwrap();
}

/// The part of a picture is selected after the run.
#[test]
fn waveform_and_diagram_show_a_part_of_the_trace() {
    let set = |value: u8| format!("[[step]]\nset = {{ \"MB0\" = {value} }}\n[[step]]\nrun = \"10ms\"\n");
    let mut finished = held(&format!("watch = [\"MB0\"]\n{}{}{}", set(1), set(2), set(3)));
    // The value becomes 1 at 2 ms, 2 at 12 ms, 3 at 22 ms.
    finished.window = crate::trace::Window { from: Some(crate::units::Time::from_millis(12)), to: None };
    let text = finished.vcd();
    let changes = text.split_once("#12\n").unwrap().1;
    assert!(changes.starts_with("$dumpvars\nb00000001 !\n$end\nb00000010 !\n#22\nb00000011 !\n"), "{text}");
    assert!(finished.svg().contains("becomes 2") && !finished.svg().contains("becomes 1"));
}
