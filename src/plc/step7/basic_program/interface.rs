//! The blocks of the basic program that are built in: numbers, names, parameters with their types and defaults (P-131).

use std::sync::{Arc, LazyLock};

use crate::plc::MessageLayout;
use crate::plc::step7::instruction::{BlockKind, BlockName};
use crate::plc::step7::text::types::{Array, Layout, Section, Type};

/// A block of the basic program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Basic {
    RunUp,
    General,
    Interrupt,
    Diagnosis,
    Messages,
    SpinCtrl,
    Panel,
    TurningPanel,
    Get,
    Put,
    Service,
    Interrupts,
    PositionAxis,
    IndexAxis,
    Transfer,
    Revolver,
    Direction,
}

impl Basic {
    /// Whether it writes signals to the NCK.
    pub(super) fn writes_to_the_nck(self) -> bool {
        match self {
            Self::General
            | Self::Messages
            | Self::SpinCtrl
            | Self::Panel
            | Self::TurningPanel
            | Self::PositionAxis
            | Self::IndexAxis => true,
            Self::RunUp
            | Self::Interrupt
            | Self::Diagnosis
            | Self::Get
            | Self::Put
            | Self::Service
            | Self::Interrupts
            | Self::Transfer
            | Self::Revolver
            | Self::Direction => false,
        }
    }
}

/// A row of the table.
pub(in crate::plc::step7) struct BasicBlock {
    pub(super) basic: Basic,
    pub(in crate::plc::step7) block: BlockName,
    pub(in crate::plc::step7) name: &'static str,
    /// Its parameters, and for a function block its instance.
    pub(in crate::plc::step7) layout: Layout,
}

impl BasicBlock {
    /// The data blocks that it needs, with their lengths.
    pub(in crate::plc::step7) fn data_blocks(&self) -> impl Iterator<Item = (u16, usize)> {
        let needed: &[(u16, usize)] = match self.basic {
            Basic::RunUp => &[(20, MACHINE_DATA_BYTES)],
            Basic::Messages => &[(2, MessageLayout::LONGEST)],
            Basic::Interrupts => &[(19, 256)],
            Basic::Transfer | Basic::Revolver => &[(71, 256), (72, 256), (73, 256)],
            Basic::Direction => &[(74, 256)],
            Basic::Panel | Basic::TurningPanel => &[(19, 256)],
            _ => &[],
        };
        needed.iter().copied()
    }
}

/// DB20 with 256 integers, 256 bytes and 32 REALs.
const MACHINE_DATA_BYTES: usize = 256 * 2 + 256 + 32 * 4;

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Bool,
    Byte,
    Word,
    Int,
    Real,
    S5Time,
    Pointer,
    /// ARRAY [1 .. n] OF BOOL.
    Bools(i32),
}

use Kind::{Bool, Bools, Byte, Int, Pointer, Real, S5Time, Word};
use Section::{InOut, Input, Output, Static};

