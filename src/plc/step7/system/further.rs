//! Rows of the table of system functions for what machine programs call now and then: hours meters, interrupts of time, masks of faults, and
//! modules and stations that the simulator does not have.

use crate::plc::step7::text::types::Section::{Input, Output};

use super::rows::Kind::{Any, Bool, Byte, DWord, DateTime, Int, Real, Text, Time, Word};
use super::rows::{Parameters, RETURN, System, SystemBlock, row, sfc};

const BUSY: (&str, crate::plc::step7::text::types::Section, super::rows::Kind) = ("BUSY", Output, Bool);
const QUERY: Parameters = &[("OB_NR", Input, Int), RETURN, ("STATUS", Output, Word)];
const NUMBER: Parameters = &[("OB_NR", Input, Int), RETURN];
const MESSAGE: Parameters = &[
    ("SIG", Input, Bool),
    ("ID", Input, Word),
    ("EV_ID", Input, DWord),
    ("CMP_ID", Input, DWord),
    ("SD", Input, Any),
    RETURN,
];

/// No module has this address.
const NO_MODULE: System = System::Answer(0x8090);
const DONE: System = System::Answer(0);

pub(super) const FURTHER: &[SystemBlock] = &[
    row(System::SetHours, sfc(2), "SET_RTM", &[("NR", Input, Byte), ("PV", Input, Int), RETURN]),
    row(System::ControlHours, sfc(3), "CTRL_RTM", &[("NR", Input, Byte), ("S", Input, Bool), RETURN]),
    row(
        System::ReadHours,
        sfc(4),
        "READ_RTM",
        &[("NR", Input, Byte), RETURN, ("CQ", Output, Bool), ("CV", Output, Int)],
    ),
    row(
        NO_MODULE,
        sfc(5),
        "GADR_LGC",
        &[
            ("SUBNETID", Input, Byte),
            ("RACK", Input, Word),
            ("SLOT", Input, Word),
            ("SUBSLOT", Input, Byte),
            ("SUBADDR", Input, Word),
            RETURN,
            ("IOID", Output, Byte),
            ("LADDR", Output, Word),
        ],
    ),
    row(
        DONE,
        sfc(7),
        "DP_PRAL",
        &[("REQ", Input, Bool), ("IOID", Input, Byte), ("LADDR", Input, Word), ("AL_INFO", Input, DWord), RETURN, BUSY],
    ),
    row(
        DONE,
        sfc(11),
        "DPSYC_FR",
        &[("REQ", Input, Bool), ("LADDR", Input, Word), ("GROUP", Input, Byte), ("MODE", Input, Byte), RETURN, BUSY],
    ),
    row(
        DONE,
        sfc(12),
        "D_ACT_DP",
        &[("REQ", Input, Bool), ("MODE", Input, Byte), ("LADDR", Input, Word), RETURN, BUSY],
    ),
    row(
        System::Answer(0x8093),
        sfc(13),
        "DPNRM_DG",
        &[("REQ", Input, Bool), ("LADDR", Input, Word), RETURN, ("RECORD", Output, Any), BUSY],
    ),
    row(
        DONE,
        sfc(19),
        "ALARM_SC",
        &[("EV_ID", Input, DWord), RETURN, ("STATE", Output, Bool), ("Q_STATE", Output, Bool)],
    ),
    row(
        System::CreateBlock,
        sfc(22),
        "CREAT_DB",
        &[
            ("LOW_LIMIT", Input, Word),
            ("UP_LIMIT", Input, Word),
            ("COUNT", Input, Word),
            RETURN,
            ("DB_NUMBER", Output, Word),
        ],
    ),
    row(
        System::SetTimeOfDay,
        sfc(28),
        "SET_TINT",
        &[("OB_NR", Input, Int), ("SDT", Input, DateTime), ("PERIOD", Input, Word), RETURN],
    ),
    row(System::CancelTimeOfDay, sfc(29), "CAN_TINT", NUMBER),
    row(System::ActivateTimeOfDay, sfc(30), "ACT_TINT", NUMBER),
    row(System::QueryTimeOfDay, sfc(31), "QRY_TINT", QUERY),
    row(
        System::StartDelay,
        sfc(32),
        "SRT_DINT",
        &[("OB_NR", Input, Int), ("DTIME", Input, Time), ("SIGN", Input, Word), RETURN],
    ),
    row(System::CancelDelay, sfc(33), "CAN_DINT", NUMBER),
    row(System::QueryDelay, sfc(34), "QRY_DINT", QUERY),
    row(
        System::MaskFaults,
        sfc(36),
        "MSK_FLT",
        &[
            ("PRGFLT_SET_MASK", Input, DWord),
            ("ACCFLT_SET_MASK", Input, DWord),
            RETURN,
            ("PRGFLT_MASKED", Output, DWord),
            ("ACCFLT_MASKED", Output, DWord),
        ],
    ),
    row(
        System::UnmaskFaults,
        sfc(37),
        "DMSK_FLT",
        &[
            ("PRGFLT_RESET_MASK", Input, DWord),
            ("ACCFLT_RESET_MASK", Input, DWord),
            RETURN,
            ("PRGFLT_MASKED", Output, DWord),
            ("ACCFLT_MASKED", Output, DWord),
        ],
    ),
    row(
        System::ReadFaults,
        sfc(38),
        "READ_ERR",
        &[
            ("PRGFLT_QUERY", Input, DWord),
            ("ACCFLT_QUERY", Input, DWord),
            RETURN,
            ("PRGFLT_CLR", Output, DWord),
            ("ACCFLT_CLR", Output, DWord),
        ],
    ),
    row(System::ReplaceValue, sfc(44), "REPL_VAL", &[("VAL", Input, DWord), RETURN]),
    row(
        NO_MODULE,
        sfc(49),
        "LGC_GADR",
        &[
            ("IOID", Input, Byte),
            ("LADDR", Input, Word),
            RETURN,
            ("AREA", Output, Byte),
            ("RACK", Output, Word),
            ("SLOT", Output, Word),
            ("SUBADDR", Output, Word),
        ],
    ),
    row(
        NO_MODULE,
        sfc(50),
        "RD_LGADR",
        &[
            ("IOID", Input, Byte),
            ("LADDR", Input, Word),
            RETURN,
            ("PEADDR", Output, Any),
            ("PECOUNT", Output, Int),
            ("PAADDR", Output, Any),
            ("PACOUNT", Output, Int),
        ],
    ),
    row(
        DONE,
        sfc(52),
        "WR_USMSG",
        &[("SEND", Input, Bool), ("EVENTN", Input, Word), ("INFO1", Input, Any), ("INFO2", Input, Any), RETURN],
    ),
    row(
        NO_MODULE,
        sfc(54),
        "RD_DPARM",
        &[("LADDR", Input, Word), ("RECNUM", Input, Byte), RETURN, ("RECORD", Output, Any)],
    ),
    row(
        NO_MODULE,
        sfc(55),
        "WR_PARM",
        &[
            ("REQ", Input, Bool),
            ("IOID", Input, Byte),
            ("LADDR", Input, Word),
            ("RECNUM", Input, Byte),
            ("RECORD", Input, Any),
            RETURN,
            BUSY,
        ],
    ),
    row(
        NO_MODULE,
        sfc(56),
        "WR_DPARM",
        &[("REQ", Input, Bool), ("IOID", Input, Byte), ("LADDR", Input, Word), ("RECNUM", Input, Byte), RETURN, BUSY],
    ),
    row(
        NO_MODULE,
        sfc(57),
        "PARM_MOD",
        &[("REQ", Input, Bool), ("IOID", Input, Byte), ("LADDR", Input, Word), RETURN, BUSY],
    ),
    row(
        NO_MODULE,
        sfc(70),
        "GEO_LOG",
        &[
            ("MASTER", Input, Int),
            ("STATION", Input, Int),
            ("SLOT", Input, Int),
            ("SUBSLOT", Input, Int),
            RETURN,
            ("LADDR", Output, Word),
        ],
    ),
    row(
        NO_MODULE,
        sfc(71),
        "LOG_GEO",
        &[
            ("LADDR", Input, Word),
            RETURN,
            ("AREA", Output, Int),
            ("MASTER", Output, Int),
            ("STATION", Output, Int),
            ("SLOT", Output, Int),
            ("SUBSLOT", Output, Int),
            ("OFFSET", Output, Int),
        ],
    ),
    row(DONE, sfc(107), "ALARM_DQ", MESSAGE),
    row(DONE, sfc(108), "ALARM_D", MESSAGE),
    row(System::RealToText, None, "R_STRNG", &[("IN", Input, Real), ("RET_VAL", Output, Text)]),
    row(System::TextToReal, None, "STRNG_R", &[("S", Input, Text), ("RET_VAL", Output, Real)]),
];
