//! The macro for tables of machine data. Each row is one datum and generates the typed field, its default, the
//! catalogue entry and the access by number.
//!
//! The tables are `general.rs`, `channel.rs`, `axis.rs` and, for setting data, `setting.rs`, `channel_setting.rs`, `axis_setting.rs`.

use std::fmt;

use serde::{Deserialize, Serialize};

use crate::control::{Kind, Value};

/// The scope of a datum, which defines its prefix in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Scope {
    /// General machine data, `$MN_`.
    General,
    /// General setting data, `$SN_`.
    Setting,
    /// Channel-specific machine data, `$MC_`.
    Channel,
    /// Channel-specific setting data, `$SC_`.
    ChannelSetting,
    /// Axis-specific machine data, `$MA_`.
    Axis,
    /// Axis-specific setting data, `$SA_`.
    AxisSetting,
}

impl Scope {
    /// The prefix in a file.
    #[must_use]
    pub const fn prefix(self) -> &'static str {
        match self {
            Self::General => "$MN_",
            Self::Setting => "$SN_",
            Self::Channel => "$MC_",
            Self::ChannelSetting => "$SC_",
            Self::Axis => "$MA_",
            Self::AxisSetting => "$SA_",
        }
    }
}

/// The time at which a stored value takes effect. The classes are ordered: data that take effect at a lower level also
/// take effect at a higher one (O-23: NEWCONF data also become active by RESET).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Effect {
    /// At once.
    Immediate,
    /// By "set machine data active".
    NewConf,
    /// By RESET.
    Reset,
    /// By power off and on.
    PowerOn,
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Immediate => "immediate",
            Self::NewConf => "NEWCONF",
            Self::Reset => "RESET",
            Self::PowerOn => "POWER ON",
        })
    }
}

/// The permitted values of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The smallest value, if any.
    pub minimum: Option<f64>,
    /// The largest value, if any.
    pub maximum: Option<f64>,
    /// Smaller values are permitted, because controls accept them, but no function works with them (O-30).
    pub plausible_from: Option<f64>,
}

impl Range {
    /// Any value of the type.
    pub const ANY: Self = Self { minimum: None, maximum: None, plausible_from: None };
    /// Larger than any value of a real machine, and small enough that sums of positions in nanometres stay exact.
    const LARGEST: f64 = 1e9;
    /// A position or a distance of either sign.
    pub const POSITION: Self = Self::between(-Self::LARGEST, Self::LARGEST);
    /// Zero or more.
    pub const NOT_NEGATIVE: Self = Self::between(0.0, Self::LARGEST);
    /// More than zero; zero is permitted, but implausible.
    pub const POSITIVE: Self = Self { plausible_from: Some(f64::MIN_POSITIVE), ..Self::NOT_NEGATIVE };
    /// A distance that is at least one increment; less is permitted, but implausible.
    pub const INCREMENT: Self = Self { plausible_from: Some(0.000_001), ..Self::NOT_NEGATIVE };

    /// From one value to another, both included.
    #[must_use]
    pub const fn between(minimum: f64, maximum: f64) -> Self {
        Self { minimum: Some(minimum), maximum: Some(maximum), plausible_from: None }
    }

    /// Whether a value is permitted.
    #[must_use]
    pub fn contains(&self, value: f64) -> bool {
        self.minimum.is_none_or(|minimum| value >= minimum) && self.maximum.is_none_or(|maximum| value <= maximum)
    }

    /// Whether a value is permitted and functions can work with it.
    #[must_use]
    pub fn is_plausible(&self, value: f64) -> bool {
        self.contains(value) && self.plausible_from.is_none_or(|least| value >= least)
    }

    /// The permitted value nearest to a value.
    #[must_use]
    pub fn nearest(&self, value: f64) -> f64 {
        let value = self.minimum.map_or(value, |minimum| value.max(minimum));
        self.maximum.map_or(value, |maximum| value.min(maximum))
    }
}

