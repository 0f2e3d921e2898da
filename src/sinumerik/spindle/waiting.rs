//! The path of a block with a feed waits at its beginning for the speed of the spindles (MD35500): for the acknowledgement of their functions,
//! and for 83.5 of each spindle of the channel to which a program has given a direction and a speed. Also G95, G4 S, and what the preparation knows of spindles.

use crate::image::axis_from_nck;
use crate::nc_program::{AuxiliaryFunction, AuxiliaryKind, g};
use crate::sinumerik::inputs::axis_signal;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::parameters::spindle::REVOLUTION_PER_MINUTE;
use crate::sinumerik::program::executable::Executable;
use crate::sinumerik::program::path::Stage;
use crate::sinumerik::program::state::Run;
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::Input;

impl State {
    /// What the path waits for, with its rule.
    pub(in crate::sinumerik) fn awaited_spindle(&self, stage: &Stage<'_>) -> Option<(Rule, Input)> {
        let parameters = stage.parameters;
        let waits = |number| parameters.axes[number].spindle.as_deref().is_some_and(|own| own.path_waits);
        let mut spindles = stage.own.spindles.iter().map(|(_, axis)| *axis).filter(|axis| waits(*axis)).peekable();
        if spindles.peek().is_some() && self.programs[stage.channel].output.concerns_spindles() {
            return Some((Rule::SpindleAcknowledgementAwaited, Input::None));
        }
        if let Some(number) = self.gear_changing(stage) {
            return Some((Rule::GearChangeAwaited, axis_signal(number, axis_from_nck::change_gear_stage, true)));
        }
        spindles.find_map(|number| {
            let spindle = self.spindles[number].as_deref().filter(|spindle| spindle.is_programmed())?;
            let turns = spindle.commanded != 0.0 && !spindle.is_new;
            if turns && self.is_in_speed_range(number, parameters) {
                return None;
            }
            let input = match spindle.holder {
                Input::None => axis_signal(number, axis_from_nck::spindle_in_setpoint_range, false),
                holder => holder,
            };
            Some((Rule::SpindleSpeedAwaited, input))
        })
    }

    /// Revolutions per second of the master spindle, with G95; 1 with G94.
    pub(in crate::sinumerik) fn revolutions(&self, run: &Run, stage: &Stage<'_>) -> f64 {
        match stage.own.spindle(0).filter(|_| run.is_per_revolution()) {
            Some(number) => self.axes[number].turning_speed().abs() / (60.0 * REVOLUTION_PER_MINUTE),
            None => 1.0,
        }
    }

    /// With G95 the path waits while the master spindle stands.
    pub(in crate::sinumerik) fn spindle_stands(&self, run: &Run, stage: &Stage<'_>) -> Option<(Rule, Input)> {
        let number = stage.own.spindle(0).filter(|_| run.is_per_revolution() && run.on_path > 0)?;
        let own = &stage.parameters.axes[number];
        let stands = self.axes[number].turning_speed().abs() < own.standstill_velocity;
        stands.then(|| (Rule::SpindleSpeedAwaited, self.axes[number].measured_velocity(number)))
    }

    /// G4 S: the spindle has not turned far enough.
    pub(in crate::sinumerik) fn dwells_for_turns(
        &self,
        turns: &mut Option<(AxisNumber, f64)>,
        stage: &Stage<'_>,
    ) -> bool {
        let Some((number, left)) = *turns else { return false };
        let left = left - self.axes[number].turning_speed().abs() * stage.parameters.cycle.seconds();
        *turns = (left > 0.0).then_some((number, left));
        turns.is_some()
    }
}

impl Run {
    /// G95 without dry run.
    fn is_per_revolution(&self) -> bool {
        self.queue.front().is_some_and(Executable::is_per_revolution) && !self.dry_run
    }

    /// $P_S and $P_SDIR: what prepared blocks have given to a spindle.
    pub(in crate::sinumerik) fn note_spindle_function(
        &mut self,
        function: &AuxiliaryFunction,
        own: &ProgramParameters,
    ) {
        let number = function.extension.filter(|number| *number != 0).unwrap_or_else(|| own.master_spindle.into());
        let direction = [3, 4, 5].into_iter().find(|m| (function.value - f64::from(*m)).abs() < 0.5);
        let (speed, direction) = match function.kind {
            AuxiliaryKind::S => (Some(function.value), None),
            AuxiliaryKind::M => (None, direction),
            AuxiliaryKind::T | AuxiliaryKind::D | AuxiliaryKind::SumOffset | AuxiliaryKind::H | AuxiliaryKind::F => {
                return;
            }
        };
        if !self.prepared_spindles.iter().any(|(of, ..)| *of == number) {
            self.prepared_spindles.push((number, 0.0, 5));
        }
        for (_, known, turns) in self.prepared_spindles.iter_mut().filter(|(of, ..)| *of == number) {
            (*known, *turns) = (speed.unwrap_or(*known), direction.unwrap_or(*turns));
        }
    }
}

impl Executable {
    /// G95: its feed is for one revolution of the master spindle in a second.
    pub(in crate::sinumerik) fn is_per_revolution(&self) -> bool {
        self.modal.is(g::G95)
    }
}
