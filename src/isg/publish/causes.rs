//! The event behind each signal of the CNC, asked for when the signal has changed.
//!
//! A state has the event that changed it. A value that follows directly from the present state (in position, axis state, state of the
//! channel) gets an event at its edge, with what was tested for it.

use crate::image::Signal;
use crate::isg::channel::{Channel, Task};
use crate::isg::hli::{axis_from_cnc, channel_from_cnc, channel_skip_from_cnc, channel_to_cnc};
use crate::isg::inputs::{axis_signal, block, channel_signal, holds};
use crate::isg::rules::Why;
use crate::isg::state::State;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{EventId, FaultName, Input, Place, Quantity};

/// The reason for the value of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Reason {
    /// It was decided in this cycle.
    Event(EventId),
    /// It follows directly from these inputs.
    Tested(Why, [Input; 3], EventId),
}

impl Reason {
    const fn one(why: Why, input: Input, parent: EventId) -> Self {
        Self::Tested(why, [input, Input::None, Input::None], parent)
    }
}

fn is(signal: Signal, byte: u16, bit: u8) -> bool {
    (signal.byte, signal.bit) == (byte, bit)
}

impl State {
    /// The event behind a bit that has changed in this cycle.
    pub(in crate::isg) fn signal_cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId {
        let reason = match place {
            Place::Axis(axis) => self.axis_reason(axis, byte, bit),
            Place::Channel(channel) => self.channel_reason(channel, byte, bit),
            Place::Nck | Place::ModeGroup(_) => Reason::Event(EventId::NONE),
        };
        match reason {
            Reason::Event(event) if event.is_some() => event,
            // What has not changed since the start.
            Reason::Event(_) => self.as_after_start,
            Reason::Tested(why, inputs, parent) => {
                let parent = if parent.is_some() { parent } else { self.as_after_start };
                // The bits of a number have one event.
                let last = self.log.events.find(self.log.events.last()).filter(|last| {
                    let same = (last.place, last.rule, last.parent) == (place, why.into(), parent);
                    same && last.cycle == self.log.cycle && last.inputs == inputs
                });
                last.map(|last| last.id).unwrap_or_else(|| self.log.note(place, why, inputs, parent))
            }
        }
    }

    fn axis_reason(&self, number: AxisNumber, byte: u16, bit: u8) -> Reason {
        let axis = &self.axes[number];
        let causes = &axis.causes;
        let is = |signal| is(signal, byte, bit);
        if is(axis_from_cnc::drive_enable_state) {
            Reason::Event(causes.drive_enable)
        } else if is(axis_from_cnc::feed_enable_state) {
            Reason::Event(causes.feed_enable)
        } else if is(axis_from_cnc::gantry_on_state) {
            Reason::Event(causes.gantry_on)
        } else if is(axis_from_cnc::drive_ready) {
            self.ready_reason(number)
        } else if is(axis_from_cnc::homed) {
            Reason::Event(causes.homed)
        } else if is(axis_from_cnc::homing) {
            Reason::Event(causes.homing)
        } else if is(axis_from_cnc::error) || is(axis_from_cnc::error_not_resettable) {
            Reason::Event(causes.error)
        } else if is(axis_from_cnc::gantry_coupled) {
            Reason::Event(causes.coupled)
        } else if is(axis_from_cnc::in_position) {
            self.position_reason(number)
        } else if byte == axis_from_cnc::axis_state.byte {
            self.axis_state_reason(number)
        } else {
            Reason::Event(self.as_after_start)
        }
    }

    /// Why a drive is ready or not, as it is now.
    fn ready_reason(&self, number: AxisNumber) -> Reason {
        let (feedback, causes) = (&self.axes[number].feedback, &self.axes[number].causes);
        let parent = self.power_on.max(causes.fault);
        match (feedback.drive_fault, feedback.drive_ready) {
            (true, _) => Reason::one(Why::DriveFault, Input::Fault(FaultName::DriveFault), causes.fault),
            (false, true) => Reason::one(Why::DriveStarted, Input::None, parent),
            (false, false) => Reason::one(Why::DriveNotReady, Input::None, parent),
        }
    }

    /// Why an axis is in position or not, as it is now.
    fn position_reason(&self, number: AxisNumber) -> Reason {
        let axis = &self.axes[number];
        if !axis.is_powered() {
            let (why, input, parent) = self.without_power(number);
            return Reason::one(why, input, parent);
        }
        if !axis.setpoint.is_at_rest() {
            return self.movement(number);
        }
        let why = if axis.is_in_position() { Why::Stands } else { Why::LeavesPosition };
        let deviation = Input::Length(Quantity::Deviation, number, axis.following_error());
        Reason::one(why, deviation, self.before_rest(number))
    }

