//! The geometry of one block: a straight line of several axes, or an arc of two axes with which the others go along.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt;

use serde::{Deserialize, Serialize};

use super::angle::{angle_of, sin_cos};
use super::axes::{PATH_AXES, PathLimits, PerPathAxis};

/// The direction of an arc, seen against the third axis of its plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Turn {
    /// Clockwise.
    Clockwise,
    /// Counterclockwise.
    Counterclockwise,
}

/// The circle of an arc.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// The two axes of its plane: the first axis turns counterclockwise to the second one.
    pub plane: [usize; 2],
    /// Its centre, in increments of both axes.
    pub centre: [f64; 2],
    /// The direction.
    pub turn: Turn,
    /// Full turns in addition to the arc.
    pub turns: u32,
}

/// An arc whose end is not on the circle through its start.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RadiiDiffer {
    /// The radius at the start, in increments.
    pub start: f64,
    /// The radius at the end.
    pub end: f64,
}

impl fmt::Display for RadiiDiffer {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { start, end } = self;
        write!(f, "the radius is {start} increments at the start of the arc and {end} at its end")
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Shape {
    Line,
    Arc { circle: Circle, radius: [f64; 2], begin: f64, sweep: f64 },
}

/// The way of one block from its start to its end, by the distance from its start.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Way {
    start: PerPathAxis,
    end: PerPathAxis,
    length: f64,
    /// The axes to which the feed refers.
    counted: [bool; PATH_AXES],
    shape: Shape,
}

impl Way {
    /// A straight line, in increments. Its length is that of the axes in `counted`, which the feed refers to; if none of them moves, that of
    /// all axes.
    #[must_use]
    pub fn line(start: PerPathAxis, end: PerPathAxis, counted: [bool; PATH_AXES]) -> Self {
        let length = |counts: &dyn Fn(usize) -> bool| {
            (0..PATH_AXES).filter(|&axis| counts(axis)).map(|axis| square(end[axis] - start[axis])).sum::<f64>().sqrt()
        };
        let of_counted = length(&|axis| counted[axis]);
        let length = if of_counted > 0.0 { of_counted } else { length(&|_| true) };
        Self { start, end, length, counted, shape: Shape::Line }
    }

    /// An arc in a plane. The other axes move in proportion to its angle; those of them that are in `counted` lengthen the way (a helix).
    /// An arc that ends where it starts is a full circle.
    ///
    /// # Errors
    /// The radii at the start and at the end differ by more than `tolerance` increments.
    pub fn arc(
        start: PerPathAxis,
        end: PerPathAxis,
        circle: Circle,
        tolerance: f64,
        counted: [bool; PATH_AXES],
    ) -> Result<Self, RadiiDiffer> {
        let [first, second] = circle.plane;
        let from_centre = |point: &PerPathAxis| [point[first] - circle.centre[0], point[second] - circle.centre[1]];
        let ([x, y], [end_x, end_y]) = (from_centre(&start), from_centre(&end));
        let radius = [(square(x) + square(y)).sqrt(), (square(end_x) + square(end_y)).sqrt()];
        if (radius[0] - radius[1]).abs() > tolerance {
            return Err(RadiiDiffer { start: radius[0], end: radius[1] });
        }
        let begin = angle_of(x, y);
        let mut sweep = angle_of(end_x, end_y) - begin;
        let closed = (x - end_x).abs() < 0.5 && (y - end_y).abs() < 0.5;
        let more = TAU * f64::from(circle.turns);
        match circle.turn {
            Turn::Counterclockwise if closed => sweep = TAU + more,
            Turn::Clockwise if closed => sweep = -TAU - more,
            Turn::Counterclockwise => sweep += more + if sweep < 0.0 { TAU } else { 0.0 },
            Turn::Clockwise => sweep -= more + if sweep > 0.0 { TAU } else { 0.0 },
        }
        let in_plane = sweep.abs() * 0.5 * (radius[0] + radius[1]);
        let others = (0..PATH_AXES).filter(|axis| !circle.plane.contains(axis) && counted[*axis]);
        let along: f64 = others.map(|axis| square(end[axis] - start[axis])).sum();
        let length = (square(in_plane) + along).sqrt();
        Ok(Self { start, end, length, counted, shape: Shape::Arc { circle, radius, begin, sweep } })
    }

    /// Its length in increments, to which the feed refers.
    #[must_use]
    pub const fn length(&self) -> f64 {
        self.length
    }

    /// The axes to which the feed refers.
    #[must_use]
    pub const fn counted(&self) -> [bool; PATH_AXES] {
        self.counted
    }

    /// Its start.
    #[must_use]
    pub const fn start(&self) -> PerPathAxis {
        self.start
    }

    /// Lets it begin elsewhere: a line leads from there to the same end, an arc keeps its circle and its start.
    pub fn begin_at(&mut self, start: PerPathAxis) {
        if self.shape == Shape::Line {
            *self = Self::line(start, self.end, self.counted);
        }
    }

