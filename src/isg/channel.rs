//! A channel: its axes, its program, its path, and its coupling groups.

use std::collections::{BTreeMap, VecDeque};

use serde::{Deserialize, Serialize};

use super::groups::{Definition, Group};
use super::homing::job::Job;
use super::language::{Block, Fault, Interpreter};
use crate::motion::coupling::Coupling;
use crate::motion::path::{Path, PerPathAxis};
use crate::units::{AxisNumber, ChannelNumber, Position};
use crate::variables::EventId;

/// An axis of a channel.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Member {
    /// The channel index: 0 to 2 are the main axes.
    pub index: u16,
    /// The name in NC programs (P-CHAN-00006).
    pub name: String,
    pub axis: AxisNumber,
}

/// What the PLC commands, as it acts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Inputs {
    pub start: bool,
    pub reset: bool,
    pub feed_hold: bool,
    pub single_block: bool,
    /// In 0.1 %.
    pub feed_override: u16,
    /// The skip levels, a bit each.
    pub skipped: u32,
}

impl Default for Inputs {
    fn default() -> Self {
        Self { start: false, reset: false, feed_hold: false, single_block: false, feed_override: 1000, skipped: 0 }
    }
}

/// What the channel does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Task {
    #[default]
    Idle,
    /// A program runs.
    Runs,
    /// A program runs, and stands after a block until NC start.
    Stands,
    /// The axes brake; then the program is over.
    Aborts,
}

/// What the program waits for.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) enum Wait {
    #[default]
    Nothing,
    /// Cycles of a dwell.
    Dwell(u64),
    Homing(Job),
}

/// The events behind the signals of a channel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct ChannelCauses {
    pub program: EventId,
    pub error: EventId,
    pub block: EventId,
    /// The NC start that the present block needed.
    pub started: EventId,
    /// The program stands, or goes on.
    pub stands: EventId,
    pub selected: EventId,
    pub feed_override: EventId,
    pub skipped: EventId,
    pub reset: EventId,
}

/// The modal words of a program.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Modal {
    /// G00 to G03.
    pub motion: u16,
    /// G90.
    pub absolute: bool,
    /// G17 to G19.
    pub plane: u16,
    /// In mm/min.
    pub feed: f64,
    /// G41 or G42.
    pub compensation: bool,
    /// G161: I, J and K are positions.
    pub centre_absolute: bool,
}

impl Default for Modal {
    /// The initial state: G00, G17, G90, G162, no compensation.
    fn default() -> Self {
        Self { motion: 0, absolute: true, plane: 17, feed: 0.0, compensation: false, centre_absolute: false }
    }
}

/// A channel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Channel {
    pub number: ChannelNumber,
    /// The axes of the channel list.
    pub configured: Vec<Member>,
    pub axes: Vec<Member>,
    pub inputs: Inputs,
    pub causes: ChannelCauses,
    /// The path of the selected program.
    pub selected: Option<String>,
    pub task: Task,
    pub wait: Wait,
    pub completed: bool,
    pub error: bool,
    pub interpreter: Option<Interpreter>,
    /// A block that waits until everything before has been executed.
    pub prepared: Option<Block>,
    /// An error that is raised when everything before has been executed.
    pub fault: Option<Fault>,
    /// The program has no more blocks.
    pub ended: bool,
    pub path: Option<Path>,
    pub path_axes: Vec<AxisNumber>,
    /// The blocks of the path: their numbers there, and as they are shown.
    pub blocks: VecDeque<(u64, u32)>,
    pub next_block: u64,
    /// Where the last block of the path ends.
    pub end: PerPathAxis,
    /// Single block: a block has been fetched since the last stop.
    pub fetched_one: bool,
    /// The program has been started in this cycle: it is active for a cycle at least.
    pub is_new: bool,
    /// M00: the program is held when everything before has been executed.
    pub halts: bool,
    /// The block that runs without the path.
    pub shown: u32,
    pub modal: Modal,
    /// Initial feed in mm/min (P-CHAN-00099), and the unit of F in mm/min (P-CHAN-00108).
    pub first_feed: f64,
    pub feed_unit: f64,
    /// Axes in manual mode (G201).
    pub manual: Vec<AxisNumber>,
    /// Coupling groups by number; group 0 is of the channel list.
    pub definitions: BTreeMap<u16, Definition>,
    pub groups: Vec<Group>,
    pub last_group: u16,
    /// Groups that the next program start switches on again.
    pub restored: Vec<u16>,
    /// A program end has switched them off (P-CHAN-00105), not a reset (P-CHAN-00104).
    pub restored_from_end: bool,
    /// A program has been started, and those groups are not on yet.
    pub restores: bool,
    /// A reset waits until the axes stand.
    pub resets: bool,
    /// A reset has left the error of a drive: what the drives report of its cycle still counts.
    pub awaits_drives: bool,
    /// P-CHAN-00104 and P-CHAN-00105.
    pub restores_after_reset: bool,
    pub restores_after_end: bool,
    /// P-CHAN-00460.
    pub retains_axes: bool,
    /// P-CHAN-00346.
    pub always_shortest_way: bool,
}

