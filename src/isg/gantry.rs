//! The hard gantry: combinations of a master and its slaves by parameter list (HG-01 to HG-29), as a policy over the coupling engine.

use super::combination::{Combination, POLICY};
use super::groups::Group;
use super::language::Form;
use super::messages;
use super::parameters::{AxisParameters, Clearing, tenths};
use super::pending::of_axis;
use super::phases::GantryPhase;
use super::rules::Why;
use super::state::{AxesView, Axis, AxisError, State};
use crate::motion::Limits;
use crate::motion::coupling::{
    Coupling, CouplingEvent, Events, Follower, Limit, Moves, OffsetSource, Progress, Realign, Target, TwoStage, What,
};
use crate::units::{AxisNumber, AxisSet, PerAxis, Position};
use crate::variables::{EventId, Input, Place, Quantity};

/// The combinations that the lists define, masters ascending.
pub(super) fn combinations(axes: &PerAxis<Axis>, cause: EventId) -> Vec<Combination> {
    let slaves_of = |master| {
        let of_master = move |(_, axis): &(AxisNumber, &Axis)| {
            axis.exists && axis.parameters.is_slave && axis.parameters.master == Some(master)
        };
        axes.iter().filter(of_master)
    };
    let masters = axes.iter().filter(|(_, axis)| axis.exists && axis.parameters.is_master);
    let with_slaves = masters.filter(|(master, _)| slaves_of(*master).next().is_some());
    with_slaves
        .filter_map(|(master, _)| {
            let followers = slaves_of(master).map(|(axis, slave)| Follower {
                offset: OffsetSource::Configured(slave.parameters.offset),
                ..Follower::new(axis)
            });
            let mut coupling = Coupling::new(master, POLICY, followers)?;
            coupling.start_up(&AxesView(axes));
            Some(Combination { coupling, homes_at_once: false, phase: GantryPhase::default(), cause })
        })
        .collect()
}

impl AxisParameters {
    /// Whether the difference of a slave is monitored: not with CONFIG (O-13), before homing only with P-AXIS-00249 (HG-08).
    fn is_monitored(&self, is_homed: bool) -> bool {
        self.clearing != Clearing::Never && (is_homed || self.checks_without_homing)
    }
}

impl State {
    /// The combination of a master or slave.
    pub(super) fn combination_of(&self, axis: AxisNumber) -> Option<usize> {
        self.combinations.iter().position(|one| one.coupling.members().any(|member| member == axis))
    }

    /// Whether an axis follows its master now.
    pub(super) fn is_coupled_slave(&self, axis: AxisNumber) -> bool {
        self.combinations
            .iter()
            .any(|one| !one.coupling.is_open() && one.coupling.followers().any(|follower| follower == axis))
    }

    /// Whether all slaves of a combination have CONFIG: a program may open it (O-14).
    pub(super) fn is_config(&self, combination: usize) -> bool {
        let mut slaves = self.combinations[combination].coupling.followers();
        slaves.all(|slave| self.axes[slave].parameters.clearing == Clearing::Never)
    }

    /// The smallest of a parameter over an axis and all that follow it, directly or through others.
    pub(super) fn smallest(&self, axis: AxisNumber, of: impl Fn(&AxisParameters) -> f64) -> f64 {
        let members = self.coupled_with(axis);
        members.into_iter().map(|member| of(&self.axes[member].parameters)).fold(f64::INFINITY, f64::min)
    }

    /// The offsets of the lists, after an update of a list at run time.
    pub(super) fn adopt_offsets(&mut self) {
        let Self { combinations, axes, .. } = self;
        for one in combinations {
            one.coupling.set_offsets(|slave| axes[slave].parameters.offset, &AxesView(axes));
        }
    }

    /// Starts to clear the differences that `gantry_on` clears, by the mode of each slave (HG-12, HG-21). On a master it counts for all its
    /// slaves (O-16).
    pub(super) fn clear_by_unit(&mut self, rising: AxisSet) {
        let Self { combinations, axes, .. } = self;
        for one in combinations.iter().filter(|one| !one.coupling.is_open()) {
            let leader = one.coupling.leader();
            for slave in one.coupling.followers() {
                let by_master = axes[leader].units.gantry_on;
                let is_on = axes[slave].units.gantry_on || by_master;
                let rises = rising.contains(slave) || rising.contains(leader);
                let apart = one.coupling.setpoint_misalignment(slave, &AxesView(axes));
                let unit = match axes[slave].parameters.clearing {
                    Clearing::ResetOrUnit | Clearing::Unit => is_on,
                    // An edge without a difference is over; one with a difference waits until the axes stand.
                    Clearing::Edge if rises => apart.is_some_and(|apart| apart != Position::ZERO),
                    Clearing::Edge => is_on && axes[slave].clears,
                    Clearing::Never => false,
                };
                axes[slave].clears = unit;
            }
        }
        let wanted: Vec<AxisNumber> = axes.iter().filter(|(_, axis)| axis.clears).map(|(axis, _)| axis).collect();
        for slave in wanted {
            let leader = self.axes[slave].parameters.master.unwrap_or(slave);
            let by = if self.axes[slave].units.gantry_on { slave } else { leader };
            self.clear_differences(|axis| axis.clears, self.axes[by].causes.gantry_on);
        }
    }

