//! `opennck alarms`: the alarm catalogue. Alarms that the model does not raise yet are marked "not yet".

use super::list::{Format, List};
use super::output::Output;
use crate::control::{AlarmRow, Texts};
use crate::controls;
use crate::image::Profile;
use crate::scenario::profile_named;
use crate::source::Problem;

pub(super) fn alarms(filter: Option<&str>, profile: Option<&str>, format: Format, output: &mut Output) -> u8 {
    let texts = match texts_of(profile) {
        Ok(texts) => texts,
        Err(problem) => {
            output.error(problem);
            return 2;
        }
    };
    let rows = texts.into_iter().flat_map(Texts::alarms).map(row).collect();
    let mut list = List { heads: &["alarm", "raised", "cancelled by", "reaction", "text"], rows };
    let found = list.retain_with(filter, output);
    list.print(format, output).max(found)
}

/// The texts of the control with this profile, or of all controls.
pub(super) fn texts_of(profile: Option<&str>) -> Result<Vec<&'static dyn Texts>, Problem> {
    let interface = profile.map(profile_named).transpose()?.map(Profile::interface);
    let is_of = |texts: &&'static dyn Texts| interface.is_none_or(|of| std::ptr::eq(texts.interface(), of));
    Ok(controls::texts().filter(is_of).collect())
}

fn row(alarm: AlarmRow) -> Vec<String> {
    let raised = if alarm.raised { "yes" } else { "not yet" };
    vec![alarm.name, raised.to_owned(), alarm.cancelled_by, alarm.reaction, alarm.text.to_owned()]
}
