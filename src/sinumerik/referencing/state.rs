//! The state of a reference point approach and of channel-specific referencing.

use serde::{Deserialize, Serialize};

use crate::control::{Transition, row};
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input};

/// Channel-specific referencing (REF-23): the active order number, and the axes already started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct ChannelReferencing {
    /// The order number of MD34110 that is being referenced; 0 if none.
    pub number: i32,
    /// The started axes, as bits.
    pub started: u32,
    /// DBX1.0 in the last cycle.
    pub was: bool,
    /// The event behind 33.0.
    pub cause: EventId,
}

impl ChannelReferencing {
    /// 33.0.
    #[must_use]
    pub(in crate::sinumerik) const fn is_active(&self) -> bool {
        self.number != 0
    }

    /// Whether it started this axis.
    #[must_use]
    pub(in crate::sinumerik) const fn started(&self, axis: AxisNumber) -> bool {
        self.is_active() && self.started >> axis.index() & 1 == 1
    }
}

impl ChannelReferencing {
    /// Whether this axis is to be started now.
    pub(in crate::sinumerik) const fn wants(&self, axis: AxisNumber, cycle_number: i32) -> bool {
        self.is_active() && self.number == cycle_number && !self.started(axis)
    }
}

/// Machine data of an encoder that the control writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct EncoderDatum {
    /// The axis.
    pub axis: AxisNumber,
    /// Encoder, 0 or 1.
    pub encoder: u8,
    /// MD34210.
    pub state: u8,
    /// MD34090, if it is written.
    pub offset: Option<Position>,
    /// The event behind it.
    pub cause: EventId,
}

/// The position of an encoder at the last power off.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Buffered {
    /// Its actual value.
    pub position: Position,
    /// It was referenced.
    pub referenced: bool,
}

/// The phase of an approach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Phase {
    /// No approach.
    #[default]
    Idle,
    /// Phase 1: towards the cam with MD34020.
    SearchCam,
    /// Braking on the cam.
    BrakeOnCam,
    /// MD34050 = 1: off the cam with MD34020.
    LeaveCam,
    /// Braking off the cam.
    BrakeOffCam,
    /// Phase 2: with MD34040 to the cam edge.
    SearchEdge,
    /// The distance of MD34092 after the edge.
    PassShift,
    /// To the zero mark with MD34040.
    SearchMark,
    /// Phase 3: with MD34070 to the reference point.
    GoToReferencePoint,
    /// Distance-coded marks, MD34330 = 1 or a grouping: the position is known, the axis brakes.
    BrakeAfterMarks,
    /// At the reference point, until exact stop fine.
    ExactStop,
}

impl Phase {
    /// A short text for the phase.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Idle => "no approach",
            Self::SearchCam => "phase 1: towards the cam",
            Self::BrakeOnCam => "braking on the cam",
            Self::LeaveCam => "leaving the cam",
            Self::BrakeOffCam => "braking off the cam",
            Self::SearchEdge => "phase 2: to the cam edge",
            Self::PassShift => "distance of MD34092",
            Self::SearchMark => "phase 2: to the zero mark",
            Self::GoToReferencePoint => "phase 3: to the reference point",
            Self::BrakeAfterMarks => "braking after the distance-coded marks",
            Self::ExactStop => "waiting for exact stop fine",
        }
    }
}

/// All transitions of an approach, except aborts, which lead from any phase to [`Phase::Idle`].
pub const TRANSITIONS: &[Transition<Phase, Rule>] = &[
    row(Phase::Idle, Rule::ApproachStarted, Phase::SearchCam),
    row(Phase::SearchCam, Rule::WithoutCam, Phase::SearchMark),
    row(Phase::SearchCam, Rule::OnCamAtStart, Phase::SearchEdge),
    row(Phase::SearchCam, Rule::CamReached, Phase::BrakeOnCam),
    row(Phase::SearchCam, Rule::LeaveCamFirst, Phase::LeaveCam),
    row(Phase::BrakeOnCam, Rule::StoppedOnCam, Phase::SearchEdge),
    row(Phase::BrakeOnCam, Rule::LeaveCamFirst, Phase::LeaveCam),
    row(Phase::LeaveCam, Rule::CamLeft, Phase::BrakeOffCam),
    row(Phase::BrakeOffCam, Rule::StoppedOffCam, Phase::SearchEdge),
    row(Phase::SearchEdge, Rule::CreepVelocityMissed, Phase::SearchCam),
    row(Phase::SearchEdge, Rule::CamEdge, Phase::PassShift),
    row(Phase::PassShift, Rule::CamShiftPassed, Phase::SearchMark),
    row(Phase::SearchMark, Rule::ZeroMark, Phase::GoToReferencePoint),
    row(Phase::SearchCam, Rule::MarksSearched, Phase::SearchMark),
    row(Phase::SearchCam, Rule::MarksSearchedOffCam, Phase::SearchMark),
    row(Phase::SearchMark, Rule::FirstMark, Phase::SearchMark),
    row(Phase::SearchMark, Rule::CamAhead, Phase::SearchMark),
    row(Phase::SearchMark, Rule::MarksTooFarApart, Phase::SearchMark),
    row(Phase::SearchMark, Rule::MarksPassed, Phase::GoToReferencePoint),
    row(Phase::SearchMark, Rule::StopAfterMarks, Phase::BrakeAfterMarks),
    row(Phase::BrakeAfterMarks, Rule::Referenced, Phase::Idle),
    row(Phase::SearchCam, Rule::AbsoluteTravels, Phase::GoToReferencePoint),
    row(Phase::SearchCam, Rule::AbsoluteStays, Phase::Idle),
    row(Phase::SearchCam, Rule::EncoderAdjusted, Phase::Idle),
    row(Phase::GoToReferencePoint, Rule::ReferencePointReached, Phase::ExactStop),
    row(Phase::ExactStop, Rule::Referenced, Phase::Idle),
];

const _: () = assert!(TRANSITIONS.len() <= u64::BITS as usize);

/// Index of the reference point approach among the charts of this control.
pub(in crate::sinumerik) const APPROACH_CHART: usize = 0;

/// The approach of one axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Approach {
    pub phase: Phase,
    /// Direction of the cam search as a sign.
    pub cam_direction: f64,
    /// Direction of the zero-mark search as a sign.
    pub marker_direction: f64,
    /// Actual value at the start of a monitored phase: start of phase 1, or the cam edge.
    pub origin: Position,
    /// The reference point, as an actual value before it is set.
    pub target: Position,
    /// The value of MD34100 that 2.4 to 2.7 selected.
    pub set_position: Position,
    /// The approach is a section of a grouping: section 3 moves to the reference point.
    pub in_grouping: bool,
    /// The first of two distance-coded marks.
    pub mark: Option<Position>,
    /// Second attempt in the other direction, with half of MD34040: the distance of two distance-coded marks was too large.
    pub second_attempt: bool,
    /// The axis passed the cam edge at the wrong speed once.
    pub creep_velocity_missed: bool,
    /// The signal of NC stop that holds it until NC start.
    pub stopped: Option<Input>,
    /// Number of cycles at the reference point without exact stop fine.
    pub waited: u64,
    /// The latest event.
    pub cause: EventId,
}
