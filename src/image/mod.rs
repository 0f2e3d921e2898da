//! The interface: the bytes that NCK, PLC and HMI exchange, and all ways to name them.
//!
//! **The memory is organized by writer.** The PLC writes [`ToNck`], the NCK writes [`FromNck`], the operator panel writes [`Hmi`]. Each of
//! them is one contiguous piece of bytes. A data block as STEP 7 sees it (DB31, bytes 0 to 147) is a table of ranges over these three
//! pieces. So the borrow checker enforces the direction: a PLC program has `&mut ToNck` and `&FromNck` and cannot write a bit of the NCK.
//!
//! ```
//! use opennck::image::{FromNck, ToNck};
//! use opennck::units::AxisNumber;
//!
//! let (mut to_nck, mut from_nck) = (ToNck::default(), FromNck::default());
//! let x = AxisNumber::FIRST;
//! from_nck.axes[x].set_gantry_synchronization_ready_to_start(true); // DB31.DBX101.4, written by the NCK
//! to_nck.axis(x).set_start_gantry_synchronization(from_nck.axis(x).gantry_synchronization_ready_to_start());
//! assert!(to_nck.axes[x].start_gantry_synchronization()); // DB31.DBX29.4
//! ```
//!
//! **The interface is data.** An [`Interface`] defines the kinds of block of a control (the control as a whole, mode groups, channels,
//! axes), the number of blocks of each kind, the owner of every byte, the signals, the names of the blocks, and their data block numbers
//! for the PLC. [`Memory`], [`Names`], [`Preset`], [`Profile`] and the mapped image use it and are independent of the control. This crate
//! contains one interface, [`SINUMERIK`]: `sinumerik/` has its tables and the structures [`ToNck`], [`FromNck`] and [`Hmi`] over its bytes.
//! Another control provides its own static with its own [`signals!`](crate::signals) tables and, for PLC programs, its own structures
//! ([`Layout`]).
//!
//! A signal is a row of a `signals!` table ([`Signal`]). The row defines accessor, documentation, symbol and address. It is also a constant
//! with the name of its getter, for code that needs a bit as data: [`axis_to_nck::controller_enable`] is DBX2.1 of an axis. An [`Address`]
//! is the STEP 7 notation, a [`Location`] is the position in memory, and [`Names`] are the names of this machine. The 828D
//! ([`Profile::SINUMERIK_828D`]) is the same memory under other data block numbers, not a second model. Bytes without signals are plain
//! memory that every program can use.

mod address;
mod bytes;
mod interface;
mod layout;
mod location;
#[cfg(feature = "mapped")]
pub mod mapped;
mod memory;
mod names;
mod numbering;
mod override_switch;
mod places;
mod preset;
mod profile;
mod signal;
mod sinumerik;
#[doc(hidden)]
pub mod table;
mod value;
mod values;

#[cfg(test)]
mod tests;

pub use address::{Address, Area, Width};
pub use bytes::{Bytes, PartBytes};
pub use interface::{BlockTable, ByteRange, ByteSignals, Interface, Override, SwitchSignals, Tables};
pub use layout::{AsBytes, Layout, View};
pub use location::{Format, Location, Part};
pub use memory::{Blocks, DataBlock, Memory, Parts};
pub use names::Names;
pub use numbering::{Numbering, Window};
pub use override_switch::{OverrideCoding, override_code};
pub use preset::Preset;
pub use profile::Profile;
pub use signal::{Block, Kind, Signal, UnitElements, Writer};
pub use sinumerik::{
    ACKNOWLEDGE_USER_ALARMS, Axis828d, AxisFromNck, AxisToNck, ChannelAuxiliary, ChannelAuxiliary828d, ChannelFromNck,
    ChannelHmi, ChannelJumpToNck, ChannelProgramToNck, ChannelSearchFromNck, ChannelToNck, FromNck, Hmi,
    ModeGroupFromNck, ModeGroupHmi, ModeGroupToNck, NckFromNck, NckHmi, NckToNck, Plain, SINUMERIK, Sinumerik, ToNck,
    USER_ALARMS, UserAlarmsToNck, UserFromNck, axis_828d, axis_from_nck, axis_to_nck, channel_auxiliary,
    channel_auxiliary_828d, channel_from_nck, channel_hmi, channel_jump_to_nck, channel_program_to_nck,
    channel_search_from_nck, channel_to_nck, mode_group_from_nck, mode_group_hmi, mode_group_to_nck, nck_from_nck,
    nck_hmi, nck_to_nck, user_alarm,
};
pub use value::{is_no_code, raw_value, signal_value};
pub use values::ValueTerms;
