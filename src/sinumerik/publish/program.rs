//! The values of the program of a channel: the block that runs, and the name of its program.

use crate::sinumerik::parameters::Parameters;
use crate::sinumerik::program::state::{ChannelProgram, Phase, Preparation};
use crate::sinumerik::state::State;
use crate::units::{AxisNumber, Position};
use crate::variables::{ChannelValues, ShownProgram, program_name};

impl ChannelProgram {
    /// The block of an alarm when everything before it has been executed. Between two blocks, and in a block whose display is off (DISPLOF), the values stay.
    pub(super) fn show_values(&self, values: &mut ChannelValues) {
        let Some(run) = &self.run else {
            values.block = 0;
            match &self.selected {
                Some(path) => values.program = program_name(path),
                None => values.program.clear(),
            }
            return;
        };
        if let (Preparation::Failed { alarm, place: (program, line), .. }, true) =
            (&run.preparation, run.is_at_rest() || run.stands_before_moving_axis())
        {
            values.block = block_number(&alarm.block, *line);
            values.program = program_name(program);
            return;
        }
        if let Some(origin) = &run.alarm_origin {
            values.block = block_number(&origin.name, origin.line);
            values.program = program_name(&origin.program);
            return;
        }
        let runs = run.queue.front().filter(|_| run.phase != Phase::Between);
        if let Some(origin) = runs.map(|block| &block.origin).filter(|origin| !origin.is_display_off) {
            values.block = block_number(&origin.name, origin.line);
            values.program = program_name(&origin.program);
        }
    }

    /// What operator panels show of it: the block that runs, unless its display is off.
    pub(in crate::sinumerik) fn shown(&self) -> ShownProgram<'_> {
        let selected = self.selected.as_deref();
        let message = self.message.as_deref().unwrap_or_default();
        let Some(run) = &self.run else {
            return ShownProgram { selected, active: selected, message, ..ShownProgram::default() };
        };
        let main = if run.is_mda { self.mda.as_deref() } else { selected };
        let shown = ShownProgram {
            selected,
            active: main,
            message,
            velocity: run.path.velocity() / Position::PER_USER_UNIT * 60.0,
            ..ShownProgram::default()
        };
        let runs = run.queue.front().filter(|_| run.phase != Phase::Between).map(|block| &block.origin);
        match runs.filter(|origin| !origin.is_display_off) {
            Some(origin) => {
                ShownProgram { active: Some(&origin.program), line: origin.line, block: &origin.text, ..shown }
            }
            None => shown,
        }
    }
}

impl State {
    /// What an axis has left of the block that runs: the axes of the path, and those of POS and POSA; a synchronous axis as its leading axis.
    pub(super) fn distance_to_go_of_program(&self, number: AxisNumber, parameters: &Parameters) -> Option<Position> {
        let leader = self.units.iter().find(|unit| unit.set.contains(number))?.leader();
        let channel = self.owners.of(leader).channel;
        if !self.owners.is_program_axis(leader, channel) {
            // A PLC axis or a command axis goes beside the path.
            return None;
        }
        let run = self.programs[channel].run.as_deref()?;
        let own = parameters.programs[channel].as_deref()?;
        let setpoint = self.axes[leader].setpoint.position;
        if let Some(positioning) = run.positionings.iter().find(|one| one.axis == leader) {
            return Some(positioning.target - setpoint);
        }
        let (block, _) = run.path.current()?;
        #[expect(clippy::cast_possible_truncation, reason = "a position of an axis fits")]
        let end = Position::new(block.way.end()[own.axes.place(leader)?].round() as i64);
        Some(end - setpoint)
    }
}

/// The N number of a block, else its line.
fn block_number(name: &str, line: u32) -> u32 {
    let digits = name.strip_prefix(['N', ':']).unwrap_or_default();
    let is_number = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_number);
    number.unwrap_or(line)
}
