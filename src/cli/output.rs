//! What the program prints: results on standard output, errors on standard error. A closed standard output is not an
//! error; one that cannot be written is.

use std::fmt::Display;
use std::io::{ErrorKind, Write};

use crate::source::printable;

/// Standard output and standard error. A reader that has closed standard output is not an error.
#[derive(Debug, Default)]
pub(super) struct Output {
    /// Nothing more is printed on standard output: its reader has closed it, or it cannot be written.
    closed: bool,
    /// Standard output could not be written.
    failed: bool,
}

impl Output {
    /// Prints a text; characters from files that would control a terminal are shown by their codes.
    pub(super) fn print(&mut self, text: &str) {
        if self.closed {
            return;
        }
        let mut out = std::io::stdout().lock();
        let printed = out.write_all(printable(text).as_bytes()).and_then(|()| out.flush());
        drop(out);
        self.note(printed);
    }

    /// Notes whether standard output could be written.
    pub(super) fn note(&mut self, printed: std::io::Result<()>) {
        if let Err(error) = printed {
            self.closed = true;
            if error.kind() != ErrorKind::BrokenPipe {
                self.failed = true;
                self.error(format!("standard output cannot be written: {error}\n  check the disk"));
            }
        }
    }

    /// The exit code of a command that ended with this code: 2 if a part of its output is missing.
    pub(super) fn code(&self, code: u8) -> u8 {
        if self.failed { 2 } else { code }
    }

    /// Whether nothing more is printed, so that a command that only prints can end.
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

    /// Prints what a person should know about a result.
    #[expect(clippy::unused_self, reason = "all printing goes through the output")]
    pub(super) fn remark(&mut self, remark: impl Display) {
        let _ = writeln!(std::io::stderr().lock(), "note: {}", printable(&remark.to_string()));
    }

    /// Prints a warning.
    #[expect(clippy::unused_self, reason = "all printing goes through the output")]
    pub(super) fn warning(&mut self, warning: impl Display) {
        let _ = writeln!(std::io::stderr().lock(), "warning: {}", printable(&warning.to_string()));
    }
}
