//! The table of a run of interface bytes, with one row per signal in address order. From each row, the macro generates getter, setter,
//! documentation with the address and the entry of the catalogue. At compile time it checks that the rows ascend, do not overlap and are
//! inside the run.
//!
//! The head of a run names the structure, the module of its constants, the kind of block, the writer and the bytes:
//! `pub struct AxisToNck, axis_to_nck: Axis, Plc, 0 to 29;`. The module contains one [`Signal`] per row, with the name of its getter:
//! `axis_to_nck::controller_enable.byte` is 2, also in constants.
//!
//! A name that is no identifier stands behind the getter: `bool, gantry_on_enable as "gantry_on.enable_w", set_gantry_on_enable: 0, 4;`.
//!
//! A bit row has the form `bool, getter, setter: byte, bit;`, a group of bits has the form `u8, getter, setter: byte, high to low;`. A
//! number of several bytes is never a bit row: it is in the block `numbers` at the end of the run, and is read and written big-endian (most
//! significant byte first) as in STEP 7.

use super::{Block, Kind, Signal, Writer};

/// Generates the bytes of one run, with accessors, constants and its part of the catalogue. A crate that uses it must also depend on
/// `bitfield` and `zerocopy`.
#[macro_export]
macro_rules! signals {
    (
        $(#[doc = $about:literal])+
        pub struct $name:ident, $constants:ident: $block:ident, $writer:ident, $first:literal to $last:literal;
        $(
            $(#[doc = $doc:literal])+
            $kind:ident, $get:ident $(as $shown:literal)?, $set:ident: $byte:literal, $high:literal $(to $low:literal)?;
        )*
        $(numbers {$(
            $(#[doc = $number_doc:literal])+
            $number:ident, $number_get:ident $(as $number_shown:literal)?, $number_set:ident: $number_byte:literal;
        )*})?
    ) => {
        bitfield::bitfield! {
            $(#[doc = $about])+
            #[derive(
                Clone, Copy, PartialEq, Eq,
                zerocopy::FromBytes, zerocopy::IntoBytes, zerocopy::Immutable, zerocopy::KnownLayout,
                zerocopy::Unaligned,
            )]
            #[repr(transparent)]
            pub struct $name([u8; $last - $first + 1]);
            no default BitRange;
            impl Debug;
            $(
                $(#[doc = $doc])+
                #[doc = concat!("\n\nByte ", $byte, ", bit ", $high $(, " to ", $low)?, ".")]
                #[inline]
                pub $kind, $get, $set:
                    ($byte - $first) * 8 + $high $(, ($byte - $first) * 8 + $low)?;
            )*
        }

        $(impl $name {$(
            $(#[doc = $number_doc])+
            #[doc = concat!("\n\nFrom byte ", $number_byte, ", big-endian.")]
            #[must_use]
            pub fn $number_get(&self) -> $number {
                let mut bytes = [0; size_of::<$number>()];
                bytes.copy_from_slice(&self.0[$number_byte - $first..][..size_of::<$number>()]);
                $number::from_be_bytes(bytes)
            }

            $(#[doc = $number_doc])+
            #[doc = concat!("\n\nFrom byte ", $number_byte, ", big-endian.")]
            pub fn $number_set(&mut self, value: $number) {
                self.0[$number_byte - $first..][..size_of::<$number>()].copy_from_slice(&value.to_be_bytes());
            }
        )*})?

        impl $name {
            /// The first byte of the run in its data block.
            pub const FIRST: u16 = $first;
            /// The last byte of the run in its data block.
            pub const LAST: u16 = $last;
            /// The signals of the run: bits in address order, then numbers in address order.
            pub const SIGNALS: &'static [$crate::image::Signal] =
                &[$($constants::$get,)* $($($constants::$number_get,)*)?];
        }

        #[doc = concat!("The signals of [`", stringify!($name), "`] as constants, by the name of their getter.")]
        #[allow(non_upper_case_globals, reason = "a constant has the name of its getter")]
        pub mod $constants {
            use $crate::image::{Block, Signal, Writer};
            $(
                $(#[doc = $doc])+
                #[doc = concat!("\n\nByte ", $byte, ", bit ", $high $(, " to ", $low)?, ".")]
                pub const $get: Signal = $crate::image::table::bits(
                    $crate::image::table::name(stringify!($get), &[$($shown)?]), Block::$block, Writer::$writer, stringify!($kind), $byte, &[$high $(, $low)?],
                    concat!($($doc),+),
                );
            )*
            $($(
                $(#[doc = $number_doc])+
                #[doc = concat!("\n\nFrom byte ", $number_byte, ", big-endian.")]
                pub const $number_get: Signal = $crate::image::table::number(
                    $crate::image::table::name(stringify!($number_get), &[$($number_shown)?]), Block::$block, Writer::$writer, stringify!($number), $number_byte,
                    concat!($($number_doc),+),
                );
            )*)?
        }

        impl Default for $name {
            fn default() -> Self {
                Self([0; $last - $first + 1])
            }
        }

        const _: () = $crate::image::table::check($name::SIGNALS, $first, $last);

        impl bitfield::BitRange<u8> for $name {
            #[inline]
            fn bit_range(&self, high: usize, low: usize) -> u8 {
                (self.0[low / 8] >> (low % 8)) & (0xFF >> (7 - (high - low)))
            }
        }

        impl bitfield::BitRangeMut<u8> for $name {
            #[inline]
            fn set_bit_range(&mut self, high: usize, low: usize, value: u8) {
                let mask = (0xFF >> (7 - (high - low))) << (low % 8);
                let byte = &mut self.0[low / 8];
                *byte = *byte & !mask | (value << (low % 8)) & mask;
            }
        }
    };
}

/// The tables of this module: like [`signals!`](crate::signals), with accessors for tests.
macro_rules! tested_signals {
    ($($rows:tt)*) => {
        $crate::signals! { $($rows)* }
        #[cfg(test)]
        $crate::image::table::accessors! { $($rows)* }
    };
}
pub(super) use tested_signals as signals;

/// The rows of a run, as tests call them.
#[cfg(test)]
macro_rules! accessors {
    (
        $(#[doc = $about:literal])+
        pub struct $name:ident, $constants:ident: $block:ident, $writer:ident, $first:literal to $last:literal;
        $(
            $(#[doc = $doc:literal])+
            $kind:ident, $get:ident $(as $shown:literal)?, $set:ident: $byte:literal, $high:literal $(to $low:literal)?;
        )*
        $(numbers {$(
            $(#[doc = $number_doc:literal])+
            $number:ident, $number_get:ident $(as $number_shown:literal)?, $number_set:ident: $number_byte:literal;
        )*})?
    ) => {
        impl $crate::image::table::Accessors for $name {
            #[rustfmt::skip]
            fn accessors() -> Vec<$crate::image::table::Accessor<Self>> {
                use $crate::image::table::Raw;
                vec![
                    $((stringify!($get), |run| run.$get().raw(), |run, raw| run.$set(Raw::of(raw))),)*
                    $($((
                        stringify!($number_get),
                        |run| run.$number_get().raw(),
                        |run, raw| run.$number_set(Raw::of(raw)),
                    ),)*)?
                ]
            }
        }
    };
}
#[cfg(test)]
pub(super) use accessors;

/// The name of a signal: that of its getter, or the one that its row gives.
#[doc(hidden)]
#[must_use]
pub const fn name(getter: &'static str, shown: &[&'static str]) -> &'static str {
    if let [shown] = shown { shown } else { getter }
}

/// The catalogue entry of a bit row.
#[doc(hidden)]
#[must_use]
pub const fn bits(
    name: &'static str,
    block: Block,
    writer: Writer,
    kind: &str,
    byte: u16,
    span: &[u8],
    doc: &'static str,
) -> Signal {
    let is_bit = matches!(kind.as_bytes(), b"bool");
    require(is_bit == (span.len() == 1), name, "a `bool` row names one bit, a `u8` row names two: high to low");
    let (bit, kind) = if is_bit {
        (span[0], Kind::Bit)
    } else {
        require(span[0] > span[1], name, "write a group high to low");
        let width = span[0] - span[1] + 1;
        (span[1], if width == 8 { Kind::Byte } else { Kind::Bits(width) })
    };
    Signal { name, block, byte, bit, kind, writer, doc: doc.trim_ascii() }
}

/// The catalogue entry of a number row.
#[doc(hidden)]
#[must_use]
pub const fn number(
    name: &'static str,
    block: Block,
    writer: Writer,
    kind: &str,
    byte: u16,
    doc: &'static str,
) -> Signal {
    let kind = match kind.as_bytes() {
        b"f32" => Kind::Real,
        b"u16" => Kind::Word,
        b"u32" => Kind::Double,
        _ => {
            require(false, name, "a number must be a u16, a u32 or an f32");
            Kind::Double
        }
    };
    Signal { name, block, byte, bit: 0, kind, writer, doc: doc.trim_ascii() }
}

/// Checks at compile time that rows ascend, neighbours do not overlap, all rows are inside the run, and no number overlaps another row.
#[doc(hidden)]
pub const fn check(rows: &[Signal], first: u16, last: u16) {
    let mut index = 0;
    while index < rows.len() {
        let row = &rows[index];
        let from = row.byte as u32 * 8 + row.bit as u32;
        let end = from + row.kind.width() as u32;
        require(row.byte >= first && end <= (last as u32 + 1) * 8, row.name, "the signal is outside its run");
        let fits = row.bit as u32 + row.kind.width() as u32 <= 8 || row.bit == 0;
        require(fits, row.name, "the signal exceeds its byte");
        if index + 1 < rows.len() && rows[index + 1].kind.is_number() == row.kind.is_number() {
            let next = &rows[index + 1];
            let ascends = end <= next.byte as u32 * 8 + next.bit as u32;
            require(ascends, next.name, "the signal must be above the previous row and must not overlap it");
        }
        if row.kind.is_number() {
            let mut other = 0;
            while other < rows.len() {
                let start = rows[other].byte as u32 * 8 + rows[other].bit as u32;
                let stop = start + rows[other].kind.width() as u32;
                require(other == index || stop <= from || end <= start, row.name, "the number overlaps a signal");
                other += 1;
            }
        }
        index += 1;
    }
}

/// The length of the longest message of [`require`].
const MESSAGE: usize = 160;

/// Stops the build with the name of a row and what it requires. A constant cannot format, so the message is copied.
const fn require(holds: bool, row: &str, what: &str) {
    if holds {
        return;
    }
    let parts = [row.as_bytes(), b": ", what.as_bytes()];
    let mut message = [b' '; MESSAGE];
    let (mut length, mut part) = (0, 0);
    while part < parts.len() {
        let mut index = 0;
        while index < parts[part].len() && length < MESSAGE {
            message[length] = parts[part][index];
            (index, length) = (index + 1, length + 1);
        }
        part += 1;
    }
    match str::from_utf8(&message) {
        Ok(message) => panic!("{}", message.trim_ascii()),
        Err(_) => panic!("a row of a table of signals is wrong"),
    }
}

/// One row, as tests call it: name, getter, setter.
#[cfg(test)]
pub(super) type Accessor<T> = (&'static str, fn(&T) -> u64, fn(&mut T, u64));

/// The rows of a run, as tests call them.
#[cfg(test)]
pub(super) trait Accessors: Sized {
    fn accessors() -> Vec<Accessor<Self>>;
}

/// The value of a row as raw bits.
#[cfg(test)]
pub(super) trait Raw {
    fn raw(self) -> u64;
    fn of(raw: u64) -> Self;
}

#[cfg(test)]
impl Raw for bool {
    fn raw(self) -> u64 {
        self.into()
    }
    fn of(raw: u64) -> Self {
        raw != 0
    }
}

#[cfg(test)]
impl Raw for f32 {
    fn raw(self) -> u64 {
        self.to_bits().into()
    }
    fn of(raw: u64) -> Self {
        Self::from_bits(raw.try_into().unwrap())
    }
}

#[cfg(test)]
impl Raw for u8 {
    fn raw(self) -> u64 {
        self.into()
    }
    fn of(raw: u64) -> Self {
        raw.try_into().unwrap()
    }
}

#[cfg(test)]
impl Raw for u32 {
    fn raw(self) -> u64 {
        self.into()
    }
    fn of(raw: u64) -> Self {
        raw.try_into().unwrap()
    }
}

#[cfg(test)]
impl Raw for u16 {
    fn raw(self) -> u64 {
        self.into()
    }
    fn of(raw: u64) -> Self {
        raw.try_into().unwrap()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn bit(name: &'static str, bit: u8) -> Signal {
        bits(name, Block::Nck, Writer::Plc, "bool", 2, &[bit], "")
    }

    #[test]
    #[should_panic(expected = "release: the signal must be above the previous row and must not overlap it")]
    fn a_row_out_of_order_is_rejected_with_its_name() {
        check(&[bit("power", 4), bit("release", 3)], 0, 2);
    }

    #[test]
    #[should_panic(expected = "power: the signal is outside its run")]
    fn a_row_outside_its_run_is_rejected_with_its_name() {
        check(&[bit("power", 4)], 0, 1);
    }
}
