//! Machine data: the settings with which the commissioning engineer adapts the control to the machine.
//!
//! The tables (`general.rs`, `setting.rs`, `channel.rs`, `axis.rs`) contain one row per datum; [`MachineData`] contains the values. A
//! machine has two sets of them. Files and the operator write the stored set, with [`MachineData::set`]. The control reads the active set.
//! [`MachineData::activate`] copies a class of data from the stored set to the active set. [`Archive`] reads and writes commissioning
//! archives.
//!
//! **Rotary axes.** Velocities and accelerations of a rotary axis have other defaults than those of a linear axis (MD32000: 27.77 rev/min,
//! not 10000 mm/min). When MD30300 `IS_ROT_AX` changes, every such datum of the axis that still has the default of the old type takes the
//! default of the new type. An archive sets MD30300 first and its other data after it, so explicitly given values always stay.

mod archive;
mod ascii;
mod axis;
mod axis_setting;
mod binary;
mod catalogue;
mod channel;
mod channel_setting;
mod check;
mod compensation;
mod export;
mod general;
mod groups;
mod import;
mod named;
mod reading;
mod scaling;
mod setting;
mod system;
mod table;
mod tables;
mod target;
mod write;

pub use archive::{Archive, Summary, files_of, is_archive};
pub use axis::Axis;
pub use axis_setting::AxisSetting;
pub use catalogue::{by_identifier, by_number, catalogue, nearest_identifier};
pub use channel::Channel;
pub use channel_setting::ChannelSetting;
pub use check::check;
pub(super) use check::unequal_data;
pub use general::General;
pub use reading::{Assignment, Member, refusal};
pub use setting::Setting;
pub(in crate::sinumerik) use table::datum_name;
pub use table::{Datum, Effect, PerTable, Range, Scope};
pub use tables::{CompensationTables, Points, SagTable};
pub(super) use tables::{Element, TableRefusal, TableValue, TableVariable};
pub use target::Target;

use serde::{Deserialize, Serialize};

use crate::control::{Owner, Value};
use crate::image::{Block, SINUMERIK};
use crate::source::Problem;
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel};

use scaling::System;
use table::Table;

/// All machine data of a machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MachineData {
    /// General machine data, `$MN_`.
    pub general: General,
    /// General setting data, `$SN_`.
    pub setting: Setting,
    /// Channel-specific machine data, `$MC_`.
    pub channels: PerChannel<Channel>,
    /// Channel-specific setting data, `$SC_`.
    pub channel_settings: PerChannel<ChannelSetting>,
    /// Axis-specific machine data, `$MA_`.
    pub axes: PerAxis<Axis>,
    /// Axis-specific setting data, `$SA_`.
    pub axis_settings: PerAxis<AxisSetting>,
    /// The tables of compensations, which are system variables.
    pub tables: CompensationTables,
}

/// The defaults of the control: linear axes, and channels CHAN1 to CHAN10, of which only the first has axes.
impl Default for MachineData {
    fn default() -> Self {
        let mut channels = PerChannel::<Channel>::default();
        for (number, channel) in channels.iter_mut() {
            channel.chan_name = format!("CHAN{number}");
            if number != ChannelNumber::FIRST {
                channel.axconf_machax_used = [0; 20];
            }
        }
        Self {
            general: General::default(),
            setting: Setting::default(),
            channels,
            channel_settings: PerChannel::default(),
            axes: PerAxis::default(),
            axis_settings: PerAxis::default(),
            tables: CompensationTables::default(),
        }
    }
}

impl MachineData {
    /// The possible machine axes: MD10000 has a name for each.
    pub fn axis_numbers() -> impl DoubleEndedIterator<Item = AxisNumber> {
        AxisNumber::up_to(SINUMERIK.count(Block::Axis))
    }

    /// Whether this axis is possible.
    #[must_use]
    pub fn is_axis(axis: AxisNumber) -> bool {
        axis.number() <= SINUMERIK.count(Block::Axis)
    }

