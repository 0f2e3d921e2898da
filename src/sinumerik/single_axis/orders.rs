//! The start of a positioning axis by the PLC: what FC 18 writes, and what refuses it.
//!
//! | error | condition |
//! |---|---|
//! | 1 | several ways of approach at once |
//! | 20 | it still brakes after Start = 0 (X-11) |
//! | 40 | the axis is no PLC axis: programs have it, or it is neutral |
//! | 50, 60 | a permanent, temporary PLC axis that is jogged or referenced |
//! | 100 | a value that is no position, a modulo position outside of 0 to 359.999 (MD30455 bit 0 = 0), or no velocity: neither a feedrate nor MD32060 |
//! | 106 | it is positioned already |
//! | 107 | an absolute target of an axis that is not referenced |
//! | 120 | it is no indexing axis (also alarm 20072) |
//! | 125 to 127 | shortest way, minus, plus: not for a linear axis |
//! | 130, 131 | behind the software limit plus, minus (20070) |
//! | 132, 133 | behind the working area limit plus, minus (20071) |

use crate::image::{AxisToNck, axis_from_nck, axis_to_nck};
use crate::nc_program::{Dimension, INCH};
use crate::sinumerik::alarms::axis_exchange as alarms;
use crate::sinumerik::axis::limits::selected_limit;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::program::geometry;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::state::{Order, OrderedBy, Outcome};
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, Quantity, RaisedAlarm};

/// A start before the axis stands.
const STARTED_TOO_EARLY: u8 = 20;

/// Why a start is refused: the error number, what was tested, and the limit behind which the target is.
struct OrderRefusal {
    error: u8,
    input: Input,
    limit: Option<(AlarmNumber, i8)>,
}

impl OrderRefusal {
    const fn new(error: u8, input: Input) -> Self {
        Self { error, input, limit: None }
    }
}

impl State {
    /// The start bits of FC 18.
    pub(super) fn watch_start(&mut self, axis: AxisNumber, signals: &AxisToNck, parameters: &Parameters) {
        self.watch_spindle_order(axis, signals, parameters);
        let start = signals.start_positioning_axis();
        let was = std::mem::replace(&mut self.single.axes[axis].start_was, start);
        let starts = axis_signal(axis, axis_to_nck::start_positioning_axis, start);
        if start && !was {
            self.start_order(axis, signals, parameters, starts);
        } else if was && !start {
            self.withdraw(axis, starts);
        }
    }

    fn start_order(&mut self, axis: AxisNumber, signals: &AxisToNck, parameters: &Parameters, starts: Input) {
        match self.order(axis, signals, parameters) {
            Ok((target, velocity)) => {
                let goal = Input::Length(Quantity::Target, axis, target);
                let event =
                    self.log.note(Place::Axis(axis), Rule::OrderStarted, [starts, goal, Input::None], EventId::NONE);
                let by_handwheel = signals.positioning_with_handwheel_override();
                let order = Order {
                    target,
                    velocity,
                    by: OrderedBy::Plc,
                    cause: event,
                    by_handwheel,
                    begun: false,
                    ending: None,
                };
                self.begin_order(axis, order);
            }
            Err(refusal) => {
                let inputs = [starts, refusal.input, Input::None];
                let event = self.log.note(Place::Axis(axis), Rule::OrderRefused, inputs, EventId::NONE);
                let one = &mut self.single.axes[axis];
                match &mut one.order {
                    None => {
                        (one.outcome, one.cause, one.limit) = (Outcome::Refused(refusal.error), event, refusal.limit);
                    }
                    // Start came again while the axis still brakes. The refusal stays until Start is 0.
                    Some(order) if order.by == OrderedBy::Plc && order.ending.is_some() => {
                        let refused = Outcome::Refused(STARTED_TOO_EARLY);
                        (order.ending, one.outcome, one.cause) = (Some(refused), refused, event);
                    }
                    Some(_) => {}
                }
            }
        }
    }

