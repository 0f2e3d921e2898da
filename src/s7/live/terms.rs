//! The terms for S7 clients: protected addresses, functions that need a password, and the identification of the CPU.

use super::identity::{OwnIdentity, identity};
use crate::machine::Machine;
use crate::s7::{Machinery, Protected, Protection};

/// Protection and identification of the CPU. The default protects nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Terms {
    /// Addresses that clients may never write.
    pub protected: Vec<Protected>,
    /// The functions that need a password.
    pub protection: Protection,
    /// The identification of the CPU.
    pub identity: OwnIdentity,
}

impl Default for Terms {
    fn default() -> Self {
        let protection = Protection { level: 1, password: None };
        Self { protected: Vec::new(), protection, identity: OwnIdentity::default() }
    }
}

impl Terms {
    /// The serial number of the CPU of a machine.
    #[must_use]
    pub fn serial_number<'a>(&'a self, machine: &Machine) -> &'a str {
        self.identity.over(identity(machine)).serial_number
    }

    /// Applies these terms to a machine.
    pub(super) fn over<'a>(&'a self, machinery: Machinery<'a>) -> Machinery<'a> {
        Machinery {
            protected: &self.protected,
            protection: self.protection,
            identity: self.identity.over(machinery.identity),
            ..machinery
        }
    }
}
