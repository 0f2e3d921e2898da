//! Tests that `docs/scenarios.md` is right and complete: its examples run, and it names every verb, function, value and key.

use std::fs;
use std::path::{Path, PathBuf};

use opennck::image::SINUMERIK;
use opennck::plc::Programs;
use opennck::scenario::{Scenario, Session};
use opennck::variables::AxisValue;

fn page() -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/scenarios.md")).expect("the page must exist")
}

/// The contents of the code blocks in TOML.
fn blocks() -> Vec<String> {
    let inside = |rest: &str| rest.split("```").next().unwrap_or_default().to_owned();
    page().split("```toml\n").skip(1).map(inside).collect()
}

#[test]
fn every_complete_example_passes() {
    let mut count = 0;
    for block in blocks().iter().filter(|block| block.starts_with("title")) {
        for scenario in Scenario::parse_cases(block, Path::new("scenarios.toml")).expect(block) {
            count += 1;
            let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).expect(block).run();
            assert!(finished.failure.is_none(), "{block}\n{:?}", finished.failure);
            assert_eq!(finished.remarks(), [""; 0], "{block}");
        }
    }
    assert!(count >= 10, "{count} cases");
}

#[test]
fn the_example_of_included_steps_passes() {
    let directory: PathBuf = std::env::temp_dir().join(format!("opennck-{}-language", std::process::id()));
    fs::create_dir_all(directory.join("parts")).unwrap();
    let blocks = blocks();
    let [part, steps] = ["# parts/press_the_key_of_y.toml", "# in a scenario"]
        .map(|head| blocks.iter().find(|block| block.starts_with(head)).expect(head));
    fs::write(directory.join("parts/press_the_key_of_y.toml"), part).unwrap();
    let head =
        "machine = \"g1_example\"\nplc = \"enable_all\"\n[machine_data]\n\"11300\" = true\n[[step]]\nrun = \"100ms\"\n";
    let scenario = Scenario::parse(&format!("{head}{steps}"), &directory.join("s.toml")).unwrap();
    let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run();
    assert!(finished.failure.is_none(), "{:?}", finished.failure);
    fs::remove_dir_all(directory).unwrap();
}

/// The names in the message about an unknown key are all that are known.
#[test]
fn the_page_names_every_key_and_verb() {
    let known = |text: &str| {
        let problem = Scenario::parse(text, Path::new("s.toml"))
            .and_then(|scenario| scenario.prepare(scenario.profiles[0], &Programs::ready()).map(drop))
            .unwrap_err();
        let names = problem.what.split(", found the unknown key").next().unwrap().to_owned();
        names.split('`').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
    };
    let page = page();
    let step = "[[step]]\nrun = \"1s\"\n";
    let mut names = known(&format!("machine = \"g1_example\"\nunknown = 1\n{step}"));
    names.extend(known("machine = \"g1_example\"\n[[step]]\nunknown = 1\n"));
    names.extend(known(&format!("machine = \"g1_example\"\n{step}[[rule]]\nnever = \"0\"\nunknown = 1\n")));
    assert!(names.len() > 40, "{names:?}");
    for name in &names {
        let shown = [format!("`{name}"), format!("[[{name}]]"), format!("[{name}"), format!("\n{name} ")];
        assert!(shown.iter().any(|text| page.contains(text)), "{name}");
    }
}

#[test]
fn the_page_names_every_function_and_every_value() {
    let page = page();
    let problem = Session::open("g1_example").unwrap().value("no_function_like_it(1)").unwrap_err();
    let text = problem.to_string();
    let functions = text.split("functions are ").nth(1).expect("the message lists all functions");
    for function in functions.lines().next().unwrap().split(", ") {
        assert!(page.contains(&format!("`{function}(")), "{function}");
    }
    for value in AxisValue::names(&SINUMERIK) {
        assert!(page.contains(&format!(".{value}`")), "{value}");
    }
    for kind in
        ["block", "push", "friction", "drift", "drive_fault", "encoder_fault", "encoder_slip", "zero_mark_missing"]
    {
        assert!(page.contains(&format!("| `{kind}` |")), "{kind}");
    }
}

/// A message about an expression.
fn mistake(expression: &str) -> Option<String> {
    Session::open("g1_example").expect("a built-in machine").expect(expression).err().map(|failure| failure.to_string())
}

/// The whole expression and 99 signs or parentheses are 100 levels.
#[test]
fn an_expression_has_at_most_100_levels() {
    for sign in ["!", "-", "("] {
        let levels = |count: usize| {
            format!("{}1{}", sign.repeat(count), if sign == "(" { ")".repeat(count) } else { String::new() })
        };
        let found = mistake(&format!("{} != 7", levels(98)));
        assert_eq!(found, None, "{sign}");
        let found = mistake(&format!("{} != 7", levels(100))).expect(sign);
        assert!(found.contains("expected at most 100 "), "{found}");
    }
    assert_eq!(mistake(&format!("{}1 == 0", "!".repeat(99))), None);
    assert!(mistake(&format!("{}1 == 1", "!".repeat(100))).unwrap().contains("at most 100 signs in a row"));
}

#[test]
fn a_message_about_a_long_expression_shows_the_mistake_in_the_middle() {
    let ones = vec!["1"; 300].join("+");
    let found = mistake(&format!("{ones} + ? + {ones}")).unwrap();
    let shown = found.split('…').nth(1).expect(&found);
    let (before, after) = shown.split_once('?').expect(shown);
    assert!(before.chars().count().abs_diff(after.chars().count()) < 3, "{found}");
}

/// Before the first cycle the control shows nothing, and the slides are where `plant.toml` puts them.
#[test]
fn the_positions_of_the_slides_are_known_before_the_first_cycle() {
    assert_eq!(mistake("time == 0 && X.slide == 120 && XF.slide == 120 && X.position == 0"), None);
}
