//! Channel-specific referencing (1.0, 33.0): the order of the axes of a channel, and what ends it.
//!
//! It waits for the enables of an axis. An axis that its machine data exclude from an approach (no encoder, or none by MD34200) is left out,
//! and so is an open grouping; an axis that is parked, has 1.3 = 1 or a velocity of 0 when its turn comes ends it with 20005.

use crate::image::{ToNck, axis_to_nck, channel_to_nck, mode_group_from_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::inputs::{axis_signal, channel_signal, mode_group_signal};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::referencing::state::ChannelReferencing;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{EventId, Input, Place};

/// The progress of the axes of an order number.
#[derive(Clone, Copy, Debug)]
struct Progress {
    /// All have finished.
    finished: bool,
    /// An axis whose approach was aborted.
    failed: Option<AxisNumber>,
}

impl State {
    /// Starts channel-specific referencing with the rising edge of DBX1.0.
    pub(in crate::sinumerik) fn start_channel_referencing(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        for (channel, group) in parameters.existing_channels() {
            let wanted = to_nck.channels[channel].activate_referencing();
            let before = self.channels[channel].referencing;
            self.channels[channel].referencing.was = wanted;
            let rises = wanted && !before.was && !before.is_active();
            if !rises || self.stop(channel, parameters).is_some() || !self.mode_groups[group].is_referencing() {
                continue;
            }
            let place = Place::Channel(channel);
            let input = channel_signal(channel, channel_to_nck::activate_referencing, true);
            let cause = self.log.note_one(place, Rule::ApproachStartedByChannel, input, EventId::NONE);
            let number = self.next_cycle_number(channel, 0, parameters);
            self.channels[channel].referencing = ChannelReferencing { number, started: 0, was: true, cause };
        }
    }

    /// Orders and ends it: axes with MD34110 = 1 start first, together; axes with n start after all with n − 1. 33.0 is reset
    /// with the last reference.
    pub(in crate::sinumerik) fn order_channel_referencing(&mut self, parameters: &Parameters, to_nck: &ToNck) {
        for (channel, group) in parameters.existing_channels() {
            if !self.channels[channel].is_referencing() {
                continue;
            }
            // The PLC first sees that its request was taken.
            if !self.log.is_of_this_cycle(self.channels[channel].referencing.cause) {
                self.refuse_hindered_axes(channel, parameters, to_nck);
            }
            let Progress { finished, failed } = self.channel_referencing_progress(channel, parameters);
            if let Some((input, cause)) = self.channel_referencing_stopped(channel, group, failed, parameters) {
                self.end_channel_referencing(channel, input, cause);
            } else if finished {
                let number = self.next_cycle_number(channel, self.channels[channel].referencing.number, parameters);
                self.channels[channel].referencing.number = number;
                if number == 0 {
                    self.end_channel_referencing(channel, Input::None, self.channels[channel].referencing.cause);
                }
            }
        }
    }

    /// 20005 for the axes that have their turn and cannot begin: only the PLC or an operator can change this, so they would wait for ever.
    fn refuse_hindered_axes(&mut self, channel: ChannelNumber, parameters: &Parameters, to_nck: &ToNck) {
        let referencing = self.channels[channel].referencing;
        let wanted = |unit: &&Unit| {
            let axis = unit.leader();
            referencing.wants(axis, parameters.axes[axis].reference.cycle_number)
        };
        let refused: Vec<_> = self
            .referenced_by(channel, parameters)
            .filter(wanted)
            .filter_map(|unit| Some((unit.leader(), self.approach_refused(unit, parameters, to_nck)?)))
            .collect();
        for (axis, inputs) in refused {
            let event = self.log.note(Place::Axis(axis), Rule::ApproachCannotStart, inputs, referencing.cause);
            self.raise_axis_alarm(alarms::APPROACH_ABORTED, axis, event);
        }
    }

    /// A machine datum with which an approach of an axis would end when it starts.
    pub(super) fn datum_against_approach(&self, number: AxisNumber, parameters: &Parameters) -> Option<Input> {
        let encoder = usize::from(self.axes[number].measuring_system.unwrap_or(0));
        let (datum, value) = parameters.axes[number].approach_hindered_by(encoder)?;
        Some(Input::Datum(datum, Some(number), value))
    }

    /// The signals of the PLC (parked, 1.3 = 1) or the machine datum with which a unit cannot begin an approach.
    fn approach_refused(&self, unit: &Unit, parameters: &Parameters, to_nck: &ToNck) -> Option<[Input; 3]> {
        let leader = unit.leader();
        if self.axes[leader].measuring_system.is_none() {
            let parked = unit.members().find(|&axis| self.selected(axis, parameters, to_nck).is_none());
            let axis = parked.unwrap_or(leader);
            let signals = &to_nck.axes[axis];
            return Some([
                axis_signal(axis, axis_to_nck::position_measuring_system_1, signals.position_measuring_system_1()),
                axis_signal(axis, axis_to_nck::position_measuring_system_2, signals.position_measuring_system_2()),
                Input::None,
            ]);
        }
        let disabled = to_nck.axes[leader].axis_spindle_disable();
        let disabled = disabled.then(|| axis_signal(leader, axis_to_nck::axis_spindle_disable, true));
        let input = disabled.or_else(|| self.datum_against_approach(leader, parameters))?;
        Some([input, Input::None, Input::None])
    }

    /// What ends it before the last axis: 20005 or another alarm that stops, RESET, a failed approach, another machine function; with the
    /// event behind it.
    fn channel_referencing_stopped(
        &self,
        channel: ChannelNumber,
        group: ModeGroupNumber,
        failed: Option<AxisNumber>,
        parameters: &Parameters,
    ) -> Option<(Input, EventId)> {
        if let Some(stop) = self.stop(channel, parameters) {
            return Some((stop.tested().1, stop.cause()));
        }
        let active = &self.mode_groups[group];
        if !active.is_referencing() {
            let referencing = mode_group_from_nck::active_machine_function_ref;
            return Some((mode_group_signal(group, referencing, false), active.cause()));
        }
        failed.map(|axis| (Input::None, self.axes[axis].approach.cause()))
    }

    fn end_channel_referencing(&mut self, channel: ChannelNumber, input: Input, cause: EventId) {
        let event = self.log.note_one(Place::Channel(channel), Rule::ChannelReferencingEnds, input, cause);
        let referencing = &mut self.channels[channel].referencing;
        (referencing.number, referencing.cause) = (0, event);
    }

    /// The units that a channel can reference.
    fn referenced_by(&self, channel: ChannelNumber, parameters: &Parameters) -> impl Iterator<Item = &Unit> {
        let whole = |unit: &&Unit| unit.grouping.is_some() || !self.is_gantry_axis(unit.leader());
        let of_channel = self.units.iter().filter(move |unit| unit.channel == channel);
        of_channel.filter(whole).filter(|unit| self.has_approach(unit, parameters))
    }

    /// Whether the machine data allow an approach of a unit: every axis has an encoder, and that of the first axis has an approach.
    pub(in crate::sinumerik) fn has_approach(&self, unit: &Unit, parameters: &Parameters) -> bool {
        let (leader, encoders) = (unit.leader(), |axis: AxisNumber| parameters.axes[axis].encoders);
        let reference = &parameters.axes[leader].reference;
        let has_approach = match self.axes[leader].measuring_system {
            Some(active) => reference.has_approach(usize::from(active)),
            None => (0..usize::from(encoders(leader)).min(2)).any(|encoder| reference.has_approach(encoder)),
        };
        has_approach && unit.members().all(|axis| encoders(axis) > 0)
    }

    /// The next order number above this one with an axis that can be started; 0 if there is none.
    fn next_cycle_number(&self, channel: ChannelNumber, above: i32, parameters: &Parameters) -> i32 {
        self.referenced_by(channel, parameters)
            .map(|unit| parameters.axes[unit.leader()].reference.cycle_number)
            .filter(|&number| number > above)
            .min()
            .unwrap_or(0)
    }

    fn channel_referencing_progress(&self, channel: ChannelNumber, parameters: &Parameters) -> Progress {
        let (mut finished, mut failed) = (true, None);
        let number = self.channels[channel].referencing.number;
        for unit in self.referenced_by(channel, parameters) {
            let axis = unit.leader();
            if parameters.axes[axis].reference.cycle_number != number {
                continue;
            }
            let running = self.axes[axis].approach.is_running()
                || unit.grouping.is_some_and(|index| self.groupings[usize::from(index)].is_referencing());
            let started = self.channels[channel].started(axis);
            let referenced = unit.members().all(|member| self.axes[member].is_referenced());
            finished &= started && !running && referenced;
            if started && !running && !referenced {
                failed = failed.or(Some(axis));
            }
        }
        Progress { finished, failed }
    }
}
