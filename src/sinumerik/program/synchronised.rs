//! Synchronised actions: conditions that the channel evaluates in its cycles, and what it then does.
//!
//! An action with `ID` ends with its program, one with `IDS` stays until CANCEL, one without an ID ends with the next block. Every cycle evaluates
//! them before the path moves, in the order in which they began. A POS moves its axis beside the path, as POSA (P-69).

use crate::nc_program::{
    AuxiliaryFunction, AuxiliaryKind, Dimension, Environment, Frequency, INCH, MainRunAction, SynchronisedAction,
    SystemVariable, Value,
};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::program::auxiliary::Package;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::execution::ProgramMemory;
use crate::sinumerik::program::geometry;
use crate::sinumerik::program::outputs::entry;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::positioning::{AxisPositioning, Handwheel};
use crate::sinumerik::program::state::{ActiveAction, Run};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::single_axis::orders::limit_behind;
use crate::sinumerik::single_axis::state::{Order, OrderedBy};
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{AlarmNumber, BlockName, Input, Parameter, Place, Quantity, short_text};

/// What an action does in this cycle.
enum Effect {
    Move {
        axis: u16,
        value: f64,
        dimension: Dimension,
        feed: Option<f64>,
        id: Option<i32>,
    },
    Output {
        kind: AuxiliaryKind,
        extension: u16,
        value: f64,
    },
    SetMarks(Vec<u16>),
    ClearMarks(Vec<u16>),
    ReadInDisable,
    /// An error of an expression of the action with this ID.
    Failed(u32, Option<i32>),
}

impl State {
    /// A synchronised action begins; one with the same ID ends.
    pub(super) fn begin_action(&mut self, action: SynchronisedAction, run: &Run, stage: &Stage<'_>) {
        let actions = &mut self.programs[stage.channel].actions;
        if action.id.is_some() {
            actions.retain(|other| other.action.id != action.id);
        }
        let until = action.id.is_none().then_some(run.executed + 2);
        actions.push(ActiveAction { action, held: false, is_over: false, until });
    }

    /// CANCEL.
    pub(super) fn cancel_actions(&mut self, ids: &[i32], stage: &Stage<'_>) {
        self.programs[stage.channel].actions.retain(|one| !one.action.id.is_some_and(|id| ids.contains(&id)));
    }

    /// Evaluates the actions of a channel whose program runs or is stopped.
    pub(super) fn run_actions(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) {
        run.read_in_disabled = false;
        let channel = stage.channel;
        if self.programs[channel].actions.is_empty() {
            return;
        }
        let mut actions = std::mem::take(&mut self.programs[channel].actions);
        actions.retain(|one| one.until.is_none_or(|until| run.executed < until));
        let cycle = stage.parameters.cycle.seconds();
        let mut environment = Channel {
            channel,
            parameters: stage.own,
            axes: &self.axes,
            spindles: &self.spindles,
            prepared_spindles: Vec::new(),
            owners: &self.owners,
            single: &self.single,
            coupled: self.coupled_axes(),
            all: stage.parameters,
            r_parameters: &mut self.r_parameters,
            library: sources.library,
            stored: sources.stored,
            written: sources.written,
            tables: sources.tables,
            program: &mut self.programs[channel],
            skips: run.skips,
            restarts: false,
            now: self.log.cycle as f64 * cycle,
            block_begun: run.block_cycle as f64 * cycle,
            modal: run.interpreter.modal(),
            feed: run.interpreter.feed(),
            offset: run.interpreter.offset().to_vec(),
            search_level: 0,
            r_written: Vec::new(),
            end: run.end,
            is_executed: true,
            is_at_rest: true,
            is_inch: stage.parameters.is_inch,
        };
        let mut effects = Vec::new();
        for one in &mut actions {
            match one.is_due(&environment) {
                Ok(false) => {}
                Ok(true) => one.effects(&mut environment, &mut effects),
                Err(number) => {
                    one.is_over = true;
                    effects.push(Effect::Failed(number, one.action.id));
                }
            }
        }
        actions.retain(|one| !one.is_over);
        self.programs[channel].actions = actions;
        for effect in effects {
            self.take_effect(effect, run, stage);
        }
    }

    fn take_effect(&mut self, effect: Effect, run: &mut Run, stage: &Stage<'_>) {
        let channel = stage.channel;
        match effect {
            Effect::Move { axis, value, dimension, feed, id } => {
                self.move_command_axis((axis, id), (value, dimension), feed, run, stage);
            }
            Effect::Output { kind, extension, value } => {
                let mut package = Package::new();
                let extension = Some(extension).filter(|extension| *extension != 0);
                let function = AuxiliaryFunction { kind, extension, axis: None, value, is_quick: false };
                package.push(entry(&function, 0, stage.own));
                // The program does not wait for it.
                self.programs[channel].output.add(&package, run.block_cause, true);
            }
            Effect::SetMarks(marks) => self.programs[channel].set_marks(&marks),
            Effect::ClearMarks(marks) => self.programs[channel].clear_marks(&marks),
            Effect::ReadInDisable => run.read_in_disabled = true,
            Effect::Failed(number, id) => {
                let running = run.queue.front().map(|block| block.origin.name.as_str()).unwrap_or_default();
                let block = id.map_or_else(|| running.to_owned(), |id| format!("ID={id}"));
                let shown = [Parameter::Text(short_text(&block)), Parameter::None, Parameter::None];
                self.raise_of_action(AlarmNumber(number), shown, run, stage);
            }
        }
    }

