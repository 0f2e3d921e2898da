//! The active machine data of one axis in the units of the model.

use crate::nc_program::Dimension;
use crate::sinumerik::machine_data::{Axis, MachineData};
use crate::sinumerik::parameters::compensation::{AxisCompensation, axis_compensation};
use crate::sinumerik::parameters::dynamics::{Dynamics, dynamics, jerk};
use crate::sinumerik::parameters::mechanics::{Mechanics, PerEncoder};
use crate::sinumerik::parameters::monitoring::{Monitoring, monitoring};
use crate::sinumerik::parameters::spindle::{SpindleParameters, spindle};
use crate::units::{AxisNumber, ChannelNumber, Position, Time};

/// Facts about an axis beside its machine data.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AxisPresence {
    /// The axis exists: it belongs to the channel, or machine data or the plant name it.
    pub exists: bool,
    /// The archive, or an entry that became active, gives MD30350: it decides whether a simulated axis outputs signals (E-26).
    pub output_is_given: bool,
    /// The archive does not give MD20050 for its channel: the default of that datum declares no geometry axis.
    pub geometry_by_default: bool,
    /// Its simulated mechanics: those of its machine data when the machine was opened.
    pub mechanics: Mechanics,
}

/// How an encoder gets its reference (MD34200 and MD30240).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// MD34200 = 1: the reference point approach ends at a zero mark, or at the substitute mark of an absolute encoder.
    ZeroMark,
    /// MD34200 = 3: two distance-coded marks give the position.
    DistanceCoded,
    /// MD34200 = 0 and MD30240 = 4: the encoder reads its position.
    Absolute,
    /// No reference point approach: MD34200 = 0 without an absolute encoder. The other values are not modelled.
    None,
}

/// A scale with distance-coded marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scale {
    /// MD34300: distance of two fixed marks.
    pub spacing: Position,
    /// MD34310: by this distance the mark between two fixed ones moves on from field to field.
    pub shift: Position,
    /// MD34320: it counts against the axis.
    pub inverted: bool,
}

/// The reference point approach of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// MD34000.
    pub cam_is_active: bool,
    /// MD34010 as a sign: +1 plus, −1 minus.
    pub cam_direction: f64,
    /// MD34020.
    pub cam_velocity: f64,
    /// MD34030.
    pub maximum_cam_distance: Position,
    /// MD34040.
    pub marker_velocity: PerEncoder<f64>,
    /// MD34050: the zero mark is searched from the rising cam edge.
    pub marker_reverse: PerEncoder<bool>,
    /// MD34060.
    pub maximum_marker_distance: PerEncoder<Position>,
    /// MD34070.
    pub position_velocity: f64,
    /// MD34080 + MD34090.
    pub move_distance: PerEncoder<Position>,
    /// MD34092.
    pub cam_shift: PerEncoder<Position>,
    /// MD34100.
    pub set_position: [Position; 4],
    /// MD34110; −1 for a spindle.
    pub cycle_number: i32,
    /// MD34200.
    pub mode: PerEncoder<u8>,
    /// How each encoder gets its reference.
    pub kind: PerEncoder<Kind>,
    /// MD34210.
    pub state: PerEncoder<u8>,
    /// MD34090 alone: with an absolute encoder, the actual value where the encoder reads 0; with distance-coded marks, that of the first mark.
    pub absolute_offset: PerEncoder<Position>,
    /// MD34300, MD34310, MD34320.
    pub scale: PerEncoder<Scale>,
    /// MD30455 bit 1 of a rotary axis: start and size of the range in which distance-coded marks give a position (MD30340, MD30330).
    pub modulo_range: Option<[Position; 2]>,
    /// MD34330: the axis does not travel to MD34100.
    pub stops_at_marks: PerEncoder<bool>,
    /// MD35000: a spindle. It has no reference point approach against a cam, and NC start does not need its reference.
    pub is_spindle: bool,
    /// MD35150 as a share of MD34040.
    pub creep_tolerance: f64,
}

/// The time in which an axis stands after its setpoint has come to rest. The manuals give no datum; a reference point approach that waits
/// longer ends.
const STANDSTILL_LIMIT: Time = Time::from_millis(10_000);

