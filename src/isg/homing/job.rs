//! The homing of a G74 block: which axes wait, and which home now.

use serde::{Deserialize, Serialize};

use crate::units::AxisNumber;
use crate::variables::EventId;

/// The axes that home one after the other, or at once: a combination, or one axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Chain {
    pub(super) members: Vec<AxisNumber>,
    /// How many members have ended.
    pub(super) ended: usize,
    pub(super) at_once: bool,
}

/// The homing of a G74 block.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::isg) struct Job {
    /// The axes that wait, by their order.
    pub(super) waiting: Vec<(i64, AxisNumber)>,
    pub(super) running: Vec<Chain>,
    pub(super) cause: EventId,
}

impl Job {
    pub(in crate::isg) fn new(mut axes: Vec<(i64, AxisNumber)>, cause: EventId) -> Self {
        axes.sort_by_key(|(order, _)| *order);
        Self { waiting: axes, running: Vec::new(), cause }
    }

    /// Whether the turn of an axis comes later.
    pub(in crate::isg) fn waits_for(&self, axis: AxisNumber) -> bool {
        self.waiting.iter().any(|(_, waits)| *waits == axis)
            || self.running.iter().any(|chain| chain.members.iter().skip(chain.ended).any(|member| *member == axis))
    }

    /// The axes that home now.
    pub(in crate::isg) fn now(&self) -> impl Iterator<Item = AxisNumber> + '_ {
        let of_chain = |chain: &Chain| {
            let count = if chain.at_once { chain.members.len() } else { 1 };
            chain.members.iter().skip(chain.ended).take(count).copied().collect::<Vec<_>>()
        };
        self.running.iter().flat_map(of_chain)
    }
}
