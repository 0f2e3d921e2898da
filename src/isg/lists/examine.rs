//! What `opennck machine-data check` reports about the lists of a machine.

use crate::control::{Class, Examined, Finding};
use crate::source::Problem;

use super::draft::Draft;
use super::list::{List, Lists, Unknown};
use super::message::{Code, Message, short};
use super::name::probably;
use super::parameter::{Key, Scope};
use super::ranges::{KIND, LINEAR, MODE, MODE_MODULO, is_spindle};
use super::reading::{Collected, collect};
use super::state::{Axis, AxisKind, Channel, Started};
use super::table::by_number;

/// The contents of the lists of a machine: names and contents of its files.
#[must_use]
pub fn examine<N: AsRef<str>, B: AsRef<[u8]>>(files: &[(N, B)]) -> Examined {
    let Collected { mut lists, problems, remarks } = collect(files);
    lists.adopt_all();
    let is_empty = lists.axes.is_empty() && lists.channels.is_empty() && problems.is_empty();
    let problems: Vec<Problem> = problems.into_iter().chain(lists.contradictions()).collect();
    let is_refused = !problems.is_empty();
    let started = lists.update();
    let mut all: Vec<Finding> = problems.into_iter().map(Finding::from).collect();
    // Values that cannot be read would give messages about their defaults.
    let messages = if is_refused { &[][..] } else { &started.messages[..] };
    all.extend(findings(&lists, messages, remarks));
    let summary = if is_refused { Vec::new() } else { summary(&lists, &started) };
    Examined { is_refused, is_empty, summary, ignored: Vec::new(), findings: all }
}

/// The findings about lists that can be read, the heaviest first. `remarks` are those of reading them.
#[must_use]
pub fn findings(lists: &Lists, messages: &[Message], remarks: Vec<Finding>) -> Vec<Finding> {
    let mut findings: Vec<Finding> = remarks.into_iter().chain(messages.iter().map(power_on)).collect();
    for list in lists.axes.iter().chain(&lists.channels) {
        findings.extend(list.unknown.iter().map(|entry| unknown(list, entry)));
        findings.extend(list.stored.keys().filter_map(|key| not_modelled(list, *key)));
        findings.extend(silent_mode(list));
    }
    findings.sort_by_key(|finding| finding.class);
    findings
}

/// A message of the control at time 0.
fn power_on(message: &Message) -> Finding {
    let text = message.text.strip_suffix(&format!(" ({})", short(&message.place))).unwrap_or(&message.text);
    let what = match message.code {
        Code::Number(number) => format!("{number}: {text}"),
        Code::Parameter(_) => text.to_owned(),
    };
    let what = if message.is_warning() { format!("warning {what}") } else { format!("error {what}") };
    let number = match message.code {
        Code::Number(_) => None,
        Code::Parameter(number) => Some(number),
    };
    Finding { place: Some(message.place.clone()), number, ..Finding::new(Class::AlarmAtPowerOn, what, "") }
}

fn unknown(list: &List, entry: &Unknown) -> Finding {
    // A control knows many more parameters: a name that is near to a known one can be right.
    let cure = probably(entry.scope, &entry.name).map_or_else(String::new, |known| format!("did you mean `{known}`?"));
    let (class, what) = (Class::NotModelled, "not known here; it is kept and has no effect");
    Finding {
        place: Some(entry.place.clone()),
        datum: entry.name.clone(),
        value: entry.value.clone(),
        owner: list.owner(),
        group: "entries that are not known here",
        ..Finding::new(class, what, cure)
    }
}

