//! The run of one axis: a table of transitions, and what the axis does in each phase.

use serde::{Deserialize, Serialize};

use crate::control::{Rows, Transition, next, row};
use crate::isg::parameters::Homing;
use crate::isg::rules::Why;
use crate::motion::{Feedback, Motion};
use crate::units::Position;
use crate::variables::EventId;

/// Where a run is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::isg) enum Phase {
    /// Begins.
    #[default]
    Begins,
    /// Fast to the cam.
    ToCam,
    /// Brakes on the cam.
    Brakes,
    /// Slowly off the cam.
    OffCam,
    /// Slowly onto the cam.
    OntoCam,
    /// Slowly to the zero pulse.
    ToZeroPulse,
    /// Back to the reference.
    Back,
    /// The axis stands on its reference position.
    Homed,
}

/// The transitions of a run.
pub(in crate::isg) const STEPS: &[Transition<Phase, Why>] = &[
    row(Phase::Begins, Why::AwayFromCam, Phase::ToCam),
    row(Phase::Begins, Why::OnCam, Phase::Brakes),
    row(Phase::Begins, Why::WithoutCam, Phase::ToZeroPulse),
    row(Phase::Begins, Why::WithoutSwitch, Phase::Back),
    row(Phase::ToCam, Why::OnCam, Phase::Brakes),
    row(Phase::Brakes, Why::Reverses, Phase::OffCam),
    row(Phase::Brakes, Why::WithoutReversal, Phase::ToZeroPulse),
    row(Phase::Brakes, Why::WithoutSwitch, Phase::Back),
    row(Phase::OffCam, Why::OffCam, Phase::OntoCam),
    row(Phase::OntoCam, Why::OnCam, Phase::ToZeroPulse),
    row(Phase::OntoCam, Why::CamEdge, Phase::Back),
    row(Phase::ToZeroPulse, Why::ZeroPulse, Phase::Back),
    row(Phase::Back, Why::Homed, Phase::Homed),
];

/// A phase in words.
pub(in crate::isg) const fn text(phase: Phase) -> &'static str {
    match phase {
        Phase::Begins => "the run begins",
        Phase::ToCam => "fast to the cam (P-AXIS-00219)",
        Phase::Brakes => "brakes on the cam",
        Phase::OffCam => "slowly off the cam (P-AXIS-00218)",
        Phase::OntoCam => "slowly onto the cam",
        Phase::ToZeroPulse => "slowly to the zero pulse",
        Phase::Back => "back to the reference",
        Phase::Homed => "homed",
    }
}

/// The run of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::isg) struct Run {
    phase: Phase,
    /// The setpoint at the start.
    pub(super) start: Position,
    /// The encoder value at the reference.
    pub(super) mark: Position,
    pub(super) cause: EventId,
}

impl Run {
    pub(super) fn begin(start: Position, feedback: &Feedback, cause: EventId) -> Self {
        Self { phase: Phase::Begins, start, mark: feedback.encoders[0].value, cause }
    }

    /// The event with which its phase began.
    pub(in crate::isg) fn cause(&self) -> EventId {
        self.cause
    }

    /// Its phase in words.
    pub(in crate::isg) fn phase_text(&self) -> &'static str {
        text(self.phase)
    }

    /// Whether the axis goes back to its reference.
    pub(super) fn goes_back(&self) -> bool {
        self.phase == Phase::Back
    }

    /// Why the phase changes in this cycle, if it does. The encoder value at the reference is taken at its edge.
    fn why(&mut self, homing: &Homing, feedback: &Feedback, rests: bool) -> Option<Why> {
        let encoder = feedback.encoders[0];
        match self.phase {
            Phase::Begins => Some(match (homing.with_cam, homing.with_zero_pulse) {
                (true, _) if feedback.cam => Why::OnCam,
                (true, _) => Why::AwayFromCam,
                (false, true) => Why::WithoutCam,
                (false, false) => Why::WithoutSwitch,
            }),
            Phase::ToCam => feedback.cam.then_some(Why::OnCam),
            Phase::Brakes if !rests => None,
            Phase::Brakes if homing.reverses => Some(Why::Reverses),
            Phase::Brakes => Some(if homing.with_zero_pulse { Why::WithoutReversal } else { Why::WithoutSwitch }),
            Phase::OffCam => (!feedback.cam).then_some(Why::OffCam),
            Phase::OntoCam if feedback.cam => {
                self.mark = encoder.value;
                Some(if homing.with_zero_pulse { Why::OnCam } else { Why::CamEdge })
            }
            Phase::ToZeroPulse => {
                self.mark = encoder.zero_mark?;
                Some(Why::ZeroPulse)
            }
            Phase::OntoCam | Phase::Back | Phase::Homed => None,
        }
    }

    /// One cycle: what the axis does, and why the phase changed.
    pub(super) fn step(
        &mut self,
        homing: &Homing,
        feedback: &Feedback,
        rests: bool,
        shift: Position,
        taken: &mut Rows,
    ) -> (Motion, Option<Why>) {
        let why = self.why(homing, feedback, rests);
        if let Some(why) = why {
            self.phase = next(STEPS, taken, self.phase, why);
        }
        let run = |velocity: f64| Motion::Run { velocity, acceleration: homing.acceleration };
        let motion = match self.phase {
            Phase::ToCam => run(homing.direction * homing.fast),
            Phase::Begins | Phase::Brakes | Phase::Homed => Motion::Brake { deceleration: homing.acceleration },
            Phase::OffCam => run(-homing.direction * homing.slow),
            Phase::OntoCam | Phase::ToZeroPulse => run(homing.direction * homing.slow),
            Phase::Back => {
                Motion::GoTo { target: self.mark + shift, velocity: homing.slow, acceleration: homing.acceleration }
            }
        };
        (motion, why)
    }

    /// The axis stands on its reference position.
    pub(super) fn end(&mut self, taken: &mut Rows) {
        self.phase = next(STEPS, taken, self.phase, Why::Homed);
    }
}
