//! The style rules of the project as tests: the imports that each module may use, and texts that a file must not contain. Each finding
//! names the place and the remedy. The table of modules is also in the docs of `lib.rs`; change both in one commit.

#[path = "layers/cycles.rs"]
mod cycles;

use std::fs;
use std::path::{Path, PathBuf};

/// Each module of `src`, and the modules that it may import besides itself. `*` means all modules.
const MODULES: &[(&str, &[&str])] = &[
    ("units", &[]),
    ("source", &[]),
    ("image", &["source", "units"]),
    ("variables", &["image", "source", "units"]),
    ("motion", &["units"]),
    ("nc_program", &[]),
    ("control", &["image", "motion", "nc_program", "source", "units", "variables"]),
    ("sinumerik", &["control", "image", "motion", "nc_program", "source", "units", "variables"]),
    ("isg", &["control", "image", "motion", "nc_program", "source", "units", "variables"]),
    ("controls", &["control", "image", "isg", "sinumerik", "source"]),
    ("plc", &["image", "source", "units"]),
    ("plant", &["motion", "source", "units"]),
    ("trace", &["image", "source", "units", "variables"]),
    ("expression", &["image", "source", "units", "variables"]),
    ("monitor", &["expression", "image", "source", "units", "variables"]),
    (
        "machine",
        &[
            "control",
            "controls",
            "expression",
            "image",
            "motion",
            "nc_program",
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
        &[
            "control",
            "controls",
            "expression",
            "image",
            "machine",
            "monitor",
            "nc_program",
            "plc",
            "source",
            "trace",
            "units",
            "variables",
        ],
    ),
    ("golden", &["control", "controls", "image", "plc", "scenario", "source", "trace", "units"]),
    ("campaign", &["image", "plc", "scenario", "source", "trace", "units", "variables"]),
    ("live", &["image", "machine", "plc", "scenario", "source", "trace", "units", "variables"]),
    ("s7", &["image", "live", "machine", "source", "units", "variables"]),
    ("web", &["control", "image", "live", "machine", "plc", "scenario", "source", "trace", "units", "variables"]),
    ("opcua", &["image", "live", "machine", "source", "units", "variables"]),
    ("symbol_files", &["image"]),
    ("cli", &["*"]),
];

/// Files that may use clocks, threads, sockets and random numbers.
const OUTSIDE: &[&str] =
    &["src/cli/", "src/live/", "src/s7/live/", "src/s7/server/", "src/s7/client/", "src/web/", "src/opcua/"];

/// A text and its remedy. (Escapes such as `\x21` keep this file from finding itself.)
const REFUSED_IN_RUST: &[(&str, &str)] = &[
    ("\x74odo!", "implement it, or omit it and state this in the head of the file"),
    ("\x75nimplemented!", "implement it, or omit it and state this in the head of the file"),
    (
        "#[\x69gnore]",
        "write a reason, `#[ignore = \"…\"]`, or write a scenario whose `.snap` shows the current behaviour",
    ),
];

/// Texts that are rejected in `src`, so that each import names its module.
const REFUSED_IN_MODULES: &[(&str, &str)] = &[
    ("crate::\x7b", "write one `use crate::module::…` for each module"),
    ("super::\x73uper", "write `crate::module::…`, so that the table of modules is checked"),
];

/// Texts that are rejected in the control except in [`INPUTS`]. A signal is named by its constant, so that a moved address does not
/// compile.
const REFUSED_IN_CONTROL: &[(&str, &str)] = &[
    (
        "Signal\x42it",
        "use the constant of the signal with `axis_signal` or a similar function of `sinumerik/inputs.rs`",
    ),
    ("match (byte, \x62it)", "use the constant of the signal, in a row of `sinumerik/publish/`"),
];

/// The only file of the control that converts a signal to a position in a block.
const INPUTS: &str = "src/sinumerik/inputs.rs";

/// Texts that are rejected in `src` except in [`OUTSIDE`].
const REFUSED_INSIDE: &[(&str, &str)] = &[
    ("std::time", "use `opennck::units::Time`; a step must not read a clock"),
    ("Instant", "use `opennck::units::Time`; a step must not read a clock"),
    ("SystemTime", "use `opennck::units::Time`; a step must not read a clock"),
    ("std::thread", "a step runs on one thread; move threads to `live`, the servers or `cli`"),
    ("std::net", "move sockets to `s7/server`"),
    ("rand", "the same input must give the same bytes; take numbers from the input"),
    ("fastrand", "the same input must give the same bytes; take numbers from the input"),
];

/// Files with fields that are not saved with a machine, and the reason.
const NOT_SAVED: &[(&str, &str)] = &[
    (
        "src/plant/moving.rs",
        "the pressed switches follow from the slides and are recomputed after restoring; all slides count as changed then",
    ),
    (
        "src/control/log.rs",
        "the transitions taken are statistics of a test suite and have no effect; all axes are decided after restoring",
    ),
];

/// Files that may name a control: its own module, and the module that selects a control.
const KNOWS_CONTROLS: &[&str] = &["src/sinumerik/", "src/controls/", "src/lib.rs"];

/// Texts that are rejected in `src` except in [`KNOWS_CONTROLS`].
const REFUSED_OUTSIDE_CONTROLS: &[(&str, &str)] =
    &[("crate::sinumerik", "use `dyn Control` and its `Texts`; only `controls` selects a control")];

/// The structures and constants of the SINUMERIK that `image` exports. Everything else in `image` works for any interface.
const SINUMERIK_IMAGE: &[&str] = &[
    "ACKNOWLEDGE_USER_ALARMS",
    "Axis828d",
    "AxisFromNck",
    "AxisToNck",
    "ChannelAuxiliary",
    "ChannelAuxiliary828d",
    "ChannelFromNck",
    "ChannelHmi",
    "ChannelJumpToNck",
    "ChannelProgramToNck",
    "ChannelSearchFromNck",
    "ChannelToNck",
    "FromNck",
    "Hmi",
    "ModeGroupFromNck",
    "ModeGroupHmi",
    "ModeGroupToNck",
    "NckFromNck",
    "NckHmi",
    "NckToNck",
    "Plain",
    "SINUMERIK",
    "Sinumerik",
    "ToNck",
    "USER_ALARMS",
    "UserAlarmsToNck",
    "UserFromNck",
    "axis_828d",
    "axis_from_nck",
    "axis_to_nck",
    "channel_auxiliary",
    "channel_auxiliary_828d",
    "channel_from_nck",
    "channel_hmi",
    "channel_jump_to_nck",
    "channel_program_to_nck",
    "channel_search_from_nck",
    "channel_to_nck",
    "mode_group_from_nck",
    "mode_group_hmi",
    "mode_group_to_nck",
    "nck_from_nck",
    "nck_hmi",
    "nck_to_nck",
    "user_alarm",
];

/// Files that may use [`SINUMERIK_IMAGE`]: the tables themselves, the control, the default structures of a PLC program, and NC variables.
const USES_SINUMERIK_IMAGE: &[&str] = &[
    "src/image/",
    "src/sinumerik/",
    "src/plc/basic_program/",
    "src/plc/closure.rs",
    "src/plc/io.rs",
    "src/plc/link.rs",
    "src/plc/step7/basic_program/spindles.rs",
    "src/s7/tests/",
    "src/variables/axis_value.rs",
    "src/variables/nc/",
];

/// Texts that are rejected in every file, because they are valid on one computer only.
const REFUSED_ANYWHERE: &[(&str, &str)] = &[
    ("/\x77ork/", "write a path relative to the file or to the project"),
    ("/\x74mp/", "write a path relative to the project, or use std::env::temp_dir()"),
    ("/\x72oot/", "write a path relative to the file or to the project"),
    ("/\x68ome/", "write a path relative to the file or to the project"),
    ("replace-\x77ith", "configure a mirror of the registry in the cargo configuration of the computer"),
    ("index-\x75rl", "configure a mirror of the registry in the cargo configuration of the computer"),
    ("sparse\x2b", "configure a mirror of the registry in the cargo configuration of the computer"),
];

/// The only file with code that the compiler does not check.
const UNSAFE: &str = "src/image/mapped/words.rs";

/// The only source of packages in `Cargo.lock`.
const REGISTRY: &str = "source = \"registry+https://github.com/rust-lang/crates.io-index\"";

/// The maximum number of lines of a file without its tests.
const LONGEST: usize = 500;

/// A table of signals with one line for each, which is looked up, not read.
const LONG_TABLE: &str = "src/image/sinumerik/db21_auxiliary.rs";

#[test]
fn modules_import_only_what_their_table_allows() {
    report(rust("src").iter().flat_map(|file| imports(&file.path, &file.text)).collect());
}

#[test]
fn modules_import_all_that_their_table_allows() {
    let files = rust("src");
    report(MODULES.iter().flat_map(|(module, may)| unused(module, may, &files)).collect());
}

#[test]
fn one_module_selects_controls_and_no_other_names_one() {
    let outside =
        rust("src").into_iter().filter(|file| !KNOWS_CONTROLS.iter().any(|known| file.path.starts_with(known)));
    report(outside.flat_map(|file| refused(&file.path, &file.text, REFUSED_OUTSIDE_CONTROLS)).collect());
}

#[test]
fn the_structures_of_the_sinumerik_are_used_where_they_are_meant() {
    let outside =
        rust("src").into_iter().filter(|file| !USES_SINUMERIK_IMAGE.iter().any(|known| file.path.starts_with(known)));
    report(outside.flat_map(|file| sinumerik_image(&file.path, &file.text)).collect());
    let exported = fs::read_to_string(root().join("src/image/mod.rs")).unwrap();
    let (_, exported) = exported.split_once("pub use sinumerik::{").expect("image exports them in one list");
    let exported: Vec<_> =
        exported[..exported.find('}').unwrap()].split(',').map(str::trim).filter(|name| !name.is_empty()).collect();
    assert_eq!(exported, SINUMERIK_IMAGE, "SINUMERIK_IMAGE must be the list that src/image/mod.rs exports");
}

#[test]
fn the_complete_state_is_saved() {
    let outside = rust("src").into_iter().filter(|file| !NOT_SAVED.iter().any(|(known, _)| file.path == *known));
    let table = &[("serde(skip)", "save the field, or add a row with the reason to NOT_SAVED")];
    report(outside.flat_map(|file| refused(&file.path, &file.text, table)).collect());
}

#[test]
fn the_table_has_every_module_and_no_other() {
    let mut modules: Vec<String> = entries(&root().join("src"))
        .iter()
        .filter(|path| path.is_dir())
        .filter_map(|path| Some(path.file_name()?.to_str()?.to_owned()))
        .collect();
    let mut table: Vec<_> = MODULES.iter().map(|(module, _)| (*module).to_owned()).collect();
    modules.sort();
    table.sort();
    assert_eq!(modules, table, "a new module needs a row in tests/layers.rs and in the docs of lib.rs");
    let docs = fs::read_to_string(root().join("src/lib.rs")).unwrap();
    report(MODULES.iter().flat_map(|(module, may)| documented(&docs, module, may)).collect());
}

#[test]
fn every_file_begins_with_its_purpose() {
    report(rust("").iter().flat_map(|file| head(&file.path, &file.text)).collect());
}

#[test]
fn no_file_contains_unfinished_code() {
    report(rust("").iter().flat_map(|file| refused(&file.path, &file.text, REFUSED_IN_RUST)).collect());
}

#[test]
fn each_import_names_its_module() {
    report(rust("src").iter().flat_map(|file| refused(&file.path, &file.text, REFUSED_IN_MODULES)).collect());
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
fn one_file_is_unsafe_and_justifies_it() {
    report(rust("").iter().flat_map(|file| unchecked(&file.path, &file.text)).collect());
    let text = fs::read_to_string(root().join(UNSAFE)).unwrap();
    assert_eq!(text.matches("\x75nsafe {").count(), 1, "{UNSAFE}: keep exactly one block");
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    assert!(
        manifest.contains("\x75nsafe_code = \"deny\""),
        "Cargo.toml: the compiler must reject it in all other files"
    );
}

#[test]
fn no_file_depends_on_one_computer() {
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

// The checks: each takes a path and a text, or a list of paths, and returns its findings.

fn imports(path: &str, text: &str) -> Vec<String> {
    let Some((module, _)) = path.strip_prefix("src/").and_then(|path| path.split_once('/')) else {
        return Vec::new();
    };
    let Some((_, may)) = MODULES.iter().find(|(name, _)| *name == module) else {
        return vec![format!("{path}:1: {module} is not in the table of modules: add a row in tests/layers.rs")];
    };
    let mut findings = Vec::new();
    for (line, found) in lines(text) {
        for other in named(found) {
            let known = MODULES.iter().any(|(name, _)| *name == other);
            if known && other != module && !may.contains(&other) && !may.contains(&"*") {
                let may = if may.is_empty() { "nothing".to_owned() } else { may.join(", ") };
                findings.push(format!("{path}:{line}: {module} must not import {other}; allowed imports: {may}"));
            }
        }
    }
    findings
}

/// The names after each `crate::` of a text.
fn named(text: &str) -> impl Iterator<Item = &str> {
    let name = |rest: &'_ str| rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
    text.split("crate::").skip(1).map(move |rest| &rest[..name(rest)])
}

/// Finds the modules that a module may import and does not.
fn unused(module: &str, may: &[&str], files: &[Text]) -> Vec<String> {
    let inside = format!("src/{module}/");
    let names = |other: &str| {
        let mut own = files.iter().filter(|file| file.path.starts_with(&inside));
        own.any(|file| named(&file.text).any(|name| name == other))
    };
    let unused = may.iter().filter(|other| **other != "*" && !names(other));
    unused.map(|other| format!("{inside}: never imports {other}: remove it from the row in both tables")).collect()
}

fn documented(docs: &str, module: &str, may: &[&str]) -> Option<String> {
    let may = match may {
        [] => "nothing".to_owned(),
        ["*"] => "all".to_owned(),
        may => may.iter().map(|module| format!("`{module}`")).collect::<Vec<_>>().join(", "),
    };
    let row = docs.lines().find(|line| line.starts_with(&format!("//! | [`{module}`]")));
    let right = row.is_some_and(|row| row.trim_end().ends_with(&format!("| {may} |")));
    (!right).then(|| format!("src/lib.rs:1: the row of `{module}` in its table of modules must end with `| {may} |`"))
}

fn head(path: &str, text: &str) -> Option<String> {
    (!text.starts_with("//! "))
        .then(|| format!("{path}:1: begin the file with `//! ` and its purpose, its callers, its inputs and outputs"))
}

fn refused(path: &str, text: &str, table: &[(&str, &str)]) -> Vec<String> {
    let mut findings = Vec::new();
    for (line, found) in lines(text) {
        for (needle, instead) in table {
            if is_word_in(needle, found) {
                findings.push(format!("{path}:{line}: `{needle}` is not allowed: {instead}"));
            }
        }
    }
    findings
}

/// Finds the structures of the SINUMERIK in the imports from `image`, also of several lines.
fn sinumerik_image(path: &str, text: &str) -> Vec<String> {
    let is_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut findings = Vec::new();
    for (start, prefix) in text.match_indices("crate::image::") {
        let rest = &text[start + prefix.len()..];
        let end = if rest.starts_with('{') { rest.find('}') } else { rest.find(|c| !is_name(c)) };
        let line = text[..start].lines().count().max(1);
        let imported = rest[..end.unwrap_or(rest.len())].split(|c| !is_name(c));
        findings.extend(imported.filter(|name| SINUMERIK_IMAGE.contains(name)).map(|name| {
            format!("{path}:{line}: `{name}` is of the SINUMERIK: use the interface of the machine, or add the file to USES_SINUMERIK_IMAGE")
        }));
    }
    findings
}

/// Finds `\x75nsafe`, or an attribute that allows it, in a file other than [`UNSAFE`], or a block without a reason before it.
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
                findings
                    .push(format!("{path}:{line}: only {UNSAFE} may contain code that the compiler does not check"));
            } else if is_word_in("\x75nsafe", found) && !is_explained {
                findings.push(format!("{path}:{line}: state before it in `// SAFETY: ` why it is sound"));
            }
        }
        is_explained = false;
    }
    findings
}

