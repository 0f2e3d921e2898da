//! The texts of this control: alarms, rules, names of machine data and charts of its state machines.

use crate::control::{AlarmRow, Chart, ClearInfo, DatumRow, Kind, Texts};
use crate::image::{Interface, SINUMERIK, Signal};
use crate::sinumerik::alarms::{Alarm, Cancel, not_raised};
use crate::sinumerik::exchange;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::gantry;
use crate::sinumerik::machine_data::{Datum, Range, Scope, catalogue, datum_name};
use crate::sinumerik::modelled::is_modelled;
use crate::sinumerik::opening::has_effect;
use crate::sinumerik::referencing;
use crate::sinumerik::rules::Rule;
use crate::variables::{AlarmNumber, Rule as RuleText};

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
        let raised = Alarm::raised().map(|alarm| row(alarm, true));
        let mut all: Vec<_> = raised.chain(not_raised::NOT_RAISED.iter().map(|alarm| row(alarm, false))).collect();
        all.sort_by_key(|alarm| alarm.number);
        all
    }

    fn alarm(&self, number: AlarmNumber) -> Option<AlarmRow> {
        let not_raised = || not_raised::NOT_RAISED.iter().find(|alarm| alarm.number == number);
        Alarm::find(number)
            .map(|alarm| row(&Alarm { number, ..*alarm }, true))
            .or_else(|| not_raised().map(|alarm| row(alarm, false)))
    }

    fn alarm_name(&self, number: AlarmNumber) -> String {
        Alarm::name(number)
    }

    fn alarm_named(&self, name: &str) -> Option<AlarmNumber> {
        Alarm::named(name)
    }

    fn rules(&self) -> &'static [RuleText] {
        Rule::ALL
    }

    fn datum_name(&self, number: u32) -> String {
        datum_name(number)
    }

    fn cycle_data(&self) -> &'static str {
        "MD10050 and MD10070"
    }

    fn machine_data(&self) -> Vec<DatumRow> {
        catalogue().map(datum_row).collect()
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
        let exchange = Chart::of("exchange", "Axis exchange", exchange::state::TRANSITIONS, Holder::text, |_| None);
        vec![approach, grouping, exchange]
    }

    fn program_ending(&self) -> &'static str {
        ""
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

fn datum_row(datum: &Datum) -> DatumRow {
    let values = (datum.count > 1).then(|| format!("0..{}", datum.count - 1));
    let owner = matches!(datum.scope, Scope::Axis | Scope::AxisSetting).then(|| "axis".to_owned());
    let index: Vec<_> = values.into_iter().chain(owner).collect();
    let index = if index.is_empty() { String::new() } else { format!("[{}]", index.join(",")) };
    let written = |is_rotary| {
        let of =
            |index| datum.default_value(index, is_rotary).map_or_else(String::new, |value| value.export(datum.kind));
        let all: Vec<_> = datum.indices().map(of).collect();
        // Most data have one default for all indices; the names of axes and channels have one for each.
        match all.as_slice() {
            [first, others @ ..] if others.iter().all(|value| value == first) => first.clone(),
            [first, second, .., last] if all.len() > 4 => format!("{first} {second} … {last}"),
            all => all.join(" "),
        }
    };
    let (linear, rotary) = (written(false), written(true));
    let default = if linear == rotary { linear } else { format!("{linear} (rotary axis {rotary})") };
    let range = match datum.kind {
        _ if datum.range != Range::ANY => datum.range.to_string(),
        Kind::Boolean => "0 or 1".to_owned(),
        Kind::Byte => "0 to 255".to_owned(),
        Kind::Dword => "whole number".to_owned(),
        Kind::Udword => "32 bits".to_owned(),
        Kind::String => "text".to_owned(),
        Kind::Double => datum.range.to_string(),
    };
    let effect = if datum.read_only { "only the control writes it".to_owned() } else { datum.effect.to_string() };
    DatumRow {
        number: datum.number,
        name: format!("{}{index}", datum.full_identifier()),
        unit: datum.unit,
        range,
        default,
        effect,
        modelled: has_effect(datum.number),
        text: datum.doc,
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
