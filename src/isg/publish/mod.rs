//! The CNC's half of the HLI, and the variables. `causes.rs` has the events behind the signals, `conditions.rs` what they wait for.

mod causes;
mod conditions;

use std::sync::Arc;

use super::channel::Channel;
use super::hli::{AxisFromCnc, FromCnc};
use super::state::{AxisError, State};
use crate::image::View;
use crate::units::{AxisNumber, Position};
use crate::variables::{AxisValues, Variables};

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
            from_cnc.skips[channel.number].set_program_block_ignore_state(channel.inputs.skipped);
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
        } else if !axis.is_powered() || !axis.units.feed_enable || self.holder(number).is_some() {
            HOLD
        } else if !axis.setpoint.is_at_rest() {
            ACTIVE
        } else {
            READY
        }
    }

    /// The channel that holds a movement of an axis.
    fn holder(&self, number: AxisNumber) -> Option<&Channel> {
        let members = self.coupled_with(number);
        let moves = |channel: &&Channel| members.iter().any(|member| channel.moves(*member));
        self.channels.iter().filter(|channel| channel.is_held()).find(moves)
    }

    fn axis_values(&self, number: AxisNumber) -> AxisValues {
        let axis = &self.axes[number];
        let difference = |coupling: &crate::motion::coupling::Coupling| {
            coupling.difference(number, &super::state::AxesView(&self.axes))
        };
        let hard = self.combinations.iter().filter(|one| !one.coupling.is_open()).map(|one| &one.coupling);
        let soft = self.channels.iter().flat_map(|channel| channel.couplings());
        let position = axis.shown(axis.actual());
        AxisValues {
            position,
            setpoint: axis.shown(axis.setpoint.position),
            // mm/min or degrees/min, as F.
            velocity: axis.feedback.velocity / Position::PER_USER_UNIT * 60.0,
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
}
