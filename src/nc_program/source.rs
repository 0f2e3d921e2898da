//! Programs as text: files and ASCII archives. A program keeps its text and where its lines begin; a block is read
//! when it is reached.

use std::collections::BTreeMap;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::head::{Head, head};

/// Whether a program is a main program or a subprogram, by its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum ProgramKind {
    /// `.mpf`, `_MPF`
    Main,
    /// `.spf`, `_SPF`
    Sub,
}

/// The text of a program.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    name: String,
    kind: ProgramKind,
    folder: String,
    text: String,
    /// Where each line begins.
    lines: Vec<u32>,
    /// Lines of the file before the program, in an archive.
    lines_before: u32,
}

/// The longest text of a program.
const LARGEST: usize = u32::MAX as usize;

impl Program {
    /// A program from the bytes of a file: UTF-8, else Latin-1. Line feeds end a line, and so does a carriage return that stands
    /// alone; before a line feed it does not count.
    ///
    /// `folder` is where the file lies: subprograms are searched there first.
    #[must_use]
    pub fn new(name: &str, kind: ProgramKind, folder: &str, bytes: &[u8]) -> Self {
        Self::of_text(name, kind, folder, decoded(bytes.to_vec()), 0)
    }

    fn of_text(name: &str, kind: ProgramKind, folder: &str, mut text: String, lines_before: u32) -> Self {
        if text.len() > LARGEST {
            let end = (0..=LARGEST).rev().find(|end| text.is_char_boundary(*end)).unwrap_or(0);
            text.truncate(end);
        }
        let mut lines = Vec::with_capacity(text.bytes().filter(|byte| *byte == b'\n').count() + 1);
        let mut start = 0;
        for line in text.split_inclusive('\n') {
            lines.push(u32::try_from(start).unwrap_or(u32::MAX));
            start += line.len();
        }
        Self { name: normalised(name), kind, folder: folder.to_owned(), text, lines, lines_before }
    }

    /// All programs of a file. In an ASCII archive each begins with `%_N_NAME_MPF` or `_SPF` alone on a line and, after it, `;$PATH=…`;
    /// neither belongs to the program. A file without such a line is one program with the name of the file.
    #[must_use]
    pub fn read(file: &str, folder: &str, bytes: impl Into<Vec<u8>>) -> Vec<Self> {
        let kind = if file.to_ascii_uppercase().ends_with("SPF") { ProgramKind::Sub } else { ProgramKind::Main };
        let text = decoded(bytes.into());
        if !text.split_inclusive('\n').any(|line| header(line).is_some()) {
            // A large program is not copied.
            return vec![Self::of_text(file, kind, folder, text, 0)];
        }
        let mut programs: Vec<Self> = Vec::new();
        let mut found: Option<(String, ProgramKind)> = None;
        let (mut start, mut first_line, mut path) = (0, 0, None);
        let (mut at, mut number) = (0, 0);
        let mut end_program =
            |found: Option<(String, ProgramKind)>, text: &str, path: Option<String>, line: u32| match found {
                Some((name, kind)) => {
                    let folder = path.unwrap_or_else(|| folder.to_owned());
                    programs.push(Self::of_text(&name, kind, &folder, text.to_owned(), line));
                }
                None if text.trim().is_empty() => {}
                None => programs.push(Self::of_text(file, kind, folder, text.to_owned(), line)),
            };
        let mut is_after_header = false;
        for line in text.split_inclusive('\n') {
            let is_path = is_after_header && line.trim_start().to_ascii_uppercase().starts_with(";$PATH=");
            is_after_header = false;
            number += 1;
            if let Some(header) = header(line) {
                end_program(found.take(), &text[start..at], path.take(), first_line);
                found = Some(header);
                is_after_header = true;
                (start, first_line) = (at + line.len(), number);
            } else if is_path {
                path = line.split_once('=').map(|(_, path)| path.trim().to_owned());
                (start, first_line) = (at + line.len(), number);
            }
            at += line.len();
        }
        end_program(found, &text[start..], path, first_line);
        // In an archive whose other programs name their folder, a program without one is in the folder of its kind.
        if programs.iter().any(|program| program.folder != folder) {
            for program in programs.iter_mut().filter(|program| program.folder == folder) {
                program.folder =
                    if program.kind == ProgramKind::Sub { "/_N_SPF_DIR" } else { "/_N_MPF_DIR" }.to_owned();
            }
        }
        if programs.is_empty() {
            programs.push(Self::of_text(file, kind, folder, text, 0));
        }
        programs
    }

