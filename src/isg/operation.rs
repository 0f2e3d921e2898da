//! The channel in a cycle: NC start, NC reset, single block, errors, and the path.

use super::channel::{Channel, Inputs, Member, Modal, Task, Wait};
use super::hli::{ChannelSkipToCnc, ChannelToCnc, axis_from_cnc, channel_to_cnc};
use super::inputs::{axis_signal, channel_signal};
use super::language::Interpreter;
use super::messages;
use super::parameters::Clearing;
use super::pending::of_axis;
use super::refused::Refused;
use super::rules::Why;
use super::state::{AxisError, State};
use crate::motion::Motion;
use crate::motion::coupling::Coupling;
use crate::motion::path::{Overrides, Path, PathLimits};
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Parameter, Place, RaisedAlarm};

impl State {
    /// Takes the commands of the PLC to a channel.
    pub(super) fn read_channel(&mut self, index: usize, to_cnc: &ChannelToCnc, skip: &ChannelSkipToCnc) {
        let channel = &mut self.channels[index];
        let before = channel.inputs;
        let feed_override =
            if to_cnc.feed_override_enable() { to_cnc.feed_override_command().min(OVERRIDE) } else { 1000 };
        // P-93: of each level the bit of its number.
        let skipped = if to_cnc.program_block_ignore_enable() { skip.program_block_ignore_command() } else { 0 };
        channel.inputs = Inputs {
            start: to_cnc.start(),
            reset: to_cnc.reset(),
            feed_hold: to_cnc.feed_hold(),
            single_block: to_cnc.single_block(),
            feed_override,
            skipped,
        };
        let now = channel.inputs;
        let place = Place::Channel(channel.number);
        if now.feed_override != before.feed_override {
            let why = if to_cnc.feed_override_enable() { Why::Commanded } else { Why::Request };
            let by = channel_signal(
                self.channels[index].number,
                channel_to_cnc::feed_override_enable,
                to_cnc.feed_override_enable(),
            );
            self.channels[index].causes.feed_override = self.log.note_one(place, why, by, EventId::NONE);
        }
        if now.skipped != before.skipped {
            let enable = channel_to_cnc::program_block_ignore_enable;
            let by = channel_signal(self.channels[index].number, enable, to_cnc.program_block_ignore_enable());
            let why = if to_cnc.program_block_ignore_enable() { Why::Commanded } else { Why::Request };
            self.channels[index].causes.skipped = self.log.note_one(place, why, by, EventId::NONE);
        }
        if now.reset && !before.reset {
            self.reset(index);
        } else if now.start && !before.start {
            self.start(index);
        }
    }

    /// NC start: a new program, or the next block.
    fn start(&mut self, index: usize) {
        let input = channel_signal(self.channels[index].number, channel_to_cnc::start, true);
        let channel = &mut self.channels[index];
        let place = Place::Channel(channel.number);
        match channel.task {
            Task::Stands => {
                let event = self.log.note_one(place, Why::GoesOn, input, channel.causes.stands);
                (channel.causes.block, channel.causes.started, channel.causes.stands) = (event, event, event);
                channel.task = Task::Runs;
            }
            Task::Idle if !channel.error => {
                let Some(path) = channel.selected.clone() else { return };
                let event = self.log.note_one(place, Why::ProgramStarts, input, channel.causes.selected);
                channel.begin(&path, event, self.lenient);
            }
            Task::Idle | Task::Runs | Task::Aborts => {}
        }
    }

    /// NC reset: ends the program, clears what a reset clears (HG-07, HG-12).
    fn reset(&mut self, index: usize) {
        let input = channel_signal(self.channels[index].number, channel_to_cnc::reset, true);
        let place = Place::Channel(self.channels[index].number);
        let event = self.log.note_one(place, Why::ResetEnds, input, self.channels[index].causes.program);
        self.end_job(index, event);
        let channel = &mut self.channels[index];
        channel.shown = channel.block();
        channel.causes.reset = event;
        if channel.is_active() {
            channel.causes.program = event;
            channel.task = Task::Aborts;
        }
        channel.interpreter = None;
        channel.resets = true;
    }

