//! Arithmetic, comparisons, conversions, shifts: functions of the values in the accumulators.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    reason = "an accumulator is a pattern of bits, and the operations say which of them count"
)]

use crate::plc::step7::instruction::{Arithmetic, Convert, Numeric, Relation, Shift};

use super::fault::Fault;
use super::real;

/// CC1, CC0 and OV.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) struct Codes {
    pub(in crate::plc::step7) cc1: bool,
    pub(in crate::plc::step7) cc0: bool,
    pub(in crate::plc::step7) ov: bool,
}

const fn codes(cc1: bool, cc0: bool, ov: bool) -> Codes {
    Codes { cc1, cc0, ov }
}

/// The invalid result: all three.
const INVALID: Codes = codes(true, true, true);

fn signed(value: i64, ov: bool) -> Codes {
    codes(value > 0, value < 0, ov)
}

pub(in crate::plc::step7) fn low(value: u32) -> i16 {
    value as i16
}

/// A value with another low word.
pub(in crate::plc::step7) fn with_low(value: u32, low: i16) -> u32 {
    value & 0xFFFF_0000 | u32::from(low as u16)
}

/// ACCU1 and the codes after an operation of ACCU2 with ACCU1; ACCU1 stays after a division by zero.
pub(in crate::plc::step7) fn calculate(
    operation: Arithmetic,
    numeric: Numeric,
    accu2: u32,
    accu1: u32,
) -> (u32, Codes) {
    match numeric {
        Numeric::Int => int(operation, accu2, accu1),
        Numeric::Double => double(operation, accu2 as i32, accu1 as i32),
        Numeric::Real => {
            let (a, b) = (f32::from_bits(accu2), f32::from_bits(accu1));
            let result = match operation {
                Arithmetic::Add => a + b,
                Arithmetic::Subtract => a - b,
                Arithmetic::Multiply => a * b,
                Arithmetic::Divide | Arithmetic::Modulo => a / b,
            };
            real_result(result)
        }
    }
}

fn int(operation: Arithmetic, accu2: u32, accu1: u32) -> (u32, Codes) {
    let (a, b) = (i32::from(low(accu2)), i32::from(low(accu1)));
    let fits = |value: i32| i16::try_from(value).is_ok();
    match operation {
        Arithmetic::Add | Arithmetic::Subtract => {
            let exact = if operation == Arithmetic::Add { a + b } else { a - b };
            let result = exact as i16;
            (with_low(accu1, result), signed(i64::from(result), !fits(exact)))
        }
        Arithmetic::Multiply => ((a * b) as u32, signed(i64::from(a * b), !fits(a * b))),
        Arithmetic::Divide | Arithmetic::Modulo => {
            if b == 0 {
                return (accu1, INVALID);
            }
            let (quotient, remainder) = (a / b, a % b);
            let result = (remainder as u32) << 16 | u32::from(quotient as u16);
            (result, signed(i64::from(quotient), !fits(quotient)))
        }
    }
}

fn double(operation: Arithmetic, a: i32, b: i32) -> (u32, Codes) {
    let (a, b) = (i64::from(a), i64::from(b));
    let exact = match operation {
        Arithmetic::Add => a + b,
        Arithmetic::Subtract => a - b,
        Arithmetic::Multiply => a * b,
        Arithmetic::Divide | Arithmetic::Modulo if b == 0 => return (b as u32, INVALID),
        Arithmetic::Divide => a / b,
        Arithmetic::Modulo => a % b,
    };
    let result = exact as i32;
    let ov = i64::from(result) != exact;
    // Sums show the sign of the 32 bits, products and quotients that of the exact value.
    let sign = if matches!(operation, Arithmetic::Add | Arithmetic::Subtract) { i64::from(result) } else { exact };
    (result as u32, signed(sign, ov))
}

