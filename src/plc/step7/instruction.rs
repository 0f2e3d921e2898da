//! Instructions and their operands: what the compiler makes of statements, and the engine runs.

use std::fmt;

/// A kind of block with a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum BlockKind {
    /// Organization block.
    Ob,
    /// Function.
    Fc,
    /// Function block.
    Fb,
    /// Data block.
    Db,
    /// System function.
    Sfc,
    /// System function block.
    Sfb,
    /// Data type of the user.
    Udt,
}

impl BlockKind {
    /// The kind of a prefix such as `FC`.
    pub(in crate::plc::step7) fn parse(word: &str) -> Option<Self> {
        Some(match word.to_ascii_uppercase().as_str() {
            "OB" => Self::Ob,
            "FC" => Self::Fc,
            "FB" => Self::Fb,
            "DB" => Self::Db,
            "SFC" => Self::Sfc,
            "SFB" => Self::Sfb,
            "UDT" => Self::Udt,
            _ => return None,
        })
    }
}

/// A block by its absolute name: `FC 10`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct BlockName {
    /// The kind.
    pub kind: BlockKind,
    /// The number.
    pub number: u16,
}

impl fmt::Display for BlockName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}{}", format!("{:?}", self.kind).to_uppercase(), self.number)
    }
}

/// A part of the memory that an operand can name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Space {
    /// The peripheral area: inputs when it is read, outputs when it is written.
    Peripheral,
    Inputs,
    Outputs,
    Flags,
    /// The open data block.
    Data,
    /// The open instance data block.
    Instance,
    /// The local data of the block.
    Local,
    /// The local data of the caller.
    Caller,
}

/// The width of an access.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Width {
    Bit,
    Byte,
    Word,
    Double,
}

impl Width {
    pub(in crate::plc::step7) const fn bits(self) -> u32 {
        match self {
            Self::Bit => 1,
            Self::Byte => 8,
            Self::Word => 16,
            Self::Double => 32,
        }
    }
}

/// An operand; addresses count bits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum Operand {
    /// `M 10.0`, `DBW 2`, `LD 4`.
    Direct(Space, u32),
    /// `DB10.DBW 2`: opens the DB.
    Block(u16, u32),
    /// A byte of a DB that is not opened: the instance of a call.
    Fixed(u16, u32),
    /// A variable of an FB: DI, from AR2 on.
    Own(u32),
    /// `M [MD 10]`: the area, and the place of the pointer.
    Indirect(Space, Space, u32),
    /// `M [AR1,P#2.0]`; without an area in the operation, `None`.
    Register(Option<Space>, Register, u32),
    /// An elementary parameter of an FC.
    Parameter(u16),
    /// A part of a parameter of an FC that is passed by pointer.
    Element(u16, u32),
    /// A part of an in-out parameter of an FB that is passed by pointer: the place of the pointer in the instance, and the distance.
    Through(u32, u32),
}

/// One of the address registers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Register {
    Ar1,
    Ar2,
}

/// The number of a timer, a counter or a block.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum Number {
    Direct(u16),
    /// `T [MW 2]`.
    At(Space, u32),
    /// A parameter of an FC.
    Parameter(u16),
    /// A parameter of an FB.
    Own(u32),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Logic {
    And,
    AndNot,
    Or,
    OrNot,
    Xor,
    XorNot,
}

/// A status bit as an operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum StatusBit {
    Zero,
    NotZero,
    Positive,
    Negative,
    NotNegative,
    NotPositive,
    Unordered,
    Overflow,
    StoredOverflow,
    BinaryResult,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Relation {
    Equal,
    NotEqual,
    Greater,
    Less,
    GreaterEqual,
    LessEqual,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Numeric {
    Int,
    Double,
    Real,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Arithmetic {
    Add,
    Subtract,
    Multiply,
    Divide,
    Modulo,
}

/// An operation on ACCU1 alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Convert {
    NegateInt,
    NegateDouble,
    InvertInt,
    InvertDouble,
    Absolute,
    NegateReal,
    Square,
    SquareRoot,
    Exponential,
    Logarithm,
    Sine,
    Cosine,
    Tangent,
    ArcSine,
    ArcCosine,
    ArcTangent,
    BcdToInt,
    BcdToDouble,
    IntToBcd,
    DoubleToBcd,
    IntToDouble,
    DoubleToReal,
    Round,
    RoundUp,
    RoundDown,
    Truncate,
    SwapWord,
    SwapDouble,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum WordLogic {
    And,
    Or,
    Xor,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Shift {
    LeftWord,
    RightWord,
    LeftDouble,
    RightDouble,
    SignedWord,
    SignedDouble,
    RotateLeft,
    RotateRight,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Accumulators {
    Swap,
    Push,
    Pop,
    Enter,
    Leave,
    RotateLeftThroughCc1,
    RotateRightThroughCc1,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Jump {
    Always,
    IfRlo,
    IfNotRlo,
    IfRloWithBr,
    IfNotRloWithBr,
    IfBr,
    IfNotBr,
    IfOverflow,
    IfStoredOverflow,
    IfZero,
    IfNotZero,
    IfPositive,
    IfNegative,
    IfNotNegative,
    IfNotPositive,
    IfUnordered,
    Loop,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum TimerKind {
    Pulse,
    ExtendedPulse,
    OnDelay,
    StoredOnDelay,
    OffDelay,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Mcr {
    Activate,
    Deactivate,
    Open,
    Close,
}

/// What `L DBLG` and similar operations load.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum DataRegister {
    DbLength,
    DbNumber,
    DiLength,
    DiNumber,
}

/// When a plain call or the end of a block takes place.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Condition {
    Always,
    IfRlo,
}

/// What a call does with the registers of the data blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Instance {
    /// A function: nothing.
    None,
    /// An instance DB: it becomes DI, AR2 is its beginning.
    Block(u16),
    /// A multi-instance: AR2 moves to its bit address.
    Within(u32),
}

/// What is called.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Target {
    /// The index of a block of the program.
    Block(u16),
    /// The index of a system function.
    System(u16),
    /// A block that is nowhere; the plan says that it is left out.
    Nothing,
}

/// A call with parameters; those that are copied are copied by instructions around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) struct CallSite {
    pub(in crate::plc::step7) target: Target,
    pub(in crate::plc::step7) instance: Instance,
    /// The parameters of a function in the table of the program: the first and the number.
    pub(in crate::plc::step7) first: u32,
    pub(in crate::plc::step7) count: u16,
}

/// A parameter of a function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum ParameterSource {
    /// A reference to the operand itself, or to its copy in the local data.
    Reference(Operand),
    /// A timer, a counter or a block.
    Number(Number),
}

/// What is copied before or after a call.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum CopySource {
    Operand(Operand),
    Constant(u32),
    Number(Number),
}

