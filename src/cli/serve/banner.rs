//! What `opennck serve` says before the first client comes: what is served, from which files, and on which terms.

use std::net::SocketAddr;

use super::arguments::Arguments;
use crate::live::Opened;
use crate::s7::live::Terms;

/// The machine, its program and its files.
pub(super) fn machine(opened: &Opened, arguments: &Arguments) -> String {
    let machine = &opened.machine;
    let plc = match (&opened.plc, &arguments.image) {
        (Some(name), _) => format!("PLC program {name}"),
        (None, Some(file)) => format!("PLC program in another process, by {}", file.display()),
        (None, None) => "no PLC program: clients write the PLC's side".to_owned(),
    };
    let axes: Vec<_> = machine.names().axes.iter().filter_map(|(_, name)| name.clone()).collect();
    let cycle = machine.cycle_time().seconds() * 1000.0;
    let mut text = format!("{}: axes {}, a cycle of {cycle} ms, {plc}\n", opened.path.display(), axes.join(", "));
    text += &format!("profile {}", machine.names().profile.name());
    match &opened.image {
        Some(file) => text += &format!(", PLC image {}", file.display()),
        None => text += ", no PLC image",
    }
    if let Some(file) = &arguments.image {
        let how = if arguments.lock_step { "lock-step" } else { "no lock-step" };
        text += &format!(", image file {} ({how}, time-out {:?})", file.display(), arguments.plc_timeout);
    }
    text += "\n";
    if let Some(scenario) = &arguments.scenario {
        text += &format!("scenario {}\n", scenario.display());
    }
    text
}

/// Where clients connect, and what they may do there.
pub(super) fn doors(addresses: &[SocketAddr], arguments: &Arguments, terms: &Terms) -> String {
    let rights = match (arguments.read_only, terms.protected.is_empty()) {
        (true, _) => "read only",
        (false, true) => "read and write",
        (false, false) => "read and write but for what --protect names",
    };
    let level = terms.protection.level;
    let password = if level > 1 { " with a password" } else { "" };
    let pdu = arguments.pdu;
    let line = |address| {
        format!(
            "S7 on {address}: rack 0, slot 2, {rights}, protection level {level}{password}, PDU up to {pdu} bytes\n"
        )
    };
    addresses.iter().map(line).collect()
}
