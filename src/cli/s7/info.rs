//! `opennck s7 info`: what a module reports about itself. Values that it does not report are left out.

use super::arguments::Host;
use super::failure::Failure;
use crate::cli::list::{Format, List};
use crate::cli::output::Output;
use crate::controls;
use crate::s7::CpuState;
use crate::s7::client::{BlockKind, Client, Error, Value, Variable};
use crate::variables::AlarmNumber;

/// Maximum number of data blocks for which the length is requested.
const BLOCKS: usize = 200;
/// Maximum number of alarms shown.
const ALARMS: u16 = 16;

struct Rows(Vec<Vec<String>>);

impl Rows {
    /// Adds a row unless the value is empty.
    fn add(&mut self, what: &str, value: impl Into<String>) {
        let value = value.into();
        if !value.is_empty() {
            self.0.push(vec![what.to_owned(), value]);
        }
    }
}

pub(super) async fn info(host: &Host, format: Format, output: &mut Output) -> Result<u8, Failure> {
    let mut rows = Rows(Vec::new());
    let plc = host.plc().await?;
    rows.add("host", host.address()?);
    of_the_plc(&plc, &mut rows).await?;
    drop(plc);
    // A PLC without an NCK is not an error.
    match host.nck().await {
        Ok(nck) => of_the_nck(&nck, &mut rows).await?,
        Err(failure) => rows.add("NCK", format!("none: {}", failure.problem.what)),
    }
    Ok(List { heads: &["what", "value"], rows: rows.0 }.print(format, output))
}

/// A value that the module does not have is not an error; a failed connection is one.
fn optional<T>(result: Result<T, Error>) -> Result<Option<T>, Error> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(error) if error.is_of_the_connection() => Err(error),
        Err(_) => Ok(None),
    }
}

async fn of_the_plc(plc: &Client, rows: &mut Rows) -> Result<(), Error> {
    if let Some(negotiated) = plc.negotiated() {
        rows.add("PDU", format!("{} bytes, {} requests at once", negotiated.pdu, negotiated.jobs));
    }
    let identification = plc.identification().await?;
    rows.add("module", identification.module_name);
    rows.add("type", identification.module_type);
    rows.add("order number", identification.order_number);
    rows.add("firmware", identification.version);
    rows.add("system", identification.system_name);
    rows.add("plant", identification.plant);
    rows.add("serial number", identification.serial_number);
    rows.add("copyright", identification.copyright);
    if let Some(state) = optional(plc.cpu_state().await)? {
        rows.add(
            "state",
            match state {
                Some(CpuState::Run) => "RUN",
                Some(CpuState::Stop) => "STOP",
                None => "neither RUN nor STOP",
            },
        );
    }
    if let Some(Some(level)) = optional(plc.protection().await)? {
        rows.add("protection level", level.to_string());
    }
    if let Some(time) = optional(plc.clock().await)? {
        let date = format!("{:04}-{:02}-{:02}", time.year, time.month, time.day);
        let of_day = format!("{:02}:{:02}:{:02}.{:03}", time.hour, time.minute, time.second, time.millisecond);
        rows.add("clock", format!("{date} {of_day}"));
    }
    of_blocks(plc, rows).await
}

async fn of_blocks(plc: &Client, rows: &mut Rows) -> Result<(), Error> {
    if let Some(counts) = optional(plc.block_counts().await)? {
        let counts: Vec<_> = counts.iter().map(|count| format!("{} {}", count.count, count.kind.name())).collect();
        rows.add("blocks", counts.join(", "));
    }
    let Some(blocks) = optional(plc.blocks(BlockKind::Db).await)? else { return Ok(()) };
    for block in blocks.iter().take(BLOCKS) {
        if let Some(block) = optional(plc.describe_block(BlockKind::Db, block.number).await)? {
            rows.add(&format!("DB{}", block.number), format!("{} bytes", block.length));
        }
    }
    if blocks.len() > BLOCKS {
        rows.add("further data blocks", (blocks.len() - BLOCKS).to_string());
    }
    Ok(())
}

