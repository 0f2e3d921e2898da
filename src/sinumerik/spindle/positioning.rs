//! SPOS, SPOSA and M19: a spindle in position control at an angle; M70: a spindle as an axis.
//!
//! | phase | what happens | until |
//! |---|---|---|
//! | searching | in speed control at MD35300 in the present direction, at standstill in that of MD35350 | the zero mark has given the position; without one in two revolutions 22051 |
//! | going | in position control to the target with MD35300 and MD35210 | the setpoint rests on it, and the actual value is within MD36010: 85.5 |
//!
//! A spindle with a known position that turns no faster than MD35300 goes at once. Without an active encoder 22050 is raised. The spindle then
//! stays in position control until M3, M4, M5, spindle reset, or RESET and the end of the program with MD35040 = 0. Spindle stop (4.3), an
//! override of 0 % and a missing enable hold the movement.

use crate::image::{AxisToNck, ToNck, axis_from_nck};
use crate::motion::Motion;
use crate::nc_program::{Action, Dimension};
use crate::sinumerik::alarms;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::parameters::spindle::SpindleParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::{Mode, Phase, SpindlePositioning};
use crate::sinumerik::spindle::target::{Course, target};
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place, Quantity};

/// Revolutions in which a zero mark must come.
const SEARCH: Position = Position::new(720_000_000);

