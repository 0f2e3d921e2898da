//! Conditions of the signals of an axis: enables, homing, position, errors, coupling.

use super::look::{Look, Row, length, of_axis};
use crate::control::{Condition, Fact, fact, yes};
use crate::isg::channel::{Channel, Wait};
use crate::isg::hli::{axis_from_cnc, axis_to_cnc};
use crate::isg::parameters::Clearing;
use crate::isg::state::{AxesView, AxisError, IN_POSITION};
use crate::motion::coupling::{Coupling, Stage};
use crate::units::{AxisNumber, Position};

/// The signals of an axis.
pub(super) const ROWS: &[Row<AxisNumber>] = &[
    Row::new(axis_from_cnc::drive_enable_request, |_, _| fixed("the CNC asks for the enable of each drive", true)),
    Row::new(axis_from_cnc::drive_enable_state, |_, axis| {
        let [enable, command] = [axis_to_cnc::drive_enable_enable, axis_to_cnc::drive_enable_command];
        Condition::Any(vec![of_axis(axis, enable, false), of_axis(axis, command, true)])
    }),
    Row::new(axis_from_cnc::feed_enable_request, |_, _| fixed("the CNC asks for the feed enable of each axis", true)),
    Row::new(axis_from_cnc::feed_enable_state, |_, axis| {
        let [enable, command] = [axis_to_cnc::feed_enable_enable, axis_to_cnc::feed_enable_command];
        Condition::Any(vec![of_axis(axis, enable, false), of_axis(axis, command, true)])
    }),
    Row::new(axis_from_cnc::gantry_on_request, |_, _| fixed("the CNC asks for the clearing by itself", false)),
    Row::new(axis_from_cnc::gantry_on_state, |_, axis| {
        let [enable, command] = [axis_to_cnc::gantry_on_enable, axis_to_cnc::gantry_on_command];
        Condition::All(vec![of_axis(axis, enable, true), of_axis(axis, command, true)])
    }),
    Row::new(axis_from_cnc::drive_ready, |look, axis| look.drive_ready(axis)),
    Row::with(axis_from_cnc::homed, |look, axis| look.homed(axis), |look, axis| look.homed_no_more(axis)),
    Row::with(axis_from_cnc::homing, |look, axis| look.homing(axis), |look, axis| look.homing_no_more(axis)),
    Row::new(axis_from_cnc::in_position, |look, axis| look.in_position(axis)),
    Row::with(
        axis_from_cnc::error,
        |look, axis| look.error(axis, AxisError::Resettable),
        |look, axis| look.no_error(axis, AxisError::Resettable),
    ),
    Row::with(
        axis_from_cnc::error_not_resettable,
        |look, axis| look.error(axis, AxisError::Locked),
        |look, axis| look.no_error(axis, AxisError::Locked),
    ),
    Row::new(axis_from_cnc::gantry_master, |look, axis| {
        let is = look.state.axes[axis].parameters.is_master;
        fact(format!("{} is a gantry master by its list (P-AXIS-00015)", look.axis(axis)), is).into()
    }),
    Row::new(axis_from_cnc::gantry_slave, |look, axis| {
        let is = look.state.axes[axis].parameters.is_slave;
        fact(format!("{} is a gantry slave by its list (P-AXIS-00015)", look.axis(axis)), is).into()
    }),
    Row::with(axis_from_cnc::gantry_coupled, |look, axis| look.coupled(axis), |look, axis| look.coupled_no_more(axis)),
];

