//! What parameters of calls and operands have in common: names, shapes, pointers, local data.

use crate::plc::step7::instruction::{BlockName, Operand as Place, Pointed, Space};
use crate::plc::step7::text::constants::Constant;
use crate::plc::step7::text::finding::Fault;
use crate::plc::step7::text::parser::code;
use crate::plc::step7::text::syntax::{Operand, Parameter, Statement};
use crate::plc::step7::text::types::{Field, Section, Type};

use super::declare::Interface;

/// To what an operand points, if its address is known.
pub(super) fn pointed(place: Place) -> Option<Pointed> {
    Some(match place {
        Place::Direct(Space::Local, bit) => Pointed::Local(bit),
        Place::Direct(space, bit) => Pointed::Constant(0, code(space) << 24 | bit),
        Place::Block(number, bit) | Place::Fixed(number, bit) => {
            Pointed::Constant(number, code(Space::Data) << 24 | bit)
        }
        Place::Own(bit) => Pointed::Own(bit),
        Place::Element(index, offset) => Pointed::Element(index, offset),
        Place::Through(at, offset) => Pointed::Through(at, offset),
        Place::Parameter(index) => Pointed::Parameter(index),
        Place::Indirect(..) | Place::Register(..) => return None,
    })
}

/// Whether a variable of one type can be passed for a parameter of another: texts of any length, all others of the same size.
pub(super) fn same_shape(wanted: &Type, found: &Type) -> bool {
    match (wanted, found) {
        (Type::Text(_), Type::Text(_)) => true,
        (Type::Text(_), _) | (_, Type::Text(_)) | (Type::DateTime, Type::Array(_)) => false,
        _ => wanted.bits() == found.bits() && found.width().is_none(),
    }
}

pub(super) fn find<'p>(parameters: &'p [Parameter], field: &Field) -> Option<&'p Parameter> {
    let is_named = |parameter: &&Parameter| parameter.name.to_lowercase() == field.name.to_lowercase();
    parameters.iter().find(is_named).filter(|_| is_parameter(field))
}

/// The faults of names that are no parameters of the block.
pub(super) fn check_names(interface: &Interface, parameters: &[Parameter], name: BlockName) -> Vec<Fault> {
    let fault = |parameter: &Parameter| {
        let fields = interface.layout.fields.iter();
        if fields.clone().any(|field| find(std::slice::from_ref(parameter), field).is_some()) {
            return None;
        }
        let names: Vec<&str> = fields.filter(|field| is_parameter(field)).map(|field| field.name.as_str()).collect();
        let all = match names.len() {
            0 => "it has no parameters".to_owned(),
            1..=12 => format!("its parameters are {}", names.join(", ")),
            _ => "check the declaration of the block".to_owned(),
        };
        let cure = crate::source::did_you_mean(&parameter.name, names, &all);
        Some(Fault::new(parameter.at, format!("{name} has no parameter `{}`", parameter.name), cure))
    };
    parameters.iter().filter_map(fault).collect()
}

fn is_parameter(field: &Field) -> bool {
    matches!(field.section, Section::Input | Section::Output | Section::InOut)
}

/// The end of the local data that a statement names absolutely, in bits.
pub(super) fn local_use(statement: &Statement) -> Option<u32> {
    let parameters = statement.parameters.iter().map(|parameter| &parameter.value);
    parameters.chain([&statement.operand]).filter_map(local_end).max()
}

/// The end of the local data that an operand names absolutely, in bits.
fn local_end(operand: &Operand) -> Option<u32> {
    match operand {
        Operand::Memory(Space::Local, width, bit) => Some(bit + width.bits()),
        Operand::Indirect(_, _, pointer) | Operand::TimerAt(pointer) | Operand::CounterAt(pointer) => {
            local_end(pointer)
        }
        Operand::BlockAt(_, _, pointer) => local_end(pointer),
        Operand::Constant(Constant::Pointer { pointer, any: Some((code, count)), .. }) if pointer >> 24 == 0x86 => {
            let bits = match code {
                0x01 => 1,
                0x02 | 0x03 => 8,
                0x04 | 0x05 | 0x09 | 0x0C => 16,
                _ => 32,
            };
            Some((pointer & 0x00FF_FFFF) + u32::from(*count) * bits)
        }
        _ => None,
    }
}
