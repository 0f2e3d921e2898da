//! The messages that the PLC program shows (FC 10 of the basic program): 510000 to 799999. They have no reaction in the NC, and are no NCK
//! alarms on the interface: they stand in the list of alarms only.

use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::sinumerik::user::state::PlcMessage;
use crate::variables::{AlarmNumber, BlockName, EventId, Input, Parameter, Place, RaisedAlarm};

impl State {
    /// The PLC program shows exactly these messages from now on.
    pub(in crate::sinumerik) fn show_messages(&mut self, numbers: &[u32]) {
        let gone: Vec<_> =
            self.user.messages.iter().filter(|message| !numbers.contains(&message.number)).copied().collect();
        for message in gone {
            let event = self.log.note_plain(Place::Nck, Rule::PlcMessageEnds, message.cause);
            self.alarms.end(&raised(message.number), event);
        }
        self.user.messages.retain(|message| numbers.contains(&message.number));
        for &number in numbers {
            if self.user.messages.iter().all(|message| message.number != number) {
                let inputs = [shown_in_db2(), Input::None, Input::None];
                let cause = self.log.note(Place::Nck, Rule::PlcMessage, inputs, EventId::NONE);
                self.user.messages.push(PlcMessage { number, cause });
            }
        }
    }

    /// A message is pending as long as the PLC program shows it.
    pub(in crate::sinumerik) fn raise_messages(&mut self) {
        for message in &self.user.messages {
            let RaisedAlarm { number, place, parameters } = raised(message.number);
            self.alarms.raise(number, place, parameters, message.cause);
        }
    }
}

/// FC 10 reads the bits of DB2.
fn shown_in_db2() -> Input {
    Input::Block(BlockName::from("DB2").unwrap_or_default())
}

fn raised(number: u32) -> RaisedAlarm {
    RaisedAlarm { number: AlarmNumber(number), place: Place::Nck, parameters: [Parameter::None; 4] }
}
