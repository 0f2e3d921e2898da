//! Dynamic overload of a synchronous axis (10656): the leading axis demands more than the synchronous axis can do (O-05).
//!
//! Called for each synchronous axis that follows, directly after it received its setpoint. Compares the setpoint with the axis' own MD32000
//! and MD32300 (or MD32301 if it is larger, because its own keys may demand it). A strictly greater value raises the alarm (O-11). Braking
//! harder than any acceleration of the leading axis is a stop, which all axes make in the same way, not a movement of the grouping. It is
//! not compared.

use crate::sinumerik::alarms;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place, Quantity};

/// Setpoints are whole increments, so the velocity calculated from them may be larger by this factor.
const ROUNDING: f64 = 1.002;

impl State {
    /// Compares the new setpoint of the axis with its limits; `before` is its velocity in the last cycle.
    pub(in crate::sinumerik) fn watch_overload(&mut self, number: AxisNumber, before: f64, parameters: &Parameters) {
        let (axis, cycle) = (&parameters.axes[number], parameters.cycle.seconds());
        let velocity = self.axes[number].setpoint.velocity();
        let too_fast = velocity.abs() > axis.maximum_velocity * ROUNDING;
        let too_hard = (velocity - before).abs() > axis.dynamics.jerk.hardest * cycle * ROUNDING + 2.0 / cycle;
        let pending = self.alarms.is_pending(alarms::GANTRY_OVERLOADED, Place::Axis(number));
        if !(too_fast || too_hard) || pending {
            return;
        }
        let inputs = inputs(number, velocity, too_fast, axis);
        let cause = self.log.note(Place::Axis(number), Rule::Overloaded, inputs, EventId::NONE);
        self.raise_axis_alarm(alarms::GANTRY_OVERLOADED, number, cause);
    }
}

/// The demanded velocity and the machine datum that it exceeds, as entered by a user.
#[expect(clippy::cast_possible_truncation, reason = "far within the range")]
fn inputs(number: AxisNumber, velocity: f64, too_fast: bool, axis: &AxisParameters) -> [Input; 3] {
    let asked = Input::Length(Quantity::Velocity, number, Position::new(velocity.round() as i64));
    let turn = |linear: f64| Position::PER_USER_UNIT * if axis.rotary { 360.0 } else { linear };
    let entered = |value: f64| (value * 1e6).round() / 1e6;
    let (datum, limit) = if too_fast {
        (32000, axis.entered_velocity(axis.maximum_velocity))
    } else if axis.jog_acceleration > axis.maximum_acceleration {
        (32301, entered(axis.jog_acceleration / turn(1_000.0)))
    } else {
        (32300, entered(axis.maximum_acceleration / turn(1_000.0)))
    };
    [asked, Input::Datum(datum, Some(number), limit), Input::None]
}
