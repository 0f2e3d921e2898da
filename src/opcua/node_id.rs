//! The identifiers of the namespace `SinumerikVarProvider`. They are texts in which upper and lower case differ. Most of them cannot be found by
//! browsing, because they have any number of indices. This file reads only the text; `reading.rs` finds what the machine has.
//!
//! | text | meaning |
//! |---|---|
//! | `/Plc/M5.0`, `/Plc/DB31.DBX60.4`, `/Plc/DB5.DBW2:INT`, `/Plc/DB8.DBW2:[10]`, `/Plc/DB2.DBD0:REAL[10]` | an address of STEP 7 |
//! | `/Plc/MB`, `/Plc/DB100.DBW` | a pattern for browsing, without a value |
//! | `/Channel/Parameter/R[u2,56]`, `R[10]`, `R[u1,1,5]`, `R[u1,1,#5]` | an NC variable: unit, index, then the last one or `#` the number |
//! | `/NC/_N_CH_TEA_ACX/$MC_CHAN_NAME[u2]` | a machine datum; its index counts from 1 |
//! | `/OpenNCK/Cycle` | a value of the simulator |

use super::member::Member;
use crate::image::{Address, Area, Width};
use crate::variables::nc::{CATALOGUE, Named, Variable, by_path};

/// What the text of an identifier stands for.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Id {
    Plc(Plc),
    /// An address without its number.
    Pattern(&'static str, Type),
    Variable(Nc),
    /// A variable that controls have and this simulator has not.
    Absent,
    Datum(Datum),
    Own(Own),
    /// A member of an object of OPC 40502.
    Cnc(Member),
}

/// The type of an address in the memory of the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    Bool,
    Byte,
    Word,
    DoubleWord,
    Int,
    DoubleInt,
    Real,
    Char,
    String,
    Timer,
    Counter,
}

/// An address in the memory of the PLC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plc {
    pub(super) area: Area,
    pub(super) byte: u16,
    pub(super) width: Width,
    pub(super) kind: Type,
    /// The number of elements of an array.
    pub(super) count: Option<u16>,
}

/// A row of the catalogue and its index.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nc {
    pub(super) variable: &'static Variable,
    /// The index is the number of an R parameter.
    pub(super) is_r: bool,
    pub(super) index: Index,
}

impl PartialEq for Nc {
    fn eq(&self, other: &Self) -> bool {
        (self.variable.name, self.is_r, self.index) == (other.variable.name, other.is_r, other.index)
    }
}

/// A machine datum by its identifier.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Datum {
    pub(super) scope: Scope,
    pub(super) identifier: String,
    pub(super) index: Index,
}

/// The owner of a machine datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scope {
    Nck,
    Channel,
    Axis,
}

impl Scope {
    pub(super) const ALL: [Self; 3] = [Self::Nck, Self::Channel, Self::Axis];

    /// The folder, and the beginning of the identifiers.
    pub(super) const fn names(self) -> (&'static str, &'static str) {
        match self {
            Self::Nck => ("_N_NC_TEA_ACX", "$MN_"),
            Self::Channel => ("_N_CH_TEA_ACX", "$MC_"),
            Self::Axis => ("_N_AX_TEA_ACX", "$MA_"),
        }
    }

    /// The code of the area of NC variables.
    pub(super) const fn area(self) -> u8 {
        match self {
            Self::Nck => 0,
            Self::Channel => 2,
            Self::Axis => 3,
        }
    }
}

/// A value of the simulator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Own {
    Cycle,
    Time,
    Speed,
}

impl Own {
    pub(super) const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Cycle, "Cycle", "The number of the interpolation cycle."),
        (Self::Time, "Time", "Simulated time in seconds."),
        (Self::Speed, "Speed", "Speed relative to real time."),
    ];
}

/// Unit, index and number of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Index {
    pub(super) unit: u8,
    pub(super) first: u16,
    /// The number of elements of an array.
    pub(super) count: Option<u16>,
}

/// The most elements of an array.
const MOST: u16 = 4096;