    /// The axis goes to a target.
    pub(in crate::sinumerik) fn begin_order(&mut self, axis: AxisNumber, order: Order) {
        self.single.set_order(axis, Some(order));
        let one = &mut self.single.axes[axis];
        (one.outcome, one.cause, one.limit) = (Outcome::None, order.cause, None);
    }

    /// Start is 0: a running order stops, and the outcome of an ended one is no longer shown.
    fn withdraw(&mut self, axis: AxisNumber, starts: Input) {
        let event = self.log.note_one(Place::Axis(axis), Rule::OrderWithdrawn, starts, EventId::NONE);
        let one = &mut self.single.axes[axis];
        one.cause = event;
        match &mut one.order {
            Some(order) if order.by == OrderedBy::Plc => {
                (order.ending, one.outcome) = (Some(Outcome::None), Outcome::None);
            }
            Some(_) => {}
            None => one.outcome = Outcome::None,
        }
        if let Some((number, direction)) = one.limit.take() {
            let alarm = self.limit_alarm(axis, number, direction);
            self.alarms.end(&alarm, event);
        }
    }

    /// 20070 and 20071 while the refusal is shown.
    pub(super) fn show_limit(&mut self, axis: AxisNumber) {
        let one = self.single.axes[axis];
        if let Some((number, direction)) = one.limit {
            let alarm = self.limit_alarm(axis, number, direction);
            self.alarms.raise(alarm.number, alarm.place, alarm.parameters, one.cause);
        }
    }

    fn limit_alarm(&self, axis: AxisNumber, number: AlarmNumber, direction: i8) -> RaisedAlarm {
        let channel = Parameter::Channel(self.owners.of(axis).channel);
        let side = if direction == 0 { Parameter::None } else { Parameter::Direction(direction) };
        let parameters = [channel, Parameter::Axis(axis), side, Parameter::None];
        RaisedAlarm { number, place: Place::Axis(axis), parameters }
    }

    /// The target and the velocity that the PLC wants, or why not.
    fn order(
        &self,
        axis: AxisNumber,
        signals: &AxisToNck,
        parameters: &Parameters,
    ) -> Result<(Position, f64), OrderRefusal> {
        let (state, data) = (&self.axes[axis], &parameters.axes[axis]);
        if self.owners.of(axis).holder != Holder::Plc || self.unit_of(axis).is_none() {
            return Err(OrderRefusal::new(40, axis_signal(axis, axis_from_nck::plc_axis, false)));
        }
        if self.single.axes[axis].order.is_some() {
            return Err(OrderRefusal::new(106, axis_signal(axis, axis_from_nck::positioning_active, true)));
        }
        if state.approach.is_running() || state.travel.is_pending() {
            let error = if data.plc_axis.is_reserved() { 50 } else { 60 };
            return Err(OrderRefusal::new(error, state.travel.shown(axis, parameters)));
        }
        if signals.indexing_position() {
            let input = axis_signal(axis, axis_to_nck::indexing_position, true);
            return Err(OrderRefusal { error: 120, input, limit: Some((alarms::NO_INDEXING_AXIS, 0)) });
        }
        let target = target(axis, state.setpoint.position, signals, data, state.is_referenced())?;
        let velocity =
            velocity(signals, data).ok_or_else(|| OrderRefusal::new(100, Input::Datum(32060, Some(axis), 0.0)))?;
        if state.is_referenced() {
            behind_limit(axis, target, signals, data)?;
        }
        Ok((target, velocity))
    }
}

