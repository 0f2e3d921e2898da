//! WHAT THE CONTROL SHOWS BESIDES BITS: axis values, raised alarms, and events with their causes.
//!
//! The control writes all of it once in each cycle, in the stage "publish"; traces, expressions and clients read it.
//! Nothing here knows a particular control: alarms and rules are numbers, whose texts the control gives
//! through [`Describe`].

mod alarms;
mod axis_value;
mod events;
mod place;
mod r_parameters;

pub use alarms::{AlarmNumber, Alarms, Arrival, Parameter, RaisedAlarm};
pub use axis_value::{AxisValue, six_decimals};
pub use events::{Event, EventId, Events, Input, Quantity, Rule, RuleNumber, SignalBit};
pub use place::{Place, axis_name, place_name};
pub use r_parameters::RParameters;

use serde::{Deserialize, Serialize};

use crate::image::Names;
use crate::units::{AxisNumber, PerAxis, Position};

/// What one machine axis shows, as the actual-value display and the service-axes view do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisValues {
    /// Actual value in the machine coordinate system, from the active measuring system.
    pub position: Position,
    /// Setpoint in the machine coordinate system.
    pub setpoint: Position,
    /// Actual velocity in mm/min or rev/min.
    pub velocity: f64,
    /// Setpoint minus actual value.
    pub following_error: Position,
    /// True position of the slide, in the machine frame of the plant.
    pub slide: Position,
    /// Actual value minus ideal position (MON-01); zero on everything but a synchronous axis.
    pub synchronism_difference: Position,
    /// Actual values of encoder 1 and 2, whichever of them is active; zero where there is none.
    pub encoders: [Position; 2],
    /// The way that is left of a movement that has an end.
    pub distance_to_go: Position,
}

/// Everything that the control shows beside bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Variables {
    /// The values of each machine axis.
    pub axes: PerAxis<AxisValues>,
    /// What is pending.
    pub alarms: Alarms,
}

/// The texts behind the numbers, given by the control.
pub trait Describe {
    /// The names of axes and channels.
    fn names(&self) -> &Names;
    /// The alarm's text with its parameters filled in.
    fn alarm_text(&self, alarm: &RaisedAlarm) -> String;
    /// The alarm as it is called: its number, or a name of our own.
    fn alarm_name(&self, number: AlarmNumber) -> String;
    /// The number behind a name of our own.
    fn alarm_number(&self, name: &str) -> Option<AlarmNumber>;
    /// Whether the control has an alarm of this number at all.
    fn has_alarm(&self, _: AlarmNumber) -> bool {
        true
    }
    /// A rule by its number.
    fn rule(&self, rule: RuleNumber) -> Rule;
    /// What a machine datum is called: `MD37110`.
    fn datum_name(&self, number: u32) -> String;
    /// Whether the lengths of an axis are degrees.
    fn is_rotary(&self, _axis: AxisNumber) -> bool {
        false
    }
}
