//! Active machine data in the units of the model, as used by the stages of a cycle.
//!
//! Recalculated whenever machine data become active (power on, RESET, NEWCONF). Every stage reads them, none writes them. Lengths
//! are whole increments, velocities increments per second, times whole cycles.

pub(super) mod axis;
pub(super) mod channels;
pub(super) mod compensation;
pub(super) mod configuration;
pub(super) mod dynamics;
pub(super) mod groupings;
pub(super) mod mechanics;
pub(super) mod monitoring;
pub(super) mod overrides;
mod path_jerk;
pub(super) mod programs;
pub(super) mod sag;
pub(super) mod spindle;
mod user;

use arrayvec::ArrayVec;

use crate::image::UserFromNck;
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::axis::{AxisParameters, AxisPresence, axis};
use crate::sinumerik::parameters::channels::{ChannelParameters, channels};
use crate::sinumerik::parameters::configuration::{ChannelFault, faults};
use crate::sinumerik::parameters::groupings::{Definitions, define};
use crate::sinumerik::parameters::overrides::{effective, factor, is_zero_setting};
use crate::sinumerik::parameters::programs::{PathOverrides, ProgramParameters, programs};
use crate::sinumerik::parameters::sag::{SagTables, sag_tables};
use crate::sinumerik::parameters::user::user_data;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, PerAxis, PerChannel, PerModeGroup, Time};
use crate::variables::RParameters;

/// All active parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// The interpolation cycle, MD10050 × MD10070.
    pub cycle: Time,
    /// Number of position-control cycles in it, MD10070 / MD10060.
    pub servo_cycles: u32,
    /// MD10070 and MD10060 if the first is not a multiple of the second: the next multiple acts (4110).
    pub corrected_ratios: Option<[f64; 2]>,
    /// Duration of a position-control cycle, in seconds.
    pub servo_cycle: f64,
    /// MD10240 = 0: the basic system is inch.
    pub is_inch: bool,
    /// MD11412: alarms with "mode group not ready" or "channel not ready" only cause "channel not ready".
    pub only_channel_not_ready: bool,
    /// MD11300: keys act as long as they are pressed, in INC and in the reference point approach.
    pub jog_mode: bool,
    /// MD11300 and SD41050.
    pub key_modes: KeyModes,
    /// MD11320: pulses per detent of each handwheel.
    pub handwheel_pulses: [f64; 3],
    /// MD11346 is 0 or 2: a handwheel at standstill drops its remaining distance.
    pub handwheel_drops_rest: bool,
    /// MD11346.
    pub handwheel_true_distance: u8,
    /// Number of cycles without a pulse after which a handwheel counts as being at standstill.
    pub handwheel_still_cycles: u64,
    /// MD12000.
    pub axis_override_is_gray: bool,
    /// MD12010: factor by switch position, from one.
    pub axis_override_factors: [f64; 31],
    /// MD12100.
    pub binary_override_limit: f64,
    /// MD17900 bit 0: the traverse command is output only while the axis may move.
    pub command_only_in_motion: bool,
    /// MD11450 bit 0: after a search, 10208 waits for DB21.DBX1.6.
    pub search_waits_for_plc: bool,
    /// MD10722 bit 0: another channel takes an axis automatically also after WAITP.
    pub exchange_after_wait: bool,
    /// MD10722 bit 3: the PLC requests only exclusive and permanent PLC axes.
    pub only_reserved_plc_axes: bool,
    /// MD10708 bit 1: START in SERUPRO starts nothing, without 16942.
    pub serupro_ignores_start: bool,
    /// The channels that exist, with their mode groups.
    pub(super) channel_list: ArrayVec<(ChannelNumber, ModeGroupNumber), { ChannelNumber::MAX as usize }>,
    /// The mode groups that have channels.
    pub(super) mode_group_list: ArrayVec<ModeGroupNumber, { ModeGroupNumber::MAX as usize }>,
    /// The channels; those without a mode group do not exist.
    pub channels: PerChannel<ChannelParameters>,
    /// MD10720: the mode of each mode group after power on.
    pub mode_after_power_on: PerModeGroup<i32>,
    /// The axes that exist.
    pub existing: AxisSet,
    /// The axes that are spindles.
    pub spindles: AxisSet,
    /// The axes.
    pub axes: PerAxis<AxisParameters>,
    /// The groupings defined by MD37100, and the faults of their definition.
    pub groupings: Definitions,
    /// The faults of the channels and their axes.
    pub faults: Vec<ChannelFault>,
    /// The tables of sag compensation that are evaluated.
    pub(super) sag: SagTables,
    /// The axes that a compensation can act on, or whose movement one depends on.
    pub(super) compensated: AxisSet,
    /// The overrides of feed and rapid traverse.
    pub(super) path_overrides: PathOverrides,
    /// For programs, of each channel.
    pub(super) programs: PerChannel<Option<Box<ProgramParameters>>>,
    /// On an 828D: what it shows the PLC of MD14510 to MD14516.
    pub(super) user: Option<Box<UserFromNck>>,
}

