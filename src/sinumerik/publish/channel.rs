//! The signals of a channel: DB21 to DB30.

use crate::image::{axis_from_nck, channel_from_nck};
use crate::nc_program::g;
use crate::sinumerik::alarms::{Alarm, Reaction};
use crate::sinumerik::axis::travel::command_signal;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::search_state::Search;
use crate::sinumerik::program::state::ProgramState;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, ChannelNumber};
use crate::variables::{EventId, Input, Place};

impl State {
    /// "At least one axis is being traversed in JOG", or is being referenced; also while feed stop, an override of 0 % or a missing enable
    /// holds the movement, in the complete section 3 of a grouping while 10655 is pending (O-31), and while 33.0 = 1.
    pub(super) fn is_channel_active(&self, channel: ChannelNumber) -> bool {
        let moves = !self.summary.in_motion.and(self.active_axes(channel)).is_empty();
        moves || self.channels[channel].is_referencing()
    }

    /// No program runs or is stopped, and no axis moves.
    pub(super) fn is_channel_reset(&self, channel: ChannelNumber) -> bool {
        let aborted = self.programs[channel].state == ProgramState::Aborted;
        aborted && !self.is_channel_active(channel)
    }

    /// DB21 to DB30 of one channel.
    pub(super) fn show_channel(&self, channel: ChannelNumber, parameters: &Parameters, rows: &mut impl Rows) {
        let active = self.is_channel_active(channel);
        let motion = || self.activity(|of| of == channel, active, parameters);
        rows.bit(channel_from_nck::referencing_active, self.channels[channel].is_referencing(), || {
            Why::Event(self.channels[channel].referencing.cause)
        });
        let program = &self.programs[channel];
        let by_program = || Why::Event(program.cause);
        rows.bit(channel_from_nck::m0_m1_active, program.programmed_stop, by_program);
        let by_search = || Why::Event(program.search_cause);
        let (search, run) = (program.search(), program.run.as_deref());
        rows.bit(channel_from_nck::action_block_active, search.is_some_and(|of| of.acts(&program.output)), by_search);
        rows.bit(channel_from_nck::approach_block_active, run.is_some_and(|run| run.approaches), by_search);
        rows.bit(channel_from_nck::last_action_block_active, search.is_some_and(Search::is_last_action), by_search);
        rows.bit(channel_from_nck::block_search_active, search.is_some_and(Search::is_searching), by_search);
        rows.bit(channel_from_nck::program_test_active, program.test.is_active, || Why::Event(program.test.cause));
        let of_path = self
            .owners
            .of_channel(channel)
            .iter()
            .find_map(|axis| self.axes[axis].by_handwheel.filter(|one| one.is_active && !one.is_axial));
        rows.bit(channel_from_nck::handwheel_override_active, of_path.is_some(), || {
            let without = |axis| {
                let missing = self.axes[axis].by_handwheel.filter(|one| !one.is_axial).map(|one| one.cause);
                missing.unwrap_or(self.single.axes[axis].handwheel_cause)
            };
            let ended = self.owners.of_channel(channel).iter().map(without).max();
            Why::Event(of_path.map(|one| one.cause).or(ended).unwrap_or(EventId::NONE))
        });
        let per_revolution = program.modal.is(g::G95);
        rows.bit(channel_from_nck::revolutional_feedrate_active, per_revolution, || Why::Event(program.modal_cause));
        rows.bit(channel_from_nck::m2_m30_active, program.ended, by_program);
        for (signal, state) in [
            (channel_from_nck::program_state_running, ProgramState::Running),
            (channel_from_nck::program_state_wait, ProgramState::Waiting),
            (channel_from_nck::program_state_stopped, ProgramState::Stopped),
            (channel_from_nck::program_state_interrupted, ProgramState::Interrupted),
            (channel_from_nck::program_state_aborted, ProgramState::Aborted),
        ] {
            rows.bit(signal, program.state == state, by_program);
        }
        let runs = matches!(program.state, ProgramState::Running | ProgramState::Waiting);
        let interrupted = matches!(program.state, ProgramState::Stopped | ProgramState::Interrupted);
        // A program that is stopped leaves the channel interrupted, but for an axis that is moved meanwhile.
        let moved = active && program.state != ProgramState::Stopped;
        let why_state = || {
            let of_program = self.log.is_of_this_cycle(program.cause);
            if of_program { Why::Event(program.cause) } else { motion() }
        };
        rows.bit(channel_from_nck::channel_state_active, runs || moved, why_state);
        rows.bit(channel_from_nck::channel_state_interrupted, interrupted && !moved, why_state);
        rows.bit(channel_from_nck::channel_state_reset, !runs && !interrupted && !active, why_state);
        let referenced = self.is_referenced(channel, parameters);
        rows.bit(channel_from_nck::all_axes_requiring_reference_point_are_referenced, referenced, || {
            self.why_referenced(channel, referenced, parameters)
        });
        let standing = self.summary.standing.has_all_of(self.stationary_axes(channel, parameters));
        rows.bit(channel_from_nck::all_axes_stationary, standing, || {
            self.why_stationary(channel, standing, parameters)
        });
        let of_channel = |reaction: Reaction| {
            move |place: Place, alarm: &Alarm| {
                alarm.reaction.has(reaction) && self.owners.concerns_channel(parameters, place, channel)
            }
        };
        let pending = |reaction| self.alarms.first(of_channel(reaction)).is_some();
        let why = |reaction| move || self.why_alarm(of_channel(reaction));
        let ready = self.run_up.is_nc_ready() && !pending(Reaction::CHANNEL_NOT_READY);
        rows.bit(channel_from_nck::channel_ready, ready, || self.why_ready(ready, why(Reaction::CHANNEL_NOT_READY)));
        let alarm = Reaction::INTERFACE_SIGNALS;
        rows.bit(channel_from_nck::channel_specific_nck_alarm_active, pending(alarm), why(alarm));
        let stop = Reaction::STOP;
        rows.bit(channel_from_nck::nck_alarm_with_machining_stop_active, pending(stop), why(stop));
    }

