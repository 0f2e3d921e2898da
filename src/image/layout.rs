//! The parts by writer as structures of a control, or as the bytes that they are.

use std::fmt::Debug;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::Interface;

/// How a PLC program sees the parts: [`Sinumerik`](super::Sinumerik) gives them as structures with accessors, another
/// control its own, [`AsBytes`] fits every control.
pub trait Layout: Debug + 'static {
    /// What the PLC writes.
    type ToNck: View + ?Sized;
    /// What the NCK writes.
    type FromNck: View + ?Sized;
    /// What the HMI writes.
    type Hmi: View + ?Sized;

    /// Whether an interface is laid out so.
    fn is_of(interface: &Interface) -> bool;
}

/// A structure over bytes: without padding, and any bytes are one.
pub trait View: FromBytes + IntoBytes + KnownLayout + Immutable + Debug {
    /// These bytes as the structure; `None` if they are too few or too many.
    #[must_use]
    fn of_bytes(bytes: &[u8]) -> Option<&Self> {
        Self::ref_from_bytes(bytes).ok()
    }

    /// These bytes as the structure, to be written.
    fn of_bytes_mut(bytes: &mut [u8]) -> Option<&mut Self> {
        Self::mut_from_bytes(bytes).ok()
    }
}

impl<T: FromBytes + IntoBytes + KnownLayout + Immutable + Debug + ?Sized> View for T {}

/// The parts as bytes.
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
