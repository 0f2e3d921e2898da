//! The programs in the memory of the control, and which of them a channel has selected.

use std::sync::Arc;

use crate::nc_program::{Program, ProgramKind};
use crate::sinumerik::nck::Nck;
use crate::sinumerik::program::state::ProgramState;
use crate::sinumerik::rules::Rule;
use crate::source::{Problem, did_you_mean};
use crate::units::ChannelNumber;
use crate::variables::{EventId, Place};

/// The folder of the blocks of MDA.
const MDA: &str = "_N_MDA_DIR";

impl Nck {
    /// Puts programs into the memory.
    pub(in crate::sinumerik) fn load_programs(&mut self, programs: Vec<Program>, search_path: Vec<String>) {
        let library = Arc::make_mut(&mut self.programs);
        for program in programs {
            library.add(program);
        }
        library.search_also(search_path);
    }

    pub(in crate::sinumerik) fn check_channel(&self, channel: ChannelNumber) -> Result<(), Problem> {
        if self.stored().mode_group(channel).is_some() {
            return Ok(());
        }
        let found = format!("expected a channel of the machine, found channel {channel}");
        Err(Problem::new(found, "MD10010 gives the channels of a machine their mode groups"))
    }

    pub(in crate::sinumerik) fn check_program(&self, channel: ChannelNumber, path: &str) -> Result<(), Problem> {
        self.check_channel(channel)?;
        if self.programs.program(path).is_some() {
            return Ok(());
        }
        let known: Vec<_> = self.programs.iter().map(|program| program.path()).collect();
        let cure = did_you_mean(path, known.iter().map(String::as_str), "no program of this path is in memory");
        Err(Problem::new(format!("expected an NC program, found {path:?}"), cure))
    }

    /// Selects the program that AUTOMATIC starts. A program that runs or is stopped goes on; the selection acts with the next start.
    pub(in crate::sinumerik) fn select_program(&mut self, channel: ChannelNumber, path: &str) -> EventId {
        self.state.programs[channel].selected = Some(path.to_owned());
        self.state.log.note_plain(Place::Channel(channel), Rule::ProgramSelected, EventId::NONE)
    }

    /// Gives blocks to MDA, in the place of the earlier ones. A block that runs is not changed.
    pub(in crate::sinumerik) fn enter_blocks(&mut self, channel: ChannelNumber, text: &str) -> EventId {
        let is_free = self.state.programs[channel].state == ProgramState::Aborted;
        let runs_automatic = self.state.programs[channel].run.as_ref().is_some_and(|run| !run.is_mda);
        if is_free || runs_automatic {
            let program = Program::new(&format!("MDA_CHAN{channel}"), ProgramKind::Main, MDA, text.as_bytes());
            let path = program.path();
            Arc::make_mut(&mut self.programs).add(program);
            self.state.programs[channel].mda = Some(path);
        }
        self.state.log.note_plain(Place::Channel(channel), Rule::BlocksEntered, EventId::NONE)
    }
}