    /// The smallest and the largest position of an axis on the way.
    #[must_use]
    pub fn bounds(&self, axis: usize) -> (f64, f64) {
        let (start, end) = (self.start[axis], self.end[axis]);
        let (mut lowest, mut highest) = (start.min(end), start.max(end));
        if let Shape::Arc { circle, radius, begin, sweep } = self.shape
            && let Some(index) = circle.plane.iter().position(|member| *member == axis)
        {
            // An arc is farthest out where its angle is a multiple of a quarter turn.
            let (first, last) = (begin.min(begin + sweep), begin.max(begin + sweep));
            let mut quarter = (first / FRAC_PI_2).ceil();
            while quarter * FRAC_PI_2 <= last && quarter - (first / FRAC_PI_2).ceil() < 4.0 {
                let (sine, cosine) = sin_cos(quarter * FRAC_PI_2);
                let out = circle.centre[index] + radius[0] * if index == 0 { cosine } else { sine };
                (lowest, highest) = (lowest.min(out), highest.max(out));
                quarter += 1.0;
            }
        }
        (lowest, highest)
    }

    /// Its end.
    #[must_use]
    pub const fn end(&self) -> PerPathAxis {
        self.end
    }

    /// The position at a distance from its start.
    #[must_use]
    pub fn at(&self, distance: f64) -> PerPathAxis {
        if distance >= self.length {
            return self.end;
        }
        let part = distance / self.length;
        let mut position = PerPathAxis::default();
        for (axis, value) in position.iter_mut().enumerate() {
            *value = self.start[axis] + (self.end[axis] - self.start[axis]) * part;
        }
        if let Shape::Arc { circle, radius, begin, sweep } = self.shape {
            let (sine, cosine) = sin_cos(begin + sweep * part);
            // A small difference of the radii, which a control permits, is spread over the arc.
            let radius = radius[0] + (radius[1] - radius[0]) * part;
            position[circle.plane[0]] = circle.centre[0] + radius * cosine;
            position[circle.plane[1]] = circle.centre[1] + radius * sine;
        }
        position
    }

    /// The movement of each axis per increment of the way, at its start or at its end.
    #[must_use]
    pub(super) fn direction(&self, at_end: bool) -> PerPathAxis {
        self.direction_at(if at_end { self.length } else { 0.0 })
    }

    /// The movement of each axis per increment of the way, at a distance from its start.
    #[must_use]
    pub fn direction_at(&self, distance: f64) -> PerPathAxis {
        let mut direction = PerPathAxis::default();
        if self.length <= 0.0 {
            return direction;
        }
        for (axis, value) in direction.iter_mut().enumerate() {
            *value = (self.end[axis] - self.start[axis]) / self.length;
        }
        if let Shape::Arc { circle, radius, begin, sweep } = self.shape {
            let part = (distance / self.length).clamp(0.0, 1.0);
            let (sine, cosine) = sin_cos(begin + sweep * part);
            let tangent = sweep * (radius[0] + (radius[1] - radius[0]) * part) / self.length;
            direction[circle.plane[0]] = -sine * tangent;
            direction[circle.plane[1]] = cosine * tangent;
        }
        direction
    }

    /// The largest velocity and acceleration along the way with which no axis exceeds its own.
    ///
    /// On an arc, acceleration along the way and towards the centre share what the weaker axis of the plane can do.
    #[must_use]
    pub(super) fn limits(&self, axes: &PathLimits) -> (f64, f64) {
        let direction = self.direction(false);
        let (mut velocity, mut acceleration) = (f64::INFINITY, f64::INFINITY);
        let mut limit = |share: f64, axis: usize, part: f64| {
            if share > 0.0 {
                velocity = velocity.min(axes.velocity[axis] / share);
                acceleration = acceleration.min(axes.acceleration[axis] * part / share);
            }
        };
        match self.shape {
            Shape::Line => {
                for (axis, share) in direction.iter().enumerate() {
                    limit(share.abs(), axis, 1.0);
                }
            }
            Shape::Arc { circle, radius, sweep, .. } => {
                let [first, second] = circle.plane;
                let radius = radius[0].min(radius[1]);
                let share = sweep.abs() * radius / self.length;
                let part = 0.5_f64.sqrt();
                for (axis, other) in direction.iter().enumerate() {
                    let of_plane = circle.plane.contains(&axis);
                    limit(if of_plane { share } else { other.abs() }, axis, if of_plane { part } else { 1.0 });
                }
                let weaker = axes.acceleration[first].min(axes.acceleration[second]);
                if share > 0.0 {
                    velocity = velocity.min((weaker * part * radius).sqrt() / share);
                }
            }
        }
        (velocity, acceleration)
    }
}

fn square(value: f64) -> f64 {
    value * value
}
