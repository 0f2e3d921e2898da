//! The CNC's half of the HLI, the variables, and the events behind both.

use std::fmt::Write;
use std::sync::Arc;

use super::hli::{AxisFromCnc, FromCnc, axis_from_cnc, channel_from_cnc};
use super::rules::Why;
use super::state::{Axis, AxisError, State};
use crate::image::View;
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::{AxisValues, BlockName, EventId, FaultName, Input, Place, Variables};

/// The axis states of the HLI.
const READY: u8 = 1;
const ACTIVE: u8 = 3;
const HOLD: u8 = 5;
const ERROR: u8 = 7;

impl State {
    /// Writes the CNC's half.
    pub(super) fn publish(&mut self, out: &mut [u8], variables: &mut Variables) {
        let Some(from_cnc) = FromCnc::of_bytes_mut(out) else { return };
        for number in self.existing() {
            let bits = self.axis_bits(number);
            from_cnc.axes[number] = bits;
            variables.axes[number] = self.axis_values(number);
        }
        for channel in &self.channels {
            let bits = &mut from_cnc.channels[channel.number];
            bits.set_program_active(channel.is_active());
            bits.set_program_completed(channel.completed);
            bits.set_error(channel.error);
            bits.set_state(channel.hli_state());
            bits.set_feed_override_request(1000);
            bits.set_feed_override_state(channel.inputs.feed_override);
            bits.set_block(channel.block());
        }
        for channel in &self.channels {
            let groups = channel.groups.iter().filter(|group| group.number < 8);
            variables.channels[channel.number].coupling_groups = groups.fold(0, |all, group| all | 1 << group.number);
            variables.channels[channel.number].block = channel.block();
        }
        if !Arc::ptr_eq(&variables.parameters, &self.in_effect) {
            variables.parameters = Arc::clone(&self.in_effect);
        }
        variables.alarms.publish(self.pending.iter());
        if variables.messages != self.pending.counts {
            variables.messages.clone_from(&self.pending.counts);
        }
    }

    fn axis_bits(&self, number: AxisNumber) -> AxisFromCnc {
        let axis = &self.axes[number];
        let mut bits = AxisFromCnc::default();
        bits.set_drive_enable_request(true);
        bits.set_drive_enable_state(axis.units.drive_enable);
        bits.set_feed_enable_request(true);
        bits.set_feed_enable_state(axis.units.feed_enable);
        bits.set_gantry_on_state(axis.units.gantry_on);
        bits.set_drive_ready(axis.feedback.drive_ready && !axis.feedback.drive_fault);
        bits.set_homed(axis.homed);
        bits.set_homing(axis.run.is_some());
        bits.set_in_position(axis.is_powered() && axis.is_in_position());
        bits.set_error(axis.error.is_some());
        bits.set_error_not_resettable(axis.error == Some(AxisError::Locked));
        bits.set_gantry_master(axis.parameters.is_master);
        bits.set_gantry_slave(axis.parameters.is_slave);
        bits.set_gantry_coupled(self.is_coupled(number));
        bits.set_axis_state(self.axis_state(number));
        bits.set_log_ax_n_r(axis.parameters.number);
        bits.set_axis_type_r(axis.parameters.kind);
        bits
    }

    /// Whether an axis is coupled now, as master or slave, in a combination or a coupling group.
    fn is_coupled(&self, number: AxisNumber) -> bool {
        let member = |mut members: Box<dyn Iterator<Item = AxisNumber> + '_>| members.any(|member| member == number);
        self.combinations
            .iter()
            .any(|one| (!one.coupling.is_open() || one.homes_at_once) && member(Box::new(one.coupling.members())))
            || self.channels.iter().any(|channel| {
                channel.couplings().any(|coupling| !coupling.is_open() && member(Box::new(coupling.members())))
            })
    }

    fn axis_state(&self, number: AxisNumber) -> u8 {
        let axis = &self.axes[number];
        if axis.error.is_some() {
            ERROR
        } else if !axis.is_powered() || !axis.units.feed_enable || self.is_held(number) {
            HOLD
        } else if !axis.setpoint.is_at_rest() {
            ACTIVE
        } else {
            READY
        }
    }

    /// Whether the channel of an axis holds a movement of it.
    fn is_held(&self, number: AxisNumber) -> bool {
        let members = self.coupled_with(number);
        self.channels.iter().any(|channel| channel.is_held() && members.iter().any(|member| channel.moves(*member)))
    }

