//! A program in its channel: blocks are fetched ahead of the path, and executed in their order.

use std::sync::Arc;

use super::channel::{Task, Wait};
use super::homing::job::Job;
use super::language::{
    Block, Command, End, Environment, Fault, FaultCode, Prepared, Refusal, Variables, is_called, is_modelled,
};
use super::messages;
use super::pending::Detail;
use super::refused::{Refused, unknown, value};
use super::rules::Why;
use super::state::State;
use crate::nc_program::Program;
use crate::units::AxisNumber;
use crate::variables::{AlarmNumber, EventId, Parameter, Place, RaisedAlarm};

/// Blocks that are fetched in a cycle at most: a program that jumps for ever does not stop the time.
const FETCHED: usize = 64;

/// The channel, as the language sees it.
struct View<'a> {
    state: &'a State,
    channel: usize,
    is_executed: bool,
}

impl Variables for View<'_> {
    fn read(&self, name: &str) -> Option<f64> {
        let channel = &self.state.channels[self.channel];
        match name {
            // SG-24: the group that is active or was active last; whether a group is active.
            "V.G.AX_LINK.NR" => Some(channel.last_group.into()),
            "V.G.AX_LINK.ACTIVE" => Some(if channel.groups.is_empty() { 0.0 } else { 1.0 }),
            _ => None,
        }
    }

    fn may_write(&self, name: &str, _: f64) -> Result<(), Refusal> {
        Err(if self.read(name).is_some() { Refusal::ReadOnly } else { Refusal::Unknown })
    }

    fn write(&mut self, _: &str, _: f64) {}

    fn waits(&self, name: &str) -> bool {
        name.starts_with("V.G.AX_LINK")
    }
}

impl Environment for View<'_> {
    fn is_executed(&self) -> bool {
        self.is_executed
    }

    fn is_skipped(&self, level: u8) -> bool {
        let bit = u32::from(level.saturating_sub(1));
        self.state.channels[self.channel].inputs.skipped.checked_shr(bit).unwrap_or(0) & 1 == 1
    }

    fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.state.programs.get(path).cloned()
    }

    fn find_program(&self, name: &str) -> Option<Arc<Program>> {
        self.state.programs.values().find(|program| is_called(name, program)).cloned()
    }
}

/// A block that is refused: the message, and its second to fourth parameter after the channel and the block.
pub(super) type Outcome = Result<(), Refused>;

impl State {
    /// One cycle of a program that runs.
    pub(super) fn step_program(&mut self, index: usize) {
        if !self.restores(index) {
            return;
        }
        self.step_wait(index);
        for _ in 0..FETCHED {
            let channel = &self.channels[index];
            if channel.task != Task::Runs || channel.wait != Wait::Nothing {
                return;
            }
            let is_executed = self.is_executed(index);
            let channel = &mut self.channels[index];
            if channel.halts {
                if is_executed {
                    channel.halts = false;
                    self.stand(index);
                }
                return;
            }
            if let Some(block) = channel.prepared.take() {
                // A coupling begins at rest: the lag of a movement before it is no difference (SG-15).
                let couples = matches!(block.command, Some(Command::LinkOn(_) | Command::Gantry { is_on: true, .. }));
                if !is_executed || couples && !self.has_settled(index) {
                    self.channels[index].prepared = Some(block);
                    return;
                }
                self.execute(index, &block);
                continue;
            }
            if channel.fetched_one && channel.inputs.single_block && !channel.ended {
                if is_executed {
                    self.channels[index].fetched_one = false;
                    self.stand(index);
                }
                return;
            }
            if let Some(fault) = channel.fault.take() {
                if !is_executed {
                    channel.fault = Some(fault);
                    return;
                }
                self.raise_fault(index, &fault);
                let cause = self.channels[index].causes.block;
                self.abort_program(index, cause);
                return;
            }
            if channel.ended {
                if is_executed && !channel.is_new && self.has_settled(index) {
                    self.complete(index);
                }
                return;
            }
            if channel.path.as_ref().is_some_and(|path| !path.has_room()) {
                return;
            }
            if !self.fetch(index, is_executed) {
                return;
            }
        }
    }

