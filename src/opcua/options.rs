//! The options of the server.

use std::path::PathBuf;
use std::sync::Arc;

use super::rights::Rights;
use crate::machine::{Command, Machine};

/// Why a command may not be executed, if it may not: protected addresses.
pub type Protects = Arc<dyn Fn(&Machine, &Command) -> Option<String> + Send + Sync>;

/// A user with a password.
#[derive(Clone, PartialEq, Eq)]
pub struct User {
    /// The name.
    pub name: String,
    /// The password.
    pub password: String,
    /// What the user may do.
    pub rights: Rights,
}

impl std::fmt::Debug for User {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("User").field("name", &self.name).field("rights", &self.rights).finish_non_exhaustive()
    }
}

/// The options of the server.
pub struct OpcUaOptions {
    /// The address, as `127.0.0.1:4840`; port 0 selects a free one.
    pub address: String,
    /// Clients may look only.
    pub is_read_only: bool,
    /// Why a command may not be executed, if it may not.
    pub protects: Protects,
    /// The folder with the certificates of the server and of the clients that it trusts. With it, clients can connect with encryption.
    pub pki: Option<PathBuf>,
    /// Also clients on other computers may connect without encryption.
    pub is_insecure: bool,
    /// The users; without one, every client has all rights.
    pub users: Vec<User>,
    /// The serial number of the hardware, as an NC variable shows it.
    pub serial_number: String,
}

impl OpcUaOptions {
    /// The options for a server that everybody on this computer may connect to and write.
    #[must_use]
    pub fn new(address: &str) -> Self {
        let protects: Protects = Arc::new(|_, _| None);
        Self {
            address: address.to_owned(),
            is_read_only: false,
            protects,
            pki: None,
            is_insecure: false,
            users: Vec::new(),
            serial_number: String::new(),
        }
    }
}

impl OpcUaOptions {
    /// The rights of a client, by the name of its user.
    pub(super) fn rights(&self, name: &str) -> Rights {
        if self.users.is_empty() {
            return Rights::ALL;
        }
        self.users.iter().find(|user| user.name == name).map_or_else(Rights::default, |user| user.rights)
    }
}

impl std::fmt::Debug for OpcUaOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("OpcUaOptions").field("address", &self.address).finish_non_exhaustive()
    }
}
