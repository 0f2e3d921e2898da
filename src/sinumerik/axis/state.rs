//! The state of one machine axis.

use serde::{Deserialize, Serialize};

use crate::image::axis_to_nck;
use crate::motion::{Brake, Feedback, Motion, Setpoint, coupling};
use crate::sinumerik::axis::controllers::{ControllerState, Enabling};
use crate::sinumerik::axis::shaping::Shaping;
use crate::sinumerik::axis::test_travel::TestTravel;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::compensation::state::Compensation;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::jog::state::Jogging;
use crate::sinumerik::monitoring::state::AxisMonitor;
use crate::sinumerik::overlay::state::{HandwheelOverride, Overlay};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::dynamics::ParameterSet;
use crate::sinumerik::referencing::state::Approach;
use crate::units::{AxisNumber, PerAxis, Position};
use crate::variables::{EventId, Input};

/// The events behind the signals of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Causes {
    /// 93.5, 93.7.
    pub drive: EventId,
    /// 61.5 to 61.7.
    pub enabling: EventId,
    /// The last condition of position control that became true.
    pub allowed: EventId,
    /// 61.3.
    pub follow_up: EventId,
    /// 92.5.
    pub brake: EventId,
    /// 102.5, 102.6.
    pub measuring_system: EventId,
    /// 60.4, 60.5.
    pub reference: [EventId; 2],
    /// 71.4, 71.5.
    pub restored: [EventId; 2],
    /// 64.4 to 64.7.
    pub motion: EventId,
    /// 69.0 to 69.2.
    pub parameter_set: EventId,
    /// 93.0 to 93.4.
    pub drive_data_set: EventId,
    /// The last fault that began or ended and can move the axis or change what its drive and encoders report.
    pub fault: EventId,
}

impl Causes {
    /// The event behind a change of the actual value: the last movement or fault.
    pub(in crate::sinumerik) fn movement(&self) -> EventId {
        self.motion.max(self.fault)
    }
}

/// One machine axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Axis {
    /// Setpoint.
    pub setpoint: Setpoint,
    /// The setpoint before this cycle, from which it is finely interpolated.
    pub before: Position,
    /// The motion command of this cycle.
    pub motion: Motion,
    /// Counts the cycles in which a filter or delay of its setpoint has not run out.
    pub unsettled: u32,
    /// Lag of the position-control setpoint behind that of the interpolator, in increments, and the velocity for feedforward, in
    /// the last position-control cycle.
    pub branch: (f64, f64),
    /// A spindle in speed control: the drive gets the velocity of the setpoint, which stays with the actual value.
    pub speed_controlled: bool,
    /// The active parameter set, 0 to 5.
    pub parameter_set: u8,
    /// The data set that its drive has accepted.
    pub drive_data_set: u8,
    /// The target of a [`Motion::GoTo`] is reached, and the setpoint rests on it.
    pub arrived: bool,
    /// Actual value minus encoder value, of each measuring system.
    pub offset: [Position; 2],
    /// Which measuring system is referenced.
    pub referenced: [bool; 2],
    /// Whose position was restored at power on, without a reference (MD34210 = 3).
    pub restored: [bool; 2],
    /// The active measuring system, 0 or 1; `None` for a parked axis.
    pub measuring_system: Option<u8>,
    /// Actual value in the machine coordinate system.
    pub actual: Position,
    /// The zero mark passed in the last cycle, as an actual value.
    pub zero_mark: Option<Position>,
    /// Actual velocity.
    pub velocity: f64,
    /// The DRF offset.
    pub overlay: Overlay,
    /// FD, FDA.
    pub by_handwheel: Option<HandwheelOverride>,
    /// The function generator.
    pub test_travel: TestTravel,
    /// The compensations.
    pub compensation: Compensation,
    /// Half a count of the active encoder.
    pub half_count: Position,
    /// True position, for display.
    pub slide: Position,
    /// The drive has started up.
    pub drive_ready: bool,
    /// The holding brake of its motor.
    pub brake: Brake,
    /// Enabling of position control.
    pub enabling: Enabling,
    /// Reference point approach.
    pub approach: Approach,
    /// A traversing key started an approach and has not been released since.
    pub key_used: bool,
    /// Direction of a key that was pressed in REF with MD11300 = 0 before all axes of the unit were in position control.
    pub key_pending: i8,
    /// Direction of the key that started the approach; 0 for channel-specific referencing.
    pub approach_key: i8,
    /// Whether it is to travel, 64.4 to 64.7.
    pub travel: Travel,
    /// Factor of the axial override.
    pub feed_factor: f64,
    /// The axial override, DBB0.
    pub feed_override: u8,
    /// 1.7.
    pub override_is_active: bool,
    /// Feed stop on an axis of its unit, or feed disable of its channel.
    pub feed_held: bool,
    /// Feed disable of its channel.
    pub feed_disabled: bool,
    /// The signal that holds it, of this axis or of another axis of its unit; in the cycle of its release, that signal with 0.
    pub feed_holder: Input,
    /// Hardware limit switches.
    pub limits: LimitSwitches,
    /// Monitoring.
    pub monitor: AxisMonitor,
    /// Keys and handwheels.
    pub jogging: Jogging,
    /// Axis disable, ramp-function generator fast stop, delete distance-to-go.
    pub signals: AxisSignals,
    /// The events behind its signals.
    pub causes: Causes,
}

