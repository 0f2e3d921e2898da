//! A part of a trace between two times, for waveforms and diagrams.

use super::waves::{WaveKind, Waves};
use crate::units::Time;

/// The part of a trace that a waveform or a diagram shows; the default is all of it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Window {
    /// Changes from this time on.
    pub from: Option<Time>,
    /// Changes up to this time.
    pub to: Option<Time>,
}

impl Waves {
    /// The rows in a window: each begins with its value before the window. What changes only outside it has no row, except what is watched
    /// and alarms that are pending.
    pub(super) fn within(mut self, window: Window) -> Self {
        if window == Window::default() {
            return self;
        }
        // The cycle that ends at `from` is the first one that is shown.
        let from = window.from.map_or(0, |from| self.calendar.cycle_from(from));
        let to = window.to.map_or(self.last, |to| self.calendar.cycle(to).min(self.last));
        self.first = from;
        self.last = to.max(from);
        for wave in &mut self.rows {
            let before = wave.changes.partition_point(|step| step.cycle < from);
            if let Some(step) = before.checked_sub(1).and_then(|index| wave.changes.get(index)) {
                wave.start = step.level;
            }
            wave.changes.truncate(wave.changes.partition_point(|step| step.cycle <= to));
            wave.changes.drain(..before.min(wave.changes.len()));
        }
        self.rows.retain(|wave| {
            let is_pending = wave.kind == WaveKind::Alarm && wave.start.is_high();
            wave.is_watched || is_pending || !wave.changes.is_empty()
        });
        self.notes.retain(|(cycle, _)| (from..=to).contains(cycle));
        self
    }
}
