//! Machine data or parameters of a control, by number: values, their types, and whose they are.

use super::{Kind, Value};
use crate::units::{AxisNumber, ChannelNumber};

/// Whose value a datum is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// The control's as a whole.
    Nck,
    /// A channel's.
    Channel(ChannelNumber),
    /// A machine axis'.
    Axis(AxisNumber),
}

/// One value of a datum as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Datum {
    /// Its type.
    pub kind: Kind,
    /// Only the control writes it.
    pub read_only: bool,
    /// How many values the datum has.
    pub count: u8,
    /// The stored value.
    pub value: Value,
}

/// The machine data or parameters of a control.
pub trait Data {
    /// The value `index` of the datum `number` of `owner`, as it is stored; `None` where there is no such value.
    fn stored(&self, number: u32, owner: Owner, index: u8) -> Option<Datum>;

    /// A text among the data, as a name of an axis or channel; `None` where there is no such text.
    fn text(&self, number: u32, owner: Owner, index: u8) -> Option<&str>;
}
