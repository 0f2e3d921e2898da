//! The trace by signal: one row per signal, with its value at the start and its changes.
//!
//! Waveform files and timing diagrams are made from these rows.

use std::collections::BTreeMap;

use super::calendar::Calendar;
use super::happened::HappeningLine;
use super::history::ValueRow;
use super::lines::LineKind;
use super::printable::{Printable, order, printable, shown};
use super::{By, Shown, Trace, Watch};
use crate::image::Location;
use crate::units::Time;
use crate::variables::{AxisValue, Describe, NamedValue, place_name};

/// All rows of a trace, in the order of owners and addresses.
#[derive(Clone, Debug)]
pub(super) struct Waves {
    pub(super) calendar: Calendar,
    /// The first and the last cycle that are shown, since the start of the trace.
    pub(super) first: u64,
    pub(super) last: u64,
    pub(super) rows: Vec<Wave>,
    /// The notes and happenings, with their cycles.
    pub(super) notes: Vec<(u64, String)>,
}

/// One row.
#[derive(Clone, Debug)]
pub(super) struct Wave {
    /// The owner; `memory` for an item without an owner.
    pub(super) owner: String,
    /// The name below the owner.
    pub(super) name: String,
    /// The address; for an alarm, its text; for a value, its unit.
    pub(super) beside: String,
    pub(super) kind: WaveKind,
    /// Whether it is shown although it never changes.
    pub(super) is_watched: bool,
    pub(super) start: Level,
    pub(super) changes: Vec<Step>,
}

/// The kind of a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WaveKind {
    Bit,
    /// A number without sign, with this number of bits.
    Number(u8),
    /// A number with sign, or a REAL.
    Real,
    /// A value that is not a signal.
    Value,
    Alarm,
}

/// The content of a row at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Level {
    Signal(Shown),
    /// In millionths.
    Value(i64),
}

impl Level {
    /// Whether a bit is 1 or an alarm is pending.
    pub(super) fn is_high(self) -> bool {
        self == Self::Signal(Shown::Bit(true))
    }
}

/// A change.
#[derive(Clone, Debug)]
pub(super) struct Step {
    /// The cycle since the start of the trace.
    pub(super) cycle: u64,
    pub(super) level: Level,
    /// The writer; values have none.
    pub(super) by: Option<By>,
    pub(super) because: Option<String>,
}

/// Owner, then signals, values, alarms; then the address, or the number of the alarm.
type Key = (usize, u8, super::printable::Order, String);

const MEMORY: &str = "memory";

/// The rows under construction, and the order of the owners.
struct Rows {
    owners: Vec<String>,
    rows: BTreeMap<Key, Wave>,
}

impl Rows {
    fn rank(&self, owner: &str) -> usize {
        self.owners.iter().position(|known| known == owner).unwrap_or(usize::MAX)
    }

    /// The row of a signal; a new row has this value at the start.
    fn signal(&mut self, symbol: Option<&str>, address: &str, location: Location, start: Shown) -> &mut Wave {
        let (owner, name) = symbol.and_then(|symbol| symbol.split_once('.')).unwrap_or((MEMORY, address));
        let kind = match start {
            Shown::Bit(_) => WaveKind::Bit,
            Shown::Unsigned(_) => WaveKind::Number(location.width),
            Shown::Number(_) => WaveKind::Real,
        };
        self.rows.entry((self.rank(owner), 0, order(address), address.to_owned())).or_insert_with(|| Wave {
            owner: owner.to_owned(),
            name: name.to_owned(),
            beside: if symbol.is_some() { address.to_owned() } else { String::new() },
            kind,
            is_watched: false,
            start: Level::Signal(start),
            changes: Vec::new(),
        })
    }

    /// The row of a signal that is shown although it never changes.
    fn watched(&mut self, printable: &Printable, start: Shown) {
        let Printable { symbol, address, location, .. } = printable;
        self.signal(symbol.as_deref(), address, *location, start).is_watched = true;
    }
}

