//! The attributes of nodes: all usual ones, also of ids that browsing does not show.

use opcua::types::{
    AttributeId, DataTypeId, DataValue, DateTime, LocalizedText, NodeClass, NodeId, QualifiedName, StatusCode, Variant,
    VariantScalarTypeId,
};

use super::node_id::{Id, Type};
use super::reading::{NOT_HERE, Reader};
use super::spaces::NAMESPACE;
use super::tree::{Node, Tree};
use crate::image::Address;

/// A node of our namespace: a folder, or a value.
pub(super) enum Found<'a> {
    Folder(&'a Node),
    /// The id, and its node in the tree if it is there.
    Value(Id, Option<&'a Node>),
}

/// The node with this id; `None` if no control has one.
pub(super) fn find<'a>(tree: &'a Tree, text: &str) -> Option<Found<'a>> {
    match tree.find(text) {
        Some(folder) if folder.is_folder => Some(Found::Folder(folder)),
        node => Id::parse(text).map(|id| Found::Value(id, node)),
    }
}

/// The names of a node: browse name, display name, description.
pub(super) fn names(found: &Found<'_>, text: &str, reader: &Reader<'_>) -> [String; 3] {
    match found {
        Found::Folder(node) | Found::Value(_, Some(node)) => {
            [node.browse_name.clone(), node.display_name.clone(), node.description.clone()]
        }
        Found::Value(id, None) => {
            let name = text.rsplit('/').next().unwrap_or_default().to_owned();
            [name.clone(), name, meaning(id, reader)]
        }
    }
}

/// The namespace of its browse name.
pub(super) fn space(found: &Found<'_>) -> u16 {
    match found {
        Found::Folder(node) | Found::Value(_, Some(node)) => node.space,
        Found::Value(_, None) => NAMESPACE,
    }
}

/// The symbol and the meaning of a signal.
fn meaning(id: &Id, reader: &Reader<'_>) -> String {
    let names = reader.machine().names();
    let location = match id {
        Id::Plc(plc) => {
            let address = Address { area: plc.area, byte: plc.byte, width: plc.width, format: None };
            reader.machine().memory().locate(&address, names.profile).ok()
        }
        Id::Variable(nc) => return format!("NC variable {}.", nc.variable.name),
        Id::Pattern(..) | Id::Absent | Id::Datum(_) | Id::Own(_) | Id::Cnc(_) => None,
    };
    let Some(location) = location else { return String::new() };
    let symbol = names.symbol(location).unwrap_or_default();
    let meaning = names.interface().meaning(location).unwrap_or_default();
    format!("{symbol}: {}", meaning.trim()).trim_matches([':', ' ']).to_owned()
}

/// Whether clients may write a node, as far as its kind goes.
pub(super) fn is_writable(id: &Id) -> bool {
    match id {
        Id::Plc(plc) => plc.kind != Type::Timer,
        Id::Variable(nc) => nc.is_r,
        Id::Datum(_) => true,
        Id::Pattern(..) | Id::Absent | Id::Own(_) | Id::Cnc(_) => false,
    }
}

/// The type of a node, and the number of elements of an array.
fn shape(id: &Id, reader: &Reader<'_>) -> Result<(DataTypeId, Option<u32>), StatusCode> {
    if let Id::Pattern(_, kind) = id {
        return Ok((of_type(*kind), None));
    }
    let value = match reader.read(id) {
        // The specification has it, also where there is no value.
        Err(StatusCode::BadNotSupported) => return Ok((DataTypeId::BaseDataType, None)),
        value => value?,
    };
    let kind = match value.scalar_type_id() {
        Some(VariantScalarTypeId::Boolean) => DataTypeId::Boolean,
        Some(VariantScalarTypeId::Byte) => DataTypeId::Byte,
        Some(VariantScalarTypeId::Int32) => DataTypeId::Int32,
        Some(VariantScalarTypeId::UInt32) => DataTypeId::UInt32,
        Some(VariantScalarTypeId::UInt64) => DataTypeId::UInt64,
        Some(VariantScalarTypeId::Double) => DataTypeId::Double,
        Some(VariantScalarTypeId::String) => DataTypeId::String,
        Some(VariantScalarTypeId::DateTime) => DataTypeId::DateTime,
        _ => DataTypeId::BaseDataType,
    };
    let count = value.as_array().map(|values| u32::try_from(values.len()).unwrap_or(u32::MAX));
    Ok((kind, count))
}

