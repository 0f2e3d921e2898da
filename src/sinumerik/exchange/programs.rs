//! Axis exchange by programs: RELEASE, GET, GETD, WAITP, and the automatic GET of a block that names an axis which its channel does not have
//! (MD30552). Also the return of axes at RESET and at the end of a program (MD30450).
//!
//! Called by the stage "programs". A block that names such an axis is prepared when everything before it has been executed; then the axis is
//! taken, and the block is prepared from where the axis stands. While a program waits for an axis, 35.1 is 1. The alarms are 14790 for a PLC
//! axis, 26075 and 26076 for one that programs never get, and `axis-not-a-channel-axis` with MD30552 = 0.

use crate::nc_program::{Action, AxisIndex, Block};
use crate::sinumerik::alarms::{self, axis_exchange as texts};
use crate::sinumerik::exchange::state::{Claim, Holder, Owners, Request, Wanted};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::{BlockAlarm, Phase, ProgramState, Run, block_name, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, ChannelNumber};
use crate::variables::{EventId, Input, Parameter, Place, short_text};

/// Where an axis has moved less than this, a block does not move it; in increments.
const MOVES: f64 = 0.5;

/// What must happen before a block can be prepared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) enum Availability {
    /// Its channel has all axes.
    All,
    /// It must get axes first.
    Claims(Claim),
    /// It never gets one of them, or not now.
    Refused(BlockAlarm),
}

/// The names of axes that a block moves.
fn moved(block: &Block) -> impl Iterator<Item = AxisIndex> {
    let of_action = |action: &Action| match action {
        Action::Position { target, .. } => vec![target.axis],
        Action::Reference(names) => names.clone(),
        Action::Preset(axes) => axes.iter().map(|(name, _)| *name).collect(),
        _ => Vec::new(),
    };
    block.axes.iter().map(|word| word.axis).chain(block.actions.iter().flat_map(of_action))
}

/// Whether the axes of the blocks behind this one may be others.
pub(in crate::sinumerik) fn exchanges(block: &Block) -> bool {
    let exchanges =
        |action: &Action| matches!(action, Action::Release(_) | Action::Get { .. } | Action::WaitForPosition(_));
    block.actions.iter().any(exchanges)
}

/// Whether a channel has the axes of a block.
pub(in crate::sinumerik) fn availability(
    block: &Block,
    channel: ChannelNumber,
    own: &ProgramParameters,
    owners: &Owners,
    parameters: &Parameters,
) -> Availability {
    let mut claim = Claim { axes: AxisSet::NONE, direct: false };
    for name in moved(block) {
        let axis = own.axes.machine_axes.get(usize::from(name.0)).copied();
        // Any other axis cannot be programmed at all.
        let Some(axis) = axis.filter(|axis| own.axes.place(*axis).is_some()) else { continue };
        if owners.is_program_axis(axis, channel) {
            continue;
        }
        let data = &parameters.axes[axis];
        let shown = Parameter::Text(short_text(own.axes.names.name(name)));
        let in_block = [Parameter::Text(short_text(&block.origin.name)), shown, Parameter::None];
        let of_axis = [Parameter::Axis(axis), Parameter::None, Parameter::None];
        let (number, parameters) = match owners.of(axis).holder {
            Holder::Plc if data.plc_axis.exclusive => (texts::EXCLUSIVE_PLC_AXIS, of_axis),
            Holder::Plc if data.plc_axis.permanent => (texts::PERMANENT_PLC_AXIS, of_axis),
            Holder::Plc => (texts::CONTROLLED_BY_PLC, in_block),
            _ if data.automatic_get == 0 => (alarms::AXIS_NOT_IN_CHANNEL, in_block),
            Holder::Program | Holder::Neutral | Holder::Command => {
                claim.axes.set(axis, true);
                claim.direct |= data.automatic_get == 2;
                continue;
            }
        };
        return Availability::Refused(BlockAlarm { number, parameters, block: block_name(&block.origin.name) });
    }
    if claim.axes.is_empty() { Availability::All } else { Availability::Claims(claim) }
}

/// The axes of GET and GETD.
fn claimed(block: &Executable, own: &ProgramParameters) -> Option<Claim> {
    let axes_of = |action: &Action| match action {
        Action::Get { axes, is_direct } => Some((axes.clone(), *is_direct)),
        _ => None,
    };
    let mut claim = Claim { axes: AxisSet::NONE, direct: false };
    for (names, direct) in block.actions.iter().filter_map(axes_of) {
        let axes = names.iter().filter_map(|name| own.axes.machine_axes.get(usize::from(name.0)));
        claim.axes = claim.axes.with(axes.copied().collect());
        claim.direct |= direct;
    }
    Some(claim).filter(|claim| !claim.axes.is_empty())
}

