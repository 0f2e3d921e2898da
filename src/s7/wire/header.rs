//! The header of an S7 PDU: `32`, its kind, a reference that the answer repeats, and the lengths of its two parts,
//! parameter and data. An acknowledgement has two more bytes: error class and error code.

use zerocopy::byteorder::big_endian::U16;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout, Unaligned};

/// The first byte of every S7 PDU.
pub const PROTOCOL: u8 = 0x32;

/// Kinds of PDU.
pub mod kind {
    /// A request.
    pub const JOB: u8 = 1;
    /// An acknowledgement without data; here used for every refusal of a job.
    pub const ACK: u8 = 2;
    /// An acknowledgement with data.
    pub const ACK_DATA: u8 = 3;
    /// All services except variables and jobs.
    pub const USER_DATA: u8 = 7;
}

/// Functions of a job.
pub mod function {
    /// Setup communication.
    pub const SETUP: u8 = 0xF0;
    /// Read variables.
    pub const READ: u8 = 0x04;
    /// Write variables.
    pub const WRITE: u8 = 0x05;
    /// Request download.
    pub const REQUEST_DOWNLOAD: u8 = 0x1A;
    /// Download block.
    pub const DOWNLOAD: u8 = 0x1B;
    /// Download ended.
    pub const END_DOWNLOAD: u8 = 0x1C;
    /// Start upload.
    pub const START_UPLOAD: u8 = 0x1D;
    /// Upload.
    pub const UPLOAD: u8 = 0x1E;
    /// End upload.
    pub const END_UPLOAD: u8 = 0x1F;
    /// Program invocation: start, and named services.
    pub const START: u8 = 0x28;
    /// PLC stop.
    pub const STOP: u8 = 0x29;
}

/// The first ten bytes.
#[derive(Clone, Copy, Debug, FromBytes, IntoBytes, Immutable, KnownLayout, Unaligned)]
#[repr(C)]
pub struct Header {
    /// `32`.
    pub protocol: u8,
    /// [`kind`].
    pub kind: u8,
    /// Always 0.
    pub redundancy: U16,
    /// The client's number for its request.
    pub reference: U16,
    /// Bytes of the parameter part.
    pub parameter_length: U16,
    /// Bytes of the data part.
    pub data_length: U16,
}

/// Error class and error code, as one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ErrorCode(pub u16);

impl ErrorCode {
    /// No error.
    pub const NONE: Self = Self(0);
    /// The service is not implemented on the module.
    pub const NOT_IMPLEMENTED: Self = Self(0x8104);
    /// No further upload at the same time.
    pub const NO_FURTHER_UPLOAD: Self = Self(0x8304);
    /// Invalid sequence of services: an upload that was not started, or that has no data left.
    pub const WRONG_SEQUENCE: Self = Self(0x8401);
    /// The function cannot be performed now.
    pub const CANNOT_BE_PERFORMED: Self = Self(0x8404);
    /// Wrong frame: lengths that do not match, or an answer that would be longer than the negotiated PDU.
    pub const WRONG_FRAME: Self = Self(0x8500);
    /// Syntax error in the name of a block.
    pub const BLOCK_NAME: Self = Self(0xD201);
    /// Syntax error in the parameters of the function.
    pub const FUNCTION_PARAMETERS: Self = Self(0xD202);
    /// No such block.
    pub const BLOCK_NOT_FOUND: Self = Self(0xD209);
    /// No (further) block of this type.
    pub const NO_BLOCK: Self = Self(0xD20E);
    /// Not permitted at the current protection level.
    pub const PROTECTED: Self = Self(0xD241);
    /// No system state list of this identifier.
    pub const WRONG_LIST: Self = Self(0xD401);
    /// No such index of the list.
    pub const WRONG_INDEX: Self = Self(0xD402);
    /// Too many logged-on clients.
    pub const TOO_MANY: Self = Self(0xD404);
    /// The service is not supported, or its parameters have a wrong syntax.
    pub const NOT_SUPPORTED: Self = Self(0xD405);
    /// Wrong password.
    pub const WRONG_PASSWORD: Self = Self(0xD602);
    /// No password to give.
    pub const NO_PASSWORD: Self = Self(0xD605);
    /// Date or time invalid.
    pub const WRONG_TIME: Self = Self(0xDC01);
}

/// A received PDU.
#[derive(Clone, Copy, Debug)]
pub struct Message<'a> {
    /// [`kind`].
    pub kind: u8,
    /// The client's number for its request.
    pub reference: u16,
    /// The error of the whole request in an acknowledgement; no error in other kinds.
    pub error: ErrorCode,
    /// The parameter part.
    pub parameter: &'a [u8],
    /// The data part.
    pub data: &'a [u8],
}

/// The reason why a PDU cannot be parsed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// Another protocol; there is no reference for an answer.
    Foreign,
    /// Its lengths do not match its bytes.
    Lengths {
        /// The reference for the answer.
        reference: u16,
        /// The kind in its header.
        kind: u8,
    },
}

impl<'a> Message<'a> {
    /// Parses a PDU; bytes after its declared end are ignored.
    ///
    /// # Errors
    /// It is not an S7 PDU, or it ends before its declared end.
    pub fn parse(pdu: &'a [u8]) -> Result<Self, Unreadable> {
        let Ok((header, rest)) = Header::ref_from_prefix(pdu) else {
            return Err(Unreadable::Foreign);
        };
        if header.protocol != PROTOCOL {
            return Err(Unreadable::Foreign);
        }
        let (kind, reference) = (header.kind, header.reference.get());
        let unreadable = Unreadable::Lengths { reference, kind };
        let (error, rest) = match (kind, rest) {
            (kind::ACK | kind::ACK_DATA, [class, code, rest @ ..]) => {
                (ErrorCode(u16::from_be_bytes([*class, *code])), rest)
            }
            (kind::ACK | kind::ACK_DATA, _) => return Err(unreadable),
            _ => (ErrorCode::NONE, rest),
        };
        let (parameter, rest) = rest.split_at_checked(header.parameter_length.get().into()).ok_or(unreadable)?;
        let data = rest.get(..usize::from(header.data_length.get())).ok_or(unreadable)?;
        Ok(Self { kind, reference, error, parameter, data })
    }
}
