//! Campaigns over golden scenarios, with results that arithmetic gives.

use std::path::{Path, PathBuf};

use super::*;
use crate::plc::Programs;
use crate::source::Problem;

/// A file of a campaign in a folder of its own; paths in it begin in the project.
fn spec(name: &str, text: &str) -> Result<Spec, Problem> {
    let folder = folder(name);
    let base = Path::new(env!("CARGO_MANIFEST_DIR")).join("golden");
    let path = folder.join("campaign.toml");
    std::fs::write(&path, text.replace("golden/", &format!("{}/", base.display()))).unwrap();
    Spec::read(&path, &Programs::ready())
}

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opennck-campaign-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn records(spec: &Spec) -> Vec<Record> {
    let cases = u64::try_from(spec.cases()).unwrap();
    (0..spec.units(cases)).flat_map(|unit| spec.run(unit, cases, &Programs::ready())).collect()
}

const HEAVY_LOAD: &str = "scenario = \"golden/worked_example/heavy_load.toml\"\nnever = [\"alarm(10652)\"]\n";

/// XF has 5 % less servo gain than X: at 10000 mm/min its following error is 10 / 0.95 mm, that of X is 10 mm. So the difference is
/// 10 / 0.95 - 10 = 0.5263 mm, and a warning limit below it raises 10652.
#[test]
fn a_warning_limit_fails_exactly_when_it_is_below_the_difference() {
    let text = format!("{HEAVY_LOAD}[vary]\n\"37110[XF]\" = {{ from = 0.51, to = 0.54, step = 0.01 }}\n");
    let spec = spec("limits", &text).unwrap();
    let records = records(&spec);
    assert_eq!(spec.cases(), 4);
    for record in &records {
        let limit: f64 = record.values[0].1.parse().unwrap();
        let expected = if limit < 10.0 / 0.95 - 10.0 { Verdict::Failed } else { Verdict::Held };
        assert_eq!(record.verdict, expected, "{limit}: {}", record.text);
    }
    let failed: Vec<_> = records.iter().filter(|record| record.verdict == Verdict::Failed).collect();
    assert_eq!(failed[0].failure, "`never` is violated: `alarm(10652)` is true");
    assert_eq!(failed[0].chain.first().map(String::as_str), Some("MON-02"), "{:?}", failed[0].chain);
    let smallest = spec.shrink(failed[0], &folder("limits"), &Programs::ready()).unwrap();
    assert_eq!(smallest.needed, [("37110[XF]".to_owned(), "0.51".to_owned())]);
    assert!(smallest.steps.0 < smallest.steps.1, "{:?}", smallest.steps);
    let path = folder("limits").join("smallest.toml");
    std::fs::write(&path, &smallest.text).unwrap();
    let scenario = crate::scenario::Scenario::read(&path).unwrap();
    let profile = scenario.profiles[0];
    let failure = scenario.prepare(profile, &Programs::ready()).unwrap().run().failure.unwrap();
    assert!(failure.to_string().contains("`never` is violated: `alarm(10652)` is true"), "{failure}");
}

#[test]
fn bisection_finds_the_difference() {
    let text = format!(
        "{HEAVY_LOAD}strategy = {{ boundary = \"37110[XF]\", to = 0.001 }}\n[vary]\n\"37110[XF]\" = {{ from = 0.5, to = 0.6 }}\n"
    );
    let spec = spec("boundary", &text).unwrap();
    let mut summary = Summary::of(&spec);
    records(&spec).iter().for_each(|record| summary.add(record));
    summary.finish(&spec, &Programs::ready()).unwrap();
    let [boundary] = &summary.boundaries[..] else { panic!("{:?}", summary.boundaries) };
    // 0.1 halved until it is at most 0.001: seven times, and both ends.
    assert_eq!(summary.cases, 9);
    let difference = 10.0 / 0.95 - 10.0;
    assert!(boundary.failed < difference && boundary.held > boundary.failed, "{boundary:?}");
    assert!((boundary.held - difference).abs() < 0.002, "{boundary:?}");
}

/// Cases with a common beginning run it once; the result is that of cases that run alone.
#[test]
fn a_case_that_goes_on_from_a_copy_is_the_case_that_runs_alone() {
    let text = "scenario = \"golden/worked_example/heavy_load.toml\"\nalarms = { may = [10652] }\n[[fault]]\n\
        kind = [\"drive_fault\", \"push\"]\nby = 0.3\naxis = \"XF\"\ntime = [\"2s\", \"0s\", \"7.0035s\"]\n";
    let text = text.replace("kind = [\"drive_fault\", \"push\"]", "kind = \"push\"");
    let spec = spec("fork", &text).unwrap();
    let forked = records(&spec);
    let alone: Vec<_> = (0..3).map(|number| spec.alone(number, &spec.choices(number), &Programs::ready())).collect();
    assert_eq!(spec.units(3), 1);
    assert_eq!(forked, alone);
}

