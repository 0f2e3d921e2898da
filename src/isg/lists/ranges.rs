//! START-UP CHECKS OF ONE AXIS: ranges, and values of a list that contradict each other (HG-06, HG-22, HG-26).
//!
//! `start` calls it for each axis before it compares masters and slaves. A value out of its range is an error, and the nearest allowed
//! value acts (O-34). Of two values that contradict each other, the resettable limit and the correction velocity give way.
//!
//! Decisions:
//!
//! - The limits of the gantry difference and the correction velocity must be set for slaves only. On other axes 0 is silent, other values
//!   are checked. The locked limit gives way where no resettable limit would be left: it then is one more than the resettable limit.
//! - Homing velocities and accelerations without an entry are reduced silently where their defaults are beyond the maximum of the axis.
//! - A rotary axis whose mode has none of the bits linear (0x1), optimised positioning (0x2) and modulo (0x4) gets the bit linear (110053),
//!   with the mode 0 the bit modulo (110353). A linear axis without the bit 0x1 gets it; only the mode 0 is a message (110353).
//! - Both gantry bits on one axis: the slave bit is removed, as its entry of a master is (110342). The slave bit of a spindle is removed.
//! - A word that is none of the allowed ones has no nearest one: the default acts.

use super::draft::Draft;
use super::message::{Code, ERROR, Message, WARNING};
use super::parameter::Key;

/// P-AXIS-00003.
pub(super) const A_EMERGENCY: Key = Key::new(3);
/// P-AXIS-00008.
pub(super) const A_MAX: Key = Key::new(8);
/// P-AXIS-00015.
pub(super) const MODE: Key = Key::new(15);
/// P-AXIS-00018.
pub(super) const KIND: Key = Key::new(18);
/// P-AXIS-00070.
pub(super) const MASTER: Key = Key::new(70);
/// P-AXIS-00071.
pub(super) const SECOND_LIMIT: Key = Key::new(71);
/// P-AXIS-00072.
pub(super) const FIRST_LIMIT: Key = Key::new(72);
/// P-AXIS-00075.
pub(super) const CORRECTION_VELOCITY: Key = Key::new(75);
/// P-AXIS-00126.
pub(super) const UPPER: Key = Key::new(126);
/// P-AXIS-00127.
pub(super) const LOWER: Key = Key::new(127);
/// P-AXIS-00285.
pub(super) const A_REF: Key = Key::new(285);
/// P-AXIS-00299.
pub(super) const HOMING: Key = Key::new(299);
/// P-AXIS-00704.
pub(super) const ON_MODE: Key = Key::new(704);

const OFFSET: Key = Key::new(73);
const VB_MAX: Key = Key::new(212);
const VB_REF_SLOW: Key = Key::new(218);
const VB_REF_FAST: Key = Key::new(219);
const STEPS: [Key; 2] = [Key::new(5), Key::new(6)];
const ON_EDGE: Key = Key::new(261);

/// The value of P-AXIS-00018 for a linear axis.
pub(super) const LINEAR: i64 = 1;
/// The value of P-AXIS-00018 for a rotary axis.
pub(super) const ROTARY: i64 = 2;
const SPINDLE: i64 = 4;

const MODE_LINEAR: i64 = 0x1;
const MODE_OPTIMISED: i64 = 0x2;
/// The bit "modulo" of P-AXIS-00015.
pub(super) const MODE_MODULO: i64 = 0x4;
const MODE_LINEAR_MODULO: i64 = 0x400;
const MODE_MASTER: i64 = 0x0001_0000;
const MODE_SLAVE: i64 = 0x0002_0000;
const LARGEST_MODE: i64 = 0x1000_0000;

const DEFAULT_UPPER: i64 = 3_600_000;
const DEFAULT_LOWER: i64 = 0;

/// The words of P-AXIS-00299. One table prints the second one without its T.
pub(super) const HOMINGS: [&str; 5] =
    ["CNC_CONTROLLED", "DRIVE_CONTROLLED", "DISABLED", "IGNORE_ABS_POS", "DRIVE_CONROLLED"];
/// The words of P-AXIS-00704.
pub(super) const ON_MODES: [&str; 4] = ["DEFAULT", "ONLY_CONTROL_UNIT", "EDGE_TRIGGERED", "CONFIG"];

/// Whether an axis is a gantry master.
pub(super) fn is_master(draft: &Draft<'_>) -> bool {
    draft.whole(MODE) & MODE_MASTER != 0
}

/// Whether an axis is a gantry slave.
pub(super) fn is_slave(draft: &Draft<'_>) -> bool {
    draft.whole(MODE) & MODE_SLAVE != 0
}

