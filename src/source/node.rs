//! A TOML 1.0 file as a tree in which every value knows its line, and the functions that read the tree.
//!
//! Readers take the keys that they know with [`Table::take`] and end with [`Table::finish`], which rejects all remaining keys by name. So
//! an unknown key is never ignored.

use std::collections::BTreeMap;

use toml::de::{DeTable, DeValue};

use super::{Place, Problem, did_you_mean};

/// A value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The line of the value.
    pub place: Place,
    /// The value.
    pub value: Value,
}

/// All TOML types except dates, which this project does not use.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// `"text"`.
    Text(String),
    /// `12`, `0xFF`.
    Integer(i64),
    /// `1.5`.
    Float(f64),
    /// `true`.
    Boolean(bool),
    /// `[1, 2]`.
    Array(Vec<Node>),
    /// `[section]` or `{ key = value }`.
    Table(Table),
}

/// Keys with their values, in the order of the file.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The place where the table begins.
    pub place: Place,
    entries: Vec<(String, Place, Node)>,
    known: Vec<&'static str>,
}

impl Table {
    /// Reads a TOML document.
    ///
    /// # Errors
    /// The first place that is not valid TOML 1.0.
    pub fn parse(text: &str, file: &str) -> Result<Self, Problem> {
        Self::parse_part(text, &Place::file(file).at_line(1))
    }

    /// Reads a part of a file as a TOML document; `place` is that of its first line.
    ///
    /// # Errors
    /// As [`Table::parse`].
    pub fn parse_part(text: &str, place: &Place) -> Result<Self, Problem> {
        let start = place;
        let lines = Lines::new(text, place.line);
        let document = DeTable::parse(text).map_err(|error| {
            let line = error.span().map_or(0, |span| lines.line(span.start));
            let key = error.span().and_then(|span| text.get(span)).map(str::trim).unwrap_or_default();
            let message = match error.message() {
                "duplicate key" => format!("the key `{key}` a second time"),
                message => message.replace('\n', "; "),
            };
            let cure = match error.message() {
                "duplicate key" => "a key stands once in its table: remove one of them",
                message if message.contains("must be quoted") => {
                    "put texts, expressions and durations in quotes: \"X.position > 5\", \"500ms\""
                }
                message if message.contains("missing assignment") || message.contains("key with no value") => {
                    "put a key with brackets in quotes: \"34090[XF]\" = 1.5"
                }
                _ => "TOML 1.0 has strings in quotes, tables in brackets, one value per key",
            };
            start.at_line(line).problem(format!("invalid TOML: {message}"), cure)
        })?;
        table(document.get_ref(), start, &lines, start)
    }

    /// An empty table.
    #[must_use]
    pub fn empty(place: Place) -> Self {
        Self { place, entries: Vec::new(), known: Vec::new() }
    }

    /// Removes a value by its key and returns it; the key counts as known from now on.
    pub fn take(&mut self, key: &'static str) -> Option<Node> {
        self.known.push(key);
        let index = self.entries.iter().position(|(name, ..)| name == key)?;
        Some(self.entries.remove(index).2)
    }

