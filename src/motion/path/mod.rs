//! The path of an NC program: lines and arcs of several axes, with one velocity along the way.
//!
//! A path knows no machine: its axes are numbered from 0, and the control says which machine axis each of them is. It interpolates in whole
//! cycles. In each cycle it takes the largest velocity with which
//!
//! * no axis exceeds its velocity or its acceleration,
//! * the path can still slow down for every block that is known: for a smaller feed, for a corner, and for standstill at the end of the last
//!   one (look-ahead),
//! * at a corner no axis changes its velocity by more than its acceleration permits in one cycle, times the overload factor.
//!
//! A block with an exact stop ends at rest, and the next one begins when the control [continues](Path::go_on). So corners are rounded by
//! no more than what one cycle passes over, and a block that comes late only makes the path wait at its end.
//!
//! Positions are computed from the start of a block, never added up, so that nothing is lost and every block ends exactly on its end.

pub(super) mod angle;
mod axes;
mod block;
mod soft;
#[cfg(test)]
mod tests;
mod way;

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

pub use axes::{PATH_AXES, PathLimits, PerPathAxis};
use block::HALF_AN_INCREMENT;
pub use block::{Feed, PathBlock};
pub use soft::LONGEST_WINDOW;
use soft::Soft;
pub use way::{Circle, RadiiDiffer, Turn, Way};

/// The number of blocks that a path takes. Looking further ahead changes nothing unless they are shorter than one braking distance together.
pub const BLOCKS: usize = 64;

/// Why a path does not take a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// It has [`BLOCKS`] blocks already.
    Full,
    /// The way of the block is shorter than half an increment: there is nothing to interpolate.
    NoWay,
}

/// The overrides of a cycle, as factors; 0 holds the path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overrides {
    /// Of a programmed feed.
    pub feed: f64,
    /// Of rapid traverse.
    pub rapid: f64,
}

/// A block with what is computed once.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Planned {
    block: PathBlock,
    /// Largest velocity and acceleration along its way.
    velocity: f64,
    acceleration: f64,
    /// Largest velocity at its start, after the corner to the block before.
    corner: f64,
    /// The path stops at its end by [`Path::stop_at_block_end`].
    stopped: bool,
}

impl Planned {
    /// Whether the path stops at its end until the control continues.
    const fn stops(&self) -> bool {
        self.block.exact_stop || self.stopped
    }
}

/// The result of a cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// The position of each axis.
    pub position: PerPathAxis,
    /// How many blocks have ended in this cycle and are gone.
    pub ended: usize,
}

/// A path in progress: plain data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Path {
    limits: PathLimits,
    blocks: VecDeque<Planned>,
    /// Where the axes are.
    position: PerPathAxis,
    /// The distance from the start of the first block.
    distance: f64,
    /// The velocity along the way.
    velocity: f64,
    /// The first block has ended with an exact stop, and the control has not continued.
    stands: bool,
    /// SOFT: what follows the plan.
    soft: Option<Box<Soft>>,
}

impl Path {
    /// A path at rest at this position.
    #[must_use]
    pub fn new(position: PerPathAxis, limits: PathLimits) -> Self {
        Self { limits, blocks: VecDeque::new(), position, distance: 0.0, velocity: 0.0, stands: false, soft: None }
    }

    /// Appends a block that begins where the last one ends. `cycle` is in seconds.
    ///
    /// # Errors
    /// There is no room, or the block moves nothing.
    pub fn append(&mut self, block: PathBlock, cycle: f64) -> Result<(), Refused> {
        if !self.has_room() {
            return Err(Refused::Full);
        }
        if block.way.length() < HALF_AN_INCREMENT {
            return Err(Refused::NoWay);
        }
        let (velocity, acceleration) = block.way.limits(&self.limits);
        let corner = match self.blocks.back() {
            Some(before) if !before.stops() => self.corner(&before.block.way, &block.way, cycle),
            Some(_) | None => 0.0,
        };
        self.blocks.push_back(Planned { block, velocity, acceleration, corner, stopped: false });
        if let Some(soft) = &mut self.soft {
            soft.append(block);
        }
        Ok(())
    }

    /// Changes the limits; they act on blocks that are appended later.
    pub fn set_limits(&mut self, limits: PathLimits) {
        self.limits = limits;
    }

    /// Limits the jerk of an empty path: accelerations become ramps over this number of cycles. 1 is no limit.
    pub fn set_jerk_window(&mut self, window: usize) {
        if !self.is_empty() || self.soft.as_ref().map_or(1, |soft| soft.window()) == window {
            return;
        }
        self.soft = (window > 1).then(|| Box::new(Soft::new(window)));
    }

    /// The largest velocity with which the path passes from one way to the next.
    fn corner(&self, before: &Way, after: &Way, cycle: f64) -> f64 {
        let (from, to) = (before.direction(true), after.direction(false));
        let mut velocity = f64::INFINITY;
        for axis in 0..PATH_AXES {
            let change = (to[axis] - from[axis]).abs();
            if change > 1e-9 {
                let permitted = self.limits.acceleration[axis] * cycle * self.limits.overload[axis];
                velocity = velocity.min(permitted / change);
            }
        }
        velocity
    }