async fn of_the_nck(nck: &Client, rows: &mut Rows) -> Result<(), Error> {
    let names = (1..=31).map(|row| format!("N/$MN_AXCONF_MACHAX_NAME_TAB[{row}]"));
    let names = read(nck, names).await?;
    let mut axes = Vec::new();
    for (number, name) in (1_u8..).zip(names) {
        match name {
            Some(Value::Text(name)) if !name.is_empty() => axes.push((number, Value::Text(name).to_string())),
            _ => {}
        }
    }
    if axes.is_empty() {
        rows.add("NCK", "reports no axis names");
        return Ok(());
    }
    let positions = axes.iter().map(|(number, _)| format!("C/MachineAxis/actToolBasePos[{number}]"));
    let positions = read(nck, positions).await?;
    for ((number, name), position) in axes.iter().zip(positions) {
        let position = position.map(|position| format!(" at {position}")).unwrap_or_default();
        rows.add(&format!("axis {number}"), format!("{name}{position}"));
    }
    let state = ["B/State/opMode", "C/State/chanStatus", "N/State/numAlarms"];
    let state = read(nck, state.into_iter().map(ToOwned::to_owned)).await?;
    let word = |at: usize| match state.get(at) {
        Some(Some(Value::Word(value))) => Some(*value),
        _ => None,
    };
    let of = |number: Option<u16>, names: &[&str]| {
        number.and_then(|number| names.get(usize::from(number)).map(ToString::to_string))
    };
    rows.add("mode", of(word(0), &["JOG", "MDA", "AUTOMATIC"]).unwrap_or_default());
    rows.add("channel", of(word(1), &["reset", "active", "interrupted"]).unwrap_or_default());
    of_alarms(nck, word(2).unwrap_or(0), rows).await
}

/// The alarm numbers, and the text of each alarm in this program's catalogue.
async fn of_alarms(nck: &Client, count: u16, rows: &mut Rows) -> Result<(), Error> {
    if count == 0 {
        rows.add("alarms", "none");
        return Ok(());
    }
    let shown = 1..=count.min(ALARMS);
    let numbers = read(nck, shown.clone().map(|row| format!("N/AlarmList/textIndex[{row}]"))).await?;
    let fill = |row| (1..=4).map(move |fill| format!("N/AlarmList/fillText{fill}[{row}]"));
    let fills = read(nck, shown.flat_map(fill)).await?;
    let texts: Vec<String> = numbers.iter().flatten().map(ToString::to_string).collect();
    rows.add("alarms", format!("{count}: {}", texts.join(" ")));
    for (number, fills) in numbers.iter().zip(fills.chunks(4)) {
        if let Some(Value::DoubleInt(number)) = number {
            let number = AlarmNumber(number.cast_unsigned());
            rows.add(&format!("alarm {}", name(number)), text(number, fills));
        }
    }
    Ok(())
}

/// The name of an alarm.
fn name(number: AlarmNumber) -> String {
    let known = controls::texts().find_map(|texts| texts.alarm(number));
    known.map_or_else(|| number.0.to_string(), |alarm| alarm.name)
}

/// The text of an alarm. `%1` to `%4` are replaced by fill texts, whose first letter gives their kind.
fn text(number: AlarmNumber, fills: &[Option<Value>]) -> String {
    let known = controls::texts().find_map(|texts| texts.alarm(number));
    let mut text = known.map_or_else(String::new, |alarm| alarm.text.to_owned());
    for (index, fill) in (1..).zip(fills) {
        let fill = fill.as_ref().map(ToString::to_string).unwrap_or_default();
        let fill = fill.strip_prefix(['A', 'K', 'S']).unwrap_or(&fill);
        text = text.replace(&format!("%{index}"), fill);
    }
    text
}

/// NC variables by name; `None` for one that the NCK does not have.
async fn read(nck: &Client, names: impl Iterator<Item = String>) -> Result<Vec<Option<Value>>, Error> {
    let variables = names.map(|name| format!("nck:{name}").parse::<Variable>()).collect::<Result<Vec<_>, _>>()?;
    nck.read_all(&variables).await.into_iter().map(optional).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_alarm_has_its_text_with_what_the_control_fills_in() {
        let fills = [Some(Value::Text("KCHAN1".to_owned())), Some(Value::Text("S2".to_owned())), None, None];
        let expected = "channel CHAN1 waiting for synchronization start of gantry grouping 2";
        assert_eq!(text(AlarmNumber(10654), &fills), expected);
        assert_eq!(text(AlarmNumber(999_999), &fills), "", "it is not in the catalogue");
    }
}