    /// The remaining keys with their values.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Node)> {
        self.entries.iter().map(|(name, _, node)| (name.as_str(), node))
    }

    /// Puts a value at a path of keys; it replaces the value there, and tables on the way are created.
    ///
    /// # Errors
    /// A key on the way has a value that is not a table; the error is this key.
    pub fn put(&mut self, path: &[&str], place: &Place, node: Node) -> Result<(), String> {
        let Some((key, rest)) = path.split_first() else {
            return Ok(());
        };
        let index = self.entries.iter().position(|(name, ..)| name == key).unwrap_or(self.entries.len());
        if index == self.entries.len() {
            let empty = Value::Table(Self::empty(place.clone()));
            self.entries.push(((*key).to_owned(), place.clone(), Node { place: place.clone(), value: empty }));
        }
        let (.., old) = &mut self.entries[index];
        match (&mut old.value, rest) {
            (_, []) => *old = node,
            (Value::Table(table), rest) => table.put(rest, place, node)?,
            (_, _) => return Err((*key).to_owned()),
        }
        Ok(())
    }

    /// Removes and returns all remaining entries: key, place of the key, value.
    pub fn take_rest(&mut self) -> Vec<(String, Place, Node)> {
        std::mem::take(&mut self.entries)
    }

    /// The remaining keys.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|(name, ..)| name.as_str())
    }

    /// Rejects all keys that were not taken.
    ///
    /// # Errors
    /// The first remaining key, with the nearest known key.
    pub fn finish(&self) -> Result<(), Problem> {
        let Some((name, place, _)) = self.entries.first() else {
            return Ok(());
        };
        let mut known = self.known.clone();
        known.dedup();
        let known = known.join("`, `");
        let cure = did_you_mean(name, self.known.iter().copied(), "remove it");
        Err(place.problem(format!("expected one of `{known}`, found the unknown key `{name}`"), cure))
    }

    /// Merges another table over this one: tables are merged, all other values are replaced; `false` also replaces a table. The place of a
    /// merged table is that of the one that changed it last: what does not fit together then does so because of this change.
    pub fn merge(&mut self, over: Self) {
        self.place = over.place;
        for (name, place, node) in over.entries {
            let existing = self.entries.iter().position(|(other, ..)| *other == name);
            match existing {
                None => self.entries.push((name, place, node)),
                Some(index) => {
                    let (_, old_place, old) = &mut self.entries[index];
                    *old_place = place;
                    match (&mut old.value, node.value) {
                        (Value::Table(table), Value::Table(new)) => {
                            table.merge(new);
                            old.place = node.place;
                        }
                        (_, value) => *old = Node { place: node.place, value },
                    }
                }
            }
        }
    }
}

impl Node {
    /// The type of this value and its content, as text for a message.
    #[must_use]
    pub fn found(&self) -> String {
        match &self.value {
            Value::Text(text) => format!("the text \"{text}\""),
            Value::Integer(number) => format!("the integer {number}"),
            Value::Float(number) => format!("the number {number}"),
            Value::Boolean(value) => format!("{value}"),
            Value::Array(_) => "an array".to_owned(),
            Value::Table(_) => "a table".to_owned(),
        }
    }

    /// The problem "expected this, found that" at this place.
    #[must_use]
    pub fn expected(&self, what: &str, cure: &str) -> Problem {
        self.place.problem(format!("expected {what}, found {}", self.found()), cure)
    }

    /// The value as a text.
    ///
    /// # Errors
    /// The value has another type.
    pub fn text(&self, what: &str) -> Result<&str, Problem> {
        match &self.value {
            Value::Text(text) => Ok(text),
            Value::Array(_) | Value::Table(_) => Err(self.expected(what, "write one text in quotes")),
            _ => Err(self.expected(what, "put it in quotes")),
        }
    }

    /// The value as a number, whole or not; it must be finite.
    ///
    /// # Errors
    /// The value has another type, or is `inf` or `nan`.
    pub fn number(&self, what: &str) -> Result<f64, Problem> {
        match self.value {
            Value::Integer(number) => Ok(number as f64),
            Value::Float(number) if number.is_finite() => Ok(number),
            _ => Err(self.expected(what, "write a finite number without quotes")),
        }
    }

    /// The value as a whole number.
    ///
    /// # Errors
    /// The value has another type.
    pub fn integer(&self, what: &str) -> Result<i64, Problem> {
        match self.value {
            Value::Integer(number) => Ok(number),
            _ => Err(self.expected(what, "write a whole number without quotes")),
        }
    }

