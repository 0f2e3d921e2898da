//! Targets of axis words in machine coordinates: offsets, incremental dimensions, limits. The preparation of a block calls it.

use crate::motion::path::{PerPathAxis, Way};
use crate::nc_program::{AxisWord, Block, Dimension, g};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::axis::limits::selected_limit;
use crate::sinumerik::program::environment::Channel;
use crate::sinumerik::program::geometry;
use crate::sinumerik::program::preparation::{Preparing, block_parameter};
use crate::sinumerik::program::state::{BlockAlarm, Run, block_name};
use crate::units::{AxisNumber, Position};
use crate::variables::Parameter;

impl Preparing<'_> {
    /// The settable and the programmable offset of an axis.
    pub(super) fn offset(&self, block: &Block, axis: AxisNumber, channel: &Channel<'_>) -> f64 {
        if geometry::suppresses_offsets(block) {
            // SUPA also suppresses the DRF offset.
            let drf =
                if geometry::suppresses_overlays(block) { channel.axes[axis].overlay.target } else { Position::ZERO };
            return -(drf.increments() as f64);
        }
        self.lasting_offset(block, axis, channel)
    }

    /// The settable and the programmable offset of an axis, without G53, G153 and SUPA.
    fn lasting_offset(&self, block: &Block, axis: AxisNumber, channel: &Channel<'_>) -> f64 {
        let settable = channel.program.active_offset(block.modal, axis).increments() as f64;
        settable + geometry::programmable_offset(block, &self.own.axes, axis)
    }

    /// Where an axis word leads. With SD42440 an incremental one also traverses what the offsets of its axis have changed by since the axis was
    /// last programmed, once; G53, G153 and SUPA are no such change.
    pub(super) fn target(
        &self,
        block: &Block,
        word: &AxisWord,
        (axis, place): (AxisNumber, usize),
        from: f64,
        run: &mut Run,
        channel: &Channel<'_>,
    ) -> f64 {
        let lasting = self.lasting_offset(block, axis, channel);
        let before = std::mem::replace(&mut run.offsets[place], lasting);
        let traverses = self.own.increments_traverse_offsets
            && word.dimension == Dimension::Incremental
            && !geometry::suppresses_offsets(block);
        let from = if traverses { from + lasting - before } else { from };
        let parameters = &self.parameters.axes[axis];
        let value = geometry::length(word.value, block, parameters.rotary);
        geometry::target(value, word.dimension, from, self.offset(block, axis, channel), parameters.modulo)
    }

    /// 10720, 10722, 10730: the end, and the farthest points of an arc.
    pub(super) fn check_limits(
        &self,
        block: &Block,
        way: &Way,
        start: &PerPathAxis,
        end: &PerPathAxis,
    ) -> Result<(), BlockAlarm> {
        for (place, &axis) in self.own.axes.path.iter().enumerate() {
            let (lowest, highest) = way.bounds(place);
            let moves = highest - lowest >= 0.5 || (end[place] - start[place]).abs() >= 0.5;
            if !moves || !self.axes[axis].knows_position() {
                continue;
            }
            let parameters = &self.parameters.axes[axis];
            for (direction, extreme, at_end) in [(-1, lowest, end[place]), (1, highest, end[place])] {
                let beyond = |limit: Position, position: f64| {
                    (position - limit.increments() as f64) * f64::from(direction) > 0.5
                };
                let side = usize::from(direction > 0);
                let said = [Parameter::Axis(axis), block_parameter(block), Parameter::Direction(direction)];
                let limit = selected_limit(&self.to_nck.axes[axis], parameters, direction);
                let software = limit.filter(|limit| beyond(*limit, extreme));
                if let Some(limit) = software {
                    let number =
                        if beyond(limit, at_end) { alarms::BEHIND_SOFTWARE_LIMIT } else { alarms::PATH_BEHIND_LIMIT };
                    return Err(BlockAlarm { number, parameters: said, block: block_name(&block.origin.name) });
                }
                let is_on = block.modal.is(g::WALIMON) && self.axes[axis].is_referenced();
                let area = parameters.working_area[side].filter(|_| is_on);
                if area.is_some_and(|limit| beyond(limit, extreme)) {
                    let number = alarms::OUTSIDE_WORKING_AREA;
                    return Err(BlockAlarm { number, parameters: said, block: block_name(&block.origin.name) });
                }
            }
        }
        Ok(())
    }
}
