//! The parts by writer, as structures of a control or as plain bytes.

use std::fmt::Debug;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::Interface;

/// The types of the parts in a PLC program: [`Sinumerik`](super::Sinumerik) has structures with accessors, another control has its own
/// structures, and [`AsBytes`] fits every control.
pub trait Layout: Debug + 'static {
    /// The signals that the PLC writes.
    type ToNck: View + ?Sized;
    /// The signals that the NCK writes.
    type FromNck: View + ?Sized;
    /// The signals that the HMI writes.
    type Hmi: View + ?Sized;

    /// Whether an interface has this layout.
    fn is_of(interface: &Interface) -> bool;
}

/// A structure over bytes. It has no padding, and any bytes are a valid value.
pub trait View: FromBytes + IntoBytes + KnownLayout + Immutable + Debug {
    /// The bytes as the structure; `None` if their number is wrong.
    #[must_use]
    fn of_bytes(bytes: &[u8]) -> Option<&Self> {
        Self::ref_from_bytes(bytes).ok()
    }

    /// The bytes as the mutable structure; `None` if their number is wrong.
    fn of_bytes_mut(bytes: &mut [u8]) -> Option<&mut Self> {
        Self::mut_from_bytes(bytes).ok()
    }
}

impl<T: FromBytes + IntoBytes + KnownLayout + Immutable + Debug + ?Sized> View for T {}

/// The parts as plain bytes.
#[derive(Clone, Copy, Debug)]
pub struct AsBytes;

impl Layout for AsBytes {
    type ToNck = [u8];
    type FromNck = [u8];
    type Hmi = [u8];

    fn is_of(_: &Interface) -> bool {
        true
    }
}