/// Whether an axis is a spindle.
pub(super) fn is_spindle(draft: &Draft<'_>) -> bool {
    draft.whole(KIND) == SPINDLE
}

/// Whether an axis is a modulo axis.
pub(super) fn is_modulo(draft: &Draft<'_>) -> bool {
    let bit = if draft.whole(KIND) == LINEAR { MODE_LINEAR_MODULO } else { MODE_MODULO };
    is_spindle(draft) || draft.whole(MODE) & bit != 0
}

/// Checks and corrects the values of one axis.
pub(super) fn check(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    kind(draft, messages);
    mode(draft, messages);
    dynamics(draft, messages);
    modulo(draft, messages);
    words(draft, messages);
    let offset = [i64::from(i32::MIN) + 1, i64::from(i32::MAX) - 1];
    limit(draft, OFFSET, offset, "", messages);
    monitoring(draft, is_slave(draft), messages);
}

/// Corrects a value that is outside two limits, with an error. `why` explains the limits.
fn limit(draft: &mut Draft<'_>, key: Key, [least, most]: [i64; 2], why: &str, messages: &mut Vec<Message>) {
    let value = draft.whole(key);
    let used = value.max(least).min(most);
    if used != value {
        let why = if why.is_empty() { String::new() } else { format!(" ({why})") };
        messages.push(draft.out_of_range(key, &format!("{least} … {most}{why}"), &used.to_string()));
        draft.set_whole(key, used);
    }
}

fn kind(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    let used = match draft.whole(KIND) {
        LINEAR | ROTARY | SPINDLE => return,
        0 => LINEAR,
        3 => ROTARY,
        _ => SPINDLE,
    };
    messages.push(draft.out_of_range(KIND, "1 (linear), 2 (rotary) or 4 (spindle)", &used.to_string()));
    draft.set_whole(KIND, used);
}

fn mode(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    let found = draft.whole(MODE);
    if found > LARGEST_MODE | (LARGEST_MODE - 1) {
        let used = found & (LARGEST_MODE | (LARGEST_MODE - 1));
        messages.push(draft.out_of_range(MODE, "0x1 … 0x10000000, bits", &format!("0x{used:x}")));
        draft.set_whole(MODE, used);
    }
    basic_mode(draft, messages);
    let mode = draft.whole(MODE);
    let without_slave = mode & !MODE_SLAVE;
    if mode & MODE_SLAVE == 0 {
        return;
    }
    let allowed = if mode & MODE_MASTER != 0 {
        "one of the bits 0x10000 (gantry master) and 0x20000 (gantry slave)"
    } else if is_spindle(draft) {
        "no bit 0x20000, because a spindle cannot be a gantry slave"
    } else {
        return;
    };
    messages.push(draft.out_of_range(MODE, allowed, &format!("0x{without_slave:x}")));
    draft.set_whole(MODE, without_slave);
}

/// 110053, 110353: a mode without a basic mode.
fn basic_mode(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    let (mode, is_linear) = (draft.whole(MODE), draft.whole(KIND) == LINEAR);
    let basic = if is_linear { MODE_LINEAR } else { MODE_LINEAR | MODE_OPTIMISED | MODE_MODULO };
    if mode & basic != 0 {
        return;
    }
    let (number, bit) = match mode {
        0 if is_linear => (Some(110_353), MODE_LINEAR),
        0 => (Some(110_353), MODE_MODULO),
        _ if is_linear => (None, MODE_LINEAR),
        _ if is_spindle(draft) => (None, MODE_MODULO),
        _ => (Some(110_053), MODE_LINEAR),
    };
    let used = mode | bit;
    if let Some(number) = number {
        let text =
            format!("{}, allowed 0x1 (linear), 0x2 (optimised) or 0x4 (modulo), used 0x{used:x}", draft.found(MODE));
        messages.push(draft.message(Code::Number(number), WARNING, MODE, &text));
    }
    draft.set_whole(MODE, used);
}

/// Velocities and accelerations, each within those that limit it.
fn dynamics(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    limit(draft, A_MAX, [1, 100_000_000], "", messages);
    limit(draft, VB_MAX, [1, 2_000_000_000], "", messages);
    let a_max = draft.whole(A_MAX);
    if draft.whole(A_EMERGENCY) != 0 {
        limit(draft, A_EMERGENCY, [1, 2 * a_max], &format!("P-AXIS-00008 is {a_max}"), messages);
    }
    for key in STEPS.into_iter().chain([A_REF]) {
        if draft.is_written(key) {
            limit(draft, key, [1, a_max], &format!("P-AXIS-00008 is {a_max}"), messages);
        } else {
            draft.set_whole(key, draft.whole(key).min(a_max));
        }
    }
    if !draft.is_written(A_REF) {
        draft.set_whole(A_REF, draft.whole(STEPS[0]).min(draft.whole(STEPS[1])));
    }
    for (key, above) in [(VB_REF_FAST, VB_MAX), (VB_REF_SLOW, VB_REF_FAST)] {
        let most = draft.whole(above);
        if draft.is_written(key) {
            let why = format!("P-AXIS-{:05} is {most}", above.number);
            limit(draft, key, [1, most], &why, messages);
        } else {
            draft.set_whole(key, draft.whole(key).min(most));
        }
    }
}

