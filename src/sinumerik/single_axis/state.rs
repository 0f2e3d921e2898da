//! The state of the axes that are positioned alone.

use serde::{Deserialize, Serialize};

use crate::image::{AxisToNck, Signal, axis_to_nck};
use crate::sinumerik::rules::Rule;
use crate::units::{AxisNumber, AxisSet, PerAxis, Position};
use crate::variables::{AlarmNumber, EventId};

/// Who positions an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum OrderedBy {
    /// FC 18.
    Plc,
    /// A synchronised action.
    Action,
}

impl OrderedBy {
    /// The rule of a movement that begins.
    pub(super) const fn moves(self) -> Rule {
        match self {
            Self::Plc => Rule::OrderMoves,
            Self::Action => Rule::ActionMoves,
        }
    }

    /// The rule of a setpoint at the target.
    pub(super) const fn at_target(self) -> Rule {
        match self {
            Self::Plc => Rule::OrderTargetReached,
            Self::Action => Rule::ActionTargetReached,
        }
    }

    /// The rule of an axis in position.
    pub(super) const fn reached(self) -> Rule {
        match self {
            Self::Plc => Rule::OrderReached,
            Self::Action => Rule::ActionReached,
        }
    }

    /// The rule of an axis at rest before its target.
    pub(super) const fn ends(self) -> Rule {
        match self {
            Self::Plc => Rule::OrderEnds,
            Self::Action => Rule::ActionEnds,
        }
    }
}

/// A movement to a target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Order {
    /// In machine coordinates.
    pub target: Position,
    /// In increments per second, at 100 %.
    pub velocity: f64,
    pub by: OrderedBy,
    /// The event of its start.
    pub cause: EventId,
    /// A handwheel changes the velocity.
    pub by_handwheel: bool,
    /// The axis was in position control since its start.
    pub begun: bool,
    /// It brakes, and then the order ends like this.
    pub ending: Option<Outcome>,
}

/// A function of FC 18 for a spindle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum SpindleOrder {
    /// To an angle.
    Position,
    /// With a speed.
    Rotate,
    /// To and fro.
    Oscillate,
}

impl SpindleOrder {
    /// All functions.
    pub(in crate::sinumerik) const ALL: [Self; 3] = [Self::Position, Self::Rotate, Self::Oscillate];

    /// The signal that starts it.
    pub(in crate::sinumerik) const fn start(self) -> Signal {
        match self {
            Self::Position => axis_to_nck::start_spindle_positioning,
            Self::Rotate => axis_to_nck::start_spindle_rotation,
            Self::Oscillate => axis_to_nck::start_spindle_oscillation,
        }
    }

    /// Whether the PLC starts it.
    fn is_started(self, signals: &AxisToNck) -> bool {
        match self {
            Self::Position => signals.start_spindle_positioning(),
            Self::Rotate => signals.start_spindle_rotation(),
            Self::Oscillate => signals.start_spindle_oscillation(),
        }
    }

    /// The functions that the PLC starts.
    pub(super) fn started(signals: &AxisToNck) -> impl Iterator<Item = Self> + '_ {
        Self::ALL.into_iter().filter(|order| order.is_started(signals))
    }
}

/// How an order ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) enum Outcome {
    /// Nothing is shown: there was none, Start is 0 again, or the rest was dropped.
    #[default]
    None,
    /// In position, with exact stop fine.
    Reached,
    /// It was stopped: its error number.
    Failed(u8),
    /// It could not be started: its error number.
    Refused(u8),
}

impl Outcome {
    /// The error number that the interface shows.
    pub(in crate::sinumerik) const fn error(self) -> u8 {
        match self {
            Self::None | Self::Reached => 0,
            Self::Failed(number) | Self::Refused(number) => number,
        }
    }
}

/// The PLC controls the axis: 28.x and 63.x.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct Independence {
    /// 63.1.
    pub taken: bool,
    /// 28.7 waits for the end of a block that uses the axis.
    pub waits: bool,
    /// 63.2.
    pub stopped: bool,
    /// 63.0.
    pub reset: bool,
    /// 28.1 and 28.2 in the last cycle.
    pub reset_was: bool,
    pub resume_was: bool,
    /// The event behind the latest change.
    pub cause: EventId,
}

/// One axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct SingleAxis {
    pub order: Option<Order>,
    /// The function of a spindle that runs.
    pub spindle: Option<SpindleOrder>,
    pub outcome: Outcome,
    /// The event behind order and outcome.
    pub cause: EventId,
    /// Why a start is refused, as long as this is shown: 20070 or 20071 with the direction, or 20072.
    pub limit: Option<(AlarmNumber, i8)>,
    /// DBD78 in mm/min or rev/min.
    pub feed: f32,
    /// The event behind 76.5 and DBD78.
    pub positioning_cause: EventId,
    /// Start, the start of a spindle function, the stops of a spindle, and 2.2 in the last cycle.
    pub start_was: bool,
    pub spindle_was: Option<SpindleOrder>,
    pub spindle_stop_was: bool,
    pub delete_was: bool,
    pub independence: Independence,
    /// The event with which a handwheel override ended.
    pub handwheel_cause: EventId,
}

/// All axes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(in crate::sinumerik) struct SingleAxes {
    pub axes: PerAxis<SingleAxis>,
    /// Those with an order.
    pub moving: AxisSet,
    /// Those with an order, a refusal that is shown, or under the control of the PLC, also one that it waits for: the stage looks at them in
    /// every cycle.
    pub watched: AxisSet,
    /// Those with a handwheel override in this cycle.
    pub overridden: AxisSet,
    /// Those that a program or an order positions: 76.5.
    pub positioning: AxisSet,
}

impl SingleAxes {
    /// An order begins or ends.
    pub(in crate::sinumerik) fn set_order(&mut self, axis: AxisNumber, order: Option<Order>) {
        self.moving.set(axis, order.is_some());
        self.axes[axis].order = order;
    }

    /// Updates whether the stage looks at an axis in every cycle.
    pub(in crate::sinumerik) fn note_watched(&mut self, axis: AxisNumber) {
        let one = &self.axes[axis];
        let by_plc = one.independence.taken || one.independence.waits;
        self.watched.set(axis, one.order.is_some() || one.spindle.is_some() || one.limit.is_some() || by_plc);
    }

    /// `$AA_SNGLAX_STAT`.
    pub(in crate::sinumerik) fn status(&self, axis: AxisNumber, is_single: bool) -> i32 {
        let one = &self.axes[axis];
        if one.spindle.is_some() {
            return 4;
        }
        match (one.order, one.outcome) {
            (Some(_), _) if one.independence.stopped => 3,
            (Some(_), _) => 4,
            (None, Outcome::Failed(_) | Outcome::Refused(_)) => 5,
            (None, Outcome::Reached) => 2,
            (None, Outcome::None) => i32::from(is_single || one.independence.taken),
        }
    }
}
