//! The output of the control in addition to signals: values of axes and channels, raised alarms, and events with their causes.
//!
//! The control writes all of it once per cycle, in the stage "publish". Traces, expressions and clients read it. This module is
//! independent of a particular control: alarms and rules are numbers, and the control provides their texts through [`Describe`].

mod alarms;
mod axis_value;
mod channel_values;
mod events;
mod happening;
mod named_value;
pub mod nc;
mod place;
mod r_parameters;

pub use alarms::{
    AlarmNumber, Alarms, Arrival, LongTexts, MessageCount, Parameter, RaisedAlarm, ShortText, short_text,
};
pub use axis_value::{AxisValue, six_decimals};
pub use channel_values::{ChannelValues, ProgramName, ShownProgram, nc_file, program_name};
pub use events::{BlockName, Event, EventId, Events, Input, Quantity, Rule, RuleNumber, SignalBit};
pub use happening::{DatumValue, FaultName, Happening};
pub use named_value::{NamedValue, is_r_parameter, r_parameter};
pub use place::{Place, axis_name, place_name};
pub use r_parameters::RParameters;

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::image::Names;
use crate::units::{AxisNumber, ChannelNumber, PerAxis, PerChannel, Position};

/// The values of one machine axis, as in the actual-value display and the service-axes view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct AxisValues {
    /// Actual value in the machine coordinate system, from the active measuring system.
    pub position: Position,
    /// Setpoint in the machine coordinate system.
    pub setpoint: Position,
    /// Actual velocity in mm/min; of a rotary axis in the unit of the control.
    pub velocity: f64,
    /// Setpoint minus actual value.
    pub following_error: Position,
    /// True position of the slide, in the machine frame of the plant.
    pub slide: Position,
    /// Actual value minus ideal position (MON-01); zero on every axis except a synchronous axis.
    pub synchronism_difference: Position,
    /// Actual values of encoders 1 and 2, active or not; zero for an encoder that does not exist.
    pub encoders: [Position; 2],
    /// Remaining distance of a movement with a target.
    pub distance_to_go: Position,
    /// Compensation of the active encoder: leadscrew error and backlash, contained in the actual value.
    pub encoder_compensation: Position,
    /// Compensation of the setpoint: sag and temperature, contained in neither the setpoint nor the actual value.
    pub setpoint_compensation: Position,
}

/// The complete output of the control in addition to signals.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Variables {
    /// The values of each machine axis.
    pub axes: PerAxis<AxisValues>,
    /// The values of each channel.
    pub channels: PerChannel<ChannelValues>,
    /// The R parameters of each channel.
    pub r_parameters: RParameters,
    /// The pending alarms.
    pub alarms: Alarms,
    /// How many messages there have been since the scenario began; empty for a control that does not count.
    pub messages: Vec<MessageCount>,
    /// The parameters in effect that expressions can read by name; empty for a control without them.
    pub parameters: Arc<Vec<ParameterValue>>,
}

/// A parameter in effect.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct ParameterValue {
    /// Its number.
    pub number: u32,
    /// Its indices.
    pub index: [u16; 2],
    /// Its axis or channel.
    pub place: Place,
    /// Its value; NaN for a word.
    pub value: f64,
    /// Its word, if it is one.
    pub word: Option<ShortText>,
}

/// Values are compared bit by bit: the NaN of a word equals itself.
impl PartialEq for ParameterValue {
    fn eq(&self, other: &Self) -> bool {
        let key = |of: &Self| (of.number, of.index, of.place, of.value.to_bits());
        key(self) == key(other) && self.word == other.word
    }
}

/// The texts for the numbers, provided by the control.
pub trait Describe {
    /// The names of axes and channels.
    fn names(&self) -> &Names;
    /// The text of the alarm with its parameters filled in.
    fn alarm_text(&self, alarm: &RaisedAlarm) -> String;
    /// A longer text of an alarm that the control keeps. The default is a control without them.
    fn message_text(&self, _index: u32) -> &str {
        ""
    }
    /// The displayed name of the alarm: its number, or its name if it has only a name.
    fn alarm_name(&self, number: AlarmNumber) -> String;
    /// The number that stands for the name of an alarm.
    fn alarm_number(&self, name: &str) -> Option<AlarmNumber>;
    /// The names of all alarms that have no number, for suggestions. The default is none.
    fn alarm_names(&self) -> Vec<String> {
        Vec::new()
    }
    /// Whether the control defines an alarm with this number.
    fn has_alarm(&self, _: AlarmNumber) -> bool {
        true
    }
    /// The number and the indices of a parameter of an axis or a channel, by its name. The default is a control without named parameters.
    fn parameter(&self, _name: &str, _place: Place) -> Option<(u32, [u16; 2])> {
        None
    }
    /// The rule with this number.
    fn rule(&self, rule: RuleNumber) -> Rule;
    /// All rules that causes name, in the order of their numbers, which begin at 0; several can have one ID. The default is none.
    fn rules(&self) -> &'static [Rule] {
        &[]
    }
    /// The displayed name of a machine datum: `MD37110`.
    fn datum_name(&self, number: u32) -> String;
    /// Whether positions of the axis are in degrees.
    fn is_rotary(&self, _axis: AxisNumber) -> bool {
        false
    }
    /// Half a count of the coarsest encoder of an axis: how far an actual position can be from that of the slide.
    fn half_count(&self, _axis: AxisNumber) -> Position {
        Position::ZERO
    }
    /// The active value of a machine datum; the index is `None` for a datum with one value. `None` if it does not exist or is a text.
    fn active_datum(&self, _number: u32, _index: Option<u8>, _axis: Option<AxisNumber>) -> Option<f64> {
        None
    }
    /// The number of R parameters of a channel. The default is a control without them.
    fn r_parameter_count(&self, _channel: ChannelNumber) -> usize {
        0
    }
    /// The value of a machine datum in the units of causes: lengths in mm.
    fn in_causes(&self, _number: u32, _axis: Option<AxisNumber>, value: f64) -> f64 {
        value
    }
}
