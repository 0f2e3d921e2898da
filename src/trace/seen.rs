//! What a trace has seen of a machine, whatever it watches: alarms, rules, bits that changed.

use std::collections::{BTreeMap, BTreeSet};

use super::{Change, Trace};
use crate::image::Part;
use crate::variables::{AlarmNumber, RuleNumber};

impl Trace {
    /// The alarms that were raised.
    #[must_use]
    pub fn alarms_raised(&self) -> BTreeSet<AlarmNumber> {
        let raised = |change: &Change| match change {
            Change::Alarm { alarm, raised: true, .. } => Some(alarm.number),
            Change::Alarm { .. }
            | Change::Byte { .. }
            | Change::Happened { .. }
            | Change::Overwritten { .. }
            | Change::NoEffect(_) => None,
        };
        self.others.iter().filter_map(|row| raised(&row.change)).collect()
    }

    /// The rules behind the events of the control, each once.
    #[must_use]
    pub fn rules_used(&self) -> Vec<RuleNumber> {
        let used: BTreeSet<u16> = self.events.iter().map(|event| event.rule.0).collect();
        used.into_iter().map(RuleNumber).collect()
    }

    /// The bits that changed: they had both values. A part of the memory with the offset of a byte, and the bits of this byte.
    #[must_use]
    pub fn bits_changed(&self) -> BTreeMap<(Part, u32), u8> {
        let mut changed = BTreeMap::new();
        for bits in &self.bits {
            *changed.entry((bits.part, bits.offset)).or_default() |= bits.old ^ bits.new;
        }
        changed
    }
}
