//! Closing a grouping again (MD37140 back to 0): checks the states of its axes; alarm 10658 prevents closing.
//!
//! Called once per cycle for open groupings, before the units are formed. Reads MD37140 and the pending movements of the axes; writes which
//! groupings stay open. Opening and closing themselves are in `synchronisation.rs`.
//!
//! Choices where the manuals leave one: a movement is pending (70XX) while a setpoint moves, an axis is not at standstill, an increment is
//! pending or a key requests a movement. A grouping that cannot close stays open and stops with its alarm. It closes when RESET has
//! cancelled 10658 and nothing is pending; otherwise the alarm returns. 30XX and 40XX cannot occur: axes are never exchanged between
//! channels, and no PLC axis can own one of them (a grouping across channels is 10651 at power on).

use crate::control::Log;
use crate::sinumerik::alarms;
use crate::sinumerik::alarms::pending::Pending;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::gantry::view::{View, Want, Wants};
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

/// Code 70XX of alarm 10658: a movement is pending for at least one axis.
const MOTION_PENDING: i64 = 7_000;

impl State {
    /// BRK-05 for every open grouping. Returns whether the set of groupings kept open has changed.
    pub(in crate::sinumerik) fn check_closings(&mut self, parameters: &Parameters) -> bool {
        let mut changed = false;
        for index in 0..self.groupings.len() {
            let before = self.groupings[index].kept_open;
            if self.groupings[index].phase == Phase::Open || before {
                let view = View { axes: &self.axes, parameters };
                let wants = self.groupings[index].check_closing(&view, &self.alarms, &mut self.log);
                self.carry_out(&wants);
                changed |= before != self.groupings[index].kept_open;
            }
        }
        changed
    }
}

impl Grouping {
    /// Whether the grouping is to be opened or must stay open.
    pub(in crate::sinumerik) fn is_kept_open(&self, parameters: &Parameters) -> bool {
        self.kept_open || self.is_broken_up(parameters)
    }

    fn is_broken_up(&self, parameters: &Parameters) -> bool {
        self.coupling.members().any(|axis| parameters.axes[axis].gantry.broken_up)
    }

    /// A grouping that is to be closed stays open while 10658 is pending or is raised.
    fn check_closing(&mut self, view: &View<'_>, alarms: &Pending, log: &mut Log) -> Wants {
        let mut wants = Wants::new();
        self.kept_open = false;
        if self.phase != Phase::Open || self.is_broken_up(view.parameters) {
            return wants;
        }
        let refused = |axis| alarms.is_pending(alarms::IMPERMISSIBLE_AXIS_STATE, Place::Axis(axis));
        if self.coupling.members().any(refused) {
            self.kept_open = true;
        } else if let Some(axis) = self.coupling.members().find(|&axis| has_motion_pending(view, axis)) {
            self.kept_open = true;
            wants.push(self.refusal(axis, view.parameters, log));
        }
        wants
    }

    fn refusal(&self, axis: AxisNumber, parameters: &Parameters, log: &mut Log) -> Want {
        let leader = self.coupling.leader();
        let (place, input) = (Place::Axis(axis), Input::Datum(37140, Some(leader), 0.0));
        let cause = log.note_one(place, Rule::ClosingRefused, input, EventId::NONE);
        let channel = Parameter::Channel(parameters.axes[leader].channel);
        let code = Parameter::Number(MOTION_PENDING + i64::from(self.number));
        let shown = [channel, Parameter::Axis(axis), code, Parameter::None];
        Want::Raise { alarm: alarms::IMPERMISSIBLE_AXIS_STATE, place, shown, cause }
    }
}

fn has_motion_pending(view: &View<'_>, number: AxisNumber) -> bool {
    let axis = &view.axes[number];
    let asked = axis.travel != Travel::None || axis.jogging.movement != Movement::None;
    asked || axis.is_in_motion() || !axis.stands(&view.parameters.axes[number])
}
