//! THE BOUNDARY OF A CONTROL: what a numerical control is to the rest of the project.
//!
//! [`Control`] is the trait that the machine steps. A control brings everything that has a name of its own: the interface
//! ([`Interface`]), signals, machine data, alarms, rules, charts of its state machines. Nothing outside the control's own
//! module and the one place that opens machines names it.
//!
//! The machine calls a control in this order, once per interpolation cycle:
//!
//! 1. [`Control::command`], for each [`ControlCommand`] that was queued, at the edge of the cycle;
//! 2. [`Control::decide`], after the PLC scan: takes what the PLC and the HMI wrote, commands setpoints;
//! 3. [`Control::velocity_command`], for each axis that is awake and each position-control cycle, while drives and
//!    mechanics move;
//! 4. [`Control::observe`], once encoders and drives have reported: monitoring and alarms;
//! 5. [`Control::publish`]: writes its half of the interface and the variables;
//! 6. [`Control::cause`] and its like, for each bit that changed, while the record is written.

mod data;
mod log;
mod opening;
mod transitions;
mod value;

pub use data::{Data, Datum, Owner};
pub use log::Log;
pub use opening::{AxisHints, Configuration, EncoderModel, Examined, Opened, Read, Site};
pub use transitions::{CHARTS, Chart, Edge, Rows, Taken, Transition, next, row};
pub use value::{Kind, Value};

use std::any::Any;
use std::fmt::Debug;

use crate::image::{Interface, Location, Names, OverrideCoding};
use crate::motion::Feedback;
use crate::source::Problem;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, PerAxis, Position, Time};
use crate::variables::{AlarmNumber, EventId, Events, Place, Rule, RuleNumber, Variables};

/// What is done to a control from outside, at the edge of a cycle.
#[derive(Clone, Debug, PartialEq)]
pub enum ControlCommand {
    /// Stores a machine datum or parameter; it acts when its class says.
    Store {
        /// Which, as people write it: `34090[XF]`.
        target: String,
        /// Its value.
        value: Value,
    },
    /// Makes stored data active that wait for it ("set machine data active").
    Activate,
    /// The operator's alarm-cancel key.
    Cancel,
    /// A handwheel is turned.
    Handwheel {
        /// From 1.
        number: u8,
        /// How far, with its sign.
        pulses: i32,
        /// Over how many cycles the pulses spread.
        cycles: u64,
    },
    /// The PLC program does not run.
    PlcMissing,
    /// The PLC program runs again.
    PlcRestarted,
    /// A client, scenario or operator wrote these bits of the control's or the HMI's part.
    Written(Location),
    /// Something happened to the mechanics: no axis rests in the next cycle.
    Wake,
}

/// What the PLC and the HMI wrote, as the control reads it in one cycle.
#[derive(Clone, Copy, Debug)]
pub struct PlcSide<'a> {
    /// What the PLC writes to the NCK.
    pub to_nck: &'a [u8],
    /// What the HMI writes.
    pub hmi: &'a [u8],
}

/// What a control writes at the end of a cycle.
#[derive(Debug)]
pub struct ControlSide<'a> {
    /// What the NCK writes.
    pub from_nck: &'a mut [u8],
    /// The bytes of the HMI that a control may mirror its own state to.
    pub hmi: &'a mut [u8],
}

/// What the PLC's half has other than in the last cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Changes {
    /// Axes whose block changed.
    pub axes: AxisSet,
    /// Another block of the control changed.
    pub shared: bool,
}

/// The times of a control.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CycleTimes {
    /// The interpolation cycle: one step of the machine.
    pub interpolation: Time,
    /// How many position-control cycles it has.
    pub position_control: u32,
}

/// A numerical control behind the interface. The head of this module says when each method is called.
pub trait Control: Send + Sync + Debug {
    /// Whether a command could be taken now; called at the boundary, before the command is queued. Changes nothing.
    ///
    /// # Errors
    /// A datum or handwheel that does not exist, or a value that does not fit it.
    fn check(&self, command: &ControlCommand) -> Result<(), Problem>;

    /// Takes a command that [`Control::check`] has passed, at the edge of a cycle. A command that an earlier one of the same
    /// cycle has made impossible does nothing.
    fn command(&mut self, command: &ControlCommand);

