//! Machine data or parameters of a control, by number: values, types and owners.

use super::{Kind, Value};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::DatumValue;

/// The owner of a datum.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Owner {
    /// The control as a whole.
    Nck,
    /// A channel.
    Channel(ChannelNumber),
    /// A machine axis.
    Axis(AxisNumber),
}

/// One value of a datum as it is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Datum {
    /// Its type.
    pub kind: Kind,
    /// Only the control may write it.
    pub read_only: bool,
    /// The number of values of the datum.
    pub count: u16,
    /// The stored value.
    pub value: Value,
}

/// The machine data or parameters of a control.
pub trait Data {
    /// The stored value `index` of the datum `number` of `owner`; `None` if there is no such value.
    fn stored(&self, number: u32, owner: Owner, index: u8) -> Option<Datum>;

    /// The number of the datum with this identifier, with its prefix. The default is a control without identifiers.
    fn number(&self, _identifier: &str) -> Option<u32> {
        None
    }

    /// A text datum, for example the name of an axis or channel; `None` if there is no such text.
    fn text(&self, number: u32, owner: Owner, index: u8) -> Option<&str>;

    /// The stored value of a datum as users write it, `34090[XF]`, for the trace; `None` if there is no such datum.
    fn named(&self, _target: &str) -> Option<DatumValue> {
        None
    }
}
