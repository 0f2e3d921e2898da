//! Publication: the NCK's half of the interface and the variables, written once at the end of each cycle. Also the event behind
//! each bit, determined when the bit has changed.
//!
//! Each block is a table of rows ([`rows`]): a row gives a signal, its value and its cause. States have their own events. A value
//! that follows directly from the present state (exact stop, standstill) gets an event when its edge is detected.
//!
//! Signals are set axis by axis (SIG-09). A value that another writer wrote into a bit of the NCK is overwritten here (SIG-11).

mod alarms;
mod auxiliary;
mod axis;
mod channel;
mod conditions;
mod control;
pub(super) mod known;
mod own_828d;
mod program;
mod rows;
mod single_axis;
mod spindle;

use zerocopy::IntoBytes;

use crate::image::{
    Axis828d, AxisFromNck, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck, ChannelSearchFromNck, FromNck, Hmi,
    ModeGroupFromNck, ModeGroupHmi, NckFromNck, UserFromNck,
};
use crate::motion::Motion;
use crate::sinumerik::jog::state::Movement;
use crate::sinumerik::nck::Nck;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::axis::AxisParameters;
use crate::sinumerik::publish::rows::{Asked, Why, Written};
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, AxisSet, ChannelNumber, Position};
use crate::variables::{AxisValues, EventId, Place, Variables};

impl Nck {
    /// Writes the published blocks. The mechanics of the axes `restless` are not at rest.
    pub fn publish(&mut self, from_nck: &mut FromNck, hmi: &mut Hmi, variables: &mut Variables, restless: AxisSet) {
        let (mut shown, mut decided) = (self.awake(), self.decided());
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        if std::mem::take(&mut state.overwritten) {
            from_nck.clear_signals();
            (shown, decided) = (parameters.existing, AxisSet::ALL);
        }
        state.show_nck(parameters, &mut Written::new(from_nck.nck.as_mut_bytes(), NckFromNck::FIRST));
        for group in parameters.existing_mode_groups() {
            let bytes = from_nck.mode_groups[group].as_mut_bytes();
            state.show_mode_group(group, parameters, &mut Written::new(bytes, ModeGroupFromNck::FIRST));
            if !state.mode_groups[group].hmi_owns_strobe {
                let bytes = hmi.mode_groups[group].as_mut_bytes();
                state.show_selection(group, &mut Written::new(bytes, ModeGroupHmi::FIRST));
            }
        }
        for (channel, _) in parameters.existing_channels() {
            let bytes = from_nck.channels[channel].as_mut_bytes();
            state.show_channel(channel, parameters, &mut Written::new(bytes, ChannelFromNck::FIRST));
            let bytes = from_nck.auxiliary[channel].as_mut_bytes();
            state.show_auxiliary(channel, parameters, &mut Written::new(bytes, ChannelAuxiliary::FIRST));
            let bytes = from_nck.searches[channel].as_mut_bytes();
            state.show_search(channel, &mut Written::new(bytes, ChannelSearchFromNck::FIRST));
            state.programs[channel].show_values(&mut variables.channels[channel]);
        }
        variables.r_parameters.take_over(&state.r_parameters);
        for number in shown.iter() {
            let axis = &parameters.axes[number];
            if !axis.silent {
                let bytes = from_nck.axes[number].as_mut_bytes();
                let mut rows = Written::new(bytes, AxisFromNck::FIRST);
                if decided.contains(number) {
                    state.show_axis(number, parameters, &mut rows);
                    state.show_spindle(number, parameters, &mut rows);
                }
                state.show_movement(number, axis, parameters, &mut rows);
            }
            variables.axes[number] = state.values(number, axis, parameters);
        }
        for index in 0..state.groupings.len() {
            let members: AxisSet = state.groupings[index].coupling.members().collect();
            if shown.and(members).is_empty() {
                continue;
            }
            state.publish_grouping(index, from_nck, parameters, variables);
        }
        state.publish_828d(parameters, from_nck, variables);
        if state.alarms.take_changed() {
            variables.alarms.publish(state.alarms.iter().map(|(alarm, _)| *alarm));
        }
        self.rest(restless);
    }

