//! The state of one machine axis in the control, and what it is told by its drive and encoders.

pub(super) mod enabling;
pub(super) mod limits;
pub(super) mod parameter_sets;
pub(super) mod position_control;
pub(super) mod signals;

use serde::{Deserialize, Serialize};

use crate::motion::{EncoderSignal, Limits, Setpoint};
use crate::sinumerik::axis::enabling::{Control, Enabling};
use crate::sinumerik::axis::limits::LimitSwitches;
use crate::sinumerik::axis::position_control::Shaping;
use crate::sinumerik::axis::signals::AxisSignals;
use crate::sinumerik::jog::increments::Jogging;
use crate::sinumerik::monitoring::AxisMonitor;
use crate::sinumerik::parameters::AxisParameters;
use crate::sinumerik::parameters::dynamics::ParameterSet;
use crate::sinumerik::referencing::approach::Approach;
use crate::units::Position;
use crate::variables::{EventId, Input};

/// What drive and encoders tell in one cycle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Feedback {
    /// Encoder 1 and 2.
    pub encoders: [EncoderSignal; 2],
    /// Half a count of each: the largest deviation that position control cannot see.
    pub half_count: [Position; 2],
    /// Velocity at the motor, in increments per second.
    pub velocity: f64,
    /// The drive has run up, and has no fault.
    pub drive_ready: bool,
    /// The drive tells of a fault.
    pub drive_fault: bool,
    /// Which encoder tells nothing.
    pub encoder_faults: [bool; 2],
    /// True position of the slide, which only the display of the simulator knows.
    pub slide: Position,
}

/// What an axis is commanded to do in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) enum Motion {
    /// Brake to rest.
    Brake {
        /// In increments per second squared.
        deceleration: f64,
    },
    /// Move at a velocity.
    Run {
        /// Signed, in increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Move to a position.
    GoTo {
        /// Where.
        target: Position,
        /// In increments per second.
        velocity: f64,
        /// In increments per second squared.
        acceleration: f64,
    },
    /// Follow-up: the setpoint is the actual value.
    Track,
    /// The setpoint stays.
    Hold,
}

impl Motion {
    /// A movement that an override of 0 % holds.
    #[must_use]
    pub(super) fn is_held(&self) -> bool {
        match *self {
            Self::Run { velocity, .. } | Self::GoTo { velocity, .. } => velocity.abs() <= 0.0,
            Self::Brake { .. } | Self::Track | Self::Hold => false,
        }
    }

    /// One cycle of it on a setpoint; whether the target of a [`Motion::GoTo`] is reached and the setpoint rests on it.
    fn execute(self, setpoint: &mut Setpoint, actual: Position, parameters: &AxisParameters, cycle: f64) -> bool {
        match self {
            Self::Brake { deceleration } => setpoint.run(0.0, deceleration, cycle),
            Self::Run { velocity, acceleration } => setpoint.run(velocity, acceleration, cycle),
            Self::GoTo { target, velocity, acceleration } if velocity > 0.0 => {
                return setpoint.go_to(target, Limits { velocity, acceleration }, cycle);
            }
            Self::GoTo { .. } => setpoint.run(0.0, parameters.maximum_acceleration, cycle),
            Self::Track => *setpoint = Setpoint::at(actual),
            Self::Hold => *setpoint = Setpoint::at(setpoint.position),
        }
        false
    }

    /// It passes the jerk filter by: a braking harder than any acceleration of the axis, or no movement at all.
    pub(super) fn is_fast(self, parameters: &AxisParameters) -> bool {
        match self {
            Self::Brake { deceleration } => deceleration > parameters.dynamics.jerk.hardest,
            Self::Track | Self::Hold => true,
            Self::Run { .. } | Self::GoTo { .. } => false,
        }
    }

    /// The acceleration with which it sets off.
    fn acceleration(self) -> Option<f64> {
        match self {
            Self::Run { acceleration, .. } | Self::GoTo { acceleration, .. } => Some(acceleration),
            Self::Brake { .. } | Self::Track | Self::Hold => None,
        }
    }

    /// The direction that is commanded: +1, −1, or 0.
    #[must_use]
    pub(super) fn direction(&self, from: Position) -> i8 {
        let sign = match *self {
            Self::Run { velocity, .. } => velocity,
            Self::GoTo { target, velocity, .. } if velocity > 0.0 => (target - from).increments() as f64,
            Self::GoTo { .. } | Self::Brake { .. } | Self::Track | Self::Hold => 0.0,
        };
        if sign > 0.0 {
            1
        } else if sign < 0.0 {
            -1
        } else {
            0
        }
    }
}

/// The events behind the signals of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Causes {
    /// 93.5, 93.7.
    pub drive: EventId,
    /// 61.3, 61.5 to 61.7.
    pub enabling: EventId,
    /// 102.5, 102.6.
    pub measuring_system: EventId,
    /// 60.4, 60.5.
    pub reference: [EventId; 2],
    /// 64.4 to 64.7.
    pub motion: EventId,
    /// 69.0 to 69.2.
    pub parameter_set: EventId,
    /// 93.0 to 93.4.
    pub drive_data_set: EventId,
}