/// 110052, 110308: the modulo range of rotary axes, spindles and linear modulo axes.
fn modulo(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    if draft.whole(KIND) == LINEAR && !is_modulo(draft) {
        return;
    }
    let (upper, lower) = (draft.whole(UPPER), draft.whole(LOWER));
    let (number, allowed) = match upper - lower {
        ..=0 => (110_052, "more than the lower limit"),
        difference if difference >= i64::from(i32::MAX) => (110_308, "less than 2147483647 above the lower limit"),
        _ => return,
    };
    let text = format!(
        "{} with the lower limit P-AXIS-00127 = {lower}, allowed {allowed}, used {DEFAULT_UPPER} and {DEFAULT_LOWER}",
        draft.found(UPPER)
    );
    messages.push(draft.message(Code::Number(number), WARNING, UPPER, &text));
    draft.set_whole(UPPER, DEFAULT_UPPER);
    draft.set_whole(LOWER, DEFAULT_LOWER);
}

fn words(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    for (key, words, printed) in [(HOMING, &HOMINGS[..], 4), (ON_MODE, &ON_MODES[..], 4)] {
        if !words.contains(&draft.word(key)) {
            messages.push(draft.out_of_range(key, &words[..printed].join(", "), words[0]));
            draft.set_word(key, words[0]);
        }
    }
    if draft.word(HOMING) == HOMINGS[4] {
        draft.set_word(HOMING, HOMINGS[1]);
    }
}

/// The limits of the gantry difference and the correction velocity. They must be set on an axis that is bound.
pub(super) fn monitoring(draft: &mut Draft<'_>, is_bound: bool, messages: &mut Vec<Message>) {
    let most = i64::from(u32::MAX) - 1;
    let (first, second) = (draft.whole(FIRST_LIMIT), draft.whole(SECOND_LIMIT));
    // Below 2 no resettable limit is left.
    if second < 2 && (is_bound || second != 0) || second > most {
        let used = if second > most { most } else { (first + 1).clamp(2, most) };
        let allowed = "more than P-AXIS-00072 and less than 4294967295";
        messages.push(draft.out_of_range(SECOND_LIMIT, allowed, &used.to_string()));
        draft.set_whole(SECOND_LIMIT, used);
    }
    let second = draft.whole(SECOND_LIMIT);
    if is_bound || first != 0 {
        let (most, why) = match second {
            0 => (most, String::new()),
            _ => (second - 1, format!("P-AXIS-00071 is {second}")),
        };
        limit(draft, FIRST_LIMIT, [1, most], &why, messages);
    }
    if is_bound || draft.whole(CORRECTION_VELOCITY) != 0 {
        let vb_max = draft.whole(VB_MAX);
        let most = (vb_max - 1).max(1);
        limit(draft, CORRECTION_VELOCITY, [1, most], &format!("P-AXIS-00212 is {vb_max}"), messages);
    }
}

/// HG-12, 110606, E-22: with P-AXIS-00261, only two modes are possible.
pub(super) fn edge(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    let mode = draft.word(ON_MODE);
    if draft.whole(ON_EDGE) == 0 || mode == ON_MODES[0] || mode == ON_MODES[2] {
        return;
    }
    let text = format!(
        "{} with P-AXIS-00261 = 1, allowed DEFAULT or EDGE_TRIGGERED, used EDGE_TRIGGERED",
        draft.found(ON_MODE)
    );
    messages.push(draft.message(Code::Number(110_606), WARNING, ON_MODE, &text));
    draft.set_word(ON_MODE, ON_MODES[2]);
}

/// 110342: a master has no master.
pub(super) fn master_of_master(draft: &mut Draft<'_>, messages: &mut Vec<Message>) {
    if !is_master(draft) || draft.whole(MASTER) == 0 {
        return;
    }
    let text = format!("{}, allowed 0, because the axis is a gantry master, used 0", draft.found(MASTER));
    messages.push(draft.message(Code::Number(110_342), ERROR, MASTER, &text));
    draft.set_whole(MASTER, 0);
}
