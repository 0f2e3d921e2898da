//! The compensations of an axis in the units of the model, and a table of values.

use crate::sinumerik::machine_data::{Axis, MachineData, Points};
use crate::units::{AxisNumber, Position};

/// A table with values in increments.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct Table {
    first: i64,
    step: i64,
    repeats: bool,
    values: Vec<f64>,
}

impl Table {
    /// `None` if the points cannot be a table: MAX below MIN, or STEP not above 0.
    pub(super) fn new(points: &Points) -> Option<Self> {
        let [first, last, step] =
            [points.minimum, points.maximum, points.step].map(|user| Position::from_user(user).increments());
        if last < first || step <= 0 {
            return None;
        }
        let count = u16::try_from((last - first) / step).ok()?;
        let value = |point: u16| points.values.get(&point).copied().unwrap_or(0.0) * Position::PER_USER_UNIT;
        Some(Self { first, step, repeats: points.is_modulo, values: (0..=count).map(value).collect() })
    }

    /// The value at a position, in increments: linear between two points; beyond the table the value of its first or last point.
    pub(in crate::sinumerik) fn at(&self, position: Position) -> f64 {
        let mut distance = position.increments() - self.first;
        let length = self.step * i64::try_from(self.values.len() - 1).unwrap_or(0);
        if self.repeats && length > 0 {
            distance = distance.rem_euclid(length);
        }
        let distance = distance.clamp(0, length);
        let point = usize::try_from(distance / self.step).unwrap_or(0);
        let (before, part) = (self.values[point], distance % self.step);
        let Some(after) = self.values.get(point + 1) else { return before };
        before + (after - before) * (part as f64 / self.step as f64)
    }
}

/// The temperature compensation of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) struct Temperature {
    /// SD43900 while MD32750 bit 0 = 1, in increments.
    pub absolute: f64,
    /// SD43910 while MD32750 bit 1 = 1.
    pub slope: f64,
    /// SD43920.
    pub reference: Position,
    /// Largest change per cycle: MD32760 of MD32000, in increments.
    pub change: f64,
}

/// The sag compensation of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) struct Sag {
    /// MD32720, in increments.
    pub maximum: f64,
    /// Largest change per cycle: MD32730 of MD32000, in increments.
    pub change: f64,
    /// MD32720 and MD32730, for causes.
    pub data: [f64; 2],
}

/// The compensations of one axis.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct AxisCompensation {
    /// MD32450 × MD32452 of each encoder in each parameter set, in increments.
    pub backlash: [[f64; 6]; 2],
    /// MD32454 bit 0: the side of the play is kept over power off.
    pub keeps_side: bool,
    /// MD32454 bit 1: motion of other compensations does not change the side of the play, of each encoder.
    pub ignores_compensations: [bool; 2],
    /// Largest change of the compensation of an encoder per cycle: MD36500 in each position-control cycle; `None` without a limit.
    pub ramp: Option<i64>,
    /// `$AA_ENC_COMP` while MD32700 = 1.
    pub leadscrew: [Option<Table>; 2],
    /// MD32710.
    pub sag: Option<Sag>,
    /// MD32750.
    pub temperature: Option<Temperature>,
}

impl AxisCompensation {
    /// Whether any compensation can act.
    pub(in crate::sinumerik) fn exists(&self) -> bool {
        self.sag.is_some()
            || self.temperature.is_some()
            || self.leadscrew.iter().any(Option::is_some)
            || self.backlash.iter().flatten().any(|backlash| backlash.abs() > 0.0)
    }
}

/// The compensations of an axis; `maximum_velocity` is MD32000 in increments per second, `cycle` in seconds.
pub(super) fn axis_compensation(
    data: &MachineData,
    number: AxisNumber,
    maximum_velocity: f64,
    cycle: f64,
    servo_cycles: u32,
) -> AxisCompensation {
    let (md, settings) = (&data.axes[number], &data.axis_settings[number]);
    let user = |value: f64| value * Position::PER_USER_UNIT;
    let ramp = Position::from_user(md.enc_change_tol).increments().saturating_mul(servo_cycles.into());
    let bit = |encoder: usize, bit: u8| md.backlash_mode[encoder] & bit != 0;
    AxisCompensation {
        backlash: [0, 1].map(|encoder| md.backlash_factor.map(|factor| user(md.backlash[encoder]) * factor)),
        keeps_side: bit(0, 1) || bit(1, 1),
        ignores_compensations: [bit(0, 2), bit(1, 2)],
        ramp: (ramp > 0).then_some(ramp),
        leadscrew: [0u8, 1].map(|encoder| {
            let points = data.tables.leadscrew.get(&(number, encoder))?;
            if md.enc_comp_enable[usize::from(encoder)] { Table::new(points) } else { None }
        }),
        sag: sag(md, maximum_velocity, cycle),
        temperature: (md.temp_comp_type & 3 != 0).then(|| Temperature {
            absolute: if md.temp_comp_type & 1 != 0 { user(settings.temp_comp_abs_value) } else { 0.0 },
            slope: if md.temp_comp_type & 2 != 0 { settings.temp_comp_slope } else { 0.0 },
            reference: Position::from_user(settings.temp_comp_ref_position),
            change: maximum_velocity * md.comp_add_velo_factor * cycle,
        }),
    }
}

fn sag(md: &Axis, maximum_velocity: f64, cycle: f64) -> Option<Sag> {
    md.cec_enable.then(|| Sag {
        maximum: md.cec_max_sum * Position::PER_USER_UNIT,
        change: maximum_velocity * md.cec_max_velo / 100.0 * cycle,
        data: [md.cec_max_sum, md.cec_max_velo],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(step: f64, minimum: f64, maximum: f64, values: &[f64]) -> Points {
        let values = (0u16..).zip(values.iter().copied()).collect();
        Points { step, minimum, maximum, is_modulo: false, values }
    }

    fn at(table: &Table, position: f64) -> f64 {
        table.at(Position::from_user(position)) / Position::PER_USER_UNIT
    }

    fn assert_at(table: &Table, position: f64, expected: f64) {
        let value = at(table, position);
        assert!((value - expected).abs() < 1e-9, "{position}: {value}, expected {expected}");
    }

    /// Linear between the points MIN + n · STEP; before and behind the table its first and last value.
    #[test]
    fn a_table_is_linear_between_its_points_and_constant_beyond_them() {
        let table = Table::new(&points(10.0, 0.0, 20.0, &[0.1, 0.3, -0.1])).unwrap();
        for (position, expected) in
            [(-5.0, 0.1), (0.0, 0.1), (5.0, 0.2), (10.0, 0.3), (15.0, 0.1), (20.0, -0.1), (99.0, -0.1)]
        {
            assert_at(&table, position, expected);
        }
    }

    #[test]
    fn a_modulo_table_repeats() {
        let table =
            Table::new(&Points { is_modulo: true, ..points(90.0, 0.0, 360.0, &[0.0, 0.2, 0.0, -0.2, 0.0]) }).unwrap();
        for (position, expected) in [(45.0, 0.1), (405.0, 0.1), (-45.0, -0.1), (315.0, -0.1)] {
            assert_at(&table, position, expected);
        }
    }

    #[test]
    fn maximum_below_minimum_and_step_0_are_no_table() {
        assert_eq!(Table::new(&points(0.0, 0.0, 20.0, &[])), None);
        assert_eq!(Table::new(&points(10.0, 5.0, 0.0, &[])), None);
        assert_eq!(Table::new(&points(-1.0, 0.0, 5.0, &[])), None);
    }
}
