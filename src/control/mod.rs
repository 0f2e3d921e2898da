//! THE BOUNDARY OF A CONTROL: the interface between a numerical control and the rest of the project.
//!
//! `tests/machine/second_control/platform.rs` is a tiny control of 32 drives that implements this whole module. Start with a copy of it.
//!
//! [`Control`] is the trait that the machine steps. A control provides everything specific to it: the interface
//! ([`Interface`](crate::image::Interface)), signals, machine data, alarms, rules, and charts of its state machines. Only the control's own
//! module and the one place that opens machines name a specific control.
//!
//! The machine calls a control in this order, once per interpolation cycle:
//!
//! 1. [`Control::begin_cycle`], then [`Control::command`], for each [`ControlCommand`] that was queued, at the edge of the cycle;
//! 2. [`Control::decide`], after the PLC scan: takes what the PLC and the HMI wrote, commands setpoints;
//! 3. [`Control::velocity_command`], for each axis that is awake and each position-control cycle, while drives and
//!    mechanics move;
//! 4. [`Control::observe`], once encoders and drives have reported: monitoring and alarms;
//! 5. [`Control::publish`]: writes its half of the interface and the variables;
//! 6. [`Control::cause`] and the related methods, for each bit that changed, while the record is written.

mod conditions;
mod data;
mod finding;
mod log;
mod opening;
mod operator;
mod texts;
mod transitions;
mod value;

pub use conditions::{Condition, Fact, Looks, Question, Row, fact, yes};
pub use data::{Data, Datum, Owner};
pub use finding::{Class, Finding, summary};
pub use log::Log;
pub use opening::{AxisHints, Configuration, EncoderModel, Examined, Opened, Read, Settings, Site, StoredDatum};
pub use operator::{FunctionGenerator, SearchKind};
pub use texts::{AlarmRow, ClearInfo, DatumRow, Texts};
pub use transitions::{CHARTS, Chart, ChartPosition, Edge, Rows, Taken, Transition, next, row};
pub use value::{Kind, Value};

use std::any::Any;
use std::fmt::Debug;

use crate::image::{Location, Names, OverrideCoding};
use crate::motion::Feedback;
use crate::nc_program::Program;
use crate::source::Problem;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, Position, Time};
use crate::variables::{
    AlarmNumber, DatumValue, EventId, Events, FaultName, Place, RParameters, RaisedAlarm, ShownProgram, Variables,
};

/// A command to a control from outside, taken at the edge of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlCommand {
    /// Stores a machine datum or parameter. It takes effect as its class defines.
    Store {
        /// The datum, as users write it: `34090[XF]`.
        target: String,
        /// Its value.
        value: Value,
    },
    /// Makes stored data effective that wait for it ("set machine data active").
    Activate,
    /// Writes an R parameter.
    RParameter {
        /// The channel.
        channel: ChannelNumber,
        /// `R number`.
        number: u16,
        /// Its value.
        value: f64,
    },
    /// Selects the program of a channel.
    SelectProgram {
        /// The channel.
        channel: ChannelNumber,
        /// Its path among the programs of the control.
        path: String,
    },
    /// Gives blocks to a channel, for manual data input.
    EnterBlocks {
        /// The channel.
        channel: ChannelNumber,
        /// The blocks, one a line.
        text: String,
    },
    /// The operator gives an axis another actual value at the place where it stands (PRESET).
    Preset {
        /// The axis.
        axis: AxisNumber,
        /// Its new actual value, in millimetres or degrees.
        value: f64,
    },
    /// Searches a block of the selected program, from which the program goes on.
    Search {
        /// The channel.
        channel: ChannelNumber,
        /// The block: `N50`, `:50`, or a label.
        block: String,
        /// How.
        kind: SearchKind,
    },
    /// Gives the function generator a signal for an axis. NC start in JOG begins it.
    FunctionGenerator(FunctionGenerator),
    /// The operator's alarm-cancel key.
    Cancel,
    /// A handwheel is turned.
    Handwheel {
        /// Number, from 1.
        number: u8,
        /// Number of pulses, with sign.
        pulses: i32,
        /// Number of cycles over which the pulses are spread.
        cycles: u64,
    },
    /// The PLC program stopped running.
    PlcMissing,
    /// The PLC program is running again.
    PlcRestarted,
    /// The PLC program shows exactly these messages from now on, by their numbers in ascending order.
    PlcMessages(Vec<u32>),
    /// A client, scenario or operator wrote these bits of the control's or the HMI's part of the interface.
    Written(Location),
    /// A fault of the mechanics, a drive or an encoder began or ended. No axis rests in the next cycle.
    Fault {
        /// The axis.
        axis: AxisNumber,
        /// The kind.
        name: FaultName,
        /// Whether it began.
        begins: bool,
        /// The axes that it can move: the axis, and those that a bridge connects with it.
        affected: AxisSet,
    },
}

