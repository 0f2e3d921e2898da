//! The words of the language that are no addresses and no functions: commands and keywords.

/// Commands with parameters in parentheses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Command {
    StopPreparation,
    Message,
    CycleAlarm,
    WaitForPosition,
    WaitForSpindle,
    Release,
    Get,
    GetDirectly,
    Preset,
    TrailOn,
    TrailOff,
    LeadOn,
    LeadOff,
    CouplingOn,
    CouplingOff,
    ElectronicGearOn,
    ElectronicGearOff,
    FeedGroup,
    SetMark,
    ClearMark,
    WaitMark,
    WaitMarkConditionally,
    Initialise,
    Start,
    WaitEnd,
    NewConfiguration,
    EndOverlays,
    Cancel,
    SingleBlockOff,
    SingleBlockOn,
    /// RDISABLE, in synchronised actions only.
    ReadInDisable,
}

/// Words of the language that are no addresses, functions or commands: none of them is the name of a variable or of a program.
const KEYWORDS: &[&str] = &[
    "ACTBLOCNO",
    "AND",
    "AXIS",
    "B_AND",
    "B_NOT",
    "B_OR",
    "B_XOR",
    "BOOL",
    "CALL",
    "CASE",
    "CHAR",
    "DEF",
    "DEFAULT",
    "DEFINE",
    "DISPLOF",
    "DISPLON",
    "DIV",
    "DO",
    "ELSE",
    "ENDFOR",
    "ENDIF",
    "ENDLABEL",
    "ENDLOOP",
    "ENDWHILE",
    "EVERY",
    "EXTCALL",
    "EXTERN",
    "FOR",
    "FRAME",
    "FROM",
    "GOTO",
    "GOTOB",
    "GOTOC",
    "GOTOF",
    "GOTOS",
    "IF",
    "INT",
    "LOOP",
    "MOD",
    "NOT",
    "OF",
    "OR",
    "PROC",
    "REAL",
    "REPEAT",
    "REPEATB",
    "RET",
    "SAVE",
    "STRING",
    "TO",
    "UNTIL",
    "VAR",
    "WHEN",
    "WHENEVER",
    "WHILE",
    "XOR",
];

/// Whether a word can only stand where the language expects it (12080).
pub(super) fn is_keyword(name: &str) -> bool {
    KEYWORDS.binary_search(&name).is_ok()
}

/// Names, and whether the command is alone in its block.
pub(super) const COMMANDS: &[(&str, Command, bool)] = &[
    ("STOPRE", Command::StopPreparation, true),
    ("MSG", Command::Message, true),
    ("SETAL", Command::CycleAlarm, true),
    ("WAITP", Command::WaitForPosition, true),
    ("WAITS", Command::WaitForSpindle, true),
    ("RELEASE", Command::Release, false),
    ("GET", Command::Get, true),
    ("GETD", Command::GetDirectly, true),
    ("PRESETON", Command::Preset, true),
    ("TRAILON", Command::TrailOn, false),
    ("TRAILOF", Command::TrailOff, false),
    ("LEADON", Command::LeadOn, false),
    ("LEADOF", Command::LeadOff, false),
    ("COUPON", Command::CouplingOn, false),
    ("COUPOF", Command::CouplingOff, false),
    ("EGON", Command::ElectronicGearOn, false),
    ("EGOFS", Command::ElectronicGearOff, false),
    ("FGROUP", Command::FeedGroup, true),
    ("SETM", Command::SetMark, false),
    ("CLEARM", Command::ClearMark, false),
    ("WAITM", Command::WaitMark, false),
    ("WAITMC", Command::WaitMarkConditionally, false),
    ("INIT", Command::Initialise, true),
    ("START", Command::Start, true),
    ("WAITE", Command::WaitEnd, true),
    ("NEWCONF", Command::NewConfiguration, true),
    ("DRFOF", Command::EndOverlays, true),
    ("CANCEL", Command::Cancel, true),
    ("SBLOF", Command::SingleBlockOff, true),
    ("SBLON", Command::SingleBlockOn, true),
    ("RDISABLE", Command::ReadInDisable, false),
];

impl Command {
    pub(super) fn find(name: &str) -> Option<Self> {
        COMMANDS.iter().find(|row| row.0 == name).map(|row| row.1)
    }

    /// Whether everything before it must have been executed.
    pub(super) fn is_stop(self) -> bool {
        matches!(
            self,
            Self::StopPreparation
                | Self::Preset
                | Self::Get
                | Self::GetDirectly
                | Self::NewConfiguration
                | Self::EndOverlays
        )
    }

    /// Whether nothing else may stand in the block.
    pub(super) fn is_alone(self) -> bool {
        COMMANDS.iter().any(|row| row.1 == self && row.2)
    }
}
