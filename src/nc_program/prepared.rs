//! What preparation hands to the channel: a block as it is to be executed.
//!
//! Values are those that the program wrote: frames, units and limits are the business of the channel. Only programmable offsets have a unit, since
//! G70 and G71 act on them where they are programmed.

use serde::{Deserialize, Serialize};

use super::auxiliary::AuxiliaryKind;
use super::condition::{Condition, MainRunValue};
use super::functions::{GFunction, Modal};
use super::names::AxisIndex;
use super::syntax::Frequency;
use super::value::Value;

/// The result of one call of the interpreter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Prepared {
    /// A block to be executed.
    Block(Box<Block>),
    /// A block that only calculated, jumped or called. Single block type 2 stops after it.
    Calculated(Origin),
    /// The next block is that of [`stop_before`](super::Interpreter::stop_before), and only calculates, jumps or calls. Nothing of it was done.
    Before(Origin),
    /// The next block needs that everything before has been executed. Nothing has changed; call again when it has.
    Waits(Origin),
    /// The program has ended: there are no more blocks.
    Ended,
}

/// Where a block comes from.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Origin {
    /// The path of the program.
    pub program: String,
    /// The line, counted from one.
    pub line: u32,
    /// The program level: 0 is the main program.
    pub level: u8,
    /// How alarms and displays name the block: its number, else its label, else its line.
    pub name: String,
    /// The source text.
    pub text: String,
    /// The skip level.
    pub skip: Option<u8>,
    /// Single block does not stop at this block (SBLOF).
    pub is_single_block_off: bool,
    /// The display shows the calling block instead (DISPLOF).
    pub is_display_off: bool,
}

/// A block to be executed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Block {
    /// Where it comes from.
    pub origin: Origin,
    /// The modal G functions that hold in it.
    pub modal: Modal,
    /// Its G functions that hold only in it: G4, G9, G53, G74, TRANS, …
    pub once: Vec<GFunction>,
    /// The path feedrate that holds in it.
    pub feed: Option<f64>,
    /// The programmable offset (TRANS, ATRANS) that holds in it, in millimetres or degrees. Axes without an entry have 0.
    pub offset: Vec<(AxisIndex, f64)>,
    /// Axis words, in their order.
    pub axes: Vec<AxisWord>,
    /// Centre, radius, angle and turns of a circle.
    pub circle: Circle,
    /// Auxiliary functions, in their order.
    pub auxiliary: Vec<AuxiliaryFunction>,
    /// Everything else that the block does, in its order.
    pub actions: Vec<Action>,
    /// M17, M2 or M30 in it, and what ends.
    pub end: Option<End>,
    /// The next block may only be prepared when this one has been executed. The interpreter then waits itself.
    pub stops_preparation: bool,
}

impl Block {
    /// Whether the block moves, outputs or dwells: single block type 1 stops after it.
    #[must_use]
    pub fn is_executable(&self) -> bool {
        !self.axes.is_empty() || !self.auxiliary.is_empty() || !self.actions.is_empty() || self.end.is_some()
    }
}

/// How a position is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Dimension {
    /// G90, AC.
    Absolute,
    /// G91, IC.
    Incremental,
    /// DC: absolute, the shortest way.
    Shortest,
    /// ACP: absolute, from plus.
    FromPlus,
    /// ACN: absolute, from minus.
    FromMinus,
}

/// A position of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AxisWord {
    /// The axis.
    pub axis: AxisIndex,
    /// The programmed value.
    pub value: f64,
    /// How it is meant.
    pub dimension: Dimension,
}

/// A component of the centre of a circle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Centre {
    /// The programmed value.
    pub value: f64,
    /// From the zero point (AC) instead of the start of the circle.
    pub is_absolute: bool,
}

/// What describes a circle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Circle {
    /// I, J, K.
    pub centre: [Option<Centre>; 3],
    /// CR; negative: more than half a circle.
    pub radius: Option<f64>,
    /// AR, in degrees.
    pub opening_angle: Option<f64>,
    /// TURN: additional full circles.
    pub turns: Option<u16>,
}

impl Circle {
    /// Whether nothing is programmed.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

/// The predefined auxiliary function group of an M function: 1 stop and end, 2 spindle, 4 gear stage.
#[must_use]
pub fn predefined_group(m: f64) -> Option<u8> {
    let has = |numbers: &[f64]| numbers.contains(&m);
    if has(&[0.0, 1.0, 2.0, 17.0, 30.0]) {
        Some(1)
    } else if has(&[3.0, 4.0, 5.0, 19.0, 70.0]) {
        Some(2)
    } else if has(&[40.0, 41.0, 42.0, 43.0, 44.0, 45.0]) {
        Some(4)
    } else {
        None
    }
}

/// Whether an M function concerns a spindle: M3, M4, M5, M19, M70, M40 to M45.
#[must_use]
pub fn is_of_spindle(m: f64) -> bool {
    matches!(predefined_group(m.round()), Some(2 | 4))
}

/// An auxiliary function.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct AuxiliaryFunction {
    /// The kind.
    pub kind: AuxiliaryKind,
    /// The number in the address, as 2 in `M2=3`.
    pub extension: Option<u16>,
    /// The axis of FA.
    pub axis: Option<AxisIndex>,
    /// The value.
    pub value: f64,
    /// QU: quick acknowledgement.
    pub is_quick: bool,
}

