//! The operations in both languages.

use std::collections::BTreeMap;
use std::sync::LazyLock;

use crate::plc::step7::instruction::{
    Accumulators, Arithmetic, Condition, Convert, Jump, Logic, Mcr, Numeric, Register, Relation, Shift, TimerKind,
    WordLogic,
};

/// What a statement does, before its operand is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) enum Operation {
    Logic(Logic),
    Open(Logic),
    Close,
    Assign,
    Set,
    Reset,
    Not,
    SetRlo(bool),
    Save,
    Edge(bool),
    Compare(Relation, Numeric),
    Arithmetic(Arithmetic, Numeric),
    AddConstant,
    Convert(Convert),
    WordLogic(WordLogic, bool),
    Shift(Shift),
    Load,
    LoadBcd,
    Transfer,
    Accumulators(Accumulators),
    Increment,
    Decrement,
    LoadRegister(Register),
    TransferRegister(Register),
    SwapRegisters,
    AddRegister(Register),
    OpenData,
    SwapDb,
    Jump(Jump),
    JumpList,
    End(Condition),
    Call,
    PlainCall(Condition),
    Mcr(Mcr),
    Timer(TimerKind),
    Free,
    CountUp,
    CountDown,
    Nothing,
}

/// The language of the operations of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// `A`, `JU`, `OPN`.
    International,
    /// `U`, `SPA`, `AUF`.
    German,
}

