//! Publication: the NCK's half of the interface and the variables, written once per cycle, at its end.
//!
//! Signals are set axis by axis (SIG-09). What somebody else wrote into a bit of the NCK is overwritten here (SIG-11).

use crate::image::{AxisFromNck, FromNck, Hmi};
use crate::motion::Motion;
use crate::sinumerik::alarms::Reaction;
use crate::sinumerik::gantry::state::Phase;
use crate::sinumerik::jog::state::{Function, Movement};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::operation::state::{MachineFunction, Mode};
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, ModeGroupNumber, Position};
use crate::variables::{AxisValues, Place, Variables};

impl Nck {
    /// Writes what the control shows. Of `restless` axes the iron has not come to rest.
    pub fn publish(&mut self, from_nck: &mut FromNck, hmi: &mut Hmi, variables: &mut Variables, restless: AxisSet) {
        let mut shown = self.awake();
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        if std::mem::take(&mut state.overwritten) {
            from_nck.clear_signals();
            shown = parameters.existing;
        }
        state.publish_nck(from_nck);
        for group in parameters.existing_mode_groups() {
            state.publish_mode_group(group, from_nck, hmi, parameters);
        }
        for (channel, _) in parameters.existing_channels() {
            state.publish_channel(channel, from_nck, parameters);
        }
        for number in shown.iter() {
            let axis = &parameters.axes[number];
            if !axis.silent {
                state.publish_axis(&mut from_nck.axes[number], number, axis);
            }
            variables.axes[number] = state.values(number, axis);
        }
        for index in 0..state.groupings.len() {
            let members: AxisSet = state.groupings[index].coupling.members().collect();
            if shown.and(members).is_empty() {
                continue;
            }
            state.publish_grouping(index, from_nck, parameters, variables);
        }
        if state.alarms.take_changed() {
            variables.alarms.publish(state.alarms.iter().map(|(alarm, _)| *alarm));
        }
        self.rest(restless);
    }
}