/// What else a block does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Action {
    /// G4 F: a pause in seconds.
    DwellSeconds(f64),
    /// G4 S: a pause in revolutions of a spindle; None is the master spindle.
    DwellRevolutions {
        /// The spindle.
        spindle: Option<u16>,
        /// The revolutions.
        revolutions: f64,
    },
    /// G74: these axes approach their reference points.
    Reference(Vec<AxisIndex>),
    /// G25, G26: working area limits or spindle speed limits.
    Limit {
        /// G26.
        is_upper: bool,
        /// Limits of axes.
        axes: Vec<(AxisIndex, f64)>,
        /// Limits of spindles; None is the master spindle.
        spindles: Vec<(Option<u16>, f64)>,
    },
    /// POS, POSA.
    Position {
        /// Axis and target.
        target: AxisWord,
        /// POS: the block ends when the axis is there. POSA does not wait.
        waits: bool,
    },
    /// `FA[X]=`, modal.
    AxisFeed(AxisIndex, f64),
    /// `FDA[X]=`: a handwheel changes the velocity of the positioning of this block; with 0 it moves the axis to the target.
    HandwheelFeed(AxisIndex, f64),
    /// `FD=`: a handwheel changes the path feed of this block.
    PathHandwheelFeed(f64),
    /// FGROUP: the path feed refers to these axes from now on; none: to the geometry axes.
    FeedGroup(Vec<AxisIndex>),
    /// `ACC[X]=`, in percent.
    Acceleration(AxisIndex, f64),
    /// `OVR=`, in percent.
    Override(f64),
    /// SPOS, SPOSA.
    SpindlePosition {
        /// None is the master spindle.
        spindle: Option<u16>,
        /// The position in degrees.
        value: f64,
        /// How it is meant.
        dimension: Dimension,
        /// SPOS: the block ends when the spindle is there.
        waits: bool,
    },
    /// WAITP: these axes have reached their targets and become neutral.
    WaitForPosition(Vec<AxisIndex>),
    /// WAITS: these spindles have reached their positions; none is the master spindle.
    WaitForSpindle(Vec<u16>),
    /// RELEASE: these axes become neutral.
    Release(Vec<AxisIndex>),
    /// GET, GETD (directly): these axes come to the channel.
    Get {
        /// The axes.
        axes: Vec<AxisIndex>,
        /// GETD.
        is_direct: bool,
    },
    /// PRESETON: these axes get these actual values.
    Preset(Vec<(AxisIndex, f64)>),
    /// MSG; None clears the message.
    Message(Option<String>),
    /// SETAL: raises a cycle alarm with a text.
    CycleAlarm {
        /// 60000 to 69999.
        number: u32,
        /// The text.
        text: Option<String>,
    },
    /// TRAILON, LEADON, COUPON, EGON and their ends.
    Coupling {
        /// The kind.
        kind: CouplingKind,
        /// Whether it begins.
        is_on: bool,
        /// The following axis.
        following: AxisIndex,
        /// The leading axis.
        leading: Option<AxisIndex>,
        /// The other parameters.
        parameters: Vec<Option<Value>>,
    },
    /// SETM: sets marks.
    SetMarks(Vec<u16>),
    /// CLEARM: clears marks; none: all.
    ClearMarks(Vec<u16>),
    /// WAITM, WAITMC (conditionally): waits for a mark in channels.
    WaitMark {
        /// The mark.
        mark: u16,
        /// The channels.
        channels: Vec<u16>,
        /// WAITMC: goes on without a stop if the mark is set already.
        is_conditional: bool,
    },
    /// INIT: selects a program in a channel.
    Initialise {
        /// The channel.
        channel: u16,
        /// The program.
        program: String,
        /// "S": waits until it is selected.
        waits: bool,
    },
    /// START: starts the selected programs of channels.
    Start(Vec<u16>),
    /// WAITE: waits for the end of the programs in channels.
    WaitEnd(Vec<u16>),
    /// NEWCONF: makes changed machine data effective.
    NewConfiguration,
    /// DRFOF: the DRF offsets of all axes of the channel end.
    EndOverlays,
    /// A synchronised action begins.
    Synchronised(Box<SynchronisedAction>),
    /// CANCEL: these synchronised actions end.
    Cancel(Vec<i32>),
}

/// The kind of a coupling.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CouplingKind {
    /// TRAILON
    Trail,
    /// LEADON
    Lead,
    /// COUPON
    Synchronous,
    /// EGON
    ElectronicGear,
}

/// What M17, M2 or M30 ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum End {
    /// A subprogram: the caller goes on. MD20800 decides whether the M function is output.
    Subprogram,
    /// The program.
    Program,
}

/// A synchronised action: the channel evaluates its condition in every cycle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SynchronisedAction {
    /// None: it ends with the next executable block.
    pub id: Option<i32>,
    /// IDS: it outlives the program.
    pub is_static: bool,
    /// When the actions are executed.
    pub frequency: Frequency,
    /// The condition; none with [`Frequency::Always`].
    pub condition: Option<Condition>,
    /// The actions.
    pub actions: Vec<MainRunAction>,
}

/// An action of a synchronised action. Its values are calculated when it is executed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum MainRunAction {
    /// POS: a command axis moves.
    Position {
        /// The axis.
        axis: AxisIndex,
        /// The target.
        value: MainRunValue,
        /// How it is meant.
        dimension: Dimension,
    },
    /// `FA[X]=`
    AxisFeed(AxisIndex, MainRunValue),
    /// M, S, H.
    Auxiliary {
        /// The kind.
        kind: AuxiliaryKind,
        /// The number in the address.
        extension: Option<u16>,
        /// The value.
        value: MainRunValue,
    },
    /// `$AC_MARKER[0]=…`, `$R[1]=…`: the place with its indices, and the value.
    Assign {
        /// The name of the system variable.
        name: String,
        /// Its indices.
        indices: Vec<Value>,
        /// The value.
        value: MainRunValue,
    },
    /// RDISABLE: no block change in this cycle.
    ReadInDisable,
    /// SETM.
    SetMarks(Vec<u16>),
    /// CLEARM.
    ClearMarks(Vec<u16>),
}