/// The data written by the PLC and the HMI, as the control reads them in one cycle.
#[derive(Clone, Copy, Debug)]
pub struct PlcSide<'a> {
    /// The bytes that the PLC writes to the NCK.
    pub to_nck: &'a [u8],
    /// The bytes that the HMI writes.
    pub hmi: &'a [u8],
}

/// The data that a control writes at the end of a cycle.
#[derive(Debug)]
pub struct ControlSide<'a> {
    /// The bytes that the NCK writes.
    pub from_nck: &'a mut [u8],
    /// The bytes of the HMI to which a control may mirror its own state.
    pub hmi: &'a mut [u8],
}

/// The differences between the PLC's half now and in the last cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changes {
    /// Axes whose block changed.
    pub axes: AxisSet,
    /// Another block of the control changed.
    pub shared: bool,
    /// The PLC has scanned since the last cycle, or there is no PLC program: it has seen what the control had output.
    pub scanned: bool,
    /// The newest cycle of the control that the PLC had seen when it wrote what the control reads now; `None` if the PLC has not scanned since.
    pub seen: Option<u64>,
    /// The PLC sees what the control writes later than in the next cycle (`from_nck_delay`).
    pub is_late: bool,
}

/// A machine datum that became active, with the event that activated it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Activated {
    /// The datum and its value now.
    pub datum: DatumValue,
    /// The event.
    pub event: EventId,
}

/// The cycle times of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleTimes {
    /// The interpolation cycle: one step of the machine. More than 0; otherwise simulated time would stand still.
    pub interpolation: Time,
    /// Number of position-control cycles in an interpolation cycle. At least 1; otherwise no axis would move.
    pub position_control: u32,
}

/// A numerical control behind the interface. The module documentation states when each method is called.
pub trait Control: Send + Sync + Debug {
    /// Checks whether a command can be taken now. Called at the boundary, before the command is queued. Changes nothing.
    ///
    /// # Errors
    /// A datum or handwheel does not exist, or a value does not fit the datum.
    fn check(&self, command: &ControlCommand) -> Result<(), Problem>;

    /// A cycle begins; from now on, events belong to the cycle of this number. A control with a [`Log`] calls [`Log::begin`].
    fn begin_cycle(&mut self, cycle: u64);

    /// Takes a command that [`Control::check`] has accepted, at the edge of a cycle. A command has no effect if an earlier command of the
    /// same cycle has made it impossible. Returns the event that was recorded for it: the root of everything that follows from it.
    fn command(&mut self, command: &ControlCommand) -> EventId;

    /// The machine data that became active since the last call.
    fn take_activated(&mut self) -> Vec<Activated> {
        Vec::new()
    }

