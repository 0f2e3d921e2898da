//! Golden files: missing, changed, accepted; one per profile; and compatibility of the format with insta.

use std::fs;

use super::*;

/// An empty directory for one test, with one scenario.
fn directory(name: &str, scenario: &str) -> PathBuf {
    let directory = std::env::temp_dir().join(format!("opennck-golden-{}-{name}", std::process::id()));
    let _ = fs::remove_dir_all(&directory);
    fs::create_dir_all(&directory).unwrap();
    fs::write(directory.join("flags.toml"), scenario).unwrap();
    directory
}

const SCENARIO: &str = "title = \"A flag: \\\"set\\\"\"\nmachine = \"g1_example\"\nwatch = [\"M0.*\"]\n\
    [[step]]\nset = { \"M0.0\" = 1 }\n[[step]]\nrun = \"10ms\"\n";

fn outcomes(directory: &Path, update: Update) -> Vec<Outcome> {
    let cases = cases(&directory.join("flags.toml")).unwrap();
    cases.iter().map(|case| case.run(&Programs::ready(), update)).collect()
}

#[test]
fn a_missing_golden_file_fails_until_it_is_accepted() {
    let directory = directory("missing", SCENARIO);
    let snap = directory.join("flags.snap");
    assert_eq!(outcomes(&directory, Update::No), [Outcome::Missing(snap.clone())]);
    assert_eq!(outcomes(&directory, Update::New), [Outcome::Missing(snap.clone())]);
    assert!(pending(&snap).is_file() && !snap.exists());
    assert_eq!(outcomes(&directory, Update::Accept), [Outcome::Accepted]);
    assert!(!pending(&snap).exists() && snap.is_file());
    assert_eq!(outcomes(&directory, Update::No), [Outcome::Held]);
    assert_eq!(outcomes(&directory, Update::Accept), [Outcome::Held]);
    check(&directory, &Programs::ready());
}

#[test]
fn a_changed_trace_is_reported_with_its_first_difference_and_keeps_the_header_when_accepted() {
    let directory = directory("changed", SCENARIO);
    let snap = directory.join("flags.snap");
    outcomes(&directory, Update::Accept);
    let golden = fs::read_to_string(&snap).unwrap();
    fs::write(&snap, golden.replace("0 -> 1", "1 -> 0").replace("source: opennck", "source: elsewhere")).unwrap();
    let report = report(&directory, &Programs::ready(), Update::No);
    assert!(report.starts_with("1 of 1 scenarios failed"), "{report}");
    assert!(report.contains("first difference in line 6") && report.contains("1 -> 0"), "{report}");
    assert_eq!(outcomes(&directory, Update::Accept), [Outcome::Accepted]);
    assert_eq!(fs::read_to_string(&snap).unwrap(), golden.replace("source: opennck", "source: elsewhere"));
}

#[test]
fn a_failed_scenario_reports_an_earlier_difference_from_its_golden_file() {
    let directory = directory("before", SCENARIO);
    outcomes(&directory, Update::Accept);
    let changed = SCENARIO.replace("\"M0.0\" = 1", "\"M0.1\" = 1");
    fs::write(directory.join("flags.toml"), format!("{changed}[[step]]\nexpect = \"M0.0\"\n")).unwrap();
    let outcome = &outcomes(&directory, Update::No)[0];
    assert!(
        matches!(outcome, Outcome::Failed(text) if text.contains("first difference in line 6, at 0.002 s")),
        "{outcome}"
    );
    // Rows of the golden file after the end of the failed run are not a difference.
    fs::write(directory.join("flags.toml"), SCENARIO.replace("\"10ms\"", "\"2ms\"\n[[step]]\nexpect = \"M0.1\""))
        .unwrap();
    let outcome = &outcomes(&directory, Update::No)[0];
    assert!(matches!(outcome, Outcome::Failed(text) if !text.contains("difference")), "{outcome}");
}

#[test]
fn a_failed_expectation_and_an_unusable_file_have_different_outcomes() {
    let directory = directory("failed", &format!("{SCENARIO}[[step]]\nexpect = \"M0.1\"\n"));
    let outcome = &outcomes(&directory, Update::Accept)[0];
    assert!(matches!(outcome, Outcome::Failed(text) if text.contains("M0.1 = 0")), "{outcome}");
    assert_eq!(outcome.exit_code(), 1);
    assert!(!directory.join("flags.snap").exists());
    fs::write(directory.join("flags.toml"), "title = 1\n[[step]]\nrun = \"1s\"\n").unwrap();
    assert!(report(&directory, &Programs::ready(), Update::No).contains("flags.toml:1"));
}

#[test]
fn each_further_profile_has_a_golden_file_of_its_own() {
    let directory = directory("profiles", &format!("profile = [\"840d_sl\", \"828d\"]\n{SCENARIO}"));
    assert_eq!(outcomes(&directory, Update::Accept), [Outcome::Accepted, Outcome::Accepted]);
    assert!(!fs::read_to_string(directory.join("flags.snap")).unwrap().contains("profile"));
    assert!(fs::read_to_string(directory.join("flags.828d.snap")).unwrap().contains("profile   828d"));
}

#[test]
fn a_comparison_of_the_sequence_forgives_times() {
    for (compare, good) in
        [("\"exact\"", false), ("\"sequence\"", true), ("{ time = \"50ms\" }", true), ("{ time = \"1ms\" }", false)]
    {
        let directory = directory("sequence", &format!("compare = {compare}\n{SCENARIO}"));
        outcomes(&directory, Update::Accept);
        let snap = directory.join("flags.snap");
        let later = fs::read_to_string(&snap).unwrap().replace("0.002", "0.010");
        fs::write(&snap, later).unwrap();
        assert_eq!(outcomes(&directory, Update::No)[0].is_good(), good, "{compare}");
    }
}

#[test]
fn windows_line_ends_and_white_space_at_the_end_do_not_count() {
    let directory = directory("windows", SCENARIO);
    outcomes(&directory, Update::Accept);
    let snap = directory.join("flags.snap");
    let windows = fs::read_to_string(&snap).unwrap().replace('\n', "\r\n") + "\r\n  \r\n";
    fs::write(&snap, windows).unwrap();
    assert_eq!(outcomes(&directory, Update::No), [Outcome::Held]);
}

#[test]
fn insta_accepts_a_file_that_we_wrote() {
    let directory = directory("insta", SCENARIO);
    outcomes(&directory, Update::Accept);
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(&directory);
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let case = &cases(&directory.join("flags.toml")).unwrap()[0];
    let body = case.scenario.prepare(case.profile, &Programs::ready()).unwrap().run().golden();
    settings.bind(|| insta::assert_snapshot!("flags", body));
    assert!(!directory.join("flags.snap.new").exists());
}

#[test]
fn scenarios_are_found_below_a_directory_in_order_and_an_empty_one_is_refused() {
    let directory = directory("found", SCENARIO);
    fs::create_dir_all(directory.join("area")).unwrap();
    fs::write(directory.join("area/b.toml"), SCENARIO).unwrap();
    fs::write(directory.join("area/notes.txt"), "").unwrap();
    let files = scenario_files(&[directory.clone(), directory.join("flags.toml")]).unwrap();
    assert_eq!(files, [directory.join("area/b.toml"), directory.join("flags.toml")]);
    fs::create_dir_all(directory.join("empty")).unwrap();
    assert!(scenario_files(&[directory.join("empty")]).is_err());
    assert!(scenario_files(&[directory.join("nowhere")]).is_err());
}