    /// Starts to clear the differences that a reset, or `gantry_on`, clears (HG-12).
    pub(super) fn clear_differences(&mut self, triggers: impl Fn(&Axis) -> bool, cause: EventId) {
        let Self { combinations, axes, log, .. } = self;
        // HG-09: no relative motion while axes of a combination home.
        let homes = |member: AxisNumber| axes[member].run.is_some() || axes[member].waits_for_others;
        let stands = |one: &&mut Combination| one.coupling.is_closed() && !one.coupling.members().any(homes);
        let standing: Vec<&mut Combination> = combinations.iter_mut().filter(stands).collect();
        for one in standing {
            let view = AxesView(axes);
            let wants = |slave: AxisNumber| {
                let is_absolute = axes[slave].homed && axes[one.coupling.leader()].homed;
                let may = axes[slave].error != Some(AxisError::Locked)
                    && (is_absolute || axes[slave].parameters.checks_without_homing);
                let rests = axes[slave].setpoint.is_at_rest() && axes[one.coupling.leader()].setpoint.is_at_rest();
                may && rests && axes[slave].is_powered() && triggers(&axes[slave])
            };
            // The distance of the setpoints is cleared: a slide that is held away from its setpoint stays there (O-15).
            let apart = |slave| one.coupling.setpoint_misalignment(slave, &view).unwrap_or(Position::ZERO);
            let begins: Vec<AxisNumber> =
                one.coupling.followers().filter(|slave| wants(*slave) && apart(*slave) != Position::ZERO).collect();
            let Some(first) = begins.first().copied() else { continue };
            let input = Input::Length(Quantity::SynchronismDifference, first, apart(first));
            one.cause = log.note_one(Place::Axis(first), Why::ClearingBegins, input, cause);
            let moves = Moves::Only(begins.iter().copied().collect());
            one.coupling.begin_realignment(Realign { moves, target: Target::LeaderSetpoint }, &view);
            for slave in begins {
                axes[slave].causes.motion = one.cause;
                if axes[slave].parameters.clearing == Clearing::Edge {
                    axes[slave].clears = false;
                }
            }
        }
    }

    /// One cycle of clearing: commands of the slaves. Only slaves that are powered move.
    pub(super) fn realign(&mut self) {
        let Self { combinations, axes, log, channels, .. } = self;
        let hard = combinations.iter_mut().map(|one| &mut one.coupling);
        let soft = channels.iter_mut().flat_map(|channel| channel.couplings_mut());
        for coupling in hard.chain(soft) {
            let limits = |axis: AxisNumber| {
                let parameters = &axes[axis].parameters;
                Limits { velocity: parameters.correction_velocity, acceleration: parameters.acceleration }
            };
            let settled = |axis: AxisNumber| axes[axis].has_settled();
            let realigning = coupling.realign(&AxesView(axes), limits, settled, true);
            let Some(realigning) = realigning else { continue };
            for (axis, motion) in realigning.commands {
                axes[axis].motion = Some(motion);
            }
            if let Progress::Done(_) = realigning.progress {
                for CouplingEvent { follower, difference, .. } in realigning.events {
                    let input = Input::Length(Quantity::SynchronismDifference, follower, difference);
                    let begun = axes[follower].causes.motion;
                    let event = log.note_one(Place::Axis(follower), Why::ClearingEnds, input, begun);
                    axes[follower].causes.motion = event;
                }
            }
        }
    }

    /// Compares the differences with their limits, after the encoders (HG-07, HG-08, SG-04, SG-06).
    pub(super) fn monitor(&mut self) {
        let mut found: Vec<(CouplingEvent, bool)> = Vec::new();
        let Self { combinations, axes, channels, .. } = self;
        let mut events = Events::new();
        for one in combinations.iter_mut() {
            let leader = one.coupling.leader();
            one.coupling.set_limits(|slave| {
                let parameters = &axes[slave].parameters;
                let is_homed = axes[slave].homed && axes[leader].homed && !axes[slave].waits_for_others;
                let limits = parameters.limits.filter(|_| parameters.is_monitored(is_homed));
                // HG-29: there is a base only while others home.
                limits.map(|limits| TwoStage { second_beyond_base: Some(limits.second), ..limits })
            });
            one.coupling.compare(&AxesView(axes), &mut events);
            found.extend(events.iter().map(|event| (*event, false)));
        }
        for coupling in channels.iter_mut().flat_map(|channel| channel.couplings_mut()) {
            coupling.compare(&AxesView(axes), &mut events);
            found.extend(events.iter().map(|event| (*event, true)));
        }
        // A jump beyond both limits is stage 2 alone.
        let beyond: Vec<AxisNumber> = found
            .iter()
            .filter(|(event, _)| matches!(event.what, What::SecondExceeded(_)))
            .map(|(event, _)| event.follower)
            .collect();
        for (event, is_soft) in found {
            match event.what {
                What::FirstExceeded(limit) if !beyond.contains(&event.follower) => {
                    self.trip(event, limit, is_soft, false);
                }
                What::SecondExceeded(limit) => self.trip(event, limit, is_soft, true),
                _ => {}
            }
        }
    }