    /// The program start switches groups on again, as soon as the differences of the last reset are cleared. False if the program waits for
    /// that, or if it is not possible.
    fn restores(&mut self, index: usize) -> bool {
        let channel = &mut self.channels[index];
        if !channel.restores || channel.task != Task::Runs {
            return true;
        }
        let waits = channel.groups.iter().any(|group| group.ending);
        if waits || !channel.restored.is_empty() && !self.has_settled(index) {
            return false;
        }
        self.channels[index].restores = false;
        let cause = self.channels[index].causes.program;
        let restored = self.restore_groups(index, cause);
        if !restored {
            self.abort_program(index, cause);
        }
        restored
    }

    fn step_wait(&mut self, index: usize) {
        let wait = std::mem::take(&mut self.channels[index].wait);
        let inputs = self.channels[index].inputs;
        let holds = inputs.feed_hold || inputs.feed_override == 0;
        let left = match wait {
            // The cycle in which a dwell ends goes on with the next block.
            Wait::Nothing | Wait::Dwell(0 | 1) => Wait::Nothing,
            Wait::Dwell(cycles) => Wait::Dwell(cycles - 1),
            Wait::Homing(job) if holds || self.misses_feed_enable(&job) => {
                self.brake_homing(&job);
                Wait::Homing(job)
            }
            Wait::Homing(mut job) => {
                if let Some(axis) = self.homing_now(&job).into_iter().find(|axis| self.lacks_releases(*axis)) {
                    self.drive_not_ready(axis);
                    Wait::Homing(job)
                } else if self.home(&mut job) {
                    Wait::Nothing
                } else {
                    Wait::Homing(job)
                }
            }
        };
        // An error of an axis has ended the program meanwhile.
        match left {
            Wait::Homing(job) if self.channels[index].task == Task::Aborts => {
                let cause = self.channels[index].causes.error;
                self.end_homing(&job, cause);
            }
            left => self.channels[index].wait = left,
        }
    }

    fn misses_feed_enable(&self, job: &Job) -> bool {
        self.homing_now(job).into_iter().any(|axis| !self.axes[axis].units.feed_enable)
    }

    /// Whether everything before has been executed.
    fn is_executed(&self, index: usize) -> bool {
        let channel = &self.channels[index];
        let rests = |axis: AxisNumber| self.axes[axis].setpoint.is_at_rest() && !self.is_clearing(axis);
        channel.has_moved() && channel.axes.iter().all(|member| rests(member.axis))
    }

    pub(super) fn has_settled(&self, index: usize) -> bool {
        let members = self.channels[index].axes.iter().flat_map(|member| self.coupled_with(member.axis));
        members.into_iter().all(|axis| !self.axes[axis].is_powered() || self.axes[axis].has_settled())
    }

    /// The end of a program: its groups end with it (SG-09).
    fn complete(&mut self, index: usize) {
        let channel = &mut self.channels[index];
        let event = self.log.note_plain(Place::Channel(channel.number), Why::ProgramEnds, channel.causes.program);
        channel.causes.program = event;
        channel.end_program(true);
        if channel.retains_axes {
            // P-CHAN-00460: couplings outlive the program, as the axes do.
            return;
        }
        let numbers: Vec<u16> = channel.groups.iter().map(|group| group.number).collect();
        if channel.restores_after_end {
            channel.restored.clone_from(&numbers);
            channel.restored_from_end = true;
        }
        self.end_groups(index, &numbers, Why::GroupEnds, event);
    }

