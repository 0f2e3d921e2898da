//! The stage: the signals of this cycle, after the setpoints of the axes.

use crate::image::{ToNck, axis_from_nck, axis_to_nck, mode_group_from_nck};
use crate::sinumerik::function_generator::state::{Generator, Phase};
use crate::sinumerik::inputs::{axis_signal, mode_group_signal};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, AxisSet, Position};
use crate::variables::{EventId, Input, Place};

impl Nck {
    /// The stage.
    pub(in crate::sinumerik) fn generate_signals(&mut self, to_nck: &ToNck) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        let axes = state.generating();
        if axes.is_empty() {
            return;
        }
        let mut generators = std::mem::take(&mut state.generators);
        for generator in &mut generators {
            if generator.axes.is_empty() {
                continue;
            }
            let unit = state.unit_of(generator.wanted.axis).filter(|unit| unit.set == generator.axes);
            match unit {
                Some(unit) => state.generate(generator, &unit, parameters, to_nck),
                None => state.drop_signal(generator),
            }
        }
        state.generators = generators;
        self.resting.hear_all(axes);
    }
}

impl State {
    /// The axes that a signal moves or is to move.
    pub(in crate::sinumerik) fn generating(&self) -> AxisSet {
        self.generators.iter().flat_map(|one| one.axes.iter()).collect()
    }

    fn generate(&mut self, generator: &mut Generator, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) {
        if generator.phase != Phase::Returns
            && let Some((rule, input, parent)) = self.generator_stops(generator, unit, parameters, to_nck)
        {
            let parent = if parent.is_some() { parent } else { generator.cause };
            generator.cause = self.log.note_one(Place::Axis(unit.leader()), rule, input, parent);
            generator.phase = Phase::Returns;
        }
        // The PLC sees 61.0 at least for one cycle.
        let asks = generator.phase == Phase::Requested && !self.log.is_of_this_cycle(generator.cause);
        if asks && unit.members().all(|axis| allows(to_nck, axis)) {
            for member in unit.members() {
                let input = axis_signal(member, axis_to_nck::drive_test_travel_enable, true);
                let parent = self.axes[member].test_travel.cause;
                let event = self.log.note_one(Place::Axis(member), Rule::GeneratorMoves, input, parent);
                let travel = &mut self.axes[member].test_travel;
                (travel.moves, travel.cause) = (true, event);
            }
            (generator.phase, generator.cause) = (Phase::Runs(0), self.axes[unit.leader()].test_travel.cause);
        }
        let powered = |axis: AxisNumber| self.axes[axis].enabling.moves() && !self.axes[axis].signals.fast_stop;
        let shares = match &mut generator.phase {
            Phase::Runs(cycles) => {
                *cycles += 1;
                let wanted = &generator.wanted;
                let time = *cycles as f64 * parameters.cycle.seconds();
                let signal = wanted.signal.value(time * wanted.frequency);
                wanted.amplitude.map(|amplitude| Position::from_user(wanted.offset + amplitude * signal))
            }
            Phase::Set | Phase::Requested | Phase::Returns => [Position::ZERO; 2],
        };
        if !unit.members().all(powered) {
            // Without position control the setpoint is where the axis is.
            for member in unit.members() {
                self.axes[member].test_travel.offset = Position::ZERO;
            }
        } else {
            self.add_signal(unit, shares, parameters, to_nck);
        }
        let returned = unit.members().all(|axis| self.axes[axis].test_travel.offset == Position::ZERO);
        if generator.phase == Phase::Returns && returned {
            self.end_signal(generator);
        }
    }

    /// The grouping was opened or closed: the setpoints stay where they are.
    fn drop_signal(&mut self, generator: &mut Generator) {
        let place = Place::Axis(generator.wanted.axis);
        generator.cause = self.log.note_plain(place, Rule::GeneratorStops, generator.cause);
        for number in generator.axes.iter() {
            self.axes[number].test_travel.offset = Position::ZERO;
        }
        self.end_signal(generator);
    }

