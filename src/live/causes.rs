//! Why the pending alarms were raised: the rule and the inputs of the event behind each of them, as text. A machine that goes back in time
//! forgets them: a cause that belongs to another moment would be wrong.

use std::sync::Arc;

use crate::machine::Machine;
use crate::trace::{Change, because};
use crate::variables::RaisedAlarm;

/// The causes of pending alarms.
#[derive(Clone, Debug, Default)]
pub(super) struct Causes(Arc<Vec<(RaisedAlarm, Arc<str>)>>);

impl Causes {
    /// Takes over the alarms of a step, before its record is drained.
    pub(super) fn observe(&mut self, machine: &Machine) {
        for row in machine.recorder().rows() {
            let Change::Alarm { alarm, raised, cause } = row.change else { continue };
            let causes = Arc::make_mut(&mut self.0);
            causes.retain(|(known, _)| *known != alarm);
            let event = machine.control().events().find(cause);
            if let (true, Some(event)) = (raised, event) {
                causes.push((alarm, because(event, machine).into()));
            }
        }
    }

    pub(super) fn of(&self, alarm: &RaisedAlarm) -> Option<&Arc<str>> {
        self.0.iter().find(|(known, _)| known == alarm).map(|(_, cause)| cause)
    }
}
