//! Records the commands to a machine as a scenario that repeats them: the reverse of `steps.rs`.
//!
//! The caller that steps the machine calls [`Transcript::edge`] before each step. The queued commands become steps in their order, and
//! the cycles between them become `run`. If the scenario runs from power on with the same PLC program and image, it has the same trace,
//! byte for byte. Consecutive writes share one table, unless the table already contains the place. `write` is used for a bit of the NCK,
//! `set` for everything else.

use std::fmt::Write;

use super::generators::generator_text;
use super::naming::missing_owner;
use super::searches::search_word;
use crate::image::{Address, Format, Location, Profile, Writer, is_no_code};
use crate::machine::{Command, DatumValue, Fault, Machine};
use crate::scenario::faults::written;
use crate::source::{Table, Value as SourceValue};
use crate::units::{AxisNumber, ChannelNumber};

/// The limit of simulated time, because the final length of a transcript is not known.
const LIMIT: &str = "8760h";

/// The head of a transcript, above the steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Heading<'a> {
    /// What the transcript shows.
    pub title: &'a str,
    /// The machine, relative to the file.
    pub machine: &'a str,
    /// The profile, which selects the numbers of the interface blocks.
    pub profile: Profile,
    /// The PLC program.
    pub plc: Option<&'a str>,
    /// The PLC image: a path relative to the file.
    pub plc_image: Option<&'a str>,
    /// What the trace shows, each with the step of a value.
    pub watch: Option<&'a [(String, Option<f64>)]>,
    /// Data that are merged into the plant.
    pub plant: Option<&'a Table>,
    /// Machine data that are stored before the first power on.
    pub machine_data: &'a [(String, DatumValue)],
}

/// A comment about the commands that follow it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Remark {
    /// The number of commands before it.
    pub before: usize,
    /// The text, which becomes a comment in the scenario.
    pub text: String,
}

/// A scenario that grows while a machine runs.
#[derive(Clone, Debug)]
pub struct Transcript {
    text: String,
    /// The cycle up to which time has been written.
    written: u64,
    /// Notes for the next step.
    notes: Vec<String>,
    /// The table of the step that is still open for entries.
    open: Option<Open>,
    /// A step has the programs in memory.
    has_programs: bool,
}

/// A step whose table can take more entries.
#[derive(Clone, Debug)]
struct Open {
    verb: &'static str,
    entries: Vec<(String, String)>,
}

impl Transcript {
    /// Starts a transcript before the first step of a machine.
    #[must_use]
    pub fn begin(heading: &Heading<'_>) -> Self {
        let mut text = format!("title = {}\nmachine = {}\n", quoted(heading.title), quoted(heading.machine));
        if heading.profile != Profile::default() {
            text += &format!("profile = {}\n", quoted(heading.profile.name()));
        }
        for (key, value) in [("plc", heading.plc), ("plc_image", heading.plc_image)] {
            if let Some(value) = value {
                text += &format!("{key} = {}\n", quoted(value));
            }
        }
        text += &format!("limit = {}\n", quoted(LIMIT));
        if let Some(watch) = heading.watch {
            let entry = |(name, step): &(String, Option<f64>)| match step {
                Some(step) => format!("{{ value = {}, step = {step:?} }}", quoted(name)),
                None => quoted(name),
            };
            let entries: Vec<_> = watch.iter().map(entry).collect();
            text += &format!("watch = [{}]\n", entries.join(", "));
        }
        if let Some(plant) = heading.plant {
            text += &format!("plant = {}\n", toml(&SourceValue::Table(plant.clone())));
        }
        if !heading.machine_data.is_empty() {
            let data = heading.machine_data.iter();
            let data: Vec<_> = data.map(|(target, value)| format!("{} = {}", quoted(target), datum(value))).collect();
            text += &format!("machine_data = {{ {} }}\n", data.join(", "));
        }
        Self { text, written: 0, notes: Vec::new(), open: None, has_programs: false }
    }

    /// Adds a note, as the trace of the machine does at the end of its next step.
    pub fn note(&mut self, text: &str) {
        self.notes.push(text.to_owned());
    }

    /// Records the commands that the machine executes at the edge of its next step; `remarks` are in order.
    pub fn edge(&mut self, machine: &Machine, remarks: &[Remark]) {
        let commands = machine.queued();
        if commands.is_empty() && self.notes.is_empty() {
            return;
        }
        self.time(machine.cycle());
        let mut remarks = remarks.iter().peekable();
        for (index, command) in commands.iter().enumerate() {
            // A remark without a command of its own is at the same position as the next one; the last one counts.
            let said = std::iter::from_fn(|| remarks.next_if(|remark| remark.before <= index)).last();
            if let Some(remark) = said {
                self.close();
                let time = machine.time() + machine.cycle_time();
                let _ = write!(self.text, "\n# {time} s: {}", remark.text);
            }
            self.command(command, machine);
        }
        self.close();
        while !self.notes.is_empty() {
            self.step("set", "{}");
        }
    }

