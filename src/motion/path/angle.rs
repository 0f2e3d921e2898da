//! Angles without the platform's library: the same bits on every computer.
//!
//! Both functions use only `+ − × ÷ sqrt` and comparisons. Their errors are below 1e-15, that is less than 0.01 nm on a radius of 10 m.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

/// A quarter turn in two parts: the first has so few digits that its products with whole numbers below 2^27 are exact.
const QUARTER: f64 = f64::from_bits(FRAC_PI_2.to_bits() & !((1 << 27) - 1));
/// The rest of a quarter turn, with what `FRAC_PI_2` does not have of it.
const REST_OF_QUARTER: f64 = FRAC_PI_2 - QUARTER + 6.123_233_995_736_766e-17;

/// Sine and cosine of an angle in radians, of up to a million turns.
#[must_use]
pub(in crate::motion) fn sin_cos(angle: f64) -> (f64, f64) {
    // The nearest multiple of a quarter turn; what remains is at most an eighth.
    let quarters = (angle / FRAC_PI_2).round();
    let rest = angle - quarters * QUARTER - quarters * REST_OF_QUARTER;
    let (sine, cosine) = eighth(rest);
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    let quarter = (quarters as i64).rem_euclid(4);
    match quarter {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The series of both functions, for at most an eighth of a turn: the first term that is left out is below 1e-17.
fn eighth(angle: f64) -> (f64, f64) {
    let square = angle * angle;
    let (mut sine, mut cosine) = (1.0, 1.0);
    // From the smallest term on: 1 − x²/(n(n−1)) · (…)
    let mut n = 17.0;
    while n > 1.0 {
        sine = 1.0 - square / (n * (n - 1.0)) * sine;
        cosine = 1.0 - square / ((n - 1.0) * (n - 2.0)) * cosine;
        n -= 2.0;
    }
    (angle * sine, cosine)
}

/// The angle of a direction in radians, from −π to π; 0 for the zero vector.
#[must_use]
pub(super) fn angle_of(x: f64, y: f64) -> f64 {
    let radius = (x * x + y * y).sqrt();
    if radius <= 0.0 {
        return 0.0;
    }
    // A first guess within 0.005 of the angle, in the octant of the direction.
    let (near, far) = if y.abs() <= x.abs() { (y, x) } else { (-x, y) };
    let slope = near / far;
    let guess = slope * (FRAC_PI_4 + 0.273 * (1.0 - slope.abs()));
    let octant = match (y.abs() <= x.abs(), x >= 0.0, y >= 0.0) {
        (true, true, _) => 0.0,
        (true, false, true) => PI,
        (true, false, false) => -PI,
        (false, _, true) => FRAC_PI_2,
        (false, _, false) => -FRAC_PI_2,
    };
    let mut angle = octant + guess;
    // The error that is left after each correction is a sixth of its cube.
    for _ in 0..3 {
        let (sine, cosine) = sin_cos(angle);
        angle += (y * cosine - x * sine) / radius;
    }
    angle
}

#[cfg(test)]
mod tests {
    #![expect(clippy::float_cmp, reason = "some angles are exact")]
    #![expect(clippy::disallowed_methods, reason = "the functions of the platform are the judge")]

    use super::*;

    #[test]
    fn sine_and_cosine_are_those_of_the_library() {
        for step in -40_000..40_000 {
            let angle = f64::from(step) * 0.001_37;
            let (sine, cosine) = sin_cos(angle);
            assert!((sine - angle.sin()).abs() < 1e-15, "sin {angle}");
            assert!((cosine - angle.cos()).abs() < 1e-15, "cos {angle}");
        }
    }

    #[test]
    fn known_angles_are_exact() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        let (sine, cosine) = sin_cos(PI / 6.0);
        assert!((sine - 0.5).abs() < 1e-15 && (cosine - 0.75_f64.sqrt()).abs() < 1e-15);
        for (x, y, angle) in
            [(1.0, 0.0, 0.0), (0.0, 2.0, FRAC_PI_2), (-3.0, 0.0, PI), (0.0, -1.0, -FRAC_PI_2), (5.0, 5.0, FRAC_PI_4)]
        {
            assert!((angle_of(x, y) - angle).abs() < 1e-15, "{x}, {y}: {}", angle_of(x, y));
        }
        assert_eq!(angle_of(0.0, 0.0), 0.0);
    }

    #[test]
    fn the_angle_of_a_direction_is_that_of_the_library() {
        for step in -3_141..3_141 {
            let angle = f64::from(step) * 0.001;
            let (sine, cosine) = (1e9 * angle.sin(), 1e9 * angle.cos());
            assert!((angle_of(cosine, sine) - angle).abs() < 1e-15, "{angle}");
        }
    }
}
