//! The coupling of a gantry: one leader, its followers, and how far they are apart.
//!
//! This is the part that does not depend on a control. It knows who leads at the moment (the dependency can be
//! inverted while a follower is referenced), hands the leader's movement on in the same cycle, and keeps the
//! synchronism difference free of jumps while references are set (decision O-12). What a stage that is exceeded
//! means (message, alarm, stop, lock) is the control's business.

use serde::{Deserialize, Serialize};

use crate::units::{AxisNumber, Position};

/// How many followers a coupling can have.
pub(super) const FOLLOWERS: usize = 2;

/// A follower and the base of its difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct Follower {
    axis: AxisNumber,
    /// What counts as no difference: 0 once both are referenced (absolute), before that where they were when the
    /// coupling closed.
    base: Position,
}

/// Which limits a difference is beyond.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stage {
    /// Beyond the first limit (warning); never, where that limit is 0.
    pub first: bool,
    /// Beyond the second limit (trip).
    pub second: bool,
}

/// The difference of one follower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference(pub Position);

impl Difference {
    /// Compares it with both limits: strictly greater is beyond, equal is not (O-11).
    #[must_use]
    pub fn stage(self, first: Position, second: Position) -> Stage {
        let distance = self.0.abs();
        Stage { first: first > Position::ZERO && distance > first, second: distance > second }
    }
}

/// A coupling of axes that move together.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Coupling {
    leader: AxisNumber,
    followers: [Option<Follower>; FOLLOWERS],
    leads_now: AxisNumber,
}

impl Coupling {
    /// A coupling of a leader with its followers; `None` where there are too many.
    #[must_use]
    pub fn new(leader: AxisNumber, followers: &[AxisNumber]) -> Option<Self> {
        let mut coupling = Self { leader, followers: [None; FOLLOWERS], leads_now: leader };
        if followers.len() > FOLLOWERS {
            return None;
        }
        for (slot, &axis) in coupling.followers.iter_mut().zip(followers) {
            *slot = Some(Follower { axis, base: Position::ZERO });
        }
        Some(coupling)
    }

    /// The leader by definition.
    #[must_use]
    pub const fn leader(&self) -> AxisNumber {
        self.leader
    }

    /// The followers by definition, ascending as they were given.
    pub fn followers(&self) -> impl DoubleEndedIterator<Item = AxisNumber> + '_ {
        self.followers.iter().flatten().map(|follower| follower.axis)
    }

    /// Leader and followers.
    pub fn members(&self) -> impl Iterator<Item = AxisNumber> + '_ {
        std::iter::once(self.leader).chain(self.followers())
    }

    /// Who leads at the moment.
    #[must_use]
    pub const fn leads_now(&self) -> AxisNumber {
        self.leads_now
    }

    /// Inverts the dependency, or reverts it: this member leads from now on.
    pub fn lead_with(&mut self, axis: AxisNumber) {
        debug_assert!(self.members().any(|member| member == axis));
        self.leads_now = axis;
    }

    /// The coupling closes: differences count from here (O-12), but for those that are absolute already.
    pub fn close(&mut self, actual: impl Fn(AxisNumber) -> Position, absolute: impl Fn(AxisNumber) -> bool) {
        let leader = actual(self.leader);
        for follower in self.followers.iter_mut().flatten() {
            follower.base = if absolute(follower.axis) { Position::ZERO } else { actual(follower.axis) - leader };
        }
    }

    /// The actual value of an axis was given another value by a reference; `absolute` tells of each follower
    /// whether it and the leader are both referenced now, from when on its difference is absolute.
    pub fn value_shifted(&mut self, axis: AxisNumber, by: Position, absolute: impl Fn(AxisNumber) -> bool) {
        for follower in self.followers.iter_mut().flatten() {
            if axis != self.leader && axis != follower.axis {
                continue;
            }
            if absolute(follower.axis) {
                follower.base = Position::ZERO;
            } else if axis == follower.axis {
                follower.base += by;
            } else {
                follower.base -= by;
            }
        }
    }

    /// The synchronism difference of a follower: its actual value minus its ideal position (MON-01).
    #[must_use]
    pub fn difference(&self, follower: AxisNumber, leader_actual: Position, follower_actual: Position) -> Difference {
        let base =
            self.followers.iter().flatten().find(|known| known.axis == follower).map_or(Position::ZERO, |f| f.base);
        Difference(follower_actual - leader_actual - base)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axis(number: u8) -> AxisNumber {
        AxisNumber::new(number).unwrap()
    }

    fn mm(value: f64) -> Position {
        Position::from_user(value)
    }

    fn coupling() -> Coupling {
        Coupling::new(axis(1), &[axis(3)]).unwrap()
    }

    #[test]
    fn the_difference_before_referencing_is_the_change_since_the_coupling_closed() {
        let mut coupling = coupling();
        coupling.close(|which| if which == axis(1) { mm(5.0) } else { mm(7.0) }, |_| false);
        assert_eq!(coupling.difference(axis(3), mm(5.0), mm(7.0)).0, mm(0.0));
        assert_eq!(coupling.difference(axis(3), mm(6.0), mm(8.25)).0, mm(0.25));
    }

    #[test]
    fn setting_the_first_reference_makes_no_jump_and_the_last_makes_it_absolute() {
        let mut coupling = coupling();
        coupling.close(|_| mm(0.0), |_| false);
        // Leader at 10.0 becomes 0.0: shifted by −10.
        coupling.value_shifted(axis(1), mm(-10.0), |_| false);
        assert_eq!(coupling.difference(axis(3), mm(0.0), mm(10.0)).0, mm(0.0));
        coupling.value_shifted(axis(3), mm(-10.941), |_| true);
        assert_eq!(coupling.difference(axis(3), mm(0.0), mm(-0.941)).0, mm(-0.941));
    }

    #[test]
    fn exactly_at_a_limit_is_not_beyond_it() {
        let limit = mm(0.2);
        assert!(!Difference(mm(37.7) - mm(37.5)).stage(limit, limit).second);
        assert!(Difference(mm(-0.200_001)).stage(limit, limit).second);
        assert!(!Difference(mm(50.0)).stage(Position::ZERO, mm(100.0)).first, "0 is no warning limit");
    }

    #[test]
    fn inverted_another_leads_and_the_leader_stays_the_leader() {
        let mut coupling = Coupling::new(axis(2), &[axis(4), axis(7)]).unwrap();
        coupling.lead_with(axis(4));
        assert_eq!((coupling.leader(), coupling.leads_now()), (axis(2), axis(4)));
        assert_eq!(Coupling::new(axis(1), &[axis(2), axis(3), axis(4)]), None);
    }
}
