//! Which data blocks there are and how long they are, looked up once: blocks do not come and go while a machine runs.

use super::station::BlockInfo;
use crate::image::{Memory, Profile};

/// The data blocks of a memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directory {
    blocks: Vec<BlockInfo>,
}

impl Directory {
    /// The interface blocks of a profile and the own blocks of a memory.
    #[must_use]
    pub fn of(memory: &Memory, profile: Profile) -> Self {
        // An interface block ends behind its last byte, whatever gaps it has.
        let end = |number| profile.spans(number).last().map_or(0, |(_, end)| *end);
        let interface = profile.data_blocks().into_iter();
        let mut blocks: Vec<_> = interface.map(|number| BlockInfo { number, length: end(number) }).collect();
        blocks.extend(memory.blocks.iter().filter_map(|block| {
            let length = u16::try_from(block.bytes.len()).ok()?;
            Some(BlockInfo { number: block.number, length })
        }));
        blocks.sort_by_key(|block| block.number);
        Self { blocks }
    }

    /// All of them, ascending.
    #[must_use]
    pub fn blocks(&self) -> &[BlockInfo] {
        &self.blocks
    }

    /// Whether there is a block of this number.
    #[must_use]
    pub fn has(&self, number: u16) -> bool {
        self.blocks.binary_search_by_key(&number, |block| block.number).is_ok()
    }
}
