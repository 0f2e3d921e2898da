//! A block that is ready to be executed, and the state of preparation behind it.

use serde::{Deserialize, Serialize};

use crate::motion::path::{PATH_AXES, PathBlock, PerPathAxis};
use crate::nc_program::{Action, Block, End, Interpreter, Modal, Origin, g};
use crate::sinumerik::parameters::programs::{OutputTime, ProgramParameters};
use crate::sinumerik::program::auxiliary::Package;
use crate::sinumerik::program::positioning::AxisPositioning;
use crate::units::{AxisNumber, AxisSet, Position};

/// The state of preparation behind a block: from there it can read on once more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct StateBehind {
    pub interpreter: Interpreter,
    pub axis_feeds: Vec<(AxisNumber, f64)>,
    pub path_override: f64,
    pub programmed_on_path: AxisSet,
    /// The offsets with which the axes of the path were last programmed.
    pub offsets: PerPathAxis,
    /// The axes that the path feed refers to (FGROUP).
    pub counted: [bool; PATH_AXES],
    /// Where the axes of the path are then.
    pub end: PerPathAxis,
}

/// A block that was read, with the interpreter before it and the state behind it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ReadBlock {
    pub block: Block,
    pub before: Interpreter,
    pub behind: StateBehind,
}

/// A block that is ready to be executed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Executable {
    pub origin: Origin,
    pub modal: Modal,
    /// Its motion on the path.
    pub way: Option<PathBlock>,
    /// When its exact stop is reached.
    pub criterion: Criterion,
    /// G4 in cycles.
    pub dwell: u64,
    pub dwell_turns: Option<(AxisNumber, f64)>,
    /// POS and POSA.
    pub positions: Vec<AxisPositioning>,
    /// G74.
    pub references: Vec<AxisNumber>,
    /// What else it does, at its beginning.
    pub actions: Vec<Action>,
    /// Auxiliary functions before, during and at the end of the motion.
    pub outputs: [Package; 3],
    pub stop: ProgrammedStop,
    pub end: Option<End>,
    /// Single block type 1 stops after it.
    pub is_executable: bool,
    /// FD: a handwheel changes its feed.
    pub by_handwheel: bool,
    /// The block, to be prepared again if its axes begin elsewhere; `None` for a calculation.
    pub block: Option<Box<ReadBlock>>,
    /// The state behind a calculation, which is a block of its own in single block type 2.
    pub calculation: Option<Box<StateBehind>>,
    /// A search has found this block, which calculates: nothing of it was done, and this is dropped when the program stands before it.
    pub stands_before: bool,
    /// The approach after a search was its motion, and ends with its exact stop.
    pub ends_approach: bool,
}

impl Executable {
    /// Whether the block does not end before a positioning that runs: POS in it, or WAITP or RELEASE of its axis.
    pub(in crate::sinumerik) fn waits_for(&self, running: &AxisPositioning, own: &ProgramParameters) -> bool {
        // RELEASE gives no axis away that POSA still moves.
        let waited = |action: &Action| match action {
            Action::WaitForPosition(names) | Action::Release(names) => {
                names.iter().any(|name| own.axes.machine_axes.get(usize::from(name.0)) == Some(&running.axis))
            }
            _ => false,
        };
        running.waits && self.positions.contains(running) || self.actions.iter().any(waited)
    }

    pub(in crate::sinumerik) fn new(origin: Origin, modal: Modal) -> Self {
        Self {
            origin,
            modal,
            way: None,
            criterion: Criterion::Fine,
            dwell: 0,
            dwell_turns: None,
            positions: Vec::new(),
            references: Vec::new(),
            actions: Vec::new(),
            outputs: Default::default(),
            stop: ProgrammedStop::None,
            end: None,
            is_executable: false,
            by_handwheel: false,
            block: None,
            calculation: None,
            stands_before: false,
            ends_approach: false,
        }
    }

    pub(in crate::sinumerik) fn output(&self, time: OutputTime) -> Option<&Package> {
        let index = match time {
            OutputTime::Before => 0,
            OutputTime::During => 1,
            OutputTime::End => 2,
            OutputTime::Never => return None,
        };
        Some(&self.outputs[index]).filter(|package| !package.is_empty())
    }

    /// The state of preparation behind it.
    pub(in crate::sinumerik) fn behind(&self) -> Option<&StateBehind> {
        self.block.as_deref().map(|read| &read.behind).or(self.calculation.as_deref())
    }

    pub(in crate::sinumerik) fn has_outputs(&self) -> bool {
        self.outputs.iter().any(|package| !package.is_empty())
    }

    /// It begins behind an interruption: a motion on the path begins at the interruption point, with all axes. What else moves or shifts an axis
    /// begins where the axis is.
    pub(in crate::sinumerik) fn begin_behind_interruption(&self, left: &mut Vec<(AxisNumber, Position)>) {
        let shifts = |action: &Action| matches!(action, Action::Preset(_) | Action::Get { .. } | Action::Release(_));
        if self.way.is_some() || self.actions.iter().any(shifts) {
            left.clear();
        }
        let moves = |axis: AxisNumber| {
            self.references.contains(&axis) || self.positions.iter().any(|positioning| positioning.axis == axis)
        };
        left.retain(|(axis, _)| !moves(*axis));
    }

    /// Whether it is one action and nothing else.
    pub(in crate::sinumerik) fn is_only_action(&self) -> bool {
        self.way.is_none()
            && self.actions.len() == 1
            && !self.has_outputs()
            && self.dwell == 0
            && self.positions.is_empty()
            && self.references.is_empty()
            && self.stop == ProgrammedStop::None
            && self.end.is_none()
    }

    /// Whether it only moves the path, so that the path can pass into it without a stop.
    pub(in crate::sinumerik) fn is_plain(&self) -> bool {
        self.way.is_some()
            && !self.by_handwheel
            && self.outputs[0].is_empty()
            && self.dwell == 0
            && self.dwell_turns.is_none()
            && self.positions.is_empty()
            && self.references.is_empty()
            && self.actions.is_empty()
    }
}

/// G601, G602, G603.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Criterion {
    /// Exact stop fine.
    Fine,
    /// Exact stop coarse.
    Coarse,
    /// The end of interpolation.
    Interpolation,
}

impl Criterion {
    /// The criterion that holds in a block.
    pub(in crate::sinumerik) fn of(modal: Modal) -> Self {
        if modal.is(g::G602) {
            Self::Coarse
        } else if modal.is(g::G603) {
            Self::Interpolation
        } else {
            Self::Fine
        }
    }
}

/// M0 and M1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum ProgrammedStop {
    None,
    /// M0.
    Always,
    /// M1, if DB21.DBX0.5 = 1.
    Optional,
    /// MD22254.
    Associated,
    /// MD22256, if DB21.DBX30.5 = 1.
    AssociatedOptional,
}
