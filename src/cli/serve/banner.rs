//! What `opennck serve` prints at its start: the machine, its files, and the terms for clients.

use std::net::SocketAddr;

use super::arguments::Arguments;
use crate::live::Opened;
use crate::s7::live::Terms;

/// The machine, its program and its files.
pub(super) fn machine(opened: &Opened, arguments: &Arguments) -> String {
    let machine = &opened.machine;
    let plc = match (opened.plc.as_ref().or(opened.plc_process.as_ref()), &arguments.image) {
        (Some(name), _) => format!("PLC program {name}"),
        (None, Some(file)) => format!("PLC program in another process, through {}", file.display()),
        (None, None) if machine.own_program().is_some() => {
            format!("PLC program {} of the machine", machine.own_program().map_or("", |(name, _)| name))
        }
        (None, None) => "no PLC program: clients write the PLC signals".to_owned(),
    };
    let axes: Vec<_> = machine.names().axes.iter().filter_map(|(_, name)| name.clone()).collect();
    let cycle = machine.cycle_time().seconds() * 1000.0;
    let mut text = format!("{}: axes {}, cycle {cycle} ms, {plc}\n", opened.path.display(), axes.join(", "));
    text += &format!("profile {}", machine.names().profile.name());
    match &opened.image {
        Some(file) => text += &format!(", PLC image {}", file.display()),
        None => text += ", no PLC image",
    }
    if let Some(file) = &arguments.image {
        let how = if arguments.lock_step { "lock-step" } else { "without lock-step" };
        text += &format!(", image file {} ({how}, time-out {:?})", file.display(), arguments.plc_timeout);
    }
    text += "\n";
    if let Some(scenario) = &arguments.scenario {
        text += &format!("scenario {}\n", scenario.display());
    }
    text
}

/// Where clients connect, and what they may do.
pub(super) fn endpoints(addresses: &[SocketAddr], arguments: &Arguments, terms: &Terms) -> String {
    let rights = match (arguments.read_only, terms.protected.is_empty()) {
        (true, _) => "read only",
        (false, true) => "read and write",
        (false, false) => "read and write except --protect",
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
