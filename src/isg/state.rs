//! The state of the control: plain data.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::channel::Channel;
use super::combination::Combination;
use super::homing::run::Run;
use super::lists::Lists;
use super::parameters::AxisParameters;
use super::pending::Pending;
use crate::control::Log;
use crate::motion::coupling::Axes;
use crate::motion::{Feedback, Motion, Setpoint};
use crate::nc_program::Program;
use crate::units::{AxisNumber, AxisSet, PerAxis, Position, Time};
use crate::variables::{EventId, ParameterValue};

/// The cycle of the CNC.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Cycle(pub Time);

impl Default for Cycle {
    fn default() -> Self {
        Self(Time::from_millis(2))
    }
}

/// The control units of an axis, as they act.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Units {
    pub drive_enable: bool,
    pub feed_enable: bool,
    pub gantry_on: bool,
}

/// An error of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub(super) enum AxisError {
    /// A reset clears it.
    Resettable,
    /// Only a restart clears it.
    Locked,
}

/// The events behind the signals of an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct AxisCauses {
    /// The last fault of the mechanics or the drive that began or ended.
    pub fault: EventId,
    pub drive_enable: EventId,
    pub feed_enable: EventId,
    pub gantry_on: EventId,
    pub ready: EventId,
    pub homed: EventId,
    pub homing: EventId,
    pub error: EventId,
    pub coupled: EventId,
    pub motion: EventId,
}

/// An axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Axis {
    pub parameters: AxisParameters,
    /// Whether the machine has it.
    pub exists: bool,
    pub setpoint: Setpoint,
    /// The command of this cycle.
    pub motion: Option<Motion>,
    pub feedback: Feedback,
    /// Actual value minus encoder value.
    pub shift: Position,
    pub homed: bool,
    pub run: Option<Run>,
    /// While the axes of its combination are being homed, the limits of a slave do not yet refer to P-AXIS-00073 (HG-29).
    pub waits_for_others: bool,
    pub error: Option<AxisError>,
    pub units: Units,
    /// The drive has been ready since the start.
    pub was_ready: bool,
    /// The drive keeps power although it reports a fault, until the axis stands.
    pub fault_stop: bool,
    /// Somebody moves the slide by hand: the setpoint follows once.
    pub tracks_once: bool,
    /// The fault that the drive reports has been raised.
    pub fault_raised: bool,
    /// `gantry_on` wants the difference of this slave cleared.
    pub clears: bool,
    /// The number of cycles in which the slide has not moved.
    pub still: u32,
    pub causes: AxisCauses,
}

impl Axis {
    /// The actual value.
    pub(super) fn actual(&self) -> Position {
        self.feedback.encoders[0].value + self.shift
    }

    /// A position as it is shown: that of a modulo axis is within its range.
    pub(super) fn shown(&self, position: Position) -> Position {
        self.parameters.modulo.map_or(position, |modulo| modulo.shown(position))
    }

    /// Setpoint minus actual value.
    pub(super) fn following_error(&self) -> Position {
        self.setpoint.position - self.actual()
    }

    /// Whether the position loop is closed: the drive is enabled and ready.
    pub(super) fn is_powered(&self) -> bool {
        let has_power = if self.feedback.drive_fault { self.fault_stop } else { self.feedback.drive_ready };
        self.units.drive_enable && has_power
    }

    /// Whether it stands at its setpoint.
    pub(super) fn is_in_position(&self) -> bool {
        self.setpoint.is_at_rest() && self.following_error().abs() <= IN_POSITION
    }

    /// Whether it stands where it will stay: at its setpoint, or held away from it.
    pub(super) fn has_settled(&self) -> bool {
        self.setpoint.is_at_rest() && (self.is_in_position() || self.still >= STILL)
    }
}

/// The window of "in position": 0.1 µm, or 0.0001°.
pub(super) const IN_POSITION: Position = Position::new(100);
/// Cycles without movement after which an axis counts as standing.
const STILL: u32 = 25;

/// The whole state.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct State {
    pub log: Log,
    pub lists: Lists,
    pub cycle: Cycle,
    /// NC programs are read as the manuals print them (E-25).
    pub lenient: bool,
    /// Drives that react and home by themselves.
    pub intelligent: AxisSet,
    pub axes: PerAxis<Axis>,
    pub combinations: Vec<Combination>,
    /// The NC programs in memory, by their paths.
    pub programs: BTreeMap<String, Arc<Program>>,
    pub channels: Vec<Channel>,
    pub pending: Pending,
    /// The parameters in effect, for expressions.
    pub in_effect: Arc<Vec<ParameterValue>>,
    pub power_on: EventId,
    /// What holds since the start of the controller.
    pub as_after_start: EventId,
    /// The parameters that became active and are not recorded yet.
    pub activated: Vec<(ParameterValue, EventId)>,
    pub plc_missing: EventId,
    /// The encoders have not reported since the start.
    pub starts: bool,
}

impl State {
    /// The axes of the machine.
    pub(super) fn existing(&self) -> impl Iterator<Item = AxisNumber> + use<> {
        let exists: AxisSet = self.axes.iter().filter(|(_, axis)| axis.exists).map(|(number, _)| number).collect();
        exists.iter()
    }

    /// The axis with this logical number.
    pub(super) fn axis_of(&self, number: u16) -> Option<AxisNumber> {
        self.axes.iter().find(|(_, axis)| axis.exists && axis.parameters.number == number).map(|(axis, _)| axis)
    }
}

/// What couplings read.
pub(super) struct AxesView<'a>(pub &'a PerAxis<Axis>);

impl Axes for AxesView<'_> {
    fn actual(&self, axis: AxisNumber) -> Position {
        self.0[axis].actual()
    }

    fn setpoint(&self, axis: AxisNumber) -> &Setpoint {
        &self.0[axis].setpoint
    }

    fn is_referenced(&self, axis: AxisNumber) -> bool {
        self.0[axis].homed
    }
}
