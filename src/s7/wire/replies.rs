//! The answers to a client: total views of acknowledgements, data items and user data. Any input gives a value or `None`, and nothing is
//! read beyond the received bytes.

use super::data::{SUCCESS, TransportSize};
use super::header::{ErrorCode, function};

/// The result of setup communication.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Setup {
    /// Maximum number of parallel requests.
    pub jobs: u16,
    /// Bytes of a PDU.
    pub pdu: u16,
}

impl Setup {
    /// Parses the parameter part of the answer.
    #[must_use]
    pub fn parse(parameter: &[u8]) -> Option<Self> {
        let &[function::SETUP, _, j1, j0, _, _, p1, p0] = parameter else {
            return None;
        };
        Some(Self { jobs: u16::from_be_bytes([j1, j0]), pdu: u16::from_be_bytes([p1, p0]) })
    }
}

/// The data items of an answer to a read request, in order: return code, and the value if there is one.
#[derive(Clone, Copy, Debug)]
pub struct DataItems<'a> {
    rest: &'a [u8],
}

impl<'a> DataItems<'a> {
    /// The items of a data part.
    #[must_use]
    pub fn new(data: &'a [u8]) -> Self {
        Self { rest: data }
    }
}

impl<'a> Iterator for DataItems<'a> {
    /// The value, or the return code of a refusal.
    type Item = Result<&'a [u8], u8>;

    /// Ends at the first incomplete item.
    fn next(&mut self) -> Option<Self::Item> {
        let [code, size, high, low, rest @ ..] = self.rest else {
            return None;
        };
        if *code != SUCCESS {
            // A refusal has no value, whatever its length field is; one server sends length 4.
            self.rest = rest;
            return Some(Err(*code));
        }
        let length = TransportSize(*size).bytes(u16::from_be_bytes([*high, *low]));
        let (value, rest) = rest.split_at_checked(length)?;
        // A fill byte follows a value of odd length, unless it is the last.
        self.rest = if length % 2 == 1 { rest.get(1..).unwrap_or(&[]) } else { rest };
        Some(Ok(value))
    }
}

/// A user data PDU of a module: an answer or a push.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UserData<'a> {
    /// Whether it is a push.
    pub is_push: bool,
    /// Group of functions.
    pub group: u8,
    /// Function in its group.
    pub function: u8,
    /// Number in a sequence, or of a job.
    pub sequence: u8,
    /// Number of the data unit.
    pub unit: u8,
    /// Whether more parts follow.
    pub more: bool,
    /// The error code.
    pub error: ErrorCode,
    /// Return code of the data item.
    pub code: u8,
    /// The payload.
    pub payload: &'a [u8],
}

impl<'a> UserData<'a> {
    /// Parses parameter and data part.
    #[must_use]
    pub fn parse(parameter: &[u8], data: &'a [u8]) -> Option<Self> {
        let &[0, 1, 0x12, length, 0x12, kind_group, function, sequence, unit, more, e1, e0] = parameter else {
            return None;
        };
        let is_push = match kind_group >> 4 {
            0 => true,
            8 => false,
            _ => return None,
        };
        if length != 8 {
            return None;
        }
        let (code, payload) = match data {
            [] => (0x0A, &[][..]),
            [code, size, high, low, rest @ ..] => {
                let length = TransportSize(*size).bytes(u16::from_be_bytes([*high, *low]));
                // Without success there is no value, whatever the length field is.
                (*code, if *code == SUCCESS { rest.get(..length)? } else { &[] })
            }
            _ => return None,
        };
        let error = ErrorCode(u16::from_be_bytes([e1, e0]));
        let group = kind_group & 0xF;
        Some(Self { is_push, group, function, sequence, unit, more: more != 0, error, code, payload })
    }
}

/// The number of a started upload, and its total length.
#[must_use]
pub fn upload_begun(parameter: &[u8]) -> Option<([u8; 4], usize)> {
    let [function::START_UPLOAD, _, _, _, number @ ..] = parameter else {
        return None;
    };
    let (number, rest) = number.split_first_chunk::<4>()?;
    let (length, rest) = rest.split_first()?;
    let digits = std::str::from_utf8(rest.get(..usize::from(*length))?).ok()?;
    Some((*number, digits.parse().ok()?))
}

/// A piece of an upload, and whether another one follows.
#[must_use]
pub fn upload_piece<'a>(parameter: &[u8], data: &'a [u8]) -> Option<(&'a [u8], bool)> {
    let ([function::UPLOAD, status, ..], [high, low, _, _, piece @ ..]) = (parameter, data) else {
        return None;
    };
    let length = usize::from(u16::from_be_bytes([*high, *low]));
    Some((piece.get(..length)?, status & 1 == 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn refused_items_have_no_value_whatever_their_length_says() {
        // snap7's server sends a length of 4 after the code of a refusal.
        let data = [0x0A, 0, 0, 4, 0xFF, 4, 0, 8, 0x11, 0, 5, 0, 0, 0, 0xFF, 9, 0, 1, 0x22];
        let items: Vec<_> = DataItems::new(&data).collect();
        assert_eq!(items, [Err(0x0A), Ok(&[0x11][..]), Err(5), Ok(&[0x22])]);
    }

    #[test]
    fn an_item_that_is_not_whole_ends_them() {
        assert_eq!(DataItems::new(&[0xFF, 4, 0, 16, 1]).count(), 0);
        assert_eq!(DataItems::new(&[0xFF, 4, 0xFF, 0xFF]).count(), 0);
        assert_eq!(DataItems::new(&[0xFF, 4, 0]).count(), 0);
    }

    #[test]
    fn answers_and_pushes_are_told_apart() {
        let answer = UserData::parse(&[0, 1, 0x12, 8, 0x12, 0x84, 1, 7, 7, 1, 0, 0], &[0xFF, 9, 0, 2, 1, 2]).unwrap();
        assert_eq!((answer.is_push, answer.group, answer.sequence, answer.more), (false, 4, 7, true));
        assert_eq!(answer.payload, [1, 2]);
        let push = UserData::parse(&[0, 1, 0x12, 8, 0x12, 0x02, 1, 3, 0, 0, 0, 0], &[0xFF, 9, 0, 0]).unwrap();
        assert!(push.is_push);
        let error = UserData::parse(&[0, 1, 0x12, 8, 0x12, 0x84, 1, 7, 0, 0, 0xD4, 2], &[0x0A, 0, 0, 0]).unwrap();
        assert_eq!(error.error, ErrorCode::WRONG_INDEX);
        assert_eq!(UserData::parse(&[0, 1, 0x12, 8, 0x12, 0x44, 1, 7, 0, 0, 0, 0], &[]), None);
    }
}
