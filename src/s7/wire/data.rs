//! Data items: return code, transport size, length and value. An item of odd length is followed by a fill byte, unless it is the last.

/// The type of an element of an item.
///
/// | type | code | bytes | answered as | length counts |
/// |---|---|---|---|---|
/// | BOOL | `01` | 1, the bit in bit 0 | `03` | bits |
/// | BYTE, CHAR, WORD, DWORD | `02` `03` `04` `06` | 1, 1, 2, 4 | `04` | bits |
/// | INT, DINT | `05` `07` | 2, 4 | `05` | bits |
/// | REAL | `08` | 4 | `07` | bytes |
/// | DATE, TIME_OF_DAY, TIME, S5TIME, DATE_AND_TIME | `09` `0A` `0B` `0C` `0F` | 2, 4, 4, 2, 8 | `04` | bits |
/// | COUNTER, TIMER | `1C` `1D` | 2 | `09` | bytes |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Type {
    /// One bit.
    Bit,
    /// One byte.
    Byte,
    /// One character.
    Char,
    /// Two bytes.
    Word,
    /// A signed two-byte integer.
    Int,
    /// Four bytes.
    DoubleWord,
    /// A signed four-byte integer.
    DoubleInt,
    /// A four-byte floating-point number.
    Real,
    /// Days since 1990.
    Date,
    /// Milliseconds since midnight.
    TimeOfDay,
    /// Milliseconds.
    Time,
    /// Time of a SIMATIC timer.
    S5Time,
    /// Date and time in BCD.
    DateAndTime,
    /// A counter.
    Counter,
    /// A timer.
    Timer,
}

impl Type {
    /// The type of a code.
    #[must_use]
    pub const fn of(code: u8) -> Option<Self> {
        Some(match code {
            0x01 => Self::Bit,
            0x02 => Self::Byte,
            0x03 => Self::Char,
            0x04 => Self::Word,
            0x05 => Self::Int,
            0x06 => Self::DoubleWord,
            0x07 => Self::DoubleInt,
            0x08 => Self::Real,
            0x09 => Self::Date,
            0x0A => Self::TimeOfDay,
            0x0B => Self::Time,
            0x0C => Self::S5Time,
            0x0F => Self::DateAndTime,
            0x1C => Self::Counter,
            0x1D => Self::Timer,
            _ => return None,
        })
    }

    /// Bytes of one element.
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Bit | Self::Byte | Self::Char => 1,
            Self::Word | Self::Int | Self::Date | Self::S5Time | Self::Counter | Self::Timer => 2,
            Self::DoubleWord | Self::DoubleInt | Self::Real | Self::TimeOfDay | Self::Time => 4,
            Self::DateAndTime => 8,
        }
    }

    /// The transport size of its answer.
    #[must_use]
    pub const fn answered_as(self) -> TransportSize {
        match self {
            Self::Bit => TransportSize::BIT,
            Self::Int | Self::DoubleInt => TransportSize::INTEGER,
            Self::Real => TransportSize::REAL,
            Self::Counter | Self::Timer => TransportSize::OCTETS,
            Self::Byte
            | Self::Char
            | Self::Word
            | Self::DoubleWord
            | Self::Date
            | Self::TimeOfDay
            | Self::Time
            | Self::S5Time
            | Self::DateAndTime => TransportSize::BYTES,
        }
    }
}

/// The unit in which the length of a value is counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TransportSize(pub u8);

impl TransportSize {
    /// No value.
    pub const NULL: Self = Self(0);
    /// One bit.
    pub const BIT: Self = Self(3);
    /// Bytes and words, length in bits.
    pub const BYTES: Self = Self(4);
    /// Integers, length in bits.
    pub const INTEGER: Self = Self(5);
    /// Floating-point numbers, length in bytes.
    pub const REAL: Self = Self(7);
    /// Octet string, length in bytes.
    pub const OCTETS: Self = Self(9);

    /// The bytes of a length field.
    #[must_use]
    pub fn bytes(self, length: u16) -> usize {
        match self.0 {
            3..=5 => usize::from(length).div_ceil(8),
            _ => usize::from(length),
        }
    }

    /// The length field for this many bytes.
    #[must_use]
    pub fn field(self, bytes: usize) -> u16 {
        let length = match self {
            Self::BIT => bytes,
            Self(4 | 5) => bytes * 8,
            _ => bytes,
        };
        u16::try_from(length).unwrap_or(u16::MAX)
    }
}

/// Success.
pub const SUCCESS: u8 = 0xFF;

/// The reason why an item is refused; other items are not affected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// `03`: access to the object is not allowed, for example it is read-only.
    NotAllowed,
    /// `05`: the address is out of range.
    OutOfRange,
    /// `06`: the data type is not supported.
    TypeNotSupported,
    /// `07`: the data type or the length of the value does not match.
    TypeInconsistent,
    /// `0A`: the object does not exist: no such block, no such variable.
    DoesNotExist,
}

impl Refusal {
    /// Its return code.
    #[must_use]
    pub const fn code(self) -> u8 {
        match self {
            Self::NotAllowed => 0x03,
            Self::OutOfRange => 0x05,
            Self::TypeNotSupported => 0x06,
            Self::TypeInconsistent => 0x07,
            Self::DoesNotExist => 0x0A,
        }
    }
}

/// The values of a write request, one per item.
#[derive(Clone, Copy, Debug)]
pub struct Values<'a> {
    rest: &'a [u8],
    left: usize,
    filled: bool,
}

impl<'a> Values<'a> {
    /// `count` values, which must end with the data part. Some clients omit the fill bytes; this is accepted if the lengths match only
    /// without them.
    #[must_use]
    pub fn new(data: &'a [u8], count: usize) -> Option<Self> {
        let fits = |filled| {
            let mut values = Self { rest: data, left: count, filled };
            let mut last = 0;
            while values.left > 0 {
                last = values.next_value()?.1.len();
            }
            let end = values.rest.len();
            (end == 0 || end == 1 && last % 2 == 1).then_some(Self { rest: data, left: count, filled })
        };
        fits(true).or_else(|| fits(false))
    }

    fn next_value(&mut self) -> Option<(TransportSize, &'a [u8])> {
        let [_, size, high, low, rest @ ..] = self.rest else {
            return None;
        };
        let size = TransportSize(*size);
        let (value, rest) = rest.split_at_checked(size.bytes(u16::from_be_bytes([*high, *low])))?;
        self.left = self.left.checked_sub(1)?;
        let fill = self.filled && value.len() % 2 == 1 && self.left > 0;
        self.rest = if fill { rest.get(1..)? } else { rest };
        Some((size, value))
    }
}

impl<'a> Iterator for Values<'a> {
    type Item = (TransportSize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        if self.left == 0 { None } else { self.next_value() }
    }
}
