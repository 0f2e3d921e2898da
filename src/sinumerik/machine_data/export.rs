//! Which text files a control exported. In such a file, data outside of the catalogue are data that the control knows (O-30); in a file
//! that a person wrote, they are perhaps mistyped.
//!
//! The header (`%_N_INITIAL_INI`, `CHANDATA(1)`) is no sign: the examples of this project have it, and people copy them. A control exports
//! all its data, so its file is long and has many data outside of the catalogue, or it has checksums of its lines.

use std::collections::BTreeMap;
use std::path::Path;

use super::catalogue::by_identifier;
use super::reading::{Author, Line};

/// So many assignments nobody writes.
const ALL_ASSIGNMENTS: usize = 1_000;

/// So many names nobody mistypes in one file.
const UNKNOWN_NAMES: usize = 100;

/// What the lines of a file have.
#[derive(Default)]
struct Counts {
    assignments: usize,
    unknown: usize,
    has_checksums: bool,
}

/// Marks the lines of the text files that a control exported.
pub(super) fn mark(lines: &mut [Line]) {
    let mut files = BTreeMap::<usize, Counts>::new();
    for line in lines.iter().filter(|line| line.author == Author::Person) {
        let counts = files.entry(line.file).or_default();
        counts.assignments += 1;
        counts.unknown += usize::from(!is_in_catalogue(&line.name));
        counts.has_checksums |= line.has_checksum;
    }
    for line in lines.iter_mut().filter(|line| line.author == Author::Person) {
        let is_arc = Path::new(&*line.place.file).extension().is_some_and(|name| name.eq_ignore_ascii_case("arc"));
        let is_export = files.get(&line.file).is_some_and(|counts| {
            counts.has_checksums || counts.assignments >= ALL_ASSIGNMENTS || counts.unknown >= UNKNOWN_NAMES
        });
        if is_arc || is_export {
            line.author = Author::Export;
        }
    }
}

fn is_in_catalogue(name: &str) -> bool {
    name.starts_with('$') && name.split('[').next().is_some_and(|name| by_identifier(name.trim()).is_some())
}
