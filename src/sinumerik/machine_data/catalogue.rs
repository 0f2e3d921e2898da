//! The catalogue: all known machine data, by number and by identifier.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::control::Value;
use crate::source;

use super::table::{Datum, Row, Scope, Table};
use super::{Axis, AxisSetting, Channel, ChannelSetting, General, Setting};

/// The numbers of all tables.
const NUMBERS: [&[u32]; 6] = [
    General::NUMBERS,
    Channel::NUMBERS,
    Axis::NUMBERS,
    Setting::NUMBERS,
    ChannelSetting::NUMBERS,
    AxisSetting::NUMBERS,
];

const _: () = check(&NUMBERS);

/// Checks at compile time that the rows of each table ascend, and that no number is in two tables. A second row would replace the first.
const fn check(tables: &[&[u32]]) {
    let mut table = 0;
    while table < tables.len() {
        let numbers = tables[table];
        let mut row = 0;
        while row < numbers.len() {
            assert!(
                row == 0 || numbers[row - 1] < numbers[row],
                "machine data must ascend by number, each number once"
            );
            let mut other = table + 1;
            while other < tables.len() {
                assert!(!has(tables[other], numbers[row]), "a number of machine data is in two tables");
                other += 1;
            }
            row += 1;
        }
        table += 1;
    }
}

const fn has(numbers: &[u32], number: u32) -> bool {
    let mut row = 0;
    while row < numbers.len() {
        if numbers[row] == number {
            return true;
        }
        row += 1;
    }
    false
}

/// All machine data with the number of their row, by number.
static BY_NUMBER: LazyLock<BTreeMap<u32, (&'static Datum, usize)>> = LazyLock::new(|| {
    let mut all = BTreeMap::new();
    collect(General::rows(), &mut all);
    collect(Channel::rows(), &mut all);
    collect(Axis::rows(), &mut all);
    collect(Setting::rows(), &mut all);
    collect(ChannelSetting::rows(), &mut all);
    collect(AxisSetting::rows(), &mut all);
    all
});

static BY_IDENTIFIER: LazyLock<BTreeMap<&'static str, &'static Datum>> =
    LazyLock::new(|| BY_NUMBER.values().map(|(datum, _)| (datum.identifier, *datum)).collect());

fn collect<T>(rows: &'static [Row<T>], all: &mut BTreeMap<u32, (&'static Datum, usize)>) {
    all.extend(rows.iter().enumerate().map(|(row, entry)| (entry.datum.number, (&entry.datum, row))));
}

/// All machine data, ascending by number.
pub fn catalogue() -> impl Iterator<Item = &'static Datum> {
    BY_NUMBER.values().map(|(datum, _)| *datum)
}

/// The datum with this number.
#[must_use]
pub fn by_number(number: u32) -> Option<&'static Datum> {
    BY_NUMBER.get(&number).map(|(datum, _)| *datum)
}

/// The datum with this identifier, with or without its prefix, in upper or lower case.
#[must_use]
pub fn by_identifier(identifier: &str) -> Option<&'static Datum> {
    let identifier = identifier.to_ascii_uppercase();
    match Scope::split(&identifier) {
        Some((scope, name)) => BY_IDENTIFIER.get(name).copied().filter(|datum| datum.scope == scope),
        None => BY_IDENTIFIER.get(identifier.as_str()).copied(),
    }
}

/// The known identifier nearest to a misspelt one, without prefix.
#[must_use]
pub fn nearest_identifier(identifier: &str) -> Option<&'static str> {
    let identifier = identifier.to_ascii_uppercase();
    let name = Scope::split(&identifier).map_or(identifier.as_str(), |(_, name)| name);
    source::nearest(name, BY_IDENTIFIER.keys().copied())
}

/// The cure for an identifier that is not in the catalogue: the nearest one. The name with its prefix is shown where only the prefix is
/// wrong.
#[must_use]
pub(super) fn meant(identifier: &str) -> Option<String> {
    let near = nearest_identifier(identifier)?;
    let has_this_name = identifier.to_ascii_uppercase().ends_with(near);
    let shown = by_identifier(near).filter(|_| has_this_name).map(Datum::full_identifier);
    Some(format!("did you mean `{}`?", shown.as_deref().unwrap_or(near)))
}

