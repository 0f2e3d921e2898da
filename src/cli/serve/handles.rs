//! The limit on open files and sockets of this process: each client uses one.

use std::fmt::Display;

/// Handles that the program needs besides its clients: listeners, files, the event queue of the system.
const BESIDE: u64 = 64;

/// Raises the limit to what the clients need; returns a warning if the system grants less.
pub(super) fn allow(clients: usize) -> Option<impl Display> {
    let wanted = u64::try_from(clients).unwrap_or(u64::MAX).saturating_add(BESIDE);
    // It raises the soft limit up to the hard limit, which any process may do.
    let given = rlimit::increase_nofile_limit(wanted).ok()?;
    (given < wanted).then(|| {
        let clients = given.saturating_sub(BESIDE);
        format!(
            "--clients needs {wanted} open files, the system allows {given}: about {clients} clients can connect; `ulimit -Hn` shows \
             the limit"
        )
    })
}
