//! The machine as JSON: its state after a step, and what happened in some steps.

use std::collections::BTreeMap;

use serde::Serialize;

use super::catalogue::Catalogue;
use crate::control::ChartPosition;
use crate::image::Part;
use crate::live::{Handle, Seen};
use crate::machine::Machine;
use crate::scenario::State;
use crate::trace::{By, Line, LineKind, Shown};
use crate::units::Time;
use crate::variables::{Describe, RaisedAlarm, axis_name, place_name};

/// The state of a machine, without its signals.
#[derive(Serialize)]
pub(super) struct Now {
    step: u64,
    cycle: u64,
    time: f64,
    speed: f64,
    paused: bool,
    held: bool,
    ended: bool,
    /// `run`, or why it is stopped.
    plc: String,
    overruns: u64,
    /// Position, setpoint, velocity, following error, synchronism difference, slide of each axis.
    axes: Vec<[f64; 6]>,
    alarms: Vec<Alarm>,
    positions: Vec<Position>,
    /// Inputs, outputs and flags as hexadecimal bytes.
    memory: [String; 3],
    scenario: Option<Scenario>,
    /// The first moment of the history: cycle and time. A text says why there is none.
    reach: Result<(u64, f64), String>,
}

#[derive(Serialize)]
struct Alarm {
    name: String,
    place: String,
    text: String,
    because: Option<String>,
    time: Option<f64>,
    cancelled_by: String,
    reaction: String,
}

/// Where a part is in a chart.
#[derive(Serialize)]
struct Position {
    chart: &'static str,
    axes: Vec<String>,
    phase: String,
    aim: String,
}

#[derive(Serialize)]
struct Scenario {
    index: usize,
    state: &'static str,
    failure: Option<String>,
}

/// Something that happened.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Edge {
    /// The time in seconds.
    pub(super) t: f64,
    /// The index of the signal in the catalogue.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(super) i: Option<usize>,
    /// What changed, if it is no signal of the catalogue: an address, an alarm, a note.
    #[serde(skip_serializing_if = "Option::is_none")]
    a: Option<String>,
    /// The new value of a signal; 1 and 0 for an alarm that is raised and cleared.
    #[serde(skip_serializing_if = "Option::is_none")]
    v: Option<f64>,
    /// Who wrote it.
    by: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    why: Option<String>,
    /// `alarm`, `note`, `event`; none for a signal.
    #[serde(skip_serializing_if = "Option::is_none")]
    kind: Option<&'static str>,
}

/// Who wrote a signal last.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Written(f64, &'static str, Option<String>);

/// What is known of the past: who wrote signals last.
#[derive(Debug, Default)]
pub(super) struct Past {
    pub(super) writers: BTreeMap<usize, Written>,
}

impl Past {
    /// Forgets what was after a time in seconds.
    pub(super) fn forget_after(&mut self, time: f64) {
        self.writers.retain(|_, written| written.0 <= time);
    }
}

fn writer(by: By) -> &'static str {
    match by {
        By::Nck => "nck",
        By::Plc => "plc",
        By::Outside => "outside",
        By::Force => "force",
        By::Plant => "plant",
        By::PowerOn => "power on",
    }
}

fn number(shown: &Shown) -> f64 {
    match shown {
        Shown::Bit(bit) => f64::from(u8::from(*bit)),
        #[expect(clippy::cast_precision_loss, reason = "a signal has at most 32 bits")]
        Shown::Unsigned(number) => *number as f64,
        Shown::Number(number) => *number,
    }
}

/// The value of each signal of the catalogue; 0 for a REAL that is no number, which JSON does not have.
pub(super) fn values(machine: &Machine, catalogue: &Catalogue) -> Vec<f64> {
    let value = |location| Some(machine.memory().value(location)).filter(|value: &f64| value.is_finite());
    catalogue.locations.iter().map(|location| value(*location).unwrap_or_default()).collect()
}

