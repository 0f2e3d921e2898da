//! An incremental encoder on a slide. It counts from the position at power on and reports its zero marks.

use serde::{Deserialize, Serialize};

use crate::units::Position;

/// The signal of an encoder in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EncoderSignal {
    /// Distance from the position at power on, in whole counts.
    pub value: Position,
    /// The value at the zero mark that was passed in this cycle, latched by the hardware.
    pub zero_mark: Option<Position>,
}

/// An incremental encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Encoder {
    /// One count.
    resolution: Position,
    /// Position of one zero mark, in the machine frame.
    zero_mark: Position,
    /// Distance between two zero marks.
    spacing: Position,
    /// Slide position at which the encoder counts zero.
    origin: Position,
    /// Counts lost or gained (fault `encoder_slip`).
    slip: Position,
}

impl Encoder {
    /// An encoder that is switched on at the position `slide`. Its zero marks are at `zero_mark + k · spacing`.
    ///
    /// Resolution and spacing are at least one increment; smaller values are raised to it.
    #[must_use]
    pub fn new(resolution: Position, zero_mark: Position, spacing: Position, slide: Position) -> Self {
        let one = Position::new(1);
        Self {
            resolution: resolution.max(one),
            zero_mark,
            spacing: spacing.max(one),
            origin: slide,
            slip: Position::ZERO,
        }
    }

    /// Half a count: the largest deviation that the encoder cannot detect.
    #[must_use]
    pub fn half_count(&self) -> Position {
        Position::new(self.resolution.increments() / 2)
    }

    /// Switches the encoder off and on: it counts from this position.
    pub fn restart(&mut self, slide: Position) {
        self.origin = slide;
        self.slip = Position::ZERO;
    }

    /// Gains or loses counts once.
    pub fn slip(&mut self, by: Position) {
        self.slip = super::within_reach(self.slip.increments().saturating_add(by.increments()));
    }

    /// The signal after the slide has moved.
    #[must_use]
    pub fn signal(&self, before: Position, after: Position) -> EncoderSignal {
        let passed = if before == after { None } else { self.mark_between(before, after) };
        EncoderSignal { value: self.value(after), zero_mark: passed.map(|mark| self.value(mark)) }
    }

    /// The count at a position of the slide.
    #[must_use]
    pub fn value(&self, slide: Position) -> Position {
        let count = self.resolution.increments();
        let distance = (slide - self.origin).increments();
        Position::new((distance + count / 2).div_euclid(count) * count) + self.slip
    }

    /// The first zero mark between `before` (excluded) and `after` (included).
    fn mark_between(&self, before: Position, after: Position) -> Option<Position> {
        let (spacing, phase) = (self.spacing.increments(), self.zero_mark.increments());
        let before_index = (before.increments() - phase).div_euclid(spacing);
        let mark = if after > before {
            phase + (before_index + 1) * spacing
        } else {
            let on_mark = before_index * spacing + phase == before.increments();
            phase + (before_index - i64::from(on_mark)) * spacing
        };
        let mark = Position::new(mark);
        let reached = if after > before { mark <= after } else { mark >= after };
        reached.then_some(mark)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    fn encoder() -> Encoder {
        Encoder::new(mm(0.001), mm(0.3), mm(10.0), mm(5.0))
    }

    #[test]
    fn it_counts_from_where_it_was_switched_on() {
        assert_eq!(encoder().signal(mm(5.0), mm(5.0)).value, mm(0.0));
        assert_eq!(encoder().signal(mm(5.0), mm(7.2504)).value, mm(2.25));
        assert_eq!(encoder().signal(mm(5.0), mm(4.9996)).value, mm(0.0));
    }

    #[test]
    fn a_zero_mark_is_caught_in_both_directions_and_only_once() {
        let encoder = encoder();
        // Zero marks at …, 0.3, 10.3, …; counting starts at 5.0, so the mark at 10.3 has the value 5.3.
        assert_eq!(encoder.signal(mm(10.2), mm(10.4)).zero_mark, Some(mm(5.3)));
        assert_eq!(encoder.signal(mm(10.4), mm(10.2)).zero_mark, Some(mm(5.3)));
        assert_eq!(encoder.signal(mm(10.2), mm(10.3)).zero_mark, Some(mm(5.3)));
        assert_eq!(encoder.signal(mm(10.3), mm(10.4)).zero_mark, None);
        assert_eq!(encoder.signal(mm(10.3), mm(10.2)).zero_mark, None);
        assert_eq!(encoder.signal(mm(-9.6), mm(-9.8)).zero_mark, Some(mm(-14.7)));
    }

    #[test]
    fn a_slip_stays_until_it_is_switched_on_again() {
        let mut encoder = encoder();
        encoder.slip(mm(0.5));
        assert_eq!(encoder.signal(mm(6.0), mm(6.0)).value, mm(1.5));
        encoder.restart(mm(6.0));
        assert_eq!(encoder.signal(mm(6.0), mm(6.0)).value, mm(0.0));
    }
}