impl Look<'_> {
    fn drive_ready(self, axis: AxisNumber) -> Condition {
        let (name, feedback) = (self.axis(axis), &self.state.axes[axis].feedback);
        let fault = if feedback.drive_fault { "pending" } else { "none" };
        Condition::All(vec![
            fact(format!("the drive of {name} has started up"), feedback.drive_ready).into(),
            Fact::new(format!("fault of the drive of {name}"), fault, "none", !feedback.drive_fault).into(),
        ])
    }

    /// The position loop is closed.
    fn has_power(self, number: AxisNumber) -> Condition {
        let axis = &self.state.axes[number];
        let ready = of_axis(number, axis_from_cnc::drive_ready, true);
        let power = if axis.feedback.drive_fault {
            let what = format!("the faulty drive of {} keeps power until it stands (P-AXIS-00254)", self.axis(number));
            Condition::Any(vec![ready, fact(what, axis.fault_stop).into()])
        } else {
            ready
        };
        Condition::All(vec![of_axis(number, axis_from_cnc::drive_enable_state, true), power])
    }

    fn in_position(self, number: AxisNumber) -> Condition {
        let deviation = self.state.axes[number].following_error().abs();
        let what = format!("deviation of {} from its setpoint", self.axis(number));
        let wanted = format!("at most {}", length(IN_POSITION));
        Condition::All(vec![
            self.has_power(number),
            self.rests(number),
            Fact::new(what, length(deviation), wanted, deviation <= IN_POSITION).into(),
        ])
    }

    fn homed(self, axis: AxisNumber) -> Condition {
        fact(format!("{} is homed", self.axis(axis)), self.state.axes[axis].homed).after(|| self.homing_ends(axis))
    }

    fn homed_no_more(self, axis: AxisNumber) -> Condition {
        let is_homed = self.state.axes[axis].homed;
        let lost = Fact::new(format!("{} is homed", self.axis(axis)), yes(is_homed), "no", !is_homed);
        lost.after(|| self.commanded(axis))
    }

    fn homing(self, axis: AxisNumber) -> Condition {
        let runs = self.state.axes[axis].run.is_some();
        fact(format!("the homing run of {} goes on", self.axis(axis)), runs).after(|| self.homing_begins(axis))
    }

    fn homing_no_more(self, axis: AxisNumber) -> Condition {
        let runs = self.state.axes[axis].run.is_some();
        let over = Fact::new(format!("the homing run of {} goes on", self.axis(axis)), yes(runs), "no", !runs);
        over.after(|| self.homing_ends(axis))
    }

    /// A program homes the axis, or the master that it follows.
    fn commanded(self, axis: AxisNumber) -> Condition {
        let named = match self.state.combination_of(axis).map(|index| &self.state.combinations[index].coupling) {
            Some(coupling) if !coupling.is_open() => coupling.leader(),
            _ => axis,
        };
        Fact::new(format!("G74 with {}", self.axis(named)), "not executed", "executed", false).into()
    }

    fn homing_begins(self, axis: AxisNumber) -> Condition {
        let parameters = &self.state.axes[axis].parameters;
        if parameters.homing.disabled {
            let what = format!("homing type of {} (P-AXIS-00299)", self.axis(axis));
            return Fact::new(what, "DISABLED", "another one", false).into();
        }
        if parameters.takes_masters_homing
            && let Some(master) = parameters.master
        {
            let what = format!("{} takes the homing of {} (P-AXIS-00074)", self.axis(axis), self.axis(master));
            return Fact::new(what, "yes", "no", false).into();
        }
        let jobs = self.state.channels.iter().filter_map(|channel| match &channel.wait {
            Wait::Homing(job) => Some(job),
            Wait::Nothing | Wait::Dwell(_) => None,
        });
        let before = jobs.filter(|job| job.waits_for(axis)).flat_map(|job| job.now()).next();
        match before {
            Some(before) => Condition::All(vec![
                of_axis(before, axis_from_cnc::homing, false),
                Fact::new(format!("turn of {} in the order of G74", self.axis(axis)), "no", "yes", false).into(),
            ]),
            None => self.commanded(axis),
        }
    }

    /// What a homing run needs until it has found its reference.
    fn homing_ends(self, axis: AxisNumber) -> Condition {
        let state = &self.state.axes[axis];
        let Some(run) = &state.run else {
            if state.parameters.takes_masters_homing
                && let Some(master) = state.parameters.master
            {
                let what = format!("homing run of {}, the master of {}", self.axis(master), self.axis(axis));
                return Fact::new(what, "not ended", "ended", false).into();
            }
            return self.homing_begins(axis);
        };
        let mut all = Vec::new();
        for member in self.state.coupled_with(axis) {
            all.push(self.has_power(member));
            all.push(of_axis(member, axis_from_cnc::feed_enable_state, true));
        }
        let what = format!("homing run of {}", self.axis(axis));
        all.push(Fact::new(what, run.phase_text(), "homed", false).into());
        Condition::All(all)
    }

    /// Each difference of a slave with the limit that stops it.
    fn differences(self, slave: AxisNumber, wanted: bool) -> Vec<Condition> {
        let hard = self.state.combinations.iter().map(|one| &one.coupling);
        let soft = self.state.channels.iter().flat_map(Channel::couplings);
        let of_slave = hard.chain(soft).filter(|coupling| coupling.is_closed());
        let found = of_slave.flat_map(Coupling::differences).filter(|(axis, ..)| *axis == slave);
        let row = |(_, difference, stage): (_, Position, Stage)| {
            let is_beyond = stage.first || stage.second;
            let words = if wanted { "above a limit" } else { "within its limits" };
            let what = format!("gantry difference of {}", self.axis(slave));
            Fact::new(what, length(difference), words, is_beyond == wanted).into()
        };
        found.map(row).collect()
    }

    fn drive_fault(self, axis: AxisNumber, wanted: bool) -> Condition {
        let is_faulty = self.state.axes[axis].feedback.drive_fault;
        let words = |is: bool| if is { "one" } else { "none" };
        let what = format!("fault of the drive of {}", self.axis(axis));
        Fact::new(what, words(is_faulty), words(wanted), is_faulty == wanted).into()
    }

    fn error(self, number: AxisNumber, wanted: AxisError) -> Condition {
        let found = self.state.axes[number].error;
        let fact = Fact::new(
            format!("error of {}", self.axis(number)),
            word(found),
            if wanted == AxisError::Locked { "one that no reset clears" } else { "one" },
            found >= Some(wanted),
        );
        fact.after(|| {
            let members = self.state.coupled_with(number);
            let mut any: Vec<Condition> = members.iter().flat_map(|axis| self.differences(*axis, true)).collect();
            if wanted == AxisError::Locked {
                let what = format!("limit of {} that no reset clears (P-AXIS-00071)", self.axis(number));
                return Fact::new(what, "not exceeded", "exceeded", false).into();
            }
            any.extend(members.iter().map(|axis| self.drive_fault(*axis, true)));
            let what = format!("movement of {} without its releases", self.axis(number));
            any.push(Fact::new(what, "none", "one", false).into());
            Condition::Any(any)
        })
    }

    fn no_error(self, number: AxisNumber, least: AxisError) -> Condition {
        let found = self.state.axes[number].error;
        let fact = Fact::new(format!("error of {}", self.axis(number)), word(found), "none", found < Some(least));
        fact.after(|| match found {
            Some(AxisError::Locked) => restart(),
            Some(AxisError::Resettable) | None => {
                let mut all = self.cleared_by_reset(number);
                all.extend(self.channel_of(number).map(|channel| self.reset(channel)));
                Condition::All(all)
            }
        })
    }

    /// What keeps a reset from clearing the error of an axis (O-15).
    pub(super) fn cleared_by_reset(self, number: AxisNumber) -> Vec<Condition> {
        if self.state.axes[number].error == Some(AxisError::Locked) {
            return vec![restart()];
        }
        let members = self.state.coupled_with(number);
        let by_drive = members.iter().map(|axis| self.drive_fault(*axis, false));
        let within = members.iter().flat_map(|axis| {
            let differences = self.differences(*axis, false).into_iter();
            differences.map(|difference| Condition::Any(vec![difference, self.reset_clears(*axis)]))
        });
        by_drive.chain(within).collect()
    }

    /// A reset moves a slave to its offset: the setpoints are apart, and its mode allows it (P-AXIS-00704).
    fn reset_clears(self, slave: AxisNumber) -> Condition {
        let axis = &self.state.axes[slave];
        let hard = self.state.combinations.iter().map(|one| &one.coupling);
        let mut couplings = hard.chain(self.state.channels.iter().flat_map(Channel::couplings));
        let apart = couplings.find_map(|coupling| coupling.setpoint_misalignment(slave, &AxesView(&self.state.axes)));
        let clears = axis.parameters.clearing == Clearing::ResetOrUnit
            && axis.parameters.correction_velocity > 0.0
            && axis.is_powered()
            && apart.is_some_and(|apart| apart != Position::ZERO);
        fact(format!("a reset clears the difference of {} (P-AXIS-00704)", self.axis(slave)), clears).into()
    }

    fn coupled(self, axis: AxisNumber) -> Condition {
        fact(format!("{} is coupled", self.axis(axis)), self.state.is_coupled(axis)).after(|| {
            let what = match self.state.combination_of(axis) {
                Some(_) => format!("#GANTRY ON for the combination of {}", self.axis(axis)),
                None => format!("#ENABLE AX LINK for a group with {}", self.axis(axis)),
            };
            Fact::new(what, "not executed", "executed", false).into()
        })
    }

    fn coupled_no_more(self, axis: AxisNumber) -> Condition {
        let is_coupled = self.state.is_coupled(axis);
        let over = Fact::new(format!("{} is coupled", self.axis(axis)), yes(is_coupled), "no", !is_coupled);
        over.after(|| {
            let executed = |what: String| Fact::new(what, "not executed", "executed", false).into();
            let combination = self.state.combination_of(axis);
            match combination.filter(|index| !self.state.combinations[*index].coupling.is_open()) {
                Some(index) => Condition::All(vec![
                    fact("all slaves have P-AXIS-00704 = CONFIG", self.state.is_config(index)).into(),
                    executed(format!("#GANTRY OFF for the combination of {}", self.axis(axis))),
                ]),
                None => {
                    executed(format!("#DISABLE AX LINK, program end or reset for the group of {}", self.axis(axis)))
                }
            }
        })
    }
}

/// A signal that has one value only.
fn fixed(what: &str, value: bool) -> Condition {
    fact(what, value).into()
}

fn word(error: Option<AxisError>) -> &'static str {
    match error {
        None => "none",
        Some(AxisError::Resettable) => "one",
        Some(AxisError::Locked) => "one that no reset clears",
    }
}

/// Only a restart clears an error beyond the second limit (HG-07).
fn restart() -> Condition {
    Fact::new("restart of the controller without the difference", "no", "yes", false).into()
}
