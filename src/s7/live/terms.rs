//! On which terms S7 clients are served: what they may not write, what needs a password, and whom they meet.

use super::identity::OwnIdentity;
use crate::s7::{Machinery, Protected, Protection};

/// What is said of the CPU and of rights in it; the default protects nothing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Terms {
    /// What clients may not write in any case.
    pub protected: Vec<Protected>,
    /// What needs a password.
    pub protection: Protection,
    /// What the CPU says of itself.
    pub identity: OwnIdentity,
}

impl Default for Terms {
    fn default() -> Self {
        let protection = Protection { level: 1, password: None };
        Self { protected: Vec::new(), protection, identity: OwnIdentity::default() }
    }
}

impl Terms {
    /// A machinery on these terms.
    pub(super) fn over<'a>(&'a self, machinery: Machinery<'a>) -> Machinery<'a> {
        Machinery {
            protected: &self.protected,
            protection: self.protection,
            identity: self.identity.over(machinery.identity),
            ..machinery
        }
    }
}
