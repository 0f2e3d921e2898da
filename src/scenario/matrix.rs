//! The matrix of a scenario: lists of values whose every combination is a case of its own, with a golden file of its own.
//!
//! A key of the matrix is a key of the head (`plc`), a value of the plant (`plant.XF.start`) or a machine datum (`34080[XF]`). The first
//! key varies slowest. A case is the scenario with these values in its head, so everything else in this module works on one scenario.

use std::path::{Path, PathBuf};

use crate::source::{Node, Place, Problem, Table, Value, did_you_mean};

/// The keys of the head that a matrix can vary.
pub(super) const HEAD: [&str; 13] = [
    "machine",
    "profile",
    "plc",
    "plc_image",
    "program",
    "nc",
    "program_path",
    "limit",
    "watch",
    "causes",
    "never",
    "always",
    "compare",
];

/// The keys of the head that belong to the scenario as a whole.
pub(super) const FIXED: [&str; 8] = ["title", "covers", "plant", "machine_data", "matrix", "rule", "at", "step"];

/// The maximum number of cases.
const CASES: usize = 10_000;

/// The maximum number of characters in the name of a golden file before `.snap`.
const LONGEST: usize = 80;

/// One combination of the values of a matrix.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Variant {
    /// The number of the case, from one.
    pub number: usize,
    /// The keys and their values as text, in the order of the matrix.
    pub values: Vec<(String, String)>,
    /// The name in golden files, after `@`.
    pub name: String,
}

/// `34080[XF] = -0.941, plc = a`.
impl std::fmt::Display for Variant {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        for (index, (key, value)) in self.values.iter().enumerate() {
            let comma = if index == 0 { "" } else { ", " };
            write!(f, "{comma}{key} = {value}")?;
        }
        Ok(())
    }
}

impl Variant {
    /// Whether its values, as `plc = a`, or its name contain a text.
    #[must_use]
    pub fn fits(&self, text: &str) -> bool {
        self.to_string().contains(text) || self.name.contains(text)
    }

    /// Whether a text is all its values, or its name.
    pub(super) fn is(&self, text: &str) -> bool {
        self.to_string() == text || self.name == text
    }

    /// The golden file of this case: `name.snap` becomes `name@34080_XF_=-0.941.snap`.
    #[must_use]
    pub fn beside(&self, snap: &Path) -> PathBuf {
        let file = snap.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let (stem, rest) = file.split_once('.').unwrap_or((&file, "snap"));
        snap.with_file_name(format!("{stem}@{}.{rest}", self.name))
    }
}

/// One key of the matrix, and its values.
struct Dimension {
    key: String,
    place: Place,
    values: Vec<Node>,
}

/// The heads of all cases of a scenario: the head with the values of each combination. A scenario without a matrix has one head.
pub(super) fn heads(mut head: Table, path: &Path) -> Result<Vec<(Option<Variant>, Table)>, Problem> {
    let Some(matrix) = head.take("matrix") else {
        return Ok(vec![(None, head)]);
    };
    let dimensions = dimensions(matrix)?;
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let names = names(&dimensions, &stem);
    let mut heads = Vec::with_capacity(names.len());
    for (index, name) in names.into_iter().enumerate() {
        let mut own = head.clone();
        let mut values = Vec::new();
        for (dimension, value) in combination(&dimensions, index) {
            values.push((dimension.key.clone(), text(value)));
            put(&mut own, dimension, value)?;
        }
        heads.push((Some(Variant { number: index + 1, values, name }), own));
    }
    Ok(heads)
}

fn dimensions(matrix: Node) -> Result<Vec<Dimension>, Problem> {
    let place = matrix.place.clone();
    let mut table = matrix.into_table("a table of keys with lists of values")?;
    let mut dimensions = Vec::new();
    for (key, place, node) in table.take_rest() {
        node.refuse_unquoted_key(&key)?;
        check_key(&key, &place)?;
        let found = node.found();
        let Value::Array(values) = node.value else {
            let what = format!("expected a list of values for `{key}`, found {found}");
            return Err(place.problem(what, "write the values in brackets: plc = [\"a\", \"b\"]"));
        };
        if values.is_empty() {
            return Err(place.problem(format!("expected at least one value for `{key}`, found none"), "write one"));
        }
        dimensions.push(Dimension { key, place, values });
    }
    let count = dimensions.iter().try_fold(1_usize, |count, next| count.checked_mul(next.values.len()));
    if dimensions.is_empty() || count.is_none_or(|count| count > CASES) {
        let found = count.map_or_else(|| "more".to_owned(), |count| count.to_string());
        let found = if dimensions.is_empty() { "no key".to_owned() } else { format!("{found} cases") };
        return Err(place.problem(
            format!("expected a matrix of 1 to {CASES} cases, found {found}"),
            "write lists of values, as plc = [\"a\", \"b\"]; all their combinations run",
        ));
    }
    Ok(dimensions)
}

