//! READING LISTS: files are told apart by their contents, their entries get types and places, and what cannot be read is an error with
//! file and line (HG-28).
//!
//! An axis list has `kopf.achs_nr` and anything of `kenngr`, `getriebe[…]`, `antr` or `lr_…` (an axis compensation list has
//! `kopf.achs_nr`, too). A channel list has `gruppe[…]`, `grp_anzahl` or `synchro_data…`. An ID counts as the list name of its parameter.
//! All other files are left alone.
//!
//! Decisions. The last one of two equal entries acts; `machine-data check` names both. A second value of an index of a channel axis or of
//! a pair that no control has (`achse[32]`, `paar[15]`) is a broken index. An entry of a known channel parameter in an axis list is an
//! unknown entry, and the reverse.

use std::collections::BTreeMap;

use crate::control::{Class, Finding};
use crate::source::{Place, Problem, Wide, decode};

use super::lines::{Line, lines};
use super::list::{AXIS_NUMBER, Entry, List, Lists, Unknown};
use super::name::{Meaning, meaning};
use super::parameter::{Key, Scope};
use super::table::by_number;
use super::value::read;

/// All that the files of a machine hold.
#[derive(Debug, Default)]
pub(super) struct Collected {
    pub(super) lists: Lists,
    /// What cannot be read.
    pub(super) problems: Vec<Problem>,
    /// What is read, but not as it seems.
    pub(super) remarks: Vec<Finding>,
}

/// One file as it is read.
struct File<'a> {
    place: Place,
    entries: Vec<Line<'a>>,
    unclosed: Option<u32>,
}

impl Lists {
    /// Reads the lists of a machine: names and contents of its files, in any order.
    ///
    /// # Errors
    /// A list cannot be read, two lists have the same axis, a channel has an axis without a list, names clash, or there is no axis list.
    pub fn read<N: AsRef<str>, B: AsRef<[u8]>>(files: &[(N, B)]) -> Result<Self, Problem> {
        Self::read_with_remarks(files).map(|(lists, _)| lists)
    }

    /// The lists, and what is read in them, but not as it seems.
    ///
    /// # Errors
    /// As [`Lists::read`].
    pub fn read_with_remarks<N: AsRef<str>, B: AsRef<[u8]>>(files: &[(N, B)]) -> Result<(Self, Vec<Finding>), Problem> {
        let Collected { mut lists, problems, remarks } = collect(files);
        if let Some(problem) = problems.into_iter().next() {
            return Err(problem);
        }
        lists.adopt_all();
        match lists.contradictions().into_iter().next() {
            Some(problem) => Err(problem),
            None => Ok((lists, remarks)),
        }
    }
}

/// Reads all that can be read.
pub(super) fn collect<N: AsRef<str>, B: AsRef<[u8]>>(files: &[(N, B)]) -> Collected {
    let mut files: Vec<(&str, &[u8])> = files.iter().map(|(name, bytes)| (name.as_ref(), bytes.as_ref())).collect();
    files.sort_by_key(|(name, _)| *name);
    let mut collected = Collected::default();
    for (name, bytes) in files {
        collected.file(name, bytes);
    }
    collected.lists.axes.sort_by_key(|list| list.number);
    collected
}

impl Collected {
    fn file(&mut self, name: &str, bytes: &[u8]) {
        let place = Place::file(name);
        if let Some(wide) = Wide::of(bytes) {
            let [what, cure] = wide.problem(name, "a parameter list in UTF-8 or Latin-1");
            self.problems.push(place.problem(what, cure));
            return;
        }
        let text = decode(bytes);
        let lines = lines(&text);
        let file = File { place, entries: lines.entries, unclosed: lines.unclosed };
        match file.scope() {
            Some(Scope::Axis) => {
                let list = self.list(&file, Scope::Axis, file.axis_number());
                self.lists.axes.push(list);
            }
            Some(Scope::Channel) => {
                let number = u16::try_from(self.lists.channels.len() + 1).unwrap_or(u16::MAX);
                let list = self.list(&file, Scope::Channel, number);
                self.lists.channels.push(list);
            }
            None => {
                self.lists.others.push(name.to_owned());
                self.remarks.extend(file.without_number());
            }
        }
    }

    fn list(&mut self, file: &File<'_>, scope: Scope, number: u16) -> List {
        let (stored, active) = (BTreeMap::new(), BTreeMap::new());
        let mut list = List { scope, number, file: file.place.clone(), stored, active, unknown: Vec::new() };
        if let Some(line) = file.unclosed {
            let what = "expected the end `*/` of the comment that begins here, found the end of the file";
            self.problems.push(file.place.at_line(line).problem(what, "write `*/` where the comment ends"));
        }
        for line in &file.entries {
            let place = file.place.at_line(line.number);
            if let Err(problem) = self.entry(&mut list, line, &place) {
                self.problems.push(problem.at(&place));
            }
        }
        list
    }

