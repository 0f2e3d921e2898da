//! What can go wrong: each error says what was asked, what came, and what to do.

use std::fmt;
use std::time::Duration;

use crate::s7::wire::codes;
use crate::s7::wire::header::ErrorCode;

/// Why a client has no answer, or not the one that was hoped for.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// An address or a value that is none; nothing was sent.
    Input {
        /// What was expected and what came.
        what: String,
        /// What to do.
        cure: String,
    },
    /// Nobody answers there.
    Unreachable {
        /// Who was called.
        host: String,
        /// What the system says.
        cause: String,
    },
    /// Somebody answers, and does not take the connection or speaks something else.
    NotAccepted {
        /// Who was called.
        host: String,
        /// With which TSAP.
        called: [u8; 2],
        /// What came instead.
        cause: String,
    },
    /// One item was refused; others of the same request are not affected.
    Refused {
        /// Which.
        what: String,
        /// Return code of the item.
        code: u8,
    },
    /// A whole request was refused.
    Rejected {
        /// What was asked.
        what: String,
        /// Class and code.
        error: ErrorCode,
    },
    /// No answer came in time.
    TimedOut {
        /// What was asked.
        what: String,
        /// How long was waited.
        after: Duration,
        /// Whether it was sent; a write that was sent may have been done.
        sent: bool,
    },
    /// The connection was lost, and what was asked was not asked again.
    Lost {
        /// What was asked.
        what: String,
        /// Whether it was sent; a write that was sent may have been done.
        sent: bool,
        /// Why.
        cause: String,
    },
    /// An answer came that does not fit the question.
    Unexpected {
        /// What was asked.
        what: String,
        /// What came.
        found: String,
    },
}

impl Error {
    /// Whether the connection is to blame and not what was asked.
    #[must_use]
    pub fn is_of_the_connection(&self) -> bool {
        match self {
            Self::Unreachable { .. } | Self::NotAccepted { .. } | Self::TimedOut { .. } | Self::Lost { .. } => true,
            Self::Input { .. } | Self::Refused { .. } | Self::Rejected { .. } | Self::Unexpected { .. } => false,
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn cure(&self) -> String {
        match self {
            Self::Input { cure, .. } => cure.clone(),
            Self::Unreachable { .. } => {
                "check address and port (102 on a module, 10102 of `opennck serve`) and whether it runs".to_owned()
            }
            Self::NotAccepted { called: [kind, place], .. } => format!(
                "it was called as {kind:02X}{place:02X} (rack {}, slot {}): try another rack, slot or kind of connection",
                place >> 5,
                place & 0x1F
            ),
            Self::Refused { what, code } if is_of_the_nck(what) => cure_of_nc_code(*code).to_owned(),
            Self::Refused { code, .. } => cure_of_code(*code).to_owned(),
            Self::Rejected { what, error: ErrorCode::NOT_IMPLEMENTED } if is_of_the_nck(what) => {
                "what was called has no NC variables: the NCK is at TSAP 0D04 (slot 4) of an 840D sl or 828D, at 0103 \
                (slot 3) of an 840D powerline; say --nck-tsap 0400:0D04"
                    .to_owned()
            }
            Self::Rejected { error, .. } => cure_of_error(*error).to_owned(),
            Self::TimedOut { sent: true, .. } => {
                "it may have been done: read before you repeat it, or allow more time".to_owned()
            }
            Self::TimedOut { sent: false, .. } => "it was not sent: check the connection, then repeat it".to_owned(),
            Self::Lost { sent: true, .. } => "it was sent and may have been done: read before you repeat it".to_owned(),
            Self::Lost { sent: false, .. } => {
                "it was not sent: repeat it when the connection is there again".to_owned()
            }
            Self::Unexpected { .. } => "the server does not keep to the protocol: report it to its maker".to_owned(),
        }
    }

    /// The same error, of something else that was asked.
    #[must_use]
    pub(super) fn of(self, what: &str) -> Self {
        let what = what.to_owned();
        match self {
            Self::Refused { code, .. } => Self::Refused { what, code },
            Self::Rejected { error, .. } => Self::Rejected { what, error },
            Self::TimedOut { after, sent, .. } => Self::TimedOut { what, after, sent },
            Self::Lost { sent, cause, .. } => Self::Lost { what, sent, cause },
            Self::Unexpected { found, .. } => Self::Unexpected { what, found },
            other @ (Self::Input { .. } | Self::Unreachable { .. } | Self::NotAccepted { .. }) => other,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Input { what, .. } => f.write_str(what),
            Self::Unreachable { host, cause } => write!(f, "{host} cannot be reached: {cause}"),
            Self::NotAccepted { host, cause, .. } => write!(f, "{host} does not take the connection: {cause}"),
            Self::Refused { what, code } => write!(f, "{what}: {} (return code {code:02X})", codes::of_item(*code)),
            Self::Rejected { what, error } => {
                write!(f, "{what}: {} (error {:04X})", codes::of_request(*error), error.0)
            }
            Self::TimedOut { what, after, sent } => {
                let sent = if *sent { "" } else { "; it was not sent" };
                write!(f, "{what}: no answer within {} s{sent}", after.as_secs_f64())
            }
            Self::Lost { what, sent, cause } => {
                let sent = if *sent { "it was sent" } else { "it was not sent" };
                write!(f, "{what}: the connection was lost ({cause}); {sent}")
            }
            Self::Unexpected { what, found } => write!(f, "{what}: an answer that does not fit: {found}"),
        }
    }
}

/// Whether NC variables were asked for, which are written so.
fn is_of_the_nck(what: &str) -> bool {
    what.starts_with("nck:")
}

/// By the return code of an item.
fn cure_of_code(code: u8) -> &'static str {
    match code {
        0x03 => "the server allows reading only, or the value cannot be set",
        0x05 => "`opennck s7 info` lists the blocks and how long they are",
        0x06 | 0x07 => "read it as bytes (DBB)",
        0x0A => "`opennck s7 info` lists the blocks",
        _ => "see the manual of the module",
    }
}

fn cure_of_nc_code(code: u8) -> &'static str {
    match code {
        0x03 => "the server allows reading only, or the NCK alone sets it",
        0x05 => "there is no such row or unit: both count from 1, so [1] is the first axis, and R5 is row 6",
        0x06 | 0x07 => "give its type behind the column, nck:A1/M/32000:DOUBLE, or none for the bytes as they come",
        0x0A => {
            "this NCK does not have it: `opennck s7 nck` lists names, machine data go by number (nck:A1/M/32000:DOUBLE)"
        }
        _ => "see the manual of the control",
    }
}

/// By the error of a whole request.
fn cure_of_error(error: ErrorCode) -> &'static str {
    match error {
        ErrorCode::NOT_IMPLEMENTED => {
            "what was called does not have this function: the PLC of a control is in slot 2, its NCK in slot 4 (3 on powerline)"
        }
        ErrorCode::PROTECTED => "give the password",
        ErrorCode::WRONG_PASSWORD => "check --password and OPENNCK_S7_PASSWORD: capitals count",
        ErrorCode::WRONG_LIST | ErrorCode::WRONG_INDEX => "list 0000 tells which lists there are",
        _ => "see the manual of the module",
    }
}
