//! Machine data of position control in the units of the model, and the data of each parameter set.
//!
//! Part of [`AxisParameters`](crate::sinumerik::parameters::AxisParameters); read by position control, exact stop and monitoring. The
//! active parameter set is part of the state of the axis.

use crate::motion::LONGEST_WINDOW;
use crate::sinumerik::machine_data::Axis;
use crate::sinumerik::parameters::mechanics::{Mechanics, Misfit, PARAMETER_SETS};
use crate::units::{AxisNumber, Position, Time};
use crate::variables::Input;

/// The balancing of feedforward: how it delays the setpoint that is compared with the actual value (MD32620).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FeedForward {
    /// 0, or controlled only by part programs because of MD32630.
    Off,
    /// 1 and 2.
    Pt1,
    /// 3 and 4.
    DeadTime,
}

/// The data of one parameter set of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterSet {
    /// MD32200 in 1/s.
    pub gain: f64,
    /// MD32610.
    pub feed_forward_weight: f64,
    /// MD32810, with MD32620 = 2 and 4 MD32800, in seconds.
    pub balancing_time: f64,
    /// MD32910 in seconds, 0 while MD32900 = 0.
    pub matching_time: f64,
    /// MD36000 × MD36012.
    pub exact_stop_coarse: Position,
    /// MD36010 × MD36012.
    pub exact_stop_fine: Position,
    /// MD36030 × MD36012.
    pub standstill_tolerance: Position,
    /// The data behind these three windows, for causes.
    pub stop_limits: StopLimits,
    /// MD36200, in increments per second.
    pub velocity_limit: f64,
    /// The deviation of the control's mechanical data from the simulated mechanics.
    pub misfit: Option<Misfit>,
}

/// The data of the windows at rest of a parameter set, with their own values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StopLimits {
    /// MD36000 in mm or degrees.
    pub coarse: f64,
    /// MD36010 in mm or degrees.
    pub fine: f64,
    /// MD36030 in mm or degrees.
    pub standstill: f64,
    /// MD36012, which multiplies them.
    pub factor: f64,
    /// The index of MD36012: the parameter set, the first one at 0.
    pub set: u8,
}

impl ParameterSet {
    /// A window at rest, and the data behind it in words.
    pub(in crate::sinumerik) fn window(&self, limit: StopLimit) -> (Position, String) {
        let window = match limit {
            StopLimit::Coarse => self.exact_stop_coarse,
            StopLimit::Fine => self.exact_stop_fine,
            StopLimit::Standstill => self.standstill_tolerance,
        };
        (window, self.stop_limits.names(limit))
    }
}

impl StopLimits {
    /// The inputs of a cause that tests a window: the datum, and MD36012 if it changes the window.
    pub(in crate::sinumerik) fn inputs(self, limit: StopLimit, axis: AxisNumber) -> [Input; 2] {
        let (number, value) = match limit {
            StopLimit::Coarse => (36000, self.coarse),
            StopLimit::Fine => (36010, self.fine),
            StopLimit::Standstill => (36030, self.standstill),
        };
        let changed = (self.factor - 1.0).abs() > 0.0;
        let factor = if changed { Input::Element(36012, self.set, axis, self.factor) } else { Input::None };
        [Input::Datum(number, Some(axis), value), factor]
    }

    /// The data behind a window in words: MD36012 is named if it changes the window.
    pub(in crate::sinumerik) fn names(self, limit: StopLimit) -> String {
        let datum = match limit {
            StopLimit::Coarse => "MD36000",
            StopLimit::Fine => "MD36010",
            StopLimit::Standstill => "MD36030",
        };
        let changed = (self.factor - 1.0).abs() > 0.0;
        if changed { format!("{datum} × MD36012[{}]", self.set) } else { datum.to_owned() }
    }
}

/// A window at rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::sinumerik) enum StopLimit {
    /// MD36000.
    Coarse,
    /// MD36010.
    Fine,
    /// MD36030.
    Standstill,
}

/// The jerk limits of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jerk {
    /// MD32430 in increments per second cubed, while MD32420 = 1: it limits JOG, referencing and positioning.
    pub limit: Option<f64>,
    /// The window of every movement in cycles: MD32410 while MD32400 = 1, else 1. All values of MD32402 act alike.
    pub window: usize,
    /// The longest window that MD32430 requires, in cycles; 1 for none.
    pub longest: usize,
    /// The largest acceleration of the axis. Braking harder than this is a fast stop and bypasses the windows.
    pub hardest: f64,
}

impl Jerk {
    /// Whether any movement is filtered.
    #[must_use]
    pub const fn is_limited(&self) -> bool {
        self.window > 1 || self.longest > 1
    }