    fn axis_state_reason(&self, number: AxisNumber) -> Reason {
        let axis = &self.axes[number];
        if axis.error.is_some() {
            return Reason::Event(axis.causes.error);
        }
        if !axis.is_powered() {
            let (why, input, parent) = self.without_power(number);
            return Reason::one(why, input, parent);
        }
        if !axis.units.feed_enable {
            let enable = axis_signal(number, axis_from_cnc::feed_enable_state, false);
            return Reason::one(Why::Held, enable, axis.causes.feed_enable);
        }
        if let Some(channel) = self.holder(number) {
            return match channel.task {
                Task::Stands => Reason::one(Why::ProgramStands, block(channel.block()), channel.causes.stands),
                Task::Idle | Task::Runs | Task::Aborts => {
                    Reason::one(Why::Held, holds(channel), channel.causes.program.max(channel.causes.feed_override))
                }
            };
        }
        if !axis.setpoint.is_at_rest() {
            return self.movement(number);
        }
        let signals = [axis_from_cnc::drive_enable_state, axis_from_cnc::feed_enable_state];
        let [drive, feed] = signals.map(|signal| axis_signal(number, signal, true));
        let error = axis_signal(number, axis_from_cnc::error, false);
        Reason::Tested(Why::Rests, [drive, feed, error], self.before_rest(number))
    }

    /// What changed last of all that lets an axis rest where it stands.
    fn before_rest(&self, number: AxisNumber) -> EventId {
        let causes = &self.axes[number].causes;
        let own = [causes.drive_enable, causes.feed_enable, causes.ready, causes.error, causes.homing, causes.motion];
        let members = self.coupled_with(number);
        let moved = self.channels.iter().filter(|channel| channel.axes.iter().any(|own| members.contains(&own.axis)));
        let programs = moved.map(|channel| channel.causes.block.max(channel.causes.program).max(channel.causes.stands));
        own.into_iter().chain(programs).max().unwrap_or(EventId::NONE)
    }

    /// Why the setpoint of an axis moves: a homing run of it or of an axis that it follows, its clearing, a block, or a stop.
    fn movement(&self, number: AxisNumber) -> Reason {
        let members = self.coupled_with(number);
        if let Some((axis, run)) = members.iter().find_map(|axis| Some((*axis, self.axes[*axis].run.as_ref()?))) {
            return Reason::one(Why::Moves, axis_signal(axis, axis_from_cnc::homing, true), run.cause());
        }
        let causes = &self.axes[number].causes;
        if self.is_clearing(number) {
            return Reason::one(Why::Moves, Input::None, causes.motion);
        }
        let moves = |channel: &&Channel| members.iter().any(|member| channel.moves(*member));
        if let Some(channel) = self.channels.iter().find(moves) {
            let parent = channel.causes.program.max(channel.causes.stands);
            return Reason::one(Why::Moves, block(channel.block()), parent);
        }
        Reason::one(Why::Moves, Input::None, self.before_rest(number))
    }

    fn channel_reason(&self, number: ChannelNumber, byte: u16, bit: u8) -> Reason {
        let Some(channel) = self.channels.iter().find(|channel| channel.number == number) else {
            return Reason::Event(self.as_after_start);
        };
        let (is, causes) = (|signal| is(signal, byte, bit), &channel.causes);
        let state = channel_from_cnc::feed_override_state.byte;
        if is(channel_from_cnc::error) {
            Reason::Event(causes.error)
        } else if is(channel_from_cnc::program_active) || is(channel_from_cnc::program_completed) {
            Reason::Event(causes.program)
        } else if byte == channel_from_cnc::state.byte {
            Self::channel_state_reason(channel)
        } else if byte >= channel_skip_from_cnc::program_block_ignore_state.byte {
            Reason::Event(causes.skipped)
        } else if byte >= channel_skip_from_cnc::program_block_ignore_request.byte {
            Reason::Event(self.as_after_start)
        } else if byte >= channel_from_cnc::block.byte {
            match channel.task {
                Task::Idle => Reason::Event(causes.program),
                Task::Runs | Task::Stands | Task::Aborts => {
                    Reason::one(Why::BlockRuns, block(channel.block()), causes.started)
                }
            }
        } else if (state..state + 2).contains(&byte) {
            Reason::Event(causes.feed_override)
        } else {
            Reason::Event(self.as_after_start)
        }
    }

    /// Why a channel has its state, as it is now.
    fn channel_state_reason(channel: &Channel) -> Reason {
        let causes = &channel.causes;
        let active = |value| channel_signal(channel.number, channel_from_cnc::program_active, value);
        if channel.error {
            let error = channel_signal(channel.number, channel_from_cnc::error, true);
            return Reason::one(Why::ChannelInError, error, causes.error);
        }
        match channel.task {
            Task::Stands => Reason::one(Why::ProgramStands, block(channel.block()), causes.stands),
            Task::Runs if channel.is_held() => {
                Reason::one(Why::Held, holds(channel), causes.program.max(causes.feed_override))
            }
            Task::Runs | Task::Aborts => {
                let hold = channel_signal(channel.number, channel_to_cnc::feed_hold, channel.inputs.feed_hold);
                let inputs = [active(true), hold, Input::None];
                Reason::Tested(Why::ProgramRuns, inputs, causes.program.max(causes.stands).max(causes.feed_override))
            }
            Task::Idle => {
                let why = if channel.selected.is_some() { Why::ProgramReady } else { Why::ProgramMissing };
                let parent = causes.program.max(causes.selected).max(causes.error);
                Reason::one(why, active(false), parent)
            }
        }
    }
}