/// The gantry data of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Gantry {
    /// MD37110.
    pub warning_limit: Position,
    /// MD37120.
    pub trip_limit: Position,
    /// MD37130.
    pub trip_limit_not_synchronised: Position,
    /// MD37140.
    pub broken_up: bool,
    /// MD30450.
    pub concurrent: bool,
    /// MD20050: it is declared as a geometry axis.
    pub geometry_axis: bool,
    /// MD30505.
    pub hirth: bool,
    /// MD37135.
    pub tripped_difference: Position,
    /// MD37150 bit 0: extended monitoring.
    pub extended_monitoring: bool,
    /// MD37150 bit 1: the synchronous axis is referenced in the leading axis' direction.
    pub direction_of_leading_axis: bool,
    /// MD37150 bit 2: no message 10655.
    pub suppress_message: bool,
    /// MD37150.
    pub function_mask: u32,
}

impl AxisParameters {
    /// The velocity of a feed of a positioning axis, in mm/min or rev/min (FA, FDA, FC 18), in increments per second.
    pub(in crate::sinumerik) fn velocity_of_feed(&self, feed: f64) -> f64 {
        feed * Position::PER_USER_UNIT / 60.0 * if self.rotary { 360.0 } else { 1.0 }
    }

    /// Whether an axis can be positioned at a value in degrees: 16830 refuses absolute positions of a modulo axis outside of 0 to 359.999, unless
    /// MD30455 bit 0 makes them count modulo 360.
    pub(in crate::sinumerik) fn is_within_modulo(&self, degrees: f64, dimension: Dimension) -> bool {
        dimension == Dimension::Incremental || !self.modulo || self.beyond_modulo || (0.0..360.0).contains(&degrees)
    }
}

/// MD30460: what the PLC may do with an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlcAxis {
    /// Bit 4: only the PLC moves it.
    pub exclusive: bool,
    /// Bit 5: it is always a PLC axis.
    pub permanent: bool,
    /// Bit 6: feed disable 6.0 does not act while it is a PLC axis.
    pub ignores_feed_disable: bool,
    /// Bit 7: 36.3 leaves it out while it is a PLC axis.
    pub ignored_by_stationary: bool,
}

impl PlcAxis {
    const fn new(mask: u32) -> Self {
        Self {
            exclusive: mask >> 4 & 1 == 1,
            permanent: mask >> 5 & 1 == 1,
            ignores_feed_disable: mask >> 6 & 1 == 1,
            ignored_by_stationary: mask >> 7 & 1 == 1,
        }
    }

    /// Whether programs never get it.
    #[must_use]
    pub const fn is_reserved(self) -> bool {
        self.exclusive || self.permanent
    }
}

/// One axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisParameters {
    /// Whether the axis exists.
    pub exists: bool,
    /// No signals in its data block: simulated (MD30130 = 0), and MD30350 = 0 was given (E-26).
    pub silent: bool,
    /// MD30300.
    pub rotary: bool,
    /// The channel it belongs to after power on.
    pub channel: ChannelNumber,
    /// MD30200.
    pub encoders: u8,
    /// The datum of 0 with which the axis cannot move: MD32000 or MD32300 (O-30).
    pub immovable_by: Option<u32>,
    /// MD32000.
    pub maximum_velocity: f64,
    /// MD32300[0].
    pub maximum_acceleration: f64,
    /// MD32301, or MD32300 if it is 0.
    pub jog_acceleration: f64,
    /// MD37100 is 11 to 18: a synchronous axis of a gantry grouping.
    pub gantry_follower: bool,
    /// MD32060.
    pub positioning_velocity: f64,
    /// MD30460.
    pub plc_axis: PlcAxis,
    /// MD30552.
    pub automatic_get: u8,
    /// MD32310[0]: the factor of the acceleration at a corner of the path.
    pub overload: f64,
    /// SD43430 and SD43420 while SD43410 and SD43400 enable them.
    pub working_area: [Option<Position>; 2],
    /// MD32020, or SD41110 / SD41130 if it is not 0.
    pub jog_velocity: f64,
    /// MD32010.
    pub jog_rapid_velocity: f64,
    /// MD11330 and SD41010 times MD31090: the distances of INC1 to INC10000 and INCvar.
    pub increments: [Position; 6],
    /// MD32090: share of the velocity of keys for the DRF offset.
    pub overlay_factor: f64,
    /// MD32080; 0 means no limit.
    pub handwheel_maximum: Position,
    /// MD32082, in increments per second.
    pub handwheel_velocity: f64,
    /// MD32084.
    pub handwheel_stop_conditions: u32,
    /// Position control, and the data of each parameter set.
    pub dynamics: Dynamics,
    /// MD36020 in cycles.
    pub positioning_cycles: u64,
    /// [`STANDSTILL_LIMIT`] in cycles.
    pub standstill_cycles: u64,
    /// MD36060; if it is 0, an axis without any motion counts as below it.
    pub standstill_velocity: f64,
    /// MD36600: a hardware limit switch sets the setpoint velocity to 0 without a ramp.
    pub limit_without_ramp: bool,
    /// MD30310: a modulo rotary axis has no software limits.
    pub modulo: bool,
    /// MD30455 bit 0: absolute positions outside of 0 to 359.999 degrees are possible.
    pub beyond_modulo: bool,
    /// MD30455 bit 2: G90 positions it on the shortest way.
    pub shortest_by_default: bool,
    /// MD30455 bit 3: $VA_IM is the actual value, also with axis disable.
    pub actual_while_disabled: bool,
    /// MD36100 and MD36120, MD36110 and MD36130.
    pub software_limits: [[Position; 2]; 2],
    /// MD32000 / MD36610.
    pub emergency_deceleration: f64,
    /// MD36620 in cycles.
    pub servo_disable_cycles: u64,
    /// Reference point approach.
    pub reference: Reference,
    /// Gantry.
    pub gantry: Gantry,
    /// Its data as a spindle, if it is one.
    pub spindle: Option<Box<SpindleParameters>>,
    /// Monitoring.
    pub(in crate::sinumerik) monitoring: Monitoring,
    /// Backlash, leadscrew error, sag and temperature.
    pub(in crate::sinumerik) compensation: AxisCompensation,
}

