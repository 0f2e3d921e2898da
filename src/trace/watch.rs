//! The selection of a trace: patterns over symbols and addresses, and the names of values.

use super::printable::{Printable, printable};
use crate::image::{Block, Location, Memory, Names, Part, Signal};
use crate::source::{Problem, did_you_mean, nearest};
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{AxisValue, NamedValue, Variables};

/// The signals and values that a trace shows. The default is every signal of the catalogue and every input and output that changed, without
/// values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Watch {
    /// `None` selects the default.
    chosen: Option<Chosen>,
    /// The default, and every bit of the areas and data blocks of the PLC program, every timer and every counter, and these bytes and words.
    every_bit: Option<Vec<Location>>,
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Chosen {
    /// Patterns with `*`, over symbols and addresses.
    patterns: Vec<String>,
    /// Locations that are named individually.
    locations: Vec<Location>,
    values: Vec<WatchedItem>,
}

/// A value to record, and how far it must have moved since its last row for another row, in its own unit; 0 for every change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct WatchedItem {
    pub(super) value: NamedValue,
    pub(super) step: f64,
}

impl Watch {
    /// Reads names, addresses and patterns, such as `X.*`, `DB33.DBX101.*`, `M10.3`, `X.position`, `CHAN1.block`, `R5`.
    ///
    /// # Errors
    /// One of the entries, given by its index, matches nothing.
    pub fn parse(
        entries: &[&str],
        names: &Names,
        memory: &Memory,
        variables: &Variables,
    ) -> Result<Self, (usize, Problem)> {
        let entries: Vec<_> = entries.iter().map(|entry| (*entry, None)).collect();
        Self::parse_stepped(&entries, names, memory, variables)
    }

    /// The same with the step of a value, in its own unit: a row where the value has moved by at least this much since its last row.
    ///
    /// # Errors
    /// One of the entries, given by its index, matches nothing, or has a step and is no value of an axis.
    pub fn parse_stepped(
        entries: &[(&str, Option<f64>)],
        names: &Names,
        memory: &Memory,
        variables: &Variables,
    ) -> Result<Self, (usize, Problem)> {
        let mut chosen = Chosen::default();
        for (index, (entry, step)) in entries.iter().enumerate() {
            chosen.add(entry, *step, names, (memory, variables)).map_err(|problem| (index, problem))?;
        }
        // The finest step of a value that is named twice counts.
        chosen.values.sort_by(|one, other| one.value.cmp(&other.value).then(one.step.total_cmp(&other.step)));
        chosen.values.dedup_by_key(|item| item.value);
        Ok(Self { chosen: Some(chosen), every_bit: None })
    }

    /// Every signal, and every bit, timer and counter of the PLC program, and these bytes and words of it, that changed.
    pub(super) fn every_bit(words: impl IntoIterator<Item = Location>) -> Self {
        Self { chosen: None, every_bit: Some(words.into_iter().collect()) }
    }

    /// Whether it shows what changes without a statement, such as a timer that runs, only if it is named.
    pub(super) fn is_of_everything(&self) -> bool {
        self.chosen.as_ref().is_none_or(|chosen| chosen.locations.is_empty())
    }

    /// The selected values.
    pub fn values(&self) -> impl Iterator<Item = NamedValue> {
        self.items().map(|item| item.value)
    }

    pub(super) fn items(&self) -> impl Iterator<Item = WatchedItem> {
        self.chosen.iter().flat_map(|chosen| chosen.values.iter().copied())
    }

    pub(super) fn locations(&self) -> &[Location] {
        self.chosen.as_ref().map(|chosen| &chosen.locations).or(self.every_bit.as_ref()).map_or(&[], Vec::as_slice)
    }

    /// The signals of the catalogue that are shown even if they never change: those that match a pattern, unless it selects a whole owner or
    /// block, of which only the changes are of interest.
    pub(super) fn unchanged(&self, names: &Names) -> Vec<Printable> {
        let patterns = self.chosen.iter().flat_map(|chosen| &chosen.patterns);
        let narrow: Vec<&String> = patterns.filter(|pattern| !is_broad(pattern)).collect();
        if narrow.is_empty() {
            return Vec::new();
        }
        let interface = names.interface();
        let of_owner = |(_, block, number): (&str, Block, u8)| {
            let signals = interface.signals().filter(move |signal| signal.block == block);
            let locations = signals.filter_map(move |signal| interface.location(signal, number));
            locations.filter(|location| names.profile.shows(*location)).map(|location| printable(names, location))
        };
        let all = names.owners().flat_map(of_owner);
        all.filter(|printable| narrow.iter().any(|pattern| fits(pattern, printable))).collect()
    }