    /// One entry of a list.
    fn entry(&mut self, list: &mut List, line: &Line<'_>, place: &Place) -> Result<(), Problem> {
        let cure = "write the index as a whole number from 0 in brackets: getriebe[0].dynamik.a_max";
        let found = meaning(line.name)
            .map_err(|what| Problem::new(format!("expected a name, found a broken index: {what}"), cure))?;
        let known = match found {
            Meaning::Known(parameter, index) if parameter.scope == list.scope => Some((parameter, index)),
            Meaning::Known(..) | Meaning::Unknown => None,
        };
        let Some((parameter, index)) = known else {
            if line.rest.is_empty() {
                let what = format!("expected a value behind `{}`, found none", line.name);
                return Err(Problem::new(what, "write the value behind the name, or remove the line"));
            }
            let (name, value) = (line.name.to_owned(), line.rest.to_owned());
            list.unknown.push(Unknown { name, value, scope: list.scope, place: place.clone() });
            return Ok(());
        };
        let read = read(parameter, index, line.rest)?;
        let key = Key { number: parameter.number(), index };
        let about = |class, what: String, cure: &str| Finding {
            place: Some(place.clone()),
            number: Some(key.number),
            datum: parameter.title(index),
            value: read.value.to_string(),
            owner: list.owner(),
            ..Finding::new(class, what, cure)
        };
        if !read.ignored.is_empty() {
            let what = format!("behind the word stands `{}`, which is ignored", read.ignored);
            self.remarks.push(about(Class::Implausible, what, "behind a word, begin a comment with `(`"));
        }
        if let Some(earlier) = list.stored.get(&key) {
            let what = format!("replaces the entry in line {}", earlier.place.line);
            self.remarks.push(about(Class::Overlaid, what, ""));
        }
        list.stored.insert(key, Entry { value: read.value, place: place.clone() });
        Ok(())
    }
}

impl File<'_> {
    /// The kind of list, by its entries; `None` for another file.
    fn scope(&self) -> Option<Scope> {
        let has = |is: &dyn Fn(&str) -> bool| self.entries.iter().any(|line| is(&list_name(line.name)));
        if has(&is_axis_number) && has(&is_of_axis) {
            return Some(Scope::Axis);
        }
        has(&is_of_channel).then_some(Scope::Channel)
    }

    /// The logical number in an axis list; 0 if it cannot be read.
    fn axis_number(&self) -> u16 {
        let last = self.entries.iter().rev().find(|line| is_axis_number(&list_name(line.name)));
        let parameter = by_number(AXIS_NUMBER).zip(last);
        let value = parameter.and_then(|(parameter, line)| read(parameter, [0, 0], line.rest).ok());
        value.and_then(|read| u16::try_from(read.value.whole()?).ok()).unwrap_or(0)
    }

    /// A finding about a file that looks like an axis list and has no logical number.
    fn without_number(&self) -> Option<Finding> {
        let line = self.entries.iter().find(|line| is_of_axis(&list_name(line.name)))?;
        let what = format!("has `{}`, but no `kopf.achs_nr`: it is not read as the list of an axis", line.name);
        let cure = "write the logical number of the axis: kopf.achs_nr 5";
        Some(Finding { place: Some(self.place.at_line(line.number)), ..Finding::new(Class::Implausible, what, cure) })
    }
}

/// The list name of an entry that is written under its ID. A parameter without a list name is one of `kenngr`.
fn list_name(name: &str) -> String {
    if !name.starts_with("P-") {
        return name.to_owned();
    }
    match meaning(name) {
        Ok(Meaning::Known(parameter, index)) => parameter.list_name(index).unwrap_or_else(|| "kenngr".to_owned()),
        Ok(Meaning::Unknown) | Err(_) => name.to_owned(),
    }
}

fn is_axis_number(name: &str) -> bool {
    name == "kopf.achs_nr"
}

fn is_of_axis(name: &str) -> bool {
    let structure = name.split(['.', '[']).next().unwrap_or_default();
    matches!(structure, "kenngr" | "getriebe" | "antr") || structure.starts_with("lr_")
}

fn is_of_channel(name: &str) -> bool {
    let structure = name.split(['.', '[']).next().unwrap_or_default();
    matches!(structure, "gruppe" | "grp_anzahl") || structure.starts_with("synchro_data")
}
