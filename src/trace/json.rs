//! One line of a trace as JSON, with the keys that `interface` promises.

use super::places::Shown;
use super::text::by_in_words;
use super::{Line, LineKind};

/// One JSON object and a newline.
pub(super) fn line(line: &Line) -> String {
    let mut fields = vec![("t", line.time.to_string())];
    match &line.kind {
        LineKind::Note(text) => fields.push(("note", quoted(text))),
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
        }
        LineKind::Value(name, _, new) => {
            fields.push(("symbol", quoted(name)));
            fields.push(("value", new.clone()));
        }
    }
    let fields: Vec<_> = fields.into_iter().map(|(key, value)| format!("\"{key}\":{value}")).collect();
    format!("{{{}}}\n", fields.join(","))
}

/// JSON has no infinity; a REAL that holds one is null.
fn number(value: Shown) -> String {
    match value {
        Shown::Number(number) if !number.is_finite() => "null".to_owned(),
        value => value.to_string(),
    }
}

fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}
