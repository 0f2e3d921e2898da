//! Conditions of handwheels (64.0 to 64.2, 67.0) and of the machine function of JOG (65.x, DB11 8.x), in the order in which
//! `jog/handwheels.rs` and `jog/increments.rs` test.

use crate::control::{Condition, Fact, fact};
use crate::image::{Signal, axis_from_nck, axis_to_nck, channel_to_nck, mode_group_from_nck, nck_hmi, nck_to_nck};
use crate::sinumerik::jog::state::Function;
use crate::sinumerik::publish::conditions::look::{Look, Row};
use crate::units::{AxisNumber, ChannelNumber, ModeGroupNumber};

/// The signals of an axis.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::with(
        axis_from_nck::handwheel_1_active,
        |look, axis| look.handwheel(axis, 0, true),
        |look, axis| look.handwheel(axis, 0, false),
    ),
    Row::with(
        axis_from_nck::handwheel_2_active,
        |look, axis| look.handwheel(axis, 1, true),
        |look, axis| look.handwheel(axis, 1, false),
    ),
    Row::with(
        axis_from_nck::handwheel_3_active,
        |look, axis| look.handwheel(axis, 2, true),
        |look, axis| look.handwheel(axis, 2, false),
    ),
    Row::with(
        axis_from_nck::invert_handwheel_direction_of_rotation_active,
        |look, axis| look.inverted(axis, true),
        |look, axis| look.inverted(axis, false),
    ),
    Row::new(axis_from_nck::active_machine_function_increment_1, |look, axis| look.function_of_axis(axis, 0)),
    Row::new(axis_from_nck::active_machine_function_increment_10, |look, axis| look.function_of_axis(axis, 1)),
    Row::new(axis_from_nck::active_machine_function_increment_100, |look, axis| look.function_of_axis(axis, 2)),
    Row::new(axis_from_nck::active_machine_function_increment_1000, |look, axis| look.function_of_axis(axis, 3)),
    Row::new(axis_from_nck::active_machine_function_increment_10000, |look, axis| look.function_of_axis(axis, 4)),
    Row::new(axis_from_nck::active_machine_function_increment_variable, |look, axis| look.function_of_axis(axis, 5)),
    Row::new(axis_from_nck::active_machine_function_continuous, |look, axis| look.function_of_axis(axis, 6)),
];

/// The signals of a mode group.
pub(super) const MODE_GROUP: &[Row<ModeGroupNumber>] = &[
    Row::new(mode_group_from_nck::active_machine_function_increment_1, |look, group| look.function_of_group(group, 0)),
    Row::new(mode_group_from_nck::active_machine_function_increment_10, |look, group| look.function_of_group(group, 1)),
    Row::new(mode_group_from_nck::active_machine_function_increment_100, |look, group| {
        look.function_of_group(group, 2)
    }),
    Row::new(mode_group_from_nck::active_machine_function_increment_1000, |look, group| {
        look.function_of_group(group, 3)
    }),
    Row::new(mode_group_from_nck::active_machine_function_increment_10000, |look, group| {
        look.function_of_group(group, 4)
    }),
    Row::new(mode_group_from_nck::active_machine_function_increment_variable, |look, group| {
        look.function_of_group(group, 5)
    }),
    Row::new(mode_group_from_nck::active_machine_function_continuous, |look, group| look.function_of_group(group, 6)),
];

/// The machine functions by their bits.
const FUNCTIONS: [Function; 7] = [
    Function::Increment(0),
    Function::Increment(1),
    Function::Increment(2),
    Function::Increment(3),
    Function::Increment(4),
    Function::Increment(5),
    Function::Continuous,
];

/// The active machine function of a mode group, by its bit.
const OF_GROUP: [Signal; 7] = [
    mode_group_from_nck::active_machine_function_increment_1,
    mode_group_from_nck::active_machine_function_increment_10,
    mode_group_from_nck::active_machine_function_increment_100,
    mode_group_from_nck::active_machine_function_increment_1000,
    mode_group_from_nck::active_machine_function_increment_10000,
    mode_group_from_nck::active_machine_function_increment_variable,
    mode_group_from_nck::active_machine_function_continuous,
];

