//! The function generator in a step: its table, and the words of its signals.

use super::duration::Duration;
use super::fields::duration;
use super::naming::axis_named;
use super::steps::Reader;
use crate::machine::{Command, FunctionGenerator, Machine, Waveform};
use crate::source::{Node, Place, Problem, Table, Value};
use crate::units::Time;

/// The words of the signals.
const SIGNALS: [(&str, Waveform); 3] =
    [("sine", Waveform::Sine), ("square", Waveform::Square), ("triangle", Waveform::Triangle)];

/// The signal of a word.
pub(super) fn waveform(word: &str) -> Option<Waveform> {
    SIGNALS.iter().find(|(other, _)| *other == word).map(|(_, signal)| *signal)
}

/// What a function generator with an unknown signal should say.
pub(super) fn waveforms() -> String {
    format!("write one of {}", SIGNALS.map(|(word, _)| format!("\"{word}\"")).join(", "))
}

/// A duration as a time; cycles are those of now.
pub(super) fn time_of(duration: Duration, machine: &Machine) -> Time {
    match duration {
        Duration::Time(time) => time,
        Duration::Cycles(cycles) => machine.cycle_time().times(cycles),
    }
}

/// The step that gives the function generator this signal.
pub(super) fn generator_text(wanted: &FunctionGenerator, machine: &Machine) -> String {
    let axis = machine.names().axes[wanted.axis].as_deref().unwrap_or_default();
    let signal = SIGNALS.iter().find(|(_, other)| *other == wanted.signal).map_or("", |(word, _)| word);
    let [own, coupled] = wanted.amplitude;
    format!(
        "{{ axis = {axis:?}, signal = \"{signal}\", amplitude = [{own:?}, {coupled:?}], offset = {:?}, frequency = {:?}, duration = \"{}us\" }}",
        wanted.offset,
        wanted.frequency,
        wanted.duration.nanos() as f64 / 1e3
    )
}

impl Reader<'_> {
    /// `{ axis = "X", signal = "sine", amplitude = [0.1, 0.05], offset = 0.0, frequency = 10.0, duration = "2s" }`.
    pub(super) fn generator(&self, node: Node) -> Result<Command, Problem> {
        let place = node.place.clone();
        let mut table = node.into_table("a function generator, as { axis = \"X\", amplitude = 0.1, … }")?;
        let axis = needed(&mut table, &place, "axis", "axis = \"X\"")?;
        let named = axis_named(self.machine, axis.text("a machine axis")?);
        let number = named.map_err(|problem| problem.at(&axis.place))?;
        let signal = match table.take("signal") {
            None => Waveform::Sine,
            Some(node) => {
                let found = waveform(node.text("the signal of the function generator")?);
                found.ok_or_else(|| node.expected("the signal of the function generator", &waveforms()))?
            }
        };
        let amplitude = amplitudes(needed(&mut table, &place, "amplitude", "amplitude = [0.1, 0.05]")?)?;
        let offset = table.take("offset").map_or(Ok(0.0), |node| node.number("an offset in mm or degrees"))?;
        let frequency = needed(&mut table, &place, "frequency", "frequency = 10.0")?.number("a frequency in hertz")?;
        let time = duration(&needed(&mut table, &place, "duration", "duration = \"2s\"")?, "a duration")?;
        table.finish()?;
        let duration = time_of(time, self.machine);
        Ok(Command::FunctionGenerator(FunctionGenerator {
            axis: number,
            signal,
            amplitude,
            offset,
            frequency,
            duration,
        }))
    }
}

fn needed(table: &mut Table, place: &Place, key: &'static str, example: &str) -> Result<Node, Problem> {
    table.take(key).ok_or_else(|| {
        place.problem(format!("expected `{key}` in a function generator, found none"), format!("write {example}"))
    })
}

/// One amplitude for all axes, or that of the leading axis and that of the coupled axes.
fn amplitudes(node: Node) -> Result<[f64; 2], Problem> {
    const WHAT: &str = "an amplitude in mm or degrees";
    if !matches!(node.value, Value::Array(_)) {
        return node.number(WHAT).map(|one| [one; 2]);
    }
    let place = node.place.clone();
    let values = node.into_list().iter().map(|one| one.number(WHAT)).collect::<Result<Vec<_>, _>>()?;
    <[f64; 2]>::try_from(values).map_err(|values| {
        let found = format!("expected an amplitude, or two of them, found {}", values.len());
        place.problem(found, "write amplitude = [0.1, 0.05]: that of the leading axis, then that of the coupled axes")
    })
}
