//! The system blocks and library functions that are built in: their names, numbers and parameters.

use std::sync::Arc;

use crate::plc::step7::basic_program::BLOCKS;
use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::types::{Array, Layout, Section, Type};

use super::further::FURTHER;
use super::rare::RARE;
pub(in crate::plc::step7) use super::rows::{Kind, System, SystemBlock};
use super::rows::{RETURN, row, sfc};

use Kind::{
    Any, Bool, Byte, DInt, DWord, Date, DateTime, Information, Int, Real, S5Time, Text, Time, TimeOfDay, TimerState,
    Word,
};
use Section::{Input, Output, Static};

const fn sfb(number: u16) -> Option<BlockName> {
    Some(BlockName { kind: BlockKind::Sfb, number })
}

const IEC_TIMER: &[(&str, Section, Kind)] = &[
    ("IN", Input, Bool),
    ("PT", Input, Time),
    ("Q", Output, Bool),
    ("ET", Output, Time),
    ("STATE", Static, TimerState),
];
const THREE: &[(&str, Section, Kind)] =
    &[("IN1", Input, Any), ("IN2", Input, Any), ("IN3", Input, Any), ("RET_VAL", Output, Any)];
const MESSAGE: &[(&str, Section, Kind)] =
    &[("SIG", Input, Bool), ("ID", Input, Word), ("EV_ID", Input, DWord), ("SD", Input, Any), RETURN];
const TEXT: (&str, Section, Kind) = ("RET_VAL", Output, Text);
const TRUTH: (&str, Section, Kind) = ("RET_VAL", Output, Bool);
const TWO_TEXTS: &[(&str, Section, Kind)] = &[("S1", Input, Text), ("S2", Input, Text), TRUTH];
const TWO_DATES: &[(&str, Section, Kind)] = &[("DT1", Input, DateTime), ("DT2", Input, DateTime), TRUTH];
const DATE_AND_DURATION: &[(&str, Section, Kind)] =
    &[("T", Input, DateTime), ("D", Input, Time), ("RET_VAL", Output, DateTime)];
const TEXT_END: &[(&str, Section, Kind)] = &[("IN", Input, Text), ("L", Input, Int), TEXT];
const TEXT_PART: &[(&str, Section, Kind)] = &[("IN", Input, Text), ("L", Input, Int), ("P", Input, Int), TEXT];
const MOVE: &[(&str, Section, Kind)] = &[("SRCBLK", Input, Any), RETURN, ("DSTBLK", Output, Any)];

/// All built-in blocks.
pub(in crate::plc::step7) const SYSTEM: &[SystemBlock] = &joined::<{ COMMON.len() + RARE.len() }>(COMMON, RARE);

const COMMON: &[SystemBlock] = &joined::<{ FREQUENT.len() + FURTHER.len() }>(FREQUENT, FURTHER);

const fn joined<const N: usize>(first: &[SystemBlock], second: &[SystemBlock]) -> [SystemBlock; N] {
    let mut all = [first[0]; N];
    let mut index = 0;
    while index < N {
        all[index] = if index < first.len() { first[index] } else { second[index - first.len()] };
        index += 1;
    }
    all
}

