//! How a client connects, which limits it negotiates, and how long it waits.

use std::time::Duration;

/// The requested TPDU size as a binary logarithm: 1024 bytes, as most clients request.
pub(super) const TPDU: u8 = 10;

/// The connection type registered with a module, which has a limited number of connections per type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ConnectionKind {
    /// Programming device.
    #[default]
    ProgrammingDevice,
    /// Operator panel.
    OperatorPanel,
    /// S7 basic communication, as between controllers.
    Basic,
}

impl ConnectionKind {
    const fn code(self) -> u8 {
        match self {
            Self::ProgrammingDevice => 1,
            Self::OperatorPanel => 2,
            Self::Basic => 3,
        }
    }
}

/// Transport service access points of both sides.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tsaps {
    /// The TSAP of the client.
    pub calling: [u8; 2],
    /// The TSAP of the module.
    pub called: [u8; 2],
}

impl Tsaps {
    /// The TSAPs for a module at a rack (0 to 7) and slot (0 to 31), with this connection type.
    #[must_use]
    pub const fn of(kind: ConnectionKind, rack: u8, slot: u8) -> Self {
        Self { calling: [1, 0], called: [kind.code(), (rack & 7) << 5 | slot & 0x1F] }
    }

    /// The PLC of a control: rack 0, slot 2.
    #[must_use]
    pub const fn plc() -> Self {
        Self::of(ConnectionKind::ProgrammingDevice, 0, 2)
    }

    /// The NCK of a SINUMERIK solution line, with the TSAPs that data collectors use.
    #[must_use]
    pub const fn nck() -> Self {
        Self { calling: [4, 0], called: [0x0D, 4] }
    }
}

/// The delay between attempts to reconnect: it starts with `first` and doubles each time, up to `most`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Backoff {
    /// Before the second attempt; the first follows at once.
    pub first: Duration,
    /// The maximum delay.
    pub most: Duration,
}

/// The options of a connection.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// TSAPs of both sides.
    pub tsaps: Tsaps,
    /// The requested PDU size, 64 to 4096; modules of a SINUMERIK grant up to 960.
    pub pdu: u16,
    /// The requested number of parallel requests.
    pub jobs: u16,
    /// Maximum number of items per request. Modules accept as many as fit in a PDU. snap7's server closes the connection if a write request
    /// has more than 20 items, and answers only 20 items of a read request.
    pub items: u8,
    /// Time limit for connecting, and for the answer to a request.
    pub timeout: Duration,
    /// How long a request waits for the reconnect after a lost connection.
    pub patience: Duration,
    /// How a lost connection is reopened; `None`: not at all.
    pub reconnect: Option<Backoff>,
    /// The password that is sent on each connection.
    pub password: Option<[u8; 8]>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            tsaps: Tsaps::plc(),
            pdu: 960,
            jobs: 8,
            items: u8::MAX,
            timeout: Duration::from_secs(5),
            patience: Duration::from_secs(30),
            reconnect: Some(Backoff { first: Duration::from_millis(100), most: Duration::from_secs(5) }),
            password: None,
        }
    }
}

impl Options {
    /// For the NCK of a SINUMERIK.
    #[must_use]
    pub fn nck() -> Self {
        Self { tsaps: Tsaps::nck(), ..Self::default() }
    }
}

/// A password of one to eight ASCII characters, padded with blanks.
#[must_use]
pub fn password(text: &str) -> Option<[u8; 8]> {
    let mut password = [b' '; 8];
    let bytes = Some(text.as_bytes()).filter(|bytes| !bytes.is_empty() && bytes.is_ascii())?;
    password.get_mut(..bytes.len())?.copy_from_slice(bytes);
    Some(password)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_password_has_one_to_eight_ascii_characters() {
        assert_eq!(password("secret"), Some(*b"secret  "));
        assert_eq!(password("12345678"), Some(*b"12345678"));
        assert_eq!(["", "123456789", "gehe\u{ed}m"].map(password), [None; 3]);
    }
}
