//! Write protection and password protection of the S7 server: the options `--protect`, `--password` and `--protection-level` of `opennck
//! serve`.

use crate::image::{Address, Area, Width};
use crate::machine::Machine;
use crate::s7::{Directory, Protected, Protection};
use crate::source::Problem;

const CURE: &str =
    "protect whole bytes: DB21, DB21..30, DB1000.DBB0..99, DB1000.DBW4, MB0..99, IB0, T0..9, M, I, Q, T, C or nck";

/// Parses a protected range: one or more data blocks, an area, bytes of either, or the NC variables.
///
/// # Errors
/// The text is not such an address, or the machine does not have it: a misspelt address would protect nothing.
pub fn protected(text: &str, machine: &Machine) -> Result<Protected, Problem> {
    let wrong = |what: &str| Problem::new(format!("--protect {text}: {what}"), CURE);
    let (first, last) = text.split_once("..").map_or((text, None), |(first, last)| (first, Some(last)));
    let whole = match first {
        "nck" => Some(Protected::NcVariables),
        "I" => Some(all(Area::Inputs)),
        "Q" => Some(all(Area::Outputs)),
        "M" => Some(all(Area::Flags)),
        "T" => Some(all(Area::Timers)),
        "C" => Some(all(Area::Counters)),
        _ => None,
    };
    if let Some(whole) = whole {
        return if last.is_none() {
            Ok(whole)
        } else {
            Err(wrong("expected a range of bytes, found a range of areas"))
        };
    }
    if let Some(number) = first.strip_prefix("DB").and_then(|number| number.parse::<u16>().ok()) {
        let last = last.map(|last| last.strip_prefix("DB").unwrap_or(last).parse());
        let last = last.unwrap_or(Ok(number)).map_err(|_| wrong("expected the number of the last block after .."))?;
        let directory = Directory::of(machine.memory(), machine.names().profile);
        if !(number..=last).any(|number| directory.has(number)) {
            return Err(wrong("expected a data block of this machine, found an unknown number"));
        }
        return Ok(Protected::Blocks(number..=last));
    }
    let address: Address =
        first.parse().map_err(|problem: Problem| wrong(&format!("expected an address, {}", problem.what)))?;
    let (length, is_range) = match address.width {
        Width::Bit(_) | Width::Bits { .. } => return Err(wrong("expected whole bytes, found bits")),
        Width::Byte => (1, true),
        Width::Word => (2, matches!(address.area, Area::Timers | Area::Counters)),
        Width::Double => (4, false),
    };
    let last = match last {
        None => address.byte,
        Some(last) if is_range => match last.parse() {
            Ok(last) if last >= address.byte => last,
            _ => return Err(wrong("expected the number of the last byte after .., found other text")),
        },
        Some(_) => return Err(wrong("expected a range to begin with a byte, found a word")),
    };
    let scale = if matches!(address.area, Area::Timers | Area::Counters) { 2 } else { 1 };
    let bytes = u32::from(address.byte) * scale..=u32::from(last) * scale + length - 1;
    for byte in [*bytes.start(), *bytes.end()] {
        machine
            .memory()
            .read_bytes(address.area, byte, &mut [0], machine.names().profile)
            .map_err(|problem| Problem::new(format!("--protect {text}: {}", problem.what), problem.cure))?;
    }
    Ok(Protected::Bytes { area: address.area, bytes })
}

fn all(area: Area) -> Protected {
    Protected::Bytes { area, bytes: 0..=u32::MAX }
}

/// The functions that need the password. Without a level, a password protects stop, restart and setting the clock.
///
/// # Errors
/// A level without a password, or a password that modules do not accept: 1 to 8 ASCII characters are allowed.
pub fn protection(password: Option<&str>, level: Option<u8>) -> Result<Protection, Problem> {
    let Some(text) = password else {
        return match level {
            None | Some(1) => Ok(Protection { level: 1, password: None }),
            Some(level) => Err(Problem::new(
                format!("--protection-level {level}: expected a password, found none"),
                "set OPENNCK_S7_PASSWORD or give --password; without a password the protection could not be removed",
            )),
        };
    };
    let bytes = text.as_bytes();
    if !(1..=8).contains(&bytes.len()) || !bytes.iter().all(|byte| (b' '..=b'~').contains(byte)) {
        // The message does not repeat the password.
        return Err(Problem::new(
            format!("--password: expected 1 to 8 characters of ASCII, found {}", text.chars().count()),
            "choose a shorter one; modules accept letters, digits and common punctuation marks",
        ));
    }
    let mut password = [b' '; 8];
    password[..bytes.len()].copy_from_slice(bytes);
    Ok(Protection { level: level.unwrap_or(2), password: Some(password) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_and_ranges_of_whole_bytes_are_protected() {
        let machine = Machine::open("g1_example").unwrap();
        let read = |text| protected(text, &machine);
        let bytes = |area, bytes| Ok(Protected::Bytes { area, bytes });
        assert_eq!(read("DB21"), Ok(Protected::Blocks(21..=21)));
        assert_eq!(read("DB21..30"), Ok(Protected::Blocks(21..=30)));
        assert_eq!(read("DB21..DB30"), Ok(Protected::Blocks(21..=30)));
        assert_eq!(read("DB31.DBB0..29"), bytes(Area::DataBlock(31), 0..=29));
        assert_eq!(read("DB31.DBD78"), bytes(Area::DataBlock(31), 78..=81));
        assert_eq!(read("MB0..99"), bytes(Area::Flags, 0..=99));
        assert_eq!(read("IW2"), bytes(Area::Inputs, 2..=3));
        assert_eq!(read("M"), bytes(Area::Flags, 0..=u32::MAX));
        assert_eq!(read("nck"), Ok(Protected::NcVariables));
        for (wrong, said) in [
            ("DB99", "expected a data block of this machine"),
            ("DB30..21", "expected a data block of this machine"),
            ("DB31.DBX4.7", "found bits"),
            ("M10.3", "found bits"),
            ("DB31.DBB0..400", "148 bytes"),
            ("DB31.DBB9..4", "last byte"),
            ("DB31.DBW4..9", "begin with a byte"),
            ("M..9", "range of areas"),
            ("everything", "expected an address"),
        ] {
            let problem = read(wrong).unwrap_err().to_string();
            assert!(problem.contains(said) && problem.contains(wrong), "{wrong}: {problem}");
        }
    }

    #[test]
    fn a_password_has_up_to_eight_characters_and_is_never_repeated() {
        assert_eq!(protection(None, None), Ok(Protection { level: 1, password: None }));
        assert_eq!(protection(Some("secret"), None), Ok(Protection { level: 2, password: Some(*b"secret  ") }));
        assert_eq!(protection(Some("12345678"), Some(3)), Ok(Protection { level: 3, password: Some(*b"12345678") }));
        assert!(protection(None, Some(3)).unwrap_err().to_string().contains("OPENNCK_S7_PASSWORD"));
        for wrong in ["", "123456789", "geheimnü"] {
            let problem = protection(Some(wrong), None).unwrap_err().to_string();
            assert!(problem.contains("1 to 8 characters") && (wrong.is_empty() || !problem.contains(wrong)));
        }
    }
}
