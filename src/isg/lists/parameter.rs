//! One parameter of the ISG kernel as its manuals describe it, and how parameters are found by ID, by number and by list name.
//!
//! The rows are in `table`. A parameter has a number for traces: `72` for P-AXIS-00072, `100104` for P-CHAN-00104.

use std::fmt;

use serde::{Deserialize, Serialize};

/// What a number of a channel parameter is above the digits of its ID.
pub(super) const CHANNEL: u32 = 100_000;

/// The kind of list that holds a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Scope {
    /// The list of an axis.
    Axis,
    /// The list of a channel.
    Channel,
}

/// The data type of a parameter, as the manuals name it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// A whole number of 16 bits without sign.
    Uns16,
    /// A whole number of 32 bits without sign.
    Uns32,
    /// A whole number of 32 bits with sign.
    Sgn32,
    /// 0 or 1.
    Boolean,
    /// A number with fractions.
    Real64,
    /// A word.
    String,
}

impl Type {
    /// The smallest and the largest whole number of the type; `None` for types that hold no whole numbers.
    #[must_use]
    pub const fn whole_numbers(self) -> Option<[i64; 2]> {
        match self {
            Self::Uns16 => Some([0, u16::MAX as i64]),
            Self::Uns32 => Some([0, u32::MAX as i64]),
            Self::Sgn32 => Some([i32::MIN as i64, i32::MAX as i64]),
            Self::Boolean => Some([0, 1]),
            Self::Real64 | Self::String => None,
        }
    }
}

impl fmt::Display for Type {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Uns16 => "UNS16",
            Self::Uns32 => "UNS32",
            Self::Sgn32 => "SGN32",
            Self::Boolean => "BOOLEAN",
            Self::Real64 => "REAL64",
            Self::String => "STRING",
        })
    }
}

/// When a changed entry takes effect (HG-02).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effect {
    /// At the next start of the controller. An update of the list at run time is kept, but not adopted.
    Restart,
    /// With the update of the list.
    Update,
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Restart => "start of the controller",
            Self::Update => "update of the list",
        })
    }
}

/// One parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The list that holds it.
    pub scope: Scope,
    /// The digits of its ID: 72 for P-AXIS-00072.
    pub digits: u32,
    /// Its name in a list, with `[i]` and `[j]` for indices; `None` if no source gives the name. Then its ID stands in the list.
    pub name: Option<&'static str>,
    /// No source gives the structure before the name; `name` has the likely one, and the name alone is accepted, too.
    pub is_structure_assumed: bool,
    /// Its data type.
    pub kind: Type,
    /// Its unit for linear axes and for rotary axes; empty without a unit.
    pub units: [&'static str; 2],
    /// Its range as the manuals print it; empty if none is printed.
    pub range: &'static str,
    /// The value without an entry.
    pub default: &'static str,
    /// When a changed entry takes effect.
    pub effect: Effect,
    /// What it does.
    pub meaning: &'static str,
    /// Whether it has an effect here.
    pub is_modelled: bool,
}

impl Parameter {
    /// Its number in traces: `72` for P-AXIS-00072, `100104` for P-CHAN-00104.
    #[must_use]
    pub const fn number(&self) -> u32 {
        match self.scope {
            Scope::Axis => self.digits,
            Scope::Channel => CHANNEL + self.digits,
        }
    }

    /// Its ID: `P-AXIS-00072`.
    #[must_use]
    pub fn id(&self) -> String {
        id(self.number())
    }

    /// Its ID and its list name, if there is one: `P-AXIS-00008 getriebe[0].dynamik.a_max`.
    #[must_use]
    pub fn title(&self, index: Index) -> String {
        match self.list_name(index) {
            Some(name) => format!("{} {name}", self.id()),
            None => self.id(),
        }
    }

    /// Its list name with indices: `getriebe[0].dynamik.a_max`.
    #[must_use]
    pub fn list_name(&self, index: Index) -> Option<String> {
        let [first, second] = index.map(|index| format!("[{index}]"));
        self.name.map(|name| name.replace("[i]", &first).replace("[j]", &second))
    }

    /// The number of indices of its list name.
    pub(super) fn indices(&self) -> usize {
        self.name.map_or(0, |name| name.matches('[').count())
    }

    /// The largest value that each of its indices may have.
    pub(super) const fn largest_index(&self) -> Index {
        match self.number() {
            100_006 | 100_035 => [u16::MAX, MOST_CHANNEL_AXES - 1],
            100_037 | 100_038 | 100_061 => [u16::MAX, MOST_PAIRS - 1],
            _ => [u16::MAX, u16::MAX],
        }
    }

    /// A row of the table with the default 0 and without a range.
    pub(super) const fn new(scope: Scope, digits: u32, name: Option<&'static str>, kind: Type) -> Self {
        Self {
            scope,
            digits,
            name,
            is_structure_assumed: false,
            kind,
            units: ["", ""],
            range: "",
            default: "0",
            effect: Effect::Update,
            meaning: "",
            is_modelled: true,
        }
    }

    /// With these units.
    pub(super) const fn unit(self, units: [&'static str; 2]) -> Self {
        Self { units, ..self }
    }

    /// With this range and this default.
    pub(super) const fn values(self, range: &'static str, default: &'static str) -> Self {
        Self { range, default, ..self }
    }

    /// With this meaning.
    pub(super) const fn means(self, meaning: &'static str) -> Self {
        Self { meaning, ..self }
    }

    /// Adopted only at the start of the controller.
    pub(super) const fn restart(self) -> Self {
        Self { effect: Effect::Restart, ..self }
    }

    /// Without an effect here.
    pub(super) const fn not_modelled(self) -> Self {
        Self { is_modelled: false, ..self }
    }

    /// With an assumed structure before the name.
    pub(super) const fn assumed(self) -> Self {
        Self { is_structure_assumed: true, ..self }
    }
}

/// The indices of an entry, from zero; 0 where a name has none.
pub type Index = [u16; 2];

/// One value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Key {
    /// The number of the parameter.
    pub number: u32,
    /// Its indices.
    pub index: Index,
}

impl Key {
    /// The value without an index, or with the indices 0.
    #[must_use]
    pub const fn new(number: u32) -> Self {
        Self { number, index: [0, 0] }
    }

    /// The value with a second index `j`: `gruppe[0].achse[j]`.
    #[must_use]
    pub const fn second(number: u32, j: u16) -> Self {
        Self { number, index: [0, j] }
    }
}

/// The number of axes that a channel can have (P-CHAN-00003).
pub(super) const MOST_CHANNEL_AXES: u16 = 32;
/// The number of pairs of coupling group 0.
pub(super) const MOST_PAIRS: u16 = 15;

/// The ID of a parameter by its number.
#[must_use]
pub fn id(number: u32) -> String {
    if number >= CHANNEL { format!("P-CHAN-{:05}", number - CHANNEL) } else { format!("P-AXIS-{number:05}") }
}