    /// The name in capitals, without folder, `_N_` and ending.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Main program or subprogram.
    #[must_use]
    pub fn kind(&self) -> ProgramKind {
        self.kind
    }

    /// Where the file lies.
    #[must_use]
    pub fn folder(&self) -> &str {
        &self.folder
    }

    /// What names the program among all others: folder, name and kind.
    #[must_use]
    pub fn path(&self) -> String {
        let ending = match self.kind {
            // A name of another control has its ending already.
            _ if self.name.ends_with(".NC") => "",
            ProgramKind::Main => ".MPF",
            ProgramKind::Sub => ".SPF",
        };
        if self.folder.is_empty() {
            format!("{}{ending}", self.name)
        } else {
            format!("{}/{}{ending}", self.folder.trim_end_matches('/'), self.name)
        }
    }

    /// Appends the program with its header to an archive.
    fn write_into(&self, archive: &mut String) {
        let ending = match self.kind {
            ProgramKind::Main => "MPF",
            ProgramKind::Sub => "SPF",
        };
        for part in ["%_N_", &self.name, "_", ending, "\n;$PATH=", &self.folder, "\n"] {
            archive.push_str(part);
        }
        // A carriage return before a line feed does not belong to the line.
        archive.push_str(&self.text.replace("\r\n", "\n"));
        if !archive.ends_with('\n') {
            archive.push('\n');
        }
    }

    /// The whole text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The number of lines.
    #[must_use]
    pub fn count(&self) -> u32 {
        u32::try_from(self.lines.len()).unwrap_or(u32::MAX)
    }

    /// A line, counted from one, without its end.
    #[must_use]
    pub fn line(&self, line: u32) -> Option<&str> {
        let index = usize::try_from(line.checked_sub(1)?).ok()?;
        let start = *self.lines.get(index)? as usize;
        let end = self.lines.get(index + 1).map_or(self.text.len(), |next| *next as usize);
        Some(self.text.get(start..end)?.trim_end_matches(['\n', '\r']))
    }

    /// The line of the file that holds a line of the program: an archive has other lines before.
    #[must_use]
    pub fn line_of_file(&self, line: u32) -> u32 {
        self.lines_before.saturating_add(line)
    }

    /// The beginning of a line.
    pub(super) fn head(&self, line: u32) -> Option<(Head<'_>, &str)> {
        let text = self.line(line)?;
        Some((head(text), text))
    }
}

/// A program name as the control compares it: in capitals, without folder, `_N_`, `_MPF`, `_SPF` and endings of files.
#[must_use]
pub fn normalised(name: &str) -> String {
    let name = name.rsplit(['/', '\\']).next().unwrap_or(name).trim().to_ascii_uppercase();
    let name = name.strip_prefix("_N_").unwrap_or(&name);
    let without = [".MPF", ".SPF", "_MPF", "_SPF"].iter().find_map(|ending| name.strip_suffix(ending));
    without.unwrap_or(name).to_owned()
}

/// The name and the kind in `%_N_NAME_MPF`, alone on a line.
fn header(line: &str) -> Option<(String, ProgramKind)> {
    let name = line.trim().strip_prefix("%_N_").or_else(|| line.trim().strip_prefix("%_n_"))?.to_ascii_uppercase();
    if name.contains(char::is_whitespace) {
        return None;
    }
    let main = name.strip_suffix("_MPF").map(|name| (name.to_owned(), ProgramKind::Main));
    main.or_else(|| name.strip_suffix("_SPF").map(|name| (name.to_owned(), ProgramKind::Sub)))
}

