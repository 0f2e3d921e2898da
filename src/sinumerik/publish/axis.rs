//! The signals of an axis: DB31 to DB61, with 101.x of gantry axes.

use crate::image::axis_from_nck;
use crate::motion::Brake;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::axis::travel::command_signal;
use crate::sinumerik::gantry::state::{Grouping, Monitored, Phase};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::parameters::dynamics::StopLimit;
use crate::sinumerik::publish::rows::{Rows, Why};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{EventId, Input, Place, Quantity};

impl State {
    /// DB31 to DB61 of one axis: the signals that a movement alone can change.
    #[inline]
    pub(super) fn show_movement(
        &self,
        number: AxisNumber,
        parameters: &AxisParameters,
        all: &Parameters,
        rows: &mut impl Rows,
    ) {
        let axis = &self.axes[number];
        let (causes, set) = (&axis.causes, axis.active_set(parameters));
        let position = axis.is_position_controlled();
        let at_rest = position && !axis.is_in_motion();
        let within = |window: Position| at_rest && axis.deviation().abs() <= window;
        let exact_stop = |limit: StopLimit| {
            if !position {
                let control = axis_signal(number, axis_from_nck::position_controller_active, false);
                return Why::Tested(
                    Rule::ExactStopWithoutControl,
                    [control, Input::None, Input::None],
                    causes.enabling,
                );
            }
            if axis.is_in_motion() {
                return self.why_in_motion(number, Rule::ExactStopInMotion, all);
            }
            let measured = Input::Length(Quantity::Deviation, number, axis.deviation());
            let [datum, factor] = set.stop_limits.inputs(limit, number);
            Why::Tested(Rule::ExactStop, [measured, datum, factor], causes.movement())
        };
        let (coarse, fine) = (set.exact_stop_coarse, set.exact_stop_fine);
        rows.bit(axis_from_nck::position_reached_exact_stop_coarse, within(coarse), || exact_stop(StopLimit::Coarse));
        rows.bit(axis_from_nck::position_reached_exact_stop_fine, within(fine), || exact_stop(StopLimit::Fine));
        rows.bit(axis_from_nck::axis_stationary, axis.is_stationary(parameters), || {
            if axis.outputs_setpoints() {
                return self.why_in_motion(number, Rule::SetpointsOutput, all);
            }
            let limit = Input::Datum(36060, Some(number), parameters.entered_velocity(parameters.standstill_velocity));
            Why::Tested(Rule::Standstill, [axis.measured_velocity(number), limit, Input::None], causes.movement())
        });
    }