    pub(super) fn shows_signal(&self, signal: &Printable) -> bool {
        self.chosen.as_ref().is_none_or(|chosen| chosen.shows(signal))
    }

    pub(super) fn shows_unnamed_bit(&self, bit: &Printable) -> bool {
        match &self.chosen {
            None => self.every_bit.is_some() || matches!(bit.location.part, Part::Inputs | Part::Outputs),
            Some(chosen) => chosen.shows(bit),
        }
    }

    pub(super) fn shows_unnamed_byte(&self, byte: &Printable) -> bool {
        self.chosen.as_ref().is_some_and(|chosen| chosen.shows(byte))
    }
}

impl Chosen {
    fn add(
        &mut self,
        entry: &str,
        step: Option<f64>,
        names: &Names,
        (memory, variables): (&Memory, &Variables),
    ) -> Result<(), Problem> {
        let entry = &*names.without_alias(entry);
        let found = channel_values(entry, names, variables)?;
        let is_text = found.iter().any(|value| matches!(value, NamedValue::Program(_)));
        let fits_step = !is_text || step.is_none();
        if !found.is_empty() && fits_step {
            let step = step.unwrap_or(0.0);
            self.values.extend(found.into_iter().map(|value| WatchedItem { value, step }));
            return Ok(());
        }
        if let Some((head, tail)) = entry.rsplit_once('.')
            && let Some(value) = AxisValue::named(tail)
        {
            let axes: Vec<_> = axes(names).filter(|(_, name)| matches(head, name)).collect();
            if axes.is_empty() {
                let known = || names_of_axes(names);
                let fallback = format!("machine axes are {}", known().collect::<Vec<_>>().join(", "));
                return Err(Problem::new(
                    format!("expected the value of a machine axis, found `{entry}`"),
                    did_you_mean(head, known(), &fallback),
                ));
            }
            let step = step.unwrap_or(0.0);
            self.values
                .extend(axes.into_iter().map(|(axis, _)| WatchedItem { value: NamedValue::Axis(axis, value), step }));
            return Ok(());
        }
        if step.is_some() {
            let values = AxisValue::names(names.interface()).join(", ");
            return Err(Problem::new(
                format!("expected the value of a machine axis for a step, found `{entry}`"),
                format!(
                    "values of an axis are {values}, and R parameters have steps, too; every change of a signal is a row"
                ),
            ));
        }
        if !entry.contains('*') {
            let location = names.resolve(memory, entry).map_err(|problem| nearest_value(problem, entry, names));
            self.locations.push(location?);
            return Ok(());
        }
        if !looks_like_addresses(entry) {
            let fits = |signal: &Signal| {
                let mut owners = names.owners().filter(|(_, block, _)| *block == signal.block);
                owners.any(|(owner, ..)| matches(entry, &format!("{owner}.{}", signal.name)))
            };
            let matching = names.interface().signals().any(fits);
            if !matching {
                let head = entry.split('.').next().unwrap_or(entry);
                let known = || names.owners().map(|(owner, ..)| owner);
                let fallback = "write a pattern such as `X.*` or `DB31.DBX101.*`";
                return Err(Problem::new(
                    format!("expected a pattern that matches a signal, found `{entry}`"),
                    match known().any(|owner| owner == head) {
                        true => fallback.to_owned(),
                        false => did_you_mean(head, known(), fallback),
                    },
                ));
            }
        }
        self.patterns.push(entry.to_owned());
        Ok(())
    }

    fn shows(&self, printable: &Printable) -> bool {
        self.locations.contains(&printable.location) || self.patterns.iter().any(|pattern| fits(pattern, printable))
    }
}

/// Whether an item matches a pattern, by its address or its symbol.
fn fits(pattern: &str, printable: &Printable) -> bool {
    matches(pattern, &printable.address) || printable.symbol.as_ref().is_some_and(|symbol| matches(pattern, symbol))
}

/// Whether a pattern selects everything of an owner or a block: `*`, `X.*`, `DB31.*`.
fn is_broad(pattern: &str) -> bool {
    pattern == "*" || pattern.split_once('.').is_some_and(|(_, rest)| rest == "*")
}

/// The problem of an unknown name, with the nearest value of an axis or a channel as the remedy if one is near.
fn nearest_value(problem: Problem, entry: &str, names: &Names) -> Problem {
    let near = entry.rsplit_once('.').and_then(|(head, tail)| {
        if names.axis(head).is_some() {
            return Some((head, nearest(tail, AxisValue::names(names.interface()))?));
        }
        names.channel(head)?;
        Some((head, nearest(tail, NamedValue::names_of_channel())?))
    });
    match near {
        Some((head, value)) => Problem { cure: format!("did you mean `{head}.{value}`?"), ..problem },
        None => problem,
    }
}