impl State {
    /// RELEASE and WAITP, at the end of their block.
    pub(in crate::sinumerik) fn release_axes(
        &mut self,
        block: &Executable,
        (channel, own): (ChannelNumber, &ProgramParameters),
        cause: EventId,
        parameters: &Parameters,
    ) {
        for action in &block.actions {
            let (names, waits) = match action {
                Action::Release(names) => (names, false),
                Action::WaitForPosition(names) => (names, true),
                _ => continue,
            };
            for name in names {
                let axis = own.axes.machine_axes.get(usize::from(name.0)).copied();
                let mine = axis.filter(|axis| self.owners.is_program_axis(*axis, channel));
                let Some(unit) = mine.and_then(|axis| self.unit_of(axis)) else { continue };
                let input = Input::Block(block_name(&block.origin.name));
                let inputs = [input, Input::None, Input::None];
                self.hand_over(&unit, channel, Rule::ReleasedByProgram, inputs, cause, parameters);
                for member in unit.members() {
                    self.owners.of_mut(member).stays_in_channel = waits;
                }
            }
        }
    }

    /// Whether the next block needs axes that the channel does not have yet.
    pub(in crate::sinumerik) fn waits_for_claim(&mut self, run: &mut Run, stage: &Stage<'_>) -> bool {
        // A claim of an earlier preparation is void when the block could be prepared meanwhile.
        let claim = run.claim.take().filter(|_| run.is_at_rest());
        let waits = claim.is_some_and(|claim| {
            let by = (stage.channel, run.block_cause);
            !self.claim_axes(claim, true, by, stage.parameters)
        });
        self.show_waiting(stage.channel, waits, run.block_cause);
        waits
    }

    /// Whether GET or GETD of the block that runs waits for an axis.
    pub(in crate::sinumerik) fn waits_for_axes(&mut self, run: &Run, stage: &Stage<'_>) -> bool {
        let Some(claim) = run.queue.front().and_then(|block| claimed(block, stage.own)) else { return false };
        let waits = !self.claim_axes(claim, false, (stage.channel, run.block_cause), stage.parameters);
        self.show_waiting(stage.channel, waits, run.block_cause);
        waits
    }

    /// A program wants axes. Returns whether its channel has them all.
    fn claim_axes(
        &mut self,
        claim: Claim,
        is_automatic: bool,
        (channel, cause): (ChannelNumber, EventId),
        parameters: &Parameters,
    ) -> bool {
        let missing: AxisSet = claim.axes.iter().filter(|axis| !self.owners.is_program_axis(*axis, channel)).collect();
        for axis in missing.iter() {
            self.claim_axis(axis, (claim.direct, is_automatic), channel, cause, parameters);
        }
        missing.is_empty()
    }

    fn claim_axis(
        &mut self,
        axis: AxisNumber,
        (direct, is_automatic): (bool, bool),
        channel: ChannelNumber,
        cause: EventId,
        parameters: &Parameters,
    ) {
        let Some(unit) = self.unit_of(axis) else { return };
        let of = *self.owners.of(axis);
        let is_free = match of.holder {
            Holder::Neutral => {
                let kept = is_automatic && of.stays_in_channel && !parameters.exchange_after_wait;
                of.channel == channel || !kept
            }
            Holder::Command => !self.is_positioned_alone(axis),
            Holder::Program | Holder::Plc => false,
        };
        if is_free {
            self.hand_over(&unit, channel, Rule::TakenByProgram, [Input::None; 3], cause, parameters);
        } else if direct && of.holder == Holder::Program {
            self.request_axis(axis, Request { channel, by: Wanted::TakenDirectly, cause });
        }
    }

    /// 35.1 while a program waits for axes.
    fn show_waiting(&mut self, channel: ChannelNumber, waits: bool, block: EventId) {
        let program = &self.programs[channel];
        let (state, rule) = match (program.state, waits) {
            (ProgramState::Running, true) => (ProgramState::Waiting, Rule::WaitsForAxis),
            (ProgramState::Waiting, false) => (ProgramState::Running, Rule::HasItsAxes),
            _ => return,
        };
        let event = self.log.note_plain(Place::Channel(channel), rule, block);
        let program = &mut self.programs[channel];
        (program.state, program.cause) = (state, event);
    }