    /// DB31 to DB61 of one axis, except the signals that a movement alone can change, and 101.x.
    #[inline]
    pub(super) fn show_axis(&self, number: AxisNumber, all: &Parameters, rows: &mut impl Rows) {
        let axis = &self.axes[number];
        let causes = &axis.causes;
        let mode = || self.mode_groups[all.mode_group(self.owners.of(number).channel)].cause();
        let [first, second] = &axis.monitor.encoders;
        rows.bit(axis_from_nck::encoder_limit_frequency_exceeded_1, first.frequency_exceeded, || {
            Why::Event(first.frequency_cause)
        });
        rows.bit(axis_from_nck::encoder_limit_frequency_exceeded_2, second.frequency_exceeded, || {
            Why::Event(second.frequency_cause)
        });
        rows.bit(axis_from_nck::referenced_synchronized_1, axis.referenced[0], || Why::Event(causes.reference[0]));
        rows.bit(axis_from_nck::referenced_synchronized_2, axis.referenced[1], || Why::Event(causes.reference[1]));
        rows.bit(axis_from_nck::position_restored_1, axis.restored[0], || Why::Event(causes.restored[0]));
        rows.bit(axis_from_nck::position_restored_2, axis.restored[1], || Why::Event(causes.restored[1]));
        let [current, speed, _] = axis.enabling.controllers();
        let position = axis.is_position_controlled();
        let place = Place::Axis(number);
        let alarm = self.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, Some(place));
        let why_alarm = || self.why_alarm(|at, alarm| at == place && alarm.reaction.has(Reaction::INTERFACE_SIGNALS));
        rows.bit(axis_from_nck::axis_specific_alarm, alarm.is_some(), why_alarm);
        let drive = || Why::Event(axis.monitor.drive_cause);
        let measuring_system = || Why::Event(causes.measuring_system);
        let ready = axis.drive_ready && axis.measuring_system.is_some() && alarm.is_none();
        rows.bit(axis_from_nck::axis_ready, ready, || match axis.measuring_system {
            _ if alarm.is_some() => why_alarm(),
            None => measuring_system(),
            Some(_) if !axis.drive_ready => drive(),
            // Of the three conditions, the drive and the alarms were not fulfilled before if they have changed in this cycle.
            Some(_) => match (self.of_this_cycle([axis.monitor.drive_cause]), why_alarm()) {
                (Some(drive), _) => drive,
                (None, Why::Event(EventId::NONE)) => measuring_system(),
                (None, cleared) => cleared,
            },
        });
        // A parked axis has no actual value to follow.
        let follows_up = axis.enabling.follow_up && axis.measuring_system.is_some();
        let enabling = || Why::Event(causes.enabling);
        rows.bit(axis_from_nck::follow_up_active, follows_up, || match axis.measuring_system {
            None => measuring_system(),
            Some(_) => self.of_this_cycle([causes.follow_up, causes.measuring_system]).unwrap_or_else(enabling),
        });
        let spindle = self.spindles[number].as_deref();
        let spindle_mode = spindle.map_or(EventId::NONE, |spindle| spindle.cause.max(spindle.mode_cause));
        rows.bit(axis_from_nck::position_controller_active, position, || {
            self.of_this_cycle([causes.enabling, spindle_mode]).unwrap_or_else(enabling)
        });
        rows.bit(axis_from_nck::speed_controller_active, speed, enabling);
        rows.bit(axis_from_nck::current_controller_active, current, enabling);
        rows.bit(axis_from_nck::drive_test_travel_request, axis.test_travel.requested, || {
            Why::Event(axis.test_travel.cause)
        });
        let jogging = &axis.jogging;
        let handwheels = jogging.handwheels | axis.overlay.handwheels;
        let handwheel = || Why::Event(jogging.handwheel_cause.max(axis.overlay.selected).max(mode()));
        rows.group(axis_from_nck::handwheel_1_active, axis_from_nck::handwheel_3_active, handwheels, handwheel);
        let motion = || Why::Event(causes.motion);
        let (request, command) = (axis.travel.request(), axis.command(all));
        rows.bit(axis_from_nck::traverse_request_minus, request < 0, motion);
        rows.bit(axis_from_nck::traverse_request_plus, request > 0, motion);
        // The later of both is closer to a change.
        let commanded = || Why::Event(causes.motion.max(axis.compensation.cause).max(axis.overlay.cause));
        rows.bit(axis_from_nck::traverse_command_minus, command < 0, commanded);
        rows.bit(axis_from_nck::traverse_command_plus, command > 0, commanded);
        rows.group(
            axis_from_nck::active_machine_function_increment_1,
            axis_from_nck::active_machine_function_continuous,
            jogging.shown,
            || Why::Event(jogging.function_cause.max(mode())),
        );
        let inverted = jogging.inverted || axis.overlay.inverted;
        rows.bit(axis_from_nck::invert_handwheel_direction_of_rotation_active, inverted, handwheel);
        let (status, exchange) = (self.exchange_status(number), || Why::Event(self.owners.of(number).cause));
        rows.number(axis_from_nck::axis_replacement_channel, status.channel, exchange);
        rows.bit(axis_from_nck::axis_replacement_requested, status.requested, exchange);
        rows.bit(axis_from_nck::axis_replacement_possible, status.possible, || {
            Why::Event(self.owners.of(number).possible_cause)
        });
        rows.bit(axis_from_nck::neutral_axis, status.neutral, exchange);
        rows.bit(axis_from_nck::plc_axis, status.plc, exchange);
        self.show_single_axis(number, rows);
        rows.number(axis_from_nck::active_controller_parameter_set, axis.parameter_set, || {
            Why::Event(causes.parameter_set)
        });
        rows.bit(axis_from_nck::ramp_function_generator_disable_active, axis.signals.fast_stop, || {
            Why::Event(axis.signals.fast_stop_cause)
        });
        rows.bit(axis_from_nck::holding_brake_open, axis.brake == Brake::Open, || {
            let rule = if axis.brake == Brake::Open { Rule::BrakeIsOpen } else { Rule::BrakeLeavesOpen };
            Why::Tested(rule, [Input::None; 3], causes.brake)
        });
        rows.number(axis_from_nck::active_drive_data_set, axis.drive_data_set, || Why::Event(causes.drive_data_set));
        rows.bit(axis_from_nck::drive_ready, axis.drive_ready, drive);
        rows.bit(axis_from_nck::pulses_enabled, axis.enabling.pulses_enabled(), || Why::Event(causes.drive));
        let active = axis.measuring_system;
        rows.bit(axis_from_nck::position_measuring_system_1_activated, active == Some(0), measuring_system);
        rows.bit(axis_from_nck::position_measuring_system_2_activated, active == Some(1), measuring_system);
    }

    /// The cause of a value that an axis has because it moves or is to move.
    fn why_in_motion(&self, number: AxisNumber, rule: Rule, all: &Parameters) -> Why {
        let motion = self.axes[number].causes.motion;
        if self.log.is_of_this_cycle(motion) {
            return Why::Event(motion);
        }
        let test_travel = &self.axes[number].test_travel;
        if test_travel.moves {
            let requested = axis_signal(number, axis_from_nck::drive_test_travel_request, true);
            return Why::Tested(rule, [requested, Input::None, Input::None], test_travel.cause);
        }
        let mover = self.mover(number);
        let axis = &self.axes[mover];
        let (shown, parent) = match (axis.travel.shown(mover, all), axis.overlay.command) {
            (Input::None, command) if command != 0 => {
                (axis_signal(mover, command_signal(command), true), axis.overlay.cause)
            }
            (shown, _) => (shown, axis.causes.motion),
        };
        Why::Tested(rule, [shown, Input::None, Input::None], parent)
    }

    /// The axis that causes the movement of an axis: the one that leads its grouping now, or the axis itself.
    pub(in crate::sinumerik) fn mover(&self, number: AxisNumber) -> AxisNumber {
        let is_of = |grouping: &&Grouping| {
            grouping.coupling.is_closed() && grouping.coupling.members().any(|axis| axis == number)
        };
        self.groupings.iter().find(is_of).map_or(number, |grouping| grouping.coupling.leads_now())
    }

    /// 101.x of the leading axis of a grouping.
    pub(super) fn show_leading_axis(&self, grouping: &Grouping, rows: &mut impl Rows) {
        // O-07: 101.4 stays during a motion that was started from outside; an automatic start never set it.
        let started = grouping.phase == Phase::Synchronising && grouping.waited_for;
        let ready = grouping.phase == Phase::WaitingForStart || started;
        let (phase, defined) = (|| Why::Event(grouping.cause), || Why::Event(self.definition_cause));
        rows.bit(axis_from_nck::gantry_synchronization_ready_to_start, ready, phase);
        let synchronised = grouping.phase == Phase::Synchronised;
        rows.bit(axis_from_nck::gantry_grouping_is_synchronized, synchronised, phase);
        rows.bit(axis_from_nck::gantry_leading_axis, true, defined);
        rows.bit(axis_from_nck::gantry_axis, true, defined);
    }

    /// 101.x of a synchronous axis.
    pub(super) fn show_synchronous_axis(&self, monitored: &Monitored, rows: &mut impl Rows) {
        rows.bit(axis_from_nck::gantry_trip_limit_exceeded, monitored.trip, || Why::Event(monitored.causes.trip));
        rows.bit(axis_from_nck::gantry_warning_limit_exceeded, monitored.warning, || {
            Why::Event(monitored.causes.warning)
        });
        rows.bit(axis_from_nck::gantry_axis, true, || Why::Event(self.definition_cause));
    }

    /// 101.x of an axis, for any position in a grouping.
    pub(super) fn show_gantry_axis(&self, number: AxisNumber, rows: &mut impl Rows) {
        for grouping in &self.groupings {
            if grouping.coupling.leader() == number {
                self.show_leading_axis(grouping, rows);
            }
            for monitored in grouping.monitored().filter(|monitored| monitored.axis == number) {
                self.show_synchronous_axis(&monitored, rows);
            }
        }
    }
}
