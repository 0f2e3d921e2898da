//! The results of the last bit operations of an observed CPU, as plain data: what each of them tested, with the value at this moment. The reasons
//! of a bit are built of them, so nothing is read again after the fact.

use super::read::Named;

/// The bit operations that are remembered, by the last bits of their addresses: more than a logic string can have.
const CONTACTS: usize = 512;

/// A bit operation that ran.
#[derive(Clone, Copy, Debug)]
pub(in crate::plc::step7) struct Contact {
    /// The instruction.
    pub(super) pc: u32,
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

    pub(super) fn put(&mut self, contact: Contact) {
        self.0[contact.pc as usize % CONTACTS] = contact;
    }

    /// What an instruction tested when it ran last.
    pub(super) fn at(&self, pc: u32) -> Option<Contact> {
        Some(self.0[pc as usize % CONTACTS]).filter(|contact| contact.pc == pc)
    }
}
