//! The stage: each axis that is positioned alone, for one cycle.

use crate::image::{ToNck, axis_from_nck, axis_to_nck, channel_to_nck, mode_group_to_nck};
use crate::sinumerik::alarms::{self, Reaction};
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::axis::traversing::Stop;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::inputs::{axis_signal, channel_signal, mode_group_signal};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::state::Led;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::state::{Order, OrderedBy, Outcome};
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, AxisSet, Position};
use crate::variables::{AlarmNumber, EventId, Input, Place, Quantity};

/// The position was not reached.
const NOT_REACHED: u8 = 115;

impl Nck {
    /// Positions the axes with an order; the signals of the axes `changed` have changed.
    pub(in crate::sinumerik) fn position_single_axes(&mut self, changed: AxisSet, to_nck: &ToNck) {
        self.state.position_axes(changed, &self.parameters, to_nck);
        // A synchronised action of this cycle may have woken an axis that rested.
        self.resting.decide_now(self.state.single.moving, &self.state.units);
        self.resting.hear_all(self.state.note_positioning(&self.parameters));
    }
}

impl State {
    fn position_axes(&mut self, changed: AxisSet, parameters: &Parameters, to_nck: &ToNck) {
        for axis in changed.with(self.single.watched).and(parameters.existing).iter() {
            let signals = &to_nck.axes[axis];
            self.watch_independence(axis, signals);
            self.watch_start(axis, signals, parameters);
            self.show_limit(axis);
            if let (Some(order), Some(unit)) = (self.single.axes[axis].order, self.unit_of(axis)) {
                self.watch_end(axis, &unit, order, parameters, to_nck);
                self.move_single_axis(axis, &unit, parameters, to_nck);
            }
            self.single.note_watched(axis);
        }
        let overridden = std::mem::take(&mut self.single.overridden);
        self.keep_handwheel_overrides(overridden);
    }

    /// Whether an order positions an axis.
    pub(in crate::sinumerik) fn is_positioned_alone(&self, axis: AxisNumber) -> bool {
        self.single.moving.contains(axis)
    }

    /// What ends an order before its target.
    fn watch_end(&mut self, axis: AxisNumber, unit: &Unit, order: Order, parameters: &Parameters, to_nck: &ToNck) {
        let signals = &to_nck.axes[axis];
        let delete = signals.delete_distance_to_go_spindle_reset();
        let deletes = delete && !std::mem::replace(&mut self.single.axes[axis].delete_was, delete);
        self.single.axes[axis].delete_was = delete;
        if order.ending.is_some() {
            return;
        }
        let (rule, input, cause, outcome) = if let Some(stop) = self.stop_of_single(axis, unit, parameters) {
            let (rule, input) = stop.tested();
            (rule, input, stop.cause(), Outcome::Failed(NOT_REACHED))
        } else if deletes {
            let pressed = axis_signal(axis, axis_to_nck::delete_distance_to_go_spindle_reset, true);
            (Rule::DistanceDeleted, pressed, EventId::NONE, Outcome::None)
        } else if let Some((rule, input)) = self.obstacle(axis, unit, order) {
            (rule, input, order.cause, Outcome::Failed(NOT_REACHED))
        } else if self.axes[axis].setpoint.is_at_rest()
            && order.begun
            && let Some(input) = self.rests_on_limit(unit, order, parameters, to_nck)
        {
            (Rule::StoppedByAlarm, input, order.cause, Outcome::Failed(NOT_REACHED))
        } else {
            return;
        };
        let event = self.log.note(Place::Axis(axis), rule, [input, Input::None, Input::None], cause);
        let one = &mut self.single.axes[axis];
        one.cause = event;
        if let Some(order) = &mut one.order {
            order.ending = Some(outcome);
        }
    }

    /// The alarm of the limit that a unit has reached on the way to its target: 10620, 10630.
    fn rests_on_limit(&mut self, unit: &Unit, order: Order, parameters: &Parameters, to_nck: &ToNck) -> Option<Input> {
        let is_free = self.before_limit(unit, (order.target, true), parameters, to_nck).is_some();
        let reached = [alarms::REACHES_SOFTWARE_LIMIT, alarms::REACHES_WORKING_AREA];
        let pending = |number: &AlarmNumber| unit.members().any(|of| self.alarms.is_pending(*number, Place::Axis(of)));
        reached.into_iter().find(pending).filter(|_| !is_free).map(|number| Input::Alarm(number.0))
    }