/// What happened, from the lines of a trace that begins at this time.
pub(super) fn edges(lines: Vec<Line>, begin: Time, catalogue: &Catalogue, past: &mut Past) -> Vec<Edge> {
    let mut edges = Vec::with_capacity(lines.len());
    for Line { time, kind } in lines {
        let t = (begin + time).seconds();
        let edge = Edge { t, i: None, a: None, v: None, by: "", why: None, kind: None };
        edges.push(match kind {
            LineKind::Signal(line) => {
                let (i, by, why) = (catalogue.index(line.location), writer(line.by), line.because);
                if let Some(index) = i {
                    past.writers.insert(index, Written(t, by, why.clone()));
                }
                let a = i.is_none().then_some(line.address);
                Edge { i, a, v: Some(number(&line.new)), by, why, ..edge }
            }
            LineKind::Alarm(line) => {
                let a = Some(format!("{} {}", line.name, line.text));
                let v = Some(f64::from(u8::from(line.raised)));
                Edge { a, v, by: "nck", why: line.because, kind: Some("alarm"), ..edge }
            }
            LineKind::Note(text) => Edge { a: Some(text), kind: Some("note"), ..edge },
            LineKind::Happening(line) => {
                let a = Some(format!("{} {} {}", line.what, line.place, line.change));
                Edge { a, by: writer(line.by), why: line.because, kind: Some("event"), ..edge }
            }
            LineKind::Value(..) | LineKind::Text(..) => continue,
        });
    }
    edges
}

impl Now {
    pub(super) fn of(seen: &Seen, live: &Handle) -> Self {
        let machine = seen.machine();
        let (names, variables) = (machine.names(), machine.variables());
        let axes = names.axes.iter().filter(|(_, name)| name.is_some()).map(|(axis, _)| {
            let of = &variables.axes[axis];
            let difference = of.synchronism_difference.user();
            [
                of.position.user(),
                of.setpoint.user(),
                of.velocity,
                of.following_error.user(),
                difference,
                of.slide.user(),
            ]
            .map(|value| if value.is_finite() { value } else { 0.0 })
        });
        let exists = |position: &ChartPosition| position.axes.iter().all(|axis| names.axes[*axis].is_some());
        let positions = machine.control().chart_positions().into_iter().filter(exists).map(|position| {
            let axes: Vec<_> = position.axes.iter().map(|axis| axis_name(*axis, names)).collect();
            let aim = format!("{}.{}", axes.first().map_or("", String::as_str), position.aim);
            Position { chart: position.chart, axes, phase: position.phase, aim }
        });
        let plc = match machine.plc_fault() {
            Some(fault) => fault.to_owned(),
            None if machine.is_plc_stopped() => "stopped".to_owned(),
            None => "run".to_owned(),
        };
        Self {
            step: seen.step(),
            cycle: machine.cycle(),
            time: machine.time().seconds(),
            speed: live.speed().ratio(),
            paused: live.is_paused(),
            held: live.is_held(),
            ended: live.has_ended(),
            plc,
            overruns: live.pace().overruns,
            axes: axes.collect(),
            alarms: variables.alarms.iter().map(|alarm| Alarm::of(alarm, seen)).collect(),
            positions: positions.collect(),
            memory: [Part::Inputs, Part::Outputs, Part::Flags].map(|part| hex(machine.memory().part(part))),
            scenario: seen.scenario().map(|(state, index)| Scenario::of(state, index)),
            reach: seen.reach().map(|reach| (reach.first, reach.time.seconds())).map_err(str::to_owned),
        }
    }
}

impl Alarm {
    fn of(alarm: &RaisedAlarm, seen: &Seen) -> Self {
        let machine = seen.machine();
        let (name, place) = (machine.alarm_name(alarm.number), place_name(alarm.place, machine.names()));
        let row = machine.control().texts().alarm(alarm.number);
        let (cancelled_by, reaction) = row.map_or_else(Default::default, |row| (row.cancelled_by, row.reaction));
        let (time, because) = (seen.raised_at(alarm).map(Time::seconds), seen.cause(alarm).map(str::to_owned));
        Self { name, place, text: machine.alarm_text(alarm), because, time, cancelled_by, reaction }
    }
}

impl Scenario {
    fn of(state: &State, index: usize) -> Self {
        let (state, failure) = match state {
            State::Acting => ("running", None),
            State::Done => ("passed", None),
            State::Failed(failure) => ("failed", Some(failure.to_string())),
        };
        Self { index, state, failure }
    }
}

fn hex(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| format!("{byte:02x}")).collect()
}
