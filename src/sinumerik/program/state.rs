//! The state of a channel's program.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use crate::control::SearchKind;
use crate::motion::path::{PATH_AXES, Path, PathLimits, PerPathAxis};
use crate::nc_program::{AxisIndex, Interpreter, Modal, Origin, ProgramAlarm, SynchronisedAction, g};
use crate::sinumerik::exchange::state::Claim;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::auxiliary::Output;
use crate::sinumerik::program::executable::{Executable, ReadBlock, StateBehind};
use crate::sinumerik::program::main_run::MainRun;
use crate::sinumerik::program::positioning::AxisPositioning;
use crate::sinumerik::program::search_state::Search;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, Position};
use crate::variables::{AlarmNumber, BlockName, EventId, Parameter};

/// 35.0 to 35.4.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum ProgramState {
    /// 35.4: no program runs.
    #[default]
    Aborted,
    /// 35.0.
    Running,
    /// 35.1: it waits for another channel, or for an axis.
    Waiting,
    /// 35.2: by NC stop, a programmed stop, single block, or an alarm.
    Stopped,
    /// 35.3: stopped, and the mode group is in JOG.
    Interrupted,
}

/// Where the stage "programs" wants an axis in this cycle. It is taken over and forgotten in the same cycle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Led {
    /// On the path.
    Path { position: Position, velocity: f64 },
    /// On its own way to a target, with increments per second.
    Target { target: Position, velocity: f64 },
    /// At rest, while the path waits.
    Rest,
}

/// The program of a channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ChannelProgram {
    /// The path of the main program that is selected.
    pub selected: Option<String>,
    /// The path of the blocks given to MDA.
    pub mda: Option<String>,
    pub state: ProgramState,
    /// The event behind the state.
    pub cause: EventId,
    /// 33.5: M2 or M30 has ended a program, and none has started since.
    pub ended: bool,
    /// 32.5: stopped by M0 or M1.
    pub programmed_stop: bool,
    /// 318.5: stopped by an M function that acts as M0 or M1 (MD22254, MD22256).
    pub associated_stop: bool,
    /// 33.7, and the axes that it concerns.
    pub test: ProgramTest,
    /// Synchronised actions, in the order in which they began.
    pub actions: Vec<ActiveAction>,
    /// $AC_TIMER, $AC_MARKER.
    pub main_run: MainRun,
    /// The marks of WAITM and SETM, a bit each.
    pub marks: u128,
    /// Marks that are taken away after the next judgement of waits.
    pub passed_marks: u128,
    /// A search that the operator wants: its block, its type, its event.
    pub search_request: Option<(String, SearchKind, EventId)>,
    /// The event behind the progress of a search: 33.4, 318.1, 32.3, 32.4, 32.6.
    pub search_cause: EventId,
    /// The modal G functions of the block that runs.
    pub modal: Modal,
    /// The event of the block change that set them.
    pub modal_cause: EventId,
    pub output: Output,
    /// Settable offsets: index in G group 8, axis, value.
    pub offsets: Vec<(u8, AxisNumber, Position)>,
    /// The programmable offsets of the block that runs, or of the last one.
    pub programmable: Vec<(AxisIndex, f64)>,
    pub message: Option<String>,
    /// The path feed of the last block that had one, which stays with MD22410.
    pub last_feed: Option<f64>,
    /// The program that runs or is stopped.
    pub run: Option<Box<Run>>,
}

impl ChannelProgram {
    pub(in crate::sinumerik) fn new(parameters: Option<&ProgramParameters>) -> Self {
        Self {
            selected: None,
            mda: None,
            state: ProgramState::Aborted,
            cause: EventId::NONE,
            ended: false,
            programmed_stop: false,
            associated_stop: false,
            test: ProgramTest::default(),
            actions: Vec::new(),
            main_run: MainRun::default(),
            marks: 0,
            passed_marks: 0,
            search_request: None,
            search_cause: EventId::NONE,
            modal: parameters.map_or_else(Modal::default, |parameters| parameters.modal),
            modal_cause: EventId::NONE,
            output: Output::default(),
            offsets: Vec::new(),
            programmable: Vec::new(),
            message: None,
            last_feed: None,
            run: None,
        }
    }

    /// FFWON: G group 24.
    pub(in crate::sinumerik) fn has_feed_forward(&self) -> bool {
        self.modal.is(g::FFWON)
    }