    /// The machine axis of this name (MD10000, exact case) or `AXn`.
    #[must_use]
    pub fn axis(&self, name: &str) -> Option<AxisNumber> {
        let by_name = Self::axis_numbers().find(|axis| self.axis_name(*axis) == name && !name.is_empty());
        // Identifiers in archives are not case-sensitive: `ax3` is AX3. Names are case-sensitive.
        let number = || AxisNumber::new(numbered(&name.to_ascii_uppercase(), "AX")?);
        by_name.or_else(|| number().filter(|axis| Self::is_axis(*axis)))
    }

    /// The name of a machine axis (MD10000); empty for an impossible axis.
    #[must_use]
    pub fn axis_name(&self, axis: AxisNumber) -> &str {
        self.general.axconf_machax_name_tab.get(axis.index()).map_or("", String::as_str)
    }

    /// MD10010: the mode group of a channel; `None` for a channel that does not exist. Channel 1 always exists.
    #[must_use]
    pub fn mode_group(&self, channel: ChannelNumber) -> Option<ModeGroupNumber> {
        let assigned = u8::try_from(self.general.assign_chan_to_mode_group[channel.index()]).ok();
        let group = assigned.and_then(ModeGroupNumber::new);
        if channel == ChannelNumber::FIRST { group.or(Some(ModeGroupNumber::FIRST)) } else { group }
    }

    /// MD20070: whether an existing channel names the axis.
    #[must_use]
    pub fn channel_knows(&self, channel: ChannelNumber, axis: AxisNumber) -> bool {
        self.mode_group(channel).is_some() && self.channels[channel].axconf_machax_used.contains(&axis.number())
    }

    /// MD20050: whether the channel of the axis declares it as a geometry axis.
    #[must_use]
    pub fn is_geometry_axis(&self, axis: AxisNumber) -> bool {
        let channel = &self.channels[self.home_channel(axis)];
        let machine_axis = |number: &u8| {
            let index = usize::from(*number).checked_sub(1)?;
            channel.axconf_machax_used.get(index).copied()
        };
        channel.axconf_geoax_assign_tab.iter().filter_map(machine_axis).any(|number| number == axis.number())
    }

    /// Whether the geometry axes of the channel of an axis are those of the default of MD20050.
    #[must_use]
    pub fn has_default_geometry(&self, axis: AxisNumber) -> bool {
        let table = &self.channels[self.home_channel(axis)].axconf_geoax_assign_tab;
        *table == Channel::default().axconf_geoax_assign_tab
    }

    /// The channel of an axis after power on: MD30550 if that channel has the axis, else the lowest channel that has it.
    #[must_use]
    pub fn home_channel(&self, axis: AxisNumber) -> ChannelNumber {
        let master = ChannelNumber::new(self.axes[axis].axconf_assign_master_chan);
        let knows = |channel: &ChannelNumber| self.channel_knows(*channel, axis);
        master.filter(knows).or_else(|| ChannelNumber::all().find(knows)).unwrap_or(ChannelNumber::FIRST)
    }

