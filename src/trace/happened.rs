//! Rows for what happens in addition to changes of the memory: power on, machine data, faults, operator keys, selected programs.

use super::By;
use crate::variables::{DatumValue, Describe, Happening, Place, place_name};

/// Something happened to the machine that is not a change of a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct HappeningLine {
    /// Its kind in JSON lines: `power_on`, `fault_set`.
    pub kind: &'static str,
    /// Its object, with its value: `power`, `MD37110 = 0.1`, `fault push = 1.5`.
    pub what: String,
    /// The axis, the channel or the control.
    pub place: String,
    /// `on`, `active`, `set`.
    pub change: &'static str,
    /// The side that it comes from.
    pub by: By,
    /// Its object as keys of JSON lines.
    pub details: Vec<(&'static str, Detail)>,
    /// The text of the event that was recorded for it, if any.
    pub because: Option<String>,
    /// The number of that event as counted in the trace, from one; zero for none.
    pub event: u32,
}

/// The value of a key in JSON lines.
#[derive(Clone, Debug, PartialEq)]
pub enum Detail {
    /// A text.
    Text(String),
    /// A number.
    Number(f64),
}

/// The row of a happening, without its event.
pub(super) fn happened(what: &Happening, by: By, describe: &dyn Describe) -> HappeningLine {
    let names = describe.names();
    let line = |kind, what: String, place, change, details| HappeningLine {
        kind,
        what,
        place: place_name(place, names),
        change,
        by,
        details,
        because: None,
        event: 0,
    };
    let plain = |kind, what: &str, change| line(kind, what.to_owned(), Place::Nck, change, Vec::new());
    match *what {
        Happening::PowerOn => plain("power_on", "power", "on"),
        Happening::DataSetActive => plain("set_machine_data_active", "set MD active", "pressed"),
        Happening::CancelKey => plain("cancel_key", "cancel key", "pressed"),
        Happening::PlcStopped => plain("plc_stopped", "PLC", "stopped"),
        Happening::PlcStarted => plain("plc_started", "PLC", "started"),
        Happening::PlcColdRestart => plain("plc_cold_restart", "PLC", "cold restart"),
        Happening::DatumStored(datum) => {
            let (what, details) = named(datum, describe);
            line("machine_datum_stored", what, datum.place, "stored", details)
        }
        Happening::DatumActive(datum) => {
            let (what, details) = named(datum, describe);
            line("machine_datum_active", what, datum.place, "active", details)
        }
        Happening::Fault { axis, name, by, begins } => {
            let (kind, change) = if begins { ("fault_set", "set") } else { ("fault_cleared", "cleared") };
            let mut details = vec![("fault", Detail::Text(name.name().to_owned()))];
            details.extend(by.map(|by| ("amount", Detail::Number(by))));
            line(kind, with_value(format!("fault {}", name.name()), by), Place::Axis(axis), change, details)
        }
        Happening::ProgramSelected { channel, program } => {
            let details = vec![("program", Detail::Text(program.to_string()))];
            line("program_selected", format!("program {program}"), Place::Channel(channel), "selected", details)
        }
        Happening::BlocksEntered { channel } => {
            line("blocks_entered", "MDA blocks".to_owned(), Place::Channel(channel), "entered", Vec::new())
        }
        Happening::HandwheelTurned { number, pulses } => {
            let details =
                vec![("handwheel", Detail::Number(f64::from(number))), ("pulses", Detail::Number(f64::from(pulses)))];
            let what = with_value(format!("handwheel {number}"), Some(f64::from(pulses)));
            line("handwheel_turned", what, Place::Nck, "turned", details)
        }
    }
}

/// `MD37110 = 0.1`, and the datum in the notation of scenarios with its value.
fn named(datum: DatumValue, describe: &dyn Describe) -> (String, Vec<(&'static str, Detail)>) {
    let DatumValue { number, place, index, value, word } = datum;
    let index = index.map(|index| index.to_string());
    let brackets = |inside: Vec<String>| match inside.is_empty() {
        true => String::new(),
        false => format!("[{}]", inside.join(",")),
    };
    let owner = match place {
        Place::Nck => None,
        Place::ModeGroup(_) | Place::Channel(_) | Place::Axis(_) => Some(place_name(place, describe.names())),
    };
    let what = describe.datum_name(number) + &brackets(index.iter().cloned().collect());
    let target = format!("{number}{}", brackets(index.into_iter().chain(owner).collect()));
    let mut details = vec![("machine_data", Detail::Text(target))];
    details.extend(value.map(|value| ("value", Detail::Number(value))));
    details.extend(word.map(|word| ("value", Detail::Text(word.to_string()))));
    let what = word.map_or_else(|| with_value(what.clone(), value), |word| format!("{what} = {word}"));
    (what, details)
}

fn with_value(what: String, value: Option<f64>) -> String {
    match value {
        Some(value) => what + &format!(" = {value}"),
        None => what,
    }
}