    /// The value as `true` or `false`.
    ///
    /// # Errors
    /// The value has another type.
    pub fn boolean(&self, what: &str) -> Result<bool, Problem> {
        match self.value {
            Value::Boolean(value) => Ok(value),
            _ => Err(self.expected(what, "write true or false")),
        }
    }

    /// The value as one of these texts, and what it stands for.
    ///
    /// # Errors
    /// The value is none of them; the error names the nearest.
    pub fn one_of<T: Copy>(&self, choices: &[(&str, T)]) -> Result<T, Problem> {
        let names: Vec<_> = choices.iter().map(|(name, _)| *name).collect();
        let what = format!("one of \"{}\"", names.join("\", \""));
        let text = self.text(&what)?;
        let choice = choices.iter().find(|(name, _)| *name == text);
        choice
            .map(|(_, choice)| *choice)
            .ok_or_else(|| self.expected(&what, &did_you_mean(text, names, "write one of them")))
    }

    /// The key that was probably meant if this value of the key `name` is a table: a dot without quotes, `X.controller_enable = 1`, makes
    /// a table `X` with the key `controller_enable`.
    #[must_use]
    pub fn unquoted_key(&self, name: &str) -> Option<String> {
        let Value::Table(table) = &self.value else {
            return None;
        };
        match &table.entries[..] {
            [(inner, _, node)] => {
                let whole = format!("{name}.{inner}");
                Some(node.unquoted_key(&whole).unwrap_or(whole))
            }
            _ => None,
        }
    }

    /// The problem of a key that has a dot and no quotes, if the value of the key `name` is one.
    ///
    /// # Errors
    /// The value is a table.
    pub fn refuse_unquoted_key(&self, name: &str) -> Result<(), Problem> {
        match (self.unquoted_key(name), &self.value) {
            (Some(key), _) => Err(self.place.problem(
                format!("expected a key in quotes, found {key} without quotes"),
                format!("write \"{key}\" = …; without quotes a dot begins a table"),
            )),
            (None, Value::Table(_)) => Err(self.expected("one value", &format!("write \"{name}\" = 1"))),
            (None, _) => Ok(()),
        }
    }

    /// The value as a table.
    ///
    /// # Errors
    /// The value has another type.
    pub fn into_table(self, what: &str) -> Result<Table, Problem> {
        match self.value {
            Value::Table(table) => Ok(table),
            _ => Err(self.expected(what, "write it as a table")),
        }
    }

    /// The value as an array; a single value becomes an array with one element.
    #[must_use]
    pub fn into_list(self) -> Vec<Self> {
        match self.value {
            Value::Array(nodes) => nodes,
            _ => vec![self],
        }
    }
}

/// The number of the first line, and the offsets of all line ends, to find the line of a byte offset.
struct Lines(u32, Vec<usize>);

impl Lines {
    fn new(text: &str, first: u32) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, byte)| *byte == b'\n').map(|(offset, _)| offset).collect();
        Self(first, ends)
    }

    fn line(&self, offset: usize) -> u32 {
        let before = self.1.partition_point(|&newline| newline < offset);
        u32::try_from(before).map_or(u32::MAX, |before| self.0.saturating_add(before))
    }
}

fn table(from: &DeTable<'_>, place: &Place, lines: &Lines, file: &Place) -> Result<Table, Problem> {
    let mut ordered = BTreeMap::new();
    for (key, value) in from {
        let key_place = file.at_line(lines.line(key.span().start));
        let value_place = file.at_line(lines.line(value.span().start));
        let node = node(value.get_ref(), &value_place, lines, file)?;
        ordered.insert((key.span().start, key.get_ref().to_string()), (key_place, node));
    }
    let entries = ordered.into_iter().map(|((_, name), (place, node))| (name, place, node)).collect();
    Ok(Table { place: place.clone(), entries, known: Vec::new() })
}

