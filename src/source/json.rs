//! Values in JSON as values of a file, for callers that have no file: the server of the live page and the module for Python.

use serde_json::Value as Json;

use super::{Node, Place, Problem, Table, Value};

impl Node {
    /// The same value as in a file; all of it has this place.
    ///
    /// # Errors
    /// It contains null, or a number that 64 bits cannot hold.
    pub fn from_json(json: &Json, place: &Place) -> Result<Self, Problem> {
        let value = match json {
            Json::Null => return Err(Problem::new("expected a value, found null", "write a number, a text or true")),
            Json::Bool(value) => Value::Boolean(*value),
            Json::String(text) => Value::Text(text.clone()),
            Json::Number(number) => match (number.as_i64(), number.as_f64()) {
                (Some(number), _) => Value::Integer(number),
                (None, Some(number)) => Value::Float(number),
                (None, None) => return Err(Problem::new("expected a smaller number", "write a number of 64 bits")),
            },
            Json::Array(list) => {
                Value::Array(list.iter().map(|one| Self::from_json(one, place)).collect::<Result<_, _>>()?)
            }
            Json::Object(object) => {
                let mut table = Table::empty(place.clone());
                for (key, value) in object {
                    // A path of one key in an empty table is always free.
                    let _ = table.put(&[key], place, Self::from_json(value, place)?);
                }
                Value::Table(table)
            }
        };
        Ok(Self { place: place.clone(), value })
    }
}
