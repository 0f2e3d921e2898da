//! The active machine data of a spindle in the units of the model (MD35000 to 35500, 12060, 12070).
//!
//! An axis is a spindle if MD35000 gives it a number and it is a modulo rotary axis (MD30300, MD30310). Speeds are increments per second. The
//! data of a gear stage have its number as index; without gear stages (MD35010 = 0) those of stage 1 act.

use crate::nc_program::Dimension;
use crate::sinumerik::machine_data::{Axis, MachineData};
use crate::sinumerik::parameters::overrides::factor;
use crate::units::{AxisNumber, Position, Time};

/// The gear stages of a spindle.
pub(in crate::sinumerik) const GEAR_STAGES: u8 = 5;

/// The data of one gear stage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GearStage {
    /// MD35130.
    pub maximum_speed: f64,
    /// MD35140.
    pub minimum_speed: f64,
    /// MD35200.
    pub acceleration: f64,
    /// MD35120 and MD35110: where M40 takes it.
    pub automatic: [f64; 2],
    /// MD35300.
    pub positioning_speed: f64,
    /// MD35210.
    pub positioning_acceleration: f64,
}

/// A spindle.
#[derive(Clone, Debug, PartialEq)]
pub struct SpindleParameters {
    /// MD35000.
    pub number: u8,
    /// Its gear stages, from 1.
    pub stages: [GearStage; GEAR_STAGES as usize],
    /// MD35040: RESET and the end of a program do not stop it.
    pub runs_on: bool,
    /// MD35100.
    pub speed_limit: f64,
    /// MD35150.
    pub tolerance: f64,
    /// MD35160, while 3.6 = 1.
    pub external_limit: f64,
    /// MD35500: a path with a feed waits for the speed.
    pub path_waits: bool,
    /// MD35010 bits 0 and 1: it has gear stages.
    pub has_stages: bool,
    /// MD35010 bit 3.
    pub simulates_change: bool,
    /// MD35090.
    pub stage_count: u8,
    /// MD35400.
    pub oscillation_speed: f64,
    /// MD35410.
    pub oscillation_acceleration: f64,
    /// MD35430 as a sign.
    first_direction: i8,
    /// MD35440 and MD35450 in cycles.
    oscillation_times: [u64; 2],
    /// MD10192 in cycles.
    pub change_wait_cycles: u64,
    /// MD35350 as a sign.
    pub search_direction: i8,
    /// SD43240 and SD43250: the angle of M19, and how it is meant.
    pub m19: (f64, Dimension),
    /// MD35035 bit 19: SPOS, SPOSA and M19 output M19.
    pub outputs_m19: bool,
    /// SD43210 and SD43220: G25 S and G26 S.
    pub programmed_limits: [f64; 2],
    /// SD41200, or MD32020 if it is 0, and MD32010.
    pub jog_speeds: [f64; 2],
    /// MD12060.
    override_is_gray: bool,
    /// MD12070.
    override_factors: [f64; 31],
    /// MD12100.
    override_limit: f64,
}

/// Increments per second of a speed of 1 rev/min.
pub(in crate::sinumerik) const REVOLUTION_PER_MINUTE: f64 = 360.0 * Position::PER_USER_UNIT / 60.0;