    fn axis_values(&self, number: AxisNumber) -> AxisValues {
        let axis = &self.axes[number];
        let difference = |coupling: &crate::motion::coupling::Coupling| {
            coupling.difference(number, &super::state::AxesView(&self.axes))
        };
        let hard = self.combinations.iter().filter(|one| !one.coupling.is_open()).map(|one| &one.coupling);
        let soft = self.channels.iter().flat_map(|channel| channel.couplings());
        let position = axis.actual();
        AxisValues {
            position,
            setpoint: axis.setpoint.position,
            // mm/min, or rev/min of a rotary axis.
            velocity: axis.feedback.velocity / Position::PER_USER_UNIT * 60.0
                / if axis.parameters.is_rotary { 360.0 } else { 1.0 },
            following_error: axis.following_error(),
            slide: axis.feedback.slide,
            synchronism_difference: hard.chain(soft).find_map(difference).unwrap_or(Position::ZERO),
            encoders: [position, Position::ZERO],
            distance_to_go: self.distance_to_go(number),
            ..AxisValues::default()
        }
    }

    fn distance_to_go(&self, number: AxisNumber) -> Position {
        let target = self.channels.iter().find_map(|channel| channel.target(number));
        target.map_or(Position::ZERO, |target| target - self.axes[number].setpoint.position)
    }

    /// The event behind a bit of an axis.
    pub(super) fn axis_cause(&mut self, number: AxisNumber, byte: u16, bit: u8) -> EventId {
        let causes = self.axes[number].causes;
        let is = |signal: crate::image::Signal| (signal.byte, signal.bit) == (byte, bit);
        let cause = if is(axis_from_cnc::drive_enable_state) {
            causes.drive_enable
        } else if is(axis_from_cnc::feed_enable_state) {
            causes.feed_enable
        } else if is(axis_from_cnc::gantry_on_state) {
            causes.gantry_on
        } else if is(axis_from_cnc::drive_ready) {
            return self.ready_cause(number);
        } else if is(axis_from_cnc::homed) {
            causes.homed
        } else if is(axis_from_cnc::homing) {
            causes.homing
        } else if is(axis_from_cnc::error) || is(axis_from_cnc::error_not_resettable) {
            causes.error
        } else if is(axis_from_cnc::gantry_coupled) {
            causes.coupled
        } else if is(axis_from_cnc::in_position) {
            return self.motion_cause(number);
        } else if byte == axis_from_cnc::axis_state.byte {
            if self.axes[number].error.is_some() {
                causes.error
            } else if self.axis_state(number) == READY {
                self.log.note_plain(Place::Axis(number), Why::Rests, causes.motion)
            } else {
                return self.motion_cause(number);
            }
        } else {
            self.power_on
        };
        if cause.is_some() { cause } else { self.power_on }
    }

    /// Why a drive is ready or not, as it is now.
    fn ready_cause(&mut self, number: AxisNumber) -> EventId {
        let Axis { feedback, causes, .. } = &self.axes[number];
        let (place, parent) = (Place::Axis(number), causes.ready);
        if feedback.drive_fault {
            return self.log.note_one(place, Why::DriveFault, Input::Fault(FaultName::DriveFault), parent);
        }
        let why = if feedback.drive_ready { Why::DriveStarted } else { Why::DriveNotReady };
        self.log.note_plain(place, why, self.power_on)
    }

    /// Why an axis is in position, moves or is held, as it is now.
    fn motion_cause(&mut self, number: AxisNumber) -> EventId {
        let axis = &self.axes[number];
        let parent = axis.causes.motion;
        let why = if !axis.is_powered() {
            Why::DriveNotReady
        } else if !axis.units.feed_enable || self.is_held(number) {
            Why::Held
        } else if !axis.setpoint.is_at_rest() {
            Why::Moves
        } else if axis.is_in_position() {
            Why::Stands
        } else {
            Why::LeavesPosition
        };
        let quantity = crate::variables::Quantity::Deviation;
        let input = Input::Length(quantity, number, axis.following_error());
        self.log.note_one(Place::Axis(number), why, input, parent)
    }

    /// The event behind a bit of a channel.
    pub(super) fn channel_cause(&mut self, number: ChannelNumber, byte: u16, bit: u8) -> EventId {
        let Some(channel) = self.channels.iter().find(|channel| channel.number == number) else {
            return self.power_on;
        };
        let is = |signal: crate::image::Signal| (signal.byte, signal.bit) == (byte, bit);
        let causes = &channel.causes;
        let cause = if is(channel_from_cnc::error) {
            causes.error
        } else if is(channel_from_cnc::program_active) || is(channel_from_cnc::program_completed) {
            causes.program
        } else if byte == channel_from_cnc::state.byte {
            causes.program.max(causes.error)
        } else if byte >= channel_from_cnc::block.byte && channel.block() != 0 {
            // Blocks are fetched ahead of the path: the cause names the one that runs.
            let (place, input, started) = (Place::Channel(number), block_name(channel.block()), causes.started);
            return self.log.note_one(place, Why::BlockRuns, Input::Block(input), started);
        } else if byte >= channel_from_cnc::block.byte {
            causes.program
        } else {
            causes.feed_override
        };
        if cause.is_some() { cause } else { self.power_on }
    }
}

/// A block as it is shown.
pub(super) fn block_name(number: u32) -> BlockName {
    let mut name = BlockName::new();
    let _ = write!(name, "N{number}");
    name
}