impl Default for Axis {
    fn default() -> Self {
        Self {
            setpoint: Setpoint::default(),
            before: Position::ZERO,
            motion: Motion::Hold,
            unsettled: 0,
            branch: (0.0, 0.0),
            speed_controlled: false,
            parameter_set: 0,
            drive_data_set: 0,
            arrived: false,
            offset: [Position::ZERO; 2],
            referenced: [false; 2],
            restored: [false; 2],
            measuring_system: None,
            actual: Position::ZERO,
            zero_mark: None,
            velocity: 0.0,
            overlay: Overlay::default(),
            by_handwheel: None,
            test_travel: TestTravel::default(),
            compensation: Compensation::default(),
            half_count: Position::ZERO,
            slide: Position::ZERO,
            drive_ready: false,
            brake: Brake::None,
            enabling: Enabling::default(),
            approach: Approach::default(),
            key_used: false,
            key_pending: 0,
            approach_key: 0,
            travel: Travel::None,
            feed_factor: 1.0,
            feed_override: 0,
            override_is_active: false,
            feed_held: false,
            feed_disabled: false,
            feed_holder: Input::None,
            limits: LimitSwitches::default(),
            monitor: AxisMonitor::default(),
            jogging: Jogging::default(),
            signals: AxisSignals::default(),
            causes: Causes::default(),
        }
    }
}

impl Axis {
    /// Whether the decisions about both axes are equal; their movements may differ.
    pub(in crate::sinumerik) fn has_decisions_of(&self, other: &Self) -> bool {
        (self.motion, self.enabling, self.travel) == (other.motion, other.enabling, other.travel)
            && (self.parameter_set, self.drive_data_set, self.measuring_system, self.drive_ready)
                == (other.parameter_set, other.drive_data_set, other.measuring_system, other.drive_ready)
            && self.brake == other.brake
            && (self.feed_factor, self.feed_override, self.override_is_active)
                == (other.feed_factor, other.feed_override, other.override_is_active)
            && (self.feed_held, self.feed_disabled, self.feed_holder)
                == (other.feed_held, other.feed_disabled, other.feed_holder)
            && (self.key_used, self.key_pending, self.approach_key, self.limits)
                == (other.key_used, other.key_pending, other.approach_key, other.limits)
            && (self.offset, self.referenced, self.restored) == (other.offset, other.referenced, other.restored)
            && (&self.jogging, self.speed_controlled) == (&other.jogging, other.speed_controlled)
            && self.signals == other.signals
            && self.causes == other.causes
            && self.by_handwheel == other.by_handwheel
            && self.test_travel.has_decisions_of(&other.test_travel)
            && self.approach == other.approach
    }

    /// Whether both axes have the same movement, if drive and encoders reported the same for both.
    pub(in crate::sinumerik) fn has_movement_of(&self, other: &Self) -> bool {
        (self.setpoint, self.before, self.arrived) == (other.setpoint, other.before, other.arrived)
            && (self.branch, self.unsettled) == (other.branch, other.unsettled)
            && self.compensation == other.compensation
            && self.overlay == other.overlay
            && self.test_travel.offset == other.test_travel.offset
            && self.monitor == other.monitor
    }

    /// Takes over the movement of the other axis.
    pub(in crate::sinumerik) fn take_movement_of(&mut self, other: &Self) {
        (self.setpoint, self.before, self.unsettled) = (other.setpoint, other.before, other.unsettled);
        (self.branch, self.arrived, self.compensation) = (other.branch, other.arrived, other.compensation);
        self.overlay = other.overlay;
        self.test_travel.offset = other.test_travel.offset;
        (self.actual, self.zero_mark, self.velocity) = (other.actual, other.zero_mark, other.velocity);
        (self.half_count, self.slide, self.monitor) = (other.half_count, other.slide, other.monitor);
    }

