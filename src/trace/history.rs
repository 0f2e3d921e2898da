//! The trace of a running machine: rows of the recorder, events, notes and watched values.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::bits::Bits;
use super::calendar::Calendar;
use super::measured::Measured;
use super::record::by_in_words;
use super::value::Recorded;
use super::watch::WatchedItem;
use super::{By, Change, Recorder, Row, Watch};
use crate::image::{Location, Memory, Part, PartBytes};
use crate::units::Time;
use crate::variables::{Event, EventId, Happening, NamedValue, RuleNumber, Variables};

/// The rows about the PLC program after which those of words that change all the time are thinned out.
const PROGRAM_ROWS: usize = 200_000;

/// A trace that grows while a machine runs.
#[derive(Clone, Debug)]
pub struct Trace {
    /// The memory before the first row.
    pub(super) start: Memory,
    pub(super) first_cycle: u64,
    /// The times of the cycles since then.
    pub(super) calendar: Calendar,
    /// The time of the machine at the first cycle.
    first_time: Time,
    /// The changed bytes.
    pub(super) bits: Vec<Bits>,
    /// All other rows: alarms, happenings, overwritten bits, commands without effect.
    pub(super) others: Vec<Row>,
    pub(super) events: Vec<Event>,
    pub(super) notes: Vec<(u64, String)>,
    pub(super) watched: Vec<WatchedValue>,
    pub(super) values: Vec<ValueRow>,
    /// Why the PLC program changed bits, in the order of cycles.
    pub(super) programs: Vec<ProgramRow>,
    /// The number of them at which some are forgotten.
    room_for_programs: usize,
    /// The symbols of the PLC program by addresses.
    symbols: Arc<BTreeMap<String, String>>,
    /// The texts of watched values.
    pub(super) texts: Vec<Box<str>>,
    /// What a check of causes needs in addition, if it was asked for.
    pub(super) measured: Option<Box<Measured>>,
    pub(super) lost: u64,
    /// The last recorded cycle.
    pub(super) last_cycle: u64,
}

/// A value that is recorded in every cycle in which it changes.
#[derive(Clone, Copy, Debug)]
pub(super) struct WatchedValue {
    pub(super) value: NamedValue,
    /// The last value, as displayed.
    pub(super) last: Option<Recorded>,
    /// How far it must have moved for another row, in its own unit.
    pub(super) step: f64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct ValueRow {
    pub(super) cycle: u64,
    pub(super) index: usize,
    pub(super) old: Option<Recorded>,
    pub(super) new: Recorded,
}

/// Why the PLC program changed bits.
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramRow {
    /// The cycle.
    pub cycle: u64,
    /// The part of the memory.
    pub part: Part,
    /// The address of the first bit in the part.
    pub bit: u32,
    /// The number of bits.
    pub bits: u32,
    /// The new value of a single bit.
    pub value: bool,
    /// The statement that wrote them.
    pub statement: Arc<str>,
    /// The operands that were tested or read, with their raw values.
    pub tested: Vec<(Location, u64)>,
    /// Operations whose operands are no part of the memory, with their places, and what they tested.
    pub operations: Vec<(Arc<str>, bool)>,
}

impl Trace {
    /// An empty trace. It begins with this memory after cycle `cycle` at this time of the machine, which is time zero.
    #[must_use]
    pub fn begin(memory: &Memory, cycle_time: Time, cycle: u64, time: Time) -> Self {
        Self {
            start: memory.clone(),
            first_cycle: cycle,
            calendar: Calendar::new(cycle_time),
            first_time: time,
            bits: Vec::new(),
            others: Vec::new(),
            events: Vec::new(),
            notes: Vec::new(),
            watched: Vec::new(),
            values: Vec::new(),
            programs: Vec::new(),
            room_for_programs: PROGRAM_ROWS,
            symbols: Arc::default(),
            texts: Vec::new(),
            measured: None,
            lost: 0,
            last_cycle: cycle,
        }
    }

    /// An empty trace that follows this one, with its symbols and its last events, to which later changes refer.
    #[must_use]
    pub fn continued(&self, memory: &Memory, cycle_time: Time, cycle: u64, time: Time) -> Self {
        /// More than a control keeps itself.
        const LAST: usize = 1024;
        let mut next = Self::begin(memory, cycle_time, cycle, time);
        next.events.extend_from_slice(&self.events[self.events.len().saturating_sub(LAST)..]);
        next.name_program(&self.symbols);
        next
    }

    /// Areas and data blocks that a program brought before the first cycle.
    pub fn remember(&mut self, memory: &Memory) {
        if self.bits.is_empty() {
            self.start = memory.clone();
        }
    }

