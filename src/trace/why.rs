//! Why a signal has its value: from an edge through the events of the control back to the signals that were written from outside it.
//!
//! The same code works on a trace in memory and on a trace from JSON lines; both become a [`Story`].

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use serde_json::Value;

use super::causes::{Cause, CauseInput};
use super::misplaced::value_as_signal;
use super::printable::is_bit;
use super::record::by_in_words;
use super::{Line, LineKind, Trace, Watch};
use crate::image::{Format, Location, Part};
use crate::source::{Problem, did_you_mean};
use crate::units::Time;
use crate::variables::Describe;

/// The changes of a trace and the events that caused them.
#[derive(Clone, Debug, Default)]
pub struct Story {
    edges: Vec<Edge>,
    causes: Vec<Cause>,
}

/// A change of a signal or an alarm, or a happening.
#[derive(Clone, Debug, PartialEq)]
struct Edge {
    time: Time,
    /// The symbol, or the address if there is no symbol; `alarm(10654)` for an alarm; `fault drive_fault`, `MD37110` for a happening.
    name: String,
    /// The address, or the place of an alarm or a happening.
    address: String,
    /// The kind of a happening: `power_on`, `fault_set`.
    happened: Option<String>,
    /// The new value, such as `1` or `raised`.
    new: String,
    /// `0 -> 1`, `raised`.
    change: String,
    by: String,
    /// The cause as text.
    because: Option<String>,
    /// The number of the event; zero for none.
    event: u32,
}

impl Trace {
    /// The chain of causes of the last edge of a location at or before a time: each event of the control with its rule and inputs, and each
    /// input back to its own last edge, until a write of PLC, plant or scenario.
    ///
    /// # Errors
    /// The location has no edge up to this time.
    pub fn why(&self, location: Location, time: Time, describe: &dyn Describe) -> Result<String, Problem> {
        self.story(describe).why(&describe.names().address(location).to_string(), time)
    }

    /// The bytes and words that the PLC program wrote and read.
    fn words(&self) -> BTreeSet<Location> {
        let written = self.programs.iter().filter(|row| row.bits > 1).filter_map(|row| {
            let (offset, width) = (row.bit / 8, u8::try_from(row.bits).ok()?);
            Some(Location { part: row.part, offset, bit: 0, width, format: Format::Unsigned })
        });
        let read = self.programs.iter().flat_map(|row| row.tested.iter().map(|(location, _)| *location));
        let is_word = |location: &Location| {
            location.width > 1 && location.is_well_formed() && !matches!(location.part, Part::Timers | Part::Counters)
        };
        written.chain(read).filter(is_word).collect()
    }

    /// All changes, with the events that caused them.
    #[must_use]
    pub fn story(&self, describe: &dyn Describe) -> Story {
        let lines = self.lines(describe, &Watch::every_bit(self.words()));
        let numbers = 1..=u32::try_from(self.events.len() + self.programs.len()).unwrap_or(u32::MAX);
        Story {
            edges: lines.iter().filter_map(Edge::of).collect(),
            causes: numbers.filter_map(|number| self.cause(number, describe)).collect(),
        }
    }
}

impl Edge {
    fn of(line: &Line) -> Option<Self> {
        let time = line.time;
        match &line.kind {
            LineKind::Note(_) | LineKind::Value(..) | LineKind::Text(..) => None,
            LineKind::Happening(happening) => Some(Self {
                time,
                name: happening.what.split(" = ").next().unwrap_or_default().to_owned(),
                address: happening.place.clone(),
                happened: Some(happening.kind.to_owned()),
                new: happening.change.to_owned(),
                change: happening.change.to_owned(),
                by: by_in_words(happening.by).to_owned(),
                because: happening.because.clone(),
                event: happening.event,
            }),
            LineKind::Signal(signal) => Some(Self {
                time,
                name: signal.symbol.clone().unwrap_or_else(|| signal.address.clone()),
                address: signal.address.clone(),
                happened: None,
                new: signal.new.to_string(),
                change: format!("{} -> {}", signal.old, signal.new),
                by: by_in_words(signal.by).to_owned(),
                because: signal.because.clone(),
                event: signal.event,
            }),
            LineKind::Alarm(alarm) => {
                let state = if alarm.raised { "raised" } else { "cleared" };
                Some(Self {
                    time,
                    name: format!("alarm({})", alarm.name),
                    address: alarm.place.clone(),
                    happened: None,
                    new: state.to_owned(),
                    change: state.to_owned(),
                    by: "nck".to_owned(),
                    because: alarm.because.clone(),
                    event: alarm.event,
                })
            }
        }
    }
}