    /// The course of its movement.
    pub(in crate::sinumerik) fn way(&self) -> Way {
        Way { rests: self.setpoint.is_at_rest(), ahead: self.motion.direction(self.setpoint.position) }
    }

    /// Whether its decisions depend on its position: an approach, axis disable, handwheels, follow-up.
    pub(in crate::sinumerik) fn decisions_follow_movement(&self) -> bool {
        self.approach.is_running()
            || self.signals.disabled_at.is_some()
            || self.jogging.handwheels != 0
            || self.motion == Motion::Track
    }

    /// Takes the feedback of drive and encoders.
    pub(in crate::sinumerik) fn sense(&mut self, feedback: &Feedback) {
        self.velocity = feedback.velocity;
        self.slide = feedback.slide;
        (self.drive_ready, self.brake) = (feedback.drive_ready, feedback.brake);
        if let Some(active) = self.measuring_system {
            let active = usize::from(active);
            let encoder = feedback.encoders[active];
            self.half_count = feedback.half_count[active];
            let to_actual = self.to_actual(active);
            self.actual = encoder.value + to_actual;
            self.zero_mark = encoder.zero_mark.map(|mark| mark + to_actual);
        }
    }

    /// What the value of an encoder gets to become an actual value: its offset, the compensations, and not the DRF offset.
    #[must_use]
    pub(in crate::sinumerik) fn to_actual(&self, encoder: usize) -> Position {
        self.offset[encoder] + self.compensation.of(encoder) - self.overlay.position()
    }

    /// Whether the active measuring system is referenced.
    #[must_use]
    pub(in crate::sinumerik) fn is_referenced(&self) -> bool {
        self.measuring_system.is_some_and(|active| self.referenced[usize::from(active)])
    }

    /// Whether the position of the active measuring system is known: referenced, or restored at power on.
    #[must_use]
    pub(in crate::sinumerik) fn knows_position(&self) -> bool {
        self.measuring_system.is_some_and(|active| {
            let active = usize::from(active);
            self.referenced[active] || self.restored[active]
        })
    }

    /// The data of the active parameter set.
    #[must_use]
    pub(in crate::sinumerik) fn active_set<'a>(&self, parameters: &'a AxisParameters) -> &'a ParameterSet {
        &parameters.dynamics.sets[usize::from(self.parameter_set)]
    }

    /// Setpoint minus actual value; with axis disable, the setpoint that position control holds.
    #[must_use]
    pub(in crate::sinumerik) fn deviation(&self) -> Position {
        self.signals.disabled_at().unwrap_or(self.setpoint.position) - self.actual
    }

    /// Whether the setpoint rests and the velocity is below MD36060.
    #[must_use]
    pub(in crate::sinumerik) fn stands(&self, parameters: &AxisParameters) -> bool {
        self.setpoint.is_at_rest() && self.velocity.abs() < parameters.standstill_velocity
    }

    /// Whether the axis is stationary (O-29): no new setpoints are output to its drive, and its velocity is below MD36060.
    #[must_use]
    pub(in crate::sinumerik) fn is_stationary(&self, parameters: &AxisParameters) -> bool {
        !self.outputs_setpoints() && self.velocity.abs() < parameters.standstill_velocity
    }

    /// Whether new setpoints are output to the drive. In follow-up, with axis disable and during the fast stop they are not.
    #[must_use]
    pub(in crate::sinumerik) fn outputs_setpoints(&self) -> bool {
        self.enabling.moves() && !self.signals.withholds_setpoint() && self.is_moving()
    }

    /// 64.6 and 64.7: +1, −1 or 0; of its own travel, or of a compensation that moves it (SIG-10).
    #[must_use]
    pub(in crate::sinumerik) fn command(&self, parameters: &Parameters) -> i8 {
        match self.travel.command(parameters) {
            0 if self.overlay.command != 0 => self.overlay.command,
            0 => self.compensation.command,
            command => command,
        }
    }

    /// Whether the axis moves or is to move.
    #[must_use]
    pub(in crate::sinumerik) fn is_in_motion(&self) -> bool {
        self.travel.is_pending() || self.is_moving()
    }

    /// Whether the axis moves; an axis that is held or waits for an enable does not.
    #[must_use]
    pub(in crate::sinumerik) fn is_moving(&self) -> bool {
        self.travel.is_moving() || self.setpoint_moves()
    }

    /// Whether the setpoint moves: its own movement, the DRF offset, or the function generator.
    #[must_use]
    pub(in crate::sinumerik) fn setpoint_moves(&self) -> bool {
        !self.setpoint.is_at_rest() || self.overlay.command != 0 || self.test_travel.moves
    }

    /// Shifts the actual value at the present position: nothing moves.
    pub(in crate::sinumerik) fn shift(&mut self, by: Position) {
        if let Some(active) = self.measuring_system {
            self.offset[usize::from(active)] += by;
            self.actual += by;
            self.setpoint.shift(by);
            self.monitor.shift(by);
            self.signals.shift(by);
        }
    }

    /// Executes the command of the cycle, with the filters of the axis.
    pub(in crate::sinumerik) fn execute(
        &mut self,
        shaping: Option<&mut Shaping>,
        parameters: &AxisParameters,
        cycle: f64,
    ) {
        let (motion, actual) = (self.motion, self.actual);
        let command =
            |setpoint: &mut Setpoint| motion.execute(setpoint, actual, parameters.maximum_acceleration, cycle);
        let Some(filter) = shaping.and_then(|shaping| shaping.jerk.as_mut()) else {
            self.arrived = command(&mut self.setpoint);
            return;
        };
        // A stop by the enabling sequence does not wait for a filter.
        let fast = matches!(self.enabling.control, ControllerState::Braking(_))
            || motion.is_fast(parameters.dynamics.jerk.hardest);
        let first = motion.acceleration().map(|rate| parameters.dynamics.jerk.window_for(rate, cycle));
        self.arrived = filter.step(&mut self.setpoint, first, fast, cycle, command);
        self.unsettled = self.unsettled.wrapping_add(u32::from(filter.is_busy()));
    }
}

