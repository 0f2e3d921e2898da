//! The texts of this control: alarms, rules, names of machine data and charts of its state machines.

use crate::control::{AlarmRow, Chart, ClearInfo, Texts};
use crate::image::{Interface, SINUMERIK, Signal};
use crate::sinumerik::alarms::{Alarm, CATALOGUE, Cancel, not_raised};
use crate::sinumerik::gantry;
use crate::sinumerik::modelled::is_modelled;
use crate::sinumerik::referencing;
use crate::sinumerik::rules::Rule;
use crate::variables::{AlarmNumber, Rule as RuleText, RuleNumber};

/// The texts of the SINUMERIK control.
pub static TEXTS: Words = Words;

/// See [`TEXTS`].
#[derive(Clone, Copy, Debug)]
pub struct Words;

impl Texts for Words {
    fn name(&self) -> &'static str {
        "sinumerik"
    }

    fn interface(&self) -> &'static Interface {
        &SINUMERIK
    }

    fn is_modelled(&self, signal: &Signal) -> bool {
        is_modelled(signal)
    }

    fn alarms(&self) -> Vec<AlarmRow> {
        let raised = CATALOGUE.iter().map(|alarm| row(alarm, true));
        let mut all: Vec<_> = raised.chain(not_raised::NOT_RAISED.iter().map(|alarm| row(alarm, false))).collect();
        all.sort_by_key(|alarm| alarm.number);
        all
    }

    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow> {
        let not_raised = || not_raised::NOT_RAISED.iter().find(|alarm| alarm.number == number);
        Alarm::find(number).map(|alarm| row(alarm, true)).or_else(|| not_raised().map(|alarm| row(alarm, false)))
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        Alarm::name(number)
    }

    fn alarm_named(&self, name: &str) -> Option<AlarmNumber> {
        Alarm::named(name)
    }

    fn rule(&self, rule: RuleNumber) -> RuleText {
        Rule::text(rule)
    }

    fn datum_name(&self, number: u32) -> String {
        format!("MD{number}")
    }

    fn cycle_data(&self) -> &'static str {
        "MD10050 and MD10070"
    }

    fn charts(&self) -> Vec<Chart> {
        let approach = Chart::of(
            "approach",
            "Reference point approach",
            referencing::state::TRANSITIONS,
            referencing::state::Phase::text,
            |_| None,
        );
        let tested = |rule| match rule {
            Rule::WaitWarningLimitZero => Some("MD37110 = 0"),
            Rule::WaitLocked => Some("29.5 = 1"),
            _ => None,
        };
        let grouping =
            Chart::of("gantry", "Gantry grouping", gantry::state::TRANSITIONS, gantry::state::Phase::text, tested);
        // An abort is not a row: it is possible in every phase.
        let approach = approach.with_step_from_anywhere(Rule::ApproachAborted, referencing::state::Phase::Idle);
        vec![approach, grouping]
    }
}

fn row(alarm: &Alarm, raised: bool) -> AlarmRow {
    AlarmRow {
        number: alarm.number,
        name: Alarm::name(alarm.number),
        text: alarm.text,
        raised,
        cancelled_by: alarm.cancel.to_string(),
        reaction: alarm.reaction.to_string(),
        clear_info: clear_info(alarm.cancel),
    }
}

/// The cancelling action in NC variables.
const fn clear_info(cancel: Cancel) -> ClearInfo {
    match cancel {
        Cancel::PowerOn => ClearInfo::PowerOn,
        Cancel::Reset => ClearInfo::Reset,
        Cancel::CancelKey => ClearInfo::CancelKey,
        Cancel::ByItself => ClearInfo::ByItself,
        Cancel::NcStart => ClearInfo::NcStart,
        Cancel::ModeGroupReset => ClearInfo::ModeGroupReset,
    }
}
