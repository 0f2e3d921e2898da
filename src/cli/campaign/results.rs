//! The file of results. Lines are appended in the order of the cases and written at once, so that a run that is interrupted at any moment
//! keeps what is done.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

use serde_json::{Value as Json, json};

use crate::campaign::{Header, Lines, Reading, Record, Spec, Summary};
use crate::source::{Place, Problem, replace, unreadable, unwritable};

/// The name of the file in its folder.
const NAME: &str = "results.jsonl";

/// A file of results that is written.
pub(super) struct Results {
    path: PathBuf,
    file: File,
    lines: Lines,
    count: u64,
}

impl Results {
    /// Begins a new file; an old one is replaced.
    pub(super) fn begin(folder: &Path, header: &Header) -> Result<Self, Problem> {
        std::fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
        let path = folder.join(NAME);
        if path.exists() {
            // Only results are replaced, no other file of this name.
            Part::open(folder)?;
        }
        replace(&path, &header.line())?;
        Self::append(path)
    }

    fn append(path: PathBuf) -> Result<Self, Problem> {
        let file = OpenOptions::new().append(true).open(&path).map_err(|error| unwritable(&path, &error))?;
        Ok(Self { path, file, lines: Lines::default(), count: 0 })
    }

    /// Goes on with a file of the same campaign; returns the first unit that must run. Its last unit can be incomplete, and runs again.
    pub(super) fn resume(
        folder: &Path,
        header: &Header,
        spec: &Spec,
        summary: &mut Summary,
    ) -> Result<(Self, u64), Problem> {
        if !folder.join(NAME).exists() {
            return Ok((Self::begin(folder, header)?, 0));
        }
        let mut part = Part::open(folder)?;
        part.check(header)?;
        let mut records: Vec<Record> = Vec::new();
        while let Some(record) = part.next(true)? {
            records.push(record);
        }
        let last = if part.is_complete { None } else { records.last().map(|record| spec.unit_of(record.case)) };
        let next = match (part.is_complete, last) {
            (true, _) => u64::MAX,
            (false, Some(unit)) => unit,
            (false, None) => 0,
        };
        records.retain(|record| last.is_none_or(|last| spec.unit_of(record.case) != last));
        replace(&folder.join(NAME), &header.line())?;
        let mut results = Self::append(folder.join(NAME))?;
        results.write(&records)?;
        records.iter().for_each(|record| summary.add(record));
        Ok((results, next))
    }

    /// Appends records.
    pub(super) fn write(&mut self, records: &[Record]) -> Result<(), Problem> {
        let text: String = records.iter().map(|record| self.lines.of(record)).collect();
        self.count += records.len() as u64;
        self.file.write_all(text.as_bytes()).map_err(|error| unwritable(&self.path, &error))
    }

    /// Notes that all records are there.
    pub(super) fn finish(mut self) -> Result<(), Problem> {
        let line = format!("{}\n", json!({ "records": self.count }));
        self.file.write_all(line.as_bytes()).map_err(|error| unwritable(&self.path, &error))
    }
}

/// A file of results that is read.
pub(super) struct Part {
    path: PathBuf,
    lines: std::io::Lines<BufReader<File>>,
    line: u32,
    reading: Reading,
    pub(super) header: Header,
    pub(super) is_complete: bool,
    count: u64,
}

impl Part {
    pub(super) fn open(folder: &Path) -> Result<Self, Problem> {
        let path = folder.join(NAME);
        let file = File::open(&path).map_err(|error| unreadable(&path, &error))?;
        let mut lines = BufReader::new(file).lines();
        let first = lines.next().transpose().map_err(|error| unreadable(&path, &error))?.unwrap_or_default();
        let header = Header::read(&first, &path.display().to_string())?;
        Ok(Self { path, lines, line: 1, reading: Reading::default(), header, is_complete: false, count: 0 })
    }

    /// Refuses results of another version, campaign or part.
    pub(super) fn check(&self, wanted: &Header) -> Result<(), Problem> {
        let place = Place::file(&self.path.display().to_string()).at_line(1);
        let found = &self.header;
        let refused = |what: String, cure: &str| Err(place.problem(what, cure));
        if found.version != wanted.version {
            let what =
                format!("expected results of version {}, found those of version {}", wanted.version, found.version);
            return refused(what, "run all parts with the same version of the program");
        }
        if found.spec != wanted.spec {
            let what = "expected results of this campaign, found those of another one, or of this one before its files changed";
            return refused(what.to_owned(), "run all parts again, in another folder");
        }
        if found.cases != wanted.cases {
            let what = format!("expected results of {} cases, found those of {}", wanted.cases, found.cases);
            return refused(what, "use the same --limit for all parts, and for --resume");
        }
        if found.shard != wanted.shard {
            let ((part, of), (other, others)) = (wanted.shard, found.shard);
            let what = format!("expected results of part {part}/{of}, found those of part {other}/{others}");
            return refused(what, "each part has a folder of its own");
        }
        Ok(())
    }

    /// Its folder.
    pub(super) fn folder(&self) -> &Path {
        self.path.parent().unwrap_or_else(|| Path::new(""))
    }

    /// The place of the line that was read last.
    pub(super) fn place(&self) -> Place {
        Place::file(&self.path.display().to_string()).at_line(self.line)
    }

    /// The next record. With `may_end`, a last line that is not complete is the end: the run was interrupted while it wrote it.
    pub(super) fn next(&mut self, may_end: bool) -> Result<Option<Record>, Problem> {
        while let Some(line) = self.lines.next() {
            let line = line.map_err(|error| unreadable(&self.path, &error))?;
            self.line += 1;
            if let Some(records) =
                serde_json::from_str::<Json>(&line).ok().and_then(|json| json.get("records")?.as_u64())
            {
                if records != self.count {
                    let what = format!("expected {} records, found {records} in the last line", self.count);
                    return Err(self.place().problem(what, "the file is damaged: run this part again"));
                }
                self.is_complete = true;
                return Ok(None);
            }
            match self.reading.line(&line, &self.place()) {
                Ok(Some(record)) => {
                    self.count += 1;
                    return Ok(Some(record));
                }
                Ok(None) => {}
                Err(problem) => {
                    let is_last = may_end && self.lines.next().is_none();
                    return if is_last { Ok(None) } else { Err(problem) };
                }
            }
        }
        Ok(None)
    }
}
