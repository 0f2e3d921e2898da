//! Names in a scenario: those of its machine, and those of the values that its steps captured.

use crate::expression::Scope;
use crate::image::{Block, Location};
use crate::machine::Machine;
use crate::source::{Problem, did_you_mean};
use crate::trace::value_as_signal;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};
use crate::variables::{Describe, NamedValue, is_r_parameter};

/// The names of a machine and of the values captured so far.
pub(super) struct Known<'a> {
    pub(super) machine: &'a Machine,
    pub(super) captured: &'a [String],
    /// Stored machine data may have given the machine other mode groups.
    pub(super) is_reconfigured: bool,
}

impl Scope for Known<'_> {
    fn describe(&self) -> &dyn Describe {
        self.machine
    }

    fn signal(&self, name: &str) -> Result<Location, Problem> {
        let location = self.machine.signal(name)?;
        // The symbols of axes and channels that do not exist are unknown; those of mode groups are not.
        let is_symbol_of_a_mode_group = name.starts_with(|c: char| c.is_ascii_lowercase());
        if is_symbol_of_a_mode_group && !self.is_reconfigured {
            return missing_owner(self.machine, location).map_or(Ok(location), Err);
        }
        Ok(location)
    }

    fn named_values(&self) -> &[String] {
        self.captured
    }
}

/// The axis with this name.
pub(super) fn axis_named(machine: &Machine, name: &str) -> Result<AxisNumber, Problem> {
    let axes = &machine.names().axes;
    machine.names().axis(name).ok_or_else(|| {
        let known: Vec<_> = AxisNumber::all().filter_map(|axis| axes[axis].as_deref()).collect();
        let fallback = format!("machine axes are {}", known.join(", "));
        Problem::new(
            format!("expected a machine axis, found `{name}`"),
            did_you_mean(name, known.iter().copied(), &fallback),
        )
    })
}

/// Checks the name of a captured value: it must be a plain name without another meaning.
pub(super) fn check_captured_name(name: &str) -> Result<(), Problem> {
    let plain = name.starts_with(|c: char| c.is_alphabetic() || c == '_')
        && name.chars().all(|c| c.is_alphanumeric() || c == '_');
    if is_r_parameter(name) {
        return Err(Problem::new(
            format!("expected a plain name for a captured value, found the R parameter `{name}`"),
            "use another name, such as `before`",
        ));
    }
    if plain && name != "time" {
        Ok(())
    } else {
        Err(Problem::new(
            format!("expected a plain name for a captured value, found `{name}`"),
            "use letters, digits and underscores; `time` is reserved",
        ))
    }
}

/// The problem of a name that is no signal: a value cannot be written like one.
fn no_signal(machine: &Machine, name: &str, unknown: Problem) -> Problem {
    let known = NamedValue::named(name, machine.names(), |channel| machine.r_parameter_count(channel));
    let cure = match known {
        Err(problem) => return problem,
        Ok(None) => return unknown,
        Ok(Some(NamedValue::RParameter(..))) => format!("write r_parameters = {{ \"{name}\" = 1.5 }}"),
        Ok(Some(NamedValue::Program(_))) => "select a program with `program` or `nc`; `watch` shows it".to_owned(),
        // The problem says already what an axis value is.
        Ok(Some(NamedValue::Axis(..))) => return unknown,
        Ok(Some(NamedValue::Block(_))) => {
            format!("`{name}` can only be read: in `wait`, `hold`, `expect`, `capture` and `watch`")
        }
    };
    Problem::new(format!("expected a signal, found the value `{name}`"), cure)
}

/// The location of any signal. A client of the control can write every signal; the NCK then overwrites its own signals.
pub(super) fn place_named(machine: &Machine, name: &str) -> Result<Location, Problem> {
    signal_named(machine, name)
}

/// The location of a signal. A value of an axis is none.
pub(super) fn signal_named(machine: &Machine, name: &str) -> Result<Location, Problem> {
    let names = machine.names();
    names.resolve(machine.memory(), name).map_err(|problem| match name.split_once('.') {
        Some((axis, _)) if names.axis(axis).is_some() => value_as_signal(problem, name),
        Some(_) | None => problem,
    })
}

/// The location of a signal that the NCK does not write, of an axis or channel that exists.
pub(super) fn writable(machine: &Machine, name: &str) -> Result<Location, Problem> {
    let location = written_by_others(machine, name)?;
    missing_owner(machine, location).map_or(Ok(location), Err)
}

/// The location of a signal that the NCK does not write.
pub(super) fn written_by_others(machine: &Machine, name: &str) -> Result<Location, Problem> {
    let names = machine.names();
    if let Ok((location, Some(_))) = names.resolve_written(machine.memory(), name) {
        return Ok(location);
    }
    let location = signal_named(machine, name).map_err(|problem| no_signal(machine, name, problem))?;
    names.check_writer(location)?;
    Ok(location)
}

/// The bit that is written with a signal: the enable of a control unit.
pub(super) fn enable_of(machine: &Machine, name: &str) -> Option<Location> {
    machine.names().resolve_written(machine.memory(), name).ok()?.1
}

/// The problem of a signal whose axis, channel or mode group this machine does not have: nothing would read what is written there.
pub(super) fn missing_owner(machine: &Machine, location: Location) -> Option<Problem> {
    let names = machine.names();
    let (number, signal) = names.interface().touching(location).next()?;
    let exists = match signal.block {
        Block::Axis => AxisNumber::new(number).is_some_and(|axis| names.axes[axis].is_some()),
        Block::Channel => ChannelNumber::new(number).is_some_and(|channel| machine.has_channel(channel)),
        Block::ModeGroup => ModeGroupNumber::new(number).is_some_and(|group| machine.has_mode_group(group)),
        Block::Nck => true,
    };
    let (kind, known): (_, Vec<&str>) = match signal.block {
        Block::Axis => ("axis", AxisNumber::all().filter_map(|axis| names.axes[axis].as_deref()).collect()),
        Block::Channel => {
            let existing = ChannelNumber::all().filter(|channel| machine.has_channel(*channel));
            ("channel", existing.filter_map(|channel| names.channels[channel].as_deref()).collect())
        }
        Block::ModeGroup => {
            let existing = ModeGroupNumber::all().filter(|group| machine.has_mode_group(*group));
            ("mode group", existing.filter_map(|group| names.owner(Block::ModeGroup, group.number())).collect())
        }
        Block::Nck => return None,
    };
    (!exists).then(|| {
        let (address, known) = (names.address(location), known.join(", "));
        Problem::new(
            format!("expected a signal of an existing {kind}, found {address} of {kind} {number}"),
            format!("the machine has {known}"),
        )
    })
}
