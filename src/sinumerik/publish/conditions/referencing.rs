//! Conditions of the reference of a measuring system, and of channel-specific referencing.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{Signal, axis_from_nck, axis_to_nck, channel_from_nck, channel_to_nck, mode_group_from_nck};
use crate::sinumerik::gantry::state::Phase as GroupingPhase;
use crate::sinumerik::jog::keys::key_signal;
use crate::sinumerik::parameters::axis::Kind;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::publish::conditions::look::{Look, Row, length};
use crate::sinumerik::publish::conditions::motion::sign;
use crate::sinumerik::referencing::state::Phase;
use crate::sinumerik::state::Unit;
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::Place;

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::with(
        axis_from_nck::referenced_synchronized_1,
        |look, axis| look.referenced(axis, 0),
        |look, axis| look.reference_lost(axis, 0),
    ),
    Row::with(
        axis_from_nck::referenced_synchronized_2,
        |look, axis| look.referenced(axis, 1),
        |look, axis| look.reference_lost(axis, 1),
    ),
    Row::with(
        axis_from_nck::position_restored_1,
        |look, axis| look.restored(axis, 0),
        |look, axis| look.restored_no_more(axis, 0),
    ),
    Row::with(
        axis_from_nck::position_restored_2,
        |look, axis| look.restored(axis, 1),
        |look, axis| look.restored_no_more(axis, 1),
    ),
];

/// "Measuring system active" and "referenced" of a measuring system, 0 or 1.
const fn signals(encoder: u8) -> (Signal, Signal) {
    if encoder == 0 {
        (axis_from_nck::position_measuring_system_1_activated, axis_from_nck::referenced_synchronized_1)
    } else {
        (axis_from_nck::position_measuring_system_2_activated, axis_from_nck::referenced_synchronized_2)
    }
}

