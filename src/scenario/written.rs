//! The steps of a scenario file as written, for as long as several cases and profiles may still read them.
//!
//! A generated scenario can have 100,000 steps, and a step as a tree of values needs some thirty times the memory of its text. So the steps
//! of a file are kept as text, and each is parsed where it is read. The text is cut at the lines `[[step]]`. A cut inside a text or an array
//! of several lines leaves an incomplete part before it, which is no TOML; such a file is parsed as a whole, as is one with other tables
//! after its steps.

use std::sync::Arc;

use crate::source::{Node, Place, Problem, Table, Value, nearest};

/// The steps of a file.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum WrittenSteps {
    /// The text from the first `[[step]]` to the end of the file, and the place of its first line.
    Text(Arc<str>, Place),
    /// Steps that cannot be parsed one by one.
    Tables(Arc<[Table]>),
}

/// The line at which a text is cut.
const STEP: &str = "[[step]]";

impl WrittenSteps {
    /// Reads a file into its head and its steps.
    ///
    /// # Errors
    /// The text is not TOML, or it has no steps.
    pub(super) fn read(text: &str, file: &str) -> Result<(Table, Self), Problem> {
        if let Some(read) = Self::read_in_parts(text, file) {
            return Ok(read);
        }
        let mut head = Table::parse(text, file)?;
        let written = head.take("step");
        let misspelt = head.entries().find(|(key, _)| written.is_none() && nearest(key, ["step"]).is_some());
        if let Some((key, node)) = misspelt {
            return Err(node.place.problem(format!("expected `[[step]]`, found `{key}`"), "did you mean `[[step]]`?"));
        }
        Ok((head, Self::of(written, file)?))
    }

    /// The steps in the value of the key `step` of a file.
    ///
    /// # Errors
    /// It is no list of tables, or it has none.
    pub(super) fn of(written: Option<Node>, file: &str) -> Result<Self, Problem> {
        let mut steps = Vec::new();
        each_step(written, &Place::file(file), |step| {
            steps.push(step);
            Ok(())
        })?;
        Ok(Self::Tables(steps.into()))
    }

    fn read_in_parts(text: &str, file: &str) -> Option<(Table, Self)> {
        let (head, steps) = text.split_at(cuts(text).next()?);
        let line = u32::try_from(head.matches('\n').count()).ok()? + 1;
        let head = Table::parse(head, file).ok().filter(|head| head.keys().all(|key| key != "step"))?;
        let written = Self::Text(steps.into(), Place::file(file).at_line(line));
        written.each(|_| Ok(())).ok()?;
        Some((head, written))
    }

    /// Shows every step, in order.
    ///
    /// # Errors
    /// The first one of `take`.
    pub(super) fn each(&self, mut take: impl FnMut(Table) -> Result<(), Problem>) -> Result<(), Problem> {
        match self {
            Self::Tables(tables) => tables.iter().cloned().try_for_each(take),
            Self::Text(text, place) => {
                let mut place = place.clone();
                for part in parts(text) {
                    let mut table = Table::parse_part(part, &place)?;
                    each_step(table.take("step"), &place, &mut take)?;
                    table.finish()?;
                    place.line += u32::try_from(part.matches('\n').count()).unwrap_or(0);
                }
                Ok(())
            }
        }
    }
}

/// The offsets of the lines `[[step]]`.
fn cuts(text: &str) -> impl Iterator<Item = usize> {
    let is_line_start = |offset: usize| {
        let before = text[..offset].trim_end_matches([' ', '\t']);
        before.is_empty() || before.ends_with('\n')
    };
    text.match_indices(STEP).map(|(offset, _)| offset).filter(move |offset| is_line_start(*offset))
}

/// The parts of a text that begins with `[[step]]`, each with one of these lines.
fn parts(text: &str) -> impl Iterator<Item = &str> {
    let ends = cuts(text).skip(1).chain(std::iter::once(text.len()));
    ends.scan(0, |start, end| {
        let part = &text[*start..end];
        *start = end;
        Some(part)
    })
}

/// Shows the steps in the value of the key `step`, one by one: a list of them, made from the list of values in its place and shortened, would
/// leave a gap in memory for each step.
fn each_step(
    node: Option<Node>,
    whole: &Place,
    mut take: impl FnMut(Table) -> Result<(), Problem>,
) -> Result<(), Problem> {
    let none = || whole.problem("expected at least one `[[step]]`, found none", "add [[step]] with a verb");
    let node = node.ok_or_else(none)?;
    if !matches!(node.value, Value::Array(_)) {
        return Err(node.expected("a list of steps", "write [[step]] with two brackets"));
    }
    let steps = node.into_list();
    if steps.is_empty() {
        return Err(none());
    }
    steps.into_iter().try_for_each(|step| take(step.into_table("a step with one verb")?))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lines of the steps, and whether the steps are kept as text.
    fn read(text: &str) -> (Vec<u32>, bool) {
        let (_, steps) = WrittenSteps::read(text, "s.toml").unwrap();
        let mut lines = Vec::new();
        let note = |step: Table| {
            lines.push(step.place.line);
            Ok(())
        };
        steps.each(note).unwrap();
        (lines, matches!(steps, WrittenSteps::Text(..)))
    }

    #[test]
    fn a_misspelt_step_is_named_with_its_line() {
        let problem = WrittenSteps::read("title = \"a\"\n[[steps]]\nrun = \"1s\"\n", "a.toml").unwrap_err();
        assert_eq!(problem.to_string(), "a.toml:2: expected `[[step]]`, found `steps`\n  did you mean `[[step]]`?");
    }

    #[test]
    fn steps_are_kept_as_text_and_know_their_lines() {
        assert_eq!(
            read("a = 1\n\n[[step]]\nrun = \"1s\"\n  [[step]]\r\nset.x = 1\n[[step]] # last\n[step.set]\ny = 1"),
            (vec![3, 5, 7], true)
        );
        assert_eq!(read("[[step]]\nrun = \"1s\"\n[[ step ]]\nx = 1\n"), (vec![1, 3], true));
        assert_eq!(read("[[step]]\nnote = \"[[step]]\" # [[step]]\n"), (vec![1], true));
    }

    #[test]
    fn what_cannot_be_cut_is_read_as_a_whole() {
        assert_eq!(read("[[step]]\nnote = '''\n[[step]]\n'''\n"), (vec![1], false));
        assert_eq!(read("[[step]]\nrun = \"1s\"\n[[rule]]\nnever = \"0\"\n[[step]]\n"), (vec![1, 5], false));
        assert_eq!(read("step = [{ run = \"1s\" }]\n"), (vec![1], false));
    }

    #[test]
    fn a_mistake_is_that_of_the_whole_file() {
        for (text, line, what) in [
            ("[[step]]\nrun = \n", 2, "invalid TOML"),
            ("a = 1\n[[step]]\nrun = 1\n[[step]]\nrun = 1\nrun = 2\n", 6, "invalid TOML"),
            ("step = []\n[[step]]\n", 2, "invalid TOML"),
            ("[step]\n", 1, "a list of steps"),
            ("step = []\n", 0, "at least one `[[step]]`"),
            ("a = 1\n", 0, "at least one `[[step]]`"),
        ] {
            let problem = WrittenSteps::read(text, "s.toml").unwrap_err();
            assert!(problem.what.contains(what), "{text}: {problem}");
            assert_eq!(problem.place.unwrap().line, line, "{text}");
        }
    }
}
