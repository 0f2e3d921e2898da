//! The conditions of each signal: what the control tests before the signal gets a value, for `opennck why-not`.
//!
//! A row here belongs to the row of the same signal in `publish/`. A signal that follows directly from the present state is a formula over
//! other signals and facts. A signal with a history (enabled, referenced, synchronised, moving) is a fact of the state, with what the stage
//! that decides it tests for the next step. The tests run all golden scenarios and require in every cycle that the formula of a signal has
//! the value of the signal, and that a signal follows when everything that is named for its next step holds.
//!
//! | file | signals |
//! |---|---|
//! | `enabling.rs` | 61.3, 61.5 to 61.7, 92.5, 93.5, 93.7 |
//! | `axis.rs` | measuring systems, exact stop, standstill |
//! | `exchange.rs` | 68.4 to 68.7 |
//! | `single_axis.rs` | 63.0 to 63.2, 76.5, 104.0 to 104.7 |
//! | `referencing.rs` | 60.4, 60.5, 33.0 |
//! | `gantry.rs` | 101.x |
//! | `motion.rs` | 64.4 to 64.7, and what stops and holds movements |
//! | `spindle.rs` | 60.0, 82.3, 83.0 to 83.7, 84.5 to 84.7, 85.5 |
//! | `jog.rs` | handwheels, increments: 64.0 to 64.2, 65.x, 67.0, DB11 8.x |
//! | `control.rs` | DB10, DB11, DB21 |
//! | `program.rs`, `states.rs` | DB21 32.x, 33.x, 35.x, 58 to 206 |
//!
//! `look.rs` has what they are computed from.

mod axis;
mod control;
mod enabling;
mod exchange;
mod gantry;
mod jog;
mod look;
mod motion;
mod program;
mod referencing;
mod single_axis;
mod spindle;
mod states;

use crate::control::{Condition, Question};
use crate::image::{NckHmi, ToNck};
use crate::sinumerik::nck::Nck;
use crate::variables::Place;
use look::{Look, Row};

impl Nck {
    /// What must hold so that a bit has a value; `None` for a signal without conditions.
    #[must_use]
    pub fn conditions(&self, question: &Question<'_>, to_nck: &ToNck, hmi: &NckHmi) -> Option<Condition> {
        let (state, parameters, library) = (&*self.state, &*self.parameters, &*self.programs);
        let look = Look { state, parameters, library, to_nck, hmi, names: question.names };
        if let Some(hidden) = look.not_shown(question.place, question.wanted) {
            return Some(hidden);
        }
        match question.place {
            Place::Nck => Row::find(control::NCK, look, (), question),
            Place::ModeGroup(group) => {
                let found = [control::MODE_GROUP, jog::MODE_GROUP];
                found.iter().find_map(|rows| Row::find(rows, look, group, question))
            }
            Place::Channel(channel) => {
                let found = [control::CHANNEL, program::CHANNEL];
                let row = found.iter().find_map(|rows| Row::find(rows, look, channel, question));
                row.or_else(|| look.auxiliary(channel, question))
            }
            Place::Axis(axis) => {
                let found = [
                    axis::ROWS,
                    enabling::ROWS,
                    exchange::ROWS,
                    single_axis::ROWS,
                    referencing::ROWS,
                    gantry::ROWS,
                    motion::ROWS,
                    jog::ROWS,
                    spindle::ROWS,
                ];
                found.iter().find_map(|rows| Row::find(rows, look, axis, question))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::Texts;
    use crate::image::{Block, Signal, Writer};
    use crate::sinumerik::publish::known::has_row;
    use crate::sinumerik::texts::TEXTS;

    fn is_in<Owner>(rows: &[Row<Owner>], signal: &Signal) -> bool {
        rows.iter().any(|row| (row.signal.byte, row.signal.bit) == (signal.byte, signal.bit))
    }

    #[test]
    fn every_bit_that_the_control_writes_has_conditions() {
        let has_conditions = |signal: &Signal| match signal.block {
            Block::Nck => is_in(control::NCK, signal),
            Block::ModeGroup => is_in(control::MODE_GROUP, signal) || is_in(jog::MODE_GROUP, signal),
            Block::Channel if signal.byte >= 58 => true,
            Block::Channel => is_in(control::CHANNEL, signal) || is_in(program::CHANNEL, signal),
            _ => {
                let all = [
                    axis::ROWS,
                    enabling::ROWS,
                    exchange::ROWS,
                    single_axis::ROWS,
                    referencing::ROWS,
                    gantry::ROWS,
                    motion::ROWS,
                    jog::ROWS,
                    spindle::ROWS,
                ];
                all.iter().any(|rows| is_in(rows, signal))
            }
        };
        let written = TEXTS.interface().signals();
        let written = written.filter(|signal| signal.writer == Writer::Nck && signal.kind.width() == 1);
        let without: Vec<_> = written.filter(|signal| has_row(signal) && !has_conditions(signal)).collect();
        assert_eq!(without, Vec::<&Signal>::new());
    }
}