    /// Fetches the next block. False if it has to wait.
    fn fetch(&mut self, index: usize, is_executed: bool) -> bool {
        let Some(mut interpreter) = self.channels[index].interpreter.take() else {
            self.channels[index].ended = true;
            return true;
        };
        let mut view = View { state: self, channel: index, is_executed };
        let next = interpreter.next(&mut view);
        let channel = &mut self.channels[index];
        channel.interpreter = Some(interpreter);
        match next {
            Ok(Prepared::Block(block)) => {
                channel.fetched_one = channel.inputs.single_block;
                let ends = block.end == Some(End::Aborted);
                let waits = block.command.is_some() || !block.homing.is_empty() || block.dwell.is_some() || ends;
                if waits || !block.warnings.is_empty() {
                    channel.prepared = Some(*block);
                } else {
                    self.execute(index, &block);
                }
                true
            }
            Ok(Prepared::Waits(_) | Prepared::Calculated(_)) => false,
            Ok(Prepared::Ended) => {
                channel.ended = true;
                true
            }
            Err(fault) => {
                channel.fault = Some(fault);
                true
            }
        }
    }

    /// Raises the message of the language.
    fn raise_fault(&mut self, index: usize, fault: &Fault) {
        let refused = self.refused_by(index, fault);
        let cause = self.channels[index].causes.program;
        let event = self.raise_in_channel(index, Some(fault.number()), refused, cause);
        self.channels[index].causes.block = event;
    }

    /// A fault of the language as a message.
    pub(super) fn refused_by(&self, index: usize, fault: &Fault) -> Refused {
        let number = match fault.code {
            FaultCode::Syntax => messages::NC_SYNTAX,
            FaultCode::Call => messages::NC_CALL,
            FaultCode::Value => messages::NC_VALUE,
            FaultCode::LinkNotAlone => messages::LINK_NOT_ALONE,
            FaultCode::LinkDenominator => messages::LINK_DENOMINATOR,
            FaultCode::Number(number) => AlarmNumber(number),
        };
        let (third, fourth) = match &fault.pair {
            Some(pair) => {
                let channel = &self.channels[index];
                let axis = channel.axis_named(&pair.axis).or_else(|| self.axis_of(pair.axis.parse().ok()?));
                (axis.map_or_else(|| Detail::Text(pair.axis.clone()), Detail::Axis), Detail::Number(pair.group))
            }
            None => {
                let text = match fault.code {
                    FaultCode::Syntax | FaultCode::Number(_) => {
                        format!("line {}, column {}: {}", fault.line, fault.column, fault.text)
                    }
                    _ => fault.text.clone(),
                };
                (Detail::Text(text), Detail::None)
            }
        };
        Refused(number, third, fourth)
    }

    /// Executes a block. A block that is refused ends the program, and nothing of it acts.
    fn execute(&mut self, index: usize, block: &Block) {
        for warning in &block.warnings {
            self.raise_fault(index, warning);
        }
        let number = block.origin.block();
        if let Err(refused) = self.try_block(index, block) {
            if !self.is_executed(index) {
                // The blocks before it are executed first.
                self.channels[index].prepared = Some(block.clone());
                return;
            }
            let cause = self.channels[index].causes.program;
            let event = self.raise_in_channel(index, Some(number), refused, cause);
            self.channels[index].shown = number;
            self.abort_program(index, event);
        }
    }

