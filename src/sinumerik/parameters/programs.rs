//! What programs of a channel need to know: the names of its axes, the axes of its path, reset values, tolerances, and when auxiliary
//! functions are output.

use std::sync::Arc;

use arrayvec::ArrayVec;

use crate::motion::path::{Feed, PATH_AXES};
use crate::nc_program::{AuxiliaryKind, AxisKind, AxisName, AxisNames, Block, GFunction, Modal};
use crate::sinumerik::machine_data::{Channel, MachineData};
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::overrides::{effective, factor, is_zero_setting};
use crate::sinumerik::parameters::path_jerk::PathJerk;
use crate::units::{AxisNumber, ChannelNumber, PerAxis, Position, Time};

/// When an auxiliary function is output (MD22200 to 22252).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum OutputTime {
    /// The motion of the block waits for its acknowledgement.
    Before,
    /// With the beginning of the motion.
    During,
    /// At the end of the motion.
    End,
    /// Not at all.
    Never,
}

impl OutputTime {
    /// 4, "as predefined", is the time that the manual gives for the kind.
    fn new(datum: u8, predefined: Self) -> Self {
        match datum {
            0 => Self::Before,
            1 => Self::During,
            2 => Self::End,
            3 => Self::Never,
            _ => predefined,
        }
    }
}

/// An auxiliary function, or all with one address, in a group.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) struct AuxiliaryGroup {
    pub group: u32,
    pub kind: AuxiliaryKind,
    /// Below 0: any.
    pub extension: i32,
    /// Below 0: any.
    pub value: i32,
}

/// MD22000 to 22030: entries without a type are empty.
fn auxiliary_groups(md: &Channel) -> Vec<AuxiliaryGroup> {
    let kind = |name: &str| match name.to_ascii_uppercase().as_str() {
        "M" => Some(AuxiliaryKind::M),
        "S" => Some(AuxiliaryKind::S),
        "T" => Some(AuxiliaryKind::T),
        "D" => Some(AuxiliaryKind::D),
        "DL" => Some(AuxiliaryKind::SumOffset),
        "H" => Some(AuxiliaryKind::H),
        "F" => Some(AuxiliaryKind::F),
        _ => None,
    };
    let row = |index: usize| {
        Some(AuxiliaryGroup {
            group: md.auxfu_assign_group[index].into(),
            kind: kind(&md.auxfu_assign_type[index])?,
            extension: md.auxfu_assign_extension[index],
            value: md.auxfu_assign_value[index],
        })
    };
    (0..md.auxfu_assign_group.len()).filter_map(row).collect()
}

/// When a change of program control takes effect while a program runs (MD10704, MD10706).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum ChangeTime {
    /// At the end of a block; skip levels only while the program is stopped there.
    BlockEnd,
    /// At once: the path stops for a short time.
    AtOnce,
    /// When preparation waits until everything has been executed (STOPRE).
    StopPreparation,
}

impl ChangeTime {
    fn new(datum: u8) -> Self {
        match datum {
            0 => Self::BlockEnd,
            1 => Self::AtOnce,
            _ => Self::StopPreparation,
        }
    }
}

/// The names that programs of a channel can use, with their axes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct ProgramAxes {
    /// Geometry axes, channel axes, machine axes: the names of one axis follow in this order.
    pub names: Arc<AxisNames>,
    /// The machine axis of each name.
    pub machine_axes: Arc<[AxisNumber]>,
    /// The machine axes that can be on the path: geometry axes first. Synchronous axes of groupings and spindles are not among them. Another
    /// channel or the PLC may have one of them.
    pub path: ArrayVec<AxisNumber, PATH_AXES>,
    /// The places of geometry axes 1 to 3 in the path.
    pub geometry: [Option<usize>; 3],
    /// The places of all geometry axes; the feed refers to them.
    pub counted: [bool; PATH_AXES],
}

impl ProgramAxes {
    /// The place of a machine axis in the path.
    pub(in crate::sinumerik) fn place(&self, axis: AxisNumber) -> Option<usize> {
        self.path.iter().position(|member| *member == axis)
    }
}

