//! An encoder on a slide: incremental, with equidistant or distance-coded marks, or absolute.
//!
//! An incremental encoder counts from the position at power on, an absolute one from its own zero. Both report the marks that they pass. A
//! distance-coded scale has a fixed mark every `spacing`, and one mark between each two of them, which moves on by `shift` from field to
//! field: at spacing/2 + shift in the first field. A scale of 20 mm with 0.02 mm has marks at 0, 10.02, 20, 30.04, 40 … It begins at its first
//! mark and ends where the marks between would meet the fixed ones.

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

/// The scale of marks in addition to the fixed ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Code {
    /// By this distance the mark between two fixed marks moves on from field to field.
    shift: Position,
    /// The scale counts against the axis.
    inverted: bool,
}

/// An encoder.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Encoder {
    /// One count.
    resolution: Position,
    /// Position of one zero mark, in the machine frame.
    zero_mark: Position,
    /// Distance between two zero marks.
    spacing: Position,
    /// The code of its marks; `None`: they are equidistant.
    code: Option<Code>,
    /// It reads its position without a movement.
    absolute: bool,
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
            code: None,
            absolute: false,
            origin: slide,
            slip: Position::ZERO,
        }
    }

    /// The same encoder with distance-coded marks; its zero mark is the first fixed one. A shift below one increment is raised to it.
    #[must_use]
    pub fn distance_coded(self, shift: Position, inverted: bool) -> Self {
        Self { code: Some(Code { shift: shift.max(Position::new(1)), inverted }), ..self }
    }

    /// An absolute encoder that reads zero at this position of the slide.
    #[must_use]
    pub fn absolute(self, zero: Position) -> Self {
        Self { absolute: true, origin: zero, ..self }
    }

    /// Whether it is an absolute encoder.
    #[must_use]
    pub const fn is_absolute(&self) -> bool {
        self.absolute
    }

    /// Half a count: the largest deviation that the encoder cannot detect.
    #[must_use]
    pub fn half_count(&self) -> Position {
        Position::new(self.resolution.increments() / 2)
    }

    /// Switches the encoder off and on: an incremental one counts from this position.
    pub fn restart(&mut self, slide: Position) {
        if !self.absolute {
            self.origin = slide;
        }
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
        if let Some(code) = self.code {
            return self.coded_mark_between(code, before, after);
        }
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

    fn coded_mark_between(&self, code: Code, before: Position, after: Position) -> Option<Position> {
        let sign = if code.inverted { -1 } else { 1 };
        let (spacing, shift) = (self.spacing.increments(), code.shift.increments());
        let along = |slide: Position| sign * (slide - self.zero_mark).increments();
        let (from, to) = (along(before), along(after));
        let field = from.div_euclid(spacing);
        // The next mark in either direction is in this field or in one of its neighbours.
        let marks = (field - 1..=field + 1).filter(|&field| field >= 0).flat_map(|field| {
            let moved = shift.saturating_mul(field + 1);
            let between = (moved < spacing / 2).then_some(field * spacing + spacing / 2 + moved);
            [Some(field * spacing), between].into_iter().flatten()
        });
        let passed =
            marks.filter(|&mark| if to > from { from < mark && mark <= to } else { to <= mark && mark < from });
        let mark = passed.min_by_key(|mark| (mark - from).abs())?;
        Some(self.zero_mark + Position::new(sign * mark))
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

    /// nc_programs 6.1: 20 mm / 0.02 mm, marks at 0, 501, 1000, 1502, 2000 periods of 0.02 mm: 0, 10.02, 20, 30.04, 40 mm.
    #[test]
    fn the_marks_of_a_distance_coded_scale() {
        let passed = |encoder: &Encoder, marks: &[(f64, f64)]| -> Vec<Option<f64>> {
            let seen = marks.iter().map(|&(from, to)| encoder.signal(mm(from), mm(to)).zero_mark);
            seen.map(|mark| mark.map(Position::user)).collect()
        };
        // Its first mark is at slide position 100, and it counts from there.
        let encoder = Encoder::new(mm(0.001), mm(100.0), mm(20.0), mm(100.0)).distance_coded(mm(0.02), false);
        let ways = [
            (109.0, 111.0),
            (111.0, 109.0),
            (119.0, 121.0),
            (129.0, 131.0),
            (139.0, 141.0),
            (102.0, 104.0),
            (100.0, 99.0),
        ];
        let marks = [Some(10.02), Some(10.02), Some(20.0), Some(30.04), Some(40.0), None, None];
        assert_eq!(passed(&encoder, &ways), marks);
        // Below its first mark there is no scale.
        assert_eq!(passed(&encoder, &[(90.0, 89.0), (99.0, 101.0), (101.0, 99.0)]), [None, Some(0.0), Some(0.0)]);
        let inverted = encoder.distance_coded(mm(0.02), true);
        assert_eq!(passed(&inverted, &[(91.0, 89.0), (81.0, 79.0), (109.0, 111.0)]), [Some(-10.02), Some(-20.0), None]);
    }

    #[test]
    fn an_absolute_encoder_reads_the_same_after_power_on() {
        let mut encoder = encoder().absolute(mm(2.0));
        assert_eq!(encoder.signal(mm(7.0), mm(7.0)).value, mm(5.0));
        encoder.restart(mm(9.5));
        assert_eq!(encoder.signal(mm(9.5), mm(9.5)).value, mm(7.5));
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
