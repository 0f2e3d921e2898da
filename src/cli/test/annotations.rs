//! `--format github`: each failure as an annotation of GitHub Actions, which a pull request shows beside the line.

use std::path::Path;

use super::work::Work;
use crate::golden::Outcome;

/// The command by which a job annotates a line: `::error file=…,line=…,title=…::message`.
pub(super) fn annotation(work: &Work, outcome: &Outcome) -> String {
    let text = outcome.to_string();
    let (file, line) = place(work, outcome, &text);
    let line = line.map_or_else(String::new, |line| format!(",line={line}"));
    format!("::error file={}{line},title={}::{}", property(&file), property(&work.name), message(&text))
}

/// The file that a reader has to open, and its line if there is one.
fn place(work: &Work, outcome: &Outcome, text: &str) -> (String, Option<u32>) {
    let scenario = || work.file.display().to_string();
    let (file, line) = match outcome {
        Outcome::Held | Outcome::Accepted | Outcome::Missing(_) | Outcome::Untrue(_) | Outcome::Differs(_) => {
            (scenario(), None)
        }
        // The text begins with the place: `FILE:LINE: …`.
        Outcome::Failed(_) | Outcome::Unusable(_) => match placed(text) {
            Some((file, line)) => (file.to_owned(), Some(line)),
            None => (scenario(), None),
        },
    };
    (below_the_repository(&file), line)
}

/// The file and line with which a message begins.
fn placed(text: &str) -> Option<(&str, u32)> {
    let first = text.lines().next()?;
    let (head, _) = first.split_once(": ")?;
    let (file, line) = head.rsplit_once(':')?;
    Some((file, line.parse().ok()?))
}

/// GitHub takes paths from the root of the repository, where jobs begin.
fn below_the_repository(file: &str) -> String {
    let root = std::env::var_os("GITHUB_WORKSPACE");
    let real = Path::new(file).canonicalize().ok();
    let below = real.zip(root).and_then(|(file, root)| {
        let root = Path::new(&root).canonicalize().ok()?;
        Some(file.strip_prefix(root).ok()?.display().to_string())
    });
    below.unwrap_or_else(|| file.to_owned())
}

/// A message: its special characters are escaped.
fn message(text: &str) -> String {
    text.replace('%', "%25").replace('\r', "%0D").replace('\n', "%0A")
}

/// A property: it ends at a comma, and its name at a colon.
fn property(text: &str) -> String {
    message(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_begins_with_its_place_or_has_none() {
        assert_eq!(placed("a/b.toml:12: expected X\n  more"), Some(("a/b.toml", 12)));
        assert_eq!(placed("C:\\a\\b.toml:12: expected X"), Some(("C:\\a\\b.toml", 12)));
        assert_eq!(placed("the trace differs: a"), None);
        assert_eq!(placed(""), None);
    }

    #[test]
    fn special_characters_are_escaped() {
        assert_eq!(message("50%\r\nb: c, d"), "50%25%0D%0Ab: c, d");
        assert_eq!(property("a [34080 = 1, plc = b]: c"), "a [34080 = 1%2C plc = b]%3A c");
    }
}
