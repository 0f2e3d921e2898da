//! The interface as a file in memory, through which a PLC in another process talks to the NC (feature `mapped`).
//!
//! [`MappedImage`] is the NC's side, for whoever runs a machine; [`PlcImage`] is the PLC's, for a soft PLC in Rust. A PLC in another
//! language maps the file and keeps to the tables below; every number in them is a whole one of 64 bits, least significant byte first, at
//! a multiple of 8. The bytes of an image are as in the PLC: words most significant byte first.
//!
//! # How nobody sees half of anything
//!
//! Each side writes its own slots and its own words of the header, and nothing else. To publish number *n*: store 0 as `NUMBER` of slot
//! *n* mod `SLOTS`, write the rest of the slot, store *n* as its `NUMBER`, then store *n* as the newest. To read: load the newest *n*, copy
//! its slot, and take the copy only if its `NUMBER` is *n*, the slot's `NUMBER` still is, and the checksum fits; else begin again. The two
//! numbers are enough where stores become visible in their order, as on x86-64 and wherever both sides have barriers; the checksum is for
//! the rest (Python on ARM). A word is loaded and stored in one piece: in C as `_Atomic uint64_t`, in Python through
//! `memoryview(…).cast("Q")`.
//!
//! # How they begin
//!
//! The NC stores 0 as `STATE` and another `GENERATION`, says how everything lies, shows the memory as it was switched on in slot 1 or whichever
//! is next, and stores 2 as `STATE`. The PLC reads the header while `STATE` is not 0, sees that `GENERATION` is still the same, and adds 1
//! to `PLC_STARTS` when it is ready; so it does after each other `GENERATION`, whether its process is new or was there already. It waits
//! for 1 as `STATE`, which the NC stores after the step of its first scan. In lock-step the NC takes no step before another number stands in
//! `PLC_STARTS` than when it began: cycles count from there, and nothing depends on who came first, or when.
//!
//! # Who wins
//!
//! An answer carries the image before and after. The NC takes the bits that differ, where the section is the PLC's; so what an S7 client
//! wrote meanwhile stays unless the program changed the very same bit, as in a PLC whose program meets an HMI. After an answer the PLC waits for
//! a step whose `TAKEN` is that answer: only there are its own flags as it left them.
//!
//! # The tables
//!
//! The header. The NC says once how everything lies; then it writes the words from 256 and the PLC those from 512, nobody another's.
//!
//! | byte | bytes | field | what it is |
//! |---|---|---|---|
//! | 0 | 8 | `MAGIC` | the characters `OpenNCK` and a byte 0 |
//! | 8 | 8 | `VERSION` | 1; a file of another version lies otherwise |
//! | 16 | 8 | `GENERATION` | how many NCs have used this file: at another number, read the header again |
//! | 24 | 8 | `FILE_BYTES` | bytes of the file that are used |
//! | 32 | 8 | `PROFILE` | 840 or 828: whose data block numbers these are |
//! | 40 | 8 | `SECTIONS` | entries of the table of sections |
//! | 48 | 8 | `SECTION_TABLE` | where the table begins in the file |
//! | 56 | 8 | `SECTION_BYTES` | bytes of an entry |
//! | 64 | 8 | `IMAGE_BYTES` | bytes of an image |
//! | 72 | 8 | `SLOTS` | slots of each side: number *n* is in slot *n* mod `SLOTS` |
//! | 80 | 8 | `NC_SLOTS` | where the NC's first slot begins in the file |
//! | 88 | 8 | `NC_SLOT_BYTES` | bytes of each of them |
//! | 96 | 8 | `PLC_SLOTS` | where the PLC's first slot begins in the file |
//! | 104 | 8 | `PLC_SLOT_BYTES` | bytes of each of them |
//! | 112 | 8 | `NC_CYCLE_TIME` | interpolation cycle in nanoseconds |
//! | 120 | 8 | `LOCK_STEP` | 1: each step waits for its answer, the first one for a PLC, too; 0: the NC takes the newest answer there is |
//! | 128 | 8 | `TIME_OUT` | for how many nanoseconds the PLC may be silent |
//! | 136 | 8 | `PROCESS` | process number of the NC |
//! | 256 | 8 | `STATE` | of the NC: 0 it has ended, 1 the PLC is in RUN, 2 the PLC is in STOP, or before its first scan: nothing is taken |
//! | 264 | 8 | `NEWEST_STEP` | the NC's newest slot that is whole; 0: none yet |
//! | 272 | 8 | `REQUEST` | the step whose answer the NC waits for; 0: none |
//! | 512 | 8 | `PLC_STARTS` | the PLC adds 1 when it has read the header, and is ready |
//! | 520 | 8 | `NEWEST_ANSWER` | the PLC's newest slot that is whole; a PLC goes on from what it finds |
//! | 528 | 8 | `ACKNOWLEDGE` | the step that the newest answer answers |
//! | 536 | 8 | `POWER` | the PLC adds 1 to switch the control off and on |
//!
//! An entry of the table of sections: bytes of one data block or area that have one writer. Byte `FIRST` + *i* of it is byte `OFFSET` + *i* of an
//! image; sections of one block that follow one another without a gap do so in the image, too, so STEP 7 addresses count from one place.
//!
//! | byte | bytes | field | what it is |
//! |---|---|---|---|
//! | 0 | 8 | `KIND` | `DB`, `I`, `Q`, `M`, `T` or `C`, filled up with bytes 0; timers and counters have two bytes each |
//! | 8 | 8 | `NUMBER` | of the data block, else 0 |
//! | 16 | 8 | `FIRST` | its first byte in this section |
//! | 24 | 8 | `LENGTH` | bytes of the section |
//! | 32 | 8 | `OFFSET` | where they begin in an image |
//! | 40 | 8 | `WRITER` | 1 the PLC, 2 the NCK, 3 the HMI, 4 the machine (inputs): what the PLC changes is taken where it is 1 |
//! | 48 | 32 | `NAME` | of the axis, the channel or the own block, filled up with bytes 0 |
//!
//! A slot of the NC: one step, as the PLC sees it at the beginning of its scan. Everything is in the image, whoever writes it, also what S7
//! clients have written into flags and own blocks.
//!
//! | byte | bytes | field | what it is |
//! |---|---|---|---|
//! | 0 | 8 | `NUMBER` | the number of the step; 0 while it is being written |
//! | 8 | 8 | `CYCLE` | the cycle of the NC |
//! | 16 | 8 | `TIME` | its time in nanoseconds |
//! | 24 | 8 | `SINCE_LAST` | nanoseconds since the last scan |
//! | 32 | 8 | `STARTS` | how often the NC has started the PLC: at another number than in the last scan it is time for OB100 |
//! | 40 | 8 | `TAKEN` | the newest answer that the NC has seen: it is in this image |
//! | 64 | `IMAGE_BYTES` | `IMAGE` | the image |
//! | `NC_SLOT_BYTES` - 8 | 8 | `CHECKSUM` | CRC-32 (that of zlib) of everything before it in the slot |
//!
//! A slot of the PLC: one answer.
//!
//! | byte | bytes | field | what it is |
//! |---|---|---|---|
//! | 0 | 8 | `NUMBER` | the number of the answer; 0 while it is being written |
//! | 8 | 8 | `ANSWERS` | the step that it answers |
//! | 64 | `IMAGE_BYTES` | `BEFORE` | the image of that step as it was |
//! | 64 + `IMAGE_BYTES` | `IMAGE_BYTES` | `AFTER` | what the PLC made of it |
//! | `PLC_SLOT_BYTES` - 8 | 8 | `CHECKSUM` | as in the NC's slots; or 0: none, for a PLC that stores with barriers |

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
