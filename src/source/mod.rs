//! Source files: places with lines, and error messages that name the place, the expectation, the finding and the remedy.
//!
//! Every reader of a file in this project (machine data, `plant.toml`, PLC images, scenarios) reports with [`Problem`], so that all
//! messages have one form. TOML files are read into a tree of [`Node`]s in which each value knows its place; merged files keep the places
//! of both. Outputs are written with [`Replacement`]: a file is complete, or it is not changed.

mod encoding;
mod json;
mod node;
mod replacement;

pub use encoding::Wide;
pub use node::{Node, Table, Value};
pub use replacement::{Replacement, replace, target};

use std::borrow::Cow;
use std::fmt;
use std::fs::{File, Metadata};
use std::io::{self, ErrorKind, IsTerminal, Read};
use std::path::Path;
use std::sync::Arc;

/// The size of the largest input file, in MiB; traces may be larger.
pub const INPUT_MIB: u64 = 256;
/// The size of the largest trace that is read, in MiB.
pub const TRACE_MIB: u64 = 4096;

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The line, counted from one; 0 for the whole file.
    pub line: u32,
}

impl Place {
    /// The place of a whole file.
    #[must_use]
    pub fn file(file: &str) -> Self {
        Self { file: file.into(), line: 0 }
    }

    /// Another line of the same file.
    #[must_use]
    pub fn at_line(&self, line: u32) -> Self {
        Self { file: Arc::clone(&self.file), line }
    }

    /// A problem at this place.
    #[must_use]
    pub fn problem(&self, what: impl Into<String>, cure: impl Into<String>) -> Problem {
        Problem { place: Some(self.clone()), what: what.into(), cure: cure.into() }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 { write!(f, "{}", self.file) } else { write!(f, "{}:{}", self.file, self.line) }
    }
}

/// Invalid input: one line with the cause (what was expected and what was found), one line with the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problem {
    /// The place, if the input is a file.
    pub place: Option<Place>,
    /// What was expected and what was found.
    pub what: String,
    /// The remedy; may be empty.
    pub cure: String,
}

impl Problem {
    /// A problem outside a file.
    #[must_use]
    pub fn new(what: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { place: None, what: what.into(), cure: cure.into() }
    }

    /// The same problem with this place, unless it already has one.
    #[must_use]
    pub fn at(mut self, place: &Place) -> Self {
        self.place.get_or_insert_with(|| place.clone());
        self
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(place) = &self.place {
            write!(f, "{place}: ")?;
        }
        f.write_str(&self.what)?;
        if !self.cure.is_empty() {
            write!(f, "\n  {}", self.cure)?;
        }
        Ok(())
    }
}

/// The known name that is nearest to a misspelt name, if one is near enough: by the number of wrong letters, or because the name is its
/// beginning, as `pos` is the beginning of `position`.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    // Two wrong letters of three leave nothing of a name.
    let length = name.chars().count();
    let allowed = (length / 3).max(2).min(length / 2).max(1);
    let mut misspelt: Option<(usize, &str)> = None;
    let mut shortened: Option<&str> = None;
    for candidate in known {
        let distance = strsim::damerau_levenshtein(name, candidate);
        if distance <= allowed && misspelt.is_none_or(|(least, _)| distance < least) {
            misspelt = Some((distance, candidate));
        }
        let is_beginning = name.len() >= SHORTENED && candidate.starts_with(name);
        if is_beginning && shortened.is_none_or(|other| candidate.len() < other.len()) {
            shortened = Some(candidate);
        }
    }
    // Almost every name of two or three letters is two wrong letters from another one.
    match misspelt {
        Some((distance, candidate)) if 2 * distance < name.chars().count() || shortened.is_none() => Some(candidate),
        Some(_) | None => shortened,
    }
}

/// The length from which a name counts as the beginning of a longer one.
const SHORTENED: usize = 2;

/// `did you mean …?`, or the fallback if no known name is near.
#[must_use]
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>, fallback: &str) -> String {
    nearest(name, known).map_or_else(|| fallback.to_owned(), |near| format!("did you mean `{near}`?"))
}

/// A text without characters that control a terminal, which texts from files may contain: each is shown by its code, as `\u{1b}`. Line
/// feeds and tabs stay.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    // The direction of the text after them can be reversed by the latter ones.
    let hidden = |c: char| {
        c.is_control() && !matches!(c, '\n' | '\t') || matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for letter in text.chars() {
        if hidden(letter) { shown.extend(letter.escape_unicode()) } else { shown.push(letter) }
    }
    Cow::Owned(shown)
}

/// Reads a text file of at most [`INPUT_MIB`] MiB. A byte order mark is removed; bytes that are not UTF-8 are read as Latin-1, which controls
/// write.
///
/// # Errors
/// The file cannot be read, is too large, or is a text in UTF-16 or UTF-32; the problem names the file and the reason.
pub fn read_text(path: &Path) -> Result<String, Problem> {
    let bytes = read_bytes(path, INPUT_MIB)?;
    match Wide::of(&bytes) {
        Some(wide) => {
            let file = path.display().to_string();
            let [what, cure] = wide.problem(&file, "a text in UTF-8 or Latin-1");
            Err(Place::file(&file).problem(what, cure))
        }
        None => Ok(decode(&bytes)),
    }
}