    /// A limit is exceeded.
    fn trip(&mut self, event: CouplingEvent, limit: Limit, is_soft: bool, is_locked: bool) {
        let slave = event.follower;
        let (why, number, error) = match (is_soft, is_locked) {
            (false, false) => (Why::StageOne, messages::STAGE_1, AxisError::Resettable),
            (false, true) => (Why::StageTwo, messages::STAGE_2, AxisError::Locked),
            (true, false) => (Why::SoftStageOne, messages::STAGE_1, AxisError::Resettable),
            (true, true) => (Why::SoftStageTwo, messages::STAGE_2, AxisError::Locked),
        };
        // An error for another reason does not hide the limit; the limit that is exceeded already does.
        if self.pending.has(messages::STAGE_2, slave) || !is_locked && self.pending.has(messages::STAGE_1, slave) {
            return;
        }
        let is_by_list = !is_soft || self.is_limited_by_list(slave);
        let mut inputs = self.beyond(slave, event.difference, limit.base, is_locked);
        if !is_by_list {
            inputs[1] = Input::None;
        }
        let causes = self.axes[slave].causes;
        let cause = self.log.note(Place::Axis(slave), why, inputs, causes.motion.max(causes.fault));
        self.pending.raise(of_axis(number, slave), None, cause);
        self.axis_error(slave, error, cause);
    }

    /// Whether the limits of a slave in a coupling group are those of its list: the pair prints none.
    fn is_limited_by_list(&self, slave: AxisNumber) -> bool {
        self.channels.iter().any(|channel| {
            let is_of_slave = |group: &&Group| {
                group.couplings.iter().any(|coupling| coupling.followers().any(|follower| follower == slave))
            };
            let definitions =
                channel.groups.iter().filter(is_of_slave).filter_map(|group| channel.definitions.get(&group.number));
            definitions.flatten().any(|pair| {
                self.referenced(channel, &pair.slave) == Some(slave)
                    && matches!(pair.form, Form::Gantry { limits: None })
            })
        })
    }

    /// A difference beyond a limit of the list, as the inputs of a cause; with the base from which the limit counts, if there is one.
    pub(super) fn beyond(
        &self,
        slave: AxisNumber,
        difference: Position,
        base: Option<Position>,
        is_locked: bool,
    ) -> [Input; 3] {
        let measured = Input::Length(Quantity::SynchronismDifference, slave, difference);
        let limits = self.axes[slave].parameters.limits;
        let limit = match (limits, is_locked) {
            (Some(limits), true) => Some((71, limits.second)),
            (Some(limits), false) => limits.first.map(|first| (72, first)),
            (None, _) => None,
        };
        let datum = limit.map(|(number, at)| Input::Datum(number, Some(slave), tenths(at)));
        let base = base.map_or(Input::None, |base| Input::Length(Quantity::Base, slave, base));
        [measured, datum.unwrap_or(Input::None), base]
    }

    /// An axis has an error: no axis of its combination stops alone (HG-13), and the program of its channel ends.
    pub(super) fn axis_error(&mut self, axis: AxisNumber, error: AxisError, cause: EventId) {
        let members = self.coupled_with(axis);
        for member in members {
            let state = &mut self.axes[member];
            if state.error < Some(error) {
                state.error = Some(error);
                state.causes.error = cause;
            }
        }
        let channels: Vec<usize> =
            (0..self.channels.len()).filter(|index| members_of_channel(self, *index, axis)).collect();
        for index in channels {
            self.abort_program(index, cause);
        }
    }

    /// An axis with all that are coupled with it.
    pub(super) fn coupled_with(&self, axis: AxisNumber) -> Vec<AxisNumber> {
        let is_together = |one: &&Combination| !one.coupling.is_open() || one.homes_at_once;
        let hard = self.combinations.iter().filter(is_together).map(|one| &one.coupling);
        let soft = self.channels.iter().flat_map(|channel| channel.couplings()).filter(|coupling| !coupling.is_open());
        let mut members = vec![axis];
        let couplings: Vec<_> = hard.chain(soft).collect();
        let mut index = 0;
        while let Some(member) = members.get(index).copied() {
            for coupling in &couplings {
                if coupling.members().any(|other| other == member) {
                    for other in coupling.members() {
                        if !members.contains(&other) {
                            members.push(other);
                        }
                    }
                }
            }
            index += 1;
        }
        members
    }
}

/// Whether an axis, or one that is coupled with it, is an axis of a channel.
fn members_of_channel(state: &State, channel: usize, axis: AxisNumber) -> bool {
    let members = state.coupled_with(axis);
    state.channels[channel].axes.iter().any(|own| members.contains(&own.axis))
}
