//! The conditions of a signal, evaluated: what the control tests before a bit has a value, with what it finds now.

use super::Machine;
use crate::control::{Condition, Fact, Question};
use crate::image::{Location, Part, Writer};
use crate::variables::{Place, SignalBit};

/// A condition with what is found now.
#[derive(Clone, Debug, PartialEq)]
pub struct Tested {
    /// What is tested.
    pub what: Subject,
    /// Whether it holds now.
    pub holds: bool,
    /// The conditions that it consists of, or that must hold first so that a fact changes. Empty for the signals of other writers, and for
    /// signals of the control without conditions.
    pub parts: Vec<Self>,
}

/// What is tested.
#[derive(Clone, Debug, PartialEq)]
pub enum Subject {
    /// A signal: its location and the value that it must have. What is tested is the value that the control has read, which with
    /// `to_nck_delay` is older than that of the memory (O-28).
    Signal(Location, bool),
    /// A fact of the control.
    Fact {
        /// What is tested.
        what: String,
        /// What the control finds.
        found: String,
        /// What it wants.
        wanted: String,
    },
    /// Each part.
    All,
    /// One part or more.
    Any,
}

impl Machine {
    /// What the control tests before a bit has a value, after the last cycle; `None` if the control does not write this bit, or does not
    /// say. Signals that the control writes itself have no parts; ask for them in turn.
    #[must_use]
    pub fn conditions(&self, location: Location, wanted: bool) -> Option<Tested> {
        let names = self.names();
        if location.width != 1 || names.writer(location) != Some(Writer::Nck) {
            return None;
        }
        let at = names.interface().signals_at(location.part, location.offset)?;
        let (place, byte, bit) = (Place::of_block(at.block, at.number)?, at.byte, location.bit);
        let question = Question { place, byte, bit, wanted, names };
        Some(self.tested(self.control.conditions(&question, self.state.plc_side())?))
    }

    fn tested(&self, condition: Condition) -> Tested {
        let each = |all: Vec<Condition>| all.into_iter().map(|part| self.tested(part)).collect::<Vec<_>>();
        match condition {
            Condition::Signal(bit, wanted) => self.tested_signal(bit, wanted),
            Condition::Fact(Fact { what, found, wanted, holds, first }) => Tested {
                what: Subject::Fact { what, found, wanted },
                holds,
                parts: first.map(|first| self.tested(*first)).into_iter().collect(),
            },
            Condition::All(all) => {
                let parts = each(all);
                Tested { what: Subject::All, holds: parts.iter().all(|part| part.holds), parts }
            }
            Condition::Any(any) => {
                let parts = each(any);
                Tested { what: Subject::Any, holds: parts.iter().any(|part| part.holds), parts }
            }
        }
    }

    fn tested_signal(&self, bit: SignalBit, wanted: bool) -> Tested {
        let interface = self.names().interface();
        let (block, number) = bit.place.block();
        let is_meant =
            |signal: &&crate::image::Signal| (signal.block, signal.byte, signal.bit) == (block, bit.byte, bit.bit);
        let location = interface.signals().find(is_meant).and_then(|signal| interface.location(signal, number));
        let location = location.expect("a control names signals of its own interface");
        let found = if location.part == Part::ToNck {
            let byte = self.state.plc_side().to_nck.get(location.offset as usize);
            byte.is_some_and(|byte| byte >> location.bit & 1 == 1)
        } else {
            self.memory().read(location) != 0
        };
        Tested { what: Subject::Signal(location, wanted), holds: found == wanted, parts: Vec::new() }
    }
}
