//! `opennck alarms`: the alarm catalogue, with the rows that nothing raises yet marked as such.

use super::list::{Format, List};
use super::output::Output;
use crate::sinumerik::{ALARMS, ALARMS_NOT_RAISED, Alarm};

pub(super) fn alarms(filter: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let mut all: Vec<(&Alarm, bool)> = ALARMS.iter().map(|alarm| (alarm, true)).collect();
    all.extend(ALARMS_NOT_RAISED.iter().map(|alarm| (alarm, false)));
    all.sort_by_key(|(alarm, _)| alarm.number);
    let rows = all.into_iter().map(|(alarm, raised)| row(alarm, raised)).collect();
    let mut list = List { heads: &["alarm", "raised", "cancelled by", "reaction", "text"], rows };
    list.retain_with(filter, output);
    list.print(format, output)
}

fn row(alarm: &Alarm, raised: bool) -> Vec<String> {
    let raised = if raised { "yes" } else { "not yet" };
    vec![
        Alarm::name(alarm.number),
        raised.to_owned(),
        alarm.cancel.to_string(),
        alarm.reaction.to_string(),
        alarm.text.to_owned(),
    ]
}
