//! Golden files that belong to no case any more: their scenario was renamed or removed, or its matrix or its profiles have changed.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::real;
use super::snapshot::Snapshot;
use crate::source::{Problem, unreadable};

/// The golden files of this program that belong to no case: below the folders among the paths, and beside the files, those with the name of
/// the file. `files` are all scenario files at the paths, each with the golden files of its cases; `None` if it cannot be used, and then
/// nothing is known about its golden files.
///
/// # Errors
/// A folder cannot be read.
pub fn orphans(paths: &[PathBuf], files: &[(PathBuf, Option<Vec<PathBuf>>)]) -> Result<Vec<PathBuf>, Problem> {
    let mut found = BTreeSet::new();
    for path in paths {
        if path.is_dir() {
            collect(path, &mut BTreeSet::new(), &mut found)?;
        } else {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let beside = golden_files(folder.unwrap_or_else(|| Path::new(".")))?;
            found.extend(beside.into_iter().filter(|snap| is_of(snap, path)));
        }
    }
    let owned: BTreeSet<PathBuf> =
        files.iter().filter_map(|(_, snaps)| snaps.as_ref()).flatten().map(|snap| real(snap)).collect();
    let unusable: Vec<&PathBuf> = files.iter().filter(|(_, snaps)| snaps.is_none()).map(|(file, _)| file).collect();
    let is_orphan = |snap: &PathBuf| {
        let is_of_unusable = || unusable.iter().any(|file| is_of(snap, file));
        !owned.contains(&real(snap)) && !is_of_unusable() && is_own(snap)
    };
    Ok(found.into_iter().filter(is_orphan).collect())
}

/// Whether a golden file is one of a scenario file, by its name.
#[must_use]
pub fn is_of(snap: &Path, file: &Path) -> bool {
    scenario_of(snap).is_some_and(|owner| real(&owner) == real(file))
}

/// The scenario file beside a golden file that has its name: `a.toml` for `a.snap`, `a.828d.snap` and `a@1.snap`. Of several, the one with
/// the longest name.
fn scenario_of(snap: &Path) -> Option<PathBuf> {
    let name = snap.file_name()?.to_str()?;
    let ends = name.char_indices().filter(|(_, letter)| matches!(letter, '.' | '@'));
    let mut ends: Vec<usize> = ends.map(|(at, _)| at).collect();
    ends.reverse();
    ends.into_iter().map(|end| snap.with_file_name(format!("{}.toml", &name[..end]))).find(|file| file.is_file())
}

/// Whether this program wrote the file; snapshots of other tests have another source.
fn is_own(snap: &Path) -> bool {
    Snapshot::read(snap).is_ok_and(|snapshot| snapshot.header.lines().any(|line| line == "source: opennck"))
}

/// The files `*.snap` in a folder.
fn golden_files(folder: &Path) -> Result<Vec<PathBuf>, Problem> {
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    let entries = entries.map_err(|error| unreadable(folder, &error))?;
    let is_snap = |path: &PathBuf| path.is_file() && path.extension().is_some_and(|extension| extension == "snap");
    Ok(entries.iter().map(std::fs::DirEntry::path).filter(is_snap).collect())
}

/// A folder is read once, also if a link to it is below it.
fn collect(folder: &Path, read: &mut BTreeSet<PathBuf>, found: &mut BTreeSet<PathBuf>) -> Result<(), Problem> {
    if !read.insert(real(folder)) {
        return Ok(());
    }
    found.extend(golden_files(folder)?);
    let entries = std::fs::read_dir(folder).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    for entry in entries.map_err(|error| unreadable(folder, &error))? {
        if entry.path().is_dir() {
            collect(&entry.path(), read, found)?;
        }
    }
    Ok(())
}