/// One machine axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Axis {
    /// Where it is to be.
    pub setpoint: Setpoint,
    /// The setpoint before this cycle, from which it is finely interpolated.
    pub before: Position,
    /// What this cycle commands.
    pub motion: Motion,
    /// Counts the cycles in which a filter or delay of its setpoint has not run out.
    pub unsettled: u32,
    /// How far position control's setpoint is behind the one of the interpolator, in increments, and the velocity that is fed
    /// forward, in the last position-control cycle.
    pub branch: (f64, f64),
    /// The active parameter set, 0 to 5.
    pub parameter_set: u8,
    /// The data set that its drive has taken.
    pub drive_data_set: u8,
    /// The target of a [`Motion::GoTo`] is reached, and the setpoint rests on it.
    pub arrived: bool,
    /// Actual value minus encoder value, of each measuring system.
    pub offset: [Position; 2],
    /// Which measuring system is referenced.
    pub referenced: [bool; 2],
    /// Which measuring system is active, 0 or 1; without one the axis is parked.
    pub measuring_system: Option<u8>,
    /// Actual value in the machine coordinate system.
    pub actual: Position,
    /// The zero mark passed in the last cycle, as an actual value.
    pub zero_mark: Option<Position>,
    /// Actual velocity.
    pub velocity: f64,
    /// Half a count of the active encoder.
    pub half_count: Position,
    /// True position, for display.
    pub slide: Position,
    /// The drive has run up.
    pub drive_ready: bool,
    /// The way to position control and back.
    pub enabling: Enabling,
    /// Reference point approach.
    pub approach: Approach,
    /// A traversing key started an approach and has not been released since.
    pub key_used: bool,
    /// Direction of the key that started the approach; 0 for channel-specific referencing.
    pub approach_key: i8,
    /// Motion wanted, 64.4 and 64.5: +1, −1 or 0.
    pub traverse_request: i8,
    /// Motion commanded, 64.6 and 64.7: +1, −1 or 0.
    pub traverse_command: i8,
    /// Factor of the axial override.
    pub feed_factor: f64,
    /// Feed stop on an axis of its unit, or feed disable of its channel.
    pub feed_held: bool,
    /// Feed disable of its channel.
    pub feed_disabled: bool,
    /// The signal that holds it, of itself or of another axis of its unit.
    pub feed_holder: Input,
    /// Hardware limit switches.
    pub(super) limits: LimitSwitches,
    /// What monitoring remembers.
    pub monitor: AxisMonitor,
    /// What keys and handwheels do.
    pub(super) jogging: Jogging,
    /// Axis disable, ramp-function generator fast stop, delete distance-to-go.
    pub(super) signals: AxisSignals,
    /// Why.
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
            parameter_set: 0,
            drive_data_set: 0,
            arrived: false,
            offset: [Position::ZERO; 2],
            referenced: [false; 2],
            measuring_system: None,
            actual: Position::ZERO,
            zero_mark: None,
            velocity: 0.0,
            half_count: Position::ZERO,
            slide: Position::ZERO,
            drive_ready: false,
            enabling: Enabling::default(),
            approach: Approach::default(),
            key_used: false,
            approach_key: 0,
            traverse_request: 0,
            traverse_command: 0,
            feed_factor: 1.0,
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
    /// Takes what drive and encoders tell.
    pub(super) fn sense(&mut self, feedback: &Feedback) {
        self.velocity = feedback.velocity;
        self.slide = feedback.slide;
        self.drive_ready = feedback.drive_ready;
        if let Some(active) = self.measuring_system {
            let active = usize::from(active);
            let encoder = feedback.encoders[active];
            self.half_count = feedback.half_count[active];
            self.actual = encoder.value + self.offset[active];
            self.zero_mark = encoder.zero_mark.map(|mark| mark + self.offset[active]);
        }
    }

    /// The active measuring system is referenced.
    #[must_use]
    pub(super) fn is_referenced(&self) -> bool {
        self.measuring_system.is_some_and(|active| self.referenced[usize::from(active)])
    }

    /// What it has once per parameter set, of the active one.
    #[must_use]
    pub(super) fn active_set<'a>(&self, parameters: &'a AxisParameters) -> &'a ParameterSet {
        &parameters.dynamics.sets[usize::from(self.parameter_set)]
    }

    /// Setpoint minus actual value; with axis disable, the setpoint that position control holds.
    #[must_use]
    pub(super) fn deviation(&self) -> Position {
        self.signals.disabled_at().unwrap_or(self.setpoint.position) - self.actual
    }

    /// The setpoint rests and the velocity is below MD36060.
    #[must_use]
    pub(super) fn stands(&self, parameters: &AxisParameters) -> bool {
        self.setpoint.is_at_rest() && self.velocity.abs() < parameters.standstill_velocity
    }

    /// The axis moves or is to move.
    #[must_use]
    pub(super) fn is_in_motion(&self) -> bool {
        self.traverse_command != 0 || !self.setpoint.is_at_rest()
    }

    /// Gives the place where it is another actual value: nothing moves.
    pub(super) fn shift(&mut self, by: Position) {
        if let Some(active) = self.measuring_system {
            self.offset[usize::from(active)] += by;
            self.actual += by;
            self.setpoint.shift(by);
            self.monitor.shift(by);
            self.signals.shift(by);
        }
    }

    /// Executes what the cycle commands, through the filters that the axis has.
    pub(super) fn execute(&mut self, shaping: Option<&mut Shaping>, parameters: &AxisParameters, cycle: f64) {
        let (motion, actual) = (self.motion, self.actual);
        let command = |setpoint: &mut Setpoint| motion.execute(setpoint, actual, parameters, cycle);
        let Some(filter) = shaping.and_then(|shaping| shaping.jerk.as_mut()) else {
            self.arrived = command(&mut self.setpoint);
            return;
        };
        // What takes the axis out of its movement does not wait for a filter.
        let fast = matches!(self.enabling.control, Control::Braking(_)) || motion.is_fast(parameters);
        let first = motion.acceleration().map(|rate| parameters.dynamics.jerk.window_for(rate, cycle));
        self.arrived = filter.step(&mut self.setpoint, first, fast, cycle, command);
        self.unsettled = self.unsettled.wrapping_add(u32::from(filter.is_busy()));
    }
}