    /// A reset clears differences and errors when the axes stand.
    fn finish_reset(&mut self, index: usize) {
        let (place, reset) = (Place::Channel(self.channels[index].number), self.channels[index].causes.reset);
        let event = self.log.now(place, reset, Why::ResetClears, [Input::None; 3]);
        self.channels[index].resets = false;
        let members = self.members_of(index);
        self.clear_differences_of(&members, event);
        self.reset_groups(index, event);
        self.clear_errors(index, &members, event);
        let is_left = |axis: &AxisNumber| self.axes[*axis].error.is_some() && self.axes[*axis].feedback.drive_fault;
        self.channels[index].awaits_drives = members.iter().any(is_left);
    }

    /// P-113: a fault of a drive that ended in the cycle of a reset. The drives report it at the end of this cycle.
    fn finish_reset_of_drives(&mut self, index: usize) {
        let members = self.members_of(index);
        if !members.iter().any(|axis| self.axes[*axis].feedback.drive_fault) {
            let (place, reset) = (Place::Channel(self.channels[index].number), self.channels[index].causes.reset);
            let event = self.log.now(place, reset, Why::ResetClears, [Input::None; 3]);
            self.clear_differences_of(&members, event);
            self.clear_errors(index, &members, event);
        }
    }

    /// The axes on which a reset of a channel acts.
    fn members_of(&self, index: usize) -> Vec<AxisNumber> {
        self.existing().filter(|axis| self.is_of_channel(index, *axis)).collect()
    }

    /// Clears the errors of axes, except what a reset does not remove (O-15), and that of the channel.
    fn clear_errors(&mut self, index: usize, members: &[AxisNumber], event: EventId) {
        let place = Place::Channel(self.channels[index].number);
        let mut cleared = Vec::new();
        for axis in members {
            let has_fault = |member: &AxisNumber| self.is_beyond(*member) || self.axes[*member].feedback.drive_fault;
            let stays = self.coupled_with(*axis).iter().any(has_fault);
            if self.axes[*axis].error == Some(AxisError::Resettable) && !stays {
                cleared.push(*axis);
            }
        }
        for axis in &cleared {
            let is_in_error = axis_signal(*axis, axis_from_cnc::error_not_resettable, false);
            let is_of_gantry =
                self.coupled_with(*axis).iter().any(|member| self.pending.has(messages::STAGE_1, *member));
            let why = if is_of_gantry { Why::Cleared } else { Why::FaultCleared };
            let cause = self.log.note_one(Place::Axis(*axis), why, is_in_error, event);
            let state = &mut self.axes[*axis];
            state.error = None;
            state.fault_stop = false;
            state.causes.error = cause;
        }
        let in_error = |axis: AxisNumber| self.axes[axis].error.is_some();
        let stays = |alarm: &RaisedAlarm| match alarm.place {
            Place::Axis(axis) => in_error(axis) && !messages::is_warning(alarm.number) || !members.contains(&axis),
            other => other != place && other != Place::Nck,
        };
        self.pending.reset(event, stays);
        let error = members.iter().any(|axis| in_error(*axis));
        let channel = &mut self.channels[index];
        if channel.error && !error {
            channel.error = false;
            channel.causes.error = self.log.note_plain(place, Why::ErrorCleared, event);
        }
    }

    /// Whether a difference is beyond a limit and is not being cleared.
    fn is_beyond(&self, slave: AxisNumber) -> bool {
        let hard = self.combinations.iter().map(|one| &one.coupling);
        let soft = self.channels.iter().flat_map(|channel| channel.couplings());
        let mut closed = hard.chain(soft).filter(|coupling| coupling.is_closed());
        closed.any(|coupling| {
            coupling.differences().any(|(axis, _, stage)| axis == slave && (stage.first || stage.second))
        })
    }

    fn clear_differences_of(&mut self, members: &[AxisNumber], cause: EventId) {
        let of_reset: Vec<AxisNumber> = members
            .iter()
            .copied()
            .filter(|axis| self.axes[*axis].parameters.clearing == Clearing::ResetOrUnit)
            .collect();
        let numbers: Vec<u16> = of_reset.iter().map(|axis| self.axes[*axis].parameters.number).collect();
        self.clear_differences(|axis| numbers.contains(&axis.parameters.number), cause);
    }

