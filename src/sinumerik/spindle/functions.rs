//! Auxiliary functions for spindles: M3, M4, M5, M40 to M45, M70 and S.
//!
//! Called by the stage "programs": [`State::show_spindle_functions`] when a package is output, [`State::take_spindle_functions`] when the PLC has
//! acknowledged it. The extension is the number of the spindle.

use crate::control::{Owner, Value};
use crate::nc_program::{AuxiliaryKind, is_of_spindle};
use crate::sinumerik::machine_data::Target;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::ProgramParameters;
use crate::sinumerik::program::auxiliary::{Entry, Package};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::spindle::state::{Mode, Spindle};
use crate::sinumerik::state::State;
use crate::units::AxisNumber;
use crate::variables::{EventId, Place};

impl State {
    /// DBW86 and DBD88 show the functions of a package from its output on.
    pub(in crate::sinumerik) fn show_spindle_functions(
        &mut self,
        package: &Package,
        own: &ProgramParameters,
        event: EventId,
    ) {
        for entry in package {
            let Some(axis) = axis_of(entry, own) else { continue };
            let Some(spindle) = self.spindles[axis].as_deref_mut() else { continue };
            match entry.kind {
                AuxiliaryKind::S => {
                    #[expect(clippy::cast_possible_truncation, reason = "the interface has REALs of four bytes")]
                    let shown = entry.value as f32;
                    spindle.s_function = shown;
                }
                _ => spindle.m_function = number(entry),
            }
            spindle.function_cause = event;
        }
    }

    /// The PLC has acknowledged a package: its functions act on their spindles.
    pub(in crate::sinumerik) fn take_spindle_functions(
        &mut self,
        package: &Package,
        (own, parameters): (&ProgramParameters, &Parameters),
        event: EventId,
    ) {
        for entry in package {
            let Some(axis) = axis_of(entry, own) else { continue };
            let Some(spindle) = self.spindles[axis].as_deref() else { continue };
            let before = *spindle;
            let event = self.log.note_plain(Place::Axis(axis), Rule::SpindleFunction, event);
            let own = parameters.axes[axis].spindle.as_deref();
            let mut wants = false;
            if let Some(spindle) = self.spindles[axis].as_deref_mut() {
                spindle.take(entry);
                if let Some(own) = own.filter(|own| own.has_stages) {
                    let m = (entry.kind == AuxiliaryKind::M).then(|| number(entry));
                    wants = spindle.want_stage(m, own);
                }
                if spindle.mode != before.mode {
                    (spindle.cause, spindle.mode_cause, spindle.position_cause) = (event, event, event);
                }
                if (spindle.direction, spindle.speed.to_bits()) != (before.direction, before.speed.to_bits()) {
                    (spindle.cause, spindle.is_new) = (event, true);
                }
            }
            if wants {
                self.begin_gear_change(axis, event);
            }
        }
    }
}

/// SD43220 for G26 S, SD43210 for G25 S.
pub(in crate::sinumerik) fn limit_of_spindle(
    (is_upper, axis, limit): (bool, AxisNumber, f64),
) -> Option<(Target, Value)> {
    let number = if is_upper { 43220 } else { 43210 };
    let target = Target::new(number, Owner::Axis(axis), 0).ok()?;
    Some((target, Value::Real(limit)))
}

impl Spindle {
    fn take(&mut self, entry: &Entry) {
        if entry.kind == AuxiliaryKind::S {
            self.speed = entry.value;
            return;
        }
        match number(entry) {
            3 => (self.direction, self.stopped, self.mode) = (1, false, Mode::Control),
            4 => (self.direction, self.stopped, self.mode) = (-1, false, Mode::Control),
            5 => (self.direction, self.mode) = (0, Mode::Control),
            70 => (self.direction, self.mode) = (0, Mode::Axis),
            _ => {}
        }
    }
}

/// The axis of the spindle that a function concerns.
fn axis_of(entry: &Entry, own: &ProgramParameters) -> Option<AxisNumber> {
    let concerns = match entry.kind {
        AuxiliaryKind::S => true,
        AuxiliaryKind::M => is_of_spindle(entry.value),
        AuxiliaryKind::T | AuxiliaryKind::D | AuxiliaryKind::SumOffset | AuxiliaryKind::H | AuxiliaryKind::F => false,
    };
    if concerns { own.spindle(entry.extension) } else { None }
}

/// The number of an M function.
fn number(entry: &Entry) -> u16 {
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the cast saturates")]
    let number = entry.value.round() as u16;
    number
}
