//! The options of the page.

use std::net::IpAddr;
use std::sync::Arc;

use super::connections::Admits;
use super::orders::Protects;
use crate::live::Opened;

/// The options of the page.
pub struct WebOptions {
    /// The address, as `127.0.0.1:8080`; port 0 selects a free one.
    pub address: String,
    /// Further names of this computer in the address of the page.
    pub hosts: Vec<String>,
    /// Clients may look only.
    pub is_read_only: bool,
    /// Which clients may connect.
    pub admits: Admits,
    /// Why a command may not be executed, if it may not: protected addresses.
    pub protects: Protects,
    /// The name of the machine.
    pub title: String,
    /// The name of its PLC program.
    pub plc: Option<String>,
}

impl WebOptions {
    /// The options for a machine that everybody may connect to and write.
    #[must_use]
    pub fn new(address: &str, opened: &Opened) -> Self {
        let own = || opened.machine.own_program().map(|(name, _)| name.to_owned());
        Self {
            address: address.to_owned(),
            hosts: Vec::new(),
            is_read_only: false,
            admits: Arc::new(|_: IpAddr| true),
            protects: Arc::new(|_, _| None),
            title: opened.path.display().to_string(),
            plc: opened.plc.clone().or_else(|| opened.plc_process.clone()).or_else(own),
        }
    }
}

impl std::fmt::Debug for WebOptions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("WebOptions").field("address", &self.address).finish_non_exhaustive()
    }
}
