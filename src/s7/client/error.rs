//! The errors of a client. Each names the request, what was found, and what to do.

use std::fmt;
use std::time::Duration;

use crate::s7::wire::codes;
use crate::s7::wire::header::ErrorCode;

/// Whether a request without an answer may have been executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Execution {
    /// It was not sent.
    NotSent,
    /// It was sent and only reads: nothing was changed.
    Read,
    /// It was sent and changes something: read the value before you repeat it.
    PerhapsExecuted,
}

/// The reason why a request failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Error {
    /// An invalid address, value or type. Nothing was sent, or what was read has another type.
    Input {
        /// What was expected and what was found.
        what: String,
        /// The remedy.
        cure: String,
    },
    /// The host cannot be reached.
    Unreachable {
        /// The host.
        host: String,
        /// The error of the system.
        cause: String,
    },
    /// The host answers, but does not accept the connection or uses another protocol.
    NotAccepted {
        /// The host.
        host: String,
        /// The called TSAP.
        called: [u8; 2],
        /// What was received instead.
        cause: String,
    },
    /// One item was refused; the other items of the same request are not affected.
    Refused {
        /// The item.
        what: String,
        /// Return code of the item.
        code: u8,
    },
    /// A whole request was refused.
    Rejected {
        /// The request.
        what: String,
        /// Error class and error code.
        error: ErrorCode,
    },
    /// No answer arrived in time.
    TimedOut {
        /// The request.
        what: String,
        /// The time limit.
        after: Duration,
        /// Whether it may have been executed.
        execution: Execution,
    },
    /// The connection was lost, and the request was not repeated.
    Lost {
        /// The request.
        what: String,
        /// Whether it may have been executed.
        execution: Execution,
        /// The reason.
        cause: String,
    },
    /// An answer does not fit the request.
    Unexpected {
        /// The request.
        what: String,
        /// What was received.
        found: String,
    },
}

impl Error {
    /// Whether the connection caused the error, not the request.
    #[must_use]
    pub fn is_of_the_connection(&self) -> bool {
        match self {
            Self::Unreachable { .. } | Self::NotAccepted { .. } | Self::TimedOut { .. } | Self::Lost { .. } => true,
            Self::Input { .. } | Self::Refused { .. } | Self::Rejected { .. } | Self::Unexpected { .. } => false,
        }
    }

    /// The remedy.
    #[must_use]
    pub fn cure(&self) -> String {
        match self {
            Self::Input { cure, .. } => cure.clone(),
            Self::Unreachable { .. } => {
                "check the address, the port (102 on a module, 10102 with `opennck serve`) and whether the server runs".to_owned()
            }
            Self::NotAccepted { called: [kind, place], .. } => format!(
                "the called TSAP was {kind:02X}{place:02X} (rack {}, slot {}): try another rack, slot or connection type",
                place >> 5,
                place & 0x1F
            ),
            Self::Refused { what, code } if is_of_the_nck(what) => cure_of_nc_code(*code).to_owned(),
            Self::Refused { code, .. } => cure_of_code(*code).to_owned(),
            Self::Rejected { what, error: ErrorCode::NOT_IMPLEMENTED } if is_of_the_nck(what) => {
                "the called module has no NC variables: the NCK is at TSAP 0D04 (slot 4) on an 840D sl or 828D, at 0103 \
                (slot 3) on an 840D powerline; use --nck-tsap 0400:0D04"
                    .to_owned()
            }
            Self::Rejected { error, .. } => cure_of_error(*error).to_owned(),
            Self::TimedOut { execution: Execution::Read, .. } => {
                "the module is connected and does not answer: check whether it is overloaded, or increase the timeout".to_owned()
            }
            Self::Lost { execution: Execution::Read, .. } => "nothing was changed: repeat it".to_owned(),
            Self::TimedOut { execution: Execution::PerhapsExecuted, .. } => {
                "the request may have been executed: read the value before you repeat it, or increase the timeout".to_owned()
            }
            Self::TimedOut { execution: Execution::NotSent, .. } => "the request was not sent: check the connection, then repeat it".to_owned(),
            Self::Lost { execution: Execution::PerhapsExecuted, .. } => "the request was sent and may have been executed: read the value before you repeat it".to_owned(),
            Self::Lost { execution: Execution::NotSent, .. } => {
                "the request was not sent: repeat it after the reconnect".to_owned()
            }
            Self::Unexpected { .. } => "the server violates the protocol: report it to its manufacturer".to_owned(),
        }
    }