    /// RESET or the end of a program: neutral axes of its channel return to it, with MD30450 = 1 its axes become neutral.
    pub(in crate::sinumerik) fn return_axes(
        &mut self,
        channel: ChannelNumber,
        cause: EventId,
        parameters: &Parameters,
    ) {
        for index in 0..self.units.len() {
            let unit = self.units[index];
            let leader = unit.leader();
            let of = *self.owners.of(leader);
            if of.channel != channel {
                continue;
            }
            let becomes_neutral = parameters.axes[leader].gantry.concurrent;
            let rule = match of.holder {
                Holder::Neutral | Holder::Command if !becomes_neutral => Rule::ReturnedToChannel,
                Holder::Program | Holder::Command if becomes_neutral => Rule::NeutralAfterReset,
                Holder::Program | Holder::Neutral | Holder::Command | Holder::Plc => continue,
            };
            let input = Input::Datum(30450, Some(leader), f64::from(u8::from(becomes_neutral)));
            self.hand_over(&unit, channel, rule, [input, Input::None, Input::None], cause, parameters);
        }
    }

    /// After the programs of a cycle: the axes whose holder they may have changed, and those that their blocks begin or end to use.
    pub(in crate::sinumerik) fn exchanged_axes(&mut self, parameters: &Parameters) -> AxisSet {
        let used = self.note_used_axes(parameters);
        if self.owners.has_changed() { parameters.existing } else { used }
    }

    /// The axes that the blocks of programs use now. Returns those of which this has changed.
    fn note_used_axes(&mut self, parameters: &Parameters) -> AxisSet {
        let mut used = AxisSet::NONE;
        for (channel, _) in parameters.existing_channels() {
            let (program, own) = (&self.programs[channel], parameters.programs[channel].as_deref());
            if let (Some(run), Some(own)) = (program.run.as_deref(), own) {
                let mine = |axis: &AxisNumber| self.owners.is_program_axis(*axis, channel);
                let of_run = own.axes.path.iter().copied().enumerate().filter(|(place, axis)| run.uses(*axis, *place));
                used = used.with(of_run.map(|(_, axis)| axis).filter(mine).collect());
            }
        }
        // An axis that is positioned alone is not free, either. Synchronous axes go with their leading axis.
        used = used.with(self.single.moving);
        for unit in &self.units {
            if used.contains(unit.leader()) {
                used = used.with(unit.set);
            }
        }
        let before = std::mem::replace(&mut self.owners.used, used);
        let changed = used.without(before).with(before.without(used));
        for axis in changed.iter() {
            let is_used = used.contains(axis);
            let rule = if is_used { Rule::ExchangeNotPossible } else { Rule::ExchangePossible };
            let of = *self.owners.of(axis);
            let program = &self.programs[of.channel];
            let leader = self.units.iter().find(|unit| unit.set.contains(axis)).map_or(axis, |unit| unit.leader());
            let alone = self.single.axes[leader].cause;
            let cause = match is_used {
                true if self.single.moving.contains(leader) => alone,
                true => program.block_cause(),
                false => program.block_cause().max(program.cause).max(of.cause).max(alone),
            };
            self.owners.of_mut(axis).possible_cause = self.log.note_plain(Place::Axis(axis), rule, cause);
        }
        changed
    }

    /// The blocks of a channel that have not begun are prepared again: its axes may be others, or stand elsewhere.
    pub(in crate::sinumerik) fn prepare_again(&mut self, channel: ChannelNumber, parameters: &Parameters) {
        let Some(own) = parameters.programs[channel].as_deref() else { return };
        let axes = &self.axes;
        if let Some(run) = &mut self.programs[channel].run {
            run.prepare_again(own, |axis| axes[axis].setpoint.position);
        }
    }
}

impl Run {
    /// The block that runs, and those into which the path passes without a stop.
    fn running(&self) -> impl Iterator<Item = &Executable> {
        let count = if self.phase == Phase::Between { 0 } else { self.on_path.max(1) };
        self.queue.iter().take(count)
    }

    /// Whether the block that runs moves an axis, or has started its movement.
    fn uses(&self, axis: AxisNumber, place: usize) -> bool {
        let moves = |block: &Executable| {
            let on_way = block.way.is_some_and(|block| {
                let (lowest, highest) = block.way.bounds(place);
                highest - lowest >= MOVES
            });
            on_way || block.positions.iter().any(|one| one.axis == axis) || block.references.contains(&axis)
        };
        let positioned = self.positionings.iter().any(|one| one.axis == axis) || self.referencing.contains(axis);
        positioned || self.returning.is_some() || self.running().any(moves)
    }

    fn prepare_again(&mut self, own: &ProgramParameters, position: impl Fn(AxisNumber) -> crate::units::Position) {
        let count = self.running().count();
        let mut end = on_path(&own.axes.path, position);
        self.end_of_ways(own, &mut end);
        for block in self.running() {
            if let Some(way) = block.way {
                end = way.way.end();
            }
            for one in &block.positions {
                if let Some(place) = own.axes.place(one.axis) {
                    end[place] = one.target.increments() as f64;
                }
            }
        }
        self.reorganise_behind(count, end);
    }
}