/// Reads a file of at most this many MiB. Pipes are read up to the same limit; devices are refused, because they may have no end.
///
/// # Errors
/// The file cannot be read, is a device or is too large; the problem names the file and the reason.
pub fn read_bytes(path: &Path, most_mib: u64) -> Result<Vec<u8>, Problem> {
    let failed = |error| unreadable(path, &error);
    let place = || Place::file(&path.display().to_string());
    let file = File::open(path).map_err(failed)?;
    let metadata = file.metadata().map_err(failed)?;
    if is_device(&metadata) && !file.is_terminal() {
        let what = "expected a file, found a device, which may have no end";
        return Err(place().problem(what, "name a file; `/dev/stdin` reads a pipe"));
    }
    let most = most_mib * 1024 * 1024;
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len().min(most)).unwrap_or(0));
    file.take(most + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > most {
        let what = format!("expected at most {most_mib} MiB, found more");
        let cure = "check the path; of a long trace, a shorter scenario or fewer signals in `watch` make a smaller one";
        return Err(place().problem(what, cure));
    }
    Ok(bytes)
}

#[cfg(unix)]
fn is_device(metadata: &Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    let kind = metadata.file_type();
    kind.is_char_device() || kind.is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: &Metadata) -> bool {
    false
}

/// The text of a file without its byte order mark; bytes that are not UTF-8 are read as Latin-1.
#[must_use]
pub fn decode(bytes: &[u8]) -> String {
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// The problem of a file that cannot be read.
#[must_use]
pub fn unreadable(path: &Path, error: &io::Error) -> Problem {
    let reason = reason(path, error);
    Place::file(&path.display().to_string())
        .problem(format!("cannot be read: {reason}"), "check the path and the permissions")
}

/// The problem of a file that cannot be written.
#[must_use]
pub fn unwritable(path: &Path, error: &io::Error) -> Problem {
    let reason = reason(path, error);
    Place::file(&path.display().to_string())
        .problem(format!("cannot be written: {reason}"), "check the path, the permissions and the disk")
}

/// An error of the system in words. Of a path through a file or through a missing folder, it names that one.
fn reason(path: &Path, error: &io::Error) -> String {
    let folders = || path.ancestors().skip(1).filter(|folder| !folder.as_os_str().is_empty());
    let named = match error.kind() {
        ErrorKind::NotADirectory if path.exists() => Some("it is neither a folder nor a plain file".to_owned()),
        ErrorKind::NotADirectory => {
            folders().find(|folder| folder.is_file()).map(|file| format!("{} is a file, not a folder", file.display()))
        }
        ErrorKind::NotFound => folders()
            .take_while(|folder| !folder.exists())
            .last()
            .map(|folder| format!("the folder {} does not exist", folder.display())),
        _ => None,
    };
    named.unwrap_or_else(|| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_prints_place_cause_and_cure() {
        let problem = Place::file("a.toml").at_line(7).problem("expected a number, found a string", "write 1.5");
        assert_eq!(problem.to_string(), "a.toml:7: expected a number, found a string\n  write 1.5");
    }

    #[test]
    fn a_path_through_a_file_or_a_missing_folder_names_it() {
        let folder = std::env::temp_dir().join(format!("opennck-paths-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("a.txt");
        std::fs::write(&file, "").unwrap();
        let told = |path: &Path| replace(path, "x").unwrap_err().what;
        let through = format!("cannot be written: {} is a file, not a folder", file.display());
        assert_eq!(told(&file.join("x.csv")), through);
        assert_eq!(told(&file.join("below/x.csv")), through);
        let missing = format!("cannot be written: the folder {} does not exist", folder.join("no").display());
        assert_eq!(told(&folder.join("no/such/x.csv")), missing);
        assert_eq!(read_text(&folder.join("no/x")).unwrap_err().what, missing.replace("written", "read"));
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn inputs_without_an_end_are_refused() {
        let device = read_text(Path::new("/dev/zero")).unwrap_err();
        assert_eq!(device.what, "expected a file, found a device, which may have no end");
        let folder = std::env::temp_dir().join(format!("opennck-large-{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let file = folder.join("a.toml");
        // One byte more than allowed, which takes no room on the disk.
        File::create(&file).unwrap().set_len(2 * 1024 * 1024 + 1).unwrap();
        assert_eq!(read_bytes(&file, 2).unwrap_err().what, "expected at most 2 MiB, found more");
        assert_eq!(read_bytes(&file, 3).unwrap().len(), 2 * 1024 * 1024 + 1);
        std::fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn a_text_for_a_terminal_has_no_characters_that_control_it() {
        assert_eq!(printable("a\tb\nc \u{e9} \u{b0}"), "a\tb\nc \u{e9} \u{b0}");
        assert_eq!(printable("\u{1b}[2J\r\u{9b}m\u{202e}\u{7f}"), "\\u{1b}[2J\\u{d}\\u{9b}m\\u{202e}\\u{7f}");
    }

    #[test]
    fn a_misspelt_name_gets_a_suggestion_and_an_unrelated_name_does_not() {
        let known = ["controller_enable", "pulse_enable"];
        assert_eq!(nearest("controler_enable", known), Some("controller_enable"));
        assert_eq!(nearest("spindle", known), None);
        assert_eq!(nearest("pulse", known), Some("pulse_enable"));
    }
}