    /// The text since the last call.
    #[must_use]
    pub fn take_text(&mut self) -> String {
        std::mem::take(&mut self.text)
    }

    /// The step that runs from the last written cycle to the end of a cycle. Append it to end the scenario there.
    #[must_use]
    pub fn rest(&self, cycle: u64) -> String {
        run(cycle.saturating_sub(self.written).max(1))
    }

    /// Lets time pass up to the end of a cycle.
    fn time(&mut self, cycle: u64) {
        if cycle > self.written {
            self.text += &run(cycle - self.written);
            self.written = cycle;
        }
    }

    fn command(&mut self, command: &Command, machine: &Machine) {
        match command {
            Command::Write { location, value } => {
                // `set` refuses both: a client may write bytes of axes and channels that do not exist.
                let is_of_the_nck = machine.names().writer(*location) == Some(Writer::Nck);
                let is_of_nobody = missing_owner(machine, *location).is_some();
                let (key, value) = entry(*location, *value, machine);
                self.put(if is_of_the_nck || is_of_nobody { "write" } else { "set" }, key, value);
            }
            Command::Force { location, value } => {
                let (key, value) = entry(*location, *value, machine);
                self.put("force", key, value);
            }
            Command::Release { location } => self.step("release", &format!("[{}]", place(*location, machine))),
            Command::MachineDatum { target, value } => {
                self.put("machine_data", quoted(target), datum(value));
            }
            Command::RParameter { channel, number, value } => {
                let key = match channel.number() {
                    1 => format!("R{number}"),
                    channel => format!("R{number}[CHAN{channel}]"),
                };
                self.put("r_parameters", quoted(&key), format!("{value:?}"));
            }
            Command::SelectProgram { channel, path } => {
                // The programs in memory do not change; those that it can call are with the first one.
                let text = machine.program_text(path, !std::mem::replace(&mut self.has_programs, true));
                match text {
                    Some(text) => self.program("nc", *channel, &in_lines(&text)),
                    None => self.program("program", *channel, &quoted(path)),
                }
            }
            Command::EnterBlocks { channel, text } => self.program("mdi", *channel, &in_lines(text)),
            Command::Preset { axis, value } => {
                let name = machine.names().axes[*axis].as_deref().unwrap_or_default();
                self.put("preset", quoted(name), format!("{value:?}"));
            }
            Command::FunctionGenerator(wanted) => {
                let text = generator_text(wanted, machine);
                self.step("function_generator", &text);
            }
            Command::Search { channel, block, kind } => {
                let kind = search_word(*kind);
                self.program("search", *channel, &format!("{{ block = {}, kind = \"{kind}\" }}", quoted(block)));
            }
            Command::NewConf => self.step("new_conf", "true"),
            Command::PowerOn => self.step("power_on", "true"),
            Command::PlcStop => self.step("plc", "\"stop\""),
            Command::PlcRun => self.step("plc", "\"run\""),
            Command::PlcColdRestart => self.step("plc", "\"cold\""),
            Command::Cancel => self.step("cancel", "true"),
            Command::Handwheel { number, pulses, cycles } => {
                let turn = format!("{{ number = {number}, pulses = {pulses}, over = \"{cycles}cycles\" }}");
                self.step("handwheel", &turn);
            }
            Command::Fault(fault) => self.step("fault", &broken(*fault, machine)),
            Command::ClearFault(fault) => self.step("clear_fault", &broken(*fault, machine)),
        }
    }

    /// Writes a step that names a program or blocks.
    fn program(&mut self, verb: &str, channel: ChannelNumber, value: &str) {
        let channel = if channel == ChannelNumber::FIRST { String::new() } else { format!("\nchannel = {channel}") };
        self.step(verb, &format!("{value}{channel}"));
    }

    /// Writes a step with one value.
    fn step(&mut self, verb: &str, value: &str) {
        self.close();
        self.text += "\n[[step]]\n";
        if !self.notes.is_empty() {
            let note = self.notes.remove(0);
            self.text += &format!("note = {}\n", quoted(&note));
        }
        self.text += &format!("{verb} = {value}\n");
    }

    /// Adds an entry to the table of a step. The previous step is extended if it has the same verb and not this entry.
    fn put(&mut self, verb: &'static str, key: String, value: String) {
        let goes_on = |open: &Open| open.verb == verb && open.entries.iter().all(|(other, _)| *other != key);
        if !self.open.as_ref().is_some_and(goes_on) {
            self.close();
            self.open = Some(Open { verb, entries: Vec::new() });
        }
        if let Some(open) = &mut self.open {
            open.entries.push((key, value));
        }
    }

