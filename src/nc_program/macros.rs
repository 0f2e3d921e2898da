//! Macros: `DEFINE NAME AS words`. The name stands for the words in the blocks of its program that follow.
//!
//! A macro is replaced in the text of a block before it is parsed, outside of strings and comments. Macros in macros are not replaced, and words of
//! control structures and jump targets are searched in the text as it is written.

use serde::{Deserialize, Serialize};

use super::alarm::{Fault, Span};
use super::dialect::Dialect;
use super::head::word;

/// A macro.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Macro {
    /// In capitals.
    pub(super) name: String,
    pub(super) text: String,
}

/// Whether the words of a block define a macro.
pub(super) fn is_definition(line: &str, from: usize) -> bool {
    word(line, from).eq_ignore_ascii_case("DEFINE")
}

/// Takes the macro that a block defines; it comes before the first executable block, as DEF.
pub(super) fn define(
    macros: &mut Vec<Macro>,
    line: &str,
    from: usize,
    has_begun: bool,
    dialect: &Dialect,
) -> Result<(), Fault> {
    let defined = defined(line, from, dialect)?;
    if has_begun {
        return Err(Fault::new(14500, Span::default(), "DEFINE comes before the first executable block"));
    }
    if macros.iter().any(|other| other.name == defined.name) {
        return Err(Fault::new(12170, Span::default(), "the program has a macro of this name").about(&defined.name));
    }
    macros.push(defined);
    Ok(())
}

/// The macro that a block defines.
fn defined(line: &str, from: usize, dialect: &Dialect) -> Result<Macro, Fault> {
    let span = |from: usize, to: usize| {
        let short = |index: usize| u32::try_from(index).unwrap_or(u32::MAX);
        Span { from: short(from), to: short(to) }
    };
    let after = |from: usize| from + line[from..].len() - line[from..].trim_start().len();
    let at_name = after(from + word(line, from).len());
    let name = word(line, at_name);
    let at = span(at_name, at_name + name.len());
    if name.is_empty() || name.as_bytes()[0].is_ascii_digit() {
        return Err(Fault::new(12080, at, "DEFINE has a name, AS and words"));
    }
    if name.len() > dialect.name_length {
        let reason = format!("{} characters, at most {} are allowed", name.len(), dialect.name_length);
        return Err(Fault::new(12420, at, reason));
    }
    let at_as = after(at_name + name.len());
    if !word(line, at_as).eq_ignore_ascii_case("AS") {
        return Err(Fault::new(12080, span(at_as, at_as + word(line, at_as).len()), "AS comes behind the name"));
    }
    let text = code(&line[at_as + 2..], dialect.comment).trim().to_owned();
    if text.is_empty() {
        return Err(Fault::new(12080, span(at_as, at_as + 2), "the words of the macro are missing"));
    }
    Ok(Macro { name: name.to_ascii_uppercase(), text })
}

/// A line with its macros replaced, from the words on; `None` if there is none in it.
pub(super) fn expanded(line: &str, from: usize, macros: &[Macro], dialect: &Dialect) -> Option<String> {
    if macros.is_empty() {
        return None;
    }
    let end = from + code(&line[from..], dialect.comment).len();
    let mut done = line[..from].to_owned();
    let (mut at, mut is_string, mut has_macro) = (from, false, false);
    while let Some(letter) = line[at..end].chars().next() {
        let name = word(line, at);
        if is_string || name.is_empty() || name.len() > end - at {
            is_string ^= letter == '"';
            done.push(letter);
            at += letter.len_utf8();
            continue;
        }
        match macros.iter().find(|one| one.name.eq_ignore_ascii_case(name)) {
            Some(found) => {
                done += &found.text;
                has_macro = true;
            }
            None => done += name,
        }
        at += name.len();
    }
    has_macro.then(|| done + &line[end..])
}

/// A text up to its comment.
fn code(text: &str, comment: char) -> &str {
    let mut is_string = false;
    let end = text.find(|letter: char| {
        is_string ^= letter == '"';
        letter == comment && !is_string
    });
    &text[..end.unwrap_or(text.len())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::nc_program::dialect::SINUMERIK;

    fn macros(lines: &[&str]) -> Vec<Macro> {
        lines.iter().map(|line| defined(line, 0, &SINUMERIK).unwrap()).collect()
    }

    #[test]
    fn a_macro_stands_for_its_words_outside_of_strings_and_comments() {
        let macros = macros(&["DEFINE RAPID AS G0 M8", "define m6 as L6 ; the tool change"]);
        let read = |line: &str| expanded(line, 0, &macros, &SINUMERIK);
        assert_eq!(read("RAPID X5").as_deref(), Some("G0 M8 X5"));
        assert_eq!(read("T1 M6 ; M6").as_deref(), Some("T1 L6 ; M6"));
        assert_eq!(read("MSG(\"M6\")"), None);
        assert_eq!(read("RAPIDLY M60"), None);
    }

    #[test]
    fn a_definition_has_a_name_as_and_words() {
        for (line, number) in
            [("DEFINE", 12080), ("DEFINE AB", 12080), ("DEFINE AB X5", 12080), ("DEFINE AB AS ; X5", 12080)]
        {
            assert_eq!(defined(line, 0, &SINUMERIK).unwrap_err().number, number, "{line}");
        }
        let long = format!("DEFINE {} AS X5", "A".repeat(33));
        assert_eq!(defined(&long, 0, &SINUMERIK).unwrap_err().number, 12420);
    }
}
