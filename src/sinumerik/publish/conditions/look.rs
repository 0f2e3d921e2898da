//! What conditions are computed from: the state after a cycle, what the control read from the PLC and the HMI in it, and names; and parts
//! of many conditions.

use crate::control::{self, Condition, Fact, Looks, fact};
use crate::image::{Names, NckHmi, Signal, ToNck};
use crate::nc_program::Library;
use crate::sinumerik::alarms::Alarm;
use crate::sinumerik::gantry::state::{Grouping, Phase};
use crate::sinumerik::inputs::required;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::state::{State, Unit};
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, Position};
use crate::variables::{Place, axis_name, place_name, six_decimals};

/// What conditions are computed from.
#[derive(Clone, Copy)]
pub(super) struct Look<'a> {
    pub(super) state: &'a State,
    pub(super) parameters: &'a Parameters,
    pub(super) library: &'a Library,
    pub(super) to_nck: &'a ToNck,
    pub(super) hmi: &'a NckHmi,
    pub(super) names: &'a Names,
}

/// The conditions of this control.
pub(super) struct Conditions;

impl Looks for Conditions {
    type At<'a> = Look<'a>;
}

/// The conditions of a signal.
pub(super) type Row<Owner> = control::Row<Conditions, Owner>;

impl<'a> Look<'a> {
    /// A block that the control does not write keeps all its bits at 0.
    pub(super) fn not_shown(self, place: Place, wanted: bool) -> Option<Condition> {
        let name = place_name(place, self.names);
        let (exists, is_silent) = match place {
            Place::Nck => (true, false),
            Place::ModeGroup(group) => (self.parameters.existing_mode_groups().any(|other| other == group), false),
            Place::Channel(channel) => (self.parameters.existing_channels().any(|(other, _)| other == channel), false),
            Place::Axis(axis) => (self.parameters.axes[axis].exists, self.parameters.axes[axis].silent),
        };
        let shown = if !exists {
            Fact::new(format!("{name} exists"), "no", "yes", false)
        } else if is_silent {
            Fact::new(format!("signals of the simulated axis {name} (MD30350)"), "off", "on", false)
        } else {
            return None;
        };
        Some(if wanted { shown.into() } else { Condition::from(shown).opposite() })
    }

    pub(super) fn axis(self, axis: AxisNumber, signal: Signal, wanted: bool) -> Condition {
        required(Place::Axis(axis), signal, wanted)
    }

    pub(super) fn channel(self, channel: ChannelNumber, signal: Signal, wanted: bool) -> Condition {
        required(Place::Channel(channel), signal, wanted)
    }

    /// Neither a signal nor a user alarm of an 828D with the same reaction disables something of a channel.
    pub(super) fn not_disabled(self, channel: ChannelNumber, signal: Signal, reaction: UserReaction) -> Condition {
        let own = self.channel(channel, signal, false);
        if self.parameters.user.is_none() {
            return own;
        }
        Condition::All(vec![own, self.user_alarm(reaction, false).into()])
    }

    /// Whether a user alarm with a reaction is active.
    pub(super) fn user_alarm(self, reaction: UserReaction, wanted: bool) -> Fact {
        let alarm = self.state.user.alarm(reaction);
        let found = alarm.map_or_else(|| "none".to_owned(), |alarm| alarm.to_string());
        let what = format!("user alarm with MD14516 bit {}", reaction as usize);
        Fact::new(what, found, if wanted { "one" } else { "none" }, alarm.is_some() == wanted)
    }

    pub(super) fn mode_group(self, group: ModeGroupNumber, signal: Signal, wanted: bool) -> Condition {
        required(Place::ModeGroup(group), signal, wanted)
    }

    pub(super) fn nck(self, signal: Signal, wanted: bool) -> Condition {
        required(Place::Nck, signal, wanted)
    }

    /// A signal of the PLC rises in this cycle; `was` is its value before.
    pub(super) fn rises(self, place: Place, signal: Signal, was: bool) -> Condition {
        let location = self.names.interface().location(&signal, place.block().1);
        let shown = location.map_or_else(
            || format!("{} of {}", signal.name, place_name(place, self.names)),
            |location| {
                let address = self.names.address(location).to_string();
                let symbol = self.names.symbol(location);
                symbol.map_or_else(|| address.clone(), |symbol| format!("{symbol} ({address})"))
            },
        );
        fact(format!("{shown} rises: it was 0 before"), !was).into()
    }

    pub(super) fn axis_name(self, axis: AxisNumber) -> String {
        axis_name(axis, self.names)
    }

    pub(super) fn channel_name(self, channel: ChannelNumber) -> String {
        place_name(Place::Channel(channel), self.names)
    }

    /// The unit of an axis.
    pub(super) fn unit(self, axis: AxisNumber) -> Unit {
        let mut units = self.state.units.iter();
        units
            .find(|unit| unit.set.contains(axis))
            .copied()
            .unwrap_or_else(|| Unit::single(axis, &self.state.owners, self.parameters))
    }

    /// What the stage of programs reads of a channel; `None` without programs.
    pub(super) fn stage(self, channel: ChannelNumber) -> Option<Stage<'a>> {
        let own = self.parameters.programs[channel].as_deref()?;
        Some(Stage { channel, parameters: self.parameters, own, to_nck: self.to_nck })
    }

    /// The grouping of a gantry axis.
    pub(super) fn grouping(self, axis: AxisNumber) -> Option<&'a Grouping> {
        self.state.groupings.iter().find(|grouping| grouping.coupling.members().any(|member| member == axis))
    }

    /// The closed grouping of a gantry axis.
    pub(super) fn closed_grouping(self, axis: AxisNumber) -> Option<&'a Grouping> {
        self.grouping(axis).filter(|grouping| grouping.phase != Phase::Open)
    }

    /// No alarm of this kind is pending.
    pub(super) fn no_alarm(self, what: String, meant: impl Fn(Place, &Alarm) -> bool) -> Condition {
        let is_meant = |place: Place, number| Alarm::find(number).is_some_and(|alarm| meant(place, alarm));
        let found = self.state.alarms.iter().find(|(raised, _)| is_meant(raised.place, raised.number));
        let found = found.map(|(raised, _)| {
            let cancel = Alarm::find(raised.number).map_or(String::new(), |alarm| alarm.cancel.to_string());
            let place = place_name(raised.place, self.names);
            format!("{} [{place}], cleared by {cancel}", Alarm::name(raised.number))
        });
        let holds = found.is_none();
        Fact::new(what, found.unwrap_or_else(|| "none".to_owned()), "none", holds).into()
    }
}

/// A length in user units.
pub(super) fn length(position: Position) -> String {
    six_decimals(position.user())
}
