//! What a grouping reads of the rest of the control, and what it wants from it.
//!
//! A grouping decides with a [`View`] and returns [`Wants`]; `grouping.rs` carries them out in their order. Its own phase, its
//! coupling and the log of events are the only things that it changes itself.

use arrayvec::ArrayVec;

use crate::motion::Motion;
use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::groupings::SYNCHRONOUS_AXES;
use crate::units::{AxisNumber, PerAxis};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place};

/// What a grouping reads.
#[derive(Clone, Copy)]
pub(in crate::sinumerik) struct View<'a> {
    pub axes: &'a PerAxis<Axis>,
    pub parameters: &'a Parameters,
}

/// What the rest of the control says to a synchronising motion.
#[derive(Clone, Copy, Debug)]
pub(in crate::sinumerik) struct Permit {
    /// REF is active, every axis is in position control, and nothing stops or limits one.
    pub granted: bool,
    /// Why not: what was tested, and the event behind it.
    pub hindrance: (Input, EventId),
}

/// One thing that a grouping wants.
#[derive(Clone, Copy, Debug)]
pub(in crate::sinumerik) enum Want {
    /// An axis moves: the travel request and the travel command that show it, and the event that began it.
    Move { axis: AxisNumber, motion: Motion, request: i8, command: i8, cause: EventId },
    /// An axis has no travel request and no travel command any more.
    Rest { axis: AxisNumber, cause: EventId },
    /// A reference point approach starts in the direction of a sign.
    StartApproach { axis: AxisNumber, direction: f64, cause: EventId },
    /// A reference point approach ends.
    AbortApproach(AxisNumber),
    /// An axis gets the setpoint of another one without interpolation.
    TakeSetpoint { axis: AxisNumber, of: AxisNumber },
    /// An alarm of an axis: `%1` channel, `%2` axis.
    RaiseOfAxis { alarm: AlarmNumber, axis: AxisNumber, cause: EventId },
    /// An alarm with its own parameters.
    Raise { alarm: AlarmNumber, place: Place, shown: [Parameter; 4], cause: EventId },
}

/// What a grouping wants at most at once: a movement and its end for each axis, and an alarm.
const MOST: usize = 2 * (1 + SYNCHRONOUS_AXES) + 1;

/// What a grouping wants, in this order.
pub(in crate::sinumerik) type Wants = ArrayVec<Want, MOST>;