impl Parameters {
    /// From the active machine data.
    #[must_use]
    pub fn new(data: &MachineData, presence: &PerAxis<AxisPresence>) -> Self {
        let cycle = cycle_time(data);
        let axes = PerAxis::from_fn(|number| axis(data, number, presence[number], cycle, servo_cycles(data)));
        let channel_list: ArrayVec<_, { ChannelNumber::MAX as usize }> =
            ChannelNumber::all().filter_map(|channel| Some((channel, data.mode_group(channel)?))).collect();
        let sag = sag_tables(data);
        let has_channels = |group: &ModeGroupNumber| channel_list.iter().any(|(_, of)| of == group);
        Self {
            mode_group_list: ModeGroupNumber::all().filter(has_channels).collect(),
            channel_list,
            cycle,
            servo_cycles: servo_cycles(data),
            servo_cycle: cycle.seconds() / f64::from(servo_cycles(data)),
            corrected_ratios: corrected_ratios(data),
            is_inch: !data.general.scaling_system_is_metric,
            only_channel_not_ready: data.general.alarm_reaction_chan_noready,
            jog_mode: data.general.jog_inc_mode_leveltriggrd,
            key_modes: KeyModes {
                increment_held: data.general.jog_inc_mode_leveltriggrd,
                continuous_held: data.setting.jog_cont_mode_leveltriggrd,
            },
            handwheel_pulses: std::array::from_fn(|index| data.general.handwh_imp_per_latch[index]),
            handwheel_true_distance: data.general.handwh_true_distance,
            handwheel_drops_rest: data.general.handwh_true_distance.is_multiple_of(2),
            handwheel_still_cycles: Time::from_millis(100).in_cycles(cycle),
            axis_override_is_gray: data.general.ovr_ax_is_gray_code,
            axis_override_factors: data.general.ovr_factor_ax_speed,
            binary_override_limit: data.general.ovr_factor_limit_bin,
            exchange_after_wait: data.general.axchange_mask & 1 == 1,
            only_reserved_plc_axes: data.general.axchange_mask >> 3 & 1 == 1,
            command_only_in_motion: data.general.vdi_function_mask & 1 == 1,
            serupro_ignores_start: data.general.serupro_mask & 2 == 2,
            search_waits_for_plc: data.general.search_run_mode & 1 == 1,
            existing: axes.iter().filter(|(_, axis)| axis.exists).map(|(number, _)| number).collect(),
            spindles: {
                let spindles = axes.iter().filter(|(_, axis)| axis.exists && axis.spindle.is_some());
                spindles.map(|(number, _)| number).collect()
            },
            channels: channels(data, &axes),
            mode_after_power_on: PerModeGroup::from_fn(|group| data.general.operating_mode_default[group.index()]),
            groupings: define(data, &axes),
            faults: {
                let mut faults = faults(data, &axes);
                faults.extend(sag.faults.iter().copied());
                faults
            },
            compensated: axes
                .iter()
                .filter(|(_, axis)| axis.exists && axis.compensation.exists())
                .map(|(number, _)| number)
                .chain(sag.relations.iter().map(|relation| relation.input))
                .collect(),
            sag,
            path_overrides: PathOverrides::new(data),
            programs: PerChannel::from_fn(|channel| {
                data.mode_group(channel).map(|_| Box::new(programs(data, channel, &axes, cycle)))
            }),
            axes,
            user: None,
        }
    }

    /// The same on an 828D.
    #[must_use]
    pub(super) fn on_828d(self, data: &MachineData) -> Self {
        Self { user: Some(Box::new(user_data(data))), ..self }
    }

    /// The existing axes.
    pub fn existing(&self) -> impl Iterator<Item = (AxisNumber, &AxisParameters)> {
        self.axes.iter().filter(|(_, axis)| axis.exists)
    }

    /// The factor of an axial override byte (O-21); Gray code 0 counts as position 1. While the override is not active it is 1, except
    /// at the zero setting.
    #[must_use]
    pub fn axis_override(&self, code: u8, is_active: bool) -> f64 {
        let gray = self.axis_override_is_gray;
        let factor = factor(code, gray, &self.axis_override_factors, self.binary_override_limit);
        effective(factor, is_active, is_zero_setting(code, gray))
    }
}

/// The interpolation cycle (O-22), rounded to whole nanoseconds, at least one microsecond.
#[must_use]
pub(super) fn cycle_time(data: &MachineData) -> Time {
    let [_, position] = ratios(data);
    let seconds = data.general.sysclock_cycle_time * f64::from(servo_cycles(data) * position);
    Time::from_seconds(seconds).max(Time::from_micros(1))
}

/// MD10070 and MD10060.
fn ratios(data: &MachineData) -> [u32; 2] {
    [data.general.ipo_sysclock_time_ratio, data.general.posctrl_sysclock_time_ratio]
        .map(|ratio| u32::try_from(ratio).unwrap_or(1).max(1))
}

fn servo_cycles(data: &MachineData) -> u32 {
    let [interpolation, position] = ratios(data);
    interpolation.div_ceil(position)
}

pub(super) fn corrected_ratios(data: &MachineData) -> Option<[f64; 2]> {
    let [interpolation, position] = ratios(data);
    (!interpolation.is_multiple_of(position)).then(|| [interpolation, position].map(f64::from))
}

/// The modes of the traversing keys.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct KeyModes {
    /// MD11300: an increment runs while its key is held, else to its end.
    pub increment_held: bool,
    /// SD41050: continuous movement runs while its key is held, else until the next press.
    pub continuous_held: bool,
}

impl Parameters {
    /// R parameters of 0, as many as MD28050 gives each channel.
    #[must_use]
    pub(super) fn r_parameters(&self) -> RParameters {
        RParameters::new(|channel| self.programs[channel].as_ref().map_or(0, |own| own.r_parameters))
    }

    /// The channels that exist, with their mode groups.
    pub fn existing_channels(&self) -> impl Iterator<Item = (ChannelNumber, ModeGroupNumber)> {
        self.channel_list.iter().copied()
    }

    /// The mode groups that have channels.
    pub fn existing_mode_groups(&self) -> impl Iterator<Item = ModeGroupNumber> {
        self.mode_group_list.iter().copied()
    }

    /// The mode group of a channel.
    #[must_use]
    pub fn mode_group(&self, channel: ChannelNumber) -> ModeGroupNumber {
        self.channels[channel].mode_group.unwrap_or(ModeGroupNumber::FIRST)
    }
}
