//! The meaning of return codes of items and of errors of whole requests as text: for the log and the metrics of a server, and for the
//! errors of a client. The numbers are from Siemens' lists; an unknown code reads "refused".

use super::header::ErrorCode;

/// The meaning of the return code of an item.
#[must_use]
pub const fn of_item(code: u8) -> &'static str {
    match code {
        0x00 => "no data",
        0x01 => "hardware fault",
        0x03 => "access is not allowed",
        0x05 => "the address is out of range",
        0x06 => "the data type is not supported",
        0x07 => "the data type or the length does not match",
        0x0A => "the object does not exist",
        _ => "refused",
    }
}

/// The meaning of the error of a whole request.
#[must_use]
pub const fn of_request(error: ErrorCode) -> &'static str {
    match error {
        ErrorCode::NOT_IMPLEMENTED => "the module does not have this service",
        ErrorCode::NO_FURTHER_UPLOAD => "too many uploads at the same time",
        ErrorCode::WRONG_SEQUENCE => "wrong order of requests",
        ErrorCode::CANNOT_BE_PERFORMED => "the function cannot be performed now",
        ErrorCode::WRONG_FRAME => "the lengths do not match, or the answer would be longer than a PDU",
        ErrorCode::BLOCK_NAME => "invalid block name",
        ErrorCode::FUNCTION_PARAMETERS => "wrong parameters",
        ErrorCode::BLOCK_NOT_FOUND => "the block does not exist",
        ErrorCode::NO_BLOCK => "there is no block of this type",
        ErrorCode::PROTECTED => "not permitted at this protection level",
        ErrorCode::WRONG_LIST => "the list does not exist",
        ErrorCode::WRONG_INDEX => "the list does not have this index",
        ErrorCode::TOO_MANY => "too many subscriptions",
        ErrorCode::NOT_SUPPORTED => "the module does not support it",
        ErrorCode::WRONG_PASSWORD => "wrong password",
        ErrorCode::NO_PASSWORD => "the module has no password",
        ErrorCode::WRONG_TIME => "invalid date or time",
        ErrorCode(_) => "refused",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::s7::wire::data::Refusal;

    #[test]
    fn every_refusal_of_this_server_has_a_text() {
        let refusals = [
            Refusal::NotAllowed,
            Refusal::OutOfRange,
            Refusal::TypeNotSupported,
            Refusal::TypeInconsistent,
            Refusal::DoesNotExist,
        ];
        for refusal in refusals {
            assert_ne!(of_item(refusal.code()), "refused", "{refusal:?}");
        }
        // The numbers are those of the lists.
        for error in [
            0x8104, 0x8304, 0x8401, 0x8404, 0x8500, 0xD201, 0xD202, 0xD209, 0xD20E, 0xD241, 0xD401, 0xD402, 0xD404,
            0xD405, 0xD602, 0xD605, 0xDC01,
        ] {
            assert_ne!(of_request(ErrorCode(error)), "refused", "{error:04X}");
        }
        assert_eq!((of_item(0x42), of_request(ErrorCode(0x4242))), ("refused", "refused"));
    }
}
