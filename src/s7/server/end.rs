//! How a conversation ended, for the log and the counters.

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The client closed the connection.
    Left,
    /// The session ended: a disconnect request, or bytes of another protocol.
    Closed,
    /// Idle timeout.
    Idle,
    /// The client had not made a request, and another client needed its place.
    GaveWay,
    /// The client did not read its answers.
    Slow,
    /// The server stops.
    Server,
    /// Injected fault.
    Fault,
}

impl End {
    pub(super) const ALL: [Self; 7] =
        [Self::Left, Self::Closed, Self::Idle, Self::GaveWay, Self::Slow, Self::Server, Self::Fault];

    /// A label for the counters.
    pub(super) const fn name(self) -> &'static str {
        match self {
            Self::Left => "left",
            Self::Closed => "closed",
            Self::Idle => "idle",
            Self::GaveWay => "gave_way",
            Self::Slow => "slow",
            Self::Server => "server",
            Self::Fault => "fault",
        }
    }
}

impl std::fmt::Display for End {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Left => "disconnected",
            Self::Closed => "closed: the client does not use S7 communication",
            Self::Idle => "closed: idle timeout",
            Self::GaveWay => "closed: no request so far, and the client limit is reached",
            Self::Slow => "closed: the client did not read its answers",
            Self::Server => "closed: the server stops",
            Self::Fault => "closed: injected fault",
        })
    }
}
