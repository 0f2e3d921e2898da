//! `--protect` for servers that order commands: the same rights as those of S7 clients.

use crate::machine::{Command, Machine};
use crate::s7::Protected;

/// Why `--protect` forbids a command, if it does.
pub(super) fn refusal(protected: &[Protected], machine: &Machine, command: &Command) -> Option<String> {
    let covers = |one: &Protected| match command.location() {
        Some(location) => {
            let address = machine.names().address(location);
            one.covers(address.area, address.byte.into(), location.bytes())
        }
        None => {
            *one == Protected::NcVariables
                && matches!(command, Command::MachineDatum { .. } | Command::RParameter { .. })
        }
    };
    protected.iter().any(covers).then(|| "the address is protected (--protect)".to_owned())
}
