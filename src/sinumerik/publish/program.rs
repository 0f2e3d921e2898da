//! The values of the program of a channel: the block that runs, and the name of its program.

use crate::nc_program::Origin;
use crate::sinumerik::program::state::{ChannelProgram, Phase};
use crate::variables::{ChannelValues, program_name};

impl ChannelProgram {
    /// Between two blocks, and in a block whose display is off (DISPLOF), the values stay.
    pub(super) fn show_values(&self, values: &mut ChannelValues) {
        let Some(run) = &self.run else {
            values.block = 0;
            match &self.selected {
                Some(path) => values.program = program_name(path),
                None => values.program.clear(),
            }
            return;
        };
        let runs = run.queue.front().filter(|_| run.phase != Phase::Between);
        if let Some(origin) = runs.map(|block| &block.origin).filter(|origin| !origin.is_display_off) {
            values.block = block_number(origin);
            values.program = program_name(&origin.program);
        }
    }
}

/// The N number of a block, else its line.
fn block_number(origin: &Origin) -> u32 {
    let digits = origin.name.strip_prefix(['N', ':']).unwrap_or_default();
    let is_number = !digits.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit());
    let number = digits.parse().ok().filter(|_| is_number);
    number.unwrap_or(origin.line)
}
