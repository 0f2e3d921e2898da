//! What holds a vertical slide: its holding brake, or the power of its drive.
//!
//! A brake opens and closes on a command, some time later. Until it holds, a slide without power falls. A slide that never had power since
//! the machine began stands on its support and does not fall.

use serde::{Deserialize, Serialize};

use super::reading::time;
use crate::motion::Brake;
use crate::source::{Node, Problem, Value};
use crate::units::Time;

/// The holding brake of a motor, which the drive opens and closes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HoldingBrake {
    /// From the command to open until it no longer holds; default 50 ms.
    pub opening_time: Time,
    /// From the command to close until it holds; default 30 ms.
    pub closing_time: Time,
}

impl Default for HoldingBrake {
    fn default() -> Self {
        Self { opening_time: Time::from_millis(50), closing_time: Time::from_millis(30) }
    }
}

/// `brake = true`, `brake = false`, or a table with times.
pub(super) fn holding_brake(node: Node) -> Result<Option<HoldingBrake>, Problem> {
    let mut brake = HoldingBrake::default();
    if let Value::Boolean(there) = node.value {
        return Ok(there.then_some(brake));
    }
    let mut table = node.into_table("a holding brake, true or false")?;
    if let Some(node) = table.take("opening_time") {
        brake.opening_time = time(&node)?;
    }
    if let Some(node) = table.take("closing_time") {
        brake.closing_time = time(&node)?;
    }
    table.finish()?;
    Ok(Some(brake))
}

/// The acceleration of a falling slide, 9.81 m/s2, in increments per second squared.
pub(super) const GRAVITY: f64 = 9.81e9;

/// The state of a holding brake.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Hold {
    /// It is to be open.
    wanted: bool,
    /// It does not hold.
    open: bool,
    /// Time until it is as wanted.
    left: Time,
    /// The drive has had power: nothing else supports the slide since.
    pub(super) carried: bool,
}

impl Hold {
    /// One cycle. Returns whether anything changed.
    pub(super) fn step(&mut self, wanted: bool, brake: HoldingBrake, cycle: Time) -> bool {
        let before = *self;
        if wanted != self.wanted {
            self.wanted = wanted;
            self.left = if wanted { brake.opening_time } else { brake.closing_time };
        }
        if self.open != self.wanted {
            self.left = (self.left - cycle).max(Time::ZERO);
            if self.left == Time::ZERO {
                self.open = self.wanted;
            }
        }
        *self != before
    }

    /// Without current the brake closes.
    pub(super) fn power_off(&mut self) {
        (self.wanted, self.open, self.left) = (false, false, Time::ZERO);
    }

    /// Whether the brake holds.
    pub(super) const fn holds(&self) -> bool {
        !self.open
    }

    /// Whether a slide without power and without a closed brake falls.
    pub(super) const fn falls(&self) -> bool {
        self.carried
    }

    pub(super) const fn state(&self) -> Brake {
        match (self.open, self.wanted) {
            (true, true) => Brake::Open,
            (false, false) => Brake::Closed,
            (true, false) | (false, true) => Brake::Moving,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_brake_opens_and_closes_after_its_times() {
        let brake = HoldingBrake { opening_time: Time::from_millis(6), closing_time: Time::from_millis(4) };
        let cycle = Time::from_millis(2);
        let mut hold = Hold::default();
        assert!(hold.state() == Brake::Closed && hold.holds());
        for expected in [Brake::Moving, Brake::Moving, Brake::Open, Brake::Open] {
            hold.step(true, brake, cycle);
            assert_eq!(hold.state(), expected);
        }
        // While it closes it does not hold yet.
        hold.step(false, brake, cycle);
        assert!(hold.state() == Brake::Moving && !hold.holds());
        hold.step(false, brake, cycle);
        assert!(hold.state() == Brake::Closed && hold.holds());
    }
}
