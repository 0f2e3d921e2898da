//! Gears, leadscrew, encoder lines and directions: the mechanical data of the control, and those of the simulated mechanics.
//!
//! The simulated mechanics correspond to the machine data at opening: an archive alone is a working machine. When these data are changed
//! later (they take effect at power on), the control converts counts and velocities with its new data, and the mechanics do not change.
//! Actual values and drives are then wrong by the ratio, as on a machine with wrong data. Read by position control and by the stage that
//! takes the encoder signals. An axis whose data match needs no extra computing time.
//!
//! One line of a linear scale is MD31010, of a rotary encoder MD31030 (rotary axis: 360 degrees) divided by MD31020, multiplied by MD31080
//! / MD31070, and multiplied by MD31050 / MD31060 if the encoder is at the motor (MD31040 = 0). One revolution of the motor is MD31030
//! multiplied by MD31050 / MD31060.
//!
//! MD32100 = −1 reverses the traversing direction, for motor and encoder, so position control does not change. MD32110 = −1 reverses the
//! encoder alone: if the mechanics do not need it, the loop is unstable and the axis runs away.
//!
//! Choices: the mechanics have the load gear of the first parameter set. A factor or a length of 0 counts as 1. The smallest step of an
//! encoder is `resolution` of the plant, not MD31020 with a multiplication.

use crate::motion::Feedback;
use crate::sinumerik::machine_data::Axis;
use crate::units::Position;

/// Values per measuring system, for index 0 and 1.
pub(in crate::sinumerik) type PerEncoder<T> = [T; 2];

/// Number of parameter sets of an axis.
pub const PARAMETER_SETS: usize = 6;

/// Distances in mm or degrees; the sign is the direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mechanics {
    /// Distance of one revolution of the motor, by parameter set.
    motor: [f64; PARAMETER_SETS],
    /// Distance of one line of each encoder, by parameter set.
    encoders: [[f64; 2]; PARAMETER_SETS],
}

impl Mechanics {
    /// The mechanical data from machine data.
    #[must_use]
    pub fn new(md: &Axis) -> Self {
        let ratio = |above: i32, below: i32| {
            let whole = |value: i32| if value == 0 { 1.0 } else { f64::from(value) };
            whole(above) / whole(below)
        };
        let sign = |value: i32| if value < 0 { -1.0 } else { 1.0 };
        let length = |value: f64| if value > 0.0 { value } else { 1.0 };
        let revolution = if md.is_rot_ax { 360.0 } else { length(md.leadscrew_pitch) };
        let direction = sign(md.ax_motion_dir);
        let load_gear = |set: usize| ratio(md.drive_ax_ratio_denom[set], md.drive_ax_ratio_numera[set]);
        let line = |set: usize, encoder: usize| {
            let measuring_gear = ratio(md.drive_enc_ratio_numera[encoder], md.drive_enc_ratio_denom[encoder]);
            let way = if md.enc_is_linear[encoder] {
                length(md.enc_grid_point_dist[encoder])
            } else if md.enc_is_direct[encoder] {
                revolution * ratio(1, md.enc_resol[encoder]) * measuring_gear
            } else {
                revolution * ratio(1, md.enc_resol[encoder]) * measuring_gear * load_gear(set)
            };
            way * direction * sign(md.enc_feedback_pol[encoder])
        };
        Self {
            motor: std::array::from_fn(|set| revolution * load_gear(set) * direction),
            encoders: std::array::from_fn(|set| [line(set, 0), line(set, 1)]),
        }
    }

    /// The distance of one revolution of the motor in the first parameter set, in mm or degrees, without a direction.
    #[must_use]
    pub fn motor_revolution(&self) -> f64 {
        self.motor[0].abs()
    }

    /// The distance of one revolution of the motor in a parameter set, 0 to 5, in mm or degrees, with the sign of its direction.
    #[must_use]
    pub(in crate::sinumerik) fn motor_turn(&self, set: usize) -> f64 {
        self.motor.get(set).copied().unwrap_or(self.motor[0])
    }

    /// The distance of one line of an encoder, 0 or 1, in the first parameter set, in mm or degrees, without a direction.
    #[must_use]
    pub fn encoder_line(&self, encoder: usize) -> f64 {
        self.encoders[0][encoder].abs()
    }

    /// The deviation from the simulated mechanics in a parameter set; `None` if the data match.
    #[must_use]
    pub fn misfit(&self, actual: &Self, set: usize) -> Option<Misfit> {
        let misfit = Misfit {
            command: actual.motor[0] / self.motor[set],
            encoders: [0, 1].map(|encoder| self.encoders[set][encoder] / actual.encoders[0][encoder]),
        };
        (misfit != Misfit { command: 1.0, encoders: [1.0; 2] }).then_some(misfit)
    }
}