/// A parameter: its name, section, type and default.
type Parameter = (&'static str, Section, Kind, u16);

/// An input without a default.
const fn input(name: &'static str, kind: Kind) -> Parameter {
    (name, Input, kind, 0)
}

const fn default(name: &'static str, kind: Kind, value: u16) -> Parameter {
    (name, Input, kind, value)
}

const fn output(name: &'static str, kind: Kind) -> Parameter {
    (name, Output, kind, 0)
}

/// FB1. S5TIME: base in the bits 12 and 13, then BCD: 700 ms is 0070h, 200 ms 0020h, and 50 s in tenths of a second 1500h.
const RUN_UP: &[Parameter] = &[
    default("MCPNum", Int, 1),
    input("MCP1In", Pointer),
    input("MCP1Out", Pointer),
    input("MCP1StatSend", Pointer),
    input("MCP1StatRec", Pointer),
    default("MCP1BusAdr", Int, 6),
    default("MCP1Timeout", S5Time, 0x0070),
    default("MCP1Cycl", S5Time, 0x0020),
    input("MCP2In", Pointer),
    input("MCP2Out", Pointer),
    input("MCP2StatSend", Pointer),
    input("MCP2StatRec", Pointer),
    input("MCP2BusAdr", Int),
    default("MCP2Timeout", S5Time, 0x0070),
    default("MCP2Cycl", S5Time, 0x0020),
    input("MCPMPI", Bool),
    input("MCP1Stop", Bool),
    input("MCP2Stop", Bool),
    input("MCP1NotSend", Bool),
    input("MCP2NotSend", Bool),
    input("MCPSDB210", Bool),
    input("MCPCopyDB77", Bool),
    input("MCPBusType", Byte),
    input("HHU", Int),
    input("BHGIn", Pointer),
    input("BHGOut", Pointer),
    input("BHGStatSend", Pointer),
    input("BHGStatRec", Pointer),
    default("BHGInLen", Byte, 6),
    default("BHGOutLen", Byte, 20),
    default("BHGTimeout", S5Time, 0x0070),
    default("BHGCycl", S5Time, 0x0010),
    default("BHGRecGDNo", Int, 2),
    default("BHGRecGBZNo", Int, 2),
    default("BHGRecObjNo", Int, 1),
    default("BHGSendGDNo", Int, 2),
    default("BHGSendGBZNo", Int, 1),
    default("BHGSendObjNo", Int, 1),
    input("BHGMPI", Bool),
    input("BHGStop", Bool),
    input("BHGNotSend", Bool),
    default("NCCyclTimeout", S5Time, 0x0020),
    default("NCRunupTimeout", S5Time, 0x1500),
    input("ListMDecGrp", Int),
    input("NCKomm", Bool),
    default("MMCToIF", Bool, 1),
    default("HWheelMMC", Bool, 1),
    input("ExtendAlMsg", Bool),
    default("MsgUser", Int, 10),
    input("UserIR", Bool),
    input("IRAuxfuT", Bool),
    input("IRAuxfuH", Bool),
    input("IRAuxfuE", Bool),
    input("UserVersion", Pointer),
    input("OpKeyNum", Int),
    input("Op1KeyIn", Pointer),
    input("Op1KeyOut", Pointer),
    input("Op1KeyBusAdr", Int),
    input("Op2KeyIn", Pointer),
    input("Op2KeyOut", Pointer),
    input("Op2KeyBusAdr", Int),
    input("Op1KeyStop", Bool),
    input("Op2KeyStop", Bool),
    input("Op1KeyNotSend", Bool),
    input("Op2KeyNotSend", Bool),
    input("OpKeyBusType", Byte),
    input("IdentMcpBusAdr", Int),
    input("IdentMcpProfilNo", Byte),
    input("IdentMcpBusType", Byte),
    input("IdentMcpStrobe", Bool),
    output("MaxBAG", Int),
    output("MaxChan", Int),
    output("MaxAxis", Int),
    output("ActivChan", Bools(10)),
    output("ActivAxis", Bools(31)),
    output("UDInt", Int),
    output("UDHex", Int),
    output("UDReal", Int),
    output("IdentMcpType", Byte),
    output("IdentMcpLengthIn", Byte),
    output("IdentMcpLengthOut", Byte),
];

const SPIN_CTRL: &[Parameter] = &[
    input("Start", Bool),
    input("Stop", Bool),
    input("Funct", Byte),
    input("Mode", Byte),
    input("AxisNo", Int),
    input("Pos", Real),
    input("FRate", Real),
    output("InPos", Bool),
    output("Error", Bool),
    output("State", Byte),
];

const PANEL: &[Parameter] = &[
    input("BAGNo", Byte),
    input("ChanNo", Byte),
    input("SpindleIFNo", Byte),
    output("FeedHold", Bool),
    output("SpindleHold", Bool),
];

const TRANSFER: &[Parameter] = &[
    input("Start", Bool),
    input("TaskIdent", Byte),
    input("TaskIdentNo", Byte),
    input("NewToolMag", Int),
    input("NewToolLoc", Int),
    input("OldToolMag", Int),
    input("OldToolLoc", Int),
    input("Status", Int),
    output("Ready", Bool),
    output("Error", Int),
];

const REVOLVER: &[Parameter] =
    &[input("Start", Bool), input("ChgdRevNo", Byte), output("Ready", Bool), output("Error", Int)];

const DIRECTION: &[Parameter] = &[
    input("MagNo", Int),
    input("ReqPos", Int),
    input("ActPos", Int),
    input("Offset", Byte),
    input("Start", Bool),
    output("Cw", Bool),
    output("Ccw", Bool),
    output("InPos", Bool),
    output("Diff", Int),
    output("Error", Bool),
];

const INTERRUPTS: &[Parameter] = &[
    input("Start", Bool),
    input("ChanNo", Int),
    input("IntNo", Int),
    output("Active", Bool),
    output("Done", Bool),
    output("Error", Bool),
    output("StartErr", Bool),
    ("Ref", InOut, Word, 0),
];

const POSITION_AXIS: &[Parameter] = &[
    input("Start", Bool),
    input("AxisNo", Byte),
    input("IC", Bool),
    input("Inch", Bool),
    input("HWheelOv", Bool),
    input("Pos", Real),
    input("FRate", Real),
    output("InPos", Bool),
    output("Activ", Bool),
    output("StartErr", Bool),
    output("Error", Bool),
];

const INDEX_AXIS: &[Parameter] = &[
    input("Start", Bool),
    input("AxisNo", Byte),
    input("IC", Bool),
    input("DC", Bool),
    input("Minus", Bool),
    input("Plus", Bool),
    input("Pos", Int),
    input("FRate", Real),
    output("InPos", Bool),
    output("Activ", Bool),
    output("StartErr", Bool),
    output("Error", Bool),
];

/// All blocks: what it is, its number, its name, its parameters.
const ROWS: &[(Basic, BlockKind, u16, &str, &[Parameter])] = &[
    (Basic::RunUp, BlockKind::Fb, 1, "RUN_UP", RUN_UP),
    (Basic::Get, BlockKind::Fb, 2, "GET", &[]),
    (Basic::Put, BlockKind::Fb, 3, "PUT", &[]),
    (Basic::Service, BlockKind::Fb, 4, "PI_SERV", &[]),
    (Basic::General, BlockKind::Fc, 2, "GP_HP", &[]),
    (Basic::Interrupt, BlockKind::Fc, 3, "GP_PRAL", &[]),
    (Basic::Diagnosis, BlockKind::Fc, 5, "GP_DIAG", &[input("PlcStop", Bool)]),
    (Basic::Transfer, BlockKind::Fc, 6, "TM_TRANS2", TRANSFER),
    (Basic::Revolver, BlockKind::Fc, 7, "TM_REV", REVOLVER),
    (Basic::Transfer, BlockKind::Fc, 8, "TM_TRANS", TRANSFER),
    (Basic::Interrupts, BlockKind::Fc, 9, "ASUP", INTERRUPTS),
    (Basic::Messages, BlockKind::Fc, 10, "AL_MSG", &[input("ToUserIF", Bool), input("Quit", Bool)]),
    (Basic::PositionAxis, BlockKind::Fc, 15, "POS_AX", POSITION_AXIS),
    (Basic::IndexAxis, BlockKind::Fc, 16, "PART_AX", INDEX_AXIS),
    (Basic::SpinCtrl, BlockKind::Fc, 18, "SpinCtrl", SPIN_CTRL),
    (Basic::Panel, BlockKind::Fc, 19, "MCP_IFM", PANEL),
    (Basic::Direction, BlockKind::Fc, 22, "TM_DIR", DIRECTION),
    (Basic::Panel, BlockKind::Fc, 24, "MCP_IFM2", PANEL),
    (Basic::TurningPanel, BlockKind::Fc, 25, "MCP_IFT", PANEL),
];

/// The blocks with their layouts.
pub(in crate::plc::step7) static BLOCKS: LazyLock<Vec<BasicBlock>> = LazyLock::new(|| {
    let block = |&(basic, kind, number, name, parameters): &(_, _, _, _, &[Parameter])| BasicBlock {
        basic,
        block: BlockName { kind, number },
        name,
        layout: match basic {
            Basic::Get => variables_layout("NDR", "RD"),
            Basic::Put => variables_layout("Done", "SD"),
            Basic::Service => service_layout(),
            _ => layout(parameters),
        },
    };
    ROWS.iter().map(block).collect()
});

fn layout(parameters: &[Parameter]) -> Layout {
    let mut layout = Layout::default();
    for &(name, section, kind, value) in parameters {
        // The rows of the table are small, so they fit.
        let bit = layout.add(name, kind.ty(), section).unwrap_or(0);
        let byte = (bit / 8) as usize;
        match kind {
            Bool if value != 0 => layout.image[byte] |= 1 << (bit % 8),
            Byte => layout.image[byte] = value.to_be_bytes()[1],
            Int | Word | S5Time => layout.image[byte..byte + 2].copy_from_slice(&value.to_be_bytes()),
            Bool | Real | Pointer | Bools(_) => {}
        }
    }
    layout
}

/// The instance of FB2 or FB3: eight variables, each with its address, and its data as an in-out parameter.
fn variables_layout(done: &str, data: &str) -> Layout {
    let mut layout = Layout::default();
    layout.add("Req", Type::Bool, Input);
    layout.add("NumVar", Type::Int, Input);
    for number in 1..=8 {
        layout.add(&format!("Addr{number}"), Type::Any, Input);
        layout.add(&format!("Unit{number}"), Type::Byte, Input);
        layout.add(&format!("Column{number}"), Type::Word, Input);
        layout.add(&format!("Line{number}"), Type::Word, Input);
    }
    layout.add("Error", Type::Bool, Output);
    layout.add(done, Type::Bool, Output);
    layout.add("State", Type::Word, Output);
    for number in 1..=8 {
        layout.add(&format!("{data}{number}"), Type::Any, InOut);
    }
    add_job(&mut layout);
    layout
}

/// The instance of FB4.
fn service_layout() -> Layout {
    let mut layout = Layout::default();
    layout.add("Req", Type::Bool, Input);
    layout.add("PIService", Type::Any, Input);
    layout.add("Unit", Type::Int, Input);
    for number in 1..=4 {
        layout.add(&format!("Addr{number}"), Type::Any, Input);
    }
    for number in 1..=10 {
        layout.add(&format!("WVar{number}"), Type::Word, Input);
    }
    layout.add("Error", Type::Bool, Output);
    layout.add("Done", Type::Bool, Output);
    layout.add("State", Type::Word, Output);
    add_job(&mut layout);
    layout
}

/// DB16: the names of the services of FB4.
pub(in crate::plc::step7) const SERVICE_BLOCK: u16 = 16;

/// The services that DB16 names.
const SERVICES: &[&str] = &[
    "LOGIN", "LOGOUT", "SELECT", "CANCEL", "DIGION", "DIGIOF", "FINDBL", "ASUB", "CONFIG", "SETUDT", "SETUFR", "NCRES",
    "CREACE", "CREATO", "DELECE", "DELETO", "MMCSEM", "TMCRTO", "TMFDPL", "TMFPBP", "TMGETT", "TMMVTL", "TMPOSM",
    "TMPCIT", "TMRASS", "TRESMO", "TSEARC",
];

/// The variables of DB16: a STRING [8] with the name of each service (P-137).
pub(in crate::plc::step7) fn service_names() -> Layout {
    let mut layout = Layout::default();
    for name in SERVICES {
        let at = (layout.add(name, Type::Text(8), Static).unwrap_or(0) / 8) as usize;
        layout.image[at] = 8;
        layout.image[at + 1] = u8::try_from(name.len()).unwrap_or(0);
        layout.image[at + 2..at + 2 + name.len()].copy_from_slice(name.as_bytes());
    }
    layout
}

/// Whether a block is FB4.
pub(in crate::plc::step7) fn is_service(index: usize) -> bool {
    BLOCKS.get(index).is_some_and(|block| block.basic == Basic::Service)
}

/// What a job remembers; ours.
fn add_job(layout: &mut Layout) {
    layout.add("ReqBefore", Type::Bool, Static);
    layout.add("Phase", Type::Byte, Static);
    layout.add("Since", Type::Word, Static);
    layout.add("Result", Type::Word, Static);
}

impl Kind {
    fn ty(self) -> Type {
        match self {
            Self::Bool => Type::Bool,
            Self::Byte => Type::Byte,
            Self::Word => Type::Word,
            Self::Int => Type::Int,
            Self::Real => Type::Real,
            Self::S5Time => Type::S5Time,
            Self::Pointer => Type::Pointer,
            Self::Bools(count) => Type::Array(Arc::new(Array { ranges: vec![(1, count)], element: Type::Bool })),
        }
    }
}

/// The index of a block by its number.
pub(in crate::plc::step7) fn by_number(block: BlockName) -> Option<usize> {
    BLOCKS.iter().position(|row| row.block == block)
}

/// The index of a block of this kind by its name.
pub(in crate::plc::step7) fn by_name(kind: BlockKind, name: &str) -> Option<usize> {
    BLOCKS.iter().position(|row| row.block.kind == kind && row.name.eq_ignore_ascii_case(name))
}

/// The IEC functions with the numbers of functions of the basic program, by their names in the library.
const IEC: &[(u16, &str)] = &[
    (2, "CONCAT"),
    (3, "D_TOD_DT"),
    (5, "DI_STRNG"),
    (6, "DT_DATE"),
    (7, "DT_DAY"),
    (8, "DT_TOD"),
    (9, "EQ_DT"),
    (10, "EQ_STRNG"),
    (15, "GT_STRNG"),
    (16, "I_STRNG"),
    (18, "LE_DT"),
    (19, "LE_STRNG"),
    (22, "LIMIT"),
    (24, "LT_STRNG"),
    (25, "MAX"),
];

/// The IEC function that has the number of a function of the basic program.
pub(in crate::plc::step7) fn iec_name(number: u16) -> Option<&'static str> {
    IEC.iter().find(|(known, _)| *known == number).map(|(_, name)| *name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// P-131: FB1 begins with MCPNum (2 bytes), then four pointers of 6 bytes each, then MCP1BusAdr.
    #[test]
    fn the_instance_of_fb1_has_its_defaults() {
        let block = &BLOCKS[by_number(BlockName { kind: BlockKind::Fb, number: 1 }).unwrap()];
        let word = |name: &str| {
            let at = (block.layout.field(name).unwrap().bit / 8) as usize;
            u16::from_be_bytes([block.layout.image[at], block.layout.image[at + 1]])
        };
        assert_eq!((word("MCPNum"), word("MCP1BusAdr"), word("MsgUser")), (1, 6, 10));
        assert_eq!(block.layout.field("MCP1BusAdr").unwrap().bit / 8, 2 + 4 * 6);
        // 50 s are 500 tenths: base 1.
        assert_eq!(word("NCRunupTimeout"), 0x1500);
        let wheel = block.layout.field("HWheelMMC").unwrap().bit;
        assert_eq!(block.layout.image[(wheel / 8) as usize] >> (wheel % 8) & 1, 1);
    }
}
