//! The path in a cycle: what holds it, where its axes are, and the axes that are positioned beside it.

use crate::image::{Signal, ToNck, axis_to_nck, channel_to_nck};
use crate::motion::path::{Feed, Overrides, Path, PerPathAxis};
use crate::sinumerik::axis::travel::Travel;
use crate::sinumerik::inputs::{axis_signal, channel_number};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::positioning::{AxisPositioning, Handwheel};
use crate::sinumerik::program::state::{Change, Led, ProgramState, Run, block_name};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{Input, Place};

/// What the stage reads in a cycle.
#[derive(Clone, Copy)]
pub(in crate::sinumerik) struct Stage<'a> {
    pub channel: ChannelNumber,
    pub parameters: &'a Parameters,
    pub own: &'a ProgramParameters,
    pub to_nck: &'a ToNck,
}

/// Whether the movements of a program may go on, and what holds them if not.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Held {
    No,
    /// By a signal or an alarm that ends by itself: the travel command stays (O-27).
    By(Rule, Input),
    /// By a stop: the program is stopped or is being stopped.
    Stopped,
}

impl State {
    /// Moves the axes of a program for one cycle. Returns how many blocks have ended on the path.
    pub(in crate::sinumerik) fn move_program(&mut self, run: &mut Run, stage: &Stage<'_>) -> usize {
        let state = self.programs[stage.channel].state;
        let stopped = state != ProgramState::Running && state != ProgramState::Waiting;
        let is_left = run.change == Some(Change::Level);
        let stops = stopped || run.stopping.is_some() || run.resetting.is_some() || is_left;
        let awaited = if run.awaits_spindles { self.awaited_spindle(stage) } else { None };
        run.awaits_spindles = awaited.is_some();
        let held = match awaited {
            _ if stops => Held::Stopped,
            Some((rule, input)) => Held::By(rule, input),
            None => self.holder(run, stage),
        };
        run.handwheel_share = self.handwheel_share(run, held, stage);
        // In JOG keys and handwheels move the axes of an interrupted program, whose path stands.
        let ended = if state == ProgramState::Interrupted { 0 } else { self.step_path(run, held, stage) };
        self.step_positionings(run, held, stage);
        ended
    }

    /// What holds the path: feed disable, feed stop or a missing enable of an axis that moves, or an override of 0 %.
    fn holder(&self, run: &Run, stage: &Stage<'_>) -> Held {
        if let Some(disabled) = self.feed_disable(stage.channel, stage.to_nck) {
            return Held::By(Rule::HeldByFeedStop, disabled);
        }
        if let Some(held) = self.spindle_stands(run, stage) {
            return Held::By(held.0, held.1);
        }
        let path = run.returning.as_ref().unwrap_or(&run.path);
        let direction = path.direction();
        let moves = |place: usize| direction[place].abs() >= 1e-12;
        let geometry = &stage.own.axes.geometry;
        let tested = self.programs[stage.channel].test.axes;
        // 21612: a geometry axis moves only while all geometry axes have their enables.
        let with_all = geometry.iter().flatten().any(|place| moves(*place));
        for (place, &axis) in stage.own.axes.path.iter().enumerate() {
            let needs_enable = moves(place) || with_all && geometry.contains(&Some(place)) && !tested.contains(axis);
            if !needs_enable || !self.owners.is_program_axis(axis, stage.channel) {
                continue;
            }
            let Some(unit) = self.unit_of(axis) else { continue };
            if !moves(place) {
                if let Some(off) = unit.members().find(|member| !self.axes[*member].enabling.is_on()) {
                    let control = crate::image::axis_from_nck::position_controller_active;
                    return Held::By(Rule::BlockWaitsForControl, axis_signal(off, control, false));
                }
                continue;
            }
            if let Some(stopper) = unit.members().find(|member| stage.to_nck.axes[*member].feed_stop()) {
                return Held::By(Rule::HeldByFeedStop, axis_signal(stopper, axis_to_nck::feed_stop, true));
            }
            if let Some(off) = unit.members().find(|member| !self.axes[*member].enabling.is_on()) {
                let control = crate::image::axis_from_nck::position_controller_active;
                return Held::By(Rule::BlockWaitsForControl, axis_signal(off, control, false));
            }
            let sign = if direction[place] > 0.0 { 1 } else { -1 };
            if let Some(input) = self.limits_program(&unit, sign) {
                return Held::By(Rule::HardwareLimitSwitch, input);
            }
            if self.axes[axis].signals.fast_stop {
                let shown = crate::image::axis_from_nck::ramp_function_generator_disable_active;
                return Held::By(Rule::FastStop, axis_signal(axis, shown, true));
            }
        }
        Held::No
    }

