//! Homing: the run of one axis, and the order of the axes of a combination (HG-09, HG-10, HG-11, HG-30).
//!
//! A run with a cam goes fast to the cam, slowly off it and slowly onto it again; the zero pulse after the cam, or without one the rising
//! edge of the cam, gives the reference. The axis then goes back to this place, so that it stands on its reference position. While an axis
//! of a combination runs, it leads the others: nothing moves relative to anything.

pub(super) mod job;
pub(super) mod run;

use job::{Chain, Job};
use run::Run;

use super::combination::Combination;
use super::hli::axis_from_cnc;
use super::inputs::axis_signal;
use super::messages;
use super::parameters::{Homing, tenths};
use super::pending::of_axis;
use super::phases::HOMING;
use super::rules::Why;
use super::state::{AxesView, Axis, AxisError, State};
use crate::motion::Motion;
use crate::units::{AxisNumber, PerAxis, Position};
use crate::variables::{EventId, Input, Place, Quantity};

impl State {
    /// One cycle of a G74 block; true when it has ended.
    pub(super) fn home(&mut self, job: &mut Job) -> bool {
        if job.running.is_empty() {
            let Some((order, _)) = job.waiting.first().copied() else { return true };
            let next: Vec<AxisNumber> =
                job.waiting.iter().filter(|(other, _)| *other == order).map(|(_, axis)| *axis).collect();
            job.waiting.retain(|(other, _)| *other != order);
            let cause = job.cause;
            job.running = next.into_iter().map(|axis| self.chain(axis, cause)).collect();
        }
        let cause = job.cause;
        for chain in &mut job.running {
            self.step_chain(chain, cause);
        }
        job.running.retain(|chain| chain.ended < chain.members.len());
        job.running.is_empty() && job.waiting.is_empty()
    }

    /// The axes that a homing moves now, or next if none moves.
    pub(super) fn homing_now(&self, job: &Job) -> Vec<AxisNumber> {
        let mut axes: Vec<AxisNumber> = job.running.iter().flat_map(|chain| chain.members.clone()).collect();
        if let (true, Some((next, _))) = (axes.is_empty(), job.waiting.first()) {
            axes.extend(job.waiting.iter().filter(|(order, _)| order == next).map(|(_, axis)| *axis));
        }
        axes.into_iter().flat_map(|axis| self.coupled_with(axis)).collect()
    }

    /// The axes of a homing that is held brake as their runs do.
    pub(super) fn brake_homing(&mut self, job: &Job) {
        for member in job.running.iter().flat_map(|chain| &chain.members) {
            if self.axes[*member].run.is_some() {
                let deceleration = self.homing_deceleration(*member);
                self.axes[*member].motion = Some(Motion::Brake { deceleration });
            }
        }
    }

    /// How a homing run brakes that is no error: P-AXIS-00285, the smallest of the axes that are coupled.
    pub(super) fn homing_deceleration(&self, axis: AxisNumber) -> f64 {
        self.smallest(axis, |parameters| parameters.homing.acceleration)
    }

    /// Ends a homing without a reference.
    pub(super) fn end_homing(&mut self, job: &Job, cause: EventId) {
        for member in job.running.iter().flat_map(|chain| &chain.members) {
            if self.axes[*member].run.take().is_some() {
                let runs = axis_signal(*member, axis_from_cnc::homing, true);
                let event = self.log.note_one(Place::Axis(*member), Why::HomingAborted, runs, cause);
                self.axes[*member].causes.homing = event;
            }
        }
        for chain in &job.running {
            self.end_chain(chain);
        }
    }