/// The plausible values.
impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let least = self.plausible_from.filter(|least| *least > f64::MIN_POSITIVE).or(self.minimum);
        let above = self.plausible_from.is_some_and(|least| least <= f64::MIN_POSITIVE);
        match (least, self.maximum) {
            (None, None) => f.write_str("any value"),
            (Some(minimum), None) if above => write!(f, "more than {minimum}"),
            (Some(minimum), None) => write!(f, "{minimum} or more"),
            (None, Some(maximum)) => write!(f, "{maximum} or less"),
            (Some(minimum), Some(maximum)) if above => write!(f, "more than {minimum} and at most {maximum}"),
            (Some(minimum), Some(maximum)) => write!(f, "{minimum} to {maximum}"),
        }
    }
}

/// A row of the catalogue: the description of a machine datum.
#[derive(Clone, Debug, PartialEq)]
pub struct Datum {
    /// Its number, `37100`.
    pub number: u32,
    /// Its name without the prefix, `GANTRY_AXIS_TYPE`.
    pub identifier: &'static str,
    /// Its scope.
    pub scope: Scope,
    /// Its type.
    pub kind: Kind,
    /// Its unit in the metric basic system with linear axes; empty without a unit.
    pub unit: &'static str,
    /// Its permitted values.
    pub range: Range,
    /// Number of its values (2 per encoder, 6 per parameter set, …); 1 without an index.
    pub count: u16,
    /// The time at which a stored value takes effect.
    pub effect: Effect,
    /// Only the control writes it. An archive may contain it.
    pub read_only: bool,
    /// Its meaning.
    pub doc: &'static str,
}

/// The number and the full name, `MD37100 $MA_GANTRY_AXIS_TYPE`.
impl fmt::Display for Datum {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", datum_name(self.number), self.full_identifier())
    }
}

impl Datum {
    /// The indices of its values.
    pub fn indices(&self) -> impl Iterator<Item = u8> + use<> {
        (0..=u8::MAX).take(usize::from(self.count))
    }

    /// The identifier with its prefix, `$MA_GANTRY_AXIS_TYPE`.
    #[must_use]
    pub fn full_identifier(&self) -> String {
        format!("{}{}", self.scope.prefix(), self.identifier)
    }
}

/// A number in its usual form: 41000 to 43999 are setting data, all others are machine data.
pub(in crate::sinumerik) fn datum_name(number: u32) -> String {
    let kind = if (41_000..44_000).contains(&number) { "SD" } else { "MD" };
    format!("{kind}{number}")
}

/// A datum and the access to its field.
pub(super) struct Row<T: 'static> {
    pub(super) datum: Datum,
    pub(super) get: fn(&T, usize) -> Option<Value>,
    pub(super) set: fn(&mut T, usize, &Value) -> Result<(), String>,
    pub(super) copy: fn(&mut T, &T),
}

/// A table of machine data.
pub(super) trait Table: Default + 'static {
    /// Its rows, ascending by number.
    fn rows() -> &'static [Row<Self>];

    /// The defaults of a rotary axis, which differ for velocities and accelerations.
    fn rotary() -> Self;

    /// Copies every datum that takes effect at this level.
    fn activate(&mut self, stored: &Self, level: Effect) {
        for row in Self::rows().iter().filter(|row| row.datum.effect <= level) {
            (row.copy)(self, stored);
        }
    }

    /// Replaces every unchanged default of one axis type by the default of the other axis type.
    fn exchange_defaults(&mut self, from: &Self, to: &Self) {
        for row in Self::rows() {
            for index in 0..usize::from(row.datum.count) {
                let (old, new) = ((row.get)(from, index), (row.get)(to, index));
                if old != new
                    && (row.get)(self, index) == old
                    && let Some(new) = new
                {
                    // A default fits its own field.
                    let _ = (row.set)(self, index, &new);
                }
            }
        }
    }
}

/// The type of a datum without an index.
pub(super) trait Scalar: Clone {
    const KIND: Kind;
    fn value(&self) -> Value;
    /// Converts a value. The error names what was expected.
    fn from_value(value: &Value) -> Result<Self, String>;
}

