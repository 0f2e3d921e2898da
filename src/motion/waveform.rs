//! The signals of a function generator.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

use super::path::angle::sin_cos;

/// A periodic signal between −1 and +1 that begins at 0, except the square wave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Waveform {
    /// Sine.
    Sine,
    /// Square wave: +1 in the first half of a period, −1 in the second.
    Square,
    /// Triangle: +1 after a quarter of a period, −1 after three quarters.
    Triangle,
}

impl Waveform {
    /// Its value after this number of periods, of at least 0.
    #[must_use]
    pub fn value(self, periods: f64) -> f64 {
        let part = periods.fract();
        match self {
            Self::Sine => sin_cos(part * TAU).0,
            Self::Square => {
                if part < 0.5 {
                    1.0
                } else {
                    -1.0
                }
            }
            Self::Triangle => 1.0 - 4.0 * ((part + 0.25).fract() - 0.5).abs(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_signal_has_its_extremes_after_a_quarter_and_three_quarters_of_a_period() {
        for wave in [Waveform::Sine, Waveform::Triangle] {
            for (periods, value) in [(0.0, 0.0), (0.25, 1.0), (0.5, 0.0), (0.75, -1.0), (7.25, 1.0)] {
                assert!((wave.value(periods) - value).abs() < 1e-12, "{wave:?} {periods}");
            }
        }
        let square = [0.0, 0.49, 0.5, 0.99, 3.25].map(|periods| Waveform::Square.value(periods) > 0.0);
        assert_eq!(square, [true, true, false, false, true]);
    }
}
