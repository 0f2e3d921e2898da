//! The conditions of each signal: what the control tests before the signal gets a value, for `opennck why-not`.
//!
//! A signal that follows directly from the present state (in position, a control unit) is a formula over other signals and facts. A signal
//! with a history (homed, coupled, in error, program active) is a fact of the state, with what must hold for its next step. The tests run
//! all golden scenarios and require in every cycle that the formula of a signal has the value of the signal, and that a signal follows when
//! everything that is named for its next step holds.

mod axis;
mod channel;
mod look;

use crate::control::{Condition, Question, fact};
use crate::isg::state::State;
use crate::variables::{Place, place_name};
use look::{Look, Row};

impl State {
    /// What must hold so that a bit has a value; `None` for a signal without conditions.
    pub(in crate::isg) fn conditions(&self, question: &Question<'_>) -> Option<Condition> {
        let look = Look { state: self, names: question.names };
        let missing = |place| {
            let exists = fact(format!("{} exists", place_name(place, question.names)), false);
            if question.wanted { exists.into() } else { Condition::from(exists).opposite() }
        };
        match question.place {
            Place::Axis(axis) if !self.axes[axis].exists => Some(missing(question.place)),
            Place::Axis(axis) => Row::find(axis::ROWS, look, axis, question),
            Place::Channel(number) => match self.channels.iter().position(|channel| channel.number == number) {
                Some(index) => Row::find(channel::ROWS, look, index, question),
                None => Some(missing(question.place)),
            },
            Place::Nck | Place::ModeGroup(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{Block, Signal, Writer};
    use crate::isg::hli::HLI;

    #[test]
    fn every_bit_that_the_control_writes_has_conditions() {
        let is = |signal: &Signal, other: Signal| (signal.byte, signal.bit) == (other.byte, other.bit);
        let has_conditions = |signal: &Signal| match signal.block {
            Block::Channel => channel::ROWS.iter().any(|row| is(signal, row.signal)),
            _ => axis::ROWS.iter().any(|row| is(signal, row.signal)),
        };
        let written = HLI.signals().filter(|signal| signal.writer == Writer::Nck && signal.kind.width() == 1);
        let without: Vec<_> = written.filter(|signal| !has_conditions(signal)).collect();
        assert_eq!(without, Vec::<&Signal>::new());
    }
}
