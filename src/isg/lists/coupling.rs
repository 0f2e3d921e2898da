//! START-UP CHECKS OF GANTRY COMBINATIONS: which slave belongs to which master, and the values that slaves take from their masters
//! (HG-01, HG-04, HG-18, isg.md 2.2).
//!
//! Decisions:
//!
//! - The values of the lists are compared after the correction of ranges, so a_emergency 0 and a_max differ although they act alike.
//! - Each of the parameters has a warning of its own, also the two of the modulo mode and the two of the modulo range (O-35).
//! - A slave that names no usable master is a slave without a combination: it belongs to no channel and is not coupled. It names none, or
//!   an axis without a list, or itself (error), or an axis without the master bit (70124), or a spindle (error).
//! - An axis that names a master and has no slave bit is an error and stays an axis of its own.

use std::collections::BTreeMap;

use super::draft::Draft;
use super::message::{Code, ERROR, Message, WARNING, short};
use super::parameter::Key;
use super::ranges::{
    A_EMERGENCY, A_MAX, HOMING, KIND, LOWER, MASTER, MODE, MODE_MODULO, UPPER, is_master, is_slave, is_spindle,
    master_of_master,
};

/// The parameters that a slave takes from its master, in the order of the manual. Of P-AXIS-00015 only the bit "modulo".
const EQUAL: [Key; 9] = [KIND, MODE, UPPER, LOWER, A_MAX, A_EMERGENCY, Key::new(254), HOMING, Key::new(367)];

/// The axes by logical number.
pub(super) type Drafts<'a> = BTreeMap<u16, Draft<'a>>;

/// The master of each coupled slave.
pub(super) fn masters(axes: &mut Drafts<'_>, messages: &mut Vec<Message>) -> BTreeMap<u16, u16> {
    for axis in axes.values_mut() {
        master_of_master(axis, messages);
    }
    let mut masters = BTreeMap::new();
    for (number, axis) in &*axes {
        match master(axis, axes) {
            Ok(Some(master)) => {
                masters.insert(*number, master);
            }
            Ok(None) => {}
            Err(message) => messages.push(message),
        }
    }
    masters
}

/// The master of an axis; an error names the reason why a slave has none.
fn master(axis: &Draft<'_>, axes: &Drafts<'_>) -> Result<Option<u16>, Message> {
    let named = u16::try_from(axis.whole(MASTER)).unwrap_or(0);
    if !is_slave(axis) {
        if named == 0 || is_master(axis) || is_spindle(axis) {
            return Ok(None);
        }
        let text = format!(
            "{}, expected the bit 0x20000 (gantry slave), because P-AXIS-00070 names the master {named}; used: no coupling",
            axis.found(MODE)
        );
        return Err(axis.message(Code::Parameter(MODE.number), ERROR, MODE, &text).with_axis(named));
    }
    let problem = |allowed: &str| axis.out_of_range(MASTER, allowed, "no coupling");
    if named == 0 {
        return Err(problem("the logical number of the gantry master of this slave"));
    }
    if named == axis.number() {
        return Err(problem("the logical number of another axis"));
    }
    let Some(of) = axes.get(&named) else {
        return Err(problem("the logical number of an axis that has a list"));
    };
    if !is_master(of) {
        let text = format!(
            "{}, but axis {named} is not configured as gantry master (P-AXIS-00015 is {}); used: no coupling",
            axis.found(MASTER),
            of.shown(MODE)
        );
        return Err(axis.message(Code::Number(70_124), WARNING, MASTER, &text).with_axis(named));
    }
    if is_spindle(of) {
        return Err(problem("a linear or rotary axis").with_axis(named));
    }
    Ok(Some(named))
}

/// Gives each slave the values of its master that must be equal, with a warning for each that differs.
pub(super) fn adopt(axes: &mut Drafts<'_>, masters: &BTreeMap<u16, u16>, messages: &mut Vec<Message>) {
    for (slave, master) in masters {
        // A master is no slave, so its values do not change here.
        let Some(master) = axes.get(master).cloned() else { continue };
        let Some(slave) = axes.get_mut(slave) else { continue };
        for key in EQUAL {
            if key == MODE {
                modulo_mode(slave, &master, messages);
            } else if !slave.equals(key, &master) {
                let found = slave.found(key);
                messages.push(difference(slave, &master, key, &found));
                slave.take(key, &master);
            }
        }
    }
}

/// The bit "modulo" of P-AXIS-00015.
fn modulo_mode(slave: &mut Draft<'_>, master: &Draft<'_>, messages: &mut Vec<Message>) {
    let wanted = master.whole(MODE) & MODE_MODULO;
    if slave.whole(MODE) & MODE_MODULO != wanted {
        let found = format!("{} (bit 0x4, modulo, differs)", slave.found(MODE));
        messages.push(difference(slave, master, MODE, &found));
        let basic = if wanted == 0 { master.whole(MODE) & 0x3 } else { 0 };
        slave.set_whole(MODE, slave.whole(MODE) & !MODE_MODULO | wanted | basic);
    }
}

/// HG-04: the warning that a slave takes the value of its master.
fn difference(slave: &Draft<'_>, master: &Draft<'_>, key: Key, found: &str) -> Message {
    let code = if key == UPPER || key == LOWER { Code::Number(70_202) } else { Code::Parameter(key.number) };
    let text = format!(
        "{found}, its gantry master axis {} has {} ({}); used: the value of the master",
        master.number(),
        master.shown(key),
        short(&master.place(key))
    );
    slave.message(code, WARNING, key, &text).with_axis(master.number())
}