    /// Whether a unit is led by a geometry axis while the path of its channel moves geometry axes.
    pub(in crate::sinumerik) fn belongs_to_moving_path(&self, unit: &Unit, parameters: &Parameters) -> bool {
        let own = parameters.programs[unit.channel].as_deref();
        let run = self.programs[unit.channel].run.as_deref();
        let (Some(own), Some(run)) = (own, run) else { return false };
        let direction = run.path.direction();
        let moves = own.axes.geometry.iter().flatten().any(|place| direction[*place].abs() >= 1e-12);
        let leader = unit.leader();
        let is_geometry = own.axes.geometry.iter().flatten().any(|place| own.axes.path[*place] == leader);
        let is_own = self.owners.is_program_axis(leader, unit.channel) && !run.leaves_alone(leader);
        run.path.velocity() > 0.0 && moves && is_geometry && is_own
    }

    /// The unit that an axis leads.
    pub(in crate::sinumerik) fn unit_of(&self, axis: AxisNumber) -> Option<Unit> {
        self.units.iter().find(|unit| unit.leader() == axis).copied()
    }

    /// What holds the path of a program that is not stopped, with its rule. For an explanation.
    pub(in crate::sinumerik) fn path_is_held(&self, run: &Run, stage: &Stage<'_>) -> Option<(Rule, Input)> {
        match self.holder(run, stage) {
            Held::By(rule, input) => Some((rule, input)),
            Held::No | Held::Stopped => None,
        }
    }

    /// The override that acts on the block of the path, with its factor. For an explanation.
    pub(in crate::sinumerik) fn path_override(&self, run: &Run, stage: &Stage<'_>) -> Option<(Signal, f64)> {
        if run.deleting || run.change.is_some() {
            return None;
        }
        let (block, _) = run.returning.as_ref().unwrap_or(&run.path).current()?;
        let overrides = self.overrides(run, Held::No, stage);
        Some(match block.feed {
            Feed::Rapid => (channel_to_nck::rapid_traverse_override, overrides.rapid),
            Feed::Programmed(_) => (channel_to_nck::feed_override, overrides.feed),
        })
    }

    /// The override of an axis on its own way: of rapid traverse, or its own.
    pub(in crate::sinumerik) fn override_of_positioning(positioning: &AxisPositioning, stage: &Stage<'_>) -> f64 {
        if positioning.is_rapid {
            let signals = &stage.to_nck.channels[stage.channel];
            let (code, is_active) = (signals.rapid_traverse_override(), signals.rapid_traverse_override_active());
            stage.parameters.path_overrides.rapid(code, is_active)
        } else {
            let signals = &stage.to_nck.axes[positioning.axis];
            stage.parameters.axis_override(signals.feed_override(), signals.override_active())
        }
    }

    fn overrides(&self, run: &Run, held: Held, stage: &Stage<'_>) -> Overrides {
        if held != Held::No || run.deleting || run.change.is_some() {
            return Overrides { feed: 0.0, rapid: 0.0 };
        }
        let signals = &stage.to_nck.channels[stage.channel];
        let by_test = run.search.as_ref().is_some_and(|search| search.is_by_program_test());
        if by_test && stage.own.serupro_ignores_overrides {
            return Overrides { feed: 1.0, rapid: 1.0 };
        }
        let of = &stage.parameters.path_overrides;
        let feed = of.feed(signals.feed_override(), signals.feed_override_active());
        // The override does not act on what a handwheel adds, except that 0 % holds everything.
        let by_handwheel = if feed > 0.0 { run.handwheel_share } else { 0.0 };
        Overrides {
            feed: (feed * self.revolutions(run, stage) + by_handwheel).max(0.0),
            rapid: of.rapid(signals.rapid_traverse_override(), signals.rapid_traverse_override_active()),
        }
    }