    /// The same error for another request text.
    #[must_use]
    pub(super) fn of(self, what: &str) -> Self {
        let what = what.to_owned();
        match self {
            Self::Refused { code, .. } => Self::Refused { what, code },
            Self::Rejected { error, .. } => Self::Rejected { what, error },
            Self::TimedOut { after, execution, .. } => Self::TimedOut { what, after, execution },
            Self::Lost { execution, cause, .. } => Self::Lost { what, execution, cause },
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
            Self::NotAccepted { host, cause, .. } => write!(f, "{host} does not accept the connection: {cause}"),
            Self::Refused { what, code } => write!(f, "{what}: {} (return code {code:02X})", codes::of_item(*code)),
            Self::Rejected { what, error } => {
                write!(f, "{what}: {} (error {:04X})", codes::of_request(*error), error.0)
            }
            Self::TimedOut { what, after, execution } => {
                let sent = match execution {
                    Execution::NotSent => "; the request was not sent",
                    Execution::Read | Execution::PerhapsExecuted => "",
                };
                write!(f, "{what}: no answer within {} s{sent}", after.as_secs_f64())
            }
            Self::Lost { what, execution, cause } => {
                let sent = match execution {
                    Execution::NotSent => "the request was not sent",
                    Execution::Read | Execution::PerhapsExecuted => "the request was sent",
                };
                write!(f, "{what}: connection lost ({cause}); {sent}")
            }
            Self::Unexpected { what, found } => write!(f, "{what}: invalid answer: {found}"),
        }
    }
}

/// Whether the error is about an NC variable, which is written in this form.
fn is_of_the_nck(what: &str) -> bool {
    what.starts_with("nck:")
}

/// The remedy by the return code of an item.
fn cure_of_code(code: u8) -> &'static str {
    match code {
        0x03 => "the server is read-only, or the value cannot be written",
        0x05 => "`opennck s7 info` lists the blocks and their lengths",
        0x06 | 0x07 => "read it as bytes (DBB)",
        0x0A => "`opennck s7 info` lists the blocks",
        _ => "see the manual of the module",
    }
}

fn cure_of_nc_code(code: u8) -> &'static str {
    match code {
        0x03 => "the server is read-only, or only the NCK sets the value",
        0x05 => "the row or unit does not exist: both count from 1, so [1] is the first axis, and R5 is row 6",
        0x06 | 0x07 => "give the type after the column, nck:A1/M/32000:DOUBLE, or omit it for raw bytes",
        0x0A => {
            "this NCK does not have it: `opennck s7 nck` lists the names; address machine data by number (nck:A1/M/32000:DOUBLE)"
        }
        _ => "see the manual of the control",
    }
}

/// The remedy by the error of a whole request.
fn cure_of_error(error: ErrorCode) -> &'static str {
    match error {
        ErrorCode::NOT_IMPLEMENTED => {
            "the called module does not have this function: the PLC of a control is in slot 2, its NCK in slot 4 (3 on powerline)"
        }
        ErrorCode::PROTECTED => "give the password",
        ErrorCode::WRONG_PASSWORD => "check --password and OPENNCK_S7_PASSWORD; passwords are case-sensitive",
        ErrorCode::WRONG_LIST | ErrorCode::WRONG_INDEX => "read list 0000 for the available lists",
        _ => "see the manual of the module",
    }
}
