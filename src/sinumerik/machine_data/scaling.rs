//! Units of length in the two basic systems (MD10240), and the conversion of a table of machine data.

use super::table::{Datum, Table};
use crate::control::Value;

/// A system of units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum System {
    Metric,
    Inch,
}

impl System {
    /// The word for it in a file.
    pub(super) const fn word(self) -> &'static str {
        match self {
            Self::Metric => "METRIC",
            Self::Inch => "INCH",
        }
    }
}

/// The number of metric units in one unit of the inch system; `None` for a datum that is not a length.
pub(super) fn metric_units(datum: &Datum, is_rotary: bool, millimetres: f64) -> Option<f64> {
    match datum.unit {
        "mm" | "mm/rev" => Some(millimetres),
        "mm, deg" | "mm/min" if !is_rotary => Some(millimetres),
        "m/s2" | "m/s3" if !is_rotary => Some(millimetres / 1_000.0),
        _ => None,
    }
}

/// Converts every length of a table into a system.
pub(super) fn convert<T: Table>(table: &mut T, is_rotary: bool, millimetres: f64, to: System) {
    for row in T::rows() {
        let Some(factor) = metric_units(&row.datum, is_rotary, millimetres) else { continue };
        for index in 0..usize::from(row.datum.count) {
            if let Some(number) = (row.get)(table, index).and_then(|value| value.number()) {
                let number = match to {
                    System::Metric => number * factor,
                    System::Inch => number / factor,
                };
                // A length is a finite number.
                let _ = (row.set)(table, index, &Value::Real(number));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sinumerik::machine_data::catalogue;

    #[test]
    fn a_length_is_converted_and_an_angle_a_time_and_a_ratio_are_not() {
        let units = |number: u32, is_rotary| {
            let datum = catalogue().find(|datum| datum.number == number).unwrap();
            metric_units(datum, is_rotary, 25.4)
        };
        assert_eq!(units(34_080, false), Some(25.4));
        assert_eq!(units(34_080, true), None);
        assert_eq!(units(32_300, false), Some(0.0254), "inch/s2 in m/s2");
        assert_eq!(units(32_430, false), Some(0.0254));
        assert_eq!(units(32_000, true), None, "rev/min");
        assert_eq!(units(31_030, true), Some(25.4), "a pitch is always a length");
        for number in [32_200, 36_020, 36_300, 32_260, 30_330] {
            assert_eq!(units(number, false), None, "{number}");
        }
        assert_eq!(units(41_110, false), Some(25.4));
        assert_eq!(units(41_130, false), None);
    }

    #[test]
    fn every_unit_of_the_catalogue_is_known_here() {
        let known = [
            "",
            "mm",
            "mm/rev",
            "mm, deg",
            "mm/min",
            "m/s2",
            "m/s3",
            "s",
            "%",
            "factor",
            "deg",
            "rev",
            "rev/min",
            "rev/s2",
            "1/rev",
            "1/mm",
            "1/deg",
            "(m/min)/mm",
            "Hz",
            "kgm2",
            "mm/inch",
        ];
        for datum in catalogue() {
            assert!(known.contains(&datum.unit), "{datum}: {}", datum.unit);
        }
    }
}