/// The bits and the codes of a REAL.
pub(in crate::plc::step7) fn real_result(result: f32) -> (u32, Codes) {
    let codes = if result.is_nan() {
        INVALID
    } else if result.is_infinite() {
        codes(result > 0.0, result < 0.0, true)
    } else if result == 0.0 {
        codes(false, false, false)
    } else if result.is_subnormal() {
        codes(false, false, true)
    } else {
        codes(result > 0.0, result < 0.0, false)
    };
    (result.to_bits(), codes)
}

/// The result of a comparison of ACCU2 with ACCU1, and the codes.
pub(in crate::plc::step7) fn compare(relation: Relation, numeric: Numeric, accu2: u32, accu1: u32) -> (bool, Codes) {
    let order = match numeric {
        Numeric::Int => Some(low(accu2).cmp(&low(accu1))),
        Numeric::Double => Some((accu2 as i32).cmp(&(accu1 as i32))),
        Numeric::Real => f32::from_bits(accu2).partial_cmp(&f32::from_bits(accu1)),
    };
    let Some(order) = order else { return (false, INVALID) };
    let result = match relation {
        Relation::Equal => order.is_eq(),
        Relation::NotEqual => order.is_ne(),
        Relation::Greater => order.is_gt(),
        Relation::Less => order.is_lt(),
        Relation::GreaterEqual => order.is_ge(),
        Relation::LessEqual => order.is_le(),
    };
    (result, codes(order.is_gt(), order.is_lt(), false))
}

/// Which codes a conversion sets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Sets {
    Nothing,
    /// OV and OS only.
    Overflow(bool),
    All(Codes),
}

/// ACCU1 after an operation on it alone.
pub(in crate::plc::step7) fn convert(operation: Convert, accu1: u32) -> Result<(u32, Sets), Fault> {
    let value = f32::from_bits(accu1);
    let nothing = |value: u32| Ok((value, Sets::Nothing));
    let function = |result: f32| {
        let (bits, codes) = real_result(result);
        Ok((bits, Sets::All(codes)))
    };
    match operation {
        Convert::NegateInt => {
            let value = low(accu1);
            let result = value.wrapping_neg();
            Ok((with_low(accu1, result), Sets::All(signed(i64::from(result), value == i16::MIN))))
        }
        Convert::NegateDouble => {
            let value = accu1 as i32;
            let result = value.wrapping_neg();
            Ok((result as u32, Sets::All(signed(i64::from(result), value == i32::MIN))))
        }
        Convert::InvertInt => nothing(accu1 ^ 0xFFFF),
        Convert::InvertDouble => nothing(!accu1),
        Convert::Absolute => nothing(accu1 & 0x7FFF_FFFF),
        Convert::NegateReal => nothing(accu1 ^ 0x8000_0000),
        Convert::Square => function(value * value),
        Convert::SquareRoot => function(value.sqrt()),
        Convert::Exponential => function(real::exponential(value)),
        Convert::Logarithm => function(real::logarithm(value)),
        Convert::Sine => function(real::sine(value)),
        Convert::Cosine => function(real::cosine(value)),
        Convert::Tangent => function(real::tangent(value)),
        Convert::ArcSine => function(real::arc_sine(value)),
        Convert::ArcCosine => function(real::arc_cosine(value)),
        Convert::ArcTangent => function(real::arc_tangent(value)),
        Convert::BcdToInt => {
            let number = digits(accu1 & 0xFFF)? as i16;
            nothing(with_low(accu1, if accu1 & 0x8000 == 0 { number } else { -number }))
        }
        Convert::BcdToDouble => {
            let number = digits(accu1 & 0x0FFF_FFFF)? as i32;
            nothing((if accu1 & 0x8000_0000 == 0 { number } else { -number }) as u32)
        }
        Convert::IntToBcd => {
            let value = low(accu1);
            let Some(bcd) = bcd(u32::from(value.unsigned_abs()), 999) else { return Ok((accu1, Sets::Overflow(true))) };
            let sign = if value < 0 { 0xF000 } else { 0 };
            Ok((with_low(accu1, (bcd | sign) as i16), Sets::Overflow(false)))
        }
        Convert::DoubleToBcd => {
            let value = accu1 as i32;
            let Some(bcd) = bcd(value.unsigned_abs(), 9_999_999) else { return Ok((accu1, Sets::Overflow(true))) };
            let sign = if value < 0 { 0xF000_0000 } else { 0 };
            Ok((bcd | sign, Sets::Overflow(false)))
        }
        Convert::IntToDouble => nothing(i32::from(low(accu1)) as u32),
        Convert::DoubleToReal => nothing((accu1 as i32 as f32).to_bits()),
        Convert::Round => rounded(accu1, f64::round_ties_even),
        Convert::RoundUp => rounded(accu1, f64::ceil),
        Convert::RoundDown => rounded(accu1, f64::floor),
        Convert::Truncate => rounded(accu1, f64::trunc),
        Convert::SwapWord => nothing(with_low(accu1, low(accu1).swap_bytes())),
        Convert::SwapDouble => nothing(accu1.swap_bytes()),
    }
}