    /// Writes the open table, which then takes no more entries.
    fn close(&mut self) {
        let Some(Open { verb, entries }) = self.open.take() else {
            return;
        };
        let entries: Vec<_> = entries.iter().map(|(key, value)| format!("{key} = {value}")).collect();
        self.step(verb, &format!("{{ {} }}", entries.join(", ")));
    }
}

fn run(cycles: u64) -> String {
    format!("\n[[step]]\nrun = \"{cycles}cycles\"\n")
}

/// The value of a machine datum in a scenario.
fn datum(value: &DatumValue) -> String {
    match value {
        DatumValue::Boolean(value) => value.to_string(),
        DatumValue::Integer(number) => number.to_string(),
        DatumValue::Real(number) => format!("{number:?}"),
        DatumValue::Text(text) => quoted(text),
    }
}

/// A location and its value in the form of `set`: the symbol if one exists, or a plain number if only that gives the same bits.
fn entry(location: Location, raw: u64, machine: &Machine) -> (String, String) {
    let plain = Address { format: Some(Format::Unsigned), ..machine.names().address(location) };
    let usual = [place_text(location, machine), plain.to_string()];
    let said = usual.iter().find_map(|name| {
        let found = machine.names().resolve(machine.memory(), name).ok()?;
        let raw = raw & location.mask();
        if is_no_code(name, raw.cast_signed(), location, machine.override_coding()) {
            // A client may write any bits.
            return Some((quoted(name), quoted(&format!("16#{raw:X}"))));
        }
        let number = (Location { format: location.format, ..found } == location).then(|| number(raw, found));
        Some((quoted(name), number??))
    });
    said.unwrap_or_else(|| (quoted(&plain.to_string()), (raw & location.mask()).to_string()))
}

/// A number in the format of its location; `None` if the bits are not a finite number.
#[expect(
    clippy::cast_possible_truncation,
    reason = "a REAL has 32 bits; a value that does not convert back is rejected"
)]
fn number(raw: u64, location: Location) -> Option<String> {
    match location.format {
        Format::Unsigned => Some(raw.to_string()),
        Format::Signed => {
            let unused = 64 - u32::from(location.width);
            Some(((raw << unused).cast_signed() >> unused).to_string())
        }
        Format::Real => {
            let real = f32::from_bits(raw as u32);
            let text = format!("{real:?}");
            let comes_back = text.parse::<f64>().is_ok_and(|number| (number as f32).to_bits() == real.to_bits());
            (real.is_finite() && comes_back).then_some(text)
        }
    }
}

/// The symbol of a location, or its address.
fn place_text(location: Location, machine: &Machine) -> String {
    let names = machine.names();
    names.symbol(location).unwrap_or_else(|| names.address(location).to_string())
}

fn place(location: Location, machine: &Machine) -> String {
    quoted(&place_text(location, machine))
}

fn broken(Fault { axis, kind }: Fault, machine: &Machine) -> String {
    let (kind, more) = written(kind);
    format!("{{ axis = {}, kind = \"{kind}\"{more} }}", axis_name(axis, machine))
}

fn axis_name(axis: AxisNumber, machine: &Machine) -> String {
    quoted(machine.names().axes[axis].as_deref().unwrap_or_default())
}

/// A value as TOML in one line.
fn toml(value: &SourceValue) -> String {
    match value {
        SourceValue::Text(text) => quoted(text),
        SourceValue::Integer(number) => number.to_string(),
        SourceValue::Float(number) => format!("{number:?}"),
        SourceValue::Boolean(value) => value.to_string(),
        SourceValue::Array(nodes) => {
            let nodes: Vec<_> = nodes.iter().map(|node| toml(&node.value)).collect();
            format!("[{}]", nodes.join(", "))
        }
        SourceValue::Table(table) => {
            let entries = table.clone().take_rest();
            let entries: Vec<_> =
                entries.iter().map(|(key, _, node)| format!("{} = {}", quoted(key), toml(&node.value))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

/// A text of several lines as a TOML string: as it is, if it can stand so.
fn in_lines(text: &str) -> String {
    let is_plain = |letter: char| !letter.is_control() || matches!(letter, '\n' | '\t');
    if text.contains('\n') && !text.contains("'''") && text.chars().all(is_plain) {
        format!("'''\n{text}'''")
    } else {
        quoted(text)
    }
}

/// A text as a TOML string.
fn quoted(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' => quoted.extend(['\\', letter]),
            '\n' => quoted += "\\n",
            _ if letter.is_control() => {
                let _ = write!(quoted, "\\u{:04X}", u32::from(letter));
            }
            _ => quoted.push(letter),
        }
    }
    quoted.push('"');
    quoted
}

#[cfg(test)]
mod tests;
