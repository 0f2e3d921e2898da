//! The binary commissioning archive (`.arc`): members with headers of 512 bytes, each padded to a multiple of 512.
//!
//! The machine data are in the members `_N_INITIAL_INI` and `_N_CFG_…` of folder `\_NC_ACT.DIR\`. Drive data,
//! definitions, programs and PLC parts in the same file are listed and ignored. A truncated file or a wrong checksum is
//! reported as damage, with its offset.

use std::path::Path;

use crate::source::{Place, Problem, decode};

use super::ascii::read_text;
use super::reading::{Author, Member, Reading};

/// Length of a header; data are padded to a multiple of it.
const BLOCK: usize = 512;

/// Whether a file is a binary archive or the rest of a failed copy: an empty `.arc`, or one with bytes that do not
/// occur in text. An `.arc` of plain text is an ASCII archive.
pub(super) fn is_binary(name: &str, bytes: &[u8]) -> bool {
    let is_arc = Path::new(name).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("arc"));
    let no_text = || bytes.iter().any(|&byte| byte < b'\t');
    bytes.starts_with(b"@@MMCIBN") || is_arc && (bytes.is_empty() || no_text())
}

/// Reads an archive.
pub(super) fn read(name: &str, bytes: &[u8], reading: &mut Reading) -> Result<(), Problem> {
    let file = Place::file(name);
    let damage = |offset: usize, what: String| {
        file.problem(
            format!("{what} at offset {offset}"),
            "the archive is damaged; copy it again from the control, in binary mode",
        )
    };
    let truncated = |offset: usize, what: String| {
        file.problem(
            format!("{what} at offset {offset}: the file ends too early, at {} bytes", bytes.len()),
            "the archive is truncated; copy it again from the control, in binary mode, and compare the sizes",
        )
    };
    if bytes.is_empty() {
        return Err(file.problem(
            "expected members, found an empty file",
            "the copy is empty; copy the archive again from the control, in binary mode",
        ));
    }
    let mut offset = 0;
    while offset < bytes.len() {
        let rest = &bytes[offset..];
        let header = rest.first_chunk::<BLOCK>().ok_or_else(|| {
            truncated(offset, format!("expected a member header of {BLOCK} bytes, found {} bytes", rest.len()))
        })?;
        let expected = decimal(&header[148..156]).ok_or_else(|| {
            damage(offset + 148, "expected a checksum in decimal digits, found something else".to_owned())
        })?;
        let found = checksum(header);
        if expected != found {
            return Err(damage(offset, format!("expected the header checksum {expected}, found {found}")));
        }
        let size = decimal(&header[124..136]).and_then(|size| usize::try_from(size).ok()).ok_or_else(|| {
            damage(offset + 124, "expected a size in decimal digits, found something else".to_owned())
        })?;
        let start = offset + BLOCK;
        let member =
            size.checked_next_multiple_of(BLOCK).and_then(|padded| bytes.get(start..start.checked_add(padded)?));
        let Some(member) = member else {
            let name = text(&header[..50]);
            let found = bytes.len() - start;
            return Err(truncated(
                start,
                format!("expected {size} bytes of {name} and their padding, found {found} bytes"),
            ));
        };
        let data = &member[..size];
        let (internal, folder) = (text(&header[..50]), text(&header[384..512]));
        if is_machine_data(&internal, &folder) {
            // Messages name the file and the member; line numbers are those of the member.
            read_text(&format!("{name}({})", shown(header)), &decode(data), Author::Control, reading);
        } else if !internal.starts_with("@@") {
            reading.members.push(Member { name: format!("{folder}{}", shown(header)), assignments: None });
        }
        offset = start + member.len();
    }
    Ok(())
}

fn is_machine_data(internal: &str, folder: &str) -> bool {
    folder == r"\_NC_ACT.DIR\"
        && (internal == "_N_INITIAL_INI" || (internal.starts_with("_N_CFG_") && internal.ends_with("_INI")))
}

/// The displayed name, or the internal name if there is none.
fn shown(header: &[u8; BLOCK]) -> String {
    let name = text(&header[50..100]);
    if name.is_empty() { text(&header[..50]) } else { name }
}

/// The sum of the header's bytes, with the checksum field taken as zero.
fn checksum(header: &[u8; BLOCK]) -> u64 {
    header[..148].iter().chain(&header[156..]).map(|&byte| u64::from(byte)).sum()
}

/// A text up to its first zero byte.
fn text(field: &[u8]) -> String {
    let end = field.iter().position(|&byte| byte == 0).unwrap_or(field.len());
    field[..end].iter().map(|&byte| char::from(byte)).collect::<String>().trim().to_owned()
}

/// A number in decimal digits, terminated by zero bytes or blanks.
fn decimal(field: &[u8]) -> Option<u64> {
    let text = text(field);
    text.bytes().all(|byte| byte.is_ascii_digit()).then(|| text.parse().ok())?
}