    fn end_signal(&mut self, generator: &mut Generator) {
        for number in generator.axes.iter() {
            let event = self.log.note_plain(Place::Axis(number), Rule::GeneratorRests, generator.cause);
            let travel = &mut self.axes[number].test_travel;
            (travel.requested, travel.moves, travel.cause) = (false, false, event);
        }
        (generator.phase, generator.axes) = (Phase::Set, AxisSet::NONE);
    }

    /// Moves the setpoints to the signal, at most at MD32000 of the slowest axis, and within the software limits of the leading axis.
    fn add_signal(&mut self, unit: &Unit, wanted: [Position; 2], parameters: &Parameters, to_nck: &ToNck) {
        let leader = unit.leader();
        let within = self.signal_within_limits(leader, wanted[0], parameters, to_nck);
        let velocity = unit.members().map(|axis| parameters.axes[axis].maximum_velocity).fold(f64::INFINITY, f64::min);
        #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
        let most = (velocity * parameters.cycle.seconds()) as i64;
        for member in unit.members() {
            let goal = match wanted[0].increments() {
                _ if member == leader => within,
                0 => wanted[1],
                // The coupled axes stand still with it.
                #[expect(clippy::cast_possible_truncation, reason = "a part of a distance")]
                whole => {
                    let part = within.increments() as f64 / whole as f64;
                    Position::new((wanted[1].increments() as f64 * part).round() as i64)
                }
            };
            let axis = &mut self.axes[member];
            let way = (goal - axis.test_travel.offset).increments().clamp(-most.max(1), most.max(1));
            axis.setpoint.shift(Position::new(way));
            axis.test_travel.offset += Position::new(way);
        }
    }

    /// The signal with which the axis stays within its software limits; one that leads back is allowed.
    fn signal_within_limits(
        &self,
        number: AxisNumber,
        wanted: Position,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Position {
        let axis = &self.axes[number];
        let now = axis.test_travel.offset;
        let base = axis.machine_setpoint() - now;
        let limit = |direction| Some(self.software_limit(number, direction, parameters, to_nck)? - base);
        let wanted = limit(1).map_or(wanted, |most| wanted.min(most.max(now.min(wanted))));
        limit(-1).map_or(wanted, |least| wanted.max(least.min(now.max(wanted))))
    }

    /// What ends a signal: the rule, what was tested, the event behind it.
    fn generator_stops(
        &self,
        generator: &Generator,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> Option<(Rule, Input, EventId)> {
        if let Some(stop) = self.stop(unit.channel, parameters) {
            let (rule, input) = stop.tested();
            return Some((rule, input, stop.cause()));
        }
        let stops = |input, event| Some((Rule::GeneratorStops, input, event));
        if let Some((input, event)) = self.on_limit_switch(unit) {
            return stops(input, event);
        }
        if self.mode_group(unit).mode != Mode::Jog {
            let jog = mode_group_signal(unit.mode_group, mode_group_from_nck::active_mode_jog, false);
            return stops(jog, self.mode_group(unit).mode_cause);
        }
        if let Some(input) = self.motion_forbidden(unit) {
            return stops(input, EventId::NONE);
        }
        if let Some(off) = unit.members().find(|&axis| !self.axes[axis].enabling.is_on()) {
            let input = axis_signal(off, axis_from_nck::position_controller_active, false);
            return stops(input, self.axes[off].causes.enabling);
        }
        let Phase::Runs(cycles) = generator.phase else { return None };
        if let Some(held) = unit.members().find(|&axis| !allows(to_nck, axis)) {
            return stops(axis_signal(held, axis_to_nck::drive_test_travel_enable, false), EventId::NONE);
        }
        let over = cycles >= generator.wanted.duration.in_cycles(parameters.cycle);
        over.then_some((Rule::GeneratorOver, Input::None, EventId::NONE))
    }
}

/// The PLC allows the travel: 1.0.
fn allows(to_nck: &ToNck, axis: AxisNumber) -> bool {
    to_nck.axes[axis].drive_test_travel_enable()
}
