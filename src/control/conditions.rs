//! Conditions: what a control tests before one of its signals gets a value.
//!
//! They answer the question of commissioning: why is this signal not 1? A control states for each of its signals a formula over other
//! signals and over facts of its own state ([`Control::conditions`](super::Control::conditions)). The reader looks up the signals in the
//! memory and asks again for those that the control writes itself.

use crate::image::Names;
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
