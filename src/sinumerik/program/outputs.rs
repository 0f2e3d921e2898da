//! The auxiliary functions of a block: when each is output, and which stop the program.

use crate::control::Changes;
use crate::nc_program::{Action, AuxiliaryFunction, AuxiliaryKind, Block, End, is_of_spindle};
use crate::sinumerik::alarms::programs as alarms;
use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::parameters::programs::{OutputTime, ProgramParameters};
use crate::sinumerik::parameters::spindle::SpindleParameters;
use crate::sinumerik::program::auxiliary::{Entry, Package};
use crate::sinumerik::program::executable::{Executable, ProgrammedStop};
use crate::sinumerik::program::preparation::{Preparing, block_parameter};
use crate::sinumerik::program::state::{BlockAlarm, block_name};
use crate::sinumerik::rules::Rule;
use crate::sinumerik::state::State;
use crate::units::ChannelNumber;
use crate::variables::{Parameter, Place};

impl Preparing<'_> {
    /// Sorts the auxiliary functions by the time of their output, and finds programmed stops.
    pub(super) fn take_outputs(&self, block: &Block, moves: bool, done: &mut Executable) -> Result<(), BlockAlarm> {
        let mut entries = [const { Vec::<Entry>::new() }; 3];
        let mut places = [0_u8; 7];
        if let Some(entry) = self.m19_of_position(block) {
            entries[0].push(entry);
            places[order(AuxiliaryKind::M)] += 1;
        }
        let of_block = block.auxiliary.iter().filter(|function| function.kind == AuxiliaryKind::M).count();
        if let Some(implicit) = entries[0].first()
            && of_block >= MOST_M_FUNCTIONS
        {
            let parameters =
                [block_parameter(block), Parameter::Number(implicit.extension.into()), Parameter::Number(19)];
            let block = block_name(&block.origin.name);
            return Err(BlockAlarm { number: alarms::TOO_MANY_M_FUNCTIONS, parameters, block });
        }
        for function in &block.auxiliary {
            let place = &mut places[order(function.kind)];
            if self.take_m19(function, done) {
                continue;
            }
            let entry = entry(function, *place, self.own);
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
        Ok(())
    }

    /// M19 of a spindle is SPOS at SD43240. Returns whether it is not output: only MD20850 or MD35035 bit 19 do that.
    fn take_m19(&self, function: &AuxiliaryFunction, done: &mut Executable) -> bool {
        let is_m19 = function.kind == AuxiliaryKind::M && is_number(function, 19);
        let spindle = function.extension.unwrap_or(0);
        let Some(axis) = self.own.spindle(spindle).filter(|_| is_m19) else { return false };
        let Some(data) = self.parameters.axes[axis].spindle.as_deref() else { return false };
        let (value, dimension) = data.m19;
        done.actions.push(Action::SpindlePosition { spindle: Some(data.number.into()), value, dimension, waits: true });
        !self.outputs_m19(data)
    }

    fn outputs_m19(&self, data: &SpindleParameters) -> bool {
        data.outputs_m19 || self.own.outputs_m19
    }

    /// The M19 that SPOS or SPOSA outputs.
    fn m19_of_position(&self, block: &Block) -> Option<Entry> {
        let spindle = block.actions.iter().find_map(|action| match action {
            Action::SpindlePosition { spindle, .. } => Some(spindle.unwrap_or(0)),
            _ => None,
        })?;
        let data = self.parameters.axes[self.own.spindle(spindle)?].spindle.as_deref()?;
        self.outputs_m19(data).then(|| Entry {
            kind: AuxiliaryKind::M,
            place: 0,
            extension: data.number.into(),
            value: 19.0,
            is_quick: false,
            is_decoded: data.number == self.own.master_spindle,
            is_of_spindle: true,
        })
    }

    /// The number of a spindle that a function names and the channel does not have (16100, P-143). Without a number a function concerns the
    /// master spindle, and without one it is only output.
    pub(super) fn unknown_spindle(&self, block: &Block) -> Option<u16> {
        let mut named = block.auxiliary.iter().filter(|function| concerns_spindle(function));
        let is_unknown = |number: &u16| *number != 0 && self.own.spindle(*number).is_none();
        named.find_map(|function| function.extension.filter(is_unknown))
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

    /// What the kind and the group of an M function say.
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
        } else if is(&[6]) || is_of_spindle(function.value) {
            OutputTime::Before
        } else {
            self.own.output_time(AuxiliaryKind::M)
        }
    }
}

impl State {
    /// What the PLC has seen is acknowledged, and its spindle functions act; what was shown for one scan is taken back. Returns whether something
    /// was.
    pub(super) fn acknowledge(
        &mut self,
        channel: ChannelNumber,
        parameters: (&ProgramParameters, &Parameters),
        changes: &Changes,
    ) -> bool {
        let output = &mut self.programs[channel].output;
        let of_spindles = |package: &Package| package.iter().any(|entry| entry.is_of_spindle);
        let package = output.acknowledge(self.log.cycle, changes.seen).filter(of_spindles);
        let was_shown = output.was_shown(changes.scanned);
        if !was_shown && package.is_none() {
            return false;
        }
        let before = output.cause;
        let event = self.log.note_plain(Place::Channel(channel), Rule::AuxiliaryAcknowledged, before);
        if was_shown {
            self.programs[channel].output.take_back(event);
        }
        if let Some(package) = package {
            self.take_spindle_functions(&package, parameters, event);
        }
        was_shown
    }
}

/// M functions of a block, with those that it outputs without naming them (M19 of SPOS).
const MOST_M_FUNCTIONS: usize = 5;

/// A function at its place in the interface.
pub(super) fn entry(function: &AuxiliaryFunction, place: u8, own: &ProgramParameters) -> Entry {
    let concerns = concerns_spindle(function);
    // An omitted extension is the master spindle, if the channel has one.
    let omitted = if concerns { own.master_spindle.into() } else { 0 };
    // F: 0 is the feed of the path, otherwise the number of the positioning axis.
    let machine_axis = function.axis.and_then(|name| own.axes.machine_axes.get(usize::from(name.0)));
    let of_axis = machine_axis.map(|axis| u16::from(axis.number()));
    let extension = of_axis.or(function.extension).unwrap_or(omitted);
    let master = own.master_spindle.max(u8::from(own.spindles.is_empty()));
    Entry {
        kind: function.kind,
        place,
        extension,
        value: function.value,
        is_quick: function.is_quick,
        is_decoded: extension == 0 || concerns && extension == u16::from(master),
        is_of_spindle: concerns && own.spindle(extension).is_some(),
    }
}

/// Whether it is an S function, or an M function of a spindle.
fn concerns_spindle(function: &AuxiliaryFunction) -> bool {
    match function.kind {
        AuxiliaryKind::S => true,
        AuxiliaryKind::M => is_of_spindle(function.value),
        AuxiliaryKind::T | AuxiliaryKind::D | AuxiliaryKind::SumOffset | AuxiliaryKind::H | AuxiliaryKind::F => false,
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