pub(super) fn axis(
    data: &MachineData,
    number: AxisNumber,
    presence: AxisPresence,
    cycle: Time,
    servo_cycles: u32,
) -> AxisParameters {
    let md = &data.axes[number];
    let rotary = md.is_rot_ax;
    // mm/min, or rev/min of 360 degrees.
    let velocity = |value: f64| value * Position::PER_USER_UNIT / 60.0 * if rotary { 360.0 } else { 1.0 };
    // m/s², or rev/s².
    let acceleration = |value: f64| value * Position::PER_USER_UNIT * if rotary { 360.0 } else { 1_000.0 };
    let cycles = |seconds: f64| {
        if seconds > 0.0 { Time::from_seconds(seconds).in_cycles(cycle) } else { 0 }
    };
    let (linear_setting, rotary_setting) = (data.setting.jog_set_velo, data.setting.jog_rot_ax_set_velo);
    let setting = if rotary { rotary_setting } else { linear_setting };
    let maximum_velocity = velocity(md.max_ax_velo);
    let maximum_acceleration = acceleration(md.max_ax_accel[0]).max(1.0);
    let jog_acceleration = if md.jog_max_accel > 0.0 { acceleration(md.jog_max_accel) } else { maximum_acceleration };
    // G1 2.7.1 defines a grouping with machine axis 3 and does not mention MD20050, whose default declares it as a geometry axis.
    let only_by_default = || presence.geometry_by_default && data.has_default_geometry(number);
    let is_declared_geometry_axis = data.is_geometry_axis(number) && !only_by_default();
    let jerk = jerk(md, acceleration(1.0), [maximum_acceleration, jog_acceleration], cycle);
    AxisParameters {
        exists: presence.exists,
        silent: presence.output_is_given && md.ctrlout_type == 0 && !md.simu_ax_vdi_output,
        rotary,
        channel: data.home_channel(number),
        encoders: md.num_encs,
        immovable_by: immovable_by(md),
        maximum_velocity,
        maximum_acceleration,
        jog_acceleration,
        gantry_follower: md.gantry_axis_type > 10,
        positioning_velocity: velocity(md.pos_ax_velo).min(maximum_velocity),
        plc_axis: PlcAxis::new(md.base_function_mask),
        automatic_get: md.auto_get_type,
        overload: md.max_accel_ovl_factor[0].max(1.0),
        working_area: {
            let settings = &data.axis_settings[number];
            [
                settings.workarea_minus_enable.then(|| Position::from_user(settings.workarea_limit_minus)),
                settings.workarea_plus_enable.then(|| Position::from_user(settings.workarea_limit_plus)),
            ]
        },
        jog_velocity: velocity(if setting > 0.0 { setting } else { md.jog_velo }).min(maximum_velocity),
        jog_rapid_velocity: velocity(md.jog_velo_rapid).min(maximum_velocity),
        increments: increments(data, md),
        overlay_factor: md.handwh_velo_overlay_factor,
        handwheel_maximum: Position::from_user(md.handwh_max_incr_size),
        handwheel_velocity: match md.handwh_max_incr_velo_size {
            limit if limit > 0.0 => velocity(limit),
            _ => f64::INFINITY,
        },
        handwheel_stop_conditions: md.handwh_stop_cond,
        dynamics: dynamics(md, jerk, &presence.mechanics, &velocity),
        positioning_cycles: cycles(md.positioning_time),
        standstill_cycles: STANDSTILL_LIMIT.in_cycles(cycle),
        standstill_velocity: velocity(md.standstill_velo_tol).max(f64::MIN_POSITIVE),
        limit_without_ramp: md.brake_mode_choice == 1,
        modulo: md.is_rot_ax && md.rot_is_modulo,
        beyond_modulo: md.misc_function_mask & 1 == 1,
        shortest_by_default: md.misc_function_mask & 4 != 0,
        actual_while_disabled: md.misc_function_mask & 8 != 0,
        software_limits: [
            [md.pos_limit_minus, md.pos_limit_minus2].map(Position::from_user),
            [md.pos_limit_plus, md.pos_limit_plus2].map(Position::from_user),
        ],
        emergency_deceleration: (maximum_velocity / md.ax_emergency_stop_time.max(cycle.seconds())).max(1.0),
        servo_disable_cycles: cycles(md.servo_disable_delay_time),
        reference: reference(md, maximum_velocity, &velocity),
        gantry: gantry(md, is_declared_geometry_axis),
        spindle: spindle(data, number, cycle),
        monitoring: monitoring(md, cycle),
        compensation: axis_compensation(data, number, maximum_velocity, cycle.seconds(), servo_cycles),
    }
}