    /// What stops the channel of an axis; of an axis that the PLC controls, only emergency stop and alarms of the axis and of the NCK.
    fn stop_of_single(&self, axis: AxisNumber, unit: &Unit, parameters: &Parameters) -> Option<Stop> {
        if !self.single.axes[axis].independence.taken {
            return self.stop(unit.channel, parameters);
        }
        if let Some(cause) = self.emergency_stop.active_cause() {
            return Some(Stop::Emergency(cause));
        }
        let own = |place: Place| match place {
            Place::Axis(of) => unit.set.contains(of),
            Place::Nck => true,
            Place::ModeGroup(_) | Place::Channel(_) => false,
        };
        let stops = self.alarms.first_alarm(|place, alarm| {
            own(place) && alarm.reaction.has(Reaction::STOP) || alarm.reaction.has(Reaction::NC_NOT_READY)
        });
        stops.map(|(number, cause)| Stop::Alarm(number, cause))
    }

    /// A limit switch ahead, the fast stop, or an enable that was there and is lost.
    fn obstacle(&self, axis: AxisNumber, unit: &Unit, order: Order) -> Option<(Rule, Input)> {
        let direction = direction(order.target - self.axes[axis].setpoint.position);
        if let Some(pressed) = self.limited_by(unit, direction) {
            return Some((Rule::HardwareLimitSwitch, self.axes[pressed].limits.input(pressed, direction)));
        }
        if self.axes[axis].signals.fast_stop {
            let shown = axis_from_nck::ramp_function_generator_disable_active;
            return Some((Rule::FastStop, axis_signal(axis, shown, true)));
        }
        let off = unit.members().find(|member| !self.axes[*member].enabling.is_on())?;
        let control = axis_signal(off, axis_from_nck::position_controller_active, false);
        order.begun.then_some((Rule::EnableLost, control))
    }

    /// One cycle on the way to the target.
    fn move_single_axis(&mut self, axis: AxisNumber, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        let Some(order) = self.single.axes[axis].order else { return };
        // A key that is pressed meanwhile starts nothing afterwards.
        self.axes[axis].jogging.pressed = [false; 2];
        let is_on = unit.members().all(|member| self.axes[member].enabling.is_on());
        let rests = self.axes[axis].setpoint.is_at_rest();
        if let Some(outcome) = order.ending {
            let cause = self.single.axes[axis].cause;
            self.travel(axis, Travel::None, cause);
            let moves = unit.members().any(|member| self.axes[member].enabling.moves());
            if rests || !moves {
                let event = self.log.now(Place::Axis(axis), cause, order.by.ends(), [Input::None; 3]);
                self.end_order(axis, outcome, event);
            }
            return;
        }
        let state = &self.axes[axis];
        let fine = state.active_set(&parameters.axes[axis]).exact_stop_fine;
        if is_on && rests && state.setpoint.position == order.target && state.deviation().abs() <= fine {
            let reached = [Input::Length(Quantity::Target, axis, order.target), Input::None, Input::None];
            let event = self.log.note(Place::Axis(axis), order.by.reached(), reached, order.cause);
            self.travel(axis, Travel::None, event);
            self.end_order(axis, Outcome::Reached, event);
            return;
        }
        if let Some(order) = &mut self.single.axes[axis].order {
            order.begun |= is_on;
        }
        let signals = &to_nck.axes[axis];
        let factor = parameters.axis_override(signals.feed_override(), signals.override_active());
        let held = self.holder_of_single((axis, unit), is_on, factor, parameters, to_nck);
        let added = if order.by_handwheel {
            self.override_by_handwheel(axis, true, held.is_some(), (parameters, to_nck)).unwrap_or(0.0)
        } else {
            0.0
        };
        let wanted = (order.velocity * factor + added).clamp(0.0, parameters.axes[axis].maximum_velocity);
        let velocity = if held.is_none() { wanted } else { 0.0 };
        self.led[axis] = Some(Led::Target { target: order.target, velocity });
        let sign = direction(order.target - self.axes[axis].setpoint.position);
        let travel = if held.is_some() { Travel::waiting(sign) } else { Travel::moving(sign) };
        if self.axes[axis].travel != travel {
            let rule = if travel == Travel::None { order.by.at_target() } else { order.by.moves() };
            let (rule, input) = held.unwrap_or((rule, Input::Length(Quantity::Target, axis, order.target)));
            let event = self.log.now(Place::Axis(axis), order.cause, rule, [input, Input::None, Input::None]);
            self.travel(axis, travel, event);
        }
    }