    /// The channel of this name (MD20000, exact case) or `CHANn`.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<ChannelNumber> {
        let by_name = self.channels.iter().find(|(_, channel)| channel.chan_name == name && !name.is_empty());
        by_name.map(|(number, _)| number).or_else(|| ChannelNumber::new(numbered(&name.to_ascii_uppercase(), "CHAN")?))
    }

    /// The value of a target.
    #[must_use]
    pub fn get(&self, target: &Target) -> Option<Value> {
        fn from<T: Table>(table: &T, target: &Target) -> Option<Value> {
            let row = T::rows().get(catalogue::row(target.datum().number)?)?;
            (row.get)(table, usize::from(target.index()))
        }
        match (target.datum().scope, target.owner()) {
            (Scope::General, _) => from(&self.general, target),
            (Scope::Setting, _) => from(&self.setting, target),
            (Scope::ChannelSetting, Owner::Channel(channel)) => from(&self.channel_settings[channel], target),
            (Scope::AxisSetting, Owner::Axis(axis)) => from(&self.axis_settings[axis], target),
            (_, Owner::Channel(channel)) => from(&self.channels[channel], target),
            (_, Owner::Axis(axis)) => from(&self.axes[axis], target),
            (_, Owner::Nck) => None,
        }
    }

    /// Writes a value like the operator or a scenario. Read-only data are rejected.
    ///
    /// # Errors
    /// The datum is read-only, or the value has the wrong type or is out of range. In this case nothing changes.
    pub fn set(&mut self, target: &Target, value: &Value) -> Result<(), Problem> {
        may_be_written(target)?;
        self.store(target, value)
    }

    /// Checks whether a value could be written with [`MachineData::set`].
    ///
    /// # Errors
    /// As [`MachineData::set`].
    pub fn check(&self, target: &Target, value: &Value) -> Result<(), Problem> {
        may_be_written(target)?;
        is_in_range(target, value)?;
        // Only the table of the datum is copied, because clients call this hundreds of times per request.
        let stored = match (target.datum().scope, target.owner()) {
            (Scope::General, _) => store_in(&mut self.general.clone(), target, value),
            (Scope::Setting, _) => store_in(&mut self.setting.clone(), target, value),
            (Scope::ChannelSetting, Owner::Channel(channel)) => {
                store_in(&mut self.channel_settings[channel].clone(), target, value)
            }
            (Scope::AxisSetting, Owner::Axis(axis)) => store_in(&mut self.axis_settings[axis].clone(), target, value),
            (_, Owner::Channel(channel)) => store_in(&mut self.channels[channel].clone(), target, value),
            (_, Owner::Axis(axis)) => store_in(&mut self.axes[axis].clone(), target, value),
            (_, Owner::Nck) => Err(NO_OWNER.to_owned()),
        };
        stored.map_err(|expected| refused(target, value, &expected))
    }

    /// Writes a value within its range.
    fn store(&mut self, target: &Target, value: &Value) -> Result<(), Problem> {
        is_in_range(target, value)?;
        self.import(target, value)
    }

    /// Writes a value like the import of an archive: any value of the type (O-30).
    fn import(&mut self, target: &Target, value: &Value) -> Result<(), Problem> {
        let (system, millimetres) = (self.system(), self.millimetres());
        let stored = match (target.datum().scope, target.owner()) {
            (Scope::General, _) => store_in(&mut self.general, target, value),
            (Scope::Setting, _) => store_in(&mut self.setting, target, value),
            (Scope::ChannelSetting, Owner::Channel(channel)) => {
                store_in(&mut self.channel_settings[channel], target, value)
            }
            (Scope::AxisSetting, Owner::Axis(axis)) => store_in(&mut self.axis_settings[axis], target, value),
            (_, Owner::Channel(channel)) => store_in(&mut self.channels[channel], target, value),
            (_, Owner::Axis(axis)) => {
                let axis = &mut self.axes[axis];
                let was_rotary = axis.is_rot_ax;
                let stored = store_in(axis, target, value);
                if axis.is_rot_ax != was_rotary {
                    let (mut linear, rotary) = (Axis::default(), Axis::rotary());
                    if system == System::Inch {
                        scaling::convert(&mut linear, false, millimetres, system);
                    }
                    let (from, to) = if was_rotary { (&rotary, &linear) } else { (&linear, &rotary) };
                    axis.exchange_defaults(from, to);
                }
                stored
            }
            (_, Owner::Nck) => Err(NO_OWNER.to_owned()),
        };
        stored.map_err(|expected| refused(target, value, &expected))
    }

    /// The values that differ from those of `before`.
    #[must_use]
    pub fn differences(&self, before: &Self) -> Vec<Target> {
        let channels = ChannelNumber::all().filter(|&channel| {
            self.channels[channel] != before.channels[channel]
                || self.channel_settings[channel] != before.channel_settings[channel]
        });
        let axes = Self::axis_numbers().filter(|&axis| {
            self.axes[axis] != before.axes[axis] || self.axis_settings[axis] != before.axis_settings[axis]
        });
        let owners: Vec<_> =
            std::iter::once(Owner::Nck).chain(channels.map(Owner::Channel)).chain(axes.map(Owner::Axis)).collect();
        let of_owner = |owner| {
            catalogue().flat_map(move |datum| {
                datum.indices().filter_map(move |index| Target::new(datum.number, owner, index).ok())
            })
        };
        owners.into_iter().flat_map(of_owner).filter(|target| self.get(target) != before.get(target)).collect()
    }

    /// The data with the nearest permitted values in place of those at `targets` that are outside of their ranges.
    #[must_use]
    pub(super) fn within_range(&self, targets: &[Target]) -> Self {
        let mut data = self.clone();
        for target in targets {
            let number = data.get(target).and_then(|value| value.number());
            let range = &target.datum().range;
            if let Some(number) = number.filter(|number| !range.contains(*number)) {
                // The nearest value has the type of the datum, because the limits of its range do.
                let _ = data.import(target, &Value::Real(range.nearest(number)));
            }
        }
        data
    }

    /// The owner of a datum by name: `axis X1`, `channel CHAN1`; empty for the whole control.
    #[must_use]
    pub fn owner_in_words(&self, owner: Owner) -> String {
        match owner {
            Owner::Nck => String::new(),
            Owner::Channel(channel) => format!("channel {}", self.channels[channel].chan_name),
            Owner::Axis(axis) if self.axis_name(axis).is_empty() => format!("axis AX{axis}"),
            Owner::Axis(axis) => format!("axis {}", self.axis_name(axis)),
        }
    }

    /// Activates stored data: copies every datum whose class takes effect at this level. POWER ON copies all data, RESET all except POWER
    /// ON data, NEWCONF the NEWCONF and immediate data (O-23).
    pub fn activate(&mut self, stored: &Self, level: Effect) {
        self.general.activate(&stored.general, level);
        self.setting.activate(&stored.setting, level);
        for (number, channel) in self.channels.iter_mut() {
            channel.activate(&stored.channels[number], level);
        }
        for (number, settings) in self.channel_settings.iter_mut() {
            settings.activate(&stored.channel_settings[number], level);
        }
        for (number, axis) in self.axes.iter_mut() {
            axis.activate(&stored.axes[number], level);
        }
        for (number, settings) in self.axis_settings.iter_mut() {
            settings.activate(&stored.axis_settings[number], level);
        }
        self.tables.clone_from(&stored.tables);
    }
}