    /// FD: what the handwheel of the first geometry axis adds, as a share of the feed.
    fn handwheel_share(&mut self, run: &Run, held: Held, stage: &Stage<'_>) -> f64 {
        let block = run.queue.front().filter(|block| block.by_handwheel && run.on_path > 0 && run.returning.is_none());
        let feed = block.and_then(|block| block.way).map(|way| run.effective_feed(way.feed, false, stage));
        let axis = stage.own.axes.geometry[0].map(|place| stage.own.axes.path[place]);
        let (Some(Feed::Programmed(feed)), Some(axis)) = (feed, axis) else { return 0.0 };
        let added = self.override_by_handwheel(axis, false, held != Held::No, (stage.parameters, stage.to_nck));
        added.map_or(0.0, |added| added / feed)
    }

    fn step_path(&mut self, run: &mut Run, held: Held, stage: &Stage<'_>) -> usize {
        let cycle = stage.parameters.cycle.seconds();
        let overrides = self.overrides(run, held, stage);
        let is_off = self.is_off(run, stage);
        if is_off && held == Held::No && run.returning.is_none() {
            run.returning = self.way_back(run, stage);
        } else if is_off && run.returning.is_none() {
            // An axis that lost the path stops alone; the path stops beside it.
            run.path.step(Overrides { feed: 0.0, rapid: 0.0 }, cycle);
            self.end_travels(run, held, stage, None);
            return 0;
        }
        let returns = run.returning.is_some();
        let path = run.returning.as_mut().unwrap_or(&mut run.path);
        let before = path.position();
        let direction = if path.stands() { PerPathAxis::default() } else { path.direction() };
        let moved = path.step(overrides, cycle);
        let (now, moves) = (moved.position, path.velocity() > 0.0);
        self.show_travels(run, &direction, moves, held, stage);
        self.lead(run, (before, now), stage);
        if returns {
            if run.returning.as_ref().is_some_and(Path::is_empty) {
                (run.returning, run.has_returned) = (None, !run.approaches);
            }
            return 0;
        }
        run.has_returned &= !moves;
        moved.ended
    }

    /// Leads the axes that move, and brings those to rest that moved in the last cycle.
    fn lead(&mut self, run: &Run, (before, now): (PerPathAxis, PerPathAxis), stage: &Stage<'_>) {
        let cycle = stage.parameters.cycle.seconds();
        for (place, &axis) in stage.own.axes.path.iter().enumerate() {
            if run.leaves_alone(axis) || !self.owners.is_program_axis(axis, stage.channel) {
                continue;
            }
            let setpoint = &self.axes[axis].setpoint;
            #[expect(clippy::cast_possible_truncation, reason = "a position of an axis fits")]
            let position = Position::new(now[place].round() as i64);
            let velocity = (now[place] - before[place]) / cycle;
            if velocity != 0.0 || !setpoint.is_still() && (setpoint.position - position).increments().abs() <= 1 {
                self.led[axis] = Some(Led::Path { position, velocity });
            } else if self.axes[axis].travel != Travel::None {
                self.led[axis] = Some(Led::Rest);
            }
        }
    }

    fn show_travels(&mut self, run: &Run, direction: &PerPathAxis, moves: bool, held: Held, stage: &Stage<'_>) {
        for (place, &axis) in stage.own.axes.path.iter().enumerate() {
            if run.leaves_alone(axis) || !self.owners.is_program_axis(axis, stage.channel) {
                continue;
            }
            let sign = if direction[place] > 1e-12 {
                1
            } else if direction[place] < -1e-12 {
                -1
            } else {
                0
            };
            let travel = match held {
                Held::Stopped if !moves => Travel::None,
                _ if moves => Travel::moving(sign),
                Held::Stopped | Held::By(..) | Held::No => Travel::waiting(sign),
            };
            self.show_travel(axis, travel, held, run, stage);
        }
    }

    fn end_travels(&mut self, run: &Run, held: Held, stage: &Stage<'_>, only: Option<AxisNumber>) {
        for &axis in &stage.own.axes.path {
            let own = self.owners.is_program_axis(axis, stage.channel) && !run.referencing.contains(axis);
            if own && only.is_none_or(|only| only == axis) {
                self.show_travel(axis, Travel::None, held, run, stage);
            }
        }
    }