    /// The event that started or ended the activity of channels: the axis that began or ended to move in this cycle, or channel-specific
    /// referencing.
    pub(super) fn activity(
        &self,
        channels: impl Fn(ChannelNumber) -> bool + Copy,
        active: bool,
        parameters: &Parameters,
    ) -> Why {
        let (now, before) = (self.summary.in_motion, self.summary.before.in_motion);
        let changed = if active { now.without(before) } else { before.without(now) };
        // An axis with a command first, then the first of axes that change together.
        let is_meant = |axis: &AxisNumber| channels(self.owners.of(*axis).channel);
        let commanded = |axis: &AxisNumber| active && self.axes[*axis].travel.is_pending();
        let changed: AxisSet = changed.iter().filter(is_meant).collect();
        let Some(number) = changed.iter().find(commanded).or_else(|| changed.iter().next()) else {
            let referencing = parameters.existing_channels().filter(|(channel, _)| channels(*channel));
            let mut causes = referencing.map(|(channel, _)| self.channels[channel].referencing.cause);
            let event = causes.find(|&cause| self.log.is_of_this_cycle(cause));
            return Why::Event(event.unwrap_or(EventId::NONE));
        };
        let axis = &self.axes[number];
        // An axis without signals shows nothing.
        let audible = |input| if parameters.axes[number].silent { Input::None } else { input };
        let tested = |rule, first, second, parent: EventId| match self.of_this_cycle([parent]) {
            Some(event) => event,
            None => Why::Tested(rule, [audible(first), audible(second), Input::None], parent),
        };
        if let Some(opened) = self.opened_loop(number) {
            return opened;
        }
        if !active {
            let [plus, minus] = [1, -1].map(|sign| axis_signal(number, command_signal(sign), false));
            return tested(Rule::ChannelAtRest, plus, minus, axis.causes.motion);
        }
        if axis.travel.is_pending() {
            let mover = self.mover(number);
            let shown = self.axes[mover].travel.shown(mover, parameters);
            return tested(Rule::ChannelActive, shown, Input::None, axis.causes.motion);
        }
        if axis.approach.is_running() {
            return tested(Rule::ChannelActive, Input::None, Input::None, axis.approach.cause());
        }
        let section_3 = self.groupings.iter().find(|grouping| {
            grouping.phase == Phase::Synchronising && grouping.coupling.members().any(|member| member == number)
        });
        if let Some(grouping) = section_3 {
            return tested(Rule::ChannelActive, Input::None, Input::None, grouping.cause);
        }
        let follows_up = axis.enabling.follow_up && axis.measuring_system.is_some();
        let follow_up = axis_signal(number, axis_from_nck::follow_up_active, follows_up);
        tested(Rule::ChannelActive, follow_up, Input::None, axis.causes.movement())
    }