    /// Names the bits, timers and counters in causes of the PLC program by its symbols.
    pub fn name_program(&mut self, symbols: &Arc<BTreeMap<String, String>>) {
        self.symbols = Arc::clone(symbols);
    }

    /// `"Key clamp" (I0.5)`, or the address alone.
    pub(super) fn program_name(&self, address: &str) -> String {
        self.symbols.get(address).map_or_else(|| address.to_owned(), |symbol| format!("\"{symbol}\" ({address})"))
    }

    /// Takes over why the PLC program changed bits in a cycle.
    pub fn extend_causes(&mut self, cycle: u64, causes: impl IntoIterator<Item = ProgramRow>) {
        self.programs.extend(causes.into_iter().map(|cause| ProgramRow { cycle, ..cause }));
        if self.programs.len() > self.room_for_programs {
            self.thin();
        }
    }

    /// Forgets the older half of the words of flags and data blocks, of which some change in every scan.
    fn thin(&mut self) {
        let is_word = |row: &ProgramRow| row.bits > 1 && matches!(row.part, Part::Flags | Part::Block(_));
        let mut left = self.programs.iter().filter(|row| is_word(row)).count() / 2;
        self.programs.retain(|row| {
            let goes = left > 0 && is_word(row);
            left -= usize::from(goes);
            !goes
        });
        self.room_for_programs = self.programs.len() + PROGRAM_ROWS;
    }

    /// Why the PLC program changed these bits in a cycle to a value, and the number of this cause in the trace.
    pub(super) fn program_cause(&self, location: Location, new: u64, cycle: u64) -> Option<(u32, &ProgramRow)> {
        let first = self.programs.partition_point(|row| row.cycle < cycle);
        let end = self.programs.partition_point(|row| row.cycle <= cycle);
        let from = u64::from(location.offset) * 8 + u64::from(location.bit);
        let to = from + u64::from(location.width);
        let is_meant = |row: &ProgramRow| {
            let begin = u64::from(row.bit);
            let overlaps = row.part == location.part && begin < to && from < begin + u64::from(row.bits);
            overlaps && (row.bits > 1 || location.width > 1 || row.value == (new != 0))
        };
        let index = first + self.programs[first..end].iter().rposition(is_meant)?;
        let number = u32::try_from(self.events.len() + index + 1).ok()?;
        Some((number, &self.programs[index]))
    }

    /// The cause of the PLC program with this number in the trace.
    pub(super) fn program_numbered(&self, number: u32) -> Option<&ProgramRow> {
        self.programs.get((number as usize).checked_sub(self.events.len() + 1)?)
    }

    /// Takes a note of why the PLC program stopped, if the recorder has that it stopped by itself.
    pub fn note_fault(&mut self, recorder: &Recorder, fault: Option<&str>) {
        let stopped = recorder
            .rows()
            .iter()
            .find(|row| matches!(row.change, Change::Happened { what: Happening::PlcStopped, by: By::Plc, .. }));
        if let (Some(row), Some(fault)) = (stopped, fault) {
            self.notes.push((row.cycle, fault.to_owned()));
        }
    }

    /// Records these values from now on, in every cycle in which they change.
    pub fn watch_values(&mut self, watch: &Watch, cycle: u64, variables: &Variables) {
        self.watched =
            watch.items().map(|WatchedItem { value, step }| WatchedValue { value, last: None, step }).collect();
        self.values.clear();
        self.note_values(cycle, variables);
    }

    /// Takes over the contents of the recorder.
    pub fn extend(&mut self, recorder: &Recorder) {
        for row in recorder.rows() {
            match row.change {
                Change::Byte { .. } => self.bits.extend(Bits::of(row)),
                Change::Alarm { .. } | Change::Happened { .. } | Change::Overwritten { .. } | Change::NoEffect(_) => {
                    self.others.push(*row);
                }
            }
        }
        self.events.extend_from_slice(recorder.new_events());
        self.lost = recorder.lost();
    }

    /// Records the time of the machine and the watched values after a cycle. Call it after each cycle.
    pub fn end_cycle(&mut self, cycle: u64, time: Time, variables: &Variables) {
        self.calendar.note(cycle.saturating_sub(self.first_cycle), time - self.first_time);
        self.note_values(cycle, variables);
    }

    /// Measures from now on, for [`Trace::check_causes`], the lengths and velocities that causes name, and `read`: the PLC's half as the
    /// control reads it, if it reads it later than it is written. Call it before the first cycle, and [`Trace::measure`] after each cycle.
    pub fn measure_causes(&mut self, variables: &Variables, read: Option<&PartBytes>) {
        self.measured = Some(Box::new(Measured::begin(self.events.len(), variables, read)));
    }