/// The data of one channel for programs.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct ProgramParameters {
    pub axes: ProgramAxes,
    /// The spindles of the channel: their numbers (MD35000) and axes.
    pub spindles: Vec<(u8, AxisNumber)>,
    /// MD20090: the spindle of functions without an extension; 0 if the channel does not have it.
    pub master_spindle: u8,
    /// MD22400.
    pub speed_stays: bool,
    /// MD20850 bit 0.
    pub outputs_m19: bool,
    /// MD28050.
    pub r_parameters: u32,
    /// MD20150.
    pub modal: Modal,
    /// MD21000 in increments.
    pub circle_tolerance: f64,
    /// MD21010.
    pub circle_tolerance_share: f64,
    /// MD22200, 22210, 22220, 22250, 22252, 22230, 22240.
    output_times: [OutputTime; 7],
    /// MD22254 and MD22256.
    pub associated_stops: [i32; 2],
    /// MD22100.
    pub quick_is_free: bool,
    /// MD22110.
    pub whole_h_functions: bool,
    /// MD20800 bit 0: M17 and M30 of subprograms are output.
    pub outputs_end_of_subprogram: bool,
    /// MD20800 bit 1: M1 is output only while it stops.
    pub outputs_m1_only_active: bool,
    /// MD22410.
    pub feed_stays: bool,
    /// SD42110 in mm/min.
    pub default_feed: f64,
    /// SD42100 in mm/min and SD42101.
    pub dry_run: (f64, u8),
    /// MD10704: when a change of the dry run takes effect.
    pub dry_run_change: ChangeTime,
    /// MD10706: when a change of the skip levels takes effect.
    pub skip_change: ChangeTime,
    /// MD22000, 22010, 22020, 22030.
    pub auxiliary_groups: Vec<AuxiliaryGroup>,
    /// MD10713: preparation waits behind these M functions.
    pub stopping_functions: Vec<i32>,
    /// MD10715 and MD10716: M functions and the subprograms that replace them.
    pub replaced_functions: Vec<(i32, String)>,
    /// MD20730.
    pub rapid_is_linear: bool,
    /// MD10708 bit 0: SERUPRO does not stop at M0.
    pub serupro_passes_m0: bool,
    /// MD10708 bit 4: SERUPRO ignores the overrides.
    pub serupro_ignores_overrides: bool,
    /// MD22600 and MD22601.
    pub serupro_speed: (u8, f64),
    /// What SOFT depends on.
    pub jerk: PathJerk,
    /// SD42120 in mm/min.
    pub approach_feed: f64,
    /// SD42440.
    pub increments_traverse_offsets: bool,
    /// MD22510.
    pub shown_groups: [u8; 8],
    /// MD22515 bit 0.
    pub shows_groups_in_order: bool,
}

impl ProgramParameters {
    /// SD42110 as the feed with which a program begins.
    pub(in crate::sinumerik) fn initial_feed(&self) -> Option<f64> {
        Some(self.default_feed).filter(|feed| *feed > 0.0)
    }

    /// The group that MD22000 to 22030 give an auxiliary function.
    pub(in crate::sinumerik) fn auxiliary_group(&self, kind: AuxiliaryKind, extension: u16, value: f64) -> Option<u32> {
        let named = self.auxiliary_groups.iter().find(|one| {
            let is_value = one.value < 0 || (f64::from(one.value) - value).abs() < 0.5;
            one.kind == kind && (one.extension < 0 || one.extension == i32::from(extension)) && is_value
        });
        named.map(|one| one.group)
    }

    /// MD10713: whether preparation waits behind a block until it has been executed.
    pub(in crate::sinumerik) fn waits_behind(&self, block: &Block) -> bool {
        block.auxiliary.iter().any(|function| {
            let is_plain = function.kind == AuxiliaryKind::M && function.extension.unwrap_or(0) == 0;
            is_plain && self.stopping_functions.iter().any(|number| (f64::from(*number) - function.value).abs() < 0.5)
        })
    }

    /// The axis of a spindle; 0 is the master spindle.
    pub(in crate::sinumerik) fn spindle(&self, number: u16) -> Option<AxisNumber> {
        let number = if number == 0 { u16::from(self.master_spindle) } else { number };
        self.spindles.iter().find(|(other, _)| u16::from(*other) == number).map(|(_, axis)| *axis)
    }

    pub(in crate::sinumerik) fn output_time(&self, kind: AuxiliaryKind) -> OutputTime {
        let index = match kind {
            AuxiliaryKind::M => 0,
            AuxiliaryKind::S => 1,
            AuxiliaryKind::T => 2,
            AuxiliaryKind::D => 3,
            AuxiliaryKind::SumOffset => 4,
            AuxiliaryKind::H => 5,
            AuxiliaryKind::F => 6,
        };
        self.output_times[index]
    }
}

/// The overrides of the path (MD12020 to 12100).
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct PathOverrides {
    feed: ([f64; 31], bool),
    rapid: ([f64; 31], bool),
    limit: f64,
}