    /// Whether an axis belongs to a channel: itself, or the master that it follows. An axis that is in no channel is reset by the first one.
    pub(super) fn is_of_channel(&self, index: usize, axis: AxisNumber) -> bool {
        let has = |channel: &Channel| {
            self.coupled_with(axis).iter().any(|member| channel.axes.iter().any(|own| own.axis == *member))
        };
        let owner = self.channels.iter().position(has);
        owner.unwrap_or(0) == index
    }

    /// Ends a program because of an error.
    pub(super) fn abort_program(&mut self, index: usize, cause: EventId) {
        self.end_job(index, cause);
        let channel = &mut self.channels[index];
        // Blocks that were fetched ahead are never reached.
        channel.shown = channel.block();
        if !channel.error {
            channel.error = true;
            channel.causes.error = cause;
        }
        // The first error ends it.
        if matches!(channel.task, Task::Runs | Task::Stands) {
            channel.task = Task::Aborts;
            channel.causes.program = self.log.note_plain(Place::Channel(channel.number), Why::ProgramAborted, cause);
        }
        self.channels[index].interpreter = None;
    }

    /// A homing that runs ends without a reference.
    fn end_job(&mut self, index: usize, cause: EventId) {
        if let Wait::Homing(job) = std::mem::take(&mut self.channels[index].wait) {
            self.end_homing(&job, cause);
        }
    }

    /// One cycle of a channel.
    pub(super) fn step_channel(&mut self, index: usize) {
        match self.channels[index].task {
            Task::Idle => {}
            Task::Aborts => self.step_abort(index),
            Task::Runs | Task::Stands => {
                self.step_program(index);
                self.step_path(index);
            }
        }
        self.channels[index].is_new = false;
        if std::mem::take(&mut self.channels[index].awaits_drives) && !self.channels[index].resets {
            self.finish_reset_of_drives(index);
        }
        if self.channels[index].resets && self.channels[index].task == Task::Idle && self.stands(index) {
            self.finish_reset(index);
        }
    }

    /// Whether all axes of a channel rest.
    fn stands(&self, index: usize) -> bool {
        self.channels[index].axes.iter().all(|member| self.axes[member.axis].setpoint.is_at_rest())
    }

    /// The axes brake: each with its a_emergency after an error (HG-22); on the path after a reset, or as a homing run brakes.
    fn step_abort(&mut self, index: usize) {
        let is_error = self.channels[index].error;
        let channel = &mut self.channels[index];
        if is_error || channel.has_moved() {
            if let Some(path) = &mut channel.path {
                path.clear();
            }
            let axes: Vec<AxisNumber> = channel.axes.iter().map(|member| member.axis).collect();
            for axis in axes.iter().filter(|axis| !self.channels[index].is_slave(**axis)) {
                let deceleration =
                    if is_error { self.axes[*axis].parameters.emergency } else { self.homing_deceleration(*axis) };
                self.axes[*axis].motion = Some(Motion::Brake { deceleration });
            }
        } else {
            self.step_path(index);
            let channel = &mut self.channels[index];
            if let Some(path) = &mut channel.path
                && path.velocity() <= 0.0
            {
                path.clear();
            }
        }
        if self.channels[index].has_moved() && self.stands(index) {
            let channel = &mut self.channels[index];
            let place = Place::Channel(channel.number);
            channel.causes.program = self.log.now(place, channel.causes.program, Why::ProgramStops, [Input::None; 3]);
            channel.end_program(false);
            if !channel.resets {
                // SG-09: the end of the program ends a coupling, however it ends; a pending reset does so with its own rule.
                let cause = channel.causes.program;
                if !channel.error && !channel.retains_axes {
                    let numbers: Vec<u16> = channel.groups.iter().map(|group| group.number).collect();
                    self.end_groups(index, &numbers, Why::GroupEnds, cause);
                }
            }
        }
    }