impl Id {
    /// `None` if no control has such a node.
    pub(super) fn parse(text: &str) -> Option<Self> {
        if let Some(address) = text.strip_prefix("/Plc/") {
            return pattern(address).or_else(|| plc(address).map(Self::Plc));
        }
        if let Some(name) = text.strip_prefix("/OpenNCK/") {
            return Own::ALL.into_iter().find(|(_, known, _)| *known == name).map(|(own, ..)| Self::Own(own));
        }
        if let Some(member) = Member::parse(text) {
            return Some(Self::Cnc(member));
        }
        let (path, index) = split_index(text)?;
        if let Some(rest) = path.strip_prefix("/NC/") {
            let (folder, identifier) = rest.split_once('/')?;
            let scope = Scope::ALL.into_iter().find(|scope| scope.names().0 == folder)?;
            let identifier = identifier.starts_with(scope.names().1).then(|| identifier.to_owned())?;
            // Some texts of machine data are rows of the catalogue.
            let is_it = |row: &&Variable| row.name[2..] == identifier && row.area.code() == scope.area();
            return Some(match CATALOGUE.iter().find(is_it) {
                Some(variable) => Self::Variable(Nc { variable, is_r: false, index }),
                None => Self::Datum(Datum { scope, identifier, index }),
            });
        }
        Some(match by_path(path)? {
            Named::Absent => Self::Absent,
            Named::Variable(variable) => Self::Variable(Nc { variable, is_r: false, index }),
            Named::RParameter(variable) => Self::Variable(Nc { variable, is_r: true, index }),
        })
    }
}

/// Splits a text before its brackets. Blanks inside the brackets mean nothing.
fn split_index(text: &str) -> Option<(&str, Index)> {
    let Some((path, inside)) = text.split_once('[') else {
        return Some((text, Index { unit: 1, first: 1, count: None }));
    };
    let inside: String = inside.strip_suffix(']')?.chars().filter(|letter| *letter != ' ').collect();
    let mut parts = inside.split(',').peekable();
    let unit = match parts.peek()?.strip_prefix('u') {
        Some(unit) => {
            parts.next();
            number(unit)?
        }
        None => 1,
    };
    let first = parts.next().map_or(Some(1), number)?;
    let count = match parts.next() {
        None => None,
        Some(last) => Some(match last.strip_prefix('#') {
            Some(count) => number::<u16>(count)?,
            None => number::<u16>(last)?.checked_sub(first)?.checked_add(1)?,
        }),
    };
    let is_possible = count.is_none_or(|count| (1..=MOST).contains(&count)) && parts.next().is_none();
    is_possible.then_some((path, Index { unit, first, count }))
}

/// Digits only: no sign.
fn number<T: std::str::FromStr>(text: &str) -> Option<T> {
    text.bytes().all(|digit| digit.is_ascii_digit()).then(|| text.parse().ok()).flatten()
}

/// The patterns of the areas; those of data blocks end with the kind.
const PATTERNS: [(&str, Type); 12] = [
    ("MB", Type::Byte),
    ("MW", Type::Word),
    ("MD", Type::DoubleWord),
    ("IB", Type::Byte),
    ("IW", Type::Word),
    ("ID", Type::DoubleWord),
    ("QB", Type::Byte),
    ("QW", Type::Word),
    ("QD", Type::DoubleWord),
    ("T", Type::Timer),
    ("C", Type::Counter),
    ("M", Type::Bool),
];

fn pattern(text: &str) -> Option<Id> {
    if let Some((pattern, kind)) = PATTERNS.into_iter().find(|(pattern, _)| *pattern == text) {
        return Some(Id::Pattern(pattern, kind));
    }
    let (block, kind) = text.strip_prefix("DB")?.split_once('.')?;
    number::<u16>(block)?;
    Some(match kind {
        "DBX" => Id::Pattern("DBX", Type::Bool),
        "DBB" => Id::Pattern("DBB", Type::Byte),
        "DBW" => Id::Pattern("DBW", Type::Word),
        "DBD" => Id::Pattern("DBD", Type::DoubleWord),
        _ => return None,
    })
}

