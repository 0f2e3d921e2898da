//! The rules of the house as tests: who may import whom, and what a file may not hold. Each finding says where it is and
//! what to do instead. The table of rooms is also in the docs of `lib.rs`; change both in one commit.

#[path = "layers/circles.rs"]
mod circles;

use std::fs;
use std::path::{Path, PathBuf};

/// Each room of `src`, and the rooms that it may import besides itself. `*` is all of them.
const ROOMS: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("source", &[]),
    ("image", &["source", "units"]),
    ("variables", &["image", "units"]),
    ("motion", &["units"]),
    ("control", &["image", "motion", "source", "units", "variables"]),
    ("sinumerik", &["control", "image", "motion", "source", "units", "variables"]),
    ("controls", &["control", "image", "sinumerik", "source"]),
    ("plc", &["image", "source", "units"]),
    ("plant", &["motion", "source", "units"]),
    ("trace", &["image", "source", "units", "variables"]),
    ("expression", &["image", "source", "units", "variables"]),
    (
        "machine",
        &[
            "control",
            "controls",
            "expression",
            "image",
            "motion",
            "plant",
            "plc",
            "source",
            "trace",
            "units",
            "variables",
        ],
    ),
    (
        "scenario",
        &["control", "controls", "expression", "image", "machine", "plc", "source", "trace", "units", "variables"],
    ),
    ("golden", &["control", "controls", "image", "machine", "plc", "scenario", "source", "trace", "units"]),
    ("live", &["image", "machine", "plc", "scenario", "source", "trace", "units", "variables"]),
    ("s7", &["control", "image", "live", "machine", "source", "units", "variables"]),
    ("cli", &["*"]),
];

/// Where clocks, threads, sockets and random numbers may be.
const OUTSIDE: &[&str] = &["src/cli/", "src/live/", "src/s7/live/", "src/s7/server/", "src/s7/client/"];

/// A text, why it is refused, and what stands in its place. (`\x21` and the like keep this file from finding itself.)
const REFUSED_IN_RUST: &[(&str, &str)] = &[
    ("\x74odo!", "do it, or leave it out and say so in the head of the file"),
    ("\x75nimplemented!", "do it, or leave it out and say so in the head of the file"),
    ("#[\x69gnore]", "give a reason, `#[ignore = \"…\"]`, or make it a scenario whose `.snap` shows what is"),
];

/// Refused in `src`, where imports go by rooms.
const REFUSED_IN_ROOMS: &[(&str, &str)] = &[
    ("crate::\x7b", "one `use crate::room::…` for each room"),
    ("super::\x73uper", "`crate::room::…`, so that the table of rooms sees it"),
];

/// Refused in the control except in [`INPUTS`]: a signal is named by its constant, so that a moved address does not compile.
const REFUSED_IN_CONTROL: &[(&str, &str)] = &[
    ("Signal\x42it", "the constant of the signal with `axis_signal` and its kin of `sinumerik/inputs.rs`"),
    ("match (byte, \x62it)", "the constant of the signal, in a row of `sinumerik/publish/`"),
];

/// The one file of the control that makes a place of a block out of a signal.
const INPUTS: &str = "src/sinumerik/inputs.rs";

/// Refused in `src` except in [`OUTSIDE`].
const REFUSED_INSIDE: &[(&str, &str)] = &[
    ("std::time", "`opennck::units::Time`; a step does not ask a clock"),
    ("Instant", "`opennck::units::Time`; a step does not ask a clock"),
    ("SystemTime", "`opennck::units::Time`; a step does not ask a clock"),
    ("std::thread", "one thread inside a step; threads belong to `live`, the servers and `cli`"),
    ("std::net", "sockets belong to `s7/server`"),
    ("rand", "the same input gives the same bytes; take numbers from the input"),
    ("fastrand", "the same input gives the same bytes; take numbers from the input"),
];

/// Files with fields that are left out of saved machines, and why they may.
const NOT_SAVED: &[(&str, &str)] = &[
    (
        "src/plant/moving.rs",
        "which switches are pressed follows from the slides, and is found anew after restoring; all slides count as changed then",
    ),
    (
        "src/control/log.rs",
        "which transitions were taken is what a suite has exercised, and decides nothing; for all axes is decided after restoring",
    ),
];