    /// Decides a cycle: reads what the PLC and the HMI wrote, and leaves the setpoints that position control works on. `cycle` is
    /// its number, `changes` says what of the PLC's half is another than in the cycle before.
    fn decide(&mut self, cycle: u64, plc: PlcSide<'_>, changes: Changes);

    /// Position control of an axis in part `part` (from 1) of `of` parts of the interpolation cycle: the velocity that its drive is
    /// to have, in increments per second; `None` for a drive without power. `counts` are the values of both encoders now.
    fn velocity_command(&mut self, axis: AxisNumber, counts: [Position; 2], part: u32, of: u32) -> Option<f64>;

    /// The axes for which every position-control cycle of this interpolation cycle is like the one before as long as their encoders
    /// report the same: their setpoint rests. Asked behind each position-control cycle; a control that does not know has none.
    fn still(&self) -> AxisSet {
        AxisSet::NONE
    }

    /// Takes what the drives and encoders of the axes `told` report, and monitors it. The others report what they did before.
    fn observe(&mut self, feedback: &PerAxis<Feedback>, told: AxisSet);

    /// Writes its half of the interface and the variables. The mechanics of the axes `restless` have not come to rest.
    fn publish(&mut self, out: ControlSide<'_>, variables: &mut Variables, restless: AxisSet);

    /// The axes that are computed in this cycle. The others come out of a cycle as they went in.
    fn awake(&self) -> AxisSet;

    /// Moves, monitors and shows every axis in every cycle from now on: slower, and the same bytes.
    fn never_rest(&mut self);

    /// Decides everything for every axis in every cycle from now on, too: slower still, and the same bytes.
    fn decide_always(&mut self) {
        self.never_rest();
    }

    /// Power off and on: stored data become active, everything else starts anew.
    fn power_on(&mut self);

    /// Its cycle times as they act now.
    fn cycle_times(&self) -> CycleTimes;

    /// The active measuring system of an axis, 0 or 1; `None` for a parked one.
    fn measuring_system(&self, axis: AxisNumber) -> Option<u8>;

    /// The event behind the present value of a bit that the control writes: byte and bit of the block of `place`, as it was decided in
    /// the cycle that runs. It may note an event for what follows from a value at the moment.
    fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId;

    /// The event behind a pending alarm.
    fn alarm_cause(&self, number: AlarmNumber, place: Place) -> EventId;

    /// The event that took an alarm away.
    fn cleared_cause(&self, number: AlarmNumber, place: Place) -> EventId;

    /// The latest events.
    fn events(&self) -> &Events;

    /// How the override switches of the machine are coded, as the active data say.
    fn override_coding(&self) -> OverrideCoding;

    /// The override of an axis that acts, in per cent.
    fn axis_override(&self, axis: AxisNumber, plc: PlcSide<'_>) -> f64;

    /// The overrides of a channel that act, in per cent: feed and rapid traverse.
    fn channel_overrides(&self, channel: ChannelNumber, plc: PlcSide<'_>) -> [f64; 2];

    /// The speed of the motor of an axis in rev/min, behind pitch and gear, from its velocity in mm/min or rev/min.
    fn motor_speed(&self, axis: AxisNumber, velocity: f64) -> f64;

    /// Its machine data or parameters, by number.
    fn data(&self) -> &dyn Data;

    /// Its texts.
    fn texts(&self) -> &'static dyn Texts;

    /// Whether the lengths of an axis are degrees.
    fn is_rotary(&self, axis: AxisNumber) -> bool;

    /// What its data make of the machine, in lines for people: its gantry groupings.
    fn configuration(&self, names: &Names) -> Vec<String>;

    /// Which rows of its charts it has taken, in the order of [`Texts::charts`].
    fn taken(&self) -> Taken;

    /// Everything that it remembers, as bytes.
    fn save(&self) -> Vec<u8>;

    /// Goes on from where [`Control::save`] was called, on a control of the same kind.
    ///
    /// # Errors
    /// The bytes are no saved control of this kind and version; nothing has changed then.
    fn restore(&mut self, saved: &[u8]) -> Result<(), Problem>;

    /// A second control that goes on from here by itself.
    fn clone_box(&self) -> Box<dyn Control>;

    /// The control itself, for those who know which one it is.
    fn as_any(&self) -> &dyn Any;
}

impl dyn Control {
    /// The control as one of a kind; `None` where it is another.
    #[must_use]
    pub fn downcast<C: 'static>(&self) -> Option<&C> {
        self.as_any().downcast_ref()
    }
}

/// The words of a control: what stands behind its numbers. They depend on no machine.
pub trait Texts: Sync {
    /// What it is called in saved machines and messages.
    fn name(&self) -> &'static str;

    /// Its interface.
    fn interface(&self) -> &'static Interface;

    /// All its alarms, ascending by number.
    fn alarms(&self) -> Vec<AlarmRow>;

    /// The alarm of a number.
    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow>;

    /// What an alarm is called: its number, or a name of our own where no source gives a number.
    fn alarm_name(&self, number: AlarmNumber) -> String;

    /// The number of an alarm that has only a name of our own.
    fn alarm_named(&self, name: &str) -> Option<AlarmNumber>;

    /// A rule by its number.
    fn rule(&self, rule: RuleNumber) -> Rule;

    /// What a datum is called in a cause: `MD37110`.
    fn datum_name(&self, number: u32) -> String;

    /// The data that set its cycle times, for the cure of an error: `MD10050 and MD10070`.
    fn cycle_data(&self) -> &'static str;

    /// Its state machines as charts.
    fn charts(&self) -> Vec<Chart>;
}

/// An alarm that a control has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlarmRow {
    /// Its number.
    pub number: AlarmNumber,
    /// What it is called: its number, or a name of our own.
    pub name: String,
    /// Its text, with `%1` to `%4`.
    pub text: &'static str,
    /// Whether the model raises it.
    pub raised: bool,
    /// What cancels it, in words.
    pub cancelled_by: String,
    /// What it does, in words.
    pub reaction: String,
    /// What cancels it, as NC variables number it.
    pub clear_info: u8,
}