    /// The block that moves or stands at its end, and the distance that is left of it, in increments.
    #[must_use]
    pub fn current(&self) -> Option<(&PathBlock, f64)> {
        if let Some(soft) = &self.soft {
            return soft.current().map(|(block, distance)| (block, block.way.length() - distance));
        }
        let planned = self.blocks.front()?;
        Some((&planned.block, planned.block.way.length() - self.distance))
    }

    /// The velocity along the way, in increments per second.
    #[must_use]
    pub fn velocity(&self) -> f64 {
        match &self.soft {
            // The axes begin to move a little later than the plan.
            Some(soft) if self.velocity > 0.0 || !soft.is_settled() => soft.velocity().max(f64::MIN_POSITIVE),
            Some(_) | None => self.velocity,
        }
    }

    /// Whether a block stands at its exact stop until [`Path::go_on`].
    #[must_use]
    pub fn stands(&self) -> bool {
        self.stands && self.soft.as_ref().is_none_or(|soft| soft.stands())
    }

    /// Whether there is nothing left to move.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty() && self.soft.as_ref().is_none_or(|soft| soft.is_empty())
    }

    /// Drops the blocks behind the first one.
    ///
    /// The first block then ends at rest, so call this only at rest.
    pub fn keep_first(&mut self) {
        self.blocks.truncate(1);
        if let Some(soft) = &mut self.soft {
            soft.keep_first();
        }
    }

    /// Gives each block another feed, by its number and its feed.
    pub fn set_feeds(&mut self, feed: impl Fn(u64, Feed) -> Feed) {
        for planned in &mut self.blocks {
            planned.block.feed = feed(planned.block.number, planned.block.feed);
        }
    }

    /// Whether another block fits.
    #[must_use]
    pub fn has_room(&self) -> bool {
        self.blocks.len() < BLOCKS
    }

    /// Stops the path at the end of the present block, or of the first one at whose end it can still stop.
    pub fn stop_at_block_end(&mut self, cycle: f64) {
        if self.blocks.iter().any(|planned| planned.stopped) {
            return;
        }
        let (mut ahead, mut acceleration, velocity) = (-self.distance, f64::INFINITY, self.velocity);
        for planned in &mut self.blocks {
            ahead += planned.block.way.length();
            acceleration = acceleration.min(planned.acceleration);
            if planned.block.exact_stop || stopping(ahead, acceleration, cycle) + acceleration * cycle >= velocity {
                planned.stopped = true;
                return;
            }
        }
    }

    /// Takes [`Path::stop_at_block_end`] back. A path that stands already goes on with [`Path::go_on`].
    pub fn pass_block_end(&mut self) {
        for planned in &mut self.blocks {
            planned.stopped = false;
        }
    }

    /// Puts a path without blocks at a position.
    pub fn place(&mut self, position: PerPathAxis) {
        if self.is_empty() {
            self.position = position;
        }
    }

    /// Where the axes are.
    #[must_use]
    pub const fn position(&self) -> PerPathAxis {
        self.position
    }

    /// The axes are in position: the block that stands at its exact stop is over.
    pub fn go_on(&mut self) {
        if self.stands() {
            self.stands = false;
            self.blocks.pop_front();
            self.distance = 0.0;
            if let Some(soft) = &mut self.soft {
                soft.go_on();
            }
        }
    }

    /// The direction of each axis in the present block: its movement per increment of the way, at its present place.
    #[must_use]
    pub fn direction(&self) -> PerPathAxis {
        if let Some(soft) = &self.soft {
            let current = soft.current();
            return current.map_or_else(PerPathAxis::default, |(block, distance)| block.way.direction_at(distance));
        }
        self.blocks.front().map_or_else(PerPathAxis::default, |planned| planned.block.way.direction_at(self.distance))
    }

    /// Where the path passes if it begins to brake in the next cycle: a few places up to standstill, in order. `cycle` is in seconds.
    #[must_use]
    pub fn while_braking(&self, cycle: f64) -> [PerPathAxis; 8] {
        let accelerations = self.blocks.iter().map(|planned| planned.acceleration);
        let slowest = accelerations.fold(f64::INFINITY, f64::min);
        let velocity = self.velocity + self.blocks.front().map_or(0.0, |first| first.acceleration) * cycle;
        let way = if slowest.is_finite() { velocity * (velocity / (2.0 * slowest) + 1.5 * cycle) } else { 0.0 };
        std::array::from_fn(|index| self.place_ahead(way * (index + 1) as f64 / 8.0))
    }

    /// The place on the known blocks after a distance, no farther than the next standstill.
    fn place_ahead(&self, way: f64) -> PerPathAxis {
        let (mut ahead, mut place) = (self.distance + way, self.position);
        for planned in &self.blocks {
            place = planned.block.way.at(ahead);
            ahead -= planned.block.way.length();
            if ahead <= 0.0 || planned.stops() {
                break;
            }
        }
        place
    }

    /// Drops all blocks; the position stays. To brake first, call [`Path::step`] with overrides of 0 until the velocity is 0.
    pub fn clear(&mut self) {
        self.blocks.clear();
        (self.distance, self.velocity, self.stands) = (0.0, 0.0, false);
        if let Some(soft) = &mut self.soft {
            soft.clear();
        }
    }

    /// One cycle, in seconds.
    pub fn step(&mut self, overrides: Overrides, cycle: f64) -> Moved {
        let planned = self.plan(overrides, cycle);
        let Some(soft) = &mut self.soft else { return planned };
        let (position, ended) = soft.step(self.distance, cycle);
        self.position = position.unwrap_or(self.position);
        Moved { position: self.position, ended }
    }

    /// One cycle of the plan; without a jerk limit the axes follow it at once.
    fn plan(&mut self, overrides: Overrides, cycle: f64) -> Moved {
        let mut ended = 0;
        let Some(first) = self.blocks.front() else {
            self.velocity = 0.0;
            return Moved { position: self.position, ended };
        };
        if self.stands {
            return Moved { position: self.position, ended };
        }
        let change = first.acceleration * cycle;
        let wanted = self.permitted(overrides, cycle);
        // A corner or a limit was not foreseen only if an override fell; then the path brakes as it can.
        self.velocity = wanted.clamp(self.velocity - change, self.velocity + change).max(0.0);
        self.distance += self.velocity * cycle;
        while let Some(planned) = self.blocks.front().copied() {
            let length = planned.block.way.length();
            let over = self.distance - length;
            if over < -HALF_AN_INCREMENT {
                if self.soft.is_none() {
                    self.position = planned.block.way.at(self.distance);
                }
                break;
            }
            if self.soft.is_none() {
                self.position = planned.block.way.end();
            }
            let last = self.blocks.len() == 1;
            if planned.stops() || last {
                self.velocity = 0.0;
            }
            if planned.stops() {
                (self.stands, self.distance) = (true, length);
                break;
            }
            ended += 1;
            self.blocks.pop_front();
            if let Some(soft) = &mut self.soft {
                soft.pass_planned(length);
            }
            self.distance = if last { 0.0 } else { over.max(0.0) };
        }
        Moved { position: self.position, ended }
    }

    /// The largest velocity of this cycle with which everything ahead can be met.
    fn permitted(&self, overrides: Overrides, cycle: f64) -> f64 {
        let mut permitted = f64::INFINITY;
        let (mut ahead, mut acceleration) = (-self.distance, f64::INFINITY);
        let slowest = self.blocks.iter().map(|planned| planned.acceleration).fold(f64::INFINITY, f64::min);
        for (index, planned) in self.blocks.iter().enumerate() {
            let wanted = match planned.block.feed {
                Feed::Programmed(feed) => (feed * overrides.feed).min(planned.velocity),
                Feed::Rapid => planned.velocity * overrides.rapid.min(1.0),
            };
            let at_start = if index == 0 { wanted } else { wanted.min(planned.corner) };
            permitted = permitted.min(if index == 0 { wanted } else { slowing(ahead, at_start, acceleration, cycle) });
            acceleration = acceleration.min(planned.acceleration);
            ahead += planned.block.way.length();
            let stops = planned.stops() || index + 1 == self.blocks.len();
            if stops {
                return permitted.min(stopping(ahead, acceleration, cycle));
            }
            // What comes later than the braking distance changes nothing in this cycle.
            let fastest = permitted.min(self.velocity + acceleration * cycle);
            if ahead > fastest * fastest / (2.0 * slowest) + fastest * cycle * 2.0 {
                break;
            }
        }
        permitted
    }
}

/// The largest velocity of a cycle from which whole cycles of braking end at rest after this distance: the sum v·T + (v − aT)·T + … over N
/// cycles equals the distance, for the smallest possible N.
fn stopping(distance: f64, acceleration: f64, cycle: f64) -> f64 {
    let step = acceleration * cycle;
    let in_steps = distance.max(0.0) / (step * cycle);
    let cycles = ((0.25 + 2.0 * in_steps).sqrt() - 0.5).ceil().max(1.0);
    step * (in_steps / cycles + 0.5 * (cycles - 1.0))
}

/// The largest velocity of a cycle from which whole cycles of braking reach another velocity after this distance:
/// (v² − w²) / 2a + (v + w)·T/2 equals the distance.
fn slowing(distance: f64, to: f64, acceleration: f64, cycle: f64) -> f64 {
    let half = 0.5 * acceleration * cycle;
    let root = (half - to) * (half - to) + 2.0 * acceleration * distance.max(0.0);
    (root.sqrt() - half).max(to)
}