/// A smallest scenario fails because of what is needed: without the fault it does not fail in this way.
#[test]
fn what_also_fails_with_the_values_of_the_base_scenario_shows_nothing() {
    let text = "scenario = \"golden/worked_example/heavy_load.toml\"\n[[fault]]\nkind = \"drive_fault\"\naxis = \"XF\"\ntime = \"9.12s\"\n";
    let spec = spec("needed", text).unwrap();
    let record = &records(&spec)[0];
    assert_eq!(record.verdict, Verdict::Failed);
    let folder = folder("needed");
    let smallest = spec.shrink(record, &folder, &Programs::ready()).unwrap();
    assert_eq!(smallest.needed.len(), 1);
    let failure = |text: &str| {
        let scenario = crate::scenario::Scenario::parse(text, &folder.join("s.toml")).unwrap();
        let finished = scenario.prepare(scenario.profiles[0], &Programs::ready()).unwrap().run();
        finished.failure.map(|failure| failure.to_string()).unwrap_or_default()
    };
    let missed = record.failure.split('`').nth(1).unwrap();
    assert!(failure(&smallest.text).contains(missed), "{}", failure(&smallest.text));
    // An entry of a time that does not come.
    let without = smallest.text.replace("time = \"9.12s\"", "time = \"300s\"");
    assert_ne!(without, smallest.text);
    assert!(!failure(&without).contains(missed), "{}", smallest.text);
}

#[test]
fn any_two_values_of_a_pairwise_campaign_occur_together() {
    let text = format!(
        "{HEAVY_LOAD}strategy = \"pairwise\"\n[vary]\n\"37110[XF]\" = [0.6, 0.7, 0.8]\n\"37110[X]\" = [0.6, 0.7, 0.8]\n\"37120[XF]\" = [1, 2]\n"
    );
    let spec = spec("pairs", &text).unwrap();
    let cases = u64::try_from(spec.cases()).unwrap();
    assert!((9..=10).contains(&cases), "at least 3 * 3 and well below 3 * 3 * 2, found {cases}");
    let all: Vec<_> = (0..cases).map(|number| spec.values(number)).collect();
    for (one, other) in [(0, 1), (0, 2), (1, 2)] {
        let pairs: std::collections::BTreeSet<_> =
            all.iter().map(|values| (&values[one].1, &values[other].1)).collect();
        assert_eq!(pairs.len() as u64, spec.varied()[one].1 * spec.varied()[other].1);
    }
}

#[test]
fn the_seed_decides_what_is_drawn() {
    let text = |seed: u64| {
        format!(
            "{HEAVY_LOAD}seed = {seed}\nstrategy = {{ random = 20 }}\n[vary]\n\"37110[XF]\" = {{ uniform = [0.6, 0.7], count = 1 }}\n"
        )
    };
    let values = |seed| {
        let spec = spec(&format!("seed{seed}"), &text(seed)).unwrap();
        (0..20).map(|number| spec.values(number)[0].1.clone()).collect::<Vec<_>>()
    };
    let (one, again, other) = (values(1), values(1), values(2));
    assert_eq!(one, again);
    assert_ne!(one, other);
    assert!(one.iter().all(|value| (0.6..0.7).contains(&value.parse::<f64>().unwrap())), "{one:?}");
    assert_eq!(one.iter().collect::<std::collections::BTreeSet<_>>().len(), 20, "each case has its own number");
}

#[test]
fn a_record_is_the_line_that_is_read_again() {
    let record = Record {
        case: 7,
        values: vec![("37110[XF]".to_owned(), "0.5".to_owned())],
        verdict: Verdict::Failed,
        failure: "a".to_owned(),
        text: "a\nb".to_owned(),
        chain: vec!["MON-02".to_owned()],
        at: 1.5,
        margins: vec![("r".to_owned(), -0.25, false)],
        reached: vec!["alarm 10652".to_owned()],
    };
    let lines = Lines::default().of(&record);
    let place = crate::source::Place::file("results.jsonl");
    let mut reading = Reading::default();
    let read: Vec<_> = lines.lines().filter_map(|line| reading.line(line, &place).unwrap()).collect();
    assert_eq!(read, [record]);
    assert!(reading.line("{\"case\": 1}", &place).unwrap_err().to_string().contains("damaged"));
}

#[test]
fn a_mistake_names_its_place_and_a_cure() {
    for (text, what, cure) in [
        ("", "expected the key `scenario`", "write scenario"),
        ("scenario = \"golden/worked_example/heavy_load.toml\"\n", "found nothing", "[vary]"),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\nstrategy = \"al\"\n[vary]\nplc = [\"gantry_start\"]\n",
            "a strategy",
            "pairwise",
        ),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\n[vary]\n\"37110[XF]\" = []\n",
            "found none of them",
            "uniform",
        ),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\n[vary]\n\"37110[XF]\" = { from = 1, to = 0, step = 0.1 }\n",
            "`from` below `to`",
            "step",
        ),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\n[vary]\nplc = [\"gantry_strt\"]\n",
            "gantry_strt",
            "gantry_start",
        ),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\n[[fault]]\nkind = \"blok\"\naxis = \"XF\"\ntime = \"1s\"\n",
            "a kind of fault",
            "did you mean `block`?",
        ),
        (
            "scenario = \"golden/worked_example/heavy_load.toml\"\nstrategy = { boundary = \"37110[X]\", to = 0.1 }\n[vary]\nplc = [\"gantry_start\"]\n",
            "`37110[X]`",
            "from",
        ),
    ] {
        let problem = spec("mistakes", text).unwrap_err().to_string();
        assert!(problem.contains(what) && problem.contains(cure), "{text}: {problem}");
    }
}
