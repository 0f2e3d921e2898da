//! Values that are recorded in every cycle for curves in one diagram, in addition to what a trace watches.

use super::Watch;
use super::value::millionths;
use super::waves::{Level, Step, Wave, WaveKind, Waves, described};
use crate::image::{Memory, Names};
use crate::source::Problem;
use crate::variables::{Describe, NamedValue, Variables, place_name};

/// Values of a machine, cycle by cycle.
#[derive(Clone, Debug, Default)]
pub struct Curves {
    values: Vec<NamedValue>,
    /// For each value: the cycles in which it changed, with the new value in millionths.
    rows: Vec<Vec<(u64, i64)>>,
}

/// Curves with one scale.
#[derive(Clone, Debug, Default)]
pub struct Panel {
    /// Their indices among the curves.
    pub curves: Vec<usize>,
    /// Lines at a value and at its negative.
    pub limits: Vec<Limit>,
}

/// A limit in a panel; it is drawn in both directions.
#[derive(Clone, Debug)]
pub struct Limit {
    /// Its name with its value.
    pub text: String,
    /// In the unit of the curves.
    pub value: f64,
}

impl Curves {
    /// The values with these names: `X.following_error`, `R5`; a pattern, `*.following_error`, names several.
    ///
    /// # Errors
    /// A name is not that of a number.
    pub fn parse(
        entries: &[&str],
        names: &Names,
        memory: &Memory,
        variables: &Variables,
    ) -> Result<Self, (usize, Problem)> {
        let mut values = Vec::new();
        for (index, entry) in entries.iter().enumerate() {
            let watch = Watch::parse(&[entry], names, memory, variables).map_err(|(_, problem)| (index, problem))?;
            let named: Vec<_> = watch.values().collect();
            if named.is_empty() || named.iter().any(|value| value.number(variables).is_none()) {
                let what = format!("expected the name of a value for a curve, found `{entry}`");
                let cure = "write `X.following_error`, `XF.synchronism_difference` or `R5`; `opennck signals` lists the values";
                return Err((index, Problem::new(what, cure)));
            }
            values.extend(named.into_iter().filter(|value| !values.contains(value)).collect::<Vec<_>>());
        }
        Ok(Self { rows: vec![Vec::new(); values.len()], values })
    }

    /// Records the values after a cycle.
    pub fn look(&mut self, cycle: u64, variables: &Variables) {
        for (value, rows) in self.values.iter().zip(&mut self.rows) {
            let new = millionths(value.number(variables).unwrap_or(0.0));
            if rows.last().is_none_or(|(_, last)| *last != new) {
                rows.push((cycle, new));
            }
        }
    }

    /// A panel for each unit, in the order of the values.
    #[must_use]
    pub fn by_unit(&self, describe: &dyn Describe) -> Vec<Panel> {
        let mut panels: Vec<(&str, Panel)> = Vec::new();
        for (index, value) in self.values.iter().enumerate() {
            let (_, unit, _) = described(*value, describe);
            match panels.iter_mut().find(|(known, _)| *known == unit) {
                Some((_, panel)) => panel.curves.push(index),
                None => panels.push((unit, Panel { curves: vec![index], limits: Vec::new() })),
            }
        }
        panels.into_iter().map(|(_, panel)| panel).collect()
    }

    /// Puts the curves of the panels into the place of the rows of a trace, and counts those of each panel.
    pub(super) fn rows<'a>(
        &self,
        panels: &'a [Panel],
        waves: &mut Waves,
        first_cycle: u64,
        describe: &dyn Describe,
    ) -> Vec<(usize, &'a [Limit])> {
        waves.rows.clear();
        let mut counts = Vec::new();
        for panel in panels {
            let own: Vec<_> =
                panel.curves.iter().filter_map(|index| self.wave(*index, first_cycle, describe)).collect();
            counts.push((own.len(), &panel.limits[..]));
            waves.rows.extend(own);
        }
        counts
    }

    fn wave(&self, index: usize, first_cycle: u64, describe: &dyn Describe) -> Option<Wave> {
        let (value, rows) = (*self.values.get(index)?, self.rows.get(index)?);
        let (name, unit, _) = described(value, describe);
        let step = |&(cycle, value): &(u64, i64)| Step {
            cycle: cycle.saturating_sub(first_cycle),
            level: Level::Value(value),
            by: None,
            because: None,
        };
        Some(Wave {
            owner: place_name(value.place(), describe.names()),
            name,
            beside: unit.to_owned(),
            kind: WaveKind::Value,
            is_watched: true,
            start: Level::Value(rows.first().map_or(0, |(_, value)| *value)),
            changes: rows.iter().map(step).collect(),
        })
    }
}