fn node(from: &DeValue<'_>, place: &Place, lines: &Lines, file: &Place) -> Result<Node, Problem> {
    let value = match from {
        DeValue::String(text) => Value::Text(text.to_string()),
        DeValue::Integer(integer) => {
            Value::Integer(i64::from_str_radix(integer.as_str(), integer.radix()).map_err(|_| {
                place.problem("expected an integer of 64 bits, found a larger one", "write a smaller number")
            })?)
        }
        DeValue::Float(float) => Value::Float(
            float
                .as_str()
                .parse()
                .map_err(|_| place.problem(format!("expected a number, found `{}`", float.as_str()), "write 1.5"))?,
        ),
        DeValue::Boolean(value) => Value::Boolean(*value),
        DeValue::Datetime(_) => {
            return Err(place.problem("expected a text, number, array or table, found a date", "put it in quotes"));
        }
        DeValue::Array(array) => Value::Array(
            array
                .iter()
                .map(|item| node(item.get_ref(), &file.at_line(lines.line(item.span().start)), lines, file))
                .collect::<Result<_, _>>()?,
        ),
        DeValue::Table(inner) => Value::Table(table(inner, place, lines, file)?),
    };
    Ok(Node { place: place.clone(), value })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Table {
        Table::parse(text, "t.toml").unwrap()
    }

    #[test]
    fn a_value_knows_its_line_and_type() {
        let mut table = parsed("a = 1\n\n[b]\nc = \"x\"\n");
        assert_eq!(table.take("a").unwrap().place.line, 1);
        let mut b = table.take("b").unwrap().into_table("b").unwrap();
        let problem = b.take("c").unwrap().number("a length in mm").unwrap_err();
        assert_eq!(
            problem.to_string(),
            "t.toml:4: expected a length in mm, found the text \"x\"\n  write a finite number without quotes"
        );
    }

    #[test]
    fn a_key_that_was_not_taken_is_rejected_with_the_nearest_name() {
        let mut table = parsed("strat = 1\n");
        assert_eq!(table.take("start"), None);
        let problem = table.finish().unwrap_err().to_string();
        assert!(problem.contains("`strat`") && problem.contains("did you mean `start`?"), "{problem}");
    }

    #[test]
    fn tables_merge_and_the_rest_is_replaced() {
        let mut table = parsed("[x]\nstart = 1\n[x.cam]\nfrom = 2\nto = 3\n");
        table.merge(parsed("[x]\ncam = false\nstop = 4\n"));
        let mut x = table.take("x").unwrap().into_table("x").unwrap();
        assert!(!x.take("cam").unwrap().boolean("cam").unwrap());
        assert_eq!(x.take("start").unwrap().integer("start").unwrap(), 1);
        assert_eq!(x.take("stop").unwrap().integer("stop").unwrap(), 4);
    }

    #[test]
    fn a_merged_table_has_the_place_of_its_last_change() {
        let mut table = parsed("[x]\nstart = 1\n[x.cam]\nfrom = 2\nto = 3\n[y]\na = 1\n");
        table.merge(Table::parse("\n[x]\ncam = { from = 5 }\n", "over.toml").unwrap());
        let place = |table: &mut Table, key| {
            let (_, place, node) = table.take_rest().into_iter().find(|(name, ..)| name == key).unwrap();
            (place.to_string(), node.into_table("a table").unwrap())
        };
        let (of_x, mut x) = place(&mut table.clone(), "x");
        let (of_cam, mut cam) = place(&mut x, "cam");
        assert_eq!((of_x.as_str(), of_cam.as_str()), ("over.toml:2", "over.toml:3"));
        assert_eq!(cam.place.to_string(), "over.toml:3");
        assert_eq!(cam.take("to").unwrap().place.to_string(), "t.toml:5");
        assert_eq!(place(&mut table, "y").0, "t.toml:6");
    }

    #[test]
    fn a_mistake_names_its_line() {
        let problem = Table::parse("a = 1\nb = \n", "t.toml").unwrap_err();
        assert_eq!(problem.place.unwrap().line, 2);
    }
}