/// Where a control may be named: in itself and in the module that chooses.
const KNOWS_CONTROLS: &[&str] = &["src/sinumerik/", "src/controls/", "src/lib.rs"];

/// Refused in `src` except in [`KNOWS_CONTROLS`].
const REFUSED_OUTSIDE_CONTROLS: &[(&str, &str)] =
    &[("crate::sinumerik", "`dyn Control` and its `Texts`; only `controls` chooses a control")];

/// Refused in every file: what holds on one computer only.
const REFUSED_ANYWHERE: &[(&str, &str)] = &[
    ("/\x77ork/", "a path relative to the file or to the project"),
    ("/\x74mp/", "a path relative to the project, or std::env::temp_dir()"),
    ("/\x72oot/", "a path relative to the file or to the project"),
    ("/\x68ome/", "a path relative to the file or to the project"),
    ("replace-\x77ith", "a mirror of the registry belongs into the cargo configuration of the computer"),
    ("index-\x75rl", "a mirror of the registry belongs into the cargo configuration of the computer"),
    ("sparse\x2b", "a mirror of the registry belongs into the cargo configuration of the computer"),
];

/// The one file with code that the compiler does not check.
const UNSAFE: &str = "src/image/mapped/words.rs";

/// The one source of packages in `Cargo.lock`.
const REGISTRY: &str = "source = \"registry+https://github.com/rust-lang/crates.io-index\"";

/// Lines of a file without its tests.
const LONGEST: usize = 500;

#[test]
fn rooms_import_only_what_their_table_allows() {
    report(rust("src").iter().flat_map(|file| imports(&file.path, &file.text)).collect());
}

#[test]
fn one_module_chooses_among_controls_and_no_other_names_one() {
    let outside =
        rust("src").into_iter().filter(|file| !KNOWS_CONTROLS.iter().any(|known| file.path.starts_with(known)));
    report(outside.flat_map(|file| refused(&file.path, &file.text, REFUSED_OUTSIDE_CONTROLS)).collect());
}

#[test]
fn everything_that_is_remembered_is_saved() {
    let outside = rust("src").into_iter().filter(|file| !NOT_SAVED.iter().any(|(known, _)| file.path == *known));
    let table = &[("serde(skip)", "save it, or give the file a row in NOT_SAVED with the reason")];
    report(outside.flat_map(|file| refused(&file.path, &file.text, table)).collect());
}

#[test]
fn the_table_has_every_room_and_no_other() {
    let mut rooms: Vec<String> = entries(&root().join("src"))
        .iter()
        .filter(|path| path.is_dir())
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    let mut table: Vec<_> = ROOMS.iter().map(|(room, _)| (*room).to_owned()).collect();
    rooms.sort();
    table.sort();
    assert_eq!(rooms, table, "a new room needs a row in tests/layers.rs and in the docs of lib.rs");
    let docs = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    report(ROOMS.iter().flat_map(|(room, may)| documented(&docs, room, may)).collect());
}

#[test]
fn every_file_begins_with_what_it_is() {
    report(rust("").iter().flat_map(|file| head(&file.path, &file.text)).collect());
}

#[test]
fn nothing_is_left_open() {
    report(rust("").iter().flat_map(|file| refused(&file.path, &file.text, REFUSED_IN_RUST)).collect());
}

#[test]
fn imports_go_by_rooms() {
    report(rust("src").iter().flat_map(|file| refused(&file.path, &file.text, REFUSED_IN_ROOMS)).collect());
}

#[test]
fn the_control_names_signals_by_their_constants() {
    let control = rust("src/sinumerik").into_iter().filter(|file| file.path != INPUTS);
    report(control.flat_map(|file| refused(&file.path, &file.text, REFUSED_IN_CONTROL)).collect());
    assert!(!refused("src/x.rs", "Signal\x42it { place, byte: 61, bit: 5 }", REFUSED_IN_CONTROL).is_empty());
    assert!(!refused("src/x.rs", "match (byte, \x62it) {", REFUSED_IN_CONTROL).is_empty());
}

#[test]
fn nothing_inside_asks_a_clock_a_socket_or_chance() {
    let inside = rust("src").into_iter().filter(|file| !OUTSIDE.iter().any(|outside| file.path.starts_with(outside)));
    report(inside.flat_map(|file| refused(&file.path, &file.text, REFUSED_INSIDE)).collect());
}

