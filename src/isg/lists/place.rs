//! How places of files are saved with a machine: as file and line. For `#[serde(with = …)]`.

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::source::Place;

pub(super) fn serialize<S: Serializer>(place: &Place, to: S) -> Result<S::Ok, S::Error> {
    (place.file.as_ref(), place.line).serialize(to)
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    let (file, line) = <(String, u32)>::deserialize(from)?;
    Ok(Place { file: file.into(), line })
}
