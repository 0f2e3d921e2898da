//! Tables of compensations: `$AA_ENC_COMP` (leadscrew error, one for each encoder) and `$AN_CEC` (sag), and the names of their elements.
//!
//! They are system variables, not machine data. Lengths are in millimetres or degrees, in every system of units (K-06).

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::units::AxisNumber;

/// The points of a table: positions from a minimum to a maximum, at equal distances.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Points {
    /// `_STEP`: the distance of two points.
    pub step: f64,
    /// `_MIN`: the position of the first point.
    pub minimum: f64,
    /// `_MAX`: the position of the last point.
    pub maximum: f64,
    /// `_IS_MODULO`: the table repeats after its last point.
    pub is_modulo: bool,
    /// The values by the number of their point; a point without a value has 0.
    pub values: BTreeMap<u16, f64>,
}

/// A table of sag compensation.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SagTable {
    /// Its points.
    pub points: Points,
    /// `_INPUT_AXIS`: the axis whose setpoint is the position in the table.
    pub input: Option<AxisNumber>,
    /// `_OUTPUT_AXIS`: the axis that gets the value.
    pub output: Option<AxisNumber>,
    /// `_DIRECTION`: +1 and -1 only while the input axis moves in this direction; 0 both directions.
    pub direction: i8,
    /// `_MULT_BY_TABLE`: the number, from 1, of the table with which this one is multiplied; 0 none.
    pub multiplied_by: u8,
}

/// All tables of a machine.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CompensationTables {
    /// The tables of the leadscrew errors, by axis and encoder (from 0).
    pub leadscrew: BTreeMap<(AxisNumber, u8), Points>,
    /// The tables of sag by their number.
    pub sag: BTreeMap<u8, SagTable>,
}

/// A part of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum Part {
    Value,
    Step,
    Minimum,
    Maximum,
    IsModulo,
    InputAxis,
    OutputAxis,
    Direction,
    MultipliedBy,
    Type,
}

/// A system variable of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) struct TableVariable {
    /// `$AN_CEC`, otherwise `$AA_ENC_COMP`.
    pub is_sag: bool,
    pub part: Part,
}

/// An element of a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) enum Element {
    /// `$AA_ENC_COMP…[encoder, point, axis]`.
    Leadscrew { axis: AxisNumber, encoder: u8, point: u16, part: Part },
    /// `$AN_CEC…[table, point]`.
    Sag { table: u8, point: u16, part: Part },
}

/// The value of an element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) enum TableValue {
    Number(f64),
    Axis(AxisNumber),
}

/// The reason for which an element is not written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum TableRefusal {
    /// The encoder or table does not exist, or has fewer points; the datum of its size.
    Index(u32),
    /// Another value is expected.
    Value(&'static str),
    /// The compensation is active: the datum that must be 0 (17070).
    Active(u32, AxisNumber),
}

impl TableVariable {
    /// The variable of this name without its indices: `$AN_CEC_STEP`.
    pub(in crate::sinumerik) fn named(name: &str) -> Option<Self> {
        let name = name.to_ascii_uppercase();
        let (is_sag, part) = match (name.strip_prefix("$AN_CEC"), name.strip_prefix("$AA_ENC_COMP")) {
            (Some(part), _) => (true, part),
            (None, Some(part)) => (false, part),
            (None, None) => return None,
        };
        let part = match (part, is_sag) {
            ("", _) => Part::Value,
            ("_STEP", _) => Part::Step,
            ("_MIN", _) => Part::Minimum,
            ("_MAX", _) => Part::Maximum,
            ("_IS_MODULO", _) => Part::IsModulo,
            ("_INPUT_AXIS", true) => Part::InputAxis,
            ("_OUTPUT_AXIS", true) => Part::OutputAxis,
            ("_DIRECTION", true) => Part::Direction,
            ("_MULT_BY_TABLE", true) => Part::MultipliedBy,
            ("_TYPE", true) => Part::Type,
            _ => return None,
        };
        Some(Self { is_sag, part })
    }

    /// The element with these numbers in brackets and this axis; `None` if they are too many or too few.
    pub(in crate::sinumerik) fn element(self, numbers: &[f64], axis: Option<AxisNumber>) -> Option<Element> {
        let number = |index: usize| {
            let number = numbers.get(index).copied().filter(|number| number.fract() == 0.0)?;
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tested with it")]
            let whole = number as u16;
            (0.0..65_535.0).contains(&number).then_some(whole)
        };
        let (expected, point) = if self.part == Part::Value { (2, number(1)?) } else { (1, 0) };
        let first = u8::try_from(number(0)?).ok()?;
        match (self.is_sag, axis) {
            _ if numbers.len() != expected => None,
            (true, None) => Some(Element::Sag { table: first, point, part: self.part }),
            (false, Some(axis)) => Some(Element::Leadscrew { axis, encoder: first, point, part: self.part }),
            (true, Some(_)) | (false, None) => None,
        }
    }
}

impl Element {
    /// The datum with the number of points of its table.
    pub(in crate::sinumerik) const fn size_datum(self) -> u32 {
        match self {
            Self::Leadscrew { .. } => 38000,
            Self::Sag { .. } => 18342,
        }
    }
}

impl CompensationTables {
    /// The value was checked.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the value was checked")]
    pub(super) fn store(&mut self, element: Element, value: TableValue) {
        let (points, point, part) = match element {
            Element::Leadscrew { axis, encoder, point, part } => {
                (self.leadscrew.entry((axis, encoder)).or_default(), point, part)
            }
            Element::Sag { table, point, part } => {
                let table = self.sag.entry(table).or_default();
                match (part, value) {
                    (Part::InputAxis, TableValue::Axis(axis)) => table.input = Some(axis),
                    (Part::OutputAxis, TableValue::Axis(axis)) => table.output = Some(axis),
                    (Part::Direction, TableValue::Number(number)) => table.direction = number as i8,
                    (Part::MultipliedBy, TableValue::Number(number)) => table.multiplied_by = number as u8,
                    _ => {}
                }
                (&mut table.points, point, part)
            }
        };
        let TableValue::Number(number) = value else { return };
        match part {
            Part::Value => {
                points.values.insert(point, number);
            }
            Part::Step => points.step = number,
            Part::Minimum => points.minimum = number,
            Part::Maximum => points.maximum = number,
            Part::IsModulo => points.is_modulo = number > 0.0,
            Part::InputAxis | Part::OutputAxis | Part::Direction | Part::MultipliedBy | Part::Type => {}
        }
    }
}
