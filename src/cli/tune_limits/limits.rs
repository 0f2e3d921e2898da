//! Proposals: the limits of a grouping from the differences that were seen.

use super::search::{Axis, Grouping, Seen};
use crate::control::{StoredDatum, Value};
use crate::source::Place;
use crate::variables::six_decimals;

/// The value of a limit that never acts in a search, in the unit of the machine data.
pub(super) const LARGE: f64 = 1_000.0;

/// The safety margin between limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Margin {
    /// A share of the lower limit.
    Share(f64),
    /// A length.
    Length(f64),
}

impl Margin {
    /// Parses `10%` or `0.05`.
    pub(super) fn parse(text: &str) -> Result<Self, String> {
        let (digits, is_share) = text.strip_suffix('%').map_or((text, false), |digits| (digits.trim_end(), true));
        let value = digits.parse::<f64>().ok().filter(|value| (0.0..=LARGE).contains(value));
        match value {
            Some(value) if is_share => Ok(Self::Share(value / 100.0)),
            Some(value) => Ok(Self::Length(value)),
            None => {
                Err(format!("expected a share such as 10%, or a length such as 0.05, from 0 to {LARGE}, found {text}"))
            }
        }
    }

    fn above(self, limit: f64) -> f64 {
        match self {
            Self::Share(share) => limit * (1.0 + share),
            Self::Length(length) => limit + length,
        }
    }
}

/// Parses the step of limits.
pub(super) fn step(text: &str) -> Result<f64, String> {
    let value = text.parse::<f64>().ok().filter(|value| (1e-6..=LARGE).contains(value));
    value.ok_or_else(|| format!("expected a length from 0.000001 to {LARGE}, found {text}"))
}

/// A number without the zeros at its end.
pub(super) fn number(value: f64) -> String {
    let text = six_decimals(value);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// The limits of all axes of a grouping, in the unit of the machine data.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Limits {
    pub(super) grouping: Grouping,
    /// MD37110; `None` leaves it as it is.
    stored_warning: Option<f64>,
    pub(super) warning: f64,
    /// MD37120.
    pub(super) trip: f64,
    /// MD37130.
    pub(super) not_synchronised: f64,
}

impl Limits {
    /// The limits of the search: the trips never act.
    pub(super) fn large(grouping: &Grouping) -> Self {
        Self { grouping: grouping.clone(), stored_warning: None, warning: 0.0, trip: LARGE, not_synchronised: LARGE }
    }

    /// MD37110: the first step at which no difference exceeds it. MD37120: with the margin, at least a step more. MD37130 stays if it is
    /// above MD37120 and no difference before synchronism exceeds it; else it is above both, with the margin.
    pub(super) fn of(grouping: &Grouping, seen: &Seen, margin: Margin, step: f64) -> Self {
        let greatest = seen.greatest.iter().map(|greatest| greatest.value).fold(0.0, f64::max);
        let warning = up(greatest, step).max(step);
        let trip = up(margin.above(warning), step).max(warning + step);
        let now = grouping.not_synchronised;
        let not_synchronised = if now > trip && now >= seen.not_synchronised {
            now
        } else {
            up(margin.above(trip.max(seen.not_synchronised)), step).max(trip + step)
        };
        Self { grouping: grouping.clone(), stored_warning: Some(warning), warning, trip, not_synchronised }
    }

    /// The machine data of all axes of the grouping.
    pub(super) fn data(&self) -> Vec<StoredDatum> {
        let of_axis = |axis: &Axis| {
            let values = [(37110, self.stored_warning), (37120, Some(self.trip)), (37130, Some(self.not_synchronised))];
            let name = axis.name.clone();
            values.into_iter().filter_map(move |(number, value)| {
                let (target, place) = (format!("{number}[{name}]"), Place::file("tune-limits"));
                Some(StoredDatum { target, place, value: Value::Real(value?) })
            })
        };
        self.grouping.axes().flat_map(of_axis).collect()
    }
}

/// The smallest multiple of a step that is not below a value. Differences and limits are whole millionths.
fn up(value: f64, step: f64) -> f64 {
    let steps = (value / step - 1e-7).ceil().max(0.0);
    (steps * step * 1e6).round() / 1e6
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_multiples_of_the_step_that_are_not_exceeded() {
        assert_eq!((up(0.526, 0.001), up(0.526_001, 0.001), up(0.3, 0.1), up(0.0, 0.001)), (0.526, 0.527, 0.3, 0.0));
        assert_eq!((number(0.55), number(100.0), number(0.0)), ("0.55".into(), "100".into(), "0".into()));
    }

    #[test]
    fn a_margin_is_a_share_or_a_length() {
        assert_eq!(Margin::parse("10%"), Ok(Margin::Share(0.1)));
        assert_eq!(Margin::parse("0.05"), Ok(Margin::Length(0.05)));
        for text in ["-1", "-5%", "ten", "", "%", "nan", "inf", "1e9"] {
            assert!(Margin::parse(text).is_err(), "{text}");
        }
    }
}