/// The missing part of a target without owner.
const NO_OWNER: &str = "an axis or a channel";

fn refused(target: &Target, value: &Value, expected: &str) -> Problem {
    let datum = target.datum();
    let found = value.export(datum.kind);
    Problem::new(format!("expected {expected} for {datum}, found {found}"), "correct the value")
}

fn may_be_written(target: &Target) -> Result<(), Problem> {
    let datum = target.datum();
    if datum.read_only {
        return Err(Problem::new(
            format!("expected a writable machine datum, found {datum}, which only the control writes"),
            "remove this assignment",
        ));
    }
    Ok(())
}

fn is_in_range(target: &Target, value: &Value) -> Result<(), Problem> {
    let range = &target.datum().range;
    match value.number() {
        Some(number) if !range.contains(number) => Err(refused(target, value, &range.to_string())),
        Some(_) | None => Ok(()),
    }
}

fn store_in<T: Table>(table: &mut T, target: &Target, value: &Value) -> Result<(), String> {
    let row = catalogue::row(target.datum().number).and_then(|row| T::rows().get(row));
    let row = row.ok_or_else(|| "a known datum".to_owned())?;
    (row.set)(table, usize::from(target.index()), value)
}

/// The number after a prefix: `AX12`.
fn numbered(name: &str, prefix: &str) -> Option<u8> {
    let digits = name.strip_prefix(prefix)?;
    (!digits.starts_with(['0', '+'])).then(|| digits.parse().ok())?
}

#[cfg(test)]
mod tests;
