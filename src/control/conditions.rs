//! Conditions: what a control tests before one of its signals gets a value.
//!
//! They answer the question of commissioning: why is this signal not 1? A control states for each of its signals a formula over other
//! signals and over facts of its own state ([`Control::conditions`](super::Control::conditions)). The reader looks up the signals in the
//! memory and asks again for those that the control writes itself.

use crate::image::{Names, Signal};
use crate::variables::{Place, SignalBit};

/// A question to a control: what must hold so that a bit of its part has this value?
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The owner of the block.
    pub place: Place,
    /// Byte of the block.
    pub byte: u16,
    /// Bit of the byte.
    pub bit: u8,
    /// The value that the bit is to have.
    pub wanted: bool,
    /// The names of axes and channels, for texts.
    pub names: &'a Names,
}

/// A formula over signals and facts.
#[derive(Clone, Debug, PartialEq)]
pub enum Condition {
    /// A signal of one bit has this value.
    Signal(SignalBit, bool),
    /// A fact of the control's state.
    Fact(Fact),
    /// Every one of these holds.
    All(Vec<Self>),
    /// One of these holds, or more.
    Any(Vec<Self>),
}

/// A fact of the control's state that no signal shows, or that has a history.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// What is tested: `alarm that stops CHAN1`.
    pub what: String,
    /// What the control finds: `25040`.
    pub found: String,
    /// What it wants: `none`.
    pub wanted: String,
    /// Whether it finds what it wants.
    pub holds: bool,
    /// What must hold so that this fact changes, if it has a history: the control tests it for the next step on the way.
    pub first: Option<Box<Condition>>,
}

impl Fact {
    /// A fact without a history.
    #[must_use]
    pub fn new(what: impl Into<String>, found: impl Into<String>, wanted: impl Into<String>, holds: bool) -> Self {
        Self { what: what.into(), found: found.into(), wanted: wanted.into(), holds, first: None }
    }

    /// The same fact with what must hold so that it changes. A fact that holds needs no change.
    #[must_use]
    pub fn after(mut self, first: impl FnOnce() -> Condition) -> Condition {
        if !self.holds {
            self.first = Some(Box::new(first()));
        }
        Condition::Fact(self)
    }
}

/// What the conditions of a control are computed from: its state after a cycle, and what it read.
pub trait Looks {
    /// It, for as long as the state is borrowed.
    type At<'a>: Copy;
}

/// The conditions of a signal: those for 1, and those for 0 if they are not the opposite.
pub struct Row<L: Looks, Owner: 'static> {
    /// The signal.
    pub signal: Signal,
    set: fn(L::At<'_>, Owner) -> Condition,
    reset: Option<fn(L::At<'_>, Owner) -> Condition>,
}

impl<L: Looks, Owner> Row<L, Owner> {
    /// A signal that is 0 exactly if these conditions for 1 do not hold.
    #[must_use]
    pub const fn new(signal: Signal, set: fn(L::At<'_>, Owner) -> Condition) -> Self {
        Self { signal, set, reset: None }
    }

    /// A signal that is reset by other conditions than those that set it.
    #[must_use]
    pub const fn with(
        signal: Signal,
        set: fn(L::At<'_>, Owner) -> Condition,
        reset: fn(L::At<'_>, Owner) -> Condition,
    ) -> Self {
        Self { signal, set, reset: Some(reset) }
    }

    /// The conditions of the bit that a question is about; `None` if no row has it.
    #[must_use]
    pub fn find(rows: &[Self], look: L::At<'_>, owner: Owner, question: &Question<'_>) -> Option<Condition> {
        let is_meant = |row: &&Self| (row.signal.byte, row.signal.bit) == (question.byte, question.bit);
        let row = rows.iter().find(is_meant)?;
        Some(match (question.wanted, row.reset) {
            (true, _) => (row.set)(look, owner),
            (false, Some(reset)) => reset(look, owner),
            (false, None) => (row.set)(look, owner).opposite(),
        })
    }
}

/// "Yes" or "no".
#[must_use]
pub const fn yes(holds: bool) -> &'static str {
    if holds { "yes" } else { "no" }
}

/// A fact that is true or false.
pub fn fact(what: impl Into<String>, holds: bool) -> Fact {
    Fact::new(what, yes(holds), "yes", holds)
}

impl From<Fact> for Condition {
    fn from(fact: Fact) -> Self {
        Self::Fact(fact)
    }
}

impl Condition {
    /// A condition that always holds: nothing is tested.
    pub const NOTHING: Self = Self::All(Vec::new());

    /// The condition that holds exactly if this one does not. What leads to a fact does not lead away from it, so it is dropped.
    #[must_use]
    pub fn opposite(self) -> Self {
        let each = |all: Vec<Self>| all.into_iter().map(Self::opposite).collect();
        match self {
            Self::Signal(bit, wanted) => Self::Signal(bit, !wanted),
            Self::Fact(Fact { what, found, wanted, holds, .. }) => {
                let wanted = match wanted.as_str() {
                    "yes" => "no".to_owned(),
                    "no" => "yes".to_owned(),
                    "none" => "one".to_owned(),
                    "one" => "none".to_owned(),
                    _ => wanted.strip_prefix("not ").map_or_else(|| format!("not {wanted}"), str::to_owned),
                };
                Self::Fact(Fact::new(what, found, wanted, !holds))
            }
            Self::All(all) => Self::Any(each(all)),
            Self::Any(any) => Self::All(each(any)),
        }
    }
}
