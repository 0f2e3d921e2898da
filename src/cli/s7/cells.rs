//! How values are shown: as text, in hexadecimal, as JSON, and with their meaning.

use serde_json::Value as Json;

use super::targets::Target;
use crate::cli::list;
use crate::image::Width;
use crate::s7::client::{Error, Memory as Place, Value, Variable};

/// A cell of a list.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) text: String,
    pub(super) json: Json,
}

impl list::Cell for Cell {
    fn text(&self) -> &str {
        &self.text
    }

    fn json(&self) -> Json {
        self.json.clone()
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self { json: text.as_str().into(), text }
    }
}

/// The cells of a value: the value itself, and its bytes in hexadecimal.
pub(super) fn cells(target: &Target, value: &Result<Value, Error>) -> [Cell; 2] {
    let variable = &target.variable;
    let value = match value {
        Ok(value) => value,
        Err(error) => return [format!("refused: {}", target.reason(error)).into(), String::new().into()],
    };
    let hex = match (variable, value) {
        // These values are already in hexadecimal, or have no bytes of their own.
        (_, Value::Bytes(_) | Value::Text(_)) => Vec::new(),
        (Variable::Memory(Place { width: Width::Bits { .. }, .. }), Value::Byte(bits)) => vec![*bits],
        _ => value.encode(variable).unwrap_or_default(),
    };
    let hex: Vec<String> = hex.iter().map(|byte| format!("{byte:02X}")).collect();
    [Cell { text: value.to_string(), json: json(variable, value) }, hex.join(" ").into()]
}

/// Bits are `true` and `false`, numbers are numbers, several values are a list. Bytes of unknown type stay hexadecimal text.
fn json(variable: &Variable, value: &Value) -> Json {
    match value {
        Value::Bit(value) => (*value).into(),
        Value::Byte(value) => (*value).into(),
        Value::Word(value) => (*value).into(),
        Value::DoubleWord(value) => (*value).into(),
        Value::Int(value) => (*value).into(),
        Value::DoubleInt(value) => (*value).into(),
        // Converted through text: the 4-byte REAL 1.1 is 1.10000002384 as an 8-byte number.
        Value::Real(_) => value.to_string().parse::<f64>().ok().map_or(Json::Null, Json::from),
        Value::Double(value) => (*value).into(),
        Value::Text(_) => value.to_string().into(),
        Value::Bytes(bytes) if matches!(variable, Variable::Memory(_)) => bytes.as_slice().into(),
        Value::Bytes(_) => value.to_string().into(),
        Value::List(values) => values.iter().map(|value| json(variable, value)).collect(),
    }
}

/// The meaning of the signal at this address; for an override also its value in per cent.
pub(super) fn meant(target: &Target, value: &Result<Value, Error>) -> String {
    let Some(location) = target.location else { return String::new() };
    let meaning = target.coding.interface.meaning(location).unwrap_or_default();
    let percent = match value {
        Ok(Value::Byte(code)) => target.coding.percent(location, *code),
        _ => None,
    };
    percent.map_or_else(|| meaning.to_owned(), |percent| format!("{percent} %. {meaning}"))
}