fn decoded(mut bytes: Vec<u8>) -> String {
    if bytes.starts_with(b"\xEF\xBB\xBF") {
        bytes.drain(..3);
    }
    for at in 0..bytes.len() {
        // Before a line feed a carriage return belongs to it, however many there are.
        if bytes[at] == b'\r' && bytes[at..].iter().find(|byte| **byte != b'\r') != Some(&b'\n') {
            bytes[at] = b'\n';
        }
    }
    String::from_utf8(bytes).unwrap_or_else(|error| error.as_bytes().iter().map(|&byte| char::from(byte)).collect())
}

/// A call that looks for a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Request<'a> {
    /// The name, in capitals, without folder and ending.
    pub name: &'a str,
    /// The folder in the call, if it has one.
    pub folder: Option<&'a str>,
    /// The folder of the caller.
    pub caller: &'a str,
}

/// The folders of a control with subprograms, in the order in which it searches them after the folder of the caller: subprograms, cycles of
/// the user, of the manufacturer, and standard cycles (MDHELP 20108).
const FOLDERS: [&str; 4] = ["/_N_SPF_DIR", "/_N_CUS_DIR", "/_N_CMA_DIR", "/_N_CST_DIR"];

/// Programs in memory. Without a folder in the call a program is searched beside the caller, in the folders of a control, then in the search
/// path in its order; a subprogram comes before a main program of the same name.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Library {
    programs: BTreeMap<String, Arc<Program>>,
    search_path: Vec<String>,
}

impl Library {
    /// No programs; subprograms are also searched in these folders, in this order.
    #[must_use]
    pub fn new(search_path: Vec<String>) -> Self {
        Self { programs: BTreeMap::new(), search_path }
    }

    /// Subprograms are also searched in these folders, after those that are searched already.
    pub fn search_also(&mut self, folders: impl IntoIterator<Item = String>) {
        for folder in folders {
            if !self.search_path.contains(&folder) {
                self.search_path.push(folder);
            }
        }
    }

    /// Adds a program, in the place of an earlier one with the same path.
    pub fn add(&mut self, program: Program) -> Arc<Program> {
        let program = Arc::new(program);
        self.programs.insert(program.path().to_ascii_uppercase(), Arc::clone(&program));
        program
    }

    /// The program with this path.
    #[must_use]
    pub fn program(&self, path: &str) -> Option<Arc<Program>> {
        self.programs.get(&path.to_ascii_uppercase()).cloned()
    }

    /// The program that a call means.
    #[must_use]
    pub fn find(&self, request: &Request<'_>) -> Option<Arc<Program>> {
        let folders: Vec<&str> = match request.folder {
            Some(folder) => vec![folder],
            None => {
                let own = self.search_path.iter().map(String::as_str);
                std::iter::once(request.caller).chain(FOLDERS).chain(own).collect()
            }
        };
        folders.iter().find_map(|folder| {
            let in_folder = |ending: &str| {
                let start =
                    if folder.is_empty() { String::new() } else { format!("{}/", folder.trim_end_matches('/')) };
                self.program(&format!("{start}{}.{ending}", request.name))
            };
            in_folder("SPF").or_else(|| in_folder("MPF"))
        })
    }

    /// Programs as an ASCII archive, as [`Program::read`] reads it: first the one with this path, then, if `all`, the others. `None` if no
    /// program has this path. A name with a space cannot stand in an archive.
    #[must_use]
    pub fn archive(&self, path: &str, all: bool) -> Option<String> {
        let can_be_read = |program: &Program| !program.name.contains(char::is_whitespace);
        let first = self.program(path).filter(|first| can_be_read(first))?;
        let others = self.programs.values().filter(|other| all && !Arc::ptr_eq(&first, other) && can_be_read(other));
        let mut text = String::new();
        for program in std::iter::once(&first).chain(others) {
            program.write_into(&mut text);
        }
        Some(text)
    }

