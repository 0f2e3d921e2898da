//! Gear stages: M41 to M45, and M40 with S (MD35010).
//!
//! | step | signals |
//! |---|---|
//! | a program wants another stage than 16.0 to 16.2 | 82.0 to 82.2 the wanted stage, 82.3 = 1; the spindle brakes, motion and block change wait |
//! | 18.5 = 1 and the spindle stands | 84.6: it oscillates with MD35400 and MD35410, for the times MD35440 and MD35450, or in the directions 18.6 and 18.7 while 18.4 = 1 |
//! | 16.3 = 1 with the actual stage in 16.0 to 16.2 | 82.3 = 0, the spindle turns on with the data of that stage; 22010 if it is not the wanted one |
//!
//! With MD35010 bit 3 the control changes the stage itself when the spindle stands. Without a change the actual stage is that of 16.0 to 16.2, and
//! stage 1 while they are 0. RESET waits for the end of a change, at most MD10192; then 16938 is raised, and the change is aborted.

use crate::image::{AxisToNck, ToNck, axis_from_nck, axis_to_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms;
use crate::sinumerik::alarms::programs::GEAR_CHANGE_TOO_LONG;
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::{axis_number, axis_signal};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::spindle::{GEAR_STAGES, REVOLUTION_PER_MINUTE, SpindleParameters};
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::{GearChange, Mode, Spindle};
use crate::sinumerik::state::{State, Unit};
use crate::units::AxisNumber;
use crate::variables::{EventId, Input, Parameter, Place};

impl Spindle {
    /// M40 to M45, and S while M40 is active. Returns whether another stage is wanted.
    pub(in crate::sinumerik) fn want_stage(&mut self, m: Option<u16>, own: &SpindleParameters) -> bool {
        match m {
            Some(40) => self.is_automatic = true,
            Some(stage @ 41..=45) => {
                self.is_automatic = false;
                self.wanted_stage = u8::try_from(stage - 40).unwrap_or(1);
            }
            Some(_) | None => {}
        }
        if self.is_automatic && self.speed > 0.0 {
            self.wanted_stage = own.stage_for(self.speed * REVOLUTION_PER_MINUTE, self.gear_stage.max(1));
        }
        self.wanted_stage != 0 && self.wanted_stage != self.gear_stage.max(1)
    }
}

impl SpindleParameters {
    /// The stage that M40 takes for a speed: the present one if the speed is within MD35120 and MD35110, else the lowest one that has it, else
    /// the nearest.
    fn stage_for(&self, speed: f64, present: u8) -> u8 {
        let has = |number: u8| {
            let [lowest, highest] = self.stage(number).automatic;
            (lowest..=highest).contains(&speed)
        };
        let mut stages = 1..=self.stage_count.max(1);
        if has(present) {
            return present;
        }
        let found = stages.clone().find(|number| has(*number));
        found
            .or_else(|| stages.find(|number| speed <= self.stage(*number).automatic[1]))
            .unwrap_or_else(|| self.stage_count.max(1))
    }
}

impl State {
    /// A program wants a stage: the change begins with this event.
    pub(in crate::sinumerik) fn begin_gear_change(&mut self, number: AxisNumber, event: EventId) {
        if let Some(spindle) = self.spindles[number].as_deref_mut()
            && spindle.change.is_none()
        {
            spindle.change = Some(GearChange { oscillation: None, waited: 0 });
            (spindle.gear_cause, spindle.is_new) = (event, true);
        }
    }

    /// Reads the answer of the PLC. Without a change the actual stage is that of the PLC.
    pub(super) fn follow_gear(
        &mut self,
        number: AxisNumber,
        own: &SpindleParameters,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) {
        let signals = &to_nck.axes[number];
        let stands = self.axes[number].stands(&parameters.axes[number]);
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        let actual = signals.actual_gear_stage();
        if spindle.change.is_none() {
            if (1..=GEAR_STAGES).contains(&actual)
                && own.has_stages
                && let Some(spindle) = self.spindles[number].as_deref_mut()
            {
                spindle.gear_stage = actual;
            }
            return;
        }
        let simulated = own.simulates_change && stands;
        if !signals.gear_stage_changed() && !simulated {
            return;
        }
        let reached = if simulated { spindle.wanted_stage } else { actual };
        let place = Place::Axis(number);
        let inputs = if simulated {
            [axis_signal(number, axis_from_nck::axis_stationary, true), Input::None, Input::None]
        } else {
            [
                axis_signal(number, axis_to_nck::gear_stage_changed, true),
                axis_number(number, axis_to_nck::actual_gear_stage, actual),
                Input::None,
            ]
        };
        let event = self.log.note(place, Rule::GearStageChanged, inputs, spindle.gear_cause);
        if reached != spindle.wanted_stage {
            let wanted = axis_number(number, axis_from_nck::setpoint_gear_stage, spindle.wanted_stage);
            let event = self.log.note(place, Rule::GearStageDiffers, [wanted, inputs[1], Input::None], event);
            self.raise_axis_alarm(alarms::GEAR_STAGE_DIFFERS, number, event);
        }
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            (spindle.gear_stage, spindle.change) = (reached.clamp(1, GEAR_STAGES), None);
            (spindle.gear_cause, spindle.cause) = (event, event);
        }
    }

    /// One cycle of a spindle whose stage is being changed: it brakes, or oscillates.
    pub(super) fn run_gear_change(
        &mut self,
        unit: &Unit,
        change: GearChange,
        own: &SpindleParameters,
        (parameters, to_nck): (&Parameters, &ToNck),
    ) {
        let number = unit.leader();
        let signals = &to_nck.axes[number];
        let may = signals.oscillation_enable() && self.axes[number].enabling.is_on() && !signals.feed_stop();
        let stands = self.axes[number].stands(&parameters.axes[number]);
        let before = change.oscillation;
        let oscillation = if may { own.next_oscillation(before, stands) } else { None };
        let direction = match oscillation {
            None => 0,
            Some(_) if signals.oscillation_by_plc() => plc_direction(signals),
            Some((direction, _)) => direction,
        };
        let velocity = own.oscillation_speed * f64::from(direction);
        let stage = own.stage(self.spindles[number].as_deref().map_or(1, |spindle| spindle.gear_stage));
        let acceleration = if oscillation.is_some() { own.oscillation_acceleration } else { stage.acceleration };
        self.axes[number].motion = Motion::Run { velocity, acceleration };
        let Some(spindle) = self.spindles[number].as_deref().copied() else { return };
        let cause = if before.is_some() == oscillation.is_some() {
            spindle.oscillation_cause
        } else {
            let enable = axis_signal(number, axis_to_nck::oscillation_enable, signals.oscillation_enable());
            self.log.note_one(Place::Axis(number), Rule::Oscillation, enable, spindle.gear_cause)
        };
        let travel = Travel::moving(direction);
        if self.axes[number].travel != travel {
            let [cw, ccw] = [axis_to_nck::oscillation_clockwise, axis_to_nck::oscillation_counterclockwise];
            let by_plc = signals.oscillation_by_plc();
            let shown = |signal, value| if by_plc { axis_signal(number, signal, value) } else { Input::None };
            let inputs = [
                axis_signal(number, axis_to_nck::oscillation_by_plc, by_plc),
                shown(cw, signals.oscillation_clockwise()),
                shown(ccw, signals.oscillation_counterclockwise()),
            ];
            let rule =
                if direction == 0 && oscillation.is_none() { Rule::GearChangeStops } else { Rule::OscillationTurns };
            let event = self.log.now(Place::Axis(number), cause.max(spindle.gear_cause), rule, inputs);
            self.travel(number, travel, event);
        }
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            spindle.change = Some(GearChange { oscillation, ..change });
            spindle.holder = Input::None;
            (spindle.oscillation_cause, spindle.commanded, spindle.is_new) = (cause, velocity, false);
            if (spindle.limited, spindle.raised) != (false, false) {
                (spindle.limited, spindle.raised, spindle.limit_cause) = (false, false, spindle.gear_cause);
            }
        }
    }

    /// Whether a spindle of a channel changes its gear stage.
    pub(in crate::sinumerik) fn gear_changing(&self, stage: &Stage<'_>) -> Option<AxisNumber> {
        let changes =
            |axis: &AxisNumber| self.spindles[*axis].as_deref().is_some_and(|spindle| spindle.change.is_some());
        stage.own.spindles.iter().map(|(_, axis)| *axis).find(changes)
    }

    /// RESET waits for the end of a gear change, and aborts it after MD10192 with 16938. Returns whether it still waits.
    pub(in crate::sinumerik) fn reset_waits_for_gear(&mut self, stage: &Stage<'_>, reset: EventId) -> bool {
        let Some(number) = self.gear_changing(stage) else { return false };
        let limit = stage.parameters.axes[number].spindle.as_deref().map_or(0, |own| own.change_wait_cycles);
        let Some(spindle) = self.spindles[number].as_deref_mut() else { return false };
        let Some(change) = spindle.change.as_mut() else { return false };
        change.waited += 1;
        if change.waited <= limit {
            return true;
        }
        let seconds = stage.parameters.cycle.seconds() * limit as f64;
        let datum = Input::Datum(10192, None, seconds);
        let event = self.log.note_one(Place::Channel(stage.channel), Rule::GearChangeTooLong, datum, reset);
        let shown = [Parameter::Channel(stage.channel), Parameter::None, Parameter::None, Parameter::None];
        self.alarms.raise(GEAR_CHANGE_TOO_LONG, Place::Channel(stage.channel), shown, event);
        if let Some(spindle) = self.spindles[number].as_deref_mut() {
            (spindle.change, spindle.gear_cause, spindle.wanted_stage) = (None, event, spindle.gear_stage.max(1));
        }
        false
    }
}

/// The direction of oscillation that the PLC gives.
fn plc_direction(signals: &AxisToNck) -> i8 {
    match (signals.oscillation_clockwise(), signals.oscillation_counterclockwise()) {
        (true, false) => 1,
        (false, true) => -1,
        (true, true) | (false, false) => 0,
    }
}

impl Spindle {
    /// 84.6.
    pub(in crate::sinumerik) fn oscillates(&self) -> bool {
        let by_change = self.change.is_some_and(|change| change.oscillation.is_some());
        self.mode == Mode::Control && (by_change || self.plc_oscillation.is_some())
    }
}
