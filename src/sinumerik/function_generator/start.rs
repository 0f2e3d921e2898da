//! The command that gives a signal, and NC start in JOG.

use crate::control::FunctionGenerator;
use crate::image::axis_from_nck;
use crate::sinumerik::alarms;
use crate::sinumerik::function_generator::state::{Generator, Phase};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::source::Problem;
use crate::units::{AxisSet, ChannelNumber};
use crate::variables::{EventId, Input, Place};

/// The largest amplitude and offset, in millimetres or degrees.
const LARGEST: f64 = 1000.0;

impl Nck {
    /// Whether the function generator can have this signal. Whether its axis can have one is judged at NC start.
    pub(in crate::sinumerik) fn check_generator(&self, wanted: &FunctionGenerator) -> Result<(), Problem> {
        if !self.parameters.axes[wanted.axis].exists {
            let found = format!("expected a machine axis for the function generator, found axis {}", wanted.axis);
            return Err(Problem::new(found, "name an axis of the machine"));
        }
        for (what, value) in
            [("amplitude", wanted.amplitude[0]), ("amplitude", wanted.amplitude[1]), ("offset", wanted.offset)]
        {
            if !value.is_finite() || value.abs() > LARGEST {
                let found = format!("expected an {what} of at most {LARGEST} mm or degrees, found {value}");
                return Err(Problem::new(found, "the axis must stay within its position tolerance: write 0.1"));
            }
        }
        let most = 0.5 / self.parameters.cycle.seconds();
        if !wanted.frequency.is_finite() || wanted.frequency <= 0.0 || wanted.frequency > most {
            let found = format!("expected a frequency above 0 and of at most {most} Hz, found {}", wanted.frequency);
            return Err(Problem::new(found, "a period takes at least two interpolation cycles"));
        }
        Ok(())
    }

    /// The operator gives a signal for an axis. One that runs goes on as it is.
    pub(in crate::sinumerik) fn parameterise_generator(&mut self, wanted: FunctionGenerator) -> EventId {
        let state = &mut *self.state;
        let cause = state.log.note_plain(Place::Axis(wanted.axis), Rule::GeneratorSet, EventId::NONE);
        let known = state.generators.iter_mut().find(|one| one.wanted.axis == wanted.axis);
        let new = Generator { wanted, phase: Phase::Set, axes: AxisSet::NONE, cause };
        match known {
            Some(known) if known.phase == Phase::Set => *known = new,
            Some(_) => state.raise_axis_alarm(alarms::GENERATOR_NOT_POSSIBLE, wanted.axis, cause),
            None => state.generators.push(new),
        }
        self.wake_all();
        cause
    }
}

impl State {
    /// NC start in JOG: all signals of a channel start.
    pub(in crate::sinumerik) fn start_generators(
        &mut self,
        channel: ChannelNumber,
        parameters: &Parameters,
        pressed: Input,
    ) {
        let mut generators = std::mem::take(&mut self.generators);
        let mine = |one: &Generator| one.phase == Phase::Set && self.owners.of(one.wanted.axis).channel == channel;
        if !generators.iter().any(mine) {
            self.generators = generators;
            return;
        }
        if let Some(number) = self.start_is_locked(channel, parameters) {
            let inputs = [pressed, Input::Alarm(number.0), Input::None];
            self.refuse_start(channel, alarms::programs::ALARM_PENDING, Rule::StartHinderedByAlarm, inputs);
        } else {
            generators.retain_mut(|one| {
                let is_other = one.phase != Phase::Set || self.owners.of(one.wanted.axis).channel != channel;
                is_other || self.start_generator(one, parameters, pressed)
            });
        }
        self.generators = generators;
    }

    /// Starts a signal. Returns whether it is kept: one for a synchronous axis is not.
    fn start_generator(&mut self, generator: &mut Generator, parameters: &Parameters, pressed: Input) -> bool {
        let number = generator.wanted.axis;
        let place = Place::Axis(number);
        if parameters.axes[number].gantry_follower {
            let leads = axis_signal(number, axis_from_nck::gantry_leading_axis, false);
            let inputs = [pressed, axis_signal(number, axis_from_nck::gantry_axis, true), leads];
            let event = self.log.note(place, Rule::GeneratorSynchronous, inputs, generator.cause);
            self.raise_axis_alarm(alarms::GENERATOR_SYNCHRONOUS_AXIS, number, event);
            return false;
        }
        let Some(unit) = self.unit_of(number) else { return true };
        if let Some(hindered) = self.hinders_generator(&unit, parameters) {
            let inputs = [pressed, hindered, Input::None];
            let event = self.log.note(place, Rule::GeneratorRefused, inputs, generator.cause);
            self.raise_axis_alarm(alarms::GENERATOR_NOT_POSSIBLE, number, event);
            return true;
        }
        let mut cause = EventId::NONE;
        for member in unit.members() {
            let event = self.log.note_one(Place::Axis(member), Rule::GeneratorStarted, pressed, generator.cause);
            let travel = &mut self.axes[member].test_travel;
            (travel.requested, travel.cause) = (true, event);
            cause = if member == number { event } else { cause };
        }
        (generator.phase, generator.axes, generator.cause) = (Phase::Requested, unit.set, cause);
        true
    }

    /// Why a signal cannot start: what was tested.
    fn hinders_generator(&self, unit: &Unit, parameters: &Parameters) -> Option<Input> {
        if let Some(stop) = self.stop(unit.channel, parameters) {
            return Some(stop.tested().1);
        }
        if let Some(input) = self.motion_forbidden(unit) {
            return Some(input);
        }
        if let Some((input, _)) = self.on_limit_switch(unit) {
            return Some(input);
        }
        unit.members().find_map(|member| {
            let axis = &self.axes[member];
            if !axis.enabling.is_on() {
                return Some(axis_signal(member, axis_from_nck::position_controller_active, false));
            }
            let moves = axis.is_in_motion() || axis.approach.is_running();
            moves.then(|| axis.travel.shown(member, parameters))
        })
    }
}