    /// SETM.
    pub(in crate::sinumerik) fn set_marks(&mut self, marks: &[u16]) {
        self.marks |= bits(marks);
    }

    /// CLEARM; without a mark, all of them.
    pub(in crate::sinumerik) fn clear_marks(&mut self, marks: &[u16]) {
        self.marks &= if marks.is_empty() { 0 } else { !bits(marks) };
    }

    /// Whether it has a mark.
    pub(in crate::sinumerik) fn has_mark(&self, mark: u16) -> bool {
        self.marks & bits(&[mark]) != 0
    }

    /// The channel goes on behind a WAITM or WAITMC: its mark is taken away after the next judgement of waits.
    pub(in crate::sinumerik) fn pass_mark(&mut self, mark: u16) {
        self.set_marks(&[mark]);
        self.passed_marks |= bits(&[mark]);
    }

    /// The block search.
    pub(in crate::sinumerik) fn search(&self) -> Option<&Search> {
        self.run.as_ref()?.search.as_deref()
    }

    /// The settable offset of an axis with these G functions.
    pub(in crate::sinumerik) fn active_offset(&self, modal: Modal, axis: AxisNumber) -> Position {
        modal.settable_offset().map_or(Position::ZERO, |index| self.settable_offset(index, axis))
    }

    /// The settable offset of an axis.
    pub(in crate::sinumerik) fn settable_offset(&self, index: u8, axis: AxisNumber) -> Position {
        let found = self.offsets.iter().find(|(of, member, _)| (*of, *member) == (index, axis));
        found.map_or(Position::ZERO, |(.., value)| *value)
    }

    /// Sets the settable offset of an axis.
    pub(in crate::sinumerik) fn set_settable_offset(&mut self, index: u8, axis: AxisNumber, value: Position) {
        self.offsets.retain(|(of, member, _)| (*of, *member) != (index, axis));
        if value != Position::ZERO {
            self.offsets.push((index, axis, value));
        }
    }
}

/// Program test: the axes get no setpoints, everything else runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ProgramTest {
    /// 33.7.
    pub is_active: bool,
    /// The axes that are disabled: those of the channel without 14.0, and those with 14.1.
    pub axes: AxisSet,
    /// The event behind it.
    pub cause: EventId,
}

/// What preparation does next.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Preparation {
    /// Reads on.
    Reads,
    /// Waits until everything has been executed.
    Waits,
    /// There are no more blocks.
    Ended,
    /// A block cannot be executed. `block` is prepared again after a correctable alarm of the channel.
    Failed {
        alarm: BlockAlarm,
        /// Why, in words; empty if the alarm says it.
        reason: String,
        /// The path of its program, and the line.
        place: (String, u32),
        block: Option<Box<ReadBlock>>,
    },
}

impl Preparation {
    /// A block that was read cannot be executed.
    pub(in crate::sinumerik) fn failed(alarm: BlockAlarm, block: Box<ReadBlock>) -> Self {
        let origin = &block.block.origin;
        let place = (origin.program.clone(), origin.line);
        Self::Failed { alarm, reason: String::new(), place, block: Some(block) }
    }
}

/// The alarm of a block, raised when everything before the block has been executed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct BlockAlarm {
    pub number: AlarmNumber,
    /// `%2` to `%4`.
    pub parameters: [Parameter; 3],
    pub block: BlockName,
}

impl BlockAlarm {
    pub(in crate::sinumerik) fn of(alarm: &ProgramAlarm) -> Self {
        let text = |text: &str| {
            if text.is_empty() { Parameter::None } else { Parameter::Text(crate::variables::short_text(text)) }
        };
        Self {
            number: AlarmNumber(alarm.number),
            parameters: [text(&alarm.block), text(&alarm.text), Parameter::None],
            block: block_name(&alarm.block),
        }
    }
}

/// Marks of a channel, a bit each.
fn bits(marks: &[u16]) -> u128 {
    marks.iter().fold(0, |bits, mark| bits | 1 << (mark % 128))
}

/// The name of a block as causes show it.
pub(in crate::sinumerik) fn block_name(name: &str) -> BlockName {
    let mut short = BlockName::new();
    for letter in name.chars() {
        if short.try_push(letter).is_err() {
            break;
        }
    }
    short
}

