//! Watched values as the trace keeps them. Measured values are in millionths, the unit of six displayed decimals.

use crate::variables::{NamedValue, Variables};

/// A watched value at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Recorded {
    /// A measured value, in millionths.
    Measured(i64),
    /// A number.
    Number(f64),
    /// A text, by its index in the texts of the trace.
    Text(u32),
}

impl Recorded {
    /// The value now. A text is added to `texts` if it differs from the last one.
    pub(super) fn of(value: NamedValue, last: Option<Self>, variables: &Variables, texts: &mut Vec<Box<str>>) -> Self {
        if let NamedValue::Program(channel) = value {
            let text = variables.channels[channel].program.as_str();
            if let Some(last @ Self::Text(index)) = last
                && texts.get(index as usize).is_some_and(|known| **known == *text)
            {
                return last;
            }
            texts.push(text.into());
            return Self::Text(u32::try_from(texts.len() - 1).unwrap_or(u32::MAX));
        }
        let number = value.number(variables).unwrap_or(f64::NAN);
        match value {
            NamedValue::Axis(..) => Self::Measured(millionths(number)),
            NamedValue::Block(_) | NamedValue::RParameter(..) | NamedValue::Program(_) => Self::Number(number),
        }
    }

    /// Whether it has moved from the last value by at least a step, in the unit of the value.
    pub(super) fn has_moved(self, last: Self, step: f64) -> bool {
        match (self, last) {
            (Self::Measured(new), Self::Measured(last)) => {
                let moved = new.abs_diff(last);
                moved > 0 && moved >= millionths(step).unsigned_abs()
            }
            (Self::Number(new), Self::Number(last)) => new.to_bits() != last.to_bits() && (new - last).abs() >= step,
            (new, last) => new != last,
        }
    }

    /// As the trace shows it; an empty text is `-`.
    pub(super) fn shown(self, texts: &[Box<str>]) -> String {
        match self {
            Self::Measured(value) => decimals(value),
            Self::Number(value) => value.to_string(),
            Self::Text(index) => match texts.get(index as usize) {
                Some(text) if !text.is_empty() => text.to_string(),
                Some(_) | None => "-".to_owned(),
            },
        }
    }

    /// In millionths, for a curve; `None` for a text.
    pub(super) fn in_millionths(self) -> Option<i64> {
        match self {
            Self::Measured(value) => Some(value),
            Self::Number(value) => Some(millionths(value)),
            Self::Text(_) => None,
        }
    }
}

/// A value in millionths.
#[expect(clippy::cast_possible_truncation, reason = "float to integer casts saturate")]
pub(super) fn millionths(value: f64) -> i64 {
    (value * 1e6).round() as i64
}

/// Millionths as text with six decimals.
pub(super) fn decimals(millionths: i64) -> String {
    let sign = if millionths < 0 { "-" } else { "" };
    let digits = millionths.unsigned_abs();
    format!("{sign}{}.{:06}", digits / 1_000_000, digits % 1_000_000)
}
