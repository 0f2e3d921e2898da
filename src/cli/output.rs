//! What the program prints: results on standard output, errors on standard error. A closed standard output is not an
//! error.

use std::fmt::Display;
#[cfg(feature = "s7")]
use std::fs::File;
use std::io::Write;
use std::path::Path;
#[cfg(feature = "s7")]
use std::path::PathBuf;

use crate::source::{Problem, printable};

/// Refuses to write an output to an input file of the same command, which would destroy the input.
pub(super) fn apart<'a>(option: &str, path: &Path, inputs: impl IntoIterator<Item = &'a Path>) -> Result<(), Problem> {
    let Ok(real) = path.canonicalize() else {
        return Ok(()); // the file does not exist yet
    };
    match inputs.into_iter().find(|input| input.canonicalize().is_ok_and(|input| input == real)) {
        Some(input) => Err(Problem::new(
            format!(
                "expected a separate file for {option}, found {}, which this command also reads or writes",
                input.display()
            ),
            "choose another file name",
        )),
        None => Ok(()),
    }
}

/// Standard output and standard error. A reader that has closed standard output is not an error.
#[derive(Debug, Default)]
pub(super) struct Output {
    /// The reader has closed standard output.
    closed: bool,
}

impl Output {
    /// Prints a text; characters from files that would control a terminal are shown by their codes.
    pub(super) fn print(&mut self, text: &str) {
        if !self.closed {
            let mut out = std::io::stdout().lock();
            self.closed = out.write_all(printable(text).as_bytes()).and_then(|()| out.flush()).is_err();
        }
    }

    /// Whether the reader has closed standard output.
    #[cfg(feature = "s7")]
    pub(super) fn is_closed(&self) -> bool {
        self.closed
    }

    /// Prints a line.
    pub(super) fn line(&mut self, text: impl Display) {
        self.print(&format!("{text}\n"));
    }

    /// Prints an error: the cause, then the remedy.
    #[expect(clippy::unused_self, reason = "all printing goes through the output")]
    pub(super) fn error(&mut self, error: impl Display) {
        let _ = writeln!(std::io::stderr().lock(), "error: {}", printable(&error.to_string()));
    }

    /// Prints a warning.
    #[expect(clippy::unused_self, reason = "all printing goes through the output")]
    pub(super) fn warning(&mut self, warning: impl Display) {
        let _ = writeln!(std::io::stderr().lock(), "warning: {}", printable(&warning.to_string()));
    }
}

/// A file that is written at the end of the command; until then it keeps its old content.
#[cfg(feature = "s7")]
pub(super) struct Kept {
    option: &'static str,
    path: PathBuf,
    file: File,
}

#[cfg(feature = "s7")]
impl Kept {
    /// Opens the file of an option, which must differ from the other files of the command.
    pub(super) fn open<'a>(
        option: &'static str,
        path: &Path,
        others: impl IntoIterator<Item = &'a Path>,
    ) -> Result<Self, Problem> {
        apart(option, path, others)?;
        let file = File::options().write(true).create(true).truncate(false).open(path);
        let file = file.map_err(|error| Self::cannot(option, path, &error))?;
        Ok(Self { option, path: path.to_owned(), file })
    }

    /// Replaces the content.
    pub(super) fn write(mut self, text: &str) -> Result<(), Problem> {
        let is_file = self.file.metadata().is_ok_and(|data| data.is_file());
        let emptied = if is_file { self.file.set_len(0) } else { Ok(()) };
        let written = emptied.and_then(|()| self.file.write_all(text.as_bytes()));
        written.map_err(|error| Self::cannot(self.option, &self.path, &error))
    }

    fn cannot(option: &str, path: &Path, error: &std::io::Error) -> Problem {
        Problem::new(
            format!("{option} {}: cannot be written: {error}", path.display()),
            "check the path, the permissions and the disk",
        )
    }
}
