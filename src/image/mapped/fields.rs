//! The positions of all fields in the file. Every field is a number of 64 bits, least significant byte first, at a multiple of 8.

/// The first bytes of the file.
pub const MAGIC: [u8; 8] = *b"OpenNCK\0";
/// The version of the layout.
pub const VERSION: u64 = 1;
/// The number of slots of each side.
pub const SLOTS: usize = 8;

/// Defines the positions of a table, and the table itself, which tests compare with the documents.
macro_rules! fields {
    ($(#[$doc:meta])* $table:ident: $($name:ident $offset:literal $bytes:literal;)+) => {
        $(pub(in crate::image::mapped) const $name: usize = $offset;)+
        $(#[$doc])*
        pub const $table: &[(usize, usize, &str)] = &[$(($offset, $bytes, stringify!($name))),+];
    };
}

/// The header: constants of the NC, from 256 the words that the NC changes, from 512 the words that the PLC changes.
pub mod header {
    fields! {
        /// Position, length and name of each field.
        FIELDS:
        MAGIC 0 8;
        VERSION 8 8;
        GENERATION 16 8;
        FILE_BYTES 24 8;
        PROFILE 32 8;
        SECTIONS 40 8;
        SECTION_TABLE 48 8;
        SECTION_BYTES 56 8;
        IMAGE_BYTES 64 8;
        SLOTS 72 8;
        NC_SLOTS 80 8;
        NC_SLOT_BYTES 88 8;
        PLC_SLOTS 96 8;
        PLC_SLOT_BYTES 104 8;
        NC_CYCLE_TIME 112 8;
        LOCK_STEP 120 8;
        TIME_OUT 128 8;
        PROCESS 136 8;
        STATE 256 8;
        NEWEST_STEP 264 8;
        REQUEST 272 8;
        PLC_STARTS 512 8;
        NEWEST_ANSWER 520 8;
        ACKNOWLEDGE 528 8;
        POWER 536 8;
    }
    /// The end of the header, where the table of sections begins.
    pub(in crate::image::mapped) const END: usize = 4096;
}

/// One entry of the table of sections.
pub mod section {
    fields! {
        /// Position, length and name of each field.
        FIELDS:
        KIND 0 8;
        NUMBER 8 8;
        FIRST 16 8;
        LENGTH 24 8;
        OFFSET 32 8;
        WRITER 40 8;
        NAME 48 32;
    }
    /// The number of bytes of an entry.
    pub(in crate::image::mapped) const BYTES: usize = 80;
}

/// A slot of the NC: one step.
pub mod step {
    fields! {
        /// Position, length and name of each field. The image follows the fields, and the checksum ends the slot.
        FIELDS:
        NUMBER 0 8;
        CYCLE 8 8;
        TIME 16 8;
        SINCE_LAST 24 8;
        STARTS 32 8;
        TAKEN 40 8;
        IMAGE 64 0;
    }
}

/// A slot of the PLC: one answer.
pub mod answer {
    fields! {
        /// Position, length and name of each field. The image before the scan and the image after it follow; the checksum ends the slot.
        FIELDS:
        NUMBER 0 8;
        ANSWERS 8 8;
        CHANGES 16 8;
        PROCESS 24 8;
        BEFORE 64 0;
    }
    /// The number of bytes of an entry in a list of changes: the offset in the image (four bytes), the byte before, the byte after.
    pub(in crate::image::mapped) const CHANGE_BYTES: usize = 8;
}