    /// One cycle of the path.
    fn step_path(&mut self, index: usize) {
        let cycle = self.cycle.0.seconds();
        let channel = &self.channels[index];
        let moving: Vec<AxisNumber> = channel.path_axes.iter().copied().filter(|axis| channel.moves(*axis)).collect();
        let members: Vec<AxisNumber> = moving.iter().flat_map(|axis| self.coupled_with(*axis)).collect();
        if let Some(axis) = members.iter().copied().find(|axis| self.lacks_releases(*axis)) {
            self.drive_not_ready(axis);
            return;
        }
        let is_free = members.iter().all(|axis| self.axes[*axis].units.feed_enable && self.axes[*axis].is_powered());
        let has_settled = self.has_settled(index);
        let is_clearing = members.iter().any(|axis| self.is_clearing(*axis));
        let channel = &mut self.channels[index];
        let goes = is_free && !is_clearing && channel.task == Task::Runs && !channel.inputs.feed_hold;
        let factor = if goes { f64::from(channel.inputs.feed_override) / 1000.0 } else { 0.0 };
        let Some(path) = channel.path.as_mut().filter(|path| !path.is_empty()) else { return };
        // Single block acts on the blocks that are on their way already, too.
        let is_single = channel.inputs.single_block;
        if is_single {
            path.stop_at_block_end(cycle);
        } else {
            path.pass_block_end();
        }
        if path.stands() {
            // Single block: the block ends where its axes stand.
            if !has_settled {
                return;
            }
            path.go_on();
            channel.pass_blocks(1);
            if is_single && channel.task == Task::Runs {
                channel.fetched_one = false;
                self.stand(index);
            }
            return;
        }
        let before = path.position();
        let moved = path.step(Overrides { feed: factor, rapid: factor.min(1.0) }, cycle);
        channel.pass_blocks(moved.ended);
        let axes = channel.path_axes.clone();
        for (place, axis) in axes.into_iter().enumerate() {
            #[expect(clippy::cast_possible_truncation, reason = "positions are within reach; the cast saturates")]
            let position = Position::new(moved.position[place].round() as i64);
            let velocity = (moved.position[place] - before[place]) / cycle;
            self.axes[axis].motion = Some(Motion::Interpolated { position, velocity });
        }
    }

    /// The program stands until NC start: after a block, or at M00.
    pub(super) fn stand(&mut self, index: usize) {
        let channel = &mut self.channels[index];
        channel.task = Task::Stands;
        let single = channel_signal(channel.number, channel_to_cnc::single_block, channel.inputs.single_block);
        let inputs = [super::inputs::block(channel.block()), single, Input::None];
        let place = Place::Channel(channel.number);
        channel.causes.stands = self.log.note(place, Why::ProgramStands, inputs, channel.causes.program);
    }

    /// Why an axis has no power: it is not enabled, or its drive is not ready.
    pub(super) fn without_power(&self, axis: AxisNumber) -> (Why, Input, EventId) {
        let state = &self.axes[axis];
        if state.units.drive_enable {
            let input = axis_signal(axis, axis_from_cnc::drive_ready, false);
            (Why::DriveNotReady, input, state.causes.ready.max(state.causes.fault))
        } else {
            let input = axis_signal(axis, axis_from_cnc::drive_enable_state, false);
            (Why::DriveNotEnabled, input, state.causes.drive_enable)
        }
    }

    /// An axis is to move without its releases.
    pub(super) fn drive_not_ready(&mut self, axis: AxisNumber) {
        let (why, input, parent) = self.without_power(axis);
        let event = self.log.note_one(Place::Axis(axis), why, input, parent);
        self.pending.raise(of_axis(messages::DRIVE_NOT_READY, axis), None, event);
        self.axis_error(axis, AxisError::Resettable, event);
    }

    /// Whether an axis is to move without its releases. A drive that starts up is waited for.
    pub(super) fn lacks_releases(&self, axis: AxisNumber) -> bool {
        let axis = &self.axes[axis];
        !axis.units.drive_enable || !axis.feedback.drive_ready && axis.was_ready
    }

    /// Whether a difference of an axis is being cleared.
    pub(super) fn is_clearing(&self, axis: AxisNumber) -> bool {
        let hard = self.combinations.iter().filter(|one| !one.homes_at_once).map(|one| &one.coupling);
        let soft = self.channels.iter().flat_map(|channel| channel.couplings());
        let clears = |coupling: &Coupling| !coupling.is_closed() && !coupling.is_open();
        hard.chain(soft).filter(|coupling| clears(coupling)).any(|coupling| coupling.members().any(|one| one == axis))
    }

