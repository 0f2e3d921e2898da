//! How a conversation ended, for the log and the counters.

/// How a conversation ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// The client has gone.
    Left,
    /// The session ended: a disconnect request, or bytes of something else.
    Closed,
    /// It asked nothing for too long.
    Idle,
    /// It had asked nothing yet, and somebody else needed its place.
    GaveWay,
    /// It did not take its answers.
    Slow,
    /// The server ends.
    Server,
    /// A fault on purpose.
    Fault,
}

impl End {
    pub(super) const ALL: [Self; 7] =
        [Self::Left, Self::Closed, Self::Idle, Self::GaveWay, Self::Slow, Self::Server, Self::Fault];

    /// In one word, for whoever counts.
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
            Self::Left => "has left",
            Self::Closed => "was disconnected: what it sent is no S7 communication",
            Self::Idle => "was disconnected: it asked nothing for too long",
            Self::GaveWay => "was disconnected: it had asked nothing yet, and another client needed its place",
            Self::Slow => "was disconnected: it did not take its answers",
            Self::Server => "was disconnected: the server ends",
            Self::Fault => "was disconnected: a fault on purpose",
        })
    }
}
