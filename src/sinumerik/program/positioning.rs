//! POS and POSA: an axis on its own way to a target.

use serde::{Deserialize, Serialize};

use crate::sinumerik::alarms::programs::STILL_POSITIONED;
use crate::sinumerik::program::state::{BlockAlarm, Run, block_name};
use crate::units::{AxisNumber, Position};
use crate::variables::{Parameter, short_text};

/// The movement of a positioning axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Positioning {
    pub axis: AxisNumber,
    /// In machine coordinates.
    pub target: Position,
    /// In increments per second.
    pub velocity: f64,
    /// POS: the block ends when the axis is there.
    pub waits: bool,
}

impl Run {
    /// 10610: the next block positions an axis again that a POSA still moves.
    pub(in crate::sinumerik) fn still_positioned(&self) -> Option<BlockAlarm> {
        let block = self.queue.front()?;
        let moves = |axis| self.positionings.iter().any(|positioning| positioning.axis == axis);
        let again = block.positions.iter().find(|positioning| moves(positioning.axis))?;
        let name = &block.origin.name;
        let parameters = [Parameter::Axis(again.axis), Parameter::Text(short_text(name)), Parameter::None];
        Some(BlockAlarm { number: STILL_POSITIONED, parameters, block: block_name(name) })
    }
}