fn plc(text: &str) -> Option<Plc> {
    let (plain, suffix) = text.split_once(':').map_or((text, None), |(plain, suffix)| (plain, Some(suffix)));
    let Address { area, byte, width, .. } = plain.parse().ok()?;
    let default = match (area, width) {
        (Area::Timers, _) => Type::Timer,
        (Area::Counters, _) => Type::Counter,
        (_, Width::Bit(_)) => Type::Bool,
        (_, Width::Bits { .. }) => return None,
        (_, Width::Byte) => Type::Byte,
        (_, Width::Word) => Type::Word,
        (_, Width::Double) => Type::DoubleWord,
    };
    let (kind, count) = match suffix {
        None => (default, None),
        Some(suffix) => {
            let (kind, rest) = suffix.split_at(suffix.find('[').unwrap_or(suffix.len()));
            let kind = if kind.is_empty() { default } else { named(kind, default, width)? };
            let inside = |rest: &str| number(rest.strip_prefix('[')?.strip_suffix(']')?.trim());
            let count = if rest.is_empty() { None } else { Some(inside(rest)?) };
            if suffix.is_empty() || count.is_some_and(|count| !(1..=MOST).contains(&count)) {
                return None;
            }
            (kind, count)
        }
    };
    // There are no arrays of texts, and a bit has no neighbour of its own type.
    let is_possible = count.is_none() || !matches!(kind, Type::String | Type::Bool);
    is_possible.then_some(Plc { area, byte, width, kind, count })
}

