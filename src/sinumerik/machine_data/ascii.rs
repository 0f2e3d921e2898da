//! The ASCII format of an archive (TEA, INI): one assignment per line, sections by channel, several members in a file.
//!
//! Reading is as tolerant as the import of the control: either kind of line ending, Latin-1, a byte order mark, missing
//! block numbers, blanks around `=`, comments, checksums of lines. A malformed line is an error in a text file: the control stops
//! its import at such a line (alarm 12550 and others), and half of the archive would be in effect. In a binary archive, which only a
//! control writes, it is kept in mind and skipped.

use crate::control::{Class, Finding};
use crate::source::{Place, decode};
use crate::units::ChannelNumber;

use super::reading::{Author, Line, Member, Reading};
use super::scaling::System;

/// Reads a file.
pub(super) fn read(name: &str, bytes: &[u8], reading: &mut Reading) {
    let (lines, findings) = (reading.lines.len(), reading.findings.len());
    read_text(name, &decode(bytes), Author::Person, reading);
    if (reading.lines.len(), reading.findings.len()) == (lines, findings) {
        let what = if bytes.is_empty() { "found an empty file" } else { "found no assignment" };
        let what = format!("expected machine data, {what}; the defaults of the control act");
        let cure = "export the machine data of the control again, or delete the file";
        let finding = Finding::new(Class::Implausible, what, cure);
        reading.findings.push(Finding { place: Some(Place::file(name)), ..finding });
    }
}

/// Reads a text; findings name `name` and the line.
pub(super) fn read_text(name: &str, text: &str, author: Author, reading: &mut Reading) {
    let file = Place::file(name);
    let mut channel = ChannelNumber::FIRST;
    let mut system = None;
    let before = reading.lines.len();
    for (number, line) in (1..).zip(text.lines()) {
        let place = file.at_line(number);
        let line = line.trim_matches(|letter: char| letter.is_whitespace() || letter == '\0' || letter == '\u{feff}');
        // A header begins a member, and a member begins with channel 1.
        if line.starts_with('%') {
            (channel, system) = (ChannelNumber::FIRST, None);
            continue;
        }
        let line = without_comment(line);
        if line.is_empty() {
            continue;
        }
        if let Some(declared) =
            [System::Metric, System::Inch].into_iter().find(|of| line.eq_ignore_ascii_case(of.word()))
        {
            system = Some(declared);
            continue;
        }
        if ["M17", "M02", "M2", "M30"].iter().any(|end| line.eq_ignore_ascii_case(end)) {
            channel = ChannelNumber::FIRST;
            continue;
        }
        match kind(line) {
            Kind::Channel(number) => channel = number,
            Kind::Assignment { number, name, value, has_checksum } => {
                let (name, value) = (name.to_owned(), value.to_owned());
                let file = reading.file;
                reading.lines.push(Line { place, number, name, channel, value, author, file, system, has_checksum });
            }
            Kind::Broken(what, cure) => {
                let finding = match author {
                    Author::Person | Author::Export => Finding::new(Class::Unreadable, what, cure),
                    Author::Control => Finding {
                        group: "lines of an unknown kind",
                        ..Finding::new(Class::NotModelled, format!("{what}; the line is ignored"), "")
                    },
                };
                reading.findings.push(Finding { place: Some(place), ..finding });
            }
        }
    }
    reading.members.push(Member { name: name.to_owned(), assignments: Some(reading.lines.len() - before) });
}

enum Kind<'a> {
    Channel(ChannelNumber),
    Assignment { number: Option<u32>, name: &'a str, value: &'a str, has_checksum: bool },
    Broken(String, &'static str),
}

/// Classifies a line without its comment.
fn kind(line: &str) -> Kind<'_> {
    if let Some(inside) = strip_word(line, "CHANDATA") {
        let number = inside.trim().strip_prefix('(').and_then(|inside| inside.strip_suffix(')'));
        return number.and_then(|number| ChannelNumber::new(number.trim().parse().ok()?)).map_or_else(
            || {
                Kind::Broken(
                    format!("expected CHANDATA(1) to CHANDATA({}), found `{line}`", ChannelNumber::MAX),
                    "correct the number of the channel",
                )
            },
            Kind::Channel,
        );
    }
    assignment(line).unwrap_or_else(|| {
        Kind::Broken(
            format!("expected an assignment such as `N37100 $MA_GANTRY_AXIS_TYPE[AX1]=1`, found `{}`", quoted(line)),
            "write one assignment in a line",
        )
    })
}

/// The beginning of a line that is not an assignment, escaped for output on a terminal.
fn quoted(line: &str) -> String {
    let shown: String = line.chars().take(60).collect();
    let more = if shown.len() < line.len() { "…" } else { "" };
    format!("{}{more}", shown.escape_debug())
}

/// `N37100 $MA_GANTRY_AXIS_TYPE[AX1]=1`
fn assignment(line: &str) -> Option<Kind<'_>> {
    let (name, value) = line.split_once('=')?;
    let (mut name, mut value) = (name.trim(), value.trim());
    let (mut number, mut has_checksum) = (None, false);
    if let Some(rest) = name.strip_prefix(['N', 'n']) {
        let digits = rest.len() - rest.trim_start_matches(|letter: char| letter.is_ascii_digit()).len();
        let (block, after) = rest.split_at(digits);
        if digits > 0 && after.starts_with([' ', '\t', '$']) {
            number = Some(block.parse().ok()?);
            name = after.trim();
        }
    }
    let mut letters = name.chars();
    let first = letters.next()?;
    let sound = (first == '$' || first == '_' || first.is_ascii_alphabetic())
        && name.split('[').next()?.trim().chars().skip(1).all(|letter| letter == '_' || letter.is_ascii_alphanumeric());
    // A checksum of the line follows the value as `'1f34`.
    if let Some((before, checksum)) = value.rsplit_once([' ', '\t'])
        && let Some(digits) = checksum.strip_prefix('\'')
        && !digits.is_empty()
        && digits.bytes().all(|digit| digit.is_ascii_hexdigit())
    {
        value = before.trim();
        has_checksum = true;
    }
    (sound && !value.is_empty()).then_some(Kind::Assignment { number, name, value, has_checksum })
}

/// The text after a word, in upper or lower case.
fn strip_word<'a>(line: &'a str, word: &str) -> Option<&'a str> {
    let (start, rest) = line.split_at_checked(word.len())?;
    start.eq_ignore_ascii_case(word).then_some(rest)
}

/// Removes a comment, unless its `;` is inside quotes.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let end = line.char_indices().find(|(_, letter)| {
        quoted ^= *letter == '"';
        *letter == ';' && !quoted
    });
    line[..end.map_or(line.len(), |(at, _)| at)].trim()
}
