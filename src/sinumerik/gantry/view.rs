//! The data that a grouping reads from the rest of the control, and its requests to it.
//!
//! A grouping decides with a [`View`] and returns [`Wants`]; `grouping.rs` executes them in their order. The grouping itself
//! changes only its own phase, its coupling and the log of events.

use arrayvec::ArrayVec;

use crate::motion::Motion;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::exchange::state::Owners;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::Kind;
use crate::sinumerik::parameters::groupings::SYNCHRONOUS_AXES;
use crate::units::{AxisNumber, PerAxis};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place};

/// The data that a grouping reads.
#[derive(Clone, Copy)]
pub(in crate::sinumerik) struct View<'a> {
    pub axes: &'a PerAxis<Axis>,
    pub owners: &'a Owners,
    pub parameters: &'a Parameters,
}

impl View<'_> {
    /// Whether a new approach leaves the reference of an axis: an absolute encoder keeps it.
    pub(in crate::sinumerik) fn keeps_reference(&self, number: AxisNumber) -> bool {
        let encoder = usize::from(self.axes[number].measuring_system.unwrap_or(0));
        self.parameters.axes[number].reference.kind[encoder] == Kind::Absolute
    }
}

/// Whether a synchronising motion is permitted.
#[derive(Clone, Copy, Debug)]
pub(in crate::sinumerik) struct Permit {
    /// REF is active, every axis is in position control, and nothing stops or limits an axis.
    pub granted: bool,
    /// The reason if not: the tested input, and the event behind it.
    pub hindrance: (Input, EventId),
}

/// A request of a grouping.
#[derive(Clone, Copy, Debug)]
pub(in crate::sinumerik) enum Want {
    /// An axis moves, with its travel request and travel command, and the event that started the movement.
    Move { axis: AxisNumber, motion: Motion, travel: Travel, cause: EventId },
    /// The travel request and the travel command of an axis end.
    Rest { axis: AxisNumber, cause: EventId },
    /// A reference point approach starts in the direction of a sign; whether the axis `keeps` its reference.
    StartApproach { axis: AxisNumber, direction: f64, keeps: bool, cause: EventId },
    /// A reference point approach ends.
    AbortApproach(AxisNumber),
    /// An axis takes the setpoint of another axis without interpolation.
    TakeSetpoint { axis: AxisNumber, of: AxisNumber },
    /// An alarm of an axis: `%1` channel, `%2` axis.
    RaiseOfAxis { alarm: AlarmNumber, axis: AxisNumber, cause: EventId },
    /// An alarm with its own parameters.
    Raise { alarm: AlarmNumber, place: Place, shown: [Parameter; 4], cause: EventId },
}

/// The largest number of requests at a time: a movement and its end for each axis, and an alarm.
const MOST: usize = 2 * (1 + SYNCHRONOUS_AXES) + 1;

/// The requests of a grouping, in this order.
pub(in crate::sinumerik) type Wants = ArrayVec<Want, MOST>;