#[test]
fn one_file_is_unsafe_and_says_why_it_is_sound() {
    report(rust("").iter().flat_map(|file| unchecked(&file.path, &file.text)).collect());
    let text = fs::read_to_string(root().join(UNSAFE)).unwrap();
    assert_eq!(text.matches("\x75nsafe {").count(), 1, "{UNSAFE}: one block is enough");
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    assert!(manifest.contains("\x75nsafe_code = \"deny\""), "Cargo.toml: elsewhere the compiler refuses it");
}

#[test]
fn nothing_holds_on_one_computer_only() {
    let files = files("");
    let mut findings: Vec<_> =
        files.iter().flat_map(|file| refused(&file.path, &file.text, REFUSED_ANYWHERE)).collect();
    findings.extend(files.iter().filter(|file| file.path == "Cargo.lock").flat_map(|file| sources(&file.text)));
    report(findings);
}

#[test]
fn files_are_short() {
    report(rust("src").iter().filter_map(|file| length(&file.path, &file.text)).collect());
}

#[test]
fn every_scenario_has_its_golden_file_and_the_reverse() {
    let paths: Vec<_> = walk(&root().join("golden")).iter().map(|path| relative(path)).collect();
    report(unpaired(&paths));
}

#[test]
fn no_snapshot_waits_for_review() {
    let paths: Vec<_> = walk(&root()).iter().map(|path| relative(path)).collect();
    report(pending(&paths));
}

// The checks: a path and a text, or paths; and the findings.

fn imports(path: &str, text: &str) -> Vec<String> {
    let Some((room, _)) = path.strip_prefix("src/").and_then(|path| path.split_once('/')) else {
        return Vec::new();
    };
    let Some((_, may)) = ROOMS.iter().find(|(name, _)| *name == room) else {
        return vec![format!("{path}:1: {room} is no room: give it a row in tests/layers.rs")];
    };
    let mut findings = Vec::new();
    for (line, found) in lines(text) {
        for rest in found.split("crate::").skip(1) {
            let other: String = rest.chars().take_while(|c| c.is_ascii_alphanumeric() || *c == '_').collect();
            let known = ROOMS.iter().any(|(name, _)| *name == other);
            if known && other != room && !may.contains(&other.as_str()) && !may.contains(&"*") {
                let may = if may.is_empty() { "nothing".to_owned() } else { may.join(", ") };
                findings.push(format!("{path}:{line}: {room} may not import {other}: it may import {may}"));
            }
        }
    }
    findings
}

fn documented(docs: &str, room: &str, may: &[&str]) -> Option<String> {
    let may = match may {
        [] => "nothing".to_owned(),
        ["*"] => "all".to_owned(),
        may => may.iter().map(|room| format!("`{room}`")).collect::<Vec<_>>().join(", "),
    };
    let row = docs.lines().find(|line| line.starts_with(&format!("//! | [`{room}`]")));
    let right = row.is_some_and(|row| row.trim_end().ends_with(&format!("| {may} |")));
    (!right).then(|| format!("src/lib.rs:1: the row of `{room}` in its table of rooms must end with `| {may} |`"))
}

fn head(path: &str, text: &str) -> Option<String> {
    (!text.starts_with("//! "))
        .then(|| format!("{path}:1: begin with `//! ` and what this file is, who calls it, what it reads and writes"))
}

fn refused(path: &str, text: &str, table: &[(&str, &str)]) -> Vec<String> {
    let mut findings = Vec::new();
    for (line, found) in lines(text) {
        for (needle, instead) in table {
            if is_word_in(needle, found) {
                findings.push(format!("{path}:{line}: `{needle}` is refused; instead: {instead}"));
            }
        }
    }
    findings
}

/// `\x75nsafe`, and what lets it pass, in another file than [`UNSAFE`], or a block without its reason before it.
fn unchecked(path: &str, text: &str) -> Vec<String> {
    let mut findings = Vec::new();
    let mut is_explained = false;
    for (line, found) in lines(text) {
        let found = found.trim();
        if found.starts_with("//") {
            is_explained |= found.starts_with("// SAFETY: ");
            continue;
        }
        if is_word_in("\x75nsafe", found) || is_word_in("\x75nsafe_code", found) {
            if path != UNSAFE {
                findings.push(format!("{path}:{line}: only {UNSAFE} may do what the compiler does not check"));
            } else if is_word_in("\x75nsafe", found) && !is_explained {
                findings.push(format!("{path}:{line}: say in `// SAFETY: ` before it why it is sound"));
            }
        }
        is_explained = false;
    }
    findings
}

