//! Conditions of travel request and travel command, and what stops and holds every movement.

use crate::control::{Condition, Fact, fact, yes};
use crate::image::{axis_from_nck, axis_to_nck, channel_to_nck, mode_group_from_nck, mode_group_to_nck, nck_from_nck};
use crate::motion::Motion;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::limits::Ahead;
use crate::sinumerik::axis::travel::command_signal;
use crate::sinumerik::exchange::state::Holder;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::jog::keys::{key_direction, key_signal};
use crate::sinumerik::jog::state::{By, Movement};
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::positioning::{AxisPositioning, Handwheel};
use crate::sinumerik::program::state::{ProgramState, Run};
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::sinumerik::single_axis::state::OrderedBy;
use crate::sinumerik::state::{State, Unit};
use crate::sinumerik::user::state::UserReaction;
use crate::units::{AxisNumber, ChannelNumber};
use crate::variables::{Input, Place};

/// The signals.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::with(
        axis_from_nck::traverse_request_minus,
        |look, axis| look.traverse(axis, -1, false, true),
        |look, axis| look.traverse(axis, -1, false, false),
    ),
    Row::with(
        axis_from_nck::traverse_request_plus,
        |look, axis| look.traverse(axis, 1, false, true),
        |look, axis| look.traverse(axis, 1, false, false),
    ),
    Row::with(
        axis_from_nck::traverse_command_minus,
        |look, axis| look.traverse(axis, -1, true, true),
        |look, axis| look.traverse(axis, -1, true, false),
    ),
    Row::with(
        axis_from_nck::traverse_command_plus,
        |look, axis| look.traverse(axis, 1, true, true),
        |look, axis| look.traverse(axis, 1, true, false),
    ),
];

/// A factor in per cent.
fn percent(factor: f64) -> String {
    format!("{} %", (factor * 1e6).round() / 1e4)
}

/// A direction in words.
pub(super) const fn sign(direction: i8) -> &'static str {
    match direction {
        1 => "plus",
        -1 => "minus",
        _ => "none",
    }
}

