//! The interface as a memory-mapped file, through which a PLC in another process exchanges signals with the NC (feature `mapped`).
//!
//! [`MappedImage`] is the NC side, for a program that runs a machine. [`PlcImage`] is the PLC side, for a soft PLC in Rust. A PLC in
//! another language maps the file and follows the tables below. All numbers in the tables are whole numbers of 64 bits, least significant
//! byte first, at a multiple of 8. The bytes of an image are as in the PLC: words most significant byte first.
//!
//! # Consistent exchange
//!
//! Each side writes only its own slots and its own words of the header. To publish number *n*: store 0 as `NUMBER` of slot *n* mod `SLOTS`,
//! write the rest of the slot, store *n* as its `NUMBER`, then store *n* as the newest number. To read: load the newest number *n* and copy
//! its slot. The copy is valid only if its `NUMBER` is *n*, the `NUMBER` of the slot is still *n*, and the checksum is correct; otherwise
//! start again. The two numbers are sufficient if stores become visible in their order: on x86-64, and on all systems if both sides use
//! barriers. The checksum covers the other cases (Python on ARM). Load and store each word in one piece: in C as `_Atomic uint64_t`, in
//! Python through `memoryview(…).cast("Q")`.
//!
//! # Start-up
//!
//! The NC stores 0 as `STATE` and a new `GENERATION`, writes the header and the table of sections, publishes the memory after power on in
//! the next slot (slot 1 in a new file), and stores 2 as `STATE`. The PLC reads the header while `STATE` is not 0, checks that `GENERATION`
//! is unchanged, and adds 1 to `PLC_STARTS` when it is ready. It repeats this after every change of `GENERATION`, in a new process or in
//! the same one. It then waits for 1 as `STATE`, which the NC stores after the step of its first scan. In lock-step mode, the NC takes no
//! step before `PLC_STARTS` differs from its value at the start of the NC. Cycles count from that moment, so the result does not depend on
//! the start order or on the time.
//!
//! # Concurrent writes
//!
//! An answer contains the image before and after the scan. The NC takes the bits that differ, in the sections of the PLC. So a value that
//! an S7 client wrote in the meantime is kept unless the program changed the same bit, as in a PLC with a program and an HMI. After an
//! answer, the PLC waits for a step whose `TAKEN` is that answer: only this step contains the flags as the PLC left them.
//!
//! # The tables
//!
//! The header. The NC writes the layout once; later it writes the words from 256 on, and the PLC writes the words from 512 on.
//!
//! | byte | bytes | field | meaning |
//! |---|---|---|---|
//! | 0 | 8 | `MAGIC` | the characters `OpenNCK` and a byte 0 |
//! | 8 | 8 | `VERSION` | 1; a file of another version has another layout |
//! | 16 | 8 | `GENERATION` | the number of NCs that have used this file; read the header again after a change |
//! | 24 | 8 | `FILE_BYTES` | number of bytes of the file in use |
//! | 32 | 8 | `PROFILE` | 840 or 828: the numbering of the data blocks |
//! | 40 | 8 | `SECTIONS` | number of entries in the table of sections |
//! | 48 | 8 | `SECTION_TABLE` | position of the table in the file |
//! | 56 | 8 | `SECTION_BYTES` | bytes of an entry |
//! | 64 | 8 | `IMAGE_BYTES` | bytes of an image |
//! | 72 | 8 | `SLOTS` | slots of each side: number *n* is in slot *n* mod `SLOTS` |
//! | 80 | 8 | `NC_SLOTS` | position of the first NC slot in the file |
//! | 88 | 8 | `NC_SLOT_BYTES` | bytes of an NC slot |
//! | 96 | 8 | `PLC_SLOTS` | position of the first PLC slot in the file |
//! | 104 | 8 | `PLC_SLOT_BYTES` | bytes of a PLC slot |
//! | 112 | 8 | `NC_CYCLE_TIME` | interpolation cycle in nanoseconds |
//! | 120 | 8 | `LOCK_STEP` | 1: each step waits for its answer, and the first one waits for a PLC; 0: the NC takes the newest answer |
//! | 128 | 8 | `TIME_OUT` | maximum time in nanoseconds without an answer of the PLC |
//! | 136 | 8 | `PROCESS` | process number of the NC |
//! | 256 | 8 | `STATE` | NC state: 0 ended; 1 PLC in RUN; 2 PLC in STOP or before its first scan (answers are not taken) |
//! | 264 | 8 | `NEWEST_STEP` | the newest complete NC slot; 0: none yet |
//! | 272 | 8 | `REQUEST` | the step for whose answer the NC waits; 0: none |
//! | 512 | 8 | `PLC_STARTS` | the PLC adds 1 when it has read the header and is ready |
//! | 520 | 8 | `NEWEST_ANSWER` | the newest complete PLC slot; a PLC continues from the value that it finds |
//! | 528 | 8 | `ACKNOWLEDGE` | the step to which the newest answer belongs |
//! | 536 | 8 | `POWER` | the PLC adds 1 to switch the control off and on |
//!
//! An entry of the table of sections: adjacent bytes of one data block or area with one writer. Byte `FIRST` + *i* of the block is byte
//! `OFFSET` + *i* of an image. Sections of one block that follow each other without a gap also do so in the image, so STEP 7 addresses
//! count from one position.
//!
//! | byte | bytes | field | meaning |
//! |---|---|---|---|
//! | 0 | 8 | `KIND` | `DB`, `I`, `Q`, `M`, `T` or `C`, padded with 0 bytes; timers and counters have two bytes each |
//! | 8 | 8 | `NUMBER` | number of the data block, otherwise 0 |
//! | 16 | 8 | `FIRST` | first byte of the block in this section |
//! | 24 | 8 | `LENGTH` | bytes of the section |
//! | 32 | 8 | `OFFSET` | position of the first byte in an image |
//! | 40 | 8 | `WRITER` | 1 PLC, 2 NCK, 3 HMI, 4 machine (inputs); the NC takes changes of the PLC only in sections with writer 1 |
//! | 48 | 32 | `NAME` | name of the axis, the channel or the data block of the program, padded with 0 bytes |
//!
//! A slot of the NC: one step, as the PLC sees it at the beginning of its scan. The image contains all bytes of all writers, including the
//! values that S7 clients have written into flags and data blocks.
//!
//! | byte | bytes | field | meaning |
//! |---|---|---|---|
//! | 0 | 8 | `NUMBER` | the number of the step; 0 while it is being written |
//! | 8 | 8 | `CYCLE` | the cycle of the NC |
//! | 16 | 8 | `TIME` | time of this cycle in nanoseconds |
//! | 24 | 8 | `SINCE_LAST` | time since the last scan in nanoseconds |
//! | 32 | 8 | `STARTS` | number of PLC starts by the NC; run OB100 if it differs from the last scan |
//! | 40 | 8 | `TAKEN` | the newest answer that the NC has processed; this image includes its changes |
//! | 64 | `IMAGE_BYTES` | `IMAGE` | the image |
//! | `NC_SLOT_BYTES` - 8 | 8 | `CHECKSUM` | CRC-32 (as in zlib) of all bytes before it in the slot |
//!
//! A slot of the PLC: one answer.
//!
//! | byte | bytes | field | meaning |
//! |---|---|---|---|
//! | 0 | 8 | `NUMBER` | the number of the answer; 0 while it is being written |
//! | 8 | 8 | `ANSWERS` | the step that it answers |
//! | 16 | 8 | `CHANGES` | 0: the two images follow; otherwise the number of changed bytes plus one, and their list follows |
//! | 24 | 8 | `PROCESS` | process number of the PLC, by which the NC notices that two answer; 0: unknown |
//! | 64 | `IMAGE_BYTES` | `BEFORE` | the image of that step, unchanged |
//! | 64 + `IMAGE_BYTES` | `IMAGE_BYTES` | `AFTER` | the image after the scan |
//! | `PLC_SLOT_BYTES` - 8 | 8 | `CHECKSUM` | as in the NC slots; or 0 for no checksum, for a PLC that stores with barriers |
//!
//! A list of changes begins at byte 64 in place of the images, which it makes unnecessary: for each changed byte four bytes with its offset
//! in the image (least significant first), the byte before, the byte after, and two bytes 0. The list needs barriers or x86-64: its
//! `CHECKSUM` is 0.

mod fields;
mod layout;
mod nc;
mod plc;
mod words;

#[cfg(test)]
mod tests;

pub use fields::{MAGIC, SLOTS, VERSION, answer, header, section, step};
pub use layout::{Section, Source};
pub use nc::{Look, MappedImage, Refusal, Rules, State, Step};
pub use plc::PlcImage;
