//! Functions of angles in degrees, and logarithms, with the same result on every computer.
//!
//! They use the crate `libm`: software in Rust, `+ − × ÷ sqrt` only, no function of the platform. An angle is first brought into 0 to 45
//! degrees by exact steps, so that multiples of 30 and 90 degrees have their exact values: SIN(30) is 0.5, COS(90) is 0.

use std::f64::consts::PI;

/// The sine of an angle in degrees.
#[must_use]
pub fn sin(degrees: f64) -> f64 {
    let turn = degrees % 360.0; // exact
    let (sign, angle) = if turn < 0.0 { (-1.0, -turn) } else { (1.0, turn) };
    let (sign, angle) = if angle >= 180.0 { (-sign, angle - 180.0) } else { (sign, angle) };
    sign * first_half(angle)
}

/// The cosine of an angle in degrees.
#[must_use]
pub fn cos(degrees: f64) -> f64 {
    let turn = (degrees % 360.0).abs();
    let angle = if turn > 180.0 { 360.0 - turn } else { turn };
    // The cosine falls from 1 to −1 over the half turn.
    if angle <= 90.0 { first_half(90.0 - angle) } else { -first_half(angle - 90.0) }
}

/// The tangent of an angle in degrees; none where it is infinite.
#[must_use]
pub fn tan(degrees: f64) -> Option<f64> {
    let (sine, cosine) = (sin(degrees), cos(degrees));
    (cosine != 0.0).then(|| sine / cosine)
}

/// The angle in degrees with this sine; none outside −1 to 1.
#[must_use]
pub fn asin(sine: f64) -> Option<f64> {
    in_range(sine).then(|| match half(sine) {
        Some(sign) => 30.0 * sign,
        None => degrees(libm::asin(sine)),
    })
}

/// The angle in degrees with this cosine; none outside −1 to 1.
#[must_use]
pub fn acos(cosine: f64) -> Option<f64> {
    in_range(cosine).then(|| match half(cosine) {
        Some(sign) => 90.0 - 30.0 * sign,
        None => degrees(libm::acos(cosine)),
    })
}

/// The angle in degrees of the vector with these components, −180 to 180.
#[must_use]
pub fn atan2(y: f64, x: f64) -> f64 {
    degrees(libm::atan2(y, x))
}

/// The natural logarithm.
#[must_use]
pub fn ln(number: f64) -> f64 {
    libm::log(number)
}

/// The exponential function.
#[must_use]
pub fn exp(number: f64) -> f64 {
    libm::exp(number)
}

/// The sine of 0 to 180 degrees.
fn first_half(angle: f64) -> f64 {
    let angle = if angle > 90.0 { 180.0 - angle } else { angle };
    if half_degrees(angle) {
        0.5
    } else if angle <= 45.0 {
        libm::sin(angle * (PI / 180.0))
    } else {
        libm::cos((90.0 - angle) * (PI / 180.0))
    }
}

#[expect(clippy::float_cmp, reason = "exactly 30 degrees")]
fn half_degrees(angle: f64) -> bool {
    angle == 30.0
}

#[expect(clippy::float_cmp, reason = "exactly one half")]
fn half(number: f64) -> Option<f64> {
    (number.abs() == 0.5).then(|| number.signum())
}

fn in_range(number: f64) -> bool {
    (-1.0..=1.0).contains(&number)
}

fn degrees(radians: f64) -> f64 {
    radians * (180.0 / PI)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::float_cmp, reason = "the values are exact")]
    fn multiples_of_thirty_and_ninety_degrees_are_exact() {
        for (angle, sine, cosine) in [
            (0.0, 0.0, 1.0),
            (90.0, 1.0, 0.0),
            (180.0, 0.0, -1.0),
            (270.0, -1.0, 0.0),
            (360.0, 0.0, 1.0),
            (-90.0, -1.0, 0.0),
        ] {
            assert_eq!((sin(angle), cos(angle)), (sine, cosine), "{angle}");
        }
        for (angle, sine) in [(30.0, 0.5), (150.0, 0.5), (210.0, -0.5), (-30.0, -0.5), (390.0, 0.5)] {
            assert_eq!(sin(angle), sine, "{angle}");
        }
        for (angle, cosine) in [(60.0, 0.5), (120.0, -0.5), (240.0, -0.5), (300.0, 0.5), (-60.0, 0.5)] {
            assert_eq!(cos(angle), cosine, "{angle}");
        }
        assert_eq!((tan(45.0), tan(90.0)), (Some(1.0), None));
        assert_eq!((asin(0.5), acos(0.5), acos(-0.5), asin(2.0)), (Some(30.0), Some(60.0), Some(120.0), None));
        assert_eq!((asin(1.0), atan2(1.0, 0.0), atan2(0.0, -1.0)), (Some(90.0), 90.0, 180.0));
    }

    #[test]
    fn the_bits_are_the_same_everywhere() {
        // Written down once; another result means another implementation.
        assert_eq!(sin(12.3).to_bits(), 0x3fcb_4494_670d_798b, "{:#x}", sin(12.3).to_bits());
        assert_eq!(cos(123.456).to_bits(), 0xbfe1_a438_70d3_71f9, "{:#x}", cos(123.456).to_bits());
    }

    #[test]
    fn sine_and_cosine_lie_on_the_circle() {
        for step in -720..720 {
            let angle = f64::from(step) * 0.731;
            let square = sin(angle) * sin(angle) + cos(angle) * cos(angle);
            assert!((square - 1.0).abs() < 4e-16, "{angle}");
        }
    }
}
