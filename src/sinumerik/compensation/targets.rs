//! What the compensation values of an axis should be in this cycle.

use crate::sinumerik::axis::state::Axis;
use crate::sinumerik::compensation::state::Compensation;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};

impl State {
    /// Whether sag and temperature compensation of an axis act: a gantry axis is synchronised, another axis is referenced (MIS-08).
    pub(super) fn setpoint_is_compensated(&self, number: AxisNumber) -> bool {
        let of = |axis: AxisNumber| {
            self.groupings.iter().find(|grouping| grouping.coupling.members().any(|member| member == axis))
        };
        of(number).map_or_else(|| self.axes[number].is_referenced(), |grouping| grouping.phase == Phase::Synchronised)
    }

    /// The sum of all tables with this output axis, in increments.
    pub(super) fn sag_of(&self, number: AxisNumber, parameters: &Parameters) -> f64 {
        let acting = parameters.sag.relations.iter().filter(|relation| {
            let direction = self.axes[relation.input].compensation.direction;
            relation.output == number
                && self.setpoint_is_compensated(relation.input)
                && (relation.direction == 0 || relation.direction == direction)
        });
        let values = acting.map(|relation| {
            let own = relation.table.at(self.axes[relation.input].setpoint.position) * relation.weight;
            match &relation.factor {
                None => own,
                Some((input, weight, table)) => {
                    // A value of 1 mm is the factor 1.
                    own * (table.at(self.axes[*input].setpoint.position) * weight / Position::PER_USER_UNIT)
                }
            }
        });
        values.sum()
    }
}

/// Temperature: SD43900 + SD43910 · (P − SD43920), in increments.
pub(super) fn temperature_of(axis: &Axis, parameters: &AxisParameters) -> f64 {
    parameters.compensation.temperature.map_or(0.0, |temperature| {
        let distance = (axis.setpoint.position - temperature.reference).increments() as f64;
        temperature.absolute + temperature.slope * distance
    })
}

/// Leadscrew error and backlash of an encoder that is referenced, in increments.
pub(super) fn encoder_error(
    axis: &Axis,
    compensation: &Compensation,
    encoder: usize,
    measured: Position,
    parameters: &AxisParameters,
) -> i64 {
    let own = &parameters.compensation;
    let leadscrew = own.leadscrew[encoder].as_ref().map_or(0.0, |table| table.at(measured));
    let reference = compensation.reference_direction[encoder];
    let side = compensation.direction;
    // Positive: the encoder leads the slide, so that it counts too much before the slide follows.
    let backlash = if side == 0 || side == reference {
        0.0
    } else {
        f64::from(reference) * own.backlash[encoder][usize::from(axis.parameter_set)]
    };
    #[expect(clippy::cast_possible_truncation, reason = "values of tables are bounded; the cast saturates")]
    let sum = (leadscrew + backlash).round() as i64;
    sum
}