impl coupling::Axes for PerAxis<Axis> {
    fn actual(&self, axis: AxisNumber) -> Position {
        self[axis].actual
    }

    fn setpoint(&self, axis: AxisNumber) -> &Setpoint {
        &self[axis].setpoint
    }

    fn is_referenced(&self, axis: AxisNumber) -> bool {
        self[axis].is_referenced()
    }
}

/// The facts of a movement that lead to another decision when they change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::sinumerik) struct Way {
    /// The setpoint rests.
    rests: bool,
    /// Direction of its target or of its motion: +1, −1 or 0.
    ahead: i8,
}

/// The limit switches of an axis in the last cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct LimitSwitches {
    pub minus: bool,
    pub plus: bool,
    pub cause: EventId,
}

impl LimitSwitches {
    /// The switch of this axis in a direction, with its present value.
    pub(in crate::sinumerik) const fn input(self, axis: AxisNumber, direction: i8) -> Input {
        if direction > 0 {
            axis_signal(axis, axis_to_nck::hardware_limit_switch_plus, self.plus)
        } else {
            axis_signal(axis, axis_to_nck::hardware_limit_switch_minus, self.minus)
        }
    }

    /// Whether a movement in this direction leads further onto a switch.
    pub(in crate::sinumerik) const fn blocks(self, direction: i8) -> bool {
        direction > 0 && self.plus || direction < 0 && self.minus
    }
}

/// The state of these signals on one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct AxisSignals {
    /// The unit is stopped by 20.1: 92.1.
    pub fast_stop: bool,
    /// The event behind it.
    pub fast_stop_cause: EventId,
    /// The position at which position control holds the axis while its setpoint is not output.
    pub disabled_at: Option<Position>,
    /// 2.2 in the last cycle.
    pub delete_was: bool,
}

impl AxisSignals {
    /// The setpoint of position control while axis disable acts.
    #[must_use]
    #[inline]
    pub(in crate::sinumerik) const fn disabled_at(&self) -> Option<Position> {
        self.disabled_at
    }

    /// Whether position control does not use the setpoint: axis disable, or the fast stop.
    #[must_use]
    pub(in crate::sinumerik) const fn withholds_setpoint(&self) -> bool {
        self.fast_stop || self.disabled_at.is_some()
    }

    /// Shifts the coordinate of the present position.
    pub(in crate::sinumerik) fn shift(&mut self, by: Position) {
        if let Some(held) = &mut self.disabled_at {
            *held += by;
        }
    }

    /// Makes position control hold the actual value.
    pub(in crate::sinumerik) fn hold_at(&mut self, actual: Position) {
        if self.disabled_at.is_some() {
            self.disabled_at = Some(actual);
        }
    }
}