    /// The travel of an axis by a program, with the event behind a change.
    fn show_travel(&mut self, axis: AxisNumber, travel: Travel, held: Held, run: &Run, stage: &Stage<'_>) {
        if self.axes[axis].travel == travel {
            return;
        }
        let place = Place::Axis(axis);
        let cause = match (held, travel) {
            (Held::Stopped, _) => {
                let program = &self.programs[stage.channel];
                let cause = run.resetting.or(run.stopping).unwrap_or(program.cause);
                self.log.now(place, cause, Rule::ProgramStopped, [Input::None; 3])
            }
            (Held::By(rule, input), Travel::Waiting(_))
            | (Held::By(rule @ Rule::HardwareLimitSwitch, input), Travel::None) => {
                self.log.now(place, run.block_cause, rule, [input, Input::None, Input::None])
            }
            _ => {
                let name = || run.queue.front().map(|block| block.origin.name.as_str()).unwrap_or_default();
                let of_way = run.positionings.iter().find(|one| one.axis == axis).map(|one| one.block);
                let block = of_way.filter(|block| !block.is_empty()).unwrap_or_else(|| block_name(name()));
                let input = Input::Block(block);
                let on_path = of_way.is_none();
                let returns = on_path && run.returning.is_some() && !run.approaches;
                let rule = match travel {
                    Travel::None if returns || on_path && run.has_returned => Rule::IsBack,
                    Travel::None => Rule::BlockMotionEnds,
                    _ if returns => Rule::Returns,
                    _ => Rule::BlockMoves,
                };
                self.log.now(place, run.block_cause, rule, [input, Input::None, Input::None])
            }
        };
        self.travel(axis, travel, cause);
    }

    fn step_positionings(&mut self, run: &mut Run, held: Held, stage: &Stage<'_>) {
        let mut index = 0;
        while let Some(&positioning) = run.positionings.get(index) {
            let AxisPositioning { axis, target, velocity, is_rapid, handwheel, .. } = positioning;
            let state = &self.axes[axis];
            let unit = self.unit_of(axis);
            let arrived = state.setpoint.position == target && state.setpoint.is_at_rest();
            let in_position = state.deviation().abs() <= state.active_set(&stage.parameters.axes[axis]).exact_stop_fine;
            let deletes = run.axial_deleting.contains(axis);
            if deletes && state.setpoint.is_at_rest() {
                // What is prepared behind it begins where the axis is now, as behind a synchronised action.
                run.positionings.remove(index);
                run.axial_deleting.set(axis, false);
                run.commanded.set(axis, true);
                run.commanded_arrived = true;
                let (place, parent) = (Place::Axis(axis), run.axial_delete_causes[axis]);
                let event = self.log.now(place, parent, Rule::BlockMotionEnds, [Input::None; 3]);
                self.travel(axis, Travel::None, event);
                continue;
            }
            if arrived && in_position {
                self.show_travel(axis, Travel::None, Held::No, run, stage);
                run.positionings.remove(index);
                run.commanded_arrived |= run.commanded.contains(axis);
                continue;
            }
            index += 1;
            let of_channel = &stage.to_nck.channels[stage.channel];
            let factor = Self::override_of_positioning(&positioning, stage);
            let on = |unit: &Unit| unit.members().all(|member| self.axes[member].enabling.is_on());
            let stopper = |unit: &Unit| unit.members().find(|member| stage.to_nck.axes[*member].feed_stop());
            let feed_disable = self.feed_disable(stage.channel, stage.to_nck);
            let way = i8::try_from((target - state.setpoint.position).increments().signum()).unwrap_or(0);
            let held = if held == Held::Stopped {
                held
            } else if let Some(disabled) = feed_disable {
                Held::By(Rule::HeldByFeedStop, disabled)
            } else if let Some(stopper) = unit.as_ref().and_then(stopper) {
                Held::By(Rule::HeldByFeedStop, axis_signal(stopper, axis_to_nck::feed_stop, true))
            } else if !unit.as_ref().is_some_and(on) {
                let control = crate::image::axis_from_nck::position_controller_active;
                Held::By(Rule::BlockWaitsForControl, axis_signal(axis, control, false))
            } else if let Some(input) = unit.as_ref().and_then(|unit| self.limits_program(unit, way)) {
                Held::By(Rule::HardwareLimitSwitch, input)
            } else if factor <= 0.0 && is_rapid {
                let code = of_channel.rapid_traverse_override();
                let signal = channel_to_nck::rapid_traverse_override;
                Held::By(Rule::HeldByOverride, channel_number(stage.channel, signal, code))
            } else if factor <= 0.0 {
                Held::By(Rule::HeldByOverride, self.axes[axis].override_input(axis))
            } else {
                Held::No
            };
            let by = (stage.parameters, stage.to_nck);
            let (place, added) = match handwheel {
                Handwheel::None => (target, 0.0),
                Handwheel::Velocity => {
                    (target, self.override_by_handwheel(axis, true, held != Held::No, by).unwrap_or(0.0))
                }
                Handwheel::Way => {
                    self.override_by_handwheel(axis, true, held != Held::No, by);
                    (self.place_by_handwheel(axis, target), 0.0)
                }
            };
            let moves = held == Held::No && !deletes;
            let velocity = if moves { (velocity * factor + added).max(0.0) } else { 0.0 };
            let velocity = velocity.min(stage.parameters.axes[axis].maximum_velocity);
            self.led[axis] = Some(Led::Target { target: place, velocity });
            let here = self.axes[axis].setpoint.position;
            let awaits_pulses = place != target && place == here;
            let sign = if awaits_pulses { target - here } else { place - here };
            let sign = i8::try_from(sign.increments().signum()).unwrap_or(0);
            let rests = self.axes[axis].setpoint.is_at_rest();
            let travel = match held {
                Held::Stopped if rests => Travel::None,
                Held::No if !awaits_pulses => Travel::moving(sign),
                Held::Stopped | Held::By(..) | Held::No => Travel::waiting(sign),
            };
            self.show_travel(axis, travel, held, run, stage);
        }
    }

