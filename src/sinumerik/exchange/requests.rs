//! Requests for an axis that wait until it is free: those of the PLC (DBB8 of the axis), and GETD of a program.
//!
//! Called once per cycle before the units are formed. Reads 8.0 to 8.4 and 8.7; writes who has an axis. A request of the PLC is tested at the
//! rising edge of 8.4: a synchronous axis of a closed grouping (26072), a channel that does not know the axis (26072, or 10658 with 50XX for
//! the leading axis of a closed grouping: MIS-06), an axis that is always a PLC axis (26072), too many PLC axes (26070). Otherwise it waits,
//! with 68.4 = 1, until no block of a program uses the axis and the axis stands. A change of blocks waits for it.

use crate::image::{AxisToNck, ToNck, axis_to_nck};
use crate::sinumerik::alarms;
use crate::sinumerik::exchange::state::{Holder, Request, Wanted};
use crate::sinumerik::inputs::{axis_number, axis_signal};
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::{State, Unit};
use crate::units::{AxisNumber, AxisSet, ChannelNumber};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place};

/// The largest number of PLC axes (FB2, P2).
const MOST_PLC_AXES: usize = 12;

/// Code 50XX of alarm 10658: the PLC asks for the leading axis, and not all axes are known in the channel.
const UNKNOWN_IN_CHANNEL_OF_PLC: i64 = 5_000;

impl Nck {
    /// Requests of the PLC for the axes whose signals have changed, and requests that waited. Before that, the groupings that are to close
    /// compare who has their axes.
    pub(in crate::sinumerik) fn exchange_axes(&mut self, changed: AxisSet, to_nck: &ToNck) {
        let keeps_open = self.state.check_closings(&self.parameters);
        self.state.answer_requests(changed, &self.parameters, to_nck);
        if self.state.owners.take_changed() || keeps_open {
            self.resting.wake_all();
        }
    }
}

impl State {
    /// Takes the requests of the PLC for these axes, whose signals have changed, and carries out those that can be.
    fn answer_requests(&mut self, changed: AxisSet, parameters: &Parameters, to_nck: &ToNck) {
        for axis in changed.and(parameters.existing).iter() {
            let signals = &to_nck.axes[axis];
            let strobe = signals.replacement_activation_signal();
            let was = std::mem::replace(&mut self.owners.of_mut(axis).strobe_was, strobe);
            if strobe && !was {
                self.take_request(axis, signals, parameters);
            }
        }
        for axis in self.owners.requested.iter() {
            self.carry_out_request(axis, parameters);
        }
    }

    /// The rising edge of 8.4.
    fn take_request(&mut self, axis: AxisNumber, signals: &AxisToNck, parameters: &Parameters) {
        let by_plc = signals.request_plc_axis();
        let inputs = [
            axis_signal(axis, axis_to_nck::replacement_activation_signal, true),
            axis_signal(axis, axis_to_nck::request_plc_axis, by_plc),
            axis_number(axis, axis_to_nck::replacement_channel_number, signals.replacement_channel_number()),
        ];
        let event = self.log.note(Place::Axis(axis), Rule::ExchangeRequested, inputs, EventId::NONE);
        let wanted = if by_plc { Wanted::PlcAxis } else { Wanted::GivenByPlc };
        let number = signals.replacement_channel_number();
        let own = self.owners.of(axis).channel;
        let channel = if number == 0 { Some(own) } else { ChannelNumber::new(number) };
        match self.exchange_refusal(axis, channel, wanted, parameters) {
            Some((alarm, channel, unit)) => self.refuse_exchange(axis, (alarm, channel), unit, event, parameters),
            None => self.request_axis(axis, Request { channel: channel.unwrap_or(own), by: wanted, cause: event }),
        }
    }

    /// An axis waits for an exchange, in the place of an earlier request.
    pub(in crate::sinumerik) fn request_axis(&mut self, axis: AxisNumber, request: Request) {
        let of = self.owners.of_mut(axis);
        if of.request.is_none_or(|known| (known.channel, known.by) != (request.channel, request.by)) {
            of.request = Some(request);
            if request.by.is_by_plc() {
                of.cause = request.cause;
            }
        }
        self.owners.requested.set(axis, true);
    }

