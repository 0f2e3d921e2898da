//! The parameters of the lists, as the machine and the trace read them.

use super::cnc::Cnc;
use super::lists;
use crate::control::{Data, Datum, Kind, Owner, Value};
use crate::units::ChannelNumber;
use crate::variables::{DatumValue, Place, short_text};

impl Data for Cnc {
    fn stored(&self, number: u32, owner: Owner, _: u8) -> Option<Datum> {
        let axis = match owner {
            Owner::Axis(axis) => Some(axis),
            Owner::Channel(_) | Owner::Nck => None,
        };
        let value = Value::Real(self.0.parameter_in_effect(number, axis)?);
        Some(Datum { kind: Kind::Double, read_only: false, count: 1, value })
    }

    fn text(&self, _: u32, _: Owner, _: u8) -> Option<&str> {
        None
    }

    fn named(&self, target: &str) -> Option<DatumValue> {
        let (owner, name) = target.split_once(':')?;
        let (parameter, _) = lists::parameter(name)?;
        let started = self.0.lists.update();
        let place = match started.axis_named(owner).and_then(|number| self.0.axis_of(number)) {
            Some(axis) => Place::Axis(axis),
            None => Place::Channel(ChannelNumber::FIRST),
        };
        let axis = match place {
            Place::Axis(axis) => Some(axis),
            _ => None,
        };
        let number = parameter.number();
        let written = self.0.lists.written(target);
        let word = match written {
            Some(Value::Text(word)) => Some(short_text(word)),
            _ => None,
        };
        let value = match written {
            Some(Value::Text(_)) => None,
            Some(written) => written.number(),
            None => self.0.parameter_in_effect(number, axis),
        };
        Some(DatumValue { number, place, index: None, value, word })
    }
}