fn reference(md: &Axis, maximum_velocity: f64, velocity: &impl Fn(f64) -> f64) -> Reference {
    let bounded = |value: f64| velocity(value).min(maximum_velocity);
    Reference {
        cam_is_active: md.refp_cam_is_active,
        cam_direction: if md.refp_cam_dir_is_minus { -1.0 } else { 1.0 },
        cam_velocity: bounded(md.refp_velo_search_cam),
        maximum_cam_distance: Position::from_user(md.refp_max_cam_dist),
        marker_velocity: md.refp_velo_search_marker.map(bounded),
        marker_reverse: md.refp_search_marker_reverse,
        maximum_marker_distance: md.refp_max_marker_dist.map(Position::from_user),
        position_velocity: bounded(md.refp_velo_pos),
        move_distance: std::array::from_fn(|encoder| {
            Position::from_user(md.refp_move_dist[encoder]) + Position::from_user(md.refp_move_dist_corr[encoder])
        }),
        cam_shift: md.refp_cam_shift.map(Position::from_user),
        set_position: md.refp_set_pos.map(Position::from_user),
        cycle_number: if md.spind_assign_to_machax == 0 { md.refp_cycle_nr } else { -1 },
        mode: md.enc_refp_mode,
        kind: std::array::from_fn(|encoder| match (md.enc_refp_mode[encoder], md.enc_type[encoder]) {
            (1, _) => Kind::ZeroMark,
            (3, _) => Kind::DistanceCoded,
            (0, ABSOLUTE) => Kind::Absolute,
            _ => Kind::None,
        }),
        state: md.enc_refp_state,
        absolute_offset: md.refp_move_dist_corr.map(Position::from_user),
        scale: std::array::from_fn(|encoder| Scale {
            spacing: Position::from_user(md.enc_refp_marker_dist[encoder]),
            shift: Position::from_user(md.enc_marker_inc[encoder]),
            inverted: md.enc_invers[encoder],
        }),
        modulo_range: (md.is_rot_ax && md.misc_function_mask & 2 != 0)
            .then(|| [md.modulo_range_start, md.modulo_range].map(Position::from_user)),
        stops_at_marks: md.refp_stop_at_abs_marker,
        is_spindle: md.spind_assign_to_machax != 0,
        creep_tolerance: md.spind_des_velo_tol,
    }
}

/// MD30240 of an absolute encoder.
const ABSOLUTE: u8 = 4;

fn immovable_by(md: &Axis) -> Option<u32> {
    let needed = [(32000, md.max_ax_velo), (32300, md.max_ax_accel[0])];
    needed.into_iter().find(|(_, value)| *value <= 0.0).map(|(datum, _)| datum)
}