impl State {
    fn publish_nck(&self, from_nck: &mut FromNck) {
        let signals = &mut from_nck.nck;
        signals.set_nc_cpu_ready(self.run_up.is_cpu_ready());
        signals.set_drives_in_cyclic_operation(self.run_up.are_drives_cyclic());
        signals.set_drives_ready(self.run_up.are_drives_ready());
        signals.set_handwheel_1_moved(self.handwheels[0].counter);
        signals.set_handwheel_2_moved(self.handwheels[1].counter);
        signals.set_handwheel_3_moved(self.handwheels[2].counter);
        signals.set_emergency_stop_active(self.emergency_stop.is_active());
        signals.set_nc_ready(self.is_nc_ready());
        signals.set_nc_alarm_active(self.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, None).is_some());
    }

    fn publish_mode_group(
        &self,
        number: ModeGroupNumber,
        from_nck: &mut FromNck,
        hmi: &mut Hmi,
        parameters: &Parameters,
    ) {
        let group = &self.mode_groups[number];
        let signals = &mut from_nck.mode_groups[number];
        signals.set_active_mode_automatic(group.mode == Mode::Automatic);
        signals.set_active_mode_mdi(group.mode == Mode::Mda);
        signals.set_active_mode_jog(group.mode == Mode::Jog);
        signals.set_active_machine_function_teach_in(group.function == MachineFunction::TeachIn);
        signals.set_active_machine_function_repos(group.function == MachineFunction::Repos);
        signals.set_active_machine_function_ref(group.is_referencing());
        signals.set_active_machine_functions(self.group_functions[number].function.map_or(0, Function::bits));
        let not_ready = self.mode_group_not_ready(number, parameters);
        signals.set_mode_group_ready(self.run_up.is_nc_ready() && not_ready.is_none());
        let mut channels = parameters.existing_channels().filter(|(_, group)| *group == number);
        signals
            .set_all_channels_in_reset_state(channels.all(|(channel, _)| !self.is_channel_active(channel, parameters)));
        if !group.strobe_is_the_hmi_s {
            hmi.mode_groups[number].set_ref_selected(group.is_referencing());
        }
    }

    /// "At least one axis is being traversed in JOG", or referenced.
    pub(super) fn is_channel_active(&self, channel: ChannelNumber, parameters: &Parameters) -> bool {
        !self.summary.in_motion.and(parameters.channels[channel].axes).is_empty()
    }

    fn publish_channel(&self, channel: ChannelNumber, from_nck: &mut FromNck, parameters: &Parameters) {
        let signals = &mut from_nck.channels[channel];
        let active = self.is_channel_active(channel, parameters);
        signals.set_referencing_active(self.channels[channel].is_referencing());
        // Without a program its state is "aborted", as after RESET.
        signals.set_program_state_aborted(true);
        signals.set_channel_state_active(active);
        signals.set_channel_state_reset(!active);
        signals.set_all_axes_requiring_reference_point_are_referenced(self.is_referenced(channel, parameters));
        signals.set_all_axes_stationary(self.summary.standing.has_all_of(parameters.channels[channel].axes));
        let alarm = |reaction: Reaction| self.channel_alarm(channel, reaction, parameters).is_some();
        signals.set_channel_ready(self.run_up.is_nc_ready() && !alarm(Reaction::CHANNEL_NOT_READY));
        signals.set_channel_specific_nck_alarm_active(alarm(Reaction::INTERFACE_SIGNALS));
        signals.set_nck_alarm_with_machining_stop_active(alarm(Reaction::STOP));
    }

    fn publish_axis(&self, signals: &mut AxisFromNck, number: AxisNumber, parameters: &AxisParameters) {
        let axis = &self.axes[number];
        let [current, speed, position] = axis.enabling.controllers();
        let place = Some(Place::Axis(number));
        let alarm = self.alarms.with_reaction(Reaction::INTERFACE_SIGNALS, place).is_some();
        signals.set_encoder_limit_frequency_exceeded_1(axis.monitor.encoders[0].frequency_exceeded);
        signals.set_encoder_limit_frequency_exceeded_2(axis.monitor.encoders[1].frequency_exceeded);
        signals.set_referenced_synchronized_1(axis.referenced[0]);
        signals.set_referenced_synchronized_2(axis.referenced[1]);
        let at_rest = position && axis.setpoint.is_at_rest() && axis.traverse_command == 0;
        let within = |window: Position| at_rest && axis.deviation().abs() <= window;
        let set = axis.active_set(parameters);
        signals.set_position_reached_exact_stop_coarse(within(set.exact_stop_coarse));
        signals.set_position_reached_exact_stop_fine(within(set.exact_stop_fine));
        signals.set_axis_specific_alarm(alarm);
        signals.set_axis_ready(axis.drive_ready && axis.measuring_system.is_some() && !alarm);
        // A parked axis has no actual value that it could follow.
        signals.set_follow_up_active(axis.enabling.follow_up && axis.measuring_system.is_some());
        signals.set_axis_stationary(axis.velocity.abs() < parameters.standstill_velocity);
        signals.set_position_controller_active(position);
        signals.set_speed_controller_active(speed);
        signals.set_current_controller_active(current);
        signals.set_traverse_request_minus(axis.traverse_request < 0);
        signals.set_traverse_request_plus(axis.traverse_request > 0);
        signals.set_traverse_command_minus(axis.traverse_command < 0);
        signals.set_traverse_command_plus(axis.traverse_command > 0);
        let jogging = &axis.jogging;
        signals.set_active_machine_functions(jogging.shown);
        signals.set_active_handwheels(jogging.handwheels);
        signals.set_invert_handwheel_direction_of_rotation_active(jogging.inverted);
        signals.set_ramp_function_generator_disable_active(axis.signals.fast_stop);
        signals.set_active_controller_parameter_set(axis.parameter_set);
        signals.set_active_drive_data_set(axis.drive_data_set);
        signals.set_drive_ready(axis.drive_ready);
        signals.set_pulses_enabled(axis.enabling.pulses_enabled());
        signals.set_position_measuring_system_1_activated(axis.measuring_system == Some(0));
        signals.set_position_measuring_system_2_activated(axis.measuring_system == Some(1));
    }

    fn publish_grouping(
        &self,
        index: usize,
        from_nck: &mut FromNck,
        parameters: &Parameters,
        variables: &mut Variables,
    ) {
        let grouping = &self.groupings[index];
        let leader = grouping.coupling.leader();
        if !parameters.axes[leader].silent {
            let signals = &mut from_nck.axes[leader];
            signals.set_gantry_axis(true);
            signals.set_gantry_leading_axis(true);
            signals.set_gantry_grouping_is_synchronized(grouping.phase == Phase::Synchronised);
            // O-07: 101.4 stays through a motion that was waited for; one that began by itself never set it.
            let started = grouping.phase == Phase::Synchronising && grouping.waited_for;
            let ready = grouping.phase == Phase::WaitingForStart || started;
            signals.set_gantry_synchronization_ready_to_start(ready);
        }
        for monitored in grouping.monitored() {
            let axis = monitored.axis;
            variables.axes[axis].synchronism_difference = monitored.difference;
            if !parameters.axes[axis].silent {
                let signals = &mut from_nck.axes[axis];
                signals.set_gantry_axis(true);
                signals.set_gantry_warning_limit_exceeded(monitored.warning);
                signals.set_gantry_trip_limit_exceeded(monitored.trip);
            }
        }
    }

    fn values(&self, number: AxisNumber, parameters: &AxisParameters) -> AxisValues {
        let axis = &self.axes[number];
        let per_user_unit = if parameters.rotary { 360.0 } else { 1.0 };
        let encoders = std::array::from_fn(|encoder| {
            if encoder < usize::from(parameters.encoders) {
                self.feedback[number].encoders[encoder].value + axis.offset[encoder]
            } else {
                Position::ZERO
            }
        });
        let setpoint = axis.setpoint.position;
        let distance_to_go = match (axis.jogging.movement, axis.motion) {
            (Movement::None, Motion::GoTo { target, .. }) => target - setpoint,
            (movement, _) => movement.distance_to_go(setpoint),
        };
        AxisValues {
            // With axis disable the display goes on with the setpoint (SIG-03).
            position: if axis.signals.disabled_at().is_some() { axis.setpoint.position } else { axis.actual },
            setpoint: axis.setpoint.position,
            velocity: axis.velocity * 60.0 / Position::PER_USER_UNIT / per_user_unit,
            following_error: axis.deviation(),
            slide: axis.slide,
            synchronism_difference: Position::ZERO,
            encoders,
            distance_to_go,
        }
    }
}