/// The values of channels that an entry names: `R5`, `CHAN1.block`, `*.program`.
fn channel_values(entry: &str, names: &Names, variables: &Variables) -> Result<Vec<NamedValue>, Problem> {
    if let Some(value) = NamedValue::named(entry, names, |channel| variables.r_parameters.count(channel))?
        && !matches!(value, NamedValue::Axis(..))
    {
        return Ok(vec![value]);
    }
    let Some((head, tail)) = entry.rsplit_once('.').filter(|(head, _)| head.contains('*')) else {
        return Ok(Vec::new());
    };
    let value: fn(ChannelNumber) -> NamedValue = match tail {
        "block" => NamedValue::Block,
        "program" => NamedValue::Program,
        _ => return Ok(Vec::new()),
    };
    let channels = names.channels.iter().filter(|(_, name)| name.as_deref().is_some_and(|name| matches(head, name)));
    // The names of all channels are known; those that the machine has also have R parameters, unless MD28050 is 0 in all of them.
    let has_parameters = |channel: &ChannelNumber| variables.r_parameters.count(*channel) > 0;
    let (existing, others): (Vec<_>, Vec<_>) = channels.map(|(channel, _)| channel).partition(has_parameters);
    let found = if existing.is_empty() { others } else { existing };
    Ok(found.into_iter().map(value).collect())
}

fn axes(names: &Names) -> impl Iterator<Item = (AxisNumber, &str)> {
    AxisNumber::all().filter_map(|axis| names.axes[axis].as_deref().map(|name| (axis, name)))
}

fn names_of_axes(names: &Names) -> impl Iterator<Item = &str> {
    axes(names).map(|(_, name)| name)
}

/// Whether a pattern refers to addresses: `DB33.…`, `M10.*`, `IB*`, `*`.
fn looks_like_addresses(pattern: &str) -> bool {
    let area = pattern.strip_prefix("DB").or_else(|| pattern.strip_prefix(['I', 'Q', 'M', 'T', 'C']));
    let area = area.map(|rest| rest.strip_prefix(['B', 'W', 'D']).unwrap_or(rest));
    pattern == "*" || area.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit() || c == '*'))
}

/// Whether a text matches a pattern, in which `*` stands for any text.
fn matches(pattern: &str, text: &str) -> bool {
    let mut parts = pattern.split('*');
    let first = parts.next().unwrap_or_default();
    let Some(mut rest) = text.strip_prefix(first) else {
        return false;
    };
    let mut last = None;
    for part in parts {
        // Each part takes its first match, except the last part, which must be at the end.
        if let Some(middle) = last.replace(part) {
            match rest.find(middle) {
                Some(at) => rest = &rest[at + middle.len()..],
                None => return false,
            }
        }
    }
    last.map_or(rest.is_empty(), |last| rest.ends_with(last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_anything() {
        for (pattern, text, fits) in [
            ("X.*", "X.controller_enable", true),
            ("X.*", "XF.controller_enable", false),
            ("X*.controller_enable", "XF.controller_enable", true),
            ("DB33.DBX101.*", "DB33.DBX101.4", true),
            ("DB33.DBX101.*", "DB33.DBX10.4", false),
            ("*gantry*start*", "X.gantry_synchronization_ready_to_start", true),
            ("*ab", "ab", true),
            ("a*a", "a", false),
            ("X.a", "X.ab", false),
        ] {
            assert_eq!(matches(pattern, text), fits, "{pattern} {text}");
        }
    }

    #[test]
    fn a_pattern_of_a_whole_owner_or_block_is_broad() {
        for (pattern, broad) in [
            ("*", true),
            ("X.*", true),
            ("*.*", true),
            ("DB31.*", true),
            ("DB31.DBX101.*", false),
            ("X.traverse_command_*", false),
            ("*.gantry_axis", false),
        ] {
            assert_eq!(is_broad(pattern), broad, "{pattern}");
        }
    }

    #[test]
    fn patterns_of_addresses_and_of_symbols_are_distinguished() {
        for pattern in ["DB33.*", "M10.*", "IB*", "QW1*", "*"] {
            assert!(looks_like_addresses(pattern), "{pattern}");
        }
        for pattern in ["X.*", "CHAN1.*", "MX.*", "DX*", "*.controller_enable"] {
            assert!(!looks_like_addresses(pattern), "{pattern}");
        }
    }
}
