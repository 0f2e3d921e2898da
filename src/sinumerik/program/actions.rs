//! What a block does besides moving and output: messages, PRESETON, NEWCONF, SETAL.

use crate::motion::path::PathLimits;
use crate::nc_program::Action;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::{BlockAlarm, Run, block_name, on_path};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::Position;
use crate::variables::{AlarmNumber, Parameter, short_text};

impl State {
    /// What a block does besides moving and output.
    pub(super) fn act(&mut self, action: Action, run: &mut Run, stage: &Stage<'_>) {
        match action {
            Action::Message(text) => self.programs[stage.channel].message = text,
            Action::Preset(axes) => {
                for (name, value) in axes {
                    let axis = stage.own.axes.machine_axes.get(usize::from(name.0));
                    if let Some(unit) = axis.and_then(|axis| self.unit_of(*axis)) {
                        self.set_actual_value(&unit, Position::from_user(value), run.block_cause);
                    }
                }
                // The path begins where its axes are now.
                run.path.place(on_path(&stage.own.axes.path, |axis| self.axes[axis].setpoint.position));
            }
            Action::EndOverlays => {
                for &axis in stage.own.axes.machine_axes.iter() {
                    self.absorb_overlay(axis);
                }
                run.path.place(on_path(&stage.own.axes.path, |axis| self.axes[axis].setpoint.position));
            }
            Action::SpindlePosition { spindle, value, dimension, .. } => {
                if let Some(axis) = stage.own.spindle(spindle.unwrap_or(0)) {
                    let by = Rule::SpindlePositioned;
                    self.position_spindle(axis, (value, dimension), by, stage.parameters, run.block_cause);
                }
            }
            Action::Limit { is_upper, spindles, .. } => {
                for (spindle, limit) in spindles {
                    run.spindle_limits
                        .extend(stage.own.spindle(spindle.unwrap_or(0)).map(|axis| (is_upper, axis, limit)));
                }
            }
            // The data are active from the next cycle on.
            Action::NewConfiguration => (run.new_conf, run.pauses) = (true, true),
            Action::Synchronised(action) => self.begin_action(*action, run, stage),
            Action::Cancel(ids) => self.cancel_actions(&ids, stage),
            Action::CycleAlarm { number, text } => {
                let text = text.unwrap_or_default();
                let first = short_text(&text);
                let name = run.queue.front().map(|block| block.origin.name.clone()).unwrap_or_default();
                run.cycle_alarm = Some(BlockAlarm {
                    number: AlarmNumber(number),
                    parameters: [
                        Parameter::Text(short_text(&name)),
                        Parameter::Text(first),
                        Parameter::Text(short_text(&text[first.len()..])),
                    ],
                    block: block_name(&name),
                });
            }
            _ => {}
        }
    }
}

impl ProgramParameters {
    /// The limits of the path with the accelerations that a block programs (ACC), in per cent of MD32300.
    pub(super) fn accelerated(
        &self,
        mut limits: PathLimits,
        actions: &[Action],
        parameters: &Parameters,
    ) -> PathLimits {
        for action in actions {
            let Action::Acceleration(name, percent) = action else { continue };
            let axis = self.axes.machine_axes.get(usize::from(name.0));
            if let Some((axis, place)) = axis.and_then(|axis| Some((axis, self.axes.place(*axis)?))) {
                limits.acceleration[place] = parameters.axes[*axis].maximum_acceleration * percent / 100.0;
            }
        }
        limits
    }
}
