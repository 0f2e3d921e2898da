//! `.snap` files in insta's format: a header between two lines of `---`, then the body.
//!
//! Bodies compare as insta compares them: line ends of Windows count as line ends, white space at the very end and
//! empty lines at the very beginning do not count.

use std::path::{Path, PathBuf};

use crate::source::{Place, Problem, read_text, unreadable};

/// A golden file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Snapshot {
    /// The lines between the two `---`; kept as they are when the body is rewritten.
    pub header: String,
    /// What is compared.
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
    /// It cannot be read, or has no header.
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
    /// It cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), Problem> {
        std::fs::write(path, self.to_string()).map_err(|error| unreadable(path, &error))
    }
}

impl std::fmt::Display for Snapshot {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "---\n{}---\n{}\n", self.header, self.body.trim_end())
    }
}

/// A body as it is compared.
#[must_use]
pub fn normalized(body: &str) -> String {
    body.trim_end().replace("\r\n", "\n").trim_start_matches(['\r', '\n']).to_owned()
}

/// The file that waits for review beside a golden file: `name.snap.new`.
#[must_use]
pub fn pending(snap: &Path) -> PathBuf {
    let mut name = snap.as_os_str().to_owned();
    name.push(".new");
    name.into()
}
