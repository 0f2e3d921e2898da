//! Block search: the program goes on at a block that the operator names.
//!
//! | type | what it does |
//! |---|---|
//! | without calculation (1) | the program begins at the block, as if there were nothing before it |
//! | contour (2), block end point (4) | calculates everything up to the block: R parameters, positions, the last auxiliary function of each group; nothing moves, nothing is output. Then the axes go to the start, or to the end, of the block |
//! | SERUPRO (5) | executes everything up to the block in a program test: with outputs, at another speed (MD22600), and without motion of any axis. Then the axes go to where the block starts |
//!
//! The block may also be one that calculates, jumps or calls: the program then stands before it, and types 2, 4 and 5 approach where the axes are
//! there. After the search the program is stopped. NC start outputs the functions that types 2 and 4 have collected, in action blocks (32.3); with the
//! last one (32.6), and with 1.6 if MD11450 bit 0 says so, 10208 asks for another NC start. That cancels 10208; the axes approach the
//! block together (32.4), and the program goes on. A leading axis takes its grouping along, in the search and in the approach (MIS-10).

use crate::control::SearchKind;
use crate::image::{ToNck, channel_to_nck};
use crate::motion::path::{Feed, Path, PathBlock, Way};
use crate::nc_program::{Action, AuxiliaryKind, BlockTarget, Interpreter, Library, is_of_spindle, predefined_group};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::inputs::channel_signal;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::Mode;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::auxiliary::{Entry, Package};
use crate::sinumerik::program::execution::ProgramMemory;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::search_state::{Search, SearchProgress};
use crate::sinumerik::program::state::{BlockAlarm, Phase, Preparation, ProgramState, Run, block_name, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisSet, ChannelNumber, Position};
use crate::variables::{AlarmNumber, EventId, Input, Parameter, Place, short_text};

/// Blocks that a search calculates in a cycle.
const BLOCKS: usize = 1_000;

/// The group of a function, if a search collects it (MD22000 to 22030, else the predefined groups of spindle functions).
fn collected_group(entry: &Entry, own: &ProgramParameters) -> Option<u32> {
    if let Some(group) = own.auxiliary_group(entry.kind, entry.extension, entry.value) {
        return (group > 1).then_some(group);
    }
    match entry.kind {
        AuxiliaryKind::M if is_of_spindle(entry.value) => predefined_group(entry.value.round()).map(u32::from),
        AuxiliaryKind::S => Some(3),
        _ => None,
    }
}

impl Nck {
    /// A search of the operator, which begins in the next cycle.
    pub(in crate::sinumerik) fn search(&mut self, channel: ChannelNumber, target: &str, kind: SearchKind) -> EventId {
        let wanted = Input::Block(block_name(target));
        let event = self.state.log.note_one(Place::Channel(channel), Rule::SearchStarted, wanted, EventId::NONE);
        self.state.programs[channel].search_request = Some((target.to_owned(), kind, event));
        event
    }

    /// Begins the searches that the operator wants. What hinders one is an alarm.
    pub(in crate::sinumerik) fn start_searches(&mut self, to_nck: &ToNck) {
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        for (channel, _) in parameters.existing_channels() {
            let Some((target, kind, event)) = state.programs[channel].search_request.take() else { continue };
            if let Err((number, second)) =
                state.start_search(channel, (&target, kind), (parameters, &self.programs), to_nck, event)
            {
                let second = Parameter::Text(short_text(&second));
                let shown = [Parameter::Channel(channel), second, Parameter::None, Parameter::None];
                state.alarms.raise(number, Place::Channel(channel), shown, event);
            } else if kind == SearchKind::ProgramTest {
                // All axes of the channel are in program test from this cycle on.
                self.resting.wake_all();
            }
        }
    }
}