impl Trace {
    /// One row for each selected signal, value and alarm.
    pub(super) fn waves(&self, describe: &dyn Describe, watch: &Watch) -> Waves {
        let names = describe.names();
        let owners = names.owners().map(|(name, ..)| name.to_owned()).collect();
        let mut rows = Rows { owners, rows: BTreeMap::new() };
        for &location in watch.locations() {
            let printable = printable(names, location);
            rows.watched(&printable, shown(&self.start, location));
        }
        for printable in watch.unchanged(names) {
            rows.watched(&printable, shown(&self.start, printable.location));
        }
        let mut notes = Vec::new();
        for line in self.lines(describe, watch) {
            let cycle = self.calendar.cycle(line.time);
            match line.kind {
                LineKind::Note(text) => notes.push((cycle, text)),
                LineKind::Happening(happening) => {
                    let HappeningLine { what, place, change, .. } = happening;
                    notes.push((cycle, format!("{place}: {what} {change}")));
                }
                LineKind::Text(name, _, new) => notes.push((cycle, format!("{name} = {new}"))),
                LineKind::Value(..) => {}
                LineKind::Signal(signal) => {
                    let wave = rows.signal(signal.symbol.as_deref(), &signal.address, signal.location, signal.old);
                    let level = Level::Signal(signal.new);
                    wave.changes.push(Step { cycle, level, by: Some(signal.by), because: signal.because });
                }
                LineKind::Alarm(alarm) => {
                    let number = alarm.name.parse().unwrap_or(u32::MAX);
                    let key = (rows.rank(&alarm.place), 2, (0, number, 0, 0), alarm.name.clone() + &alarm.text);
                    let wave = rows.rows.entry(key).or_insert_with(|| Wave {
                        owner: alarm.place,
                        name: format!("alarm {}", alarm.name),
                        beside: alarm.text,
                        kind: WaveKind::Alarm,
                        is_watched: false,
                        start: Level::Signal(Shown::Bit(!alarm.raised)),
                        changes: Vec::new(),
                    });
                    let level = Level::Signal(Shown::Bit(alarm.raised));
                    wave.changes.push(Step { cycle, level, by: Some(By::Nck), because: alarm.because });
                }
            }
        }
        for (index, watched) in self.watched.iter().enumerate() {
            let mut changes = self.values.iter().filter(|row| row.index == index);
            let Some(first) = changes.next() else {
                continue;
            };
            // Texts are among the notes.
            let Some(start) = first.new.in_millionths() else { continue };
            let owner = place_name(watched.value.place(), names);
            let (name, unit, order) = described(watched.value, describe);
            let key = (rows.rank(&owner), 1, order, String::new());
            let step = |row: &ValueRow| Step {
                cycle: row.cycle.saturating_sub(self.first_cycle),
                level: Level::Value(row.new.in_millionths().unwrap_or(0)),
                by: None,
                because: None,
            };
            let wave = Wave {
                owner,
                name,
                beside: unit.to_owned(),
                kind: WaveKind::Value,
                is_watched: true,
                start: Level::Value(start),
                changes: changes.map(step).collect(),
            };
            rows.rows.insert(key, wave);
        }
        Waves {
            calendar: self.calendar.clone(),
            first: 0,
            last: self.last_cycle.saturating_sub(self.first_cycle),
            rows: rows.rows.into_values().collect(),
            notes,
        }
    }
}

/// The name of a value below its owner, its unit, and its order.
pub(super) fn described(value: NamedValue, describe: &dyn Describe) -> (String, &'static str, super::printable::Order) {
    match value {
        NamedValue::Axis(axis, value) => {
            let interface = describe.names().interface();
            let unit = match (value, describe.is_rotary(axis)) {
                (AxisValue::Velocity, false) => "mm/min",
                (AxisValue::Velocity, true) => interface.values().rotary_velocity,
                (_, false) => "mm",
                (_, true) => "\u{b0}",
            };
            (value.name(interface).to_owned(), unit, (value as u8, 0, 0, 0))
        }
        NamedValue::Block(_) => ("block".to_owned(), "", (0, 0, 0, 0)),
        NamedValue::Program(_) => ("program".to_owned(), "", (1, 0, 0, 0)),
        NamedValue::RParameter(_, number) => (format!("R{number}"), "", (2, number.into(), 0, 0)),
    }
}

impl Waves {
    /// The time at the end of a cycle.
    pub(super) fn time(&self, cycle: u64) -> Time {
        self.calendar.time(cycle)
    }
}