impl PathOverrides {
    pub(in crate::sinumerik) fn new(data: &MachineData) -> Self {
        let general = &data.general;
        Self {
            feed: (general.ovr_factor_feedrate, general.ovr_feed_is_gray_code),
            rapid: (general.ovr_factor_rapid_tra, general.ovr_rapid_is_gray_code),
            limit: general.ovr_factor_limit_bin,
        }
    }

    /// The factor of the feed, from DB21.DBB4 and 6.7.
    pub(in crate::sinumerik) fn feed(&self, code: u8, is_active: bool) -> f64 {
        let (factors, gray) = &self.feed;
        effective(factor(code, *gray, factors, self.limit), is_active, is_zero_setting(code, *gray))
    }

    /// The factor of rapid traverse, from DB21.DBB5 and 6.6.
    pub(in crate::sinumerik) fn rapid(&self, code: u8, is_active: bool) -> f64 {
        let (factors, gray) = &self.rapid;
        effective(factor(code, *gray, factors, self.limit.min(1.0)), is_active, is_zero_setting(code, *gray))
    }
}

/// From the data of a channel.
pub(in crate::sinumerik) fn programs(
    data: &MachineData,
    channel: ChannelNumber,
    axes: &PerAxis<AxisParameters>,
    cycle: Time,
) -> ProgramParameters {
    let md = &data.channels[channel];
    let setting = &data.channel_settings[channel];
    let mut modal = Modal::default();
    for GFunction { group, .. } in Modal::default().groups() {
        let index = md.gcode_reset_values.of(group);
        if index > 0 {
            // A function that OpenNCK does not have leaves the first one of the table.
            modal.set(GFunction { group, index });
        }
    }
    let times = [
        (md.auxfu_m_sync_type, OutputTime::Before),
        (md.auxfu_s_sync_type, OutputTime::During),
        (md.auxfu_t_sync_type, OutputTime::Before),
        (md.auxfu_d_sync_type, OutputTime::Before),
        (md.auxfu_dl_sync_type, OutputTime::Before),
        (md.auxfu_h_sync_type, OutputTime::Before),
        (md.auxfu_f_sync_type, OutputTime::Never),
    ];
    let of_channel = axes.iter().filter(|(_, axis)| axis.exists && axis.channel == channel);
    let spindles: Vec<_> =
        of_channel.filter_map(|(number, axis)| Some((axis.spindle.as_ref()?.number, number))).collect();
    let has_master = spindles.iter().any(|(number, _)| *number == md.spind_def_master_spind);
    let own_axes = program_axes(data, md, channel, axes);
    ProgramParameters {
        jerk: PathJerk::new(data, &own_axes.path, axes, (md.max_path_jerk, cycle)),
        axes: own_axes,
        master_spindle: if has_master { md.spind_def_master_spind } else { 0 },
        spindles,
        outputs_m19: md.spos_to_vdi & 1 == 1,
        speed_stays: md.s_values_active_after_reset,
        r_parameters: u32::try_from(md.mm_num_r_param).unwrap_or(0),
        modal,
        circle_tolerance: Position::from_user(md.circle_error_const).increments() as f64,
        circle_tolerance_share: md.circle_error_factor,
        output_times: times.map(|(datum, predefined)| OutputTime::new(datum, predefined)),
        associated_stops: [md.auxfu_assoc_m0_value, md.auxfu_assoc_m1_value],
        quick_is_free: md.auxfu_quick_blockchange == 1,
        whole_h_functions: md.auxfu_h_type_int == 1,
        outputs_end_of_subprogram: md.spf_end_to_vdi & 1 == 1,
        outputs_m1_only_active: md.spf_end_to_vdi & 2 == 2,
        feed_stays: md.f_values_active_after_reset,
        default_feed: setting.default_feed,
        dry_run: (setting.dry_run_feed, setting.dry_run_feed_mode),
        dry_run_change: ChangeTime::new(data.general.dryrun_mask),
        skip_change: ChangeTime::new(data.general.slash_mask),
        auxiliary_groups: auxiliary_groups(md),
        stopping_functions: data.general.m_no_fct_stopre.into_iter().filter(|number| *number >= 0).collect(),
        replaced_functions: replaced_functions(data),
        rapid_is_linear: md.g0_linear_mode,
        serupro_passes_m0: data.general.serupro_mask & 1 == 1,
        serupro_ignores_overrides: data.general.serupro_mask & 16 == 16,
        serupro_speed: (md.serupro_speed_mode, md.serupro_speed_factor),
        approach_feed: setting.approach_feed,
        increments_traverse_offsets: setting.frame_offset_incr_prog,
        shown_groups: md.gcode_groups_to_plc,
        shows_groups_in_order: md.gcode_groups_to_plc_mode & 1 == 1,
    }
}

