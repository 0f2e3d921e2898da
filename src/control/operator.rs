//! What an operator starts: block searches and the function generator.

use serde::{Deserialize, Serialize};

use crate::motion::Waveform;
use crate::units::{AxisNumber, Time};

/// A signal that the function generator adds to the setpoint of an axis, and of the axes that are coupled with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FunctionGenerator {
    /// The axis.
    pub axis: AxisNumber,
    /// The signal.
    pub signal: Waveform,
    /// The amplitude for the axis and that for the axes coupled with it, in millimetres or degrees.
    pub amplitude: [f64; 2],
    /// This is added to the signal, in millimetres or degrees.
    pub offset: f64,
    /// Periods in a second.
    pub frequency: f64,
    /// How long it acts.
    pub duration: Time,
}

/// How a block search comes to its block.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum SearchKind {
    /// Nothing before the block counts.
    WithoutCalculation,
    /// Everything before it is calculated; the axes go to its start.
    Contour,
    /// Everything before it is calculated; the axes go to its end.
    EndPoint,
    /// Everything before it is executed in a program test (SERUPRO).
    ProgramTest,
}
