//! The positions of the bytes of an area or a data block in the memory by writer.

use crate::source::Problem;

use super::interface::Run;
use super::profile::beyond;
use super::{Area, Memory, Numbering, Profile};

impl Memory {
    /// The position of `bytes` bytes from `byte` of an area on. All of them exist, but the run can be shorter.
    pub(super) fn run(&self, area: Area, byte: u32, bytes: u32, profile: Profile) -> Result<Run, Problem> {
        if let Area::DataBlock(db) = area {
            // A block of the PLC program with the number of a block that this machine does not use (P-151).
            let is_own = self.blocks.get(db).is_some();
            if !is_own && profile.has(db) {
                return profile.run(db, byte, byte.saturating_add(bytes.max(1)) - 1);
            }
            if !is_own {
                return Err(self.unknown(db, profile));
            }
        }
        let part = area.plain_part();
        let length = u32::try_from(self.part(part).len()).unwrap_or(u32::MAX);
        if byte.saturating_add(bytes) > length {
            return Err(beyond(&area.to_string(), length, byte.saturating_add(bytes)));
        }
        Ok(Run { part, offset: byte, left: length - byte })
    }

    fn unknown(&self, db: u16, profile: Profile) -> Problem {
        let own: Vec<String> = self.blocks.iter().map(|block| block.number.to_string()).collect();
        let Numbering { blocks, axes, .. } = profile.numbering();
        let mut others = Profile::all(profile.interface()).filter(|other| *other != profile);
        let cure = match others.find(|other| other.has(db)) {
            Some(other) => {
                format!("it is a block of {}; set its profile, or use a symbol", other.numbering().title)
            }
            None => format!("the data block of an axis is {axes}; declare other blocks in a PLC image"),
        };
        Problem::new(
            format!("expected {blocks} or a block of the PLC program ({}), found DB{db}", own.join(", ")),
            cure,
        )
    }
}