impl Look<'_> {
    fn traverse(self, number: AxisNumber, direction: i8, command: bool, wanted: bool) -> Condition {
        let axis = &self.state.axes[number];
        let (word, shown) =
            if command { ("command", axis.command(self.parameters)) } else { ("request", axis.travel.request()) };
        let what = format!("traverse {word} of {}", self.axis_name(number));
        let expected = if wanted { sign(direction).to_owned() } else { format!("not {}", sign(direction)) };
        Fact::new(what, sign(shown), expected, (shown == direction) == wanted).after(|| {
            match (self.beside(number).filter(|_| command), wanted) {
                // A compensation or a DRF offset commands it; its own movement does not.
                (Some(beside), false) => beside.into(),
                (Some(_) | None, true) => {
                    let by_drf = self.pulses_of_drf(number, direction).filter(|_| command);
                    let own = self.movement(number, direction, command);
                    Condition::Any([Some(own), by_drf, self.started_by_plc(number)].into_iter().flatten().collect())
                }
                (None, false) => self.ends(number, direction, command),
            }
        })
    }

    /// What commands an axis that has no traverse command of its own (SIG-10): a DRF offset or a compensation.
    fn beside(self, number: AxisNumber) -> Option<Fact> {
        let axis = &self.state.axes[number];
        let name = self.axis_name(number);
        if axis.travel.command(self.parameters) != 0 {
            return None;
        }
        if axis.overlay.command != 0 {
            return Some(Fact::new(format!("DRF offset of {name}"), "on its way", "where the pulses want it", false));
        }
        let moved = axis.compensation.command != 0;
        moved.then(|| Fact::new(format!("compensation of {name}"), "moves the axis", "at its value", false))
    }

    /// Pulses of the handwheel of a DRF offset, if one is selected.
    fn pulses_of_drf(self, number: AxisNumber, direction: i8) -> Option<Condition> {
        let handwheels = self.state.axes[number].overlay.handwheels;
        let what =
            format!("DRF pulses of handwheel {} for {}", handwheels.trailing_zeros() + 1, self.axis_name(number));
        (handwheels != 0).then(|| Fact::new(what, "none", sign(direction), false).into())
    }

    /// What moves an axis that is positioned alone, by the PLC or a synchronised action, in a direction.
    fn positioned_alone(self, number: AxisNumber, unit: &Unit, direction: i8, command: bool) -> Option<Condition> {
        let order = self.state.single.axes[number].order?;
        let goes = self.state.axes[number].travel.request();
        let by = match order.by {
            OrderedBy::Plc => "the PLC",
            OrderedBy::Action => "a synchronised action",
        };
        let found = match order.ending {
            Some(_) => format!("by {by}, is being stopped"),
            None => format!("by {by}, direction {}", sign(goes)),
        };
        let what = format!("positioning of {}", self.axis_name(number));
        let positioning = Fact::new(what, found, format!("direction {}", sign(direction)), goes == direction).into();
        let mut all = vec![positioning];
        if command && self.parameters.command_only_in_motion {
            all.extend(self.not_held_alone(unit));
        }
        Some(Condition::All(all))
    }

    /// Nothing holds the movement of an axis that is positioned alone.
    pub(super) fn not_held_alone(self, unit: &Unit) -> Vec<Condition> {
        let number = unit.leader();
        let mut all = vec![self.axis(number, axis_from_nck::axis_stop_active, false)];
        if !self.state.single.axes[number].independence.taken {
            all.push(self.channel(unit.channel, channel_to_nck::nc_stop_axes_plus_spindles, false));
            let of_group = mode_group_to_nck::mode_group_stop_axes_plus_spindles;
            all.push(self.mode_group(unit.mode_group, of_group, false));
        }
        let is_plc_axis = self.state.owners.of(number).holder == Holder::Plc;
        if !(is_plc_axis && self.parameters.axes[number].plc_axis.ignores_feed_disable) {
            all.push(self.channel(unit.channel, channel_to_nck::feed_disable, false));
        }
        all.extend(unit.members().map(|axis| self.axis(axis, axis_to_nck::feed_stop, false)));
        all.extend(unit.members().map(|axis| self.in_control(axis)));
        let signals = &self.to_nck.axes[number];
        let factor = self.parameters.axis_override(signals.feed_override(), signals.override_active());
        all.push(self.override_of(number, factor));
        all
    }

    /// What ends the positioning of an axis before its target: delete distance-to-go, and what stops its channel, unless the PLC has taken it
    /// out of it (28.x).
    pub(super) fn ends_positioning(self, number: AxisNumber, unit: &Unit) -> Vec<Condition> {
        let delete = axis_to_nck::delete_distance_to_go_spindle_reset;
        let rises = self.rises(Place::Axis(number), delete, self.state.single.axes[number].delete_was);
        let mut any = vec![Condition::All(vec![self.axis(number, delete, true), rises])];
        if !self.state.single.axes[number].independence.taken {
            any.push(self.not_stopped(unit.channel).opposite());
        }
        any
    }

    /// The PLC starts the positioning of an axis that it has taken, or a function of a spindle.
    fn started_by_plc(self, number: AxisNumber) -> Option<Condition> {
        let is_plc_axis = self.state.owners.of(number).holder == Holder::Plc;
        let one = &self.state.single.axes[number];
        (is_plc_axis && one.order.is_none() && one.spindle.is_none()).then(|| self.start_by_plc(number))
    }

    /// What ends a request or a command: the opposite of what it needs, and what ends a movement only in its course.
    fn ends(self, number: AxisNumber, direction: i8, command: bool) -> Condition {
        let unit = self.unit(number);
        if let Some(leader) = self.led_by_another(number).filter(|_| command) {
            // SIG-09.
            return self.ends(leader, direction, command);
        }
        let mut any = vec![self.movement(number, direction, command).opposite()];
        if self.state.single.axes[number].order.is_some() {
            any.extend(self.ends_positioning(number, &unit));
            return Condition::Any(any);
        }
        let axis = &self.state.axes[number];
        let turns = self.spindle_movement(&unit, direction, command).is_some();
        let jogs = !axis.approach.is_running() && !self.synchronises(number) && !turns && self.state.is_jogging(&unit);
        if jogs {
            any.push(self.only_jog(unit.mode_group).opposite());
        }
        if jogs && axis.jogging.movement.is_by_key() {
            any.push(self.function_stays(unit.leader(), unit.mode_group).opposite());
        }
        // O-26: an enable that is missing from the beginning is waited for.
        if axis.approach.is_running() || jogs && axis.jogging.movement.is_by_key() && axis.jogging.was_on {
            any.push(Condition::All(self.enables_of_axes(&unit)).opposite());
        }
        Condition::Any(any)
    }

    /// Whether the closed grouping of an axis makes its synchronising motion.
    fn synchronises(self, number: AxisNumber) -> bool {
        self.closed_grouping(number).is_some_and(|grouping| grouping.phase == Phase::Synchronising)
    }

    /// The leading axis whose movement a synchronous axis follows, if it does not move for itself.
    fn led_by_another(self, number: AxisNumber) -> Option<AxisNumber> {
        let leader = self.closed_grouping(number)?.coupling.leader();
        let itself = self.state.axes[number].approach.is_running() || self.synchronises(number);
        (leader != number && !itself).then_some(leader)
    }

    /// What must hold so that an axis is to move in a direction (request), or moves (command). With MD17900 bit 0 = 1 a command also needs
    /// that nothing holds the movement (O-27).
    fn movement(self, number: AxisNumber, direction: i8, command: bool) -> Condition {
        let unit = self.unit(number);
        if let Some(turning) = self.spindle_movement(&unit, direction, command) {
            return turning;
        }
        if let Some(positioning) = self.positioned_alone(number, &unit, direction, command) {
            return positioning;
        }
        let axis = &self.state.axes[number];
        let mut all = Vec::new();
        if command && self.parameters.command_only_in_motion {
            all.push(self.not_held(&unit));
            all.extend(unit.members().map(|axis| self.in_control(axis)));
        }
        if axis.approach.is_running() {
            let goes = axis.approach.direction(axis, self.parameters.axes[number].reference.cam_is_active);
            let what = format!("reference point approach of {}", self.axis_name(number));
            let found = format!("{}, direction {}", axis.approach.phase().text(), sign(goes));
            all.push(Fact::new(what, found, format!("direction {}", sign(direction)), goes == direction).into());
            all.push(self.not_stopped(unit.channel));
            all.push(self.may_reference(&unit));
            all.extend(unit.members().map(|axis| self.in_control(axis)));
        } else if self.synchronises(number) {
            let goes = match axis.motion {
                Motion::GoTo { target, .. } => (target - axis.setpoint.position).increments().signum(),
                Motion::Brake { .. }
                | Motion::Run { .. }
                | Motion::Interpolated { .. }
                | Motion::Track
                | Motion::Hold => 0,
            };
            let goes = i8::try_from(goes).unwrap_or(0);
            let what = format!("synchronising motion of {}", self.axis_name(number));
            let wanted = format!("direction {}", sign(direction));
            all.push(Fact::new(what, format!("direction {}", sign(goes)), wanted, goes == direction).into());
        } else if let Some(leader) = self.led_by_another(number) {
            // SIG-09: the command of the leading axis is also displayed here, its request is not.
            let start = self.start_of_section_3(number);
            if command {
                let along = self.axis(leader, command_signal(direction), true);
                return Condition::Any(std::iter::once(along).chain(start).collect());
            }
            let what = format!("movement of {} for itself, in section 2 or 3", self.axis_name(number));
            let itself = Fact::new(what, "none", format!("direction {}", sign(direction)), false);
            return match start {
                Some(start) => itself.after(|| start),
                None => itself.into(),
            };
        } else if self.state.is_jogging(&unit) {
            all.push(self.jog(&unit, direction, command));
        } else if self.state.programs[unit.channel].run.is_some() {
            all.push(self.moved_by_program(unit.channel, number, direction));
        } else {
            let by_key = self.referencing_by_key(&unit, direction);
            all.push(Condition::Any(std::iter::once(by_key).chain(self.start_of_section_3(number)).collect()));
        }
        Condition::All(all)
    }

    /// REF is active, or a block of the program references the unit (REF-24).
    pub(super) fn may_reference(self, unit: &Unit) -> Condition {
        if self.state.is_referenced_by_program(unit) {
            return fact(format!("the program references {}", self.axis_name(unit.leader())), true).into();
        }
        self.mode_group(unit.mode_group, mode_group_from_nck::active_machine_function_ref, true)
    }

    /// What begins the synchronising motion of a closed grouping that waits for it (REF-14).
    fn start_of_section_3(self, number: AxisNumber) -> Option<Condition> {
        let waiting = self.closed_grouping(number).filter(|grouping| grouping.phase == Phase::WaitingForStart)?;
        Some(self.starts(waiting))
    }

    /// Movement in JOG by a key, in the order in which `jog/keys.rs` tests.
    fn jog(self, unit: &Unit, direction: i8, command: bool) -> Condition {
        let number = unit.leader();
        let (axis, jogging) = (&self.state.axes[number], &self.state.axes[number].jogging);
        let modes = self.parameters.key_modes;
        let name = self.axis_name(number);
        let mut all = vec![self.not_stopped(unit.channel)];
        let needs_key = match jogging.movement {
            Movement::None => {
                // O-26: only a rising edge starts a movement.
                let pressed = key_direction(&self.to_nck.axes[number]) == direction;
                let rises = self.rises(Place::Axis(number), key_signal(direction), pressed);
                let by_key = Condition::All(vec![rises, self.key(number, direction)]);
                let by_handwheel = self.turned(number, sign(direction));
                all.push(Condition::Any(std::iter::once(by_key).chain(by_handwheel).collect()));
                false
            }
            Movement::Continuous(_) => modes.continuous_held,
            Movement::Pending(_, By::Key(_)) | Movement::Path(_, By::Key(_)) => modes.increment_held,
            Movement::Pending(_, By::Handwheel) | Movement::Path(_, By::Handwheel) => false,
        };
        if needs_key {
            all.push(self.key(number, direction));
        }
        let moves = jogging.movement.direction(axis.setpoint.position);
        // A continuous movement keeps its direction.
        let keeps = matches!(jogging.movement, Movement::Continuous(_)) && moves == direction;
        if jogging.movement != Movement::None && !keeps {
            let what = format!("movement of {name} in JOG");
            all.push(Fact::new(what, sign(moves), sign(direction), moves == direction).into());
        }
        let switch = if direction > 0 {
            axis_to_nck::hardware_limit_switch_plus
        } else {
            axis_to_nck::hardware_limit_switch_minus
        };
        all.extend(unit.members().map(|axis| self.axis(axis, switch, false)));
        if command {
            all.push(self.axis(number, axis_from_nck::ramp_function_generator_disable_active, false));
            let ahead = self.state.software_limit_ahead(number, direction, self.parameters, self.to_nck);
            // The limit is tested when the axis may move.
            let is_on = unit.members().all(|axis| self.state.axes[axis].enabling.is_on());
            let reached = ahead == Ahead::Reached && is_on && !axis.is_held();
            all.push(fact(format!("{name} is before its software limit"), !reached).into());
        }
        Condition::All(all)
    }

    /// The key of a direction, alone and not disabled.
    pub(super) fn key(self, axis: AxisNumber, direction: i8) -> Condition {
        Condition::All(vec![
            self.axis(axis, key_signal(direction), true),
            self.axis(axis, key_signal(-direction), false),
            self.axis(axis, axis_to_nck::traversing_key_disable, false),
        ])
    }

    /// With REF a key requests an approach, in any other machine function or mode nothing.
    fn referencing_by_key(self, unit: &Unit, direction: i8) -> Condition {
        let group = unit.mode_group;
        if !self.state.mode_groups[group].is_referencing() {
            return Condition::All(vec![
                self.mode_group(group, mode_group_from_nck::active_mode_jog, true),
                self.mode_group(group, mode_group_from_nck::active_machine_function_repos, false),
            ]);
        }
        let number = unit.leader();
        let reference = &self.parameters.axes[number].reference;
        let name = self.axis_name(number);
        let mut all = vec![self.approach_requested(unit), self.start(unit)];
        if reference.cam_is_active {
            // An approach that begins on the cam first leaves it.
            let forward = if reference.cam_direction > 0.0 { 1 } else { -1 };
            let on_cam = self.to_nck.axes[number].deceleration_reference_point_approach();
            let first = if on_cam { -forward } else { forward };
            let what = format!("first direction of an approach of {name} (MD34010, 12.7)");
            all.push(Fact::new(what, sign(first), sign(direction), first == direction).into());
        } else {
            all.push(self.key(number, direction));
        }
        Condition::All(all)
    }

    /// No reason stops every movement of a channel.
    pub(super) fn not_stopped(self, channel: ChannelNumber) -> Condition {
        let group = self.parameters.mode_group(channel);
        let stops = self.no_alarm(format!("alarm that stops {}", self.channel_name(channel)), |place, alarm| {
            alarm.reaction.has(Reaction::STOP) && self.state.owners.concerns_channel(self.parameters, place, channel)
                || alarm.reaction.has(Reaction::NC_NOT_READY)
        });
        Condition::All(vec![
            self.nck(nck_from_nck::emergency_stop_active, false),
            self.channel(channel, channel_to_nck::channel_reset, false),
            self.mode_group(group, mode_group_to_nck::mode_group_reset, false),
            stops,
            self.no_mode_group_alarm(group),
        ])
    }

    /// Neither feed stop nor an override of 0 holds the movement of a unit.
    pub(super) fn not_held(self, unit: &Unit) -> Condition {
        let mut all = vec![self.not_disabled(unit.channel, channel_to_nck::feed_disable, UserReaction::Feed)];
        all.extend(unit.members().map(|axis| self.axis(axis, axis_to_nck::feed_stop, false)));
        if self.state.axes[unit.leader()].approach.stopped.is_some() {
            // C-76: NC stop holds an approach in JOG until NC start.
            all.push(self.channel(unit.channel, channel_to_nck::nc_stop, false));
            all.push(self.channel(unit.channel, channel_to_nck::nc_stop_axes_plus_spindles, false));
            all.push(self.channel(unit.channel, channel_to_nck::nc_start, true));
        }
        match self.not_held_by_program(unit) {
            Some(by_program) => all.extend(by_program),
            None => all.push(self.override_acts(unit.leader())),
        }
        Condition::All(all)
    }

    /// What else must hold so that a running program moves a unit. `None` if no program moves it: its axial override counts then.
    fn not_held_by_program(self, unit: &Unit) -> Option<Vec<Condition>> {
        let leader = unit.leader();
        let program = &self.state.programs[unit.channel];
        let (run, stage) = (program.run.as_deref()?, self.stage(unit.channel)?);
        let runs = matches!(program.state, ProgramState::Running | ProgramState::Waiting);
        let otherwise = self.state.axes[leader].approach.is_running() || run.referencing.contains(leader);
        if !runs || otherwise || !self.state.owners.is_program_axis(leader, unit.channel) {
            return None;
        }
        if let Some(positioning) = run.positionings.iter().find(|one| one.axis == leader) {
            let factor = self.override_of(leader, State::override_of_positioning(positioning, &stage));
            return Some(std::iter::once(factor).chain(self.pulses_of_override(positioning)).collect());
        }
        stage.own.axes.path.contains(&leader).then(|| self.path_not_held(run, &stage))
    }

    /// With FDA = 0 only pulses of its handwheel move the axis.
    fn pulses_of_override(self, positioning: &AxisPositioning) -> Option<Condition> {
        let axis = &self.state.axes[positioning.axis];
        let is_moved = positioning.handwheel == Handwheel::Way && axis.by_handwheel.is_some_and(|one| one.is_active);
        let way = (positioning.target - axis.setpoint.position).increments().signum();
        let what = format!("pulses of the handwheel of {} (FDA = 0)", self.axis_name(positioning.axis));
        let waits = is_moved && axis.setpoint.is_at_rest() && way != 0;
        waits.then(|| Fact::new(what, "none", sign(if way > 0 { 1 } else { -1 }), false).into())
    }

    /// Neither a signal nor an override of 0 % holds the path of a channel.
    pub(super) fn path_not_held(self, run: &Run, stage: &Stage<'_>) -> Vec<Condition> {
        let name = self.channel_name(stage.channel);
        let mut all = Vec::new();
        if let Some((_, Input::Bit(bit, value))) = self.state.path_is_held(run, stage) {
            all.push(Condition::Signal(bit, !value));
        }
        if let Some((signal, factor)) = self.state.path_override(run, stage) {
            let what = format!("effective override of the path of {name} ({})", signal.name);
            all.push(Fact::new(what, percent(factor), "above 0 %", factor > 0.0).into());
        }
        all
    }

    /// An override of 0 holds only while it is active.
    fn override_acts(self, axis: AxisNumber) -> Condition {
        self.override_of(axis, self.state.axes[axis].feed_factor)
    }

    /// An override that is not 0.
    pub(super) fn override_of(self, axis: AxisNumber, factor: f64) -> Condition {
        let what = format!("effective override of {}", self.axis_name(axis));
        Fact::new(what, percent(factor), "above 0 %", factor > 0.0).into()
    }

    /// Nothing forbids a movement of a unit, and each of its axes is in position control.
    pub(super) fn can_move(self, unit: &Unit) -> Condition {
        let mut all = vec![self.may_move(unit)];
        all.extend(unit.members().map(|axis| self.in_control(axis)));
        Condition::All(all)
    }

    /// Nothing forbids a movement of a unit.
    pub(super) fn may_move(self, unit: &Unit) -> Condition {
        let leader = unit.leader();
        let disabled = self.state.axes[leader].signals.disabled_at.is_some();
        Condition::All(vec![
            self.not_stopped(unit.channel),
            fact(format!("axis disable of {} has ended", self.axis_name(leader)), !disabled).after(|| {
                let rest = unit.members().map(|axis| self.setpoint_rests(axis));
                let off = self.axis(leader, axis_to_nck::axis_spindle_disable, false);
                let in_test = self.state.programs[unit.channel].test.axes.contains(leader);
                let what = format!("{} is in program test, or in a search with program test", self.axis_name(leader));
                let no_test = Fact::new(what, yes(in_test), "no", !in_test).into();
                Condition::All([off, no_test].into_iter().chain(rest).collect())
            }),
            self.axis(leader, axis_from_nck::ramp_function_generator_disable_active, false),
        ])
    }
}
