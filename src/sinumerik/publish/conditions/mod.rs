//! The conditions of each signal: what the control tests before the signal gets a value, for `opennck why-not`.
//!
//! A row here belongs to the row of the same signal in `publish/`. A signal that follows directly from the present state is a formula over
//! other signals and facts. A signal with a history (enabled, referenced, synchronised, moving) is a fact of the state, with what the stage
//! that decides it tests for the next step. The tests run all golden scenarios and require in every cycle that the formula of a signal has
//! the value of the signal, and that a signal follows when everything that is named for its next step holds.
//!
//! | file | signals |
//! |---|---|
//! | `axis.rs` | enabling, measuring systems, exact stop, standstill |
//! | `referencing.rs` | 60.4, 60.5, 33.0 |
//! | `gantry.rs` | 101.x |
//! | `motion.rs` | 64.4 to 64.7, and what stops and holds movements |
//! | `control.rs` | DB10, DB11, DB21 |
//!
//! `look.rs` has what they are computed from.

mod axis;
mod control;
mod gantry;
mod look;
mod motion;
mod referencing;

use crate::control::{Condition, Question};
use crate::image::ToNck;
use crate::sinumerik::nck::Nck;
use crate::variables::Place;
use look::Look;

impl Nck {
    /// What must hold so that a bit has a value; `None` for a signal without conditions.
    #[must_use]
    pub fn conditions(&self, question: &Question<'_>, to_nck: &ToNck) -> Option<Condition> {
        let look = Look { state: &self.state, parameters: &self.parameters, to_nck, names: question.names };
        if let Some(hidden) = look.not_shown(question.place, question.wanted) {
            return Some(hidden);
        }
        match question.place {
            Place::Nck => look.find(control::NCK, (), question),
            Place::ModeGroup(group) => look.find(control::MODE_GROUP, group, question),
            Place::Channel(channel) => look.find(control::CHANNEL, channel, question),
            Place::Axis(axis) => {
                let found = [axis::ROWS, referencing::ROWS, gantry::ROWS, motion::ROWS];
                found.iter().find_map(|rows| look.find(rows, axis, question))
            }
        }
    }
}
