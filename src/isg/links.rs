//! The soft gantry: coupling groups that programs define, switch on and switch off (SG-01 to SG-25), as a policy over the coupling engine.

use super::channel::Channel;
use super::combination::POLICY;
use super::groups::Group;
use super::language::{AxisReference, Form, Link, LinkOff, Pair};
use super::messages;
use super::parameters::{Clearing, GANTRY_BITS, length, velocity};
use super::pending::{Detail, of_axis};
use super::phases::LinkPhase;
use super::refused::{Refused, unknown, value};
use super::rules::Why;
use super::state::{AxesView, AxisError, State};
use crate::motion::coupling::{Coupling, Follower, Moves, OffsetSource, Realign, Sign, Target, TwoStage};
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place, Quantity};

/// Coupling groups 0 to 6: 0 is of the channel list (SG-14).
pub(super) const GROUPS: i64 = 7;

impl State {
    /// Defines a group (SG-01, SG-02, SG-14, SG-20).
    pub(super) fn define_link(&mut self, index: usize, link: &Link) -> Result<(), Refused> {
        let channel = &mut self.channels[index];
        let number = group_number(link.group).filter(|number| *number != 0);
        let number = number.ok_or_else(|| Refused::group(messages::GROUP_OUT_OF_RANGE, link.group))?;
        if channel.groups.iter().any(|group| group.number == number) {
            return Err(Refused::group(messages::GROUP_ACTIVE, link.group));
        }
        if link.pairs.len() > PAIRS {
            return Err(value(&format!("a coupling group has at most {PAIRS} pairs, found {}", link.pairs.len())));
        }
        let named: Vec<&str> =
            link.pairs.iter().flat_map(|pair| [&pair.slave, &pair.master]).filter_map(name_of).collect();
        if let Some(name) = named.iter().find(|name| channel.axis_named(name).is_none()) {
            return Err(unknown(name));
        }
        channel.definitions.insert(number, link.pairs.clone());
        Ok(())
    }

    /// Switches a group on; `None` is group 0 (SG-07).
    pub(super) fn switch_on(
        &mut self,
        index: usize,
        group: Option<i64>,
        why: Why,
        cause: EventId,
    ) -> Result<(), Refused> {
        let group = group.unwrap_or(0);
        let out_of_range = Refused::group(messages::GROUP_OUT_OF_RANGE, group);
        let number = group_number(group).ok_or(out_of_range)?;
        let channel = &self.channels[index];
        if channel.modal.compensation {
            return Err(Refused::new(messages::LINK_WITH_COMPENSATION));
        }
        if channel.groups.iter().any(|active| active.number == number) {
            return Ok(());
        }
        let definition = channel.definitions.get(&number).filter(|pairs| !pairs.is_empty());
        let definition = definition.ok_or_else(|| Refused::group(messages::LINK_UNASSIGNED, group))?;
        let mut pairs = self.checked_pairs(channel, definition, group)?;
        let by_list: Vec<bool> =
            definition.iter().map(|pair| matches!(pair.form, Form::Gantry { limits: None })).collect();
        for ((_, follower), _) in pairs.iter_mut().zip(by_list).filter(|(_, by_list)| *by_list) {
            follower.limits = self.limits_of_list(follower.axis, cause);
        }
        let channel = &self.channels[index];
        let mut couplings: Vec<Coupling> = Vec::new();
        let mut masters: Vec<AxisNumber> = pairs.iter().map(|(master, _)| *master).collect();
        masters.sort_unstable();
        masters.dedup();
        for master in masters {
            let followers = pairs.iter().filter(|(other, _)| *other == master).map(|(_, follower)| *follower);
            let Some(mut coupling) = Coupling::new(master, POLICY, followers) else { continue };
            coupling.start_up(&AxesView(&self.axes));
            couplings.push(coupling);
        }
        let channel_number = channel.number;
        let event = self.log.note_plain(Place::Channel(channel_number), why, cause);
        for member in couplings.iter().flat_map(Coupling::members) {
            self.axes[member].causes.coupled = event;
        }
        let mut group = Group { number, couplings, ending: false, phase: LinkPhase::Inactive };
        Self::note_group(self.link_rows(), &mut group, why);
        let channel = &mut self.channels[index];
        channel.groups.push(group);
        channel.last_group = number;
        Ok(())
    }