impl Default for Mechanics {
    fn default() -> Self {
        Self::new(&Axis::default())
    }
}

/// The factors by which the control's data deviate from the simulated mechanics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Misfit {
    /// Velocity of the slide divided by the commanded velocity.
    pub command: f64,
    /// Distance measured by each encoder divided by the distance of the slide.
    pub encoders: [f64; 2],
}

impl Misfit {
    /// The value measured by an encoder.
    #[must_use]
    pub fn shown(&self, encoder: usize, value: Position) -> Position {
        #[expect(clippy::cast_possible_truncation, reason = "a position for display; the cast saturates")]
        Position::new((value.increments() as f64 * self.encoders[encoder]).round() as i64)
    }

    /// The signals of encoders and drive as the control interprets them.
    #[must_use]
    pub(in crate::sinumerik) fn seen(&self, feedback: &Feedback, active: usize) -> Feedback {
        let mut seen = *feedback;
        for (index, encoder) in seen.encoders.iter_mut().enumerate() {
            encoder.value = self.shown(index, encoder.value);
            encoder.zero_mark = encoder.zero_mark.map(|mark| self.shown(index, mark));
            seen.half_count[index] = self.shown(index, seen.half_count[index]).abs();
        }
        seen.velocity *= self.encoders[active];
        seen
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mechanics from changed machine data of an axis.
    fn with(change: impl FnOnce(&mut Axis)) -> Mechanics {
        let mut md = Axis::default();
        change(&mut md);
        Mechanics::new(&md)
    }

    fn misfit(change: impl FnOnce(&mut Axis)) -> Option<(f64, f64)> {
        with(change).misfit(&Mechanics::default(), 0).map(|misfit| (misfit.command, misfit.encoders[0]))
    }

    #[test]
    fn what_is_as_the_iron_was_built_fits() {
        assert_eq!(misfit(|_| {}), None);
        assert_eq!(misfit(|md| md.enc_grid_point_dist = [0.02; 2]), None, "no linear scale");
        assert_eq!(misfit(|md| md.drive_ax_ratio_denom[1] = 3), None, "another parameter set");
    }

    /// The mechanics: 10 mm of pitch, 2048 lines at the motor, gears 1:1.
    #[test]
    fn wrong_data_miss_by_their_ratio() {
        // Twice the pitch: every line counts for twice its distance, and the motor makes half the revolutions.
        assert_eq!(misfit(|md| md.leadscrew_pitch = 20.0), Some((0.5, 2.0)));
        // A load gear of 4 motor revolutions for 1 load revolution: a motor encoder measures a quarter; the motor turns 4 times as fast.
        assert_eq!(misfit(|md| md.drive_ax_ratio_numera[0] = 4), Some((4.0, 0.25)));
        // The lines and the measuring gear concern the encoder alone.
        assert_eq!(misfit(|md| md.enc_resol = [1024; 2]), Some((1.0, 2.0)));
        assert_eq!(misfit(|md| md.drive_enc_ratio_numera = [2; 2]), Some((1.0, 2.0)));
        assert_eq!(misfit(|md| md.drive_enc_ratio_denom = [2; 2]), Some((1.0, 0.5)));
    }

    #[test]
    fn a_load_gear_does_not_concern_an_encoder_at_the_machine() {
        let built = with(|md| md.enc_is_direct[0] = true);
        let now = with(|md| (md.enc_is_direct[0], md.drive_ax_ratio_numera[0]) = (true, 4));
        assert_eq!(now.misfit(&built, 0), Some(Misfit { command: 4.0, encoders: [1.0, 0.25] }));
    }

    /// DYN-06
    #[test]
    fn the_traversing_direction_turns_motor_and_encoder_and_the_polarity_the_encoder_alone() {
        assert_eq!(misfit(|md| md.ax_motion_dir = -1), Some((-1.0, -1.0)));
        assert_eq!(misfit(|md| md.enc_feedback_pol = [-1; 2]), Some((1.0, -1.0)));
    }

    #[test]
    fn a_factor_of_zero_divides_by_nothing() {
        let zero = with(|md| (md.drive_ax_ratio_numera[0], md.drive_enc_ratio_denom) = (0, [0; 2]));
        assert_eq!(zero.misfit(&Mechanics::default(), 0), None);
        let zero =
            with(|md| (md.leadscrew_pitch, md.enc_grid_point_dist, md.enc_is_linear) = (0.0, [0.0; 2], [true; 2]));
        assert_eq!(zero.misfit(&with(|md| md.leadscrew_pitch = 1.0), 0).map(|misfit| misfit.command), Some(1.0));
    }
}