/// Copies a number of bits; 1, or whole bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) struct Copy {
    pub(in crate::plc::step7) from: CopySource,
    pub(in crate::plc::step7) to: Operand,
    pub(in crate::plc::step7) bits: u32,
}

/// To what a pointer points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum Pointed {
    /// A known place: the number of the DB, or 0, and the area-crossing pointer.
    Constant(u16, u32),
    /// Local data of the caller.
    Local(u32),
    /// A variable of the FB that calls.
    Own(u32),
    /// An elementary parameter of the function that calls.
    Parameter(u16),
    /// A part of a parameter of the function that calls.
    Element(u16, u32),
    /// A part of an in-out parameter of the FB that calls.
    Through(u32, u32),
}

/// Writes a POINTER of 6 bytes, or an ANY of 10 bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) struct MakePointer {
    pub(in crate::plc::step7) to: Operand,
    pub(in crate::plc::step7) pointed: Pointed,
    /// The code of the type and the count, for ANY.
    pub(in crate::plc::step7) any: Option<(u8, u16)>,
}

/// One instruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum Op {
    Nothing,
    Logic(Logic, Operand),
    LogicTimer(Logic, Number),
    LogicCounter(Logic, Number),
    LogicStatus(Logic, StatusBit),
    OrBeforeAnd,
    OpenNest(Logic),
    CloseNest,
    Assign(Operand),
    Set(Operand),
    Reset(Operand),
    Not,
    SetRlo(bool),
    Save,
    Edge(bool, Operand),
    Compare(Relation, Numeric),
    Arithmetic(Arithmetic, Numeric),
    AddWord(u16),
    AddDouble(u32),
    Convert(Convert),
    WordLogic(WordLogic, Width),
    WordLogicConstant(WordLogic, Width, u32),
    Shift(Shift),
    ShiftBy(Shift, u8),
    Load(Width, Operand),
    LoadConstant(u32),
    LoadStatus,
    LoadData(DataRegister),
    LoadTimer(bool, Number),
    LoadCounter(bool, Number),
    /// `L P##parameter` in a function.
    LoadParameterAddress(u16),
    Transfer(Width, Operand),
    TransferStatus,
    Accumulators(Accumulators),
    Increment(u8),
    Decrement(u8),
    /// The register from ACCU1.
    RegisterFromAccu(Register),
    RegisterFromConstant(Register, u32),
    RegisterFromOperand(Register, Operand),
    RegisterFromParameterAddress(Register, u16),
    /// AR1 from AR2.
    RegisterFromOther,
    AccuFromRegister(Register),
    OperandFromRegister(Register, Operand),
    /// AR2 from AR1.
    OtherFromRegister,
    SwapRegisters,
    AddRegister(Register),
    AddRegisterConstant(Register, u32),
    OpenDb(Number),
    OpenDi(Number),
    SwapDb,
    Jump(Jump, u32),
    /// The number of jumps that follow, and where to go if ACCU1 picks none of them.
    JumpList(u16, u32),
    End(Condition),
    Mcr(Mcr),
    StartTimer(TimerKind, Number),
    FreeTimer(Number),
    ResetTimer(Number),
    CountUp(Number),
    CountDown(Number),
    SetCounter(Number),
    ResetCounter(Number),
    FreeCounter(Number),
    /// An index of the copies of the program.
    Copy(u32),
    /// An index of the pointers of the program.
    Pointer(u32),
    /// An index of the calls of the program.
    Call(u32),
    /// `UC`, `CC`.
    CallPlain(Condition, Target),
    /// `UC FC [MW 2]`.
    CallNumber(Condition, BlockKind, Number),
}

/// Where an instruction comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(in crate::plc::step7) struct Line {
    pub(in crate::plc::step7) file: u16,
    pub(in crate::plc::step7) network: u16,
    pub(in crate::plc::step7) line: u32,
    pub(in crate::plc::step7) statement: u32,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_instruction_has_sixteen_bytes() {
        assert!(size_of::<Op>() <= 16, "{}", size_of::<Op>());
    }
}
