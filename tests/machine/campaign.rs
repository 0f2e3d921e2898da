//! `opennck campaign` as users call it: parts and the whole, interrupted runs, what is refused.
#![cfg(feature = "cli")]

use std::fs;
use std::path::{Path, PathBuf};

use super::cli::{directory, err, opennck, out};

/// A campaign in a directory of its own. The axes are 0.5263 mm apart (see the scenario), so a limit of 0.52 warns and one of 0.53 does not.
fn campaign(name: &str, more: &str) -> PathBuf {
    let directory = directory(name);
    let scenario = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden/worked_example/heavy_load.toml");
    let scenario = scenario.display();
    let text = format!("scenario = '{scenario}'\nnever = [\"alarm(10652)\"]\n{more}");
    fs::write(directory.join("c.toml"), text).expect("the target directory is writable");
    directory
}

const LIMITS: &str = "[vary]\n\"37110[XF]\" = [0.52, 0.53, 0.54, 0.51]\n";

fn file(directory: &Path, name: &str) -> String {
    fs::read_to_string(directory.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[test]
fn parts_threads_and_an_interrupted_run_give_the_same_bytes() {
    let directory = campaign("campaign_parts", LIMITS);
    let run = |arguments: &[&str]| {
        let output = opennck(arguments, &directory);
        assert_eq!(output.status.code(), Some(1), "{}{}", out(&output), err(&output));
        out(&output)
    };
    let screen = run(&["campaign", "c.toml", "--out", "whole", "--jobs", "1"]);
    assert!(screen.contains("4 cases: 2 failed, 2 held"), "{screen}");
    assert!(screen.contains("1. 2 cases: `never` is violated: `alarm(10652)` is true"), "{screen}");
    assert!(screen.contains("next: opennck run whole/failures/1.toml"), "{screen}");
    run(&["run", "whole/failures/1.toml"]);
    run(&["campaign", "c.toml", "--out", "one", "--shard", "1/2"]);
    run(&["campaign", "c.toml", "--out", "two", "--shard", "2/2", "--jobs", "3"]);
    run(&["campaign", "merge", "c.toml", "two", "one", "--out", "merged"]);
    // A run that was ended in the middle of a line.
    let results = file(&directory, "whole/results.jsonl");
    fs::create_dir_all(directory.join("again")).unwrap();
    fs::write(directory.join("again/results.jsonl"), &results[..results.len() * 2 / 3]).unwrap();
    run(&["campaign", "c.toml", "--out", "again", "--resume"]);
    for other in ["merged", "again"] {
        for name in ["results.jsonl", "report.json", "report.html", "junit.xml", "failures/1.toml"] {
            assert_eq!(
                file(&directory, &format!("{other}/{name}")),
                file(&directory, &format!("whole/{name}")),
                "{other}"
            );
        }
    }
    let report: serde_json::Value = serde_json::from_str(&file(&directory, "whole/report.json")).unwrap();
    assert_eq!((report["verdicts"]["failed"].as_u64(), report["groups"][0]["cases"].as_u64()), (Some(2), Some(2)));
    for (arguments, what) in [
        (vec!["campaign", "merge", "c.toml", "one", "--out", "m"], "none of part 2/2"),
        (vec!["campaign", "merge", "c.toml", "one", "one", "--out", "m"], "found part 1/2 twice"),
        (vec!["campaign", "c.toml", "--out", "one", "--resume"], "found those of part 1/2"),
        (
            vec!["campaign", "c.toml", "--out", "whole", "--limit", "3", "--resume"],
            "expected results of 3 cases, found those of 4",
        ),
    ] {
        refused(&directory, &arguments, what);
    }
    fs::write(directory.join("two/results.jsonl"), &results[..results.len() * 2 / 3]).unwrap();
    refused(
        &directory,
        &["campaign", "merge", "c.toml", "one", "two", "--out", "m"],
        "part 1/2, found those of part 1/1",
    );
    let damaged = file(&directory, "one/results.jsonl").replacen("\"case\"", "\"cas\"", 1);
    fs::write(directory.join("one/results.jsonl"), damaged).unwrap();
    refused(&directory, &["campaign", "c.toml", "--shard", "1/2", "--out", "one", "--resume"], "the file is damaged");
    let other = results.replacen(env!("CARGO_PKG_VERSION"), "9.9.9", 1);
    fs::write(directory.join("whole/results.jsonl"), other).unwrap();
    refused(&directory, &["campaign", "c.toml", "--out", "whole", "--resume"], "found those of version 9.9.9");
}

fn refused(directory: &PathBuf, arguments: &[&str], what: &str) {
    let output = opennck(arguments, directory);
    assert_eq!(output.status.code(), Some(2), "{}", out(&output));
    assert!(err(&output).contains(what), "{what}: {}", err(&output));
}

#[test]
fn billions_of_cases_do_not_begin() {
    let range = "{ from = 0.53, to = 1.53, step = 0.0001 }";
    let directory = campaign(
        "campaign_billions",
        &format!("[vary]\n\"37110[XF]\" = {range}\n\"37110[X]\" = {range}\n\"37120[X]\" = {range}\n"),
    );
    let output = opennck(&["campaign", "c.toml"], &directory);
    assert_eq!(output.status.code(), Some(2));
    // 10,001 values each.
    assert!(err(&output).contains("found 1000300030001: about"), "{}", err(&output));
    let output = opennck(&["campaign", "c.toml", "--list", "--limit", "2"], &directory);
    assert_eq!(out(&output).lines().count(), 2, "{}", out(&output));
}

#[test]
fn what_no_case_reaches_fails_the_campaign() {
    let text = "sometimes = [\"X.gantry_grouping_is_synchronized\", \"alarm(10653)\"]\n[vary]\n\"37110[XF]\" = [0.6]\n";
    let directory = campaign("campaign_sometimes", text);
    let output = opennck(&["campaign", "c.toml"], &directory);
    assert_eq!(output.status.code(), Some(1), "{}", out(&output));
    assert!(out(&output).contains("no case reached alarm(10653)"), "{}", out(&output));
    assert!(!out(&output).contains("no case reached X.gantry"), "{}", out(&output));
    assert!(file(&directory, "c-results/junit.xml").contains("no case reached alarm(10653)"));
}
