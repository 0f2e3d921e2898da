//! `opennck alarms`: the alarm catalogue. Alarms that the model does not raise yet are marked "not yet".

use super::list::{Format, List};
use super::output::Output;
use crate::control::{AlarmRow, Texts};
use crate::controls;

pub(super) fn alarms(filter: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let rows = controls::texts().flat_map(Texts::alarms).map(row).collect();
    let mut list = List { heads: &["alarm", "raised", "cancelled by", "reaction", "text"], rows };
    let found = list.retain_with(filter, output);
    list.print(format, output).max(found)
}

fn row(alarm: AlarmRow) -> Vec<String> {
    let raised = if alarm.raised { "yes" } else { "not yet" };
    vec![alarm.name, raised.to_owned(), alarm.cancelled_by, alarm.reaction, alarm.text.to_owned()]
}