impl Look<'_> {
    /// The reference of the active measuring system of an axis.
    pub(super) fn reference_signal(self, axis: AxisNumber) -> Condition {
        match self.state.axes[axis].measuring_system {
            None => self.not_parked(axis),
            Some(active) => self.axis(axis, signals(active).1, true),
        }
    }

    fn reference_fact(self, number: AxisNumber, encoder: u8, wanted: bool) -> Fact {
        let word = |set| if set { "set" } else { "missing" };
        let set = self.state.axes[number].referenced[usize::from(encoder)];
        let what = format!("reference of measuring system {} of {}", encoder + 1, self.axis_name(number));
        Fact::new(what, word(set), word(wanted), set == wanted)
    }

    fn restored_fact(self, number: AxisNumber, encoder: u8, wanted: bool) -> Fact {
        let word = |set| if set { "restored" } else { "not restored" };
        let set = self.state.axes[number].restored[usize::from(encoder)];
        let what = format!("position of measuring system {} of {}", encoder + 1, self.axis_name(number));
        Fact::new(what, word(set), word(wanted), set == wanted)
    }

    /// 71.4 and 71.5 come at power on.
    fn restored(self, number: AxisNumber, encoder: u8) -> Condition {
        self.restored_fact(number, encoder, true).after(|| {
            let state = self.parameters.axes[number].reference.state[usize::from(encoder)];
            let what = format!("MD34210[{encoder}] of {}", self.axis_name(number));
            Condition::All(vec![
                Fact::new(what, state.to_string(), "3, with an incremental encoder", state == 3).into(),
                fact("power off and on", false).into(),
            ])
        })
    }

    fn restored_no_more(self, number: AxisNumber, encoder: u8) -> Condition {
        self.restored_fact(number, encoder, false).after(|| {
            let name = self.axis_name(number);
            Condition::Any(vec![
                self.not_parked(number).opposite(),
                fact(format!("a new approach of {name} begins"), false).into(),
                fact(format!("encoder {} of {name} fails or exceeds its limit frequency", encoder + 1), false).into(),
            ])
        })
    }

    fn referenced(self, number: AxisNumber, encoder: u8) -> Condition {
        self.reference_fact(number, encoder, true).after(|| {
            let axis = &self.state.axes[number];
            if axis.measuring_system != Some(encoder) {
                return self.axis(number, signals(encoder).0, true);
            }
            if axis.approach.is_running() {
                return self.approach_goes_on(number);
            }
            let unit = self.unit(number);
            match self.grouping(number) {
                None => Condition::All(vec![self.approach_starts(&unit), self.start(&unit)]),
                Some(grouping) if grouping.phase == GroupingPhase::Open => {
                    let datum = fact(format!("grouping of {} is closed (MD37140 = 0)", self.axis_name(number)), false);
                    datum.into()
                }
                Some(grouping) => {
                    if let Some(now) = grouping.referencing().filter(|&now| now != number) {
                        // Sections 1 and 2: one axis after another.
                        return self.reference_signal(now);
                    }
                    if number == grouping.coupling.leader() {
                        return Condition::All(vec![self.approach_starts(&unit), self.start(&unit)]);
                    }
                    let section = Fact::new(
                        format!("gantry grouping {}", grouping.number),
                        grouping.phase.text(),
                        format!("section 2 with {}, after a new start of section 1", self.axis_name(number)),
                        false,
                    );
                    section.after(|| Condition::All(vec![self.approach_starts(&unit), self.start(&unit)]))
                }
            }
        })
    }

    /// The next step of a running approach, and that nothing holds it.
    fn approach_goes_on(self, number: AxisNumber) -> Condition {
        let (axis, parameters) = (&self.state.axes[number], &self.parameters.axes[number]);
        let reference = &parameters.reference;
        let encoder = usize::from(axis.measuring_system.unwrap_or(0));
        let cam = |wanted| self.axis(number, axis_to_nck::deceleration_reference_point_approach, wanted);
        let name = self.axis_name(number);
        let next = match axis.approach.phase() {
            Phase::SearchMark if reference.kind[encoder] == Kind::DistanceCoded => {
                Fact::new(format!("distance-coded marks of {name}"), "fewer than two", "two passed", false).into()
            }
            Phase::SearchCam if reference.cam_is_active => cam(true),
            Phase::Idle | Phase::SearchCam => fact(format!("the zero mark search of {name} begins"), false).into(),
            Phase::BrakeOnCam | Phase::BrakeOffCam | Phase::BrakeAfterMarks => self.stands(number),
            Phase::LeaveCam => cam(false),
            Phase::SearchEdge => cam(reference.marker_reverse[encoder]),
            Phase::PassShift => {
                let way = (axis.actual - axis.approach.origin).abs();
                let shift = reference.cam_shift[encoder];
                let wanted = format!("at least {} (MD34092)", length(shift));
                Fact::new(format!("distance of {name} from the cam edge"), length(way), wanted, way >= shift).into()
            }
            Phase::SearchMark => {
                Fact::new(format!("zero mark of {name} since the cam edge"), "none", "passed", false).into()
            }
            Phase::GoToReferencePoint => {
                let left = (axis.approach.target - axis.setpoint.position).abs();
                let what = format!("distance of {name} from the reference point");
                Fact::new(what, length(left), "0", axis.arrived).into()
            }
            Phase::ExactStop => self.deviation(number, StopLimit::Fine),
        };
        let unit = self.unit(number);
        let phase = Fact::new(format!("approach of {name}"), axis.approach.phase().text(), "completed", false);
        let moves = if matches!(axis.approach.phase(), Phase::SearchCam | Phase::GoToReferencePoint) {
            self.not_held(&unit)
        } else {
            // The override does not act in phase 2; feed stop does.
            let stops = unit.members().map(|axis| self.axis(axis, axis_to_nck::feed_stop, false));
            Condition::All(stops.collect())
        };
        phase.after(|| Condition::All(vec![next, moves]))
    }

    /// What allows the start of an approach of a unit, except the key or the channel that starts it.
    pub(super) fn approach_starts(self, unit: &Unit) -> Condition {
        Condition::All(vec![
            self.approach_requested(unit),
            self.can_move(unit),
            self.not_disabled(unit.channel, channel_to_nck::feed_disable, UserReaction::Feed),
        ])
    }

    /// What allows the request for an approach, which may wait for enables and for feed disable (O-27).
    pub(super) fn approach_requested(self, unit: &Unit) -> Condition {
        let number = unit.leader();
        let reference = &self.parameters.axes[number].reference;
        let active = self.state.axes[number].measuring_system;
        let mode = active.map_or(0, |active| reference.mode[usize::from(active)]);
        let has_approach = active.is_some_and(|active| reference.has_approach(usize::from(active)));
        let name = self.axis_name(number);
        let mut all = vec![
            self.mode_group(unit.mode_group, mode_group_from_nck::active_machine_function_ref, true),
            self.may_move(unit),
            self.axis(number, axis_to_nck::axis_spindle_disable, false),
        ];
        if reference.is_spindle {
            let what = format!("reference point approach of {name} (MD35000)");
            all.push(Fact::new(what, "none, because it is a spindle", "that of an axis", false).into());
        }
        if active.is_some() {
            let what = format!("referencing mode of {name} (MD34200)");
            let wanted = "1 or 3, or 0 with an absolute encoder";
            all.push(Fact::new(what, mode.to_string(), wanted, has_approach).into());
            let state = active.map_or(0, |active| reference.state[usize::from(active)]);
            if active.is_some_and(|active| reference.kind[usize::from(active)] == Kind::Absolute) {
                let what = format!("adjustment of the absolute encoder of {name} (MD34210)");
                let adjusts = matches!(state, 1 | 2);
                all.push(Fact::new(what, state.to_string(), "1, and the key adjusts it", adjusts).into());
            }
        } else {
            all.push(self.not_parked(number));
        }
        if let Some(grouping) = self.grouping(number) {
            let phase = grouping.phase;
            let free = matches!(
                phase,
                GroupingPhase::NotSynchronised | GroupingPhase::WaitingForStart | GroupingPhase::Synchronised
            );
            let idle = free && grouping.coupling.is_closed();
            let what = format!("gantry grouping {}", grouping.number);
            all.push(Fact::new(what, phase.text(), "no approach or motion of the grouping runs", idle).into());
        }
        Condition::All(all)
    }

    /// What starts it: the key, pressed anew, or the channel.
    pub(super) fn start(self, unit: &Unit) -> Condition {
        let number = unit.leader();
        let reference = &self.parameters.axes[number].reference;
        let forward = if reference.cam_direction > 0.0 { 1 } else { -1 };
        let used = self.state.axes[number].key_used;
        let released =
            || fact(format!("the key of {} was released since its last start", self.axis_name(number)), !used);
        let pending = self.state.axes[number].key_pending;
        let with = |direction| {
            if pending != direction {
                return Condition::All(vec![self.key(number, direction), released().into()]);
            }
            // MD11300 = 0: the press counts until it is cancelled.
            let what =
                format!("the press of the key {} of {} waits for the enables", sign(direction), self.axis_name(number));
            Condition::All(vec![
                fact(what, true).into(),
                self.axis(number, key_signal(-direction), false),
                self.axis(number, axis_to_nck::traversing_key_disable, false),
            ])
        };
        let mut any = vec![with(forward)];
        let active = self.state.axes[number].measuring_system.map(usize::from);
        let is_absolute = active.is_some_and(|active| reference.kind[active] == Kind::Absolute);
        if !reference.cam_is_active && !is_absolute {
            any.push(with(-forward));
        }
        if reference.cycle_number > 0 {
            let referencing = &self.state.channels[unit.channel].referencing;
            let turn = referencing.wants(number, reference.cycle_number);
            let what = format!("turn of {} in channel-specific referencing (MD34110)", self.axis_name(number));
            let active = self.channel(unit.channel, channel_from_nck::referencing_active, true);
            any.push(Condition::All(vec![active, Fact::new(what, yes(turn), "yes", turn).into()]));
        }
        Condition::Any(any)
    }

    /// A reference is lost by parking, by a new approach, by the encoder, or by a parameter set with another load gear.
    fn reference_lost(self, number: AxisNumber, encoder: u8) -> Condition {
        self.reference_fact(number, encoder, false).after(|| {
            let name = self.axis_name(number);
            let event = |what: String| Condition::from(fact(what, false));
            Condition::Any(vec![
                self.not_parked(number).opposite(),
                event(format!("a new approach of {name} begins")),
                event(format!("encoder {} of {name} fails or exceeds its limit frequency", encoder + 1)),
                event(format!("{name} takes a parameter set with another load gear")),
            ])
        })
    }

    /// The axes of a channel that channel-specific referencing does not leave out.
    fn ordered(self, channel: ChannelNumber) -> impl Iterator<Item = AxisNumber> {
        let axes = self.state.owners.of_channel(channel);
        axes.iter().filter(move |&axis| self.state.has_approach(&self.unit(axis), self.parameters))
    }

    fn channel_fact(self, channel: ChannelNumber, wanted: bool) -> Fact {
        let word = |runs| if runs { "runs" } else { "does not run" };
        let runs = self.state.channels[channel].is_referencing();
        let what = format!("channel-specific referencing of {}", self.channel_name(channel));
        Fact::new(what, word(runs), word(wanted), runs == wanted)
    }

    /// 33.0 begins with the rising edge of 1.0.
    pub(super) fn channel_referencing(self, channel: ChannelNumber) -> Condition {
        self.channel_fact(channel, true).after(|| {
            let referencing = &self.state.channels[channel].referencing;
            let group = self.parameters.mode_group(channel);
            let ordered = self.ordered(channel).any(|axis| self.parameters.axes[axis].reference.cycle_number > 0);
            let name = self.channel_name(channel);
            let what = format!("an axis of {name} with MD34110 above 0, an encoder and an approach (MD34200)");
            Condition::All(vec![
                self.channel(channel, channel_to_nck::activate_referencing, true),
                self.rises(Place::Channel(channel), channel_to_nck::activate_referencing, referencing.was),
                self.mode_group(group, mode_group_from_nck::active_machine_function_ref, true),
                self.not_stopped(channel),
                fact(what, ordered).into(),
            ])
        })
    }

    /// 33.0 ends with the last axis, or when REF or the permission to move is lost.
    pub(super) fn channel_referencing_ended(self, channel: ChannelNumber) -> Condition {
        self.channel_fact(channel, false).after(|| {
            let group = self.parameters.mode_group(channel);
            let number = self.state.channels[channel].referencing.number;
            let open = self.ordered(channel).filter(|&axis| {
                self.parameters.axes[axis].reference.cycle_number >= number
                    && (!self.state.axes[axis].is_referenced() || self.state.axes[axis].approach.is_running())
            });
            let all = open.map(|axis| self.reference_signal(axis)).collect::<Vec<_>>();
            let referenced = if all.is_empty() {
                fact("every axis in the order of MD34110 was referenced", false).into()
            } else {
                Condition::All(all)
            };
            Condition::Any(vec![
                referenced,
                self.mode_group(group, mode_group_from_nck::active_machine_function_ref, false),
                self.not_stopped(channel).opposite(),
            ])
        })
    }
}
