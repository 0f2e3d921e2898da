//! The blocks of the PLC: their number by type, a list, the description of a block, and its content.

use super::error::Error;
use super::system::text;
use super::{Client, Question};
use crate::s7::wire::header::{ErrorCode, function};
use crate::s7::wire::replies;
use crate::s7::wire::requests;
use crate::s7::wire::user_data::group;

/// The longest block in load memory: 64 KiB of content with header and trailer.
const LONGEST: usize = 128 * 1024;

/// Block types.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlockKind {
    /// Organization block.
    Ob,
    /// Data block.
    Db,
    /// System data block.
    Sdb,
    /// Function.
    Fc,
    /// System function.
    Sfc,
    /// Function block.
    Fb,
    /// System function block.
    Sfb,
}

impl BlockKind {
    /// All types.
    pub const ALL: [Self; 7] = [Self::Ob, Self::Db, Self::Sdb, Self::Fc, Self::Sfc, Self::Fb, Self::Sfb];

    /// Its letter on the wire.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::Ob => b'8',
            Self::Db => b'A',
            Self::Sdb => b'B',
            Self::Fc => b'C',
            Self::Sfc => b'D',
            Self::Fb => b'E',
            Self::Sfb => b'F',
        }
    }

    /// `OB`, `DB`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Ob => "OB",
            Self::Db => "DB",
            Self::Sdb => "SDB",
            Self::Fc => "FC",
            Self::Sfc => "SFC",
            Self::Fb => "FB",
            Self::Sfb => "SFB",
        }
    }
}

/// The number of blocks of a type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockCount {
    /// The type.
    pub kind: BlockKind,
    /// The number of blocks.
    pub count: u16,
}

/// A block in a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockEntry {
    /// Its number.
    pub number: u16,
    /// Flags, uninterpreted.
    pub flags: u8,
    /// Language, uninterpreted; 5 is a data block.
    pub language: u8,
}

/// The description of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BlockDescription {
    /// Its type.
    pub kind: BlockKind,
    /// Its number.
    pub number: u16,
    /// Language, uninterpreted; 5 is a data block.
    pub language: u8,
    /// Bytes in load memory.
    pub load_memory: u32,
    /// Bytes of its code or data.
    pub length: u16,
    /// Its author.
    pub author: String,
    /// Its family.
    pub family: String,
    /// Its name.
    pub name: String,
    /// Its version; the high four bits are the digit before the point.
    pub version: u8,
    /// Its checksum.
    pub checksum: u16,
}

impl Client {
    /// The number of blocks of each type.
    ///
    /// # Errors
    /// The module does not report it, or no answer arrives.
    pub async fn block_counts(&self) -> Result<Vec<BlockCount>, Error> {
        let payload = self.short("number of blocks", group::BLOCKS, 1, &[], true).await?;
        let count = |entry: &[u8]| {
            let &[b'0', code, high, low] = entry else { return None };
            let kind = BlockKind::ALL.into_iter().find(|kind| kind.code() == code)?;
            Some(BlockCount { kind, count: u16::from_be_bytes([high, low]) })
        };
        Ok(payload.chunks(4).filter_map(count).collect())
    }

    /// The blocks of a type.
    ///
    /// # Errors
    /// The module does not report them, or no answer arrives.
    pub async fn blocks(&self, kind: BlockKind) -> Result<Vec<BlockEntry>, Error> {
        let payload = match self.long("list of blocks", group::BLOCKS, 2, &[b'0', kind.code()]).await {
            Err(Error::Rejected { error: ErrorCode::NO_BLOCK, .. }) => return Ok(Vec::new()),
            payload => payload?,
        };
        let entry = |entry: &[u8]| {
            let &[high, low, flags, language] = entry else { return None };
            Some(BlockEntry { number: u16::from_be_bytes([high, low]), flags, language })
        };
        Ok(payload.chunks(4).filter_map(entry).collect())
    }

    /// The description of a block.
    ///
    /// # Errors
    /// There is no such block, or no answer arrives.
    pub async fn describe_block(&self, kind: BlockKind, number: u16) -> Result<BlockDescription, Error> {
        let name = format!("{}{number}", kind.name());
        let block = requests::block_name(kind.code(), number);
        let payload = self.short("block", group::BLOCKS, 3, &block, true).await;
        let payload = payload.map_err(|error| error.of(&name))?;
        describe(kind, &payload)
            .ok_or_else(|| Error::Unexpected { what: name, found: format!("{} bytes", payload.len()) })
    }

    /// Uploads a block in its load memory format: a header of 36 bytes, its content, a trailer.
    ///
    /// # Errors
    /// There is no such block, the upload is not permitted, or no answer arrives.
    pub async fn upload(&self, kind: BlockKind, number: u16) -> Result<Vec<u8>, Error> {
        let name = format!("upload of {}{number}", kind.name());
        let unexpected = |found: String| Error::Unexpected { what: name.clone(), found };
        let begin = requests::start_upload(requests::block_name(kind.code(), number));
        let reply = self.ask(Question::job("upload", &begin)).await.map_err(|error| error.of(&name))?;
        let begun = replies::upload_begun(&reply.parameter);
        let (number, length) = begun.ok_or_else(|| unexpected("no upload number".to_owned()))?;
        let block = self.pieces(&name, number).await;
        if matches!(block, Err(Error::Lost { .. })) {
            return block; // the upload ended with its connection
        }
        // End the upload even after an error: an open upload occupies one of the few upload slots of the module.
        let end = requests::upload(function::END_UPLOAD, number);
        let ended = self.ask(Question::job("upload", &end)).await.map_err(|error| error.of(&name));
        let block = block?;
        ended?;
        if block.len() == length { Ok(block) } else { Err(unexpected(format!("{} of {length} bytes", block.len()))) }
    }

    /// The content of an upload that has begun.
    async fn pieces(&self, name: &str, number: [u8; 4]) -> Result<Vec<u8>, Error> {
        let unexpected = |found: String| Error::Unexpected { what: name.to_owned(), found };
        let mut block = Vec::new();
        let piece = requests::upload(function::UPLOAD, number);
        loop {
            let reply = self.ask(Question::job("upload", &piece)).await.map_err(|error| error.of(name))?;
            let piece = replies::upload_piece(&reply.parameter, &reply.data);
            let (piece, more) = piece.ok_or_else(|| unexpected("no piece of a block".to_owned()))?;
            block.extend_from_slice(piece);
            if !more {
                return Ok(block);
            }
            if block.len() > LONGEST || piece.is_empty() {
                return Err(unexpected(format!("the block exceeds the maximum length, {} bytes so far", block.len())));
            }
        }
    }
}

/// The description of the block begins after its type, a length and an unknown word.
fn describe(kind: BlockKind, payload: &[u8]) -> Option<BlockDescription> {
    let head = payload.get(6..)?;
    let word = |at: usize| Some(u16::from_be_bytes(head.get(at..at + 2)?.try_into().ok()?));
    let text = |at: usize| head.get(at..at + 8).map(text);
    Some(BlockDescription {
        kind,
        number: word(6)?,
        language: *head.get(4)?,
        load_memory: u32::from_be_bytes(head.get(8..12)?.try_into().ok()?),
        length: word(34)?,
        author: text(36)?,
        family: text(44)?,
        name: text(52)?,
        version: *head.get(60)?,
        checksum: word(62)?,
    })
}