    /// The axes that home with an axis: the master first, then its slaves in the order of their numbers.
    fn chain(&mut self, axis: AxisNumber, cause: EventId) -> Chain {
        let Some(index) = self.combination_of(axis).filter(|index| !self.combinations[*index].coupling.is_open())
        else {
            return Chain { members: vec![axis], ended: 0, at_once: false };
        };
        let coupling = &self.combinations[index].coupling;
        let leader = coupling.leader();
        let runs = |member: &AxisNumber| *member == leader || !self.axes[*member].parameters.takes_masters_homing;
        let members: Vec<AxisNumber> = coupling.members().filter(runs).collect();
        // HG-10, HG-23: only drives that home by themselves begin at once.
        let at_once = coupling.followers().any(|slave| self.axes[slave].parameters.homes_at_once)
            && members
                .iter()
                .all(|member| self.intelligent.contains(*member) && !self.axes[*member].parameters.homing.by_the_cnc);
        for member in &members {
            // HG-29: nothing is absolute until all have been homed.
            let state = &mut self.axes[*member];
            if !state.parameters.homing.disabled && std::mem::take(&mut state.homed) {
                let homed = axis_signal(*member, axis_from_cnc::homed, true);
                state.causes.homed = self.log.note_one(Place::Axis(*member), Why::ReferenceLost, homed, cause);
            }
            self.axes[*member].waits_for_others = *member != leader;
        }
        if at_once {
            self.combinations[index].homes_at_once = true;
            let view = AxesView(&self.axes);
            self.combinations[index].coupling.release(&view);
        }
        Chain { members, ended: 0, at_once }
    }

    fn end_chain(&mut self, chain: &Chain) {
        for member in &chain.members {
            self.axes[*member].waits_for_others = false;
        }
        let Some(index) = chain.members.first().and_then(|first| self.combination_of(*first)) else { return };
        let view = AxesView(&self.axes);
        let one = &mut self.combinations[index];
        // HG-29: from here on the limits of all count from P-AXIS-00073.
        one.coupling.clear_bases();
        if one.homes_at_once {
            one.homes_at_once = false;
            one.coupling.close(&view);
        } else if !one.coupling.is_open() {
            let leader = one.coupling.leader();
            one.coupling.lead_with(leader);
        }
    }

    fn step_chain(&mut self, chain: &mut Chain, cause: EventId) {
        if chain.at_once {
            let members = chain.members.clone();
            let mut all = true;
            for member in members {
                all &= self.step_run(member, Why::HomingAtOnce, cause);
            }
            if all {
                chain.ended = chain.members.len();
                self.end_chain(chain);
            }
            return;
        }
        let Some(axis) = chain.members.get(chain.ended).copied() else { return };
        if self.axes[axis].run.is_none()
            && let Some(index) = self.combination_of(axis)
            && !self.combinations[index].coupling.is_open()
        {
            self.combinations[index].coupling.lead_with(axis);
        }
        let why = if chain.ended == 0 { Why::HomingBegins } else { Why::HomingInTurn };
        if self.step_run(axis, why, cause) {
            chain.ended += 1;
            if chain.ended == chain.members.len() {
                self.end_chain(chain);
            }
        }
    }

    /// One cycle of the run of an axis, which begins if there is none. True when the axis is homed.
    fn step_run(&mut self, number: AxisNumber, why: Why, cause: EventId) -> bool {
        let axis = &mut self.axes[number];
        let homing = axis.parameters.homing;
        if homing.disabled {
            return true;
        }
        if why == Why::HomingAtOnce && axis.run.is_none() && axis.homed {
            return true;
        }
        let mut run = match axis.run {
            Some(run) => run,
            None => {
                let event = self.log.note_plain(Place::Axis(number), why, cause);
                axis.causes.homing = event;
                if std::mem::take(&mut axis.homed) {
                    axis.causes.homed = event;
                }
                Run::begin(axis.setpoint.position, &axis.feedback, event)
            }
        };
        let rests = axis.setpoint.is_at_rest();
        let (motion, changed) = run.step(&homing, &axis.feedback, rests, axis.shift, &mut self.log.taken.0[HOMING]);
        if let Some(changed) = changed {
            let inputs = inputs_of(number, changed, &homing, axis.shown(axis.actual()));
            run.cause = self.log.note(Place::Axis(number), changed, inputs, run.cause);
        }
        let travelled = (axis.setpoint.position - run.start).abs();
        let is_too_far = axis.parameters.is_slave && homing.farthest.is_some_and(|farthest| travelled > farthest);
        let mark = run.mark + axis.shift;
        let arrived = run.goes_back() && rests && axis.setpoint.position == mark && axis.has_settled();
        axis.motion = Some(motion);
        axis.run = Some(run);
        if is_too_far {
            let farthest = homing.farthest.map(|at| Input::Datum(284, Some(number), tenths(at)));
            let travelled = Input::Length(Quantity::Distance, number, travelled);
            let inputs = [travelled, farthest.unwrap_or(Input::None), Input::None];
            let event = self.log.note(Place::Axis(number), Why::HomingAborted, inputs, run.cause);
            self.pending.raise(of_axis(messages::HOMING_TRAVEL, number), None, event);
            self.axis_error(number, AxisError::Resettable, event);
            return false;
        }
        if !arrived {
            return false;
        }
        run.end(&mut self.log.taken.0[HOMING]);
        // The movement back was in the old reference.
        (axis.run, axis.motion) = (None, None);
        let input = Input::Length(Quantity::Position, number, axis.shown(axis.actual()));
        let event = self.log.note_one(Place::Axis(number), Why::Homed, input, run.cause);
        self.axes[number].causes.homing = event;
        self.refer(number, homing.position - mark, event);
        self.refer_slaves(number, event);
        true
    }