/// A synchronised action that is evaluated.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ActiveAction {
    pub action: SynchronisedAction,
    /// Its condition held in the last cycle; with FROM, in an earlier one.
    pub held: bool,
    pub is_over: bool,
    /// Without an ID: it ends when this many blocks were executed.
    pub until: Option<u64>,
}

/// What a program waits for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum WaitFor {
    /// WAITM, WAITMC: these channels have the mark.
    Mark { mark: u16, channels: Vec<ChannelNumber> },
    /// WAITE: these channels have ended their programs.
    End(Vec<ChannelNumber>),
}

/// A program that a program starts: its channel, and the event of the block.
pub(in crate::sinumerik) type StartRequest = (ChannelNumber, ChannelNumber, EventId);

/// What the block that runs does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Phase {
    /// No block runs: the next one begins if nothing holds it.
    #[default]
    Between,
    /// Waits until the PLC has acknowledged what is output before the motion.
    Before,
    /// Moves, dwells, references.
    Moving,
    /// Waits until the PLC has acknowledged what is output during or after the motion.
    After,
}

/// A program that runs or is stopped.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Run {
    pub interpreter: Interpreter,
    /// It runs the blocks of MDA.
    pub is_mda: bool,
    pub preparation: Preparation,
    /// The blocks that are prepared. The first one runs, unless the phase is "between".
    pub queue: VecDeque<Executable>,
    /// How many of them are on the path.
    pub on_path: usize,
    pub phase: Phase,
    pub path: Path,
    /// The axes of the path.
    pub limits: PathLimits,
    /// The return to the path.
    pub returning: Option<Path>,
    /// It is over, and the path has not moved since.
    pub has_returned: bool,
    /// Where the prepared blocks end, in machine coordinates.
    pub end: PerPathAxis,
    /// Where its axes were when it stopped between two blocks: the next motion begins there, so that they return first.
    pub left: Vec<(AxisNumber, Position)>,
    /// Numbers the blocks on the path.
    pub numbers: u64,
    /// The feeds of positioning axes (FA), in mm/min or rev/min.
    pub axis_feeds: Vec<(AxisNumber, f64)>,
    /// POS and POSA that move.
    pub positionings: Vec<AxisPositioning>,
    /// The path of a block with a feed has not begun: it waits for the speed of the spindles.
    pub awaits_spindles: bool,
    /// The speeds and directions that prepared blocks have given to spindles: their numbers, rev/min, and 3, 4 or 5.
    pub prepared_spindles: Vec<(u16, f64, i32)>,
    pub spindle_limits: Vec<(bool, AxisNumber, f64)>,
    pub dwell_turns: Option<(AxisNumber, f64)>,
    /// Cycles left of G4.
    pub dwell: u64,
    /// The event with which the block that runs began.
    pub block_cause: EventId,
    /// The cycle in which it began.
    pub block_cycle: u64,
    /// The cycle of the last NC start.
    pub continued_cycle: u64,
    /// The cycle in which NC start has gone on with the program, if it was ever stopped.
    pub read_again_cycle: Option<u64>,
    /// The event that stops the program; it is stopped when its axes are at rest.
    pub stopping: Option<EventId>,
    /// The event of a RESET that ends the program when its axes are at rest.
    pub resetting: Option<EventId>,
    /// DB21.DBX6.2 in the last cycle.
    pub delete_was: bool,
    /// DB31.DBX2.2 of the axes of the path in the last cycle.
    pub axial_delete_were: AxisSet,
    /// The axes on their own ways that brake and drop the rest.
    pub axial_deleting: AxisSet,
    /// The events of their signals.
    pub axial_delete_causes: PerAxis<EventId>,
    /// The rest of the block is dropped when the path is at rest.
    pub deleting: bool,
    /// NC start has cancelled the alarm of a block.
    pub reads_again: bool,
    /// NEWCONF makes stored machine data effective at the end of the stage.
    pub new_conf: bool,
    /// The block whose alarm SETAL has raised, until the next one begins.
    pub alarm_origin: Option<Origin>,
    /// SETAL raises this alarm at the end of its block.
    pub cycle_alarm: Option<BlockAlarm>,
    /// Nothing more is prepared in this cycle.
    pub pauses: bool,
    /// Blocks that are prepared again, before any other.
    pub again: VecDeque<Box<ReadBlock>>,
    /// The axes that the next block needs and its channel does not have.
    pub claim: Option<Claim>,
    /// Nothing is prepared until everything has been executed: the axes may be others then.
    pub holds_preparation: bool,
    /// The axes of G74 in the block that runs, and those whose approach has begun.
    pub referencing: AxisSet,
    pub referencing_started: AxisSet,
    /// Behind the last block that was executed.
    pub behind: StateBehind,
    /// How many blocks were executed.
    pub executed: u64,
    /// R parameters that preparation has written ahead: before which block, index, value before.
    pub r_log: VecDeque<(u64, u16, f64)>,
    /// The skip levels in effect, a bit each.
    pub skips: u16,
    /// The dry run is in effect.
    pub dry_run: bool,
    /// What waits until the path has come to a short stop.
    pub change: Option<Change>,
    /// DB21.DBX6.3 and 6.4 in the last cycle.
    pub level_signals_were: [bool; 2],
    /// Axes that synchronised actions have moved: the path leaves them alone until it begins again.
    pub commanded: AxisSet,
    /// One of them has arrived: blocks behind the one that runs are prepared again.
    pub commanded_arrived: bool,
    /// RDISABLE of a synchronised action in this cycle.
    pub read_in_disabled: bool,
    /// OVR as a factor.
    pub path_override: f64,
    /// FD: what the handwheel adds, as a share of the feed.
    pub handwheel_share: f64,
    /// The axes that the last block which named them has moved on the path: they are no positioning axes.
    pub programmed_on_path: AxisSet,
    /// The offsets with which the axes of the path were last programmed, in increments.
    pub offsets: PerPathAxis,
    /// The axes that the path feed refers to: the geometry axes, or those of FGROUP.
    pub counted: [bool; PATH_AXES],
    /// What it waits for in other channels.
    pub waits: Option<WaitFor>,
    /// The programs that it starts in other channels, at the end of the stage.
    pub starts: Vec<StartRequest>,
    /// A block search, until its approach begins.
    pub search: Option<Box<Search>>,
    /// 32.4: the return to the path is the approach after a search.
    pub approaches: bool,
}

