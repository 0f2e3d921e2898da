//! Rows of the table for system functions that few programs call: bits of ranges, data blocks of the load memory, 32-bit hours meters, system
//! state lists, and function blocks for modules and partners that the simulator does not have.

use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::types::Section::{InOut, Input, Output};

use super::rows::Kind::{Any, Bool, Byte, DInt, DWord, Header, Int, Pointer, Word};
use super::rows::{Parameters, RETURN, System, SystemBlock, row, sfc};

const BUSY: (&str, crate::plc::step7::text::types::Section, super::rows::Kind) = ("BUSY", Output, Bool);
const BITS: Parameters = &[("N", Input, Int), RETURN, ("SA", Output, Pointer)];
const LOAD_MEMORY: Parameters = &[("REQ", Input, Bool), ("SRCBLK", Input, Any), RETURN, BUSY, ("DSTBLK", Output, Any)];

const fn sfb(number: u16) -> Option<BlockName> {
    Some(BlockName { kind: BlockKind::Sfb, number })
}

/// There is no partner with this connection.
const NO_CONNECTION: System = System::Refuse(1);
/// There is no module with this address.
const NO_MODULE: System = System::Refuse(0xC080_9100);

pub(super) const RARE: &[SystemBlock] = &[
    row(System::DeleteBlock, sfc(23), "DEL_DB", &[("DB_NUMBER", Input, Word), RETURN]),
    row(System::Multicomputing, sfc(35), "MP_ALM", &[("JOB", Input, Byte), RETURN]),
    row(
        System::StateList,
        sfc(51),
        "RDSYSST",
        &[
            ("REQ", Input, Bool),
            ("SZL_ID", Input, Word),
            ("INDEX", Input, Word),
            RETURN,
            BUSY,
            ("SZL_HEADER", Output, Header),
            ("DR", Output, Any),
        ],
    ),
    row(System::SetBits(true), sfc(79), "SET", BITS),
    row(System::SetBits(false), sfc(80), "RSET", BITS),
    row(
        System::CreateLoaded,
        sfc(82),
        "CREA_DBL",
        &[
            ("REQ", Input, Bool),
            ("LOW_LIMIT", Input, Word),
            ("UP_LIMIT", Input, Word),
            ("COUNT", Input, Word),
            ("ATTRIB", Input, Byte),
            ("SRCBLK", Input, Any),
            RETURN,
            BUSY,
            ("DB_NUM", Output, Word),
        ],
    ),
    row(System::MoveLoaded, sfc(83), "READ_DBL", LOAD_MEMORY),
    row(System::MoveLoaded, sfc(84), "WRIT_DBL", LOAD_MEMORY),
    row(
        System::LongHours,
        sfc(101),
        "RTM",
        &[
            ("NR", Input, Byte),
            ("MODE", Input, Byte),
            ("PV", Input, DInt),
            RETURN,
            ("CQ", Output, Bool),
            ("CV", Output, DInt),
        ],
    ),
    row(
        System::Answer(0),
        sfc(105),
        "READ_SI",
        &[("MODE", Input, Int), RETURN, ("N_SYS", Output, Int), ("SYS_INST", Output, Any)],
    ),
    row(System::Answer(0), sfc(106), "DEL_SI", &[("MODE", Input, Int), ("CMP_ID", Input, DWord), RETURN]),
    row(
        NO_CONNECTION,
        sfb(8),
        "USEND",
        &[
            ("REQ", Input, Bool),
            ("ID", Input, Word),
            ("R_ID", Input, DWord),
            ("DONE", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("SD_1", InOut, Any),
            ("SD_2", InOut, Any),
            ("SD_3", InOut, Any),
            ("SD_4", InOut, Any),
        ],
    ),
    row(
        NO_CONNECTION,
        sfb(9),
        "URCV",
        &[
            ("EN_R", Input, Bool),
            ("ID", Input, Word),
            ("R_ID", Input, DWord),
            ("NDR", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("RD_1", InOut, Any),
            ("RD_2", InOut, Any),
            ("RD_3", InOut, Any),
            ("RD_4", InOut, Any),
        ],
    ),
    row(
        NO_CONNECTION,
        sfb(12),
        "BSEND",
        &[
            ("REQ", Input, Bool),
            ("R", Input, Bool),
            ("ID", Input, Word),
            ("R_ID", Input, DWord),
            ("DONE", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("SD_1", InOut, Any),
            ("LEN", InOut, Word),
        ],
    ),
    row(
        NO_CONNECTION,
        sfb(13),
        "BRCV",
        &[
            ("EN_R", Input, Bool),
            ("ID", Input, Word),
            ("R_ID", Input, DWord),
            ("NDR", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("RD_1", InOut, Any),
            ("LEN", InOut, Word),
        ],
    ),
    row(
        NO_CONNECTION,
        sfb(14),
        "GET",
        &[
            ("REQ", Input, Bool),
            ("ID", Input, Word),
            ("NDR", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("ADDR_1", InOut, Any),
            ("ADDR_2", InOut, Any),
            ("ADDR_3", InOut, Any),
            ("ADDR_4", InOut, Any),
            ("RD_1", InOut, Any),
            ("RD_2", InOut, Any),
            ("RD_3", InOut, Any),
            ("RD_4", InOut, Any),
        ],
    ),
    row(
        NO_CONNECTION,
        sfb(15),
        "PUT",
        &[
            ("REQ", Input, Bool),
            ("ID", Input, Word),
            ("DONE", Output, Bool),
            ("ERROR", Output, Bool),
            ("STATUS", Output, Word),
            ("ADDR_1", InOut, Any),
            ("ADDR_2", InOut, Any),
            ("ADDR_3", InOut, Any),
            ("ADDR_4", InOut, Any),
            ("SD_1", InOut, Any),
            ("SD_2", InOut, Any),
            ("SD_3", InOut, Any),
            ("SD_4", InOut, Any),
        ],
    ),
    row(
        NO_MODULE,
        sfb(52),
        "RDREC",
        &[
            ("REQ", Input, Bool),
            ("ID", Input, DWord),
            ("INDEX", Input, Int),
            ("MLEN", Input, Int),
            ("VALID", Output, Bool),
            BUSY,
            ("ERROR", Output, Bool),
            ("STATUS", Output, DWord),
            ("LEN", Output, Int),
            ("RECORD", InOut, Any),
        ],
    ),
    row(
        NO_MODULE,
        sfb(53),
        "WRREC",
        &[
            ("REQ", Input, Bool),
            ("ID", Input, DWord),
            ("INDEX", Input, Int),
            ("LEN", Input, Int),
            ("DONE", Output, Bool),
            BUSY,
            ("ERROR", Output, Bool),
            ("STATUS", Output, DWord),
            ("RECORD", InOut, Any),
        ],
    ),
    row(
        System::Refuse(0),
        sfb(54),
        "RALRM",
        &[
            ("MODE", Input, Int),
            ("F_ID", Input, DWord),
            ("MLEN", Input, Int),
            ("NEW", Output, Bool),
            ("STATUS", Output, DWord),
            ("ID", Output, DWord),
            ("LEN", Output, Int),
            ("TINFO", InOut, Any),
            ("AINFO", InOut, Any),
        ],
    ),
];