    /// HG-11: slaves with P-AXIS-00074 take the position of their own list when their master is homed.
    fn refer_slaves(&mut self, master: AxisNumber, cause: EventId) {
        let Some(index) = self.combination_of(master) else { return };
        let coupling = &self.combinations[index].coupling;
        if coupling.leader() != master || (coupling.is_open() && !self.combinations[index].homes_at_once) {
            return;
        }
        let slaves: Vec<AxisNumber> = coupling.followers().collect();
        let beyond = self.axes[master].actual() - self.axes[master].parameters.homing.position;
        for slave in slaves {
            let parameters = &self.axes[slave].parameters;
            if parameters.takes_masters_homing {
                let by = parameters.homing.position + beyond - self.axes[slave].actual();
                let takes = Input::Datum(74, Some(slave), 1.0);
                let event = self.log.note_one(Place::Axis(slave), Why::HomedWithMaster, takes, cause);
                self.refer(slave, by, event);
            }
        }
    }

    /// The actual value of an axis gets its reference. Nothing moves.
    fn refer(&mut self, number: AxisNumber, by: Position, cause: EventId) {
        let Self { combinations, axes, .. } = self;
        let waiting = |axes: &PerAxis<Axis>, one: &Combination| -> Vec<(AxisNumber, Option<Position>)> {
            let waiting = one.coupling.followers().filter(|slave| axes[*slave].waits_for_others);
            waiting.map(|slave| (slave, one.coupling.difference(slave, &AxesView(axes)))).collect()
        };
        let before: Vec<_> = combinations.iter().map(|one| waiting(axes, one)).collect();
        let axis = &mut axes[number];
        axis.shift += by;
        axis.setpoint.shift(by);
        axis.homed = true;
        axis.causes.homed = cause;
        for (one, before) in combinations.iter_mut().zip(before) {
            one.coupling.value_shifted(number, by, &AxesView(axes));
            // P-108: the difference is that of the references at once. Limits that act before homing go on as they were (P-AXIS-00249).
            for (slave, before) in before {
                let now = one.coupling.difference(slave, &AxesView(axes));
                if let Some(jump) = now.zip(before).map(|(now, before)| now - before).filter(|by| *by != Position::ZERO)
                {
                    one.coupling.move_base(slave, jump);
                }
            }
        }
    }
}

/// What a transition of a run has tested: the parameters that decide, and where the axis was. No signal shows its cam.
fn inputs_of(axis: AxisNumber, why: Why, homing: &Homing, actual: Position) -> [Input; 3] {
    let datum = |number, is: bool| Input::Datum(number, Some(axis), f64::from(u8::from(is)));
    let cam = datum(156, !homing.with_cam);
    let reversal = datum(157, !homing.reverses);
    let zero_pulse = datum(84, !homing.with_zero_pulse);
    let here = Input::Length(Quantity::Position, axis, actual);
    match why {
        Why::WithoutCam => [cam, zero_pulse, here],
        Why::WithoutSwitch if homing.with_cam => [reversal, zero_pulse, here],
        Why::WithoutSwitch => [cam, zero_pulse, here],
        Why::Reverses | Why::WithoutReversal => [reversal, here, Input::None],
        Why::CamEdge => [zero_pulse, here, Input::None],
        _ => [here, Input::None, Input::None],
    }
}
