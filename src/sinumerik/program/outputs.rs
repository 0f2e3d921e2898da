//! The auxiliary functions of a block: when each is output, and which stop the program.

use crate::nc_program::{AuxiliaryFunction, AuxiliaryKind, Block, End};
use crate::sinumerik::parameters::programs::OutputTime;
use crate::sinumerik::program::auxiliary::{Entry, Package};
use crate::sinumerik::program::preparation::Preparing;
use crate::sinumerik::program::state::{Executable, ProgrammedStop};

impl Preparing<'_> {
    /// Sorts the auxiliary functions by the time of their output, and finds programmed stops.
    pub(super) fn take_outputs(&self, block: &Block, moves: bool, done: &mut Executable) {
        let mut entries = [const { Vec::<Entry>::new() }; 3];
        let mut places = [0_u8; 7];
        for function in &block.auxiliary {
            let place = &mut places[order(function.kind)];
            let entry = Entry {
                kind: function.kind,
                place: *place,
                extension: function.extension.unwrap_or(0),
                value: function.value,
                is_quick: function.is_quick,
            };
            *place += 1;
            let stop = self.programmed_stop(function);
            if stop != ProgrammedStop::None {
                done.stop = stop;
            }
            if function.kind == AuxiliaryKind::M
                && block.end == Some(End::Subprogram)
                && [2, 17, 30].iter().any(|number| is_number(function, *number))
                && !self.own.outputs_end_of_subprogram
            {
                continue;
            }
            match self.output_time(function) {
                OutputTime::Never => {}
                // Without motion there is nothing to wait for: all of them together.
                OutputTime::Before => entries[0].push(entry),
                _ if !moves => entries[0].push(entry),
                OutputTime::During => entries[1].push(entry),
                OutputTime::End => entries[2].push(entry),
            }
        }
        for (package, mut entries) in done.outputs.iter_mut().zip(entries) {
            entries.sort_by_key(|entry| (order(entry.kind), entry.place));
            // A block has at most ten auxiliary functions (14750).
            *package = entries.into_iter().take(Package::new().capacity()).collect();
        }
    }

    fn programmed_stop(&self, function: &AuxiliaryFunction) -> ProgrammedStop {
        let [m0, m1] = self.own.associated_stops;
        let is = |number: i32| is_number(function, number);
        if function.kind != AuxiliaryKind::M || function.extension.unwrap_or(0) != 0 {
            ProgrammedStop::None
        } else if is(0) {
            ProgrammedStop::Always
        } else if is(1) {
            ProgrammedStop::Optional
        } else if is(m0) {
            ProgrammedStop::Associated
        } else if is(m1) {
            ProgrammedStop::AssociatedOptional
        } else {
            ProgrammedStop::None
        }
    }

    /// nc_programs.md 1.5: what the kind and the group of an M function say.
    fn output_time(&self, function: &AuxiliaryFunction) -> OutputTime {
        match function.kind {
            // S is predefined, and that has priority over the type (MD22210).
            AuxiliaryKind::S => return OutputTime::During,
            AuxiliaryKind::M => {}
            kind => return self.own.output_time(kind),
        }
        let is = |numbers: &[i32]| numbers.iter().any(|number| is_number(function, *number));
        let plain = function.extension.unwrap_or(0) == 0;
        if plain && is(&[0, 1, 2, 17, 30]) || self.programmed_stop(function) != ProgrammedStop::None {
            OutputTime::End
        } else if is(&[3, 4, 5, 6, 19, 70, 40, 41, 42, 43, 44, 45]) {
            OutputTime::Before
        } else {
            self.own.output_time(AuxiliaryKind::M)
        }
    }
}

/// Whether a function has this whole number.
fn is_number(function: &AuxiliaryFunction, number: i32) -> bool {
    (function.value - f64::from(number)).abs() < 0.5
}

/// M, S, T, D, DL, H, F: the order within a package.
const fn order(kind: AuxiliaryKind) -> usize {
    match kind {
        AuxiliaryKind::M => 0,
        AuxiliaryKind::S => 1,
        AuxiliaryKind::T => 2,
        AuxiliaryKind::D => 3,
        AuxiliaryKind::SumOffset => 4,
        AuxiliaryKind::H => 5,
        AuxiliaryKind::F => 6,
    }
}