/// Whether a text occurs and no name goes on before or after it.
fn is_word_in(needle: &str, line: &str) -> bool {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    line.match_indices(needle).any(|(start, _)| {
        let before = line[..start].chars().next_back().is_some_and(is_name);
        let after = line[start + needle.len()..].chars().next().is_some_and(is_name);
        !(before && needle.starts_with(is_name) || after && needle.ends_with(is_name))
    })
}

fn sources(lock: &str) -> Vec<String> {
    lines(lock)
        .filter(|(_, found)| found.starts_with("source = ") && *found != REGISTRY)
        .map(|(line, _)| format!("Cargo.lock:{line}: packages come from crates.io: {REGISTRY}"))
        .collect()
}

fn length(path: &str, text: &str) -> Option<String> {
    if path.ends_with("/tests.rs") || path.contains("/tests/") {
        return None;
    }
    let without_tests = text.find("#[cfg(test)]\nmod tests {").map_or(text, |start| &text[..start]);
    let length = without_tests.lines().count();
    (length > LONGEST)
        .then(|| format!("{path}:{LONGEST}: {length} lines without tests, at most {LONGEST}: split it by what it does"))
}

fn unpaired(paths: &[String]) -> Vec<String> {
    let mut findings = Vec::new();
    for path in paths {
        if let Some(name) = path.strip_suffix(".toml")
            && !paths.contains(&format!("{name}.snap"))
        {
            findings.push(format!(
                "{path}:1: has no golden file: read `opennck run {path}`, then `opennck test --accept {path}`"
            ));
        }
        if let Some(name) = path.strip_suffix(".snap") {
            let name = name.strip_suffix(".828d").unwrap_or(name);
            if !paths.contains(&format!("{name}.toml")) {
                findings.push(format!("{path}:1: has no scenario {name}.toml: remove it, or bring the scenario back"));
            }
        }
    }
    findings
}

fn pending(paths: &[String]) -> Vec<String> {
    let waiting = |path: &&String| path.ends_with(".snap.new") || path.ends_with(".pending-snap");
    let finding = |path: &String| format!("{path}:1: waits for review: `cargo insta review`, or remove it");
    paths.iter().filter(waiting).map(finding).collect()
}

// The files of the project.

struct Text {
    path: String,
    text: String,
}

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// All text files below a folder.
fn files(below: &str) -> Vec<Text> {
    let read = |path: &PathBuf| Some(Text { path: relative(path), text: fs::read_to_string(path).ok()? });
    walk(&root().join(below)).iter().filter_map(read).collect()
}

fn rust(below: &str) -> Vec<Text> {
    let mut files = files(below);
    files.retain(|file| file.path.ends_with(".rs"));
    assert!(!files.is_empty(), "found no Rust below {below}");
    files
}

/// Every file below a folder, in order; not what git and cargo keep there.
fn walk(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for path in entries(folder) {
        if path.is_dir() {
            if !path.ends_with(".git") && !path.join("CACHEDIR.TAG").exists() {
                found.extend(walk(&path));
            }
        } else if !path.ends_with(".git") {
            found.push(path);
        }
    }
    found
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("it was just listed").path()).collect();
    paths.sort();
    paths
}

fn relative(path: &Path) -> String {
    let path = path.strip_prefix(root()).unwrap_or(path);
    path.components().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// Lines, counted from one.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines().enumerate().map(|(index, line)| (index + 1, line))
}

#[track_caller]
#[expect(clippy::needless_pass_by_value, reason = "a check ends with its findings")]
fn report(findings: Vec<String>) {
    assert!(findings.is_empty(), "{} findings:\n{}", findings.len(), findings.join("\n"));
}

// The checks find what they are for.