    /// Measures after a cycle, if [`Trace::measure_causes`] was called; its events must be in the trace.
    pub fn measure(&mut self, cycle: u64, variables: &Variables, read: Option<&PartBytes>) {
        if let Some(measured) = &mut self.measured {
            measured.measure(cycle, &self.events, variables, read);
        }
    }

    fn note_values(&mut self, cycle: u64, variables: &Variables) {
        self.last_cycle = self.last_cycle.max(cycle);
        for (index, watched) in self.watched.iter_mut().enumerate() {
            let new = Recorded::of(watched.value, watched.last, variables, &mut self.texts);
            if watched.last.is_none_or(|last| new.has_moved(last, watched.step)) {
                self.values.push(ValueRow { cycle, index, old: watched.last, new });
                watched.last = Some(new);
            }
        }
    }

    /// Adds a note that belongs to a cycle.
    pub fn note(&mut self, cycle: u64, text: impl Into<String>) {
        self.notes.push((cycle, text.into()));
    }

    /// The bytes of memory that its contents take.
    #[must_use]
    pub fn bytes(&self) -> usize {
        let notes: usize = self.notes.iter().map(|(_, text)| text.len() + size_of::<(u64, String)>()).sum();
        self.bits.len() * size_of::<Bits>()
            + self.others.len() * size_of::<Row>()
            + self.events.len() * size_of::<Event>()
            + self.values.len() * size_of::<ValueRow>()
            + self.programs.iter().map(|row| size_of_val(row) + size_of_val(&*row.tested)).sum::<usize>()
            + notes
    }

    /// The changes of each cycle that has any: its changed bits, and its other rows.
    pub(super) fn cycles(&self) -> impl Iterator<Item = (u64, &[Bits], &[Row])> {
        let (mut bits, mut others) = (&self.bits[..], &self.others[..]);
        std::iter::from_fn(move || {
            let next = [bits.first().map(|bits| bits.cycle), others.first().map(|row| row.cycle)];
            let cycle = next.into_iter().flatten().min()?;
            let of_bits = bits.iter().take_while(|bits| bits.cycle == cycle).count();
            let of_others = others.iter().take_while(|row| row.cycle == cycle).count();
            let found = (cycle, &bits[..of_bits], &others[..of_others]);
            (bits, others) = (&bits[of_bits..], &others[of_others..]);
            Some(found)
        })
    }

    /// The event that had this number at the end of a cycle; numbers can restart at power on.
    #[must_use]
    pub fn event(&self, id: EventId, cycle: u64) -> Option<&Event> {
        self.events.get(self.event_index(id, cycle)?)
    }

    pub(super) fn event_index(&self, id: EventId, cycle: u64) -> Option<usize> {
        let so_far = self.events.partition_point(|event| event.cycle <= cycle);
        if !id.is_some() {
            return None;
        }
        self.events[..so_far].iter().rposition(|event| event.id == id)
    }

    /// The number of an event in this trace, where numbers never restart: from one; zero for none.
    pub(super) fn event_number(&self, id: EventId, cycle: u64) -> u32 {
        self.event_index(id, cycle).map_or(0, |index| u32::try_from(index + 1).unwrap_or(0))
    }

    /// The event with this number in this trace.
    pub(super) fn event_numbered(&self, number: u32) -> Option<&Event> {
        self.events.get((number as usize).checked_sub(1)?)
    }

    /// The last change of a location, with its time and its writer in words; `None` if it never changed.
    #[must_use]
    pub fn last_change(&self, location: Location) -> Option<(Time, &'static str)> {
        let bits = self.last_edge(location, u64::MAX)?;
        Some((self.time(bits.cycle), by_in_words(bits.by)))
    }

    /// The rule behind the last edge of a location up to a cycle; `None` if it had no edge, or one without a cause.
    #[must_use]
    pub fn last_rule(&self, location: Location, cycle: u64) -> Option<RuleNumber> {
        let bits = self.last_edge(location, cycle)?;
        self.event(bits.cause, bits.cycle).map(|event| event.rule)
    }

    /// The lowest bits of a location that changed in the last cycle that changed it, up to the given one: writer and cause of its line.
    fn last_edge(&self, location: Location, cycle: u64) -> Option<&Bits> {
        let so_far = &self.bits[..self.bits.partition_point(|bits| bits.cycle <= cycle)];
        let mut cycles = so_far.chunk_by(|one, next| one.cycle == next.cycle).rev();
        cycles.find_map(|of_cycle| of_cycle.iter().find(|bits| bits.changed(location) != 0))
    }

    /// The number of rows that the recorder lost because it was not drained.
    #[must_use]
    pub fn lost(&self) -> u64 {
        self.lost
    }

    /// The time at the end of a cycle.
    pub(super) fn time(&self, cycle: u64) -> Time {
        self.calendar.time(cycle.saturating_sub(self.first_cycle))
    }
}
