//! What bit operations test, before they run on an observed CPU, and their texts.

use crate::plc::step7::instruction::{Logic, Numeric, Op, Operand, Relation, Space, StatusBit};

use super::access::{Spot, Where};
use super::contacts::Contact;
use super::cpu::Cpu;
use super::memory::Areas;
use super::operations::status_bit;
use super::read::Named;

/// The bit address of a place in all local data.
pub(super) fn local(spot: Spot) -> Option<u32> {
    match spot.at {
        Where::Local(from, _) => Some(from * 8 + spot.bit),
        Where::Area(_) | Where::Peripheral | Where::Block(_) => None,
    }
}

impl Cpu {
    /// Before an instruction: remembers what it tests, if it is a bit operation.
    pub(super) fn note_contact<A: Areas>(&mut self, areas: &A, op: Op, pc: u32) {
        let (status, now) = (self.state.registers.status, self.work.now);
        let mut contact = Contact { pc, named: None, value: false, marker: false, is_first: !status.fc };
        let mut origin = None;
        match op {
            Op::Logic(_, operand) | Op::Edge(_, operand) => {
                let Ok(spot) = self.spot(areas, operand) else { return };
                let Ok(value) = self.read_bit(areas, spot) else { return };
                contact.named = self.named(spot);
                contact.value = value;
                if let Op::Edge(is_positive, _) = op {
                    contact.marker = value;
                    contact.value = if is_positive { status.rlo && !value } else { !status.rlo && value };
                } else if let Some(bit) = local(spot) {
                    origin = self.observed.as_ref().map(|observed| observed.flow.of_local(bit, 1));
                }
            }
            Op::LogicTimer(_, number) => {
                let Ok(number) = self.number(areas, number) else { return };
                let Some(timer) = self.state.timers.get(usize::from(number)) else { return };
                contact.named = Some(Named::Timer(number));
                contact.value = timer.status(now);
            }
            Op::LogicCounter(_, number) => {
                let Ok(number) = self.number(areas, number) else { return };
                let Some(counter) = self.state.counters.get(usize::from(number)) else { return };
                contact.named = Some(Named::Counter(number));
                contact.value = counter.value != 0;
            }
            Op::LogicStatus(_, bit) => {
                contact.value = status_bit(status, bit);
                origin = self.observed.as_ref().map(|observed| observed.flow.of_status(bit));
            }
            Op::Compare(relation, numeric) => {
                let [accu1, accu2, ..] = self.state.registers.accu;
                (contact.value, _) = super::arithmetic::compare(relation, numeric, accu2, accu1);
            }
            Op::OpenNest(_) | Op::OrBeforeAnd | Op::Not => {}
            _ => return,
        }
        let Some(observed) = &mut self.observed else { return };
        observed.contacts.put(contact);
        // Also if it is unknown: the same statement may have run before with another one.
        if let Some(origin) = origin {
            observed.flow.remember(pc, origin);
        }
    }
}

/// A bit operation as its source writes it, for one whose operand has no name: `A <0`, `O L 20.1`, `>I`.
pub(in crate::plc::step7) fn text_of(op: Op) -> Option<String> {
    let operation = |logic| match logic {
        Logic::And => "A",
        Logic::AndNot => "AN",
        Logic::Or => "O",
        Logic::OrNot => "ON",
        Logic::Xor => "X",
        Logic::XorNot => "XN",
    };
    Some(match op {
        Op::LogicStatus(logic, bit) => format!("{} {}", operation(logic), name_of(bit)),
        Op::Logic(logic, Operand::Direct(Space::Local, bit)) => {
            format!("{} L {}.{}", operation(logic), bit / 8, bit % 8)
        }
        Op::Logic(logic, _) => format!("{} of a local bit", operation(logic)),
        Op::Compare(relation, numeric) => {
            let relation = match relation {
                Relation::Equal => "==",
                Relation::NotEqual => "<>",
                Relation::Greater => ">",
                Relation::Less => "<",
                Relation::GreaterEqual => ">=",
                Relation::LessEqual => "<=",
            };
            let numeric = match numeric {
                Numeric::Int => "I",
                Numeric::Double => "D",
                Numeric::Real => "R",
            };
            format!("{relation}{numeric}")
        }
        _ => return None,
    })
}

/// The name of a status bit as an operand.
fn name_of(bit: StatusBit) -> &'static str {
    match bit {
        StatusBit::Zero => "==0",
        StatusBit::NotZero => "<>0",
        StatusBit::Positive => ">0",
        StatusBit::Negative => "<0",
        StatusBit::NotNegative => ">=0",
        StatusBit::NotPositive => "<=0",
        StatusBit::Unordered => "UO",
        StatusBit::Overflow => "OV",
        StatusBit::StoredOverflow => "OS",
        StatusBit::BinaryResult => "BR",
    }
}