/// The signals that assign a handwheel: of the axis, and of the HMI "selected" and "machine axis".
const ASSIGNED: [[Signal; 3]; 3] = [
    [axis_to_nck::activate_handwheel_1, nck_hmi::handwheel_1_selected, nck_hmi::handwheel_1_machine_axis],
    [axis_to_nck::activate_handwheel_2, nck_hmi::handwheel_2_selected, nck_hmi::handwheel_2_machine_axis],
    [axis_to_nck::activate_handwheel_3, nck_hmi::handwheel_3_selected, nck_hmi::handwheel_3_machine_axis],
];

impl Look<'_> {
    /// JOG without REF and REPOS.
    pub(super) fn only_jog(self, group: ModeGroupNumber) -> Condition {
        Condition::All(vec![
            self.mode_group(group, mode_group_from_nck::active_mode_jog, true),
            self.mode_group(group, mode_group_from_nck::active_machine_function_ref, false),
            self.mode_group(group, mode_group_from_nck::active_machine_function_repos, false),
        ])
    }

    /// The handwheel that moves an axis, 0 to 2: assigned to it, and none with a smaller number.
    fn handwheel(self, number: AxisNumber, handwheel: usize, wanted: bool) -> Condition {
        let axis = &self.state.axes[number];
        let active = axis.jogging.handwheels | axis.overlay.handwheels;
        let found = if active == 0 { "none".to_owned() } else { (active.trailing_zeros() + 1).to_string() };
        let not = if wanted { "" } else { "not " };
        let holds = (active >> handwheel & 1 == 1) == wanted;
        let what = format!("handwheel of {}", self.axis_name(number));
        Fact::new(what, found, format!("{not}{}", handwheel + 1), holds).after(|| {
            let unit = self.unit(number);
            let programs = [mode_group_from_nck::active_mode_automatic, mode_group_from_nck::active_mode_mdi];
            let drf = Condition::All(vec![
                Condition::Any(programs.map(|mode| self.mode_group(unit.mode_group, mode, true)).into()),
                self.channel(unit.channel, channel_to_nck::activate_drf, true),
            ]);
            let mode = Condition::Any(vec![self.only_jog(unit.mode_group), drf]);
            let mut all = vec![mode, self.assigned(number, handwheel)];
            all.extend((0..handwheel).map(|other| self.assigned(number, other).opposite()));
            if unit.leader() != number {
                // MIS-01.
                let what = format!("{} is a synchronous axis of a closed gantry grouping", self.axis_name(number));
                all.push(Fact::new(what, "yes", "no", false).into());
            }
            if !wanted {
                return Condition::All(all).opposite();
            }
            if self.state.single.axes[unit.leader()].order.is_some() {
                // It is not jogged meanwhile.
                let what = format!("positioning of {} by the PLC or a synchronised action", self.axis_name(number));
                all.push(Fact::new(what, "runs", "none", false).into());
            }
            Condition::All(all)
        })
    }

    /// Pulses of the handwheel of an axis, if it has one. With continuous a pulse has no distance.
    pub(super) fn turned(self, number: AxisNumber, direction: &str) -> Option<Condition> {
        let active = self.state.axes[number].jogging.handwheels;
        let what = format!("pulses of handwheel {} for {}", active.trailing_zeros() + 1, self.axis_name(number));
        (active != 0).then(|| {
            Condition::All(vec![
                self.axis(number, axis_from_nck::active_machine_function_continuous, false),
                Fact::new(what, "none", direction, false).into(),
            ])
        })
    }

    /// What begins a handwheel override (K-31): a movement that asks for it, and a handwheel of the axis.
    pub(super) fn override_begins(self, axis: AxisNumber, is_axial: bool) -> Condition {
        let name = self.axis_name(axis);
        let asks = self.state.axes[axis].by_handwheel.is_some_and(|one| one.is_axial == is_axial);
        let what = if is_axial {
            format!("positioning of {name} with FDA, or with function 7 or 8 of FC 18")
        } else {
            format!("block with FD, with the handwheel of {name}")
        };
        let movement = Fact::new(what, if asks { "runs" } else { "none" }, "runs", asks).into();
        let by_hmi = self.state.handwheels.iter().any(|handwheel| handwheel.selected == Some(axis));
        let selected = Fact::new(
            format!("handwheel that the HMI selects for {name}"),
            if by_hmi { "one" } else { "none" },
            "one",
            by_hmi,
        );
        let by_plc = ASSIGNED.iter().map(|[by_plc, ..]| self.axis(axis, *by_plc, true));
        Condition::All(vec![movement, Condition::Any(by_plc.chain([selected.into()]).collect())])
    }

    /// The same for the path of a channel: its first geometry axis has the handwheel.
    pub(super) fn override_of_path_begins(self, channel: ChannelNumber) -> Condition {
        let own = self.parameters.programs[channel].as_deref();
        let axis = own.and_then(|own| own.axes.geometry[0].map(|place| own.axes.path[place]));
        match axis {
            Some(axis) => self.override_begins(axis, false),
            None => fact(format!("{} has a first geometry axis", self.channel_name(channel)), false).into(),
        }
    }

    /// By the PLC, or by the HMI for a machine axis.
    fn assigned(self, axis: AxisNumber, handwheel: usize) -> Condition {
        let [by_plc, selected, machine_axis] = ASSIGNED[handwheel];
        let hmi = self.hmi;
        let numbers = [hmi.handwheel_1_axis_number(), hmi.handwheel_2_axis_number(), hmi.handwheel_3_axis_number()];
        let chosen = AxisNumber::new(numbers[handwheel]);
        let what = format!("machine axis of handwheel {} at the HMI", handwheel + 1);
        let found = chosen.map_or_else(|| "none".to_owned(), |chosen| self.axis_name(chosen));
        let chosen = Fact::new(what, found, self.axis_name(axis), chosen == Some(axis));
        Condition::Any(vec![
            self.axis(axis, by_plc, true),
            Condition::All(vec![self.nck(selected, true), self.nck(machine_axis, true), chosen.into()]),
        ])
    }

    fn inverted(self, axis: AxisNumber, wanted: bool) -> Condition {
        let state = &self.state.axes[axis];
        let inverted = state.jogging.inverted || state.overlay.inverted;
        let word = |inverted| if inverted { "inverted" } else { "not inverted" };
        let what = format!("direction of the handwheel of {}", self.axis_name(axis));
        Fact::new(what, word(inverted), word(wanted), inverted == wanted).after(|| {
            let active = [
                axis_from_nck::handwheel_1_active,
                axis_from_nck::handwheel_2_active,
                axis_from_nck::handwheel_3_active,
            ];
            let all = Condition::All(vec![
                Condition::Any(active.map(|active| self.axis(axis, active, true)).into()),
                self.axis(axis, axis_to_nck::invert_handwheel_direction_of_rotation, true),
            ]);
            if wanted { all } else { all.opposite() }
        })
    }

    /// Of several requests the smallest increment applies, without one continuous.
    fn requested(bit: usize, request: impl Fn(Signal, bool) -> Condition, of: fn(Function) -> Signal) -> Condition {
        let smaller = FUNCTIONS[..bit.min(6)].iter().map(|&other| request(of(other), false));
        let own = (bit < 6).then(|| request(of(FUNCTIONS[bit]), true));
        Condition::All(own.into_iter().chain(smaller).collect())
    }

    /// The active machine function of JOG of an axis stays requested: another one ends the movement of a key (C-04).
    pub(super) fn function_stays(self, number: AxisNumber, group: ModeGroupNumber) -> Condition {
        let bit = usize::from(self.state.axes[number].jogging.function.bit());
        if self.state.group_functions[group].function.is_some() {
            Self::requested(bit, |signal, value| self.mode_group(group, signal, value), Function::of_mode_group)
        } else {
            Self::requested(bit, |signal, value| self.axis(number, signal, value), Function::of_axis)
        }
    }

    fn function_of_axis(self, number: AxisNumber, bit: usize) -> Condition {
        let group = self.parameters.mode_group(self.state.owners.of(number).channel);
        let central = |wanted| self.nck(nck_to_nck::increment_inputs_active_in_mode_group_area, wanted);
        let own = Self::requested(bit, |signal, value| self.axis(number, signal, value), Function::of_axis);
        let of_group = self.mode_group(group, OF_GROUP[bit], true);
        Condition::All(vec![
            self.only_jog(group),
            Condition::Any(vec![
                Condition::All(vec![central(false), own]),
                Condition::All(vec![central(true), of_group]),
            ]),
        ])
    }

    fn function_of_group(self, group: ModeGroupNumber, bit: usize) -> Condition {
        Condition::All(vec![
            self.nck(nck_to_nck::increment_inputs_active_in_mode_group_area, true),
            self.only_jog(group),
            Self::requested(bit, |signal, value| self.mode_group(group, signal, value), Function::of_mode_group),
        ])
    }
}
