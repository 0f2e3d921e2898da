//! A block with values, as the channel executes it.

use serde::{Deserialize, Serialize};

use super::fault::Fault;
use super::link::{AxisReference, Link, LinkOff};

/// A block of a program: what has to be executed, with its values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Where it stands.
    pub origin: Origin,
    /// G functions, in their order. Modal ones are not repeated in later blocks.
    pub g: Vec<u32>,
    /// M functions, in their order.
    pub m: Vec<u32>,
    /// H functions, in their order.
    pub h: Vec<u32>,
    /// F: mm/min, or degrees/min.
    pub feed: Option<f64>,
    /// I, J, K: the centre of a circle.
    pub centre: [Option<f64>; 3],
    /// R: the radius of a circle.
    pub radius: Option<f64>,
    /// T
    pub tool: Option<f64>,
    /// D
    pub tool_data: Option<f64>,
    /// S
    pub spindle: Option<f64>,
    /// Axes and their values; empty in a block with G04 or G74.
    pub axes: Vec<(String, f64)>,
    /// The signs that stand directly behind the name of an axis, as in `A-90`: the direction of a modulo axis. They are in the values, too.
    pub signs: Vec<(String, Sign)>,
    /// Axes with two signs behind their names, as in `C--90`. This is possible for a modulo axis; for another one the message is raised.
    pub two_signs: Vec<(String, Fault)>,
    /// G74: axes and their place in the order. Equal numbers are homed together.
    pub homing: Vec<(String, u32)>,
    /// G04, `#TIME`.
    pub dwell: Option<Dwell>,
    /// A command; it is alone in its block.
    pub command: Option<Command>,
    /// M17, M29, M2, M30.
    pub end: Option<End>,
    /// Messages of class 1: 20003, 20375, 20685, 21111. The block is executed.
    pub warnings: Vec<Fault>,
}

/// A sign directly behind the name of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Sign {
    /// `C+90`
    Plus,
    /// `A-90`
    Minus,
}

impl Sign {
    pub(super) const fn of(letter: Option<char>) -> Option<Self> {
        match letter {
            Some('+') => Some(Self::Plus),
            Some('-') => Some(Self::Minus),
            _ => None,
        }
    }
}

/// Where a block stands.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The path of the program.
    pub program: String,
    /// The first line of the block, counted from one.
    pub line: u32,
    /// The N number.
    pub number: Option<u32>,
    /// The jump label: `N20:` or `[NAME]`.
    pub label: Option<String>,
    /// The level of `/`.
    pub skip: Option<u8>,
    /// The line as it was written.
    pub text: String,
}

impl Origin {
    /// The number that `channel_1.block` shows: the N number, of a block without one its line.
    #[must_use]
    pub fn block(&self) -> u32 {
        self.number.unwrap_or(self.line)
    }
}

/// A dwell time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Dwell {
    /// Not negative.
    pub seconds: f64,
    /// The axis with which it was written; the channel knows whether it is the first main axis.
    pub axis: Option<String>,
}

/// What M17, M29, M2 or M30 ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum End {
    /// The program: M2 or M30, with `lenient` M17 in a main program, too.
    Program,
    /// A subroutine: its caller goes on.
    Subroutine,
    /// M2 or M30 in a subroutine: the whole program is aborted, with a warning.
    Aborted,
}

/// A command.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Command {
    /// `#SET AX LINK`, `#AX LINK`: defines a group.
    Link(Link),
    /// `#ENABLE AX LINK`, `#AX LINK ON`: none is group 0 of the channel list.
    LinkOn(Option<i64>),
    /// `#DISABLE AX LINK`, `#AX LINK OFF`.
    LinkOff(LinkOff),
    /// `#GANTRY ON`, `#GANTRY OFF`.
    Gantry {
        /// ON.
        is_on: bool,
        /// Which combinations.
        targets: GantryTargets,
    },
    /// `#CALL AX`, `#AX REQUEST`: axes come to the channel.
    CallAxis {
        /// FAST: without the setpoints of the interpolator.
        is_fast: bool,
        /// What happens to names, numbers and indices that are there already.
        conflicts: Conflicts,
        /// At least one.
        requests: Vec<AxisRequest>,
    },
    /// `#PUT AX`, `#AX RELEASE`: axes leave the channel.
    PutAxis(PutTargets),
    /// G201 (on) and G202: manual mode with parallel interpolation.
    Manual {
        /// G201.
        is_on: bool,
        /// At least one.
        axes: Vec<String>,
    },
}

/// The combinations of `#GANTRY`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum GantryTargets {
    /// ALL.
    All,
    /// Masters, by name (`AX=`) or logical number (`AXNR=`).
    Masters(Vec<AxisReference>),
}

/// The switches NAM, NBR and IDX of `#AX REQUEST`; all off with `#CALL AX`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Conflicts {
    /// NAM
    pub name: bool,
    /// NBR
    pub number: bool,
    /// IDX
    pub index: bool,
}

/// `[Axis_X1, 5, 4]`
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AxisRequest {
    /// The name that the axis gets in the channel.
    pub name: String,
    /// Its logical number.
    pub number: u32,
    /// Its index in the channel, from 0.
    pub index: u32,
    /// Further words of the request.
    pub options: Vec<String>,
}

/// The axes of `#PUT AX`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PutTargets {
    /// ALL.
    All,
    /// Names in the channel.
    Names(Vec<String>),
    /// Logical numbers: `#AX RELEASE NBR`.
    Numbers(Vec<u32>),
}

/// Whether a block can have this G function. The control refuses others as a value that is not possible.
#[must_use]
pub const fn is_modelled(g: u32) -> bool {
    matches!(
        g,
        0..=4 | 9 | 17..=19 | 40..=42 | 53..=61 | 64 | 71 | 74 | 80 | 90 | 91 | 94 | 161 | 162 | 200..=202 | 260 | 261 | 359 | 360
    )
}