/// A key is one of the head, a value of the plant, or else looks like a machine datum, which the machine judges.
fn check_key(key: &str, place: &Place) -> Result<(), Problem> {
    if FIXED.contains(&key) {
        let cure = format!("vary {}, \"plant.AXIS.key\" or a machine datum", HEAD.join(", "));
        return Err(place.problem(format!("expected a key that a matrix can vary, found `{key}`"), cure));
    }
    let is_datum = || key.contains(|c: char| c.is_ascii_digit() || c.is_ascii_uppercase());
    if HEAD.contains(&key) || key.strip_prefix("plant.").is_some_and(|rest| !rest.is_empty()) || is_datum() {
        return Ok(());
    }
    let known = format!("keys are {}, \"plant.XF.start\" and machine data, as \"34080[XF]\"", HEAD.join(", "));
    Err(place.problem(format!("expected a key that a matrix can vary, found `{key}`"), did_you_mean(key, HEAD, &known)))
}

/// The values of a combination; the first key varies slowest.
fn combination(dimensions: &[Dimension], index: usize) -> impl Iterator<Item = (&Dimension, &Node)> {
    let mut following: usize = dimensions.iter().map(|dimension| dimension.values.len()).product();
    dimensions.iter().map(move |dimension| {
        following /= dimension.values.len();
        (dimension, &dimension.values[index / following % dimension.values.len()])
    })
}

/// Writes a value into the head of a case.
fn put(head: &mut Table, dimension: &Dimension, value: &Node) -> Result<(), Problem> {
    let Dimension { key, place, .. } = dimension;
    let path: Vec<&str> = match key.strip_prefix("plant.") {
        Some(rest) => std::iter::once("plant").chain(rest.split('.')).collect(),
        None if HEAD.contains(&key.as_str()) => vec![key],
        None => vec!["machine_data", key],
    };
    head.put(&path, place, value.clone()).map_err(|part| {
        let what = format!("expected a table `{part}`, found another value, so `{key}` cannot be set in it");
        place.problem(what, "remove that value from the scenario")
    })
}

/// The names of all cases. Where two names are the same on any computer, or a name is too long, the number of the case replaces it.
fn names(dimensions: &[Dimension], stem: &str) -> Vec<String> {
    let count = dimensions.iter().map(|dimension| dimension.values.len()).product();
    let name = |index| {
        let parts = combination(dimensions, index)
            .map(|(dimension, value)| format!("{}={}", for_a_file(&dimension.key), for_a_file(&text(value))));
        parts.collect::<Vec<_>>().join(",")
    };
    let names: Vec<String> = (0..count).map(name).collect();
    let mut sorted: Vec<String> = names.iter().map(|name| name.to_ascii_lowercase()).collect();
    sorted.sort_unstable();
    let is_unique = |name: &String| {
        let lower = name.to_ascii_lowercase();
        let first = sorted.partition_point(|other| *other < lower);
        sorted.get(first + 1).is_none_or(|next| *next != lower)
    };
    let fits = |name: &String| stem.chars().count() + 1 + name.chars().count() <= LONGEST;
    let named = names.iter().enumerate().map(|(index, name)| {
        if is_unique(name) && fits(name) { name.clone() } else { format!("case-{:03}", index + 1) }
    });
    named.collect()
}

/// Letters, digits, `.` and `-` stay; everything else becomes `_`.
fn for_a_file(text: &str) -> String {
    text.chars().map(|c| if c.is_alphanumeric() || c == '.' || c == '-' { c } else { '_' }).collect()
}