/// Whether a text occurs that is not part of a longer name.
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
        .map(|(line, _)| format!("Cargo.lock:{line}: use packages from crates.io only: {REGISTRY}"))
        .collect()
}

fn length(path: &str, text: &str) -> Option<String> {
    if path.ends_with("/tests.rs") || path.contains("/tests/") {
        return None;
    }
    let without_tests = text.find("#[cfg(test)]\nmod tests {").map_or(text, |start| &text[..start]);
    let length = without_tests.lines().count();
    (length > LONGEST && path != LONG_TABLE).then(|| {
        format!("{path}:{LONGEST}: {length} lines without tests, maximum {LONGEST}: split the file by purpose")
    })
}

fn unpaired(paths: &[String]) -> Vec<String> {
    let mut findings = Vec::new();
    for path in paths {
        // A scenario with a matrix has a golden file for each case, `name@values.snap`; a part and a machine have none.
        let has_cases = |name: &str| paths.iter().any(|path| path.starts_with(&format!("{name}@")));
        if let Some(name) = path.strip_suffix(".toml")
            && !path.contains("/parts/")
            && !path.ends_with("/plant.toml")
            && !paths.contains(&format!("{name}.snap"))
            && !has_cases(name)
        {
            findings.push(format!(
                "{path}:1: has no golden file: review `opennck run {path}`, then run `opennck test --accept {path}`"
            ));
        }
        if let Some(name) = path.strip_suffix(".snap") {
            let name = name.strip_suffix(".828d").unwrap_or(name);
            let name = name.split('@').next().unwrap_or(name);
            if !paths.contains(&format!("{name}.toml")) {
                findings.push(format!("{path}:1: has no scenario {name}.toml: remove it, or restore the scenario"));
            }
        }
    }
    findings
}

