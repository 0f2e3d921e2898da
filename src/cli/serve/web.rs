//! `--web`: the live page, with the same rights as the S7 server.

use std::path::Path;
use std::sync::Arc;

use super::arguments::Arguments;
use super::protects::refusal;
use crate::live::{Live, LiveOptions, Opened};
use crate::s7::live::Terms;
use crate::source::Problem;
use crate::web::{WebOptions, WebServer};

/// The options of the page, if it is served.
pub(super) fn options(arguments: &Arguments, opened: &Opened, terms: &Terms) -> Option<WebOptions> {
    let address = arguments.web.as_deref()?;
    let (networks, protected) = (arguments.allow.clone(), terms.protected.clone());
    Some(WebOptions {
        hosts: arguments.web_host.clone(),
        is_read_only: arguments.read_only,
        admits: Arc::new(move |peer| networks.is_empty() || networks.iter().any(|network| network.contains(peer))),
        protects: Arc::new(move |machine, command| refusal(&protected, machine, command)),
        ..WebOptions::new(address, opened)
    })
}

/// Adds what the page needs of the machine: its last minutes, and everything since power on as a scenario for a file in this folder.
pub(super) fn with_history(live: LiveOptions, arguments: &Arguments, opened: &Opened) -> LiveOptions {
    if arguments.web.is_none() {
        return live;
    }
    // Without a transcript, the page says that the session cannot be saved.
    let transcript = opened.transcript(Path::new("session.toml")).ok().filter(|_| arguments.image.is_none());
    LiveOptions { keeps_history: true, transcript, ..live }
}

/// Opens the page.
pub(super) fn open(live: &Live, options: Option<WebOptions>) -> Result<Option<WebServer>, Problem> {
    options.map(|options| WebServer::open(live, options)).transpose()
}

/// Where the page is.
pub(super) fn banner(server: Option<&WebServer>) -> String {
    let Some(server) = server else { return String::new() };
    let token = server.token().map_or_else(String::new, |token| format!("#token={token}"));
    server.addresses().iter().map(|address| format!("page on http://{address}/{token}\n")).collect()
}
