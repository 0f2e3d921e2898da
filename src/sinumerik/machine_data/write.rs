//! Writes an archive in the export syntax of the control.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::control::Owner;
use crate::units::ChannelNumber;

use super::Archive;

impl Archive {
    /// The archive as an ASCII file: given and unknown data, in sections by channel. Reading it again gives the same
    /// archive. Values that were never given are not written and keep their defaults.
    #[must_use]
    pub fn write(&self) -> String {
        let mut sections = BTreeMap::<ChannelNumber, String>::new();
        sections.insert(ChannelNumber::FIRST, String::new());
        for target in self.given.keys() {
            let datum = target.datum();
            let Some(value) = self.data.get(target) else {
                continue;
            };
            // The control exports general and axis data in the section of channel 1.
            let channel = match target.owner() {
                Owner::Channel(channel) => channel,
                Owner::Nck | Owner::Axis(_) => ChannelNumber::FIRST,
            };
            let section = sections.entry(channel).or_default();
            // Writing into a String cannot fail.
            let _ = writeln!(section, "N{} {target}={}", datum.number, value.export(datum.kind));
        }
        let tables = sections.entry(ChannelNumber::FIRST).or_default();
        for line in self.data.table_lines() {
            let _ = writeln!(tables, "{line}");
        }
        for unknown in &self.unknown {
            let section = sections.entry(unknown.channel).or_default();
            let number = unknown.number.map(|number| format!("N{number} ")).unwrap_or_default();
            let _ = writeln!(section, "{number}{}={}", unknown.name, unknown.value);
        }
        let mut text = format!("%_N_INITIAL_INI\n;$PATH=/\n{}\n\n", self.data.system().word());
        for (channel, section) in sections {
            let _ = write!(text, "CHANDATA({channel})\n{section}");
        }
        text.push_str("M17\n");
        text
    }
}