fn pending(paths: &[String]) -> Vec<String> {
    let waiting = |path: &&String| path.ends_with(".snap.new") || path.ends_with(".pending-snap");
    let finding = |path: &String| format!("{path}:1: needs a review: run `cargo insta review`, or remove it");
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

/// Every file below a folder, in order, except the folders of git and cargo.
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
    let mut paths: Vec<_> = entries.map(|entry| entry.expect("the entry was just listed").path()).collect();
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

// Tests of the checks.

#[test]
fn a_wrong_import_is_found_with_file_and_line() {
    let text = "//! A head.\nuse crate::units::Time;\nuse crate::sinumerik::Control;\n";
    let findings = imports("src/plc/x.rs", text);
    assert_eq!(
        findings,
        ["src/plc/x.rs:3: plc must not import sinumerik; allowed imports: image, source, units".to_owned()]
    );
    assert!(imports("src/cli/x.rs", text).is_empty());
    assert!(imports("src/lib.rs", text).is_empty());
    assert_eq!(imports("src/units/x.rs", "fn f() -> crate::image::Bytes {}").len(), 1);
    assert_eq!(imports("src/attic/x.rs", "").len(), 1);
}

#[test]
fn an_import_of_a_structure_of_the_sinumerik_is_found() {
    let found = sinumerik_image("src/trace/x.rs", "//! X.\nuse crate::image::{\n    Kind, ToNck,\n};\n");
    assert_eq!(found.len(), 1);
    assert!(found[0].starts_with("src/trace/x.rs:2: `ToNck` is of the SINUMERIK"), "{found:?}");
    assert_eq!(sinumerik_image("src/trace/x.rs", "let part = crate::image::Part::ToNck;").len(), 0);
    assert_eq!(sinumerik_image("src/trace/x.rs", "fn f(x: &crate::image::ToNck) {}").len(), 1);
}

#[test]
fn an_unused_allowance_is_found() {
    let file = |path: &str, text: &str| Text { path: path.to_owned(), text: text.to_owned() };
    let files =
        [file("src/plc/x.rs", "use crate::units::Time;\n"), file("src/plant/x.rs", "use crate::image::Kind;\n")];
    assert!(unused("plc", &["units"], &files).is_empty());
    assert_eq!(
        unused("plc", &["image", "units"], &files),
        ["src/plc/: never imports image: remove it from the row in both tables".to_owned()]
    );
}

#[test]
fn a_different_table_in_the_docs_is_found() {
    let docs = "//! | [`plc`] | the program | `image`, `units` |\n//! | [`units`] | units | nothing |";
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
fn rejected_words_are_found_and_longer_names_are_not() {
    let refused = |text: &str| refused("src/x.rs", text, REFUSED_INSIDE);
    assert_eq!(
        refused("let now = Instant::now();"),
        ["src/x.rs:1: `Instant` is not allowed: use `opennck::units::Time`; a step must not read a clock".to_owned()]
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
fn an_unchecked_block_is_found_in_other_files_and_without_its_reason() {
    let block = "fn f() {\n    \x75nsafe { g() }\n}";
    let found = |path, text| unchecked(path, text).len();
    assert_eq!(
        unchecked("src/x.rs", block),
        [format!("src/x.rs:2: only {UNSAFE} may contain code that the compiler does not check")]
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
    assert!(length("src/module/tests.rs", &format!("{code}fn g() {{}}\n")).is_none());
}

#[test]
fn an_unpaired_file_is_found() {
    let paths = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    assert_eq!(unpaired(&paths(&["golden/a/b.toml", "golden/a/b.snap", "golden/a/b.828d.snap"])).len(), 0);
    assert_eq!(unpaired(&paths(&["golden/a/b.toml", "golden/a/b@x=1.0.snap", "golden/a/parts/c.toml"])).len(), 0);
    assert_eq!(unpaired(&paths(&["golden/a/b@x=1.0.snap"])).len(), 1);
    assert_eq!(unpaired(&paths(&["golden/a/b.toml"])).len(), 1);
    assert_eq!(unpaired(&paths(&["golden/a/b.snap"])).len(), 1);
    assert_eq!(pending(&paths(&["a/b.snap.new", "a/.c.rs.pending-snap", "a/b.snap"])).len(), 2);
}