/// The blocks that most programs call.
const FREQUENT: &[SystemBlock] = &[
    row(System::SetClock, sfc(0), "SET_CLK", &[("PDT", Input, DateTime), RETURN]),
    row(System::ReadClock, sfc(1), "READ_CLK", &[RETURN, ("CDT", Output, DateTime)]),
    row(
        System::StartInformation,
        sfc(6),
        "RD_SINFO",
        &[RETURN, ("TOP_SI", Output, Information), ("START_UP_SI", Output, Information)],
    ),
    row(System::ReadConsistent, sfc(14), "DPRD_DAT", &[("LADDR", Input, Word), RETURN, ("RECORD", Output, Any)]),
    row(System::WriteConsistent, sfc(15), "DPWR_DAT", &[("LADDR", Input, Word), ("RECORD", Input, Any), RETURN]),
    row(System::BlockMove, sfc(20), "BLKMOV", MOVE),
    row(System::BlockMove, sfc(81), "UBLKMOV", MOVE),
    row(System::Answer(0), sfc(17), "ALARM_SQ", MESSAGE),
    row(System::Answer(0), sfc(18), "ALARM_S", MESSAGE),
    row(System::Fill, sfc(21), "FILL", &[("BVAL", Input, Any), RETURN, ("BLK", Output, Any)]),
    row(
        System::TestBlock,
        sfc(24),
        "TEST_DB",
        &[("DB_NUMBER", Input, Word), RETURN, ("DB_LENGTH", Output, Word), ("WRITE_PROT", Output, Bool)],
    ),
    row(System::UpdateImage, sfc(26), "UPDAT_PI", &[("PART", Input, Byte), RETURN, ("FLADDR", Output, Word)]),
    row(System::UpdateImage, sfc(27), "UPDAT_PO", &[("PART", Input, Byte), RETURN, ("FLADDR", Output, Word)]),
    row(System::DisableInterrupts, sfc(39), "DIS_IRT", &[("MODE", Input, Byte), ("OB_NR", Input, Int), RETURN]),
    row(System::EnableInterrupts, sfc(40), "EN_IRT", &[("MODE", Input, Byte), ("OB_NR", Input, Int), RETURN]),
    row(System::DelayInterrupts, sfc(41), "DIS_AIRT", &[RETURN]),
    row(System::AllowInterrupts, sfc(42), "EN_AIRT", &[RETURN]),
    row(System::Retrigger, sfc(43), "RE_TRIGR", &[]),
    row(System::Stop, sfc(46), "STP", &[]),
    row(System::Wait, sfc(47), "WAIT", &[("WT", Input, Int)]),
    row(
        System::Answer(0x8090),
        sfc(58),
        "WR_REC",
        &[
            ("REQ", Input, Bool),
            ("IOID", Input, Byte),
            ("LADDR", Input, Word),
            ("RECNUM", Input, Byte),
            ("RECORD", Input, Any),
            RETURN,
            ("BUSY", Output, Bool),
        ],
    ),
    row(
        System::Answer(0x8090),
        sfc(59),
        "RD_REC",
        &[
            ("REQ", Input, Bool),
            ("IOID", Input, Byte),
            ("LADDR", Input, Word),
            ("RECNUM", Input, Byte),
            RETURN,
            ("BUSY", Output, Bool),
            ("RECORD", Output, Any),
        ],
    ),
    row(System::TimeTick, sfc(64), "TIME_TCK", &[("RET_VAL", Output, Time)]),
    row(
        System::CountUp,
        sfb(0),
        "CTU",
        &[
            ("CU", Input, Bool),
            ("R", Input, Bool),
            ("PV", Input, Int),
            ("Q", Output, Bool),
            ("CV", Output, Int),
            ("CUO", Static, Bool),
        ],
    ),
    row(
        System::CountDown,
        sfb(1),
        "CTD",
        &[
            ("CD", Input, Bool),
            ("LOAD", Input, Bool),
            ("PV", Input, Int),
            ("Q", Output, Bool),
            ("CV", Output, Int),
            ("CDO", Static, Bool),
        ],
    ),
    row(
        System::CountUpDown,
        sfb(2),
        "CTUD",
        &[
            ("CU", Input, Bool),
            ("CD", Input, Bool),
            ("R", Input, Bool),
            ("LOAD", Input, Bool),
            ("PV", Input, Int),
            ("QU", Output, Bool),
            ("QD", Output, Bool),
            ("CV", Output, Int),
            ("CUO", Static, Bool),
            ("CDO", Static, Bool),
        ],
    ),
    row(System::Pulse, sfb(3), "TP", IEC_TIMER),
    row(System::OnDelay, sfb(4), "TON", IEC_TIMER),
    row(System::OffDelay, sfb(5), "TOF", IEC_TIMER),
    row(System::TimerToTime, None, "S5TI_TIM", &[("IN", Input, S5Time), ("RET_VAL", Output, Time)]),
    row(System::TimeToTimer, None, "TIM_S5TI", &[("IN", Input, Time), ("RET_VAL", Output, S5Time)]),
    row(
        System::Limit,
        None,
        "LIMIT",
        &[("MN", Input, Any), ("IN", Input, Any), ("MX", Input, Any), ("RET_VAL", Output, Any)],
    ),
    row(System::Maximum, None, "MAX", THREE),
    row(System::Minimum, None, "MIN", THREE),
    row(
        System::Scale,
        None,
        "SCALE",
        &[
            ("IN", Input, Int),
            ("HI_LIM", Input, Real),
            ("LO_LIM", Input, Real),
            ("BIPOLAR", Input, Bool),
            ("RET_VAL", Output, Word),
            ("OUT", Output, Real),
        ],
    ),
    row(
        System::Unscale,
        None,
        "UNSCALE",
        &[
            ("IN", Input, Real),
            ("HI_LIM", Input, Real),
            ("LO_LIM", Input, Real),
            ("BIPOLAR", Input, Bool),
            ("RET_VAL", Output, Word),
            ("OUT", Output, Int),
        ],
    ),
    row(System::DateOf, None, "DT_DATE", &[("IN", Input, DateTime), ("RET_VAL", Output, Date)]),
    row(System::TimeOfDayOf, None, "DT_TOD", &[("IN", Input, DateTime), ("RET_VAL", Output, TimeOfDay)]),
    row(System::WeekdayOf, None, "DT_DAY", &[("IN", Input, DateTime), ("RET_VAL", Output, Int)]),
    row(
        System::DateAndTime,
        None,
        "D_TOD_DT",
        &[("IN1", Input, Date), ("IN2", Input, TimeOfDay), ("RET_VAL", Output, DateTime)],
    ),
    row(System::IntToText, None, "I_STRNG", &[("I", Input, Int), ("RET_VAL", Output, Text)]),
    row(System::DoubleToText, None, "DI_STRNG", &[("I", Input, DInt), ("RET_VAL", Output, Text)]),
    row(System::TextToInt, None, "STRNG_I", &[("S", Input, Text), ("RET_VAL", Output, Int)]),
    row(System::TextToDouble, None, "STRNG_DI", &[("S", Input, Text), ("RET_VAL", Output, DInt)]),
    row(System::TextEqual, None, "EQ_STRNG", TWO_TEXTS),
    row(System::DateEqual, None, "EQ_DT", TWO_DATES),
    row(System::TextNotEqual, None, "NE_STRNG", TWO_TEXTS),
    row(System::DateNotEqual, None, "NE_DT", TWO_DATES),
    row(System::TextGreater, None, "GT_STRNG", TWO_TEXTS),
    row(System::DateGreater, None, "GT_DT", TWO_DATES),
    row(System::TextGreaterEqual, None, "GE_STRNG", TWO_TEXTS),
    row(System::DateGreaterEqual, None, "GE_DT", TWO_DATES),
    row(System::TextLess, None, "LT_STRNG", TWO_TEXTS),
    row(System::DateLess, None, "LT_DT", TWO_DATES),
    row(System::TextLessEqual, None, "LE_STRNG", TWO_TEXTS),
    row(System::DateLessEqual, None, "LE_DT", TWO_DATES),
    row(System::DateLater, None, "AD_DT_TM", DATE_AND_DURATION),
    row(System::DateEarlier, None, "SB_DT_TM", DATE_AND_DURATION),
    row(
        System::DateDifference,
        None,
        "SB_DT_DT",
        &[("DT1", Input, DateTime), ("DT2", Input, DateTime), ("RET_VAL", Output, Time)],
    ),
    row(System::Length, None, "LEN", &[("S", Input, Text), RETURN]),
    row(System::Find, None, "FIND", &[("IN1", Input, Text), ("IN2", Input, Text), RETURN]),
    row(System::Left, None, "LEFT", TEXT_END),
    row(System::Right, None, "RIGHT", TEXT_END),
    row(System::Middle, None, "MID", TEXT_PART),
    row(System::Delete, None, "DELETE", TEXT_PART),
    row(System::Concatenate, None, "CONCAT", &[("IN1", Input, Text), ("IN2", Input, Text), TEXT]),
    row(System::Insert, None, "INSERT", &[("IN1", Input, Text), ("IN2", Input, Text), ("P", Input, Int), TEXT]),
    row(
        System::Replace,
        None,
        "REPLACE",
        &[("IN1", Input, Text), ("IN2", Input, Text), ("L", Input, Int), ("P", Input, Int), TEXT],
    ),
    row(
        System::Select,
        None,
        "SEL",
        &[("G", Input, Bool), ("IN0", Input, Any), ("IN1", Input, Any), ("RET_VAL", Output, Any)],
    ),
    row(System::BitSum, None, "BITSUM", &[("IN", Input, DWord), RETURN]),
    row(System::Encode, None, "ENCO", &[("IN", Input, DWord), RETURN]),
    row(System::Decode, None, "DECO", &[("IN", Input, Word), ("RET_VAL", Output, DWord)]),
];