impl Scalar for bool {
    const KIND: Kind = Kind::Boolean;
    fn value(&self) -> Value {
        Value::Boolean(*self)
    }
    fn from_value(value: &Value) -> Result<Self, String> {
        match value {
            Value::Boolean(value) => Ok(*value),
            Value::Text(_) => Err("0 or 1".to_owned()),
            Value::Integer(_) | Value::Real(_) => match value.whole() {
                Some(0) => Ok(false),
                Some(1) => Ok(true),
                _ => Err("0 or 1".to_owned()),
            },
        }
    }
}

/// A whole number type and its entry in [`Kind`].
macro_rules! whole_number {
    ($type:ty, $kind:ident, $expected:literal) => {
        impl Scalar for $type {
            const KIND: Kind = Kind::$kind;
            fn value(&self) -> Value {
                Value::Integer(i64::from(*self))
            }
            fn from_value(value: &Value) -> Result<Self, String> {
                value.whole().and_then(|whole| Self::try_from(whole).ok()).ok_or_else(|| $expected.to_owned())
            }
        }
    };
}

whole_number!(u8, Byte, "a whole number from 0 to 255");

whole_number!(i32, Dword, "a whole number of 32 bits");

whole_number!(u32, Udword, "32 bits such as 'H0F'");

impl Scalar for f64 {
    const KIND: Kind = Kind::Double;
    fn value(&self) -> Value {
        Value::Real(*self)
    }
    fn from_value(value: &Value) -> Result<Self, String> {
        value.number().filter(|number| number.is_finite()).ok_or_else(|| "a finite number".to_owned())
    }
}

impl Scalar for String {
    const KIND: Kind = Kind::String;
    fn value(&self) -> Value {
        Value::Text(self.clone())
    }
    fn from_value(value: &Value) -> Result<Self, String> {
        match value {
            Value::Text(text) if !text.contains(['"', '\n', '\r']) => Ok(text.clone()),
            Value::Text(_) | Value::Boolean(_) | Value::Integer(_) | Value::Real(_) => {
                Err("a text in quotes, without quotes and line ends inside".to_owned())
            }
        }
    }
}

/// The type of a datum: one scalar, or several with an index.
pub(super) trait Field: Clone {
    const KIND: Kind;
    const COUNT: u16;
    fn value(&self, index: usize) -> Option<Value>;
    fn store(&mut self, index: usize, value: &Value) -> Result<(), String>;
}

impl<T: Scalar> Field for T {
    const KIND: Kind = T::KIND;
    const COUNT: u16 = 1;
    fn value(&self, index: usize) -> Option<Value> {
        (index == 0).then(|| Scalar::value(self))
    }
    fn store(&mut self, index: usize, value: &Value) -> Result<(), String> {
        if index != 0 {
            return Err("no index, or index 0".to_owned());
        }
        *self = T::from_value(value)?;
        Ok(())
    }
}

impl<T: Scalar, const N: usize> Field for [T; N] {
    const KIND: Kind = T::KIND;
    #[expect(clippy::cast_possible_truncation, reason = "no datum has more than 62 values")]
    const COUNT: u16 = N as u16;
    fn value(&self, index: usize) -> Option<Value> {
        self.get(index).map(Scalar::value)
    }
    fn store(&mut self, index: usize, value: &Value) -> Result<(), String> {
        let place = self.get_mut(index).ok_or_else(|| format!("an index from 0 to {}", N - 1))?;
        *place = T::from_value(value)?;
        Ok(())
    }
}

/// One value for each of the 62 tables of sag compensation. Two arrays, because longer ones cannot be saved.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PerTable<T>([[T; 31]; 2]);

impl<T: Copy> PerTable<T> {
    /// The same value for all tables.
    pub const fn filled(value: T) -> Self {
        Self([[value; 31]; 2])
    }

    /// The value of a table, from 0.
    #[must_use]
    pub fn get(&self, table: usize) -> Option<T> {
        self.0.get(table / 31)?.get(table % 31).copied()
    }
}