impl State {
    /// SPOS, SPOSA, M19, or the PLC: the rule orders a position.
    pub(in crate::sinumerik) fn position_spindle(
        &mut self,
        number: AxisNumber,
        (angle, dimension): (f64, Dimension),
        rule: Rule,
        parameters: &Parameters,
        cause: EventId,
    ) {
        let place = Place::Axis(number);
        let event = self.log.note_plain(place, rule, cause);
        if self.axes[number].measuring_system.is_none() || parameters.axes[number].encoders == 0 {
            let none = axis_signal(number, axis_from_nck::position_measuring_system_1_activated, false);
            let event = self.log.note_one(place, Rule::SpindleWithoutEncoder, none, event);
            self.raise_axis_alarm(alarms::SPINDLE_WITHOUT_POSITION_CONTROL, number, event);
            return;
        }
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            let phase = Phase::Searching { from: None };
            let positioning = SpindlePositioning { angle: Position::from_user(angle), dimension, speed: None, phase };
            (spindle.mode, spindle.mode_cause) = (Mode::Positioning(positioning), event);
            (spindle.direction, spindle.stopped, spindle.cause) = (0, false, event);
            spindle.position_cause = event;
        }
    }

    /// One cycle of a spindle that is positioned.
    pub(super) fn run_positioning(
        &mut self,
        unit: &Unit,
        mut order: SpindlePositioning,
        own: &SpindleParameters,
        (parameters, to_nck): (&Parameters, &ToNck),
    ) {
        let number = unit.leader();
        let signals = &to_nck.axes[number];
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        let holder = self.spindle_holder(unit, &spindle, own, to_nck);
        let factor = if holder.is_some() { 0.0 } else { self.spindle_factor(number, own, signals) };
        let stage = own.stage(spindle.gear_stage);
        let positioning_speed = order.speed.unwrap_or(stage.positioning_speed);
        let velocity = positioning_speed.min(own.speed_limit) * factor;
        // A spindle whose setpoint is not output (1.3, program test) passes no zero mark.
        let referenced = self.axes[number].is_referenced() || self.axes[number].signals.disabled_at.is_some();
        let slow = self.axes[number].setpoint.velocity().abs() <= positioning_speed * 1.001;
        if let Phase::Searching { from } = order.phase {
            if referenced && slow {
                order.phase = Phase::Going { target: self.begin_position_control(number, &order, own, parameters) };
            } else if self.zero_mark_is_missing(number, from) {
                let input = Input::Length(Quantity::Distance, number, SEARCH);
                let event = self.log.note_one(Place::Axis(number), Rule::SpindleMarkMissing, input, spindle.cause);
                self.raise_axis_alarm(alarms::SPINDLE_MARK_MISSING, number, event);
            } else if from.is_none() && slow && !referenced {
                order.phase = Phase::Searching { from: Some(self.axes[number].actual) };
            }
        }
        let direction = match order.phase {
            Phase::Searching { .. } => self.search_direction(number, &order, own),
            Phase::Going { target } | Phase::InPosition { target } => {
                let rest = target - self.axes[number].setpoint.position;
                i8::try_from(rest.increments().signum()).unwrap_or(0)
            }
        };
        match order.phase {
            Phase::Searching { .. } => {
                let velocity = velocity * f64::from(direction);
                self.axes[number].motion = Motion::Run { velocity, acceleration: stage.acceleration };
            }
            Phase::Going { target } | Phase::InPosition { target } => {
                let acceleration = stage.positioning_acceleration;
                self.axes[number].motion = Motion::GoTo { target, velocity, acceleration };
                self.watch_spindle_target(number, target, &mut order, parameters);
            }
        }
        let commanded = if holder.is_some() { 0.0 } else { velocity * f64::from(direction) };
        let there = matches!(order.phase, Phase::InPosition { .. });
        let travel = match holder {
            _ if there => Travel::None,
            None => Travel::moving(direction),
            Some(_) => Travel::waiting(direction),
        };
        self.show_spindle_travel(number, travel, holder, (&spindle, signals));
        if let Some(spindle) = self.spindles[number].as_deref_mut()
            && matches!(spindle.mode, Mode::Positioning(_))
        {
            spindle.mode = Mode::Positioning(order);
            (spindle.commanded, spindle.limited, spindle.raised, spindle.is_new) = (commanded, false, false, false);
            spindle.holder = holder.map_or(Input::None, |(_, input)| input);
        }
    }

    /// The direction in which the zero mark is searched.
    fn search_direction(&self, number: AxisNumber, order: &SpindlePositioning, own: &SpindleParameters) -> i8 {
        let velocity = self.axes[number].setpoint.velocity();
        let stands = self.axes[number].setpoint.is_at_rest();
        match order.dimension {
            _ if !stands => {
                if velocity > 0.0 {
                    1
                } else {
                    -1
                }
            }
            Dimension::FromPlus => 1,
            Dimension::FromMinus => -1,
            Dimension::Absolute | Dimension::Incremental | Dimension::Shortest => own.search_direction,
        }
    }

    /// Two revolutions have passed since the search began.
    fn zero_mark_is_missing(&self, number: AxisNumber, from: Option<Position>) -> bool {
        let axis = &self.axes[number];
        !axis.is_referenced() && from.is_some_and(|from| (axis.actual - from).abs() > SEARCH)
    }

    /// Closes position control at the present speed, and returns the target. The setpoint leads by the following error of this speed.
    fn begin_position_control(
        &mut self,
        number: AxisNumber,
        order: &SpindlePositioning,
        own: &SpindleParameters,
        parameters: &Parameters,
    ) -> Position {
        let gear_stage = self.spindles[number].as_deref().map_or(0, |spindle| spindle.gear_stage);
        let deceleration = own.stage(gear_stage).positioning_acceleration;
        if self.axes[number].speed_controlled {
            self.axes[number].close_position_control(&parameters.axes[number]);
            let shown = self.reference_inputs(number, parameters).0;
            let cause = self.spindles[number].as_deref().map_or(EventId::NONE, |spindle| spindle.cause);
            let event = self.log.note(Place::Axis(number), Rule::SpindleClosesLoop, shown, cause);
            if let Some(spindle) = self.spindles[number].as_deref_mut() {
                spindle.mode_cause = event;
            }
        }
        let axis = &self.axes[number];
        let course = Course { position: axis.setpoint.position, velocity: axis.setpoint.velocity(), deceleration };
        target(order.angle, order.dimension, course)
    }

    /// 85.5 comes when the setpoint rests on the target and the actual value is within exact stop fine.
    fn watch_spindle_target(
        &mut self,
        number: AxisNumber,
        target: Position,
        order: &mut SpindlePositioning,
        parameters: &Parameters,
    ) {
        let axis = &self.axes[number];
        let fine = axis.active_set(&parameters.axes[number]).exact_stop_fine;
        let rests = axis.setpoint.is_at_rest() && axis.setpoint.position == target;
        if rests && axis.deviation().abs() <= fine && matches!(order.phase, Phase::Going { .. }) {
            order.phase = Phase::InPosition { target };
            let reached = Input::Length(Quantity::Deviation, number, axis.deviation());
            let begun = self.spindles[number].as_deref().map_or(EventId::NONE, |spindle| spindle.cause);
            let event = self.log.note_one(Place::Axis(number), Rule::SpindleInPosition, reached, begun);
            if let Some(spindle) = self.spindles[number].as_deref_mut() {
                (spindle.cause, spindle.position_cause) = (event, event);
            }
        }
    }

    /// Whether a spindle is on its way to a position.
    pub(in crate::sinumerik) fn is_being_positioned(&self, number: AxisNumber) -> bool {
        let order = self.spindles[number].as_deref().map(|spindle| spindle.mode);
        matches!(
            order,
            Some(Mode::Positioning(SpindlePositioning { phase: Phase::Searching { .. } | Phase::Going { .. }, .. }))
        )
    }

    /// Whether a spindle of a channel is on its way to a position.
    pub(in crate::sinumerik) fn spindles_are_positioned(&self, own: &ProgramParameters) -> bool {
        own.spindles.iter().any(|(_, axis)| self.is_being_positioned(*axis))
    }

    /// Whether the spindles for which actions of a block wait are where they shall be: SPOS and M19 in position; WAITS in position, at their
    /// speed, or at rest.
    pub(in crate::sinumerik) fn spindles_have_arrived(
        &self,
        actions: &[Action],
        own: &ProgramParameters,
        parameters: &Parameters,
    ) -> bool {
        let ready = |number: &AxisNumber| {
            !self.is_being_positioned(*number)
                && (matches!(self.spindle_mode(*number), Some(Mode::Positioning(_)))
                    || self.is_in_speed_range(*number, parameters))
        };
        actions.iter().all(|action| match action {
            Action::SpindlePosition { spindle, waits: true, .. } => {
                own.spindle(spindle.unwrap_or(0)).is_none_or(|number| !self.is_being_positioned(number))
            }
            Action::WaitForSpindle(spindles) if spindles.is_empty() => own.spindle(0).as_ref().is_none_or(ready),
            Action::WaitForSpindle(spindles) => {
                spindles.iter().filter_map(|spindle| own.spindle(*spindle)).all(|number| ready(&number))
            }
            _ => true,
        })
    }

    /// The mode of a spindle.
    pub(in crate::sinumerik) fn spindle_mode(&self, number: AxisNumber) -> Option<Mode> {
        self.spindles[number].as_deref().map(|spindle| spindle.mode)
    }

    /// Brings the loop of a spindle into line with its mode: speed control, or position control of an axis once it stands (M70).
    pub(super) fn follow_spindle_mode(&mut self, number: AxisNumber, parameters: &Parameters) {
        let axis = &mut self.axes[number];
        match self.spindles[number].as_deref().map(|spindle| spindle.mode) {
            Some(Mode::Control) if !axis.speed_controlled => axis.speed_controlled = true,
            Some(Mode::Axis) if axis.speed_controlled && axis.stands(&parameters.axes[number]) => {
                axis.close_position_control(&parameters.axes[number]);
                let cause = self.spindles[number].as_deref().map_or(EventId::NONE, |spindle| spindle.cause);
                let event = self.log.note_plain(Place::Axis(number), Rule::SpindleIsAxis, cause);
                if let Some(spindle) = self.spindles[number].as_deref_mut() {
                    spindle.mode_cause = event;
                }
            }
            Some(Mode::Control | Mode::Positioning(_) | Mode::Axis) | None => {}
        }
    }

    /// The override of a spindle.
    pub(in crate::sinumerik) fn spindle_factor(
        &self,
        number: AxisNumber,
        own: &SpindleParameters,
        signals: &AxisToNck,
    ) -> f64 {
        super::turning::spindle_factor(own, signals, self.axes[number].feed_factor)
    }
}
