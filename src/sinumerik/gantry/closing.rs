//! Closing a grouping again (MD37140 back to 0): the states of its axes are checked, and 10658 refuses.
//!
//! Called once per cycle before the units are formed, for the groupings that are open. Reads MD37140 and what the axes have
//! before them; writes which groupings stay open. Opening, and closing itself, are in `synchronisation.rs`.
//!
//! Choices where the manuals leave one: a movement is pending (70XX) while a setpoint moves, an axis is not at standstill, an
//! increment waits or a key asks for a movement. A refused grouping stays open, stops with its alarm, and closes when RESET
//! has cancelled 10658 and nothing is pending any more; else the alarm returns. 30XX and 40XX cannot come: axes are
//! never exchanged between channels, and no PLC axis can own one of them (a grouping across channels is 10651 at power on).

use crate::sinumerik::alarms;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

/// Code 70XX of alarm 10658: a movement is pending for at least one axis.
const MOTION_PENDING: i64 = 7_000;

impl State {
    /// Whether the grouping is to be open, or has to stay so.
    pub(in crate::sinumerik) fn is_kept_open(&self, index: usize, parameters: &Parameters) -> bool {
        let grouping = &self.groupings[index];
        grouping.kept_open || grouping.coupling.members().any(|axis| parameters.axes[axis].gantry.broken_up)
    }

    /// BRK-05 for every open grouping; whether one is kept open that was not, or the other way round.
    pub(in crate::sinumerik) fn check_closings(&mut self, parameters: &Parameters) -> bool {
        let mut changed = false;
        for index in 0..self.groupings.len() {
            let grouping = &self.groupings[index];
            if grouping.phase != Phase::Open && !grouping.kept_open {
                continue;
            }
            let unit = Unit::of(&grouping.coupling, index, parameters);
            let closing = unit.members().all(|axis| !parameters.axes[axis].gantry.broken_up);
            let kept_open = closing && grouping.phase == Phase::Open && self.refuses_to_close(index, &unit, parameters);
            changed |= kept_open != self.groupings[index].kept_open;
            self.groupings[index].kept_open = kept_open;
        }
        changed
    }

    /// 10658 is pending, or comes.
    fn refuses_to_close(&mut self, index: usize, unit: &Unit, parameters: &Parameters) -> bool {
        let refused = |axis| self.alarms.is_pending(alarms::IMPERMISSIBLE_AXIS_STATE, Place::Axis(axis));
        if unit.members().any(refused) {
            return true;
        }
        let Some(axis) = unit.members().find(|&axis| self.has_motion_pending(axis, parameters)) else {
            return false;
        };
        let input = Input::Datum(37140, Some(unit.leader()), 0.0);
        let cause = self.log.note_one(Place::Axis(axis), Rule::ClosingRefused, input, EventId::NONE);
        let code = Parameter::Number(MOTION_PENDING + i64::from(self.groupings[index].number));
        let shown = [Parameter::Channel(unit.channel), Parameter::Axis(axis), code, Parameter::None];
        self.alarms.raise(alarms::IMPERMISSIBLE_AXIS_STATE, Place::Axis(axis), shown, cause);
        true
    }

    fn has_motion_pending(&self, number: AxisNumber, parameters: &Parameters) -> bool {
        let axis = &self.axes[number];
        let asked = axis.traverse_request != 0 || axis.jogging.movement != Movement::None;
        asked || axis.is_in_motion() || !axis.stands(&parameters.axes[number])
    }
}
