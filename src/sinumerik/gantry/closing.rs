//! Closing a grouping again (MD37140 back to 0): checks the states of its axes; alarm 10658 prevents closing.
//!
//! Called once per cycle for open groupings, before the units are formed. Reads MD37140, who has the axes, and their pending movements; writes which
//! groupings stay open. Opening and closing themselves are in `synchronisation.rs`.
//!
//! Choices where the manuals leave one: a movement is pending (70XX) while a setpoint moves, an axis is not at standstill, an increment is
//! pending or a key requests a movement. A grouping that cannot close stays open and stops with its alarm. It closes when RESET has
//! cancelled 10658 and nothing is pending; otherwise the alarm returns. The first reason is reported: axes in different channels (30XX), axes in
//! different states (40XX: one of them neutral or a PLC axis), pending motion (70XX). Closing exchanges no axis.

use crate::control::Log;
use crate::image::axis_from_nck;
use crate::sinumerik::alarms;
use crate::sinumerik::alarms::pending::Pending;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::gantry::view::{View, Want, Wants};
use crate::sinumerik::inputs::{axis_number, axis_signal};
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

/// Code 30XX of alarm 10658: not all axes are in one channel.
const NOT_IN_ONE_CHANNEL: i64 = 3_000;

/// Code 40XX of alarm 10658: the axes are in different states: channel axis, neutral axis, PLC axis.
const DIFFERENT_STATES: i64 = 4_000;

/// Code 70XX of alarm 10658: a movement is pending for at least one axis.
const MOTION_PENDING: i64 = 7_000;

impl State {
    /// BRK-05 for every open grouping. Returns whether the set of groupings kept open has changed.
    pub(in crate::sinumerik) fn check_closings(&mut self, parameters: &Parameters) -> bool {
        let mut changed = false;
        for index in 0..self.groupings.len() {
            let before = self.groupings[index].kept_open;
            if self.groupings[index].phase == Phase::Open || before {
                let view = View { axes: &self.axes, owners: &self.owners, parameters };
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
        } else if let Some((axis, code)) = self.hindrance_of_closing(view) {
            self.kept_open = true;
            wants.push(self.refusal((axis, code), view, log));
        }
        wants
    }

    /// The axis that does not permit closing, and the code of the reason.
    fn hindrance_of_closing(&self, view: &View<'_>) -> Option<(AxisNumber, i64)> {
        let leading = view.owners.of(self.coupling.leader());
        let elsewhere = |axis: &AxisNumber| view.owners.of(*axis).channel != leading.channel;
        let otherwise = |axis: &AxisNumber| view.owners.of(*axis).holder != leading.holder;
        let moves = |axis: &AxisNumber| has_motion_pending(view, *axis);
        let first = |axes: &dyn Fn(&AxisNumber) -> bool| self.coupling.members().find(axes);
        first(&elsewhere)
            .map(|axis| (axis, NOT_IN_ONE_CHANNEL))
            .or_else(|| first(&otherwise).map(|axis| (axis, DIFFERENT_STATES)))
            .or_else(|| first(&moves).map(|axis| (axis, MOTION_PENDING)))
    }

    /// The rule of a refusal, and what it compares beside MD37140.
    fn reason(&self, axis: AxisNumber, code: i64, view: &View<'_>) -> (Rule, [Input; 2]) {
        let both = |input: &dyn Fn(AxisNumber) -> Input| [input(axis), input(self.coupling.leader())];
        let channel =
            |axis| axis_number(axis, axis_from_nck::axis_replacement_channel, view.owners.of(axis).channel.number());
        let is = |axis, holder| view.owners.of(axis).holder == holder;
        let state = |axis| {
            if is(axis, Holder::Plc) {
                axis_signal(axis, axis_from_nck::plc_axis, true)
            } else {
                axis_signal(axis, axis_from_nck::neutral_axis, is(axis, Holder::Neutral))
            }
        };
        match code {
            NOT_IN_ONE_CHANNEL => (Rule::ClosingInOtherChannel, both(&channel)),
            DIFFERENT_STATES => (Rule::ClosingInOtherState, both(&state)),
            _ => (Rule::ClosingRefused, [Input::None; 2]),
        }
    }

    fn refusal(&self, (axis, code): (AxisNumber, i64), view: &View<'_>, log: &mut Log) -> Want {
        let leader = self.coupling.leader();
        let (place, input) = (Place::Axis(axis), Input::Datum(37140, Some(leader), 0.0));
        let (rule, [first, second]) = self.reason(axis, code, view);
        let cause = log.note(place, rule, [input, first, second], EventId::NONE);
        let channel = Parameter::Channel(view.owners.of(axis).channel);
        let code = Parameter::Number(code + i64::from(self.number));
        let shown = [channel, Parameter::Axis(axis), code, Parameter::None];
        Want::Raise { alarm: alarms::IMPERMISSIBLE_AXIS_STATE, place, shown, cause }
    }
}

fn has_motion_pending(view: &View<'_>, number: AxisNumber) -> bool {
    let axis = &view.axes[number];
    let asked = axis.travel != Travel::None || axis.jogging.movement != Movement::None;
    asked || axis.is_in_motion() || !axis.stands(&view.parameters.axes[number])
}