    /// All programs, in the order of their paths.
    pub fn iter(&self) -> impl Iterator<Item = &Arc<Program>> {
        self.programs.values()
    }
}

/// Name and folder of a text in a call, as `/_N_SPF_DIR/_N_PART_SPF` or `PART`.
pub(super) fn requested(text: &str) -> (String, Option<&str>) {
    let text = text.trim();
    let folder = text.rfind('/').map(|end| &text[..end]);
    (normalised(text), folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(program: &Program) -> Vec<&str> {
        (1..=program.count()).filter_map(|line| program.line(line)).collect()
    }

    #[test]
    fn a_carriage_return_alone_ends_a_line() {
        let program = Program::new("part", ProgramKind::Main, "", b"N10 X1 ;first\rN20 X2\r\nN30 X3\r\r\nM30\r");
        assert_eq!(lines(&program), ["N10 X1 ;first", "N20 X2", "N30 X3", "M30"]);
    }

    #[test]
    fn line_feeds_with_and_without_carriage_return_end_a_line() {
        let program = Program::new("part.mpf", ProgramKind::Main, "", b"G1\r\nX5\n\nM30");
        assert_eq!(lines(&program), ["G1", "X5", "", "M30"]);
        assert_eq!((program.name(), program.line(0), program.line(5)), ("PART", None, None));
    }

    #[test]
    fn latin_1_and_utf_8_are_read() {
        for bytes in [&b"MSG(\"\xE4\")"[..], "MSG(\"\u{e4}\")".as_bytes(), b"\xEF\xBB\xBFMSG(\"\xC3\xA4\")"] {
            assert_eq!(Program::new("A", ProgramKind::Main, "", bytes).line(1), Some("MSG(\"\u{e4}\")"));
        }
    }

    #[test]
    fn an_archive_has_several_programs_without_their_header_lines() {
        let archive = b"%_N_PART_MPF\n;$PATH=/_N_MPF_DIR\nG1 X5\nM30\n%_N_L100_SPF\r\n;$PATH=/_N_SPF_DIR\r\nM17\r\n%_N_OTHER_SPF\nRET\n";
        let programs = Program::read("archive.arc", "", archive);
        let found: Vec<_> =
            programs.iter().map(|one| (one.path(), lines(one).join("|"), one.line_of_file(1))).collect();
        assert_eq!(
            found,
            [
                ("/_N_MPF_DIR/PART.MPF".to_owned(), "G1 X5|M30".to_owned(), 3),
                ("/_N_SPF_DIR/L100.SPF".to_owned(), "M17".to_owned(), 7),
                ("/_N_SPF_DIR/OTHER.SPF".to_owned(), "RET".to_owned(), 9),
            ]
        );
    }

    #[test]
    fn a_file_without_headers_is_one_program() {
        let programs = Program::read("parts/Part.MPF", "parts", b"M30");
        assert_eq!((programs.len(), programs[0].path().as_str()), (1, "parts/PART.MPF"));
        assert_eq!(Program::read("empty.spf", "", b"").len(), 1);
    }

    #[test]
    fn a_subprogram_is_searched_beside_the_caller_then_in_the_search_path() {
        let mut library = Library::new(vec!["common".to_owned()]);
        for (folder, text) in [("common", "1"), ("own", "2")] {
            library.add(Program::new("sub.spf", ProgramKind::Sub, folder, text.as_bytes()));
        }
        let find = |folder, caller| {
            let found = library.find(&Request { name: "SUB", folder, caller });
            found.map(|program| program.folder().to_owned())
        };
        assert_eq!(find(None, "own").as_deref(), Some("own"));
        assert_eq!(find(None, "elsewhere").as_deref(), Some("common"));
        assert_eq!(find(Some("common"), "own").as_deref(), Some("common"));
        assert_eq!(find(Some("nowhere"), "own"), None);
        assert_eq!(requested("/_N_SPF_DIR/_N_Part_SPF"), ("PART".to_owned(), Some("/_N_SPF_DIR")));
    }
}