fn rounded(accu1: u32, round: fn(f64) -> f64) -> Result<(u32, Sets), Fault> {
    let exact = round(f64::from(f32::from_bits(accu1)));
    if exact >= f64::from(i32::MIN) && exact <= f64::from(i32::MAX) {
        Ok((exact as i32 as u32, Sets::Overflow(false)))
    } else {
        Ok((accu1, Sets::Overflow(true)))
    }
}

/// The number of BCD digits.
pub(in crate::plc::step7) fn digits(bcd: u32) -> Result<u32, Fault> {
    (0..8).rev().try_fold(0, |number, digit| match bcd >> (digit * 4) & 0xF {
        value @ 0..=9 => Ok(number * 10 + value),
        _ => Err(Fault::BcdDigit),
    })
}

/// The digits of a number; `None` beyond a limit.
fn bcd(number: u32, limit: u32) -> Option<u32> {
    if number > limit {
        return None;
    }
    let mut rest = number;
    let mut bcd = 0;
    for digit in 0..8 {
        bcd |= (rest % 10) << (digit * 4);
        rest /= 10;
    }
    Some(bcd)
}

/// ACCU1 and CC1 after a shift; `None` for a shift by 0, which does nothing.
pub(in crate::plc::step7) fn shift(operation: Shift, accu1: u32, count: u8) -> Option<(u32, bool)> {
    if count == 0 {
        return None;
    }
    let n = u32::from(count);
    let word = accu1 & 0xFFFF;
    let high = accu1 & 0xFFFF_0000;
    let wide = u64::from(accu1);
    Some(match operation {
        Shift::LeftWord => {
            let shifted = if n > 16 { 0 } else { word << n };
            (high | shifted & 0xFFFF, shifted >> 16 & 1 == 1)
        }
        Shift::RightWord => {
            let shifted = if n > 16 { 0 } else { (word << 1) >> n };
            (high | shifted >> 1, shifted & 1 == 1)
        }
        Shift::LeftDouble => {
            let shifted = if n > 32 { 0 } else { wide << n };
            (shifted as u32, shifted >> 32 & 1 == 1)
        }
        Shift::RightDouble => {
            let shifted = if n > 32 { 0 } else { (wide << 1) >> n };
            ((shifted >> 1) as u32, shifted & 1 == 1)
        }
        Shift::SignedWord => {
            let shifted = (i32::from(low(accu1)) << 1) >> n.min(16);
            (high | (shifted >> 1) as u32 & 0xFFFF, shifted & 1 == 1)
        }
        Shift::SignedDouble => {
            let shifted = (i64::from(accu1 as i32) << 1) >> n.min(32);
            ((shifted >> 1) as u32, shifted & 1 == 1)
        }
        Shift::RotateLeft => {
            let result = accu1.rotate_left((n - 1) % 32 + 1);
            (result, result & 1 == 1)
        }
        Shift::RotateRight => {
            let result = accu1.rotate_right((n - 1) % 32 + 1);
            (result, result >> 31 == 1)
        }
    })
}