fn of_type(kind: Type) -> DataTypeId {
    match kind {
        Type::Bool => DataTypeId::Boolean,
        Type::Byte | Type::Word | Type::DoubleWord | Type::Timer => DataTypeId::UInt32,
        Type::Int | Type::DoubleInt => DataTypeId::Int32,
        Type::Real => DataTypeId::Double,
        Type::Char | Type::String => DataTypeId::String,
        Type::Counter => DataTypeId::Byte,
    }
}

/// An attribute of a node. `may_write` is the right of the client.
pub(super) fn attribute(
    found: &Found<'_>,
    text: &str,
    attribute: AttributeId,
    reader: &Reader<'_>,
    may_write: bool,
) -> DataValue {
    let value = match (found, attribute) {
        (Found::Value(id, _), AttributeId::Value) => reader.read(id),
        _ => other(found, text, attribute, reader, may_write),
    };
    match value {
        Ok(value) => DataValue::new_at(value, DateTime::now()),
        Err(status) => DataValue { status: Some(status), server_timestamp: Some(DateTime::now()), ..DataValue::null() },
    }
}

fn other(
    found: &Found<'_>,
    text: &str,
    attribute: AttributeId,
    reader: &Reader<'_>,
    may_write: bool,
) -> Result<Variant, StatusCode> {
    // The machine does not have it, whatever the attribute.
    if let Found::Value(id, _) = found {
        shape(id, reader)?;
    }
    let names = || names(found, text, reader);
    Ok(match (attribute, found) {
        (AttributeId::NodeId, _) => NodeId::new(NAMESPACE, text.to_owned()).into(),
        (AttributeId::NodeClass, Found::Folder(_)) => (NodeClass::Object as i32).into(),
        (AttributeId::NodeClass, Found::Value(..)) => (NodeClass::Variable as i32).into(),
        (AttributeId::BrowseName, _) => QualifiedName::new(space(found), names()[0].clone()).into(),
        (AttributeId::DisplayName, _) => LocalizedText::new("", &names()[1]).into(),
        (AttributeId::Description, _) => LocalizedText::new("", &names()[2]).into(),
        (AttributeId::WriteMask | AttributeId::UserWriteMask, _) => 0_u32.into(),
        (AttributeId::EventNotifier, Found::Folder(_)) => 0_u8.into(),
        (AttributeId::DataType, Found::Value(id, _)) => NodeId::from(shape(id, reader)?.0).into(),
        (AttributeId::ValueRank, Found::Value(id, _)) => {
            let is_array = shape(id, reader)?.1.is_some();
            (if is_array { 1_i32 } else { -1 }).into()
        }
        (AttributeId::ArrayDimensions, Found::Value(id, _)) => {
            shape(id, reader)?.1.map_or_else(|| Variant::from(Vec::<u32>::new()), |count| vec![count].into())
        }
        (AttributeId::AccessLevel, Found::Value(id, _)) => (1 | u8::from(is_writable(id)) << 1).into(),
        (AttributeId::UserAccessLevel, Found::Value(id, _)) => (1 | u8::from(is_writable(id) && may_write) << 1).into(),
        (AttributeId::MinimumSamplingInterval, Found::Value(..)) => {
            (reader.machine().cycle_time().seconds() * 1000.0).into()
        }
        (AttributeId::Historizing, Found::Value(..)) => false.into(),
        _ => return Err(NOT_HERE),
    })
}