#[test]
fn a_wrong_import_is_found_with_file_and_line() {
    let text = "//! A head.\nuse crate::units::Time;\nuse crate::sinumerik::Control;\n";
    let findings = imports("src/plc/x.rs", text);
    assert_eq!(
        findings,
        ["src/plc/x.rs:3: plc may not import sinumerik: it may import image, source, units".to_owned()]
    );
    assert!(imports("src/cli/x.rs", text).is_empty());
    assert!(imports("src/lib.rs", text).is_empty());
    assert_eq!(imports("src/units/x.rs", "fn f() -> crate::image::Bytes {}").len(), 1);
    assert_eq!(imports("src/attic/x.rs", "").len(), 1);
}

#[test]
fn a_table_in_the_docs_that_says_something_else_is_found() {
    let docs = "//! | [`plc`] | THE PROGRAM | `image`, `units` |\n//! | [`units`] | units | nothing |";
    assert_eq!(documented(docs, "plc", &["image", "units"]), None);
    assert_eq!(documented(docs, "units", &[]), None);
    assert!(documented(docs, "plc", &["image"]).is_some());
    assert!(documented(docs, "cli", &["*"]).is_some());
}

#[test]
fn a_file_without_a_head_is_found() {
    assert!(head("src/x.rs", "use std::fs;\n").is_some());
    assert!(head("src/x.rs", "//! What it is.\n").is_none());
}

#[test]
fn refused_words_are_found_and_longer_names_are_not() {
    let refused = |text: &str| refused("src/x.rs", text, REFUSED_INSIDE);
    assert_eq!(
        refused("let now = Instant::now();"),
        ["src/x.rs:1: `Instant` is refused; instead: `opennck::units::Time`; a step does not ask a clock".to_owned()]
    );
    assert!(refused("fn operands(brand: Instantaneous) {}").is_empty());
    let open = super_refused("fn f() {\n    \x74odo!()\n}");
    assert!(open[0].starts_with("src/x.rs:2: "), "{open:?}");
    assert_eq!(super_refused("#[\x69gnore]").len(), 1);
    assert!(super_refused("#[ignore = \"needs a disk\"]").is_empty());
}

fn super_refused(text: &str) -> Vec<String> {
    refused("src/x.rs", text, REFUSED_IN_RUST)
}

#[test]
fn an_unchecked_block_is_found_elsewhere_and_without_its_reason() {
    let block = "fn f() {\n    \x75nsafe { g() }\n}";
    let found = |path, text| unchecked(path, text).len();
    assert_eq!(
        unchecked("src/x.rs", block),
        [format!("src/x.rs:2: only {UNSAFE} may do what the compiler does not check")]
    );
    assert_eq!(found("src/x.rs", "#[allow(\x75nsafe_code)]"), 1);
    assert_eq!(found("src/x.rs", "//! No \x75nsafe code."), 0);
    assert_eq!(found(UNSAFE, block), 1);
    assert_eq!(found(UNSAFE, "    // SAFETY: it is\n    // sound.\n    \x75nsafe { g() }"), 0);
}

#[test]
fn a_path_of_one_computer_is_found() {
    let refused = |text: &str| refused("README.md", text, REFUSED_ANYWHERE).len();
    assert_eq!(refused("see /\x74mp/trace.jsonl"), 1);
    assert_eq!(refused("see target/trace.jsonl"), 0);
    assert_eq!(sources(REGISTRY).len(), 0);
    assert_eq!(sources("source = \"registry+https://mirror.example/index\"").len(), 1);
}

#[test]
fn a_long_file_is_found_and_its_tests_do_not_count() {
    let code = "fn f() {}\n".repeat(LONGEST);
    assert!(length("src/x.rs", &code).is_none());
    assert!(length("src/x.rs", &format!("{code}#[cfg(test)]\nmod tests {{\n}}\n")).is_none());
    assert!(length("src/x.rs", &format!("{code}fn g() {{}}\n")).is_some());
    assert!(length("src/room/tests.rs", &format!("{code}fn g() {{}}\n")).is_none());
}

#[test]
fn what_lacks_its_other_half_is_found() {
    let paths = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    assert_eq!(unpaired(&paths(&["golden/a/b.toml", "golden/a/b.snap", "golden/a/b.828d.snap"])).len(), 0);
    assert_eq!(unpaired(&paths(&["golden/a/b.toml"])).len(), 1);
    assert_eq!(unpaired(&paths(&["golden/a/b.snap"])).len(), 1);
    assert_eq!(pending(&paths(&["a/b.snap.new", "a/.c.rs.pending-snap", "a/b.snap"])).len(), 2);
}