    fn try_block(&mut self, index: usize, block: &Block) -> Outcome {
        let mut modal = self.channels[index].modal;
        if let Some(g) = block.g.iter().find(|g| !is_modelled(**g)) {
            return Err(value(&format!("G{g} is not modelled")));
        }
        for g in &block.g {
            match g {
                0..=3 => modal.motion = u16::try_from(*g).unwrap_or(0),
                17..=19 => modal.plane = u16::try_from(*g).unwrap_or(17),
                40 => modal.compensation = false,
                41 | 42 => modal.compensation = true,
                90 => modal.absolute = true,
                91 => modal.absolute = false,
                161 => modal.centre_absolute = true,
                162 => modal.centre_absolute = false,
                // They are words of their own in the block, or have no effect here.
                _ => {}
            }
        }
        if let Some(feed) = block.feed {
            if feed < 0.0 || !feed.is_finite() {
                return Err(value("F is not negative"));
            }
            modal.feed = feed * self.channels[index].feed_unit;
        }
        // A circle without an end point is a full one.
        let is_circle = modal.motion >= 2 && (block.radius.is_some() || block.centre.iter().any(Option::is_some));
        let has_words = !block.axes.is_empty() || is_circle;
        if has_words {
            self.append_motion(index, block, &modal)?;
        }
        self.channels[index].modal = modal;
        if !has_words {
            self.note_block(index, block.origin.block());
        }
        let cause = self.channels[index].causes.block;
        if let Some(dwell) = &block.dwell {
            let cycles = dwell.seconds / self.cycle.0.seconds();
            if !(0.0..=1e12).contains(&cycles) {
                return Err(value("dwell time"));
            }
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within its limits")]
            let whole = cycles.ceil() as u64;
            self.channels[index].wait = if whole == 0 { Wait::Nothing } else { Wait::Dwell(whole) };
        }
        if !block.homing.is_empty() {
            self.begin_homing(index, block, cause)?;
        }
        if let Some(command) = &block.command {
            self.command(index, command, cause)?;
        }
        // M00 holds the program until NC start. M01 does so only on request, and the interface has none.
        self.channels[index].halts |= block.m.contains(&0);
        match block.end {
            Some(End::Program) => self.channels[index].ended = true,
            Some(End::Aborted) => self.abort_with_warning(index, block.origin.block()),
            Some(End::Subroutine) | None => {}
        }
        Ok(())
    }

    /// M30 in a subroutine: the whole program ends, with a warning and without an error state.
    fn abort_with_warning(&mut self, index: usize, block: u32) {
        let channel = &mut self.channels[index];
        let (number, place) = (channel.number, Place::Channel(channel.number));
        let event = self.log.note_one(place, Why::Raised, super::inputs::block(block), channel.causes.program);
        let text = Detail::Text("the end of the program, M02 or M30, stands in a subroutine".to_owned());
        let text = self.pending.parameter(text);
        let parameters = [Parameter::Channel(number), Parameter::Number(block.into()), text, Parameter::None];
        self.pending.raise_as(RaisedAlarm { number: messages::NC_CALL, place, parameters }, None, true, event);
        channel.causes.program = self.log.note_plain(place, Why::ProgramAborted, event);
        channel.task = Task::Aborts;
        channel.interpreter = None;
    }

    /// The block that runs is another one.
    fn note_block(&mut self, index: usize, number: u32) {
        let channel = &mut self.channels[index];
        if channel.shown == number {
            return;
        }
        channel.shown = number;
        let (place, block) = (Place::Channel(channel.number), super::inputs::block(number));
        channel.causes.block = self.log.note_one(place, Why::BlockRuns, block, channel.causes.started);
    }

    fn begin_homing(&mut self, index: usize, block: &Block, cause: EventId) -> Outcome {
        let channel = &self.channels[index];
        if let Some(group) = channel.groups.first() {
            // SG-23.
            return Err(Refused::group(messages::HOMING_WITH_GROUP, group.number.into()));
        }
        let mut axes = Vec::new();
        for (name, order) in &block.homing {
            let axis = channel.axis_named(name).ok_or_else(|| unknown(name))?;
            axes.push((i64::from(*order), axis));
        }
        self.channels[index].wait = Wait::Homing(Job::new(axes, cause));
        Ok(())
    }

    fn command(&mut self, index: usize, command: &Command, cause: EventId) -> Outcome {
        match command {
            Command::Link(link) => self.define_link(index, link),
            Command::LinkOn(group) => self.switch_on(index, *group, Why::GroupOn, cause),
            Command::LinkOff(what) => self.switch_off(index, *what, cause),
            Command::Gantry { is_on, targets } => self.switch_gantry(index, *is_on, targets, cause),
            Command::CallAxis { conflicts, requests, .. } => self.call_axes(index, *conflicts, requests),
            Command::PutAxis(targets) => self.put_axes(index, targets),
            Command::Manual { is_on, axes } => {
                for name in axes {
                    let axis = self.channels[index].axis_named(name).ok_or_else(|| unknown(name))?;
                    let manual = &mut self.channels[index].manual;
                    manual.retain(|other| *other != axis);
                    if *is_on {
                        manual.push(axis);
                    }
                }
                Ok(())
            }
        }
    }
}
