//! When and why alarms were raised: the rule and the inputs of the event behind each of them, as text. A machine that goes back in time
//! forgets what was raised later, and knows again what was raised before.

use std::sync::Arc;

use crate::machine::Machine;
use crate::trace::{Change, because};
use crate::units::Time;
use crate::variables::RaisedAlarm;

/// The most entries. Beyond that, the oldest one of an alarm that is not pending goes.
const MOST: usize = 256;

/// An alarm, and when and why it was raised.
#[derive(Clone, Debug)]
pub(super) struct Raised {
    alarm: RaisedAlarm,
    cycle: u64,
    pub(super) time: Time,
    pub(super) because: Option<Arc<str>>,
}

/// The alarms that were raised, oldest first.
#[derive(Clone, Debug, Default)]
pub(super) struct Causes(Arc<Vec<Raised>>);

impl Causes {
    /// Takes over the alarms of a step, before its record is drained.
    pub(super) fn observe(&mut self, machine: &Machine) {
        for row in machine.recorder().rows() {
            let Change::Alarm { alarm, raised: true, cause } = row.change else { continue };
            let event = machine.control().events().find(cause);
            let because = event.map(|event| because(event, machine).into());
            let all = Arc::make_mut(&mut self.0);
            all.push(Raised { alarm, cycle: machine.cycle(), time: machine.time(), because });
            if all.len() > MOST {
                let pending = |alarm: &RaisedAlarm| machine.variables().alarms.iter().any(|other| other == alarm);
                let oldest = all.iter().position(|raised| !pending(&raised.alarm)).unwrap_or(0);
                all.remove(oldest);
            }
        }
    }

    /// Forgets what was raised after a cycle.
    pub(super) fn forget_after(&mut self, cycle: u64) {
        Arc::make_mut(&mut self.0).retain(|raised| raised.cycle <= cycle);
    }

    /// The last time that an alarm was raised.
    pub(super) fn of(&self, alarm: &RaisedAlarm) -> Option<&Raised> {
        self.0.iter().rfind(|raised| raised.alarm == *alarm)
    }
}
