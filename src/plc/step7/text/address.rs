//! Absolute addresses in both languages: `M 20.0`, `EW 4`, `PIW 256`, `DB 10`, `T 5`. Operands and symbol tables have them.

use crate::plc::step7::instruction::{BlockKind, BlockName, Space, Width};

/// The area and the width of a word such as `MW`, `E`, `DBX`, `PAW`.
pub(in crate::plc::step7) fn area(word: &str) -> Option<(Space, Width)> {
    let word = word.to_ascii_uppercase();
    let width = |rest: &str| {
        Some(match rest {
            "" => Width::Bit,
            "B" => Width::Byte,
            "W" => Width::Word,
            "D" => Width::Double,
            _ => return None,
        })
    };
    let data = |rest: &str| width(if rest == "X" { "" } else { rest }).filter(|_| !rest.is_empty());
    if let Some(rest) = word.strip_prefix("DB") {
        return Some((Space::Data, data(rest)?));
    }
    if let Some(rest) = word.strip_prefix("DI") {
        return Some((Space::Instance, data(rest)?));
    }
    if let Some(rest) = word.strip_prefix('P') {
        let rest = rest.strip_prefix(['I', 'E', 'Q', 'A'])?;
        return Some((Space::Peripheral, width(rest).filter(|&width| width != Width::Bit)?));
    }
    let (first, rest) = word.split_at_checked(1)?;
    let space = match first {
        "I" | "E" => Space::Inputs,
        "Q" | "A" => Space::Outputs,
        "M" => Space::Flags,
        "L" => Space::Local,
        _ => return None,
    };
    Some((space, width(rest)?))
}

/// Letters and the digits after them: `DB10`, `MW10`.
pub(in crate::plc::step7) fn split(word: &str) -> Option<(&str, &str)> {
    let start = word.find(|letter: char| letter.is_ascii_digit())?;
    let (letters, digits) = word.split_at_checked(start)?;
    (!letters.is_empty() && digits.bytes().all(|digit| digit.is_ascii_digit())).then_some((letters, digits))
}

/// The bit address of `20.0` or `20`; the error says what was expected.
pub(in crate::plc::step7) fn place(width: Width, byte: &str, bit: Option<&str>) -> Result<u32, &'static str> {
    let byte: u32 = byte.parse().ok().filter(|&byte| byte <= 65_535).ok_or("a byte from 0 to 65535")?;
    match (width, bit) {
        (Width::Bit, Some(bit)) => {
            let bit: u32 = bit.parse().ok().filter(|&bit| bit <= 7).ok_or("a bit from 0 to 7")?;
            Ok(byte * 8 + bit)
        }
        (Width::Bit, None) => Err("a bit address, as `20.0`"),
        (_, None) => Ok(byte * 8),
        (_, Some(_)) => Err("a byte address without a bit, as `20`"),
    }
}

/// The meaning of an address.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::plc::step7) enum Address {
    Memory(Space, Width, u32),
    Timer(u16),
    Counter(u16),
    Block(BlockName),
    /// Of a kind that has no code: a variable table, an SDB.
    Other,
}

/// An address as symbol tables write it: `M      20.0`, `DB     10`.
pub(in crate::plc::step7) fn parse(text: &str) -> Option<Address> {
    let text = text.trim();
    let start = text.find(|letter: char| letter.is_ascii_digit())?;
    let (word, rest) = text.split_at_checked(start)?;
    let word = word.trim().to_ascii_uppercase();
    let number = || rest.parse::<u16>().ok();
    if let Some(kind) = BlockKind::parse(&word) {
        return Some(Address::Block(BlockName { kind, number: number()? }));
    }
    match word.as_str() {
        "T" => return Some(Address::Timer(number()?)),
        "C" | "Z" => return Some(Address::Counter(number()?)),
        "VAT" | "SDB" => return number().map(|_| Address::Other),
        _ => {}
    }
    let (space, width) =
        area(&word).filter(|(space, _)| !matches!(space, Space::Data | Space::Instance | Space::Local))?;
    let (byte, bit) = rest.split_once('.').map_or((rest, None), |(byte, bit)| (byte, Some(bit)));
    Some(Address::Memory(space, width, place(width, byte, bit).ok()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_are_accepted_in_both_languages() {
        assert_eq!(area("EW"), Some((Space::Inputs, Width::Word)));
        assert_eq!(area("I"), Some((Space::Inputs, Width::Bit)));
        assert_eq!(area("PAD"), Some((Space::Peripheral, Width::Double)));
        assert_eq!(area("dbx"), Some((Space::Data, Width::Bit)));
        assert_eq!((area("DB"), area("PI"), area("T"), area("é")), (None, None, None, None));
        assert_eq!(parse("M      20.1 "), Some(Address::Memory(Space::Flags, Width::Bit, 161)));
        assert_eq!(parse("Z 5"), Some(Address::Counter(5)));
        assert_eq!(parse("VAT 1"), Some(Address::Other));
        assert_eq!((parse("M 1.8"), parse("MW 1.0"), parse("")), (None, None, None));
    }
}
