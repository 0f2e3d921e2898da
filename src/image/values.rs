//! How a control names and shows the values of its axes that are not signals. Traces, causes, expressions and lists read it.

/// How a control names and shows those values of its axes that differ from control to control.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueTerms {
    /// The name of the difference of a coupled axis, behind the name of the axis.
    pub difference: &'static str,
    /// What this difference is, with its unit.
    pub difference_meaning: &'static str,
    /// What the velocity is, with its unit.
    pub velocity_meaning: &'static str,
    /// The unit of the velocity of a rotary axis.
    pub rotary_velocity: &'static str,
    /// How many degrees per minute this unit is.
    pub rotary_velocity_degrees: f64,
}

impl ValueTerms {
    /// The terms of the SINUMERIK.
    pub const SINUMERIK: Self = Self {
        difference: "synchronism_difference",
        difference_meaning: "Actual value minus ideal position of a synchronous axis, in mm or degrees.",
        velocity_meaning: "Actual velocity, in mm/min or rev/min.",
        rotary_velocity: "rev/min",
        rotary_velocity_degrees: 360.0,
    };
}