impl Edge {
    /// Whether it is a change of this name: a symbol or an address, `alarm(10654)`, or for a happening its name with or without its place
    /// (`fault drive_fault`, `MD37110[XF]`, `power`) or its kind (`power_on`).
    fn is_of(&self, what: &str) -> bool {
        match &self.happened {
            None => self.name == what || (self.address == what && !self.name.starts_with("alarm(")),
            Some(kind) => self.name == what || kind == what || self.name_with_place() == what,
        }
    }

    fn name_with_place(&self) -> String {
        if self.happened.is_some() { format!("{}[{}]", self.name, self.address) } else { self.name.clone() }
    }
}

impl Story {
    /// Reads JSON lines from `opennck run --trace`; lines of other kinds are ignored.
    ///
    /// # Errors
    /// A line is not a JSON object, or has no time.
    pub fn read(text: &str) -> Result<Self, (usize, Problem)> {
        let mut story = Self::default();
        let mut values = BTreeMap::new();
        for (index, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
            let wrong = |found: String| {
                let cure = "write the trace again with `opennck run SCENARIO --trace F.jsonl`";
                (index + 1, Problem::new(format!("expected one line of a trace, found {found}"), cure))
            };
            let value: Value = serde_json::from_str(line).map_err(|error| wrong(format!("invalid JSON: {error}")))?;
            let time = value.get("t").and_then(Value::as_f64).map(Time::from_seconds);
            let time = time.ok_or_else(|| wrong("a line without the time `t`".to_owned()))?;
            story.take(time, &value, &mut values);
        }
        story.edges.sort_by_key(|edge| edge.time);
        Ok(story)
    }

    /// Takes a line; `values` has the last value at each address.
    fn take(&mut self, time: Time, line: &Value, values: &mut BTreeMap<String, String>) {
        let text = |key: &str| line.get(key).and_then(Value::as_str).map(str::to_owned);
        let number = |key: &str| line.get(key).and_then(Value::as_u64).and_then(|n| u32::try_from(n).ok()).unwrap_or(0);
        let (because, event) = (text("because"), number("event"));
        if let Some(kind) = text("happened") {
            let object = ["fault", "machine_data", "handwheel"].into_iter().find_map(|key| line.get(key));
            let (name, change) = happening_of_kind(&kind, &plain(object));
            let (address, by) = (text("where").unwrap_or_default(), text("by").unwrap_or_default());
            let (new, change) = (change.to_owned(), change.to_owned());
            self.edges.push(Edge { time, name, address, happened: Some(kind), new, change, by, because, event });
            return;
        }
        if let Some(address) = text("signal") {
            let new = plain(line.get("value"));
            let old =
                values.insert(address.clone(), new.clone()).unwrap_or_else(|| match (new.as_str(), is_bit(&address)) {
                    ("1", true) => "0".to_owned(),
                    ("0", true) => "1".to_owned(),
                    _ => "?".to_owned(),
                });
            let change = format!("{old} -> {new}");
            let name = text("symbol").unwrap_or_else(|| address.clone());
            let by = text("by").unwrap_or_default();
            self.edges.push(Edge { time, name, address, happened: None, new, change, by, because, event });
        } else if let Some(alarm) = line.get("alarm") {
            let state = text("state").unwrap_or_default();
            let (name, address) = (format!("alarm({})", plain(Some(alarm))), text("where").unwrap_or_default());
            self.edges.push(Edge {
                time,
                name,
                address,
                happened: None,
                new: state.clone(),
                change: state,
                by: "nck".into(),
                because,
                event,
            });
        } else if event != 0 {
            let inputs = line.get("inputs").and_then(Value::as_array);
            self.causes.push(Cause {
                number: event,
                time,
                place: text("where").unwrap_or_default(),
                rule: text("rule").unwrap_or_default(),
                because: because.unwrap_or_default(),
                inputs: inputs.into_iter().flatten().filter_map(input).collect(),
                parent: number("parent"),
            });
        }
    }

