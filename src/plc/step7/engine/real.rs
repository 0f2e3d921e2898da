//! Exponential, logarithm and trigonometry of REAL, computed in double precision from additions, multiplications and divisions, so that
//! every processor gives the same bits.
#![expect(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_precision_loss,
    clippy::float_cmp,
    reason = "results are rounded to REAL once, at the end"
)]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, FRAC_PI_6, LN_2, SQRT_2};

/// The second part of π/2, below the precision of the first.
const REST_OF_HALF_PI: f64 = 6.123_233_995_736_766e-17;

pub(in crate::plc::step7) fn exponential(value: f32) -> f32 {
    let x = f64::from(value);
    if x.is_nan() || x > 100.0 {
        return value + value.abs() * f32::MAX;
    }
    if x < -110.0 {
        return 0.0;
    }
    let power = (x / LN_2).round_ties_even();
    let rest = x - power * LN_2;
    let mut term = 1.0;
    let mut sum = 1.0;
    for n in 1..18 {
        term = term * rest / f64::from(n);
        sum += term;
    }
    (sum * two_to(power as i32)) as f32
}

/// A power of two, for exponents of double precision.
fn two_to(power: i32) -> f64 {
    f64::from_bits((i64::from(power) + 1023).cast_unsigned() << 52)
}

pub(in crate::plc::step7) fn logarithm(value: f32) -> f32 {
    let x = f64::from(value);
    if x.is_nan() || x < 0.0 {
        return f32::NAN;
    }
    if x == 0.0 {
        return f32::NEG_INFINITY;
    }
    if x.is_infinite() {
        return value;
    }
    // x is a normal number of double precision: its exponent, and a fraction from 1 to 2.
    let bits = x.to_bits();
    let mut exponent = (bits >> 52) as i64 - 1023;
    let mut fraction = f64::from_bits(bits & 0x000F_FFFF_FFFF_FFFF | 1023 << 52);
    if fraction > SQRT_2 {
        fraction /= 2.0;
        exponent += 1;
    }
    let z = (fraction - 1.0) / (fraction + 1.0);
    let square = z * z;
    let mut sum = 0.0;
    for n in (0..16).rev() {
        sum = sum * square + 1.0 / f64::from(2 * n + 1);
    }
    (2.0 * z * sum + exponent as f64 * LN_2) as f32
}

/// The quadrant of an angle, and the rest between −π/4 and π/4.
fn quadrant(x: f64) -> (i64, f64) {
    let turns = (x / FRAC_PI_2).round_ties_even();
    let rest = (x - turns * FRAC_PI_2) - turns * REST_OF_HALF_PI;
    (turns.rem_euclid(4.0) as i64, rest.clamp(-FRAC_PI_4 * 1.01, FRAC_PI_4 * 1.01))
}

fn series(x: f64, first: f64, start: i32) -> f64 {
    let mut term = first;
    let mut sum = first;
    for n in 0..9 {
        let k = f64::from(start + 2 * n);
        term = -term * x * x / (k * (k + 1.0));
        sum += term;
    }
    sum
}

fn sine_and_cosine(value: f32) -> (f64, f64) {
    let x = f64::from(value);
    if !x.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let (quadrant, rest) = quadrant(x);
    let (sine, cosine) = (series(rest, rest, 2), series(rest, 1.0, 1));
    match quadrant {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

pub(in crate::plc::step7) fn sine(value: f32) -> f32 {
    sine_and_cosine(value).0 as f32
}

pub(in crate::plc::step7) fn cosine(value: f32) -> f32 {
    sine_and_cosine(value).1 as f32
}

pub(in crate::plc::step7) fn tangent(value: f32) -> f32 {
    let (sine, cosine) = sine_and_cosine(value);
    (sine / cosine) as f32
}

fn arc_tangent_of(x: f64) -> f64 {
    if x < 0.0 {
        return -arc_tangent_of(-x);
    }
    if x > 1.0 {
        return FRAC_PI_2 - arc_tangent_of(1.0 / x);
    }
    // tan 15° bounds the argument of the series.
    const TAN_15: f64 = 0.267_949_192_431_122_7;
    let root = 3.0_f64.sqrt();
    let (base, z) = if x > TAN_15 { (FRAC_PI_6, (x * root - 1.0) / (x + root)) } else { (0.0, x) };
    let square = -z * z;
    let mut sum = 0.0;
    for n in (0..16).rev() {
        sum = sum * square + 1.0 / f64::from(2 * n + 1);
    }
    base + z * sum
}

pub(in crate::plc::step7) fn arc_tangent(value: f32) -> f32 {
    if value.is_nan() { value } else { arc_tangent_of(f64::from(value)) as f32 }
}

fn arc_sine_of(x: f64) -> f64 {
    if x.abs() == 1.0 { x * FRAC_PI_2 } else { arc_tangent_of(x / (1.0 - x * x).sqrt()) }
}

pub(in crate::plc::step7) fn arc_sine(value: f32) -> f32 {
    if value.abs() <= 1.0 { arc_sine_of(f64::from(value)) as f32 } else { f32::NAN }
}

pub(in crate::plc::step7) fn arc_cosine(value: f32) -> f32 {
    if value.abs() <= 1.0 { (FRAC_PI_2 - arc_sine_of(f64::from(value))) as f32 } else { f32::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Within one unit of the last place.
    fn near(found: f32, exact: f64) -> bool {
        let wanted = exact as f32;
        found == wanted || (i64::from(found.to_bits()) - i64::from(wanted.to_bits())).abs() <= 1
    }

    #[test]
    fn functions_have_the_precision_of_real() {
        let e = std::f64::consts::E;
        assert!(near(exponential(1.0), e) && near(exponential(-1.0), 1.0 / e) && near(exponential(0.0), 1.0));
        assert!(exponential(89.0).is_infinite() && exponential(-120.0) == 0.0 && exponential(f32::NAN).is_nan());
        assert!(exponential(f32::INFINITY).is_infinite());
        assert!(near(logarithm(2.0), LN_2) && near(logarithm(0.5), -LN_2) && near(logarithm(1.0), 0.0));
        assert!(logarithm(-1.0).is_nan() && logarithm(0.0) == f32::NEG_INFINITY);
        let third = std::f64::consts::FRAC_PI_3 as f32;
        // The argument is π/3 + δ after rounding; sin(π/3 + δ) = √3/2 + δ/2, cos = 1/2 − δ √3/2.
        let delta = f64::from(third) - std::f64::consts::FRAC_PI_3;
        let root = 3.0_f64.sqrt() / 2.0;
        assert!(near(sine(third), root + delta / 2.0) && near(cosine(third), 0.5 - delta * root));
        assert!(near(sine(-third), -(root + delta / 2.0)) && sine(f32::INFINITY).is_nan());
        assert!(near(tangent(FRAC_PI_4 as f32), 1.0));
        assert!(
            near(arc_tangent(1.0), FRAC_PI_4)
                && near(arc_tangent(-1.0), -FRAC_PI_4)
                && near(arc_tangent(1e30), FRAC_PI_2)
        );
        assert!(near(arc_sine(0.5), FRAC_PI_6) && near(arc_sine(-1.0), -FRAC_PI_2) && arc_sine(1.1).is_nan());
        assert!(near(arc_cosine(0.5), std::f64::consts::FRAC_PI_3) && near(arc_cosine(-1.0), std::f64::consts::PI));
    }
}