impl SystemBlock {
    /// Its parameters, and for a function block its instance.
    pub(in crate::plc::step7) fn layout(&self) -> Layout {
        let mut layout = Layout::default();
        for &(name, section, kind) in self.parameters {
            // The rows of the table are small, so they fit.
            layout.add(name, kind.ty(), section);
        }
        layout
    }
}

impl Kind {
    fn ty(self) -> Type {
        let bytes = |count| Type::Array(Arc::new(Array { ranges: vec![(1, count)], element: Type::Byte }));
        match self {
            Self::Bool => Type::Bool,
            Self::Byte => Type::Byte,
            Self::Word => Type::Word,
            Self::Int => Type::Int,
            Self::DInt => Type::DInt,
            Self::DWord => Type::DWord,
            Self::Real => Type::Real,
            Self::Time => Type::Time,
            Self::S5Time => Type::S5Time,
            Self::Date => Type::Date,
            Self::TimeOfDay => Type::TimeOfDay,
            Self::DateTime => Type::DateTime,
            Self::Text => Type::Text(254),
            Self::Any => Type::Any,
            Self::Information => bytes(20),
            Self::TimerState => bytes(10),
            Self::Pointer => Type::Pointer,
            Self::Header => bytes(4),
        }
    }
}

/// The index of the first block of the basic program among the built-in blocks.
pub(in crate::plc::step7) const BASIC: usize = 1000;

/// The parameters of a built-in block, and for a function block its instance.
pub(in crate::plc::step7) fn layout_of(index: usize) -> Layout {
    match index.checked_sub(BASIC) {
        Some(basic) => BLOCKS[basic].layout.clone(),
        None => SYSTEM[index].layout(),
    }
}

/// The index of a system block by its number.
pub(in crate::plc::step7) fn by_number(block: BlockName) -> Option<usize> {
    SYSTEM.iter().position(|row| row.block == Some(block))
}

/// The index of a library function by its name.
pub(in crate::plc::step7) fn by_name(name: &str) -> Option<usize> {
    SYSTEM.iter().position(|row| row.block.is_none() && row.name.eq_ignore_ascii_case(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_iec_timer_has_22_bytes() {
        let timer = &SYSTEM[by_number(BlockName { kind: BlockKind::Sfb, number: 4 }).unwrap()];
        let layout = timer.layout();
        let bits: Vec<_> = layout.fields.iter().map(|field| field.bit / 8).collect();
        assert_eq!(bits, [0, 2, 6, 8, 12]);
        assert_eq!(layout.image.len(), 22);
    }
}
