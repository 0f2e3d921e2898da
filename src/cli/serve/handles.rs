//! How many files and sockets the system lets this process have: each client is one.

use std::fmt::Display;

/// What the program needs besides its clients: listeners, files, the system's events.
const BESIDE: u64 = 64;

/// Asks the system for enough handles; says so where it does not give them.
pub(super) fn allow(clients: usize) -> Option<impl Display> {
    let wanted = u64::try_from(clients).unwrap_or(u64::MAX).saturating_add(BESIDE);
    // It asks for no more than what anybody may have.
    let given = rlimit::increase_nofile_limit(wanted).ok()?;
    (given < wanted).then(|| {
        let clients = given.saturating_sub(BESIDE);
        format!("expected {wanted} handles for --clients, found {given}: about {clients} clients find a place; `ulimit -Hn` tells the limit")
    })
}
