//! How a client connects, what it asks for, and how long it waits.

use std::time::Duration;

/// The length of a TPDU that is asked for, as a binary logarithm: 1024, as most clients do.
pub(super) const TPDU: u8 = 10;

/// As what a client registers with a module, which has a number of places for each kind.
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

/// Who calls whom: transport service access points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tsaps {
    /// Of the client.
    pub calling: [u8; 2],
    /// Of the module.
    pub called: [u8; 2],
}

impl Tsaps {
    /// A module by rack (0 to 7) and slot (0 to 31), called as this kind of client.
    #[must_use]
    pub const fn of(kind: ConnectionKind, rack: u8, slot: u8) -> Self {
        Self { calling: [1, 0], called: [kind.code(), (rack & 7) << 5 | slot & 0x1F] }
    }

    /// The PLC of a control: rack 0, slot 2.
    #[must_use]
    pub const fn plc() -> Self {
        Self::of(ConnectionKind::ProgrammingDevice, 0, 2)
    }

    /// The NCK of a SINUMERIK solution line, as data collectors call it.
    #[must_use]
    pub const fn nck() -> Self {
        Self { calling: [4, 0], called: [0x0D, 4] }
    }
}

/// How long to wait between attempts to connect again: the first time, then twice as long each time, up to the most.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Backoff {
    /// Before the second attempt; the first follows at once.
    pub first: Duration,
    /// Never longer than that.
    pub most: Duration,
}

/// How a client connects and what it asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Options {
    /// Who calls whom.
    pub tsaps: Tsaps,
    /// The longest PDU that is asked for, 64 to 4096; modules of a SINUMERIK grant up to 960.
    pub pdu: u16,
    /// How many requests on their way at once are asked for.
    pub jobs: u16,
    /// How many items one request may have. As many as fit is what modules take; snap7's server ends on more than 20 in a write
    /// request and cuts a read request to 20.
    pub items: u8,
    /// How long connecting may take, and the answer to a request.
    pub timeout: Duration,
    /// How long a request waits until a lost connection is there again.
    pub patience: Duration,
    /// How a lost connection is opened again; none: not at all.
    pub reconnect: Option<Backoff>,
    /// Given to the module on each connection.
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

/// A password of one to eight ASCII characters, filled with blanks.
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
