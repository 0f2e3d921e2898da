//! Lists for people and programs: the same rows as an aligned table, as JSON, or as CSV.

use std::collections::BTreeSet;

use clap::ValueEnum;

use super::output::Output;
use crate::source::{Problem, did_you_mean};

/// Output format of a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(super) enum Format {
    /// Aligned columns.
    Table,
    /// A JSON array of objects.
    Json,
    /// Comma-separated values with a header.
    Csv,
}

/// A cell of a list.
pub(super) trait Cell {
    /// The text for tables and CSV.
    fn text(&self) -> &str;

    /// The value for JSON.
    fn json(&self) -> serde_json::Value {
        self.text().into()
    }
}

impl Cell for String {
    fn text(&self) -> &str {
        self
    }
}

/// `did you mean …?` with the words of a list that are nearest to a text that no row contains, or the fallback. `limit_exeeded` is compared
/// with every two and three words in a row of a symbol.
pub(super) fn near_words<'a>(wanted: &str, texts: impl Iterator<Item = &'a str>, fallback: &str) -> String {
    let count = wanted.split('_').count();
    let mut known = BTreeSet::new();
    for text in texts {
        let text = text.to_lowercase();
        for word in text.split(|letter: char| !letter.is_alphanumeric() && letter != '_') {
            let parts: Vec<_> = word.split('_').collect();
            let pieces = parts.windows(count).chain(parts.windows(count + 1));
            known.extend(pieces.map(|parts| parts.join("_")).filter(|part| part.len() > 2));
        }
    }
    // Of a word of three letters every other one is near.
    let known = known.iter().filter(|known| wanted.len() > 3 || known.starts_with(wanted));
    did_you_mean(wanted, known.map(String::as_str), fallback)
}

/// Rows below a heading line. Every row has as many cells as there are headings.
pub(super) struct List<C = String> {
    pub(super) heads: &'static [&'static str],
    pub(super) rows: Vec<Vec<C>>,
}

impl<C: Cell> List<C> {
    /// Keeps the rows that contain a text, ignoring case. Warns if none is left. Returns the exit code, as `grep`: 1 if none is left.
    pub(super) fn retain_with(&mut self, filter: Option<&str>, output: &mut Output) -> u8 {
        let Some(filter) = filter else { return 0 };
        let wanted = filter.to_lowercase();
        let texts = || self.rows.iter().flatten().map(Cell::text);
        let cure = near_words(&wanted, texts(), "omit the filter to list all rows");
        self.rows.retain(|row| row.iter().any(|cell| cell.text().to_lowercase().contains(&wanted)));
        if self.rows.is_empty() {
            output.warning(format!("no row contains `{filter}`; {cure}"));
        }
        u8::from(self.rows.is_empty())
    }

    /// Prints the list and returns the exit code.
    pub(super) fn print(&self, format: Format, output: &mut Output) -> u8 {
        match self.text(format) {
            Ok(text) => {
                output.print(&text);
                0
            }
            Err(problem) => {
                output.error(problem);
                2
            }
        }
    }

    /// The list as a text.
    pub(super) fn text(&self, format: Format) -> Result<String, Problem> {
        let failed =
            |error: String| Problem::new(format!("the list cannot be written: {error}"), "choose another format");
        match format {
            Format::Table => Ok(self.table()),
            Format::Json => {
                let text = serde_json::to_string_pretty(&self.objects()).map_err(|error| failed(error.to_string()))?;
                Ok(text + "\n")
            }
            Format::Csv => {
                let mut writer = csv::Writer::from_writer(Vec::new());
                writer.write_record(self.heads).map_err(|error| failed(error.to_string()))?;
                for row in &self.rows {
                    writer.write_record(row.iter().map(Cell::text)).map_err(|error| failed(error.to_string()))?;
                }
                let bytes = writer.into_inner().map_err(|error| failed(error.to_string()))?;
                String::from_utf8(bytes).map_err(|error| failed(error.to_string()))
            }
        }
    }

    fn objects(&self) -> Vec<serde_json::Map<String, serde_json::Value>> {
        let object =
            |row: &Vec<C>| self.heads.iter().zip(row).map(|(head, cell)| ((*head).to_owned(), cell.json())).collect();
        self.rows.iter().map(object).collect()
    }

    /// Columns are as wide as their longest text; the last one is not padded.
    fn table(&self) -> String {
        let lines = || {
            let cells = self.rows.iter().map(|row| row.iter().map(Cell::text).collect());
            std::iter::once(self.heads.to_vec()).chain(cells)
        };
        let widths: Vec<usize> = (0..self.heads.len())
            .map(|column| lines().map(|line| line[column].chars().count()).max().unwrap_or(0))
            .collect();
        let mut text = String::new();
        for line in lines() {
            let cells: Vec<String> = line.iter().zip(&widths).map(|(cell, width)| format!("{cell:<width$}")).collect();
            text.push_str(cells.join("  ").trim_end());
            text.push('\n');
        }
        text
    }
}
