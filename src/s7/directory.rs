//! The existing data blocks and their lengths. They are determined once, because blocks do not change while a machine
//! runs.

use super::station::BlockInfo;
use crate::image::{Memory, Profile};

/// The data blocks of a memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directory {
    blocks: Vec<BlockInfo>,
}

impl Directory {
    /// The interface blocks of a profile and the user blocks of a memory.
    #[must_use]
    pub fn of(memory: &Memory, profile: Profile) -> Self {
        // An interface block ends after its last byte; gaps before it count.
        let end = |number| profile.spans(number).last().map_or(0, |(_, end)| *end);
        let interface = profile.data_blocks().into_iter().filter(|number| memory.blocks.get(*number).is_none());
        let mut blocks: Vec<_> = interface.map(|number| BlockInfo { number, length: end(number) }).collect();
        blocks.extend(memory.blocks.iter().filter_map(|block| {
            let length = u16::try_from(block.bytes.len()).ok()?;
            Some(BlockInfo { number: block.number, length })
        }));
        blocks.sort_by_key(|block| block.number);
        Self { blocks }
    }

    /// All blocks in ascending order.
    #[must_use]
    pub fn blocks(&self) -> &[BlockInfo] {
        &self.blocks
    }

    /// Whether a block with this number exists.
    #[must_use]
    pub fn has(&self, number: u16) -> bool {
        self.blocks.binary_search_by_key(&number, |block| block.number).is_ok()
    }
}