    /// The event behind the value of a bit that was published in this cycle.
    pub fn cause(&mut self, place: Place, byte: u16, bit: u8) -> EventId {
        let mut asked = Asked::new(byte, bit);
        let (parameters, state) = (&*self.parameters, &mut *self.state);
        match place {
            Place::Nck => {
                state.show_nck(parameters, &mut asked);
                state.show_user(parameters, &mut asked);
            }
            Place::ModeGroup(group) => {
                state.show_mode_group(group, parameters, &mut asked);
                state.show_selection(group, &mut asked);
            }
            Place::Channel(channel) => {
                state.show_channel(channel, parameters, &mut asked);
                state.show_auxiliary(channel, parameters, &mut asked);
                state.show_search(channel, &mut asked);
                state.show_auxiliary_828d(channel, parameters, &mut asked);
            }
            // What a silent axis had shown went with power off.
            Place::Axis(axis) if parameters.axes[axis].silent => {}
            Place::Axis(axis) => {
                state.show_axis(axis, parameters, &mut asked);
                state.show_movement(axis, &parameters.axes[axis], parameters, &mut asked);
                state.show_spindle(axis, parameters, &mut asked);
                state.show_gantry_axis(axis, &mut asked);
                if parameters.user.is_some() {
                    let values = state.values(axis, &parameters.axes[axis], parameters);
                    state.show_axis_828d(axis, &values, parameters, &mut asked);
                }
            }
        }
        let cause = match asked.found() {
            None => EventId::NONE,
            Some(Why::Event(event)) => event,
            Some(Why::Tested(rule, inputs, parent)) => state.log.note(place, rule, inputs, parent),
        };
        // A value that has not changed yet has its state from power on.
        if cause.is_some() { cause } else { state.as_after_power_on }
    }
}

impl State {
    /// What only the 828D has. It has one channel and eight axes.
    fn publish_828d(&self, parameters: &Parameters, from_nck: &mut FromNck, variables: &Variables) {
        if parameters.user.is_none() {
            return;
        }
        self.show_user(parameters, &mut Written::new(from_nck.user.as_mut_bytes(), UserFromNck::FIRST));
        let channel = ChannelNumber::FIRST;
        let bytes = from_nck.auxiliary_828d[channel].as_mut_bytes();
        self.show_auxiliary_828d(channel, parameters, &mut Written::new(bytes, ChannelAuxiliary828d::FIRST));
        for axis in AxisNumber::up_to(8).filter(|axis| parameters.existing.contains(*axis)) {
            if !parameters.axes[axis].silent {
                let mut rows = Written::new(from_nck.axes_828d[axis].as_mut_bytes(), Axis828d::FIRST);
                self.show_axis_828d(axis, &variables.axes[axis], parameters, &mut rows);
            }
        }
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
            let bytes = from_nck.axes[leader].as_mut_bytes();
            self.show_leading_axis(grouping, &mut Written::new(bytes, AxisFromNck::FIRST));
        }
        for monitored in grouping.monitored() {
            let axis = monitored.axis;
            variables.axes[axis].synchronism_difference = monitored.difference;
            if !parameters.axes[axis].silent {
                let bytes = from_nck.axes[axis].as_mut_bytes();
                self.show_synchronous_axis(&monitored, &mut Written::new(bytes, AxisFromNck::FIRST));
            }
        }
    }

    fn values(&self, number: AxisNumber, parameters: &AxisParameters, all: &Parameters) -> AxisValues {
        let axis = &self.axes[number];
        let drf = axis.overlay.position();
        let encoders = std::array::from_fn(|encoder| {
            if encoder < usize::from(parameters.encoders) {
                self.feedback[number].encoders[encoder].value + axis.to_actual(encoder) + drf
            } else {
                Position::ZERO
            }
        });
        let setpoint = axis.setpoint.position;
        let by_program = self.distance_to_go_of_program(number, all);
        let distance_to_go = by_program.unwrap_or_else(|| match (axis.jogging.movement, axis.motion) {
            (Movement::None, Motion::GoTo { target, .. }) => target - setpoint,
            (movement, _) => movement.distance_to_go(setpoint),
        });
        AxisValues {
            // During axis disable the displayed value follows the setpoint (SIG-03).
            position: drf + if axis.signals.disabled_at().is_some() { axis.setpoint.position } else { axis.actual },
            setpoint: axis.machine_setpoint(),
            velocity: parameters.per_minute(axis.velocity),
            following_error: axis.deviation(),
            slide: axis.slide,
            synchronism_difference: Position::ZERO,
            encoders,
            distance_to_go,
            encoder_compensation: axis
                .measuring_system
                .map_or(Position::ZERO, |active| axis.compensation.encoder[usize::from(active)]),
            setpoint_compensation: axis.compensation.setpoint,
        }
    }
}