impl Channel {
    /// A channel after the start of the controller.
    pub(super) fn new(number: ChannelNumber) -> Self {
        Self {
            number,
            configured: Vec::new(),
            axes: Vec::new(),
            inputs: Inputs::default(),
            causes: ChannelCauses::default(),
            selected: None,
            task: Task::Idle,
            wait: Wait::Nothing,
            completed: false,
            error: false,
            interpreter: None,
            prepared: None,
            fault: None,
            ended: false,
            path: None,
            path_axes: Vec::new(),
            blocks: VecDeque::new(),
            next_block: 0,
            end: PerPathAxis::default(),
            fetched_one: false,
            is_new: false,
            halts: false,
            shown: 0,
            modal: Modal::default(),
            first_feed: 0.0,
            feed_unit: 1.0,
            manual: Vec::new(),
            definitions: BTreeMap::new(),
            groups: Vec::new(),
            last_group: 0,
            restored: Vec::new(),
            restored_from_end: false,
            restores: false,
            resets: false,
            awaits_drives: false,
            restores_after_reset: false,
            restores_after_end: false,
            retains_axes: false,
            always_shortest_way: false,
        }
    }

    /// A program runs, is held, or is being aborted.
    pub(super) fn is_active(&self) -> bool {
        self.task != Task::Idle
    }

    /// Whether a movement or the program is held.
    pub(super) fn is_held(&self) -> bool {
        match self.task {
            Task::Stands => true,
            Task::Runs => self.inputs.feed_hold || self.inputs.feed_override == 0,
            Task::Idle | Task::Aborts => false,
        }
    }

    /// The state of the channel on the HLI.
    pub(super) fn hli_state(&self) -> u8 {
        match self.task {
            _ if self.error => 6,
            _ if self.is_held() => 5,
            Task::Runs | Task::Stands | Task::Aborts => 4,
            Task::Idle if self.selected.is_some() => 3,
            Task::Idle => 2,
        }
    }

    /// The block that runs, as it is shown.
    pub(super) fn block(&self) -> u32 {
        let of_path = self.path.as_ref().and_then(|path| path.current()).map(|(block, _)| block.number);
        let shown = of_path.and_then(|number| self.blocks.iter().find(|(other, _)| *other == number));
        match self.task {
            Task::Idle => 0,
            // The block that has ended, although others may be on the path already.
            Task::Stands => self.shown,
            _ => shown.map_or(self.shown, |(_, shown)| *shown),
        }
    }

    /// Whether the path has nothing left to move.
    pub(super) fn has_moved(&self) -> bool {
        self.path.as_ref().is_none_or(Path::is_empty)
    }

    /// Whether an axis moves in the present block.
    pub(super) fn moves(&self, axis: AxisNumber) -> bool {
        let index = self.path_axes.iter().position(|other| *other == axis);
        let path = self.path.as_ref().filter(|path| !path.is_empty());
        index.zip(path).is_some_and(|(index, path)| path.direction()[index] != 0.0)
    }

    /// The end of the present block for an axis.
    #[expect(clippy::cast_possible_truncation, reason = "the cast saturates")]
    pub(super) fn target(&self, axis: AxisNumber) -> Option<Position> {
        let index = self.path_axes.iter().position(|other| *other == axis)?;
        let (block, _) = self.path.as_ref()?.current()?;
        Some(Position::new(block.way.end()[index].round() as i64))
    }

    /// The couplings of the active groups.
    pub(super) fn couplings(&self) -> impl Iterator<Item = &Coupling> {
        self.groups.iter().flat_map(|group| &group.couplings)
    }

    /// The couplings of the active groups.
    pub(super) fn couplings_mut(&mut self) -> impl Iterator<Item = &mut Coupling> {
        self.groups.iter_mut().flat_map(|group| &mut group.couplings)
    }

    /// Whether an axis is the slave of an active group.
    pub(super) fn is_slave(&self, axis: AxisNumber) -> bool {
        self.couplings().any(|coupling| coupling.followers().any(|follower| follower == axis))
    }

    /// Whether an axis is a member of an active group.
    pub(super) fn is_in_group(&self, axis: AxisNumber) -> bool {
        self.couplings().any(|coupling| coupling.members().any(|member| member == axis))
    }

    /// The axis of a name in NC programs.
    pub(super) fn axis_named(&self, name: &str) -> Option<AxisNumber> {
        self.axes.iter().find(|member| member.name == name).map(|member| member.axis)
    }

    /// The channel index of an axis.
    pub(super) fn index_of(&self, axis: AxisNumber) -> Option<u16> {
        self.axes.iter().find(|member| member.axis == axis).map(|member| member.index)
    }
}