    /// The chain of causes of the last edge of a signal (symbol or address), an alarm (`alarm(10654)`) or a happening (`power_on`,
    /// `fault drive_fault[XF]`, `MD37110[XF]`) at or before a time.
    ///
    /// # Errors
    /// There is no such edge, or the trace does not contain this name.
    pub fn why(&self, what: &str, time: Time) -> Result<String, Problem> {
        let mut all = self.edges.iter().enumerate().filter(|(_, edge)| edge.is_of(what)).peekable();
        let Some((_, first)) = all.peek() else {
            let signals = self.edges.iter().filter(|edge| edge.happened.is_none());
            let happened: Vec<_> =
                self.edges.iter().filter(|edge| edge.happened.is_some()).map(Edge::name_with_place).collect();
            let names = signals.flat_map(|edge| [edge.name.as_str(), edge.address.as_str()]);
            let names = names.chain(happened.iter().map(String::as_str));
            let fallback =
                "it did not change, or the trace does not watch it; write a symbol, an address or a happening";
            let problem = Problem::new(
                format!("expected a signal or a happening of the trace, found `{what}`"),
                did_you_mean(what, names, fallback),
            );
            return Err(value_as_signal(problem, what));
        };
        let first = first.time;
        let Some((index, _)) = all.take_while(|(_, edge)| edge.time <= time).last() else {
            return Err(Problem::new(
                format!("expected an edge of `{what}` at or before {time} s, found none"),
                format!("its first edge is at {first} s"),
            ));
        };
        Ok(Chain::new(self).from(index))
    }
}

/// Rows deeper than this have the indent of this depth, so that a long chain does not become wider and wider.
const DEEPEST: usize = 40;

/// The chain under construction; each edge and each cause is printed once.
struct Chain<'a> {
    story: &'a Story,
    /// The edges with a name or an address and a new value, in order of time.
    by_value: BTreeMap<(&'a str, &'a str), Vec<usize>>,
    by_number: BTreeMap<u32, &'a Cause>,
    text: String,
    edges: BTreeSet<usize>,
    causes: BTreeSet<u32>,
    /// The rows to follow, with their depths, the last one first. A chain can be too long for the stack of the thread.
    open: Vec<(Follow<'a>, usize)>,
}