    /// POS: the axis moves beside the path.
    fn move_command_axis(
        &mut self,
        (name, id): (u16, Option<i32>),
        (value, dimension): (f64, Dimension),
        feed: Option<f64>,
        run: &mut Run,
        stage: &Stage<'_>,
    ) {
        let axes = &stage.own.axes;
        let Some(&axis) = axes.machine_axes.get(usize::from(name)) else { return };
        let Some(place) = axes.place(axis) else {
            // A synchronous axis moves with its leading axis: 14092 as the reason.
            let reason = Parameter::Number(alarms::WRONG_AXIS_TYPE.0.into());
            self.raise_of_action(alarms::COMMAND_AXIS, [Parameter::Axis(axis), reason, Parameter::None], run, stage);
            return;
        };
        let of = *self.owners.of(axis);
        let is_elsewhere = of.channel != stage.channel;
        let refused =
            [Parameter::None, id.map_or(Parameter::None, |id| Parameter::Number(id.into())), Parameter::Axis(axis)];
        if of.holder == Holder::Plc {
            self.raise_of_action(alarms::COMMAND_AXIS_OF_PLC, refused, run, stage);
            return;
        }
        let is_on_path = !run.path.is_empty() && run.path.direction()[place].abs() > 1e-12;
        if is_elsewhere || of.holder == Holder::Program && is_on_path {
            self.raise_of_action(alarms::COMMAND_AXIS_IN_MOTION, refused, run, stage);
            return;
        }
        let parameters = &stage.parameters.axes[axis];
        if !parameters.is_within_modulo(value, dimension) {
            let reason = Parameter::Number(alarms::OUTSIDE_MODULO_RANGE.0.into());
            self.raise_of_action(alarms::COMMAND_AXIS, [Parameter::Axis(axis), reason, Parameter::None], run, stage);
            return;
        }
        // The basic system, whatever the blocks of the program say.
        let unit = if stage.parameters.is_inch && !parameters.rotary { INCH } else { 1.0 };
        let programmed = feed
            .map(|feed| feed * unit)
            .or_else(|| run.axis_feeds.iter().find(|(of, _)| *of == axis).map(|(_, feed)| *feed));
        let velocity = programmed
            .map_or(parameters.positioning_velocity, |feed| parameters.velocity_of_feed(feed))
            .min(parameters.maximum_velocity);
        if velocity <= 0.0 {
            let reason = Parameter::Number(alarms::NO_POSITIONING_VELOCITY.0.into());
            self.raise_of_action(alarms::COMMAND_AXIS, [Parameter::Axis(axis), reason, Parameter::None], run, stage);
            return;
        }
        let from = self.axes[axis].setpoint.position.increments() as f64;
        let wanted = Position::from_user(value * unit).increments() as f64;
        let target = geometry::target(wanted, dimension, from, 0.0, parameters.modulo);
        #[expect(clippy::cast_possible_truncation, reason = "a position fits")]
        let target = Position::new(target.round() as i64);
        let limit = limit_behind(axis, target, &stage.to_nck.axes[axis], parameters);
        if let Some((number, _)) = limit.filter(|_| self.axes[axis].is_referenced()) {
            let reason = Parameter::Number(number.0.into());
            self.raise_of_action(alarms::COMMAND_AXIS, [Parameter::Axis(axis), reason, Parameter::None], run, stage);
            return;
        }
        if of.holder != Holder::Program {
            self.order_command_axis(axis, (target, velocity), run, stage);
            return;
        }
        if run.positionings.iter().any(|one| one.axis == axis && one.target == target) {
            return;
        }
        run.positionings.retain(|one| one.axis != axis);
        run.positionings.push(AxisPositioning {
            axis,
            target,
            velocity,
            waits: false,
            is_rapid: false,
            handwheel: Handwheel::None,
            block: BlockName::new(),
        });
        run.commanded.set(axis, true);
    }

    /// A command axis has arrived: what is prepared behind the block that runs begins where it is now.
    pub(super) fn take_command_axes(&mut self, run: &mut Run, stage: &Stage<'_>) {
        if !run.commanded_arrived || run.on_path > 1 {
            return;
        }
        run.commanded_arrived = false;
        let mut end = run.queue.front().and_then(|block| block.behind()).unwrap_or(&run.behind).end;
        for (place, axis) in stage.own.axes.path.iter().enumerate() {
            if run.commanded.contains(*axis) {
                end[place] = self.axes[*axis].setpoint.position.increments() as f64;
            }
        }
        run.reorganise(end);
    }

