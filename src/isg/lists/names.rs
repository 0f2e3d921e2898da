//! NAMES OF AXES: the default names of axis lists (P-AXIS-00297) and the names of axes in channels (P-CHAN-00006); HG-17, HG-25.
//!
//! A name has up to 16 characters; the first one is A B C U V W X Y Z or Q, then come letters, digits and underscores (the manuals say
//! letters and digits, and print underscores).
//!
//! Decisions. A longer name is cut off. A name with other characters has no nearest one: of a list, the default `X_Achse` acts; in a
//! channel, the default name of the axis. The default `X_Achse` of lists without an entry is no name of an axis, so it clashes with none.
//! With P-CHAN-00253, a default name other than A1 … A32 is an error, and `A` with the logical number acts where that is possible. The
//! rule binds the axes of that channel and the axes of no channel.

use std::collections::{BTreeMap, BTreeSet};

use super::coupling::Drafts;
use super::message::Message;
use super::parameter::Key;

/// P-AXIS-00297.
pub(super) const DEFAULT_NAME: Key = Key::new(297);

const LONGEST: usize = 16;
const UNNAMED: &str = "X_Achse";
const ALLOWED: &str = "up to 16 letters, digits and underscores, the first one of A B C U V W X Y Z Q";

/// What is wrong with a name, and the nearest name if there is one; `None` for a correct one.
pub(super) fn fault(name: &str) -> Option<(&'static str, Option<String>)> {
    let starts = name.starts_with(['A', 'B', 'C', 'U', 'V', 'W', 'X', 'Y', 'Z', 'Q']);
    if !starts || !name.chars().all(|letter| letter.is_alphanumeric() || letter == '_') {
        return Some((ALLOWED, None));
    }
    (name.chars().count() > LONGEST).then(|| (ALLOWED, Some(name.chars().take(LONGEST).collect())))
}

/// Checks and corrects the default names. Returns the axes that have a name of their own.
pub(super) fn check(axes: &mut Drafts<'_>, aliased: &BTreeSet<u16>, messages: &mut Vec<Message>) -> BTreeSet<u16> {
    let listed: BTreeSet<String> = axes.values().map(|axis| axis.word(DEFAULT_NAME).to_owned()).collect();
    let mut owners: BTreeMap<String, u16> = BTreeMap::new();
    for (number, axis) in &mut *axes {
        let name = axis.word(DEFAULT_NAME).to_owned();
        if aliased.contains(number) && !is_alias(&name) {
            let own = format!("A{number}");
            let is_free = is_alias(&own) && !listed.contains(&own);
            let used = if is_free { own.as_str() } else { UNNAMED };
            messages.push(axis.out_of_range(DEFAULT_NAME, "A1 … A32, because P-CHAN-00253 is 1", used));
            axis.set_word(DEFAULT_NAME, used);
            if is_free {
                owners.insert(own, *number);
            }
            continue;
        }
        if !axis.is_written(DEFAULT_NAME) {
            continue;
        }
        let mut used = name.clone();
        if let Some((allowed, nearest)) = fault(&name) {
            used = nearest.unwrap_or_else(|| UNNAMED.to_owned());
            messages.push(axis.out_of_range(DEFAULT_NAME, allowed, &used));
            axis.set_word(DEFAULT_NAME, &used);
            if used == UNNAMED {
                continue;
            }
        }
        match owners.get(&used) {
            Some(other) => {
                let allowed = format!("a name that no other axis has (axis {other} has it)");
                let used = format!("ax{number} as the only name of the axis");
                messages.push(axis.out_of_range(DEFAULT_NAME, &allowed, &used).with_axis(*other));
            }
            None => {
                owners.insert(used, *number);
            }
        }
    }
    owners.into_values().collect()
}

/// HG-25: A1 to A32.
fn is_alias(name: &str) -> bool {
    (1..=32).any(|number| name == format!("A{number}"))
}
