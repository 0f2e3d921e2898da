//! Which data blocks there are and how long they are, looked up once: blocks do not come and go while a machine runs.

use super::station::BlockInfo;
use crate::image::{Area, Memory, Profile};

/// The data blocks of a memory.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Directory {
    blocks: Vec<BlockInfo>,
}

impl Directory {
    /// The interface blocks of a profile and the own blocks of a memory.
    #[must_use]
    pub fn of(memory: &Memory, profile: Profile) -> Self {
        let interface: Vec<u16> = match profile {
            Profile::Sinumerik840dSl => [10, 11].into_iter().chain(21..=61).collect(),
            Profile::Sinumerik828d => {
                let single = [1800, 2600, 2700, 3000, 3100, 3200, 3300];
                single.into_iter().chain(3800..=3807).chain(3900..=3907).collect()
            }
        };
        let mut blocks: Vec<BlockInfo> = interface.into_iter().map(|number| block(memory, profile, number)).collect();
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

/// An interface block ends behind its last byte. Those of the 828D have some bytes at every thousand, and gaps between.
fn block(memory: &Memory, profile: Profile, number: u16) -> BlockInfo {
    let exists = |byte: &u16| memory.read_bytes(Area::DataBlock(number), (*byte).into(), &mut [0], profile).is_ok();
    let length = match profile {
        Profile::Sinumerik840dSl => {
            let bytes: Vec<u16> = (0..512).collect();
            u16::try_from(bytes.partition_point(exists)).unwrap_or(0)
        }
        Profile::Sinumerik828d => bytes_of_pages().rev().find(exists).map_or(0, |last| last + 1),
    };
    BlockInfo { number, length }
}

/// Where a block of the 828D may have bytes: at the beginning of each thousand.
pub(super) fn bytes_of_pages() -> impl DoubleEndedIterator<Item = u16> {
    (0..10).flat_map(|page| (0..32).map(move |byte| page * 1000 + byte))
}