    /// The path of a channel, at rest, with the present positions and limits of its axes: those that a block names, then the others as far
    /// as there is room.
    pub(super) fn place_path(&mut self, index: usize, named: &[AxisNumber]) {
        let channel = &self.channels[index];
        let free = channel.axes.iter().map(|member| member.axis).filter(|axis| !channel.is_slave(*axis));
        let mut axes: Vec<AxisNumber> = free.collect();
        axes.sort_by_key(|axis| !named.contains(axis));
        axes.truncate(crate::motion::path::PATH_AXES);
        let mut position = [0.0; crate::motion::path::PATH_AXES];
        let mut limits = PathLimits {
            velocity: [f64::INFINITY; crate::motion::path::PATH_AXES],
            acceleration: [f64::INFINITY; crate::motion::path::PATH_AXES],
            overload: [1.0; crate::motion::path::PATH_AXES],
        };
        for (place, axis) in axes.iter().enumerate() {
            position[place] = self.axes[*axis].setpoint.position.increments() as f64;
            // SG-12: slaves limit the path, too.
            limits.velocity[place] = self.smallest(*axis, |parameters| parameters.velocity);
            limits.acceleration[place] = self.smallest(*axis, |parameters| parameters.acceleration);
        }
        let channel = &mut self.channels[index];
        channel.path = Some(Path::new(position, limits));
        channel.path_axes = axes;
    }

    /// Raises a message of a channel. `block` is none where no block is the reason.
    pub(super) fn raise_in_channel(
        &mut self,
        index: usize,
        block: Option<u32>,
        Refused(number, third, fourth): Refused,
        cause: EventId,
    ) -> EventId {
        let channel = self.channels[index].number;
        let place = Place::Channel(channel);
        let number_of_block = block.map_or(Input::None, super::inputs::block);
        let event = self.log.note_one(place, Why::Raised, number_of_block, cause);
        let other = third.axis();
        let block = block.map_or(Parameter::None, |block| Parameter::Number(block.into()));
        let [third, fourth] = [third, fourth].map(|detail| self.pending.parameter(detail));
        let alarm = RaisedAlarm { number, place, parameters: [Parameter::Channel(channel), block, third, fourth] };
        self.pending.raise(alarm, other, event);
        event
    }
}

/// The largest override: 200 %.
const OVERRIDE: u16 = 2000;

impl Channel {
    /// A program begins.
    fn begin(&mut self, path: &str, cause: EventId, lenient: bool) {
        self.task = Task::Runs;
        self.completed = false;
        self.ended = false;
        (self.causes.program, self.causes.block, self.causes.started) = (cause, cause, cause);
        self.interpreter = Some(Interpreter::new(path, lenient));
        (self.prepared, self.fault, self.wait) = (None, None, Wait::Nothing);
        self.blocks.clear();
        (self.path, self.shown) = (None, 0);
        self.modal = Modal { feed: self.first_feed, ..Modal::default() };
        (self.is_new, self.halts, self.restores) = (true, false, true);
        self.manual.clear();
        if !self.retains_axes {
            self.axes = self.configured.clone();
        }
    }

    /// Blocks of the path have ended; the last one is shown until the next one begins.
    fn pass_blocks(&mut self, count: usize) {
        for _ in 0..count {
            if let Some((_, shown)) = self.blocks.pop_front() {
                self.shown = shown;
            }
        }
    }

    /// A program has ended.
    pub(super) fn end_program(&mut self, completed: bool) {
        self.task = Task::Idle;
        self.completed = completed;
        (self.interpreter, self.prepared, self.fault, self.wait) = (None, None, None, Wait::Nothing);
        self.blocks.clear();
        (self.path, self.shown) = (None, 0);
        self.modal.compensation = false;
        self.manual.clear();
    }

    /// The axis in a place of the channel.
    pub(super) fn member_at(&self, index: u16) -> Option<&Member> {
        self.axes.iter().find(|member| member.index == index)
    }
}
