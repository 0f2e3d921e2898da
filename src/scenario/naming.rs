//! Names in a scenario: those of its machine, and those of the values that its steps captured.

use crate::expression::Scope;
use crate::image::Location;
use crate::machine::Machine;
use crate::source::{Problem, did_you_mean};
use crate::units::AxisNumber;
use crate::variables::Describe;

/// The names of a machine and of the values captured so far.
pub(super) struct Known<'a> {
    pub(super) machine: &'a Machine,
    pub(super) captured: &'a [String],
}

impl Scope for Known<'_> {
    fn describe(&self) -> &dyn Describe {
        self.machine
    }

    fn signal(&self, name: &str) -> Result<Location, Problem> {
        self.machine.signal(name)
    }

    fn named_values(&self) -> &[String] {
        self.captured
    }
}

/// The axis with this name.
pub(super) fn axis_named(machine: &Machine, name: &str) -> Result<AxisNumber, Problem> {
    let axes = &machine.names().axes;
    AxisNumber::all().find(|axis| axes[*axis].as_deref() == Some(name)).ok_or_else(|| {
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
    if plain && name != "time" {
        Ok(())
    } else {
        Err(Problem::new(
            format!("expected a plain name for a captured value, found `{name}`"),
            "use letters, digits and underscores; `time` is reserved",
        ))
    }
}

/// The location of any signal. A client of the control can write every signal; the NCK then overwrites its own signals.
pub(super) fn place_named(machine: &Machine, name: &str) -> Result<Location, Problem> {
    machine.names().resolve(machine.memory(), name)
}

/// The location of a signal that the NCK does not write.
pub(super) fn writable(machine: &Machine, name: &str) -> Result<Location, Problem> {
    let names = machine.names();
    let location = names.resolve(machine.memory(), name)?;
    names.check_writer(location)?;
    Ok(location)
}
