//! The results of the last bit operations of an observed CPU: what each of them tested, with the value at this moment. The reasons of a bit are
//! built of them, so nothing is read again after the fact.

use crate::plc::step7::instruction::{Logic, Numeric, Op, Operand, Relation, Space, StatusBit};

use super::access::{Spot, Where};
use super::cpu::Cpu;
use super::memory::Areas;
use super::operations::status_bit;
use super::origin::Origin;
use super::read::Named;

/// The bit operations that are remembered, by the last bits of their addresses: more than a logic string can have.
const CONTACTS: usize = 512;

/// A bit operation that ran.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Contact {
    /// The instruction.
    pc: u32,
    /// What it tested; without a name it is local data.
    pub(super) named: Option<Named>,
    /// The bit that it tested, before a negation; of an edge and a comparison the result.
    pub(super) value: bool,
    /// Of an edge its marker, before the operation.
    pub(super) marker: bool,
    /// A logic string began with it.
    pub(super) is_first: bool,
}

/// The last bit operations.
#[derive(Clone, Debug)]
pub(in crate::plc::step7) struct Contacts(Vec<Contact>);

impl Contacts {
    pub(in crate::plc::step7) fn new() -> Self {
        Self(vec![Contact { pc: u32::MAX, named: None, value: false, marker: false, is_first: false }; CONTACTS])
    }

    fn put(&mut self, contact: Contact) {
        self.0[contact.pc as usize % CONTACTS] = contact;
    }

    /// What an instruction tested when it ran last.
    pub(super) fn at(&self, pc: u32) -> Option<Contact> {
        Some(self.0[pc as usize % CONTACTS]).filter(|contact| contact.pc == pc)
    }
}

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
        if let Some(origin) = origin.filter(|origin: &Origin| origin.reads().is_some()) {
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