/// What a row is about.
#[derive(Clone, Copy)]
enum Follow<'a> {
    Edge(usize),
    /// The number of an event, and the word before it.
    Cause(u32, &'static str),
    /// An input that was tested at a time.
    Input(&'a CauseInput, Time),
}

impl<'a> Chain<'a> {
    fn new(story: &'a Story) -> Self {
        let mut by_value: BTreeMap<_, Vec<usize>> = BTreeMap::new();
        for (index, edge) in story.edges.iter().enumerate().filter(|(_, edge)| edge.happened.is_none()) {
            by_value.entry((edge.address.as_str(), edge.new.as_str())).or_default().push(index);
            if edge.name != edge.address {
                by_value.entry((edge.name.as_str(), edge.new.as_str())).or_default().push(index);
            }
        }
        // Of two events with one number, the first counts.
        let by_number = story.causes.iter().rev().map(|cause| (cause.number, cause)).collect();
        let (edges, causes) = (BTreeSet::new(), BTreeSet::new());
        Self { story, by_value, by_number, text: String::new(), edges, causes, open: Vec::new() }
    }

    /// The text of the chain that ends with an edge.
    fn from(mut self, edge: usize) -> String {
        self.open.push((Follow::Edge(edge), 0));
        while let Some((follow, depth)) = self.open.pop() {
            match follow {
                Follow::Edge(index) => self.edge(index, depth),
                Follow::Cause(number, word) => self.cause(number, depth, word),
                Follow::Input(input, time) => self.input(input, time, depth),
            }
        }
        self.text
    }

    fn row(&mut self, time: Time, depth: usize, text: &str) {
        let indent = "  ".repeat(depth.min(DEEPEST));
        let _ = writeln!(self.text, "{time:>9}  {indent}{text}");
    }

    fn timeless_row(&mut self, depth: usize, text: &str) {
        let indent = "  ".repeat(depth.min(DEEPEST));
        let _ = writeln!(self.text, "{:>9}  {indent}{text}", "");
    }

    fn edge(&mut self, index: usize, depth: usize) {
        let edge = &self.story.edges[index];
        let address = if edge.address == edge.name { String::new() } else { format!(" ({})", edge.address) };
        let known = if self.edges.insert(index) { "" } else { ", see above" };
        self.row(edge.time, depth, &format!("{}{address}  {}  by {}{known}", edge.name, edge.change, edge.by));
        if !known.is_empty() {
            return;
        }
        match (edge.event, &edge.because) {
            (0, Some(because)) => {
                let text = format!("because {because}");
                self.row(edge.time, depth + 1, &text);
            }
            (0, None) if edge.by == "nck" => self.row(edge.time, depth + 1, "no known cause"),
            (0, None) => {}
            (event, _) => self.open.push((Follow::Cause(event, "because"), depth + 1)),
        }
    }

    fn cause(&mut self, number: u32, depth: usize, word: &'static str) {
        let Some(&cause) = self.by_number.get(&number) else {
            self.timeless_row(depth, &format!("{word} of an event that is not in the trace"));
            return;
        };
        let known = if self.causes.insert(number) { "" } else { ", see above" };
        self.row(cause.time, depth, &format!("{word} {}  [{}]{known}", cause.because, cause.place));
        if !known.is_empty() {
            return;
        }
        if cause.parent != 0 {
            // The parent of an event is printed below it and not inside it, so that the way back to the start is one straight line.
            self.open.push((Follow::Cause(cause.parent, "after"), depth));
        }
        let inputs = cause.inputs.iter().rev().map(|input| (Follow::Input(input, cause.time), depth + 1));
        self.open.extend(inputs);
    }

    /// Follows a signal or an alarm to its previous edge.
    fn input(&mut self, input: &CauseInput, time: Time, depth: usize) {
        if let CauseInput::Timer(name, status) = input {
            return self.timer(name, *status, time, depth);
        }
        let (name, new) = match input {
            CauseInput::Signal { address, value, .. } => (address.clone(), value.clone()),
            CauseInput::Alarm(name) => (format!("alarm({name})"), "raised".to_owned()),
            // Measured values and machine data are in the text of the event.
            CauseInput::Datum(..)
            | CauseInput::Value(..)
            | CauseInput::Fault(_)
            | CauseInput::Block(_)
            | CauseInput::Timer(..) => return,
        };
        let edges = self.by_value.get(&(name.as_str(), new.as_str())).map_or(&[][..], Vec::as_slice);
        let before = edges.partition_point(|index| self.story.edges[*index].time <= time);
        if let Some(&index) = before.checked_sub(1).and_then(|last| edges.get(last)) {
            self.open.push((Follow::Edge(index), depth));
        } else if let CauseInput::Signal { address, symbol, .. } = input {
            let name = symbol.as_ref().unwrap_or(address);
            let changes =
                self.by_value.range((address.as_str(), "")..).next().is_some_and(|((of, _), _)| of == address);
            let why = if changes { "from the start" } else { "without an edge in this trace" };
            let address = if name == address { String::new() } else { format!(" ({address})") };
            self.timeless_row(depth, &format!("{name}{address}  {new}  {why}"));
        }
    }
}

impl Chain<'_> {
    /// Follows a timer or a counter to the statement that started or changed it last.
    fn timer(&mut self, name: &str, status: u64, time: Time, depth: usize) {
        let of_name = self.by_value.range((name, "")..).take_while(|((of, _), _)| *of == name);
        let edges = of_name.flat_map(|(_, edges)| edges).copied();
        let last = edges.filter(|index| self.story.edges[*index].time <= time).max();
        match last {
            Some(index) => self.open.push((Follow::Edge(index), depth)),
            None => self.timeless_row(depth, &format!("{name}  {status}  without an edge in this trace")),
        }
    }
}

