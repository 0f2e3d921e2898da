//! `--watch`: runs cases again when one of their files has changed. Files are compared by time and length, twice a second: that needs no
//! service of the system, and works on network drives.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::Metadata;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

use super::arguments::Arguments;
use super::select::found;
use super::suite::once;
use super::work::Work;
use crate::cli::output::Output;
use crate::plc::Programs;

/// How often the files are compared.
const EVERY: Duration = Duration::from_millis(500);

/// The state of a file.
type State = (Option<SystemTime>, u64);

/// Runs cases again, until the output is closed or the process is ended.
pub(super) fn again(arguments: &Arguments, programs: &Programs, output: &mut Output) -> u8 {
    let mut known = states(arguments);
    output.line(format!("\nwatching {} files; press Ctrl-C to stop", known.len()));
    while !output.is_closed() {
        sleep(EVERY);
        let new = states(arguments);
        let changed: BTreeSet<PathBuf> =
            known.keys().chain(new.keys()).filter(|path| known.get(*path) != new.get(*path)).cloned().collect();
        if changed.is_empty() {
            continue;
        }
        for path in &changed {
            output.line(format!("\nchanged: {}", path.display()));
        }
        match found(arguments) {
            Ok(mut found) => {
                found.work.retain(|work| {
                    work.inputs().iter().any(|input| changed.iter().any(|path| path.starts_with(input)))
                });
                once(&found, None, arguments, programs, output);
            }
            Err(problem) => output.error(problem),
        }
        // What changed during the run counts as the next change. An accepted golden file does, too: its case then passes, and rests.
        known = new;
    }
    0
}

/// All files of the selected cases with their states.
fn states(arguments: &Arguments) -> BTreeMap<PathBuf, State> {
    let inputs: BTreeSet<PathBuf> =
        found(arguments).map_or_else(|_| BTreeSet::new(), |found| found.work.iter().flat_map(Work::inputs).collect());
    let mut states = BTreeMap::new();
    for input in inputs {
        collect(&input, &mut states);
    }
    states
}

/// A file, or the files in a folder; a machine has no folders below its own.
fn collect(path: &Path, states: &mut BTreeMap<PathBuf, State>) {
    let Ok(data) = std::fs::metadata(path) else { return };
    if data.is_file() {
        states.insert(path.to_owned(), state(&data));
        return;
    }
    for entry in std::fs::read_dir(path).into_iter().flatten().flatten() {
        if let Ok(data) = entry.metadata()
            && data.is_file()
        {
            states.insert(entry.path(), state(&data));
        }
    }
}

fn state(data: &Metadata) -> State {
    (data.modified().ok(), data.len())
}