impl State {
    /// Begins a search, or names the alarm that refuses it and its second parameter.
    fn start_search(
        &mut self,
        channel: ChannelNumber,
        (target, kind): (&str, SearchKind),
        (parameters, library): (&Parameters, &Library),
        to_nck: &ToNck,
        event: EventId,
    ) -> Result<(), (AlarmNumber, String)> {
        const ACTION: &str = "block search";
        let refused = |number| Err((number, ACTION.to_owned()));
        let Some(own) = parameters.programs[channel].as_deref() else { return Ok(()) };
        let program = &self.programs[channel];
        let by_test = kind == SearchKind::ProgramTest;
        let runs = matches!(program.state, ProgramState::Running | ProgramState::Waiting);
        let search = program.run.as_ref().and_then(|run| run.search.as_deref());
        if search.is_some_and(Search::is_by_program_test) {
            return refused(alarms::DURING_SERUPRO);
        }
        if self.mode_groups[parameters.mode_group(channel)].mode != Mode::Automatic {
            return refused(alarms::MODE_NOT_SUITABLE);
        }
        if runs || program.state != ProgramState::Aborted && !by_test {
            return refused(alarms::ONLY_IN_RESET);
        }
        if by_test && to_nck.channels[channel].activate_dry_run_feedrate() {
            return refused(alarms::NOT_IN_DRY_RUN);
        }
        if by_test && !program.test.axes.is_empty() {
            return refused(alarms::NOT_IN_PROGRAM_TEST);
        }
        let selected = program.selected.clone().unwrap_or_default();
        let Some(found) = library.program(&selected) else {
            let shown = if selected.is_empty() { alarms::NONE_SELECTED } else { &selected };
            return Err((alarms::SEARCH_WITHOUT_PROGRAM, shown.to_owned()));
        };
        let Some(wanted) = BlockTarget::new(target) else {
            let is_number = target.trim_start().starts_with(['N', 'n', ':']);
            let number = if is_number { alarms::SEARCH_BLOCK_NUMBER } else { alarms::SEARCH_LABEL };
            return Err((number, target.to_owned()));
        };
        let mut interpreter = Interpreter::new(&selected, own.modal, self.initial_feed(channel, own), false);
        if kind == SearchKind::WithoutCalculation && !interpreter.go_to(&found, &wanted) {
            return Err((alarms::SEARCH_TARGET_MISSING, target.to_owned()));
        }
        if kind != SearchKind::WithoutCalculation {
            interpreter.stop_before(wanted);
        }
        let mut run = self.new_run((channel, false), interpreter, own, (parameters, to_nck), event);
        run.search = Some(Box::new(Search {
            kind,
            target: target.to_owned(),
            progress: SearchProgress::Searching,
            collected: Vec::new(),
            approach: None,
            begun: false,
        }));
        let program = &mut self.programs[channel];
        if by_test {
            (program.test.axes, program.test.cause) = (parameters.channels[channel].axes, event);
        }
        program.run = Some(Box::new(run));
        (program.state, program.cause, program.ended) = (ProgramState::Running, event, false);
        (program.programmed_stop, program.associated_stop) = (false, false);
        (program.modal, program.modal_cause, program.search_cause) = (own.modal, event, event);
        Ok(())
    }

    /// A cycle of a search that executes nothing, of a search that has found its block, or of its action blocks. Returns whether the program
    /// does nothing else in this cycle.
    pub(super) fn run_search(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) -> bool {
        let Some(search) = run.search.as_deref() else { return false };
        let runs = matches!(self.programs[stage.channel].state, ProgramState::Running | ProgramState::Waiting);
        match search.progress {
            SearchProgress::Searching if search.calculates() => {
                self.calculate(run, stage, sources);
                true
            }
            SearchProgress::Searching => false,
            SearchProgress::Found if search.kind == SearchKind::ProgramTest => {
                // The setpoints take the positions of the machine again.
                let axes = stage.parameters.channels[stage.channel].axes;
                if axes.iter().all(|axis| self.axes[axis].signals.disabled_at().is_none()) {
                    self.search_is_ready(run, stage);
                }
                true
            }
            SearchProgress::Found => {
                if runs {
                    self.begin_actions(run, stage);
                }
                true
            }
            SearchProgress::Acting => {
                // The last action block is output when nothing waits behind it.
                if !self.programs[stage.channel].output.is_waiting() {
                    self.search_goes_on(run, stage, SearchProgress::LastAction, Rule::SearchActions, Input::None);
                }
                true
            }
            SearchProgress::LastAction | SearchProgress::WaitsForPlc => {
                let done = stage.to_nck.channels[stage.channel].plc_action_completed();
                let waits = stage.parameters.search_waits_for_plc && !done;
                let is_output = !self.programs[stage.channel].output.is_busy();
                if is_output && !waits {
                    self.search_is_ready(run, stage);
                } else if is_output && search.progress == SearchProgress::LastAction {
                    self.search_goes_on(run, stage, SearchProgress::WaitsForPlc, Rule::SearchActed, Input::None);
                }
                true
            }
            SearchProgress::Ready => {
                if runs {
                    self.begin_approach(run, stage);
                }
                !runs
            }
        }
    }