/// The row number of a datum in its table.
pub(super) fn row(number: u32) -> Option<usize> {
    BY_NUMBER.get(&number).map(|(_, row)| *row)
}

impl Scope {
    /// Splits an identifier into its scope and the rest.
    pub(super) fn split(identifier: &str) -> Option<(Self, &str)> {
        [Self::General, Self::Setting, Self::Channel, Self::ChannelSetting, Self::Axis, Self::AxisSetting]
            .into_iter()
            .find_map(|scope| identifier.strip_prefix(scope.prefix()).map(|name| (scope, name)))
    }
}

impl Datum {
    /// The default of the value at an index; of a linear axis, or of a rotary one.
    #[must_use]
    pub fn default_value(&self, index: u8, is_rotary: bool) -> Option<Value> {
        fn value<T: Table>(row: usize, table: &T, index: u8) -> Option<Value> {
            (T::rows().get(row)?.get)(table, usize::from(index))
        }
        let row = row(self.number)?;
        match self.scope {
            Scope::General => value(row, &General::default(), index),
            Scope::Setting => value(row, &Setting::default(), index),
            Scope::Channel => value(row, &Channel::default(), index),
            Scope::ChannelSetting => value(row, &ChannelSetting::default(), index),
            Scope::AxisSetting => value(row, &AxisSetting::default(), index),
            Scope::Axis if is_rotary => value(row, &Axis::rotary(), index),
            Scope::Axis => value(row, &Axis::default(), index),
        }
    }

    /// The default of a linear axis, at the first index, as the control writes it.
    #[must_use]
    pub fn default_text(&self) -> String {
        self.default_value(0, false).map_or_else(String::new, |value| value.export(self.kind))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Kind;
    use crate::sinumerik::machine_data::Effect;

    #[test]
    fn a_datum_is_found_by_number_and_by_identifier() {
        let datum = by_number(37100).unwrap();
        assert_eq!(datum.to_string(), "MD37100 $MA_GANTRY_AXIS_TYPE");
        assert_eq!((datum.kind, datum.count, datum.effect), (Kind::Byte, 1, Effect::PowerOn));
        assert_eq!(by_identifier("$MA_GANTRY_AXIS_TYPE"), Some(datum));
        assert_eq!(by_identifier("gantry_axis_type"), Some(datum));
        assert_eq!(by_identifier("$MC_GANTRY_AXIS_TYPE"), None);
        assert_eq!(nearest_identifier("$MA_GANTRY_AXIS_TYP"), Some("GANTRY_AXIS_TYPE"));
    }

    #[test]
    fn no_row_is_lost_and_every_identifier_is_unique() {
        let machine_data = General::rows().len() + Channel::rows().len() + Axis::rows().len();
        let settings = Setting::rows().len() + ChannelSetting::rows().len() + AxisSetting::rows().len();
        let rows = machine_data + settings;
        assert_eq!((catalogue().count(), BY_IDENTIFIER.len()), (rows, rows));
    }

    #[test]
    #[should_panic(expected = "a number of machine data is in two tables")]
    fn a_number_in_two_tables_is_rejected() {
        check(&[&[10_000, 10_001], &[20_000], &[10_001]]);
    }

    #[test]
    #[should_panic(expected = "machine data must ascend by number, each number once")]
    fn a_number_twice_in_one_table_is_rejected() {
        check(&[&[10_000, 10_000]]);
    }

    #[test]
    fn every_default_is_a_value_of_its_own_datum() {
        for datum in catalogue() {
            let value = Value::parse(&datum.default_text()).unwrap();
            if let Some(number) = value.number() {
                assert!(datum.range.contains(number), "{datum}");
            }
        }
        assert_eq!(by_number(32084).unwrap().default_text(), "'Hff'");
        assert_eq!(by_number(10000).unwrap().default_text(), "\"X1\"");
        assert!(by_number(34093).unwrap().read_only && !by_number(34090).unwrap().read_only);
    }
}