    /// The limits of the list of a slave that a pair without printed limits monitors. Values out of their ranges are messages, as they are
    /// at the start on a slave by list (HG-06, O-34).
    fn limits_of_list(&mut self, slave: AxisNumber, cause: EventId) -> Option<TwoStage> {
        let (limits, messages) = self.lists.gantry_pair(self.axes[slave].parameters.number)?;
        for message in &messages {
            self.raise_check(message, Why::PairCheck, cause);
        }
        self.axes[slave].parameters.correction_velocity = velocity(limits.correction_velocity);
        Some(TwoStage::new(Some(length(limits.first.into())), length(limits.second.into())))
    }

    /// The pairs with their axes, or why the group cannot become active. Nothing of it does then (SG-22).
    fn checked_pairs(
        &self,
        channel: &Channel,
        definition: &[Pair],
        group: i64,
    ) -> Result<Vec<(AxisNumber, Follower)>, Refused> {
        let mut pairs = Vec::with_capacity(definition.len());
        for pair in definition {
            let missing = |reference: &AxisReference| {
                Refused(messages::LINK_AXIS_MISSING, Detail::Text(reference.bare()), Detail::Number(group))
            };
            let find =
                |reference: &AxisReference| self.referenced(channel, reference).ok_or_else(|| missing(reference));
            let (slave, master) = (find(&pair.slave)?, find(&pair.master)?);
            let of_pair = |number| {
                let text = format!("ax{} of group {group}", self.axes[master].parameters.number);
                Refused(number, Detail::Axis(slave), Detail::Text(text))
            };
            if channel.index_of(slave).is_some_and(|index| index <= 2) {
                return Err(Refused::axis(messages::SLAVE_IS_MAIN_AXIS, slave));
            }
            let [one, other] = [master, slave].map(|axis| &self.axes[axis].parameters);
            if one.kind != other.kind {
                return Err(of_pair(messages::TYPES_DIFFER));
            }
            if one.mode & !GANTRY_BITS != other.mode & !GANTRY_BITS {
                return Err(of_pair(messages::MODES_DIFFER));
            }
            if channel.manual.contains(&slave) {
                return Err(Refused::axis(messages::SLAVE_IN_MANUAL, slave));
            }
            let active = channel.groups.iter().flat_map(|group| {
                group.couplings.iter().map(move |coupling| (Detail::Number(group.number.into()), coupling))
            });
            for (other, coupling) in active {
                if coupling.followers().any(|axis| axis == slave) {
                    return Err(Refused(messages::ALREADY_SLAVE, Detail::Axis(slave), other));
                }
                if coupling.leader() == slave {
                    return Err(Refused(messages::SLAVE_IS_MASTER, Detail::Axis(slave), other));
                }
                if coupling.followers().any(|axis| axis == master) {
                    return Err(Refused(messages::MASTER_IS_SLAVE, Detail::Axis(master), other));
                }
            }
            let limits = match pair.form {
                Form::Gantry { limits: Some([first, second]) } => {
                    Some(TwoStage::new(Some(Position::from_user(first)), Position::from_user(second)))
                }
                // The list may leave them out; `check_gantry_pairs` then gives the nearest allowed ones.
                Form::Gantry { limits: None } => self.axes[slave].parameters.limits,
                Form::Bare | Form::Standard | Form::Factor { .. } => None,
            };
            let factor = if pair.form.factor() < 0 { Sign::Minus } else { Sign::Plus };
            pairs.push((master, Follower { axis: slave, factor, offset: OffsetSource::AtActivation, limits }));
        }
        Ok(pairs)
    }

