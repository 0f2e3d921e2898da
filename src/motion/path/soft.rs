//! Jerk limitation of a path (SOFT): the distance along the way is the mean of the planned distances of the last cycles.
//!
//! The plan is that of a path without jerk limitation. What the axes follow is its moving average along the same way, so that no contour changes
//! and no acceleration becomes larger. A step of acceleration becomes a ramp over the window, and a movement takes the window less one
//! cycle longer. The blocks that the plan has passed stay here until the average has passed them, too.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

use super::axes::PerPathAxis;
use super::block::{HALF_AN_INCREMENT, PathBlock};

/// The longest window, in cycles.
pub const LONGEST_WINDOW: usize = 1_000;

/// What follows the plan of a path. All distances count from the start of the first way that it has not passed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Soft {
    /// The planned distances of the last cycles, and their sum.
    ring: VecDeque<f64>,
    sum: f64,
    /// How many of the newest distances are equal.
    equal: usize,
    window: usize,
    /// The ways that it has not passed.
    ways: VecDeque<PathBlock>,
    /// Where the first block of the plan begins.
    planned_start: f64,
    /// Where the axes are.
    distance: f64,
    velocity: f64,
}

impl Soft {
    /// A window of whole cycles, at rest.
    pub(super) fn new(window: usize) -> Self {
        let window = window.clamp(1, LONGEST_WINDOW);
        Self { ring: VecDeque::from(vec![0.0; window]), equal: window, window, ..Self::default() }
    }

    pub(super) const fn window(&self) -> usize {
        self.window
    }

    pub(super) fn append(&mut self, block: PathBlock) {
        self.ways.push_back(block);
    }

    pub(super) fn keep_first(&mut self) {
        self.ways.truncate(1);
    }

    /// Whether the average has reached the plan.
    pub(super) const fn is_settled(&self) -> bool {
        self.equal >= self.window
    }

    pub(super) fn is_empty(&self) -> bool {
        self.ways.is_empty()
    }

    pub(super) const fn velocity(&self) -> f64 {
        self.velocity
    }

    /// The block in which the axes are, and how far.
    pub(super) fn current(&self) -> Option<(&PathBlock, f64)> {
        self.ways.front().map(|block| (block, self.distance))
    }

    /// The plan has passed a block of this length.
    pub(super) fn pass_planned(&mut self, length: f64) {
        self.planned_start += length;
    }

    /// One cycle: the plan is at this distance in its first block. Returns the position, unless nothing is left, and how many blocks have ended.
    pub(super) fn step(&mut self, planned: f64, cycle: f64) -> (Option<PerPathAxis>, usize) {
        let newest = self.planned_start + planned;
        let oldest = self.ring.pop_front().unwrap_or(newest);
        let is_equal = self.ring.back().is_none_or(|last| (newest - last).abs() < 1e-3);
        self.equal = if is_equal { (self.equal + 1).min(self.window) } else { 1 };
        self.ring.push_back(newest);
        self.sum += newest - oldest;
        let before = self.distance;
        if self.is_settled() {
            // Sums of many cycles have rounding errors.
            self.sum = newest * self.window as f64;
            (self.distance, self.velocity) = (newest, 0.0);
        } else {
            self.distance = (self.sum / self.window as f64).clamp(self.distance, newest.max(self.distance));
            self.velocity = (self.distance - before) / cycle;
        }
        let (mut position, mut ended) = (None, 0);
        while let Some(block) = self.ways.front() {
            let length = block.way.length();
            if self.distance < length - HALF_AN_INCREMENT {
                position = Some(block.way.at(self.distance));
                break;
            }
            position = Some(block.way.end());
            if self.planned_start < length - HALF_AN_INCREMENT {
                // The plan is still in this block, or stands at its end.
                break;
            }
            self.pass();
            ended += 1;
        }
        (position, ended)
    }

    /// Whether the axes are at the end of their block, at rest.
    pub(super) fn stands(&self) -> bool {
        let is_at_end = |block: &PathBlock| self.distance >= block.way.length() - HALF_AN_INCREMENT;
        self.is_settled() && self.ways.front().is_none_or(is_at_end)
    }

    /// The block at whose end the plan and the axes stand is over.
    pub(super) fn go_on(&mut self) {
        if let Some(block) = self.ways.front() {
            self.planned_start += block.way.length();
            self.pass();
        }
    }

    /// Distances count from the start of the next way.
    fn pass(&mut self) {
        let Some(block) = self.ways.pop_front() else { return };
        let length = block.way.length();
        self.planned_start -= length;
        self.distance -= length;
        self.sum -= length * self.ring.len() as f64;
        for one in &mut self.ring {
            *one -= length;
        }
    }

    pub(super) fn clear(&mut self) {
        *self = Self::new(self.window);
    }
}
