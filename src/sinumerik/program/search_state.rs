//! The state of a block search.

use serde::{Deserialize, Serialize};

use crate::control::SearchKind;
use crate::motion::path::PerPathAxis;
use crate::nc_program::{BlockTarget, Origin};
use crate::sinumerik::program::auxiliary::{Entry, Output};

/// How far a search is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum SearchProgress {
    /// 33.4: it looks for the block.
    Searching,
    /// The block was found: the axes of SERUPRO get their real positions back; in types 2 and 4, NC start outputs action blocks.
    Found,
    /// 32.3: action blocks are output.
    Acting,
    /// 32.6: the last one is output.
    LastAction,
    /// All are output; MD11450 bit 0: 1.6 is waited for.
    WaitsForPlc,
    /// 10208: NC start begins the approach.
    Ready,
}

/// A block search.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Search {
    pub kind: SearchKind,
    /// The block, as the operator names it.
    pub target: String,
    pub progress: SearchProgress,
    /// The auxiliary functions that are output in action blocks.
    pub collected: Vec<Entry>,
    /// Where the approach leads to.
    pub approach: Option<PerPathAxis>,
    /// The search has begun in an earlier cycle, so that 33.4 can be seen.
    pub begun: bool,
}

impl Search {
    /// Whether this block is the target.
    pub(super) fn is_target(&self, origin: &Origin) -> bool {
        origin.level == 0 && BlockTarget::new(&self.target).is_some_and(|target| target.is(&origin.text))
    }

    /// $P_SEARCHL while it searches.
    pub(super) fn level(&self) -> u8 {
        match self.kind {
            _ if !self.is_searching() => 0,
            SearchKind::WithoutCalculation => 1,
            SearchKind::Contour => 2,
            SearchKind::EndPoint => 4,
            SearchKind::ProgramTest => 5,
        }
    }

    /// 33.4.
    pub(in crate::sinumerik) fn is_searching(&self) -> bool {
        self.progress == SearchProgress::Searching
    }

    /// 32.3.
    pub(in crate::sinumerik) fn acts(&self, output: &Output) -> bool {
        self.progress == SearchProgress::Acting || self.progress == SearchProgress::LastAction && output.is_busy()
    }

    /// 32.6: until NC start.
    pub(in crate::sinumerik) fn is_last_action(&self) -> bool {
        let has_actions = matches!(self.kind, SearchKind::Contour | SearchKind::EndPoint);
        has_actions
            && matches!(self.progress, SearchProgress::LastAction | SearchProgress::WaitsForPlc | SearchProgress::Ready)
    }

    /// 318.1.
    pub(in crate::sinumerik) fn is_by_program_test(&self) -> bool {
        self.is_searching() && self.kind == SearchKind::ProgramTest
    }

    /// It executes nothing: it calculates up to the block.
    pub(super) fn calculates(&self) -> bool {
        self.is_searching() && self.kind != SearchKind::ProgramTest
    }
}