/// MD34210 = 2: an absolute encoder is adjusted; an incremental one was referenced and stands in exact stop fine.
pub(in crate::sinumerik) const ADJUSTED: u8 = 2;

impl Reference {
    /// Whether the position of the encoder is known before the axis is at its reference point: MD34330 then decides whether it travels there.
    #[must_use]
    pub(in crate::sinumerik) fn knows_position_before(&self, encoder: usize) -> bool {
        matches!(self.kind[encoder], Kind::DistanceCoded | Kind::Absolute)
    }

    /// A position that distance-coded marks gave.
    #[must_use]
    pub(in crate::sinumerik) fn coded(&self, position: Position) -> Position {
        let Some([start, size]) = self.modulo_range else { return position };
        start + Position::new((position - start).increments().rem_euclid(size.increments().max(1)))
    }

    /// Whether the machine data give this encoder a reference point approach.
    #[must_use]
    pub(in crate::sinumerik) fn has_approach(&self, encoder: usize) -> bool {
        self.kind[encoder] != Kind::None
    }
}

impl AxisParameters {
    /// A velocity in increments per second as values and machine data show it: mm/min, of a rotary axis rev/min.
    #[must_use]
    pub fn per_minute(&self, velocity: f64) -> f64 {
        velocity * 60.0 / Position::PER_USER_UNIT / if self.rotary { 360.0 } else { 1.0 }
    }

    /// A velocity that a machine datum gave, as it was entered.
    #[must_use]
    pub(in crate::sinumerik) fn entered_velocity(&self, velocity: f64) -> f64 {
        (self.per_minute(velocity) * 1e6).round() / 1e6
    }

    /// The datum, and its value, with which a reference point approach on this encoder cannot end: a velocity of 0 (O-30), or MD34200.
    #[must_use]
    pub(in crate::sinumerik) fn approach_hindered_by(&self, encoder: usize) -> Option<(u32, f64)> {
        let reference = &self.reference;
        let needs = match reference.kind[encoder] {
            Kind::ZeroMark => [reference.cam_is_active, true, true],
            Kind::DistanceCoded => [false, true, !reference.stops_at_marks[encoder]],
            // Only an adjusted encoder travels.
            Kind::Absolute if reference.state[encoder] != ADJUSTED => return None,
            Kind::Absolute => [false, false, !reference.stops_at_marks[encoder]],
            Kind::None => return Some((34200, f64::from(reference.mode[encoder]))),
        };
        let needed = [
            (34020, reference.cam_velocity, needs[0]),
            (34040, reference.marker_velocity[encoder], needs[1]),
            (34070, reference.position_velocity, needs[2]),
        ];
        if !needs.contains(&true) {
            return None;
        }
        let hinders = |(_, velocity, is_needed): &(u32, f64, bool)| *is_needed && *velocity <= 0.0;
        let datum = self.immovable_by.or_else(|| needed.into_iter().find(hinders).map(|(datum, ..)| datum));
        datum.map(|datum| (datum, 0.0))
    }
}

/// Limited to the range of a position, so that sums stay exact.
fn increments(data: &MachineData, md: &Axis) -> [Position; 6] {
    // Index 1 of MD31090 is the weight in the inch system.
    let weight = md.jog_incr_weight[usize::from(!data.general.scaling_system_is_metric && !md.is_rot_ax)];
    let [one, ten, hundred, thousand, ten_thousand] = data.general.jog_incr_size_tab;
    [one, ten, hundred, thousand, ten_thousand, data.setting.jog_var_incr_size]
        .map(|size| Position::from_user((size * weight).clamp(-1e9, 1e9)))
}

fn gantry(md: &Axis, geometry_axis: bool) -> Gantry {
    Gantry {
        warning_limit: Position::from_user(md.gantry_pos_tol_warning),
        trip_limit: Position::from_user(md.gantry_pos_tol_error),
        trip_limit_not_synchronised: Position::from_user(md.gantry_pos_tol_ref),
        broken_up: md.gantry_break_up,
        concurrent: md.is_concurrent_pos_ax,
        geometry_axis,
        hirth: md.hirth_is_active,
        tripped_difference: Position::from_user(md.gantry_act_pos_tol_error),
        extended_monitoring: md.gantry_function_mask & 1 != 0,
        direction_of_leading_axis: md.gantry_function_mask & 2 != 0,
        function_mask: md.gantry_function_mask,
        suppress_message: md.gantry_function_mask & 4 != 0,
    }
}
