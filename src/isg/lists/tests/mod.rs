//! Tests of the parameter lists: from files to axes, channels and messages. Each cites the rules that it covers, and the cases of the
//! acceptance list (B43 to B54).

mod any_bytes;
mod axes;
mod channels;
mod coupling;
mod examined;
mod names;
mod reading;
mod writing;

use crate::control::Value;
use crate::source::Problem;

use super::{Axis, Lists, Message, PARAMETERS, Parameter, Started};

/// A linear gantry master with the logical number 1.
const MASTER: &str = "kopf.achs_nr 1\nkenngr.achs_typ 1\nkenngr.achs_mode 0x00010001\ngetriebe[0].dynamik.a_max 1000\n";

/// The rest of the list of a slave of axis 1: resettable limit 0.1 mm, locked limit 0.5 mm, correction velocity 1 mm/s.
const SLAVE: &str = "kenngr.achs_typ 1\nkenngr.achs_mode 0x00020001\nkenngr.gantry_ax_nr 1\n\
    kenngr.gantry_max_diff_resetable 1000\nkenngr.gantry_max_diff_reset_locked 5000\nkenngr.gantry_offset 0\n\
    kenngr.gantry_vb_korr 1000\n";

/// A channel with axis 1 as X.
const CHANNEL: &str = "gruppe[0].achs_anzahl 1\ngruppe[0].achse[0].bezeichnung X\ngruppe[0].achse[0].log_achs_nr 1\n";

fn read(files: &[(&str, &str)]) -> Result<Lists, Problem> {
    Lists::read(files)
}

fn start(files: &[(&str, &str)]) -> Started {
    read(files).unwrap().start()
}

/// The combination of the manual: X with the slaves 5 and 6. Added lines replace those of the fixture.
fn hard(master: &str, slave: &str, channel: &str) -> Started {
    let files = hard_files(master, slave, channel);
    let files: Vec<(&str, &str)> = files.iter().map(|(name, text)| (*name, text.as_str())).collect();
    start(&files)
}

fn hard_files(master: &str, slave: &str, channel: &str) -> Vec<(&'static str, String)> {
    vec![
        ("x.lis", format!("{MASTER}{master}")),
        ("x1.lis", format!("kopf.achs_nr 5\nkopf.log_achs_name Axis_X1\n{SLAVE}{slave}")),
        ("x2.lis", format!("kopf.achs_nr 6\nkopf.log_achs_name Axis_X2\n{SLAVE}")),
        ("channel.lis", format!("{CHANNEL}{channel}")),
    ]
}

fn axis(started: &Started, number: u16) -> &Axis {
    started.axis(number).unwrap()
}

/// The messages as `code class axis`.
fn codes(messages: &[Message]) -> Vec<String> {
    let row = |message: &Message| {
        let axis = message.axis.map_or_else(|| "-".to_owned(), |axis| axis.to_string());
        format!("{} {} {axis}", message.code, message.class)
    };
    messages.iter().map(row).collect()
}

fn whole(axis: &Axis, name: &str) -> i64 {
    axis.value(name).and_then(Value::whole).unwrap()
}

/// Lists and what a start makes of them are saved with a machine.
#[test]
fn lists_survive_saving() {
    let mut lists = Lists::read(&hard_files("", "getriebe[0].dynamik.a_max 500\nkenngr.swe_pos 5\n", "")).unwrap();
    let started = lists.start();
    assert_eq!(started.messages.len(), 1);
    let bytes = postcard::to_stdvec(&(&lists, &started)).unwrap();
    assert_eq!(postcard::from_bytes::<(Lists, Started)>(&bytes).unwrap(), (lists, started));
}

/// The page for users has the table of parameters as it is.
#[test]
fn the_page_of_parameter_lists_has_each_parameter() {
    let page = include_str!("../../../../docs/parameter_lists.md");
    let (_, table) = page.split_once("## Parameters").unwrap();
    let printed: Vec<&str> = table.lines().filter(|line| line.starts_with("| P-")).collect();
    let row = |parameter: &Parameter| {
        let name = parameter.name.map_or_else(|| "–".to_owned(), |name| format!("`{name}`"));
        let unit = if parameter.units[0] == parameter.units[1] {
            parameter.units[0].to_owned()
        } else {
            parameter.units.join(" / ")
        };
        let columns = [
            parameter.id(),
            name,
            parameter.kind.to_string(),
            unit,
            parameter.range.to_owned(),
            parameter.default.to_owned(),
            parameter.effect.to_string(),
            parameter.meaning.to_owned(),
            if parameter.is_modelled { "yes" } else { "–" }.to_owned(),
        ];
        let columns = columns.map(|column| if column.is_empty() { " ".to_owned() } else { format!(" {column} ") });
        format!("|{}|", columns.join("|"))
    };
    let expected: Vec<String> = PARAMETERS.iter().map(row).collect();
    assert_eq!(printed, expected, "expected in docs/parameter_lists.md:\n{}", expected.join("\n"));
}
