//! START-UP CHECKS OF CHANNELS: their axes, and coupling group 0 (HG-03, SG-21).
//!
//! Decisions:
//!
//! - Without P-CHAN-00003, all axes of the list belong to the channel. With it, that many, gaps in the index not counted; another number
//!   of axes is an error, and the smaller number acts. A gantry slave is an error also beyond that number.
//! - A gantry slave in a channel (21020), an axis with the number 0, and an axis that another channel or index has, are left out.
//! - P-CHAN-00108 with another value than its two, 0 and −1 is an error, and 100 acts: of two units none is the nearest.
//! - Group 0: pairs without both numbers do not exist; with one of them they are skipped (20438), as are a slave that is its own master
//!   (20440), a slave of an earlier pair (20441), and an axis that an earlier pair has in the other role (20442). Whether the axes are in
//!   the channel is checked when the group is activated.

use std::collections::BTreeMap;

use super::draft::Draft;
use super::list::List;
use super::message::{Code, ERROR, Message, WARNING};
use super::names::fault;
use super::parameter::{Key, MOST_CHANNEL_AXES, MOST_PAIRS};
use super::state::{Channel, ChannelAxis, Pair};

const COUNT: Key = Key::new(100_003);
const GROUPS: Key = Key::new(100_023);
const FEED: Key = Key::new(100_099);
const FACTOR: Key = Key::new(100_108);

/// The two values of P-CHAN-00108.
const IN_MM_PER_MINUTE: f64 = 100.0;
const IN_M_PER_MINUTE: f64 = 0.1;
/// It counts as no entry.
const WITHOUT_UNIT: f64 = -1.0;

/// What a channel must know about an axis.
#[derive(Clone, Debug)]
pub(super) struct Known {
    pub(super) is_slave: bool,
    pub(super) default_name: String,
}

const fn name(j: u16) -> Key {
    Key::second(100_006, j)
}

const fn logical_number(j: u16) -> Key {
    Key::second(100_035, j)
}

/// The indices and logical numbers of the axes that a list gives to its channel, before any check.
pub(super) fn listed(list: &List) -> Vec<(u16, u16)> {
    let most = list.active.get(&COUNT).and_then(|entry| entry.value.whole());
    let most = most.and_then(|most| usize::try_from(most).ok()).unwrap_or(usize::MAX);
    all(list).into_iter().take(most).collect()
}

/// The indices and logical numbers of all axes of a list, also of those beyond P-CHAN-00003.
fn all(list: &List) -> Vec<(u16, u16)> {
    let is_there = |j: &u16| list.active.contains_key(&name(*j)) || list.active.contains_key(&logical_number(*j));
    let number = |j| list.active.get(&logical_number(j)).and_then(|entry| entry.value.whole()).unwrap_or(0);
    (0..MOST_CHANNEL_AXES).filter(is_there).map(|j| (j, u16::try_from(number(j)).unwrap_or(0))).collect()
}

/// Checks a channel. `owners` has the channel of each axis that an earlier channel took; this one adds its own.
pub(super) fn check(
    list: &List,
    axes: &BTreeMap<u16, Known>,
    owners: &mut BTreeMap<u16, u16>,
    messages: &mut Vec<Message>,
) -> Channel {
    let mut draft = Draft::new(list);
    numbers(&mut draft, messages);
    let own = channel_axes(&mut draft, axes, owners, messages);
    let group_0 = group_0(&draft, messages);
    let is_set = |number| draft.whole(Key::new(number)) != 0;
    Channel {
        number: list.number,
        file: list.file.file.to_string(),
        axes: own,
        group_0,
        restore_after_reset: is_set(100_104),
        preserve_after_program_end: is_set(100_105),
        retain_last_configuration: is_set(100_460),
        always_shortest_way: is_set(100_346),
        has_alias_names: is_set(100_253),
        is_feed_in_m_per_minute: draft.real(FACTOR) == IN_M_PER_MINUTE,
        default_feed: draft.real(FEED),
        values: draft.into_values(),
    }
}

fn numbers(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    if draft.whole(GROUPS) != 1 {
        messages.push(draft.out_of_range(GROUPS, "1", "1"));
        draft.set_whole(GROUPS, 1);
    }
    feed_unit(draft, messages);
    if draft.real(FEED) < 0.0 {
        messages.push(draft.out_of_range(FEED, "0 or more", "0"));
        draft.set_real(FEED, 0.0);
    }
}

/// P-CHAN-00108 names one of two units. 0 is a warning, −1 means no entry, another number is out of its range.
fn feed_unit(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    let factor = draft.real(FACTOR);
    if factor == IN_MM_PER_MINUTE || factor == IN_M_PER_MINUTE {
        return;
    }
    if factor != WITHOUT_UNIT {
        let mut message = draft.out_of_range(FACTOR, "0.1 (F in m/min) or 100 (F in mm/min)", "100");
        if factor <= 0.0 {
            message.class = WARNING;
        }
        messages.push(message);
    }
    draft.set_real(FACTOR, IN_MM_PER_MINUTE);
}