    /// An axis that programs do not have: the action takes it as a command axis. One that has arrived begins again with another target.
    fn order_command_axis(
        &mut self,
        axis: AxisNumber,
        (target, velocity): (Position, f64),
        run: &Run,
        stage: &Stage<'_>,
    ) {
        let Some(unit) = self.unit_of(axis) else { return };
        let known = self.single.axes[axis].order.map_or(self.axes[axis].setpoint.position, |order| order.target);
        let is_command = self.owners.of(axis).holder == Holder::Command;
        if is_command && known == target {
            return;
        }
        let inputs = [Input::Length(Quantity::Target, axis, target), Input::None, Input::None];
        if !is_command {
            self.hand_over(&unit, stage.channel, Rule::TakenByAction, inputs, run.block_cause, stage.parameters);
        }
        let cause = self.log.note(Place::Axis(axis), Rule::ActionStarts, inputs, run.block_cause);
        let order =
            Order { target, velocity, by: OrderedBy::Action, cause, by_handwheel: false, begun: false, ending: None };
        self.begin_order(axis, order);
        self.single.note_watched(axis);
    }

    fn raise_of_action(
        &mut self,
        number: AlarmNumber,
        [second, third, fourth]: [Parameter; 3],
        run: &Run,
        stage: &Stage<'_>,
    ) {
        let place = Place::Channel(stage.channel);
        let event = self.log.note_one(place, Rule::ActionRefused, Input::None, run.block_cause);
        let shown = [Parameter::Channel(stage.channel), second, third, fourth];
        self.alarms.raise(number, place, shown, event);
    }
}

impl Run {
    /// Whether the next block has to wait for a command axis: the path takes it back when it has arrived.
    pub(super) fn waits_for_command_axis(&self, stage: &Stage<'_>) -> bool {
        let way = self.queue.front().and_then(|block| block.way);
        let is_moved =
            |place: usize| way.is_some_and(|block| (block.way.end()[place] - block.way.start()[place]).abs() >= 0.5);
        let is_busy = |axis| self.commanded.contains(axis) && self.positionings.iter().any(|one| one.axis == axis);
        let mut path = stage.own.axes.path.iter().enumerate();
        self.commanded_arrived || path.any(|(place, axis)| is_moved(place) && is_busy(*axis))
    }
}

impl ActiveAction {
    /// Whether it acts in this cycle.
    fn is_due(&mut self, environment: &dyn Environment) -> Result<bool, u32> {
        let holds = match &self.action.condition {
            Some(condition) => condition.holds(environment)?,
            None => true,
        };
        let before = std::mem::replace(&mut self.held, holds);
        Ok(match self.action.frequency {
            Frequency::Always => true,
            Frequency::Whenever => holds,
            Frequency::Every => holds && !before,
            Frequency::Once => {
                self.is_over = holds;
                holds
            }
            Frequency::From => {
                self.held |= before;
                self.held
            }
        })
    }

    fn effects(&mut self, environment: &mut Channel<'_>, effects: &mut Vec<Effect>) {
        let mut feed = None;
        for action in &self.action.actions {
            let done = match action {
                MainRunAction::AxisFeed(_, value) => value.number(environment).map(|value| {
                    feed = Some(value);
                    None
                }),
                MainRunAction::Position { axis, value, dimension } => value.number(environment).map(|value| {
                    Some(Effect::Move { axis: axis.0, value, dimension: *dimension, feed: None, id: self.action.id })
                }),
                MainRunAction::Auxiliary { kind, extension, value } => value
                    .auxiliary(*kind, environment)
                    .map(|value| Some(Effect::Output { kind: *kind, extension: extension.unwrap_or(0), value })),
                MainRunAction::Assign { name, indices, value } => {
                    value.value(environment).and_then(|value| assign(environment, name, indices, &value)).map(|()| None)
                }
                MainRunAction::ReadInDisable => Ok(Some(Effect::ReadInDisable)),
                MainRunAction::SetMarks(marks) => Ok(Some(Effect::SetMarks(marks.clone()))),
                MainRunAction::ClearMarks(marks) => Ok(Some(Effect::ClearMarks(marks.clone()))),
            };
            match done {
                Ok(effect) => effects.extend(effect),
                Err(number) => {
                    self.is_over = true;
                    effects.push(Effect::Failed(number, self.action.id));
                }
            }
        }
        // FA of the same action, in whatever order it is written.
        if let Some(programmed) = feed {
            for effect in effects.iter_mut() {
                if let Effect::Move { feed, .. } = effect {
                    feed.get_or_insert(programmed);
                }
            }
        }
    }
}

/// `$R[n]=`, `$AC_MARKER[n]=`, `$AC_TIMER[n]=`.
fn assign(environment: &mut Channel<'_>, name: &str, indices: &[Value], value: &Value) -> Result<(), u32> {
    if name == "$R" {
        let index = indices.first().and_then(Value::number).unwrap_or(-1.0);
        if index.fract() != 0.0 || index < 0.0 || index >= f64::from(environment.r_parameters()) {
            return Err(17020);
        }
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "tested above")]
        environment.set_r_parameter(index as u32, value.number().ok_or(12150_u32)?);
        return Ok(());
    }
    let variable = SystemVariable { name, indices };
    environment.set_system(&variable, value).map_err(crate::nc_program::VariableRefusal::number)
}
