//! Who holds each axis, and the table of all transitions.

use serde::{Deserialize, Serialize};

use crate::control::{Log, Transition, next, row};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel};
use crate::variables::{EventId, Input, Place};

/// Who moves an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Holder {
    /// A channel axis: programs of its channel may name it.
    #[default]
    Program,
    /// Neutral: 68.6. A program takes it with GET, the PLC with DBB8, a synchronised action by moving it.
    Neutral,
    /// PLC axis: 68.7.
    Plc,
    /// Command axis: a synchronised action moves it.
    Command,
}

impl Holder {
    /// A short text.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Program => "channel axis",
            Self::Neutral => "neutral axis",
            Self::Plc => "PLC axis",
            Self::Command => "command axis",
        }
    }
}

/// All transitions of an axis. The channel that has it can change with each of them.
pub const TRANSITIONS: &[Transition<Holder, Rule>] = &[
    row(Holder::Program, Rule::ReleasedByProgram, Holder::Neutral),
    row(Holder::Program, Rule::NeutralAfterReset, Holder::Neutral),
    row(Holder::Program, Rule::TakenByProgram, Holder::Program),
    row(Holder::Program, Rule::TakenByPlc, Holder::Plc),
    row(Holder::Program, Rule::GivenToChannel, Holder::Program),
    row(Holder::Program, Rule::TakenByAction, Holder::Command),
    row(Holder::Neutral, Rule::TakenByProgram, Holder::Program),
    row(Holder::Neutral, Rule::ReturnedToChannel, Holder::Program),
    row(Holder::Neutral, Rule::TakenByPlc, Holder::Plc),
    row(Holder::Neutral, Rule::GivenToChannel, Holder::Program),
    row(Holder::Neutral, Rule::TakenByAction, Holder::Command),
    row(Holder::Plc, Rule::GivenToChannel, Holder::Program),
    row(Holder::Command, Rule::TakenByProgram, Holder::Program),
    row(Holder::Command, Rule::ReturnedToChannel, Holder::Program),
    row(Holder::Command, Rule::NeutralAfterReset, Holder::Neutral),
    row(Holder::Command, Rule::TakenByPlc, Holder::Plc),
    row(Holder::Command, Rule::GivenToChannel, Holder::Program),
];

const _: () = assert!(TRANSITIONS.len() <= u64::BITS as usize);

/// Index of the axis exchange among the charts of this control.
pub(in crate::sinumerik) const EXCHANGE_CHART: usize = 2;

/// A request that waits until the axis stands and no block uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Request {
    /// The channel that is to get the axis.
    pub channel: ChannelNumber,
    pub by: Wanted,
    /// The event of the request.
    pub cause: EventId,
}

/// What an axis is to become.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Wanted {
    /// PLC axis: 8.7 = 1 with the edge of 8.4.
    PlcAxis,
    /// Axis of the channel: 8.7 = 0 with the edge of 8.4.
    GivenByPlc,
    /// Axis of the channel: GETD of a program.
    TakenDirectly,
}

impl Wanted {
    /// The PLC has asked: 68.4.
    pub(in crate::sinumerik) const fn is_by_plc(self) -> bool {
        matches!(self, Self::PlcAxis | Self::GivenByPlc)
    }

    pub(in crate::sinumerik) const fn rule(self) -> Rule {
        match self {
            Self::PlcAxis => Rule::TakenByPlc,
            Self::GivenByPlc => Rule::GivenToChannel,
            Self::TakenDirectly => Rule::TakenByProgram,
        }
    }
}

/// The axes that a program wants.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Claim {
    pub axes: AxisSet,
    /// GETD, or MD30552 = 2.
    pub direct: bool,
}

/// One axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Ownership {
    pub holder: Holder,
    /// The channel that has it, or had it last: 68.0 to 68.3.
    pub channel: ChannelNumber,
    /// WAITP made it neutral: another channel does not take it automatically (MD10722 bit 0).
    pub stays_in_channel: bool,
    /// The latest transition, or the latest request or its end.
    pub cause: EventId,
    /// The event behind 68.5.
    pub possible_cause: EventId,
    pub request: Option<Request>,
    /// 8.4 in the last cycle.
    pub strobe_was: bool,
}

/// All axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Owners {
    axes: PerAxis<Ownership>,
    of_channel: PerChannel<AxisSet>,
    /// The axes with a request.
    pub requested: AxisSet,
    /// The axes that a block of a program uses.
    pub used: AxisSet,
    /// Someone got an axis since the last call of [`Owners::take_changed`].
    changed: bool,
}