/// The target in machine coordinates.
fn target(
    axis: AxisNumber,
    from: Position,
    signals: &AxisToNck,
    data: &AxisParameters,
    is_referenced: bool,
) -> Result<Position, OrderRefusal> {
    let (incremental, shortest) = (signals.incremental_position(), signals.shortest_distance());
    let (minus, plus) = (signals.approach_in_minus_direction(), signals.approach_in_plus_direction());
    let ways = [
        (shortest, 125, axis_to_nck::shortest_distance),
        (minus, 126, axis_to_nck::approach_in_minus_direction),
        (plus, 127, axis_to_nck::approach_in_plus_direction),
        (incremental, 1, axis_to_nck::incremental_position),
    ];
    let chosen: Vec<_> = ways.iter().filter(|(is_set, ..)| *is_set).collect();
    if let [_, (_, _, second), ..] = chosen.as_slice() {
        return Err(OrderRefusal::new(1, axis_signal(axis, *second, true)));
    }
    if let Some((_, error, signal)) = chosen.iter().find(|(_, error, _)| *error != 1 && !data.rotary) {
        return Err(OrderRefusal::new(*error, axis_signal(axis, *signal, true)));
    }
    let inches = signals.position_in_inches() && !data.rotary;
    let value = f64::from(signals.positioning_target()) * if inches { INCH } else { 1.0 };
    let bad = || OrderRefusal::new(100, Input::None);
    if !value.is_finite() || value.abs() > 1e9 {
        return Err(bad());
    }
    let value = Position::from_user(value);
    if incremental {
        return Ok(from + value);
    }
    if !is_referenced {
        return Err(OrderRefusal::new(107, axis_signal(axis, axis_from_nck::referenced_synchronized_1, false)));
    }
    let dimension = match (shortest, plus, minus) {
        (true, ..) => Dimension::Shortest,
        (_, true, _) => Dimension::FromPlus,
        (_, _, true) => Dimension::FromMinus,
        _ => Dimension::Absolute,
    };
    if !data.is_within_modulo(value.user(), dimension) {
        return Err(bad());
    }
    let dimension = if data.modulo { dimension } else { Dimension::Absolute };
    let target = geometry::target(value.increments() as f64, dimension, from.increments() as f64, 0.0, data.modulo);
    #[expect(clippy::cast_possible_truncation, reason = "a position fits")]
    Ok(Position::new(target.round() as i64))
}

/// In increments per second.
fn velocity(signals: &AxisToNck, data: &AxisParameters) -> Option<f64> {
    let feed = f64::from(signals.positioning_feedrate());
    let inches = signals.position_in_inches() && !data.rotary;
    let wanted = if feed > 0.0 {
        data.velocity_of_feed(feed) * if inches { INCH } else { 1.0 }
    } else {
        data.positioning_velocity
    };
    (wanted > 0.0 && wanted.is_finite()).then(|| wanted.min(data.maximum_velocity))
}

/// The alarm of the limit behind which a target is, and its direction.
pub(in crate::sinumerik) fn limit_behind(
    axis: AxisNumber,
    target: Position,
    signals: &AxisToNck,
    data: &AxisParameters,
) -> Option<(AlarmNumber, i8)> {
    behind_limit(axis, target, signals, data).err().and_then(|refusal| refusal.limit)
}

/// 20070, 20071: only of a referenced axis.
fn behind_limit(
    axis: AxisNumber,
    target: Position,
    signals: &AxisToNck,
    data: &AxisParameters,
) -> Result<(), OrderRefusal> {
    for (direction, place) in [(1_i8, 0_u8), (-1, 1)] {
        let beyond = |limit: Position| (target - limit).increments() * i64::from(direction) > 0;
        let software = selected_limit(signals, data, direction).filter(|limit| beyond(*limit));
        let area = data.working_area[usize::from(direction > 0)].filter(|limit| beyond(*limit));
        let second = if direction > 0 {
            signals.second_software_limit_switch_plus()
        } else {
            signals.second_software_limit_switch_minus()
        };
        let datum = [[36100, 36120], [36110, 36130]][usize::from(direction > 0)][usize::from(second)];
        let (alarm, error, input) = match (software, area) {
            (Some(limit), _) => {
                (alarms::BEHIND_SOFTWARE_LIMIT, 130 + place, Input::Datum(datum, Some(axis), limit.user()))
            }
            (None, Some(_)) => (alarms::BEHIND_WORKING_AREA, 132 + place, Input::None),
            (None, None) => continue,
        };
        return Err(OrderRefusal { error, input, limit: Some((alarm, direction)) });
    }
    Ok(())
}