    pub(super) fn referenced(&self, channel: &Channel, reference: &AxisReference) -> Option<AxisNumber> {
        match reference {
            AxisReference::Name(name) => channel.axis_named(name),
            AxisReference::Number(number) => {
                let axis = self.axis_of(u16::try_from(*number).ok()?)?;
                channel.index_of(axis).map(|_| axis)
            }
        }
    }

    /// Switches groups off (SG-07).
    pub(super) fn switch_off(&mut self, index: usize, what: LinkOff, cause: EventId) -> Result<(), Refused> {
        let channel = &self.channels[index];
        if channel.modal.compensation {
            return Err(Refused::new(messages::LINK_WITH_COMPENSATION));
        }
        let numbers: Vec<u16> = match what {
            LinkOff::All => channel.groups.iter().map(|group| group.number).collect(),
            LinkOff::Last => vec![channel.last_group],
            LinkOff::Group(group) => {
                let number = group_number(group);
                vec![number.ok_or_else(|| Refused::group(messages::GROUP_OUT_OF_RANGE, group))?]
            }
        };
        self.end_groups(index, &numbers, Why::GroupOff, cause);
        Ok(())
    }

    /// Ends groups: their slaves are independent.
    pub(super) fn end_groups(&mut self, index: usize, numbers: &[u16], why: Why, cause: EventId) {
        let channel = &mut self.channels[index];
        let ends = |group: &Group| numbers.contains(&group.number);
        if !channel.groups.iter().any(ends) {
            return;
        }
        let event = self.log.note_plain(Place::Channel(channel.number), why, cause);
        for group in channel.groups.iter().filter(|group| ends(group)) {
            for member in group.couplings.iter().flat_map(Coupling::members) {
                self.axes[member].causes.coupled = event;
            }
        }
        let rows = &mut self.log.taken.0;
        for group in channel.groups.iter_mut().filter(|group| ends(group)) {
            Self::note_group(&mut rows[super::phases::LINK], group, why);
        }
        channel.groups.retain(|group| !ends(group));
        // The group before it counts as the last one that was switched on.
        if numbers.contains(&channel.last_group) {
            channel.last_group = channel.groups.last().map_or(channel.last_group, |group| group.number);
        }
    }

    /// A reset ends all groups; differences that it clears are cleared first (SG-04, SG-09).
    pub(super) fn reset_groups(&mut self, index: usize, cause: EventId) {
        let Self { channels, axes, log, .. } = self;
        let channel = &mut channels[index];
        let is_kept = channel.retains_axes;
        if channel.restores_after_reset && !is_kept && !channel.groups.is_empty() {
            channel.restored = channel.groups.iter().map(|group| group.number).collect();
            channel.restored_from_end = false;
        }
        for group in &mut channel.groups {
            for coupling in group.couplings.iter_mut().filter(|coupling| coupling.is_closed()) {
                let view = AxesView(axes);
                let apart = |slave| coupling.setpoint_misalignment(slave, &view).unwrap_or(Position::ZERO);
                let clears = coupling.followers().find(|slave| {
                    let axis = &axes[*slave];
                    axis.error != Some(AxisError::Locked)
                        && axis.is_powered()
                        && axis.parameters.correction_velocity > 0.0
                        && axis.parameters.clearing == Clearing::ResetOrUnit
                        && coupling.is_monitored(*slave)
                        && apart(*slave) != Position::ZERO
                });
                if let Some(slave) = clears {
                    group.ending = !is_kept;
                    let input = Input::Length(Quantity::SynchronismDifference, slave, apart(slave));
                    let event = log.note_one(Place::Axis(slave), Why::ClearingBegins, input, cause);
                    for follower in coupling.followers() {
                        axes[follower].causes.motion = event;
                    }
                    let view = AxesView(axes);
                    coupling
                        .begin_realignment(Realign { moves: Moves::Followers, target: Target::LeaderSetpoint }, &view);
                }
            }
        }
        if is_kept {
            // P-CHAN-00460.
            return;
        }
        let over: Vec<u16> = channel.groups.iter().filter(|group| !group.ending).map(|group| group.number).collect();
        self.end_groups(index, &over, Why::GroupEnds, cause);
    }