    /// Whether all axes of a program have come to rest.
    pub(in crate::sinumerik) fn program_rests(&self, run: &Run, stage: &Stage<'_>) -> bool {
        let path = run.returning.as_ref().unwrap_or(&run.path);
        let mut own = stage.own.axes.path.iter().filter(|axis| self.owners.is_program_axis(**axis, stage.channel));
        path.velocity() <= 0.0 && own.all(|axis| self.axes[*axis].setpoint.is_at_rest())
    }

    /// A unit that a program leads in this cycle takes its movement over. Returns whether one does.
    pub(in crate::sinumerik) fn follow_program(
        &mut self,
        unit: &Unit,
        parameters: &Parameters,
        to_nck: &ToNck,
    ) -> bool {
        let leader = unit.leader();
        let Some(led) = self.led[leader].take() else { return false };
        let direction = match led {
            Led::Path { velocity, .. } => velocity,
            Led::Target { target, .. } => (target - self.axes[leader].setpoint.position).increments() as f64,
            Led::Rest => 0.0,
        };
        let sign = i8::from(direction > 0.0) - i8::from(direction < 0.0);
        if self.limited_by(unit, sign).is_some() && self.brake_at_limit(unit, parameters) {
            return true;
        }
        self.axes[leader].motion = match led {
            Led::Rest => return true,
            Led::Path { position, velocity } => crate::motion::Motion::Interpolated { position, velocity },
            Led::Target { target, velocity } => {
                let acceleration = parameters.axes[leader].maximum_acceleration;
                match self.before_limit(unit, (target, velocity > 0.0), parameters, to_nck) {
                    Some(target) => crate::motion::Motion::GoTo { target, velocity, acceleration },
                    None => crate::motion::Motion::Brake { deceleration: acceleration },
                }
            }
        };
        true
    }

    /// The axes that programs lead or have led: they decide in each cycle.
    pub(in crate::sinumerik) fn program_axes(&self, parameters: &Parameters) -> crate::units::AxisSet {
        let mut axes = self.single.watched.with(self.generating());
        for (channel, _) in parameters.existing_channels() {
            let program = &self.programs[channel];
            let Some(own) = parameters.programs[channel].as_deref() else { continue };
            let moves =
                |axis: &AxisNumber| self.axes[*axis].travel != Travel::None || !self.axes[*axis].setpoint.is_still();
            if let Some(run) = program.run.as_deref() {
                let runs = matches!(program.state, ProgramState::Running | ProgramState::Waiting);
                let active = |axis: &AxisNumber| {
                    runs && !run.path.is_empty() || moves(axis) || run.positionings.iter().any(|one| one.axis == *axis)
                };
                let mine = |axis: &AxisNumber| self.owners.is_program_axis(*axis, channel);
                axes = axes.with(own.axes.path.iter().copied().filter(mine).filter(active).collect());
                axes = axes.with(run.referencing);
            }
        }
        axes
    }
}