impl<T: Scalar> Field for PerTable<T> {
    const KIND: Kind = T::KIND;
    const COUNT: u16 = 62;
    fn value(&self, index: usize) -> Option<Value> {
        self.0.get(index / 31)?.get(index % 31).map(Scalar::value)
    }
    fn store(&mut self, index: usize, value: &Value) -> Result<(), String> {
        let place = self.0.get_mut(index / 31).and_then(|half| half.get_mut(index % 31));
        *place.ok_or_else(|| format!("an index from 0 to {}", Self::COUNT - 1))? = T::from_value(value)?;
        Ok(())
    }
}

/// Many values, of which most have their default: only those up to the last other one are saved.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Many<T, const N: usize>(Vec<T>);

impl<T: Copy + Default, const N: usize> Many<T, N> {
    /// A value, from 0; the default beyond the last one that was stored.
    #[must_use]
    pub fn get(&self, index: usize) -> T {
        self.0.get(index).copied().unwrap_or_default()
    }
}

impl<T: Scalar + Copy + Default + PartialEq, const N: usize> Field for Many<T, N> {
    const KIND: Kind = T::KIND;
    #[expect(clippy::cast_possible_truncation, reason = "no datum has more than 256 values")]
    const COUNT: u16 = N as u16;
    fn value(&self, index: usize) -> Option<Value> {
        (index < N).then(|| Scalar::value(&self.get(index)))
    }
    fn store(&mut self, index: usize, value: &Value) -> Result<(), String> {
        if index >= N {
            return Err(format!("an index from 0 to {}", N - 1));
        }
        let value = T::from_value(value)?;
        if index >= self.0.len() {
            self.0.resize(index + 1, T::default());
        }
        self.0[index] = value;
        while self.0.last() == Some(&T::default()) {
            self.0.pop();
        }
        Ok(())
    }
}

/// A table of machine data. A row: meaning; number, identifier, field, type, default (and the default of a rotary
/// axis); unit, range, effect (and `read_only true`).
macro_rules! machine_data {
    (
        $(#[$table_doc:meta])*
        $table:ident {
            $(
                $(#[doc = $doc:literal])+
                $number:literal $identifier:ident $field:ident: $type:ty = $default:expr $(, rotary $rotary:expr)?;
                $unit:literal, $range:expr, $effect:ident $(, read_only $read_only:literal)?;
            )+
        }
        scope $scope:ident
    ) => {
        $(#[$table_doc])*
        #[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
        pub struct $table {
            $(
                #[doc = concat!(
                    "`", $number, " ", stringify!($identifier), "`:", $($doc,)+
                    " (unit `", $unit, "`, acts by ", stringify!($effect), ")."
                )]
                pub $field: $type,
            )+
        }

        impl $table {
            /// The numbers of its data, in the order of its rows.
            pub(super) const NUMBERS: &'static [u32] = &[$($number),+];
        }

        impl Default for $table {
            fn default() -> Self {
                Self { $($field: $default,)+ }
            }
        }

        impl $crate::sinumerik::machine_data::table::Table for $table {
            fn rotary() -> Self {
                #[allow(clippy::needless_update, reason = "a table may have a pair in every row")]
                Self { $($($field: $rotary,)?)+ ..Self::default() }
            }

            fn rows() -> &'static [$crate::sinumerik::machine_data::table::Row<Self>] {
                use $crate::sinumerik::machine_data::table::{Datum, Effect, Field, Range, Row, Scope};
                static ROWS: &[Row<$table>] = &[
                    $(Row {
                        datum: Datum {
                            number: $number,
                            identifier: stringify!($identifier),
                            scope: Scope::$scope,
                            kind: <$type as Field>::KIND,
                            unit: $unit,
                            range: $range,
                            count: <$type as Field>::COUNT,
                            effect: Effect::$effect,
                            read_only: false $(|| $read_only)?,
                            doc: concat!($($doc,)+ "").trim_ascii(),
                        },
                        get: |table, index| Field::value(&table.$field, index),
                        set: |table, index, value| Field::store(&mut table.$field, index, value),
                        copy: |to, from| to.$field.clone_from(&from.$field),
                    },)+
                ];
                ROWS
            }
        }
    };
}

pub(super) use machine_data;
