//! Writing an archive in the syntax in which the control exports it.

use std::collections::BTreeMap;
use std::fmt::Write;

use crate::control::Owner;
use crate::units::ChannelNumber;

use super::Archive;

impl Archive {
    /// The archive as an ASCII file: what was given and what is unknown, in sections by channel. Read again it is the
    /// same archive; values that were never given keep their defaults by not being written.
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
        for unknown in &self.unknown {
            let section = sections.entry(unknown.channel).or_default();
            let number = unknown.number.map(|number| format!("N{number} ")).unwrap_or_default();
            let _ = writeln!(section, "{number}{}={}", unknown.name, unknown.value);
        }
        let mut text = "%_N_INITIAL_INI\n;$PATH=/\nMETRIC\n\n".to_owned();
        for (channel, section) in sections {
            let _ = write!(text, "CHANDATA({channel})\n{section}");
        }
        text.push_str("M17\n");
        text
    }
}
