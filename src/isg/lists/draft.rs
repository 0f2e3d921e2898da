//! The values of one list while the start-up checks correct them.

use std::collections::BTreeMap;

use crate::control::Value;
use crate::source::Place;

use super::list::List;
use super::message::{Code, ERROR, Message};
use super::parameter::{Key, Scope};
use super::table::{PARAMETERS, by_number};

/// A list with the values that the checks leave.
#[derive(Clone, Debug)]
pub(super) struct Draft<'a> {
    pub(super) list: &'a List,
    values: BTreeMap<Key, Value>,
}

impl<'a> Draft<'a> {
    /// What the control adopted of a list, and the default of each parameter without an entry.
    pub(super) fn new(list: &'a List) -> Self {
        let scope = PARAMETERS
            .iter()
            .filter(|parameter| parameter.scope == list.scope && parameter.largest_index()[1] == u16::MAX);
        let defaults = scope.filter_map(|parameter| Some((Key::new(parameter.number()), default(parameter.number())?)));
        let mut values: BTreeMap<Key, Value> = defaults.collect();
        values.extend(list.active.iter().map(|(key, entry)| (*key, entry.value.clone())));
        Self { list, values }
    }

    /// The number of the axis or channel.
    pub(super) const fn number(&self) -> u16 {
        self.list.number
    }

    /// The place of an entry, or the file without the entry.
    pub(super) fn place(&self, key: Key) -> Place {
        self.list.active.get(&key).map_or_else(|| self.list.file.clone(), |entry| entry.place.clone())
    }

    /// Whether the list has this entry.
    pub(super) fn is_written(&self, key: Key) -> bool {
        self.list.active.contains_key(&key)
    }

    /// The value of a whole number; 0 without a value.
    pub(super) fn whole(&self, key: Key) -> i64 {
        self.values.get(&key).and_then(Value::whole).unwrap_or(0)
    }

    /// The value of a number with fractions; 0 without a value.
    pub(super) fn real(&self, key: Key) -> f64 {
        self.values.get(&key).and_then(Value::number).unwrap_or(0.0)
    }

    /// A word; empty without a value.
    pub(super) fn word(&self, key: Key) -> &str {
        match self.values.get(&key) {
            Some(Value::Text(text)) => text,
            Some(Value::Boolean(_) | Value::Integer(_) | Value::Real(_)) | None => "",
        }
    }

    pub(super) fn set_whole(&mut self, key: Key, value: i64) {
        self.values.insert(key, Value::Integer(value));
    }

    pub(super) fn set_real(&mut self, key: Key, value: f64) {
        self.values.insert(key, Value::Real(value));
    }

    pub(super) fn set_word(&mut self, key: Key, value: &str) {
        self.values.insert(key, Value::Text(value.to_owned()));
    }

    /// Takes the value of another list.
    pub(super) fn take(&mut self, key: Key, from: &Draft<'_>) {
        if let Some(value) = from.values.get(&key) {
            self.values.insert(key, value.clone());
        }
    }

    /// Whether two lists have the same value.
    pub(super) fn equals(&self, key: Key, other: &Draft<'_>) -> bool {
        self.values.get(&key) == other.values.get(&key)
    }

    /// The parameter, its owner and its value: `P-AXIS-00072 kenngr.gantry_max_diff_resetable of axis 5: found 0`.
    pub(super) fn found(&self, key: Key) -> String {
        let title = by_number(key.number).map_or_else(String::new, |parameter| parameter.title(key.index));
        let found = match (self.is_written(key), self.values.get(&key)) {
            (true, Some(value)) => format!("found {}", shown(key, value)),
            (false, Some(value)) => format!("found no entry (default {})", shown(key, value)),
            (_, None) => "found no entry".to_owned(),
        };
        format!("{title} of {}: {found}", self.list.owner())
    }

    /// The value as messages print it.
    pub(super) fn shown(&self, key: Key) -> String {
        self.values.get(&key).map_or_else(String::new, |value| shown(key, value))
    }

    /// A message about this list.
    pub(super) fn message(&self, code: Code, class: u8, key: Key, text: &str) -> Message {
        let message = Message::new(code, class, &self.place(key), text);
        match self.list.scope {
            Scope::Axis => message.of_axis(self.number()),
            Scope::Channel => message.of_channel(self.number()),
        }
    }

    /// HG-06, O-34: the error that a value is out of its range, with the value that is used.
    pub(super) fn out_of_range(&self, key: Key, allowed: &str, used: &str) -> Message {
        let text = format!("{}, allowed {allowed}, used {used}", self.found(key));
        self.message(Code::Parameter(key.number), ERROR, key, &text)
    }

    /// The values that the checks left.
    pub(super) fn into_values(self) -> BTreeMap<Key, Value> {
        self.values
    }
}

/// The default of a parameter as a value; `None` if it follows from other parameters.
fn default(number: u32) -> Option<Value> {
    let parameter = by_number(number)?;
    let text = parameter.default;
    match parameter.kind.whole_numbers() {
        Some(_) => match text.strip_prefix("0x") {
            Some(digits) => i64::from_str_radix(digits, 16).ok().map(Value::Integer),
            None => text.parse().ok().map(Value::Integer),
        },
        None => match text.parse::<f64>() {
            Ok(number) => Some(Value::Real(number)),
            Err(_) => (!text.is_empty()).then(|| Value::Text(text.to_owned())),
        },
    }
}

/// A value as messages print it: the axis mode with its bits.
fn shown(key: Key, value: &Value) -> String {
    match value {
        Value::Integer(bits) if key.number == 15 => format!("0x{bits:x}"),
        Value::Text(text) => text.clone(),
        Value::Integer(_) | Value::Real(_) | Value::Boolean(_) => value.to_string(),
    }
}
