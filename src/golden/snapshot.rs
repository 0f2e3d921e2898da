//! `.snap` files in the format of insta: a header between two lines of `---`, then the body.
//!
//! Bodies are compared as in insta: Windows line ends are equal to Unix line ends, and white space at the end and empty lines at the
//! beginning are ignored.

use std::path::{Path, PathBuf};

use crate::source::{Place, Problem, read_text, replace};

/// A golden file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    /// The lines between the two `---`. They are kept unchanged when the body is rewritten.
    pub header: String,
    /// The text that is compared.
    pub body: String,
}

impl Snapshot {
    /// A new golden file for a scenario.
    #[must_use]
    pub fn new(title: &str, body: String) -> Self {
        let title = serde_json::Value::from(title);
        Self { header: format!("source: opennck\ndescription: {title}\n"), body }
    }

    /// Reads a golden file.
    ///
    /// # Errors
    /// The file cannot be read, or has no header.
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let text = read_text(path)?.replace("\r\n", "\n");
        let parts = text.strip_prefix("---\n").and_then(|rest| match rest.strip_prefix("---\n") {
            Some(body) => Some(("", body)),
            None => rest.split_once("\n---\n").or_else(|| rest.strip_suffix("\n---").map(|head| (head, ""))),
        });
        let Some((header, body)) = parts else {
            return Err(Place::file(&path.display().to_string()).at_line(1).problem(
                "expected a header between two lines of ---, found none",
                "write the file with `opennck test --accept`",
            ));
        };
        let header = if header.is_empty() { String::new() } else { format!("{header}\n") };
        Ok(Self { header, body: body.to_owned() })
    }

    /// Writes the golden file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Problem> {
        replace(path, &self.to_string())
    }
}

impl std::fmt::Display for Snapshot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "---\n{}---\n{}\n", self.header, self.body.trim_end())
    }
}

/// The normalized form of a body, which comparisons use.
#[must_use]
pub fn normalized(body: &str) -> String {
    body.trim_end().replace("\r\n", "\n").trim_start_matches(['\r', '\n']).to_owned()
}

/// The path of the file for review beside a golden file: `name.snap.new`.
#[must_use]
pub fn pending(snap: &Path) -> PathBuf {
    let mut name = snap.as_os_str().to_owned();
    name.push(".new");
    name.into()
}