/// MD10715 with MD10716. Stops, ends, and functions of spindles cannot be replaced.
fn replaced_functions(data: &MachineData) -> Vec<(i32, String)> {
    let rows = data.general.m_no_fct_cycle.iter().zip(&data.general.m_no_fct_cycle_name);
    let is_replaced = |number: i32, name: &str| {
        number > 5 && ![17, 19, 30, 70].contains(&number) && !(40..=45).contains(&number) && !name.is_empty()
    };
    rows.filter(|(number, name)| is_replaced(**number, name)).map(|(number, name)| (*number, name.clone())).collect()
}

fn program_axes(
    data: &MachineData,
    md: &Channel,
    channel: ChannelNumber,
    axes: &PerAxis<AxisParameters>,
) -> ProgramAxes {
    let known = |axis: AxisNumber| axes[axis].channel == channel || data.channel_knows(channel, axis);
    let machine_axis = |number: u8| AxisNumber::new(number).filter(|axis| axes[*axis].exists && known(*axis));
    let channel_axis = |index: usize| md.axconf_machax_used.get(index).copied().and_then(machine_axis);
    let geometry = md.axconf_geoax_assign_tab.map(|number| channel_axis(usize::from(number).checked_sub(1)?));
    let mut rows: Vec<(String, AxisNumber)> = Vec::new();
    let mut add = |name: &str, axis: Option<AxisNumber>| {
        if let (Some(axis), false) = (axis, name.is_empty()) {
            rows.push((name.to_owned(), axis));
        }
    };
    for (name, axis) in md.axconf_geoax_name_tab.iter().zip(geometry) {
        add(name, axis);
    }
    for (index, name) in md.axconf_chanax_name_tab.iter().enumerate() {
        add(name, channel_axis(index));
    }
    for axis in MachineData::axis_numbers() {
        add(data.axis_name(axis), machine_axis(axis.number()));
        add(&format!("AX{axis}"), machine_axis(axis.number()));
    }
    let name = |(name, axis): &(String, AxisNumber)| AxisName {
        name: name.clone(),
        kind: match (axes[*axis].rotary, axes[*axis].modulo) {
            (false, _) => AxisKind::Linear,
            (true, false) => AxisKind::Rotary,
            (true, true) => AxisKind::Modulo,
        },
        is_beyond_modulo: axes[*axis].beyond_modulo,
        is_shortest_by_default: axes[*axis].shortest_by_default,
    };
    let is_synchronous = |axis: AxisNumber| data.axes[axis].gantry_axis_type > 10;
    let mut path = ArrayVec::<AxisNumber, PATH_AXES>::new();
    let others = (0..md.axconf_machax_used.len()).map(channel_axis);
    for axis in geometry.into_iter().chain(others).flatten() {
        if !is_synchronous(axis) && axes[axis].spindle.is_none() && !path.contains(&axis) {
            // A channel with more axes than a path can have interpolates the first of them.
            let _ = path.try_push(axis);
        }
    }
    let geometry = geometry.map(|axis| path.iter().position(|member| Some(*member) == axis));
    ProgramAxes {
        names: Arc::new(AxisNames::new(rows.iter().map(name))),
        machine_axes: rows.iter().map(|(_, axis)| *axis).collect(),
        counted: std::array::from_fn(|place| geometry.contains(&Some(place))),
        path,
        geometry,
    }
}

impl ProgramParameters {
    /// The feed of a block in a search by program test: MD22600 selects the dry run feed or the programmed one, and whether MD22601 multiplies
    /// it.
    pub(in crate::sinumerik) fn search_feed(&self, feed: Feed) -> Feed {
        let Feed::Programmed(programmed) = feed else { return feed };
        let (mode, factor) = self.serupro_speed;
        let dry = self.dry_run.0 * Position::PER_USER_UNIT / 60.0;
        Feed::Programmed(match mode {
            0 => dry * factor,
            1 => programmed * factor,
            2 => dry,
            _ => programmed,
        })
    }

    /// The feed of a block while the dry run is active: SD42101 decides between SD42100 and the programmed feed.
    pub(in crate::sinumerik) fn dry_run_feed(&self, feed: Feed, per_revolution: bool, is_active: bool) -> Feed {
        let Feed::Programmed(programmed) = feed else { return feed };
        if !is_active {
            return feed;
        }
        let dry = self.dry_run.0 * Position::PER_USER_UNIT / 60.0;
        Feed::Programmed(match self.dry_run.1 {
            // G95 acts as G94 with SD42100.
            _ if per_revolution => dry,
            0 => programmed.max(dry),
            1 => programmed.min(dry),
            _ => dry,
        })
    }
}
