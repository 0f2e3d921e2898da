//! Tests that `docs/scenarios.md` is right and complete: its examples run, and it names every verb, function, value and key.

use std::fs;
use std::path::{Path, PathBuf};

use opennck::plc::Programs;
use opennck::scenario::Scenario;
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
    // Programs of the NC are not available yet.
    for name in names.iter().filter(|name| *name != "program") {
        let shown = [format!("`{name}"), format!("[[{name}]]"), format!("[{name}"), format!("\n{name} ")];
        assert!(shown.iter().any(|text| page.contains(text)), "{name}");
    }
}

#[test]
fn the_page_names_every_function_and_every_value() {
    let page = page();
    let problem = opennck::scenario::Session::open("g1_example").unwrap().value("no_function_like_it(1)").unwrap_err();
    let text = problem.to_string();
    let functions = text.split("functions are ").nth(1).expect("the message lists all functions");
    for function in functions.lines().next().unwrap().split(", ") {
        assert!(page.contains(&format!("`{function}(")), "{function}");
    }
    for value in AxisValue::ALL {
        assert!(page.contains(&format!(".{}`", value.name())), "{value}");
    }
    for kind in
        ["block", "push", "friction", "drift", "drive_fault", "encoder_fault", "encoder_slip", "zero_mark_missing"]
    {
        assert!(page.contains(&format!("| `{kind}` |")), "{kind}");
    }
}