/// International, German, meaning.
const OPERATIONS: &[(&str, &str, Operation)] = &[
    ("A", "U", Operation::Logic(Logic::And)),
    ("AN", "UN", Operation::Logic(Logic::AndNot)),
    ("O", "O", Operation::Logic(Logic::Or)),
    ("ON", "ON", Operation::Logic(Logic::OrNot)),
    ("X", "X", Operation::Logic(Logic::Xor)),
    ("XN", "XN", Operation::Logic(Logic::XorNot)),
    ("A(", "U(", Operation::Open(Logic::And)),
    ("AN(", "UN(", Operation::Open(Logic::AndNot)),
    ("O(", "O(", Operation::Open(Logic::Or)),
    ("ON(", "ON(", Operation::Open(Logic::OrNot)),
    ("X(", "X(", Operation::Open(Logic::Xor)),
    ("XN(", "XN(", Operation::Open(Logic::XorNot)),
    (")", ")", Operation::Close),
    ("=", "=", Operation::Assign),
    ("S", "S", Operation::Set),
    ("R", "R", Operation::Reset),
    ("NOT", "NOT", Operation::Not),
    ("SET", "SET", Operation::SetRlo(true)),
    ("CLR", "CLR", Operation::SetRlo(false)),
    ("SAVE", "SAVE", Operation::Save),
    ("FP", "FP", Operation::Edge(true)),
    ("FN", "FN", Operation::Edge(false)),
    ("==I", "==I", Operation::Compare(Relation::Equal, Numeric::Int)),
    ("<>I", "<>I", Operation::Compare(Relation::NotEqual, Numeric::Int)),
    (">I", ">I", Operation::Compare(Relation::Greater, Numeric::Int)),
    ("<I", "<I", Operation::Compare(Relation::Less, Numeric::Int)),
    (">=I", ">=I", Operation::Compare(Relation::GreaterEqual, Numeric::Int)),
    ("<=I", "<=I", Operation::Compare(Relation::LessEqual, Numeric::Int)),
    ("==D", "==D", Operation::Compare(Relation::Equal, Numeric::Double)),
    ("<>D", "<>D", Operation::Compare(Relation::NotEqual, Numeric::Double)),
    (">D", ">D", Operation::Compare(Relation::Greater, Numeric::Double)),
    ("<D", "<D", Operation::Compare(Relation::Less, Numeric::Double)),
    (">=D", ">=D", Operation::Compare(Relation::GreaterEqual, Numeric::Double)),
    ("<=D", "<=D", Operation::Compare(Relation::LessEqual, Numeric::Double)),
    ("==R", "==R", Operation::Compare(Relation::Equal, Numeric::Real)),
    ("<>R", "<>R", Operation::Compare(Relation::NotEqual, Numeric::Real)),
    (">R", ">R", Operation::Compare(Relation::Greater, Numeric::Real)),
    ("<R", "<R", Operation::Compare(Relation::Less, Numeric::Real)),
    (">=R", ">=R", Operation::Compare(Relation::GreaterEqual, Numeric::Real)),
    ("<=R", "<=R", Operation::Compare(Relation::LessEqual, Numeric::Real)),
    ("+I", "+I", Operation::Arithmetic(Arithmetic::Add, Numeric::Int)),
    ("-I", "-I", Operation::Arithmetic(Arithmetic::Subtract, Numeric::Int)),
    ("*I", "*I", Operation::Arithmetic(Arithmetic::Multiply, Numeric::Int)),
    ("/I", "/I", Operation::Arithmetic(Arithmetic::Divide, Numeric::Int)),
    ("+D", "+D", Operation::Arithmetic(Arithmetic::Add, Numeric::Double)),
    ("-D", "-D", Operation::Arithmetic(Arithmetic::Subtract, Numeric::Double)),
    ("*D", "*D", Operation::Arithmetic(Arithmetic::Multiply, Numeric::Double)),
    ("/D", "/D", Operation::Arithmetic(Arithmetic::Divide, Numeric::Double)),
    ("MOD", "MOD", Operation::Arithmetic(Arithmetic::Modulo, Numeric::Double)),
    ("+R", "+R", Operation::Arithmetic(Arithmetic::Add, Numeric::Real)),
    ("-R", "-R", Operation::Arithmetic(Arithmetic::Subtract, Numeric::Real)),
    ("*R", "*R", Operation::Arithmetic(Arithmetic::Multiply, Numeric::Real)),
    ("/R", "/R", Operation::Arithmetic(Arithmetic::Divide, Numeric::Real)),
    ("+", "+", Operation::AddConstant),
    ("NEGI", "NEGI", Operation::Convert(Convert::NegateInt)),
    ("NEGD", "NEGD", Operation::Convert(Convert::NegateDouble)),
    ("INVI", "INVI", Operation::Convert(Convert::InvertInt)),
    ("INVD", "INVD", Operation::Convert(Convert::InvertDouble)),
    ("ABS", "ABS", Operation::Convert(Convert::Absolute)),
    ("NEGR", "NEGR", Operation::Convert(Convert::NegateReal)),
    ("SQR", "SQR", Operation::Convert(Convert::Square)),
    ("SQRT", "SQRT", Operation::Convert(Convert::SquareRoot)),
    ("EXP", "EXP", Operation::Convert(Convert::Exponential)),
    ("LN", "LN", Operation::Convert(Convert::Logarithm)),
    ("SIN", "SIN", Operation::Convert(Convert::Sine)),
    ("COS", "COS", Operation::Convert(Convert::Cosine)),
    ("TAN", "TAN", Operation::Convert(Convert::Tangent)),
    ("ASIN", "ASIN", Operation::Convert(Convert::ArcSine)),
    ("ACOS", "ACOS", Operation::Convert(Convert::ArcCosine)),
    ("ATAN", "ATAN", Operation::Convert(Convert::ArcTangent)),
    ("BTI", "BTI", Operation::Convert(Convert::BcdToInt)),
    ("BTD", "BTD", Operation::Convert(Convert::BcdToDouble)),
    ("ITB", "ITB", Operation::Convert(Convert::IntToBcd)),
    ("DTB", "DTB", Operation::Convert(Convert::DoubleToBcd)),
    ("ITD", "ITD", Operation::Convert(Convert::IntToDouble)),
    ("DTR", "DTR", Operation::Convert(Convert::DoubleToReal)),
    ("RND", "RND", Operation::Convert(Convert::Round)),
    ("RND+", "RND+", Operation::Convert(Convert::RoundUp)),
    ("RND-", "RND-", Operation::Convert(Convert::RoundDown)),
    ("TRUNC", "TRUNC", Operation::Convert(Convert::Truncate)),
    ("CAW", "TAW", Operation::Convert(Convert::SwapWord)),
    ("CAD", "TAD", Operation::Convert(Convert::SwapDouble)),
    ("AW", "UW", Operation::WordLogic(WordLogic::And, false)),
    ("OW", "OW", Operation::WordLogic(WordLogic::Or, false)),
    ("XOW", "XOW", Operation::WordLogic(WordLogic::Xor, false)),
    ("AD", "UD", Operation::WordLogic(WordLogic::And, true)),
    ("OD", "OD", Operation::WordLogic(WordLogic::Or, true)),
    ("XOD", "XOD", Operation::WordLogic(WordLogic::Xor, true)),
    ("SLW", "SLW", Operation::Shift(Shift::LeftWord)),
    ("SRW", "SRW", Operation::Shift(Shift::RightWord)),
    ("SLD", "SLD", Operation::Shift(Shift::LeftDouble)),
    ("SRD", "SRD", Operation::Shift(Shift::RightDouble)),
    ("SSI", "SSI", Operation::Shift(Shift::SignedWord)),
    ("SSD", "SSD", Operation::Shift(Shift::SignedDouble)),
    ("RLD", "RLD", Operation::Shift(Shift::RotateLeft)),
    ("RRD", "RRD", Operation::Shift(Shift::RotateRight)),
    ("RLDA", "RLDA", Operation::Accumulators(Accumulators::RotateLeftThroughCc1)),
    ("RRDA", "RRDA", Operation::Accumulators(Accumulators::RotateRightThroughCc1)),
    ("L", "L", Operation::Load),
    ("LC", "LC", Operation::LoadBcd),
    ("T", "T", Operation::Transfer),
    ("TAK", "TAK", Operation::Accumulators(Accumulators::Swap)),
    ("PUSH", "PUSH", Operation::Accumulators(Accumulators::Push)),
    ("POP", "POP", Operation::Accumulators(Accumulators::Pop)),
    ("ENT", "ENT", Operation::Accumulators(Accumulators::Enter)),
    ("LEAVE", "LEAVE", Operation::Accumulators(Accumulators::Leave)),
    ("INC", "INC", Operation::Increment),
    ("DEC", "DEC", Operation::Decrement),
    ("LAR1", "LAR1", Operation::LoadRegister(Register::Ar1)),
    ("LAR2", "LAR2", Operation::LoadRegister(Register::Ar2)),
    ("TAR1", "TAR1", Operation::TransferRegister(Register::Ar1)),
    ("TAR2", "TAR2", Operation::TransferRegister(Register::Ar2)),
    ("CAR", "TAR", Operation::SwapRegisters),
    ("+AR1", "+AR1", Operation::AddRegister(Register::Ar1)),
    ("+AR2", "+AR2", Operation::AddRegister(Register::Ar2)),
    ("OPN", "AUF", Operation::OpenData),
    ("CDB", "TDB", Operation::SwapDb),
    ("JU", "SPA", Operation::Jump(Jump::Always)),
    ("JL", "SPL", Operation::JumpList),
    ("JC", "SPB", Operation::Jump(Jump::IfRlo)),
    ("JCN", "SPBN", Operation::Jump(Jump::IfNotRlo)),
    ("JCB", "SPBB", Operation::Jump(Jump::IfRloWithBr)),
    ("JNB", "SPBNB", Operation::Jump(Jump::IfNotRloWithBr)),
    ("JBI", "SPBI", Operation::Jump(Jump::IfBr)),
    ("JNBI", "SPBIN", Operation::Jump(Jump::IfNotBr)),
    ("JO", "SPO", Operation::Jump(Jump::IfOverflow)),
    ("JOS", "SPS", Operation::Jump(Jump::IfStoredOverflow)),
    ("JZ", "SPZ", Operation::Jump(Jump::IfZero)),
    ("JN", "SPN", Operation::Jump(Jump::IfNotZero)),
    ("JP", "SPP", Operation::Jump(Jump::IfPositive)),
    ("JM", "SPM", Operation::Jump(Jump::IfNegative)),
    ("JPZ", "SPPZ", Operation::Jump(Jump::IfNotNegative)),
    ("JMZ", "SPMZ", Operation::Jump(Jump::IfNotPositive)),
    ("JUO", "SPU", Operation::Jump(Jump::IfUnordered)),
    ("LOOP", "LOOP", Operation::Jump(Jump::Loop)),
    ("BE", "BE", Operation::End(Condition::Always)),
    ("BEU", "BEA", Operation::End(Condition::Always)),
    ("BEC", "BEB", Operation::End(Condition::IfRlo)),
    ("CALL", "CALL", Operation::Call),
    ("UC", "UC", Operation::PlainCall(Condition::Always)),
    ("CC", "CC", Operation::PlainCall(Condition::IfRlo)),
    ("MCRA", "MCRA", Operation::Mcr(Mcr::Activate)),
    ("MCRD", "MCRD", Operation::Mcr(Mcr::Deactivate)),
    ("MCR(", "MCR(", Operation::Mcr(Mcr::Open)),
    (")MCR", ")MCR", Operation::Mcr(Mcr::Close)),
    ("SP", "SI", Operation::Timer(TimerKind::Pulse)),
    ("SE", "SV", Operation::Timer(TimerKind::ExtendedPulse)),
    ("SD", "SE", Operation::Timer(TimerKind::OnDelay)),
    ("SS", "SS", Operation::Timer(TimerKind::StoredOnDelay)),
    ("SF", "SA", Operation::Timer(TimerKind::OffDelay)),
    ("FR", "FR", Operation::Free),
    ("CU", "ZV", Operation::CountUp),
    ("CD", "ZR", Operation::CountDown),
    ("BLD", "BLD", Operation::Nothing),
    ("NOP", "NOP", Operation::Nothing),
];

