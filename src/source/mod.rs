//! Where it stands: files with their lines, and problems that say where, what was expected, what came and what to do.
//!
//! Every reader of a file in this project (machine data, `plant.toml`, PLC images, scenarios) reports with
//! [`Problem`], so that a person meets one form of message. TOML files are read into a tree of [`Node`]s in
//! which each value knows its place; merged files keep the places of both.

mod node;

pub use node::{Node, Table, Value};

use std::fmt;
use std::sync::Arc;

/// A line of a file.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// The file as the user named it.
    pub file: Arc<str>,
    /// The line, from one; 0 where the whole file is meant.
    pub line: u32,
}

impl Place {
    /// A whole file.
    #[must_use]
    pub fn file(file: &str) -> Self {
        Self { file: file.into(), line: 0 }
    }

    /// Another line of the same file.
    #[must_use]
    pub fn at_line(&self, line: u32) -> Self {
        Self { file: Arc::clone(&self.file), line }
    }

    /// A problem here.
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

/// Unusable input: one line of cause (what was expected and what came), one line of cure.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub struct Problem {
    /// Where, if it is in a file.
    pub place: Option<Place>,
    /// What was expected and what came.
    pub what: String,
    /// What to do about it; may be empty.
    pub cure: String,
}

impl Problem {
    /// A problem that is not in a file.
    #[must_use]
    pub fn new(what: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { place: None, what: what.into(), cure: cure.into() }
    }

    /// The same problem, at this place unless it already has one.
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

/// The known name nearest to a misspelt one, if one is near enough to be meant.
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let allowed = (name.chars().count() / 3).max(2);
    known
        .into_iter()
        .map(|candidate| (strsim::damerau_levenshtein(name, candidate), candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// `did you mean …?`, or the fallback where nothing is near.
#[must_use]
pub fn did_you_mean<'a>(name: &str, known: impl IntoIterator<Item = &'a str>, fallback: &str) -> String {
    nearest(name, known).map_or_else(|| fallback.to_owned(), |near| format!("did you mean `{near}`?"))
}

/// Reads a text file; a byte order mark is dropped, bytes that are not UTF-8 are taken as Latin-1, as controls write them.
///
/// # Errors
/// The file cannot be read; the problem names it and says why.
pub fn read_text(path: &std::path::Path) -> Result<String, Problem> {
    let bytes = std::fs::read(path).map_err(|error| unreadable(path, &error))?;
    Ok(decode(&bytes))
}

/// The text of a file: without its byte order mark; bytes that are not UTF-8 are taken as Latin-1.
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
pub fn unreadable(path: &std::path::Path, error: &std::io::Error) -> Problem {
    Place::file(&path.display().to_string())
        .problem(format!("cannot be read: {error}"), "check the path and the permissions")
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
    fn a_misspelt_name_finds_its_neighbour_and_a_foreign_one_does_not() {
        let known = ["controller_enable", "pulse_enable"];
        assert_eq!(nearest("controler_enable", known), Some("controller_enable"));
        assert_eq!(nearest("spindle", known), None);
    }
}