    fn search_goes_on(
        &mut self,
        run: &mut Run,
        stage: &Stage<'_>,
        to: SearchProgress,
        rule: Rule,
        input: Input,
    ) -> EventId {
        let before = self.programs[stage.channel].search_cause;
        let event = self.log.note_one(Place::Channel(stage.channel), rule, input, before);
        self.programs[stage.channel].search_cause = event;
        if let Some(search) = &mut run.search {
            search.progress = to;
        }
        event
    }

    /// Calculates up to the target.
    fn calculate(&mut self, run: &mut Run, stage: &Stage<'_>, sources: &mut ProgramMemory<'_>) {
        let Some(search) = &mut run.search else { return };
        if !std::mem::replace(&mut search.begun, true) {
            return;
        }
        if search.kind == SearchKind::WithoutCalculation {
            self.found(run, stage);
            self.search_is_ready(run, stage);
            return;
        }
        for _ in 0..BLOCKS {
            if run.queue.is_empty() {
                self.prepare(run, stage, sources);
            }
            let Some(search) = &mut run.search else { return };
            let Some(block) = run.queue.front() else {
                match &run.preparation {
                    Preparation::Failed { alarm, .. } => {
                        let alarm = *alarm;
                        run.search = None;
                        self.raise_block_alarm(alarm, run, stage);
                        self.programs[stage.channel].search_cause = self.programs[stage.channel].cause;
                    }
                    Preparation::Ended => self.target_is_missing(run, stage),
                    Preparation::Reads | Preparation::Waits => {}
                }
                return;
            };
            if search.is_target(&block.origin) {
                self.found(run, stage);
                return;
            }
            for entry in block.outputs.iter().flatten() {
                if let Some(group) = collected_group(entry, stage.own) {
                    search.collected.retain(|other| collected_group(other, stage.own) != Some(group));
                    search.collected.push(*entry);
                }
            }
            let (modal, ends) = (block.modal, block.end.is_some() && block.origin.level == 0);
            let message = block.actions.iter().rev().find_map(|action| match action {
                Action::Message(text) => Some(text.clone()),
                _ => None,
            });
            let input = Input::Block(block_name(&block.origin.name));
            if self.programs[stage.channel].modal != modal {
                let before = self.programs[stage.channel].search_cause;
                let event = self.log.note_one(Place::Channel(stage.channel), Rule::SearchCalculates, input, before);
                (self.programs[stage.channel].modal, self.programs[stage.channel].modal_cause) = (modal, event);
            }
            let program = &mut self.programs[stage.channel];
            if let Some(message) = message {
                program.message = message;
            }
            run.take_executed();
            if ends {
                self.target_is_missing(run, stage);
                return;
            }
        }
    }

    /// 15350: the program has ended before its target.
    pub(super) fn target_is_missing(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let Some(search) = run.search.take() else { return };
        let alarm = BlockAlarm {
            number: alarms::SEARCH_NOT_FOUND,
            parameters: [Parameter::Text(short_text(&search.target)), Parameter::None, Parameter::None],
            block: block_name(&search.target),
        };
        let input = Input::Block(block_name(&search.target));
        let before = self.programs[stage.channel].search_cause;
        let event = self.log.note_one(Place::Channel(stage.channel), Rule::SearchMissed, input, before);
        let program = &mut self.programs[stage.channel];
        (program.test.axes, program.test.cause, program.search_cause) = (AxisSet::NONE, event, event);
        run.block_cause = event;
        self.raise_block_alarm(alarm, run, stage);
    }

    /// The target was found: the program is stopped before it.
    pub(super) fn found(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let Some(kind) = run.search.as_ref().map(|search| search.kind) else { return };
        let name = run.queue.front().map(|block| block.origin.name.clone()).unwrap_or_default();
        let input = if name.is_empty() { Input::None } else { Input::Block(block_name(&name)) };
        let cause = self.search_goes_on(run, stage, SearchProgress::Found, Rule::SearchFound, input);
        // A block that calculates is read again when the program goes on.
        let calculates = run.queue.front().is_some_and(|block| block.stands_before);
        if calculates {
            run.queue.pop_front();
        }
        let axes = &stage.own.axes.path;
        let approach = match kind {
            SearchKind::WithoutCalculation => None,
            SearchKind::Contour => Some(run.behind.end),
            SearchKind::EndPoint if calculates => Some(run.behind.end),
            SearchKind::EndPoint => {
                let end = run.queue.front().and_then(|block| block.behind()).map(|behind| behind.end);
                if let Some(block) = run.queue.front_mut() {
                    let waits = block.positions.drain(..).any(|positioning| positioning.waits);
                    block.ends_approach = block.way.take().is_some_and(|way| way.exact_stop) || waits;
                }
                end
            }
            SearchKind::ProgramTest => Some(on_path(axes, |axis| self.axes[axis].setpoint.position)),
        };
        let Some(search) = &mut run.search else { return };
        search.approach = approach;
        if kind == SearchKind::ProgramTest {
            (self.programs[stage.channel].test.axes, self.programs[stage.channel].test.cause) = (AxisSet::NONE, cause);
        }
        self.stop_program(stage.channel, cause);
    }

