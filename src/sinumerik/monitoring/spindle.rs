//! Speed monitoring of a spindle: 22100 above 110 % of MD35100, whatever turns the spindle.

use crate::sinumerik::alarms;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::spindle::REVOLUTION_PER_MINUTE;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{Input, Quantity};

/// The share of MD35100 above which the chuck speed counts as exceeded.
const CHUCK_SPEED: f64 = 1.1;

impl State {
    pub(in crate::sinumerik) fn monitor_spindle(&mut self, number: AxisNumber, parameters: &AxisParameters) {
        let Some(own) = parameters.spindle.as_deref() else { return };
        if self.axes[number].velocity.abs() > CHUCK_SPEED * own.speed_limit {
            let limit = Input::Datum(35100, Some(number), own.speed_limit / REVOLUTION_PER_MINUTE);
            let inputs = [self.axes[number].measured_velocity(number), limit, Input::None];
            let alarm = self.axis_alarm(alarms::CHUCK_SPEED, number);
            self.raise_new(alarm, Rule::ChuckSpeedExceeded, inputs, self.axes[number].causes.movement());
        }
    }
}

impl crate::sinumerik::axis::state::Axis {
    /// The actual velocity as an input.
    pub(in crate::sinumerik) fn measured_velocity(&self, number: AxisNumber) -> Input {
        #[expect(clippy::cast_possible_truncation, reason = "a velocity for display; the cast saturates")]
        let velocity = Position::new(self.velocity as i64);
        Input::Length(Quantity::Velocity, number, velocity)
    }
}