    /// Groups that a reset has switched off end when their differences are cleared.
    pub(super) fn finish_groups(&mut self) {
        for index in 0..self.channels.len() {
            let channel = &self.channels[index];
            let cleared = |group: &&Group| group.ending && group.couplings.iter().all(Coupling::is_closed);
            let over: Vec<u16> = channel.groups.iter().filter(cleared).map(|group| group.number).collect();
            if !over.is_empty() {
                let cause = channel.causes.reset;
                self.end_groups(index, &over, Why::GroupEnds, cause);
            }
        }
    }

    /// The program start switches groups on again (SG-09, SG-16, SG-17, SG-18). False if that is not possible.
    pub(super) fn restore_groups(&mut self, index: usize, cause: EventId) -> bool {
        for number in std::mem::take(&mut self.channels[index].restored) {
            let channel = &self.channels[index];
            let definition = channel.definitions.get(&number);
            let in_configuration = |reference: &AxisReference| {
                let axis = self.referenced(channel, reference);
                axis.is_some_and(|axis| channel.configured.iter().any(|member| member.axis == axis))
            };
            let is_complete = definition.is_some_and(|pairs| {
                pairs.iter().all(|pair| in_configuration(&pair.slave) && in_configuration(&pair.master))
            });
            let restored = if is_complete {
                self.switch_on(index, Some(number.into()), Why::GroupRestored, cause)
            } else {
                let from_end = channel.restored_from_end;
                let message = if from_end { messages::LINK_NOT_KEPT } else { messages::LINK_NOT_RESTORED };
                Err(Refused::group(message, number.into()))
            };
            if let Err(refused) = restored {
                self.raise_in_channel(index, None, refused, cause);
                return false;
            }
        }
        true
    }

    /// Differences that are still beyond a limit after they were cleared stop the axes again.
    pub(super) fn trip_again(&mut self) {
        let view = AxesView(&self.axes);
        let base = |coupling: &Coupling, slave| coupling.limits(slave, &view).and_then(|(_, second)| second.base);
        let beyond: Vec<(AxisNumber, Position, Option<Position>, bool)> = self
            .combinations
            .iter()
            .map(|one| &one.coupling)
            .filter(|coupling| coupling.is_closed())
            .flat_map(|coupling| coupling.differences().map(move |found| (coupling, found)))
            .filter(|(_, (axis, _, stage))| (stage.first || stage.second) && self.axes[*axis].error.is_none())
            .map(|(coupling, (axis, difference, stage))| (axis, difference, base(coupling, axis), stage.second))
            .collect();
        for (slave, difference, base, is_locked) in beyond {
            let (number, error, why) = if is_locked {
                (messages::STAGE_2, AxisError::Locked, Why::StageTwo)
            } else {
                (messages::STAGE_1, AxisError::Resettable, Why::StageOne)
            };
            let inputs = self.beyond(slave, difference, base, is_locked);
            let event = self.log.note(Place::Axis(slave), why, inputs, self.axes[slave].causes.motion);
            self.pending.raise(of_axis(number, slave), None, event);
            self.axis_error(slave, error, event);
        }
    }
}

/// Pairs of a group.
const PAIRS: usize = 15;

fn group_number(group: i64) -> Option<u16> {
    u16::try_from(group).ok().filter(|number| i64::from(*number) < GROUPS)
}

fn name_of(reference: &AxisReference) -> Option<&str> {
    match reference {
        AxisReference::Name(name) => Some(name),
        AxisReference::Number(_) => None,
    }
}