/// A change of program control for which the path stops for a short time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Change {
    /// MD10704 = 1.
    DryRun,
    /// MD10706 = 1.
    Skips,
    /// 6.3: the subprogram that runs is not repeated.
    Passes,
    /// 6.4: the subprogram that runs is left.
    Level,
}

impl Run {
    /// The first block is over.
    pub(in crate::sinumerik) fn take_executed(&mut self) -> Option<Executable> {
        let done = self.queue.pop_front()?;
        self.executed += 1;
        if let Some(behind) = done.behind() {
            self.behind.clone_from(behind);
        }
        let executed = self.executed;
        while self.r_log.front().is_some_and(|(before, ..)| *before < executed) {
            self.r_log.pop_front();
        }
        Some(done)
    }

    /// Whether the path does not move this axis: it is positioned, referenced, or moved by a synchronised action.
    pub(in crate::sinumerik) fn leaves_alone(&self, axis: AxisNumber) -> bool {
        let is_positioned = self.positionings.iter().any(|positioning| positioning.axis == axis);
        is_positioned || self.referencing.contains(axis) || self.commanded.contains(axis)
    }

    /// Whether everything that was prepared has been executed. What POSA moves goes on beyond its block.
    pub(in crate::sinumerik) fn is_executed(&self) -> bool {
        self.queue.is_empty() && self.phase == Phase::Between && self.path.is_empty()
    }

    /// Whether everything has been executed, and nothing moves any more.
    pub(in crate::sinumerik) fn is_at_rest(&self) -> bool {
        self.is_executed() && self.positionings.is_empty()
    }

    /// Axes on their own ways end at their targets, wherever they are now.
    pub(in crate::sinumerik) fn end_of_ways(&self, own: &ProgramParameters, end: &mut PerPathAxis) {
        for one in &self.positionings {
            if let Some(place) = own.axes.place(one.axis) {
                end[place] = one.target.increments() as f64;
            }
        }
    }
}

/// The positions of path axes, in increments.
pub(in crate::sinumerik) fn on_path(axes: &[AxisNumber], position: impl Fn(AxisNumber) -> Position) -> PerPathAxis {
    let mut all = [0.0; PATH_AXES];
    for (place, axis) in all.iter_mut().zip(axes) {
        *place = position(*axis).increments() as f64;
    }
    all
}
