//! A trace as JSON lines. The docs of [`super`] define the lines and their keys.

use super::causes::{Cause, CauseInput};
use super::printable::Shown;
use super::record::by_in_words;
use super::{By, Detail, Line, LineKind};

/// All lines; an event precedes the bits of the NCK that it explains.
pub(super) fn lines(lines: &[Line], causes: &[Cause]) -> String {
    let mut text = String::new();
    let mut causes = causes.iter().peekable();
    for one in lines {
        let before = |cause: &Cause| match cause.time == one.time {
            true => follows_events(&one.kind),
            false => cause.time < one.time,
        };
        while let Some(next) = causes.next_if(|next| before(next)) {
            text += &cause(next);
        }
        text += &line(one);
    }
    // The last line can be a happening, which its event follows.
    text.extend(causes.map(cause));
    text
}

/// Within one time, notes and writes come first, then events, then the changes that the control derived from them.
fn follows_events(kind: &LineKind) -> bool {
    match kind {
        LineKind::Note(_) | LineKind::Happening(_) => false,
        LineKind::Signal(signal) => signal.by == By::Nck || signal.by == By::Plc && signal.event != 0,
        LineKind::Alarm(_) | LineKind::Value(..) | LineKind::Text(..) => true,
    }
}

fn cause(cause: &Cause) -> String {
    let mut fields = vec![
        ("t", cause.time.to_string()),
        ("event", cause.number.to_string()),
        ("where", quoted(&cause.place)),
        ("rule", quoted(&cause.rule)),
        ("because", quoted(&cause.because)),
        ("inputs", format!("[{}]", cause.inputs.iter().map(input).collect::<Vec<_>>().join(","))),
    ];
    if cause.parent != 0 {
        fields.push(("parent", cause.parent.to_string()));
    }
    object(&fields)
}

fn input(input: &CauseInput) -> String {
    match input {
        CauseInput::Signal { address, symbol, value } => {
            let symbol = symbol.as_ref().map(|symbol| format!(",\"symbol\":{}", quoted(symbol))).unwrap_or_default();
            // JSON has no infinity.
            let value = if value.parse().is_ok_and(f64::is_finite) { value } else { "null" };
            format!("{{\"signal\":{}{symbol},\"value\":{value}}}", quoted(address))
        }
        CauseInput::Datum(name, value) => {
            let value = if value.is_finite() { value.to_string() } else { "null".to_owned() };
            format!("{{\"machine_data\":{},\"value\":{value}}}", quoted(name))
        }
        CauseInput::Value(name, value) => format!("{{\"symbol\":{},\"value\":{value}}}", quoted(name)),
        CauseInput::Alarm(name) => match name.parse::<u32>() {
            Ok(number) => format!("{{\"alarm\":{number}}}"),
            Err(_) => format!("{{\"alarm\":{}}}", quoted(name)),
        },
        CauseInput::Fault(name) => format!("{{\"fault\":{}}}", quoted(name)),
        CauseInput::Timer(name, status) => format!("{{\"timer\":{},\"value\":{}}}", quoted(name), status),
        CauseInput::Block(name) => format!("{{\"block\":{}}}", quoted(name)),
    }
}

/// One JSON object and a newline.
fn line(line: &Line) -> String {
    let mut fields = vec![("t", line.time.to_string())];
    match &line.kind {
        LineKind::Note(text) => fields.push(("note", quoted(text))),
        LineKind::Happening(happening) => {
            fields.push(("happened", quoted(happening.kind)));
            fields.extend(happening.details.iter().map(|(key, detail)| (*key, self::detail(detail))));
            fields.push(("where", quoted(&happening.place)));
            fields.push(("by", quoted(by_in_words(happening.by))));
            if let Some(because) = &happening.because {
                fields.push(("because", quoted(because)));
            }
            if happening.event != 0 {
                fields.push(("event", happening.event.to_string()));
            }
        }
        LineKind::Signal(signal) => {
            fields.push(("signal", quoted(&signal.address)));
            if let Some(symbol) = &signal.symbol {
                fields.push(("symbol", quoted(symbol)));
            }
            fields.push(("value", number(signal.new)));
            fields.push(("by", quoted(by_in_words(signal.by))));
            if let Some(because) = &signal.because {
                fields.push(("because", quoted(because)));
            }
            if signal.event != 0 {
                fields.push(("event", signal.event.to_string()));
            }
        }
        LineKind::Alarm(alarm) => {
            let name = if alarm.numbered { alarm.name.clone() } else { quoted(&alarm.name) };
            let parameters: Vec<_> = alarm
                .parameters
                .iter()
                .map(|parameter| match parameter {
                    Ok(number) => number.to_string(),
                    Err(name) => quoted(name),
                })
                .collect();
            fields.push(("alarm", name));
            fields.push(("state", quoted(if alarm.raised { "raised" } else { "cleared" })));
            fields.push(("where", quoted(&alarm.place)));
            fields.push(("parameters", format!("[{}]", parameters.join(","))));
            fields.push(("text", quoted(&alarm.text)));
            if let Some(because) = &alarm.because {
                fields.push(("because", quoted(because)));
            }
            if alarm.event != 0 {
                fields.push(("event", alarm.event.to_string()));
            }
        }
        LineKind::Value(name, _, new) => {
            fields.push(("symbol", quoted(name)));
            // Only an R parameter can be without a finite number.
            let is_finite = new.parse().is_ok_and(f64::is_finite);
            fields.push(("value", if is_finite { new.clone() } else { "null".to_owned() }));
        }
        LineKind::Text(name, _, new) => {
            fields.push(("symbol", quoted(name)));
            fields.push(("value", quoted(new)));
        }
    }
    object(&fields)
}

fn object(fields: &[(&str, String)]) -> String {
    let fields: Vec<_> = fields.iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
    format!("{{{}}}\n", fields.join(","))
}

fn detail(detail: &Detail) -> String {
    match detail {
        Detail::Text(text) => quoted(text),
        Detail::Number(value) => number(Shown::Number(*value)),
    }
}

/// JSON has no infinity; an infinite REAL becomes null.
fn number(value: Shown) -> String {
    match value {
        Shown::Number(number) if !number.is_finite() => "null".to_owned(),
        value => value.to_string(),
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