    /// Computes the decisions of a cycle: reads the data of the PLC and the HMI, and sets the setpoints for position control. `changes` are
    /// the differences of the PLC's half from the previous cycle.
    fn decide(&mut self, plc: PlcSide<'_>, changes: Changes);

    /// Why the control stops the PLC program now: it does not run again before power off. `None` if it does not.
    fn stops_plc(&self) -> Option<String> {
        None
    }

    /// The PLC goes to STOP: makes its signals those of a PLC that does not run, and returns whether there are such. The default is a control that
    /// shares its memory with the PLC, where they stay as they are.
    fn neutralise(&self, _to_nck: &mut [u8]) -> bool {
        false
    }

    /// Position control of an axis in part `part` (from 1) of `of` parts of the interpolation cycle. Returns the velocity command for the
    /// drive, in increments per second; `None` for a drive without power. `counts` are the present values of both encoders.
    fn velocity_command(&mut self, axis: AxisNumber, counts: [Position; 2], part: u32, of: u32) -> Option<f64>;

    /// The axes whose setpoint rests: each of their position-control cycles in this interpolation cycle repeats the previous one while
    /// their encoders report the same values. Called after each position-control cycle. The default is no axis.
    fn still(&self) -> AxisSet {
        AxisSet::NONE
    }

    /// Whether the holding brake of an axis is to be open. The default is a control without brakes.
    fn opens_brake(&self, _axis: AxisNumber) -> bool {
        true
    }

    /// Takes the feedback of drives and encoders of the axes `changed`, and monitors it. The feedback of the other axes has not changed.
    fn observe(&mut self, feedback: &PerAxis<Feedback>, changed: AxisSet);

    /// Writes the control's half of the interface and the variables. The mechanics of the axes `restless` are not at rest.
    fn publish(&mut self, out: ControlSide<'_>, variables: &mut Variables, restless: AxisSet);

    /// The axes that are computed in this cycle. The state of the others does not change. The default is all axes.
    fn awake(&self) -> AxisSet {
        AxisSet::ALL
    }

    /// From now on moves, monitors and publishes every axis in every cycle: slower, with identical bytes. The default does nothing, for a
    /// control whose axes are always awake.
    fn never_rest(&mut self) {}

    /// From now on also makes all decisions for every axis in every cycle: even slower, with identical bytes.
    fn decide_always(&mut self) {
        self.never_rest();
    }

    /// Power off and on: stored data become effective, everything else starts again. Only the numbers of the cycle and of the events go on:
    /// the control keeps its [`Events`], because the record refers to them. Returns the event recorded for it.
    fn power_on(&mut self) -> EventId;

    /// The cycle times in effect, never 0. The machine checks this when it is opened.
    fn cycle_times(&self) -> CycleTimes;

    /// Whether the machine has this channel, according to its stored data. The default is every channel.
    fn has_channel(&self, channel: ChannelNumber) -> bool {
        let _ = channel;
        true
    }

    /// Whether the machine has this mode group, according to its stored data. The default is every mode group.
    fn has_mode_group(&self, mode_group: ModeGroupNumber) -> bool {
        let _ = mode_group;
        true
    }

    /// The active measuring system of an axis, 0 or 1; `None` for a parked axis.
    fn measuring_system(&self, axis: AxisNumber) -> Option<u8>;

    /// The event behind the present value of a bit that the control writes, at byte and bit of the block of `place`, as decided in the
    /// present cycle. It may record an event for a value that follows directly from the present state.
    fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId;

    /// The event behind a pending alarm.
    fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId;

    /// The alarms that were raised in this cycle although they were pending. The default is none, for a control that raises an alarm once.
    fn raised_again(&self) -> &[RaisedAlarm] {
        &[]
    }

    /// The event that cleared an alarm.
    fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId;

    /// What must hold so that a bit of the control's part has a value, tested with the state after the last cycle, in which `plc` was
    /// read. The default is `None`, for a control that does not say.
    fn conditions(&self, _question: &Question<'_>, _plc: PlcSide<'_>) -> Option<Condition> {
        None
    }

    /// The latest events.
    fn events(&self) -> &Events;

    /// The coding of the machine's override switches, according to the data in effect.
    fn override_coding(&self) -> OverrideCoding;

    /// The effective override of an axis, in per cent. The default is 100 %, for a control without axial overrides.
    fn axis_override(&self, _axis: AxisNumber, _plc: PlcSide<'_>) -> f64 {
        100.0
    }

    /// The effective override of a spindle, in per cent. The default is 100 %, for a control without spindles.
    fn spindle_override(&self, _axis: AxisNumber, _plc: PlcSide<'_>) -> f64 {
        100.0
    }

    /// The effective overrides of a channel, in per cent: feed and rapid traverse. The default is 100 %, for a control without overrides.
    fn channel_overrides(&self, _channel: ChannelNumber, _plc: PlcSide<'_>) -> [f64; 2] {
        [100.0; 2]
    }

    /// The motor speed of an axis in rev/min, with pitch and gear, from the axis velocity in mm/min or rev/min. The default is the same
    /// number, for an axis without a gear and with a pitch of 1 mm.
    fn motor_speed(&self, _axis: AxisNumber, velocity: f64) -> f64 {
        velocity
    }

    /// What operator panels show of the program of a channel. The default is a control without programs.
    fn shown_program(&self, _channel: ChannelNumber) -> ShownProgram<'_> {
        ShownProgram::default()
    }

    /// The settable zero offset of an axis, in mm or degrees: frame 1 is G54. The default is none.
    fn zero_offset(&self, _channel: ChannelNumber, _frame: u8, _axis: AxisNumber) -> f64 {
        0.0
    }

    /// The value of an R parameter; `None` if it does not exist. The default is a control without them.
    fn r_parameter(&self, _channel: ChannelNumber, _number: u16) -> Option<f64> {
        None
    }

    /// All R parameters. The default is none.
    fn r_parameters(&self) -> RParameters {
        RParameters::default()
    }

    /// The NC programs in memory as a text that [`Program::read`] reads again: first the one with this path, then, if `all`, the others.
    /// `None` if no program has this path. The default is a control without programs.
    fn program_text(&self, _path: &str, _all: bool) -> Option<String> {
        None
    }

    /// Puts NC programs into the memory of the control, in the place of those with the same paths; subprograms are also searched in
    /// `search_path`. The default is a control without programs.
    fn load_programs(&mut self, _programs: Vec<Program>, _search_path: Vec<String>) {}

    /// The machine data or parameters, by number.
    fn data(&self) -> &dyn Data;

    /// A longer text of a message, [`Parameter::OfControl`](crate::variables::Parameter::OfControl). The default is a control without them.
    fn message_text(&self, _index: u32) -> &str {
        ""
    }

    /// The texts of the control.
    fn texts(&self) -> &'static dyn Texts;

    /// Whether positions of the axis are in degrees.
    fn is_rotary(&self, axis: AxisNumber) -> bool;

    /// The active value of a machine datum; the index is `None` for a datum with one value. The default is a control that knows none.
    fn active_datum(&self, _number: u32, _index: Option<u8>, _axis: Option<AxisNumber>) -> Option<f64> {
        None
    }

    /// The value of a machine datum in the units of causes: lengths in mm. The default is a control whose data have these units.
    fn in_causes(&self, _number: u32, _axis: Option<AxisNumber>, value: f64) -> f64 {
        value
    }

    /// The configuration that results from the data, as lines of text: the gantry groupings. The default is no line.
    fn configuration(&self, _names: &Names) -> Vec<String> {
        Vec::new()
    }

    /// The rows of the charts that were used, in the order of [`Texts::charts`]. The default is none, for a control without charts.
    fn taken(&self) -> Taken {
        Taken::default()
    }

    /// Where each part of the machine is in the charts. The default is none, for a control without charts.
    fn chart_positions(&self) -> Vec<ChartPosition> {
        Vec::new()
    }

    /// The complete state, as bytes.
    fn save(&self) -> Vec<u8>;

    /// Continues from the state at [`Control::save`], on a control of the same kind.
    ///
    /// # Errors
    /// The bytes are not a saved control of this kind and version. In this case nothing has changed.
    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem>;

    /// An independent copy that continues from the present state.
    fn clone_box(&self) -> Box<dyn Control>;

    /// The control itself, for callers that know its type.
    fn as_any(&self) -> &dyn Any;
}

impl dyn Control {
    /// The control as a specific type; `None` if it is of another type.
    #[must_use]
    pub fn downcast<C: 'static>(&self) -> Option<&C> {
        self.as_any().downcast_ref()
    }
}