fn channel_axes(
    draft: &mut Draft<'_>,
    axes: &BTreeMap<u16, Known>,
    owners: &mut BTreeMap<u16, u16>,
    messages: &mut Vec<Message>,
) -> Vec<ChannelAxis> {
    let (all, count) = (all(draft.list), listed(draft.list).len());
    let there = i64::try_from(all.len()).unwrap_or(0);
    if draft.is_written(COUNT) && draft.whole(COUNT) != there {
        let text = format!("{}, but the list has {there} axes, used the first {count}", draft.found(COUNT));
        messages.push(draft.message(Code::Parameter(COUNT.number), ERROR, COUNT, &text));
    }
    draft.set_whole(COUNT, i64::try_from(count).unwrap_or(0));
    let mut own: Vec<ChannelAxis> = Vec::new();
    for (place, (j, number)) in all.into_iter().enumerate() {
        let key = logical_number(j);
        let Some(known) = axes.get(&number) else {
            if place >= count {
                continue;
            }
            messages.push(draft.out_of_range(key, "the logical number of an axis that has a list", "no axis"));
            continue;
        };
        if known.is_slave {
            let text =
                format!("{}, a gantry slave, which must not belong to a channel; used: no axis", draft.found(key));
            messages.push(draft.message(Code::Number(21_020), ERROR, key, &text).of_axis(number));
            continue;
        }
        if place >= count {
            continue;
        }
        if let Some(channel) = owners.get(&number) {
            let allowed = format!("an axis that is in no channel yet (channel {channel} has it)");
            messages.push(draft.out_of_range(key, &allowed, "no axis").of_axis(number));
            continue;
        }
        owners.insert(number, draft.number());
        let name = channel_name(draft, j, known, messages).to_owned();
        own.push(ChannelAxis { index: j, name, number });
    }
    own
}

/// The name of an axis in the channel.
fn channel_name<'a>(draft: &'a mut Draft<'_>, j: u16, known: &Known, messages: &mut Vec<Message>) -> &'a str {
    let key = name(j);
    if let Some((allowed, nearest)) = fault(draft.word(key)) {
        let used = nearest.unwrap_or_else(|| known.default_name.clone());
        messages.push(draft.out_of_range(key, allowed, &used));
        draft.set_word(key, &used);
    }
    draft.word(key)
}

fn group_0(draft: &Draft<'_>, messages: &mut Vec<Message>) -> Vec<Pair> {
    let mut pairs: Vec<Pair> = Vec::new();
    for j in 0..MOST_PAIRS {
        let keys = [100_037, 100_038, 100_061].map(|number| Key::second(number, j));
        let [master, slave, mode] = keys.map(|key| u16::try_from(draft.whole(key)).unwrap_or(0));
        let pair = Pair { index: j, master, slave, is_spindles: mode != 0 };
        if master == 0 && slave == 0 {
            continue;
        }
        if let Some((number, axis, why)) = skipped(&pairs, &pair) {
            let text = format!(
                "P-CHAN-00037, P-CHAN-00038 of {}: pair {j} of coupling group 0 is {master} → {slave}: {why}; used: no pair",
                draft.list.owner()
            );
            let message = draft.message(Code::Number(number), WARNING, keys[1], &text);
            let other = if axis == master { slave } else { master };
            messages.push(message.of_axis(axis).with_axis(other));
            continue;
        }
        if mode > 1 {
            messages.push(draft.out_of_range(keys[2], "0 (path axes) or 1 (spindles)", "1"));
        }
        pairs.push(pair);
    }
    pairs
}

/// The number of the warning, the axis and the reason why a pair is skipped.
fn skipped(earlier: &[Pair], pair: &Pair) -> Option<(u32, u16, String)> {
    let Pair { master, slave, .. } = *pair;
    if master == 0 || slave == 0 {
        return Some((20_438, master.max(slave), "the number 0 is no axis".to_owned()));
    }
    if master == slave {
        return Some((20_440, slave, "the slave is its own master".to_owned()));
    }
    if let Some(other) = earlier.iter().find(|other| other.slave == slave) {
        return Some((20_441, slave, format!("axis {slave} is the slave of pair {}, too", other.index)));
    }
    if let Some(other) = earlier.iter().find(|other| other.master == slave || other.slave == master) {
        let both = if other.master == slave { slave } else { master };
        return Some((20_442, both, format!("axis {both} is a master and a slave (pair {})", other.index)));
    }
    None
}