/// The type with a name, if an address of this width can have it.
fn named(name: &str, default: Type, width: Width) -> Option<Type> {
    Some(match (name, width) {
        ("BOOL", Width::Bit(_)) => Type::Bool,
        ("TIMER", _) if default == Type::Timer => Type::Timer,
        ("COUNTER", _) if default == Type::Counter => Type::Counter,
        _ if matches!(default, Type::Timer | Type::Counter) => return None,
        ("BYTE", Width::Byte) => Type::Byte,
        ("CHAR", Width::Byte | Width::Word) => Type::Char,
        ("STRING", Width::Byte | Width::Word) => Type::String,
        ("WORD", Width::Word) => Type::Word,
        ("INT", Width::Word) => Type::Int,
        ("DWORD", Width::Double) => Type::DoubleWord,
        ("DINT", Width::Double) => Type::DoubleInt,
        ("REAL", Width::Double) => Type::Real,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn index(text: &str) -> Option<(u8, u16, Option<u16>)> {
        split_index(text).map(|(_, Index { unit, first, count })| (unit, first, count))
    }

    /// The forms of the manual, and those of client sources.
    #[test]
    fn an_index_has_a_unit_a_first_and_a_last_element() {
        for (text, found) in [
            ("R", Some((1, 1, None))),
            ("R[u2,56]", Some((2, 56, None))),
            ("R[u2]", Some((2, 1, None))),
            ("R[10]", Some((1, 10, None))),
            ("R[0]", Some((1, 0, None))),
            ("R[u1,1,5]", Some((1, 1, Some(5)))),
            ("R[u1,3,5]", Some((1, 3, Some(3)))),
            ("R[u1,1,#5]", Some((1, 1, Some(5)))),
            ("R[u1, 1]", Some((1, 1, None))),
            ("R[ u1 , 1 ]", Some((1, 1, None))),
            ("R[u1,5,1]", None),
            ("R[u1,1,#0]", None),
            ("R[u1,1,#5000]", None),
            ("R[u1,1,2,3]", None),
            ("R[]", None),
            ("R[u]", None),
            ("R[-1]", None),
            ("R[u1,1", None),
            ("R[u1,1]x", None),
            ("R[u999]", None),
            ("R[99999]", None),
        ] {
            assert_eq!(index(text), found, "{text}");
        }
    }

    fn address(text: &str) -> Option<(Type, Option<u16>)> {
        match Id::parse(text)? {
            Id::Plc(Plc { kind, count, .. }) => Some((kind, count)),
            _ => None,
        }
    }

    #[test]
    fn an_address_has_a_default_type_or_the_type_after_the_colon() {
        for (text, found) in [
            ("/Plc/M5.0", Some((Type::Bool, None))),
            ("/Plc/DB21.DBX7.1", Some((Type::Bool, None))),
            ("/Plc/MB5", Some((Type::Byte, None))),
            ("/Plc/DB5.DBW2", Some((Type::Word, None))),
            ("/Plc/DB5.DBD2", Some((Type::DoubleWord, None))),
            ("/Plc/DB2.DBD0:REAL", Some((Type::Real, None))),
            ("/Plc/DB2.DBD0:REAL[10]", Some((Type::Real, Some(10)))),
            ("/Plc/DB8.DBW2:[10]", Some((Type::Word, Some(10)))),
            ("/Plc/DB8.DBB2:STRING", Some((Type::String, None))),
            ("/Plc/DB8.DBB2:CHAR", Some((Type::Char, None))),
            ("/Plc/T5", Some((Type::Timer, None))),
            ("/Plc/C5", Some((Type::Counter, None))),
            ("/Plc/DB8.DBB2:STRING[2]", None),
            ("/Plc/DB5.DBX0.0:[8]", None),
            ("/Plc/DB5.DBW2:REAL", None),
            ("/Plc/DB5.DBX2.0:INT", None),
            ("/Plc/DB5.DBW2:", None),
            ("/Plc/DB5.DBW2:[0]", None),
            ("/Plc/DB5.DBW2:[9999]", None),
            ("/Plc/DB5.DBX2.8", None),
            ("/Plc/DB10.DBX100.0..4", None),
            ("/Plc/X", None),
            ("/Plc/", None),
            ("/plc/M5.0", None),
        ] {
            assert_eq!(address(text), found, "{text}");
        }
    }

    #[test]
    fn a_pattern_is_an_address_without_its_number() {
        assert_eq!(Id::parse("/Plc/MB"), Some(Id::Pattern("MB", Type::Byte)));
        assert_eq!(Id::parse("/Plc/DB100.DBW"), Some(Id::Pattern("DBW", Type::Word)));
        assert_eq!(Id::parse("/Plc/DB100"), None);
        assert_eq!(Id::parse("/Plc/DBx.DBW"), None);
    }

    #[test]
    fn other_ids_are_variables_machine_data_and_values_of_the_simulator() {
        let Some(Id::Variable(nc)) = Id::parse("/Channel/Parameter/R[u1,1,5]") else { panic!("it is a variable") };
        assert_eq!((nc.is_r, nc.index), (true, Index { unit: 1, first: 1, count: Some(5) }));
        let Some(Id::Variable(name)) = Id::parse("/NC/_N_CH_TEA_ACX/$MC_CHAN_NAME[u2]") else { panic!("it is a row") };
        assert_eq!((name.variable.name, name.index.unit), ("C/$MC_CHAN_NAME", 2));
        let datum = Id::parse("/NC/_N_AX_TEA_ACX/$MA_GANTRY_AXIS_TYPE[u2]");
        let index = Index { unit: 2, first: 1, count: None };
        let identifier = "$MA_GANTRY_AXIS_TYPE".to_owned();
        assert_eq!(datum, Some(Id::Datum(Datum { scope: Scope::Axis, identifier, index })));
        assert_eq!(Id::parse("/NC/_N_AX_TEA_ACX/$MC_CHAN_NAME"), None);
        assert_eq!(Id::parse("/NC/_N_NC_GD3_ACX/ARRAY[1]"), None);
        assert_eq!(Id::parse("/Nck/MachineAxis/vaPower[u1,1]"), Some(Id::Absent));
        assert_eq!(Id::parse("/OpenNCK/Cycle"), Some(Id::Own(Own::Cycle)));
        assert_eq!(Id::parse("/OpenNCK/cycle"), None);
        assert_eq!(Id::parse("/Channel/State/nonsense"), None);
    }
}
