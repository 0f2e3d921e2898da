//! `opennck s7 szl`: prints a system state list, one record per line: in hexadecimal, and its meaning if known.

use super::arguments::Host;
use super::failure::Failure;
use crate::cli::list::{Format, List};
use crate::cli::output::Output;

pub(super) async fn szl(host: &Host, id: u16, index: u16, format: Format, output: &mut Output) -> Result<u8, Failure> {
    let plc = host.plc().await?;
    let list = plc.list(id, index).await?;
    if format == Format::Table {
        let name = name(id);
        let name = if name.is_empty() { String::new() } else { format!(", {name}") };
        output.line(format!("SZL {id:04X} index {index:04X}{name}: {} records of {} bytes", list.count, list.record));
    }
    let row = |(number, record): (usize, &[u8])| {
        let hex: Vec<String> = record.iter().map(|byte| format!("{byte:02X}")).collect();
        vec![number.to_string(), hex.join(" "), meaning(id, record)]
    };
    let rows = (1..).zip(list.records()).map(row).collect();
    Ok(List { heads: &["record", "hex", "meaning"], rows }.print(format, output))
}

/// The content of a list. The number of the list is in the low byte of the ID.
fn name(id: u16) -> &'static str {
    match id & 0xFF {
        0x00 => "all lists",
        0x11 => "identification of the module",
        0x12 => "features of the CPU",
        0x13 => "memories",
        0x14 => "areas",
        0x15 => "types of block",
        0x19 | 0x74 => "lamps",
        0x1C => "identification of a component",
        0x22 => "interrupts",
        0x24 => "operating states",
        0x31 | 0x32 => "communication",
        0xA0 => "diagnostic buffer",
        _ => "",
    }
}

fn meaning(id: u16, record: &[u8]) -> String {
    /// Index 9 of list 1C, the only numeric one.
    const MANUFACTURER: u16 = 9;
    let word = |at: usize| record.get(at..at + 2).map(|word| u16::from_be_bytes([word[0], word[1]]));
    let lookup = |number: Option<u16>, names: &[(u16, &str)]| {
        let found = names.iter().find(|(known, _)| Some(*known) == number);
        found.map(|(_, name)| (*name).to_owned())
    };
    let known = match id & 0xFF {
        0x00 => word(0).map(|list| name(list).to_owned()),
        0x11 => {
            let what = lookup(word(0), &[(1, "module"), (6, "hardware"), (7, "firmware")]);
            what.map(|what| format!("{what} {}", printable(record.get(2..22).unwrap_or_default())))
        }
        0x1C => {
            let names = [
                (1, "system"),
                (2, "module"),
                (3, "plant"),
                (4, "copyright"),
                (5, "serial number"),
                (7, "type"),
                (8, "memory card"),
                (MANUFACTURER, "manufacturer"),
                (0xB, "location"),
            ];
            let text = || printable(record.get(2..).unwrap_or_default());
            let number = || format!("{:04X}", word(2).unwrap_or_default());
            let is_number = word(0) == Some(MANUFACTURER);
            lookup(word(0), &names).map(|what| format!("{what}: {}", if is_number { number() } else { text() }))
        }
        0x19 | 0x74 => {
            let names = [(1, "SF"), (4, "RUN"), (5, "STOP"), (6, "FRCE"), (11, "BUS1F"), (12, "BUS2F"), (21, "MAINT")];
            let state = if record.get(2) == Some(&1) { "on" } else { "off" };
            lookup(word(0), &names).map(|lamp| format!("{lamp} {state}"))
        }
        0x24 => lookup(
            record.get(3).map(|state| u16::from(*state)),
            &[
                (1, "STOP (update)"),
                (3, "STOP"),
                (4, "STOP"),
                (5, "start-up"),
                (6, "start-up"),
                (7, "start-up"),
                (8, "RUN"),
                (10, "HOLD"),
            ],
        ),
        0x32 if word(0) == Some(4) => word(6).map(|level| format!("protection level {level}")),
        0xA0 => word(0).map(|event| format!("event {event:04X}")),
        _ => None,
    };
    known.unwrap_or_else(|| printable(record)).trim_end().to_owned()
}

/// The printable characters; a point replaces each of the others.
fn printable(bytes: &[u8]) -> String {
    let end = bytes.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1);
    let shown = |byte: &u8| if (0x20..0x7F).contains(byte) { char::from(*byte) } else { '.' };
    bytes[..end].iter().map(shown).collect::<String>().trim().to_owned()
}
