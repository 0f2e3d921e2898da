//! `--opcua`: the OPC UA server, with the same rights as the S7 server.

use std::sync::Arc;

use super::arguments::Arguments;
use super::protects::refusal;
use crate::live::Live;
use crate::opcua::{OpcUaOptions, OpcUaServer, Rights, User};
use crate::s7::live::Terms;
use crate::source::Problem;

/// The environment variable with the password of a user begins so.
const PASSWORD: &str = "OPENNCK_OPCUA_PASSWORD_";

/// Opens the server, if it is wanted.
pub(super) fn open(live: &Live, arguments: &Arguments, terms: &Terms) -> Result<Option<OpcUaServer>, Problem> {
    let Some(address) = arguments.opcua.as_deref() else { return Ok(None) };
    let protected = terms.protected.clone();
    let serial_number = live.with(|machine| terms.serial_number(machine).to_owned());
    let options = OpcUaOptions {
        is_read_only: arguments.read_only,
        protects: Arc::new(move |machine, command| refusal(&protected, machine, command)),
        pki: arguments.opcua_pki.clone(),
        is_insecure: arguments.opcua_insecure,
        users: arguments.opcua_user.iter().map(|text| user(text)).collect::<Result<_, _>>()?,
        serial_number,
        ..OpcUaOptions::new(address)
    };
    OpcUaServer::open(live, options).map(Some)
}

fn user(text: &str) -> Result<User, Problem> {
    let named = text.split_once(':').filter(|(name, _)| !name.is_empty());
    let (name, rights) = named.ok_or_else(|| {
        Problem::new(
            format!("--opcua-user {text}: expected a name and rights"),
            "write it as panel:StateRead;PlcRead;PlcWrite, or admin:SinuReadAll;SinuWriteAll",
        )
    })?;
    let variable = format!("{PASSWORD}{name}");
    let password = std::env::var(&variable).ok().filter(|password| !password.is_empty()).ok_or_else(|| {
        Problem::new(format!("--opcua-user {name}: no password"), format!("set the environment variable {variable}"))
    })?;
    Ok(User { name: name.to_owned(), password, rights: Rights::parse(rights)? })
}

/// Where clients connect.
pub(super) fn banner(server: Option<&OpcUaServer>) -> String {
    let Some(server) = server else { return String::new() };
    let security = match server.security() {
        (true, true) => "with or without encryption",
        (false, true) => "with encryption",
        (_, false) => "without encryption",
    };
    server.addresses().iter().map(|address| format!("OPC UA on opc.tcp://{address}, {security}\n")).collect()
}
