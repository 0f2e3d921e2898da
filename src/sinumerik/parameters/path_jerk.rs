//! The jerk limitation of a path (SOFT): MD32431 of its axes, and MD20600 of the path. The stage of programs asks for the window when a path
//! begins.

use crate::motion::path::{LONGEST_WINDOW, PATH_AXES};
use crate::sinumerik::machine_data::MachineData;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::units::{AxisNumber, PerAxis, Position, Time};

/// What the jerk limitation of a path (SOFT) depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::sinumerik) struct PathJerk {
    /// The longest time that an axis needs to its largest acceleration (MD32431), in seconds.
    of_axes: f64,
    /// MD20600, in increments per second cubed.
    of_path: f64,
    /// MD32300 of each axis of the path.
    acceleration: [f64; PATH_AXES],
    /// The cycle, in seconds.
    cycle: f64,
}

impl PathJerk {
    pub(super) fn new(
        data: &MachineData,
        path: &[AxisNumber],
        axes: &PerAxis<AxisParameters>,
        (path_jerk, cycle): (f64, Time),
    ) -> Self {
        const METRE: f64 = 1_000.0 * Position::PER_USER_UNIT;
        let turn = |axis: AxisNumber| if axes[axis].rotary { 360.0 * Position::PER_USER_UNIT } else { METRE };
        let time = |axis: &AxisNumber| axes[*axis].maximum_acceleration / (data.axes[*axis].max_ax_jerk * turn(*axis));
        let mut acceleration = [0.0; PATH_AXES];
        for (place, axis) in path.iter().enumerate() {
            acceleration[place] = axes[*axis].maximum_acceleration;
        }
        let of_axes = path.iter().map(time).fold(0.0, f64::max);
        Self { of_axes, of_path: path_jerk * METRE, acceleration, cycle: cycle.seconds() }
    }

    /// The cycles over which SOFT spreads a change of the acceleration: no axis exceeds MD32431, and the path not MD20600, at any acceleration
    /// that the axes can have. The path is the way of the axes in `counted` (FGROUP), and of the others in blocks that move none of them.
    pub(in crate::sinumerik) fn window(&self, counted: [bool; PATH_AXES]) -> usize {
        let along = |wanted: bool| {
            let axes = self.acceleration.iter().zip(counted).filter(|(_, is_counted)| *is_counted == wanted);
            axes.map(|(acceleration, _)| acceleration * acceleration).sum::<f64>().sqrt()
        };
        let seconds = self.of_axes.max(along(true).max(along(false)) / self.of_path);
        let cycles = (seconds / self.cycle - 1e-6).ceil();
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the cast saturates, and is bounded"
        )]
        let cycles = cycles as usize;
        cycles.clamp(1, LONGEST_WINDOW)
    }
}
