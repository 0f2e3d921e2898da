//! What happens at a time of the scenario, whatever its steps do then: `[[at]]`.
//!
//! An entry is a step with a verb that acts at once, and a `time`. Its commands act in the first cycle that begins at or after this time,
//! before the commands of a step. Campaigns put faults and changes into a scenario in this way without a change of its steps.

use std::sync::Arc;

use super::duration::Duration;
use super::failure::Failure;
use super::fields::duration;
use super::passing::{Book, Progress};
use super::steps::{Action, Reader};
use crate::machine::Machine;
use crate::source::{Node, Place, Problem, Table, Value};

/// The entries that are still to come.
#[derive(Clone, Debug, Default)]
pub(super) struct Timed {
    events: Arc<[Event]>,
    /// The indices of those that have not acted yet, in the order of the file.
    pending: Vec<usize>,
}

#[derive(Debug)]
struct Event {
    time: Duration,
    place: Place,
    note: Option<Box<str>>,
    action: Action,
}

/// Reads `[[at]]`; names and values are looked up when the scenario is prepared for a machine.
pub(super) fn written(node: Option<Node>) -> Result<Vec<Table>, Problem> {
    let Some(node) = node else {
        return Ok(Vec::new());
    };
    if !matches!(node.value, Value::Array(_)) {
        return Err(node.expected("a list of what happens at a time", "write [[at]] with two brackets"));
    }
    node.into_list().into_iter().map(|entry| entry.into_table("an entry of [[at]]")).collect()
}

impl Timed {
    /// Looks up the entries with the reader of the steps, which has read them all.
    pub(super) fn read(entries: &[Table], reader: &mut Reader<'_>) -> Result<Self, Problem> {
        let events: Vec<Event> = entries.iter().map(|entry| event(entry.clone(), reader)).collect::<Result<_, _>>()?;
        Ok(Self { pending: (0..events.len()).collect(), events: events.into() })
    }

    /// Queues the commands of the entries whose time has come. The caller steps the machine next.
    pub(super) fn go_on(
        &mut self,
        book: &mut Book,
        machine: &mut Machine,
        note: &mut dyn FnMut(&Machine, &str),
    ) -> Result<(), Failure> {
        if self.pending.is_empty() {
            return Ok(());
        }
        let (cycles, time) = (machine.cycle() - book.start.0, book.time(machine));
        let has_come = |duration: Duration| match duration {
            Duration::Time(from) => time >= from,
            Duration::Cycles(from) => cycles >= from,
        };
        for event in self.pending.extract_if(.., |index| has_come(self.events[*index].time)) {
            let Event { place, note: text, action, .. } = &self.events[event];
            if let Some(text) = text {
                note(machine, text);
            }
            book.go_on(action, &mut Progress::new(machine), machine).map_err(|failure| failure.at(place))?;
        }
        Ok(())
    }

    /// The lines of entries whose time did not come.
    pub(super) fn remarks(&self) -> impl Iterator<Item = String> {
        self.pending.iter().map(|index| {
            let place = &self.events[*index].place;
            format!("{place}: [[at]] did not happen: the scenario ended before its time")
        })
    }
}

fn event(mut entry: Table, reader: &mut Reader<'_>) -> Result<Event, Problem> {
    const EXAMPLE: &str =
        "write time = \"3.2s\" and a verb that acts at once: fault = { axis = \"XF\", kind = \"block\" }";
    let place = entry.place.clone();
    let time =
        entry.take("time").ok_or_else(|| place.problem("expected the key `time` in [[at]], found none", EXAMPLE))?;
    let time = duration(&time, "a time since the start of the scenario")?;
    let note = entry.take("note").map(|node| node.text("a note").map(Box::from)).transpose()?;
    let action = reader.step(entry, place.clone(), None)?.action;
    if action.commands(reader.machine.cycle_time()).is_none() {
        return Err(place.problem("expected a verb that acts at once, found one that takes time or judges", EXAMPLE));
    }
    Ok(Event { time, place, note, action })
}
