//! What return codes of items and errors of whole requests mean, in words: for the log and the metrics of a server, and for the
//! errors of a client. The numbers are of Siemens' lists; what is not known here is a refusal like any other.

use super::header::ErrorCode;

/// What the return code of an item means.
#[must_use]
pub const fn of_item(code: u8) -> &'static str {
    match code {
        0x00 => "nothing came",
        0x01 => "the hardware has a fault",
        0x03 => "access is not allowed",
        0x05 => "the address is out of range",
        0x06 => "the data type is not supported",
        0x07 => "data type or length do not match",
        0x0A => "the object does not exist",
        _ => "refused",
    }
}

/// What the error of a whole request means.
#[must_use]
pub const fn of_request(error: ErrorCode) -> &'static str {
    match error {
        ErrorCode::NOT_IMPLEMENTED => "the module does not have this service",
        ErrorCode::NO_FURTHER_UPLOAD => "too many uploads at the same time",
        ErrorCode::WRONG_SEQUENCE => "not in this order",
        ErrorCode::CANNOT_BE_PERFORMED => "it cannot be done now",
        ErrorCode::WRONG_FRAME => "the lengths do not fit, or the answer would be longer than a PDU",
        ErrorCode::BLOCK_NAME => "no name of a block",
        ErrorCode::FUNCTION_PARAMETERS => "wrong parameters",
        ErrorCode::BLOCK_NOT_FOUND => "there is no such block",
        ErrorCode::NO_BLOCK => "there is no block of this type",
        ErrorCode::PROTECTED => "not permitted at this protection level",
        ErrorCode::WRONG_LIST => "there is no such list",
        ErrorCode::WRONG_INDEX => "the list has no such index",
        ErrorCode::TOO_MANY => "too many subscriptions",
        ErrorCode::NOT_SUPPORTED => "the module does not support it",
        ErrorCode::WRONG_PASSWORD => "wrong password",
        ErrorCode::NO_PASSWORD => "there is no password to give",
        ErrorCode::WRONG_TIME => "no valid date and time",
        ErrorCode(_) => "refused",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::s7::wire::data::Refusal;

    #[test]
    fn what_this_server_refuses_has_words() {
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
        // Each a number of its own, as the lists have them.
        for error in [
            0x8104, 0x8304, 0x8401, 0x8404, 0x8500, 0xD201, 0xD202, 0xD209, 0xD20E, 0xD241, 0xD401, 0xD402, 0xD404,
            0xD405, 0xD602, 0xD605, 0xDC01,
        ] {
            assert_ne!(of_request(ErrorCode(error)), "refused", "{error:04X}");
        }
        assert_eq!((of_item(0x42), of_request(ErrorCode(0x4242))), ("refused", "refused"));
    }
}
