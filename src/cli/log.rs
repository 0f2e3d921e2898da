//! The log of `opennck serve` on standard error, one event per line: clients, refused requests, alarms and, on request, writes.

#![expect(clippy::disallowed_methods, reason = "each line starts with the time of day")]

use std::fmt::{Debug, Write};
use std::time::{SystemTime, UNIX_EPOCH};

use indicatif::ProgressBar;
use tracing::field::{Field, Visit};
use tracing::span::{Attributes, Id, Record};
use tracing::{Event, Level, Metadata, Subscriber};

/// Prints the events of this crate above the status line.
#[derive(Debug)]
pub(super) struct Log {
    pub(super) status: ProgressBar,
    /// Whether writes of clients are logged as well.
    pub(super) writes: bool,
}

impl Subscriber for Log {
    fn enabled(&self, metadata: &Metadata<'_>) -> bool {
        let finest = if self.writes { Level::DEBUG } else { Level::INFO };
        *metadata.level() <= finest && metadata.target().starts_with(env!("CARGO_CRATE_NAME"))
    }

    fn event(&self, event: &Event<'_>) {
        let mut line = Line(String::new());
        event.record(&mut line);
        let seconds = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default().as_secs() % 86_400;
        let (hour, minute, second) = (seconds / 3600, seconds / 60 % 60, seconds % 60);
        let text = format!("{hour:02}:{minute:02}:{second:02} {}\n", line.0);
        self.status.suspend(|| {
            // If standard error cannot be written, there is no other place to report it.
            let _ = std::io::Write::write_all(&mut std::io::stderr().lock(), text.as_bytes());
        });
    }

    fn new_span(&self, _: &Attributes<'_>) -> Id {
        Id::from_u64(1) // spans are not used
    }

    fn record(&self, _: &Id, _: &Record<'_>) {}

    fn record_follows_from(&self, _: &Id, _: &Id) {}

    fn enter(&self, _: &Id) {}

    fn exit(&self, _: &Id) {}
}

/// The message of an event.
struct Line(String);

impl Visit for Line {
    fn record_debug(&mut self, field: &Field, value: &dyn Debug) {
        if field.name() == "message" {
            let _ = write!(self.0, "{value:?}");
        }
    }
}