    /// The alarm with which the NCK refuses a request of the PLC, its channel, and the closed grouping that it concerns.
    fn exchange_refusal(
        &self,
        axis: AxisNumber,
        channel: Option<ChannelNumber>,
        wanted: Wanted,
        parameters: &Parameters,
    ) -> Option<(AlarmNumber, ChannelNumber, Option<Unit>)> {
        let own = self.owners.of(axis).channel;
        let data = parameters.axes[axis].plc_axis;
        let impossible = Some((alarms::axis_exchange::NO_PLC_AXIS, own, None));
        // A synchronous axis of a closed grouping leads no unit.
        let Some(unit) = self.unit_of(axis) else { return impossible };
        let exists = |channel: &ChannelNumber| parameters.existing_channels().any(|(other, _)| other == *channel);
        let Some(target) = channel.filter(exists) else { return impossible };
        let known = parameters.channels[target].known;
        if !known.has_all_of(unit.set) {
            let closed = Some((alarms::IMPERMISSIBLE_AXIS_STATE, own, Some(unit)));
            return if unit.grouping.is_some() { closed } else { impossible };
        }
        let refused = match wanted {
            Wanted::PlcAxis => parameters.only_reserved_plc_axes && !data.is_reserved(),
            Wanted::GivenByPlc => data.is_reserved(),
            Wanted::TakenDirectly => false,
        };
        if refused {
            return impossible;
        }
        let plc_axes = self.owners.held_by(Holder::Plc).without(unit.set).iter().count();
        let too_many = wanted == Wanted::PlcAxis && plc_axes + usize::from(unit.count) > MOST_PLC_AXES;
        too_many.then_some((alarms::axis_exchange::TOO_MANY_PLC_AXES, own, None))
    }

    fn refuse_exchange(
        &mut self,
        axis: AxisNumber,
        (alarm, channel): (AlarmNumber, ChannelNumber),
        closed: Option<Unit>,
        event: EventId,
        parameters: &Parameters,
    ) {
        let grouping =
            closed.and_then(|unit| unit.grouping).map(|index| &parameters.groupings.groupings[usize::from(index)]);
        let code = grouping.map_or(Parameter::None, |definition| {
            Parameter::Number(UNKNOWN_IN_CHANNEL_OF_PLC + i64::from(definition.number))
        });
        let event = self.log.note_plain(Place::Axis(axis), Rule::ExchangeRefused, event);
        let parameters = [Parameter::Channel(channel), Parameter::Axis(axis), code, Parameter::None];
        self.alarms.raise(alarm, Place::Axis(axis), parameters, event);
    }

    /// An axis with a request gets its new holder when it is free.
    fn carry_out_request(&mut self, axis: AxisNumber, parameters: &Parameters) {
        let Some(request) = self.owners.of(axis).request else { return };
        let Some(unit) = self.unit_of(axis) else { return };
        let of = *self.owners.of(axis);
        let there_already = match request.by {
            Wanted::PlcAxis => of.holder == Holder::Plc,
            Wanted::GivenByPlc | Wanted::TakenDirectly => of.holder == Holder::Program && of.channel == request.channel,
        };
        if !there_already {
            if !self.is_exchange_possible(&unit) || !self.stands_free(&unit) {
                return;
            }
            self.hand_over(&unit, request.channel, request.by.rule(), [Input::None; 3], request.cause, parameters);
        } else if request.by.is_by_plc() {
            // Nothing to change: the request ends.
            let event = self.log.note_plain(Place::Axis(axis), Rule::ExchangeDone, request.cause);
            self.owners.of_mut(axis).cause = event;
        }
        self.owners.of_mut(axis).request = None;
        self.owners.requested.set(axis, false);
    }

    /// All axes of a unit get another holder.
    pub(in crate::sinumerik) fn hand_over(
        &mut self,
        unit: &Unit,
        channel: ChannelNumber,
        by: Rule,
        inputs: [Input; 3],
        cause: EventId,
        parameters: &Parameters,
    ) {
        let before = *self.owners.of(unit.leader());
        for axis in unit.members() {
            self.owners.step((axis, channel), by, &mut self.log, inputs, cause);
        }
        if before.holder == Holder::Program {
            // What is prepared ahead may name the axis.
            self.prepare_again(before.channel, parameters);
        }
    }

    /// Whether no block of a program uses the axes of a unit, and they are not positioned alone: 68.5.
    pub(in crate::sinumerik) fn is_exchange_possible(&self, unit: &Unit) -> bool {
        !self.owners.used.contains(unit.leader())
    }

    /// Whether the axes of a unit stand, and nothing is to move them.
    fn stands_free(&self, unit: &Unit) -> bool {
        unit.members().all(|number| {
            let axis = &self.axes[number];
            let jogged = axis.jogging.movement != Movement::None;
            axis.setpoint.is_at_rest() && !axis.travel.is_pending() && !axis.approach.is_running() && !jogged
        })
    }

    /// Whether someone asks for an axis of the programs of a channel: then its next block waits.
    pub(in crate::sinumerik) fn is_axis_wanted(&self, channel: ChannelNumber) -> bool {
        self.owners.requested.iter().any(|axis| self.owners.is_program_axis(axis, channel))
    }
}