    fn end_order(&mut self, axis: AxisNumber, outcome: Outcome, cause: EventId) {
        let by_plc = self.single.axes[axis].order.is_some_and(|order| order.by == OrderedBy::Plc);
        self.single.set_order(axis, None);
        let one = &mut self.single.axes[axis];
        // Start may be 0 already.
        one.outcome = if by_plc && !one.start_was { Outcome::None } else { outcome };
        one.cause = cause;
    }

    /// The rule and the input that hold an axis.
    fn holder_of_single(
        &self,
        (axis, unit): (AxisNumber, &Unit),
        is_on: bool,
        factor: f64,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<(Rule, Input)> {
        let channel = &to_nck.channels[unit.channel];
        let independence = &self.single.axes[axis].independence;
        let is_plc_axis = self.owners.of(axis).holder == Holder::Plc;
        if independence.stopped {
            return Some((Rule::PlcStops, axis_signal(axis, axis_from_nck::axis_stop_active, true)));
        }
        if channel.nc_stop_axes_plus_spindles() && !independence.taken {
            let pressed = channel_to_nck::nc_stop_axes_plus_spindles;
            return Some((Rule::NcStop, channel_signal(unit.channel, pressed, true)));
        }
        if to_nck.mode_groups[unit.mode_group].mode_group_stop_axes_plus_spindles() && !independence.taken {
            let pressed = mode_group_to_nck::mode_group_stop_axes_plus_spindles;
            return Some((Rule::NcStop, mode_group_signal(unit.mode_group, pressed, true)));
        }
        let ignores_feed_disable = is_plc_axis && parameters.axes[axis].plc_axis.ignores_feed_disable;
        if let Some(disabled) = self.feed_disable(unit.channel, to_nck).filter(|_| !ignores_feed_disable) {
            return Some((Rule::HeldByFeedStop, disabled));
        }
        if let Some(stopper) = unit.members().find(|member| to_nck.axes[*member].feed_stop()) {
            return Some((Rule::HeldByFeedStop, axis_signal(stopper, axis_to_nck::feed_stop, true)));
        }
        if !is_on {
            let off = unit.members().find(|member| !self.axes[*member].enabling.is_on()).unwrap_or(axis);
            return Some((
                Rule::OrderWaitsForControl,
                axis_signal(off, axis_from_nck::position_controller_active, false),
            ));
        }
        (factor <= 0.0).then(|| (Rule::HeldByOverride, self.axes[axis].override_input(axis)))
    }

    /// 76.5 and DBD78: of orders, and of POS and POSA of programs. Returns the axes of which they have changed.
    fn note_positioning(&mut self, parameters: &Parameters) -> AxisSet {
        let mut now = AxisSet::NONE;
        let mut begins: Vec<(AxisNumber, f64, EventId)> = Vec::new();
        for axis in self.single.moving.iter() {
            now.set(axis, true);
            if let Some(order) = self.single.axes[axis].order {
                begins.push((axis, order.velocity, order.cause));
            }
        }
        for (channel, _) in parameters.existing_channels() {
            let Some(run) = self.programs[channel].run.as_deref() else { continue };
            for one in &run.positionings {
                now.set(one.axis, true);
                begins.push((one.axis, one.velocity, run.block_cause));
            }
        }
        let before = std::mem::replace(&mut self.single.positioning, now);
        let mut changed = now.without(before).with(before.without(now));
        for (axis, velocity, cause) in begins {
            let turns = if parameters.axes[axis].rotary { 360.0 } else { 1.0 };
            #[expect(clippy::cast_possible_truncation, reason = "DBD78 is a REAL")]
            let feed = (velocity * 60.0 / Position::PER_USER_UNIT / turns) as f32;
            let one = &mut self.single.axes[axis];
            if !before.contains(axis) || one.feed.to_bits() != feed.to_bits() {
                one.feed = feed;
                one.positioning_cause = self.log.note_plain(Place::Axis(axis), Rule::Positioning, cause);
                changed.set(axis, true);
            }
        }
        for axis in before.without(now).iter() {
            let cause = self.single.axes[axis].cause.max(self.axes[axis].causes.motion);
            self.single.axes[axis].positioning_cause =
                self.log.note_plain(Place::Axis(axis), Rule::PositioningEnds, cause);
        }
        changed
    }
}

/// +1, −1 or 0.
fn direction(way: Position) -> i8 {
    i8::try_from(way.increments().signum()).unwrap_or(0)
}