/// The name of a happening of this kind with this object, and its change, as in the rows of a trace.
fn happening_of_kind(kind: &str, object: &str) -> (String, &'static str) {
    let datum = || {
        // `37110[2,XF]` is MD37110[2] of XF, which is its place.
        let (number, inside) = object.split_once('[').unwrap_or((object, ""));
        let index = inside.split([',', ']']).next().filter(|index| index.parse::<u8>().is_ok());
        // As the control names them: 41000 to 43999 are setting data.
        let is_setting = number.parse().is_ok_and(|number: u32| (41_000..44_000).contains(&number));
        let kind = if is_setting { "SD" } else { "MD" };
        format!("{kind}{number}{}", index.map(|index| format!("[{index}]")).unwrap_or_default())
    };
    match kind {
        "power_on" => ("power".to_owned(), "on"),
        "set_machine_data_active" => ("set MD active".to_owned(), "pressed"),
        "cancel_key" => ("cancel key".to_owned(), "pressed"),
        "plc_stopped" => ("PLC".to_owned(), "stopped"),
        "plc_started" => ("PLC".to_owned(), "started"),
        "plc_cold_restart" => ("PLC".to_owned(), "cold restart"),
        "machine_datum_stored" => (datum(), "stored"),
        "machine_datum_active" => (datum(), "active"),
        "fault_set" => (format!("fault {object}"), "set"),
        "fault_cleared" => (format!("fault {object}"), "cleared"),
        "handwheel_turned" => (format!("handwheel {object}"), "turned"),
        other => (other.to_owned(), "happened"),
    }
}

fn input(input: &Value) -> Option<CauseInput> {
    let text = |key: &str| input.get(key).and_then(Value::as_str).map(str::to_owned);
    let value = input.get("value");
    if let Some(address) = text("signal") {
        let value = value.filter(|value| value.is_number())?.to_string();
        return Some(CauseInput::Signal { address, symbol: text("symbol"), value });
    }
    if let Some(name) = text("machine_data") {
        return Some(CauseInput::Datum(name, value.and_then(Value::as_f64).unwrap_or(f64::NAN)));
    }
    if let Some(alarm) = input.get("alarm") {
        return Some(CauseInput::Alarm(plain(Some(alarm))));
    }
    if let Some(fault) = text("fault") {
        return Some(CauseInput::Fault(fault));
    }
    if let Some(block) = text("block") {
        return Some(CauseInput::Block(block));
    }
    if let Some(timer) = text("timer") {
        return Some(CauseInput::Timer(timer, value.and_then(Value::as_u64).unwrap_or(0)));
    }
    text("symbol").map(|name| CauseInput::Value(name, plain(value)))
}

/// A number or a text, unquoted.
fn plain(value: Option<&Value>) -> String {
    match value {
        Some(Value::String(text)) => text.clone(),
        Some(value) => value.to_string(),
        None => String::new(),
    }
}