impl Owners {
    /// After power on: each axis is in its channel (MD30550); it is neutral with MD30450 = 1, and a PLC axis with MD30460 bit 4 or 5. The
    /// axes of a closed grouping are what their leading axis is (DEF-11).
    pub(in crate::sinumerik) fn new(parameters: &Parameters) -> Self {
        let holder = |axis: AxisNumber| {
            let data = &parameters.axes[axis];
            if data.plc_axis.is_reserved() {
                Holder::Plc
            } else if data.gantry.concurrent {
                Holder::Neutral
            } else {
                Holder::Program
            }
        };
        let mut owners = Self {
            axes: PerAxis::from_fn(|axis| Ownership {
                holder: holder(axis),
                channel: parameters.axes[axis].channel,
                stays_in_channel: false,
                cause: EventId::NONE,
                possible_cause: EventId::NONE,
                request: None,
                strobe_was: false,
            }),
            of_channel: PerChannel::default(),
            requested: AxisSet::NONE,
            used: AxisSet::NONE,
            changed: false,
        };
        for grouping in &parameters.groupings.groupings {
            let is_open = grouping.coupling.members().any(|axis| parameters.axes[axis].gantry.broken_up);
            let leading = owners.axes[grouping.coupling.leader()];
            for axis in grouping.coupling.followers().filter(|_| !is_open) {
                owners.axes[axis] = leading;
            }
        }
        owners.count(parameters);
        owners
    }

    fn count(&mut self, parameters: &Parameters) {
        self.of_channel = PerChannel::from_fn(|channel| {
            parameters.existing().map(|(axis, _)| axis).filter(|axis| self.axes[*axis].channel == channel).collect()
        });
    }

    pub(in crate::sinumerik) fn of(&self, axis: AxisNumber) -> &Ownership {
        &self.axes[axis]
    }

    pub(in crate::sinumerik) fn of_mut(&mut self, axis: AxisNumber) -> &mut Ownership {
        &mut self.axes[axis]
    }

    /// The axes that a channel has, or had last.
    pub(in crate::sinumerik) fn of_channel(&self, channel: ChannelNumber) -> AxisSet {
        self.of_channel[channel]
    }

    /// Whether programs of this channel move the axis.
    pub(in crate::sinumerik) fn is_program_axis(&self, axis: AxisNumber, channel: ChannelNumber) -> bool {
        let of = &self.axes[axis];
        of.holder == Holder::Program && of.channel == channel
    }

    /// The axes that this holder has.
    pub(in crate::sinumerik) fn held_by(&self, holder: Holder) -> AxisSet {
        self.axes.iter().filter(|(_, of)| of.holder == holder).map(|(axis, _)| axis).collect()
    }

    /// Makes a transition of the table, for one axis. Returns its event.
    pub(in crate::sinumerik) fn step(
        &mut self,
        (axis, channel): (AxisNumber, ChannelNumber),
        by: Rule,
        log: &mut Log,
        inputs: [Input; 3],
        parent: EventId,
    ) -> EventId {
        let holder = next(TRANSITIONS, &mut log.taken.0[EXCHANGE_CHART], self.axes[axis].holder, by);
        let event = log.note(Place::Axis(axis), by, inputs, parent);
        let before = std::mem::replace(&mut self.axes[axis].channel, channel);
        self.of_channel[before].set(axis, false);
        self.of_channel[channel].set(axis, true);
        let of = &mut self.axes[axis];
        (of.holder, of.cause, of.stays_in_channel) = (holder, event, false);
        self.changed = true;
        event
    }

    /// Whether someone got an axis since the last call of [`Owners::take_changed`].
    pub(in crate::sinumerik) fn has_changed(&self) -> bool {
        self.changed
    }

    /// Whether someone got an axis since the last call.
    pub(in crate::sinumerik) fn take_changed(&mut self) -> bool {
        std::mem::take(&mut self.changed)
    }

    /// Whether an event at a place concerns a channel.
    pub(in crate::sinumerik) fn concerns_channel(
        &self,
        parameters: &Parameters,
        place: Place,
        channel: ChannelNumber,
    ) -> bool {
        match place {
            Place::Nck => true,
            Place::ModeGroup(group) => parameters.mode_group(channel) == group,
            Place::Channel(other) => other == channel,
            Place::Axis(axis) => self.axes[axis].channel == channel,
        }
    }

    /// Whether an event at a place concerns a mode group.
    pub(in crate::sinumerik) fn concerns_mode_group(
        &self,
        parameters: &Parameters,
        place: Place,
        group: ModeGroupNumber,
    ) -> bool {
        match place {
            Place::Nck => true,
            Place::ModeGroup(other) => other == group,
            Place::Channel(channel) => parameters.mode_group(channel) == group,
            Place::Axis(axis) => parameters.mode_group(self.axes[axis].channel) == group,
        }
    }
}
