//! The texts of a control: what its numbers mean, without a machine.

use super::Chart;
use crate::image::{Interface, Signal};
use crate::variables::{AlarmNumber, Place, Rule, RuleNumber};

/// The texts of a control: the meaning of its numbers. They do not depend on a machine.
pub trait Texts: Sync {
    /// Its name in saved machines and messages.
    fn name(&self) -> &'static str;

    /// Its interface.
    fn interface(&self) -> &'static Interface;

    /// How it names the first axis and the first channel where no machine gives names.
    fn first_names(&self) -> (&'static str, &'static str) {
        ("AX1", "CHAN1")
    }

    /// Whether a signal has an effect: the control writes it, or reads it if another side writes it. The default is all signals.
    fn is_modelled(&self, _signal: &Signal) -> bool {
        true
    }

    /// All its alarms, ascending by number.
    fn alarms(&self) -> Vec<AlarmRow>;

    /// The alarm of a number.
    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow>;

    /// The name of an alarm: its number, or our own name if no source gives a number.
    fn alarm_name(&self, number: AlarmNumber) -> String;

    /// The number of an alarm that has only our own name.
    fn alarm_named(&self, name: &str) -> Option<AlarmNumber>;

    /// All its rules; the number of a rule is its index. Several rules can have one ID.
    fn rules(&self) -> &'static [Rule];

    /// A rule by its number.
    fn rule(&self, rule: RuleNumber) -> Rule {
        self.rules().get(usize::from(rule.0)).copied().unwrap_or(Rule { id: "?", text: "unknown rule" })
    }

    /// The number and the indices of a parameter of an axis or a channel, by its name. The default is a control without named parameters.
    fn parameter(&self, _name: &str, _place: Place) -> Option<(u32, [u16; 2])> {
        None
    }

    /// The name of a datum in a cause: `MD37110`.
    fn datum_name(&self, number: u32) -> String;

    /// The data that set the cycle times, for use in error messages: `MD10050 and MD10070`.
    fn cycle_data(&self) -> &'static str;

    /// All its machine data, ascending by number. The default is none, for a control without a list of its data.
    fn machine_data(&self) -> Vec<DatumRow> {
        Vec::new()
    }

    /// Its state machines as charts.
    fn charts(&self) -> Vec<Chart>;

    /// The ending in the names of its programs, with a dot; none if it has kinds of programs (`.MPF`, `.SPF`).
    fn program_ending(&self) -> &'static str;
}

/// A machine datum of a control.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct DatumRow {
    /// Its number.
    pub number: u32,
    /// Its name with its index, as a file has it: `$MA_REFP_SET_POS[0..3,axis]`.
    pub name: String,
    /// Its unit; empty without a unit.
    pub unit: &'static str,
    /// Its permitted values, in words.
    pub range: String,
    /// Its default, as a file has it.
    pub default: String,
    /// The action with which a new value takes effect, in words.
    pub effect: String,
    /// Whether it has an effect in the model.
    pub modelled: bool,
    /// Its meaning.
    pub text: &'static str,
}

/// An alarm of a control.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AlarmRow {
    /// Its number.
    pub number: AlarmNumber,
    /// Its name: its number, or our own name.
    pub name: String,
    /// Its text, with `%1` to `%4`.
    pub text: &'static str,
    /// Whether the model raises it.
    pub raised: bool,
    /// The action that cancels it, in words.
    pub cancelled_by: String,
    /// Its reactions, in words.
    pub reaction: String,
    /// The cancelling action, as NC variables code it.
    pub clear_info: ClearInfo,
}

/// The action that cancels an alarm, with its code in the NC variables `clearInfo`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ClearInfo {
    /// Power off and on.
    PowerOn = 1,
    /// RESET in the channel.
    Reset = 2,
    /// The alarm-cancel key.
    CancelKey = 3,
    /// The control clears it when its cause is gone.
    ByItself = 4,
    /// NC start.
    NcStart = 5,
    /// RESET in all channels of the mode group.
    ModeGroupReset = 6,
}

impl ClearInfo {
    /// The code.
    #[must_use]
    pub const fn code(self) -> u8 {
        self as u8
    }
}
