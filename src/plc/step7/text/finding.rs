//! What is wrong with a source, and where: file, line, column, and for statements block and network.

use std::fmt;

/// A place in a source file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::plc::step7) struct At {
    /// The index of the file.
    pub(in crate::plc::step7) file: u16,
    /// The line, counted from one; 0 for a whole file.
    pub(in crate::plc::step7) line: u32,
    /// The column, counted from one.
    pub(in crate::plc::step7) column: u32,
}

/// A finding before the name of its file is known.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(in crate::plc::step7) struct Fault {
    pub(in crate::plc::step7) at: At,
    pub(in crate::plc::step7) kind: FindingKind,
    pub(in crate::plc::step7) what: String,
    pub(in crate::plc::step7) cure: String,
}

impl Fault {
    pub(in crate::plc::step7) fn new(at: At, what: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { at, kind: FindingKind::Error, what: what.into(), cure: cure.into() }
    }

    pub(in crate::plc::step7) fn unsupported(at: At, what: impl Into<String>) -> Self {
        Self {
            at,
            kind: FindingKind::Unsupported,
            what: what.into(),
            cure: "see `docs/plc_step7.md` for what is supported".to_owned(),
        }
    }
}

/// The kind of a finding.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum FindingKind {
    /// The text violates the rules of STEP 7.
    Error,
    /// The text is legal, and this compiler does not support it.
    Unsupported,
    /// A block is called that is nowhere.
    Missing,
}

/// Something in a source that prevents the program from running, or that is worth knowing.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// What kind of finding it is.
    pub kind: FindingKind,
    /// The file as the user named it.
    pub file: String,
    /// The line, counted from one; 0 for the whole file.
    pub line: u32,
    /// The column, counted from one.
    pub column: u32,
    /// The block and the network, as `FC10, network 2`; empty outside of statements.
    pub context: String,
    /// What was expected and what was found.
    pub what: String,
    /// The remedy.
    pub cure: String,
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        f.write_str(": ")?;
        if !self.context.is_empty() {
            write!(f, "{}: ", self.context)?;
        }
        f.write_str(&self.what)?;
        if !self.cure.is_empty() {
            write!(f, "\n  {}", self.cure)?;
        }
        Ok(())
    }
}