/// A value as it was written, as far as names and messages need it.
fn text(node: &Node) -> String {
    match &node.value {
        Value::Text(text) => text.clone(),
        Value::Integer(number) => number.to_string(),
        Value::Float(number) => format!("{number:?}"),
        Value::Boolean(value) => value.to_string(),
        Value::Array(nodes) => format!("[{}]", nodes.iter().map(text).collect::<Vec<_>>().join(", ")),
        Value::Table(table) => {
            let entries: Vec<_> = table.entries().map(|(key, node)| format!("{key} = {}", text(node))).collect();
            format!("{{ {} }}", entries.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn variants(matrix: &str, file: &str) -> Result<Vec<Variant>, Problem> {
        let head = Table::parse(&format!("[matrix]\n{matrix}"), file)?;
        Ok(heads(head, Path::new(file))?.into_iter().filter_map(|(variant, _)| variant).collect())
    }

    fn names(matrix: &str) -> Vec<String> {
        variants(matrix, "s.toml").unwrap().into_iter().map(|variant| variant.name).collect()
    }

    #[test]
    fn every_combination_is_a_case_and_the_first_key_varies_slowest() {
        let all = variants("\"34080[XF]\" = [-0.941, 0.0]\nplc = [\"a\", \"b\"]", "s.toml").unwrap();
        let names: Vec<_> = all.iter().map(|variant| variant.name.as_str()).collect();
        assert_eq!(
            names,
            ["34080_XF_=-0.941,plc=a", "34080_XF_=-0.941,plc=b", "34080_XF_=0.0,plc=a", "34080_XF_=0.0,plc=b"]
        );
        assert_eq!(all[1].to_string(), "34080[XF] = -0.941, plc = b");
        assert_eq!(all[1].number, 2);
        let snap = all[0].beside(Path::new("golden/s.828d.snap"));
        assert_eq!(snap, Path::new("golden/s@34080_XF_=-0.941,plc=a.828d.snap"));
    }

    #[test]
    fn names_that_meet_or_are_too_long_become_numbers() {
        assert_eq!(names("plc = [\"a/b\", \"a_b\", \"c\"]"), ["case-001", "case-002", "plc=c"]);
        assert_eq!(names("plc = [\"a\", \"A\"]"), ["case-001", "case-002"], "not every file system tells them apart");
        // `s@plc=` and 74 letters are 80 characters.
        let long = |length: usize| names(&format!("plc = [\"{}\"]", "x".repeat(length)));
        assert_eq!(long(74), [format!("plc={}", "x".repeat(74))]);
        assert_eq!(long(75), ["case-001"]);
    }

    #[test]
    fn a_value_is_named_as_it_was_written() {
        assert_eq!(
            names("watch = [[\"X.*\"], [\"Y.*\", \"XF.*\"]]\ncauses = [true]\n\"10240\" = [1]"),
            ["watch=_X.__,causes=true,10240=1", "watch=_Y.___XF.__,causes=true,10240=1"]
        );
    }

    #[test]
    fn a_case_has_the_values_in_its_head() {
        let text = "plc = \"old\"\n[plant.XF]\nstart = 1.0\nx = 2\n[matrix]\nplc = [\"a\"]\n\"plant.XF.start\" = [119.5]\n\"plant.Y.cam\" = [false]\n\"34080[XF]\" = [1]";
        let (_, mut head) = heads(Table::parse(text, "s.toml").unwrap(), Path::new("s.toml")).unwrap().remove(0);
        assert_eq!(head.take("plc").unwrap().text("plc").unwrap(), "a");
        let mut plant = head.take("plant").unwrap().into_table("plant").unwrap();
        let mut xf = plant.take("XF").unwrap().into_table("XF").unwrap();
        assert_eq!(xf.take("start").unwrap().value, Value::Float(119.5));
        assert_eq!(xf.take("x").unwrap().value, Value::Integer(2));
        assert!(plant.take("Y").is_some());
        let data = head.take("machine_data").unwrap().into_table("data").unwrap();
        assert_eq!(data.keys().collect::<Vec<_>>(), ["34080[XF]"]);
    }

    #[test]
    fn a_mistake_names_its_line_and_a_cure() {
        for (matrix, line, what, cure) in [
            ("plcc = [\"a\"]", 2, "found `plcc`", "did you mean `plc`?"),
            ("nothing_like_it = [\"a\"]", 2, "found `nothing_like_it`", "\"plant.XF.start\""),
            ("title = [\"a\"]", 2, "found `title`", "vary machine, profile"),
            ("plc = \"a\"", 2, "a list of values for `plc`, found the text \"a\"", "brackets"),
            ("plc = []", 2, "at least one value", "write one"),
            ("plant.XF.start = [1.0]", 2, "found plant.XF.start without quotes", "\"plant.XF.start\" = "),
            ("", 1, "a matrix of 1 to 10000 cases, found no key", "lists of values"),
        ] {
            let problem = variants(matrix, "s.toml").unwrap_err();
            assert_eq!(problem.place.as_ref().unwrap().line, line, "{matrix}: {problem}");
            assert!(problem.what.contains(what) && problem.cure.contains(cure), "{matrix}: {problem}");
        }
        let many = format!("a1 = {0}\nb1 = {0}\nc1 = {0}", format_args!("[{}]", "1,".repeat(30)));
        let problem = variants(&many, "s.toml").unwrap_err();
        assert!(problem.what.contains("found 27000 cases"), "{problem}");
    }
}