    /// The cause of 36.3: the axis that is no longer stationary, or that was the last one.
    fn why_stationary(&self, channel: ChannelNumber, standing: bool, parameters: &Parameters) -> Why {
        let (now, before) = (self.summary.standing, self.summary.before.standing);
        let changed = if standing { now.without(before) } else { before.without(now) };
        let Some(number) = changed.and(self.stationary_axes(channel, parameters)).iter().next() else {
            // An axis that moves or stands has come or gone.
            return Why::Event(self.exchange_of_this_cycle());
        };
        if let Some(opened) = self.opened_loop(number) {
            return opened;
        }
        let rule = if standing { Rule::AllStationary } else { Rule::NotAllStationary };
        let input = if parameters.axes[number].silent {
            Input::None
        } else {
            axis_signal(number, axis_from_nck::axis_stationary, standing)
        };
        Why::Tested(rule, [input, Input::None, Input::None], self.axes[number].causes.movement())
    }

    /// The cause of 36.2: the axis that is no longer referenced, or that was the last one; or machine data.
    fn why_referenced(&self, channel: ChannelNumber, referenced: bool, parameters: &Parameters) -> Why {
        let (now, before) = (self.summary.referenced, self.summary.before.referenced);
        let changed = if referenced { now.without(before) } else { before.without(now) };
        let rule = if referenced { Rule::ChannelReferenced } else { Rule::ChannelNotReferenced };
        let channels = &parameters.channels[channel];
        if let Some(number) = changed.and(channels.reference_needed).iter().next() {
            let (inputs, parent) = self.reference_inputs(number, parameters);
            return Why::Tested(rule, inputs, parent);
        }
        let cycle = |number| {
            let cycle = f64::from(parameters.axes[number].reference.cycle_number);
            Input::Datum(34110, Some(number), cycle)
        };
        let lock = Input::Datum(20700, None, f64::from(u8::from(channels.start_locked)));
        let mut data = channels.axes.iter().map(cycle).chain([lock]);
        let datum = data.find(|datum| self.log.is_new(datum));
        datum.map_or(Why::Event(EventId::NONE), |datum| {
            Why::Tested(rule, [datum, Input::None, Input::None], EventId::NONE)
        })
    }

    /// Whether the active measuring system of an axis is referenced, as inputs, and the event behind it.
    pub(in crate::sinumerik) fn reference_inputs(
        &self,
        number: AxisNumber,
        parameters: &Parameters,
    ) -> ([Input; 3], EventId) {
        use axis_from_nck::{
            position_measuring_system_1_activated, position_measuring_system_2_activated, referenced_synchronized_1,
            referenced_synchronized_2,
        };
        let axis = &self.axes[number];
        let shown = |signal, value| {
            if parameters.axes[number].silent { Input::None } else { axis_signal(number, signal, value) }
        };
        let (reference, selected) = (axis.causes.reference, axis.causes.measuring_system);
        match axis.measuring_system {
            None => {
                let first = shown(position_measuring_system_1_activated, false);
                let second = shown(position_measuring_system_2_activated, false);
                ([first, second, Input::None], selected)
            }
            Some(0) => {
                let value = shown(referenced_synchronized_1, axis.referenced[0]);
                let active = shown(position_measuring_system_1_activated, true);
                ([value, active, Input::None], reference[0].max(selected))
            }
            Some(_) => {
                let value = shown(referenced_synchronized_2, axis.referenced[1]);
                let active = shown(position_measuring_system_2_activated, true);
                ([value, active, Input::None], reference[1].max(selected))
            }
        }
    }
}