/// The spindle of an axis, if it is one.
pub(super) fn spindle(data: &MachineData, number: AxisNumber, cycle: Time) -> Option<Box<SpindleParameters>> {
    let md = &data.axes[number];
    if !is_spindle(md) {
        return None;
    }
    let (settings, general) = (&data.axis_settings[number], &data.general);
    let speed = |value: f64| value * REVOLUTION_PER_MINUTE;
    let cycles = |seconds: f64| Time::from_seconds(seconds.max(0.0)).in_cycles(cycle);
    let stage = |stage: usize| GearStage {
        maximum_speed: speed(md.gear_step_max_velo_limit[stage]),
        minimum_speed: speed(md.gear_step_min_velo_limit[stage]),
        acceleration: acceleration(md.gear_step_speedctrl_accel[stage]),
        automatic: [md.gear_step_min_velo[stage], md.gear_step_max_velo[stage]].map(speed),
        positioning_speed: speed(md.spind_posctrl_velo[stage]),
        positioning_acceleration: acceleration(md.gear_step_posctrl_accel[stage]),
    };
    let jog = data.setting.jog_spind_set_velo;
    Some(Box::new(SpindleParameters {
        number: md.spind_assign_to_machax,
        stages: [1, 2, 3, 4, 5].map(stage),
        runs_on: md.spind_active_after_reset != 0,
        speed_limit: speed(md.spind_velo_limit),
        tolerance: md.spind_des_velo_tol,
        external_limit: speed(md.spind_extern_velo_limit),
        path_waits: md.spind_on_speed_at_ipo_start != 0,
        has_stages: md.gear_step_change_enable & 3 != 0,
        simulates_change: md.gear_step_change_enable & 8 != 0,
        stage_count: u8::try_from(md.num_gear_steps).unwrap_or(1).min(GEAR_STAGES),
        oscillation_speed: speed(md.spind_oscill_des_velo),
        oscillation_acceleration: acceleration(md.spind_oscill_accel),
        first_direction: if md.spind_oscill_start_dir == 4 { -1 } else { 1 },
        oscillation_times: [md.spind_oscill_time_cw, md.spind_oscill_time_ccw].map(cycles),
        change_wait_cycles: cycles(general.gear_change_wait_time),
        search_direction: if md.spind_positioning_dir == 4 { -1 } else { 1 },
        m19: (settings.m19_spos, m19_dimension(settings.m19_sposmode)),
        outputs_m19: md.spind_function_mask >> 19 & 1 == 1,
        programmed_limits: [settings.spind_min_velo_g25, settings.spind_max_velo_g26].map(speed),
        jog_speeds: [if jog > 0.0 { jog } else { md.jog_velo }, md.jog_velo_rapid].map(speed),
        override_is_gray: general.ovr_spind_is_gray_code,
        override_factors: general.ovr_factor_spind_speed,
        override_limit: general.ovr_factor_limit_bin,
    }))
}

/// SD43250.
const fn m19_dimension(mode: u8) -> Dimension {
    match mode {
        1 => Dimension::Incremental,
        2 => Dimension::Shortest,
        4 => Dimension::FromPlus,
        5 => Dimension::FromMinus,
        _ => Dimension::Absolute,
    }
}

/// Whether an axis is a spindle.
pub(in crate::sinumerik) fn is_spindle(md: &Axis) -> bool {
    md.spind_assign_to_machax != 0 && md.is_rot_ax && md.rot_is_modulo
}

/// An acceleration in rev/s² in increments per second squared.
fn acceleration(value: f64) -> f64 {
    (value * 360.0 * Position::PER_USER_UNIT).max(1.0)
}

impl SpindleParameters {
    /// The factor of the spindle override, DBB19. Gray code 0 is no position of the switch: 100 % (S-04).
    #[must_use]
    pub fn override_factor(&self, code: u8) -> f64 {
        if self.override_is_gray && code & 0x1F == 0 {
            return 1.0;
        }
        factor(code, self.override_is_gray, &self.override_factors, self.override_limit)
    }

    /// One cycle of an oscillation: its direction, and the cycles that are left in it, this one included (MD35440 clockwise, MD35450
    /// counterclockwise). It begins when the spindle stands.
    #[must_use]
    pub fn next_oscillation(&self, before: Option<(i8, u64)>, stands: bool) -> Option<(i8, u64)> {
        let begins = |direction: i8| (direction, self.oscillation_times[usize::from(direction < 0)]);
        match before {
            None => stands.then(|| begins(self.first_direction)),
            Some((direction, left)) if left > 1 => Some((direction, left - 1)),
            Some((direction, _)) => Some(begins(-direction)),
        }
    }

    /// The data of a gear stage; those of stage 1 for 0.
    #[must_use]
    pub fn stage(&self, stage: u8) -> &GearStage {
        let index = usize::from(stage.clamp(1, GEAR_STAGES)) - 1;
        &self.stages[index]
    }
}