/// An entry of a known parameter without an effect here.
fn not_modelled(list: &List, key: Key) -> Option<Finding> {
    let parameter = by_number(key.number)?;
    let what = match (parameter.is_modelled, key.index[0]) {
        (false, _) => "not modelled; it is kept and has no effect",
        (true, 0) => return None,
        (true, _) => "only the index 0 is modelled; the entry is kept and has no effect",
    };
    let entry = list.stored.get(&key)?;
    Some(Finding {
        place: Some(entry.place.clone()),
        number: Some(key.number),
        datum: parameter.title(key.index),
        value: entry.value.to_string(),
        owner: list.owner(),
        group: "known parameters without an effect",
        ..Finding::new(Class::NotModelled, what, "")
    })
}

/// A basic mode that a control corrects with a warning, and that is corrected silently here.
fn silent_mode(list: &List) -> Option<Finding> {
    if list.scope != Scope::Axis || list.number == 0 {
        return None;
    }
    let draft = Draft::new(list);
    let mode = draft.whole(MODE);
    let (number, bit) = match (draft.whole(KIND), mode) {
        (_, 0) => return None,
        (LINEAR, _) if mode & 1 == 0 => (110_051, "0x1 (linear)"),
        _ if is_spindle(&draft) && mode & MODE_MODULO == 0 => (110_352, "0x4 (modulo)"),
        _ => return None,
    };
    let what =
        format!("without the bit {bit}, a control gives warning {number} and sets the bit; here it is set silently");
    Some(Finding {
        place: Some(draft.place(MODE)),
        number: Some(MODE.number),
        datum: "P-AXIS-00015 kenngr.achs_mode".to_owned(),
        value: draft.shown(MODE),
        owner: list.owner(),
        ..Finding::new(Class::ActsOtherwise, what, "set the bit in the list")
    })
}

fn summary(lists: &Lists, started: &Started) -> Vec<String> {
    let axes = started.axes.iter().map(|axis| axis_line(lists, started, axis));
    let mut lines: Vec<String> = axes.chain(started.channels.iter().map(channel_line)).collect();
    let unknown = lists.unknown().count();
    if unknown != 0 {
        lines.push(format!("entries of unknown parameters: {unknown}"));
    }
    if !lists.others().is_empty() {
        lines.push(format!("other lists, left alone: {}", lists.others().join(", ")));
    }
    lines
}

/// `ax5 Axis_X1: linear, gantry slave of ax1, x1.lis`
fn axis_line(lists: &Lists, started: &Started, axis: &Axis) -> String {
    let names = started.names(axis);
    let kind = match axis.kind {
        AxisKind::Linear => "linear",
        AxisKind::Rotary => "rotary",
        AxisKind::Spindle => "spindle",
    };
    let modulo = if axis.is_modulo && axis.kind != AxisKind::Spindle { ", modulo" } else { "" };
    let gantry = match (axis.is_master, axis.is_slave, axis.master) {
        (true, ..) => ", gantry master".to_owned(),
        (false, true, Some(master)) => format!(", gantry slave of ax{master}"),
        (false, true, None) => ", gantry slave without a master".to_owned(),
        (false, false, _) => String::new(),
    };
    let file = lists.axis(axis.number).map_or("", |list| &list.file.file);
    let name = if names.is_empty() { String::new() } else { format!(" {}", names.join(" ")) };
    format!("ax{}{name}: {kind}{modulo}{gantry}, {file}", axis.number)
}

/// `channel_1: X (ax1) at 0, Y (ax2) at 1; coupling group 0: 2 → 8; channel.lis`
fn channel_line(channel: &Channel) -> String {
    let axes: Vec<String> =
        channel.axes.iter().map(|axis| format!("{} (ax{}) at {}", axis.name, axis.number, axis.index)).collect();
    let axes = if axes.is_empty() { "no axes".to_owned() } else { axes.join(", ") };
    let pairs: Vec<String> = channel.group_0.iter().map(|pair| format!("{} → {}", pair.master, pair.slave)).collect();
    let group = if pairs.is_empty() { String::new() } else { format!("; coupling group 0: {}", pairs.join(", ")) };
    format!("channel_{}: {axes}{group}; {}", channel.number, channel.file)
}
