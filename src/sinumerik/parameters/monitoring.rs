//! The limits of monitoring in the units of the model, recalculated with all parameters.
//!
//! Motor speeds and encoder frequencies are converted into axis velocities with the distances from `mechanics.rs`, for the first parameter
//! set.

use crate::sinumerik::machine_data::Axis;
use crate::sinumerik::parameters::mechanics::Mechanics;
use crate::sinumerik::parameters::mechanics::PerEncoder;
use crate::units::{Position, Time};

/// The monitoring of an encoder according to MD36310.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) struct ZeroMarks {
    /// Number of wrong zero marks that raises the alarm; `None`: not monitored.
    pub errors: Option<u32>,
    /// 100: no monitoring of the encoder.
    pub off: bool,
    /// Above 100: a fault is reported as pollution, 25010 and 25011.
    pub pollution: bool,
    /// MD34300: distance between two zero marks.
    pub spacing: Position,
}

/// The limits of one axis.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::sinumerik) struct Monitoring {
    /// MD36040 in cycles.
    pub standstill_cycles: u64,
    /// MD36050.
    pub clamping_tolerance: Position,
    /// MD36400.
    pub contour_tolerance: Position,
    /// MD36210 of the rated speed (MD32250, MD32260), at the load.
    pub speed_setpoint_limit: f64,
    /// MD36210 itself.
    pub speed_setpoint_percent: f64,
    /// MD36220 in cycles.
    pub speed_setpoint_cycles: u64,
    /// MD36300 as a velocity.
    pub frequency_limit: PerEncoder<f64>,
    /// MD36302 of it.
    pub frequency_low: PerEncoder<f64>,
    /// MD36300 in Hz and MD36302 in per cent.
    pub frequency_data: PerEncoder<[f64; 2]>,
    /// MD36310.
    pub zero_marks: PerEncoder<ZeroMarks>,
    /// MD36500.
    pub switch_over_tolerance: Position,
    /// MD36510; `None`: off.
    pub encoder_difference: Option<Position>,
}

/// The limits from machine data.
pub(in crate::sinumerik) fn monitoring(md: &Axis, cycle: Time) -> Monitoring {
    let cycles = |seconds: f64| if seconds > 0.0 { Time::from_seconds(seconds).in_cycles(cycle) } else { 0 };
    let mechanics = Mechanics::new(md);
    let revolution = mechanics.motor_revolution() * Position::PER_USER_UNIT;
    // MD32250 percent of the output give MD32260; 0 counts as 100 percent.
    let full_speed = if md.rated_outval > 0.0 { md.rated_velo * 100.0 / md.rated_outval } else { md.rated_velo };
    let frequency_limit =
        [0, 1].map(|encoder| md.enc_freq_limit[encoder] * mechanics.encoder_line(encoder) * Position::PER_USER_UNIT);
    Monitoring {
        standstill_cycles: cycles(md.standstill_delay_time),
        clamping_tolerance: Position::from_user(md.clamp_pos_tol),
        contour_tolerance: Position::from_user(md.contour_tol),
        speed_setpoint_percent: md.ctrlout_limit,
        speed_setpoint_limit: (md.ctrlout_limit / 100.0 * full_speed / 60.0 * revolution).min(f64::MAX),
        speed_setpoint_cycles: cycles(md.ctrlout_limit_time),
        frequency_limit,
        frequency_low: [0, 1].map(|encoder| frequency_limit[encoder] * md.enc_freq_limit_low[encoder] / 100.0),
        frequency_data: [0, 1].map(|encoder| [md.enc_freq_limit[encoder], md.enc_freq_limit_low[encoder]]),
        zero_marks: [0, 1].map(|encoder| {
            let said = u32::try_from(md.enc_zero_monitoring[encoder]).unwrap_or(0);
            ZeroMarks {
                errors: match said {
                    0 | 100 => None,
                    1..100 => Some(said),
                    101.. => Some(said - 100),
                },
                off: said == 100,
                pollution: said > 100,
                spacing: Position::from_user(md.enc_refp_marker_dist[encoder]).max(Position::new(1)),
            }
        }),
        switch_over_tolerance: Position::from_user(md.enc_change_tol),
        encoder_difference: (md.enc_diff_tol > 0.0).then(|| Position::from_user(md.enc_diff_tol)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(change: impl FnOnce(&mut Axis)) -> Monitoring {
        let mut md = Axis::default();
        change(&mut md);
        monitoring(&md, Time::from_millis(2))
    }

    fn assert_mm_per_second(increments: f64, expected: f64) {
        let found = increments / Position::PER_USER_UNIT;
        assert!((found - expected).abs() < 1e-9 * expected, "{found} mm/s instead of {expected}");
    }

    #[test]
    fn a_speed_of_the_motor_becomes_a_velocity_of_the_axis() {
        // 110 % of 3000 rev/min are 55 rev/s; one turn moves 10 mm.
        assert_mm_per_second(limits(|_| {}).speed_setpoint_limit, 550.0);
        // With 80 % output at rated speed, 100 % are 3750 rev/min: 110 % of it are 68.75 rev/s.
        assert_mm_per_second(limits(|md| md.rated_outval = 80.0).speed_setpoint_limit, 687.5);
        // A gear of 5 : 2: the motor turns 2.5 times per turn of the screw.
        let geared = limits(|md| (md.drive_ax_ratio_numera[0], md.drive_ax_ratio_denom[0]) = (5, 2));
        assert_mm_per_second(geared.speed_setpoint_limit, 220.0);
        assert_mm_per_second(limits(|md| md.is_rot_ax = true).speed_setpoint_limit, 55.0 * 360.0);
    }

    #[test]
    fn a_frequency_of_the_encoder_becomes_a_velocity_of_the_axis() {
        // 300 kHz / 2048 lines per turn * 10 mm per turn.
        let expected = 300_000.0 / 2048.0 * 10.0;
        assert_mm_per_second(limits(|_| {}).frequency_limit[0], expected);
        assert_mm_per_second(limits(|_| {}).frequency_low[1], expected * 0.999);
        // A linear scale of 0.01 mm: 300 kHz are 3000 mm/s.
        assert_mm_per_second(limits(|md| md.enc_is_linear[0] = true).frequency_limit[0], 3_000.0);
        // On a motor that turns twice per turn of the screw half the velocity; no change for an encoder on the screw.
        let gear = |md: &mut Axis| md.drive_ax_ratio_numera[0] = 2;
        assert_mm_per_second(limits(gear).frequency_limit[0], expected / 2.0);
        let direct = limits(|md| (md.enc_is_direct[0], md.drive_ax_ratio_numera[0]) = (true, 2));
        assert_mm_per_second(direct.frequency_limit[0], expected);
        // A measuring gear: three turns of the motor are one turn of the encoder.
        assert_mm_per_second(limits(|md| md.drive_enc_ratio_numera[0] = 3).frequency_limit[0], expected * 3.0);
    }

    #[test]
    fn zero_mark_monitoring_is_off_at_0_and_100_and_attenuated_above() {
        let said = |value| limits(|md| md.enc_zero_monitoring[0] = value).zero_marks[0];
        assert_eq!((said(0).errors, said(0).off), (None, false));
        assert_eq!((said(3).errors, said(3).off, said(3).pollution), (Some(3), false, false));
        assert_eq!((said(100).errors, said(100).off), (None, true));
        assert_eq!((said(102).errors, said(102).off, said(102).pollution), (Some(2), false, true));
        assert_eq!(said(-1), said(0));
    }
}