type Table = BTreeMap<&'static str, Operation>;

static INTERNATIONAL: LazyLock<Table> =
    LazyLock::new(|| OPERATIONS.iter().map(|&(word, _, operation)| (word, operation)).collect());

static GERMAN: LazyLock<Table> =
    LazyLock::new(|| OPERATIONS.iter().map(|&(_, word, operation)| (word, operation)).collect());

impl Language {
    /// The operation of a word in capitals.
    pub(in crate::plc::step7) fn operation(self, word: &str) -> Option<Operation> {
        match self {
            Self::International => INTERNATIONAL.get(word).copied(),
            Self::German => GERMAN.get(word).copied(),
        }
    }

    /// The words of this language, for suggestions.
    pub(in crate::plc::step7) fn words(self) -> impl Iterator<Item = &'static str> {
        OPERATIONS.iter().map(move |&(international, german, _)| match self {
            Self::International => international,
            Self::German => german,
        })
    }

    /// The language of statements by the words that only one of them has: more than 0 international, less than 0 German, 0 for both.
    pub(in crate::plc::step7) fn balance<'a>(words: impl Iterator<Item = &'a str>) -> i64 {
        words.fold(0, |balance, word| match (INTERNATIONAL.contains_key(word), GERMAN.contains_key(word)) {
            (true, false) => balance + 1,
            (false, true) => balance - 1,
            _ => balance,
        })
    }

    /// The language of a balance.
    pub(in crate::plc::step7) fn of_balance(balance: i64) -> Option<Self> {
        match balance {
            0 => None,
            1.. => Some(Self::International),
            _ => Some(Self::German),
        }
    }

    /// Whether a word means one thing in German and another in international operations.
    pub(in crate::plc::step7) fn differs(word: &str) -> bool {
        match (INTERNATIONAL.get(word), GERMAN.get(word)) {
            (Some(one), Some(other)) => one != other,
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_one_language_decide() {
        let of = |words: &[&'static str]| Language::of_balance(Language::balance(words.iter().copied()));
        assert_eq!(of(&["L", "SE", "U"]), Some(Language::German));
        assert_eq!(of(&["L", "SE", "A"]), Some(Language::International));
        assert_eq!(of(&["L", "SE"]), None);
        let words = OPERATIONS.iter().map(|&(word, ..)| word);
        assert_eq!(words.filter(|word| Language::differs(word)).collect::<Vec<_>>(), ["SE"]);
        assert_eq!(Language::German.operation("SE"), Some(Operation::Timer(TimerKind::OnDelay)));
        assert_eq!(Language::International.operation("SE"), Some(Operation::Timer(TimerKind::ExtendedPulse)));
    }
}