    /// NC start after the search: action blocks, as many as the functions need.
    fn begin_actions(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let cause = self.programs[stage.channel].cause;
        self.programs[stage.channel].search_cause = cause;
        let Some(search) = &mut run.search else { return };
        let collected = std::mem::take(&mut search.collected);
        if collected.is_empty() {
            self.search_goes_on(run, stage, SearchProgress::LastAction, Rule::SearchActions, Input::None);
            return;
        }
        // M, S and H functions have their own places in each action block.
        let mut package = Package::new();
        let mut packages = Vec::new();
        let room = |package: &Package, entry: &Entry| {
            let places = match entry.kind {
                AuxiliaryKind::M => 5,
                AuxiliaryKind::S | AuxiliaryKind::H => 3,
                AuxiliaryKind::F => 6,
                AuxiliaryKind::T | AuxiliaryKind::D | AuxiliaryKind::SumOffset => 1,
            };
            package.iter().filter(|other| other.kind == entry.kind).count() < places && !package.is_full()
        };
        for mut entry in collected {
            if !room(&package, &entry) {
                packages.push(std::mem::take(&mut package));
            }
            let place = package.iter().filter(|other| other.kind == entry.kind).count();
            entry.place = u8::try_from(place).unwrap_or(0);
            package.push(entry);
        }
        packages.push(package);
        let to = if packages.len() > 1 { SearchProgress::Acting } else { SearchProgress::LastAction };
        let event = self.search_goes_on(run, stage, to, Rule::SearchActions, Input::None);
        for package in packages {
            self.programs[stage.channel].output.add(&package, event, false);
        }
    }

    /// 10208: NC start begins the approach.
    fn search_is_ready(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let done = channel_signal(stage.channel, channel_to_nck::plc_action_completed, true);
        let input =
            if stage.parameters.search_waits_for_plc && stage.to_nck.channels[stage.channel].plc_action_completed() {
                done
            } else {
                Input::None
            };
        let cause = self.search_goes_on(run, stage, SearchProgress::Ready, Rule::SearchReady, input);
        let shown = [Parameter::Channel(stage.channel), Parameter::None, Parameter::None, Parameter::None];
        self.alarms.raise(alarms::CONTINUE_AFTER_SEARCH, Place::Channel(stage.channel), shown, cause);
        self.stop_program(stage.channel, cause);
    }

    /// NC start after 10208: all axes of the path go together to the start, or to the end, of the block.
    fn begin_approach(&mut self, run: &mut Run, stage: &Stage<'_>) {
        let cause = self.programs[stage.channel].cause;
        let Some(search) = run.search.take() else { return };
        self.programs[stage.channel].search_cause = cause;
        run.phase = Phase::Between;
        run.path.clear();
        run.on_path = 0;
        let axes = &stage.own.axes;
        let from = on_path(&axes.path, |axis| self.axes[axis].setpoint.position);
        let to = search.approach.unwrap_or(from);
        if search.kind == SearchKind::WithoutCalculation {
            run.end = from;
            return;
        }
        run.path.place(to);
        let feed = match stage.own.approach_feed {
            feed if feed > 0.0 => Feed::Programmed(feed * Position::PER_USER_UNIT / 60.0),
            _ => Feed::Rapid,
        };
        let mut way = Path::new(from, run.limits);
        let block = PathBlock { number: 0, way: Way::line(from, to, axes.counted), feed, exact_stop: false };
        if way.append(block, stage.parameters.cycle.seconds()).is_ok() {
            run.returning = Some(way);
            run.approaches = true;
        }
    }

    /// 32.4 ends with the approach.
    pub(super) fn end_approach(&mut self, run: &mut Run, stage: &Stage<'_>) {
        if run.approaches && run.returning.is_none() {
            run.approaches = false;
            let before = self.programs[stage.channel].search_cause;
            let event = self.log.note_plain(Place::Channel(stage.channel), Rule::ApproachEnds, before);
            self.programs[stage.channel].search_cause = event;
        }
    }
}
