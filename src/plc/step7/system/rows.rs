//! What a row of the table of built-in blocks consists of.

use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::types::Section;

/// A built-in block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum System {
    SetClock,
    ReadClock,
    StartInformation,
    ReadConsistent,
    WriteConsistent,
    BlockMove,
    Fill,
    UpdateImage,
    Retrigger,
    DisableInterrupts,
    EnableInterrupts,
    DelayInterrupts,
    AllowInterrupts,
    Stop,
    Wait,
    TimeTick,
    CountUp,
    CountDown,
    CountUpDown,
    Pulse,
    OnDelay,
    OffDelay,
    TimerToTime,
    TimeToTimer,
    Limit,
    Maximum,
    Minimum,
    Scale,
    Unscale,
    DateOf,
    TimeOfDayOf,
    WeekdayOf,
    DateAndTime,
    IntToText,
    DoubleToText,
    TextToInt,
    TextToDouble,
    TextEqual,
    TextNotEqual,
    TextGreater,
    TextGreaterEqual,
    TextLess,
    TextLessEqual,
    DateEqual,
    DateNotEqual,
    DateGreater,
    DateGreaterEqual,
    DateLess,
    DateLessEqual,
    DateLater,
    DateEarlier,
    DateDifference,
    Length,
    Find,
    Left,
    Right,
    Middle,
    Concatenate,
    Insert,
    Delete,
    Replace,
    Select,
    BitSum,
    Encode,
    Decode,
    TestBlock,
    /// It does nothing and has this RET_VAL.
    Answer(u16),
    SetHours,
    ControlHours,
    ReadHours,
    CreateBlock,
    SetTimeOfDay,
    CancelTimeOfDay,
    ActivateTimeOfDay,
    QueryTimeOfDay,
    StartDelay,
    CancelDelay,
    QueryDelay,
    MaskFaults,
    UnmaskFaults,
    ReadFaults,
    ReplaceValue,
    RealToText,
    TextToReal,
    DeleteBlock,
    CreateLoaded,
    MoveLoaded,
    /// SET or RSET.
    SetBits(bool),
    StateList,
    Multicomputing,
    LongHours,
    /// A function block whose partner does not exist, with its STATUS.
    Refuse(u32),
}

/// Names, sections and types of parameters.
pub(super) type Parameters = &'static [(&'static str, Section, Kind)];

/// A row of the table: what it is, where it is called, its name, its parameters.
#[derive(Clone, Copy)]
pub(in crate::plc::step7) struct SystemBlock {
    pub(in crate::plc::step7) system: System,
    /// The number of the SFC or SFB; `None` for a function of a library, which is found by its name.
    pub(in crate::plc::step7) block: Option<BlockName>,
    pub(in crate::plc::step7) name: &'static str,
    pub(in crate::plc::step7) parameters: &'static [(&'static str, Section, Kind)],
}

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Kind {
    Bool,
    Byte,
    Word,
    Int,
    DInt,
    DWord,
    Real,
    Time,
    S5Time,
    Date,
    TimeOfDay,
    DateTime,
    Text,
    Any,
    /// A structure of 20 bytes.
    Information,
    /// Internal data of an IEC timer: 10 bytes.
    TimerState,
    Pointer,
    /// The header of a system state list: 4 bytes.
    Header,
}

pub(super) const fn sfc(number: u16) -> Option<BlockName> {
    Some(BlockName { kind: BlockKind::Sfc, number })
}

pub(super) const fn row(
    system: System,
    block: Option<BlockName>,
    name: &'static str,
    parameters: &'static [(&'static str, Section, Kind)],
) -> SystemBlock {
    SystemBlock { system, block, name, parameters }
}

pub(super) const RETURN: (&str, Section, Kind) = ("RET_VAL", Section::Output, Kind::Int);
