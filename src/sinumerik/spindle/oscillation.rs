//! Oscillation of a spindle by the PLC (FC 18, function 3): with MD35400 and MD35410, for the times MD35440 and MD35450 in each direction.

use crate::image::{ToNck, axis_from_nck};
use crate::motion::Motion;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::spindle::SpindleParameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{Input, Place};

impl State {
    /// One cycle of a spindle that the PLC lets oscillate: it brakes first, and what holds a spindle holds the oscillation.
    pub(super) fn run_plc_oscillation(
        &mut self,
        unit: &Unit,
        own: &SpindleParameters,
        (parameters, to_nck): (&Parameters, &ToNck),
    ) {
        let number = unit.leader();
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        let holder = self.spindle_holder(unit, &spindle, own, to_nck);
        let stands = self.axes[number].stands(&parameters.axes[number]);
        let before = spindle.plc_oscillation;
        let oscillation = match before {
            _ if holder.is_some() => None,
            None if !stands => None,
            None => Some(own.first_oscillation()),
            Some(present) => Some(own.next_oscillation(present)),
        };
        let direction = oscillation.map_or(0, |(direction, _)| direction);
        let velocity = own.oscillation_speed * f64::from(direction);
        let acceleration = if oscillation.is_some() {
            own.oscillation_acceleration
        } else {
            own.stage(spindle.gear_stage).acceleration
        };
        self.axes[number].motion = Motion::Run { velocity, acceleration };
        let travel = Travel::moving(direction);
        let shown = axis_signal(number, axis_from_nck::positioning_active, true);
        if self.axes[number].travel != travel {
            let (rule, input) = holder.unwrap_or((Rule::OscillationTurns, shown));
            let event = self.log.now(Place::Axis(number), spindle.cause, rule, [input, Input::None, Input::None]);
            self.travel(number, travel, event);
        }
        let cause = if before.is_some() == oscillation.is_some() {
            spindle.oscillation_cause
        } else {
            self.log.note_one(Place::Axis(number), Rule::Oscillation, shown, spindle.cause)
        };
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            (spindle.plc_oscillation, spindle.oscillation_cause) = (oscillation, cause);
            (spindle.commanded, spindle.is_new, spindle.limited, spindle.raised) = (velocity, false, false, false);
            spindle.holder = holder.map_or(Input::None, |(_, input)| input);
        }
    }

    /// The PLC does not let a spindle oscillate any more.
    pub(super) fn end_plc_oscillation(&mut self, number: AxisNumber) {
        if let Some(spindle) = self.spindles[number].as_deref_mut()
            && spindle.plc_oscillation.take().is_some()
        {
            spindle.oscillation_cause = spindle.cause;
        }
    }
}