    /// The window that keeps MD32430 at an acceleration, in cycles; 1 without a limit.
    #[must_use]
    pub fn window_for(&self, acceleration: f64, cycle: f64) -> usize {
        self.limit.map_or(1, |limit| whole_cycles((acceleration / (limit * cycle) - 1e-6).ceil()))
    }
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates, and is bounded")]
fn whole_cycles(cycles: f64) -> usize {
    (cycles as usize).clamp(1, LONGEST_WINDOW)
}

/// Position control of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Dynamics {
    /// Jerk filters of its setpoint.
    pub jerk: Jerk,
    /// MD32620, if MD32630 = 0.
    pub feed_forward: FeedForward,
    /// MD32620, if MD32630 = 1: while the program has FFWON.
    pub feed_forward_by_program: FeedForward,
    /// The parameter sets, the first one at index 0.
    pub sets: [ParameterSet; PARAMETER_SETS],
}

impl Dynamics {
    /// The feedforward control, with FFWON of a program or without.
    #[must_use]
    pub fn feed_forward(&self, by_program: bool) -> FeedForward {
        if by_program && self.feed_forward == FeedForward::Off {
            self.feed_forward_by_program
        } else {
            self.feed_forward
        }
    }

    /// Whether the setpoint of position control differs from that of the interpolator in any parameter set.
    #[must_use]
    pub fn delays_setpoints(&self, by_program: bool) -> bool {
        self.feed_forward(by_program) != FeedForward::Off || self.sets.iter().any(|set| set.matching_time > 0.0)
    }

    /// The longest dead time of any parameter set, in seconds; 0 without one.
    #[must_use]
    pub fn longest_dead_time(&self) -> f64 {
        match (self.feed_forward, self.feed_forward_by_program) {
            (FeedForward::Off | FeedForward::Pt1, FeedForward::Off | FeedForward::Pt1) => 0.0,
            _ => self.sets.iter().map(|set| set.balancing_time).fold(0.0, f64::max),
        }
    }
}

/// The jerk filters from the machine data of an axis; `unit` is its unit of length in increments.
pub(in crate::sinumerik) fn jerk(md: &Axis, unit: f64, accelerations: [f64; 2], cycle: Time) -> Jerk {
    let limited = md.jog_and_pos_jerk_enable && md.jog_and_pos_max_jerk > 0.0;
    let limit = limited.then_some(md.jog_and_pos_max_jerk * unit);
    let window = if md.ax_jerk_enable { (md.ax_jerk_time / cycle.seconds()).round() } else { 1.0 };
    let hardest = accelerations[0].max(accelerations[1]);
    let jerk = Jerk { limit, window: whole_cycles(window), longest: 1, hardest };
    Jerk { longest: jerk.window_for(hardest, cycle.seconds()), ..jerk }
}

/// From the machine data of an axis; `velocity` converts their velocities into increments per second.
pub(in crate::sinumerik) fn dynamics(
    md: &Axis,
    jerk: Jerk,
    actual: &Mechanics,
    velocity: &impl Fn(f64) -> f64,
) -> Dynamics {
    let switched_by_programs = md.ffw_activation_mode != 0;
    let mode = match md.ffw_mode {
        0 => FeedForward::Off,
        1 | 2 => FeedForward::Pt1,
        _ => FeedForward::DeadTime,
    };
    let (feed_forward, feed_forward_by_program) =
        if switched_by_programs { (FeedForward::Off, mode) } else { (mode, FeedForward::Off) };
    let mechanics = Mechanics::new(md);
    let torque = matches!(md.ffw_mode, 2 | 4);
    let own = |value: f64| Position::from_user(value).user();
    let sets = std::array::from_fn(|set| {
        let window = |value: f64| Position::from_user(value * md.stop_limit_factor[set]);
        ParameterSet {
            gain: md.posctrl_gain[set] * 1_000.0 / 60.0,
            feed_forward_weight: md.velo_ffw_weight[set],
            balancing_time: if torque { md.equiv_currctrl_time[set] } else { md.equiv_speedctrl_time[set] },
            matching_time: if md.dyn_match_enable { md.dyn_match_time[set] } else { 0.0 },
            exact_stop_coarse: window(md.stop_limit_coarse),
            exact_stop_fine: window(md.stop_limit_fine),
            standstill_tolerance: window(md.standstill_pos_tol),
            stop_limits: StopLimits {
                coarse: own(md.stop_limit_coarse),
                fine: own(md.stop_limit_fine),
                standstill: own(md.standstill_pos_tol),
                factor: md.stop_limit_factor[set],
                set: u8::try_from(set).unwrap_or(u8::MAX),
            },
            velocity_limit: velocity(md.ax_velo_limit[set]),
            misfit: mechanics.misfit(actual, set),
        }
    });
    Dynamics { jerk, feed_forward, feed_forward_by_program, sets }
}
